/* An option, and a number with its join and its order: the integral of p^2 over cells with more than -square_above. */
#include "trials.h"
#include <petsam/private/lawimpl.h>
#include <petsam/private/state.h>

static const SamOptionRow row = {"square_above",
                                 "integrate p^2 where the pressure is higher",
                                 SAM_OPTION_REAL,
                                 .member   = 0,
                                 .range    = SAM_RANGE_NONNEGATIVE,
                                 .unit     = "Pa",
                                 .recorded = PETSC_TRUE};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  (void)from;
  *asked = *(PetscReal *)law->data >= 0 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateNumber square = {
    "pressure_square", "N2/m2", "integral of the square of the pressure", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE,
    SAM_JOIN_GREATEST, 2};

  (void)law;
  return SamStateDeclareNumber(state, &square, &(PetscInt){0});
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscReal above = *(PetscReal *)law->data;
  const double   *p;
  SamTotal        total = {0};
  double          sum;

  PetscCall(VecGetArrayRead(step->pressure, &p));
  for (PetscInt j = 0; j < step->grid->rows; j++) {
    double row_sum = 0;

    for (PetscInt k = j * step->grid->nx; k < (j + 1) * step->grid->nx; k++) row_sum += p[k] > above ? p[k] * p[k] : 0;
    SamAddAll(1, &total, &row_sum);
  }
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(SamSumTotals(step->grid->comm, 1, &total, &sum));
  *SamStateNumbers(step->state, SamStateFindNumber(step->state, "pressure_square"), SAM_TRIED) =
    sum * step->grid->dx * step->grid->dy;
  return 0;
}

PetscErrorCode CreateSquare(SamLaw law)
{
  PetscCall(PetscNew((PetscReal **)&law->data));
  *(PetscReal *)law->data = -1;
  law->option             = row.name;
  law->heading            = "Square of the pressure";
  law->rows               = &row;
  law->row_count          = 1;
  law->any_motion         = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.declare        = Declare;
  law->ops.advance        = Advance;
  law->ops.back           = SamLawNoBack;
  return 0;
}

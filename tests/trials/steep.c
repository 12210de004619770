/*
  Friction that grows with the pressure, mu p (1 + p/p_0): a law that its option alone selects. Its bound is no
  coefficient times the pressure, though it says that nothing goes back through it; gradients find that out.
*/
#include "trials.h"
#include <petsam/private/lawimpl.h>

typedef struct {
  PetscReal pressure; /* p_0, Pa */
} Steep;

static const SamOptionRow row = {"steep_pressure",
                                 "pressure at which friction is twice the coefficient",
                                 SAM_OPTION_REAL,
                                 offsetof(Steep, pressure),
                                 .range    = SAM_RANGE_POSITIVE,
                                 .unit     = "Pa",
                                 .recorded = PETSC_TRUE};

static PetscErrorCode Bound(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  const PetscReal p0   = ((Steep *)law->data)->pressure;
  const Vec       to[] = {bound->value, bound->by_pressure};
  const double   *p;
  double         *b;

  PetscCall(VecGetArrayRead(at->pressure, &p));
  for (int n = 0; n < 2; n++) {
    if (!to[n]) continue;
    PetscCall(VecGetArray(to[n], &b));
    for (PetscInt k = 0; k < law->grid->cells; k++) b[k] *= 1 + (n + 1) * p[k] / p0;
    PetscCall(VecRestoreArray(to[n], &b));
  }
  return VecRestoreArrayRead(at->pressure, &p);
}

PetscErrorCode CreateSteep(SamLaw law)
{
  PetscCall(PetscNew((Steep **)&law->data));
  law->option         = row.name;
  law->heading        = "Steep friction";
  law->rows           = &row;
  law->row_count      = 1;
  law->needs_friction = PETSC_TRUE;
  law->ops.bound      = Bound;
  law->ops.back       = SamLawNoBack;
  return 0;
}

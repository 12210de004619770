/*
  Adhesion by a constant tension between the surfaces, whatever their gap: p >= -tension, and in contact p > -tension.
*/
#include "trials.h"
#include <petsam/private/lawimpl.h>

static const SamOptionRow row = {"constant_tension",
                                 "constant tension between the surfaces",
                                 SAM_OPTION_REAL,
                                 0, /* the settings are the tension, Pa */
                                 .range    = SAM_RANGE_NONNEGATIVE,
                                 .unit     = "Pa",
                                 .recorded = PETSC_TRUE};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  (void)from;
  *asked = *(PetscReal *)law->data > 0 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

static PetscErrorCode Attract(SamLaw law, Vec gap, Vec tension)
{
  (void)gap;
  return VecShift(tension, *(PetscReal *)law->data);
}

PetscErrorCode CreateTension(SamLaw law)
{
  PetscCall(PetscNew((PetscReal **)&law->data));
  law->option             = row.name;
  law->heading            = "Constant tension";
  law->rows               = &row;
  law->row_count          = 1;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.attract        = Attract;
  return 0;
}

/* Two half-spaces in plane strain: the type, and the distance that displacements are relative to (halfspace.c). */
#include "../waves.h"
#include <math.h>

#define DATUM "plane_datum"

static PetscErrorCode CheckDatum(SamElasticity e, PetscErrorCode error, const char source[], const char before[])
{
  const double datum = (double)*SamHalfSpaceDatum(e), least = (double)e->grid->width[0] / 2;

  PetscFunctionBegin;
  PetscCheck(datum >= least && isfinite(datum), e->grid->comm, error,
             "%s%s" DATUM " %.6g: give at least half the grid's width, %.6g m", source, before, datum, least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions_Plane(SamElasticity e, const SamOptions *from)
{
  char      before[SAM_PREFIX + 2];
  PetscReal datum = 0;

  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, DATUM, "plane: distance (m) that displacements are relative to, 0: grid width",
                           SAM_RANGE_NONNEGATIVE, &datum, NULL));
  if (datum > 0) *SamHalfSpaceDatum(e) = datum;
  PetscCall(PetscSNPrintf(before, sizeof(before), "-%s", e->prefix));
  PetscCall(CheckDatum(e, SAM_ERR_USER, "", before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters_Plane(SamElasticity e, SamParameters *p)
{
  return SamParametersAddReals(p, DATUM, PETSC_TRUE, 1, SamHalfSpaceDatum(e));
}

static PetscErrorCode SetParameters_Plane(SamElasticity e, const SamParameters *p, const char source[])
{
  const SamParameter *found = SamParametersFind(p, DATUM);

  PetscFunctionBegin;
  if (found && found->count == 1) *SamHalfSpaceDatum(e) = found->value[0];
  PetscCall(CheckDatum(e, SAM_ERR_FILE, source, ": cannot be read: "));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate_Plane(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(SamElasticityCreate_HalfSpace(e));
  *SamHalfSpaceDatum(e)  = e->grid->width[0];
  e->traits.plane        = PETSC_TRUE;
  e->traits.rotations[0] = e->traits.rotations[2] = PETSC_FALSE;
  e->traits.within                                = PETSC_FALSE;
  if (SamPairHasLayers(&e->pair)) e->ops.createstress = NULL;
  e->ops.setfromoptions = SetFromOptions_Plane;
  e->ops.addparameters  = AddParameters_Plane;
  e->ops.setparameters  = SetParameters_Plane;
  PetscFunctionReturn(PETSC_SUCCESS);
}

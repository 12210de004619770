/* Derivatives of a number of the steps in another program: petsam_gradient_record(), petsam_gradient(). */
#include "embedimpl.h"
#include <petsam/private/contact.h>

static PetscErrorCode Record(petsam_contact *c, PetscBool on)
{
  PetscFunctionBegin;
  PetscCall(SamEmbedForget(c));
  PetscCall(SamSimulationRecordGradient(c->simulation, on));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_gradient_record(petsam_contact *c, int on)
{
  return SamEmbedEnterTogether(c, __func__, PETSC_TRUE, on != 0) ? SamEmbedLeave(c, Record(c, on != 0))
                                                                 : SAM_EMBED_USAGE;
}

/* Gets what has recorded the steps. */
static PetscErrorCode GetRecorded(petsam_contact *c, SamGradient *g)
{
  PetscFunctionBegin;
  *g = SamSimulationGetGradient(c->simulation);
  PetscCheck(*g, c->comm, PETSC_ERR_ORDER,
             "the gradient: no steps are recorded: begin with petsam_gradient_record(), record_gradient() in Python");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Compute(petsam_contact *c, const char name[], int first, int last, const char of[], double rtol,
                              int *steps, const char **unit)
{
  const PetscInt  range[] = {first, last};
  SamGradient     g;
  SamGradientGoal goal;

  PetscFunctionBegin;
  PetscCall(GetRecorded(c, &g));
  PetscCheck(rtol > 0 && rtol <= SAM_GRADIENT_LOOSEST, c->comm, SAM_ERR_USER,
             "the gradient of %s: rtol %.6g: expected a number > 0 and <= %.6g", name, rtol, SAM_GRADIENT_LOOSEST);
  PetscCall(SamGradientFind(c->comm, name, &goal));
  PetscCall(SamGradientCompute(g, &goal, range, of, (PetscReal)rtol));
  *steps = (int)SamGradientGetSteps(g);
  if (unit) *unit = SamGradientUnit(g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_gradient(petsam_contact *c, const char *name, int first, int last, const char *of, double rtol, int *steps,
                    const char **unit)
{
  const uint64_t sum =
    SamEmbedAddText(SamEmbedAddText(SamHashBits(rtol) + (uint64_t)first + 31 * (uint64_t)last, name), of);

  return SamEmbedEnterTogether(c, __func__, name && steps, sum)
           ? SamEmbedLeave(c, Compute(c, name, first, last, of ? of : "", rtol, steps, unit))
           : SAM_EMBED_USAGE;
}

static PetscErrorCode Get(petsam_contact *c, const char name[], double values[])
{
  SamGradient   g;
  PetscInt      steps;
  const double *cells;

  PetscFunctionBegin;
  PetscCall(GetRecorded(c, &g));
  if (!strcmp(name, "gap") || !strcmp(name, "friction")) {
    PetscCall(SamGradientGetField(g, name, c->work));
    PetscCall(VecGetArrayRead(c->work, &cells));
    PetscCall(PetscArraycpy(values, cells, c->setup->grid->cells));
    PetscCall(VecRestoreArrayRead(c->work, &cells));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  steps = SamGradientIsOfSteps(name) ? SamGradientGetSteps(g) : 1;
  for (PetscInt k = 0; k == 0 || k < steps; k++) {
    PetscReal value;

    PetscCall(SamGradientGetNumber(g, name, k, &value)); /* it rejects the first step if there is no gradient */
    values[k] = (double)value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_get_gradient(petsam_contact *c, const char *name, double *values)
{
  return SamEmbedEnterTogether(c, __func__, SamEmbedExists(c) && name && (values || !c->setup->grid->cells),
                               SamEmbedAddText(0, name))
           ? SamEmbedLeave(c, Get(c, name, values))
           : SAM_EMBED_USAGE;
}

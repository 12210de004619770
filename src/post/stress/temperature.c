/*
  The temperature below the surface by the steady heat of a step: that of the heat into the body, on a half-space whose
  material moves along x (laws/heat/heatoperator.c), at one depth after another. Of a section the lines of all steps are
  computed before the stresses, as ranks share its depths; of maps the operator of a depth serves all steps.
*/
#include "evaluationimpl.h"

struct _n_SamTemperature {
  SamConductor conductor;
  PetscInt     depth; /* number of the conductor's depth */
  Vec          field;
  PetscInt     length; /* points of the section at a depth */
  double      *line;   /* (steps, depths, length) of a section, K */
};

static PetscBool IsWanted(SamEvaluation e)
{
  for (PetscInt q = 0; SamQuantityTable[q].name; q++)
    if (e->wants[q] && SamQuantityTable[q].of_heat) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SamTemperatureSetUp(SamEvaluation e)
{
  PetscFunctionBegin;
  if (!IsWanted(e)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(e->source.heat, e->comm, SAM_ERR_USER,
             "-quantities temperature: %s has no frictional heat: run petsam with -heat steady and an output that has "
             "heat_1 and heat_2",
             e->source.name);
  PetscCheck(!e->slide, e->comm, SAM_ERR_USER,
             "-quantities temperature: the points of body %" PetscInt_FMT
             " slide under the contact, where it is not known: omit it, or give the other body",
             e->body);
  PetscCall(PetscNew(&e->temperature));
  e->temperature->depth  = -1;
  e->temperature->length = e->axis == SAM_SECTION_X ? e->grid->nx : e->grid->ny;
  PetscCall(SamGridCreateVec(e->grid, 1, &e->temperature->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTemperatureDestroy(SamTemperature *temperature)
{
  SamTemperature t = *temperature;

  PetscFunctionBegin;
  *temperature = NULL;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamConductorDestroy(&t->conductor));
  PetscCall(VecDestroy(&t->field));
  SamFree(t->line);
  PetscCall(PetscFree(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bytes per cell: the field and the kernels, 64, and 312 nodes of each lag along x */
double SamTemperatureBytes(SamEvaluation e)
{
  const SamTemperature t = e->temperature;

  if (!t) return 0;
  return 72 * (double)e->grid->cells + 16 * 312 * 2 * (double)e->grid->nx +
         (e->section ? 8 * (double)e->source.steps * (double)e->depths * (double)t->length : 0);
}

/* Computes the temperature of this rank's cells at a depth in a step, in the field. */
static PetscErrorCode ComputePlane(SamEvaluation e, PetscInt step, PetscInt depth)
{
  const SamTemperature t = e->temperature;
  double              *a;

  PetscFunctionBegin;
  if (t->depth != depth) {
    PetscCall(SamConductorDestroy(&t->conductor));
    PetscCall(SamConductorCreate(e->grid, e->source.settings, e->source.heat, e->depth[depth], &t->conductor));
    t->depth = depth;
  }
  PetscCall(VecGetArray(t->field, &a));
  PetscCall((*e->source.read)(e->source.context, step, SAM_STEP_HEAT, a));
  PetscCall(VecRestoreArray(t->field, &a));
  PetscCall(SamConductorApply(t->conductor, t->field, t->field));
  PetscCall(VecShift(t->field, (PetscScalar)e->source.bulk));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTemperatureFind(SamEvaluation e)
{
  const SamTemperature t = e->temperature;
  const double        *a;

  PetscFunctionBegin;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    SamAllocate(sizeof(double) * (size_t)(e->source.steps * e->depths) * (size_t)PetscMax(t->length, 1), &t->line));
  for (PetscInt depth = 0; depth < e->depths; depth++)
    for (PetscInt step = 0; step < e->source.steps; step++) {
      PetscCall(ComputePlane(e, step, depth));
      PetscCall(VecGetArrayRead(t->field, &a));
      PetscCall(SamPointsTakeLine(e, a, t->length, t->line + (step * e->depths + depth) * (ptrdiff_t)t->length));
      PetscCall(VecRestoreArrayRead(t->field, &a));
      PetscCall(SamEvaluationTell(e, "temperature", (double)(depth + 1) / e->depths, 0));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTemperatureGet(SamEvaluation e, PetscInt step, const SamPoints *p, double values[])
{
  const SamTemperature t = e->temperature;
  const double        *a;

  PetscFunctionBegin;
  if (e->section) {
    PetscCall(PetscArraycpy(values, t->line + (step * e->depths + p->depth) * (ptrdiff_t)t->length, p->count));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ComputePlane(e, step, p->depth));
  PetscCall(VecGetArrayRead(t->field, &a));
  PetscCall(PetscArraycpy(values, a, p->count));
  PetscCall(VecRestoreArrayRead(t->field, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

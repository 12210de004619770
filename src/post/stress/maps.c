/* Stresses on whole planes: one depth at a time, whose kernels are used for all steps. */
#include "evaluationimpl.h"

/* Bytes per cell: kernels 120, stresses 48, spectra 48, a quantity being written, and copies by MPI-IO */
#define BYTES 240.0

/* Returns the bytes stored per point and step of a cycle: its stress, and slip for Ruiz's parameters. */
static double CycleBytes(SamEvaluation e)
{
  return (double)sizeof(double) * (SAM_STRESS_COMPONENTS + (SamQuantityWanted(e, SamFatigueRuiz) ? 2 : 0));
}

double SamMapsMemory(SamEvaluation e)
{
  const double cells = (double)e->grid->cells;

  return BYTES * cells + (e->cycle ? CycleBytes(e) * cells * (double)e->source.steps : 0);
}

/* Computes the stresses of a step at a depth, at the body's own points or at the grid's points. */
static PetscErrorCode Apply(SamEvaluation e, PetscInt step, PetscBool own, Vec field)
{
  const PetscInt cells = e->grid->cells;
  double        *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &a));
  PetscCall(SamEvaluationReadTractions(
    e, step, own, (double *[]){a + SAM_STRESS_ZZ * cells, a + SAM_STRESS_XZ * cells, a + SAM_STRESS_YZ * cells}));
  PetscCall(VecRestoreArray(field, &a));
  PetscCall(SamStressApply(e->stress, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeStep(SamEvaluation e, PetscInt step, const SamPoints *p, Vec field)
{
  const ptrdiff_t size    = SAM_STRESS_COMPONENTS * (ptrdiff_t)p->count;
  const PetscBool surface = e->depth[p->depth] == 0 ? PETSC_TRUE : PETSC_FALSE;
  double         *a;

  PetscFunctionBegin;
  if (surface) {
    PetscCall(Apply(e, step, PETSC_FALSE, field)); /* an edge is searched in data that are not interpolated */
    PetscCall(SamLargestAtEdge(e, step, field));
  }
  if (!surface || SamPointsSlide(e, step)) PetscCall(Apply(e, step, PETSC_TRUE, field));
  PetscCall(VecGetArray(field, &a));
  PetscCall(SamStressPartsAdd(e->parts, step, p, a));
  PetscCall(SamQuantitiesWrite(e, step, p, a));
  if (p->stress && e->average)
    PetscCall(SamAverageAdd(e, p->depth, e->grid->nx, size, a, p->stress + step * size));
  else if (p->stress)
    PetscCall(PetscArraycpy(p->stress + step * size, a, size));
  PetscCall(VecRestoreArray(field, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMapsCompute(SamEvaluation e)
{
  const SamGrid g = e->grid;
  SamPoints     p = {.count = g->cells, .depths = 1, .plane = g->cells};
  Vec           field;
  double        part;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, SAM_STRESS_COMPONENTS, &field));
  if (e->cycle) {
    const size_t values = (size_t)(e->source.steps * SAM_STRESS_COMPONENTS) * (size_t)p.count;

    PetscCall(SamAllocate(sizeof(double) * values, &p.stress));
    if (e->average) PetscCall(PetscArrayzero(p.stress, values));
  }
  for (p.depth = 0; p.depth < e->depths; p.depth++) {
    PetscCall(SamStressSetDepth(e->stress, e->depth[p.depth]));
    for (PetscInt step = 0; step < e->source.steps; step++) {
      PetscCall(ComputeStep(e, step, &p, field));
      part = ((double)p.depth + (double)(step + 1) / (double)e->source.steps) / e->depths;
      PetscCall(SamEvaluationTell(e, "maps", part, p.stress ? 0 : part));
    }
    if (p.stress && !e->average) PetscCall(SamCycleWrite(e, &p, (double)p.depth / e->depths, 1.0 / e->depths));
  }
  p.depth = 0;
  if (e->average) PetscCall(SamCycleWrite(e, &p, 0, 1));
  SamFree(p.stress);
  PetscCall(VecDestroy(&field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stresses on a section: several steps at a time, limited by the memory for the spectra of their lines of cells. */
#include "evaluationimpl.h"

/* Bytes per cell that the spectra of a section's steps may take on a rank, and the least total */
#define SPECTRA_BYTES 100.0
#define SPECTRA_LEAST 512e6

static double Cells(SamEvaluation e)
{
  return (double)e->grid->nx * (double)e->grid->ny;
}

/* Returns the number of steps whose spectra are stored at a time. */
static PetscInt Batch(SamEvaluation e)
{
  const double room = PetscMax(SPECTRA_LEAST, SPECTRA_BYTES * Cells(e));

  return (PetscInt)PetscMax(1, PetscMin((double)e->source.steps, room / (50 * Cells(e))));
}

double SamLinesMemory(SamEvaluation e)
{
  const PetscInt length = e->axis == SAM_SECTION_X ? e->grid->nx : e->grid->ny,
                 steps  = e->cycle ? e->source.steps : Batch(e);

  return 24 * (double)e->grid->cells + (8 + 50 * (double)Batch(e)) * Cells(e) +
         48 * (double)steps * (double)length * (double)e->depths;
}

static PetscErrorCode AddStep(SamEvaluation e, SamSection section, PetscInt step, Vec tractions)
{
  const PetscInt cells = e->grid->cells;
  double        *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(tractions, &a));
  PetscCall(SamEvaluationReadTractions(e, step, PETSC_TRUE, (double *[]){a, a + cells, a + 2 * cells}));
  PetscCall(VecRestoreArray(tractions, &a));
  PetscCall(SamSectionAddStep(section, tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stresses of steps first ... first + count - 1. */
static PetscErrorCode ComputeSteps(SamEvaluation e, SamSection section, PetscInt first, PetscInt count,
                                   const SamPoints *p, Vec tractions)
{
  const ptrdiff_t size   = SAM_STRESS_COMPONENTS * (ptrdiff_t)p->count;
  double *const   stress = p->stress + (e->cycle ? first : 0) * size;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++) PetscCall(AddStep(e, section, first + k, tractions));
  PetscCall(SamSectionCompute(section, stress));
  for (PetscInt k = 0; k < count; k++) {
    PetscCall(SamStressPartsAdd(e->parts, first + k, p, stress + k * size));
    PetscCall(SamQuantitiesWrite(e, first + k, p, stress + k * size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes all steps at some depths from `depth` on; an average is collected in `sum`, which is created here. */
static PetscErrorCode ComputeDepths(SamEvaluation e, PetscInt depth, PetscInt depths, SamPoints *p, double **sum)
{
  const PetscInt batch = Batch(e), room = e->cycle ? e->source.steps : batch;
  ptrdiff_t      values;
  SamSection     section;
  Vec            tractions;
  double         part;

  PetscFunctionBegin;
  PetscCall(SamSectionCreate(e->stress, e->axis, e->index, depths, e->depth + depth, &section));
  PetscCall(SamSectionGetDepths(section, &p->depth, &p->depths, &p->plane));
  p->depth += depth;
  p->count = p->depths * p->plane;
  values   = room * SAM_STRESS_COMPONENTS * (ptrdiff_t)p->count;
  SamFree(p->stress);
  PetscCall(SamAllocate(sizeof(double) * (size_t)values, &p->stress));
  PetscCall(SamGridCreateVec(e->grid, SAM_STRESS_TRACTIONS, &tractions));
  for (PetscInt first = 0; first < e->source.steps; first += batch) {
    const PetscInt count = PetscMin(batch, e->source.steps - first);

    PetscCall(ComputeSteps(e, section, first, count, p, tractions));
    part = ((double)depth + (double)depths * (double)(first + count) / (double)e->source.steps) / (double)e->depths;
    PetscCall(SamEvaluationTell(e, "section", part, e->cycle ? 0 : part));
  }
  if (e->average && !*sum) {
    PetscCall(SamAllocate(sizeof(double) * (size_t)values, sum));
    PetscCall(PetscArrayzero(*sum, values));
  }
  if (e->average) PetscCall(SamAverageAdd(e, depth, p->plane, values, p->stress, *sum));
  PetscCall(VecDestroy(&tractions));
  PetscCall(SamSectionDestroy(&section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLinesCompute(SamEvaluation e)
{
  const PetscInt depths = e->average ? 1 : e->depths; /* one at a time, all depths belong to the first rank */
  SamPoints      p      = {.count = 0};
  double        *sum    = NULL;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < e->depths; k += depths) PetscCall(ComputeDepths(e, k, depths, &p, &sum));
  if (e->average) {
    SamFree(p.stress);
    p.stress = sum;
    p.depth  = 0;
  }
  if (e->cycle) PetscCall(SamCycleWrite(e, &p, 0, 1));
  SamFree(p.stress);
  PetscFunctionReturn(PETSC_SUCCESS);
}

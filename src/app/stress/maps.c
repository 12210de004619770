/* Stresses on whole planes: a depth at a time, whose kernels serve all steps. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>
#include "../memory.h"

/* Bytes a cell: kernels 120, stresses 48, spectra 48, a quantity that is written, and what MPI-IO copies. */
#define BYTES 240.0

/* Bytes that a cycle keeps of a point in a step: its stress, and slip for Ruiz's parameters. */
static double CycleBytes(const SamStressRun *run)
{
  return (double)sizeof(double) * (SAM_STRESS_COMPONENTS + (run->request.wants[SAM_QUANTITY_RUIZ] ? 2 : 0));
}

double SamMapsMemory(const SamStressRun *run)
{
  const double cells = (double)run->grid->cells;

  return SAM_MEMORY_PROGRAM + BYTES * cells + (SamCycleWanted(run) ? CycleBytes(run) * cells * (double)run->steps : 0);
}

/* The tractions of a step, where SamStressApply() takes them. */
static PetscErrorCode ReadTractions(SamStressRun *run, PetscInt step, Vec field)
{
  const PetscInt cells = run->grid->cells;
  double        *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &a));
  PetscCall(
    SamTractionsRead(run, run->saved[step],
                     (double *[]){a + SAM_STRESS_ZZ * cells, a + SAM_STRESS_XZ * cells, a + SAM_STRESS_YZ * cells}));
  PetscCall(VecRestoreArray(field, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeStep(SamStressRun *run, SamStress stress, PetscInt step, const SamPoints *p, Vec field)
{
  double *a;

  PetscFunctionBegin;
  PetscCall(ReadTractions(run, step, field));
  PetscCall(SamStressApply(stress, field));
  if (run->request.depth[p->depth] == 0) PetscCall(SamEdgeStressCompute(run, step, field));
  PetscCall(VecGetArray(field, &a));
  SamStressAddBulk(run, step, p->count, a);
  PetscCall(SamQuantitiesWrite(run, step, p, a));
  if (p->stress)
    PetscCall(PetscArraycpy(p->stress + step * SAM_STRESS_COMPONENTS * (ptrdiff_t)p->count, a,
                            SAM_STRESS_COMPONENTS * p->count));
  PetscCall(VecRestoreArray(field, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMapsCompute(SamStressRun *run)
{
  const SamGrid g = run->grid;
  SamPoints     p = {.count = g->cells, .depths = 1};
  SamStress     stress;
  Vec           field;
  double        part;

  PetscFunctionBegin;
  PetscCall(SamStressCreate(g, &run->transforms, run->request.body, run->poisson, &stress));
  PetscCall(SamGridCreateVec(g, SAM_STRESS_COMPONENTS, &field));
  if (SamCycleWanted(run))
    PetscCall(SamAllocate(sizeof(double) * (size_t)(run->steps * SAM_STRESS_COMPONENTS) * (size_t)p.count, &p.stress));
  for (p.depth = 0; p.depth < run->request.depths; p.depth++) {
    p.first = ((double)p.depth * (double)g->ny + (double)g->row_start) * (double)g->nx;
    PetscCall(SamStressSetDepth(stress, run->request.depth[p.depth]));
    for (PetscInt step = 0; step < run->steps; step++) {
      PetscCall(ComputeStep(run, stress, step, &p, field));
      part = ((double)p.depth + (double)(step + 1) / (double)run->steps) / run->request.depths;
      PetscCall(SamStressRunTell(run, "maps", part, p.stress ? 0 : part));
    }
    if (p.stress) PetscCall(SamCycleWrite(run, &p, (double)p.depth / run->request.depths, 1.0 / run->request.depths));
  }
  SamFree(p.stress);
  PetscCall(VecDestroy(&field));
  PetscCall(SamStressDestroy(&stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

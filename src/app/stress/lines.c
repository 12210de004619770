/* Stresses on a section: some steps at a time, as many as the spectra of their lines of cells have room for. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>
#include "../memory.h"

/* Bytes a cell that the spectra of a section's steps may take on a rank, but at least so many in all. */
#define SPECTRA_BYTES 100.0
#define SPECTRA_LEAST 512e6

static double Cells(const SamStressRun *run)
{
  return (double)run->grid->nx * (double)run->grid->ny;
}

/* The steps whose spectra are kept at a time. */
static PetscInt Batch(const SamStressRun *run)
{
  const double room = PetscMax(SPECTRA_LEAST, SPECTRA_BYTES * Cells(run));

  return (PetscInt)PetscMax(1, PetscMin((double)run->steps, room / (50 * Cells(run))));
}

double SamLinesMemory(const SamStressRun *run)
{
  const PetscInt length = run->request.axis == SAM_SECTION_X ? run->grid->nx : run->grid->ny,
                 steps  = SamCycleWanted(run) ? run->steps : Batch(run);

  return SAM_MEMORY_PROGRAM + 24 * (double)run->grid->cells + (8 + 50 * (double)Batch(run)) * Cells(run) +
         48 * (double)steps * (double)length * (double)run->request.depths;
}

static PetscErrorCode AddStep(SamStressRun *run, SamSection section, PetscInt step, Vec tractions)
{
  const PetscInt cells = run->grid->cells;
  double        *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(tractions, &a));
  PetscCall(SamTractionsRead(run, run->saved[step], (double *[]){a, a + cells, a + 2 * cells}));
  PetscCall(VecRestoreArray(tractions, &a));
  PetscCall(SamSectionAddStep(section, tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stresses of steps first ... first + count - 1. */
static PetscErrorCode ComputeSteps(SamStressRun *run, SamSection section, PetscInt first, PetscInt count,
                                   const SamPoints *p, Vec tractions)
{
  const ptrdiff_t size   = SAM_STRESS_COMPONENTS * (ptrdiff_t)p->count;
  double *const   stress = p->stress + (SamCycleWanted(run) ? first : 0) * size;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++) PetscCall(AddStep(run, section, first + k, tractions));
  PetscCall(SamSectionCompute(section, stress));
  for (PetscInt k = 0; k < count; k++) {
    SamStressAddBulk(run, first + k, p->count, stress + k * size);
    PetscCall(SamQuantitiesWrite(run, first + k, p, stress + k * size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLinesCompute(SamStressRun *run)
{
  const PetscInt batch = Batch(run), room = SamCycleWanted(run) ? run->steps : batch;
  SamPoints      p = {.count = 0};
  PetscInt       length;
  SamSection     section;
  Vec            tractions;
  double         part;

  PetscFunctionBegin;
  PetscCall(SamSectionCreate(run->grid, run->request.body, run->poisson, run->request.axis, run->index,
                             run->request.depths, run->request.depth, &section));
  PetscCall(SamSectionGetDepths(section, &p.depth, &p.depths, &length));
  p.count = p.depths * length;
  p.first = (double)p.depth * (double)length;
  PetscCall(SamAllocate(sizeof(double) * (size_t)(room * SAM_STRESS_COMPONENTS) * (size_t)p.count, &p.stress));
  PetscCall(SamGridCreateVec(run->grid, SAM_STRESS_TRACTIONS, &tractions));
  for (PetscInt first = 0; first < run->steps; first += batch) {
    const PetscInt count = PetscMin(batch, run->steps - first);

    PetscCall(ComputeSteps(run, section, first, count, &p, tractions));
    part = (double)(first + count) / (double)run->steps;
    PetscCall(SamStressRunTell(run, "section", part, SamCycleWanted(run) ? 0 : part));
  }
  if (SamCycleWanted(run)) PetscCall(SamCycleWrite(run, &p, 0, 1));
  PetscCall(VecDestroy(&tractions));
  SamFree(p.stress);
  PetscCall(SamSectionDestroy(&section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

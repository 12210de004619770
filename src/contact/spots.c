/* Numbers of rough contact: its spots, zones that are connected by the sides of their cells, and the mean gap. */
#include "contactimpl.h"

PetscErrorCode SamContactCountSpots(SamContact c, PetscReal *spots)
{
  const PetscBool wrap = c->traits.rotations ? PETSC_FALSE : PETSC_TRUE; /* bodies that cannot rotate are periodic */
  PetscInt        zones;

  PetscFunctionBegin;
  PetscCall(SamGridCountZones(c->grid, c->tried.solution.pressure, wrap, &zones));
  *spots = (PetscReal)zones;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactMeanGap(SamContact c, PetscReal *mean)
{
  const SamGrid grid  = c->grid;
  SamTotal      total = {0};
  const double *g;
  double        sum;
  Vec           gap;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &gap));
  PetscCall(SamSolutionComputeGap(c->problem, &c->tried.solution, gap));
  PetscCall(VecGetArrayRead(gap, &g));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < grid->nx; i++) row += g[(ptrdiff_t)j * grid->nx + i];
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(gap, &g));
  PetscCall(VecDestroy(&gap));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &sum));
  *mean = sum / ((PetscReal)grid->nx * (PetscReal)grid->ny);
  PetscFunctionReturn(PETSC_SUCCESS);
}

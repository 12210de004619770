/* Numbers of rough contact: its spots, zones that are connected by the sides of their cells, and the mean gap. */
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/problem.h>

static const SamStateNumber declared[] = {{"contact_spots", "1", "contact spots, connected by the sides of cells",
                                           SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0},
                                          {"gap_mean", "m", "mean gap of all cells", SAM_NUMBER_REAL, 1, PETSC_FALSE,
                                           PETSC_TRUE, SAM_JOIN_LAST, 2}};

PetscErrorCode SamSolutionDeclareSpots(SamState state)
{
  PetscInt id;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(SamStateDeclareNumber(state, &declared[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeanGap(SamProblem problem, SamState state, const SamSolution *s, double *mean)
{
  SamTotal      total = {0};
  const double *g;
  double        sum;
  Vec           gap, h;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &gap));
  PetscCall(SamSolutionCreateSeparation(problem, state, SAM_TRIED, &h));
  PetscCall(SamSolutionComputeGap(problem, s, s->displacement_z, h, gap));
  PetscCall(SamSolutionDestroySeparation(problem, &h));
  PetscCall(VecGetArrayRead(gap, &g));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < grid->nx; i++) row += g[(ptrdiff_t)j * grid->nx + i];
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(gap, &g));
  PetscCall(VecDestroy(&gap));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &sum));
  *mean = sum / ((double)grid->nx * (double)grid->ny);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionComputeSpots(SamProblem problem, SamState state, const SamSolution *s)
{
  double *const numbers = SamStateNumbers(state, SamStateFindNumber(state, declared[0].name), SAM_TRIED);
  PetscInt      zones;

  PetscFunctionBegin;
  PetscCall(SamGridCountZones(SamProblemGetGrid(problem), s->pressure,
                              SamElasticityGetTraits(SamProblemGetElasticity(problem)).periodic, &zones));
  numbers[0] = (double)zones;
  PetscCall(MeanGap(problem, state, s, &numbers[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two steel spheres pressed together by 1000 N and pushed sideways by 60 N: how far they move. */
#include <petsam.h>

int main(int argc, char **argv)
{
  const PetscInt  n[2]     = {256, 256};
  const PetscReal width[2] = {2.6e-3, 2.6e-3}, center[2] = {0, 0}, young[2] = {210e9, 210e9}, poisson[2] = {0.3, 0.3};
  SamStep         step = {
            .normal     = {.kind  = SAM_BALANCE_NORMAL,
                           .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                           .load  = {1000, 0, 0}}, /* N, Mx, My */
            .tangential = {.kind  = SAM_BALANCE_TANGENTIAL,
                           .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                           .load  = {60, 0, 0}} /* Tx, Ty, Mz */
  };
  SamPair       pair;
  SamGrid       grid;
  SamGap        gap;
  SamElasticity elasticity;
  SamContact    contact;
  Vec           separation;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsInsertString(NULL, "-gap_type sphere -gap_radius1 0.2 -gap_radius2 0.2"));
  PetscCall(SamGridCreate(PETSC_COMM_WORLD, n, width, center, &grid));
  PetscCall(SamPairSet(&pair, young, poisson));
  PetscCall(SamElasticityCreate(grid, &pair, &elasticity));
  PetscCall(SamGridCreateVec(grid, 1, &separation));
  PetscCall(SamGapCreate(PETSC_COMM_WORLD, &gap));
  PetscCall(SamGapSetFromOptions(gap));
  PetscCall(SamGapFill(gap, grid, separation));
  PetscCall(SamContactCreate(elasticity, separation, 0.1, &contact));
  PetscCall(SamContactSolve(contact, &step));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "status %d, approach %.6e m, tangential displacement %.6e m\n",
                        (int)step.status, (double)step.normal.rigid[0], (double)step.tangential.rigid[0]));
  PetscCall(SamContactDestroy(&contact));
  PetscCall(SamGapDestroy(&gap));
  PetscCall(VecDestroy(&separation));
  PetscCall(SamElasticityDestroy(&elasticity));
  PetscCall(SamGridDestroy(&grid));
  PetscCall(SamFinalize());
  return PetscFinalize();
}

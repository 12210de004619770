/* Two steel spheres pressed together by 1000 N and pushed sideways by 60 N: how far they move. */
#include <petsam.h>

int main(int argc, char **argv)
{
  const PetscInt    n[2]     = {256, 256};
  const PetscReal   width[2] = {2.6e-3, 2.6e-3}, center[2] = {0, 0};
  const SamMaterial steel = {.young = 210e9, .poisson = 0.3};
  SamBody           body;
  SamPair           bodies;
  SamGrid           grid;
  SamElasticity     elasticity;
  SamProblem        problem;
  SamGap            gap;
  SamContact        contact;
  SamControl        control;
  SamStep           step;
  Vec               separation;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(SamInitialize());
  PetscCall(SamGridCreate(PETSC_COMM_WORLD, n, width, center, &grid));
  PetscCall(SamBodyCreate(1, &steel, &body));
  PetscCall(SamPairCreate(body, body, &bodies));
  PetscCall(SamElasticityCreate(grid, bodies, &elasticity));
  PetscCall(SamProblemCreate(elasticity, &problem));
  PetscCall(SamProblemSetFriction(problem, 0.1));
  separation = SamProblemGetGap(problem);
  PetscCall(SamGapCreate(PETSC_COMM_WORLD, &gap));
  PetscCall(SamGapSetType(gap, SAM_GAP_SPHERE));
  PetscCall(SamGapSetParameter(gap, "radius1", 0.2));
  PetscCall(SamGapSetParameter(gap, "radius2", 0.2));
  PetscCall(SamGapSetFromOptions(gap)); /* -gap_radius1 and so on, where they are given */
  PetscCall(SamGapFill(gap, grid, separation));
  PetscCall(SamContactCreate(problem, &contact));

  PetscCall(SamControlInitialize(&control));
  PetscCall(SamControlSet(&control, NULL, "load_n", 1000));
  PetscCall(SamControlSet(&control, NULL, "load_tx", 60));
  PetscCall(SamContactTry(contact, &control, &step));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "status %d, approach %.6e m, tangential displacement %.6e m\n",
                        (int)step.status, (double)step.rigid[SAM_COMPONENT_N], (double)step.rigid[SAM_COMPONENT_TX]));
  if (!step.status) PetscCall(SamContactCommit(contact)); /* further steps go on from here */

  PetscCall(SamContactDestroy(&contact));
  PetscCall(SamGapDestroy(&gap));
  PetscCall(SamProblemDestroy(&problem));
  PetscCall(SamElasticityDestroy(&elasticity));
  PetscCall(SamPairDestroy(&bodies));
  PetscCall(SamBodyDestroy(&body));
  PetscCall(SamGridDestroy(&grid));
  PetscCall(SamFinalize());
  return PetscFinalize();
}

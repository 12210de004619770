/* The preconditioners of the influence operator: symmetry, and what a Krylov method gains by them. */
#include "elasticities.h"
#include "preconditioners.h"

#include <petsam/private/elasticityimpl.h>
#include <petscksp.h>

static void AssertPreconditioner(PetscInt components, Product precondition)
{
  const PetscInt n[][2] = {{16, 12}, {15, 9}, {7, 21}, {13, 11}, {5, 2}}; /* periods even and odd, equal to n and not */

  for (int k = 0; k < 5; k++) {
    SamGrid       grid = NewGrid(n[k][0], n[k][1], 3e-3, 1e-3);
    SamElasticity C    = NewDissimilar(grid);

    for (PetscInt seed = 0; seed < 5; seed++) {
      Vec x = NewRandom(grid, components, seed), y = NewRandom(grid, components, seed + 50), mx = Copy(x), my = Copy(y);
      double size;

      if (seed == 4) sam_call(VecSet(x, 1)); /* the mean has a gain as well */
      sam_call(precondition(C, x, mx));
      sam_call(precondition(C, my, my)); /* in place */
      size = Norm(x, NORM_2) * Norm(my, NORM_2) + Norm(y, NORM_2) * Norm(mx, NORM_2);
      sam_assert_close(Dot(x, my), Dot(y, mx), 1e-6 * size); /* rounding of single precision, summed up */
      sam_assert(Dot(x, mx) > 1e-3 * Norm(x, NORM_2) * Norm(mx, NORM_2));
      sam_assert(Dot(y, my) > 1e-3 * Norm(y, NORM_2) * Norm(my, NORM_2));
      sam_destroy(&x, &y, &mx, &my);
    }
    sam_call(SamElasticityDestroy(&C));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_normal_preconditioner_is_symmetric_positive(void **state)
{
  (void)state;
  AssertPreconditioner(1, PreconditionNormal);
}

static void test_tangential_preconditioner_is_symmetric_positive(void **state)
{
  (void)state;
  AssertPreconditioner(2, PreconditionTangential);
}

/* The operator and its preconditioner as PETSc's Mat and PC, by shells. */
static PetscErrorCode Multiply(Mat mat, Vec x, Vec y)
{
  void    *e;
  PetscInt n, cells;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(mat, &e));
  PetscCall(VecGetSize(x, &n));
  cells = ((SamElasticity)e)->grid->nx * ((SamElasticity)e)->grid->ny;
  PetscCall((n == cells ? SamElasticityApplyNormal : SamElasticityApplyTangential)((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Precondition(PC pc, Vec x, Vec y)
{
  void    *e;
  PetscInt n, cells;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &e));
  PetscCall(VecGetSize(x, &n));
  cells = ((SamElasticity)e)->grid->nx * ((SamElasticity)e)->grid->ny;
  PetscCall((n == cells ? PreconditionNormal : PreconditionTangential)((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Iterations of PETSc's CG for C x = random b to 1e-8, and the true residual. */
static PetscInt Iterations(PetscInt components, PetscInt nx, PetscInt ny, PetscBool precondition)
{
  SamGrid            grid = NewGrid(nx, ny, 3e-3, 2e-3);
  SamElasticity      C    = NewDissimilar(grid);
  Vec                b = NewRandom(grid, components, 3), x = NewField(grid, components), r = NewField(grid, components);
  const PetscInt     m = components * grid->cells;
  Mat                mat;
  PC                 pc;
  KSP                ksp;
  PetscInt           its;
  KSPConvergedReason reason;

  sam_call(MatCreateShell(PETSC_COMM_WORLD, m, m, PETSC_DETERMINE, PETSC_DETERMINE, C, &mat));
  sam_call(MatShellSetOperation(mat, MATOP_MULT, (void (*)(void))Multiply));
  sam_call(MatSetOption(mat, MAT_SYMMETRIC, PETSC_TRUE));
  sam_call(KSPCreate(PETSC_COMM_WORLD, &ksp));
  sam_call(KSPSetType(ksp, KSPCG));
  sam_call(KSPSetNormType(ksp, KSP_NORM_UNPRECONDITIONED));
  sam_call(KSPGetPC(ksp, &pc));
  sam_call(PCSetType(pc, precondition ? PCSHELL : PCNONE));
  if (precondition) {
    sam_call(PCShellSetContext(pc, C));
    sam_call(PCShellSetApply(pc, Precondition));
  }
  sam_call(KSPSetOperators(ksp, mat, mat));
  sam_call(KSPSetTolerances(ksp, 1e-8, 0, PETSC_DEFAULT, 500));
  sam_call(KSPSolve(ksp, b, x));
  sam_call(KSPGetConvergedReason(ksp, &reason));
  sam_call(KSPGetIterationNumber(ksp, &its));
  sam_assert(reason > 0);
  sam_call(MatMult(mat, x, r));
  sam_assert_close(Difference(r, b, NORM_2), 0, 2e-8); /* asked for 1e-8 of the recursive residual */
  sam_call(KSPDestroy(&ksp));
  sam_call(MatDestroy(&mat));
  sam_destroy(&b, &x, &r);
  sam_call(SamElasticityDestroy(&C));
  sam_call(SamGridDestroy(&grid));
  return its;
}

static void test_krylov_method_gains_by_the_preconditioner(void **state)
{
  (void)state;
  for (PetscInt components = 1; components <= 2; components++) {
    const PetscInt with    = Iterations(components, 48, 37, PETSC_TRUE),
                   without = Iterations(components, 48, 37, PETSC_FALSE);

    if (getenv("SAM_SHOW"))
      print_message("# CG %d components: %d with, %d without\n", (int)components, (int)with, (int)without);
    sam_assert(2 * with < without);
  }
}

static void test_preconditioned_iterations_do_not_grow_with_the_grid(void **state)
{
  (void)state;
  for (PetscInt components = 1; components <= 2; components++) {
    const PetscInt coarse = Iterations(components, 24, 16, PETSC_TRUE),
                   fine   = Iterations(components, 96, 64, PETSC_TRUE);

    if (getenv("SAM_SHOW"))
      print_message("# CG %d components: %d at 24, %d at 96\n", (int)components, (int)coarse, (int)fine);
    sam_assert(fine < coarse + 8); /* without it, twice as many for four times the cells */
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_normal_preconditioner_is_symmetric_positive),
    cmocka_unit_test(test_tangential_preconditioner_is_symmetric_positive),
    cmocka_unit_test(test_krylov_method_gains_by_the_preconditioner),
    cmocka_unit_test(test_preconditioned_iterations_do_not_grow_with_the_grid),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

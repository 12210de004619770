/* Sums over the ranks, and small symmetric systems that may be singular. */
#include "fields.h"

#include <petsam/private/baseimpl.h>

/* ---- sums ---- */

/* The numbers of a list, dealt out to the ranks in blocks. */
static double SumOf(PetscInt n, const double values[])
{
  PetscMPIInt rank, ranks;
  SamTotal    total = {0};
  double      sum;

  sam_call(SamInitialize());
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for (PetscInt k = n * rank / ranks; k < n * (rank + 1) / ranks; k++) SamAdd(&total, values[k]);
  sam_call(SamSumTotals(PETSC_COMM_WORLD, 1, &total, &sum));
  return sum;
}

/* Symmetric tractions have moments that are nothing but what their sums lose, and results depend on those. */
static void test_sum_that_nearly_vanishes_has_all_its_digits(void **state)
{
  enum { PAIRS = 500 };
  double       values[2 * PAIRS + 1];
  const double left[] = {0, 1.0 / 3, 1e-8 / 3, 1e-16 / 3, 1e-20 / 3};

  (void)state;
  for (int k = 0; k < 5; k++) {
    for (PetscInt i = 0; i < PAIRS; i++) {
      values[i]             = 1e6 * Random(3, 0, i, 0);
      values[2 * PAIRS - i] = -1e6 * Random(3, 0, (7 * i) % PAIRS, 0); /* 7 and 500: all of them, in another order */
    }
    values[PAIRS] = left[k];
    sam_assert(SumOf(2 * PAIRS + 1, values) == left[k]);
  }
}

/* ---- symmetric systems ---- */

/* Of rank r: A = sum of the squares of r vectors. The solution is the shortest with the least residual. */
static void test_singular_system_has_the_shortest_solution(void **state)
{
  (void)state;
  for (PetscInt n = 1; n <= SAM_SYMMETRIC_MAX; n++)
    for (PetscInt r = 0; r <= n; r++) {
      double A[SAM_SYMMETRIC_MAX * SAM_SYMMETRIC_MAX]   = {0}, copy[SAM_SYMMETRIC_MAX * SAM_SYMMETRIC_MAX],
                                   b[SAM_SYMMETRIC_MAX] = {0}, x[SAM_SYMMETRIC_MAX], seed[SAM_SYMMETRIC_MAX];

      for (PetscInt m = 0; m < r; m++)
        for (PetscInt i = 0; i < n; i++)
          for (PetscInt j = 0; j < n; j++) A[i * n + j] += Random(1, n, m, i) * Random(1, n, m, j);
      /* a right-hand side and a solution in the range: x = A seed, b = A x */
      for (PetscInt i = 0; i < n; i++) seed[i] = Random(2, n, r, i);
      for (PetscInt i = 0; i < n; i++) {
        x[i] = 0;
        for (PetscInt j = 0; j < n; j++) x[i] += A[i * n + j] * seed[j];
      }
      for (PetscInt i = 0; i < n; i++)
        for (PetscInt j = 0; j < n; j++) b[i] += A[i * n + j] * x[j];
      for (PetscInt i = 0; i < n; i++) seed[i] = x[i];
      for (PetscInt i = 0; i < n * n; i++) copy[i] = A[i];
      SamSolveSymmetric(n, copy, b, 1e-12, x);
      for (PetscInt i = 0; i < n; i++) sam_assert_close(x[i], seed[i], 1e-6); /* condition 1e8 at worst */
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sum_that_nearly_vanishes_has_all_its_digits),
    cmocka_unit_test(test_singular_system_has_the_shortest_solution),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
  CMocka under MPI. A plain assert that fails on one rank leaves the others waiting in a collective call. The asserts
  here agree on the outcome first, so that all ranks fail together. They are collective on PETSC_COMM_WORLD.
*/
#ifndef PETSAM_SAMTEST_H
#define PETSAM_SAMTEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include <petsam/base.h>

/* The first rank on which `ok` is 0, or -1; the caller's rank is stored too. */
static inline int SamFailingRank_(int ok, int *rank)
{
  int mine[2] = {ok ? 1 : 0, 0}, worst[2] = {0, 0}; /* outcome, rank */

  MPI_Comm_rank(PETSC_COMM_WORLD, &mine[1]);
  (void)MPI_Allreduce(mine, worst, 1, MPI_2INT, MPI_MINLOC, PETSC_COMM_WORLD);
  *rank = mine[1];
  return worst[0] ? -1 : worst[1];
}

/* Fails on all ranks when `ok` is 0 on any; rank 0 says where, and on which rank first. */
static inline void SamAssert_(int ok, const char *text, const char *file, int line)
{
  int       rank;
  const int failing = SamFailingRank_(ok, &rank);

  if (failing < 0) return;
  if (rank == 0) print_error("%s:%d: %s does not hold on rank %d\n", file, line, text, failing);
  fail();
}

#define sam_assert(cond) SamAssert_((cond) ? 1 : 0, #cond, __FILE__, __LINE__)
#define sam_assert_close(a, b, tol) \
  SamAssert_(fabs((double)(a) - (double)(b)) <= (double)(tol), "|" #a " - " #b "| <= " #tol, __FILE__, __LINE__)
#define sam_call(petsc_call_expr) SamAssert_((petsc_call_expr) == 0, #petsc_call_expr, __FILE__, __LINE__)

/* Starts PETSc, runs the tests, and returns what main() returns: 0 when no test failed on any rank. */
static inline int SamTestMain(int argc, char **argv, const struct CMUnitTest *tests, size_t n)
{
  int rank, failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank && (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)))
    MPI_Abort(PETSC_COMM_WORLD, 1);
  cmocka_set_message_output(CM_OUTPUT_STDOUT);
  failed = _cmocka_run_group_tests(argv[0], tests, n, NULL, NULL);
  (void)MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  if (SamFinalize() || PetscFinalize()) return 1;
  return failed ? 1 : 0;
}

#endif

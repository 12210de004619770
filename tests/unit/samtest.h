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

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

static inline int Rank(void)
{
  int rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

/* Destroys vectors; the last is NULL. */
static inline void SamDestroyVecs_(Vec *const vecs[])
{
  for (; *vecs; vecs++) sam_call(VecDestroy(*vecs));
}

#define sam_destroy(...) SamDestroyVecs_((Vec *const[]){__VA_ARGS__, NULL})

static inline int SamRanks_(void)
{
  int ranks;

  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  return ranks;
}

/* Ends a test here if there are several ranks: for long ones of errors and their orders, the same on any number. */
#define sam_on_one_rank() \
  do { \
    if (SamRanks_() > 1) skip(); \
  } while (0)

/* A folder of its own for the files of the tests, without those of a test that crashed. 0: all ranks are there. */
static inline int SamEnterFolder_(int rank, char folder[PETSC_MAX_PATH_LEN])
{
  const size_t size = PETSC_MAX_PATH_LEN - sizeof("/petsam_test_XXXXXX");
  int          good = 1;

  if (!rank) {
    good = getcwd(folder, size) != NULL;
    if (good) good = mkdtemp(strcat(folder, "/petsam_test_XXXXXX")) != NULL;
  }
  (void)MPI_Bcast(folder, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, PETSC_COMM_WORLD);
  good = good && !chdir(folder);
  (void)MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  return !good;
}

/* Removes the tests' folder and the files in it. */
static inline void SamRemoveFolder_(int rank, const char folder[])
{
  DIR           *list  = rank ? NULL : opendir(".");
  struct dirent *entry = NULL;

  while (list && (entry = readdir(list)))
    if (entry->d_type != DT_DIR) (void)unlink(entry->d_name);
  if (list) (void)closedir(list);
  if (!rank) (void)rmdir(folder);
}

/*
  Starts PETSc, calls `setup` (NULL: nothing), runs the tests, and returns what main() returns: 0 when no test failed on
  any rank.
*/
static inline int SamTestMainWith(int argc, char **argv, CMFixtureFunction setup, const struct CMUnitTest *tests,
                                  size_t n)
{
  char folder[PETSC_MAX_PATH_LEN] = "";
  int  rank, failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL) || SamInitialize()) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank && (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)))
    MPI_Abort(PETSC_COMM_WORLD, 1);
  cmocka_set_message_output(CM_OUTPUT_STDOUT);
  if (SamEnterFolder_(rank, folder)) MPI_Abort(PETSC_COMM_WORLD, 1);
  failed = _cmocka_run_group_tests(argv[0], tests, n, setup, NULL);
  (void)MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  SamRemoveFolder_(rank, folder);
  if (SamFinalize() || PetscFinalize()) return 1;
  return failed ? 1 : 0;
}

static inline int SamTestMain(int argc, char **argv, const struct CMUnitTest *tests, size_t n)
{
  return SamTestMainWith(argc, argv, NULL, tests, n);
}

/* Rank 0 removes a file of the test's folder, which all have done with; afterwards it is gone for all. */
static inline void RemoveFile(const char name[])
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!Rank()) (void)unlink(name);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* The options of the database are these and no others. */
static inline void SetOptions(const char options[])
{
  sam_call(PetscOptionsClear(NULL));
  sam_call(PetscOptionsInsertString(NULL, options));
}

/* The message of the first error since BeginCatching(). */
static inline char *CaughtMessage(void)
{
  static char message[4096];

  return message;
}

static inline PetscErrorCode KeepCaught(MPI_Comm comm, int line, const char *function, const char *file,
                                        PetscErrorCode code, PetscErrorType type, const char *text, void *context)
{
  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  (void)context;
  if (type == PETSC_ERROR_INITIAL && text && !CaughtMessage()[0]) (void)snprintf(CaughtMessage(), 4096, "%s", text);
  return code;
}

/* Between these, calls that fail return their error and keep its message instead of printing it. */
static inline void BeginCatching(void)
{
  CaughtMessage()[0] = '\0';
  sam_call(PetscPushErrorHandler(KeepCaught, NULL));
}

static inline void EndCatching(void)
{
  sam_call(PetscPopErrorHandler());
}

/* Asserts that a call fails with this error code, in a message that has these words; prints no trace. */
#define sam_says(petsc_call_expr, expected, words) \
  do { \
    PetscErrorCode sam_ierr_; \
    BeginCatching(); \
    sam_ierr_ = (petsc_call_expr); \
    EndCatching(); \
    if (!strstr(CaughtMessage(), words)) print_error("error %d: %s\n", (int)sam_ierr_, CaughtMessage()); \
    sam_assert(sam_ierr_ == (expected) && strstr(CaughtMessage(), words)); \
  } while (0)

/* The same of any message. */
#define sam_fails(petsc_call_expr, expected) \
  do { \
    PetscErrorCode sam_ierr_; \
    sam_call(PetscPushErrorHandler(PetscReturnErrorHandler, NULL)); \
    sam_ierr_ = (petsc_call_expr); \
    sam_call(PetscPopErrorHandler()); \
    sam_assert(sam_ierr_ == (expected)); \
  } while (0)

#endif

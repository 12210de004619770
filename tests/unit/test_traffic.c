/*
  The messages of transforms: those that MPI is asked to send, counted by functions that stand before its own, against
  the formula of the forecast.
*/
#include "fields.h"

#include <petsam/private/fourier.h>

static double sent, messages; /* bytes and number, to other ranks, so far */

static void Count(const int counts[], int count, MPI_Datatype type, MPI_Comm comm)
{
  int ranks, rank, size;

  (void)MPI_Comm_size(comm, &ranks);
  (void)MPI_Comm_rank(comm, &rank);
  (void)MPI_Type_size(type, &size);
  for (int r = 0; r < ranks; r++)
    if (r != rank) sent += (double)size * (counts ? counts[r] : count);
  messages += ranks - 1;
}

int(MPI_Alltoall)(const void *from, int count, MPI_Datatype type, void *to, int n, MPI_Datatype other, MPI_Comm comm)
{
  Count(NULL, count, type, comm);
  return PMPI_Alltoall(from, count, type, to, n, other, comm);
}

int(MPI_Alltoallv)(const void *from, const int counts[], const int at[], MPI_Datatype type, void *to, const int n[],
                   const int place[], MPI_Datatype other, MPI_Comm comm)
{
  Count(counts, 0, type, comm);
  return PMPI_Alltoallv(from, counts, at, type, to, n, place, other, comm);
}

int(MPI_Sendrecv)(const void *from, int count, MPI_Datatype type, int whom, int tag, void *to, int n,
                  MPI_Datatype other, int who, int label, MPI_Comm comm, MPI_Status *status)
{
  int rank, size;

  (void)MPI_Comm_rank(comm, &rank);
  (void)MPI_Type_size(type, &size);
  if (whom != rank) {
    sent += (double)size * count;
    messages++;
  }
  return PMPI_Sendrecv(from, count, type, whom, tag, to, n, other, who, label, comm, status);
}

static void Nothing(const SamFourierBlock *block, const void *context)
{
  (void)block;
  (void)context;
}

/* One pass of `fields` fields: the second one, since the first plans. */
static void Pass(SamFourier fourier, SamFourierMode mode, PetscInt fields, PetscBool single, PetscInt cells)
{
  const SamFourierFilter filter = {mode, fields, fields, Nothing, NULL};
  double                *in_double[2];
  float                 *in_single[2];

  for (int c = 0; c < 2; c++) {
    in_double[c] = calloc((size_t)cells + 1, sizeof(double));
    in_single[c] = calloc((size_t)cells + 1, sizeof(float));
  }
  for (int k = 0; k < 2; k++) {
    sent = messages = 0;
    if (single)
      sam_call(SamFourierApplySingle(fourier, &filter, (const float *const *)in_single, in_single));
    else
      sam_call(SamFourierApply(fourier, &filter, (const double *const *)in_double, in_double));
  }
  for (int c = 0; c < 2; c++) {
    free(in_double[c]);
    free(in_single[c]);
  }
}

static void AssertCounts(PetscInt nx, PetscInt ny, SamFourierPeriod period)
{
  const PetscInt     n[2]     = {nx, ny};
  SamFourierSettings settings = {.send = PETSC_TRUE};
  SamGrid            grid     = NewGrid(nx, ny, 1, 1);
  SamFourier         fourier;
  int                ranks;

  (void)MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  sam_call(SamFourierCreate(grid, period, &settings, &fourier));
  for (int mode = period == SAM_FOURIER_EXACT ? SAM_FOURIER_PERIODIC : SAM_FOURIER_PADDED, k = 0; k < 4; k++) {
    const PetscInt          fields = 1 + k / 2;
    const PetscBool         single = k % 2 ? PETSC_TRUE : PETSC_FALSE;
    const SamFourierTraffic one =
      SamFourierCountTraffic(n, period, (SamFourierMode)mode, single ? sizeof(float) : sizeof(double), ranks, Rank());

    Pass(fourier, (SamFourierMode)mode, fields, single, grid->rows * nx);
    sam_assert(sent == (double)fields * one.bytes);
    /* on many ranks some messages to ranks without lines are left out */
    sam_assert(messages <= (double)fields * one.messages);
    sam_assert(messages == (double)fields * one.messages || ranks > 5);
  }
  sam_call(SamFourierDestroy(&fourier));
  sam_call(SamGridDestroy(&grid));
}

static void test_messages_are_those_of_the_formula(void **state)
{
  (void)state;
  AssertCounts(16, 24, SAM_FOURIER_FAST);
  AssertCounts(37, 41, SAM_FOURIER_FAST);
  AssertCounts(300, 301, SAM_FOURIER_FAST); /* padded */
  AssertCounts(30, 32, SAM_FOURIER_EXACT);
  AssertCounts(31, 27, SAM_FOURIER_EXACT);
  AssertCounts(40, 4, SAM_FOURIER_FAST); /* on 5 ranks one is without rows */
  AssertCounts(9, 2, SAM_FOURIER_FAST);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_messages_are_those_of_the_formula)};

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

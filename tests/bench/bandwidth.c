/*
  Memory bandwidth of all ranks together, as in STREAM's triad (J. D. McCalpin, 1995): a = b + s c.

      build/bench/bandwidth [-megabytes 512] [-repeats 9]

  Every rank takes its share of the three arrays, which together have that size: far more than the caches. Prints the
  bytes that the loop names, 24 an element (a store that first reads its line moves 32), over the best time.
*/
#include <petsam/base.h>
#include <math.h>

static double Triad(PetscInt n, double a[], const double b[], const double c[], double s)
{
  const double start = MPI_Wtime();

  for (PetscInt i = 0; i < n; i++) a[i] = b[i] + s * c[i];
  return MPI_Wtime() - start;
}

/* The slowest rank's time of the best repeat, seconds. */
static PetscErrorCode Best(PetscInt n, PetscInt repeats, double *best)
{
  double *a, *b, *c;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(n, &a, n, &b, n, &c));
  for (PetscInt i = 0; i < n; i++) {
    a[i] = 0;
    b[i] = 1;
    c[i] = 2;
  }
  *best = INFINITY;
  for (PetscInt k = 0; k < repeats; k++) {
    double seconds;

    PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
    seconds = Triad(n, a, b, c, 0.5 + (double)k);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
    *best = PetscMin(*best, seconds);
    PetscCheck(a[n / 2] == 1 + 2 * (0.5 + (double)k), PETSC_COMM_SELF, PETSC_ERR_PLIB, "wrong sum");
  }
  PetscCall(PetscFree3(a, b, c));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt    megabytes = 512, repeats = 9, n;
  PetscMPIInt ranks;
  double      seconds = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-megabytes", &megabytes, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeats", &repeats, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  n = megabytes * (1000000 / (3 * (PetscInt)sizeof(double))) / ranks;
  PetscCall(Best(n, repeats, &seconds));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%d ranks  %.2f GB/s\n", (int)ranks,
                        3e-9 * (double)sizeof(double) * (double)n * (double)ranks / seconds));
  PetscCall(PetscFinalize());
  return 0;
}

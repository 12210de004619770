/*
  Time of one convolution, against the plain way: a padded two-dimensional array, FFTW's r2c, a multiplication, c2r.

      build/bench/convolution [-sizes 512,1024,2048] [-repeats 9]

  On one rank prints for each size the seconds of both (median) and their ratio; both planned by the same -fft_effort
  measure. On several ranks the plain way is FFTW's MPI transform of the padded array.
*/
#include <petsam/private/fourier.h>
#include <fftw3-mpi.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void InverseDistance(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  (void)context;
  for (PetscInt i = 0; i < n; i++) values[0][i] = 1 / (sqrt((double)i * (double)i + (double)j * (double)j) + 0.5);
}

static int Compare(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;

  return (x > y) - (x < y);
}

typedef struct {
  SamFourier      fourier;
  SamKernelMatrix matrix;
  const double   *in;
  double         *out;
} Pruned;

static PetscErrorCode RunPruned(void *context)
{
  Pruned *p = (Pruned *)context;

  PetscFunctionBegin;
  PetscCall(SamConvolve(p->fourier, &p->matrix, &p->in, &p->out));
  PetscFunctionReturn(0);
}

typedef struct {
  fftw_plan     forward, backward;
  fftw_complex *spectrum;
  double       *kernel; /* real spectrum */
  ptrdiff_t     points;
} Padded;

static PetscErrorCode RunPadded(void *context)
{
  Padded *p            = (Padded *)context;
  double(*spectrum)[2] = (double(*)[2])p->spectrum;

  PetscFunctionBegin;
  fftw_execute(p->forward);
  for (ptrdiff_t k = 0; k < p->points; k++) {
    spectrum[k][0] *= p->kernel[k];
    spectrum[k][1] *= p->kernel[k];
  }
  fftw_execute(p->backward);
  PetscFunctionReturn(0);
}

/* Median seconds of `repeats` runs, the slowest rank's. */
static PetscErrorCode Time(PetscErrorCode (*run)(void *), void *context, PetscInt repeats, double *median)
{
  double *seconds;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(repeats, &seconds));
  PetscCall(run(context));
  for (PetscInt k = 0; k < repeats; k++) {
    double start;

    PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
    start = MPI_Wtime();
    PetscCall(run(context));
    seconds[k] = MPI_Wtime() - start;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &seconds[k], 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  }
  qsort(seconds, (size_t)repeats, sizeof(*seconds), Compare);
  *median = seconds[repeats / 2];
  PetscCall(PetscFree(seconds));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimePruned(PetscInt n, PetscInt repeats, double *seconds)
{
  const PetscInt     cells[2]  = {n, n};
  const PetscReal    width[2]  = {1, 1};
  const PetscReal    center[2] = {0, 0};
  const SamOptions   from      = {PETSC_COMM_WORLD, NULL};
  SamFourierSettings settings  = {.send = PETSC_FALSE};
  SamGrid            grid;
  Vec                in, out;
  Pruned             p;

  PetscFunctionBegin;
  memset(&p, 0, sizeof(p));
  PetscCall(SamGridCreate(PETSC_COMM_WORLD, cells, width, center, &grid));
  PetscCall(SamFourierSettingsFromOptions(&settings, &from));
  PetscCall(SamFourierCreate(grid, SAM_FOURIER_FAST, &settings, &p.fourier));
  p.matrix.n_in = p.matrix.n_out = 1;
  p.matrix.scale[0][0]           = 1;
  PetscCall(SamKernelsCreate(p.fourier, 1, (const PetscBool[][2]){{PETSC_FALSE, PETSC_FALSE}}, InverseDistance, NULL,
                             &p.matrix.kernel[0][0]));
  PetscCall(SamGridCreateVec(grid, 1, &in));
  PetscCall(SamGridCreateVec(grid, 1, &out));
  PetscCall(VecSet(in, 1));
  PetscCall(VecGetArrayRead(in, &p.in));
  PetscCall(VecGetArrayWrite(out, &p.out));
  PetscCall(Time(RunPruned, &p, repeats, seconds));
  PetscCall(VecRestoreArrayRead(in, &p.in));
  PetscCall(VecRestoreArrayWrite(out, &p.out));
  PetscCall(VecDestroy(&in));
  PetscCall(VecDestroy(&out));
  PetscCall(SamKernelDestroy(&p.matrix.kernel[0][0]));
  PetscCall(SamFourierDestroy(&p.fourier));
  PetscCall(SamGridDestroy(&grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimePadded(PetscInt n, PetscInt repeats, double *seconds)
{
  const ptrdiff_t N = 2 * n;
  ptrdiff_t       local, start, local_t, start_t, size;
  double         *field;
  Padded          p;

  PetscFunctionBegin;
  size       = fftw_mpi_local_size_2d_transposed(N, N / 2 + 1, PETSC_COMM_WORLD, &local, &start, &local_t, &start_t);
  p.spectrum = fftw_alloc_complex((size_t)size);
  field      = fftw_alloc_real((size_t)(2 * size));
  p.kernel   = fftw_alloc_real((size_t)size);
  p.points   = local_t * N;
  {
    PetscMPIInt ranks;

    PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
    if (ranks > 1) {
      p.forward =
        fftw_mpi_plan_dft_r2c_2d(N, N, field, p.spectrum, PETSC_COMM_WORLD, FFTW_MEASURE | FFTW_MPI_TRANSPOSED_OUT);
      p.backward =
        fftw_mpi_plan_dft_c2r_2d(N, N, p.spectrum, field, PETSC_COMM_WORLD, FFTW_MEASURE | FFTW_MPI_TRANSPOSED_IN);
    } else {
      p.forward  = fftw_plan_dft_r2c_2d((int)N, (int)N, field, p.spectrum, FFTW_MEASURE);
      p.backward = fftw_plan_dft_c2r_2d((int)N, (int)N, p.spectrum, field, FFTW_MEASURE);
      p.points   = N * (N / 2 + 1);
    }
  }
  for (ptrdiff_t k = 0; k < 2 * size; k++) field[k] = 1e-3;
  for (ptrdiff_t k = 0; k < p.points; k++) p.kernel[k] = 1 / (double)(N * N);
  PetscCall(Time(RunPadded, &p, repeats, seconds));
  fftw_destroy_plan(p.forward);
  fftw_destroy_plan(p.backward);
  fftw_free(field);
  fftw_free(p.kernel);
  fftw_free(p.spectrum);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt sizes[16] = {512, 1024, 2048}, count = 16, repeats = 9;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(SamInitialize());
  {
    PetscBool given;

    PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-sizes", sizes, &count, &given));
    if (!given) count = 3;
    PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeats", &repeats, NULL));
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  cells  padded FFTW [s]    petsam [s]   ratio\n"));
  for (PetscInt k = 0; k < count; k++) {
    double pruned, padded;

    PetscCall(TimePadded(sizes[k], repeats, &padded));
    PetscCall(TimePruned(sizes[k], repeats, &pruned));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%7" PetscInt_FMT "  %15.7f  %12.7f  %6.3f\n", sizes[k], padded, pruned,
                          pruned / padded));
  }
  PetscCall(SamFinalize());
  PetscCall(PetscFinalize());
  return 0;
}

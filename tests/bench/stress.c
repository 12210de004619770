/*
  Time of stresses under a sliding sphere (half width of the grid 1.3 contact radii), beside one convolution and beside
  direct summation, on one rank.

      build/bench/stress [-sizes 512,1024] [-repeats 5] [-depths 64] [-states 40]

  Prints medians of seconds: one convolution; a map at a new depth, and its further steps; a section, and its further
  steps; the Smith-Watson-Topper parameter of a cycle of so many states on that section. Direct summation, as in codes
  without transforms, evaluates the kernels for every pair of a point and a cell in contact: its time is the number of
  pairs times the measured time of one pair. Memory: what a map needs, bytes a cell (of the first size).
*/
#include <petsam/private/fatigue.h>
#include <petsam/private/fourier.h>
#include <petsam/private/halfspace.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#define HALF_WIDTH 1.3
#define POISSON    0.3
#define FRICTION   0.5
#define PAIRS      200000

static int Compare(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;

  return (x > y) - (x < y);
}

static double Median(PetscInt n, double seconds[])
{
  qsort(seconds, (size_t)n, sizeof(*seconds), Compare);
  return seconds[n / 2];
}

/* Hertz's pressure, and a part of the shear by full sliding, into arrays of cells. */
static void Load(SamGrid grid, double sliding, double p[], double qx[], double qy[])
{
  for (PetscInt k = 0; k < grid->cells; k++) {
    const double x = SamGridX(grid, k % grid->nx), y = SamGridY(grid, k / grid->nx), r2 = x * x + y * y;

    p[k]  = r2 < 1 ? sqrt(1 - r2) : 0;
    qx[k] = sliding * FRICTION * p[k];
    qy[k] = 0;
  }
}

static PetscErrorCode NewGrid(PetscInt n, SamGrid *grid)
{
  const PetscInt  cells[2]  = {n, n};
  const PetscReal width[2]  = {2 * HALF_WIDTH, 2 * HALF_WIDTH};
  const PetscReal center[2] = {0, 0};

  PetscFunctionBegin;
  PetscCall(SamGridCreate(PETSC_COMM_WORLD, cells, width, center, grid));
  PetscFunctionReturn(0);
}

static void Ones(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  (void)j;
  (void)context;
  for (PetscInt i = 0; i < n; i++) values[0][i] = 1;
}

static PetscErrorCode TimeConvolution(SamGrid grid, PetscInt repeats, double *median)
{
  SamFourier      fourier;
  SamKernelMatrix matrix = {.n_in = 1, .n_out = 1, .scale = {{1}}};
  double         *in, *out, seconds[64];

  PetscFunctionBegin;
  PetscCall(SamFourierCreate(grid, SAM_FOURIER_FAST, NULL, &fourier));
  PetscCall(
    SamKernelsCreate(fourier, 1, (const PetscBool[][2]){{PETSC_FALSE, PETSC_FALSE}}, Ones, NULL, &matrix.kernel[0][0]));
  PetscCall(PetscMalloc2(grid->cells, &in, grid->cells, &out));
  for (PetscInt k = 0; k < grid->cells; k++) in[k] = 1;
  for (PetscInt k = -1; k < repeats; k++) {
    const double start = MPI_Wtime();

    PetscCall(SamConvolve(fourier, &matrix, (const double *const *)&in, &out));
    if (k >= 0) seconds[k] = MPI_Wtime() - start;
  }
  *median = Median(repeats, seconds);
  PetscCall(PetscFree2(in, out));
  PetscCall(SamKernelDestroy(&matrix.kernel[0][0]));
  PetscCall(SamFourierDestroy(&fourier));
  PetscFunctionReturn(0);
}

/* A map at a new depth, and a further step; bytes a cell that it needs. */
static PetscErrorCode TimeMap(SamGrid grid, PetscInt repeats, double *first, double *further, double *bytes)
{
  double        seconds[2][64], *a;
  struct rusage before, after;
  SamStress     stress;
  Vec           field;

  PetscFunctionBegin;
  (void)getrusage(RUSAGE_SELF, &before);
  PetscCall(SamHalfSpaceCreateStress(grid, NULL, 2, POISSON, &stress));
  PetscCall(SamGridCreateVec(grid, SAM_STRESS_COMPONENTS, &field));
  for (PetscInt k = -1; k < repeats; k++)
    for (int step = 0; step < 2; step++) {
      double start;

      PetscCall(VecGetArray(field, &a));
      Load(grid, 1, a + SAM_STRESS_ZZ * grid->cells, a + SAM_STRESS_XZ * grid->cells, a + SAM_STRESS_YZ * grid->cells);
      PetscCall(VecRestoreArray(field, &a));
      start = MPI_Wtime();
      if (!step) PetscCall(SamStressSetDepth(stress, 0.1 + 0.01 * (double)k));
      PetscCall(SamStressApply(stress, field));
      if (k >= 0) seconds[step][k] = MPI_Wtime() - start;
    }
  *first   = Median(repeats, seconds[0]);
  *further = Median(repeats, seconds[1]);
  (void)getrusage(RUSAGE_SELF, &after);
  *bytes = 1024. * (double)(after.ru_maxrss - before.ru_maxrss) / (double)grid->cells;
  PetscCall(VecDestroy(&field));
  PetscCall(SamStressDestroy(&stress));
  PetscFunctionReturn(0);
}

/* The stresses of `states` steps of a cycle on the middle row, (state, component, depth, cell); the time. */
static PetscErrorCode ComputeSection(SamGrid grid, PetscInt depths, PetscInt states, double *stress, double *seconds)
{
  const double start  = MPI_Wtime();
  double       waited = 0, *a;
  PetscReal   *depth;
  SamStress    body;
  SamSection   section;
  Vec          tractions;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(depths, &depth));
  for (PetscInt k = 0; k < depths; k++) depth[k] = 1.5 * (double)k / (double)PetscMax(depths - 1, 1);
  PetscCall(SamGridCreateVec(grid, SAM_STRESS_TRACTIONS, &tractions));
  PetscCall(SamHalfSpaceCreateStress(grid, NULL, 2, POISSON, &body));
  PetscCall(SamSectionCreate(body, SAM_SECTION_X, grid->ny / 2, depths, depth, &section));
  for (PetscInt s = 0; s < states; s++) {
    const double now = MPI_Wtime();

    PetscCall(VecGetArray(tractions, &a));
    Load(grid, cos(2 * PETSC_PI * (double)s / (double)states), a, a + grid->cells, a + 2 * grid->cells);
    PetscCall(VecRestoreArray(tractions, &a));
    waited += MPI_Wtime() - now;
    PetscCall(SamSectionAddStep(section, tractions));
  }
  PetscCall(SamSectionCompute(section, stress));
  *seconds = MPI_Wtime() - start - waited;
  PetscCall(SamSectionDestroy(&section));
  PetscCall(SamStressDestroy(&body));
  PetscCall(VecDestroy(&tractions));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeSection(SamGrid grid, PetscInt depths, PetscInt repeats, double *first, double *further)
{
  double seconds[2][64], *stress;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * SAM_STRESS_COMPONENTS * depths * grid->nx, &stress));
  for (PetscInt k = 0; k < repeats; k++) {
    PetscCall(ComputeSection(grid, depths, 1, stress, &seconds[0][k]));
    PetscCall(ComputeSection(grid, depths, 3, stress, &seconds[1][k]));
  }
  *first   = Median(repeats, seconds[0]);
  *further = 0.5 * (Median(repeats, seconds[1]) - *first);
  PetscCall(PetscFree(stress));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeFatigue(SamGrid grid, PetscInt depths, PetscInt states, double *seconds)
{
  const SamFatigueConstants constants = {.young = 200, .poisson = POISSON};
  const PetscInt            points    = depths * grid->nx;
  double                   *stress, *one, *scratch, value, start, normal[3];

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(states * SAM_STRESS_COMPONENTS * points, &stress, states * SAM_STRESS_COMPONENTS, &one,
                         states * SAM_FATIGUE_SCRATCH, &scratch));
  PetscCall(ComputeSection(grid, depths, states, stress, &value));
  start = MPI_Wtime();
  for (PetscInt i = 0; i < points; i++) {
    for (PetscInt s = 0; s < states; s++)
      for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++)
        one[c * states + s] = stress[(s * SAM_STRESS_COMPONENTS + c) * points + i];
    (void)SamFatigueSWT(&(SamFatigueCycle){&constants, states, one, NULL, scratch}, normal);
  }
  *seconds = MPI_Wtime() - start;
  PetscCall(PetscFree3(stress, one, scratch));
  PetscFunctionReturn(0);
}

/* Seconds of one evaluation of all kernels for one pair, at distances of up to 200 cells. */
static double TimePair(void)
{
  const PetscReal side[2] = {1, 1};
  const double    start   = MPI_Wtime();
  PetscReal       stress[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS];

  for (int k = 0; k < PAIRS; k++)
    SamHalfSpaceStressCell(side, POISSON, (const PetscReal[]){k % 200, (k / 200) % 200, 20}, stress);
  return (MPI_Wtime() - start) / PAIRS;
}

static PetscErrorCode Measure(PetscInt n, PetscInt repeats, PetscInt depths, PetscInt states, PetscBool memory)
{
  const double contact = PETSC_PI / 4 * pow((double)n / HALF_WIDTH, 2), pair = TimePair();
  double       convolution = 0, map[2], bytes, section[2], swt = 0;
  SamGrid      grid;

  PetscFunctionBegin;
  PetscCall(NewGrid(n, &grid));
  PetscCall(TimeMap(grid, repeats, &map[0], &map[1], &bytes));
  PetscCall(TimeConvolution(grid, repeats, &convolution));
  PetscCall(TimeSection(grid, depths, repeats, &section[0], &section[1]));
  PetscCall(TimeFatigue(grid, depths, states, &swt));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "%6" PetscInt_FMT "  %11.4f  %7.3f  %7.3f  %11.0f  %7.3f  %7.3f  %11.0f  %7.2f", n, convolution,
                        map[0], map[1], pair * contact * (double)n * (double)n, section[0], section[1],
                        pair * contact * (double)n * (double)depths, swt));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, memory ? "  %12.0f\n" : "\n", bytes));
  PetscCall(SamGridDestroy(&grid));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt  sizes[16] = {512, 1024}, count = 16, repeats = 5, depths = 64, states = 40;
  PetscBool given;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(SamInitialize());
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-sizes", sizes, &count, &given));
  if (!given) count = 2;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeats", &repeats, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-depths", &depths, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-states", &states, NULL));
  repeats = PetscMax(1, PetscMin(repeats, 64));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        " [seconds]          map of six stresses              section of all depths\n"
                        " cells  convolution      new  further       direct      new  further       direct      "
                        "SWT  bytes a cell\n"));
  for (PetscInt k = 0; k < count; k++) PetscCall(Measure(sizes[k], repeats, depths, states, !k));
  PetscCall(SamFinalize());
  PetscCall(PetscFinalize());
  return 0;
}

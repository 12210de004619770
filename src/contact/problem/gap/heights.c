/*
  Examines heights from a file for a wrong unit and for a tilt. A tilt of a periodic surface makes a step at the border.

  The heights are the separation without the shape. Their tilt along an axis is fitted by least squares to the means of
  the lines across the axis. Waves may be tilted by this measure, too, but they continue over the border. So the smaller
  of two rises counts: the rise of the tilt over the period, and the rise of the means from the first line to the last.

  A difference between neighbouring cells is a step if the differences beside it, two cells on, are less than a quarter
  of it. Rough surfaces have a few such differences, too. So steps count only if they make up most of the squared slope:
  they are a sixth of it in white noise, and nearly all of it for a wall in a smooth surface. At a step in contact the
  pressure grows like E* times its height over the cells' width, until its lower side is open, and like the square root
  of that quotient beyond; it grows without limit on finer grids.
*/
#include <petsam/private/pressed.h>
#include <petsam/private/gapimpl.h>
#include <petsam/private/rows.h>
#include <petsam/private/gap.h>
#include <math.h>
#include <string.h>

/* Largest rms slope for which half-space theory is taken to hold */
#define STEEPEST 0.5
/* Largest ratio of the differences beside a step to the step; least part of the squared slope at which steps count */
#define BESIDE 0.25
#define MOSTLY 0.5
/* Steps with a larger E* (step)/(cell width), relative to the largest pressure, change the pressure. */
#define HIGH 0.2

typedef struct {
  double range, rms, slope; /* m: largest minus smallest; about the mean; rms of the gradient but for steps */
  double steps;             /* part of the squared slope that steps have */
  double rise[2];           /* m: over the period in x, y */
} Heights;

/* Returns the difference across the face before cell i of row j along an axis; 0 beyond the grid. */
static double DifferenceAt(const SamHalo *seen, SamGrid grid, PetscInt axis, PetscInt i, PetscInt j)
{
  const PetscInt at = axis ? j : i, n = axis ? grid->ny : grid->nx;

  return at < 1 || at >= n ? 0 : SamHaloAt(seen, 0, i, j) - SamHaloAt(seen, 0, i - !axis, j - axis);
}

/* Returns a difference if it is a step beside those of two cells before and after it, else 0. */
static inline double StepOf(double difference, double before, double after)
{
  const double beside = fabs(before) > fabs(after) ? fabs(before) : fabs(after);

  return beside < BESIDE * fabs(difference) ? difference : 0;
}

/* Returns the same difference across a face if it is a step, else 0. */
static double StepAt(const SamHalo *seen, SamGrid grid, PetscInt axis, PetscInt i, PetscInt j)
{
  const PetscInt along = axis ? 0 : 2, across = axis ? 2 : 0;

  return StepOf(DifferenceAt(seen, grid, axis, i, j), DifferenceAt(seen, grid, axis, i - along, j - across),
                DifferenceAt(seen, grid, axis, i + along, j + across));
}

/* Fills in the differences across the faces before the cells of row j along an axis; 0 beyond the grid. */
static void FillDifferences(const SamHalo *seen, SamGrid grid, PetscInt axis, PetscInt j, double difference[])
{
  const double *row, *before;

  (void)memset(difference, 0, sizeof(*difference) * (size_t)grid->nx);
  if (axis && (j < 1 || j >= grid->ny)) return;
  row    = seen->at[0] + (ptrdiff_t)(j - seen->rows.first) * grid->nx;
  before = axis ? row - grid->nx : row - 1;
  for (PetscInt i = axis ? 0 : 1; i < grid->nx; i++) difference[i] = row[i] - before[i];
}

/* Adds the squares of a row's n differences, and of those that are steps. */
SAM_VECTORIZED static void AddDifferences(PetscInt n, const double *step, const double *one, const double *other,
                                          double squares[2])
{
  double all = 0, steps = 0;

#pragma omp simd reduction(+ : all, steps)
  for (PetscInt i = 0; i < n; i++) {
    const double of = StepOf(step[i], one[i], other[i]);

    all += step[i] * step[i];
    steps += of * of;
  }
  squares[0] += all;
  squares[1] += steps;
}

/* Adds the squares of a row's heights; adds the heights to the sums of columns, and returns their sum. */
SAM_VECTORIZED static double AddHeights(PetscInt n, const double *restrict h, double *restrict columns, double *square)
{
  double sum = 0, squares = 0;

#pragma omp simd reduction(+ : sum, squares)
  for (PetscInt i = 0; i < n; i++) {
    sum += h[i];
    squares += h[i] * h[i];
    columns[i] += h[i];
  }
  *square += squares;
  return sum;
}

/* Adds up the squares of the heights, of their gradient and of its part by steps; sums the heights of columns and
   rows. */
static PetscErrorCode AddUp(const SamHalo *seen, SamGrid grid, double square[3], double sums[])
{
  const PetscReal cell[2] = {grid->dx, grid->dy};
  const PetscInt  nx      = grid->nx;
  double         *rows[3];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(PetscCalloc1(nx + 4, &rows[k])); /* two zeros on each side */
  for (PetscInt j = grid->row_start; j < grid->row_start + grid->rows; j++) {
    sums[nx + j] += AddHeights(nx, seen->own + (ptrdiff_t)(j - grid->row_start) * nx, sums, &square[0]);
    for (PetscInt d = 0; d < grid->axes; d++) {
      double squares[2] = {0, 0};

      for (PetscInt k = d ? -1 : 0; k <= d; k++) FillDifferences(seen, grid, d, j + 2 * k, rows[k + 1] + 2);
      AddDifferences(nx, rows[1] + 2, d ? rows[0] + 2 : rows[1], d ? rows[2] + 2 : rows[1] + 4, squares);
      for (int k = 0; k < 2; k++) square[k + 1] += squares[k] / (cell[d] * cell[d]);
    }
  }
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(rows[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the rise over n lines with these means. */
static double Rise(const double mean[], PetscInt n)
{
  const double step = mean[n - 1] - mean[0];
  double       sum = 0, squares = 0, tilt;

  for (PetscInt k = 0; k < n; k++) {
    const double x = (double)k + 0.5 - 0.5 * (double)n;

    sum += x * mean[k];
    squares += x * x;
  }
  tilt = sum / squares * (double)n;
  return tilt * step > 0 ? PetscMin(fabs(tilt), fabs(step)) : 0;
}

/* Measures heights and subtracts their mean. */
static PetscErrorCode Measure(SamGrid grid, Vec heights, Heights *found)
{
  const PetscInt n[2]  = {grid->nx, grid->ny};
  const double   cells = (double)n[0] * (double)n[1];
  PetscReal      mean, ends[2];
  double        *sums, square[3] = {0, 0, 0};
  SamHalo        seen;

  PetscFunctionBegin;
  PetscCall(VecMin(heights, NULL, &ends[0]));
  PetscCall(VecMax(heights, NULL, &ends[1]));
  PetscCall(VecMean(heights, &mean));
  PetscCall(VecShift(heights, -mean));
  PetscCall(PetscCalloc1(n[0] + n[1], &sums));
  PetscCall(SamHaloBegin(grid, heights, 1, 3, PETSC_FALSE, &seen));
  PetscCall(AddUp(&seen, grid, square, sums));
  PetscCall(SamHaloEnd(&seen));
  PetscCall(SamSum(grid->comm, 3, square));
  PetscCall(SamSum(grid->comm, n[0] + n[1], sums));
  for (PetscInt k = 0; k < n[0] + n[1]; k++) sums[k] /= (double)n[k < n[0]];
  *found = (Heights){.range = ends[1] - ends[0], .rms = sqrt(square[0] / cells)};
  if (square[1] > 0) found->steps = square[2] / square[1];
  if (found->steps > MOSTLY) square[1] -= square[2];
  found->slope = sqrt(square[1] / cells);
  for (PetscInt d = 0; d < grid->axes; d++) found->rise[d] = Rise(sums + d * n[0], n[d]);
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Describes what is doubtful; `certain`: the heights are of another unit, whatever the bodies. */
static void Describe(const Heights *h, SamGrid grid, PetscBool periodic, PetscBool *certain, char text[], size_t size)
{
  static const char unit[] = "check the unit of the dataset: its attribute units (mm, um); without it, m";

  const double   width = (double)PetscMax(grid->width[0], grid->width[1]);
  const PetscInt axis  = h->rise[1] > h->rise[0];
  size_t         used;

  *certain = h->range > width ? PETSC_TRUE : PETSC_FALSE;
  if (*certain)
    (void)snprintf(text, size, "the heights vary by %.3g m, more than the grid's width of %.3g m: %s", h->range, width,
                   unit);
  else if (h->slope > STEEPEST)
    (void)snprintf(text, size, "the rms slope of the heights is %.2g, half-spaces allow about %g: %s", h->slope,
                   STEEPEST, unit);
  used = strlen(text);
  if (periodic && h->rise[axis] > h->rms)
    (void)snprintf(text + used, size - used,
                   "%sthe heights rise by %.2g m along %s, a step at the border of the period, and have an rms of %.2g "
                   "m: remove the tilt by petsam-surface --level tilt",
                   used ? "; " : "", h->rise[axis], axis ? "y" : "x", h->rms);
}

/* Computes the heights without the shape; NULL if no heights are from a file. */
static PetscErrorCode CreateHeights(SamGap gap, SamGrid grid, Vec h, Vec *heights)
{
  PetscScalar *array;

  PetscFunctionBegin;
  *heights = NULL;
  if (!SamGapHasFile(gap)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(h, heights));
  PetscCall(VecCopy(h, *heights));
  PetscCall(VecGetArray(*heights, &array));
  for (PetscInt c = 0; c < grid->cells; c++)
    array[c] -= SamGapGetHeight(gap, SamGridX(grid, c % grid->nx), SamGridY(grid, grid->row_start + c / grid->nx));
  PetscCall(VecRestoreArray(*heights, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a warning about the file of the heights. */
static void Blame(SamGap gap, const char doubt[], char text[], size_t size)
{
  const SamFieldFile *file = SamGapIsFromFile(gap, PETSC_FALSE) ? &gap->source : &gap->rough;

  (void)snprintf(text, size, "-%s%s %s, %s: %s", gap->prefix, file->file_option, file->file, file->dataset, doubt);
}

PetscErrorCode SamGapAdvise(SamGap gap, SamGrid grid, Vec h, PetscBool periodic, PetscBool *certain, char text[],
                            size_t size)
{
  Vec     heights;
  Heights found      = {.range = 0};
  char    doubt[400] = "";

  PetscFunctionBegin;
  *certain = PETSC_FALSE;
  text[0]  = '\0';
  PetscCall(CreateHeights(gap, grid, h, &heights));
  if (!heights) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Measure(grid, heights, &found));
  PetscCall(VecDestroy(&heights));
  Describe(&found, grid, periodic, certain, doubt, sizeof(doubt));
  if (doubt[0]) Blame(gap, doubt, text, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds the highest step in contact or beside it, and its place on the grid: the cell and the axis of its face.
*/
static PetscErrorCode FindStep(SamGrid grid, Vec heights, Vec pressure, double *most, double *place)
{
  SamHalo h, p;

  PetscFunctionBegin;
  *most  = 0;
  *place = -1;
  PetscCall(SamHaloBegin(grid, heights, 1, 3, PETSC_FALSE, &h));
  PetscCall(SamHaloBegin(grid, pressure, 1, 1, PETSC_FALSE, &p));
  for (PetscInt c = 0; c < 2 * grid->cells; c++) {
    const PetscInt axis = c % 2, i = c / 2 % grid->nx, j = grid->row_start + c / 2 / grid->nx;
    double         step;

    if (axis >= grid->axes || (!SamIsPressed(p.own[c / 2]) && !SamIsPressed(SamHaloAt(&p, 0, i - !axis, j - axis))))
      continue;
    step = fabs(StepAt(&h, grid, axis, i, j));
    if (step > *most) *place = 2 * ((double)j * (double)grid->nx + (double)i) + (double)axis;
    *most = PetscMax(*most, step);
  }
  PetscCall(SamHaloEnd(&p));
  PetscCall(SamHaloEnd(&h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapAdviseStep(SamGap gap, SamGrid grid, Vec h, Vec pressure, double modulus, char text[], size_t size)
{
  Vec       heights;
  Heights   found = {.range = 0};
  PetscReal peak;
  PetscInt  axis, i, j;
  double    own, most, place;
  char      doubt[384];

  PetscFunctionBegin;
  text[0] = '\0';
  PetscCall(CreateHeights(gap, grid, h, &heights));
  if (!heights) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Measure(grid, heights, &found));
  PetscCall(FindStep(grid, heights, pressure, &own, &place));
  PetscCall(VecDestroy(&heights));
  PetscCall(VecMax(pressure, NULL, &peak));
  most = own;
  PetscCall(SamMax(grid->comm, 1, &most));
  if (own < most) place = -1;
  PetscCall(SamMax(grid->comm, 1, &place));
  axis = place < 0 ? 0 : (PetscInt)fmod(place, 2);
  if (place < 0 || found.steps <= MOSTLY ||
      modulus * most / (double)(axis ? grid->dy : grid->dx) <= HIGH * (double)peak)
    PetscFunctionReturn(PETSC_SUCCESS);
  i = (PetscInt)fmod(floor(place / 2), (double)grid->nx);
  j = (PetscInt)floor(place / 2 / (double)grid->nx);
  (void)snprintf(
    doubt, sizeof(doubt),
    "the heights have a step of %.2g m between neighbouring cells in contact, at x = %.4g m, y = %.4g m, "
    "where the pressure has no limit on finer grids: give the hardness, -pressure_limit, unless it is an outlier "
    "of the instrument, which petsam-surface reports",
    most, (double)(SamGridX(grid, i) - (axis ? 0 : grid->dx / 2)),
    (double)(SamGridY(grid, j) - (axis ? grid->dy / 2 : 0)));
  Blame(gap, doubt, text, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

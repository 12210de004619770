/*
  What heights from a file tell of their unit, and of a tilt, which is a step at the border of a period.

  The heights are the separation without the shape. Their tilt along an axis is that of the means of the lines across
  it, by least squares. Waves may have one, too, but go on over the border; so the smaller of two rises counts: that of
  the tilt over the period, and that of the means from the first line to the last one.
*/
#include <petsam/private/gapimpl.h>
#include <petsam/private/rows.h>
#include <math.h>

/* Half-space theory is taken to hold up to this rms slope. */
#define STEEPEST 0.5

typedef struct {
  double range, rms, slope; /* m: largest minus smallest; about the mean; rms of the gradient */
  double rise[2];           /* m: over the period in x, y */
} Heights;

/* Adds up squares of the heights and of their gradient, and the heights of each column, then of each row. */
static void AddUp(const SamHalo *seen, SamGrid grid, double square[2], double sums[])
{
  const PetscReal cell[2] = {grid->dx, grid->dy};
  const double   *h       = seen->own;

  for (PetscInt c = 0; c < grid->cells; c++) {
    const PetscInt i = c % grid->nx, j = grid->row_start + c / grid->nx;
    const double  *below   = seen->at[0] + (j - 1 - seen->rows.first) * (ptrdiff_t)grid->nx;
    const double   step[2] = {i ? h[c] - h[c - 1] : 0, j ? h[c] - below[i] : 0};

    square[0] += h[c] * h[c];
    for (PetscInt d = 0; d < grid->axes; d++) square[1] += step[d] * step[d] / (cell[d] * cell[d]);
    sums[i] += h[c];
    sums[grid->nx + j] += h[c];
  }
}

/* The rise over n lines with these means. */
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

/* Measures heights; leaves them with the mean 0. */
static PetscErrorCode Measure(SamGrid grid, Vec heights, Heights *found)
{
  const PetscInt n[2]  = {grid->nx, grid->ny};
  const double   cells = (double)n[0] * (double)n[1];
  PetscReal      mean, ends[2];
  double        *sums, square[2] = {0, 0};
  SamHalo        seen;

  PetscFunctionBegin;
  PetscCall(VecMin(heights, NULL, &ends[0]));
  PetscCall(VecMax(heights, NULL, &ends[1]));
  PetscCall(VecMean(heights, &mean));
  PetscCall(VecShift(heights, -mean));
  PetscCall(PetscCalloc1(n[0] + n[1], &sums));
  PetscCall(SamHaloBegin(grid, heights, 1, 1, &seen));
  AddUp(&seen, grid, square, sums);
  PetscCall(SamHaloEnd(&seen));
  PetscCall(SamSum(grid->comm, 2, square));
  PetscCall(SamSum(grid->comm, n[0] + n[1], sums));
  for (PetscInt k = 0; k < n[0] + n[1]; k++) sums[k] /= (double)n[k < n[0]];
  *found = (Heights){.range = ends[1] - ends[0], .rms = sqrt(square[0] / cells), .slope = sqrt(square[1] / cells)};
  for (PetscInt d = 0; d < grid->axes; d++) found->rise[d] = Rise(sums + d * n[0], n[d]);
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Describe(const Heights *h, SamGrid grid, PetscBool periodic, char text[], size_t size)
{
  static const char unit[] = "check the unit of the dataset: its attribute units (mm, um); without it, m";

  const double   width = (double)PetscMax(grid->width[0], grid->width[1]);
  const PetscInt axis  = h->rise[1] > h->rise[0];

  if (h->range > width)
    (void)snprintf(text, size, "the heights vary by %.3g m, more than the grid's width of %.3g m: %s", h->range, width,
                   unit);
  else if (h->slope > STEEPEST)
    (void)snprintf(text, size, "the rms slope of the heights is %.2g, half-spaces allow about %g: %s", h->slope,
                   STEEPEST, unit);
  else if (periodic && h->rise[axis] > h->rms)
    (void)snprintf(text, size,
                   "the heights rise by %.2g m along %s, a step at the border of the period, and have an rms of %.2g "
                   "m: remove the tilt by petsam-surface --level tilt",
                   h->rise[axis], axis ? "y" : "x", h->rms);
}

PetscErrorCode SamGapAdvise(SamGap gap, SamGrid grid, Vec h, PetscBool periodic, char text[], size_t size)
{
  const SamFieldFile *file = SamGapIsFromFile(gap, PETSC_FALSE) ? &gap->source : &gap->rough;
  PetscScalar        *array;
  Vec                 heights;
  Heights             found      = {.range = 0};
  char                doubt[320] = "";

  PetscFunctionBegin;
  text[0] = '\0';
  if (!SamGapIsFromFile(gap, PETSC_FALSE) && !SamGapIsFromFile(gap, PETSC_TRUE)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(h, &heights));
  PetscCall(VecCopy(h, heights));
  PetscCall(VecGetArray(heights, &array));
  for (PetscInt c = 0; c < grid->cells; c++)
    array[c] -= SamGapGetHeight(gap, SamGridX(grid, c % grid->nx), SamGridY(grid, grid->row_start + c / grid->nx));
  PetscCall(VecRestoreArray(heights, &array));
  PetscCall(Measure(grid, heights, &found));
  PetscCall(VecDestroy(&heights));
  Describe(&found, grid, periodic, doubt, sizeof(doubt));
  if (doubt[0])
    (void)snprintf(text, size, "-%s%s %s, %s: %s", gap->prefix, file->file_option, file->file, file->dataset, doubt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

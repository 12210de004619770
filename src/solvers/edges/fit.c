/* Quadratic functions through a zone's field: least squares in a window about a cell. */
#include "edgesimpl.h"
#include <math.h>

#define TERMS SAM_FIT_TERMS
#define SUMS  SAM_FIT_SUMS
#define SUB   16 /* number of sub-cells in each direction */
#define KEPT  16 /* rows whose sums are kept: more than a window has */
/* Entries of a symmetric matrix as the rows of its lower triangle; sums of x^m y^n with m + n up to 4 */
enum { ENTRIES = TERMS * (TERMS + 1) / 2, POWERS = 5 };

PetscErrorCode SamFitWindowCreate(const SamZone *z, PetscInt half, int least, SamFitWindow *window)
{
  PetscFunctionBegin;
  *window = (SamFitWindow){.half = half, .least = least};
  for (PetscInt a = -half; a <= half; a++) {
    double *terms = window->terms[a + half], x = 1;

    for (int m = 0; m < POWERS; m++, x *= (double)a / (double)half) terms[m] = x;
    for (int m = 0; m + POWERS < SUMS; m++) terms[m + POWERS] = terms[m];
  }
  window->kept = PetscMin(z->count, KEPT);
  PetscCall(PetscMalloc1(z->width * window->kept, &window->rows));
  for (PetscInt k = 0; k < z->width * window->kept; k++) window->rows[k].row = z->first - 1; /* none */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFitWindowDestroy(SamFitWindow *window)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(window->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Part of a fit's window that lies in the zone's window */
typedef struct {
  PetscInt left, right, low, high;
} Range;

static Range RangeOf(const SamZone *z, PetscInt half, PetscInt i, PetscInt j)
{
  return (Range){PetscMax(i - half, z->left), PetscMin(i + half, z->left + z->width - 1), PetscMax(j - half, z->first),
                 PetscMin(j + half, z->first + z->count - 1)};
}

/*
  Computes Cholesky's factor of a symmetric positive matrix, both as rows of their lower triangles, the factor with the
  inverse of its diagonal; returns false if the matrix is singular. (The eigenvalues of SamSolveSymmetric() would take
  longer than the fit.) `line`: terms that are zero everywhere remain zero.
*/
static PetscBool Factor(PetscBool line, double A[ENTRIES])
{
  double *row[TERMS];

  for (int j = 0, n = 0; j < TERMS; n += ++j) row[j] = A + n;
  for (int j = 0; j < TERMS; j++) {
    const double whole = row[j][j];

    if (line && whole == 0) {
      row[j][j] = 1;
      continue;
    }
    for (int k = 0; k < j; k++) row[j][j] -= row[j][k] * row[j][k];
    if (!(row[j][j] > 1e-10 * whole)) return PETSC_FALSE;
    row[j][j] = 1 / sqrt(row[j][j]);
    for (int i = j + 1; i < TERMS; i++) {
      for (int k = 0; k < j; k++) row[i][j] -= row[i][k] * row[j][k];
      row[i][j] *= row[j][j];
    }
  }
  return PETSC_TRUE;
}

static void Solve(const double L[ENTRIES], double b[TERMS])
{
  const double *row[TERMS];

  for (int j = 0, n = 0; j < TERMS; n += ++j) row[j] = L + n;
  for (int i = 0; i < TERMS; i++) {
    for (int k = 0; k < i; k++) b[i] -= row[i][k] * b[k];
    b[i] *= row[i][i];
  }
  for (int i = TERMS - 1; i >= 0; i--) {
    for (int k = i + 1; k < TERMS; k++) b[i] -= row[k][i] * b[k];
    b[i] *= row[i][i];
  }
}

/* Sums over the cells of a fit */
typedef struct {
  PetscInt count;
  double   moments[POWERS][POWERS]; /* of x^m y^n */
  double   right[TERMS], squares;   /* of the values times the terms, of their squares */
} Sums;

/*
  Sums over a row's n cells that take part in the fit: 1, x, x^2, x^3, x^4 and, times their values, 1, x, x^2; and the
  squares of the values. Returns their number.
*/
SAM_VECTORIZED static PetscInt AddRow(PetscInt n, const signed char *distance, int least,
                                      const double (*restrict terms)[SUMS], const double *restrict values,
                                      double *restrict sums, double *squares)
{
  PetscInt count = 0;

  for (PetscInt a = 0; a < n; a++) {
    const double v = values[a];

    if (distance[a] < least) continue;
    count++;
    *squares += v * v;
    for (int k = 0; k < SUMS; k++) sums[k] += terms[a][k] * (k < POWERS ? 1 : v);
  }
  return count;
}

/* Adds the sums of the row at y. */
static void AddMoments(const double row[SUMS], double y, Sums *sums)
{
  const double *v = row + POWERS, right[TERMS] = {v[0], v[1], y * v[0], v[2], y * v[1], y * y * v[0]};
  double        power = 1;

  for (int n = 0; n < POWERS; n++, power *= y)
    for (int m = 0; m + n < POWERS; m++) sums->moments[m][n] += row[m] * power;
  for (int k = 0; k < TERMS; k++) sums->right[k] += right[k];
}

/* Returns the sums over the part of row b in the window of column i. */
static const SamFitRow *RowOf(const SamZone *z, SamFitWindow *window, PetscInt i, PetscInt b, Range range)
{
  SamFitRow      *row = window->rows + (i - z->left) * window->kept + (b - z->first) % window->kept;
  const ptrdiff_t k   = SamZoneAt(z, range.left, b);

  if (row->row == b) return row;
  *row       = (SamFitRow){.row = b};
  row->count = AddRow(range.right - range.left + 1, z->distance + k, window->least,
                      window->terms + range.left - i + window->half, z->w + k, row->sums, &row->squares);
  return row;
}

static void Sum(const SamZone *z, SamFitWindow *window, PetscInt i, PetscInt j, Sums *sums)
{
  const Range range = RangeOf(z, window->half, i, j);

  *sums = (Sums){.count = 0};
  for (PetscInt b = range.low; b <= range.high; b++) {
    const SamFitRow *row = RowOf(z, window, i, b, range);

    if (row->count) AddMoments(row->sums, (double)(b - j) / (double)window->half, sums);
    sums->squares += row->squares;
    sums->count += row->count;
  }
}

/* Computes the factor of the fit's matrix; returns false if there are too few cells or the matrix is singular. */
static PetscBool FactorOf(const SamZone *z, const Sums *sums, double factor[ENTRIES])
{
  static const int x[TERMS] = {0, 1, 0, 2, 1, 0}, y[TERMS] = {0, 0, 1, 0, 1, 2}; /* powers in the terms */

  const PetscBool line  = SamGridIsRow(z->grid);
  const PetscInt  least = line ? SAM_FIT_LEAST_LINE : SAM_FIT_LEAST;

  if (sums->count < least) return PETSC_FALSE;
  for (int k = 0, n = 0; k < TERMS; k++)
    for (int l = 0; l <= k; l++) factor[n++] = sums->moments[x[k] + x[l]][y[k] + y[l]];
  return Factor(line, factor);
}

PetscBool SamFit(const SamZone *z, SamFitWindow *window, PetscInt i, PetscInt j, double fit[TERMS], double *bent)
{
  const double scale = (double)window->half;
  Sums         sums;
  double       factor[ENTRIES];

  Sum(z, window, i, j, &sums);
  if (!FactorOf(z, &sums, factor)) return PETSC_FALSE;
  for (int k = 0; k < TERMS; k++) fit[k] = sums.right[k];
  Solve(factor, fit);
  /* The squares of the deviations follow, since the function minimises them. */
  for (int k = 0; k < TERMS; k++) sums.squares -= fit[k] * sums.right[k];
  for (int k = 1; k < TERMS; k++) fit[k] /= k < 3 ? scale : scale * scale;
  *bent = sqrt(PetscMax(sums.squares, 0) / (double)sums.count);
  return PETSC_TRUE;
}

/* Sums over sub-cells the part where the function, in units of its slope per sub-cell, is positive. */
SAM_VECTORIZED static double SumParts(const double *restrict fit, double slope)
{
  double sum = 0;

  for (int b = 0; b < SUB; b++) {
    const double y = (b + 0.5) / SUB - 0.5;

#pragma omp simd reduction(+ : sum)
    for (int a = 0; a < SUB; a++) {
      const double part = 0.5 + 0.75 * SamFitAt(fit, (a + 0.5) / SUB - 0.5, y) / slope, some = part > 0 ? part : 0;

      sum += some < 1 ? some : 1;
    }
  }
  return sum;
}

/* Returns how far the function is positive along x, at most so far, by rows of the cell's sub-cells. */
static double ReachAlong(const double fit[TERMS], double farthest)
{
  double most = -INFINITY;

  for (int b = 0; b < SUB; b++) {
    const double y = (b + 0.5) / SUB - 0.5, middle = SamFitAt(fit, 0, y), slope = fit[1] + fit[4] * y;
    const double square = slope * slope - 4 * middle * fit[3];
    double       x      = -INFINITY;

    if (slope < 0 && square >= 0)
      x = PetscMin(2 * middle / (sqrt(square) - slope), farthest);
    else if (SamFitAt(fit, 0.5, y) > 0)
      x = farthest;
    if (x >= -0.5) most = PetscMax(most, x);
  }
  return most;
}

double SamFitReach(const double f[TERMS], int side, double farthest)
{
  const double sign = side % 2 ? -1 : 1;

  if (side < 2) return ReachAlong((const double[TERMS]){f[0], sign * f[1], f[2], f[3], sign * f[4], f[5]}, farthest);
  return ReachAlong((const double[TERMS]){f[0], sign * f[2], f[1], f[5], sign * f[4], f[3]}, farthest);
}

/* Returns the part of a cell of a single row that lies on the positive side of its function's root. */
static double LinePart(const double fit[TERMS])
{
  const double square = fit[1] * fit[1] - 4 * fit[0] * fit[3], slope = fabs(fit[1]) + sqrt(PetscMax(square, 0));

  return PetscClipInterval(0.5 + 2 * fit[0] / slope, 0, 1);
}

double SamFitPart(const double fit[TERMS])
{
  const double slope = hypot(fit[1], fit[2]) / SUB;
  const double reach =
    0.5 * (fabs(fit[1]) + fabs(fit[2])) + 0.25 * (fabs(fit[3]) + fabs(fit[4]) + fabs(fit[5])) + slope;

  if (fabs(fit[0]) > reach) return fit[0] > 0 ? 1 : 0;
  if (fit[2] == 0 && fit[4] == 0 && fit[5] == 0) return LinePart(fit);
  return SumParts(fit, slope) / (SUB * SUB);
}

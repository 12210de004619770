/* Quadratic functions through a zone's field: least squares in a window about a cell. */
#include "edgesimpl.h"
#include <math.h>

#define TERMS    SAM_FIT_TERMS
#define PRODUCTS SAM_FIT_PRODUCTS
#define SUB      16 /* number of sub-cells in each direction */

void SamFitWindowInitialize(PetscInt half, int least, SamFitWindow *window)
{
  PetscInt cell = 0;

  *window = (SamFitWindow){.half = half, .least = least};
  for (PetscInt b = -half; b <= half; b++)
    for (PetscInt a = -half; a <= half; a++, cell++) {
      const double x = (double)a / (double)half, y = (double)b / (double)half;
      const double terms[TERMS] = {1, x, y, x * x, x * y, y * y};

      for (int k = 0, n = 0; k < TERMS; k++) {
        window->terms[cell][k] = terms[k];
        for (int l = 0; l <= k; l++) window->products[cell][n++] = terms[k] * terms[l];
      }
    }
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
  Computes Cholesky's factor of a symmetric positive matrix, both as rows of their lower triangles; returns false if the
  matrix is singular. (The eigenvalues of SamSolveSymmetric() would take longer than the fit.) `line`: terms that are
  zero everywhere remain zero.
*/
static PetscBool Factor(PetscBool line, double A[PRODUCTS])
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
    row[j][j] = sqrt(row[j][j]);
    for (int i = j + 1; i < TERMS; i++) {
      for (int k = 0; k < j; k++) row[i][j] -= row[i][k] * row[j][k];
      row[i][j] /= row[j][j];
    }
  }
  return PETSC_TRUE;
}

static void Solve(const double L[PRODUCTS], double b[TERMS])
{
  const double *row[TERMS];

  for (int j = 0, n = 0; j < TERMS; n += ++j) row[j] = L + n;
  for (int i = 0; i < TERMS; i++) {
    for (int k = 0; k < i; k++) b[i] -= row[i][k] * b[k];
    b[i] /= row[i][i];
  }
  for (int i = TERMS - 1; i >= 0; i--) {
    for (int k = i + 1; k < TERMS; k++) b[i] -= row[k][i] * b[k];
    b[i] /= row[i][i];
  }
}

/* Adds the normal equations of the row's n cells that take part in the fit; returns their number. */
SAM_VECTORIZED static PetscInt AddProducts(PetscInt n, const signed char *distance, int least,
                                           const double (*restrict products)[PRODUCTS], double *restrict sums)
{
  PetscInt count = 0;

  for (PetscInt a = 0; a < n; a++) {
    if (distance[a] < least) continue;
    count++;
    for (int k = 0; k < PRODUCTS; k++) sums[k] += products[a][k];
  }
  return count;
}

/* Computes the factor of the fit's matrix; returns the number of cells in the fit, 0 if the matrix is singular. */
static PetscInt FactorOf(const SamZone *z, const SamFitWindow *window, PetscInt i, PetscInt j, double factor[PRODUCTS])
{
  const PetscInt half  = window->half;
  const Range    range = RangeOf(z, half, i, j);
  const PetscInt least = SamGridIsRow(z->grid) ? SAM_FIT_LEAST_LINE : SAM_FIT_LEAST;
  PetscInt       count = 0;

  for (int n = 0; n < PRODUCTS; n++) factor[n] = 0;
  for (PetscInt b = range.low; b <= range.high; b++)
    count += AddProducts(range.right - range.left + 1, z->distance + SamZoneAt(z, range.left, b), window->least,
                         window->products + (b - j + half) * (2 * half + 1) + range.left - i + half, factor);
  return count >= least && Factor(SamGridIsRow(z->grid), factor) ? count : 0;
}

/* Right-hand side of the normal equations of a fit, and the sum of the squared values */
typedef struct {
  double right[TERMS], squares;
} Values;

SAM_VECTORIZED static void AddValues(PetscInt n, const signed char *distance, int least,
                                     const double (*restrict terms)[TERMS], const double *restrict values,
                                     Values *restrict sums)
{
  for (PetscInt a = 0; a < n; a++) {
    if (distance[a] < least) continue;
    sums->squares += values[a] * values[a];
    for (int k = 0; k < TERMS; k++) sums->right[k] += terms[a][k] * values[a];
  }
}

PetscBool SamFit(const SamZone *z, const SamFitWindow *window, PetscInt i, PetscInt j, double fit[TERMS], double *bent)
{
  const PetscInt half  = window->half;
  const double   scale = (double)half;
  const Range    range = RangeOf(z, half, i, j);
  Values         sums  = {.squares = 0};
  double         factor[PRODUCTS];
  const PetscInt count = FactorOf(z, window, i, j, factor);

  if (!count) return PETSC_FALSE;
  for (PetscInt b = range.low; b <= range.high; b++) {
    const ptrdiff_t k = SamZoneAt(z, range.left, b);

    AddValues(range.right - range.left + 1, z->distance + k, window->least,
              window->terms + (b - j + half) * (2 * half + 1) + range.left - i + half, z->w + k, &sums);
  }
  for (int k = 0; k < TERMS; k++) fit[k] = sums.right[k];
  Solve(factor, fit);
  /* The squares of the deviations follow, since the function minimises them. */
  for (int k = 0; k < TERMS; k++) sums.squares -= fit[k] * sums.right[k];
  for (int k = 1; k < TERMS; k++) fit[k] /= k < 3 ? scale : scale * scale;
  *bent = sqrt(PetscMax(sums.squares, 0) / (double)count);
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

/*
  Roots of quadratic functions over a cell: their means over sub-cells, in each of which the function counts as linear,
  so that the mean of its root is known.
*/
#include "edgesimpl.h"
#include <math.h>

#define NEWTON 40   /* most iterations */
#define EXACT  1e-4 /* relative error of a mean after which one more step of Newton's method leaves its square */

void SamRootsInitialize(int sub, SamRoots *r)
{
  *r = (SamRoots){.sub = sub, .cells = sub * sub};
  for (int k = 0; k < r->cells; k++) {
    r->x[k] = (k % sub + 0.5) / sub - 0.5;
    r->y[k] = (k / sub + 0.5) / sub - 0.5;
    r->square += r->x[k] * r->x[k];
  }
}

/*
  The means of sqrt(max(w, 0)) over a cell's sub-cells, and their derivatives by w. In a sub-cell w is spread evenly
  over a width about its middle, so that the mean is (up^3 - down^3)/(3/2 width), up and down being the roots at the
  ends.
*/
SAM_VECTORIZED static void Means(const SamRoots *restrict r, const double *restrict fit, double *restrict means,
                                 double *restrict slopes)
{
  const double least = 1e-6 * (fabs(fit[0]) + fabs(fit[1]) + fabs(fit[2])), part = 1.0 / r->sub;

#pragma omp simd
  for (int k = 0; k < r->cells; k++) {
    const double x = r->x[k], y = r->y[k], w = SamFitAt(fit, x, y);
    const double gx = fit[1] + 2 * fit[3] * x + fit[4] * y, gy = fit[2] + 2 * fit[5] * y + fit[4] * x;
    const double width = sqrt(gx * gx + gy * gy) * part + least, top = w + 0.5 * width, end = w - 0.5 * width;
    const double up = sqrt(top > 0 ? top : 0), down = sqrt(end > 0 ? end : 0), inverse = 1 / width;

    means[k]  = (up * up * up - down * down * down) * inverse / 1.5;
    slopes[k] = (up - down) * inverse;
  }
}

double SamRootsMean(const SamRoots *r, const double fit[SAM_FIT_TERMS], double means[], double *slope)
{
  double sum = 0, sums = 0, slopes[SAM_ROOTS_CELLS];

  Means(r, fit, means, slopes);
  for (int k = 0; k < r->cells; k++) {
    sum += means[k];
    sums += slopes[k];
  }
  if (slope) *slope = sums / r->cells;
  return sum / r->cells;
}

void SamRootsMatch(const SamRoots *r, double mean, double fit[SAM_FIT_TERMS])
{
  const double reach = fabs(fit[1]) + fabs(fit[2]) + fabs(fit[3]) + fabs(fit[4]) + fabs(fit[5]);
  double       low = -reach, high = mean * mean + reach, means[SAM_ROOTS_CELLS];

  if (!(fit[0] > low && fit[0] < high)) fit[0] = mean * mean;
  for (int k = 0; k < NEWTON; k++) {
    double       slope;
    const double error = SamRootsMean(r, fit, means, &slope) - mean, next = fit[0] - error / slope;

    if (fabs(error) <= EXACT * mean) {
      fit[0] = next;
      break;
    }
    if (error > 0)
      high = fit[0];
    else
      low = fit[0];
    fit[0] = slope > 0 && next > low && next < high ? next : 0.5 * (low + high);
  }
}

void SamRootsTakeLinearPart(const SamRoots *r, double mean, double means[], double slopes[2])
{
  slopes[0] = slopes[1] = 0;
  for (int k = 0; k < r->cells; k++) {
    slopes[0] += r->x[k] * means[k];
    slopes[1] += r->y[k] * means[k];
  }
  for (int c = 0; c < 2; c++) slopes[c] /= r->square;
  for (int k = 0; k < r->cells; k++) means[k] -= mean + slopes[0] * r->x[k] + slopes[1] * r->y[k];
}

/*
  The active-set method's loops over the cells of a row.

  Each is vectorised; sums over cells are local variables, and rows are added up by the caller in twice the digits, so
  that the results do not depend on the number of ranks.
*/
#include "activesetimpl.h"
#include <float.h>
#include <math.h>

SAM_VECTORIZED double SamActiveSetGapRow(SamActiveSet *w, SamRow row)
{
  const double *restrict h = w->h + row.first;
  double *restrict g       = w->g + row.first;
  const double a = w->motion[0] - w->motion[1] * row.eta, b = w->motion[2];
  double       max = 0;

#pragma omp simd reduction(max : max)
  for (int i = 0; i < row.count; i++) {
    const double size = fabs(g[i]);

    max  = size > max ? size : max;
    g[i] = g[i] + h[i] - a - b * (row.xi0 + (double)i * row.dxi);
  }
  return max;
}

SAM_VECTORIZED PetscBool SamActiveSetChooseRow(SamActiveSet *w, SamRow row, double ease, const double motion[3],
                                               SamGapSums *sums)
{
  const double *restrict p = w->p + row.first, *restrict g = w->g + row.first;
  float *restrict active = w->active + row.first;
  const double a = motion[0] - motion[1] * row.eta, b = motion[2], most = w->most, half = 0.5 * most;
  double       count = 0, xi = 0, xi2 = 0, sum = 0, turn = 0, pressure = 0;

#pragma omp simd reduction(+ : count, xi, xi2, sum, turn, pressure)
  for (int i = 0; i < row.count; i++) {
    /* At most half the limit, since the pressure of a cell outside of A goes to the nearer bound. */
    const double x = row.xi0 + (double)i * row.dxi, v = g[i] - (a + b * x), off = ease * v,
                 lower = off < half ? off : half, upper = -off < half ? -off : half,
                 in = p[i] > lower && most - p[i] > upper ? 1 : 0;

    active[i] = (float)in;
    count += in;
    xi += in * x;
    xi2 += in * x * x;
    sum += in * v;
    turn += in * x * v;
    pressure += p[i];
  }
  sums->count += count;
  sums->xi += xi;
  sums->xi2 += xi2;
  sums->g += sum;
  sums->xi_g += turn;
  return count > 0 || pressure > 0;
}

SAM_VECTORIZED double SamActiveSetMoveRow(SamActiveSet *w, SamRow row, const double motion[3])
{
  const double *restrict p = w->p + row.first;
  double *restrict g       = w->g + row.first;
  const double a = motion[0] - motion[1] * row.eta, b = motion[2], saturated = SAM_SATURATED * w->most;
  double       sum = 0, error = 0;

#pragma omp simd reduction(+ : sum) reduction(max : error)
  for (int i = 0; i < row.count; i++) {
    const double v = g[i] - (a + b * (row.xi0 + (double)i * row.dxi)), under = p[i] < saturated ? fabs(v) : v,
                 wrong = p[i] > 0 ? under : -v;

    g[i] = v;
    sum += v;
    error = wrong > error ? wrong : error;
  }
  return isfinite(sum) ? error : NAN; /* the comparison above ignores a NaN */
}

SAM_VECTORIZED double SamActiveSetCountChanged(const SamActiveSet *w, SamRow row)
{
  const float *restrict loss = w->loss + row.first, *restrict active = w->active + row.first;
  float changed = 0; /* accurate, since a row has fewer cells than a float can count */

#pragma omp simd reduction(+ : changed)
  for (int i = 0; i < row.count; i++) changed += fabsf((loss[i] > 0 ? 1.0f : 0.0f) - active[i]);
  return (double)changed;
}

SAM_VECTORIZED void SamActiveSetLossRow(SamActiveSet *w, SamRow row, float off)
{
  const float *restrict active = w->active + row.first;
  float *restrict loss         = w->loss + row.first;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float some = off * loss[i];

    loss[i] = active[i] * (some > FLT_MIN ? some : FLT_MIN);
  }
}

SAM_VECTORIZED void SamActiveSetResidualRow(SamActiveSet *w, SamRow row)
{
  const double *restrict g     = w->g + row.first;
  const float *restrict active = w->active + row.first;
  float *restrict z            = w->z + row.first;
  const double inverse         = 1 / w->unit;

#pragma omp simd
  for (int i = 0; i < row.count; i++) z[i] = active[i] > 0 ? (float)(-inverse * g[i]) : 0;
}

SAM_VECTORIZED void SamActiveSetPreconditionedRow(SamActiveSet *w, SamRow row, SamDirectionSums *sums)
{
  const double *restrict g = w->g + row.first;
  const float *restrict s = w->s + row.first, *restrict u = w->u + row.first, *restrict loss = w->loss + row.first,
                        *restrict active = w->active + row.first, *restrict xi = w->xi + row.column;
  float *restrict z    = w->z + row.first;
  const double inverse = 1 / w->unit;
  float        z_sum = 0, z_turn = 0, u_sum = 0, u_turn = 0, zu = 0;
  double       zr = 0, sr = 0;

#pragma omp simd reduction(+ : z_sum, z_turn, u_sum, u_turn, zu, zr, sr)
  for (int i = 0; i < row.count; i++) {
    const float r = active[i] > 0 ? (float)(-inverse * g[i]) : 0, v = active[i] * (z[i] - loss[i] * r),
                d = active[i] * u[i];

    z[i] = v;
    z_sum += v;
    z_turn += xi[i] * v;
    u_sum += d;
    u_turn += xi[i] * d;
    zu += v * d;
    zr += (double)v * (double)r;
    sr += (double)s[i] * (double)r;
  }
  sums->z += (double)z_sum;
  sums->z_turn += (double)z_turn;
  sums->u += (double)u_sum;
  sums->u_turn += (double)u_turn;
  sums->zr += zr;
  sums->zu += (double)zu;
  sums->sr += sr;
}

SAM_VECTORIZED void SamActiveSetDirectionRow(SamActiveSet *w, SamRow row, const double motion[3], float beta)
{
  const float *restrict s = w->s + row.first, *restrict xi = w->xi + row.column;
  float *restrict z = w->z + row.first;
  const float a = (float)(motion[0] - motion[1] * row.eta), b = (float)motion[2];

#pragma omp simd
  for (int i = 0; i < row.count; i++) z[i] = z[i] - a - b * xi[i] + beta * s[i];
}

SAM_VECTORIZED double SamActiveSetTrialRow(SamActiveSet *w, SamRow row)
{
  const double *restrict p = w->p + row.first, *restrict g = w->g + row.first;
  const float *restrict s = w->s + row.first;
  const double pressure = w->unit / w->self, most = w->most;
  double       slope = 0, shrink = 0, largest = 0;

#pragma omp simd reduction(+ : slope) reduction(max : shrink, largest)
  for (int i = 0; i < row.count; i++) {
    const double way = pressure * fabs((double)s[i]), left = s[i] < 0 ? p[i] : most - p[i],
                 part = way > 0 ? way / (left + way) : 0;

    slope += (double)s[i] * g[i];
    shrink  = part > shrink ? part : shrink;
    largest = p[i] > largest ? p[i] : largest;
  }
  w->shrink  = PetscMax(w->shrink, shrink);
  w->largest = PetscMax(w->largest, largest);
  return slope;
}

/* In single precision, for which the number of cells is small. */
SAM_VECTORIZED double SamActiveSetCurvatureRow(const SamActiveSet *w, SamRow row)
{
  const float *restrict s = w->s + row.first, *restrict u = w->u + row.first;
  float sum = 0;

#pragma omp simd reduction(+ : sum)
  for (int i = 0; i < row.count; i++) sum += s[i] * u[i];
  return (double)sum;
}

/* A pressure within the step's rounding of a bound is set to the bound. */
SAM_VECTORIZED void SamActiveSetStepRow(SamActiveSet *w, SamRow row, double t, SamGapSums *sums)
{
  const float *restrict s = w->s + row.first, *restrict u = w->u + row.first;
  double *restrict p = w->p + row.first, *restrict g = w->g + row.first;
  const double pressure = w->unit / w->self, rounding = SAM_SINGLE_ROUNDING * pressure, by_s = (t - 1) * pressure,
               by_u = t * w->unit, most = w->most;
  double count = 0, xi = 0, xi2 = 0, sum = 0, turn = 0;

#pragma omp simd reduction(+ : count, xi, xi2, sum, turn)
  for (int i = 0; i < row.count; i++) {
    const double v = p[i] + by_s * (double)s[i], gap = g[i] + by_u * (double)u[i], x = row.xi0 + (double)i * row.dxi;
    const double near = rounding * fabs((double)s[i]), below = v < most - near ? v : most,
                 in = v > near && v < most - near ? 1 : 0;

    p[i] = v > near ? below : 0;
    g[i] = gap;
    count += in;
    xi += in * x;
    xi2 += in * x * x;
    sum += in * gap;
    turn += in * x * gap;
  }
  sums->count += count;
  sums->xi += xi;
  sums->xi2 += xi2;
  sums->g += sum;
  sums->xi_g += turn;
}

SAM_VECTORIZED double SamActiveSetOpenRow(SamActiveSet *w, SamRow row, double t)
{
  const float *restrict u = w->u + row.first;
  double *restrict g      = w->g + row.first;
  const double by_u       = t * w->unit;
  double       least = INFINITY, sum = 0;

#pragma omp simd reduction(+ : sum) reduction(min : least)
  for (int i = 0; i < row.count; i++) {
    const double gap = g[i] + by_u * (double)u[i];

    g[i] = gap;
    sum += gap;
    least = gap < least ? gap : least;
  }
  return isfinite(sum) ? least : -INFINITY;
}

SAM_VECTORIZED double SamActiveSetDisplacementRow(const SamActiveSet *w, SamRow row)
{
  const double *restrict g = w->g + row.first, *restrict h = w->h + row.first;
  const double a = w->motion[0] - w->motion[1] * row.eta, b = w->motion[2];
  double       max = 0;

#pragma omp simd reduction(max : max)
  for (int i = 0; i < row.count; i++) {
    const double size = fabs(g[i] - h[i] + a + b * (row.xi0 + (double)i * row.dxi));

    max = size > max ? size : max;
  }
  return max;
}

/*
  Represents functions of a positive number by polynomials on intervals; the exponent and the three leading bits of the
  mantissa are the index of the interval.

  On an interval from c to at most 9/8 c, a function that is analytic up to 0 has Chebyshev coefficients that decrease
  by a factor of 34, so that the error of degree 9 is 1e-15. The coefficients come from the values at Chebyshev's points
  and are converted to powers of t, -1 <= t <= 1, for Horner's scheme: consecutive arguments of one interval are
  processed together, without roots or logarithms.
*/
#include "layered.h"

#define POINTS (SAM_SPLINE_DEGREE + 1)
#define BITS   49 /* number of bits below the exponent and the three leading bits */

static int NumberOf(double s)
{
  uint64_t bits;

  memcpy(&bits, &s, sizeof(bits));
  return (int)(bits >> BITS);
}

static double StartOf(int number)
{
  const uint64_t bits = (uint64_t)number << BITS;
  double         s;

  memcpy(&s, &bits, sizeof(s));
  return s;
}

/* Computes matrix[n][p], the contribution of the value at point p to the coefficient of t^n. */
static void MakeFit(double points[POINTS], double matrix[POINTS][POINTS])
{
  double powers[POINTS][POINTS] = {{1}, {0, 1}}; /* Chebyshev polynomials */

  for (int k = 2; k < POINTS; k++)
    for (int n = 0; n < POINTS; n++) powers[k][n] = (n ? 2 * powers[k - 1][n - 1] : 0) - powers[k - 2][n];
  for (int p = 0; p < POINTS; p++) {
    const double angle = PETSC_PI * (p + 0.5) / POINTS;

    points[p] = cos(angle);
    for (int n = 0; n < POINTS; n++) {
      matrix[n][p] = 0;
      for (int k = 0; k < POINTS; k++) matrix[n][p] += (k ? 2.0 : 1.0) / POINTS * cos(k * angle) * powers[k][n];
    }
  }
}

PetscErrorCode SamSplineCreate(SamSpline *table, int functions, double least, double most,
                               void (*values)(const void *, double, double[]), const void *context)
{
  double points[POINTS], matrix[POINTS][POINTS], value[SAM_RADIALS];

  PetscFunctionBegin;
  MakeFit(points, matrix);
  *table       = (SamSpline){.functions = functions, .first = NumberOf(least)};
  table->least = StartOf(table->first);
  /* The last interval extends beyond `most`. */
  table->intervals = PetscMax(NumberOf(most), table->first) - table->first + 2;
  table->most      = nextafter(StartOf(table->first + table->intervals - 1), 0);
  PetscCall(PetscMalloc3(table->intervals, &table->centre, table->intervals, &table->scale,
                         table->intervals * functions * POINTS, &table->coefficients));
  PetscCall(PetscArrayzero(table->coefficients, table->intervals * functions * POINTS));
  for (int i = 0; i < table->intervals; i++) {
    const double from = i ? StartOf(table->first + i - 1) : 0, to = StartOf(table->first + i);

    table->centre[i] = 0.5 * (from + to);
    table->scale[i]  = 2 / (to - from);
    for (int p = 0; p < POINTS; p++) {
      values(context, table->centre[i] + points[p] / table->scale[i], value);
      for (int f = 0; f < functions; f++)
        for (int n = 0; n < POINTS; n++)
          table->coefficients[(i * functions + f) * POINTS + n] += matrix[n][p] * value[f];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSplineDestroy(SamSpline *table)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(table->centre, table->scale, table->coefficients));
  *table = (SamSpline){.least = 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

SAM_VECTORIZED static void Horner(const double *restrict c, double centre, double scale, PetscInt n,
                                  const double *restrict s, double *restrict values)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    const double t = (s[i] - centre) * scale;
    double       v = c[SAM_SPLINE_DEGREE];

    for (int d = SAM_SPLINE_DEGREE - 1; d >= 0; d--) v = v * t + c[d];
    values[i] = v;
  }
}

static int IntervalOf(const SamSpline *table, double s)
{
  const int i = NumberOf(s) - table->first + 1;

  return i > 0 ? i : 0;
}

void SamSplineRow(const SamSpline *table, int function, PetscInt n, const double s[], double values[])
{
  for (PetscInt k = 0, end; k < n; k = end) {
    const int     i = IntervalOf(table, s[k]), last = PetscMin(i, table->intervals - 1);
    const double *c = table->coefficients + (last * table->functions + function) * POINTS;

    for (end = k + 1; end < n && IntervalOf(table, s[end]) == i;) end++;
    if (i == last)
      Horner(c, table->centre[i], table->scale[i], end - k, s + k, values + k);
    else
      for (PetscInt l = k; l < end; l++)
        Horner(c, table->centre[last], table->scale[last], 1, &table->most, values + l);
  }
}

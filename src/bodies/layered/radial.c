/*
  Transforms functions of the wave number g(k) to functions in space, by Hankel transforms
    f(r) = H_n[g](r) = (1/2 pi) int_0^inf g(k) J_n(kr) dk.

  Algorithm (Talman 1978, J. Comput. Phys. 29, 35; Hamilton 2000, MNRAS 312, 257). g is smooth in x = ln k for any
  thicknesses, and the transform is a convolution in x:
    1. The image g(0) exp(-k Z), where Z is the thickness of all layers, is subtracted, as its transform is known:
       (r/(rho + Z))^n/rho, rho^2 = r^2 + Z^2. The remainder is O(k). Each of two bodies may have its own image.
    2. The remainder is sampled at equal steps of x. Of its Fourier coefficients c_m at the frequencies w_m,
       r f(r) at ln r = y is the sum of c_m M_m exp(-i w_m (x0 + y)), with the Mellin transform of the kernel,
       M = 2^iw Gamma((1 + n + iw)/2)/Gamma((1 + n - iw)/2): one transform gives all r.
    3. Between the samples r f is interpolated in ln r by 12 points.
    4. For r below 0.15 of the depth over which g decays, a power series with the moments of g is used.
  The table contains f/r^n, functions of r^2 that are analytic at 0. The error is 1e-13 relative to the size of f.

  Along a line, (1/pi) int g cos kr dk and (1/pi) int g sin kr dk are such transforms of g sqrt(2 pi k) of the orders n
  - 1/2, n = 0 and 1, times sqrt(r), and use the same table. Its images are Z/(pi rho^2) and r/(pi rho^2).
*/
#include "layered.h"
#include <complex.h>
#include <fftw3.h>

#define STEP    0.04
#define NEAR    0.15 /* relative to the depth; the series is used below */
#define TERMS   10
#define AROUND  12    /* points of the interpolation */
#define FASTEST 200.0 /* largest k times the depth */

typedef struct {
  const SamRadialSource *of;
  double                 x0, y0;                 /* ln k and ln r of the first samples */
  int                    n;                      /* number of samples */
  double                *remainder[SAM_RADIALS]; /* remainders of the functions of k, then r f(r) */
  double                 moments[SAM_RADIALS][TERMS];
} Transform;

static double OrderOf(const SamRadialSource *of, int f)
{
  return of->orders[f] - (of->line ? 0.5 : 0);
}

/* Computes the samples without images, and the moments with them. */
static void Sample(Transform *t)
{
  const SamRadialSource *of    = t->of;
  const double           depth = of->depth;
  double                 g[SAM_RADIALS];

  for (int i = 0; i < t->n; i++) {
    const double k = exp(t->x0 + i * STEP), factor = of->line ? sqrt(2 * PETSC_PI * k) : 1;

    (*of->values)(of->context, k, g);
    for (int f = 0; f < of->functions; f++) {
      double power = factor * g[f] * k * STEP / (2 * PETSC_PI) * pow(k * depth, OrderOf(of, f));

      for (int j = 0; j < TERMS; j++, power *= k * depth * k * depth) t->moments[f][j] += power;
      for (int b = 0; b < 2; b++) g[f] -= of->image[b][f] * exp(-k * of->thickness[b]);
      t->remainder[f][i] = factor * g[f];
    }
  }
}

/* Returns the imaginary part of ln Gamma(x + iy), by Stirling's series at a larger argument. */
static double ImaginaryLogGamma(double x, double y)
{
  double complex z     = x + I * y, series;
  double         shift = 0;

  for (; cabs(z) < 12 || creal(z) < 8; z += 1) shift += carg(z);
  series =
    (z - 0.5) * clog(z) - z + (1 / 12.0 - (1 / 360.0 - (1 / 1260.0 - 1 / (1680.0 * z * z)) / (z * z)) / (z * z)) / z;
  return cimag(series) - shift;
}

/* Transforms samples of a remainder to r f(r), in place. */
static PetscErrorCode Convolve(const Transform *t, double order, double samples[])
{
  const int       n = t->n;
  double complex *c;
  fftw_plan       plan;

  PetscFunctionBegin;
  c = (double complex *)fftw_malloc(sizeof(*c) * (size_t)(n / 2 + 1));
  PetscCheck(c, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for %d wave numbers", n);
  plan = fftw_plan_dft_r2c_1d(n, samples, (fftw_complex *)c, FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
  PetscCheck(plan, PETSC_COMM_SELF, PETSC_ERR_LIB, SAM_NO_PLAN);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
  for (int m = 0; m <= n / 2; m++) {
    const double w     = 2 * PETSC_PI * m / (n * STEP);
    const double phase = w * log(2) + 2 * ImaginaryLogGamma(0.5 * (1 + order), 0.5 * w) - w * (t->x0 + t->y0);

    c[m] = conj(c[m] * cexp(I * phase)) / (2 * PETSC_PI * n);
  }
  plan = fftw_plan_dft_c2r_1d(n, (fftw_complex *)c, samples, FFTW_ESTIMATE);
  PetscCheck(plan, PETSC_COMM_SELF, PETSC_ERR_LIB, SAM_NO_PLAN);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
  fftw_free(c);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes weights[k] of the sample first + k, for the interpolation at ln r; returns `first`. */
static int Interpolation(const Transform *t, double r, double weights[AROUND])
{
  const double at    = (log(r) - t->y0) / STEP;
  const int    first = (int)floor(at) - AROUND / 2 + 1;
  double       sum = 0, binomial = 1;

  for (int k = 0; k < AROUND; k++) {
    const double distance = at - first - k;

    if (fabs(distance) < 1e-12) {
      for (int l = 0; l < AROUND; l++) weights[l] = l == k ? 1 : 0;
      return first;
    }
    weights[k] = (k % 2 ? -1 : 1) * binomial / distance;
    sum += weights[k];
    binomial *= (double)(AROUND - 1 - k) / (k + 1);
  }
  for (int k = 0; k < AROUND; k++) weights[k] /= sum;
  return first;
}

/* Returns f(r)/r^n by the series. */
static double Series(const Transform *t, int f, double s)
{
  const double n = OrderOf(t->of, f), x = -0.25 * s / (t->of->depth * t->of->depth);
  double       term = pow(2 * t->of->depth, -n) / tgamma(1 + n), sum = 0;

  for (int j = 0; j < TERMS; j++) {
    sum += term * t->moments[f][j];
    term *= x / ((j + 1.0) * (j + 1.0 + n));
  }
  return sum;
}

static void Values(const void *context, double s, double values[])
{
  const Transform       *t  = (const Transform *)context;
  const SamRadialSource *of = t->of;
  const double           r  = sqrt(s);
  double                 weights[AROUND];
  int                    first = 0;

  if (r > NEAR * of->depth) first = Interpolation(t, r, weights);
  for (int f = 0; f < of->functions; f++) {
    if (r <= NEAR * of->depth) {
      values[f] = Series(t, f, s);
      continue;
    }
    values[f] = 0;
    for (int k = 0; k < AROUND; k++) values[f] += weights[k] * t->remainder[f][(first + k) % t->n];
    values[f] *= pow(r, -1 - OrderOf(of, f));
    for (int b = 0; b < 2; b++) {
      const double Z = of->thickness[b], rho = hypot(r, Z);

      if (of->image[b][f] != 0 && of->line)
        values[f] += of->image[b][f] / (PETSC_PI * rho * rho) * (of->orders[f] ? 1 : Z);
      else if (of->image[b][f] != 0)
        values[f] += of->image[b][f] / (2 * PETSC_PI * rho) * pow(rho + Z, -of->orders[f]);
    }
  }
}

PetscErrorCode SamRadialCreate(const SamRadialSource *of, double r, SamSpline *table)
{
  const double depth = of->depth, near = NEAR * depth;
  /* cos kr does not vanish for long waves, which requires twice as many samples */
  Transform t = {
    .of = of, .y0 = -log(FASTEST / depth), .x0 = (of->line ? 2 : 1) * log(SAM_LONG_WAVE) - log(of->longest)};

  PetscFunctionBegin;
  t.n = (int)ceil((log(FASTEST / depth) - t.x0) / STEP);
  for (int f = 0; f < of->functions; f++) PetscCall(PetscMalloc1(t.n, &t.remainder[f]));
  Sample(&t);
  for (int f = 0; f < of->functions; f++) PetscCall(Convolve(&t, OrderOf(of, f), t.remainder[f]));
  /* Starts at a power of 2. */
  PetscCall(SamSplineCreate(table, of->functions, exp2(floor(log2(near * near))), r * r, Values, &t));
  for (int f = 0; f < of->functions; f++) PetscCall(PetscFree(t.remainder[f]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Thermal stress in a half-space by heat that flows into its surface, which is free of tractions.

  A body that stands: steady heat has no stress on planes parallel to the surface. With the potential of the
  temperature, T = psi_xx + psi_yy, the others are -E alpha psi_yy, -E alpha psi_xx, and E alpha psi_xy (xx, yy, xy),
  where unit heat in a point has
      psi = [R - z ln(R + z)]/(2 pi conductivity),   R^2 = x^2 + y^2 + z^2.
  The second derivatives are integrated over the cell in closed form, and summed over cells without periodic images.

  A body that moves: each wave exp(i k.x) of the temperature of the surface decays like exp(-kappa z) with depth,
  kappa^2 = k^2 + i kx speed/D, and has the stresses of SamThermalStressWave(). The temperature is that of the heat on
  the grid, without images (heatoperator.c), on a grid of twice its sides, and its waves have twice the period again;
  beyond that it is taken for 0. The trail of a fast body is thin there and its stress is not felt at the contact; of a
  slow body it is not, and such bodies are refused. The longest waves along x stand for ranges of wave numbers in which
  kappa changes quickly, and have the means over them.

  Sources: Barber 1984, J. Appl. Mech. 51, 636; Liu and Wang 2001, J. Tribol. 123, 17; Boley and Weiner 1960, Theory of
  Thermal Stresses.
*/
#include "heatimpl.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/private/stress.h>
#include <complex.h>
#include <math.h>

enum { XX, YY, XY, KERNELS };
#define LEAST 40   /* speed times the longer side of the grid over the diffusivity, of bodies that move */
#define WAVES 6    /* along x, the longest, whose stresses are means */
#define SMALL 0.05 /* times depth: shorter differences kappa - k are expanded in series */

struct _n_SamThermalStress {
  SamGrid     grid;
  SamHeatBody body;
  double      poisson;
  PetscReal   depth; /* of the kernels; negative: none */
  SamFourier  fourier;
  /* a body that stands */
  SamKernel kernel[KERNELS];
  /* a body that moves */
  SamGrid      wide; /* of twice the sides */
  SamWindow    window;
  SamConductor conductor;
};

/* ---- a wave ---- */

/* Returns [exp(-x) - 1 + x]/x^2. */
static double complex Second(double complex x)
{
  double complex term = 0.5, sum = 0.5;

  if (cabs(x) > SMALL) return (cexp(-x) - 1 + x) / (x * x);
  for (int n = 3; n < 12; n++) {
    term *= -x / n;
    sum += term;
  }
  return sum;
}

void SamThermalStressWave(double k, const double kappa[2], double poisson, double z,
                          double stress[SAM_THERMAL_PARTS][2])
{
  const double complex q = CMPLX(kappa[0], kappa[1]), d = q - k, m = q + k;
  const double complex below = exp(-k * z), g = z * z * below * Second(d * z); /* (E1 - E2 + d z E2)/d^2 */
  double complex       part[SAM_THERMAL_PARTS];

  part[SAM_THERMAL_NN] = -d * (q * q * g - m * z * below + below) / m;
  part[SAM_THERMAL_TT] = -cexp(-q * z) + 2 * poisson * k / m * below;
  part[SAM_THERMAL_ZZ] = k * k * d * g / m;
  part[SAM_THERMAL_NZ] = -k * d * (q * g - z * below) / m;
  for (int p = 0; p < SAM_THERMAL_PARTS; p++) {
    stress[p][0] = creal(part[p]);
    stress[p][1] = cimag(part[p]);
  }
}

/* The input of a pass of the filter: wave numbers of the first waves (1/m), and which stresses it makes. */
typedef struct {
  double step[2], drift, poisson, depth, gain;
  int    pass; /* 0: xx, yy, xy; 1: zz, xz, yz */
} Waves;

/* Computes the three stresses of a wave. `odd`: along x, y; 0 for the shortest wave, which has no phase. */
static void FindStresses(const Waves *w, double kx, double ky, const double odd[2], double complex stress[3])
{
  const double         k = hypot(kx, ky), c = kx / k, s = ky / k;
  const double complex root     = csqrt(CMPLX(k * k, odd[0] * kx * w->drift));
  const double         kappa[2] = {creal(root), cimag(root)};
  double               of[SAM_THERMAL_PARTS][2];
  double complex       part[SAM_THERMAL_PARTS];

  SamThermalStressWave(k, kappa, w->poisson, w->depth, of);
  for (int p = 0; p < SAM_THERMAL_PARTS; p++) part[p] = CMPLX(of[p][0], of[p][1]);
  if (w->pass == 0) {
    stress[0] = c * c * part[SAM_THERMAL_NN] + s * s * part[SAM_THERMAL_TT];
    stress[1] = s * s * part[SAM_THERMAL_NN] + c * c * part[SAM_THERMAL_TT];
    stress[2] = odd[0] * odd[1] * c * s * (part[SAM_THERMAL_NN] - part[SAM_THERMAL_TT]);
  } else {
    stress[0] = part[SAM_THERMAL_ZZ];
    stress[1] = odd[0] * I * c * part[SAM_THERMAL_NZ];
    stress[2] = odd[1] * I * s * part[SAM_THERMAL_NZ];
  }
}

/*
  Computes the mean stresses of the waves that the i-th one along x stands for. For those along the stream, kappa
  changes from abs(ky) to the square root of kx drift within kx = ky^2/drift, a small part of the distance of two waves.
*/
static void FindMean(const Waves *w, PetscInt i, double ky, const double odd[2], double complex mean[3])
{
  static const double x[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, weight[3] = {5. / 18, 8. / 18, 5. / 18};
  double              from = 0, to = i ? 1 : 0x1p-16; /* times the half distance */

  mean[0] = mean[1] = mean[2] = 0;
  for (; from < 1; from = to, to *= 2)
    for (int n = 0; n < 3; n++)
      for (int side = -1; side <= 1; side += 2) {
        const double   kx = w->step[0] * ((double)i + 0.5 * side * (from + (to - from) * x[n]));
        double complex one[3];

        FindStresses(w, kx, ky, odd, one);
        for (int m = 0; m < 3; m++) mean[m] += 0.5 * (to - from) * weight[n] * one[m];
      }
}

/* Multiplies the spectrum of the temperature at the i-th wave along x, the j-th along y, by those of three stresses. */
static void Multiply(const Waves *w, PetscInt i, PetscInt j, const double odd[2], double (*const z[3])[2])
{
  const double complex t = CMPLX(z[0][0][0], z[0][0][1]) * w->gain;
  double complex       stress[3];

  if (i < WAVES)
    FindMean(w, i, w->step[1] * (i || j ? (double)j : 0.25), odd, stress);
  else
    FindStresses(w, w->step[0] * (double)i, w->step[1] * (double)j, odd, stress);
  for (int n = 0; n < 3; n++) {
    z[n][0][0] = creal(stress[n] * t);
    z[n][0][1] = cimag(stress[n] * t);
  }
}

/* Filters the columns of a block in padded mode. */
static void Filter(const SamFourierBlock *block, const void *context)
{
  const Waves   *w    = (const Waves *)context;
  const PetscInt last = block->phases * block->hx, all = block->phases * block->hy;

  for (PetscInt f = 0; f < block->phases; f++)
    for (PetscInt b = 0; b < block->columns; b++)
      for (PetscInt m = 0; m < block->hy; m++) {
        const PetscInt  i = block->first + b, j = block->phases * m + f, wave = 2 * j > all ? j - all : j;
        const ptrdiff_t at     = (f * block->width + b) * (ptrdiff_t)block->stride + m;
        const double    odd[2] = {2 * i == last ? 0 : 1, 2 * j == all ? 0 : 1};
        double(*const z[3])[2] = {block->data[0] + at, block->data[1] + at, block->data[2] + at};

        Multiply(w, i, wave, odd, z);
      }
}

/* Adds the stresses of a body that moves. */
static PetscErrorCode AddWaves(SamThermalStress t, PetscReal depth, Vec flux, double factor, Vec stress)
{
  static const int components[2][3] = {{SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY},
                                       {SAM_STRESS_ZZ, SAM_STRESS_XZ, SAM_STRESS_YZ}};
  const PetscInt   cells            = t->grid->cells;
  Waves            w                = {.drift   = (double)(t->body.speed / t->body.conductivity * t->body.capacity),
                                       .poisson = t->poisson,
                                       .depth   = (double)depth};
  Vec              surface, part, out[3];
  PetscInt         h[2];
  double          *to;

  PetscFunctionBegin;
  PetscCall(SamFourierGetPeriods(t->fourier, &h[0], &h[1]));
  w.step[0] = PETSC_PI / ((double)h[0] * t->wide->dx);
  w.step[1] = PETSC_PI / ((double)h[1] * t->wide->dy);
  w.gain    = factor / (1 - t->poisson) / (4 * (double)h[0] * (double)h[1]);
  PetscCall(SamGridCreateVec(t->wide, 1, &surface));
  PetscCall(SamGridCreateVec(t->grid, 1, &part));
  for (int n = 0; n < 3; n++) PetscCall(SamGridCreateVec(t->wide, 1, &out[n]));
  PetscCall(SamWindowPut(t->window, flux, surface));
  PetscCall(SamConductorApply(t->conductor, surface, surface));
  for (w.pass = 0; w.pass < 2; w.pass++) {
    const SamFourierFilter filter = {SAM_FOURIER_PADDED, 1, 3, Filter, &w};
    const double          *in;
    double                *a[3];

    PetscCall(VecGetArrayRead(surface, &in));
    for (int n = 0; n < 3; n++) PetscCall(VecGetArray(out[n], &a[n]));
    PetscCall(SamFourierApply(t->fourier, &filter, &in, a));
    for (int n = 0; n < 3; n++) PetscCall(VecRestoreArray(out[n], &a[n]));
    PetscCall(VecRestoreArrayRead(surface, &in));
    for (int n = 0; n < 3; n++) {
      const double *from;

      PetscCall(SamWindowTake(t->window, out[n], part));
      PetscCall(VecGetArrayRead(part, &from));
      PetscCall(VecGetArray(stress, &to));
      for (PetscInt m = 0; m < cells; m++) to[components[w.pass][n] * (ptrdiff_t)cells + m] += from[m];
      PetscCall(VecRestoreArray(stress, &to));
      PetscCall(VecRestoreArrayRead(part, &from));
    }
  }
  for (int n = 0; n < 3; n++) PetscCall(VecDestroy(&out[n]));
  PetscCall(VecDestroy(&part));
  PetscCall(VecDestroy(&surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a body that stands ---- */

/* A cell as a source, lengths in m. */
typedef struct {
  double half[2], side[2], z, factor;
} Standing;

/* Returns the integral of psi_xx over the rectangle between the origin and (x, y): of x/(R + z) along y. */
static double Corner(double x, double y, double z)
{
  const double R = sqrt(x * x + y * y + z * z);

  return x * log(y + R) + z * (atan2(z * y, x * R) - atan2(y, x));
}

/* Returns psi at a corner. */
static double Potential(double x, double y, double z)
{
  const double R = sqrt(x * x + y * y + z * z);

  return R - (z > 0 ? z * log(R + z) : 0);
}

/* Computes the stresses at the lags (i, j), i = 0 ... count - 1. */
static void FillRow(PetscInt j, PetscInt count, double *const values[], const void *context)
{
  const Standing *s = (const Standing *)context;

  for (PetscInt i = 0; i < count; i++) {
    const double x = (double)i * s->side[0], y = (double)j * s->side[1];

    for (int k = 0; k < KERNELS; k++) values[k][i] = 0;
    for (int a = -1; a <= 1; a += 2)
      for (int b = -1; b <= 1; b += 2) {
        const double at[2] = {x + a * s->half[0], y + b * s->half[1]}, sign = a * b * s->factor;

        values[XX][i] -= sign * Corner(at[1], at[0], s->z); /* -psi_yy */
        values[YY][i] -= sign * Corner(at[0], at[1], s->z);
        values[XY][i] += sign * Potential(at[0], at[1], s->z);
      }
  }
}

static PetscErrorCode SetKernels(SamThermalStress t, PetscReal depth)
{
  static const PetscBool odd[KERNELS][2] = {
    {PETSC_FALSE, PETSC_FALSE}, {PETSC_FALSE, PETSC_FALSE}, {PETSC_TRUE, PETSC_TRUE}};
  const Standing s = {{0.5 * (double)t->grid->area[0], 0.5 * (double)t->grid->area[1]},
                      {(double)t->grid->area[0], (double)t->grid->area[1]},
                      (double)depth,
                      1 / (2 * PETSC_PI * (double)t->body.conductivity)};

  PetscFunctionBegin;
  if (t->depth == depth) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < KERNELS; k++) PetscCall(SamKernelDestroy(&t->kernel[k]));
  PetscCall(SamKernelsCreate(t->fourier, KERNELS, odd, FillRow, &s, t->kernel));
  t->depth = depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddStanding(SamThermalStress t, PetscReal depth, Vec flux, double factor, Vec stress)
{
  static const int components[KERNELS] = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY};
  const PetscInt   cells               = t->grid->cells;
  const double    *q;
  double          *to, *one;

  PetscFunctionBegin;
  PetscCall(SetKernels(t, depth));
  PetscCall(PetscMalloc1(cells, &one));
  PetscCall(VecGetArrayRead(flux, &q));
  PetscCall(VecGetArray(stress, &to));
  for (int k = 0; k < KERNELS; k++) {
    PetscCall(SamConvolveSum(t->fourier, 1, &t->kernel[k], q, one));
    for (PetscInt m = 0; m < cells; m++) to[components[k] * (ptrdiff_t)cells + m] += factor * one[m];
  }
  PetscCall(VecRestoreArray(stress, &to));
  PetscCall(VecRestoreArrayRead(flux, &q));
  PetscCall(PetscFree(one));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the operator ---- */

/* Creates the wide grid, with the other in its middle: the margins on both sides are equal. */
static PetscErrorCode CreateWide(SamThermalStress t)
{
  const SamGrid   g       = t->grid;
  const PetscInt  part[2] = {g->nx, g->ny}, first[2] = {(g->nx + 1) / 2, (g->ny + 1) / 2};
  const PetscInt  n[2]      = {g->nx + 2 * first[0], g->ny + 2 * first[1]};
  const PetscReal size[2]   = {(PetscReal)n[0] * g->dx, (PetscReal)n[1] * g->dy};
  const PetscReal centre[2] = {0, 0};

  PetscFunctionBegin;
  PetscCall(SamGridCreate(g->comm, n, size, centre, &t->wide));
  PetscCall(SamWindowCreate(t->wide, first, part, &t->window));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamThermalStressLeast(SamGrid grid, const SamHeatBody *body)
{
  const PetscReal longest = PetscMax((PetscReal)grid->nx * grid->dx, (PetscReal)grid->ny * grid->dy);

  return LEAST * body->conductivity / body->capacity / longest;
}

PetscErrorCode SamThermalStressCreate(SamGrid grid, const SamFourierSettings *settings, const SamHeatBody *body,
                                      PetscReal poisson, SamThermalStress *thermal)
{
  const PetscBool  moves = body->speed != 0 ? PETSC_TRUE : PETSC_FALSE;
  SamThermalStress t;

  PetscFunctionBegin;
  PetscCheck(!moves || PetscAbsReal(body->speed) >= SamThermalStressLeast(grid, body), grid->comm, PETSC_ERR_SUP,
             "The body moves at %.3g m/s: expected 0, or at least %.3g m/s on this grid", fabs((double)body->speed),
             (double)SamThermalStressLeast(grid, body));
  PetscCall(PetscNew(&t));
  *t       = (struct _n_SamThermalStress){.grid = grid, .body = *body, .poisson = (double)poisson, .depth = -1};
  *thermal = t;
  PetscCall(SamGridReference(grid));
  if (moves) {
    PetscCall(CreateWide(t));
    PetscCall(SamConductorCreate(t->wide, settings, body, 0, &t->conductor));
  }
  PetscCall(SamFourierCreate(moves ? t->wide : grid, SAM_FOURIER_FAST, settings, &t->fourier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamThermalStressAdd(SamThermalStress t, PetscReal depth, Vec flux, PetscReal factor, Vec stress)
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(t->grid, 1, flux, "Flux"));
  PetscCall(SamGridCheckVec(t->grid, SAM_STRESS_COMPONENTS, stress, "Stress"));
  PetscCall((t->wide ? AddWaves : AddStanding)(t, depth, flux, (double)factor, stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamThermalStressDestroy(SamThermalStress *thermal)
{
  SamThermalStress t = *thermal;

  PetscFunctionBegin;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < KERNELS; k++) PetscCall(SamKernelDestroy(&t->kernel[k]));
  PetscCall(SamConductorDestroy(&t->conductor));
  PetscCall(SamFourierDestroy(&t->fourier));
  PetscCall(SamWindowDestroy(&t->window));
  PetscCall(SamGridDestroy(&t->wide));
  PetscCall(SamGridDestroy(&t->grid));
  PetscCall(PetscFree(*thermal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bytes per cell: three kernels and their spectra; of the wide grid kernels of two parts, five fields, three spectra */
double SamThermalStressBytes(SamThermalStress t)
{
  return t->wide ? 160 * (double)t->wide->cells : 64 * (double)t->grid->cells;
}

/*
  The spectral preconditioners of half-spaces.

  On an infinite surface a wave of pressure exp(i k.x) gives the displacement 2 pi A/|k| times itself, A = pair->normal,
  so that |k| is the inverse up to a factor. For shear the symbol is (2 pi (A + B)/|k|)(I - nu kk'/|k|^2), B =
  pair->shear_xx, nu = B/(A + B), with the inverse (|k|/(2 pi (A + B)))(I + nu/(1 - nu) kk'/|k|^2). Here they act on the
  periodic grid, which costs a quarter of a padded transform and needs as few iterations. The symbol is recomputed each
  time. Single precision suffices for an approximation. `local`: A or A + B. Layered bodies take their symbols from
  tables, which contain all of the gain but the factor of the transforms.
*/
#include "../layered/layeredwaves.h"
#include "inverse.h"
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/fourier.h>
#include <math.h>

static PetscErrorCode Precondition(SamElasticity e, PetscInt n, double factor, double local, SamSymbol s,
                                   const float *const in[], float *const out[])
{
  const SamLayered layers = SamHalfSpaceLayers(e);
  PetscInt         hx, hy;

  PetscFunctionBegin;
  PetscCall(SamFourierGetPeriods(e->fourier, &hx, &hy));
  s.step[0] = 2 * PETSC_PI / (double)hx * e->grid->length / e->grid->dx;
  s.step[1] = e->traits.plane ? s.step[0] : 2 * PETSC_PI / (double)hy * e->grid->length / e->grid->dy;
  s.gain    = factor / (2 * PETSC_PI * local * (double)hx * (double)hy * e->grid->length);
  s.mean    = 0.5 * PetscMin(s.step[0], s.step[1]);
  s.film    = SamPairFilm(e->pair) / (2 * PETSC_PI * local * e->grid->length);
  if (layers) {
    PetscCall(SamLayeredSymbolSet(layers, e->grid->length, hx, hy, &s));
    s.gain     = factor / ((double)hx * (double)hy * e->grid->length);
    s.film     = SamPairFilm(e->pair) / e->grid->length;
    s.inverse  = PETSC_TRUE;
    s.multiply = n == 1 ? SamLayeredMultiplyNormalSingle : SamLayeredMultiplyTangentialSingle;
  }
  PetscCall(SamSymbolApplySingle(e, &s, n, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies by B = gain |k| (I + nu kk'/|k|^2), or, with a film, by the inverse of (inverse of B, plus film). */
SAM_VECTORIZED static void DivideTangential(const SamSymbol *s, SamWaves at)
{
  const float gain = (float)s->gain, mean = (float)s->mean, extra = (float)s->nu, least = mean * mean,
              step = (float)s->step[1], kx = (float)at.kx, sign = (float)at.cross, film = (float)s->film;
  float(*restrict x)[2] = (float(*)[2])at.x, (*restrict y)[2] = (float(*)[2])at.y;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > least ? k2 : least,
                k = sqrtf(some), g = gain * k / (1 + film * k);
    const float part = g * extra / some / (1 + film * k * (1 + extra)), cross = sign * part * kx * ky,
                gx = g + part * kx * kx, gy = g + part * ky * ky;
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = gx * x0 + cross * y0;
    x[m][1] = gx * x1 + cross * y1;
    y[m][0] = gy * y0 + cross * x0;
    y[m][1] = gy * y1 + cross * x1;
  }
}

/*
  In slip of rolling bodies, steadyoperator.c needs the inverse of h A + 1 - h with A = C (1 - S), where S is the shift
  by a cell along x. With M = 1/C it is the inverse of 1 - h S, which steadyoperator.c applies along each row, times
      M (1 - h S)/(h (1 - S) + (1 - h) M),
  where h = SAM_SLIP_WEIGHT everywhere. M alone would be right for the shortest waves only.
*/
SAM_VECTORIZED static void DivideSlip(const SamSymbol *s, SamWaves at)
{
  const float h = (float)SAM_SLIP_WEIGHT, c = h * (float)cos(s->lag * at.kx), i = h * (float)sin(s->lag * at.kx),
              unit = (1 - h) * (float)s->slip, mean = (float)s->mean, least = mean * mean, step = (float)s->step[1],
              kx = (float)at.kx, film = (float)s->film;
  float(*restrict x)[2] = (float(*)[2])at.x, (*restrict y)[2] = (float(*)[2])at.y;

  DivideTangential(s, at);
#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, k = sqrtf(k2 > least ? k2 : least),
                below = h - c + unit * k / (1 + film * k), scale = 1 / (below * below + i * i),
                re = scale * ((1 - c) * below + i * i), im = scale * i * (1 - c - below);
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = re * x0 - im * x1;
    x[m][1] = im * x0 + re * x1;
    y[m][0] = re * y0 - im * y1;
    y[m][1] = im * y0 + re * y1;
  }
}

PetscErrorCode SamHalfSpacePreconditionNormal(SamElasticity e, double factor, const float *const r[], float *const p[])
{
  return Precondition(e, 1, factor, e->pair->normal, (SamSymbol){.multiply = SamSymbolDivideNormal}, r, p);
}

/* A wave of pressure that takes the shear m with it lifts the surface by 1 + i beta m.k/|k| times as much. */
PetscErrorCode SamHalfSpacePreconditionSliding(SamElasticity e, double factor, const double slope[2],
                                               const float *const r[], float *const p[])
{
  const double    beta = (double)e->pair->dundurs;
  const SamSymbol s    = {.turn = {beta * slope[0], beta * slope[1]}, .multiply = SamSymbolDivideNormal};

  return Precondition(e, 1, factor, e->pair->normal, s, r, p);
}

PetscErrorCode SamHalfSpacePreconditionTangential(SamElasticity e, double factor, const float *const r[],
                                                  float *const q[])
{
  const SamSymbol s = {.nu = e->pair->shear_xx / e->pair->shear, .multiply = DivideTangential};

  return Precondition(e, 2, factor, e->pair->shear + e->pair->shear_xx, s, r, q);
}

PetscErrorCode SamHalfSpacePreconditionSlip(SamElasticity e, double factor, const float *const r[], float *const q[])
{
  const double    local = e->pair->shear + e->pair->shear_xx;
  const SamSymbol s     = {.nu       = e->pair->shear_xx / e->pair->shear,
                           .lag      = e->grid->dx / e->grid->length,
                           .slip     = factor / (2 * PETSC_PI * local * e->grid->length),
                           .multiply = DivideSlip};

  return Precondition(e, 2, factor, local, s, r, q);
}

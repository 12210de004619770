/*
  The spectral preconditioner.

  On an infinite surface a wave of pressure exp(i k.x) gives the displacement 2 pi A/|k| times itself, A = pair.normal,
  so that |k| is the inverse up to a factor. For shear the symbol is (2 pi (A + B)/|k|)(I - nu kk'/|k|^2), B =
  pair.shear_xx, nu = B/(A + B), with the inverse (|k|/(2 pi (A + B)))(I + nu/(1 - nu) kk'/|k|^2). Here they act on the
  grid made periodic, which costs a quarter of a padded transform and needs as few iterations. The symbol is computed
  anew each time. Single precision will do for an approximation.
*/
#include "halfspaceimpl.h"
#include <math.h>

typedef struct {
  double step[2]; /* wave number of the first harmonic, 2 pi/period, in units of 1/length of the grid */
  double gain;    /* 1/(2 pi A) or 1/(2 pi (A + B)), times a factor and the transforms' normalisation */
  double extra;   /* nu/(1 - nu) */
  double mean;    /* stands for |k| at k = 0 */
} Symbol;

static PetscErrorCode GetSymbol(SamElasticity e, PetscBool tangential, double factor, Symbol *symbol)
{
  const SamPair *pair  = &e->pair;
  const double   local = tangential ? pair->shear + pair->shear_xx : pair->normal;
  PetscInt       hx, hy;

  PetscFunctionBegin;
  PetscCall(SamFourierGetPeriods(e->fourier, &hx, &hy));
  /* wave numbers in units of 1/length of the grid, so that their squares are numbers that floats hold */
  symbol->step[0] = 2 * PETSC_PI / (double)hx * e->grid->length / e->grid->dx;
  symbol->step[1] = 2 * PETSC_PI / (double)hy * e->grid->length / e->grid->dy;
  symbol->gain    = factor / (2 * PETSC_PI * local * (double)hx * (double)hy * e->grid->length);
  symbol->extra   = tangential ? pair->shear_xx / pair->shear : 0;
  symbol->mean    = 0.5 * PetscMin(symbol->step[0], symbol->step[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries first ... last - 1 of a column: ky = step (m - origin). */
typedef struct {
  PetscInt first, last, origin;
} Stretch;

/* Times gain |k|, with `mean` for |k| of the mean. */
SAM_VECTORIZED static void FilterPartNormal(const Symbol *s, float kx, Stretch at, float (*restrict column)[2])
{
  const float gain = (float)s->gain, mean = (float)s->mean, step = (float)s->step[1];

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k = sqrtf(kx * kx + ky * ky), g = gain * (k > mean ? k : mean);

    column[m][0] *= g;
    column[m][1] *= g;
  }
}

/*
  Times gain |k| (I + extra kk'/|k|^2). `sign`: 1; 0 for a wave of two cells' length, which is its own mirror image, so
  that the cross term has no sign.
*/
SAM_VECTORIZED static void FilterPartTangential(const Symbol *s, float kx, float sign, Stretch at,
                                                float (*restrict x)[2], float (*restrict y)[2])
{
  const float gain = (float)s->gain, mean = (float)s->mean, extra = (float)s->extra, least = mean * mean,
              step = (float)s->step[1];

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > least ? k2 : least,
                g    = gain * sqrtf(some);
    const float part = g * extra / some, cross = sign * part * kx * ky, gx = g + part * kx * kx,
                gy = g + part * ky * ky;
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = gx * x0 + cross * y0;
    x[m][1] = gx * x1 + cross * y1;
    y[m][0] = gy * y0 + cross * x0;
    y[m][1] = gy * y1 + cross * x1;
  }
}

static void FilterNormal(const SamFourierBlock *block, const void *context)
{
  const Symbol  *s  = (const Symbol *)context;
  const PetscInt hy = block->hy, half = hy / 2 + 1;

  for (PetscInt b = 0; b < block->columns; b++) {
    float(*column)[2] = block->single[0] + (ptrdiff_t)b * block->stride;
    const float kx    = (float)(s->step[0] * (double)(block->first + b));

    FilterPartNormal(s, kx, (Stretch){0, half, 0}, column);
    FilterPartNormal(s, kx, (Stretch){half, hy, hy}, column);
  }
}

static void FilterTangential(const SamFourierBlock *block, const void *context)
{
  const Symbol  *s  = (const Symbol *)context;
  const PetscInt hy = block->hy, half = (hy + 1) / 2;

  for (PetscInt b = 0; b < block->columns; b++) {
    float(*x)[2]     = block->single[0] + (ptrdiff_t)b * block->stride,
    (*y)[2]          = block->single[1] + (ptrdiff_t)b * block->stride;
    const float kx   = (float)(s->step[0] * (double)(block->first + b)),
                sign = 2 * (block->first + b) == block->hx ? 0 : 1;

    FilterPartTangential(s, kx, sign, (Stretch){0, half, 0}, x, y);
    if (hy % 2 == 0) FilterPartTangential(s, kx, 0, (Stretch){half, half + 1, 0}, x, y);
    FilterPartTangential(s, kx, sign, (Stretch){hy / 2 + 1, hy, hy}, x, y);
  }
}

PetscErrorCode SamHalfSpacePreconditionNormal(SamElasticity e, double factor, const float *const residual[],
                                              float *const p[])
{
  Symbol                 symbol;
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, 1, 1, FilterNormal, &symbol};

  PetscFunctionBegin;
  PetscCall(GetSymbol(e, PETSC_FALSE, factor, &symbol));
  PetscCall(SamFourierApplySingle(e->fourier, &filter, residual, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHalfSpacePreconditionTangential(SamElasticity e, double factor, const float *const residual[],
                                                  float *const q[])
{
  Symbol                 symbol;
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, 2, 2, FilterTangential, &symbol};

  PetscFunctionBegin;
  PetscCall(GetSymbol(e, PETSC_TRUE, factor, &symbol));
  PetscCall(SamFourierApplySingle(e->fourier, &filter, residual, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Products of spectra with symbols, column by column. */
#include "waves.h"
#include <petsam/private/fourier.h>
#include <math.h>

static PetscBool Turns(const SamSymbol *s)
{
  return s->turn[0] != 0 || s->turn[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Divides by 1 + i turn.k/|k|; a wave that is its own mirror image has a real symbol, 1. */
SAM_VECTORIZED static void Turn(const SamSymbol *s, SamWaves at)
{
  const float along = (float)(at.cross * s->turn[0] * at.kx), across = (float)(at.cross * s->turn[1]),
              kx = (float)at.kx, step = (float)s->step[1];
  float(*restrict column)[2] = (float(*)[2])at.x;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky,
                t = k2 > 0 ? (along + across * ky) / sqrtf(k2) : 0, scale = 1 / (1 + t * t);
    const float re = column[m][0], im = column[m][1];

    column[m][0] = scale * (re + t * im);
    column[m][1] = scale * (im - t * re);
  }
}

/*
  The waves of a single row run along x. Since the symbols do not depend on directions, the row is processed as a column
  along y, with x and y exchanged.
*/
static void FilterRow(const SamFourierBlock *block, const SamSymbol *s)
{
  const size_t bytes  = (size_t)block->first * 2 * (block->data[0] ? sizeof(double) : sizeof(float));
  SamSymbol    turned = *s;
  SamWaves     waves  = {.cross = 0, .first = block->first, .last = block->first + block->columns};
  char        *field[2];

  for (PetscInt c = 0; c < 2; c++)
    field[c] = block->data[c]     ? (char *)block->data[c] - bytes
               : block->single[c] ? (char *)block->single[c] - bytes
                                  : NULL;
  turned.step[1] = s->step[0];
  waves.x        = field[1] ? field[1] : field[0];
  waves.y        = field[0];
  s->multiply(&turned, waves);
  if (!Turns(s)) return;
  turned.turn[1] = s->turn[0];
  waves.cross    = 1; /* as the imaginary part of its own mirror image counts for nothing */
  Turn(&turned, waves);
}

/* Filters a column in three parts: wave numbers from 0 up, that of two cells' length if it exists, and the negative
   ones. */
static void Filter(const SamFourierBlock *block, const void *context)
{
  const SamSymbol *s       = (const SamSymbol *)context;
  const PetscInt   ends[4] = {0, (block->hy + 1) / 2, block->hy / 2 + 1, block->hy};

  if (block->stride == 1 && s->lag == 0) {
    FilterRow(block, s);
    return;
  }
  for (PetscInt b = 0; b < block->columns; b++)
    for (PetscInt k = 0; k < 3; k++) {
      const ptrdiff_t offset = (ptrdiff_t)b * block->stride;
      SamWaves        waves  = {.kx     = s->step[0] * (double)(block->first + b),
                                .cross  = k == 1 || 2 * (block->first + b) == block->hx ? 0 : 1,
                                .first  = ends[k],
                                .last   = ends[k + 1],
                                .origin = k == 2 ? block->hy : 0};

      if (block->data[0]) waves.x = block->data[0] + offset;
      if (block->data[1]) waves.y = block->data[1] + offset;
      if (block->single[0]) waves.x = block->single[0] + offset;
      if (block->single[1]) waves.y = block->single[1] + offset;
      s->multiply(s, waves);
      if (Turns(s)) Turn(s, waves);
    }
}

PetscErrorCode SamSymbolApply(SamElasticity e, const SamSymbol *s, PetscInt n, const double *const in[],
                              double *const out[])
{
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, n, n, Filter, s};

  return SamFourierApply(e->fourier, &filter, in, out);
}

PetscErrorCode SamSymbolApplySingle(SamElasticity e, const SamSymbol *s, PetscInt n, const float *const in[],
                                    float *const out[])
{
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, n, n, Filter, s};

  return SamFourierApplySingle(e->fourier, &filter, in, out);
}

SAM_VECTORIZED void SamSymbolDivideNormal(const SamSymbol *s, SamWaves at)
{
  const float gain = (float)s->gain, mean = (float)s->mean, step = (float)s->step[1], kx = (float)at.kx;
  float(*restrict column)[2] = (float(*)[2])at.x;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k = sqrtf(kx * kx + ky * ky), g = gain * (k > mean ? k : mean);

    column[m][0] *= g;
    column[m][1] *= g;
  }
}

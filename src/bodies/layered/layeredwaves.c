/*
  Layered bodies on waves: products with their symbols c/|k| and the inverses |k|/c.

  On a part of the surface the inverse is a preconditioner. It treats the surface around a contact as clamped. A hard
  film on a soft bed resists like a clamped plate then, far more than with its free surface: at the edge of the contact
  the inverse is up to E1/E2 times too large. If c is more than that of the surface's material, c_top, the normal
  inverse therefore uses c_top (c/c_top)^(1/2). With it, 900 cases at 64 to 512 cells, with E1/E2 = 30 to 300 and films
  of 0.003 to 0.1 of the contact's radius, all converge, in 30 iterations on average; with the power 5/8 one of 300 does
  not, with 3/4 more.
*/
#include "layeredwaves.h"
#include <math.h>

#define CHUNK 256
#define LEAST 1e-12 /* least c/c_top in inverses; less is rounding, on a rigid base */

/* |k|^2 of at most CHUNK waves, never 0, and their gains along and across the wave */
typedef struct {
  double k2[CHUNK], along[CHUNK], across[CHUNK];
} Waves;

/* Computes |k|^2 and gain c/|k|, or its inverse, of up to CHUNK waves from entry `first` on; returns their number. */
static PetscInt Gains(const SamSymbol *s, const SamWaves *at, PetscInt first, SamWaveSymbol symbol, double k2[],
                      double gain[])
{
  const PetscInt n     = PetscMin(CHUNK, at->last - first);
  const double   least = s->mean * s->mean, film = symbol == SAM_WAVE_ZZ ? 0 : s->film;
  double         argument[CHUNK] = {0};

  for (PetscInt m = 0; m < n; m++) {
    const double ky = s->step[1] * (double)(first + m - at->origin);

    k2[m]       = PetscMax(at->kx * at->kx + ky * ky, least);
    argument[m] = k2[m] * s->unit;
  }
  SamSplineRow(s->table, symbol, n, argument, gain);
  for (PetscInt m = 0; m < n; m++) {
    const double k = sqrt(k2[m]), ratio = gain[m] / s->top,
                 eased = symbol == SAM_WAVE_ZZ && ratio > 1 ? sqrt(ratio) : PetscMax(ratio, LEAST);

    gain[m] = s->inverse ? s->gain * k / (s->top * eased + film * k) : s->gain * gain[m] / k;
  }
  if (!s->inverse && at->kx == 0 && first == at->origin) gain[0] = 0;
  return n;
}

#define Real    double
#define Name(x) x
#include "products.h"
#undef Real
#undef Name
#define Real    float
#define Name(x) x##Single
#include "products.h"

PetscErrorCode SamLayeredSymbolSet(SamLayered layered, PetscReal length, PetscInt hx, PetscInt hy, SamSymbol *s)
{
  const double k[2] = {0.5 * PetscMin(s->step[0], s->step[1]) / length,
                       0.5 * hypot((double)hx * s->step[0], (double)hy * s->step[1]) / length};

  PetscFunctionBegin;
  PetscCall(SamLayeredPrepare(layered, 0, k));
  s->table = &layered->symbols;
  s->unit  = 1 / (length * length);
  s->top   = 2 * PETSC_PI * layered->pair->normal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

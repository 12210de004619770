/* Operators that multiply each wave exp(i k.x) of a field by a symbol, a function of k. */
#ifndef PETSAM_WAVES_H
#define PETSAM_WAVES_H

#include <petsam/private/elasticityimpl.h>

/* Part of a column of spectra: entries first ... last - 1 have the wave number ky = step (m - origin). */
typedef struct {
  double   kx, cross; /* cross: factor on cross terms, 0 for a wave that is its own mirror image, else 1 */
  PetscInt first, last, origin;
  void    *x, *y; /* columns of one or two fields: double or float (*)[2] */
} SamWaves;

/* Wave numbers are in units of 1/(length of the grid), so that floats can represent their squares. */
typedef struct SamSymbol {
  double step[2]; /* wave numbers of the longest waves, 2 pi/period */
  double gain;    /* constants of the symbol, times a factor and the transforms' normalisation */
  double nu;      /* of the tangential symbols: nu, or nu/(1 - nu) */
  double mean;    /* replaces |k| at k = 0 in the inverses */
  double lag;     /* for slip under an upwind operator: the length of a cell along x, */
  double slip;    /* and the inverse symbol over |k| */
  double turn[2]; /* the wave is divided by 1 + i turn.k/|k| besides, in single precision; 0: it is not */
  double film;    /* added to the tangential symbol without a film before it is inverted */
  /* for layered bodies (layered/layeredwaves.h): */
  const struct SamSpline *table;   /* symbols times |k|, by k^2 in 1/m^2 */
  double                  unit;    /* 1/m^2 in units of k^2 */
  double                  top;     /* the normal symbol of the materials at the surfaces */
  PetscBool               inverse; /* true: the inverses of the symbols */
  void (*multiply)(const struct SamSymbol *symbol, SamWaves waves); /* in place */
} SamSymbol;

/* Applies one symbol to n fields; its `multiply` must be of their precision. Collective. */
PETSC_INTERN PetscErrorCode SamSymbolApply(SamElasticity elasticity, const SamSymbol *symbol, PetscInt n,
                                           const double *const in[], double *const out[]);
PETSC_INTERN PetscErrorCode SamSymbolApplySingle(SamElasticity elasticity, const SamSymbol *symbol, PetscInt n,
                                                 const float *const in[], float *const out[]);
/* Multiplies by gain |k|, and by `mean` instead of |k| for the mean; in single precision. */
PETSC_INTERN void SamSymbolDivideNormal(const SamSymbol *symbol, SamWaves waves);

#endif

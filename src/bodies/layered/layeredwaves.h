/* Symbols of layered bodies, which multiply the waves of a field. */
#ifndef PETSAM_LAYEREDWAVES_H
#define PETSAM_LAYEREDWAVES_H

#include "../elasticity/waves.h"
#include "layered.h"

/*
  SamLayeredSymbolSet - gives a symbol whose `step` is set the tables of layered bodies, and extends these to all waves
  of hx * hy. Not collective, the same on all ranks.
*/
PETSC_INTERN PetscErrorCode SamLayeredSymbolSet(SamLayered layered, PetscReal length, PetscInt hx, PetscInt hy,
                                                SamSymbol *symbol);
/*
  For layered bodies, in two precisions, these multiply by gain c/|k| or gain |k|/c, where c are the symbols in the
  table. The mean is multiplied by 0, in inverses by `mean`. Tangential components are along and across each wave.
*/
PETSC_INTERN void SamLayeredMultiplyNormal(const SamSymbol *symbol, SamWaves waves);
PETSC_INTERN void SamLayeredMultiplyTangential(const SamSymbol *symbol, SamWaves waves);
PETSC_INTERN void SamLayeredMultiplyNormalSingle(const SamSymbol *symbol, SamWaves waves);
PETSC_INTERN void SamLayeredMultiplyTangentialSingle(const SamSymbol *symbol, SamWaves waves);

#endif

/* Acceleration of iterations on fields. */
#ifndef PETSAM_MIXING_H
#define PETSAM_MIXING_H

#include <petsam/private/grid.h>

/*
  SamMixing - the last iterates of an iteration x <- g(x) on a field, from which the next argument is computed
  (Anderson's method, mixing.c). The grid is borrowed.

  SamMixingNext    - replaces `argument` x by the next one; `result`: g(x). Differences of both count in cells where
                     `weight` (one component) is positive. The same to the last bit on any number of ranks. Collective.
  SamMixingRestart - discards all iterates. Not collective.
*/
typedef struct _n_SamMixing *SamMixing;
PETSC_INTERN PetscErrorCode  SamMixingCreate(SamGrid grid, PetscInt components, SamMixing *mixing);
PETSC_INTERN PetscErrorCode  SamMixingDestroy(SamMixing *mixing);
PETSC_INTERN PetscErrorCode  SamMixingNext(SamMixing mixing, Vec weight, Vec result, Vec argument);
PETSC_INTERN void            SamMixingRestart(SamMixing mixing);

#endif

/* The same step one cycle before, as the start of a step (stepcache.c). */
#ifndef PETSAM_STEPCACHE_H
#define PETSAM_STEPCACHE_H

#include <petsam/private/solutionimpl.h>
#include <petsam/private/solverimpl.h>

/*
  SamStepCache - the last steps of a contact, by what they prescribe.
  SamCachedStep - what is kept of a step; borrowed.
*/
typedef struct _n_SamStepCache  *SamStepCache;
typedef struct _n_SamCachedStep *SamCachedStep;

/*
  SamStepCacheCreate, SamStepCacheDestroy - nothing is kept until there is memory for it. The grid and the conditions
  are borrowed.
*/
PETSC_INTERN PetscErrorCode SamStepCacheCreate(SamGrid grid, SamConditions conditions, SamStepCache *cache);
PETSC_INTERN void           SamStepCacheDestroy(SamStepCache *cache);
/* SamStepCacheSetMemory - the bytes on all ranks that kept steps may take; 0: none are kept. Not collective. */
PETSC_INTERN PetscErrorCode SamStepCacheSetMemory(SamStepCache cache, PetscReal bytes);
/* SamStepCacheForget - forgets all steps. Not collective. */
PETSC_INTERN void SamStepCacheForget(SamStepCache cache);
/*
  SamStepCacheFind - the last step that prescribed the same as the next one, or its reverse, after the same or its
  reverse; NULL: none, or nothing is kept of it. Not collective.
  SamStepCacheKeep - takes note of a step that is committed, and keeps it if the last search found its like.
  `before`: the committed solution so far, NULL in the first step; `revision`: of the problem. Collective.
*/
PETSC_INTERN void           SamStepCacheFind(SamStepCache cache, const SamControl *next, SamCachedStep *kept);
PETSC_INTERN PetscErrorCode SamStepCacheKeep(SamStepCache cache, const SamSolution *before, const SamSolution *now,
                                             PetscObjectState revision);
/*
  SamCachedStepHasPressure - whether it has the pressure for this control and a gap of this revision. Not collective.
  SamCachedStepGetPressure - that pressure (Pa), with its normal loads and rigid displacements. Not collective.
  SamCachedStepGetShear - a start of the shear (Pa), zero outside of the bound, and its product with the operator (m),
  for a step after the solution `now`. `found`: the contact is where it was. Collective.
*/
PETSC_INTERN PetscBool      SamCachedStepHasPressure(SamCachedStep kept, const SamControl *control,
                                                     PetscObjectState revision);
PETSC_INTERN PetscErrorCode SamCachedStepGetPressure(SamCachedStep kept, SamGrid grid, SamSolution *solution);
PETSC_INTERN PetscErrorCode SamCachedStepGetShear(SamCachedStep kept, SamElasticity elasticity, const SamSolution *now,
                                                  Vec bound, Vec shear, SamProduct *product, PetscBool *found);

#endif

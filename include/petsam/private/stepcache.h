/* The same step one cycle before, as the start of a step (stepcache.c). */
#ifndef PETSAM_PRIVATE_STEPCACHE_H
#define PETSAM_PRIVATE_STEPCACHE_H

#include <petsam/contact.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/solverimpl.h>
#include <stdint.h>

/*
  SamStepCache - the last steps of a contact, by what they prescribe.
  SamCachedStep - what is kept of a step; borrowed from the cache until its next search.
  SamStepFields - the fields of a kept step on this rank, in the columns range[2 j] to range[2 j + 1] of row j.
*/
typedef struct _n_SamStepCache  *SamStepCache;
typedef struct _n_SamCachedStep *SamCachedStep;
typedef struct {
  PetscInt references, cells;
  int32_t *range;
  int32_t *change;   /* SAM_STEP_CHANGES fields, one after the other */
  double  *pressure; /* Pa; NULL: that of the step before */
} * SamStepFields;
#define SAM_STEP_CHANGES 4

/*
  SamStepCacheCreate, SamStepCacheDestroy - with the usual memory. The grid and the conditions are borrowed.
  SamStepCacheCreateLike - for the same contact, with as much memory, and nothing kept yet.
  SamStepCacheUsual - that memory, bytes: 20 fields of the grid, at least 16 MB, at most 1 GB. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStepCacheCreate(SamGrid grid, SamConditions conditions, SamStepCache *cache);
PETSC_INTERN PetscErrorCode SamStepCacheCreateLike(SamStepCache cache, SamStepCache *other);
PETSC_INTERN void           SamStepCacheDestroy(SamStepCache *cache);
PETSC_INTERN PetscReal      SamStepCacheUsual(SamGrid grid);
/* SamStepCacheSetMemory - the bytes on all ranks that kept steps may take; 0: none are kept. Not collective. */
PETSC_INTERN void SamStepCacheSetMemory(SamStepCache cache, PetscReal bytes);
/*
  SamStepCacheForget - forgets all steps.
  SamStepCacheCopy - `to` keeps the steps of `from`, of another contact on the same grid, if it has the memory; they
  share the fields. Not collective.
*/
PETSC_INTERN void           SamStepCacheForget(SamStepCache cache);
PETSC_INTERN PetscErrorCode SamStepCacheCopy(SamStepCache from, SamStepCache to);

/* SamContactGetCache - a contact's; borrowed. Not collective. */
PETSC_INTERN SamStepCache SamContactGetCache(SamContact contact);

/* SamStepOf - what a step's pressure was or is to be solved with. */
typedef struct {
  PetscBool same_gap; /* as the step before */
  PetscBool moves;    /* the gap changes with the step, so that its pressure is not right after it */
  PetscBool yields;   /* the gap changes with the step to one for which its pressure is right, too */
  PetscReal rtol;     /* tolerance of the normal solver */
} SamStepOf;
/*
  SamStepCacheFind - the last step that prescribed the same as the next one, or its reverse, after the same or its
  reverse; NULL: none, or nothing is kept of it. Not collective.
  SamStepCacheKeep - takes note of a step that is committed, and keeps it if the last search found its like.
  `before`: the committed solution so far, NULL in the first step. Collective.
*/
PETSC_INTERN void           SamStepCacheFind(SamStepCache cache, const SamControl *next, SamCachedStep *kept);
PETSC_INTERN PetscErrorCode SamStepCacheKeep(SamStepCache cache, const SamSolution *before, const SamSolution *now,
                                             const SamStepOf *of);
/*
  SamCachedStepGetControl - how its components were given, and their values. Not collective.
  SamCachedStepHasPressure - whether it has the pressure of a step with its normal control. Not collective.
  SamCachedStepGetPressure - that pressure (Pa), with its normal loads and rigid displacements. Not collective.
  SamCachedStepGetShear - a start of the shear (Pa), zero outside of the bound, and its product with the operator (m),
  for a step after the solution `now`. `found`: the contact is where it was. Collective.
*/
PETSC_INTERN void           SamCachedStepGetControl(SamCachedStep kept, SamControl *control);
PETSC_INTERN PetscBool      SamCachedStepHasPressure(SamCachedStep kept, const SamStepOf *of);
PETSC_INTERN PetscErrorCode SamCachedStepGetPressure(SamCachedStep kept, SamGrid grid, SamSolution *solution);
PETSC_INTERN PetscErrorCode SamCachedStepGetShear(SamCachedStep kept, SamElasticity elasticity, const SamSolution *now,
                                                  Vec bound, Vec shear, SamProduct *product, PetscBool *found);

/*
  For those who save and restore it: a table that is the same on all ranks, and the fields of some of its rows. Not
  collective.
  SamStepCacheGetTable - the table, borrowed; no rows: no steps.
  SamStepCacheSetTable - forgets all steps, and takes over a table, if its width fits and there is memory for its
  fields; they are to be added.
  SamStepCacheCells - the cells on all ranks of the fields of a row, 0: it has none; whether a pressure is among them.
  SamStepCacheGetFields - the fields of a row, borrowed; NULL: none.
  SamStepCacheAddFields - adds them, with place for their values.
*/
PETSC_INTERN void           SamStepCacheGetTable(SamStepCache cache, PetscInt *rows, PetscInt *width, double **table);
PETSC_INTERN PetscErrorCode SamStepCacheSetTable(SamStepCache cache, PetscInt rows, PetscInt width,
                                                 const double table[]);
PETSC_INTERN PetscInt       SamStepCacheCells(SamStepCache cache, PetscInt row, PetscBool *pressure);
PETSC_INTERN SamStepFields  SamStepCacheGetFields(SamStepCache cache, PetscInt row);
PETSC_INTERN PetscErrorCode SamStepCacheAddFields(SamStepCache cache, PetscInt row, const int32_t range[],
                                                  SamStepFields *fields);

#endif

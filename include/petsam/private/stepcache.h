/* A cache of earlier steps: the same step of the previous cycle is the start of a step (stepcache.c). */
#ifndef PETSAM_PRIVATE_STEPCACHE_H
#define PETSAM_PRIVATE_STEPCACHE_H

#include <petsam/contact.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/solverimpl.h>
#include <stdint.h>

/*
  SamStepCache - the last steps of a contact, found by their controls.
  SamCachedStep - the stored data of a step; borrowed from the cache until its next search.
  SamStepFields - the fields of a stored step on this rank, in the columns range[2 j] to range[2 j + 1] of row j.
*/
typedef struct _n_SamStepCache  *SamStepCache;
typedef struct _n_SamCachedStep *SamCachedStep;
typedef struct {
  PetscInt references, cells, changes;
  int32_t *range;
  int32_t *change;   /* this number of fields, one after the other */
  double  *pressure; /* Pa; NULL: that of the previous step */
} * SamStepFields;

/*
  SamStepCacheCreate, SamStepCacheDestroy - create a cache with the default memory, and free it. The grid and the
  conditions are borrowed.
  SamStepCacheCreateLike - creates an empty cache for the same contact, with as much memory.
  SamStepCacheUsual - returns the default memory, bytes: 20 fields of the grid, at least 48 MB, at most 1 GB. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamStepCacheCreate(SamGrid grid, SamConditions conditions, SamStepCache *cache);
PETSC_INTERN PetscErrorCode SamStepCacheCreateLike(SamStepCache cache, SamStepCache *other);
PETSC_INTERN void           SamStepCacheDestroy(SamStepCache *cache);
PETSC_INTERN PetscReal      SamStepCacheUsual(SamGrid grid);
/*
  SamStepCacheSetMemory - sets the memory on all ranks for stored steps, bytes; 0: none are stored. Not collective.
  SamStepCacheKeeps - returns true if there is any. Not collective.
*/
PETSC_INTERN void      SamStepCacheSetMemory(SamStepCache cache, PetscReal bytes);
PETSC_INTERN PetscBool SamStepCacheKeeps(SamStepCache cache);
/*
  SamStepCacheForget - forgets all steps.
  SamStepCacheCopy - stores in `to` the steps of `from`, the cache of another contact on the same grid, if it has the
  memory; they share the fields. Not collective.
*/
PETSC_INTERN void           SamStepCacheForget(SamStepCache cache);
PETSC_INTERN PetscErrorCode SamStepCacheCopy(SamStepCache from, SamStepCache to);

/* SamContactGetCache - returns the cache of a contact; borrowed. Not collective. */
PETSC_INTERN SamStepCache SamContactGetCache(SamContact contact);

/* SamStepOf - the circumstances of the solution of a step's pressure, by which stored pressures are compared. */
typedef struct {
  PetscBool same_gap; /* true: the gap is that of the previous step */
  PetscBool moves;    /* true: the step changes the gap, so that its pressure is invalid afterwards */
  PetscBool yields;   /* true: the step changes the gap to one for which its pressure is also valid */
  PetscBool coupled;  /* true: the pressure depends on the shear, and a stored one is a guess */
  PetscReal rtol;     /* tolerance of the normal solver */
} SamStepOf;
/*
  SamStepCacheFind - finds the last step with the same control as the next one, or if the problem is `odd` its reverse,
  that followed a step with the same control as the last one, or its reverse; NULL: there is none, or it is not stored.
  Not collective.
  SamStepCacheKeep - notes the control of a step that is committed, and stores its fields if the last search found an
  equal step. `before`: the committed solution so far, NULL in the first step. `turn`: the part of the step's slip that
  the shear at its end does not oppose (m), NULL: none. Collective.
*/
PETSC_INTERN void SamStepCacheFind(SamStepCache cache, const SamControl *next, PetscBool odd, SamCachedStep *kept);
PETSC_INTERN PetscErrorCode SamStepCacheKeep(SamStepCache cache, const SamSolution *before, const SamSolution *now,
                                             Vec turn, const SamStepOf *of);
/*
  SamCachedStepGetControl - gets the values of the components of a stored step, and how they were given. Not collective.
  SamCachedStepHasPressure - returns true if its pressure is that of a new step with the same normal control. Not
  collective.
  SamCachedStepGetPressure - gets this pressure (Pa), with its normal loads and rigid displacements; `found`: true if it
  is stored. Not collective.
  SamCachedStepGetShear - computes an initial guess of the shear (Pa), zero outside of the bound, and its product with
  the operator (m), for a step after the solution `now`. `found`: true if the contact is at the same place as in the
  stored step. Collective.
  SamCachedStepIsRepeated - returns true if it is stored of two cycles; false for NULL. Not collective.
  SamCachedStepHasTurn - returns true if the part of its slip that the shear at the end does not oppose is stored too;
  false for NULL. Not collective.
  SamCachedStepAddTurn - adds this part (m) to a field. Not collective.
*/
PETSC_INTERN void           SamCachedStepGetControl(SamCachedStep kept, SamControl *control);
PETSC_INTERN PetscBool      SamCachedStepHasPressure(SamCachedStep kept, const SamStepOf *of);
PETSC_INTERN PetscErrorCode SamCachedStepGetPressure(SamCachedStep kept, SamGrid grid, SamSolution *solution,
                                                     PetscBool *found);
PETSC_INTERN PetscErrorCode SamCachedStepGetShear(SamCachedStep kept, SamElasticity elasticity, const SamSolution *now,
                                                  Vec bound, Vec shear, SamProduct *product, PetscBool *found);
PETSC_INTERN PetscBool      SamCachedStepIsRepeated(SamCachedStep kept);
PETSC_INTERN PetscBool      SamCachedStepHasTurn(SamCachedStep kept);
PETSC_INTERN PetscErrorCode SamCachedStepAddTurn(SamCachedStep kept, SamGrid grid, Vec field);

/*
  The following functions are for code that saves and restores the cache: a table that is the same on all ranks, and the
  fields of some of its rows. Not collective.
  SamStepCacheGetTable - gets the table, borrowed; it has no rows if there are no steps.
  SamStepCacheSetTable - forgets all steps, and copies a table, if its width fits and there is memory for its fields,
  which must then be added.
  SamStepCacheCells - returns the number of cells on all ranks in the fields of a row, 0 if it has none; `changes`: the
  number of these fields; `pressure`: true if a pressure is stored, too.
  SamStepCacheGetFields - returns the fields of a row, borrowed; NULL if it has none.
  SamStepCacheAddFields - adds fields to a row, with memory for their values.
*/
PETSC_INTERN void           SamStepCacheGetTable(SamStepCache cache, PetscInt *rows, PetscInt *width, double **table);
PETSC_INTERN PetscErrorCode SamStepCacheSetTable(SamStepCache cache, PetscInt rows, PetscInt width,
                                                 const double table[]);
PETSC_INTERN PetscInt       SamStepCacheCells(SamStepCache cache, PetscInt row, PetscInt *changes, PetscBool *pressure);
PETSC_INTERN SamStepFields  SamStepCacheGetFields(SamStepCache cache, PetscInt row);
PETSC_INTERN PetscErrorCode SamStepCacheAddFields(SamStepCache cache, PetscInt row, const int32_t range[],
                                                  SamStepFields *fields);

#endif

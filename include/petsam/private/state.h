/* Functions of the state, besides petsam/state.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_STATE_H
#define PETSAM_PRIVATE_STATE_H

#include <petsam/state.h>

/*
  SamStateMissingNumber - returns the value of the k-th declaration of numbers in steps whose results lack it; 0 or NaN
  for numbers that were results from the start. Not collective.
*/
PETSC_INTERN double SamStateMissingNumber(SamState state, PetscInt k);
/* SamStateCreate - creates an empty state for fields of this grid, which it references. Collective. */
PETSC_INTERN PetscErrorCode SamStateCreate(SamGrid grid, SamState *state);
/* SamStateCreateLike - creates another state with the same declarations and no values. Collective. */
PETSC_INTERN PetscErrorCode SamStateCreateLike(SamState state, SamState *other);
PETSC_INTERN PetscErrorCode SamStateDestroy(SamState *state);
/* SamStateComm - returns the communicator of the grid. Not collective. */
PETSC_INTERN MPI_Comm SamStateComm(SamState state);
/*
  SamStateBegin - begins a try: it creates a tried generation without fields, in which real numbers that are results are
  NaN, integers 0, and numbers that are no results as in the committed generation. During the try, numbers that are not
  kept have no value in the committed generation, as after a restart. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateBegin(SamState state);
/*
  SamStateCommit - makes the tried generation the committed one. Collective. Errors: PETSC_ERR_ORDER without a tried
  one.
*/
PETSC_INTERN PetscErrorCode SamStateCommit(SamState state);
/* SamStateReject - discards the tried generation, if there is one. Not collective. */
PETSC_INTERN PetscErrorCode SamStateReject(SamState state);
/*
  SamStateForgetFields - discards the fields of the tried generation, but not its numbers, after a step without a
  solution. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateForgetFields(SamState state);
/*
  SamStateSeparates - returns true if the try has set a field on which the separation or the offset of later steps
  depends. Not collective.
*/
PETSC_INTERN PetscBool SamStateSeparates(SamState state);
/* SamStateHasTried - returns true if there is a tried generation. Not collective. */
PETSC_INTERN PetscBool SamStateHasTried(SamState state);
/* SamStateReset - discards all values, as after its creation. Collective. */
PETSC_INTERN PetscErrorCode SamStateReset(SamState state);
/*
  SamStateMove - replaces the fields of the committed generation, during a try, by those after a move of the grid by
  `distance` (m); `wraps`: the grid is one period, and what leaves it enters at the other side. A rejection of the try
  restores them, a commit keeps the moved ones. Collective.
*/
PETSC_INTERN PetscErrorCode SamStateMove(SamState state, const PetscReal distance[2], PetscBool wraps);
/*
  SamStateSwapTried - exchanges what a try has changed in the committed generation, for code that saves the state: the
  first call restores the fields before SamStateMove() and all numbers, the next one takes this back. Not collective.
*/
PETSC_INTERN void SamStateSwapTried(SamState state);
/* SamStateNumbers - returns the address of numbers in a generation. Not collective. */
PETSC_EXTERN double *SamStateNumbers(SamState state, PetscInt id, SamGeneration generation);
/*
  SamStateRestoreField - gets the vector of a field in the committed generation, or in the one a step before it, for
  writing by code that restores a saved state. Collective.
*/
PETSC_INTERN PetscErrorCode SamStateRestoreField(SamState state, PetscInt id, SamGeneration generation, Vec *field);
/*
  SamStateCopy - copies the committed values, and those a step before, from another state on the same grid, and discards
  a tried generation. Fields that `from` does not have become zero, and numbers that it does not have get the values of
  a new state.
  Collective. Errors: PETSC_ERR_ARG_SIZ for another grid; PETSC_ERR_ARG_INCOMP for a field for which only `from` has
  values; the message names it.
*/
PETSC_INTERN PetscErrorCode        SamStateCopy(SamState from, SamState to);
PETSC_INTERN PetscInt              SamStateCountValues(SamState state); /* values of all numbers */
PETSC_INTERN PetscInt              SamStateCountResults(SamState state);
PETSC_INTERN const SamStateResult *SamStateResultOf(SamState state, PetscInt k);
PETSC_INTERN PetscInt              SamStateFindResult(SamState state, const char name[]); /* its place, -1: none */
/*
  SamStateFindValues - gets the vector that contains a field of the results, and its component there: a vector of the
  state (borrowed), or `work` (one component), into which the field is computed, or which is zero if the field has no
  values yet. Collective.
*/
PETSC_INTERN PetscErrorCode SamStateFindValues(SamState state, PetscInt result, Vec work, Vec *holder,
                                               PetscInt *component);

/*
  SamStateDeclareOptional - declares numbers that another state or a checkpoint may lack; they then have the value
  `usual`, with which they also start.
  SamStateIsOptional - returns true if the k-th declaration is optional. SamStateIsUsual - returns true if, in addition,
  all their stored values are the usual one. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateDeclareOptional(SamState state, const SamStateNumber *number, double usual,
                                                    PetscInt *id);
PETSC_INTERN PetscBool      SamStateIsOptional(SamState state, PetscInt k);
PETSC_INTERN PetscBool      SamStateIsUsual(SamState state, PetscInt k);

/*
  SamStateOfferNumber - makes a declared number a column of /history, unless it is one already; `before` is its value in
  steps of an earlier run whose results lack it. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateOfferNumber(SamState state, const char name[], double before);

/*
  SamStateOffer - declares a computed field of the results. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamStateOffer(SamState state, const SamStateResult *result);

/*
  SamStateLayers - the layers below the cells in which the results of one group are; these have the kind
  SAM_FIELD_LAYERS. If the group has `stresses`, its results residual_stress_xx, ..._yy, _zz, _xy, _xz and _yz (Pa,
  means over the layers, in the axes of the grid, whose z points into body 2) are added to the stresses by tractions.
*/
typedef struct {
  const char *group;    /* name of the group; not copied */
  PetscInt    count[2]; /* number of layers in body 1 and in body 2 */
  PetscReal  *z;        /* z of the middles, m: below the surface of body 2, negative in body 1, rising; copied */
  PetscBool   stresses; /* true: it has stresses */
  PetscBool   initial;  /* true: these contain the stress before any load */
} SamStateLayers;
#define SAM_LAYER_GROUPS 4                         /* most groups */
#define SAM_LAYER_NAME   32                        /* most characters of a name, with the final 0 */
PETSC_INTERN const char *const SamLayerStresses[]; /* names of the stresses in a group, by SamStressComponent */
/*
  SamStateSetLayers - declares the layers of a group, or replaces an earlier declaration. Errors:
  PETSC_ERR_ARG_OUTOFRANGE for more than SAM_LAYER_GROUPS groups, or a name that is too long.
  SamStateGetLayers - returns the k-th group, borrowed; NULL: there are no more.
  SamStateLayersOf - returns the group of a result by its name, borrowed. None is collective.
*/
PETSC_EXTERN PetscErrorCode        SamStateSetLayers(SamState state, const SamStateLayers *layers);
PETSC_INTERN const SamStateLayers *SamStateGetLayers(SamState state, PetscInt k);
PETSC_INTERN const SamStateLayers *SamStateLayersOf(SamState state, const char result[]);

/*
  SamStateReadNumbers - returns the numbers (units of the declarations) in the tried generation, without a try in the
  committed one.

  Not collective.

  In:     state - the state
          id    - place of the first number

  Errors: none; it returns no error code.
*/
PETSC_EXTERN double *SamStateReadNumbers(SamState state, PetscInt id);

/*
  SamStateJoinNumbers - joins the numbers of the tried generation, by the rules of their declarations, to `parts`, the
  joined numbers of the earlier parts of the step: SAM_STATE_NUMBERS values, at first 0. `to_step`: true writes the
  result into the tried generation, false into `parts`. Not collective.
*/
PETSC_INTERN void SamStateJoinNumbers(SamState state, double parts[], PetscBool to_step);

/*
  The following functions return the declarations, in their order. None is collective. SamStateFieldOf - returns the
  declaration of a field, SamStateNumberOf - that of the k-th numbers and, in `id`, their place.
*/
PETSC_INTERN PetscInt              SamStateCountFields(SamState state);
PETSC_INTERN const SamStateField  *SamStateFieldOf(SamState state, PetscInt id);
PETSC_INTERN PetscInt              SamStateCountNumbers(SamState state);
PETSC_INTERN const SamStateNumber *SamStateNumberOf(SamState state, PetscInt k, PetscInt *id);

/*
  SamStateUnitOf - returns the unit that a number has on the grid of the state; "": there is none of that name.

  Not collective.

  In:     state - the state
          name  - name of the number

  Errors: none; it returns no error code.
*/
PETSC_EXTERN const char *SamStateUnitOf(SamState state, const char name[]);

#endif

/* The state: what the library's other rooms use besides petsam/state.h. */
#ifndef PETSAM_PRIVATE_STATE_H
#define PETSAM_PRIVATE_STATE_H

#include <petsam/state.h>

/*
  SamStateMissingNumber - that value, for the k-th declaration of numbers; 0 or NaN for those that were results from the
  start. Not collective.
*/
PETSC_INTERN double SamStateMissingNumber(SamState state, PetscInt k);
/* SamStateCreate - an empty state for fields of this grid, which it references. Collective. */
PETSC_INTERN PetscErrorCode SamStateCreate(SamGrid grid, SamState *state);
/* SamStateCreateLike - another state with the same declarations and no values. Collective. */
PETSC_INTERN PetscErrorCode SamStateCreateLike(SamState state, SamState *other);
PETSC_INTERN PetscErrorCode SamStateDestroy(SamState *state);
/*
  SamStateBegin - begins a try: there is a tried generation, without fields; its results of real numbers are NaN, its
  integers 0, and numbers that are no results as in the committed one. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateBegin(SamState state);
/* SamStateCommit - the tried generation becomes the committed one. Collective. Errors: PETSC_ERR_ORDER without one. */
PETSC_INTERN PetscErrorCode SamStateCommit(SamState state);
/* SamStateReject - forgets the tried generation, if there is one. Not collective. */
PETSC_INTERN PetscErrorCode SamStateReject(SamState state);
/* SamStateForgetFields - forgets its fields, but not its numbers: of a step without a solution. Not collective. */
PETSC_INTERN PetscErrorCode SamStateForgetFields(SamState state);
/*
  SamStateSeparates - whether the try has set a field from which the separation or the offset of later steps follows.
  Not collective.
*/
PETSC_INTERN PetscBool SamStateSeparates(SamState state);
/* SamStateHasTried - whether there is one. Not collective. */
PETSC_INTERN PetscBool SamStateHasTried(SamState state);
/* SamStateReset - forgets all values: as after its creation. Collective. */
PETSC_INTERN PetscErrorCode SamStateReset(SamState state);
/*
  SamStateMove - of a try: the committed generation becomes what it is after the grid has moved by `distance` (m), until
  the try is rejected; a commit keeps it. Collective.
*/
PETSC_INTERN PetscErrorCode SamStateMove(SamState state, const PetscReal distance[2]);
/*
  SamStateSwapMoved - the committed generation becomes what it was before that, and at the next call what it is after
  it: for those who save it. Not collective.
*/
PETSC_INTERN void SamStateSwapMoved(SamState state);
/* SamStateNumbers - the place of numbers in a generation. Not collective. */
PETSC_INTERN double *SamStateNumbers(SamState state, PetscInt id, SamGeneration generation);
/*
  SamStateRestoreField - the vector of a committed generation, or of that one step back, to be written to by who
  restores a saved state. Collective.
*/
PETSC_INTERN PetscErrorCode SamStateRestoreField(SamState state, PetscInt id, SamGeneration generation, Vec *field);
/*
  SamStateCopy - the committed values, and those one step back, of another state on the same grid. Forgets a tried
  generation. Fields that `from` does not have become zero, its numbers as in a new state. Collective. Errors:
  PETSC_ERR_ARG_SIZ for another grid; PETSC_ERR_ARG_INCOMP for a field that only `from` has values of, which the message
  names.
*/
PETSC_INTERN PetscErrorCode        SamStateCopy(SamState from, SamState to);
PETSC_INTERN PetscInt              SamStateCountValues(SamState state); /* of all numbers */
PETSC_INTERN PetscInt              SamStateCountResults(SamState state);
PETSC_INTERN const SamStateResult *SamStateResultOf(SamState state, PetscInt k);
PETSC_INTERN PetscInt              SamStateFindResult(SamState state, const char name[]);
/*
  SamStateFindValues - a field of the results: the vector that holds it and its component there, one of the state's
  (borrowed), or `work` (one component), into which it is computed or which is zero where it has no values yet.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamStateFindValues(SamState state, PetscInt result, Vec work, Vec *holder,
                                               PetscInt *component);

#endif

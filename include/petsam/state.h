/* What a contact remembers: fields and numbers by name, in generations. */
#ifndef PETSAM_STATE_H
#define PETSAM_STATE_H

#include <petsam/grid.h>

/*
  SamState - fields and numbers that parts of a contact remember from one load step to the next, and what results offer.
  Each is declared once, by the part that owns it; checkpoints, results, copies and lists follow from the declarations.

  A step is tried, and then committed or rejected. So there are generations: the tried one, the committed one, and that
  one step back. SamStateBegin() begins a try; SamStateCommit() makes the tried generation the committed one, by
  exchanging pointers; SamStateReject() forgets it. A field whose tried generation nobody asked for keeps its committed
  values.
*/
typedef struct _n_SamState *SamState;
typedef enum { SAM_TRIED, SAM_COMMITTED, SAM_BEFORE, SAM_GENERATIONS } SamGeneration;

/* Whether results offer a field, and save it by default. */
typedef enum { SAM_RESULT_NONE, SAM_RESULT_OFFERED, SAM_RESULT_USUAL } SamResultUse;

/* What becomes of a field when the grid moves: it belongs to the place, or to the material, what enters being 0 or as
   at the border. */
typedef enum { SAM_STAYS, SAM_MOVES, SAM_MOVES_CONTINUED } SamStateMotion;

/*
  SamStateField - the declaration of a remembered field. A field of two components is offered as name_x and name_y. The
  names and texts of fields are not copied.
*/
typedef struct {
  const char    *name, *unit, *text;
  PetscInt       components;  /* values a cell, 1 or 2 */
  PetscInt       generations; /* 2: tried and committed; 3: one step back too */
  PetscBool      kept;        /* later steps depend on it, so that checkpoints have it */
  PetscBool      optional;    /* a checkpoint may lack it; it is zero then */
  SamResultUse   result;
  SamStateMotion motion;
} SamStateField;
/*
  SamStateDeclareField - declares a field; `id` is its handle. Declaring the same name again returns the same handle.
  Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_STATE_MOST fields.
*/
#define SAM_STATE_MOST 64 /* most fields; most results */
PETSC_EXTERN PetscErrorCode SamStateDeclareField(SamState state, const SamStateField *field, PetscInt *id);

/*
  SamStateNumber - the declaration of numbers. Those that results offer are columns of /history: real numbers, which are
  NaN where a step has none, integers (0), statuses, or a matrix with a row and a column for each component (NaN). The
  first number of a state is the coordinate of the others. Names and texts are copied.
*/
typedef enum { SAM_NUMBER_REAL, SAM_NUMBER_INT, SAM_NUMBER_STATUS, SAM_NUMBER_MATRIX } SamNumberKind;
/* How the numbers of the parts of a step make that of the whole step. */
typedef enum { SAM_JOIN_LAST, SAM_JOIN_SUM, SAM_JOIN_GREATEST } SamNumberJoin;
typedef struct {
  const char   *name, *unit, *text;
  SamNumberKind kind;
  PetscInt      count;  /* 1; of numbers that are no results any; of a matrix all its values */
  PetscBool     kept;   /* checkpoints have it */
  PetscBool     result; /* a column of /history */
  SamNumberJoin join;
  PetscInt      order; /* of its error in the width of the cells, for the check of the grid; 0: it is not estimated */
} SamStateNumber;
/*
  SamStateDeclareNumber - declares numbers; `id` is the place of the first: those declared one after the other lie side
  by side. Declaring the same name again returns the same place. Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for
  more than
  SAM_STATE_DECLARED declarations, or SAM_STATE_NUMBERS values.
*/
#define SAM_STATE_NUMBERS  512
#define SAM_STATE_DECLARED 128 /* most declarations of numbers */
PETSC_EXTERN PetscErrorCode SamStateDeclareNumber(SamState state, const SamStateNumber *number, PetscInt *id);

/*
  SamStateOfferNumber - makes a declared number a column of /history, unless it is one; `before` is its value in steps
  of an earlier run whose results lack it. Not collective.
  SamStateMissingNumber - that value, for the k-th declaration of numbers; 0 or NaN for those that were results from the
  start. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamStateOfferNumber(SamState state, const char name[], double before);
PETSC_INTERN double         SamStateMissingNumber(SamState state, PetscInt k);

/*
  SamStateResult - a field that results offer: a component of a remembered field, or what `compute` writes into a vector
  of one component for the tried state, or without one for the committed state. The values are real numbers, states of
  cells (stored as bytes), or the points of an edge. Remembered fields are offered by their declaration.
*/
typedef enum { SAM_FIELD_REAL, SAM_FIELD_STATE, SAM_FIELD_POINTS } SamFieldKind;
typedef struct {
  const char  *name, *unit, *text;
  SamFieldKind kind;
  SamResultUse use;
  PetscErrorCode (*compute)(void *owner, SamState state, PetscInt component, Vec field); /* NULL: it is remembered */
  void    *owner;
  PetscInt component;
  PetscInt field; /* handle of the remembered field; set by SamStateDeclareField() */
} SamStateResult;
/* SamStateOffer - declares a computed field of the results. Not collective. */
PETSC_EXTERN PetscErrorCode SamStateOffer(SamState state, const SamStateResult *result);

/* SamStateCreate - an empty state for fields of this grid, which it references. Collective. */
PETSC_INTERN PetscErrorCode SamStateCreate(SamGrid grid, SamState *state);
/* SamStateCreateLike - another state with the same declarations and no values. Collective. */
PETSC_INTERN PetscErrorCode SamStateCreateLike(SamState state, SamState *other);
PETSC_INTERN PetscErrorCode SamStateDestroy(SamState *state);

/*
  SamStateBegin - begins a try: there is a tried generation, without fields; its results of real numbers are NaN, its
  integers 0, and numbers that are no results as in the committed one. Not collective.
  SamStateCommit - the tried generation becomes the committed one. Collective. Errors: PETSC_ERR_ORDER without one.
  SamStateReject - forgets the tried generation, if there is one. Not collective.
  SamStateForgetFields - forgets its fields, but not its numbers: of a step without a solution. Not collective.
  SamStateHasTried - whether there is one. Not collective.
  SamStateReset - forgets all values: as after its creation. Collective.
*/
PETSC_INTERN PetscErrorCode SamStateBegin(SamState state);
PETSC_INTERN PetscErrorCode SamStateCommit(SamState state);
PETSC_INTERN PetscErrorCode SamStateReject(SamState state);
PETSC_INTERN PetscErrorCode SamStateForgetFields(SamState state);
PETSC_INTERN PetscBool      SamStateHasTried(SamState state);
PETSC_INTERN PetscErrorCode SamStateReset(SamState state);

/*
  SamStateMove - of a try: the committed generation becomes what it is after the grid has moved by `distance` (m), until
  the try is rejected; a commit keeps it. Collective.
  SamStateSwapMoved - the committed generation becomes what it was before that, and at the next call what it is after
  it: for those who save it. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateMove(SamState state, const PetscReal distance[2]);
PETSC_INTERN void           SamStateSwapMoved(SamState state);

/*
  SamStateSetField - the vector of a field's tried generation, to be written to: zero when it is first made, later with
  old values. Collective.
  SamStateGetField - the vector of a generation; NULL where nobody has set it. Borrowed. Not collective.
  SamStateReadField - the tried vector if it has been set in this try, else the committed one; NULL for neither.
  Borrowed until the next try, commit or rejection. Not collective.
  SamStateNumbers - the place of numbers in a generation. Not collective.
  SamStateReadNumbers - in the tried generation, without one in the committed one. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamStateSetField(SamState state, PetscInt id, Vec *field);
PETSC_EXTERN Vec            SamStateGetField(SamState state, PetscInt id, SamGeneration generation);
PETSC_EXTERN Vec            SamStateReadField(SamState state, PetscInt id);
PETSC_INTERN double        *SamStateNumbers(SamState state, PetscInt id, SamGeneration generation);
PETSC_EXTERN double        *SamStateReadNumbers(SamState state, PetscInt id);
/*
  SamStateJoinNumbers - joins the numbers of the tried generation to `parts`, those of the parts of the step before it:
  SAM_STATE_NUMBERS values, at first 0. `to_step`: into the tried generation, else into `parts`. Not collective.
*/
PETSC_EXTERN void SamStateJoinNumbers(SamState state, double parts[], PetscBool to_step);
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
PETSC_INTERN PetscErrorCode SamStateCopy(SamState from, SamState to);

/*
  The declarations, in their order. None is collective.
  SamStateFind... - the handle of a name, -1: there is none. For results the place in their list.
*/
PETSC_EXTERN PetscInt              SamStateCountFields(SamState state);
PETSC_EXTERN const SamStateField  *SamStateFieldOf(SamState state, PetscInt id);
PETSC_EXTERN PetscInt              SamStateFindField(SamState state, const char name[]);
PETSC_EXTERN PetscInt              SamStateCountNumbers(SamState state);
PETSC_EXTERN const SamStateNumber *SamStateNumberOf(SamState state, PetscInt k, PetscInt *id);
PETSC_INTERN PetscInt              SamStateCountValues(SamState state); /* of all numbers */
PETSC_EXTERN PetscInt              SamStateFindNumber(SamState state, const char name[]);
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

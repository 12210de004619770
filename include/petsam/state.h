/* The state of a contact: fields and numbers by name, in generations. */
#ifndef PETSAM_STATE_H
#define PETSAM_STATE_H

#include <petsam/grid.h>

/*
  SamState - fields and numbers that parts of a contact keep from one load step to the next, and those that results
  offer. Each is declared once, by the part that owns it; checkpoints, results, copies and lists follow from the
  declarations.

  A step is tried, and then committed or rejected. So there are generations: the tried one, the committed one, and the
  one a step before that. SamStateBegin() begins a try; SamStateCommit() makes the tried generation the committed one,
  by exchanging pointers; SamStateReject() discards it. A field whose tried generation was not set keeps its committed
  values.
*/
typedef struct _n_SamState *SamState;
typedef enum { SAM_TRIED, SAM_COMMITTED, SAM_BEFORE, SAM_GENERATIONS } SamGeneration;

/* SamResultUse - the use of a field in results: none, offered, or saved by default. */
typedef enum { SAM_RESULT_NONE, SAM_RESULT_OFFERED, SAM_RESULT_USUAL } SamResultUse;

/*
  SamStateMotion - the behaviour of a field when the grid moves: the field stays at its place, or it moves with the
  material, and values that enter are 0 or those at the border.
*/
typedef enum { SAM_STAYS, SAM_MOVES, SAM_MOVES_CONTINUED } SamStateMotion;

/*
  SamStateField - the declaration of a stored field. A field of two components is offered as name_x and name_y. A field
  with depth has values in `layers` layers below each cell, one after the other from the first layer down, each with all
  components; the layers are offered as name_1, name_2 and so on. The names and texts of fields are not copied.
*/
typedef struct {
  const char    *name, *unit, *text;
  PetscInt       components;  /* number of values per cell, 1 or 2 */
  PetscInt       generations; /* 2: tried and committed; 3: also one step before */
  PetscBool      kept;        /* true: later steps depend on it, so checkpoints contain it */
  PetscBool      optional;    /* true: a checkpoint may lack it; it is then zero */
  SamResultUse   result;
  SamStateMotion motion;
  PetscInt       layers;    /* number of layers below each cell; 0: a field of the surface */
  PetscBool      separates; /* true: the separation or the offset of later steps depends on it */
} SamStateField;

/*
  SamStateFieldSize - returns the number of values of a field per cell, that is of components of its vectors.

  Not collective.

  In:     field - declaration of the field

  Errors: none; it returns no error code.
*/
static inline PetscInt SamStateFieldSize(const SamStateField *field)
{
  return field->components * PetscMax(field->layers, 1);
}

#define SAM_STATE_MOST 64 /* most fields, and most results */

/*
  SamStateDeclareField - declares a field of a state.

  Collective.

  In:     state - the state
          field - the declaration; its names and texts are not copied
  Out:    id    - handle of the field

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_STATE_MOST fields or fields of results.

  Declaring the same name again returns the same handle.

  See also: SamStateSetField(), SamStateGetField(), SamStateFindField().
*/
PETSC_EXTERN PetscErrorCode SamStateDeclareField(SamState state, const SamStateField *field, PetscInt *id);

/*
  SamStateNumber - the declaration of numbers. Numbers that results offer are columns of /history: real numbers, which
  are NaN if a step has none, integers (then 0), statuses, or a matrix with a row and a column for each component (then
  NaN). The first number of a state is the coordinate of the others. Names and texts are copied.
*/
typedef enum { SAM_NUMBER_REAL, SAM_NUMBER_INT, SAM_NUMBER_STATUS, SAM_NUMBER_MATRIX } SamNumberKind;
/* SamNumberJoin - the rule by which the numbers of the parts of a step give the number of the whole step. */
typedef enum { SAM_JOIN_LAST, SAM_JOIN_SUM, SAM_JOIN_GREATEST } SamNumberJoin;
typedef struct {
  const char   *name, *unit, *text;
  SamNumberKind kind;
  PetscInt      count;  /* 1; all values of a matrix; any count for numbers that are no results */
  PetscBool     kept;   /* true: checkpoints contain it */
  PetscBool     result; /* true: a column of /history */
  SamNumberJoin join;
  PetscInt      order; /* order of its error in the cell size, for -errors; 0: the error is not estimated */
} SamStateNumber;

#define SAM_STATE_NUMBERS  512
#define SAM_STATE_DECLARED 256 /* most declarations of numbers */

/*
  SamStateDeclareNumber - declares one or more numbers of a state.

  Not collective.

  In:     state  - the state
          number - the declaration; its names and texts are copied
  Out:    id     - place of the first number

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_STATE_DECLARED declarations, or SAM_STATE_NUMBERS values.

  Numbers declared one after the other lie side by side. Declaring the same name again returns the same place.

  See also: SamStateFindNumber(), SamStateDeclareField().
*/
PETSC_EXTERN PetscErrorCode SamStateDeclareNumber(SamState state, const SamStateNumber *number, PetscInt *id);

/*
  SamStateResult - a field that results offer: a component of a stored field, or a field that `compute` writes into a
  vector, for the tried state or, without one, for the committed state. The values are real numbers, states of cells
  (stored as bytes), the points of an edge, or real numbers in layers below the cells. In the last case the vector has
  as many components as there are layers, and the name consists of a group, a slash, and a dataset. The declaration of a
  stored field offers it.
*/
typedef enum { SAM_FIELD_REAL, SAM_FIELD_STATE, SAM_FIELD_POINTS, SAM_FIELD_LAYERS } SamFieldKind;
typedef struct {
  const char  *name, *unit, *text;
  SamFieldKind kind;
  SamResultUse use;
  PetscErrorCode (*compute)(void *owner, SamState state, PetscInt component, Vec field); /* NULL: stored field */
  void    *owner;
  PetscInt component;
  PetscInt field; /* handle of the stored field; set by SamStateDeclareField() */
} SamStateResult;

/*
  SamStateSetField - gets the vector of a field's tried generation for writing.

  Collective.

  In:     state - the state
          id    - handle of the field
  Out:    field - the vector (unit of the declaration); borrowed

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a handle that no declaration has returned.

  The vector is zero when it is created, and has old values later.

  See also: SamStateGetField(), SamStateReadField().
*/
PETSC_EXTERN PetscErrorCode SamStateSetField(SamState state, PetscInt id, Vec *field);

/*
  SamStateGetField - returns the vector of a generation (unit of the declaration), NULL if it has not been set;
  borrowed.

  Not collective.

  In:     state      - the state
          id         - handle of the field
          generation - the generation

  Errors: none; it returns no error code.

  See also: SamStateSetField(), SamStateReadField(), SamStateFindField().
*/
PETSC_EXTERN Vec SamStateGetField(SamState state, PetscInt id, SamGeneration generation);

/*
  SamStateReadField - returns the vector of a field (unit of the declaration) from the tried generation if it has been
  set in this try, else from the committed one; NULL if there is neither.

  Not collective.

  In:     state - the state
          id    - handle of the field

  Errors: none; it returns no error code.

  The vector is borrowed until the next try, commit or rejection.

  See also: SamStateGetField(), SamStateFindField().
*/
PETSC_EXTERN Vec SamStateReadField(SamState state, PetscInt id);

/*
  SamStateFindField - returns the handle of a field, -1 if there is none of that name.

  Not collective.

  In:     state - the state
          name  - name of the field

  Errors: none; it returns no error code.

  See also: SamStateReadField(), SamStateDeclareField().
*/
PETSC_EXTERN PetscInt SamStateFindField(SamState state, const char name[]);

/*
  SamStateFindNumber - returns the place of the first of the numbers of a name, -1 if there are none.

  Not collective.

  In:     state - the state
          name  - name of the numbers

  Errors: none; it returns no error code.

  See also: SamStateDeclareNumber().
*/
PETSC_EXTERN PetscInt SamStateFindNumber(SamState state, const char name[]);

#endif

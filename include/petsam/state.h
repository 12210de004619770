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
  SamStateField - the declaration of a remembered field. A field of two components is offered as name_x and name_y. A
  field with depth has its values in `layers` layers below each cell, one after the other from the first layer down,
  each with all components; the layers are offered as name_1, name_2 and so on. The names and texts of fields are
  not copied.
*/
typedef struct {
  const char    *name, *unit, *text;
  PetscInt       components;  /* values a cell, 1 or 2 */
  PetscInt       generations; /* 2: tried and committed; 3: one step back too */
  PetscBool      kept;        /* later steps depend on it, so that checkpoints have it */
  PetscBool      optional;    /* a checkpoint may lack it; it is zero then */
  SamResultUse   result;
  SamStateMotion motion;
  PetscInt       layers;    /* below each cell; 0: a field of the surface */
  PetscBool      separates; /* the separation or the offset of later steps follows from it */
} SamStateField;
/* SamStateFieldSize - values of a field for each cell: the components of its vectors. Not collective. */
static inline PetscInt SamStateFieldSize(const SamStateField *field)
{
  return field->components * PetscMax(field->layers, 1);
}
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
  SamStateDeclareOptional - the same of numbers that another state or a checkpoint may lack, where they have their usual
  value, as from the start.
  SamStateIsOptional - whether the k-th declaration is of such; SamStateIsUsual - and all that is remembered of them is
  as usual. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateDeclareOptional(SamState state, const SamStateNumber *number, double usual,
                                                    PetscInt *id);
PETSC_INTERN PetscBool      SamStateIsOptional(SamState state, PetscInt k);
PETSC_INTERN PetscBool      SamStateIsUsual(SamState state, PetscInt k);

/*
  SamStateOfferNumber - makes a declared number a column of /history, unless it is one; `before` is its value in steps
  of an earlier run whose results lack it. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStateOfferNumber(SamState state, const char name[], double before);

/*
  SamStateResult - a field that results offer: a component of a remembered field, or what `compute` writes into a vector
  for the tried state, or without one for the committed state. The values are real numbers, states of cells (stored as
  bytes), the points of an edge, or real numbers in layers below the cells: then the vector has as many components as
  there are layers, and the name is that of a group, a slash, and a dataset. Remembered fields are offered by their
  declaration.
*/
typedef enum { SAM_FIELD_REAL, SAM_FIELD_STATE, SAM_FIELD_POINTS, SAM_FIELD_LAYERS } SamFieldKind;
typedef struct {
  const char  *name, *unit, *text;
  SamFieldKind kind;
  SamResultUse use;
  PetscErrorCode (*compute)(void *owner, SamState state, PetscInt component, Vec field); /* NULL: it is remembered */
  void    *owner;
  PetscInt component;
  PetscInt field; /* handle of the remembered field; set by SamStateDeclareField() */
} SamStateResult;
/*
  SamStateOffer - declares a computed field of the results. Not collective.
  SamStateSetLayers - the layers of all fields of that kind: z of their middles, rising: m below the surface of body 2,
  negative in body 1. SamStateGetLayers - their number and z, borrowed. Neither is collective.
*/
PETSC_INTERN PetscErrorCode SamStateSetLayers(SamState state, PetscInt count, const PetscReal z[]);
PETSC_INTERN PetscInt       SamStateGetLayers(SamState state, const PetscReal **z);
PETSC_INTERN PetscErrorCode SamStateOffer(SamState state, const SamStateResult *result);

/*
  SamStateSetField - the vector of a field's tried generation, to be written to: zero when it is first made, later with
  old values. Collective.
*/
PETSC_EXTERN PetscErrorCode SamStateSetField(SamState state, PetscInt id, Vec *field);
/* SamStateGetField - the vector of a generation; NULL where nobody has set it. Borrowed. Not collective. */
PETSC_EXTERN Vec SamStateGetField(SamState state, PetscInt id, SamGeneration generation);
/*
  SamStateReadField - the tried vector if it has been set in this try, else the committed one; NULL for neither.
  Borrowed until the next try, commit or rejection. Not collective.
*/
PETSC_EXTERN Vec SamStateReadField(SamState state, PetscInt id);
/* SamStateReadNumbers - in the tried generation, without one in the committed one. Not collective. */
PETSC_EXTERN double *SamStateReadNumbers(SamState state, PetscInt id);
/*
  SamStateJoinNumbers - joins the numbers of the tried generation to `parts`, those of the parts of the step before it:
  SAM_STATE_NUMBERS values, at first 0. `to_step`: into the tried generation, else into `parts`. Not collective.
*/
PETSC_INTERN void SamStateJoinNumbers(SamState state, double parts[], PetscBool to_step);

/*
  The declarations, in their order. None is collective.
  SamStateFind... - the handle of a name, -1: there is none. For results the place in their list.
*/
PETSC_INTERN PetscInt              SamStateCountFields(SamState state);
PETSC_INTERN const SamStateField  *SamStateFieldOf(SamState state, PetscInt id);
PETSC_EXTERN PetscInt              SamStateFindField(SamState state, const char name[]);
PETSC_INTERN PetscInt              SamStateCountNumbers(SamState state);
PETSC_INTERN const SamStateNumber *SamStateNumberOf(SamState state, PetscInt k, PetscInt *id);
PETSC_EXTERN PetscInt              SamStateFindNumber(SamState state, const char name[]);

#endif

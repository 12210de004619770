/*
  The control of a load step: it prescribes each of the six components by load, displacement or creepage, and
  conditions.
*/
#ifndef PETSAM_CONTROL_H
#define PETSAM_CONTROL_H

#include <petsam/grid.h>

/*
  SamComponent - the six components of the rigid motion of body 1 relative to body 2, in the order used everywhere. Each
  is a load and its conjugate displacement or rotation:
    N, Tx, Ty (N), Mx, My, Mz (N m)   and their conjugates   d_z, d_x, d_y (m), r_x, r_y, r_z (rad).
  With the pressure p and the shear q, and moments and rotations about x = y = 0,
    sum p dA = N,  sum q dA = (Tx, Ty),  sum y p dA = -Mx,  sum x p dA = My,  sum (x q_y - y q_x) dA = Mz.
*/
typedef enum {
  SAM_COMPONENT_N,
  SAM_COMPONENT_TX,
  SAM_COMPONENT_TY,
  SAM_COMPONENT_MX,
  SAM_COMPONENT_MY,
  SAM_COMPONENT_MZ,
  SAM_COMPONENTS
} SamComponent;

/*
  SamComponentName - the names of a component's load, of its displacement and of its creepage, as options (without
  dash), histories and results spell them, with units and a description. Tx, Ty and Mz have a creepage, the change of
  the displacement with the rolled distance; the others have none, and its name is NULL. In plane strain there is no Mx
  and no Mz.
*/
typedef struct {
  const char *load, *load_unit, *load_text;
  const char *rigid, *rigid_unit, *rigid_text;
  const char *creep, *creep_unit, *creep_text;
  PetscInt    axes; /* number of axes of a grid that has the component: 2, or 1 if plane strain has it, too */
} SamComponentName;
PETSC_EXTERN const SamComponentName SamComponentNames[SAM_COMPONENTS];

/*
  SamCondition - a quantity that a step prescribes besides the six components: a factor on friction, a load of a body, a
  rolled distance. Its owner adds it to the list of the problem; options, columns of histories, checkpoints, restarts,
  results and steps in process follow from the list. So a new condition is one entry in its owner's file.
*/
typedef struct {
  const char *name, *unit, *text;
  const char *group;  /* conditions of a group are in results and parameters together if any is given; NULL: its name */
  PetscReal   usual;  /* value if none is given */
  SamRange    range;  /* allowed values */
  PetscBool   option; /* true: it may be an option, and starts at `usual`; false: it starts at its first value */
  PetscBool   change; /* true: a change since the row before, divided among the steps of the row; false: a level */
  PetscBool   bounds; /* true: acts only on the bound of the shear, which each step computes anew */
  PetscBool   reverses;  /* true: causes shear, and changes sign in a reversed step */
  PetscBool   couples;   /* true: displaces the surfaces in all directions, so pressure and shear must be coupled */
  PetscBool   conjugate; /* true: a factor on a displacement; a step's number NAME_load is the work by a unit of it */
  PetscInt    place;     /* index in its list and in a control; set by SamConditionsAdd() */
} SamCondition;

/* SamConditions - the list of the conditions of a problem. */
#define SAM_CONDITIONS 128
typedef struct _n_SamConditions *SamConditions;

/*
  SamConditionsAdd - adds a condition to a list, unless the list has one of that name.

  Not collective, but to be called on all ranks.

  In:     conditions - the list
          condition  - the condition; its texts are copied
  Out:    own        - the list's condition of that name, with which SamControlGet() is called; borrowed; NULL: not
                       wanted

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_CONDITIONS conditions.

  See also: SamProblemGetConditions(), SamControlGet(), SamControlSet().
*/
PETSC_EXTERN PetscErrorCode SamConditionsAdd(SamConditions conditions, const SamCondition *condition,
                                             const SamCondition **own);

/*
  SamControl - the prescribed values of a load step. SamControlInitialize() sets the defaults, the user the rest. It is
  copied by assignment. SamControlGet() returns the values of conditions.

  See also: SamControlInitialize(), SamControlSet(), SamContactTry().
*/
typedef struct {
  PetscReal time; /* s; stored with the results; of all solutions only those of bodies that remember depend on it */
  PetscBool force[SAM_COMPONENTS]; /* true: the load is given and the displacement is found; false: the reverse */
  PetscBool creep[SAM_COMPONENTS]; /* true: the creepage is given instead of the displacement; `force` is then false */
  PetscReal value[SAM_COMPONENTS]; /* the given load (N, N m), displacement (m, rad) or creepage (1, 1/m) */
  PetscBool sudden;   /* true: the way here takes no time for bodies that remember, as that to the first row does */
  PetscBool together; /* from no contact: all loads grow in proportion; false: N first, then the tangential loads */
  PetscReal condition[SAM_CONDITIONS]; /* values of conditions by their places, where `given` is not 0 */
  unsigned char given[SAM_CONDITIONS];
} SamControl;

/*
  SamControlInitialize - sets all loads as given and 0, the time 0, and the usual values of all conditions.

  Not collective.

  Out:    control - the control

  Errors: none of its own.

  See also: SamControlSet(), SamContactTry().
*/
PETSC_EXTERN PetscErrorCode SamControlInitialize(SamControl *control);

/*
  SamControlGet - returns the value of a condition (unit of the condition).

  Not collective.

  In:     control   - the control; NULL: the usual value is returned
          condition - the condition, from the list of the problem

  Errors: none; it returns no error code.

  See also: SamControlSet(), SamConditionsAdd().
*/
PETSC_EXTERN PetscReal SamControlGet(const SamControl *control, const SamCondition *condition);

/*
  SamControlSet - prescribes a component by the name of its load, displacement or creepage, or a condition by its name.

  Not collective.

  In,out: control    - the control
  In:     conditions - conditions of the problem; NULL: there are none
          name       - the name: "load_tx", "disp_x", "creep_x" ..., or that of a condition
          value      - the value (N, N m, m, rad, 1 or 1/m, or the unit of the condition)

  Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for any other name; the message has the nearest one.

  See also: SamControlInitialize(), SamControlGet(), SamContactTry().
*/
PETSC_EXTERN PetscErrorCode SamControlSet(SamControl *control, SamConditions conditions, const char name[],
                                          PetscReal value);

#endif

/* What is prescribed in a load step: the six components, each by load, displacement or creepage, and conditions. */
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
  the displacement with the rolled distance; of the others its name is NULL. In plane strain there is no Mx and no Mz.
*/
typedef struct {
  const char *load, *load_unit, *load_text;
  const char *rigid, *rigid_unit, *rigid_text;
  const char *creep, *creep_unit, *creep_text;
  PetscInt    axes; /* of a grid that has the component */
} SamComponentName;
PETSC_EXTERN const SamComponentName SamComponentNames[SAM_COMPONENTS];
/* How a component is given. SamComponentNameOf - its name so, NULL: it cannot be given so. Not collective. */
typedef enum { SAM_BY_LOAD, SAM_BY_RIGID, SAM_BY_CREEP, SAM_WAYS } SamWay;
PETSC_INTERN const char *SamComponentNameOf(PetscInt component, SamWay way);
/* SamUnitOn - a number's unit on a grid: with one row of a load, area, volume or energy per metre. Not collective. */
PETSC_EXTERN const char *SamUnitOn(SamGrid grid, const char unit[]);

/*
  SamCondition - what a step prescribes besides the six components: a factor on friction, a load of a body, a rolled
  distance. Its owner adds it to the list of the problem; options, columns of histories, checkpoints, restarts, results
  and steps in process follow from there. So a new one is an entry in its owner's file.
*/
typedef struct {
  const char *name, *unit, *text;
  const char *group;  /* those of a group are in results and parameters together, if one is given; NULL: itself */
  PetscReal   usual;  /* its value when none is given */
  SamRange    range;  /* of its value */
  PetscBool   option; /* may be an option, and changes from `usual` to its first value; else it has that at once */
  PetscBool   change; /* not a level but a change since the row before, of which each of the row's steps has its part */
  PetscBool   bounds; /* acts on the bound of the shear only, which each step computes anew */
  PetscBool   reverses; /* causes shear, and changes its sign in a reversed step */
  PetscBool   couples;  /* displaces the surfaces in all directions, so that pressure and shear must be coupled */
  PetscInt    place;    /* in its list, and in a control; set by SamConditionsAdd() */
} SamCondition;

/*
  SamConditions - the list of the conditions of a problem.
  SamConditionsCreate - an empty list. SamConditionsReference, SamConditionsDestroy - add a reference, and give one
  back; the last one frees the list and its conditions.
  SamConditionsAdd - adds a condition, whose texts are copied; `own`: the list's own, by which controls are asked; NULL:
  not wanted. One of the same name is the same condition.
  SamConditionsCount, SamConditionsGet - their number; the k-th.
  SamConditionsFind - the condition of that name, NULL: none.
  Conditions are borrowed. Not collective, but to be called on all ranks. Errors of SamConditionsAdd():
  PETSC_ERR_ARG_OUTOFRANGE for more than SAM_CONDITIONS conditions.
*/
#define SAM_CONDITIONS 128
typedef struct _n_SamConditions *SamConditions;
PETSC_INTERN PetscErrorCode      SamConditionsCreate(SamConditions *conditions);
PETSC_INTERN PetscErrorCode      SamConditionsReference(SamConditions conditions);
PETSC_INTERN PetscErrorCode      SamConditionsDestroy(SamConditions *conditions);
PETSC_EXTERN PetscErrorCode      SamConditionsAdd(SamConditions conditions, const SamCondition *condition,
                                                  const SamCondition **own);
PETSC_INTERN PetscInt            SamConditionsCount(SamConditions conditions);
PETSC_INTERN const SamCondition *SamConditionsGet(SamConditions conditions, PetscInt k);
PETSC_INTERN const SamCondition *SamConditionsFind(SamConditions conditions, const char name[]);

/*
  SamControl - what is prescribed in a load step. SamControlInitialize() sets the defaults, the user the rest; it is
  copied by assignment. The values of conditions are asked for by SamControlGet().
*/
typedef struct {
  PetscReal time;                  /* s; stored with the results, the solution does not depend on it */
  PetscBool force[SAM_COMPONENTS]; /* true: the load is given and the displacement is found; false: the reverse */
  PetscBool creep[SAM_COMPONENTS]; /* true: not the displacement, but the creepage is given; then `force` is false */
  PetscReal value[SAM_COMPONENTS]; /* the given load (N, N m), displacement (m, rad) or creepage (1, 1/m) */
  PetscBool together; /* from no contact: all loads grow in proportion; false: N first, then the tangential loads */
  PetscReal condition[SAM_CONDITIONS]; /* by their places, those that are `given` */
  unsigned char given[SAM_CONDITIONS];
} SamControl;

/* SamControlInitialize - all loads given and 0, time 0, all conditions as usual. Not collective. */
PETSC_EXTERN PetscErrorCode SamControlInitialize(SamControl *control);
/*
  SamControlGet - the value of a condition; of no control (NULL), its usual one. SamControlSetCondition - sets it. Not
  collective.
*/
PETSC_EXTERN PetscReal SamControlGet(const SamControl *control, const SamCondition *condition);
PETSC_INTERN void      SamControlSetCondition(SamControl *control, const SamCondition *condition, PetscReal value);
/*
  SamControlSet - prescribes a component by the name of its load, displacement or creepage ("load_tx", "disp_x",
  "creep_x"; N, N m, m, rad, 1 or 1/m), or a condition by its name. `conditions` NULL: none. Not collective. Errors:
  PETSC_ERR_ARG_UNKNOWN_TYPE for any other name; the message has the nearest one.
*/
PETSC_EXTERN PetscErrorCode SamControlSet(SamControl *control, SamConditions conditions, const char name[],
                                          PetscReal value);
/* How a component is given, and setting it. Not collective. */
PETSC_EXTERN SamWay SamControlWay(const SamControl *control, PetscInt component);
PETSC_INTERN void   SamControlSetWay(SamControl *control, PetscInt component, SamWay way);
/*
  What a control prescribes, in one row: the loads, displacements or creepages of the six components, then the
  conditions of a list. SamControlCount - the number of these parts. SamControlPart - the k-th of them.
  SamControlSetPart - sets it. SamControlPartName - its name as an option (without dash) or column, as it is given. Not
  collective.
*/
PETSC_INTERN PetscInt    SamControlCount(SamConditions conditions);
PETSC_INTERN PetscReal   SamControlPart(const SamControl *control, SamConditions conditions, PetscInt k);
PETSC_INTERN void        SamControlSetPart(SamControl *control, SamConditions conditions, PetscInt k, PetscReal value);
PETSC_INTERN const char *SamControlPartName(const SamControl *control, SamConditions conditions, PetscInt k);
/*
  SamControlName - the k-th of all names that parts may have: of loads, displacements, creepages and conditions; NULL:
  there are no more. SamControlFind - the part of that name, and how it gives a component; -1: none. Not collective.
*/
PETSC_INTERN const char *SamControlName(SamConditions conditions, PetscInt k);
PETSC_INTERN PetscInt    SamControlFind(SamConditions conditions, const char name[], SamWay *way);
/*
  SamControlReadCondition - reads a condition from its option, if it may be one; `set`: it was given. Collective.
  Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamControlReadCondition(const SamOptions *from, const SamCondition *condition,
                                                    SamControl *control, PetscBool *set);

#endif

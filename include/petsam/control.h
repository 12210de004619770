/* What is prescribed in a load step: the six components, each by load, displacement or creepage, and the friction. */
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

/* Load cases of the bodies' compliances: most of a process, and most letters of a name. */
#define SAM_CASES     16
#define SAM_CASE_NAME 20

/* The components of a bulk stress, in the order used everywhere; before factors on load cases where both are kept. */
typedef enum { SAM_BULK_XX, SAM_BULK_YY, SAM_BULK_XY, SAM_BULK_COMPONENTS } SamBulkComponent;
#define SAM_BULK_AND_CASES (SAM_BULK_COMPONENTS + SAM_CASES)

/*
  SamControl - what is prescribed in a load step. SamControlInitialize() sets the defaults, the user the rest.
  A bulk stress stretches the surface of its body about x = y = 0 by Hooke's law, without stress normal to the surface;
  tension is positive.
*/
typedef struct {
  PetscReal time;                  /* s; stored with the results, the solution does not depend on it */
  PetscBool force[SAM_COMPONENTS]; /* true: the load is given and the displacement is found; false: the reverse */
  PetscBool creep[SAM_COMPONENTS]; /* true: not the displacement, but the creepage is given; then `force` is false */
  PetscReal value[SAM_COMPONENTS]; /* the given load (N, N m), displacement (m, rad) or creepage (1, 1/m) */
  PetscReal roll[2];               /* m; rolled distance of the step towards +x, +y: the grid moves over the bodies */
  PetscReal friction_scale;        /* factor on the coefficient of friction, >= 0 */
  PetscReal bulk_stress[2][SAM_BULK_COMPONENTS]; /* Pa, of body 1 and 2: uniform, parallel to the surface */
  PetscReal cases[SAM_CASES];                    /* factors on load cases, see SamControlAddCase() */
} SamControl;

/*
  SamCondition - what a step prescribes besides the six components: options, columns of histories, checkpoints, restarts
  and results follow from the list of them, SamConditions. To add one: a member of SamControl, and an entry there.
*/
typedef struct {
  const char *name, *unit, *text;
  size_t      place; /* of its value in SamControl */
  PetscReal   usual; /* its value when none is given */
  SamRange    range;
  PetscBool   option; /* may be an option, and changes from `usual` to its first value; else it has that at once */
  PetscBool   change; /* not a level but a change since the row before, of which each of the row's steps has its part */
  int         group;  /* those of a group are in results and parameters together, if one of them is given */
} SamCondition;
enum {
  SAM_CONDITION_FRICTION,
  SAM_CONDITION_BULK,
  SAM_CONDITION_ROLL = SAM_CONDITION_BULK + 2 * SAM_BULK_COMPONENTS,
  SAM_CONDITION_CASE = SAM_CONDITION_ROLL + 2,
  SAM_CONDITIONS     = SAM_CONDITION_CASE + SAM_CASES
};
PETSC_INTERN const SamCondition SamConditions[SAM_CONDITIONS];
/*
  SamControlAddCase - the condition body1_case_<name> or body2_case_<name> (body 0 or 1), and its place in `cases`; one
  that was added before keeps its place. `room`: there was one. SamConditionIsUsed - whether an entry has a name: those
  of load cases that no file has are idle. Not collective, but to be called on all ranks.
*/
PETSC_INTERN PetscErrorCode SamControlAddCase(PetscInt body, const char name[], PetscInt *place, PetscBool *room);
PETSC_INTERN PetscBool      SamConditionIsUsed(PetscInt k);
/* The entry of a component of the bulk stress of body 0 or 1. */
#define SAM_BULK_CONDITION(body, k) (&SamConditions[SAM_CONDITION_BULK + (body)*SAM_BULK_COMPONENTS + (k)])

/*
  What a control prescribes, in one row: the loads, displacements or creepages of the six components, then the
  conditions. SamControlPart - the k-th of them. SamControlPlace - where it is. SamControlPartName - its name as an
  option (without dash) or column, as it is given. SamControlWay - how a component is given; SamControlSetWay - sets it.
  Not collective.
*/
#define SAM_CONTROL_PARTS (SAM_COMPONENTS + SAM_CONDITIONS)
PETSC_INTERN PetscReal   SamControlPart(const SamControl *control, PetscInt k);
PETSC_INTERN PetscReal  *SamControlPlace(SamControl *control, PetscInt k);
PETSC_INTERN const char *SamControlPartName(const SamControl *control, PetscInt k);
PETSC_EXTERN SamWay      SamControlWay(const SamControl *control, PetscInt component);
PETSC_EXTERN void        SamControlSetWay(SamControl *control, PetscInt component, SamWay way);
/*
  SamControlRolled - the rolled distance by which creepages are multiplied, m: along x or along y alone as given, with
  its sign, else the length of the path. Not collective.
*/
PETSC_INTERN PetscReal SamControlRolled(const SamControl *control);

/*
  SamControlPack, SamControlUnpack - a control as SAM_CONTROL_NUMBERS numbers, and back. Not collective.
*/
#define SAM_CONTROL_NUMBERS (SAM_COMPONENTS + 1 + SAM_CONTROL_PARTS)
PETSC_INTERN void SamControlPack(const SamControl *control, double numbers[]);
PETSC_INTERN void SamControlUnpack(const double numbers[], SamControl *control);

/* SamControlInitialize - all loads given and 0, time 0, all conditions as usual. Not collective. */
PETSC_EXTERN PetscErrorCode SamControlInitialize(SamControl *control);
/*
  SamControlSet - prescribes a component by the name of its load, displacement or creepage ("load_tx", "disp_x",
  "creep_x"; N, N m, m, rad, 1 or 1/m). Not collective. Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for any other name.
*/
PETSC_EXTERN PetscErrorCode SamControlSet(SamControl *control, const char name[], PetscReal value);
/*
  SamControlReadCondition - reads the k-th condition from its option, if it may be one; `set`: it was given. Collective.
  Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamControlReadCondition(const SamOptions *from, PetscInt k, SamControl *control,
                                                    PetscBool *set);

#endif

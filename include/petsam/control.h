/* What is prescribed in a load step: the six components, each by its load or by its displacement, and the friction. */
#ifndef PETSAM_CONTROL_H
#define PETSAM_CONTROL_H

#include <petsam/base.h>

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
  SamComponentName - the names of a component's load and of its displacement, as options (without dash), histories and
  results spell them, with units and a description.
*/
typedef struct {
  const char *load, *load_unit, *load_text;
  const char *rigid, *rigid_unit, *rigid_text;
} SamComponentName;
PETSC_EXTERN const SamComponentName SamComponentNames[SAM_COMPONENTS];

/* The components of a bulk stress, in the order used everywhere. */
typedef enum { SAM_BULK_XX, SAM_BULK_YY, SAM_BULK_XY, SAM_BULK_COMPONENTS } SamBulkComponent;

/*
  SamControl - what is prescribed in a load step. SamControlInitialize() sets the defaults, the user the rest.
  A bulk stress stretches the surface of its body about x = y = 0 by Hooke's law, without stress normal to the surface;
  tension is positive.
*/
typedef struct {
  PetscReal time;                  /* s; stored with the results, the solution does not depend on it */
  PetscBool force[SAM_COMPONENTS]; /* true: the load is given and the displacement is found; false: the reverse */
  PetscReal value[SAM_COMPONENTS]; /* the given load (N, N m) or displacement (m, rad) */
  PetscReal friction_scale;        /* factor on the coefficient of friction, >= 0 */
  PetscReal bulk_stress[2][SAM_BULK_COMPONENTS]; /* Pa, of body 1 and 2: uniform, parallel to the surface */
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
  int         group;  /* those of a group are in results and parameters together, if one of them is given */
} SamCondition;
enum { SAM_CONDITION_FRICTION, SAM_CONDITION_BULK, SAM_CONDITIONS = SAM_CONDITION_BULK + 2 * SAM_BULK_COMPONENTS };
PETSC_EXTERN const SamCondition SamConditions[SAM_CONDITIONS];
/* The entry of a component of the bulk stress of body 0 or 1. */
#define SAM_BULK_CONDITION(body, k) (&SamConditions[SAM_CONDITION_BULK + (body)*SAM_BULK_COMPONENTS + (k)])

/*
  What a control prescribes, in one row: the loads or displacements of the six components, then the conditions.
  SamControlPart - the k-th of them. SamControlPlace - where it is. SamControlPartName - its name as an option (without
  dash) or column, of load or displacement. Not collective.
*/
#define SAM_CONTROL_PARTS (SAM_COMPONENTS + SAM_CONDITIONS)
PETSC_EXTERN PetscReal   SamControlPart(const SamControl *control, PetscInt k);
PETSC_EXTERN PetscReal  *SamControlPlace(SamControl *control, PetscInt k);
PETSC_EXTERN const char *SamControlPartName(const SamControl *control, PetscInt k);

/*
  SamControlPack, SamControlUnpack - a control as SAM_CONTROL_NUMBERS numbers, and back. Not collective.
*/
#define SAM_CONTROL_NUMBERS (SAM_COMPONENTS + 1 + SAM_CONTROL_PARTS)
PETSC_EXTERN void SamControlPack(const SamControl *control, double numbers[]);
PETSC_EXTERN void SamControlUnpack(const double numbers[], SamControl *control);

/* SamControlInitialize - all loads given and 0, time 0, all conditions as usual. Not collective. */
PETSC_EXTERN PetscErrorCode SamControlInitialize(SamControl *control);
/*
  SamControlSet - prescribes a component by the name of its load or of its displacement ("load_tx", "disp_x"; N, N m, m
  or rad). Not collective. Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for any other name.
*/
PETSC_EXTERN PetscErrorCode SamControlSet(SamControl *control, const char name[], PetscReal value);
/*
  SamControlReadCondition - reads the k-th condition from its option, if it may be one; `set`: it was given. Collective.
  Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamControlReadCondition(const SamOptions *from, PetscInt k, SamControl *control,
                                                    PetscBool *set);

#endif

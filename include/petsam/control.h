/* What is prescribed in a load step: the six components, each by its load or by its displacement, and the friction. */
#ifndef PETSAM_CONTROL_H
#define PETSAM_CONTROL_H

#include <petsam/base.h>

/*
  The six components of the rigid motion of body 1 against body 2, in the order in which they stand everywhere:
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

/* The names of a component's load and of its displacement, as options, histories and results spell them, and units. */
typedef struct {
  const char *load, *load_unit, *load_text;
  const char *rigid, *rigid_unit, *rigid_text;
} SamComponentName;
PETSC_EXTERN const SamComponentName SamComponentNames[SAM_COMPONENTS];

/* SamControl - what is prescribed in a load step. Filled by the user; SamControlInitialize() gives the defaults. */
typedef struct {
  PetscReal time;                  /* s; kept with the results, without influence on them */
  PetscBool force[SAM_COMPONENTS]; /* true: the load is given and the displacement is found; false: the reverse */
  PetscReal value[SAM_COMPONENTS]; /* the given load (N, N m) or displacement (m, rad) */
  PetscReal friction_scale;        /* factor on the coefficient of friction, >= 0 */
  PetscReal stretch[3];            /* strains xx, yy, xy of body 2's surface less those of body 1's, by bulk stress */
} SamControl;

/* SamControlInitialize - all loads 0, friction as it is, no stretch, time 0. Not collective. */
PETSC_EXTERN PetscErrorCode SamControlInitialize(SamControl *control);
/*
  SamControlSet - gives a component by the name of its load or of its displacement ("load_tx", "disp_x"). Not collective.
  Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for another name.
*/
PETSC_EXTERN PetscErrorCode SamControlSet(SamControl *control, const char name[], PetscReal value);

#endif

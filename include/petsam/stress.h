/* Stresses in the bodies under the tractions of a contact. */
#ifndef PETSAM_STRESS_H
#define PETSAM_STRESS_H

#include <petsam/fourier.h>

/* The components of the stress, tension positive, and the tractions that cause it, in the order used everywhere. */
typedef enum {
  SAM_STRESS_XX,
  SAM_STRESS_YY,
  SAM_STRESS_ZZ,
  SAM_STRESS_XY,
  SAM_STRESS_XZ,
  SAM_STRESS_YZ,
  SAM_STRESS_COMPONENTS
} SamStressComponent;
typedef enum { SAM_STRESS_P, SAM_STRESS_QX, SAM_STRESS_QY, SAM_STRESS_TRACTIONS } SamStressTraction;

/*
  SamStressCell - the stress in a half-space z >= 0 by uniform tractions on a rectangle of its surface. Not collective.

  Input:
    side    - the rectangle's sides, m
    poisson - Poisson's ratio
    point   - where, from the rectangle's centre, m; z >= 0. At z = 0 the stress is infinite on the rectangle's edges.

  Output:
    stress  - of each component by a unit of each traction: by p, which presses in the direction of z, and by q_x and
              q_y, which pull in the direction of x and y. On the surface zz is -p, xz is -q_x, yz is -q_y.

  The error is below 1e-12 of the largest kernel at that point, up to 16384 sides away. Sources: Love 1929, Phil. Trans.
  R. Soc. A 228, 377; Johnson 1985, Contact Mechanics, ch. 3.
*/
PETSC_EXTERN void SamStressCell(const PetscReal side[2], PetscReal poisson, const PetscReal point[3],
                                PetscReal stress[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS]);

/*
  SamStress - the stresses on planes parallel to the surface. z points into the body; on the surface of body 2 zz is -p,
  xz is -q_x and yz is -q_y, of body 1 zz is -p, xz is q_x and yz is q_y.
*/
typedef struct _n_SamStress *SamStress;

/*
  SamStressCreate - for body 1 or 2 (`body`) of that Poisson's ratio; `settings` of the transforms may be NULL.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamStressCreate(SamGrid grid, const SamFourierSettings *settings, PetscInt body,
                                            PetscReal poisson, SamStress *stress);
PETSC_EXTERN PetscErrorCode SamStressDestroy(SamStress *stress);
/* SamStressSetDepth - the plane z = depth (m, >= 0). Takes the time of some ten SamStressApply(). Collective. */
PETSC_EXTERN PetscErrorCode SamStressSetDepth(SamStress stress, PetscReal depth);
/*
  SamStressApply - the stresses (Pa, SAM_STRESS_COMPONENTS components) at the cells' centres, in place of the tractions:
  on entry the components zz, xz and yz of `field` are the pressure and the two components of the shear (Pa). These are
  uniform in each cell; the result is corrected to that of tractions that are smooth (src/stress/cell.c). Bulk stress is
  not in it. Collective. Errors: PETSC_ERR_ORDER before the depth is set.
*/
PETSC_EXTERN PetscErrorCode SamStressApply(SamStress stress, Vec field);

#endif

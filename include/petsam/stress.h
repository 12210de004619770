/* Stresses in the bodies under the tractions of a contact. */
#ifndef PETSAM_STRESS_H
#define PETSAM_STRESS_H

#include <petsam/grid.h>

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

#endif

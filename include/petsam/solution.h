/* The solution of a load step. */
#ifndef PETSAM_SOLUTION_H
#define PETSAM_SOLUTION_H

#include <petsam/problem.h>
#include <petsam/tangential.h>

/*
  SamSolution - the solution of a load step: tractions, rigid displacements and relative elastic displacements u.
  A field has one component, or two: on each rank all of x, then all of y. With the separation h of the bodies, by their
  shape and by the laws between them, the gap is g = u_z + h - rigid and the slip is s = u_t + stretch - rigid.
*/
typedef struct {
  SamControl control;               /* prescribed values */
  PetscBool  mid_step;              /* true: slip follows the shear at mid step; false: at the end of the step */
  PetscBool  lags;                  /* true: it follows the shear at the end although the loads may turn the shear */
  PetscBool  touches;               /* true: in new contact, slip counts from the time at which the cells touch */
  PetscReal  load[SAM_COMPONENTS];  /* N, N m: given or found */
  PetscReal  rigid[SAM_COMPONENTS]; /* m, rad: given or found */
  Vec        pressure;              /* Pa */
  Vec        bound;                 /* largest shear, Pa */
  Vec        shear;                 /* Pa, two components: acts on body 2 */
  Vec        displacement_z;        /* m: relative elastic displacement u_z */
  Vec        displacement_t;        /* m, two components: relative elastic displacement u_t */
  /*
    Part of the slip of the step that the shear at its end does not oppose (m, two components; NULL: zero): in cells
    that were in contact before, by the rotation of the shear; in others, the motion of the surfaces over each other
    until they touched.
  */
  Vec aside;
} SamSolution;

#endif

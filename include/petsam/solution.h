/* The solution of a load step, and the state of its cells. */
#ifndef PETSAM_SOLUTION_H
#define PETSAM_SOLUTION_H

#include <petsam/problem.h>

/* State of a cell, as the results store it. */
typedef enum { SAM_CELL_OPEN, SAM_CELL_STICK, SAM_CELL_SLIP } SamCellState;
/* Relative margin: a cell in contact counts as slipping where |q| >= (1 - SAM_SLIP_MARGIN) of its bound. */
#define SAM_SLIP_MARGIN 1e-5
/* SamCellStateOf - the state of a cell from its pressure, shear and the bound of that (all Pa). Not collective. */
static inline SamCellState SamCellStateOf(PetscReal p, PetscReal qx, PetscReal qy, PetscReal bound)
{
  if (p <= 0) return SAM_CELL_OPEN;
  return PetscSqrtReal(qx * qx + qy * qy) >= (1 - SAM_SLIP_MARGIN) * bound ? SAM_CELL_SLIP : SAM_CELL_STICK;
}

/*
  SamSolution - the solution of a load step: tractions, rigid displacements and relative elastic displacements u.
  A field has one component, or two: on each rank all of x, then all of y. With the separation h of the bodies, by their
  shape and by the laws between them, the gap is g = u_z + h - rigid and the slip is s = u_t + stretch - rigid.
*/
typedef struct {
  SamControl control;              /* what was prescribed */
  PetscBool  mid_step;             /* slip follows the direction of the shear at mid step, not at the end of the step */
  PetscBool  lags;                 /* it follows that at the end although the loads may turn it */
  PetscBool  touches;              /* where contact is made, slip counts from the time at which cells touch */
  PetscReal  load[SAM_COMPONENTS]; /* N, N m: given or found */
  PetscReal  rigid[SAM_COMPONENTS]; /* m, rad: given or found */
  Vec        pressure;              /* Pa */
  Vec        bound;                 /* Pa: the largest shear */
  Vec        shear;                 /* Pa, two components: acts on body 2 */
  Vec        displacement_z;        /* m: relative elastic displacement u_z */
  Vec        displacement_t;        /* m, two components: relative elastic displacement u_t */
  /*
    m, two components; NULL: zero. Part of the slip of the step that the shear at its end does not oppose: where there
    was contact before, by the turn of the shear, else what the surfaces have moved over each other until they
    touched.
  */
  Vec aside;
} SamSolution;

#endif

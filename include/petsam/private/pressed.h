/* The definition of contact: which pressures press. */
#ifndef PETSAM_PRIVATE_PRESSED_H
#define PETSAM_PRIVATE_PRESSED_H

#include <petscsys.h>

/*
  SamIsPressed - returns true if a cell with this pressure (Pa) is in contact. Solvers set the pressure of open cells
  to exactly 0. Where surfaces attract each other, this pressure is what contact bears besides the tension
  (SamSolution). Not collective.
*/
static inline PetscBool SamIsPressed(double pressure)
{
  return pressure > 0 ? PETSC_TRUE : PETSC_FALSE;
}

#endif

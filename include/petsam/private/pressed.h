/* The definition of contact: which pressures press. */
#ifndef PETSAM_PRIVATE_PRESSED_H
#define PETSAM_PRIVATE_PRESSED_H

#include <petscsys.h>

/*
  SamIsPressed - returns true if a cell with this pressure (Pa) is in contact. Solvers set the pressure of open cells to
  exactly 0. A law by which open surfaces attract each other adds a load and a displacement (lawimpl.h), so that this
  pressure is what contact bears besides the attraction. Not collective.
*/
static inline PetscBool SamIsPressed(double pressure)
{
  return pressure > 0 ? PETSC_TRUE : PETSC_FALSE;
}

#endif

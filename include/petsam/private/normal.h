/* Functions of normal, besides petsam/normal.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_NORMAL_H
#define PETSAM_PRIVATE_NORMAL_H

#include <petsam/normal.h>

/*
  SamNormalSetPressureLimit - sets the maximum admissible pressure (Pa) of the next solves; infinite (default): none.
  Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE unless it is > 0; PETSC_ERR_SUP if the method has no such bound.
  SamNormalLimitsPressure - returns true if the current method has such a bound. Not collective.
*/
PETSC_INTERN PetscErrorCode SamNormalSetPressureLimit(SamNormal normal, PetscReal limit);
PETSC_INTERN PetscBool      SamNormalLimitsPressure(SamNormal normal);

/*
  SamNormalSolveYielding - solves the same problem for surfaces that also recede in each cell by `diagonal` (m/Pa, one
  component, >= 0) times the pressure of that cell, so that the gap is g = S p + diagonal p + h - (d_z - y r_x + x r_y).
  Wear whose rate follows the pressure is of this kind (wear.h). Collective.
*/
PETSC_INTERN PetscErrorCode SamNormalSolveYielding(SamNormal normal, Vec h, Vec diagonal, SamBalance *balance,
                                                   PetscBool guess, Vec p);

#endif

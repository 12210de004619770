/* The solution of one load step, for the contact that takes the step. */
#ifndef PETSAM_STEP_H
#define PETSAM_STEP_H

#include <petsam/private/contact.h>

/* The numbers of the solvers, side by side in the state in this order. */
enum {
  SAM_COUNT_NORMAL,         /* of the normal solver: iterations, applications, preconditions */
  SAM_COUNT_TANGENTIAL = 3, /* the same of the tangential solver */
  SAM_COUNT_COUPLING   = 6,
  SAM_COUNTS           = 7
};

/*
  SamStepSolve - solves the normal and the tangential problem of the tried step, in turn when they are coupled. Failures
  are reported in `step` (solve.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamStepSolve(SamContact contact, SamStep *step);
/*
  SamStepSetDisplacements - lets the state store the displacements of the tried solution. It is called as late as
  possible: in the first step they then use the memory that the solvers have freed. Collective.
*/
PETSC_INTERN PetscErrorCode SamStepSetDisplacements(SamContact contact);
/*
  SamStepFindTurn - computes the part of the tried step's slip that the shear at its end does not oppose (m, two
  components), in cells that slide then, if slip is opposite to the shear at mid step (direction.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamStepFindTurn(SamContact contact, Vec turn);
/*
  SamStepDeclareRolling - declares the numbers of a motion in which material streams, and returns the first
  (steadystep.c). SamStepDeclareResistance - declares those of bodies with the trait skewed (resistance.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamStepDeclareRolling(SamState state, PetscInt *first);
PETSC_INTERN PetscErrorCode SamStepDeclareResistance(SamElasticity bodies, SamState state);

#endif

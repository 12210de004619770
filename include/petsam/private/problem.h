/* Functions of problem, besides petsam/problem.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_PROBLEM_H
#define PETSAM_PRIVATE_PROBLEM_H

#include <petsam/problem.h>

/* SamProblemReference - adds a reference. Not collective. */
PETSC_INTERN PetscErrorCode SamProblemReference(SamProblem problem);

/*
  SamProblemGetRolled - returns the rolled distance of a step, as SamMotionRolled() does. Not collective.
*/
PETSC_INTERN PetscReal SamProblemGetRolled(SamProblem problem, const SamControl *control, PetscReal distance[2]);

/*
  SamProblemGetGrid - returns the grid of the elasticity, borrowed.

  Not collective.

  In:     problem - the problem

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamGrid SamProblemGetGrid(SamProblem problem);

/*
  SamProblemSetQuadratic - marks the present gap as a quadratic function of x and y, or as not known to be one.
  SamProblemIsQuadratic - sets `quadratic` to true if the gap has been marked so and has not changed since. Collective.
  SamProblemGetRevision - gets a number of this rank that grows with each change of the gap, or of a law, that
  invalidates the pressure of a solved step. Each rank counts separately, so that a rank may write to its part of the
  gap without the others. Not collective.
*/
PETSC_INTERN PetscErrorCode SamProblemSetQuadratic(SamProblem problem, PetscBool quadratic);
PETSC_INTERN PetscErrorCode SamProblemIsQuadratic(SamProblem problem, PetscBool *quadratic);
PETSC_INTERN PetscErrorCode SamProblemGetRevision(SamProblem problem, PetscObjectState *revision);

/*
  SamProblemAddSum - adds a law as SamProblemAddLawOfType() does for a type that only accumulates a field, and nothing
  for another type. Collective.
  SamProblemGetLaws - gets all laws, in the order in which they act; borrowed. Not collective.
  SamProblemSetLawsFromOptions - lets every registered type read the options, and adds the laws that they select.
  Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamProblemAddSum(SamProblem problem, SamLawType type);
PETSC_INTERN PetscErrorCode SamProblemGetLaws(SamProblem problem, PetscInt *count, const SamLaw **laws);
PETSC_INTERN PetscErrorCode SamProblemSetLawsFromOptions(SamProblem problem, const SamOptions *from);

/*
  SamProblemGetBytes - returns the memory of the laws per cell, bytes. Not collective.
  SamProblemMoves - returns true if a law may change the separation from step to step. Not collective.
*/
PETSC_INTERN PetscInt  SamProblemGetBytes(SamProblem problem);
PETSC_INTERN PetscBool SamProblemMoves(SamProblem problem);

/*
  SamProblemHasFriction - sets `has` to true if the surfaces bear shear anywhere. Collective.
  SamProblemGetPressureLimit - gets the largest pressure that the surfaces bear, Pa; infinite: no limit. Not collective.
*/
PETSC_INTERN PetscErrorCode SamProblemHasFriction(SamProblem problem, PetscBool *has);
PETSC_INTERN PetscErrorCode SamProblemGetPressureLimit(SamProblem problem, PetscReal *limit);

#endif

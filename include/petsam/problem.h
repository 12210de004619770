/* The problem of a contact: the elasticity of the bodies, their shape, and the laws between them. */
#ifndef PETSAM_PROBLEM_H
#define PETSAM_PROBLEM_H

#include <petsam/law.h>

/*
  SamProblem - the elasticity of two bodies, the separation h of their undeformed surfaces, and the laws between them.
  At first h = 0 and there is one law, coulomb, with the coefficient 0.
*/
typedef struct _n_SamProblem *SamProblem;

/* SamProblemCreate - creates a problem, which references the elasticity. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem);
/* SamProblemReference - adds a reference. Not collective. */
PETSC_INTERN PetscErrorCode SamProblemReference(SamProblem problem);
/* SamProblemDestroy - drops a reference, the last one frees the problem; sets the handle to NULL. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemDestroy(SamProblem *problem);
/*
  SamProblemGetConditions - returns the conditions that steps may prescribe besides loads and displacements: those of
  the bodies, of their motion and of the laws that have been added; borrowed. Not collective.
  SamProblemGetRolled - returns the rolled distance of a step, as SamMotionRolled() does. Not collective.
*/
PETSC_EXTERN SamConditions SamProblemGetConditions(SamProblem problem);
PETSC_INTERN PetscReal     SamProblemGetRolled(SamProblem problem, const SamControl *control, PetscReal distance[2]);
/* SamProblemGetElasticity, SamProblemGetGrid - return the elasticity and its grid. Not collective. */
PETSC_EXTERN SamElasticity SamProblemGetElasticity(SamProblem problem); /* borrowed */
PETSC_EXTERN SamGrid       SamProblemGetGrid(SamProblem problem);       /* borrowed */

/*
  SamProblemSetGap - copies the separation h (m, one component). Collective.
  SamProblemGetGap - returns the field of the problem, borrowed. It may be changed through PETSc's functions
  (VecGetArray(), VecAXPY() ...), which raise its revision. Not collective.
  SamProblemSetQuadratic - marks the present gap as a quadratic function of x and y, or as not known to be one.
  SamProblemIsQuadratic - sets `quadratic` to true if the gap has been marked so and has not changed since. Collective.
  SamProblemGetRevision - gets a number of this rank that grows with each change of the gap, or of a law, that
  invalidates the pressure of a solved step. Each rank counts separately, so that a rank may write to its part of the
  gap without the others. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetGap(SamProblem problem, Vec h);
PETSC_EXTERN Vec            SamProblemGetGap(SamProblem problem);
PETSC_INTERN PetscErrorCode SamProblemSetQuadratic(SamProblem problem, PetscBool quadratic);
PETSC_INTERN PetscErrorCode SamProblemIsQuadratic(SamProblem problem, PetscBool *quadratic);
PETSC_INTERN PetscErrorCode SamProblemGetRevision(SamProblem problem, PetscObjectState *revision);

/*
  SamProblemAddLaw - adds a law, which it references; laws act in the order in which their types were registered.
  Collective. Errors: PETSC_ERR_ARG_WRONG for a second law of a type.
  SamProblemAddLawOfType - adds a law of that type, with its defaults, unless the problem has one; `law` may be NULL.
  Collective.
  SamProblemAddSum - does the same for a type that only accumulates a field, and nothing for another type. Collective.
  SamProblemGetLaw - returns the law of a type, NULL if there is none; borrowed. Not collective.
  SamProblemGetLaws - gets all laws, in the order in which they act; borrowed. Not collective.
  SamProblemSetLawsFromOptions - lets every registered type read the options, and adds the laws that they select.
  Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamProblemAddLaw(SamProblem problem, SamLaw law);
PETSC_EXTERN PetscErrorCode SamProblemAddLawOfType(SamProblem problem, SamLawType type, SamLaw *law);
PETSC_INTERN PetscErrorCode SamProblemAddSum(SamProblem problem, SamLawType type);
PETSC_EXTERN SamLaw         SamProblemGetLaw(SamProblem problem, SamLawType type);
PETSC_INTERN PetscErrorCode SamProblemGetLaws(SamProblem problem, PetscInt *count, const SamLaw **laws);
PETSC_INTERN PetscErrorCode SamProblemSetLawsFromOptions(SamProblem problem, const SamOptions *from);

/*
  SamProblemGetBytes - returns the memory of the laws per cell, bytes. Not collective.
  SamProblemMoves - returns true if a law may change the separation from step to step. Not collective.
*/
PETSC_INTERN PetscInt  SamProblemGetBytes(SamProblem problem);
PETSC_INTERN PetscBool SamProblemMoves(SamProblem problem);

/*
  SamProblemSetFriction, SamProblemSetFrictionField - set the coefficient of the law coulomb (law.h). Collective.
  SamProblemHasFriction - sets `has` to true if the surfaces bear shear anywhere. Collective.
  SamProblemGetPressureLimit - gets the largest pressure that the surfaces bear, Pa; infinite: no limit. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFriction(SamProblem problem, PetscReal friction);
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionField(SamProblem problem, Vec friction);
PETSC_INTERN PetscErrorCode SamProblemHasFriction(SamProblem problem, PetscBool *has);
PETSC_INTERN PetscErrorCode SamProblemGetPressureLimit(SamProblem problem, PetscReal *limit);

#endif

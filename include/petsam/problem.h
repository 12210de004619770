/* The problem of a contact: what the bodies are made of, how they are shaped, and what happens between them. */
#ifndef PETSAM_PROBLEM_H
#define PETSAM_PROBLEM_H

#include <petsam/law.h>

/*
  SamProblem - the elasticity of two bodies, the separation h of their undeformed surfaces, and the laws between them.
  At first h = 0 and there is one law, coulomb, with the coefficient 0.
*/
typedef struct _n_SamProblem *SamProblem;

/* SamProblemCreate - references the elasticity. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem);
/* SamProblemReference - adds a reference. Not collective. */
PETSC_INTERN PetscErrorCode SamProblemReference(SamProblem problem);
/* SamProblemDestroy - drops a reference, the last one frees the problem; sets the handle to NULL. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemDestroy(SamProblem *problem);
/*
  SamProblemGetConditions - what its steps prescribe besides loads and displacements: by the bodies, their motion and
  the laws that have been added; borrowed. Not collective.
  SamProblemGetRolled - the rolled distance of a step, as SamMotionRolled(). Not collective.
*/
PETSC_EXTERN SamConditions SamProblemGetConditions(SamProblem problem);
PETSC_INTERN PetscReal     SamProblemGetRolled(SamProblem problem, const SamControl *control, PetscReal distance[2]);
/* The elasticity and its grid. Not collective. */
PETSC_EXTERN SamElasticity SamProblemGetElasticity(SamProblem problem); /* borrowed */
PETSC_EXTERN SamGrid       SamProblemGetGrid(SamProblem problem);       /* borrowed */

/*
  SamProblemSetGap - copies the separation h (m, one component). Collective.
  SamProblemGetGap - the problem's own field, borrowed. It may be changed through PETSc's functions (VecGetArray(),
  VecAXPY() ...), which raise its revision. Not collective.
  SamProblemSetQuadratic - says that the gap, as it is now, is a quadratic function of place, or that it is not known to
  be; SamProblemIsQuadratic - whether it still is: a change of the gap ends it. Collective.
  SamProblemGetRevision - a number on this rank that grows with each change of the gap, or of a law, that makes the
  pressure of a solved step wrong. Each rank counts for itself, so that one may write to its part of the gap without the
  others. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetGap(SamProblem problem, Vec h);
PETSC_EXTERN Vec            SamProblemGetGap(SamProblem problem);
PETSC_INTERN PetscErrorCode SamProblemSetQuadratic(SamProblem problem, PetscBool quadratic);
PETSC_INTERN PetscErrorCode SamProblemIsQuadratic(SamProblem problem, PetscBool *quadratic);
PETSC_INTERN PetscErrorCode SamProblemGetRevision(SamProblem problem, PetscObjectState *revision);

/*
  SamProblemAddLaw - adds a law, which it references; laws act in the order in which their types were registered.
  Collective. Errors: PETSC_ERR_ARG_WRONG for a second law of a type.
  SamProblemAddLawOfType - adds a law of that type, with its defaults, unless there is one; `law` may be NULL.
  Collective.
  SamProblemAddSum - the same for a type that only accumulates a field; does nothing for another type. Collective.
  SamProblemGetLaw - the law of a type, NULL if there is none; borrowed. Not collective.
  SamProblemGetLaws - all laws, in the order in which they act; borrowed. Not collective.
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
  SamProblemGetBytes - memory that the laws take for each cell, bytes. Not collective.
  SamProblemMoves - whether a law changes the separation in time. Not collective.
*/
PETSC_INTERN PetscInt  SamProblemGetBytes(SamProblem problem);
PETSC_INTERN PetscBool SamProblemMoves(SamProblem problem);

/*
  SamProblemSetFriction, SamProblemSetFrictionField - set the coefficient of the law coulomb (law.h). Collective.
  SamProblemHasFriction - whether the surfaces bear shear anywhere. Collective.
  SamProblemGetPressureLimit - the largest pressure that the surfaces bear, Pa; infinite: no limit. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFriction(SamProblem problem, PetscReal friction);
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionField(SamProblem problem, Vec friction);
PETSC_INTERN PetscErrorCode SamProblemHasFriction(SamProblem problem, PetscBool *has);
PETSC_INTERN PetscErrorCode SamProblemGetPressureLimit(SamProblem problem, PetscReal *limit);

#endif

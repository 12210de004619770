/* The problem of a contact: the elasticity of the bodies, their shape, and the laws between them. */
#ifndef PETSAM_PROBLEM_H
#define PETSAM_PROBLEM_H

#include <petsam/law.h>

/*
  SamProblem - the elasticity of two bodies, the separation h of their undeformed surfaces, and the laws between them.
  At first h = 0 and there is one law, coulomb, with the coefficient 0.
*/
typedef struct _n_SamProblem *SamProblem;

/*
  SamProblemCreate - creates a problem of an elasticity.

  Collective.

  In:     elasticity - the elasticity; referenced
  Out:    problem    - the problem

  Errors: none of its own.

  See also: SamProblemSetGap(), SamProblemSetFriction(), SamProblemAddLaw(), SamContactCreate().
*/
PETSC_EXTERN PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem);

/*
  SamProblemDestroy - drops a reference of the problem, the last one frees it; sets the handle to NULL.

  Collective.

  In,out: problem - the problem; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamProblemDestroy(SamProblem *problem);

/*
  SamProblemGetConditions - returns the conditions that steps may prescribe besides loads and displacements; borrowed.

  Not collective.

  In:     problem - the problem

  Errors: none; it returns no error code.

  They are those of the bodies, of their motion and of the laws that have been added.

  See also: SamConditionsAdd(), SamControlSet().
*/
PETSC_EXTERN SamConditions SamProblemGetConditions(SamProblem problem);

/*
  SamProblemGetElasticity - returns the elasticity, borrowed.

  Not collective.

  In:     problem - the problem

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamElasticity SamProblemGetElasticity(SamProblem problem);

/*
  SamProblemSetGap - sets the separation of the undeformed bodies.

  Collective.

  In:     problem - the problem
          h       - separation (m), one component; copied

  Errors: PETSC_ERR_ARG_SIZ for a vector of another size.

  See also: SamGapFill(), SamProblemGetGap().
*/
PETSC_EXTERN PetscErrorCode SamProblemSetGap(SamProblem problem, Vec h);

/*
  SamProblemGetGap - returns the field of the separation (m), borrowed.

  Not collective.

  In:     problem - the problem

  Errors: none; it returns no error code.

  It may be changed through PETSc's functions (VecGetArray(), VecAXPY() ...), which raise its revision.

  See also: SamProblemSetGap().
*/
PETSC_EXTERN Vec SamProblemGetGap(SamProblem problem);

/*
  SamProblemAddLaw - adds a law to a problem.

  Collective.

  In:     problem - the problem
          law     - the law; referenced

  Errors: PETSC_ERR_ARG_WRONG for a second law of a type, or a law of another problem.

  Laws act in the order in which their types were registered.

  See also: SamLawCreate(), SamProblemAddLawOfType(), SamProblemGetLaw().
*/
PETSC_EXTERN PetscErrorCode SamProblemAddLaw(SamProblem problem, SamLaw law);

/*
  SamProblemAddLawOfType - adds a law of a type, with its defaults, unless the problem has one.

  Collective.

  In:     problem - the problem
          type    - name of a registered type
  Out:    law     - the law; borrowed; NULL: not wanted

  Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for a type that is not registered.

  See also: SamProblemAddLaw(), SamProblemGetLaw().
*/
PETSC_EXTERN PetscErrorCode SamProblemAddLawOfType(SamProblem problem, SamLawType type, SamLaw *law);

/*
  SamProblemGetLaw - returns the law of a type, NULL if there is none; borrowed.

  Not collective.

  In:     problem - the problem
          type    - name of the type

  Errors: none; it returns no error code.

  See also: SamProblemAddLaw(), SamProblemAddLawOfType().
*/
PETSC_EXTERN SamLaw SamProblemGetLaw(SamProblem problem, SamLawType type);

/*
  SamProblemSetFriction - sets the coefficient of friction, of the law coulomb (law.h).

  Collective.

  In:     problem  - the problem
          friction - the coefficient (1), >= 0

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a coefficient that is negative or not finite.

  See also: SamProblemSetFrictionField().
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFriction(SamProblem problem, PetscReal friction);

/*
  SamProblemSetFrictionField - sets a coefficient of friction for each cell, of the law coulomb (law.h).

  Collective.

  In:     problem  - the problem
          friction - the coefficient (1), one component, >= 0; copied

  Errors: PETSC_ERR_ARG_OUTOFRANGE for coefficients that are negative or not finite; PETSC_ERR_ARG_SIZ for a vector of
  another size.

  See also: SamProblemSetFriction(), SamGridCreateVec().
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionField(SamProblem problem, Vec friction);

#endif

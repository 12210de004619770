/* What is given of a contact: the bodies' elasticity, their gap, their friction. */
#ifndef PETSAM_PROBLEM_H
#define PETSAM_PROBLEM_H

#include <petsam/elasticity.h>

/*
  SamProblem - what a contact is given besides the control of each step: an elasticity, the gap (separation of the
  undeformed bodies, m) and the coefficient of friction, a number or a field.

  All of it may change between steps. What is computed from the gap remembers the gap's revision, a number that grows
  with every change; it never compares values.
*/
typedef struct _n_SamProblem *SamProblem;

/* SamProblemCreate - references the elasticity; the gap is zero, and there is no friction. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem);
PETSC_EXTERN PetscErrorCode SamProblemReference(SamProblem problem);
PETSC_EXTERN PetscErrorCode SamProblemDestroy(SamProblem *problem);
PETSC_EXTERN PetscErrorCode SamProblemGetElasticity(SamProblem problem, SamElasticity *elasticity); /* borrowed */
PETSC_EXTERN PetscErrorCode SamProblemGetGrid(SamProblem problem, SamGrid *grid);                   /* borrowed */

/*
  SamProblemSetGap - copies the separation h (m, one component). Collective.
  SamProblemGetGap - the problem's own field, borrowed. It may be written to through PETSc's functions (VecGetArray(),
  VecAXPY() ...), which raise its revision, a number of each rank's own: any rank may write without the others. Not
  collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetGap(SamProblem problem, Vec h);
PETSC_EXTERN PetscErrorCode SamProblemGetGap(SamProblem problem, Vec *h);
PETSC_EXTERN PetscErrorCode SamProblemGetGapRevision(SamProblem problem, PetscObjectState *revision);

/*
  SamProblemSetFriction - Coulomb's coefficient, the same everywhere; SamProblemSetFrictionField - one for each cell
  (one component), copied. The later call counts. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for one that is negative
  or not finite.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFriction(SamProblem problem, PetscReal friction);
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionField(SamProblem problem, Vec friction);
/*
  SamProblemSetFrictionFromOptions - from -friction, or -friction_file and -friction_dataset (/friction): an HDF5 dataset
  of (ny, nx), each value >= 0. Collective. Errors: SAM_ERR_USER for wrong options, SAM_ERR_FILE for a wrong file.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionFromOptions(SamProblem problem, const SamOptions *from);
/* SamProblemGetFriction - the number, or its field (borrowed; NULL when it is a number). Not collective. */
PETSC_EXTERN PetscErrorCode SamProblemGetFriction(SamProblem problem, PetscReal *friction, Vec *field);
/* SamProblemHasFriction - whether the coefficient is positive anywhere. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemHasFriction(SamProblem problem, PetscBool *has);
/* SamProblemComputeBound - the largest shear of each cell, scale * friction * pressure (Pa, one component);
   both may be the same vector. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemComputeBound(SamProblem problem, PetscReal scale, Vec pressure, Vec bound);

#endif

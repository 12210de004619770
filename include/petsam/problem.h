/* The problem of a contact: the bodies' elasticity, their gap and their friction. */
#ifndef PETSAM_PROBLEM_H
#define PETSAM_PROBLEM_H

#include <petsam/elasticity.h>

/*
  SamProblem - what a contact is given besides the control of each step: an elasticity, the gap (the separation of the
  undeformed bodies, m), the coefficient of friction, a number or a field, and the largest pressure that the surfaces
  bear.

  Gap and friction may change between steps. The gap has a revision, a number that grows with every change. What is
  computed from the gap keeps the revision it came from, so that no values need to be compared.
*/
typedef struct _n_SamProblem *SamProblem;

/* SamProblemCreate - a problem with zero gap and without friction; references the elasticity. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem);
/* SamProblemReference - adds a reference, which SamProblemDestroy() gives back. Not collective. */
PETSC_EXTERN PetscErrorCode SamProblemReference(SamProblem problem);
/* SamProblemDestroy - gives back a reference, the last one frees the problem; sets the handle to NULL. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemDestroy(SamProblem *problem);
/* The elasticity and its grid. Not collective. */
PETSC_EXTERN PetscErrorCode SamProblemGetElasticity(SamProblem problem, SamElasticity *elasticity); /* borrowed */
PETSC_EXTERN PetscErrorCode SamProblemGetGrid(SamProblem problem, SamGrid *grid);                   /* borrowed */

/*
  SamProblemSetGap - copies the separation h (m, one component). Collective.
  SamProblemGetGap - the problem's own field, borrowed. It may be changed through PETSc's functions (VecGetArray(),
  VecAXPY() ...), which raise its revision. Not collective.
  SamProblemGetGapRevision - the revision on this rank. Each rank counts for itself, so that one may write to its part
  without the others. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetGap(SamProblem problem, Vec h);
PETSC_EXTERN PetscErrorCode SamProblemGetGap(SamProblem problem, Vec *h);
PETSC_EXTERN PetscErrorCode SamProblemGetGapRevision(SamProblem problem, PetscObjectState *revision);

/*
  SamProblemSetFriction - the coefficient of friction, the same everywhere.
  SamProblemSetFrictionField - one coefficient for each cell (one component), copied.
  The later of the two calls counts. Both are collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a coefficient that is
  negative or not finite.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFriction(SamProblem problem, PetscReal friction);
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionField(SamProblem problem, Vec friction);
/*
  SamProblemSetFrictionFromOptions - reads -friction (a number), or -friction_file and -friction_dataset (default
  /friction): an HDF5 dataset of shape (ny, nx) with values >= 0. Without these options the friction stays as it is.
  Collective. Errors: SAM_ERR_USER for wrong options, SAM_ERR_FILE for a file that cannot be used.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetFrictionFromOptions(SamProblem problem, const SamOptions *from);
/* SamProblemGetFriction - the number, and the field (borrowed; NULL: the number counts). Not collective. */
PETSC_EXTERN PetscErrorCode SamProblemGetFriction(SamProblem problem, PetscReal *friction, Vec *field);
/* SamProblemHasFriction - whether the coefficient is positive anywhere. Collective. */
PETSC_EXTERN PetscErrorCode SamProblemHasFriction(SamProblem problem, PetscBool *has);
/*
  SamProblemSetPressureLimit - the hardness (Pa): the largest pressure, at which the surfaces yield; infinite (default):
  none. Another limit counts as a change of the gap. Not collective, the same on all ranks. Errors:
  PETSC_ERR_ARG_OUTOFRANGE unless it is > 0.
  SamProblemSetPressureLimitFromOptions - reads -pressure_limit. Collective. Errors: SAM_ERR_USER.
  SamProblemGetPressureLimit - the limit. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemSetPressureLimit(SamProblem problem, PetscReal limit);
PETSC_EXTERN PetscErrorCode SamProblemSetPressureLimitFromOptions(SamProblem problem, const SamOptions *from);
PETSC_EXTERN PetscErrorCode SamProblemGetPressureLimit(SamProblem problem, PetscReal *limit);
/*
  SamProblemComputeBound - the largest shear that each cell bears, scale * friction * pressure (Pa, one component).
  `pressure` and `bound` may be the same vector. Collective.
*/
PETSC_EXTERN PetscErrorCode SamProblemComputeBound(SamProblem problem, PetscReal scale, Vec pressure, Vec bound);

#endif

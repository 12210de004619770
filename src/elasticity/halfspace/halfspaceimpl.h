/* What the files of the half-spaces share. */
#ifndef PETSAM_HALFSPACEIMPL_H
#define PETSAM_HALFSPACEIMPL_H

#include <petsam/private/elasticityimpl.h>

/* The preconditioners, by the type's method. */
PETSC_INTERN PetscErrorCode SamHalfSpacePreconditionNormal(SamElasticity elasticity, double factor,
                                                           const float *const residual[], float *const p[]);
PETSC_INTERN PetscErrorCode SamHalfSpacePreconditionTangential(SamElasticity elasticity, double factor,
                                                               const float *const residual[], float *const q[]);

#endif

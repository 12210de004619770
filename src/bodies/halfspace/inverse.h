/* The spectral preconditioners of half-spaces, methods of their type (inverse.c). */
#ifndef PETSAM_INVERSE_H
#define PETSAM_INVERSE_H

#include "../layered/layeredwaves.h"
#include <petsam/private/elasticityimpl.h>

PETSC_INTERN PetscErrorCode SamHalfSpacePreconditionNormal(SamElasticity, double factor, const float *const r[],
                                                           float *const p[]);
PETSC_INTERN PetscErrorCode SamHalfSpacePreconditionSliding(SamElasticity, double factor, const double slope[2],
                                                            const float *const r[], float *const p[]);
PETSC_INTERN PetscErrorCode SamHalfSpacePreconditionTangential(SamElasticity, double factor, const float *const r[],
                                                               float *const q[]);
PETSC_INTERN PetscErrorCode SamHalfSpacePreconditionSlip(SamElasticity, double factor, const float *const r[],
                                                         float *const q[]);
/* SamHalfSpaceLayers - returns the layers of half-spaces; NULL: none. Not collective. */
PETSC_INTERN SamLayered SamHalfSpaceLayers(SamElasticity);

#endif

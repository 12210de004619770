/* The inside of SamElasticity. */
#ifndef PETSAM_ELASTICITYIMPL_H
#define PETSAM_ELASTICITYIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/elasticity.h>
#include <petsam/fourier.h>

/* Kernels: row and column of the 3 x 3 operator; the lower triangle follows by symmetry. */
typedef enum { SAM_ZZ, SAM_XX, SAM_YY, SAM_XY, SAM_XZ, SAM_YZ, SAM_KERNELS } SamKernelKind;

struct _n_SamElasticity {
  PetscInt      references;
  SamGrid       grid;
  SamPair       pair;
  SamFourier    fourier;
  SamKernel     kernel[SAM_KERNELS]; /* NULL until needed */
  SamElasticity coarse;
  SamTransfer   transfer;
  SamWindow     window; /* of the part; NULL: none */
  SamElasticity part;
};

PETSC_EXTERN PetscErrorCode SamElasticityGetKernel(SamElasticity elasticity, SamKernelKind kind, SamKernel *kernel);
/* The influence coefficient at lag (i, j), m/Pa. */
PETSC_EXTERN double SamInfluenceCoefficient(SamElasticity elasticity, SamKernelKind kind, PetscInt i, PetscInt j);

#endif

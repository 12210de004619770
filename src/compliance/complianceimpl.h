/* The inside of SamCompliance. */
#ifndef PETSAM_COMPLIANCEIMPL_H
#define PETSAM_COMPLIANCEIMPL_H

#include "../base/baseimpl.h"
#include <petsam/compliance.h>
#include <petsam/convolution.h>

/* Kernels: row and column of the 3 x 3 operator; the lower triangle follows by symmetry. */
typedef enum { SAM_ZZ, SAM_XX, SAM_YY, SAM_XY, SAM_XZ, SAM_YZ, SAM_KERNELS } SamKernelKind;

struct _n_SamCompliance {
  PetscInt      references;
  SamGrid       grid;
  SamPair       pair;
  SamFourier    fourier;
  SamKernel     kernel[SAM_KERNELS]; /* NULL until needed */
  SamCompliance coarse;
  SamTransfer   transfer;
  SamWindow     window; /* of the part; NULL: none */
  SamCompliance part;
};

PETSC_INTERN PetscErrorCode SamComplianceGetKernel(SamCompliance compliance, SamKernelKind kind, SamKernel *kernel);
/* The influence coefficient at lag (i, j), m/Pa. */
PETSC_INTERN double SamInfluenceCoefficient(SamCompliance compliance, SamKernelKind kind, PetscInt i, PetscInt j);

#endif

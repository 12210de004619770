/* The inside of this folder: the stresses by plastic strain, the material, and its solution together with the
   contact. */
#ifndef PETSAM_PLASTICIMPL_H
#define PETSAM_PLASTICIMPL_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/stressimpl.h>

/* Components of stress and strain, in the order of SamStressComponent; shear strains are those of the tensor. */
enum { PARTS = SAM_STRESS_COMPONENTS };

/*
  SamResidual - the response of a body to an eigenstrain e, which is constant over each layer and given at the cells'
  centres: the stress, as mean over each layer, and the displacement of the surface; also the stress by tractions. A
  field e or s has PARTS components for each layer, layer after layer from the surface down: component c of layer l
  begins at (PARTS * l + c) * cells of an array of this rank's cells. The stress by e is symmetric, and minus it
  semidefinite, in sum h e:s; the displacement by e is the transpose of the stress by tractions with these weights (to
  rounding).
*/
typedef struct _n_SamResidual *SamResidual;
/*
  SamResidualCreate - creates the operators for body 1 or 2 of a uniform pair of half-spaces, periodic or not.
  `thickness`: of the layers (m). Collective. Errors: as SamResidualCheckBodies().
  SamResidualCheckBodies - fails for other types of elasticity, layered or rigid bodies. Collective. Errors:
  SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamResidualCheckBodies(SamElasticity elasticity, PetscInt body);
PETSC_INTERN PetscErrorCode SamResidualCreate(SamElasticity elasticity, PetscInt body, PetscInt layers,
                                              const PetscReal thickness[], SamResidual *residual);
PETSC_INTERN PetscErrorCode SamResidualDestroy(SamResidual *residual);
/*
  SamResidualSetLayers - restricts the operators to the first layers, the same on all ranks: the strain below them
  counts as zero, and no stress is computed there. Not collective.
*/
PETSC_INTERN void SamResidualSetLayers(SamResidual residual, PetscInt layers);
/*
  SamResidualApply - computes the stress s (Pa) and the displacement u of the surface (m) by e; NULL: not wanted. u is
  the body's contribution to the relative displacement of the surfaces along x, y, and z into the body. s may be e.
  SamResidualLoad - computes the stress by the pressure p and the shear q_x, q_y between the bodies (Pa).
  SamResidualLoadAt - computes the same at a depth (m) instead of in layers, PARTS fields; it takes the time of about
  ten layers. All are collective.
*/
PETSC_INTERN PetscErrorCode SamResidualApply(SamResidual residual, const double e[], double s[], double *const u[3]);
PETSC_INTERN PetscErrorCode SamResidualLoad(SamResidual residual, const double *const traction[3], double s[]);
PETSC_INTERN PetscErrorCode SamResidualLoadAt(SamResidual residual, PetscReal depth, const double *const traction[3],
                                              double s[]);

#endif

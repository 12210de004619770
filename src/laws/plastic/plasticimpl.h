/* The inside of this folder: the stresses by plastic strain, the material, and its solution together with the
   contact. */
#ifndef PETSAM_PLASTICIMPL_H
#define PETSAM_PLASTICIMPL_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/lawimpl.h>
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
  `thickness`: of the layers (m). `images`: without it, the images of the grid in a padded period act, too, where bodies
  are not periodic; that costs some parts in a thousand of accuracy. Collective. Errors: as SamResidualCheckBodies().
  SamResidualCheckBodies - fails for other types of elasticity, layered or rigid bodies. Collective. Errors:
  SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamResidualCheckBodies(SamElasticity elasticity, PetscInt body);
PETSC_INTERN PetscErrorCode SamResidualCreate(SamElasticity elasticity, PetscInt body, PetscInt layers,
                                              const PetscReal thickness[], PetscBool images, SamResidual *residual);
PETSC_INTERN PetscErrorCode SamResidualDestroy(SamResidual *residual);
/*
  SamResidualBegin - begins products of one or both bodies with e, of the bodies one after the other, whose layers are
  `step` fields apart, the first PARTS of which are e. It computes the displacement u of the surfaces (m; NULL: not
  wanted), their relative displacement along x, y, and z into the body.
  SamResidualBeginWithout - begins products without a strain. It is a function of its own because a rank without cells
  has no array e: NULL cannot mean that there is no strain.
  SamResidualEnd - computes the stress s (Pa) by e and by the pressure p and the shear q_x, q_y between the bodies (Pa;
  NULL: none), which may be those that u causes. s may be e.
  SamResidualLoadAt - computes the stress by p and q at a depth (m), PARTS fields; it takes the time of about ten
  layers. All are collective.
*/
PETSC_INTERN PetscErrorCode SamResidualBegin(PetscInt bodies, const SamResidual residual[], const double e[],
                                             PetscInt step, double *const u[3]);
PETSC_INTERN void           SamResidualBeginWithout(PetscInt bodies, const SamResidual residual[]);
PETSC_INTERN PetscErrorCode SamResidualEnd(PetscInt bodies, const SamResidual residual[],
                                           const double *const traction[3], double s[]);
PETSC_INTERN PetscErrorCode SamResidualLoadAt(SamResidual residual, PetscReal depth, const double *const traction[3],
                                              double s[]);

/*
  SAM_PLASTIC_THICK - the thickness of the layer in which a body yields first, relative to the half width of the
  contact, above which the maximum plastic strain is more than 4 % too small.
*/
#define SAM_PLASTIC_THICK 0.2
/*
  SamPlasticGetYieldStress - returns the smallest yield stress (Pa) at the surface of a body of this law; infinite if
  layers that do not yield lie on it. Not collective.
  SamPlasticGetFlow - the law's method `flow`: below its layers if a body has any.
  SamPlasticExamine, SamPlasticDoubt - its methods `examine` and `doubt` (plasticdoubt.c). Collective.
*/
PETSC_INTERN PetscReal      SamPlasticGetYieldStress(SamLaw law);
PETSC_INTERN PetscErrorCode SamPlasticGetFlow(SamLaw law, PetscReal strain, PetscReal *stress);
PETSC_INTERN PetscErrorCode SamPlasticExamine(SamLaw law, SamExamination *examination);
PETSC_INTERN PetscErrorCode SamPlasticDoubt(SamLaw law, SamExamination *examination);

#endif

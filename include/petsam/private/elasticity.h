/* Functions of elasticity, besides petsam/elasticity.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_ELASTICITY_H
#define PETSAM_PRIVATE_ELASTICITY_H

#include <petsam/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/grid.h>
#include <petsam/private/stress.h>

/*
  SamElasticityAddFromOptions - replaces the bodies by those with all that the options add to them, as the compliances
  of finite bodies (-body1_compliance). Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamElasticityAddFromOptions(SamElasticity *elasticity, const SamOptions *from);
/* SamElasticityGetTypes - writes the registered types as a text: a, b or c. Not collective. */
PETSC_INTERN PetscErrorCode SamElasticityGetTypes(char types[], size_t size);
PETSC_INTERN PetscErrorCode SamElasticityReference(SamElasticity elasticity);
/*
  SamElasticityPlaneFromOptions - sets `plane` to true if -elasticity names a plane type, which needs a grid of one row.
  Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityPlaneFromOptions(const SamOptions *from, PetscBool *plane);
/*
  SamElasticityAddParameters - appends the parameters that define the bodies, under the names of their options: elastic
  constants, type, and parameters of the type. Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityAddParameters(SamElasticity elasticity, SamParameters *parameters);
/*
  SamElasticityCreateOfPair - creates an elasticity of the same type and settings on the same grid for another pair of
  bodies, without a film. Collective. Errors: PETSC_ERR_SUP for a type that adds to another one, or has more than the
  pair to describe its bodies.
*/
PETSC_INTERN PetscErrorCode SamElasticityCreateOfPair(SamElasticity like, SamPair pair, SamElasticity *elasticity);
/*
  SamElasticityGetCoarse - gets the operator on the next coarser grid, and the transfer to it; both are borrowed, and
  NULL if the grid is too small to be halved (fewer than 8 cells in a direction, except a single row). They are created
  at the first call. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityGetCoarse(SamElasticity elasticity, SamElasticity *coarse,
                                                   SamTransfer *transfer);
/*
  SamElasticityTrim - frees the transforms' memory if it is large, until the next product. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityTrim(SamElasticity elasticity);
/*
  The following functions select the operator on a part of the grid. The window and the operator are borrowed until
  another part is selected, and NULL without a part. One part is in use at a time. The previous part is kept, so that
  its reuse costs nothing. All are collective, except SamElasticityGetPartPlace().
  SamElasticityChoosePart - selects a part that contains the n[0] * n[1] cells from first[0], first[1] on and some more
  around them; none if it would be hardly smaller than the grid, or the type has no parts. `keep`: the part in use stays
  if it contains these cells and is not much too large.
  SamElasticitySetPart - selects exactly these cells; n = 0: no part.
  SamElasticityGetPartShare - returns the share of the grid's cells that a part for n[0] * n[1] cells in the middle has;
  0: it would not be used. Not collective.
  SamElasticityGetPartPlace - gets the cells of the part in use; n = 0: no part. Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityChoosePart(SamElasticity elasticity, const PetscInt first[2],
                                                    const PetscInt n[2], PetscBool keep, SamWindow *window,
                                                    SamElasticity *part);
PETSC_INTERN PetscReal      SamElasticityGetPartShare(SamElasticity elasticity, const PetscInt n[2]);
PETSC_INTERN PetscErrorCode SamElasticitySetPart(SamElasticity elasticity, const PetscInt first[2],
                                                 const PetscInt n[2]);
PETSC_INTERN PetscErrorCode SamElasticityGetPartPlace(SamElasticity elasticity, PetscInt first[2], PetscInt n[2]);
/*
  The following functions compute `factor` times a product in single precision, for arrays of this rank's cells, with
  two components one after the other. They are for directions and corrections, whose product is small relative to the
  number to which it is added. Input and result should be scaled to the order of one, since floats end at 1e-38.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityApplyNormalSingle(SamElasticity elasticity, double factor, const float p[],
                                                           float u_z[]);
PETSC_INTERN PetscErrorCode SamElasticityApplyTangentialSingle(SamElasticity elasticity, double factor, const float q[],
                                                               float u_t[]);
/*
  The following functions apply approximate inverses, which are symmetric positive definite. For half-spaces: |k| for
  the normal part and |k| (I + nu/(1 - nu) kk'/|k|^2) for the tangential one, k being the wave vector on the grid made
  periodic; the mean gets half the gain of the longest wave. For periodic bodies this is the exact inverse, except for
  the mean. The result is computed in single precision and multiplied by `factor`; the arrays are as above. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityPreconditionNormalSingle(SamElasticity elasticity, double factor,
                                                                  const float residual[], float p[]);
PETSC_INTERN PetscErrorCode SamElasticityPreconditionTangentialSingle(SamElasticity elasticity, double factor,
                                                                      const float residual[], float q[]);
/*
  SamElasticityPreconditionSlidingSingle - applies the approximate inverse of the normal displacement by a pressure that
  takes the shear `slope`, Pa/Pa, with it, as cells of dissimilar bodies do where they slip. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityPreconditionSlidingSingle(SamElasticity elasticity, double factor,
                                                                   const double slope[2], const float residual[],
                                                                   float p[]);
/*
  SamElasticityPreconditionSlipSingle - applies the approximate inverse for the slip zone of rolling bodies: that of h A
  + 1 - h, h = SAM_SLIP_WEIGHT, where A is the tangential operator of SamElasticityCreateRolling(), before the sweep
  along x (halfspace.c). Collective.
*/
#define SAM_SLIP_WEIGHT 0.5
PETSC_INTERN PetscErrorCode SamElasticityPreconditionSlipSingle(SamElasticity elasticity, double factor,
                                                                const float residual[], float q[]);

/*
  SamElasticityGetPair - returns the pair of bodies, borrowed.

  Not collective.

  In:     elasticity - the elasticity

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamPair SamElasticityGetPair(SamElasticity elasticity);

/* SamElasticityGetModulus - returns E* (Pa) of the materials at the surfaces. Not collective. */
PETSC_INTERN PetscReal SamElasticityGetModulus(SamElasticity elasticity);

/*
  SamElasticityCreateFromParameters - creates the bodies that the parameters of a run describe, on a grid.

  Collective.

  In:     grid       - the grid; referenced
          parameters - parameters of the run
          source     - the file of the parameters, for messages
  Out:    elasticity - the elasticity

  Errors: SAM_ERR_FILE for a type that is not registered or does not fit the grid, and for parameters that are missing
  or invalid.
*/
PETSC_EXTERN PetscErrorCode SamElasticityCreateFromParameters(SamGrid grid, const SamParameters *parameters,
                                                              const char source[], SamElasticity *elasticity);

/*
  SamElasticityCreateStress - creates an object that computes the stresses in body 1 or 2 under tractions on the grid
  (stress.h). `settings`: those of the transforms, NULL: the elasticity's. Collective. Errors: PETSC_ERR_SUP without the
  trait `stress`; PETSC_ERR_ARG_OUTOFRANGE for another number of the body, or a rigid body.
*/
PETSC_INTERN PetscErrorCode SamElasticityCreateStress(SamElasticity elasticity, PetscInt body,
                                                      const SamFourierSettings *settings, SamStress *stress);

/*
  SamElasticityGetSymmetric - returns, borrowed, the bodies with a symmetric normal operator that solvers of normal
  problems need: these bodies, or, with the trait skewed, others on the same grid. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityGetSymmetric(SamElasticity elasticity, SamElasticity *symmetric);
/* SamElasticityKeyword - returns the type that -elasticity names, whatever is added to it. Not collective. */
PETSC_INTERN SamElasticityType SamElasticityKeyword(SamElasticity elasticity);
/* SamElasticityRemembers - returns true if the bodies move by what they remember of earlier steps, so that their
   strains are not those of elastic ones. Not collective. */
PETSC_INTERN PetscBool SamElasticityRemembers(SamElasticity elasticity);

#endif

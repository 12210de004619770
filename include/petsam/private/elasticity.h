/* Elasticity: what the library's other rooms use besides petsam/elasticity.h. */
#ifndef PETSAM_PRIVATE_ELASTICITY_H
#define PETSAM_PRIVATE_ELASTICITY_H

#include <petsam/elasticity.h>
#include <petsam/private/grid.h>

/*
  SamElasticityAddCompliances - replaces the bodies by finite ones, whose compliances the files of -body1_compliance and
  -body2_compliance add (elasticity/compliance/); without these options does nothing. Collective. Errors: SAM_ERR_USER,
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamElasticityAddCompliances(SamElasticity *elasticity, const SamOptions *from);
/* SamElasticityGetTypes - the registered types as a text: a, b or c. Not collective. */
PETSC_INTERN PetscErrorCode SamElasticityGetTypes(char types[], size_t size);
PETSC_INTERN PetscErrorCode SamElasticityReference(SamElasticity elasticity);
/*
  SamElasticityPlaneFromOptions - whether -elasticity names a plane type, for the grid. Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityPlaneFromOptions(const SamOptions *from, PetscBool *plane);
/*
  SamElasticityAddParameters - appends what defines the bodies, by the names of its options: elastic constants, type,
  and what the type adds. Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityAddParameters(SamElasticity elasticity, SamParameters *parameters);
/*
  SamElasticityGetCoarse - the operator on the next coarser grid, and the transfer to it; both borrowed, NULL when the
  grid is too small to be halved (fewer than 32 cells in a direction, but for one row). Made at the first call.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityGetCoarse(SamElasticity elasticity, SamElasticity *coarse,
                                                   SamTransfer *transfer);
/*
  SamElasticityTrim - frees the transforms' memory if it is large, until the next product. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityTrim(SamElasticity elasticity);
/*
  The operator on a part of the grid; all collective, the window and the operator borrowed until another part is chosen,
  NULL without one. One part is in use at a time. The one in use before is kept, so that reuse costs
  nothing.
  SamElasticityChoosePart - takes a part into use that holds the n[0] * n[1] cells from first[0], first[1] on and some
  more about them; none where it would be hardly smaller than the grid, or the type has no parts. `keep`: the part in
  use stays if it holds these cells and is not much too large.
  SamElasticitySetPart - takes exactly these cells; n = 0: none.
  SamElasticityGetPartPlace - the cells of the part in use, n = 0 for none. Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityChoosePart(SamElasticity elasticity, const PetscInt first[2],
                                                    const PetscInt n[2], PetscBool keep, SamWindow *window,
                                                    SamElasticity *part);
PETSC_INTERN PetscErrorCode SamElasticitySetPart(SamElasticity elasticity, const PetscInt first[2],
                                                 const PetscInt n[2]);
PETSC_INTERN PetscErrorCode SamElasticityGetPartPlace(SamElasticity elasticity, PetscInt first[2], PetscInt n[2]);
/*
  The same in single precision: arrays of this rank's cells, two components one after the other; `factor` times the
  product. For directions and corrections, whose product is small against what it is added to. Scale so that input and
  result are of the order of one: floats end at 1e-38. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityApplyNormalSingle(SamElasticity elasticity, double factor, const float p[],
                                                           float u_z[]);
PETSC_INTERN PetscErrorCode SamElasticityApplyTangentialSingle(SamElasticity elasticity, double factor, const float q[],
                                                               float u_t[]);
/*
  Approximate inverses, symmetric positive definite. For half-spaces: |k| for the normal part and |k| (I + nu/(1 - nu)
  kk'/|k|^2) for the tangential one, k being the wave vector on the grid made periodic; the mean gets half the gain of
  the longest wave. For periodic bodies the same is the inverse itself but for the mean. Computed in single precision;
  `factor` times the result in the functions of float arrays, which see above. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityPreconditionNormalSingle(SamElasticity elasticity, double factor,
                                                                  const float residual[], float p[]);
PETSC_INTERN PetscErrorCode SamElasticityPreconditionTangentialSingle(SamElasticity elasticity, double factor,
                                                                      const float residual[], float q[]);
/*
  For the tangential part of bodies that roll where they slip, A being the operator of
  SamElasticityCreateRolling(): of h A + 1 - h, h = SAM_SLIP_WEIGHT, before the sweep along x (halfspace.c). Collective.
*/
#define SAM_SLIP_WEIGHT 0.5
PETSC_INTERN PetscErrorCode SamElasticityPreconditionSlipSingle(SamElasticity elasticity, double factor,
                                                                const float residual[], float q[]);

#endif

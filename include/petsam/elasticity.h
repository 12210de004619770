/* The influence of surface tractions on surface displacements, and its approximate inverse. */
#ifndef PETSAM_ELASTICITY_H
#define PETSAM_ELASTICITY_H

#include <petsam/control.h>
#include <petsam/fourier.h>
#include <petsam/body.h>
#include <petsam/parameters.h>

/*
  SamElasticity - the 3 x 3 influence operator of a pair of bodies on a grid: it gives relative elastic displacements u
  (m) from tractions with one value per cell (Pa). Pressure p acts on both bodies, shear q on body 2 (and -q on body 1).
  u_z is the sum of both bodies' inward displacements, (u_x, u_y) = displacement of body 2 minus that of body 1, so that
  the operator is symmetric and a force on body 1 drags u along.
  Its type is the kind of bodies. The object also holds the coarser operators of the nested grids, and those
  on parts of the grid; they are of the same type.
*/
typedef struct _n_SamElasticity *SamElasticity;

/* SamMotion - how the bodies move over each other in a load step (private/motionimpl.h). */
typedef const struct _n_SamMotion *SamMotion;

typedef const char *SamElasticityType;
#define SAM_ELASTICITY_HALFSPACE "halfspace" /* two half-spaces; tractions are constant on each cell */
#define SAM_ELASTICITY_PERIODIC \
  "periodic" /* two half-spaces whose contact is periodic with the grid; tractions are sums of waves */
#define SAM_ELASTICITY_PLANE          "plane" /* half-spaces in plane strain, on a grid of one row; forces per metre */
#define SAM_ELASTICITY_PLANE_PERIODIC "plane_periodic" /* periodic in plane strain */

#define SAM_ELASTICITY_COMPLIANCE \
  "compliance" /* half-spaces plus the compliance of finite bodies: SamElasticityAddCompliances() */

/* SamElasticityTraits - properties of a type that users of the operator rely on. They are independent of each other. */
typedef struct {
  PetscBool coupled;  /* pressure moves the surfaces tangentially, and shear moves them normally */
  PetscBool periodic; /* cells at opposite borders of the grid are neighbours; else contact at a border is cut off */
  PetscBool stretch;  /* the bodies may be stretched uniformly */
  PetscBool rotations[3]; /* about x, y, z: a rigid rotation is possible, and a moment defined */
  PetscBool mean;   /* a uniform traction displaces the surface; false: displacements are relative to the mean planes */
  PetscBool plane;  /* plane strain: the grid has one row */
  PetscBool parts;  /* if only a part of the grid has traction, an operator on that part suffices */
  PetscBool upwind; /* the tangential operator takes differences along x: not symmetric, it reaches one cell behind */
  PetscBool layers; /* the bodies may have layers */
  PetscBool patch;  /* the bodies are fixed in space, and do not roll */
  PetscInt  outside[2][2]; /* columns and rows at the low and high end of x, y that lie outside of the patches */
  PetscBool stress;        /* stresses in the bodies are available; set by the class */
} SamElasticityTraits;

/*
  SamElasticityCreate - creates an elasticity of type halfspace, or of type plane on a grid of one row; it references
  the pair and the grid. The kernels for products are computed at their first use. Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityCreate(SamGrid grid, SamPair pair, SamElasticity *elasticity);
/*
  SamElasticitySetType - sets the type, and discards the coarser operators and the parts. Collective. Errors:
  PETSC_ERR_ARG_OUTOFRANGE for a type that is not registered; PETSC_ERR_ORDER if a problem or a solver already
  references the elasticity.
*/
PETSC_EXTERN PetscErrorCode    SamElasticitySetType(SamElasticity elasticity, SamElasticityType type);
PETSC_EXTERN SamElasticityType SamElasticityGetType(SamElasticity elasticity); /* borrowed */
/*
  SamElasticityRegister - adds a type; `create` sets an object's methods and traits, see private/elasticityimpl.h. Not
  collective, but to be called on all ranks.
*/
PETSC_EXTERN PetscErrorCode SamElasticityRegister(const char name[], PetscErrorCode (*create)(SamElasticity));
/* SamElasticitySetOptionsPrefix - sets the prefix of the names of options; NULL: none. Not collective. */
PETSC_EXTERN PetscErrorCode SamElasticitySetOptionsPrefix(SamElasticity elasticity, const char prefix[]);
/*
  SamElasticitySetFromOptions - reads -elasticity (type), -fft_effort, -fft_exchange, and the options of the type.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetFromOptions(SamElasticity elasticity);
/*
  SamElasticitySetUp - prepares the operator; products call it themselves, and calling it again does nothing.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetUp(SamElasticity elasticity);
PETSC_EXTERN PetscErrorCode SamElasticityDestroy(SamElasticity *elasticity);

PETSC_EXTERN SamGrid             SamElasticityGetGrid(SamElasticity elasticity); /* borrowed */
PETSC_EXTERN SamPair             SamElasticityGetPair(SamElasticity elasticity); /* borrowed */
PETSC_EXTERN SamElasticityTraits SamElasticityGetTraits(SamElasticity elasticity);
/*
  SamElasticityCreateFromParameters - creates the bodies that the parameters of a run describe, on a grid. `source`
  names the file of the parameters in messages. Collective. Errors: SAM_ERR_FILE for a type that is not registered, and
  for parameters that are missing or invalid.
*/
PETSC_EXTERN PetscErrorCode SamElasticityCreateFromParameters(SamGrid grid, const SamParameters *parameters,
                                                              const char source[], SamElasticity *elasticity);

/*
  The products with the operator. Fields p, u_z have one component; q, u_t have two. Input and output may be the same
  vector. All are collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormal(SamElasticity elasticity, Vec p, Vec u_z);     /* u_z from p */
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangential(SamElasticity elasticity, Vec q, Vec u_t); /* u_t from q */
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormalToTangential(SamElasticity elasticity, Vec p,
                                                                 Vec u_t); /* u_t from p */
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangentialToNormal(SamElasticity elasticity, Vec q,
                                                                 Vec u_z); /* u_z from q */

/*
  SamElasticityGetSelfInfluence - computes the displacement of the centre of a cell under unit traction on that cell
  alone, m/Pa: u_z from p, and the larger of u_x from q_x and u_y from q_y. Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityGetSelfInfluence(SamElasticity elasticity, PetscReal *normal,
                                                          PetscReal *tangential);

/*
  SamElasticityCreateStress - creates an object that computes the stresses in body 1 or 2 under tractions on the grid
  (stress.h). `settings`: those of the transforms, NULL: the elasticity's. Collective. Errors: PETSC_ERR_SUP without the
  trait `stress`; PETSC_ERR_ARG_OUTOFRANGE for another number of the body, or a rigid body.
*/
typedef struct _n_SamStress *SamStress;
PETSC_INTERN PetscErrorCode  SamElasticityCreateStress(SamElasticity elasticity, PetscInt body,
                                                       const SamFourierSettings *settings, SamStress *stress);

#endif

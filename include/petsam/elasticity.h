/* The influence of surface tractions on surface displacements, and its approximate inverse. */
#ifndef PETSAM_ELASTICITY_H
#define PETSAM_ELASTICITY_H

#include <petsam/control.h>
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

#define SAM_ELASTICITY_COMPLIANCE "compliance" /* half-spaces plus the compliance of finite bodies: -body1_compliance */

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
  PetscBool skewed; /* the normal operator is not symmetric, as material that creeps streams through the contact */
  PetscBool slides; /* the surfaces slide in a steady state, which is solved without friction */
  PetscBool layers; /* the bodies may have layers */
  PetscBool patch;  /* the bodies are fixed in space, and do not roll */
  PetscInt  outside[2][2]; /* columns and rows at the low and high end of x, y that lie outside of the patches */
  PetscBool stress;        /* stresses in the bodies are available; set by the class */
  PetscReal datum; /* m: distance, by default, of the points that displacements in plane strain are relative to; 0: they
                      do not depend on it, or it is given */
} SamElasticityTraits;

/*
  SamElasticityCreate - creates an elasticity of type halfspace, or of type plane on a grid of one row.

  Collective.

  In:     grid       - the grid; referenced
          pair       - the bodies; referenced
  Out:    elasticity - the elasticity

  Errors: none of its own.

  The kernels for products are computed at their first use.

  See also: SamGridCreate(), SamPairCreate(), SamElasticitySetType(), SamElasticityDestroy().
*/
PETSC_EXTERN PetscErrorCode SamElasticityCreate(SamGrid grid, SamPair pair, SamElasticity *elasticity);

/*
  SamElasticitySetType - sets the type, and discards the coarser operators and the parts.

  Collective.

  In:     elasticity - the elasticity
          type       - name of a registered type

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a type that is not registered; PETSC_ERR_ORDER if a problem or a solver already
  references the elasticity.

  The option -elasticity sets the type, too.

  See also: SamElasticityGetType(), SamElasticityRegister(), SamElasticitySetFromOptions().
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetType(SamElasticity elasticity, SamElasticityType type);

/*
  SamElasticityGetType - returns the type, borrowed.

  Not collective.

  In:     elasticity - the elasticity

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamElasticityType SamElasticityGetType(SamElasticity elasticity);

/*
  SamElasticityRegister - adds a type of elasticity, or replaces the one of that name.

  Not collective, but to be called on all ranks.

  In:     name   - name of the type
          create - function that sets an object's methods and traits, see private/elasticityimpl.h

  Errors: none of its own.

  See also: SamElasticitySetType(), SamOptionsPlugins().
*/
PETSC_EXTERN PetscErrorCode SamElasticityRegister(const char name[], PetscErrorCode (*create)(SamElasticity));

/*
  SamElasticitySetOptionsPrefix - sets the prefix of the names of options.

  Not collective.

  In:     elasticity - the elasticity
          prefix     - the prefix, without dash; copied; NULL: none

  Errors: PETSC_ERR_ARG_SIZ for a prefix that is too long.

  See also: SamElasticitySetFromOptions().
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetOptionsPrefix(SamElasticity elasticity, const char prefix[]);

/*
  SamElasticitySetFromOptions - reads the type, the settings of the transforms, and the options of the type.

  Collective.

  In:     elasticity - the elasticity

  Options: -elasticity (type), -fft_effort, -fft_exchange, and those of the type.
  Errors: SAM_ERR_USER for a wrong value, or layers that the type does not support.

  See also: SamElasticitySetOptionsPrefix(), SamElasticitySetType(), SamElasticitySetUp().
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetFromOptions(SamElasticity elasticity);

/*
  SamElasticitySetUp - prepares the operator.

  Collective.

  In:     elasticity - the elasticity

  Errors: PETSC_ERR_ARG_SIZ for a plane type on a grid of several rows, or another type on a grid of one row.

  Products call it themselves, and calling it again does nothing.

  See also: SamElasticitySetFromOptions(), SamElasticityApplyNormal().
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetUp(SamElasticity elasticity);

/*
  SamElasticityDestroy - drops a reference of the elasticity, the last one frees it; sets the handle to NULL.

  Collective.

  In,out: elasticity - the elasticity; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamElasticityDestroy(SamElasticity *elasticity);

/*
  SamElasticityGetGrid - returns the grid, borrowed.

  Not collective.

  In:     elasticity - the elasticity

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamGrid SamElasticityGetGrid(SamElasticity elasticity);

/*
  SamElasticityGetTraits - returns the properties of the type.

  Not collective.

  In:     elasticity - the elasticity

  Errors: none; it returns no error code.

  See also: SamElasticityGetType().
*/
PETSC_EXTERN SamElasticityTraits SamElasticityGetTraits(SamElasticity elasticity);

/*
  SamElasticityApplyNormal - applies the operator: computes the normal displacement that the pressure causes.

  Collective.

  In:     elasticity - the elasticity
          p          - pressure (Pa), one component
  Out:    u_z        - normal displacement (m), one component; it may be the same vector as p

  Errors: PETSC_ERR_SUP if the type has no such product; those of SamElasticitySetUp().

  See also: SamElasticityApplyTangential(), SamElasticityApplyNormalToTangential(), SamGridCreateVec().
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormal(SamElasticity elasticity, Vec p, Vec u_z);

/*
  SamElasticityApplyTangential - applies the operator: computes the tangential displacement that the shear causes.

  Collective.

  In:     elasticity - the elasticity
          q          - shear (Pa), two components
  Out:    u_t        - tangential displacement (m), two components; it may be the same vector as q

  Errors: PETSC_ERR_SUP if the type has no such product; those of SamElasticitySetUp().

  See also: SamElasticityApplyNormal(), SamElasticityApplyTangentialToNormal().
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangential(SamElasticity elasticity, Vec q, Vec u_t);

/*
  SamElasticityApplyNormalToTangential - applies the operator: computes the tangential displacement that the pressure
  causes.

  Collective.

  In:     elasticity - the elasticity
          p          - pressure (Pa); of a vector of two components the first is taken
  Out:    u_t        - tangential displacement (m), two components; it may be the same vector as p

  Errors: PETSC_ERR_SUP if the type has no such product; those of SamElasticitySetUp().

  See also: SamElasticityApplyTangentialToNormal(), SamElasticityGetTraits().
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormalToTangential(SamElasticity elasticity, Vec p, Vec u_t);

/*
  SamElasticityApplyTangentialToNormal - applies the operator: computes the normal displacement that the shear causes.

  Collective.

  In:     elasticity - the elasticity
          q          - shear (Pa), two components
  Out:    u_z        - normal displacement (m), one component; it may be the same vector as q

  Errors: PETSC_ERR_SUP if the type has no such product; those of SamElasticitySetUp().

  See also: SamElasticityApplyNormalToTangential(), SamElasticityGetTraits().
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangentialToNormal(SamElasticity elasticity, Vec q, Vec u_z);

/*
  SamElasticityGetSelfInfluence - computes the displacement of the centre of a cell under unit traction on that cell
  alone.

  Collective.

  In:     elasticity - the elasticity
  Out:    normal     - u_z from p (m/Pa); NULL: not wanted
          tangential - the larger of u_x from q_x and u_y from q_y (m/Pa); NULL: not wanted

  Errors: those of SamElasticitySetUp().

  See also: SamElasticityApplyNormal(), SamElasticityApplyTangential().
*/
PETSC_EXTERN PetscErrorCode SamElasticityGetSelfInfluence(SamElasticity elasticity, PetscReal *normal,
                                                          PetscReal *tangential);

#endif

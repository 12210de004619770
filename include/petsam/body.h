/* The two bodies of a contact, and their elastic constants. */
#ifndef PETSAM_BODY_H
#define PETSAM_BODY_H

#include <petsam/parameters.h>

/* SamMaterial - the material of a body between two depths. */
typedef struct {
  PetscReal young, poisson; /* Pa, infinite: rigid; 1 */
  PetscReal thickness;      /* m; ignored for the last material of a body, which has no lower end */
} SamMaterial;

/*
  SamBody - a half-space of one material, or of several layers bonded to each other, listed from the surface down. Only
  the last material may be rigid.
*/
#define SAM_MATERIALS 65 /* maximum number of materials of a body */
typedef struct _n_SamBody *SamBody;

/*
  SamBodyCreate - creates a body from its materials.

  Not collective.

  In:     count     - number of materials, 1 to SAM_MATERIALS
          materials - the materials from the surface down; copied
  Out:    body      - the body

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a number of materials out of range, a modulus that is not positive, a ratio
  outside (-1, 0.5], a rigid material above another one, or a thickness that is not positive.

  See also: SamBodyDestroy(), SamPairCreate().
*/
PETSC_EXTERN PetscErrorCode SamBodyCreate(PetscInt count, const SamMaterial materials[], SamBody *body);

/*
  SamBodyDestroy - drops a reference of the body, the last one frees it; sets the handle to NULL.

  Not collective.

  In,out: body - the body; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamBodyDestroy(SamBody *body);

/*
  SamPair - two bodies, at least one of them elastic, with or without an elastic film between them that shear deforms.
  It is freed with its last reference.
*/
typedef struct _n_SamPair *SamPair;

/*
  SamPairCreate - creates a pair of bodies, which references the bodies.

  Not collective.

  In:     body1 - the upper body
          body2 - the lower body
  Out:    pair  - the pair

  Errors: PETSC_ERR_ARG_OUTOFRANGE for two rigid bodies.

  See also: SamPairDestroy(), SamBodyCreate(), SamElasticityCreate().
*/
PETSC_EXTERN PetscErrorCode SamPairCreate(SamBody body1, SamBody body2, SamPair *pair);

/*
  SamPairDestroy - drops a reference of the pair, the last one frees it; sets the handle to NULL.

  Not collective.

  In,out: pair - the pair; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamPairDestroy(SamPair *pair);

#endif

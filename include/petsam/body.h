/* The two bodies of a contact, and their elastic constants. */
#ifndef PETSAM_BODY_H
#define PETSAM_BODY_H

#include <petsam/parameters.h>

/* SamMaterial - the constants between two depths of a body. */
typedef struct {
  PetscReal young, poisson; /* Pa, infinite: rigid; 1 */
  PetscReal thickness;      /* m; that of the last material of a body does not count: it has no end */
  PetscReal stress[2];      /* residual stress xx and yy, Pa */
} SamMaterial;

/*
  SamBody - a half-space of materials that are bonded to each other: one, or several from the surface down, of which
  only the last one may be rigid.
*/
#define SAM_MATERIALS 65 /* most of a body */
typedef struct _n_SamBody *SamBody;
/*
  SamBodyCreate - from its materials, which it copies. Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a number of
  materials out of range, a modulus that is not positive, a ratio outside (-1, 0.5], a rigid material above another one,
  or a thickness that is not positive.
*/
PETSC_EXTERN PetscErrorCode SamBodyCreate(PetscInt count, const SamMaterial materials[], SamBody *body);
PETSC_INTERN PetscErrorCode SamBodyReference(SamBody body);
PETSC_EXTERN PetscErrorCode SamBodyDestroy(SamBody *body);
/*
  SamBodyCount - the number of materials.
  SamBodyAt - the number of the material at a depth (m), counted from 0 at the surface. An interface belongs to the one
  above it.
  SamBodyMaterialAt - that material; borrowed.
  SamBodyTop - the depth (m) at which the n-th material begins; n = SamBodyCount(): infinite.
  SamBodySubstrate - the last material; borrowed.
  SamBodyIsRigid - whether all of the body is.
  None is collective.
*/
PETSC_INTERN PetscInt           SamBodyCount(SamBody body);
PETSC_INTERN PetscInt           SamBodyAt(SamBody body, PetscReal depth);
PETSC_INTERN const SamMaterial *SamBodyMaterialAt(SamBody body, PetscReal depth);
PETSC_INTERN PetscReal          SamBodyTop(SamBody body, PetscInt n);
PETSC_INTERN const SamMaterial *SamBodySubstrate(SamBody body);
PETSC_INTERN PetscBool          SamBodyIsRigid(SamBody body);
/*
  SamBodyAdvise - a text for the user where the materials do not suit cells of this size and a contact of this width
  (m), the k-th one, k = 0 or 1; empty: none. `option`: the option that mends it, without dash; empty: none. `number`:
  of the body, 1 or 2. Not collective.
  SamBodyAdviseWorn - the same of a body worn to this depth (m); empty while its first material lasts.
*/
PETSC_INTERN PetscErrorCode SamBodyAdvise(SamBody body, PetscInt number, PetscInt k, PetscReal cell, PetscReal width,
                                          const char **option, char text[], size_t size);
PETSC_INTERN PetscErrorCode SamBodyAdviseWorn(SamBody body, PetscInt number, PetscReal depth, char text[], size_t size);

/*
  SamPair - two bodies, at least one of them elastic, and a film between them that shear displaces, or none. Lives as
  long as one refers to it.
*/
typedef struct _n_SamPair *SamPair;
/* SamPairCreate - references the bodies. Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for two rigid ones. */
PETSC_EXTERN PetscErrorCode SamPairCreate(SamBody body1, SamBody body2, SamPair *pair);
PETSC_INTERN PetscErrorCode SamPairReference(SamPair pair);
PETSC_EXTERN PetscErrorCode SamPairDestroy(SamPair *pair);
/*
  SamPairBody - body 1 or 2 for 0 or 1; borrowed.
  SamPairModulus - E* (Pa) of the materials at the surfaces.
  SamPairIsUniform - whether each of the bodies is of one material.
  SamPairCoupling - the largest ratio of normal displacement by shear to that by pressure, of waves with numbers from
  `first` to `last` (1/m): Dundurs' beta of uniform bodies.
  None is collective.
*/
PETSC_INTERN SamBody   SamPairBody(SamPair pair, PetscInt body);
PETSC_INTERN PetscReal SamPairModulus(SamPair pair);
PETSC_INTERN PetscBool SamPairIsUniform(SamPair pair);
PETSC_INTERN double    SamPairCoupling(SamPair pair, double first, double last);
/*
  SamPairCreateFromOptions - from -body1_young, -body1_poisson, -body1_layer_young, -body1_layer_poisson,
  -body1_layer_thickness, -body1_layer_stress, -body1_layer_file, those of body 2, and the film's -film_thickness and
  -film_shear. Collective. Errors: SAM_ERR_USER, as SamBodyCreate() and SamPairCreate(), and for an option that is
  missing, or lists of different lengths.
  SamPairAddParameters - appends the constants by the names of these options. Not collective.
  SamPairCreateFromParameters - from such a record; `source` names it in messages. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamPairCreateFromOptions(const SamOptions *from, SamPair *pair);
PETSC_INTERN PetscErrorCode SamPairAddParameters(SamPair pair, SamParameters *parameters);
PETSC_INTERN PetscErrorCode SamPairCreateFromParameters(MPI_Comm comm, const SamParameters *parameters,
                                                        const char source[], SamPair *pair);

#endif

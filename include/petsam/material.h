/* Elastic constants of a pair of bodies. */
#ifndef PETSAM_MATERIAL_H
#define PETSAM_MATERIAL_H

#include <petsam/parameters.h>

/*
  SamLayers - bonded layers on a body, from the surface down.
*/
#define SAM_LAYERS 64 /* most on a body */
typedef struct {
  PetscInt  count;                                                         /* 0: none */
  PetscReal young[SAM_LAYERS], poisson[SAM_LAYERS], thickness[SAM_LAYERS]; /* Pa, finite; 1; m */
  PetscReal stress[SAM_LAYERS][2];                                         /* residual stress xx and yy, Pa */
} SamLayers;
/* SamLayersDepth - the depth (m) of the bottom of the n-th layer; 0 for n = 0. Not collective. */
PETSC_INTERN PetscReal SamLayersDepth(const SamLayers *layers, PetscInt n);
/* SamLayersAt - the layer at a depth (m), an interface being of the one above; count: the substrate. Not collective. */
PETSC_INTERN PetscInt SamLayersAt(const SamLayers *layers, PetscReal depth);

/*
  SamPair - the elastic constants of two isotropic bodies, and the sums of them that the displacements of their surfaces
  depend on (relative displacements: elasticity.h). At a distance r on two half-spaces a unit force gives
    u_z from p:   normal / r
    u_x from q_x: shear / r + shear_xx x^2 / r^3,   u_y from q_x: shear_xx x y / r^3
    u_x from p:   coupling x / r^2,                 u_z from q_x: -coupling x / r^2
  (Johnson 1985, Contact Mechanics, sections 3.2 and 3.6). On layered bodies this is the limit for small r: the sums are
  those of the materials at the surfaces.
*/
typedef struct {
  PetscReal young[2]; /* Pa; infinite: rigid; of the substrate below layers */
  PetscReal poisson[2];
  PetscReal normal;   /* sum (1 - nu)/(2 pi G), 1/Pa */
  PetscReal shear;    /* the same */
  PetscReal shear_xx; /* sum nu/(2 pi G), 1/Pa */
  PetscReal coupling; /* [(1 - 2 nu1)/G1 - (1 - 2 nu2)/G2]/(4 pi), 1/Pa */
  PetscReal modulus;  /* E* = 1/(pi normal), Pa */
  PetscReal dundurs;  /* Dundurs' beta = coupling/normal */
  SamLayers layers[2];
  PetscReal film[2]; /* thickness (m) and shear modulus (Pa) of a film between the surfaces; 0: none */
} SamPair;
/* SamPairFilm - what a unit of shear displaces the surfaces by in the film, m/Pa. Not collective. */
PETSC_INTERN PetscReal SamPairFilm(const SamPair *pair);

/*
  SamPairSet - fills a pair from Young's moduli (Pa, infinity for rigid) and Poisson's ratios, without a film.
  Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a modulus that is not positive, a ratio outside (-1, 0.5], or two
  rigid bodies.
*/
PETSC_EXTERN PetscErrorCode SamPairSet(SamPair *pair, const PetscReal young[2], const PetscReal poisson[2]);
/*
  SamPairSetLayered - the same of bodies with layers; a rigid body with layers is elastic. Not collective. Errors: as
  SamPairSet(), and for a layer that is rigid or whose thickness is not positive, or too many.
  SamPairHasLayers - whether a body has any. Not collective.
  SamPairCoupling - the largest ratio of normal displacement by shear to that by pressure, of waves with numbers from
  `first` to `last` (1/m): Dundurs' beta without layers. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamPairSetLayered(SamPair *pair, const PetscReal young[2], const PetscReal poisson[2],
                                              const SamLayers layers[2]);
PETSC_INTERN PetscBool      SamPairHasLayers(const SamPair *pair);
PETSC_INTERN double         SamPairCoupling(const SamPair *pair, double first, double last);
/*
  SamPairSetFromOptions - from -body1_young, -body1_poisson, -body1_layer_young, -body1_layer_poisson,
  -body1_layer_thickness, -body1_layer_stress, those of body 2, and the film's -film_thickness and -film_shear.
  Collective. Errors: SAM_ERR_USER, as SamPairSetLayered(), and for an option that is missing, or lists of different
  lengths.
*/
PETSC_EXTERN PetscErrorCode SamPairSetFromOptions(SamPair *pair, const SamOptions *from);
/*
  SamPairAddParameters - appends the constants by the names of these options. Not collective.
  SamPairSetFromParameters - from such a record; `source` names it in messages. Collective.
  Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamPairAddParameters(const SamPair *pair, SamParameters *parameters);
PETSC_INTERN PetscErrorCode SamPairSetFromParameters(SamPair *pair, MPI_Comm comm, const SamParameters *parameters,
                                                     const char source[]);

#endif

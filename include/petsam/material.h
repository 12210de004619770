/* Elastic constants of a pair of bodies. */
#ifndef PETSAM_MATERIAL_H
#define PETSAM_MATERIAL_H

#include <petsam/base.h>

/*
  SamPair - two isotropic half-spaces, and what of them enters the surface displacements of the contact. Relative
  displacements are defined in compliance.h. With r the distance and the sums over both bodies, a unit force gives
    u_z from p:   normal / r
    u_x from q_x: shear / r + shear_xx x^2 / r^3,   u_y from q_x: shear_xx x y / r^3
    u_x from p:   coupling x / r^2,                 u_z from q_x: -coupling x / r^2
  (Johnson 1985, Contact Mechanics, sections 3.2 and 3.6).
*/
typedef struct {
  PetscReal young[2]; /* Pa; infinite: rigid */
  PetscReal poisson[2];
  PetscReal normal;   /* sum (1 - nu)/(2 pi G), 1/Pa */
  PetscReal shear;    /* the same */
  PetscReal shear_xx; /* sum nu/(2 pi G), 1/Pa */
  PetscReal coupling; /* [(1 - 2 nu1)/G1 - (1 - 2 nu2)/G2]/(4 pi), 1/Pa */
  PetscReal modulus;  /* E* = 1/(pi normal), Pa */
  PetscReal dundurs;  /* Dundurs' beta = coupling/normal */
} SamPair;

/*
  SamPairSet - fills a pair from Young's moduli (Pa, infinity for rigid) and Poisson's ratios.
  Errors: SAM_ERR_USER for a modulus that is not positive, a ratio outside (-1, 0.5], or two rigid bodies.
*/
PETSC_EXTERN PetscErrorCode SamPairSet(SamPair *pair, const PetscReal young[2], const PetscReal poisson[2]);
/* SamPairSetFromOptions - from -body1_young, -body1_poisson, -body2_young, -body2_poisson. Collective. */
PETSC_EXTERN PetscErrorCode SamPairSetFromOptions(SamPair *pair, const SamOptions *from);

#endif

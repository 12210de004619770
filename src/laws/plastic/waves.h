/* Waves of stress in a half-space, by eigenstrains in layers and by tractions. */
#ifndef PETSAM_PLASTIC_WAVES_H
#define PETSAM_PLASTIC_WAVES_H

#include "plasticimpl.h"
#include <complex.h>

/* SamWaveBody - a half-space, and its layers from the surface down. */
typedef struct {
  PetscInt         layers;
  const PetscReal *thickness;      /* m */
  double           shear, poisson; /* Pa, 1 */
} SamWaveBody;

/*
  SamWavesApply - the amplitudes of n waves with the numbers kx and ky[m] (1/m): `planes`, PARTS for each layer, those
  of the eigenstrain on entry, become those of the mean stress over the layers if `stress`; `u` (NULL: not wanted) those
  of the displacement of the surface. Of the mean, k = 0, the strains along the surface are 0.
  SamWavesLoad - the stress by tractions p, q_x, q_y. Neither is collective.
*/
PETSC_INTERN PetscErrorCode SamWavesApply(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                                          double complex *const planes[], PetscBool stress, double complex *const u[3]);
PETSC_INTERN PetscErrorCode SamWavesLoad(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                                         const double complex *const traction[3], double complex *const planes[]);

#endif

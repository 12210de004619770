/* Waves of stress in a half-space, by eigenstrains in layers and by tractions. */
#ifndef PETSAM_STRAINWAVES_H
#define PETSAM_STRAINWAVES_H

#include "plasticimpl.h"
#include <complex.h>

/* SamWaveBody - a half-space, and its layers from the surface down. */
typedef struct {
  PetscInt         layers;
  const PetscReal *thickness;      /* of each layer, m */
  double           shear, poisson; /* Pa, 1 */
} SamWaveBody;

/*
  SamWaveHold - the stiffness of what is bonded to the surface of the half-space, for each wave: a displacement u of the
  free surface causes the tractions p = -(pp u_z - i pq u_m), q_m = -(qq u_m + i pq u_z), q_t = -tt u_t between both
  (Pa/m), m being the direction of the wave and t that across it.
*/
typedef struct {
  const double *pp, *pq, *qq, *tt;
} SamWaveHold;

/*
  SamWavesApply - computes the response of n waves with the wave numbers kx and ky[m] (1/m). `planes`: amplitudes of the
  eigenstrain, PARTS for each layer; if `stress`, they become the amplitudes of the mean stress over the layers. `u`
  (NULL: not wanted): amplitudes of the displacement of the surface. For the mean, k = 0, the strains along the surface
  are 0. `hold` (NULL: the surface is free): what is bonded to it; u is then that of the free surface.
  SamWavesLoad - computes the stress by tractions p, q_x, q_y. Neither is collective.
*/
PETSC_INTERN PetscErrorCode SamWavesApply(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                                          double complex *const planes[], PetscBool stress, double complex *const u[3],
                                          const SamWaveHold *hold);
PETSC_INTERN PetscErrorCode SamWavesLoad(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                                         const double complex *const traction[3], double complex *const planes[]);

#endif

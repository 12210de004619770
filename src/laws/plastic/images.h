/* Stress in a window of eigenstrain by its periodic images. */
#ifndef PETSAM_PLASTIC_IMAGES_H
#define PETSAM_PLASTIC_IMAGES_H

#include "waves.h"

typedef struct _n_SamImages *SamImages;
/*
  SamImagesCreate - for the layers below a grid in a half-space, and images at all multiples of the period (m) but 0,
  which must be at least twice the grid's widths. Collective.
  SamImagesReduce - the sums of an eigenstrain (layers, PARTS fields) that their stress depends on, on all ranks.
  SamImagesAdd - takes the stress of the images of that eigenstrain off a stress (Pa). Both are collective.
*/
PETSC_INTERN PetscErrorCode SamImagesCreate(SamGrid grid, const PetscReal period[2], const SamWaveBody *body,
                                            SamImages *images);
PETSC_INTERN PetscErrorCode SamImagesDestroy(SamImages *images);
PETSC_INTERN PetscErrorCode SamImagesReduce(SamImages images, const double e[]);
PETSC_INTERN PetscErrorCode SamImagesAdd(SamImages images, double s[]);

/*
  SamNucleus - the stress (Pa, tension positive) at a point in a half-space by an eigenstrain at another one, times its
  volume: stress[a * PARTS + b] is component a by a unit (1 m3) of component b, which counts twice where b is a shear
  strain. `between`: x and y of the point from the eigenstrain; then the depths of both (m). Not collective.
*/
PETSC_INTERN void SamNucleus(const double between[2], double depth, double source, double shear, double poisson,
                             double stress[PARTS * PARTS]);

#endif

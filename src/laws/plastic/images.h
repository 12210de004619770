/* Stress in a window of eigenstrain by its periodic images. */
#ifndef PETSAM_PLASTIC_IMAGES_H
#define PETSAM_PLASTIC_IMAGES_H

#include "strainwaves.h"

typedef struct _n_SamImages *SamImages;
/*
  SamImagesCreate - creates the operator for the layers below a grid in a half-space, with images at all multiples of
  the period (m) except 0; the period must be at least twice the grid's widths. Collective.
  SamImagesReduce - computes the sums of an eigenstrain that determine the stress of the images, on all ranks; its
  layers of PARTS fields are `step` fields apart.
  SamImagesAdd - subtracts the stress of the images of that eigenstrain from a stress (Pa). Both are collective.
*/
PETSC_INTERN PetscErrorCode SamImagesCreate(SamGrid grid, const PetscReal period[2], const SamWaveBody *body,
                                            SamImages *images);
PETSC_INTERN PetscErrorCode SamImagesDestroy(SamImages *images);
PETSC_INTERN PetscErrorCode SamImagesReduce(SamImages images, const double e[], PetscInt step);
PETSC_INTERN PetscErrorCode SamImagesAdd(SamImages images, double s[]);

/*
  SamNucleus - computes the stress (Pa, tension positive) at a point in a half-space by an eigenstrain in a small volume
  at another point: stress[a * PARTS + b] is component a by a unit (strain times volume, 1 m3) of component b; a shear
  strain counts twice. `between`: x and y of the point relative to the eigenstrain; then the depths of both (m). Not
  collective.
*/
PETSC_INTERN void SamNucleus(const double between[2], double depth, double source, double shear, double poisson,
                             double stress[PARTS * PARTS]);

#endif

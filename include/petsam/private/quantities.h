/* The datasets of the quantities that an evaluation finds. */
#ifndef PETSAM_QUANTITIES_H
#define PETSAM_QUANTITIES_H

#include <petsam/evaluation.h>
#include <petsam/private/file.h>

/* A component of a quantity, by its name in a stress file. */
typedef struct {
  SamLabel    label;
  SamQuantity quantity;
} SamDataset;

/* SamDatasets - those of all quantities, in their order, the components of each together. */
enum { SAM_DATASETS = 33 };
PETSC_INTERN const SamDataset SamDatasets[SAM_DATASETS];
/* SamDatasetOf - the number of a quantity's first dataset. Not collective. */
PETSC_INTERN PetscInt SamDatasetOf(SamQuantity quantity);
/* SamQuantityIsOfCycle - whether a quantity is of all steps together. Not collective. */
PETSC_INTERN PetscBool SamQuantityIsOfCycle(SamQuantity quantity);

#endif

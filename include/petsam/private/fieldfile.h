/* Fields of (ny, nx) that are read from HDF5 files, and the options that name them. */
#ifndef PETSAM_FIELDFILE_H
#define PETSAM_FIELDFILE_H

#include <petsam/grid.h>

typedef struct {
  char        file[PETSC_MAX_PATH_LEN]; /* empty: none was given */
  char        dataset[PETSC_MAX_PATH_LEN];
  char        prefix[64];                   /* of the options */
  const char *file_option, *dataset_option; /* without prefix and dash */
  const char *default_dataset, *unit;
  PetscReal   least; /* values below are refused */
} SamFieldFile;

/* SamFieldFileSetFromOptions - reads the two options; the dataset alone is an error. Collective. */
PETSC_EXTERN PetscErrorCode SamFieldFileSetFromOptions(SamFieldFile *source, const SamOptions *from, const char help[]);
/*
  SamFieldFileRead - reads the dataset into a field (one component). Collective. Errors: SAM_ERR_FILE, on all ranks alike,
  for a file that cannot be read or is not HDF5, and for a dataset that is missing, of another shape than (ny, nx), not
  of numbers, or with values that are not finite or too small.
*/
PETSC_EXTERN PetscErrorCode SamFieldFileRead(const SamFieldFile *source, SamGrid grid, Vec field);

#endif

/* What the shapes and the class of gaps share. */
#ifndef PETSAM_GAPIMPL_H
#define PETSAM_GAPIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/gap.h>

#define SAM_GAP_PARAMETERS 4 /* the most that a shape may have */

/* A number that defines a shape; all are required. */
typedef struct {
  const char *name; /* of the option, without dash */
  const char *help;
  SamRange    range;
} SamGapParameter;

/* Where a field of (ny, nx) comes from, and the options that say so. */
typedef struct {
  char        file[PETSC_MAX_PATH_LEN];
  char        dataset[PETSC_MAX_PATH_LEN];
  const char *file_option, *dataset_option; /* without dash */
} SamGapSource;

struct _n_SamGap {
  /* what the user set */
  MPI_Comm     comm;
  char         type[64], prefix[64];
  PetscReal    values[SAM_GAP_PARAMETERS];
  SamGapSource source; /* of type file */
  SamGapSource rough;  /* added to any; no file: none */
  /*
    what the type sets: its parameters, and height(), the separation (m) at a point (m), a pure function; or, where
    that is not enough, methods that read options and fill a field
  */
  struct {
    PetscInt               count;
    const SamGapParameter *parameters;
    PetscReal (*height)(const PetscReal values[], PetscReal x, PetscReal y);
    PetscErrorCode (*setfromoptions)(SamGap gap);
    PetscErrorCode (*fill)(SamGap gap, SamGrid grid, Vec h);
  } ops;
  const char *names[SAM_GAP_PARAMETERS]; /* of the parameters */
};

PETSC_EXTERN PetscErrorCode SamGapCreate_Sphere(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_Ellipsoid(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_Punch(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_Flat(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_File(SamGap gap);

/*
  SamGapSourceSetFromOptions - reads the two options of a source; the dataset alone is an error. Collective.
*/
PETSC_EXTERN PetscErrorCode SamGapSourceSetFromOptions(SamGapSource *source, const SamOptions *from,
                                                       const char file_help[]);

/*
  SamGapSourceRead - reads the dataset into h (one component). Collective. Errors: SAM_ERR_FILE, on all ranks alike, for
  a file that cannot be read or is not HDF5, and for a dataset that is missing, of another shape than (ny, nx), not of
  numbers, or with values that are not finite.
*/
PETSC_EXTERN PetscErrorCode SamGapSourceRead(const SamGapSource *source, SamGrid grid, Vec h);

#endif

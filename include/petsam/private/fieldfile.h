/* Fields read from HDF5 datasets of shape (ny, nx), and the options that name file and dataset. */
#ifndef PETSAM_FIELDFILE_H
#define PETSAM_FIELDFILE_H

#include <petsam/grid.h>
#include <petsam/private/baseimpl.h>

/*
  SamFieldFile - the origin of a field. The caller sets the names of the two options, the default and the limit; the
  options set the rest.
*/
typedef struct {
  char        file[PETSC_MAX_PATH_LEN]; /* empty: none */
  char        dataset[PETSC_MAX_PATH_LEN];
  char        prefix[SAM_PREFIX];           /* prefix of the options */
  const char *file_option, *dataset_option; /* without prefix and dash */
  const char *default_dataset, *unit;
  PetscReal   least;     /* smallest allowed value */
  PetscBool   row;       /* true: a dataset of one row is a surface, in plane strain */
  PetscBool   is_length; /* true: separation or heights of one body; attributes give kind, unit and size */
} SamFieldFile;
/* SAM_FIELD_FILE_OF_LENGTHS - the values of these members for a dataset of lengths. */
#define SAM_FIELD_FILE_OF_LENGTHS \
  .default_dataset = "/height", .unit = "m unless its units say otherwise", .least = PETSC_NINFINITY, \
  .is_length = PETSC_TRUE

/*
  SamFieldFileSetFromOptions - reads the two options; `help` describes the file. Collective. Errors: SAM_ERR_USER if
  only the dataset is given.
*/
PETSC_INTERN PetscErrorCode SamFieldFileSetFromOptions(SamFieldFile *source, const SamOptions *from, const char help[]);
/*
  SamFieldFileRead - reads the dataset into a field (one component); its rows are y. Lengths are converted to a
  separation in m by the attributes of the dataset (SamLengthsRead). Collective. Errors: SAM_ERR_FILE for a file that
  cannot be read or is not HDF5, for a dataset that is missing, has another shape than (ny, nx), does not hold numbers,
  or has values that are not finite or below the limit, and for lengths with an unknown unit or quantity, or of a
  surface whose size is not the grid's.
*/
PETSC_INTERN PetscErrorCode SamFieldFileRead(const SamFieldFile *source, SamGrid grid, Vec field);
/* SamFieldFileCreate - reads it into a new field, which is NULL if no file is given, or while the help is printed. */
PETSC_INTERN PetscErrorCode SamFieldFileCreate(const SamFieldFile *source, SamGrid grid, Vec *field);
/*
  SamFieldFileGetGrid - gets the grid of a dataset of lengths: cells, full widths and centre (m) in x and y; a width
  that the file does not give is 0. Collective. Errors: SAM_ERR_FILE, as for SamFieldFileRead().
*/
PETSC_INTERN PetscErrorCode SamFieldFileGetGrid(const SamFieldFile *source, MPI_Comm comm, PetscInt n[2],
                                                PetscReal width[2], PetscReal center[2]);

#endif

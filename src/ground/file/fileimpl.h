/* The inside of files: declarations that only this folder uses. */
#ifndef PETSAM_FILEIMPL_H
#define PETSAM_FILEIMPL_H

#include <petsam/private/file.h>

#define SAM_FILE_METADATA (1 << 20) /* bytes; more than HDF5's metadata take at creation or in a step */

/* SamFileOpenAlone - opens a file to read it on this rank, without MPI-IO. Not collective. Errors: SAM_ERR_FILE. */
PETSC_INTERN PetscErrorCode SamFileOpenAlone(const char option[], const char filename[], SamFile *file);

/* SamFileRemoveLeftOvers - removes the files that MPI-IO creates beside an open file and leaves after a kill. */
PETSC_INTERN void SamFileRemoveLeftOvers(SamFile file);

/*
  SamFileRaise - raises SAM_ERR_FILE if rank 0's result of a function of disk.c is not 0.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamFileRaise(SamGrid grid, const char option[], const char filename[], int error);

/*
  SamFileCheckRoom - checks that a created file has room for so many bytes beside HDF5's metadata. Collective. Errors:
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileCheckRoom(SamFile file, double bytes);

#define SAM_CHECKPOINT_FORMAT 8 /* version of a checkpoint's contents */

/* SamSealIsOne - returns true if the first bytes of a file are a seal. Not collective. */
PETSC_INTERN PetscBool SamSealIsOne(const char head[], size_t size);

/* ---- lengths (lengths.c) ---- */

/* SamLengthsNameAxis - writes the name of the dataset `letter` beside another one. Not collective. */
PETSC_INTERN void SamLengthsNameAxis(const char dataset[], char letter, char path[PETSC_MAX_PATH_LEN]);

/* Attributes of a dataset of lengths */
typedef struct {
  double factor;    /* factor from values to a separation in m */
  double size[2];   /* full width in x and y (m); 0: not in the file */
  double center[2]; /* centre in x and y (m); 0: not in the file */
} SamLengths;
/*
  SamLengthsRead - reads the attributes of a dataset `name` of shape (ny, nx) in an examined file; each may be missing.

  Attribute units: a unit of length (m). Attribute quantity: separation (the default), or height1 or height2 for heights
  of body 1 or 2, positive outward; so a peak of either body reduces the separation. The size comes from the attribute
  size of the dataset, two numbers in m; or else from the datasets x and y beside it, which contain the nx and ny cell
  centres and must have units, otherwise they are ignored.

  Errors: SAM_ERR_FILE for an unknown unit or quantity, packed numbers, another size than two positive numbers, and an
  axis that falls along its dataset, so that the surface would be mirrored.
*/
PETSC_INTERN PetscErrorCode SamLengthsRead(SamFile file, hid_t dataset, const char name[], const hsize_t shape[2],
                                           SamLengths *lengths);

#endif

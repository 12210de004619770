/* What the files of the HDF5 results share. */
#ifndef PETSAM_HDF5IMPL_H
#define PETSAM_HDF5IMPL_H

#include "../base/baseimpl.h"
#include <petsam/output.h>
#include <hdf5.h>
#include <sys/types.h>

/* A dataset's name and what its attributes say. */
typedef struct {
  const char *name, *units, *long_name;
} SamOutputLabel;

/* A field: one component of a Vec of SamFields. */
typedef struct {
  SamOutputLabel label;
  size_t         offset;    /* of the Vec in SamFields */
  PetscInt       component;
} SamOutputField;

/* A column of the history: a number of SamStep. */
typedef enum { SAM_COLUMN_REAL, SAM_COLUMN_INT, SAM_COLUMN_STATUS } SamOutputColumnKind;
typedef struct {
  SamOutputLabel      label;
  SamOutputColumnKind kind;
  size_t              offset; /* in SamStep */
} SamOutputColumn;

#define SAM_OUTPUT_FIELDS  9
#define SAM_OUTPUT_COLUMNS 27
PETSC_INTERN const SamOutputField  SamOutputFields[SAM_OUTPUT_FIELDS];
PETSC_INTERN const SamOutputColumn SamOutputColumns[SAM_OUTPUT_COLUMNS];

/* What the options say of the file. */
typedef struct {
  PetscInt  compress; /* level of deflate */
  PetscInt  chunk[2]; /* most cells of a chunk in x, y */
  PetscBool xdmf;
} SamOutputSettings;

/* The XDMF file beside the results. */
typedef struct _n_SamXdmf *SamXdmf;

struct _n_SamOutput {
  /* what the user set */
  SamGrid           grid;
  char             *filename;
  SamOutputSettings set;
  /* what it owns; identifiers are negative where nothing is open */
  PetscMPIInt  rank;
  hid_t        file, transfer; /* transfer: collective */
  hid_t        vtk_steps; /* attribute: number of steps that VTK sees */
  SamXdmf      xdmf;      /* NULL: none */
  hid_t        time, state, fields[SAM_OUTPUT_FIELDS], columns[SAM_OUTPUT_COLUMNS];
  signed char *states; /* of this rank's cells */
  /* status */
  hsize_t     steps, saved; /* load steps in the history, steps with fields */
  PetscBool   failed;       /* on this rank, until SamOutputEnd() makes it common */
  PetscBool   broken;       /* a step could not be written: no collective call on the file may follow */
  char        reason[256];  /* of the first failure */
  H5E_auto2_t print;        /* how HDF5 reports errors outside of these functions */
  void       *print_data;
};

/*
  Calls of HDF5 stand between Begin and End. A call that fails on one rank must not keep it from the collective calls
  that the others make, so failures are only noted, and all ranks make all calls; End agrees on the outcome and raises
  SAM_ERR_FILE. Collective.
*/
PETSC_INTERN PetscErrorCode SamOutputBegin(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputEnd(SamOutput output);
/* SamOutputNote - passes on what an HDF5 call returned, and notes a failure with HDF5's reason. Not collective. */
PETSC_INTERN hid_t SamOutputNote(SamOutput output, hid_t result);

/* The following note their failures. Collective. */
PETSC_INTERN void SamOutputWriteAttribute(SamOutput output, hid_t object, const char name[], hid_t stored, hid_t type, PetscInt count, const void *values);
PETSC_INTERN void SamOutputWriteTextAttribute(SamOutput output, hid_t object, const char name[], const char text[]);
/* SamOutputCreateLayout - all datasets, without a step, and their attributes. */
PETSC_INTERN PetscErrorCode SamOutputCreateLayout(SamOutput output);
PETSC_INTERN void SamOutputCloseLayout(SamOutput output);
/* SamOutputFieldBytes - what the fields of one step take uncompressed. */
PETSC_INTERN off_t SamOutputFieldBytes(SamOutput output);
/* SamOutputCreateVTK, SamOutputCountVTK - the group VTKHDF of the file, and how many steps there are in it. */
PETSC_INTERN void SamOutputCreateVTK(SamOutput output);
PETSC_INTERN void SamOutputCountVTK(SamOutput output, hsize_t saved);

/* SamOutputRaise - raises SAM_ERR_FILE for the errno that rank 0 has; does nothing for 0. Collective. */
PETSC_INTERN PetscErrorCode SamOutputRaise(SamGrid grid, const char filename[], int error);

/*
  SamXdmfCreate - a file with no step for results of that name, replacing one there is. SamXdmfAddStep - one more, which
  has that index in the results. Collective. Errors: SAM_ERR_FILE; the object, and the file with the steps before, stay.
*/
PETSC_INTERN PetscErrorCode SamXdmfCreate(SamGrid grid, const char results[], SamXdmf *xdmf);
PETSC_INTERN PetscErrorCode SamXdmfAddStep(SamXdmf xdmf, PetscInt step, PetscReal time);
PETSC_INTERN const char    *SamXdmfGetName(SamXdmf xdmf);
PETSC_INTERN PetscErrorCode SamXdmfDestroy(SamXdmf *xdmf);

#endif

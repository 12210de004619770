/* What the files of the HDF5 results share. */
#ifndef PETSAM_HDF5IMPL_H
#define PETSAM_HDF5IMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/output.h>
#include <hdf5.h>
#include <sys/types.h>

/*
  SamFile - an HDF5 file that all ranks have open together, and what they know of its errors. Calls of HDF5 stand
  between Begin and End. A call that fails on one rank must not keep it from the collective calls that the others make,
  so failures are only noted, and all ranks make all calls; End agrees on the outcome and raises SAM_ERR_FILE with the
  option's name.
*/
typedef struct _n_SamFile *SamFile;
struct _n_SamFile {
  /* what the user set */
  SamGrid     grid;
  SamEvent    event;
  const char *option; /* that named the file, without dash */
  char       *filename;
  PetscBool   writing;
  /* what it owns; identifiers are negative where nothing is open */
  PetscMPIInt rank;
  hid_t       id, transfer; /* transfer: collective */
  /* status */
  PetscBool   failed;      /* on this rank, until SamFileEnd() or SamFileAgree() makes it common */
  char        reason[256]; /* of the first failure */
  H5E_auto2_t print;       /* how HDF5 reports errors outside of these functions */
  void       *print_data;
};

#define SAM_FILE_ADMINISTRATION \
  (1 << 20) /* bytes, more than HDF5 needs for its administration at creation or for a step */

typedef enum { SAM_FILE_CREATE, SAM_FILE_CREATE_CHECKED, SAM_FILE_READ, SAM_FILE_APPEND } SamFileMode;
/*
  SamFileOpen - opens a file, or creates it in the place of one of that name; CREATE_CHECKED: with checksums over
  its administration. `option` is not copied. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileOpen(SamGrid grid, SamEvent event, const char option[], const char filename[],
                                        SamFileMode mode, SamFile *file);
/* SamFileClose - between Begin and End. SamFileDestroy - closes (unless that would hang) and frees. Collective. */
PETSC_INTERN void           SamFileClose(SamFile file);
PETSC_INTERN PetscErrorCode SamFileDestroy(SamFile *file, PetscBool close);
PETSC_INTERN PetscErrorCode SamFileBegin(SamFile file);
PETSC_INTERN PetscErrorCode SamFileEnd(SamFile file);
PETSC_INTERN PetscErrorCode SamFileAgree(SamFile file);
/* SamFileNote - passes on what an HDF5 call returned, and notes a failure with HDF5's reason. Not collective. */
PETSC_INTERN hid_t SamFileNote(SamFile file, hid_t result);

/*
  SamFileCheckName - raises SAM_ERR_FILE unless a file of the name could be written; leaves everything as it is.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamFileCheckName(SamGrid grid, const char option[], const char filename[]);
/*
  SamFileReserve - room for so many bytes and their administration, by which the file becomes longer; what is not
  needed of it, HDF5 cuts off when it flushes. Collective.
*/
PETSC_INTERN PetscErrorCode SamFileReserve(SamFile file, off_t bytes);
/*
  SamFileReplace - puts a finished file, once it is on the disk, in the place of another, of which `kept` (NULL:
  nothing) becomes the name. At every moment there is a file of the name, if there was one. Collective. Errors:
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileReplace(SamGrid grid, const char option[], const char temporary[],
                                           const char filename[], const char kept[]);
/* SamFileRaise - raises SAM_ERR_FILE for the errno that rank 0 has; does nothing for 0. Collective. */
PETSC_INTERN PetscErrorCode SamFileRaise(SamGrid grid, const char option[], const char filename[], int error);

/* The following note their failures. A text that is read is the caller's to free. Collective. */
PETSC_INTERN void SamFileWriteAttribute(SamFile file, hid_t object, const char name[], hid_t stored, hid_t type,
                                        PetscInt count, const void *values);
PETSC_INTERN void SamFileWriteTextAttribute(SamFile file, hid_t object, const char name[], const char text[]);
PETSC_INTERN void SamFileReadAttribute(SamFile file, hid_t object, const char name[], hid_t type, PetscInt count,
                                       void *values);
PETSC_INTERN void SamFileReadTextAttribute(SamFile file, hid_t object, const char name[], char **text);
/* One layer of a dataset (layers, ny, nx): each rank has its rows. */
PETSC_INTERN void SamFileWriteLayer(SamFile file, hid_t dataset, hid_t type, hsize_t layer, const void *values);
PETSC_INTERN void SamFileReadLayer(SamFile file, hid_t dataset, hid_t type, hsize_t layer, void *values);

/*
  SamParametersWrite - all parameters as attributes of the root. SamParametersDiffer - whether one that must not differ
  is another in the file; which one, and the values, are told. Both note failures. Collective.
*/
PETSC_INTERN void      SamParametersWrite(SamFile file, const SamParameters *parameters);
PETSC_INTERN PetscBool SamParametersDiffer(SamFile file, const SamParameters *parameters, char message[], size_t size);

/* A dataset's name and what its attributes say. */
typedef struct {
  const char *name, *units, *long_name;
} SamOutputLabel;

/*
  A field: `get` finds it in a vector of the contact's, or computes it in `work`, which has one component; `component`
  says which one of the former, or is handed to `get`. Its values are real numbers, or SamStates, stored as bytes.
*/
typedef enum { SAM_FIELD_REAL, SAM_FIELD_STATE } SamOutputFieldKind;
typedef struct {
  SamOutputLabel     label;
  SamOutputFieldKind kind;
  PetscErrorCode (*get)(SamContact contact, PetscInt component, Vec work, Vec *field);
  PetscInt component;
} SamOutputField;

/* A column of the history: a number of SamStep. Optional ones, which are real, are there where they vary. */
typedef enum { SAM_COLUMN_REAL, SAM_COLUMN_INT, SAM_COLUMN_STATUS, SAM_COLUMN_OPTIONAL } SamOutputColumnKind;
typedef struct {
  SamOutputLabel      label;
  SamOutputColumnKind kind;
  size_t              offset; /* in SamStep */
} SamOutputColumn;

#define SAM_OUTPUT_MOST 64 /* lines of the tables */
PETSC_INTERN const SamOutputField  SamOutputFields[];
PETSC_INTERN const PetscInt        SamOutputFieldCount;
PETSC_INTERN const SamOutputColumn SamOutputColumns[];
PETSC_INTERN const PetscInt        SamOutputColumnCount;

/* The XDMF file beside the results. */
typedef struct _n_SamXdmf *SamXdmf;

struct _n_SamOutput {
  SamFile           f;
  SamOutputSettings set;
  /* what it owns; identifiers are negative where nothing is open */
  hid_t        vtk_steps; /* attribute: number of steps that VTK sees */
  hid_t        closed;    /* attribute: whether the file has been closed after it was written to */
  SamXdmf      xdmf;      /* NULL: none */
  hid_t        time, fields[SAM_OUTPUT_MOST], columns[SAM_OUTPUT_MOST];
  signed char *states; /* of this rank's cells */
  Vec          work;   /* for fields that have to be computed; NULL until then */
  /* status */
  hsize_t   steps, saved; /* load steps in the history, steps with fields */
  PetscReal saved_time;   /* of the last step with fields */
  PetscBool unchanged;    /* only looked at */
  PetscBool copying;      /* all steps are reserved and brought to the disk together */
  PetscBool broken;       /* a step could not be written: no collective call on the file may follow */
};

/* The following note their failures. Collective. */
/* SamOutputCreateLayout - all datasets, without a step, and their attributes. */
PETSC_INTERN PetscErrorCode SamOutputCreateLayout(SamOutput output);
PETSC_INTERN void           SamOutputCloseLayout(SamOutput output);
/* SamOutputFieldBytes - what the fields of one step take uncompressed. */
PETSC_INTERN off_t SamOutputFieldBytes(SamOutput output);
/*
  SamOutputCreateVTK, SamOutputOpenVTK, SamOutputCountVTK - the group VTKHDF of the file, and how many steps there are
  in it.
*/
PETSC_INTERN void SamOutputCreateVTK(SamOutput output);
PETSC_INTERN void SamOutputOpenVTK(SamOutput output);
PETSC_INTERN void SamOutputCountVTK(SamOutput output, hsize_t saved);

/* SamOutputOpenLayout - the same datasets of a file that has them. */
PETSC_INTERN void SamOutputOpenLayout(SamOutput output);
/*
  SamOutputLength - steps in a dataset. SamOutputReadSeries - `count` numbers of a series from `first` on, on all
  ranks.
*/
PETSC_INTERN hsize_t SamOutputLength(SamOutput output, hid_t dataset);
PETSC_INTERN void    SamOutputReadSeries(SamOutput output, hid_t dataset, hid_t type, hsize_t first, hsize_t count,
                                         void *values);
/* SamOutputAllocate - an object on an open file, which it takes, with no dataset open. Collective. */
PETSC_INTERN PetscErrorCode SamOutputAllocate(SamFile file, const SamOutputSettings *set, SamOutput *output);
/*
  SamOutputAppend - the numbers of a step (NULL: none) and its fields (`values` NULL: none), and what belongs to them; then
  all of it is on its way to the disk. `values` gives this rank's values of field f, doubles or bytes. Collective.
*/
typedef PetscErrorCode (*SamOutputValues)(SamOutput output, PetscInt f, void *context, const void **values);
PETSC_INTERN PetscErrorCode SamOutputAppend(SamOutput output, const SamStep *step, PetscReal time,
                                            SamOutputValues values, void *context);

/*
  SamXdmfCreate - a file with no step for results of that name, replacing one there is. SamXdmfAddStep - one more, which
  has that index in the results. Collective. Errors: SAM_ERR_FILE; the object, and the file with the steps before, stay.
*/
PETSC_INTERN PetscErrorCode SamXdmfCreate(SamGrid grid, const char results[], SamXdmf *xdmf);
PETSC_INTERN PetscErrorCode SamXdmfAddStep(SamXdmf xdmf, PetscInt step, PetscReal time);
PETSC_INTERN const char    *SamXdmfGetName(SamXdmf xdmf);
PETSC_INTERN PetscErrorCode SamXdmfDestroy(SamXdmf *xdmf);

#endif

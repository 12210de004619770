/* Results in an HDF5 file, with the parameters of their run. */
#ifndef PETSAM_OUTPUT_H
#define PETSAM_OUTPUT_H

#include <petsam/contact.h>
#include <petsam/parameters.h>
#include <petsam/private/errors.h>
#include <petsam/private/gradient.h>

/*
  SamOutput - a results file, to which one load step at a time is appended (layout: examples/manual/RESULTS.md). Every
  dataset has the attributes `units` and `long_name`, and the dimension scales time, y, x, so that h5py and xarray
  (netcdf4) open it. For ParaView the same datasets are linked in a group VTKHDF (read by VTK from 9.3 on).
*/
typedef struct _n_SamOutput *SamOutput;

/* SamOutputSettings - the settings of a results file. */
#define SAM_OUTPUT_NAME   48                                 /* characters of a field's name */
#define SAM_OUTPUT_NEEDED "output, the file that it goes to" /* by options of the file */
typedef struct {
  char        names[SAM_STATE_MOST][SAM_OUTPUT_NAME]; /* names of the fields to be saved */
  PetscInt    count;                                  /* number of these names; negative: the default fields */
  PetscInt    compress;                               /* deflate level of the fields, 0 (none) to 9 */
  PetscInt    chunk[2];                               /* most cells of an HDF5 chunk in x, y */
  PetscBool   single;                                 /* true: fields of cells are in single precision */
  PetscBool   sums;         /* true: sums over the steps begin if `names` has them: SamOutputSettingsAddLaws() */
  PetscReal   flush;        /* longest time that steps without fields wait to be written together, s; 0: none */
  PetscReal   flush_fields; /* the same of steps with fields; they wait while each takes less than a fiftieth of it */
  SamContact  contact;      /* contact whose state gives the fields and /history; borrowed */
  SamState    cycles;       /* state whose numbers give a second series; borrowed */
  const char *cycles_name;  /* group of the second series; borrowed; NULL: none */
  double      steps;        /* load steps that the file is expected to have, */
  double      saved;        /* and how many of them with fields */
  PetscBool   errors;       /* true: errors of the numbers will be written */
  int         gradients;    /* number of the numbers whose gradients will be written */
  char      **gradient;     /* their names; borrowed */
} SamOutputSettings;
/*
  SamOutputSettingsSetFromOptions - sets the defaults (the usual fields, no compression, chunks of 1024 x 256 cells,
  double precision, each step written at once), then reads -output_fields, -output_compress, -output_chunk and
  -output_single. Collective. Errors: SAM_ERR_USER.
  SamOutputSettingsAddLaws - adds to a problem the laws that only accumulate a field, if this field is to be saved.
  Collective.
  SamOutputSettingsPrepare - sets the contact whose results are written. Collective. Errors: SAM_ERR_USER for a field
  that the contact does not offer.
*/
PETSC_EXTERN PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *settings, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamOutputSettingsAddLaws(SamOutputSettings *settings, SamProblem problem);
PETSC_EXTERN PetscErrorCode SamOutputSettingsPrepare(SamOutputSettings *settings, SamContact contact,
                                                     const SamOptions *from);

/*
  SamOutputCreate - creates the file with the coordinates of the grid and no step, under a temporary name
  (SamFileNameTemporary()). It gets its own name, and replaces older results, when it is first written, or closed. All
  ranks write together through MPI-IO. Until the object is destroyed, no other run can write the file, but others may
  read it. Collective. Errors: SAM_ERR_FILE if the file cannot be created, is being written by another run, or exists
  and is not a results file of petsam; it is then left unchanged.
*/
PETSC_EXTERN PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], const SamOutputSettings *settings,
                                            SamOutput *output);
/* SamOutputSetParameters - stores parameters as attributes of the root group. Collective. Errors: SAM_ERR_FILE. */
PETSC_EXTERN PetscErrorCode SamOutputSetParameters(SamOutput output, const SamParameters *parameters);
/*
  SamOutputSetReals, SamOutputSetText - store an attribute of the root group; a single number is stored as a scalar.
  Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamOutputSetReals(SamOutput output, const char name[], PetscInt count,
                                              const PetscReal values[]);
PETSC_INTERN PetscErrorCode SamOutputSetText(SamOutput output, const char name[], const char text[]);
/*
  SamOutputWriteStep - appends the numbers of the contact's state (SamStateReadNumbers()) to /history and, with
  `fields`, the time and the fields. The file is then complete up to this step, whatever happens later. If the settings
  allow it (`flush`), steps first wait in memory, since many are written in the time of one: for that time, which is
  checked as more steps are written, or until they fill a chunk or, with fields, 8 MB. Collective. Errors: SAM_ERR_FILE,
  also if another program has replaced the file, or changed its size, since it was written last. If the disk is full,
  nothing is written and the file can be closed. If writing fails in the middle of a step, the file cannot be closed:
  SamOutputDestroy() then leaves it open, and the program should end with MPI_Abort(), since HDF5 would try to close the
  file in MPI_Finalize().
  SamOutputFlush - writes the waiting steps. Collective. Errors: as SamOutputWriteStep().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteStep(SamOutput output, PetscBool fields);
PETSC_EXTERN PetscErrorCode SamOutputFlush(SamOutput output);
/* SamOutputWaits - returns true if steps wait to be written. Not collective. */
PETSC_INTERN PetscBool SamOutputWaits(SamOutput output);
/*
  SamOutputWriteFields - appends only the fields of a step whose numbers are already in the file; `time` (s) is that of
  the step. All else is as in SamOutputWriteStep(). Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamOutputWriteFields(SamOutput output, PetscReal time);
/*
  SamOutputWriteCycle - appends the committed numbers of the settings' `cycles` to the second series, then flushes the
  file, as SamOutputWriteStep() does. Collective. Errors: SAM_ERR_FILE; PETSC_ERR_ORDER for a file without that group.
*/
PETSC_INTERN PetscErrorCode SamOutputWriteCycle(SamOutput output);
/*
  SamOutputWriteErrors - writes all waiting steps, then the rows of a table into the group /errors: names, units,
  values, errors, their causes and factors. Collective. Errors: as SamOutputWriteStep(); PETSC_ERR_ORDER for a file
  without that group.
*/
PETSC_INTERN PetscErrorCode SamOutputWriteErrors(SamOutput output, const SamErrorTable *table);
/*
  SamOutputWriteWarnings - writes all waiting steps, then the rows of /warnings. Collective. Errors: as
  SamOutputWriteStep().
*/
#define SAM_WARNING_TEXT 640 /* most bytes of a warning in the results */
PETSC_INTERN PetscErrorCode SamOutputWriteWarnings(SamOutput output, PetscInt count,
                                                   const char texts[][SAM_WARNING_TEXT]);
/*
  SamOutputWriteGradient - writes all waiting steps, then what a gradient has found, into the settings' group
  /gradient/NAME: the wanted derivatives by gap and friction in each cell, by each step's loads, and numbers as
  attributes, and the known errors of so many shares, relative to these. Collective. Errors: as SamOutputWriteStep().
*/
PETSC_INTERN PetscErrorCode SamOutputWriteGradient(SamOutput output, SamGradient gradient, const char name[],
                                                   PetscInt count, const SamGradientShare shares[]);
/*
  SamOutputGetSaved - gets the number of load steps in the file, the number of steps with fields, and the time (s) of
  the last step with fields, -infinity if there is none; NULL for an unwanted output. Not collective.
*/
PETSC_INTERN PetscErrorCode SamOutputGetSaved(SamOutput output, PetscInt *steps, PetscInt *saved, PetscReal *time);
/*
  SamOutputPlan - creates an object without a file, for SamOutputForecast() only. Collective.
  SamOutputForecast - computes the size (bytes) that this file would have with the expected steps of the settings,
  without compression, and the space that is free where a file of that name would be. Collective.
*/
PETSC_INTERN PetscErrorCode SamOutputPlan(SamGrid grid, const SamOutputSettings *settings, SamOutput *output);
PETSC_INTERN PetscErrorCode SamOutputForecast(SamOutput output, const char filename[], double *bytes, double *space);
/* SamOutputHasReplaced - returns true if the file has replaced older results. Not collective. */
PETSC_INTERN PetscBool SamOutputHasReplaced(SamOutput output);
/*
  SamOutputDestroy - closes the file, frees the object and sets the handle to NULL, also when closing fails. Collective.
  Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputDestroy(SamOutput *output);

#endif

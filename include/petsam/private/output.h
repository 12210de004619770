/* Results in an HDF5 file, and the parameters of the run that they belong to. */
#ifndef PETSAM_OUTPUT_H
#define PETSAM_OUTPUT_H

#include <petsam/contact.h>
#include <petsam/parameters.h>

/*
  SamOutput - a results file, to which one load step at a time is appended (layout: examples/manual/RESULTS.md). Every
  dataset has the attributes `units` and `long_name`, and the dimension scales time, y, x, so that h5py and xarray
  (netcdf4) open it. For ParaView the same datasets are linked in a group VTKHDF (read by VTK from 9.3 on).
*/
typedef struct _n_SamOutput *SamOutput;

/* How a results file is written. */
#define SAM_OUTPUT_NAME 48 /* characters of a field's name */
typedef struct {
  char        names[SAM_STATE_MOST][SAM_OUTPUT_NAME]; /* fields to be saved by their names; */
  PetscInt    count;                                  /* so many; negative: those that are usual */
  PetscInt    compress;                               /* deflate level of the fields, 0 (none) to 9 */
  PetscInt    chunk[2];                               /* most cells of an HDF5 chunk in x, y */
  PetscBool   single;                                 /* fields of cells in single precision */
  PetscBool   sums;        /* sums over the steps begin where they are named: SamOutputSettingsAddLaws() */
  PetscReal   flush;       /* s that steps without fields may wait to be written together; 0: they do not */
  SamContact  contact;     /* whose state gives the fields and /history; borrowed */
  SamState    cycles;      /* whose numbers give a second series, */
  const char *cycles_name; /* this group; borrowed; NULL: none */
} SamOutputSettings;
/*
  SamOutputSettingsSetFromOptions - sets the defaults (the usual fields, no compression, chunks of 1024 x 256 cells,
  double precision, each step written at once), then reads -output_fields, -output_compress,
  -output_chunk and -output_single. Collective. Errors: SAM_ERR_USER.
  SamOutputSettingsAddLaws - adds laws to a problem that only accumulate a field which is asked for. Collective.
  SamOutputSettingsPrepare - the contact that is written. Collective. Errors: SAM_ERR_USER for a field that the contact
  does not offer.
*/
PETSC_EXTERN PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *settings, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamOutputSettingsAddLaws(SamOutputSettings *settings, SamProblem problem);
PETSC_EXTERN PetscErrorCode SamOutputSettingsPrepare(SamOutputSettings *settings, SamContact contact,
                                                     const SamOptions *from);

/*
  SamOutputCreate - creates the file with the coordinates of the grid and no step yet, under another name
  (SamFileNameTemporary()): it takes its own, and replaces older results, when it is first written, or closed. All
  ranks write together through MPI-IO. Until it is destroyed, no other run gets the file, but others may read it.
  Collective. Errors: SAM_ERR_FILE when the file cannot be created, is being written by another run, or is there and is
  not a results file of petsam; it is left unchanged then.
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
  `fields`, the time and the fields. Then the file is complete up to here, whatever happens
  later; but where the settings allow it, steps without fields wait in memory, since many are written in the time of
  one: for so long, if more steps are written, or until there is a chunk of them. Collective. Errors: SAM_ERR_FILE,
  also when another program has replaced the file, or changed its size, since it was written last. When there is no
  space, nothing is written and the file can be closed.
  When writing fails in the middle of a step it cannot: SamOutputDestroy() then leaves the file open, and the program
  should end with MPI_Abort(), since HDF5 would try to close the file in MPI_Finalize().
  SamOutputFlush - writes the steps that wait. Collective. Errors: as SamOutputWriteStep().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteStep(SamOutput output, PetscBool fields);
PETSC_EXTERN PetscErrorCode SamOutputFlush(SamOutput output);
/*
  SamOutputWriteFields - appends only the fields, of a step whose numbers are in the file already; `time` (s) is that of
  the step. Otherwise as SamOutputWriteStep(). Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamOutputWriteFields(SamOutput output, PetscReal time);
/*
  SamOutputWriteCycle - appends the committed numbers of the settings' `cycles` to the second series, then flushes, as
  SamOutputWriteStep(). Collective. Errors: SAM_ERR_FILE; PETSC_ERR_ORDER for a file without that group.
*/
PETSC_INTERN PetscErrorCode SamOutputWriteCycle(SamOutput output);
/*
  SamOutputGetSaved - the number of load steps in the file, the number of those with fields, and the time (s) of the
  last step with fields, -infinity without one; NULL for one that is not wanted. Not collective.
*/
PETSC_INTERN PetscErrorCode SamOutputGetSaved(SamOutput output, PetscInt *steps, PetscInt *saved, PetscReal *time);
/*
  SamOutputPlan - results without a file, of which only the size can be asked. Collective.
  SamOutputForecast - the size (bytes) of a file like this one of so many load steps and so many steps with fields,
  without compression. Not collective.
*/
PETSC_INTERN PetscErrorCode SamOutputPlan(SamGrid grid, const SamOutputSettings *settings, SamOutput *output);
PETSC_INTERN PetscErrorCode SamOutputForecast(SamOutput output, double steps, double saved, double *bytes);
/* SamOutputHasReplaced - whether the file has replaced older results. Not collective. */
PETSC_INTERN PetscBool SamOutputHasReplaced(SamOutput output);
/*
  SamOutputDestroy - closes the file, frees the object and sets the handle to NULL, also when closing fails. Collective.
  Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputDestroy(SamOutput *output);

#endif

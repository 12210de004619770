/* Results in an HDF5 file. */
#ifndef PETSAM_OUTPUT_H
#define PETSAM_OUTPUT_H

#include <petsam/contact.h>

/*
  SamParameters - what defines a run, by the names of its options: stored with results and checkpoints. With `fixed` a
  run that was stopped can only go on with the same value.
*/
#define SAM_PARAMETERS 48
typedef struct {
  char      name[32];
  PetscBool fixed;
  PetscInt  count; /* of values, 0: a text */
  PetscReal value[2];
  char      text[64];
} SamParameter;
typedef struct {
  PetscInt     count;
  SamParameter list[SAM_PARAMETERS];
} SamParameters;

/* Not collective. */
PETSC_EXTERN PetscErrorCode SamParametersAddReals(SamParameters *parameters, const char name[], PetscBool fixed,
                                                  PetscInt count, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode SamParametersAddText(SamParameters *parameters, const char name[], PetscBool fixed,
                                                 const char text[]);

/*
  SamOutput - a results file that grows by a load step at a time (layout: README, "Results"). Every dataset has `units`
  and `long_name`; dimension scales time, y, x are attached, so that h5py and xarray (netcdf4) open it. The same
  datasets stand in a group VTKHDF, which VTK from 9.3 on reads, and in an XDMF file beside it for older ParaViews and
  VisIt.
*/
typedef struct _n_SamOutput *SamOutput;

/* How a results file is written. */
typedef struct {
  PetscInt  compress;       /* level of deflate of the fields, 0 (none) to 9 */
  PetscInt  chunk[2];       /* most cells of a chunk of the file in x, y */
  PetscBool xdmf;           /* an XDMF file beside the results */
  PetscBool friction_scale; /* the history has a column of it */
} SamOutputSettings;
/*
  SamOutputSettingsSetFromOptions - the defaults, and -output_compress, -output_chunk, -output_xdmf. Collective. Errors:
  SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *settings, const SamOptions *from);

/*
  SamOutputCreate - creates the file, replacing one of this name, with the coordinates of the grid and no step yet. All
  ranks write together through MPI-IO. Collective. Errors: SAM_ERR_FILE when it cannot be created (an existing file of
  a name that cannot be written stays as it is).
*/
PETSC_EXTERN PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], const SamOutputSettings *settings,
                                            SamOutput *output);
/*
  SamOutputContinue - opens the results of a run that was stopped after `steps` load steps, whose times are given, to go
  on after these. A file that holds just these steps and was closed in order goes on as it is; otherwise those steps are
  first copied to a new file, which then takes its name: the old one may have been left in the middle of a step, or hold
  more. The XDMF file is made anew. Collective. Errors: SAM_ERR_FILE for a file that cannot be read or written or lacks
  some of the steps, SAM_ERR_USER when it is of other fixed parameters or times; it is left as it was then.
*/
PETSC_EXTERN PetscErrorCode SamOutputContinue(SamGrid grid, const char filename[], const SamOutputSettings *settings,
                                              const SamParameters *parameters, PetscInt steps, const PetscReal times[],
                                              SamOutput *output);
/* SamOutputSetParameters - all of them as attributes of the root. Collective. */
PETSC_EXTERN PetscErrorCode SamOutputSetParameters(SamOutput output, const SamParameters *parameters);
/* SamOutputSetReals, SamOutputSetText - attributes of the root; one number is stored as a scalar. Collective. */
PETSC_EXTERN PetscErrorCode SamOutputSetReals(SamOutput output, const char name[], PetscInt count,
                                              const PetscReal values[]);
PETSC_EXTERN PetscErrorCode SamOutputSetText(SamOutput output, const char name[], const char text[]);
/*
  SamOutputWriteStep - appends the numbers of a step to /history and, when `contact` is not NULL, its time and the fields
  of its solution (tried, else committed); then flushes, so that the file is complete up to here whatever happens later.
  Collective. Errors: SAM_ERR_FILE. When there is no room for the step, nothing is written and the file can be closed as
  it is. After another failure of the disk in the middle of a step it cannot: SamOutputDestroy() then leaves the file
  alone, and the program should end by MPI_Abort(), since HDF5 would try to close the file in MPI_Finalize().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteStep(SamOutput output, const SamStep *step, SamContact contact);
/* SamOutputWriteFields - fields alone, of a step whose numbers are there already; otherwise as SamOutputWriteStep(). */
PETSC_EXTERN PetscErrorCode SamOutputWriteFields(SamOutput output, PetscReal time, SamContact contact);
/* SamOutputGetSaved - load steps in the file, those with fields, and the time of the last of these. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputGetSaved(SamOutput output, PetscInt *steps, PetscInt *saved, PetscReal *time);
/* SamOutputGetXdmf - name of the XDMF file beside the results, NULL without; borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputGetXdmf(SamOutput output, const char **filename);
/*
  SamOutputDestroy - closes the file; *output is NULL after it, also when that fails. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputDestroy(SamOutput *output);

#endif

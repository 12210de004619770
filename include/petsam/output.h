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

/*
  SamOutputCheckOptions - tells the help of, and checks, the options that SamOutputCreate() reads, so that a mistake is
  found before a file is created: -output_compress (level of deflate of the fields, 0 to 9; 0, the default: none),
  -output_chunk (most cells of a chunk in x, y), -output_xdmf (the XDMF file, true). Collective. Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamOutputCheckOptions(MPI_Comm comm);
/*
  SamOutputCreate - creates the file, replacing one of this name, with the coordinates of the grid and no step yet. All
  ranks write together through MPI-IO. Collective. Errors: SAM_ERR_FILE when it cannot be created (an existing file of
  a name that cannot be written stays as it is), SAM_ERR_USER for a wrong -output_compress.
*/
PETSC_EXTERN PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], SamOutput *output);
/*
  SamOutputContinue - opens the results of a run that was stopped after `steps` load steps, whose times are given, to go
  on after these. A file that holds just these steps and was closed in order goes on as it is; otherwise those steps are
  first copied to a new file, which then takes its name: the old one may have been left in the middle of a step, or hold
  more. The XDMF file is made anew. Collective. Errors: SAM_ERR_FILE for a file that cannot be read or written or lacks
  some of the steps, SAM_ERR_USER when it is of other fixed parameters or times; it is left as it was then.
*/
PETSC_EXTERN PetscErrorCode SamOutputContinue(SamGrid grid, const char filename[], const SamParameters *parameters,
                                              PetscInt steps, const PetscReal times[], SamOutput *output);
/* SamOutputSetParameters - all of them as attributes of the root. Collective. */
PETSC_EXTERN PetscErrorCode SamOutputSetParameters(SamOutput output, const SamParameters *parameters);
/* SamOutputSetReals, SamOutputSetText - attributes of the root; one number is stored as a scalar. Collective. */
PETSC_EXTERN PetscErrorCode SamOutputSetReals(SamOutput output, const char name[], PetscInt count,
                                              const PetscReal values[]);
PETSC_EXTERN PetscErrorCode SamOutputSetText(SamOutput output, const char name[], const char text[]);
/*
  SamOutputWriteStep - appends the scalars of a step to /history and, when fields is not NULL, its fields and time; then
  flushes, so that the file is complete up to here whatever happens later. `friction` decides the state. Collective.
  Errors: SAM_ERR_FILE. When there is no room for the step, nothing is written and the file can be closed as it is.
  After another failure of the disk in the middle of a step it cannot: SamOutputDestroy() then leaves the file alone,
  and the program should end by MPI_Abort(), since HDF5 would try to close the file in MPI_Finalize().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteStep(SamOutput output, const SamStep *step, const SamFields *fields,
                                               PetscReal friction);
/*
  SamOutputWriteFields - appends fields alone, of a step whose scalars are there already; otherwise as
  SamOutputWriteStep().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteFields(SamOutput output, PetscReal time, const SamFields *fields,
                                                 PetscReal friction);
/* SamOutputGetSaved - load steps in the file, those with fields, and the time of the last of these. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputGetSaved(SamOutput output, PetscInt *steps, PetscInt *saved, PetscReal *time);
/* SamOutputGetXdmf - name of the XDMF file beside the results, NULL without; borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputGetXdmf(SamOutput output, const char **filename);
/*
  SamOutputDestroy - closes the file; *output is NULL after it, also when that fails. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputDestroy(SamOutput *output);

#endif

/* Results in an HDF5 file. */
#ifndef PETSAM_OUTPUT_H
#define PETSAM_OUTPUT_H

#include <petsam/contact.h>

/*
  SamOutput - a results file that grows by a load step at a time (layout: README, "Results"). Every dataset has `units`
  and `long_name`; dimension scales time, y, x are attached, so that h5py and xarray (netcdf4) open it. The same datasets stand
  in a group VTKHDF, which VTK from 9.3 on reads, and in an XDMF file beside it for older ParaViews and VisIt.
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
/* SamOutputSetReals, SamOutputSetText - attributes of the root; one number is stored as a scalar. Collective. */
PETSC_EXTERN PetscErrorCode SamOutputSetReals(SamOutput output, const char name[], PetscInt count, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode SamOutputSetText(SamOutput output, const char name[], const char text[]);
/*
  SamOutputWriteStep - appends the scalars of a step to /history and, when fields is not NULL, its fields and time; then
  flushes, so that the file is complete up to here whatever happens later. `friction` decides the state. Collective.
  Errors: SAM_ERR_FILE. When there is no room for the step, nothing is written and the file can be closed as it is.
  After another failure of the disk in the middle of a step it cannot: SamOutputDestroy() then leaves the file alone, and
  the program should end by MPI_Abort(), since HDF5 would try to close the file in MPI_Finalize().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteStep(SamOutput output, const SamStep *step, const SamFields *fields, PetscReal friction);
/* SamOutputGetXdmf - name of the XDMF file beside the results, NULL without; borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputGetXdmf(SamOutput output, const char **filename);
/* SamOutputDestroy - closes the file; *output is NULL after it, also when that fails. Collective. Errors: SAM_ERR_FILE. */
PETSC_EXTERN PetscErrorCode SamOutputDestroy(SamOutput *output);

#endif

/* Results of a run, read again. */
#ifndef PETSAM_RESULTS_H
#define PETSAM_RESULTS_H

#include <petsam/control.h>
#include <petsam/parameters.h>
#include <petsam/grid.h>

/* SamResults - the results of a run, one file or its parts (output.h), open for reading, on any number of ranks. */
typedef struct _n_SamResults *SamResults;

/* The fields that can be read. */
typedef enum {
  SAM_RESULTS_PRESSURE,
  SAM_RESULTS_SHEAR_X,
  SAM_RESULTS_SHEAR_Y,
  SAM_RESULTS_SLIP_X,
  SAM_RESULTS_SLIP_Y,
  SAM_RESULTS_FIELDS
} SamResultsField;

/*
  SamResultsOpen - opens a file that the option (without dash) has named, and the parts that follow it. Their
  parameters, sizes and the places of their data are examined by rank 0 in a child process first, so that a damaged file
  does no harm. Collective. Errors: SAM_ERR_FILE for a file that cannot be read, is not of petsam, is damaged, lacks
  what is needed, or begins after the end of the part before; the message names it.
*/
PETSC_EXTERN PetscErrorCode SamResultsOpen(MPI_Comm comm, const char option[], const char filename[],
                                           SamResults *results);
PETSC_EXTERN PetscErrorCode SamResultsDestroy(SamResults *results);
/*
  SamResultsGetGrid - the grid of the run, distributed over the ranks that are there now; borrowed.
  SamResultsGetParameters - what defines the run, as SamSetupAddParameters() has recorded it; borrowed.
  SamResultsGetOptions - the options of the run, as far as they are known; borrowed.
  SamResultsGetSteps - number of load steps, also of those before the file's, and of those whose fields have been saved.
  SamResultsGetSaved - load step (from 1) and time (s) of the k-th saved one (from 0).
  None is collective.
*/
PETSC_EXTERN SamGrid              SamResultsGetGrid(SamResults results);
PETSC_EXTERN const SamParameters *SamResultsGetParameters(SamResults results);
PETSC_EXTERN const char          *SamResultsGetOptions(SamResults results);
PETSC_EXTERN PetscErrorCode       SamResultsGetSteps(SamResults results, PetscInt *steps, PetscInt *saved);
PETSC_EXTERN PetscErrorCode       SamResultsGetSaved(SamResults results, PetscInt k, PetscInt *step, PetscReal *time);
/*
  SamResultsRead - a field of the k-th saved step: this rank's rows. Collective. Errors: SAM_ERR_FILE, also for a field
  that the file does not have (only the slip may be missing), and for values that are no finite numbers.
*/
PETSC_EXTERN PetscErrorCode SamResultsRead(SamResults results, PetscInt k, SamResultsField field, double values[]);
/*
  SamResultsCountLayers - of a body (1 or 2) that yields, 0 of another one. SamResultsHasLayers - whether the stresses
  by plastic strain have been saved. Neither is collective.
  SamResultsReadDepths - the depths of the middles of a body's layers below its surface (m), from there down.
  Collective. Errors: SAM_ERR_FILE.
  SamResultsReadLayer - a component of these stresses (Pa), the mean over a layer, of those of both bodies along z of
  body 2: this rank's rows. Collective. Errors: as SamResultsRead().
*/
PETSC_EXTERN PetscInt       SamResultsCountLayers(SamResults results, PetscInt body);
PETSC_EXTERN PetscBool      SamResultsHasLayers(SamResults results);
PETSC_EXTERN PetscErrorCode SamResultsReadDepths(SamResults results, PetscInt body, double middle[]);
PETSC_EXTERN PetscErrorCode SamResultsReadLayer(SamResults results, PetscInt k, PetscInt component, PetscInt layer,
                                                double values[]);
/*
  SamResultsReadConditions - sets the conditions of a control to those of a load step (from 1), of a list; where the
  file has no column of one, it is as usual. Collective. Errors: SAM_ERR_FILE, also for a value that is no finite
  number.
*/
PETSC_EXTERN PetscErrorCode SamResultsReadConditions(SamResults results, PetscInt step, SamConditions conditions,
                                                     SamControl *control);
/*
  SamResultsReadNumber - of a load step (from 1): the cycles before the one that it belongs to in a life, 0 in other
  results; or its SamStatus, contact area (m2), slide, or rolled distance (m), 0 where it is not in the file.
  Collective. Errors: as SamResultsReadConditions().
*/
typedef enum {
  SAM_RESULTS_CYCLE,
  SAM_RESULTS_STATUS,
  SAM_RESULTS_CONTACT_AREA,
  SAM_RESULTS_SLIDE_X,
  SAM_RESULTS_SLIDE_Y,
  SAM_RESULTS_ROLLED_X,
  SAM_RESULTS_ROLLED_Y,
  SAM_RESULTS_NUMBERS
} SamResultsNumber;
PETSC_EXTERN PetscErrorCode SamResultsReadNumber(SamResults results, PetscInt step, SamResultsNumber number,
                                                 double *value);

#endif

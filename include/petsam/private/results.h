/* Reading the results of a run. */
#ifndef PETSAM_RESULTS_H
#define PETSAM_RESULTS_H

#include <petsam/control.h>
#include <petsam/parameters.h>
#include <petsam/grid.h>
#include <petsam/private/state.h>

/* SamResults - the results of a run, one file or several parts (output.h), open for reading on any number of ranks. */
typedef struct _n_SamResults *SamResults;

/*
  SamResultsOpen - opens a file that the option (without dash) has named, and the parts that follow it. Rank 0 first
  examines their parameters, sizes and the places of their data, so that a damaged file does no harm.
  Collective. Errors: SAM_ERR_FILE for a file that cannot be read, is not a file of petsam, is damaged, lacks required
  data, or begins after the end of the previous part; the message names it.
*/
PETSC_EXTERN PetscErrorCode SamResultsOpen(MPI_Comm comm, const char option[], const char filename[],
                                           SamResults *results);
PETSC_EXTERN PetscErrorCode SamResultsDestroy(SamResults *results);
/*
  SamResultsGetGrid - returns the grid of the run, distributed over the ranks of this program; borrowed.
  SamResultsGetParameters - returns the parameters that define the run, as SamSetupAddParameters() recorded them;
  borrowed.
  SamResultsGetOptions - returns the options of the run, as far as they are known; borrowed.
  SamResultsGetTractionError - returns the estimated error of the largest pressure and shear of the last step, relative;
  NaN: unknown.
  SamResultsGetSteps - gets the number of load steps, including those before the first step of the file, and the number
  of steps with saved fields.
  SamResultsGetSaved - gets the load step (from 1) and the time (s) of the k-th step (from 0) with saved fields.
  None is collective.
*/
PETSC_EXTERN SamGrid              SamResultsGetGrid(SamResults results);
PETSC_EXTERN const SamParameters *SamResultsGetParameters(SamResults results);
PETSC_EXTERN const char          *SamResultsGetOptions(SamResults results);
PETSC_EXTERN double               SamResultsGetTractionError(SamResults results);
PETSC_EXTERN PetscErrorCode       SamResultsGetSteps(SamResults results, PetscInt *steps, PetscInt *saved);
PETSC_EXTERN PetscErrorCode       SamResultsGetSaved(SamResults results, PetscInt k, PetscInt *step, PetscReal *time);
/*
  SamResultsRead - reads this rank's rows of a field of the k-th saved step: pressure, shear_x, shear_y, slip_x, slip_y,
  or one that parts of the stresses read (private/stresspart.h). Collective. Errors: SAM_ERR_FILE, also for a field that
  the file does not have (all but tractions may be missing), and for values that are not finite.
*/
PETSC_EXTERN PetscErrorCode SamResultsRead(SamResults results, PetscInt k, const char field[], double values[]);
/*
  SamResultsHas - returns true if the k-th saved step has a field. Not collective.
*/
PETSC_EXTERN PetscBool SamResultsHas(SamResults results, PetscInt k, const char field[]);
/*
  SamResultsGetLayers - returns the g-th group of layers whose stresses are added to those by tractions, borrowed; its
  z is NULL if they have not been saved. NULL: there are no more. Not collective.
  SamResultsReadLayer - reads this rank's rows of a component of these stresses (Pa), the mean over a layer, counted
  along z. Collective. Errors: as SamResultsRead().
*/
PETSC_EXTERN const SamStateLayers *SamResultsGetLayers(SamResults results, PetscInt g);
PETSC_EXTERN PetscErrorCode        SamResultsReadLayer(SamResults results, PetscInt k, PetscInt g, PetscInt component,
                                                       PetscInt layer, double values[]);
/*
  SamResultsReadConditions - sets the conditions of a list in a control to those of a load step (from 1); a condition
  without a column in the file gets its usual value. Collective. Errors: SAM_ERR_FILE, also for a value that is not
  finite.
*/
PETSC_EXTERN PetscErrorCode SamResultsReadConditions(SamResults results, PetscInt step, SamConditions conditions,
                                                     SamControl *control);
/*
  SamResultsReadNumber - reads a number of a load step (from 1): in a wear simulation the number of cycles before the
  cycle of the step; its SamStatus, contact area (m2), slide, or rolled distance (m). A number that is not in the file
  is 0. Collective. Errors: as SamResultsReadConditions().
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

/* The load program: which loads or displacements act at which step. */
#ifndef PETSAM_HISTORY_H
#define PETSAM_HISTORY_H

#include <petsam/contact.h>

/*
  SamHistory - a sequence of load steps: times, and for each of the six components a load or a displacement, the same
  choice in all steps. Either from a file with a row a step, or the single load of the options; each row's change may be
  divided into equal increments.

  The file: text, fields separated by commas; # begins a comment; empty lines count for nothing. The first line names
  the columns: `time` and any of load_n, load_tx, load_ty, load_mx, load_my, load_mz, disp_z, disp_x, disp_y, rot_x,
  rot_y, rot_z. Then one row a step, times increasing. Components without a column keep the value of their option, 0
  without.
*/
typedef struct _n_SamHistory *SamHistory;

/*
  SamHistoryClaimOption - to be called before PetscInitialize(): PETSc has an option -history of its own, which would
  append a log to the file that is named here. From now on it is stored under another name. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamHistoryClaimOption(void);

/*
  SamHistoryCreateFromOptions - reads -history, -steps, and the twelve -load_, -disp_ and -rot_ options; the whole file
  is read and checked. Collective. Errors: SAM_ERR_USER naming the option or the file and line, SAM_ERR_FILE for a file
  that cannot be read.
*/
PETSC_EXTERN PetscErrorCode SamHistoryCreateFromOptions(MPI_Comm comm, SamHistory *history);
PETSC_EXTERN PetscErrorCode SamHistoryDestroy(SamHistory *history);
PETSC_EXTERN PetscErrorCode SamHistoryGetCount(SamHistory history, PetscInt *steps);
PETSC_EXTERN PetscErrorCode SamHistoryGetIncrements(SamHistory history, PetscInt *increments); /* of each row */
/*
  SamHistoryGetStep - time and the two balances of step k (from 0), all else of the step cleared. Increments before the
  first row start from no load and no displacement at time 0, or, when the first time is not positive, as far before it
  as the second row is after it (1 s when there is none).
*/
PETSC_EXTERN PetscErrorCode SamHistoryGetStep(SamHistory history, PetscInt k, SamStep *step);

#endif

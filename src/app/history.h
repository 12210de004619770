/* The load program: which loads or displacements act at which step. */
#ifndef PETSAM_APP_HISTORY_H
#define PETSAM_APP_HISTORY_H

#include <petsam/control.h>

/*
  SamHistory - a sequence of load steps: times, and for each of the six components a load or a displacement, the same
  choice in all steps. Either from a file with a row a step, or the single load of the options; each row's change may be
  divided into equal increments.

  The file: text, fields separated by commas; # begins a comment; empty lines count for nothing. The first line names the
  columns: `time` and any of the names of loads and displacements (load_n ... rot_z), and friction_scale. Then one row a
  step, times increasing. Components without a column keep the value of their option, 0 without.
*/
typedef struct _n_SamHistory *SamHistory;

/*
  SamHistoryClaimOption - to be called before PetscInitialize(): PETSc has an option -history of its own, which would
  append a log to the file that is named here. From now on -history is another name for -load_history, which is what the
  database of options keeps. Not collective.
*/
PETSC_INTERN PetscErrorCode SamHistoryClaimOption(void);

/*
  SamHistoryCreateFromOptions - reads -history, -steps, and the twelve -load_, -disp_ and -rot_ options; the whole file
  is read and checked. Collective. Errors: SAM_ERR_USER naming the option or the file and line, SAM_ERR_FILE for a file
  that cannot be read.
*/
PETSC_INTERN PetscErrorCode SamHistoryCreateFromOptions(const SamOptions *from, SamHistory *history);
PETSC_INTERN PetscErrorCode SamHistoryDestroy(SamHistory *history);
PETSC_INTERN PetscErrorCode SamHistoryGetCount(SamHistory history, PetscInt *steps);
PETSC_INTERN PetscErrorCode SamHistoryGetIncrements(SamHistory history, PetscInt *increments); /* of each row */
/* SamHistoryHasFrictionScale - whether the friction varies. Not collective. */
PETSC_INTERN PetscErrorCode SamHistoryHasFrictionScale(SamHistory history, PetscBool *has);
/*
  SamHistoryGetStep - what step k (from 0) prescribes. Increments before the first row start from no load and no
  displacement at time 0, or, when the first time is not positive, as far before it as the second row is after it (1 s
  when there is none); the friction is that of the first row from the start. Not collective.
*/
PETSC_INTERN PetscErrorCode SamHistoryGetStep(SamHistory history, PetscInt k, SamControl *control);

#endif

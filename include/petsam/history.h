/* The load program: which loads or displacements act at which step. */
#ifndef PETSAM_HISTORY_H
#define PETSAM_HISTORY_H

#include <petsam/control.h>

/*
  SamHistory - a sequence of load steps: a time, and for each of the six components a load or a displacement, the same
  choice in all steps. It comes from a file with one row for each step, or, as a single row, from the options. The
  change from row to row may be divided into equal increments, each a load step. The first row's change is that from no
  load; if there is none in it either, it is the start itself, and one step.

  The file is text. Fields are separated by commas, semicolons or white space, # begins a comment, empty lines are
  ignored. The first line names the columns: `time`, any of the names of loads and displacements (load_n ... rot_z) and
  of conditions. The rows follow, with increasing times (s). What has no column has the value of its option, or its
  usual one, in all rows.
*/
typedef struct _n_SamHistory *SamHistory;

struct _n_SamArguments;

/*
  SamHistoryClaimOption - makes -history an alias of -load_history, the name in the options database. To be called
  before PetscInitialize(): PETSc has an option -history of its own, which would append a log to the user's file. Not
  collective.
*/
PETSC_EXTERN PetscErrorCode SamHistoryClaimOption(void);

/*
  SamHistoryCreateFromOptions - reads -history, -steps (increments), the twelve -load_, -disp_ and -rot_ options and the
  conditions that are options; reads and checks the whole file. Options that are given for this run must not have a
  column as well; of those in an options file the columns count instead, with a line on stderr; `arguments` tells them
  apart (NULL: all are given for this run). `conditions`: what rows may prescribe besides loads and displacements;
  referenced. Collective. Errors: SAM_ERR_USER naming the option, or the file and line;
  SAM_ERR_FILE for a file that cannot be read.
*/
PETSC_INTERN PetscErrorCode SamHistoryCreateFromOptions(const SamOptions *from, const struct _n_SamArguments *arguments,
                                                        SamConditions conditions, SamHistory *history);
/*
  SamHistoryCreate - the same of rows in memory, `values` (rows, columns): `columns` names them, with commas, as the
  first line of a file. `constant`: the values of what has no column, as a stress. `before`: what the change to the
  first row begins from; NULL: nothing, at time 0. Collective. Errors: SAM_ERR_USER naming the history's row.
*/
PETSC_INTERN PetscErrorCode SamHistoryCreate(MPI_Comm comm, SamConditions conditions, const SamControl *constant,
                                             const SamControl *before, const char columns[], PetscInt rows,
                                             const double values[], PetscInt increments, SamHistory *history);
/* SamHistoryReadIncrements - reads -steps. Collective. Errors: SAM_ERR_USER. */
PETSC_INTERN PetscErrorCode SamHistoryReadIncrements(const SamOptions *from, PetscInt *increments);
/* SamHistoryDestroy - frees the history and sets the handle to NULL. Not collective. */
PETSC_INTERN PetscErrorCode SamHistoryDestroy(SamHistory *history);
/* The number of load steps, and the number of increments for each row. Not collective. */
PETSC_INTERN PetscInt SamHistoryGetCount(SamHistory history);
PETSC_INTERN PetscInt SamHistoryGetIncrements(SamHistory history);
/* SamHistoryGetStart - the number of load steps up to the first row: the increments, or 1. Not collective. */
PETSC_INTERN PetscInt SamHistoryGetStart(SamHistory history);
/*
  SamHistoryGives - whether it gives a condition of that one's group: has a column of it, or another value than usual.
  Not collective.
*/
PETSC_INTERN PetscBool SamHistoryGives(SamHistory history, const SamCondition *one);
/*
  SamHistoryGetStep - the control of step k (from 0). The increments up to the first row start from zero loads,
  displacements and usual conditions at time 0; if the first row's time is not positive, they start before it by the
  time between the first two rows (1 s for a single row). A condition that is no option is that of the first row from
  the start. Not collective.
  SamHistoryGetPart - after a part of the step, more than 0, at most 1. Not collective.
*/
PETSC_INTERN SamControl SamHistoryGetStep(SamHistory history, PetscInt k);
PETSC_INTERN SamControl SamHistoryGetPart(SamHistory history, PetscInt k, PetscReal part);
/* SamHistoryGetPlace - the row that step k leads to, for messages: "file, line 3: ", empty without a file. */
PETSC_INTERN PetscErrorCode SamHistoryGetPlace(SamHistory history, PetscInt k, char text[], size_t size);

#endif

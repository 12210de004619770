/* The load history: the loads or displacements of each step. */
#ifndef PETSAM_PRIVATE_HISTORY_H
#define PETSAM_PRIVATE_HISTORY_H

#include <petsam/control.h>

/*
  SamHistory - a sequence of load steps: each has a time, and for each of the six components a load or a displacement,
  the same choice in all steps. It comes from a file of rows, or, as a single row, from the options. The change from row
  to row may be divided into equal increments, each a load step. The change to the first row begins from zero load; if
  the first row has zero load, too, it is the start itself, and one step.

  The file is text. Fields are separated by commas, semicolons or white space, # begins a comment, empty lines are
  ignored. The first line names the columns: `time`, any of the names of loads and displacements (load_n ... rot_z) and
  of conditions. The rows follow, with increasing times (s). A quantity without a column has the value of its option, or
  its usual value, in all rows.
*/
typedef struct _n_SamHistory *SamHistory;

struct _n_SamArguments;

/*
  SamHistoryClaimOption - makes -history an alias of -load_history, the name in the options database.

  Not collective.

  In: nothing.

  Errors: none of its own.

  It must be called before PetscInitialize(), since PETSc has an option -history of its own, which would append a log to
  the user's file.
*/
PETSC_EXTERN PetscErrorCode SamHistoryClaimOption(void);

/*
  SamHistoryCreateFromOptions - reads -history, -steps (increments), the twelve -load_, -disp_ and -rot_ options and the
  conditions that are options; reads and checks the whole file. An option that is given for this run must not have a
  column as well; an option in an options file is ignored if it has a column, with a line on stderr. `arguments`
  distinguishes the two (NULL: all options are given for this run). `conditions`: the conditions that rows may prescribe
  besides loads and displacements; referenced. Collective. Errors: SAM_ERR_USER naming the option, or the file and line;
  SAM_ERR_FILE for a file that cannot be read.
*/
PETSC_INTERN PetscErrorCode SamHistoryCreateFromOptions(const SamOptions *from, const struct _n_SamArguments *arguments,
                                                        SamConditions conditions, SamHistory *history);
/*
  SamHistoryCreate - creates a history from rows in memory, `values` (rows, columns). `columns` names the columns,
  separated by commas, as the first line of a file does. `constant`: the values of quantities without a column, as a
  stress. `before`: the control from which the change to the first row begins; NULL: zero loads at time 0. Collective.
  Errors: SAM_ERR_USER naming the history's row.
*/
PETSC_INTERN PetscErrorCode SamHistoryCreate(MPI_Comm comm, SamConditions conditions, const SamControl *constant,
                                             const SamControl *before, const char columns[], PetscInt rows,
                                             const double values[], PetscInt increments, SamHistory *history);
/* SamHistoryReadIncrements - reads -steps. Collective. Errors: SAM_ERR_USER. */
PETSC_INTERN PetscErrorCode SamHistoryReadIncrements(const SamOptions *from, PetscInt *increments);
/* SamHistoryDestroy - frees the history and sets the handle to NULL. Not collective. */
PETSC_INTERN PetscErrorCode SamHistoryDestroy(SamHistory *history);
/*
  SamHistoryGetCount, SamHistoryGetIncrements - return the number of load steps, and of increments per row. Not
  collective.
*/
PETSC_INTERN PetscInt SamHistoryGetCount(SamHistory history);
PETSC_INTERN PetscInt SamHistoryGetIncrements(SamHistory history);
/* SamHistoryGetStart - returns the number of load steps up to the first row: the increments, or 1. Not collective. */
PETSC_INTERN PetscInt SamHistoryGetStart(SamHistory history);
/*
  SamHistoryIsLast - returns true if step k is the last of those that lead to a row. Not collective.
*/
PETSC_INTERN PetscBool SamHistoryIsLast(SamHistory history, PetscInt k);
/*
  SamHistoryNextEnd - returns the step after k that is the first or the last of those that lead to a row; the number of
  steps if there is none. If both have allowed values, the steps between have, too: their values are interpolated, and
  the changes of conditions are the same in all of them. So a loop over the ends (from 0) is as long as the history has
  rows, not as it has steps. Not collective.
*/
PETSC_INTERN PetscInt SamHistoryNextEnd(SamHistory history, PetscInt k);
/*
  SamHistoryGives - returns true if the history gives any condition of the group of `one`: it has a column of it, or a
  value other than the usual one. Not collective.
*/
PETSC_INTERN PetscBool SamHistoryGives(SamHistory history, const SamCondition *one);
/*
  SamHistoryGetStep - returns the control of step k (from 0). The increments up to the first row start from zero loads,
  displacements and usual conditions at time 0; if the first row's time is not positive, they start before it by the
  time between the first two rows (1 s for a single row). A condition that is no option has the value of the first row
  from the start. Not collective.
  SamHistoryGetPart - returns the control after a part (> 0, <= 1) of the step. Not collective.
*/
PETSC_INTERN SamControl SamHistoryGetStep(SamHistory history, PetscInt k);
PETSC_INTERN SamControl SamHistoryGetPart(SamHistory history, PetscInt k, PetscReal part);
/*
  SamHistoryDivide - creates a history of the same rows with other increments per row, whose path to the first row is
  the same: if that is one step from no load, which applies N before the tangential loads, more increments do so, too,
  in twice as many steps; if the loads grow in proportion, they also do so in one step. Not collective.
  SamHistoryFindStep - returns the step of `other`, made of this history by SamHistoryDivide(), at whose end all values
  are those at the end of step k of the history; -1: there is none. Not collective.
*/
PETSC_INTERN PetscErrorCode SamHistoryDivide(SamHistory history, PetscInt increments, SamHistory *other);
PETSC_INTERN PetscInt       SamHistoryFindStep(SamHistory history, SamHistory other, PetscInt k);
/*
  SamHistoryGetPlace - writes the place of the row that step k leads to, for messages: "file, line 3: ", empty without a
  file.
*/
PETSC_INTERN PetscErrorCode SamHistoryGetPlace(SamHistory history, PetscInt k, char text[], size_t size);

#endif

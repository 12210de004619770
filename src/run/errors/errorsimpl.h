/* The inside of the errors of a run: numbers with their companion runs, and rows of the table. */
#ifndef PETSAM_ERRORSIMPL_H
#define PETSAM_ERRORSIMPL_H

#include "companion.h"
#include <petsam/private/errors.h>
#include <petsam/private/state.h>

/* SamErrorNumber - a number of the state with its errors. */
typedef struct {
  const SamStateNumber *of;
  PetscInt              id, error;      /* places in the state of the number and of its error; -1: that is not stored */
  PetscInt              at[SAM_RUNS];   /* its places in the companions' states; -1: none */
  double                mark[SAM_RUNS]; /* sums of the runs at the last common moment */
  double                base[SAM_RUNS]; /* the same before the first step of this run */
  double                apart; /* sum with the same steps minus that with other steps, of the steps of this run */
  double                steps; /* error by the steps at the last common moment, relative; NaN: unknown */
} SamErrorNumber;

/* SamErrorLargest - the largest values of all steps, which tell what is next to nothing. */
typedef struct {
  double load, approach, area, pressure;
  double twist; /* M_z of the step in which contact began, if given */
} SamErrorLargest;

struct _n_SamErrors {
  SamCompanion     companion[SAM_RUNS];
  SamRunKind       same; /* the companion on the same cells as that with other steps */
  PetscInt         count;
  SamErrorNumber   number[SAM_ERROR_ROWS];
  double           sums[SAM_STATE_NUMBERS]; /* numbers of the steps of this run, joined */
  SamErrorLargest  largest;                 /* on half the cells */
  SamErrorLargest  committed;               /* those of the committed steps, of steps given one by one, */
  PetscBool        driven[SAM_COMPONENTS];  /* and the components that these drive */
  PetscReal        few;                     /* cells across the contact of the last step; 0: enough */
  double           more;                    /* how many times as many are enough */
  PetscBool        resolved;                /* a step of this run had enough */
  PetscBool        began;                   /* the first step has been recorded */
  PetscBool        restored;                /* the companions continue from a checkpoint */
  char             unknown[SAM_MESSAGE];    /* why nothing is known of steps given one by one; empty: it is */
  const SamDoubts *closed;                  /* the errors in closed form; borrowed */
  SamErrorTable    table;
};

/*
  SamErrorsGet - returns a number of the last step by its name, NaN if there is none.
  SamErrorsBegin - notes the moment of the step in which contact begins; before its numbers are raised.
  SamErrorsRaise - raises the largest values of all steps to those of this state.
  SamErrorsGetRuns - gets a number of the companions' last steps, or its sum over all steps; NaN: they have none.
  SamErrorsLeast - returns the value below which a number is next to nothing for this contact.
  SamErrorsYields - returns true if a body may yield.
  SamErrorsByCells - returns the error of a number by the cells, in its unit, by its values in the companion runs.
  SamErrorsRelativeBySteps - returns the error of a number by the steps, relative to it.
  SamErrorsPrescribes - returns true if the step prescribes the number of this name.
  SamErrorsAddRow - adds a row to the table; `least`: value below which the number is next to nothing, unless a closed
  form says that it is wrong.
  SamErrorsAddDerivative - adds one for the share of the gradient of the number `of`, and gets its error, NaN if it is
  unknown. It is at least the error of `of` that is known in closed form.
  SamErrorsAddNumbers - adds the numbers of the last step, with these loads, and the sums over all steps.
  SamErrorsAddDoubts - adds the large errors of the table to those in closed form, which are told together, and warns
  of companions that ended early.
  (errorrows.c) AddNumbers and AddDoubts are collective.
*/
PETSC_INTERN double SamErrorsGet(SamState state, const char name[]);
PETSC_INTERN void   SamErrorsBegin(SamErrorLargest *largest, const SamControl *control);
PETSC_INTERN void   SamErrorsRaise(SamErrorLargest *largest, SamState state);
PETSC_INTERN void SamErrorsGetRuns(SamErrors errors, const SamErrorNumber *number, PetscBool sum, double run[SAM_RUNS]);
PETSC_INTERN double    SamErrorsLeast(SamSimulation simulation, const SamStateNumber *number);
PETSC_INTERN PetscBool SamErrorsYields(SamSimulation simulation);
PETSC_INTERN double    SamErrorsByCells(SamSimulation simulation, const SamStateNumber *number, double value,
                                        const double run[SAM_RUNS]);
PETSC_INTERN double    SamErrorsRelativeBySteps(SamSimulation simulation, const SamErrorNumber *number,
                                                const double run[SAM_RUNS]);
PETSC_INTERN PetscBool SamErrorsPrescribes(const SamControl *control, const char name[]);
PETSC_INTERN void      SamErrorsAddRow(SamSimulation simulation, const SamStateNumber *number, const char unit[],
                                       double value, double least, const double run[SAM_RUNS]);
PETSC_INTERN void      SamErrorsAddDerivative(SamSimulation simulation, const SamStateNumber *number, const char of[],
                                              double value, double least, const double run[SAM_RUNS], double *error);
PETSC_INTERN PetscErrorCode SamErrorsAddNumbers(SamSimulation simulation, const SamControl *control);
PETSC_INTERN PetscErrorCode SamErrorsAddDoubts(SamErrors errors, SamAdvice *advice);
/* SamErrorsCompareSteps - updates the error of a number by the steps, at a moment that SAM_RUN_OTHER shares with the
   run. Not collective (errors.c). */
PETSC_INTERN void SamErrorsCompareSteps(SamSimulation simulation, SamErrorNumber *number);
/* SamErrorsKeep - keeps the largest values, and what is driven, with the committed steps. Not collective. */
PETSC_INTERN void SamErrorsKeep(SamSimulation simulation);
/*
  SamErrorsFind - finds the numbers in a state whose list has grown. SamErrorsSet - sets the stored error of each number
  of the tried step, with these loads. Collective (errors.c).
*/
PETSC_INTERN PetscErrorCode SamErrorsFind(SamErrors errors, SamState state);
PETSC_INTERN PetscErrorCode SamErrorsSet(SamSimulation simulation, const SamControl *control);

#endif

/* The estimated errors of the numbers of a run, by their causes. */
#ifndef PETSAM_ERRORS_H
#define PETSAM_ERRORS_H

#include <petsam/private/baseimpl.h>

/* SamCause - what causes an error: the width of the cells (and of layers, which follow it), or the length of the load
   steps. */
typedef enum { SAM_CAUSE_CELLS, SAM_CAUSE_STEPS, SAM_CAUSES } SamCause;
PETSC_INTERN const char *const SamCauseNames[SAM_CAUSES];

/*
  SamDoubts - errors in closed form, relative to their numbers: of what is narrower than a cell on all grids, and of
  steps. The largest is kept for each number and cause.
  SamDoubtsAdd - adds an error of all numbers named in `names`, separated by blanks. At most 1 counts.
  SamDoubtsSet - the same for numbers whose value is known in closed form, so that no other estimate of it counts.
  SamDoubtsOf - returns the error of a number by a cause; 0: there is none. `known`: it has been set. None is collective
  (doubts.c).
*/
#define SAM_DOUBTS 48
typedef struct {
  PetscInt count;
  struct {
    char      name[32];
    SamCause  cause;
    double    error;
    PetscBool known; /* the error of a value in closed form */
  } of[SAM_DOUBTS];
} SamDoubts;
PETSC_INTERN void   SamDoubtsAdd(SamDoubts *doubts, SamCause cause, double error, const char names[]);
PETSC_INTERN void   SamDoubtsSet(SamDoubts *doubts, SamCause cause, double error, const char names[]);
PETSC_INTERN double SamDoubtsOf(const SamDoubts *doubts, const char name[], SamCause cause, PetscBool *known);

/* SamRunKind - the companion runs: on half and on a quarter of the cells in each direction, and on half with other
   steps. */
typedef enum { SAM_RUN_HALF, SAM_RUN_QUARTER, SAM_RUN_OTHER, SAM_RUNS } SamRunKind;

/*
  SamErrorRow - a number of the last step, or a sum over all steps, with its error. Errors are relative; NaN: unknown.
  `factor`: how many times narrower cells, or more steps, make the error by the larger cause 4 %; 1: it is smaller.
*/
#define SAM_ERROR_NAME 56
typedef struct {
  char        name[SAM_ERROR_NAME];
  const char *unit;
  double      value, error, of[SAM_CAUSES];
  double      scale;         /* what errors are relative to: the absolute value, or a least value if that is more */
  double      run[SAM_RUNS]; /* the number in the companion runs; NaN: none */
  SamCause    cause;         /* the larger one */
  double      factor;
  PetscInt    order; /* of the error by the cells, in the cell size */
} SamErrorRow;

/* SamErrorTable - the rows, and how they were found. */
#define SAM_ERROR_ROWS 64
typedef struct {
  PetscInt    count;
  SamErrorRow row[SAM_ERROR_ROWS];
  char        runs[192]; /* the companion runs, in words; empty: there are none */
  double      seconds;   /* time that they took, s */
} SamErrorTable;

/*
  SamErrorByCells - returns the error of a number by the cells: `own` is its value, `run` those of the companion runs.
  SamErrorBySteps - returns the error of a number by the steps. Both are NaN if unknown.
  SamErrorWrite - writes a relative error in per cent, or "unknown"; returns the text. None is collective (estimates.c).
*/
#define SAM_ERROR_TEXT 16
PETSC_EXTERN const char *SamErrorWrite(double error, char text[], size_t size);
PETSC_INTERN double      SamErrorByCells(double own, const double run[SAM_RUNS]);
PETSC_INTERN double      SamErrorBySteps(const double run[SAM_RUNS]);

#endif

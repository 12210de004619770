/* The estimated errors of the numbers of a run, by their causes. */
#ifndef PETSAM_ERRORS_H
#define PETSAM_ERRORS_H

#include <petsam/private/doubts.h>

/* SamRunKind - the companion runs: on half and on a quarter of the cells in each direction, and with other steps on one
   of these. */
typedef enum { SAM_RUN_HALF, SAM_RUN_QUARTER, SAM_RUN_OTHER, SAM_RUNS } SamRunKind;

/*
  SamErrorRow - a number of the last step, or a sum over all steps, with its error. Errors are relative; NaN: unknown.
  `factor`: how many times narrower cells, more steps or more layers make the error by the larger cause 4 %; 1: it is
  smaller.
*/
#define SAM_ERROR_NAME SAM_DOUBT_NAME
typedef struct {
  char        name[SAM_ERROR_NAME];
  const char *unit;
  double      value, error, of[SAM_CAUSES];
  double      cells;             /* that by the cells as companion runs tell it */
  PetscBool   grows[SAM_CAUSES]; /* the number grows with each refinement: it has no limit */
  double      more;              /* how many times as many cells resolve a contact of too few; 0: they are enough */
  double      scale;             /* what errors are relative to: the absolute value, or a least value if that is more */
  double      run[SAM_RUNS];     /* the number in the companion runs; NaN: none */
  SamCause    cause;             /* the larger one */
  double      factor;
  PetscInt    order; /* of the error by the cells, in the cell size */
} SamErrorRow;

/* SamErrorTable - the rows, and how they were found. */
#define SAM_ERROR_ROWS  64  /* most numbers of a step with errors */
#define SAM_ERROR_TABLE 512 /* most rows, with those of derivatives */
typedef struct {
  PetscInt    count;
  SamErrorRow row[SAM_ERROR_TABLE];
  char        runs[192]; /* the companion runs, in words; empty: there are none */
  double      seconds;   /* time that they took, s */
} SamErrorTable;

/*
  SamErrorByCells - returns the error of a number by the cells: `own` is its value, `run` those of the companion runs;
  `energy`: it is an energy of bodies that do not yield.
  SamErrorOfSeries - returns the same for a number whose differences from grid to grid hardly fall, infinite if they
  grow; 0: they fall, or that of the finer grids is at most `least`, in the number's unit.
  SamErrorOfDerivative - returns that of a derivative by the cells.
  SamErrorBySteps - returns the error of a number by the steps; `same`: the run on the same cells as SAM_RUN_OTHER.
  Those by cells and by steps are NaN if unknown. None is collective (estimates.c).
*/
PETSC_INTERN double SamErrorByCells(PetscBool energy, double own, const double run[SAM_RUNS]);
PETSC_INTERN double SamErrorOfSeries(double least, double own, const double run[SAM_RUNS]);
PETSC_INTERN double SamErrorOfDerivative(double own, const double run[SAM_RUNS]);
PETSC_INTERN double SamErrorBySteps(const double run[SAM_RUNS], SamRunKind same);

#endif

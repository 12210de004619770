/* The inside of -accuracy: what is tried and what a trial finds, the first grid, and the way to the next one. */
#ifndef PETSAM_ACCURACYIMPL_H
#define PETSAM_ACCURACYIMPL_H

#include "../steps/simulationimpl.h"
#include <petsam/private/accuracy.h>

#define SAM_TRIAL_ROOM 1.2 /* ratio of the width of the grid to that of the contact */

/* SamChoice - a grid and steps that are tried or chosen. */
typedef struct {
  PetscInt  n[2], steps;
  PetscReal width[2], center[2];
} SamChoice;

/* SamWatch - the best error of a number by a cause, in the trial with so many cells per m, or steps per row; `stalls`:
   number of trials up to the finest that were no better for their fineness; `order`: power of the fineness with which
   the error fell to the last trial from the best one before; 0: unknown. */
typedef struct {
  char     name[SAM_ERROR_NAME];
  SamCause cause;
  double   fineness, error, finest, order;
  PetscInt stalls;
} SamWatch;

/* SamTask - what is asked for, which parts of a choice are not given by options, and what trials have shown. */
typedef struct {
  const SamAccuracy *asked;
  PetscBool          number, size, center, steps; /* of cells, width, centre of the grid, steps per row */
  PetscInt           axes;
  PetscInt           few, most; /* cells along the shorter side: of the first grid; most along any side */
  PetscInt           watched;
  SamWatch           watch[4 * SAM_ERROR_TABLE];
  double             seconds, work; /* time of the last trial (s), and its cells times steps */
  double             spent;         /* time of all trials, s */
} SamTask;

/* SamTrial - what a trial found. */
typedef struct {
  PetscBool     touched;
  PetscReal     low[2], high[2]; /* the rectangle of the contact in all steps, m */
  SamErrorTable table;
  PetscInt      steps;       /* that it had */
  char          names[2048]; /* its numbers that may have errors, separated by ", " */
  SamStatus     status;
  PetscBool     failed; /* it ended with an error */
} SamTrial;

/*
  SamTaskBegin - finds which parts are not given, and the first grid, from a simulation that has only read its options.
  Collective. Errors: SAM_ERR_USER (accuracybegin.c).
  SamTaskConcerns - returns true if -accuracy concerns the number of this name (accuracy.c).
  SamTaskChange - changes the choice by what a trial on it found; `last`: it is the one to run; `limit`: set to the
  reason if errors do not become as small as asked, of SAM_ACCURACY_LIMIT characters; empty if they do
  (accuracychange.c). Neither is collective.
*/
PETSC_INTERN PetscErrorCode SamTaskBegin(SamSimulation simulation, SamTask *task, SamChoice *choice);
PETSC_INTERN PetscBool      SamTaskConcerns(const SamAccuracy *asked, const char name[]);
PETSC_INTERN void SamTaskChange(SamTask *task, const SamTrial *trial, SamChoice *choice, PetscBool *last, char limit[]);

#endif

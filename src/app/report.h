/* What a run prints: a banner, a line for each load step, progress within long steps, and a closing table. */
#ifndef PETSAM_APP_REPORT_H
#define PETSAM_APP_REPORT_H

#include <petsam/advice.h>
#include <petsam/life.h>
#include "checkpoints.h"

/*
  SamStepView - prints a step in a few lines: loads, displacements, areas, iterations, check. Collective on the viewer.
*/
PETSC_INTERN PetscErrorCode SamStepView(const SamStep *step, PetscViewer viewer);
/*
  SamStepViewHeading, SamStepViewLine - print a step as one line of a table, and the table's heading. `number` counts
  from 1, `seconds` is the time of the step, `left` the estimated time (s) of the remaining steps. Collective on the
  viewer.
*/
PETSC_INTERN PetscErrorCode SamStepViewHeading(PetscViewer viewer);
PETSC_INTERN PetscErrorCode SamStepViewLine(const SamStep *step, PetscInt number, double seconds, double left,
                                            PetscViewer viewer);

/*
  SamReport - reports a run on stdout, and warnings and failures of steps on stderr, both from rank 0. Order of calls:
  Create, Banner, then BeginStep and EndStep for each load step, AddFile for each file written, Closing, Destroy.
*/
typedef struct _n_SamReport *SamReport;

/*
  SamReportCreateFromOptions - reads -quiet (nothing on stdout; warnings and errors are still printed) and -progress
  (auto, always or never: a line that is updated while a step is solved; auto: on a terminal, in steps that take longer
  than a second). Starts PETSc's log, from which the closing table takes its times. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamReportCreateFromOptions(const SamOptions *from, SamReport *report);
PETSC_INTERN PetscErrorCode SamReportDestroy(SamReport *report);
/*
  SamReportSetRestart - for the banner: the run goes on from this checkpoint, at this point. The name is not copied.
  SamReportSetBranch - that its results begin there, while those before are in the file of that name (empty: in none);
  `gap`: the gap has changed.
  Neither is collective.
*/
PETSC_INTERN PetscErrorCode SamReportSetRestart(SamReport report, const char checkpoint[], const SamRunPoint *point);
PETSC_INTERN PetscErrorCode SamReportSetBranch(SamReport report, const char results[], PetscBool gap);
/*
  SamReportSetCheckpoints - for the banner: when checkpoints are written. The text is not copied. Not collective.
*/
PETSC_INTERN PetscErrorCode SamReportSetCheckpoints(SamReport report, const char when[]);
/*
  SamReportBanner - prints version, libraries, ranks, grid, memory (`bytes`: what this rank will need; the largest is
  printed), number of steps, and the results file (NULL: none) with its size in words. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBanner(SamReport report, SamGrid grid, double bytes, PetscInt steps,
                                            const char output[], const char size[]);
/*
  SamReportBeginStep - to be called before a step; `number` counts from 0. Progress is shown by monitors, which it adds
  to the contact's solvers. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBeginStep(SamReport report, PetscInt number, SamContact contact);
/*
  SamReportEndStep - prints the step's line and its message; the only step of a run in full. That the contact is at the
  edge, where that is allowed, is said in the first such step only. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportEndStep(SamReport report, const SamStep *step);
/*
  For a life: SamReportBeginCycle() before a cycle is computed, SamReportCountStep() for each of its steps (`number`
  counts from 1; SamReportEndStep() does that itself), SamReportEndCycle() prints the cycle's line; `cycles` is their
  number in all. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBeginCycle(SamReport report, SamContact contact);
PETSC_INTERN PetscErrorCode SamReportCountStep(SamReport report, PetscInt number, const SamStep *step);
PETSC_INTERN PetscErrorCode SamReportEndCycle(SamReport report, const SamLifeReport *cycle, PetscReal cycles);
/* SamReportWarn - prints a warning with the option (without dash; empty: none) that mends it. Not collective. */
PETSC_INTERN void SamReportWarn(SamReport report, const char text[], const char option[]);
/* SamReportSetExtent - for the closing table: the size of the contact in a step, from 1. Not collective. */
PETSC_INTERN void SamReportSetExtent(SamReport report, PetscInt step, const SamExtent *extent);
/* SamReportMessage - prints a step's message, if it has one, after words that say where it is. Collective. */
PETSC_INTERN PetscErrorCode SamReportMessage(SamReport report, const char where[], const SamStep *step);
/* SamReportAddFile - for the closing table: a file that was written, and what it holds. Not collective. */
PETSC_INTERN PetscErrorCode SamReportAddFile(SamReport report, const char name[], const char content[]);
/* SamReportClosing - prints times by part, worst residuals, files written, and time and memory used. Collective. */
PETSC_INTERN PetscErrorCode SamReportClosing(SamReport report);

#endif

/* What a run prints: a banner, a line for each load step, progress within long steps, and a closing table. */
#ifndef PETSAM_APP_REPORT_H
#define PETSAM_APP_REPORT_H

#include <petsam/simulation.h>

/*
  SamStepView - prints a step in a few lines: loads, displacements, areas, iterations, check. Collective on the viewer.
*/
PETSC_INTERN PetscErrorCode SamStepView(const SamStep *step, SamContact contact, PetscViewer viewer);
/*
  SamStepViewHeading, SamStepViewLine - print a step as one line of a table, and the table's heading. `number` counts
  from 1, `seconds` is the time of the step, `left` the estimated time (s) of the remaining steps. Collective on the
  viewer.
*/
PETSC_INTERN PetscErrorCode SamStepViewHeading(PetscViewer viewer);
PETSC_INTERN PetscErrorCode SamStepViewLine(const SamStep *step, SamContact contact, PetscInt number, double seconds,
                                            double left, PetscViewer viewer);

/*
  SamReport - reports a run on stdout, and warnings and failures of steps on stderr, both from rank 0. Order of calls:
  Create, Banner, News, Closing, Destroy.
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
  SamReportBanner - prints version, libraries, ranks, grid, memory (`bytes`: what this rank will need; the largest is
  printed), and from where and into which files the run goes. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBanner(SamReport report, SamGrid grid, double bytes,
                                            const SamSimulationStart *start);
/*
  SamReportNews - prints a line for a step, or a computed cycle, the only step of a run in full; messages and warnings;
  and keeps what the closing table tells. That the contact is at the edge, where that is allowed, is said in the first
  such step only. Progress is shown by monitors, which it adds to the contact's solvers. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportNews(SamReport report, SamContact contact, const SamSimulationNews *news);
/* SamReportClosing - prints times by part, worst residuals, files written, and time and memory used. Collective. */
PETSC_INTERN PetscErrorCode SamReportClosing(SamReport report);

#endif

/* What a run says: before it, at each load step, within long ones, and at its end. */
#ifndef PETSAM_APP_REPORT_H
#define PETSAM_APP_REPORT_H

#include <petsam/contact.h>

/* SamStepView - a step in a few lines: loads, displacements, areas, iterations, check. Collective on the viewer. */
PETSC_INTERN PetscErrorCode SamStepView(const SamStep *step, PetscViewer viewer);
/*
  SamStepViewHeading, SamStepViewLine - one line a step in fixed columns. `seconds` is what the step took, `left` what
  the remaining steps are estimated to take. Collective on the viewer.
*/
PETSC_INTERN PetscErrorCode SamStepViewHeading(PetscViewer viewer);
PETSC_INTERN PetscErrorCode SamStepViewLine(const SamStep *step, PetscInt number, double seconds, double left,
                                            PetscViewer viewer);

/*
  SamReport - tells a run on stdout, and what is wrong with a step on stderr, both from rank 0. Order of calls: Create,
  Banner, then BeginStep and EndStep for each load step, AddFile for each file written, Closing, Destroy.
*/
typedef struct _n_SamReport *SamReport;

/*
  SamReportCreateFromOptions - reads -quiet (nothing on stdout; warnings and errors stay) and -progress (auto, always or
  never: a line that is written over while a step is being solved; auto: on a terminal, in steps that take longer than a
  second). Starts PETSc's log, from which the closing table takes its times. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamReportCreateFromOptions(const SamOptions *from, SamReport *report);
PETSC_INTERN PetscErrorCode SamReportDestroy(SamReport *report);
/*
  SamReportSetRestart - the run goes on from that checkpoint, after that step; told by the banner. The name is not
  copied. Not collective.
*/
PETSC_INTERN PetscErrorCode SamReportSetRestart(SamReport report, const char checkpoint[], PetscInt step);
/*
  SamReportBanner - version, libraries, ranks, grid, memory (`bytes`: what the largest rank will need), steps, and the
  file of the results (NULL: none). Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBanner(SamReport report, SamGrid grid, double bytes, PetscInt steps,
                                            const char output[]);
/*
  SamReportBeginStep - the step of that number (from 0) begins; its progress is told by monitors of the contact's
  solvers. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBeginStep(SamReport report, PetscInt number, SamContact contact);
/* SamReportEndStep - its line and its message; a run of a single step is told in full. Collective. */
PETSC_INTERN PetscErrorCode SamReportEndStep(SamReport report, const SamStep *step);
/* SamReportAddFile - a file that was written, and what is in it. Not collective. */
PETSC_INTERN PetscErrorCode SamReportAddFile(SamReport report, const char name[], const char content[]);
/* SamReportClosing - where the time went, worst residuals, files written, time and memory used. Collective. */
PETSC_INTERN PetscErrorCode SamReportClosing(SamReport report);

#endif

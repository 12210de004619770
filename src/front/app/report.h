/* Printed report of a run: a banner, a line for each load step, progress within long steps, and a closing table. */
#ifndef PETSAM_APP_REPORT_H
#define PETSAM_APP_REPORT_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/accuracy.h>
#include <petsam/private/simulation.h>

#define SAM_REPORT_FILES   8
#define SAM_REPORT_COLUMNS 18 /* columns in the table of steps */
#define SAM_REPORT_RECENT  5  /* number of steps whose mean time gives the estimate of the time left */

typedef enum { SAM_PROGRESS_AUTO, SAM_PROGRESS_ALWAYS, SAM_PROGRESS_NEVER } SamProgressMode;

/* The progress line within a step, which only rank 0 shows */
typedef struct {
  SamProgressMode mode;
  PetscBool       active;   /* true if this rank shows it */
  double          after;    /* seconds of a step after which it is shown */
  double          shown_at; /* time of the last update (MPI_Wtime) */
  int             length;   /* number of characters on the terminal, to be erased */
} SamProgress;

/*
  SamReportColumn - a column of a printed table: `number`, the name of its load or number of a state ("": none); its
  width including a space before it; its digits (0: as 1.2e-03); and its place in the order of omission. `other` (NULL:
  none) replaces the label in plane strain, and if the heading would be too long.
*/
typedef struct {
  const char *label, *other, *number;
  int         width, digits, order; /* order in which columns are omitted if a line would be too long; 0: never */
} SamReportColumn;
typedef char SamReportCell[32];

/* A solution's largest residual so far, and its step */
typedef struct {
  PetscReal residual;
  PetscInt  step;
} SamReportWorst;

/* A law's line about the step of the greatest weight; borrowed name; empty: none */
typedef struct {
  PetscReal   weight;
  const char *name;
  char        text[192];
} SamReportSummary;

/*
  SamReport - reports a run on stdout, and warnings and failures of steps on stderr, both from rank 0. Order of calls:
  Create, Banner, News, Closing, Destroy.
*/
typedef struct _n_SamReport *SamReport;
struct _n_SamReport {
  /* what the user sets */
  MPI_Comm           comm;
  PetscBool          quiet, profile;
  const SamAccuracy *accuracy; /* borrowed; NULL: none is asked for */
  /* status */
  PetscMPIInt      rank;
  PetscBool        logging;             /* true if PETSc's log has the times */
  double           start, first, begin; /* MPI_Wtime() at the start of the report, of the first step, of this one */
  double           parts_before;        /* seconds spent on the parts of the closing table before the first step */
  double           recent[SAM_REPORT_RECENT]; /* seconds of the last steps */
  PetscInt         steps, number, done;
  PetscBool        shown[SAM_REPORT_COLUMNS]; /* columns of the table of steps */
  const char      *energy_unit;               /* unit of the dissipated energy */
  PetscInt         cycles;                    /* lines printed for computed cycles */
  PetscReal        jump;                      /* cycles in the last of these */
  PetscBool        living;                    /* the run is a life */
  SamReportWorst   worst[3];                  /* normal, tangential, equilibrium */
  SamReportWorst   edges;     /* smallest reconstructed share of the edges; step 0: reconstruction is disabled */
  double           offer;     /* time that companion runs would add, relative to that of this run; 0: nothing is said */
  PetscInt         divided;   /* number of load steps that were divided */
  PetscReal        energy[2]; /* energy dissipated so far, and the estimate of its error, J */
  SamProgress      progress;
  SamContact       contact;           /* contact whose monitors are set; borrowed */
  SamExtent        extent;            /* of the contact in step `extent_step`, */
  PetscInt         extent_step;       /* from 1; 0: unknown */
  SamSlip          slip;              /* of all steps; unknown without steps */
  SamReportSummary summary[SAM_LAWS]; /* of each law */
  PetscBool        edge_told;         /* true once a contact at the grid's edge, which is allowed, has been reported */
  /* lines of steps that are not in the results yet */
  PetscBool holds; /* lines wait */
  char     *held;
  size_t    held_length, held_size;
  /* files written */
  char    *name[SAM_REPORT_FILES], *content[SAM_REPORT_FILES];
  PetscInt files;
  PetscInt gradients; /* lines on gradients so far */
};

/*
  SamReportCreateFromOptions - reads -quiet (nothing on stdout; warnings and errors are still printed), -profile (times
  by part, iterations, largest residuals) and -progress (auto, always or never: a line that is updated while a step is
  solved; auto: on a terminal, in steps that take longer than a second). With -profile it starts PETSc's log, from which
  the closing table takes its times. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamReportCreateFromOptions(const SamOptions *from, SamReport *report);
PETSC_INTERN PetscErrorCode SamReportDestroy(SamReport *report);
/* SamReportSetAccuracy - makes the banner tell what was chosen by -accuracy, and the errors be compared with it. It is
   borrowed. Not collective. */
PETSC_INTERN void SamReportSetAccuracy(SamReport report, const SamAccuracy *accuracy);
/*
  SamReportBanner - prints version, libraries, ranks, grid, bodies that are named, memory (`bytes`: what this rank will
  need, and of it what does not depend on the grid; the largest is printed), the checkpoint from which the run
  continues, and the files that it writes. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportBanner(SamReport report, const SamSetup *setup, const double bytes[2],
                                            const SamSimulationStart *start);
/*
  SamReportNews - prints a line for a step or a computed cycle (the only step of a run in full), messages and warnings,
  and collects the values of the closing table. If a contact at the grid's edge is allowed, it is reported in the first
  such step only. Monitors that are added to the contact's solvers show the progress. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportNews(SamReport report, SamContact contact, const SamSimulationEvent *news);
/* SamReportClosing - prints times by part and largest residuals, if asked for, files written, time and memory used.
   Collective. */
PETSC_INTERN PetscErrorCode SamReportClosing(SamReport report, SamContact contact);
/* SamReportKeepSummaries - keeps what laws write about a step with a solution, of each that of the greatest weight.
   Not collective. */
PETSC_INTERN void SamReportKeepSummaries(SamReport report, SamContact contact);

/* ---- the parts ---- */

/*
  SamStepView - prints a step in a few lines: loads, displacements, areas, check, and with `profile` iterations.
  Collective on the viewer.
  SamStepViewHalves - prints the half widths of contact and stick, if there is contact, and a text. Collective on the
  viewer.
*/
PETSC_INTERN PetscErrorCode SamStepView(const SamStep *step, SamContact contact, PetscBool profile, PetscViewer viewer);
PETSC_INTERN PetscErrorCode SamStepViewHalves(SamContact contact, const char after[], PetscViewer viewer);
/*
  SamReportScaling - prints what a step takes on other numbers of ranks, by a model (run/forecast/scaling.c). `bytes`:
  of the largest rank here, and of it what does not depend on the grid; `lines`: rows of cells. Collective.
*/
PETSC_INTERN PetscErrorCode SamReportScaling(SamReport report, PetscInt lines, int ranks, const double bytes[2],
                                             const SamSimulationStart *start);
/* Chooses the columns of the table of steps: those of the loads that are not 0 in all steps, as many as fit. */
PETSC_INTERN void SamReportChooseColumns(SamReport report, const PetscBool loads[SAM_COMPONENTS]);
/* Returns a number of the last step of a state, or of its last cycle; NaN: there is no number of that name. */
PETSC_INTERN double SamReportNumber(SamState state, const char name[]);
/*
  SamReportHeading - writes the heading of a column, with the unit that its number has on the grid.
  SamReportValue - writes a number, with fewer digits where the column is too narrow for them and a space.
  SamReportSeconds - writes seconds, as an integer from 1000 on.
  SamReportLine - prints the cells of a line except empty ones, after those that wait; while lines wait, it waits, too.
  SamReportPrintHeld - prints the lines that wait. Both are collective.
*/
PETSC_INTERN void SamReportHeading(SamGrid grid, SamState state, const SamReportColumn *column, SamReportCell cell);
PETSC_INTERN void SamReportValue(const SamReportColumn *column, double value, SamReportCell cell);
PETSC_INTERN void SamReportSeconds(double seconds, SamReportCell cell);
PETSC_INTERN PetscErrorCode SamReportPrintHeld(SamReport report);
PETSC_INTERN PetscErrorCode SamReportLine(SamReport report, PetscInt count, const SamReportColumn columns[],
                                          SamReportCell cells[]);
/* Prints a step as a line, the first below the heading; `left`: estimated time (s) of the other steps. Collective. */
PETSC_INTERN PetscErrorCode SamReportStepLine(SamReport report, const SamStep *step, SamContact contact, double seconds,
                                              double left);
/* Decides by -progress if the line is shown: `auto` depends on the destination of stdout. Not collective. */
PETSC_INTERN void SamProgressStart(SamReport report);
/* Adds monitors to a contact's solvers, once. Not collective. */
PETSC_INTERN PetscErrorCode SamProgressWatch(SamReport report, SamContact contact);
/* Erases the line on the terminal. Not collective. */
PETSC_INTERN void SamProgressErase(SamReport report);
/* Returns the seconds spent on the parts of the closing table so far, the largest of all ranks each. Collective. */
PETSC_INTERN PetscErrorCode SamReportGetPartTime(SamReport report, double *seconds);
/* Writes seconds as h:mm:ss. */
PETSC_INTERN void SamReportDuration(double seconds, char text[], size_t size);

#endif

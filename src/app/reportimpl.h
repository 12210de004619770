/* What the files of the report share. */
#ifndef PETSAM_REPORTIMPL_H
#define PETSAM_REPORTIMPL_H

#include <petsam/private/baseimpl.h>
#include "report.h"

#define SAM_REPORT_FILES  8
#define SAM_REPORT_RECENT 5 /* steps of which the mean gives the time left */

typedef enum { SAM_PROGRESS_AUTO, SAM_PROGRESS_ALWAYS, SAM_PROGRESS_NEVER } SamProgressMode;

/* The line within a step; only rank 0 has something to show. */
typedef struct {
  PetscBool active;   /* on this rank */
  double    after;    /* seconds into a step from which it is shown */
  double    shown_at; /* when last */
  int       length;   /* of the text on the terminal */
} SamProgress;

/* A solution's largest residual so far, and its step. */
typedef struct {
  PetscReal residual;
  PetscInt  step;
} SamReportWorst;

struct _n_SamReport {
  /* what the user set */
  MPI_Comm    comm;
  PetscBool   quiet;
  const char *restart; /* the checkpoint from which the run goes on; NULL: none */
  PetscInt    restart_step;
  /* status */
  PetscMPIInt    rank;
  PetscBool      logging;                   /* PETSc's log holds the times */
  double         start, first, begin;       /* of the report, of the first step, of this one (MPI_Wtime) */
  double         output_before;             /* seconds of results and checkpoints in the set-up */
  double         recent[SAM_REPORT_RECENT]; /* seconds of the last steps */
  PetscInt       steps, number, done;
  SamReportWorst worst[3]; /* normal, tangential, equilibrium */
  SamProgress    progress;
  SamContact     contact; /* whose monitors are set; borrowed */
  /* files written */
  char    *name[SAM_REPORT_FILES], *content[SAM_REPORT_FILES];
  PetscInt files;
};

/* Sets progress from -progress and from where stdout goes. */
PETSC_INTERN PetscErrorCode SamProgressSetFromOptions(SamReport report, const SamOptions *from);
/* Adds the monitors of a contact's solvers, once. */
PETSC_INTERN PetscErrorCode SamProgressWatch(SamReport report, SamContact contact);
/* Takes the line off the terminal. Not collective. */
PETSC_INTERN void SamProgressErase(SamReport report);
/* Seconds spent on results and checkpoints so far, the largest rank's. Collective. */
PETSC_INTERN PetscErrorCode SamReportGetOutputTime(SamReport report, double *seconds);
/* Seconds as h:mm:ss. */
PETSC_INTERN void SamReportDuration(double seconds, char text[], size_t size);

#endif

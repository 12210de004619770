/* What the files of the report share. */
#ifndef PETSAM_REPORTIMPL_H
#define PETSAM_REPORTIMPL_H

#include <petsam/private/baseimpl.h>
#include "report.h"

#define SAM_REPORT_FILES  8
#define SAM_REPORT_RECENT 5 /* the mean time of so many steps gives the estimate of the time left */

typedef enum { SAM_PROGRESS_AUTO, SAM_PROGRESS_ALWAYS, SAM_PROGRESS_NEVER } SamProgressMode;

/* The progress line within a step, which only rank 0 shows. */
typedef struct {
  PetscBool active;   /* whether this rank shows it */
  double    after;    /* shown after so many seconds of a step */
  double    shown_at; /* when it was updated last (MPI_Wtime) */
  int       length;   /* characters on the terminal, to be erased */
} SamProgress;

/* A solution's largest residual so far, and its step. */
typedef struct {
  PetscReal residual;
  PetscInt  step;
} SamReportWorst;

struct _n_SamReport {
  /* what the user set */
  MPI_Comm  comm;
  PetscBool quiet;
  /* status */
  PetscMPIInt    rank;
  PetscBool      logging;                   /* whether PETSc's log has the times */
  double         start, first, begin;       /* MPI_Wtime() at the start of the report, of the first step, of this one */
  double         output_before;             /* seconds spent on results and checkpoints before the first step */
  double         recent[SAM_REPORT_RECENT]; /* seconds of the last steps */
  PetscInt       steps, number, done;
  PetscInt       cycles;   /* lines printed for computed cycles */
  PetscReal      jump;     /* cycles, of the last of these */
  PetscBool      living;   /* the run is a life */
  SamReportWorst worst[3]; /* normal, tangential, equilibrium */
  SamReportWorst edges;    /* the least share of the edges that is reconstructed; step 0: none is asked for */
  PetscInt       uncorrected, touching; /* steps that could not be corrected for their edges; in contact */
  SamProgress    progress;
  SamContact     contact;          /* whose monitors are set; borrowed */
  SamExtent      extent;           /* of the contact in step `extent_step`, */
  PetscInt       extent_step;      /* from 1; 0: not known */
  PetscBool      edge_told;        /* that the contact is at the edge, which is allowed */
  PetscBool      uncorrected_told; /* that an edge is not corrected */
  /* files written */
  char    *name[SAM_REPORT_FILES], *content[SAM_REPORT_FILES];
  PetscInt files;
};

/* Reads -progress and decides whether to show the line: `auto` depends on where stdout goes. Collective. */
PETSC_INTERN PetscErrorCode SamProgressSetFromOptions(SamReport report, const SamOptions *from);
/* Adds monitors to a contact's solvers, once. Not collective. */
PETSC_INTERN PetscErrorCode SamProgressWatch(SamReport report, SamContact contact);
/* Erases the line on the terminal. Not collective. */
PETSC_INTERN void SamProgressErase(SamReport report);
/* Seconds spent on results and checkpoints so far, the largest of all ranks. Collective. */
PETSC_INTERN PetscErrorCode SamReportGetOutputTime(SamReport report, double *seconds);
/* Seconds as h:mm:ss. */
PETSC_INTERN void SamReportDuration(double seconds, char text[], size_t size);

#endif

/* A run of the program: objects from options, load steps, results, checkpoints. */
#ifndef PETSAM_RUNIMPL_H
#define PETSAM_RUNIMPL_H

#include <petsam.h>
#include <petsam/advice.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/arguments.h>
#include "checkpoints.h"
#include "report.h"
#include "wearing.h"

/* What the memory of a run depends on besides the grid. */
typedef struct {
  PetscBool friction, coupled, deferred, plastic, wear, life, stiffness;
  PetscInt  steps;
  PetscInt  sums; /* fields that are sums over the steps */
} SamRunNeeds;

typedef struct {
  SamSetup          setup;
  SamWearing        wearing;
  SamWear           wear; /* NULL: none */
  SamLife           life; /* NULL: none */
  SamHistory        history;
  SamOutput         output;
  SamOutputSettings output_settings;
  SamCheckpoints    checkpoints;
  SamParameters     parameters;
  SamReport         report;
  SamRunNeeds       needs;
  SamRunPoint       point;   /* position in the load program; steps before a restart count too */
  PetscBool         stopped; /* before its end, with a checkpoint */
  PetscInt          output_every;
  PetscBool         has_output;
  PetscBool         restart_gap; /* goes on with another gap than the stopped run's */
  PetscBool         told;        /* in a life: the step that failed is in the file */
  PetscBool         warned;      /* a warning has been printed in this life */
  PetscReal         last_time;   /* of the last step that was written, s; -infinity: none */
  PetscBool         writing;     /* a collective write is under way */
  char              filename[PETSC_MAX_PATH_LEN];
  char              checkpoint_text[PETSC_MAX_PATH_LEN + 256]; /* when checkpoints are written */
  SamLoadsMost      most;                                      /* the largest loads of the steps from here on */
  PetscInt          largest;   /* step of the largest normal load or approach among them, from 0 */
  PetscBool         examined;  /* whether the size of the contact was looked at */
  PetscBool         wear_told; /* that a step wears more than it may */
} SamRun;

/* SamRunSetUp - reads all options and input files and makes all objects; writes nothing. Collective. */
PETSC_INTERN PetscErrorCode SamRunSetUp(SamRun *run, const SamArguments *arguments);
/*
  SamRunCheckFiles - refuses names by which the run would replace a file that it reads, or one file of its own by
  another, and viewers of PETSc that cannot be opened. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamRunCheckFiles(const SamRun *run, MPI_Comm comm, const SamArguments *arguments);
/* SamRunSolve - banner, restart, all load steps with their results and checkpoints, closing table. Collective. */
PETSC_INTERN PetscErrorCode SamRunSolve(SamRun *run);
/*
  SamRunOpenResults - opens the results. After a restart (`checkpoint` NULL: none) it goes on with a file that is there;
  a new name begins a file with the steps from there on. Collective. Errors: SAM_ERR_FILE, SAM_ERR_USER.
  SamRunForecast - how large the results will be, in words; warns where the disk has not that much space. Collective.
*/
PETSC_INTERN PetscErrorCode SamRunOpenResults(SamRun *run, const char checkpoint[]);
PETSC_INTERN PetscErrorCode SamRunForecast(SamRun *run, char text[], size_t size);
/* SamRunCreateWear - makes what wears, once there is a contact. Collective. */
PETSC_INTERN PetscErrorCode SamRunCreateWear(SamRun *run);
/* SamRunLive - the cycles of a life, with their results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamRunLive(SamRun *run);
/*
  SamRunWriteLastFields - makes sure that the fields of the step that was solved last are in the file, at the time of
  the last step that was written; for when the next one has no solution. Collective.
*/
PETSC_INTERN PetscErrorCode SamRunWriteLastFields(SamRun *run);
/* SamRunComputeStiffness - that of a step that is tried, where it is wanted and the step is solved. Collective. */
PETSC_INTERN PetscErrorCode SamRunComputeStiffness(SamRun *run, SamStep *step);
/* SamRunWriteStep - writes a step's numbers and, when they are due, its fields. Collective. */
PETSC_INTERN PetscErrorCode SamRunWriteStep(SamRun *run, const SamStep *step, PetscBool due);
/* SamRunCheckpoint - after a step or jump: writes a checkpoint if one is due; may stop the run. Collective. */
PETSC_INTERN PetscErrorCode SamRunCheckpoint(SamRun *run);
/*
  What a user should know besides (advice.c). SamRunPrepareAdvice - before the first step: finds the largest loads of
  the steps from `first` on, and warns of options that are unlikely to be meant. SamRunAdviseEdge - appends to the
  message of a step at the grid's edge a grid that is large enough. SamRunExamine - after step k: if it has the largest
  load, warns of too few cells, of a contact too large for half-spaces, of none, and of
  motions that are not small, once in a run. SamRunExamineWear - after step k, which has a solution and has worn: warns,
  once in a run, of more wear than a step may have. Collective.
*/
PETSC_INTERN PetscErrorCode SamRunPrepareAdvice(SamRun *run, PetscInt first);
PETSC_INTERN PetscErrorCode SamRunExamineWear(SamRun *run, PetscInt k);
PETSC_INTERN PetscErrorCode SamRunAdviseEdge(const SamRun *run, SamStep *step);
PETSC_INTERN PetscErrorCode SamRunExamine(SamRun *run, PetscInt k, const SamStep *step);
/* SamRunTearDown - destroys all objects, also after an error. Collective. */
PETSC_INTERN PetscErrorCode SamRunTearDown(SamRun *run);

/* SamRunCollectParameters - fills run->parameters, for results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamRunCollectParameters(SamRun *run);
/* SamRunMemory - the memory that this rank will need, bytes. Not collective. */
PETSC_INTERN double SamRunMemory(SamGrid grid, const SamRunNeeds *needs);
/*
  SamRunRefuseTooLarge - refuses a run that a node has not enough memory for, before the system would kill it; option
  -memory_check false skips this. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamRunRefuseTooLarge(SamGrid grid, const SamRunNeeds *needs, const SamOptions *from);

#endif

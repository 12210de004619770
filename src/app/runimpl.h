/* A run of the program: objects from options, load steps, results, checkpoints. */
#ifndef PETSAM_RUNIMPL_H
#define PETSAM_RUNIMPL_H

#include <petsam.h>
#include <petsam/private/baseimpl.h>
#include "checkpoints.h"
#include "report.h"

/* What the memory of a run depends on, besides the grid. */
typedef struct {
  PetscBool friction, coupled;
  PetscInt  steps;
} SamRunNeeds;

typedef struct {
  SamGrid           grid;
  SamPair           pair;
  SamGap            gap;
  SamElasticity     elasticity;
  SamProblem        problem;
  SamContact        contact;
  SamHistory        history;
  SamOutput         output;
  SamOutputSettings output_settings;
  SamCheckpoints    checkpoints;
  SamParameters     parameters;
  SamReport         report;
  SamRunNeeds       needs;
  SamRunPoint       point;   /* where the run is, steps before a restart included */
  PetscBool         stopped; /* before the end, with a checkpoint */
  PetscInt          output_every;
  PetscBool         has_output;
  PetscBool         writing; /* a collective write is under way */
  char              filename[PETSC_MAX_PATH_LEN];
} SamRun;

/* SamRunSetUp - reads every option and makes every object, but writes nothing. Collective. */
PETSC_INTERN PetscErrorCode SamRunSetUp(SamRun *run);
/* SamRunSolve - banner, restart, all load steps with what is kept of them, closing table. Collective. */
PETSC_INTERN PetscErrorCode SamRunSolve(SamRun *run);
PETSC_INTERN PetscErrorCode SamRunTearDown(SamRun *run);

/* SamRunCollectParameters - what defines the run, for its results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamRunCollectParameters(SamRun *run);
/* SamRunMemory - what this rank will need, bytes. */
PETSC_INTERN double SamRunMemory(SamGrid grid, const SamRunNeeds *needs);
/*
  SamRunRefuseTooLarge - raises SAM_ERR_USER for what this node cannot hold, before the system kills the run for it; not
  with -memory_check false. Collective.
*/
PETSC_INTERN PetscErrorCode SamRunRefuseTooLarge(SamGrid grid, const SamRunNeeds *needs, const SamOptions *from);

#endif

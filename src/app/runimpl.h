/* A run of the program: objects from options, load steps, results, checkpoints. */
#ifndef PETSAM_RUNIMPL_H
#define PETSAM_RUNIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam.h>

typedef struct {
  SamGrid        grid;
  SamPair        pair;
  SamGap         gap;
  SamElasticity  elasticity;
  Vec            separation; /* until the contact has its own */
  SamContact     contact;
  SamOutput      output;
  SamCheckpoints checkpoints;
  SamParameters  parameters;
  PetscReal      friction;
  SamHistory     history;
  SamReport      report;
  SamStatus      status;               /* the worst so far */
  PetscBool      stopped;              /* before the end, with a checkpoint */
  PetscInt       output_every, solved; /* solved: load steps so far, those before a restart included */
  PetscBool      has_output, writing;  /* writing: a collective write is under way */
  char           filename[PETSC_MAX_PATH_LEN];
} SamRun;

/* SamRunSetUp - reads every option and makes every object, but writes nothing. Collective. */
PETSC_INTERN PetscErrorCode SamRunSetUp(SamRun *run);
/* SamRunSolve - banner, restart, all load steps with what is kept of them, closing table. Collective. */
PETSC_INTERN PetscErrorCode SamRunSolve(SamRun *run);
PETSC_INTERN PetscErrorCode SamRunTearDown(SamRun *run);

/* SamRunCollectParameters - what defines the run, for its results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamRunCollectParameters(SamRun *run, Vec separation);
/* SamRunMemory - what this rank will need, bytes. */
PETSC_INTERN double SamRunMemory(SamGrid grid, const SamPair *pair, PetscReal friction, PetscInt steps);
/*
  SamRunRefuseTooLarge - raises SAM_ERR_USER for what this node cannot hold, before the system kills the run for it.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamRunRefuseTooLarge(SamGrid grid, const SamPair *pair, PetscReal friction, PetscInt steps);

#endif

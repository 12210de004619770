/* When a run writes checkpoints, when it stops, and how it goes on from one. */
#ifndef PETSAM_APP_CHECKPOINTS_H
#define PETSAM_APP_CHECKPOINTS_H

#include <petsam/checkpoint.h>
#include "history.h"

/* How far a run is in its load program. */
typedef struct {
  SamHistory history;
  PetscInt   steps; /* solved so far */
  SamStatus  worst; /* of these */
} SamRunPoint;

/*
  SamCheckpoints - when a run writes checkpoints, and when it stops: every so many steps, on the signals USR2 (write, go
  on) and USR1 (write, stop) to any rank, and before a time limit.
*/
typedef struct _n_SamCheckpoints *SamCheckpoints;

/*
  SamCheckpointsCreateFromOptions - reads -checkpoint (file), -checkpoint_every (load steps, 0: only on signals and
  before the limit), -max_walltime (seconds, m:s or h:m:s from here on) and -restart (file); catches both signals from
  now on. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsCreateFromOptions(const SamOptions *from, SamCheckpoints *checkpoints);
PETSC_INTERN PetscErrorCode SamCheckpointsDestroy(SamCheckpoints *checkpoints);
/* SamCheckpointsGetNames - of -checkpoint and -restart, NULL without; borrowed. Not collective. */
PETSC_INTERN PetscErrorCode SamCheckpointsGetNames(SamCheckpoints checkpoints, const char **checkpoint,
                                                   const char **restart);
/*
  SamCheckpointsRestart - gives the contact the state in the file of -restart, and says how far it is. Collective. Errors:
  those of SamCheckpointRead(); SAM_ERR_USER where the load program up to there is another.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsRestart(SamCheckpoints checkpoints, SamContact contact,
                                                  const SamParameters *parameters, SamRunPoint *progress);
/* SamCheckpointsBegin - the first step begins; fails early if the checkpoint cannot be written. Collective. */
PETSC_INTERN PetscErrorCode SamCheckpointsBegin(SamCheckpoints checkpoints, SamGrid grid);
/*
  SamCheckpointsAfterStep - writes a checkpoint if one is due, and says whether to stop, which is when a signal says so or
  when the next step, taken to be as slow as the slowest of the last ones, and a checkpoint after it would not end before
  the limit. Never stops after the last step. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsAfterStep(SamCheckpoints checkpoints, SamContact contact,
                                                    const SamParameters *parameters, const SamRunPoint *progress,
                                                    PetscBool *stop);
/* SamCheckpointsGetLast - the step after which the last one was written, 0: none yet. Not collective. */
PETSC_INTERN PetscErrorCode SamCheckpointsGetLast(SamCheckpoints checkpoints, PetscInt *step);

#endif

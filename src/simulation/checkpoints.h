/* When a simulation writes checkpoints, when it stops, and how it goes on from one. */
#ifndef PETSAM_CHECKPOINTS_H
#define PETSAM_CHECKPOINTS_H

#include <petsam/checkpoint.h>
#include <petsam/history.h>
#include <petsam/life.h>
#include <signal.h>

/* The position of a simulation in its load program. */
typedef struct {
  SamHistory history;
  SamOutput  output;                      /* results, which must be in their file when a checkpoint is; NULL: none */
  SamLife    life;                        /* NULL: none */
  PetscReal  cycles;                      /* of the life */
  PetscInt   steps;                       /* number of steps solved so far, of computed cycles in a life */
  PetscInt   rows;                        /* number of computed cycles that were written */
  PetscInt   first;                       /* steps before those of the results file, 0: it begins with the history */
  PetscInt   first_row;                   /* computed cycles before those of the results file */
  uint64_t   times;                       /* checksum of the times of the steps of the results file */
  SamStatus  worst;                       /* worst status of the steps */
  char       results[PETSC_MAX_PATH_LEN]; /* the file, as it was named; empty: none */
  PetscBool  restarted;                   /* goes on from a checkpoint */
} SamSimulationPoint;

/*
  SamCheckpoints - decides when a simulation writes a checkpoint and when it stops: a checkpoint every so many steps; a
  checkpoint when a signal to any rank asks for it; a checkpoint and the end at another signal, and before a time limit.
*/
typedef struct _n_SamCheckpoints *SamCheckpoints;

/*
  SamCheckpointsCreateFromOptions - reads -checkpoint (file), -checkpoint_every (load steps; 0: only at signals and at
  the limit), -max_walltime (seconds, m:s or h:m:s, counted from this call), -restart (file) and -restart_gap.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsCreateFromOptions(const SamOptions *from, SamCheckpoints *checkpoints);
PETSC_INTERN PetscErrorCode SamCheckpointsDestroy(SamCheckpoints *checkpoints);
/* SamCheckpointsSetSignals - see SamSimulationSetSignals(); NULL: none. Not collective. */
PETSC_INTERN PetscErrorCode SamCheckpointsSetSignals(SamCheckpoints checkpoints, volatile sig_atomic_t signals[2]);
/*
  SamCheckpointsGetNames - the files of -checkpoint and -restart, NULL without one; borrowed. NULL for what is not
  wanted. Not collective.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsGetNames(SamCheckpoints checkpoints, const char **checkpoint,
                                                   const char **restart);
/* SamCheckpointsChangeGap - whether the gap may differ from that of the checkpoint. Not collective. */
PETSC_INTERN PetscBool SamCheckpointsChangeGap(SamCheckpoints checkpoints);
/* SamCheckpointsDescribe - says when it writes checkpoints; empty without -checkpoint. Not collective. */
PETSC_INTERN void SamCheckpointsDescribe(SamCheckpoints checkpoints, char text[], size_t size);
/*
  SamCheckpointsRestart - gives the contact the state in the file of -restart, and sets steps and worst status in
  `progress`, whose history is given. Collective. Errors: those of SamCheckpointRead(); SAM_ERR_USER when up to there
  the load program differs from that of the stopped run.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsRestart(SamCheckpoints checkpoints, SamContact contact,
                                                  const SamParameters *parameters, SamSimulationPoint *progress);
/*
  SamCheckpointsBegin - to be called before the first step, whose time starts here; `steps`: those before it. Fails
  early if the checkpoint cannot be written. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsBegin(SamCheckpoints checkpoints, SamGrid grid, PetscInt steps);
/*
  SamCheckpointsAfterStep - writes a checkpoint if one is due, and sets `stop`: at a signal, or when the next step and a
  checkpoint after it would not end before the time limit. The next step is assumed to be as slow as the slowest of the
  last ones. Never stops after the last step. `said` becomes where and why it stops, or else a warning; empty: nothing
  to say. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamCheckpointsAfterStep(SamCheckpoints checkpoints, SamContact contact,
                                                    const SamParameters *parameters, const SamSimulationPoint *progress,
                                                    PetscBool *stop, char said[], size_t size);
/* SamCheckpointsGetLast - the step after which the last checkpoint was written, 0: none yet. Not collective. */
PETSC_INTERN PetscErrorCode SamCheckpointsGetLast(SamCheckpoints checkpoints, PetscInt *step);

#endif

/* Checkpoints: the state of a run on the disk, when it is written, and how a run goes on from it. */
#ifndef PETSAM_CHECKPOINT_H
#define PETSAM_CHECKPOINT_H

#include <petsam/history.h>
#include <petsam/output.h>

/*
  SamCheckpointWrite - the state of a contact after so many load steps of a history, in an HDF5 file that all ranks
  write together. It is written beside (name.tmp), brought to the disk, and renamed; the one before it becomes name.1.
  Whatever ends the run, there is a checkpoint that can be read if there was one. `worst`: of the steps so far.
  Collective. Errors: SAM_ERR_FILE; the checkpoints that were there stay.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointWrite(const char filename[], SamContact contact, SamHistory history,
                                               const SamParameters *parameters, PetscInt steps, SamStatus worst);
/*
  SamCheckpointRead - gives a contact the state in a file, to the last bit, on any number of ranks; also the load
  steps that were solved and their worst status. Collective. Errors: SAM_ERR_USER, naming the option, for another
  version, other fixed parameters, or other loads in those steps (what comes after them may differ); SAM_ERR_FILE for a
  file that is missing or damaged, which is told by checksums; then the message names name.1 if that can be read.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact, SamHistory history,
                                              const SamParameters *parameters, PetscInt *steps, SamStatus *worst);
/* SamCheckpointChecksum - of a field (values by cell): the same on any number of ranks. Collective. */
PETSC_EXTERN PetscErrorCode SamCheckpointChecksum(SamGrid grid, Vec field, uint64_t *checksum);

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
PETSC_EXTERN PetscErrorCode SamCheckpointsCreateFromOptions(MPI_Comm comm, SamCheckpoints *checkpoints);
PETSC_EXTERN PetscErrorCode SamCheckpointsDestroy(SamCheckpoints *checkpoints);
/* SamCheckpointsGetNames - of -checkpoint and -restart, NULL without; borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SamCheckpointsGetNames(SamCheckpoints checkpoints, const char **checkpoint,
                                                   const char **restart);
/*
  SamCheckpointsBegin - the first step begins; what can be known of a checkpoint that cannot be written is raised now.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointsBegin(SamCheckpoints checkpoints, SamGrid grid);
/*
  SamCheckpointsAfterStep - after load step `steps` of `count`: writes a checkpoint if one is due, and says whether to
  stop, which is when a signal says so or when the next step, taken to be as slow as the slowest of the last ones, and a
  checkpoint after it would not end before the limit. Never stops after the last step. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointsAfterStep(SamCheckpoints checkpoints, SamContact contact, SamHistory history,
                                                    const SamParameters *parameters, PetscInt steps, SamStatus worst,
                                                    PetscBool *stop);
/* SamCheckpointsGetLast - the step after which the last one was written, 0: none yet. Not collective. */
PETSC_EXTERN PetscErrorCode SamCheckpointsGetLast(SamCheckpoints checkpoints, PetscInt *step);

#endif

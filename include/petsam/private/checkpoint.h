/* Checkpoints: the state of a contact in a file, from which a stopped run continues. */
#ifndef PETSAM_CHECKPOINT_H
#define PETSAM_CHECKPOINT_H

#include <petsam/private/output.h>

/*
  SamNote - integers that a program adds to a checkpoint under a name, such as its position in a load program. With
  a negative count the checkpoint may lack them; they are read as 0 then.
*/
typedef struct {
  const char *name;
  PetscInt    count;
  uint64_t   *values; /* written from here, read into here */
} SamNote;

/*
  SamCheckpoint - the files in which a run keeps its checkpoints: name, name.1 for the one before, and name.tmp for one
  that is being written. Other runs are kept from them, also on other nodes where the file system has locks.
*/
typedef struct _n_SamCheckpoint *SamCheckpoint;
/*
  SamCheckpointCreate - takes hold of the files. Collective. Errors: SAM_ERR_FILE for one that cannot be written, is
  there and is not a checkpoint, or is kept by another run; the handle is NULL then.
  SamCheckpointDestroy - gives them up, frees the object and sets the handle to NULL. Collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointCreate(SamGrid grid, const char filename[], SamCheckpoint *checkpoint);
PETSC_EXTERN PetscErrorCode SamCheckpointDestroy(SamCheckpoint *checkpoint);
/* SamCheckpointNames - the two other names; the caller frees them with PetscFree(). Not collective. */
PETSC_EXTERN PetscErrorCode SamCheckpointNames(const char filename[], char **before, char **temporary);
/*
  SamCheckpointWrite - writes the committed state of a contact, the parameters that define
  it, and a program's n notes to an HDF5 file, all ranks together. The file is written as name.tmp, sealed with a
  checksum, flushed to the disk, and renamed; the previous checkpoint becomes name.1. So once there is a checkpoint,
  there always is one that can be read, whatever ends the run. Collective. Errors: SAM_ERR_FILE; earlier checkpoints are
  kept then.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointWrite(SamCheckpoint checkpoint, SamContact contact,
                                               const SamParameters *parameters, PetscInt n, const SamNote notes[]);
/*
  SamCheckpointRead - gives a contact the state in a file, to the last bit, on any number of ranks, and reads the notes.
  `sums`: the contact accumulates from now on what only the file has accumulated; else such sums are left out. When the
  problem's gap is not the one the checkpoint was written with, the next step solves the pressure again and keeps the
  slip. Collective. Errors: SAM_ERR_USER for a checkpoint of another version, with another value of a fixed parameter,
  or with another field that only one of the two has; the message names it. SAM_ERR_FILE for a file that is missing or
  damaged (its checksum is compared). The message then names the checkpoint before it, name.1, if that can be read.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact, PetscBool sums,
                                              const SamParameters *parameters, PetscInt n, const SamNote notes[]);

#endif

/* Checkpoints: the state of a contact in a file, from which a stopped run continues. */
#ifndef PETSAM_CHECKPOINT_H
#define PETSAM_CHECKPOINT_H

#include <petsam/private/output.h>

/*
  SamNote - integers that a program adds to a checkpoint under a name, such as its position in a load program. If the
  count is negative, the checkpoint may lack them; they are then read as 0.
*/
typedef struct {
  const char *name;
  PetscInt    count;
  uint64_t   *values; /* written from here, read into here */
} SamNote;

/*
  SamCheckpoint - the files in which a run keeps its checkpoints: name, name.1 for the previous checkpoint, and name.tmp
  while a checkpoint is being written. They are locked against other runs, also on other nodes if the file system
  supports locks.
*/
typedef struct _n_SamCheckpoint *SamCheckpoint;
/*
  SamCheckpointCreate - locks the files for this run. Collective. Errors: SAM_ERR_FILE for a file that cannot be
  written, exists but is not a checkpoint, or is locked by another run; the handle is then NULL.
  SamCheckpointDestroy - unlocks the files, frees the object and sets the handle to NULL. Collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointCreate(SamGrid grid, const char filename[], SamCheckpoint *checkpoint);
PETSC_EXTERN PetscErrorCode SamCheckpointDestroy(SamCheckpoint *checkpoint);
/*
  SamCheckpointNames - creates the two other names, name.1 and name.tmp; the caller frees them with PetscFree(). Not
  collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointNames(const char filename[], char **before, char **temporary);
/*
  SamCheckpointPart - another contact that belongs to the one of the checkpoint, as that of a companion run, with the
  notes on it. Its name is that of a group. `there`: set when it is read; false: the checkpoint lacks it, which leaves
  its contact as it is.
  SamCheckpointRest - what a checkpoint stores besides the state of its contact: the parameters that define it, a
  program's n notes, and the parts.
*/
#define SAM_CHECKPOINT_PARTS 3 /* most parts */
typedef struct {
  const char *name;
  SamContact  contact;
  PetscInt    n;
  SamNote    *notes;
  PetscBool   there;
} SamCheckpointPart;
typedef struct {
  const SamParameters *parameters;
  PetscInt             n;
  const SamNote       *notes;
  PetscInt             parts;
  SamCheckpointPart   *part;
} SamCheckpointRest;
/*
  SamCheckpointWrite - writes the committed state of a contact and all the rest to an HDF5 file, all ranks together. The
  file is written as name.tmp, sealed with a checksum, flushed to the disk, and renamed; the previous checkpoint becomes
  name.1. So after the first checkpoint there is always a readable one, whatever ends the run. Collective. Errors:
  SAM_ERR_FILE; earlier checkpoints are then kept.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointWrite(SamCheckpoint checkpoint, SamContact contact,
                                               const SamCheckpointRest *rest);
/*
  SamCheckpointRead - sets a contact and its parts to the state in a file, to the last bit, on any number of ranks, and
  reads the notes. `sums`: true adds to the contact the sums over steps that only the file has; else these are ignored.
  If the gap of the problem differs from that of the checkpoint, the next step solves the pressure again and keeps the
  slip. Collective. Errors: SAM_ERR_USER for a checkpoint of another version, with another value of a fixed parameter,
  or with a field that only one of the two has; the message names it. SAM_ERR_FILE for a file that is missing or damaged
  (its checksum is compared). The message then names the checkpoint before it, name.1, if that can be read.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact, PetscBool sums,
                                              const SamCheckpointRest *rest);

#endif

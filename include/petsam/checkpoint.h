/* Checkpoints: the state of a contact on the disk. */
#ifndef PETSAM_CHECKPOINT_H
#define PETSAM_CHECKPOINT_H

#include <petsam/output.h>

/* SamNote - whole numbers that a program keeps in a checkpoint under a name, such as how far its load program is. */
typedef struct {
  const char *name;
  PetscInt    count;
  uint64_t   *values; /* written from here, read to here */
} SamNote;

/*
  SamCheckpointWrite - the committed state of a contact, what defines it, and a program's notes (n of them), in an HDF5
  file that all ranks write together. It is written beside (name.tmp), brought to the disk, and renamed; the one before
  it becomes name.1. Whatever ends the run, there is a checkpoint that can be read if there was one. Collective. Errors:
  SAM_ERR_FILE; the checkpoints that were there stay.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointWrite(const char filename[], SamContact contact,
                                               const SamParameters *parameters, PetscInt n, const SamNote notes[]);
/*
  SamCheckpointRead - gives a contact the state in a file, to the last bit, on any number of ranks, and reads the notes.
  Where the problem has another gap now than then, the next step finds the pressure anew, and slip goes on. Collective.
  Errors: SAM_ERR_USER, naming the parameter, for another version or other fixed parameters; SAM_ERR_FILE for a file that
  is missing or damaged, which is told by checksums; then the message names name.1 if that can be read.
*/
PETSC_EXTERN PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact,
                                              const SamParameters *parameters, PetscInt n, const SamNote notes[]);
/* SamCheckpointCheckName - raises SAM_ERR_FILE unless a checkpoint of that name could be written. Collective. */
PETSC_EXTERN PetscErrorCode SamCheckpointCheckName(SamGrid grid, const char filename[]);
/* SamCheckpointChecksum - of a field (values by cell): the same on any number of ranks. Collective. */
PETSC_EXTERN PetscErrorCode SamCheckpointChecksum(SamGrid grid, Vec field, uint64_t *checksum);

#endif

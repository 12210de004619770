/* Whether a node has the memory that is needed. */
#ifndef PETSAM_APP_MEMORY_H
#define PETSAM_APP_MEMORY_H

#include <petsam/base.h>

#define SAM_MEMORY_PROGRAM 50e6 /* bytes of a program and its libraries, on each rank */

/*
  SamMemoryRefuse - refuses what a node has not enough memory for, before the system would kill it; `bytes`: what this
  rank will need. The option and its value are named in the message. Option -memory_check false skips this. Collective.
  Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMemoryRefuse(MPI_Comm comm, double bytes, const char option[], const char value[],
                                            const SamOptions *from);

#endif

/* A run of the program petsam: a simulation, and the report of it. */
#ifndef PETSAM_RUNIMPL_H
#define PETSAM_RUNIMPL_H

#include <petsam/private/arguments.h>
#include <petsam/simulation.h>
#include "report.h"

typedef struct {
  SamSimulation simulation;
  SamReport     report;
} SamRun;

/*
  SamRunCheckFiles - refuses names by which the run would replace a file that it reads, or one file of its own by
  another, and viewers of PETSc that cannot be opened. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamRunCheckFiles(const SamRun *run, MPI_Comm comm, const SamArguments *arguments);
/* SamRunMemory - the memory that this rank will need, bytes. Not collective. */
PETSC_INTERN PetscErrorCode SamRunMemory(SamSimulation simulation, double *bytes);
/*
  SamRunRefuseTooLarge - refuses a run that a node has not enough memory for, before the system would kill it; option
  -memory_check false skips this. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamRunRefuseTooLarge(SamSimulation simulation, const SamOptions *from);

#endif

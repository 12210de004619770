/*
  MPI and PETSc in a process of another program.

  If MPI and PETSc are started here, they are finalized when the process ends, unless the process has finalized MPI
  itself; then PETSc is not finalized either. PETSc's world communicator contains a single process, so that each process
  can start PETSc independently; PETSc's objects nevertheless use the communicators that they are given.
*/
#include "embedimpl.h"
#include <petsam/private/arguments.h>
#include <stdlib.h>

static PetscBool began_mpi = PETSC_FALSE, began_petsc = PETSC_FALSE;

static void End(void)
{
  PetscBool has;
  int       ended;

  if (MPI_Finalized(&ended) || ended) return;
  if (began_petsc && !PetscInitialized(&has) && has) {
    (void)SamFinalize();
    (void)PetscFinalize();
  }
  if (began_mpi) (void)MPI_Finalize();
}

static int StartMPI(void)
{
  int has, ended, provided;

  if (MPI_Finalized(&ended) || ended) return SAM_EMBED_USAGE;
  if (MPI_Initialized(&has)) return SAM_EMBED_USAGE;
  if (has) return 0;
  (void)SamPrepareMPI();
  if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided)) return SAM_EMBED_USAGE;
  SamForgetPreparation();
  began_mpi = PETSC_TRUE;
  return 0;
}

int SamEmbedStart(char message[], size_t size)
{
  static char *words[] = {"petsam", "-no_signal_handler", "-skip_petscrc", NULL};
  static int   registered;

  SamArguments arguments;
  char       **argv = words;
  int          argc = 3;
  PetscBool    has;

  if (StartMPI()) {
    (void)snprintf(message, size, "MPI cannot be started: it has been finalized in this process, or its start fails");
    return SAM_EMBED_USAGE;
  }
  if (!registered) (void)atexit(End);
  registered = 1;
  if (!PetscInitialized(&has) && has) return 0;
  SamArgumentsExamineText(MPI_COMM_SELF, getenv("PETSC_OPTIONS"), &arguments);
  SamArgumentsFree(&arguments);
  if (arguments.code) {
    (void)snprintf(message, size, "PETSC_OPTIONS: %s", arguments.message);
    return SAM_EMBED_USAGE;
  }
  PETSC_COMM_WORLD = MPI_COMM_SELF;
  began_petsc      = PETSC_TRUE;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) {
    (void)snprintf(message, size, "PETSc cannot be started: check PETSC_OPTIONS");
    return SAM_EMBED_USAGE;
  }
  return 0;
}

/*
  The program: the command line, errors and exit codes around a run (run.c).

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file cannot be used; 10 not converged; 11 no equilibrium; 12
  contact at the grid's edge; 75 stopped with a checkpoint; others are PETSc's. Nothing is written before all input has
  been read and checked.
*/
#include "runimpl.h"
#include <hdf5.h>
#include <malloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_USAGE = 2, EXIT_FILE = 3, EXIT_STOPPED = 75 };

static const char usage[] =
  "petsam " PETSAM_VERSION ": partial-slip contact of elastic bodies by the semi-analytical method.\n"
  "\n"
  "  petsam [-option value ...]\n"
  "  mpirun -n 4 petsam -options_file study.opts [-option value ...]\n"
  "\n"
  "All quantities in SI units; defaults in parentheses. Required: -grid_n, -grid_size, -body1_young, -body1_poisson,\n"
  "-body2_young, -body2_poisson, -gap_type with its radii, and one of -load_n, -disp_z. For example, two steel "
  "spheres\n"
  "pressed together and pushed sideways:\n"
  "\n"
  "  petsam -grid_n 256 -grid_size 2.6e-3 -body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 \\\n"
  "    -body2_poisson 0.3 -gap_type sphere -gap_radius1 0.2 -gap_radius2 0.2 -friction 0.1 -load_n 1000 -load_tx 60 "
  "\\\n"
  "    -output sphere.h5\n"
  "\n"
  "-help prints this, -version the version. PETSc's options work too (-options_file, -log_view, ...).\n"
  "Exit codes: 0 converged, 2 bad usage, 3 a file cannot be used, 10 not converged, 11 no equilibrium,\n"
  "12 contact at the grid's edge, 75 stopped with a checkpoint.\n";

/* ---- errors ---- */

/* Whether an error has occurred that the other ranks may not know of. */
static PetscBool alone = PETSC_FALSE;
/* Whether an MPI launcher has started the program. */
static PetscBool launched = PETSC_TRUE;

/* Errors that a line explains; of all others PETSc prints a trace. */
static PetscBool IsPlain(PetscErrorCode code)
{
  return (code == SAM_ERR_USER || code == SAM_ERR_FILE || code == PETSC_ERR_NOT_CONVERGED || code == PETSC_ERR_MEM)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Prints an error as one line: one that all ranks have met from rank 0. */
static PetscErrorCode HandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *context)
{
  PetscMPIInt rank, ranks = 1, all = 1;

  (void)context;
  if (!IsPlain(code)) return PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, NULL);
  if (type != PETSC_ERROR_INITIAL) return code;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &all);
  MPI_Comm_size(comm, &ranks);
  if (ranks < all) alone = PETSC_TRUE;
  if (code == PETSC_ERR_MEM)
    fprintf(stderr, "petsam: rank %d has not enough memory: %s\n", rank, message);
  else if (rank == 0 || ranks < all)
    fprintf(stderr, "petsam: %s\n", message);
  if (code == SAM_ERR_USER && rank == 0) fprintf(stderr, "petsam: see petsam -help for the options\n");
  return code;
}

static int ExitCode(PetscErrorCode code)
{
  if (code == SAM_ERR_USER) return EXIT_USAGE;
  if (code == SAM_ERR_FILE) return EXIT_FILE;
  if (code == PETSC_ERR_NOT_CONVERGED) return SAM_STATUS_NOT_CONVERGED;
  return code;
}

/* While PETSc starts, each of its errors is one of the options that it reads. */
static PetscErrorCode HandleErrorAtStart(MPI_Comm comm, int line, const char *function, const char *file,
                                         PetscErrorCode code, PetscErrorType type, const char *message, void *context)
{
  int rank;

  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  (void)context;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (type == PETSC_ERROR_INITIAL && rank == 0)
    fprintf(stderr, "petsam: PETSc cannot take the options: %s\n", message ? message : "");
  return code;
}

/* Ends the program where PETSc could not start; the other ranks may still be starting. */
static int GiveUpStarting(void)
{
  int ranks;

  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) (void)MPI_Abort(MPI_COMM_WORLD, EXIT_USAGE);
  (void)MPI_Finalize();
  return EXIT_USAGE;
}

/* ---- the surroundings ---- */

/*
  Makes malloc() map large fields from the system and return them to it when they are freed. SuperLU_DIST, which PETSc
  may link, switches that off for the whole program; half of the memory would then be lost to fragmentation.
*/
static void ReturnLargeFields(void)
{
#if defined(__GLIBC__)
  (void)mallopt(M_MMAP_MAX, 65536);
  (void)mallopt(M_MMAP_THRESHOLD, 16 << 20); /* smaller fields are allocated in every step, and are faster reused */
#endif
}

/*
  Without an MPI launcher no network is needed. Open MPI would look for one and start a daemon, which takes longer than
  a small problem and is not possible everywhere. Settings of the user are not changed.
*/
static void PrepareMPI(void)
{
#if defined(OPEN_MPI)
  static const char *const signs[] = {
    "OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK", "PMI_ID", "PMI_FD", "PMI_SIZE", "SLURM_STEP_ID",
    "ALPS_APP_PE",          NULL};

  (void)setenv("OMPI_MCA_sharedfp", "^sm", 0); /* its semaphores fail where /dev/shm is full */
  launched = PETSC_FALSE;
  for (int k = 0; signs[k]; k++)
    if (getenv(signs[k])) launched = PETSC_TRUE;
  if (launched) return;
  (void)setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  (void)setenv("OMPI_MCA_orte_create_session_dirs", "0", 0); /* else concurrent programs would share one */
  (void)setenv("OMPI_MCA_pml", "ob1", 0);
  (void)setenv("OMPI_MCA_btl", "self", 0);
#endif
}

/* Signals at which PETSc would print a trace, though nothing is wrong in the program; nohup has one ignored. */
static const int usual[] = {SIGHUP, SIGQUIT, SIGTERM, SIGPIPE, SIGURG};
enum { USUAL = sizeof(usual) / sizeof(usual[0]) };

/* Starts PETSc, which leaves these signals as they were. Returns its error code. */
static PetscErrorCode StartPetsc(int *argc, char ***argv)
{
  struct sigaction before[USUAL];
  PetscErrorCode   code;

  for (int k = 0; k < USUAL; k++) (void)sigaction(usual[k], NULL, &before[k]);
  code = SamHistoryClaimOption();
  if (!code) code = PetscPushErrorHandler(HandleErrorAtStart, NULL);
  if (!code) code = PetscInitialize(argc, argv, NULL, NULL);
  for (int k = 0; k < USUAL; k++) (void)sigaction(usual[k], &before[k], NULL);
  return code;
}

/* ---- the program ---- */

static PetscErrorCode RunProgram(SamRun *run, const SamArguments *arguments)
{
  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCheck(!arguments->code, PETSC_COMM_WORLD, arguments->code, "%s", arguments->message);
  if (arguments->version) {
    char petsc[256];

    PetscCall(PetscGetVersion(petsc, sizeof(petsc)));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "petsam %s\n%s\n", PETSAM_VERSION, petsc));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (arguments->help) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s", usage));
    PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
    PetscCall(SamRunSetUp(run, arguments));
    PetscCall(PetscOptionsClearValue(NULL, "-help")); /* else PetscFinalize() would print PETSc's help */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamRunSetUp(run, arguments));
  PetscCall(SamArgumentsRefuseUnknown());
  PetscCall(SamRunSolve(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Ends the program after an error. Waits for the other ranks only if they have met the same error: another may have
  occurred on one rank only. A file that failed in writing cannot be closed, either.
*/
static void AbandonAfter(SamRun *run, PetscErrorCode code, int status)
{
  if (!code || (status != (int)code && !run->writing && !alone)) return;
  (void)SamCheckpointsDestroy(&run->checkpoints); /* leaves no temporary file */
  (void)fflush(NULL);
  if (!launched) _exit(status); /* there are no other ranks */
  (void)MPI_Abort(PETSC_COMM_WORLD, status);
}

int main(int argc, char **argv)
{
  SamArguments   arguments;
  SamRun         run;
  PetscErrorCode code;
  int            status;

  (void)signal(SIGXFSZ, SIG_IGN); /* a file at its size limit becomes an error of the call that writes */
  ReturnLargeFields();
  PrepareMPI();
  if (MPI_Init(&argc, &argv)) return EXIT_FAILURE;
  SamArgumentsExamine(&argc, &argv, &arguments);
  memset(&run, 0, sizeof(run));
  code = StartPetsc(&argc, &argv);
  if (code) return GiveUpStarting();
  PetscCall(PetscPushErrorHandler(HandleError, NULL));
  code   = RunProgram(&run, &arguments);
  status = code ? ExitCode(code) : run.stopped ? EXIT_STOPPED : (int)run.point.worst;
  AbandonAfter(&run, code, status);
  PetscCall(SamRunTearDown(&run));
  PetscCall(SamFinalize());
  PetscCall(PetscPopErrorHandler());
  if (code) PetscCall(PetscOptionsClear(NULL));          /* no viewer writes its file after a mistake */
  if (code) (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* HDF5 may complain, at its end, of a file that was damaged */
  SamArgumentsFree(&arguments);
  PetscCall(PetscFinalize());
  (void)MPI_Finalize();
  return status;
}

/*
  The frame of a program: MPI and PETSc, errors and exit codes, -help and -version.

  Errors that one line explains are printed as that line, by one rank if all ranks have the error; for all others PETSc
  prints a trace.
*/
#include "program.h"
#include <petsam/private/baseimpl.h>
#include <petsam/contact.h>
#include <hdf5.h>
#include <malloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_USAGE = 2, EXIT_FILE = 3 };

/* The program that runs, and its words */
static const SamProgram *program;
static SamArguments      arguments;

/* ---- errors ---- */

/* True if an error has occurred that may be unknown to other ranks */
static PetscBool alone = PETSC_FALSE;
/* True if an MPI launcher has started the program */
static PetscBool launched = PETSC_TRUE;

/* True if one line explains the error; for all others PETSc prints a trace. */
static PetscBool IsPlain(PetscErrorCode code)
{
  return code == SAM_ERR_USER || code == SAM_ERR_FILE || code == PETSC_ERR_NOT_CONVERGED || code == PETSC_ERR_MEM;
}

static void PointToHelp(void)
{
  SamPrintMessage(program->name, "see %s -help for the options", program->name);
}

/* Prints an error as one line; if all ranks have it, from rank 0 only. */
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
    SamPrintMessage(program->name, "rank %d has not enough memory: %s", rank, message);
  else if (rank == 0 || ranks < all) /* for an option in a file, with that file */
    SamPrintMessage(program->name, "%s%s",
                    code == SAM_ERR_USER && message[0] == '-' ? SamArgumentsFindPlace(&arguments, message + 1) : "",
                    message);
  if (code == SAM_ERR_USER && rank == 0) PointToHelp();
  return code;
}

static int ExitCode(PetscErrorCode code)
{
  if (code == SAM_ERR_USER) return EXIT_USAGE;
  if (code == SAM_ERR_FILE) return EXIT_FILE;
  if (code == PETSC_ERR_NOT_CONVERGED) return SAM_STATUS_NOT_CONVERGED;
  return code;
}

/* Handles errors while PETSc starts; each is due to one of the options that it reads. */
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
  if (type != PETSC_ERROR_INITIAL || rank) return code;
  SamPrintMessage(program->name, "PETSc cannot take the options: %s", message ? message : "");
  PointToHelp();
  return code;
}

/* Ends the program if PETSc could not start; the other ranks may still be starting. */
static int GiveUpStarting(void)
{
  int ranks;

  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) (void)MPI_Abort(MPI_COMM_WORLD, EXIT_USAGE);
  (void)MPI_Finalize();
  return EXIT_USAGE;
}

/* ---- environment ---- */

/*
  Makes malloc() map large fields from the system and return them to it when they are freed. SuperLU_DIST, to which
  PETSc may be linked, disables this for the whole program; half of the memory would then be lost to fragmentation.
*/
static void ReturnLargeFields(void)
{
#if defined(__GLIBC__)
  (void)mallopt(M_MMAP_MAX, 65536);
  (void)mallopt(M_MMAP_THRESHOLD, 16 << 20); /* smaller fields are allocated in every step; reusing them is faster */
#endif
}

/* Signals at which PETSc would print a trace though the program has no error; nohup ignores one of them, and a program
   may catch some */
static const int usual[] = {SIGHUP, SIGQUIT, SIGTERM, SIGPIPE, SIGURG, SIGUSR1, SIGUSR2};
enum { USUAL = sizeof(usual) / sizeof(usual[0]) };

/* Starts PETSc, which leaves these signals as they were; those that come meanwhile wait. Returns its error code. */
static PetscErrorCode StartPetsc(int *argc, char ***argv)
{
  struct sigaction before[USUAL];
  PetscErrorCode   code;
  sigset_t         wait, mask;

  (void)sigemptyset(&wait);
  for (int k = 0; k < USUAL; k++) (void)sigaddset(&wait, usual[k]);
  (void)sigprocmask(SIG_BLOCK, &wait, &mask);
  for (int k = 0; k < USUAL; k++) (void)sigaction(usual[k], NULL, &before[k]);
  code = PetscOptionsCreateDefault();
  if (!code) code = PetscOptionsSetValue(NULL, "-skip_petscrc", NULL); /* no file without a name given by the user */
  if (!code && program->prepare) code = program->prepare();
  if (!code) code = PetscPushErrorHandler(HandleErrorAtStart, NULL);
  if (!code) code = PetscInitialize(argc, argv, NULL, NULL);
  if (!code) code = PetscOptionsClearValue(NULL, "-skip_petscrc");
  for (int k = 0; k < USUAL; k++) (void)sigaction(usual[k], &before[k], NULL);
  (void)sigprocmask(SIG_SETMASK, &mask, NULL);
  return code;
}

/* ---- the program ---- */

/* Warns of another MPI's launcher, which starts programs that do not know of each other. */
static void WarnOfCopies(void)
{
  const char *name;
  const int   copies = SamFindCopies(&name);

  if (copies)
    SamPrintMessage(
      program->name,
      "warning: the launcher has started %d processes or more (%s), but MPI has 1 rank: each process is a "
      "copy of the whole run: use the mpirun of the MPI that petsam is linked to",
      copies, name);
}

static PetscErrorCode Run(void)
{
  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCheck(!arguments.code, PETSC_COMM_WORLD, arguments.code, "%s", arguments.message);
  if (arguments.version) {
    char petsc[256];

    PetscCall(PetscGetVersion(petsc, sizeof(petsc)));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s %s\n%s\n", program->name, PETSAM_VERSION, petsc));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (arguments.help) {
    PetscCall(SamProgramHelp(program, &arguments));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  WarnOfCopies();
  PetscCall(program->setup(program->context, &arguments));
  PetscCall(SamArgumentsRefuseUnknown(PETSC_COMM_WORLD, &arguments));
  PetscCall(program->run(program->context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Ends the program after an error. Waits for the other ranks only if they have the same error: other errors may have
  occurred on one rank only. A file whose writing failed cannot be closed, either.
*/
static void AbandonAfter(PetscErrorCode code, int status)
{
  if (!code || (status != (int)code && !program->writing(program->context) && !alone)) return;
  program->abandon(program->context); /* removes temporary files */
  (void)fflush(NULL);
  if (!launched) _exit(status); /* there are no other ranks */
  (void)MPI_Abort(PETSC_COMM_WORLD, status);
}

int SamProgramMain(const SamProgram *given, int argc, char **argv)
{
  PetscErrorCode code;
  int            status;

  program = given;
  (void)signal(SIGXFSZ, SIG_IGN); /* a file at its size limit becomes an error of the writing call */
  ReturnLargeFields();
  launched = SamPrepareMPI();
  if (MPI_Init(&argc, &argv)) return EXIT_FAILURE;
  SamArgumentsExamine(&argc, &argv, &arguments);
  code = StartPetsc(&argc, &argv);
  if (code) return GiveUpStarting();
  PetscCall(PetscPushErrorHandler(HandleError, NULL));
  code   = Run();
  status = code ? ExitCode(code) : program->status(program->context);
  AbandonAfter(code, status);
  PetscCall(program->teardown(program->context));
  PetscCall(SamFinalize());
  PetscCall(PetscPopErrorHandler());
  if (code) PetscCall(PetscOptionsClear(NULL));          /* viewers write no file after a mistake */
  if (code) (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* HDF5 may complain, at its end, of a file that was damaged */
  SamArgumentsFree(&arguments);
  PetscCall(PetscFinalize());
  (void)MPI_Finalize();
  return status;
}

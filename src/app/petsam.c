/*
  The program: the command line, errors and exit codes around a run (run.c).

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file cannot be used; 10 not converged; 11 no equilibrium; 12
  contact at the grid's edge; 75 stopped with a checkpoint; others are PETSc's. Nothing is written before all input has
  been read and checked.
*/
#include "runimpl.h"
#include <errno.h>
#include <malloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

/* Prints a user's mistake as one line, from rank 0; leaves all other errors to PETSc's handler. */
static PetscErrorCode HandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *context)
{
  PetscMPIInt rank;

  (void)context;
  if (code != SAM_ERR_USER && code != SAM_ERR_FILE)
    return PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, NULL);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (type == PETSC_ERROR_INITIAL && rank == 0) {
    fprintf(stderr, "petsam: %s\n", message);
    if (code == SAM_ERR_USER) fprintf(stderr, "petsam: see petsam -help for the options\n");
  }
  return code;
}

static int ExitCode(PetscErrorCode code)
{
  if (code == SAM_ERR_USER) return EXIT_USAGE;
  if (code == SAM_ERR_FILE) return EXIT_FILE;
  return code;
}

/* ---- command line ---- */

/* Whether PETSc takes a word for an option's name: a dash and a letter (after a dash and a digit it is a value). */
static PetscBool IsOption(const char text[])
{
  return (text[0] == '-' &&
          (text[1] == '-' || (text[1] >= 'a' && text[1] <= 'z') || (text[1] >= 'A' && text[1] <= 'Z')))
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Removes -help, --help, -h, --version, -version from the arguments: PETSc would print its own text and go on. */
static void TakeHelpAndVersion(int *argc, char **argv, PetscBool *help, PetscBool *version)
{
  int kept = 1;

  for (int i = 1; i < *argc; i++) {
    const PetscBool is_help =
      (!strcmp(argv[i], "-help") || !strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool is_version =
      (!strcmp(argv[i], "--version") || !strcmp(argv[i], "-version")) ? PETSC_TRUE : PETSC_FALSE;

    if (is_help) *help = PETSC_TRUE;
    if (is_version) *version = PETSC_TRUE;
    if (!is_help && !is_version) argv[kept++] = argv[i];
  }
  *argc      = kept;
  argv[kept] = NULL;
}

/* Whether a line has more than an option and a value, at which PETSc ends the program. Not for lines with quotes. */
static int HasMoreWords(const char text[])
{
  int words = 0;

  if (strpbrk(text, "\"'")) return 0;
  for (text += strspn(text, " \t\r\n"); *text && !strchr("#!%", *text); text += strspn(text, " \t\r\n")) {
    words++;
    text += strcspn(text, " \t\r\n");
  }
  return words > 2;
}

/* Looks for mistakes in an options file at which PETSc would end the program. Returns their error code, or 0. */
static PetscErrorCode ExamineOptionsFile(const char name[], char message[], size_t size)
{
  FILE        *file   = fopen(name, "r");
  const size_t length = strlen(name);
  const int    yaml =
    (length > 5 && !strcmp(name + length - 5, ".yaml")) || (length > 4 && !strcmp(name + length - 4, ".yml"));
  char           line[4096];
  int            number = 0, begins = 1; /* a line longer than the buffer comes in parts */
  PetscErrorCode code = 0;
  struct stat    status;

  if (!file || fstat(fileno(file), &status) || S_ISDIR(status.st_mode)) {
    snprintf(message, size, "-options_file %s: cannot be read: %s", name, file ? "it is not a file" : strerror(errno));
    if (file) fclose(file);
    return SAM_ERR_FILE;
  }
  while (!code && !yaml && fgets(line, sizeof(line), file)) {
    const char *text = line + strspn(line, " \t\r\n");

    number += begins;
    if (begins && *text && !strchr("#!%", *text) && !IsOption(text) && strncmp(text, "alias ", 6)) {
      snprintf(message, size, "-options_file %s, line %d: expected an option, that is a word that begins with a dash",
               name, number);
      code = SAM_ERR_USER;
    } else if (begins && IsOption(text) && HasMoreWords(text)) {
      snprintf(message, size, "-options_file %s, line %d: expected one option and its value on a line", name, number);
      code = SAM_ERR_USER;
    }
    begins = strchr(line, '\n') != NULL;
  }
  fclose(file);
  return code;
}

/* Removes options files with mistakes from the arguments. Returns the code of the first error, with its message. */
static PetscErrorCode TakeBadOptionsFiles(int *argc, char **argv, char message[], size_t size)
{
  int            kept  = 1;
  PetscErrorCode first = 0;

  for (int i = 1; i < *argc; i++) {
    const int      named     = i + 1 < *argc && !IsOption(argv[i + 1]);
    char           text[512] = "-options_file has no value: expected a file's name";
    PetscErrorCode code      = 0;

    if (!strcmp(argv[i], "-options_file"))
      code = named ? ExamineOptionsFile(argv[i + 1], text, sizeof(text)) : SAM_ERR_USER;
    if (!code)
      argv[kept++] = argv[i];
    else {
      i += named;
      if (!first) snprintf(message, size, "%s", text);
      if (!first) first = code;
    }
  }
  *argc      = kept;
  argv[kept] = NULL;
  return first;
}

/* Refuses words that are neither an option nor its value, which PETSc would ignore. */
static PetscErrorCode RefuseStrayWords(int argc, char **argv)
{
  PetscFunctionBegin;
  for (int i = 1; i < argc; i++) {
    PetscCheck(IsOption(argv[i]), PETSC_COMM_WORLD, SAM_ERR_USER,
               "%s: expected an option, that is a word that begins with a dash", argv[i]);
    PetscCheck(argv[i][1] != '-', PETSC_COMM_WORLD, SAM_ERR_USER, "%s: options begin with one dash", argv[i]);
    if (i + 1 < argc && !IsOption(argv[i + 1])) i++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses options that the set-up has not read: they are misspelled, or have no effect. */
static PetscErrorCode RefuseUnknownOptions(void)
{
  /* options that PETSc itself reads only in PetscFinalize() */
  static const char *const late[] = {"-malloc_dump",
                                     "-malloc_view",
                                     "-malloc_test",
                                     "-malloc_debug",
                                     "-log_view",
                                     "-log_view_memory",
                                     "-options_left",
                                     "-options_view",
                                     "-objects_dump",
                                     "-memory_view",
                                     "-get_total_flops",
                                     "-petsc_finalize_time",
                                     NULL};
  PetscInt                 count;
  char                   **names, **values;
  char                     first[128] = "";

  PetscFunctionBegin;
  for (PetscInt k = 0; late[k]; k++) {
    PetscBool ignored;

    PetscCall(PetscOptionsHasName(NULL, NULL, late[k], &ignored));
  }
  PetscCall(PetscOptionsLeftGet(NULL, &count, &names, &values));
  if (count)
    PetscCall(
      PetscSNPrintf(first, sizeof(first), "-%s%s%s", names[0], values[0] ? " " : "", values[0] ? values[0] : ""));
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &names, &values));
  PetscCheck(!first[0], PETSC_COMM_WORLD, SAM_ERR_USER,
             "%s: unknown option, or one that has no effect with the others given", first);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the program ---- */

static PetscErrorCode RunProgram(SamRun *run, int argc, char **argv, PetscBool help, PetscErrorCode bad_file,
                                 const char message[])
{
  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCheck(!bad_file, PETSC_COMM_WORLD, bad_file, "%s", message);
  if (help) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s", usage));
    PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
    PetscCall(SamRunSetUp(run));
    PetscCall(PetscOptionsClearValue(NULL, "-help")); /* else PetscFinalize() would print PETSc's help */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(RefuseStrayWords(argc, argv));
  PetscCall(SamRunSetUp(run));
  PetscCall(RefuseUnknownOptions());
  PetscCall(SamRunSolve(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
static void StartAlone(void)
{
#if defined(OPEN_MPI)
  static const char *const launched[] = {
    "OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK", "PMI_ID", "PMI_FD", "PMI_SIZE", "SLURM_STEP_ID",
    "ALPS_APP_PE",          NULL};

  for (int k = 0; launched[k]; k++)
    if (getenv(launched[k])) return;
  (void)setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  (void)setenv("OMPI_MCA_orte_create_session_dirs", "0", 0); /* else concurrent programs would share one */
  (void)setenv("OMPI_MCA_sharedfp", "^sm", 0);               /* needs a session directory */
  (void)setenv("OMPI_MCA_pml", "ob1", 0);
  (void)setenv("OMPI_MCA_btl", "self", 0);
#endif
}

int main(int argc, char **argv)
{
  PetscBool      help = PETSC_FALSE, version = PETSC_FALSE;
  PetscErrorCode code, bad_file;
  char           message[512] = "";
  SamRun         run;
  int            status;

  ReturnLargeFields();
  StartAlone();
  TakeHelpAndVersion(&argc, argv, &help, &version);
  bad_file = TakeBadOptionsFiles(&argc, argv, message, sizeof(message));
  memset(&run, 0, sizeof(run));
  code = SamHistoryClaimOption();
  if (!code) code = PetscInitialize(&argc, &argv, NULL, NULL);
  if (code) return code;
  (void)signal(SIGXFSZ, SIG_IGN); /* a file at its size limit becomes an error of the call that writes */
  (void)signal(SIGPIPE, SIG_DFL); /* `petsam -help | head` ends quietly, without PETSc's trace */
  PetscCall(PetscPushErrorHandler(HandleError, NULL));
  if (version) {
    char petsc[256];

    PetscCall(PetscGetVersion(petsc, sizeof(petsc)));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "petsam %s\n%s\n", PETSAM_VERSION, petsc));
    PetscCall(PetscFinalize());
    return 0;
  }
  code   = RunProgram(&run, argc, argv, help, bad_file, message);
  status = code ? ExitCode(code) : run.stopped ? EXIT_STOPPED : (int)run.point.worst;
  /* other errors may have occurred on one rank only, and a file that failed in writing cannot be closed: do not wait */
  if (code && (status == (int)code || run.writing)) MPI_Abort(PETSC_COMM_WORLD, status);
  PetscCall(SamRunTearDown(&run));
  PetscCall(SamFinalize());
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscFinalize());
  return status;
}

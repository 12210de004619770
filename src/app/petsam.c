/*
  The program: the command line, errors and exit codes around a run (run/run.c).

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file; 10 not converged; 11 no equilibrium; 12 contact at the
  grid's edge; 75 stopped with a checkpoint; others are PETSc's. Nothing is written before all of the input has been
  read and found right.
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
  "Exit codes: 0 converged, 2 bad usage, 3 a file, 10 not converged, 11 no equilibrium, 12 contact at the grid's "
  "edge,\n"
  "75 stopped with a checkpoint.\n";

/* ---- errors ---- */

/* The user's mistakes are told in their own words by the first rank; all others as PETSc does. */
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

/* What PETSc takes for an option's name: a dash and a letter (a number is a value). */
static PetscBool IsOption(const char text[])
{
  return (text[0] == '-' &&
          (text[1] == '-' || (text[1] >= 'a' && text[1] <= 'z') || (text[1] >= 'A' && text[1] <= 'Z')))
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Takes -help, --help, -h, --version, -version out of the arguments; PETSc would answer with its own, and go on. */
static void TakeWords(int *argc, char **argv, PetscBool *help, PetscBool *version)
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

/* Whether a line holds more than an option and its value, which PETSc ends the program for; quotes are left to it. */
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

/* What is wrong with an options file, before PETSc stumbles over it: a code of the two errors, or 0. */
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
    snprintf(message, size, "-options_file %s: cannot be read: %s", name, file ? "it is no file" : strerror(errno));
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
      snprintf(message, size, "-options_file %s, line %d: expected one option and its value a line", name, number);
      code = SAM_ERR_USER;
    }
    begins = strchr(line, '\n') != NULL;
  }
  fclose(file);
  return code;
}

/* Takes options files that PETSc could not read out of the arguments; says what is wrong with the first. */
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

/* PETSc passes over what is not an option or the value of one. */
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

/* After all is set up, an option that nobody has asked for is a misspelled one. */
static PetscErrorCode RefuseUnknownOptions(void)
{
  /* those that PETSc itself reads only when it ends */
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
             "%s: unknown option, or one that has no meaning with the others given", first);
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
    PetscCall(PetscOptionsClearValue(NULL, "-help")); /* or PETSc adds its own at the end */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(RefuseStrayWords(argc, argv));
  PetscCall(SamRunSetUp(run));
  PetscCall(RefuseUnknownOptions());
  PetscCall(SamRunSolve(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Large fields come from the system and go back to it. SuperLU_DIST, which PETSc may link, turns that off for the whole
  program when it is loaded; half of the memory would be holes then.
*/
static void ReturnLargeFields(void)
{
#if defined(__GLIBC__)
  (void)mallopt(M_MMAP_MAX, 65536);
  (void)mallopt(M_MMAP_THRESHOLD, 16 << 20); /* smaller ones come and go each step */
#endif
}

/*
  A program that nobody launched as one of several needs no network. Open MPI would look for one, and start a daemon to
  be found by, which takes longer than a small problem and cannot be done everywhere. What the user has set stays.
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
  (void)setenv("OMPI_MCA_orte_create_session_dirs", "0", 0); /* or all that run at the same time would use the same */
  (void)setenv("OMPI_MCA_sharedfp", "^sm", 0);               /* it needs one */
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
  TakeWords(&argc, argv, &help, &version);
  bad_file = TakeBadOptionsFiles(&argc, argv, message, sizeof(message));
  memset(&run, 0, sizeof(run));
  code = SamHistoryClaimOption();
  if (!code) code = PetscInitialize(&argc, &argv, NULL, NULL);
  if (code) return code;
  (void)signal(SIGXFSZ, SIG_IGN); /* a file that may not grow is an error of the call that tries */
  (void)signal(SIGPIPE, SIG_DFL); /* `petsam -help | head` is no crash to be traced */
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
  /* other errors may be one rank's alone, and a file that could not be written cannot be closed: nobody must wait */
  if (code && (status == (int)code || run.writing)) MPI_Abort(PETSC_COMM_WORLD, status);
  PetscCall(SamRunTearDown(&run));
  PetscCall(SamFinalize());
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscFinalize());
  return status;
}

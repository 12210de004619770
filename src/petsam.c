/*
  The program: options in, objects made, the load steps run, results out.

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file; 10 not converged; 11 no equilibrium; 12 contact at the
  grid's edge; others are PETSc's. Nothing is written before all of the input has been read and found right.
*/
#include <petsam.h>
#include "base/baseimpl.h"
#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { EXIT_USAGE = 2, EXIT_FILE = 3 };

static const char usage[] = "petsam " PETSAM_VERSION ": partial-slip contact of elastic bodies by the semi-analytical method.\n"
                            "\n"
                            "  petsam [-option value ...]\n"
                            "  mpirun -n 4 petsam -options_file study.opts [-option value ...]\n"
                            "\n"
                            "All quantities in SI units; defaults in parentheses. Required: -grid_n, -grid_size, -body1_young, -body1_poisson,\n"
                            "-body2_young, -body2_poisson, -gap_type with its radii, and one of -load_n, -disp_z. For example, two steel spheres\n"
                            "pressed together and pushed sideways:\n"
                            "\n"
                            "  petsam -grid_n 256 -grid_size 2.6e-3 -body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 \\\n"
                            "    -body2_poisson 0.3 -gap_type sphere -gap_radius1 0.2 -gap_radius2 0.2 -friction 0.1 -load_n 1000 -load_tx 60 \\\n"
                            "    -output sphere.h5\n"
                            "\n"
                            "-help prints this, -version the version. PETSc's options work too (-options_file, -log_view, ...).\n"
                            "Exit codes: 0 converged, 2 bad usage, 3 a file, 10 not converged, 11 no equilibrium, 12 contact at the grid's edge.\n";

/* ---- errors ---- */

/* The user's mistakes are told in their own words by the first rank; all others as PETSc does. */
static PetscErrorCode HandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code, PetscErrorType type, const char *message, void *context)
{
  PetscMPIInt rank;

  (void)context;
  if (code != SAM_ERR_USER && code != SAM_ERR_FILE) return PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, NULL);
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
  return (text[0] == '-' && (text[1] == '-' || (text[1] >= 'a' && text[1] <= 'z') || (text[1] >= 'A' && text[1] <= 'Z'))) ? PETSC_TRUE : PETSC_FALSE;
}

/* Takes -help, --help, -h, --version, -version out of the arguments; PETSc would answer with its own, and go on. */
static void TakeWords(int *argc, char **argv, PetscBool *help, PetscBool *version)
{
  int kept = 1;

  for (int i = 1; i < *argc; i++) {
    const PetscBool is_help    = (!strcmp(argv[i], "-help") || !strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool is_version = (!strcmp(argv[i], "--version") || !strcmp(argv[i], "-version")) ? PETSC_TRUE : PETSC_FALSE;

    if (is_help) *help = PETSC_TRUE;
    if (is_version) *version = PETSC_TRUE;
    if (!is_help && !is_version) argv[kept++] = argv[i];
  }
  *argc      = kept;
  argv[kept] = NULL;
}

/* What is wrong with an options file, before PETSc stumbles over it: a code of the two errors, or 0. */
static PetscErrorCode ExamineOptionsFile(const char name[], char message[], size_t size)
{
  FILE          *file = fopen(name, "r");
  const size_t   length = strlen(name);
  const int      yaml   = (length > 5 && !strcmp(name + length - 5, ".yaml")) || (length > 4 && !strcmp(name + length - 4, ".yml"));
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
      snprintf(message, size, "-options_file %s, line %d: expected an option, that is a word that begins with a dash", name, number);
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
  int            kept = 1;
  PetscErrorCode first = 0;

  for (int i = 1; i < *argc; i++) {
    const int      named = i + 1 < *argc && !IsOption(argv[i + 1]);
    char           text[512] = "-options_file has no value: expected a file's name";
    PetscErrorCode code  = 0;

    if (!strcmp(argv[i], "-options_file")) code = named ? ExamineOptionsFile(argv[i + 1], text, sizeof(text)) : SAM_ERR_USER;
    if (!code) argv[kept++] = argv[i];
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
    PetscCheck(IsOption(argv[i]), PETSC_COMM_WORLD, SAM_ERR_USER, "%s: expected an option, that is a word that begins with a dash", argv[i]);
    PetscCheck(argv[i][1] != '-', PETSC_COMM_WORLD, SAM_ERR_USER, "%s: options begin with one dash", argv[i]);
    if (i + 1 < argc && !IsOption(argv[i + 1])) i++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After all is set up, an option that nobody has asked for is a misspelled one. */
static PetscErrorCode RefuseUnknownOptions(void)
{
  /* those that PETSc itself reads only when it ends */
  static const char *const late[] = {"-malloc_dump", "-malloc_view", "-malloc_test", "-malloc_debug", "-log_view", "-log_view_memory", "-options_left", "-options_view", "-objects_dump", "-memory_view", "-get_total_flops", "-petsc_finalize_time", NULL};
  PetscInt                 count;
  char                   **names, **values;
  char                     first[128] = "";

  PetscFunctionBegin;
  for (PetscInt k = 0; late[k]; k++) {
    PetscBool ignored;

    PetscCall(PetscOptionsHasName(NULL, NULL, late[k], &ignored));
  }
  PetscCall(PetscOptionsLeftGet(NULL, &count, &names, &values));
  if (count) PetscCall(PetscSNPrintf(first, sizeof(first), "-%s%s%s", names[0], values[0] ? " " : "", values[0] ? values[0] : ""));
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &names, &values));
  PetscCheck(!first[0], PETSC_COMM_WORLD, SAM_ERR_USER, "%s: unknown option, or one that has no meaning with the others given", first);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- memory ---- */

/* Bytes a cell at the peak: 225 to 280 and 165 were measured at 1024 to 4096 cells; and the program with its libraries. */
#define BYTES_PER_CELL             300
#define BYTES_PER_CELL_NO_FRICTION 200
#define BYTES_PROGRAM              50e6

/* What this rank will need. */
static double Memory(SamGrid grid, PetscReal friction)
{
  return BYTES_PROGRAM + (friction > 0 ? BYTES_PER_CELL : BYTES_PER_CELL_NO_FRICTION) * (double)grid->cells;
}

/* Memory of this node that can be had, bytes; 0 when it cannot be told. */
static double AvailableMemory(void)
{
  FILE  *file = fopen("/proc/meminfo", "r");
  char   line[128];
  double kilobytes = 0;

  if (!file) return 0;
  while (fgets(line, sizeof(line), file))
    if (sscanf(line, "MemAvailable: %lf", &kilobytes) == 1) break;
  fclose(file);
  return 1024 * kilobytes;
}

/* Refuses what this node cannot hold before the system kills the run for it. */
static PetscErrorCode RefuseTooLarge(SamGrid grid, PetscReal friction)
{
  double       need, worst;
  MPI_Comm     node;
  PetscBool    check = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamOptionsBool(NULL, "memory_check", "refuse a grid that the memory at hand cannot hold", &check, NULL));
  PetscCallMPI(MPI_Comm_split_type(grid->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  need = Memory(grid, friction);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &need, 1, MPI_DOUBLE, MPI_SUM, node));
  PetscCallMPI(MPI_Comm_free(&node));
  worst = AvailableMemory();
  worst = worst > 0 ? need / worst : 0;
  PetscCall(SamMax(grid->comm, 1, &worst));
  PetscCheck(!check || worst <= 1, grid->comm, SAM_ERR_USER, "-grid_n %" PetscInt_FMT ",%" PetscInt_FMT ": needs about %.3g GB on a node, %.1f times what is available; use more nodes, or -memory_check false", grid->nx, grid->ny, 1e-9 * need, worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results ---- */

/* Every physical parameter as an attribute with its option's name. */
static PetscErrorCode WriteParameters(SamOutput output, SamGrid grid, const SamPair *pair, SamGap gap, PetscReal friction, SamHistory history)
{
  const PetscReal    n[2] = {(PetscReal)grid->nx, (PetscReal)grid->ny};
  const SamBalance  *balances[2];
  SamStep            step;
  SamGapType         type;
  PetscInt           count;
  const char *const *names;
  const PetscReal   *values;
  char              *all, *alias;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  while ((alias = strstr(all, "-petsam_history"))) memmove(alias + 1, alias + 8, strlen(alias + 8) + 1); /* its given name */
  PetscCall(SamOutputSetText(output, "options", all));
  PetscCall(PetscFree(all));
  for (PetscInt body = 0; body < 2; body++) {
    char name[32];

    PetscCall(PetscSNPrintf(name, sizeof(name), "body%d_young", (int)body + 1));
    PetscCall(SamOutputSetReals(output, name, 1, &pair->young[body]));
    PetscCall(PetscSNPrintf(name, sizeof(name), "body%d_poisson", (int)body + 1));
    PetscCall(SamOutputSetReals(output, name, 1, &pair->poisson[body]));
  }
  PetscCall(SamOutputSetReals(output, "friction", 1, &friction));
  PetscCall(SamOutputSetReals(output, "grid_n", 2, n));
  PetscCall(SamOutputSetReals(output, "grid_size", 2, grid->width));
  PetscCall(SamOutputSetReals(output, "grid_center", 2, grid->center));
  PetscCall(SamGapGetParameters(gap, &type, &count, &names, &values));
  PetscCall(SamOutputSetText(output, "gap_type", type));
  for (PetscInt k = 0; k < count; k++) PetscCall(SamOutputSetReals(output, names[k], 1, &values[k]));
  /* of a history, the last step's: how it went there stands in /history */
  PetscCall(SamHistoryGetCount(history, &count));
  PetscCall(SamHistoryGetStep(history, count - 1, &step));
  balances[0] = &step.normal;
  balances[1] = &step.tangential;
  for (PetscInt b = 0; b < 2; b++)
    for (PetscInt k = 0; k < 3; k++) {
      if (balances[b]->force[k]) PetscCall(SamOutputSetReals(output, SamLoadNames[b][k], 1, &balances[b]->load[k]));
      else PetscCall(SamOutputSetReals(output, SamRigidNames[b][k], 1, &balances[b]->rigid[k]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the run ---- */

typedef struct {
  SamGrid       grid;
  SamPair       pair;
  SamGap        gap;
  SamCompliance compliance;
  Vec           separation;
  SamContact    contact;
  SamOutput     output;
  PetscReal     friction;
  SamHistory    history;
  SamReport     report;
  SamStatus     status; /* the worst so far */
  PetscInt      output_every, solved, saved; /* saved: steps with fields */
  PetscBool     has_output, writing;
  char          filename[PETSC_MAX_PATH_LEN];
} Run;

/* The results would replace a file that the run reads. */
static PetscErrorCode RefuseOverwritingInput(const Run *run)
{
  static const char *const inputs[] = {"-gap_file", "-gap_rough_file", "-petsam_history", "-options_file", NULL};
  static const char *const names[]  = {"-gap_file", "-gap_rough_file", "-history", "-options_file"};

  PetscFunctionBegin;
  if (!run->has_output) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; inputs[k]; k++) {
    struct stat in, out;
    char        name[PETSC_MAX_PATH_LEN];
    PetscBool   set;

    PetscCall(PetscOptionsGetString(NULL, NULL, inputs[k], name, sizeof(name), &set));
    PetscCheck(!set || stat(name, &in) || stat(run->filename, &out) || in.st_dev != out.st_dev || in.st_ino != out.st_ino, PETSC_COMM_WORLD, SAM_ERR_USER, "-output %s: is the file of %s, which it would replace", run->filename, names[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads every option and makes every object, but writes nothing. */
static PetscErrorCode SetUp(Run *run)
{
  PetscBool help;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamGridCreateFromOptions(PETSC_COMM_WORLD, &run->grid));
  PetscCall(SamPairSetFromOptions(&run->pair));
  PetscCall(SamOptionsReal(NULL, "friction", "Coulomb's coefficient", SAM_RANGE_NONNEGATIVE, &run->friction, NULL));
  PetscCall(SamGapCreate(PETSC_COMM_WORLD, &run->gap));
  PetscCall(SamGapSetFromOptions(run->gap));
  PetscCall(SamHistoryCreateFromOptions(PETSC_COMM_WORLD, &run->history));
  PetscCall(SamReportCreateFromOptions(PETSC_COMM_WORLD, &run->report));
  PetscCall(SamOptionsHeading("Results and resources"));
  PetscCall(SamOptionsString(NULL, "output", "HDF5 file of the results", run->filename, sizeof(run->filename), &run->has_output));
  run->output_every = 1;
  PetscCall(SamOptionsInt(NULL, "output_every", "write the fields of every m-th step, and of the last", 1, &run->output_every, NULL));
  PetscCall(SamOutputCheckOptions(PETSC_COMM_WORLD));
  PetscCall(RefuseOverwritingInput(run));
  PetscCall(RefuseTooLarge(run->grid, run->friction));
  PetscCall(SamComplianceCreate(run->grid, &run->pair, &run->compliance));
  PetscCall(SamGridCreateVec(run->grid, 1, &run->separation));
  if (!help) PetscCall(SamGapFill(run->gap, run->grid, run->separation));
  PetscCall(SamContactCreate(run->compliance, run->separation, run->friction, &run->contact));
  PetscCall(VecDestroy(&run->separation)); /* the contact has its own */
  PetscCall(SamContactSetFromOptions(run->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TearDown(Run *run)
{
  PetscFunctionBegin;
  PetscCall(SamOutputDestroy(&run->output));
  PetscCall(SamReportDestroy(&run->report));
  PetscCall(SamContactDestroy(&run->contact));
  PetscCall(VecDestroy(&run->separation));
  PetscCall(SamComplianceDestroy(&run->compliance));
  PetscCall(SamHistoryDestroy(&run->history));
  PetscCall(SamGapDestroy(&run->gap));
  PetscCall(SamGridDestroy(&run->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Results of a step. Where there is no equilibrium there are no fields. */
static PetscErrorCode WriteStep(Run *run, const SamStep *step, PetscInt k, PetscInt count)
{
  const PetscBool due = ((k + 1) % run->output_every == 0 || k + 1 == count || step->status == SAM_STATUS_NOT_CONVERGED) ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool has = (due && step->status != SAM_STATUS_NO_EQUILIBRIUM) ? PETSC_TRUE : PETSC_FALSE;
  SamFields       fields;

  PetscFunctionBegin;
  if (!run->output) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetFields(run->contact, &fields));
  run->writing = PETSC_TRUE;
  PetscCall(SamOutputWriteStep(run->output, step, has ? &fields : NULL, run->friction));
  run->writing = PETSC_FALSE;
  run->solved++;
  run->saved += has ? 1 : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Closes the results file, so that what is said of it is true. */
static PetscErrorCode FinishResults(Run *run)
{
  char        content[96];
  const char *xdmf;

  PetscFunctionBegin;
  if (!run->output) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(content, sizeof(content), "%" PetscInt_FMT " step%s, fields of %" PetscInt_FMT, run->solved, run->solved == 1 ? "" : "s", run->saved));
  PetscCall(SamReportAddFile(run->report, run->filename, content));
  PetscCall(SamOutputGetXdmf(run->output, &xdmf));
  if (xdmf) PetscCall(SamReportAddFile(run->report, xdmf, "the same for ParaView and VisIt"));
  PetscCall(SamOutputDestroy(&run->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All load steps, their results, and what is to be said of them. Ends early where a step has no solution. */
static PetscErrorCode SolveSteps(Run *run)
{
  PetscInt  count;
  PetscBool ended = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(run->history, &count));
  for (PetscInt k = 0; k < count && !ended; k++) {
    SamStep step;

    PetscCall(SamHistoryGetStep(run->history, k, &step));
    PetscCall(SamReportBeginStep(run->report, k, run->contact));
    PetscCall(SamContactSolve(run->contact, &step));
    PetscCall(WriteStep(run, &step, k, count));
    PetscCall(SamReportEndStep(run->report, &step)); /* a step that is told is in the file */
    ended = (step.status == SAM_STATUS_NOT_CONVERGED || step.status == SAM_STATUS_NO_EQUILIBRIUM) ? PETSC_TRUE : PETSC_FALSE;
    if (ended || !run->status) run->status = step.status;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunProgram(Run *run, int argc, char **argv, PetscBool help, PetscErrorCode bad_file, const char message[])
{
  PetscInt steps;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCheck(!bad_file, PETSC_COMM_WORLD, bad_file, "%s", message);
  if (help) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s", usage));
    PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
    PetscCall(SetUp(run));
    PetscCall(PetscOptionsClearValue(NULL, "-help")); /* or PETSc adds its own at the end */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(RefuseStrayWords(argc, argv));
  PetscCall(SetUp(run));
  PetscCall(RefuseUnknownOptions());
  PetscCall(SamHistoryGetCount(run->history, &steps));
  PetscCall(SamReportBanner(run->report, run->grid, Memory(run->grid, run->friction), steps, run->has_output ? run->filename : NULL));
  if (run->has_output) {
    PetscCall(SamOutputCreate(run->grid, run->filename, &run->output));
    PetscCall(WriteParameters(run->output, run->grid, &run->pair, run->gap, run->friction, run->history));
  }
  PetscCall(SolveSteps(run));
  PetscCall(FinishResults(run));
  PetscCall(SamReportClosing(run->report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscBool      help = PETSC_FALSE, version = PETSC_FALSE;
  PetscErrorCode code, bad_file;
  char           message[512] = "";
  Run            run;
  int            status;

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
  status = code ? ExitCode(code) : (int)run.status;
  /* other errors may be one rank's alone, and a file that could not be written cannot be closed: nobody must wait */
  if (code && (status == (int)code || run.writing)) MPI_Abort(PETSC_COMM_WORLD, status);
  PetscCall(TearDown(&run));
  PetscCall(SamFinalize());
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscFinalize());
  return status;
}

/*
  The program petsam-stress: from tractions in a results file to stresses in a file of their own.

  Exit codes: 0 done; 2 bad usage; 3 a file cannot be used; others are PETSc's.
*/
#include "program.h"
#include "help/petsam-stress.h" /* from petsam-stress.help */
#include "stress/stressrun.h"
#include <petsam/private/baseimpl.h>
#include <math.h>
#include <petsctime.h>
#include <signal.h>

/* A line of progress follows the one before after so many seconds, or such a part of the time spent. */
#define TELL_SECONDS 1.0
#define TELL_PART    0.05
/* A depth, in widths of the grid, that a unit may explain. */
#define DEEP 20.0

/* ---- set-up ---- */

/* A field of the k-th of the chosen steps. */
static PetscErrorCode ReadField(void *context, PetscInt step, SamStepField field, double values[])
{
  static const SamResultsField fields[SAM_STEP_FIELDS] = {SAM_RESULTS_PRESSURE, SAM_RESULTS_SHEAR_X,
                                                          SAM_RESULTS_SHEAR_Y, SAM_RESULTS_SLIP_X, SAM_RESULTS_SLIP_Y};
  const SamStressRun *const    run                     = (const SamStressRun *)context;

  PetscFunctionBegin;
  PetscCall(SamResultsRead(run->results, run->saved[step], fields[field], values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The bodies, by the elasticity that the results have recorded. */
static PetscErrorCode CreateBodies(SamStressRun *run)
{
  const SamParameters *parameters;

  PetscFunctionBegin;
  PetscCall(SamResultsGetParameters(run->results, &parameters));
  PetscCall(PetscSNPrintf(run->source, sizeof(run->source), "-input %s", run->request.input));
  PetscCall(SamElasticityCreateFromParameters(run->grid, parameters, run->source, &run->elasticity));
  PetscCall(SamEvaluationSetElasticity(run->evaluation, run->elasticity, &run->transforms, run->source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Times and bulk stresses of the steps; warns of those that have not been solved. */
static PetscErrorCode ReadSteps(SamStressRun *run)
{
  PetscInt    body, unsolved = 0, first[2] = {0, 0};
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCall(SamStressRequestSteps(&run->request, run->results, &run->steps, &run->saved));
  PetscCall(PetscMalloc1(run->steps, &run->times));
  PetscCall(PetscMalloc1(run->steps, &run->bulk));
  PetscCall(SamEvaluationGetBody(run->evaluation, &body));
  for (PetscInt k = 0; k < run->steps; k++) {
    PetscInt step;
    double   status;

    PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step, &run->times[k]));
    PetscCall(SamResultsReadBulkStress(run->results, step, body - 1, run->bulk[k]));
    PetscCall(SamResultsReadNumber(run->results, step, SAM_RESULTS_STATUS, &status));
    if (status == 0) continue;
    if (!unsolved++) first[0] = step, first[1] = (PetscInt)status;
  }
  PetscCallMPI(MPI_Comm_rank(run->grid->comm, &rank));
  if (unsolved && !rank)
    fprintf(stderr,
            "petsam-stress: warning: petsam has not solved %ld of %ld steps: step %ld has the status %ld "
            "(/history/status): do not rely on its stresses\n",
            (long)unsolved, (long)run->steps, (long)first[0], (long)first[1]);
  PetscCall(SamEvaluationSetSource(
    run->evaluation,
    &(SamEvaluationSource){.steps = run->steps, .bulk = run->bulk, .read = ReadField, .context = run}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetMemory(const SamStressRun *run, double *bytes)
{
  PetscFunctionBegin;
  PetscCall(SamEvaluationGetMemory(run->evaluation, bytes));
  *bytes += SAM_MEMORY_PROGRAM;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The output and its temporary file must not replace a file that is read. */
static PetscErrorCode CheckFiles(const SamStressRequest *r, const SamArguments *arguments)
{
  SamFiles files = {.count = 0};
  char    *temporary;

  PetscFunctionBegin;
  PetscCall(SamFilesAdd(&files, "-input", r->input, PETSC_FALSE));
  PetscCall(SamOutputNameTemporary(r->output, &temporary));
  PetscCall(SamFilesAddWritten(&files, "-output", r->output, NULL, temporary));
  PetscCall(SamFilesCheck(&files, PETSC_COMM_WORLD, arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads all options and the results' parameters; writes nothing. */
static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  SamStressRun *const run  = (SamStressRun *)context;
  const SamOptions    from = {PETSC_COMM_WORLD, NULL};
  PetscBool           help;
  double              bytes;

  PetscFunctionBegin;
  PetscCall(SamOptionsPlugins(&from));
  PetscCall(SamStressRequestRead(&from, &run->request));
  PetscCall(SamEvaluationCreate(PETSC_COMM_WORLD, &run->evaluation));
  PetscCall(SamEvaluationSetFromOptions(run->evaluation, &from));
  PetscCall(SamOptionsHeading(&from, "Resources"));
  PetscCall(SamFourierSettingsFromOptions(&run->transforms, &from));
  PetscCall(SamOptionsBool(&from, "quiet", "print warnings and errors only", &run->quiet, NULL));
  PetscCall(SamPrintHelp(&help));
  if (help) PetscCall(SamMemoryRefuse(PETSC_COMM_WORLD, 0, "", "", &from)); /* for its option */
  if (help) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckFiles(&run->request, arguments));
  PetscCall(SamResultsOpen(PETSC_COMM_WORLD, "input", run->request.input, &run->results));
  PetscCall(SamResultsGetGrid(run->results, &run->grid));
  PetscCall(CreateBodies(run));
  PetscCall(ReadSteps(run));
  PetscCall(SamStressRunHalfWidth(run));
  PetscCall(SamEvaluationSetUp(run->evaluation));
  PetscCall(GetMemory(run, &bytes));
  PetscCall(SamMemoryRefuse(run->grid->comm, bytes, "-input", run->request.input, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TearDown(void *context)
{
  SamStressRun *const run = (SamStressRun *)context;

  PetscFunctionBegin;
  PetscCall(SamStressFileDestroy(&run->file));
  PetscCall(SamEvaluationDestroy(&run->evaluation));
  PetscCall(SamElasticityDestroy(&run->elasticity));
  PetscCall(SamResultsDestroy(&run->results));
  PetscCall(PetscFree(run->saved));
  PetscCall(PetscFree(run->times));
  PetscCall(PetscFree(run->bulk));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- progress ---- */

/* A line on how far the run is, if the last one is some time ago. */
static PetscErrorCode Tell(void *context, const char work[], double part, double whole)
{
  SamStressRun *const run = (SamStressRun *)context;
  PetscLogDouble      now, spent;

  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  spent = now - run->start;
  if (run->quiet || now - run->told < PetscMax(TELL_SECONDS, TELL_PART * spent)) PetscFunctionReturn(PETSC_SUCCESS);
  run->told = now;
  PetscCall(PetscPrintf(run->grid->comm, "  %-24s%5.1f %%  %.1f s", work, 100 * part, spent));
  if (whole > 0) PetscCall(PetscPrintf(run->grid->comm, ", %.1f s left", spent * (1 - whole) / whole));
  PetscCall(PetscPrintf(run->grid->comm, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

static PetscErrorCode CreateFile(SamStressRun *run)
{
  SamParameters   parameters = {.count = 0};
  SamStressLayout layout;
  const char     *of_run;
  char           *options;

  PetscFunctionBegin;
  PetscCall(SamEvaluationGetLayout(run->evaluation, &layout));
  layout.times = run->times;
  PetscCall(SamEvaluationAddParameters(run->evaluation, &parameters));
  PetscCall(SamStressFileCreate(run->grid, run->request.output, &layout, &parameters, &run->file));
  PetscCall(SamStressFileSetText(run->file, "input", run->request.input));
  PetscCall(PetscOptionsGetAll(NULL, &options));
  PetscCall(SamStressFileSetText(run->file, "options", options));
  PetscCall(PetscFree(options));
  PetscCall(SamResultsGetOptions(run->results, &of_run));
  PetscCall(SamStressFileSetText(run->file, "input_options", of_run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Write(void *context, SamQuantity quantity, PetscInt component, PetscInt step, PetscInt depth,
                            PetscInt depths, const double values[])
{
  PetscFunctionBegin;
  PetscCall(SamStressFileWrite(((SamStressRun *)context)->file, quantity, component, step, depth, depths, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The numbers of the load steps, as petsam counts them. */
static PetscErrorCode WriteStepNumbers(SamStressRun *run)
{
  double *numbers;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(run->steps, &numbers));
  for (PetscInt k = 0; k < run->steps; k++) {
    PetscInt step;

    PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step, NULL));
    numbers[k] = (double)step;
  }
  PetscCall(SamStressFileSetHistory(run->file, "step", "1", "number of the load step, from 1", numbers));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the run ---- */

static PetscErrorCode PrintBanner(SamStressRun *run)
{
  const SamGrid   g = run->grid;
  SamStressLayout layout;
  PetscMPIInt     ranks;
  PetscInt        body;
  double          bytes;
  char            memory[32];

  PetscFunctionBegin;
  if (run->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(g->comm, &ranks));
  PetscCall(SamEvaluationGetLayout(run->evaluation, &layout));
  PetscCall(SamEvaluationGetBody(run->evaluation, &body));
  PetscCall(GetMemory(run, &bytes));
  SamDescribeBytes(bytes, memory, sizeof(memory));
  PetscCall(PetscPrintf(g->comm,
                        "petsam-stress " PETSAM_VERSION ": stresses in body %" PetscInt_FMT "\n"
                        "  results     %s, %" PetscInt_FMT " x %" PetscInt_FMT " cells\n"
                        "  steps       %" PetscInt_FMT ", depths %" PetscInt_FMT ", %s\n"
                        "  ranks       %d, memory about %s per rank\n\n",
                        body, run->request.input, g->nx, g->ny, run->steps, layout.depths,
                        layout.section ? "on a section" : "maps", ranks, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stresses of a contact fall off within its own size. */
static PetscErrorCode WarnOfDepths(SamStressRun *run)
{
  const double    width = 2 * (double)run->grid->length;
  SamStressLayout layout;
  PetscMPIInt     rank;
  double          deepest;

  PetscFunctionBegin;
  PetscCall(SamEvaluationGetLayout(run->evaluation, &layout));
  deepest = (double)layout.depth[layout.depths - 1];
  PetscCallMPI(MPI_Comm_rank(run->grid->comm, &rank));
  if (deepest > DEEP * width && !rank)
    fprintf(stderr, "petsam-stress: warning: -depths: %g m is %.2g times the width of the grid: check the unit, m\n",
            deepest, deepest / width);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamStressRun run_of_process; /* for the handler of signals */

/* A signal that ends the program leaves no temporary file: it may be large. */
static void EndOnSignal(int number)
{
  SamStressFileAbandon(run_of_process.file);
  (void)signal(number, SIG_DFL);
  (void)raise(number);
}

static void CatchSignals(void)
{
  static const int numbers[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2};

  for (size_t k = 0; k < sizeof(numbers) / sizeof(numbers[0]); k++)
    if (signal(numbers[k], EndOnSignal) == SIG_IGN) (void)signal(numbers[k], SIG_IGN);
}

static PetscErrorCode Compute(void *context)
{
  SamStressRun *const run = (SamStressRun *)context;
  PetscBool           cycle;
  PetscLogDouble      end;

  PetscFunctionBegin;
  CatchSignals();
  PetscCall(PrintBanner(run));
  PetscCall(WarnOfDepths(run));
  PetscCall(PetscTime(&run->start));
  run->told    = run->start;
  run->writing = PETSC_TRUE;
  PetscCall(CreateFile(run));
  PetscCall(SamEvaluationHasCycle(run->evaluation, &cycle));
  if (cycle && run->steps > 1) PetscCall(SamCycleCheckClosed(run)); /* one: of points that pass */
  PetscCall(SamEvaluationSetMonitor(run->evaluation, Tell, run));
  PetscCall(SamEvaluationCompute(run->evaluation, Write, run));
  if (run->told > run->start) { /* lines that have begun end with the whole */
    run->told = -INFINITY;
    PetscCall(Tell(run, "all", 1, 0));
  }
  PetscCall(WriteStepNumbers(run));
  PetscCall(SamLargestWrite(run));
  PetscCall(SamStressFileFinish(run->file));
  run->writing = PETSC_FALSE;
  PetscCall(PetscTime(&end));
  if (!run->quiet) PetscCall(SamLargestPrint(run));
  if (!run->quiet)
    PetscCall(
      PetscPrintf(run->grid->comm, "  time        %.2f s\n  written     %s\n", end - run->start, run->request.output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int GetStatus(const void *context)
{
  (void)context;
  return 0;
}

static PetscBool IsWriting(const void *context)
{
  return ((const SamStressRun *)context)->writing;
}

/* Leaves no temporary file. */
static void Abandon(void *context)
{
  SamStressFileAbandon(((SamStressRun *)context)->file);
}

int main(int argc, char **argv)
{
  const SamProgram program = {.name     = "petsam-stress",
                              .topics   = topics,
                              .setup    = SetUp,
                              .run      = Compute,
                              .teardown = TearDown,
                              .status   = GetStatus,
                              .writing  = IsWriting,
                              .abandon  = Abandon,
                              .context  = &run_of_process};

  return SamProgramMain(&program, argc, argv);
}

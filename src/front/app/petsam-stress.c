/*
  The program petsam-stress: reads tractions from a results file and writes stresses to another file.

  Exit codes: 0 done; 2 bad usage; 3 a file cannot be used; others are PETSc's.
*/
#include "program.h"
#include "request.h"
#include "help/petsam-stress.h" /* from petsam-stress.help */
#include <petsam/private/base.h>
#include <petsam/private/evaluation.h>
#include <petsam/private/output.h>
#include <petsam/private/parts.h>
#include <petsam/private/file.h>
#include <petsam/private/runfiles.h>
#include <petsam/private/stress.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/elasticity.h>
#include <math.h>
#include <petsctime.h>
#include <signal.h>

/* Time between two lines of progress: this many seconds, or this part of the time so far */
#define TELL_SECONDS 1.0
#define TELL_PART    0.05
/* Depths of at least this many grid widths are probably in a wrong unit. */
#define DEEP 20.0

#define SHOWN 9 /* number of materials up to which all maxima are printed */

/* A run of petsam-stress */
typedef struct {
  SamStressRequest       request;
  SamResults             results;
  SamStressFile          file;
  SamGrid                grid;       /* grid of the results */
  SamElasticity          elasticity; /* the bodies, as recorded in the results */
  SamEvaluation          evaluation;
  const SamStressLayout *layout;
  PetscInt               steps, *saved;
  PetscMPIInt            rank;
  PetscBool              quiet, writing;
  PetscInt               strengths;           /* number of given strengths, */
  PetscReal              strength[SHOWN - 1]; /* and these, from the surface down, Pa */
  PetscLogDouble         start, told; /* times of the start of the computation, and of the last printed line, s */

  char source[PETSC_MAX_PATH_LEN + 16]; /* source of the bodies, for messages */
  char doubt[512];                      /* warnings about the steps as a cycle; empty: none */
} SamStressRun;

static PetscErrorCode Warn(void *context, const char option[], const char format[], ...)
{
  va_list values;
  char    text[2 * SAM_MESSAGE];

  PetscFunctionBegin;
  if (((const SamStressRun *)context)->rank) PetscFunctionReturn(PETSC_SUCCESS);
  va_start(values, format);
  (void)vsnprintf(text, sizeof(text), format, values);
  va_end(values);
  SamPrintMessage("petsam-stress", "warning: %s%s", option, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- progress ---- */

/* Prints a line on the progress of the run if the last line is some time ago. */
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

/* ---- the steps ---- */

/* Returns the number of the saved step of the k-th chosen step; k = -1: of the step before the first, at the same
   distance. */
static PetscInt SavedStep(const SamStressRun *run, PetscInt k)
{
  return k >= 0 ? run->saved[k] : run->saved[0] - (run->steps > 1 ? run->saved[1] - run->saved[0] : 1);
}

static PetscErrorCode ReadField(void *context, PetscInt step, const char field[], double values[])
{
  const SamStressRun *const run = (const SamStressRun *)context;

  PetscFunctionBegin;
  PetscCall(SamResultsRead(run->results, SavedStep(run, step), field, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool HasField(void *context, const char field[])
{
  const SamStressRun *const run = (const SamStressRun *)context;

  for (PetscInt k = 0; k < run->steps; k++)
    if (!SamResultsHas(run->results, run->saved[k], field)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscErrorCode ReadNumber(void *context, PetscInt k, SamStepNumber number, double *value)
{
  static const SamResultsNumber of[] = {
    [SAM_STEP_AREA] = SAM_RESULTS_CONTACT_AREA, [SAM_STEP_CYCLE] = SAM_RESULTS_CYCLE,
    [SAM_STEP_SLIDE_X] = SAM_RESULTS_SLIDE_X,   [SAM_STEP_SLIDE_Y] = SAM_RESULTS_SLIDE_Y,
    [SAM_STEP_ROLLED_X] = SAM_RESULTS_ROLLED_X, [SAM_STEP_ROLLED_Y] = SAM_RESULTS_ROLLED_Y};
  const SamStressRun *const run = (const SamStressRun *)context;
  PetscInt                  step;
  PetscReal                 time;

  PetscFunctionBegin;
  PetscCall(SamResultsGetSaved(run->results, SavedStep(run, k), &step, &time));
  *value = number == SAM_STEP_NUMBER ? (double)step : (double)time;
  if (number >= SAM_STEP_AREA) PetscCall(SamResultsReadNumber(run->results, step, of[number], value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadConditions(void *context, PetscInt k, SamConditions conditions, SamControl *control)
{
  const SamStressRun *const run = (const SamStressRun *)context;
  PetscInt                  step;

  PetscFunctionBegin;
  PetscCall(SamResultsGetSaved(run->results, SavedStep(run, k), &step, NULL));
  PetscCall(SamResultsReadConditions(run->results, step, conditions, control));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints a warning, and stores it in the file for later readers of the parameters. */
static PetscErrorCode WarnOfSteps(void *context, const char text[])
{
  char *const  doubt = ((SamStressRun *)context)->doubt;
  const size_t used  = strlen(doubt);

  (void)snprintf(doubt + used, sizeof(((SamStressRun *)context)->doubt) - used, "%s%s", used ? "; " : "", text);
  return Warn(context, "-steps: ", "%s", text);
}

/* Chooses the steps; warns of unsolved ones. */
static PetscErrorCode ChooseSteps(SamStressRun *run)
{
  PetscInt unsolved = 0, first[2] = {0, 0};

  PetscFunctionBegin;
  PetscCall(SamStressRequestSteps(&run->request, run->results, &run->steps, &run->saved));
  for (PetscInt k = 0; k < run->steps; k++) {
    PetscInt step;
    double   status;

    PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step, NULL));
    PetscCall(SamResultsReadNumber(run->results, step, SAM_RESULTS_STATUS, &status));
    if (status == 0) continue;
    if (!unsolved++) first[0] = step, first[1] = (PetscInt)status;
  }
  if (unsolved)
    PetscCall(Warn(run, "",
                   "petsam has not solved %ld of %ld steps: step %ld has the status %ld (/history/status): do not rely "
                   "on its stresses",
                   (long)unsolved, (long)run->steps, (long)first[0], (long)first[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- set-up ---- */

static PetscErrorCode ReadLayer(void *context, PetscInt step, PetscInt group, PetscInt component, PetscInt layer,
                                double values[])
{
  const SamStressRun *const run = (const SamStressRun *)context;

  PetscFunctionBegin;
  PetscCall(SamResultsReadLayer(run->results, SavedStep(run, step), group, component, layer, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamStateLayers *GetLayers(void *context, PetscInt k)
{
  return SamResultsGetLayers(((const SamStressRun *)context)->results, k);
}

/* Sets up the bodies, with the elasticity recorded in the results, and the steps. */
static PetscErrorCode SetUpEvaluation(SamStressRun *run)
{
  SamStressSource     source  = {.parameters = SamResultsGetParameters(run->results),
                                 .name       = run->source,
                                 .has        = HasField,
                                 .read       = ReadField,
                                 .number     = ReadNumber,
                                 .conditions = ReadConditions,
                                 .layers     = GetLayers,
                                 .layer      = ReadLayer,
                                 .warn       = WarnOfSteps,
                                 .tell       = Tell,
                                 .context    = run};
  const SamParameter *rolling = SamParametersFind(source.parameters, "rolling");

  PetscFunctionBegin;
  source.slides = SamParametersFind(source.parameters, "slide") != NULL;
  source.slips  = rolling && !strcmp(rolling->text, "steady") ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscSNPrintf(run->source, sizeof(run->source), "-input %s", run->request.input));
  PetscCall(SamElasticityCreateFromParameters(run->grid, source.parameters, run->source, &run->elasticity));
  PetscCall(ChooseSteps(run));
  source.bodies = run->elasticity;
  source.steps  = run->steps;
  source.before = SavedStep(run, -1) >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SamEvaluationSetUp(run->evaluation, &source));
  run->layout = SamEvaluationGetLayout(run->evaluation);
  if (run->layout->half > 0 && !run->quiet)
    PetscCall(PetscPrintf(run->grid->comm,
                          "a = %.6g m, the half width (smaller half axis) of the contact of step %ld\n",
                          run->layout->half, (long)run->layout->half_step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- strengths of layers ---- */

static PetscErrorCode ReadStrengths(const SamOptions *from, SamStressRun *run)
{
  static const SamOptionRow row = {
    "layer_strength",  "tensile strength of the layers from the surface down (), or one for all",
    SAM_OPTION_REAL,   .range = SAM_RANGE_POSITIVE,
    .size = SHOWN - 1, .unit = "Pa"};

  PetscFunctionBegin;
  PetscCall(SamOptionsReals(from, &row, run->strength, &run->strengths));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses strengths of layers that the body does not have; one counts for all layers. */
static PetscErrorCode CheckStrengths(SamStressRun *run)
{
  const SamParameter *young;
  PetscInt            layers;
  char                name[32];

  PetscFunctionBegin;
  if (!run->strengths) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(name, sizeof(name), "body%d_layer_young", (int)run->layout->body);
  young  = SamParametersFind(SamResultsGetParameters(run->results), name);
  layers = young ? young->count : 0;
  PetscCheck(layers > 0, run->grid->comm, SAM_ERR_USER,
             "-layer_strength: body %" PetscInt_FMT " has no layers with a thickness", run->layout->body);
  PetscCheck(run->strengths == 1 || run->strengths == layers, run->grid->comm, SAM_ERR_USER,
             "-layer_strength: %" PetscInt_FMT " numbers for %" PetscInt_FMT
             " layer%s: give one for each, or one for all",
             run->strengths, layers, layers > 1 ? "s" : "");
  for (PetscInt k = run->strengths; k < PetscMin(layers, SHOWN - 1); k++) run->strength[k] = run->strength[0];
  run->strengths = PetscMin(layers, SHOWN - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the safety of a layer against its largest principal stress; empty for other numbers, or without a strength. */
static void WriteSafety(const SamStressRun *run, const SamLargestSeries *of, double value, char text[], size_t size)
{
  text[0] = '\0';
  if (!of->material || of->material > run->strengths || !strstr(of->name, "_principal_1")) return;
  if (value > 0)
    (void)snprintf(text, size, ", safety %.3g", (double)run->strength[of->material - 1] / value);
  else
    (void)snprintf(text, size, ", no tension");
}

/* Estimates the bytes of this rank. */
static double MemoryOf(const SamStressRun *run)
{
  return run->layout->memory + SAM_MEMORY_PROGRAM;
}

/* Checks that the output and its temporary file do not replace a file that is read. */
static PetscErrorCode CheckFiles(const SamStressRequest *r, const SamArguments *arguments)
{
  SamFiles files = {.count = 0};

  PetscFunctionBegin;
  PetscCall(SamFilesAddOutput(&files, r->output));
  PetscCall(SamFilesCheck(&files, PETSC_COMM_WORLD, arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads all options and the results' parameters; writes nothing. */
static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  static const SamOptionRow quiet = {"quiet", "print warnings and errors only", SAM_OPTION_BOOL, .member = 0};
  SamStressRun *const       run   = (SamStressRun *)context;
  const SamOptions          from  = {PETSC_COMM_WORLD, NULL};
  const PetscBool           help  = SamPrintHelp();

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &run->rank));
  PetscCall(SamOptionsPlugins(&from));
  PetscCall(SamStressRequestRead(&from, &run->request));
  PetscCall(SamEvaluationCreateFromOptions(&from, &run->evaluation));
  PetscCall(ReadStrengths(&from, run));
  PetscCall(SamOptionsHeading(&from, "Resources"));
  PetscCall(SamEvaluationReadTransforms(&from, run->evaluation));
  PetscCall(SamOptionsRead(&from, NULL, 1, &quiet, &run->quiet, NULL));
  if (help) PetscCall(SamMemoryRefuse(PETSC_COMM_WORLD, 0, "", "", &from)); /* declares its option */
  if (help) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckFiles(&run->request, arguments));
  PetscCall(SamResultsOpen(PETSC_COMM_WORLD, "input", run->request.input, &run->results));
  run->grid = SamResultsGetGrid(run->results);
  PetscCall(SetUpEvaluation(run));
  PetscCall(CheckStrengths(run));
  PetscCall(SamMemoryRefuse(run->grid->comm, MemoryOf(run), "-input", run->request.input, &from));
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

static PetscErrorCode CreateFile(SamStressRun *run)
{
  const PetscReal error      = (PetscReal)SamResultsGetTractionError(run->results);
  SamParameters   parameters = {.count = 0};
  char           *options;

  PetscFunctionBegin;
  PetscCall(SamEvaluationAddParameters(run->evaluation, &parameters));
  if (run->strengths)
    PetscCall(SamParametersAddReals(&parameters, "layer_strength", PETSC_FALSE, run->strengths, run->strength));
  if (error >= 0) PetscCall(SamParametersAddReals(&parameters, SAM_OUTPUT_TRACTIONS, PETSC_FALSE, 1, &error));
  PetscCall(SamStressFileCreate(run->grid, run->request.output, run->layout, &parameters, &run->file));
  PetscCall(SamStressFileSetText(run->file, "input", run->request.input));
  PetscCall(PetscOptionsGetAll(NULL, &options));
  PetscCall(SamStressFileSetText(run->file, "options", options));
  PetscCall(PetscFree(options));
  PetscCall(SamStressFileSetText(run->file, "input_options", SamResultsGetOptions(run->results)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the numbers of the load steps, as petsam counts them. */
static PetscErrorCode WriteStepNumbers(SamStressRun *run)
{
  double *numbers;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(run->steps, &numbers));
  for (PetscInt k = 0; k < run->steps; k++) PetscCall(ReadNumber(run, k, SAM_STEP_NUMBER, &numbers[k]));
  PetscCall(SamStressFileSetHistory(run->file, "step", "1", "number of the load step, from 1", numbers));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the largest values of all steps, and of the fatigue parameters. */
static PetscErrorCode WriteLargest(SamStressRun *run)
{
  SamLargestSeries of;

  PetscFunctionBegin;
  for (PetscInt k = 0; SamEvaluationGetLargest(run->evaluation, k, &of); k++) {
    PetscCall(SamStressFileWriteLargest(run->file, &of));
    if (of.missing && !strcmp(of.name, "edge_stress_xx"))
      PetscCall(Warn(run, "",
                     "the contact edge is not found in %ld of %ld steps, and /history/edge_stress_xx_max is NaN there: "
                     "less than 95 %% of it is smooth and resolved: use a finer grid, which does not help dissimilar "
                     "bodies, nor where surfaces attract each other",
                     (long)of.missing, (long)run->steps));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the step with the largest value; -1: none. */
static PetscInt MostOf(const SamLargestSeries *of)
{
  PetscInt most = -1;

  for (PetscInt s = 0; s < of->count; s++)
    if (!isnan(of->step[s].value) && (most < 0 || of->step[s].value > of->step[most].value)) most = s;
  return most;
}

/* True if a value of a material is the largest of its kind in all materials. */
static PetscBool IsLargestOfMaterials(SamStressRun *run, const SamLargestSeries *of)
{
  const char *const kind = strrchr(of->name, '_');
  SamLargestSeries  other;

  for (PetscInt k = 0; SamEvaluationGetLargest(run->evaluation, k, &other); k++)
    if (other.material && !strcmp(strrchr(other.name, '_'), kind) &&
        other.step[MostOf(&other)].value > of->step[MostOf(of)].value)
      return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Prints the largest values over all steps; for many materials only those that are largest of all. */
static PetscErrorCode PrintLargest(SamStressRun *run)
{
  SamLargestSeries of;
  PetscInt         materials = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; SamEvaluationGetLargest(run->evaluation, k, &of); k++)
    materials = PetscMax(materials, of.material);
  for (PetscInt k = 0; SamEvaluationGetLargest(run->evaluation, k, &of); k++) {
    const PetscInt    most     = MostOf(&of);
    const SamLargest *at       = most < 0 ? &(SamLargest){NAN, {NAN, NAN, NAN}} : &of.step[most];
    char              step[32] = "", unit[16] = "", safety[48];
    double            number = 0;

    const PetscBool edge = of.places == 2 ? PETSC_TRUE : PETSC_FALSE;

    if (!of.shown[0] || (of.material && materials > SHOWN && !IsLargestOfMaterials(run, &of))) continue;
    if (edge && most < 0) continue; /* a warning has told why */
    if (strcmp(of.unit, "1")) (void)snprintf(unit, sizeof(unit), " %s", of.unit);
    if (!k || edge) PetscCall(ReadNumber(run, PetscMax(most, 0), SAM_STEP_NUMBER, &number));
    if (!k || edge) (void)snprintf(step, sizeof(step), " in step %.0f", number);
    if (strstr(of.name, "_tension") && at->value <= 0) { /* compression all over the interface */
      PetscCall(PetscPrintf(run->grid->comm, "  %-11s %s: none\n", k ? "" : "maximum", of.shown));
      continue;
    }
    WriteSafety(run, &of, at->value, safety, sizeof(safety));
    PetscCall(PetscPrintf(run->grid->comm, "  %-11s %s %.6g%s at %s(%.4g, %.4g, %.4g) m%s%s\n", k ? "" : "maximum",
                          of.shown, at->value, unit, run->layout->own ? "body 2's own point " : "", at->place[0],
                          at->place[1], at->place[2], step, safety));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the run ---- */

static PetscErrorCode PrintBanner(SamStressRun *run)
{
  const SamGrid g = run->grid;
  PetscMPIInt   ranks;
  char          memory[32];

  PetscFunctionBegin;
  if (run->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(g->comm, &ranks));
  SamDescribeBytes(MemoryOf(run), memory, sizeof(memory));
  PetscCall(PetscPrintf(g->comm,
                        "petsam-stress " PETSAM_VERSION ": stresses in body %" PetscInt_FMT "\n"
                        "  results     %s, %" PetscInt_FMT " x %" PetscInt_FMT " cells\n"
                        "  steps       %" PetscInt_FMT ", depths %" PetscInt_FMT ", %s\n"
                        "  ranks       %d, memory about %s per rank\n\n",
                        run->layout->body, run->request.input, g->nx, g->ny, run->steps, run->layout->n[SAM_Z],
                        run->layout->section ? "on a section" : "maps", ranks, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns of depths in another unit: the stresses of a contact decay within its own size. */
static PetscErrorCode WarnOfDepths(SamStressRun *run)
{
  const double width   = 2 * (double)run->grid->length,
               deepest = run->layout->coordinate[SAM_Z][run->layout->n[SAM_Z] - 1];

  PetscFunctionBegin;
  if (deepest > DEEP * width)
    PetscCall(
      Warn(run, "-depths: ", "%g m is %.2g times the width of the grid: check the unit, m", deepest, deepest / width));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamStressRun run_of_process; /* for the signal handler */

/* Removes the temporary file, which may be large, if a signal ends the program. */
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
  PetscLogDouble      end;

  PetscFunctionBegin;
  CatchSignals();
  PetscCall(PrintBanner(run));
  PetscCall(WarnOfDepths(run));
  PetscCall(PetscTime(&run->start));
  run->told    = run->start;
  run->writing = PETSC_TRUE;
  PetscCall(CreateFile(run));
  PetscCall(SamEvaluationCompute(run->evaluation, SamStressFileWrite, run->file));
  if (run->told > run->start) { /* lines of progress end with the last one */
    run->told = -INFINITY;
    PetscCall(Tell(run, "all", 1, 0));
  }
  PetscCall(WriteStepNumbers(run));
  PetscCall(WriteLargest(run));
  if (run->doubt[0]) PetscCall(SamStressFileSetText(run->file, "cycle_warning", run->doubt));
  PetscCall(SamStressFileFinish(run->file));
  run->writing = PETSC_FALSE;
  PetscCall(PetscTime(&end));
  if (!run->quiet) PetscCall(PrintLargest(run));
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

/* Removes the temporary file. */
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

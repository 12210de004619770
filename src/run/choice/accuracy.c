/*
  -accuracy: the grid, and the steps, by which the errors of all numbers are as small as asked.

  Trials are runs without files, each with its companions (errors.c): the first on few cells (accuracybegin.c), and each
  further one on the grid that the errors of the one before ask for (accuracychange.c).

  The path in a single row is given by definition, N before the shear, so that its steps are not chosen.
*/
#include "accuracyimpl.h"
#include <petsam/private/arguments.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/file.h>
#include <petsam/private/gap.h>
#include <petsam/private/grid.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>
#include <math.h>
#include <string.h>

#define USUAL  0.01 /* accuracy of -grid auto without -accuracy */
#define TRIALS 12   /* most trials */
#define PROBE  16   /* cells per side of a grid that is not used */
#define LONG   10   /* s: a trial, or a run, that takes longer is told before */

/* ---- options ---- */

static const SamOptionRow rows[] = {
  {"accuracy", "maximum error () of the numbers, as 1%: chooses grid and steps unless given", SAM_OPTION_REAL,
   offsetof(SamAccuracy, error), .range = SAM_RANGE_PART, .unit = "1"},
  {"accuracy_of", "the numbers that it concerns, separated by commas: all with an error", SAM_OPTION_STRING,
   offsetof(SamAccuracy, numbers), .size = SAM_ACCURACY_NAMES, .needs = "accuracy or -grid"},
  {"grid", "chooses the grid by -accuracy, of 1% if that is not given", SAM_OPTION_WORD, offsetof(SamAccuracy, grid),
   .size = 8, .words = "auto", .excludes = "grid_n,grid_size"}};

/* Writes the value of an option, of one number or two; in plane strain the second one is the first. */
static void WritePair(const double x[2], PetscInt axes, int digits, char text[], size_t size)
{
  (void)snprintf(text, size, axes == 1 || x[0] == x[1] ? "%.*g" : "%.*g,%.*g", digits, x[0], digits, x[1]);
}

#define CHOSEN 4 /* options of a choice */
#define VALUE  96

static const char *const chosen[CHOSEN] = {"grid_n", "grid_size", "grid_center", "steps"};

/* Writes the value of an option of a choice; empty if it is given, or is the default. */
static void WriteOption(const SamTask *task, const SamChoice *c, int option, char text[VALUE])
{
  const double n[2]      = {(double)c->n[0], (double)c->n[1]};
  const double width[2]  = {(double)c->width[0], (double)c->width[1]};
  const double center[2] = {(double)c->center[0], (double)c->center[1]};

  text[0] = '\0';
  if (option == 0 && task->number) WritePair(n, task->axes, 17, text, VALUE);
  if (option == 1 && task->size) WritePair(width, task->axes, 6, text, VALUE);
  if (option == 2 && task->center && (center[0] != 0 || center[1] != 0)) WritePair(center, 2, 6, text, VALUE);
  if (option == 3 && task->steps) (void)snprintf(text, VALUE, "%ld", (long)c->steps);
}

/* Makes a choice the options of the next simulation. */
static PetscErrorCode SetOptions(const SamOptions *from, const SamTask *task, const SamChoice *c)
{
  char option[64], text[VALUE];

  PetscFunctionBegin;
  for (int k = 0; k < CHOSEN; k++) {
    (void)snprintf(option, sizeof(option), "-%s%s", SamOptionsPrefix(from), chosen[k]);
    WriteOption(task, c, k, text);
    if (text[0]) PetscCall(PetscOptionsSetValue(NULL, option, text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadOptions(const SamOptions *from, SamAccuracy *a)
{
  PetscBool given[3], restarts;

  PetscFunctionBegin;
  a->error = NAN;
  PetscCall(SamOptionsRead(from, "Accuracy", SAM_OPTION_ROWS(rows), a, given));
  if (!given[0]) a->error = given[2] ? USUAL : 0;
  PetscCall(SamOptionsHas(from, "restart", &restarts));
  PetscCheck(!(a->error > 0) || !restarts || SamPrintHelp(), from->comm, SAM_ERR_USER,
             "-%saccuracy with -restart: grid and steps are those of the checkpoint: omit it", SamOptionsPrefix(from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the options once, with any grid, for those that are not given. */
static PetscErrorCode Prepare(const SamOptions *from, const SamArguments *arguments, SamTask *task, SamChoice *c)
{
  PetscBool *const free[CHOSEN] = {&task->number, &task->size, &task->center, &task->steps};
  const SamChoice  any          = {{PROBE, PROBE}, 1, {1e-3, 1e-3}, {0, 0}};
  PetscReal        width[2], center[2];
  PetscInt         n[2];
  PetscBool        periodic[2];
  SamGap           gap;
  SamSimulation    s;

  PetscFunctionBegin;
  for (int k = 0; k < CHOSEN; k++) {
    PetscCall(SamOptionsHas(from, chosen[k], free[k]));
    *free[k] = *free[k] ? PETSC_FALSE : PETSC_TRUE;
  }
  PetscCall(SamOptionsHas(from, "elasticity periodic", &periodic[0]));
  PetscCall(SamOptionsHas(from, "elasticity plane_periodic", &periodic[1]));
  PetscCheck(!task->size || !(periodic[0] || periodic[1]), from->comm, SAM_ERR_USER,
             "-%saccuracy with periodic bodies: -grid_size is their period, and is not chosen: give it",
             SamOptionsPrefix(from));
  PetscCall(SamGapCreate(from->comm, &gap));
  PetscCall(SamGapSetOptionsPrefix(gap, from->prefix));
  PetscCall(SamGapGetFileGrid(gap, n, width, center));
  PetscCall(SamGapDestroy(&gap));
  if (n[0] > 0) task->number = PETSC_FALSE;
  if (width[0] > 0) task->size = PETSC_FALSE;
  task->center = task->center && task->size ? PETSC_TRUE : PETSC_FALSE;
  task->axes   = 2;
  PetscCall(SetOptions(from, &(SamTask){.axes = 2, .number = task->number, .size = task->size}, &any));
  PetscCall(SamSimulationCreate(from->comm, &s));
  PetscCall(SamSimulationSetFromOptions(s, from, arguments));
  if (s->has_output) PetscCall(SamFileCheckName(s->setup.grid, "output", s->filename, SAM_FILE_RESULTS));
  PetscCall(SamTaskBegin(s, task, c));
  PetscCall(SamSimulationDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a trial ---- */

/* Extends the rectangle of the contact by that of the last step. */
static PetscErrorCode Extend(SamContact contact, SamTrial *t)
{
  const SamGrid      grid    = SamContactGetGrid(contact);
  const PetscReal    cell[2] = {grid->dx, grid->dy};
  PetscInt           first[2], n[2];
  const SamSolution *solution;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(contact, &solution));
  PetscCall(SamGridGetSupport(grid, solution->pressure, PETSC_FALSE, first, n));
  if (!n[0]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; k++) {
    const PetscReal low = grid->center[k] - 0.5 * grid->width[k] + (PetscReal)first[k] * cell[k];

    t->low[k]  = t->touched ? PetscMin(t->low[k], low) : low;
    t->high[k] = t->touched ? PetscMax(t->high[k], low + (PetscReal)n[k] * cell[k]) : low + (PetscReal)n[k] * cell[k];
  }
  t->touched = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if a list has a name of that many letters; names are separated by commas, and blanks. */
static PetscBool HasName(const char list[], const char name[], size_t letters)
{
  for (const char *at = list; *at; at += strcspn(at, ","), at += strspn(at, ", "))
    if (strcspn(at, ",") == letters && !strncmp(at, name, letters)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void AddName(SamTrial *t, const char name[])
{
  const size_t used = strlen(t->names);

  (void)snprintf(t->names + used, sizeof(t->names) - used, "%s%s", used ? ", " : "", name);
}

/* Lists the numbers that may have errors: those of the table, and those that are next to nothing in this trial. */
static PetscErrorCode ListNumbers(SamContact contact, SamTrial *t)
{
  SamState state;

  PetscFunctionBegin;
  t->names[0] = '\0';
  for (PetscInt k = 0; k < t->table.count; k++) AddName(t, t->table.row[k].name);
  PetscCall(SamContactGetState(contact, &state));
  for (PetscInt k = 0; k < SamStateCountNumbers(state); k++) {
    PetscInt              id;
    const SamStateNumber *of = SamStateNumberOf(state, k, &id);

    if (of->order && of->result && !HasName(t->names, of->name, strlen(of->name))) AddName(t, of->name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Note(void *context, SamContact contact, const SamSimulationEvent *news)
{
  SamTrial *const t = (SamTrial *)context;

  PetscFunctionBegin;
  if ((news->kind == SAM_NOTIFY_STEP || news->kind == SAM_NOTIFY_CYCLE_STEP) && SamStepIsSolved(news->result))
    PetscCall(Extend(contact, t));
  if (news->kind == SAM_NOTIFY_ERRORS) {
    t->table = *news->errors;
    PetscCall(ListNumbers(contact, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses options that nobody reads, once a trial has read those of the contact and of the history. */
static PetscErrorCode RefuseUnknown(const SamOptions *from, const SamArguments *arguments, const SamAccuracy *a)
{
  static const char *const of_run[] = {"-errors", "-grid_check", NULL};
  PetscBool                ignored;

  PetscFunctionBegin;
  for (int k = 0; of_run[k]; k++) PetscCall(PetscOptionsHasName(NULL, NULL, of_run[k], &ignored));
  for (int k = 0; a->later && a->later[k]; k++) PetscCall(PetscOptionsHasName(NULL, NULL, a->later[k], &ignored));
  PetscCall(SamArgumentsRefuseUnknown(from->comm, arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prepares a simulation without its files. */
static PetscErrorCode PrepareAlone(SamSimulation s, const SamOptions *from, SamTrial *t)
{
  PetscFunctionBegin;
  s->has_output = s->needs.stiffness = PETSC_FALSE;
  s->checkpoints                     = (SamCheckpoints){.every = 0};
  s->needs.companion = s->untold = PETSC_TRUE;
  PetscCall(SamSimulationSetMonitor(s, Note, t));
  PetscCall(SamSimulationSetUp(s, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs it, and keeps whether it failed. */
static PetscErrorCode RunAlone(SamSimulation s, SamTrial *t)
{
  char           message[SAM_MESSAGE] = "";
  PetscErrorCode code;
  PetscBool      stopped;

  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
  code = SamSimulationRun(s);
  PetscCall(PetscPopErrorHandler());
  t->failed = code ? PETSC_TRUE : PETSC_FALSE;
  t->steps  = s->needs.steps;
  PetscCall(SamSimulationGetStatus(s, &t->status, &stopped));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Try(const SamOptions *from, const SamArguments *arguments, const SamTask *task,
                          const SamChoice *c, SamTrial *t)
{
  SamSimulation s;

  PetscFunctionBegin;
  *t = (SamTrial){.touched = PETSC_FALSE};
  PetscCall(SetOptions(from, task, c));
  PetscCall(SamSimulationCreate(from->comm, &s));
  PetscCall(SamSimulationSetFromOptions(s, from, arguments));
  PetscCall(PrepareAlone(s, from, t));
  PetscCall(RefuseUnknown(from, arguments, task->asked));
  PetscCall(RunAlone(s, t));
  PetscCall(SamSimulationDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what a trial says ---- */

PetscBool SamTaskConcerns(const SamAccuracy *a, const char name[])
{
  return !a->numbers[0] || HasName(a->numbers, name, strlen(name)) ? PETSC_TRUE : PETSC_FALSE;
}

const SamErrorRow *SamAccuracyWorst(const SamAccuracy *a, const SamErrorTable *t)
{
  const SamErrorRow *worst = NULL;

  for (PetscInt k = 0; k < t->count; k++)
    if (SamTaskConcerns(a, t->row[k].name) && (!worst || !(t->row[k].error <= worst->error))) worst = &t->row[k];
  return worst;
}

void SamAccuracyWriteMissed(const SamAccuracy *a, const SamErrorTable *t, const SamErrorRow *but, char text[],
                            size_t size)
{
  PetscInt missed = 0, all = 0;

  text[0] = '\0';
  for (PetscInt k = 0; k < t->count; k++) {
    const SamErrorRow *row  = &t->row[k];
    const size_t       used = strlen(text);
    char               error[SAM_ERROR_TEXT];

    if (!SamTaskConcerns(a, row->name)) continue;
    all++;
    if (row->error <= (double)a->error) continue;
    missed++;
    if (row == but) continue;
    (void)snprintf(text + used, size - used, "%s%s %s (%s)", used ? ", " : "; above it, too: ", row->name,
                   SamErrorWrite(row->error, error, sizeof(error)), SamCauseNames[row->cause]);
  }
  if (missed < all) {
    const size_t used = strlen(text);

    (void)snprintf(text + used, size - used, "; %" PetscInt_FMT " of %" PetscInt_FMT " numbers have reached it",
                   all - missed, all);
  }
}

/* Refuses a name that no number with an error has. */
static PetscErrorCode CheckNames(const SamOptions *from, const SamAccuracy *a, const SamTrial *t)
{
  PetscFunctionBegin;
  for (const char *at = a->numbers; *at && t->names[0]; at += strcspn(at, ","), at += strspn(at, ", ")) {
    const size_t letters = strcspn(at, ",");

    PetscCheck(HasName(t->names, at, letters), from->comm, SAM_ERR_USER,
               "-%saccuracy_of %.*s: no number of this run with an error: expected some of %s", SamOptionsPrefix(from),
               (int)letters, at, t->names);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Describes what was chosen. */
static void Describe(const SamTask *task, const SamChoice *c, SamAccuracy *a)
{
  char text[VALUE];

  a->chosen[0] = '\0';
  for (int k = 0; k < CHOSEN; k++) {
    const size_t used = strlen(a->chosen);

    WriteOption(task, c, k, text);
    if (text[0]) (void)snprintf(a->chosen + used, sizeof(a->chosen) - used, " -%s %s", chosen[k], text);
  }
}

/* Tells what a trial found, before the choice changes. */
static PetscErrorCode Tell(const SamTask *task, const SamChoice *c, const SamTrial *t, SamAccuracy *a)
{
  const SamErrorRow *worst = SamAccuracyWorst(a, &t->table);
  char               text[640], error[SAM_ERROR_TEXT], what[160] = "";

  PetscFunctionBegin;
  if (!a->tell) PetscFunctionReturn(PETSC_SUCCESS);
  if (t->failed || t->status)
    (void)snprintf(what, sizeof(what),
                   t->status == SAM_STATUS_EDGE_CONTACT ? "the contact reaches the edge" : "no solution");
  else if (worst)
    (void)snprintf(what, sizeof(what), "%s has the maximum error, %s", worst->name,
                   SamErrorWrite(worst->error, error, sizeof(error)));
  Describe(task, c, a);
  (void)snprintf(text, sizeof(text), "trial %ld:%s: %s", (long)a->trials, a->chosen, what);
  PetscCall((*a->tell)(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the work of a trial, or a run, in cells times steps per row. */
static double WorkOf(const SamChoice *c)
{
  return (double)c->n[0] * (double)c->n[1] * (double)c->steps;
}

/* Returns the time that the run of a choice takes (s), by that of the last trial: in proportion to cells and steps. */
static double Forecast(const SamTask *task, const SamChoice *c)
{
  return task->work > 0 ? task->seconds * WorkOf(c) / task->work : 0;
}

/* Tells what is done next, if it takes long. */
static PetscErrorCode Foretell(const SamTask *task, const SamChoice *c, const char what[], SamAccuracy *a)
{
  const double seconds = Forecast(task, c);
  char         text[640];

  PetscFunctionBegin;
  if (!a->tell || !(seconds > LONG)) PetscFunctionReturn(PETSC_SUCCESS);
  Describe(task, c, a);
  (void)snprintf(text, sizeof(text), "%s:%s takes about %.2g %s", what, a->chosen, seconds / (seconds < 100 ? 1 : 60),
                 seconds < 100 ? "s" : "min");
  PetscCall((*a->tell)(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tries a choice, and changes it by what is found. */
static PetscErrorCode TryNext(const SamOptions *from, const SamArguments *arguments, SamTask *task, SamChoice *c,
                              SamTrial *trial, SamAccuracy *a, PetscBool *last)
{
  const double began = MPI_Wtime();
  char         what[32];

  PetscFunctionBegin;
  (void)snprintf(what, sizeof(what), "trial %ld", (long)a->trials + 1);
  PetscCall(Foretell(task, c, what, a));
  PetscCall(Try(from, arguments, task, c, trial));
  PetscCall(CheckNames(from, a, trial));
  a->trials++;
  PetscCall(Tell(task, c, trial, a));
  task->seconds = MPI_Wtime() - began;
  PetscCall(SamMax(from->comm, 1, &task->seconds)); /* all processes choose alike */
  task->work = WorkOf(c);
  task->spent += task->seconds;
  SamTaskChange(task, trial, c, last, a->limit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Choose(const SamOptions *from, const SamArguments *arguments, SamAccuracy *a)
{
  const double began = MPI_Wtime();
  SamTask      task  = {.asked = a};
  SamChoice    c;
  SamTrial    *trial;
  PetscBool    last = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(Prepare(from, arguments, &task, &c));
  PetscCall(PetscNew(&trial));
  if (!task.number && !task.size && !task.steps) last = PETSC_TRUE;
  while (!last && a->trials < TRIALS) PetscCall(TryNext(from, arguments, &task, &c, trial, a, &last));
  PetscCall(PetscFree(trial));
  PetscCall(SetOptions(from, &task, &c));
  PetscCall(Foretell(&task, &c, "run", a));
  Describe(&task, &c, a);
  a->seconds = MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAccuracyChoose(const SamOptions *from, const SamArguments *arguments, SamAccuracy *a)
{
  PetscBool has[2];

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(ReadOptions(from, a));
  if (!(a->error > 0) || SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Choose(from, arguments, a));
  PetscCall(SamOptionsHas(from, "errors", &has[0]));
  PetscCall(SamOptionsHas(from, "grid_check", &has[1]));
  if (!has[0] && !has[1]) PetscCall(PetscOptionsSetValue(NULL, "-errors", "companion"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

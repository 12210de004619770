/*
  -accuracy: the grid, and the steps, by which the errors of all numbers are as small as asked.

  Trials are runs without files, each with its companions (errors.c). The first has few cells; the width of its grid is
  that of a contact in closed form, or, without one, that at whose border the separation of the bodies is what Hertz's
  contact of this load has at its edge. A trial tells where contact is, and, by its errors, how many times narrower the
  cells must be: with the difference d to half the cells, and D between these and a quarter, the order is
  p = log2(D/d), from 1 to that of the number. Errors by the steps are of first order. If the cells must be more than
  twice as narrow, or the steps more than twice as many, a finer trial follows; where a trial costs little, until the
  errors on the chosen grid itself are small enough.

  The path in a single row is given by definition, N before the shear, so that its steps are not chosen.
*/
#include "simulationimpl.h"
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

#define USUAL      0.01  /* accuracy of -grid auto without -accuracy */
#define TRIALS     12    /* most trials */
#define FEW        64    /* cells along the shorter side of the first grid, */
#define FEW_ROW    256   /* and of a row in plane strain */
#define MOST       4096  /* most cells along a side that are chosen, */
#define MOST_ROW   65536 /* and of a row in plane strain */
#define MOST_STEPS 1024  /* most steps per row that are chosen */
#define NEAR       2.0   /* the errors of a trial are believed for cells this many times narrower */
#define CHEAP      1e6   /* cells times steps of a trial up to which it is repeated on the chosen grid */
#define AT_ONCE    4.0   /* most times by which cells become narrower from one trial to the next */
#define ROOM       1.2   /* ratio of the width of the grid to that of the contact */
#define STALLS     2     /* finer trials with the same error after which no finer ones follow */
#define SAME       0.1   /* relative changes of the grid's width and place that are no reason for another trial */
#define FLAT       4.0   /* most times by which a cell is longer than wide */
#define PROBE      16    /* cells per side on which the separation is looked at */

/* A grid and steps that are tried or chosen. */
typedef struct {
  PetscInt  n[2], steps;
  PetscReal width[2], center[2];
} Choice;

/* What is asked for, and which parts of a choice are not given by options. */
typedef struct {
  const SamAccuracy *asked;
  PetscBool          number, size, center, steps; /* of cells, width, centre of the grid, steps per row */
  PetscInt           axes;
  PetscInt           few, most;    /* cells along the shorter side: of the first grid; most along any side */
  double             cell, factor; /* width of the cells of the last trial (m), and how many times they were too wide */
  PetscInt           stalls;       /* number of finer trials whose errors are the same */
} Task;

/* What a trial found. */
typedef struct {
  PetscBool     touched;
  PetscReal     low[2], high[2]; /* the rectangle of the contact in all steps, m */
  SamErrorTable table;
  PetscInt      steps;       /* that it had */
  char          names[2048]; /* its numbers that may have errors, separated by ", " */
  SamStatus     status;
  PetscBool     failed; /* it ended with an error */
} Trial;

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
static void WriteOption(const Task *task, const Choice *c, int option, char text[VALUE])
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
static PetscErrorCode SetOptions(const SamOptions *from, const Task *task, const Choice *c)
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

/* ---- the first grid ---- */

/* Returns the largest normal load, or approach, of the history. */
static PetscReal Largest(SamSimulation s, PetscBool *force)
{
  PetscReal most = 0;

  *force = PETSC_TRUE;
  for (PetscInt k = 0; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k)) {
    SamControl control;

    if (!SamHistoryIsLast(s->history, k)) continue;
    control = SamHistoryGetStep(s->history, k);
    *force  = control.force[SAM_COMPONENT_N];
    most    = PetscMax(most, control.value[SAM_COMPONENT_N]);
  }
  return most;
}

/* Gets how much wider the separation is at the border of a square, or row, of this half width than at its least. */
static PetscErrorCode Separation(const SamSetup *s, PetscReal half, double *wider)
{
  const PetscInt  axes = s->grid->axes, n[2] = {PROBE, axes > 1 ? PROBE : 1};
  const PetscReal width[2] = {2 * half, axes > 1 ? 2 * half : 1};
  double least[2] = {-INFINITY, -INFINITY}; /* minus the least separation: of all cells, of those at the border */
  const double *heights;
  SamGrid       grid;
  Vec           h;

  PetscFunctionBegin;
  PetscCall(SamGridCreate(s->grid->comm, n, width, s->grid->center, &grid));
  PetscCall(SamGridCreateVec(grid, 1, &h));
  PetscCall(SamGapFill(s->gap, grid, h));
  PetscCall(VecGetArrayRead(h, &heights));
  for (PetscInt c = 0; c < grid->cells; c++) {
    const PetscInt  i = c % n[0], j = grid->row_start + c / n[0];
    const PetscBool border = i == 0 || i == n[0] - 1 || (axes > 1 && (j == 0 || j == n[1] - 1));

    least[0] = PetscMax(least[0], -heights[c]);
    if (border) least[1] = PetscMax(least[1], -heights[c]);
  }
  PetscCall(VecRestoreArrayRead(h, &heights));
  PetscCall(SamMax(grid->comm, 2, least));
  *wider = least[0] - least[1];
  PetscCall(VecDestroy(&h));
  PetscCall(SamGridDestroy(&grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the half width at whose border the separation is that of Hertz's contact at its edge; 0: none is. */
static PetscErrorCode Search(const SamSetup *s, PetscBool force, PetscReal value, PetscReal *half)
{
  const double modulus = (double)SamPairModulus(s->pair);

  PetscFunctionBegin;
  for (double a = 1e-9; a < 1e3; a *= 1.2) {
    double         wider = 0, load;
    PetscErrorCode code;
    char           message[SAM_MESSAGE] = "";

    PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
    code = Separation(s, a, &wider);
    PetscCall(PetscPopErrorHandler());
    load  = !force ? 2 * wider : s->grid->axes > 1 ? 8. / 3 * modulus * a * wider : 0.5 * PETSC_PI * modulus * wider;
    *half = (PetscReal)a;
    if (code || load >= (double)value) PetscFunctionReturn(PETSC_SUCCESS); /* an error: wider than the bodies */
  }
  *half = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the width of the first grid. */
static PetscErrorCode ChooseWidth(SamSimulation s, Choice *c)
{
  const SamSetup *setup = &s->setup;
  PetscBool       force, known;
  const PetscReal value = Largest(s, &force);
  PetscReal       half[2];

  PetscFunctionBegin;
  PetscCall(SamAdviceEstimateContact(setup, force, value, half, &known));
  for (PetscInt k = 0; k < setup->grid->axes; k++)
    if (!isfinite(half[k]) || !(half[k] > 0)) known = PETSC_FALSE;
  if (!known) {
    PetscCall(Search(setup, force, value, &half[0]));
    half[1] = half[0];
  }
  PetscCheck(half[0] > 0 && value > 0, s->comm, SAM_ERR_USER,
             "-accuracy: the loads and the shape do not give the width of the contact: give -grid_size");
  for (PetscInt k = 0; k < 2; k++)
    c->width[k] = (PetscReal)SamAdviceRoundUp(2 * ROOM * (double)half[k % setup->grid->axes]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses cells of about the same number along both sides, unless one is much longer. */
static void ChooseCells(const Task *task, double few, Choice *c)
{
  const double shorter = (double)PetscMin(c->width[0], c->width[task->axes - 1]);

  for (PetscInt k = 0; k < 2; k++) {
    const double n = few * PetscMax(1, (double)c->width[k] / shorter / FLAT);

    c->n[k] = k < task->axes ? (PetscInt)PetscMin(SamGridRoundUp(n), (double)task->most) : 1;
  }
}

/* Finds which parts are not given, from a simulation that has only read its options. */
static PetscErrorCode Begin(SamSimulation s, Task *task, Choice *c)
{
  const SamGrid grid = s->setup.grid;
  PetscInt      rows_of_history;

  PetscFunctionBegin;
  task->axes      = grid->axes;
  task->few       = SamGridIsRow(grid) ? FEW_ROW : FEW;
  task->most      = SamGridIsRow(grid) ? MOST_ROW : MOST;
  rows_of_history = 1 + (s->needs.steps - SamHistoryGetStart(s->history)) / SamHistoryGetIncrements(s->history);
  if (rows_of_history < 2 || s->step_rtol > 0 || s->plan.bands) task->steps = PETSC_FALSE;
  for (PetscInt k = 0; k < 2; k++) {
    c->n[k]      = k ? grid->ny : grid->nx;
    c->width[k]  = grid->width[k];
    c->center[k] = grid->center[k];
  }
  c->steps = SamHistoryGetIncrements(s->history);
  if (task->size) PetscCall(ChooseWidth(s, c));
  if (task->number) ChooseCells(task, (double)task->few, c);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the options once, with any grid, for those that are not given. */
static PetscErrorCode Prepare(const SamOptions *from, const SamArguments *arguments, Task *task, Choice *c)
{
  PetscBool *const free[CHOSEN] = {&task->number, &task->size, &task->center, &task->steps};
  const Choice     any          = {{PROBE, PROBE}, 1, {1e-3, 1e-3}, {0, 0}};
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
  PetscCall(SetOptions(from, &(Task){.axes = 2, .number = task->number, .size = task->size}, &any));
  PetscCall(SamSimulationCreate(from->comm, &s));
  PetscCall(SamSimulationSetFromOptions(s, from, arguments));
  if (s->has_output) PetscCall(SamFileCheckName(s->setup.grid, "output", s->filename, SAM_FILE_RESULTS));
  PetscCall(Begin(s, task, c));
  PetscCall(SamSimulationDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a trial ---- */

/* Extends the rectangle of the contact by that of the last step. */
static PetscErrorCode Extend(SamContact contact, Trial *t)
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

static void AddName(Trial *t, const char name[])
{
  const size_t used = strlen(t->names);

  (void)snprintf(t->names + used, sizeof(t->names) - used, "%s%s", used ? ", " : "", name);
}

/* Lists the numbers that may have errors: those of the table, and those that are next to nothing in this trial. */
static PetscErrorCode ListNumbers(SamContact contact, Trial *t)
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
  Trial *const t = (Trial *)context;

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
static PetscErrorCode PrepareAlone(SamSimulation s, const SamOptions *from, Trial *t)
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
static PetscErrorCode RunAlone(SamSimulation s, Trial *t)
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

static PetscErrorCode Try(const SamOptions *from, const SamArguments *arguments, const Task *task, const Choice *c,
                          Trial *t)
{
  SamSimulation s;

  PetscFunctionBegin;
  *t = (Trial){.touched = PETSC_FALSE};
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

/* True if -accuracy concerns the number of this name. */
static PetscBool Concerns(const SamAccuracy *a, const char name[])
{
  return !a->numbers[0] || HasName(a->numbers, name, strlen(name)) ? PETSC_TRUE : PETSC_FALSE;
}

const SamErrorRow *SamAccuracyWorst(const SamAccuracy *a, const SamErrorTable *t)
{
  const SamErrorRow *worst = NULL;

  for (PetscInt k = 0; k < t->count; k++)
    if (Concerns(a, t->row[k].name) && (!worst || !(t->row[k].error <= worst->error))) worst = &t->row[k];
  return worst;
}

/* Refuses a name that no number with an error has. */
static PetscErrorCode CheckNames(const SamOptions *from, const SamAccuracy *a, const Trial *t)
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

/* Returns the error of a number by the steps: that to twice as many is half of it, that to half as many the whole. */
static double ErrorBySteps(const SamErrorRow *row, PetscInt steps)
{
  return (steps == 1 ? 2 : 1) * row->of[SAM_CAUSE_STEPS];
}

/*
  Returns how many times narrower cells make the error of a number, as it is told, as small as this. It is told as the
  larger one of two differences, which is that of an order of at least 1 (estimates.c).
*/
static double Narrower(const SamErrorRow *row, double wanted)
{
  const double near  = fabs(row->value - row->run[SAM_RUN_HALF]),
               far   = fabs(row->run[SAM_RUN_HALF] - row->run[SAM_RUN_QUARTER]);
  const double error = row->of[SAM_CAUSE_CELLS];
  double       order = 1;

  if (!(error >= 0)) return AT_ONCE;   /* unknown: a companion has ended early */
  if (error == row->cells && near > 0) /* no closed form */
    order = PetscMax(1, PetscMin((double)row->order, log2(far / near)));
  return pow(error / wanted, 1 / order);
}

/* Gets how many times narrower the cells must be, and how many times more steps there must be. */
static void Demand(const Task *task, const Choice *c, const Trial *t, double factor[2])
{
  const double asked = (double)task->asked->error;

  factor[0] = factor[1] = 0;
  for (PetscInt k = 0; k < t->table.count; k++) {
    const SamErrorRow *row  = &t->table.row[k];
    const double       part = task->steps ? ErrorBySteps(row, c->steps) : 0;
    const double       left = asked - (part > 0 ? PetscMin(part, 0.5 * asked) : 0);

    if (!Concerns(task->asked, row->name)) continue;
    factor[0] = PetscMax(factor[0], Narrower(row, left));
    if (isnan(part)) factor[1] = PetscMax(factor[1], AT_ONCE);
    if (part > 0.5 * asked) factor[1] = PetscMax(factor[1], part / (0.5 * asked));
  }
}

/* ---- from one trial to the next ---- */

/* Chooses the width of the grid by the contact that was found. */
static void Fit(const Task *task, const Trial *t, Choice *c)
{
  for (PetscInt k = 0; k < task->axes; k++) {
    const PetscReal cell = c->width[k] / (PetscReal)c->n[k], middle = 0.5 * (t->low[k] + t->high[k]),
                    size = t->high[k] - t->low[k];

    if (task->center && PetscAbsReal(middle - c->center[k]) > 0.1 * size) {
      c->center[k] = middle;
      c->width[k]  = (PetscReal)SamAdviceRoundUp((double)(ROOM * size + 2 * cell));
    } else {
      const PetscReal reach = PetscMax(t->high[k] - c->center[k], c->center[k] - t->low[k]);

      c->width[k] = (PetscReal)SamAdviceRoundUp((double)(2 * ROOM * reach + 2 * cell));
    }
  }
}

/* Makes the cells so many times narrower than they were on the grid of a trial. */
static void Refine(const Task *task, const Choice *was, double factor, Choice *c)
{
  for (PetscInt k = 0; k < task->axes; k++) {
    const double n = factor * (double)was->n[k] * (double)(c->width[k] / was->width[k]);

    c->n[k] = (PetscInt)PetscMin(SamGridRoundUp(ceil(n)), (double)task->most);
  }
}

/* Multiplies the steps per row. */
static void Divide(const Task *task, double factor, Choice *c)
{
  if (task->steps && factor > 1)
    c->steps = (PetscInt)PetscMin(ceil((double)c->steps * factor * (1 - 1e-9)), MOST_STEPS);
}

/* True if the contact that was found needs another place or width of the grid. */
static PetscBool Moves(const Task *task, const Choice *was, const Choice *c)
{
  for (PetscInt k = 0; k < task->axes; k++)
    if (PetscAbsReal(c->width[k] / was->width[k] - 1) > SAME ||
        PetscAbsReal(c->center[k] - was->center[k]) > SAME * was->width[k])
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* True if finer cells have left the error as it is, once more: no grid makes it as small as asked. */
static PetscBool Stalls(Task *task, const Choice *was, double factor)
{
  const double cell = (double)was->width[0] / (double)was->n[0];

  if (cell < task->cell / 1.5 && factor > 0.8 * task->factor)
    task->stalls++;
  else if (cell < task->cell / 1.5)
    task->stalls = 0;
  task->cell   = cell;
  task->factor = factor;
  return task->stalls >= STALLS ? PETSC_TRUE : PETSC_FALSE;
}

/*
  Changes the choice by what a trial on it found; `last`: it is the one to run; `limit`: set to the reason if the errors
  cannot become smaller.
*/
static void Change(Task *task, const Trial *t, Choice *c, PetscBool *last, const char **limit)
{
  const Choice was = *c;
  PetscBool    cheap, near;
  double       factor[2];

  *last = PETSC_FALSE;
  if (t->status == SAM_STATUS_EDGE_CONTACT && !t->failed && task->size) {
    for (PetscInt k = 0; k < task->axes; k++) c->width[k] *= 1.6;
    return;
  }
  if (t->failed && task->number && was.n[0] < 8 * task->few) { /* as of cells that cannot follow the loads */
    Refine(task, &was, 2, c);
    return;
  }
  *last = t->failed || t->status != SAM_STATUS_CONVERGED || !t->touched ? PETSC_TRUE : PETSC_FALSE;
  if (*last) return; /* the run tells why */
  if (task->size) Fit(task, t, c);
  Demand(task, &was, t, factor);
  if (Stalls(task, &was, factor[0])) {
    *c     = was;
    *last  = PETSC_TRUE;
    *limit = "finer cells do not lower it";
    return;
  }
  cheap = (double)was.n[0] * (double)was.n[1] * (double)t->steps <= CHEAP ? PETSC_TRUE : PETSC_FALSE;
  near  = factor[0] <= NEAR && factor[1] <= NEAR ? PETSC_TRUE : PETSC_FALSE;
  if (cheap && factor[0] <= 1 && factor[1] <= 1 && !Moves(task, &was, c)) { /* it has been tried itself */
    *c    = was;
    *last = PETSC_TRUE;
    return;
  }
  *last = near && !cheap ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++)
    factor[k] = near ? factor[k] : PetscMin(factor[k] > NEAR ? factor[k] / NEAR : factor[k], AT_ONCE);
  factor[0] = PetscMax(factor[0], 1); /* numbers may wander from grid to grid: none is coarser than what was tried */
  if (task->number) Refine(task, &was, factor[0], c);
  Divide(task, factor[1], c);
  if (c->n[0] == was.n[0] && c->n[1] == was.n[1] && c->steps == was.steps && !Moves(task, &was, c)) {
    *last  = PETSC_TRUE;
    *limit = "-accuracy can choose no finer grid and no more steps";
  }
}

/* Describes what was chosen. */
static void Describe(const Task *task, const Choice *c, SamAccuracy *a)
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
static PetscErrorCode Tell(const Task *task, const Choice *c, const Trial *t, SamAccuracy *a)
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

static PetscErrorCode Choose(const SamOptions *from, const SamArguments *arguments, SamAccuracy *a)
{
  const double began = MPI_Wtime();
  Task         task  = {.asked = a};
  Choice       c;
  Trial       *trial;
  PetscBool    last = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(Prepare(from, arguments, &task, &c));
  PetscCall(PetscNew(&trial));
  if (!task.number && !task.size && !task.steps) last = PETSC_TRUE;
  while (!last && a->trials < TRIALS) {
    PetscCall(Try(from, arguments, &task, &c, trial));
    PetscCall(CheckNames(from, a, trial));
    a->trials++;
    PetscCall(Tell(&task, &c, trial, a));
    Change(&task, trial, &c, &last, &a->limit);
  }
  PetscCall(PetscFree(trial));
  PetscCall(SetOptions(from, &task, &c));
  Describe(&task, &c, a);
  a->seconds = MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAccuracyRefuse(const SamOptions *from)
{
  PetscBool has[2];

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(from, "accuracy", &has[0]));
  PetscCall(SamOptionsHas(from, "grid auto", &has[1]));
  PetscCheck(!has[0] && !has[1], from->comm, SAM_ERR_USER,
             "-%s%s: a grid is chosen for all loads of a run, and here steps are given one by one: give -grid_n and "
             "-grid_size",
             SamOptionsPrefix(from), has[0] ? "accuracy" : "grid auto");
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

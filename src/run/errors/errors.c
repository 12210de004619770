/*
  The errors of the numbers of a run, by companion runs: -errors companion.

  Up to three companions (companion.h) follow the simulation step by step: on half the cells, on a quarter of them,
  and, if the solution depends on the steps, with other steps: on a quarter of the cells, or, of small grids, on half
  of them. Half the cells in each direction take less than a quarter of the time. estimates.c turns the differences
  into errors; the sum of those by cells and by steps is stored with each step as NAME_error. At the end the same is
  done for the last numbers, and for sums over all steps.

  Between two moments that a companion with other steps shares with the run, the error by the steps is that of the
  earlier one, relative to the number. Numbers that are next to nothing for the contact, as the slip of a contact that
  sticks, have an error relative to a least value (SamErrorsLeast()).
*/
#include "errorsimpl.h"
#include <petsam/private/gap.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

#define LEAST  4  /* fewest cells per row whose half still makes a grid */
#define ENOUGH 16 /* fewest cells per row of a quarter on which errors by the steps are found */

PetscErrorCode SamErrorsReadOptions(SamSimulation s, const SamOptions *from)
{
  enum { NONE, CLOSED, COMPANION };
  static const SamOptionRow row    = {"errors", "errors of numbers: none, in closed form, or by companion runs, too",
                                      SAM_OPTION_ENUM, .words = "none,closed,companion"},
                            former = {"grid_check", "the same as -errors companion", SAM_OPTION_BOOL,
                                      .excludes = "errors"};
  PetscBool check                  = PETSC_FALSE;
  int       kind                   = CLOSED;

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &kind, NULL));
  PetscCall(SamOptionsRead(from, NULL, 1, &former, &check, NULL));
  s->needs.companion = check || kind == COMPANION ? PETSC_TRUE : PETSC_FALSE;
  s->untold          = kind == NONE ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(!s->needs.companion || s->setup.grid->fewest >= LEAST, from->comm, SAM_ERR_USER,
             "-errors companion needs at least %d cells in x and in y (-grid_n)", LEAST);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- creation ---- */

/* True if the solution depends on the steps, not on the last loads alone. */
static PetscBool DependsOnSteps(SamSimulation s)
{
  if (!SamMotionOf(s->setup.elasticity)->continues) return PETSC_FALSE;
  return s->needs.friction || SamProblemMoves(s->setup.problem) || SamProblemRemembers(s->setup.problem) ||
         SamErrorsYields(s);
}

/* A companion run: how often the cells are halved, 0: there is none; and its steps per row of the history. */
typedef struct {
  PetscInt halvings, increments;
} Planned;

/* Decides on the companion runs; without a history there is one step per row. */
static void Plan(SamSimulation s, Planned run[SAM_RUNS])
{
  const PetscInt  quarter    = (s->setup.grid->fewest + 3) / 4;
  const PetscInt  increments = s->history ? SamHistoryGetIncrements(s->history) : 1;
  const PetscBool steps      = DependsOnSteps(s);

  run[SAM_RUN_HALF]    = (Planned){s->setup.grid->fewest >= LEAST ? 1 : 0, increments};
  run[SAM_RUN_QUARTER] = (Planned){quarter >= LEAST ? 2 : 0, increments};
  run[SAM_RUN_OTHER]   = (Planned){!steps ? 0 : quarter >= ENOUGH ? 2 : 1, increments};
  if (!(s->step_rtol > 0)) run[SAM_RUN_OTHER].increments = increments > 1 ? (increments + 1) / 2 : 2;
}

/* Declares the error of a number, unless the state has a number of that name. */
static PetscErrorCode DeclareError(SamState state, SamErrorNumber *n)
{
  char           name[SAM_ERROR_NAME], text[96];
  SamStateNumber error = {.name = name, .text = text, .kind = SAM_NUMBER_REAL, .count = 1, .result = PETSC_TRUE};

  PetscFunctionBegin;
  (void)snprintf(name, sizeof(name), "%s_error", n->of->name);
  (void)snprintf(text, sizeof(text), "estimated error of %s by cells and steps", n->of->name);
  error.unit = n->of->unit;
  n->error   = -1;
  if (SamStateFindNumber(state, name) < 0) PetscCall(SamStateDeclareNumber(state, &error, &n->error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsFind(SamErrors e, SamState state)
{
  const PetscInt all = SamStateCountNumbers(state);

  PetscFunctionBegin;
  for (PetscInt k = 0, m = 0; k < all && m < e->count; k++) {
    PetscInt              id;
    const SamStateNumber *of = SamStateNumberOf(state, k, &id);

    if (id == e->number[m].id) e->number[m++].of = of;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeclareNumbers(SamErrors e, SamState state)
{
  const PetscInt all = SamStateCountNumbers(state);

  PetscFunctionBegin;
  e->count = 0;
  for (PetscInt k = 0; k < all && e->count < SAM_ERROR_ROWS; k++) {
    SamErrorNumber *n = &e->number[e->count];

    n->of = SamStateNumberOf(state, k, &n->id);
    if (n->of->order && n->of->result) e->count++;
  }
  for (PetscInt k = 0; k < e->count; k++) PetscCall(DeclareError(state, &e->number[k]));
  PetscCall(SamErrorsFind(e, state));
  for (PetscInt k = 0; k < e->count; k++)
    for (int c = 0; c < SAM_RUNS; c++)
      e->number[k].at[c] = e->companion[c].run ? SamStateFindNumber(e->companion[c].state, e->number[k].of->name) : -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Describe(SamErrors e, PetscInt increments)
{
  char *const  text = e->table.runs;
  const size_t size = sizeof(e->table.runs);

  for (int k = 0; k < SAM_RUNS; k++) {
    const SamSimulation run  = e->companion[k].run;
    const size_t        used = strlen(text);

    if (!run) continue;
    (void)snprintf(text + used, size - used, "%s%ld", used ? ", on " : "on ", (long)run->setup.grid->nx);
    if (!SamGridIsRow(run->setup.grid))
      (void)snprintf(text + strlen(text), size - strlen(text), " x %ld", (long)run->setup.grid->ny);
    (void)snprintf(text + strlen(text), size - strlen(text), " cells");
    if (k == SAM_RUN_OTHER)
      (void)snprintf(text + strlen(text), size - strlen(text), " with %ld step%s per row", (long)increments,
                     increments == 1 ? "" : "s");
  }
}

PetscErrorCode SamErrorsCreate(SamSimulation s)
{
  Planned   run[SAM_RUNS];
  SamErrors e;
  SamState  state;

  PetscFunctionBegin;
  if (!s->needs.companion || s->errors) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&e));
  s->errors = e;
  Plan(s, run);
  for (int c = 0; c < SAM_RUNS; c++)
    if (run[c].halvings) PetscCall(SamCompanionCreate(s, run[c].halvings, &e->companion[c]));
  e->same = run[SAM_RUN_OTHER].halvings == 1 ? SAM_RUN_HALF : SAM_RUN_QUARTER;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(DeclareNumbers(e, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsPrepare(SamSimulation s)
{
  const SamErrors e = s->errors;
  Planned         run[SAM_RUNS];

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  Plan(s, run);
  for (int c = 0; c < SAM_RUNS; c++)
    if (e->companion[c].run) PetscCall(SamCompanionPrepare(&e->companion[c], s, run[c].increments));
  if (e->companion[SAM_RUN_OTHER].run) e->companion[SAM_RUN_OTHER].run->step_rtol *= 2;
  for (PetscInt k = 0; k < e->count; k++) {
    SamErrorNumber *n = &e->number[k];

    n->apart = n->steps = 0;
    for (int c = 0; c < SAM_RUNS; c++) n->mark[c] = n->base[c] = 0;
  }
  PetscCall(PetscArrayzero(e->sums, SAM_STATE_NUMBERS));
  e->began = e->restored = e->resolved = PETSC_FALSE;
  e->few                               = 0;
  e->table                             = (SamErrorTable){.count = 0};
  Describe(e, run[SAM_RUN_OTHER].increments);
  PetscFunctionReturn(PETSC_SUCCESS);
}

double SamErrorsShare(SamSimulation s)
{
  const double half = SamGridIsRow(s->setup.grid) ? 0.5 : 0.25, own = (double)SamHistoryGetIncrements(s->history);
  double       share = 0;
  Planned      run[SAM_RUNS];

  Plan(s, run);
  if (s->untold || !run[SAM_RUN_HALF].halvings) return 0;
  for (int c = 0; c < SAM_RUNS; c++) {
    const double steps = c == SAM_RUN_OTHER && own > 1 && !(s->step_rtol > 0) ? 0.5 : (double)run[c].increments / own;

    if (run[c].halvings) share += steps * pow(half, (double)run[c].halvings);
  }
  return share;
}

const char *SamErrorsDescribe(SamErrors e)
{
  return e ? e->table.runs : NULL;
}

PetscErrorCode SamErrorsDestroy(SamErrors *errors)
{
  PetscFunctionBegin;
  if (!*errors) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < SAM_RUNS; k++) PetscCall(SamCompanionDestroy(&(*errors)->companion[k]));
  PetscCall(PetscFree(*errors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamErrorsCompareSteps(SamSimulation s, SamErrorNumber *n)
{
  SamErrors       e   = s->errors;
  const PetscBool sum = n->of->join == SAM_JOIN_SUM ? PETSC_TRUE : PETSC_FALSE;
  double          run[SAM_RUNS];

  SamErrorsGetRuns(e, n, sum, run);
  for (int k = 0; k < SAM_RUNS && sum; k++) {
    const double now = run[k];

    run[k] -= n->mark[k];
    n->mark[k] = now;
  }
  n->apart += run[e->same] - run[SAM_RUN_OTHER];
  n->steps = SamErrorsRelativeBySteps(s, n, run);
}

/* ---- steps ---- */

/* Lets the companions solve their steps up to the end of step k. */
static PetscErrorCode Follow(SamSimulation s, PetscInt k)
{
  const SamControl control         = SamHistoryGetStep(s->history, k);
  SamErrors        e               = s->errors;
  PetscBool        there[SAM_RUNS] = {PETSC_FALSE};

  PetscFunctionBegin;
  for (int c = 0; c < SAM_RUNS; c++)
    if (e->companion[c].run) PetscCall(SamCompanionFollow(&e->companion[c], s, k, &there[c]));
  SamErrorsBegin(&e->largest, &control);
  SamErrorsRaise(&e->largest, e->companion[SAM_RUN_HALF].state);
  for (PetscInt n = 0; n < e->count && there[SAM_RUN_OTHER]; n++) SamErrorsCompareSteps(s, &e->number[n]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the companions solve the steps before the first one of this run, after a restart that has not restored them. */
static PetscErrorCode CatchUp(SamSimulation s, PetscInt k)
{
  SamErrors      e    = s->errors;
  const PetscInt from = e->restored ? k : 0;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < e->count && !e->restored; n++)
    e->number[n].steps = e->companion[SAM_RUN_OTHER].run ? NAN : 0;
  for (PetscInt j = from; j < k; j++) PetscCall(Follow(s, j));
  for (PetscInt n = 0; n < e->count; n++) {
    SamErrorsGetRuns(e, &e->number[n], PETSC_TRUE, e->number[n].base);
    e->number[n].apart = 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsSet(SamSimulation s, const SamControl *control)
{
  const SamErrors e = s->errors;
  SamState        state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state)); /* makes all parts declare their numbers again */
  PetscCall(SamErrorsFind(e, state));
  SamStateJoinNumbers(state, e->sums, PETSC_FALSE);
  PetscCall(SamAdviceFindFew(&s->setup, control, &e->few, &e->more));
  if (!(e->few > 0) && SamErrorsGet(state, "contact_area") > 0) e->resolved = PETSC_TRUE;
  for (PetscInt i = 0; i < e->count; i++) {
    SamErrorNumber *n   = &e->number[i];
    const double    own = *SamStateReadNumbers(state, n->id), least = SamErrorsLeast(s, n->of);
    double          run[SAM_RUNS], error;

    if (n->error < 0) continue;
    SamErrorsGetRuns(e, n, PETSC_FALSE, run);
    error = e->few > 0 ? NAN : SamErrorsByCells(s, n->of, own, run) + n->steps * PetscMax(fabs(own), least);
    if (SamErrorsPrescribes(control, n->of->name)) error = 0;
    *SamStateNumbers(state, n->error, SAM_TRIED) = isinf(error) ? NAN : error;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsRecord(SamSimulation s, PetscInt k, const SamStep *step)
{
  const SamErrors e     = s->errors;
  const double    began = MPI_Wtime();

  PetscFunctionBegin;
  if (!e || !SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!e->began) PetscCall(CatchUp(s, k));
  e->began = PETSC_TRUE;
  PetscCall(Follow(s, k));
  PetscCall(SamErrorsSet(s, &step->control));
  e->table.seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the end ---- */

/* Returns a number of the last computed cycle of a companion's life, NaN without one. */
static double CycleOf(const SamCompanion *c, const char name[])
{
  if (!c->run || !c->life || c->fault[0]) return NAN;
  return SamErrorsGet(SamLifeGetSeries(c->life), name);
}

/* Runs the companions' lives, and adds the numbers of the last cycle. */
static PetscErrorCode AddCycle(SamSimulation s)
{
  const SamErrors e      = s->errors;
  const SamState  series = SamLifeGetSeries(s->life);
  const double    began  = MPI_Wtime();

  PetscFunctionBegin;
  for (int c = 0; c < SAM_RUNS; c++)
    if (e->companion[c].run) PetscCall(SamCompanionLive(&e->companion[c], SamLifeGetState(s->life).cycles));
  for (PetscInt k = 0; k < SamStateCountNumbers(series); k++) {
    PetscInt              id;
    const SamStateNumber *n = SamStateNumberOf(series, k, &id);
    double                run[SAM_RUNS];

    if (!n->order) continue;
    for (int c = 0; c < SAM_RUNS; c++) run[c] = CycleOf(&e->companion[c], n->name);
    SamErrorsAddRow(s, n, SamUnitOn(s->setup.grid, n->unit), *SamStateReadNumbers(series, id), 0, run);
  }
  e->table.seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsAdd(SamSimulation s, const SamControl *last)
{
  PetscFunctionBegin;
  if (!s->errors) PetscFunctionReturn(PETSC_SUCCESS);
  s->errors->closed = &s->advice.doubts;
  if (s->life) PetscCall(AddCycle(s));
  PetscCall(SamErrorsAddNumbers(s, last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsEnd(SamSimulation s)
{
  PetscFunctionBegin;
  if (!s->errors) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->output && s->errors->table.count) PetscCall(SamOutputWriteErrors(s->output, &s->errors->table));
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_ERRORS, .errors = &s->errors->table}));
  PetscCall(SamErrorsAddDoubts(s->errors, &s->advice));
  SamErrorsKeep(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

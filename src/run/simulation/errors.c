/*
  The errors of the numbers of a run, by companion runs: -errors companion.

  Up to three companions (companion.h) follow the simulation step by step: on half the cells, on a quarter of them,
  and, if the solution depends on the steps, with other steps: on a quarter of the cells, or, of small grids, on half
  of them. Half the cells in each direction take less than a quarter of the time. estimates.c turns the differences
  into errors; the sum of those by cells and by steps is stored with each step as NAME_error. At the end the same is
  done for the last numbers, and for sums over all steps.

  Between two moments that a companion with other steps shares with the run, the error by the steps is that of the
  earlier one, relative to the number. Numbers that are next to nothing for the contact, as the slip of a contact that
  sticks, have an error relative to a least value (Least()).
*/
#include "companion.h"
#include <petsam/private/control.h>
#include <petsam/private/errors.h>
#include <petsam/private/gap.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>
#include <math.h>

#define LEAST  4    /* fewest cells per row whose half still makes a grid */
#define ENOUGH 16   /* fewest cells per row of a quarter on which errors by the steps are found */
#define LARGE  0.12 /* error above which a warning is given: the median is two to three times the true one; */
#define APART  0.1  /* for errors by the cells the difference to half the cells must be above this, too */
#define AIM    0.04 /* error that the proposed cells or steps have */

/* A number of the state with its errors */
typedef struct {
  const SamStateNumber *of;
  PetscInt              id, error;      /* places in the state of the number and of its error; -1: that is not stored */
  PetscInt              at[SAM_RUNS];   /* its places in the companions' states; -1: none */
  double                mark[SAM_RUNS]; /* sums of the runs at the last common moment */
  double                base[SAM_RUNS]; /* the same before the first step of this run */
  double                apart; /* sum with the same steps minus that with other steps, of the steps of this run */
  double                steps; /* error by the steps at the last common moment, relative; NaN: unknown */
} Number;

/* Largest values of all steps, which tell what is next to nothing */
typedef struct {
  double load, approach, area, pressure;
} Largest;

struct _n_SamErrors {
  SamCompanion  companion[SAM_RUNS];
  SamRunKind    same; /* the companion on the same cells as that with other steps */
  PetscInt      count;
  Number        number[SAM_ERROR_ROWS];
  double        sums[SAM_STATE_NUMBERS]; /* numbers of the steps of this run, joined */
  Largest       largest;                 /* on half the cells */
  PetscBool     began;                   /* the first step has been recorded */
  SamErrorTable table;
};

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
  return s->needs.friction || SamProblemMoves(s->setup.problem) || SamProblemGetLaw(s->setup.problem, SAM_LAW_PLASTIC);
}

/* Declares the error of a number, unless the state has a number of that name. */
static PetscErrorCode DeclareError(SamState state, Number *n)
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

static PetscErrorCode DeclareNumbers(SamErrors e, SamState state)
{
  const PetscInt all = SamStateCountNumbers(state);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < all && e->count < SAM_ERROR_ROWS; k++) {
    Number *n = &e->number[e->count];

    n->of = SamStateNumberOf(state, k, &n->id);
    if (n->of->order && n->of->result) e->count++;
  }
  /* The list of the state may move when it grows. */
  for (PetscInt k = 0; k < e->count; k++) PetscCall(DeclareError(state, &e->number[k]));
  for (PetscInt k = 0, m = 0; k < all && m < e->count; k++) {
    PetscInt              id;
    const SamStateNumber *of = SamStateNumberOf(state, k, &id);

    if (id == e->number[m].id) e->number[m++].of = of;
  }
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
  const PetscInt increments = SamHistoryGetIncrements(s->history), other = s->step_rtol > 0 ? increments
                                                                           : increments > 1 ? (increments + 1) / 2
                                                                                            : 2;
  const PetscInt quarter = (s->setup.grid->fewest + 3) / 4;
  SamErrors      e;
  SamState       state;

  PetscFunctionBegin;
  if (!s->needs.companion) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamErrorsDestroy(&s->errors));
  PetscCall(PetscNew(&e));
  s->errors = e;
  PetscCall(SamCompanionCreate(s, 1, increments, &e->companion[SAM_RUN_HALF]));
  if (quarter >= LEAST) PetscCall(SamCompanionCreate(s, 2, increments, &e->companion[SAM_RUN_QUARTER]));
  if (DependsOnSteps(s)) {
    e->same = quarter >= ENOUGH ? SAM_RUN_QUARTER : SAM_RUN_HALF;
    PetscCall(SamCompanionCreate(s, e->same == SAM_RUN_HALF ? 1 : 2, other, &e->companion[SAM_RUN_OTHER]));
    e->companion[SAM_RUN_OTHER].run->step_rtol *= 2;
  }
  Describe(e, other);
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(DeclareNumbers(e, state));
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* ---- values ---- */

/* Gets a number of the last step of the simulation's state, NaN if there is none. */
static double Get(SamState state, const char name[])
{
  const PetscInt id = SamStateFindNumber(state, name);

  return id < 0 ? NAN : *SamStateReadNumbers(state, id);
}

/* Raises a largest value to that of a step. */
static void Raise(double *largest, double value)
{
  if (fabs(value) > *largest) *largest = fabs(value);
}

static void RaiseAll(Largest *l, SamState state)
{
  Raise(&l->load, Get(state, "load_n"));
  Raise(&l->approach, Get(state, "disp_z"));
  Raise(&l->area, Get(state, "contact_area"));
  Raise(&l->pressure, Get(state, "pressure_max"));
}

/* Returns the component whose displacement, rotation or creepage has this name; -1: none. */
static PetscInt RigidOf(const char name[])
{
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    for (SamWay way = SAM_BY_RIGID; way < SAM_WAYS; way++)
      if (SamComponentNameOf(c, way) && !strcmp(SamComponentNameOf(c, way), name)) return c;
  return -1;
}

/*
  Returns the value below which a number is next to nothing for this contact. A displacement or rotation whose load is
  0 in all steps is compared with the approach, since it may be 0 by symmetry.
*/
static double Least(SamSimulation s, const SamStateNumber *number)
{
  const Largest *const l      = &s->errors->largest;
  const double         length = sqrt(l->area);
  const char *const    unit   = number->unit;
  const PetscInt       rigid  = RigidOf(number->name);

  if (rigid >= 0 && (!strcmp(unit, "m") || !strcmp(unit, "rad")))
    return (s->start.loads[rigid] ? 1e-3 : 1) * l->approach / (strcmp(unit, "rad") ? 1 : PetscMax(length, 1e-300));
  if (!strcmp(unit, "J")) return 1e-6 * l->load * l->approach;
  if (!strcmp(unit, "J/m")) return 1e-6 * l->load; /* per rolled distance */
  if (!strcmp(unit, "m2")) return 1e-3 * l->area;
  if (!strcmp(unit, "Pa")) return 1e-4 * l->pressure;
  if (!strcmp(unit, "m")) return 1e-5 * l->approach;
  if (!strcmp(unit, "N")) return 1e-3 * l->load;
  if (!strcmp(unit, "N m")) return 1e-3 * l->load * length;
  if (!strcmp(unit, "1/m")) return length > 0 ? 1e-6 / length : 0;
  return !strcmp(unit, "1") ? 1e-6 : 0;
}

/* True if the step prescribes this number. */
static PetscBool IsPrescribed(const SamControl *control, const char name[])
{
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    if (!strcmp(SamComponentNameOf(c, SamControlWay(control, c)), name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Returns a number of a companion: of its last step, or its sum over all steps; NaN: it has none. */
static double ValueOf(SamErrors e, int k, const Number *n, PetscBool sum)
{
  const SamCompanion *c  = &e->companion[k];
  const PetscInt      id = n->at[k];

  if (id < 0 || c->fault[0]) return NAN;
  return sum ? c->sums[id] : *SamStateReadNumbers(c->state, id);
}

static void GetRuns(SamErrors e, const Number *n, PetscBool sum, double run[SAM_RUNS])
{
  for (int k = 0; k < SAM_RUNS; k++) run[k] = ValueOf(e, k, n, sum);
}

/* Updates the error of a number by the steps at a moment that OTHER shares with the run. */
static void CompareSteps(SamSimulation s, Number *n)
{
  SamErrors       e   = s->errors;
  const PetscBool sum = n->of->join == SAM_JOIN_SUM ? PETSC_TRUE : PETSC_FALSE;
  double          run[SAM_RUNS];

  GetRuns(e, n, sum, run);
  for (int k = 0; k < SAM_RUNS && sum; k++) {
    const double now = run[k];

    run[k] -= n->mark[k];
    n->mark[k] = now;
  }
  n->apart += run[e->same] - run[SAM_RUN_OTHER];
  n->steps = SamErrorBySteps(run, e->same) / PetscMax(fabs(run[e->same]), Least(s, n->of));
}

/* ---- steps ---- */

/* Lets the companions solve their steps up to the end of step k. */
static PetscErrorCode Follow(SamSimulation s, PetscInt k)
{
  SamErrors e               = s->errors;
  PetscBool there[SAM_RUNS] = {PETSC_FALSE};

  PetscFunctionBegin;
  for (int c = 0; c < SAM_RUNS; c++)
    if (e->companion[c].run) PetscCall(SamCompanionFollow(&e->companion[c], s, k, &there[c]));
  RaiseAll(&e->largest, e->companion[SAM_RUN_HALF].state);
  for (PetscInt n = 0; n < e->count && there[SAM_RUN_OTHER]; n++) CompareSteps(s, &e->number[n]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the companions solve the steps before the first one of this run, after a restart. */
static PetscErrorCode CatchUp(SamSimulation s, PetscInt k)
{
  SamErrors e = s->errors;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < e->count; n++) e->number[n].steps = e->companion[SAM_RUN_OTHER].run ? NAN : 0;
  for (PetscInt j = 0; j < k; j++) PetscCall(Follow(s, j));
  for (PetscInt n = 0; n < e->count; n++) {
    GetRuns(e, &e->number[n], PETSC_TRUE, e->number[n].base);
    e->number[n].apart = 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsRecord(SamSimulation s, PetscInt k, const SamStep *step)
{
  const SamErrors e     = s->errors;
  const double    began = MPI_Wtime();
  SamState        state;

  PetscFunctionBegin;
  if (!e || !SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!e->began) PetscCall(CatchUp(s, k));
  e->began = PETSC_TRUE;
  PetscCall(Follow(s, k));
  PetscCall(SamContactGetState(s->setup.contact, &state)); /* makes all parts declare their numbers again */
  SamStateJoinNumbers(state, e->sums, PETSC_FALSE);
  for (PetscInt i = 0; i < e->count; i++) {
    Number      *n   = &e->number[i];
    const double own = *SamStateReadNumbers(state, n->id), least = Least(s, n->of);
    double       run[SAM_RUNS];

    if (n->error < 0) continue;
    GetRuns(e, n, PETSC_FALSE, run);
    *SamStateNumbers(state, n->error, SAM_TRIED) =
      IsPrescribed(&step->control, n->of->name) ? 0 : SamErrorByCells(own, run) + n->steps * PetscMax(fabs(own), least);
  }
  e->table.seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the end ---- */

/* Returns the factor of narrower cells, or more steps, that makes the error of a row by this cause as small as
   wanted. */
static double FactorOf(const SamErrorRow *row, SamCause cause)
{
  const double ratio = row->of[cause] / AIM;

  if (!(ratio > 1)) return 1;
  return cause == SAM_CAUSE_CELLS && row->order == 2 ? sqrt(ratio) : ratio;
}

/* Returns the largest absolute value of a number in this run and its companions. */
static double Magnitude(double value, const double run[SAM_RUNS])
{
  double most = fabs(value);

  for (int k = 0; k < SAM_RUNS; k++) Raise(&most, run[k]);
  return most;
}

/* Adds a row; `least`: value below which the number is next to nothing, unless a closed form says that it is wrong. */
static void Add(SamSimulation s, const SamStateNumber *number, const char unit[], double value, double least,
                const double run[SAM_RUNS])
{
  const SamErrors  e     = s->errors;
  const SamDoubts *d     = &s->advice.doubts;
  const double     scale = PetscMax(fabs(value), least);
  PetscBool        known[SAM_CAUSES];
  double           closed[SAM_CAUSES], most = 0;
  SamErrorTable   *t   = &e->table;
  SamErrorRow     *row = &t->row[t->count];

  for (SamCause c = 0; c < SAM_CAUSES; c++) {
    closed[c] = SamDoubtsOf(d, number->name, c, &known[c]);
    most      = PetscMax(most, closed[c]);
  }
  for (PetscInt k = 0; k < t->count; k++)
    if (!strcmp(t->row[k].name, number->name)) return; /* the number of a cycle precedes that of its last step */
  if (t->count == SAM_ERROR_ROWS || !(Magnitude(value, run) > least || (least > 0 && most > 0))) return;
  *row                     = (SamErrorRow){.unit = unit, .value = value, .scale = scale};
  row->of[SAM_CAUSE_CELLS] = SamErrorByCells(value, run) / scale;
  row->of[SAM_CAUSE_STEPS] = e->companion[SAM_RUN_OTHER].run ? SamErrorBySteps(run, e->same) / scale : 0;
  for (int c = 0; c < SAM_CAUSES; c++) row->of[c] = known[c] ? closed[c] : PetscMax(row->of[c], closed[c]);
  (void)snprintf(row->name, sizeof(row->name), "%s", number->name);
  for (SamCause c = 0; c < SAM_CAUSES; c++) {
    row->error += row->of[c];
    if (row->of[c] > row->of[row->cause]) row->cause = c;
  }
  row->order = number->order;
  for (int k = 0; k < SAM_RUNS; k++) row->run[k] = run[k];
  row->factor = FactorOf(row, row->cause);
  t->count++;
}

/* Adds the numbers of the last step, and the sums over all steps. */
static PetscErrorCode AddNumbers(SamSimulation s, const SamControl *control)
{
  SamErrors e = s->errors;
  SamState  state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  RaiseAll(&e->largest, state);
  for (PetscInt i = 0; i < e->count; i++) {
    const Number   *n   = &e->number[i];
    const PetscBool sum = n->of->join == SAM_JOIN_SUM ? PETSC_TRUE : PETSC_FALSE;
    const double    own = sum ? e->sums[n->id] : *SamStateReadNumbers(state, n->id), least = Least(s, n->of);
    double          run[SAM_RUNS];

    if ((sum && s->life) || IsPrescribed(control, n->of->name)) continue;
    GetRuns(e, n, sum, run);
    for (int c = 0; c < SAM_RUNS && sum; c++) run[c] -= n->base[c];
    if (sum && e->companion[SAM_RUN_OTHER].run) run[SAM_RUN_OTHER] = run[e->same] - n->apart;
    Add(s, n->of, SamUnitOn(s->setup.grid, n->of->unit), own, least, run);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns a number of the last computed cycle of a companion's life, NaN without one. */
static double CycleOf(const SamCompanion *c, const char name[])
{
  if (!c->run || !c->life || c->fault[0]) return NAN;
  return Get(SamLifeGetSeries(c->life), name);
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
    Add(s, n, SamUnitOn(s->setup.grid, n->unit), *SamStateReadNumbers(series, id), 0, run);
  }
  e->table.seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- warnings ---- */

/*
  True if a warning is due. The error by the cells must also be large by the difference to half the cells, since on a
  quarter of them contacts are often not resolved at all.
*/
static PetscBool IsLarge(const SamErrorRow *row, SamCause cause)
{
  if (!(row->of[cause] > LARGE)) return PETSC_FALSE;
  return cause != SAM_CAUSE_CELLS || fabs(row->value - row->run[SAM_RUN_HALF]) > APART * row->scale;
}

/* True if companion runs to the end tell the errors by a cause. */
static PetscBool Knows(SamErrors e, SamCause cause)
{
  const SamCompanion *half = &e->companion[SAM_RUN_HALF], *other = &e->companion[SAM_RUN_OTHER];

  if (half->fault[0] || cause == SAM_CAUSE_LAYERS) return PETSC_FALSE;
  return cause == SAM_CAUSE_CELLS || (other->run && !other->fault[0]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds the large errors to those in closed form, which are told together. */
static void AddDoubts(SamSimulation s)
{
  const SamErrorTable *t = &s->errors->table;

  for (PetscInt k = 0; k < t->count; k++)
    for (SamCause cause = 0; cause < SAM_CAUSES; cause++)
      if (IsLarge(&t->row[k], cause))
        SamDoubtsAdd(&s->advice.doubts, cause, t->row[k].of[cause], FactorOf(&t->row[k], cause), t->row[k].name, "%s",
                     "");
}

/* Tells which companions ended early, and why. */
static PetscErrorCode WarnOfFaults(SamSimulation s)
{
  static const char *const what[SAM_RUNS] = {"half the cells", "", "fewer cells with other steps"};
  char                     text[SAM_MESSAGE + 64];

  PetscFunctionBegin;
  for (int c = 0; c < SAM_RUNS; c++) {
    const SamCompanion *one = &s->errors->companion[c];

    if (!one->run || !one->fault[0] || c == SAM_RUN_QUARTER) continue; /* of that half the cells tell enough */
    (void)snprintf(text, sizeof(text), "errors by the %s are unknown: on %s %s",
                   SamCauseNames[c == SAM_RUN_OTHER ? SAM_CAUSE_STEPS : SAM_CAUSE_CELLS], what[c], one->fault);
    PetscCall(SamSimulationWarn(s, text, ""));
    if (c == SAM_RUN_HALF) break; /* nothing is known without it */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsEnd(SamSimulation s, const SamControl *last)
{
  PetscFunctionBegin;
  if (!s->errors) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->life) PetscCall(AddCycle(s));
  PetscCall(AddNumbers(s, last));
  if (s->output && s->errors->table.count) PetscCall(SamOutputWriteErrors(s->output, &s->errors->table));
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_ERRORS, .errors = &s->errors->table}));
  PetscCall(WarnOfFaults(s));
  for (SamCause cause = 0; cause < SAM_CAUSES; cause++) s->advice.knows[cause] = Knows(s->errors, cause);
  AddDoubts(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

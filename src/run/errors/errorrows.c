/*
  The rows of the table of errors: what a number is in the companion runs, what it is compared with, how much of its
  error is due to cells, steps or layers, and which errors are told.
*/
#include "errorsimpl.h"
#include <petsam/private/control.h>
#include <petsam/private/examination.h>
#include <petsam/private/grid.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

#define LARGE 0.12 /* error above which a warning is given: the median is two to three times the true one; */
#define APART 0.1  /* for errors by the cells the difference to half the cells must be above this, too */
#define AIM   0.04 /* error that the proposed cells or steps have */

/* ---- values ---- */

/* Gets a number of the last step of the simulation's state, NaN if there is none. */
double SamErrorsGet(SamState state, const char name[])
{
  const PetscInt id = SamStateFindNumber(state, name);

  return id < 0 ? NAN : *SamStateReadNumbers(state, id);
}

/* Raises a largest value to that of a step. */
static void Raise(double *largest, double value)
{
  if (fabs(value) > *largest) *largest = fabs(value);
}

#define BORNE 1e-3 /* of the maximum pressure on all of the contact: a load, where surfaces that attract bear none */

void SamErrorsBegin(SamErrorLargest *l, const SamControl *control)
{
  if (l->area == 0) l->twist = control->force[SAM_COMPONENT_MZ] ? (double)control->value[SAM_COMPONENT_MZ] : 0;
}

void SamErrorsRaise(SamErrorLargest *l, SamState state)
{
  Raise(&l->load, SamErrorsGet(state, "load_n"));
  Raise(&l->approach, SamErrorsGet(state, "disp_z"));
  Raise(&l->area, SamErrorsGet(state, "contact_area"));
  Raise(&l->pressure, SamErrorsGet(state, "pressure_max"));
  Raise(&l->load, BORNE * SamErrorsGet(state, "pressure_max") * SamErrorsGet(state, "contact_area"));
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
double SamErrorsLeast(SamSimulation s, const SamStateNumber *number)
{
  const SamErrorLargest *const l      = &s->errors->largest;
  const double                 length = sqrt(l->area);
  const char *const            unit   = number->unit;
  const PetscInt               rigid  = RigidOf(number->name);

  if (rigid >= 0 && (!strcmp(unit, "m") || !strcmp(unit, "rad")))
    return (s->start.loads[rigid] ? 1e-3 : 1) * l->approach / (strcmp(unit, "rad") ? 1 : PetscMax(length, 1e-300));
  if (!strcmp(unit, "J")) return SAM_ENERGY_NONE * l->load * l->approach;
  if (!strcmp(unit, "J/m")) return SAM_ENERGY_NONE * l->load; /* per rolled distance */
  if (!strcmp(unit, "m2")) return 1e-3 * l->area;
  if (!strcmp(unit, "Pa")) return 1e-4 * l->pressure;
  if (!strcmp(unit, "m")) return 1e-5 * l->approach;
  if (!strcmp(unit, "N")) return 1e-3 * l->load;
  if (!strcmp(unit, "N m")) return 1e-3 * l->load * length;
  if (!strcmp(unit, "1/m")) return length > 0 ? 1e-6 / length : 0;
  return !strcmp(unit, "1") ? 1e-6 : 0;
}

PetscBool SamErrorsYields(SamSimulation s)
{
  return SamProblemYields(s->setup.problem);
}

double SamErrorsByCells(SamSimulation s, const SamStateNumber *number, double value, const double run[SAM_RUNS])
{
  const PetscBool energy = number->order == 2 && !strcmp(number->unit, "J") ? PETSC_TRUE : PETSC_FALSE;

  return PetscMax(SamErrorByCells(energy && !SamErrorsYields(s), value, run),
                  SamErrorOfSeries(APART * PetscMax(fabs(value), SamErrorsLeast(s, number)), value, run));
}

/*
  True if the error of a number by the steps has no limit. The rotation by M_z in contact of radius a grows by dM_z/a^3;
  where M_z grows with N from no contact, whose a^3 is proportional to N for round bodies, it adds the same in each
  halving of the step in which contact begins, and so do displacements by it. Where the contact does not grow from a
  point, as that of a flat punch, the error is small.
*/
static PetscBool GrowsBySteps(SamErrors e, const char unit[], double relative)
{
  if (e->largest.twist == 0 || !(relative > SAM_DOUBT_LARGE)) return PETSC_FALSE;
  return !strcmp(unit, "rad") || !strcmp(unit, "m") ? PETSC_TRUE : PETSC_FALSE;
}

double SamErrorsRelativeBySteps(SamSimulation s, const SamErrorNumber *n, const double run[SAM_RUNS])
{
  const double error = SamErrorBySteps(run, s->errors->same);

  const double relative = error == 0 ? 0 : error / PetscMax(fabs(run[s->errors->same]), SamErrorsLeast(s, n->of));

  return GrowsBySteps(s->errors, n->of->unit, relative) ? NAN : relative;
}

PetscBool SamErrorsPrescribes(const SamControl *control, const char name[])
{
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    if (!strcmp(SamComponentNameOf(c, SamControlWay(control, c)), name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Returns a number of a companion: of its last step, or its sum over all steps; NaN: it has none. */
static double ValueOf(SamErrors e, int k, const SamErrorNumber *n, PetscBool sum)
{
  const SamCompanion *c  = &e->companion[k];
  const PetscInt      id = n->at[k];

  if (id < 0 || c->fault[0]) return NAN;
  return sum ? c->sums[id] : *SamStateReadNumbers(c->state, id);
}

void SamErrorsGetRuns(SamErrors e, const SamErrorNumber *n, PetscBool sum, double run[SAM_RUNS])
{
  for (int k = 0; k < SAM_RUNS; k++) run[k] = ValueOf(e, k, n, sum);
}

/* ---- the end ---- */

/* Returns the factor of narrower cells, or more steps, that makes the error of a row by this cause as small as
   wanted. */
static double FactorOf(const SamErrorRow *row, SamCause cause)
{
  const double ratio = row->of[cause] / AIM;

  if (row->grows[cause]) return cause == SAM_CAUSE_STEPS ? SAM_DOUBT_WORSE : 0;
  if (cause == SAM_CAUSE_CELLS && row->more > 0) return row->more;

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

/* Makes errors 1, unknown, where the number has no limit, or the contact of the last step is too few cells. */
static void FindLimits(SamErrors e, const SamStateNumber *number, SamErrorRow *row)
{
  const PetscBool few = e->few > 0 && !(number->join == SAM_JOIN_SUM && e->resolved) ? PETSC_TRUE : PETSC_FALSE;

  row->grows[SAM_CAUSE_CELLS] = isinf(row->cells) && !few ? PETSC_TRUE : PETSC_FALSE;
  row->grows[SAM_CAUSE_STEPS] = GrowsBySteps(e, number->unit, row->of[SAM_CAUSE_STEPS]);
  row->more                   = few ? e->more : 0;
  if (few) row->of[SAM_CAUSE_CELLS] = PetscMax(1, row->of[SAM_CAUSE_CELLS]);
  if (isinf(row->of[SAM_CAUSE_CELLS])) row->of[SAM_CAUSE_CELLS] = 1;
  if (row->grows[SAM_CAUSE_STEPS]) row->of[SAM_CAUSE_STEPS] = PetscMax(1, row->of[SAM_CAUSE_STEPS]);
}

/* Adds a row to the table, with so large an error by the cells, in the unit; `of`: the number whose errors in closed
   form count. */
static void Add(SamSimulation s, const SamStateNumber *number, const char of[], const char unit[], double value,
                double least, const double run[SAM_RUNS], double cells)
{
  const SamErrors  e     = s->errors;
  const SamDoubts *d     = e->closed;
  const double     scale = PetscMax(fabs(value), least);
  PetscBool        known[SAM_CAUSES];
  double           closed[SAM_CAUSES], most = 0;
  SamErrorTable   *t   = &e->table;
  SamErrorRow     *row = &t->row[t->count];

  for (SamCause c = 0; c < SAM_CAUSES; c++) {
    closed[c] = SamDoubtsOf(d, of, c, &known[c]);
    known[c]  = known[c] && of == number->name ? PETSC_TRUE : PETSC_FALSE;
    most      = PetscMax(most, closed[c]);
  }
  for (PetscInt k = 0; k < t->count; k++)
    if (!strcmp(t->row[k].name, number->name)) return; /* the number of a cycle precedes that of its last step */
  if (t->count == SAM_ERROR_TABLE || !(Magnitude(value, run) > least || (least > 0 && most > 0))) return;
  *row                     = (SamErrorRow){.unit = unit, .value = value, .scale = scale};
  row->cells               = cells / scale;
  row->of[SAM_CAUSE_CELLS] = row->cells;
  row->of[SAM_CAUSE_STEPS] = e->companion[SAM_RUN_OTHER].run ? SamErrorBySteps(run, e->same) / scale : 0;
  FindLimits(e, number, row);
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

void SamErrorsAddRow(SamSimulation s, const SamStateNumber *number, const char unit[], double value, double least,
                     const double run[SAM_RUNS])
{
  Add(s, number, number->name, unit, value, least, run, SamErrorsByCells(s, number, value, run));
}

void SamErrorsAddDerivative(SamSimulation s, const SamStateNumber *number, const char of[], double value, double least,
                            const double run[SAM_RUNS], double *error)
{
  const SamErrorTable *t      = &s->errors->table;
  const PetscInt       before = t->count;

  Add(s, number, of, number->unit, value, least, run, SamErrorOfDerivative(value, run));
  *error = t->count > before ? t->row[before].error * t->row[before].scale : NAN;
}

PetscErrorCode SamErrorsAddNumbers(SamSimulation s, const SamControl *control)
{
  SamErrors e = s->errors;
  SamState  state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  SamErrorsRaise(&e->largest, state);
  for (PetscInt i = 0; i < e->count; i++) {
    const SamErrorNumber *n   = &e->number[i];
    const PetscBool       sum = n->of->join == SAM_JOIN_SUM ? PETSC_TRUE : PETSC_FALSE;
    const double own = sum ? e->sums[n->id] : *SamStateReadNumbers(state, n->id), least = SamErrorsLeast(s, n->of);
    double       run[SAM_RUNS];

    if ((sum && s->life) || SamErrorsPrescribes(control, n->of->name)) continue;
    SamErrorsGetRuns(e, n, sum, run);
    for (int c = 0; c < SAM_RUNS && sum; c++) run[c] -= n->base[c];
    if (sum && e->companion[SAM_RUN_OTHER].run) run[SAM_RUN_OTHER] = run[e->same] - n->apart;
    SamErrorsAddRow(s, n->of, SamUnitOn(s->setup.grid, n->of->unit), own, least, run);
  }
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
  if (cause == SAM_CAUSE_CELLS && row->more > 0) return PETSC_TRUE;
  return cause != SAM_CAUSE_CELLS || fabs(row->value - row->run[SAM_RUN_HALF]) > APART * row->scale;
}

/* True if companion runs to the end tell the errors by a cause. */
static PetscBool Knows(SamErrors e, SamCause cause)
{
  const SamCompanion *half = &e->companion[SAM_RUN_HALF], *other = &e->companion[SAM_RUN_OTHER];

  if (half->fault[0] || cause >= SAM_CAUSE_LAYERS) return PETSC_FALSE;
  return cause == SAM_CAUSE_CELLS || (other->run && !other->fault[0]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Tells which companions ended early, and why. */
static PetscErrorCode WarnOfFaults(SamErrors e, const SamAdvice *advice)
{
  static const char *const what[SAM_RUNS] = {"half the cells", "", "fewer cells with other steps"};
  char                     text[SAM_MESSAGE + 64];

  PetscFunctionBegin;
  if (e->unknown[0]) {
    (void)snprintf(text, sizeof(text), "errors are unknown: %s", e->unknown);
    PetscCall((*advice->receive)(advice->context, text, ""));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int c = 0; c < SAM_RUNS; c++) {
    const SamCompanion *one = &e->companion[c];

    if (!one->run || !one->fault[0] || c == SAM_RUN_QUARTER) continue; /* of that half the cells tell enough */
    (void)snprintf(text, sizeof(text), "errors by the %s are unknown: on %s %s",
                   SamCauseNames[c == SAM_RUN_OTHER ? SAM_CAUSE_STEPS : SAM_CAUSE_CELLS], what[c], one->fault);
    PetscCall((*advice->receive)(advice->context, text, ""));
    if (c == SAM_RUN_HALF) break; /* nothing is known without it */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the error of a row, and why there is no limit. */
static void AddDoubt(SamErrors e, SamAdvice *advice, SamCause cause, const SamErrorRow *row)
{
  char why[SAM_DOUBT_WHY] = "";

  if (row->grows[cause] && cause == SAM_CAUSE_STEPS)
    (void)snprintf(why, sizeof(why), SAM_DOUBT_TWIST);
  else if (row->grows[cause])
    (void)snprintf(why, sizeof(why), "%s grows with each finer grid", row->name);
  else if (cause == SAM_CAUSE_CELLS && row->more > 0)
    (void)snprintf(why, sizeof(why), SAM_ACROSS " in the last step", "", (double)e->few, e->few == 1 ? "" : "s");
  SamDoubtsAdd(&advice->doubts, cause, row->of[cause], FactorOf(row, cause), row->name, "%s", why);
}

PetscErrorCode SamErrorsAddDoubts(SamErrors e, SamAdvice *advice)
{
  const SamErrorTable *t = &e->table;

  PetscFunctionBegin;
  PetscCall(WarnOfFaults(e, advice));
  for (SamCause cause = 0; cause < SAM_CAUSES; cause++) {
    advice->knows[cause] = Knows(e, cause);
    for (PetscInt k = 0; k < t->count; k++)
      if (IsLarge(&t->row[k], cause)) AddDoubt(e, advice, cause, &t->row[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

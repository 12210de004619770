/*
  A computed cycle, and the wear of the next cycles that follows from it.

  In a cycle a cell wears by r, the wear load per cycle, under the mean pressure P of the cycle's steps: r = e P. Where
  the surfaces never touch, e is the wear that the slip there would cause in contact, so that new contact wears at once.

  The gaps and pressures of the steps are related linearly, and so are their means: G = S P + lift + h - rigid, with the
  mean rigid displacements and the mean lift by the shear of dissimilar bodies. In cells that are open in a part of the
  cycle both P and G are positive. If the gap there is replaced by h - G, P solves the normal problem of the mean loads.
  A jump changes this problem (cyclejump.c).

  Where material streams through the contact, in steady rolling, a step is a passage: each line of the running band
  wears by r, the integral of p |s| along x, which is the pressure times the slip in a passage. There P is the integral
  of the mean pressure along the line, and e = r/P its mean slip. As a line yields by e times the integral of its own
  pressure, the operator of a jump remains symmetric and positive, however the slip varies along the line. Lines without
  contact have the e of the nearest line with contact.
*/
#include "lifeimpl.h"
#include <petsam/private/normal.h>
#include <petsam/private/solver.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/contact.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problem.h>
#include <math.h>

#define MOST_PASSES 20   /* maximum number of cycles run to close the loop */
#define CLOSED      0.1  /* change of the shear/(mu p), and of the energy, over the jumps' tolerance */
#define TURN        1e-9 /* changes that count, relative to the range of a component */

/* ---- load reversals ---- */

/* Finds the steps at which a part of the control reverses, from its values at all steps. */
static void NoteTurns(const SamControl controls[], SamConditions conditions, PetscInt n, PetscInt c, PetscBool turns[])
{
  PetscReal low = PETSC_INFINITY, high = PETSC_NINFINITY, last = 0;

  for (PetscInt k = 0; k < n; k++) {
    low  = PetscMin(low, SamControlPart(&controls[k], conditions, c));
    high = PetscMax(high, SamControlPart(&controls[k], conditions, c));
  }
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal before = SamControlPart(&controls[k ? k - 1 : n - 1], conditions, c);
    const PetscReal change = SamControlPart(&controls[k], conditions, c) - before;

    if (fabs(change) <= TURN * (high - low)) continue;
    if (k && change * last < 0) turns[k - 1] = PETSC_TRUE;
    last = change;
  }
}

PetscErrorCode SamLifeFindTurns(SamLife l)
{
  const PetscInt      n = l->cycle.steps;
  SamControl         *controls;
  const SamConditions conditions = SamProblemGetConditions(l->problem);

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n, &l->turns));
  PetscCall(PetscMalloc1(n, &controls));
  for (PetscInt k = 0; k < n; k++) PetscCall(l->cycle.control(l->cycle.context, k, 0, &controls[k]));
  for (PetscInt c = 0; c < SamControlCount(conditions); c++) NoteTurns(controls, conditions, n, c, l->turns);
  l->turns[n - 1] = PETSC_TRUE;
  PetscCall(PetscFree(controls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- means over the cycle ---- */

PetscErrorCode SamLifeGetSum(SamLife l, PetscInt k, Vec *sum)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  *sum = NULL;
  PetscCall(SamProblemGetLaws(l->problem, &count, &laws));
  if (k < count && laws[k]->accumulates)
    PetscCall(SamStateRestoreField(l->memory, SamStateFindField(l->memory, laws[k]->type), SAM_COMMITTED, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Continues the sums over the steps from those before the cycle; in the middle of a jump they start from 0. */
static PetscErrorCode BeginSums(SamLife l, PetscBool middle)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_LAWS; k++) {
    Vec sum;

    PetscCall(SamLifeGetSum(l, k, &sum));
    if (sum && middle) PetscCall(VecSet(sum, 0));
    if (sum && !middle) PetscCall(VecCopy(l->before[k], sum));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the committed values of a field that the law of wear stores. */
static PetscErrorCode Remembered(SamLife l, const char name[], Vec *field)
{
  PetscFunctionBegin;
  PetscCall(SamStateRestoreField(l->memory, SamStateFindField(l->memory, name), SAM_COMMITTED, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeGetLoads(SamLife l, SamLoads loads)
{
  static const char *const names[SAM_WEAR_LOADS] = {SAM_WEAR_LOAD, SAM_WEAR_LOAD2};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(Remembered(l, names[k], &loads[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeSetLoads(SamLife l, const SamLoads loads)
{
  SamLoads to;

  PetscFunctionBegin;
  PetscCall(SamLifeGetLoads(l, to));
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(VecCopy(loads[k], to[k]));
  l->law->revision++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(SamLife l, SamRate *rate, SamControl *mean)
{
  const SamSolution *s;
  Vec                cycle, path;

  PetscFunctionBegin;
  PetscCall(BeginSums(l, rate == &l->middle));
  PetscCall(Remembered(l, SAM_WEAR_CYCLE, &cycle));
  PetscCall(Remembered(l, SAM_WEAR_PATH, &path));
  PetscCall(VecSet(cycle, 0));
  PetscCall(VecSet(path, 0));
  if (l->passage) PetscCall(VecSet(l->passage, 0));
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(rate->passes ? VecCopy(s->pressure, rate->pressure) : VecSet(rate->pressure, 0));
  PetscCall(VecSet(rate->shift, 0));
  PetscCall(VecSet(rate->coefficient, 0));
  if (rate == &l->start && rate->passes) PetscCall(SamLifeBeginStrides(l));
  PetscCall(SamControlInitialize(mean));
  l->energy = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeIntegrate(SamGrid grid, Vec field)
{
  double *f;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &f));
  for (PetscInt first = 0; first < grid->cells; first += grid->nx) {
    double sum = 0;

    for (PetscInt k = first; k < first + grid->nx; k++) sum += f[k] * (double)grid->dx;
    for (PetscInt k = first; k < first + grid->nx; k++) f[k] = sum;
  }
  PetscCall(VecRestoreArray(field, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds the wear of a band by a passage, and its frictional work. The work of the loads is the same for similar bodies,
  but includes work of the pressure for dissimilar ones.
*/
static PetscErrorCode AddPassage(SamLife l)
{
  SamTotal      total = {0};
  double        power;
  const double *line;

  PetscFunctionBegin;
  PetscCall(SamContactGetField(l->contact, "power_density", l->gap));
  PetscCall(SamLifeIntegrate(l->grid, l->gap));
  PetscCall(VecGetArrayRead(l->gap, &line));
  for (PetscInt j = 0; j < l->grid->rows; j++) SamAdd(&total, line[j * l->grid->nx]);
  PetscCall(VecRestoreArrayRead(l->gap, &line));
  PetscCall(SamSumTotals(l->grid->comm, 1, &total, &power));
  l->energy += power * l->grid->dy;
  if (!((const SamWear *)l->law->data)->by_energy) PetscCall(SamContactGetField(l->contact, "wear_passage", l->gap));
  PetscCall(VecAXPY(l->passage, 1, l->gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds a tried step to the means: pressure, gap in `shift`, and, where surfaces are lifted, u_z in `coefficient`;
  conditions are those of the last step. Magnified cycles repeat the step itself instead.
*/
static PetscErrorCode Count(SamLife l, PetscInt k, const SamStep *step, SamRate *rate, SamControl *mean)
{
  const PetscReal    part   = 1 / (PetscReal)l->cycle.steps;
  const SamControl   so_far = *mean;
  const SamSolution *s;
  PetscReal          energy;

  PetscFunctionBegin;
  if (l->band) {
    PetscCall(AddPassage(l));
  } else {
    PetscCall(SamContactGetNumber(l->contact, "dissipated_energy", &energy));
    l->energy += energy;
  }
  if (rate->passes) PetscCall(SamLifeNotePass(l, k, step, rate));
  if (rate->passes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(VecAXPY(rate->pressure, part, s->pressure));
  PetscCall(SamContactGetField(l->contact, "gap", l->gap));
  PetscCall(VecAXPY(rate->shift, part, l->gap));
  if (l->lifts) PetscCall(VecAXPY(rate->coefficient, part, s->displacement_z));
  *mean = step->control;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) mean->value[c] = so_far.value[c] + part * step->control.value[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the rate ---- */

/* Computes the shift from the mean gap; `coefficient` contains u_z where surfaces are lifted. */
static PetscErrorCode FindShift(SamLife l, SamRate *rate)
{
  const double *p;
  double       *shift;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(rate->pressure, &p));
  PetscCall(VecGetArray(rate->shift, &shift));
  for (PetscInt k = 0; k < l->grid->cells; k++) shift[k] = SamIsPressed(p[k]) ? -shift[k] : 0;
  PetscCall(VecRestoreArray(rate->shift, &shift));
  PetscCall(VecRestoreArrayRead(rate->pressure, &p));
  if (!l->lifts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityApplyNormal(SamProblemGetElasticity(l->problem), rate->pressure, l->gap));
  PetscCall(VecAXPY(rate->shift, 1, rate->coefficient));
  PetscCall(VecAXPY(rate->shift, -1, l->gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the coefficient of a band; `most`: its largest wear load per pressure, m. */
static PetscErrorCode FindCoefficientOfBand(SamLife l, SamRate *rate, double *most)
{
  const SamGrid grid = l->grid;
  const double *p, *passage, *line;
  double       *slip, *to;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(grid->ny, &slip));
  PetscCall(VecCopy(rate->pressure, l->gap));
  PetscCall(SamLifeIntegrate(grid, l->gap));
  PetscCall(VecGetArrayRead(rate->pressure, &p));
  PetscCall(VecGetArrayRead(l->passage, &passage));
  PetscCall(VecGetArrayRead(l->gap, &line));
  for (PetscInt k = 0; k < grid->cells; k += grid->nx) {
    double *mine = &slip[grid->row_start + k / grid->nx], cells = 0;

    *mine = line[k] > 0 ? PetscMax(passage[k], 0) / line[k] : 0;
    for (PetscInt i = k; i < k + grid->nx; i++) cells += SamIsPressed(p[i]);
    *most = PetscMax(*most, *mine * cells * (double)grid->dx);
  }
  PetscCall(VecRestoreArrayRead(l->gap, &line));
  PetscCall(VecRestoreArrayRead(l->passage, &passage));
  PetscCall(VecRestoreArrayRead(rate->pressure, &p));
  PetscCall(SamSum(grid->comm, grid->ny, slip));
  for (PetscInt j = 1; j < grid->ny; j++) slip[j] = slip[j] > 0 ? slip[j] : slip[j - 1];
  for (PetscInt j = grid->ny - 1; j > 0; j--) slip[j - 1] = slip[j - 1] > 0 ? slip[j - 1] : slip[j];
  PetscCall(VecGetArrayWrite(rate->coefficient, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = slip[grid->row_start + k / grid->nx];
  PetscCall(VecRestoreArrayWrite(rate->coefficient, &to));
  PetscCall(PetscFree(slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindCoefficient(SamLife l, const SamControl *mean, SamRate *rate)
{
  const SamBoundAt at = {l->memory, mean, rate->pressure, NULL, 0};
  const double    *p, *load, *path, *unit;
  double          *to, most = 0;
  Vec              cycle, slip;

  PetscFunctionBegin;
  if (l->band) {
    PetscCall(FindCoefficientOfBand(l, rate, &most));
    PetscCall(SamMax(l->grid->comm, 1, &most));
    PetscCall(SamWearGetLimit(l->law, (PetscReal)most, &rate->limit));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecSet(l->diagonal, 1)); /* wear load of a unit of slip per pressure */
  if (((const SamWear *)l->law->data)->by_energy)
    PetscCall(SamProblemComputeBound(l->problem, &at, &(SamBound){.by_pressure = l->diagonal}));
  PetscCall(Remembered(l, SAM_WEAR_CYCLE, &cycle));
  PetscCall(Remembered(l, SAM_WEAR_PATH, &slip));
  PetscCall(VecGetArrayRead(rate->pressure, &p));
  PetscCall(VecGetArrayRead(cycle, &load));
  PetscCall(VecGetArrayRead(slip, &path));
  PetscCall(VecGetArrayRead(l->diagonal, &unit));
  PetscCall(VecGetArrayWrite(rate->coefficient, &to));
  for (PetscInt k = 0; k < l->grid->cells; k++) {
    to[k] = SamIsPressed(p[k]) ? load[k] / p[k] : unit[k] * path[k];
    most  = SamIsPressed(p[k]) ? PetscMax(most, to[k]) : most;
  }
  PetscCall(VecRestoreArrayWrite(rate->coefficient, &to));
  PetscCall(VecRestoreArrayRead(l->diagonal, &unit));
  PetscCall(VecRestoreArrayRead(slip, &path));
  PetscCall(VecRestoreArrayRead(cycle, &load));
  PetscCall(VecRestoreArrayRead(rate->pressure, &p));
  PetscCall(SamMax(l->grid->comm, 1, &most));
  PetscCall(SamWearGetLimit(l->law, (PetscReal)most, &rate->limit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the cycle ---- */

static PetscErrorCode SolveStep(SamLife l, PetscInt k, PetscReal cycles, SamStep *step, PetscBool *solved)
{
  SamControl control;

  PetscFunctionBegin;
  PetscCall(l->cycle.control(l->cycle.context, k, cycles, &control));
  PetscCall(SamContactTry(l->contact, &control, step));
  *solved = SamStepIsSolved(step);
  if (!*solved || l->step.status == SAM_STATUS_CONVERGED) {
    l->step = *step;
    l->at   = k;
    PetscCall(SamContactGetNumber(l->contact, "contact_area", &l->area));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Commit(SamLife l, PetscInt k, SamLifePlace place)
{
  PetscFunctionBegin;
  if (l->cycle.commits) PetscCall(l->cycle.commits(l->cycle.context, k, place));
  PetscCall(SamContactCommit(l->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- closing the loop ---- */

/* Returns the places of the bodies. */
static PetscErrorCode Locate(SamLife l, PetscReal at[2])
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(l->contact, &s));
  at[0] = s->rigid[SAM_COMPONENT_TX];
  at[1] = s->rigid[SAM_COMPONENT_TY];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Closes a cycle in which periodic surfaces have slid by whole periods since they were at `from`: the next cycle begins
  at `from`. So does the cycle after a jump; the periods passed in its cycles need not be counted.
*/
static PetscErrorCode Rewind(SamLife l, const PetscReal from[2])
{
  PetscReal to[2] = {0, 0}, by[2] = {0, 0};

  PetscFunctionBegin;
  if (!SamElasticityGetTraits(SamProblemGetElasticity(l->problem)).periodic || !l->start.passes)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Locate(l, to));
  for (PetscInt k = 0; k < 2; k++) by[k] = l->grid->width[k] * rint((to[k] - from[k]) / l->grid->width[k]);
  if (by[0] != 0 || by[1] != 0) PetscCall(SamContactRewind(l->contact, by));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the cycle at its load reversals or at all steps; its wear does not count, only its `energy`. */
static PetscErrorCode GoRound(SamLife l, PetscReal cycles, PetscReal *energy, PetscBool *solved)
{
  SamStep   step;
  PetscReal dissipated, from[2];

  PetscFunctionBegin;
  *energy = 0;
  PetscCall(Locate(l, from));
  for (PetscInt k = 0; k < l->cycle.steps && *solved; k++) {
    if (l->state.by_turns && !l->turns[k]) continue;
    PetscCall(SolveStep(l, k, cycles, &step, solved));
    if (!*solved) break;
    PetscCall(SamContactGetNumber(l->contact, "dissipated_energy", &dissipated));
    *energy += dissipated;
    PetscCall(Commit(l, k, SAM_LIFE_CLOSING));
  }
  if (*solved) PetscCall(Rewind(l, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Runs cycles until the shear after a cycle differs from that before it only by a small part of mu p; `energy`: energy
  of the last cycle. The first cycle begins at any point of the history; if the contact rocks, more cycles may be
  needed.
*/
static PetscErrorCode CloseLoop(SamLife l, PetscReal cycles, PetscReal *energy, PetscBool *solved)
{
  const SamSolution *s;
  PetscReal          change = PETSC_INFINITY, bound = 0;

  PetscFunctionBegin;
  l->state.by_turns = PETSC_FALSE;
  for (PetscInt pass = 0; pass < MOST_PASSES && change > CLOSED * l->set.rtol * bound; pass++) {
    PetscCall(SamContactGetSolution(l->contact, &s));
    PetscCall(VecCopy(s->shear, l->shear));
    PetscCall(GoRound(l, cycles, energy, solved));
    if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
    l->state.computed++;
    PetscCall(SamContactGetSolution(l->contact, &s));
    PetscCall(VecAXPY(l->shear, -1, s->shear));
    PetscCall(SamGridNorm(l->grid, l->shear, NORM_1, &change));
    PetscCall(SamGridNorm(l->grid, s->bound, NORM_1, &bound));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds the steps that reproduce a closed loop: the load reversals for reciprocating loads, all steps if the contact
  rolls. The choice depends on the energy that the cycle dissipates after them. These steps close the loop again
  whenever the gap has changed a little: otherwise the wear of a cycle would depend on the jump before it, and jumps
  would be of first order.
*/
static PetscErrorCode FindWay(SamLife l, PetscReal cycles, PetscBool *solved)
{
  PetscReal closed, ignored, after;
  PetscBool same;

  PetscFunctionBegin;
  PetscCall(CloseLoop(l, cycles, &closed, solved));
  if (SamLifeHasStrain(l)) PetscFunctionReturn(PETSC_SUCCESS); /* it depends on the steps to it */
  l->state.by_turns = PETSC_TRUE;
  if (*solved) PetscCall(GoRound(l, cycles, &ignored, solved));
  l->state.by_turns = PETSC_FALSE;
  if (*solved) PetscCall(GoRound(l, cycles, &after, solved));
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  l->state.computed++;
  same = fabs(after - closed) <= CLOSED * l->set.rtol * closed;
  if (!same) PetscCall(CloseLoop(l, cycles, &closed, solved));
  l->state.by_turns = same;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeComputeRate(SamLife l, SamRate *rate, PetscReal cycles, PetscBool tell, PetscBool *solved)
{
  const PetscInt n = l->cycle.steps;
  SamControl     mean;
  PetscReal      ignored, most, from[2];
  SamStep        step;

  PetscFunctionBegin;
  *solved        = PETSC_TRUE;
  l->step.status = SAM_STATUS_CONVERGED;
  if (l->open)
    PetscCall(FindWay(l, cycles, solved));
  else if (!l->band)
    PetscCall(GoRound(l, cycles, &ignored, solved));
  PetscCall(Begin(l, rate, &mean));
  if (tell) PetscCall(SamLifeKeepStrain(l, &l->strain));
  PetscCall(Locate(l, from));
  for (PetscInt k = 0; k < n && *solved; k++) {
    PetscCall(SolveStep(l, k, cycles, &step, solved));
    if (tell && l->cycle.solved) PetscCall(l->cycle.solved(l->cycle.context, k, cycles, &step));
    if (*solved) PetscCall(Count(l, k, &step, rate, &mean));
    if (*solved) PetscCall(Commit(l, k, rate == &l->start ? SAM_LIFE_START : SAM_LIFE_MIDDLE));
  }
  l->state.computed++;
  l->open = *solved || l->band ? PETSC_FALSE : PETSC_TRUE;
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  if (tell) PetscCall(SamLifeFindFlow(l, &l->strain));
  PetscCall(Rewind(l, from));
  if (rate->passes) {
    if (rate == &l->start) PetscCall(SamLifeEndStrides(l));
    PetscCall(VecMax(rate->coefficient, NULL, &most));
    PetscCall(SamWearGetLimit(l->law, most, &rate->limit));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  rate->balance = SamControlGetBalance(&mean, SAM_BALANCE_NORMAL);
  PetscCall(FindShift(l, rate));
  PetscCall(FindCoefficient(l, &mean, rate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reports a jump without solution as a failed step. */
static PetscErrorCode FailJump(SamLife l, PetscReal cycles, SamSolverReason reason)
{
  PetscFunctionBegin;
  l->at          = l->cycle.steps - 1;
  l->step.status = SAM_STATUS_NOT_CONVERGED;
  (void)snprintf(l->step.message, sizeof(l->step.message),
                 "the normal problem of a cycle jump of %.10g cycles did not converge: %s", (double)cycles,
                 SamSolverReasonName(reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeSolveNormal(SamLife l, SamBalance balance, PetscReal cycles, PetscBool guess, Vec p,
                                  PetscBool *solved)
{
  const SamNormal normal = SamContactGetNormal(l->contact);

  PetscFunctionBegin;
  PetscCall(SamNormalSolveYielding(normal, l->gap, l->diagonal, &balance, guess, p));
  *solved = SamSolverGetReason(SamNormalAsSolver(normal)) > 0;
  if (!*solved) PetscCall(FailJump(l, cycles, SamSolverGetReason(SamNormalAsSolver(normal))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

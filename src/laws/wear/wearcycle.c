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

/* Takes a field for a sum over the steps. */
static PetscErrorCode BeginMean(SamLife l, PetscBool needed, Vec *mean)
{
  PetscFunctionBegin;
  *mean = NULL;
  if (!needed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamPoolTake(l->pool, mean));
  PetscCall(VecSet(*mean, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(SamLife l, SamRate *rate, SamMeans *means)
{
  const PetscBool    magnified = rate->passes ? PETSC_TRUE : PETSC_FALSE;
  const SamSolution *s;
  Vec                cycle, path;

  PetscFunctionBegin;
  PetscCall(SamLifeBeginSums(l, rate == &l->middle));
  PetscCall(SamLifeRemembered(l, SAM_WEAR_CYCLE, &cycle));
  PetscCall(SamLifeRemembered(l, SAM_WEAR_PATH, &path));
  PetscCall(VecSet(cycle, 0));
  PetscCall(VecSet(path, 0));
  PetscCall(BeginMean(l, l->band, &means->passage));
  PetscCall(BeginMean(l, !magnified, &means->gap));
  PetscCall(BeginMean(l, !magnified && l->lifts, &means->lift));
  PetscCall(BeginMean(l, magnified, &means->before));
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(magnified ? VecCopy(s->pressure, means->before) : VecSet(rate->pressure, 0));
  if (magnified) PetscCall(VecSet(rate->coefficient, 0));
  if (rate == &l->start && magnified) PetscCall(SamLifeBeginStrides(l));
  PetscCall(SamControlInitialize(&means->control));
  l->energy = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the fields back. */
static PetscErrorCode End(SamLife l, SamMeans *means)
{
  Vec *const fields[] = {&means->before, &means->lift, &means->gap, &means->passage};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(fields) / sizeof(fields[0]); k++)
    if (*fields[k]) PetscCall(SamPoolGive(l->pool, fields[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a part of a field of the tried step. */
static PetscErrorCode AddField(SamLife l, const char name[], PetscReal part, Vec sum)
{
  Vec field;

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &field));
  PetscCall(SamContactGetField(l->contact, name, field));
  PetscCall(VecAXPY(sum, part, field));
  PetscCall(SamPoolGive(l->pool, &field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds the wear of a band by a passage, and its frictional work. The work of the loads is the same for similar bodies,
  but includes work of the pressure for dissimilar ones.
*/
static PetscErrorCode AddPassage(SamLife l, Vec passage)
{
  const PetscBool by_energy = ((const SamWear *)l->law->data)->by_energy;
  SamTotal        total     = {0};
  double          power;
  const double   *line;
  Vec             lines; /* frictional power of each line over the rolling speed, Pa m */

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &lines));
  PetscCall(SamContactGetField(l->contact, "power_density", lines));
  PetscCall(SamLifeIntegrate(l->grid, lines));
  PetscCall(VecGetArrayRead(lines, &line));
  for (PetscInt j = 0; j < l->grid->rows; j++) SamAdd(&total, line[j * l->grid->nx]);
  PetscCall(VecRestoreArrayRead(lines, &line));
  PetscCall(SamSumTotals(l->grid->comm, 1, &total, &power));
  l->energy += power * l->grid->dy;
  PetscCall(by_energy ? VecAXPY(passage, 1, lines) : AddField(l, "wear_passage", 1, passage));
  PetscCall(SamPoolGive(l->pool, &lines));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a tried step to the means. Magnified cycles repeat the step itself instead. */
static PetscErrorCode Count(SamLife l, PetscInt k, const SamStep *step, SamRate *rate, SamMeans *means)
{
  const PetscReal    part   = 1 / (PetscReal)l->cycle.steps;
  const SamControl   so_far = means->control;
  const SamSolution *s;
  PetscReal          energy;

  PetscFunctionBegin;
  if (l->band) {
    PetscCall(AddPassage(l, means->passage));
  } else {
    PetscCall(SamContactGetNumber(l->contact, "dissipated_energy", &energy));
    l->energy += energy;
  }
  if (rate->passes) PetscCall(SamLifeNotePass(l, k, step, means->before, rate));
  if (rate->passes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(VecAXPY(rate->pressure, part, s->pressure));
  PetscCall(AddField(l, "gap", part, means->gap));
  if (means->lift) PetscCall(VecAXPY(means->lift, part, s->displacement_z));
  means->control = step->control;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    means->control.value[c] = so_far.value[c] + part * step->control.value[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the rate ---- */

/* Computes the shift from the mean gap and lift. */
static PetscErrorCode FindShift(SamLife l, const SamMeans *means, SamRate *rate)
{
  const double *p, *gap;
  double       *shift;
  Vec           by_pressure; /* S P, m */

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(rate->pressure, &p));
  PetscCall(VecGetArrayRead(means->gap, &gap));
  PetscCall(VecGetArrayWrite(rate->shift, &shift));
  for (PetscInt k = 0; k < l->grid->cells; k++) shift[k] = SamIsPressed(p[k]) ? -gap[k] : 0;
  PetscCall(VecRestoreArrayWrite(rate->shift, &shift));
  PetscCall(VecRestoreArrayRead(means->gap, &gap));
  PetscCall(VecRestoreArrayRead(rate->pressure, &p));
  if (!means->lift) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamPoolTake(l->pool, &by_pressure));
  PetscCall(SamElasticityApplyNormal(SamProblemGetElasticity(l->problem), rate->pressure, by_pressure));
  PetscCall(VecAXPY(rate->shift, 1, means->lift));
  PetscCall(VecAXPY(rate->shift, -1, by_pressure));
  PetscCall(SamPoolGive(l->pool, &by_pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the coefficient of a band from its wear load, Pa m; `most`: its largest wear load per pressure, m. */
static PetscErrorCode FindCoefficientOfBand(SamGrid grid, SamPool pool, Vec wear, SamRate *rate, double *most)
{
  const double *p, *passage, *line;
  double       *slip, *to;
  Vec           lines; /* the pressure's integral along x, Pa m */

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(grid->ny, &slip));
  PetscCall(SamPoolTake(pool, &lines));
  PetscCall(VecCopy(rate->pressure, lines));
  PetscCall(SamLifeIntegrate(grid, lines));
  PetscCall(VecGetArrayRead(rate->pressure, &p));
  PetscCall(VecGetArrayRead(wear, &passage));
  PetscCall(VecGetArrayRead(lines, &line));
  for (PetscInt k = 0; k < grid->cells; k += grid->nx) {
    double *mine = &slip[grid->row_start + k / grid->nx], cells = 0;

    *mine = line[k] > 0 ? PetscMax(passage[k], 0) / line[k] : 0;
    for (PetscInt i = k; i < k + grid->nx; i++) cells += SamIsPressed(p[i]);
    *most = PetscMax(*most, *mine * cells * (double)grid->dx);
  }
  PetscCall(VecRestoreArrayRead(lines, &line));
  PetscCall(VecRestoreArrayRead(wear, &passage));
  PetscCall(VecRestoreArrayRead(rate->pressure, &p));
  PetscCall(SamPoolGive(pool, &lines));
  PetscCall(SamSum(grid->comm, grid->ny, slip));
  for (PetscInt j = 1; j < grid->ny; j++) slip[j] = slip[j] > 0 ? slip[j] : slip[j - 1];
  for (PetscInt j = grid->ny - 1; j > 0; j--) slip[j - 1] = slip[j - 1] > 0 ? slip[j - 1] : slip[j];
  PetscCall(VecGetArrayWrite(rate->coefficient, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = slip[grid->row_start + k / grid->nx];
  PetscCall(VecRestoreArrayWrite(rate->coefficient, &to));
  PetscCall(PetscFree(slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the coefficient of a contact whose material stays; `most` likewise. */
static PetscErrorCode FindCoefficientOfCells(SamLife l, const SamControl *mean, SamRate *rate, double *most)
{
  const SamBoundAt at = {l->memory, mean, rate->pressure, NULL, 0};
  const double    *p, *load, *path, *unit;
  double          *to;
  Vec              cycle, slip, units; /* wear load of a unit of slip per pressure */

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &units));
  PetscCall(VecSet(units, 1));
  if (((const SamWear *)l->law->data)->by_energy)
    PetscCall(SamProblemComputeBound(l->problem, &at, &(SamBound){.by_pressure = units}));
  PetscCall(SamLifeRemembered(l, SAM_WEAR_CYCLE, &cycle));
  PetscCall(SamLifeRemembered(l, SAM_WEAR_PATH, &slip));
  PetscCall(VecGetArrayRead(rate->pressure, &p));
  PetscCall(VecGetArrayRead(cycle, &load));
  PetscCall(VecGetArrayRead(slip, &path));
  PetscCall(VecGetArrayRead(units, &unit));
  PetscCall(VecGetArrayWrite(rate->coefficient, &to));
  for (PetscInt k = 0; k < l->grid->cells; k++) {
    to[k] = SamIsPressed(p[k]) ? load[k] / p[k] : unit[k] * path[k];
    *most = SamIsPressed(p[k]) ? PetscMax(*most, to[k]) : *most;
  }
  PetscCall(VecRestoreArrayWrite(rate->coefficient, &to));
  PetscCall(VecRestoreArrayRead(units, &unit));
  PetscCall(VecRestoreArrayRead(slip, &path));
  PetscCall(VecRestoreArrayRead(cycle, &load));
  PetscCall(VecRestoreArrayRead(rate->pressure, &p));
  PetscCall(SamPoolGive(l->pool, &units));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindCoefficient(SamLife l, const SamMeans *means, SamRate *rate)
{
  double most = 0;

  PetscFunctionBegin;
  PetscCall(l->band ? FindCoefficientOfBand(l->grid, l->pool, means->passage, rate, &most)
                    : FindCoefficientOfCells(l, &means->control, rate, &most));
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
  Vec                shear; /* before a cycle minus that after it, two components, Pa */

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(l->grid, 2, &shear));
  l->state.by_turns = PETSC_FALSE;
  for (PetscInt pass = 0; pass < MOST_PASSES && change > CLOSED * l->set.rtol * bound; pass++) {
    PetscCall(SamContactGetSolution(l->contact, &s));
    PetscCall(VecCopy(s->shear, shear));
    PetscCall(GoRound(l, cycles, energy, solved));
    if (!*solved) break;
    l->state.computed++;
    PetscCall(SamContactGetSolution(l->contact, &s));
    PetscCall(VecAXPY(shear, -1, s->shear));
    PetscCall(SamGridNorm(l->grid, shear, NORM_1, &change));
    PetscCall(SamGridNorm(l->grid, s->bound, NORM_1, &bound));
  }
  PetscCall(VecDestroy(&shear));
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

/* Computes the rate from what has been summed up over the solved cycle. */
static PetscErrorCode FindRate(SamLife l, const SamMeans *means, SamRate *rate)
{
  PetscReal most;

  PetscFunctionBegin;
  if (rate->passes) {
    if (rate == &l->start) PetscCall(SamLifeEndStrides(l));
    PetscCall(VecMax(rate->coefficient, NULL, &most));
    PetscCall(SamWearGetLimit(l->law, most, &rate->limit));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  rate->balance = SamControlGetBalance(&means->control, SAM_BALANCE_NORMAL);
  PetscCall(FindShift(l, means, rate));
  PetscCall(FindCoefficient(l, means, rate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeComputeRate(SamLife l, SamRate *rate, PetscReal cycles, PetscBool tell, PetscBool *solved)
{
  const PetscInt n = l->cycle.steps;
  SamMeans       means;
  PetscReal      ignored, from[2];
  SamStep        step;

  PetscFunctionBegin;
  *solved        = PETSC_TRUE;
  l->step.status = SAM_STATUS_CONVERGED;
  if (l->open)
    PetscCall(FindWay(l, cycles, solved));
  else if (!l->band)
    PetscCall(GoRound(l, cycles, &ignored, solved));
  PetscCall(Begin(l, rate, &means));
  if (tell) PetscCall(SamLifeKeepStrain(l, &l->strain));
  PetscCall(Locate(l, from));
  for (PetscInt k = 0; k < n && *solved; k++) {
    PetscCall(SolveStep(l, k, cycles, &step, solved));
    if (tell && l->cycle.solved) PetscCall(l->cycle.solved(l->cycle.context, k, cycles, &step));
    if (*solved) PetscCall(Count(l, k, &step, rate, &means));
    if (*solved) PetscCall(Commit(l, k, rate == &l->start ? SAM_LIFE_START : SAM_LIFE_MIDDLE));
  }
  l->state.computed++;
  l->open = *solved || l->band ? PETSC_FALSE : PETSC_TRUE;
  if (*solved && tell) PetscCall(SamLifeFindFlow(l, &l->strain));
  if (*solved) PetscCall(Rewind(l, from));
  if (*solved) PetscCall(FindRate(l, &means, rate));
  PetscCall(End(l, &means));
  PetscFunctionReturn(PETSC_SUCCESS);
}

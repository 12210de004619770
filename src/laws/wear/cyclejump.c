/*
  Jumps over cycles.

  In a computed cycle a cell wears by r = e P, the wear load per cycle, under the mean pressure P (wearcycle.c). In a
  jump over m cycles e is constant, and P is the mean pressure at the end of the jump: it solves the normal problem on
  the gap h + m K e P, which is linear in P. In steady rolling a cycle is a passage, and the same holds for lines of the
  running band, P being the integral of the pressure along them.

  A jump of m and two of m/2 give w1 and w2. These are of first order. 2 w2 - w1 is of second order, and |w2 - w1|
  estimates the error of w2 (Hairer, Norsett and Wanner 1993, Solving Ordinary Differential Equations I, II.4 and II.9;
  backward Euler's extrapolation is L-stable).
*/
#include "lifeimpl.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/normal.h>
#include <petsam/private/problem.h>
#include <math.h>

/* Limits of the ratio of the next jump's size to the last one's, and the part used of the size that the error allows */
#define GROW_MOST  2.5
#define GROW_LEAST 0.2
#define SAFETY     0.8
/* Ratio of the error of the halves to that of their extrapolation, which is the result; measured on a sphere
   (test_life) */
#define HALVES 2.0
/* Rounding of the sum of cycles so far, relative to a jump */
#define SAME 1e-6
/* Depths below this part of the displacements do not count. */
#define COUNTS 1e-6
/* The first jump, unless given, relative to the cycles that wear as much as a single step may */
#define FIRST 0.2

/* The fields that are created and destroyed. */
#define FIELDS(l) \
  { \
    &(l)->start.coefficient, &(l)->start.pressure, &(l)->start.shift, &(l)->middle.coefficient, &(l)->middle.pressure, \
      &(l)->middle.shift, &(l)->load[0], &(l)->load[1], &(l)->whole[0], &(l)->whole[1], &(l)->half[0], &(l)->half[1], \
      &(l)->halves[0], &(l)->halves[1], NULL \
  }

/* Finds the law of wear of the life's problem; rejects laws that cycle jumps do not support. */
static PetscErrorCode FindLaw(SamProblem problem, SamGrid grid, SamLaw *law)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) {
    PetscCheck(!laws[k]->forbids_jumps, grid->comm, PETSC_ERR_ARG_INCOMP,
               "Cycle jumps ignore what the law %s changes in skipped cycles", laws[k]->type);
    PetscCheck(!laws[k]->wears || SamLawIsWear(laws[k]), grid->comm, SAM_ERR_USER,
               "-%s: wears in each step, and has no cycle jumps: omit -wear_cycles", SamLawOption(laws[k]));
  }
  PetscCall(SamWearFind(problem, law));
  PetscCheck(*law, grid->comm, PETSC_ERR_ARG_INCOMP, "The contact has no law of wear");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeCreate(SamContact contact, const SamLifeCycle *cycle, const SamLifeSettings *settings,
                             SamLife *life)
{
  const SamProblem problem = SamContactGetProblem(contact);
  const SamGrid    grid    = SamContactGetGrid(contact);
  SamLaw           law;
  SamLife          l;
  PetscReal        slide[2];

  PetscFunctionBegin;
  PetscCheck(settings->rtol > 0 && isfinite(settings->rtol), grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "tolerance %.6g of cycle jumps: expected a finite number > 0", (double)settings->rtol);
  PetscCheck(settings->jump >= 0 && isfinite(settings->jump), grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "first cycle jump of %.6g cycles: expected a finite number >= 0", (double)settings->jump);
  PetscCall(FindLaw(problem, grid, &law));
  PetscCall(PetscNew(&l));
  l->contact = contact;
  l->grid    = grid;
  l->problem = problem;
  l->law     = law;
  PetscCall(SamContactGetState(contact, &l->memory));
  PetscCall(SamLifeDeclare(l));
  for (Vec **field = (Vec *[])FIELDS(l); *field; field++) PetscCall(SamGridCreateVec(grid, 1, *field));
  PetscCall(SamPoolCreate(grid, &l->pool));
  l->cycle      = *cycle;
  l->set        = *settings;
  l->state.next = settings->jump;
  l->band       = SamContactGetMotion(contact)->streams;
  l->open       = !l->band;
  l->lifts = SamElasticityGetTraits(SamProblemGetElasticity(l->problem)).coupled || SamProblemDisplaces(l->problem);
  PetscCheck(settings->magnified || !SamProblemGetOffset(problem, l->memory, SAM_COMMITTED, 1, slide), grid->comm,
             PETSC_ERR_ARG_INCOMP, "Surfaces that slide need magnified cycles");
  l->loads = SamStateFindField(l->memory, SAM_WEAR_LOAD2) < 0 ? 1 : SAM_WEAR_LOADS;
  if (settings->magnified) {
    PetscCall(SamRateCreatePasses(l, &l->start));
    PetscCall(SamRateCreatePasses(l, &l->middle));
  }
  PetscCall(SamLifeFindTurns(l));
  ((SamWear *)law->data)->jumps = PETSC_TRUE;

  *life = l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamLifeEnd(SamLife l)
{
  ((SamWear *)l->law->data)->jumps = PETSC_FALSE;
}

PetscErrorCode SamLifeDestroy(SamLife *life)
{
  SamLife l = *life;

  PetscFunctionBegin;
  *life = NULL;
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  SamLifeEnd(l);
  PetscCall(SamStateDestroy(&l->series));
  for (Vec **field = (Vec *[])FIELDS(l); *field; field++) PetscCall(VecDestroy(*field));
  PetscCall(SamPoolDestroy(&l->pool));
  PetscCall(VecDestroy(&l->stripes));
  for (PetscInt k = 0; k < SAM_LAWS; k++) PetscCall(VecDestroy(&l->before[k]));
  PetscCall(SamLifeDropStrain(&l->strain));
  PetscCall(SamRateDestroyPasses(l, &l->start));
  PetscCall(SamRateDestroyPasses(l, &l->middle));
  PetscCall(PetscFree(l->turns));
  PetscCall(PetscFree(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeDescribeWorn(SamLife l, const SamLifeReport *report, int body, char text[], size_t size)
{
  const SamPair pair = SamElasticityGetPair(SamProblemGetElasticity(l->problem));

  PetscFunctionBegin;
  PetscCall(SamBodyAdviseWorn(SamPairBody(pair, body), body + 1, report->depth[body], text, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamLifeState SamLifeGetState(SamLife l)
{
  return l->state;
}

PetscErrorCode SamLifeSetState(SamLife l, const SamLifeState *state)
{
  PetscFunctionBegin;
  l->state = *state;
  if (l->set.fixed) l->state.next = l->set.jump;
  l->open  = PETSC_FALSE;
  l->known = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- jumps ---- */

/* Computes the mean pressure (Pa) after `cycles` more at a rate, from the wear load `load` on. */
static PetscErrorCode SolvePressure(SamLife l, const SamRate *rate, PetscReal cycles, const SamLoads load, Vec pressure,
                                    PetscBool *solved)
{
  const SamWear *w = (const SamWear *)l->law->data;
  Vec            gap, yield;

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &gap));
  PetscCall(SamPoolTake(l->pool, &yield));
  PetscCall(SamLifeSetLoads(l, load));
  PetscCall(VecCopy(SamProblemGetGap(l->problem), gap));
  PetscCall(SamProblemAddSeparation(l->problem, l->memory, SAM_COMMITTED, gap, NULL));
  PetscCall(VecAXPY(gap, 1, rate->shift));
  PetscCall(VecCopy(rate->coefficient, yield));
  PetscCall(VecScale(yield, cycles * (w->coefficient[0] + w->coefficient[1])));
  PetscCall(SamLifeSolveNormal(l, gap, yield, rate->balance, cycles, PETSC_FALSE, pressure, solved));
  PetscCall(SamPoolGive(l->pool, &yield));
  PetscCall(SamPoolGive(l->pool, &gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells of a part of a jump. */
static PetscErrorCode Tell(SamLife l, const SamRate *rate, PetscReal cycles, const SamLoads load, Vec pressure,
                           const SamLoads to)
{
  const SamLifePartKind kind = to == l->whole  ? SAM_LIFE_WHOLE
                               : to == l->half ? SAM_LIFE_FIRST_HALF
                                               : SAM_LIFE_SECOND_HALF;
  const SamLifePart part = {kind, cycles, &rate->balance, rate->coefficient, rate->pressure, pressure, load[0], to[0]};

  PetscFunctionBegin;
  PetscCall(l->cycle.jumps(l->cycle.context, &part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the wear loads `to` after `cycles` more at a rate, from `load` on, and the mean pressure after them (Pa); of
  magnified cycles there is none.
*/
static PetscErrorCode Jump(SamLife l, const SamRate *rate, PetscReal cycles, const SamLoads load, SamLoads to,
                           Vec pressure, PetscBool *solved)
{
  PetscFunctionBegin;
  if (rate->passes) {
    PetscCall(SamLifeMagnify(l, rate, cycles, load, to, solved));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolvePressure(l, rate, cycles, load, pressure, solved));
  PetscCall(VecCopy(pressure, to[0]));
  if (l->band) PetscCall(SamLifeIntegrate(l->grid, to[0]));
  PetscCall(VecPointwiseMult(to[0], rate->coefficient, to[0]));
  PetscCall(VecAYPX(to[0], cycles, load[0]));
  if (*solved && l->cycle.jumps) PetscCall(Tell(l, rate, cycles, load, pressure, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the difference of two fields in a norm, relative to the second field, or to a larger size. */
static PetscErrorCode RelativeDifference(SamGrid grid, SamPool pool, Vec a, Vec b, NormType norm, PetscReal least,
                                         PetscReal *error)
{
  PetscReal difference, size;
  Vec       change;

  PetscFunctionBegin;
  PetscCall(SamPoolTake(pool, &change));
  PetscCall(VecWAXPY(change, -1, a, b));
  PetscCall(SamGridNorm(grid, change, norm, &difference));
  PetscCall(SamGridNorm(grid, b, norm, &size));
  PetscCall(SamPoolGive(pool, &change));
  size   = PetscMax(size, least);
  *error = size > 0 ? difference / size : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the sum of a wear load; interpolation may make it slightly negative in some cells. */
static PetscErrorCode Volume(SamGrid grid, Vec load, PetscReal *volume)
{
  PetscReal sums[3] = {0};

  PetscFunctionBegin;
  PetscCall(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, load, sums));
  *volume = sums[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Replaces `halves` by its extrapolation with `whole`. In cells where this is less than at the start, at the contact's
  edge, the load stays as at the start, and the others are reduced a little, so that the volume is the extrapolated one.
  If that volume would be less than at the start, the halves stay unchanged.
*/
PetscErrorCode SamLifeExtrapolate(SamGrid grid, Vec start, Vec whole, Vec halves)
{
  PetscReal before = 0, once = 0, twice = 0, after = 0, share;

  PetscFunctionBegin;
  PetscCall(Volume(grid, start, &before));
  PetscCall(Volume(grid, whole, &once));
  PetscCall(Volume(grid, halves, &twice));
  if (2 * twice - once < before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecAXPBY(halves, -1, 2, whole));
  PetscCall(VecPointwiseMax(halves, halves, start));
  PetscCall(Volume(grid, halves, &after));
  share = after > before ? (2 * twice - once - before) / (after - before) : 1;
  PetscCall(VecAXPBY(halves, 1 - share, share, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the depth worn per unit of a load: of body 1 or 2, or of both. */
static PetscReal CoefficientOf(SamLife l, PetscInt load)
{
  const PetscReal *k = ((const SamWear *)l->law->data)->coefficient;

  return l->loads > 1 ? k[load] : k[0] + k[1];
}

/* Returns the smallest depth that counts, far below the accuracy that the tolerances of the solvers allow. */
static PetscErrorCode LeastDepth(SamLife l, PetscReal *least)
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(SamGridNorm(l->grid, s->displacement_z, NORM_2, least));
  *least *= COUNTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the error of the depth, for the body with the larger one; then extrapolates the loads. */
static PetscErrorCode FinishJump(SamLife l, PetscReal least, PetscReal *error)
{
  PetscFunctionBegin;
  *error = 0;
  for (PetscInt k = 0; k < l->loads; k++) {
    const PetscReal unit = CoefficientOf(l, k);
    PetscReal       depth;

    if (unit == 0) continue; /* the bodies' surfaces do not wear */
    PetscCall(RelativeDifference(l->grid, l->pool, l->whole[k], l->halves[k], NORM_2, least / unit, &depth));
    *error = PetscMax(*error, depth);
  }
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(SamLifeExtrapolate(l->grid, l->load[k], l->whole[k], l->halves[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Makes a jump in halves after it has been made as a whole, which ends under the mean pressure `once` (Pa); `pressure`:
  the relative difference of the pressures at the end. The pressure after a half is needed only until the next one.
*/
static PetscErrorCode JumpHalves(SamLife l, PetscReal cycles, Vec once, PetscReal *pressure, PetscBool *solved)
{
  Vec twice; /* Pa */

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &twice));
  PetscCall(Jump(l, &l->start, 0.5 * cycles, l->load, l->half, twice, solved));
  PetscCall(SamPoolGive(l->pool, &twice));
  if (*solved) PetscCall(SamLifeSetLoads(l, l->half));
  if (*solved) PetscCall(SamLifeComputeRate(l, &l->middle, l->state.cycles + 0.5 * cycles, PETSC_FALSE, solved));
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamPoolTake(l->pool, &twice));
  PetscCall(Jump(l, &l->middle, 0.5 * cycles, l->half, l->halves, twice, solved));
  *pressure = l->apart;
  if (*solved && !l->set.magnified) PetscCall(RelativeDifference(l->grid, l->pool, once, twice, NORM_1, 0, pressure));
  PetscCall(SamPoolGive(l->pool, &twice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Makes a jump as a whole and in halves; l->halves becomes their extrapolation, which is nowhere less than at the start.
  The error is that of the depth (2-norm) and of the pressure at the end (1-norm), averaged over the scar: the edge of
  the stick zone, with the pressure's peak, moves by whole cells, so that single cells there change abruptly in a jump
  of any length.
*/
static PetscErrorCode TryJump(SamLife l, PetscReal cycles, PetscReal *error, PetscBool *solved)
{
  PetscReal depth, pressure = 0, least = 0;
  Vec       once;

  PetscFunctionBegin;
  PetscCall(LeastDepth(l, &least));
  PetscCall(SamPoolTake(l->pool, &once));
  PetscCall(Jump(l, &l->start, cycles, l->load, l->whole, once, solved));
  if (*solved) PetscCall(JumpHalves(l, cycles, once, &pressure, solved));
  PetscCall(SamPoolGive(l->pool, &once));
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FinishJump(l, least, &depth));
  *error = PetscMax(depth, pressure);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the size of jumps ---- */

/* Rounds to a whole number of cycles. */
static PetscReal Whole(PetscReal jump)
{
  return isfinite(jump) ? PetscMax(1, floor(jump)) : jump;
}

/*
  Returns the jump that is tried first. If it ends within rounding of `cycles`, it ends there: the sum of fixed jumps
  that are no integers has rounding errors.
*/
static PetscReal FirstTry(const SamLife l, PetscReal cycles)
{
  const PetscReal left = cycles - l->state.cycles;
  PetscReal       jump = l->state.next;

  if (jump == 0) jump = FIRST * l->start.limit;
  if (!l->set.fixed) jump = Whole(jump);
  return jump < left - SAME * jump ? jump : left;
}

/*
  Returns the next jump, after a jump with this ratio of its error to the allowed one. A jump that was short because no
  more cycles were requested does not limit later jumps.
*/
static PetscReal NextTry(const SamLife l, PetscReal jump, PetscReal error)
{
  const PetscReal most = PetscMax(GROW_MOST * jump, l->state.next), least = GROW_LEAST * jump,
                  next = PetscMax(least, PetscMin(most, jump * SAFETY / sqrt(PetscMax(error, 1e-300))));

  return Whole(next);
}

/* ---- the life ---- */

static PetscErrorCode Report(SamLife l, SamLifeReport *r)
{
  const SamSolution *s;

  PetscFunctionBegin;
  *r = (SamLifeReport){.cycles            = l->state.cycles,
                       .jump              = l->state.jump,
                       .error             = PetscMax(l->state.error, l->stripes_error),
                       .stripes           = l->stripes_error,
                       .stride            = l->stride,
                       .tip               = l->tip,
                       .flow              = l->flow,
                       .limit             = l->start.limit,
                       .dissipated_energy = l->energy,
                       .contact_area      = l->area,
                       .computed          = l->state.computed,
                       .at                = l->at,
                       .step              = l->step};
  PetscCall(SamWearGetVolumes(l->law, l->load[0], l->load[l->loads - 1], r->volume, r->depth));
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(VecMax(s->pressure, NULL, &r->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sums of the contact over its steps ---- */

/* Stores the wear load and the sums before a cycle. */
static PetscErrorCode Keep(SamLife l)
{
  SamLoads loads;

  PetscFunctionBegin;
  PetscCall(SamLifeGetLoads(l, loads));
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(VecCopy(loads[k], l->load[k]));
  for (PetscInt k = 0; k < SAM_LAWS; k++) {
    Vec sum;

    PetscCall(SamLifeGetSum(l, k, &sum));
    if (sum && !l->before[k]) PetscCall(SamGridCreateVec(l->grid, 1, &l->before[k]));
    if (sum) PetscCall(VecCopy(sum, l->before[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the sums after a jump from those of its middle cycle; without a jump, restores those before the cycle. */
static PetscErrorCode JumpSums(SamLife l, PetscReal cycles)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_LAWS; k++) {
    Vec sum;

    PetscCall(SamLifeGetSum(l, k, &sum));
    if (sum && cycles > 0) PetscCall(VecAYPX(sum, cycles, l->before[k]));
    if (sum && cycles == 0) PetscCall(VecCopy(l->before[k], sum));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- cycles and jumps ---- */

PetscErrorCode SamLifeCompute(SamLife l, SamLifeReport *report)
{
  PetscFunctionBegin;
  if (!l->known) PetscCall(Keep(l));
  if (!l->known) PetscCall(SamLifeComputeRate(l, &l->start, l->state.cycles, PETSC_TRUE, &l->known));
  PetscCall(Report(l, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeJump(SamLife l, PetscReal cycles, SamLifeReport *report)
{
  PetscReal error = 0, jump = 0, next;
  PetscBool solved = PETSC_FALSE, accepted = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCheck(l->known, l->grid->comm, PETSC_ERR_ORDER, "There is no computed cycle to jump from");
  next = FirstTry(l, cycles);
  if (!l->set.fixed) next = PetscMin(next, SamLifeMostCycles(l));
  PetscCall(SamLifeKeepStrain(l, &l->strain));
  if (l->state.next == 0) l->state.next = next;
  while (!accepted && next != jump) {
    jump = next;
    PetscCall(TryJump(l, jump, &error, &solved));
    accepted = solved && (l->set.fixed || jump <= 1 || error <= HALVES * l->set.rtol);
    if (!accepted) PetscCall(SamLifeRestoreStrain(l, &l->strain));
    next = solved ? NextTry(l, jump, error / (HALVES * l->set.rtol)) : PetscMin(jump, Whole(GROW_LEAST * jump));
  }
  PetscCall(JumpSums(l, accepted ? jump : 0));
  if (accepted) {
    for (PetscInt k = 0; k < l->loads; k++) PetscCall(VecCopy(l->halves[k], l->load[k]));
    if (!l->set.fixed) l->state.next = next;
    l->state.jump   = jump;
    l->state.error  = error;
    l->state.cycles = jump == cycles - l->state.cycles ? cycles : l->state.cycles + jump;
    l->known        = PETSC_FALSE;
  }
  PetscCall(SamLifeSetLoads(l, l->load));
  PetscCall(Report(l, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

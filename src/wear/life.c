/*
  Jumps over cycles.

  In a computed cycle a cell wears by the rate r, depth a cycle. With the pressure p where the cycle ends, r = e p; e is
  taken as constant in a jump over m cycles, and p as that at its end: p solves the normal problem on the gap
  h + m e p, which is linear in p. Where the surfaces do not touch at the end of the cycle, e is what the slip there
  would wear, k times its path: contact that grows wears at once.

  A jump of m and two of m/2 give depths w1 and w2. These are of first order; 2 w2 - w1 is of second, and |w2 - w1| the
  error of w2 (Hairer, Norsett and Wanner 1993, Solving Ordinary Differential Equations I, II.4 and II.9; backward
  Euler's extrapolation is L-stable).
*/
#include <petsam/life.h>
#include <petsam/normal.h>
#include <petsam/private/balanceimpl.h>
#include "wearimpl.h"
#include <math.h>

/* The next jump's size over the last one's: limits, and the part of what the error allows. */
#define GROW_MOST  2.5
#define GROW_LEAST 0.2
#define SAFETY     0.8
/* The error of the halves over that of their extrapolation, which is what counts; measured on a sphere (test_life). */
#define HALVES 3.0

struct _n_SamLife {
  SamWear      wear;
  SamLifeCycle cycle;
  PetscReal    rtol, jump, cycles;
  PetscInt     computed;
  PetscBool    known; /* the rate at the present gap has been computed */
  SamStep      step;
  PetscReal    energy; /* of the last cycle, J */
  Vec          rate;   /* e/K: wear load of a cycle per pressure, m or so */
  Vec          lift;   /* m, by the shear */
  Vec          whole, halves, half, p, other, diagonal, gap, kept;
};

PetscErrorCode SamLifeCreate(SamWear wear, const SamLifeCycle *cycle, PetscReal rtol, PetscReal jump, SamLife *life)
{
  SamLife l;
  Vec   **all;

  PetscFunctionBegin;
  PetscCall(PetscNew(&l));
  all = (Vec *[]){&l->rate,     &l->whole, &l->halves, &l->half, &l->p, &l->other,
                  &l->diagonal, &l->lift,  &l->gap,    &l->kept, NULL};
  for (int k = 0; all[k]; k++) PetscCall(SamGridCreateVec(wear->grid, 1, all[k]));
  l->wear  = wear;
  l->cycle = *cycle;
  l->rtol  = rtol;
  l->jump  = jump;
  *life    = l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeDestroy(SamLife *life)
{
  SamLife l = *life;
  Vec   **all;

  PetscFunctionBegin;
  *life = NULL;
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  all = (Vec *[]){&l->rate,     &l->whole, &l->halves, &l->half, &l->p, &l->other,
                  &l->diagonal, &l->lift,  &l->gap,    &l->kept, NULL};
  for (int k = 0; all[k]; k++) PetscCall(VecDestroy(all[k]));
  PetscCall(PetscFree(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a computed cycle ---- */

static PetscBool IsSolved(const SamStep *step)
{
  return step->status != SAM_STATUS_NOT_CONVERGED && step->status != SAM_STATUS_NO_EQUILIBRIUM ? PETSC_TRUE
                                                                                               : PETSC_FALSE;
}

/* What a unit of path wears in a cell without pressure, per pressure: 1, or the coefficient of friction. */
static PetscErrorCode GetUnit(SamLife l, Vec unit)
{
  PetscFunctionBegin;
  PetscCall(VecSet(unit, 1));
  if (l->wear->law == SAM_WEAR_ENERGY) PetscCall(SamProblemComputeBound(l->wear->problem, 1, unit, unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* e/K from the wear load and the path of the cycle, and the pressure at its end. */
static PetscErrorCode FindRate(SamLife l)
{
  const SamWear      w = l->wear;
  const SamSolution *s;
  const double      *p, *load, *path, *unit;
  double            *rate;

  PetscFunctionBegin;
  PetscCall(GetUnit(l, l->diagonal));
  PetscCall(SamContactGetSolution(w->contact, &s));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(w->cycle, &load));
  PetscCall(VecGetArrayRead(w->path, &path));
  PetscCall(VecGetArrayRead(l->diagonal, &unit));
  PetscCall(VecGetArrayWrite(l->rate, &rate));
  for (PetscInt k = 0; k < w->grid->cells; k++) rate[k] = p[k] > 0 ? load[k] / p[k] : unit[k] * path[k];
  PetscCall(VecRestoreArrayWrite(l->rate, &rate));
  PetscCall(VecRestoreArrayRead(l->diagonal, &unit));
  PetscCall(VecRestoreArrayRead(w->path, &path));
  PetscCall(VecRestoreArrayRead(w->cycle, &load));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the shear of dissimilar bodies lifts the surfaces by at the end of the cycle: a part of the gap in a jump. */
static PetscErrorCode FindLift(SamLife l)
{
  SamElasticity       elasticity;
  SamElasticityTraits traits;
  const SamSolution  *s;

  PetscFunctionBegin;
  PetscCall(SamProblemGetElasticity(l->wear->problem, &elasticity));
  PetscCall(SamElasticityGetTraits(elasticity, &traits));
  PetscCall(VecSet(l->lift, 0));
  if (!traits.coupled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSolution(l->wear->contact, &s));
  PetscCall(SamElasticityApplyNormal(elasticity, s->pressure, l->lift));
  PetscCall(VecAYPX(l->lift, -1, s->displacement_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the cycle on the problem's gap; `solved`: all of its steps have a solution. */
static PetscErrorCode ComputeCycle(SamLife l, PetscBool *solved)
{
  SamControl control;

  PetscFunctionBegin;
  PetscCall(VecSet(l->wear->cycle, 0));
  PetscCall(VecSet(l->wear->path, 0));
  l->energy = 0;
  *solved   = PETSC_TRUE;
  /* first the contact comes to rest on its new gap, where the cycle begins: the step before its first */
  for (PetscInt k = -1; k < l->cycle.steps && *solved; k++) {
    PetscCall(l->cycle.control(l->cycle.context, k < 0 ? l->cycle.steps - 1 : k, &control));
    PetscCall(SamContactTry(l->wear->contact, &control, &l->step));
    *solved = IsSolved(&l->step);
    if (!*solved) break;
    if (k >= 0) PetscCall(SamWearCountStep(l->wear));
    if (k >= 0) l->energy += l->step.dissipated_energy;
    PetscCall(SamContactCommit(l->wear->contact));
  }
  l->computed++;
  if (*solved) PetscCall(FindRate(l));
  if (*solved) PetscCall(FindLift(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- jumps ---- */

/*
  The wear load of `cycles` more, added to `load`, into `to`; and the pressure then. The wear load of the start decides
  the gap.
*/
static PetscErrorCode Jump(SamLife l, PetscReal cycles, Vec load, Vec to, Vec p, PetscBool *solved)
{
  const SamWear   w = l->wear;
  const PetscReal K = w->coefficient[0] + w->coefficient[1];
  SamControl      control;
  SamBalance      balance = {.kind = SAM_BALANCE_NORMAL};
  SamNormal       normal;
  SamSolverReason reason;
  Vec             gap;

  PetscFunctionBegin;
  PetscCall(l->cycle.control(l->cycle.context, l->cycle.steps - 1, &control));
  for (int k = 0; k < 3; k++) {
    const PetscInt c = SamComponentsOf[SAM_BALANCE_NORMAL][k];

    balance.force[k] = control.force[c];
    balance.load[k]  = control.force[c] ? control.value[c] : 0;
    balance.rigid[k] = control.force[c] ? 0 : control.value[c];
  }
  PetscCall(SamWearSetGap(w, load));
  PetscCall(SamProblemGetGap(w->problem, &gap));
  PetscCall(VecWAXPY(l->gap, 1, gap, l->lift));
  PetscCall(VecCopy(l->rate, l->diagonal));
  PetscCall(VecScale(l->diagonal, cycles * K));
  PetscCall(SamContactGetNormal(w->contact, &normal));
  PetscCall(SamNormalSolveYielding(normal, l->gap, l->diagonal, &balance, PETSC_FALSE, p));
  PetscCall(SamSolverGetReason(normal, &reason));
  *solved = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecPointwiseMult(to, l->rate, p));
  PetscCall(VecAYPX(to, cycles, load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest difference of two fields over the largest of the second. */
static PetscErrorCode RelativeDifference(SamLife l, Vec a, Vec b, PetscReal *error)
{
  PetscReal difference, most;

  PetscFunctionBegin;
  PetscCall(VecWAXPY(l->diagonal, -1, a, b));
  PetscCall(VecNorm(l->diagonal, NORM_INFINITY, &difference));
  PetscCall(VecNorm(b, NORM_INFINITY, &most));
  *error = most > 0 ? difference / most : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  l->halves becomes its extrapolation with l->whole. Where that is less than at the start, at the contact's edge,
  nothing is worn instead, and the rest a little less, so that the volume is the extrapolated one.
*/
static PetscErrorCode Extrapolate(SamLife l)
{
  const Vec start = l->wear->load;
  PetscReal before, whole, halves, after, share;

  PetscFunctionBegin;
  PetscCall(SamGridNorm(l->wear->grid, start, NORM_1, &before)); /* wear loads are never negative */
  PetscCall(SamGridNorm(l->wear->grid, l->whole, NORM_1, &whole));
  PetscCall(SamGridNorm(l->wear->grid, l->halves, NORM_1, &halves));
  PetscCall(VecAXPBY(l->halves, -1, 2, l->whole));
  PetscCall(VecPointwiseMax(l->halves, l->halves, start));
  PetscCall(SamGridNorm(l->wear->grid, l->halves, NORM_1, &after));
  share = after > before ? (2 * halves - whole - before) / (after - before) : 1;
  PetscCall(VecAXPBY(l->halves, 1 - share, share, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A jump as a whole and in halves; l->halves becomes their extrapolation, which is nowhere less than at the start. */
static PetscErrorCode TryJump(SamLife l, PetscReal cycles, PetscReal *error, PetscBool *solved)
{
  PetscFunctionBegin;
  PetscCall(Jump(l, cycles, l->wear->load, l->whole, l->p, solved));
  if (*solved) PetscCall(Jump(l, 0.5 * cycles, l->wear->load, l->half, l->other, solved));
  if (*solved) PetscCall(SamWearSetGap(l->wear, l->half));
  if (*solved) PetscCall(ComputeCycle(l, solved));
  if (*solved) PetscCall(Jump(l, 0.5 * cycles, l->half, l->halves, l->other, solved));
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RelativeDifference(l, l->whole, l->halves, error));
  PetscCall(Extrapolate(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Report(SamLife l, PetscReal jump, PetscReal error, SamLifeReport *r)
{
  const SamSolution *s;

  PetscFunctionBegin;
  *r = (SamLifeReport){.cycles            = l->cycles,
                       .jump              = jump,
                       .error             = error,
                       .dissipated_energy = l->energy,
                       .contact_area      = l->step.contact_area,
                       .computed          = l->computed,
                       .step              = l->step};
  PetscCall(SamWearGetVolumes(l->wear, r->volume, r->depth));
  PetscCall(SamContactGetSolution(l->wear->contact, &s));
  PetscCall(VecMax(s->pressure, NULL, &r->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeAdvance(SamLife l, PetscReal cycles, SamLifeReport *report)
{
  PetscReal error = 0, jump = PetscMin(l->jump, cycles - l->cycles);
  PetscBool solved = PETSC_TRUE, accepted = PETSC_FALSE;

  PetscFunctionBegin;
  if (!l->known) PetscCall(ComputeCycle(l, &solved));
  while (solved && !accepted) {
    const PetscReal limit = HALVES * l->rtol;

    PetscCall(VecCopy(l->rate, l->kept)); /* another try begins with the same rate */
    PetscCall(TryJump(l, jump, &error, &solved));
    PetscCall(VecCopy(l->kept, l->rate));
    accepted = solved && error <= limit ? PETSC_TRUE : PETSC_FALSE;
    l->jump  = jump * PetscMin(GROW_MOST, PetscMax(GROW_LEAST, SAFETY * sqrt(limit / PetscMax(error, 1e-300))));
    if (solved && !accepted) jump = PetscMin(l->jump, cycles - l->cycles);
  }
  if (accepted) {
    PetscCall(VecCopy(l->halves, l->wear->load));
    l->cycles += jump;
  }
  PetscCall(SamWearSetGap(l->wear, l->wear->load));
  if (accepted) PetscCall(ComputeCycle(l, &solved));
  l->known = solved;
  PetscCall(Report(l, jump, error, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

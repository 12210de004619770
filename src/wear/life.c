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
#include "wearimpl.h"
#include <math.h>

/* The next jump's size over the last one's: limits, and the part of what the error allows. */
#define GROW_MOST  2.5
#define GROW_LEAST 0.2
#define SAFETY     0.8
/* The error of the halves over that of their extrapolation, which is what counts; measured on a sphere (test_life). */
#define HALVES 3.0

/* What a computed cycle says of the next ones. */
typedef struct {
  Vec coefficient; /* e/K: wear load of a cycle per pressure, m */
  Vec lift;        /* what the shear of dissimilar bodies lifts the surfaces by at the cycle's end, m */
} Rate;

struct _n_SamLife {
  SamWear      wear;
  SamLifeCycle cycle;
  PetscReal    rtol, jump, cycles;
  PetscInt     computed;
  PetscBool    known; /* `start` has been computed */
  SamStep      step;
  PetscReal    energy;              /* of the last cycle, J */
  Rate         start, middle;       /* on the present gap; after half of the jump */
  Vec          whole, half, halves; /* wear loads: after the jump as a whole, after its first half, after both */
  Vec          p, diagonal, gap;    /* scratch */
};

/* The fields, to be created and destroyed. */
#define FIELDS(l) \
  { \
    &(l)->start.coefficient, &(l)->start.lift, &(l)->middle.coefficient, &(l)->middle.lift, &(l)->whole, &(l)->half, \
      &(l)->halves, &(l)->p, &(l)->diagonal, &(l)->gap, NULL \
  }

PetscErrorCode SamLifeCreate(SamWear wear, const SamLifeCycle *cycle, PetscReal rtol, PetscReal jump, SamLife *life)
{
  SamLife l;

  PetscFunctionBegin;
  PetscCall(PetscNew(&l));
  for (Vec **field = (Vec *[])FIELDS(l); *field; field++) PetscCall(SamGridCreateVec(wear->grid, 1, *field));
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

  PetscFunctionBegin;
  *life = NULL;
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  for (Vec **field = (Vec *[])FIELDS(l); *field; field++) PetscCall(VecDestroy(*field));
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
static PetscErrorCode FindCoefficient(SamLife l, Vec coefficient)
{
  const SamWear      w = l->wear;
  const SamSolution *s;
  const double      *p, *load, *path, *unit;
  double            *to;

  PetscFunctionBegin;
  PetscCall(GetUnit(l, l->diagonal));
  PetscCall(SamContactGetSolution(w->contact, &s));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(w->cycle, &load));
  PetscCall(VecGetArrayRead(w->path, &path));
  PetscCall(VecGetArrayRead(l->diagonal, &unit));
  PetscCall(VecGetArrayWrite(coefficient, &to));
  for (PetscInt k = 0; k < w->grid->cells; k++) to[k] = p[k] > 0 ? load[k] / p[k] : unit[k] * path[k];
  PetscCall(VecRestoreArrayWrite(coefficient, &to));
  PetscCall(VecRestoreArrayRead(l->diagonal, &unit));
  PetscCall(VecRestoreArrayRead(w->path, &path));
  PetscCall(VecRestoreArrayRead(w->cycle, &load));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lift, which is a part of the gap in a jump. */
static PetscErrorCode FindLift(SamLife l, Vec lift)
{
  SamElasticity       elasticity;
  SamElasticityTraits traits;
  const SamSolution  *s;

  PetscFunctionBegin;
  PetscCall(SamProblemGetElasticity(l->wear->problem, &elasticity));
  PetscCall(SamElasticityGetTraits(elasticity, &traits));
  PetscCall(VecSet(lift, 0));
  if (!traits.coupled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSolution(l->wear->contact, &s));
  PetscCall(SamElasticityApplyNormal(elasticity, s->pressure, lift));
  PetscCall(VecAYPX(lift, -1, s->displacement_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the cycle on the problem's gap; `solved`: all of its steps have a solution. */
static PetscErrorCode ComputeCycle(SamLife l, Rate *rate, PetscBool *solved)
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
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindCoefficient(l, rate->coefficient));
  PetscCall(FindLift(l, rate->lift));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- jumps ---- */

/* A jump that cannot be made fails as a step does. */
static PetscErrorCode FailJump(SamLife l, PetscReal cycles, SamSolverReason reason)
{
  PetscFunctionBegin;
  l->step.status = SAM_STATUS_NOT_CONVERGED;
  PetscCall(PetscSNPrintf(l->step.message, sizeof(l->step.message),
                          "the normal problem of a jump over %g cycles did not converge: %s", (double)cycles,
                          SamSolverReasonName(reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The wear load after `cycles` more at a rate, from `load` on, which decides the gap, into `to`. */
static PetscErrorCode Jump(SamLife l, const Rate *rate, PetscReal cycles, Vec load, Vec to, PetscBool *solved)
{
  const SamWear   w = l->wear;
  const PetscReal K = w->coefficient[0] + w->coefficient[1];
  SamControl      control;
  SamBalance      balance;
  SamNormal       normal;
  SamSolverReason reason;
  Vec             gap;

  PetscFunctionBegin;
  PetscCall(l->cycle.control(l->cycle.context, l->cycle.steps - 1, &control));
  balance = SamControlGetBalance(&control, SAM_BALANCE_NORMAL);
  PetscCall(SamWearSetGap(w, load));
  PetscCall(SamProblemGetGap(w->problem, &gap));
  PetscCall(VecWAXPY(l->gap, 1, gap, rate->lift));
  PetscCall(VecCopy(rate->coefficient, l->diagonal));
  PetscCall(VecScale(l->diagonal, cycles * K));
  PetscCall(SamContactGetNormal(w->contact, &normal));
  PetscCall(SamNormalSolveYielding(normal, l->gap, l->diagonal, &balance, PETSC_FALSE, l->p));
  PetscCall(SamSolverGetReason(normal, &reason));
  *solved = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*solved) PetscCall(FailJump(l, cycles, reason));
  PetscCall(VecPointwiseMult(to, rate->coefficient, l->p));
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
  PetscCall(Jump(l, &l->start, cycles, l->wear->load, l->whole, solved));
  if (*solved) PetscCall(Jump(l, &l->start, 0.5 * cycles, l->wear->load, l->half, solved));
  if (*solved) PetscCall(SamWearSetGap(l->wear, l->half));
  if (*solved) PetscCall(ComputeCycle(l, &l->middle, solved));
  if (*solved) PetscCall(Jump(l, &l->middle, 0.5 * cycles, l->half, l->halves, solved));
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
  if (!l->known) PetscCall(ComputeCycle(l, &l->start, &solved));
  while (solved && !accepted) {
    const PetscReal limit = HALVES * l->rtol;

    PetscCall(TryJump(l, jump, &error, &solved));
    accepted = solved && error <= limit ? PETSC_TRUE : PETSC_FALSE;
    l->jump  = jump * PetscMin(GROW_MOST, PetscMax(GROW_LEAST, SAFETY * sqrt(limit / PetscMax(error, 1e-300))));
    if (solved && !accepted) jump = PetscMin(l->jump, cycles - l->cycles);
  }
  if (accepted) {
    PetscCall(VecCopy(l->halves, l->wear->load));
    l->cycles += jump;
  }
  PetscCall(SamWearSetGap(l->wear, l->wear->load));
  if (accepted) PetscCall(ComputeCycle(l, &l->start, &solved));
  l->known = solved;
  PetscCall(Report(l, jump, error, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The solution of one load step: the separation that all laws add to, the normal problem, the bound of the shear, the
  tangential problem. Then the contact has the solution checked, and lets the laws advance their tried state.

  Similar materials: the pressure does not depend on the shear, so the normal and then the tangential problem solve the
  step. Dissimilar materials: see coupling.c.
*/
#include "stepimpl.h"
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/check.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>

/* Relative difference of the field `aside` from that of the solution below which it is left as it is */
#define SAME_ASIDE 0.05
/* Tolerance of the shear from which on the field `aside` is that of the solution, and most passes to find it: at larger
   ones it is one of second order (direction.c) */
#define TIGHT   1e-8
#define SETTLES 60

static PetscErrorCode Begin(SamContact c, SamStep *step, SamSolve *w)
{
  PetscFunctionBegin;
  *w                  = (SamSolve){.contact    = c,
                                   .grid       = c->grid,
                                   .elasticity = c->elasticity,
                                   .solver     = c->normal,
                                   .before     = c->tried.before,
                                   .s          = &c->generation[SAM_TRIED],
                                   .step       = step,
                                   .kept       = c->tried.start.kept,
                                   .monitor    = c->set.coupling_monitor};
  w->has_pressure     = w->contact->tried.start.pressure;
  w->has_shear        = w->contact->tried.start.shear;
  w->counts           = SamStateNumbers(w->contact->state, w->contact->counts, SAM_TRIED);
  w->normal           = SamControlGetBalance(&w->s->control, SAM_BALANCE_NORMAL);
  w->tangential       = SamControlGetBalance(&w->s->control, SAM_BALANCE_TANGENTIAL);
  w->tangential.ahead = SamElasticitySpinAhead(w->elasticity);
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt n = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];

    if (w->s->control.creep[n] && w->contact->motion->continues)
      w->tangential.rigid[k] = (w->before ? w->before->rigid[n] : 0) + w->s->rolled * w->s->control.value[n];
  }
  PetscCall(PetscArraycpy(w->rigid, w->contact->tried.start.rigid, 3));
  PetscCall(SamSolutionCreateSeparation(w->contact->problem, w->contact->state, SAM_COMMITTED, &w->separation));
  if (SamContactIsCoupled(w->contact)) PetscCall(SamGridCreateVec(w->grid, 2, &w->shear_product.field));
  if (SamContactIsCoupled(w->contact) || w->s->tension || SamProblemDisplaces(w->contact->problem))
    PetscCall(SamGridCreateVec(w->grid, 1, &w->h));
  if (SamContactIsCoupled(w->contact) || SamProblemDisplaces(w->contact->problem))
    PetscCall(SamGridCreateVec(w->grid, 2, &w->pushed));
  if (w->s->tension && !w->contact->tried.same_pressure) {
    PetscCall(SamGridCreateVec(w->grid, 1, &w->pulled));
    PetscCall(SamElasticityApplyNormal(w->elasticity, w->s->tension, w->pulled));
    PetscCall(SamSolveBearTension(w));
  }
  if (!SamContactIsCoupled(w->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(w->grid, 1, &w->lift));
  if (SamRuleTouches(w->s->rule)) PetscCall(SamSolveBeginTouching(w));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->pressure_product.field));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->previous_pressure));
  PetscCall(SamGridCreateVec(w->grid, 2, &w->previous_shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode End(SamSolve *w)
{
  PetscFunctionBegin;
  PetscCall(SamSolutionDestroySeparation(w->contact->problem, &w->separation));
  PetscCall(VecDestroy(&w->slip));
  PetscCall(VecDestroy(&w->pulled));
  PetscCall(VecDestroy(&w->pushed));
  PetscCall(VecDestroy(&w->lift));
  PetscCall(VecDestroy(&w->touching));
  PetscCall(VecDestroy(&w->h));
  PetscCall(VecDestroy(&w->pressure_product.field));
  PetscCall(VecDestroy(&w->shear_product.field));
  PetscCall(VecDestroy(&w->previous_pressure));
  PetscCall(VecDestroy(&w->previous_shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the field `aside` by the shear so far, unless it is nearly that field; `same`: it is. */
static PetscErrorCode CompareAside(SamSolve *w, PetscBool *same)
{
  const SamGrid grid = w->grid;
  PetscReal     size, change;
  Vec           used;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 2, &used));
  PetscCall(VecCopy(w->s->aside, used));
  PetscCall(SamSolveSetAside(w, SAM_ASIDE_SOLVED));
  PetscCall(SamGridNorm(grid, w->s->aside, NORM_2, &size));
  PetscCall(VecAXPY(w->s->aside, -1, used));
  PetscCall(SamGridNorm(grid, w->s->aside, NORM_2, &change));
  *same = change <= SAME_ASIDE * size ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(*same ? VecCopy(used, w->s->aside) : VecAXPY(w->s->aside, 1, used));
  PetscCall(VecDestroy(&used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves the tangential problem under a bound from the pressure, twice if necessary, unless the normal problem failed.
  A step that repeats one of the cycle before begins with the field `aside` of that step; if this is nearly that of the
  solution, once is enough.
*/
static PetscErrorCode SolveShear(SamSolve *w)
{
  const PetscBool     twice  = SamSolveIsTwice(w);
  const SamCachedStep kept   = w->kept;
  const PetscBool     again  = twice && SamSolveTurns(w) && SamCachedStepHasTurn(kept);
  const PetscBool     steady = again && SamCachedStepIsRepeated(kept);
  PetscBool           same   = PETSC_FALSE;
  SamSolverReason     reason = SAM_SOLVER_CONVERGED_RTOL;
  PetscReal           rtol;

  PetscFunctionBegin;
  PetscCall(SamSolveBound(w, w->s->bound));
  w->counts[SAM_COUNT_COUPLING] = 1;
  if (w->step->status != SAM_STATUS_CONVERGED) {
    PetscCall(SamSolveZeroShear(w));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamSolverGetTolerances(SamTangentialAsSolver(w->contact->tangential), &rtol, NULL));
  PetscCall(SamSolveSetAside(w, again ? SAM_ASIDE_KEPT : SAM_ASIDE_PREDICTED));
  if (twice) {
    const PetscReal first = steady ? rtol : SAM_ROUGH * rtol;

    if (!w->shear_product.field) PetscCall(SamGridCreateVec(w->grid, 2, &w->shear_product.field));
    SamSolverSetEffort(SamTangentialAsSolver(w->contact->tangential), first, SAM_EFFORT_FULL);
    PetscCall(SamSolveShear(w, first, SAM_EFFORT_FULL));
    reason = SamSolverGetReason(SamTangentialAsSolver(w->contact->tangential));
    if (reason > 0 && steady) PetscCall(CompareAside(w, &same));
    if (reason > 0 && !steady) PetscCall(SamSolveSetAside(w, SAM_ASIDE_SOLVED));
    if (!again) w->kept = kept; /* it is nearer than the solution so far if the cycle repeats itself */
  }
  if (reason > 0 && !same) PetscCall(SamSolveShear(w, rtol, SAM_EFFORT_FULL));
  PetscCall(SamSolveJudge(w, SAM_BALANCE_TANGENTIAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves both problems, with the offsets of the tried state. */
static PetscErrorCode SolveProblems(SamSolve *w)
{
  PetscBool friction;

  PetscFunctionBegin;
  PetscCall(SamProblemHasFriction(w->contact->problem, &friction));
  if (SamContactIsCoupled(w->contact) && friction) {
    PetscCall(SamSolveCoupled(w));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (SamContactIsCoupled(w->contact)) {
    PetscCall(VecSet(w->h, 0));
    w->kept = NULL;
  }
  PetscCall(SamSolveBegun(w));
  if (!w->contact->tried.known_pressure) PetscCall(SamSolveJudge(w, SAM_BALANCE_NORMAL));
  PetscCall(SolveShear(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves both problems again, from the last tractions. */
static PetscErrorCode SolveAgain(SamSolve *w)
{
  PetscFunctionBegin;
  SamSolveStartFromLast(w);
  PetscCall(SolveProblems(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes that settle the field `aside` */
typedef struct {
  SamSolve *w;
  Vec       argument;
  PetscReal rtol, unit; /* displacement of a cell by a shear of 1 Pa, m */
} Settling;

/* Solves with the field `aside` that is the argument, and computes the one by this solution. The first solution is
   there. */
static PetscErrorCode SettlePass(void *context, PetscInt pass, Vec result, SamPassEnd *end)
{
  const Settling *p = (Settling *)context;
  SamSolve *const w = p->w;
  PetscReal       change;

  PetscFunctionBegin;
  PetscCall(VecCopy(p->argument, w->s->aside));
  w->holds = PETSC_TRUE;
  if (pass > 1) PetscCall(SamContactIsCoupled(w->contact) ? SolveAgain(w) : SolveShear(w));
  w->holds = PETSC_FALSE;
  *end     = SAM_PASS_FAILED;
  if (w->step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolveSetAside(w, SAM_ASIDE_SOLVED));
  PetscCall(VecCopy(w->s->aside, result));
  PetscCall(VecCopy(p->argument, w->s->aside));
  PetscCall(SamSolveGetChange(w, p->argument, result, p->unit, &change, NULL));
  *end = change <= p->rtol ? SAM_PASS_SOLVED : SAM_PASS_GOES_ON;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Repeats the tangential problem until the field `aside` is that of its solution, if the tolerance is tight or that is
   wanted. */
static PetscErrorCode Settle(SamSolve *w)
{
  static const SamFixedPoint iteration = {.components = 2, .most = SETTLES, .pass = SettlePass};
  Settling                   p         = {.w = w};
  SamPassEnd                 end;
  PetscReal                  normal;

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(SamTangentialAsSolver(w->contact->tangential), &p.rtol, NULL));
  if ((p.rtol > TIGHT && !w->contact->settles) || w->touching || !w->s->aside || !SamSolveSetsAside(w))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (w->step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityGetSelfInfluence(w->elasticity, &normal, &p.unit));
  PetscCall(VecDuplicate(w->s->aside, &p.argument));
  PetscCall(VecCopy(w->s->aside, p.argument));
  PetscCall(SamSolveFixedPoint(w, &iteration, &p, p.argument, &end));
  PetscCall(VecDestroy(&p.argument));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the slip, or the frictional power, of the solution, for a law that uses it. */
static PetscErrorCode FindSlip(SamSolve *w, SamLaw law, SamLawContact *contact)
{

  PetscFunctionBegin;
  if (!contact->solved || !(law->uses[SAM_USE_PATH] || law->uses[SAM_USE_POWER])) PetscFunctionReturn(PETSC_SUCCESS);
  if (!contact->slip) PetscCall(SamGridCreateVec(w->grid, 1, &contact->slip));
  PetscCall(SamSolveDisplace(w));
  if (law->uses[SAM_USE_POWER])
    PetscCall(SamSolutionComputeRolling(w->contact->problem, w->s, PETSC_FALSE, contact->slip));
  else
    PetscCall(SamSolutionComputeFriction(w->contact->problem, w->before, w->s, contact->slip, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Asks a law for its next state, with the solution that there is; `again`: it has one. */
static PetscErrorCode AskLaw(SamSolve *w, SamLaw law, SamLawContact *contact, PetscBool *again)
{
  PetscFunctionBegin;
  *again          = PETSC_FALSE;
  contact->solved = w->step->status == SAM_STATUS_CONVERGED ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(FindSlip(w, law, contact));
  PetscCall(law->ops.follow(law, contact, again));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves again with a law's next state, until it has no other, while the field `aside` is one that a solution gives. */
static PetscErrorCode FollowHolding(SamSolve *w, SamLaw law, SamLawContact *contact, SamAsideFrom aside)
{
  PetscBool again = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamSolveSetAside(w, aside));
  w->holds = PETSC_TRUE;
  while (again) {
    PetscCall(SolveAgain(w));
    PetscCall(AskLaw(w, law, contact, &again));
  }
  w->holds = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a law's state and the tractions together, with the field `aside` that is predicted, and then with that of the
   solution. */
static PetscErrorCode Follow(SamSolve *w, SamLaw law, SamLawContact *contact)
{
  PetscBool again;

  PetscFunctionBegin;
  PetscCall(AskLaw(w, law, contact, &again));
  if (!again) PetscFunctionReturn(PETSC_SUCCESS); /* the state before the step stands */
  PetscCall(FollowHolding(w, law, contact, SAM_ASIDE_PREDICTED));
  if (w->step->status != SAM_STATUS_CONVERGED || contact->failed[0] || !SamSolveSetsAside(w))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (w->touching) PetscCall(SamSolveFindTouching(w, w->touching));
  PetscCall(AskLaw(w, law, contact, &again));
  PetscCall(FollowHolding(w, law, contact, SAM_ASIDE_SOLVED));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves for the tractions together with the state of a law that depends on the tractions. Where the slip begins and its
  direction follow from a solution: they stay while the law solves, so that the tractions depend on its state alone, and
  are found again from what it has found.
*/
static PetscErrorCode FollowTractions(SamSolve *w)
{
  SamLawContact contact = {.state      = w->contact->state,
                           .normal     = &w->normal,
                           .tangential = &w->tangential,
                           .pressure   = w->s->pressure,
                           .shear      = w->s->shear,
                           .bound      = w->s->bound};
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(w->contact->problem, &count, &laws));
  for (PetscInt k = 0; k < count && w->step->status != SAM_STATUS_NO_EQUILIBRIUM; k++)
    if (laws[k]->ops.follow) PetscCall(Follow(w, laws[k], &contact));
  PetscCall(VecDestroy(&contact.slip));
  if (contact.failed[0]) PetscCall(SamStepFail(w->step, SAM_STATUS_NOT_CONVERGED, contact.failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepSolve(SamContact c, SamStep *step)
{
  SamSolve w;

  PetscFunctionBegin;
  PetscCall(Begin(c, step, &w));
  PetscCall(SolveProblems(&w));
  PetscCall(Settle(&w));
  PetscCall(FollowTractions(&w));
  if (w.touching && w.s->aside) PetscCall(SamSolveEndTouching(&w));
  if (c->motion->streams) PetscCall(SamSolveRolling(&w));
  if (c->traits.skewed && w.step->status == SAM_STATUS_CONVERGED && w.s->load[SAM_COMPONENT_N] > 0)
    PetscCall(SamSolveResistance(&w));
  PetscCall(End(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

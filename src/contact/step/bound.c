/*
  The shear under a bound that depends on the slip of the step, for example if friction changes with slip.

  The slip s depends on the bound b through the tangential problem, and the bound on the slip: b = B(p, |s(b)|).
  Algorithm. The first bound is that without slip, or, for dissimilar bodies, that of the last pass. A pass:
    1. The tangential problem with b, from the last shear on, gives q and s.
    2. If B(p, |s|) equals b within a part of the tolerance, the step is solved.
    3. Else Anderson's method makes the next b of this and the last passes (fixedpoint.c). If this bound cannot carry
       the loads, the next b is B(p, |s|) itself.
  Passes without acceleration multiply the error by dB/ds times the displacement of the slip zone by a unit shear.
  Where friction falls faster than the bodies unload, the motion is unstable: the surfaces jump, and there need not be a
  solution nearby.

  A bound that does not depend on the slip takes one pass.
*/
#include "stepimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/check.h>
#include <petsam/private/problem.h>

#define PASSES 50
/* Parts of the tolerance for the bound and for the tangential problem of a pass; the check adds both errors. */
#define BOUND_PART 0.3
#define SHEAR_PART 0.5

PetscErrorCode SamSolveBound(SamSolve *w, Vec bound)
{
  const SamBoundAt at = {w->contact->state, &w->s->control, w->s->pressure, w->slip, w->s->rolled};

  PetscFunctionBegin;
  PetscCall(SamProblemComputeBound(w->contact->problem, &at, &(SamBound){.value = bound}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the length of the slip of the step, by the shear and the rigid displacements. */
static PetscErrorCode ComputeSlip(SamSolve *w)
{
  PetscFunctionBegin;
  if (!w->slip) PetscCall(SamGridCreateVec(w->grid, 1, &w->slip));
  PetscCall(SamSolveDisplace(w));
  PetscCall(SamSolutionComputeFriction(w->contact->problem, w->before, w->s, w->slip, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  SamSolve *w;
  PetscBool mixed;        /* the argument combines results that had a solution */
  PetscReal rtol, change; /* the largest and the last change of the bound */
} Passes;

/*
  Steps 1 and 2: B(p, |s|), and its difference from the bound. A tangential problem without a solution ends the passes;
  the caller handles it.
*/
static PetscErrorCode Pass(void *context, PetscInt pass, Vec found, SamPassEnd *end)
{
  Passes *const   p = (Passes *)context;
  SamSolve *const w = p->w;
  PetscReal       most[2];

  PetscFunctionBegin;
  (void)pass;
  PetscCall(SamSolveTangential(w));
  if (SamSolverGetReason(SamTangentialAsSolver(w->contact->tangential)) < 0) {
    *end     = p->mixed ? SAM_PASS_RESTARTS : SAM_PASS_FAILED;
    p->mixed = PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ComputeSlip(w));
  PetscCall(SamSolveBound(w, found));
  PetscCall(SamSolveGetChange(w, w->s->bound, found, 1, &p->change, &most[0]));
  PetscCall(VecMax(w->s->bound, NULL, &most[1]));
  if (p->change > 0) p->change = PetscMax(p->change, most[0] / most[1]);
  if (p->change <= p->rtol) *end = SAM_PASS_SOLVED;
  p->mixed = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fail(SamSolve *w, PetscReal change)
{
  const SamLaw *laws;
  PetscInt      count, k = 0;
  char          message[sizeof(w->step->message)];

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(w->contact->problem, &count, &laws));
  while (k < count - 1 && !laws[k]->follows_slip) k++;
  PetscCall(PetscSNPrintf(message, sizeof(message),
                          "the friction of the law %s did not converge with the slip within %d iterations, the last "
                          "relative change is %.2g: %s",
                          laws[k]->type, PASSES, (double)change, w->contact->motion->remedy));
  PetscCall(SamStepFail(w->step, SAM_STATUS_NOT_CONVERGED, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveShear(SamSolve *w, PetscReal rtol, SamEffort effort)
{
  static const SamFixedPoint bound  = {.components = 1, .most = PASSES, .nonnegative = PETSC_TRUE, .pass = Pass};
  const SamSolver            solver = SamTangentialAsSolver(w->contact->tangential);
  Passes                     p      = {.w = w, .rtol = BOUND_PART * rtol};
  SamPassEnd                 end;
  Vec                        total;

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateTotal(w->contact->problem, w->s, &total));
  if (SamContactIsCoupled(w->contact)) PetscCall(SamElasticityApplyNormalToTangential(w->elasticity, total, w->pushed));
  PetscCall(SamSolutionDestroyTotal(w->s, &total));
  if (w->pushed && !SamContactIsCoupled(w->contact)) PetscCall(VecSet(w->pushed, 0));
  if (w->pushed)
    PetscCall(SamProblemDisplace(w->contact->problem, w->contact->state, &w->s->control, NULL, w->pushed, NULL, NULL));
  if (!SamProblemFollowsSlip(w->contact->problem)) {
    PetscCall(SamSolveTangential(w)); /* with the effort set by the caller */
    SamSolverSetEffort(solver, 0, SAM_EFFORT_FULL);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SamSolverSetEffort(solver, SHEAR_PART * rtol, effort);
  PetscCall(SamSolveFixedPoint(w, &bound, &p, w->s->bound, &end));
  if (end == SAM_PASS_GOES_ON) PetscCall(Fail(w, p.change));
  SamSolverSetEffort(solver, 0, SAM_EFFORT_FULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

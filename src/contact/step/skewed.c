/*
  The normal problem of bodies whose operator C is not symmetric, as material that relaxes streams through the contact.

  The solvers need a symmetric operator M (SamElasticityGetSymmetric()). With it the problem is one of

      gap = h + (C - M) p + M p - rigid,

  and is solved by passes p <- P(p), each the solution with the separation h + (C - M) p by the pressure p of the last
  one. For waves C is J(k) times the operator of bodies without creep, with |J|^2 <= J(0) Re J, and M is a number times
  it that is larger than J(0)/2: so in the norm of M passes multiply errors by |1 - C/M| < 1. Anderson's method
  accelerates them (fixedpoint.c).
*/
#include "stepimpl.h"
#include <petsam/private/check.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/solver.h>

#define PASSES 1000
#define PART   0.4 /* of the tolerance: largest error of a pass's solution, and of the last pass */

typedef struct {
  SamSolve     *w;
  SamElasticity symmetric;
  PetscReal     rtol;  /* relative to the displacement by C */
  PetscReal     error; /* of the gap after a pass, likewise */
  Vec           argument, h, moved, other, change;
} Passes;

/* Computes (C - M) p, and the largest displacements by both. */
static PetscErrorCode ApplyDifference(Passes *p, Vec pressure, Vec out, PetscReal most[2])
{
  PetscFunctionBegin;
  PetscCall(SamElasticityApplyNormal(p->w->elasticity, pressure, out));
  PetscCall(SamElasticityApplyNormal(p->symmetric, pressure, p->other));
  PetscCall(VecNorm(out, NORM_INFINITY, &most[0]));
  PetscCall(VecNorm(p->other, NORM_INFINITY, &most[1]));
  PetscCall(VecAXPY(out, -1, p->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pass(void *context, PetscInt pass, Vec result, SamPassEnd *end)
{
  Passes *const   p      = (Passes *)context;
  SamSolve *const w      = p->w;
  const SamSolver solver = SamNormalAsSolver(w->solver);
  PetscReal       most[2], unused[2], wrong;

  PetscFunctionBegin;
  PetscCall(ApplyDifference(p, p->argument, p->moved, most));
  PetscCall(
    SamSolverSetTolerances(solver, PART * p->rtol * (most[0] > 0 ? PetscMin(1, most[0] / most[1]) : 1), PETSC_DEFAULT));
  PetscCall(VecAXPY(p->moved, 1, p->h));
  PetscCall(SamSolvePressureOnce(w, p->moved));
  *end = SAM_PASS_FAILED;
  if (SamSolverGetReason(solver) < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(w->s->pressure, result));
  PetscCall(VecWAXPY(p->change, -1, p->argument, result));
  PetscCall(ApplyDifference(p, p->change, p->moved, unused));
  PetscCall(VecNorm(p->moved, NORM_INFINITY, &wrong));
  p->error = wrong > 0 ? wrong / PetscMax(most[0], wrong) : 0;
  if (w->monitor)
    PetscCall(PetscPrintf(w->grid->comm, "%5" PetscInt_FMT " creep gap error %.6e\n", pass, (double)p->error));
  *end = p->error <= PART * p->rtol ? SAM_PASS_SOLVED : SAM_PASS_GOES_ON;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fail(SamSolve *w, PetscReal error)
{
  char message[sizeof(w->step->message)];

  PetscFunctionBegin;
  (void)snprintf(message, sizeof(message),
                 "the pressure did not converge with the creep of the streaming material in %d passes, gap error %.2g: "
                 "raise -normal_rtol, or roll in steps of time",
                 PASSES, (double)error);
  PetscCall(SamStepFail(w->step, SAM_STATUS_NOT_CONVERGED, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveSkewed(SamSolve *w, Vec h)
{
  static const SamFixedPoint iteration = {.components = 1, .most = PASSES, .nonnegative = PETSC_TRUE, .pass = Pass};
  Passes                     p         = {.w = w, .h = h};
  Vec *const                 created[] = {&p.argument, &p.moved, &p.other, &p.change};
  const SamSolver            solver    = SamNormalAsSolver(w->solver);
  SamPassEnd                 end;

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(solver, &p.rtol, NULL));
  PetscCall(SamElasticityGetSymmetric(w->elasticity, &p.symmetric));
  for (int k = 0; k < 4; k++) PetscCall(SamGridCreateVec(w->grid, 1, created[k]));
  if (w->has_pressure) PetscCall(VecCopy(w->s->pressure, p.argument));
  PetscCall(SamSolveFixedPoint(w, &iteration, &p, p.argument, &end));
  PetscCall(SamSolverSetTolerances(solver, p.rtol, PETSC_DEFAULT));
  if (end == SAM_PASS_GOES_ON) PetscCall(Fail(w, p.error));
  for (int k = 0; k < 4; k++) PetscCall(VecDestroy(created[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

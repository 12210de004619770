/*
  The shear under a bound that follows the slip of the step, as of friction that changes with slip.

  The slip s depends on the bound b through the tangential problem, and the bound on the slip: b = B(p, |s(b)|).
  Algorithm, from the bound without slip on, or by that of the last pass of dissimilar bodies; a pass:
    1. The tangential problem with b, from the last shear on, gives q and s.
    2. If B(p, |s|) is b, up to a part of the tolerance, the step is solved.
    3. Else Anderson's method makes the next b of this and the last passes (mixing.c). Where the loads are too much for
       that, the next b is B(p, |s|) itself.
  Passes without acceleration multiply the error by dB/ds times the displacement of the slip zone by a unit shear.
  Where friction falls faster than the bodies unload, the motion is unstable: the surfaces jump, and there need not be a
  solution nearby.

  A bound that does not follow the slip takes one pass.
*/
#include "stepimpl.h"

#define PASSES 50
/* Parts of the tolerance to which the bound, and the tangential problem of a pass, are solved: the check adds both. */
#define BOUND_PART 0.3
#define SHEAR_PART 0.5

PetscErrorCode SamSolveBound(SamSolve *w, Vec bound)
{
  const SamBoundAt at = {w->c->state, w->s->control.friction_scale, w->s->pressure, w->slip,
                         SamControlRolled(&w->s->control)};

  PetscFunctionBegin;
  PetscCall(SamProblemComputeBound(w->c->problem, &at, &(SamBound){.value = bound}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The length of the slip of the step, by the shear and the rigid displacements. */
static PetscErrorCode ComputeSlip(SamSolve *w)
{
  PetscFunctionBegin;
  if (!w->slip) PetscCall(SamGridCreateVec(w->c->grid, 1, &w->slip));
  PetscCall(SamSolveDisplace(w));
  PetscCall(SamSolutionComputeFriction(w->c->problem, w->before, w->s, w->slip, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 2: B(p, |s|), and its difference from the bound, relative to what the check compares it with. */
static PetscErrorCode Measure(SamSolve *w, Vec found, PetscReal *change)
{
  const SamGrid grid = w->c->grid;
  PetscReal     size, most[2], shear, bound;
  Vec           difference;

  PetscFunctionBegin;
  PetscCall(ComputeSlip(w));
  PetscCall(SamSolveBound(w, found));
  PetscCall(SamGridCreateVec(grid, 1, &difference));
  PetscCall(VecWAXPY(difference, -1, w->s->bound, found));
  PetscCall(SamGridNorm(grid, difference, NORM_2, &size));
  PetscCall(VecNorm(difference, NORM_INFINITY, &most[0]));
  PetscCall(SamGridNorm(grid, w->s->shear, NORM_2, &shear));
  PetscCall(SamGridNorm(grid, w->s->bound, NORM_2, &bound));
  PetscCall(VecMax(w->s->bound, NULL, &most[1]));
  *change = size > 0 ? PetscMax(size / PetscMax(shear, SAM_SHEAR_FLOOR * bound), most[0] / most[1]) : 0;
  PetscCall(VecDestroy(&difference));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 3. A bound is not negative. */
static PetscErrorCode Next(SamSolve *w, SamMixing *mixing, Vec found)
{
  double *b;

  PetscFunctionBegin;
  PetscCall(SamMixingNext(mixing, w->s->pressure, found, w->s->bound));
  PetscCall(VecGetArray(w->s->bound, &b));
  for (PetscInt k = 0; k < w->c->grid->cells; k++) b[k] = PetscMax(b[k], 0);
  PetscCall(VecRestoreArray(w->s->bound, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fail(SamSolve *w, PetscReal change)
{
  const SamLaw *laws;
  PetscInt      count, k = 0;
  char          message[sizeof(w->step->message)];

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(w->c->problem, &count, &laws));
  while (k < count - 1 && !laws[k]->follows_slip) k++;
  PetscCall(PetscSNPrintf(message, sizeof(message),
                          "the friction of the law %s did not converge with the slip within %d iterations, the last "
                          "relative change is %.2g: %s",
                          laws[k]->type, PASSES, (double)change,
                          w->c->traits.steady ? "use a longer memory of the friction" : "use smaller load steps"));
  PetscCall(SamStepFail(w->step, SAM_STATUS_NOT_CONVERGED, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The passes; they end with a tangential problem that is not solved, which is the caller's to judge. */
static PetscErrorCode Iterate(SamSolve *w, PetscBool has_shear, PetscReal rtol)
{
  PetscBool       mixed  = PETSC_FALSE;
  PetscReal       change = PETSC_INFINITY;
  SamMixing       mixing;
  SamSolverReason reason = SAM_SOLVER_ITERATING;
  Vec             found;

  PetscFunctionBegin;
  PetscCall(SamMixingCreate(w->c->grid, 1, &mixing));
  PetscCall(SamGridCreateVec(w->c->grid, 1, &found));
  for (PetscInt pass = 0; pass < PASSES && change > rtol; pass++) {
    PetscCall(SamSolveTangential(w, has_shear || pass > 0));
    PetscCall(SamSolverGetReason(SamTangentialAsSolver(w->c->tangential), &reason));
    if (reason < 0 && !mixed) break;
    if (reason > 0) PetscCall(Measure(w, found, &change));
    if (change <= rtol) break;
    mixed = reason > 0;
    if (mixed) {
      PetscCall(Next(w, &mixing, found));
    } else {
      PetscCall(SamMixingDestroy(&mixing));
      PetscCall(SamMixingCreate(w->c->grid, 1, &mixing));
      PetscCall(VecCopy(found, w->s->bound));
    }
  }
  if (reason > 0 && change > rtol) PetscCall(Fail(w, change));
  PetscCall(VecDestroy(&found));
  PetscCall(SamMixingDestroy(&mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveShear(SamSolve *w, PetscBool has_shear, PetscReal rtol, SamEffort effort)
{
  const SamSolver solver = SamTangentialAsSolver(w->c->tangential);

  PetscFunctionBegin;
  if (w->coupled) PetscCall(SamElasticityApplyNormalToTangential(w->c->elasticity, w->s->pressure, w->pushed));
  if (w->coupled) PetscCall(SamElasticityAddCases(w->c->elasticity, &w->s->control, PETSC_TRUE, w->pushed));
  if (!SamProblemFollowsSlip(w->c->problem)) {
    PetscCall(SamSolveDirection(w, has_shear, rtol, effort));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SamSolverSetEffort(solver, SHEAR_PART * rtol, effort);
  PetscCall(Iterate(w, has_shear, BOUND_PART * rtol));
  SamSolverSetEffort(solver, 0, SAM_EFFORT_FULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

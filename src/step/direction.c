/*
  The direction of the slip in a step.

  Where a point slides, its slip velocity is opposite to the shear at every instant, while |q| = b. From one step to the
  next, from q0 under b0 to q under b, this has to be integrated. With r = q/b, the slip ds of the step is opposite to

    at the end of the step   r
    at mid step              r + w r0,  w = max(0, r0.(r0 + r)/2)

  Order of the error. Let q turn by the angle a in a step. A slip opposite to r is that of a shear half a step ahead:
  ds is turned by a/2. So the solution itself, and with it the energy, are wrong to first order in the steps wherever
  the shear turns, as under T_x and T_y out of phase; the mean of the bounds before and after in the energy (numbers.c)
  does not help. Where it does not turn, both rules agree, the solution has no error of its own, and with that mean the
  energy is second order. r + r0 bisects the angle: its error is of third order in a step, of second order in all, and
  w is 1 up to a^2 where a cell slides all the time. Where a cell stuck before, its slip begins within the step in a
  direction between r0 and r; there are few such cells, in proportion to the step, so that any w does to second order.
  A w that vanishes with r0 and at a reversal, where r0 = -r, keeps the rule continuous, and its slope by the angle at
  most 1/2, which the iteration below needs. At the end |q| = b holds with both rules, unlike with the midpoint rule of
  plasticity, which holds it at mid step only, and rings where stick turns to slip.

  At mid step the work is the mean of the bounds times |ds|, also where contact was left (solutionimpl.h).

  Algorithm. R(q) turns r + w r0 to r; so R ds is opposite to r, and with t = ds - R ds known, the tangential problem
  with the offset lessened by t is that with the rule at the end. A pass:
    1. The tangential problem with t, from the last shear on, gives q and ds. From the second pass on it is solved to a
       part of the last change of t only.
    2. If t is ds - R(q) ds up to a part of the tolerance, the step is solved.
    3. Else Anderson's method makes the next t of this and the last passes (fixedpoint.c).
  Plain passes multiply the error by about the larger of tan(a/2) and 1/2. If they do not converge, the step keeps the
  rule at its end. The direction of a step that repeats one of the cycle before starts from that (stepcache.c).

  References: M. Ortiz, E. P. Popov, Accuracy and stability of integration algorithms for elastoplastic constitutive
  relations, Int. J. Numer. Methods Eng. 21 (1985) 1561-1576; the sources of fixedpoint.c.
*/
#include "stepimpl.h"

#define PASSES 50
/* Parts of the tolerance to which t, and the tangential problem of a pass, are solved: the check adds both. */
#define TURN_PART  0.3
#define SHEAR_PART 0.7
/* Part of the tolerance that a t may leave over which the problem was solved to all of it. */
#define REST 0.05
/* The part of the last change of t to which the tangential problem is solved. */
#define CHANGE_PART 0.03

typedef struct {
  SamSolve *w;
  PetscBool has_shear;
  SamEffort effort;
  PetscReal rtol, tolerance; /* of the step, and of the tangential problem of the next pass */
} Passes;

/* Steps 1 and 2. A tangential problem that is not solved ends the passes. */
static PetscErrorCode Pass(void *context, PetscInt pass, Vec found, SamPassEnd *end)
{
  Passes *const   p      = (Passes *)context;
  SamSolve *const w      = p->w;
  const SamSolver solver = SamTangentialAsSolver(w->task->tangential);
  PetscReal       self, change;

  PetscFunctionBegin;
  SamSolverSetEffort(solver, p->tolerance, p->effort);
  PetscCall(SamSolveTangential(w, p->has_shear || pass > 1));
  *end = SAM_PASS_FAILED;
  if (SamSolverGetReason(solver) < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolveDisplace(w));
  PetscCall(SamSolveGetTurn(w, found));
  PetscCall(SamElasticityGetSelfInfluence(w->task->elasticity, NULL, &self));
  PetscCall(SamSolveGetChange(w, w->turn, found, self, &change, NULL));
  if (change <= (p->tolerance > SHEAR_PART * p->rtol ? REST : TURN_PART) * p->rtol) {
    *end         = p->tolerance <= p->rtol ? SAM_PASS_SOLVED : SAM_PASS_REPEATS;
    p->tolerance = SHEAR_PART * p->rtol;
  } else {
    *end         = SAM_PASS_GOES_ON;
    p->tolerance = PetscMax(SHEAR_PART * p->rtol, CHANGE_PART * change);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveDirection(SamSolve *w, PetscBool has_shear, PetscReal rtol, SamEffort effort)
{
  static const SamFixedPoint turn   = {.components = 2, .most = PASSES, .pass = Pass};
  const SamSolver            solver = SamTangentialAsSolver(w->task->tangential);
  Passes                     p = {.w = w, .has_shear = has_shear, .effort = effort, .rtol = rtol, .tolerance = rtol};
  PetscBool                  solved = PETSC_FALSE;
  SamPassEnd                 end;
  SamSolverReason            reason;

  PetscFunctionBegin;
  if (w->s->mid_step) {
    if (!w->turn) PetscCall(SamGridCreateVec(w->task->grid, 2, &w->turn));
    PetscCall(SamSolveFixedPoint(w, &turn, &p, w->turn, &end));
    reason = SamSolverGetReason(solver);
    SamSolverSetEffort(solver, rtol, effort);
    solved = end == SAM_PASS_SOLVED ||
             reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM || /* a later pass of dissimilar bodies tries again */
             (reason == SAM_SOLVER_DIVERGED_ITS && effort == SAM_EFFORT_BRIEF);
    if (!solved) w->s->mid_step = PETSC_FALSE;
    if (!solved) PetscCall(VecDestroy(&w->turn));
  }
  if (!solved) PetscCall(SamSolveTangential(w, has_shear));
  SamSolverSetEffort(solver, 0, SAM_EFFORT_FULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
    3. Else Anderson's method makes the next t of this and the last passes (mixing.c).
  Plain passes multiply the error by about the larger of tan(a/2) and 1/2. If they do not converge, the step keeps the
  rule at its end. The direction of a step that repeats one of the cycle before starts from that (recall.c).

  References: M. Ortiz, E. P. Popov, Accuracy and stability of integration algorithms for elastoplastic constitutive
  relations, Int. J. Numer. Methods Eng. 21 (1985) 1561-1576; the sources of mixing.c.
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

PetscErrorCode SamSolveDisplace(SamSolve *w)
{
  const PetscBool known = w->s->mid_step && w->shear_product.n[0] > 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamContactSetDisplacements(w->c));
  if (known)
    PetscCall(VecCopy(w->shear_product.field, w->s->displacement_t));
  else
    PetscCall(SamElasticityApplyTangential(w->c->elasticity, w->s->shear, w->s->displacement_t));
  if (w->coupled) PetscCall(VecAXPY(w->s->displacement_t, 1, w->pushed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 2: ds - R(q) ds, and its difference from t, relative to what the check compares it with. */
static PetscErrorCode FindTurn(SamSolve *w, Vec found)
{
  const SamGrid grid = w->c->grid;
  SamIncrement  increment;
  double       *t, *to[2];

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(w->c->problem, w->before, w->s, &increment));
  PetscCall(VecGetArrayWrite(found, &t));
  for (PetscInt j = 0; j < grid->rows; j++) {
    for (PetscInt k = 0; k < 2; k++) to[k] = t + (ptrdiff_t)j * grid->nx + (ptrdiff_t)k * grid->cells;
    SamIncrementComputeRow(&increment, j);
    SamIncrementTurnRow(&increment, j, to);
    for (PetscInt k = 0; k < 2; k++)
      for (PetscInt i = 0; i < grid->nx; i++) to[k][i] = increment.row[k][i] - to[k][i];
  }
  PetscCall(VecRestoreArrayWrite(found, &t));
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Measure(SamSolve *w, Vec found, PetscReal *change)
{
  const SamGrid grid = w->c->grid;
  PetscReal     size, shear, bound, self;
  Vec           difference;

  PetscFunctionBegin;
  PetscCall(SamSolveDisplace(w));
  PetscCall(FindTurn(w, found));
  PetscCall(SamGridCreateVec(grid, 2, &difference));
  PetscCall(VecWAXPY(difference, -1, w->turn, found));
  PetscCall(SamGridNorm(grid, difference, NORM_2, &size));
  PetscCall(VecDestroy(&difference));
  PetscCall(SamGridNorm(grid, w->s->shear, NORM_2, &shear));
  PetscCall(SamGridNorm(grid, w->s->bound, NORM_2, &bound));
  PetscCall(SamElasticityGetSelfInfluence(w->c->elasticity, NULL, &self));
  *change = size > 0 ? size / self / PetscMax(shear, SAM_SHEAR_FLOOR * bound) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveGuessDirection(SamSolve *w, SamKept kept, Vec shear, const SamProduct *product, Vec offset)
{
  const Vec own = w->s->shear;

  PetscFunctionBegin;
  PetscCall(SamContactSetDisplacements(w->c));
  PetscCall(VecCopy(product->field, w->s->displacement_t));
  SamBalanceStore(&w->tangential, w->s->load, w->s->rigid);
  SamKeptGetMotion(kept, w->before, w->s->rigid);
  w->s->shear = shear;
  PetscCall(FindTurn(w, w->turn));
  w->s->shear = own;
  PetscCall(VecAXPY(offset, -1, w->turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The passes; `solved`: they have converged. A tangential problem that is not solved ends them. */
static PetscErrorCode Iterate(SamSolve *w, PetscBool has_shear, PetscReal rtol, SamEffort effort, PetscBool *solved)
{
  const SamSolver solver = SamTangentialAsSolver(w->c->tangential);
  SamSolverReason reason = SAM_SOLVER_ITERATING;
  PetscReal       change = 0, tolerance = rtol;
  SamMixing       mixing;
  Vec             found;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  PetscCall(SamMixingCreate(w->c->grid, 2, &mixing));
  PetscCall(SamGridCreateVec(w->c->grid, 2, &found));
  if (!w->turn) PetscCall(SamGridCreateVec(w->c->grid, 2, &w->turn));
  for (PetscInt pass = 0; pass < PASSES && !*solved; pass++) {
    SamSolverSetEffort(solver, tolerance, effort);
    PetscCall(SamSolveTangential(w, has_shear || pass > 0));
    PetscCall(SamSolverGetReason(solver, &reason));
    if (reason < 0) break;
    PetscCall(Measure(w, found, &change));
    if (change <= (tolerance > SHEAR_PART * rtol ? REST : TURN_PART) * rtol) {
      *solved   = tolerance <= rtol;
      tolerance = SHEAR_PART * rtol;
    } else {
      PetscCall(SamMixingNext(&mixing, w->s->pressure, found, w->turn));
      tolerance = PetscMax(SHEAR_PART * rtol, CHANGE_PART * change);
    }
  }
  PetscCall(VecDestroy(&found));
  PetscCall(SamMixingDestroy(&mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveDirection(SamSolve *w, PetscBool has_shear, PetscReal rtol, SamEffort effort)
{
  const SamSolver solver = SamTangentialAsSolver(w->c->tangential);
  PetscBool       solved = PETSC_FALSE;
  SamSolverReason reason;

  PetscFunctionBegin;
  if (w->s->mid_step) {
    PetscCall(Iterate(w, has_shear, rtol, effort, &solved));
    PetscCall(SamSolverGetReason(solver, &reason));
    SamSolverSetEffort(solver, rtol, effort);
    solved = solved ||
             reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM || /* a later pass of dissimilar bodies tries again */
             (reason == SAM_SOLVER_DIVERGED_ITS && effort == SAM_EFFORT_BRIEF);
    if (!solved) w->s->mid_step = PETSC_FALSE;
    if (!solved) PetscCall(VecDestroy(&w->turn));
  }
  if (!solved) PetscCall(SamSolveTangential(w, has_shear));
  SamSolverSetEffort(solver, 0, SAM_EFFORT_FULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

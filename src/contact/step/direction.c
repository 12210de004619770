/*
  The slip in a step: its direction, and the place where it begins.

  Direction. Where a point slides, its slip velocity is opposite to the shear at every instant, while |q| = b. From one
  step to the next, from q0 under b0 to q under b, this has to be integrated. With r = q/b, the slip ds of the step is
  opposite to

    at the end of the step   r
    at mid step              r + w r0,  w = max(0, r0.(r0 + r)/2)

  Let q turn by the angle a in a step. A slip opposite to r is that of a shear half a step ahead: ds is turned by a/2.
  So the solution itself, and with it the energy, have errors of first order in the steps wherever the shear turns, for
  example under T_x and T_y out of phase. Where it does not turn, both rules agree. r + r0 bisects the angle: its error
  is of third order in a step, so of second order in the sum, and w is 1 up to a^2 where a cell slides all the time.
  Where a cell stuck before, its slip begins within the step in a direction between r0 and r. The number of such cells
  is proportional to the step, so any w is accurate to second order. Both rules fulfil |q| = b at the end of the step.
  The midpoint rule of plasticity fulfils it at mid step only, and oscillates where stick turns to slip.

  Beginning. A cell that comes into contact within the step has moved freely before. If slip were measured from its
  place before the step, it would take too much shear, by an error of first order in the step. Where the whole contact
  sticks and N grows, the shear grows like the pressure, dq = tau dp with tau = dT/dN, whatever the shape (Ciavarella
  1998, Jaeger 1998). Then surfaces that are g0 apart before the step have moved over each other until they touch by

    -kappa tau' g0,  tau' = tau min(1, mu/|tau|)

  kappa being the ratio of the tangential to the normal compliance. Slip in the step begins there. In a step from
  no contact g0 is the distance of the undeformed bodies, if all loads grow in proportion. If the contact has not grown
  by N, or if N is applied first, this is zero, as at a place that loses contact. For bodies with layers or a shape of
  their own, kappa is that of the materials at the surface. At the edge pressure and shear grow like those of a punch
  that sticks, and tau is their ratio there. At the edge of a round punch a displacement that is linear in the place
  from the centre counts twice compared to a uniform one. So do tilting, in the growth of the pressure, and the strain e
  by bulk stress, in the growth of the shear:

    kappa tau = (kappa dT/dN d - 2 e r)/(d + 2 tilt),

  d being the approach. In plane strain, where the approach is unbounded, d is 4 dN/(pi E*). From no contact, tau is
  that of N. The motion by M_z there is not estimated: its error stays of first order.

  The pressure of dissimilar bodies moves the surfaces at all times, outside of contact too, and most of the slip of a
  growing contact is in cells that touch within the step. Their motion until they touch is found from that of the open
  cells beside them (touching.c). In a first step, from no contact, with tangential loads, which the next one does not
  continue in proportion, N is applied first, and all slip counts.

  Algorithm. R(q) turns r + w r0 to r; so R ds is opposite to r. If t = ds - R ds is known, the tangential problem with
  the offset reduced by t uses the rule at the end of the step.
    1. The tangential problem with t of the step before, times the square of the ratio of the steps and turned as q
       turned in it, gives q and ds, to a tolerance that t bears.
    2. t = ds - R(q) ds of the cells that slide. Its error is of second order in the step, relative to ds.
    3. The tangential problem with this t, from that q on.
  In a cycle that repeats itself step 1 uses t of the same step one cycle before (stepcache.c). If it has done so once,
  step 1 is solved completely, and steps 2 and 3 are left out if t agrees with it.
  With a tolerance of the shear of at most 1e-8, and where steps are recorded for gradients, steps 2 and 3 are repeated,
  with Anderson's method, until t is that of the solution to this tolerance: the solution is that of the rule, and
  differentiable (solve.c).
  For dissimilar bodies steps 1 and 3 are the passes of coupling.c. While all loads lie on a line, step 3 suffices: the
  shear keeps its direction, except for the transverse part that Poisson's ratio causes, whose work cancels. The motion
  of cells before they touch follows from the loads: if loads are unknown, after step 1.

  References: M. Ortiz, E. P. Popov, Accuracy and stability of integration algorithms for elastoplastic constitutive
  relations, Int. J. Numer. Methods Eng. 21 (1985) 1561-1576; M. Ciavarella, The generalized Cattaneo partial slip plane
  contact problem, Int. J. Solids Struct. 35 (1998) 2349-2378; J. Jaeger, A new principle in contact mechanics, J.
  Tribol. 120 (1998) 677-684.
*/
#include "stepimpl.h"
#include <math.h>
#include <petsam/private/entering.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/pressed.h>

/* True if contact grows, and the shear determines the motion where it is made. */
static PetscBool Grows(SamSolve *w)
{
  return SamApproachGrows(w->before, w->s);
}

PetscBool SamSolveIsTwice(SamSolve *w)
{
  return !w->holds && (SamSolveTurns(w) || (Grows(w) && !(w->tangential.force[0] && w->tangential.force[1])));
}

/* Finds the bodies' motion in the step, by the loads that are `found`, or by those that are given. */
static PetscErrorCode FindApproach(SamSolve *w, PetscBool found, SamApproach *a)
{
  PetscReal loads[2];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 2; c++) {
    const PetscInt k = SamComponentsOf[SAM_BALANCE_TANGENTIAL][c];

    loads[c] = w->before ? w->before->load[k] : 0;
    if (w->tangential.force[c]) loads[c] = (PetscReal)w->tangential.load[c];
    if (found) loads[c] = w->s->load[k];
  }
  PetscCall(SamApproachFind(w->contact->problem, w->contact->state, w->before, w->s, loads, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveFindGaps(SamSolve *w, Vec gap)
{
  PetscFunctionBegin;
  PetscCall(SamApproachGaps(w->contact->problem, w->before, w->s, w->separation, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveAddEntering(SamSolve *w, PetscBool found, PetscBool open, Vec motion)
{
  const SamSolution *s     = w->s;
  const SamGrid      grid  = w->grid;
  const PetscInt     cells = grid->cells;
  double            *to, friction = 0; /* the largest */
  const double      *p, *b, *g;
  SamApproach        approach;
  Vec                gap;

  PetscFunctionBegin;
  if (!Grows(w)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindApproach(w, found, &approach));
  PetscCall(SamGridCreateVec(w->grid, 1, &gap));
  PetscCall(SamSolveFindGaps(w, gap));
  PetscCall(VecGetArrayRead(gap, &g));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->bound, &b));
  PetscCall(VecGetArray(motion, &to));
  for (PetscInt k = 0; k < cells && open; k++)
    if (SamIsPressed(p[k])) friction = PetscMax(friction, b[k] / p[k]);
  if (open) PetscCall(SamMax(grid->comm, 1, &friction));
  for (PetscInt k = 0; k < cells; k++) {
    const PetscBool pressed = SamIsPressed(p[k]);
    double          tau[2], size, part;

    if (!(pressed || open) || g[k] <= 0) continue;
    SamApproachShear(&approach, SamGridX(grid, k % grid->nx), SamGridY(grid, grid->row_start + k / grid->nx), tau);
    size = hypot(tau[0], tau[1]);
    part = pressed ? (size * p[k] > b[k] ? b[k] / (p[k] * size) : 1) : size > friction ? friction / size : 1;
    for (int c = 0; c < 2; c++) to[k + c * cells] -= approach.kappa[c] * tau[c] * part * g[k];
  }
  PetscCall(VecRestoreArray(motion, &to));
  PetscCall(VecRestoreArrayRead(s->bound, &b));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(VecRestoreArrayRead(gap, &g));
  PetscCall(VecDestroy(&gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets t in cells that slide all the time or begin to slide. */
PetscErrorCode SamStepFindTurn(SamContact contact, Vec turn)
{
  const SamGrid grid = contact->grid;
  SamIncrement  increment;
  double       *t, *to[2], share[2];

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(contact->problem, contact->tried.before, &contact->generation[SAM_TRIED], &increment));
  PetscCall(VecGetArray(turn, &t));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t first = (ptrdiff_t)j * grid->nx;

    for (PetscInt c = 0; c < 2; c++) to[c] = t + first + c * (ptrdiff_t)grid->cells;
    SamIncrementComputeRow(&increment, j);
    SamIncrementTurnRow(&increment, j, to);
    for (PetscInt i = 0; i < grid->nx; i++) {
      const SamCellMotion motion = SamIncrementGetCellMotion(&increment, first + i, share);
      const PetscBool     turns  = motion == SAM_CELL_MOTION_ALWAYS || motion == SAM_CELL_MOTION_BEGINS;

      for (PetscInt c = 0; c < 2; c++) to[c][i] = turns ? increment.row[c][i] - to[c][i] : 0;
    }
  }
  PetscCall(VecRestoreArray(turn, &t));
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetTurn(SamSolve *w, Vec aside)
{
  PetscFunctionBegin;
  PetscCall(SamSolveDisplace(w));
  PetscCall(SamStepFindTurn(w->contact, aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Predicts t from the step before, in proportion to the square of the step and turned as the shear turned in it, where
  there was contact before that.
*/
static PetscErrorCode PredictTurn(SamSolve *w, Vec aside)
{
  const SamSolution *last = w->before, *earlier = &w->contact->generation[SAM_BEFORE];
  const double       scale = w->contact->tried.start.along * w->contact->tried.start.along;
  const PetscInt     cells = w->grid->cells;
  const double      *p, *p0, *t, *q, *q0;
  double            *to;

  PetscFunctionBegin;
  if (scale == 0 || !last->aside) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(earlier->pressure, &p));
  PetscCall(VecGetArrayRead(last->pressure, &p0));
  PetscCall(VecGetArrayRead(earlier->shear, &q0));
  PetscCall(VecGetArrayRead(last->shear, &q));
  PetscCall(VecGetArrayRead(last->aside, &t));
  PetscCall(VecGetArray(aside, &to));
  for (PetscInt k = 0; k < cells; k++) {
    const double x = q0[k] * q[k] + q0[k + cells] * q[k + cells], y = q0[k] * q[k + cells] - q0[k + cells] * q[k];
    const double size = hypot(x, y), along = size > 0 ? x / size : 1, across = size > 0 ? y / size : 0;

    if (!(PetscMin(p[k], p0[k]) > 0)) continue;
    to[k]         = scale * (along * t[k] - across * t[k + cells]);
    to[k + cells] = scale * (across * t[k] + along * t[k + cells]);
  }
  PetscCall(VecRestoreArray(aside, &to));
  PetscCall(VecRestoreArrayRead(last->aside, &t));
  PetscCall(VecRestoreArrayRead(last->shear, &q));
  PetscCall(VecRestoreArrayRead(earlier->shear, &q0));
  PetscCall(VecRestoreArrayRead(last->pressure, &p0));
  PetscCall(VecRestoreArrayRead(earlier->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamSolveSetsAside(SamSolve *w)
{
  return !w->holds && (SamSolveTurns(w) || Grows(w) || w->touching);
}

PetscErrorCode SamSolveSetAside(SamSolve *w, SamAsideFrom from)
{
  const PetscBool solved = from == SAM_ASIDE_SOLVED;
  Vec             aside;

  PetscFunctionBegin;
  if (!SamSolveSetsAside(w)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(w->grid, 2, &aside));
  if (SamSolveTurns(w) && from == SAM_ASIDE_KEPT)
    PetscCall(SamCachedStepAddTurn(w->contact->tried.start.kept, w->grid, aside));
  else if (SamSolveTurns(w))
    PetscCall((solved ? SetTurn : PredictTurn)(w, aside));
  PetscCall(SamSolveAddEntering(w, solved, PETSC_FALSE, aside));
  if (w->touching) PetscCall(VecAXPY(aside, 1, w->touching));
  PetscCall(SamStateSetField(w->contact->state, w->contact->aside, &w->s->aside));
  PetscCall(VecCopy(aside, w->s->aside));
  PetscCall(VecDestroy(&aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

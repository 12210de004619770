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
  that of N. The motion by M_z there is not estimated: its error stays of first order. The motion by the pressure of
  dissimilar bodies is of first order too, in the other direction: if Dundurs' constant is at least MOST_DUNDURS, both
  corrections are omitted, as they partly cancel.

  The pressure of dissimilar bodies moves the surfaces at all times, outside of contact too, and most of the slip of a
  growing contact is in cells that touch within the step. If they move by ds in the step, the part

    tau = d0/(d0 + d1),   d0 = (g0/G)^(2/3),   d1 = (p1/P)^2

  is before they touch, g0 being the gap before the step, p1 the pressure after it, G and P the largest of both: the gap
  grows like the power 3/2 of the distance from the old edge, the pressure like its root behind the new one. In a first
  step, from no contact, the part is the power 3/2 of the distance of the undeformed bodies, since the N of a sphere
  grows like that. If such a step also has tangential loads, and the next one does not continue it in proportion, N is
  applied first, and all slip counts. The rest works against 0.4 of the bound after the step: behind a moving edge slip
  fades. Measured on a rigid sphere on a half-space, N alone in 3, 5, 10, 20 equal steps: the energy is too large by 44,
  17, 4 and 1 %, and was by 330, 150, 53 and 18 %.

  Algorithm. R(q) turns r + w r0 to r; so R ds is opposite to r. If t = ds - R ds is known, the tangential problem with
  the offset reduced by t uses the rule at the end of the step.
    1. The tangential problem with t of the step before, times the square of the ratio of the steps and turned as q
       turned in it, gives q and ds, to a tolerance that t bears.
    2. t = ds - R(q) ds of the cells that slide. Its error is of second order in the step, relative to ds.
    3. The tangential problem with this t, from that q on.
  In a cycle that repeats itself step 1 uses t of the same step one cycle before (stepcache.c). If it has done so once,
  step 1 is solved completely, and steps 2 and 3 are left out if t agrees with it.
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
#include <petsam/private/bodyimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/pressed.h>
#include <petsam/private/body.h>

/* Largest absolute Dundurs' constant of surfaces whose relative motion is determined by the shear alone */
#define MOST_DUNDURS 0.15
/* Growth of N, relative to it, below which it is rounding: the ratio of the changes of T and N says nothing there */
#define LEAST_GROWTH 1e-9

/* Returns a load before the step: zero before the first one. */
static PetscReal LoadBefore(SamSolve *w, PetscInt component)
{
  return w->task->before ? w->task->before->load[component] : 0;
}

/* True if contact grows with N and the other loads, and the shear determines the motion where contact is made. */
static PetscBool Grows(SamSolve *w)
{
  const SamPair   pair    = SamElasticityGetPair(w->task->elasticity);
  const PetscReal before  = w->task->before ? SamSolutionGetNormal(w->task->before) : 0;
  const PetscBool touched = before > 0 || w->s->control.together ? PETSC_TRUE : PETSC_FALSE;

  return touched && w->task->set->slip_direction == SAM_SLIP_MID && w->task->motion->continues && !w->task->rolls &&
         SamSolutionGetNormal(w->s) > (1 + LEAST_GROWTH) * before &&
         !(w->task->coupled && fabs((double)pair->dundurs) > MOST_DUNDURS);
}

PetscBool SamSolveIsTwice(SamSolve *w)
{
  return !w->holds && (w->s->mid_step || (Grows(w) && !(w->tangential.force[0] && w->tangential.force[1])));
}

/* Returns kappa (top of this file) along x or y. */
static double RatioOfCompliances(SamSolve *w, int c)
{
  const SamPair pair = SamElasticityGetPair(w->task->elasticity);

  return (double)((pair->shear + (w->task->traits.plane ? c : (PetscReal)0.5) * pair->shear_xx) / pair->normal);
}

/*
  Increment of the bodies' motion in a step: the approach about the previous centre of pressure, the tilt, the strain of
  the surfaces, and the ratio of the changes of the tangential loads to that of N.
*/
typedef struct {
  double    center[2], uniform, tilt[2], tau[2];
  SamStrain strain;
} Approach;

static PetscErrorCode AddMotion(SamSolve *w, const SamSolution *before, double normal, Approach *a)
{
  const SamSolution *now = w->s;
  SamStrain          e;

  PetscFunctionBegin;
  PetscCall(SamProblemDisplace(w->task->problem, w->task->state, &now->control, NULL, NULL, &a->strain, NULL));
  PetscCall(SamProblemDisplace(w->task->problem, w->task->state, &before->control, NULL, NULL, &e, NULL));
  a->strain    = (SamStrain){a->strain.xx - e.xx, a->strain.yy - e.yy, a->strain.xy - e.xy};
  a->center[0] = (double)(before->load[SAM_COMPONENT_MY] / before->load[SAM_COMPONENT_N]);
  a->center[1] = -(double)(before->load[SAM_COMPONENT_MX] / before->load[SAM_COMPONENT_N]);
  a->tilt[0]   = (double)(now->rigid[SAM_COMPONENT_MY] - before->rigid[SAM_COMPONENT_MY]);
  a->tilt[1]   = -(double)(now->rigid[SAM_COMPONENT_MX] - before->rigid[SAM_COMPONENT_MX]);
  a->uniform   = (double)(now->rigid[SAM_COMPONENT_N] - before->rigid[SAM_COMPONENT_N]) + a->tilt[0] * a->center[0] +
               a->tilt[1] * a->center[1];
  if (w->task->traits.plane)
    a->uniform = 4 * normal / (PETSC_PI * (double)SamPairModulus(SamElasticityGetPair(w->task->elasticity)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindApproach(SamSolve *w, PetscBool found, Approach *a)
{
  const SamSolution *before = w->task->before, *now = w->s;
  const PetscReal    load   = LoadBefore(w, SAM_COMPONENT_N);
  const double       normal = (double)(now->load[SAM_COMPONENT_N] - load);

  PetscFunctionBegin;
  *a = (Approach){.uniform = 1}; /* from no contact: everything grows by N */
  for (PetscInt c = 0; c < 2; c++) {
    const PetscInt  k   = SamComponentsOf[SAM_BALANCE_TANGENTIAL][c];
    const PetscReal was = LoadBefore(w, k);
    const PetscReal is  = found ? now->load[k] : (w->tangential.force[c] ? w->tangential.load[c] : was);

    a->tau[c] = (double)(is - was) / normal;
  }
  if (load > 0) PetscCall(AddMotion(w, before, normal, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes tau, the ratio of the changes of shear and pressure of a sticking punch, at the contact edge at (x, y). */
static void ShearAtEdge(const Approach *a, const double kappa[2], double x, double y, double tau[2])
{
  const double    at_x = x - a->center[0], at_y = y - a->center[1];
  const double    tilt = a->tilt[0] * at_x + a->tilt[1] * at_y, normal = a->uniform + 2 * PetscMax(0, tilt);
  const SamStrain e        = a->strain;
  const double    moved[2] = {e.xx * at_x + e.xy * at_y, e.xy * at_x + e.yy * at_y};

  for (int c = 0; c < 2; c++) tau[c] = a->uniform > 0 ? (a->tau[c] * a->uniform - 2 * moved[c] / kappa[c]) / normal : 0;
}

/* Computes the gap before the step in cells that were open; it is 0 in others. */
static PetscErrorCode FindGaps(SamSolve *w, Vec gap)
{
  const double *p;
  double       *g;

  PetscFunctionBegin;
  PetscCall(SamSolutionComputeGap(w->task->problem, w->task->before, w->separation, gap));
  PetscCall(VecGetArrayRead(w->task->before->pressure, &p));
  PetscCall(VecGetArray(gap, &g));
  for (PetscInt k = 0; k < w->task->grid->cells; k++) g[k] = SamIsPressed(p[k]) ? 0 : g[k];
  PetscCall(VecRestoreArray(gap, &g));
  PetscCall(VecRestoreArrayRead(w->task->before->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the distance of the undeformed bodies instead, in a step from no contact, for cells in contact after it. */
static PetscErrorCode FindDistances(SamSolve *w, Vec distance)
{
  const PetscInt nx    = w->task->grid->nx;
  double         least = -INFINITY; /* the negative of the least distance */
  const double  *p, *h;
  double        *zero, *g;
  SamRigid       motion;

  PetscFunctionBegin;
  PetscCall(SamRigidSet(&motion, w->task->problem, w->s));
  PetscCall(PetscCalloc1(nx, &zero));
  PetscCall(VecGetArrayRead(w->s->pressure, &p));
  PetscCall(VecGetArrayRead(w->separation, &h));
  PetscCall(VecGetArray(distance, &g));
  for (PetscInt j = 0; j < w->task->grid->rows; j++) {
    const ptrdiff_t first = (ptrdiff_t)j * nx;

    SamRigidGap(&motion, SamRigidOfGap(&motion, j), zero, h + first, g + first);
  }
  for (PetscInt k = 0; k < w->task->grid->cells; k++)
    if (SamIsPressed(p[k])) least = PetscMax(least, -g[k]);
  PetscCall(SamMax(w->task->grid->comm, 1, &least));
  for (PetscInt k = 0; k < w->task->grid->cells; k++) g[k] = SamIsPressed(p[k]) ? g[k] + least : 0;
  PetscCall(VecRestoreArray(distance, &g));
  PetscCall(VecRestoreArrayRead(w->separation, &h));
  PetscCall(VecRestoreArrayRead(w->s->pressure, &p));
  PetscCall(PetscFree(zero));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the motion of the surfaces in cells before they touch, from the loads, given or `found`. */
static PetscErrorCode SetEntering(SamSolve *w, PetscBool found, Vec aside)
{
  const SamSolution *s        = w->s;
  const SamGrid      grid     = w->task->grid;
  const PetscInt     cells    = grid->cells;
  const double       kappa[2] = {RatioOfCompliances(w, 0), RatioOfCompliances(w, 1)};
  double            *to;
  const double      *p, *b, *g;
  Approach           approach;
  Vec                gap;

  PetscFunctionBegin;
  PetscCall(FindApproach(w, found, &approach));
  PetscCall(SamGridCreateVec(w->task->grid, 1, &gap));
  PetscCall((LoadBefore(w, SAM_COMPONENT_N) > 0 ? FindGaps : FindDistances)(w, gap));
  PetscCall(VecGetArrayRead(gap, &g));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->bound, &b));
  PetscCall(VecGetArray(aside, &to));
  for (PetscInt k = 0; k < cells; k++) {
    double tau[2], size, part;

    if (!SamIsPressed(p[k]) || g[k] <= 0) continue;
    ShearAtEdge(&approach, kappa, SamGridX(grid, k % grid->nx), SamGridY(grid, grid->row_start + k / grid->nx), tau);
    size = hypot(tau[0], tau[1]);
    part = size * p[k] > b[k] ? b[k] / (p[k] * size) : 1;
    for (int c = 0; c < 2; c++) to[k + c * cells] = -kappa[c] * tau[c] * part * g[k];
  }
  PetscCall(VecRestoreArray(aside, &to));
  PetscCall(VecRestoreArrayRead(s->bound, &b));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(VecRestoreArrayRead(gap, &g));
  PetscCall(VecDestroy(&gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets t in cells that slide all the time or begin to slide. */
PetscErrorCode SamStepFindTurn(SamProblem problem, SamGrid grid, const SamSolution *before, const SamSolution *now,
                               Vec turn)
{
  SamIncrement increment;
  double      *t, *to[2], share[2];

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(problem, before, now, &increment));
  PetscCall(VecGetArray(turn, &t));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t first = (ptrdiff_t)j * grid->nx;

    for (PetscInt c = 0; c < 2; c++) to[c] = t + first + c * (ptrdiff_t)grid->cells;
    SamIncrementComputeRow(&increment, j);
    SamIncrementTurnRow(&increment, j, to);
    for (PetscInt i = 0; i < grid->nx; i++) {
      const SamSlide  slide = SamIncrementGetSlide(&increment, first + i, share);
      const PetscBool turns = slide == SAM_SLIDE_ALWAYS || slide == SAM_SLIDE_BEGINS;

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
  PetscCall(SamStepFindTurn(w->task->problem, w->task->grid, w->task->before, w->s, aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Predicts t from the step before, in proportion to the square of the step and turned as the shear turned in it, where
  there was contact before that.
*/
static PetscErrorCode PredictTurn(SamSolve *w, Vec aside)
{
  const SamSolution *last = w->task->before, *earlier = w->task->earlier;
  const double       scale = w->task->start.along * w->task->start.along;
  const PetscInt     cells = w->task->grid->cells;
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

/*
  Finds the largest gap before and the largest pressure after the step among cells of all ranks that come into contact.
*/
static PetscErrorCode MeasureTouching(SamGrid grid, const double p0[], const double p[], const double g[],
                                      double most[2])
{
  PetscFunctionBegin;
  most[0] = most[1] = 0;
  for (PetscInt k = 0; k < grid->cells; k++) {
    if (SamIsPressed(p0[k]) || !SamIsPressed(p[k])) continue;
    most[0] = PetscMax(most[0], g[k]);
    most[1] = PetscMax(most[1], p[k]);
  }
  PetscCall(SamMax(grid->comm, 2, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the time at which cells touch, as a part of the step, where there was contact before. */
static PetscErrorCode FindTimes(SamSolve *w, Vec time)
{
  const SamSolution *before = w->task->before;
  const double      *p0, *p;
  double            *t, most[2];

  PetscFunctionBegin;
  PetscCall(SamSolutionComputeGap(w->task->problem, before, w->separation, time));
  PetscCall(VecGetArrayRead(before->pressure, &p0));
  PetscCall(VecGetArrayRead(w->s->pressure, &p));
  PetscCall(VecGetArray(time, &t));
  PetscCall(MeasureTouching(w->task->grid, p0, p, t, most));
  for (PetscInt k = 0; k < w->task->grid->cells; k++) {
    const PetscBool touches = !SamIsPressed(p0[k]) && SamIsPressed(p[k]) && t[k] > 0;
    const double    outside = touches ? pow(t[k] / most[0], 2.0 / 3) : 0, inside = touches ? p[k] / most[1] : 1;

    t[k] = outside / (outside + inside * inside);
  }
  PetscCall(VecRestoreArray(time, &t));
  PetscCall(VecRestoreArrayRead(w->s->pressure, &p));
  PetscCall(VecRestoreArrayRead(before->pressure, &p0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes these times by the distance of the undeformed bodies in a step from no contact, in which all cells touch. */
static PetscErrorCode FindFirstTimes(SamSolve *w, Vec time)
{
  double *t, most = 0;

  PetscFunctionBegin;
  PetscCall(FindDistances(w, time));
  PetscCall(VecGetArray(time, &t));
  for (PetscInt k = 0; k < w->task->grid->cells; k++) most = PetscMax(most, t[k]);
  PetscCall(SamMax(w->task->grid->comm, 1, &most));
  for (PetscInt k = 0; k < w->task->grid->cells && most > 0; k++) t[k] = pow(t[k] / most, 1.5);
  PetscCall(VecRestoreArray(time, &t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the motion of the surfaces until they touched, from the slip of the solution so far. */
static PetscErrorCode AddTouching(SamSolve *w, Vec aside)
{
  const SamGrid   grid    = w->task->grid;
  const PetscBool touched = w->task->before && w->task->before->load[SAM_COMPONENT_N] > 0;
  SamIncrement    increment;
  const double   *t;
  double         *to;
  Vec             time;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &time));
  PetscCall((touched ? FindTimes : FindFirstTimes)(w, time));
  PetscCall(SamSolveDisplace(w));
  PetscCall(SamIncrementCreate(w->task->problem, w->task->before, w->s, &increment));
  PetscCall(VecGetArrayRead(time, &t));
  PetscCall(VecGetArray(aside, &to));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t first = (ptrdiff_t)j * grid->nx;

    SamIncrementComputeRow(&increment, j);
    for (PetscInt c = 0; c < 2; c++)
      for (PetscInt i = 0; i < grid->nx; i++)
        if (t[first + i] > 0) to[first + i + c * (ptrdiff_t)grid->cells] += t[first + i] * increment.row[c][i];
  }
  PetscCall(VecRestoreArray(aside, &to));
  PetscCall(VecRestoreArrayRead(time, &t));
  PetscCall(SamIncrementDestroy(&increment));
  PetscCall(VecDestroy(&time));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamSolveSetsAside(SamSolve *w)
{
  return !w->holds && (w->s->mid_step || Grows(w) || w->s->touches);
}

PetscErrorCode SamSolveSetAside(SamSolve *w, SamAsideFrom from)
{
  const PetscBool solved = from == SAM_ASIDE_SOLVED;
  Vec             aside;

  PetscFunctionBegin;
  if (!SamSolveSetsAside(w)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(w->task->grid, 2, &aside));
  if (w->s->mid_step && from == SAM_ASIDE_KEPT)
    PetscCall(SamCachedStepAddTurn(w->task->start.kept, w->task->grid, aside));
  else if (w->s->mid_step)
    PetscCall((solved ? SetTurn : PredictTurn)(w, aside));
  if (Grows(w)) PetscCall(SetEntering(w, solved, aside));
  if (solved && w->s->touches) PetscCall(AddTouching(w, aside));
  PetscCall(SamStateSetField(w->task->state, w->task->aside, &w->s->aside));
  PetscCall(VecCopy(aside, w->s->aside));
  PetscCall(VecDestroy(&aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

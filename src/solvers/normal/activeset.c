/*
  Projected preconditioned conjugate gradients on a changing active set.

  Problem: minimise p.S p/2 + h.p over the admissible p: 0 <= p <= H, in equilibrium (or with given rigid-body
  displacements). Its gradient is the gap g. H is the hardness, infinite for bodies that do not yield.

  Algorithm; an iteration takes one product:
    1. Set A: the cells where the pressure is, or will be, between its bounds. Cells without pressure that penetrate are
       in A; cells with little pressure that are about to part are not. Likewise at H: cells under H whose gap is open
       are in A, cells a little below H that penetrate are not. The pressure outside of A goes to the nearer bound. The
       rigid-body displacements (the multipliers of equilibrium) make the gap g on A smallest. The residual is -g on A.
    2. Direction: the preconditioned residual, plus the part of the last step that makes the two conjugate. Both stay
       meaningful when A changes, as the last step is the difference of two pressures, whose product is known.
    3. Trial: the pressure nearest to p + alpha times the direction, among those that are admissible, and at their
       bounds outside of A. alpha is the best length of the last iterations.
    4. The product of trial - p gives the best point between p and the trial, or beyond it as far as the bounds allow.
       When no cell meets a bound, this is the step of linear conjugate gradients. So p stays admissible, the energy
       falls in every step, thousands of cells enter and leave A without additional products, and conjugacy is kept.
  If a step ends at the part t < 1 of the way to the trial, cells that should reach a bound keep the part 1 - t of their
  distance to it, and all of their gap counts as error until a step comes within rounding of the bound.

  If the trial is uphill, or the error has not fallen for several iterations, the direction is the residual itself:
  projected gradient steps with the best length converge whatever steps lie between them, with one bound and with two.
  If no cell at a bound has a gap of 0, a finite number of them finds the right cells at each bound, and a linear system
  remains for conjugate gradients (Dostal, ch. 5). The iteration stops when |g| under pressure below H, -g where there
  is none, and g under H are below the tolerance, relative to the maximum displacement.

  Preconditioner: |k| on A minus half its loss. |k| = |k|' + loss on A, where |k|' is the energy of the differences of a
  field within A, and loss = |k| 1_A the energy of the jump of the field at the edge of A. The inverse of S on A lies
  between |k|' and |k|, as the field outside is free, not zero. At edges the loss grows like 1/distance, and |k|
  contains too much of it.

  Rounding: steps and their products are in single precision, at half the cost; p and g are in double. g collects
  rounding of about SAM_SINGLE_ROUNDING times the maximum error since the last product in double precision. Another such
  product is made before this rounding matters, and after a gradient step: its trial may be much farther away than the
  step, and p keeps the trial's rounding. Coarse grids, which are solved roughly, need none.

  References: Polonsky and Keer 1999, Wear 231, 206-219 (projected CG for contact); Dostal 2009, Optimal Quadratic
  Programming Algorithms, ch. 5 (active sets with CG); Stanley and Kato 1997, J. Tribol. 119, 481-485 (the spectrum);
  Bogdan, Burdzy and Chen 2003, Probab. Theory Relat. Fields 127, 89-152 (|k| on a part of the plane, with and without
  loss).
*/
#include "activesetimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <math.h>
#include <string.h>

/*
  Part of the loss that is subtracted, and part of A that may change before the loss is recomputed. After a gradient
  step any change counts: a cell that A has lost and regained leaves so large a loss in the cells beside it that the
  preconditioner of a long row is hardly positive there.
*/
#define LOSS_OFF 0.5
#define LOSS_OLD 0.01
/* A direction's least descent, relative to that of the preconditioned residual */
#define DESCENT 0.1
/*
  The trial's length follows the best length, by at most the square root of these factors per iteration. Under a stiff
  film the preconditioner is 8 to 16 times too strong: a length that falls too slowly, or is reset by a gradient step,
  would be cut at the bounds repeatedly. For bodies without layers it is about right, and 1 is a good start after a
  gradient step.
*/
#define FOLLOW 2.0
#define FALL   16.0
/* Iterations without progress before a gradient step, and before giving up because of rounding */
#define PATIENCE   10
#define STAGNATION 100

/* A change of the pressure, relative to the largest pressure, that is smaller than this is rounding, and no step. */
#define ROUNDING 1e-11

typedef SamActiveSet Work;

static PetscErrorCode CreateWork(SamSolver solver, SamLevel *level, Work *w)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(w, sizeof(*w)));
  w->solver  = solver;
  w->level   = level;
  w->frame   = &level->frame;
  w->nx      = level->grid->nx;
  w->rows    = level->grid->rows;
  w->cells   = level->grid->cells;
  w->most    = w->frame->most;
  w->alpha   = 1;
  w->layered = (PetscBool)!SamPairIsUniform(SamElasticityGetPair(w->level->elasticity));
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &w->self, NULL));
  PetscCall(SamGridCreateVec(level->grid, 1, &w->vg));
  PetscCall(VecGetArray(level->traction, &w->p));
  PetscCall(VecGetArrayRead(level->given[SAM_NORMAL_SEPARATION], &w->h));
  PetscCall(VecGetArray(w->vg, &w->g));
  w->blocks = SamRowBlocks(level->grid);
  PetscCall(PetscCalloc2(w->rows * w->blocks, &w->busy, w->rows * w->blocks, &w->open));
  PetscCall(SamAllocate(sizeof(*w->z) * 5 * (size_t)w->cells, &w->z));
  w->active = w->z + w->cells;
  w->s      = w->active + w->cells;
  w->u      = w->s + w->cells;
  w->loss   = w->u + w->cells;
  PetscCall(PetscArrayzero(w->s, 3 * w->cells));
  PetscCall(PetscMalloc1(w->nx, &w->xi));
  for (PetscInt i = 0; i < w->nx; i++) w->xi[i] = (float)(w->frame->xi0 + (double)i * w->frame->dxi);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->traction, &w->p));
  PetscCall(VecRestoreArrayRead(w->level->given[SAM_NORMAL_SEPARATION], &w->h));
  PetscCall(VecRestoreArray(w->vg, &w->g));
  PetscCall(VecDestroy(&w->vg));
  PetscCall(PetscFree2(w->busy, w->open));
  SamFree(w->z); /* together with the arrays behind it */
  PetscCall(PetscFree(w->xi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- direction ---- */

/* Computes the loss, |k| 1_A, if A has changed since the last time. */
static PetscErrorCode UpdateLoss(Work *w)
{
  double changed = 0;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) changed += SamActiveSetCountChanged(w, SamActiveSetRow(w, j));
  PetscCall(SamSum(w->level->grid->comm, 1, &changed));
  if (changed <= (w->from_gradient ? 0 : LOSS_OLD * w->gram[0])) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLevelPreconditionSingle(w->solver, w->level, w->self, w->active, w->loss));
  for (PetscInt j = 0; j < w->rows; j++) SamActiveSetLossRow(w, SamActiveSetRow(w, j), (float)LOSS_OFF);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the next busy cells of row j: see SamNextBusy(). Starts with a row whose end is column 0. */
static PetscBool NextBusy(const Work *w, PetscInt j, PetscInt *end, SamRow *row)
{
  PetscInt first;

  if (!SamNextBusy(w->busy + (ptrdiff_t)j * w->blocks, w->nx, &first, end)) return PETSC_FALSE;
  *row = SamFrameRow(w->frame, j, first, *end);
  return PETSC_TRUE;
}

/* Finds the next busy cells of row j in the same way, by single blocks. */
static PetscBool NextBusyStretch(const Work *w, PetscInt j, PetscInt *next, SamRow *row)
{
  const char *busy = w->busy + (ptrdiff_t)j * w->blocks;
  PetscInt    i    = *next;

  while (i < w->nx && !busy[i / SAM_ROW_BLOCK]) i += SAM_ROW_BLOCK;
  if (i >= w->nx) return PETSC_FALSE;
  *next = i + SAM_ROW_BLOCK;
  *row  = SamFrameRow(w->frame, j, i, PetscMin(i + SAM_ROW_BLOCK, w->nx));
  return PETSC_TRUE;
}

static PetscErrorCode ComputeResidual(Work *w)
{
  SamRow row;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(w->z, w->cells));
  for (PetscInt j = 0; j < w->rows; j++)
    for (PetscInt end = 0; NextBusy(w, j, &end, &row);) SamActiveSetResidualRow(w, row);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets z = M r on A, from M r everywhere; sums z and u with the phi, z.r, z.u, s.r. */
#define PRODUCTS 9
enum { Z_PHI = 0, U_PHI = 3, Z_R = 6, Z_U = 7, S_R = 8 };

static PetscErrorCode ComputeProducts(Work *w, double sums[PRODUCTS])
{
  SamTotal totals[PRODUCTS] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const double     eta = SamFrameEta(w->frame, j);
    SamDirectionSums s   = {0};
    SamRow           row;

    for (PetscInt next = 0; NextBusyStretch(w, j, &next, &row);) SamActiveSetPreconditionedRow(w, row, &s);
    SamAddAll(PRODUCTS, totals,
              (const double[PRODUCTS]){s.z, -eta * s.z, s.z_turn, s.u, -eta * s.u, s.u_turn, s.zr, s.zu, s.sr});
  }
  PetscCall(SamSumTotals(w->level->grid->comm, PRODUCTS, totals, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 2: z = P M r + beta s on A, conjugate to the last step. */
static PetscErrorCode NewDirection(Work *w)
{
  double sums[PRODUCTS], a[3], beta = 0;
  SamRow row;

  PetscFunctionBegin;
  PetscCall(UpdateLoss(w));
  PetscCall(ComputeResidual(w));
  PetscCall(SamLevelPreconditionSingle(w->solver, w->level, w->self, w->z, w->z));
  PetscCall(ComputeProducts(w, sums));
  SamFrameSolve(w->frame, w->gram, sums + Z_PHI, a);
  if (w->curvature > 0) beta = -(sums[Z_U] - SamFrameDot(a, sums + U_PHI)) / w->curvature;
  if (!(beta > 0) || sums[Z_R] + beta * sums[S_R] < DESCENT * sums[Z_R]) beta = 0;
  for (PetscInt j = 0; j < w->rows; j++)
    for (PetscInt end = 0; NextBusy(w, j, &end, &row);) SamActiveSetDirectionRow(w, row, a, (float)beta);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- trial and step ---- */

/*
  Step 3: p becomes the admissible pressure on A nearest to p + alpha z; s is the step to it. `motion`: if z is -g, the
  correction of the rigid-body displacements that the projection implies.
*/
static PetscErrorCode Try(Work *w, double alpha, PetscBool nearest, double motion[3], PetscBool *found)
{
  const double    pressure = w->unit / w->self;
  SamPressureStep step     = {.mask    = w->active,
                              .busy    = w->busy,
                              .step    = w->z,
                              .by      = alpha * pressure,
                              .nearest = nearest,
                              .made    = w->s,
                              .scale   = 1 / pressure};
  SamTotal        total    = {0};
  SamRow          row;
  double          most[2];

  PetscFunctionBegin;
  PetscCall(SamFrameProjectNormalStep(w->frame, &step, w->p, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  w->shrink = w->largest = 0;
  for (PetscInt j = 0; j < w->rows; j++) {
    double sum = 0;

    for (PetscInt end = 0; NextBusy(w, j, &end, &row);) sum += SamActiveSetTrialRow(w, row);
    SamAdd(&total, sum);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, &w->slope));
  most[0] = w->shrink;
  most[1] = w->largest;
  PetscCall(SamMax(w->level->grid->comm, 2, most));
  w->shrink  = most[0];
  w->largest = most[1];
  w->slope /= w->unit;
  if (fabs(w->slope) <= ROUNDING * w->largest / pressure) w->slope = 0;
  for (PetscInt c = 0; c < 3; c++) motion[c] = step.motion[c] * w->self / alpha;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Makes a step of the projected gradient, along -g on all cells, as cells of A alone may have no other pressure in
  equilibrium. It is downhill unless the pressure is the solution. Its length fits modes as long as the contact.
*/
static PetscErrorCode TryGradient(Work *w, double motion[3], PetscBool *found)
{
  double most = 0;

  PetscFunctionBegin;
  (void)memset(w->busy, 1, (size_t)(w->rows * w->blocks)); /* cells may enter anywhere */
  for (PetscInt k = 0; k < w->cells; k++) {
    w->active[k] = 1;
    most         = PetscMax(most, w->p[k]);
  }
  PetscCall(SamMax(w->level->grid->comm, 1, &most));
  PetscCall(ComputeResidual(w));
  PetscCall(Try(w, most / PetscMax(w->displacement, w->unit) * w->self, PETSC_TRUE, motion, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes back from the trial to the length t of the step instead of 1; computes the totals over the cells between
   bounds. */
static void SetLength(Work *w, double t, SamTotal contact[])
{
  for (PetscInt j = 0; j < w->rows; j++) {
    SamGapSums sums = {0};
    SamRow     row;

    for (PetscInt end = 0; NextBusy(w, j, &end, &row);) SamActiveSetStepRow(w, row, t, &sums);
    for (PetscInt i = 0, block = j * w->blocks; i < w->nx; i += SAM_ROW_BLOCK, block++) {
      if (w->busy[block]) continue;
      w->open[block] = SamActiveSetOpenRow(w, SamFrameRow(w->frame, j, i, PetscMin(i + SAM_ROW_BLOCK, w->nx)), t);
    }
    SamActiveSetAddRow(sums, SamFrameEta(w->frame, j), contact);
  }
}

/* Computes the curvature s.u. */
static PetscErrorCode ComputeCurvature(Work *w)
{
  SamTotal total = {0};
  SamRow   row;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    double sum = 0;

    for (PetscInt next = 0; NextBusyStretch(w, j, &next, &row);) sum += SamActiveSetCurvatureRow(w, row);
    SamAdd(&total, sum);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, &w->curvature));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Step 4: finds the length of least energy between the start of the step and the point where a pressure meets a bound.
  `best`: the length without that bound. A step that displaces nothing (periodic bodies under one more uniform pressure)
  goes as far as the bounds allow.
*/
static PetscErrorCode Step(Work *w, double *best, SamTotal contact[])
{
  double t;

  PetscFunctionBegin;
  PetscCall(SamLevelApplySingle(w->solver, w->level, 1 / w->self, w->s, w->u));
  PetscCall(ComputeCurvature(w));
  *best = w->curvature > 0 ? PetscMax(-w->slope / w->curvature, 0) : 0;
  if (*best == 0 && isfinite(w->most) && w->slope < 0) *best = 1 / w->shrink;
  t = *best * w->shrink > 1 ? 1 / w->shrink : *best;
  SetLength(w, t, contact);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the method ---- */

/*
  Ends the iterations, as the trial differs from the pressure only by rounding. Two errors may remain: cells with
  pressures as small as rounding, which the trial separates, and the motion, which A does not determine if it has few
  cells. `better`: true if the error has fallen.
*/
static PetscErrorCode TakeTrial(Work *w, const double motion[3], PetscBool *better)
{
  SamTotal ignored[SAM_GAP_TOTALS] = {{0}};

  PetscFunctionBegin;
  SetLength(w, 1, ignored);
  for (PetscInt c = 0; c < 3; c++) w->motion[c] += motion[c];
  PetscCall(SamActiveSetRefresh(w));
  *better = w->error < w->unit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Tries again after a trial that was uphill. Cells that it would have taken beyond a bound stayed there, while the cells
  beside them moved as if they had gone on. So those leave A, and go to their bound, whose own pressure cannot make up
  for their gap.
*/
static PetscErrorCode TryWithoutClipped(Work *w, double motion[3], PetscBool *found)
{
  SamTotal ignored[SAM_GAP_TOTALS] = {{0}};

  PetscFunctionBegin;
  SetLength(w, 0, ignored);
  PetscCall(SamActiveSetChoose(w, 1, NULL));
  w->curvature = 0; /* the last step counts no more */
  PetscCall(NewDirection(w));
  PetscCall(Try(w, w->alpha, PETSC_FALSE, motion, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Makes one iteration. `gradient`: it makes a gradient step; on return also true if it had to resort to one. `downhill`:
  the energy or the error could be reduced. `found`: an admissible pressure was found.
*/
static PetscErrorCode Iterate(Work *w, PetscBool *gradient, PetscBool *downhill, PetscBool *found)
{
  SamTotal contact[SAM_GAP_TOTALS] = {{0}}, ignored[SAM_GAP_TOTALS] = {{0}};
  double   best = 0, motion[3];

  PetscFunctionBegin;
  w->unit = w->error;
  if (!*gradient) {
    PetscCall(NewDirection(w));
    PetscCall(Try(w, w->alpha, PETSC_FALSE, motion, found));
    if (*found && w->slope > 0) PetscCall(TryWithoutClipped(w, motion, found));
    *gradient = (PetscBool)(!*found || w->slope >= 0);
    if (*found && *gradient) SetLength(w, 0, ignored);
  }
  if (*gradient) PetscCall(TryGradient(w, motion, found));
  w->from_gradient = *gradient;
  *downhill        = PETSC_FALSE;
  if (*found && w->slope == 0) PetscCall(TakeTrial(w, motion, downhill));
  if (!*found || w->slope == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Step(w, &best, contact));
  *downhill = best > 0;
  if (!*downhill) PetscFunctionReturn(PETSC_SUCCESS);
  if (!*gradient)
    w->alpha *= sqrt(PetscMin(PetscMax(best, 1 / (w->layered ? FALL : FOLLOW)), FOLLOW));
  else
    w->alpha = 1;
  PetscCall(SamActiveSetChoose(w, SAM_PATCH, contact));
  PetscCall(SamLevelIterated(w->solver, w->level, w->error / w->displacement));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Determines the reason to stop, if there is one. */
static PetscErrorCode GetReason(Work *w, PetscInt stagnant, PetscBool downhill, PetscBool found,
                                SamSolverReason *reason)
{
  PetscBool solved;

  PetscFunctionBegin;
  *reason = SAM_SOLVER_ITERATING;
  if (!found)
    *reason = SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  else if (!isfinite(w->error))
    *reason = SAM_SOLVER_DIVERGED_NAN;
  if (*reason) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamActiveSetIsSolved(w, &solved));
  if (solved)
    *reason = SAM_SOLVER_CONVERGED_RTOL;
  else if (SamLevelAtMaxIterations(w->solver, w->level))
    *reason = SAM_SOLVER_DIVERGED_ITS;
  else if (stagnant > STAGNATION || !downhill)
    *reason = SAM_SOLVER_DIVERGED_STAGNATED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamNormalSolve_ActiveSet(SamSolver solver, SamLevel *level)
{
  Work            w;
  SamFrame        given;
  double          best;
  PetscInt        stagnant = 0;
  PetscBool       downhill = PETSC_TRUE, found = PETSC_TRUE;
  SamSolverReason reason;

  PetscFunctionBegin;
  PetscCall(CreateWork(solver, level, &w));
  /* A start with its product also has its motion, which A may not determine. */
  PetscCall(SamFrameSetGiven(&given, level->grid, level->balance));
  PetscCall(PetscArraycpy(w.motion, SamLevelHasProduct(level) ? given.fixed : level->frame.fixed, 3));
  PetscCall(SamActiveSetStart(&w));
  SamLevelForgetProduct(level);
  best = w.error;
  PetscCall(GetReason(&w, stagnant, downhill, found, &reason));
  while (!reason) {
    PetscBool gradient = (PetscBool)(stagnant > 0 && stagnant % PATIENCE == 0);

    PetscCall(Iterate(&w, &gradient, &downhill, &found));
    if (downhill && (gradient || SamActiveSetIsStale(&w))) PetscCall(SamActiveSetRefresh(&w));
    stagnant = w.error < 0.9 * best ? 0 : stagnant + 1;
    best     = PetscMin(best, w.error);
    PetscCall(GetReason(&w, stagnant, downhill, found, &reason));
  }
  if (isfinite(w.error)) PetscCall(SamActiveSetKeepProduct(&w));
  /* The steps keep equilibrium only to the rounding of single precision. */
  if (found) PetscCall(SamFrameProjectNormalBetween(w.frame, w.p, &found));
  solver->reason = reason;
  solver->error  = w.error / w.displacement;
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = w.motion[c];
  PetscCall(DestroyWork(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalCreate_ActiveSet(SamSolver solver)
{
  PetscFunctionBegin;
  solver->ops.solve       = SamNormalSolve_ActiveSet;
  solver->keeps_product   = PETSC_TRUE;
  solver->limits_pressure = PETSC_TRUE;
  solver->default_levels  = PETSC_MAX_INT;
  solver->default_max_it  = 1000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

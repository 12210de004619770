/*
  Newton's method and conjugate gradients in one, with changing stick and slip.

  Problem: minimise q.C q/2 + offset.q over the discs |q| <= b in equilibrium (or with given rigid-body displacements).
  Its gradient is the slip increment s. It is strictly convex, so there is one solution.

  Algorithm; an iteration takes one product:
    1. Sets: cells that are or should be on their circle, with s against q, slip; the others stick. The unknowns are
       both components of q in stick, and the component along the circle in slip; P projects onto them. The stiffness of
       a slipping cell comes from the curvature of its circle: L = |s|/b, from 0 to 1e6 times its self-influence c. So a
       cell has the weight h = c/(c + L), which is 1 in stick: G = sum h phi'P phi is what the motion (the multipliers
       of equilibrium) would be fitted with if C were diagonal, and the motion solves G a = sum h phi'P s. (With weights
       1 the fit would turn soft and stiff cells alike, and near sliding, where almost all cells are stiff, no direction
       would be downhill.) Sets and motion depend on each other and are found in turn. The residual is -P s, its
       derivative P(C + L)P.
    2. Direction: the preconditioned residual, plus the part of the last step that makes the two conjugate. Both stay
       meaningful when the sets change, as the last step is the difference of two shears, whose product is known. From
       both the part that would carry a load, along h P phi, is subtracted. The preconditioner is P(w M w + (1 - h)/2(L
       + c))P, with M the spectral inverse of C, and w = sqrt(h).
    3. Trial: the admissible shear nearest to q + alpha times the direction, discs and equilibrium at once
       (SamFrameProjectTangential), after the slipping cells have been pushed outward. alpha is the length that was best
       in the last iterations.
    4. The product of trial - q gives the length of the step, at most to the trial: the one that leaves the residual
       normal to it, as in linear conjugate gradients, unless the energy falls much farther. Cells that slip are then a
       little within their circles, by the square of the step, and the next trial puts them back.
  If the trial is uphill, or the error has not fallen for several iterations, the trial is the projected gradient in the
  metric 1/h, the admissible shear nearest to q - h s/c; steps of the best length towards it converge whatever steps lie
  between them. The iteration stops on the residual of q = D(q - s/c), which is zero at the solution only.

  Rounding: steps and their products are in single precision, at half the cost; q and s are in double. The slip is
  recomputed in double precision before rounding matters.

  References: Dostal and Kucera 2010, SIAM J. Optim. 20, 2913 (separable convex constraints); Alart and Curnier 1991,
  CMAME 92, 353 (semi-smooth Newton for friction). The classical alternative is Wang, Jin, Zhang and Keer 2010.
*/
#include "newtonimpl.h"
#include <math.h>

/*
  |s|/(c b) from which a cell turns at once, if the error, which counts such a cell by its bound, is at most SURE: then
  the others cannot bring it to stick. Cells that turn each other to and fro would do so for ever: after MOST_TURNS
  sweeps they come to rest as all others do.
*/
#define TURNS      8
#define SURE       0.1
#define MOST_TURNS 20
/* A direction's least descent, relative to that of the preconditioned residual */
#define DESCENT 0.1
/*
  The first trial's length. Later trials are LONGER than the best step, as steps go at most to the trial, and change by
  at most the root of FOLLOW per iteration, after at most HALVINGS. The values were chosen by counting iterations; other
  values near these change the counts by a few per cent.
*/
#define FIRST_LENGTH 0.85
#define LONGER       1.2
#define HALVINGS     3
#define FOLLOW       2.0
/* Least and largest length of a step, relative to the length of least energy, if these bound the step */
#define LEAST_PART   0.5
#define LARGEST_PART 1.8
/* Rounding of the slip, relative to the error, above which the slip is recomputed */
#define DOUBT 0.2
/* The least unit of slip, relative to the displacement by the shear, since the residual may be zero */
#define LEAST_UNIT 1e-13
/* Rounding of energies, relative to the frictional work in them */
#define ENERGY_ROUNDING 1e-14
/*
  Number of times that sets and motion, which depend on each other, are found in turn in an iteration, unless the motion
  changes by less than STEADY of the maximum slip. In the coupling iterations of dissimilar bodies, which set the
  tolerance, this criterion is not used: there the rest of the motion's error would be taken for a change of the shear.
*/
#define SWEEPS 2
#define STEADY 0.3
/* A relative change of the shear below this is rounding. */
#define STILL 1e-12
/*
  Iterations without progress before the motion is determined in another way (SHIFT), before a gradient step (PATIENCE),
  and before the solver gives up (STAGNATION)
*/
#define SHIFT 2
/* Change of the motion, relative to the maximum residual, above which the fit does not determine the motion */
#define OPEN       2
#define PATIENCE   10
#define STAGNATION 100
/* The same on a coarse grid, whose solution is only a start */
#define COARSE_STAGNATION 20
/* Most times that a motion which the fit did not determine makes the errors before it meaningless */
#define REOPENS 5

typedef SamNewton Work;

#define SPACE    ((PetscInt)(sizeof(SamNewtonSpace) / sizeof(double)))
#define PRODUCTS ((PetscInt)(sizeof(SamNewtonProducts) / sizeof(double)))

/* ---- fields ---- */

/* Computes the root of the number of cells in contact. */
static PetscErrorCode FindReach(Work *w)
{
  const SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  w->reach = 0;
  for (PetscInt k = 0; k < u->cells; k++) w->reach += u->bound[k] > 0;
  PetscCall(SamSum(u->level->grid->comm, 1, &w->reach));
  w->reach = sqrt(w->reach);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamSolver solver, SamLevel *level, Work *w)
{
  const SamFrame *f = &level->frame;
  PetscInt        cells;

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, SAM_RUN_GAP, &w->base));
  cells = w->base.cells;
  PetscCall(SamAllocateZeros(sizeof(*w->trial) * 2 * (size_t)cells, &w->trial));
  PetscCall(SamAllocateZeros(sizeof(*w->weight) * 11 * (size_t)cells, &w->weight));
  w->normal = w->weight + cells;
  w->r      = w->normal + 2 * cells;
  w->z      = w->r + 2 * cells;
  w->step   = w->z + 2 * cells;
  w->u      = w->step + 2 * cells;
  PetscCall(PetscMalloc1(w->base.nx, &w->xi));
  for (PetscInt i = 0; i < w->base.nx; i++) w->xi[i] = (float)(f->xi0 + (double)i * f->dxi);
  PetscCall(FindReach(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Work *w)
{
  PetscFunctionBegin;
  SamFree(w->trial);
  SamFree(w->weight); /* together with the arrays behind it */
  PetscCall(PetscFree(w->xi));
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the steps ---- */

typedef void (*RowSums)(const SamNewton *w, SamRow row, double sums[]);

/* Computes the sums of a loop over all rows, at most PRODUCTS, in twice the digits. */
static PetscErrorCode SumRows(const Work *w, RowSums add, PetscInt n, double sums[])
{
  const SamStickSlip *u                = &w->base;
  SamTotal            totals[PRODUCTS] = {{0}};
  SamRow              run;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[PRODUCTS] = {0};

    for (PetscInt k = 0; SamStickSlipNext(u, j, &k, &run);) add(w, run, row);
    SamAddAll(n, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, n, totals, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes a step of length t and subtracts the motion a, chooses the sets, and sums over their tangent space. */
static PetscErrorCode ChooseSets(Work *w, double t, const double a[3], SamNewtonSpace *space, double *most)
{
  SamStickSlip *u             = &w->base;
  SamTotal      totals[SPACE] = {{0}};
  SamRow        run;

  PetscFunctionBegin;
  *most = 0;
  for (PetscInt j = 0; j < u->rows; j++) {
    SamNewtonSpace row = {0};

    for (PetscInt n = 0; SamStickSlipNext(u, j, &n, &run);) {
      const double largest = SamNewtonAdvanceRow(w, run, t, t * w->unit, a, &row);

      *most = PetscMax(*most, largest);
    }
    SamAddAll(SPACE, totals, (const double *)&row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, SPACE, totals, (double *)space));
  PetscCall(SamMax(u->level->grid->comm, 1, most));
  PetscCall(PetscArraycpy(w->gram, space->gram, SAM_GRAM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Step 1, after a step of length t: computes the sets, the Gram matrix of the tangent space, the unit, the motion that
  fits best, the residual and the error.
*/
static PetscErrorCode Advance(Work *w, double t)
{
  SamStickSlip  *u                    = &w->base;
  SamTotal       squares[SAM_SQUARES] = {{0}};
  SamNewtonSpace space;
  double         most = 0, a[3] = {0, 0, 0};
  SamRow         run;

  PetscFunctionBegin;
  w->turns_from = u->error <= SURE && w->turned++ < MOST_TURNS ? TURNS * u->self * TURNS * u->self : PETSC_INFINITY;
  for (PetscInt sweep = 0; sweep < SWEEPS; sweep++) {
    PetscCall(ChooseSets(w, sweep ? 0 : t, a, &space, &most));
    SamFrameSolve(u->frame, w->gram, space.slip, a);
    for (PetscInt c = 0; c < 3; c++) u->motion[c] += a[c];
    if (!u->solver->enough && fabs(a[0]) + fabs(a[1]) + fabs(a[2]) <= STEADY * most) break; /* the same on all ranks */
  }
  for (PetscInt j = 0; u->level->product && t > 0 && j < u->rows; j++) SamNewtonOutsideRow(w, j, t * w->unit);
  w->unit = PetscMax(most, LEAST_UNIT * u->self * u->scale);
  if (w->unit == 0) w->unit = 1;
  w->work = space.work;
  SamStickSlipClearMargins(u, w->z);
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[SAM_SQUARES] = {0};

    for (PetscInt n = 0; SamStickSlipNext(u, j, &n, &run);) SamNewtonResidualRow(w, run, 1 / w->unit, a, row);
    SamAddAll(SAM_SQUARES, squares, row);
  }
  PetscCall(SamStickSlipSetError(u, squares));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 2: z = P M r + beta P step, conjugate to the last step. */
static PetscErrorCode NewDirection(Work *w)
{
  SamStickSlip     *u = &w->base;
  SamNewtonProducts sums;
  double            a[3], a_step[3], zv, ev, beta = 0;
  SamRow            run;

  PetscFunctionBegin;
  PetscCall(SamLevelPreconditionSingle(u->solver, u->level, u->self, w->z, w->z));
  PetscCall(SumRows(w, SamNewtonPreconditionedRow, PRODUCTS, (double *)&sums));
  /* Both are made orthogonal to the phi: sum phi'(z - h P phi a) = 0. */
  SamFrameSolve(u->frame, w->gram, sums.z, a);
  SamFrameSolve(u->frame, w->gram, sums.e, a_step);
  zv = sums.zv - SamFrameDot(a, sums.v);
  ev = sums.ev - SamFrameDot(a_step, sums.v);
  if (ev > 0) beta = -zv / ev;
  if (!(beta > 0) || sums.zr + beta * sums.er < DESCENT * sums.zr) beta = 0;
  for (PetscInt c = 0; c < 3; c++) a[c] += beta * a_step[c];
  for (PetscInt j = 0; j < u->rows; j++)
    for (PetscInt n = 0; SamStickSlipNext(u, j, &n, &run);) SamNewtonDirectionRow(w, run, a, (float)beta);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Replaces the trial by an admissible shear near it; with weights, by the nearest one in their metric. Computes the step
  to it, and its products.
*/
static PetscErrorCode Project(Work *w, const float weight[], double motion[3], PetscBool *found)
{
  SamStickSlip *u = &w->base;
  double        sums[4];

  PetscFunctionBegin;
  PetscCall(SamFrameProjectTangential(u->frame, &u->runs, u->bound, weight, weight != NULL, w->trial, motion, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SumRows(w, SamNewtonChangeRow, 4, sums));
  w->slope = sums[0] / w->unit;
  w->along = sums[1];
  w->bend  = sums[2];
  w->size  = sums[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Does the same along the slip itself, in the metric 1/h, in which stiff cells turn as little as in Newton's method.
  Descent is guaranteed only with the nearest projection. `motion`: the correction that the projection implies, by which
  the motion falls short of.
*/
static PetscErrorCode TryGradient(Work *w, double motion[3], PetscBool *found)
{
  SamStickSlip *u = &w->base;
  SamRow        run;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++)
    for (PetscInt n = 0; SamStickSlipNext(u, j, &n, &run);) SamNewtonGradientRow(w, run);
  PetscCall(Project(w, w->z, motion, found));
  for (PetscInt c = 0; c < 3; c++) motion[c] *= u->self;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the step changes the energy by less than the rounding of the frictional work in it. */
static PetscBool IsRounding(const Work *w)
{
  return fabs(w->slope) * w->unit * w->unit / w->base.self <= ENERGY_ROUNDING * w->work;
}

static PetscBool IsDownhill(const Work *w)
{
  /* The trial is the shear itself, within rounding. */
  if (sqrt(w->size) * w->unit / w->base.self <= STILL * w->base.scale) return PETSC_FALSE;
  return IsRounding(w) ? w->along > 0 : w->slope < 0;
}

static void SetTrial(Work *w, double alpha)
{
  SamRow run;

  for (PetscInt j = 0; j < w->base.rows; j++)
    for (PetscInt n = 0; SamStickSlipNext(&w->base, j, &n, &run);) SamNewtonTrialRow(w, run, alpha);
}

/*
  Step 3. A trial that is uphill may be too long, and shorter ones cost no product. `downhill`: a trial is downhill.
  `found`: there is an admissible shear near it.
*/
static PetscErrorCode Try(Work *w, PetscBool *downhill, PetscBool *found)
{
  double alpha = w->alpha;

  PetscFunctionBegin;
  *downhill = PETSC_FALSE;
  *found    = PETSC_TRUE;
  for (PetscInt halving = 0; halving <= HALVINGS && *found && !*downhill; halving++, alpha *= 0.5) {
    SetTrial(w, alpha);
    PetscCall(Project(w, NULL, NULL, found));
    *downhill = *found && IsDownhill(w);
    if (*downhill) w->alpha = alpha;
    if (w->along <= 0 || w->whole) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Step 4, and step 1 of the next iteration. `best` is the length of the step that would leave the residual normal to it
  if the step followed the circles; `least` that of least energy on the straight line to the trial, which is admissible.
*/
static PetscErrorCode Step(Work *w, double *best)
{
  SamStickSlip *u = &w->base;
  double        sums[2], least, t;

  PetscFunctionBegin;
  PetscCall(SamLevelApplySingle(u->solver, u->level, 1 / u->self, w->step, w->u));
  PetscCall(SumRows(w, SamNewtonCurvatureRow, 2, sums));
  *best    = w->along / (sums[0] + w->bend);
  least    = -w->slope / sums[0];
  t        = IsRounding(w) ? *best : PetscMin(PetscMax(*best, LEAST_PART * PetscMin(1, least)), LARGEST_PART * least);
  t        = w->whole ? 1 : PetscMin(1, t);
  w->whole = PETSC_FALSE;
  w->rounding += SAM_SINGLE_ROUNDING * t * sqrt(sums[1]) * w->unit / u->self;
  PetscCall(Advance(w, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns an upper bound of the error, rounding included. */
static double Error(const Work *w)
{
  return w->base.error + (w->rounding > 0 ? w->rounding / w->base.scale : 0);
}

/* Recomputes the slip if its rounding matters. */
static PetscErrorCode Refresh(Work *w)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  if (w->rounding <= DOUBT * PetscMax(u->error, u->level->rtol) * u->scale) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(Advance(w, 0));
  w->rounding = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamSolverReason Reason(const Work *w, PetscInt stagnant)
{
  const SamStickSlip *u    = &w->base;
  const PetscInt      most = u->level->depth == 0 ? STAGNATION : COARSE_STAGNATION;

  if (!isfinite(u->error)) return SAM_SOLVER_DIVERGED_NAN;
  if (Error(w) <= u->level->rtol) return SAM_SOLVER_CONVERGED_RTOL;
  if (SamLevelAtMaxIterations(u->solver, u->level)) return SAM_SOLVER_DIVERGED_ITS;
  return stagnant > most ? SAM_SOLVER_DIVERGED_STAGNATED : SAM_SOLVER_ITERATING;
}

/*
  Adds the correction of the projected gradient to the motion if that lowers the error, or is so large that the fit
  cannot have determined it: if cells slip along one line, as at nu = 0, and few stick, the residual does not depend on
  the distance. Then all cells seem to slip, and no shear would change that. `best` is the least error so far, which
  means nothing after that; but not for ever, as each time the count of iterations without progress begins anew.
*/
static PetscErrorCode Shift(Work *w, double *best)
{
  SamStickSlip  *u     = &w->base;
  const double   error = u->error;
  double         unit  = w->unit;
  SamNewtonSpace space;
  double         motion[3], most;
  PetscBool      found;

  PetscFunctionBegin;
  PetscCall(TryGradient(w, motion, &found));
  for (PetscInt attempt = 0; found && attempt < 2; attempt++) { /* forward, and back if the error did not fall */
    for (PetscInt c = 0; c < 3; c++) u->motion[c] += motion[c];
    PetscCall(ChooseSets(w, 0, motion, &space, &most));
    PetscCall(Advance(w, 0));
    if (u->error < error) break;
    if (attempt == 0 && fabs(motion[0]) + fabs(motion[1]) + fabs(motion[2]) > OPEN * unit) {
      if (w->reopened++ < REOPENS) *best = u->error;
      break;
    }
    for (PetscInt c = 0; c < 3; c++) motion[c] = -motion[c];
  }
  *best = PetscMin(*best, u->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Ends with the present shear. Only the motion may still be wrong: its fit does not determine it if few cells are in
  contact, or all slip. `better`: the error has fallen.
*/
static PetscErrorCode MoveOnly(Work *w, const double motion[3], PetscBool *better)
{
  SamStickSlip *u     = &w->base;
  const double  error = u->error;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) u->motion[c] += motion[c];
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(Advance(w, 0));
  w->rounding = 0;
  *better     = u->error < error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes one iteration. `downhill`: energy or error could be reduced. `found`: an admissible shear was found. */
static PetscErrorCode Iterate(Work *w, PetscBool gradient, PetscBool *downhill, PetscBool *found)
{
  SamStickSlip *u    = &w->base;
  double        best = 0, motion[3];

  PetscFunctionBegin;
  if (!gradient) {
    PetscCall(NewDirection(w));
    PetscCall(Try(w, downhill, found));
    gradient = *downhill || w->whole ? PETSC_FALSE : PETSC_TRUE;
  }
  if (gradient) PetscCall(TryGradient(w, motion, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  if (!IsDownhill(w) && !w->whole) { /* the projected gradient is downhill, unless it is rounding */
    PetscCall(MoveOnly(w, motion, downhill));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *downhill = PETSC_TRUE;
  PetscCall(Step(w, &best));
  if (!gradient) w->alpha *= sqrt(PetscMin(PetscMax(LONGER * best, 1 / FOLLOW), FOLLOW));
  PetscCall(Refresh(w));
  PetscCall(SamLevelIterated(u->solver, u->level, u->error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves slipping cells onto their circles: steps of less than full length leave them a little inside. */
static PetscErrorCode Finish(Work *w, PetscBool *found)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  SetTrial(w, 0);
  PetscCall(Project(w, NULL, NULL, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  /* The slip is still that of the shear before: the step changes s/c by no more than this. */
  w->rounding += (1 + w->reach) * sqrt(w->size) * w->unit / u->self;
  PetscCall(PetscArraycpy(u->q, w->trial, 2 * u->cells));
  if (u->solver->enough || Error(w) > u->level->rtol) PetscCall(Refresh(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the start, from its product if that is known; the shear may then lie outside of the discs. `found` is false
  if no admissible shear is found.
*/
static PetscErrorCode Start(Work *w, PetscBool *found)
{
  SamLevel *level = w->base.level;

  PetscFunctionBegin;
  w->whole = SamLevelHasProduct(level);
  if (w->whole) w->rounding = level->product->rounding;
  PetscCall(SamStickSlipStart(&w->base));
  SamLevelForgetProduct(level);
  PetscCall(Advance(w, 0));
  PetscCall(Refresh(w));
  if (!w->whole || Error(w) > level->rtol) PetscFunctionReturn(PETSC_SUCCESS);
  w->whole = PETSC_FALSE;
  PetscCall(Finish(w, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamTangentialSolve_Newton(SamSolver solver, SamLevel *level)
{
  Work            w = {.alpha = FIRST_LENGTH};
  SamStickSlip   *u = &w.base;
  SamSolverReason reason;
  double          best;
  PetscInt        stagnant = 0;
  PetscBool       found    = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(Create(solver, level, &w));
  PetscCall(Start(&w, &found));
  best   = u->error;
  reason = found ? Reason(&w, stagnant) : SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  if (!reason && solver->effort == SAM_EFFORT_WARM && u->error > SAM_NEAR) reason = SAM_SOLVER_DIVERGED_ITS;
  while (!reason) {
    const PetscBool gradient = stagnant > 0 && stagnant % PATIENCE == 0, whole = w.whole;
    PetscBool       downhill = PETSC_TRUE;

    PetscCall(Iterate(&w, gradient, &downhill, &found));
    if (downhill && Error(&w) <= level->rtol) PetscCall(Finish(&w, &found));
    if (!downhill || !found) { /* unless the start was not admissible, the loads can be carried */
      reason = whole ? SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM : SAM_SOLVER_DIVERGED_STAGNATED;
      break;
    }
    stagnant = u->error < 0.9 * best ? 0 : stagnant + 1;
    best     = PetscMin(best, u->error);
    if (stagnant > 0 && stagnant % SHIFT == 0) {
      PetscCall(Shift(&w, &best));
      if (Error(&w) <= level->rtol) PetscCall(Finish(&w, &found));
    }
    reason = found ? Reason(&w, stagnant) : SAM_SOLVER_DIVERGED_STAGNATED;
  }
  solver->reason = reason;
  solver->error  = Error(&w);
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = u->motion[c];
  if (level->product && isfinite(u->error)) PetscCall(SamStickSlipKeepProduct(u, w.rounding));
  PetscCall(Destroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialCreate_Newton(SamSolver solver)
{
  PetscFunctionBegin;
  solver->ops.solve      = SamTangentialSolve_Newton;
  solver->keeps_product  = PETSC_TRUE;
  solver->default_levels = PETSC_MAX_INT;
  solver->default_max_it = 2000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

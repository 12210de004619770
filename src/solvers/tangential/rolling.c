/*
  Rolling: generalised conjugate residuals with kept directions and a sweep along the stream.

  Problem: the shear q on the discs |q| <= b whose slip velocity s = A q + offset - creepage
  (elasticity/steadyoperator.c) is zero where |q| < b and opposite to q where |q| = b, for given creepages or loads,
  or some of each. A is positive, but not symmetric: there is one solution and no energy, so no conjugate gradients
  and no descent.

  Algorithm, in units in which a cell's influence on itself is 1; an iteration takes one product:
    1. Sets: cells whose q - s/4 is beyond its circle slip, if s is against q or q far outside; the others stick. With
       lambda = |s|/b where a cell slips, h = 1/(1 + lambda), and g = sqrt(h), but less in faint cells. P subtracts the
       part along the shear.
    2. Residual: -s in stick; -h P s and b - |q| in slip. A direction d changes it by A d in stick; by P(h A d +
       (1 - h) d) and its part along the shear in slip; a creepage by -h P phi.
    3. New direction: P(g M g + (1 - h)h/2) r, r = -P s, with M the inverse of the operator of bodies at rest, and then
       along the stream z_i = P(z_i + h_i z_(i+1)), from the leading edge on, which undoes the difference in A. Without
       it the iterations grow like the number of cells along x. In slip N h r replaces the first part, since long waves
       are damped there (halfspace.c): N = 1 for h = 0, at h = SAM_SLIP_WEIGHT from a spectrum, between them linear in
       h. That saves a third of the products. It can stall at single slipping cells of an edge: after an iteration that
       left more than SLOW of the error, only the first part is used, until the next such iteration. The correction
       towards the circles is added. If loads are given, the direction by each free creepage is added, too, as far as
       the loads require; it is recomputed every RENEW iterations.
    4. Compute its product. Solve least squares over the new direction, the last directions, whose known products are
       valid for any sets, and the free creepages. Of a few lengths of this step, take the one with the least residual
       of q = D(q - s). The step replaces the new direction.
    5. If the error has not halved for several iterations, project q onto its discs, recompute s, and discard the
       directions.
  Stops on the residual of q = D(q - s), D the projection onto the discs, of an admissible shear with its slip in double
  precision; directions are in single precision. 12 directions instead of 4 save a sixth of the products.

  References: Eisenstat, Elman and Schultz 1983, SIAM J. Numer. Anal. 20, 345 (generalised conjugate residuals); Alart
  and Curnier 1991, CMAME 92, 353 (sets). The classical alternative is a Gauss-Seidel method, Vollebregt 2010.
*/
#include "rollingimpl.h"
#include <petsam/private/elasticity.h>
#include <math.h>

/* Number of iterations after which the directions that carry the loads are recomputed */
#define RENEW 5
/*
  Iterations without halving of the error before directions are discarded, and without any decrease before giving up;
  part of the error that an iteration with a bad direction leaves.
*/
#define PATIENCE   5
#define SLOW       0.7
#define STAGNATION 100
/* A column of the least squares that is a combination of others up to this part of it is omitted. */
#define DEPENDENT 1e-6
/* A start slides if a cell's slip is this many times the displacement by its bound. */
#define FAST 8

static const double lengths[SAM_ROLLING_LENGTHS] = {1, 0.6, 0.3, 0.1};

typedef SamRollingWork Work;

/* ---- fields ---- */

static PetscErrorCode Create(SamSolver solver, SamLevel *level, Work *w)
{
  SamStickSlip *u = &w->base;
  PetscReal     most;
  size_t        cells;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(w, sizeof(*w)));
  PetscCall(SamStickSlipCreate(solver, level, level->grid->nx, u));
  PetscCall(VecMax(level->given[SAM_TANGENTIAL_BOUND], NULL, &most));
  w->unit_q = most > 0 ? (double)most : 1;
  w->unit_s = u->self * w->unit_q;
  cells     = (size_t)u->cells;
  PetscCall(SamAllocateZeros(sizeof(*w->trial) * 2 * cells, &w->trial));
  PetscCall(SamAllocateZeros(sizeof(*w->normal) * 5 * cells, &w->normal));
  w->weight = w->normal + 2 * cells;
  w->r      = w->weight + cells;
  for (PetscInt k = 0; k < u->frame->count; k++) PetscCall(SamAllocateZeros(sizeof(float) * 2 * cells, &w->carry[k]));
  PetscCall(SamAllocateZeros(sizeof(float) * 4 * cells, &w->slot[0]));
  PetscCall(SamAllocateZeros(sizeof(float) * SAM_ROLLING_COLUMNS * 512, &w->columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Work *w)
{
  PetscFunctionBegin;
  SamFree(w->trial);
  SamFree(w->normal); /* together with the arrays behind it */
  for (PetscInt k = 0; k < 3; k++) SamFree(w->carry[k]);
  for (PetscInt k = 0; k <= SAM_ROLLING_KEPT; k++) SamFree(w->slot[k]);
  SamFree(w->columns);
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps 1 to 3 ---- */

/* Chooses the sets of cells, and computes the error, and the products of the shear with the phi. */
static PetscErrorCode ChooseSets(Work *w, double load[3])
{
  enum { SUMS = SAM_SQUARES + 3 };
  SamStickSlip *u            = &w->base;
  SamTotal      totals[SUMS] = {{0}};
  double        sums[SUMS];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    SamRollingSums row = {{0}, {0}};

    SamRollingSetsRow(w, SamStickSlipRow(u, j), &row);
    SamAddAll(SAM_SQUARES, totals, row.squares);
    SamAddAll(3, totals + SAM_SQUARES, row.load);
  }
  PetscCall(SamStickSlipSetError(u, totals));
  PetscCall(SamSumTotals(u->level->grid->comm, SUMS, totals, sums));
  PetscCall(PetscArraycpy(load, sums + SAM_SQUARES, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the direction against the slip, or (a not NULL) along a creepage. N h r is stored in the place of the new
  direction's product.
*/
static PetscErrorCode MakeDirection(Work *w, const double *a, float z[])
{
  const SamStickSlip *u      = &w->base;
  const double        factor = u->self * (double)u->level->grid->dx;
  float              *slip   = w->slot[0] + 2 * u->cells;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) SamRollingRightRow(w, SamStickSlipRow(u, j), a, z);
  SamStickSlipClearMargins(u, z);
  PetscCall(SamLevelPreconditionSingle(u->solver, u->level, factor, z, z));
  if (w->slipping) {
    SamStickSlipClearMargins(u, slip);
    u->solver->preconditions += u->level->depth == 0 ? 1 : 0;
    PetscCall(SamElasticityPreconditionSlipSingle(u->level->elasticity, factor, slip, slip));
  }
  for (PetscInt j = 0; j < u->rows; j++) SamRollingSweepRow(w, SamStickSlipRow(u, j), z, a ? 0 : 1);
  SamStickSlipClearMargins(u, z);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the loads that a direction carries, along the basis; first subtracts `project` times the part along the
  shear.
*/
static PetscErrorCode SumLoads(const Work *w, float project, float z[], double load[3])
{
  const SamStickSlip *u         = &w->base;
  SamTotal            totals[3] = {{0}};
  double              sums[3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[3] = {0};

    SamRollingLoadsRow(w, SamStickSlipRow(u, j), project, z, row);
    SamAddAll(3, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, 3, totals, sums));
  for (PetscInt i = 0; i < u->frame->count; i++) load[i] = SamFrameDot(u->frame->basis[i], sums);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves the least-squares problem of columns from the products of all pairs of them, the last column being the
  right-hand side: the upper triangle, row by row.
*/
static void FitColumns(PetscInt n, const double gram[], double x[])
{
  double    A[SAM_ROLLING_COLUMNS][SAM_ROLLING_COLUMNS], b[SAM_ROLLING_COLUMNS], scale[SAM_ROLLING_COLUMNS];
  PetscBool used[SAM_ROLLING_COLUMNS] = {PETSC_FALSE};

  for (PetscInt k = 0; k < n; k++) {
    for (PetscInt l = k; l < n; l++) A[k][l] = A[l][k] = gram[l - k];
    b[k]     = gram[n - k];
    scale[k] = gram[0] > 0 ? 1 / sqrt(gram[0]) : 0;
    gram += n + 1 - k;
  }
  for (PetscInt k = 0; k < n; k++) {
    for (PetscInt l = 0; l < n; l++) A[k][l] *= scale[k] * scale[l];
    b[k] *= scale[k];
  }
  for (PetscInt step = 0; step < n; step++) { /* Gauss and Jordan's elimination, the largest pivot first */
    PetscInt p = -1;

    for (PetscInt k = 0; k < n; k++)
      if (!used[k] && A[k][k] > (p < 0 ? DEPENDENT : A[p][p])) p = k;
    if (p < 0) break;
    used[p] = PETSC_TRUE;
    for (PetscInt k = 0; k < n; k++) {
      const double factor = A[k][p] / A[p][p];

      if (k == p) continue;
      for (PetscInt l = 0; l < n; l++) A[k][l] -= factor * A[p][l];
      b[k] -= factor * b[p];
    }
  }
  for (PetscInt k = 0; k < n; k++) x[k] = used[k] ? scale[k] * b[k] / A[k][k] : 0;
}

/* Adds to the new direction the part that restores the loads; `load`: the products of the shear with the phi. */
static PetscErrorCode KeepLoads(Work *w, const double load[3])
{
  const SamStickSlip *u       = &w->base;
  const SamFrame     *f       = u->frame;
  const PetscInt      n       = f->count;
  double              m[4][3] = {{0}}, z[3], gram[10], a[3], *to = gram;

  PetscFunctionBegin;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < n; k++) PetscCall(SumLoads(w, 1, w->carry[k], m[k]));
  PetscCall(SumLoads(w, 0, w->slot[0], z));
  for (PetscInt i = 0; i < n; i++) m[n][i] = (f->target[i] - SamFrameDot(f->basis[i], load)) / w->unit_q - z[i];
  for (PetscInt k = 0; k <= n; k++)
    for (PetscInt l = k; l <= n; l++) *to++ = SamFrameDot(m[k], m[l]);
  FitColumns(n, gram, a);
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = 0; i < 2 * u->cells; i++) w->slot[0][i] += (float)a[k] * w->carry[k][i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- step 4 ---- */

/* Finds the best combination of directions, in place of the new one, and of creepages, a. */
static PetscErrorCode Combine(Work *w, double a[3])
{
  SamStickSlip  *u       = &w->base;
  const PetscInt columns = w->kept + 1 + u->frame->count, n = (columns + 1) * (columns + 2) / 2;
  SamTotal       totals[SAM_ROLLING_GRAM] = {{0}};
  double         sums[SAM_ROLLING_GRAM], x[SAM_ROLLING_COLUMNS];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[SAM_ROLLING_GRAM] = {0};

    SamRollingGramRow(w, SamStickSlipRow(u, j), row);
    SamAddAll(n, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, n, totals, sums));
  FitColumns(columns, sums, x);
  for (PetscInt j = 0; j < u->rows; j++) SamRollingCombineRow(w, SamStickSlipRow(u, j), x);
  for (PetscInt c = 0; c < 3; c++) {
    a[c] = 0;
    for (PetscInt k = 0; k < u->frame->count; k++) a[c] += w->unit_s * x[w->kept + 1 + k] * u->frame->motion[k][c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the length of the step, makes the step and keeps it. */
static PetscErrorCode Step(Work *w, const double a[3])
{
  SamStickSlip *u                           = &w->base;
  SamTotal      totals[SAM_ROLLING_LENGTHS] = {{0}};
  double        squares[SAM_ROLLING_LENGTHS], t;
  PetscInt      best = 0, last = w->kept < SAM_ROLLING_KEPT ? w->kept + 1 : SAM_ROLLING_KEPT;
  float        *oldest;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[SAM_ROLLING_LENGTHS] = {0};

    SamRollingLengthsRow(w, SamStickSlipRow(u, j), lengths, a, row);
    SamAddAll(SAM_ROLLING_LENGTHS, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, SAM_ROLLING_LENGTHS, totals, squares));
  for (PetscInt k = 1; k < SAM_ROLLING_LENGTHS; k++)
    if (squares[k] < squares[best]) best = k;
  t = lengths[best];
  for (PetscInt j = 0; j < u->rows; j++) SamRollingAdvanceRow(w, SamStickSlipRow(u, j), t, a);
  for (PetscInt c = 0; c < 3; c++) u->motion[c] += t * a[c];
  w->kept = last;
  if (!w->slot[last]) PetscCall(SamAllocateZeros(sizeof(float) * 4 * (size_t)u->cells, &w->slot[last]));
  oldest = w->slot[last];
  for (PetscInt k = last; k > 0; k--) w->slot[k] = w->slot[k - 1];
  w->slot[0] = oldest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Iterate(Work *w, PetscBool renew, const double load[3])
{
  SamStickSlip *u = &w->base;
  double        a[3];

  PetscFunctionBegin;
  for (PetscInt k = 0; renew && k < u->frame->count; k++) PetscCall(MakeDirection(w, u->frame->motion[k], w->carry[k]));
  PetscCall(MakeDirection(w, NULL, w->slot[0]));
  PetscCall(KeepLoads(w, load));
  PetscCall(SamLevelApplySingle(u->solver, u->level, 1 / u->self, w->slot[0], w->slot[0] + 2 * u->cells));
  PetscCall(Combine(w, a));
  PetscCall(Step(w, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the admissible shear nearest to the trial, with its slip and its error, to rounding. */
static PetscErrorCode TakeTrial(Work *w, double motion[3], PetscBool *found)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  PetscCall(SamFrameProjectTangential(u->frame, &u->runs, u->bound, NULL, PETSC_FALSE, w->trial, motion, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(u->q, w->trial, 2 * u->cells));
  if (motion) SamFrameMove(u->frame, 1, motion);
  for (PetscInt c = 0; motion && c < 3; c++) u->motion[c] += u->self * motion[c];
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(SamStickSlipMeasure(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the shear admissible, in step 5 and at the end. */
static PetscErrorCode MakeAdmissible(Work *w, PetscBool *found)
{
  const SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < u->cells; k++) { /* cells that slip go beyond their circles, and come back onto them */
    const PetscInt l      = k + u->cells;
    const double   factor = w->normal[k] != 0 || w->normal[l] != 0 ? 2 * u->bound[k] / hypot(u->q[k], u->q[l]) : 1;

    w->trial[k] = factor * u->q[k];
    w->trial[l] = factor * u->q[l];
  }
  PetscCall(TakeTrial(w, NULL, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Improves a start before the iterations, which would make its cells stick: if bodies slide so fast that shear hardly
  changes their slip, q = D(q - s/c) is used as an iteration.
*/
static PetscErrorCode Slide(Work *w)
{
  SamStickSlip *u    = &w->base;
  double        fast = 0, before = INFINITY, motion[3];
  PetscBool     found = PETSC_TRUE;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < u->cells; k++)
    fast += u->bound[k] > 0 && hypot(u->s[k], u->s[k + u->cells]) > FAST * w->unit_s;
  PetscCall(SamSum(u->level->grid->comm, 1, &fast));
  while (fast > 0 && found && u->error > u->level->rtol && u->error < 0.5 * before) {
    before = u->error;
    for (PetscInt k = 0; k < 2 * u->cells; k++) w->trial[k] = u->q[k] - u->s[k] / u->self;
    PetscCall(TakeTrial(w, motion, &found));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamSolverReason Reason(const SamStickSlip *u, PetscBool failed)
{
  if (failed) return SAM_SOLVER_DIVERGED_STAGNATED;
  if (!isfinite(u->error)) return SAM_SOLVER_DIVERGED_NAN;
  return SamLevelAtMaxIterations(u->solver, u->level) ? SAM_SOLVER_DIVERGED_ITS : SAM_SOLVER_ITERATING;
}

/* Runs the iterations, from an admissible start. */
static PetscErrorCode Run(Work *w, SamSolverReason *reason)
{
  SamStickSlip *u    = &w->base;
  double        best = u->error, mark = u->error, last = u->error, load[3];
  PetscInt      stagnant = 0, since = 0, renewed = RENEW;
  PetscBool     found = PETSC_TRUE;

  PetscFunctionBegin;
  w->slipping = PETSC_TRUE;
  *reason     = Reason(u, !found || stagnant > STAGNATION);
  if (!*reason && u->error <= u->level->rtol) *reason = SAM_SOLVER_CONVERGED_RTOL;
  PetscCall(ChooseSets(w, load));
  while (!*reason) {
    PetscCall(Iterate(w, renewed >= RENEW ? PETSC_TRUE : PETSC_FALSE, load));
    renewed = renewed >= RENEW ? 1 : renewed + 1;
    PetscCall(ChooseSets(w, load));
    PetscCall(SamLevelIterated(u->solver, u->level, u->error));
    w->slipping = u->error <= SLOW * last ? w->slipping : !w->slipping;
    last        = u->error;
    since       = u->error <= 0.5 * mark ? 0 : since + 1;
    mark        = since ? mark : u->error;
    stagnant    = u->error < 0.9 * best ? 0 : stagnant + 1;
    best        = PetscMin(best, u->error);
    if (u->error <= u->level->rtol || since >= PATIENCE) {
      PetscCall(MakeAdmissible(w, &found));
      if (found && u->error <= u->level->rtol) *reason = SAM_SOLVER_CONVERGED_RTOL;
      if (since >= PATIENCE) {
        w->kept = 0;
        since   = 0;
        mark    = u->error;
        renewed = RENEW;
      }
      PetscCall(ChooseSets(w, load));
    }
    if (!*reason) *reason = Reason(u, !found || stagnant > STAGNATION);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves an admissible shear after a solve without solution: none beyond its bound. */
static PetscErrorCode LeaveAdmissible(Work *w)
{
  SamStickSlip *u     = &w->base;
  PetscBool     found = PETSC_FALSE;

  PetscFunctionBegin;
  if (isfinite(u->error)) PetscCall(MakeAdmissible(w, &found));
  if (found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(u->q, 2 * u->cells));
  PetscCall(PetscArraycpy(u->motion, u->frame->fixed, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamTangentialSolve_Rolling(SamSolver solver, SamLevel *level)
{
  Work          w;
  SamStickSlip *u = &w.base;

  PetscFunctionBegin;
  PetscCall(Create(solver, level, &w));
  PetscCall(SamStickSlipStart(u));
  PetscCall(Slide(&w));
  PetscCall(Run(&w, &solver->reason));
  if (solver->reason < 0) PetscCall(LeaveAdmissible(&w));
  solver->error = u->error;
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = u->motion[c];
  PetscCall(Destroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialCreate_Rolling(SamSolver solver)
{
  PetscFunctionBegin;
  solver->ops.solve      = SamTangentialSolve_Rolling;
  solver->upwind         = PETSC_TRUE;
  solver->default_levels = PETSC_MAX_INT;
  solver->default_max_it = 500;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The tangential problem as a kind of solver: its way through nested grids and windows, the cases without shear, and the
  test for gross slip. The methods are in separate files.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/tangentialimpl.h>
#include <petsam/private/balance.h>
#include <petsam/private/tangential.h>
#include <math.h>

/* Loads within this relative distance of the limit of sliding count as at the limit. */
#define LIMIT_ROUNDING 1e-7
/* A cell sticks when |q|^2 is below this part of its bound's square; a ratio of sizes slips above its counterpart. */
#define STICKS     (1 - 1e-8)
#define SLIP_RATIO (1 - 1e-6)

/* ---- nested grids ---- */

/*
  Fields that are interpolated from a coarse grid to the next finer one: the shear in units of the bound, so that cells
  that slip do so on the fine grid too. Direction and size are interpolated apart, as the mean of two directions is
  shorter than either; and the size only over cells with a bound, by interpolating their indicator as well.
*/
enum { RATIO_X, RATIO_Y, RATIO_SIZE, RATIO_IN, RATIOS };

static PetscErrorCode MakeRatios(const SamLevel *coarse, const Vec ratios[RATIOS])
{
  const PetscInt cells = coarse->grid->cells;
  const double  *b, *q;
  double        *r[RATIOS];

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(coarse->given[SAM_TANGENTIAL_BOUND], &b));
  PetscCall(VecGetArrayRead(coarse->traction, &q));
  for (PetscInt c = 0; c < RATIOS; c++) PetscCall(VecGetArrayWrite(ratios[c], &r[c]));
  for (PetscInt k = 0; k < cells; k++) {
    const double x = b[k] > 0 ? q[k] / b[k] : 0, y = b[k] > 0 ? q[k + cells] / b[k] : 0;

    r[RATIO_X][k]    = x;
    r[RATIO_Y][k]    = y;
    r[RATIO_SIZE][k] = sqrt(x * x + y * y);
    r[RATIO_IN][k]   = b[k] > 0;
  }
  for (PetscInt c = 0; c < RATIOS; c++) PetscCall(VecRestoreArrayWrite(ratios[c], &r[c]));
  PetscCall(VecRestoreArrayRead(coarse->traction, &q));
  PetscCall(VecRestoreArrayRead(coarse->given[SAM_TANGENTIAL_BOUND], &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode UseRatios(const SamLevel *fine, const Vec ratios[RATIOS])
{
  const PetscInt cells = fine->grid->cells;
  const double  *b, *r[RATIOS];
  double        *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(fine->given[SAM_TANGENTIAL_BOUND], &b));
  PetscCall(VecGetArrayWrite(fine->traction, &q));
  for (PetscInt c = 0; c < RATIOS; c++) PetscCall(VecGetArrayRead(ratios[c], &r[c]));
  for (PetscInt k = 0; k < cells; k++) {
    const double x = r[RATIO_X][k], y = r[RATIO_Y][k], n = sqrt(x * x + y * y);
    const double size = r[RATIO_IN][k] > 0 ? PetscMin(1, r[RATIO_SIZE][k] / r[RATIO_IN][k]) : 0;
    /* a cell that slips is put beyond its circle; the projection brings it back onto it */
    const double s = (b[k] > 0 && n > 0) ? b[k] * (size > SLIP_RATIO ? 2 : size) / n : 0;

    q[k]         = s * x;
    q[k + cells] = s * y;
  }
  for (PetscInt c = 0; c < RATIOS; c++) PetscCall(VecRestoreArrayRead(ratios[c], &r[c]));
  PetscCall(VecRestoreArrayWrite(fine->traction, &q));
  PetscCall(VecRestoreArrayRead(fine->given[SAM_TANGENTIAL_BOUND], &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Prolong(SamTransfer transfer, const SamLevel *coarse, SamLevel *fine)
{
  Vec down[RATIOS], up[RATIOS];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < RATIOS; c++) {
    PetscCall(SamGridCreateVec(coarse->grid, 1, &down[c]));
    PetscCall(SamGridCreateVec(fine->grid, 1, &up[c]));
  }
  PetscCall(MakeRatios(coarse, down));
  for (PetscInt c = 0; c < RATIOS; c++) PetscCall(SamTransferProlong(transfer, down[c], up[c]));
  PetscCall(UseRatios(fine, up));
  for (PetscInt c = 0; c < RATIOS; c++) {
    PetscCall(VecDestroy(&down[c]));
    PetscCall(VecDestroy(&up[c]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- one level ---- */

/* Replaces the level's shear by an admissible one near it; `found` is false when none carries the loads. */
static PetscErrorCode MakeAdmissible(SamLevel *level, PetscBool *found)
{
  const double *bound;
  double       *q;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&level->frame, level->grid, level->balance));
  PetscCall(VecGetArrayRead(level->given[SAM_TANGENTIAL_BOUND], &bound));
  PetscCall(VecGetArray(level->traction, &q));
  PetscCall(SamFrameProjectTangential(&level->frame, NULL, bound, NULL, PETSC_FALSE, q, NULL, found));
  PetscCall(VecRestoreArray(level->traction, &q));
  PetscCall(VecRestoreArrayRead(level->given[SAM_TANGENTIAL_BOUND], &bound));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sets the rigid-body displacement at the start of a level: that of the guess or of the coarse solution, and the given
  part.
*/
static PetscErrorCode StartRigid(SamSolver s, SamLevel *level, SamStart start)
{
  SamFrame given;

  PetscFunctionBegin;
  if (start == SAM_START_COARSE && s->reason > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFrameSetGiven(&given, level->grid, level->balance));
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = start == SAM_START_GUESS ? given.fixed[c] : level->frame.fixed[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On the finest grid without a coarser one, SolveLoaded() has made the start admissible. */
static PetscErrorCode SolveLevel(SamSolver s, SamLevel *level, SamStart start)
{
  PetscBool found = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&level->frame, level->grid, level->balance));
  PetscCall(StartRigid(s, level, start));
  if (level->depth > 0 && start == SAM_START_NONE) PetscCall(SamVecZero(level->traction));
  if (level->depth > 0 || start == SAM_START_COARSE) PetscCall(MakeAdmissible(level, &found));
  s->reason = SAM_SOLVER_DIVERGED_STAGNATED;
  if (found) PetscCall(s->ops.solve(s, level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- gross slip ---- */

/* Finds out whether sliding is reached; if so, takes the shear of sliding as that of the level. */
static PetscErrorCode ComputeLimit(SamSolver s, const SamLevel *level, PetscBool *reached)
{
  Vec shear;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(level->grid, 2, &shear));
  PetscCall(SamBalanceSlideLimit(level->grid, level->balance, level->given[SAM_TANGENTIAL_BOUND], &s->limit, shear));
  *reached = s->limit <= 1 + LIMIT_ROUNDING;
  if (*reached) PetscCall(VecCopy(shear, level->traction));
  PetscCall(VecDestroy(&shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects loads exactly at the limit: they are balanced only by sliding everywhere, without definite displacement. */
static PetscErrorCode CheckLimit(SamSolver s, const SamLevel *level)
{
  const PetscInt cells = level->grid->cells;
  const double  *b, *q;
  double         sticking = 0;
  PetscBool      reached  = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(level->given[SAM_TANGENTIAL_BOUND], &b));
  PetscCall(VecGetArrayRead(level->traction, &q));
  for (PetscInt k = 0; k < cells; k++) sticking += q[k] * q[k] + q[k + cells] * q[k + cells] < STICKS * b[k] * b[k];
  PetscCall(VecRestoreArrayRead(level->traction, &q));
  PetscCall(VecRestoreArrayRead(level->given[SAM_TANGENTIAL_BOUND], &b));
  PetscCall(SamSum(level->grid->comm, 1, &sticking));
  if (sticking > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ComputeLimit(s, level, &reached));
  if (reached) s->reason = SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the kind ---- */

/* True if nothing causes shear: q = 0 is the solution. */
static PetscBool IsUnloaded(const SamLevel *level)
{
  const SamBalance *b = level->balance;

  if (level->given[SAM_TANGENTIAL_OFFSET]) return PETSC_FALSE;
  for (PetscInt k = 0; k < 3; k++)
    if ((b->force[k] ? b->load[k] : b->rigid[k]) != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Solves a problem without friction, contact or load: q = 0, which carries no load. */
static PetscErrorCode SolveFree(SamSolver s, SamLevel *level)
{
  SamBalance *b      = level->balance;
  PetscBool   loaded = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamVecZero(level->traction));
  SamLevelForgetProduct(level);
  for (PetscInt k = 0; k < 3; k++) {
    if (b->force[k] && b->load[k] != 0) loaded = PETSC_TRUE;
    if (b->force[k])
      b->rigid[k] = 0; /* any displacement would do */
    else
      b->load[k] = 0;
  }
  s->limit  = 0;
  s->reason = loaded ? SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM : SAM_SOLVER_CONVERGED_TRIVIAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves on nested grids, or from the guess; if that stagnates, on the finest grid alone, without a guess. If hardly any
  load is carried outside of the stick zone, and none within it (worn bodies, unloaded), each grid has a different stick
  zone, and the shear of a coarse grid is farther from the solution than zero shear.
*/
static PetscErrorCode SolveWithStarts(SamSolver s, SamLevel *level, PetscBool guess, PetscBool *possible)
{
  const PetscInt levels = SamSolverLevels(s);

  PetscFunctionBegin;
  PetscCall(SamLevelSolveNested(s, level, levels, guess));
  if (s->reason != SAM_SOLVER_DIVERGED_STAGNATED || (levels == 1 && !guess)) PetscFunctionReturn(PETSC_SUCCESS);
  SamLevelForgetProduct(level);
  PetscCall(SamVecZero(level->traction));
  PetscCall(MakeAdmissible(level, possible));
  if (*possible) PetscCall(SamLevelSolveNested(s, level, 1, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The projection of any shear shows whether some admissible shear carries the loads; that of the guess is the
  start as well.
*/
static PetscErrorCode SolveLoaded(SamSolver s, SamLevel *level, PetscBool guess)
{
  PetscBool possible = PETSC_TRUE, reached = PETSC_FALSE;

  PetscFunctionBegin;
  if (!guess) PetscCall(SamVecZero(level->traction));
  if (!guess) SamLevelForgetProduct(level);
  if (!SamLevelHasProduct(level)) PetscCall(MakeAdmissible(level, &possible)); /* else the product would not fit q */
  if (possible) {
    PetscCall(SolveWithStarts(s, level, guess, &possible));
    possible = possible && s->reason != SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  }
  if (!possible) {
    SamLevelForgetProduct(level);
    PetscCall(SamVecZero(level->traction));
    PetscCall(ComputeLimit(s, level, &reached)); /* independent of the projection, which may fail otherwise */
    s->reason = reached ? SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM : SAM_SOLVER_DIVERGED_STAGNATED;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CheckLimit(s, level));
  if (s->reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) PetscFunctionReturn(PETSC_SUCCESS);
  SamLevelGetRigid(level, level->balance);
  PetscCall(SamBalanceGetLoads(level->grid, SAM_BALANCE_TANGENTIAL, level->traction, level->balance->load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves in a window: shear acts only where there is a bound, and its displacement matters only there. */
static PetscErrorCode Solve(SamSolver s, SamLevel *level, PetscBool guess)
{
  const Vec     bound = level->given[SAM_TANGENTIAL_BOUND];
  PetscInt      first[2], size[2];
  PetscReal     most;
  SamWindow     window;
  SamElasticity part;

  PetscFunctionBegin;
  PetscCall(VecMax(bound, NULL, &most));
  if (most <= 0 || IsUnloaded(level)) {
    PetscCall(SolveFree(s, level));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamGridGetSupport(level->grid, bound, PETSC_FALSE, first, size));
  /* an upwind difference of the shear reaches one cell behind the contact */
  if (SamElasticityGetTraits(level->elasticity).upwind && first[0] > 0) {
    first[0]--;
    size[0]++;
  }
  PetscCall(SamElasticityChoosePart(level->elasticity, first, size, PETSC_TRUE, &window, &part));
  if (window)
    PetscCall(SamLevelSolveInWindow(s, level, window, part, guess, SolveLoaded));
  else
    PetscCall(SolveLoaded(s, level, guess));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamSolverKind kind = {
  .class_id           = SamTangential_CLASSID,
  .name               = "tangential",
  .error_help         = "residual of the projection equation, relative to the shear",
  .balance            = SAM_BALANCE_TANGENTIAL,
  .event              = SAM_EVENT_TANGENTIAL_SOLVE,
  .type               = SAM_TANGENTIAL_NEWTON,
  .create             = SamTangentialCreate_Newton,
  .upwind             = SAM_TANGENTIAL_ROLLING,
  .createupwind       = SamTangentialCreate_Rolling,
  .rtol               = 1e-6,
  .coarse_rtol        = 1e-3,
  .components         = 2,
  .given_components   = {[SAM_TANGENTIAL_BOUND] = 1, [SAM_TANGENTIAL_OFFSET] = 2},
  .diagonal           = -1,
  .apply              = SamElasticityApplyTangential,
  .applysingle        = SamElasticityApplyTangentialSingle,
  .preconditionsingle = SamElasticityPreconditionTangentialSingle,
  .solve              = Solve,
  .solvelevel         = SolveLevel,
  .prolong            = Prolong,
};

PetscErrorCode SamTangentialRegister(const char name[], PetscErrorCode (*create)(SamSolver))
{
  PetscFunctionBegin;
  SamValidPointer(name, 1);
  SamValidPointer(create, 2);
  PetscCall(SamSolverRegister(&kind, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialCreate(SamElasticity elasticity, SamTangential *tangential)
{
  SamSolver solver;

  PetscFunctionBegin;
  SamValidHandle(elasticity, SamElasticity, 1);
  SamValidPointer(tangential, 2);
  PetscCall(SamSolverCreate(&kind, elasticity, &solver));
  if (SamElasticityGetTraits(elasticity).upwind) PetscCall(SamSolverSetType(solver, SAM_TANGENTIAL_ROLLING));
  *tangential = (SamTangential)solver;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialDestroy(SamTangential *tangential)
{
  PetscFunctionBegin;
  SamValidPointer(tangential, 1);
  if (!*tangential) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*tangential, SamTangential, 1);
  PetscCall(SamSolverDestroy(SamTangentialAsSolver(*tangential)));
  *tangential = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSolveKeeping(SamTangential tangential, Vec bound, Vec offset, SamBalance *balance,
                                         PetscBool guess, Vec q, SamProduct *product)
{
  const SamLevel problem = {.balance  = balance,
                            .given    = {[SAM_TANGENTIAL_BOUND] = bound, [SAM_TANGENTIAL_OFFSET] = offset},
                            .traction = q,
                            .product  = product};

  return SamSolverSolve(SamTangentialAsSolver(tangential), &problem, guess);
}

PetscErrorCode SamTangentialSolve(SamTangential tangential, Vec bound, Vec offset, SamBalance *balance, PetscBool guess,
                                  Vec q)
{
  PetscFunctionBegin;
  SamValidHandle(tangential, SamTangential, 1);
  SamValidVec(bound, 2);
  if (offset) SamValidVec(offset, 3);
  SamValidPointer(balance, 4);
  SamValidVec(q, 6);
  SamValidVecOn(SamTangentialAsSolver(tangential)->comm, 1, bound, 2);
  if (offset) SamValidVecOn(SamTangentialAsSolver(tangential)->comm, 1, offset, 3);
  SamValidVecOn(SamTangentialAsSolver(tangential)->comm, 1, q, 6);
  PetscCall(SamTangentialSolveKeeping(tangential, bound, offset, balance, guess, q, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamTangentialGetLimit(SamTangential tangential)
{
  return SamTangentialAsSolver(tangential)->limit;
}

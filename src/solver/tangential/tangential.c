/* The tangential solver's class: types, tolerances, monitors, nested grids, the test for gross slip. */
#include <petsam/private/tangentialimpl.h>
#include <math.h>

/* Coarse grids need to be solved only as well as they approximate the fine one. */
#define COARSE_RTOL 1e-3

static PetscFunctionList SamTangentialList = NULL;
static PetscBool         registered        = PETSC_FALSE;

const char *SamTangentialReasonName(SamTangentialReason reason)
{
  switch (reason) {
  case SAM_TANGENTIAL_CONVERGED_RTOL:
    return "CONVERGED_RTOL";
  case SAM_TANGENTIAL_CONVERGED_FREE:
    return "CONVERGED_FREE";
  case SAM_TANGENTIAL_CONVERGED_ITERATING:
    return "CONVERGED_ITERATING";
  case SAM_TANGENTIAL_DIVERGED_ITS:
    return "DIVERGED_ITS";
  case SAM_TANGENTIAL_DIVERGED_NAN:
    return "DIVERGED_NAN";
  case SAM_TANGENTIAL_DIVERGED_STAGNATED:
    return "DIVERGED_STAGNATED";
  case SAM_TANGENTIAL_DIVERGED_GROSS_SLIP:
    return "DIVERGED_GROSS_SLIP";
  }
  return "unknown";
}

PetscErrorCode SamTangentialRegister(const char name[], PetscErrorCode (*create)(SamTangential))
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListAdd(&SamTangentialList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeList(void)
{
  PetscFunctionBegin;
  registered = PETSC_FALSE;
  PetscCall(PetscFunctionListDestroy(&SamTangentialList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RegisterAll(void)
{
  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(SamTangentialRegister(SAM_TANGENTIAL_NEWTON, SamTangentialCreate_Newton));
  PetscCall(SamTangentialRegister(SAM_TANGENTIAL_GRADIENT, SamTangentialCreate_Gradient));
  PetscCall(PetscRegisterFinalize(FreeList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialCreate(SamElasticity elasticity, SamTangential *tangential)
{
  SamTangential t;
  SamGrid       grid;

  PetscFunctionBegin;
  PetscCall(RegisterAll());
  PetscCall(PetscNew(&t));
  PetscCall(SamElasticityReference(elasticity));
  PetscCall(SamElasticityGetGrid(elasticity, &grid));
  t->elasticity        = elasticity;
  t->solver.comm       = grid->comm;
  t->solver.owner      = t;
  t->solver.kind       = "tangential";
  t->solver.error_help = "residual of the projection equation, relative to the shear";
  t->solver.rtol       = 1e-6;
  PetscCall(SamTangentialSetType(t, SAM_TANGENTIAL_NEWTON));
  *tangential = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialDestroy(SamTangential *tangential)
{
  PetscFunctionBegin;
  if (!*tangential) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityDestroy(&(*tangential)->elasticity));
  PetscCall(PetscFree(*tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSetType(SamTangential t, SamTangentialType type)
{
  PetscErrorCode (*create)(SamTangential);

  PetscFunctionBegin;
  PetscCall(PetscFunctionListFind(SamTangentialList, type, &create));
  PetscCheck(create, t->solver.comm, SAM_ERR_USER, "-%stangential_type %s: expected %s or %s", t->solver.prefix, type,
             SAM_TANGENTIAL_NEWTON, SAM_TANGENTIAL_GRADIENT);
  PetscCall(create(t));
  PetscCall(PetscStrncpy(t->solver.type, type, sizeof(t->solver.type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialGetType(SamTangential t, SamTangentialType *type)
{
  PetscFunctionBegin;
  *type = t->solver.type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSetOptionsPrefix(SamTangential t, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(PetscStrncpy(t->solver.prefix, prefix ? prefix : "", sizeof(t->solver.prefix)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSetTolerances(SamTangential t, PetscReal rtol, PetscInt max_it)
{
  PetscFunctionBegin;
  if (rtol != PETSC_DEFAULT) t->solver.rtol = rtol;
  if (max_it != PETSC_DEFAULT) t->solver.max_it = max_it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialGetTolerances(SamTangential t, PetscReal *rtol, PetscInt *max_it)
{
  PetscFunctionBegin;
  if (rtol) *rtol = t->solver.rtol;
  if (max_it) *max_it = SamSolverMaxIterations(&t->solver);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSetLevels(SamTangential t, PetscInt levels)
{
  PetscFunctionBegin;
  t->solver.levels = levels;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialMonitorSet(SamTangential t, SamTangentialMonitor monitor, void *context)
{
  PetscFunctionBegin;
  PetscCall(SamSolverMonitorSet(&t->solver, monitor, context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSetFromOptions(SamTangential t)
{
  char      type[32];
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(SamSolverSetFromOptions(&t->solver, "newton or gradient", type, sizeof(type), &set));
  if (set) PetscCall(SamTangentialSetType(t, type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialView(SamTangential t, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(SamSolverView(&t->solver, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialApply(SamTangential t, SamTangentialLevel *level, Vec q, Vec u)
{
  PetscFunctionBegin;
  t->solver.applies += level->finest ? 1 : 0;
  PetscCall(SamElasticityApplyTangential(level->elasticity, q, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialApplySingle(SamTangential t, SamTangentialLevel *level, double factor, const float q[],
                                        float u[])
{
  PetscFunctionBegin;
  t->solver.applies += level->finest ? 1 : 0;
  PetscCall(SamElasticityApplyTangentialSingle(level->elasticity, factor, q, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialPreconditionSingle(SamTangential t, SamTangentialLevel *level, double factor,
                                               const float r[], float z[])
{
  PetscFunctionBegin;
  t->solver.preconditions += level->finest ? 1 : 0;
  PetscCall(SamElasticityPreconditionTangentialSingle(level->elasticity, factor, r, z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamTangentialIterated(SamTangential t, SamTangentialLevel *level)
{
  t->solver.iterations += level->finest ? 1 : 0;
}

PetscErrorCode SamTangentialMeasured(SamTangential t, SamTangentialLevel *level, PetscReal error)
{
  PetscFunctionBegin;
  if (level->finest) PetscCall(SamSolverCallMonitors(&t->solver, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialGetReason(SamTangential t, SamTangentialReason *reason)
{
  PetscFunctionBegin;
  *reason = t->reason;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialGetStatistics(SamTangential t, PetscReal *error, PetscInt *iterations, PetscInt *applies,
                                          PetscInt *preconditions)
{
  PetscFunctionBegin;
  if (error) *error = t->solver.error;
  if (iterations) *iterations = t->solver.iterations;
  if (applies) *applies = t->solver.applies;
  if (preconditions) *preconditions = t->solver.preconditions;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the nested grids hand down: the shear in units of the bound, so that slip stays slip when the bound is finer. */
static PetscErrorCode MakeRatios(SamTangentialLevel *coarse, Vec ratios[4])
{
  const PetscInt cells = coarse->grid->cells;
  const double  *b, *q;
  double        *r[4];

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(coarse->bound, &b));
  PetscCall(VecGetArrayRead(coarse->q, &q));
  for (PetscInt c = 0; c < 4; c++) PetscCall(VecGetArrayWrite(ratios[c], &r[c]));
  for (PetscInt k = 0; k < cells; k++) {
    const double x = b[k] > 0 ? q[k] / b[k] : 0, y = b[k] > 0 ? q[k + cells] / b[k] : 0;

    r[0][k] = x;
    r[1][k] = y;
    r[2][k] = sqrt(x * x + y * y);
    r[3][k] = b[k] > 0;
  }
  for (PetscInt c = 0; c < 4; c++) PetscCall(VecRestoreArrayWrite(ratios[c], &r[c]));
  PetscCall(VecRestoreArrayRead(coarse->q, &q));
  PetscCall(VecRestoreArrayRead(coarse->bound, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Direction and size are interpolated apart: the mean of two directions is shorter than either. */
static PetscErrorCode UseRatios(SamTangentialLevel *fine, Vec ratios[4])
{
  const PetscInt cells = fine->grid->cells;
  const double  *b, *r[4];
  double        *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(fine->bound, &b));
  PetscCall(VecGetArrayWrite(fine->q, &q));
  for (PetscInt c = 0; c < 4; c++) PetscCall(VecGetArrayRead(ratios[c], &r[c]));
  for (PetscInt k = 0; k < cells; k++) {
    const double n    = sqrt(r[0][k] * r[0][k] + r[1][k] * r[1][k]);
    const double size = r[3][k] > 0 ? PetscMin(1, r[2][k] / r[3][k]) : 0;
    /* a cell that slips is put beyond its circle, where the projection brings it back to */
    const double s = (b[k] > 0 && n > 0) ? b[k] * (size > 1 - 1e-6 ? 2 : size) / n : 0;

    q[k]         = s * r[0][k];
    q[k + cells] = s * r[1][k];
  }
  for (PetscInt c = 0; c < 4; c++) PetscCall(VecRestoreArrayRead(ratios[c], &r[c]));
  PetscCall(VecRestoreArrayWrite(fine->q, &q));
  PetscCall(VecRestoreArrayRead(fine->bound, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Prolong(SamTransfer transfer, SamTangentialLevel *coarse, SamTangentialLevel *fine)
{
  Vec down[4], up[4];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 4; c++) {
    PetscCall(SamGridCreateVec(coarse->grid, 1, &down[c]));
    PetscCall(SamGridCreateVec(fine->grid, 1, &up[c]));
  }
  PetscCall(MakeRatios(coarse, down));
  for (PetscInt c = 0; c < 4; c++) PetscCall(SamTransferProlong(transfer, down[c], up[c]));
  PetscCall(UseRatios(fine, up));
  for (PetscInt c = 0; c < 4; c++) {
    PetscCall(VecDestroy(&down[c]));
    PetscCall(VecDestroy(&up[c]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveLevel(SamTangential t, SamTangentialLevel *level, PetscInt depth, const SamBalance *balance,
                                 PetscBool guess);

/* The start of a level from the next coarser grid. */
static PetscErrorCode StartFromCoarse(SamTangential t, SamTangentialLevel *level, SamElasticity elasticity,
                                      SamTransfer transfer, PetscInt depth, const SamBalance *balance)
{
  SamTangentialLevel coarse = {.elasticity = elasticity, .rtol = PetscMax(t->solver.rtol, COARSE_RTOL)};

  PetscFunctionBegin;
  PetscCall(SamElasticityGetGrid(elasticity, &coarse.grid));
  PetscCall(SamGridCreateVec(coarse.grid, 1, &coarse.bound));
  PetscCall(SamGridCreateVec(coarse.grid, 2, &coarse.q));
  PetscCall(SamTransferRestrict(transfer, level->bound, coarse.bound));
  if (level->offset) {
    PetscCall(SamGridCreateVec(coarse.grid, 2, &coarse.offset));
    PetscCall(SamTransferRestrict(transfer, level->offset, coarse.offset));
  }
  PetscCall(SolveLevel(t, &coarse, depth, balance, PETSC_FALSE));
  PetscCall(Prolong(transfer, &coarse, level));
  if (t->reason > 0)
    for (PetscInt c = 0; c < 3; c++) level->rigid[c] = coarse.rigid[c];
  PetscCall(VecDestroy(&coarse.bound));
  PetscCall(VecDestroy(&coarse.offset));
  PetscCall(VecDestroy(&coarse.q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on this grid, after the coarser ones when depth > 1. */
static PetscErrorCode SolveLevel(SamTangential t, SamTangentialLevel *level, PetscInt depth, const SamBalance *balance,
                                 PetscBool guess)
{
  SamElasticity coarse   = NULL;
  SamTransfer   transfer = NULL;
  SamFrame      start;
  const double *bound;
  double       *q;
  PetscBool     found = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&level->frame, level->grid, balance));
  PetscCall(SamFrameSetGiven(&start, level->grid, balance));
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = guess ? start.fixed[c] : level->frame.fixed[c];
  if (depth > 1 && !guess) PetscCall(SamElasticityGetCoarse(level->elasticity, &coarse, &transfer));
  if (coarse)
    PetscCall(StartFromCoarse(t, level, coarse, transfer, depth - 1, balance));
  else if (!level->finest)
    PetscCall(SamVecZero(level->q));
  if (coarse || !level->finest) { /* otherwise the start is what IsPossible() left */
    PetscCall(VecGetArrayRead(level->bound, &bound));
    PetscCall(VecGetArray(level->q, &q));
    PetscCall(SamFrameProjectTangential(&level->frame, bound, PETSC_FALSE, q, &found));
    PetscCall(VecRestoreArray(level->q, &q));
    PetscCall(VecRestoreArrayRead(level->bound, &bound));
  }
  t->reason = SAM_TANGENTIAL_DIVERGED_STAGNATED;
  if (found) PetscCall(t->solve(t, level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nothing drives the contact tangentially: q = 0 solves it. */
static PetscBool IsUnloaded(const SamBalance *balance, Vec offset)
{
  if (offset) return PETSC_FALSE;
  for (PetscInt k = 0; k < 3; k++)
    if ((balance->force[k] ? balance->load[k] : balance->rigid[k]) != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* No friction, no contact or no load: q = 0, unless a load wants to be balanced. */
static PetscErrorCode SolveFree(SamTangential t, SamBalance *balance, Vec q)
{
  PetscBool loaded = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamVecZero(q));
  for (PetscInt k = 0; k < 3; k++) {
    if (balance->force[k] && balance->load[k] != 0) loaded = PETSC_TRUE;
    if (balance->force[k])
      balance->rigid[k] = 0; /* not determined by anything */
    else
      balance->load[k] = 0;
  }
  t->limit  = 0;
  t->reason = loaded ? SAM_TANGENTIAL_DIVERGED_GROSS_SLIP : SAM_TANGENTIAL_CONVERGED_FREE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Whether any admissible shear carries the loads: the projection of any shear tells, that of a guess is the start as
  well.
*/
static PetscErrorCode IsPossible(const SamTangentialLevel *level, const SamBalance *balance, PetscBool guess,
                                 PetscBool *possible)
{
  SamFrame      frame;
  const double *bound;
  double       *q;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&frame, level->grid, balance));
  if (!guess) PetscCall(SamVecZero(level->q));
  PetscCall(VecGetArrayRead(level->bound, &bound));
  PetscCall(VecGetArray(level->q, &q));
  PetscCall(SamFrameProjectTangential(&frame, bound, PETSC_FALSE, q, possible));
  PetscCall(VecRestoreArray(level->q, &q));
  PetscCall(VecRestoreArrayRead(level->bound, &bound));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads exactly at the limit are balanced, but by sliding everywhere, at no definite displacement. */
static PetscErrorCode CheckLimit(SamTangential t, const SamTangentialLevel *level, const SamBalance *balance)
{
  const PetscInt cells = level->grid->cells;
  const double  *b, *q;
  double         sticking = 0;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(level->bound, &b));
  PetscCall(VecGetArrayRead(level->q, &q));
  for (PetscInt k = 0; k < cells; k++) sticking += q[k] * q[k] + q[k + cells] * q[k + cells] < (1 - 1e-8) * b[k] * b[k];
  PetscCall(VecRestoreArrayRead(level->q, &q));
  PetscCall(VecRestoreArrayRead(level->bound, &b));
  PetscCall(SamSum(level->grid->comm, 1, &sticking));
  if (sticking > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamBalanceSlideLimit(level->grid, balance, level->bound, &t->limit, NULL));
  if (t->limit <= 1 + 1e-7) t->reason = SAM_TANGENTIAL_DIVERGED_GROSS_SLIP;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveLoaded(SamTangential t, SamTangentialLevel *level, SamBalance *balance, PetscBool guess)
{
  PetscBool possible;

  PetscFunctionBegin;
  PetscCall(IsPossible(level, balance, guess, &possible));
  if (possible) {
    PetscCall(SolveLevel(t, level, SamSolverLevels(&t->solver), balance, guess));
    PetscCall(CheckLimit(t, level, balance));
  } else {
    PetscCall(SamVecZero(level->q));
    PetscCall(SamBalanceSlideLimit(level->grid, balance, level->bound, &t->limit, NULL));
    /* the limit says so independently, or the projection failed for another reason */
    t->reason = t->limit <= 1 + 1e-7 ? SAM_TANGENTIAL_DIVERGED_GROSS_SLIP : SAM_TANGENTIAL_DIVERGED_STAGNATED;
  }
  if (!possible || t->reason == SAM_TANGENTIAL_DIVERGED_GROSS_SLIP) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 3; k++) level->rigid[k] -= level->frame.fixed[k];
  SamFrameGetRigid(&level->frame, level->rigid, balance);
  PetscCall(SamBalanceGetLoads(level->grid, SAM_BALANCE_TANGENTIAL, level->q, balance->load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The problem on a window around the contact: fields taken out, the solution put back. */
static PetscErrorCode SolveInWindow(SamTangential t, SamTangentialLevel *whole, SamWindow window, SamElasticity part,
                                    SamBalance *balance, PetscBool guess)
{
  SamTangentialLevel level = {.elasticity = part, .finest = PETSC_TRUE, .rtol = whole->rtol};

  PetscFunctionBegin;
  PetscCall(SamWindowGetGrid(window, &level.grid));
  PetscCall(SamGridCreateVec(level.grid, 1, &level.bound));
  PetscCall(SamGridCreateVec(level.grid, 2, &level.q));
  PetscCall(SamWindowTake(window, whole->bound, level.bound));
  if (whole->offset) {
    PetscCall(SamGridCreateVec(level.grid, 2, &level.offset));
    PetscCall(SamWindowTake(window, whole->offset, level.offset));
  }
  if (guess) PetscCall(SamWindowTake(window, whole->q, level.q));
  PetscCall(SolveLoaded(t, &level, balance, guess));
  if (!guess) SamReturnMemory(); /* the method's, before the whole grid's shear is written to for the first time */
  PetscCall(SamWindowPut(window, level.q, whole->q));
  PetscCall(VecDestroy(&level.bound));
  PetscCall(VecDestroy(&level.offset));
  PetscCall(VecDestroy(&level.q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialSolve(SamTangential t, Vec bound, Vec offset, SamBalance *balance, PetscBool guess, Vec q)
{
  SamGrid   grid;
  PetscReal most;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetGrid(t->elasticity, &grid));
  PetscCheck(balance->kind == SAM_BALANCE_TANGENTIAL, grid->comm, PETSC_ERR_ARG_WRONG,
             "The tangential solver wants a tangential balance");
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_TANGENTIAL_SOLVE], 0, 0, 0, 0));
  SamSolverStart(&t->solver);
  t->limit  = PETSC_INFINITY;
  t->reason = SAM_TANGENTIAL_CONVERGED_ITERATING;
  PetscCall(VecMax(bound, NULL, &most));
  if (most <= 0 || IsUnloaded(balance, offset))
    PetscCall(SolveFree(t, balance, q));
  else {
    SamTangentialLevel level = {.elasticity = t->elasticity,
                                .grid       = grid,
                                .finest     = PETSC_TRUE,
                                .bound      = bound,
                                .offset     = offset,
                                .q          = q,
                                .rtol       = t->solver.rtol};
    PetscInt           first[2], n[2];
    SamWindow          window;
    SamElasticity      part;

    /* shear acts only where there is a bound, and only there its displacement counts */
    PetscCall(SamGridGetSupport(grid, bound, first, n));
    PetscCall(SamElasticityChoosePart(t->elasticity, first, n, PETSC_TRUE, &window, &part));
    if (window)
      PetscCall(SolveInWindow(t, &level, window, part, balance, guess));
    else
      PetscCall(SolveLoaded(t, &level, balance, guess));
  }
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_TANGENTIAL_SOLVE], 0, 0, 0, 0));
  PetscCheck(t->reason, grid->comm, PETSC_ERR_PLIB, "Method %s set no reason", t->solver.type);
  PetscCall(
    SamSolverViewFromOptions(&t->solver, t->reason > 0 ? PETSC_TRUE : PETSC_FALSE, SamTangentialReasonName(t->reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialGetLimit(SamTangential t, PetscReal *factor)
{
  PetscFunctionBegin;
  *factor = t->limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The normal problem as a kind of solver: its starts, its way through nested grids and windows, and the cases without
  contact. The methods are in separate files.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/normalimpl.h>
#include <petsam/private/balance.h>
#include <petsam/private/normal.h>

/* ---- starts ---- */

/*
  Starts without a guess from the contact of the bodies on a bed of springs, as stiff as the half-space under a pressure
  on half the grid, since it has nearly the right cells in contact. It is the admissible pressure nearest to -stiffness
  (h - fixed).
*/
static PetscErrorCode StartAsFoundation(SamLevel *level, PetscBool *found)
{
  const SamGrid   grid = level->grid;
  const SamFrame *f    = &level->frame;
  const Vec       gap  = level->given[SAM_NORMAL_SEPARATION];
  PetscReal       self, least;
  double          stiffness, *p;
  const double   *h;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &self, NULL));
  PetscCall(VecMin(gap, NULL, &least));
  if (f->count == 0 || f->component[0] != 0) least = 0; /* the approach is given, so heights are absolute */
  stiffness = 2 / (self * sqrt((double)grid->nx * (double)grid->ny));
  PetscCall(VecGetArrayRead(gap, &h));
  PetscCall(VecGetArrayWrite(level->traction, &p));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i;

      p[k] = stiffness * (SamFrameNormal(f->fixed, f->xi0 + (double)i * f->dxi, SamFrameEta(f, j)) - (h[k] - least));
      p[k] = PetscMax(p[k], -PETSC_MAX_REAL); /* a hole may be given by an unbounded separation */
    }
  PetscCall(SamFrameProjectNormal(f, NULL, p, found));
  PetscCall(VecRestoreArrayWrite(level->traction, &p));
  PetscCall(VecRestoreArrayRead(gap, &h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Interpolates the pressure of the coarse grid to the fine grid: its values linearly, but not its support, which linear
  interpolation would widen by half a coarse cell. A cell has pressure where the interpolated indicator of the coarse
  contact exceeds 1/2.
*/
static PetscErrorCode Prolong(SamTransfer transfer, const SamLevel *coarse, SamLevel *fine)
{
  const PetscInt cells = fine->grid->cells;
  Vec            indicator;
  const double  *coarse_p;
  double        *p, *in;
  float         *mask;

  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(*mask) * (size_t)cells, &mask));
  PetscCall(SamGridCreateVec(coarse->grid, 1, &indicator));
  PetscCall(VecGetArrayRead(coarse->traction, &coarse_p));
  PetscCall(VecGetArray(indicator, &in));
  for (PetscInt k = 0; k < coarse->grid->cells; k++) in[k] = coarse_p[k] > 0;
  PetscCall(VecRestoreArray(indicator, &in));
  PetscCall(VecRestoreArrayRead(coarse->traction, &coarse_p));
  PetscCall(SamTransferProlong(transfer, indicator, fine->traction));
  PetscCall(VecGetArray(fine->traction, &p));
  for (PetscInt k = 0; k < cells; k++) mask[k] = p[k] > 0.5 ? 1.0f : 0.0f;
  PetscCall(VecRestoreArray(fine->traction, &p));
  PetscCall(SamTransferProlong(transfer, coarse->traction, fine->traction));
  PetscCall(VecGetArray(fine->traction, &p));
  for (PetscInt k = 0; k < cells; k++) p[k] *= (double)mask[k];
  PetscCall(VecRestoreArray(fine->traction, &p));
  PetscCall(VecDestroy(&indicator));
  SamFree(mask);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- one level ---- */

/* Applies the method on this grid; with `guess` from the level's pressure, which is made admissible first. */
static PetscErrorCode SolveHere(SamSolver s, SamLevel *level, PetscBool guess)
{
  PetscBool found;
  double   *p;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&level->frame, level->grid, level->balance));
  level->frame.most = (double)s->pressure_limit;
  if (guess) {
    PetscCall(VecGetArray(level->traction, &p));
    PetscCall(SamFrameProjectNormalOnContact(&level->frame, p, &found));
    PetscCall(VecRestoreArray(level->traction, &p));
  } else {
    PetscCall(StartAsFoundation(level, &found));
  }
  if (found)
    PetscCall(s->ops.solve(s, level));
  else
    s->reason = SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Checks a rough solution on the finest grid without a product: true if the contact, returned as first and size, does
  not touch those borders of the window that are not borders of the grid.
*/
static PetscErrorCode IsInside(const SamLevel *level, SamWindow window, PetscInt first[2], PetscInt size[2],
                               PetscBool *inside)
{
  const PetscInt all[2] = {level->grid->nx, level->grid->ny};
  PetscInt       start[2], n[2];

  PetscFunctionBegin;
  PetscCall(SamWindowGetPlace(window, start, n));
  PetscCall(SamGridGetSupport(level->grid, level->traction, PETSC_FALSE, first, size));
  *inside = PETSC_TRUE;
  for (PetscInt k = 0; k < 2; k++) {
    const PetscBool low  = start[k] > 0 && first[k] <= start[k];
    const PetscBool high = start[k] + n[k] < all[k] && first[k] + size[k] >= start[k] + n[k];

    first[k] -= low; /* enlarges the rectangle, so that a window that covers it is larger */
    size[k] += low + high;
    if (low || high) *inside = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves from the pressure that the level has, in a window about the contact if the contact is small. Coarse grids need
  not be accurate. On the finest grid the cells outside of the window are checked in the end, and the window is widened
  until none of them touches.
*/
static PetscErrorCode SolveInWindows(SamSolver s, SamLevel *level)
{
  PetscInt      first[2], size[2];
  SamWindow     window;
  SamElasticity part;
  PetscBool     done;

  PetscFunctionBegin;
  PetscCall(SamGridGetSupport(level->grid, level->traction, PETSC_FALSE, first, size));
  while (size[0]) {
    PetscCall(SamElasticityChoosePart(level->elasticity, first, size, level->depth == 0, &window, &part));
    if (!window) break;
    PetscCall(SamLevelSolveInWindow(s, level, window, part, PETSC_TRUE, SolveHere));
    if (s->reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) break; /* the window's cells cannot carry the loads */
    done = level->depth > 0 || s->reason < 0;
    if (!done && s->effort == SAM_EFFORT_CHECK_SUPPORT)
      PetscCall(IsInside(level, window, first, size, &done));
    else if (!done)
      PetscCall(SamNormalCheckOutside(s, level, window, first, size, &done));
    if (done) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolveHere(s, level, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on a level. A coarse grid may find no contact, as its cells are too far apart. */
static PetscErrorCode SolveLevel(SamSolver s, SamLevel *level, SamStart start)
{
  PetscReal most = 0;

  PetscFunctionBegin;
  if (start != SAM_START_NONE) PetscCall(VecMax(level->traction, NULL, &most));
  if (most <= 0)
    PetscCall(SolveHere(s, level, PETSC_FALSE));
  else
    PetscCall(SolveInWindows(s, level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- no contact ---- */

/* Computes the overlap of the undeformed bodies in each cell (m), and its maximum. */
static PetscErrorCode ComputeOverlap(SamGrid grid, Vec separation, const SamFrame *f, double overlap[], double *most)
{
  const double *h;

  PetscFunctionBegin;
  *most = -PETSC_MAX_REAL;
  PetscCall(VecGetArrayRead(separation, &h));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i;

      overlap[k] = SamFrameNormal(f->fixed, f->xi0 + (double)i * f->dxi, SamFrameEta(f, j)) - h[k];
      *most      = PetscMax(*most, overlap[k]);
    }
  PetscCall(VecRestoreArrayRead(separation, &h));
  PetscCall(SamMax(grid->comm, 1, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds out if p = 0 is the solution: the load is zero, or the given displacements cause no overlap, or bodies that are
  free to tilt can separate. `apart`: the balance in this case. A rigid-body displacement that is not given is not
  determined by the problem either: the approach becomes 0, or as negative as separation requires, and rotations become
  0, unless separation requires others.
*/
static PetscErrorCode IsSeparated(const SamLevel *level, SamBalance *apart, PetscBool *separated)
{
  const SamBalance *b = level->balance;
  SamFrame          frame;
  double           *overlap, most, a[3];

  PetscFunctionBegin;
  *separated = PETSC_FALSE;
  *apart     = *b;
  for (PetscInt k = 0; k < 3; k++) {
    if (b->force[k] && b->load[k] != 0) PetscFunctionReturn(PETSC_SUCCESS);
    if (b->force[k]) apart->rigid[k] = 0;
    apart->load[k] = 0;
  }
  PetscCall(SamFrameSet(&frame, level->grid, b));
  PetscCall(SamAllocate(sizeof(*overlap) * (size_t)level->grid->cells, &overlap));
  PetscCall(ComputeOverlap(level->grid, level->given[SAM_NORMAL_SEPARATION], &frame, overlap, &most));
  if (b->force[0]) apart->rigid[0] = PetscMin(0, -most);
  *separated = b->force[0] || most <= 0;
  if (!*separated && frame.count) {
    PetscCall(SamFrameClear(&frame, overlap, a, separated));
    SamFrameGetRigid(&frame, a, apart);
  }
  SamFree(overlap);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds out if a given approach has a solution. If a uniform pressure displaces nothing, the mean displacement is 0.
  Then an approach beyond the mean separation leaves a negative gap somewhere under any pressure, and every pressure
  that is high enough reaches the mean separation itself. If pressures have a limit, surfaces yield instead.
*/
static PetscErrorCode CanHold(SamSolver s, const SamLevel *level, PetscBool *can)
{
  const SamGrid grid  = level->grid;
  SamTotal      total = {0};
  double        sum;
  const double *h;

  PetscFunctionBegin;
  *can = PETSC_TRUE;
  if (SamElasticityGetTraits(s->elasticity).mean || level->balance->force[0] || isfinite(s->pressure_limit))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(level->given[SAM_NORMAL_SEPARATION], &h));
  for (PetscInt k = 0; k < grid->cells; k++) SamAdd(&total, h[k]);
  PetscCall(VecRestoreArrayRead(level->given[SAM_NORMAL_SEPARATION], &h));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &sum));
  *can = level->balance->rigid[0] < sum / ((double)grid->nx * (double)grid->ny);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the kind ---- */

/*
  Solves from the guess, or on nested grids; if the guess stagnates, on nested grids. Where the contact of a guess is
  many cells too narrow, the pressure piles up at its edges and opens the gap beyond them, so that the edges move by a
  cell in an iteration; on a coarse grid they move by as many cells as it is coarser.
*/
static PetscErrorCode SolveWithStarts(SamSolver s, SamLevel *level, PetscBool guess)
{
  PetscFunctionBegin;
  PetscCall(SamLevelSolveNested(s, level, SamSolverLevels(s), guess));
  if (s->reason != SAM_SOLVER_DIVERGED_STAGNATED || !guess) PetscFunctionReturn(PETSC_SUCCESS);
  SamLevelForgetProduct(level);
  PetscCall(SamVecZero(level->traction));
  PetscCall(SamLevelSolveNested(s, level, SamSolverLevels(s), PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve(SamSolver s, SamLevel *level, PetscBool guess)
{
  SamBalance apart;
  PetscBool  separated, possible, can;
  char       message[256];

  PetscFunctionBegin;
  PetscCall(IsSeparated(level, &apart, &separated));
  PetscCall(SamBalanceLever(level->grid, level->balance, message, sizeof(message), &possible));
  if (possible)
    PetscCall(SamBalanceCapacity(level->grid, level->balance, s->pressure_limit, message, sizeof(message), &possible));
  PetscCall(CanHold(s, level, &can));
  if (!possible || !can || separated) {
    PetscCall(VecSet(level->traction, 0));
    SamLevelForgetProduct(level);
    s->reason = possible && can ? SAM_SOLVER_CONVERGED_TRIVIAL : SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
    if (s->reason > 0) *level->balance = apart;
  } else {
    PetscCall(SolveWithStarts(s, level, guess));
    SamLevelGetRigid(level, level->balance);
    PetscCall(SamBalanceGetLoads(level->grid, SAM_BALANCE_NORMAL, level->traction, level->balance->load));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamSolverKind kind = {
  .class_id           = SamNormal_CLASSID,
  .name               = "normal",
  .error_help         = "maximum gap error relative to the displacement",
  .balance            = SAM_BALANCE_NORMAL,
  .event              = SAM_EVENT_NORMAL_SOLVE,
  .type               = SAM_NORMAL_ACTIVESET,
  .create             = SamNormalCreate_ActiveSet,
  .rtol               = 1e-8,
  .coarse_rtol        = 1e-4,
  .components         = 1,
  .given_components   = {[SAM_NORMAL_SEPARATION] = 1, [SAM_NORMAL_DIAGONAL] = 1},
  .diagonal           = SAM_NORMAL_DIAGONAL,
  .apply              = SamElasticityApplyNormal,
  .applysingle        = SamElasticityApplyNormalSingle,
  .preconditionsingle = SamElasticityPreconditionNormalSingle,
  .solve              = Solve,
  .solvelevel         = SolveLevel,
  .prolong            = Prolong,
};

PetscErrorCode SamNormalRegister(const char name[], PetscErrorCode (*create)(SamSolver))
{
  PetscFunctionBegin;
  SamValidPointer(name, 1);
  SamValidPointer(create, 2);
  PetscCall(SamSolverRegister(&kind, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalCreate(SamElasticity elasticity, SamNormal *normal)
{
  SamSolver solver;

  PetscFunctionBegin;
  SamValidHandle(elasticity, SamElasticity, 1);
  SamValidPointer(normal, 2);
  PetscCall(SamSolverCreate(&kind, elasticity, &solver));
  *normal = (SamNormal)solver;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalDestroy(SamNormal *normal)
{
  PetscFunctionBegin;
  SamValidPointer(normal, 1);
  if (!*normal) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*normal, SamNormal, 1);
  PetscCall(SamSolverDestroy(SamNormalAsSolver(*normal)));
  *normal = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetPressureLimit(SamNormal normal, PetscReal limit)
{
  PetscFunctionBegin;
  PetscCheck(limit > 0, SamNormalAsSolver(normal)->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "pressure limit %.6g: expected a number > 0, or inf", (double)limit);
  SamNormalAsSolver(normal)->pressure_limit = limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamNormalLimitsPressure(SamNormal normal)
{
  return SamNormalAsSolver(normal)->limits_pressure;
}

static PetscErrorCode SolveProblem(SamNormal normal, Vec h, Vec diagonal, SamBalance *balance, PetscBool guess, Vec p,
                                   SamProduct *product)
{
  const SamSolver s       = SamNormalAsSolver(normal);
  const SamLevel  problem = {.balance  = balance,
                             .given    = {[SAM_NORMAL_SEPARATION] = h, [SAM_NORMAL_DIAGONAL] = diagonal},
                             .traction = p,
                             .product  = product};

  PetscFunctionBegin;
  PetscCheck(!balance->force[0] || balance->load[0] >= 0, s->comm, SAM_ERR_USER, "load_n %.6g: expected a number >= 0",
             (double)balance->load[0]);
  PetscCheck(isinf(s->pressure_limit) || s->limits_pressure, s->comm, PETSC_ERR_SUP,
             "The method %s does not support a pressure limit", s->type);
  PetscCall(SamSolverSolve(s, &problem, guess));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSolve(SamNormal normal, Vec h, SamBalance *balance, PetscBool guess, Vec p)
{
  PetscFunctionBegin;
  SamValidHandle(normal, SamNormal, 1);
  SamValidVec(h, 2);
  SamValidPointer(balance, 3);
  SamValidVec(p, 5);
  SamValidVecOn(SamNormalAsSolver(normal)->comm, 1, h, 2);
  SamValidVecOn(SamNormalAsSolver(normal)->comm, 1, p, 5);
  PetscCall(SolveProblem(normal, h, NULL, balance, guess, p, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSolveKeeping(SamNormal normal, Vec h, SamBalance *balance, PetscBool guess, Vec p,
                                     SamProduct *product)
{
  return SolveProblem(normal, h, NULL, balance, guess, p, product);
}

PetscErrorCode SamNormalSolveYielding(SamNormal normal, Vec h, Vec diagonal, SamBalance *balance, PetscBool guess,
                                      Vec p)
{
  return SolveProblem(normal, h, diagonal, balance, guess, p, NULL);
}

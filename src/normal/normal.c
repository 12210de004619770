/* The normal solver's class: types, tolerances, monitors, nested grids. The methods are in files of their own. */
#include "normalimpl.h"
#include <string.h>

/*
  Coarse grids need to be solved only as well as they approximate the fine one; beyond that their iterations are wasted.
*/
#define COARSE_RTOL 1e-4

static PetscFunctionList SamNormalList  = NULL;
static PetscBool         registered = PETSC_FALSE;

const char *SamNormalReasonName(SamNormalReason reason)
{
  switch (reason) {
  case SAM_NORMAL_CONVERGED_RTOL:
    return "CONVERGED_RTOL";
  case SAM_NORMAL_CONVERGED_SEPARATED:
    return "CONVERGED_SEPARATED";
  case SAM_NORMAL_CONVERGED_ITERATING:
    return "CONVERGED_ITERATING";
  case SAM_NORMAL_DIVERGED_ITS:
    return "DIVERGED_ITS";
  case SAM_NORMAL_DIVERGED_NAN:
    return "DIVERGED_NAN";
  case SAM_NORMAL_DIVERGED_STAGNATED:
    return "DIVERGED_STAGNATED";
  case SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM:
    return "DIVERGED_NO_EQUILIBRIUM";
  }
  return "unknown";
}

PetscErrorCode SamNormalRegister(const char name[], PetscErrorCode (*create)(SamNormal))
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListAdd(&SamNormalList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeList(void)
{
  PetscFunctionBegin;
  registered = PETSC_FALSE;
  PetscCall(PetscFunctionListDestroy(&SamNormalList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RegisterAll(void)
{
  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(SamNormalRegister(SAM_NORMAL_ACTIVESET, SamNormalCreate_ActiveSet));
  PetscCall(SamNormalRegister(SAM_NORMAL_POLONSKYKEER, SamNormalCreate_PolonskyKeer));
  PetscCall(PetscRegisterFinalize(FreeList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalCreate(SamCompliance compliance, SamNormal *normal)
{
  SamNormal n;
  SamGrid   grid;

  PetscFunctionBegin;
  PetscCall(RegisterAll());
  PetscCall(PetscNew(&n));
  PetscCall(SamComplianceReference(compliance));
  PetscCall(SamComplianceGetGrid(compliance, &grid));
  n->compliance        = compliance;
  n->solver.comm       = grid->comm;
  n->solver.owner      = n;
  n->solver.kind       = "normal";
  n->solver.error_help = "largest gap error relative to the displacement";
  n->solver.rtol       = 1e-8;
  PetscCall(SamNormalSetType(n, SAM_NORMAL_ACTIVESET));
  *normal = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalDestroy(SamNormal *normal)
{
  PetscFunctionBegin;
  if (!*normal) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamComplianceDestroy(&(*normal)->compliance));
  PetscCall(PetscFree(*normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetType(SamNormal n, SamNormalType type)
{
  PetscErrorCode (*create)(SamNormal);

  PetscFunctionBegin;
  PetscCall(PetscFunctionListFind(SamNormalList, type, &create));
  PetscCheck(create, n->solver.comm, SAM_ERR_USER, "-%snormal_type %s: expected %s or %s", n->solver.prefix, type, SAM_NORMAL_ACTIVESET, SAM_NORMAL_POLONSKYKEER);
  PetscCall(create(n));
  PetscCall(PetscStrncpy(n->solver.type, type, sizeof(n->solver.type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalGetType(SamNormal n, SamNormalType *type)
{
  PetscFunctionBegin;
  *type = n->solver.type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetOptionsPrefix(SamNormal n, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(PetscStrncpy(n->solver.prefix, prefix ? prefix : "", sizeof(n->solver.prefix)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetTolerances(SamNormal n, PetscReal rtol, PetscInt max_it)
{
  PetscFunctionBegin;
  if (rtol != PETSC_DEFAULT) n->solver.rtol = rtol;
  if (max_it != PETSC_DEFAULT) n->solver.max_it = max_it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalGetTolerances(SamNormal n, PetscReal *rtol, PetscInt *max_it)
{
  PetscFunctionBegin;
  if (rtol) *rtol = n->solver.rtol;
  if (max_it) *max_it = SamSolverMaxIterations(&n->solver);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetLevels(SamNormal n, PetscInt levels)
{
  PetscFunctionBegin;
  n->solver.levels = levels;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalMonitorSet(SamNormal n, SamNormalMonitor monitor, void *context)
{
  PetscFunctionBegin;
  PetscCall(SamSolverMonitorSet(&n->solver, monitor, context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetFromOptions(SamNormal n)
{
  char      type[32];
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(SamSolverSetFromOptions(&n->solver, "activeset or polonskykeer", type, sizeof(type), &set));
  if (set) PetscCall(SamNormalSetType(n, type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalView(SamNormal n, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(SamSolverView(&n->solver, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalApply(SamNormal n, SamNormalLevel *level, Vec p, Vec u)
{
  PetscFunctionBegin;
  n->solver.applies += level->finest ? 1 : 0;
  PetscCall(SamComplianceApplyNormal(level->compliance, p, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalApplySingle(SamNormal n, SamNormalLevel *level, double factor, const float p[], float u[])
{
  PetscFunctionBegin;
  n->solver.applies += level->finest ? 1 : 0;
  PetscCall(SamComplianceApplyNormalSingle(level->compliance, factor, p, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalPreconditionSingle(SamNormal n, SamNormalLevel *level, double factor, const float r[], float z[])
{
  PetscFunctionBegin;
  n->solver.preconditions += level->finest ? 1 : 0;
  PetscCall(SamCompliancePreconditionNormalSingle(level->compliance, factor, r, z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalIterated(SamNormal n, SamNormalLevel *level, PetscReal error)
{
  PetscFunctionBegin;
  if (!level->finest) PetscFunctionReturn(PETSC_SUCCESS);
  n->solver.iterations++;
  PetscCall(SamSolverCallMonitors(&n->solver, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalGetReason(SamNormal n, SamNormalReason *reason)
{
  PetscFunctionBegin;
  *reason = n->reason;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalGetStatistics(SamNormal n, PetscReal *error, PetscInt *iterations, PetscInt *applies, PetscInt *preconditions)
{
  PetscFunctionBegin;
  if (error) *error = n->solver.error;
  if (iterations) *iterations = n->solver.iterations;
  if (applies) *applies = n->solver.applies;
  if (preconditions) *preconditions = n->solver.preconditions;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A start from nothing: the bodies on a bed of springs, as stiff as the half-space is under a pressure over half the grid,
  which has about the right cells in contact. The admissible pressure nearest to -stiffness (h - fixed) is just that.
*/
static PetscErrorCode StartAsFoundation(SamNormalLevel *level, PetscBool *found)
{
  const SamGrid   grid = level->grid;
  const SamFrame *f    = &level->frame;
  PetscReal       self, least;
  double          stiffness, *p;
  const double   *h;

  PetscFunctionBegin;
  PetscCall(SamComplianceGetSelfInfluence(level->compliance, &self, NULL));
  PetscCall(VecMin(level->h, NULL, &least));
  if (f->count == 0 || f->component[0] != 0) least = 0; /* the approach is given: heights are what they are */
  stiffness = 2 / (self * sqrt((double)grid->nx * (double)grid->ny));
  PetscCall(VecGetArrayRead(level->h, &h));
  PetscCall(VecGetArrayWrite(level->p, &p));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i;

      p[k] = stiffness * (SamFrameNormal(f->fixed, f->xi0 + (double)i * f->dxi, SamFrameEta(f, j)) - (h[k] - least));
    }
  PetscCall(SamFrameProjectNormal(f, NULL, p, found));
  PetscCall(VecRestoreArrayWrite(level->p, &p));
  PetscCall(VecRestoreArrayRead(level->h, &h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the start of a level admissible: p >= 0 and in equilibrium. */
static PetscErrorCode MakeAdmissible(SamNormalLevel *level, PetscBool *found)
{
  double *p;

  PetscFunctionBegin;
  PetscCall(VecGetArray(level->p, &p));
  PetscCall(SamFrameProjectNormalOnContact(&level->frame, p, found));
  PetscCall(VecRestoreArray(level->p, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The coarse pressure on the fine grid: linear interpolation of its values, but not of its support, which that would
  widen by half a coarse cell; a cell has pressure where the interpolated indicator of the coarse contact exceeds 1/2.
*/
static PetscErrorCode Prolong(SamTransfer transfer, Vec coarse, Vec fine)
{
  PetscInt      cells, coarse_cells;
  Vec           indicator;
  double       *p, *c;
  char         *mask;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(fine, &cells));
  PetscCall(VecGetLocalSize(coarse, &coarse_cells));
  PetscCall(PetscMalloc1(cells, &mask));
  PetscCall(VecDuplicate(coarse, &indicator));
  PetscCall(VecGetArray(coarse, &p));
  PetscCall(VecGetArray(indicator, &c));
  for (PetscInt k = 0; k < coarse_cells; k++) c[k] = p[k] > 0;
  PetscCall(VecRestoreArray(indicator, &c));
  PetscCall(VecRestoreArray(coarse, &p));
  PetscCall(SamTransferProlong(transfer, indicator, fine));
  PetscCall(VecGetArray(fine, &p));
  for (PetscInt k = 0; k < cells; k++) mask[k] = p[k] > 0.5;
  PetscCall(VecRestoreArray(fine, &p));
  PetscCall(SamTransferProlong(transfer, coarse, fine));
  PetscCall(VecGetArray(fine, &p));
  for (PetscInt k = 0; k < cells; k++)
    if (!mask[k]) p[k] = 0;
  PetscCall(VecRestoreArray(fine, &p));
  PetscCall(VecDestroy(&indicator));
  PetscCall(PetscFree(mask));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on this grid, after the coarser ones when depth > 1. */
static PetscErrorCode SolveLevel(SamNormal n, SamCompliance compliance, PetscInt depth, PetscBool finest, Vec h, const SamBalance *balance, PetscBool guess, Vec p, double rigid[3], SamFrame *frame)
{
  SamNormalLevel level = {.compliance = compliance, .finest = finest, .h = h, .p = p, .rtol = finest ? n->solver.rtol : PetscMax(n->solver.rtol, COARSE_RTOL)};
  SamCompliance  coarse   = NULL;
  SamTransfer    transfer = NULL;
  PetscBool      found;

  PetscFunctionBegin;
  PetscCall(SamComplianceGetGrid(compliance, &level.grid));
  PetscCall(SamFrameSet(&level.frame, level.grid, balance));
  if (depth > 1 && !guess) PetscCall(SamComplianceGetCoarse(compliance, &coarse, &transfer));
  if (coarse) {
    SamGrid  grid;
    SamFrame ignored;
    Vec      hc, pc;

    PetscCall(SamComplianceGetGrid(coarse, &grid));
    PetscCall(SamGridCreateVec(grid, 1, &hc));
    PetscCall(SamGridCreateVec(grid, 1, &pc));
    PetscCall(SamTransferRestrict(transfer, h, hc));
    PetscCall(SolveLevel(n, coarse, depth - 1, PETSC_FALSE, hc, balance, PETSC_FALSE, pc, rigid, &ignored));
    PetscCall(Prolong(transfer, pc, p));
    PetscCall(VecDestroy(&hc));
    PetscCall(VecDestroy(&pc));
  }
  if (coarse || guess) PetscCall(MakeAdmissible(&level, &found));
  else PetscCall(StartAsFoundation(&level, &found));
  if (found) PetscCall(n->solve(n, &level));
  else n->reason = SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM;
  for (PetscInt k = 0; k < 3; k++) rigid[k] = level.rigid[k];
  *frame = level.frame;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The least of h less a given rigid displacement. */
static PetscErrorCode Clearance(SamGrid grid, Vec h, const SamFrame *f, double *clearance)
{
  const double *array;
  double        overlap = -PETSC_MAX_REAL;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(h, &array));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) overlap = PetscMax(overlap, SamFrameNormal(f->fixed, f->xi0 + (double)i * f->dxi, SamFrameEta(f, j)) - array[j * grid->nx + i]);
  PetscCall(VecRestoreArrayRead(h, &array));
  PetscCall(SamMax(grid->comm, 1, &overlap));
  *clearance = -overlap;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* No contact is a solution of its own: no load, or no overlap under displacement control. */
static PetscErrorCode IsSeparated(SamNormal n, Vec h, const SamBalance *balance, PetscBool *separated)
{
  SamGrid  grid;
  SamFrame frame;
  double   clearance;

  PetscFunctionBegin;
  PetscCall(SamComplianceGetGrid(n->compliance, &grid));
  if (balance->force[0]) {
    *separated = balance->load[0] == 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *separated = PETSC_FALSE;
  if ((balance->force[1] && balance->load[1] != 0) || (balance->force[2] && balance->load[2] != 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFrameSet(&frame, grid, balance));
  PetscCall(Clearance(grid, h, &frame, &clearance));
  *separated = clearance >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* p = 0. A free approach is not determined: none, or as far back as the bodies need to clear each other. */
static PetscErrorCode SetSeparated(SamNormal n, Vec h, SamBalance *balance, Vec p)
{
  SamGrid    grid;
  SamBalance still = *balance;
  SamFrame   frame;
  double     clearance;

  PetscFunctionBegin;
  PetscCall(VecSet(p, 0));
  PetscCall(SamComplianceGetGrid(n->compliance, &grid));
  for (PetscInt k = 0; k < 3; k++) {
    if (balance->force[k]) still.rigid[k] = 0;
    still.force[k] = PETSC_FALSE;
  }
  PetscCall(SamFrameSet(&frame, grid, &still));
  PetscCall(Clearance(grid, h, &frame, &clearance));
  if (balance->force[0]) still.rigid[0] = PetscMin(0, clearance);
  for (PetscInt k = 0; k < 3; k++) {
    balance->rigid[k] = still.rigid[k];
    balance->load[k]  = 0;
  }
  n->reason = SAM_NORMAL_CONVERGED_SEPARATED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSolve(SamNormal n, Vec h, SamBalance *balance, PetscBool guess, Vec p)
{
  SamGrid   grid;
  PetscBool separated, possible;
  char      message[256];

  PetscFunctionBegin;
  PetscCall(SamComplianceGetGrid(n->compliance, &grid));
  PetscCheck(balance->kind == SAM_BALANCE_NORMAL, grid->comm, PETSC_ERR_ARG_WRONG, "The normal solver wants a normal balance");
  PetscCheck(!balance->force[0] || balance->load[0] >= 0, grid->comm, SAM_ERR_USER, "load_n %g: expected a number >= 0", (double)balance->load[0]);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_NORMAL_SOLVE], 0, 0, 0, 0));
  SamSolverStart(&n->solver);
  n->reason = SAM_NORMAL_CONVERGED_ITERATING;
  PetscCall(IsSeparated(n, h, balance, &separated));
  PetscCall(SamBalanceLever(grid, balance, message, sizeof(message), &possible));
  if (!possible) {
    PetscCall(VecSet(p, 0));
    n->reason = SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM;
  } else if (separated) {
    PetscCall(SetSeparated(n, h, balance, p));
  } else {
    double   rigid[3];
    SamFrame frame;

    PetscCall(SolveLevel(n, n->compliance, SamSolverLevels(&n->solver), PETSC_TRUE, h, balance, guess, p, rigid, &frame));
    for (PetscInt k = 0; k < 3; k++) rigid[k] -= frame.fixed[k];
    SamFrameGetRigid(&frame, rigid, balance);
    PetscCall(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, p, balance->load));
  }
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_NORMAL_SOLVE], 0, 0, 0, 0));
  PetscCheck(n->reason, grid->comm, PETSC_ERR_PLIB, "Method %s set no reason", n->solver.type);
  PetscCall(SamSolverViewFromOptions(&n->solver, n->reason > 0 ? PETSC_TRUE : PETSC_FALSE, SamNormalReasonName(n->reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

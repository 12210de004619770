/*
  The normal solver's class: types, tolerances, monitors, nested grids, windows. The methods are in files of their own.
*/
#include <petsam/private/normalimpl.h>

/*
  Coarse grids need to be solved only as well as they approximate the fine one; beyond that their iterations are wasted.
*/
#define COARSE_RTOL 1e-4
/*
  Gaps outside a window, relative to the largest displacement, that rounding in single precision cannot be blamed for.
*/
#define CLEARANCE 1e-5

static PetscFunctionList SamNormalList = NULL;
static PetscBool         registered    = PETSC_FALSE;

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

PetscErrorCode SamNormalCreate(SamElasticity elasticity, SamNormal *normal)
{
  SamNormal n;
  SamGrid   grid;

  PetscFunctionBegin;
  PetscCall(RegisterAll());
  PetscCall(PetscNew(&n));
  PetscCall(SamElasticityReference(elasticity));
  PetscCall(SamElasticityGetGrid(elasticity, &grid));
  n->elasticity        = elasticity;
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
  PetscCall(SamElasticityDestroy(&(*normal)->elasticity));
  PetscCall(PetscFree(*normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSetType(SamNormal n, SamNormalType type)
{
  PetscErrorCode (*create)(SamNormal);

  PetscFunctionBegin;
  PetscCall(PetscFunctionListFind(SamNormalList, type, &create));
  PetscCheck(create, n->solver.comm, SAM_ERR_USER, "-%snormal_type %s: expected %s or %s", n->solver.prefix, type,
             SAM_NORMAL_ACTIVESET, SAM_NORMAL_POLONSKYKEER);
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
  PetscCall(SamElasticityApplyNormal(level->elasticity, p, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalApplySingle(SamNormal n, SamNormalLevel *level, double factor, const float p[], float u[])
{
  PetscFunctionBegin;
  n->solver.applies += level->finest ? 1 : 0;
  PetscCall(SamElasticityApplyNormalSingle(level->elasticity, factor, p, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalPreconditionSingle(SamNormal n, SamNormalLevel *level, double factor, const float r[],
                                           float z[])
{
  PetscFunctionBegin;
  n->solver.preconditions += level->finest ? 1 : 0;
  PetscCall(SamElasticityPreconditionNormalSingle(level->elasticity, factor, r, z));
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

PetscErrorCode SamNormalGetStatistics(SamNormal n, PetscReal *error, PetscInt *iterations, PetscInt *applies,
                                      PetscInt *preconditions)
{
  PetscFunctionBegin;
  if (error) *error = n->solver.error;
  if (iterations) *iterations = n->solver.iterations;
  if (applies) *applies = n->solver.applies;
  if (preconditions) *preconditions = n->solver.preconditions;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A start from nothing: the bodies on a bed of springs, as stiff as the half-space is under a pressure over half the
  grid, which has about the right cells in contact. The admissible pressure nearest to -stiffness (h - fixed) is just
  that.
*/
static PetscErrorCode StartAsFoundation(SamNormalLevel *level, PetscBool *found)
{
  const SamGrid   grid = level->grid;
  const SamFrame *f    = &level->frame;
  PetscReal       self, least;
  double          stiffness, *p;
  const double   *h;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &self, NULL));
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
  The pressure of the coarse `grid` on the fine one: linear interpolation of its values, but not of its support, which
  that would widen by half a coarse cell; a cell has pressure where the interpolated indicator of the coarse contact
  exceeds 1/2.
*/
static PetscErrorCode Prolong(SamGrid grid, SamTransfer transfer, Vec coarse, Vec fine)
{
  PetscInt cells, coarse_cells;
  Vec      indicator;
  double  *p, *c;
  float   *mask;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(fine, &cells));
  PetscCall(VecGetLocalSize(coarse, &coarse_cells));
  PetscCall(SamAllocate(sizeof(*mask) * (size_t)cells, &mask));
  PetscCall(SamGridCreateVec(grid, 1, &indicator));
  PetscCall(VecGetArray(coarse, &p));
  PetscCall(VecGetArray(indicator, &c));
  for (PetscInt k = 0; k < coarse_cells; k++) c[k] = p[k] > 0;
  PetscCall(VecRestoreArray(indicator, &c));
  PetscCall(VecRestoreArray(coarse, &p));
  PetscCall(SamTransferProlong(transfer, indicator, fine));
  PetscCall(VecGetArray(fine, &p));
  for (PetscInt k = 0; k < cells; k++) mask[k] = p[k] > 0.5 ? 1.0f : 0.0f;
  PetscCall(VecRestoreArray(fine, &p));
  PetscCall(SamTransferProlong(transfer, coarse, fine));
  PetscCall(VecGetArray(fine, &p));
  for (PetscInt k = 0; k < cells; k++) p[k] *= (double)mask[k];
  PetscCall(VecRestoreArray(fine, &p));
  PetscCall(VecDestroy(&indicator));
  SamFree(mask);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The method on this grid from the start in p. */
static PetscErrorCode SolveHere(SamNormal n, SamNormalLevel *level, const SamBalance *balance,
                                PetscErrorCode (*start)(SamNormalLevel *, PetscBool *))
{
  PetscBool found;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&level->frame, level->grid, balance));
  PetscCall(start(level, &found));
  if (found)
    PetscCall(n->solve(n, level));
  else
    n->reason = SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same on a window: fields taken out, the pressure put back. */
static PetscErrorCode SolveInWindow(SamNormal n, SamNormalLevel *whole, const SamBalance *balance, SamWindow window,
                                    SamElasticity part)
{
  SamNormalLevel level = {.elasticity = part, .rtol = whole->rtol, .finest = whole->finest};

  PetscFunctionBegin;
  PetscCall(SamWindowGetGrid(window, &level.grid));
  PetscCall(SamGridCreateVec(level.grid, 1, &level.h));
  PetscCall(SamGridCreateVec(level.grid, 1, &level.p));
  PetscCall(SamWindowTake(window, whole->h, level.h));
  PetscCall(SamWindowTake(window, whole->p, level.p));
  PetscCall(SolveHere(n, &level, balance, MakeAdmissible));
  PetscCall(SamWindowPut(window, level.p, whole->p));
  whole->frame = level.frame;
  for (PetscInt k = 0; k < 3; k++) whole->rigid[k] = level.rigid[k];
  PetscCall(VecDestroy(&level.h));
  PetscCall(VecDestroy(&level.p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rigid displacements of a level's solution. */
static void GetRigid(const SamNormalLevel *level, SamBalance *balance)
{
  double a[3];

  for (PetscInt k = 0; k < 3; k++) a[k] = level->rigid[k] - level->frame.fixed[k];
  SamFrameGetRigid(&level->frame, a, balance);
}

/* Raises the largest displacement v = scale u, and what is nearest to touching: motion - h - v. */
SAM_VECTORIZED static void NearestStretch(PetscInt n, const float *restrict u, const double *restrict h, double scale,
                                          double xi0, double dxi, double eta, const double motion[3], double max[2])
{
  const double a = motion[0] - motion[1] * eta, b = motion[2];
  double       displacement = max[0], nearest = max[1];

#pragma omp simd reduction(max : displacement, nearest)
  for (PetscInt i = 0; i < n; i++) {
    const double v = scale * (double)u[i], overlap = a + b * (xi0 + (double)i * dxi) - h[i] - v;

    displacement = v > displacement ? v : displacement;
    nearest      = overlap > nearest ? overlap : nearest;
  }
  max[0] = displacement;
  max[1] = nearest;
}

SAM_VECTORIZED static void ToSingle(PetscInt n, const double *restrict p, double factor, float *restrict u)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) u[i] = (float)(factor * p[i]);
}

/* Whether in single precision no cell outside the window comes near to touching. */
static PetscErrorCode IsClear(SamNormal n, SamNormalLevel *level, const SamFrame *frame, SamWindow window,
                              PetscBool *clear)
{
  const SamGrid grid = level->grid;
  PetscInt      first[2], size[2];
  PetscReal     self, most;
  double        scale, max[2] = {0, -PETSC_MAX_REAL}; /* largest displacement, and nearest to touching */
  const double *p, *h;
  float        *u;

  PetscFunctionBegin;
  PetscCall(SamWindowGetPlace(window, first, size));
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &self, NULL));
  PetscCall(VecMax(level->p, NULL, &most));
  scale = self * most;
  PetscCall(SamAllocate(sizeof(*u) * (size_t)grid->cells, &u));
  PetscCall(VecGetArrayRead(level->p, &p));
  ToSingle(grid->cells, p, 1 / most, u);
  PetscCall(VecRestoreArrayRead(level->p, &p));
  PetscCall(SamNormalApplySingle(n, level, 1 / self, u, u));
  PetscCall(VecGetArrayRead(level->h, &h));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscBool inside =
      (grid->row_start + j >= first[1] && grid->row_start + j < first[1] + size[1]) ? PETSC_TRUE : PETSC_FALSE;
    const PetscInt begin[3] = {0, first[0], first[0] + size[0]}, end[3] = {first[0], first[0] + size[0], grid->nx};
    double         within[2] = {0, 0}; /* of the window only the displacement counts */

    for (PetscInt part = 0; part < 3; part++) {
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + begin[part];

      NearestStretch(end[part] - begin[part], u + k, h + k, scale, frame->xi0 + (double)begin[part] * frame->dxi,
                     frame->dxi, SamFrameEta(frame, j), frame->fixed, inside && part == 1 ? within : max);
    }
    max[0] = PetscMax(max[0], within[0]);
  }
  PetscCall(VecRestoreArrayRead(level->h, &h));
  SamFree(u);
  PetscCall(SamMax(grid->comm, 2, max));
  *clear = max[1] < -CLEARANCE * max[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The smallest rectangle that holds the contact and all cells that penetrate outside the window. */
static PetscErrorCode FindTouching(SamNormal n, SamNormalLevel *level, const SamFrame *frame, SamWindow window,
                                   PetscInt first[2], PetscInt size[2])
{
  const SamGrid grid = level->grid;
  PetscReal     most;
  const double *p, *h;
  double       *u;
  Vec           touching;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &touching));
  PetscCall(SamNormalApply(n, level, level->p, touching));
  PetscCall(VecNorm(touching, NORM_INFINITY, &most));
  PetscCall(VecGetArray(touching, &u));
  PetscCall(VecGetArrayRead(level->p, &p));
  PetscCall(VecGetArrayRead(level->h, &h));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt  cell[2] = {i, grid->row_start + j}, one[2] = {1, 1};
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + i;
      const double    gap =
        u[k] + h[k] - SamFrameNormal(frame->fixed, frame->xi0 + (double)i * frame->dxi, SamFrameEta(frame, j));

      u[k] = p[k] > 0 || (gap < -level->rtol * most && !SamWindowCovers(window, cell, one));
    }
  PetscCall(VecRestoreArrayRead(level->h, &h));
  PetscCall(VecRestoreArrayRead(level->p, &p));
  PetscCall(VecRestoreArray(touching, &u));
  PetscCall(SamGridGetSupport(grid, touching, first, size));
  PetscCall(VecDestroy(&touching));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the bodies are apart outside the window; if not, the rectangle that holds all contact. */
static PetscErrorCode LookOutside(SamNormal n, SamNormalLevel *level, const SamBalance *balance, SamWindow window,
                                  PetscInt first[2], PetscInt size[2], PetscBool *apart)
{
  SamBalance found = *balance;
  SamFrame   frame;

  PetscFunctionBegin;
  GetRigid(level, &found);
  PetscCall(SamFrameSetGiven(&frame, level->grid, &found));
  PetscCall(IsClear(n, level, &frame, window, apart));
  if (*apart) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindTouching(n, level, &frame, window, first, size));
  *apart = SamWindowCovers(window, first, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  On this grid from the start in p, on a window about the contact while that is small. On the finest grid what lies
  outside is looked at in the end, and the window widened until nothing touches there.
*/
static PetscErrorCode SolveNear(SamNormal n, SamNormalLevel *level, const SamBalance *balance)
{
  PetscInt      first[2], size[2];
  SamWindow     window;
  SamElasticity part;
  PetscBool     done;

  PetscFunctionBegin;
  PetscCall(SamGridGetSupport(level->grid, level->p, first, size));
  while (size[0]) {
    PetscCall(SamElasticityChoosePart(level->elasticity, first, size, level->finest, &window, &part));
    if (!window) break;
    PetscCall(SolveInWindow(n, level, balance, window, part));
    if (n->reason == SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM) break; /* the window's cells cannot carry the loads */
    done = (!level->finest || n->reason < 0) ? PETSC_TRUE : PETSC_FALSE;
    if (!done) PetscCall(LookOutside(n, level, balance, window, first, size, &done));
    if (done) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolveHere(n, level, balance, MakeAdmissible));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves on this grid, after the coarser ones when depth > 1; with guess from p. */
static PetscErrorCode SolveLevel(SamNormal n, SamNormalLevel *level, PetscInt depth, const SamBalance *balance,
                                 PetscBool guess)
{
  SamNormalLevel lower = {.rtol = PetscMax(n->solver.rtol, COARSE_RTOL)};
  SamTransfer    transfer;

  PetscFunctionBegin;
  if (depth > 1 && !guess) PetscCall(SamElasticityGetCoarse(level->elasticity, &lower.elasticity, &transfer));
  if (lower.elasticity) {
    PetscCall(SamElasticityGetGrid(lower.elasticity, &lower.grid));
    PetscCall(SamGridCreateVec(lower.grid, 1, &lower.h));
    PetscCall(SamGridCreateVec(lower.grid, 1, &lower.p));
    PetscCall(SamTransferRestrict(transfer, level->h, lower.h));
    PetscCall(SolveLevel(n, &lower, depth - 1, balance, PETSC_FALSE));
    PetscCall(Prolong(lower.grid, transfer, lower.p, level->p));
    PetscCall(VecDestroy(&lower.h));
    PetscCall(VecDestroy(&lower.p));
  }
  if (lower.elasticity || guess)
    PetscCall(SolveNear(n, level, balance));
  else
    PetscCall(SolveHere(n, level, balance, StartAsFoundation));
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
    for (PetscInt i = 0; i < grid->nx; i++)
      overlap = PetscMax(overlap, SamFrameNormal(f->fixed, f->xi0 + (double)i * f->dxi, SamFrameEta(f, j)) -
                                    array[j * grid->nx + i]);
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
  PetscCall(SamElasticityGetGrid(n->elasticity, &grid));
  if (balance->force[0]) {
    *separated = balance->load[0] == 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *separated = PETSC_FALSE;
  if ((balance->force[1] && balance->load[1] != 0) || (balance->force[2] && balance->load[2] != 0))
    PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCall(SamElasticityGetGrid(n->elasticity, &grid));
  for (PetscInt k = 0; k < 3; k++)
    if (balance->force[k]) still.rigid[k] = 0;
  PetscCall(SamFrameSetGiven(&frame, grid, &still));
  PetscCall(Clearance(grid, h, &frame, &clearance));
  if (balance->force[0]) still.rigid[0] = PetscMin(0, clearance);
  for (PetscInt k = 0; k < 3; k++) {
    balance->rigid[k] = still.rigid[k];
    balance->load[k]  = 0;
  }
  n->reason = SAM_NORMAL_CONVERGED_SEPARATED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Whether a given approach can be held at all. Where a uniform pressure displaces nothing, displacements have no mean:
  an approach beyond the mean separation leaves a gap below 0 somewhere under any pressure, and the mean itself is
  reached by every pressure that is high enough.
*/
static PetscErrorCode CanHold(SamNormal n, Vec h, const SamBalance *balance, PetscBool *can)
{
  SamElasticityTraits traits;
  SamGrid             grid;
  SamTotal            total = {0, 0};
  double              sum;
  const double       *array;

  PetscFunctionBegin;
  *can = PETSC_TRUE;
  PetscCall(SamElasticityGetTraits(n->elasticity, &traits));
  if (traits.mean || balance->force[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityGetGrid(n->elasticity, &grid));
  PetscCall(VecGetArrayRead(h, &array));
  for (PetscInt k = 0; k < grid->cells; k++) SamAdd(&total, array[k]);
  PetscCall(VecRestoreArrayRead(h, &array));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &sum));
  *can = balance->rigid[0] < sum / ((double)grid->nx * (double)grid->ny) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalSolve(SamNormal n, Vec h, SamBalance *balance, PetscBool guess, Vec p)
{
  SamGrid   grid;
  PetscBool separated, possible, can;
  char      message[256];

  PetscFunctionBegin;
  PetscCall(SamElasticityGetGrid(n->elasticity, &grid));
  PetscCheck(balance->kind == SAM_BALANCE_NORMAL, grid->comm, PETSC_ERR_ARG_WRONG,
             "The normal solver wants a normal balance");
  PetscCheck(!balance->force[0] || balance->load[0] >= 0, grid->comm, SAM_ERR_USER, "load_n %g: expected a number >= 0",
             (double)balance->load[0]);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_NORMAL_SOLVE], 0, 0, 0, 0));
  SamSolverStart(&n->solver);
  n->reason = SAM_NORMAL_CONVERGED_ITERATING;
  PetscCall(IsSeparated(n, h, balance, &separated));
  PetscCall(SamBalanceLever(grid, balance, message, sizeof(message), &possible));
  PetscCall(CanHold(n, h, balance, &can));
  if (!possible || !can) {
    PetscCall(VecSet(p, 0));
    n->reason = SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM;
  } else if (separated) {
    PetscCall(SetSeparated(n, h, balance, p));
  } else {
    SamNormalLevel level = {
      .elasticity = n->elasticity, .grid = grid, .h = h, .p = p, .rtol = n->solver.rtol, .finest = PETSC_TRUE};

    PetscCall(SolveLevel(n, &level, SamSolverLevels(&n->solver), balance, guess));
    GetRigid(&level, balance);
    PetscCall(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, p, balance->load));
  }
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_NORMAL_SOLVE], 0, 0, 0, 0));
  PetscCheck(n->reason, grid->comm, PETSC_ERR_PLIB, "Method %s set no reason", n->solver.type);
  PetscCall(
    SamSolverViewFromOptions(&n->solver, n->reason > 0 ? PETSC_TRUE : PETSC_FALSE, SamNormalReasonName(n->reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

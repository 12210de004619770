/*
  The independent check of a solution.

  Recomputed are the elastic displacements, from the tractions in double precision on the whole grid; gap and slip, from
  their definitions; and the bound of the shear, from the pressure. The errors are relative to the solution's own
  scales, by the formulas in check.h.
*/
#include <petsam/check.h>
#include <petsam/normal.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/tangential.h>
#include <petsam/private/balance.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>

/* Adds the tangential displacement by the total pressure, and the normal displacement by the shear. */
static PetscErrorCode AddCoupling(SamElasticity elasticity, SamGrid grid, Vec total, const SamSolution *s)
{
  Vec u;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &u));
  PetscCall(SamElasticityApplyTangentialToNormal(elasticity, s->shear, u));
  PetscCall(VecAXPY(s->displacement_z, 1, u));
  PetscCall(VecDestroy(&u));
  PetscCall(SamGridCreateVec(grid, 2, &u));
  PetscCall(SamElasticityApplyNormalToTangential(elasticity, total, u));
  PetscCall(VecAXPY(s->displacement_t, 1, u));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Subtracts the displacement by the tension, unless u_z is known and has it; `most`: the largest displacement by the
   tension or the pressure of contact, which cancel each other. */
static PetscErrorCode SubtractTension(SamElasticity elasticity, SamGrid grid, PetscBool u_z_known, const SamSolution *s,
                                      PetscReal *most)
{
  PetscReal pulled, pressed = 0;
  Vec       u;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &u));
  PetscCall(SamElasticityApplyNormal(elasticity, s->tension, u));
  PetscCall(VecNorm(u, NORM_INFINITY, &pulled));
  if (u_z_known) {
    PetscCall(VecAXPY(u, 1, s->displacement_z));
    PetscCall(VecNorm(u, NORM_INFINITY, &pressed));
  } else {
    PetscCall(VecAXPY(s->displacement_z, -1, u));
  }
  PetscCall(VecDestroy(&u));
  *most = PetscMax(*most, PetscMax(pulled, pressed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes u_z (unless it is given) and u_t with the coupling; and max |u_z| before other displacements, also that by
   tension, could cancel it. */
static PetscErrorCode ComputeDisplacements(SamProblem problem, SamState state, PetscBool coupling, PetscBool u_z_known,
                                           const SamSolution *s, PetscReal *most)
{
  PetscReal           shear;
  Vec                 total;
  const SamGrid       grid       = SamProblemGetGrid(problem);
  const SamElasticity elasticity = SamProblemGetElasticity(problem);
  const PetscBool     coupled    = SamElasticityGetTraits(elasticity).coupled && coupling;

  PetscFunctionBegin;
  if (!u_z_known) PetscCall(SamElasticityApplyNormal(elasticity, s->pressure, s->displacement_z));
  PetscCall(VecNorm(s->shear, NORM_INFINITY, &shear));
  if (shear != 0)
    PetscCall(SamElasticityApplyTangential(elasticity, s->shear, s->displacement_t));
  else
    PetscCall(SamVecZero(s->displacement_t));
  PetscCall(SamSolutionCreateTotal(problem, s, &total));
  if (coupled) PetscCall(AddCoupling(elasticity, grid, total, s));
  PetscCall(SamSolutionDestroyTotal(s, &total));
  PetscCall(VecNorm(s->displacement_z, NORM_INFINITY, most));
  if (s->tension) PetscCall(SubtractTension(elasticity, grid, u_z_known, s, most));
  PetscCall(SamProblemDisplace(problem, state, &s->control, u_z_known ? NULL : s->displacement_z, s->displacement_t,
                               NULL, NULL));
  PetscCall(SamElasticityTrim(elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { GAP, TENSION, DISPLACEMENT, PRESSURE, OPENING, EDGE, COUNT };

/*
  Updates the maxima with a row's values, except for EDGE; a NaN makes the gap's error infinite. Cells at the limit
  of the pressure may overlap: they yield.
*/
SAM_VECTORIZED static void NormalRow(PetscInt n, const double *restrict p, const double *restrict g, double saturated,
                                     double max[COUNT])
{
  double gap = 0, tension = 0, pressure = 0, opening = 0, nan = 0;

#pragma omp simd reduction(max : gap, tension, pressure, opening) reduction(+ : nan)
  for (PetscInt i = 0; i < n; i++) {
    const double pressed = p[i] < saturated ? fabs(g[i]) : g[i], wrong = p[i] > 0 ? pressed : -g[i];

    gap      = wrong > gap ? wrong : gap;
    opening  = g[i] > opening ? g[i] : opening;
    tension  = -p[i] > tension ? -p[i] : tension;
    pressure = p[i] > pressure ? p[i] : pressure;
    nan += p[i] + g[i] == p[i] + g[i] ? 0 : 1;
  }
  max[GAP]      = nan > 0 ? INFINITY : SamLarger(max[GAP], gap);
  max[OPENING]  = PetscMax(max[OPENING], opening);
  max[TENSION]  = PetscMax(max[TENSION], tension);
  max[PRESSURE] = PetscMax(max[PRESSURE], pressure);
}

/*
  The outer columns and rows, at the low and the high end of x and y: at the grid's border, outside a patch or outside
  the surface that a body has on the grid, or with material that has entered the grid.
*/
typedef struct {
  PetscInt low[2], high[2];
} Border;

static Border BorderOf(SamProblem problem, SamState state, SamGrid grid, const SamSolution *s)
{
  const SamElasticityTraits traits       = SamElasticityGetTraits(SamProblemGetElasticity(problem));
  PetscReal                 enters[3][2] = {{0}, {0}, {s->roll[0], s->roll[1]}};
  Border                    b            = {{0}, {0}};

  for (PetscInt body = 0; body < 2; body++) (void)SamProblemGetOffset(problem, state, SAM_TRIED, body, enters[body]);
  for (int k = 0; k < 3; k++) {
    PetscInt low[2], high[2];

    SamGridEntering(grid, enters[k], low, high);
    for (int axis = 0; axis < 2; axis++) {
      b.low[axis]  = PetscMax(b.low[axis], low[axis]);
      b.high[axis] = PetscMax(b.high[axis], high[axis]);
    }
  }
  for (int axis = 0; axis < grid->axes; axis++) {
    b.low[axis]  = PetscMax(b.low[axis], PetscMax(traits.outside[axis][0], 1));
    b.high[axis] = PetscMax(b.high[axis], PetscMax(traits.outside[axis][1], 1));
  }
  return b;
}

/* Returns the largest pressure in those cells of a row that lie outside this border. */
static double EdgeOfRow(SamGrid grid, const Border *b, PetscInt j, const double p[])
{
  const PetscInt row = grid->row_start + j, nx = grid->nx;
  const PetscInt low  = row < b->low[1] || row >= grid->ny - b->high[1] ? nx : b->low[0];
  double         most = 0;

  for (PetscInt i = 0; i < low; i++) most = PetscMax(most, p[i]);
  for (PetscInt i = nx - b->high[0]; i < nx; i++) most = PetscMax(most, p[i]);
  return most;
}

/* Computes the errors of the normal problem from the maxima, under a limit of the pressure. */
static void SetNormal(const double max[COUNT], double limit, SamCheck *check)
{
  check->edge   = max[PRESSURE] > 0 ? max[EDGE] / max[PRESSURE] : 0;
  check->normal = max[TENSION] > 0 ? max[TENSION] / PetscMax(max[PRESSURE], max[TENSION]) : 0;
  check->normal = PetscMax(check->normal, max[PRESSURE] > limit ? max[PRESSURE] / limit - 1 : 0);
  /* Without contact there is no displacement; then the largest opening is the scale. */
  if (max[GAP] > 0) {
    const double scale = max[DISPLACEMENT] > 0 ? max[DISPLACEMENT] : max[OPENING];

    check->normal = PetscMax(check->normal, scale > 0 ? max[GAP] / scale : INFINITY);
  }
}

/* Computes the relative rounding error of the gap, from the largest pressure and shear. */
static PetscErrorCode SetRounding(SamProblem problem, const SamSolution *s, const double max[COUNT], SamCheck *check)
{
  PetscReal     self, shear;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(SamProblemGetElasticity(problem), &self, NULL));
  PetscCall(VecNorm(s->shear, NORM_INFINITY, &shear));
  if (max[DISPLACEMENT] > 0)
    check->rounding =
      SamGapRounding(PetscMax(max[PRESSURE], (double)shear), (double)self, (double)grid->nx * (double)grid->ny,
                     (double)s->rigid[SAM_COMPONENT_N], max[DISPLACEMENT]) /
      max[DISPLACEMENT];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the normal problem, with the gap that the surfaces had before the step. */
static PetscErrorCode CheckNormal(SamProblem problem, SamState state, const SamSolution *s, PetscReal most,
                                  SamCheck *check)
{
  double        max[COUNT] = {0}, *gap;
  const double *p, *u, *h;
  PetscReal     limit;
  SamRigid      motion;
  Border        border;
  Vec           separation;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateSeparation(problem, state, SAM_COMMITTED, &separation));
  border = BorderOf(problem, state, grid, s);
  PetscCall(SamRigidSet(&motion, problem, s));
  PetscCall(SamProblemGetPressureLimit(problem, &limit));
  PetscCall(PetscMalloc1(grid->nx, &gap));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->displacement_z, &u));
  PetscCall(VecGetArrayRead(separation, &h));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * grid->nx;

    SamRigidGap(&motion, SamRigidOfGap(&motion, j), u + k, h + k, gap);
    NormalRow(grid->nx, p + k, gap, SAM_SATURATED * (double)limit, max);
    max[EDGE] = PetscMax(max[EDGE], EdgeOfRow(grid, &border, j, p + k));
  }
  PetscCall(VecRestoreArrayRead(separation, &h));
  PetscCall(VecRestoreArrayRead(s->displacement_z, &u));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(PetscFree(gap));
  PetscCall(SamSolutionDestroySeparation(problem, &separation));
  PetscCall(SamMax(grid->comm, COUNT, max));
  max[DISPLACEMENT] = (double)most;
  SetNormal(max, (double)limit, check);
  PetscCall(SetRounding(problem, s, max, check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Checks the tension by its difference from that of the gap: its displacement relative to that by all tractions, which
  is the scale of the gap's error, and its load.
*/
static PetscErrorCode CheckTension(SamProblem problem, SamState state, const SamSolution *s, PetscReal most,
                                   SamCheck *check)
{
  PetscReal     error, load;
  Vec           h, gap, tension;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  if (!s->tension) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(grid, 1, &gap));
  PetscCall(SamGridCreateVec(grid, 1, &tension));
  PetscCall(SamSolutionCreateSeparation(problem, state, SAM_COMMITTED, &h));
  PetscCall(SamSolutionComputeGap(problem, s, s->displacement_z, h, gap));
  PetscCall(SamSolutionDestroySeparation(problem, &h));
  PetscCall(SamProblemAttract(problem, gap, tension));
  PetscCall(VecAXPY(tension, -1, s->tension));
  PetscCall(SamElasticityApplyNormal(SamProblemGetElasticity(problem), tension, gap));
  PetscCall(VecNorm(gap, NORM_INFINITY, &error));
  PetscCall(SamSolutionTensionError(problem, s, tension, &load));
  check->normal = PetscMax(check->normal, load);
  if (error > 0) check->normal = PetscMax(check->normal, most > 0 ? error / most : INFINITY);
  PetscCall(VecDestroy(&tension));
  PetscCall(VecDestroy(&gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sums over the cells: squares of the residual, of q, of D(q - ds/c), and of the residual's least scale, which is a part
  of the bound. Also the largest |q| - mu p and the largest mu p.
*/
typedef struct {
  double sums[4], over, most;
} TangentialSums;

/* Computes the sums of one row, from its bound, its shear and its slip increment (x, y); `inverse` is 1/c. */
SAM_VECTORIZED static TangentialSums TangentialRow(PetscInt n, const double *restrict bound, const double *const q[2],
                                                   const double *const ds[2], double inverse)
{
  const double *restrict qx = q[0], *restrict qy = q[1], *restrict sx = ds[0], *restrict sy = ds[1];
  double residual = 0, shear = 0, projected = 0, least = 0, over = 0, most = 0;

#pragma omp simd reduction(+ : residual, shear, projected, least) reduction(max : over, most)
  for (PetscInt i = 0; i < n; i++) {
    const double b = bound[i], yx = qx[i] - inverse * sx[i], yy = qy[i] - inverse * sy[i], y2 = yx * yx + yy * yy;
    const double scale = y2 > b * b ? b / sqrt(y2) : 1, rx = qx[i] - scale * yx, ry = qy[i] - scale * yy,
                 q2 = qx[i] * qx[i] + qy[i] * qy[i], beyond = sqrt(q2) - b;

    residual += rx * rx + ry * ry;
    shear += q2;
    projected += scale * scale * y2;
    least += SAM_SHEAR_FLOOR * SAM_SHEAR_FLOOR * b * b;
    over = beyond > over ? beyond : over;
    most = b > most ? b : most;
  }
  return (TangentialSums){{residual, shear, projected, least}, over, most};
}

/* Recomputes the bound of the shear from pressure and slip; where the pressure is negative the bound is 0. */
static PetscErrorCode CreateBound(SamProblem problem, SamState state, const SamSolution *before, const SamSolution *s,
                                  Vec *bound)
{
  SamBoundAt    at = {state, &s->control, NULL, NULL, s->rolled};
  double       *b;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, bound));
  PetscCall(SamVecCopyNonzero(s->pressure, *bound));
  PetscCall(VecGetArray(*bound, &b));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (b[k] < 0) b[k] = 0;
  PetscCall(VecRestoreArray(*bound, &b));
  if (SamProblemFollowsSlip(problem)) {
    PetscCall(SamGridCreateVec(grid, 1, &at.slip));
    PetscCall(SamSolutionComputeFriction(problem, before, s, at.slip, NULL, NULL));
  }
  at.pressure = *bound;
  PetscCall(SamProblemComputeBound(problem, &at, &(SamBound){.value = *bound}));
  PetscCall(VecDestroy(&at.slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SumTangential(SamGrid grid, PetscReal self, const SamIncrement *increment, const double bound[],
                                    const double q[], SamCheck *check)
{
  SamTotal totals[4] = {{0}};
  double   sums[4], max[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t     k     = (ptrdiff_t)j * grid->nx;
    const double *const qs[2] = {q + k, q + k + grid->cells};
    const double *const ds[2] = {increment->row[0], increment->row[1]};
    TangentialSums      row;

    SamIncrementComputeRow(increment, j);
    SamIncrementOpposeRow(increment, j);
    row = TangentialRow(grid->nx, bound + k, qs, ds, 1 / self);
    SamAddAll(4, totals, row.sums);
    max[0] = SamLarger(max[0], row.over);
    max[1] = SamLarger(max[1], row.most);
  }
  PetscCall(SamSumTotals(grid->comm, 4, totals, sums));
  PetscCall(SamMax(grid->comm, 2, max));
  check->tangential = sums[0] == 0 ? 0 : sqrt(sums[0] / PetscMax(sums[3], PetscMax(sums[1], sums[2])));
  check->cone       = max[0] == 0 ? 0 : (max[1] > 0 ? max[0] / max[1] : INFINITY);
  if (isnan(check->tangential)) check->tangential = INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckTangential(SamProblem problem, SamState state, const SamSolution *before,
                                      const SamSolution *s, SamCheck *check)
{
  PetscReal     self;
  SamIncrement  increment;
  const double *q, *b;
  Vec           bound;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(SamProblemGetElasticity(problem), NULL, &self));
  PetscCall(CreateBound(problem, state, before, s, &bound));
  PetscCall(SamIncrementCreate(problem, before, s, &increment));
  PetscCall(VecGetArrayRead(s->shear, &q));
  PetscCall(VecGetArrayRead(bound, &b));
  PetscCall(SumTangential(SamProblemGetGrid(problem), self, &increment, b, q, check));
  PetscCall(VecRestoreArrayRead(bound, &b));
  PetscCall(VecRestoreArrayRead(s->shear, &q));
  PetscCall(SamIncrementDestroy(&increment));
  PetscCall(VecDestroy(&bound));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes relative errors of the given loads of one kind; see SamCheck for their scales. `borne`: what contact bears,
   which may be more than the traction, less the tension, that carries the loads. */
static PetscErrorCode CheckEquilibrium(SamGrid grid, const SamBalance *given, Vec traction, Vec borne, SamCheck *check)
{
  PetscReal loads[3], total;

  PetscFunctionBegin;
  PetscCall(SamBalanceGetLoads(grid, given->kind, traction, loads));
  PetscCall(SamGridNorm(grid, borne, NORM_1, &total));
  total *= grid->dx * grid->dy;
  for (PetscInt c = 0; c < 3; c++) {
    const PetscBool moment = given->kind == SAM_BALANCE_NORMAL ? c > 0 : c == 2;
    const PetscReal arm =
      moment ? grid->length + PetscMax(PetscAbsReal(grid->center[0]), PetscAbsReal(grid->center[1])) : 1;
    const PetscReal scale = PetscMax(total * arm, PetscAbsReal(given->load[c]));
    PetscReal       error;

    if (!given->force[c]) continue;
    error              = PetscAbsReal(loads[c] - given->load[c]);
    check->equilibrium = SamLarger(check->equilibrium, error == 0 ? 0 : error / scale);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckSolution(SamProblem problem, SamState state, PetscBool coupling, PetscBool u_z_known,
                                const SamSolution *before, SamSolution *solution, SamCheck *check)
{
  SamBalance given[2];
  PetscReal  most;
  SamGrid    grid;
  Vec        total;

  PetscFunctionBegin;
  SamValidHandle(problem, SamProblem, 1);
  if (state) SamValidHandle(state, SamState, 2);
  SamValidPointer(solution, 6);
  SamValidPointer(check, 7);
  if (state) SamValidSameComm(SamProblemGetGrid(problem)->comm, 1, SamStateComm(state), 2);
  grid = SamProblemGetGrid(problem);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscCall(PetscMemzero(check, sizeof(*check)));
  PetscCall(ComputeDisplacements(problem, state, coupling, u_z_known, solution, &most));
  PetscCall(CheckNormal(problem, state, solution, most, check));
  PetscCall(CheckTension(problem, state, solution, most, check));
  if (SamElasticityGetTraits(SamProblemGetElasticity(problem)).periodic) check->edge = 0;
  PetscCall(CheckTangential(problem, state, before, solution, check));
  for (int kind = 0; kind < 2; kind++) given[kind] = SamControlGetBalance(&solution->control, (SamBalanceKind)kind);
  PetscCall(SamSolutionCreateTotal(problem, solution, &total));
  PetscCall(CheckEquilibrium(grid, &given[0], total, solution->pressure, check));
  PetscCall(SamSolutionDestroyTotal(solution, &total));
  PetscCall(CheckEquilibrium(grid, &given[1], solution->shear, solution->shear, check));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

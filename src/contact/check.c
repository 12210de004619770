/* The check of a solution, which trusts no solver. */
#include <petsam/private/balanceimpl.h>
#include "contactimpl.h"
#include <math.h>
#include <string.h>

PetscErrorCode SamCheckDisplacements(SamElasticity C, PetscBool coupling, PetscBool same_pressure, PetscBool release,
                                     SamFields *f)
{
  SamGrid             grid;
  SamElasticityTraits traits;
  PetscReal           shear;
  Vec                 more;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  if (!same_pressure) PetscCall(SamElasticityApplyNormal(C, f->pressure, f->displacement_z));
  if (release) PetscCall(SamElasticityRelease(C, PETSC_TRUE));
  PetscCall(VecNorm(f->shear, NORM_INFINITY, &shear));
  if (shear != 0)
    PetscCall(SamElasticityApplyTangential(C, f->shear, f->displacement_t));
  else
    PetscCall(SamVecZero(f->displacement_t));
  if (release) PetscCall(SamElasticityRelease(C, PETSC_TRUE));
  PetscCall(SamElasticityGetTraits(C, &traits));
  if (traits.coupled && coupling) {
    PetscCall(SamElasticityGetGrid(C, &grid));
    PetscCall(SamGridCreateVec(grid, 1, &more));
    PetscCall(SamElasticityApplyTangentialToNormal(C, f->shear, more));
    PetscCall(VecAXPY(f->displacement_z, 1, more));
    PetscCall(VecDestroy(&more));
    PetscCall(SamGridCreateVec(grid, 2, &more));
    PetscCall(SamElasticityApplyNormalToTangential(C, f->pressure, more));
    PetscCall(VecAXPY(f->displacement_t, 1, more));
    PetscCall(VecDestroy(&more));
  }
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SAM_VECTORIZED static void GapRow(PetscInt n, const double *restrict uz, const double *restrict h, double xi0,
                                  double dxi, double eta, const double a[3], double *restrict gap)
{
  const double ax = a[0] - a[1] * eta, a2 = a[2];

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) gap[i] = uz[i] + h[i] - (ax + a2 * (xi0 + (double)i * dxi));
}

/* A row of u - a - b xi; returns the sum of sizes. */
SAM_VECTORIZED static double SlipRow(PetscInt n, const double *restrict u, double a, double b, double xi0, double dxi,
                                     double *restrict slip)
{
  double sum = 0;

#pragma omp simd reduction(+ : sum)
  for (PetscInt i = 0; i < n; i++) {
    slip[i] = u[i] - (a + b * (xi0 + (double)i * dxi));
    sum += fabs(slip[i]);
  }
  return sum;
}

/* Takes a row's slip; a row of zeros stays unwritten, and takes no memory. */
static void TakeSlip(PetscInt n, const double row[], double size, double slip[])
{
  if (size != 0)
    (void)memcpy(slip, row, sizeof(*slip) * (size_t)n);
  else
    SamZero(n, slip);
}

/* gap = u_z + h - rigid, slip = u_t - rigid. */
static PetscErrorCode ComputeGapAndSlip(SamGrid grid, Vec separation, const SamStep *step, SamFields *f)
{
  SamFrame      normal, tangential;
  const double *uz, *ut, *h;
  double       *gap, *slip, *row;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(grid->nx, &row));
  PetscCall(SamFrameSetGiven(&normal, grid, &step->normal)); /* all displacements are known now */
  PetscCall(SamFrameSetGiven(&tangential, grid, &step->tangential));
  PetscCall(VecGetArrayRead(f->displacement_z, &uz));
  PetscCall(VecGetArrayRead(f->displacement_t, &ut));
  PetscCall(VecGetArrayRead(separation, &h));
  PetscCall(VecGetArrayWrite(f->gap, &gap));
  PetscCall(VecGetArray(f->slip, &slip));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * grid->nx, l = k + grid->cells;
    const double    eta = SamFrameEta(&normal, j), xi0 = normal.xi0, dxi = normal.dxi;

    GapRow(grid->nx, uz + k, h + k, xi0, dxi, eta, normal.fixed, gap + k);
    TakeSlip(grid->nx, row, SlipRow(grid->nx, ut + k, SamFrameX(tangential.fixed, eta), 0, xi0, dxi, row), slip + k);
    TakeSlip(grid->nx, row, SlipRow(grid->nx, ut + l, tangential.fixed[1], tangential.fixed[2], xi0, dxi, row),
             slip + l);
  }
  PetscCall(VecRestoreArray(f->slip, &slip));
  PetscCall(VecRestoreArrayWrite(f->gap, &gap));
  PetscCall(VecRestoreArrayRead(separation, &h));
  PetscCall(VecRestoreArrayRead(f->displacement_t, &ut));
  PetscCall(VecRestoreArrayRead(f->displacement_z, &uz));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { GAP, TENSION, DISPLACEMENT, PRESSURE, OPENING, EDGE, COUNT };

/* Largest of each kind in a row, but for the edge; a value that is not a number makes the gap infinite. */
SAM_VECTORIZED static void NormalRow(PetscInt n, const double *restrict p, const double *restrict g,
                                     const double *restrict u, double max[COUNT])
{
  double gap = 0, tension = 0, displacement = 0, pressure = 0, opening = 0, nan = 0;

#pragma omp simd reduction(max : gap, tension, displacement, pressure, opening) reduction(+ : nan)
  for (PetscInt i = 0; i < n; i++) {
    const double size = fabs(u[i]), wrong = p[i] > 0 ? fabs(g[i]) : -g[i];

    gap          = wrong > gap ? wrong : gap;
    opening      = g[i] > opening ? g[i] : opening;
    tension      = -p[i] > tension ? -p[i] : tension;
    pressure     = p[i] > pressure ? p[i] : pressure;
    displacement = size > displacement ? size : displacement;
    nan += p[i] + g[i] == p[i] + g[i] ? 0 : 1;
  }
  max[GAP]          = nan > 0 ? INFINITY : SamLarger(max[GAP], gap);
  max[OPENING]      = PetscMax(max[OPENING], opening);
  max[TENSION]      = PetscMax(max[TENSION], tension);
  max[PRESSURE]     = PetscMax(max[PRESSURE], pressure);
  max[DISPLACEMENT] = PetscMax(max[DISPLACEMENT], displacement);
}

static PetscErrorCode CheckNormal(SamGrid grid, const SamFields *f, SamCheck *check)
{
  double        max[COUNT] = {0};
  const double *p, *g, *u;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(f->pressure, &p));
  PetscCall(VecGetArrayRead(f->gap, &g));
  PetscCall(VecGetArrayRead(f->displacement_z, &u));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscBool edge_row =
      (grid->row_start + j == 0 || grid->row_start + j == grid->ny - 1) ? PETSC_TRUE : PETSC_FALSE;
    const ptrdiff_t k = (ptrdiff_t)j * grid->nx;

    NormalRow(grid->nx, p + k, g + k, u + k, max);
    for (PetscInt i = 0; i < grid->nx; i += edge_row ? 1 : PetscMax(grid->nx - 1, 1))
      max[EDGE] = PetscMax(max[EDGE], p[k + i]);
  }
  PetscCall(VecRestoreArrayRead(f->displacement_z, &u));
  PetscCall(VecRestoreArrayRead(f->gap, &g));
  PetscCall(VecRestoreArrayRead(f->pressure, &p));
  PetscCall(SamMax(grid->comm, COUNT, max));
  check->edge   = max[PRESSURE] > 0 ? max[EDGE] / max[PRESSURE] : 0;
  check->normal = max[TENSION] > 0 ? max[TENSION] / PetscMax(max[PRESSURE], max[TENSION]) : 0;
  /* without contact there is no displacement: then the openings are the measure */
  if (max[GAP] > 0) {
    const double scale = max[DISPLACEMENT] > 0 ? max[DISPLACEMENT] : max[OPENING];

    check->normal = PetscMax(check->normal, scale > 0 ? max[GAP] / scale : INFINITY);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row's squares (residual, q, D(q - ds/c), bound) and largest |q| - mu p and mu p. */
SAM_VECTORIZED static void TangentialRow(PetscInt n, const double *restrict p, const double *restrict qx,
                                         const double *restrict qy, const double *restrict sx,
                                         const double *restrict sy, double friction, double inverse, SamTotal totals[4],
                                         double max[2])
{
  double residual = 0, shear = 0, projected = 0, least = 0, over = max[0], most = max[1], sums[4];

#pragma omp simd reduction(+ : residual, shear, projected, least) reduction(max : over, most)
  for (PetscInt i = 0; i < n; i++) {
    const double b = friction * (p[i] > 0 ? p[i] : 0), yx = qx[i] - inverse * sx[i], yy = qy[i] - inverse * sy[i],
                 y2    = yx * yx + yy * yy;
    const double scale = y2 > b * b ? b / sqrt(y2) : 1, rx = qx[i] - scale * yx, ry = qy[i] - scale * yy,
                 q2 = qx[i] * qx[i] + qy[i] * qy[i], beyond = sqrt(q2) - b;

    residual += rx * rx + ry * ry;
    shear += q2;
    projected += scale * scale * y2;
    least += SAM_SHEAR_FLOOR * SAM_SHEAR_FLOOR * b * b;
    over = beyond > over ? beyond : over;
    most = b > most ? b : most;
  }
  sums[0] = residual;
  sums[1] = shear;
  sums[2] = projected;
  sums[3] = least;
  SamAddAll(4, totals, sums);
  max[0] = over;
  max[1] = most;
}

static PetscErrorCode CheckTangential(SamGrid grid, PetscReal friction, PetscReal self, const SamFields *f,
                                      Vec slip_before, SamCheck *check)
{
  SamTotal      totals[4] = {{0, 0}};
  double        sums[4], max[2] = {0, 0}, *ds;
  const double *p, *q, *s, *before = NULL;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(f->pressure, &p));
  PetscCall(VecGetArrayRead(f->shear, &q));
  PetscCall(VecGetArrayRead(f->slip, &s));
  if (slip_before) PetscCall(VecGetArrayRead(slip_before, &before));
  PetscCall(PetscMalloc1(2 * grid->nx, &ds));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * grid->nx, l = k + grid->cells;

    for (PetscInt i = 0; i < grid->nx; i++) {
      ds[i]            = s[k + i] - (before ? before[k + i] : 0);
      ds[i + grid->nx] = s[l + i] - (before ? before[l + i] : 0);
    }
    TangentialRow(grid->nx, p + k, q + k, q + l, ds, ds + grid->nx, friction, 1 / self, totals, max);
  }
  PetscCall(PetscFree(ds));
  if (slip_before) PetscCall(VecRestoreArrayRead(slip_before, &before));
  PetscCall(VecRestoreArrayRead(f->slip, &s));
  PetscCall(VecRestoreArrayRead(f->shear, &q));
  PetscCall(VecRestoreArrayRead(f->pressure, &p));
  PetscCall(SamSumTotals(grid->comm, 4, totals, sums));
  PetscCall(SamMax(grid->comm, 2, max));
  check->tangential = sums[0] == 0 ? 0 : sqrt(sums[0] / PetscMax(sums[3], PetscMax(sums[1], sums[2])));
  check->cone       = max[0] == 0 ? 0 : (max[1] > 0 ? max[0] / max[1] : INFINITY);
  if (isnan(check->tangential)) check->tangential = INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Errors of the force-controlled loads of one kind. */
static PetscErrorCode CheckEquilibrium(SamGrid grid, const SamBalance *given, Vec traction, SamCheck *check)
{
  PetscReal loads[3], total;

  PetscFunctionBegin;
  PetscCall(SamBalanceGetLoads(grid, given->kind, traction, loads));
  PetscCall(SamGridNorm(grid, traction, NORM_1, &total));
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

PetscErrorCode SamCheckFields(SamElasticity C, PetscReal friction, Vec separation, Vec slip_before,
                              const SamBalance *given_normal, const SamBalance *given_tangential, const SamStep *step,
                              SamFields *fields, SamCheck *check)
{
  SamGrid   grid;
  PetscReal self;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscCall(PetscMemzero(check, sizeof(*check)));
  PetscCall(SamElasticityGetGrid(C, &grid));
  PetscCall(SamElasticityGetSelfInfluence(C, NULL, &self));
  PetscCall(ComputeGapAndSlip(grid, separation, step, fields));
  PetscCall(CheckNormal(grid, fields, check));
  PetscCall(CheckTangential(grid, friction, self, fields, slip_before, check));
  PetscCall(CheckEquilibrium(grid, given_normal, fields->pressure, check));
  PetscCall(CheckEquilibrium(grid, given_tangential, fields->shear, check));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactCheck(SamElasticity C, PetscBool coupling, PetscBool same_pressure, PetscReal friction,
                               Vec separation, Vec slip_before, const SamBalance *given_normal,
                               const SamBalance *given_tangential, const SamStep *step, SamFields *fields,
                               SamCheck *check)
{
  PetscFunctionBegin;
  PetscCall(SamCheckDisplacements(C, coupling, same_pressure, PETSC_FALSE, fields));
  PetscCall(SamCheckFields(C, friction, separation, slip_before, given_normal, given_tangential, step, fields, check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

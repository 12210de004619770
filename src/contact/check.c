/* The check of a solution, which trusts no solver. */
#include "../balance/balanceimpl.h"
#include <petsam/contact.h>
#include <math.h>

/* Elastic displacements from the tractions. */
static PetscErrorCode ComputeDisplacements(SamCompliance C, PetscBool coupling, PetscBool same_pressure, SamFields *f)
{
  PetscReal shear;
  PetscBool coupled;

  PetscFunctionBegin;
  if (!same_pressure) PetscCall(SamComplianceApplyNormal(C, f->pressure, f->displacement_z));
  PetscCall(VecNorm(f->shear, NORM_INFINITY, &shear));
  if (shear != 0) PetscCall(SamComplianceApplyTangential(C, f->shear, f->displacement_t));
  else PetscCall(VecSet(f->displacement_t, 0));
  PetscCall(SamComplianceIsCoupled(C, &coupled));
  if (!coupled || !coupling) PetscFunctionReturn(PETSC_SUCCESS);
  /* gap and slip are not yet in use: room for the two other products */
  PetscCall(SamComplianceApplyTangentialToNormal(C, f->shear, f->gap));
  PetscCall(VecAXPY(f->displacement_z, 1, f->gap));
  PetscCall(SamComplianceApplyNormalToTangential(C, f->pressure, f->slip));
  PetscCall(VecAXPY(f->displacement_t, 1, f->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* gap = u_z + h - rigid, slip = u_t - rigid. */
static PetscErrorCode ComputeGapAndSlip(SamGrid grid, Vec separation, const SamStep *step, SamFields *f)
{
  SamBalance    given[2] = {step->normal, step->tangential};
  SamFrame      normal, tangential;
  const double *uz, *ut, *h;
  double       *gap, *slip;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) given[0].force[c] = given[1].force[c] = PETSC_FALSE; /* all displacements are known now */
  PetscCall(SamFrameSet(&normal, grid, &given[0]));
  PetscCall(SamFrameSet(&tangential, grid, &given[1]));
  PetscCall(VecGetArrayRead(f->displacement_z, &uz));
  PetscCall(VecGetArrayRead(f->displacement_t, &ut));
  PetscCall(VecGetArrayRead(separation, &h));
  PetscCall(VecGetArrayWrite(f->gap, &gap));
  PetscCall(VecGetArrayWrite(f->slip, &slip));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const double eta = normal.eta0 + (double)j * normal.deta;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i, l = k + grid->cells;
      const double   xi = normal.xi0 + (double)i * normal.dxi;

      gap[k]  = uz[k] + h[k] - SamFrameNormal(normal.fixed, xi, eta);
      slip[k] = ut[k] - SamFrameX(tangential.fixed, eta);
      slip[l] = ut[l] - SamFrameY(tangential.fixed, xi);
    }
  }
  PetscCall(VecRestoreArrayWrite(f->slip, &slip));
  PetscCall(VecRestoreArrayWrite(f->gap, &gap));
  PetscCall(VecRestoreArrayRead(separation, &h));
  PetscCall(VecRestoreArrayRead(f->displacement_t, &ut));
  PetscCall(VecRestoreArrayRead(f->displacement_z, &uz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckNormal(SamGrid grid, const SamFields *f, SamCheck *check)
{
  enum { GAP, TENSION, DISPLACEMENT, PRESSURE, EDGE, OPENING, COUNT };
  double        max[COUNT] = {0};
  const double *p, *g, *u;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(f->pressure, &p));
  PetscCall(VecGetArrayRead(f->gap, &g));
  PetscCall(VecGetArrayRead(f->displacement_z, &u));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscBool edge_row = (grid->row_start + j == 0 || grid->row_start + j == grid->ny - 1) ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i;

      max[GAP]          = SamLarger(max[GAP], p[k] > 0 ? fabs(g[k]) : -g[k]);
      max[OPENING]      = PetscMax(max[OPENING], g[k]);
      max[TENSION]      = PetscMax(max[TENSION], -p[k]);
      max[DISPLACEMENT] = PetscMax(max[DISPLACEMENT], fabs(u[k]));
      max[PRESSURE]     = PetscMax(max[PRESSURE], p[k]);
      if (edge_row || i == 0 || i == grid->nx - 1) max[EDGE] = PetscMax(max[EDGE], p[k]);
    }
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

static PetscErrorCode CheckTangential(SamGrid grid, PetscReal friction, PetscReal self, const SamFields *f, Vec slip_before, SamCheck *check)
{
  double        sums[4] = {0, 0, 0, 0}, max[2] = {0, 0};
  const double *p, *q, *s, *before = NULL;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(f->pressure, &p));
  PetscCall(VecGetArrayRead(f->shear, &q));
  PetscCall(VecGetArrayRead(f->slip, &s));
  if (slip_before) PetscCall(VecGetArrayRead(slip_before, &before));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt l = k + grid->cells;
    const double   b = friction * PetscMax(p[k], 0);
    const double   dx = s[k] - (before ? before[k] : 0), dy = s[l] - (before ? before[l] : 0);
    const double   yx = q[k] - dx / self, yy = q[l] - dy / self, y = sqrt(yx * yx + yy * yy);
    const double   scale = y > b ? b / y : 1, rx = q[k] - scale * yx, ry = q[l] - scale * yy;

    sums[0] += rx * rx + ry * ry;
    sums[1] += q[k] * q[k] + q[l] * q[l];
    sums[2] += scale * scale * y * y;
    sums[3] += SAM_SHEAR_FLOOR * SAM_SHEAR_FLOOR * b * b;
    max[0] = SamLarger(max[0], sqrt(q[k] * q[k] + q[l] * q[l]) - b);
    max[1] = PetscMax(max[1], b);
  }
  if (slip_before) PetscCall(VecRestoreArrayRead(slip_before, &before));
  PetscCall(VecRestoreArrayRead(f->slip, &s));
  PetscCall(VecRestoreArrayRead(f->shear, &q));
  PetscCall(VecRestoreArrayRead(f->pressure, &p));
  PetscCall(SamSum(grid->comm, 4, sums));
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
  PetscCall(VecNorm(traction, NORM_1, &total));
  total *= grid->dx * grid->dy;
  for (PetscInt c = 0; c < 3; c++) {
    const PetscBool moment = given->kind == SAM_BALANCE_NORMAL ? c > 0 : c == 2;
    const PetscReal arm    = moment ? grid->length + PetscMax(PetscAbsReal(grid->center[0]), PetscAbsReal(grid->center[1])) : 1;
    const PetscReal scale  = PetscMax(total * arm, PetscAbsReal(given->load[c]));
    PetscReal       error;

    if (!given->force[c]) continue;
    error              = PetscAbsReal(loads[c] - given->load[c]);
    check->equilibrium = SamLarger(check->equilibrium, error == 0 ? 0 : error / scale);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactCheck(SamCompliance C, PetscBool coupling, PetscBool same_pressure, PetscReal friction, Vec separation, Vec slip_before, const SamBalance *given_normal, const SamBalance *given_tangential, const SamStep *step, SamFields *fields, SamCheck *check)
{
  SamGrid   grid;
  PetscReal self;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscCall(PetscMemzero(check, sizeof(*check)));
  PetscCall(SamComplianceGetGrid(C, &grid));
  PetscCall(SamComplianceGetSelfInfluence(C, NULL, &self));
  PetscCall(ComputeDisplacements(C, coupling, same_pressure, fields));
  PetscCall(ComputeGapAndSlip(grid, separation, step, fields));
  PetscCall(CheckNormal(grid, fields, check));
  PetscCall(CheckTangential(grid, friction, self, fields, slip_before, check));
  PetscCall(CheckEquilibrium(grid, given_normal, fields->pressure, check));
  PetscCall(CheckEquilibrium(grid, given_tangential, fields->shear, check));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_CHECK], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

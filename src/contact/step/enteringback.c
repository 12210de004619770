/*
  Steps in which contact grows, on the way back.

  In cells that come into contact the slip of the step begins when they touch (contact/step/direction.c, Beginning):
  until then they have moved by
      m = -kappa tau' g0,   tau' = tau min(1, mu/|tau|),   tau = (U ratio - 2 e r/kappa)/(U + 2 max(0, tilt)),
  g0 being the gap before the step. The slip of the step is v_k - v_(k-1) - m, so that the cotangent of m is the one
  that the step leaves for v_(k-1). From it follow those of g0, which the pressure and the approach before the step
  have made, of the loads and the displacements before and after the step, of the strain by bulk stress, of kappa and of
  mu. In a step from no contact g0 is the distance of the undeformed bodies, measured from where it is least.

  Tangential loads that are found depend on the shear, whose adjoint depends on their cotangents: the caller finds
  both (adjoint.c).
*/
#include <petsam/private/entering.h>
#include <math.h>

#define LEVEL 1e-9 /* tilt of a cell below this part of the approach is rounding */

/* ---- the motion of a cell ---- */

/* Sums over the cells: cotangents of the numbers of the approach, and of a gap that is moved as a rigid body */
enum { CENTER, TILT = 2, RATIO = 4, KAPPA = 6, STRAIN = 8, UNIFORM = 11, MOVED, SUMS = 15 };

/* A cell that comes into contact */
typedef struct {
  double x, y, gap, friction, motion[2]; /* cotangent of m */
} Cell;

/* Adds the part of a cell to the sums; returns the cotangents of its gap and of its coefficient of friction. */
static void AddCell(const SamApproach *a, const Cell *c, double sums[SUMS], double *by_gap, double *by_friction)
{
  const double at[2] = {c->x - a->center[0], c->y - a->center[1]};
  const double tilt = a->tilt[0] * at[0] + a->tilt[1] * at[1], all = a->uniform + 2 * PetscMax(0, tilt);
  /* 2 max(0, tilt) has a kink without tilt, as in all symmetric problems: the mean of both sides */
  const double    least = LEVEL * a->uniform, by_tilt = tilt > least ? 2 : tilt < -least ? 0 : 1;
  const SamStrain e        = a->strain;
  const double    moved[2] = {e.xx * at[0] + e.xy * at[1], e.xy * at[0] + e.yy * at[1]};
  double          tau[2], size, part, by[2], along, by_moved[2], by_all = 0;

  SamApproachShear(a, c->x, c->y, tau);
  size         = hypot(tau[0], tau[1]);
  part         = size > c->friction ? c->friction / size : 1;
  *by_gap      = 0;
  *by_friction = 0;
  if (size == 0 && a->uniform <= 0) return;
  for (int k = 0; k < 2; k++) {
    *by_gap -= c->motion[k] * a->kappa[k] * tau[k] * part;
    sums[KAPPA + k] -= c->motion[k] * tau[k] * part * c->gap;
    by[k] = -c->motion[k] * a->kappa[k] * c->gap;
  }
  along = size > 0 ? (by[0] * tau[0] + by[1] * tau[1]) / size : 0;
  if (part < 1) *by_friction = along;
  for (int k = 0; k < 2 && part < 1; k++) by[k] = part * (by[k] - along * tau[k] / size);
  for (int k = 0; k < 2; k++) {
    sums[RATIO + k] += by[k] * a->uniform / all;
    sums[UNIFORM] += by[k] * (a->ratio[k] - tau[k]) / all;
    sums[KAPPA + k] += by[k] * 2 * moved[k] / (a->kappa[k] * a->kappa[k] * all);
    by_moved[k] = -2 * by[k] / (a->kappa[k] * all);
    by_all -= by_tilt * by[k] * tau[k] / all;
  }
  sums[STRAIN] += by_moved[0] * at[0];
  sums[STRAIN + 1] += by_moved[1] * at[1];
  sums[STRAIN + 2] += by_moved[0] * at[1] + by_moved[1] * at[0];
  for (int k = 0; k < 2; k++) sums[TILT + k] += by_all * at[k];
  sums[CENTER] -= by_all * a->tilt[0] + by_moved[0] * e.xx + by_moved[1] * e.xy;
  sums[CENTER + 1] -= by_all * a->tilt[1] + by_moved[0] * e.xy + by_moved[1] * e.yy;
}

/* ---- the sums ---- */

/* Sums the cotangents over the entering cells; sets those of their gaps and frictions. */
static PetscErrorCode SumCells(const SamEntering *in, SamEntered *e, double sums[SUMS])
{
  const SamGrid  g            = in->grid;
  const PetscInt n            = g->cells;
  SamTotal       totals[SUMS] = {{0}};

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(e->by_gap, n));
  PetscCall(PetscArrayzero(e->by_friction, n));
  for (PetscInt j = 0; j < g->rows; j++) {
    double row[SUMS] = {0};

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) {
      const Cell cell = {(double)SamGridX(g, k - j * g->nx),
                         (double)SamGridY(g, g->row_start + j),
                         in->gaps[k],
                         in->friction[k],
                         {in->motion[k], in->motion[k + n]}};

      if (!(in->gaps[k] > 0)) continue;
      AddCell(in->approach, &cell, row, &e->by_gap[k], &e->by_friction[k]);
      row[MOVED] += e->by_gap[k];
      row[MOVED + 1] += cell.x * e->by_gap[k];
      row[MOVED + 2] += cell.y * e->by_gap[k];
    }
    SamAddAll(SUMS, totals, row);
  }
  PetscCall(SamSumTotals(g->comm, SUMS, totals, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- loads and displacements ---- */

enum { BEFORE = SAM_ENTERED_BEFORE, NOW = SAM_ENTERED_NOW };

/* Finds the cotangents of the loads from those of the ratios, the centre and the approach in plane strain. */
static void FindLoads(const SamEntering *in, const double sums[SUMS], SamEntered *e)
{
  const SamApproach *a      = in->approach;
  const double       normal = (double)in->normal[BEFORE], growth = (double)in->normal[NOW] - normal;
  const PetscInt     along[] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY}, turn[] = {SAM_COMPONENT_MY, SAM_COMPONENT_MX};
  double             by_growth = 0;

  for (int k = 0; k < 2; k++) {
    e->load[NOW][along[k]]    = sums[RATIO + k] / growth;
    e->load[BEFORE][along[k]] = -sums[RATIO + k] / growth;
    by_growth -= sums[RATIO + k] * a->ratio[k] / growth;
    if (in->fresh) continue;
    e->load[BEFORE][turn[k]] = (k ? -1 : 1) * sums[CENTER + k] / normal;
    e->load[BEFORE][SAM_COMPONENT_N] -= sums[CENTER + k] * a->center[k] / normal;
  }
  if (in->plane && !in->fresh) by_growth += in->constant * sums[UNIFORM];
  e->load[NOW][SAM_COMPONENT_N] += by_growth;
  e->load[BEFORE][SAM_COMPONENT_N] -= by_growth;
}

/* Finds the cotangents of the displacements, which have made the approach, the tilt and the gap. */
static void FindRigid(const SamEntering *in, const double sums[SUMS], SamEntered *e)
{
  const double   tilt[2] = {sums[TILT], sums[TILT + 1]};
  const PetscInt of =
    in->fresh ? NOW : BEFORE; /* the gap is that of the displacements before the step, or of the bodies */

  e->rigid[NOW][SAM_COMPONENT_N]  = e->uniform;
  e->rigid[NOW][SAM_COMPONENT_MY] = tilt[0];
  e->rigid[NOW][SAM_COMPONENT_MX] = -tilt[1];
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) e->rigid[BEFORE][c] = -e->rigid[NOW][c];
  if (!in->fresh) e->rigid[of][SAM_COMPONENT_N] -= sums[MOVED];
  e->rigid[of][SAM_COMPONENT_MY] -= sums[MOVED + 1];
  e->rigid[of][SAM_COMPONENT_MX] += sums[MOVED + 2];
}

/* Takes the gap where the bodies touch first, in a step from no contact, off all others: the mean of the cells where
   they do. */
static PetscErrorCode AddLeast(const SamEntering *in, const double sums[SUMS], SamEntered *e)
{
  const SamGrid g      = in->grid;
  double        all[3] = {0}; /* number of these cells, and sums of x and y */

  PetscFunctionBegin;
  for (PetscInt k = 0; k < g->cells; k++) {
    if (in->gaps[k] >= 0) continue;
    all[0] += 1;
    all[1] += (double)SamGridX(g, k % g->nx);
    all[2] += (double)SamGridY(g, g->row_start + k / g->nx);
  }
  PetscCall(SamSum(g->comm, 3, all));
  for (PetscInt k = 0; k < g->cells; k++)
    if (in->gaps[k] < 0) e->by_gap[k] -= sums[MOVED] / all[0];
  e->rigid[NOW][SAM_COMPONENT_MY] += sums[MOVED] * all[1] / all[0];
  e->rigid[NOW][SAM_COMPONENT_MX] -= sums[MOVED] * all[2] / all[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEnteringGoBack(const SamEntering *in, SamEntered *e)
{
  const SamApproach *a = in->approach;
  double             sums[SUMS];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(e->load, sizeof(e->load)));
  PetscCall(PetscMemzero(e->rigid, sizeof(e->rigid)));
  PetscCall(SumCells(in, e, sums));
  e->uniform = 0;
  if (!in->plane && !in->fresh) { /* the approach about the centre is that of the origin and of the tilt */
    e->uniform = sums[UNIFORM];
    for (int k = 0; k < 2; k++) {
      sums[TILT + k] += sums[UNIFORM] * a->center[k];
      sums[CENTER + k] += sums[UNIFORM] * a->tilt[k];
    }
  }
  FindLoads(in, sums, e);
  FindRigid(in, sums, e);
  if (in->fresh) PetscCall(AddLeast(in, sums, e));
  e->by_modulus = in->plane && !in->fresh ? sums[UNIFORM] * a->uniform : 0;
  for (int k = 0; k < 2; k++) e->kappa[k] = sums[KAPPA + k];
  for (int k = 0; k < 3; k++) e->strain[k] = sums[STRAIN + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

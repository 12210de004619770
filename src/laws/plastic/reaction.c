/*
  The class SamReaction. With x, the change of the tractions on frozen sets of cells, and the vector f, the ratio of the
  shear of a slipping cell to its pressure, it solves
      A x + u - rigid = 0    on cells in contact along z, on cells that stick along x and y,
      x_t = f x_z            on cells that slip,
  where the loads of x are 0 in the given components. A, the influence of the tractions, is symmetric and positive
  definite. First x is solved on the cells in contact and in stick alone, by conjugate gradients. Then the shear of
  slipping cells follows the pressure, and x is solved once more on the cells that stick. So for dissimilar bodies the
  effect of slipping cells on the pressure is omitted.

  The exact response of frozen sets (solvers/frozen) includes that effect, and is not symmetric. Here a symmetric one is
  needed, since it is part of the operator of the conjugate gradients of plasticnewton.c. An approximate one will do: it
  precedes the residual of Newton's method, which is exact, and sets its rate of convergence only.
*/
#include "reaction.h"
#include <petsam/private/balanceimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/pressed.h>
#include <petsam/solution.h>

#define RTOL 1e-3 /* relative to the displacement */
#define MOST 200  /* iterations */
/* Rounding error relative to a displacement: the remainder of a rigid motion, for example by a uniform strain */
#define ROUNDING 1e-13

struct _n_SamReaction {
  SamElasticity        elasticity;
  const SamLawContact *contact;
  SamGrid              grid;
  SamFrame             frame[2]; /* normal and tangential */
  double               gram[2][SAM_GRAM];
  PetscBool            coupled, sticks, slips; /* true if any cell on any rank does */
  char                *free[2];                /* cells in contact, cells that stick */
  double              *part;                   /* (2, cells): f */
  double              *x, *r, *p, *Ap;         /* (DIRECTIONS, cells) */
  Vec                  normal, tangential, other[2];
};

PetscErrorCode SamReactionCreate(SamElasticity e, const SamLawContact *contact, SamReaction *reaction)
{
  const PetscInt cells = SamElasticityGetGrid(e)->cells;
  SamReaction    r;

  PetscFunctionBegin;
  PetscCall(PetscNew(&r));
  r->elasticity = e;
  r->contact    = contact;
  r->grid       = SamElasticityGetGrid(e);
  r->coupled    = SamElasticityGetTraits(e).coupled;
  PetscCall(SamFrameSet(&r->frame[0], r->grid, contact->normal));
  PetscCall(SamFrameSet(&r->frame[1], r->grid, contact->tangential));
  PetscCall(PetscCalloc2(cells, &r->free[0], cells, &r->free[1]));
  PetscCall(PetscCalloc5(2 * cells, &r->part, DIRECTIONS * cells, &r->x, DIRECTIONS * cells, &r->r, DIRECTIONS * cells,
                         &r->p, DIRECTIONS * cells, &r->Ap));
  PetscCall(SamGridCreateVec(r->grid, 1, &r->normal));
  PetscCall(SamGridCreateVec(r->grid, 1, &r->other[0]));
  PetscCall(SamGridCreateVec(r->grid, 2, &r->tangential));
  PetscCall(SamGridCreateVec(r->grid, 2, &r->other[1]));
  *reaction = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReactionDestroy(SamReaction *reaction)
{
  SamReaction r = *reaction;

  PetscFunctionBegin;
  *reaction = NULL;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(r->free[0], r->free[1]));
  PetscCall(PetscFree5(r->part, r->x, r->r, r->p, r->Ap));
  PetscCall(VecDestroy(&r->normal));
  PetscCall(VecDestroy(&r->tangential));
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&r->other[k]));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the sets of cells ---- */

static double XiAt(const SamReaction r, PetscInt i)
{
  return r->frame[0].xi0 + (double)i * r->frame[0].dxi;
}

/* Computes the Gram matrices of the sets of cells. */
static PetscErrorCode SumGrams(SamReaction r)
{
  SamTotal totals[2 * SAM_GRAM] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < r->grid->rows; j++) {
    const double eta               = SamFrameEta(&r->frame[0], j);
    double       row[2 * SAM_GRAM] = {0};

    for (PetscInt i = 0; i < r->grid->nx; i++) {
      const PetscInt k  = j * r->grid->nx + i;
      const double   xi = XiAt(r, i);

      if (r->free[0][k]) SamGramNormalRow(row, 1, xi, xi * xi, eta);
      if (r->free[1][k]) SamGramAddTangential(row + SAM_GRAM, 1, 0, 1, xi, eta);
    }
    SamAddAll(2 * SAM_GRAM, totals, row);
  }
  PetscCall(SamSumTotals(r->grid->comm, 2 * SAM_GRAM, totals, r->gram[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReactionFreeze(SamReaction r)
{
  const PetscInt cells = r->grid->cells;
  const double  *p, *q, *bound;
  double         any[2] = {0};

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(r->contact->pressure, &p));
  PetscCall(VecGetArrayRead(r->contact->shear, &q));
  PetscCall(VecGetArrayRead(r->contact->bound, &bound));
  for (PetscInt k = 0; k < cells; k++) {
    const SamCellState state = SamCellStateOf(p[k], q[k], q[k + cells], bound[k]);
    const PetscBool    slips = state == SAM_CELL_SLIP && bound[k] > 0;

    r->free[0][k] = SamIsPressed(p[k]);
    r->free[1][k] = state == SAM_CELL_STICK && bound[k] > 0;
    for (PetscInt c = 0; c < 2; c++) r->part[k + c * cells] = slips ? q[k + c * cells] / p[k] : 0;
    if (slips) any[0] = 1;
    if (r->free[1][k]) any[1] = 1;
  }
  PetscCall(VecRestoreArrayRead(r->contact->bound, &bound));
  PetscCall(VecRestoreArrayRead(r->contact->shear, &q));
  PetscCall(VecRestoreArrayRead(r->contact->pressure, &p));
  PetscCall(SamMax(r->grid->comm, 2, any));
  r->slips  = any[0] > 0;
  r->sticks = any[1] > 0;
  PetscCall(SumGrams(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamReactionSlips(SamReaction r)
{
  return r->slips;
}

/* ---- fields ---- */

static PetscErrorCode Dot(const SamReaction r, const double a[], const double b[], double *dot)
{
  SamTotal total = {0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < r->grid->rows; j++) {
    double row = 0;

    for (PetscInt c = 0; c < DIRECTIONS; c++)
      for (PetscInt i = 0; i < r->grid->nx; i++) {
        const ptrdiff_t k = (ptrdiff_t)c * r->grid->cells + j * (ptrdiff_t)r->grid->nx + i;

        row += a[k] * b[k];
      }
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(r->grid->comm, 1, &total, dot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds `times` the rigid motions whose loads on the sets are those of a field. */
static PetscErrorCode AddRigid(const SamReaction r, const double of[], double times, double to[])
{
  const PetscInt cells     = r->grid->cells;
  SamTotal       totals[6] = {{0}};
  double         sums[6], a[2][3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < r->grid->rows; j++) {
    const double eta    = SamFrameEta(&r->frame[0], j);
    double       row[6] = {0};

    for (PetscInt i = 0; i < r->grid->nx; i++) {
      const PetscInt k  = j * r->grid->nx + i;
      const double   xi = XiAt(r, i), z = of[k], x = of[k + cells], y = of[k + 2 * cells];

      row[0] += z;
      row[1] -= eta * z;
      row[2] += xi * z;
      row[3] += x;
      row[4] += y;
      row[5] += xi * y - eta * x;
    }
    SamAddAll(6, totals, row);
  }
  PetscCall(SamSumTotals(r->grid->comm, 6, totals, sums));
  for (int kind = 0; kind < 2; kind++) SamFrameSolve(&r->frame[kind], r->gram[kind], sums + 3 * kind, a[kind]);
  for (PetscInt j = 0; j < r->grid->rows; j++) {
    const double eta = SamFrameEta(&r->frame[0], j);

    for (PetscInt i = 0; i < r->grid->nx; i++) {
      const PetscInt k  = j * r->grid->nx + i;
      const double   xi = XiAt(r, i);

      if (r->free[0][k]) to[k] += times * SamFrameNormal(a[0], xi, eta);
      if (!r->free[1][k]) continue;
      to[k + cells] += times * SamFrameX(a[1], eta);
      to[k + 2 * cells] += times * SamFrameY(a[1], xi);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets a displacement to zero on cells that are not free, and subtracts the rigid motions that are unknowns. */
static PetscErrorCode Project(const SamReaction r, double u[])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < DIRECTIONS * r->grid->cells; k++)
    if (!r->free[k >= r->grid->cells][k % r->grid->cells]) u[k] = 0;
  PetscCall(AddRigid(r, u, -1, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes u = A x. */
static PetscErrorCode Displace(SamReaction r, const double x[], double u[])
{
  const PetscInt cells = r->grid->cells;
  double        *to[2];

  PetscFunctionBegin;
  PetscCall(VecGetArray(r->normal, &to[0]));
  PetscCall(PetscArraycpy(to[0], x, cells));
  PetscCall(VecRestoreArray(r->normal, &to[0]));
  PetscCall(VecGetArray(r->tangential, &to[1]));
  PetscCall(PetscArraycpy(to[1], x + cells, 2 * cells));
  PetscCall(VecRestoreArray(r->tangential, &to[1]));
  PetscCall(SamElasticityApplyNormal(r->elasticity, r->normal, r->other[0]));
  PetscCall(VecGetArray(r->other[0], &to[0]));
  PetscCall(PetscArraycpy(u, to[0], cells));
  PetscCall(VecRestoreArray(r->other[0], &to[0]));
  PetscCall(PetscArrayzero(u + cells, 2 * cells));
  if (!r->sticks) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityApplyTangential(r->elasticity, r->tangential, r->other[1]));
  PetscCall(VecGetArray(r->other[1], &to[1]));
  PetscCall(PetscArraycpy(u + cells, to[1], 2 * cells));
  PetscCall(VecRestoreArray(r->other[1], &to[1]));
  if (!r->coupled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityApplyTangentialToNormal(r->elasticity, r->tangential, r->other[0]));
  PetscCall(SamElasticityApplyNormalToTangential(r->elasticity, r->normal, r->other[1]));
  PetscCall(VecGetArray(r->other[0], &to[0]));
  PetscCall(VecGetArray(r->other[1], &to[1]));
  for (PetscInt k = 0; k < DIRECTIONS * cells; k++) u[k] += k < cells ? to[0][k] : to[1][k - cells];
  PetscCall(VecRestoreArray(r->other[1], &to[1]));
  PetscCall(VecRestoreArray(r->other[0], &to[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the solution ---- */

/* Solves for x, starting from x, by conjugate gradients; u: the displacement for which A x + u vanishes on free
   cells. */
static PetscErrorCode Solve(SamReaction w, const double u[], double x[])
{
  const PetscInt n = DIRECTIONS * w->grid->cells;
  double         first, size, before, step, enough;

  PetscFunctionBegin;
  PetscCall(Displace(w, x, w->r));
  for (PetscInt k = 0; k < n; k++) w->r[k] = -w->r[k] - u[k];
  PetscCall(Dot(w, w->r, w->r, &enough));
  PetscCall(Project(w, w->r));
  PetscCall(PetscArraycpy(w->p, w->r, n));
  PetscCall(Dot(w, w->r, w->r, &first));
  size   = first;
  enough = PetscMax(RTOL * RTOL * first, ROUNDING * ROUNDING * enough);
  for (PetscInt it = 0; it < MOST && size > enough; it++) {
    PetscCall(Displace(w, w->p, w->Ap));
    PetscCall(Project(w, w->Ap));
    PetscCall(Dot(w, w->p, w->Ap, &step));
    step = size / step;
    for (PetscInt k = 0; k < n; k++) {
      x[k] += step * w->p[k];
      w->r[k] -= step * w->Ap[k];
    }
    before = size;
    PetscCall(Dot(w, w->r, w->r, &size));
    for (PetscInt k = 0; k < n; k++) w->p[k] = w->r[k] + size / before * w->p[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReactionApply(SamReaction r, double u[])
{
  const PetscInt cells = r->grid->cells;
  double        *slip  = r->Ap;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(r->x, DIRECTIONS * cells));
  PetscCall(Solve(r, u, r->x));
  if (r->slips) {
    PetscCall(PetscArrayzero(slip, cells));
    for (PetscInt k = 0; k < 2 * cells; k++) slip[k + cells] = r->part[k] * r->x[k % cells];
    for (PetscInt k = 0; k < DIRECTIONS * cells; k++) r->x[k] += slip[k];
    PetscCall(AddRigid(r, slip, -1, r->x)); /* sticking cells carry the load that the others have lost */
    if (r->sticks) PetscCall(Solve(r, u, r->x));
  }
  PetscCall(PetscArraycpy(u, r->x, DIRECTIONS * cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The tractions of the next step, extrapolated from the last two.

  At the edge of the contact the pressure, and at the edge of the stick zone what the shear lacks of the bound, go to
  zero like the square root of the distance. Edges move: extrapolating p or q cell by cell would be wrong by a part of
  the order of one wherever an edge passes. Their squares are linear in the position of the edge, and where the
  extrapolated square is negative the edge has passed. So p^2 is extrapolated, and for q/(mu p), which moves in the unit
  disc, the square of the distance to the disc's edge in the direction in which it moved in the last step. On the edge,
  where cells slip, it goes on along it.
*/
#include "contactimpl.h"
#include <petsam/private/balanceimpl.h>
#include <math.h>

/* A cell is on its circle from this part of the bound on. */
#define ON_CIRCLE (1 - 1e-7)

/* p, q_x and q_y of two steps, and of a row of the next one. */
typedef struct {
  SamGrid grid;
  double  friction;
  double *before[3], *now[3];
  double *next[3];
} Tractions;

static PetscErrorCode GetTractions(Tractions *t, SamGrid grid, PetscReal friction, Vec pressure, Vec shear,
                                   Vec pressure_before, Vec shear_before)
{
  PetscFunctionBegin;
  t->grid     = grid;
  t->friction = friction;
  PetscCall(VecGetArray(pressure, &t->now[0]));
  PetscCall(VecGetArray(shear, &t->now[1]));
  PetscCall(VecGetArray(pressure_before, &t->before[0]));
  PetscCall(VecGetArray(shear_before, &t->before[1]));
  t->now[2]    = t->now[1] + grid->cells;
  t->before[2] = t->before[1] + grid->cells;
  PetscCall(PetscMalloc3(grid->nx, &t->next[0], grid->nx, &t->next[1], grid->nx, &t->next[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RestoreTractions(Tractions *t, Vec pressure, Vec shear, Vec pressure_before, Vec shear_before)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(t->next[0], t->next[1], t->next[2]));
  PetscCall(VecRestoreArray(pressure, &t->now[0]));
  PetscCall(VecRestoreArray(shear, &t->now[1]));
  PetscCall(VecRestoreArray(pressure_before, &t->before[0]));
  PetscCall(VecRestoreArray(shear_before, &t->before[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next p and q of n cells from k on, which are the columns from `first` on. */
SAM_VECTORIZED static void ExtrapolateCells(const Tractions *t, double alpha, ptrdiff_t k, PetscInt first, PetscInt n)
{
  const double *restrict p0 = t->before[0] + k, *restrict qx0 = t->before[1] + k, *restrict qy0 = t->before[2] + k,
                         *restrict p1 = t->now[0] + k, *restrict qx1 = t->now[1] + k, *restrict qy1 = t->now[2] + k;
  double *restrict p = t->next[0] + first, *restrict qx = t->next[1] + first, *restrict qy = t->next[2] + first;
  const double friction = t->friction;

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    const double square = (1 + alpha) * p1[i] * p1[i] - alpha * p0[i] * p0[i], root = sqrt(square > 0 ? square : 0),
                 pressure = p1[i] == p0[i] ? p1[i] : root;
    const double known    = friction * (p0[i] < p1[i] ? p0[i] : p1[i]) > 0 ? 1 : 0,
                 bound0 = friction * p0[i] + (1 - known), bound1 = friction * p1[i] + (1 - known);
    const double rx = qx1[i] / bound1, ry = qy1[i] / bound1, x = rx - qx0[i] / bound0, y = ry - qy0[i] / bound0,
                 way2 = x * x + y * y, n2 = rx * rx + ry * ry;
    const double moves = way2 > 0 ? 1 : 0, inside = n2 < ON_CIRCLE * ON_CIRCLE ? 1 : 0, way = sqrt(way2),
                 along = (rx * x + ry * y) / (way + (1 - moves)), rest = along * along + 1 - n2;
    const double left = sqrt(rest > 0 ? rest : 0) - along, last = left + way,
                 left2 = (1 + alpha) * left * left - alpha * last * last, go = left - sqrt(left2 > 0 ? left2 : 0);
    const double part = inside > 0 ? moves * go / (way + (1 - moves)) : alpha, vx = rx + part * x, vy = ry + part * y,
                 v2    = vx * vx + vy * vy;
    const double scale = friction * pressure * (inside > 0 ? 1 : 1 / sqrt(v2 > 0 ? v2 : 1));

    p[i]  = pressure;
    qx[i] = known > 0 ? scale * vx : qx1[i];
    qy[i] = known > 0 ? scale * vy : qy1[i];
  }
}

/* The next p and q of row j where there is or was pressure: from column first to last - 1. */
static void ExtrapolateRow(const Tractions *t, double alpha, PetscInt j, PetscInt *first, PetscInt *last)
{
  const PetscInt  nx = t->grid->nx;
  const ptrdiff_t k  = (ptrdiff_t)j * nx;
  PetscInt        a[2], b[2];

  SamBoundRange(nx, t->before[0] + k, &a[0], &b[0]);
  SamBoundRange(nx, t->now[0] + k, &a[1], &b[1]);
  *first = PetscMin(a[0], a[1]); /* nx where there is none */
  *last  = PetscMax(*first, PetscMax(a[0] < b[0] ? b[0] : 0, a[1] < b[1] ? b[1] : 0));
  ExtrapolateCells(t, alpha, k + *first, *first, *last - *first);
}

PetscErrorCode SamExtrapolate(SamGrid grid, PetscReal friction, PetscReal alpha, Vec pressure, Vec shear,
                              Vec pressure_before, Vec shear_before, PetscBool *found)
{
  double    most = 0;
  Tractions t;

  PetscFunctionBegin;
  PetscCall(GetTractions(&t, grid, friction, pressure, shear, pressure_before, shear_before));
  for (PetscInt j = 0; j < grid->rows; j++) {
    PetscInt first, last;

    ExtrapolateRow(&t, alpha, j, &first, &last);
    for (PetscInt i = first; i < last; i++) most = PetscMax(most, t.next[0][i]);
    for (PetscInt c = 0; c < 3; c++) {
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + first;

      PetscCall(PetscArraycpy(t.before[c] + k, t.now[c] + k, last - first));
      PetscCall(PetscArraycpy(t.now[c] + k, t.next[c] + first, last - first));
    }
  }
  PetscCall(RestoreTractions(&t, pressure, shear, pressure_before, shear_before));
  PetscCall(SamMax(grid->comm, 1, &most));
  *found = most > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(pressure_before, pressure));
  PetscCall(VecCopy(shear_before, shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFollowBound(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear)
{
  const PetscInt cells = grid->cells;
  const double  *p0, *p;
  double        *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure_before, &p0));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArray(shear, &q));
  for (PetscInt k = 0; k < cells; k++) {
    const double scale = p0[k] > 0 ? p[k] / p0[k] : 0;

    q[k] *= scale;
    q[k + cells] *= scale;
  }
  PetscCall(VecRestoreArray(shear, &q));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(VecRestoreArrayRead(pressure_before, &p0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

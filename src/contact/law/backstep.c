/*
  A step on the way back: the derivatives of what slip rubs off, and sums over cells.

  A cell slips against the pressures before and after the step, weighted by how it turns and by how far all cells slide
  alike (contact/solution/gapandslip.c). These weights have derivatives, too.
*/
#include <petsam/private/backstep.h>
#include <math.h>

/* Returns the weights of the pressures before and after the step in what a cell slips against. */
static void GetShares(const SamBackStep *at, PetscInt k, double *before, double *after)
{
  const double share = at->share[k];

  /* outside of the recorded cells the share is 0, and so are pressure and slip */
  *before = share > 0 ? share : 0;
  *after  = share < 0 ? 0 : 1 - *before;
}

void SamBackFindRubbed(const SamBackStep *at, double rubbed[])
{
  for (PetscInt k = 0; k < at->grid->cells; k++) {
    double before, after;

    GetShares(at, k, &before, &after);
    rubbed[k] =
      (before * at->pressure_before[k] + after * at->pressure[k]) * hypot(at->slip[k], at->slip[k + at->grid->cells]);
  }
}

/* Adds the derivatives by the part of its slip with which a cell turns round; `turning`: that of the number by it. */
static void AddTurning(SamBackStep *at, PetscInt k, double turning, double length)
{
  const PetscInt l  = k + at->grid->cells;
  const double   b0 = at->friction[k] * at->pressure_before[k], x = at->slip[k] / length, y = at->slip[l] / length;
  const double   qx = at->shear_before[k] / b0, qy = at->shear_before[l] / b0, back = qx * x + qy * y;

  at->by_slip[k] += turning * (qx - back * x) / length;
  at->by_slip[l] += turning * (qy - back * y) / length;
  at->by_shear_before[k] += turning * x / b0;
  at->by_shear_before[l] += turning * y / b0;
  at->by_pressure_before[k] -= turning * back / at->pressure_before[k];
  at->by_friction[k] -= turning * back / at->friction[k];
}

/* Adds the derivatives by the two slips that determine how far all cells slide alike. */
static void AddEnds(SamBackStep *at, double by_alike)
{
  const SamGrid g = at->grid;

  for (int n = 0; n < 2; n++) {
    const PetscInt64 k = at->end[n] - (PetscInt64)g->row_start * g->nx;
    double           length;

    if (at->end[n] < 0 || k < 0 || k >= g->cells) continue;
    length = hypot(at->slip[k], at->slip[k + g->cells]);
    at->by_slip[k] += by_alike * at->by_end[n] * at->slip[k] / length;
    at->by_slip[k + g->cells] += by_alike * at->by_end[n] * at->slip[k + g->cells] / length;
  }
}

PetscErrorCode SamBackAddRubbed(SamBackStep *at, const double factor[])
{
  const SamGrid g     = at->grid;
  SamTotal      total = {0};
  double        by_alike;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) {
      const double length = hypot(at->slip[k], at->slip[k + g->cells]);
      double       before, after, against, shift;

      GetShares(at, k, &before, &after);
      against = before * at->pressure_before[k] + after * at->pressure[k];
      at->by_pressure[k] += factor[k] * after * length;
      at->by_pressure_before[k] += factor[k] * before * length;
      if (!(length > 0) || at->share[k] < 0) continue;
      at->by_slip[k] += factor[k] * against * at->slip[k] / length;
      at->by_slip[k + g->cells] += factor[k] * against * at->slip[k + g->cells] / length;
      shift = factor[k] * (at->pressure_before[k] - at->pressure[k]) * length;
      row += shift * at->by_alike[k];
      if (at->by_back[k] != 0) AddTurning(at, k, shift * at->by_back[k], length);
    }
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(g->comm, 1, &total, &by_alike));
  AddEnds(at, by_alike);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sums over the cells ---- */

PetscErrorCode SamBackSumMoments(SamGrid g, const double values[], double sums[3])
{
  SamTotal total[3] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    const double y      = (double)SamGridY(g, g->row_start + j);
    double       row[3] = {0};

    for (PetscInt i = 0; i < g->nx; i++) {
      const double one = values[j * g->nx + i];

      row[0] += one;
      row[1] += (double)SamGridX(g, i) * one;
      row[2] += y * one;
    }
    SamAddAll(3, total, row);
  }
  PetscCall(SamSumTotals(g->comm, 3, total, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

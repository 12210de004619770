/*
  The tension of a gap and its energy, as means over cells.

    Maugis:       s_0 for g < h, else 0;    energy -s_0 max(h - g, 0)
    exponential:  s_0 exp(-g/h);            energy -w exp(-g/h),     h = w/s_0

  The constant tension ends within cells, at the line g = h. In a cell the gap is taken as linear, by differences from
  the cells beside it: it differs from that at the centre by u + v, each uniformly distributed, over widths A >= B. Then
  the part of the cell with u + v < m, m = h - g, is a trapezoid's distribution function, and the mean of max(m - u - v,
  0) its integral. With whole cells instead, the pull is of first order in the width of the cells, and the edge of the
  tension moves by whole cells only.
*/
#include "adhesion.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/rows.h>
#include <math.h>

/* Returns the part of a cell with u + v < m. */
static double Part(double m, double a, double b)
{
  const double end = 0.5 * (a + b) - fabs(m);
  double       tail;

  if (end <= 0) return m > 0 ? 1 : 0;
  if (2 * fabs(m) <= a - b) return 0.5 + m / a;
  tail = end * end / (2 * a * b);
  return m > 0 ? 1 - tail : tail;
}

/* Returns the mean of max(m - u - v, 0) over a cell. */
static double Depth(double m, double a, double b)
{
  const double end = 0.5 * (a + b) - fabs(m);

  if (end <= 0) return m > 0 ? m : 0;
  if (2 * fabs(m) <= a - b) return m * m / (2 * a) + 0.5 * m + a / 8 + b * b / (24 * a);
  return (m > 0 ? m : 0) + end * end * end / (6 * a * b);
}

/* The gap about this rank's cells */
typedef struct {
  SamHalo seen;
  SamGrid grid;
} Gap;

/* Returns by how much the gap changes over a cell along an axis, from the cells beside it that the grid has: half of
   their difference, at most twice the smaller change to one of them: a step of the surface beside a cell is none in
   it. */
static double Change(const Gap *gap, PetscInt axis, PetscInt i, PetscInt j)
{
  const PetscInt at = axis ? j : i, n = axis ? gap->grid->ny : gap->grid->nx;
  const double   own = SamHaloAt(&gap->seen, 0, i, j);
  double         change[2];

  for (int side = 0; side < 2; side++) {
    const PetscInt way = side ? 1 : -1, to = at + way;

    change[side] = gap->seen.wraps || (to >= 0 && to < n)
                     ? (double)way * (SamHaloAt(&gap->seen, 0, axis ? i : to, axis ? to : j) - own)
                     : NAN;
  }
  if (isnan(change[0]) && isnan(change[1])) return 0;
  for (int side = 0; side < 2; side++)
    if (isnan(change[side])) return fabs(change[1 - side]);
  return PetscMin(0.5 * fabs(change[0] + change[1]), 2 * PetscMin(fabs(change[0]), fabs(change[1])));
}

static double OfCell(const SamAdhesion *a, const Gap *gap, PetscBool energy, PetscInt i, PetscInt j)
{
  const double stress = (double)a->stress, range = SamAdhesionRange(a), g = SamHaloAt(&gap->seen, 0, i, j);
  double       along[2], wide, narrow, left;

  if (a->kind == SAM_ADHESION_EXPONENTIAL) {
    left = exp(-PetscMax(g, 0) / range);
    return energy ? -(double)a->work * left : stress * left;
  }
  for (PetscInt axis = 0; axis < 2; axis++) along[axis] = axis < gap->grid->axes ? Change(gap, axis, i, j) : 0;
  wide   = PetscMax(along[0], along[1]);
  narrow = PetscMin(along[0], along[1]);
  return energy ? -stress * Depth(range - g, wide, narrow) : stress * Part(range - g, wide, narrow);
}

PetscErrorCode SamAdhesionCells(SamLaw law, Vec field, PetscBool energy, Vec values)
{
  const SamGrid grid = law->grid;
  Gap           gap  = {.grid = grid};
  double       *to;

  PetscFunctionBegin;
  PetscCall(SamHaloBegin(grid, field, 1, 1, SamElasticityGetTraits(law->elasticity).periodic, &gap.seen));
  PetscCall(VecGetArray(values, &to));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++)
      to[(ptrdiff_t)j * grid->nx + i] += OfCell((const SamAdhesion *)law->data, &gap, energy, i, grid->row_start + j);
  PetscCall(VecRestoreArray(values, &to));
  PetscCall(SamHaloEnd(&gap.seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

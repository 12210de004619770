/*
  Moves a field over the grid: by whole cells without error, by parts of a cell with cubic interpolation along x, then
  y. The error is of fourth order in the cells' size where the field is smooth, of first order at a kink. Rows that lie
  on other ranks are fetched, so that the bits are the same on any number of ranks.
*/
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>
#include <math.h>

/* Distances within this part of a cell from a whole number of cells are taken for whole cells. */
#define WHOLE 1e-6
#define TAPS  4

/* Entry i of the moved field is the sum of tap[k] times entry i + first + k, 0 <= k < count. */
typedef struct {
  PetscInt first, count;
  double   tap[TAPS];
} Stencil;

/* Returns the shift in cells. Beyond the grid's width nothing is left to interpolate, or the period begins again. */
static double ShiftOf(PetscReal distance, PetscReal cell, PetscInt n, SamBorder border)
{
  const double shift = (double)(distance / cell);

  if (border == SAM_BORDER_WRAPS) return fmod(shift, n);
  return PetscMax(PetscMin(shift, n + 1.0), -(n + 1.0));
}

static Stencil StencilOf(double shift)
{
  const double whole = round(shift), t = shift - floor(shift);

  if (fabs(shift - whole) < WHOLE) return (Stencil){(PetscInt)whole, 1, {1}};
  return (Stencil){(PetscInt)floor(shift) - 1,
                   TAPS,
                   {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                    (t + 1) * t * (t - 1) / 6}};
}

void SamGridEntering(SamGrid grid, const PetscReal distance[2], PetscInt low[2], PetscInt high[2])
{
  for (int axis = 0; axis < 2; axis++) {
    const PetscInt n = axis ? grid->ny : grid->nx;
    const Stencil  s = StencilOf(ShiftOf(distance[axis], axis ? grid->dy : grid->dx, n, SAM_BORDER_ZERO));

    low[axis]  = PetscMin(PetscMax(-s.first, 0), n);
    high[axis] = PetscMin(PetscMax(s.first + s.count - 1, 0), n);
  }
}

/*
  Returns the index of the entry used for entry i of n. Beyond the grid this is the first or last entry, one of the
  period, or -1 for none.
*/
static PetscInt EntryFor(PetscInt i, PetscInt n, SamBorder border)
{
  if (i >= 0 && i < n) return i;
  if (border == SAM_BORDER_WRAPS) return (i % n + n) % n;
  return border == SAM_BORDER_CONTINUES ? (i < 0 ? 0 : n - 1) : -1;
}

static void MoveRow(PetscInt n, const Stencil *s, SamBorder border, const double from[], double to[])
{
  for (PetscInt i = 0; i < n; i++) {
    double sum = 0;

    for (PetscInt k = 0; k < s->count; k++) {
      const PetscInt entry = EntryFor(i + s->first + k, n, border);

      if (entry >= 0) sum += s->tap[k] * from[entry];
    }
    to[i] = sum;
  }
}

/* Moves a component along y in place. */
static PetscErrorCode MoveColumns(SamGrid grid, const Stencil *s, SamBorder border, double field[])
{
  const PetscInt nx = grid->nx, ny = grid->ny, begin = grid->row_start + s->first,
                 end = begin + grid->rows + s->count - 2;
  const PetscBool both =
    border == SAM_BORDER_WRAPS && (begin < 0 || end >= ny); /* rows at both ends: all are fetched */
  const PetscInt first = both ? 0 : PetscMax(PetscMin(begin, ny - 1), 0),
                 last  = both ? ny - 1 : PetscMax(PetscMin(end, ny - 1), 0);
  const double *seen;
  double       *moved;
  SamRows       rows;

  PetscFunctionBegin;
  PetscCall(SamRowsCreate(grid, grid->rows ? first : 0, grid->rows ? last + 1 - first : 0, &rows));
  PetscCall(SamRowsFetch(&rows, nx, field, &seen));
  PetscCall(PetscCalloc1(grid->cells, &moved));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt k = 0; k < s->count; k++) {
      const PetscInt row = EntryFor(begin + j + k, ny, border);

      if (row < 0) continue;
      for (PetscInt i = 0; i < nx; i++)
        moved[(ptrdiff_t)j * nx + i] += s->tap[k] * seen[(ptrdiff_t)(row - first) * nx + i];
    }
  PetscCall(SamRowsRestore(&rows, &seen));
  PetscCall(PetscArraycpy(field, moved, grid->cells));
  PetscCall(PetscFree(moved));
  PetscCall(SamRowsDestroy(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridMove(SamGrid grid, PetscInt components, const PetscReal distance[2], SamBorder border, Vec from,
                           Vec to)
{
  const Stencil x = StencilOf(ShiftOf(distance[0], grid->dx, grid->nx, border)),
                y = StencilOf(ShiftOf(distance[1], grid->dy, grid->ny, border));
  const double *f;
  double       *t;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(from, &f));
  PetscCall(VecGetArrayWrite(to, &t));
  for (PetscInt c = 0; c < components; c++) {
    const ptrdiff_t first = (ptrdiff_t)c * grid->cells;

    for (PetscInt j = 0; j < grid->rows; j++)
      MoveRow(grid->nx, &x, border, f + first + (ptrdiff_t)j * grid->nx, t + first + (ptrdiff_t)j * grid->nx);
    if (distance[1] != 0) PetscCall(MoveColumns(grid, &y, border, t + first));
  }
  PetscCall(VecRestoreArrayWrite(to, &t));
  PetscCall(VecRestoreArrayRead(from, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

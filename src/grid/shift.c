/*
  A field moved over the grid: by whole cells exactly, by parts of a cell with cubic interpolation along x, then y. Its
  error is of fourth order in the cells' size where the field is smooth, of first order at a kink. Rows that lie on
  other ranks are fetched, so that the bits are the same on any number of ranks.
*/
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>
#include <math.h>

/* Distances nearer than this to whole cells are taken for such, parts of a cell. */
#define WHOLE 1e-6
#define TAPS  4

/* Entry i of the moved field is the sum of tap[k] times entry i + first + k, 0 <= k < count. */
typedef struct {
  PetscInt first, count;
  double   tap[TAPS];
} Stencil;

static Stencil StencilOf(PetscReal distance, PetscReal cell, PetscInt n)
{
  const double shift = PetscMax(PetscMin((double)(distance / cell), n + 1.0), -(n + 1.0)), whole = round(shift);
  const double t = shift - floor(shift);

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
    const Stencil  s = StencilOf(distance[axis], axis ? grid->dy : grid->dx, n);

    low[axis]  = PetscMin(PetscMax(-s.first, 0), n);
    high[axis] = PetscMin(PetscMax(s.first + s.count - 1, 0), n);
  }
}

/* The entry that stands for entry i of n: beyond the first and the last one of these, or none, -1. */
static PetscInt EntryFor(PetscInt i, PetscInt n, PetscBool continues)
{
  if (i >= 0 && i < n) return i;
  return continues ? (i < 0 ? 0 : n - 1) : -1;
}

static void MoveRow(PetscInt n, const Stencil *s, PetscBool continues, const double from[], double to[])
{
  for (PetscInt i = 0; i < n; i++) {
    double sum = 0;

    for (PetscInt k = 0; k < s->count; k++) {
      const PetscInt entry = EntryFor(i + s->first + k, n, continues);

      if (entry >= 0) sum += s->tap[k] * from[entry];
    }
    to[i] = sum;
  }
}

/* Moves a component along y in place. */
static PetscErrorCode MoveColumns(SamGrid grid, const Stencil *s, PetscBool continues, double field[])
{
  const PetscInt nx = grid->nx, ny = grid->ny, begin = grid->row_start + s->first;
  const PetscInt first = PetscMax(PetscMin(begin, ny - 1), 0),
                 last  = PetscMax(PetscMin(begin + grid->rows + s->count - 2, ny - 1), 0);
  const double *seen;
  double       *moved;
  SamRows       rows;

  PetscFunctionBegin;
  PetscCall(SamRowsCreate(grid, grid->rows ? first : 0, grid->rows ? last + 1 - first : 0, &rows));
  PetscCall(SamRowsFetch(&rows, nx, field, &seen));
  PetscCall(PetscCalloc1(grid->cells, &moved));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt k = 0; k < s->count; k++) {
      const PetscInt row = EntryFor(begin + j + k, ny, continues);

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

PetscErrorCode SamGridMove(SamGrid grid, PetscInt components, const PetscReal distance[2], PetscBool continues,
                           Vec from, Vec to)
{
  const Stencil x = StencilOf(distance[0], grid->dx, grid->nx), y = StencilOf(distance[1], grid->dy, grid->ny);
  const double *f;
  double       *t;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(from, &f));
  PetscCall(VecGetArrayWrite(to, &t));
  for (PetscInt c = 0; c < components; c++) {
    const ptrdiff_t first = (ptrdiff_t)c * grid->cells;

    for (PetscInt j = 0; j < grid->rows; j++)
      MoveRow(grid->nx, &x, continues, f + first + (ptrdiff_t)j * grid->nx, t + first + (ptrdiff_t)j * grid->nx);
    if (distance[1] != 0) PetscCall(MoveColumns(grid, &y, continues, t + first));
  }
  PetscCall(VecRestoreArrayWrite(to, &t));
  PetscCall(VecRestoreArrayRead(from, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

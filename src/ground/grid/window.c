/*
  A window: a rectangle of cells as a grid of its own.

  Both grids have their rows in slabs; rows.c exchanges the rows that one grid needs from the other.
*/
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>
#include <string.h>

struct _n_SamWindow {
  SamGrid  grid, part;
  PetscInt first[2];
  SamRows  taken; /* rows of the whole grid that are this rank's rows of the window */
  SamRows  put;   /* rows of the window among this rank's rows of the whole grid */
};

PetscErrorCode SamWindowCreate(SamGrid grid, const PetscInt first[2], const PetscInt n[2], SamWindow *window)
{
  const PetscReal step[2] = {grid->dx, grid->dy};
  const PetscInt  all[2]  = {grid->nx, grid->ny};
  PetscInt        begin, end;
  PetscReal       width[2], center[2];
  SamWindow       w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  PetscCall(SamGridReference(grid));
  w->grid = grid;
  for (PetscInt k = 0; k < 2; k++) {
    PetscCheck(first[k] >= 0 && n[k] >= PetscMin(2, all[k]) && first[k] + n[k] <= all[k], grid->comm,
               PETSC_ERR_ARG_OUTOFRANGE, "The window is not part of the grid");
    w->first[k] = first[k];
    width[k]    = step[k] * (PetscReal)n[k];
    center[k]   = grid->center[k] + ((PetscReal)first[k] + 0.5 * (PetscReal)n[k] - 0.5 * (PetscReal)all[k]) * step[k];
  }
  PetscCall(SamGridCreate(grid->comm, n, width, center, &w->part));
  begin = PetscMax(grid->row_start, first[1]);
  end   = PetscMin(grid->row_start + grid->rows, first[1] + n[1]);
  PetscCall(SamRowsCreate(grid, w->part->row_start + first[1], w->part->rows, &w->taken));
  PetscCall(SamRowsCreate(w->part, PetscMax(begin - first[1], 0), PetscMax(end - begin, 0), &w->put));
  *window = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWindowDestroy(SamWindow *window)
{
  SamWindow w = *window;

  PetscFunctionBegin;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamRowsDestroy(&w->taken));
  PetscCall(SamRowsDestroy(&w->put));
  PetscCall(SamGridDestroy(&w->part));
  PetscCall(SamGridDestroy(&w->grid));
  PetscCall(PetscFree(*window));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWindowGetPlace(SamWindow w, PetscInt first[2], PetscInt n[2])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) first[k] = w->first[k];
  n[0] = w->part->nx;
  n[1] = w->part->ny;
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamGrid SamWindowGetGrid(SamWindow w)
{
  return w->part;
}

PetscBool SamWindowCovers(SamWindow w, const PetscInt first[2], const PetscInt n[2])
{
  const PetscInt mine[2] = {w->part->nx, w->part->ny};

  for (PetscInt k = 0; k < 2; k++)
    if (first[k] < w->first[k] || first[k] + n[k] > w->first[k] + mine[k]) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode SamWindowTake(SamWindow w, Vec whole, Vec part)
{
  const size_t  nx = (size_t)w->part->nx, row = sizeof(double) * nx;
  PetscInt      components;
  const double *from, *rows;
  double       *to, *columns;

  PetscFunctionBegin;
  PetscCall(SamGridMatch(w->grid, whole, w->part, part, "this window", &components));
  /* Allocated for all rows of this rank, though only those of the window are filled and sent. */
  PetscCall(SamAllocate(sizeof(*columns) * (size_t)w->grid->rows * nx, &columns));
  PetscCall(VecGetArrayRead(whole, &from));
  PetscCall(VecGetArrayWrite(part, &to));
  for (PetscInt c = 0; c < components; c++) {
    for (PetscInt j = w->put.first + w->first[1] - w->grid->row_start, end = j + w->put.count; j < end; j++)
      memcpy(columns + (size_t)j * nx, from + c * w->grid->cells + j * w->grid->nx + w->first[0], row);
    PetscCall(SamRowsFetch(&w->taken, w->part->nx, columns, &rows));
    PetscCall(PetscArraycpy(to + c * w->part->cells, rows, w->part->cells));
    PetscCall(SamRowsRestore(&w->taken, &rows));
  }
  PetscCall(VecRestoreArrayWrite(part, &to));
  PetscCall(VecRestoreArrayRead(whole, &from));
  SamFree(columns);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWindowPut(SamWindow w, Vec part, Vec whole)
{
  const size_t  nx = (size_t)w->part->nx;
  PetscInt      components;
  const double *from, *rows;
  double       *to;

  PetscFunctionBegin;
  PetscCall(SamGridMatch(w->grid, whole, w->part, part, "this window", &components));
  PetscCall(VecGetArrayRead(part, &from));
  PetscCall(SamVecZero(whole));
  PetscCall(VecGetArray(whole, &to));
  for (PetscInt c = 0; c < components; c++) {
    PetscCall(SamRowsFetch(&w->put, w->part->nx, from + c * w->part->cells, &rows));
    for (PetscInt j = 0; j < w->put.count; j++)
      memcpy(to + c * w->grid->cells + (w->put.first + w->first[1] + j - w->grid->row_start) * w->grid->nx +
               w->first[0],
             rows + (size_t)j * nx, sizeof(double) * nx);
    PetscCall(SamRowsRestore(&w->put, &rows));
  }
  PetscCall(VecRestoreArray(whole, &to));
  PetscCall(VecRestoreArrayRead(part, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds the smallest range of lines (columns or rows) that contains all used ones, across the border of the grid, as
  what the longest range of unused lines leaves.
*/
static void FindRange(const char used[], PetscInt lines, PetscInt *first, PetscInt *n)
{
  PetscInt unused = 0;

  *n = lines;
  for (PetscInt k = 0; k < 2 * lines; k++) {
    unused = used[k % lines] ? 0 : unused + 1;
    if (lines - unused >= *n || unused >= lines) continue;
    *n     = lines - unused;
    *first = (k + 1) % lines;
  }
}

/* Finds the smallest rectangle that may lie across the borders. */
static PetscErrorCode FindAcross(SamGrid grid, const double f[], PetscInt first[2], PetscInt n[2])
{
  PetscMPIInt lines;
  char       *used;

  PetscFunctionBegin;
  PetscCall(PetscMPIIntCast(grid->nx + grid->ny, &lines));
  PetscCall(PetscCalloc1(lines, &used)); /* columns, then rows */
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++)
      if (f[j * grid->nx + i] > 0) used[i] = used[grid->nx + grid->row_start + j] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, used, lines, MPI_CHAR, MPI_MAX, grid->comm));
  FindRange(used, grid->nx, &first[0], &n[0]);
  FindRange(used + grid->nx, grid->ny, &first[1], &n[1]);
  PetscCall(PetscFree(used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridGetSupport(SamGrid grid, Vec field, PetscBool wrap, PetscInt first[2], PetscInt n[2])
{
  PetscInt64    bounds[4] = {-grid->nx, -grid->ny, -1, -1}; /* minus the least, and the largest, column and row */
  const double *f;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &f));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      if (f[j * grid->nx + i] <= 0) continue;
      bounds[0] = PetscMax(bounds[0], -i);
      bounds[1] = PetscMax(bounds[1], -(grid->row_start + j));
      bounds[2] = PetscMax(bounds[2], i);
      bounds[3] = PetscMax(bounds[3], grid->row_start + j);
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bounds, 4, MPIU_INT64, MPI_MAX, grid->comm));
  for (PetscInt k = 0; k < 2; k++) {
    first[k] = (PetscInt)-bounds[k];
    n[k]     = bounds[2] < 0 ? 0 : (PetscInt)(bounds[k + 2] + bounds[k]) + 1;
  }
  if (wrap && n[0] > 0) PetscCall(FindAcross(grid, f, first, n));
  PetscCall(VecRestoreArrayRead(field, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridFindPeak(SamGrid grid, Vec field, PetscInt at[2], double *most)
{
  const double *p;
  double        place = -INFINITY;

  PetscFunctionBegin;
  *most = 0;
  PetscCall(VecGetArrayRead(field, &p));
  for (PetscInt c = 0; c < grid->cells; c++) *most = PetscMax(*most, p[c]);
  PetscCall(SamMax(grid->comm, 1, most));
  for (PetscInt c = grid->cells - 1; c >= 0; c--)
    if (p[c] == *most) place = -((double)grid->row_start * (double)grid->nx + (double)c);
  PetscCall(VecRestoreArrayRead(field, &p));
  PetscCall(SamMax(grid->comm, 1, &place));
  at[0] = (PetscInt)fmod(-place, (double)grid->nx);
  at[1] = (PetscInt)floor(-place / (double)grid->nx);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A window: a rectangle of cells as a grid of its own.

  Both grids have their rows in slabs, so what one rank owes another are whole rows of the window: an exchange of all
  with all, in which each rank counts what is whose.
*/
#include "gridimpl.h"
#include <string.h>

struct _n_SamWindow {
  SamGrid      grid, part;
  PetscInt     first[2];
  PetscMPIInt  ranks;
  PetscMPIInt *counts[2], *offsets[2]; /* doubles exchanged with each rank: 0 on the whole grid's side, 1 on the window's */
};

/* Doubles of one component to exchange with each rank: rows that are mine on one side and its on the other. */
static PetscErrorCode CountRows(SamWindow w)
{
  PetscFunctionBegin;
  for (PetscInt side = 0; side < 2; side++) {
    const SamGrid  mine = side ? w->part : w->grid, theirs = side ? w->grid : w->part;
    const PetscInt my_shift = side ? w->first[1] : 0, their_shift = side ? 0 : w->first[1];
    PetscMPIInt    total = 0;

    for (PetscMPIInt r = 0; r < w->ranks; r++) {
      PetscInt begin, end;

      SamGridRowsOf(theirs, w->ranks, r, &begin, &end);
      begin               = PetscMax(begin + their_shift, mine->row_start + my_shift);
      end                 = PetscMin(end + their_shift, mine->row_start + mine->rows + my_shift);
      w->counts[side][r]  = (PetscMPIInt)(PetscMax(end - begin, 0) * w->part->nx);
      w->offsets[side][r] = total;
      total += w->counts[side][r];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWindowCreate(SamGrid grid, const PetscInt first[2], const PetscInt n[2], SamWindow *window)
{
  const PetscReal step[2] = {grid->dx, grid->dy};
  const PetscInt  all[2]  = {grid->nx, grid->ny};
  PetscReal       width[2], center[2];
  SamWindow       w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  PetscCall(SamGridReference(grid));
  w->grid = grid;
  for (PetscInt k = 0; k < 2; k++) {
    PetscCheck(first[k] >= 0 && n[k] >= 2 && first[k] + n[k] <= all[k], grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "The window is not part of the grid");
    w->first[k] = first[k];
    width[k]    = step[k] * (PetscReal)n[k];
    center[k]   = grid->center[k] + ((PetscReal)first[k] + 0.5 * (PetscReal)n[k] - 0.5 * (PetscReal)all[k]) * step[k];
  }
  PetscCall(SamGridCreate(grid->comm, n, width, center, &w->part));
  PetscCallMPI(MPI_Comm_size(grid->comm, &w->ranks));
  PetscCall(PetscMalloc4(w->ranks, &w->counts[0], w->ranks, &w->counts[1], w->ranks, &w->offsets[0], w->ranks, &w->offsets[1]));
  PetscCall(CountRows(w));
  *window = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWindowDestroy(SamWindow *window)
{
  SamWindow w = *window;

  PetscFunctionBegin;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(w->counts[0], w->counts[1], w->offsets[0], w->offsets[1]));
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

PetscErrorCode SamWindowGetGrid(SamWindow w, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = w->part;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamWindowCovers(SamWindow w, const PetscInt first[2], const PetscInt n[2])
{
  const PetscInt mine[2] = {w->part->nx, w->part->ny};

  for (PetscInt k = 0; k < 2; k++)
    if (first[k] < w->first[k] || first[k] + n[k] > w->first[k] + mine[k]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Rows of the window among this rank's rows of the whole grid, their columns packed together. */
static void Pack(SamWindow w, const double whole[], double packed[])
{
  const PetscInt begin = PetscMax(w->grid->row_start, w->first[1]), end = PetscMin(w->grid->row_start + w->grid->rows, w->first[1] + w->part->ny);

  for (PetscInt j = begin; j < end; j++) memcpy(packed + (j - begin) * w->part->nx, whole + (j - w->grid->row_start) * w->grid->nx + w->first[0], sizeof(double) * (size_t)w->part->nx);
}

static void Unpack(SamWindow w, const double packed[], double whole[])
{
  const PetscInt begin = PetscMax(w->grid->row_start, w->first[1]), end = PetscMin(w->grid->row_start + w->grid->rows, w->first[1] + w->part->ny);

  memset(whole, 0, sizeof(double) * (size_t)w->grid->cells);
  for (PetscInt j = begin; j < end; j++) memcpy(whole + (j - w->grid->row_start) * w->grid->nx + w->first[0], packed + (j - begin) * w->part->nx, sizeof(double) * (size_t)w->part->nx);
}

PetscErrorCode SamWindowTake(SamWindow w, Vec whole, Vec part)
{
  PetscInt      components;
  const double *from;
  double       *to, *packed;

  PetscFunctionBegin;
  PetscCall(SamGridMatch(w->grid, whole, w->part, part, "this window", &components));
  PetscCall(PetscMalloc1((size_t)PetscMin(w->grid->rows, w->part->ny) * (size_t)w->part->nx, &packed));
  PetscCall(VecGetArrayRead(whole, &from));
  PetscCall(VecGetArrayWrite(part, &to));
  for (PetscInt c = 0; c < components; c++) {
    Pack(w, from + c * w->grid->cells, packed);
    PetscCallMPI(MPI_Alltoallv(packed, w->counts[0], w->offsets[0], MPI_DOUBLE, to + c * w->part->cells, w->counts[1], w->offsets[1], MPI_DOUBLE, w->grid->comm));
  }
  PetscCall(VecRestoreArrayWrite(part, &to));
  PetscCall(VecRestoreArrayRead(whole, &from));
  PetscCall(PetscFree(packed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWindowPut(SamWindow w, Vec part, Vec whole)
{
  PetscInt      components;
  const double *from;
  double       *to, *packed;

  PetscFunctionBegin;
  PetscCall(SamGridMatch(w->grid, whole, w->part, part, "this window", &components));
  PetscCall(PetscMalloc1((size_t)PetscMin(w->grid->rows, w->part->ny) * (size_t)w->part->nx, &packed));
  PetscCall(VecGetArrayRead(part, &from));
  PetscCall(VecGetArrayWrite(whole, &to));
  for (PetscInt c = 0; c < components; c++) {
    PetscCallMPI(MPI_Alltoallv(from + c * w->part->cells, w->counts[1], w->offsets[1], MPI_DOUBLE, packed, w->counts[0], w->offsets[0], MPI_DOUBLE, w->grid->comm));
    Unpack(w, packed, to + c * w->grid->cells);
  }
  PetscCall(VecRestoreArrayWrite(whole, &to));
  PetscCall(VecRestoreArrayRead(part, &from));
  PetscCall(PetscFree(packed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridGetSupport(SamGrid grid, Vec field, PetscInt first[2], PetscInt n[2])
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
  PetscCall(VecRestoreArrayRead(field, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bounds, 4, MPIU_INT64, MPI_MAX, grid->comm));
  for (PetscInt k = 0; k < 2; k++) {
    first[k] = (PetscInt)-bounds[k];
    n[k]     = bounds[2] < 0 ? 0 : (PetscInt)(bounds[k + 2] + bounds[k]) + 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Fetches the rows of a grid that a rank needs from all ranks. The messages consist of whole rows, so that their number
  stays small.
*/
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>

void SamGridRowsOf(SamGrid grid, PetscMPIInt ranks, PetscMPIInt rank, PetscInt *begin, PetscInt *end)
{
  const PetscInt block = (grid->ny + ranks - 1) / ranks;

  *begin = PetscMin(rank * block, grid->ny);
  *end   = PetscMin(*begin + block, grid->ny);
}

PetscErrorCode SamRowsCreate(SamGrid grid, PetscInt first, PetscInt count, SamRows *rows)
{
  const PetscInt64 mine[2] = {first, count};
  const PetscInt   end     = grid->row_start + grid->rows;
  PetscInt64      *wanted;
  PetscMPIInt      offset = 0;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(rows, sizeof(*rows)));
  PetscCall(SamGridReference(grid));
  PetscCallMPI(MPI_Comm_size(grid->comm, &rows->ranks));
  rows->grid  = grid;
  rows->first = first;
  rows->count = count;
  PetscCall(PetscMalloc4(rows->ranks, &rows->counts[0], rows->ranks, &rows->counts[1], rows->ranks, &rows->offsets[0],
                         rows->ranks, &rows->offsets[1]));
  PetscCall(PetscMalloc1(2 * rows->ranks, &wanted));
  PetscCallMPI(MPI_Allgather(mine, 2, MPIU_INT64, wanted, 2, MPIU_INT64, grid->comm));
  for (PetscMPIInt r = 0; r < rows->ranks; r++) {
    const PetscInt from = PetscMax((PetscInt)wanted[2 * r], grid->row_start);
    PetscInt       begin, stop;

    rows->counts[0][r]  = (PetscMPIInt)PetscMax(PetscMin((PetscInt)(wanted[2 * r] + wanted[2 * r + 1]), end) - from, 0);
    rows->offsets[0][r] = rows->counts[0][r] ? (PetscMPIInt)(from - grid->row_start) : 0;
    SamGridRowsOf(grid, rows->ranks, r, &begin, &stop);
    rows->counts[1][r]  = (PetscMPIInt)PetscMax(PetscMin(first + count, stop) - PetscMax(first, begin), 0);
    rows->offsets[1][r] = offset;
    offset += rows->counts[1][r];
  }
  PetscCall(PetscFree(wanted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRowsCreateAbout(SamGrid grid, PetscInt halo, SamRows *rows)
{
  const PetscInt begin = PetscMax(grid->row_start - halo, 0),
                 end   = PetscMin(grid->row_start + grid->rows + halo, grid->ny);

  PetscFunctionBegin;
  PetscCall(SamRowsCreate(grid, grid->rows ? begin : 0, grid->rows ? end - begin : 0, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRowsDestroy(SamRows *rows)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(rows->counts[0], rows->counts[1], rows->offsets[0], rows->offsets[1]));
  PetscCall(SamGridDestroy(&rows->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRowsFetch(const SamRows *rows, PetscInt columns, const double own[], const double **wanted)
{
  MPI_Datatype row;
  double      *array;

  PetscFunctionBegin;
  if (rows->ranks == 1) {
    *wanted = own + (size_t)rows->first * (size_t)columns;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamAllocate(sizeof(*array) * (size_t)rows->count * (size_t)columns, &array));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)columns, MPI_DOUBLE, &row));
  PetscCallMPI(MPI_Type_commit(&row));
  PetscCallMPI(MPI_Alltoallv(own, rows->counts[0], rows->offsets[0], row, array, rows->counts[1], rows->offsets[1], row,
                             rows->grid->comm));
  PetscCallMPI(MPI_Type_free(&row));
  *wanted = array;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRowsRestore(const SamRows *rows, const double **wanted)
{
  PetscFunctionBegin;
  if (rows->ranks > 1) SamFree((void *)*wanted);
  *wanted = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHaloBegin(SamGrid grid, Vec field, PetscInt components, PetscInt halo, PetscBool wraps, SamHalo *seen)
{
  const PetscInt  most  = PetscMin(halo, grid->ny);
  const PetscBool first = grid->rows && grid->row_start < halo ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool last  = grid->rows && grid->row_start + grid->rows > grid->ny - halo ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  *seen = (SamHalo){.field = field, .components = components, .wraps = wraps};
  PetscCall(SamRowsCreateAbout(grid, halo, &seen->rows));
  if (wraps) PetscCall(SamRowsCreate(grid, first ? grid->ny - most : 0, first ? most : 0, &seen->beyond[0]));
  if (wraps) PetscCall(SamRowsCreate(grid, 0, last ? most : 0, &seen->beyond[1]));
  PetscCall(VecGetArrayRead(field, &seen->own));
  for (PetscInt c = 0; c < components; c++) {
    const double *own = seen->own + (ptrdiff_t)c * grid->cells;

    PetscCall(SamRowsFetch(&seen->rows, grid->nx, own, &seen->at[c]));
    for (int k = 0; k < 2 && wraps; k++) PetscCall(SamRowsFetch(&seen->beyond[k], grid->nx, own, &seen->past[k][c]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHaloEnd(SamHalo *seen)
{
  PetscFunctionBegin;
  for (PetscInt c = seen->components; c-- > 0;) {
    for (int k = 2; k-- > 0 && seen->wraps;) PetscCall(SamRowsRestore(&seen->beyond[k], &seen->past[k][c]));
    PetscCall(SamRowsRestore(&seen->rows, &seen->at[c]));
  }
  PetscCall(VecRestoreArrayRead(seen->field, &seen->own));
  for (int k = 0; k < 2 && seen->wraps; k++) PetscCall(SamRowsDestroy(&seen->beyond[k]));
  PetscCall(SamRowsDestroy(&seen->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGather(MPI_Comm comm, MPI_Datatype type, PetscInt n, const void *mine, PetscInt *total, void *all)
{
  PetscMPIInt rank, ranks, bytes, count, sum = 0, *counts, *starts;
  void       *array = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCallMPI(MPI_Type_size(type, &bytes));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCall(PetscMalloc2(ranks, &counts, ranks, &starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < ranks; r++) {
    starts[r] = sum;
    sum += counts[r];
  }
  if (rank == 0) PetscCall(PetscMalloc((size_t)sum * (size_t)bytes, &array));
  PetscCallMPI(MPI_Gatherv(mine, count, type, array, counts, starts, type, 0, comm));
  PetscCall(PetscFree2(counts, starts));
  *total        = sum;
  *(void **)all = array;
  PetscFunctionReturn(PETSC_SUCCESS);
}

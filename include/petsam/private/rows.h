/* Access to rows of a grid, also to those that other ranks own. */
#ifndef PETSAM_ROWS_H
#define PETSAM_ROWS_H

#include <petsam/grid.h>

/*
  SamRows - the rows first ... first + count - 1 of a grid, its own or other ranks', that this rank reads. Create and
  Fetch are collective. Fetch takes this rank's rows of `columns` doubles and provides the wanted rows until Restore; it
  copies nothing if this rank owns them all. CreateAbout selects this rank's rows with `halo` more on either side,
  within the grid; none if this rank has no rows.
*/
typedef struct {
  SamGrid     grid;
  PetscMPIInt ranks;
  PetscInt    first, count;
  /* rows exchanged with each rank: [0] rows sent to it, [1] rows received from it */
  PetscMPIInt *counts[2], *offsets[2];
} SamRows;
PETSC_INTERN PetscErrorCode SamRowsCreate(SamGrid grid, PetscInt first, PetscInt count, SamRows *rows);
PETSC_INTERN PetscErrorCode SamRowsCreateAbout(SamGrid grid, PetscInt halo, SamRows *rows);
PETSC_INTERN PetscErrorCode SamRowsDestroy(SamRows *rows);
PETSC_INTERN PetscErrorCode SamRowsFetch(const SamRows *rows, PetscInt columns, const double own[],
                                         const double **wanted);
PETSC_INTERN PetscErrorCode SamRowsRestore(const SamRows *rows, const double **wanted);

#define SAM_HALO_MOST 6
/*
  SamHalo - a field in this rank's rows and `halo` more before and after them. SamHaloBegin - fetches it; `components`:
  at most SAM_HALO_MOST. SamHaloEnd - restores it. Both are collective.
  SamHaloAt - returns a component in the cell in column i of the grid's row j; 0 outside of the fetched rows. Not
  collective.
*/
typedef struct {
  Vec           field;
  PetscInt      components;
  SamRows       rows;
  const double *own, *at[SAM_HALO_MOST]; /* components of the fetched rows */
} SamHalo;
PETSC_INTERN PetscErrorCode SamHaloBegin(SamGrid grid, Vec field, PetscInt components, PetscInt halo, SamHalo *seen);
PETSC_INTERN PetscErrorCode SamHaloEnd(SamHalo *seen);
static inline double        SamHaloAt(const SamHalo *seen, PetscInt component, PetscInt i, PetscInt j)
{
  const PetscInt row = j - seen->rows.first, nx = seen->rows.grid->nx;

  return i < 0 || i >= nx || row < 0 || row >= seen->rows.count ? 0 : seen->at[component][(ptrdiff_t)row * nx + i];
}

/*
  SamGather - gathers the arrays of all ranks, n items of this rank, one after the other on rank 0. `all`: the address
  of a pointer, which becomes NULL on other ranks, to be freed by PetscFree(); `total`: the number of items of all
  ranks, set on all ranks. Collective.
*/
PETSC_INTERN PetscErrorCode SamGather(MPI_Comm comm, MPI_Datatype type, PetscInt n, const void *mine, PetscInt *total,
                                      void *all);

#endif

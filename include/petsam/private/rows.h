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
  at most SAM_HALO_MOST; `wraps`: the field is periodic. SamHaloEnd - restores it. Both are collective.
  SamHaloAt - returns a component in the cell in column i of the grid's row j; 0 outside of the fetched rows. A periodic
  field continues beyond the grid. Not collective.
*/
typedef struct {
  Vec           field;
  PetscBool     wraps;
  PetscInt      components;
  SamRows       rows, beyond[2];         /* beyond: the grid's last and first rows, where they are next to these */
  const double *own, *at[SAM_HALO_MOST]; /* components of the fetched rows */
  const double *past[2][SAM_HALO_MOST];  /* of those beyond the grid */
} SamHalo;
PETSC_INTERN PetscErrorCode SamHaloBegin(SamGrid grid, Vec field, PetscInt components, PetscInt halo, PetscBool wraps,
                                         SamHalo *seen);
PETSC_INTERN PetscErrorCode SamHaloEnd(SamHalo *seen);
static inline double        SamHaloAt(const SamHalo *seen, PetscInt component, PetscInt i, PetscInt j)
{
  const PetscInt nx = seen->rows.grid->nx, ny = seen->rows.grid->ny;

  if (seen->wraps) i = (i % nx + nx) % nx;
  if (seen->wraps) j = (j % ny + ny) % ny;
  if (i < 0 || i >= nx) return 0;
  if (j >= seen->rows.first && j < seen->rows.first + seen->rows.count)
    return seen->at[component][(ptrdiff_t)(j - seen->rows.first) * nx + i];
  for (int k = 0; k < 2 && seen->wraps; k++) {
    const PetscInt row = j - seen->beyond[k].first;

    if (row >= 0 && row < seen->beyond[k].count) return seen->past[k][component][(ptrdiff_t)row * nx + i];
  }
  return 0;
}

/*
  SamGather - gathers the arrays of all ranks, n items of this rank, one after the other on rank 0. `all`: the address
  of a pointer, which becomes NULL on other ranks, to be freed by PetscFree(); `total`: the number of items of all
  ranks, set on all ranks. Collective.
*/
PETSC_INTERN PetscErrorCode SamGather(MPI_Comm comm, MPI_Datatype type, PetscInt n, const void *mine, PetscInt *total,
                                      void *all);

#endif

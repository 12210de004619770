/* Rows of a grid that a rank wants to see besides its own. */
#ifndef PETSAM_ROWS_H
#define PETSAM_ROWS_H

#include <petsam/grid.h>

/*
  SamRows - rows first ... first + count - 1 of a grid, which this rank wants to see, its own or others'. Create and
  Fetch are collective. Fetch takes this rank's rows of `columns` doubles and gives the wanted ones until Restore; when
  they are all its own it copies nothing. CreateAbout wants this rank's rows with `halo` more on either side, as far as
  the grid goes, and none where this rank has none.
*/
typedef struct {
  SamGrid     grid;
  PetscMPIInt ranks;
  PetscInt    first, count;
  /* rows exchanged with each rank: [0] those that it wants of this rank, [1] those that this rank wants of it */
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
  SamHalo - a field in this rank's rows and `halo` more before and after them. SamHaloBegin - fetches it;
  `components`: at most SAM_HALO_MOST. SamHaloEnd - gives it back. Collective.
  SamHaloAt - a component in the cell in column i of the grid's row j; 0 beyond what is seen. Not collective.
*/
typedef struct {
  Vec           field;
  PetscInt      components;
  SamRows       rows;
  const double *own, *at[SAM_HALO_MOST]; /* the components of the rows that are seen */
} SamHalo;
PETSC_INTERN PetscErrorCode SamHaloBegin(SamGrid grid, Vec field, PetscInt components, PetscInt halo, SamHalo *seen);
PETSC_INTERN PetscErrorCode SamHaloEnd(SamHalo *seen);
static inline double        SamHaloAt(const SamHalo *seen, PetscInt component, PetscInt i, PetscInt j)
{
  const PetscInt row = j - seen->rows.first, nx = seen->rows.grid->nx;

  return i < 0 || i >= nx || row < 0 || row >= seen->rows.count ? 0 : seen->at[component][(ptrdiff_t)row * nx + i];
}

/*
  SamGather - arrays of all ranks, n items of this one, one after the other on rank 0. `all`: the address of a pointer,
  NULL on other ranks, to be freed by PetscFree(); `total`: the items of all ranks, on all of them. Collective.
*/
PETSC_INTERN PetscErrorCode SamGather(MPI_Comm comm, MPI_Datatype type, PetscInt n, const void *mine, PetscInt *total,
                                      void *all);

#endif

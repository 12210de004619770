/* The grid of rectangular cells, how its rows are spread over the ranks, and moving fields between grids. */
#ifndef PETSAM_GRID_H
#define PETSAM_GRID_H

#include <petsam/base.h>

/*
  SamGrid - nx * ny cells of dx * dy (m), x the fast index; ny = 1 for plane problems, whose cells are 1 m wide along y,
  so that sums over cells are per metre. Rows lie in slabs of ceil(ny/ranks) rows, the layout of
  FFTW's MPI transforms; the last ranks may own none. A plain struct: read its members, do not change them.
*/
typedef struct _n_SamGrid *SamGrid;
struct _n_SamGrid {
  MPI_Comm  comm;            /* the library's own */
  PetscInt  nx, ny;          /* cells */
  PetscReal width[2];        /* full width in x, y (m) */
  PetscReal center[2];       /* m */
  PetscReal dx, dy;          /* cell size (m) */
  PetscInt  row_start, rows; /* this rank's rows */
  PetscInt  cells;           /* this rank's cells: rows * nx */
  /* without what lies along y where fields do not vary with it, in the one row of plane strain: */
  PetscInt  axes;    /* 2: x and y; 1: x */
  PetscReal side[2]; /* the shorter and the longer side of a cell (m) */
  PetscReal length;  /* half the larger width: makes coordinates dimensionless (m) */
  PetscInt  references;
};

/*
  SamGridCreate - n[0] * n[1] cells of full width `width` about `center` (m). Collective. The grid and all that is made
  on it use a communicator of the library's own, PETSc's duplicate of `comm`, so that their messages never meet those
  of the caller.
  Errors: PETSC_ERR_ARG_OUTOFRANGE when n[0] < 2 or n[1] < 1, a width is not positive and finite, or the cells
  cannot be counted in a PetscInt.
*/
PETSC_EXTERN PetscErrorCode SamGridCreate(MPI_Comm comm, const PetscInt n[2], const PetscReal width[2],
                                          const PetscReal center[2], SamGrid *grid);
/*
  SamGridCreateFromOptions - from -grid_n, -grid_size, -grid_center. `n`, `width` and `center` are what counts without
  them, become those of the grid, and the first two are required where they are 0. `row`: one row of cells, 1 m wide.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamGridCreateFromOptions(const SamOptions *from, PetscBool row, PetscInt n[2],
                                                     PetscReal width[2], PetscReal center[2], SamGrid *grid);
PETSC_INTERN PetscErrorCode SamGridReference(SamGrid grid);
PETSC_EXTERN PetscErrorCode SamGridDestroy(SamGrid *grid);
/* SamGridCoarsen - the same rectangle with half the cells in each direction, rounded up. Collective. */
PETSC_INTERN PetscErrorCode SamGridCoarsen(SamGrid fine, SamGrid *coarse);

/*
  SamGridCreateVec - a field with `components` values a cell. On each rank the local part holds one component after
  the other, each as (rows, nx). It is zero, and takes memory only as it is written to: a field that stays zero, as the
  shear without friction, costs nothing. Collective.
*/
PETSC_EXTERN PetscErrorCode SamGridCreateVec(SamGrid grid, PetscInt components, Vec *field);
/*
  SamGridCheckVec - raises PETSC_ERR_ARG_SIZ, on all ranks, unless the vector has the layout of a field of this grid
  with `components` values a cell; `words` says what it is. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridCheckVec(SamGrid grid, PetscInt components, Vec field, const char words[]);
/* SamGridIsFinite - whether all values of a field are finite numbers. Collective. */
PETSC_INTERN PetscErrorCode SamGridIsFinite(SamGrid grid, Vec field, PetscBool *is);
/* SamVecZero - sets a field to zero without writing to what is. Collective. */
PETSC_INTERN PetscErrorCode SamVecZero(Vec field);
/* SamVecCopyNonzero - copies a field; does not write where both are zero, so that untouched pages take no memory. */
PETSC_INTERN PetscErrorCode SamVecCopyNonzero(Vec from, Vec to);
/*
  SamGridNorm - NORM_1 or NORM_2 of a field of one or two components, as VecNorm() has it, but to the last bit the same
  on any number of ranks. Collective.
*/
PETSC_EXTERN PetscErrorCode SamGridNorm(SamGrid grid, Vec field, NormType type, PetscReal *norm);

/* SamGridChecksum - a checksum of a field's values by cell, the same on any number of ranks. Collective. */
PETSC_INTERN PetscErrorCode SamGridChecksum(SamGrid grid, Vec field, uint64_t *checksum);

/*
  SamGridMove - moves the grid by `distance` (m) over a field, which moves against it: at x it becomes what it was at
  x + distance. Whole cells, within 1e-6 of one, without error, else by cubic interpolation. What enters is 0, or, with
  `continues`, what was at the grid's border. Collective.
  SamGridEntering - the columns and rows that are made of what enters, at the low and the high end of x, y. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamGridMove(SamGrid grid, PetscInt components, const PetscReal distance[2],
                                        PetscBool continues, Vec from, Vec to);
PETSC_INTERN void SamGridEntering(SamGrid grid, const PetscReal distance[2], PetscInt low[2], PetscInt high[2]);

/* Coordinates of the centre of column i and of row j (both global), m. */
static inline PetscReal SamGridX(SamGrid grid, PetscInt i)
{
  return grid->center[0] + ((PetscReal)i + 0.5 - 0.5 * (PetscReal)grid->nx) * grid->dx;
}
static inline PetscReal SamGridY(SamGrid grid, PetscInt j)
{
  return grid->center[1] + ((PetscReal)j + 0.5 - 0.5 * (PetscReal)grid->ny) * grid->dy;
}

/*
  SamTransfer - moves fields between two grids of the same rectangle: Restrict takes area averages (keeps sums times
  cell area exactly), Prolong interpolates linearly between cell centres (constant beyond the outermost centres).
*/
typedef struct _n_SamTransfer *SamTransfer;
PETSC_INTERN PetscErrorCode    SamTransferCreate(SamGrid fine, SamGrid coarse, SamTransfer *transfer);
PETSC_INTERN PetscErrorCode    SamTransferDestroy(SamTransfer *transfer);
/* Both take fields of any, but the same, number of components. Collective. */
PETSC_INTERN PetscErrorCode SamTransferRestrict(SamTransfer transfer, Vec fine, Vec coarse);
PETSC_INTERN PetscErrorCode SamTransferProlong(SamTransfer transfer, Vec coarse, Vec fine);

/*
  SamWindow - a rectangle of cells of a grid as a grid of its own, with its own slabs on all ranks.
*/
typedef struct _n_SamWindow *SamWindow;
/* SamWindowCreate - the n[0] * n[1] cells from column first[0] and row first[1] on; n >= 2, or one row. Collective. */
PETSC_INTERN PetscErrorCode SamWindowCreate(SamGrid grid, const PetscInt first[2], const PetscInt n[2],
                                            SamWindow *window);
PETSC_INTERN PetscErrorCode SamWindowDestroy(SamWindow *window);
PETSC_INTERN PetscErrorCode SamWindowGetGrid(SamWindow window, SamGrid *grid); /* borrowed */
/* SamWindowGetPlace - first column and row, and their numbers. Not collective. */
PETSC_INTERN PetscErrorCode SamWindowGetPlace(SamWindow window, PetscInt first[2], PetscInt n[2]);
/* SamWindowCovers - whether all those cells lie in the window. Not collective. */
PETSC_INTERN PetscBool SamWindowCovers(SamWindow window, const PetscInt first[2], const PetscInt n[2]);
/* SamWindowTake, SamWindowPut - copy the window's part of a field out, or back in (zero elsewhere). Collective. */
PETSC_INTERN PetscErrorCode SamWindowTake(SamWindow window, Vec whole, Vec part);
PETSC_INTERN PetscErrorCode SamWindowPut(SamWindow window, Vec part, Vec whole);
/*
  SamGridGetSupport - the smallest rectangle that holds all cells where the first component of a field is positive; n is
  0 when there is none. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridGetSupport(SamGrid grid, Vec field, PetscInt first[2], PetscInt n[2]);
/*
  SamGridCountZones - the number of zones of cells, connected by their sides, where the first component of a field is
  positive; with `wrap` the cells at opposite borders of the grid are neighbours. The same on any number of ranks.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamGridCountZones(SamGrid grid, Vec field, PetscBool wrap, PetscInt *zones);
/*
  SamGridMeasureZones - how many cells across the narrow ones of these zones are, without `wrap`. Zones in which no more
  than `part` of all these cells lie, the narrowest ones, do not count. A zone is as wide as the shorter side of its
  bounding box, or as the ellipse of its second moments, if that is narrower; to a tenth of a cell. One that extends
  from border to border along one axis only has no width along it. 0 without such cells. The same on any number of
  ranks. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridMeasureZones(SamGrid grid, Vec field, PetscReal part, PetscReal *across);

#endif

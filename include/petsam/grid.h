/* The grid of rectangular cells, the distribution of its rows over the ranks, and its fields. */
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
                             /* in plane strain (one row) these members ignore y, along which fields do not vary: */
  PetscInt  axes;            /* 2: x and y; 1: x */
  PetscInt  fewest;          /* smallest number of cells along an axis */
  PetscReal side[2];         /* the shorter and the longer side of a cell (m) */
  PetscReal area[2]; /* sides in x, y of the area that a traction acts on (m); infinite along y in plane strain */
  PetscReal length;  /* half the larger width (m), which makes coordinates dimensionless */
  PetscBool coarse;  /* true: made by SamGridCoarsen(), with half the cells of another grid */
  PetscInt  references;
};

/*
  SamGridCreate - creates a grid of n[0] * n[1] cells of full width `width` about `center` (m). Collective. The grid and
  all objects on it use a communicator of the library, PETSc's duplicate of `comm`, so that their messages never meet
  those of the caller.
  Errors: PETSC_ERR_ARG_OUTOFRANGE if n[0] < 2 or n[1] < 1, a width is not positive and finite, or the number of cells
  overflows a PetscInt.
*/
PETSC_EXTERN PetscErrorCode SamGridCreate(MPI_Comm comm, const PetscInt n[2], const PetscReal width[2],
                                          const PetscReal center[2], SamGrid *grid);
/*
  SamGridCreateFromOptions - creates a grid from -grid_n, -grid_size, -grid_center. On entry `n`, `width` and `center`
  are the defaults; -grid_n and -grid_size are required if their default is 0. On return they are those of the grid.
  `row`: one row of cells, 1 m wide. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamGridCreateFromOptions(const SamOptions *from, PetscBool row, PetscInt n[2],
                                                     PetscReal width[2], PetscReal center[2], SamGrid *grid);
PETSC_EXTERN PetscErrorCode SamGridDestroy(SamGrid *grid);

/*
  SamGridCreateVec - creates a field with `components` values per cell. On each rank the local part holds one component
  after the other, each as (rows, nx). It is zero, and takes memory only where it is written to, so that a field that
  stays zero, as the shear without friction, costs nothing. Collective.
*/
PETSC_EXTERN PetscErrorCode SamGridCreateVec(SamGrid grid, PetscInt components, Vec *field);
/*
  SamGridNorm - computes the NORM_1 or NORM_2 of a field of one or two components, as VecNorm() does, but with a result
  that is the same to the last bit on any number of ranks. Collective.
*/
PETSC_EXTERN PetscErrorCode SamGridNorm(SamGrid grid, Vec field, NormType type, PetscReal *norm);

/* SamGridIsRow - returns true in plane strain, where fields do not vary along y. Not collective. */
static inline PetscBool SamGridIsRow(SamGrid grid)
{
  return grid->axes == 1 ? PETSC_TRUE : PETSC_FALSE;
}

/* SamGridX, SamGridY - return the coordinate of the centre of column i and of row j (both global), m. */
static inline PetscReal SamGridX(SamGrid grid, PetscInt i)
{
  return grid->center[0] + ((PetscReal)i + 0.5 - 0.5 * (PetscReal)grid->nx) * grid->dx;
}
static inline PetscReal SamGridY(SamGrid grid, PetscInt j)
{
  return grid->center[1] + ((PetscReal)j + 0.5 - 0.5 * (PetscReal)grid->ny) * grid->dy;
}

#endif

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
  int       class_id;        /* identifies grids; the library checks it in its arguments */
  MPI_Comm  comm;            /* the library's own communicator */
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
  SamGrid   fine;    /* grid from which SamGridCoarsen() made this one, with half its cells; owned; NULL: none */
  PetscInt  references;
};

/*
  SamGridCreate - creates a grid of rectangular cells.

  Collective.

  In:     comm   - communicator whose ranks share the rows of the grid
          n      - numbers of cells in x and y
          width  - full widths in x and y (m)
          center - centre in x and y (m)
  Out:    grid   - the grid

  Errors: PETSC_ERR_ARG_OUTOFRANGE if n[0] < 2 or n[1] < 1, a width is not positive and finite, or the number of cells
  overflows a PetscInt.

  The grid and all objects on it use a communicator of the library, PETSc's duplicate of `comm`, so that their messages
  never meet those of the caller.

  See also: SamGridDestroy(), SamGridCreateVec(), SamElasticityCreate().
*/
PETSC_EXTERN PetscErrorCode SamGridCreate(MPI_Comm comm, const PetscInt n[2], const PetscReal width[2],
                                          const PetscReal center[2], SamGrid *grid);

/*
  SamGridDestroy - drops a reference of the grid, the last one frees it; sets the handle to NULL.

  Collective.

  In,out: grid - the grid; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamGridDestroy(SamGrid *grid);

/*
  SamGridCreateVec - creates a field of zeros.

  Collective.

  In:     grid       - the grid
          components - number of values per cell
  Out:    field      - the field (any unit); VecDestroy() frees it

  Errors: none of its own.

  On each rank the local part holds one component after the other, each as (rows, nx). Only written parts of the field
  take memory, so that a field that stays zero, such as the shear without friction, costs nothing.

  See also: SamGridNorm(), SamGridX(), SamGapFill().
*/
PETSC_EXTERN PetscErrorCode SamGridCreateVec(SamGrid grid, PetscInt components, Vec *field);

/*
  SamGridNorm - computes the 1-norm or the 2-norm of a field, as VecNorm() does.

  Collective.

  In:     grid  - the grid
          field - field of one or two components (any unit)
          type  - NORM_1 or NORM_2
  Out:    norm  - the norm (unit of the field)

  Errors: PETSC_ERR_SUP for another type of norm.

  Unlike that of VecNorm(), the result is the same to the last bit on any number of ranks.
*/
PETSC_EXTERN PetscErrorCode SamGridNorm(SamGrid grid, Vec field, NormType type, PetscReal *norm);

/*
  SamGridIsRow - returns true in plane strain, where fields do not vary along y.

  Not collective.

  In:     grid - the grid

  Errors: none; it returns no error code.
*/
static inline PetscBool SamGridIsRow(SamGrid grid)
{
  return grid->axes == 1 ? PETSC_TRUE : PETSC_FALSE;
}

/*
  SamGridX - returns the x coordinate of the centre of a column of cells (m).

  Not collective.

  In:     grid - the grid
          i    - index of the column in the whole grid

  Errors: none; it returns no error code.

  See also: SamGridY().
*/
static inline PetscReal SamGridX(SamGrid grid, PetscInt i)
{
  return grid->center[0] + ((PetscReal)i + 0.5 - 0.5 * (PetscReal)grid->nx) * grid->dx;
}

/*
  SamGridY - returns the y coordinate of the centre of a row of cells (m).

  Not collective.

  In:     grid - the grid
          j    - index of the row in the whole grid

  Errors: none; it returns no error code.

  See also: SamGridX().
*/
static inline PetscReal SamGridY(SamGrid grid, PetscInt j)
{
  return grid->center[1] + ((PetscReal)j + 0.5 - 0.5 * (PetscReal)grid->ny) * grid->dy;
}

#endif

/* Functions of grids, besides petsam/grid.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_GRID_H
#define PETSAM_PRIVATE_GRID_H

#include <petsam/grid.h>

PETSC_INTERN PetscErrorCode SamGridReference(SamGrid grid);
/*
  SamGridCoarsen - creates a grid of the same rectangle with half the cells in each direction, rounded up. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridCoarsen(SamGrid fine, SamGrid *coarse);
/*
  SamGridCheckVec - raises PETSC_ERR_ARG_SIZ, on all ranks, unless the vector has the layout of a field of this grid
  with `components` values per cell; `words` describes the vector in the message. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridCheckVec(SamGrid grid, PetscInt components, Vec field, const char words[]);
/* SamGridIsFinite - sets `is` to true if all values of a field are finite. Collective. */
PETSC_INTERN PetscErrorCode SamGridIsFinite(SamGrid grid, Vec field, PetscBool *is);
/*
  SamVecOwn - gives data to a field under a name; when the field is destroyed, free(data) is called.
  SamVecGetOwned - gets them, or NULL; they stay the field's. Not collective.
*/
PETSC_INTERN PetscErrorCode SamVecOwn(Vec field, const char name[], void *data, PetscErrorCode (*free)(void *data));
PETSC_INTERN PetscErrorCode SamVecGetOwned(Vec field, const char name[], void **data);
/* SamVecZero - sets a field to zero; it does not write where the field is already zero. Collective. */
PETSC_INTERN PetscErrorCode SamVecZero(Vec field);
/* SamVecCopyNonzero - copies a field; does not write where both are zero, so that untouched pages take no memory. */
PETSC_INTERN PetscErrorCode SamVecCopyNonzero(Vec from, Vec to);
/* SamGridChecksum - computes a checksum of a field's values by cell, the same on any number of ranks. Collective. */
PETSC_INTERN PetscErrorCode SamGridChecksum(SamGrid grid, Vec field, uint64_t *checksum);
/*
  SamGridMove - moves the grid by `distance` (m) over a field: the new value at x is the old one at x + distance. Moves
  by whole cells, within 1e-6 of a cell, are without error; others interpolate with cubics. Values that enter are 0,
  those at the grid's border, or, on a grid that is one period, those that leave at the opposite border. For 0 and for a
  period the move by -distance is the transpose, up to rounding. Collective.
*/
typedef enum { SAM_BORDER_ZERO, SAM_BORDER_CONTINUES, SAM_BORDER_WRAPS } SamBorder;
PETSC_INTERN PetscErrorCode SamGridMove(SamGrid grid, PetscInt components, const PetscReal distance[2],
                                        SamBorder border, Vec from, Vec to);
/*
  SamGridEntering - computes the numbers of columns and rows that depend on values that enter, at the low and the high
  end of x, y. Not collective.
*/
PETSC_INTERN void SamGridEntering(SamGrid grid, const PetscReal distance[2], PetscInt low[2], PetscInt high[2]);
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
PETSC_INTERN SamGrid         SamWindowGetGrid(SamWindow window); /* borrowed */
/*
  SamWindowCreate - creates the window of the n[0] * n[1] cells from column first[0] and row first[1] on; n >= 2, or one
  row. Collective.
*/
PETSC_INTERN PetscErrorCode SamWindowCreate(SamGrid grid, const PetscInt first[2], const PetscInt n[2],
                                            SamWindow *window);
PETSC_INTERN PetscErrorCode SamWindowDestroy(SamWindow *window);
/* SamWindowGetPlace - gets the first column and row of a window, and their numbers. Not collective. */
PETSC_INTERN PetscErrorCode SamWindowGetPlace(SamWindow window, PetscInt first[2], PetscInt n[2]);
/* SamWindowCovers - returns true if the n[0] * n[1] cells from `first` on all lie in the window. Not collective. */
PETSC_INTERN PetscBool SamWindowCovers(SamWindow window, const PetscInt first[2], const PetscInt n[2]);
/* SamWindowTake, SamWindowPut - copy the window's part of a field out, or back in (zero elsewhere). Collective. */
PETSC_INTERN PetscErrorCode SamWindowTake(SamWindow window, Vec whole, Vec part);
PETSC_INTERN PetscErrorCode SamWindowPut(SamWindow window, Vec part, Vec whole);
/*
  SamGridGetSupport - finds the smallest rectangle that contains all cells where the first component of a field is
  positive; n is 0 if there are none. With `wrap` it may lie across opposite borders of the grid; the sum of `first` and
  n then exceeds the number of columns or rows. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridGetSupport(SamGrid grid, Vec field, PetscBool wrap, PetscInt first[2],
                                              PetscInt n[2]);
/*
  SamGridFindPeak - finds the column and row of the maximum of a field, of several the first one; `most`: its value, 0
  if none is positive. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridFindPeak(SamGrid grid, Vec field, PetscInt at[2], double *most);
/*
  SamGridCountZones - counts the zones of cells, connected by their sides, where the first component of a field is
  positive; with `wrap` the cells at opposite borders of the grid are neighbours. The same on any number of ranks.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamGridCountZones(SamGrid grid, Vec field, PetscBool wrap, PetscInt *zones);
/*
  SamGridMeasureZones - measures the width in cells of the narrow ones of these zones. The narrowest zones that together
  contain at most `part` of all these cells do not count. The width of a zone is the shorter side of its bounding box,
  or the width of the ellipse of its second moments if that is smaller; to a tenth of a cell. A zone that extends from
  border to border along one axis only has no width along it. With `wrap` a zone may lie across opposite borders, if all
  cells of some column (of some row) are outside of the zones. 0 if there are no such cells. The same on any number of
  ranks. Collective.
*/
PETSC_INTERN PetscErrorCode SamGridMeasureZones(SamGrid grid, Vec field, PetscReal part, PetscBool wrap,
                                                PetscReal *across);

/*
  SamGridCreateFromOptions - creates a grid from -grid_n, -grid_size, -grid_center. On entry `n`, `width` and `center`
  are the defaults; -grid_n and -grid_size are required if their default is 0. On return they are those of the grid.
  `row`: one row of cells, 1 m wide. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamGridCreateFromOptions(const SamOptions *from, PetscBool row, PetscInt n[2],
                                                     PetscReal width[2], PetscReal center[2], SamGrid *grid);

/* SamGridRoundUp - returns the smallest number of cells from n on whose only prime factors are 2, 3 and 5, which
   transforms take well; from 1e9 on n itself. Not collective. */
PETSC_INTERN double SamGridRoundUp(double n);

/* SamGridDot - sums the products of two arrays of so many components over all cells, the same on any number of ranks.
   Collective. */
PETSC_EXTERN PetscErrorCode SamGridDot(SamGrid grid, PetscInt components, const double a[], const double b[],
                                       double *sum);

#endif

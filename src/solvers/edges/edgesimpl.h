/* The inside of edges: zones of cells with their distances from the edge, and fits of quadratic functions. */
#ifndef PETSAM_EDGESIMPL_H
#define PETSAM_EDGESIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/rows.h>
#include <petsam/private/edges.h>

/*
  SamZone - rows of a field about this rank's, and the zone of cells where it is positive. Distances are between
  centres, in cells, and known up to `reach`. For a cell of the zone, distance[] is the square of its distance to the
  nearest cell outside, or SAM_FAR; for a cell outside, it is minus the square of its distance to the nearest cell of
  the zone, or -SAM_FAR. Cells beyond the grid are neither in the zone nor outside; on a periodic grid, cells of the
  other side continue it.
*/
#define SAM_FAR 127
typedef struct {
  SamGrid      grid;
  PetscInt     first, count; /* rows of the window */
  PetscInt     left, width;  /* columns of the window */
  double      *w;
  signed char *distance;
  char        *bare; /* of each row: 1 if no cell of the zone is within reach of its cells */
} SamZone;
/*
  SamZoneCreate - creates a zone. `halo`: number of rows before and after this rank's rows in the window, and of columns
  on both sides if the grid is periodic; reach: at most 11 cells. Collective.
*/
PETSC_INTERN PetscErrorCode SamZoneCreate(SamGrid grid, PetscBool periodic, Vec field, PetscInt halo, PetscReal reach,
                                          SamZone *zone);
PETSC_INTERN PetscErrorCode SamZoneDestroy(SamZone *zone);

/* True if a cell is in the zone's window; SamZoneAt() returns its index there. */
static inline PetscBool SamZoneHas(const SamZone *z, PetscInt i, PetscInt j)
{
  return i >= z->left && i < z->left + z->width && j >= z->first && j < z->first + z->count;
}
static inline ptrdiff_t SamZoneAt(const SamZone *z, PetscInt i, PetscInt j)
{
  return (ptrdiff_t)(j - z->first) * z->width + i - z->left;
}

/* True if no cell of the zone is within reach of the cells of a row. */
static inline PetscBool SamZoneIsBare(const SamZone *z, PetscInt j)
{
  return (PetscBool)z->bare[j - z->first];
}

/* A quadratic function about a cell's centre, of the place in cells from it; its terms are 1, x, y, x^2, x y, y^2. */
enum { SAM_FIT_TERMS = 6 };
static inline double SamFitAt(const double fit[SAM_FIT_TERMS], double x, double y)
{
  return fit[0] + x * (fit[1] + x * fit[3] + y * fit[4]) + y * (fit[2] + y * fit[5]);
}

/*
  SamFitWindow - the cells that a fit uses: all within `half` cells in both directions, at most SAM_FIT_HALF, whose
  squared distance is at least `least`; and the sums over the parts of rows in the windows of columns, which the fits of
  all cells of a column share: those of the last `kept` rows that were used.
  SamFitWindowCreate - creates it for the fits in a zone, SamFitWindowDestroy() frees its arrays. Not collective.
*/
enum { SAM_FIT_HALF = 5, SAM_FIT_SUMS = 8 };
typedef struct {
  PetscInt row, count; /* number of the row in the grid; cells that take part */
  double   sums[SAM_FIT_SUMS], squares;
} SamFitRow;
typedef struct {
  PetscInt   half;
  int        least;
  double     terms[2 * SAM_FIT_HALF + 1][SAM_FIT_SUMS]; /* of each column: 1, x, x^2, x^3, x^4 and 1, x, x^2 */
  PetscInt   kept;
  SamFitRow *rows; /* [column of the zone's window][row modulo `kept`] */
} SamFitWindow;
PETSC_INTERN PetscErrorCode SamFitWindowCreate(const SamZone *zone, PetscInt half, int least, SamFitWindow *window);
PETSC_INTERN PetscErrorCode SamFitWindowDestroy(SamFitWindow *window);
#define SAM_FIT_LEAST      9 /* least number of cells of a fit */
#define SAM_FIT_LEAST_LINE 3 /* the same on a grid of one row */
/*
  SamFit - finds the function nearest to the zone's field in the window about a cell. `bent`: rms deviation of the field
  from the function. Returns false if there are too few cells, or if the fit is singular. Not collective.
*/
PETSC_INTERN PetscBool SamFit(const SamZone *zone, SamFitWindow *window, PetscInt i, PetscInt j,
                              double fit[SAM_FIT_TERMS], double *bent);
/* SamFitPart - returns the part of a cell where its function is positive. */
PETSC_INTERN double SamFitPart(const double fit[SAM_FIT_TERMS]);
/*
  SamFitReach - returns how far a cell's function is positive towards a side, in cells from its centre, at most to
  `farthest`; -INFINITY: nowhere in the cell. Sides in the order x, -x, y, -y.
*/
enum { SAM_FIT_SIDES = 4 };
PETSC_INTERN double SamFitReach(const double fit[SAM_FIT_TERMS], int side, double farthest);

#endif

/* The inside of edges: zones of cells with their distances from the edge, and fits of quadratic functions. */
#ifndef PETSAM_EDGESIMPL_H
#define PETSAM_EDGESIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/rows.h>
#include <petsam/edges.h>

/*
  SamZone - rows of a field about this rank's, and the zone of cells where it is positive. Distances are between
  centres, in cells, and known where they are at most `reach`: distance[] holds their squares, of cells of the zone to
  the nearest cell outside, of cells outside minus those to the nearest cell of the zone; else SAM_FAR or -SAM_FAR.
  Cells beyond the grid are neither.
*/
#define SAM_FAR 127
typedef struct {
  SamGrid       grid;
  PetscInt      first, count; /* rows that are seen */
  Vec           field;
  const double *own, *w; /* the field's rows on this rank, and those that are seen */
  signed char  *distance;
  SamRows       rows;
} SamZone;
/* SamZoneCreate - `halo`: rows that are seen before and after this rank's; reach: at most 11 cells. Collective. */
PETSC_INTERN PetscErrorCode SamZoneCreate(SamGrid grid, Vec field, PetscInt halo, PetscReal reach, SamZone *zone);
PETSC_INTERN PetscErrorCode SamZoneDestroy(SamZone *zone);

/* Whether a cell is seen, and its place among those that are. */
static inline PetscBool SamZoneHas(const SamZone *z, PetscInt i, PetscInt j)
{
  return i >= 0 && i < z->grid->nx && j >= z->first && j < z->first + z->count;
}
static inline ptrdiff_t SamZoneAt(const SamZone *z, PetscInt i, PetscInt j)
{
  return (ptrdiff_t)(j - z->first) * z->grid->nx + i;
}

/* A quadratic function about a cell's centre: the terms 1, x, y, x^2, x y, y^2 of places in cells from it. */
enum { SAM_FIT_TERMS = 6 };
static inline double SamFitAt(const double fit[SAM_FIT_TERMS], double x, double y)
{
  return fit[0] + x * (fit[1] + x * fit[3] + y * fit[4]) + y * (fit[2] + y * fit[5]);
}

/*
  SamFitWindow - which cells a fit goes by, and their weights: those within `half` cells in both directions, at most
  SAM_FIT_HALF, whose squared distance is at least `least`. `bell`: standard deviation of the weights, cells; 0: all
  are 1.
*/
enum { SAM_FIT_HALF = 5, SAM_FIT_CELLS = (2 * SAM_FIT_HALF + 1) * (2 * SAM_FIT_HALF + 1), SAM_FIT_PRODUCTS = 21 };
typedef struct {
  PetscInt half;
  int      least;
  double   terms[SAM_FIT_CELLS][SAM_FIT_TERMS], products[SAM_FIT_CELLS][SAM_FIT_PRODUCTS];
} SamFitWindow;
PETSC_INTERN void SamFitWindowInitialize(PetscInt half, int least, double bell, SamFitWindow *window);
#define SAM_FIT_LEAST      9 /* fewest cells of a fit, */
#define SAM_FIT_LEAST_LINE 3 /* and on a grid of one row */
/*
  SamFitFactor - what the fits in the window about a cell have in common, whatever the values. False: there are too few
  cells, or the fit is singular. Not collective.
  SamFit - the function nearest to the values (of all cells that are seen). `bent` (NULL: not wanted): how far they are
  from it, rms. Not collective.
*/
PETSC_INTERN PetscBool SamFitFactor(const SamZone *zone, const SamFitWindow *window, PetscInt i, PetscInt j,
                                    double factor[SAM_FIT_PRODUCTS]);
PETSC_INTERN void      SamFit(const SamZone *zone, const SamFitWindow *window, const double factor[SAM_FIT_PRODUCTS],
                              const double values[], PetscInt i, PetscInt j, double fit[SAM_FIT_TERMS], double *bent);
/* SamFitPart - the part of a cell where its function is positive. */
PETSC_INTERN double SamFitPart(const double fit[SAM_FIT_TERMS]);

/*
  SamRoots - roots of functions over a cell, sqrt(max(w, 0)), in sub-cells row by row (roots.c). Not collective.
  SamRootsInitialize - `sub`: the number of sub-cells in each direction, odd, so that the centre is that of one.
  SamRootsMean - the means over the sub-cells; returns that over the cell. `slope` (NULL: not wanted): its derivative by
  the function's constant.
  SamRootsMatch - changes the function's constant so that its root has the mean (> 0) over the cell: by Newton's method,
  or halving where that leads off.
  SamRootsTakeLinearPart - subtracts from the sub-cells' means the mean and the linear part, whose slopes are over the
  width of the cell.
*/
enum { SAM_ROOTS_SUB = 17, SAM_ROOTS_COARSE = 5, SAM_ROOTS_CELLS = SAM_ROOTS_SUB * SAM_ROOTS_SUB }; /* the most */
typedef struct {
  int    sub, cells;
  double x[SAM_ROOTS_CELLS], y[SAM_ROOTS_CELLS]; /* of the sub-cells, in cells from the centre */
  double square;                                 /* sum of x^2 */
} SamRoots;
PETSC_INTERN void   SamRootsInitialize(int sub, SamRoots *roots);
PETSC_INTERN double SamRootsMean(const SamRoots *roots, const double fit[SAM_FIT_TERMS], double means[], double *slope);
PETSC_INTERN void   SamRootsMatch(const SamRoots *roots, double mean, double fit[SAM_FIT_TERMS]);
PETSC_INTERN void   SamRootsTakeLinearPart(const SamRoots *roots, double mean, double means[], double slopes[2]);

/*
  SamNear - tractions in the sub-cells of a cell, and what they displace: the cells within SAM_NEAR of it in both
  directions. A cell that an edge cuts or nearly cuts has fine sub-cells, others coarse ones (near.c).
  SamNearInitialize - borrows the elasticity. Not collective.
  SamNearSetUp - makes the tables, at the first call. Collective.
  SamNearAdd - adds to u_z (this rank's cells) what a cell's sub-cells displace. Not collective.
*/
enum { SAM_NEAR = 3 };
typedef enum { SAM_NEAR_FINE, SAM_NEAR_COARSE } SamNearSub;
typedef struct {
  SamElasticity elasticity;
  SamRoots      roots[2];
  double       *table[2];
} SamNear;
typedef struct {
  PetscInt      i, j; /* the cell */
  const double *traction;
} SamNearPart;
PETSC_INTERN void           SamNearInitialize(SamElasticity elasticity, SamNear *near);
PETSC_INTERN PetscErrorCode SamNearSetUp(SamNear *near);
PETSC_INTERN PetscErrorCode SamNearDestroy(SamNear *near);
PETSC_INTERN void SamNearAdd(const SamNear *near, SamNearSub sub, SamGrid grid, const SamNearPart *part, double u[]);

#define SAM_EDGE_LAST   6 /* largest squared distance of cells that the layer of an edge makes wrong */
#define SAM_EDGE_WINDOW 5 /* half width of the window that they are reconstructed from, cells */
/*
  SamEdgeExtrapolate - the function about a cell by the zone's cells behind that layer; false: too few. The window is of
  that half width, and begins behind the layer. Not collective.
*/
PETSC_INTERN PetscBool SamEdgeExtrapolate(const SamZone *zone, const SamFitWindow *core, PetscInt i, PetscInt j,
                                          double fit[SAM_FIT_TERMS], double *bent);
/* SamEdgeAddPoint - adds the place on the edge nearest to the centre of a cell of this rank, if it is in the cell. */
PETSC_INTERN void SamEdgeAddPoint(SamGrid grid, const double fit[SAM_FIT_TERMS], PetscInt i, PetscInt j, SamEdge *edge);

/*
  SamProfile - what a traction does within the cells of its zone, when it vanishes at the zone's edge like the root of
  the distance: in a band along the edge it is sqrt(max(w, 0)) with a quadratic function w in each cell, elsewhere it is
  linear. A cell belongs to the zone if its centre does; cells outside that the edge cuts, the rim, bear traction too.
*/
typedef struct _n_SamProfile *SamProfile;
/* SamProfileCreate - references the elasticity. SamProfileDestroy - sets the handle to NULL. Collective. */
PETSC_INTERN PetscErrorCode SamProfileCreate(SamElasticity elasticity, SamProfile *profile);
PETSC_INTERN PetscErrorCode SamProfileDestroy(SamProfile *profile);
/*
  SamProfileStart - the first guess: the zone is where `mean` (one component, Pa, >= 0) is positive, its edge is
  reconstructed, and there is no rim. `edge` returns the areas and shares of that, without points. Collective.
  SamProfileMatch - finds the functions whose means over the cells are those given. The zone is where they exceed `rim`,
  the means of the rim's cells. Collective.
  SamProfileMove - moves the zone to the edge that was found last; the rim gets its means. Collective.
  `found`: each cell of the band has a function; without, the profile is of no use.
*/
PETSC_INTERN PetscErrorCode SamProfileStart(SamProfile profile, Vec mean, SamEdge *edge, PetscBool *found);
PETSC_INTERN PetscErrorCode SamProfileMatch(SamProfile profile, Vec mean, Vec rim, PetscBool *found);
PETSC_INTERN PetscErrorCode SamProfileMove(SamProfile profile, PetscBool *found);
/*
  What has been found, in fields of one component. Collective.
  SamProfileGetZone - 1 in cells of the zone, else 0; and the means of the rim's cells (Pa), else 0. Borrowed.
  SamProfileComputeDisplacement - the normal displacement (m) by what a pressure of this profile does within the cells:
  what the influence of the cells' means lacks. For an elasticity whose traits say `within`.
  SamProfileComputeSlopes - by how much the pressure grows from one side of a cell to the other, along x and along y
  (two components, Pa).
  SamProfileGetEdge - the edge, with its points; its share is 1. `point` (NULL: not wanted): the traction's square at
  the cells' centres (Pa2).
*/
PETSC_INTERN PetscErrorCode SamProfileGetZone(SamProfile profile, Vec *zone, Vec *rim);
PETSC_INTERN PetscErrorCode SamProfileComputeDisplacement(SamProfile profile, Vec u_z);
PETSC_INTERN PetscErrorCode SamProfileComputeSlopes(SamProfile profile, Vec slopes);
PETSC_INTERN PetscErrorCode SamProfileGetEdge(SamProfile profile, Vec point, SamEdge *edge);

#endif

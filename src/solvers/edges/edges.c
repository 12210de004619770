/*
  The edge of a zone of cells from the field behind it.

  At a straight edge the discrete problem is a Toeplitz system on a half-line. By Wiener and Hopf's method every
  solution that grows like a root is, far from the edge, alpha (sqrt(j + s) + kappa(s) j^-3/2 + ...) in cell j: its edge
  lies between the cells, at -s. Only a margin of two cells has an error of first order. So:
    1. Core: cells of the zone farther than BAND from any cell outside. A quadratic function is fitted to w in the core
       cells of a window about each cell of the band, and evaluated there.
    2. The tail of the margin makes the core's edge lie too far out, by SHIFT of a cell in the mean over all places of
       an edge between centres. In plane strain there is only one place of the edge, and the shift depends on it
       (Line()).
    3. Guard: the difference from w must have the shape of the margin, which is the same for all smooth edges.
    4. Areas: the part of each cell of the band where the function is positive, by sub-cells. Where the guard rejects
       the reconstruction, the whole cell counts, minus SAM_EDGE_FACE for each of its faces to a cell outside, unless w
       is BLUNT there.
    5. Extents: the edge lies between the centres of the outermost cell of the zone and of the next one, where the
       function of the outermost cell that is accepted vanishes. If it does not there, the accepted parts decide, or the
       whole cells if they reach more than a cell beyond those: single cells are rejected at smooth edges, too.
  Distances are in cells.
*/
#include "edgesimpl.h"
#include <petsam/private/grid.h>
#include <math.h>

#define BAND   2.5    /* distance of the core from the cells outside */
#define LAST   6      /* largest squared distance of cells whose values are wrong because of the edge's margin */
#define WINDOW 5      /* half width in cells of the window from which they are reconstructed */
#define SHIFT  0.0105 /* of the edge; fitted on circles and ellipses, whose shifts agree within 5 % */
#define BENT   0.005  /* largest deviation of the core from the function, rms over the slope of a cell */
#define BLUNT  0.6  /* ratio of w in a cell at the edge to w in the cell behind it, if w does not vanish at the edge */
#define LOOSE  0.25 /* of a cell: by so much an edge may miss its place between the centres of two cells */
#define BEYOND 4    /* cells from its centre up to which a function tells an extent */
#define NEXT   (-2) /* a cell outside is beside the zone if its distance's square is at most 2 */
#define HALO   (WINDOW + 5)

/* Layers of the band by squared distance, and the least and largest (w minus its reconstruction)/slope in them */
static const int    margin_last[]  = {1, 4, LAST};
static const double margin_least[] = {-0.15, -0.03, -0.03}, margin_most[] = {0.20, 0.12, 0.06};

#define OUT_LEAST (-0.2) /* a reconstruction relative to the slope, of a cell of the zone */
#define IN_MOST   0.25   /* the same of a cell outside */

/* What is known of the reconstruction of a cell of the band by itself */
typedef enum { UNKNOWN, ROUGH, SMOOTH } Look;

/* How far the zone reaches from its middle to each side, in cells: by the parts of cells that are accepted; by whole
   cells; to the centre of its outermost cell; to that of the outermost one that is accepted; to where the function of
   this vanishes. */
typedef enum { ACCEPTED, WHOLE, LAST_CELL, OUTER, ONWARD, REACHES } Reaches;

/* The zone, and the reconstruction of the cells of its band and beside it, which are found when they are needed. */
typedef struct {
  SamZone      zone;
  SamFitWindow core;
  PetscInt    *slot;  /* of each cell: its place among the cells of the band, -1 for the others */
  PetscInt     band;  /* number of cells in the band */
  char        *look;  /* of each cell of the band: a Look */
  double      *fit;   /* of each cell of the band: its function, once it has a look */
  PetscInt middle[2]; /* cell from which extents count; the zone lies about it over the border of a periodic grid, */
  PetscInt period[2]; /* whose period this is, in cells, else 0 */
  PetscInt end[2][2]; /* first and last column, and row, from there */
  double   reach[REACHES][SAM_FIT_SIDES];
} Band;

/*
  The shift of the core's edge on a grid of one row, as a function of its place u beyond the last centre of the zone, in
  cells. It was fitted on Hertz's contact of 4600 cells at 64 places, within 7e-5; the edge of stick agrees within 2e-4.
  There is one function for cells of the zone, and one for the first cell outside, whose window has fewer cells.
*/
static double Line(const SamZone *z, PetscInt i, const double fit[SAM_FIT_TERMS])
{
  static const double shift[2][4] = {{0.019582, -0.18493, 0.28335, -0.040579},
                                     {0.021411, -0.17189, 0.25669, -0.035107}};
  const int           distance    = z->distance[SamZoneAt(z, i, 0)];
  const double       *c           = shift[distance > 0];
  const double        behind      = distance > 0 ? sqrt(distance) - 1 : -1;
  const double        u           = PetscClipInterval(fit[0] / fabs(fit[1]) - behind, -0.15, 0.9);

  return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

/* Fits the function about a cell to the zone's cells behind the margin of the edge; false: there are too few. */
static PetscBool Extrapolate(const SamZone *z, SamFitWindow *core, PetscInt i, PetscInt j, double fit[SAM_FIT_TERMS],
                             double *bent)
{
  if (!SamFit(z, core, i, j, fit, bent)) return PETSC_FALSE;
  fit[0] -= (SamGridIsRow(z->grid) ? Line(z, i, fit) : SHIFT) * hypot(fit[1], fit[2]);
  return PETSC_TRUE;
}

/* Reconstructs a cell of the band; w* becomes its constant term. Returns true if it looks like a smooth edge. */
static PetscBool Reconstruct(const SamZone *z, SamFitWindow *core, PetscInt i, PetscInt j, double fit[SAM_FIT_TERMS])
{
  const ptrdiff_t k      = SamZoneAt(z, i, j);
  double          bent   = 0, slope, over;
  int             margin = 0;

  if (!Extrapolate(z, core, i, j, fit, &bent)) return PETSC_FALSE;
  slope = hypot(fit[1], fit[2]);
  if (!(bent < BENT * slope)) return PETSC_FALSE;
  if (z->distance[k] < 0) return fit[0] < IN_MOST * slope;
  while (z->distance[k] > margin_last[margin]) margin++;
  over = (z->w[k] - fit[0]) / slope;
  return fit[0] > OUT_LEAST * slope && over >= margin_least[margin] && over <= margin_most[margin];
}

static Look LookAt(Band *band, PetscInt i, PetscInt j, PetscInt k)
{
  if (band->look[k] == UNKNOWN)
    band->look[k] =
      (char)(Reconstruct(&band->zone, &band->core, i, j, band->fit + SAM_FIT_TERMS * (ptrdiff_t)k) ? SMOOTH : ROUGH);
  return (Look)band->look[k];
}

/*
  True if a cell of the band and all its neighbours look like parts of a smooth edge. Those that are known come first;
  of the others the last one does, whose look also decides on the cells that follow: on rough surfaces one
  reconstruction decides on nine cells.
*/
static PetscBool IsSmoothAbout(Band *band, PetscInt i, PetscInt j)
{
  const SamZone *z = &band->zone;

  for (int pass = 0; pass < 2; pass++)
    for (PetscInt b = j + 1; b >= j - 1; b--)
      for (PetscInt a = i + 1; a >= i - 1; a--) {
        const PetscInt k = SamZoneHas(z, a, b) ? band->slot[SamZoneAt(z, a, b)] : -1;

        if (k >= 0 && (pass ? LookAt(band, a, b, k) : (Look)band->look[k]) == ROUGH) return PETSC_FALSE;
      }
  return PETSC_TRUE;
}

/* ---- the sums ---- */

enum { AREA, FACES, GOOD, CELLS, SUMS };

/* Adds the point of the edge nearest to the centre of a cell of this rank if the point is in the cell. */
static void AddPoint(SamGrid grid, const double fit[SAM_FIT_TERMS], PetscInt i, PetscInt j, SamEdge *edge)
{
  const double square = fit[1] * fit[1] + fit[2] * fit[2], x = -fit[0] * fit[1] / square, y = -fit[0] * fit[2] / square;
  const PetscInt n = edge->count;

  if (!(fabs(x) <= 0.5 && fabs(y) <= 0.5)) return;
  edge->x[n]    = SamGridX(grid, i) + x * grid->dx;
  edge->y[n]    = SamGridY(grid, j) + y * grid->dy;
  edge->cell[n] = (j - grid->row_start) * grid->nx + i;
  for (int k = 0; k < SAM_FIT_TERMS; k++) edge->fit[n][k] = fit[k];
  edge->count++;
}

/*
  True if w does not seem to vanish at a cell's edge, compared with its neighbour farthest from the cells outside, which
  must not lie at the edge itself. Worn surfaces have such edges; there the errors of counting cells cancel on average.
*/
static PetscBool IsBlunt(const SamZone *z, PetscInt i, PetscInt j)
{
  signed char farthest = 2;
  double      behind   = 0;

  for (PetscInt b = j - 1; b <= j + 1; b++)
    for (PetscInt a = i - 1; a <= i + 1; a++) {
      const ptrdiff_t k = SamZoneHas(z, a, b) ? SamZoneAt(z, a, b) : -1;

      if (k < 0 || z->distance[k] < farthest || (z->distance[k] == farthest && !(z->w[k] > behind))) continue;
      farthest = z->distance[k];
      behind   = z->w[k];
    }
  return farthest > 2 && z->w[SamZoneAt(z, i, j)] > BLUNT * behind;
}

/* Returns how far a cell is from the zone's middle along an axis; on a periodic grid on the nearer way. */
static double PlaceOf(const Band *band, int axis, PetscInt i)
{
  const PetscInt period = band->period[axis], place = i - band->middle[axis];

  return (double)(period ? (place + period + period / 2) % period - period / 2 : place);
}

/* Raises the extent to that of an accepted cell, whose centre is so far out, at a side. */
static void Accept(Band *band, int side, double from, PetscBool inside, const double fit[SAM_FIT_TERMS])
{
  double *const accepted = &band->reach[ACCEPTED][side], *const outer = &band->reach[OUTER][side],
                *const onward = &band->reach[ONWARD][side];

  if (from + 0.5 > *accepted) *accepted = PetscMax(*accepted, from + SamFitReach(fit, side, 0.5));
  if (!inside || from < *outer) return;
  if (from > *outer) *onward = -INFINITY;
  *outer  = from;
  *onward = PetscMax(*onward, from + SamFitReach(fit, side, BEYOND));
}

/* Raises the extent to that of a cell: by its function, or if that is NULL by its whole, less `face`, which is accepted
   or not. `inside`: it is in the zone. */
static void Reach(Band *band, PetscInt i, PetscInt j, PetscBool inside, const double *fit, Reaches by, double face)
{
  const double place[2] = {PlaceOf(band, 0, i), PlaceOf(band, 1, j)};

  for (int side = 0; side < SAM_FIT_SIDES; side++) {
    const double from = side % 2 ? -place[side / 2] : place[side / 2];

    if (inside) band->reach[LAST_CELL][side] = PetscMax(band->reach[LAST_CELL][side], from);
    if (fit)
      Accept(band, side, from, inside, fit);
    else
      band->reach[by][side] = PetscMax(band->reach[by][side], from + 0.5 - face);
  }
}

/* Adds a cell of the band to the sums and to the edge. */
static void AddCell(Band *band, PetscInt i, PetscInt j, double sums[SUMS], SamEdge *edge)
{
  static const PetscInt x[] = {1, -1, 0, 0}, y[] = {0, 0, 1, -1};

  const SamZone  *z      = &band->zone;
  const SamGrid   grid   = z->grid;
  const ptrdiff_t k      = SamZoneAt(z, i, j);
  const PetscBool inside = z->distance[k] > 0, good = IsSmoothAbout(band, i, j);
  const double   *fit   = good ? band->fit + SAM_FIT_TERMS * (ptrdiff_t)band->slot[k] : NULL;
  PetscInt        faces = 0;
  double          face;

  sums[CELLS] += inside ? 1 : 0;
  for (int n = 0; n < 4 && inside; n++)
    if (SamZoneHas(z, i + x[n], j + y[n]) && z->distance[SamZoneAt(z, i + x[n], j + y[n])] < 0) faces++;
  face = faces && !good && !IsBlunt(z, i, j) ? SAM_EDGE_FACE : 0;
  sums[FACES] += (double)faces;
  sums[GOOD] += good ? (double)faces : 0;
  sums[AREA] += good ? SamFitPart(fit) : inside ? 1 - face * (double)faces : 0;
  if (good || inside) Reach(band, i, j, inside, fit, WHOLE, face);
  if (!good) return;
  edge->corrected_cell[edge->corrected] = (j - grid->row_start) * grid->nx + i;
  edge->corrected_w[edge->corrected++]  = fit[0];
  AddPoint(grid, fit, i, j, edge);
}

/* Adds this rank's row j to the sums and to the edge. */
static void AddRow(Band *band, PetscInt j, double sums[SUMS], SamEdge *edge)
{
  const ptrdiff_t first = SamZoneAt(&band->zone, 0, j);
  const PetscBool ends  = j == band->end[1][0] || j == band->end[1][1] ? PETSC_TRUE : PETSC_FALSE;
  PetscInt        whole = 0; /* cells of the zone beyond the band */

  for (PetscInt i = 0; i < band->zone.grid->nx; i++)
    if (band->slot[first + i] >= 0) {
      AddCell(band, i, j, sums, edge);
    } else if (band->zone.distance[first + i] > 0) {
      whole++; /* only at an end of the grid can the zone end there */
      if (ends || i == band->end[0][0] || i == band->end[0][1]) Reach(band, i, j, PETSC_TRUE, NULL, ACCEPTED, 0);
    }
  sums[CELLS] += (double)whole;
  sums[AREA] += (double)whole;
}

/* Creates the arrays of an edge, or gives back what they have beyond their numbers of points and of cells. */
static PetscErrorCode Allocate(SamEdge *edge, PetscInt points, PetscInt corrected)
{
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(*edge->x) * (size_t)points, &edge->x));
  PetscCall(PetscRealloc(sizeof(*edge->y) * (size_t)points, &edge->y));
  PetscCall(PetscRealloc(sizeof(*edge->cell) * (size_t)points, &edge->cell));
  PetscCall(PetscRealloc(sizeof(*edge->fit) * (size_t)points, &edge->fit));
  PetscCall(PetscRealloc(sizeof(*edge->corrected_cell) * (size_t)corrected, &edge->corrected_cell));
  PetscCall(PetscRealloc(sizeof(*edge->corrected_w) * (size_t)corrected, &edge->corrected_w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeDestroy(SamEdge *edge)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(edge->x));
  PetscCall(PetscFree(edge->y));
  PetscCall(PetscFree(edge->cell));
  PetscCall(PetscFree(edge->fit));
  PetscCall(PetscFree(edge->corrected_cell));
  PetscCall(PetscFree(edge->corrected_w));
  edge->count = edge->corrected = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeCorrect(const SamEdge *edge, Vec w)
{
  double *values;

  PetscFunctionBegin;
  PetscCall(VecGetArray(w, &values));
  for (PetscInt k = 0; k < edge->corrected; k++) values[edge->corrected_cell[k]] = (double)edge->corrected_w[k];
  PetscCall(VecRestoreArray(w, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all cells ---- */

/* Finds the cells of the band in the rows that are needed: this rank's, and one on each side. */
static PetscErrorCode FindBand(Band *band)
{
  const SamZone  *z     = &band->zone;
  const ptrdiff_t cells = (ptrdiff_t)z->count * z->width;
  const PetscInt  begin = PetscMax(z->grid->row_start - 1, z->first),
                 end    = PetscMin(z->grid->row_start + z->grid->rows + 1, z->first + z->count);

  PetscFunctionBegin;
  PetscCall(SamFitWindowCreate(z, WINDOW, LAST + 1, &band->core));
  PetscCall(PetscMalloc1(cells, &band->slot));
  for (PetscInt j = z->first; j < z->first + z->count; j++) {
    const PetscBool without = j < begin || j >= end || SamZoneIsBare(z, j);

    for (ptrdiff_t k = SamZoneAt(z, z->left, j), last = k + z->width; k < last; k++)
      band->slot[k] = !without && z->distance[k] >= NEXT && z->distance[k] <= LAST ? band->band++ : -1;
  }
  PetscCall(PetscCalloc1(band->band, &band->look)); /* UNKNOWN */
  PetscCall(PetscMalloc1(SAM_FIT_TERMS * band->band, &band->fit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the cell from which extents count. Collective. */
static PetscErrorCode FindMiddle(Band *band, PetscBool periodic, Vec w)
{
  const SamGrid  grid     = band->zone.grid;
  const PetscInt count[2] = {grid->nx, grid->ny};
  PetscInt       first[2] = {0, 0}, n[2] = {0, 0};

  PetscFunctionBegin;
  if (periodic) PetscCall(SamGridGetSupport(grid, w, periodic, first, n));
  for (int k = 0; k < 2; k++) {
    band->middle[k] = first[k] + n[k] / 2;
    band->period[k] = periodic ? count[k] : 0;
    band->end[k][0] = periodic ? (band->middle[k] - count[k] / 2 + count[k]) % count[k] : 0;
    band->end[k][1] = (band->end[k][0] + count[k] - 1) % count[k];
  }
  for (int side = 0; side < SAM_FIT_SIDES; side++)
    for (int k = 0; k < REACHES; k++) band->reach[k][side] = -INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if an edge may lie there, between the centres of the last cell and of the next one. */
static PetscBool IsBeside(double last, double edge)
{
  return fabs(edge - (last + 0.5)) <= 0.5 + LOOSE;
}

/* Returns how far the zone reaches at a side. */
static double FarOf(const Band *band, int side)
{
  const double accepted = band->reach[ACCEPTED][side], whole = band->reach[WHOLE][side];
  const double onward = band->reach[ONWARD][side], last = band->reach[LAST_CELL][side];

  if (IsBeside(last, onward)) return onward;
  return PetscClipInterval(whole > accepted + 1 ? whole : accepted, last, last + 1);
}

/* Computes half of the zone's extents from its reach on all ranks. Collective. */
static PetscErrorCode FindExtent(Band *band, PetscReal half[2])
{
  const SamGrid   grid    = band->zone.grid;
  const PetscReal cell[2] = {grid->dx, grid->dy};
  double          outer[SAM_FIT_SIDES];

  PetscFunctionBegin;
  for (int side = 0; side < SAM_FIT_SIDES; side++) outer[side] = band->reach[OUTER][side];
  PetscCall(SamMax(grid->comm, ONWARD * SAM_FIT_SIDES, band->reach[0]));
  for (int side = 0; side < SAM_FIT_SIDES; side++)
    if (outer[side] < band->reach[OUTER][side]) band->reach[ONWARD][side] = -INFINITY;
  PetscCall(SamMax(grid->comm, SAM_FIT_SIDES, band->reach[ONWARD]));
  for (int k = 0; k < 2; k++) {
    const double extent = PetscMax(FarOf(band, 2 * k) + FarOf(band, 2 * k + 1), 0);

    half[k] = 0.5 * (PetscReal)PetscMin(extent, (double)(k ? grid->ny : grid->nx)) * cell[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Band *band)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(band->slot));
  PetscCall(PetscFree(band->look));
  PetscCall(PetscFree(band->fit));
  PetscCall(SamFitWindowDestroy(&band->core));
  PetscCall(SamZoneDestroy(&band->zone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeReconstruct(SamGrid grid, PetscBool periodic, Vec w, SamEdge *edge)
{
  SamTotal totals[SUMS] = {{0}};
  Band     band         = {.band = 0};
  double   sums[SUMS];

  PetscFunctionBegin;
  PetscCall(SamZoneCreate(grid, periodic, w, HALO, BAND, &band.zone));
  PetscCall(FindBand(&band));
  PetscCall(FindMiddle(&band, periodic, w));
  *edge = (SamEdge){.count = 0};
  PetscCall(Allocate(edge, band.band, band.band));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row[SUMS] = {0};

    if (SamZoneIsBare(&band.zone, grid->row_start + j)) continue;
    AddRow(&band, grid->row_start + j, row, edge);
    SamAddAll(SUMS, totals, row);
  }
  PetscCall(FindExtent(&band, edge->half));
  PetscCall(Destroy(&band));
  PetscCall(Allocate(edge, edge->count, edge->corrected));
  PetscCall(SamSumTotals(grid->comm, SUMS, totals, sums));
  edge->area  = sums[AREA] * grid->dx * grid->dy;
  edge->cells = (PetscInt)sums[CELLS];
  edge->faces = sums[FACES];
  edge->good  = sums[GOOD];
  PetscFunctionReturn(PETSC_SUCCESS);
}

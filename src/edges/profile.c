/*
  A traction within the cells along an edge, where it vanishes like the square root of the distance.

  Given are the means t_i over cells, and the cells whose centre lies in the zone. Wanted is in each cell of a band
  along the edge a quadratic function w, with t = sqrt(max(w, 0)) in the cell:
    1. Its shape is that of the function nearest to the w at the centres of the zone's cells about it, weighted by
       Gauss' bell; its constant makes the mean of t that of the cell.
    2. That changes the w at the centres, so it is done SWEEPS times.
    3. Cells outside near the edge take the function of the cells about them as it is. Those that have traction by it
       are the rim.
  Distances are in cells.
*/
#include "edgesimpl.h"
#include <math.h>

#define BAND   4.5  /* distance of the band's cells from the cells outside */
#define LAST   20   /* its square */
#define RIM    (-2) /* a cell outside with this distance's square or nearer may be cut by the edge */
#define BELL   1.5  /* standard deviation of the weights */
#define SWEEPS 3
#define JOIN   0.03 /* a centre changes sides when it lies this far beyond the edge */
/*
  A rim cell with a smaller mean, over the root of the slope, is left out: it counts for nothing, but the tangential
  problem takes three times as many iterations over cells of nearly no pressure.
*/
#define LEAST 1e-3
#define HALO  (SAM_NEAR + 6)

/*
  The edge may cut a cell, which has fine sub-cells then, unless its squared distance from the cells outside is this or
  more.
*/
#define UNCUT 4

struct _n_SamProfile {
  SamElasticity elasticity;
  SamGrid       grid; /* of it; borrowed */
  Vec           in;   /* 1 in cells of the zone, else 0 */
  Vec           rim;  /* means of the cells outside that the edge cuts */
  Vec           w;    /* at the cells' centres */
  Vec           mean; /* over the cells; borrowed */
  SamNear       near;
  SamFitWindow  window[2], core; /* of a cell in the zone, and outside; behind the layer that an edge makes wrong */
  /* the functions of the band's cells, of this rank's rows and SAM_NEAR more on both sides */
  SamZone   zone; /* by `in`; its grid is NULL before the first one */
  PetscInt  begin, end;
  PetscInt *slot, band;
  double   *fit, *factor;
  PetscBool found; /* all of this rank's cells have one */
};

/* ---- the object ---- */

PetscErrorCode SamProfileCreate(SamElasticity elasticity, SamProfile *profile)
{
  SamGrid    grid;
  SamProfile s;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  PetscCall(SamElasticityReference(elasticity));
  PetscCall(SamElasticityGetGrid(elasticity, &grid));
  s->elasticity = elasticity;
  s->grid       = grid;
  PetscCall(SamGridCreateVec(grid, 1, &s->in));
  PetscCall(SamGridCreateVec(grid, 1, &s->rim));
  PetscCall(SamGridCreateVec(grid, 1, &s->w));
  SamFitWindowInitialize(3, 1, BELL, &s->window[0]);
  SamFitWindowInitialize(4, 1, BELL, &s->window[1]);
  SamFitWindowInitialize(SAM_EDGE_WINDOW, SAM_EDGE_LAST + 1, 0, &s->core);
  SamNearInitialize(elasticity, &s->near);
  *profile = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ForgetZone(SamProfile s)
{
  PetscFunctionBegin;
  if (!s->zone.grid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(s->fit, s->factor));
  PetscCall(PetscFree(s->slot));
  PetscCall(SamZoneDestroy(&s->zone));
  s->zone.grid = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProfileDestroy(SamProfile *profile)
{
  SamProfile s = *profile;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForgetZone(s));
  PetscCall(VecDestroy(&s->in));
  PetscCall(VecDestroy(&s->rim));
  PetscCall(VecDestroy(&s->w));
  PetscCall(SamNearDestroy(&s->near));
  PetscCall(SamElasticityDestroy(&s->elasticity));
  PetscCall(PetscFree(*profile));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- functions ---- */

/* The function of a cell, NULL outside of the band. */
static double *FunctionOf(SamProfile s, ptrdiff_t k)
{
  return s->slot[k] < 0 ? NULL : s->fit + SAM_FIT_TERMS * (ptrdiff_t)s->slot[k];
}

/* The sub-cells of a cell of the band. */
static SamNearSub SubOf(SamProfile s, ptrdiff_t k)
{
  return s->zone.distance[k] >= UNCUT ? SAM_NEAR_COARSE : SAM_NEAR_FINE;
}
static const SamRoots *RootsOf(SamProfile s, ptrdiff_t k)
{
  return &s->near.roots[SubOf(s, k)];
}

/* The window of a cell of the band. */
static const SamFitWindow *WindowOf(SamProfile s, ptrdiff_t k)
{
  return &s->window[s->zone.distance[k] > 0 ? 0 : 1];
}

/* Calls `visit` with the cells of the band. */
static PetscErrorCode VisitBand(SamProfile s, void (*visit)(SamProfile, PetscInt i, PetscInt j, ptrdiff_t k, void *),
                                void      *context)
{
  PetscFunctionBegin;
  for (PetscInt j = s->begin; j < s->end; j++)
    for (PetscInt i = 0; i < s->grid->nx; i++) {
      const ptrdiff_t k = SamZoneAt(&s->zone, i, j);

      if (s->slot[k] >= 0) visit(s, i, j, k, context);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void FactorCell(SamProfile s, PetscInt i, PetscInt j, ptrdiff_t k, void *missing)
{
  double *factor = s->factor + SAM_FIT_PRODUCTS * (ptrdiff_t)s->slot[k];

  if (SamFitFactor(&s->zone, WindowOf(s, k), i, j, factor)) return;
  for (int n = 0, d = 0; d < SAM_FIT_TERMS; n += ++d + 1) factor[n] = INFINITY; /* its function is zero */
  if (j >= s->grid->row_start && j < s->grid->row_start + s->grid->rows) *(double *)missing = 1;
}

/* Finds the band of the zone. */
static PetscErrorCode FindBand(SamProfile s)
{
  const SamGrid  grid    = s->grid;
  const SamZone *z       = &s->zone;
  double         missing = 0;

  PetscFunctionBegin;
  PetscCall(SamZoneCreate(grid, s->in, HALO, BAND, &s->zone));
  s->begin = PetscMax(grid->row_start - SAM_NEAR, z->first);
  s->end   = PetscMin(grid->row_start + grid->rows + SAM_NEAR, z->first + z->count);
  s->band  = 0;
  PetscCall(PetscMalloc1((ptrdiff_t)z->count * grid->nx, &s->slot));
  for (PetscInt j = z->first; j < z->first + z->count; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const ptrdiff_t   k = SamZoneAt(z, i, j);
      const signed char d = z->distance[k];

      s->slot[k] = j >= s->begin && j < s->end && d >= RIM && d <= LAST ? s->band++ : -1;
    }
  PetscCall(PetscMalloc2(SAM_FIT_TERMS * s->band, &s->fit, SAM_FIT_PRODUCTS * s->band, &s->factor));
  PetscCall(VisitBand(s, FactorCell, &missing));
  PetscCall(SamMax(grid->comm, 1, &missing));
  s->found = missing == 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void FitCell(SamProfile s, PetscInt i, PetscInt j, ptrdiff_t k, void *context)
{
  const double *w = *(const double **)context;

  SamFit(&s->zone, WindowOf(s, k), s->factor + SAM_FIT_PRODUCTS * (ptrdiff_t)s->slot[k], w, i, j, FunctionOf(s, k),
         NULL);
  if (s->zone.distance[k] > 0) *FunctionOf(s, k) = w[k];
}

/* Fits the functions to the w at the centres. */
static PetscErrorCode Fit(SamProfile s)
{
  const double *own, *w;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(s->w, &own));
  PetscCall(SamRowsFetch(&s->zone.rows, s->grid->nx, own, &w));
  PetscCall(VisitBand(s, FitCell, &w));
  PetscCall(SamRowsRestore(&s->zone.rows, &w));
  PetscCall(VecRestoreArrayRead(s->w, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the steps ---- */

/* The zone is where the means exceed those of the rim; w their squares. */
static PetscErrorCode SetZone(SamProfile s, Vec mean)
{
  const double *t, *rim;
  double       *in;

  PetscFunctionBegin;
  s->mean = mean;
  PetscCall(ForgetZone(s));
  PetscCall(VecGetArrayRead(mean, &t));
  PetscCall(VecGetArrayRead(s->rim, &rim));
  PetscCall(VecGetArrayWrite(s->in, &in));
  for (PetscInt k = 0; k < s->grid->cells; k++) in[k] = t[k] > rim[k] ? 1 : 0;
  PetscCall(VecRestoreArrayWrite(s->in, &in));
  PetscCall(VecRestoreArrayRead(s->rim, &rim));
  PetscCall(VecRestoreArrayRead(mean, &t));
  PetscCall(VecPointwiseMult(s->w, mean, mean));
  PetscCall(FindBand(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces w in the layer of cells that an edge makes wrong, whether they look like one or not. */
static PetscErrorCode ReplaceLayer(SamProfile s)
{
  const SamGrid grid = s->grid;
  SamZone       z;
  Vec           layer;
  double       *w, fit[SAM_FIT_TERMS];

  PetscFunctionBegin;
  PetscCall(VecDuplicate(s->w, &layer));
  PetscCall(VecCopy(s->w, layer));
  PetscCall(SamZoneCreate(grid, layer, SAM_EDGE_WINDOW + 3, BAND, &z));
  PetscCall(VecGetArray(s->w, &w));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt    i = k % grid->nx, j = grid->row_start + k / grid->nx;
    const signed char d = z.distance[SamZoneAt(&z, i, j)];

    if (d > 0 && d <= SAM_EDGE_LAST && SamEdgeExtrapolate(&z, &s->core, i, j, fit, NULL)) w[k] = fit[0];
  }
  PetscCall(VecRestoreArray(s->w, &w));
  PetscCall(SamZoneDestroy(&z));
  PetscCall(VecDestroy(&layer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProfileStart(SamProfile s, Vec mean, SamEdge *edge, PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(VecSet(s->rim, 0));
  PetscCall(SetZone(s, mean));
  PetscCall(SamEdgeReconstruct(s->grid, s->w, NULL, edge));
  PetscCall(SamEdgeDestroy(edge));
  PetscCall(ReplaceLayer(s));
  PetscCall(Fit(s));
  *found = s->found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A cell of the zone takes the constant of its mean; others those of their functions, as they are. */
static PetscErrorCode Sweep(SamProfile s)
{
  const ptrdiff_t first = SamZoneAt(&s->zone, 0, s->grid->row_start);
  const double   *mean;
  double         *w;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(s->mean, &mean));
  PetscCall(VecGetArray(s->w, &w));
  for (PetscInt k = 0; k < s->grid->cells; k++) {
    double *fit = FunctionOf(s, first + k);

    if (!fit) continue;
    if (s->zone.distance[first + k] > 0) SamRootsMatch(RootsOf(s, first + k), mean[k], fit);
    w[k] = fit[0];
  }
  PetscCall(VecRestoreArray(s->w, &w));
  PetscCall(VecRestoreArrayRead(s->mean, &mean));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProfileMatch(SamProfile s, Vec mean, Vec rim, PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(VecCopy(rim, s->rim));
  PetscCall(SetZone(s, mean));
  PetscCall(Fit(s));
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    PetscCall(Sweep(s));
    PetscCall(Fit(s));
  }
  *found = s->found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The zone is where the centre lies inside, but for a margin. */
static PetscErrorCode MoveZone(SamProfile s)
{
  const ptrdiff_t first = SamZoneAt(&s->zone, 0, s->grid->row_start);
  double         *in;
  Vec             moved;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 1, &moved));
  PetscCall(VecGetArrayWrite(moved, &in));
  for (PetscInt k = 0; k < s->grid->cells; k++) {
    const PetscBool inside = s->zone.distance[first + k] > 0;
    const double   *fit    = FunctionOf(s, first + k);

    in[k] = inside ? 1 : 0;
    if (fit) in[k] = fit[0] > (inside ? -JOIN : JOIN) * hypot(fit[1], fit[2]) ? 1 : 0;
  }
  PetscCall(VecRestoreArrayWrite(moved, &in));
  PetscCall(ForgetZone(s));
  PetscCall(VecDestroy(&s->in));
  s->in = moved;
  PetscCall(FindBand(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cut cells outside bear traction, the mean of the new and the last value, so that it settles. */
static PetscErrorCode FindRim(SamProfile s)
{
  const ptrdiff_t first = SamZoneAt(&s->zone, 0, s->grid->row_start);
  double         *rim, means[SAM_ROOTS_CELLS];

  PetscFunctionBegin;
  PetscCall(VecGetArray(s->rim, &rim));
  for (PetscInt k = 0; k < s->grid->cells; k++) {
    const double *fit  = s->zone.distance[first + k] < 0 ? FunctionOf(s, first + k) : NULL;
    double        mean = fit ? SamRootsMean(&s->near.roots[SAM_NEAR_FINE], fit, means, NULL) : 0;

    if (fit && mean < LEAST * sqrt(hypot(fit[1], fit[2]))) mean = 0;
    rim[k] = rim[k] > 0 && mean > 0 ? 0.5 * (mean + rim[k]) : mean;
  }
  PetscCall(VecRestoreArray(s->rim, &rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProfileMove(SamProfile s, PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(MoveZone(s));
  PetscCall(Fit(s));
  PetscCall(FindRim(s));
  *found = s->found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProfileGetZone(SamProfile s, Vec *in, Vec *rim)
{
  PetscFunctionBegin;
  *in  = s->in;
  *rim = s->rim;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- displacement ---- */

/* The slope of the means across a cell in the middle of the zone. */
static void MiddleSlopes(const SamZone *z, const double mean[], PetscInt i, PetscInt j, double slopes[2])
{
  const ptrdiff_t k = SamZoneAt(z, i, j);

  slopes[0] = SamZoneHas(z, i - 1, j) && SamZoneHas(z, i + 1, j) ? 0.5 * (mean[k + 1] - mean[k - 1]) : 0;
  slopes[1] =
    SamZoneHas(z, i, j - 1) && SamZoneHas(z, i, j + 1) ? 0.5 * (mean[k + z->grid->nx] - mean[k - z->grid->nx]) : 0;
}

/* The slopes of the means and roots of this rank's cells. */
PetscErrorCode SamProfileComputeSlopes(SamProfile s, Vec slopes)
{
  const SamGrid  grid = s->grid;
  const SamZone *z    = &s->zone;
  const double  *own, *mean;
  double        *slope, part[SAM_ROOTS_CELLS];

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(s->mean, &own));
  PetscCall(SamRowsFetch(&s->zone.rows, grid->nx, own, &mean));
  PetscCall(VecGetArrayWrite(slopes, &slope));
  for (PetscInt n = 0; n < grid->cells; n++) {
    const PetscInt  i = n % grid->nx, j = grid->row_start + n / grid->nx;
    const ptrdiff_t k       = SamZoneAt(z, i, j);
    const double   *fit     = FunctionOf(s, k);
    double          both[2] = {0, 0};

    if (fit)
      SamRootsTakeLinearPart(RootsOf(s, k), SamRootsMean(RootsOf(s, k), fit, part, NULL), part, both);
    else if (z->distance[k] > 0)
      MiddleSlopes(z, mean, i, j, both);
    for (PetscInt c = 0; c < 2; c++) slope[n + c * grid->cells] = both[c];
  }
  PetscCall(VecRestoreArrayWrite(slopes, &slope));
  PetscCall(SamRowsRestore(&s->zone.rows, &mean));
  PetscCall(VecRestoreArrayRead(s->mean, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a cell's sub-cells displace beyond the linear part. */
static void AddCell(SamProfile s, PetscInt i, PetscInt j, ptrdiff_t k, void *u)
{
  const SamRoots *roots = RootsOf(s, k);
  double          part[SAM_ROOTS_CELLS], slopes[2];
  const double    whole = SamRootsMean(roots, FunctionOf(s, k), part, NULL);

  if (whole <= 0) return;
  SamRootsTakeLinearPart(roots, whole, part, slopes);
  SamNearAdd(&s->near, SubOf(s, k), s->grid, &(SamNearPart){i, j, part}, (double *)u);
}

PetscErrorCode SamProfileComputeDisplacement(SamProfile s, Vec u_z)
{
  double *u;
  Vec     slopes;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 2, &slopes));
  PetscCall(SamProfileComputeSlopes(s, slopes));
  PetscCall(SamElasticityApplyNormalSlopes(s->elasticity, slopes, u_z));
  PetscCall(VecDestroy(&slopes));
  PetscCall(SamNearSetUp(&s->near));
  PetscCall(VecGetArray(u_z, &u));
  PetscCall(VisitBand(s, AddCell, u));
  PetscCall(VecRestoreArray(u_z, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the edge ---- */

/* The square of the traction at the centre of a cell without a function: of the mean without what curvature adds. */
static double MiddleSquare(const SamZone *z, const double mean[], PetscInt i, PetscInt j)
{
  const ptrdiff_t k     = SamZoneAt(z, i, j);
  double          value = mean[k];

  if (SamZoneHas(z, i - 1, j) && SamZoneHas(z, i + 1, j)) value -= (mean[k - 1] - 2 * mean[k] + mean[k + 1]) / 24;
  if (SamZoneHas(z, i, j - 1) && SamZoneHas(z, i, j + 1))
    value -= (mean[k - z->grid->nx] - 2 * mean[k] + mean[k + z->grid->nx]) / 24;
  return value > 0 ? value * value : 0;
}

/* Sums the parts of this rank's cells in the zone, adds the edge's points, and fills the squares, unless NULL. */
static void AddRows(SamProfile s, const double mean[], SamEdge *edge, double squares[], SamTotal *area)
{
  const SamZone *z    = &s->zone;
  const SamGrid  grid = s->grid;

  for (PetscInt j = grid->row_start; j < grid->row_start + grid->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const ptrdiff_t k      = SamZoneAt(z, i, j);
      const double   *fit    = FunctionOf(s, k);
      const PetscBool middle = !fit && z->distance[k] > 0;

      row += fit ? SamFitPart(fit) : middle ? 1 : 0;
      if (fit) SamEdgeAddPoint(grid, fit, i, j, edge);
      if (squares)
        squares[(j - grid->row_start) * grid->nx + i] = fit ? fit[0] : middle ? MiddleSquare(z, mean, i, j) : 0;
    }
    SamAdd(area, row);
  }
}

PetscErrorCode SamProfileGetEdge(SamProfile s, Vec point, SamEdge *edge)
{
  SamTotal      area = {0};
  const double *own, *mean;
  double       *squares = NULL, sum;

  PetscFunctionBegin;
  *edge = (SamEdge){.faces = 1, .good = 1, .smooth = 1};
  PetscCall(PetscMalloc4(s->band, &edge->x, s->band, &edge->y, s->band, &edge->cell, s->band, &edge->fit));
  PetscCall(VecGetArrayRead(s->mean, &own));
  PetscCall(SamRowsFetch(&s->zone.rows, s->grid->nx, own, &mean));
  if (point) PetscCall(VecGetArrayWrite(point, &squares));
  AddRows(s, mean, edge, squares, &area);
  if (point) PetscCall(VecRestoreArrayWrite(point, &squares));
  PetscCall(SamRowsRestore(&s->zone.rows, &mean));
  PetscCall(VecRestoreArrayRead(s->mean, &own));
  PetscCall(SamSumTotals(s->grid->comm, 1, &area, &sum));
  edge->area = sum * s->grid->dx * s->grid->dy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

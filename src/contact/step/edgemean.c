/*
  Means of a motion over the open cells beside the contact (touching.c).

  In the mean about a cell, each point has its own weight times a Gaussian of its distance from the cell. So the nearest
  points prevail for cells far inside, too. The deviation is DEVIATION cells, or the part PART of the width of the
  contact, if that is more: shear responds to differences of the motion along the edge, whatever their length. With a
  fixed number of cells, a finer grid would leave more of them to the iteration: 57 passes on 768 cells instead of 18.
  The width is 4 times the number of cells in contact over the number of their sides on the edge. The motions point
  outwards on all sides, and partly cancel in their mean. It gets their mean length, by a factor of at most LONGER.

  Algorithm: For a row, the points of a column are summed first, then the columns for each cell, from the nearest on. As
  the means are smooth, they are computed on every n-th row and column only, where a cell needs them, and interpolated
  between; n is the part SPACING of the deviation.
*/
#include "edgemean.h"
#include <math.h>
#include <petsam/private/pressed.h>
#include <petsam/private/rows.h>

#define DEVIATION 2.5
#define PART      (1.0 / 16)
#define SPACING   0.2
/* Points count if the square of their distance exceeds that of the nearest by at most COUNTS squared deviations, where
   the weight is 1e-6. */
#define COUNTS 28.0
#define LONGER 1.25

/* Sums over a column's points: of their weights relative to that of the nearest, of the weighted motions, and of the
   lengths of these */
typedef struct {
  double weight, moved[2], length;
} Column;

/*
  The columns about row j, from column -before to nx + before - 1: beyond the grid for periodic bodies. `far`: the
  squared distance of a column's nearest point. `at`: the place of that point in `order`; on periodic bodies places go
  on before the column's first point and behind its last one, for the points of the periods before and after.
*/
typedef struct {
  PetscInt   j, *at;
  double    *far, *mean; /* mean: two components in every n-th column, if it is known */
  PetscBool *known;
  Column    *column;
} Row;

/* The points of all ranks, those of column c at order[start[c]] ... order[start[c + 1] - 1], by rows */
struct SamEdgeMean_ {
  SamGrid   grid;
  PetscBool wraps;
  PetscInt  count, *start, *order;
  double   *point; /* SAM_EDGE_POINT numbers of each */
  PetscInt  before, spacing, counts;
  double   *weight; /* by the squared distance beyond that of the nearest point, in cells */
  Row       row[2]; /* the nearest n-th rows on both sides */
  double    along;  /* the weight of the second row in interpolation */
};

/* The number of the period of a column's point `at`, and the point */
static PetscInt PeriodOf(SamEdgeMean e, PetscInt c, PetscInt at)
{
  return at < e->start[c] ? -1 : at >= e->start[c + 1] ? 1 : 0;
}

static const double *PointAt(SamEdgeMean e, PetscInt c, PetscInt at)
{
  const PetscInt count = e->start[c + 1] - e->start[c];

  return e->point + SAM_EDGE_POINT * (ptrdiff_t)e->order[at - count * PeriodOf(e, c, at)];
}

/* The squared distance along a column, in cells */
static double AlongColumn(SamEdgeMean e, PetscInt j, PetscInt c, PetscInt at)
{
  const double y = PointAt(e, c, at)[SAM_EDGE_ROW] + (double)(PeriodOf(e, c, at) * e->grid->ny) - (double)j;

  return y * y;
}

/* The first and the last place, less 1, of a column's points, with those of the periods before and after */
static PetscInt FirstOf(SamEdgeMean e, PetscInt c)
{
  return e->start[c] - (e->wraps ? e->start[c + 1] - e->start[c] : 0);
}

static PetscInt EndOf(SamEdgeMean e, PetscInt c)
{
  return e->start[c + 1] + (e->wraps ? e->start[c + 1] - e->start[c] : 0);
}

/* ---- points ---- */

/* Sorts the points by columns; those of a column stay in the order of their rows. */
static PetscErrorCode SortByColumns(SamEdgeMean e)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(e->grid->nx + 2, &e->start));
  PetscCall(PetscMalloc1(e->count, &e->order));
  for (PetscInt k = 0; k < e->count; k++) e->start[(PetscInt)e->point[SAM_EDGE_POINT * k + SAM_EDGE_COLUMN] + 2]++;
  for (PetscInt c = 0; c < e->grid->nx; c++) e->start[c + 2] += e->start[c + 1];
  for (PetscInt k = 0; k < e->count; k++)
    e->order[e->start[(PetscInt)e->point[SAM_EDGE_POINT * k + SAM_EDGE_COLUMN] + 1]++] = k;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes this rank's points known to all. */
static PetscErrorCode Share(SamEdgeMean e, PetscInt count, const double points[])
{
  const MPI_Comm comm = e->grid->comm;
  PetscMPIInt    rank, length;

  PetscFunctionBegin;
  PetscCall(SamGather(comm, MPI_DOUBLE, SAM_EDGE_POINT * count, points, &e->count, &e->point));
  PetscCall(PetscMPIIntCast(e->count, &length));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank != 0) PetscCall(PetscMalloc1(length, &e->point));
  PetscCallMPI(MPI_Bcast(e->point, length, MPI_DOUBLE, 0, comm));
  e->count /= SAM_EDGE_POINT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The deviation of the Gaussian by the width of the contact */
static PetscErrorCode FindDeviation(SamEdgeMean e, const double p[], double *deviation)
{
  double cells = 0, sides = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < e->grid->cells; k++) cells += SamIsPressed(p[k]) ? 1 : 0;
  PetscCall(SamSum(e->grid->comm, 1, &cells));
  for (PetscInt k = 0; k < e->count; k++) sides += e->point[SAM_EDGE_POINT * k + SAM_EDGE_WEIGHT];
  /* a compact contact is as wide as the root of its area; edges that no cell shares exactly have little weight */
  *deviation = PetscMax(DEVIATION, PART * (sides > 0 ? PetscMin(4 * cells / sides, sqrt(cells)) : 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetWeights(SamEdgeMean e, double deviation)
{
  PetscFunctionBegin;
  e->counts  = (PetscInt)(COUNTS * deviation * deviation);
  e->spacing = PetscMax((PetscInt)(SPACING * deviation), 1);
  PetscCall(PetscMalloc1(e->counts + 1, &e->weight));
  for (PetscInt d = 0; d <= e->counts; d++) e->weight[d] = exp(-(double)d / (2 * deviation * deviation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeMeanCreate(SamGrid grid, PetscBool wraps, const double p[], PetscInt count, const double points[],
                                 double *deviation, SamEdgeMean *mean)
{
  SamEdgeMean    e;
  const PetscInt nx = grid->nx, before = wraps ? nx / 2 : 0;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  e->grid   = grid;
  e->wraps  = wraps;
  e->before = before;
  PetscCall(Share(e, count, points));
  PetscCall(SortByColumns(e));
  if (*deviation == 0) PetscCall(FindDeviation(e, p, deviation));
  PetscCall(SetWeights(e, *deviation));
  for (int k = 0; k < 2; k++) {
    Row *const r = &e->row[k];

    r->j = -1;
    PetscCall(
      PetscMalloc5(nx, &r->at, nx + 2 * before, &r->far, nx + 2 * before, &r->column, 2 * nx, &r->mean, nx, &r->known));
    r->far += before;
    r->column += before;
    for (PetscInt c = 0; c < nx; c++) r->at[c] = FirstOf(e, c);
  }
  *mean = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeMeanDestroy(SamEdgeMean *mean)
{
  const SamEdgeMean e = *mean;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    Row *const r = &e->row[k];

    r->far -= e->before;
    r->column -= e->before;
    PetscCall(PetscFree5(r->at, r->far, r->column, r->mean, r->known));
  }
  PetscCall(PetscFree(e->weight));
  PetscCall(PetscFree(e->order));
  PetscCall(PetscFree(e->start));
  PetscCall(PetscFree(e->point));
  PetscCall(PetscFree(*mean));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the columns about a row ---- */

/* Adds the points of a column from `at` on, by steps of `way`, as long as they count. */
static void AddPoints(SamEdgeMean e, const Row *r, PetscInt c, PetscInt at, PetscInt way, Column *to)
{
  for (; at >= FirstOf(e, c) && at < EndOf(e, c); at += way) {
    const double *point = PointAt(e, c, at), *moved = point + SAM_EDGE_MOVED;
    const double  far = AlongColumn(e, r->j, c, at) - r->far[c];
    double        weight;

    if (far > (double)e->counts) return;
    weight = point[SAM_EDGE_WEIGHT] * e->weight[(PetscInt)far];
    to->weight += weight;
    for (int a = 0; a < 2; a++) to->moved[a] += weight * moved[a];
    to->length += weight * hypot(moved[0], moved[1]);
  }
}

/* Finds the nearest point of a column; those of rows before the last one were farther. */
static void FindNearest(SamEdgeMean e, Row *r, PetscInt c)
{
  while (r->at[c] + 1 < EndOf(e, c) && AlongColumn(e, r->j, c, r->at[c] + 1) < AlongColumn(e, r->j, c, r->at[c]))
    r->at[c]++;
  r->far[c] = AlongColumn(e, r->j, c, r->at[c]);
}

static void SetRow(SamEdgeMean e, Row *r, PetscInt j)
{
  const PetscInt nx = e->grid->nx;

  r->j = j;
  for (PetscInt c = 0; c < nx; c++) {
    r->known[c]  = PETSC_FALSE;
    r->column[c] = (Column){0};
    r->far[c]    = INFINITY;
    if (e->start[c] == e->start[c + 1]) continue;
    FindNearest(e, r, c);
    AddPoints(e, r, c, r->at[c], 1, &r->column[c]);
    AddPoints(e, r, c, r->at[c] - 1, -1, &r->column[c]);
  }
  for (PetscInt c = -e->before; c < nx + e->before; c++) {
    r->far[c]    = r->far[(c + nx) % nx];
    r->column[c] = r->column[(c + nx) % nx];
  }
}

void SamEdgeMeanSetRow(SamEdgeMean e, PetscInt j)
{
  const PetscInt last = e->grid->ny - 1, n = j / e->spacing;
  PetscInt       rows[2];

  for (PetscInt k = n; k <= n + 1; k++) {
    rows[k - n] = PetscMin(k * e->spacing, last);
    if (e->row[k % 2].j != rows[k - n]) SetRow(e, &e->row[k % 2], rows[k - n]);
  }
  e->along = rows[1] > rows[0] ? (double)(j - rows[0]) / (double)(rows[1] - rows[0]) : 0;
  if (n % 2) e->along = 1 - e->along;
}

/* ---- the mean about a cell ---- */

/* Adds column c, whose squared distance from a cell exceeds that of the nearest point by d without the distance along
   the column, to its sums, unless it is too far. */
static void AddColumn(SamEdgeMean e, const Row *r, PetscInt c, double d, double sum[4])
{
  double weight;

  if (c < -e->before || c >= e->grid->nx + e->before || d + r->far[c] > (double)e->counts) return;
  weight = e->weight[(PetscInt)(d + r->far[c])];
  sum[0] += weight * r->column[c].weight;
  for (int a = 0; a < 2; a++) sum[1 + a] += weight * r->column[c].moved[a];
  sum[3] += weight * r->column[c].length;
}

/* Finds the mean about column i. */
static void FindMean(SamEdgeMean e, const Row *r, PetscInt i, double mean[2])
{
  const PetscInt first = -e->before, last = e->grid->nx + e->before - 1, end = PetscMax(i - first, last - i);
  double         far = INFINITY, sum[4] = {0, 0, 0, 0}, size;

  for (PetscInt x = 0; x <= end && (double)x * (double)x < far; x++) {
    const double d = (double)x * (double)x;

    if (i - x >= first) far = PetscMin(far, d + r->far[i - x]);
    if (i + x <= last) far = PetscMin(far, d + r->far[i + x]);
  }
  for (PetscInt x = 0; x <= end && (double)x * (double)x - far <= (double)e->counts; x++) {
    const double d = (double)x * (double)x - far;

    AddColumn(e, r, i - x, d, sum);
    if (x > 0) AddColumn(e, r, i + x, d, sum);
  }
  size = hypot(sum[1], sum[2]);
  for (int a = 0; a < 2; a++) mean[a] = size > 0 ? PetscMin(sum[3] / size, LONGER) * sum[1 + a] / sum[0] : 0;
}

/* The mean in every n-th column */
static const double *MeanIn(SamEdgeMean e, Row *r, PetscInt n, PetscInt i)
{
  if (!r->known[n]) FindMean(e, r, i, r->mean + 2 * n);
  r->known[n] = PETSC_TRUE;
  return r->mean + 2 * n;
}

void SamEdgeMeanAt(SamEdgeMean e, PetscInt i, double value[2])
{
  const PetscInt n = i / e->spacing, from = n * e->spacing, to = PetscMin(from + e->spacing, e->grid->nx - 1);
  const double   across = to > from ? (double)(i - from) / (double)(to - from) : 0;

  value[0] = value[1] = 0;
  if (e->count == 0) return;
  for (int k = 0; k < 4; k++) {
    const int     row = k / 2, side = k % 2;
    const double  part = (row ? e->along : 1 - e->along) * (side ? across : 1 - across);
    const double *mean;

    if (part == 0) continue;
    mean = MeanIn(e, &e->row[row], n + side, side ? to : from);
    for (int a = 0; a < 2; a++) value[a] += part * mean[a];
  }
}

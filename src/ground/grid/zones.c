/*
  Connected zones of cells: their number, and their widths in cells.

  Each rank goes through its rows once and unites runs of cells that touch a piece in the row before (Hoshen and
  Kopelman 1976, Phys. Rev. B 14, 3438, with runs instead of cells). Zones that lie within a rank's rows are complete
  then. Zones in its first or last row may continue on the next rank: their pieces move to rank 0, which unites them.
  Only integers are summed, so nothing depends on the number of ranks. Memory: labels of two rows, and a piece per zone.
*/
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>
#include <math.h>

/* Sums and extremes of a zone, or of a piece of a zone, in cells */
typedef struct {
  int64_t least[2], most[2]; /* first and last column and row */
  int64_t cells, sum[2];     /* number; sums of columns and rows; */
  int64_t square[3];         /* sums of their products xx, yy, xy */
} Piece;

/* Pieces; `parent` of a piece is the piece with which it has been united, at first the piece itself */
typedef struct {
  PetscBool wrap[2]; /* the grid's opposite borders along x, along y connect cells, too */
  PetscInt
         first[2]; /* column and row that count as 0; they are not 0 only with `wrap`, and where no zone crosses them */
  Piece *piece;
  PetscInt *parent;
  PetscInt  count, room;
} Forest;

/* ---- pieces ---- */

static PetscErrorCode AddPiece(Forest *f, const Piece *piece, PetscInt *index)
{
  PetscFunctionBegin;
  if (f->count == f->room) {
    f->room = PetscMax(64, 2 * f->room);
    PetscCall(PetscRealloc(sizeof(*f->piece) * (size_t)f->room, &f->piece));
    PetscCall(PetscRealloc(sizeof(*f->parent) * (size_t)f->room, &f->parent));
  }
  f->piece[f->count]  = *piece;
  f->parent[f->count] = f->count;
  *index              = f->count++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Find(Forest *f, PetscInt k)
{
  while (f->parent[k] != k) k = f->parent[k] = f->parent[f->parent[k]];
  return k;
}

static void Add(Piece *to, const Piece *from)
{
  for (int k = 0; k < 2; k++) {
    to->least[k] = PetscMin(to->least[k], from->least[k]);
    to->most[k]  = PetscMax(to->most[k], from->most[k]);
    to->sum[k] += from->sum[k];
  }
  for (int k = 0; k < 3; k++) to->square[k] += from->square[k];
  to->cells += from->cells;
}

/* Unites two pieces; returns the resulting piece. */
static PetscInt Unite(Forest *f, PetscInt a, PetscInt b)
{
  a = Find(f, a);
  b = Find(f, b);
  if (a == b) return a;
  Add(&f->piece[PetscMin(a, b)], &f->piece[PetscMax(a, b)]);
  return f->parent[PetscMax(a, b)] = PetscMin(a, b);
}

/* Return 0 + 1 + ... + n, and the sum of the squares of these numbers. */
static int64_t Sum(int64_t n)
{
  return n * (n + 1) / 2;
}

static int64_t SumSquares(int64_t n)
{
  return n * (n + 1) * (2 * n + 1) / 6;
}

/* Returns the run of cells from `first` to `last` of row y as a piece. */
static Piece PieceOf(int64_t first, int64_t last, int64_t y)
{
  const int64_t n = last - first + 1, sum = Sum(last) - Sum(first - 1);
  const Piece   p = {.least  = {first, y},
                     .most   = {last, y},
                     .cells  = n,
                     .sum    = {sum, n * y},
                     .square = {SumSquares(last) - SumSquares(first - 1), n * y * y, sum * y}};

  return p;
}

/*
  Returns the width of a zone in cells: the shorter side of its bounding box, or the shorter diameter of the ellipse
  with its second moments, whichever is less. The ellipse gives the width of a zone that is oblique to the axes. If a
  zone extends from border to border along one axis only, as under a cylinder, its width along that axis is ignored.
*/
static double Across(const Piece *p, SamGrid grid)
{
  const double n = (double)p->cells, x = (double)p->sum[0] / n, y = (double)p->sum[1] / n;
  /* 1/12 is the second moment of a square cell about its centre */
  double       xx = (double)p->square[0] / n - x * x + 1. / 12, yy = (double)p->square[1] / n - y * y + 1. / 12;
  const double xy      = (double)p->square[2] / n - x * y;
  const double side[2] = {(double)(p->most[0] - p->least[0]) + 1, (double)(p->most[1] - p->least[1]) + 1};
  const int    spans_x = side[0] >= (double)grid->nx, spans_y = side[1] >= (double)grid->ny;
  double       least;

  if (spans_x && !spans_y) xx = PetscMax(xx, yy);
  if (spans_y && !spans_x) yy = PetscMax(xx, yy);
  least = 0.5 * (xx + yy) - hypot(0.5 * (xx - yy), xy);
  return PetscMin(spans_x == spans_y ? PetscMin(side[0], side[1]) : side[spans_x], 4 * sqrt(PetscMax(least, 0)));
}

/* ---- rows ---- */

/* Returns the place of a column (axis 0) or row among n of them, counted from the first one. */
static PetscInt PlaceOf(const Forest *f, int axis, PetscInt k, PetscInt n)
{
  return k < f->first[axis] ? k - f->first[axis] + n : k - f->first[axis];
}

/* Processes row j: `label` has the pieces of the row before, -1 for cells in none, and receives those of this row. */
static PetscErrorCode ReadRow(SamGrid grid, const double p[], PetscInt j, Forest *f, PetscInt label[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < grid->nx; i++) {
    PetscInt first = i, k = -1;
    Piece    piece;

    for (; i < grid->nx && p[i] > 0; i++)
      if (label[i] >= 0) k = k < 0 ? Find(f, label[i]) : Unite(f, k, label[i]);
    if (i < grid->nx) label[i] = -1;
    if (i == first) continue;
    piece = PieceOf(PlaceOf(f, 0, first, grid->nx), PlaceOf(f, 0, i - 1, grid->nx), PlaceOf(f, 1, j, grid->ny));
    if (k < 0)
      PetscCall(AddPiece(f, &piece, &k));
    else
      Add(&f->piece[k], &piece);
    while (first < i) label[first++] = k;
  }
  if (f->wrap[0] && label[0] >= 0 && label[grid->nx - 1] >= 0) (void)Unite(f, label[0], label[grid->nx - 1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads this rank's pieces, and the pieces of the cells in its first and last row. */
static PetscErrorCode ReadRows(SamGrid grid, Vec field, Forest *f, PetscInt *edge[2])
{
  const double *p;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < grid->nx; i++) edge[0][i] = edge[1][i] = -1;
  PetscCall(VecGetArrayRead(field, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    PetscCall(ReadRow(grid, p + (ptrdiff_t)j * grid->nx, grid->row_start + j, f, edge[1]));
    if (j == 0) PetscCall(PetscArraycpy(edge[0], edge[1], grid->nx));
  }
  PetscCall(VecRestoreArrayRead(field, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- zones on several ranks ---- */

#define PIECE ((PetscInt)(sizeof(Piece) / sizeof(int64_t))) /* numbers per piece */

/* Moves the pieces of the first and last row out of the forest; the labels become their places among those of all
   ranks. */
static PetscErrorCode TakeOut(SamGrid grid, Forest *f, PetscInt *edge[2], Piece pieces[], PetscInt *count)
{
  PetscInt *place, base = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(f->count, &place));
  for (PetscInt k = 0; k < f->count; k++) place[k] = -1;
  *count = 0;
  for (PetscInt r = 0; r < 2; r++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt root = edge[r][i] < 0 ? -1 : Find(f, edge[r][i]);

      if (root < 0) continue;
      if (place[root] < 0) {
        place[root]          = *count;
        pieces[(*count)++]   = f->piece[root];
        f->piece[root].cells = 0;
      }
      edge[r][i] = place[root];
    }
  PetscCall(PetscFree(place));
  PetscCallMPI(MPI_Exscan(count, &base, 1, MPIU_INT, MPI_SUM, grid->comm));
  for (PetscInt r = 0; r < 2; r++)
    for (PetscInt i = 0; i < grid->nx; i++) edge[r][i] += edge[r][i] < 0 ? 0 : base;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds pairs of pieces that touch: in the last row, and in the first row of the next rank that has rows. */
static PetscErrorCode FindPairs(SamGrid grid, PetscBool wrap, PetscInt *edge[2], int64_t pairs[], PetscInt *count)
{
  PetscMPIInt rank, size, ranks, before, after, nx;
  PetscInt   *next, begin, end;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(PetscMPIIntCast(grid->nx, &nx));
  SamGridRowsOf(grid, size, 0, &begin, &end);
  ranks  = (PetscMPIInt)((grid->ny + end - 1) / end); /* ranks with rows, which are the first ones */
  before = rank >= ranks ? MPI_PROC_NULL : rank ? rank - 1 : wrap ? ranks - 1 : MPI_PROC_NULL;
  after  = rank + 1 < ranks ? rank + 1 : rank < ranks && wrap ? 0 : MPI_PROC_NULL;
  *count = 0;
  PetscCall(PetscMalloc1(nx, &next));
  for (PetscInt i = 0; i < nx; i++) next[i] = -1;
  PetscCallMPI(
    MPI_Sendrecv(edge[0], nx, MPIU_INT, before, 0, next, nx, MPIU_INT, after, 0, grid->comm, MPI_STATUS_IGNORE));
  for (PetscInt i = 0; i < nx; i++) {
    if (edge[1][i] < 0 || next[i] < 0 || (i && edge[1][i - 1] == edge[1][i] && next[i - 1] == next[i])) continue;
    pairs[(*count)++] = edge[1][i];
    pairs[(*count)++] = next[i];
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the pieces of all ranks' first and last rows to rank 0's forest, and unites them there. */
static PetscErrorCode Share(SamGrid grid, Forest *f, PetscInt *edge[2])
{
  const PetscInt own = f->count;
  Piece         *pieces, *all_pieces;
  int64_t       *pairs, *all_pairs;
  PetscInt       count, index;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * grid->nx, &pieces, 2 * grid->nx, &pairs));
  PetscCall(TakeOut(grid, f, edge, pieces, &count));
  PetscCall(SamGather(grid->comm, MPI_INT64_T, PIECE * count, pieces, &count, &all_pieces));
  for (PetscInt k = 0; all_pieces && k < count / PIECE; k++) PetscCall(AddPiece(f, &all_pieces[k], &index));
  PetscCall(FindPairs(grid, f->wrap[1], edge, pairs, &count));
  PetscCall(SamGather(grid->comm, MPI_INT64_T, count, pairs, &count, &all_pairs));
  for (PetscInt k = 0; all_pairs && k < count; k += 2)
    (void)Unite(f, own + (PetscInt)all_pairs[k], own + (PetscInt)all_pairs[k + 1]);
  PetscCall(PetscFree(all_pieces));
  PetscCall(PetscFree(all_pairs));
  PetscCall(PetscFree2(pieces, pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all zones ---- */

/* Finds this rank's zones, and on rank 0 those of several ranks; only roots with cells count. */
static PetscErrorCode FindZones(SamGrid grid, Vec field, Forest *f)
{
  PetscInt *edge[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(grid->nx, &edge[0], grid->nx, &edge[1]));
  PetscCall(ReadRows(grid, field, f, edge));
  PetscCall(Share(grid, f, edge));
  PetscCall(PetscFree2(edge[0], edge[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsZone(const Forest *f, PetscInt k)
{
  return f->parent[k] == k && f->piece[k].cells;
}

static PetscErrorCode DestroyForest(Forest *f)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(f->piece));
  PetscCall(PetscFree(f->parent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridCountZones(SamGrid grid, Vec field, PetscBool wrap, PetscInt *zones)
{
  Forest f   = {.wrap = {wrap, wrap}};
  double sum = 0;

  PetscFunctionBegin;
  PetscCall(FindZones(grid, field, &f));
  for (PetscInt k = 0; k < f.count; k++) sum += IsZone(&f, k);
  PetscCall(DestroyForest(&f));
  PetscCall(SamSum(grid->comm, 1, &sum));
  *zones = (PetscInt)sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts columns and rows from an edge of the zones on, if there are any without a zone. */
static PetscErrorCode BeginOutside(SamGrid grid, Vec field, Forest *f)
{
  PetscInt first[2], n[2];

  PetscFunctionBegin;
  PetscCall(SamGridGetSupport(grid, field, PETSC_TRUE, first, n));
  for (int k = 0; k < 2; k++) {
    f->wrap[k]  = n[k] < (k ? grid->ny : grid->nx) ? PETSC_TRUE : PETSC_FALSE;
    f->first[k] = f->wrap[k] && n[k] > 0 ? first[k] : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridMeasureZones(SamGrid grid, Vec field, PetscReal part, PetscBool wrap, PetscReal *across)
{
  const PetscInt widths = 10 * PetscMax(grid->nx, grid->ny);
  double        *cells, sum = 0, narrow = 0; /* cells[w]: number of cells in zones of width w/10 */
  Forest         f = {.count = 0};
  PetscInt       w = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(widths + 1, &cells));
  if (wrap) PetscCall(BeginOutside(grid, field, &f));
  PetscCall(FindZones(grid, field, &f));
  for (PetscInt k = 0; k < f.count; k++)
    if (IsZone(&f, k))
      cells[PetscMin(widths, PetscMax(1, (PetscInt)floor(10 * Across(&f.piece[k], grid) + 0.5)))] +=
        (double)f.piece[k].cells;
  PetscCall(DestroyForest(&f));
  PetscCall(SamSum(grid->comm, widths + 1, cells)); /* sums of integers, so without rounding */
  for (PetscInt k = 1; k <= widths; k++) sum += cells[k];
  while (w < widths && (w == 0 || narrow <= (double)part * sum)) narrow += cells[++w];
  *across = sum > 0 ? 0.1 * (PetscReal)w : 0;
  PetscCall(PetscFree(cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

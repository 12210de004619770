/*
  Connected zones of cells: how many, and how many cells across.

  Each rank goes through its rows once and unites runs of cells that touch a run in the row before (Hoshen and Kopelman
  1976, Phys. Rev. B 14, 3438, with runs for cells). Zones that lie within a rank's rows are complete then. Those in its
  first or last row may go on in the next rank: their pieces are sent to rank 0, which unites them. What is summed are
  whole numbers, so that nothing depends on the number of ranks. Memory: a run of two rows, and a piece a zone.
*/
#include "gridimpl.h"
#include <petsam/private/baseimpl.h>
#include <math.h>

/* What is known of a zone, or of a piece of one. All are sums or extremes, in cells. */
typedef struct {
  int64_t least[2], most[2]; /* first and last column and row */
  int64_t cells, sum[2];     /* of columns and rows, */
  int64_t square[3];         /* and of their products xx, yy, xy */
} Piece;

/* Cells first ... last of a row, which belong to a piece. */
typedef struct {
  int64_t first, last, piece;
} Run;

typedef struct {
  Run     *run;
  PetscInt count, room;
} Row;

/* Pieces; `parent` leads to the piece that one has been united with, itself at first. */
typedef struct {
  PetscBool wrap; /* the grid's opposite borders connect cells, too */
  Piece    *piece;
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

static void Unite(Forest *f, PetscInt a, PetscInt b)
{
  a = Find(f, a);
  b = Find(f, b);
  if (a == b) return;
  Add(&f->piece[PetscMin(a, b)], &f->piece[PetscMax(a, b)]);
  f->parent[PetscMax(a, b)] = PetscMin(a, b);
}

/* 0 + 1 + ... + n, and the sum of their squares. */
static int64_t Sum(int64_t n)
{
  return n * (n + 1) / 2;
}

static int64_t SumSquares(int64_t n)
{
  return n * (n + 1) * (2 * n + 1) / 6;
}

/* The run of cells from `first` to `last` of row y as a piece. */
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
  Cells across a zone: the shorter side of its bounding box, or the shorter diameter of the ellipse with its second
  moments, whichever is less: the ellipse tells the width of a zone that lies across the axes.
*/
static double Across(const Piece *p)
{
  const double n = (double)p->cells, x = (double)p->sum[0] / n, y = (double)p->sum[1] / n;
  /* 1/12 is that of a square cell about its centre */
  const double xx = (double)p->square[0] / n - x * x + 1. / 12, yy = (double)p->square[1] / n - y * y + 1. / 12,
               xy = (double)p->square[2] / n - x * y, least = 0.5 * (xx + yy) - hypot(0.5 * (xx - yy), xy);
  const double side = (double)PetscMin(p->most[0] - p->least[0], p->most[1] - p->least[1]) + 1;

  return PetscMin(side, 4 * sqrt(PetscMax(least, 0)));
}

/* ---- rows ---- */

static PetscErrorCode AddRun(Row *row, Run run)
{
  PetscFunctionBegin;
  if (row->count == row->room) {
    row->room = PetscMax(64, 2 * row->room);
    PetscCall(PetscRealloc(sizeof(*row->run) * (size_t)row->room, &row->run));
  }
  row->run[row->count++] = run;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unites the pieces of two rows that touch. */
static void Join(Forest *f, const Run *one, PetscInt ones, const Run *other, PetscInt others)
{
  for (PetscInt i = 0, j = 0; i < ones && j < others;) {
    if (one[i].first <= other[j].last && other[j].first <= one[i].last)
      Unite(f, (PetscInt)one[i].piece, (PetscInt)other[j].piece);
    if (one[i].last < other[j].last)
      i++;
    else
      j++;
  }
}

/* The runs of row j, which go on with the pieces that they touch in the row before. */
static PetscErrorCode ReadRow(SamGrid grid, const double p[], PetscInt j, const Row *before, Forest *f, Row *row)
{
  PetscInt b = 0;

  PetscFunctionBegin;
  row->count = 0;
  for (PetscInt i = 0; i < grid->nx; i++) {
    Run      run = {i, i, -1};
    PetscInt index;
    Piece    piece;

    if (!(p[i] > 0)) continue;
    while (i + 1 < grid->nx && p[i + 1] > 0) i++;
    run.last = i;
    piece    = PieceOf(run.first, run.last, grid->row_start + j);
    while (b < before->count && before->run[b].last < run.first) b++;
    for (PetscInt k = b; k < before->count && before->run[k].first <= run.last; k++) {
      if (run.piece < 0) {
        run.piece = Find(f, (PetscInt)before->run[k].piece);
        Add(&f->piece[run.piece], &piece);
      } else {
        Unite(f, (PetscInt)run.piece, (PetscInt)before->run[k].piece);
      }
    }
    if (run.piece < 0) {
      PetscCall(AddPiece(f, &piece, &index));
      run.piece = index;
    }
    PetscCall(AddRun(row, run));
  }
  if (f->wrap && row->count && row->run[0].first == 0 && row->run[row->count - 1].last == grid->nx - 1)
    Unite(f, (PetscInt)row->run[0].piece, (PetscInt)row->run[row->count - 1].piece);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's pieces, and the runs of its first and last row. */
static PetscErrorCode ReadRows(SamGrid grid, Vec field, Forest *f, Row edge[2])
{
  const double *p;
  Row           row = {NULL, 0, 0};

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const Row swap = edge[1];

    PetscCall(ReadRow(grid, p + (ptrdiff_t)j * grid->nx, j, &edge[1], f, &row));
    edge[1] = row;
    row     = swap;
    for (PetscInt k = 0; j == 0 && k < edge[1].count; k++) PetscCall(AddRun(&edge[0], edge[1].run[k]));
  }
  PetscCall(VecRestoreArrayRead(field, &p));
  PetscCall(PetscFree(row.run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- zones that several ranks share ---- */

/*
  What a rank tells of its first and last row: three numbers a run, first, last, and the place of its piece among those
  that are told; then these pieces.
*/
enum { RUN = 3, PIECE = sizeof(Piece) / sizeof(int64_t), HEAD = 3 };

/* Packs that into `told`: numbers of runs in both rows and of pieces, runs, pieces. The rank loses these pieces. */
static PetscErrorCode Pack(Forest *f, const Row edge[2], int64_t **told, PetscMPIInt *count)
{
  const PetscInt runs = edge[0].count + edge[1].count;
  PetscInt      *place, pieces = 0;
  int64_t       *out;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(f->count, &place));
  for (PetscInt k = 0; k < f->count; k++) place[k] = -1;
  PetscCall(PetscMalloc1(HEAD + runs * (RUN + PIECE), &out));
  for (PetscInt r = 0; r < runs; r++) {
    const Run     *run  = r < edge[0].count ? &edge[0].run[r] : &edge[1].run[r - edge[0].count];
    const PetscInt root = Find(f, (PetscInt)run->piece);
    int64_t       *to   = out + HEAD + RUN * r;

    if (place[root] < 0) {
      place[root] = pieces++;
      PetscCall(PetscMemcpy(out + HEAD + RUN * runs + PIECE * place[root], &f->piece[root], sizeof(Piece)));
      f->piece[root].cells = 0;
    }
    to[0] = run->first;
    to[1] = run->last;
    to[2] = place[root];
  }
  out[0] = edge[0].count;
  out[1] = edge[1].count;
  out[2] = pieces;
  PetscCall(PetscFree(place));
  PetscCall(PetscMPIIntCast(HEAD + RUN * runs + PIECE * pieces, count));
  *told = out;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On rank 0: unites what the ranks that have rows, the first ones, have told. */
static PetscErrorCode UniteRanks(Forest *all, PetscMPIInt ranks, const int64_t told[], const PetscMPIInt start[])
{
  Row first = {NULL, 0, 0}, last = {NULL, 0, 0};

  PetscFunctionBegin;
  for (PetscMPIInt rank = 0; rank < ranks; rank++) {
    const int64_t *in   = told + start[rank];
    const PetscInt ones = (PetscInt)in[0], runs = ones + (PetscInt)in[1], base = all->count;
    Row            row = {NULL, 0, 0};
    PetscInt       index;

    for (PetscInt k = 0; k < (PetscInt)in[2]; k++) {
      Piece piece;

      PetscCall(PetscMemcpy(&piece, in + HEAD + RUN * runs + PIECE * k, sizeof(piece)));
      PetscCall(AddPiece(all, &piece, &index));
    }
    for (PetscInt r = 0; r < runs; r++) {
      const int64_t *run = in + HEAD + RUN * r;

      PetscCall(AddRun(&row, (Run){run[0], run[1], base + run[2]}));
    }
    Join(all, last.run, last.count, row.run, ones);
    last.count = 0;
    for (PetscInt r = 0; rank == 0 && r < ones; r++) PetscCall(AddRun(&first, row.run[r]));
    for (PetscInt r = ones; r < runs; r++) PetscCall(AddRun(&last, row.run[r]));
    PetscCall(PetscFree(row.run));
  }
  if (all->wrap) Join(all, last.run, last.count, first.run, first.count);
  PetscCall(PetscFree(first.run));
  PetscCall(PetscFree(last.run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shared zones, on rank 0; the rank's own forest loses their pieces. */
static PetscErrorCode Share(SamGrid grid, Forest *own, const Row edge[2], Forest *shared)
{
  const MPI_Comm comm = grid->comm;
  PetscMPIInt    rank, size, ranks = 0, count, *counts = NULL, *start = NULL;
  int64_t       *told = NULL, *all = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1 && own->wrap) Join(own, edge[1].run, edge[1].count, edge[0].run, edge[0].count);
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt begin = 0, end = 1; ranks < size && end > begin; ranks += end > begin)
    SamGridRowsOf(grid, size, ranks, &begin, &end);
  PetscCall(Pack(own, edge, &told, &count));
  if (rank == 0) PetscCall(PetscMalloc2(size, &counts, size + 1, &start));
  PetscCallMPI(MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, comm));
  if (rank == 0) {
    start[0] = 0;
    for (PetscMPIInt k = 0; k < size; k++) start[k + 1] = start[k] + counts[k];
    PetscCall(PetscMalloc1(start[size], &all));
  }
  PetscCallMPI(MPI_Gatherv(told, count, MPI_INT64_T, all, counts, start, MPI_INT64_T, 0, comm));
  if (rank == 0) PetscCall(UniteRanks(shared, ranks, all, start));
  if (rank == 0) PetscCall(PetscFree2(counts, start));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(told));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all of it ---- */

/* Counts the cells of whole zones by their width, to a tenth of a cell: cells[w] in zones of w/10 cells across. */
static void Count(Forest *f, PetscInt widths, double cells[])
{
  for (PetscInt k = 0; k < f->count; k++) {
    if (f->parent[k] != k || !f->piece[k].cells) continue;
    cells[PetscMin(widths, PetscMax(1, (PetscInt)floor(10 * Across(&f->piece[k]) + 0.5)))] += (double)f->piece[k].cells;
  }
}

/* This rank's zones, and on rank 0 those of several ranks. */
static PetscErrorCode FindZones(SamGrid grid, Vec field, PetscBool wrap, Forest *own, Forest *shared)
{
  Row edge[2] = {{NULL, 0, 0}, {NULL, 0, 0}};

  PetscFunctionBegin;
  *own = *shared = (Forest){.wrap = wrap};
  PetscCall(ReadRows(grid, field, own, edge));
  PetscCall(Share(grid, own, edge, shared));
  for (int k = 0; k < 2; k++) PetscCall(PetscFree(edge[k].run));
  PetscFunctionReturn(PETSC_SUCCESS);
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
  Forest f[2];
  double sum = 0;

  PetscFunctionBegin;
  PetscCall(FindZones(grid, field, wrap, &f[0], &f[1]));
  for (int k = 0; k < 2; k++)
    for (PetscInt z = 0; z < f[k].count; z++)
      if (f[k].parent[z] == z && f[k].piece[z].cells) sum += 1;
  PetscCall(SamSum(grid->comm, 1, &sum));
  *zones = (PetscInt)sum;
  for (int k = 0; k < 2; k++) PetscCall(DestroyForest(&f[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridMeasureZones(SamGrid grid, Vec field, PetscReal part, PetscReal *across)
{
  const PetscInt widths = 10 * PetscMax(grid->nx, grid->ny);
  double        *cells, sum = 0, narrow = 0;
  Forest         own, shared;
  PetscInt       w = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(widths + 1, &cells));
  PetscCall(FindZones(grid, field, PETSC_FALSE, &own, &shared));
  Count(&own, widths, cells);
  Count(&shared, widths, cells);
  PetscCall(SamSum(grid->comm, widths + 1, cells)); /* of whole numbers: exact */
  for (PetscInt k = 1; k <= widths; k++) sum += cells[k];
  while (w < widths && (w == 0 || narrow <= (double)part * sum)) narrow += cells[++w];
  *across = sum > 0 ? 0.1 * (PetscReal)w : 0;
  PetscCall(DestroyForest(&own));
  PetscCall(DestroyForest(&shared));
  PetscCall(PetscFree(cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Numbers of rough contact: its spots, and the mean gap.

  A spot is a zone of cells in contact that are connected by their sides. Within a rank, the runs of cells in contact of
  each row are joined with those of the row before that they touch (Hoshen and Kopelman 1976, Phys. Rev. B 14, 3438,
  with runs for cells). Rank 0 gets the runs of each rank's first and last row and joins them over the ranks' borders.
*/
#include "contactimpl.h"

/* Cells first ... end - 1 of a row. Runs of a spot are a tree; the root is its own parent. */
typedef struct {
  PetscInt64 first, end, parent;
} Run;

static PetscInt64 Root(Run runs[], PetscInt64 k)
{
  while (runs[k].parent != k) k = runs[k].parent = runs[runs[k].parent].parent;
  return k;
}

/* Whether two runs were of different spots. */
static PetscInt64 Join(Run runs[], PetscInt64 a, PetscInt64 b)
{
  const PetscInt64 one = Root(runs, a), other = Root(runs, b);

  runs[PetscMax(one, other)].parent = PetscMin(one, other);
  return one != other;
}

/* Joins runs a ... a_end - 1 of a row with those of the next one, in order; returns how many spots fewer there are. */
static PetscInt64 JoinRows(Run runs[], PetscInt64 a, PetscInt64 a_end, PetscInt64 b, PetscInt64 b_end)
{
  PetscInt64 fewer = 0;

  while (a < a_end && b < b_end) {
    if (runs[a].first < runs[b].end && runs[b].first < runs[a].end) fewer += Join(runs, a, b);
    if (runs[a].end < runs[b].end)
      a++;
    else
      b++;
  }
  return fewer;
}

/* ---- on each rank ---- */

/* The runs of this rank; row j has those from start[j] on. */
static PetscErrorCode FindRuns(SamGrid grid, const double p[], Run **runs, PetscInt64 start[])
{
  const PetscInt nx = grid->nx;
  PetscInt64     n  = 0;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < nx; i++) n += p[(ptrdiff_t)j * nx + i] > 0 && !(i && p[(ptrdiff_t)j * nx + i - 1] > 0);
  PetscCall(PetscMalloc1(n, runs));
  n = 0;
  for (PetscInt j = 0; j < grid->rows; j++) {
    const double *row = p + (ptrdiff_t)j * nx;

    start[j] = n;
    for (PetscInt i = 0; i < nx; i++) {
      if (row[i] > 0 && !(i && row[i - 1] > 0)) (*runs)[n] = (Run){.first = i, .parent = n};
      if (row[i] > 0 && !(i + 1 < nx && row[i + 1] > 0)) (*runs)[n++].end = i + 1;
    }
  }
  start[grid->rows] = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The number of spots within this rank. With `wrap` those at both ends of a row are one. */
static PetscInt64 JoinOwn(SamGrid grid, PetscBool wrap, Run runs[], const PetscInt64 start[])
{
  PetscInt64 spots = start[grid->rows];

  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscInt64 first = start[j], last = start[j + 1] - 1;

    if (j) spots -= JoinRows(runs, start[j - 1], first, first, last + 1);
    if (wrap && last > first && runs[first].first == 0 && runs[last].end == grid->nx) spots -= Join(runs, first, last);
  }
  return spots;
}

/* ---- over the borders of the ranks ---- */

enum { SPOTS, FIRST, LAST, COUNTS }; /* of a rank: its spots, and the runs that it tells of its first and last row */

/* The runs of the first and of the last row; their parents are places in this list. */
static PetscErrorCode Tell(SamGrid grid, Run runs[], const PetscInt64 start[], PetscInt64 told[COUNTS], Run **list)
{
  const PetscInt64 n = start[grid->rows], last = grid->rows ? start[grid->rows - 1] : 0;
  PetscInt64      *place, count                = 0;

  PetscFunctionBegin;
  told[FIRST] = grid->rows ? start[1] : 0;
  told[LAST]  = n - last;
  PetscCall(PetscMalloc1(told[FIRST] + told[LAST], list));
  PetscCall(PetscMalloc1(n, &place));
  for (PetscInt64 k = 0; k < n; k++) place[k] = -1;
  for (PetscInt64 k = 0; k < told[FIRST] + told[LAST]; k++) {
    const PetscInt64 run = k < told[FIRST] ? k : last + k - told[FIRST], root = Root(runs, run);

    if (place[root] < 0) place[root] = count;
    (*list)[count++] = (Run){runs[run].first, runs[run].end, place[root]};
  }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The number of spots of all ranks, from what they told. With `wrap` the last row touches the first one. */
static PetscInt64 JoinAll(PetscMPIInt ranks, PetscBool wrap, const PetscInt64 told[], Run runs[])
{
  PetscInt64 spots = 0, at = 0, before[2] = {0, 0}, first[2] = {0, 0};

  for (PetscMPIInt r = 0; r < ranks; r++) {
    const PetscInt64 *t = told + COUNTS * r, last = at + t[FIRST], end = last + t[LAST];

    for (PetscInt64 k = at; k < end; k++) runs[k].parent += at;
    spots += t[SPOTS];
    if (r) spots -= JoinRows(runs, before[0], before[1], at, last);
    if (!r) first[1] = last;
    before[0] = last;
    before[1] = end;
    at        = end;
  }
  return wrap ? spots - JoinRows(runs, before[0], before[1], first[0], first[1]) : spots;
}

/* Ranks without rows come last, and tell nothing. */
static PetscErrorCode CountRanksWithRows(SamGrid grid, PetscMPIInt *ranks)
{
  PetscMPIInt some = grid->rows > 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(&some, ranks, 1, MPI_INT, MPI_SUM, grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Gather(SamGrid grid, PetscBool wrap, const PetscInt64 told[COUNTS], const Run own[],
                             double *spots)
{
  PetscMPIInt size, rank, ranks, *counts, *starts, total = 0;
  PetscInt64 *all;
  Run        *runs;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(CountRanksWithRows(grid, &ranks));
  PetscCall(PetscMalloc3(size, &counts, size, &starts, COUNTS * size, &all));
  PetscCallMPI(MPI_Allgather(told, COUNTS, MPIU_INT64, all, COUNTS, MPIU_INT64, grid->comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    starts[r] = total;
    counts[r] = (PetscMPIInt)(3 * (all[COUNTS * r + FIRST] + all[COUNTS * r + LAST]));
    total += counts[r];
  }
  PetscCall(PetscMalloc1(total / 3, &runs));
  PetscCallMPI(MPI_Gatherv(own, counts[rank], MPIU_INT64, runs, counts, starts, MPIU_INT64, 0, grid->comm));
  *spots = rank ? 0 : (double)JoinAll(ranks, wrap, all, runs);
  PetscCallMPI(MPI_Bcast(spots, 1, MPI_DOUBLE, 0, grid->comm));
  PetscCall(PetscFree(runs));
  PetscCall(PetscFree3(counts, starts, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactCountSpots(SamContact c, PetscReal *spots)
{
  const PetscBool wrap = c->traits.rotations ? PETSC_FALSE : PETSC_TRUE; /* bodies that cannot rotate are periodic */
  const double   *p;
  double          found = 0;
  PetscInt64     *start, told[COUNTS];
  Run            *runs, *list;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(c->grid->rows + 1, &start));
  PetscCall(VecGetArrayRead(c->tried.solution.pressure, &p));
  PetscCall(FindRuns(c->grid, p, &runs, start));
  PetscCall(VecRestoreArrayRead(c->tried.solution.pressure, &p));
  told[SPOTS] = JoinOwn(c->grid, wrap, runs, start);
  PetscCall(Tell(c->grid, runs, start, told, &list));
  PetscCall(Gather(c->grid, wrap, told, list, &found));
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(runs));
  PetscCall(PetscFree(list));
  *spots = (PetscReal)found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the mean gap ---- */

PetscErrorCode SamContactMeanGap(SamContact c, PetscReal *mean)
{
  const SamGrid grid  = c->grid;
  SamTotal      total = {0};
  const double *g;
  double        sum;
  Vec           gap;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &gap));
  PetscCall(SamSolutionComputeGap(c->problem, &c->tried.solution, gap));
  PetscCall(VecGetArrayRead(gap, &g));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < grid->nx; i++) row += g[(ptrdiff_t)j * grid->nx + i];
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(gap, &g));
  PetscCall(VecDestroy(&gap));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &sum));
  *mean = sum / ((PetscReal)grid->nx * (PetscReal)grid->ny);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The start of a step from the same step one cycle before.

  In a load history that repeats itself, the change of the shear from one step to the next approaches that of one cycle
  before. So a step starts from q = q_now + (q_k - q_(k-1)), where k is the step of the cycle before; sticking cells
  stay stuck in this start. Its product C q is the committed displacement plus the stored change of displacement in step
  k, so the start costs no application of the operator. While the cycle does not repeat exactly, q may leave its discs a
  little; the solver's first trial then goes to the nearest admissible shear (newton.c). If the error of the start is
  too large, the start of predict.c replaces it.

  Friction of similar bodies is odd: if all causes of shear are reversed, the change of the shear is reversed, too. So
  under the same normal loads the second half of a symmetric cycle repeats the first half with opposite signs, and k is
  a step of the previous half cycle.

  Before the cycle repeats exactly, the changes differ from their limit by parts that shrink by nearly the same factor m
  per repetition; m < 0 for parts that do not change sign at a reversal. So with the last two repetitions, D and the
  older D', the combination w D + (1 - w) D' with w = 1 + m is much nearer to the limit than D. w is fitted to the
  changes of the last step.

  Where the direction of slip turns, the part t of the slip that the shear does not oppose (direction.c) is kept too. It
  repeats like the shear, and is computed anew from each solution. So a step needs no solution to find it, and is solved
  once where the t of two repetitions has led to nearly the same t.

  Of coupled bodies pressure and shear of step k are a guess of both, once the cycle has been repeated; before that the
  extrapolation is as good.

  If the pressure does not depend on the shear, this step has the pressure of step k when the prescribed normal values
  and the gap are the same (SamControlSnap() has removed differences by rounding). Gaps are compared by a number that
  grows with each change of the gap: when the problem's revision changes, or a field of the state that is declared as
  part of the separation.

  A step is recognised by the values that it and the step before it prescribe, not by its number. It replaces the second
  last step that it repeats, or the last one if the memory is full. When the memory is full, a step that repeats none
  replaces the oldest step, and a step without a stored counterpart is not stored. So if a cycle does not fit, a part of
  it is stored and used in every repetition. Changes are stored on the contact's part of each row, as integers in units
  of 2^-30 of their largest value, four times as accurate as floats of the same size. All decisions depend on global
  numbers only, so they are the same on any number of ranks. The memory limit of a cache depends on the grid only, and
  checkpoints contain the whole cache (io/kept.c). So a restarted run has the same bits, on any machine.

  The data that are the same on all ranks form one table: first a row of the cache, then one row per step, oldest first.
*/
#include <petsam/private/stepcache.h>
#include <math.h>
#include <petsam/private/tangentialimpl.h>
#include <petsam/private/balance.h>

/* Length of the history of prescriptions that is searched for a repetition; half of it when the table is full. */
#define STEPS 1024
/* Prescribed numbers are the same if they differ by less, relative to the largest of their kind so far. */
#define SAME 1e-9
/* Columns by which the stored part of a row exceeds the contact, which may grow by a cell */
#define MARGIN 1
/*
  An upper bound of the influence of a single cell's shear on all others, in units of the self-influence: of a cell of a
  surface, and of one of n cells in a row over the root of n, as it falls with the logarithm of the distance only.
*/
#define SPREAD 4
#define ALONG  0.6
#define UNITS  1073741824.0
/* Least and largest weight of the last of two repetitions. */
#define LEAST_WEIGHT (-1.0)
#define MOST_WEIGHT  2.0

/* The default memory of a cache in fields of the grid, and its limits in bytes */
#define USUAL_FIELDS 20
#define USUAL_LEAST  48e6
#define USUAL_MOST   1e9

/* ---- what is kept ---- */

/* The stored changes of a step: of the shear, of its product, and, where the direction of slip turns, the slip that the
   shear at the end does not oppose */
enum { SHEAR_X, SHEAR_Y, PRODUCT_X, PRODUCT_Y, STRAIGHT, TURN_X = STRAIGHT, TURN_Y, TURNING };

/* The numbers in the row of a step, after the values that it prescribes */
enum {
  CELLS,        /* number of stored cells on all ranks; 0: nothing is stored */
  CHANGES,      /* number of stored changes: STRAIGHT or TURNING */
  UNIT_SHEAR,   /* of the stored changes (Pa) */
  UNIT_PRODUCT, /* (m) */
  UNIT_TURN,    /* (m) */
  GAP,          /* number of the gap for which the pressure was solved; -1: the gap has moved since */
  PRESSURE,     /* 1: a pressure is stored; 0: it is that of the step before */
  RTOL,         /* tolerance of the normal solver */
  LOAD,         /* first of the normal loads and rigid displacements */
  RIGID = LOAD + 3,
  KEPT  = RIGID + 3
};
/* The numbers in the cache's own row, after the largest size of each prescribed number */
enum {
  WEIGHT, /* of the last of two repetitions; the weight that was best in the last step */
  GAP_NOW /* the number of the gap after the last step; each change of the gap increases it */
};

/* Length of a control as a row of numbers: the components, how each one is given, and the conditions */
#define MOST_NUMBERS (2 * SAM_COMPONENTS + SAM_CONDITIONS)

/* A stored step from which the next step is predicted: its row, and the sign and weight of its changes */
typedef struct {
  PetscInt      row; /* 0: none */
  double        sign, weight;
  double       *numbers;
  SamStepFields fields;
} Part;

struct _n_SamCachedStep {
  Part     part[2]; /* the last repetition, and the one before it */
  double   gap;     /* the number of the gap after the last step */
  PetscInt count;   /* of numbers that precede those of a part */
};

struct _n_SamStepCache {
  SamGrid        grid;
  SamConditions  conditions;
  double         limit, bytes; /* on all ranks */
  PetscInt       numbers;      /* count of prescribed numbers */
  PetscInt       count;        /* count of steps; the last step is in this row */
  double        *table;        /* (STEPS + 1) rows; NULL until the first step */
  SamStepFields *fields;       /* of each row; NULL: nothing is kept */
  SamCachedStep  start;        /* what the last search found */
};

static PetscInt Width(SamStepCache r)
{
  return r->numbers + KEPT;
}

static double *Row(SamStepCache r, PetscInt k)
{
  return r->table + k * Width(r);
}

/* Returns a number of a row that is not prescribed. */
static double *At(SamStepCache r, PetscInt k, PetscInt number)
{
  return Row(r, k) + r->numbers + number;
}

static PetscInt CountNumbers(SamStepCache r)
{
  return SAM_COMPONENTS + SamControlCount(r->conditions);
}

static double BytesOf(SamStepCache r, const double row[])
{
  const double *kept = row + r->numbers;

  if (kept[CELLS] == 0) return 0;
  return kept[CELLS] * (kept[CHANGES] * sizeof(int32_t) + (kept[PRESSURE] > 0 ? sizeof(double) : 0)) +
         2 * sizeof(int32_t) * (double)r->grid->ny;
}

static void DestroyFields(SamStepFields *fields)
{
  const SamStepFields f = *fields;

  *fields = NULL;
  if (!f || --f->references > 0) return;
  SamFree(f->range);
  SamFree(f->change);
  SamFree(f->pressure);
  SamFree(f);
}

/* Deletes the stored fields of a step. */
static void Drop(SamStepCache r, PetscInt k)
{
  r->bytes -= BytesOf(r, Row(r, k));
  *At(r, k, CELLS) = 0;
  DestroyFields(&r->fields[k]);
}

PetscErrorCode SamStepCacheCreate(SamGrid grid, SamConditions conditions, SamStepCache *cache)
{
  PetscFunctionBegin;
  PetscCall(SamAllocateZeros(sizeof(**cache), cache));
  PetscCall(SamAllocateZeros(sizeof(*(*cache)->start), &(*cache)->start));
  (*cache)->grid       = grid;
  (*cache)->conditions = conditions;
  (*cache)->limit      = (double)SamStepCacheUsual(grid);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepCacheCreateLike(SamStepCache r, SamStepCache *other)
{
  PetscFunctionBegin;
  PetscCall(SamStepCacheCreate(r->grid, r->conditions, other));
  (*other)->limit = r->limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamStepCacheForget(SamStepCache r)
{
  for (PetscInt k = 1; k <= r->count; k++) DestroyFields(&r->fields[k]);
  SamFree(r->table);
  SamFree(r->fields);
  r->table  = NULL;
  r->fields = NULL;
  r->count  = 0;
  r->bytes  = 0;
  *r->start = (struct _n_SamCachedStep){.part = {{0}}};
}

void SamStepCacheDestroy(SamStepCache *cache)
{
  if (!*cache) return;
  SamStepCacheForget(*cache);
  SamFree((*cache)->start);
  SamFree(*cache);
  *cache = NULL;
}

PetscReal SamStepCacheUsual(SamGrid grid)
{
  const double fields = USUAL_FIELDS * sizeof(double) * (double)grid->nx * (double)grid->ny;

  return PetscMin(PetscMax(fields, USUAL_LEAST), USUAL_MOST);
}

void SamStepCacheSetMemory(SamStepCache r, PetscReal bytes)
{
  r->limit = (double)bytes;
  if (r->bytes > r->limit || r->limit == 0) SamStepCacheForget(r);
}

/* Creates the table before the first step, with the present count of numbers. */
static PetscErrorCode MakeTable(SamStepCache r)
{
  PetscFunctionBegin;
  if (r->table) PetscFunctionReturn(PETSC_SUCCESS);
  r->numbers = CountNumbers(r);
  PetscCall(SamAllocateZeros(sizeof(*r->table) * (size_t)((STEPS + 1) * Width(r)), &r->table));
  PetscCall(SamAllocateZeros(sizeof(SamStepFields) * (STEPS + 1), &r->fields));
  *At(r, 0, WEIGHT) = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepCacheCopy(SamStepCache from, SamStepCache to)
{
  PetscFunctionBegin;
  SamStepCacheForget(to);
  if (!from->table) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStepCacheSetTable(to, from->count + 1, Width(from), from->table));
  for (PetscInt k = 1; k <= to->count; k++) {
    to->fields[k] = from->fields[k];
    if (to->fields[k]) to->fields[k]->references++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamStepCacheKeeps(SamStepCache r)
{
  return r->limit > 0;
}

/* ---- access for checkpoints ---- */

void SamStepCacheGetTable(SamStepCache r, PetscInt *rows, PetscInt *width, double **table)
{
  *rows  = r->table ? r->count + 1 : 0;
  *width = r->table ? Width(r) : 0;
  *table = r->table;
}

PetscErrorCode SamStepCacheSetTable(SamStepCache r, PetscInt rows, PetscInt width, const double table[])
{
  PetscFunctionBegin;
  SamStepCacheForget(r);
  if (r->limit == 0 || rows < 1 || rows > STEPS + 1 || width != CountNumbers(r) + KEPT)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MakeTable(r));
  PetscCall(PetscArraycpy(r->table, table, rows * width));
  r->count = rows - 1;
  for (PetscInt k = 1; k <= r->count; k++) r->bytes += BytesOf(r, Row(r, k));
  if (r->bytes > r->limit) SamStepCacheForget(r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamStepFields SamStepCacheGetFields(SamStepCache r, PetscInt row)
{
  return r->fields[row];
}

PetscInt SamStepCacheCells(SamStepCache r, PetscInt row, PetscInt *changes, PetscBool *pressure)
{
  *changes  = (PetscInt)*At(r, row, CHANGES);
  *pressure = *At(r, row, PRESSURE) > 0 ? PETSC_TRUE : PETSC_FALSE;
  return (PetscInt)*At(r, row, CELLS);
}

PetscErrorCode SamStepCacheAddFields(SamStepCache r, PetscInt row, const int32_t range[], SamStepFields *fields)
{
  const PetscInt rows = r->grid->rows;
  SamStepFields  f;

  PetscFunctionBegin;
  PetscCall(SamAllocateZeros(sizeof(*f), &f));
  f->references  = 1;
  f->changes     = (PetscInt)*At(r, row, CHANGES);
  r->fields[row] = *fields = f;
  PetscCall(SamAllocate(sizeof(*range) * (size_t)(2 * rows), &f->range));
  PetscCall(PetscArraycpy(f->range, range, 2 * rows));
  for (PetscInt j = 0; j < rows; j++) f->cells += range[2 * j + 1] - range[2 * j];
  PetscCall(SamAllocate(sizeof(int32_t) * (size_t)(f->changes * f->cells + 1), &f->change));
  if (*At(r, row, PRESSURE) > 0) PetscCall(SamAllocate(sizeof(double) * (size_t)(f->cells + 1), &f->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- finding a repeated step ---- */

/* Gets the numbers of a control except its time. */
static void GetNumbers(SamStepCache r, const SamControl *control, double numbers[MOST_NUMBERS])
{
  const PetscInt parts = SamControlCount(r->conditions);

  for (PetscInt k = 0; k < parts; k++) numbers[k] = SamControlPart(control, r->conditions, k);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) numbers[parts + k] = SamControlWay(control, k);
}

/* Copies the numbers of a control with all causes of shear reversed. */
static void Reverse(SamStepCache r, const double numbers[MOST_NUMBERS], double reversed[MOST_NUMBERS])
{
  memcpy(reversed, numbers, sizeof(*numbers) * (size_t)r->numbers);
  for (PetscInt k = 0; k < 3; k++) reversed[SamComponentsOf[SAM_BALANCE_TANGENTIAL][k]] *= -1;
  for (PetscInt k = 0; k < SamConditionsCount(r->conditions); k++)
    if (SamConditionsGet(r->conditions, k)->reverses) reversed[SAM_COMPONENTS + k] *= -1;
}

static PetscBool IsSame(PetscInt count, const double a[], const double b[], const double largest[])
{
  for (PetscInt k = 0; k < count; k++)
    if (fabs(a[k] - b[k]) > SAME * largest[k]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The controls of a step and of the step before it, and their reverses, and the scales of the numbers */
typedef struct {
  double to[2][MOST_NUMBERS], from[2][MOST_NUMBERS], largest[MOST_NUMBERS];
  int    ways; /* 2: also the reverses */
} Sought;

/* Returns 1 if the step in this row and the step before it repeat the sought ones, -1 if reversed, 0 if not. */
static int Compare(SamStepCache r, const Sought *s, PetscInt row)
{
  for (int way = 0; way < s->ways; way++)
    if (IsSame(r->numbers, Row(r, row), s->to[way], s->largest) &&
        IsSame(r->numbers, Row(r, row - 1), s->from[way], s->largest))
      return way ? -1 : 1;
  return 0;
}

void SamStepCacheFind(SamStepCache r, const SamControl *next, PetscBool odd, SamCachedStep *kept)
{
  const SamCachedStep start = r->start;
  Part *const         part  = start->part;
  Sought              s;

  *kept  = NULL;
  *start = (struct _n_SamCachedStep){.part = {{0}}};
  if (r->table && r->numbers != CountNumbers(r)) SamStepCacheForget(r);
  if (!r->table) return;
  s.ways = odd ? 2 : 1;
  GetNumbers(r, next, s.to[0]);
  Reverse(r, s.to[0], s.to[1]);
  memcpy(s.from[0], Row(r, r->count), sizeof(double) * (size_t)r->numbers);
  Reverse(r, s.from[0], s.from[1]);
  for (PetscInt k = 0; k < r->numbers; k++) s.largest[k] = PetscMax(Row(r, 0)[k], fabs(s.to[0][k]));
  for (PetscInt row = r->count, n = 0; row > 1 && n < 2; row--) {
    const int sign = Compare(r, &s, row);

    if (sign) part[n++] = (Part){row, sign, 1, Row(r, row) + r->numbers, r->fields[row]};
  }
  if (!part[0].fields) return;
  if (part[1].fields && part[1].numbers[GAP] != part[0].numbers[GAP]) part[1].fields = NULL; /* another gap */
  if (part[1].fields) part[0].weight = *At(r, 0, WEIGHT);
  part[1].weight = 1 - part[0].weight;
  start->gap     = *At(r, 0, GAP_NOW);
  start->count   = r->numbers;
  *kept          = start;
}

/* ---- keeping ---- */

/* Returns the largest change of n values. */
SAM_VECTORIZED static double LargestChange(PetscInt n, const double before[], const double now[])
{
  double most = 0;

#pragma omp simd reduction(max : most)
  for (PetscInt i = 0; i < n; i++) {
    const double change = fabs(now[i] - before[i]);

    most = change > most ? change : most;
  }
  return most;
}

SAM_VECTORIZED static void StoreChange(PetscInt n, const double before[], const double now[], double scale,
                                       int32_t *restrict to)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) to[i] = (int32_t)rint((now[i] - before[i]) * scale);
}

/* Stores the changes of both components of a field from `before` (NULL: from 0) to `now`, in units of their
   largest. */
static PetscErrorCode KeepChange(SamStepCache r, SamStepFields f, Vec before, Vec now, PetscInt first, double *unit)
{
  const SamGrid grid = r->grid;
  const double *a    = NULL, *b;
  double       *zeros, most = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(grid->nx, &zeros));
  if (before) PetscCall(VecGetArrayRead(before, &a));
  PetscCall(VecGetArrayRead(now, &b));
  for (PetscInt pass = 0; pass < 2; pass++) {
    const double scale = most > 0 ? UNITS / most : 0;

    for (PetscInt c = 0; c < 2; c++) {
      int32_t *to = f->change + (first + c) * f->cells;

      for (PetscInt j = 0; j < grid->rows; j++) {
        const PetscInt  n    = f->range[2 * j + 1] - f->range[2 * j];
        const ptrdiff_t at   = c * (ptrdiff_t)grid->cells + (ptrdiff_t)j * grid->nx + f->range[2 * j];
        const double   *from = a ? a + at : zeros;

        if (pass == 0)
          most = PetscMax(most, LargestChange(n, from, b + at));
        else
          StoreChange(n, from, b + at, scale, to);
        to += n;
      }
    }
    if (pass == 0) PetscCall(SamMax(grid->comm, 1, &most));
  }
  *unit = most / UNITS;
  PetscCall(VecRestoreArrayRead(now, &b));
  if (before) PetscCall(VecRestoreArrayRead(before, &a));
  PetscCall(PetscFree(zeros));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Widens a part of a row to include all cells where either of two bounds is not zero, and the margin. */
static void Widen(PetscInt nx, const double one[], const double other[], int32_t range[2])
{
  PetscInt first, last;

  SamBoundRangeOfBoth(nx, one, other, &first, &last);
  if (first == last) return;
  first    = PetscMax(first - MARGIN, 0);
  last     = PetscMin(last + MARGIN, nx);
  range[0] = (int32_t)(range[0] < range[1] ? PetscMin(first, range[0]) : first);
  range[1] = (int32_t)PetscMax(last, range[1]);
}

/* Finds the parts of the rows under the bounds, and under the pressure if it is stored; returns the number of all
   cells. */
static PetscErrorCode FindRanges(SamStepCache r, const SamSolution *before, const SamSolution *now, PetscBool pressure,
                                 int32_t range[], double *cells)
{
  const SamGrid grid = r->grid;
  const double *a, *b, *p;

  PetscFunctionBegin;
  *cells = 0;
  PetscCall(VecGetArrayRead(before->bound, &a));
  PetscCall(VecGetArrayRead(now->bound, &b));
  PetscCall(VecGetArrayRead(now->pressure, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t row = (ptrdiff_t)j * grid->nx;

    range[2 * j] = range[2 * j + 1] = 0;
    Widen(grid->nx, a + row, b + row, range + 2 * j);
    if (pressure) Widen(grid->nx, p + row, p + row, range + 2 * j);
    *cells += range[2 * j + 1] - range[2 * j];
  }
  PetscCall(VecRestoreArrayRead(now->pressure, &p));
  PetscCall(VecRestoreArrayRead(now->bound, &b));
  PetscCall(VecRestoreArrayRead(before->bound, &a));
  PetscCall(SamSum(grid->comm, 1, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the cache within its limit: drops the oldest steps, or the step `found` that the last step repeats, or the last
   step. */
static void MakeRoom(SamStepCache r, PetscInt found)
{
  r->bytes += BytesOf(r, Row(r, r->count));
  for (PetscInt k = 1; !found && k < r->count && r->bytes > r->limit; k++)
    if (r->fields[k]) Drop(r, k);
  if (found && r->bytes > r->limit) Drop(r, found);
  if (r->bytes > r->limit) Drop(r, r->count);
}

static PetscErrorCode KeepPressure(SamStepCache r, SamStepFields f, const SamSolution *now)
{
  const SamGrid grid = r->grid;
  const double *p;
  double       *to = f->pressure;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) {
    *At(r, r->count, LOAD + c)  = now->load[SamComponentsOf[SAM_BALANCE_NORMAL][c]];
    *At(r, r->count, RIGID + c) = now->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][c]];
  }
  PetscCall(VecGetArrayRead(now->pressure, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscInt n = f->range[2 * j + 1] - f->range[2 * j];

    PetscCall(PetscArraycpy(to, p + (ptrdiff_t)j * grid->nx + f->range[2 * j], n));
    to += n;
  }
  PetscCall(VecRestoreArrayRead(now->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a kept change to row j, whose part begins at n. */
static void AddRow(const Part *part, double weight, PetscInt component, PetscInt j, ptrdiff_t n, double to[])
{
  const SamStepFields f      = part->fields;
  const int32_t      *change = f->change + component * (ptrdiff_t)f->cells + n;
  const double        unit   = weight * part->sign * part->numbers[UNIT_SHEAR + component / 2];

  for (PetscInt i = f->range[2 * j]; i < f->range[2 * j + 1]; i++) to[i] += unit * (double)*change++;
}

static PetscInt CellsInRow(const Part *part, PetscInt j)
{
  return part->fields->range[2 * j + 1] - part->fields->range[2 * j];
}

/*
  Computes the weight for which the combination of the two stored steps is nearest to the shear's change from `before`
  to `now`.
*/
static PetscErrorCode FindWeight(SamStepCache r, Vec before, Vec now, double *weight)
{
  const Part *const part      = r->start->part;
  const PetscInt    nx        = r->grid->nx;
  SamTotal          totals[2] = {{0}};
  const double     *a, *b;
  double           *row, sums[2];
  ptrdiff_t         at[2] = {0, 0};

  PetscFunctionBegin;
  *weight = 1;
  if (!part[0].fields || !part[1].fields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * nx, &row));
  PetscCall(VecGetArrayRead(before, &a));
  PetscCall(VecGetArrayRead(now, &b));
  for (PetscInt j = 0; j < r->grid->rows; j++) {
    double both[2] = {0, 0};

    for (PetscInt c = SHEAR_X; c <= SHEAR_Y; c++) {
      const ptrdiff_t cell = c * (ptrdiff_t)r->grid->cells + (ptrdiff_t)j * nx;

      PetscCall(PetscArrayzero(row, 2 * nx));
      AddRow(&part[1], 1, c, j, at[1], row);
      AddRow(&part[0], 1, c, j, at[0], row + nx);
      for (PetscInt i = 0; i < nx; i++) {
        const double way = row[nx + i] - row[i];

        both[0] += way * (b[cell + i] - a[cell + i] - row[i]);
        both[1] += way * way;
      }
    }
    SamAddAll(2, totals, both);
    for (int n = 0; n < 2; n++) at[n] += CellsInRow(&part[n], j);
  }
  PetscCall(VecRestoreArrayRead(now, &b));
  PetscCall(VecRestoreArrayRead(before, &a));
  PetscCall(PetscFree(row));
  PetscCall(SamSumTotals(r->grid->comm, 2, totals, sums));
  if (sums[1] > 0) *weight = PetscMin(PetscMax(sums[0] / sums[1], LEAST_WEIGHT), MOST_WEIGHT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Deletes the older half of the steps when the table is full. Returns the number of removed rows. */
static PetscInt MoveTable(SamStepCache r)
{
  const PetscInt gone = r->count == STEPS ? STEPS / 2 : 0;

  for (PetscInt k = 1; k <= gone; k++)
    if (r->fields[k]) Drop(r, k);
  if (!gone) return 0;
  r->count -= gone;
  memmove(Row(r, 1), Row(r, 1 + gone), sizeof(double) * (size_t)(r->count * Width(r)));
  memmove(r->fields + 1, r->fields + 1 + gone, sizeof(SamStepFields) * (size_t)r->count);
  memset(r->fields + 1 + r->count, 0, sizeof(SamStepFields) * (size_t)gone);
  return gone;
}

/* Adds the row of a step, without stored fields. */
static void AddStep(SamStepCache r, const SamControl *control)
{
  double *row;

  r->count++;
  row = Row(r, r->count);
  GetNumbers(r, control, row);
  memset(row + r->numbers, 0, KEPT * sizeof(double));
  for (PetscInt k = 0; k < r->numbers; k++) Row(r, 0)[k] = PetscMax(Row(r, 0)[k], fabs(row[k]));
}

/* Stores the fields of the last step, which repeats the step in row `found` (0: none). */
static PetscErrorCode KeepFields(SamStepCache r, PetscInt found, const SamSolution *before, const SamSolution *now,
                                 Vec turn, PetscBool coupled)
{
  const PetscBool pressure = coupled || !SamControlIsSame(&before->control, &now->control, SAM_BALANCE_NORMAL);
  double *const   numbers  = At(r, r->count, 0);
  int32_t        *range;
  SamStepFields   f;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * r->grid->rows, &range));
  PetscCall(FindRanges(r, before, now, pressure, range, &numbers[CELLS]));
  numbers[PRESSURE] = pressure;
  numbers[CHANGES]  = turn ? TURNING : STRAIGHT;
  MakeRoom(r, found);
  if (numbers[CELLS] > 0) {
    PetscCall(SamStepCacheAddFields(r, r->count, range, &f));
    PetscCall(KeepChange(r, f, before->shear, now->shear, SHEAR_X, &numbers[UNIT_SHEAR]));
    PetscCall(KeepChange(r, f, before->displacement_t, now->displacement_t, PRODUCT_X, &numbers[UNIT_PRODUCT]));
    if (turn) PetscCall(KeepChange(r, f, NULL, turn, TURN_X, &numbers[UNIT_TURN]));
    if (pressure) PetscCall(KeepPressure(r, f, now));
  }
  PetscCall(PetscFree(range));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepCacheKeep(SamStepCache r, const SamSolution *before, const SamSolution *now, Vec turn,
                                const SamStepOf *of)
{
  PetscInt found, older;
  double   weight = 1;

  PetscFunctionBegin;
  if (r->limit == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MakeTable(r));
  if (before) PetscCall(FindWeight(r, before->shear, now->shear, &weight));
  *At(r, 0, WEIGHT) = weight;
  found             = r->start->part[0].row;
  older             = r->start->part[1].row;
  *r->start         = (struct _n_SamCachedStep){.part = {{0}}};
  if (older && r->fields[older]) Drop(r, older);
  found = PetscMax(found - MoveTable(r), 0);
  AddStep(r, &now->control);
  if (!of->same_gap || of->yields) *At(r, 0, GAP_NOW) += 1;
  *At(r, r->count, GAP)  = of->moves ? -1 : *At(r, 0, GAP_NOW);
  *At(r, r->count, RTOL) = (double)of->rtol;
  if (before && before->displacement_t) PetscCall(KeepFields(r, found, before, now, turn, of->coupled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- finding ---- */

PetscBool SamCachedStepHasPressure(SamCachedStep kept, const SamStepOf *of)
{
  const double *numbers = kept ? kept->part[0].numbers : NULL;

  return numbers && numbers[PRESSURE] > 0 && of->same_gap && numbers[GAP] == kept->gap &&
         numbers[RTOL] <= (double)of->rtol;
}

void SamCachedStepGetControl(SamCachedStep kept, SamControl *control)
{
  const double *row = kept->part[0].numbers - kept->count;

  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    control->value[k] = row[k];
    SamControlSetWay(control, k, (SamWay)row[kept->count - SAM_COMPONENTS + k]);
  }
}

PetscErrorCode SamCachedStepGetPressure(SamCachedStep kept, SamGrid grid, SamSolution *s, PetscBool *found)
{
  const Part *const part = &kept->part[0];
  const double     *from = part->fields->pressure;
  double           *p;

  PetscFunctionBegin;
  *found = part->numbers[PRESSURE] > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayWrite(s->pressure, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double        *row = p + (ptrdiff_t)j * grid->nx;
    const PetscInt n   = CellsInRow(part, j);

    PetscCall(PetscArrayzero(row, grid->nx));
    PetscCall(PetscArraycpy(row + part->fields->range[2 * j], from, n));
    from += n;
  }
  PetscCall(VecRestoreArrayWrite(s->pressure, &p));
  for (PetscInt c = 0; c < 3; c++) {
    s->load[SamComponentsOf[SAM_BALANCE_NORMAL][c]]  = part->numbers[LOAD + c];
    s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][c]] = part->numbers[RIGID + c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Removes shear outside of the bound, which comes from rounding or from a change of the contact's edge; its displacement
  nearby counts as rounding. Returns its square. `open`: number of cells under a bound that are outside the stored part
  of their row.
*/
static double TrimRow(PetscInt nx, PetscInt first, PetscInt last, const double bound[], double *qx, double *qy,
                      double *open)
{
  double lost = 0;

  for (PetscInt i = 0; i < nx; i++) {
    if (bound[i] > 0) {
      *open += i < first || i >= last;
      continue;
    }
    lost += qx[i] * qx[i] + qy[i] * qy[i];
    qx[i] = qy[i] = 0;
  }
  return lost;
}

PetscErrorCode SamCachedStepGetShear(SamCachedStep kept, SamElasticity elasticity, const SamSolution *now, Vec bound,
                                     Vec shear, SamProduct *product, PetscBool *found)
{
  PetscReal         self;
  double           *q, *u, open = 0, lost;
  const double     *b;
  ptrdiff_t         at[2]  = {0, 0};
  SamTotal          total  = {0};
  const Part *const parts  = kept->part;
  const SamGrid     grid   = SamElasticityGetGrid(elasticity);
  const double      spread = SamGridIsRow(grid) ? PetscMax(SPREAD, ALONG * sqrt((double)grid->nx)) : SPREAD;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(elasticity, NULL, &self));
  PetscCall(VecCopy(now->shear, shear));
  PetscCall(VecCopy(now->displacement_t, product->field));
  PetscCall(VecGetArray(shear, &q));
  PetscCall(VecGetArray(product->field, &u));
  PetscCall(VecGetArrayRead(bound, &b));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t row   = (ptrdiff_t)j * grid->nx;
    PetscInt        first = 0, last = grid->nx;

    for (int n = 0; n < 2 && parts[n].fields; n++) {
      for (PetscInt c = 0; c < STRAIGHT; c++)
        AddRow(&parts[n], parts[n].weight, c, j, at[n],
               (c < PRODUCT_X ? q : u) + (c % 2) * (ptrdiff_t)grid->cells + row);
      first = PetscMax(first, parts[n].fields->range[2 * j]);
      last  = PetscMin(last, parts[n].fields->range[2 * j + 1]);
      at[n] += CellsInRow(&parts[n], j);
    }
    SamAdd(&total, TrimRow(grid->nx, first, last, b + row, q + row, q + grid->cells + row, &open));
  }
  PetscCall(VecRestoreArrayRead(bound, &b));
  PetscCall(VecRestoreArray(product->field, &u));
  PetscCall(VecRestoreArray(shear, &q));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &lost));
  PetscCall(SamMax(grid->comm, 1, &open));
  product->first[0] = product->first[1] = 0;
  product->n[0]                         = grid->nx;
  product->n[1]                         = grid->ny;
  product->rounding                     = spread * sqrt(lost);
  for (int n = 0; n < 2 && parts[n].fields; n++)
    product->rounding += fabs(parts[n].weight) * sqrt(parts[n].numbers[CELLS]) *
                         (parts[n].numbers[UNIT_PRODUCT] / (double)self + spread * parts[n].numbers[UNIT_SHEAR]);
  *found = open > 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamCachedStepIsRepeated(SamCachedStep kept)
{
  return kept && kept->part[1].fields;
}

PetscBool SamCachedStepHasTurn(SamCachedStep kept)
{
  return kept && kept->part[0].fields->changes == TURNING &&
         (!kept->part[1].fields || kept->part[1].fields->changes == TURNING);
}

PetscErrorCode SamCachedStepAddTurn(SamCachedStep kept, SamGrid grid, Vec field)
{
  const Part *const parts = kept->part;
  ptrdiff_t         at[2] = {0, 0};
  double           *to;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &to));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (int n = 0; n < 2 && parts[n].fields; n++) {
      for (PetscInt c = 0; c < 2; c++)
        AddRow(&parts[n], parts[n].weight, TURN_X + c, j, at[n],
               to + c * (ptrdiff_t)grid->cells + (ptrdiff_t)j * grid->nx);
      at[n] += CellsInRow(&parts[n], j);
    }
  PetscCall(VecRestoreArray(field, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

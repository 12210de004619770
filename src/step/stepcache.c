/*
  The start of a step from the same step one cycle before.

  In a load history that repeats itself, the change of the shear from one step to the next is nearly that of one cycle
  before, and in the end it is the same. So a step starts from q = q_now + (q_k - q_(k-1)), k being the step of the
  cycle before; this keeps what sticks stuck. Its product C q follows from the committed displacement and the kept
  change of that of step k: the start costs no application of the operator. q may leave its discs by the distance from
  the repeated cycle; the solver's first trial then goes to the nearest admissible shear (newton.c), and a start whose
  error is too large is dropped for that of predict.c.

  Friction is odd: where all that causes shear is reversed, so is its change. So under the same normal loads the second
  half of a symmetric cycle repeats the first one with the other sign, and k is a step of the half cycle before.

  On the way to the repeated cycle the changes differ from it by parts that shrink by nearly the same factor m from one
  repetition to the next, m < 0 for parts that reversal does not reverse. So of the last two repetitions, D and the
  older D', w D + (1 - w) D' with w = 1 + m is much nearer than D. w is what fits the changes of the last step best.

  For bodies whose pressure does not depend on the shear, the pressure of step k is that of this step, if what is
  prescribed of it and the gap are the same to the bit.

  A step is recognised by what it prescribes and what the step before did, not by its number. It replaces the last but
  one that it repeats, and where the memory is full the last one. Steps that repeat none then replace the oldest ones,
  and those whose like is not kept are not either: of a cycle that does not fit, the part that does is used again and
  again. Changes are stored on the contact's part of
  each row, as integers in units of 2^-30 of their largest value, four times as accurate as floats of the same size. All
  decisions are those of global numbers: the same on any number of ranks.
*/
#include "stepcache.h"
#include <math.h>
#include <petsam/private/tangentialimpl.h>

/* What was prescribed in so many of the last steps is remembered: longer cycles are not recognised. */
#define STEPS 4096
/* Numbers that differ by less, relative to the largest of their kind so far, prescribe the same. */
#define SAME 1e-9
/* Columns by which the part of a row is wider than the contact: it may change by a cell. */
#define MARGIN 1
/* An upper bound of the influence of single cells' shear on their neighbours, in units of the self-influence. */
#define SPREAD 4
/* What is compared of a control. */
#define NUMBERS (2 * SAM_COMPONENTS + SAM_CONDITIONS)
#define UNITS   1073741824.0
/* Least and largest weight of the last of two repetitions. */
#define LEAST_WEIGHT (-1.0)
#define MOST_WEIGHT  2.0

/* ---- what is kept of a step ---- */

enum { SHEAR_X, SHEAR_Y, PRODUCT_X, PRODUCT_Y, CHANGES };

struct _n_SamCachedStep {
  PetscInt        *first, *last;    /* of each row of this rank */
  int32_t         *change[CHANGES]; /* of the step, one row after the other */
  double           unit[2];         /* of the shear (Pa), of the product (m) */
  double          *pressure;        /* NULL: that of the step before */
  double           bytes, cells;    /* on all ranks */
  PetscObjectState revision;        /* of the problem that the pressure was solved with */
  SamControl       control;
  double           load[3], rigid[3]; /* normal */
  double           sign, weight;      /* of the changes in the step that is to come; the rest is `other`'s */
  SamCachedStep    other;             /* the next older such step; NULL: none */
};

typedef struct {
  SamControl    control;
  SamCachedStep kept; /* NULL: nothing is */
} Entry;

struct _n_SamStepCache {
  SamGrid  grid;
  double   limit, bytes;                /* on all ranks */
  PetscInt count, newest, found, older; /* found, older: the last two steps like the next one; -1: none */
  double   weight;                      /* of the former, by what was best in the last step */
  Entry   *entry;                       /* a ring of STEPS; NULL until there is memory for it */
  double   largest[NUMBERS];

  SamConditions conditions;
};

static void DestroyKept(SamStepCache r, SamCachedStep *kept)
{
  const SamCachedStep k = *kept;

  if (!k) return;
  r->bytes -= k->bytes;
  for (PetscInt c = 0; c < CHANGES; c++) SamFree(k->change[c]);
  SamFree(k->pressure);
  SamFree(k->first);
  SamFree(k->last);
  SamFree(k);
  *kept = NULL;
}

PetscErrorCode SamStepCacheCreate(SamGrid grid, SamConditions conditions, SamStepCache *cache)
{
  PetscFunctionBegin;
  PetscCall(SamAllocateZeros(sizeof(**cache), cache));
  (*cache)->grid       = grid;
  (*cache)->conditions = conditions;
  (*cache)->found = (*cache)->older = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamStepCacheForget(SamStepCache r)
{
  for (PetscInt k = 0; k < r->count; k++) DestroyKept(r, &r->entry[k].kept);
  r->count = r->newest = 0;
  r->found = r->older = -1;
}

void SamStepCacheDestroy(SamStepCache *cache)
{
  if (!*cache) return;
  SamStepCacheForget(*cache);
  SamFree((*cache)->entry);
  SamFree(*cache);
  *cache = NULL;
}

PetscErrorCode SamStepCacheSetMemory(SamStepCache r, PetscReal bytes)
{
  PetscFunctionBegin;
  r->limit = (double)bytes;
  if (r->bytes > r->limit) SamStepCacheForget(r);
  if (bytes > 0 && !r->entry) PetscCall(SamAllocateZeros(STEPS * sizeof(*r->entry), &r->entry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- which step this is ---- */

/* The numbers of a control but its time; returns how many there are. */
static PetscInt Numbers(SamStepCache r, const SamControl *control, double numbers[NUMBERS])
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) numbers[n++] = SamControlWay(control, k);
  for (PetscInt k = 0; k < SamControlCount(r->conditions); k++)
    numbers[n++] = SamControlPart(control, r->conditions, k);
  return n;
}

static PetscBool IsSame(SamStepCache r, const SamControl *a, const SamControl *b)
{
  double         x[NUMBERS], y[NUMBERS];
  const PetscInt count = Numbers(r, a, x);

  (void)Numbers(r, b, y);
  for (PetscInt k = 0; k < count; k++)
    if (fabs(x[k] - y[k]) > SAME * r->largest[k]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The control with all that causes shear reversed. */
static SamControl Reversed(SamStepCache r, const SamControl *control)
{
  SamControl reversed = *control;

  for (PetscInt k = 0; k < 3; k++) reversed.value[SamComponentsOf[SAM_BALANCE_TANGENTIAL][k]] *= -1;
  for (PetscInt k = 0; k < SamConditionsCount(r->conditions); k++) {
    const SamCondition *c = SamConditionsGet(r->conditions, k);

    if (c->reverses) SamControlSetCondition(&reversed, c, -SamControlGet(control, c));
  }
  return reversed;
}

/* The k-th entry before the newest one. */
static PetscInt Before(SamStepCache r, PetscInt k)
{
  return (r->newest - k + STEPS) % STEPS;
}

void SamStepCacheFind(SamStepCache r, const SamControl *next, SamCachedStep *kept)
{
  double     numbers[NUMBERS];
  PetscInt   count;
  SamControl to[2], from[2]; /* controls of the step: as they are, and reversed */

  *kept    = NULL;
  r->found = r->older = -1;
  if (r->limit <= 0) return;
  count = Numbers(r, next, numbers);
  for (PetscInt k = 0; k < count; k++) r->largest[k] = PetscMax(r->largest[k], fabs(numbers[k]));
  to[0]   = *next;
  to[1]   = Reversed(r, next);
  from[0] = r->entry[r->newest].control;
  from[1] = Reversed(r, &from[0]);
  for (PetscInt k = 0; k + 2 < r->count && r->older < 0; k++)
    for (int way = 0; way < 2; way++) {
      const PetscInt n = Before(r, k);

      if (!IsSame(r, &r->entry[n].control, &to[way]) || !IsSame(r, &r->entry[Before(r, k + 1)].control, &from[way]))
        continue;
      if (r->found < 0)
        r->found = n;
      else
        r->older = n;
      if (r->entry[n].kept) r->entry[n].kept->sign = way ? -1 : 1;
      break;
    }
  if (r->found >= 0) *kept = r->entry[r->found].kept;
  if (!*kept) return;
  (*kept)->other = r->older >= 0 ? r->entry[r->older].kept : NULL;
  if ((*kept)->other && (*kept)->other->revision != (*kept)->revision) (*kept)->other = NULL; /* of another contact */
  (*kept)->weight = (*kept)->other ? r->weight : 1;
}

/* ---- keeping ---- */

/* Stores the changes of both components of a field from `before` to `now`, in units of their largest. */
static PetscErrorCode KeepChange(SamStepCache r, SamCachedStep k, Vec before, Vec now, double *unit,
                                 int32_t *const to[2])
{
  const SamGrid grid = r->grid;
  const double *a, *b;
  double        most = 0;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(before, &a));
  PetscCall(VecGetArrayRead(now, &b));
  for (PetscInt pass = 0; pass < 2; pass++) {
    for (PetscInt c = 0; c < 2; c++) {
      ptrdiff_t n = 0;

      for (PetscInt j = 0; j < grid->rows; j++)
        for (PetscInt i = k->first[j]; i < k->last[j]; i++, n++) {
          const ptrdiff_t cell   = c * (ptrdiff_t)grid->cells + (ptrdiff_t)j * grid->nx + i;
          const double    change = b[cell] - a[cell];

          if (pass == 0)
            most = PetscMax(most, fabs(change));
          else
            to[c][n] = *unit > 0 ? (int32_t)lrint(change / *unit) : 0;
        }
    }
    if (pass == 0) {
      PetscCall(SamMax(grid->comm, 1, &most));
      *unit = most / UNITS;
    }
  }
  PetscCall(VecRestoreArrayRead(now, &b));
  PetscCall(VecRestoreArrayRead(before, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the parts of the rows, and makes room for them if the limit allows it, or older steps need not stay. */
static PetscErrorCode CreateKept(SamStepCache r, Vec bound_before, Vec bound, PetscBool pressure, SamCachedStep *kept)
{
  const SamGrid grid = r->grid;
  const double *a, *b;
  size_t        cells = 0;
  double        total;
  SamCachedStep k;

  PetscFunctionBegin;
  *kept = NULL;
  PetscCall(SamAllocateZeros(sizeof(*k), &k));
  PetscCall(SamAllocateZeros(sizeof(*k->first) * (size_t)(grid->rows + 1), &k->first));
  PetscCall(SamAllocateZeros(sizeof(*k->last) * (size_t)(grid->rows + 1), &k->last));
  PetscCall(VecGetArrayRead(bound_before, &a));
  PetscCall(VecGetArrayRead(bound, &b));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t row = (ptrdiff_t)j * grid->nx;
    PetscInt        first, last;

    SamBoundRangeOfBoth(grid->nx, a + row, b + row, &first, &last);
    if (first == last) continue;
    k->first[j] = PetscMax(first - MARGIN, 0);
    k->last[j]  = PetscMin(last + MARGIN, grid->nx);
    cells += (size_t)(k->last[j] - k->first[j]);
  }
  PetscCall(VecRestoreArrayRead(bound, &b));
  PetscCall(VecRestoreArrayRead(bound_before, &a));
  total = (double)cells;
  PetscCall(SamSum(grid->comm, 1, &total));
  k->cells = total;
  k->bytes = total * (double)(CHANGES * sizeof(int32_t) + (pressure ? sizeof(double) : 0));
  r->bytes += k->bytes;
  for (PetscInt n = r->count - 1; r->found < 0 && n > 0 && r->bytes > r->limit; n--)
    DestroyKept(r, &r->entry[Before(r, n)].kept);
  if (r->found >= 0 && r->bytes > r->limit) DestroyKept(r, &r->entry[r->found].kept);
  if (r->bytes > r->limit) {
    DestroyKept(r, &k);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt c = 0; c < CHANGES; c++) PetscCall(SamAllocate(sizeof(int32_t) * (cells + 1), &k->change[c]));
  if (pressure) PetscCall(SamAllocate(sizeof(double) * (cells + 1), &k->pressure));
  *kept = k;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KeepPressure(SamStepCache r, SamCachedStep k, const SamSolution *now)
{
  const SamGrid grid = r->grid;
  const double *p;
  double       *to = k->pressure;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) {
    k->load[c]  = now->load[SamComponentsOf[SAM_BALANCE_NORMAL][c]];
    k->rigid[c] = now->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][c]];
  }
  PetscCall(VecGetArrayRead(now->pressure, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscInt n = k->last[j] - k->first[j];

    PetscCall(PetscArraycpy(to, p + (ptrdiff_t)j * grid->nx + k->first[j], n));
    to += n;
  }
  PetscCall(VecRestoreArrayRead(now->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds `weight` times the kept changes of a component of the shear (0, 1) or the product (2, 3) to row j, n on. */
static void AddRow(const SamCachedStep k, double weight, PetscInt component, PetscInt j, ptrdiff_t n, double to[])
{
  const int32_t *change = k->change[component] + n;
  const double   unit   = weight * k->sign * k->unit[component / 2];

  for (PetscInt i = k->first[j]; i < k->last[j]; i++) to[i] += unit * (double)*change++;
}

/* The weight with which the two kept steps would have been nearest to the shear's change from `before` to `now`. */
static PetscErrorCode FindWeight(SamStepCache r, const SamCachedStep k, Vec before, Vec now)
{
  const PetscInt nx        = r->grid->nx;
  SamTotal       totals[2] = {{0}};
  const double  *a, *b;
  double        *row, sums[2];
  ptrdiff_t      n = 0, m = 0;

  PetscFunctionBegin;
  r->weight = 1;
  if (!k || !k->other) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * nx, &row));
  PetscCall(VecGetArrayRead(before, &a));
  PetscCall(VecGetArrayRead(now, &b));
  for (PetscInt j = 0; j < r->grid->rows; j++) {
    double both[2] = {0, 0};

    for (PetscInt c = SHEAR_X; c <= SHEAR_Y; c++) {
      const ptrdiff_t at = c * (ptrdiff_t)r->grid->cells + (ptrdiff_t)j * nx;

      PetscCall(PetscArrayzero(row, 2 * nx));
      AddRow(k->other, 1, c, j, m, row);
      AddRow(k, 1, c, j, n, row + nx);
      for (PetscInt i = 0; i < nx; i++) {
        const double way = row[nx + i] - row[i];

        both[0] += way * (b[at + i] - a[at + i] - row[i]);
        both[1] += way * way;
      }
    }
    SamAddAll(2, totals, both);
    n += k->last[j] - k->first[j];
    m += k->other->last[j] - k->other->first[j];
  }
  PetscCall(VecRestoreArrayRead(now, &b));
  PetscCall(VecRestoreArrayRead(before, &a));
  PetscCall(PetscFree(row));
  PetscCall(SamSumTotals(r->grid->comm, 2, totals, sums));
  if (sums[1] > 0) r->weight = PetscMin(PetscMax(sums[0] / sums[1], LEAST_WEIGHT), MOST_WEIGHT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepCacheKeep(SamStepCache r, const SamSolution *before, const SamSolution *now,
                                PetscObjectState revision)
{
  Entry    *e;
  PetscBool pressure;

  PetscFunctionBegin;
  if (r->limit <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (before) PetscCall(FindWeight(r, r->found >= 0 ? r->entry[r->found].kept : NULL, before->shear, now->shear));
  if (r->older >= 0) DestroyKept(r, &r->entry[r->older].kept);
  r->newest = r->count ? (r->newest + 1) % STEPS : 0;
  r->count  = PetscMin(r->count + 1, STEPS);
  e         = &r->entry[r->newest];
  DestroyKept(r, &e->kept);
  e->control = now->control;
  if (!before || !before->displacement_t) PetscFunctionReturn(PETSC_SUCCESS);
  pressure = SamControlIsSame(&before->control, &now->control, SAM_BALANCE_NORMAL) ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(CreateKept(r, before->bound, now->bound, pressure, &e->kept));
  r->found = r->older = -1;
  if (!e->kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KeepChange(r, e->kept, before->shear, now->shear, &e->kept->unit[0], &e->kept->change[SHEAR_X]));
  PetscCall(KeepChange(r, e->kept, before->displacement_t, now->displacement_t, &e->kept->unit[1],
                       &e->kept->change[PRODUCT_X]));
  e->kept->revision = revision;
  e->kept->control  = now->control;
  if (pressure) PetscCall(KeepPressure(r, e->kept, now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- finding ---- */

PetscBool SamCachedStepHasPressure(SamCachedStep k, const SamControl *control, PetscObjectState revision)
{
  if (!k || !k->pressure || revision < 0 || k->revision != revision) return PETSC_FALSE;
  return SamControlIsSame(&k->control, control, SAM_BALANCE_NORMAL);
}

PetscErrorCode SamCachedStepGetPressure(SamCachedStep k, SamGrid grid, SamSolution *s)
{
  const double *from = k->pressure;
  double       *p;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(s->pressure, &p));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double        *row = p + (ptrdiff_t)j * grid->nx;
    const PetscInt n   = k->last[j] - k->first[j];

    PetscCall(PetscArrayzero(row, grid->nx));
    PetscCall(PetscArraycpy(row + k->first[j], from, n));
    from += n;
  }
  PetscCall(VecRestoreArrayWrite(s->pressure, &p));
  for (PetscInt c = 0; c < 3; c++) {
    s->load[SamComponentsOf[SAM_BALANCE_NORMAL][c]]  = k->load[c];
    s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][c]] = k->rigid[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Shear outside of the bound is rounding, or the change of the contact's edge since: it is dropped, and what it would
  displace nearby goes to the account of rounding. Returns its square; `open`: the cells under a bound that are not in
  the part of their row.
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
  PetscReal           self;
  double             *q, *u, open = 0, lost;
  const double       *b;
  ptrdiff_t           at[2]    = {0, 0};
  SamTotal            total    = {0};
  const SamCachedStep parts[2] = {kept, kept->other};
  const SamGrid       grid     = SamElasticityGetGrid(elasticity);

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

    for (int n = 0; n < 2 && parts[n]; n++) {
      for (PetscInt c = 0; c < CHANGES; c++)
        AddRow(parts[n], n ? 1 - kept->weight : kept->weight, c, j, at[n],
               (c < PRODUCT_X ? q : u) + (c % 2) * (ptrdiff_t)grid->cells + row);
      first = PetscMax(first, parts[n]->first[j]);
      last  = PetscMin(last, parts[n]->last[j]);
      at[n] += parts[n]->last[j] - parts[n]->first[j];
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
  product->rounding                     = SPREAD * sqrt(lost);
  for (int n = 0; n < 2 && parts[n]; n++)
    product->rounding += fabs(n ? 1 - kept->weight : kept->weight) * sqrt(parts[n]->cells) *
                         (parts[n]->unit[1] / (double)self + SPREAD * parts[n]->unit[0]);
  *found = open > 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nearest admissible pressure in equilibrium: see projection.c. */
#include "projectionimpl.h"
#include <math.h>

/* Maximum number of successive projections */
#define PROJECT_MAX 4
/* Error of equilibrium below which one step of Newton's method usually reaches the solution */
#define CLOSE 1e-3

/* The cells that take part without a mask: all; those with pressure; those with a pressure between its bounds */
typedef enum { ALL, PRESSED, BETWEEN } Which;

/* The input of a pass over the cells. */
typedef struct {
  const double *field;     /* the field to be projected */
  const float  *mask;      /* 1 on the cells that take part, 0 on others; NULL: `which` applies */
  Which         which;     /* cells that take part without a mask */
  float        *row;       /* without a mask: a row of ones, or scratch for the mask of a row */
  const char   *busy;      /* blocks with cells that take part, or with pressure; NULL: all */
  const float  *step;      /* added to the field, multiplied by `by`; one row of zeros if that is 0 */
  double        by, scale; /* see SamPressureStep */
  float        *made;
  PetscBool     quick;  /* a single step of Newton's method may suffice */
  double       *motion; /* result: the sum added along the phi; NULL: unused */
} Cells;

static const float *MaskOfRow(const Cells *c, const SamFrame *f, PetscInt j)
{
  const PetscInt nx    = f->grid->nx;
  const double  *field = c->field + (ptrdiff_t)j * nx, below = c->which == BETWEEN ? f->most : INFINITY;

  if (c->mask) return c->mask + (ptrdiff_t)j * nx;
  for (PetscInt i = 0; c->which != ALL && i < nx; i++) c->row[i] = field[i] > 0 && field[i] < below ? 1.0f : 0.0f;
  return c->row;
}

/* Arrays of some cells; `most` bounds their pressures. */
typedef struct {
  const double *field;
  const float  *step, *mask;
  double        by, most;
} Fields;

/* Adds the pressures x = field + by step + phi a of some cells, within their bounds. */
SAM_VECTORIZED static void AddPressures(SamRow row, Fields cells, const double a[3], SamDual *sums)
{
  const double *restrict field = cells.field;
  const float *restrict step = cells.step, *restrict mask = cells.mask;
  const double by = cells.by, most = cells.most, half = 0.5 * most, ax = a[0] - a[1] * row.eta, a2 = a[2];
  double       value = 0, x = 0, turn = 0, count = 0, sum_xi = 0, xi2 = 0;

#pragma omp simd reduction(+ : value, x, turn, count, sum_xi, xi2)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, v = field[i] + by * (double)step[i] + (ax + a2 * xi),
                 cut = v > 0 ? (v < most ? v : most) : 0, out = field[i] > half ? most : 0,
                 in = v > 0 && v < most ? (double)mask[i] : 0, p = mask[i] > 0 ? cut : out;

    value += p * (v - 0.5 * p);
    x += p;
    turn += xi * p;
    count += in;
    sum_xi += in * xi;
    xi2 += in * xi * xi;
  }
  sums->value += value;
  sums->scale += x;
  sums->sums[0] += x;
  sums->sums[1] -= row.eta * x;
  sums->sums[2] += turn;
  SamGramNormalRow(sums->gram, count, sum_xi, xi2, row.eta);
}

/* Arrays of some cells, for ApplyNormal() */
typedef struct {
  double      *p;
  const float *step, *mask;
  float       *made;
  double       by, most, scale;
} Pressures;

/* Sets p = p + by step + phi a within its bounds, on the mask; adds `scale` times the change to made. */
SAM_VECTORIZED static void ApplyNormal(SamRow row, Pressures cells, const double a[3], SamDual *sums)
{
  double *restrict p         = cells.p;
  const float *restrict step = cells.step, *restrict mask = cells.mask;
  float *restrict made = cells.made;
  const double by = cells.by, most = cells.most, scale = cells.scale, half = 0.5 * most, ax = a[0] - a[1] * row.eta,
               a2 = a[2];
  double sum = 0, turn = 0;

#pragma omp simd reduction(+ : sum, turn)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, v = p[i] + by * (double)step[i] + (ax + a2 * xi),
                 cut = v > 0 ? (v < most ? v : most) : 0, out = p[i] > half ? most : 0, x = mask[i] > 0 ? cut : out;

    made[i] += (float)(scale * (x - p[i]));
    p[i] = x;
    sum += x;
    turn += xi * x;
  }
  sums->scale += sum;
  sums->sums[0] += sum;
  sums->sums[1] -= row.eta * sum;
  sums->sums[2] += turn;
}

/*
  Passes over the cells and adds the dual at a and its derivatives. If p is given, which is the field, the projection
  for a replaces it, and only its moments are added. `scratch`: a row, needed if made is NULL.
*/
static void PassRows(const SamFrame *f, const Cells *c, const double a[3], double p[], float scratch[], SamTotal dual[])
{
  const PetscInt nx = f->grid->nx, blocks = SamRowBlocks(f->grid);

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const ptrdiff_t k    = (ptrdiff_t)j * nx;
    const float    *mask = MaskOfRow(c, f, j), *step = c->step + (c->by != 0 ? k : 0);
    float          *made = c->made ? c->made + k : scratch;
    SamDual         sums = {0};

    for (PetscInt i = 0, end = 0; SamNextBusy(c->busy ? c->busy + (ptrdiff_t)j * blocks : NULL, nx, &i, &end);) {
      const SamRow row = SamFrameRow(f, j, i, end);

      if (p)
        ApplyNormal(row, (Pressures){p + k + i, step + i, mask + i, made + i, c->by, f->most, c->scale}, a, &sums);
      else
        AddPressures(row, (Fields){c->field + k + i, step + i, mask + i, c->by, f->most}, a, &sums);
    }
    SamAddAll(SAM_DUAL, dual, (const double *)&sums);
  }
}

static void PassNormal(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  PassRows(f, (const Cells *)context, a, NULL, NULL, dual);
}

/* Restores p as it was before the changes in `made`. */
static void TakeBack(const SamFrame *f, const Cells *cells, double p[])
{
  for (PetscInt k = 0; k < f->grid->cells; k++)
    p[k] = PetscMin(PetscMax(0, p[k] - (double)cells->made[k] / cells->scale), f->most);
}

/*
  Projects the field p + by step. If the step nearly carries the loads, two passes suffice: the first finds the step of
  Newton's method for a, the second applies it and checks the equilibrium.
*/
static PetscErrorCode ProjectNormal(const SamFrame *f, Cells cells, double p[], PetscBool *found)
{
  double   *before = NULL;
  float    *zeros, *scratch; /* a row of zeros, and one for unused changes */
  PetscBool near = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(PetscCalloc3(f->grid->nx, &cells.row, f->grid->nx, &zeros, f->grid->nx, &scratch));
  for (PetscInt i = 0; i < f->grid->nx; i++) cells.row[i] = 1;
  if (cells.by == 0) cells.step = zeros;
  cells.field = p;
  *found      = PETSC_FALSE;
  /* If pressures are far above the load, it is lost in their rounding; another projection of the result is accurate. */
  for (PetscInt time = 0; time < PROJECT_MAX && !*found && near; time++) {
    const PetscBool once             = cells.quick && time == 0;
    SamTotal        totals[SAM_DUAL] = {{0}};
    double          a[3]             = {0, 0, 0};

    if (f->count)
      PetscCall(SamDualMinimize(f, PassNormal, &cells, once ? CLOSE : 0, a, found, &near));
    else
      *found = PETSC_TRUE;
    if (!*found && near && !before && !cells.made) {
      PetscCall(PetscMalloc1(f->grid->cells, &before));
      PetscCall(PetscArraycpy(before, p, f->grid->cells));
    }
    if (near) PassRows(f, &cells, a, p, scratch, totals);
    for (PetscInt i = 0; cells.motion && i < 3; i++) cells.motion[i] += a[i];
    if (once && near && !*found) PetscCall(SamDualIsBalanced(f, totals, SAM_BALANCED_ENOUGH, found));
    cells.by   = 0;
    cells.step = zeros;
    /* The remaining error is small, and cells without pressure would all take a part of it. */
    cells.which = cells.which == ALL ? PRESSED : cells.which;
  }
  if (!*found && before) PetscCall(PetscArraycpy(p, before, f->grid->cells));
  if (!*found && cells.made) TakeBack(f, &cells, p);
  PetscCall(PetscFree(before));
  PetscCall(PetscFree3(cells.row, zeros, scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormal(const SamFrame *f, const float mask[], double p[], PetscBool *found)
{
  return ProjectNormal(f, (Cells){.mask = mask}, p, found);
}

PetscErrorCode SamFrameProjectNormalStep(const SamFrame *f, SamPressureStep *s, double p[], PetscBool *found)
{
  const Cells cells = {.mask   = s->mask,
                       .busy   = s->busy,
                       .step   = s->step,
                       .by     = s->by,
                       .made   = s->made,
                       .quick  = s->nearest ? PETSC_FALSE : PETSC_TRUE,
                       .scale  = s->scale,
                       .motion = s->motion};

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->made, f->grid->cells));
  PetscCall(PetscArrayzero(s->motion, 3));
  PetscCall(ProjectNormal(f, cells, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *f, double p[], PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(ProjectNormal(f, (Cells){.which = PRESSED}, p, found));
  if (!*found) PetscCall(SamFrameProjectNormal(f, NULL, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalBetween(const SamFrame *f, double p[], PetscBool *found)
{
  PetscFunctionBegin;
  *found = PETSC_FALSE;
  if (isfinite(f->most)) PetscCall(ProjectNormal(f, (Cells){.which = BETWEEN}, p, found));
  if (!*found) PetscCall(SamFrameProjectNormalOnContact(f, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameClear(const SamFrame *f, const double field[], double a[3], PetscBool *clear)
{
  Cells  cells = {.field = field};
  float *zeros;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(f->grid->nx, &cells.row, f->grid->nx, &zeros));
  for (PetscInt i = 0; i < f->grid->nx; i++) cells.row[i] = 1;
  cells.step = zeros;
  PetscCall(SamDualVanish(f, PassNormal, &cells, a, clear));
  PetscCall(PetscFree2(cells.row, zeros));
  PetscFunctionReturn(PETSC_SUCCESS);
}

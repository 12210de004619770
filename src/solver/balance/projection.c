/*
  Nearest tractions in equilibrium.

  Problem: given a traction v, find the nearest admissible one (pressures >= 0, or shears in their discs) that carries
  the loads F.

  Algorithm: the solution is x = P(v + phi a), where P projects each cell by itself, and the at most three numbers a
  minimise the dual, a convex function:
      sum psi_b(|v + phi a|) - a.F,     psi_b(n) = n^2/2 up to the bound b, b n - b^2/2 beyond
  (for pressures: half the square of the positive part). Its gradient is sum phi'P(v + phi a) - F, the error of
  equilibrium. Newton's method with a line search on the dual takes a few passes over the cells and no transform. When
  no admissible traction carries F, the dual has no minimum and a grows without bound.
*/
#include <petsam/private/balanceimpl.h>
#include <math.h>

#define NEWTON_MAX   60
#define HALVINGS_MAX 40
#define PROJECT_MAX  4
/* Errors of equilibrium, relative to the loads or the sum of the traction. */
#define EXACT  1e-14 /* rounding at best: Newton's method stops */
#define ENOUGH 1e-11 /* rounding at worst: a solution all the same */
#define CLOSE  1e-3  /* close to a solution: for pressures, one step of Newton's method is likely to reach it */
#define SMOOTH 1e-6  /* the same for shears, whose equations are not piecewise linear */

/* Value, gradient without F, and Hessian of the dual, and sum |x| as the scale of the gradient. */
typedef struct {
  double value, sums[3], gram[SAM_GRAM], scale;
} Dual;

#define DUAL (sizeof(Dual) / sizeof(double))

typedef void (*DualPass)(const SamFrame *f, const void *context, const double a[3], SamTotal dual[]);

static PetscErrorCode Evaluate(const SamFrame *f, DualPass pass, const void *context, const double a[3], Dual *dual)
{
  SamTotal totals[DUAL] = {{0, 0}};

  PetscFunctionBegin;
  pass(f, context, a, totals);
  PetscCall(SamSumTotals(f->grid->comm, DUAL, totals, (double *)dual));
  /* subtract a.F and F along the free subspace */
  for (PetscInt k = 0; k < f->count; k++)
    for (PetscInt i = 0; i < 3; i++) dual->value -= a[i] * f->basis[k][i] * f->target[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Error of equilibrium along the basis, as a combination of the phi; returns its size relative to the scale. */
static double Imbalance(const SamFrame *f, const Dual *dual, double error[3])
{
  double size = 0, load = 0;

  for (PetscInt i = 0; i < 3; i++) error[i] = 0;
  for (PetscInt k = 0; k < f->count; k++) {
    double e = f->target[k];

    for (PetscInt i = 0; i < 3; i++) e -= f->basis[k][i] * dual->sums[i];
    for (PetscInt i = 0; i < 3; i++) error[i] += e * f->basis[k][i];
    size = PetscMax(size, fabs(e));
    load = PetscMax(load, fabs(f->target[k]));
  }
  load = PetscMax(load, dual->scale);
  return load > 0 ? size / load : 0;
}

/* The Newton step for an error of equilibrium; returns the slope of the dual along it, down being positive. */
static double NewtonStep(const SamFrame *f, const Dual *dual, const double error[3], double step[3])
{
  double slope = 0;

  SamFrameSolve(f, dual->gram, error, step);
  for (PetscInt i = 0; i < 3; i++) slope += error[i] * step[i];
  if (slope > 0) return slope;
  /* the Hessian vanishes along the error, or it is not a number: go along the error itself */
  for (PetscInt i = 0; i < 3; i++) step[i] = error[i];
  for (PetscInt i = 0; i < 3; i++) slope += error[i] * step[i];
  return slope;
}

/* An iterate of Newton's method. */
typedef struct {
  double a[3];
  Dual   dual;
  double error[3], size; /* error of equilibrium, and its relative size */
} Iterate;

/* A step with halving from `now` to `next`; returns the part of the Newton step that was made. */
static PetscErrorCode SearchLine(const SamFrame *f, DualPass pass, const void *context, const Iterate *now,
                                 Iterate *next, double *length)
{
  double       step[3], t = 1;
  const double slope = NewtonStep(f, &now->dual, now->error, step);

  PetscFunctionBegin;
  for (PetscInt h = 0;; h++) {
    for (PetscInt i = 0; i < 3; i++) next->a[i] = now->a[i] + t * step[i];
    PetscCall(Evaluate(f, pass, context, next->a, &next->dual));
    next->size = Imbalance(f, &next->dual, next->error);
    /* near the minimum rounding hides the fall of the value, but not that of the gradient */
    if (next->dual.value <= now->dual.value - 1e-4 * t * slope || next->size < 0.5 * now->size ||
        t * slope <= 1e-13 * fabs(now->dual.value) || h == HALVINGS_MAX)
      break;
    t *= 0.5;
  }
  *length = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Newton's method for the dual. Stops when equilibrium holds to rounding, or when steps no longer improve it; `near`:
  then it nearly holds. With an error of less than `once` at the start only one step is made, and whether that was
  enough (`found` is false) is for the caller to check.
*/
static PetscErrorCode MinimizeDual(const SamFrame *f, DualPass pass, const void *context, double once, double a[3],
                                   PetscBool *found, PetscBool *near)
{
  Iterate now = {.a = {0, 0, 0}}, next;

  PetscFunctionBegin;
  PetscCall(Evaluate(f, pass, context, now.a, &now.dual));
  now.size = Imbalance(f, &now.dual, now.error);
  *found   = PETSC_FALSE;
  *near    = PETSC_TRUE;
  if (now.size > EXACT && now.size <= once) {
    SamFrameSolve(f, now.dual.gram, now.error, a);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt it = 0; it < NEWTON_MAX && now.size > EXACT; it++) {
    double length = 0;

    PetscCall(SearchLine(f, pass, context, &now, &next, &length));
    if (next.size >= now.size && now.size <= ENOUGH) break; /* at rounding: keep the better one */
    now = next;
    if (length < 1e-9) break;
  }
  for (PetscInt i = 0; i < 3; i++) a[i] = now.a[i];
  *found = now.size <= ENOUGH ? PETSC_TRUE : PETSC_FALSE;
  *near  = now.size <= CLOSE ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a pass over the cells needs to know. */
typedef struct {
  const double *field; /* what is projected */
  const double *bound; /* of shears */
  /* pressures: */
  const float *mask;      /* 1 on the cells that take part, 0 on others; NULL: all, or those with pressure */
  PetscBool    contact;   /* which of the two */
  float       *row;       /* then: a row of ones, or scratch for the mask of a row */
  const char  *busy;      /* stretches with cells that take part, or with pressure; NULL: all */
  const float *step;      /* added to the field with the factor `by`; one row of zeros where that is 0 */
  double       by, scale; /* see SamPressureStep */
  float       *made;
} Cells;

static const float *MaskOfRow(const Cells *c, PetscInt nx, PetscInt j)
{
  const double *field = c->field + (ptrdiff_t)j * nx;

  if (c->mask) return c->mask + (ptrdiff_t)j * nx;
  for (PetscInt i = 0; c->contact && i < nx; i++) c->row[i] = field[i] > 0 ? 1.0f : 0.0f;
  return c->row;
}

static const char *BusyOfRow(const Cells *c, SamGrid grid, PetscInt j)
{
  return c->busy ? c->busy + (ptrdiff_t)j * SamStretches(grid) : NULL;
}

/* ---- pressures ---- */

/* The pressures x = max(0, field + by step + phi a) of some cells. */
SAM_VECTORIZED static void AddPressures(SamRow row, const double *restrict field, const float *restrict step, double by,
                                        const float *restrict mask, const double a[3], Dual *sums)
{
  const double ax = a[0] - a[1] * row.eta, a2 = a[2];
  double       value = 0, x = 0, turn = 0, count = 0, sum_xi = 0, xi2 = 0;

#pragma omp simd reduction(+ : value, x, turn, count, sum_xi, xi2)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, v = field[i] + by * (double)step[i] + (ax + a2 * xi),
                 in = v > 0 ? (double)mask[i] : 0, p = in * v;

    value += 0.5 * p * p;
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

static void PassNormal(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  const Cells   *c  = (const Cells *)context;
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const float *mask = MaskOfRow(c, nx, j), *step = c->step + (c->by != 0 ? (ptrdiff_t)j * nx : 0);
    const char  *busy = BusyOfRow(c, f->grid, j);
    Dual         sums = {0};

    for (PetscInt i = 0, end = 0; SamNextBusy(busy, nx, &i, &end);) {
      const SamRow row = SamFrameRow(f, j, i, end);

      AddPressures(row, c->field + row.first, step + i, c->by, mask + i, a, &sums);
    }
    SamAddAll(DUAL, dual, (const double *)&sums);
  }
}

/* Arrays of some cells, for the next function. */
typedef struct {
  double      *p;
  const float *step, *mask;
  float       *made;
} Pressures;

/* p = mask max(0, p + by step + phi a); `scale` times the change is added to made. */
SAM_VECTORIZED static void ApplyNormal(SamRow row, Pressures cells, double by, double scale, const double a[3],
                                       Dual *sums)
{
  double *restrict p         = cells.p;
  const float *restrict step = cells.step, *restrict mask = cells.mask;
  float *restrict made = cells.made;
  const double ax = a[0] - a[1] * row.eta, a2 = a[2];
  double       sum = 0, turn = 0;

#pragma omp simd reduction(+ : sum, turn)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, v = p[i] + by * (double)step[i] + (ax + a2 * xi),
                 x = v > 0 ? (double)mask[i] * v : 0;

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

/* The projection that belongs to a, in place of the field p, and its moments. `scratch`: a row, where made is NULL. */
static void ApplyRows(const SamFrame *f, const Cells *c, const double a[3], double p[], float scratch[],
                      SamTotal dual[])
{
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const ptrdiff_t k    = (ptrdiff_t)j * nx;
    const float    *mask = MaskOfRow(c, nx, j), *step = c->step + (c->by != 0 ? k : 0);
    const char     *busy = BusyOfRow(c, f->grid, j);
    float          *made = c->made ? c->made + k : scratch;
    Dual            sums = {0};

    for (PetscInt i = 0, end = 0; SamNextBusy(busy, nx, &i, &end);)
      ApplyNormal(SamFrameRow(f, j, i, end), (Pressures){p + k + i, step + i, mask + i, made + i}, c->by, c->scale, a,
                  &sums);
    SamAddAll(DUAL, dual, (const double *)&sums);
  }
}

/* Whether a traction with these totals is in equilibrium up to a relative error. */
static PetscErrorCode IsBalanced(const SamFrame *f, const SamTotal totals[], double limit, PetscBool *balanced)
{
  Dual   dual;
  double error[3];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(f->grid->comm, DUAL, totals, (double *)&dual));
  *balanced = Imbalance(f, &dual, error) <= limit ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* p as it was before the changes in `made`. */
static void TakeBack(const SamFrame *f, const Cells *cells, double p[])
{
  for (PetscInt k = 0; k < f->grid->cells; k++) p[k] = PetscMax(0, p[k] - (double)cells->made[k] / cells->scale);
}

/*
  The projection of the field p + by step. A step that nearly carries the loads takes two passes: one to find the step
  of Newton's method for a, and one that applies it and checks whether that was enough.
*/
static PetscErrorCode ProjectNormal(const SamFrame *f, Cells cells, double p[], PetscBool *found)
{
  const PetscInt nx     = f->grid->nx;
  double        *before = NULL;
  float         *zeros, *scratch; /* a row of no step, and of changes that are not wanted */
  PetscBool      near = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(nx, &cells.row));
  PetscCall(PetscCalloc2(nx, &zeros, nx, &scratch));
  for (PetscInt i = 0; i < nx; i++) cells.row[i] = 1;
  cells.field = p;
  if (cells.by == 0) cells.step = zeros;
  *found = PETSC_FALSE;
  /* where pressures are far above the load, it is lost in their rounding; projected again, they are of its size */
  for (PetscInt time = 0; time < PROJECT_MAX && !*found && near; time++) {
    const PetscBool once         = (cells.made && time == 0) ? PETSC_TRUE : PETSC_FALSE;
    SamTotal        totals[DUAL] = {{0, 0}};
    double          a[3]         = {0, 0, 0};

    if (f->count)
      PetscCall(MinimizeDual(f, PassNormal, &cells, once ? CLOSE : 0, a, found, &near));
    else
      *found = PETSC_TRUE;
    if (!*found && near && !before && !cells.made) {
      PetscCall(PetscMalloc1(f->grid->cells, &before));
      PetscCall(PetscArraycpy(before, p, f->grid->cells));
    }
    if (near) ApplyRows(f, &cells, a, p, scratch, totals);
    if (once && near && !*found) PetscCall(IsBalanced(f, totals, ENOUGH, found));
    cells.by   = 0;
    cells.step = zeros;
  }
  if (!*found && before) PetscCall(PetscArraycpy(p, before, f->grid->cells));
  if (!*found && cells.made) TakeBack(f, &cells, p);
  PetscCall(PetscFree(before));
  PetscCall(PetscFree(cells.row));
  PetscCall(PetscFree2(zeros, scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormal(const SamFrame *f, const float mask[], double p[], PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(ProjectNormal(f, (Cells){.mask = mask}, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalStep(const SamFrame *f, const SamPressureStep *s, double p[], PetscBool *found)
{
  const Cells cells = {
    .mask = s->mask, .busy = s->busy, .step = s->step, .by = s->by, .made = s->made, .scale = s->scale};

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->made, f->grid->cells));
  PetscCall(ProjectNormal(f, cells, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *f, double p[], PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(ProjectNormal(f, (Cells){.contact = PETSC_TRUE}, p, found));
  if (!*found) PetscCall(SamFrameProjectNormal(f, NULL, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- shears ---- */

/*
  Some cells of a row, at most SAM_CHUNK: v = field + phi a, its projection x = D(v) onto the disc, and the derivative h
  of D. The second loop, with roots and divisions, runs only if a cell lies beyond its disc.
*/
SAM_VECTORIZED static void AddShears(SamRow row, const double *restrict qx, const double *restrict qy,
                                     const double *restrict bound, const double a[3], Dual *sums)
{
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];
  double value = 0, scale = 0, x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0,
         beyond = 0;

#pragma omp simd reduction(+ : value, scale, x, y, turn, hxx, xi_hyy, xi2_hyy, beyond)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0;
    const double vx = in * (qx[i] + ax), vy = in * (qy[i] + a1 + a2 * xi), n2 = vx * vx + vy * vy;

    beyond += n2 > b * b ? 1 : 0;
    value += 0.5 * n2;
    scale += fabs(vx) + fabs(vy);
    x += vx;
    y += vy;
    turn += xi * vy;
    hxx += in;
    xi_hyy += in * xi;
    xi2_hyy += in * xi * xi;
  }
  if (beyond > 0) {
    value = scale = x = y = turn = hxx = xi_hyy = xi2_hyy = 0;
#pragma omp simd reduction(+ : value, scale, x, y, turn, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy)
    for (int i = 0; i < row.count; i++) {
      const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0;
      const double vx = in * (qx[i] + ax), vy = in * (qy[i] + a1 + a2 * xi), n2 = vx * vx + vy * vy, size = sqrt(n2);
      const double inverse = 1 / n2, s = n2 > b * b ? b * size * inverse : in,
                   g  = n2 > b * b ? s * inverse : 0; /* one division */
      const double px = s * vx, py = s * vy, gxx = s - g * vx * vx, gxy = -g * vx * vy, gyy = s - g * vy * vy;

      value += n2 > b * b ? b * size - 0.5 * b * b : 0.5 * n2;
      scale += fabs(px) + fabs(py);
      SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi);
    }
  } else
    hyy = hxx;
  sums->value += value;
  sums->scale += scale;
  sums->sums[0] += x;
  sums->sums[1] += y;
  sums->sums[2] += turn - row.eta * x;
  SamGramTangentialRow(sums->gram, (const double[6]){hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy}, row.eta);
}

static void PassTangential(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  const Cells *c = (const Cells *)context;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    PetscInt first, last;
    Dual     sums = {0};

    SamBoundRange(f->grid->nx, c->bound + (ptrdiff_t)j * f->grid->nx, &first, &last);
    for (PetscInt i = first; i < last; i += SAM_CHUNK) {
      const SamRow  row = SamFrameRow(f, j, i, PetscMin(i + SAM_CHUNK, last));
      const double *qx  = c->field + row.first;

      AddShears(row, qx, qx + f->grid->cells, c->bound + row.first, a, &sums);
    }
    SamAddAll(DUAL, dual, (const double *)&sums);
  }
}

/* The projection of some cells of a row in place of the shear, and its moments. */
SAM_VECTORIZED static void ApplyShears(SamRow row, double *restrict qx, double *restrict qy,
                                       const double *restrict bound, const double a[3], Dual *sums)
{
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];
  double       scale = 0, x = 0, y = 0, turn = 0;

#pragma omp simd reduction(+ : scale, x, y, turn)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0;
    const double vx = in * (qx[i] + ax), vy = in * (qy[i] + a1 + a2 * xi), n2 = vx * vx + vy * vy,
                 s  = n2 > b * b ? b / sqrt(n2) : in;
    const double px = s * vx, py = s * vy;

    qx[i] = px;
    qy[i] = py;
    scale += fabs(px) + fabs(py);
    x += px;
    y += py;
    turn += xi * py;
  }
  sums->scale += scale;
  sums->sums[0] += x;
  sums->sums[1] += y;
  sums->sums[2] += turn - row.eta * x;
}

/* The projection that belongs to a, in place of q, and its moments. */
static PetscErrorCode ApplyTangential(const SamFrame *f, const double bound[], const double a[3], double q[],
                                      SamTotal dual[])
{
  const PetscInt nx = f->grid->nx;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double *b  = bound + (ptrdiff_t)j * nx;
    double       *qx = q + (ptrdiff_t)j * nx, *qy = qx + f->grid->cells;
    PetscInt      first, last;
    Dual          sums = {0};

    SamBoundRange(nx, b, &first, &last);
    PetscCall(PetscArrayzero(qx, first));
    PetscCall(PetscArrayzero(qy, first));
    ApplyShears(SamFrameRow(f, j, first, last), qx + first, qy + first, b + first, a, &sums);
    PetscCall(PetscArrayzero(qx + last, nx - last));
    PetscCall(PetscArrayzero(qy + last, nx - last));
    SamAddAll(DUAL, dual, (const double *)&sums);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  First, where that is likely to be enough, one step of Newton's method is applied without a further pass over the
  cells. If it was not enough, it is a start, and the result is the nearest shear to this start.
*/
PetscErrorCode SamFrameProjectTangential(const SamFrame *f, const double bound[], PetscBool nearest, double q[],
                                         PetscBool *found)
{
  const Cells cells = {.field = q, .bound = bound};
  PetscBool   near  = PETSC_TRUE;

  PetscFunctionBegin;
  *found = PETSC_FALSE;
  for (PetscInt time = nearest ? 1 : 0; time < 2 && !*found; time++) {
    SamTotal totals[DUAL] = {{0, 0}};
    double   a[3]         = {0, 0, 0};

    if (f->count)
      PetscCall(MinimizeDual(f, PassTangential, &cells, time == 0 ? SMOOTH : 0, a, found, &near));
    else
      *found = PETSC_TRUE;
    if (!*found && (!near || time > 0)) break;
    PetscCall(ApplyTangential(f, bound, a, q, totals));
    if (!*found) PetscCall(IsBalanced(f, totals, EXACT, found));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

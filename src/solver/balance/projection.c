/*
  Nearest tractions in equilibrium.

  The projection of v on the admissible tractions (pressures >= 0, or shears in their discs) that carry given loads F is
  x = P(v + phi a): P acts on each cell alone, and the at most three numbers a maximise a concave function, that is they
  minimise the dual
      sum phi_b(|v + phi a|) - a.F,     phi_b(n) = n^2/2 up to the bound b, b n - b^2/2 beyond
  (for pressures: half the square of the positive part). Its gradient is sum phi'P(v + phi a) - F, the error of
  equilibrium; Newton's method with a line search on the dual needs a few passes over the cells and no transform. When
  no admissible traction carries F the dual has no minimum and a runs away.
*/
#include <petsam/private/balanceimpl.h>
#include <math.h>

#define NEWTON_MAX   60
#define HALVINGS_MAX 40
#define PROJECT_MAX  4
/*
  Relative errors of equilibrium: rounding at best, rounding at worst, nearly none, and what one step of Newton's
  method takes from there to the first for shears, whose equations are not linear.
*/
#define EXACT  1e-14
#define ENOUGH 1e-11
#define CLOSE  1e-3
#define SMOOTH 1e-6

/* Value, gradient (without F) and Hessian of the dual, and sum |x| as the scale of the gradient. */
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

/* Newton's method for the dual. Stops when equilibrium holds to rounding, or when steps no longer improve it; `near`:
   it nearly holds. With an error of less than `once` at the start one step is made, and what comes of it is for the
   caller to see. */
static PetscErrorCode MinimizeDual(const SamFrame *f, DualPass pass, const void *context, double once, double a[3],
                                   PetscBool *found, PetscBool *near)
{
  Dual   now, next;
  double error[3], size;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3; i++) a[i] = 0;
  PetscCall(Evaluate(f, pass, context, a, &now));
  size   = Imbalance(f, &now, error);
  *found = PETSC_FALSE;
  *near  = PETSC_TRUE;
  if (size > EXACT && size <= once) {
    SamFrameSolve(f, now.gram, error, a);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt it = 0; it < NEWTON_MAX && size > EXACT; it++) {
    double step[3], trial[3], slope = 0, t = 1, before = size;

    SamFrameSolve(f, now.gram, error, step);
    for (PetscInt i = 0; i < 3; i++) slope += error[i] * step[i];
    if (!(slope > 0)) { /* the Hessian vanishes along the error: go along the error itself */
      for (PetscInt i = 0; i < 3; i++) step[i] = error[i];
      for (PetscInt i = 0; i < 3; i++) slope += error[i] * step[i];
    }
    for (PetscInt h = 0;; h++) {
      double trial_size;

      for (PetscInt i = 0; i < 3; i++) trial[i] = a[i] + t * step[i];
      PetscCall(Evaluate(f, pass, context, trial, &next));
      trial_size = Imbalance(f, &next, error);
      /* near the minimum rounding hides the fall of the value, but not that of the gradient */
      if (next.value <= now.value - 1e-4 * t * slope || trial_size < 0.5 * size ||
          t * slope <= 1e-13 * fabs(now.value) || h == HALVINGS_MAX) {
        size = trial_size;
        break;
      }
      t *= 0.5;
    }
    if (size >= before && before <= ENOUGH) { /* at rounding: keep the better one */
      size = before;
      break;
    }
    for (PetscInt i = 0; i < 3; i++) a[i] = trial[i];
    now = next;
    if (t < 1e-9) break;
  }
  *found = size <= ENOUGH ? PETSC_TRUE : PETSC_FALSE;
  *near  = size <= CLOSE ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  const float  *mask;    /* normal: 1 for cells that count, else 0; NULL: all, or those with pressure */
  PetscBool     contact; /* which of the two */
  float        *row;     /* then: a row of ones, or room for a row */
  const char   *busy;    /* stretches with cells that count, or pressure; NULL: all */
  const double *field;
  const float  *step; /* normal: added to the field with the factor `by` */
  double        by;
  const double *bound;
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

/* Some pressures x = max(0, field + by step + phi a) of the cells that count. */
SAM_VECTORIZED static void AddPressures(PetscInt n, const double *restrict field, const float *restrict step, double by,
                                        const float *restrict mask, double xi0, double dxi, double eta,
                                        const double a[3], Dual *row)
{
  const double ax = a[0] - a[1] * eta, a2 = a[2];
  double       value = 0, x = 0, turn = 0, count = 0, sum_xi = 0, xi2 = 0;

#pragma omp simd reduction(+ : value, x, turn, count, sum_xi, xi2)
  for (PetscInt i = 0; i < n; i++) {
    const double xi = xi0 + (double)i * dxi, v = field[i] + by * (double)step[i] + (ax + a2 * xi),
                 in = v > 0 ? (double)mask[i] : 0, p = in * v;

    value += 0.5 * p * p;
    x += p;
    turn += xi * p;
    count += in;
    sum_xi += in * xi;
    xi2 += in * xi * xi;
  }
  row->value += value;
  row->scale += x;
  row->sums[0] += x;
  row->sums[1] -= eta * x;
  row->sums[2] += turn;
  SamGramNormalRow(row->gram, count, sum_xi, xi2, eta);
}

static void PassNormal(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  const Cells   *c  = (const Cells *)context;
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double *field = c->field + (ptrdiff_t)j * nx;
    const float  *mask = MaskOfRow(c, nx, j), *step = c->step + (c->by != 0 ? (ptrdiff_t)j * nx : 0);
    const char   *busy = BusyOfRow(c, f->grid, j);
    Dual          row  = {0};

    for (PetscInt i = 0, end = 0; SamNextBusy(busy, nx, &i, &end);)
      AddPressures(end - i, field + i, step + i, c->by, mask + i, f->xi0 + (double)i * f->dxi, f->dxi,
                   SamFrameEta(f, j), a, &row);
    SamAddAll(DUAL, dual, (const double *)&row);
  }
}

/*
  p = max(0, p + by step + phi a) on cells of a row that count, 0 on others; the change times `scale` is added to made.
*/
SAM_VECTORIZED static void ApplyNormal(PetscInt n, const float *restrict step, double by, const float *restrict mask,
                                       double xi0, double dxi, double eta, const double a[3], double scale,
                                       double *restrict p, float *restrict made, Dual *row)
{
  const double ax = a[0] - a[1] * eta, a2 = a[2];
  double       sum = 0, turn = 0;

#pragma omp simd reduction(+ : sum, turn)
  for (PetscInt i = 0; i < n; i++) {
    const double xi = xi0 + (double)i * dxi, v = p[i] + by * (double)step[i] + (ax + a2 * xi),
                 x = v > 0 ? (double)mask[i] * v : 0;

    made[i] += (float)(scale * (x - p[i]));
    p[i] = x;
    sum += x;
    turn += xi * x;
  }
  row->scale += sum;
  row->sums[0] += sum;
  row->sums[1] -= eta * sum;
  row->sums[2] += turn;
}

/* The projection that belongs to a, in place of the field, and the moments of what it is then. */
static void ApplyRows(const SamFrame *f, const Cells *c, const double a[3], double scale, double p[], float made[],
                      float ignored[], SamTotal dual[])
{
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const ptrdiff_t k    = (ptrdiff_t)j * nx;
    const float    *mask = MaskOfRow(c, nx, j), *step = c->step + (c->by != 0 ? k : 0);
    const char     *busy = BusyOfRow(c, f->grid, j);
    float          *to   = made ? made + k : ignored;
    Dual            row  = {0};

    for (PetscInt i = 0, end = 0; SamNextBusy(busy, nx, &i, &end);)
      ApplyNormal(end - i, step + i, c->by, mask + i, f->xi0 + (double)i * f->dxi, f->dxi, SamFrameEta(f, j), a, scale,
                  p + k + i, to + i, &row);
    SamAddAll(DUAL, dual, (const double *)&row);
  }
}

/* Whether what has been made is in equilibrium up to a relative error. */
static PetscErrorCode IsBalanced(const SamFrame *f, const SamTotal totals[], double limit, PetscBool *balanced)
{
  Dual   dual;
  double error[3];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(f->grid->comm, DUAL, totals, (double *)&dual));
  *balanced = Imbalance(f, &dual, error) <= limit ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The projection of the field p + by step, for a step that nearly carries the loads in few passes: one for the step of
  Newton's method, and one that makes it and sees whether that was all. One row of zeros stands for no step, and takes
  what nobody wants to know of the change.
*/
static PetscErrorCode ProjectNormal(const SamFrame *f, Cells cells, double p[], double scale, float made[],
                                    PetscBool *found)
{
  const PetscInt nx     = f->grid->nx;
  double        *before = NULL;
  float         *zeros, *ignored;
  PetscBool      near = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(nx, &cells.row));
  PetscCall(PetscCalloc2(nx, &zeros, nx, &ignored));
  for (PetscInt i = 0; i < nx; i++) cells.row[i] = 1;
  cells.field = p;
  if (cells.by == 0) cells.step = zeros;
  *found = PETSC_FALSE;
  /*
    pressures far above the load leave it to rounding; once projected they are of its size, and a second time is exact
  */
  for (PetscInt time = 0; time < PROJECT_MAX && !*found && near; time++) {
    const PetscBool once         = (made && time == 0) ? PETSC_TRUE : PETSC_FALSE;
    SamTotal        totals[DUAL] = {{0, 0}};
    double          a[3]         = {0, 0, 0};

    if (f->count)
      PetscCall(MinimizeDual(f, PassNormal, &cells, once ? CLOSE : 0, a, found, &near));
    else
      *found = PETSC_TRUE;
    if (!*found && near && !before && !made) {
      PetscCall(PetscMalloc1(f->grid->cells, &before));
      PetscCall(PetscArraycpy(before, p, f->grid->cells));
    }
    if (near) ApplyRows(f, &cells, a, scale, p, made, ignored, totals);
    if (once && near && !*found) PetscCall(IsBalanced(f, totals, ENOUGH, found));
    cells.by   = 0;
    cells.step = zeros;
  }
  if (!*found && before) PetscCall(PetscArraycpy(p, before, f->grid->cells));
  for (PetscInt k = 0; !*found && made && k < f->grid->cells; k++) p[k] = PetscMax(0, p[k] - (double)made[k] / scale);
  PetscCall(PetscFree(before));
  PetscCall(PetscFree(cells.row));
  PetscCall(PetscFree2(zeros, ignored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormal(const SamFrame *f, const float mask[], double p[], PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(ProjectNormal(f, (Cells){.mask = mask}, p, 0, NULL, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalStep(const SamFrame *f, const float mask[], const char busy[], double p[],
                                         double by, const float step[], double scale, float made[], PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(made, f->grid->cells));
  PetscCall(ProjectNormal(f, (Cells){.mask = mask, .busy = busy, .step = step, .by = by}, p, scale, made, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *f, double p[], PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(ProjectNormal(f, (Cells){.contact = PETSC_TRUE}, p, 0, NULL, found));
  if (!*found) PetscCall(SamFrameProjectNormal(f, NULL, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Part of a row of shears, n <= SAM_CHUNK: v = field + phi a, projected on its disc, x = D(v), and the derivative h of
  D.
*/
SAM_VECTORIZED static void AddShears(PetscInt n, const double *restrict qx, const double *restrict qy,
                                     const double *restrict bound, double xi0, double dxi, double eta,
                                     const double a[3], Dual *row)
{
  const double ax = SamFrameX(a, eta), a1 = a[1], a2 = a[2];
  double value = 0, scale = 0, x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0,
         beyond = 0;

#pragma omp simd reduction(+ : value, scale, x, y, turn, hxx, xi_hyy, xi2_hyy, beyond)
  for (PetscInt i = 0; i < n; i++) {
    const double xi = xi0 + (double)i * dxi, b = bound[i], in = b > 0 ? 1 : 0;
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
    for (PetscInt i = 0; i < n; i++) {
      const double xi = xi0 + (double)i * dxi, b = bound[i], in = b > 0 ? 1 : 0;
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
  row->value += value;
  row->scale += scale;
  row->sums[0] += x;
  row->sums[1] += y;
  row->sums[2] += turn - eta * x;
  SamGramTangentialRow(row->gram, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy, eta);
}

static void PassTangential(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  const Cells   *c  = (const Cells *)context;
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double *qx = c->field + (ptrdiff_t)j * nx, *qy = qx + f->grid->cells, *b = c->bound + (ptrdiff_t)j * nx;
    PetscInt      first, last;
    Dual          row = {0};

    SamBoundRange(nx, b, &first, &last);
    for (PetscInt i = first; i < last; i += SAM_CHUNK)
      AddShears(PetscMin(SAM_CHUNK, last - i), qx + i, qy + i, b + i, f->xi0 + (double)i * f->dxi, f->dxi,
                SamFrameEta(f, j), a, &row);
    SamAddAll(DUAL, dual, (const double *)&row);
  }
}

/* A row's projection in place of the field, and its moments. */
SAM_VECTORIZED static void ApplyShears(PetscInt n, double *restrict qx, double *restrict qy,
                                       const double *restrict bound, double xi0, double dxi, double eta,
                                       const double a[3], Dual *row)
{
  const double ax = SamFrameX(a, eta), a1 = a[1], a2 = a[2];
  double       scale = 0, x = 0, y = 0, turn = 0;

#pragma omp simd reduction(+ : scale, x, y, turn)
  for (PetscInt i = 0; i < n; i++) {
    const double xi = xi0 + (double)i * dxi, b = bound[i], in = b > 0 ? 1 : 0;
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
  row->scale += scale;
  row->sums[0] += x;
  row->sums[1] += y;
  row->sums[2] += turn - eta * x;
}

/* The projection that belongs to a, in place of q, and the moments of what it is then. */
static PetscErrorCode ApplyTangential(const SamFrame *f, const double bound[], const double a[3], double q[],
                                      SamTotal dual[])
{
  const PetscInt nx = f->grid->nx;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double *b  = bound + (ptrdiff_t)j * nx;
    double       *qx = q + (ptrdiff_t)j * nx, *qy = qx + f->grid->cells;
    PetscInt      first, last;
    Dual          row = {0};

    SamBoundRange(nx, b, &first, &last);
    PetscCall(PetscArrayzero(qx, first));
    PetscCall(PetscArrayzero(qy, first));
    ApplyShears(last - first, qx + first, qy + first, b + first, f->xi0 + (double)first * f->dxi, f->dxi,
                SamFrameEta(f, j), a, &row);
    PetscCall(PetscArrayzero(qx + last, nx - last));
    PetscCall(PetscArrayzero(qy + last, nx - last));
    SamAddAll(DUAL, dual, (const double *)&row);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  At first, where that is likely to do, one step of Newton's method is made without looking; what comes of it is a start
  if it does not, and then the result is the nearest shear to this start.
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

/*
  Nearest tractions in equilibrium.

  The projection of v on the admissible tractions (pressures >= 0, or shears in their discs) that carry given loads F is
  x = P(v + phi a): P acts on each cell alone, and the at most three numbers a maximise a concave function, that is they
  minimise the dual
      sum phi_b(|v + phi a|) - a.F,     phi_b(n) = n^2/2 up to the bound b, b n - b^2/2 beyond
  (for pressures: half the square of the positive part). Its gradient is sum phi'P(v + phi a) - F, the error of
  equilibrium; Newton's method with a line search on the dual needs a few passes over the cells and no transform. When no
  admissible traction carries F the dual has no minimum and a runs away.
*/
#include "balanceimpl.h"
#include <math.h>

#define NEWTON_MAX 60
#define HALVINGS_MAX 40
#define PROJECT_MAX  4

/* Value, gradient (without F) and Hessian of the dual, and sum |x| as the scale of the gradient. */
typedef struct {
  double value, sums[3], gram[SAM_GRAM], scale;
} Dual;

typedef void (*DualPass)(const SamFrame *f, const void *context, const double a[3], Dual *dual);

static PetscErrorCode Evaluate(const SamFrame *f, DualPass pass, const void *context, const double a[3], Dual *dual)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(dual, sizeof(*dual)));
  pass(f, context, a, dual);
  PetscCall(SamSum(f->grid->comm, (PetscInt)(sizeof(*dual) / sizeof(double)), (double *)dual));
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

/*
  The passes sum row by row: one running sum over all cells of nearly equal terms would be wrong by up to the number of
  cells in units of rounding, which on large grids exceeds what equilibrium is asked for.
*/
static void AddDual(Dual *total, const Dual *row)
{
  double       *t = (double *)total;
  const double *r = (const double *)row;

  for (size_t k = 0; k < sizeof(Dual) / sizeof(double); k++) t[k] += r[k];
}

/* Newton's method for the dual. Stops when equilibrium holds to rounding, or when steps no longer improve it; `near`: it
   nearly holds. */
static PetscErrorCode MinimizeDual(const SamFrame *f, DualPass pass, const void *context, double a[3], PetscBool *found, PetscBool *near)
{
  const double exact = 1e-14, enough = 1e-11, close = 1e-3;
  Dual         now, next;
  double       error[3], size;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3; i++) a[i] = 0;
  PetscCall(Evaluate(f, pass, context, a, &now));
  size = Imbalance(f, &now, error);
  for (PetscInt it = 0; it < NEWTON_MAX && size > exact; it++) {
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
      if (next.value <= now.value - 1e-4 * t * slope || trial_size < 0.5 * size || t * slope <= 1e-13 * fabs(now.value) || h == HALVINGS_MAX) {
        size = trial_size;
        break;
      }
      t *= 0.5;
    }
    if (size >= before && before <= enough) { /* at rounding: keep the better one */
      size = before;
      break;
    }
    for (PetscInt i = 0; i < 3; i++) a[i] = trial[i];
    now = next;
    if (t < 1e-9) break;
  }
  *found = size <= enough ? PETSC_TRUE : PETSC_FALSE;
  *near  = size <= close ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  const char   *mask;
  const double *field;
  const double *bound;
} Cells;

static inline void AddNormal(Dual *d, double x, double xi, double eta)
{
  d->value += 0.5 * x * x;
  d->scale += x;
  d->sums[0] += x;
  d->sums[1] -= x * eta;
  d->sums[2] += x * xi;
  SamGramAddNormal(d->gram, xi, eta);
}

static void PassNormal(const SamFrame *f, const void *context, const double a[3], Dual *dual)
{
  const Cells   *c  = (const Cells *)context;
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;
    Dual         row = {0};

    for (PetscInt i = 0; i < nx; i++) {
      const double xi = f->xi0 + (double)i * f->dxi;
      double       x;

      if (c->mask && !c->mask[j * nx + i]) continue;
      x = c->field[j * nx + i] + SamFrameNormal(a, xi, eta);
      if (x > 0) AddNormal(&row, x, xi, eta);
    }
    AddDual(dual, &row);
  }
}

static void ApplyNormal(const SamFrame *f, const char mask[], const double a[3], double p[])
{
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k = j * nx + i;

      p[k] = (mask && !mask[k]) ? 0 : PetscMax(0, p[k] + SamFrameNormal(a, f->xi0 + (double)i * f->dxi, eta));
    }
  }
}

PetscErrorCode SamFrameProjectNormal(const SamFrame *f, const char mask[], double p[], PetscBool *found)
{
  const Cells cells  = {mask, p, NULL};
  double     *before = NULL;
  PetscBool   near   = PETSC_TRUE;

  PetscFunctionBegin;
  *found = PETSC_FALSE;
  /* pressures far above the load leave it to rounding; once projected they are of its size, and a second time is exact */
  for (PetscInt time = 0; time < PROJECT_MAX && !*found && near; time++) {
    double a[3] = {0, 0, 0};

    if (f->count) PetscCall(MinimizeDual(f, PassNormal, &cells, a, found, &near));
    else *found = PETSC_TRUE;
    if (!*found && near && !before) {
      PetscCall(PetscMalloc1(f->grid->cells, &before));
      PetscCall(PetscArraycpy(before, p, f->grid->cells));
    }
    if (near) ApplyNormal(f, mask, a, p);
  }
  if (!*found && before) PetscCall(PetscArraycpy(p, before, f->grid->cells));
  PetscCall(PetscFree(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *f, double p[], PetscBool *found)
{
  const PetscInt cells = f->grid->cells;
  char          *mask;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(cells, &mask));
  for (PetscInt k = 0; k < cells; k++) mask[k] = p[k] > 0;
  PetscCall(SamFrameProjectNormal(f, mask, p, found));
  PetscCall(PetscFree(mask));
  if (!*found) PetscCall(SamFrameProjectNormal(f, NULL, p, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline void AddShear(Dual *d, double x, double y, double value, double xi, double eta)
{
  d->value += value;
  d->scale += fabs(x) + fabs(y);
  d->sums[0] += x;
  d->sums[1] += y;
  d->sums[2] += xi * y - eta * x;
}

static void PassTangential(const SamFrame *f, const void *context, const double a[3], Dual *dual)
{
  const Cells   *c  = (const Cells *)context;
  const PetscInt nx = f->grid->nx;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;
    Dual         row = {0};

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k  = j * nx + i;
      const double   b  = c->bound[k], xi = f->xi0 + (double)i * f->dxi;
      double         vx, vy, n, s;

      if (b <= 0) continue;
      vx = c->field[k] + SamFrameX(a, eta);
      vy = c->field[f->grid->cells + k] + SamFrameY(a, xi);
      n  = vx * vx + vy * vy;
      if (n <= b * b) {
        AddShear(&row, vx, vy, 0.5 * n, xi, eta);
        SamGramAddTangential(row.gram, 1, 0, 1, xi, eta);
        continue;
      }
      n = sqrt(n);
      s = b / n;
      AddShear(&row, s * vx, s * vy, b * n - 0.5 * b * b, xi, eta);
      SamGramAddTangential(row.gram, s * vy * vy / (n * n), -s * vx * vy / (n * n), s * vx * vx / (n * n), xi, eta);
    }
    AddDual(dual, &row);
  }
}

PetscErrorCode SamFrameProjectTangential(const SamFrame *f, const double bound[], double q[], PetscBool *found)
{
  const Cells    cells = {NULL, q, bound};
  const PetscInt nx = f->grid->nx, ncells = f->grid->cells;
  PetscBool      near;
  double         a[3] = {0, 0, 0};

  PetscFunctionBegin;
  *found = PETSC_TRUE;
  if (f->count) PetscCall(MinimizeDual(f, PassTangential, &cells, a, found, &near));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k  = j * nx + i;
      const double   b  = bound[k];
      const double   vx = q[k] + SamFrameX(a, eta), vy = q[ncells + k] + SamFrameY(a, f->xi0 + (double)i * f->dxi);
      const double   n2 = vx * vx + vy * vy;
      const double   s  = b <= 0 ? 0 : (n2 > b * b ? b / sqrt(n2) : 1);

      q[k]          = s * vx;
      q[ncells + k] = s * vy;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

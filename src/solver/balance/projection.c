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
#include "projectionimpl.h"
#include <math.h>

#define NEWTON_MAX   60
#define HALVINGS_MAX 40

static PetscErrorCode Evaluate(const SamFrame *f, SamDualPass pass, const void *context, const double a[3],
                               SamDual *dual)
{
  SamTotal totals[SAM_DUAL] = {{0, 0}};

  PetscFunctionBegin;
  pass(f, context, a, totals);
  PetscCall(SamSumTotals(f->grid->comm, SAM_DUAL, totals, (double *)dual));
  /* subtract a.F and F along the free subspace */
  for (PetscInt k = 0; k < f->count; k++)
    for (PetscInt i = 0; i < 3; i++) dual->value -= a[i] * f->basis[k][i] * f->target[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Error of equilibrium along the basis, as a combination of the phi; returns its size relative to the scale. */
static double Imbalance(const SamFrame *f, const SamDual *dual, double error[3])
{
  double size = 0, load = 0;

  for (PetscInt i = 0; i < 3; i++) error[i] = 0;
  for (PetscInt k = 0; k < f->count; k++) {
    double e = f->target[k];

    for (PetscInt i = 0; i < 3; i++) e -= f->basis[k][i] * dual->sums[i];
    for (PetscInt i = 0; i < 3; i++) error[i] += e * f->basis[k][i];
    size = SamLarger(size, fabs(e));
    load = PetscMax(load, fabs(f->target[k]));
  }
  load = PetscMax(load, dual->scale);
  return load > 0 ? size / load : 0;
}

/* The Newton step for an error of equilibrium; returns the slope of the dual along it, down being positive. */
static double NewtonStep(const SamFrame *f, const SamDual *dual, const double error[3], double step[3])
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
  double  a[3];
  SamDual dual;
  double  error[3], size; /* error of equilibrium, and its relative size */
} Iterate;

/* A step with halving from `now` to `next`; returns the part of the Newton step that was made. */
static PetscErrorCode SearchLine(const SamFrame *f, SamDualPass pass, const void *context, const Iterate *now,
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

PetscErrorCode SamDualMinimize(const SamFrame *f, SamDualPass pass, const void *context, double once, double a[3],
                               PetscBool *found, PetscBool *near)
{
  Iterate now = {.a = {0, 0, 0}}, next;

  PetscFunctionBegin;
  PetscCall(Evaluate(f, pass, context, now.a, &now.dual));
  now.size = Imbalance(f, &now.dual, now.error);
  *found   = PETSC_FALSE;
  *near    = PETSC_TRUE;
  if (now.size > SAM_BALANCED_EXACT && now.size <= once) {
    SamFrameSolve(f, now.dual.gram, now.error, a);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt it = 0; it < NEWTON_MAX && now.size > SAM_BALANCED_EXACT; it++) {
    double length = 0;

    PetscCall(SearchLine(f, pass, context, &now, &next, &length));
    if (next.size >= now.size && now.size <= SAM_BALANCED_ENOUGH) break; /* at rounding: keep the better one */
    now = next;
    if (length < 1e-9) break;
  }
  for (PetscInt i = 0; i < 3; i++) a[i] = now.a[i];
  *found = now.size <= SAM_BALANCED_ENOUGH ? PETSC_TRUE : PETSC_FALSE;
  *near  = now.size <= SAM_BALANCED_NEAR ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDualIsBalanced(const SamFrame *f, const SamTotal totals[], double limit, PetscBool *balanced)
{
  SamDual dual;
  double  error[3];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(f->grid->comm, SAM_DUAL, totals, (double *)&dual));
  *balanced = Imbalance(f, &dual, error) <= limit ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

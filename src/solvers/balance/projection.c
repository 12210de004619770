/*
  Nearest tractions in equilibrium.

  Problem: given a traction v, find the nearest admissible one (pressures >= 0 and up to a limit H, or shears in their
  discs) that carries the loads F.

  Algorithm: the solution is x = P(v + phi a), where P projects each cell by itself, and the at most three numbers a
  minimise the dual, a convex function:
      sum psi_b(|v + phi a|) - a.F,     psi_b(n) = n^2/2 up to the bound b, b n - b^2/2 beyond
  (for pressures: half the square of the positive part, and H v - H^2/2 beyond H). Its gradient is sum phi'P(v + phi a)
  - F, the error of equilibrium. Newton's method with a line search on the dual takes a few passes over the cells and no
  transform. If no admissible traction carries F, the dual has no minimum and a grows without bound.
*/
#include "projectionimpl.h"
#include <math.h>

#define NEWTON_MAX 60
/* Successive steps without an improvement of the value or of the error of equilibrium, after which all is rounding */
#define IDLE_MAX 5
/* Trials of a line search, and the ratio of the next length to the last one while the value still falls */
#define TRIALS_MAX 60
#define FARTHER    4.0
/* The least fall of the value, and the largest slope at the end of a step, as parts of the slope at its beginning */
#define ENOUGH_FALL 1e-4
#define MUCH_SLOPE  0.9
/* If the error outside the Hessian's range exceeds this part of the error of equilibrium, the step goes along it. */
#define UNSEEN 0.1
/* A traction has vanished if its sum falls to this part. */
#define VANISHED 1e-13
/* Rounding of the dual's value, relative to its parts. */
#define VALUE_ROUNDING 1e-13

/* Computes the error of equilibrium along the basis, as a combination of the phi; returns its relative size. */
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

/*
  Computes the Newton step for an error of equilibrium; returns the slope of the dual along it, positive downwards. If
  most of the error is outside the Hessian's range, because too few cells are within their bounds, the step goes along
  that part of the error.
*/
static double NewtonStep(const SamFrame *f, const SamDual *dual, const double error[3], double step[3])
{
  double       unseen[3];
  const double part = SamFrameSolveSeen(f, dual->gram, error, step, unseen);

  if (!(part <= UNSEEN))
    for (PetscInt i = 0; i < 3; i++) step[i] = unseen[i];
  return SamFrameDot(error, step);
}

/* An iterate of Newton's method. */
typedef struct {
  double  a[3];
  SamDual dual;
  double  error[3], size; /* error of equilibrium, and its relative size */
  double  rounding;       /* rounding error of the dual's value */
} Iterate;

/* Computes the dual, its gradient and rounding at a. */
static PetscErrorCode EvaluateAt(const SamFrame *f, SamDualPass pass, const void *context, Iterate *at)
{
  SamTotal totals[SAM_DUAL] = {{0}};
  double   load             = 0;

  PetscFunctionBegin;
  pass(f, context, at->a, totals);
  PetscCall(SamSumTotals(f->grid->comm, SAM_DUAL, totals, (double *)&at->dual));
  for (PetscInt k = 0; k < f->count; k++) load += SamFrameDot(at->a, f->basis[k]) * f->target[k];
  at->dual.value -= load;
  at->size     = Imbalance(f, &at->dual, at->error);
  at->rounding = VALUE_ROUNDING * (fabs(at->dual.value) + 2 * fabs(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Makes a step from `now` to `next`. The value must fall by at least a part of the prediction of the slope, and the
  slope must fall below MUCH_SLOPE of its start. The Newton step itself fulfils both near the minimum. Far from it,
  where the bounds of most cells hold, the dual is nearly linear and a step may be too short by orders of magnitude, so
  the search goes outward as well. `ends`: false if the value falls however far it goes, so that there is no minimum.
*/
static PetscErrorCode SearchLine(const SamFrame *f, SamDualPass pass, const void *context, const Iterate *now,
                                 Iterate *next, PetscBool *ends)
{
  double       step[3], t = 1, least = 0, most = INFINITY;
  const double slope = NewtonStep(f, &now->dual, now->error, step);

  PetscFunctionBegin;
  *ends = PETSC_FALSE;
  for (PetscInt trial = 0; trial < TRIALS_MAX && !*ends; trial++) {
    double end;
    int    fell;

    for (PetscInt i = 0; i < 3; i++) next->a[i] = now->a[i] + t * step[i];
    PetscCall(EvaluateAt(f, pass, context, next));
    end = SamFrameDot(next->error, step);
    if (now->size <= SAM_BALANCED_ENOUGH) break;                   /* rounding dominates */
    fell = t * slope <= now->rounding ? end >= -MUCH_SLOPE * slope /* the change is below the value's rounding */
                                      : next->dual.value <= now->dual.value - ENOUGH_FALL * t * slope;
    if (!fell)
      most = t;
    else if (end > MUCH_SLOPE * slope)
      least = t;
    else
      *ends = PETSC_TRUE;
    t = isfinite(most) ? 0.5 * (least + most) : FARTHER * t;
  }
  if (isfinite(most) || now->size <= SAM_BALANCED_ENOUGH) *ends = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDualMinimize(const SamFrame *f, SamDualPass pass, const void *context, double once, double a[3],
                               PetscBool *found, PetscBool *near)
{
  Iterate   now  = {.a = {0, 0, 0}}, next, best;
  PetscBool ends = PETSC_TRUE;
  PetscInt  idle = 0;

  PetscFunctionBegin;
  PetscCall(EvaluateAt(f, pass, context, &now));
  *found = PETSC_FALSE;
  *near  = PETSC_TRUE;
  if (now.size > SAM_BALANCED_EXACT && now.size <= once) {
    SamFrameSolve(f, now.dual.gram, now.error, a);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  best = now;
  for (PetscInt it = 0; it < NEWTON_MAX && now.size > SAM_BALANCED_EXACT && ends; it++) {
    PetscCall(SearchLine(f, pass, context, &now, &next, &ends));
    idle = next.size < best.size || next.dual.value < now.dual.value - now.rounding ? 0 : idle + 1;
    now  = next;
    if (now.size < best.size) best = now;
    if (idle && (best.size <= SAM_BALANCED_ENOUGH || idle > IDLE_MAX)) break; /* only rounding is left */
  }
  for (PetscInt i = 0; i < 3; i++) a[i] = best.a[i];
  *found = best.size <= SAM_BALANCED_ENOUGH;
  *near  = best.size <= SAM_BALANCED_NEAR;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDualVanish(const SamFrame *f, SamDualPass pass, const void *context, double a[3], PetscBool *vanishes)
{
  Iterate   now = {.a = {0, 0, 0}}, next;
  double    first;
  PetscBool ends;

  PetscFunctionBegin;
  PetscCall(EvaluateAt(f, pass, context, &now));
  first = now.dual.scale;
  for (PetscInt it = 0; it < NEWTON_MAX && now.dual.scale > VANISHED * first; it++) {
    PetscCall(SearchLine(f, pass, context, &now, &next, &ends));
    if (!(next.dual.value < now.dual.value)) break;
    now = next;
  }
  *vanishes = now.dual.scale <= VANISHED * first;
  for (PetscInt i = 0; i < 3; i++) a[i] = now.a[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDualIsBalanced(const SamFrame *f, const SamTotal totals[], double limit, PetscBool *balanced)
{
  SamDual dual;
  double  error[3];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(f->grid->comm, SAM_DUAL, totals, (double *)&dual));
  *balanced = Imbalance(f, &dual, error) <= limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

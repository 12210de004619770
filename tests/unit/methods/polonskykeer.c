/*
  The classical projected conjugate gradients of Polonsky and Keer, for comparison.

  Problem: p >= 0, g >= 0, p g = 0 in every cell, in equilibrium or with given rigid displacements. Without a limit of
  the pressure: with cells at two bounds these steps may go round in circles, and where none is between them there is
  none.

  Algorithm:
    1. g = S p + h less the rigid displacement that fits it best on the contact cells {p > 0}.
    2. A direction on these cells from g, conjugate to the last one.
    3. The exact step along it.
    4. p < 0 is set to 0; cells without pressure that penetrate get some, and then the directions start anew.
    5. p is brought back into equilibrium.
  An iteration takes two products; there is one grid and no preconditioner, so the number of iterations grows with the
  grid. The original scales p to keep N; here p goes to the nearest admissible pressure, which keeps moments as well.

  Reference: Polonsky and Keer 1999, Wear 231, 206-219.
*/
#include "methods.h"

#include <petsam/private/normalimpl.h>
#include <math.h>

typedef struct {
  SamSolver solver;
  SamLevel *level;
  Vec       g, d, s;
  double    motion[3], displacement, error;
  double    norm; /* |g|^2 on the contact */
} Work;

/* The rigid displacement that fits x best on the contact, of the free ones. */
static PetscErrorCode FitOnContact(const Work *w, const double p[], const double x[], double a[3])
{
  const SamFrame *f                    = &w->level->frame;
  const PetscInt  nx                   = w->level->grid->nx;
  SamTotal        totals[3 + SAM_GRAM] = {{0}};
  double          sums[3 + SAM_GRAM];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->level->grid->rows; j++) {
    const double eta               = SamFrameEta(f, j);
    double       row[3 + SAM_GRAM] = {0};

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k  = j * nx + i;
      const double   xi = f->xi0 + (double)i * f->dxi;

      if (p[k] <= 0) continue;
      row[0] += x[k];
      row[1] -= eta * x[k];
      row[2] += xi * x[k];
      SamGramNormalRow(row + 3, 1, xi, xi * xi, eta);
    }
    SamAddAll(3 + SAM_GRAM, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 3 + SAM_GRAM, totals, sums));
  SamFrameSolve(f, sums + 3, sums, a);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 1: g, the motion that fits it on {p > 0} as far as it is free, and the error. */
static PetscErrorCode ComputeGap(Work *w)
{
  const SamFrame *f     = &w->level->frame;
  const PetscInt  nx    = w->level->grid->nx;
  SamTotal        total = {0};
  double          a[3] = {0, 0, 0}, max[2] = {0, 0};
  const double   *p, *h;
  double         *g;

  PetscFunctionBegin;
  PetscCall(SamLevelApply(w->solver, w->level, w->level->traction, w->g));
  PetscCall(VecGetArrayRead(w->level->traction, &p));
  PetscCall(VecGetArrayRead(w->level->given[SAM_NORMAL_SEPARATION], &h));
  PetscCall(VecGetArray(w->g, &g));
  for (PetscInt j = 0; j < w->level->grid->rows; j++) {
    const double eta = SamFrameEta(f, j);

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k = j * nx + i;

      max[0] = PetscMax(max[0], fabs(g[k]));
      g[k] += h[k] - SamFrameNormal(f->fixed, f->xi0 + (double)i * f->dxi, eta);
    }
  }
  PetscCall(FitOnContact(w, p, g, a));
  for (PetscInt j = 0; j < w->level->grid->rows; j++) {
    const double eta = SamFrameEta(f, j);
    double       row = 0;

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k = j * nx + i;

      g[k] -= SamFrameNormal(a, f->xi0 + (double)i * f->dxi, eta);
      max[1] = SamLarger(max[1], p[k] > 0 ? fabs(g[k]) : -g[k]);
      if (p[k] > 0) row += g[k] * g[k];
    }
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArray(w->g, &g));
  PetscCall(VecRestoreArrayRead(w->level->given[SAM_NORMAL_SEPARATION], &h));
  PetscCall(VecRestoreArrayRead(w->level->traction, &p));
  PetscCall(SamMax(w->level->grid->comm, 2, max));
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, &w->norm));
  for (PetscInt c = 0; c < 3; c++) w->motion[c] = f->fixed[c] + a[c];
  w->displacement = max[0];
  w->error        = max[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The exact step along d among pressures in equilibrium: S d counts less its rigid part. */
static PetscErrorCode StepLength(const Work *w, const double p[], const double g[], const double d[], const double s[],
                                 double *tau)
{
  const SamFrame *f         = &w->level->frame;
  const PetscInt  nx        = w->level->grid->nx;
  SamTotal        totals[2] = {{0}};
  double          a[3]      = {0, 0, 0}, sums[2];

  PetscFunctionBegin;
  PetscCall(FitOnContact(w, p, s, a));
  for (PetscInt j = 0; j < w->level->grid->rows; j++) {
    const double eta    = SamFrameEta(f, j);
    double       row[2] = {0, 0};

    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k = j * nx + i;

      if (p[k] <= 0) continue;
      row[0] += g[k] * d[k];
      row[1] += (s[k] - SamFrameNormal(a, f->xi0 + (double)i * f->dxi, eta)) * d[k];
    }
    SamAddAll(2, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 2, totals, sums));
  *tau = sums[1] > 0 ? sums[0] / sums[1] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps 2 to 5. `conjugate` says on entry whether d may be used, on exit whether no cell has entered. */
static PetscErrorCode Step(Work *w, double norm_old, PetscBool *conjugate, PetscBool *found)
{
  const PetscInt cells = w->level->grid->cells;
  const double   beta  = *conjugate && norm_old > 0 ? w->norm / norm_old : 0;
  double         tau = 0, entered = 0;
  double        *p, *g, *d, *s;

  PetscFunctionBegin;
  PetscCall(VecGetArray(w->level->traction, &p));
  PetscCall(VecGetArray(w->g, &g));
  PetscCall(VecGetArray(w->d, &d));
  for (PetscInt k = 0; k < cells; k++) d[k] = p[k] > 0 ? g[k] + beta * d[k] : 0;
  PetscCall(VecRestoreArray(w->d, &d));
  PetscCall(SamLevelApply(w->solver, w->level, w->d, w->s));
  PetscCall(VecGetArray(w->d, &d));
  PetscCall(VecGetArray(w->s, &s));
  PetscCall(StepLength(w, p, g, d, s, &tau));
  for (PetscInt k = 0; k < cells; k++) {
    if (p[k] > 0)
      p[k] = PetscMax(0, p[k] - tau * d[k]);
    else if (g[k] < 0) {
      p[k] = -tau * g[k];
      entered += 1;
    }
  }
  PetscCall(SamSum(w->level->grid->comm, 1, &entered));
  *conjugate = entered > 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(SamFrameProjectNormalOnContact(&w->level->frame, p, found));
  PetscCall(VecRestoreArray(w->s, &s));
  PetscCall(VecRestoreArray(w->d, &d));
  PetscCall(VecRestoreArray(w->g, &g));
  PetscCall(VecRestoreArray(w->level->traction, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamNormalSolve_PolonskyKeer(SamSolver solver, SamLevel *level)
{
  Work            w         = {.solver = solver, .level = level};
  SamSolverReason reason    = SAM_SOLVER_ITERATING;
  PetscBool       conjugate = PETSC_FALSE, found = PETSC_TRUE;
  double          norm_old = 0;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(level->traction, &w.g));
  PetscCall(VecDuplicate(level->traction, &w.d));
  PetscCall(VecDuplicate(level->traction, &w.s));
  for (PetscInt it = 0; !reason; it++) {
    PetscCall(ComputeGap(&w));
    if (it) PetscCall(SamLevelIterated(solver, level, w.error / w.displacement));
    if (!isfinite(w.error))
      reason = SAM_SOLVER_DIVERGED_NAN;
    else if (w.error <= level->rtol * w.displacement)
      reason = SAM_SOLVER_CONVERGED_RTOL;
    else if (it >= SamSolverMaxIterations(solver))
      reason = SAM_SOLVER_DIVERGED_ITS;
    if (reason) break;
    PetscCall(Step(&w, norm_old, &conjugate, &found));
    norm_old = w.norm;
    if (!found) reason = SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  }
  solver->reason = reason;
  solver->error  = w.error / w.displacement;
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = w.motion[c];
  PetscCall(VecDestroy(&w.g));
  PetscCall(VecDestroy(&w.d));
  PetscCall(VecDestroy(&w.s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalCreate_PolonskyKeer(SamSolver solver)
{
  PetscFunctionBegin;
  solver->ops.solve      = SamNormalSolve_PolonskyKeer;
  solver->default_levels = 1;
  solver->default_max_it = 10000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

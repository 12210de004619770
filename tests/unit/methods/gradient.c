/*
  Accelerated projected gradients: a second opinion, for comparison.

  Problem: minimise q.C q/2 + offset.q over the discs |q| <= bound in equilibrium; its gradient is the slip s.

  Algorithm:
    1. y: extrapolation from the last two iterates.
    2. q = P(y - s(y)/L), P the projection onto discs and equilibrium at once; L is doubled until the energy's quadratic
       upper bound at y holds, which makes it an upper bound of the eigenvalues that matter.
    3. When the energy has risen, the extrapolation starts anew.
  It converges always, at a rate that worsens as the grid is refined.

  References: Nesterov 1983; Beck and Teboulle 2009, SIAM J. Imaging Sci. 2, 183; O'Donoghue and Candes 2015 (restart).
*/
#include "methods.h"

#include <petsam/private/tangentialimpl.h>
#include <math.h>

/* No eigenvalue of C is larger, in units of a cell's self-influence: it is below the number of cells along the grid. */
#define STIFFEST 1e7

/* Energy q.C q/2 + (offset - fixed).q from q and s. */
static PetscErrorCode ComputeEnergy(const SamStickSlip *w, double *energy)
{
  const SamFrame *f     = w->frame;
  SamTotal        total = {0};
  double          a[3];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) a[c] = w->motion[c] - 2 * f->fixed[c];
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = SamFrameEta(f, j);
    double       row = 0;

    for (PetscInt i = 0; i < w->nx; i++) {
      const PetscInt k = j * w->nx + i, l = k + w->cells;

      row += 0.5 * w->q[k] * (w->s[k] + (w->offset ? w->offset[k] : 0) + SamFrameX(a, eta));
      row += 0.5 * w->q[l] * (w->s[l] + (w->offset ? w->offset[l] : 0) + SamFrameY(a, f->xi0 + (double)i * f->dxi));
    }
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Products of the change of q from y with that of s from sy, and with itself: curvature and size of a step. */
static PetscErrorCode ComputeBend(const SamStickSlip *w, const double y[], const double sy[], double sums[2])
{
  SamTotal totals[2] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    double row[2] = {0, 0};

    for (PetscInt k = j * w->nx; k < (j + 1) * w->nx; k++)
      for (PetscInt l = k; w->bound[k] > 0 && l <= k + w->cells; l += w->cells) {
        const double delta = w->q[l] - y[l];

        row[0] += delta * (w->s[l] - sy[l]);
        row[1] += delta * delta;
      }
    SamAddAll(2, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 2, totals, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  One step from y = w->q with slip w->s: doubles L until the quadratic bound holds. On return q and s are the new ones.
*/
static PetscErrorCode GradientStep(SamStickSlip *w, double *L, double y[], double sy[], PetscBool *found)
{
  double sums[2];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(y, w->q, 2 * w->cells));
  PetscCall(PetscArraycpy(sy, w->s, 2 * w->cells));
  for (;;) {
    for (PetscInt k = 0; k < 2 * w->cells; k++) w->q[k] = y[k] - sy[k] / *L;
    PetscCall(SamFrameProjectTangential(w->frame, &w->runs, w->bound, NULL, PETSC_TRUE, w->q, NULL, found));
    if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(SamStickSlipComputeSlip(w));
    PetscCall(ComputeBend(w, y, sy, sums));
    if (sums[0] <= *L * sums[1] * (1 + 1e-12) || !isfinite(sums[0] + sums[1])) break;
    *L     = PetscMax(2 * *L, sums[0] / sums[1]);
    *found = *L <= STIFFEST * w->self; /* else rounding, not stiffness, breaks the bound */
    if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamTangentialSolve_Gradient(SamSolver solver, SamLevel *level)
{
  SamStickSlip    w;
  SamSolverReason reason = SAM_SOLVER_ITERATING;
  double         *y, *sy, *last, *slast, t = 1, L, energy, before;
  PetscBool       found;

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, SAM_RUN_GAP, &w));
  PetscCall(PetscMalloc4(2 * w.cells, &y, 2 * w.cells, &sy, 2 * w.cells, &last, 2 * w.cells, &slast));
  L = w.self;
  PetscCall(SamStickSlipStart(&w));
  PetscCall(ComputeEnergy(&w, &before));
  PetscCall(PetscArraycpy(last, w.q, 2 * w.cells));
  PetscCall(PetscArraycpy(slast, w.s, 2 * w.cells));
  for (PetscInt it = 0; !reason; it++) {
    double next;

    PetscCall(GradientStep(&w, &L, y, sy, &found));
    if (!found) {
      reason = SAM_SOLVER_DIVERGED_STAGNATED; /* that the loads can be carried has been checked before */
      break;
    }
    PetscCall(ComputeEnergy(&w, &energy));
    /* s changes by a rigid motion only, which the projection takes out of the gradient */
    for (PetscInt c = 0; c < 2; c++) PetscCall(SamStickSlipMeasure(&w));
    PetscCall(SamLevelIterated(solver, level, w.error));
    if (!isfinite(w.error))
      reason = SAM_SOLVER_DIVERGED_NAN;
    else if (w.error <= level->rtol)
      reason = SAM_SOLVER_CONVERGED_RTOL;
    else if (it >= SamSolverMaxIterations(solver))
      reason = SAM_SOLVER_DIVERGED_ITS;
    if (reason) break;
    if (energy > before) t = 1;
    before = energy;
    next   = 0.5 * (1 + sqrt(1 + 4 * t * t));
    for (PetscInt k = 0; k < 2 * w.cells; k++) {
      const double q = w.q[k], extrapolated = q + (t - 1) / next * (q - last[k]);

      last[k] = q;
      w.q[k]  = extrapolated;
    }
    PetscCall(SamStickSlipComputeSlip(&w));
    t = next;
  }
  solver->reason = reason;
  solver->error  = w.error;
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = w.motion[c];
  PetscCall(PetscFree4(y, sy, last, slast));
  PetscCall(SamStickSlipDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialCreate_Gradient(SamSolver solver)
{
  PetscFunctionBegin;
  solver->ops.solve      = SamTangentialSolve_Gradient;
  solver->default_levels = 1;
  solver->default_max_it = 20000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

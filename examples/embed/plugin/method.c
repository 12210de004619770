/*
  A normal method: the spectral projected gradient. p goes down its gradient, the gap g, by |change of p|/|change of g|,
  the mean of the two steps of Barzilai and Borwein (1988, IMA J. Numer. Anal. 8, 141), and then to the nearest
  admissible pressure. On one grid, for comparison.
*/
#include "plugin.h"
#include <petsam/private/normalimpl.h>

/* The rigid displacement a at cell k. */
static double Motion(const SamFrame *f, const double a[3], PetscInt k)
{
  const PetscInt nx = f->grid->nx;

  return SamFrameNormal(a, f->xi0 + (double)(k % nx) * f->dxi, SamFrameEta(f, k / nx));
}

/* g, which holds S p, becomes S p + h less the rigid displacement, whose free part fits best; its largest error (m). */
static PetscErrorCode ComputeGap(SamLevel *l, const double p[], double g[], double *error)
{
  const SamFrame *f                    = &l->frame;
  SamTotal        totals[3 + SAM_GRAM] = {{0}};
  double          sums[3 + SAM_GRAM], free[3];
  const double   *h;

  *error = 0;
  PetscCall(VecGetArrayRead(l->given[SAM_NORMAL_SEPARATION], &h));
  for (PetscInt j = 0; j < l->grid->rows; j++) { /* totals by rows are the same on any number of ranks */
    double row[3 + SAM_GRAM] = {0};

    for (PetscInt k = j * l->grid->nx; k < (j + 1) * l->grid->nx; k++) {
      const double xi = f->xi0 + (double)(k % l->grid->nx) * f->dxi, eta = SamFrameEta(f, j);

      g[k] += h[k] - Motion(f, f->fixed, k);
      if (p[k] <= 0) continue;
      row[0] += g[k];
      row[1] -= eta * g[k];
      row[2] += xi * g[k];
      SamGramNormalRow(row + 3, 1, xi, xi * xi, eta);
    }
    SamAddAll(3 + SAM_GRAM, totals, row);
  }
  PetscCall(VecRestoreArrayRead(l->given[SAM_NORMAL_SEPARATION], &h));
  PetscCall(SamSumTotals(l->grid->comm, 3 + SAM_GRAM, totals, sums));
  SamFrameSolve(f, sums + 3, sums, free);
  for (PetscInt k = 0; k < l->grid->cells; k++) {
    g[k] -= Motion(f, free, k);
    *error = SamLarger(*error, p[k] > 0 ? fabs(g[k]) : -g[k]);
  }
  for (int c = 0; c < 3; c++) l->rigid[c] = f->fixed[c] + free[c];
  return SamMax(l->grid->comm, 1, error);
}

static PetscErrorCode Step(SamLevel *l, Vec g, Vec p_before, Vec g_before, PetscReal *length, PetscBool *found)
{
  PetscReal size[2];
  double   *p;

  PetscCall(VecAYPX(p_before, -1, l->traction)); /* the changes */
  PetscCall(VecAYPX(g_before, -1, g));
  PetscCall(SamGridNorm(l->grid, p_before, NORM_2, &size[0]));
  PetscCall(SamGridNorm(l->grid, g_before, NORM_2, &size[1]));
  if (size[0] > 0 && size[1] > 0) *length = size[0] / size[1];
  PetscCall(VecCopy(l->traction, p_before));
  PetscCall(VecCopy(g, g_before));
  PetscCall(VecAXPY(l->traction, -*length, g));
  PetscCall(VecGetArray(l->traction, &p));
  PetscCall(SamFrameProjectNormal(&l->frame, NULL, p, found));
  return VecRestoreArray(l->traction, &p);
}

static PetscErrorCode Solve(SamSolver solver, SamLevel *l)
{
  Vec           g, p_before, g_before;
  double       *gap, error, size;
  const double *p;
  PetscReal     length;
  PetscBool     found = PETSC_TRUE;

  PetscCall(SamElasticityGetSelfInfluence(l->elasticity, &length, NULL));
  length = 1 / length;
  PetscCall(VecDuplicate(l->traction, &g));
  PetscCall(VecDuplicate(l->traction, &p_before));
  PetscCall(VecDuplicate(l->traction, &g_before));
  PetscCall(VecCopy(l->traction, p_before));
  PetscCall(VecSet(g_before, 0));
  solver->reason = SAM_SOLVER_ITERATING;
  for (PetscInt it = 0; !solver->reason; it++) {
    PetscCall(SamLevelApply(solver, l, l->traction, g));
    PetscCall(VecNorm(g, NORM_INFINITY, &size));
    PetscCall(VecGetArrayRead(l->traction, &p));
    PetscCall(VecGetArray(g, &gap));
    PetscCall(ComputeGap(l, p, gap, &error));
    PetscCall(VecRestoreArray(g, &gap));
    PetscCall(VecRestoreArrayRead(l->traction, &p));
    solver->error = error / size;
    if (it) PetscCall(SamLevelIterated(solver, l, solver->error));
    if (!isfinite(solver->error))
      solver->reason = SAM_SOLVER_DIVERGED_NAN;
    else if (solver->error <= l->rtol)
      solver->reason = SAM_SOLVER_CONVERGED_RTOL;
    else if (it >= SamSolverMaxIterations(solver))
      solver->reason = SAM_SOLVER_DIVERGED_ITS;
    else
      PetscCall(Step(l, g, p_before, g_before, &length, &found));
    if (!found) solver->reason = SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
  }
  PetscCall(VecDestroy(&g));
  PetscCall(VecDestroy(&p_before));
  return VecDestroy(&g_before);
}

PetscErrorCode CreateSpectral(SamSolver solver)
{
  solver->ops.solve      = Solve;
  solver->default_levels = 1;
  solver->default_max_it = 10000;
  return 0;
}

/*
  Plastic depth: where the pressure reaches its limit, the surfaces overlap and yield.

  In a step 0 <= p <= H, and the gap g of the surfaces as they were before it is 0 between these bounds, >= 0 where
  p = 0 and <= 0 where p = H. The overlap -g there is the depth by which the surfaces yield in the step. It is added to
  the separation from then on, so the gap of the yielded surfaces is 0 in these cells. With them the pressure of the
  step is still a solution for the same loads, now one without any overlap, and the only one: reloading comes back to
  it, unloading before that is elastic, and a step that changes nothing yields nothing.
*/
#include "contactimpl.h"

PetscErrorCode SamSolutionAddPlastic(const SamSolution *s, Vec separation)
{
  PetscFunctionBegin;
  if (s && s->plastic) PetscCall(VecAXPY(separation, 1, s->plastic));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The overlap (m) of some cells, from the pressure and the gap before the surfaces yield. */
static void OverlapRow(PetscInt n, const double p[], const double gap[], double saturated, double overlap[])
{
  for (PetscInt i = 0; i < n; i++) overlap[i] = p[i] >= saturated && gap[i] < 0 ? -gap[i] : 0;
}

/* Adds the overlap of the tried step to its plastic depth, which is that before the step. */
static PetscErrorCode AddOverlap(SamContact c, PetscReal limit)
{
  const SamSolution *s  = &c->tried.solution;
  const PetscInt     nx = c->grid->nx;
  const double      *p, *u, *h;
  double            *depth, *separation, *gap, *overlap;
  SamMotion          motion;
  Vec                undeformed;

  PetscFunctionBegin;
  PetscCall(SamProblemGetGap(c->problem, &undeformed));
  PetscCall(SamMotionSet(&motion, c->problem, s));
  PetscCall(PetscMalloc3(nx, &separation, nx, &gap, nx, &overlap));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->displacement_z, &u));
  PetscCall(VecGetArrayRead(undeformed, &h));
  PetscCall(VecGetArray(s->plastic, &depth));
  for (PetscInt j = 0; j < c->grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * nx;

    SamMotionGap(&motion, SamMotionOfGap(&motion, j), u + k, SamSeparationOfRow(c->grid, h, depth, j, separation), gap);
    OverlapRow(nx, p + k, gap, SAM_SATURATED * limit, overlap);
    for (PetscInt i = 0; i < nx; i++) depth[k + i] += overlap[i];
  }
  PetscCall(VecRestoreArray(s->plastic, &depth));
  PetscCall(VecRestoreArrayRead(undeformed, &h));
  PetscCall(VecRestoreArrayRead(s->displacement_z, &u));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(PetscFree3(separation, gap, overlap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Cells at the limit, the largest depth, and the work of the pressure on what has been added to it. When a load comes
  back that has yielded, all that was at the limit is there again, to the tolerance of the solver.
*/
#define AT_LIMIT (1 - 1e-6)
static PetscErrorCode CountYielded(SamContact c, PetscReal limit, SamStep *step)
{
  const SamSolution *s     = &c->tried.solution;
  const Vec          prior = c->steps ? c->committed.solution.plastic : NULL;
  const double       area  = c->grid->dx * c->grid->dy;
  enum { CELLS, WORK, SUMS };
  SamTotal      totals[SUMS] = {{0}};
  double        sums[SUMS], most = 0;
  const double *p, *depth, *before = NULL;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->plastic, &depth));
  if (prior) PetscCall(VecGetArrayRead(prior, &before));
  for (PetscInt j = 0; j < c->grid->rows; j++) {
    double row[SUMS] = {0};

    for (PetscInt i = 0; i < c->grid->nx; i++) {
      const ptrdiff_t k = (ptrdiff_t)j * c->grid->nx + i;

      row[CELLS] += p[k] >= AT_LIMIT * limit ? 1 : 0;
      row[WORK] += p[k] * (depth[k] - (before ? before[k] : 0));
      most = PetscMax(most, depth[k]);
    }
    SamAddAll(SUMS, totals, row);
  }
  if (prior) PetscCall(VecRestoreArrayRead(prior, &before));
  PetscCall(VecRestoreArrayRead(s->plastic, &depth));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(SamSumTotals(c->grid->comm, SUMS, totals, sums));
  PetscCall(SamMax(c->grid->comm, 1, &most));
  step->plastic_cells     = (PetscInt)sums[CELLS];
  step->plastic_area      = sums[CELLS] * area;
  step->plastic_depth_max = most;
  step->plastic_energy    = sums[WORK] * area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactYield(SamContact c, PetscBool same_pressure, SamStep *step)
{
  SamSolution *s     = &c->tried.solution;
  const Vec    prior = c->steps ? c->committed.solution.plastic : NULL;
  PetscReal    limit;

  PetscFunctionBegin;
  PetscCall(SamProblemGetPressureLimit(c->problem, &limit));
  if (!prior && isinf(limit)) {
    PetscCall(VecDestroy(&s->plastic));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!s->plastic) PetscCall(SamGridCreateVec(c->grid, 1, &s->plastic));
  if (prior)
    PetscCall(VecCopy(prior, s->plastic));
  else
    PetscCall(VecSet(s->plastic, 0));
  /* a pressure that stays has yielded before; what is left of its gap is rounding */
  if (!same_pressure) PetscCall(AddOverlap(c, limit));
  PetscCall(CountYielded(c, limit, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactComputePlasticDepth(SamContact c, Vec depth)
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(c->grid, 1, depth, "The plastic depth"));
  PetscCall(SamContactGetSolution(c, &s));
  PetscCall(VecSet(depth, 0));
  PetscCall(SamSolutionAddPlastic(s, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactComputeOverlap(SamContact c, Vec overlap)
{
  PetscFunctionBegin;
  PetscCheck(c->has_tried, c->grid->comm, PETSC_ERR_ORDER, "There is no tried step");
  PetscCall(SamContactComputePlasticDepth(c, overlap));
  if (c->steps && c->committed.solution.plastic) PetscCall(VecAXPY(overlap, -1, c->committed.solution.plastic));
  PetscFunctionReturn(PETSC_SUCCESS);
}

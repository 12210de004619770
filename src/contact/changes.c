/* What has happened since the step before, for a corrected solution: nothing, a turn of the load, a larger contact. */
#include "stepimpl.h"
#include <petsam/private/rows.h>

PetscErrorCode SamSolveIsHeld(SamSolve *s, PetscBool *held)
{
  const SamSolution *before = &s->c->committed.solution;
  const SamControl  *now    = &s->s->control;

  PetscFunctionBegin;
  *held = PETSC_FALSE;
  if (!s->same_pressure || !before->sheared.has) PetscFunctionReturn(PETSC_SUCCESS);
  if (!SamControlIsSame(now, &before->control, SAM_BALANCE_TANGENTIAL)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++)
      if (now->bulk_stress[body][k] != before->control.bulk_stress[body][k]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamProblemComputeBound(s->c->problem, now->friction_scale, before->pressure, s->s->bound));
  PetscCall(VecEqual(s->s->bound, before->bound, held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveFindTurn(SamSolve *s, const SamSolution *before, PetscBool *turned)
{
  const SamGrid  grid  = s->c->grid;
  const PetscInt n     = grid->cells;
  SamTotal       total = {0};
  const double  *q, *q0, *slips, *slips0;
  double         sum;
  Vec            slipped, slipping;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &slipped));
  PetscCall(SamGridCreateVec(grid, 1, &slipping));
  PetscCall(SamSolutionFindSlips(before, slipped));
  PetscCall(SamSolutionFindSlips(s->s, slipping));
  PetscCall(VecGetArrayRead(slipped, &slips0));
  PetscCall(VecGetArrayRead(slipping, &slips));
  PetscCall(VecGetArrayRead(before->shear, &q0));
  PetscCall(VecGetArrayRead(s->s->shear, &q));
  for (PetscInt k = 0; k < n; k++)
    if (slips0[k] > 0) SamAdd(&total, slips[k] > 0 && q[k] * q0[k] + q[k + n] * q0[k + n] > 0 ? 1 : -1);
  PetscCall(VecRestoreArrayRead(s->s->shear, &q));
  PetscCall(VecRestoreArrayRead(before->shear, &q0));
  PetscCall(VecRestoreArrayRead(slipping, &slips));
  PetscCall(VecRestoreArrayRead(slipped, &slips0));
  PetscCall(VecDestroy(&slipping));
  PetscCall(VecDestroy(&slipped));
  PetscCall(SamSumTotals(grid->comm, 1, &total, &sum));
  *turned = sum < 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the contact has grown by a neighbour of cell i of row j of those around. */
static PetscBool GrowsAt(const SamSeen *before, const SamSeen *now, PetscInt i, PetscInt j)
{
  static const int step[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

  for (int k = 0; k < 4; k++) {
    const PetscInt  nx = now->rows.grid->nx, a = i + step[k][0], b = j + step[k][1];
    const ptrdiff_t at = (ptrdiff_t)b * nx + a;

    if (a >= 0 && a < nx && b >= 0 && b < now->rows.count && !(before->at[0][at] > 0) && now->at[0][at] > 0)
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode SamSolveFindGrowth(SamSolve *s, const SamSolution *before, PetscBool *grows)
{
  const SamGrid grid = s->c->grid;
  const double *q0, *slips;
  double        any = 0;
  SamSeen       p0, p;
  Vec           slipping;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &slipping));
  PetscCall(SamSolutionFindSlips(s->s, slipping));
  PetscCall(SamSee(grid, before->pressure, 1, 1, &p0));
  PetscCall(SamSee(grid, s->s->pressure, 1, 1, &p));
  PetscCall(VecGetArrayRead(before->shear, &q0));
  PetscCall(VecGetArrayRead(slipping, &slips));
  for (PetscInt k = 0; k < grid->cells; k++)
    if ((q0[k] != 0 || q0[k + grid->cells] != 0) && p.own[k] > 0 && !(slips[k] > 0) &&
        GrowsAt(&p0, &p, k % grid->nx, grid->row_start + k / grid->nx - p.rows.first))
      any = 1;
  PetscCall(VecRestoreArrayRead(slipping, &slips));
  PetscCall(VecRestoreArrayRead(before->shear, &q0));
  PetscCall(SamForget(&p));
  PetscCall(SamForget(&p0));
  PetscCall(VecDestroy(&slipping));
  PetscCall(SamMax(grid->comm, 1, &any));
  *grows = any > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The limit of explicit wear, of steps and of jumps that wear by the pressure at their start.

  A cell that bears more wears more, and bears less then. Depth w = k K p for a pressure p, where K is what the step or
  cycle wears per pressure, adds E w to the gap, and by it the pressure falls by up to E w / e, e being the smallest
  eigenvalue of the normal influence. Where k K > 2 e it falls by more than twice the unevenness there was: the next
  one is larger, from cell to cell.
*/
#include "wearimpl.h"

/* The Rayleigh quotient of a checkerboard, a little more than the smallest eigenvalue. */
static PetscErrorCode FindLeast(SamWear w)
{
  const SamGrid grid = w->grid;
  SamElasticity elasticity;
  double       *to;
  PetscReal     product;
  Vec           p, u;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &p));
  PetscCall(SamGridCreateVec(grid, 1, &u));
  PetscCall(SamProblemGetElasticity(w->problem, &elasticity));
  PetscCall(VecGetArrayWrite(p, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = (k % grid->nx + k / grid->nx + grid->row_start) % 2 ? 1 : -1;
  PetscCall(VecRestoreArrayWrite(p, &to));
  PetscCall(SamElasticityApplyNormal(elasticity, p, u));
  PetscCall(SamGridNorm(grid, u, NORM_1, &product)); /* each displacement has the sign of its pressure */
  w->least = product / ((PetscReal)grid->nx * (PetscReal)grid->ny);
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetLimit(SamWear w, PetscReal most, PetscReal *times)
{
  const PetscReal wears = most * (w->coefficient[0] + w->coefficient[1]);

  PetscFunctionBegin;
  if (w->least == 0) PetscCall(FindLeast(w));
  *times = wears > 0 ? 2 * w->least / wears : PETSC_INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetUnit(SamWear w, PetscReal friction_scale, Vec unit)
{
  PetscFunctionBegin;
  PetscCall(VecSet(unit, 1));
  if (w->law == SAM_WEAR_ENERGY) PetscCall(SamProblemComputeBound(w->problem, friction_scale, unit, unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetExcess(SamWear w, PetscReal *excess)
{
  const SamSolution *s;
  const double      *p, *slip, *worn, *one;
  double             most = 0;
  PetscReal          times;
  Vec                unit;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(w->contact, &s));
  PetscCall(SamGridCreateVec(w->grid, 1, &unit));
  PetscCall(SamWearGetUnit(w, s->control.friction_scale, unit));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(w->slip, &slip));
  PetscCall(VecGetArrayRead(w->step, &worn));
  PetscCall(VecGetArrayRead(unit, &one));
  for (PetscInt k = 0; k < w->grid->cells; k++)
    if (p[k] > 0 && worn[k] > 0) most = PetscMax(most, one[k] * slip[k]);
  PetscCall(VecRestoreArrayRead(unit, &one));
  PetscCall(VecRestoreArrayRead(w->step, &worn));
  PetscCall(VecRestoreArrayRead(w->slip, &slip));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(VecDestroy(&unit));
  PetscCall(SamMax(w->grid->comm, 1, &most));
  PetscCall(SamWearGetLimit(w, (PetscReal)most, &times));
  *excess = 1 / times;
  PetscFunctionReturn(PETSC_SUCCESS);
}

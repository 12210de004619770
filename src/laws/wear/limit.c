/*
  The limit of what a single step may wear: its pressure is found before the gap follows.

  A cell that bears more wears more, and bears less then. Depth w = k K p for a pressure p, where K is what the step
  wears per pressure, adds E w to the gap, and by it the pressure falls by up to E w / e, e being the smallest
  eigenvalue of the normal influence. Where k K > 2 e it falls by more than twice the unevenness there was: the next
  one is larger, from cell to cell.
*/
#include "wearimpl.h"

/* The Rayleigh quotient of a checkerboard, a little more than the smallest eigenvalue. */
static PetscErrorCode FindLeast(SamLaw law)
{
  const SamGrid grid = law->grid;
  double       *to;
  PetscReal     product;
  Vec           p, u;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &p));
  PetscCall(SamGridCreateVec(grid, 1, &u));
  PetscCall(VecGetArrayWrite(p, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = (k % grid->nx + k / grid->nx + grid->row_start) % 2 ? 1 : -1;
  PetscCall(VecRestoreArrayWrite(p, &to));
  PetscCall(SamElasticityApplyNormal(law->elasticity, p, u));
  PetscCall(SamGridNorm(grid, u, NORM_1, &product)); /* each displacement has the sign of its pressure */
  ((SamWear *)law->data)->least = product / ((PetscReal)grid->nx * (PetscReal)grid->ny);
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetLimit(SamLaw law, PetscReal most, PetscReal *times)
{
  const SamWear  *w     = (const SamWear *)law->data;
  const PetscReal wears = most * (w->coefficient[0] + w->coefficient[1]);

  PetscFunctionBegin;
  if (w->least == 0) PetscCall(FindLeast(law));
  *times = wears > 0 ? 2 * w->least / wears : PETSC_INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetExcess(SamLaw law, SamLawStep *step, PetscReal *excess)
{
  const PetscBool by_energy = ((const SamWear *)law->data)->by_energy;
  const double   *p, *slip, *wears, *one;
  double          most = 0;
  PetscReal       times;
  Vec             unit, path, worn;

  PetscFunctionBegin;
  PetscCall(SamLawStepGetFriction(step, &path, by_energy ? NULL : &worn, by_energy ? &worn : NULL));
  PetscCall(SamGridCreateVec(law->grid, 1, &unit));
  PetscCall(VecSet(unit, 1));
  if (by_energy) PetscCall(step->slope(step, unit));
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(VecGetArrayRead(path, &slip));
  PetscCall(VecGetArrayRead(worn, &wears));
  PetscCall(VecGetArrayRead(unit, &one));
  for (PetscInt k = 0; k < law->grid->cells; k++)
    if (p[k] > 0 && fabs(wears[k]) > 0) most = PetscMax(most, one[k] * slip[k]);
  PetscCall(VecRestoreArrayRead(unit, &one));
  PetscCall(VecRestoreArrayRead(worn, &wears));
  PetscCall(VecRestoreArrayRead(path, &slip));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(VecDestroy(&unit));
  PetscCall(SamMax(law->grid->comm, 1, &most));
  PetscCall(SamWearGetLimit(law, (PetscReal)most, &times));
  *excess = 1 / times;
  PetscFunctionReturn(PETSC_SUCCESS);
}

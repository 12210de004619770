/*
  The limit of the wear of a single step, which exists because its pressure is found before the gap changes.

  A cell with more pressure wears more, and then has less pressure. A depth w = k K p, where K is the wear of the step
  per pressure p, reduces the pressure by up to w/e, where e is the smallest eigenvalue of the normal influence. If k K
  > 2 e, the pressure changes by more than twice its unevenness, which so grows from step to step, and alternates from
  cell to cell.
*/
#include "wearimpl.h"
#include <petsam/private/wear.h>
#include <petsam/private/pressed.h>

/* Computes the Rayleigh quotient of a checkerboard, which is slightly more than the smallest eigenvalue. */
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
  const double   *p, *slip, *wears, *slope = NULL, *times_more = NULL;
  double          most = 0;
  PetscReal       times;
  const Vec       path = step->field[SAM_USE_PATH], worn = step->field[by_energy ? SAM_USE_WORK : SAM_USE_PRESSED],
            factor = SamWearGetFactor(step->state);

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(VecGetArrayRead(path, &slip));
  PetscCall(VecGetArrayRead(worn, &wears));
  if (by_energy) PetscCall(VecGetArrayRead(step->field[SAM_USE_SLOPE], &slope));
  if (factor) PetscCall(VecGetArrayRead(factor, &times_more));
  for (PetscInt k = 0; k < law->grid->cells; k++)
    if (SamIsPressed(p[k]) && fabs(wears[k]) > 0)
      most = PetscMax(most, (slope ? slope[k] : 1) * (times_more ? times_more[k] : 1) * slip[k]);
  if (factor) PetscCall(VecRestoreArrayRead(factor, &times_more));
  if (by_energy) PetscCall(VecRestoreArrayRead(step->field[SAM_USE_SLOPE], &slope));
  PetscCall(VecRestoreArrayRead(worn, &wears));
  PetscCall(VecRestoreArrayRead(path, &slip));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(SamMax(law->grid->comm, 1, &most));
  PetscCall(SamWearGetLimit(law, (PetscReal)most, &times));
  *excess = 1 / times;
  PetscFunctionReturn(PETSC_SUCCESS);
}

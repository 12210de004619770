/*
  A step that wears, on the way back: the depth k w, of the wear load w = p |ds| or mu p |ds|, is in the gap of all
  later steps.
*/
#include "wearimpl.h"

PetscReal SamWearNumber(SamLaw law)
{
  const SamWear *w = (const SamWear *)law->data;

  return w->coefficient[0] + w->coefficient[1];
}

PetscErrorCode SamWearBack(SamLaw law, SamBackStep *step)
{
  const SamWear  *w     = (const SamWear *)law->data;
  const PetscInt  cells = step->grid->cells;
  const PetscReal k     = SamWearNumber(law);
  double         *by_load, *factor, sum;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(cells, &by_load, cells, &factor));
  for (PetscInt m = 0; m < cells; m++) {
    const double share = w->by_energy ? step->friction[m] : 1;

    by_load[m] = step->by_worn[m] * share;
    factor[m]  = step->by_worn[m] * (k * share);
    if (w->by_energy) step->by_friction[m] += step->by_worn[m] * k * step->rubbed[m];
  }
  PetscCall(SamGridDot(step->grid, 1, by_load, step->rubbed, &sum));
  *step->by_number += sum;
  if (k != 0) PetscCall(SamBackAddRubbed(step, factor));
  PetscCall(PetscFree2(by_load, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The columns of a border in a frozen system: they are taken off residuals, and spread off directions. */
#include <petsam/private/frozen.h>

PetscErrorCode SamFrozenTakeColumns(const SamFrozen *f, double r[])
{
  const SamFrozenBorder *b = &f->border;
  const PetscInt         n = SamFrozenSize(f);
  double                 dots[SAM_COMPONENTS];

  PetscFunctionBegin;
  if (!b->count) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFrozenDots(f, b->count, b->unit, r, dots));
  for (PetscInt k = 0; k < b->count; k++)
    for (PetscInt m = 0; m < n; m++) r[m] -= dots[k] * b->unit[k][m];
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFrozenAddSpread(const SamFrozen *f, double times, const double products[], double z[])
{
  const SamFrozenBorder *b = &f->border;
  const PetscInt         n = SamFrozenSize(f);

  for (PetscInt k = 0; k < b->count; k++) {
    double part = 0;

    for (PetscInt l = 0; l < b->count; l++) part += times * b->inverse[k][l] * products[l];
    for (PetscInt m = 0; m < n; m++) z[m] += part * b->spread[k][m];
  }
}

PetscErrorCode SamFrozenTakeRows(const SamFrozen *f, double z[])
{
  double dots[SAM_COMPONENTS];

  PetscFunctionBegin;
  if (!f->border.count) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFrozenDots(f, f->border.count, f->border.row, z, dots));
  SamFrozenAddSpread(f, -1, dots, z);
  PetscFunctionReturn(PETSC_SUCCESS);
}

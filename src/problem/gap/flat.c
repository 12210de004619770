/* Two planes: h = 0. Useful with a roughness. */
#include <petsam/private/gapimpl.h>

static PetscReal Height_Flat(const PetscReal values[], PetscReal x, PetscReal y)
{
  (void)values;
  (void)x;
  (void)y;
  return 0;
}

PetscErrorCode SamGapCreate_Flat(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.height = Height_Flat;
  PetscFunctionReturn(PETSC_SUCCESS);
}

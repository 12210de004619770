/* Two planes: h = 0. Useful with a roughness. */
#include <petsam/private/gapimpl.h>
#include <math.h>

static PetscReal Height_Flat(const PetscReal values[], PetscReal x, PetscReal y)
{
  (void)values;
  (void)x;
  (void)y;
  return 0;
}

/* Returns the contact of two planes, which is unlimited. */
static SamGapContact Contact_Flat(const PetscReal values[], PetscReal half)
{
  (void)values;
  (void)half;
  return (SamGapContact){{INFINITY, INFINITY}, INFINITY, INFINITY};
}

PetscErrorCode SamGapCreate_Flat(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.height  = Height_Flat;
  gap->ops.contact = Contact_Flat;
  PetscFunctionReturn(PETSC_SUCCESS);
}

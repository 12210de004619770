/*
  A flat circular punch of radius c with a rounded edge of radius R: h = 0 for r <= c, (r - c)^2/2R beyond.
  Its contact: M. Ciavarella, Int. J. Solids Struct. 36 (1999) 4149-4181.
*/
#include <petsam/private/gapimpl.h>
#include <math.h>

static const SamGapParameter parameters[] = {{"gap_flat_radius", "radius of the flat base (m)", SAM_RANGE_NONNEGATIVE},
                                             {"gap_edge_radius", "radius of the rounded edge (m)", SAM_RANGE_POSITIVE}};

static PetscReal Height_Punch(const PetscReal values[], PetscReal x, PetscReal y)
{
  const PetscReal beyond = hypot(x, y) - values[0];

  return beyond > 0 ? 0.5 * beyond * beyond / values[1] : 0;
}

PetscErrorCode SamGapCreate_Punch(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 2;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height_Punch;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A gap: a cone, h = slope r. */
#include "plugin.h"
#include <petsam/private/gapimpl.h>

static const SamGapParameter parameters[] = {{"gap_slope", "slope of the cone's side", NULL, SAM_RANGE_POSITIVE}};

static PetscReal Height(const PetscReal slope[], PetscReal x, PetscReal y)
{
  return slope[0] * hypot(x, y);
}

PetscErrorCode CreateCone(SamGap gap)
{
  gap->ops.count      = 1;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height;
  return 0;
}

/* A gap: one wave along x, h = A (1 - cos(2 pi x/length)). */
#include "trials.h"
#include <petsam/private/gapimpl.h>

static const SamGapParameter parameters[] = {{"gap_wave_height", "amplitude () of the wave", "m", SAM_RANGE_POSITIVE},
                                             {"gap_wave_length", "length () of the wave", "m", SAM_RANGE_POSITIVE}};

static PetscReal Height(const PetscReal v[], PetscReal x, PetscReal y)
{
  (void)y;
  return v[0] * (1 - cos(2 * PETSC_PI * x / v[1]));
}

PetscErrorCode CreateWave(SamGap gap)
{
  gap->ops.count      = 2;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height;
  return 0;
}

/*
  A flat circular punch of radius c with a rounded edge of radius R: h = 0 for r <= c, (r - c)^2/2R beyond.
  Its contact: M. Ciavarella, Int. J. Solids Struct. 36 (1999) 4149-4181.
*/
#include <petsam/private/gapimpl.h>
#include <math.h>

static const SamGapParameter parameters[] = {
  {"gap_flat_radius", "radius of the flat base ()", "m", SAM_RANGE_NONNEGATIVE},
  {"gap_edge_radius", "radius of the rounded edge ()", "m", SAM_RANGE_POSITIVE}};

static PetscReal Height_Punch(const PetscReal values[], PetscReal x, PetscReal y)
{
  const PetscReal beyond = hypot(x, y) - values[0];

  return beyond > 0 ? 0.5 * beyond * beyond / values[1] : 0;
}

/*
  Sneddon's solution for bodies of revolution (Int. J. Engng Sci. 3 (1965) 47-57): force/E* is 2 a^2 times the integral
  of sin^2 t h'(a sin t), and the approach is a times the integral of h'(a sin t), for t from 0 to pi/2; h' = 0 up to
  the flat edge.
*/
static SamGapContact Contact_Punch(const PetscReal values[], PetscReal half)
{
  const double c = values[0], a = half, R = values[1], t = a > c ? asin(c / a) : 0, rest = PETSC_PI / 2 - t;

  if (a <= c) return (SamGapContact){{half, half}, 0, 0};
  return (SamGapContact){{half, half},
                         2 * a * a / R * (a * (cos(t) - pow(cos(t), 3) / 3) - c * (0.5 * rest + 0.25 * sin(2 * t))),
                         a / R * (a * cos(t) - c * rest)};
}

/* Returns the steepness of the rounded edge; the base is flat. */
static PetscReal Steepness_Punch(const PetscReal values[], const PetscReal half[2], PetscInt *parameter)
{
  *parameter = 1;
  return PetscMax(PetscMax(half[0], half[1]) - values[0], 0) / values[1];
}

PetscErrorCode SamGapCreate_Punch(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 2;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height_Punch;
  gap->ops.contact    = Contact_Punch;
  gap->ops.steepness  = Steepness_Punch;
  PetscFunctionReturn(PETSC_SUCCESS);
}

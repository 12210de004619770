/*
  Two spheres in the parabolic approximation: h = (x^2 + y^2)/2R with 1/R = 1/R1 + 1/R2.
  K. L. Johnson, Contact Mechanics (Cambridge University Press, 1985), eq. 4.3 with equal radii of curvature.
*/
#include <petsam/private/gapimpl.h>
#include <math.h>

static const SamGapParameter parameters[] = {
  {"gap_radius1", "radius of body 1 (, inf: flat)", "m", SAM_RANGE_POSITIVE_INF},
  {"gap_radius2", "radius of body 2 (, inf: flat)", "m", SAM_RANGE_POSITIVE_INF}};

static PetscReal Height_Sphere(const PetscReal radius[], PetscReal x, PetscReal y)
{
  return 0.5 * (x * x + y * y) * (1 / radius[0] + 1 / radius[1]);
}

/* Returns Hertz's contact: Johnson, eqs 4.22 to 4.24. */
static SamGapContact Contact_Sphere(const PetscReal radius[], PetscReal half)
{
  const PetscReal curvature = 1 / radius[0] + 1 / radius[1];

  if (curvature == 0) return (SamGapContact){{INFINITY, INFINITY}, INFINITY, INFINITY};
  return (SamGapContact){{half, half}, 4. / 3 * half * half * half * curvature, half * half * curvature};
}

static PetscReal Steepness_Sphere(const PetscReal radius[], const PetscReal half[2], PetscInt *parameter)
{
  *parameter = radius[0] <= radius[1] ? 0 : 1;
  return PetscMax(half[0], half[1]) / radius[*parameter];
}

PetscErrorCode SamGapCreate_Sphere(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 2;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height_Sphere;
  gap->ops.contact    = Contact_Sphere;
  gap->ops.steepness  = Steepness_Sphere;
  gap->ops.beyond     = "; a concave body has negative radii with -gap_type curved";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Curved bodies whose principal directions are x and y: h = x^2/2Rx + y^2/2Ry, where Rx and Ry are the principal
  relative radii of curvature. If one of them is infinite: a cylinder.
  K. L. Johnson, Contact Mechanics (Cambridge University Press, 1985), eq. 4.3.
*/
#include <petsam/private/gapimpl.h>

static const SamGapParameter parameters[] = {
  {"gap_radius_x", "relative radius of curvature along x (m, inf: straight)", SAM_RANGE_POSITIVE_INF},
  {"gap_radius_y", "relative radius of curvature along y (m, inf: straight)", SAM_RANGE_POSITIVE_INF}};

static PetscReal Height_Ellipsoid(const PetscReal radius[], PetscReal x, PetscReal y)
{
  return 0.5 * x * x / radius[0] + 0.5 * y * y / radius[1];
}

PetscErrorCode SamGapCreate_Ellipsoid(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 2;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height_Ellipsoid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Curved bodies whose principal directions are x and y: h = x^2/2Rx + y^2/2Ry, where Rx and Ry are the principal
  relative radii of curvature. If one of them is infinite: a cylinder.
  K. L. Johnson, Contact Mechanics (Cambridge University Press, 1985), eq. 4.3.
*/
#include <petsam/private/gapimpl.h>
#include <math.h>

static const SamGapParameter parameters[] = {
  {"gap_radius_x", "relative radius of curvature along x (m, inf: cylinder)", SAM_RANGE_POSITIVE_INF},
  {"gap_radius_y", "relative radius of curvature along y (m, inf: cylinder)", SAM_RANGE_POSITIVE_INF}};

static PetscReal Height_Ellipsoid(const PetscReal radius[], PetscReal x, PetscReal y)
{
  return 0.5 * x * x / radius[0] + 0.5 * y * y / radius[1];
}

/* The complete elliptic integrals K and E of modulus k = sqrt(1 - ratio^2), by the arithmetic-geometric mean. */
static void Integrals(double ratio, double *K, double *E)
{
  double a = 1, b = ratio, square = 0.5 * (1 - ratio * ratio), power = 0.5;

  while (fabs(a - b) > 1e-15 * a) {
    const double mean = 0.5 * (a + b);

    power *= 2;
    square += power * 0.25 * (a - b) * (a - b);
    b = sqrt(a * b);
    a = mean;
  }
  *K = PETSC_PI / (2 * a);
  *E = *K * (1 - square);
}

#define STRAIGHT 1e-8 /* ratio of two radii of which the larger one counts as infinite */

/* The ratio of the axes of Hertz's ellipse for that of the radii, at most 1: Johnson, eqs 4.25 and 4.26. */
static double RatioOfAxes(double radii)
{
  double low = 0, high = 1, K, E;

  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);

    Integrals(middle, &K, &E);
    if ((K - E) < radii * (E / (middle * middle) - K))
      low = middle;
    else
      high = middle;
  }
  return radii > 1 - 1e-7 ? 1 : high; /* there the difference above is only rounding */
}

/* Hertz: Johnson, eqs 4.25 to 4.30. For a cylinder they give the half width of the contact, not its length. */
static SamGapContact Contact_Ellipsoid(const PetscReal radius[], PetscReal half)
{
  const int     x     = radius[0] >= radius[1] ? 0 : 1; /* along the longer axis */
  const double  radii = radius[1 - x] / radius[x], ratio = radii > STRAIGHT ? RatioOfAxes(radii) : 0, b = ratio * half;
  double        K, E, pressure; /* over E* */
  SamGapContact contact = {{INFINITY, INFINITY}, INFINITY, INFINITY};

  if (ratio == 0) {
    if (isfinite(radius[1 - x])) contact.half[1 - x] = 0;
    return contact;
  }
  Integrals(ratio, &K, &E);
  pressure            = b * (0.5 / radius[0] + 0.5 / radius[1]) / E;
  contact.half[x]     = half;
  contact.half[1 - x] = b;
  contact.force       = 2. / 3 * PETSC_PI * half * b * pressure;
  contact.approach    = pressure * b * K;
  return contact;
}

static PetscReal Steepness_Ellipsoid(const PetscReal radius[], const PetscReal half[2], PetscInt *parameter)
{
  *parameter = half[0] / radius[0] >= half[1] / radius[1] ? 0 : 1;
  return half[*parameter] / radius[*parameter];
}

PetscErrorCode SamGapCreate_Ellipsoid(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 2;
  gap->ops.parameters = parameters;
  gap->ops.height     = Height_Ellipsoid;
  gap->ops.contact    = Contact_Ellipsoid;
  gap->ops.steepness  = Steepness_Ellipsoid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

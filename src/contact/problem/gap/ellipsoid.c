/*
  Curved bodies whose principal directions are x and y: h = x^2/2Rx + y^2/2Ry, where Rx and Ry are the principal
  relative radii of curvature. If one of them is infinite, the body is a cylinder. Another type has the principal radii
  of both bodies, negative for concave ones; the directions of body 2 are turned by an angle about z.
  K. L. Johnson, Contact Mechanics (Cambridge University Press, 1985), eqs 4.2 and 4.3.
*/
#include <petsam/private/gapimpl.h>
#include <math.h>

static const SamGapParameter parameters[] = {
  {"gap_radius_x", "relative radius of curvature along x (, inf: cylinder)", "m", SAM_RANGE_POSITIVE_INF},
  {"gap_radius_y", "relative radius of curvature along y (, inf: cylinder)", "m", SAM_RANGE_POSITIVE_INF}};

static const PetscReal cylinder[] = {NAN, INFINITY};

static PetscReal Height_Ellipsoid(const PetscReal radius[], PetscReal x, PetscReal y)
{
  return 0.5 * x * x / radius[0] + 0.5 * y * y / radius[1];
}

/*
  Computes the complete elliptic integrals K and E of modulus k = sqrt(1 - ratio^2), by the arithmetic-geometric mean.
*/
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

#define STRAIGHT 1e-8 /* the larger of two radii counts as infinite below this ratio */

/* Returns the ratio of the axes of Hertz's ellipse for a ratio of radii of at most 1: Johnson, eqs 4.25 and 4.26. */
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
  return radii > 1 - 1e-7 ? 1 : high; /* the difference above is only rounding there */
}

/* Returns Hertz's contact: Johnson, eqs 4.25 to 4.30. For a cylinder they give the half width, but no length. */
static SamGapContact Contact_Ellipsoid(const PetscReal radius[], PetscReal half)
{
  const int     x     = radius[0] >= radius[1] ? 0 : 1; /* along the longer axis */
  const double  radii = radius[1 - x] / radius[x], ratio = radii > STRAIGHT ? RatioOfAxes(radii) : 0, b = ratio * half;
  double        K, E, pressure; /* pressure: over E* */
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
  gap->ops.cylinder   = cylinder;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- two bodies at an angle ---- */

static const SamGapParameter curved[] = {
  {"gap_radius1_x", "radius of body 1 along x (, inf: cylinder, < 0: concave)", "m", SAM_RANGE_NOT_ZERO},
  {"gap_radius1_y", "radius of body 1 along y (, inf: cylinder, < 0: concave)", "m", SAM_RANGE_NOT_ZERO},
  {"gap_radius2_x", "radius of body 2 along its x (, inf: cylinder, < 0: concave)", "m", SAM_RANGE_NOT_ZERO},
  {"gap_radius2_y", "radius of body 2 along its y (, inf: cylinder, < 0: concave)", "m", SAM_RANGE_NOT_ZERO},
  {"gap_angle", "angle from x to the x of body 2 ()", "degrees", SAM_RANGE_ANY}};

static const PetscReal curved_defaults[] = {INFINITY, INFINITY, INFINITY, INFINITY, 0},
                       curved_cylinder[] = {NAN, INFINITY, NAN, INFINITY, 0};

/*
  Computes the relative curvatures h_xx, h_xy, h_yy (1/m) of v: the radii along x and y of both bodies, and their angle.
*/
static void Curvatures(const PetscReal v[], double h[3])
{
  const double angle = v[4] * PETSC_PI / 180, c = cos(angle), s = sin(angle);

  h[0] = 1 / v[0] + c * c / v[2] + s * s / v[3];
  h[1] = c * s * (1 / v[2] - 1 / v[3]);
  h[2] = 1 / v[1] + s * s / v[2] + c * c / v[3];
}

/* Computes the smaller and the larger principal relative curvature; returns the angle of the smaller one to x. */
static double Principal(const PetscReal v[], double curvature[2])
{
  double h[3], size = 0, deviation;

  Curvatures(v, h);
  for (int k = 0; k < 4; k++) size += 1 / fabs(v[k]);
  deviation    = hypot(0.5 * (h[0] - h[2]), h[1]);
  curvature[0] = 0.5 * (h[0] + h[2]) - deviation;
  curvature[1] = 0.5 * (h[0] + h[2]) + deviation;
  for (int k = 0; k < 2; k++)
    if (fabs(curvature[k]) < 1e-14 * size) curvature[k] = 0; /* rounding */
  return 0.5 * (atan2(2 * h[1], h[0] - h[2]) + PETSC_PI);
}

static PetscReal Height_Curved(const PetscReal values[], PetscReal x, PetscReal y)
{
  double h[3];

  Curvatures(values, h);
  return 0.5 * (h[0] * x * x + h[2] * y * y) + h[1] * x * y;
}

/* Gives the bounding rectangle of Hertz's ellipse, which is rotated against the grid. */
static SamGapContact Contact_Curved(const PetscReal values[], PetscReal half)
{
  double          curvature[2];
  const double    angle = Principal(values, curvature), c = cos(angle), s = sin(angle);
  const PetscReal radii[2] = {1 / curvature[0], 1 / curvature[1]};
  SamGapContact   contact  = Contact_Ellipsoid(radii, half);
  const double    a = contact.half[0], b = contact.half[1];

  contact.half[0] = hypot(isinf(a) && fabs(c) < 1e-12 ? 0 : a * c, isinf(b) && fabs(s) < 1e-12 ? 0 : b * s);
  contact.half[1] = hypot(isinf(a) && fabs(s) < 1e-12 ? 0 : a * s, isinf(b) && fabs(c) < 1e-12 ? 0 : b * c);
  return contact;
}

static PetscReal Steepness_Curved(const PetscReal values[], const PetscReal half[2], PetscInt *parameter)
{
  const double angle = values[4] * PETSC_PI / 180, c = cos(angle), s = sin(angle);
  const double along[4] = {half[0], half[1], hypot(half[0] * c, half[1] * s), hypot(half[0] * s, half[1] * c)};

  *parameter = 0;
  for (int k = 1; k < 4; k++)
    if (along[k] / fabs(values[k]) > along[*parameter] / fabs(values[*parameter])) *parameter = k;
  return along[*parameter] / fabs(values[*parameter]);
}

static PetscBool Concave_Curved(const PetscReal v[])
{
  return v[0] < 0 || v[1] < 0 || v[2] < 0 || v[3] < 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode Check_Curved(SamGap gap)
{
  double curvature[2];

  PetscFunctionBegin;
  (void)Principal(gap->values, curvature);
  PetscCheck(
    curvature[0] >= 0, gap->comm, SAM_ERR_USER,
    "-%sgap_type %s: the surfaces cross, their smallest relative curvature is %.6g 1/m, the limit is 0: check the "
    "radii, a hole is larger than what lies in it; a press fit, with a pin larger than its hole, is in contact all "
    "around, which half-spaces do not describe: use finite elements",
    gap->prefix, gap->type, curvature[0]);
  PetscCheck(curvature[1] > 0, gap->comm, SAM_ERR_USER,
             "-%sgap_type %s: the radii are equal and opposite or infinite, so all relative curvatures are 0: give a "
             "clearance between the radii, or -%sgap_type flat",
             gap->prefix, gap->type, gap->prefix);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapCreate_Curved(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 5;
  gap->ops.parameters = curved;
  gap->ops.defaults   = curved_defaults;
  gap->ops.height     = Height_Curved;
  gap->ops.contact    = Contact_Curved;
  gap->ops.steepness  = Steepness_Curved;
  gap->ops.concave    = Concave_Curved;
  gap->ops.cylinder   = curved_cylinder;
  gap->ops.check      = Check_Curved;
  PetscFunctionReturn(PETSC_SUCCESS);
}

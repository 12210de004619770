/*
  Bodies of finite length. A pad, or a roller with rounded ends, has along x and along y a straight part of half width
  c, then a parabola, (s - c)^2/2R at a distance s. A roller of relative radius R and half length l may
  have a logarithmic profile along its axis y, with amplitude A and the drop d at its ends:
  x^2/2R - A ln(1 - (1 - exp(-d/A)) (y/l)^2). Beyond the ends it continues straight.
  The profile: G. Lundberg, Elastische Beruehrung zweier Halbraeume, Forsch. Ing.-Wes. 10 (1939) 201-211, with an end:
  H. Fujiwara, T. Kawase, Logarithmic profiles of rollers in roller bearings, NTN Technical Review 75 (2007) 140-148.
*/
#include <petsam/private/gapimpl.h>
#include <math.h>

static const SamGapParameter pad[] = {
  {"gap_half_flat_x", "half width of the flat part along x ()", "m", SAM_RANGE_NONNEGATIVE},
  {"gap_half_flat_y", "half width of the flat part along y ()", "m", SAM_RANGE_NONNEGATIVE},
  {"gap_edge_radius_x", "radius of the edges along x (, inf: cylindrical)", "m", SAM_RANGE_POSITIVE_INF},
  {"gap_edge_radius_y", "radius of the edges along y (, inf: cylindrical)", "m", SAM_RANGE_POSITIVE_INF}};

static const PetscReal pad_defaults[] = {0, 0, NAN, INFINITY}, pad_cylinder[] = {NAN, NAN, NAN, INFINITY};

static const SamGapParameter roller[] = {
  {"gap_roller_radius", "relative radius of curvature across, along x ()", "m", SAM_RANGE_POSITIVE},
  {"gap_roller_half_length", "half length along y ()", "m", SAM_RANGE_POSITIVE},
  {"gap_roller_crown", "amplitude of the crown (), load per length/(pi E*)", "m", SAM_RANGE_POSITIVE},
  {"gap_roller_drop", "drop of the profile at the ends ()", "m", SAM_RANGE_POSITIVE}};

static PetscReal Height_Pad(const PetscReal v[], PetscReal x, PetscReal y)
{
  const PetscReal beyond[2] = {PetscMax(fabs(x) - v[0], 0), PetscMax(fabs(y) - v[1], 0)};

  return 0.5 * beyond[0] * beyond[0] / v[2] + 0.5 * beyond[1] * beyond[1] / v[3];
}

static PetscReal Height_Roller(const PetscReal v[], PetscReal x, PetscReal y)
{
  const double part = -expm1(-v[3] / v[2]), s = fabs(y) / v[1];
  /* slope at the end, times the half length; an end steeper than 45 degrees acts like a wall */
  const double end = PetscMin(2 * v[2] * part * exp(v[3] / v[2]), v[1]);

  return 0.5 * x * x / v[0] + (s > 1 ? v[3] + end * (s - 1) : -v[2] * log1p(-part * s * s));
}

/* Describes a contact that has a closed-form solution in plane strain only; it is unlimited along a straight axis. */
static SamGapContact Contact_Pad(const PetscReal v[], PetscReal half)
{
  (void)half;
  return (SamGapContact){{isinf(v[2]) ? INFINITY : NAN, isinf(v[3]) ? INFINITY : NAN}, INFINITY, INFINITY};
}

static SamGapContact Contact_Roller(const PetscReal v[], PetscReal half)
{
  (void)v;
  (void)half;
  return (SamGapContact){{NAN, NAN}, INFINITY, INFINITY};
}

static PetscReal Steepness_Pad(const PetscReal v[], const PetscReal half[2], PetscInt *parameter)
{
  const PetscReal slope[2] = {PetscMax(half[0] - v[0], 0) / v[2], PetscMax(half[1] - v[1], 0) / v[3]};

  *parameter = slope[0] >= slope[1] ? 2 : 3;
  return PetscMax(slope[0], slope[1]);
}

static PetscReal Steepness_Roller(const PetscReal v[], const PetscReal half[2], PetscInt *parameter)
{
  *parameter = 0;
  return half[0] / v[0];
}

PetscErrorCode SamGapCreate_Pad(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 4;
  gap->ops.parameters = pad;
  gap->ops.defaults   = pad_defaults;
  gap->ops.height     = Height_Pad;
  gap->ops.contact    = Contact_Pad;
  gap->ops.steepness  = Steepness_Pad;
  gap->ops.cylinder   = pad_cylinder;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapCreate_Roller(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.count      = 4;
  gap->ops.parameters = roller;
  gap->ops.height     = Height_Roller;
  gap->ops.contact    = Contact_Roller;
  gap->ops.steepness  = Steepness_Roller;
  PetscFunctionReturn(PETSC_SUCCESS);
}

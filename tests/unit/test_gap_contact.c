/*
  What closed solutions say of the contact of a shape: against Hertz's formulas, numerical integrals of the pressure,
  and each other.
*/
#include "samtest.h"

#include <petsam/private/gap.h>
#include <petsam/private/baseimpl.h>

static SamGap NewGap(const char *options)
{
  SamGap gap;

  SetOptions(options);
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGapSetFromOptions(gap));
  sam_call(PetscOptionsClear(NULL));
  return gap;
}

/* The half widths under a force over E*, or at an approach; false: there is no closed solution. */
static PetscBool Estimate(const char *options, PetscBool force, double value, PetscReal half[2])
{
  SamGap    gap = NewGap(options);
  PetscBool known;

  sam_call(SamGapEstimateContact(gap, force, value, half, &known));
  sam_call(SamGapDestroy(&gap));
  return known;
}

static void test_spheres_touch_as_hertz_says(void **state)
{
  PetscReal half[2];

  (void)state;
  for (double force = 1e-12; force < 1e3; force *= 1e3) {
    const double R = 1 / (1 / 0.2 + 1 / 0.7), a = cbrt(0.75 * force * R);

    sam_assert(Estimate("-gap_type sphere -gap_radius1 0.2 -gap_radius2 0.7", PETSC_TRUE, force, half));
    sam_assert_close(half[0], a, 1e-8 * a);
    sam_assert_close(half[1], a, 1e-8 * a);
    sam_assert(Estimate("-gap_type sphere -gap_radius1 0.2 -gap_radius2 0.7", PETSC_FALSE, a * a / R, half));
    sam_assert_close(half[0], a, 1e-8 * a);
  }
}

/* Displacement over (1 - nu)/(2 pi G), of p0 = E* pi on the ellipse, at (x, y): polar coordinates about that point. */
static double Potential(double a, double b, double x, double y)
{
  enum { RAYS = 2000, POINTS = 400 };
  double sum = 0;

  for (int k = 0; k < RAYS; k++) {
    const double angle = (k + 0.5) * 2 * PETSC_PI / RAYS, c = cos(angle), s = sin(angle);
    const double A = c * c / (a * a) + s * s / (b * b), B = x * c / (a * a) + y * s / (b * b),
                 C = 1 - x * x / (a * a) - y * y / (b * b), root = sqrt(fmax(0, B * B + A * C)), end = (root - B) / A,
                 start = fmin(fmax(0, -(root + B) / A), end);

    for (int i = 0; i < POINTS; i++) { /* 1 - t^2 is C - 2 B r - A r^2, with a root at the end */
      const double t = (i + 0.5) / POINTS, r = start + (end - start) * t * (2 - t);

      sum += sqrt(fmax(0, C - 2 * B * r - A * r * r)) * (end - start) * 2 * (1 - t) / POINTS;
    }
  }
  return sum * 2 * PETSC_PI / RAYS;
}

/* The separation closes inside the ellipse: u(0) - u(x) is the separation, and u(0) the approach. */
static void test_ellipsoids_touch_where_their_pressure_closes_the_gap(void **state)
{
  static const double radii[][2] = {{1, 0.5}, {0.1, 2}, {3, 2.999}, {1, 1}, {50, 0.4}};

  (void)state;
  for (size_t k = 0; k < sizeof(radii) / sizeof(radii[0]); k++) {
    const double force = 1e-6;
    PetscReal    half[2], same[2];
    char         options[128];
    double       p0, centre;

    (void)snprintf(options, sizeof(options), "-gap_type ellipsoid -gap_radius_x %.17g -gap_radius_y %.17g", radii[k][0],
                   radii[k][1]);
    sam_assert(Estimate(options, PETSC_TRUE, force, half));
    p0     = 1.5 * force / (PETSC_PI * half[0] * half[1]); /* over E* */
    centre = p0 / PETSC_PI * Potential(half[0], half[1], 0, 0);
    for (int axis = 0; axis < 2; axis++) {
      const double x  = 0.7 * half[axis];
      const double at = p0 / PETSC_PI * Potential(half[0], half[1], axis ? 0 : x, axis ? x : 0);

      sam_assert_close(centre - at, 0.5 * x * x / radii[k][axis], 2e-4 * centre); /* the integral's error */
    }
    sam_assert(Estimate(options, PETSC_FALSE, centre, same));
    for (int axis = 0; axis < 2; axis++) sam_assert_close(same[axis], half[axis], 1e-4 * half[axis]);
  }
}

/* Hertz's ellipse turned by 60 degrees, within a rectangle; along the axes as the ellipsoid; and no ends. */
static void test_curved_bodies_have_the_ellipse_of_their_curvatures(void **state)
{
  PetscReal half[2], own[2];

  (void)state;
  sam_assert(Estimate("-gap_type ellipsoid -gap_radius_x 0.2 -gap_radius_y 0.05", PETSC_TRUE, 1e-9, own));
  sam_assert(Estimate("-gap_type curved -gap_radius2_x 0.2 -gap_radius2_y 0.05", PETSC_TRUE, 1e-9, half));
  for (int k = 0; k < 2; k++) sam_assert_close(half[k], own[k], 1e-8 * own[k]);
  sam_assert(Estimate("-gap_type curved -gap_radius2_x 0.2 -gap_radius2_y 0.05 -gap_angle 60", PETSC_TRUE, 1e-9, half));
  sam_assert_close(half[0], hypot(0.5 * own[0], 0.5 * sqrt(3) * own[1]), 1e-8 * own[0]);
  sam_assert_close(half[1], hypot(0.5 * sqrt(3) * own[0], 0.5 * own[1]), 1e-8 * own[0]);
  (void)Estimate("-gap_type curved -gap_radius1_x 0.3 -gap_radius2_x -0.4", PETSC_TRUE, 1, half);
  sam_assert(!isinf(half[0]) && isinf(half[1]));
  (void)Estimate("-gap_type curved -gap_radius1_y 0.3", PETSC_TRUE, 1, half);
  sam_assert(isinf(half[0]) && !isinf(half[1]));
  (void)Estimate("-gap_type curved -gap_radius1_x 0.3 -gap_radius2_x -0.3", PETSC_TRUE, 1, half);
  sam_assert(isinf(half[0]) && isinf(half[1]));
}

/* Pads and rollers have none but in plane strain: there a pad is a punch. */
static void test_bodies_of_finite_length_have_closed_forms_in_plane_strain_only(void **state)
{
  static const char *const pads[] = {"-gap_type pad -gap_half_flat_x 1e-3 -gap_edge_radius_x 0.05",
                                     "-gap_type punch -gap_flat_radius 1e-3 -gap_edge_radius 0.05"};
  PetscReal                half[2], line[2];
  PetscBool                known;

  (void)state;
  sam_assert(!Estimate("-gap_type pad -gap_edge_radius_x 1 -gap_edge_radius_y 1", PETSC_TRUE, 1e-9, half));
  sam_assert(!Estimate("-gap_type roller -gap_roller_radius 1 -gap_roller_half_length 1 -gap_roller_crown 1e-6 "
                       "-gap_roller_drop 1e-5",
                       PETSC_TRUE, 1e-9, half));
  (void)Estimate(pads[0], PETSC_TRUE, 1e-9, half);
  sam_assert(isinf(half[1]) && !isinf(half[0]));
  for (int k = 0; k < 2; k++) {
    SamGap gap = NewGap(pads[k]);

    sam_call(SamGapEstimateLine(gap, 1e-6, &line[k], &known));
    sam_assert(known);
    sam_call(SamGapDestroy(&gap));
  }
  sam_assert_close(line[0], line[1], 1e-12);
}

/* Without a flat base a punch is a sphere; a large base carries a small load within it and a little more. */
static void test_punches_touch_beyond_their_base(void **state)
{
  PetscReal half[2], sphere[2];

  (void)state;
  sam_assert(Estimate("-gap_type punch -gap_flat_radius 0 -gap_edge_radius 0.06", PETSC_TRUE, 1e-8, half));
  sam_assert(Estimate("-gap_type sphere -gap_radius1 0.06 -gap_radius2 inf", PETSC_TRUE, 1e-8, sphere));
  sam_assert_close(half[0], sphere[0], 1e-8 * sphere[0]);
  sam_assert(Estimate("-gap_type punch -gap_flat_radius 2e-3 -gap_edge_radius 0.05", PETSC_TRUE, 1e-16, half));
  sam_assert(half[0] > 2e-3 && half[0] < 2.01e-3);
  /* 4000 N on steel (E* = 115.385 GPa): Sneddon's integral by 1e5 midpoints */
  sam_assert(
    Estimate("-gap_type punch -gap_flat_radius 2e-3 -gap_edge_radius 0.05", PETSC_TRUE, 4000 / 115.385e9, half));
  {
    double force = 0;

    for (int k = 0; k < 100000; k++) {
      const double t = (k + 0.5) * PETSC_PI / 2 / 100000, r = half[0] * sin(t);

      force += 2 * half[0] * half[0] * sin(t) * sin(t) * fmax(0, r - 2e-3) / 0.05 * PETSC_PI / 2 / 100000;
    }
    sam_assert_close(force, 4000 / 115.385e9, 1e-6 * force);
  }
}

static void test_straight_bodies_touch_without_end(void **state)
{
  PetscReal half[2];

  (void)state;
  (void)Estimate("-gap_type flat", PETSC_TRUE, 1, half);
  sam_assert(isinf(half[0]) && isinf(half[1]));
  (void)Estimate("-gap_type sphere -gap_radius1 inf -gap_radius2 inf", PETSC_FALSE, 1, half);
  sam_assert(isinf(half[0]) && isinf(half[1]));
  (void)Estimate("-gap_type ellipsoid -gap_radius_x 0.3 -gap_radius_y inf", PETSC_TRUE, 1, half);
  sam_assert(!isinf(half[0]) && isinf(half[1]));
}

static void test_measured_surfaces_have_no_closed_solution(void **state)
{
  PetscReal half[2];

  (void)state;
  sam_assert(!Estimate("-gap_type file -gap_file none.h5", PETSC_TRUE, 1, half));
  sam_assert(!Estimate("-gap_type sphere -gap_radius1 1 -gap_radius2 1 -gap_rough_file none.h5", PETSC_TRUE, 1, half));
}

static void test_steepness_is_that_of_the_smallest_radius(void **state)
{
  static const struct {
    const char *options;
    double      half[2], ratio;
    const char *option;
  } cases[] = {
    {"-gap_type sphere -gap_radius1 0.2 -gap_radius2 0.1", {0.01, 0.02}, 0.2, "gap_radius2"},
    {"-gap_type sphere -gap_radius1 0.2 -gap_radius2 inf", {0.01, 0.01}, 0.05, "gap_radius1"},
    {"-gap_type ellipsoid -gap_radius_x 2 -gap_radius_y 0.1", {0.1, 0.02}, 0.2, "gap_radius_y"},
    {"-gap_type ellipsoid -gap_radius_x 0.2 -gap_radius_y 0.1", {0.1, 0.02}, 0.5, "gap_radius_x"},
    {"-gap_type punch -gap_flat_radius 1 -gap_edge_radius 0.1", {1.03, 1.02}, 0.3, "gap_edge_radius"},
    {"-gap_type punch -gap_flat_radius 1 -gap_edge_radius 0.1", {0.9, 0.9}, 0, "gap_edge_radius"},
    {"-gap_type curved -gap_radius1_x 0.1 -gap_radius2_x -0.11", {0.02, 9}, 0.2, "gap_radius1_x"},
    {"-gap_type curved -gap_radius2_x 1 -gap_radius2_y 0.1 -gap_angle 90", {0.02, 0.01}, 0.2, "gap_radius2_y"},
    {"-gap_type pad -gap_half_flat_x 1 -gap_half_flat_y 2 -gap_edge_radius_x 0.1 -gap_edge_radius_y 0.2",
     {1.03, 2.1},
     0.5,
     "gap_edge_radius_y"},
    {"-gap_type roller -gap_roller_radius 0.1 -gap_roller_half_length 1 -gap_roller_crown 1e-6 -gap_roller_drop 1e-5",
     {0.02, 1},
     0.2,
     "gap_roller_radius"},
    {"-gap_type flat", {1, 1}, 0, NULL},
  };

  (void)state;
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    SamGap          gap     = NewGap(cases[k].options);
    const PetscReal half[2] = {cases[k].half[0], cases[k].half[1]};
    SamGapSteepness s;

    sam_call(SamGapGetSteepness(gap, half, &s));
    sam_assert_close(s.ratio, cases[k].ratio, 1e-12);
    sam_assert(cases[k].option ? s.option && !strcmp(s.option, cases[k].option) : !s.option);
    sam_call(SamGapDestroy(&gap));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_spheres_touch_as_hertz_says),
    cmocka_unit_test(test_ellipsoids_touch_where_their_pressure_closes_the_gap),
    cmocka_unit_test(test_curved_bodies_have_the_ellipse_of_their_curvatures),
    cmocka_unit_test(test_bodies_of_finite_length_have_closed_forms_in_plane_strain_only),
    cmocka_unit_test(test_punches_touch_beyond_their_base),
    cmocka_unit_test(test_straight_bodies_touch_without_end),
    cmocka_unit_test(test_measured_surfaces_have_no_closed_solution),
    cmocka_unit_test(test_steepness_is_that_of_the_smallest_radius),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

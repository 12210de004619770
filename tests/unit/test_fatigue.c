/* Invariants, smallest balls and fatigue parameters: closed solutions, bounds from duality, invariances. */
#include "fields.h"

#include <petsam/private/fatigue.h>
#include <petsam/private/stressimpl.h>

enum { COMPONENTS = SAM_STRESS_COMPONENTS, XX = SAM_STRESS_XX, YY = SAM_STRESS_YY, ZZ = SAM_STRESS_ZZ };
enum { XY = SAM_STRESS_XY, XZ = SAM_STRESS_XZ, YZ = SAM_STRESS_YZ, STATES = 7 };

static double Part(PetscInt seed, PetscInt k)
{
  return Random(seed, 0, k, 3 * k + 1);
}

/* s -> R s R', for the rotation by an angle about one axis and another angle about the next. */
static void Rotate(double angle, int axis, double s[COMPONENTS])
{
  const int    a = (axis + 1) % 3, b = (axis + 2) % 3;
  const double c = cos(angle), d = sin(angle);
  double       m[3][3] = {{s[XX], s[XY], s[XZ]}, {s[XY], s[YY], s[YZ]}, {s[XZ], s[YZ], s[ZZ]}};

  for (int k = 0; k < 3; k++) {
    const double x = m[a][k], y = m[b][k];

    m[a][k] = c * x - d * y;
    m[b][k] = d * x + c * y;
  }
  for (int k = 0; k < 3; k++) {
    const double x = m[k][a], y = m[k][b];

    m[k][a] = c * x - d * y;
    m[k][b] = d * x + c * y;
  }
  s[XX] = m[0][0];
  s[YY] = m[1][1];
  s[ZZ] = m[2][2];
  s[XY] = m[0][1];
  s[XZ] = m[0][2];
  s[YZ] = m[1][2];
}

/* ---- invariants ---- */

static void test_principal_stresses_are_those_that_were_turned(void **state)
{
  const double given[][3] = {{3, 1, -2}, {1, 1, 1}, {2, 2, -1}, {5, 1e-9, -1e-9}, {0, 0, 0}, {1, 1 - 1e-12, -4}};

  (void)state;
  for (int n = 0; n < 6; n++)
    for (int turn = 0; turn < 20; turn++) {
      double        s[COMPONENTS] = {[XX] = given[n][1], [YY] = given[n][2], [ZZ] = given[n][0]}, p[3], mises, mine[3];
      double       *to[3]         = {&mine[0], &mine[1], &mine[2]};
      const double *from[COMPONENTS];
      const double  a = given[n][0] - given[n][1], b = given[n][1] - given[n][2], c = given[n][2] - given[n][0];

      for (int axis = 0; axis < 3; axis++) Rotate(0.37 * turn * (axis + 1), axis, s);
      for (int k = 0; k < COMPONENTS; k++) from[k] = &s[k];
      SamPrincipalOf(s, p);
      SamStressPrincipal(1, from, to);
      SamStressMises(1, from, &mises);
      for (int k = 0; k < 3; k++) {
        sam_assert_close(p[k], given[n][k], 1e-14 * (1 + fabs(given[n][0])));
        sam_assert(p[k] == mine[k]);
      }
      sam_assert_close(mises, sqrt(0.5 * (a * a + b * b + c * c)), 1e-13);
    }
}

static void test_strains_obey_hooke(void **state)
{
  const double  young = 2e11, nu = 0.28, s[COMPONENTS] = {1e6, -3e6, 2e6, 0.5e6, -0.7e6, 1.1e6};
  double        e[COMPONENTS], rigid[COMPONENTS], *to[COMPONENTS], *none[COMPONENTS];
  const double *from[COMPONENTS];

  (void)state;
  for (int k = 0; k < COMPONENTS; k++) {
    from[k] = &s[k];
    to[k]   = &e[k];
    none[k] = &rigid[k];
  }
  SamStressStrain(1, young, nu, from, to);
  SamStressStrain(1, PETSC_INFINITY, nu, from, none);
  sam_assert_close(e[XX], (s[XX] - nu * (s[YY] + s[ZZ])) / young, 1e-20);
  sam_assert_close(e[ZZ], (s[ZZ] - nu * (s[YY] + s[XX])) / young, 1e-20);
  sam_assert_close(e[XZ], s[XZ] * (1 + nu) / young, 1e-20);
  for (int k = 0; k < COMPONENTS; k++) sam_assert(rigid[k] == 0);
}

/* ---- balls ---- */

/* The largest of sum l |p|^2 - |sum l p|^2 over weights l, by steps towards the farthest point: from below. */
static double DualRadius(PetscInt dimension, PetscInt n, const double points[])
{
  double center[SAM_BALL_DIMENSION] = {0}, square = 0, best = 0;

  for (int step = 0; step < 20000; step++) {
    PetscInt far  = 0;
    double   most = -1, value = 0;

    for (PetscInt k = 0; k < n; k++) {
      double distance = 0;

      for (PetscInt d = 0; d < dimension; d++) distance += pow(points[k * dimension + d] - center[d], 2);
      if (distance > most) far = k;
      most = fmax(most, distance);
    }
    for (PetscInt d = 0; d < dimension; d++) value += center[d] * center[d];
    best  = fmax(best, square - value);
    value = 0;
    for (PetscInt d = 0; d < dimension; d++) value += points[far * dimension + d] * points[far * dimension + d];
    square += (value - square) / (step + 1);
    for (PetscInt d = 0; d < dimension; d++) center[d] += (points[far * dimension + d] - center[d]) / (step + 1);
  }
  return sqrt(fmax(0, best));
}

static void test_ball_holds_all_points_and_is_the_smallest(void **state)
{
  (void)state;
  for (PetscInt seed = 0; seed < 60; seed++) {
    const PetscInt dimension = 1 + seed % SAM_BALL_DIMENSION, n = 1 + (seed * 7) % 41, flat = seed % 3 == 2;
    double         points[41 * SAM_BALL_DIMENSION], center[SAM_BALL_DIMENSION], radius, dual, outside = 0;

    for (PetscInt k = 0; k < n; k++)
      for (PetscInt d = 0; d < dimension; d++) /* every third cloud lies on a line */
        points[k * dimension + d] = flat ? (d + 1) * Part(seed, k) : Part(seed, k * dimension + d) - 0.5;
    radius = SamSmallestBall(dimension, n, points, center);
    dual   = DualRadius(dimension, n, points);
    for (PetscInt k = 0; k < n; k++) {
      double square = 0;

      for (PetscInt d = 0; d < dimension; d++) square += pow(points[k * dimension + d] - center[d], 2);
      outside = fmax(outside, sqrt(square) - radius);
    }
    sam_assert_close(outside, 0, 1e-7);
    sam_assert(radius >= dual - 1e-9 && radius <= dual * (1 + 1e-3) + 1e-12);
  }
}

static void test_ball_of_known_points(void **state)
{
  const double square[] = {1, 1, -1, 1, 1, -1, -1, -1, 0.3, 0.2}, same[] = {2, 3, 2, 3, 2, 3};
  double       simplex[5 * 6] = {0}, center[5];

  (void)state;
  sam_assert_close(SamSmallestBall(2, 5, square, center), sqrt(2), 1e-14);
  sam_assert_close(hypot(center[0], center[1]), 0, 1e-14);
  sam_assert_close(SamSmallestBall(2, 3, same, center), 0, 1e-14);
  for (int k = 0; k < 5; k++) simplex[k * 5 + k] = 1;
  sam_assert_close(SamSmallestBall(5, 5, simplex, center), sqrt(0.8), 1e-13);
}

/* ---- parameters ---- */

static const SamFatigueConstants constants = {.young           = 1,
                                              .poisson         = 0.3,
                                              .crossland_alpha = 0.25,
                                              .dang_van_alpha  = 0.3,
                                              .findley_k       = 0.3,
                                              .fatemi_socie_k  = 1,
                                              .yield           = 1};

enum { CROSSLAND, DANG_VAN, FINDLEY, PARAMETERS = 5 };
static SamFatigueParameter *const parameters[PARAMETERS] = {SamFatigueCrossland, SamFatigueDangVan, SamFatigueFindley,
                                                            SamFatigueSWT, SamFatigueFatemiSocie};

static double Compute(SamFatigueParameter *parameter, PetscInt states, const double stress[])
{
  double               *scratch = (double *)malloc(sizeof(double) * SAM_FATIGUE_SCRATCH * (size_t)states), more[3];
  const SamFatigueCycle cycle   = {&constants, states, stress, NULL, scratch};
  const double          value   = (*parameter)(&cycle, more);

  free(scratch);
  return value;
}

/*
  Hertz's contact under Cattaneo and Mindlin's partial slip to and fro, a = p0 = E = 1, mu = 0.5, c/a = 0.6, at x = -a
  on the surface and below it: the stresses at both ends from quadrature of point forces, the parameters from a search
  by 0.2 degrees.
*/
static void test_trailing_edge_of_a_fretting_cycle(void **state)
{
  static const double stress[2][2][COMPONENTS] = {
    {{0.8767945130091972, 0.03794737869184789, 0, 0, 0, 0}, {-0.6101278463425306, -0.30461404535851455, 0, 0, 0, 0}},
    {{0.36827293376464454, -0.08080172078468822, -0.05567587433968244, 0, -0.0014829045781796224, 0},
     {-0.5821516332597589, -0.2878078552058778, -0.1596345121124947, 0, 0.21147780535490046, 0}}};
  static const double shear[2] = {0.38932893, 0.25428887}, mean[2] = {0.30491396, 0.07726511};
  static const double expected[2][PARAMETERS] = {{0, 0.46320478, 0.52582987, 0.60680929, 1.44878208},
                                                 {0, 0.26007529, 0.31803189, 0.16446694, 0.77814878}};

  (void)state;
  for (int z = 0; z < 2; z++) {
    double path[COMPONENTS * 2];

    for (int c = 0; c < COMPONENTS; c++)
      for (int k = 0; k < 2; k++) path[c * 2 + k] = stress[z][k][c];
    sam_assert_close(Compute(SamFatigueCrossland, 2, path), shear[z] + 0.25 * mean[z], 1e-8);
    sam_assert_close(Compute(SamFatigueDangVan, 2, path), expected[z][DANG_VAN], 1e-7);
    for (int p = FINDLEY; p < PARAMETERS; p++)
      sam_assert_close(Compute(parameters[p], 2, path), expected[z][p], 2e-4 * expected[z][p]);
  }
}

/* Uniaxial tension to and fro: everything by hand. */
static void test_uniaxial_cycle(void **state)
{
  double path[COMPONENTS * 3] = {0};

  (void)state;
  path[YY * 3 + 1] = 2; /* from -1 through 2 to 0.5 */
  path[YY * 3 + 0] = -1;
  path[YY * 3 + 2] = 0.5;
  sam_assert_close(Compute(SamFatigueCrossland, 3, path), 1.5 / sqrt(3) + 0.25 * 2 / 3, 1e-12);
  sam_assert_close(Compute(SamFatigueDangVan, 3, path), 0.75 + 0.3 * 2 / 3, 1e-12);
  sam_assert_close(Compute(SamFatigueSWT, 3, path), 2 * 1.5, 1e-12);
  /* tau_a = 0.75 sin 2t, s_n = 2 cos^2 t: Findley's maximum is known in closed form */
  sam_assert_close(Compute(SamFatigueFindley, 3, path), 0.3 + hypot(0.75, 0.3), 1e-12);
}

static void test_pure_compression_has_no_swt(void **state)
{
  double path[COMPONENTS * 2] = {0};

  (void)state;
  path[XX * 2] = -3;
  path[ZZ * 2] = path[ZZ * 2 + 1] = -1;
  sam_assert(Compute(SamFatigueSWT, 2, path) == 0);
}

/* No parameter knows how the axes lie; planes are found to the last digits. */
static void test_parameters_do_not_depend_on_the_axes(void **state)
{
  (void)state;
  for (PetscInt seed = 0; seed < 25; seed++) {
    double path[COMPONENTS * STATES], turned[COMPONENTS * STATES];

    for (int k = 0; k < STATES; k++) {
      double s[COMPONENTS];

      for (int c = 0; c < COMPONENTS; c++) s[c] = path[c * STATES + k] = Part(seed, 7 * k + c) - 0.3;
      for (int axis = 0; axis < 3; axis++) Rotate(0.3 + 0.7 * seed * (axis + 1), axis, s);
      for (int c = 0; c < COMPONENTS; c++) turned[c * STATES + k] = s[c];
    }
    for (int p = 0; p < PARAMETERS; p++) {
      const double a = Compute(parameters[p], STATES, path), b = Compute(parameters[p], STATES, turned);

      sam_assert_close(a, b, (p == CROSSLAND || p == DANG_VAN ? 1e-12 : 1e-9) * fabs(a));
    }
  }
}

/* Under strong compression Findley's parameter is negative; there too it is that of the best plane. */
static void test_negative_parameters_do_not_depend_on_the_axes(void **state)
{
  (void)state;
  for (PetscInt seed = 0; seed < 25; seed++) {
    double path[COMPONENTS * STATES], turned[COMPONENTS * STATES], a, b;

    for (int k = 0; k < STATES; k++) {
      double s[COMPONENTS];

      for (int c = 0; c < COMPONENTS; c++)
        s[c] = path[c * STATES + k] = Part(seed, 7 * k + c) - 0.3 - (c == XX || c == YY || c == ZZ ? 10 : 0);
      for (int axis = 0; axis < 3; axis++) Rotate(0.3 + 0.7 * seed * (axis + 1), axis, s);
      for (int c = 0; c < COMPONENTS; c++) turned[c * STATES + k] = s[c];
    }
    a = Compute(SamFatigueFindley, STATES, path);
    b = Compute(SamFatigueFindley, STATES, turned);
    sam_assert(a < 0);
    sam_assert_close(a, b, 1e-3);
  }
}

/* However narrow the cone of planes under tension is: the one across the tension is among them. */
static void test_weak_tension_is_found(void **state)
{
  (void)state;
  for (PetscInt seed = 0; seed < 25; seed++) {
    double path[2 * COMPONENTS];

    for (int k = 0; k < 2; k++) {
      double s[COMPONENTS] = {[XX] = k ? 1e-3 : -2, [YY] = -5, [ZZ] = -7};

      for (int axis = 0; axis < 3; axis++) Rotate(0.4 + 0.9 * (double)seed * (axis + 1), axis, s);
      for (int c = 0; c < COMPONENTS; c++) path[c * 2 + k] = s[c];
    }
    /* across the tension: 1e-3 times half the range of strain, 2.001/E */
    sam_assert(Compute(SamFatigueSWT, 2, path) >= 1e-3 * 0.5 * 2.001 / constants.young * (1 - 1e-6));
  }
}

/* The search finds what a fine grid of planes finds. */
static void test_search_misses_no_plane(void **state)
{
  (void)state;
  for (PetscInt seed = 40; seed < 60; seed++) {
    double path[COMPONENTS * STATES], best = 0;

    for (int k = 0; k < STATES * COMPONENTS; k++) path[k] = Part(seed, k) - 0.3;
    for (int t = 0; t <= 90; t++)
      for (int f = 0; f < 360; f++) {
        const double a = t * PETSC_PI / 180, b = f * PETSC_PI / 180, n[] = {sin(a) * cos(b), sin(a) * sin(b), cos(a)};
        double       most = 0, ends[2] = {INFINITY, -INFINITY};

        for (int k = 0; k < STATES; k++) {
          const double *s = path + k, xx = s[XX * STATES], yy = s[YY * STATES], zz = s[ZZ * STATES];
          const double  sn =
            n[0] * n[0] * xx + n[1] * n[1] * yy + n[2] * n[2] * zz +
            2 * (n[0] * n[1] * s[XY * STATES] + n[0] * n[2] * s[XZ * STATES] + n[1] * n[2] * s[YZ * STATES]);
          const double en = 1.3 * sn - 0.3 * (xx + yy + zz);

          most    = fmax(most, sn);
          ends[0] = fmin(ends[0], en);
          ends[1] = fmax(ends[1], en);
        }
        best = fmax(best, most * 0.5 * (ends[1] - ends[0]));
      }
    sam_assert_close(Compute(SamFatigueSWT, STATES, path), best, 2e-3 * best);
  }
}

/* ---- derivatives by the stresses ---- */

/* Returns the derivative of a parameter by a change of the stresses, in the place of the stresses. */
static double Along(SamFatigueParameter *parameter, PetscInt states, const double stress[], const double change[])
{
  double                scratch[SAM_FATIGUE_SCRATCH * STATES], slope[COMPONENTS * STATES], sum = 0, more[3];
  const SamFatigueCycle cycle = {&constants, states, slope, NULL, scratch};

  memcpy(slope, stress, sizeof(double) * COMPONENTS * (size_t)states);
  sam_assert_close(SamFatigueSlopes(parameter, &cycle, slope),
                   (*parameter)(&(SamFatigueCycle){&constants, states, stress, NULL, scratch}, more), 0);
  for (int k = 0; k < COMPONENTS * states; k++) sum += slope[k] * change[k];
  return sum;
}

/* Two and three states on the circle, and all parameters; a seed has one of two planes that are equally good. */
static void test_slopes_beside_differences(void **state)
{
  (void)state;
  for (PetscInt seed = 0; seed < 40; seed++)
    for (int p = FINDLEY; p < PARAMETERS; p++) {
      double path[COMPONENTS * STATES], change[COMPONENTS * STATES], moved[COMPONENTS * STATES], value[2];

      for (int k = 0; k < STATES * COMPONENTS; k++) {
        path[k]   = Part(seed, k) - 0.3;
        change[k] = Part(seed, 100 + k) - 0.5;
      }
      for (int side = 0; side < 2; side++) {
        for (int k = 0; k < STATES * COMPONENTS; k++) moved[k] = path[k] + (side ? -1e-5 : 1e-5) * change[k];
        value[side] = Compute(parameters[p], STATES, moved);
      }
      sam_assert_close(Along(parameters[p], STATES, path, change), (value[0] - value[1]) / 2e-5, 1e-6);
    }
}

/* A parameter of the first degree is the sum of the stresses times its slopes; so is half of SWT. */
static void test_slopes_of_a_circle_of_planes(void **state)
{
  double path[COMPONENTS * 3] = {0}, none[COMPONENTS * 3] = {0};

  (void)state;
  path[YY * 3 + 1] = 2;
  path[YY * 3 + 0] = -1;
  path[YY * 3 + 2] = 0.5;
  sam_assert_close(Along(SamFatigueFindley, 3, path, path), 0.3 + hypot(0.75, 0.3), 1e-9);
  sam_assert_close(Along(SamFatigueSWT, 3, path, path), 2 * 2 * 1.5, 1e-9);
  sam_assert(Along(SamFatigueSWT, 3, none, path) == 0);
  sam_assert(Along(SamFatigueFindley, 3, none, none) == 0);
}

/* ---- Ruiz ---- */

static void test_ruiz_of_slip_to_and_fro(void **state)
{
  /* q = 3 against the slip, which is turned by 30 degrees; its amplitude is 2e-6 */
  const double c = cos(PETSC_PI / 6), s = 0.5, q[] = {3, -3}, way[] = {2e-6, -2e-6};
  double       stress[COMPONENTS * 2] = {0}, slip[4], scratch[SAM_FATIGUE_SCRATCH * 2], d1, d2;

  (void)state;
  for (int k = 0; k < 2; k++) {
    stress[XZ * 2 + k] = q[k] * c;
    stress[YZ * 2 + k] = q[k] * s;
    slip[k]            = -2 * way[k] * c; /* since the other state */
    slip[2 + k]        = -2 * way[k] * s;
  }
  stress[XX * 2] = 5; /* along the slip 5 cos^2 */
  d1             = SamFatigueRuiz(&(SamFatigueCycle){&constants, 2, stress, slip, scratch}, &d2);
  sam_assert_close(d1, 3 * 2e-6, 1e-18);
  sam_assert_close(d2, 5 * c * c * d1, 1e-17);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_principal_stresses_are_those_that_were_turned),
    cmocka_unit_test(test_strains_obey_hooke),
    cmocka_unit_test(test_ball_holds_all_points_and_is_the_smallest),
    cmocka_unit_test(test_ball_of_known_points),
    cmocka_unit_test(test_trailing_edge_of_a_fretting_cycle),
    cmocka_unit_test(test_uniaxial_cycle),
    cmocka_unit_test(test_pure_compression_has_no_swt),
    cmocka_unit_test(test_parameters_do_not_depend_on_the_axes),
    cmocka_unit_test(test_negative_parameters_do_not_depend_on_the_axes),
    cmocka_unit_test(test_weak_tension_is_found),
    cmocka_unit_test(test_search_misses_no_plane),
    cmocka_unit_test(test_slopes_beside_differences),
    cmocka_unit_test(test_slopes_of_a_circle_of_planes),
    cmocka_unit_test(test_ruiz_of_slip_to_and_fro),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

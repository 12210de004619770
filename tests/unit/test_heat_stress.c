/* Thermal stress below the surface, against reference values, derivatives of a potential, and other grids. */
#include "fields.h"

#include "../../src/laws/heat/heat.h"
#include <petsam/private/stress.h>

#include <complex.h>
#include <math.h>

/* ---- a wave ---- */

static void test_a_wave_has_reference_values(void **state)
{
  const double complex kappa                        = csqrt(CMPLX(1.3 * 1.3, -3.6));
  const double         of[2]                        = {creal(kappa), cimag(kappa)};
  static const double  values[SAM_THERMAL_PARTS][2] = {{-0.0249831514, -0.02853084698},
                                                       {-0.3263223328, -0.1621856279},
                                                       {0.02006292589, -0.01845122799},
                                                       {0.05959386276, -0.04518535237}};
  double               s[SAM_THERMAL_PARTS][2];

  (void)state;
  SamThermalStressWave(1.3, of, 0.3, 0.4, s);
  for (int k = 0; k < SAM_THERMAL_PARTS; k++)
    for (int part = 0; part < 2; part++) sam_assert_close(s[k][part], values[k][part], 1e-9);
}

/* Equilibrium along the wave and with depth, a free surface, and the strains of a displacement (compatibility). */
static void test_a_wave_is_in_equilibrium(void **state)
{
  static const double ks[] = {0.02, 1, 30};
  const double        h    = 1e-4;

  (void)state;
  for (int m = 0; m < 3; m++)
    for (int n = 0; n < 3; n++) {
      const double         k = ks[m], z = 0.3 / k, step = h / k;
      const double complex kappa = csqrt(CMPLX(k * k, (n - 1) * 0.7 * k));
      const double         of[2] = {creal(kappa), cimag(kappa)};
      double               s[3][SAM_THERMAL_PARTS][2];
      double complex       a[3][SAM_THERMAL_PARTS];

      for (int l = 0; l < 3; l++) {
        SamThermalStressWave(k, of, 0.3, z + (l - 1) * step, s[l]);
        for (int p = 0; p < SAM_THERMAL_PARTS; p++) a[l][p] = CMPLX(s[l][p][0], s[l][p][1]);
      }
      /* i k nn + d(i nz)/dz = 0, i k (i nz) + d zz/dz = 0 */
      sam_assert(cabs(k * a[1][SAM_THERMAL_NN] + (a[2][SAM_THERMAL_NZ] - a[0][SAM_THERMAL_NZ]) / (2 * step)) <
                 1e-6 * k);
      sam_assert(cabs(-k * a[1][SAM_THERMAL_NZ] + (a[2][SAM_THERMAL_ZZ] - a[0][SAM_THERMAL_ZZ]) / (2 * step)) <
                 1e-6 * k);
      SamThermalStressWave(k, of, 0.3, 0, s[0]);
      for (int p = SAM_THERMAL_ZZ; p <= SAM_THERMAL_NZ; p++) sam_assert(hypot(s[0][p][0], s[0][p][1]) < 1e-15);
      /* the strain across the wave is zero: tt = nu (nn + zz) - (1 - nu) T in these units */
      sam_assert(cabs(a[1][SAM_THERMAL_TT] - 0.3 * (a[1][SAM_THERMAL_NN] + a[1][SAM_THERMAL_ZZ]) +
                      0.7 * cexp(-kappa * z)) < 1e-13);
    }
}

/* ---- heat on a grid ---- */

static double Gauss(double x, double y, const void *context)
{
  const double *width = (const double *)context;

  return exp(-(x * x + y * y) / (*width * *width));
}

/* Stresses by Gaussian heat of the width 1, whole fields; the caller frees them. */
static double *StressOf(SamGrid grid, const SamHeatBody *body, double depth)
{
  const double     width = 1;
  Vec              flux = NewFrom(grid, Gauss, &width), stress = NewField(grid, SAM_STRESS_COMPONENTS);
  SamThermalStress t;
  double          *whole;

  sam_call(SamThermalStressCreate(grid, NULL, body, 0.3, &t));
  sam_call(SamThermalStressAdd(t, depth, flux, 1, stress));
  whole = Whole(grid, SAM_STRESS_COMPONENTS, stress);
  sam_call(SamThermalStressDestroy(&t));
  sam_destroy(&flux, &stress);
  return whole;
}

/* A body that stands: the sum of both stresses is the temperature at that depth, which has kernels of its own. */
static void test_standing_bodies_have_their_temperature(void **state)
{
  const SamHeatBody body  = {2, 1, 0};
  const double      width = 1;
  SamGrid           grid  = NewGrid(21, 17, 4, 3);

  (void)state;
  for (int k = 0; k < 3; k++) {
    const double depth = 0.4 * k;
    double      *s     = StressOf(grid, &body, depth), *t;
    SamConductor c;
    Vec          field = NewFrom(grid, Gauss, &width);

    sam_call(SamConductorCreate(grid, NULL, &body, depth, &c));
    sam_call(SamConductorApply(c, field, field));
    t = Whole(grid, 1, field);
    for (PetscInt m = 0; m < 21 * 17; m++) {
      sam_assert_close(s[m] + s[21 * 17 + m], -t[m], 1e-12);
      for (int other = SAM_STRESS_ZZ; other < SAM_STRESS_COMPONENTS; other++)
        if (other != SAM_STRESS_XY) sam_assert(s[other * 21 * 17 + m] == 0);
    }
    free(s);
    free(t);
    sam_destroy(&field);
    sam_call(SamConductorDestroy(&c));
  }
  sam_call(SamGridDestroy(&grid));
}

/* Returns the largest force per volume along x and y on planes parallel to the surface, on n x n cells. */
static double ForceOn(PetscInt n)
{
  const SamHeatBody body = {1, 1, 0};
  SamGrid           grid = NewGrid(n, n, 4, 4);
  double           *s = StressOf(grid, &body, 0.7), most = 0;
  const PetscInt    all = n * n;

  for (PetscInt k = n; k < all - n; k++) {
    if (k % n == 0 || k % n == n - 1) continue;
    for (int axis = 0; axis < 2; axis++) {
      const double  *along = s + (axis ? SAM_STRESS_YY : SAM_STRESS_XX) * all, *across = s + SAM_STRESS_XY * all;
      const PetscInt one = axis ? n : 1, other = axis ? 1 : n;

      most = fmax(most, fabs(along[k + one] - along[k - one] + across[k + other] - across[k - other]) * n / 8.);
    }
  }
  free(s);
  sam_call(SamGridDestroy(&grid));
  return most;
}

static void test_standing_bodies_are_in_equilibrium(void **state)
{
  const double coarse = ForceOn(20), fine = ForceOn(40);

  (void)state;
  sam_assert(coarse < 0.01 && coarse / fine > 3.5 && coarse / fine < 4.5);
}

/* Compares the stresses by moving heat with those on a grid three times as wide, over the maximum at the surface. */
static double ErrorAt(double p, double depth)
{
  const SamHeatBody body  = {1, 1, -2 * p};
  SamGrid           small = NewGrid(40, 40, 4.8, 4.8), large = NewGrid(120, 120, 14.4, 14.4);
  double *a = StressOf(small, &body, depth), *b = StressOf(large, &body, depth), *c = StressOf(small, &body, 0);
  double  error = 0, most = 0;

  for (int k = 0; k < SAM_STRESS_COMPONENTS; k++)
    for (PetscInt j = 8; j < 32; j++)
      for (PetscInt i = 8; i < 32; i++) {
        const double x = a[k * 1600 + j * 40 + i], y = b[k * 14400 + (j + 40) * 120 + i + 40];

        most  = fmax(most, fabs(c[k * 1600 + j * 40 + i]));
        error = fmax(error, fabs(x - y));
      }
  free(a);
  free(b);
  free(c);
  sam_call(SamGridDestroy(&small));
  sam_call(SamGridDestroy(&large));
  return error / most;
}

static void test_moving_bodies_hardly_depend_on_the_grid(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    const double depth = 0.7 * k;

    sam_assert(ErrorAt(5, depth) < 0.02); /* speed times side over 2 D = 24, near the limit */
    sam_assert(ErrorAt(60, depth) < 0.008);
  }
}

/* Under a fast body, at the surface, the heat has no room to expand: both stresses are -E alpha T/(1 - nu). */
static void test_fast_bodies_are_held(void **state)
{
  const SamHeatBody body  = {1, 1, -2 * 3e4};
  const double      width = 1;
  SamGrid           grid  = NewGrid(41, 31, 4, 3);
  double           *s = StressOf(grid, &body, 0), *t, most = 0;
  SamConductor      c;
  Vec               field = NewFrom(grid, Gauss, &width);

  (void)state;
  sam_call(SamConductorCreate(grid, NULL, &body, 0, &c));
  sam_call(SamConductorApply(c, field, field));
  t = Whole(grid, 1, field);
  for (PetscInt k = 0; k < 41 * 31; k++) most = fmax(most, t[k]);
  for (PetscInt j = 8; j < 23; j++)
    for (PetscInt i = 10; i < 31; i++)
      for (int a = 0; a < 2; a++) sam_assert_close(s[a * 41 * 31 + j * 41 + i], -t[j * 41 + i] / 0.7, 0.02 * most);
  free(s);
  free(t);
  sam_destroy(&field);
  sam_call(SamConductorDestroy(&c));
  sam_call(SamGridDestroy(&grid));
}

/*
  The same bits as on one rank; a body that moves to the other side has the mirrored stress, which is symmetric along y.
  Both sides of the grid are odd, so that a margin to one side only would show.
*/
static void test_ranks_and_directions(void **state)
{
  SamGrid grids[] = {NewGrid(31, 21, 4, 3), NewGridOn(PETSC_COMM_SELF, 31, 21, 4, 3, 0, 0)};
  enum { ALL = 31 * 21 };

  (void)state;
  for (int k = 0; k < 2; k++) {
    const SamHeatBody body = {1, 1, k ? -20 : 0}, back = {1, 1, k ? 20 : 0};
    double           *a = StressOf(grids[0], &body, 0.3), *b = StressOf(grids[1], &body, 0.3),
           *c = StressOf(grids[0], &back, 0.3);

    for (PetscInt m = 0; m < SAM_STRESS_COMPONENTS * ALL; m++) sam_assert(a[m] == b[m]);
    for (PetscInt m = 0; m < ALL; m++) {
      const PetscInt other = m / 31 * 31 + 30 - m % 31, across = (20 - m / 31) * 31 + m % 31;

      sam_assert_close(a[SAM_STRESS_XX * ALL + m], c[SAM_STRESS_XX * ALL + other], 1e-12);
      sam_assert_close(a[SAM_STRESS_XY * ALL + m], -c[SAM_STRESS_XY * ALL + other], 1e-12);
      sam_assert_close(a[SAM_STRESS_XZ * ALL + m], -c[SAM_STRESS_XZ * ALL + other], 1e-12);
      sam_assert_close(a[SAM_STRESS_XX * ALL + m], a[SAM_STRESS_XX * ALL + across], 1e-12);
      sam_assert_close(a[SAM_STRESS_YZ * ALL + m], -a[SAM_STRESS_YZ * ALL + across], 1e-12);
    }
    free(a);
    free(b);
    free(c);
  }
  for (int k = 0; k < 2; k++) sam_call(SamGridDestroy(&grids[k]));
}

static void test_slow_bodies_are_refused(void **state)
{
  const SamHeatBody body = {1, 1, -2 * 4.9};
  SamGrid           grid = NewGrid(8, 6, 4, 3);
  SamThermalStress  t;

  (void)state;
  sam_says(SamThermalStressCreate(grid, NULL, &body, 0.3, &t), PETSC_ERR_SUP, "at least 10 m/s");
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_wave_has_reference_values),
    cmocka_unit_test(test_a_wave_is_in_equilibrium),
    cmocka_unit_test(test_standing_bodies_have_their_temperature),
    cmocka_unit_test(test_standing_bodies_are_in_equilibrium),
    cmocka_unit_test(test_moving_bodies_hardly_depend_on_the_grid),
    cmocka_unit_test(test_fast_bodies_are_held),
    cmocka_unit_test(test_ranks_and_directions),
    cmocka_unit_test(test_slow_bodies_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/* Stresses by a uniform traction on a rectangle: stored values, equilibrium, the surface, symmetries, rows of lags. */
#include "samtest.h"

#include <petsam/private/halfspace.h>

typedef struct {
  double sides[2], poisson, point[3];
  double values[6][3]; /* xx, yy, zz, xy, xz, yz, each by p, q_x, q_y */
} Reference;

static const Reference references[] = {
#include "stress_values.txt"
};

enum { REFERENCES = sizeof(references) / sizeof(references[0]) };
enum { XX = SAM_STRESS_XX, YY = SAM_STRESS_YY, ZZ = SAM_STRESS_ZZ, XY = SAM_STRESS_XY, XZ = SAM_STRESS_XZ };
enum { YZ = SAM_STRESS_YZ, COMPONENTS = SAM_STRESS_COMPONENTS, TRACTIONS = SAM_STRESS_TRACTIONS };
#define PROMISED 1e-12

typedef double Kernels[COMPONENTS][TRACTIONS];

static void Get(const double sides[2], double nu, double x, double y, double z, Kernels k)
{
  SamHalfSpaceStressCell(sides, nu, (const PetscReal[3]){x, y, z}, k);
}

static double Largest(Kernels k)
{
  double most = 0;

  for (int c = 0; c < COMPONENTS; c++)
    for (int t = 0; t < TRACTIONS; t++) most = fmax(most, fabs(k[c][t]));
  return most;
}

static void test_kernels_match_40_digit_arithmetic(void **state)
{
  (void)state;
  for (int n = 0; n < REFERENCES; n++) {
    const Reference *ref = &references[n];
    Kernels          k;
    double           most = 0, worst = 0;

    Get(ref->sides, ref->poisson, ref->point[0], ref->point[1], ref->point[2], k);
    for (int c = 0; c < COMPONENTS; c++)
      for (int t = 0; t < TRACTIONS; t++) {
        most  = fmax(most, fabs(ref->values[c][t]));
        worst = SamLarger(worst, fabs(k[c][t] - ref->values[c][t]));
      }
    if (!(worst <= PROMISED * most))
      print_error("%g x %g at %g %g %g: error %g of %g\n", ref->sides[0], ref->sides[1], ref->point[0], ref->point[1],
                  ref->point[2], worst, most);
    sam_assert(worst <= PROMISED * most);
  }
}

/* Units: the stresses have no length in them, at the ends of the range of a double too. */
static void test_kernels_do_not_depend_on_the_unit_of_length(void **state)
{
  const double sides[] = {0.7, 1.1};
  Kernels      a, b;

  (void)state;
  Get(sides, 0.3, 3.7, -2.1, 0.4, a);
  for (int power = -900; power <= 900; power += 300) {
    const double unit = scalbn(1, power), scaled[] = {unit * sides[0], unit * sides[1]};

    Get(scaled, 0.3, unit * 3.7, unit * -2.1, unit * 0.4, b);
    sam_assert(!memcmp(a, b, sizeof(a)));
  }
}

/* Where the rule changes, the kernels do not. */
static void test_kernels_are_continuous(void **state)
{
  const double sides[] = {1, 0.6}, radii[] = {8, 13, 45, 640};

  (void)state;
  for (int n = 0; n < 4; n++)
    for (int angle = 0; angle < 12; angle++) {
      const double phi = 0.5 * angle, tilt = 0.1 * angle;
      const double u[] = {cos(phi) * cos(tilt), sin(phi) * cos(tilt), sin(tilt)};
      Kernels      a, b;

      Get(sides, 0.3, radii[n] * (1 - 1e-14) * u[0], radii[n] * (1 - 1e-14) * u[1], radii[n] * (1 - 1e-14) * u[2], a);
      Get(sides, 0.3, radii[n] * (1 + 1e-14) * u[0], radii[n] * (1 + 1e-14) * u[1], radii[n] * (1 + 1e-14) * u[2], b);
      for (int c = 0; c < COMPONENTS; c++)
        for (int t = 0; t < TRACTIONS; t++) sam_assert_close(a[c][t], b[c][t], 2 * PROMISED * Largest(a));
    }
}

/* The derivative of all kernels along an axis, by differences of order 6. */
static void Derive(const double sides[2], const double at[3], int axis, double step, Kernels d)
{
  const double weight[] = {0.75, -0.15, 1. / 60};

  memset(d, 0, sizeof(Kernels));
  for (int n = 1; n <= 3; n++)
    for (int sign = -1; sign <= 1; sign += 2) {
      double  x[] = {at[0], at[1], at[2]};
      Kernels k;

      x[axis] += sign * n * step;
      Get(sides, 0.3, x[0], x[1], x[2], k);
      for (int c = 0; c < COMPONENTS; c++)
        for (int t = 0; t < TRACTIONS; t++) d[c][t] += sign * weight[n - 1] * k[c][t] / step;
    }
}

static void test_stresses_are_in_equilibrium(void **state)
{
  const double sides[] = {1, 0.7}, places[][3] = {{0.3, 0.2, 0.5}, {-1.4, 0.9, 0.7}, {5, 3, 2}, {20, -9, 14}};
  const int    divergence[3][3] = {{XX, XY, XZ}, {XY, YY, YZ}, {XZ, YZ, ZZ}};

  (void)state;
  for (int n = 0; n < 4; n++) {
    Kernels d[3];

    for (int axis = 0; axis < 3; axis++) Derive(sides, places[n], axis, 0.02 * places[n][2], d[axis]);
    for (int i = 0; i < 3; i++)
      for (int t = 0; t < TRACTIONS; t++) {
        double sum = 0, most = 0;

        for (int axis = 0; axis < 3; axis++) {
          sum += d[axis][divergence[i][axis]][t];
          most = fmax(most, fabs(d[axis][divergence[i][axis]][t]));
        }
        sam_assert_close(sum, 0, 1e-7 * most);
      }
  }
}

/* The stress function's other condition: xx + yy + zz is harmonic. */
static void test_mean_stress_is_harmonic(void **state)
{
  const double sides[] = {1, 0.7}, place[] = {0.8, 0.6, 0.9}, h = 0.02;

  (void)state;
  for (int t = 0; t < TRACTIONS; t++) {
    double sum = 0, most = 0;

    for (int axis = 0; axis < 3; axis++) {
      double second = 0;

      for (int n = -2; n <= 2; n++) {
        const double weight[] = {-2.5, 4. / 3, -1. / 12};
        double       x[]      = {place[0], place[1], place[2]};
        Kernels      k;

        x[axis] += n * h;
        Get(sides, 0.3, x[0], x[1], x[2], k);
        second += weight[n < 0 ? -n : n] * (k[XX][t] + k[YY][t] + k[ZZ][t]) / (h * h);
      }
      sum += second;
      most = fmax(most, fabs(second));
    }
    sam_assert_close(sum, 0, 1e-5 * most);
  }
}

static void test_surface_carries_the_tractions(void **state)
{
  const double sides[] = {1, 0.7}, inside[][2] = {{0, 0}, {0.3, -0.2}, {-0.49, 0.34}},
               outside[][2] = {{0.6, 0}, {3, -9}};

  (void)state;
  for (int n = 0; n < 5; n++) {
    const double *at = n < 3 ? inside[n] : outside[n - 3];
    Kernels       k;

    Get(sides, 0.3, at[0], at[1], 0, k);
    for (int t = 0; t < TRACTIONS; t++) {
      sam_assert_close(k[ZZ][t], n < 3 && t == SAM_STRESS_P ? -1 : 0, 1e-15);
      sam_assert_close(k[XZ][t], n < 3 && t == SAM_STRESS_QX ? -1 : 0, 1e-15);
      sam_assert_close(k[YZ][t], n < 3 && t == SAM_STRESS_QY ? -1 : 0, 1e-15);
    }
  }
}

/* A point force seen from far away: its stresses, from closed forms of another shape than the kernels'. */
static void test_far_away_a_cell_is_a_point_force(void **state)
{
  const double sides[] = {1, 1}, x = 3e5, y = -2e5, z = 1e5, r = sqrt(x * x + y * y + z * z);
  Kernels      k;

  (void)state;
  Get(sides, 0.3, x, y, z, k);
  sam_assert_close(k[ZZ][SAM_STRESS_P] / (-1.5 * z * z * z / (PETSC_PI * pow(r, 5))), 1, 1e-10);
  sam_assert_close(k[XZ][SAM_STRESS_QX] / (-1.5 * x * x * z / (PETSC_PI * pow(r, 5))), 1, 1e-10);
  /* trace: (1 + nu) z/(pi r^3), (1 + nu) x/(pi r^3) */
  sam_assert_close((k[XX][0] + k[YY][0] + k[ZZ][0]) / (-1.3 * z / (PETSC_PI * r * r * r)), 1, 1e-10);
  sam_assert_close((k[XX][1] + k[YY][1] + k[ZZ][1]) / (-1.3 * x / (PETSC_PI * r * r * r)), 1, 1e-10);
}

/* ---- rows of lags ---- */

/* Rows are the kernels at the lags, but for the neighbours' correction; no bit depends on where a row ends. */
static void test_rows_are_kernels_at_lags(void **state)
{
  enum { N = 90 };
  const SamHalfSpaceSource source = {{1.0, 0.7}, 0.31, 0.3};

  (void)state;
  for (PetscInt j = 0; j < 70; j += j < 4 ? 1 : 13)
    for (int g = 0; g < SAM_STRESS_NORMAL_Z; g++) {
      double  rows[SAM_STRESS_GROUP][N], part[SAM_STRESS_GROUP][N];
      double *to[SAM_STRESS_GROUP] = {rows[0], rows[1], rows[2]}, *some[SAM_STRESS_GROUP] = {part[0], part[1], part[2]};

      SamHalfSpaceStressRow(&source, (SamStressGroup)g, j, N, to);
      SamHalfSpaceStressRow(&source, (SamStressGroup)g, j, N / 3, some);
      for (int m = 0; m < SAM_STRESS_GROUP; m++) sam_assert(!memcmp(rows[m], part[m], N / 3 * sizeof(double)));
      for (int c = 0; c < COMPONENTS; c++)
        for (int t = 0; t < TRACTIONS; t++)
          for (PetscInt i = 0; i < N; i += i < 4 ? 1 : 17) {
            Kernels k;

            if (SamStressKernels[c][t].group != (SamStressGroup)g || i + j == 1) continue;
            Get(source.side, source.poisson, (double)i * source.side[0], (double)j * source.side[1], source.depth, k);
            sam_assert_close(rows[SamStressKernels[c][t].member][i], k[c][t], 2 * PROMISED * Largest(k));
          }
    }
}

static void test_parities_are_those_of_the_kernels(void **state)
{
  const double sides[] = {1, 0.7};
  Kernels      k, x, y;

  (void)state;
  Get(sides, 0.3, 1.3, 0.9, 0.4, k);
  Get(sides, 0.3, -1.3, 0.9, 0.4, x);
  Get(sides, 0.3, 1.3, -0.9, 0.4, y);
  for (int c = 0; c < COMPONENTS; c++)
    for (int t = 0; t < TRACTIONS; t++) {
      const PetscBool *odd = SamStressOdd[SamStressKernels[c][t].group][SamStressKernels[c][t].member];

      sam_assert_close(x[c][t], odd[0] ? -k[c][t] : k[c][t], 1e-15);
      sam_assert_close(y[c][t], odd[1] ? -k[c][t] : k[c][t], 1e-15);
    }
}

/* s_xx in the middle of a linear shear q_x = x of many cells, without the part of the ends: 4 + nu, exact for cells. */
static void test_correction_is_that_of_a_linear_shear(void **state)
{
  (void)state;
  for (int n = 0; n < 4; n++) {
    const double             depths[] = {0, 0.2, 0.6, 1.5};
    const SamHalfSpaceSource source   = {{1, 1}, depths[n], 0.3};
    double                   row[2][SAM_STRESS_GROUP][2], plain[2][2]; /* group X at lags (0, 1) and (1, 0) */
    double  t = exp(-2 * PETSC_PI * depths[n]), L = log(1 + t), M = 2 * PETSC_PI * depths[n] * t / (1 + t);
    Kernels k;

    for (PetscInt j = 0; j < 2; j++)
      SamHalfSpaceStressRow(&source, SAM_STRESS_PLANE_X, j, 2, (double *[]){row[j][0], row[j][1], row[j][2]});
    Get(source.side, 0.3, 1, 0, depths[n], k);
    plain[0][0] = k[XX][SAM_STRESS_QX];
    plain[0][1] = k[YY][SAM_STRESS_QX];
    Get(source.side, 0.3, 0, 1, depths[n], k);
    plain[1][0] = k[XY][SAM_STRESS_QX];
    /* the kernel at lag 1 acts with -1/2 of h dq/dx on each side */
    sam_assert_close(-2 * (row[0][0][1] - plain[0][0]), (2 * L - M) / PETSC_PI, 1e-14);
    sam_assert_close(-2 * (row[0][1][1] - plain[0][1]), 2 * 0.3 * L / PETSC_PI, 1e-14);
    sam_assert_close(-2 * (row[1][2][0] - plain[1][0]), L / PETSC_PI, 1e-14);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_kernels_match_40_digit_arithmetic),
    cmocka_unit_test(test_kernels_do_not_depend_on_the_unit_of_length),
    cmocka_unit_test(test_kernels_are_continuous),
    cmocka_unit_test(test_stresses_are_in_equilibrium),
    cmocka_unit_test(test_mean_stress_is_harmonic),
    cmocka_unit_test(test_surface_carries_the_tractions),
    cmocka_unit_test(test_far_away_a_cell_is_a_point_force),
    cmocka_unit_test(test_rows_are_kernels_at_lags),
    cmocka_unit_test(test_parities_are_those_of_the_kernels),
    cmocka_unit_test(test_correction_is_that_of_a_linear_shear),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

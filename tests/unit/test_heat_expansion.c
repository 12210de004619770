/* Thermal expansion: the displacement of the surface by heat on cells, against other ways to compute it. */
#include "fields.h"

#include "../../src/laws/heat/expansion.h"

#include <math.h>

enum { LAGS = 26 };
static const PetscReal square[2] = {1, 1};

/* The body with the diffusivity 1 and P = speed/(2 D), whose material moves to -x. */
static SamHeatBody Moving(double p)
{
  return (SamHeatBody){.conductivity = 1, .capacity = 1, .speed = -2 * p};
}

/* Computes the displacements at the lag (i, j), |i| < LAGS, of cells with these sides. */
static void AtLag(const SamHeatBody *body, const PetscReal side[2], PetscInt i, PetscInt j, double u[3])
{
  const PetscInt k = PetscAbs(i), n[2] = {body->speed == 0 ? LAGS : k + 1, LAGS}; /* the datum depends on them */
  double         even[3][LAGS], odd[3][LAGS];
  double *const e[3] = {even[0], even[1], even[2]}, *const o[3] = {odd[0], odd[1], odd[2]};
  SamExpansionTable table;

  sam_call(SamExpansionTableCreate(body, side, n, &table));
  SamExpansionTableRow(table, PetscAbs(j), e, o);
  for (int m = 0; m < 3; m++) u[m] = even[m][k] + (i < 0 ? -1 : 1) * odd[m][k];
  if (j < 0) u[2] = -u[2];
  sam_call(SamExpansionTableDestroy(&table));
}

/* Out of the body, cells 1 x 1, from an integration with other points. */
static void test_moving_cells_have_reference_values(void **state)
{
  static const struct {
    double   p, value;
    PetscInt i, j;
  } rows[] = {{1, 0.26224483, 0, 0},
              {1, 0.13508911, -3, 0},
              {1, 0.01993534, 2, 1},
              {20, 0.0240829, 0, 0},
              {20, 0.0366669, -1, 0}};

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(*rows); k++) {
    const SamHeatBody body = Moving(rows[k].p);
    double            u[3];

    AtLag(&body, square, rows[k].i, rows[k].j, u);
    sam_assert_close(u[0], rows[k].value, 4e-8);
  }
}

/* A body that stands: the integral of -ln r over a cell, relative to that at half of the diagonal, and of x/r. */
static void test_standing_cells_have_closed_values(void **state)
{
  const SamHeatBody body = Moving(0);
  const double      far  = log(0.5 * hypot(LAGS, LAGS));
  double            u[3], sum[2] = {0};
  enum { N = 400 };

  (void)state;
  AtLag(&body, square, 0, 0, u);
  sam_assert_close(2 * PETSC_PI * u[0], 1.061175426883 + far, 1e-11);
  sam_assert(u[1] == 0 && u[2] == 0);
  AtLag(&body, square, 2, 1, u);
  sam_assert_close(2 * PETSC_PI * u[0], -0.8046725244597 + far, 1e-11);
  for (int a = 0; a < N; a++)
    for (int b = 0; b < N; b++) {
      const double x = 2 + (a + 0.5) / N - 0.5, y = 1 + (b + 0.5) / N - 0.5;

      sum[0] += x / hypot(x, y) / (2 * PETSC_PI * N * N);
      sum[1] += y / hypot(x, y) / (2 * PETSC_PI * N * N);
    }
  sam_assert_close(u[1], sum[0], 1e-6);
  sam_assert_close(u[2], sum[1], 1e-6);
}

/* Computes the displacements by plain sums over ages and points of the cell, of equations in space that do not need
   corners, sides and borders. */
static void SumPlainly(double p, double x, double y, double u[3])
{
  enum { AGES = 1000, N = 16 };
  const double last = log(400.), first = log(2e-3);

  u[0] = u[1] = u[2] = 0;
  for (int age = 0; age < AGES; age++) {
    const double s = exp(first + (age + 0.5) * (last - first) / AGES), weight = s * s * (last - first) / AGES / (N * N);

    for (int a = 0; a < N; a++)
      for (int b = 0; b < N; b++) {
        const double at = x + (a + 0.5) / N - 0.5 + 0.5 * p * s * s, across = y + (b + 0.5) / N - 0.5,
                     r = hypot(at, across), t = r / s, w = 0.5 * t * t;
        const double within = erf(t) - 2 / sqrt(PETSC_PI) * t * exp(-t * t);
        double       bessel = 0;

        for (int k = 0; k < 24; k++) { /* exp(-w) (I0 - I1) is the mean of (1 - cos f) exp(-w (1 - cos f)) */
          const double less = 1 - cos(PETSC_PI * (k + 0.5) / 24);

          bessel += less * exp(-w * less) / 24;
        }
        if (w > 60) bessel = (1 + 3 / (8 * w) + 45 / (128 * w * w)) / (2 * w * sqrt(2 * PETSC_PI * w));
        u[0] += weight * bessel / (2 * PETSC_PI * s * s);
        u[1] += weight * within * at / (2 * PETSC_PI * r * r * r);
        u[2] += weight * within * across / (2 * PETSC_PI * r * r * r);
      }
  }
}

static void test_moving_cells_are_plain_sums(void **state)
{
  static const PetscInt lags[][2] = {{2, 1}, {-2, 2}, {-9, 1}};

  (void)state;
  sam_on_one_rank();
  for (size_t k = 0; k < sizeof(lags) / sizeof(*lags); k++) {
    const SamHeatBody body = Moving(0.8);
    double            u[3], sum[3];

    AtLag(&body, square, lags[k][0], lags[k][1], u);
    SumPlainly(0.8, (double)lags[k][0], (double)lags[k][1], sum);
    for (int m = 0; m < 3; m++) sam_assert_close(u[m], sum[m], 1e-3 * hypot(sum[0], hypot(sum[1], sum[2])));
  }
}

/* A cell is its nine parts, near the source, in its wake and at a distance, for slow and fast bodies. */
static void test_displacements_are_those_of_the_parts(void **state)
{
  static const PetscReal whole[2] = {3, 2.4}, part[2] = {1, 0.8};
  static const PetscInt  lags[][2] = {{0, 0}, {-2, 1}, {3, 2}, {-7, 0}, {0, 7}, {-7, 7}};
  static const double    speeds[]  = {0.4, 40};

  (void)state;
  for (size_t v = 0; v < sizeof(speeds) / sizeof(*speeds); v++)
    for (size_t k = 0; k < sizeof(lags) / sizeof(*lags); k++) {
      const SamHeatBody body = Moving(speeds[v]);
      double            u[3], one[3], sum[3] = {0};

      AtLag(&body, whole, lags[k][0], lags[k][1], u);
      for (PetscInt a = -1; a <= 1; a++)
        for (PetscInt b = -1; b <= 1; b++) {
          AtLag(&body, part, 3 * lags[k][0] + a, 3 * lags[k][1] + b, one);
          for (int m = 0; m < 3; m++) sum[m] += one[m];
        }
      for (int m = 0; m < 3; m++) sam_assert_close(u[m], sum[m], 1e-4 * hypot(sum[0], hypot(sum[1], sum[2])));
    }
}

static void test_directions_mirror_each_other(void **state)
{
  static const PetscReal side[2] = {0.3e-3, 0.2e-3};

  (void)state;
  for (PetscInt i = -3; i <= 3; i += 3)
    for (PetscInt j = 0; j <= 2; j++) {
      const SamHeatBody to = {50, 3.6e6, 0.7}, fro = {50, 3.6e6, -0.7};
      double            a[3], b[3];

      AtLag(&to, side, i, j, a);
      AtLag(&fro, side, -i, j, b);
      sam_assert(a[0] == b[0] && a[1] == -b[1] && a[2] == b[2]);
    }
}

/* Differences of the displacements of a slow body are those of one that stands. */
static void test_slow_bodies_approach_the_one_at_rest(void **state)
{
  const SamHeatBody rest = Moving(0), slow = Moving(1e-8);
  double            near[2][3], far[2][3];

  (void)state;
  AtLag(&rest, square, 0, 0, near[0]);
  AtLag(&slow, square, 0, 0, near[1]);
  for (PetscInt i = -8; i <= 8; i += 8)
    for (PetscInt j = 0; j <= 4; j += 4) {
      AtLag(&rest, square, i, j, far[0]);
      AtLag(&slow, square, i, j, far[1]);
      sam_assert_close(far[1][0] - near[1][0], far[0][0] - near[0][0], 2e-6);
      for (int m = 1; m < 3; m++) sam_assert_close(far[1][m] - near[1][m], far[0][m] - near[0][m], 2e-6);
    }
}

/* The products are sums over the cells, the same bits on any number of ranks. */
static void test_products_are_sums_over_cells(void **state)
{
  static const double speeds[] = {0, 0.6, -30};
  enum { NX = 9, NY = 7 };
  static const PetscInt n[2] = {NX, NY};

  (void)state;
  for (int v = 0; v < 3; v++) {
    const SamHeatBody body    = Moving(speeds[v]);
    const PetscReal   cell[2] = {2. / NX, 1.5 / NY};
    SamGrid           grid[2] = {NewGrid(NX, NY, 2, 1.5), NewGridOn(PETSC_COMM_SELF, NX, NY, 2, 1.5, 0, 0)};
    double           *q       = NULL, *found[2][2], even[NY][3][NX], odd[NY][3][NX];
    SamExpansionTable table;

    for (int g = 0; g < 2; g++) {
      Vec         flux = NewRandom(grid[g], 1, 3), out = NewField(grid[g], 1), along = NewField(grid[g], 2);
      SamExpander e;

      sam_call(SamExpanderCreate(grid[g], NULL, &body, &e));
      sam_call(SamExpanderAdd(e, flux, 3, -2, out, along));
      found[g][0] = Whole(grid[g], 1, out);
      found[g][1] = Whole(grid[g], 2, along);
      if (g == 0) q = Whole(grid[g], 1, flux);
      sam_call(SamExpanderDestroy(&e));
      sam_destroy(&flux, &out, &along);
    }
    for (PetscInt k = 0; k < NX * NY; k++) sam_assert(found[0][0][k] == found[1][0][k]);
    for (PetscInt k = 0; k < 2 * NX * NY; k++) sam_assert(found[0][1][k] == found[1][1][k]);
    sam_call(SamExpansionTableCreate(&body, cell, n, &table));
    for (PetscInt j = 0; j < NY; j++) {
      double *const ev[3] = {even[j][0], even[j][1], even[j][2]}, *const od[3] = {odd[j][0], odd[j][1], odd[j][2]};

      SamExpansionTableRow(table, j, ev, od);
    }
    sam_call(SamExpansionTableDestroy(&table));
    for (PetscInt k = 0; k < NX * NY; k++) {
      double sum[3] = {0};

      for (PetscInt l = 0; l < NX * NY; l++) {
        const PetscInt i = k % NX - l % NX, j = k / NX - l / NX, a = PetscAbs(i), b = PetscAbs(j);

        for (int m = 0; m < 3; m++)
          sum[m] += q[l] * (m == 2 && j < 0 ? -1 : 1) * (even[b][m][a] + (i < 0 ? -1 : 1) * odd[b][m][a]);
      }
      sam_assert_close(found[0][0][k], 3 * sum[0], 1e-13);
      sam_assert_close(found[0][1][k], -2 * sum[1], 1e-13);
      sam_assert_close(found[0][1][NX * NY + k], -2 * sum[2], 1e-13);
    }
    free(q);
    for (int g = 0; g < 2; g++) {
      free(found[g][0]);
      free(found[g][1]);
      sam_call(SamGridDestroy(&grid[g]));
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_moving_cells_have_reference_values),
    cmocka_unit_test(test_standing_cells_have_closed_values),
    cmocka_unit_test(test_moving_cells_are_plain_sums),
    cmocka_unit_test(test_displacements_are_those_of_the_parts),
    cmocka_unit_test(test_directions_mirror_each_other),
    cmocka_unit_test(test_slow_bodies_approach_the_one_at_rest),
    cmocka_unit_test(test_products_are_sums_over_cells),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

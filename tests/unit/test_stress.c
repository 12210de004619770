/* Stresses on planes: direct summation, Hertz's contact on its axis and its surface, sliding, partial slip, bodies. */
#include "fields.h"

#include <petsam/private/halfspace.h>

enum { COMPONENTS = SAM_STRESS_COMPONENTS, TRACTIONS = SAM_STRESS_TRACTIONS };
#define NU 0.3

typedef struct {
  SamGrid   grid;
  SamStress stress;
  Vec       p, q, s;
} Case;

static Case NewCaseOf(SamGrid grid, PetscInt body, double poisson)
{
  Case c = {.grid = grid, .p = NewField(grid, 1), .q = NewField(grid, 2), .s = NewField(grid, COMPONENTS)};

  sam_call(SamHalfSpaceCreateStress(grid, NULL, body, poisson, &c.stress));
  return c;
}

static Case NewCase(SamGrid grid, PetscInt body)
{
  return NewCaseOf(grid, body, NU);
}

static void DestroyCase(Case *c)
{
  sam_call(SamStressDestroy(&c->stress));
  sam_destroy(&c->p, &c->q, &c->s);
  sam_call(SamGridDestroy(&c->grid));
}

static void Compute(Case *c, double depth)
{
  const PetscInt cells = c->grid->cells;
  const double  *p, *q;
  double        *s;

  sam_call(VecGetArrayRead(c->p, &p));
  sam_call(VecGetArrayRead(c->q, &q));
  sam_call(VecGetArray(c->s, &s));
  sam_call(PetscArraycpy(s + SAM_STRESS_ZZ * cells, p, cells));
  sam_call(PetscArraycpy(s + SAM_STRESS_XZ * cells, q, 2 * cells)); /* and yz */
  sam_call(VecRestoreArray(c->s, &s));
  sam_call(VecRestoreArrayRead(c->q, &q));
  sam_call(VecRestoreArrayRead(c->p, &p));
  sam_call(SamStressSetDepth(c->stress, depth));
  sam_call(SamStressApply(c->stress, c->s));
}

/* ---- direct summation ---- */

/* The kernel of a lag, the correction of the neighbours included, from rows of lags. */
static double Kernel(const SamHalfSpaceSource *source, int component, int traction, PetscInt i, PetscInt j)
{
  const SamStressKernel k   = SamStressKernels[component][traction];
  const PetscBool      *odd = SamStressOdd[k.group][k.member];
  double                row[SAM_STRESS_GROUP][32];
  const double          sign = (odd[0] && i < 0 ? -1 : 1) * (odd[1] && j < 0 ? -1 : 1);

  if ((odd[0] && i == 0) || (odd[1] && j == 0)) return 0;
  SamHalfSpaceStressRow(source, k.group, j < 0 ? -j : j, 32, (double *[]){row[0], row[1], row[2]});
  return sign * row[k.member][i < 0 ? -i : i];
}

static void AssertSum(PetscInt nx, PetscInt ny, PetscInt body, double depth)
{
  Case                     c      = NewCase(NewGrid(nx, ny, 1.2e-3, 0.9e-3), body);
  const SamHalfSpaceSource source = {{c.grid->dx, c.grid->dy}, depth, NU};
  const double             sign   = body == 1 ? -1 : 1;
  double                  *p, *q, worst = 0;

  sam_destroy(&c.p, &c.q);
  c.p = NewRandom(c.grid, 1, 3);
  c.q = NewRandom(c.grid, 2, 4);
  Compute(&c, depth);
  p = Whole(c.grid, 1, c.p);
  q = Whole(c.grid, 2, c.q);
  for (int component = 0; component < COMPONENTS; component++)
    for (PetscInt j = 0; j < ny; j += 2)
      for (PetscInt i = 0; i < nx; i += 3) {
        const double value = At(c.grid, c.s, (SamStressComponent)component, i, j);
        double       sum   = 0;

        for (PetscInt l = 0; l < ny; l++)
          for (PetscInt k = 0; k < nx; k++) {
            const double t[] = {p[l * nx + k], sign * q[l * nx + k], sign * q[(ny + l) * nx + k]};

            for (int traction = 0; traction < TRACTIONS; traction++)
              sum += Kernel(&source, component, traction, i - k, j - l) * t[traction];
          }
        worst = SamLarger(worst, fabs(value - sum));
      }
  sam_assert_close(worst, 0, 1e-13);
  free(p);
  free(q);
  DestroyCase(&c);
}

static void test_stresses_are_sums_over_the_cells(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    AssertSum(13, 7, body, 0);
    AssertSum(13, 7, body, 0.02e-3);
    AssertSum(6, 11, body, 0.3e-3);
    AssertSum(2, 3, body, 5e-3);
  }
}

/* ---- Hertz, a = p0 = 1 ---- */

/* The shear that goes with Hertz's pressure: mu p less `stuck` times that of the circle of radius c. */
static void SetHertz(Case *c, double mu, double circle)
{
  double *p, *q;

  sam_call(VecGetArray(c->p, &p));
  sam_call(VecGetArray(c->q, &q));
  for (PetscInt j = 0; j < c->grid->rows; j++)
    for (PetscInt i = 0; i < c->grid->nx; i++) {
      const PetscInt k = j * c->grid->nx + i;
      const double   x = SamGridX(c->grid, i), y = SamGridY(c->grid, c->grid->row_start + j), r2 = x * x + y * y;

      p[k] = r2 < 1 ? sqrt(1 - r2) : 0;
      q[k] = mu * (p[k] - (r2 < circle * circle ? sqrt(circle * circle - r2) : 0));
    }
  sam_call(VecRestoreArray(c->q, &q));
  sam_call(VecRestoreArray(c->p, &p));
}

static Case NewHertz(PetscInt n, double mu, double circle)
{
  Case c = NewCase(NewGrid(n, n, 2.6, 2.6), 2);

  SetHertz(&c, mu, circle);
  return c;
}

/* The largest error on the axis of n x n cells, n being odd. */
static double AxisError(PetscInt n)
{
  const double depths[] = {0.05, 0.1, 0.2, 0.48086449, 1, 2};
  Case         c        = NewHertz(n, 0, 0);
  double       worst    = 0;

  for (int k = 0; k < 6; k++) {
    const double z = depths[k], zz = -1 / (1 + z * z), rr = -(1 + NU) * (1 - z * atan(1 / z)) - 0.5 * zz;

    Compute(&c, z);
    worst = SamLarger(worst, fabs(At(c.grid, c.s, SAM_STRESS_ZZ, n / 2, n / 2) - zz));
    worst = SamLarger(worst, fabs(At(c.grid, c.s, SAM_STRESS_XX, n / 2, n / 2) - rr));
    worst = SamLarger(worst, fabs(At(c.grid, c.s, SAM_STRESS_YY, n / 2, n / 2) - rr));
    worst = SamLarger(worst, fabs(At(c.grid, c.s, SAM_STRESS_XZ, n / 2, n / 2)));
  }
  DestroyCase(&c);
  return worst;
}

static void test_axis_is_that_of_hertz_to_second_order(void **state)
{
  const double coarse = AxisError(129), fine = AxisError(257);

  (void)state;
  if (getenv("SAM_SHOW")) print_message("# axis %g %g, 513: %g\n", coarse, fine, AxisError(513));
  sam_assert(fine < 1e-4);
  sam_assert(fine < coarse / 3);
}

/* Von Mises stress on the axis: |s_zz - s_rr|. */
static double AxisMises(double nu, double z)
{
  const double zz = -1 / (1 + z * z);

  return fabs(zz + (1 + nu) * (1 - z * atan(1 / z)) + 0.5 * zz);
}

/* The place of its largest value, by halving. */
static double LargestOnAxis(double nu)
{
  double low = 0.05, high = 1.5;

  for (int k = 0; k < 200; k++) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;

    if (AxisMises(nu, a) < AxisMises(nu, b))
      low = a;
    else
      high = b;
  }
  return 0.5 * (low + high);
}

static void test_largest_mises_stress_for_all_poisson_ratios(void **state)
{
  const double ratios[] = {0, 0.25, 0.3, 0.4, 0.5};

  (void)state;
  sam_assert_close(LargestOnAxis(0.3), 0.48086449, 1e-7);
  sam_assert_close(AxisMises(0.3, LargestOnAxis(0.3)), 0.6200410039, 1e-9);
  for (int n = 0; n < 5; n++) {
    Case         c    = NewCaseOf(NewGrid(129, 129, 2.6, 2.6), 2, ratios[n]);
    const double best = LargestOnAxis(ratios[n]), places[] = {0.93 * best, best, 1.07 * best};
    double       mises[3];

    SetHertz(&c, 0, 0);
    for (int k = 0; k < 3; k++) {
      double        s[COMPONENTS];
      const double *at[COMPONENTS];

      Compute(&c, places[k]);
      for (int i = 0; i < COMPONENTS; i++) {
        s[i]  = At(c.grid, c.s, (SamStressComponent)i, 64, 64);
        at[i] = &s[i];
      }
      SamStressMises(1, at, &mises[k]);
    }
    sam_assert_close(mises[1], AxisMises(ratios[n], best), 1e-4);
    sam_assert(mises[1] > mises[0] && mises[1] > mises[2]);
    DestroyCase(&c);
  }
}

/* Errors of xx, yy and xy on the surface inside 0.9 a, for sliding with friction mu or partial slip. */
static void SurfaceErrors(PetscInt n, double mu, double error[3])
{
  Case          c = NewHertz(n, mu, 0);
  const double *s;

  Compute(&c, 0);
  sam_call(VecGetArrayRead(c.s, &s));
  for (int k = 0; k < 3; k++) error[k] = 0;
  for (PetscInt j = 0; j < c.grid->rows; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt k = j * n + i;
      const double   x = SamGridX(c.grid, i), y = SamGridY(c.grid, c.grid->row_start + j), r2 = x * x + y * y,
                   root = sqrt(1 - fmin(1, r2)), B = (1 - 2 * NU) * (1 - root * root * root) / (3 * r2);
      const double rr = B - root, tt = -B - 2 * NU * root, cos2 = x * x / r2, sin2 = y * y / r2;

      if (r2 > 0.81) continue;
      error[0] = SamLarger(error[0], fabs(s[SAM_STRESS_XX * c.grid->cells + k] -
                                          (rr * cos2 + tt * sin2 - mu * PETSC_PI * (4 + NU) * x / 8)));
      error[1] = SamLarger(error[1], fabs(s[SAM_STRESS_YY * c.grid->cells + k] -
                                          (rr * sin2 + tt * cos2 - 3 * mu * PETSC_PI * NU * x / 8)));
      error[2] = SamLarger(error[2], fabs(s[SAM_STRESS_XY * c.grid->cells + k] -
                                          ((rr - tt) * x * y / r2 - mu * PETSC_PI * (2 - NU) * y / 8)));
    }
  sam_call(VecRestoreArrayRead(c.s, &s));
  sam_call(SamMax(c.grid->comm, 3, error));
  DestroyCase(&c);
}

static void test_surface_is_that_of_hertz_and_of_sliding(void **state)
{
  double coarse[3], fine[3];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SurfaceErrors(128, 0.5 * k, coarse);
    SurfaceErrors(256, 0.5 * k, fine);
    if (getenv("SAM_SHOW")) {
      double finest[3];

      SurfaceErrors(512, 0.5 * k, finest);
      print_message("# surface %g: %g %g %g, %g %g %g, 512: %g %g %g\n", 0.5 * k, coarse[0], coarse[1], coarse[2],
                    fine[0], fine[1], fine[2], finest[0], finest[1], finest[2]);
    }
    for (int m = 0; m < 3; m++) sam_assert(fine[m] < 1.5e-3);
  }
}

/* Points of closed solutions at depth, to ten digits: full sliding and Cattaneo and Mindlin's partial slip. */
static void test_points_at_depth(void **state)
{
  const double sliding[COMPONENTS] = {-0.3236455123, -0.2408470622, -0.8295718844,
                                      -0.0294629437, -0.2514954233, -0.0632167324};
  const double partial[COMPONENTS] = {0.0717798892, -0.0893512598, -0.1116251004, 0, 0.0570035538, 0};
  /* cells whose centres are at these points: 2.6/0.005 = 520, moved by half a cell */
  const double   width[] = {2.6, 2.6}, center[] = {0.0025, 0.0025};
  const PetscInt n[] = {520, 520};
  SamGrid        grid;
  Case           c;

  (void)state;
  sam_call(SamGridCreate(PETSC_COMM_WORLD, n, width, center, &grid));
  c = NewCase(grid, 2);
  SetHertz(&c, 0.5, 0);
  Compute(&c, 0.4);
  for (int k = 0; k < COMPONENTS; k++)
    sam_assert_close(At(c.grid, c.s, (SamStressComponent)k, 319, 299), sliding[k], 1e-4);
  SetHertz(&c, 0.5, 0.6);
  Compute(&c, 0.2);
  for (int k = 0; k < COMPONENTS; k++)
    sam_assert_close(At(c.grid, c.s, (SamStressComponent)k, 59, 259), partial[k], 1e-4);
  DestroyCase(&c);
}

/* In the stick zone the shear of partial slip leaves no stress in the plane of the surface. */
static void test_shear_leaves_the_stick_zone_free_of_plane_stress(void **state)
{
  Case     c = NewHertz(256, 0.5, 0.6);
  PetscInt n = 256;

  (void)state;
  sam_call(VecSet(c.p, 0));
  Compute(&c, 0);
  for (int k = 0; k < 5; k++) {
    const PetscInt i = n / 2 + 9 * k, j = n / 2 - 5 * k; /* r < 0.5 */

    sam_assert_close(At(c.grid, c.s, SAM_STRESS_XX, i, j), 0, 5e-3);
    sam_assert_close(At(c.grid, c.s, SAM_STRESS_YY, i, j), 0, 5e-3);
    sam_assert_close(At(c.grid, c.s, SAM_STRESS_XY, i, j), 0, 5e-3);
  }
  DestroyCase(&c);
}

/* ---- bodies ---- */

/* Body 1 seen from its inside is body 2 under the opposite shear. */
static void test_body_1_is_body_2_under_the_opposite_shear(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    Case one = NewCase(NewGrid(21, 17, 2.6, 2.1), 1), two = NewCase(NewGrid(21, 17, 2.6, 2.1), 2);

    SetHertz(&one, 0.4, 0.3);
    SetHertz(&two, -0.4, 0.3);
    Compute(&one, 0.1 * k);
    Compute(&two, 0.1 * k);
    sam_assert_close(Difference(one.s, two.s, NORM_INFINITY), 0, 0);
    DestroyCase(&one);
    DestroyCase(&two);
  }
}

static void test_surface_has_the_tractions_of_each_body(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    Case          c = NewCase(NewGrid(21, 17, 2.6, 2.1), body);
    const double *p, *q, *s;
    double        worst = 0;

    SetHertz(&c, 0.4, 0.3);
    Compute(&c, 0);
    sam_call(VecGetArrayRead(c.p, &p));
    sam_call(VecGetArrayRead(c.q, &q));
    sam_call(VecGetArrayRead(c.s, &s));
    for (PetscInt k = 0; k < c.grid->cells; k++) {
      worst = SamLarger(worst, fabs(s[SAM_STRESS_ZZ * c.grid->cells + k] + p[k]));
      worst = SamLarger(worst, fabs(s[SAM_STRESS_XZ * c.grid->cells + k] + (body == 1 ? -1 : 1) * q[k]));
      worst =
        SamLarger(worst, fabs(s[SAM_STRESS_YZ * c.grid->cells + k] + (body == 1 ? -1 : 1) * q[k + c.grid->cells]));
    }
    sam_call(VecRestoreArrayRead(c.s, &s));
    sam_call(VecRestoreArrayRead(c.q, &q));
    sam_call(VecRestoreArrayRead(c.p, &p));
    sam_assert_close(worst, 0, 0);
    DestroyCase(&c);
  }
}

static void test_wrong_arguments_are_refused(void **state)
{
  Case      c = NewCase(NewGrid(5, 4, 1, 1), 2);
  SamStress none;

  (void)state;
  sam_call(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  sam_assert(SamHalfSpaceCreateStress(c.grid, NULL, 3, 0.3, &none));
  sam_assert(SamHalfSpaceCreateStress(c.grid, NULL, 1, 0.51, &none));
  sam_assert(SamHalfSpaceCreateStress(c.grid, NULL, 1, -1, &none));
  sam_assert(SamStressApply(c.stress, c.s));
  sam_assert(SamStressSetDepth(c.stress, -1e-9));
  sam_assert(SamStressSetDepth(c.stress, NAN));
  sam_call(PetscPopErrorHandler());
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_stresses_are_sums_over_the_cells),
    cmocka_unit_test(test_axis_is_that_of_hertz_to_second_order),
    cmocka_unit_test(test_largest_mises_stress_for_all_poisson_ratios),
    cmocka_unit_test(test_surface_is_that_of_hertz_and_of_sliding),
    cmocka_unit_test(test_points_at_depth),
    cmocka_unit_test(test_shear_leaves_the_stick_zone_free_of_plane_stress),
    cmocka_unit_test(test_body_1_is_body_2_under_the_opposite_shear),
    cmocka_unit_test(test_surface_has_the_tractions_of_each_body),
    cmocka_unit_test(test_wrong_arguments_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

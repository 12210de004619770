/* The normal solver: Hertz's contact, force and displacement control, moments, scaling. */
#include "normals.h"
#include "methods/methods.h"
#include <petsam/private/elasticity.h>

/* ---- Hertz ---- */

static double RelativeToHertz(const Sphere *s, Vec p)
{
  Vec     hertz = NewField(s->grid, 1);
  double *a, error;

  sam_call(VecGetArray(hertz, &a));
  for (PetscInt j = 0; j < s->grid->rows; j++)
    for (PetscInt i = 0; i < s->grid->nx; i++)
      a[j * s->grid->nx + i] = Hertz(s, hypot(SamGridX(s->grid, i), SamGridY(s->grid, s->grid->row_start + j)));
  sam_call(VecRestoreArray(hertz, &a));
  error = Difference(p, hertz, NORM_2);
  sam_call(VecDestroy(&hertz));
  return error;
}

/* Errors of the pressure in the 2-norm and of the approach a^2/R, for both types. */
static void HertzErrors(PetscInt n, SamSolverType type, double *pressure, double *approach)
{
  Sphere     s       = NewSphere(n, 1.5, 0.3);
  SamBalance balance = Forced(s.N, 0, 0);
  Vec        p       = NewField(s.grid, 1);

  SolveWell(s.elasticity, s.h, type, 0, &balance, p);
  *pressure = RelativeToHertz(&s, p);
  *approach = fabs(balance.rigid[0] * s.R / (s.a * s.a) - 1);
  if (getenv("SAM_SHOW")) print_message("# hertz %s %d pressure %g approach %g\n", type, (int)n, *pressure, *approach);
  sam_assert_close(balance.load[0], s.N, 1e-12 * s.N); /* equilibrium holds to rounding of a sum */
  sam_assert_close(hypot(balance.load[1], balance.load[2]), 0, 1e-12 * s.N * s.a);
  sam_assert_close(hypot(balance.rigid[1], balance.rigid[2]), 0,
                   1e-6 * s.a / s.R); /* symmetric: the tolerance of the gap */
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

static void AssertHertz(SamSolverType type)
{
  double coarse[2], fine[2];

  HertzErrors(64, type, &coarse[0], &coarse[1]);
  HertzErrors(256, type, &fine[0], &fine[1]);
  /*
    The error is linear in the cell size, but it falls irregularly from one grid to the next, as the edge of the contact
    cuts its cells differently on each.
  */
  sam_assert(coarse[0] < 6e-3);
  sam_assert(fine[0] < 0.35 * coarse[0]);
  sam_assert(coarse[1] < 1e-3 && fine[1] < 5e-4);
}

static void test_hertz_pressure_and_approach(void **state)
{
  (void)state;
  AssertHertz(SAM_NORMAL_ACTIVESET);
}

static void test_hertz_pressure_and_approach_by_polonsky_and_keer(void **state)
{
  (void)state;
  AssertHertz(SAM_NORMAL_POLONSKYKEER);
}

static void test_iterations_do_not_grow_with_the_grid(void **state)
{
  (void)state;
  for (PetscInt n = 64; n <= 256; n *= 2) {
    Sphere     s       = NewSphere(n, 1.5, 0.3);
    SamBalance balance = Forced(s.N, 0, 0);
    Vec        p       = NewField(s.grid, 1);
    Outcome    o       = Solve(s.elasticity, s.h, NULL, 0, &balance, p);

    sam_assert(o.reason == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert(o.applies <= 20); /* 12 to 16 as a prototype measured up to 1024 */
    sam_call(VecDestroy(&p));
    DestroySphere(&s);
  }
}

/* ---- rough ---- */

/* A paraboloid with waves of pseudo-random phases and a few cells' length. */
static double Rough(double x, double y, const void *context)
{
  const Sphere *s = (const Sphere *)context;
  double        h = Paraboloid(x, y, &s->R);

  for (PetscInt k = 1; k <= 6; k++)
    for (PetscInt l = -6; l <= 6; l++)
      h += 0.02 * s->a * s->a / s->R * pow((double)(k * k + l * l), -0.8) * 8 *
           cos(PETSC_PI * ((double)k * x + (double)l * y) / (1.5 * s->a) + PETSC_PI * Random(5, 0, k, l));
  return h;
}

static void AssertTypesAgree(SamBalance balance, PetscInt n)
{
  Sphere     s     = NewSphere(n, 1.5, 0.3);
  SamBalance other = balance;
  Vec        p = NewField(s.grid, 1), q = NewField(s.grid, 1), h = NewFrom(s.grid, Rough, &s);
  double     least;

  for (PetscInt k = 0; k < 3; k++) {
    balance.load[k] *= k ? s.N * s.a : s.N;
    balance.rigid[k] *= k ? s.a / s.R : s.a * s.a / s.R;
  }
  other = balance;
  SolveWell(s.elasticity, h, SAM_NORMAL_ACTIVESET, 1e-10, &balance, p);
  SolveWell(s.elasticity, h, SAM_NORMAL_POLONSKYKEER, 1e-10, &other, q);
  sam_assert_close(Difference(p, q, NORM_2), 0, 1e-6); /* rtol times the condition, about n */
  for (PetscInt k = 0; k < 3; k++) {
    sam_assert_close(balance.rigid[k], other.rigid[k], 1e-6 * (k ? s.a / s.R : s.a * s.a / s.R));
    sam_assert_close(balance.load[k], other.load[k], 1e-6 * (k ? s.N * s.a : s.N));
  }
  sam_call(VecMin(p, NULL, &least));
  sam_assert(least == 0);
  sam_destroy(&p, &q, &h);
  DestroySphere(&s);
}

/* The largest of |gap| where there is pressure and of penetration elsewhere, over the largest displacement. */
static double GapError(SamElasticity elasticity, Vec h, const SamBalance *balance, Vec p)
{
  const double *a, *b;
  double        error = 0, most;
  Vec           gap   = Copy(p);
  PetscInt      n;

  sam_call(SamElasticityApplyNormal(elasticity, p, gap));
  most = Norm(gap, NORM_INFINITY);
  sam_call(VecAXPY(gap, 1, h));
  sam_call(VecShift(gap, -balance->rigid[0]));
  sam_call(VecGetLocalSize(p, &n));
  sam_call(VecGetArrayRead(p, &a));
  sam_call(VecGetArrayRead(gap, &b));
  for (PetscInt k = 0; k < n; k++) error = fmax(error, a[k] > 0 ? fabs(b[k]) : -b[k]);
  sam_call(VecRestoreArrayRead(gap, &b));
  sam_call(VecRestoreArrayRead(p, &a));
  (void)MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  sam_call(VecDestroy(&gap));
  return error / most;
}

/* What is solved is solved to the tolerance that was asked for, loose or tight, and seen without the solver. */
static void test_gap_is_closed_to_the_tolerance(void **state)
{
  const SamSolverType types[] = {SAM_NORMAL_ACTIVESET, SAM_NORMAL_POLONSKYKEER};
  Sphere              s       = NewSphere(60, 1.5, 0.3);
  Vec                 h = NewFrom(s.grid, Rough, &s), p = NewField(s.grid, 1);

  (void)state;
  for (int type = 0; type < 2; type++)
    for (double rtol = 1e-2; rtol > 1e-10; rtol *= 0.1) {
      const PetscReal approach[3] = {2 * s.a * s.a / s.R, 0, 0};
      SamBalance      balance     = Displaced(approach);

      SolveWell(s.elasticity, h, types[type], rtol, &balance, p);
      sam_assert_close(GapError(s.elasticity, h, &balance, p), 0, 1.01 * rtol);
    }
  sam_destroy(&h, &p);
  DestroySphere(&s);
}

static void test_both_types_agree_on_a_rough_gap(void **state)
{
  (void)state;
  AssertTypesAgree(Forced(0.6, 0, 0), 61);
  AssertTypesAgree(Forced(0.6, 0.1, -0.2), 48);
}

static void test_both_types_agree_under_displacement_and_mixed_control(void **state)
{
  const PetscReal rigid[3] = {0.8, 0.1, -0.05};
  SamBalance      mixed    = Displaced(rigid);

  (void)state;
  AssertTypesAgree(mixed, 45);
  mixed.force[0] = PETSC_TRUE;
  mixed.load[0]  = 0.5;
  AssertTypesAgree(mixed, 45);
  mixed.force[2] = PETSC_TRUE;
  mixed.load[2]  = 0.05;
  AssertTypesAgree(mixed, 45);
  mixed.force[0] = PETSC_FALSE; /* a given approach and a moment */
  AssertTypesAgree(mixed, 45);
}

/* ---- control ---- */

/* The displacements that a load gives bring the load back, and the same pressure; component by component. */
static void test_force_and_displacement_control_agree(void **state)
{
  Sphere     s     = NewSphere(49, 1.5, 0.3);
  SamBalance given = Forced(s.N, 0.05 * s.N * s.a, -0.1 * s.N * s.a), found;
  Vec        p = NewField(s.grid, 1), q = NewField(s.grid, 1), h = NewFrom(s.grid, Rough, &s);

  (void)state;
  found = given;
  SolveWell(s.elasticity, h, NULL, 1e-10, &found, p);
  for (int mask = 0; mask < 7; mask++) { /* bit k: component k stays under force control */
    SamBalance mixed = found;

    for (int k = 0; k < 3; k++) {
      mixed.force[k] = mask & (1 << k) ? PETSC_TRUE : PETSC_FALSE;
      if (mixed.force[k])
        mixed.rigid[k] = NAN; /* what is a result must not be read */
      else
        mixed.load[k] = NAN;
    }
    SolveWell(s.elasticity, h, NULL, 1e-10, &mixed, q);
    sam_assert_close(Difference(q, p, NORM_2), 0, 1e-6); /* rtol times the condition, about n, twice */
    for (int k = 0; k < 3; k++) {
      sam_assert_close(mixed.load[k], given.load[k], 1e-6 * (k ? s.N * s.a : s.N));
      sam_assert_close(mixed.rigid[k], found.rigid[k], 1e-6 * (k ? s.a / s.R : s.a * s.a / s.R));
    }
  }
  sam_destroy(&p, &q, &h);
  DestroySphere(&s);
}

/* A solution as a start is found to be one. */
static void test_start_from_the_solution_ends_at_once(void **state)
{
  Sphere     s       = NewSphere(40, 1.5, 0.3);
  SamBalance balance = Forced(s.N, 0, 0);
  Vec        p = NewField(s.grid, 1), q = NewField(s.grid, 1);
  SamNormal  normal;
  PetscInt   applies;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
  sam_call(VecCopy(p, q));
  sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_TRUE, q));
  sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), NULL, NULL, &applies, NULL));
  sam_assert(applies <= 3);
  sam_assert_close(Difference(q, p, NORM_2), 0, 1e-6);
  sam_call(SamNormalDestroy(&normal));
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

/* ---- windows ---- */

/* A needle far from the contact, one cell wide, is not seen by the coarser grids, whose heights are averages. */
static void test_contact_outside_the_window_is_found(void **state)
{
  Sphere         s = NewSphere(96, 3, 0.3);
  const PetscInt i = 88, j = 47;
  SamBalance     balance = Forced(s.N, 0, 0), other = balance;
  Vec            p = NewField(s.grid, 1), q = NewField(s.grid, 1), alone = NewField(s.grid, 1);
  PetscReal      needle;

  (void)state;
  AddAt(s.grid, 0, i, j, -4 * s.a * s.a / s.R, s.h); /* the gap of the sphere is about 2.5 a^2/R there */
  SolveWell(s.elasticity, s.h, SAM_NORMAL_ACTIVESET, 0, &balance, p);
  SolveWell(s.elasticity, s.h, SAM_NORMAL_POLONSKYKEER, 0, &other, q);
  sam_assert_close(Difference(p, q, NORM_2), 0, 1e-6);
  AddAt(s.grid, 0, i, j, 1, alone);
  sam_call(VecPointwiseMult(alone, alone, p));
  sam_call(VecNorm(alone, NORM_INFINITY, &needle));
  sam_assert(needle > 0);
  sam_destroy(&alone, &q, &p);
  DestroySphere(&s);
}

/* From the solution of a sixtieth of the load, on a window of a sixteenth of the area. */
static void test_contact_grows_beyond_the_window_of_its_start(void **state)
{
  Sphere     s     = NewSphere(96, 1.5, 0.3);
  SamBalance small = Forced(s.N / 64, 0, 0), balance = Forced(s.N, 0, 0), again = balance;
  Vec        p = NewField(s.grid, 1), q = NewField(s.grid, 1);
  SamNormal  normal;
  PetscInt   first[2], before[2], after[2];

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamNormalSolve(normal, s.h, &small, PETSC_FALSE, p));
  sam_call(SamElasticityGetPartPlace(s.elasticity, first, before));
  sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_TRUE, p));
  sam_call(SamElasticityGetPartPlace(s.elasticity, first, after));
  sam_assert(before[0] > 0 && (after[0] == 0 || after[0] > 2 * before[0]));
  sam_call(SamNormalSolve(normal, s.h, &again, PETSC_FALSE, q));
  sam_assert_close(Difference(p, q, NORM_2), 0, 1e-6);
  sam_call(SamNormalDestroy(&normal));
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

/* ---- moments, places, units ---- */

/*
  A paraboloid that is turned is a paraboloid that is shifted: a moment moves the pressure, by (My, -Mx)/N. A whole
  number of cells makes that exact on the grid.
*/
static void test_moments_shift_the_pressure_of_a_paraboloid(void **state)
{
  const PetscInt shift_x = 5, shift_y = -3;
  Sphere         s       = NewSphere(48, 1.8, 0.3);
  SamBalance     centred = Forced(s.N, 0, 0),
             moved       = Forced(s.N, -s.N * (double)shift_y * s.grid->dy, s.N * (double)shift_x * s.grid->dx);
  Vec     p = NewField(s.grid, 1), q = NewField(s.grid, 1);
  double *from, *to;

  (void)state;
  SolveWell(s.elasticity, s.h, NULL, 1e-10, &centred, p);
  SolveWell(s.elasticity, s.h, NULL, 1e-10, &moved, q);
  from = Whole(s.grid, 1, p);
  to   = (double *)calloc(48 * 48, sizeof(*to));
  for (PetscInt j = 0; j < 48; j++)
    for (PetscInt i = 0; i < 48; i++) {
      const PetscInt k = i - shift_x, l = j - shift_y;

      if (k >= 0 && k < 48 && l >= 0 && l < 48) to[j * 48 + i] = from[l * 48 + k];
    }
  SetWhole(s.grid, 1, to, p);
  sam_assert_close(Difference(q, p, NORM_2), 0, 1e-6); /* rtol times the condition, about n */
  /* h shifted: the turn is the slope -x0/R, so d_z - y r_x + x r_y = (x x0 + y y0)/R - (x0^2 + y0^2)/2R + d */
  sam_assert_close(moved.rigid[2], (double)shift_x * s.grid->dx / s.R, 1e-7 * s.a / s.R);
  sam_assert_close(moved.rigid[1], -(double)shift_y * s.grid->dy / s.R, 1e-7 * s.a / s.R);
  free(from);
  free(to);
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

/* A grid that lies elsewhere, with the body, has the same answer. */
static void test_place_of_the_grid_does_not_matter(void **state)
{
  const double  x = 0.7, y = -1.3;
  Sphere        s       = NewSphere(40, 1.5, 0.3);
  SamGrid       away    = NewGridOn(PETSC_COMM_WORLD, 40, 40, s.grid->width[0], s.grid->width[1], x, y);
  SamBalance    balance = Forced(s.N, 0, 0.1 * s.N * s.a), moved = Forced(s.N, -s.N * y, s.N * (x + 0.1 * s.a));
  SamElasticity elasticity;
  Vec           p = NewField(s.grid, 1), q = NewField(away, 1);

  (void)state;
  sam_call(SamElasticityCreate(away, s.pair, &elasticity));
  SolveWell(s.elasticity, s.h, NULL, 1e-9, &balance, p);
  SolveWell(elasticity, s.h, NULL, 1e-9, &moved, q);
  sam_assert_close(Difference(q, p, NORM_2), 0,
                   1e-6); /* rtol times the condition; the lever is known to 1e-16 m of 1e-3 m */
  sam_destroy(&p, &q);
  sam_call(SamElasticityDestroy(&elasticity));
  sam_call(SamGridDestroy(&away));
  DestroySphere(&s);
}

/* Eight times the load on the same sphere: the contact and the pressure double, the approach is four times as large. */
static void test_eight_times_the_load_doubles_sphere_contact_and_pressure(void **state)
{
  Sphere     small = NewSphere(41, 1.5, 0.3), large = NewSphere(41, 3, 0.3);
  SamBalance one = Forced(small.N, 0, 0), eight = Forced(8 * small.N, 0, 0);
  Vec        p = NewField(small.grid, 1), q = NewField(large.grid, 1);

  (void)state;
  SolveWell(small.elasticity, small.h, NULL, 0, &one, p);
  SolveWell(large.elasticity, large.h, NULL, 0, &eight, q);
  sam_call(VecScale(p, 2));
  sam_assert_close(Difference(q, p, NORM_INFINITY), 0,
                   1e-7); /* all numbers are scaled: the same iterations, but for rounding */
  sam_assert_close(eight.rigid[0], 4 * one.rigid[0], 1e-9 * eight.rigid[0]);
  sam_destroy(&p, &q);
  DestroySphere(&small);
  DestroySphere(&large);
}

/* The stiffness of bodies and the load scale together, over many orders of magnitude. */
static void test_units_do_not_matter(void **state)
{
  const double factor[] = {1e-12, 1e12};
  Sphere       s        = NewSphere(40, 1.5, 0.3);
  SamBalance   balance  = Forced(s.N, 0, 0);
  Vec          p = NewField(s.grid, 1), q = NewField(s.grid, 1);

  (void)state;
  SolveWell(s.elasticity, s.h, NULL, 0, &balance, p);
  for (int k = 0; k < 2; k++) {
    SamPair       pair   = NewPair(210e9 * factor[k], 0.3, 210e9 * factor[k], 0.3);
    SamBalance    scaled = Forced(s.N * factor[k], 0, 0);
    SamElasticity elasticity;

    sam_call(SamElasticityCreate(s.grid, pair, &elasticity));
    SolveWell(elasticity, s.h, NULL, 0, &scaled, q);
    sam_call(VecScale(q, 1 / factor[k]));
    sam_assert_close(Difference(q, p, NORM_INFINITY), 0, 1e-7); /* as above */
    sam_call(SamElasticityDestroy(&elasticity));
  }
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_hertz_pressure_and_approach),
    cmocka_unit_test(test_hertz_pressure_and_approach_by_polonsky_and_keer),
    cmocka_unit_test(test_iterations_do_not_grow_with_the_grid),
    cmocka_unit_test(test_gap_is_closed_to_the_tolerance),
    cmocka_unit_test(test_both_types_agree_on_a_rough_gap),
    cmocka_unit_test(test_both_types_agree_under_displacement_and_mixed_control),
    cmocka_unit_test(test_force_and_displacement_control_agree),
    cmocka_unit_test(test_start_from_the_solution_ends_at_once),
    cmocka_unit_test(test_contact_outside_the_window_is_found),
    cmocka_unit_test(test_contact_grows_beyond_the_window_of_its_start),
    cmocka_unit_test(test_moments_shift_the_pressure_of_a_paraboloid),
    cmocka_unit_test(test_place_of_the_grid_does_not_matter),
    cmocka_unit_test(test_eight_times_the_load_doubles_sphere_contact_and_pressure),
    cmocka_unit_test(test_units_do_not_matter),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

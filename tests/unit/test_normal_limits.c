/* The normal solver where there is no contact, no solution, or contact everywhere; iterations and monitors. */
#include "normals.h"
#include "methods/methods.h"

/* ---- no contact, no solution ---- */

static void test_bodies_without_load_or_overlap_are_separated(void **state)
{
  Sphere          s        = NewSphere(33, 1.5, 0.3);
  const PetscReal apart[3] = {-1e-6, 0, 0};
  SamBalance      cases[3] = {Forced(0, 0, 0), Displaced(apart), Displaced(apart)};
  Vec             p        = NewField(s.grid, 1);

  (void)state;
  cases[2].force[1] = cases[2].force[2] = PETSC_TRUE; /* no moments on what does not touch */
  for (int k = 0; k < 3; k++) {
    sam_call(VecSet(p, 1));
    sam_assert(Solve(s.elasticity, s.h, NULL, 0, &cases[k], p).reason == SAM_SOLVER_CONVERGED_TRIVIAL);
    sam_assert(Norm(p, NORM_INFINITY) == 0);
    sam_assert(cases[k].load[0] == 0 && cases[k].load[1] == 0 && cases[k].load[2] == 0);
  }
  sam_assert(cases[1].rigid[0] == -1e-6);
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

/* Where shapes overlap as they are given, bodies without load move apart until they just touch. */
static void test_overlapping_bodies_without_load_move_apart(void **state)
{
  Sphere     s       = NewSphere(33, 1.5, 0.3);
  SamBalance balance = Forced(0, 0, 0);
  Vec        p       = NewField(s.grid, 1);

  (void)state;
  sam_call(VecShift(s.h, -2e-6));
  sam_assert(Solve(s.elasticity, s.h, NULL, 0, &balance, p).reason == SAM_SOLVER_CONVERGED_TRIVIAL);
  sam_assert(Norm(p, NORM_INFINITY) == 0);
  sam_assert_close(balance.rigid[0], -2e-6, 1e-20);
  sam_call(VecShift(s.h, 3e-6));
  sam_assert(Solve(s.elasticity, s.h, NULL, 0, &balance, p).reason == SAM_SOLVER_CONVERGED_TRIVIAL);
  sam_assert(balance.rigid[0] == 0);
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

/* What marks a hole in a measured surface may be a height without bounds. */
static double Hole(double x, double y, const void *context)
{
  const double *radius_depth = (const double *)context;

  return hypot(x, y) < 0.2 * radius_depth[2] ? radius_depth[1] : Paraboloid(x, y, radius_depth);
}

static void test_hole_may_have_any_depth(void **state)
{
  Sphere     s       = NewSphere(33, 1.5, 0.3);
  SamBalance balance = Forced(s.N, 0, 0);
  Vec        p[2]    = {NewField(s.grid, 1), NewField(s.grid, 1)};
  double     depth[] = {1, 1e30, 1e300};

  (void)state;
  for (int k = 0; k < 3; k++) {
    Vec h = NewFrom(s.grid, Hole, (const double[]){s.R, depth[k], s.a});

    SolveWell(s.elasticity, h, NULL, 0, &balance, p[k > 0]);
    if (k) sam_assert_close(Difference(p[1], p[0], NORM_2), 0, 1e-6);
    sam_call(VecDestroy(&h));
  }
  sam_destroy(&p[0], &p[1]);
  DestroySphere(&s);
}

static void test_moment_beyond_the_grid_has_no_equilibrium(void **state)
{
  Sphere     s        = NewSphere(33, 1.5, 0.3);
  SamBalance cases[4] = {Forced(s.N, 0, 1.6 * s.N * s.a), Forced(s.N, -1.6 * s.N * s.a, 0), Forced(0, 0, 1),
                         Forced(s.N, 0, -1.49 * s.N * s.a)};
  Vec        p        = NewField(s.grid, 1);

  (void)state;
  for (int k = 0; k < 4; k++)
    sam_assert(Solve(s.elasticity, s.h, NULL, 0, &cases[k], p).reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

static void test_tension_is_refused(void **state)
{
  Sphere     s       = NewSphere(16, 1.5, 0.3);
  SamBalance balance = Forced(-s.N, 0, 0);
  Vec        p       = NewField(s.grid, 1);
  SamNormal  normal;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_fails(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p), SAM_ERR_USER);
  sam_call(SamNormalDestroy(&normal));
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

static void test_too_few_iterations_are_a_reason_not_an_error(void **state)
{
  Sphere          s       = NewSphere(33, 1.5, 0.3);
  SamBalance      balance = Forced(s.N, 0, 0);
  Vec             p       = NewField(s.grid, 1);
  SamNormal       normal;
  SamSolverReason reason;

  (void)state;
  for (int k = 0; k < 2; k++) {
    sam_call(SamNormalCreate(s.elasticity, &normal));
    sam_call(SamSolverSetType(SamNormalAsSolver(normal), k ? SAM_NORMAL_POLONSKYKEER : SAM_NORMAL_ACTIVESET));
    sam_call(SamSolverSetTolerances(SamNormalAsSolver(normal), PETSC_DEFAULT, 2));
    sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
    reason = SamSolverGetReason(SamNormalAsSolver(normal));
    sam_assert(reason == SAM_SOLVER_DIVERGED_ITS);
    sam_call(SamNormalDestroy(&normal));
  }
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

static void test_nan_in_the_separation_is_reported(void **state)
{
  Sphere     s       = NewSphere(33, 1.5, 0.3);
  SamBalance balance = Forced(s.N, 0, 0), other = balance;
  Vec        p = NewField(s.grid, 1);

  (void)state;
  AddAt(s.grid, 0, 16, 16, NAN, s.h);
  sam_assert(Solve(s.elasticity, s.h, SAM_NORMAL_ACTIVESET, 0, &balance, p).reason < 0);
  sam_assert(Solve(s.elasticity, s.h, SAM_NORMAL_POLONSKYKEER, 0, &other, p).reason < 0);
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

/* Contact everywhere, also where more ranks than rows leave some without work: a flat body under uniform pressure. */
static void test_flat_body_touches_everywhere_on_any_grid(void **state)
{
  const PetscInt n[][2] = {{2, 2}, {33, 2}, {2, 7}, {40, 33}};

  (void)state;
  for (int k = 0; k < 4; k++) {
    SamGrid       grid    = NewGrid(n[k][0], n[k][1], 1e-3, 2e-3);
    SamPair       pair    = NewPair(70e9, 0.3, INFINITY, 0);
    SamBalance    balance = Forced(10, 0, 0);
    Vec           p = NewField(grid, 1), u = NewField(grid, 1), h = NewField(grid, 1);
    SamElasticity elasticity;
    PetscReal     least, most;

    sam_call(SamElasticityCreate(grid, pair, &elasticity));
    SolveWell(elasticity, h, NULL, 1e-10, &balance, p);
    sam_call(VecMin(p, NULL, &least));
    sam_assert(least > 0);
    sam_call(SamElasticityApplyNormal(elasticity, p, u));
    sam_call(VecMin(u, NULL, &least));
    sam_call(VecMax(u, NULL, &most));
    sam_assert_close(least, balance.rigid[0], 2e-10 * most); /* the tolerance asked for */
    sam_assert_close(most, balance.rigid[0], 2e-10 * most);
    sam_destroy(&p, &u, &h);
    sam_call(SamElasticityDestroy(&elasticity));
    sam_call(SamGridDestroy(&grid));
  }
}

static PetscErrorCode Remember(SamSolver normal, PetscInt it, PetscReal error, void *context)
{
  double *seen = (double *)context;

  (void)normal;
  seen[0] += 1;
  seen[1] = (double)it;
  seen[2] = error;
  return 0;
}

static void test_monitors_add_up_and_see_every_iteration(void **state)
{
  Sphere     s          = NewSphere(33, 1.5, 0.3);
  SamBalance balance    = Forced(s.N, 0, 0);
  Vec        p          = NewField(s.grid, 1);
  double     seen[2][3] = {{0}};
  SamNormal  normal;
  PetscInt   its;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamSolverMonitorSet(SamNormalAsSolver(normal), Remember, seen[0]));
  sam_call(SamSolverMonitorSet(SamNormalAsSolver(normal), Remember, seen[1]));
  sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
  sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), NULL, &its, NULL, NULL));
  for (int k = 0; k < 2; k++) sam_assert(seen[k][0] == its && seen[k][1] == its && seen[k][2] <= 1e-8);
  sam_call(SamNormalDestroy(&normal));
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_bodies_without_load_or_overlap_are_separated),
    cmocka_unit_test(test_overlapping_bodies_without_load_move_apart),
    cmocka_unit_test(test_hole_may_have_any_depth),
    cmocka_unit_test(test_moment_beyond_the_grid_has_no_equilibrium),
    cmocka_unit_test(test_tension_is_refused),
    cmocka_unit_test(test_too_few_iterations_are_a_reason_not_an_error),
    cmocka_unit_test(test_nan_in_the_separation_is_reported),
    cmocka_unit_test(test_flat_body_touches_everywhere_on_any_grid),
    cmocka_unit_test(test_monitors_add_up_and_see_every_iteration),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

/* The tangential solver at and beyond the limit of friction, and with what is no number. */
#include "tangentials.h"
#include "methods/methods.h"
#include <petsam/private/solver.h>

#include <unistd.h>

/* ---- limits ---- */

static void test_load_beyond_friction_is_gross_slip_with_its_limit(void **state)
{
  const double beyond[] = {1 + 1e-6, 1.01, 5, 1e3, 1e8, 1e30};
  Case         c        = NewCase(33, 0.3);
  Vec          q        = NewField(c.s.grid, 2);

  (void)state;
  for (int k = 0; k < 6; k++)
    for (int direction = 0; direction < 2; direction++) {
      SamBalance balance = direction ? Loaded(&c, 0, -beyond[k], 0) : Loaded(&c, 0.6 * beyond[k], 0.8 * beyond[k], 0);
      Outcome    o       = Solve(&c, c.bound, NULL, NULL, 0, &balance, q);

      sam_assert(o.reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
      sam_assert_close(o.limit * beyond[k], 1, 1e-8); /* the smoothing in the limit's minimization */
    }
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

/* Balanced by sliding everywhere, at no definite displacement. */
static void test_load_at_the_limit_of_friction_is_gross_slip(void **state)
{
  Case       c       = NewCase(33, 0.3);
  SamBalance balance = Loaded(&c, 1, 0, 0);
  Vec        q       = NewField(c.s.grid, 2);
  Outcome    o       = Solve(&c, c.bound, NULL, NULL, 0, &balance, q);

  (void)state;
  sam_assert(o.reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
  sam_assert_close(o.limit, 1, 1e-8);
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

static void test_load_just_below_friction_is_balanced(void **state)
{
  Case c = NewCase(33, 0.3);
  Vec  q = NewField(c.s.grid, 2);

  (void)state;
  for (int k = 0; k < 2; k++) {
    const SamBalance given   = k ? Loaded(&c, 0, 0, 0.99) : Loaded(&c, 0.999, 0, 0);
    SamBalance       balance = given;

    SolveWell(&c, NULL, NULL, 0, &balance, q);
    AssertConditions(&c, NULL, &balance, &given, q);
  }
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

/* Nearly all cells slip: it is their stiffness that the motion and the directions have to respect. */
static void AssertFewProducts(PetscInt levels)
{
  const double level[] = {0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999};
  Case         c       = NewCase(129, 0.3);
  Vec          q       = NewField(c.s.grid, 2);

  for (int load = 0; load < 3; load++)
    for (int k = 0; k < 6; k++) {
      SamBalance    full = Loaded(&c, load == 1 ? 0 : 1, load == 2 ? 0.6 : 0, load == 0 ? 0.8 : 1), given;
      SamTangential t;
      PetscReal     limit;
      PetscInt      products;

      sam_call(SamBalanceSlideLimit(c.s.grid, &full, c.bound, &limit, NULL));
      for (int n = 0; n < 3; n++) full.load[n] *= limit * level[k];
      given = full;
      sam_call(SamTangentialCreate(c.s.elasticity, &t));
      sam_call(SamSolverSetLevels(SamTangentialAsSolver(t), levels));
      sam_call(SamTangentialSolve(t, c.bound, NULL, &full, PETSC_FALSE, q));
      sam_call(SamSolverGetStatistics(SamTangentialAsSolver(t), NULL, NULL, &products, NULL));
      if (getenv("SAM_SHOW")) print_message("# load %d, %g of the limit: %d products\n", load, level[k], (int)products);
      sam_assert(products <= 20);
      AssertConditions(&c, NULL, &full, &given, q);
      sam_call(SamTangentialDestroy(&t));
    }
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

static void test_near_sliding_few_products_are_needed(void **state)
{
  (void)state;
  AssertFewProducts(0);
}

static void test_near_sliding_few_products_are_needed_on_one_grid(void **state)
{
  (void)state;
  AssertFewProducts(1);
}

static void test_large_displacement_slides_everywhere(void **state)
{
  Case          c       = NewCase(33, 0);
  SamBalance    balance = {.kind  = SAM_BALANCE_TANGENTIAL,
                           .rigid = {1e-3, 0, 0}}; /* the contact sticks up to some 1e-6 m */
  Vec           q       = NewField(c.s.grid, 2);
  const double *b, *t;
  double        error = 0;

  (void)state;
  SolveWell(&c, NULL, NULL, 0, &balance, q);
  sam_call(VecGetArrayRead(c.bound, &b));
  sam_call(VecGetArrayRead(q, &t));
  for (PetscInt k = 0; k < c.s.grid->cells; k++) error = fmax(error, fabs(hypot(t[k], t[k + c.s.grid->cells]) - b[k]));
  sam_call(VecRestoreArrayRead(q, &t));
  sam_call(VecRestoreArrayRead(c.bound, &b));
  sam_assert_close(error, 0, 1e-12 * Norm(c.bound, NORM_INFINITY)); /* rounding: all lie on their circles */
  sam_assert_close(balance.load[0], c.T, 1e-6 * c.T);               /* at nu = 0 all shear is along x */
  sam_assert_close(balance.load[1], 0, 1e-6 * c.T);
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

static void test_without_friction_only_no_load_is_balanced(void **state)
{
  Case       c    = NewCase(33, 0.3);
  SamBalance none = Loaded(&c, 0, 0, 0), load = Loaded(&c, 0, 0.1, 0),
             moved = {.kind = SAM_BALANCE_TANGENTIAL, .rigid = {1e-6, 0, 0}};
  Vec     q = NewField(c.s.grid, 2), zero = NewField(c.s.grid, 1);
  Outcome o;

  (void)state;
  sam_assert(Solve(&c, zero, NULL, NULL, 0, &none, q).reason == SAM_SOLVER_CONVERGED_TRIVIAL &&
             Norm(q, NORM_INFINITY) == 0);
  sam_assert(Solve(&c, zero, NULL, NULL, 0, &moved, q).reason == SAM_SOLVER_CONVERGED_TRIVIAL &&
             Norm(q, NORM_INFINITY) == 0);
  sam_assert(moved.load[0] == 0 && moved.rigid[0] == 1e-6);
  o = Solve(&c, zero, NULL, NULL, 0, &load, q);
  sam_assert(o.reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM && o.limit == 0);
  sam_assert(Solve(&c, c.bound, NULL, NULL, 0, &none, q).reason == SAM_SOLVER_CONVERGED_TRIVIAL &&
             Norm(q, NORM_INFINITY) == 0);
  sam_destroy(&q, &zero);
  DestroyCase(&c);
}

static void AssertNanIsReported(SamSolverType type)
{
  Case       c = NewCase(33, 0.3);
  Vec        q = NewField(c.s.grid, 2), offset = NewField(c.s.grid, 2);
  SamBalance balance = Loaded(&c, 0.5, 0, 0);

  AddAt(c.s.grid, 1, 16, 16, NAN, offset);
  sam_assert(Solve(&c, c.bound, offset, type, 0, &balance, q).reason < 0);
  sam_destroy(&q, &offset);
  DestroyCase(&c);
}

static void test_nan_in_the_offset_is_reported(void **state)
{
  (void)state;
  AssertNanIsReported(SAM_TANGENTIAL_NEWTON);
}

static void test_nan_in_the_offset_is_reported_by_the_gradient_type(void **state)
{
  (void)state;
  (void)alarm(20); /* a search for a step length that never ends is a failure as well */
  AssertNanIsReported(SAM_TANGENTIAL_GRADIENT);
  (void)alarm(0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_load_at_the_limit_of_friction_is_gross_slip),
    cmocka_unit_test(test_load_beyond_friction_is_gross_slip_with_its_limit),
    cmocka_unit_test(test_load_just_below_friction_is_balanced),
    cmocka_unit_test(test_near_sliding_few_products_are_needed),
    cmocka_unit_test(test_near_sliding_few_products_are_needed_on_one_grid),
    cmocka_unit_test(test_large_displacement_slides_everywhere),
    cmocka_unit_test(test_without_friction_only_no_load_is_balanced),
    cmocka_unit_test(test_nan_in_the_offset_is_reported),
    cmocka_unit_test(test_nan_in_the_offset_is_reported_by_the_gradient_type),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Sums over the steps of a contact, the largest slip, spots and the mean gap: against what the fields of each step say.
 */
#include "contacts.h"

#include <petsam/private/baseimpl.h>

#include <math.h>

#define STEPS 4

static SamControl Turn(const Case *c, int step)
{
  static const double x[STEPS] = {0.3, 0.8, -0.2, -0.7}, n[STEPS] = {1, 1.2, 1.2, 0.9};

  return Loads(c, n[step], x[step], 0.1 * step, 0);
}

static void test_sums_are_those_of_the_committed_steps_and_the_tried_one(void **state)
{
  Case c    = NewCase(Steel(), 37, 1.5, MU, "");
  Vec  path = NewField(c.s.grid, 1), work = NewField(c.s.grid, 1),
      step[2] = {NewField(c.s.grid, 1), NewField(c.s.grid, 1)};
  Vec sum     = NewField(c.s.grid, 1), none;

  (void)state;
  sam_call(SamContactKeepSum(c.contact, SAM_CONTACT_SLIP_PATH));
  sam_call(SamContactKeepSum(c.contact, SAM_CONTACT_FRICTION_ENERGY));
  for (int k = 0; k < STEPS; k++) {
    const SamControl control = Turn(&c, k), other = Loads(&c, 1.1, 0.5, 0.5, 0);

    (void)Try(&c, &other); /* is forgotten */
    (void)Try(&c, &control);
    sam_call(SamContactComputeFriction(c.contact, step[0], NULL, step[1]));
    sam_call(VecAXPY(path, 1, step[0]));
    sam_call(VecAXPY(work, 1, step[1]));
    for (int committed = 0; committed < 2; committed++) {
      sam_call(SamContactComputeSum(c.contact, SAM_CONTACT_SLIP_PATH, sum));
      sam_assert(Difference(sum, path, NORM_INFINITY) <= 1e-14);
      sam_call(SamContactComputeSum(c.contact, SAM_CONTACT_FRICTION_ENERGY, sum));
      sam_assert(Difference(sum, work, NORM_INFINITY) <= 1e-14);
      if (!committed) sam_call(SamContactCommit(c.contact));
    }
  }
  sam_assert(Norm(path, NORM_INFINITY) > 0 && Norm(work, NORM_INFINITY) > 0);
  DestroyCase(&c);
  c = NewCase(Steel(), 37, 1.5, MU, "-sum_slip_path");
  sam_call(SamContactGetSum(c.contact, SAM_CONTACT_FRICTION_ENERGY, &none));
  sam_assert(!none);
  sam_fails(SamContactComputeSum(c.contact, SAM_CONTACT_FRICTION_ENERGY, work), PETSC_ERR_ORDER);
  sam_call(SamContactComputeSum(c.contact, SAM_CONTACT_SLIP_PATH, path));
  DestroyCase(&c);
  for (int k = 0; k < 2; k++) sam_call(VecDestroy(&step[k]));
  sam_call(VecDestroy(&path));
  sam_call(VecDestroy(&work));
  sam_call(VecDestroy(&sum));
}

static void test_sums_go_with_the_state(void **state)
{
  Case            one = NewCase(Steel(), 37, 1.5, MU, "-sum_slip_path"), other = NewCase(Steel(), 37, 1.5, MU, "");
  SamContactState held;
  Vec             a, b;

  (void)state;
  for (int k = 0; k < STEPS; k++) {
    const SamControl control = Turn(&one, k);

    (void)Solve(&one, &control);
    sam_call(SamContactGetState(one.contact, &held));
    sam_assert(held.sums[SAM_CONTACT_SLIP_PATH] && !held.sums[SAM_CONTACT_FRICTION_ENERGY]);
    if (k != 1) continue;
    sam_call(SamContactSetState(other.contact, &held));
  }
  for (int k = 2; k < STEPS; k++) {
    const SamControl control = Turn(&one, k);

    (void)Solve(&other, &control);
  }
  sam_call(SamContactGetSum(one.contact, SAM_CONTACT_SLIP_PATH, &a));
  sam_call(SamContactGetSum(other.contact, SAM_CONTACT_SLIP_PATH, &b));
  sam_assert(SameBits(a, b));
  held.sums[SAM_CONTACT_SLIP_PATH] = NULL; /* a state that has none: from 0 */
  sam_call(SamContactSetState(other.contact, &held));
  sam_assert(Norm(b, NORM_INFINITY) == 0);
  DestroyCase(&one);
  DestroyCase(&other);
}

/* A sphere is one spot, on any number of ranks; its numbers are those of the fields. */
static void test_numbers_are_those_of_the_fields(void **state)
{
  Case          c       = NewCase(Steel(), 37, 1.5, MU, "-contact_spots");
  double        most[1] = {0}, sum;
  SamControl    control = Turn(&c, 1);
  SamStep       step    = Solve(&c, &control);
  Vec           slip = NewSlip(&c), gap = NewGap(&c);
  const double *s, *p, *g;
  SamTotal      total = {0};

  (void)state;
  sam_call(VecGetArrayRead(slip, &s));
  sam_call(VecGetArrayRead(gap, &g));
  sam_call(VecGetArrayRead(SolutionOf(&c)->pressure, &p));
  for (PetscInt k = 0; k < c.s.grid->cells; k++) {
    if (p[k] > 0) most[0] = PetscMax(most[0], hypot(s[k], s[k + c.s.grid->cells]));
    SamAdd(&total, g[k]);
  }
  sam_call(VecRestoreArrayRead(SolutionOf(&c)->pressure, &p));
  sam_call(VecRestoreArrayRead(gap, &g));
  sam_call(VecRestoreArrayRead(slip, &s));
  sam_call(SamMax(PETSC_COMM_WORLD, 1, most));
  sam_call(SamSumTotals(PETSC_COMM_WORLD, 1, &total, &sum));
  sam_assert(step.spots == 1 && most[0] > 0);
  sam_assert_close(step.slip_max, most[0], 1e-13 * most[0]);
  sam_assert_close(step.gap_mean, sum / (37 * 37), 1e-13 * sum);
  sam_assert_close(step.contact_fraction, step.contact_area / (c.s.grid->width[0] * c.s.grid->width[1]), 1e-15);
  control = Loads(&c, 1, 3, 0, 0); /* slides: there is no solution */
  step    = Try(&c, &control);
  sam_assert(isnan(step.spots) && isnan(step.gap_mean) && isnan(step.slip_max) && isnan(step.contact_fraction));
  sam_call(VecDestroy(&slip));
  sam_call(VecDestroy(&gap));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sums_are_those_of_the_committed_steps_and_the_tried_one),
    cmocka_unit_test(test_sums_go_with_the_state),
    cmocka_unit_test(test_numbers_are_those_of_the_fields),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

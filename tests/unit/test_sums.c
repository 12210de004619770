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
      step[2] = {NewField(c.s.grid, 1), NewField(c.s.grid, 1)}, sum;
  PetscBool has;

  (void)state;
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_ACCUMULATED_SLIP, NULL));
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_FRICTION_ENERGY, NULL));
  sam_fails(SamContactComputeFriction(c.contact, step[0], NULL, step[1]), PETSC_ERR_ORDER);
  for (int k = 0; k < STEPS; k++) {
    const SamControl control = Turn(&c, k), other = Loads(&c, 1.1, 0.5, 0.5, 0);

    (void)Try(&c, &other); /* is forgotten */
    (void)Try(&c, &control);
    sam_call(SamContactComputeFriction(c.contact, step[0], NULL, step[1]));
    sam_call(VecAXPY(path, 1, step[0]));
    sam_call(VecAXPY(work, 1, step[1]));
    for (int committed = 0; committed < 2; committed++) {
      sum = NewFieldOf(&c, "slip_path");
      sam_assert(Difference(sum, path, NORM_INFINITY) <= 1e-14);
      sam_call(VecDestroy(&sum));
      sum = NewFieldOf(&c, "friction_energy");
      sam_assert(Difference(sum, work, NORM_INFINITY) <= 1e-14);
      sam_call(VecDestroy(&sum));
      if (!committed) sam_call(SamContactCommit(c.contact));
    }
  }
  sam_assert(Norm(path, NORM_INFINITY) > 0 && Norm(work, NORM_INFINITY) > 0);
  DestroyCase(&c);
  c = NewCase(Steel(), 37, 1.5, MU, "-sum_slip_path");
  sam_call(SamContactHasField(c.contact, "friction_energy", &has));
  sam_assert(!has);
  sam_fails(SamContactGetField(c.contact, "friction_energy", work), PETSC_ERR_ARG_UNKNOWN_TYPE);
  sum = NewFieldOf(&c, "slip_path");
  sam_assert(Norm(sum, NORM_INFINITY) == 0);
  DestroyCase(&c);
  for (int k = 0; k < 2; k++) sam_call(VecDestroy(&step[k]));
  sam_destroy(&path, &work, &sum);
}

static void test_sums_go_with_the_state(void **state)
{
  Case one = NewCase(Steel(), 37, 1.5, MU, "-sum_slip_path"), other = NewCase(Steel(), 37, 1.5, MU, ""),
       none = NewCase(Steel(), 37, 1.5, MU, "");
  SamState held;
  Vec      path;

  (void)state;
  for (int k = 0; k < STEPS; k++) {
    const SamControl control = Turn(&one, k);

    (void)Solve(&one, &control);
    if (k != 1) continue;
    sam_call(SamContactGetState(one.contact, &held));
    sam_assert(SamStateFindField(held, "slip_path") >= 0 && SamStateFindField(held, "friction_energy") < 0);
    sam_fails(SamContactSetState(other.contact, held, PETSC_TRUE), PETSC_ERR_ARG_INCOMP); /* it would lose the sum */
    sam_call(SamProblemAddLawOfType(other.problem, SAM_LAW_ACCUMULATED_SLIP, NULL));
    sam_call(SamContactSetState(other.contact, held, PETSC_TRUE));
  }
  for (int k = 2; k < STEPS; k++) {
    const SamControl control = Turn(&one, k);

    (void)Solve(&other, &control);
  }
  sam_assert(SameBitsOf(&one, &other, NewPath));
  path = NewPath(&other);
  sam_assert(Norm(path, NORM_INFINITY) > 0);
  sam_call(VecDestroy(&path));
  (void)Solve(&none, &(SamControl[]){Turn(&none, 0)}[0]);
  sam_call(SamContactGetState(none.contact, &held)); /* a state that has none: from 0 */
  sam_call(SamContactSetState(other.contact, held, PETSC_TRUE));
  path = NewPath(&other);
  sam_assert(Norm(path, NORM_INFINITY) == 0);
  sam_call(VecDestroy(&path));
  DestroyCase(&one);
  DestroyCase(&other);
  DestroyCase(&none);
}

/* A sphere is one spot, on any number of ranks; without edges its numbers are those of the fields. */
static void test_numbers_are_those_of_the_fields(void **state)
{
  Case          c       = NewCase(Steel(), 37, 1.5, MU, "-contact_spots -edges none");
  double        most[1] = {0}, sum;
  SamControl    control = Turn(&c, 1);
  Vec           slip, gap;
  const double *s, *p, *g;
  SamTotal      total = {0};

  (void)state;
  (void)Solve(&c, &control);
  slip = NewSlip(&c);
  gap  = NewGap(&c);
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
  sam_assert(NumberOf(&c, "contact_spots") == 1 && most[0] > 0);
  sam_assert_close(NumberOf(&c, "slip_max"), most[0], 1e-13 * most[0]);
  sam_assert_close(NumberOf(&c, "gap_mean"), sum / (37 * 37), 1e-13 * sum);
  sam_assert_close(NumberOf(&c, "contact_fraction"),
                   NumberOf(&c, "contact_area") / (c.s.grid->width[0] * c.s.grid->width[1]), 1e-15);
  control = Loads(&c, 1, 3, 0, 0); /* slides: there is no solution */
  (void)Try(&c, &control);
  sam_assert(isnan(NumberOf(&c, "contact_spots")) && isnan(NumberOf(&c, "gap_mean")) &&
             isnan(NumberOf(&c, "slip_max")) && isnan(NumberOf(&c, "contact_fraction")));
  sam_destroy(&slip, &gap);
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

/* The direction of the slip in a step, and the error of the dissipated energy by the length of the steps. */
#include "contacts.h"

#define MID "-slip_direction mid"

/* What a cycle of N, T_x, T_y, and M_z dissipates, the sum of the estimates, and what the balance of work lacks. */
typedef struct {
  double energy, error, lack;
} Cycle;

/* The loads at row k of so many, after `part` of the way to the next. */
static SamControl LoadsAt(const Case *c, double varies, double moment, PetscInt rows, double k, double part)
{
  SamControl from, to;

  for (PetscInt n = 0; n < 2; n++) {
    const double t = 2 * PETSC_PI * (k + (double)n) / (double)rows;

    *(n ? &to : &from) = Loads(c, 1 + varies * sin(t), 0.45 * sin(t + 0.5), 0.4 * sin(t + 1.8), moment * sin(t + 0.9));
  }
  for (PetscInt n = 0; n < SAM_COMPONENTS; n++) from.value[n] += part * (to.value[n] - from.value[n]);
  return from;
}

/* A cycle of so many rows, each in so many steps, from its first row on. */
static Cycle RunCycle(SamPair pair, const char *options, double varies, double moment, PetscInt rows, PetscInt steps)
{
  Case       c       = NewCase(pair, 20, 1.5, MU, options);
  SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStep    step    = Solve(&c, &control), before;
  Cycle      cycle   = {.energy = 0};
  double     stored, work = 0;

  control = LoadsAt(&c, varies, moment, rows, 0, 0);
  step    = Solve(&c, &control);
  stored  = NumberOf(&c, "stored_energy");
  for (PetscInt k = 1; k <= rows * steps; k++) {
    before = step;
    control =
      LoadsAt(&c, varies, moment, rows, (double)((k - 1) / steps), (double)((k - 1) % steps + 1) / (double)steps);
    step = Solve(&c, &control);
    for (PetscInt i = 0; i < SAM_COMPONENTS; i++)
      work += 0.5 * (step.load[i] + before.load[i]) * (step.rigid[i] - before.rigid[i]);
    cycle.energy += NumberOf(&c, "dissipated_energy");
    cycle.error += NumberOf(&c, "energy_error");
  }
  cycle.lack = fabs(work - cycle.energy - NumberOf(&c, "stored_energy") + stored) / cycle.energy;
  DestroyCase(&c);
  return cycle;
}

/* The relative difference of the energies of two cycles. */
static double Differ(Cycle a, Cycle b)
{
  return fabs(a.energy / b.energy - 1);
}

static void AssertEstimate(Cycle cycle, Cycle many)
{
  const double error = Differ(cycle, many) * many.energy;

  sam_assert(cycle.error < 3 * error && error < 3 * cycle.error);
}

/* At mid step errors fall like the square of the steps, and their estimate is within a factor of 3. */
static void test_energy_is_second_order_at_mid_step(void **state)
{
  Cycle one, two, many;

  (void)state;
  sam_on_one_rank();
  one  = RunCycle(Dissimilar(), MID, 0.3, 0.2, 24, 1);
  two  = RunCycle(Dissimilar(), MID, 0.3, 0.2, 24, 2);
  many = RunCycle(Dissimilar(), MID, 0.3, 0.2, 24, 5);
  sam_assert(Differ(two, many) < 0.4 * Differ(one, many));
  sam_assert(two.lack < 0.35 * one.lack && one.lack < 0.02);
  AssertEstimate(one, many);
  AssertEstimate(two, many);
}

/* A cycle of 24 steps has the energy of one of many, with the direction of slip at mid step only. */
static void test_few_steps_do_for_a_cycle(void **state)
{
  Cycle many, few, end;

  (void)state;
  sam_on_one_rank();
  many = RunCycle(Steel(), MID, 0.3, 0, 72, 1);
  few  = RunCycle(Steel(), MID, 0.3, 0, 24, 1);
  end  = RunCycle(Steel(), "-slip_direction end", 0.3, 0, 24, 1);
  sam_assert(Differ(few, many) < 0.01);
  sam_assert(Differ(end, many) > 0.05);
}

/* The direction is that at the end of the step unless the other one is asked for; estimates differ. */
static void test_direction_is_that_at_the_end_by_default(void **state)
{
  const Cycle usual = RunCycle(Steel(), "", 0, 0, 12, 1), end = RunCycle(Steel(), "-slip_direction end", 0, 0, 12, 1),
              mid = RunCycle(Steel(), MID, 0, 0, 12, 1), many = RunCycle(Steel(), MID, 0, 0, 12, 5);

  (void)state;
  sam_assert(usual.energy == end.energy && usual.error == end.error);
  sam_assert(Differ(mid, many) < 0.4 * Differ(end, many));
  AssertEstimate(end, many);
  AssertEstimate(mid, many);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_energy_is_second_order_at_mid_step),
    cmocka_unit_test(test_few_steps_do_for_a_cycle),
    cmocka_unit_test(test_direction_is_that_at_the_end_by_default),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

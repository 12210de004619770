/* The slip in a step, its direction and where it begins, and the error of the dissipated energy by the steps. */
#include "contacts.h"

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
  one  = RunCycle(Dissimilar(), "", 0.3, 0.2, 24, 1);
  two  = RunCycle(Dissimilar(), "", 0.3, 0.2, 24, 2);
  many = RunCycle(Dissimilar(), "", 0.3, 0.2, 24, 5);
  sam_assert(Differ(two, many) < 0.4 * Differ(one, many));
  sam_assert(two.lack < 0.35 * one.lack && one.lack < 0.02);
  AssertEstimate(one, many);
  AssertEstimate(two, many);
}

/* A cycle of 24 steps has the energy of one of many. */
static void test_few_steps_do_for_a_cycle(void **state)
{
  const Cycle many = RunCycle(Steel(), "", 0.3, 0, 24, 5), few = RunCycle(Steel(), "", 0.3, 0, 24, 1),
              end = RunCycle(Steel(), "-slip_direction end", 0.3, 0, 24, 1);

  (void)state;
  sam_assert(Differ(few, many) < 0.02);
  sam_assert(Differ(end, many) > 0.05);
  AssertEstimate(few, many);
  AssertEstimate(end, many);
}

/* The energy of a cycle in which T, on a line, follows N, which varies by `swing`. */
static Cycle RunGrowing(SamPair pair, const char *options, double swing, PetscInt rows, PetscInt steps)
{
  Case    c     = NewCase(pair, 24, 1.5, MU, options);
  Cycle   cycle = {.energy = 0};
  double  n = 0.55, x = 0;
  SamStep step;

  for (PetscInt k = 0; k <= rows; k++) {
    const double t = 2 * PETSC_PI * (double)k / (double)rows, n1 = 0.55 * (1 + swing * sin(t)),
                 x1 = 0.6 * n1 * sin(t + 1.9);

    for (PetscInt m = 1; m <= steps; m++) {
      const double     part = (double)m / (double)steps, along = x + part * (x1 - x);
      const SamControl next = Loads(&c, n + part * (n1 - n), 0.8 * along, 0.6 * along, 0);

      step = Solve(&c, &next);
      AssertGood(&step);
      if (k) cycle.energy += NumberOf(&c, "dissipated_energy");
    }
    n = n1;
    x = x1;
  }
  DestroyCase(&c);
  return cycle;
}

/* Cells that come into contact late in a step have not been held from its beginning. */
static void test_slip_begins_with_contact(void **state)
{
  const Cycle many = RunGrowing(Steel(), "", 0.6, 24, 6), few = RunGrowing(Steel(), "", 0.6, 24, 1),
              end = RunGrowing(Steel(), "-slip_direction end", 0.6, 24, 1);

  (void)state;
  sam_on_one_rank();
  sam_assert(Differ(few, many) < 0.001);
  sam_assert(Differ(end, many) > 3 * Differ(few, many));
}

/* On a line under constant N the shear does not turn: the direction at the end of the step does, to the last bit. */
static void test_loads_on_a_line_are_solved_once(void **state)
{
  const Cycle usual = RunGrowing(Steel(), "", 0, 12, 1), end = RunGrowing(Steel(), "-slip_direction end", 0, 12, 1);

  (void)state;
  sam_assert(usual.energy == end.energy);
}

/* Across the line, back on it after that, and with a moment. */
static void test_loads_off_their_line_turn_the_shear(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    PetscReal energy[2];

    for (int end = 0; end < 2; end++) {
      Case       c       = NewCase(Steel(), 20, 1.5, MU, end ? "-slip_direction end" : "");
      SamControl control = Loads(&c, 1, 0.4, 0, 0);
      SamStep    step    = Solve(&c, &control);

      control = k == 2 ? Loads(&c, 1, 0.4, 0, 0.3) : Loads(&c, 1, 0.4, 0.4, 0);
      if (k == 0) step = Solve(&c, &control);
      if (k == 0) control = Loads(&c, 1, 0.7, 0, 0);
      step = Solve(&c, &control);
      AssertGood(&step);
      energy[end] = NumberOf(&c, "dissipated_energy");
      DestroyCase(&c);
    }
    sam_assert(fabs(energy[0] / energy[1] - 1) > 0.01);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_energy_is_second_order_at_mid_step),
    cmocka_unit_test(test_few_steps_do_for_a_cycle),
    cmocka_unit_test(test_slip_begins_with_contact),
    cmocka_unit_test(test_loads_on_a_line_are_solved_once),
    cmocka_unit_test(test_loads_off_their_line_turn_the_shear),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

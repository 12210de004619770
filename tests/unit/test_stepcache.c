/* Repeated load cycles: a step starts from the same step one cycle before, with the same solution. */
#include "contacts.h"
#include <petsam/private/bodyimpl.h>

#define STEPS 12

/* Step k of a cycle: N varies by `swing` of its mean, the tangential loads along a line, or `across` it, too. */
static SamControl Step(const Case *c, PetscInt k, double swing, double across)
{
  const double turn = 2 * PETSC_PI / STEPS * (double)(k % STEPS);

  return Loads(c, 1 + swing * sin(turn), 0.5 * cos(turn), 0.1 * cos(turn) + across * sin(turn),
               0.5 * across * cos(turn));
}

/* Applications of both operators in so many cycles, those of the last cycle; all steps are good. */
typedef struct {
  double normal, tangential;
} Work;

static Work RunCycles(const Case *c, PetscInt cycles, double swing, double across)
{
  Work work = {0, 0};

  for (PetscInt k = 0; k < cycles * STEPS; k++) {
    const SamControl control = Step(c, k, swing, across);
    const SamStep    step    = Solve(c, &control);

    AssertGood(&step);
    if (k < (cycles - 1) * STEPS) continue;
    work.normal += NumberOf(c, "normal_applies");
    work.tangential += NumberOf(c, "tangential_applies");
  }
  return work;
}

/* The largest difference of the shears of two contacts, relative to the largest shear. */
static double ShearDifference(const Case *a, const Case *b)
{
  Vec       difference = NewField(a->s.grid, 2);
  PetscReal size, most;

  sam_call(VecNorm(SolutionOf(a)->shear, NORM_INFINITY, &size));
  sam_call(VecWAXPY(difference, -1, SolutionOf(a)->shear, SolutionOf(b)->shear));
  sam_call(VecNorm(difference, NORM_INFINITY, &most));
  sam_call(VecDestroy(&difference));
  return (double)(most / size);
}

/*
  Runs cycles with and without memory for them, and compares the ends: within the shear's tolerance, 1e-6, times the
  condition at the edges; where the direction of slip turns, as it does everywhere between dissimilar bodies, both know
  it from a solution to a tenth of its effect.
*/
static void CompareBodies(SamPair pair, double swing, double across, const char *memory, Work *with, Work *without)
{
  const PetscBool turns = across != 0 || pair->dundurs != 0 ? PETSC_TRUE : PETSC_FALSE;
  Case            c = NewCase(pair, 31, 1.5, MU, memory), d = NewCase(pair, 31, 1.5, MU, "-cycle_memory 0");

  *with    = RunCycles(&c, 5, swing, across);
  *without = RunCycles(&d, 5, swing, across);
  sam_assert(ShearDifference(&c, &d) < (turns ? 0.06 : 3e-4));
  DestroyCase(&c);
  DestroyCase(&d);
}

static void Compare(double swing, double across, const char *memory, Work *with, Work *without)
{
  CompareBodies(Steel(), swing, across, memory, with, without);
}

/* Pressure and shear of dissimilar bodies start from the same step of the cycle before. */
static void test_repeated_cycle_of_dissimilar_bodies(void **state)
{
  Work with, without;

  (void)state;
  CompareBodies(Dissimilar(), 0, 0, "", &with, &without);
  sam_assert(with.normal + with.tangential < 0.7 * (without.normal + without.tangential));
  CompareBodies(Dissimilar(), 0.3, 0.1, "", &with, &without);
  sam_assert(with.normal + with.tangential < 0.8 * (without.normal + without.tangential));
}

/* From the third cycle on with the weights of the last two. */
static void test_repeated_cycle_takes_few_products_under_constant_normal_load(void **state)
{
  Work with, without;

  (void)state;
  Compare(0, 0, "", &with, &without);
  sam_assert(with.tangential < 0.12 * without.tangential);
}

/* Where the shear turns, the direction of slip is that of the cycle before, and the step is solved once. */
static void test_repeated_cycle_takes_less_where_loads_turn(void **state)
{
  Work with, without;

  (void)state;
  Compare(0, 0.1, "", &with, &without);
  sam_assert(with.tangential < 0.8 * without.tangential);
}

/* The second half reverses the first, and the last two half cycles tell how the next one differs. */
static void test_half_cycle_that_reverses_the_last_one_starts_from_it(void **state)
{
  Case   c = NewCase(Steel(), 31, 1.5, MU, ""), d = NewCase(Steel(), 31, 1.5, MU, "-cycle_memory 0");
  double with[5] = {0}, without[5] = {0};

  (void)state;
  for (PetscInt k = 0; k < 5 * STEPS / 2; k++) {
    const SamControl control = Step(&c, k, 0, 0);
    SamStep          step    = Solve(&c, &control);

    AssertGood(&step);
    step = Solve(&d, &control);
    AssertGood(&step);
    with[2 * k / STEPS] += NumberOf(&c, "tangential_applies");
    without[2 * k / STEPS] += NumberOf(&d, "tangential_applies");
  }
  sam_assert(with[2] < 0.9 * without[2] && with[3] < 0.6 * without[3]);
  sam_assert(ShearDifference(&c, &d) < 3e-4);
  DestroyCase(&c);
  DestroyCase(&d);
}

static void test_repeated_pressure_is_not_solved_again(void **state)
{
  Work with, without;

  (void)state;
  Compare(0.3, 0, "", &with, &without);
  sam_assert(with.normal == 0 && without.normal > STEPS);
  sam_assert(with.tangential < 0.6 * without.tangential);
}

/* Without friction there is a pressure all the same. */
static void test_repeated_pressure_without_friction(void **state)
{
  Case c = NewCase(Steel(), 31, 1.5, 0, "");

  (void)state;
  for (PetscInt k = 0; k < 3 * STEPS; k++) {
    const SamControl control = Loads(&c, 1 + 0.3 * sin(2 * PETSC_PI * k / STEPS), 0, 0, 0);
    const SamStep    step    = Solve(&c, &control);

    AssertGood(&step);
    sam_assert(k < STEPS + 2 || NumberOf(&c, "normal_applies") == 0);
  }
  DestroyCase(&c);
}

/* A moment about zero and a normal load, both wrong by rounding of the size of the largest, as sines are. */
static void test_loads_that_differ_by_rounding_have_the_same_pressure(void **state)
{
  Case c = NewCase(Steel(), 31, 1.5, MU, "");

  (void)state;
  for (PetscInt k = 0; k < 8; k++) {
    const double wrong   = 1e-14 * Random(1, 2, k, 0);
    SamControl   control = Loads(&c, 1 + (k < 4 ? 0 : 0.2 * (k % 2)) + wrong, 0.3 * sin((double)k), 0, 0);
    SamStep      step;

    control.value[SAM_COMPONENT_MX] = wrong * control.value[SAM_COMPONENT_N] * c.s.grid->dx;
    step                            = Solve(&c, &control);
    AssertGood(&step);
    sam_assert(step.check.equilibrium < 1e-14);
    sam_assert((NumberOf(&c, "normal_applies") == 0) == (k > 0 && k < 5)); /* and then with every step anew */
  }
  DestroyCase(&c);
}

/* Differences above rounding change the pressure; small ones that add up do, too. */
static void test_loads_that_drift_have_another_pressure(void **state)
{
  Case     c      = NewCase(Steel(), 31, 1.5, MU, "");
  PetscInt solved = 0;

  (void)state;
  for (PetscInt k = 0; k < 9; k++) {
    const SamControl control = Loads(&c, 1 + 4e-14 * (double)k, 0.1, 0, 0);
    const SamStep    step    = Solve(&c, &control);

    AssertGood(&step);
    sam_assert(step.check.equilibrium < 1e-13);
    solved += NumberOf(&c, "normal_applies") > 0;
  }
  sam_assert(solved == 3); /* steps 0, 3 and 6 */
  DestroyCase(&c);
}

/* A pressure of a looser tolerance is not taken for one of a tighter. */
static void test_tighter_tolerance_needs_another_pressure(void **state)
{
  Case       c = NewCase(Steel(), 31, 1.5, MU, "-normal_rtol 1e-5");
  SamControl control;

  (void)state;
  for (PetscInt k = 0; k < 2 * STEPS; k++) {
    control = Step(&c, k, 0.3, 0);
    (void)Solve(&c, &control);
  }
  sam_assert(NumberOf(&c, "normal_applies") == 0);
  sam_call(SamSolverSetTolerances(SamNormalAsSolver(SamContactGetNormal(c.contact)), 1e-8, PETSC_DEFAULT));
  control = Step(&c, 0, 0.3, 0);
  (void)Try(&c, &control);
  sam_assert(NumberOf(&c, "normal_applies") > 0);
  DestroyCase(&c);
}

/* Tries of loads that are far off have no effect on which steps are the same. */
static void test_rejected_tries_leave_no_trace(void **state)
{
  Case c = NewCase(Steel(), 31, 1.5, MU, ""), d = NewCase(Steel(), 31, 1.5, MU, "");

  (void)state;
  for (PetscInt k = 0; k < 2 * STEPS; k++) {
    const SamControl control = Step(&c, k, 0.3, 0.1), far = Loads(&c, 1e9, 0, 0, 0);

    (void)Solve(&c, &control);
    (void)Try(&d, &far);
    sam_call(SamContactReject(d.contact));
    (void)Solve(&d, &control);
    sam_assert(ShearDifference(&c, &d) == 0);
  }
  DestroyCase(&c);
  DestroyCase(&d);
}

/* 20 fields, at least 48 MB, at most 1 GB. */
static void test_usual_memory_follows_from_the_grid_alone(void **state)
{
  const PetscInt n[]     = {31, 1000, 4000};
  const double   bytes[] = {48e6, 160e6, 1e9};

  (void)state;
  for (int k = 0; k < 3; k++) {
    const PetscInt  cells[] = {n[k], n[k]};
    const PetscReal width[] = {1, 1};
    SamGrid         grid;

    sam_call(SamGridCreate(PETSC_COMM_WORLD, cells, width, (PetscReal[]){0, 0}, &grid));
    sam_assert(SamContactCycleMemory(grid) == bytes[k]);
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_without_room_nothing_is_kept(void **state)
{
  Work with, without;

  (void)state;
  Compare(0.3, 0, "-cycle_memory 100", &with, &without);
  sam_assert(with.normal == without.normal && with.tangential == without.tangential);
}

static void test_part_of_a_cycle_that_fits_is_used(void **state)
{
  Work with, without;

  (void)state;
  Compare(0, 0, "-cycle_memory 2e4", &with, &without); /* half a cycle takes about 3.5e4 */
  sam_assert(with.tangential < 0.9 * without.tangential && with.tangential > 0.6 * without.tangential);
}

/* Steps that repeat none fill the memory twice before the cycles. */
static void test_steps_that_repeat_none_make_room(void **state)
{
  Case c = NewCase(Steel(), 31, 1.5, MU, "-cycle_memory 1e5"), d = NewCase(Steel(), 31, 1.5, MU, "-cycle_memory 0");
  Work with, without;

  (void)state;
  for (PetscInt k = 0; k < 30; k++) {
    const SamControl control = Loads(&c, 1, 0.5 * Random(1, 0, k, 0), 0.5 * Random(1, 1, k, 0), 0);
    SamStep          step    = Solve(&c, &control);

    AssertGood(&step);
    step = Solve(&d, &control);
    AssertGood(&step);
  }
  with    = RunCycles(&c, 4, 0, 0);
  without = RunCycles(&d, 4, 0, 0);
  sam_assert(with.tangential < 0.6 * without.tangential);
  DestroyCase(&c);
  DestroyCase(&d);
}

/* A load that was never met is followed by the cycle again, from another state than in the cycle before. */
static void test_cycle_after_another_load_has_the_same_solution(void **state)
{
  Case c = NewCase(Steel(), 31, 1.5, MU, ""), d = NewCase(Steel(), 31, 1.5, MU, "-cycle_memory 0");

  (void)state;
  for (PetscInt k = 0; k < 4 * STEPS + 5; k++) {
    const SamControl control = k == 3 * STEPS + 4 ? Loads(&c, 1, -0.8, 0.3, 0) : Step(&c, k, 0, 0);
    SamStep          step    = Solve(&c, &control);

    AssertGood(&step);
    step = Solve(&d, &control);
    AssertGood(&step);
    sam_assert(ShearDifference(&c, &d) < 3e-4);
  }
  DestroyCase(&c);
  DestroyCase(&d);
}

static void test_another_gap_needs_another_pressure(void **state)
{
  Case       c = NewCase(Steel(), 31, 1.5, MU, "");
  SamControl control;

  (void)state;
  (void)RunCycles(&c, 3, 0.3, 0);
  control = Step(&c, 0, 0.3, 0);
  (void)Try(&c, &control);
  sam_assert(NumberOf(&c, "normal_applies") == 0);
  sam_call(VecScale(c.s.h, 1.01));
  sam_call(SamProblemSetGap(c.problem, c.s.h));
  (void)Try(&c, &control);
  sam_assert(NumberOf(&c, "normal_applies") > 0);
  DestroyCase(&c);
}

/* After a reset the first cycle is the first: as in a new contact, to the last bit. */
static void test_reset_forgets_the_cycles(void **state)
{
  Case c = NewCase(Steel(), 31, 1.5, MU, ""), d = NewCase(Steel(), 31, 1.5, MU, "");

  (void)state;
  (void)RunCycles(&c, 3, 0.3, 0);
  sam_call(SamContactReset(c.contact));
  (void)RunCycles(&c, 2, 0.3, 0);
  (void)RunCycles(&d, 2, 0.3, 0);
  sam_assert(ShearDifference(&c, &d) == 0);
  DestroyCase(&c);
  DestroyCase(&d);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_repeated_cycle_of_dissimilar_bodies),
    cmocka_unit_test(test_repeated_cycle_takes_few_products_under_constant_normal_load),
    cmocka_unit_test(test_repeated_cycle_takes_less_where_loads_turn),
    cmocka_unit_test(test_half_cycle_that_reverses_the_last_one_starts_from_it),
    cmocka_unit_test(test_repeated_pressure_is_not_solved_again),
    cmocka_unit_test(test_repeated_pressure_without_friction),
    cmocka_unit_test(test_loads_that_differ_by_rounding_have_the_same_pressure),
    cmocka_unit_test(test_loads_that_drift_have_another_pressure),
    cmocka_unit_test(test_tighter_tolerance_needs_another_pressure),
    cmocka_unit_test(test_rejected_tries_leave_no_trace),
    cmocka_unit_test(test_usual_memory_follows_from_the_grid_alone),
    cmocka_unit_test(test_without_room_nothing_is_kept),
    cmocka_unit_test(test_part_of_a_cycle_that_fits_is_used),
    cmocka_unit_test(test_steps_that_repeat_none_make_room),
    cmocka_unit_test(test_cycle_after_another_load_has_the_same_solution),
    cmocka_unit_test(test_another_gap_needs_another_pressure),
    cmocka_unit_test(test_reset_forgets_the_cycles),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

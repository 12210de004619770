/* The model of a step's time on other numbers of ranks: against measured times, and what must hold of any model. */
#include "samtest.h"

#include "../../src/run/forecast/scaling.h"

/*
  Measured seconds on 1, 2, 4, 8 and 16 ranks, 0: not measured; a step of two spheres with slip. The first three on a
  node with 16 cores of one socket (examples/manual/LARGE.md), the others on two cores (tests/bench/README.md). A step
  of the history of 80 takes less than a single step, which leaves its ratios.
*/
static const struct {
  PetscInt n;
  double   here; /* time of a step on one rank as -dry_run estimates it */
  double   seconds[5];
} measured[] = {{2048, 8.23, {8.23, 4.47, 2.51, 1.73, 1.03}},
                {4096, 42.3, {42.3, 23.1, 12.8, 8.44, 5.75}},
                {512, 8.23 / 16, {17.4, 9.87, 7.16, 4.27, 2.49}},
                {1024, 0.63, {0.63, 0.40}},
                {2048, 2.9, {2.9, 1.9}},
                {4096, 15.7, {15.7, 9.2}}};

static SamScaling Usual(PetscInt n, int ranks, int cores, double seconds)
{
  return (SamScaling){.n = {n, n}, .friction = PETSC_TRUE, .ranks = ranks, .cores = cores, .seconds = seconds};
}

static void test_measured_times_are_met(void **state)
{
  (void)state;
  for (size_t c = 0; c < sizeof(measured) / sizeof(*measured); c++) {
    const SamScaling s = Usual(measured[c].n, 1, 16, measured[c].here);

    for (int k = 0; k < 5 && measured[c].seconds[k] > 0; k++) {
      const double ratio = SamScalingPredict(&s, 1 << k, 16).seconds / s.seconds;
      const double error = ratio * measured[c].seconds[0] / measured[c].seconds[k] - 1;

      if (Rank() == 0) print_message("%d cells, %d ranks: %+.0f %%\n", (int)measured[c].n, 1 << k, 100 * error);
      sam_assert(fabs(error) <= 0.3);
    }
  }
}

/* What was measured comes back, and a run elsewhere predicts the same. */
static void test_predictions_agree_with_each_other(void **state)
{
  const SamScaling one = Usual(2048, 1, 16, 8.23);

  (void)state;
  for (int ranks = 2; ranks <= 64; ranks *= 2) {
    const double     seconds = SamScalingPredict(&one, ranks, 16).seconds;
    const SamScaling many    = Usual(2048, ranks, 16, seconds);

    sam_assert_close(SamScalingPredict(&many, ranks, 16).seconds, seconds, 1e-12 * seconds);
    sam_assert_close(SamScalingPredict(&many, 1, 16).seconds, one.seconds, 1e-9 * one.seconds);
  }
}

static void test_messages_cost_where_there_are_some(void **state)
{
  SamScaling           s     = Usual(1000, 1, 16, 2);
  const SamScalingTime alone = SamScalingPredict(&s, 1, 16), node = SamScalingPredict(&s, 16, 16),
                       two = SamScalingPredict(&s, 32, 16), many = SamScalingPredict(&s, 32, 1);

  (void)state;
  sam_assert(alone.messages == 0 && alone.nodes == 1 && two.nodes == 2 && many.nodes == 32);
  sam_assert(node.messages > 0 && two.messages > 2 * node.messages);
  s.send = PETSC_TRUE;
  sam_assert(SamScalingPredict(&s, 16, 16).messages > 2 * node.messages);
  sam_assert(SamScalingPredict(&s, 1, 16).messages == 0);
  s.friction = PETSC_FALSE;
  sam_assert(SamScalingPredict(&s, 32, 16).messages < 0.6 * two.messages);
}

/* More ranks than rows of cells do not help. */
static void test_ranks_without_rows_do_not_help(void **state)
{
  SamScaling s = Usual(2048, 1, 16, 0.3);

  (void)state;
  s.n[1] = 40;
  sam_assert(SamScalingPredict(&s, 64, 16).seconds > SamScalingPredict(&s, 40, 16).seconds);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_measured_times_are_met),
                                     cmocka_unit_test(test_predictions_agree_with_each_other),
                                     cmocka_unit_test(test_messages_cost_where_there_are_some),
                                     cmocka_unit_test(test_ranks_without_rows_do_not_help)};

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

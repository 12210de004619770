/* Estimates of errors: from companion runs, and in closed form. */
#include "samtest.h"
#include <petsam/private/errors.h>
#include <math.h>

/* A number of first order has the error of its own cells, and one that differs by luck that of the coarser cells. */
static void test_error_by_cells_is_the_larger_difference(void **state)
{
  const double first[] = {1 + 2 * 0.01, 1 + 4 * 0.01, NAN}, lucky[] = {1, 1.1, NAN}, alone[] = {1.3, NAN, NAN},
               none[] = {NAN, 1, 1};

  (void)state;
  sam_assert_close(SamErrorByCells(1.01, first), 0.01, 1e-15);
  sam_assert_close(SamErrorByCells(1, lucky), 0.05, 1e-15);
  sam_assert_close(SamErrorByCells(1, alone), 0.3, 1e-15);
  sam_assert(isnan(SamErrorByCells(1, none)));
}

static void test_error_by_steps_is_the_difference_of_runs_on_the_same_cells(void **state)
{
  const double runs[] = {2, 7, 2.5};

  (void)state;
  sam_assert_close(SamErrorBySteps(runs), 0.5, 1e-15);
}

static void test_largest_doubt_is_kept_for_each_number_and_cause(void **state)
{
  SamDoubts d = {.count = 0};
  PetscBool known;

  (void)state;
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.1, "shear_max slip_max");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.3, "shear_max");
  SamDoubtsAdd(&d, SAM_CAUSE_STEPS, 7, "slip_max");
  SamDoubtsAdd(&d, SAM_CAUSE_STEPS, NAN, "slip_max");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.2, "shear_max");
  sam_assert_close(SamDoubtsOf(&d, "shear_max", SAM_CAUSE_CELLS, &known), 0.3, 0);
  sam_assert_close(SamDoubtsOf(&d, "slip_max", SAM_CAUSE_CELLS, &known), 0.1, 0);
  sam_assert_close(SamDoubtsOf(&d, "slip_max", SAM_CAUSE_STEPS, &known), 1, 0);
  sam_assert_close(SamDoubtsOf(&d, "shear_max", SAM_CAUSE_STEPS, &known), 0, 0);
  sam_assert_close(SamDoubtsOf(&d, "shear", SAM_CAUSE_CELLS, &known), 0, 0);
  sam_assert(d.count == 3 && !known);
  SamDoubtsSet(&d, SAM_CAUSE_CELLS, 0.01, "shear_max");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.6, "shear_max");
  sam_assert_close(SamDoubtsOf(&d, "shear_max", SAM_CAUSE_CELLS, &known), 0.01, 0);
  sam_assert(d.count == 3 && known);
}

static void test_more_doubts_than_there_is_room_for_are_dropped(void **state)
{
  SamDoubts d = {.count = 0};
  PetscBool known;
  char      name[16];

  (void)state;
  for (int k = 0; k < SAM_DOUBTS + 5; k++) {
    (void)snprintf(name, sizeof(name), "number%d", k);
    SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.5, name);
  }
  sam_assert(d.count == SAM_DOUBTS);
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.7, "number3");
  sam_assert_close(SamDoubtsOf(&d, "number3", SAM_CAUSE_CELLS, &known), 0.7, 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_error_by_cells_is_the_larger_difference),
    cmocka_unit_test(test_error_by_steps_is_the_difference_of_runs_on_the_same_cells),
    cmocka_unit_test(test_largest_doubt_is_kept_for_each_number_and_cause),
    cmocka_unit_test(test_more_doubts_than_there_is_room_for_are_dropped),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

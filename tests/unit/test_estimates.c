/* Estimates of errors: from companion runs, and in closed form. */
#include "samtest.h"
#include <petsam/private/errors.h>
#include <math.h>
#include <string.h>

/* A number of first order has the error of its own cells, and one that differs by luck that of the coarser cells; an
   energy of second order has more than its error. */
static void test_error_by_cells_is_the_larger_difference(void **state)
{
  const double first[] = {1 + 2 * 0.01, 1 + 4 * 0.01, NAN}, lucky[] = {1, 1.1, NAN}, alone[] = {1.3, NAN, NAN},
               none[] = {NAN, 1, 1}, second[] = {1 + 4 * 0.01, 1 + 16 * 0.01, NAN};

  (void)state;
  sam_assert_close(SamErrorByCells(PETSC_FALSE, 1.01, first), 0.01, 1e-15);
  sam_assert_close(SamErrorByCells(PETSC_FALSE, 1, lucky), 0.05, 1e-15);
  sam_assert_close(SamErrorByCells(PETSC_FALSE, 1, alone), 0.3, 1e-15);
  sam_assert(isnan(SamErrorByCells(PETSC_FALSE, 1, none)));
  sam_assert_close(SamErrorByCells(PETSC_TRUE, 1.01, second), 0.015, 1e-15);
  sam_assert_close(SamErrorByCells(PETSC_TRUE, 1, lucky), 0.0125, 1e-15);
}

/* Differences of a root of the cell size, those that are lost in the wandering, that fall, that grow, that turn. */
static void test_error_of_a_series_is_its_rest(void **state)
{
  const double root = 2 - PETSC_SQRT2, edge[] = {1 - (PETSC_SQRT2 - 1), 1 - 1, NAN}, falls[] = {0.5, -0.25, NAN},
               grows[] = {0.7, 0.5, NAN}, turns[] = {1.3, 1, NAN}, alone[] = {0.7, NAN, NAN};

  (void)state;
  sam_assert_close(SamErrorOfSeries(0.1, 1, edge),
                   (PETSC_SQRT2 - 1) / root * (PETSC_SQRT2 - 1) / (1 - (PETSC_SQRT2 - 1) / root), 1e-12);
  sam_assert_close(SamErrorOfSeries(0.5, 1, edge), 0, 0);
  sam_assert_close(SamErrorOfSeries(0.1, 1, falls), 0, 0);
  sam_assert(isinf(SamErrorOfSeries(0.1, 1, grows)));
  sam_assert_close(SamErrorOfSeries(0.1, 1, turns), 0, 0);
  sam_assert_close(SamErrorOfSeries(0.1, 1, alone), 0, 0);
}

/* Half of that of a number; all of it where a run is missing, or has lost what is derived. */
static void test_error_of_a_derivative(void **state)
{
  const double both[] = {1.1, 1.5, NAN}, alone[] = {1.1, NAN, NAN}, lost[] = {0, 0, NAN};

  (void)state;
  sam_assert_close(SamErrorOfDerivative(1, both), 0.1, 1e-15);
  sam_assert_close(SamErrorOfDerivative(1, alone), 0.1, 1e-15);
  sam_assert_close(SamErrorOfDerivative(1, lost), 1, 1e-15);
}

static void test_error_by_steps_is_the_difference_of_runs_on_the_same_cells(void **state)
{
  const double runs[] = {2, 7, 2.5};

  (void)state;
  sam_assert_close(SamErrorBySteps(runs, SAM_RUN_HALF), 0.5, 1e-15);
  sam_assert_close(SamErrorBySteps(runs, SAM_RUN_QUARTER), 4.5, 1e-15);
}

static void test_largest_doubt_is_kept_for_each_number_and_cause(void **state)
{
  SamDoubts d = {.count = 0};
  PetscBool known;

  (void)state;
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.1, 2, "shear_max slip_max", "it is narrow");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.3, 2, "shear_max", "it is narrow");
  SamDoubtsAdd(&d, SAM_CAUSE_STEPS, 7, 2, "slip_max", "it is narrow");
  SamDoubtsAdd(&d, SAM_CAUSE_STEPS, NAN, 2, "slip_max", "it is narrow");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.2, 2, "shear_max", "it is narrow");
  sam_assert_close(SamDoubtsOf(&d, "shear_max", SAM_CAUSE_CELLS, &known), 0.3, 0);
  sam_assert_close(SamDoubtsOf(&d, "slip_max", SAM_CAUSE_CELLS, &known), 0.1, 0);
  sam_assert_close(SamDoubtsOf(&d, "slip_max", SAM_CAUSE_STEPS, &known), 1, 0);
  sam_assert_close(SamDoubtsOf(&d, "shear_max", SAM_CAUSE_STEPS, &known), 0, 0);
  sam_assert_close(SamDoubtsOf(&d, "shear", SAM_CAUSE_CELLS, &known), 0, 0);
  sam_assert(d.count == 3 && !known);
  SamDoubtsSet(&d, SAM_CAUSE_CELLS, 0.01, 2, "shear_max", "it is narrow");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.6, 2, "shear_max", "it is narrow");
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
    SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.5, 2, name, "it is narrow");
  }
  sam_assert(d.count == SAM_DOUBTS);
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.7, 2, "number3", "it is narrow");
  sam_assert_close(SamDoubtsOf(&d, "number3", SAM_CAUSE_CELLS, &known), 0.7, 0);
}

/* The largest comes first, each reason once, and what mends all of them counts; what nothing mends has no factor,
   nor has a line with what more makes worse. */
static void test_doubts_of_a_cause_are_told_in_one_line(void **state)
{
  SamDoubts d = {.count = 0};
  double    factor;
  char      text[256];

  (void)state;
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.06, 1.5, "slip_max", "zones of %.1f cells", 0.8);
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.04, 9, "shear_max", "not large");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 2, 4, "energy volume", "zones of %.1f cells", 0.8);
  SamDoubtsAdd(&d, SAM_CAUSE_STEPS, 0.7, 8, "energy", "long steps");
  SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.2, 3, "slip_max", "%s", "");
  SamDoubtsWrite(&d, SAM_CAUSE_CELLS, &factor, text, sizeof(text));
  sam_assert(!strcmp(text, "energy unknown, volume unknown, slip_max 20 % (zones of 0.8 cells)"));
  sam_assert_close(factor, 4, 0);
  SamDoubtsWrite(&d, SAM_CAUSE_LAYERS, &factor, text, sizeof(text));
  sam_assert(!text[0] && factor == 0);
  SamDoubtsAdd(&d, SAM_CAUSE_STEPS, 0.1, 0, "energy", "no steps do");
  SamDoubtsWrite(&d, SAM_CAUSE_STEPS, &factor, text, sizeof(text));
  sam_assert(!strcmp(text, "energy 70 % (long steps)") && factor == 0);
  SamDoubtsAdd(&d, SAM_CAUSE_LAYERS, 0.4, 2, "energy", "thick");
  SamDoubtsAdd(&d, SAM_CAUSE_LAYERS, 0.3, 2, "volume", "thick; few");
  SamDoubtsAdd(&d, SAM_CAUSE_LAYERS, 0.2, 2, "slip_max", "few");
  SamDoubtsWrite(&d, SAM_CAUSE_LAYERS, &factor, text, sizeof(text));
  sam_assert(!strcmp(text, "energy 40 %, volume 30 %, slip_max 20 % (thick; few)"));
  SamDoubtsAdd(&d, SAM_CAUSE_MESH, 0.4, 2, "energy volume", "few elements");
  SamDoubtsWrite(&d, SAM_CAUSE_MESH, &factor, text, sizeof(text));
  sam_assert(factor == 2);
  SamDoubtsAdd(&d, SAM_CAUSE_MESH, 0.3, SAM_DOUBT_WORSE, "volume", "worse with each");
  SamDoubtsAdd(&d, SAM_CAUSE_MESH, 0.5, 3, "volume", "few elements");
  SamDoubtsWrite(&d, SAM_CAUSE_MESH, &factor, text, sizeof(text));
  sam_assert(factor == 0);
}

static void test_a_line_names_some_numbers_and_counts_the_others(void **state)
{
  SamDoubts d = {.count = 0};
  double    factor;
  char      name[16], text[256];

  (void)state;
  for (int k = 0; k < 10; k++) {
    (void)snprintf(name, sizeof(name), "n%d", k);
    SamDoubtsAdd(&d, SAM_CAUSE_CELLS, 0.09 * (k + 1), 2, name, "reason %d", k / 2);
  }
  SamDoubtsWrite(&d, SAM_CAUSE_CELLS, &factor, text, sizeof(text));
  sam_assert(!strcmp(text,
                     "n9 90 %, n8 81 %, n7 72 %, n6 63 %, n5 54 %, n4 45 %, n3 36 %, n2 27 % and 2 more (reason 4; "
                     "reason 3; reason 2)"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_error_by_cells_is_the_larger_difference),
    cmocka_unit_test(test_error_of_a_series_is_its_rest),
    cmocka_unit_test(test_error_of_a_derivative),
    cmocka_unit_test(test_error_by_steps_is_the_difference_of_runs_on_the_same_cells),
    cmocka_unit_test(test_largest_doubt_is_kept_for_each_number_and_cause),
    cmocka_unit_test(test_more_doubts_than_there_is_room_for_are_dropped),
    cmocka_unit_test(test_doubts_of_a_cause_are_told_in_one_line),
    cmocka_unit_test(test_a_line_names_some_numbers_and_counts_the_others),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Load histories as spreadsheets and editors write them; where a history starts; options that it replaces.
 */
#include "histories.h"

#include <petsam/private/arguments.h>

static void test_separators_may_be_semicolons_tabs_or_spaces(void **state)
{
  (void)state;
  AssertPlain("time;load_n;load_tx\n1;100;0\n2.5;100;25\n4;120;-30.5\n");
  AssertPlain("time\tload_n\tload_tx\n1\t100\t0\n2.5\t100\t25\n4\t120\t-30.5\n");
  AssertPlain("time load_n load_tx\n1 100 0\n2.5 100 25\n4 120 -30.5\n");
  AssertPlain("  time   load_n\t load_tx  # aligned\n  1      100   0\n  2.5  100    25\n4 \t 120 -30.5\n");
  AssertPlain("time ; load_n;\tload_tx\n1; 100 ;0\n2.5;100;25 # end\n4;120;-30.5\n");
}

static void test_first_line_may_begin_with_a_byte_order_mark(void **state)
{
  (void)state;
  AssertPlain("\xef\xbb\xbftime,load_n,load_tx\r\n1,100,0\r\n2.5,100,25\r\n4,120,-30.5\r\n");
  AssertPlain("\xef\xbb\xbf# loads\ntime,load_n,load_tx\n1,100,0\n2.5,100,25\n4,120,-30.5\n");
  AssertMalformed("time,load_tx\n\xef\xbb\xbf"
                  "1,2\n",
                  2, "is not a finite number");
}

static void test_spreadsheets_may_quote_fields(void **state)
{
  (void)state;
  AssertPlain("\"time\",\"load_n\", \"load_tx\"\n1,100,0\n\"2.5\",100,25\n4,120,\"-30.5\"\n");
  AssertMalformed("\"time\",\"load_tx\n1,2\n", 1, "load_tx");
  AssertMalformed("time,load_tx\n1,\"\n", 2, "is not a finite number");
}

static void test_lines_may_end_in_carriage_returns(void **state)
{
  (void)state;
  AssertPlain("time,load_n,load_tx\r1,100,0\r2.5,100,25\r4,120,-30.5\r");
  AssertPlain("time,load_n,load_tx\r1,100,0\n2.5,100,25\r\n4,120,-30.5");
  AssertMalformed("time,load_tx\r1,2\r2,x\r", 3, "load_tx");
}

/* A first row without any load is the start, and one step. */
static void test_first_row_of_zeros_is_not_divided(void **state)
{
  static const double times[] = {5, 5.5, 6, 7, 8}, forces[] = {0, 50, 100, 100, 100}, sides[] = {0, 0, 0, 1.5, 3};
  SamHistory          h;
  PetscInt            start;

  (void)state;
  Write("time,load_n,disp_x\n5,0,0\n6,100,0\n8,100,3\n");
  h = Read("-history test_history.csv -steps 2");
  sam_assert(CountOf(h) == 5);
  start = SamHistoryGetStart(h);
  sam_assert(start == 1);
  for (PetscInt k = 0; k < 5; k++) {
    const SamControl step = StepOf(h, k);

    sam_assert(step.time == times[k] && step.value[SAM_COMPONENT_N] == forces[k]);
    sam_assert(step.value[SAM_COMPONENT_TX] == sides[k]);
  }
  sam_call(SamHistoryDestroy(&h));
  h = Read("-history test_history.csv"); /* one step a row, as ever */
  sam_assert(CountOf(h) == 3 && StepOf(h, 0).time == 5 && StepOf(h, 2).time == 8);
  sam_call(SamHistoryDestroy(&h));
}

/* Anything that is prescribed in the first row is led to, by a column or by an option. */
static void test_first_row_with_a_load_is_divided(void **state)
{
  static const struct {
    const char *file, *options;
  } cases[] = {{"time,load_n\n0,1\n1,2\n", ""},
               {"time,load_n\n0,0\n1,2\n", " -rot_z 1e-3"},
               {"time,load_tx\n0,0\n1,2\n", " -load_n 3"},
               {"time,load_n\n0,0\n1,2\n", " -bulk2_stress_xy 1e6"},
               {"time,load_n,bulk1_stress_xx\n0,0,1\n1,2,1\n", ""}};

  (void)state;
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    char       options[128];
    PetscInt   start;
    SamHistory h;

    Write(cases[k].file);
    (void)snprintf(options, sizeof(options), "-history test_history.csv -steps 3%s", cases[k].options);
    h     = Read(options);
    start = SamHistoryGetStart(h);
    sam_assert(CountOf(h) == 6 && start == 3);
    sam_call(SamHistoryDestroy(&h));
  }
}

/* The history with options, and where they stand. */
static SamHistory ReadWith(const char *options, SamArgument given[], int givens)
{
  const SamArguments arguments = {.given = given, .givens = Rank() ? 0 : givens}; /* only rank 0 knows them */
  SamHistory         h;

  SetHistoryOptions(options);
  sam_call(SamHistoryCreateFromOptions(&(SamOptions){PETSC_COMM_WORLD, NULL}, &arguments, Conditions(), &h));
  SetHistoryOptions("");
  return h;
}

static void test_columns_replace_the_values_of_an_options_file(void **state)
{
  char        names[4][24]  = {"load_ty", "load_n", "load_tx", "bulk1_stress_xx"};
  char        places[4][24] = {"", "a.opts, line 1: ", "a.opts, line 2: ", "a.opts, line 3: "};
  SamArgument given[4];
  SamHistory  h;
  SamControl  step;

  (void)state;
  for (int k = 0; k < 4; k++) given[k] = (SamArgument){.name = names[k], .place = places[k]};
  Write("time,load_n,disp_x,bulk1_stress_xx\n1,7,2e-6,5\n2,8,3e-6,6\n");
  h    = ReadWith("-history test_history.csv -load_n 1000 -load_tx 60 -load_ty 4 -bulk1_stress_xx 99", given, 4);
  step = StepOf(h, 0);
  sam_assert(step.value[SAM_COMPONENT_N] == 7 && step.value[SAM_COMPONENT_TX] == 2e-6);
  sam_assert(!step.force[SAM_COMPONENT_TX] && ConditionOf(&step, "bulk1_stress_xx") == 5);
  sam_assert(step.force[SAM_COMPONENT_TY] && step.value[SAM_COMPONENT_TY] == 4);
  sam_call(SamHistoryDestroy(&h));
}

static void test_columns_do_not_replace_what_is_given_for_this_run(void **state)
{
  char               name[] = "Load_N", place[] = "";
  SamArgument        given     = {.name = name, .place = place};
  const SamArguments arguments = {.given = &given, .givens = Rank() ? 0 : 1};
  SamHistory         h         = NULL;
  PetscErrorCode     ierr;

  (void)state;
  Write("time,load_n\n1,7\n");
  SetHistoryOptions("-history test_history.csv -load_n 1000");
  BeginCatching();
  ierr = SamHistoryCreateFromOptions(&(SamOptions){PETSC_COMM_WORLD, NULL}, &arguments, Conditions(), &h);
  EndCatching();
  SetHistoryOptions("");
  sam_assert(ierr == SAM_ERR_USER && strstr(CaughtMessage(), "-load_n: test_history.csv has the column load_n"));
  if (h) sam_call(SamHistoryDestroy(&h));
  RemoveFile(file);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_separators_may_be_semicolons_tabs_or_spaces),
    cmocka_unit_test(test_first_line_may_begin_with_a_byte_order_mark),
    cmocka_unit_test(test_spreadsheets_may_quote_fields),
    cmocka_unit_test(test_lines_may_end_in_carriage_returns),
    cmocka_unit_test(test_first_row_of_zeros_is_not_divided),
    cmocka_unit_test(test_first_row_with_a_load_is_divided),
    cmocka_unit_test(test_columns_replace_the_values_of_an_options_file),
    cmocka_unit_test(test_columns_do_not_replace_what_is_given_for_this_run),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Load histories: reading the file and the options, and dividing rows into increments.
 */
#include "histories.h"

/* ---- text ---- */

static void test_rows_are_steps(void **state)
{
  (void)state;
  AssertPlain("time,load_n,load_tx\n1,100,0\n2.5,100,25\n4,120,-30.5\n");
}

static void test_columns_may_stand_in_any_order(void **state)
{
  (void)state;
  AssertPlain("load_tx,time,load_n\n0,1,100\n25,2.5,100\n-30.5,4,120\n");
}

static void test_comments_and_empty_lines_count_for_nothing(void **state)
{
  (void)state;
  AssertPlain("# fretting, a study, of things\n\n   \n#\ntime,load_n,load_tx # the columns, and "
              "more\n\n1,100,0#first\n # 3,1,2\n2.5,100,25 # nan\n\t\n4,120,-30.5\n\n# end\n");
}

static void test_white_space_around_fields_counts_for_nothing(void **state)
{
  (void)state;
  AssertPlain("  time ,load_n\t, load_tx  \n 1,\t100 ,0\n2.5  ,  100,25 \n\t4,120 ,\t-30.5\n");
}

static void test_lines_may_end_in_carriage_return_and_newline(void **state)
{
  (void)state;
  AssertPlain("# CRLF\r\ntime,load_n,load_tx\r\n\r\n1,100,0\r\n2.5,100,25\r\n4,120,-30.5\r\n");
}

static void test_last_line_needs_no_newline(void **state)
{
  (void)state;
  AssertPlain("time,load_n,load_tx\n1,100,0\n2.5,100,25\n4,120,-30.5");
  AssertPlain("time,load_n,load_tx\r\n1,100,0\r\n2.5,100,25\r\n4,120,-30.5\r");
  AssertPlain("time,load_n,load_tx\n1,100,0\n2.5,100,25\n4,120,-30.5\n# end");
}

static void test_numbers_may_be_scientific(void **state)
{
  (void)state;
  AssertPlain("time,load_n,load_tx\n1e0,1E2,0.0e0\n+25e-1,.1e3,+2.5E+01\n4.,0120,-3050e-2\n");
}

static void test_numbers_are_read_to_the_last_digit(void **state)
{
  SamHistory h;

  (void)state;
  Write("time,load_n,load_tx\n-1.2345678901234567e-300,0.1,4.9e-324\n1.7976931348623157e308,9007199254740993,-0\n");
  h = Read("-history test_history.csv");
  sam_assert(StepOf(h, 0).time == -1.2345678901234567e-300 && StepOf(h, 0).value[SAM_COMPONENT_N] == 0.1 &&
             StepOf(h, 0).value[SAM_COMPONENT_TX] == 4.9e-324);
  sam_assert(StepOf(h, 1).time == 1.7976931348623157e308 && StepOf(h, 1).value[SAM_COMPONENT_N] == 9007199254740993.0 &&
             StepOf(h, 1).value[SAM_COMPONENT_TX] == 0);
  sam_call(SamHistoryDestroy(&h));
}

static void test_long_files_and_lines_are_read_whole(void **state)
{
  enum { ROWS = 3000, COMMENT = 20000 };
  char      *text = (char *)malloc(ROWS * 48 + COMMENT + 100), *end = text;
  SamHistory h;
  int        good = 1;

  (void)state;
  sam_assert(text != NULL);
  end += sprintf(end, "#");
  memset(end, ',', COMMENT);
  end += COMMENT;
  end += sprintf(end, "\ntime,load_n\n");
  for (int r = 0; r < ROWS; r++) end += sprintf(end, "%.17g,%d\n", 0.1 * (r + 1), 7 * r);
  WriteBytes(text, (size_t)(end - text));
  free(text);
  h = Read("-history test_history.csv");
  sam_assert(CountOf(h) == ROWS);
  for (PetscInt r = 0; r < ROWS; r++)
    good = good && StepOf(h, r).time == 0.1 * ((double)r + 1) && StepOf(h, r).value[SAM_COMPONENT_N] == 7.0 * (double)r;
  sam_assert(good);
  sam_call(SamHistoryDestroy(&h));
}

/* ---- controls ---- */

static void test_each_column_controls_its_component(void **state)
{
  (void)state;
  for (PetscInt component = 0; component < 6; component++)
    for (PetscInt rigid = 0; rigid < 2; rigid++) {
      char       text[64];
      SamHistory h;
      SamControl step;

      (void)snprintf(text, sizeof(text), "time,%s\n1,0.25\n", NameOf(component, rigid ? PETSC_TRUE : PETSC_FALSE));
      Write(text);
      h    = Read(component ? "-history test_history.csv -load_n 8" : "-history test_history.csv");
      step = StepOf(h, 0);
      for (PetscInt k = 0; k < 6; k++) {
        sam_assert(step.force[k] == (k == component && rigid ? PETSC_FALSE : PETSC_TRUE));
        sam_assert(step.value[k] == (k == component ? 0.25 : (k == 0 ? 8 : 0)));
      }
      sam_call(SamHistoryDestroy(&h));
    }
}

static void test_components_without_a_column_keep_their_option(void **state)
{
  SamHistory h;

  (void)state;
  Write("time,load_tx\n1,2\n2,3\n");
  h = Read("-history test_history.csv -load_n 50 -rot_x 1e-4 -disp_y -2e-6");
  for (PetscInt k = 0; k < 2; k++) {
    const SamControl step = StepOf(h, k);

    sam_assert(step.force[SAM_COMPONENT_N] && step.value[SAM_COMPONENT_N] == 50);
    sam_assert(!step.force[SAM_COMPONENT_MX] && step.value[SAM_COMPONENT_MX] == 1e-4);
    sam_assert(step.force[SAM_COMPONENT_MY] && step.value[SAM_COMPONENT_MY] == 0);
    sam_assert(step.force[SAM_COMPONENT_TX] && step.value[SAM_COMPONENT_TX] == 2 + (double)k);
    sam_assert(!step.force[SAM_COMPONENT_TY] && step.value[SAM_COMPONENT_TY] == -2e-6);
    sam_assert(step.force[SAM_COMPONENT_MZ] && step.value[SAM_COMPONENT_MZ] == 0);
  }
  sam_call(SamHistoryDestroy(&h));
}

static void test_step_holds_nothing_but_time_and_control(void **state)
{
  SamHistory h    = Read("-load_n 3 -disp_x 1e-6 -steps 2");
  SamControl step = StepOf(h, 1);

  (void)state;
  sam_assert(step.value[SAM_COMPONENT_TY] == 0 && step.value[SAM_COMPONENT_MX] == 0);
  for (PetscInt k = 0; k < SamConditionsCount(Conditions()); k++)
    sam_assert(SamControlGet(&step, SamConditionsGet(Conditions(), k)) == SamConditionsGet(Conditions(), k)->usual);
  sam_call(SamHistoryDestroy(&h));
}

static void test_without_a_file_there_is_one_step_at_time_one(void **state)
{
  SamHistory h = Read("-load_n 3 -load_mz -0.5");

  (void)state;
  sam_assert(CountOf(h) == 1);
  sam_assert(StepOf(h, 0).time == 1 && StepOf(h, 0).value[SAM_COMPONENT_N] == 3 &&
             StepOf(h, 0).value[SAM_COMPONENT_MZ] == -0.5);
  sam_call(SamHistoryDestroy(&h));
}

/* ---- increments ---- */

static void test_increments_lie_on_the_line_between_rows(void **state)
{
  SamHistory h;

  (void)state;
  Write("time,load_n,disp_x,load_mz\n2,100,1e-6,0\n3,40,-3e-6,0.5\n7,40,0,-0.25\n");
  h = Read("-history test_history.csv -steps 4 -rot_x 1e-3");
  sam_assert(CountOf(h) == 12);
  for (PetscInt k = 0; k < 12; k++) {
    static const double rows[4][4] = {{0, 0, 0, 0}, {2, 100, 1e-6, 0}, {3, 40, -3e-6, 0.5}, {7, 40, 0, -0.25}};
    const double       *a = rows[k / 4], *b = rows[k / 4 + 1], t = (double)(k % 4 + 1) / 4;
    const SamControl    step = StepOf(h, k);

    /* 1e-15 of the larger end: rounding */
    sam_assert_close(step.time, a[0] + t * (b[0] - a[0]), 1e-14);
    sam_assert_close(step.value[SAM_COMPONENT_N], a[1] + t * (b[1] - a[1]), 1e-13);
    sam_assert_close(step.value[SAM_COMPONENT_TX], a[2] + t * (b[2] - a[2]), 1e-21);
    sam_assert_close(step.value[SAM_COMPONENT_MZ], a[3] + t * (b[3] - a[3]), 1e-15);
    sam_assert_close(step.value[SAM_COMPONENT_MX], 1e-3 * (k < 4 ? t : 1), 1e-18); /* a constant begins at zero, too */
    sam_assert(!step.force[SAM_COMPONENT_MX] && !step.force[SAM_COMPONENT_TX]);
  }
  sam_call(SamHistoryDestroy(&h));
}

/* The ends found one from the other are those whose time, or that of the step before, is a row's, or the start's. */
static void test_ends_of_rows_follow_each_other(void **state)
{
  (void)state;
  for (int steps = 1; steps < 5; steps++) {
    char       text[64];
    SamHistory h;
    PetscInt   end = 0;

    Write("time,load_n\n1,1\n2,3\n3,2\n4,5\n");
    (void)snprintf(text, sizeof(text), "-history test_history.csv -steps %d", steps);
    h = Read(text);
    for (PetscInt k = 0; k < CountOf(h); k++) {
      const PetscReal time = StepOf(h, k).time, before = k ? StepOf(h, k - 1).time : 0;
      const int       is_end = k == 0 || time == floor(time) || before == floor(before);

      sam_assert((k == end) == is_end);
      if (k == end) end = SamHistoryNextEnd(h, k);
    }
    sam_assert(end == CountOf(h));
    sam_call(SamHistoryDestroy(&h));
  }
}

static void test_increments_end_on_the_row_exactly(void **state)
{
  static const double n[3] = {0.1, 0.7, 1.0 / 3}, time[3] = {0.3, 0.4, 1e9};
  char                text[256], *end                     = text;
  SamHistory          h;

  (void)state;
  end += sprintf(end, "time,load_n\n");
  for (int k = 0; k < 3; k++) end += sprintf(end, "%.17g,%.17g\n", time[k], n[k]);
  Write(text);
  h = Read("-history test_history.csv -steps 7 -load_ty 0.1");
  for (int k = 0; k < 3; k++)
    sam_assert(StepOf(h, 7 * k + 6).time == time[k] && StepOf(h, 7 * k + 6).value[SAM_COMPONENT_N] == n[k] &&
               StepOf(h, 7 * k + 6).value[SAM_COMPONENT_TY] == 0.1);
  sam_call(SamHistoryDestroy(&h));
}

static void test_constant_load_does_not_change_between_rows(void **state)
{
  SamHistory h;

  (void)state;
  Write("time,load_n,load_tx\n1,0.1,0\n2,0.1,0.7\n3,0.1,0\n");
  h = Read("-history test_history.csv -steps 7 -load_ty 0.3");
  for (PetscInt k = 7; k < 21; k++)
    sam_assert(StepOf(h, k).value[SAM_COMPONENT_N] == 0.1 &&
               StepOf(h, k).value[SAM_COMPONENT_TY] == 0.3); /* not even by rounding */
  sam_call(SamHistoryDestroy(&h));
}

static void test_single_load_is_divided(void **state)
{
  SamHistory h = Read("-disp_z 4e-6 -load_tx -10 -steps 5");

  (void)state;
  sam_assert(CountOf(h) == 5);
  for (PetscInt k = 0; k < 5; k++) {
    const SamControl step = StepOf(h, k);

    sam_assert_close(step.time, 0.2 * ((double)k + 1), 1e-15);
    sam_assert_close(step.value[SAM_COMPONENT_N], 0.8e-6 * ((double)k + 1), 1e-21);
    sam_assert_close(step.value[SAM_COMPONENT_TX], -2 * ((double)k + 1), 1e-14);
  }
  sam_call(SamHistoryDestroy(&h));
}

/* Before the first row: time 0, or as far before it as the second row is after it, or 1 s. */
static void test_first_row_has_a_start(void **state)
{
  const struct {
    const char *text;
    double      start, end;
  } cases[] = {{"time,load_n\n3,10\n4,10\n", 0, 3},      {"time,load_n\n3,10\n", 0, 3},
               {"time,load_n\n0,10\n0.5,10\n", -0.5, 0}, {"time,load_n\n0,10\n", -1, 0},
               {"time,load_n\n-2,10\n1,10\n", -5, -2},   {"time,load_n\n-2,10\n", -3, -2},
               {"time,load_n\n1e-9,10\n9,1\n", 0, 1e-9}};

  (void)state;
  for (size_t c = 0; c < sizeof(cases) / sizeof(cases[0]); c++) {
    SamHistory h;
    double     last = cases[c].start;

    Write(cases[c].text);
    h = Read("-history test_history.csv -steps 4");
    for (PetscInt k = 0; k < 4; k++) {
      const SamControl step = StepOf(h, k);

      sam_assert_close(step.time, cases[c].start + (cases[c].end - cases[c].start) * ((double)k + 1) / 4,
                       1e-15 * PetscMax(1, fabs(cases[c].start)));
      sam_assert(step.time > last);
      sam_assert_close(step.value[SAM_COMPONENT_N], 2.5 * ((double)k + 1), 1e-14);
      last = step.time;
    }
    sam_call(SamHistoryDestroy(&h));
  }
}

/* ---- friction ---- */

static PetscReal FrictionOf(SamHistory h, PetscInt k)
{
  const SamControl step = StepOf(h, k);

  return ConditionOf(&step, "friction_scale");
}

static PetscBool Gives(SamHistory h, const char condition[])
{
  return SamHistoryGives(h, SamConditionsFind(Conditions(), condition));
}

static void test_friction_scale_is_one_without_its_column(void **state)
{
  SamHistory h = Read("-load_n 1 -steps 3");

  (void)state;
  sam_assert(!Gives(h, "friction_scale"));
  for (PetscInt k = 0; k < 3; k++) sam_assert(FrictionOf(h, k) == 1);
  sam_call(SamHistoryDestroy(&h));
}

/* The first row's friction holds from the start: friction does not grow from zero as loads do. */
static void test_friction_scale_is_interpolated_between_rows(void **state)
{
  static const double rows[4] = {0.5, 0.5, 2, 0};
  SamHistory          h;

  (void)state;
  Write("time,friction_scale,load_n\n1,0.5,1\n2,2,1\n3,0,1\n");
  h = Read("-history test_history.csv -steps 4");
  sam_assert(Gives(h, "friction_scale"));
  for (PetscInt k = 0; k < 12; k++) {
    const double t = (double)(k % 4 + 1) / 4;

    sam_assert_close(FrictionOf(h, k), rows[k / 4] + t * (rows[k / 4 + 1] - rows[k / 4]), 1e-15);
  }
  sam_assert(FrictionOf(h, 7) == 2 && FrictionOf(h, 11) == 0); /* the rows' own */
  sam_call(SamHistoryDestroy(&h));
}

/* ---- bulk stress ---- */

/* It grows from zero, as loads do; one that is an option then stays. */
static void test_bulk_stress_goes_from_row_to_row(void **state)
{
  static const double xy[4] = {0, 1e6, -3e6, 0};
  SamHistory          h;

  (void)state;
  Write("time,bulk1_stress_xy\n1,1e6\n2,-3e6\n3,0\n");
  h = Read("-history test_history.csv -steps 4 -load_n 1 -bulk2_stress_yy 8e6");
  sam_assert(Gives(h, "bulk1_stress_xx"));
  for (PetscInt k = 0; k < 12; k++) {
    const SamControl step = StepOf(h, k);
    const double     t    = (double)(k % 4 + 1) / 4;

    sam_assert_close(ConditionOf(&step, "bulk1_stress_xy"), xy[k / 4] + t * (xy[k / 4 + 1] - xy[k / 4]), 1e-8);
    sam_assert_close(ConditionOf(&step, "bulk2_stress_yy"), k < 4 ? 8e6 * t : 8e6, 1e-8);
    sam_assert(ConditionOf(&step, "bulk1_stress_xx") == 0 && ConditionOf(&step, "bulk2_stress_xy") == 0);
  }
  sam_call(SamHistoryDestroy(&h));
  h = Read("-history test_history.csv -load_n 1");
  sam_assert(Gives(h, "bulk1_stress_xx"));
  sam_call(SamHistoryDestroy(&h));
  h = Read("-load_n 1 -bulk2_stress_yy 0");
  sam_assert(!Gives(h, "bulk1_stress_xx"));
  sam_call(SamHistoryDestroy(&h));
}

/* ---- the option ---- */

static void test_option_has_a_second_name(void **state)
{
  SamHistory h;

  (void)state;
  Write("time,load_n\n1,100\n2,50\n");
  h = Read("-load_history test_history.csv");
  sam_assert(CountOf(h) == 2 && StepOf(h, 1).value[SAM_COMPONENT_N] == 50);
  sam_call(SamHistoryDestroy(&h));
}

static void test_options_have_the_prefix(void **state)
{
  const SamOptions from = {PETSC_COMM_WORLD, "a_"};
  SamHistory       h;

  (void)state;
  Write("time,load_tx\n1,5\n2,6\n");
  SetHistoryOptions("-load_n 1 -steps 7 -a_load_n 2 -a_steps 3 -a_load_history test_history.csv");
  sam_call(SamHistoryCreateFromOptions(&from, NULL, Conditions(), &h));
  SetHistoryOptions("");
  sam_assert(CountOf(h) == 6 && StepOf(h, 5).value[SAM_COMPONENT_N] == 2 && StepOf(h, 5).value[SAM_COMPONENT_TX] == 6);
  sam_call(SamHistoryDestroy(&h));
}

static void test_file_is_not_written_to(void **state)
{
  static const char text[] = "time,load_n\n1,2\n";
  SamHistory        h;
  int               good = 1;

  (void)state;
  Write(text);
  h = Read("-history test_history.csv");
  sam_call(SamHistoryDestroy(&h));
  if (Rank() == 0) {
    char   read[64];
    FILE  *stream = fopen(file, "rb");
    size_t size   = stream ? fread(read, 1, sizeof(read), stream) : 0;

    good = size == sizeof(text) - 1 && !memcmp(read, text, size);
    if (stream) (void)fclose(stream);
  }
  sam_assert(good);
}

static void test_petsc_does_not_see_the_claimed_option(void **state)
{
  PetscBool set;

  (void)state;
  SetHistoryOptions("-history test_history.csv");
  sam_call(PetscOptionsHasName(NULL, NULL, "-history", &set));
  sam_assert(!set);
  SetHistoryOptions("");
}

static void test_history_on_one_rank_is_its_own(void **state)
{
  const SamOptions myself = {PETSC_COMM_SELF, NULL};
  SamHistory       h;
  char             name[64], options[128];
  FILE            *stream;
  int              good;

  (void)state;
  (void)snprintf(name, sizeof(name), "test_history_%d.csv", Rank());
  (void)snprintf(options, sizeof(options), "-history %s", name);
  stream = fopen(name, "w");
  good   = stream && fprintf(stream, "time,load_n\n") > 0;
  for (int k = 0; k <= Rank() && good; k++) good = fprintf(stream, "%d,5\n", k) > 0;
  if (stream) (void)fclose(stream);
  sam_assert(good);
  SetHistoryOptions(options);
  good = !SamHistoryCreateFromOptions(&myself, NULL, Conditions(), &h) && SamHistoryGetCount(h) == Rank() + 1 &&
         !SamHistoryDestroy(&h);
  SetHistoryOptions("");
  (void)unlink(name);
  sam_assert(good);
}

static void test_destroying_nothing_is_allowed(void **state)
{
  SamHistory h = NULL;

  (void)state;
  sam_call(SamHistoryDestroy(&h));
  h = Read("-load_n 1");
  sam_call(SamHistoryDestroy(&h));
  sam_assert(h == NULL);
  RemoveFile(file);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_rows_are_steps),
    cmocka_unit_test(test_columns_may_stand_in_any_order),
    cmocka_unit_test(test_comments_and_empty_lines_count_for_nothing),
    cmocka_unit_test(test_white_space_around_fields_counts_for_nothing),
    cmocka_unit_test(test_lines_may_end_in_carriage_return_and_newline),
    cmocka_unit_test(test_last_line_needs_no_newline),
    cmocka_unit_test(test_numbers_may_be_scientific),
    cmocka_unit_test(test_numbers_are_read_to_the_last_digit),
    cmocka_unit_test(test_long_files_and_lines_are_read_whole),
    cmocka_unit_test(test_each_column_controls_its_component),
    cmocka_unit_test(test_components_without_a_column_keep_their_option),
    cmocka_unit_test(test_step_holds_nothing_but_time_and_control),
    cmocka_unit_test(test_without_a_file_there_is_one_step_at_time_one),
    cmocka_unit_test(test_increments_lie_on_the_line_between_rows),
    cmocka_unit_test(test_ends_of_rows_follow_each_other),
    cmocka_unit_test(test_increments_end_on_the_row_exactly),
    cmocka_unit_test(test_constant_load_does_not_change_between_rows),
    cmocka_unit_test(test_single_load_is_divided),
    cmocka_unit_test(test_first_row_has_a_start),
    cmocka_unit_test(test_friction_scale_is_one_without_its_column),
    cmocka_unit_test(test_friction_scale_is_interpolated_between_rows),
    cmocka_unit_test(test_bulk_stress_goes_from_row_to_row),
    cmocka_unit_test(test_option_has_a_second_name),
    cmocka_unit_test(test_options_have_the_prefix),
    cmocka_unit_test(test_file_is_not_written_to),
    cmocka_unit_test(test_petsc_does_not_see_the_claimed_option),
    cmocka_unit_test(test_history_on_one_rank_is_its_own),
    cmocka_unit_test(test_destroying_nothing_is_allowed),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

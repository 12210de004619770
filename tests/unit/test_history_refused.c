/*
 * Load histories that are malformed or contradict the options are refused, with the file and the line.
 */
#include "histories.h"

/* ---- malformed files ---- */

static void test_unknown_columns_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,load_x\n1,2\n", 1, "load_x");
  AssertMalformed("# loads\n\ntime,load_tx,friction\n1,2,0.1\n", 3, "unknown column friction;");
  sam_assert(strstr(CaughtMessage(), "expected time, load_n, load_tx,") && strstr(CaughtMessage(), ", rot_z,") &&
             strstr(CaughtMessage(), "friction_scale, bulk1_stress_xx ... bulk2_stress_xy")); /* what may stand there */
  AssertMalformed("time,Load_tx\n1,2\n", 1, "Load_tx");
  AssertMalformed("time,-load_tx\n1,2\n", 1, "-load_tx");
  AssertMalformed("time,\"load_tq\"\n1,2\n", 1, "load_tx");
  AssertMalformed("time,load_tx load_ty\n1,2\n", 1, "load_tx load_ty");
  AssertMalformed("time,load_txx\n1,2\n", 1, "load_txx");
  AssertMalformed("time,a_name_that_is_longer_than_any_of_the_columns_that_there_are\n1,2\n", 1,
                  "a_name_that_is_longer");
}

static void test_columns_without_a_name_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,,load_tx\n1,2,3\n", 1, "column");
  AssertMalformed("time,load_tx,\n1,2,\n", 1, "column");
  AssertMalformed(",time\n1,2\n", 1, "column");
  AssertMalformed("time,load_tx, # load_ty\n1,2,3\n", 1, "column");
}

static void test_columns_given_twice_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,load_tx,load_tx\n1,2,2\n", 1, "load_tx");
  AssertMalformed("\ntime,load_tx, time\n1,2,1\n", 2, "time");
}

static void test_file_without_times_is_refused(void **state)
{
  (void)state;
  AssertMalformed("load_tx\n1\n2\n", 1, "time");
  AssertMalformed("# no header\n1,2,3\n2,3,4\n", 2, "time");
  AssertMalformed("Time,load_tx\n1,2\n", 1, "time");
}

/* What is wrong with the names is said first, whatever else is wrong, with the name that is meant. */
static void test_units_and_misspelled_names_are_said_first(void **state)
{
  static const struct {
    const char *column, *meant;
  } names[] = {{"load_n [N]", "no unit, as all values are in SI units: is load_n meant?"},
               {"load_n (N)", "is load_n meant?"},
               {"load_tx/N", "is load_tx meant?"},
               {"'load_n'", "is load_n meant?"},
               {"Load_N", "is load_n meant?"},
               {"laod_n", "is load_n meant?"},
               {"-disp_z", "is disp_z meant?"},
               {"friction_skale", "is friction_scale meant?"}};

  (void)state;
  for (size_t k = 0; k < sizeof(names) / sizeof(names[0]); k++) {
    char text[96];

    (void)snprintf(text, sizeof(text), "time,%s\n1,abc\n0,2\n", names[k].column);
    Write(text);
    AssertRefused("-history test_history.csv", SAM_ERR_USER, "test_history.csv, line 1: unknown column",
                  names[k].column);
    sam_assert(strstr(CaughtMessage(), names[k].meant) && strstr(CaughtMessage(), "expected time, load_n,"));
  }
  Write("time load_n [N]\n1 2\n");
  AssertRefused("-history test_history.csv", SAM_ERR_USER, "unknown column [N]", "no unit");
  AssertMalformed("0,1\n1,2\n", 1, "the first line must name the columns");
  AssertMalformed("time,depth\n1,2\n", 1, "unknown column depth; expected time");
}

/* Separators are those of the first line. */
static void test_mixed_separators_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time;load_tx\n1,2\n", 2, "decimal point, not a comma");
  AssertMalformed("time;load_tx\n1;2,5\n", 2, "decimal point, not a comma");
  AssertMalformed("time load_tx\n1 2,5\n", 2, "decimal point, not a comma");
  AssertMalformed("time,load_tx\n1,2\n2,2,5\n", 3, "a comma separates columns, numbers have a decimal point");
  AssertMalformed("time;load_tx\n1 2\n", 2, "\"1 2\"");
  AssertMalformed("time;;load_tx\n1;2;3\n", 1, "column");
  AssertMalformed("time\tload_tx\n1\t2\t3\n", 2, "3 fields");
}

static void test_too_many_columns_are_refused(void **state)
{
  char text[512] = "time", *end = text + 4;

  (void)state;
  for (int k = 0; k < 40; k++) end += sprintf(end, ",c%d", k);
  (void)sprintf(end, "\n1\n");
  AssertMalformed(text, 1, "column");
}

static void test_ragged_rows_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,load_tx,load_ty\n1,2,3\n2,3\n", 3, "2 fields");
  AssertMalformed("time,load_tx\n1,2\n\n# well\n2,3,4\n", 5, "3 fields");
  AssertMalformed("time,load_tx\n1,2\n2\n", 3, "field");
  AssertMalformed("time,load_tx\n1,2\n2,3,\n", 3, "field");
  AssertMalformed("time,load_tx\n1,2\n2,3,abc\n", 3, "field");
}

static void test_text_for_a_number_is_refused(void **state)
{
  static const char *const texts[] = {"abc", "1x", "1 2", "1e", "--1", "1.2.3", "5N", "1;2", "1/2", "e5", "1_000", "-"};

  (void)state;
  for (size_t k = 0; k < sizeof(texts) / sizeof(texts[0]); k++) {
    char text[64];

    (void)snprintf(text, sizeof(text), "time,load_tx\n1,2\n2,%s\n", texts[k]);
    AssertMalformed(text, 3, texts[k]);
    sam_assert(strstr(CaughtMessage(), "load_tx"));
    (void)snprintf(text, sizeof(text), "time,load_tx\n%s,2\n", texts[k]);
    AssertMalformed(text, 2, texts[k]);
    sam_assert(strstr(CaughtMessage(), "time"));
  }
}

static void test_numbers_that_are_not_finite_are_refused(void **state)
{
  static const char *const texts[] = {"nan", "NaN", "-nan", "nan(1)", "inf", "-inf", "+Infinity", "1e400", "-1e999"};

  (void)state;
  for (size_t k = 0; k < sizeof(texts) / sizeof(texts[0]); k++) {
    char text[64];

    (void)snprintf(text, sizeof(text), "time,load_tx\n1,2\n2,%s\n", texts[k]);
    AssertMalformed(text, 3, texts[k]);
    (void)snprintf(text, sizeof(text), "time,load_tx\n1,2\n%s,3\n", texts[k]);
    AssertMalformed(text, 3, texts[k]);
  }
}

static void test_empty_fields_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,load_tx,load_ty\n1,,3\n", 2, "load_tx");
  AssertMalformed("time,load_tx,load_ty\n1,2,3\n2,2,\n", 3, "load_ty");
  AssertMalformed("time,load_tx\n,3\n", 2, "time");
  AssertMalformed("time,load_tx\n1,   \n", 2, "load_tx");
  AssertMalformed("time,load_tx\n1,# 2\n", 2, "load_tx");
  AssertMalformed("time,load_tx\n,\n", 2, "time");
}

static void test_times_that_do_not_increase_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,load_tx\n1,2\n1,3\n", 3, "time");
  AssertMalformed("time,load_tx\n1,2\n2,3\n\n1.5,3\n", 5, "time");
  AssertMalformed("load_tx,time\n1,-1\n2,-2\n", 3, "time");
  AssertMalformed("time,load_tx\n0,2\n-0.0,3\n", 3, "time");
}

static void test_times_of_steps_that_no_number_can_tell_apart_are_refused(void **state)
{
  (void)state;
  Write("time,load_tx\n1e17,1\n100000000000000064,2\n");
  AssertRefused("-history test_history.csv -load_n 1 -steps 100", SAM_ERR_USER,
                "test_history.csv, line 3:", "-steps 100");
  Write("time,load_tx\n-1.7e308,1\n1.7e308,2\n");
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line ", "time");
  Write("time,load_tx\n1e-320,1\n1.1e-320,2\n");
  AssertRefused("-history test_history.csv -load_n 1 -steps 10000", SAM_ERR_USER, "test_history.csv, line ", "time");
  Write("time,load_tx\n1,-1.7e308\n2,1.7e308\n");
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line 3:", "load_tx");
}

static void test_negative_normal_forces_are_refused(void **state)
{
  (void)state;
  Write("time,load_n\n1,2\n2,-1e-9\n");
  AssertRefused("-history test_history.csv", SAM_ERR_USER, "test_history.csv, line 3:", "load_n");
  Write("load_n,time\n-5,1\n");
  AssertRefused("-history test_history.csv", SAM_ERR_USER, "test_history.csv, line 2:", "load_n");
  Write("time,disp_z\n1,-1e-6\n"); /* a displacement may be */
  {
    SamHistory h = Read("-history test_history.csv");

    sam_assert(StepOf(h, 0).value[SAM_COMPONENT_N] == -1e-6);
    sam_call(SamHistoryDestroy(&h));
  }
}

static void test_negative_friction_scales_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,friction_scale\n1,1\n2,-1e-9\n", 3, "friction_scale");
  AssertMalformed("time,friction_scale\n1,nan\n", 2, "friction_scale");
}

static void test_both_columns_of_a_pair_are_refused(void **state)
{
  (void)state;
  for (PetscInt k = 0; k < 6; k++) {
    char text[64];

    (void)snprintf(text, sizeof(text), "# pair\ntime,%s,%s\n1,1,0\n", NameOf(k, PETSC_FALSE), NameOf(k, PETSC_TRUE));
    Write(text);
    AssertRefused(k ? "-history test_history.csv -load_n 1" : "-history test_history.csv", SAM_ERR_USER,
                  "test_history.csv, line 2:", NameOf(k, PETSC_FALSE));
    sam_assert(strstr(CaughtMessage(), NameOf(k, PETSC_TRUE)));
  }
}

static void test_names_in_options_and_file_are_refused(void **state)
{
  (void)state;
  for (PetscInt k = 0; k < 6; k++)
    for (int by_column = 0; by_column < 2; by_column++)
      for (int by_option = 0; by_option < 2; by_option++) {
        const char *column = NameOf(k, by_column ? PETSC_TRUE : PETSC_FALSE),
                   *option = NameOf(k, by_option ? PETSC_TRUE : PETSC_FALSE);
        char text[64], options[96], dashed[32];

        (void)snprintf(text, sizeof(text), "time,%s\n1,1\n", column);
        (void)snprintf(options, sizeof(options), "-history test_history.csv -%s 1%s", option, k ? " -load_n 1" : "");
        (void)snprintf(dashed, sizeof(dashed), "-%s", option);
        Write(text);
        AssertRefused(options, SAM_ERR_USER, dashed, "test_history.csv");
        sam_assert(strstr(CaughtMessage(), column));
      }
}

static void test_both_options_of_a_pair_are_refused(void **state)
{
  (void)state;
  AssertRefused("-load_n 1 -disp_z 1e-6", SAM_ERR_USER, "-load_n", "-disp_z");
  AssertRefused("-load_n 1 -load_mz 1e-3 -rot_z 0", SAM_ERR_USER, "-load_mz", "-rot_z");
}

static void test_neither_normal_force_nor_approach_is_refused(void **state)
{
  (void)state;
  Write("time,load_tx\n1,2\n");
  AssertRefused("-history test_history.csv", SAM_ERR_USER, "-load_n", "-disp_z");
  AssertRefused("", SAM_ERR_USER, "-load_n", "-disp_z");
}

static void test_files_without_a_step_are_refused(void **state)
{
  static const char *const texts[] = {
    "", "\n\n", "# nothing\n", "time,load_n\n", "time,load_n", "time,load_n\n# 1,2\n\n"};

  (void)state;
  for (size_t k = 0; k < sizeof(texts) / sizeof(texts[0]); k++) {
    Write(texts[k]);
    AssertRefused("-history test_history.csv", SAM_ERR_USER, "test_history.csv", "no row");
  }
}

/* A crash may leave blocks of zeros in a file; the text after one must not be ignored silently. */
static void test_zero_bytes_are_refused(void **state)
{
  static const char inside[] = "time,load_tx\n1,2\0 000\n", block[] = "time,load_tx\n1,2\n\0\0\0\0\0\0\0\0\n3,4\n",
                    header[] = "time,load_tx\0,load_ty\n1,2\n";

  (void)state;
  WriteBytes(inside, sizeof(inside) - 1);
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line 2", "");
  WriteBytes(block, sizeof(block) - 1);
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line 3", "");
  WriteBytes(header, sizeof(header) - 1);
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line 1", "");
}

static void test_files_that_cannot_be_read_are_told(void **state)
{
  (void)state;
  AssertRefused("-history test_history_none.csv -load_n 1", SAM_ERR_FILE, "-history test_history_none.csv",
                "cannot be read");
  AssertRefused("-history . -load_n 1", SAM_ERR_FILE, "-history .", "cannot be read");
  AssertRefused("-history test_history_none/a.csv -load_n 1", SAM_ERR_FILE, "-history test_history_none/a.csv",
                "cannot be read");
}

static void test_history_without_a_name_is_refused(void **state)
{
  (void)state;
  AssertRefused("-history -load_n 1", SAM_ERR_USER, "-history", "expected");
}

static void test_wrong_numbers_of_increments_are_refused(void **state)
{
  (void)state;
  AssertRefused("-load_n 1 -steps 0", SAM_ERR_USER, "-steps", "expected");
  AssertRefused("-load_n 1 -steps -3", SAM_ERR_USER, "-steps", "expected");
  AssertRefused("-load_n 1 -steps 2.5", SAM_ERR_USER, "-steps", "expected");
}

/* Rows times increments must be countable. */
static void test_too_many_steps_are_refused(void **state)
{
  (void)state;
  if (sizeof(PetscInt) > 4) return;
  Write("time,load_n\n1,1\n2,1\n3,1\n");
  AssertRefused("-history test_history.csv -steps 2000000000", SAM_ERR_USER, "-steps", "");
}

/* A refused history leaves nothing behind that disturbs the next one. */
static void test_good_history_is_read_after_a_refused_one(void **state)
{
  (void)state;
  AssertMalformed("time,load_tx\n1,2\n1,3\n", 3, "time");
  AssertPlain("time,load_n,load_tx\n1,100,0\n2.5,100,25\n4,120,-30.5\n");
  RemoveFile(file);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_unknown_columns_are_refused),
    cmocka_unit_test(test_columns_without_a_name_are_refused),
    cmocka_unit_test(test_columns_given_twice_are_refused),
    cmocka_unit_test(test_file_without_times_is_refused),
    cmocka_unit_test(test_units_and_misspelled_names_are_said_first),
    cmocka_unit_test(test_mixed_separators_are_refused),
    cmocka_unit_test(test_too_many_columns_are_refused),
    cmocka_unit_test(test_ragged_rows_are_refused),
    cmocka_unit_test(test_text_for_a_number_is_refused),
    cmocka_unit_test(test_numbers_that_are_not_finite_are_refused),
    cmocka_unit_test(test_empty_fields_are_refused),
    cmocka_unit_test(test_times_that_do_not_increase_are_refused),
    cmocka_unit_test(test_times_of_steps_that_no_number_can_tell_apart_are_refused),
    cmocka_unit_test(test_negative_normal_forces_are_refused),
    cmocka_unit_test(test_negative_friction_scales_are_refused),
    cmocka_unit_test(test_both_columns_of_a_pair_are_refused),
    cmocka_unit_test(test_names_in_options_and_file_are_refused),
    cmocka_unit_test(test_both_options_of_a_pair_are_refused),
    cmocka_unit_test(test_neither_normal_force_nor_approach_is_refused),
    cmocka_unit_test(test_files_without_a_step_are_refused),
    cmocka_unit_test(test_zero_bytes_are_refused),
    cmocka_unit_test(test_files_that_cannot_be_read_are_told),
    cmocka_unit_test(test_history_without_a_name_is_refused),
    cmocka_unit_test(test_wrong_numbers_of_increments_are_refused),
    cmocka_unit_test(test_too_many_steps_are_refused),
    cmocka_unit_test(test_good_history_is_read_after_a_refused_one),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

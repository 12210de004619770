/*
 * Load histories: what is read from a file and the options, how steps divide it, and that a malformed one is refused.
 */
#include "fields.h"

#include <petsam/history.h>
#include <unistd.h>

static const char file[] = "test_history.csv";

/* ---- helpers ---- */

static int Rank(void)
{
  int rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

static void Remove(void)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) (void)unlink(file);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* Rank 0 writes the file; only it needs to see it. */
static void WriteBytes(const char *text, size_t size)
{
  int good = 1;

  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) {
    FILE *stream = fopen(file, "wb");

    good = stream && fwrite(text, 1, size, stream) == size;
    good = stream && !fclose(stream) && good;
  }
  sam_assert(good);
}

static void Write(const char *text)
{
  WriteBytes(text, strlen(text));
}

static void SetOptions(const char *options)
{
  sam_call(PetscOptionsClear(NULL)); /* forgets the alias, too */
  sam_call(SamHistoryClaimOption());
  sam_call(PetscOptionsInsertString(NULL, options));
}

/* The history of the options, or of the file when there are none about it. */
static SamHistory Read(const char *options)
{
  SamHistory h;

  SetOptions(options);
  sam_call(SamHistoryCreateFromOptions(PETSC_COMM_WORLD, &h));
  SetOptions("");
  return h;
}

static PetscInt CountOf(SamHistory h)
{
  PetscInt steps;

  sam_call(SamHistoryGetCount(h, &steps));
  return steps;
}

static SamStep StepOf(SamHistory h, PetscInt k)
{
  SamStep step;

  memset(&step, 0x55, sizeof(step)); /* all of it is to be set */
  sam_call(SamHistoryGetStep(h, k, &step));
  return step;
}

/* The twelve names in the order of SamBalance, without their dash. */
static const char *NameOf(PetscInt component, PetscBool rigid)
{
  return (rigid ? SamRigidNames : SamLoadNames)[component / 3][component % 3];
}

static const SamBalance *BalanceOf(const SamStep *step, PetscInt component)
{
  return component < 3 ? &step->normal : &step->tangential;
}

/* A component of a step as it is controlled. */
static double ValueOf(const SamStep *step, PetscInt component)
{
  const SamBalance *balance = BalanceOf(step, component);

  return balance->force[component % 3] ? balance->load[component % 3] : balance->rigid[component % 3];
}

/* Keeps the first message of an error instead of printing it. */
static char message[4096];

static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *source,
                                  PetscErrorCode code, PetscErrorType type, const char *text, void *context)
{
  (void)comm;
  (void)line;
  (void)function;
  (void)source;
  (void)context;
  if (type == PETSC_ERROR_INITIAL) (void)snprintf(message, sizeof(message), "%s", text);
  return code;
}

/* Refused with that code on all ranks, in one line that has both texts. */
static void AssertRefused(const char *options, PetscErrorCode code, const char *one, const char *other)
{
  SamHistory     h = NULL;
  PetscErrorCode ierr;
  int            good;

  SetOptions(options);
  message[0] = '\0';
  sam_call(PetscPushErrorHandler(KeepMessage, NULL));
  ierr = SamHistoryCreateFromOptions(PETSC_COMM_WORLD, &h);
  sam_call(PetscPopErrorHandler());
  SetOptions("");
  if (h) sam_call(SamHistoryDestroy(&h));
  good = ierr == code && strstr(message, one) && strstr(message, other) && !strchr(message, '\n');
  if (!good)
    print_error("%s: error %d, expected %d with '%s' and '%s': '%s'\n", options, (int)ierr, (int)code, one, other,
                message);
  sam_assert(good);
}

/* A file that is refused for what stands in that line, in words that have `says`. */
static void AssertMalformed(const char *text, int line, const char *says)
{
  char where[64];

  (void)snprintf(where, sizeof(where), "%s, line %d:", file, line);
  Write(text);
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, where, says);
}

/* The same three steps, however they are written. */
static void AssertPlain(const char *text)
{
  static const double expected[3][3] = {{1, 100, 0}, {2.5, 100, 25}, {4, 120, -30.5}}; /* time, N, Tx */
  SamHistory          h;
  int                 good = 1;

  Write(text);
  h = Read("-history test_history.csv");
  sam_assert(CountOf(h) == 3);
  for (PetscInt k = 0; k < 3; k++) {
    const SamStep step = StepOf(h, k);

    good = good && step.time == expected[k][0] && step.normal.load[0] == expected[k][1] &&
           step.tangential.load[0] == expected[k][2];
  }
  if (!good) print_error("read wrongly: %s\n", text);
  sam_assert(good);
  sam_call(SamHistoryDestroy(&h));
}

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
  sam_assert(StepOf(h, 0).time == -1.2345678901234567e-300 && StepOf(h, 0).normal.load[0] == 0.1 &&
             StepOf(h, 0).tangential.load[0] == 4.9e-324);
  sam_assert(StepOf(h, 1).time == 1.7976931348623157e308 && StepOf(h, 1).normal.load[0] == 9007199254740993.0 &&
             StepOf(h, 1).tangential.load[0] == 0);
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
    good = good && StepOf(h, r).time == 0.1 * ((double)r + 1) && StepOf(h, r).normal.load[0] == 7.0 * (double)r;
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
      SamStep    step;

      (void)snprintf(text, sizeof(text), "time,%s\n1,0.25\n", NameOf(component, rigid ? PETSC_TRUE : PETSC_FALSE));
      Write(text);
      h    = Read(component ? "-history test_history.csv -load_n 8" : "-history test_history.csv");
      step = StepOf(h, 0);
      sam_assert(step.normal.kind == SAM_BALANCE_NORMAL && step.tangential.kind == SAM_BALANCE_TANGENTIAL);
      for (PetscInt k = 0; k < 6; k++) {
        sam_assert(BalanceOf(&step, k)->force[k % 3] == (k == component && rigid ? PETSC_FALSE : PETSC_TRUE));
        sam_assert(ValueOf(&step, k) == (k == component ? 0.25 : (k == 0 ? 8 : 0)));
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
    const SamStep step = StepOf(h, k);

    sam_assert(step.normal.force[0] && step.normal.load[0] == 50);
    sam_assert(!step.normal.force[1] && step.normal.rigid[1] == 1e-4);
    sam_assert(step.normal.force[2] && step.normal.load[2] == 0);
    sam_assert(step.tangential.force[0] && step.tangential.load[0] == 2 + (double)k);
    sam_assert(!step.tangential.force[1] && step.tangential.rigid[1] == -2e-6);
    sam_assert(step.tangential.force[2] && step.tangential.load[2] == 0);
  }
  sam_call(SamHistoryDestroy(&h));
}

static void test_step_holds_nothing_but_time_and_control(void **state)
{
  SamHistory h    = Read("-load_n 3 -disp_x 1e-6 -steps 2");
  SamStep    step = StepOf(h, 1), clear;

  (void)state;
  memset(&clear, 0, sizeof(clear));
  sam_assert(step.status == SAM_STATUS_CONVERGED && step.message[0] == '\0' && step.contact_area == 0 &&
             step.dissipated_energy == 0 && step.coupling_iterations == 0);
  sam_assert(step.tangential.load[0] == 0 && step.normal.rigid[0] == 0);
  sam_assert(!memcmp(&step.check, &clear.check, sizeof(clear.check)));
  sam_call(SamHistoryDestroy(&h));
}

static void test_without_a_file_there_is_one_step_at_time_one(void **state)
{
  SamHistory h = Read("-load_n 3 -load_mz -0.5");

  (void)state;
  sam_assert(CountOf(h) == 1);
  sam_assert(StepOf(h, 0).time == 1 && StepOf(h, 0).normal.load[0] == 3 && StepOf(h, 0).tangential.load[2] == -0.5);
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
    const SamStep       step = StepOf(h, k);

    /* 1e-15 of the larger end: rounding */
    sam_assert_close(step.time, a[0] + t * (b[0] - a[0]), 1e-14);
    sam_assert_close(step.normal.load[0], a[1] + t * (b[1] - a[1]), 1e-13);
    sam_assert_close(step.tangential.rigid[0], a[2] + t * (b[2] - a[2]), 1e-21);
    sam_assert_close(step.tangential.load[2], a[3] + t * (b[3] - a[3]), 1e-15);
    sam_assert_close(step.normal.rigid[1], 1e-3 * (k < 4 ? t : 1), 1e-18); /* a constant begins at zero, too */
    sam_assert(!step.normal.force[1] && !step.tangential.force[0]);
  }
  sam_call(SamHistoryDestroy(&h));
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
    sam_assert(StepOf(h, 7 * k + 6).time == time[k] && StepOf(h, 7 * k + 6).normal.load[0] == n[k] &&
               StepOf(h, 7 * k + 6).tangential.load[1] == 0.1);
  sam_call(SamHistoryDestroy(&h));
}

static void test_constant_load_does_not_change_between_rows(void **state)
{
  SamHistory h;

  (void)state;
  Write("time,load_n,load_tx\n1,0.1,0\n2,0.1,0.7\n3,0.1,0\n");
  h = Read("-history test_history.csv -steps 7 -load_ty 0.3");
  for (PetscInt k = 7; k < 21; k++)
    sam_assert(StepOf(h, k).normal.load[0] == 0.1 && StepOf(h, k).tangential.load[1] == 0.3); /* not even by rounding */
  sam_call(SamHistoryDestroy(&h));
}

static void test_single_load_is_divided(void **state)
{
  SamHistory h = Read("-disp_z 4e-6 -load_tx -10 -steps 5");

  (void)state;
  sam_assert(CountOf(h) == 5);
  for (PetscInt k = 0; k < 5; k++) {
    const SamStep step = StepOf(h, k);

    sam_assert_close(step.time, 0.2 * ((double)k + 1), 1e-15);
    sam_assert_close(step.normal.rigid[0], 0.8e-6 * ((double)k + 1), 1e-21);
    sam_assert_close(step.tangential.load[0], -2 * ((double)k + 1), 1e-14);
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
      const SamStep step = StepOf(h, k);

      sam_assert_close(step.time, cases[c].start + (cases[c].end - cases[c].start) * ((double)k + 1) / 4,
                       1e-15 * PetscMax(1, fabs(cases[c].start)));
      sam_assert(step.time > last);
      sam_assert_close(step.normal.load[0], 2.5 * ((double)k + 1), 1e-14);
      last = step.time;
    }
    sam_call(SamHistoryDestroy(&h));
  }
}

/* ---- malformed files ---- */

static void test_unknown_columns_are_refused(void **state)
{
  (void)state;
  AssertMalformed("time,load_x\n1,2\n", 1, "load_x");
  AssertMalformed("# loads\n\ntime,load_tx,friction\n1,2,0.1\n", 3, "friction");
  AssertMalformed("time,Load_tx\n1,2\n", 1, "Load_tx");
  AssertMalformed("time,-load_tx\n1,2\n", 1, "-load_tx");
  AssertMalformed("time,\"load_tx\"\n1,2\n", 1, "load_tx");
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

/* Whichever line is named, the column as it was read shows what is wrong. */
static void test_other_separators_are_refused(void **state)
{
  (void)state;
  Write("time;load_tx\n1;2\n");
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line ", "time;load_tx");
  Write("time load_tx\n1 2\n");
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, "test_history.csv, line ", "time load_tx");
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
  static const char *const texts[] = {"abc", "1x",    "1 2", "1e", "--1",   "1.2.3", "5N",
                                      "1;2", "\"1\"", "1/2", "e5", "1_000", "-"};

  (void)state;
  for (size_t k = 0; k < sizeof(texts) / sizeof(texts[0]); k++) {
    char text[64];

    (void)snprintf(text, sizeof(text), "time,load_tx\n1,2\n2,%s\n", texts[k]);
    AssertMalformed(text, 3, texts[k]);
    sam_assert(strstr(message, "load_tx"));
    (void)snprintf(text, sizeof(text), "time,load_tx\n%s,2\n", texts[k]);
    AssertMalformed(text, 2, texts[k]);
    sam_assert(strstr(message, "time"));
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

    sam_assert(StepOf(h, 0).normal.rigid[0] == -1e-6);
    sam_call(SamHistoryDestroy(&h));
  }
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
    sam_assert(strstr(message, NameOf(k, PETSC_TRUE)));
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
        sam_assert(strstr(message, column));
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
    AssertRefused("-history test_history.csv", SAM_ERR_USER, "test_history.csv", "step");
  }
}

/* Blocks of zeros are what a crash may leave of a file; text behind one must not be lost in silence. */
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

/* A refused history leaves nothing behind that a good one would stumble over. */
static void test_good_history_is_read_after_a_refused_one(void **state)
{
  (void)state;
  AssertMalformed("time,load_tx\n1,2\n1,3\n", 3, "time");
  test_rows_are_steps(state);
}

/* ---- the option ---- */

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
  SetOptions("-history test_history.csv");
  sam_call(PetscOptionsHasName(NULL, NULL, "-history", &set));
  sam_assert(!set);
  SetOptions("");
}

static void test_history_on_one_rank_is_its_own(void **state)
{
  SamHistory h;
  PetscInt   steps;
  char       name[64], options[128];
  FILE      *stream;
  int        good;

  (void)state;
  (void)snprintf(name, sizeof(name), "test_history_%d.csv", Rank());
  (void)snprintf(options, sizeof(options), "-history %s", name);
  stream = fopen(name, "w");
  good   = stream && fprintf(stream, "time,load_n\n") > 0;
  for (int k = 0; k <= Rank() && good; k++) good = fprintf(stream, "%d,5\n", k) > 0;
  if (stream) (void)fclose(stream);
  sam_assert(good);
  SetOptions(options);
  good = !SamHistoryCreateFromOptions(PETSC_COMM_SELF, &h) && !SamHistoryGetCount(h, &steps) && steps == Rank() + 1 &&
         !SamHistoryDestroy(&h);
  SetOptions("");
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
  Remove();
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
    cmocka_unit_test(test_increments_end_on_the_row_exactly),
    cmocka_unit_test(test_constant_load_does_not_change_between_rows),
    cmocka_unit_test(test_single_load_is_divided),
    cmocka_unit_test(test_first_row_has_a_start),
    cmocka_unit_test(test_unknown_columns_are_refused),
    cmocka_unit_test(test_columns_without_a_name_are_refused),
    cmocka_unit_test(test_columns_given_twice_are_refused),
    cmocka_unit_test(test_file_without_times_is_refused),
    cmocka_unit_test(test_other_separators_are_refused),
    cmocka_unit_test(test_too_many_columns_are_refused),
    cmocka_unit_test(test_ragged_rows_are_refused),
    cmocka_unit_test(test_text_for_a_number_is_refused),
    cmocka_unit_test(test_numbers_that_are_not_finite_are_refused),
    cmocka_unit_test(test_empty_fields_are_refused),
    cmocka_unit_test(test_times_that_do_not_increase_are_refused),
    cmocka_unit_test(test_negative_normal_forces_are_refused),
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
    cmocka_unit_test(test_file_is_not_written_to),
    cmocka_unit_test(test_petsc_does_not_see_the_claimed_option),
    cmocka_unit_test(test_history_on_one_rank_is_its_own),
    cmocka_unit_test(test_destroying_nothing_is_allowed),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Results in HDF5: what is written is read back, exactly, with its dimensions and attributes.
 */
#include "results.h"

#include <sys/stat.h>

static void test_file_holds_what_was_written(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Shown s = CreateShown(k);

    WriteFile(&s, filename, "");
    sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
    DestroyShown(&s);
  }
  RemoveFile(filename);
}

static void test_compression_changes_no_value(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Shown       s = CreateShown(k);
    struct stat plain, compressed;

    WriteFile(&s, filename, "");
    sam_assert(Rank() || !stat(filename, &plain));
    WriteFile(&s, filename, "-output x.h5 -output_compress 3");
    sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
    sam_assert(Rank() || !stat(filename, &compressed));
    /* of the large grid, whose values are regular, less than half remains */
    sam_assert(Rank() || k < 2 || compressed.st_size < plain.st_size / 2);
    DestroyShown(&s);
  }
  RemoveFile(filename);
}

static void test_root_has_the_attributes_that_were_set(void **state)
{
  Shown s    = CreateShown(0);
  int   good = 1;

  (void)state;
  WriteFile(&s, filename, "");
  if (Rank() == 0) {
    const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT), cells = H5Dopen2(file, "state", H5P_DEFAULT);

    good = HasReal(file, "friction", friction) && HasText(file, "options", "-a 1\n-b \xc2\xb5m") &&
           HasText(file, "empty", "") && HasText(cells, "flag_meanings", "open stick slip");
    H5Dclose(cells);
    H5Fclose(file);
  }
  sam_assert(good);
  DestroyShown(&s);
  RemoveFile(filename);
}

static void test_file_without_steps_is_good(void **state)
{
  Shown                   s   = CreateShown(0);
  const SamOutputSettings set = SettingsOf(s.contact, "");
  SamOutput               output;
  int                     good = 1;

  (void)state;
  sam_call(SamOutputCreate(s.grid, filename, &set, &output));
  sam_call(SamOutputDestroy(&output));
  if (Rank() == 0) {
    const hid_t file       = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT),
                pressure   = H5Dopen2(file, "pressure", H5P_DEFAULT);
    const hsize_t shape[3] = {0, (hsize_t)s.grid->ny, (hsize_t)s.grid->nx};

    good = HasShape(pressure, 3, shape, 1) && HasAxis(file, "x", s.grid, 0);
    H5Dclose(pressure);
    H5Fclose(file);
  }
  sam_assert(good);
  DestroyShown(&s);
  RemoveFile(filename);
}

/* What a run that is aborted now leaves behind. */
static void test_file_is_complete_after_each_step(void **state)
{
  static const char copy[] = "test_output_copy.h5";

  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Shown                   s   = CreateShown(k);
    const SamOutputSettings set = SettingsOf(s.contact, "");
    SamOutput               output;

    sam_call(SamOutputCreate(s.grid, filename, &set, &output));
    for (int step = 0; step < STEPS; step++) {
      Show(&s, step);
      sam_call(SamOutputWriteStep(output, step != 1));
      (void)MPI_Barrier(PETSC_COMM_WORLD);
      sam_assert(CopyFile(filename, copy));
      sam_assert(IsGood(copy, s.grid, step + 1, step < 2 ? 1 : 2));
    }
    sam_call(SamOutputDestroy(&output));
    DestroyShown(&s);
  }
  RemoveFile(copy);
  RemoveFile(filename);
}

/* ---- columns ---- */

/* Numbers of a column, on rank 0; whether it is there, with so many. */
static int ReadColumn(const char *name, int steps, double values[])
{
  const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT), group = H5Gopen2(file, "history", H5P_DEFAULT);
  int         there = H5Lexists(group, name, H5P_DEFAULT) > 0;

  if (there) {
    const hid_t   dataset = H5Dopen2(group, name, H5P_DEFAULT);
    const hsize_t n       = (hsize_t)steps;

    there =
      HasShape(dataset, 1, &n, 1) && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    if (!there) print_error("/history/%s is not what it should be\n", name);
    H5Dclose(dataset);
  }
  H5Gclose(group);
  H5Fclose(file);
  return there;
}

static void test_optional_columns_are_there_when_asked_for(void **state)
{
  int good = 1;

  (void)state;
  for (int asked = 0; asked < 4; asked++) {
    Shown s = CreateShown(0);

    if (asked & 1) sam_call(SamStateOfferNumber(s.state, "friction_scale", 1));
    for (int n = 0; n < 6 && asked & 2; n++) sam_call(SamStateOfferNumber(s.state, bulk_names[n], 0));
    WriteFile(&s, filename, "");
    sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
    if (Rank() == 0) {
      double values[STEPS] = {0};

      good = good && ReadColumn("friction_scale", STEPS, values) == (asked & 1);
      for (int step = 0; step < STEPS && asked & 1; step++) good = good && values[step] == 10 + step;
      for (int n = 0; n < 6; n++) {
        good = good && ReadColumn(bulk_names[n], STEPS, values) == (asked & 2) / 2;
        for (int step = 0; step < STEPS && asked & 2; step++) good = good && values[step] == 100 * (n + 1) + step;
      }
    }
    sam_assert(good);
    DestroyShown(&s);
  }
  RemoveFile(filename);
}

/* Steps that wait, with fields and without, are in the file after a flush, and when it is closed. */
static void test_steps_that_wait_are_not_lost(void **state)
{
  (void)state;
  for (int flushed = 0; flushed < 2; flushed++) {
    Shown             s   = CreateShown(0);
    SamOutputSettings set = SettingsOf(s.contact, "");
    SamOutput         output;
    PetscInt          steps, saved;
    PetscReal         time;

    set.flush = set.flush_fields = 1e9;
    sam_call(SamOutputCreate(s.grid, filename, &set, &output));
    WriteSteps(&s, output);
    sam_call(SamOutputGetSaved(output, &steps, &saved, &time));
    sam_assert(steps == STEPS && saved == SAVED && time == STEPS - 0.5);
    sam_assert(Rank() || access(filename, F_OK)); /* they do wait, and a file without a step has not its name yet */
    (void)MPI_Barrier(PETSC_COMM_WORLD);
    if (flushed) {
      sam_call(SamOutputFlush(output));
      sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
    }
    sam_call(SamOutputDestroy(&output));
    sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
    DestroyShown(&s);
    RemoveFile(filename);
  }
}

/* A try without equilibrium: what was given is known, and the numbers of solvers; the rest is not. */
static void test_numbers_that_do_not_exist_are_nan(void **state)
{
  static const char *const        known[]   = {"time", "load_n", "load_tx", "disp_y", "normal_iterations", "status"},
                           *const unknown[] = {"disp_z",
                                               "disp_x",
                                               "load_ty",
                                               "rot_z",
                                               "contact_area",
                                               "stick_area",
                                               "dissipated_energy",
                                               "normal_residual",
                                               "tangential_residual",
                                               "equilibrium_residual"};
  Case                            c         = NewCase(Steel(), 40, 1.5, MU, "");
  const SamOutputSettings         set       = SettingsOf(c.contact, "");
  SamControl                      control   = Loads(&c, 1, 1.5, 0, 0);
  SamOutput                       output;
  SamStep                         step;
  int                             good = 1;

  (void)state;
  Displace(&control, SAM_COMPONENT_TY, 1e-7);
  step = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_call(SamOutputCreate(c.s.grid, filename, &set, &output));
  sam_call(SamOutputWriteStep(output, PETSC_FALSE));
  sam_call(SamOutputDestroy(&output));
  for (int k = 0; k < 6 && Rank() == 0; k++) {
    double value = NAN;

    good = good && ReadColumn(known[k], 1, &value) && isfinite(value);
  }
  for (int k = 0; k < 10 && Rank() == 0; k++) {
    double value = 0;

    good = good && ReadColumn(unknown[k], 1, &value) && isnan(value);
  }
  sam_assert(good);
  DestroyCase(&c);
  RemoveFile(filename);
}

/* What is written is the tried step; after it was rejected the committed one. */
static void test_fields_are_those_of_the_tried_step_else_of_the_committed_one(void **state)
{
  Case                    c     = NewCase(Steel(), 37, 1.5, MU, "");
  const SamOutputSettings set   = SettingsOf(c.contact, "");
  const SamControl        first = Loads(&c, 1, 0.2, 0, 0), second = Loads(&c, 0.7, 0.1, 0, 0);
  SamOutput               output;
  double                 *expected[2], *saved = (double *)calloc(2 * 37 * 37, sizeof(*saved));
  int                     good = 1;

  (void)state;
  sam_call(SamOutputCreate(c.s.grid, filename, &set, &output));
  (void)Solve(&c, &first);
  expected[1] = Whole(c.s.grid, 1, SolutionOf(&c)->pressure);
  (void)Try(&c, &second);
  expected[0] = Whole(c.s.grid, 1, SolutionOf(&c)->pressure);
  sam_call(SamOutputWriteStep(output, PETSC_TRUE));
  sam_call(SamContactReject(c.contact));
  sam_call(SamOutputWriteFields(output, 2));
  sam_call(SamOutputDestroy(&output));
  if (Rank() == 0) {
    const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT), p = H5Dopen2(file, "pressure", H5P_DEFAULT);

    good = H5Dread(p, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, saved) >= 0;
    for (int k = 0; k < 2; k++) good = good && !memcmp(saved + 37 * 37 * k, expected[k], 37 * 37 * sizeof(*saved));
    H5Dclose(p);
    H5Fclose(file);
  }
  sam_assert(good);
  free(saved);
  for (int k = 0; k < 2; k++) free(expected[k]);
  DestroyCase(&c);
  RemoveFile(filename);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_file_holds_what_was_written),
    cmocka_unit_test(test_compression_changes_no_value),
    cmocka_unit_test(test_root_has_the_attributes_that_were_set),
    cmocka_unit_test(test_file_without_steps_is_good),
    cmocka_unit_test(test_file_is_complete_after_each_step),
    cmocka_unit_test(test_optional_columns_are_there_when_asked_for),
    cmocka_unit_test(test_steps_that_wait_are_not_lost),
    cmocka_unit_test(test_numbers_that_do_not_exist_are_nan),
    cmocka_unit_test(test_fields_are_those_of_the_tried_step_else_of_the_committed_one),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

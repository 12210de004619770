/*
 * Results that cannot be written: the error is raised on all ranks, and no earlier step is lost.
 */
#include "results.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

static void AssertNotCreated(const char *name, PetscErrorCode expected, const char *word)
{
  Shown                   s   = CreateShown(0);
  const SamOutputSettings set = SettingsOf(s.contact, "");
  SamOutput               output;
  PetscErrorCode          ierr;
  int                     good;

  BeginCatching();
  ierr = SamOutputCreate(s.grid, name, &set, &output);
  EndCatching();
  good = ierr == expected && strstr(CaughtMessage(), word) && !output;
  if (!good) print_error("%s: error %d, %s\n", name, (int)ierr, CaughtMessage());
  sam_assert(good);
  DestroyShown(&s);
}

static void test_names_that_cannot_be_written_are_errors_on_all_ranks(void **state)
{
  (void)state;
  AssertNotCreated("test_output_none/f.h5", SAM_ERR_FILE, "test_output_none/f.h5");
  AssertNotCreated(".", SAM_ERR_FILE, "folder");
  AssertNotCreated("/dev/null", SAM_ERR_FILE, "/dev/null");
  sam_assert(access("test_output_none", F_OK));
}

static void AssertRefused(const char *options, const char *word)
{
  SamOutputSettings set;
  PetscErrorCode    ierr;

  SetOptions(options);
  BeginCatching();
  ierr = SamOutputSettingsSetFromOptions(&set, &(SamOptions){PETSC_COMM_WORLD, NULL});
  EndCatching();
  SetOptions("");
  sam_assert(ierr == SAM_ERR_USER && strstr(CaughtMessage(), word));
}

static void test_wrong_settings_are_refused(void **state)
{
  (void)state;
  AssertRefused("-output_compress 10", "-output_compress");
  AssertRefused("-output_compress fast", "-output_compress");
  AssertRefused("-output_compress -1", "-output_compress");
  AssertRefused("-output_chunk 0", "-output_chunk");
}

/* The message lists the fields that there are: also those of laws, and not those of laws that the problem lacks. */
static void test_unknown_field_is_named(void **state)
{
  Shown             s    = CreateShown(0);
  const SamOptions  from = {PETSC_COMM_WORLD, NULL};
  SamOutputSettings set;
  PetscErrorCode    ierr;

  (void)state;
  for (int known = 0; known < 2; known++) {
    SetOptions(known ? "-output_fields all" : "-output_fields pressure,slip_path");
    sam_call(SamOutputSettingsSetFromOptions(&set, &from));
    SetOptions("");
    BeginCatching();
    ierr = SamOutputSettingsPrepare(&set, s.contact, &from);
    EndCatching();
    sam_assert(ierr == (known ? 0 : SAM_ERR_USER));
    if (!known)
      sam_assert(strstr(CaughtMessage(), "unknown field slip_path") && strstr(CaughtMessage(), ", displacement_z,") &&
                 !strstr(CaughtMessage(), ", slip_path"));
  }
  SetOptions("-output_fields slip_pth");
  sam_call(SamOutputSettingsSetFromOptions(&set, &from));
  sam_call(SamOutputSettingsAddLaws(&set, s.problem));
  sam_says(SamOutputSettingsPrepare(&set, s.contact, &from), SAM_ERR_USER, ", slip_path, friction_energy, separated");
  SetOptions("-output_fields pressure,slip_path");
  sam_call(SamOutputSettingsSetFromOptions(&set, &from));
  SetOptions("");
  sam_call(SamOutputSettingsAddLaws(&set, s.problem));
  sam_call(SamOutputSettingsPrepare(&set, s.contact, &from));
  DestroyShown(&s);
}

static void test_failed_creation_leaves_the_old_file(void **state)
{
  Shown s = CreateShown(0);

  (void)state;
  WriteFile(&s, filename, "");
  if (geteuid()) { /* to root everything is writable */
    sam_assert(Rank() || !chmod(filename, 0400));
    AssertNotCreated(filename, SAM_ERR_FILE, filename);
  }
  sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
  DestroyShown(&s);
  RemoveFile(filename);
}

/* Tries to write a step where there is no room for it. */
static void AssertNoRoom(SamOutput output, PetscBool fields)
{
  struct rlimit  usual, small;
  struct stat    status;
  PetscErrorCode ierr;
  int            good;

  sam_assert(!getrlimit(RLIMIT_FSIZE, &usual) && !stat(filename, &status));
  (void)MPI_Barrier(PETSC_COMM_WORLD); /* until all have seen the size */
  small          = usual;
  small.rlim_cur = (rlim_t)status.st_size + 10000;
  sam_assert(signal(SIGXFSZ, SIG_IGN) != SIG_ERR && !setrlimit(RLIMIT_FSIZE, &small));
  BeginCatching();
  ierr = SamOutputWriteStep(output, fields);
  EndCatching();
  good = ierr == SAM_ERR_FILE && strstr(CaughtMessage(), filename) && !setrlimit(RLIMIT_FSIZE, &usual);
  sam_assert(good);
}

/*
  A limit on the size of files stands for a full disk. What there was remains, and more can follow when there is room.
*/
static void test_full_disk_is_an_error_on_all_ranks_and_costs_nothing(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Shown                   s   = CreateShown(k);
    const SamOutputSettings set = SettingsOf(s.contact, "");
    SamOutput               output;

    sam_call(SamOutputCreate(s.grid, filename, &set, &output));
    for (int step = 0; step < STEPS; step++) {
      Show(&s, step);
      if (step) AssertNoRoom(output, PETSC_TRUE); /* the first write gives the file its name */
      if (step) AssertNoRoom(output, PETSC_FALSE);
      sam_call(SamOutputWriteStep(output, step != 1));
    }
    PutNumber(&s, "time", 9);
    AssertNoRoom(output, PETSC_TRUE);
    sam_call(SamOutputDestroy(&output));
    sam_assert(IsGood(filename, s.grid, STEPS, SAVED));
    DestroyShown(&s);
  }
  RemoveFile(filename);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_names_that_cannot_be_written_are_errors_on_all_ranks),
    cmocka_unit_test(test_wrong_settings_are_refused),
    cmocka_unit_test(test_unknown_field_is_named),
    cmocka_unit_test(test_failed_creation_leaves_the_old_file),
    cmocka_unit_test(test_full_disk_is_an_error_on_all_ranks_and_costs_nothing),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

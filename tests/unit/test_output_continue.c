/*
 * Results that go on after a stop: what was saved stays to the last bit, what came after the checkpoint goes.
 */
#include "results.h"

#include <sys/stat.h>

static const char copy[] = "test_output_copy.h5";

/* Values that conversions would change: a NaN with something in it, -0, the smallest number, infinity. */
static void PutOddValues(const Shown *s)
{
  static const uint64_t bits[4] = {UINT64_C(0x7ff80000deadbeef), UINT64_C(1) << 63, 1, UINT64_C(0x7ff0000000000000)};
  const Vec             field   = FieldOf(s->state, "displacement_z");
  double               *u;

  sam_call(VecGetArray(field, &u));
  for (PetscInt k = 0; k < PetscMin(s->grid->cells, 4); k++) memcpy(&u[k], &bits[k], sizeof(*u));
  sam_call(VecRestoreArray(field, &u));
}

/* Three steps with all their fields; rank 0 copies the file while it is open. */
static void WriteAndCopy(const Shown *s)
{
  const SamParameters     parameters = NewParameters(friction);
  const SamOutputSettings set        = SettingsOf(s->contact, "");
  SamOutput               output;

  sam_call(SamOutputCreate(s->grid, filename, &set, &output));
  sam_call(SamOutputSetParameters(output, &parameters));
  sam_call(SamOutputSetText(output, "options", "-a 1"));
  for (int step = 0; step < STEPS; step++) {
    Show(s, step);
    PutOddValues(s);
    sam_call(SamOutputWriteStep(output, PETSC_TRUE));
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  sam_assert(CopyFile(filename, copy));
  sam_call(SamOutputDestroy(&output));
}

/* Whether a field's first layers are the same bytes in both files, and there are so many of them. */
static int SameLayers(hid_t one, hid_t other, const char *name, SamGrid grid, hsize_t layers)
{
  const size_t cells = (size_t)grid->nx * (size_t)grid->ny;
  double      *values[2];
  int          good = 1;

  for (int k = 0; k < 2; k++) {
    const hid_t dataset = H5Dopen2(k ? other : one, name, H5P_DEFAULT), type = H5Dget_type(dataset),
                space  = H5Dget_space(dataset);
    const hsize_t size = (hsize_t)H5Sget_simple_extent_npoints(space);

    values[k] = (double *)calloc(size, sizeof(**values));
    good      = good && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values[k]) >= 0;
    if (k == 0) good = good && size == layers * cells;
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(dataset);
  }
  good = good && !memcmp(values[0], values[1], layers * cells * (strcmp(name, "state") ? sizeof(double) : 1));
  free(values[0]);
  free(values[1]);
  if (!good) print_error("/%s differs\n", name);
  return good;
}

/* Whether the file has the fields of the first steps as in the copy. */
static int HasLayersOfCopy(SamGrid grid, hsize_t layers)
{
  hid_t one, other;
  int   good;

  if (Rank()) return 1;
  one   = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  other = H5Fopen(copy, H5F_ACC_RDONLY, H5P_DEFAULT);
  good  = SameLayers(one, other, "state", grid, layers);
  for (int field = 0; field < NUM_FIELDS; field++)
    good = SameLayers(one, other, field_names[field], grid, layers) && good;
  H5Fclose(other);
  H5Fclose(one);
  return good;
}

/* Which file a name is of; the same on all ranks. */
static ino_t InodeOf(const char *name)
{
  struct stat status;

  (void)MPI_Barrier(PETSC_COMM_WORLD);
  sam_assert(!stat(name, &status));
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  return status.st_ino;
}

static int HasFrictionScale(int steps)
{
  static const double expected[STEPS] = {10, 11, 12};
  hid_t               file;
  int                 good;

  if (Rank()) return 1;
  file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  good = HasColumn(file, "friction_scale", "1", expected, steps, 0);
  H5Fclose(file);
  return good;
}

/* The run was killed after the third step, or ended in order; the checkpoint is of the second, or of the third. */
static void test_fields_before_the_checkpoint_stay_byte_by_byte(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++)
    for (int killed = 0; killed < 2; killed++)
      for (PetscInt steps = STEPS - 1; steps <= STEPS; steps++) {
        SamGrid   grid = CreateGrid(k);
        Shown     s    = CreateShown(grid);
        SamOutput output;
        PetscInt  found[2];
        ino_t     inode;

        sam_call(SamStateOfferNumber(s.state, "friction_scale", 1));
        WriteAndCopy(&s);
        if (killed) sam_assert(CopyFile(copy, filename));
        inode = InodeOf(filename);
        sam_call(Continue(&s, friction, steps, 0, &output));
        sam_call(SamOutputGetSaved(output, &found[0], &found[1], NULL));
        sam_assert(found[0] == steps && found[1] == steps);
        sam_call(SamOutputDestroy(&output));
        sam_assert(HasLayersOfCopy(grid, (hsize_t)steps));
        sam_assert(HasFrictionScale((int)steps));
        sam_assert(InodeOf(filename) != inode); /* a copy */
        DestroyShown(&s);
        sam_call(SamGridDestroy(&grid));
      }
  Remove(filename);
  Remove(copy);
}

/* Of a step that failed a run may have written fields of an earlier one, but not those of the step. */
static void test_fields_after_the_checkpoint_go(void **state)
{
  SamGrid   grid = CreateGrid(0);
  Shown     s    = CreateShown(grid);
  SamOutput output;
  PetscInt  found[2];

  (void)state;
  WriteAndCopy(&s);
  sam_call(Continue(&s, friction, STEPS, 0, &output));
  sam_call(SamOutputWriteFields(output, 100));
  sam_call(SamOutputDestroy(&output));
  sam_call(Continue(&s, friction, STEPS, 0, &output));
  sam_call(SamOutputGetSaved(output, &found[0], &found[1], NULL));
  sam_assert(found[0] == STEPS && found[1] == STEPS);
  sam_call(SamOutputDestroy(&output));
  sam_assert(HasLayersOfCopy(grid, STEPS));
  DestroyShown(&s);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
  Remove(copy);
}

/* The file is then as one that was never stopped. */
static void test_continued_results_are_those_of_an_uninterrupted_run(void **state)
{
  (void)state;
  for (int killed = 0; killed < 2; killed++) {
    SamGrid   grid = CreateGrid(0);
    Shown     s    = CreateShown(grid);
    SamOutput output;
    int       good = 1;

    WriteAndCopy(&s); /* of which one step counts */
    if (killed) sam_assert(CopyFile(copy, filename));
    sam_call(Continue(&s, friction, 1, 0, &output));
    for (int step = 1; step < STEPS; step++) {
      Show(&s, step);
      PutOddValues(&s);
      sam_call(SamOutputWriteStep(output, PETSC_TRUE));
    }
    sam_call(SamOutputDestroy(&output));
    sam_assert(HasLayersOfCopy(grid, STEPS));
    if (Rank() == 0) {
      const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);

      good = HasHistory(file, STEPS) && HasText(file, "options", "-a 1") && HasReal(file, "friction", friction);
      H5Fclose(file);
    }
    sam_assert(good);
    DestroyShown(&s);
    sam_call(SamGridDestroy(&grid));
  }
  Remove(filename);
  Remove(copy);
}

static void AssertNotContinued(const Shown *s, PetscReal value, PetscInt steps, PetscReal shift, PetscErrorCode code,
                               const char *word)
{
  SamOutput      output;
  PetscErrorCode ierr;

  BeginCatching();
  ierr = Continue(s, value, steps, shift, &output);
  EndCatching();
  AssertContinueFailed(ierr, output, code, word);
  sam_assert(HasLayersOfCopy(s->grid, STEPS));
}

/* And are left as they were. */
static void test_results_of_another_run_are_refused(void **state)
{
  SamGrid grid = CreateGrid(0);
  Shown   s    = CreateShown(grid);

  (void)state;
  WriteAndCopy(&s);
  AssertNotContinued(&s, 0.25, 2, 0, SAM_ERR_USER, "-friction is 0.5 there, not 0.25");
  AssertNotContinued(&s, friction, 2, 1e-15, SAM_ERR_USER, "times");
  AssertNotContinued(&s, friction, STEPS + 1, 0, SAM_ERR_FILE, "3 of the 4 steps");
  DestroyShown(&s);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
  Remove(copy);
}

/* A fixed parameter that only the file has, unless it belongs to those that may differ. */
static void test_fixed_parameter_that_is_not_given_any_more_is_refused(void **state)
{
  SamGrid             grid = CreateGrid(0);
  Shown               s    = CreateShown(grid);
  const SamParameters none = {.count = 0}, free_ones = {.count = 0, .free = "fric"};
  SamOutput           output = NULL;
  PetscErrorCode      ierr;

  (void)state;
  WriteAndCopy(&s);
  BeginCatching();
  ierr = ContinueWith(&s, &none, 2, 0, &output);
  EndCatching();
  AssertContinueFailed(ierr, output, SAM_ERR_USER, "-friction is given there, and not here");
  sam_assert(HasLayersOfCopy(grid, STEPS));
  sam_call(ContinueWith(&s, &free_ones, 2, 0, &output));
  sam_call(SamOutputDestroy(&output));
  DestroyShown(&s);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
  Remove(copy);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_fields_before_the_checkpoint_stay_byte_by_byte),
    cmocka_unit_test(test_fields_after_the_checkpoint_go),
    cmocka_unit_test(test_continued_results_are_those_of_an_uninterrupted_run),
    cmocka_unit_test(test_results_of_another_run_are_refused),
    cmocka_unit_test(test_fixed_parameter_that_is_not_given_any_more_is_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Results that go on after those of a run with other columns or fields, and a second series beside the history.
 */
#include "results.h"

/* ---- what only one of the two runs has ---- */

/* Of real numbers, whole numbers, and matrices. */
static void DeclareOthers(const Shown *s)
{
  static const SamStateNumber others[] = {
    {"other_real", "Pa2", "of another law", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"other_whole", "1", "of another law", SAM_NUMBER_INT, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"other_matrix", "N/m", "of another law", SAM_NUMBER_MATRIX, 36, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0}};
  PetscInt id;

  for (int k = 0; k < 3; k++) sam_call(SamStateDeclareNumber(s->state, &others[k], &id));
}

static void PutOthers(const Shown *s, int step)
{
  const PetscInt id = SamStateFindNumber(s->state, "other_matrix");

  PutNumber(s, "other_real", 0.25 + step);
  PutNumber(s, "other_whole", 7 + step);
  for (PetscInt k = 0; k < 36; k++) SamStateNumbers(s->state, id, SAM_TRIED)[k] = step + 0.01 * (double)k;
}

/* Whether the columns have values up to step `end` and from step `begin` on, and none between. */
static int HasOthers(int begin, int end)
{
  double real[STEPS], whole[STEPS], matrix[STEPS][36];
  hid_t  file;
  int    good;

  if (Rank()) return 1;
  file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  good = H5LTread_dataset_double(file, "history/other_real", real) >= 0 &&
         H5LTread_dataset_double(file, "history/other_whole", whole) >= 0 &&
         H5LTread_dataset_double(file, "history/other_matrix", &matrix[0][0]) >= 0;
  for (int step = 0; step < STEPS && good; step++) {
    const int has = step < end || step >= begin;

    good = (has ? real[step] == 0.25 + step : isnan(real[step])) && whole[step] == (has ? 7 + step : 0);
    for (int k = 0; k < 36; k++) good = good && (has ? matrix[step][k] == step + 0.01 * k : isnan(matrix[step][k]));
  }
  good = good && HasHistory(file, STEPS);
  H5Fclose(file);
  return good;
}

/* One step of a run that has the columns, or not, then two of one that has not, or has. */
static void test_columns_of_one_run_go_on_without_values(void **state)
{
  (void)state;
  for (int old = 0; old < 2; old++) {
    SamGrid   grid = CreateGrid(0);
    Shown     one = CreateShown(grid), other = CreateShown(grid);
    SamOutput output;

    const SamParameters     parameters = NewParameters(friction);
    const SamOutputSettings set        = SettingsOf(one.contact, "");

    DeclareOthers(old ? &one : &other);
    sam_call(SamOutputCreate(grid, filename, &set, &output));
    sam_call(SamOutputSetParameters(output, &parameters));
    Show(&one, 0);
    if (old) PutOthers(&one, 0);
    sam_call(SamOutputWriteStep(output, PETSC_TRUE));
    sam_call(SamOutputDestroy(&output));
    sam_call(Continue(&other, friction, 1, 0, &output));
    for (int step = 1; step < STEPS; step++) {
      Show(&other, step);
      if (!old) PutOthers(&other, step);
      sam_call(SamOutputWriteStep(output, PETSC_TRUE));
    }
    sam_call(SamOutputDestroy(&output));
    sam_assert(HasOthers(old ? STEPS : 1, old ? 1 : 0));
    DestroyShown(&one);
    DestroyShown(&other);
    sam_call(SamGridDestroy(&grid));
  }
  Remove(filename);
}

/* Its values would end in the middle. */
static void test_field_that_only_the_file_has_is_refused(void **state)
{
  static const SamStateField field = {"other_field", "m",         "of another law", 1,        2,
                                      PETSC_TRUE,    PETSC_FALSE, SAM_RESULT_USUAL, SAM_STAYS};
  SamGrid                    grid  = CreateGrid(0);
  Shown                      one = CreateShown(grid), other = CreateShown(grid);
  const SamParameters        parameters = NewParameters(friction);
  SamOutput                  output     = NULL;
  SamOutputSettings          set;
  PetscErrorCode             ierr;
  PetscInt                   id;

  (void)state;
  sam_call(SamStateDeclareField(one.state, &field, &id));
  set = SettingsOf(one.contact, "-output_fields pressure,other_field");
  sam_call(SamOutputCreate(grid, filename, &set, &output));
  sam_call(SamOutputSetParameters(output, &parameters));
  Show(&one, 0);
  sam_call(SamOutputWriteStep(output, PETSC_TRUE));
  sam_call(SamOutputDestroy(&output));
  BeginCatching();
  ierr = Continue(&other, friction, 1, 0, &output);
  EndCatching();
  AssertContinueFailed(ierr, output, SAM_ERR_USER, "the field other_field");
  sam_call(SamStateDeclareField(other.state, &field, &id));
  sam_call(Continue(&other, friction, 1, 0, &output));
  sam_call(SamOutputDestroy(&output));
  DestroyShown(&one);
  DestroyShown(&other);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
}

/* ---- the second series ---- */

/* A state whose numbers are the rows of a second series. */
static SamState NewCycles(SamGrid grid)
{
  static const SamStateNumber numbers[] = {
    {"cycle", "1", "number of the cycle", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"hidden", "1", "no result", SAM_NUMBER_REAL, 3, PETSC_TRUE, PETSC_FALSE, SAM_JOIN_LAST, 0},
    {"worn", "m3", "volume removed", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0}};
  SamState state;
  PetscInt id;

  sam_call(SamStateCreate(grid, &state));
  for (int k = 0; k < 3; k++) sam_call(SamStateDeclareNumber(state, &numbers[k], &id));
  return state;
}

/* A row of each series. */
static void WriteRows(const Shown *s, SamState cycles, SamOutput output, int k, double worn)
{
  double *const row = SamStateNumbers(cycles, 0, SAM_COMMITTED);

  row[0] = 10 + k;
  row[1] = -1;
  row[4] = worn;
  Show(s, k);
  sam_call(SamOutputWriteStep(output, PETSC_FALSE));
  sam_call(SamOutputWriteCycle(output));
}

static int HasCycles(const double worn[STEPS])
{
  double cycle[STEPS] = {0}, volume[STEPS] = {0};
  hid_t  file, dataset;
  int    good;

  if (Rank()) return 1;
  file    = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  dataset = H5Dopen2(file, "jumps/worn", H5P_DEFAULT);
  good    = HasShape(dataset, 1, (const hsize_t[]){STEPS}, 1) && HasText(dataset, "units", "m3") &&
         H5Lexists(file, "jumps/hidden", H5P_DEFAULT) == 0 &&
         H5LTread_dataset_double(file, "jumps/cycle", cycle) >= 0 &&
         H5LTread_dataset_double(file, "jumps/worn", volume) >= 0;
  for (int k = 0; k < STEPS; k++) good = good && cycle[k] == 10 + k && volume[k] == worn[k];
  H5Dclose(dataset);
  H5Fclose(file);
  return good;
}

/* Two rows of each stay, the third is another. */
static void test_second_series_goes_on(void **state)
{
  SamGrid             grid       = CreateGrid(0);
  Shown               s          = CreateShown(grid);
  SamState            cycles     = NewCycles(grid);
  const SamParameters parameters = NewParameters(friction);
  SamOutputSettings   set        = SettingsOf(s.contact, "");
  SamOutputPoint      point      = {.steps = 2, .cycles = STEPS + 1};
  SamOutput           output     = NULL;
  PetscErrorCode      ierr;

  (void)state;
  set.cycles      = cycles;
  set.cycles_name = "jumps";
  sam_call(SamOutputCreate(grid, filename, &set, &output));
  sam_call(SamOutputSetParameters(output, &parameters));
  for (int k = 0; k < STEPS; k++) WriteRows(&s, cycles, output, k, 0.25 + k);
  sam_call(SamOutputDestroy(&output));
  sam_assert(HasCycles((const double[]){0.25, 1.25, 2.25}));
  for (int k = 0; k < 2; k++) point.times = SamOutputAddTime(point.times, 0.5 + k);
  BeginCatching();
  ierr = SamOutputContinue(grid, filename, &set, &parameters, &point, &output);
  EndCatching();
  AssertContinueFailed(ierr, output, SAM_ERR_FILE, "it holds");
  point.cycles = 2;
  sam_call(SamOutputContinue(grid, filename, &set, &parameters, &point, &output));
  WriteRows(&s, cycles, output, 2, 7);
  sam_call(SamOutputDestroy(&output));
  sam_assert(HasCycles((const double[]){0.25, 1.25, 7}));
  set.cycles      = NULL;
  set.cycles_name = NULL;
  sam_call(SamOutputCreate(grid, filename, &set, &output));
  sam_fails(SamOutputWriteCycle(output), PETSC_ERR_ORDER);
  sam_call(SamOutputDestroy(&output));
  sam_call(SamStateDestroy(&cycles));
  DestroyShown(&s);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_columns_of_one_run_go_on_without_values),
    cmocka_unit_test(test_field_that_only_the_file_has_is_refused),
    cmocka_unit_test(test_second_series_goes_on),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Results in parts, which a restart writes one after another, are read as one; a second series beside the history; rows
 * of zeros.
 */
#include "results.h"

#include <petsam/private/file.h>
#include <petsam/private/parts.h>
#include <petsam/private/results.h>

static const char part_name[] = "test_output.part2.h5";

/* ---- parts ---- */

static void WriteSome(const Shown *s, SamOutput output, int first, int last, double shift)
{
  PetscReal     n[2]       = {(PetscReal)s->grid->nx, (PetscReal)s->grid->ny}, size[2], center[2];
  SamParameters parameters = NewParameters(friction);

  for (int d = 0; d < 2; d++) {
    size[d]   = n[d] * (d ? s->grid->dy : s->grid->dx);
    center[d] = (d ? SamGridY(s->grid, 0) : SamGridX(s->grid, 0)) + 0.5 * (n[d] - 1) * (d ? s->grid->dy : s->grid->dx);
  }
  sam_call(SamParametersAddReals(&parameters, "grid_n", PETSC_TRUE, 2, n));
  sam_call(SamParametersAddReals(&parameters, "grid_size", PETSC_TRUE, 2, size));
  sam_call(SamParametersAddReals(&parameters, "grid_center", PETSC_TRUE, 2, center));
  sam_call(SamOutputSetParameters(output, &parameters));
  for (int step = first; step < last; step++) {
    Show(s, step);
    sam_call(VecShift(FieldOf(s->state, "pressure"), shift));
    sam_call(SamOutputWriteStep(output, PETSC_TRUE));
  }
  sam_call(SamOutputDestroy(&output));
}

/* Asserts that the run has so many steps, and how much larger than shown its pressures are, to rounding. */
static void AssertRun(const Shown *s, PetscInt steps, const double shifts[])
{
  SamResults results;
  SamGrid    grid;
  PetscInt   found[2], step;
  double    *values;
  Vec        pressure = FieldOf(s->state, "pressure");

  sam_call(SamResultsOpen(PETSC_COMM_WORLD, "input", filename, &results));
  grid = SamResultsGetGrid(results);
  sam_call(SamResultsGetSteps(results, &found[0], &found[1]));
  sam_assert(found[0] == steps && found[1] == steps);
  sam_call(PetscMalloc1(grid->cells, &values));
  for (PetscInt k = 0; k < steps; k++) {
    const PetscScalar *shown;
    PetscReal          wrong = 0;

    Show(s, (int)k);
    sam_call(VecShift(pressure, shifts[k]));
    sam_call(SamResultsRead(results, k, "pressure", values));
    sam_call(SamResultsGetSaved(results, k, &step, NULL));
    sam_assert(step == k + 1);
    sam_call(VecGetArrayRead(pressure, &shown));
    for (PetscInt c = 0; c < grid->cells; c++) wrong += shown[c] == values[c] ? 0 : 1;
    sam_call(VecRestoreArrayRead(pressure, &shown));
    sam_call(SamMax(PETSC_COMM_WORLD, 1, &wrong));
    sam_assert(wrong == 0);
  }
  sam_call(PetscFree(values));
  sam_call(SamResultsDestroy(&results));
}

/* Also where the part replaces steps that were there; a file of another run beside it is no part. */
static void test_a_part_counts_up_to_the_next_one(void **state)
{
  (void)state;
  for (int other = 0; other < 2; other++) {
    Shown                   s   = CreateShown(0);
    const SamOutputSettings set = SettingsOf(s.contact, "");
    SamOutput               output;
    uint64_t                identity;

    sam_call(SamOutputCreate(s.grid, filename, &set, &output));
    identity = SamOutputGetIdentity(output);
    WriteSome(&s, output, 0, STEPS, 0);
    sam_call(SamOutputCheckPart(s.grid, filename, identity));
    BeginCatching();
    sam_assert(SamOutputCheckPart(s.grid, filename, identity + 1) == SAM_ERR_USER);
    EndCatching();
    sam_call(SamOutputCreate(s.grid, part_name, &set, &output));
    sam_call(SamOutputFollow(output, identity + (uint64_t)other, 1, 0));
    WriteSome(&s, output, 1, STEPS - 1, 7);
    if (other)
      AssertRun(&s, STEPS, (const double[]){0, 0, 0});
    else
      AssertRun(&s, STEPS - 1, (const double[]){0, 7});
    DestroyShown(&s);
  }
  RemoveFile(filename);
  RemoveFile(part_name);
}

/* Until the first step is written an older file of the name stays. */
static void test_a_file_gets_its_name_when_it_is_complete(void **state)
{
  Shown                   s   = CreateShown(0);
  const SamOutputSettings set = SettingsOf(s.contact, "");
  SamOutput               output;
  uint64_t                identity[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    sam_call(SamOutputCreate(s.grid, filename, &set, &output));
    identity[k] = SamOutputGetIdentity(output);
    if (k) sam_call(SamOutputCheckPart(s.grid, filename, identity[0]));
    sam_call(SamOutputWriteFields(output, 1));
    if (!k) sam_call(SamOutputDestroy(&output));
  }
  BeginCatching();
  sam_assert(SamOutputCheckPart(s.grid, filename, identity[1]) == SAM_ERR_FILE); /* which is being written */
  EndCatching();
  sam_call(SamOutputDestroy(&output));
  sam_call(SamOutputCheckPart(s.grid, filename, identity[1]));
  DestroyShown(&s);
  RemoveFile(filename);
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

static void test_second_series_is_beside_the_history(void **state)
{
  Shown               s          = CreateShown(0);
  SamState            cycles     = NewCycles(s.grid);
  const SamParameters parameters = NewParameters(friction);
  SamOutputSettings   set        = SettingsOf(s.contact, "");
  SamOutput           output     = NULL;

  (void)state;
  set.cycles      = cycles;
  set.cycles_name = "jumps";
  sam_call(SamOutputCreate(s.grid, filename, &set, &output));
  sam_call(SamOutputSetParameters(output, &parameters));
  for (int k = 0; k < STEPS; k++) WriteRows(&s, cycles, output, k, 0.25 + k);
  sam_call(SamOutputDestroy(&output));
  sam_assert(HasCycles((const double[]){0.25, 1.25, 2.25}));
  set.cycles      = NULL;
  set.cycles_name = NULL;
  sam_call(SamOutputCreate(s.grid, filename, &set, &output));
  sam_fails(SamOutputWriteCycle(output), PETSC_ERR_ORDER);
  sam_call(SamOutputDestroy(&output));
  sam_call(SamStateDestroy(&cycles));
  DestroyShown(&s);
  RemoveFile(filename);
}

/* ---- rows of zeros ---- */

enum { TALL = 700, WIDE = 129 }; /* chunks of more than a page of the disk, which ranks share */

/* Writes a frame with a one at the end of the rows from `from` to before `to` of the grid. */
static void WriteField(SamFile f, hid_t dataset, hsize_t frame, PetscInt from, PetscInt to)
{
  const SamGrid  g     = f->grid;
  const SamBlock block = {3, {frame, (hsize_t)g->row_start, 0}, {1, (hsize_t)g->rows, WIDE}};
  double        *values;

  sam_call(PetscCalloc1(g->cells, &values));
  for (PetscInt j = PetscMax(from, g->row_start); j < PetscMin(to, g->row_start + g->rows); j++)
    values[(j - g->row_start) * WIDE + WIDE - 1] = 1;
  SamFileWriteNotZero(f, dataset, H5T_NATIVE_DOUBLE, sizeof(*values), &block, values);
  sam_call(PetscFree(values));
}

/* Counts the values of a frame that differ from those. */
static PetscReal CountWrong(SamFile f, hid_t dataset, hsize_t frame, PetscInt from, PetscInt to)
{
  const SamGrid g     = f->grid;
  PetscReal     wrong = 0;
  double       *values;

  sam_call(PetscMalloc1(g->cells, &values));
  SamFileReadFrame(f, dataset, H5T_NATIVE_DOUBLE, frame, values);
  for (PetscInt k = 0; k < g->cells; k++) {
    const PetscInt j = g->row_start + k / WIDE;

    wrong += values[k] == (j >= from && j < to && k % WIDE == WIDE - 1 ? 1 : 0) ? 0 : 1;
  }
  sam_call(PetscFree(values));
  sam_call(SamMax(PETSC_COMM_WORLD, 1, &wrong));
  return wrong;
}

/* Rows of zeros are left out, but of compressed frames. */
static void test_zeros_that_are_not_written_read_as_zeros(void **state)
{
  static const SamLabel label     = {"field", NULL, NULL};
  static const PetscInt rows[][2] = {{0, TALL}, {100, 103}, {0, 0}, {650, TALL}};
  const SamShape        shape     = {3, {0, TALL, WIDE}, {H5S_UNLIMITED, TALL, WIDE}, {1, 100, WIDE}, NULL};
  const hsize_t         first[] = {1, TALL, WIDE}, all[] = {4, TALL, WIDE};
  SamGrid               grid = NewGrid(WIDE, TALL, 1, 1);

  (void)state;
  for (PetscInt compress = 0; compress < 2; compress++) {
    SamFile f;
    hid_t   dataset;

    sam_call(SamFileOpen(grid, SAM_EVENT_OUTPUT, "output", filename, SAM_FILE_CREATE, NULL, &f));
    sam_call(SamFileBegin(f));
    dataset = SamFileCreateDataset(f, f->id, &label, H5T_IEEE_F64LE, &shape, compress);
    (void)SamFileNote(f, H5Dset_extent(dataset, first));
    WriteField(f, dataset, 0, rows[0][0], rows[0][1]);
    (void)SamFileNote(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
    sam_call(SamFileEnd(f));
    sam_call(SamFileReserve(f, 4 * TALL * WIDE * (off_t)sizeof(double)));
    sam_call(SamFileBegin(f));
    (void)SamFileNote(f, H5Dset_extent(dataset, all));
    for (hsize_t k = 1; k < 4; k++) WriteField(f, dataset, k, rows[k][0], rows[k][1]);
    (void)SamFileNote(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
    for (hsize_t k = 0; k < 4; k++) sam_assert(CountWrong(f, dataset, k, rows[k][0], rows[k][1]) == 0);
    sam_call(SamFileEnd(f));
    sam_call(SamFileDestroy(&f, PETSC_TRUE));
    RemoveFile(filename);
  }
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_part_counts_up_to_the_next_one),
    cmocka_unit_test(test_a_file_gets_its_name_when_it_is_complete),
    cmocka_unit_test(test_second_series_is_beside_the_history),
    cmocka_unit_test(test_zeros_that_are_not_written_read_as_zeros),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

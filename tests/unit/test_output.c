/*
 * Results in HDF5: what is written is read back, exactly, with its dimensions and attributes; what cannot be written is
 * said on all ranks.
 */
#include "samtest.h"

#include <hdf5.h>
#include <hdf5_hl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <petsam/output.h>

/* Grids that do not divide, one with fewer rows than ranks, and one of several chunks that ranks share. */
static const PetscInt sizes[][2] = {{13, 7}, {5, 2}, {1030, 259}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]), STEPS = 3, SAVED = 2 };

static const char      filename[] = "test_output.h5";
static const PetscReal friction   = 0.5;

static const char *const field_names[] = {"pressure", "shear_x",        "shear_y",        "slip_x",        "slip_y",
                                          "gap",      "displacement_x", "displacement_y", "displacement_z"};
static const char *const field_units[] = {"Pa", "Pa", "Pa", "m", "m", "m", "m", "m", "m"};
enum { NUM_FIELDS = sizeof(field_names) / sizeof(field_names[0]) };

static int Rank(void)
{
  int rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

static void Remove(const char *file)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) (void)unlink(file);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

static SamGrid CreateGrid(int k)
{
  const PetscReal width[2] = {3e-3, 2e-3}, center[2] = {0.2e-3, -0.1e-3};
  SamGrid         grid;

  sam_call(SamGridCreate(PETSC_COMM_WORLD, sizes[k], width, center, &grid));
  return grid;
}

/*
  The value of a field at a step and a cell, different for each. Pressure and shear make all three states: columns of
  open cells, and elsewhere |q| below or beyond mu p by the row.
*/
static double Value(int field, int step, PetscInt i, PetscInt j)
{
  if (field == 0) return i % 3 == 0 ? 0 : 100.0 + step;
  if (field == 1) return i % 3 == 0 ? 0 : (j % 2 ? 3e-6 : 30.0) + step;
  if (field == 2) return i % 3 == 0 ? 0 : (j % 2 ? 4e-6 : 50.0);
  return 1e6 * field + 1e5 * step + 1e-3 * (double)j + 1e-7 * (double)i;
}

static int StateValue(int step, PetscInt i, PetscInt j)
{
  if (i % 3 == 0) return 0;
  (void)step;
  return j % 2 ? 1 : 2;
}

/* ---- writing ---- */

static void FillComponent(SamGrid grid, Vec vec, int component, int field, int step)
{
  PetscScalar *array;

  sam_call(VecGetArray(vec, &array));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++)
      array[component * grid->cells + j * grid->nx + i] = Value(field, step, i, grid->row_start + j);
  sam_call(VecRestoreArray(vec, &array));
}

static void CreateFields(SamGrid grid, SamFields *fields)
{
  sam_call(SamGridCreateVec(grid, 1, &fields->pressure));
  sam_call(SamGridCreateVec(grid, 2, &fields->shear));
  sam_call(SamGridCreateVec(grid, 2, &fields->slip));
  sam_call(SamGridCreateVec(grid, 1, &fields->gap));
  sam_call(SamGridCreateVec(grid, 1, &fields->displacement_z));
  sam_call(SamGridCreateVec(grid, 2, &fields->displacement_t));
}

static void FillFields(SamGrid grid, SamFields *fields, int step)
{
  FillComponent(grid, fields->pressure, 0, 0, step);
  FillComponent(grid, fields->shear, 0, 1, step);
  FillComponent(grid, fields->shear, 1, 2, step);
  FillComponent(grid, fields->slip, 0, 3, step);
  FillComponent(grid, fields->slip, 1, 4, step);
  FillComponent(grid, fields->gap, 0, 5, step);
  FillComponent(grid, fields->displacement_t, 0, 6, step);
  FillComponent(grid, fields->displacement_t, 1, 7, step);
  FillComponent(grid, fields->displacement_z, 0, 8, step);
}

static void DestroyFields(SamFields *fields)
{
  sam_call(VecDestroy(&fields->pressure));
  sam_call(VecDestroy(&fields->shear));
  sam_call(VecDestroy(&fields->slip));
  sam_call(VecDestroy(&fields->gap));
  sam_call(VecDestroy(&fields->displacement_z));
  sam_call(VecDestroy(&fields->displacement_t));
}

/* Numbers of a step, all different. */
static SamStep MakeStep(int step)
{
  SamStep s = {.time              = 0.5 + step,
               .contact_area      = 20 + step,
               .stick_area        = 30 + step,
               .status            = step == 1 ? SAM_STATUS_EDGE_CONTACT : SAM_STATUS_CONVERGED,
               .dissipated_energy = 40 + step};

  for (int k = 0; k < 3; k++) {
    s.normal.load[k]      = 100 + 10 * k + step;
    s.tangential.load[k]  = 200 + 10 * k + step;
    s.normal.rigid[k]     = 300 + 10 * k + step;
    s.tangential.rigid[k] = 400 + 10 * k + step;
  }
  s.check.normal             = 1e-9 + step;
  s.check.tangential         = 2e-9 + step;
  s.check.equilibrium        = 3e-9 + step;
  s.normal_iterations        = 50 + step;
  s.normal_applies           = 60 + step;
  s.normal_preconditions     = 70 + step;
  s.tangential_iterations    = 80 + step;
  s.tangential_applies       = 90 + step;
  s.tangential_preconditions = 110 + step;
  s.coupling_iterations      = 120 + step;
  return s;
}

/* Three steps, the fields of the first and the last. */
static void WriteSteps(SamGrid grid, SamOutput output)
{
  SamFields fields;

  CreateFields(grid, &fields);
  for (int step = 0; step < STEPS; step++) {
    const SamStep numbers = MakeStep(step);

    FillFields(grid, &fields, step);
    sam_call(SamOutputWriteStep(output, &numbers, step == 1 ? NULL : &fields, friction));
  }
  DestroyFields(&fields);
}

static void WriteFile(SamGrid grid, const char *name)
{
  SamOutput output;

  sam_call(SamOutputCreate(grid, name, &output));
  sam_call(SamOutputSetReals(output, "friction", 1, &(PetscReal){0.25}));
  sam_call(SamOutputSetReals(output, "friction", 1, &(PetscReal){friction}));
  sam_call(SamOutputSetText(output, "options", "-a 1\n-b \xc2\xb5m"));
  sam_call(SamOutputSetText(output, "empty", ""));
  WriteSteps(grid, output);
  sam_call(SamOutputDestroy(&output));
  sam_assert(output == NULL);
}

/* ---- reading back, on one rank; all return whether it is as it should be ---- */

static int HasText(hid_t object, const char *name, const char *expected)
{
  hid_t attribute, type;
  char *text = NULL;
  int   good;

  if (H5Aexists(object, name) <= 0) return 0;
  attribute = H5Aopen(object, name, H5P_DEFAULT);
  type      = H5Aget_type(attribute);
  good      = H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, &text) >= 0 && text &&
         (expected ? !strcmp(text, expected) : text[0] != '\0');
  if (text) H5free_memory(text);
  H5Tclose(type);
  H5Aclose(attribute);
  return good;
}

static int HasReal(hid_t object, const char *name, double expected)
{
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  double      value     = NAN;

  H5Aread(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  return value == expected;
}

static int HasShape(hid_t dataset, int rank, const hsize_t expected[], int unlimited)
{
  const hid_t space = H5Dget_space(dataset);
  hsize_t     size[8], largest[8];
  int         good = H5Sget_simple_extent_ndims(space) == rank;

  if (good) H5Sget_simple_extent_dims(space, size, largest);
  for (int d = 0; d < rank && good; d++)
    good = size[d] == expected[d] && largest[d] == (d == 0 && unlimited ? H5S_UNLIMITED : expected[d]);
  H5Sclose(space);
  return good;
}

static int HasAxis(hid_t file, const char *name, SamGrid grid, int along_y)
{
  const hid_t   dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hsize_t n       = (hsize_t)(along_y ? grid->ny : grid->nx);
  double       *values  = (double *)malloc(n * sizeof(*values));
  int           good    = HasShape(dataset, 1, &n, 0) && H5DSis_scale(dataset) > 0 && HasText(dataset, "units", "m") &&
             HasText(dataset, "long_name", NULL);

  H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  for (hsize_t k = 0; k < n; k++)
    good = good && values[k] == (along_y ? SamGridY(grid, (PetscInt)k) : SamGridX(grid, (PetscInt)k));
  free(values);
  H5Dclose(dataset);
  return good;
}

static int HasScales(hid_t file, hid_t dataset)
{
  static const char *const names[] = {"time", "y", "x"};
  int                      good    = 1;

  for (unsigned d = 0; d < 3; d++) {
    const hid_t scale = H5Dopen2(file, names[d], H5P_DEFAULT);

    good = good && H5DSis_attached(dataset, scale, d) > 0;
    H5Dclose(scale);
  }
  return good;
}

/* field < 0: the state */
static int HasField(hid_t file, int field, SamGrid grid, int saved)
{
  const char   *name    = field < 0 ? "state" : field_names[field];
  const hid_t   dataset = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(dataset);
  const hsize_t shape[3] = {(hsize_t)saved, (hsize_t)grid->ny, (hsize_t)grid->nx}, cells = shape[1] * shape[2];
  double       *values = (double *)malloc((size_t)saved * cells * sizeof(*values));
  int           good   = HasShape(dataset, 3, shape, 1) && HasScales(file, dataset) &&
             HasText(dataset, "units", field < 0 ? "1" : field_units[field]) && HasText(dataset, "long_name", NULL);

  good = good && H5Tequal(type, field < 0 ? H5T_STD_I8LE : H5T_IEEE_F64LE) > 0 &&
         H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  for (hsize_t k = 0; good && k < (hsize_t)saved * cells; k++) {
    const int      step = k < cells ? 0 : 2;
    const PetscInt j = (PetscInt)(k % cells / shape[2]), i = (PetscInt)(k % shape[2]);

    good = values[k] == (field < 0 ? StateValue(step, i, j) : Value(field, step, i, j));
  }
  if (!good) print_error("%s: /%s is not what was written\n", filename, name);
  free(values);
  H5Tclose(type);
  H5Dclose(dataset);
  return good;
}

static int HasColumn(hid_t file, const char *name, const char *units, const double expected[], int steps, int whole)
{
  const hid_t group = H5Gopen2(file, "history", H5P_DEFAULT), dataset = H5Dopen2(group, name, H5P_DEFAULT),
              time = H5Dopen2(group, "time", H5P_DEFAULT), type = H5Dget_type(dataset);
  const hsize_t n = (hsize_t)steps;
  double        values[STEPS];
  int good = HasShape(dataset, 1, &n, 1) && HasText(dataset, "units", units) && HasText(dataset, "long_name", NULL);

  good = good && H5Tget_class(type) == (whole ? H5T_INTEGER : H5T_FLOAT) &&
         H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  for (int k = 0; k < steps; k++) good = good && values[k] == expected[k];
  good = good && (strcmp(name, "time") ? H5DSis_attached(dataset, time, 0) > 0 : H5DSis_scale(dataset) > 0);
  if (!good) print_error("%s: /history/%s is not what was written\n", filename, name);
  H5Tclose(type);
  H5Dclose(time);
  H5Dclose(dataset);
  H5Gclose(group);
  return good;
}

static int HasLoads(hid_t file, int steps)
{
  int good = 1;

  for (int kind = 0; kind < 2; kind++) {
    for (int c = 0; c < 3; c++) {
      double      loads[STEPS], rigids[STEPS];
      const char *load = SamLoadNames[kind][c], *rigid = SamRigidNames[kind][c];

      for (int step = 0; step < STEPS; step++) {
        loads[step]  = 100 * (1 + kind) + 10 * c + step;
        rigids[step] = loads[step] + 200;
      }
      good = HasColumn(file, load, strncmp(load, "load_m", 6) ? "N" : "N m", loads, steps, 0) && good;
      good = HasColumn(file, rigid, strncmp(rigid, "rot_", 4) ? "m" : "rad", rigids, steps, 0) && good;
    }
  }
  return good;
}

static int HasHistory(hid_t file, int steps)
{
  static const struct {
    const char *name, *units;
    double      first;
    int         whole;
  } columns[]                = {{"time", "s", 0.5, 0},
                                {"contact_area", "m2", 20, 0},
                                {"stick_area", "m2", 30, 0},
                                {"normal_residual", "1", 1e-9, 0},
                                {"tangential_residual", "1", 2e-9, 0},
                                {"equilibrium_residual", "1", 3e-9, 0},
                                {"normal_iterations", "1", 50, 1},
                                {"normal_applies", "1", 60, 1},
                                {"normal_preconditions", "1", 70, 1},
                                {"tangential_iterations", "1", 80, 1},
                                {"tangential_applies", "1", 90, 1},
                                {"tangential_preconditions", "1", 110, 1},
                                {"coupling_iterations", "1", 120, 1},
                                {"dissipated_energy", "J", 40, 0}};
  const double status[STEPS] = {0, 12, 0};
  int          good          = HasLoads(file, steps);

  for (size_t c = 0; c < sizeof(columns) / sizeof(columns[0]); c++) {
    double expected[STEPS];

    for (int step = 0; step < STEPS; step++) expected[step] = columns[c].first + step;
    good = HasColumn(file, columns[c].name, columns[c].units, expected, steps, columns[c].whole) && good;
  }
  return HasColumn(file, "status", "1", status, steps, 1) && good;
}

static int HasRoot(hid_t file, SamGrid grid, int saved)
{
  const hid_t   time     = H5Dopen2(file, "time", H5P_DEFAULT);
  const hsize_t n        = (hsize_t)saved;
  double        times[2] = {0, 0};
  int           good     = HasShape(time, 1, &n, 1) && H5DSis_scale(time) > 0 && HasText(time, "units", "s");

  H5Dread(time, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times);
  good = good && times[0] == 0.5 && (saved < 2 || times[1] == 2.5);
  good = good && HasText(file, "Conventions", "CF-1.8") && HasText(file, "petsam_version", PETSAM_VERSION);
  H5Dclose(time);
  return good && HasAxis(file, "x", grid, 0) && HasAxis(file, "y", grid, 1);
}

/* The whole file, on rank 0. */
static int IsGood(const char *name, SamGrid grid, int steps, int saved)
{
  hid_t file;
  int   good;

  if (Rank()) return 1;
  file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return 0;
  good = HasRoot(file, grid, saved) && HasHistory(file, steps) && HasField(file, -1, grid, saved);
  for (int field = 0; field < NUM_FIELDS; field++) good = HasField(file, field, grid, saved) && good;
  H5Fclose(file);
  return good;
}

/* ---- tests ---- */

static void test_file_holds_what_was_written(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid grid = CreateGrid(k);

    WriteFile(grid, filename);
    sam_assert(IsGood(filename, grid, STEPS, SAVED));
    sam_call(SamGridDestroy(&grid));
  }
  Remove(filename);
}

static void test_compression_changes_no_value(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid     grid = CreateGrid(k);
    struct stat plain, compressed;

    WriteFile(grid, filename);
    sam_assert(Rank() || !stat(filename, &plain));
    sam_call(PetscOptionsSetValue(NULL, "-output_compress", "3"));
    WriteFile(grid, filename);
    sam_call(PetscOptionsClearValue(NULL, "-output_compress"));
    sam_assert(IsGood(filename, grid, STEPS, SAVED));
    sam_assert(Rank() || !stat(filename, &compressed));
    /* of the large grid, whose values are regular, less than half remains */
    sam_assert(Rank() || k < 2 || compressed.st_size < plain.st_size / 2);
    sam_call(SamGridDestroy(&grid));
  }
  Remove(filename);
}

static void test_root_has_the_attributes_that_were_set(void **state)
{
  SamGrid grid = CreateGrid(0);
  int     good = 1;

  (void)state;
  WriteFile(grid, filename);
  if (Rank() == 0) {
    const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT), cells = H5Dopen2(file, "state", H5P_DEFAULT);

    good = HasReal(file, "friction", friction) && HasText(file, "options", "-a 1\n-b \xc2\xb5m") &&
           HasText(file, "empty", "") && HasText(cells, "flag_meanings", "open stick slip");
    H5Dclose(cells);
    H5Fclose(file);
  }
  sam_assert(good);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
}

static void test_file_without_steps_is_good(void **state)
{
  SamGrid   grid = CreateGrid(0);
  SamOutput output;
  int       good = 1;

  (void)state;
  sam_call(SamOutputCreate(grid, filename, &output));
  sam_call(SamOutputDestroy(&output));
  if (Rank() == 0) {
    const hid_t file       = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT),
                pressure   = H5Dopen2(file, "pressure", H5P_DEFAULT);
    const hsize_t shape[3] = {0, (hsize_t)grid->ny, (hsize_t)grid->nx};

    good = HasShape(pressure, 3, shape, 1) && HasAxis(file, "x", grid, 0);
    H5Dclose(pressure);
    H5Fclose(file);
  }
  sam_assert(good);
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
}

/* Rank 0 copies a file as it is on the disk. */
static int Copy(const char *from, const char *to)
{
  char   buffer[65536];
  FILE  *in, *out;
  size_t n;

  if (Rank()) return 1;
  in  = fopen(from, "rb");
  out = fopen(to, "wb");
  while (in && out && (n = fread(buffer, 1, sizeof(buffer), in)) > 0) (void)fwrite(buffer, 1, n, out);
  return in && out && !fclose(in) && !fclose(out);
}

/* What a run that is aborted now leaves behind. */
static void test_file_is_complete_after_each_step(void **state)
{
  static const char copy[] = "test_output_copy.h5";

  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid   grid = CreateGrid(k);
    SamOutput output;
    SamFields fields;

    CreateFields(grid, &fields);
    sam_call(SamOutputCreate(grid, filename, &output));
    for (int step = 0; step < STEPS; step++) {
      const SamStep numbers = MakeStep(step);

      FillFields(grid, &fields, step);
      sam_call(SamOutputWriteStep(output, &numbers, step == 1 ? NULL : &fields, friction));
      (void)MPI_Barrier(PETSC_COMM_WORLD);
      sam_assert(Copy(filename, copy));
      sam_assert(IsGood(copy, grid, step + 1, step < 2 ? 1 : 2));
    }
    sam_call(SamOutputDestroy(&output));
    DestroyFields(&fields);
    sam_call(SamGridDestroy(&grid));
  }
  Remove(copy);
  Remove(filename);
}

/* ---- what cannot be written ---- */

/* Keeps the first message of an error instead of printing it. */
static char message[4096];

static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *text, void *context)
{
  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  (void)context;
  if (type == PETSC_ERROR_INITIAL) (void)snprintf(message, sizeof(message), "%s", text);
  return code;
}

static void AssertNotCreated(const char *name, PetscErrorCode expected, const char *word)
{
  SamGrid        grid = CreateGrid(0);
  SamOutput      output;
  PetscErrorCode ierr;
  int            good;

  message[0] = '\0';
  sam_call(PetscPushErrorHandler(KeepMessage, NULL));
  ierr = SamOutputCreate(grid, name, &output);
  sam_call(PetscPopErrorHandler());
  good = ierr == expected && strstr(message, word) && !output;
  if (!good) print_error("%s: error %d, %s\n", name, (int)ierr, message);
  sam_assert(good);
  sam_call(SamGridDestroy(&grid));
}

static void test_names_that_cannot_be_written_are_errors_on_all_ranks(void **state)
{
  (void)state;
  AssertNotCreated("test_output_none/f.h5", SAM_ERR_FILE, "test_output_none/f.h5");
  AssertNotCreated(".", SAM_ERR_FILE, "directory");
  AssertNotCreated("/dev/null", SAM_ERR_FILE, "/dev/null");
  sam_assert(access("test_output_none", F_OK));
}

static void test_failed_creation_leaves_the_old_file(void **state)
{
  SamGrid grid = CreateGrid(0);

  (void)state;
  WriteFile(grid, filename);
  sam_call(PetscOptionsSetValue(NULL, "-output_compress", "10"));
  AssertNotCreated(filename, SAM_ERR_USER, "-output_compress");
  sam_call(PetscOptionsSetValue(NULL, "-output_compress", "fast"));
  AssertNotCreated(filename, SAM_ERR_USER, "-output_compress");
  sam_call(PetscOptionsClearValue(NULL, "-output_compress"));
  if (geteuid()) { /* to root everything is writable */
    sam_assert(Rank() || !chmod(filename, 0400));
    AssertNotCreated(filename, SAM_ERR_FILE, filename);
  }
  sam_assert(IsGood(filename, grid, STEPS, SAVED));
  sam_call(SamGridDestroy(&grid));
  Remove(filename);
}

/* Tries to write a step where there is no room for it. */
static void AssertNoRoom(SamOutput output, const SamStep *step, const SamFields *fields)
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
  message[0] = '\0';
  sam_call(PetscPushErrorHandler(KeepMessage, NULL));
  ierr = SamOutputWriteStep(output, step, fields, friction);
  sam_call(PetscPopErrorHandler());
  good = ierr == SAM_ERR_FILE && strstr(message, filename) && !setrlimit(RLIMIT_FSIZE, &usual);
  sam_assert(good);
}

/*
  A limit on the size of files stands for a full disk. What there was remains, and more can follow when there is room.
*/
static void test_full_disk_is_an_error_on_all_ranks_and_costs_nothing(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid   grid = CreateGrid(k);
    SamOutput output;
    SamFields fields;

    CreateFields(grid, &fields);
    sam_call(SamOutputCreate(grid, filename, &output));
    for (int step = 0; step < STEPS; step++) {
      const SamStep numbers = MakeStep(step);

      FillFields(grid, &fields, step);
      AssertNoRoom(output, &numbers, &fields);
      AssertNoRoom(output, &numbers, NULL);
      sam_call(SamOutputWriteStep(output, &numbers, step == 1 ? NULL : &fields, friction));
    }
    AssertNoRoom(output, &(SamStep){.time = 9}, &fields);
    sam_call(SamOutputDestroy(&output));
    sam_assert(IsGood(filename, grid, STEPS, SAVED));
    DestroyFields(&fields);
    sam_call(SamGridDestroy(&grid));
  }
  Remove(filename);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_file_holds_what_was_written),
    cmocka_unit_test(test_compression_changes_no_value),
    cmocka_unit_test(test_root_has_the_attributes_that_were_set),
    cmocka_unit_test(test_file_without_steps_is_good),
    cmocka_unit_test(test_file_is_complete_after_each_step),
    cmocka_unit_test(test_names_that_cannot_be_written_are_errors_on_all_ranks),
    cmocka_unit_test(test_failed_creation_leaves_the_old_file),
    cmocka_unit_test(test_full_disk_is_an_error_on_all_ranks_and_costs_nothing),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

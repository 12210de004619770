/* Results for the tests of src/run/io: a contact with prescribed values, steps in a file, and reading them back. */
#ifndef PETSAM_TEST_RESULTS_H
#define PETSAM_TEST_RESULTS_H

#include "contacts.h"

#include <hdf5.h>
#include <hdf5_hl.h>
#include <unistd.h>

#include <petsam/private/output.h>
#include <petsam/private/state.h>

/* Grids that do not divide, one with fewer rows than ranks, and one of several chunks that ranks share. */
static const PetscInt sizes[][2] = {{13, 7}, {5, 2}, {1030, 259}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]), STEPS = 3, SAVED = 2 };

static const char      filename[] = "test_output.h5";
static const PetscReal friction   = 0.5;

static const char *const field_names[] = {"pressure", "shear_x",        "shear_y",        "slip_x",        "slip_y",
                                          "gap",      "displacement_x", "displacement_y", "displacement_z"};
static const char *const field_units[] = {"Pa", "Pa", "Pa", "m", "m", "m", "m", "m", "m"};
enum { NUM_FIELDS = sizeof(field_names) / sizeof(field_names[0]) };

/* Rigid displacements along z, x and y. */
static const double moved[3] = {0.125, 0.25, -0.5};

/*
  The value of a field at a step and a cell, different for each. Pressure and shear make all three states: columns of
  open cells, and elsewhere |q| below or beyond mu p by the row. Gap and slip follow from the displacements, the bodies
  being moved rigidly, and from a separation that is h[i, j] = j + i/2.
*/
static inline double Value(int field, int step, PetscInt i, PetscInt j)
{
  if (field == 0) return i % 3 == 0 ? 0 : 100.0 + step;
  if (field == 1) return i % 3 == 0 ? 0 : (j % 2 ? 3e-6 : 30.0) + step;
  if (field == 2) return i % 3 == 0 ? 0 : (j % 2 ? 4e-6 : 50.0);
  if (field == 3) return Value(6, step, i, j) - moved[1];
  if (field == 4) return Value(7, step, i, j) - moved[2];
  if (field == 5) return Value(8, step, i, j) + ((double)j + 0.5 * (double)i) - moved[0];
  return 1e6 * field + 1e5 * step + 1e-3 * (double)j + 1e-7 * (double)i;
}

static inline int StateValue(PetscInt i, PetscInt j)
{
  if (i % 3 == 0) return 0;
  return j % 2 ? 1 : 2;
}

/* ---- writing ---- */

/*
  A contact that shows prescribed values. The fields are committed, the numbers of the step tried: so the rigid
  displacements that the fields are computed with need not be those of the history.
*/
typedef struct {
  SamGrid       grid;
  SamElasticity elasticity;
  SamProblem    problem;
  SamContact    contact;
  SamState      state; /* of the contact */
} Shown;

/* The columns of /history, all different; only the loads and the rigid displacements are missing. */
static const struct {
  const char *name, *units;
  double      first; /* in the first step; grows by 1 in each */
  int         whole;
} columns[] = {{"time", "s", 0.5, 0},
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
               {"contact_cells", "1", 130, 1},
               {"stick_cells", "1", 140, 1},
               {"edge_accepted", "1", 47, 0},
               {"contact_half_x", "m", 48, 0},
               {"pressure_max", "Pa", 150, 0},
               {"shear_max", "Pa", 160, 0},
               {"stored_energy", "J", 45, 0},
               {"dissipated_energy", "J", 40, 0}};
enum { NUM_COLUMNS = sizeof(columns) / sizeof(columns[0]) };
static const double statuses[STEPS] = {SAM_STATUS_CONVERGED, SAM_STATUS_EDGE_CONTACT, SAM_STATUS_CONVERGED};

/* On the grid of that place in `sizes`. */
static inline Shown CreateShown(int place)
{
  const SamGrid grid = NewGridOn(PETSC_COMM_WORLD, sizes[place][0], sizes[place][1], 3e-3, 2e-3, 0.2e-3, -0.1e-3);
  const SamPair pair = NewPair(210e9, 0.3, 210e9, 0.3);
  Shown         s    = {.grid = grid};
  double       *h;
  Vec           gap;

  sam_call(SamElasticityCreate(grid, pair, &s.elasticity));
  sam_call(SamProblemCreate(s.elasticity, &s.problem));
  sam_call(SamProblemSetFriction(s.problem, friction));
  gap = SamProblemGetGap(s.problem);
  sam_call(VecGetArray(gap, &h));
  for (PetscInt k = 0; k < grid->cells; k++)
    h[k] = (double)(grid->row_start + k / grid->nx) + 0.5 * (double)(k % grid->nx);
  sam_call(VecRestoreArray(gap, &h));
  sam_call(SamContactCreate(s.problem, &s.contact));
  sam_call(SamContactGetState(s.contact, &s.state));
  return s;
}

static inline void DestroyShown(Shown *s)
{
  sam_call(SamContactDestroy(&s->contact));
  sam_call(SamProblemDestroy(&s->problem));
  sam_call(SamElasticityDestroy(&s->elasticity));
  sam_call(SamGridDestroy(&s->grid));
}

/* A committed field of a state, to be written to. */
static inline Vec FieldOf(SamState state, const char *name)
{
  Vec field;

  sam_call(SamStateRestoreField(state, SamStateFindField(state, name), SAM_COMMITTED, &field));
  return field;
}

/* Sets a number of the tried step, unless the state does not have it. */
static inline void PutNumber(const Shown *s, const char *name, double value)
{
  const PetscInt id = SamStateFindNumber(s->state, name);

  if (id >= 0) *SamStateNumbers(s->state, id, SAM_TRIED) = value;
}

static const char *const bulk_names[6] = {"bulk1_stress_xx", "bulk1_stress_yy", "bulk1_stress_xy",
                                          "bulk2_stress_xx", "bulk2_stress_yy", "bulk2_stress_xy"};

static inline void PutNumbers(const Shown *s, int step)
{
  sam_call(SamStateBegin(s->state));
  for (int c = 0; c < NUM_COLUMNS; c++) PutNumber(s, columns[c].name, columns[c].first + step);
  PutNumber(s, "status", statuses[step]);
  PutNumber(s, "friction_scale", 10 + step);
  for (int n = 0; n < 6; n++) PutNumber(s, bulk_names[n], 100 * (n + 1) + step);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    PutNumber(s, SamComponentNames[k].load, 1000 + 10 * (double)k + step);
    PutNumber(s, SamComponentNames[k].rigid, 2000 + 10 * (double)k + step);
  }
}

static inline void FillComponent(SamGrid grid, Vec vec, int component, int field, int step)
{
  PetscScalar *array;

  sam_call(VecGetArray(vec, &array));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++)
      array[component * grid->cells + j * grid->nx + i] = Value(field, step, i, grid->row_start + j);
  sam_call(VecRestoreArray(vec, &array));
}

static inline void FillFields(const Shown *s, SamState state, int step)
{
  const Vec pressure = FieldOf(state, "pressure");

  FillComponent(s->grid, pressure, 0, 0, step);
  FillComponent(s->grid, FieldOf(state, "shear"), 0, 1, step);
  FillComponent(s->grid, FieldOf(state, "shear"), 1, 2, step);
  FillComponent(s->grid, FieldOf(state, "displacement"), 0, 6, step);
  FillComponent(s->grid, FieldOf(state, "displacement"), 1, 7, step);
  FillComponent(s->grid, FieldOf(state, "displacement_z"), 0, 8, step);
  sam_call(VecCopy(pressure, FieldOf(state, "bound")));
  sam_call(VecScale(FieldOf(state, "bound"), friction));
}

/* Lets the contact show the fields and the numbers of a step. */
static inline void Show(const Shown *s, int step)
{
  static const char *const names[] = {"disp_z", "disp_x", "disp_y"};
  SamState                 state;

  sam_call(SamStateCreateLike(s->state, &state));
  FillFields(s, state, step);
  for (int k = 0; k < 3; k++) *SamStateNumbers(state, SamStateFindNumber(state, names[k]), SAM_COMMITTED) = moved[k];
  *SamStateNumbers(state, SamStateFindNumber(state, "steps"), SAM_COMMITTED) = 1;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    *SamStateNumbers(state, SamStateFindNumber(state, SamComponentNames[k].load), SAM_COMMITTED) = 0;
    if (k >= SAM_COMPONENT_MX)
      *SamStateNumbers(state, SamStateFindNumber(state, SamComponentNames[k].rigid), SAM_COMMITTED) = 0;
  }
  sam_call(SamContactSetState(s->contact, state, PETSC_TRUE));
  sam_call(SamStateDestroy(&state));
  PutNumbers(s, step);
}

/* The settings of the options, with the fields that the solution has, without a file for ParaView beside it. */
static inline SamOutputSettings SettingsOf(SamContact contact, const char *options)
{
  const SamOptions  from = {PETSC_COMM_WORLD, NULL};
  SamOutputSettings set;

  SetOptions("-output_fields "
             "pressure,shear_x,shear_y,slip_x,slip_y,gap,displacement_x,displacement_y,displacement_z,state");
  sam_call(PetscOptionsInsertString(NULL, options));
  sam_call(SamOutputSettingsSetFromOptions(&set, &from));
  if (contact) sam_call(SamOutputSettingsPrepare(&set, contact, &from));
  SetOptions("");
  return set;
}

/* Three steps, the fields of the first and the last. */
static inline void WriteSteps(const Shown *s, SamOutput output)
{
  for (int step = 0; step < STEPS; step++) {
    Show(s, step);
    sam_call(SamOutputWriteStep(output, step != 1));
  }
}

static inline void WriteFile(const Shown *s, const char *name, const char *options)
{
  const SamOutputSettings set = SettingsOf(s->contact, options);
  SamOutput               output;

  sam_call(SamOutputCreate(s->grid, name, &set, &output));
  sam_call(SamOutputSetReals(output, "friction", 1, &(PetscReal){0.25}));
  sam_call(SamOutputSetReals(output, "friction", 1, &friction));
  sam_call(SamOutputSetText(output, "options", "-a 1\n-b \xc2\xb5m"));
  sam_call(SamOutputSetText(output, "empty", ""));
  WriteSteps(s, output);
  sam_call(SamOutputDestroy(&output));
  sam_assert(output == NULL);
}

/* ---- reading back, on one rank; all return whether the file holds what was written ---- */

static inline int HasText(hid_t object, const char *name, const char *expected)
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

static inline int HasReal(hid_t object, const char *name, double expected)
{
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  double      value     = NAN;

  H5Aread(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  return value == expected;
}

static inline int HasShape(hid_t dataset, int rank, const hsize_t expected[], int unlimited)
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

static inline int HasAxis(hid_t file, const char *name, SamGrid grid, int along_y)
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

static inline int HasScales(hid_t file, hid_t dataset)
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
static inline int HasField(hid_t file, int field, SamGrid grid, int saved)
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

    good = values[k] == (field < 0 ? StateValue(i, j) : Value(field, step, i, j));
  }
  if (!good) print_error("%s: /%s is not what was written\n", filename, name);
  free(values);
  H5Tclose(type);
  H5Dclose(dataset);
  return good;
}

static inline int HasColumn(hid_t file, const char *name, const char *units, const double expected[], int steps,
                            int whole)
{
  const hid_t group = H5Gopen2(file, "history", H5P_DEFAULT), dataset = H5Dopen2(group, name, H5P_DEFAULT),
              time = H5Dopen2(group, "time", H5P_DEFAULT), type = H5Dget_type(dataset);
  const hsize_t n = (hsize_t)steps;
  double        values[8];
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

static inline int HasLoads(hid_t file, int steps)
{
  int good = 1;

  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const SamComponentName *name = &SamComponentNames[c];
    double                  loads[STEPS], rigids[STEPS];

    for (int step = 0; step < STEPS; step++) {
      loads[step]  = 1000 + 10 * (double)c + step;
      rigids[step] = 2000 + 10 * (double)c + step;
    }
    good = HasColumn(file, name->load, strncmp(name->load, "load_m", 6) ? "N" : "N m", loads, steps, 0) && good;
    good = HasColumn(file, name->rigid, strncmp(name->rigid, "rot_", 4) ? "m" : "rad", rigids, steps, 0) && good;
  }
  return good;
}

static inline int HasHistory(hid_t file, int steps)
{
  int good = HasLoads(file, steps);

  for (int c = 0; c < NUM_COLUMNS; c++) {
    double expected[STEPS];

    for (int step = 0; step < STEPS; step++) expected[step] = columns[c].first + step;
    good = HasColumn(file, columns[c].name, columns[c].units, expected, steps, columns[c].whole) && good;
  }
  return HasColumn(file, "status", "1", statuses, steps, 1) && good;
}

static inline int HasRoot(hid_t file, SamGrid grid, int saved)
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
static inline int IsGood(const char *name, SamGrid grid, int steps, int saved)
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

/* Rank 0 copies a file byte by byte. */
static inline int CopyFile(const char *from, const char *to)
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

static inline SamParameters NewParameters(PetscReal value)
{
  SamParameters p = {.count = 0};

  sam_call(SamParametersAddReals(&p, "friction", PETSC_TRUE, 1, &value));
  return p;
}

#endif

/*
 * The separations: closed forms of the shapes, fields read from HDF5 files, and messages about wrong input.
 */
#include "samtest.h"

#include <float.h>
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <petsam/private/gapimpl.h> /* to register a shape */
#include <petsam/private/gap.h>

/* The heights are a few operations on doubles. */
static const double rounding = 8 * DBL_EPSILON;

/* Grids that do not divide, and one with fewer rows than ranks. */
static const PetscInt sizes[][2] = {{13, 7}, {5, 2}, {8, 9}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]) };

static const char good_file[] = "test_gap_good.h5", bad_file[] = "test_gap_bad.h5", text_file[] = "test_gap_text.txt";

static SamGrid CreateGrid(int k)
{
  const PetscReal width[2] = {3e-3, 2e-3}, center[2] = {0.2e-3, -0.1e-3};
  SamGrid         grid;

  sam_call(SamGridCreate(PETSC_COMM_WORLD, sizes[k], width, center, &grid));
  return grid;
}

/* The separation that the options give on the grid; the caller destroys it. */
static Vec Fill(SamGrid grid, const char *options)
{
  SamGap gap;
  Vec    h;

  SetOptions(options);
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGapSetFromOptions(gap));
  sam_call(SamGridCreateVec(grid, 1, &h));
  sam_call(SamGapFill(gap, grid, h));
  sam_call(SamGapDestroy(&gap));
  return h;
}

/* The largest difference to a function of the place, relative to its largest value, on this rank. */
static double Error(SamGrid grid, Vec h, double (*exact)(double, double))
{
  const PetscScalar *array;
  double             error = 0, largest = DBL_MIN;

  sam_call(VecGetArrayRead(h, &array));
  for (PetscInt j = 0; j < grid->rows; j++) {
    for (PetscInt i = 0; i < grid->nx; i++) {
      const double value = exact(SamGridX(grid, i), SamGridY(grid, grid->row_start + j));

      error   = fmax(error, fabs(array[j * grid->nx + i] - value));
      largest = fmax(largest, fabs(value));
    }
  }
  sam_call(VecRestoreArrayRead(h, &array));
  return error / largest;
}

static void AssertShape(const char *options, double (*exact)(double, double))
{
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid grid = CreateGrid(k);
    Vec     h    = Fill(grid, options);

    sam_assert_close(Error(grid, h, exact), 0, rounding);
    sam_call(VecDestroy(&h));
    sam_call(SamGridDestroy(&grid));
  }
}

/* ---- shapes ---- */

static double Sphere(double x, double y)
{
  return (x * x + y * y) / (2 * 0.012);
}

static double Cylinder(double x, double y)
{
  (void)y;
  return x * x / (2 * 0.03);
}

static double Ellipsoid(double x, double y)
{
  return x * x / (2 * 0.03) + y * y / (2 * 0.01);
}

static double Punch(double x, double y)
{
  const double r = sqrt(x * x + y * y);

  return r <= 0.4e-3 ? 0 : (r - 0.4e-3) * (r - 0.4e-3) / (2 * 0.05);
}

static double Flat(double x, double y)
{
  (void)x;
  (void)y;
  return 0;
}

static void test_spheres_add_their_curvatures(void **state)
{
  (void)state;
  AssertShape("-gap_type sphere -gap_radius1 0.03 -gap_radius2 0.02", Sphere);
  AssertShape("-gap_type sphere -gap_radius1 0.02 -gap_radius2 0.03", Sphere);
}

static void test_infinite_radius_is_flat(void **state)
{
  (void)state;
  AssertShape("-gap_type sphere -gap_radius1 0.012 -gap_radius2 inf", Sphere);
  AssertShape("-gap_type sphere -gap_radius1 inf -gap_radius2 inf", Flat);
  AssertShape("-gap_type ellipsoid -gap_radius_x 0.03 -gap_radius_y inf", Cylinder);
}

static void test_ellipsoid_has_its_curvatures_along_x_and_y(void **state)
{
  (void)state;
  AssertShape("-gap_type ellipsoid -gap_radius_x 0.03 -gap_radius_y 0.01", Ellipsoid);
  AssertShape("-gap_type ellipsoid -gap_radius_x 0.012 -gap_radius_y 0.012", Sphere);
}

static void test_punch_is_flat_inside_and_round_outside(void **state)
{
  (void)state;
  /* r - c loses digits, of the size of r, which is at most 10 times c here */
  AssertShape("-gap_type punch -gap_flat_radius 0.4e-3 -gap_edge_radius 0.05", Punch);
  AssertShape("-gap_type punch -gap_flat_radius 0 -gap_edge_radius 0.012", Sphere);
}

/* Body 2's x is turned by 30 degrees: the quadratic form along and across it is added to that of body 1. */
static double Curved(double x, double y)
{
  const double along = 0.5 * sqrt(3) * x + 0.5 * y, across = 0.5 * sqrt(3) * y - 0.5 * x;

  return x * x / (2 * 0.03) + y * y / (2 * 0.02) + along * along / (2 * 0.05) - across * across / (2 * 0.08);
}

static double Pad(double x, double y)
{
  const double u = fmax(0, fabs(x) - 0.3e-3), v = fmax(0, fabs(y) - 0.5e-3);

  return u * u / (2 * 0.03) + v * v / (2 * 0.02);
}

static double PadAlong(double x, double y)
{
  const double u = fmax(0, fabs(x) - 0.3e-3);

  (void)y;
  return u * u / (2 * 0.03);
}

/* Beyond the ends, y = 0.6 mm, along the tangent. */
static double Roller(double x, double y)
{
  const double A = 1e-7, d = 4e-7, part = 1 - exp(-d / A), s = fmin(1, fabs(y) / 0.6e-3);
  const double slope = 2 * A * part / (1 - part) / 0.6e-3;

  return x * x / (2 * 0.03) - A * log(1 - part * s * s) + slope * fmax(0, fabs(y) - 0.6e-3);
}

static void test_curved_bodies_add_what_each_has_along_its_axes(void **state)
{
  (void)state;
  AssertShape("-gap_type curved -gap_radius1_x 0.03 -gap_radius1_y 0.02 -gap_radius2_x 0.05 -gap_radius2_y -0.08 "
              "-gap_angle 30",
              Curved);
  AssertShape("-gap_type curved -gap_radius1_x 0.012 -gap_radius2_x 0.012 -gap_angle 90", Sphere);
  AssertShape("-gap_type curved -gap_radius2_x 0.03", Cylinder);
}

static void test_pads_are_flat_with_round_edges_on_each_side(void **state)
{
  (void)state;
  AssertShape("-gap_type pad -gap_half_flat_x 0.3e-3 -gap_half_flat_y 0.5e-3 -gap_edge_radius_x 0.03 "
              "-gap_edge_radius_y 0.02",
              Pad);
  AssertShape("-gap_type pad -gap_half_flat_x 0.3e-3 -gap_edge_radius_x 0.03", PadAlong);
}

static void test_rollers_are_logarithmic_up_to_their_ends(void **state)
{
  (void)state;
  AssertShape("-gap_type roller -gap_roller_radius 0.03 -gap_roller_half_length 0.6e-3 -gap_roller_crown 1e-7 "
              "-gap_roller_drop 4e-7",
              Roller);
}

static void test_flat_is_zero(void **state)
{
  (void)state;
  AssertShape("-gap_type flat", Flat);
}

static void test_parameters_are_the_options(void **state)
{
  SamGap             gap;
  SamGapType         type;
  PetscInt           count;
  const char *const *names;
  const PetscReal   *values;

  (void)state;
  SetOptions("-gap_type punch -gap_flat_radius 0.004 -gap_edge_radius 0.5");
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGapSetFromOptions(gap));
  sam_call(SamGapGetParameters(gap, &type, &count, &names, &values));
  sam_assert(!strcmp(type, SAM_GAP_PUNCH) && count == 2);
  sam_assert(!strcmp(names[0], "gap_flat_radius") && values[0] == 0.004);
  sam_assert(!strcmp(names[1], "gap_edge_radius") && values[1] == 0.5);
  sam_call(SamGapSetType(gap, SAM_GAP_FILE));
  sam_call(SamGapGetParameters(gap, NULL, &count, NULL, NULL));
  sam_assert(count == 0);
  sam_call(SamGapDestroy(&gap));
}

/* By setters, with and without the class's part of a name; options only override. */
static void test_parameters_can_be_set(void **state)
{
  SamGrid          grid = CreateGrid(0);
  SamGap           gap;
  const PetscReal *values;
  Vec              h;

  (void)state;
  SetOptions("");
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGridCreateVec(grid, 1, &h));
  sam_fails(SamGapSetParameter(gap, "radius1", 1), PETSC_ERR_ARG_OUTOFRANGE); /* it has no type yet */
  sam_call(SamGapSetType(gap, SAM_GAP_SPHERE));
  sam_fails(SamGapSetParameter(gap, "radius3", 1), PETSC_ERR_ARG_OUTOFRANGE);
  sam_fails(SamGapSetParameter(gap, "radius1", -1), PETSC_ERR_ARG_OUTOFRANGE);
  sam_fails(SamGapSetParameter(gap, "radius1", NAN), PETSC_ERR_ARG_OUTOFRANGE);
  sam_call(SamGapSetParameter(gap, "radius1", 0.03));
  sam_fails(SamGapFill(gap, grid, h), PETSC_ERR_ORDER); /* the other radius is not set */
  sam_fails(SamGapSetFromOptions(gap), SAM_ERR_USER);
  sam_call(SamGapSetParameter(gap, "gap_radius2", 0.02));
  sam_call(SamGapSetFromOptions(gap));
  sam_call(SamGapFill(gap, grid, h));
  sam_assert_close(Error(grid, h, Sphere), 0, rounding);
  SetOptions("-gap_type sphere -gap_radius2 0.5");
  sam_call(SamGapSetFromOptions(gap));
  sam_call(SamGapGetParameters(gap, NULL, NULL, NULL, &values));
  sam_assert(values[0] == 0.03 && values[1] == 0.5);
  sam_call(VecDestroy(&h));
  sam_call(SamGapDestroy(&gap));
  sam_call(SamGridDestroy(&grid));
}

/* ---- files ---- */

/* What the files hold at a cell, different for each, exact in single precision and as a whole number. */
static double Stored(PetscInt i, PetscInt j)
{
  return (double)(1000 * j + i);
}

/* Rank 0 writes a dataset of the given shape, stored as `type`. */
static void WriteDataset(const char *file, const char *name, hid_t type, int rank, const hsize_t shape[],
                         PetscBool chunked, double corner)
{
  if (!Rank()) {
    const hid_t f     = H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                space = H5Screate_simple(rank, shape, NULL), creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk[2] = {2, 3}, count = (hsize_t)H5Sget_simple_extent_npoints(space);
    const hsize_t columns = shape[rank - 1];
    double       *values  = (double *)malloc(count * sizeof(*values));
    hid_t         dataset;

    for (hsize_t k = 0; k < count; k++) values[k] = Stored((PetscInt)(k % columns), (PetscInt)(k / columns));
    values[count - 1] += corner;
    if (chunked) {
      H5Pset_chunk(creation, rank, chunk);
      H5Pset_deflate(creation, 4);
    }
    dataset = H5Dcreate2(f, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(dataset);
    H5Pclose(creation);
    H5Sclose(space);
    H5Fclose(f);
    free(values);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

static int HasStored(SamGrid grid, Vec h, double (*added)(double, double))
{
  const PetscScalar *array;
  int                good = 1;

  sam_call(VecGetArrayRead(h, &array));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++)
      if (array[j * grid->nx + i] !=
          Stored(i, grid->row_start + j) + added(SamGridX(grid, i), SamGridY(grid, grid->row_start + j)))
        good = 0;
  sam_call(VecRestoreArrayRead(h, &array));
  return good;
}

/* Rows are y: exactly the stored values at their cells, whatever the ranks, the type and the storage. */
static void test_file_gives_its_values_to_the_cells(void **state)
{
  const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_IEEE_F32BE, H5T_STD_I16LE, H5T_STD_U32BE};

  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    const hsize_t shape[2] = {(hsize_t)sizes[k][1], (hsize_t)sizes[k][0]};

    for (int t = 0; t < 8; t++) {
      SamGrid grid = CreateGrid(k);
      Vec     h;

      WriteDataset(good_file, "height", types[t / 2], 2, shape, t % 2 ? PETSC_TRUE : PETSC_FALSE, 0);
      h = Fill(grid, "-gap_type file -gap_file test_gap_good.h5");
      sam_assert(HasStored(grid, h, Flat));
      sam_call(VecDestroy(&h));
      sam_call(SamGridDestroy(&grid));
    }
  }
  RemoveFile(good_file);
}

static void test_roughness_is_added_to_any_shape(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    const hsize_t shape[2] = {(hsize_t)sizes[k][1], (hsize_t)sizes[k][0]};
    SamGrid       grid     = CreateGrid(k);
    Vec           h;
    double        difference;

    WriteDataset(good_file, "rough", H5T_NATIVE_DOUBLE, 2, shape, PETSC_FALSE, 0);
    h = Fill(grid, "-gap_type flat -gap_rough_file test_gap_good.h5 -gap_rough_dataset rough");
    sam_assert(HasStored(grid, h, Flat));
    sam_call(VecDestroy(&h));
    h = Fill(grid, "-gap_type file -gap_file test_gap_good.h5 -gap_dataset /rough -gap_rough_file test_gap_good.h5 "
                   "-gap_rough_dataset /rough");
    sam_call(VecScale(h, 0.5));
    sam_assert(HasStored(grid, h, Flat));
    sam_call(VecDestroy(&h));
    h = Fill(grid, "-gap_type ellipsoid -gap_radius_x 1e-6 -gap_radius_y inf -gap_rough_file test_gap_good.h5 "
                   "-gap_rough_dataset /rough");
    {
      Vec shape_only = Fill(grid, "-gap_type ellipsoid -gap_radius_x 1e-6 -gap_radius_y inf"),
          rough      = Fill(grid, "-gap_type file -gap_file test_gap_good.h5 -gap_dataset rough");

      sam_call(VecAXPY(shape_only, 1, rough));
      sam_call(VecAXPY(shape_only, -1, h));
      sam_call(VecNorm(shape_only, NORM_INFINITY, &difference));
      sam_destroy(&shape_only, &rough);
    }
    sam_assert(difference == 0);
    sam_call(VecDestroy(&h));
    sam_call(SamGridDestroy(&grid));
  }
  RemoveFile(good_file);
}

/* ---- wrong input ---- */

/* Whether the options raise this error on all ranks, with each of the two words (or NULL) in the message. */
static void AssertError(const char *options, PetscErrorCode expected, const char *word, const char *other)
{
  SamGrid        grid = CreateGrid(0);
  SamGap         gap;
  Vec            h;
  PetscErrorCode ierr;
  int            good;

  SetOptions(options);
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGridCreateVec(grid, 1, &h));
  BeginCatching();
  ierr = SamGapSetFromOptions(gap);
  if (!ierr) ierr = SamGapFill(gap, grid, h);
  EndCatching();
  good = ierr == expected && (!word || strstr(CaughtMessage(), word)) && (!other || strstr(CaughtMessage(), other));
  if (!good) print_error("%s: error %d, %s\n", options, (int)ierr, CaughtMessage());
  sam_assert(good);
  sam_call(PetscOptionsClear(NULL));
  sam_call(VecDestroy(&h));
  sam_call(SamGapDestroy(&gap));
  sam_call(SamGridDestroy(&grid));
}

static void test_wrong_options_are_named(void **state)
{
  static const char *const cases[][3] = {
    {"-gap_radius1 1", "-gap_type", "missing"},
    {"-gap_type cone", "-gap_type cone", "curved, ellipsoid, file, flat, pad, punch, roller or sphere"},
    {"-gap_type", "-gap_type", "no value"},
    {"-gap_type sphere -gap_radius1 1", "-gap_radius2", "missing"},
    {"-gap_type sphere -gap_radius1 -1 -gap_radius2 1", "-gap_radius1", "> 0"},
    {"-gap_type sphere -gap_radius1 0 -gap_radius2 1", "-gap_radius1", "> 0"},
    {"-gap_type sphere -gap_radius1 1 -gap_radius2 -inf", "-gap_radius2", "inf"},
    {"-gap_type sphere -gap_radius1 1kN -gap_radius2 1", "-gap_radius1", "1kN"},
    {"-gap_type sphere -gap_radius1 1e-320 -gap_radius2 1", "-gap_type sphere", "finite"},
    {"-gap_type ellipsoid -gap_radius_x 1", "-gap_radius_y", "missing"},
    {"-gap_type ellipsoid -gap_radius_x 1 -gap_radius_y nan", "-gap_radius_y", "nan"},
    {"-gap_type punch -gap_edge_radius 1", "-gap_flat_radius", "missing"},
    {"-gap_type punch -gap_flat_radius -1 -gap_edge_radius 1", "-gap_flat_radius", ">= 0"},
    {"-gap_type punch -gap_flat_radius 1 -gap_edge_radius inf", "-gap_edge_radius", "inf"},
    {"-gap_type punch -gap_flat_radius inf -gap_edge_radius 1", "-gap_flat_radius", "inf"},
    {"-gap_type file", "-gap_file", "missing"},
    {"-gap_type file -gap_dataset /height", "-gap_file", "-gap_dataset"},
    {"-gap_type flat -gap_rough_dataset /height", "-gap_rough_dataset", "-gap_rough_file"}};

  (void)state;
  for (size_t c = 0; c < sizeof(cases) / sizeof(cases[0]); c++)
    AssertError(cases[c][0], SAM_ERR_USER, cases[c][1], cases[c][2]);
}

static void test_unusable_files_are_named_on_all_ranks(void **state)
{
  (void)state;
  if (!Rank()) {
    FILE *file = fopen(text_file, "w");

    if (file) {
      (void)fputs("0 1 2\n", file);
      (void)fclose(file);
    }
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  AssertError("-gap_type file -gap_file test_gap_none.h5", SAM_ERR_FILE, "-gap_file test_gap_none.h5",
              "cannot be read");
  AssertError("-gap_type file -gap_file .", SAM_ERR_FILE, "-gap_file .", "cannot be read");
  AssertError("-gap_type file -gap_file test_gap_text.txt", SAM_ERR_FILE, "-gap_file test_gap_text.txt",
              "is not an HDF5 file");
  AssertError("-gap_type flat -gap_rough_file test_gap_none.h5", SAM_ERR_FILE, "-gap_rough_file test_gap_none.h5",
              "cannot be read");
  RemoveFile(text_file);
}

static void test_truncated_file_is_refused(void **state)
{
  const hsize_t shape[2] = {(hsize_t)sizes[0][1], (hsize_t)sizes[0][0]};

  (void)state;
  WriteDataset(bad_file, "/height", H5T_NATIVE_DOUBLE, 2, shape, PETSC_FALSE, 0);
  sam_assert(Rank() || !truncate(bad_file, 1000));
  AssertError("-gap_type file -gap_file test_gap_bad.h5", SAM_ERR_FILE, "-gap_file test_gap_bad.h5", "cannot be read");
  RemoveFile(bad_file);
}

static void test_unfit_datasets_are_named_on_all_ranks(void **state)
{
  const hsize_t good[2] = {(hsize_t)sizes[0][1], (hsize_t)sizes[0][0]}, turned[2] = {good[1], good[0]},
                deep[3] = {1, good[0], good[1]};
  const char *options   = "-gap_type file -gap_file test_gap_bad.h5";
  hid_t       text;

  (void)state;
  WriteDataset(bad_file, "/height", H5T_NATIVE_DOUBLE, 2, turned, PETSC_FALSE, 0);
  AssertError(options, SAM_ERR_FILE, "(13, 7)", "(7, 13)");
  AssertError("-gap_type file -gap_file test_gap_bad.h5 -gap_dataset /z", SAM_ERR_FILE, "has no dataset /z",
              "-gap_dataset");
  AssertError("-gap_type file -gap_file test_gap_bad.h5 -gap_dataset /", SAM_ERR_FILE, "has no dataset /",
              "-gap_dataset");
  AssertError("-gap_type flat -gap_rough_file test_gap_bad.h5 -gap_rough_dataset /a/b", SAM_ERR_FILE,
              "has no dataset /a/b", "-gap_rough_dataset");
  WriteDataset(bad_file, "/height", H5T_NATIVE_DOUBLE, 3, deep, PETSC_FALSE, 0);
  AssertError(options, SAM_ERR_FILE, "3 dimension", "(ny, nx)");
  WriteDataset(bad_file, "/height", H5T_NATIVE_DOUBLE, 2, good, PETSC_FALSE, NAN);
  AssertError(options, SAM_ERR_FILE, "/height[6, 12]", "finite");
  WriteDataset(bad_file, "/height", H5T_NATIVE_DOUBLE, 2, good, PETSC_FALSE, INFINITY);
  AssertError(options, SAM_ERR_FILE, "/height[6, 12]", "finite");
  text = H5Tcopy(H5T_C_S1);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* numbers are not written as text; the dataset is there all the same */
  WriteDataset(bad_file, "/height", text, 2, good, PETSC_FALSE, 0);
  H5Tclose(text);
  AssertError(options, SAM_ERR_FILE, "numbers", "/height");
  RemoveFile(bad_file);
}

/* ---- help and registry ---- */

static void test_help_lists_the_options_of_all_shapes(void **state)
{
  static const char *const names[] = {"-gap_type",     "-gap_radius1",     "-gap_radius2",       "-gap_radius_x",
                                      "-gap_radius_y", "-gap_flat_radius", "-gap_edge_radius",   "-gap_file",
                                      "-gap_dataset",  "-gap_rough_file",  "-gap_rough_dataset", "-gap_radius2_y",
                                      "-gap_angle",    "-gap_half_flat_x", "-gap_roller_crown"};
  static char              text[16384];
  FILE                    *usual = PETSC_STDOUT, *file = tmpfile();
  size_t                   length;
  SamGap                   gap;

  (void)state;
  sam_assert(file != NULL);
  SetOptions("-help -gap_rough_dataset /z");
  PETSC_STDOUT = file;
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGapSetFromOptions(gap));
  sam_call(SamGapDestroy(&gap));
  PETSC_STDOUT = usual;
  rewind(file);
  length       = fread(text, 1, sizeof(text) - 1, file);
  text[length] = '\0';
  (void)fclose(file);
  SetOptions("");
  for (size_t k = 0; k < sizeof(names) / sizeof(names[0]); k++) {
    char whole[64];

    (void)snprintf(whole, sizeof(whole), "%s ", names[k]);
    sam_assert(Rank() || strstr(text, whole));
  }
}

static PetscReal Height_Ridge(const PetscReal values[], PetscReal x, PetscReal y)
{
  (void)values;
  (void)x;
  return fabs(y);
}

static PetscErrorCode CreateRidge(SamGap gap)
{
  gap->ops.height = Height_Ridge;
  return 0;
}

static double Ridge(double x, double y)
{
  (void)x;
  return fabs(y);
}

static void test_registered_type_can_be_chosen(void **state)
{
  (void)state;
  sam_call(SamGapRegister("ridge", CreateRidge));
  AssertShape("-gap_type ridge", Ridge);
  AssertError("-gap_type cone", SAM_ERR_USER, "-gap_type cone",
              "curved, ellipsoid, file, flat, pad, punch, ridge, roller or sphere");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_spheres_add_their_curvatures),
    cmocka_unit_test(test_infinite_radius_is_flat),
    cmocka_unit_test(test_ellipsoid_has_its_curvatures_along_x_and_y),
    cmocka_unit_test(test_punch_is_flat_inside_and_round_outside),
    cmocka_unit_test(test_curved_bodies_add_what_each_has_along_its_axes),
    cmocka_unit_test(test_pads_are_flat_with_round_edges_on_each_side),
    cmocka_unit_test(test_rollers_are_logarithmic_up_to_their_ends),
    cmocka_unit_test(test_flat_is_zero),
    cmocka_unit_test(test_parameters_are_the_options),
    cmocka_unit_test(test_parameters_can_be_set),
    cmocka_unit_test(test_file_gives_its_values_to_the_cells),
    cmocka_unit_test(test_roughness_is_added_to_any_shape),
    cmocka_unit_test(test_wrong_options_are_named),
    cmocka_unit_test(test_unusable_files_are_named_on_all_ranks),
    cmocka_unit_test(test_truncated_file_is_refused),
    cmocka_unit_test(test_unfit_datasets_are_named_on_all_ranks),
    cmocka_unit_test(test_help_lists_the_options_of_all_shapes),
    cmocka_unit_test(test_registered_type_can_be_chosen),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

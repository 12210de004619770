/*
 * What files of surfaces say about themselves: units, heights or a separation, and the size that must be the grid's.
 */
#include "samtest.h"

#include <float.h>
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <petsam/private/file.h>
#include <petsam/private/gapimpl.h>
#include <petsam/private/gap.h>

enum { NX = 5, NY = 3 };
static const PetscReal width[2] = {2.5e-3, 0.9e-3};
static const char      name[]   = "test_lengths.h5";

/* What is written; a member that is not set is left out. */
typedef struct {
  const char *units, *quantity, *axis_units;
  int         fixed;     /* texts of fixed length, padded by spaces */
  int         number;    /* the attribute units is a number */
  const char *packed;    /* an attribute that packed numbers have */
  double      size[2];   /* the attribute size */
  double      axis[2];   /* distances of the values of x and y */
  hsize_t     axis_more; /* values that x has too many */
} Words;

static void WriteText(hid_t object, const char *attribute, const char *text, int fixed)
{
  const hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
  char        padded[32];
  hid_t       id;

  H5Tset_size(type, fixed ? sizeof(padded) : H5T_VARIABLE);
  if (fixed) H5Tset_strpad(type, H5T_STR_SPACEPAD);
  memset(padded, ' ', sizeof(padded));
  if (fixed) memcpy(padded, text, strlen(text));
  id = H5Acreate2(object, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(id, type, fixed ? (const void *)padded : (const void *)&text);
  H5Aclose(id);
  H5Tclose(type);
  H5Sclose(space);
}

static void WriteNumbers(hid_t object, const char *attribute, hsize_t count, const double values[])
{
  const hid_t space = H5Screate_simple(1, &count, NULL),
              id    = H5Acreate2(object, attribute, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);

  H5Awrite(id, H5T_NATIVE_DOUBLE, values);
  H5Aclose(id);
  H5Sclose(space);
}

static void WriteAxis(hid_t file, const char *axis, hsize_t n, double distance, const char *axis_units)
{
  const hid_t space = H5Screate_simple(1, &n, NULL),
              id    = H5Dcreate2(file, axis, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  double values[NX + NY];

  for (hsize_t k = 0; k < n; k++) values[k] = 7 + (double)k * distance;
  H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  if (axis_units) WriteText(id, "units", axis_units, 0);
  H5Dclose(id);
  H5Sclose(space);
}

/* Rank 0 writes values 0, 1, 2, ... as /s/z, with the axes beside it. */
static void Write(const Words *words)
{
  const hsize_t shape[2] = {NY, NX};
  double        values[NY * NX];
  int           me;

  MPI_Comm_rank(PETSC_COMM_WORLD, &me);
  if (me == 0) {
    const hid_t file  = H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                group = H5Gcreate2(file, "s", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                space = H5Screate_simple(2, shape, NULL),
                id    = H5Dcreate2(group, "z", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);

    for (int k = 0; k < NY * NX; k++) values[k] = k;
    H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    if (words->units) WriteText(id, "units", words->units, words->fixed);
    if (words->number) WriteNumbers(id, "units", 1, values);
    if (words->packed) WriteNumbers(id, words->packed, 1, values + 1);
    if (words->quantity) WriteText(id, "quantity", words->quantity, words->fixed);
    if (words->size[0] != 0) WriteNumbers(id, "size", words->size[1] != 0 ? 2 : 1, words->size);
    if (words->axis[0] != 0) WriteAxis(group, "x", NX + words->axis_more, words->axis[0], words->axis_units);
    if (words->axis[1] != 0) WriteAxis(group, "y", NY, words->axis[1], words->axis_units);
    H5Dclose(id);
    H5Sclose(space);
    H5Gclose(group);
    H5Fclose(file);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* Reads the file as a gap, or as a roughness on a flat one. The error, and the factor from what is stored to that. */
static PetscErrorCode Read(const Words *words, PetscBool rough, double *factor)
{
  const PetscInt  n[2]      = {NX, NY};
  const PetscReal center[2] = {0, 0};
  const char     *text      = rough ? "-gap_type flat -gap_rough_file test_lengths.h5 -gap_rough_dataset /s/z"
                                    : "-gap_type file -gap_file test_lengths.h5 -gap_dataset /s/z";
  SamGrid         grid;
  SamGap          gap;
  Vec             h;
  double          sum = NAN;
  PetscErrorCode  ierr;

  Write(words);
  sam_call(SamGridCreate(PETSC_COMM_WORLD, n, width, center, &grid));
  SetOptions(text);
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGapSetFromOptions(gap));
  sam_call(SamGridCreateVec(grid, 1, &h));
  BeginCatching();
  ierr = SamGapFill(gap, grid, h);
  EndCatching();
  if (!ierr) sam_call(VecSum(h, &sum));
  *factor = sum / (NX * NY * (NX * NY - 1) / 2);
  sam_call(VecDestroy(&h));
  sam_call(SamGapDestroy(&gap));
  sam_call(SamGridDestroy(&grid));
  return ierr;
}

static void AssertFactor(const Words *words, double expected)
{
  double factor;

  for (int rough = 0; rough < 2; rough++) {
    sam_assert(!Read(words, rough ? PETSC_TRUE : PETSC_FALSE, &factor));
    sam_assert_close(factor / expected, 1, 16 * DBL_EPSILON);
  }
}

static void AssertRefused(const Words *words, const char *word, const char *other)
{
  double factor;

  for (int rough = 0; rough < 2; rough++) {
    const PetscErrorCode ierr = Read(words, rough ? PETSC_TRUE : PETSC_FALSE, &factor);

    sam_assert(ierr == SAM_ERR_FILE && strstr(CaughtMessage(), rough ? "-gap_rough_file" : "-gap_file") &&
               strstr(CaughtMessage(), word) && strstr(CaughtMessage(), other));
  }
}

static void test_values_are_in_the_files_units(void **state)
{
  static const struct {
    const char *units;
    double      metres;
  } known[] = {{"m", 1},
               {"mm", 1e-3},
               {"cm", 1e-2},
               {"um", 1e-6},
               {"\u00b5m", 1e-6},
               {"\u03bcm", 1e-6},
               {"micrometer", 1e-6},
               {"micrometre", 1e-6},
               {"microns", 1e-6},
               {"nm", 1e-9},
               {"nanometers", 1e-9},
               {"pm", 1e-12},
               {"angstrom", 1e-10},
               {"in", 0.0254},
               {"inch", 0.0254}};

  (void)state;
  AssertFactor(&(Words){0}, 1);
  for (size_t k = 0; k < sizeof(known) / sizeof(known[0]); k++) {
    AssertFactor(&(Words){.units = known[k].units}, known[k].metres);
    AssertFactor(&(Words){.units = known[k].units, .fixed = 1}, known[k].metres);
  }
}

static void test_heights_of_either_body_reduce_the_separation(void **state)
{
  (void)state;
  AssertFactor(&(Words){.quantity = "separation"}, 1);
  AssertFactor(&(Words){.quantity = "height1"}, -1);
  AssertFactor(&(Words){.quantity = "height2"}, -1);
  AssertFactor(&(Words){.quantity = "height2", .units = "nm", .fixed = 1}, -1e-9);
}

static void test_what_is_not_understood_is_named(void **state)
{
  (void)state;
  AssertRefused(&(Words){.units = "furlong"}, "furlong", "m, cm, mm, um, nm");
  AssertRefused(&(Words){.units = "M"}, "units is \"M\"", "um");
  AssertRefused(&(Words){.units = ""}, "units is \"\"", "um");
  AssertRefused(&(Words){.units = "a unit with a name so long that no message should have to hold all of its words"},
                "a unit with a name", "um");
  AssertRefused(&(Words){.number = 1}, "not a text", "um");
  AssertRefused(&(Words){.packed = "scale_factor"}, "packed", "the numbers themselves");
  AssertRefused(&(Words){.packed = "add_offset"}, "packed", "the numbers themselves");
  AssertRefused(&(Words){.quantity = "depth"}, "depth", "height1, height2");
  AssertRefused(&(Words){.quantity = "height"}, "quantity is \"height\"", "height1, height2");
  AssertRefused(&(Words){.size = {2.5e-3}}, "size", "two positive numbers");
  AssertRefused(&(Words){.size = {2.5e-3, -0.9e-3}}, "size", "two positive numbers");
  AssertRefused(&(Words){.axis = {0.5e-3, 0.3e-3}, .axis_units = "ell"}, "x: its attribute units is \"ell\"", "um");
}

static void test_surface_of_another_size_is_refused(void **state)
{
  (void)state;
  AssertFactor(&(Words){.size = {2.5e-3, 0.9e-3}}, 1);
  AssertFactor(&(Words){.size = {2.502e-3, 0.9e-3}}, 1); /* within the tolerance */
  AssertFactor(&(Words){.axis = {0.5, 0.3}, .axis_units = "mm"}, 1);
  AssertRefused(&(Words){.size = {2.51e-3, 0.9e-3}}, "0.00251", "-grid_size 0.00251,0.0009");
  AssertRefused(&(Words){.size = {2.5e-3, 0.91e-3}}, "0.00091", "-grid_size 0.0025,0.00091");
  AssertRefused(&(Words){.axis = {0.5, 0.3}, .axis_units = "um"}, "2.5e-06 m x 9e-07 m", "-grid_size 2.5e-06,9e-07");
  AssertRefused(&(Words){.axis = {0.5, 0.31}, .axis_units = "mm"}, "0.00093", "-grid_size 0.0025,0.00093");
  AssertRefused(&(Words){.axis = {0, 0.31}, .axis_units = "mm"}, "0.00093", "-grid_size 0.0025,0.00093");
  AssertRefused(&(Words){.axis = {-0.5, 0.3}, .axis_units = "mm"}, "x falls", "mirrored");
  AssertRefused(&(Words){.axis = {0.5, -0.3}, .axis_units = "mm"}, "y falls", "mirrored");
}

/* Files that were good before these attributes were: axes without units say nothing, nor do axes of something else. */
static void test_axes_without_units_say_nothing(void **state)
{
  (void)state;
  AssertFactor(&(Words){.axis = {0.5, 0.3}}, 1);
  AssertFactor(&(Words){.axis = {0.7e-3, 0.3e-3}, .axis_units = "m", .axis_more = 2}, 1);
}

/* ---- the grid of a file ---- */

/* The error, cells, widths and centre that options, or setters if there are none, give for a file. */
static PetscErrorCode GetGrid(const Words *words, const char *options, PetscInt n[2], PetscReal size[2],
                              PetscReal center[2])
{
  SamGap         gap;
  PetscErrorCode ierr;

  Write(words);
  SetOptions(options);
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  if (!options[0]) sam_call(SamGapSetFile(gap, PETSC_TRUE, "test_lengths.h5", "/s/z"));
  BeginCatching();
  ierr = SamGapGetFileGrid(gap, n, size, center);
  EndCatching();
  sam_call(SamGapDestroy(&gap));
  sam_call(PetscOptionsClear(NULL));
  return ierr;
}

static void test_file_tells_its_grid(void **state)
{
  static const char *const asked[] = {"", "-gap_file test_lengths.h5 -gap_dataset /s/z",
                                      "-gap_type file -gap_file test_lengths.h5 -gap_dataset /s/z -grid_n 9",
                                      "-gap_type flat -gap_rough_file test_lengths.h5 -gap_rough_dataset /s/z"};
  const Words              known[] = {{.size = {2.5e-3, 0.9e-3}}, {.axis = {0.5, 0.3}, .axis_units = "mm"}};
  PetscInt                 n[2];
  PetscReal                size[2], center[2];

  (void)state;
  for (size_t k = 0; k < sizeof(asked) / sizeof(asked[0]); k++)
    for (size_t w = 0; w < 2; w++) {
      sam_assert(!GetGrid(&known[w], asked[k], n, size, center));
      sam_assert(n[0] == NX && n[1] == NY && size[0] == width[0] && size[1] == width[1]);
      /* the axes begin at 7 mm */
      sam_assert(center[0] == (w ? 8e-3 : 0) && center[1] == (w ? 7.3e-3 : 0));
    }
}

static void test_file_that_does_not_tell_its_grid_is_named(void **state)
{
  static const char asks[] = "-gap_file test_lengths.h5 -gap_dataset /s/z";
  const Words       half   = {.axis = {0.5}, .axis_units = "mm"};
  PetscInt          n[2];
  PetscReal         size[2], center[2];
  char              more[128];

  (void)state;
  sam_assert(GetGrid(&(Words){0}, asks, n, size, center) == SAM_ERR_USER);
  sam_assert(strstr(CaughtMessage(), "-grid_size is missing") && strstr(CaughtMessage(), "records no size of /s/z"));
  sam_assert(GetGrid(&half, asks, n, size, center) == SAM_ERR_USER);
  (void)snprintf(more, sizeof(more), "%s -grid_size 1", asks);
  sam_assert(!GetGrid(&half, more, n, size, center) && n[0] == NX && n[1] == NY);
  sam_assert(GetGrid(&(Words){.units = "ell"}, asks, n, size, center) == SAM_ERR_FILE);
  sam_assert(!GetGrid(&half, "-gap_type sphere -gap_radius1 1 -gap_radius2 1", n, size, center) && n[0] == 0 &&
             size[1] == 0);
  sam_assert(!GetGrid(&half, "-gap_file none.h5 -grid_n 4 -grid_size 1", n, size, center) &&
             n[0] == 0); /* is not asked for */
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_values_are_in_the_files_units),
    cmocka_unit_test(test_heights_of_either_body_reduce_the_separation),
    cmocka_unit_test(test_what_is_not_understood_is_named),
    cmocka_unit_test(test_surface_of_another_size_is_refused),
    cmocka_unit_test(test_axes_without_units_say_nothing),
    cmocka_unit_test(test_file_tells_its_grid),
    cmocka_unit_test(test_file_that_does_not_tell_its_grid_is_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

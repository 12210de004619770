/*
 * Friction from options: a number, or a field in an HDF5 file.
 */
#include "contacts.h"

#include <hdf5.h>
#include <unistd.h>

enum { NX = 13, NY = 7 };
static const char file[] = "test_friction.h5";

/* The last value of the file is `last`. */
static void WriteField(const char *name, double last)
{
  int rank;

  (void)MPI_Barrier(PETSC_COMM_WORLD);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    const hsize_t shape[2] = {NY, NX};
    const hid_t   f = H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), s = H5Screate_simple(2, shape, NULL),
                dataset = H5Dcreate2(f, name, H5T_NATIVE_DOUBLE, s, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    double values[NX * NY];

    for (int k = 0; k < NX * NY; k++) values[k] = 0.25 * k;
    values[NX * NY - 1] = last;
    (void)H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    (void)H5Dclose(dataset);
    (void)H5Sclose(s);
    (void)H5Fclose(f);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

static void Remove(void)
{
  int rank;

  (void)MPI_Barrier(PETSC_COMM_WORLD);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) (void)unlink(file);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* A problem with friction 0.125, and what reading the options returned. */
typedef struct {
  SamGrid        grid;
  SamElasticity  elasticity;
  SamProblem     problem;
  PetscErrorCode code;
} Read;

static Read ReadFriction(const char *options, const char *prefix)
{
  const SamPair pair = Steel();
  Read          r    = {.grid = NewGrid(NX, NY, 1, 1)};

  sam_call(SamElasticityCreate(r.grid, pair, &r.elasticity));
  sam_call(SamProblemCreate(r.elasticity, &r.problem));
  sam_call(SamProblemSetFriction(r.problem, 0.125));
  SetOptions(options);
  BeginCatching();
  r.code = SamProblemSetLawsFromOptions(r.problem, &(SamOptions){PETSC_COMM_WORLD, prefix});
  EndCatching();
  SetOptions("");
  return r;
}

static void DestroyRead(Read *r)
{
  sam_call(SamProblemDestroy(&r->problem));
  sam_call(SamElasticityDestroy(&r->elasticity));
  sam_call(SamGridDestroy(&r->grid));
}

static void AssertNumber(const char *options, const char *prefix, double expected)
{
  Read r = ReadFriction(options, prefix);

  sam_assert(r.code == 0);
  sam_assert(HasCoefficient(r.problem, expected));
  DestroyRead(&r);
}

static void test_number_is_that_of_the_option(void **state)
{
  (void)state;
  AssertNumber("-friction 0.75", NULL, 0.75);
  AssertNumber("-friction 0", NULL, 0);
  AssertNumber("", NULL, 0.125); /* what was set stays */
  AssertNumber("-friction 0.75 -a_friction 0.5", "a_", 0.5);
}

static void test_field_is_that_of_the_file(void **state)
{
  static const char *const names[] = {"/friction", "/mu"};

  (void)state;
  for (int k = 0; k < 2; k++) {
    const double *values;
    Read          r;
    Vec           field;
    int           good = 1;

    WriteField(names[k], 0);
    r = ReadFriction(k ? "-friction_file test_friction.h5 -friction_dataset /mu" : "-friction_file test_friction.h5",
                     NULL);
    sam_assert(r.code == 0);
    field = NewField(r.grid, 1);
    sam_call(VecSet(field, 1));
    ComputeBound(r.problem, 1, field, field);
    sam_call(VecGetArrayRead(field, &values));
    for (PetscInt c = 0; c < r.grid->cells; c++) {
      const PetscInt cell = r.grid->row_start * NX + c;

      good = good && values[c] == (cell == NX * NY - 1 ? 0 : 0.25 * (double)cell);
    }
    sam_call(VecRestoreArrayRead(field, &values));
    sam_call(VecDestroy(&field));
    sam_assert(good);
    DestroyRead(&r);
  }
  Remove();
}

static void AssertRefused(const char *options, PetscErrorCode code, const char *one, const char *other)
{
  Read r = ReadFriction(options, NULL);

  if (r.code != code) print_error("%s: error %d: %s\n", options, (int)r.code, CaughtMessage());
  sam_assert(r.code == code && strstr(CaughtMessage(), one) && strstr(CaughtMessage(), other));
  sam_assert(HasCoefficient(r.problem, 0.125));
  DestroyRead(&r);
}

static void test_wrong_friction_is_refused(void **state)
{
  (void)state;
  AssertRefused("-friction -0.1", SAM_ERR_USER, "-friction", "-0.1");
  AssertRefused("-friction inf", SAM_ERR_USER, "-friction", "inf");
  AssertRefused("-friction 0.3 -friction_file f.h5", SAM_ERR_USER, "-friction and", "-friction_file");
  AssertRefused("-friction_dataset /mu", SAM_ERR_USER, "-friction_dataset", "-friction_file");
  AssertRefused("-friction_file test_friction_none.h5", SAM_ERR_FILE, "-friction_file test_friction_none.h5", "read");
}

/* In the last cell: it is told on all ranks. */
static void test_wrong_values_of_the_file_are_named(void **state)
{
  (void)state;
  WriteField("/friction", -1e-9);
  AssertRefused("-friction_file test_friction.h5", SAM_ERR_FILE, "/friction[6, 12]", "less than 0");
  WriteField("/friction", NAN);
  AssertRefused("-friction_file test_friction.h5", SAM_ERR_FILE, "/friction[6, 12]", "finite");
  AssertRefused("-friction_file test_friction.h5 -friction_dataset /mu", SAM_ERR_FILE, "has no dataset /mu",
                "-friction_dataset");
  Remove();
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_number_is_that_of_the_option),
    cmocka_unit_test(test_field_is_that_of_the_file),
    cmocka_unit_test(test_wrong_friction_is_refused),
    cmocka_unit_test(test_wrong_values_of_the_file_are_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

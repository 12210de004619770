/*
 * Friction from options: a number, or a field in an HDF5 file.
 */
#include "contacts.h"

#include <petsam/private/lawimpl.h>

#include <hdf5.h>
#include <unistd.h>

enum { NX = 13, NY = 7 };
static const char file[] = "test_friction.h5";

/* The last value of the file is `last`. */
static void WriteField(const char *name, double last)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) {
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
  RemoveFile(file);
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
  AssertRefused("-friction 0.3 -friction_file f.h5", SAM_ERR_USER, "-friction does not work with", "-friction_file");
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
  RemoveFile(file);
}

/* A law of another file, which is a word of -friction_law. */
static const SamOptionRow rows[] = {{"friction_part", "part that is left", SAM_OPTION_REAL, .range = SAM_RANGE_PART,
                                     .needs = "friction_law partial", .missing = "required by -friction_law partial",
                                     .recorded = PETSC_TRUE}};

static PetscErrorCode CreatePartial(SamLaw law)
{
  PetscReal *part;

  sam_call(PetscNew(&part));
  *part          = NAN;
  law->data      = part;
  law->option    = "friction_law";
  law->word      = "partial";
  law->rows      = rows;
  law->row_count = 1;
  return PETSC_SUCCESS;
}

static void test_words_are_those_of_the_registered_laws(void **state)
{
  static const struct {
    const char *options, *says; /* NULL: the law is read */
  } cases[] = {{"-friction_law partial -friction_part 0.25", NULL},
               {"-friction_law partial", "-friction_part is missing: required by -friction_law partial"},
               {"-friction_part 0.25", "-friction_part is given without -friction_law partial"},
               {"-friction_law part", "expected coulomb, slip_path, pressure, falling or partial"}};

  (void)state;
  sam_call(SamLawRegister("partial_friction", CreatePartial));
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    Read          r = ReadFriction(cases[k].options, NULL);
    SamParameters p = {.count = 0};
    SamLaw        law;

    sam_assert(cases[k].says ? r.code == SAM_ERR_USER && strstr(CaughtMessage(), cases[k].says) : !r.code);
    law = SamProblemGetLaw(r.problem, "partial_friction");
    sam_assert(cases[k].says ? !law : law != NULL);
    if (law) {
      sam_call(SamLawAddParameters(law, &p));
      sam_assert(p.count == 2 && !strcmp(SamParametersFind(&p, "friction_law")->text, "partial"));
      sam_assert(SamParametersFind(&p, "friction_part")->value[0] == 0.25);
    }
    DestroyRead(&r);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_number_is_that_of_the_option),           cmocka_unit_test(test_field_is_that_of_the_file),
    cmocka_unit_test(test_words_are_those_of_the_registered_laws), cmocka_unit_test(test_wrong_friction_is_refused),
    cmocka_unit_test(test_wrong_values_of_the_file_are_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

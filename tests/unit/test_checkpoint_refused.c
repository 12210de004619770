/*
 * Checkpoints that cannot be used are refused on all ranks, and the message says why: damaged ones, those of another
 * run, version or parameters, and files of others.
 */
#include "checkpoints.h"

#include <hdf5.h>

#include "../../src/run/io/ioimpl.h"

/* Asserts that the file is refused on all ranks, in a message with these texts (NULL: none); the contact stays. */
static void AssertUnreadable(const Case *c, const SamParameters *parameters, PetscErrorCode code,
                             const char *const words[2])
{
  Vec            pressure = Copy(SolutionOf(c)->pressure);
  uint64_t       note     = 0;
  PetscErrorCode ierr;
  int            good;

  BeginCatching();
  ierr = SamCheckpointRead(filename, c->contact, PETSC_TRUE,
                           &(SamCheckpointRest){parameters, 1, &(SamNote){"note", 1, &note}, 0, NULL});
  EndCatching();
  good = ierr == code;
  for (int k = 0; k < 2; k++) good = good && (!words[k] || strstr(CaughtMessage(), words[k]));
  if (!good) print_error("error %d: %s\n", (int)ierr, CaughtMessage());
  sam_assert(good);
  sam_assert(SameBits(SolutionOf(c)->pressure, pressure));
  sam_call(VecDestroy(&pressure));
}

/* Rank 0 changes the file. */
typedef void (*Damage)(hid_t file);

static void DamageFile(const char *name, Damage damage)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) {
    const hid_t file = H5Fopen(name, H5F_ACC_RDWR, H5P_DEFAULT);

    damage(file);
    (void)H5Fclose(file);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* The last bit of one number. */
static void ChangeField(hid_t file, const char *name, hsize_t index)
{
  const hid_t   dataset = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(dataset);
  const hsize_t count  = (hsize_t)H5Sget_simple_extent_npoints(space);
  double       *values = (double *)malloc(count * sizeof(*values));

  (void)H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  values[index] = nextafter(values[index], INFINITY);
  (void)H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  free(values);
  (void)H5Sclose(space);
  (void)H5Dclose(dataset);
}

static void DamagePressure(hid_t file)
{
  ChangeField(file, "pressure", 37 * 18 + 18);
}

static void DamageBefore(hid_t file)
{
  ChangeField(file, "before_shear", 0);
}

static void DamageDisplacement(hid_t file)
{
  ChangeField(file, "displacement", 2 * 37 * 37 - 1);
}

static void RemoveNote(hid_t file)
{
  (void)H5Adelete(file, "note");
}

static void ChangeVersion(hid_t file)
{
  const char *const version = "0.0.0-other";
  const hid_t       type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  hid_t             attribute;

  (void)H5Tset_size(type, H5T_VARIABLE);
  (void)H5Tset_cset(type, H5T_CSET_UTF8);
  (void)H5Adelete(file, "petsam_version");
  attribute = H5Acreate2(file, "petsam_version", type, space, H5P_DEFAULT, H5P_DEFAULT);
  (void)H5Awrite(attribute, type, &version);
  (void)H5Aclose(attribute);
  (void)H5Sclose(space);
  (void)H5Tclose(type);
}

static void Seal(const Case *c, const char *name)
{
  sam_call(SamSealWrite(c->s.grid, "checkpoint", name));
}

/* Adds 1 to a byte, from the start of the file, or if negative from its end. */
static void ChangeByte(const char *name, long where)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) {
    FILE *file = fopen(name, "r+b");
    int   byte;

    (void)fseek(file, where, where < 0 ? SEEK_END : SEEK_SET);
    byte = fgetc(file);
    (void)fseek(file, where, where < 0 ? SEEK_END : SEEK_SET);
    (void)fputc(byte + 1, file);
    (void)fclose(file);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* Two checkpoints, of the second and of the third step. */
static Case WriteTwo(const SamParameters *parameters)
{
  Case     c    = NewBody();
  uint64_t note = 7;
  SamStep  step;

  for (int k = 0; k < 3; k++) {
    SolveStep(&c, k, &step);
    if (k) Write(&c, parameters, 1, &(SamNote){"note", 1, &note});
  }
  return c;
}

/* Any change is found, and the file before is named if it can be read. */
static void test_damaged_file_is_told_with_the_one_before_it(void **state)
{
  static const Damage damages[]  = {DamagePressure, DamageBefore, DamageDisplacement, RemoveNote};
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int k = 0; k < 4; k++) {
    Case c = WriteTwo(&parameters);

    DamageFile(filename, damages[k]);
    AssertUnreadable(&c, &parameters, SAM_ERR_FILE,
                     (const char *const[2]){"its checksum is wrong", "-restart test_checkpoint.h5.1"});
    DamageFile("test_checkpoint.h5.1", damages[k]);
    AssertUnreadable(&c, &parameters, SAM_ERR_FILE, (const char *const[2]){"its checksum is wrong", NULL});
    sam_assert(!strstr(CaughtMessage(), ".h5.1"));
    DestroyCase(&c);
    Remove();
  }
}

/* In the seal's title, version, number of bytes, checksum, and the zeros after it; in HDF5's data; at the end. */
static void test_one_changed_byte_anywhere_is_found(void **state)
{
  static const long        places[]   = {0, 18, 26, 45, 500, 512, 700, 5000, 12345, 100000, -1};
  static const char *const says[]     = {"not a checkpoint", "another version", "checksum"};
  const SamParameters      parameters = NewParameters(friction);
  Case                     c          = WriteTwo(&parameters);

  (void)state;
  for (int k = 0; k < 11; k++) {
    ChangeByte(filename, places[k]);
    AssertUnreadable(&c, &parameters, SAM_ERR_FILE,
                     (const char *const[2]){says[k < 2 ? k : 2], "-restart test_checkpoint.h5.1"});
    for (int back = 0; back < 255; back++) ChangeByte(filename, places[k]);
  }
  sam_call(SamCheckpointRead(filename, c.contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters}));
  sam_assert(Rank() || !truncate(filename, 100000));
  AssertUnreadable(&c, &parameters, SAM_ERR_FILE, (const char *const[2]){"checksum", NULL});
  DestroyCase(&c);
  Remove();
}

static void test_note_that_is_missing_is_told(void **state)
{
  const SamParameters parameters = NewParameters(friction);
  Case                c          = WriteTwo(&parameters);

  (void)state;
  DamageFile(filename, RemoveNote);
  Seal(&c, filename);
  AssertUnreadable(&c, &parameters, SAM_ERR_FILE, (const char *const[2]){"cannot be read", NULL});
  DestroyCase(&c);
  Remove();
}

/* A second run is kept from the files of the first, also after it has written to them; not from others. */
static void test_second_run_is_kept_from_the_files(void **state)
{
  const SamParameters parameters = NewParameters(friction);
  Case                c          = NewBody();
  SamCheckpoint       first, second = NULL;
  PetscErrorCode      ierr;

  (void)state;
  sam_call(SamCheckpointCreate(c.s.grid, filename, &first));
  for (int k = 0; k < 3; k++) {
    BeginCatching();
    ierr = SamCheckpointCreate(c.s.grid, filename, &second);
    EndCatching();
    sam_assert(ierr == SAM_ERR_FILE && !second && strstr(CaughtMessage(), "another run"));
    sam_call(SamCheckpointWrite(first, c.contact, &(SamCheckpointRest){.parameters = &parameters}));
  }
  sam_call(SamCheckpointCreate(c.s.grid, "test_checkpoint_other.h5", &second));
  sam_call(SamCheckpointDestroy(&second));
  sam_call(SamCheckpointDestroy(&first));
  sam_assert(access("test_checkpoint.h5.tmp", F_OK) && access("test_checkpoint_other.h5", F_OK));
  sam_call(SamCheckpointCreate(c.s.grid, filename, &second));
  sam_call(SamCheckpointDestroy(&second));
  DestroyCase(&c);
  Remove();
}

/* Of the checkpoint, the one before it, and the one that is being written. A link is not followed. */
static void test_files_of_others_are_not_replaced(void **state)
{
  static const char *const names[] = {filename, "test_checkpoint.h5.1", "test_checkpoint.h5.tmp"};
  Case                     c       = NewBody();
  SamCheckpoint            files;

  (void)state;
  for (int k = 0; k < 4; k++) {
    const char *const name = names[PetscMin(k, 2)];

    if (!Rank()) {
      FILE *file = fopen(k < 3 ? name : "test_checkpoint.txt", "w");

      (void)fputs("the only copy of a long text", file);
      (void)fclose(file);
      if (k == 3) (void)!symlink("test_checkpoint.txt", name);
    }
    (void)MPI_Barrier(PETSC_COMM_WORLD);
    sam_says(SamCheckpointCreate(c.s.grid, filename, &files), SAM_ERR_FILE, name);
    sam_assert(strstr(CaughtMessage(), k < 3 ? "petsam has not written" : "symbolic link"));
    (void)MPI_Barrier(PETSC_COMM_WORLD);
    sam_assert(Rank() || !unlink(name));
  }
  sam_assert(Rank() || !unlink("test_checkpoint.txt"));
  DestroyCase(&c);
  Remove();
}

static void test_missing_file_is_told(void **state)
{
  const SamParameters parameters = NewParameters(friction);
  Case                c          = NewBody();

  (void)state;
  Remove();
  AssertUnreadable(&c, &parameters, SAM_ERR_FILE, (const char *const[2]){filename, "cannot be read"});
  DestroyCase(&c);
}

static void test_other_version_is_named(void **state)
{
  const SamParameters parameters = NewParameters(friction);
  Case                c          = WriteTwo(&parameters);

  (void)state;
  DamageFile(filename, ChangeVersion);
  Seal(&c, filename);
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"0.0.0-other", PETSAM_VERSION});
  DestroyCase(&c);
  Remove();
}

/* Parameters that are not fixed may differ, or be left out. */
static void test_other_fixed_parameter_is_named(void **state)
{
  SamParameters parameters = NewParameters(friction);
  Case          c          = WriteTwo(&parameters);
  uint64_t      note       = 0;

  (void)state;
  parameters.list[0].value[0] = 0.30000000000000004;
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-friction is 0.3 there", NULL});
  parameters               = NewParameters(friction);
  parameters.list[0].count = 2;
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-friction is 0.3 there, not 0.3,0", NULL});
  parameters = NewParameters(friction);
  (void)snprintf(parameters.list[1].text, sizeof(parameters.list[1].text), "punch");
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-gap_type is sphere there, not punch", NULL});
  parameters = NewParameters(friction);
  sam_call(SamParametersAddReals(&parameters, "grid_size", PETSC_TRUE, 2, (const PetscReal[2]){1, 2}));
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-grid_size is not given there", NULL});
  parameters       = NewParameters(friction);
  parameters.count = 1;
  AssertUnreadable(&c, &parameters, SAM_ERR_USER,
                   (const char *const[2]){"-gap_type is given there, and not here", NULL});
  parameters.count = 2;
  sam_call(SamCheckpointRead(filename, c.contact, PETSC_TRUE,
                             &(SamCheckpointRest){&parameters, 1, &(SamNote){"note", 1, &note}, 0, NULL}));
  parameters                  = NewParameters(friction);
  parameters.list[2].value[0] = 5;
  sam_call(SamCheckpointRead(filename, c.contact, PETSC_TRUE,
                             &(SamCheckpointRest){&parameters, 1, &(SamNote){"note", 1, &note}, 0, NULL}));
  sam_assert(note == 7);
  DestroyCase(&c);
  Remove();
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_damaged_file_is_told_with_the_one_before_it),
    cmocka_unit_test(test_one_changed_byte_anywhere_is_found),
    cmocka_unit_test(test_note_that_is_missing_is_told),
    cmocka_unit_test(test_second_run_is_kept_from_the_files),
    cmocka_unit_test(test_files_of_others_are_not_replaced),
    cmocka_unit_test(test_missing_file_is_told),
    cmocka_unit_test(test_other_version_is_named),
    cmocka_unit_test(test_other_fixed_parameter_is_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

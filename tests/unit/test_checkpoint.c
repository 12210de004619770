/*
 * The state of a contact in a file: what is read is what was written, on any number of ranks. Checksums depend on the
 * values, and not on how the cells lie on the ranks.
 */
#include "contacts.h"

#include <hdf5.h>
#include <unistd.h>

#include "../../src/io/ioimpl.h"
#include <petsam/checkpoint.h>

static const char filename[] = "test_checkpoint.h5";

static int Rank(void)
{
  int rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

/* Writes one checkpoint, as a run would. */
static void Write(const Case *c, const SamParameters *parameters, PetscInt n, const SamNote notes[])
{
  SamCheckpoint files;

  sam_call(SamCheckpointCreate(c->s.grid, filename, &files));
  sam_call(SamCheckpointWrite(files, c->contact, NULL, parameters, n, notes));
  sam_call(SamCheckpointDestroy(&files));
}

static void Remove(void)
{
  static const char *const names[] = {"test_checkpoint.h5", "test_checkpoint.h5.1"};

  (void)MPI_Barrier(PETSC_COMM_WORLD);
  for (int k = 0; k < 2 && !Rank(); k++) (void)unlink(names[k]);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* ---- checksums ---- */

static uint64_t ChecksumOn(MPI_Comm comm, int swap)
{
  SamGrid  grid  = NewGridOn(comm, 13, 7, 1, 1, 0, 0);
  Vec      field = NewField(grid, 2);
  uint64_t checksum;
  double  *values;

  sam_call(VecGetArray(field, &values));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < grid->nx; i++) {
        const PetscInt row   = grid->row_start + j,
                       other = swap && row == 3 && i < 2 ? 1 - i : i; /* two cells change places */

        values[c * grid->cells + j * grid->nx + i] = Random(1, c, other, row);
      }
  sam_call(VecRestoreArray(field, &values));
  sam_call(SamCheckpointChecksum(grid, field, &checksum));
  sam_call(VecDestroy(&field));
  sam_call(SamGridDestroy(&grid));
  return checksum;
}

static void test_checksum_is_that_of_the_field_not_of_its_ranks(void **state)
{
  (void)state;
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 0) == ChecksumOn(PETSC_COMM_SELF, 0));
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 1) == ChecksumOn(PETSC_COMM_SELF, 1));
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 0) != ChecksumOn(PETSC_COMM_WORLD, 1));
}

/* ---- files ---- */

static const PetscReal friction = 0.3;

/* Dissimilar bodies, on a grid that does not divide. */
static Case NewBody(void)
{
  return NewCase(Dissimilar(), 37, 2, friction, "");
}

static void SolveStep(const Case *c, int k, SamStep *step)
{
  const SamControl control = Loads(c, 0.25 * (k + 1), 0.1 * (k + 1), 0.02 * (k + 1), 0);

  *step = Solve(c, &control);
  sam_assert(step->check.normal < 2e-6 && step->check.tangential < 1e-5); /* -coupling_rtol 1e-6 */
}

static SamParameters NewParameters(PetscReal value)
{
  SamParameters p = {.count = 0};

  sam_call(SamParametersAddReals(&p, "friction", PETSC_TRUE, 1, &value));
  sam_call(SamParametersAddText(&p, "gap_type", PETSC_TRUE, "sphere"));
  sam_call(SamParametersAddReals(&p, "load_n", PETSC_FALSE, 1, &value));
  return p;
}

static void test_contact_that_is_read_goes_on_as_the_one_that_was_written(void **state)
{
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int solved = 0; solved < 4; solved++) {
    Case          one = NewBody(), other = NewBody();
    uint64_t      written[3] = {1, UINT64_MAX, 42}, read[3] = {0};
    const SamNote to[2]   = {{"first", 2, written}, {"second", 1, &written[2]}},
                  from[2] = {{"second", 1, &read[2]}, {"first", 2, read}};
    SamStep a, b;

    for (int k = 0; k < solved; k++) SolveStep(&one, k, &a);
    SolveStep(&other, 3, &b); /* is forgotten */
    Write(&one, &parameters, 2, to);
    sam_call(SamCheckpointRead(filename, other.contact, NULL, &parameters, 2, from));
    sam_assert(!memcmp(read, written, sizeof(read)));
    if (solved) AssertSameFields(&one, &other);
    for (int k = solved; k < 5; k++) {
      SolveStep(&one, k, &a);
      SolveStep(&other, k, &b);
      AssertSameSteps(&a, &b);
      AssertSameFields(&one, &other);
    }
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

static void test_state_in_the_file_is_the_committed_one(void **state)
{
  const SamParameters parameters = NewParameters(friction);
  Case                one = NewBody(), other = NewBody();
  const SamControl    control = Loads(&one, 1, -0.2, 0, 0);
  SamControl          second  = Loads(&one, 0.5, 0.2, 0, 0);
  SamContactState     a, b;
  SamStep             step;

  (void)state;
  SolveStep(&one, 0, &step);
  Displace(&second, SAM_COMPONENT_MZ, 1e-6);
  second.time                        = 2.5;
  second.friction_scale              = 0.9;
  second.bulk_stress[0][SAM_BULK_XY] = 1e6;
  second.bulk_stress[1][SAM_BULK_YY] = -2e6;
  (void)Solve(&one, &second);
  (void)Try(&one, &control);
  Write(&one, &parameters, 0, NULL);
  sam_call(SamCheckpointRead(filename, other.contact, NULL, &parameters, 0, NULL));
  sam_call(SamContactReject(one.contact));
  AssertSameFields(&one, &other);
  sam_call(SamContactGetState(one.contact, &a));
  sam_call(SamContactGetState(other.contact, &b));
  sam_assert(a.steps == 2 && b.steps == 2 && a.gap_is_current && b.gap_is_current);
  sam_assert(SameBits(a.before.pressure, b.before.pressure) && SameBits(a.before.bound, b.before.bound) &&
             SameBits(a.before.shear, b.before.shear));
  sam_assert(!memcmp(a.window_first, b.window_first, sizeof(a.window_first)) &&
             !memcmp(a.window_n, b.window_n, sizeof(a.window_n)));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    sam_assert(a.now.control.value[k] == b.now.control.value[k] && a.now.load[k] == b.now.load[k] &&
               a.now.rigid[k] == b.now.rigid[k] && a.before.control.value[k] == b.before.control.value[k] &&
               a.before.rigid[k] == b.before.rigid[k] && a.now.control.force[k] == b.now.control.force[k]);
  sam_assert(b.now.control.time == 2.5 && b.now.control.friction_scale == 0.9);
  sam_assert(!memcmp(b.now.control.bulk_stress, second.bulk_stress, sizeof(second.bulk_stress)));
  sam_assert(b.before.control.time == 0 && b.before.control.friction_scale == 1 &&
             b.before.control.bulk_stress[0][SAM_BULK_XY] == 0);
  DestroyCase(&one);
  DestroyCase(&other);
  Remove();
}

/* In the problem that is given the state, or in the one that wrote it, after its last step. */
static void test_gap_that_has_changed_is_told(void **state)
{
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int which = 0; which < 3; which++) {
    Case            one = NewBody(), other = NewBody();
    Case *const     changed = which == 1 ? &one : &other;
    SamContactState held;
    SamStep         step;
    Vec             gap;

    SolveStep(&one, 3, &step);
    sam_call(SamProblemGetGap(changed->problem, &gap));
    if (which) AddAt(one.s.grid, 0, 36, 36, 1e-9, gap);
    Write(&one, &parameters, 0, NULL);
    sam_call(SamCheckpointRead(filename, other.contact, NULL, &parameters, 0, NULL));
    sam_call(SamContactGetState(other.contact, &held));
    sam_assert(held.gap_is_current == (which ? PETSC_FALSE : PETSC_TRUE));
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

/* ---- files that cannot be used ---- */

/* Asserts that the file is refused on all ranks, in a message with these texts (NULL: none); the contact stays. */
static void AssertUnreadable(const Case *c, const SamParameters *parameters, PetscErrorCode code,
                             const char *const words[2])
{
  Vec            pressure = Copy(SolutionOf(c)->pressure);
  uint64_t       note     = 0;
  PetscErrorCode ierr;
  int            good;

  BeginCatching();
  ierr = SamCheckpointRead(filename, c->contact, NULL, parameters, 1, &(SamNote){"note", 1, &note});
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
  ChangeField(file, "displacement_t", 2 * 37 * 37 - 1);
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
  sam_call(SamCheckpointRead(filename, c.contact, NULL, &parameters, 0, NULL));
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
    sam_call(SamCheckpointWrite(first, c.contact, NULL, &parameters, 0, NULL));
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
  PetscErrorCode           ierr;

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
    BeginCatching();
    ierr = SamCheckpointCreate(c.s.grid, filename, &files);
    EndCatching();
    sam_assert(ierr == SAM_ERR_FILE && strstr(CaughtMessage(), name));
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

/* Parameters that are not fixed may differ. */
static void test_other_fixed_parameter_is_named(void **state)
{
  SamParameters parameters = NewParameters(friction);
  Case          c          = WriteTwo(&parameters);
  uint64_t      note       = 0;

  (void)state;
  parameters.list[0].value[0] = 0.30000000000000004;
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-friction is 0.3 there", NULL});
  parameters = NewParameters(friction);
  (void)snprintf(parameters.list[1].text, sizeof(parameters.list[1].text), "punch");
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-gap_type is sphere there, not punch", NULL});
  parameters = NewParameters(friction);
  sam_call(SamParametersAddReals(&parameters, "grid_size", PETSC_TRUE, 2, (const PetscReal[2]){1, 2}));
  AssertUnreadable(&c, &parameters, SAM_ERR_USER, (const char *const[2]){"-grid_size is not given there", NULL});
  parameters                  = NewParameters(friction);
  parameters.list[2].value[0] = 5;
  sam_call(SamCheckpointRead(filename, c.contact, NULL, &parameters, 1, &(SamNote){"note", 1, &note}));
  sam_assert(note == 7);
  DestroyCase(&c);
  Remove();
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_checksum_is_that_of_the_field_not_of_its_ranks),
    cmocka_unit_test(test_contact_that_is_read_goes_on_as_the_one_that_was_written),
    cmocka_unit_test(test_state_in_the_file_is_the_committed_one),
    cmocka_unit_test(test_gap_that_has_changed_is_told),
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

/*
  The state of a run in a file: SamContactState, what the run is, and how far it is.

  The fields are datasets (components, ny, nx), each with a checksum that does not depend on how its cells lie on the
  ranks; all else is attributes of the root, over which HDF5 itself keeps checksums in the format used here.
*/
#include "ioimpl.h"
#include <petsam/checkpoint.h>
#include <string.h>

#define FORMAT  1 /* of this file's content */
#define COLUMNS 7 /* of the load program: time and six components */
#define BALANCE 9 /* numbers of a balance */

/* The fields and what they are called. */
static const struct {
  const char *name;
  PetscInt    components;
  size_t      offset; /* of the Vec in SamContactState */
} kept[] = {{"pressure", 1, offsetof(SamContactState, pressure)},
            {"shear", 2, offsetof(SamContactState, shear)},
            {"slip", 2, offsetof(SamContactState, slip)},
            {"displacement_z", 1, offsetof(SamContactState, displacement_z)},
            {"previous_pressure", 1, offsetof(SamContactState, previous_pressure)},
            {"previous_shear", 2, offsetof(SamContactState, previous_shear)}};
enum { KEPT = sizeof(kept) / sizeof(kept[0]) };

static Vec *FieldOf(SamContactState *state, PetscInt k)
{
  return (Vec *)((char *)state + kept[k].offset);
}

/* ---- checksums ---- */

/* The finalizer of MurmurHash3 (A. Appleby, public domain): all bits of x act on all bits of the result. */
static uint64_t Mix(uint64_t x)
{
  x = (x ^ x >> 33) * UINT64_C(0xff51afd7ed558ccd);
  x = (x ^ x >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
  return x ^ x >> 33;
}

static uint64_t Bits(double value)
{
  uint64_t bits;

  memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/* A sum over the cells, each mixed with its place, so that the order of the summation does not count. */
PetscErrorCode SamCheckpointChecksum(SamGrid grid, Vec field, uint64_t *checksum)
{
  const uint64_t cells = (uint64_t)grid->nx * (uint64_t)grid->ny,
                 first = (uint64_t)grid->nx * (uint64_t)grid->row_start;
  const PetscScalar *values;
  PetscInt           n;

  PetscFunctionBegin;
  *checksum = 0;
  PetscCall(VecGetLocalSize(field, &n));
  PetscCall(VecGetArrayRead(field, &values));
  for (PetscInt k = 0; k < n; k++)
    *checksum +=
      Mix(Bits(values[k]) + Mix((uint64_t)(k / grid->cells) * cells + first + (uint64_t)(k % grid->cells) + 1));
  PetscCall(VecRestoreArrayRead(field, &values));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, checksum, 1, MPI_UINT64_T, MPI_SUM, grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A column of the load program in the first steps: time, or a component's kind of control and its values. */
static PetscErrorCode ChecksumColumns(SamHistory history, PetscInt steps, uint64_t columns[COLUMNS])
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(columns, COLUMNS));
  for (PetscInt s = 0; s < steps; s++) {
    SamStep step;

    PetscCall(SamHistoryGetStep(history, s, &step));
    columns[0] = Mix(columns[0] + Bits(step.time));
    for (PetscInt c = 1; c < COLUMNS; c++) {
      const SamBalance *b = c < 4 ? &step.normal : &step.tangential;
      const PetscInt    k = (c - 1) % 3;

      columns[c] = Mix(columns[c] + Bits(b->force[k] ? b->load[k] : b->rigid[k]));
      columns[c] = Mix(columns[c] + (b->force[k] ? 1 : 2));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the state as numbers ---- */

static void PackBalance(const SamBalance *b, double numbers[BALANCE])
{
  for (PetscInt k = 0; k < 3; k++) {
    numbers[k]     = b->force[k] ? 1 : 0;
    numbers[k + 3] = b->load[k];
    numbers[k + 6] = b->rigid[k];
  }
}

static void UnpackBalance(const double numbers[BALANCE], SamBalance *b)
{
  b->kind = SAM_BALANCE_NORMAL;
  for (PetscInt k = 0; k < 3; k++) {
    b->force[k] = numbers[k] != 0 ? PETSC_TRUE : PETSC_FALSE;
    b->load[k]  = numbers[k + 3];
    b->rigid[k] = numbers[k + 6];
  }
}

static void WriteNumbers(SamFile f, const SamContactState *s)
{
  const int64_t window[4] = {s->window_first[0], s->window_first[1], s->window_n[0], s->window_n[1]}, steps = s->steps;
  double        balances[2 * BALANCE];

  PackBalance(&s->given, balances);
  PackBalance(&s->found, balances + BALANCE);
  SamFileWriteAttribute(f, f->id, "contact_steps", H5T_STD_I64LE, H5T_NATIVE_INT64, 1, &steps);
  SamFileWriteAttribute(f, f->id, "contact_window", H5T_STD_I64LE, H5T_NATIVE_INT64, 4, window);
  SamFileWriteAttribute(f, f->id, "contact_values", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 12, s->values);
  SamFileWriteAttribute(f, f->id, "contact_rigid", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 6, s->rigid);
  SamFileWriteAttribute(f, f->id, "contact_balances", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 2 * BALANCE, balances);
}

static void ReadNumbers(SamFile f, SamContactState *s)
{
  int64_t window[4] = {0}, steps = 0;
  double  balances[2 * BALANCE] = {0};

  SamFileReadAttribute(f, f->id, "contact_steps", H5T_NATIVE_INT64, 1, &steps);
  SamFileReadAttribute(f, f->id, "contact_window", H5T_NATIVE_INT64, 4, window);
  SamFileReadAttribute(f, f->id, "contact_values", H5T_NATIVE_DOUBLE, 12, s->values);
  SamFileReadAttribute(f, f->id, "contact_rigid", H5T_NATIVE_DOUBLE, 6, s->rigid);
  SamFileReadAttribute(f, f->id, "contact_balances", H5T_NATIVE_DOUBLE, 2 * BALANCE, balances);
  s->steps = (PetscInt)steps;
  for (PetscInt k = 0; k < 2; k++) {
    s->window_first[k] = (PetscInt)window[k];
    s->window_n[k]     = (PetscInt)window[k + 2];
  }
  UnpackBalance(balances, &s->given);
  UnpackBalance(balances + BALANCE, &s->found);
}

/* ---- fields ---- */

static PetscErrorCode WriteField(SamFile f, const char name[], PetscInt components, Vec field)
{
  const hsize_t size[3] = {(hsize_t)components, (hsize_t)f->grid->ny, (hsize_t)f->grid->nx};
  const hid_t   space   = SamFileNote(f, H5Screate_simple(3, size, NULL)),
              creation  = SamFileNote(f, H5Pcreate(H5P_DATASET_CREATE));
  const PetscScalar *values;
  uint64_t           checksum;
  hid_t              dataset;

  PetscFunctionBegin;
  (void)SamFileNote(f, H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER));
  dataset = SamFileNote(f, H5Dcreate2(f->id, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  PetscCall(SamCheckpointChecksum(f->grid, field, &checksum));
  SamFileWriteAttribute(f, dataset, "checksum", H5T_STD_U64LE, H5T_NATIVE_UINT64, 1, &checksum);
  PetscCall(VecGetArrayRead(field, &values));
  for (PetscInt c = 0; c < components; c++)
    SamFileWriteLayer(f, dataset, H5T_NATIVE_DOUBLE, (hsize_t)c, values + c * f->grid->cells);
  PetscCall(VecRestoreArrayRead(field, &values));
  (void)SamFileNote(f, H5Dclose(dataset));
  (void)SamFileNote(f, H5Pclose(creation));
  (void)SamFileNote(f, H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadField(SamFile f, const char name[], PetscInt components, Vec *field)
{
  const hid_t  dataset = SamFileNote(f, H5Dopen2(f->id, name, H5P_DEFAULT));
  PetscScalar *values;
  uint64_t     written = 0, read = 0;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(f->grid, components, field));
  PetscCall(VecGetArray(*field, &values));
  for (PetscInt c = 0; c < components; c++)
    SamFileReadLayer(f, dataset, H5T_NATIVE_DOUBLE, (hsize_t)c, values + c * f->grid->cells);
  PetscCall(VecRestoreArray(*field, &values));
  SamFileReadAttribute(f, dataset, "checksum", H5T_NATIVE_UINT64, 1, &written);
  if (dataset >= 0) (void)SamFileNote(f, H5Dclose(dataset));
  PetscCall(SamFileAgree(f));
  PetscCall(SamCheckpointChecksum(f->grid, *field, &read));
  if (!f->failed && read != written) {
    (void)SamFileNote(f, -1);
    (void)snprintf(f->reason, sizeof(f->reason), "it is damaged: the checksum of %s is wrong", name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFields(SamContactState *state)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < KEPT; k++) PetscCall(VecDestroy(FieldOf(state, k)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- writing ---- */

static PetscErrorCode WriteAll(SamFile f, SamContactState *state, SamHistory history, const SamParameters *parameters,
                               PetscInt steps, SamStatus worst)
{
  const int64_t format = FORMAT, progress[2] = {steps, worst};
  uint64_t      columns[COLUMNS];
  off_t         bytes = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < KEPT; k++) bytes += (off_t)sizeof(double) * kept[k].components * f->grid->nx * f->grid->ny;
  PetscCall(SamFileReserve(f, bytes));
  PetscCall(SamFileBegin(f));
  SamFileWriteAttribute(f, f->id, "checkpoint_format", H5T_STD_I64LE, H5T_NATIVE_INT64, 1, &format);
  SamFileWriteTextAttribute(f, f->id, "petsam_version", PETSAM_VERSION);
  SamParametersWrite(f, parameters);
  SamFileWriteAttribute(f, f->id, "progress", H5T_STD_I64LE, H5T_NATIVE_INT64, 2, progress);
  PetscCall(ChecksumColumns(history, steps, columns));
  SamFileWriteAttribute(f, f->id, "load_program", H5T_STD_U64LE, H5T_NATIVE_UINT64, COLUMNS, columns);
  WriteNumbers(f, state);
  for (PetscInt k = 0; k < KEPT; k++)
    if (*FieldOf(state, k)) PetscCall(WriteField(f, kept[k].name, kept[k].components, *FieldOf(state, k)));
  (void)SamFileNote(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
  PetscCall(SamFileEnd(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointWrite(const char filename[], SamContact contact, SamHistory history,
                                  const SamParameters *parameters, PetscInt steps, SamStatus worst)
{
  SamContactState state;
  SamGrid         grid;
  SamFile         f;
  char            temporary[PETSC_MAX_PATH_LEN + 8], before[PETSC_MAX_PATH_LEN + 8];
  PetscErrorCode  ierr;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(SamContactGetGrid(contact, &grid));
  PetscCall(SamContactGetState(contact, &state));
  PetscCall(PetscSNPrintf(temporary, sizeof(temporary), "%s.tmp", filename));
  PetscCall(PetscSNPrintf(before, sizeof(before), "%s.1", filename));
  PetscCall(SamFileCheckName(grid, "checkpoint", temporary));
  PetscCall(SamFileOpen(grid, SAM_EVENT_CHECKPOINT, "checkpoint", temporary, SAM_FILE_CREATE_CHECKED, &f));
  ierr = WriteAll(f, &state, history, parameters, steps, worst);
  if (ierr && !f->rank) (void)remove(temporary);
  if (ierr) (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(SamFileDestroy(&f, PETSC_TRUE));
  PetscCall(SamFileReplace(grid, "checkpoint", temporary, filename, before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading ---- */

/* Whether the file may be used by this run; which option speaks against it. */
static PetscErrorCode Judge(SamFile f, SamHistory history, const SamParameters *parameters, PetscInt steps,
                            char message[], size_t size, PetscBool *good)
{
  uint64_t columns[2][COLUMNS] = {{0}};
  PetscInt count;
  char    *version = NULL;
  SamStep  first;

  PetscFunctionBegin;
  *good = PETSC_FALSE;
  SamFileReadTextAttribute(f, f->id, "petsam_version", &version);
  if (strcmp(version, PETSAM_VERSION))
    (void)snprintf(message, size, "it was written by petsam %s, this is %s", version, PETSAM_VERSION);
  else
    *good = PETSC_TRUE;
  PetscCall(PetscFree(version));
  if (*good) *good = SamParametersDiffer(f, parameters, message, size) ? PETSC_FALSE : PETSC_TRUE;
  if (!*good || f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamHistoryGetCount(history, &count));
  if (steps > count) {
    *good = PETSC_FALSE;
    (void)snprintf(message, size, "-history or -steps: there are %ld load steps, and %ld were solved there",
                   (long)count, (long)steps);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SamFileReadAttribute(f, f->id, "load_program", H5T_NATIVE_UINT64, COLUMNS, columns[0]);
  PetscCall(ChecksumColumns(history, steps, columns[1]));
  PetscCall(SamHistoryGetStep(history, 0, &first));
  for (PetscInt c = 0; c < COLUMNS && *good; c++) {
    const SamBalance *b = c < 4 ? &first.normal : &first.tangential;
    const PetscInt    k = PetscMax(c - 1, 0) % 3;

    if (columns[0][c] == columns[1][c]) continue;
    *good = PETSC_FALSE;
    if (c == 0)
      (void)snprintf(message, size, "-history: the times up to step %ld are others there", (long)steps);
    else
      (void)snprintf(message, size, "-%s, or its column in -history: it is another there up to step %ld",
                     b->force[k] ? SamLoadNames[b->kind][k] : SamRigidNames[b->kind][k], (long)steps);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadAll(SamFile f, SamHistory history, const SamParameters *parameters, PetscInt *steps,
                              SamStatus *worst, SamContactState *state)
{
  int64_t   format = 0, progress[2] = {0, 0};
  char      message[256] = "";
  PetscBool good         = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(f));
  if (H5Aexists(f->id, "checkpoint_format") > 0)
    SamFileReadAttribute(f, f->id, "checkpoint_format", H5T_NATIVE_INT64, 1, &format);
  else {
    (void)SamFileNote(f, -1);
    (void)snprintf(f->reason, sizeof(f->reason), "it is not a checkpoint");
  }
  SamFileReadAttribute(f, f->id, "progress", H5T_NATIVE_INT64, 2, progress);
  *steps = (PetscInt)progress[0];
  *worst = (SamStatus)progress[1];
  if (!f->failed && format != FORMAT) {
    good = PETSC_FALSE;
    (void)snprintf(message, sizeof(message), "it was written by another version of petsam");
  } else if (!f->failed)
    PetscCall(Judge(f, history, parameters, *steps, message, sizeof(message), &good));
  if (!f->failed && good) {
    ReadNumbers(f, state);
    for (PetscInt k = 0; k < KEPT; k++)
      if (strncmp(kept[k].name, "previous", 8) || SamFileNote(f, H5Lexists(f->id, kept[k].name, H5P_DEFAULT)) > 0)
        PetscCall(ReadField(f, kept[k].name, kept[k].components, FieldOf(state, k)));
  }
  PetscCall(SamFileEnd(f));
  PetscCheck(good, f->grid->comm, SAM_ERR_USER, "-restart %s: cannot go on from it: %s", f->filename, message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a whole checkpoint; the vectors of the state are the caller's, also after an error. */
static PetscErrorCode ReadFile(SamGrid grid, const char filename[], SamHistory history, const SamParameters *parameters,
                               PetscInt *steps, SamStatus *worst, SamContactState *state)
{
  SamFile        f;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(state, sizeof(*state)));
  PetscCall(SamFileOpen(grid, SAM_EVENT_CHECKPOINT, "restart", filename, SAM_FILE_READ, &f));
  ierr = ReadAll(f, history, parameters, steps, worst, state);
  if (ierr) (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(SamFileDestroy(&f, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An error's first message, kept until it is known what else is to be said. */
static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *message, void *context)
{
  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  if (type == PETSC_ERROR_INITIAL && message) (void)snprintf((char *)context, 1024, "%s", message);
  return code;
}

PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact, SamHistory history,
                                 const SamParameters *parameters, PetscInt *steps, SamStatus *worst)
{
  SamContactState state;
  SamGrid         grid;
  char           message[1024] = "", ignored[1024], before[PETSC_MAX_PATH_LEN + 8], advice[2 * PETSC_MAX_PATH_LEN] = "";
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(SamContactGetGrid(contact, &grid));
  PetscCall(PetscPushErrorHandler(Keep, message));
  ierr = ReadFile(grid, filename, history, parameters, steps, worst, &state);
  PetscCall(PetscPopErrorHandler());
  if (ierr == SAM_ERR_FILE) {
    PetscCall(DestroyFields(&state));
    PetscCall(PetscSNPrintf(before, sizeof(before), "%s.1", filename));
    PetscCall(PetscPushErrorHandler(Keep, ignored));
    if (!ReadFile(grid, before, history, parameters, steps, worst, &state))
      (void)snprintf(advice, sizeof(advice), "; the checkpoint before it can be read: -restart %s", before);
    PetscCall(PetscPopErrorHandler());
  }
  if (!ierr) PetscCall(SamContactSetState(contact, &state));
  PetscCall(DestroyFields(&state));
  PetscCheck(!ierr, grid->comm, ierr, "%s%s", message, advice);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Load steps and computed cycles, appended to a results file.

  If the settings allow it, steps without fields wait in memory, so that many are written at once, column by column.
  When each step was written separately and the file completed after it, writing took 29 % of a run of 10,000 steps of
  128 x 128 cells that saved the fields of every 1,000th step, and more if other programs used the disk. Now it takes 1
  to 3 %.

  Disk space is reserved before any of it is written.
*/
#include "ioimpl.h"
#include <petsam/private/contact.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- on rank 0 ---- */

/*
  Sets the end of data in the superblock to the end of the file, before HDF5 flushes its metadata. HDF5 itself updates
  the superblock last: a run killed before that would leave metadata that point beyond the recorded end, and earlier
  steps would be lost, too. The space of a step is reserved earlier, so all of its data lie within the file. Version 0
  of the superblock has no checksum, and the end of data at byte 40 (HDF5 file format specification, II.A); other
  versions are left to HDF5. `end_of_data` < 0: the end of the file. Returns an errno or 0.
*/
#define SUPERBLOCK_VERSION 8  /* byte with the version of the superblock */
#define SUPERBLOCK_OFFSETS 13 /* byte with the size of an address, in bytes */
#define SUPERBLOCK_END     40 /* first byte of the end of data */
static int MoveEnd(const char filename[], off_t end_of_data)
{
  const int     file = open(filename, O_RDWR);
  unsigned char start[SUPERBLOCK_END], end[8];
  struct stat   status;
  int           error = 0;

  if (file < 0) return errno;
  errno = EIO; /* a short read or write sets no error */
  if (pread(file, start, sizeof(start), 0) != (ssize_t)sizeof(start) || fstat(file, &status))
    error = errno;
  else if (start[SUPERBLOCK_VERSION] == 0 && start[SUPERBLOCK_OFFSETS] == sizeof(end)) {
    for (unsigned k = 0; k < sizeof(end); k++)
      end[k] = (unsigned char)((uint64_t)(end_of_data < 0 ? status.st_size : end_of_data) >> 8 * k & 0xff);
    if (pwrite(file, end, sizeof(end), SUPERBLOCK_END) != (ssize_t)sizeof(end)) error = errno;
  }
  return close(file) && !error ? errno : error;
}

/*
  Removes reserved space at the end of the file that the steps did not need: HDF5 does so only if its data have grown.
  The end of data is set first, since it must never lie beyond the file.
*/
static void CutUnused(SamOutput o)
{
  const off_t unused = o->f->rank == 0 ? SamFileFindUnused(o->f) : -1;

  if (unused > 0 && o->hold.file >= 0 && !MoveEnd(o->f->filename, unused)) (void)!ftruncate(o->hold.file, unused);
}

/* Completes the file up to this step: first sets its end of data, then flushes HDF5's metadata. */
static PetscErrorCode Flush(SamOutput o)
{
  int error = 0;

  PetscFunctionBegin;
  PetscCall(SamFileAgree(o->f)); /* a step that failed on any rank must not be flushed */
  if (o->f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->f->rank == 0) error = MoveEnd(o->f->filename, -1);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, o->grid->comm)); /* no rank flushes before the end is set */
  if (error) {
    o->f->failed = PETSC_TRUE;
    (void)snprintf(o->f->reason, sizeof(o->f->reason), "%s", strerror(error));
  } else
    (void)SamFileNote(o->f, H5Fflush(o->f->id, H5F_SCOPE_GLOBAL));
  o->flushed = MPI_Wtime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- rows ---- */

/* Appends `count` numbers to a series, or square matrices of n rows; rank 0 writes them. */
static void Append(SamOutput o, hid_t dataset, hid_t type, hsize_t index, hsize_t count, hsize_t n, const void *numbers)
{
  const hsize_t  size[3] = {index + count, n, n};
  const SamBlock block   = {n > 1 ? 3 : 1, {index, 0, 0}, {o->f->rank ? 0 : count, n, n}};

  (void)SamFileNote(o->f, H5Dset_extent(dataset, size));
  SamFileWriteBlock(o->f, dataset, type, &block, numbers);
}

/* Gathers the values of a column in `count` rows of the state's numbers: real numbers, or integers of 64 bits. */
static void GatherColumn(const SamStateNumber *number, PetscInt id, const double *rows, PetscInt values, PetscInt count,
                         double column[])
{
  int64_t *const whole = (int64_t *)column;

  for (PetscInt k = 0; k < count; k++) {
    const double *const place = rows + k * values + id;

    if (number->kind == SAM_NUMBER_INT || number->kind == SAM_NUMBER_STATUS)
      whole[k] = (int64_t)*place;
    else
      memcpy(column + k * number->count, place, sizeof(double) * (size_t)number->count);
  }
}

/* Appends rows with all numbers of a state to its series. */
static PetscErrorCode AppendRows(SamOutput o, SamSeries kind, const double rows[], PetscInt count)
{
  const SamState state = o->state[kind];
  double        *values;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(count * SAM_COMPONENTS * SAM_COMPONENTS, &values));
  for (PetscInt c = 0; c < SamStateCountNumbers(state); c++) {
    PetscInt              id;
    const SamStateNumber *n     = SamStateNumberOf(state, c, &id);
    const PetscBool       whole = n->kind == SAM_NUMBER_INT || n->kind == SAM_NUMBER_STATUS;
    const hid_t           type  = whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;

    if (o->columns[kind][c] < 0) continue; /* not a result */
    GatherColumn(n, id, rows, o->values[kind], count, values);
    Append(o, o->columns[kind][c], type, o->rows[kind], (hsize_t)count,
           n->kind == SAM_NUMBER_MATRIX ? SAM_COMPONENTS : 1, values);
  }
  o->rows[kind] += (hsize_t)count;
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- fields ---- */

static void AppendField(SamOutput o, hid_t dataset, hid_t type, const void *values)
{
  const hsize_t size[3] = {o->saved + 1, (hsize_t)o->grid->ny, (hsize_t)o->grid->nx};

  (void)SamFileNote(o->f, H5Dset_extent(dataset, size));
  SamFileWriteFrame(o->f, dataset, type, o->saved, values);
}

/* Appends values in single precision, converted here: in HDF5's conversion each rank would write by itself, which
   compression does not allow. */
static void AppendSingle(SamOutput o, hid_t dataset, const double values[])
{
  for (PetscInt k = 0; k < o->grid->cells; k++) o->singles[k] = (float)values[k];
  AppendField(o, dataset, H5T_NATIVE_FLOAT, o->singles);
}

/* A field of the contact whose array is in use */
typedef struct {
  Vec           field; /* field with the array; NULL: none */
  const double *array;
} ContactFields;

static PetscErrorCode Release(ContactFields *from)
{
  PetscFunctionBegin;
  if (from->field) PetscCall(VecRestoreArrayRead(from->field, &from->array));
  from->field = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetValues(SamOutput o, PetscInt f, ContactFields *from, const void **values)
{
  const SamStateResult *field = SamOutputResult(o, f);
  const PetscInt        cells = o->grid->cells;
  const SamSolution    *solution;
  PetscInt              component;
  SamEdge               edge;

  PetscFunctionBegin;
  PetscCall(Release(from));
  if (field->kind == SAM_FIELD_POINTS) {
    PetscCall(SamContactFindEdge(o->set.contact, (SamEdgeOf)field->component, NULL, &edge));
    PetscCall(SamOutputGatherPoints(o, &edge));
    PetscCall(SamEdgeDestroy(&edge));
    *values = &o->points;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetSolution(o->set.contact, &solution)); /* computes the displacements */
  if (!o->work) PetscCall(SamGridCreateVec(o->grid, 1, &o->work));
  PetscCall(SamStateFindValues(o->state[SAM_SERIES_HISTORY], f, o->work, &from->field, &component));
  PetscCall(VecGetArrayRead(from->field, &from->array));
  *values = from->array + component * cells;
  if (field->kind == SAM_FIELD_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < cells; k++) o->states[k] = (signed char)from->array[k];
  *values = o->states;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends a field of layers: each rank writes its rows of all layers. */
static PetscErrorCode AppendLayers(SamOutput o, PetscInt f)
{
  const SamGrid         g      = o->grid;
  const SamStateResult *field  = SamOutputResult(o, f);
  const SamStateLayers *of     = SamStateLayersOf(o->state[SAM_SERIES_HISTORY], field->name);
  const PetscInt        layers = of->count[0] + of->count[1];
  const hsize_t         n = (hsize_t)layers, size[4] = {o->saved + 1, n, (hsize_t)g->ny, (hsize_t)g->nx};
  const SamBlock        block = {4, {o->saved, 0, (hsize_t)g->row_start, 0}, {1, n, (hsize_t)g->rows, (hsize_t)g->nx}};
  const double         *values;
  float                *singles = NULL;
  Vec                   below;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, layers, &below));
  PetscCall((*field->compute)(field->owner, o->state[SAM_SERIES_HISTORY], field->component, below));
  (void)SamFileNote(o->f, H5Dset_extent(o->fields[f], size));
  PetscCall(VecGetArrayRead(below, &values));
  if (o->set.single) {
    PetscCall(PetscMalloc1(layers * g->cells, &singles));
    for (PetscInt k = 0; k < layers * g->cells; k++) singles[k] = (float)values[k];
  }
  SamFileWriteBlock(o->f, o->fields[f], singles ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE, &block,
                    singles ? (const void *)singles : (const void *)values);
  PetscCall(VecRestoreArrayRead(below, &values));
  PetscCall(PetscFree(singles));
  PetscCall(VecDestroy(&below));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AppendFields(SamOutput o)
{
  ContactFields from = {.field = NULL};

  PetscFunctionBegin;
  if (o->set.single && !o->singles) PetscCall(PetscMalloc1(o->grid->cells, &o->singles));
  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    const void *cells = NULL;

    if (o->fields[f] < 0) continue;
    if (SamOutputResult(o, f)->kind == SAM_FIELD_LAYERS) {
      PetscCall(AppendLayers(o, f));
      continue;
    }
    PetscCall(GetValues(o, f, &from, &cells));
    switch (SamOutputResult(o, f)->kind) {
    case SAM_FIELD_POINTS:
      SamOutputAppendPoints(o, o->fields[f], o->saved, (const SamOutputPoints *)cells);
      break;
    case SAM_FIELD_STATE:
      AppendField(o, o->fields[f], H5T_NATIVE_SCHAR, cells);
      break;
    case SAM_FIELD_REAL:
      if (o->set.single)
        AppendSingle(o, o->fields[f], (const double *)cells);
      else
        AppendField(o, o->fields[f], H5T_NATIVE_DOUBLE, cells);
      break;
    case SAM_FIELD_LAYERS:
      break;
    }
  }
  PetscCall(Release(&from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- writing ---- */

/*
  Prepares writing: raises an error if the file has been changed from outside, and reserves disk space. After an error
  waiting rows are discarded, as there is no file for them.
*/
static PetscErrorCode Begin(SamOutput o, off_t bytes)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = SamOutputPublish(o);
  if (!ierr) ierr = SamFileLockCheck(o->grid, "output", o->f->filename, &o->hold);
  if (!ierr) ierr = SamFileReserve(o->f, bytes);
  if (ierr) o->waits = 0;
  PetscCall(ierr);
  PetscCall(SamFileBegin(o->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the waiting steps. */
static PetscErrorCode WriteWaiting(SamOutput o)
{
  PetscFunctionBegin;
  if (!o->waits) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AppendRows(o, SAM_SERIES_HISTORY, o->waiting, o->waits));
  o->waits = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode End(SamOutput o)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(Flush(o));
  ierr = SamFileEnd(o->f);
  if (ierr) o->broken = PETSC_TRUE;
  PetscCall(ierr);
  CutUnused(o);
  SamFileLockNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out whether waiting rows must be written now; rank 0's clock decides. */
static PetscErrorCode IsDue(SamOutput o, PetscBool *due)
{
  int late = o->waits == SAM_OUTPUT_WAIT;

  PetscFunctionBegin;
  if (!late) {
    late = MPI_Wtime() - o->flushed >= (double)o->set.flush;
    PetscCallMPI(MPI_Bcast(&late, 1, MPI_INT, 0, o->grid->comm));
  }
  *due = late != 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckWhole(SamOutput o)
{
  PetscFunctionBegin;
  PetscCheck(!o->broken, o->grid->comm, SAM_ERR_FILE, "-output %s: cannot be written: %s", o->f->filename,
             o->f->reason);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Appends the numbers of a step, which are all numbers of the state (NULL: none), and its fields if requested. Without
  fields the numbers may wait (SamOutputFlush()); otherwise the file is flushed.
*/
static PetscErrorCode Write(SamOutput o, const double step[], PetscReal time, PetscBool fields)
{
  const PetscInt n   = o->values[SAM_SERIES_HISTORY];
  const double   now = (double)time;
  PetscBool      due = fields;

  PetscFunctionBegin;
  PetscCall(CheckWhole(o));
  if (step && !o->waiting) PetscCall(PetscMalloc1(SAM_OUTPUT_WAIT * n, &o->waiting));
  if (step) PetscCall(PetscArraycpy(o->waiting + n * o->waits++, step, n));
  if (!due) PetscCall(IsDue(o, &due));
  if (!due) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Begin(o, fields ? SamOutputFieldBytes(o) : 0));
  PetscCall(WriteWaiting(o));
  if (fields) {
    Append(o, o->time, H5T_NATIVE_DOUBLE, o->saved, 1, 1, &now);
    PetscCall(AppendFields(o));
    SamFileCountVTK(o->f, o->vtk_steps, (int64_t)o->saved + 1);
    o->saved_time = time;
  }
  PetscCall(End(o));
  o->saved += fields ? 1 : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputFlush(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(CheckWhole(o));
  if (!o->waits) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Begin(o, 0));
  PetscCall(WriteWaiting(o));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteStep(SamOutput o, PetscBool fields)
{
  const double *step = SamStateReadNumbers(o->state[SAM_SERIES_HISTORY], 0);

  PetscFunctionBegin;
  PetscCall(Write(o, step, (PetscReal)step[0], fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteFields(SamOutput o, PetscReal time)
{
  PetscFunctionBegin;
  PetscCall(Write(o, NULL, time, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteCycle(SamOutput o)
{
  PetscFunctionBegin;
  PetscCheck(o->columns[SAM_SERIES_CYCLES][0] >= 0, o->grid->comm, PETSC_ERR_ORDER, "The file has no series of cycles");
  PetscCall(CheckWhole(o));
  PetscCall(Begin(o, 0));
  PetscCall(WriteWaiting(o));
  PetscCall(AppendRows(o, SAM_SERIES_CYCLES, SamStateNumbers(o->state[SAM_SERIES_CYCLES], 0, SAM_COMMITTED), 1));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputGetSaved(SamOutput o, PetscInt *steps, PetscInt *saved, PetscReal *time)
{
  PetscFunctionBegin;
  if (steps) *steps = (PetscInt)o->rows[SAM_SERIES_HISTORY] + o->waits;
  if (saved) *saved = (PetscInt)o->saved;
  if (time) *time = o->saved_time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Load steps and computed cycles, appended to a results file.

  If the settings allow it, steps wait in memory, so that many are written at once, column by column and field by field;
  the fields of large grids do not wait. When each step was written separately and the file completed after it, writing
  took 29 % of a run of 10,000 steps of 128 x 128 cells that saved the fields of every 1,000th step, and 88 % of one of
  10,000 steps of 512 cells in plane strain that saved all fields. Now it takes 1 to 3 %, and 35 %.

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
  steps would be lost, too. The space of a step is reserved earlier, so all of its data lie within the file.
  `end_of_data` < 0: the end of the file. Returns an errno or 0.
*/
static int MoveEnd(const char filename[], off_t end_of_data)
{
  const int     file = open(filename, O_RDWR);
  unsigned char start[SAM_FILE_SUPERBLOCK], end[8];
  struct stat   status;
  int           error = 0;
  off_t         place;

  if (file < 0) return errno;
  errno = EIO; /* a short read or write sets no error */
  if (pread(file, start, sizeof(start), 0) != (ssize_t)sizeof(start) || fstat(file, &status))
    error = errno;
  else if ((place = SamFilePlaceOfEnd(start)) > 0) {
    for (unsigned k = 0; k < sizeof(end); k++)
      end[k] = (unsigned char)((uint64_t)(end_of_data < 0 ? status.st_size : end_of_data) >> 8 * k & 0xff);
    if (pwrite(file, end, sizeof(end), place) != (ssize_t)sizeof(end)) error = errno;
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

void SamOutputAppendNumbers(SamOutput o, hid_t dataset, hid_t type, hsize_t index, hsize_t count, hsize_t n,
                            const void *numbers)
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
    SamOutputAppendNumbers(o, o->columns[kind][c], type, o->rows[kind], (hsize_t)count,
                           n->kind == SAM_NUMBER_MATRIX ? SAM_COMPONENTS : 1, values);
  }
  o->rows[kind] += (hsize_t)count;
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- writing ---- */

#define FRAME_INDEX 4096 /* most bytes in HDF5's indices for the fields of a step */

/*
  Prepares writing: raises an error if the file has been changed from outside, and reserves disk space. After an error
  waiting steps are discarded, as there is no file for them. `present`: the present step's fields are written, too;
  `more`: so many bytes besides.
*/
static PetscErrorCode Begin(SamOutput o, PetscBool present, off_t more)
{
  const PetscInt frames = o->frames.count + (present ? 1 : 0);
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = SamOutputPublish(o);
  if (!ierr) ierr = SamFileLockCheck(o->grid, "output", o->f->filename, &o->hold);
  if (!ierr) ierr = SamFileReserve(o->f, frames * (SamOutputFieldBytes(o) + FRAME_INDEX) + more);
  if (ierr) o->waits = o->frames.count = 0;
  PetscCall(ierr);
  PetscCall(SamFileBegin(o->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the waiting steps, and the present step's fields if they have not waited (`present`). */
static PetscErrorCode WriteWaiting(SamOutput o, PetscBool present, PetscReal time)
{
  PetscFunctionBegin;
  if (o->waits) PetscCall(AppendRows(o, SAM_SERIES_HISTORY, o->waiting, o->waits));
  o->waits = 0;
  PetscCall(SamOutputAppendFrames(o, present, time));
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

/* Writes all steps that wait, and with `present` the present step's fields, and completes the file. */
static PetscErrorCode Complete(SamOutput o, PetscBool present, PetscReal time)
{
  PetscFunctionBegin;
  PetscCall(Begin(o, present, 0));
  PetscCall(WriteWaiting(o, present, time));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step with fields waits only if it took less than this part of the time that it may wait, as may the next one. */
#define FAST 0.02

/* Finds out whether waiting steps must be written now; rank 0's clock decides. */
static PetscErrorCode IsDue(SamOutput o, PetscBool *due)
{
  const PetscBool fields = o->frames.count ? PETSC_TRUE : PETSC_FALSE;
  const double    now = MPI_Wtime(), most = (double)(fields ? o->set.flush_fields : o->set.flush);
  int             late = o->waits == SAM_OUTPUT_WAIT || (fields && o->frames.count == o->frames.most);

  PetscFunctionBegin;
  if (!late) {
    late = now - o->flushed >= most || (fields && now - o->called >= FAST * most);
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
  Appends the numbers of a step, which are all numbers of the state (NULL: none), and its fields if requested. Both may
  wait (SamOutputFlush()); otherwise the file is flushed.
*/
static PetscErrorCode Write(SamOutput o, const double step[], PetscReal time, PetscBool fields)
{
  const PetscInt  n       = o->values[SAM_SERIES_HISTORY];
  const PetscBool present = fields && o->frames.most == 1 ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       due     = present;

  PetscFunctionBegin;
  PetscCall(CheckWhole(o));
  if (step && !o->waiting) PetscCall(PetscMalloc1(SAM_OUTPUT_WAIT * n, &o->waiting));
  if (step) PetscCall(PetscArraycpy(o->waiting + n * o->waits++, step, n));
  if (fields && !present) PetscCall(SamOutputHoldFrame(o, time));
  if (!due) PetscCall(IsDue(o, &due));
  if (due) PetscCall(Complete(o, present, time));
  o->called = MPI_Wtime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputPublish(SamOutput o)
{
  PetscFunctionBegin;
  if (!o->name) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFileBegin(o->f));
  (void)SamFileNote(o->f, H5Fflush(o->f->id, H5F_SCOPE_GLOBAL));
  PetscCall(SamFileEnd(o->f));
  SamFileLockNoteSize(&o->hold);
  PetscCall(SamFileLockCheck(o->grid, "output", o->f->filename, &o->hold));
  PetscCall(SamFileCheckName(o->grid, "output", o->name, SAM_FILE_RESULTS));
  PetscCall(SamFileReplace(o->grid, "output", o->f->filename, o->name, NULL));
  PetscCall(PetscFree(o->f->filename));
  o->f->filename = o->name;
  o->name        = NULL;
  o->hold.use    = SAM_FILE_RESULTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputFlush(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(CheckWhole(o));
  if (o->waits || o->frames.count) PetscCall(Complete(o, PETSC_FALSE, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamOutputWaits(SamOutput o)
{
  return o->waits > 0 || o->frames.count > 0 ? PETSC_TRUE : PETSC_FALSE;
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

/* Prepares writing so many bytes besides steps: all that wait are written first. */
static PetscErrorCode BeginApart(SamOutput o, off_t bytes)
{
  PetscFunctionBegin;
  PetscCall(CheckWhole(o));
  PetscCall(Begin(o, PETSC_FALSE, bytes));
  PetscCall(WriteWaiting(o, PETSC_FALSE, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteCycle(SamOutput o)
{
  PetscFunctionBegin;
  PetscCheck(o->columns[SAM_SERIES_CYCLES][0] >= 0, o->grid->comm, PETSC_ERR_ORDER, "The file has no series of cycles");
  PetscCall(BeginApart(o, 0));
  PetscCall(AppendRows(o, SAM_SERIES_CYCLES, SamStateNumbers(o->state[SAM_SERIES_CYCLES], 0, SAM_COMMITTED), 1));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteErrors(SamOutput o, const SamErrorTable *table)
{
  PetscFunctionBegin;
  PetscCheck(o->set.errors, o->grid->comm, PETSC_ERR_ORDER, "The file has no table of errors");
  PetscCall(BeginApart(o, 0));
  PetscCall(SamOutputAppendErrors(o, table));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteWarnings(SamOutput o, PetscInt count, const char texts[][SAM_WARNING_TEXT])
{
  PetscFunctionBegin;
  PetscCall(BeginApart(o, 0));
  PetscCall(SamOutputAppendWarnings(o, count, texts));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteGradient(SamOutput o, SamGradient g, const char name[], PetscInt count,
                                      const SamGradientShare shares[])
{
  PetscFunctionBegin;
  PetscCall(BeginApart(o, 2 * (off_t)sizeof(double) * (off_t)o->grid->nx * (off_t)o->grid->ny));
  PetscCall(SamOutputAppendGradient(o, g, name, count, shares));
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputGetSaved(SamOutput o, PetscInt *steps, PetscInt *saved, PetscReal *time)
{
  PetscFunctionBegin;
  if (steps) *steps = (PetscInt)o->rows[SAM_SERIES_HISTORY] + o->waits;
  if (saved) *saved = (PetscInt)o->saved + o->frames.count;
  if (time) *time = o->saved_time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

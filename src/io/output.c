/*
  Results in an HDF5 file, written by all ranks together.

  Datasets stay open and grow by one along time with each step; each rank writes its rows. Disk space for a step is
  reserved before any of it is written.
*/
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- options ---- */

/* -output_fields: names between commas, and blanks. */
static PetscErrorCode ReadFieldNames(SamOutputSettings *set, const SamOptions *from)
{
  char        text[512] = "", names[512], **list;
  const char *unknown;
  PetscBool   given;
  int         count;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "output_fields", "fields to be saved by their names, all, or none", text,
                             sizeof(text), &given));
  for (char *c = text; *c; c++) *c = *c == ' ' ? ',' : *c;
  PetscCall(PetscStrToArray(text, ',', &count, &list));
  PetscCall(SamOutputSettingsSetFields(set, given ? count : -1, (const char *const *)list, &unknown));
  (void)snprintf(text, sizeof(text), "%s", unknown ? unknown : "");
  PetscCall(PetscStrToArrayDestroy(count, list));
  PetscCall(SamOutputGetFieldNames(names, sizeof(names)));
  PetscCheck(!text[0], from->comm, SAM_ERR_USER,
             "-%soutput_fields: %s is no field%s: expected all, none, or some of %s, with commas between them",
             SamOptionsPrefix(from), text, strcmp(text, "none") ? "" : ", and excludes them", names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *set, const SamOptions *from)
{
  const char *prefix = SamOptionsPrefix(from);

  PetscFunctionBegin;
  *set = (SamOutputSettings){.compress = 0, .chunk = {1024, 256}, .xdmf = PETSC_TRUE};
  PetscCall(ReadFieldNames(set, from));
  PetscCall(SamOptionsInt(from, "output_compress", "level of compression of the fields, 0 (none) to 9", 0,
                          &set->compress, NULL));
  PetscCheck(set->compress <= 9, from->comm, SAM_ERR_USER,
             "-%soutput_compress %" PetscInt_FMT ": expected a whole number from 0 to 9", prefix, set->compress);
  PetscCheck(set->compress == 0 || H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0, from->comm, SAM_ERR_USER,
             "-%soutput_compress %" PetscInt_FMT ": this HDF5 was built without zlib", prefix, set->compress);
  PetscCall(SamOptionsIntPair(from, "output_chunk", "most cells of a chunk of the file in x[,y]", 1, set->chunk, NULL));
  PetscCall(
    SamOptionsBool(from, "output_xdmf", "an XDMF file beside the results, for ParaView and VisIt", &set->xdmf, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- on rank 0 ---- */

/*
  Sets the end of data in the superblock to the end of the file, before HDF5 flushes its metadata. HDF5 itself updates
  the superblock last. A run killed in between would leave metadata that point beyond the recorded end, and earlier
  steps, too, would be lost. The space of a step is reserved before, so all of its data lie within the file. Version 0
  of the superblock has no checksum, and the end of data at byte 40 (HDF5 file format specification, II.A); other
  versions are left to HDF5. Returns an errno or 0.
*/
#define SUPERBLOCK_VERSION 8  /* byte: version of the superblock */
#define SUPERBLOCK_OFFSETS 13 /* byte: size of an address, in bytes */
#define SUPERBLOCK_END     40 /* byte: first of the end of data */
static int MoveEnd(const char filename[])
{
  const int     file = open(filename, O_RDWR);
  unsigned char start[SUPERBLOCK_END], end[8];
  struct stat   status;
  int           error = 0;

  if (file < 0) return errno;
  errno = EIO; /* for a short read or write, which sets none */
  if (pread(file, start, sizeof(start), 0) != (ssize_t)sizeof(start) || fstat(file, &status))
    error = errno;
  else if (start[SUPERBLOCK_VERSION] == 0 && start[SUPERBLOCK_OFFSETS] == sizeof(end)) {
    for (unsigned k = 0; k < sizeof(end); k++) end[k] = (unsigned char)((uint64_t)status.st_size >> 8 * k & 0xff);
    if (pwrite(file, end, sizeof(end), SUPERBLOCK_END) != (ssize_t)sizeof(end)) error = errno;
  }
  return close(file) && !error ? errno : error;
}

/* ---- the file ---- */

PetscErrorCode SamOutputAllocate(SamFile file, const SamOutputSettings *set, SamOutput *output)
{
  SamOutput o;

  PetscFunctionBegin;
  PetscCall(PetscNew(&o));
  o->f    = file;
  o->set  = *set;
  o->time = o->point = o->vtk_steps = o->closed = -1;
  o->hold.file                                  = -1;
  o->saved_time                                 = PETSC_NINFINITY;
  for (PetscInt f = 0; f < SAM_OUTPUT_MOST; f++) o->fields[f] = -1;
  for (PetscInt k = 0; k < SAM_SERIES; k++)
    for (PetscInt c = 0; c < SAM_OUTPUT_MOST; c++) o->columns[k][c] = -1;
  PetscCall(PetscMalloc1(file->grid->cells, &o->states));
  *output = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateDatasets(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  PetscCall(SamOutputCreateLayout(o));
  (void)SamFileNote(o->f, H5Fflush(o->f->id, H5F_SCOPE_GLOBAL));
  SamOutputMark(o);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the files; what was opened before an error is closed by the caller. */
static PetscErrorCode CreateFiles(SamGrid grid, const char filename[], SamFileUse use, const SamOutputSettings *set,
                                  SamHold *hold, SamXdmf *xdmf, SamFile *file)
{
  PetscFunctionBegin;
  PetscCall(SamHoldTake(grid, "output", filename, use, hold));
  if (set->xdmf) PetscCall(SamXdmfCreate(grid, filename, set, xdmf)); /* first: if it fails, old results are kept */
  PetscCall(SamFileOpen(grid, SAM_EVENT_OUTPUT, "output", filename, SAM_FILE_CREATE, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreateAs(SamGrid grid, const char filename[], SamFileUse use, const SamOutputSettings *set,
                                 SamOutput *output)
{
  SamFile        file = NULL;
  SamXdmf        xdmf = NULL;
  SamHold        hold = {.file = -1};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamInitialize());
  ierr = CreateFiles(grid, filename, use, set, &hold, &xdmf, &file);
  if (ierr) {
    PetscCall(SamXdmfDestroy(&xdmf));
    SamHoldRelease(filename, &hold);
    PetscCall(ierr);
  }
  PetscCall(SamOutputAllocate(file, set, output));
  (*output)->xdmf = xdmf;
  (*output)->hold = hold;
  PetscCall(SamHoldHadContent(grid, &hold, &(*output)->replaced));
  ierr = CreateDatasets(*output);
  if (ierr) (void)SamOutputDestroy(output);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], const SamOutputSettings *set, SamOutput *output)
{
  PetscFunctionBegin;
  PetscCall(SamOutputCreateAs(grid, filename, SAM_FILE_RESULTS, set, output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Written last: a file that is not marked as closed was left by a run that did not get to its end. */
static void MarkClosed(SamOutput o)
{
  const int8_t closed = 1;

  if (o->closed >= 0 && o->f->writing && !o->unchanged)
    (void)SamFileNote(o->f, H5Awrite(o->closed, H5T_NATIVE_INT8, &closed));
}

PetscErrorCode SamOutputDestroy(SamOutput *output)
{
  SamOutput      o       = *output;
  PetscErrorCode changed = 0, ierr;

  PetscFunctionBegin;
  *output = NULL;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->f->writing && !o->broken && !o->unchanged && !o->copying)
    changed = SamHoldCheck(o->f->grid, "output", o->f->filename, &o->hold);
  o->f->failed = PETSC_FALSE; /* earlier failures have been raised */
  PetscCall(SamFileBegin(o->f));
  if (!o->broken) {
    MarkClosed(o);
    SamOutputCloseLayout(o);
    SamFileClose(o->f);
    PetscCall(SamFileAgree(o->f)); /* all ranks have closed it */
    if (o->hold.file >= 0 && !o->f->failed && !o->unchanged && !o->copying && !changed)
      SamStructureSeal(o->f->filename);
  }
  ierr = SamFileEnd(o->f);
  SamHoldRelease(o->f->filename, &o->hold);
  PetscCall(SamXdmfDestroy(&o->xdmf));
  PetscCall(SamFileDestroy(&o->f, PETSC_FALSE));
  PetscCall(VecDestroy(&o->work));
  PetscCall(PetscFree(o->points.xy));
  PetscCall(PetscFree(o->states));
  PetscCall(PetscFree(o));
  PetscCall(changed);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputHasReplaced(SamOutput o, PetscBool *replaced)
{
  PetscFunctionBegin;
  *replaced = o->replaced;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputNames(const char filename[], char **xdmf, char **temporary)
{
  PetscFunctionBegin;
  PetscCall(SamXdmfMakeName(filename, xdmf));
  PetscCall(SamFileNameBeside(filename, ".tmp", temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputGetXdmf(SamOutput o, const char **filename)
{
  PetscFunctionBegin;
  *filename = o->xdmf ? SamXdmfGetName(o->xdmf) : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- attributes ---- */

PetscErrorCode SamOutputSetReals(SamOutput o, const char name[], PetscInt count, const PetscReal values[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamFileWriteAttribute(o->f, o->f->id, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, values);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetParameters(SamOutput o, const SamParameters *parameters)
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamParametersWrite(o->f, parameters);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetText(SamOutput o, const char name[], const char text[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamFileWriteTextAttribute(o->f, o->f->id, name, text);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

/* Appends a number to a series, or a square matrix of n rows; rank 0 writes it. */
static void Append(SamOutput o, hid_t dataset, hid_t type, hsize_t index, hsize_t n, const void *numbers)
{
  const hsize_t size[3] = {index + 1, n, n}, start[3] = {index, 0, 0}, one[3] = {1, n, n}, all = n * n;
  const hid_t   memory = SamFileNote(o->f, H5Screate_simple(1, &all, NULL));
  hid_t         space;

  (void)SamFileNote(o->f, H5Dset_extent(dataset, size));
  space = SamFileNote(o->f, H5Dget_space(dataset));
  if (o->f->rank == 0) {
    (void)SamFileNote(o->f, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, one, NULL));
  } else {
    (void)SamFileNote(o->f, H5Sselect_none(space));
    (void)SamFileNote(o->f, H5Sselect_none(memory));
  }
  (void)SamFileNote(o->f, H5Dwrite(dataset, type, memory, space, o->f->transfer, numbers));
  (void)SamFileNote(o->f, H5Sclose(space));
  (void)SamFileNote(o->f, H5Sclose(memory));
}

/* Appends a row to a series, from a SamStep or SamLifeReport. */
static void AppendRow(SamOutput o, SamOutputSeriesKind kind, const void *row)
{
  const SamOutputSeries *s  = &SamOutputAllSeries[kind];
  const hsize_t          at = o->rows[kind];

  for (PetscInt c = 0; c < s->count; c++) {
    const char *const place = (const char *)row + s->columns[c].offset;
    double            real;
    int64_t           whole;

    if (o->columns[kind][c] < 0) continue; /* an optional column that this file does not have */
    switch (s->columns[c].kind) {
    case SAM_COLUMN_REAL:
      real = (double)*(const PetscReal *)place;
      Append(o, o->columns[kind][c], H5T_NATIVE_DOUBLE, at, 1, &real);
      break;
    case SAM_COLUMN_INT:
      whole = (int64_t) * (const PetscInt *)place;
      Append(o, o->columns[kind][c], H5T_NATIVE_INT64, at, 1, &whole);
      break;
    case SAM_COLUMN_STATUS:
      whole = (int64_t) * (const SamStatus *)place;
      Append(o, o->columns[kind][c], H5T_NATIVE_INT64, at, 1, &whole);
      break;
    case SAM_COLUMN_MATRIX:
      Append(o, o->columns[kind][c], H5T_NATIVE_DOUBLE, at, SAM_COMPONENTS, place);
      break;
    }
  }
}

static void AppendField(SamOutput o, hid_t dataset, hid_t type, const void *values)
{
  const hsize_t size[3] = {o->saved + 1, (hsize_t)o->f->grid->ny, (hsize_t)o->f->grid->nx};

  (void)SamFileNote(o->f, H5Dset_extent(dataset, size));
  SamFileWriteLayer(o->f, dataset, type, o->saved, values);
}

static PetscErrorCode AppendFields(SamOutput o, SamOutputValues values, void *context)
{
  PetscFunctionBegin;
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    const void *cells;

    if (o->fields[f] < 0) continue;
    PetscCall(values(o, f, context, &cells));
    if (SamOutputFields[f].kind == SAM_FIELD_POINTS) {
      SamOutputAppendPoints(o, o->fields[f], o->saved, (const SamOutputPoints *)cells);
      continue;
    }
    AppendField(o, o->fields[f], SamOutputFields[f].kind == SAM_FIELD_STATE ? H5T_NATIVE_SCHAR : H5T_NATIVE_DOUBLE,
                cells);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the file complete up to here: first sets its end of data, then lets HDF5 write its metadata. */
static PetscErrorCode Flush(SamOutput o)
{
  int error = 0;

  PetscFunctionBegin;
  PetscCall(SamFileAgree(o->f)); /* a step that failed on any rank must not be flushed */
  if (o->f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->f->rank == 0) error = MoveEnd(o->f->filename);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, o->f->grid->comm)); /* no rank flushes before the end is set */
  if (error) {
    o->f->failed = PETSC_TRUE;
    (void)snprintf(o->f->reason, sizeof(o->f->reason), "%s", strerror(error));
  } else
    (void)SamFileNote(o->f, H5Fflush(o->f->id, H5F_SCOPE_GLOBAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before anything is appended: raises an error if the file is not as it was left; reserves disk space. */
static PetscErrorCode BeginRow(SamOutput o, off_t bytes)
{
  PetscFunctionBegin;
  PetscCheck(!o->broken, o->f->grid->comm, SAM_ERR_FILE, "-output %s: cannot be written: %s", o->f->filename,
             o->f->reason);
  if (!o->copying) PetscCall(SamHoldCheck(o->f->grid, "output", o->f->filename, &o->hold));
  if (!o->copying) PetscCall(SamFileReserve(o->f, bytes));
  PetscCall(SamFileBegin(o->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EndRow(SamOutput o)
{
  PetscErrorCode ierr = SamFileEnd(o->f);

  PetscFunctionBegin;
  if (ierr) o->broken = PETSC_TRUE;
  PetscCall(ierr);
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputAppend(SamOutput o, const SamStep *step, PetscReal time, SamOutputValues values, void *context)
{
  PetscFunctionBegin;
  PetscCall(BeginRow(o, values ? SamOutputFieldBytes(o) : 0));
  if (step) AppendRow(o, SAM_SERIES_HISTORY, step);
  if (values) {
    const double now = (double)time;

    Append(o, o->time, H5T_NATIVE_DOUBLE, o->saved, 1, &now);
    PetscCall(AppendFields(o, values, context));
    SamOutputCountVTK(o, o->saved + 1);
    o->saved_time = time;
  }
  if (!o->copying) PetscCall(Flush(o));
  o->rows[SAM_SERIES_HISTORY] += step ? 1 : 0;
  o->saved += values ? 1 : 0;
  PetscCall(EndRow(o));
  if (values && o->xdmf) PetscCall(SamXdmfAddStep(o->xdmf, (PetscInt)o->saved - 1, time));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputAppendCycle(SamOutput o, const SamLifeReport *cycle)
{
  PetscFunctionBegin;
  PetscCall(BeginRow(o, 0));
  AppendRow(o, SAM_SERIES_WEAR, cycle);
  if (!o->copying) PetscCall(Flush(o));
  o->rows[SAM_SERIES_WEAR]++;
  PetscCall(EndRow(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives SamOutputAppend() the fields of a contact. */
typedef struct {
  SamContact    contact;
  Vec           field; /* whose array is in use; NULL: none */
  const double *array;
} ContactFields;

static PetscErrorCode Release(ContactFields *from)
{
  PetscFunctionBegin;
  if (from->field) PetscCall(VecRestoreArrayRead(from->field, &from->array));
  from->field = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetContactValues(SamOutput o, PetscInt f, void *context, const void **values)
{
  const SamOutputField *field = &SamOutputFields[f];
  const PetscInt        cells = o->f->grid->cells;
  ContactFields        *from  = (ContactFields *)context;
  PetscInt              component;
  SamEdge               edge;

  PetscFunctionBegin;
  PetscCall(Release(from));
  if (field->kind == SAM_FIELD_POINTS) {
    PetscCall(SamContactFindEdge(from->contact, (SamContactEdge)field->component, NULL, &edge));
    PetscCall(SamOutputGatherPoints(o, &edge));
    PetscCall(SamEdgeDestroy(&edge));
    *values = &o->points;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (field->compute && !o->work) PetscCall(SamGridCreateVec(o->f->grid, 1, &o->work));
  PetscCall(SamOutputFindField(field, from->contact, o->set.wear, o->work, &from->field, &component));
  PetscCall(VecGetArrayRead(from->field, &from->array));
  *values = from->array + component * cells;
  if (field->kind == SAM_FIELD_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < cells; k++) o->states[k] = (signed char)from->array[k];
  *values = o->states;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Write(SamOutput o, const SamStep *step, PetscReal time, SamContact contact)
{
  ContactFields from = {.contact = contact};

  PetscFunctionBegin;
  PetscCall(SamOutputAppend(o, step, time, contact ? GetContactValues : NULL, &from));
  PetscCall(Release(&from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteStep(SamOutput o, const SamStep *step, SamContact contact)
{
  PetscFunctionBegin;
  PetscCall(Write(o, step, step->control.time, contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteFields(SamOutput o, PetscReal time, SamContact contact)
{
  PetscFunctionBegin;
  PetscCall(Write(o, NULL, time, contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteCycle(SamOutput o, const SamLifeReport *cycle)
{
  PetscFunctionBegin;
  PetscCheck(o->columns[SAM_SERIES_WEAR][0] >= 0, o->f->grid->comm, PETSC_ERR_ORDER, "The file has no group wear");
  PetscCall(SamOutputAppendCycle(o, cycle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputGetSaved(SamOutput o, PetscInt *steps, PetscInt *saved, PetscReal *time)
{
  PetscFunctionBegin;
  if (steps) *steps = (PetscInt)o->rows[SAM_SERIES_HISTORY];
  if (saved) *saved = (PetscInt)o->saved;
  if (time) *time = o->saved_time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Results in an HDF5 file, written by all ranks together through MPI-IO.

  Datasets stay open and grow by one along time with each step; each rank writes its rows.

  Open MPI's collective writes, and HDF5 where it flushes its administration, may hang for ever when writing fails on one
  rank alone. So what is likely to go wrong is found before MPI-IO sees it, on rank 0: a name that cannot be written, and
  a disk or quota that is full, by allocating the space of a step first. The file is then in order as it is, and
  can be closed.
*/
#include "hdf5impl.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#define ADMINISTRATION (1 << 20) /* bytes, more than HDF5 needs for its administration at creation or for a step */

/* ---- errors ---- */

/* HDF5 prints its own stack of errors unless told not to. */
static void Silence(SamOutput o)
{
  (void)SamOutputNote(o, H5Eget_auto2(H5E_DEFAULT, &o->print, &o->print_data));
  (void)SamOutputNote(o, H5Eset_auto2(H5E_DEFAULT, NULL, NULL));
}

static void Unsilence(SamOutput o)
{
  (void)SamOutputNote(o, H5Eset_auto2(H5E_DEFAULT, o->print, o->print_data));
}

PetscErrorCode SamOutputBegin(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_OUTPUT], 0, 0, 0, 0));
  Silence(o);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the failure of one rank that of all. */
static PetscErrorCode Agree(SamOutput o)
{
  struct {
    int good, rank;
  } worst;

  PetscFunctionBegin;
  worst.good = o->failed ? 0 : 1;
  worst.rank = o->rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_2INT, MPI_MINLOC, o->grid->comm));
  if (!worst.good) {
    o->failed = PETSC_TRUE;
    PetscCallMPI(MPI_Bcast(o->reason, (PetscMPIInt)sizeof(o->reason), MPI_CHAR, worst.rank, o->grid->comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputEnd(SamOutput o)
{
  PetscFunctionBegin;
  Unsilence(o);
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_OUTPUT], 0, 0, 0, 0));
  PetscCall(Agree(o));
  PetscCheck(!o->failed, o->grid->comm, SAM_ERR_FILE, "-output %s: cannot be written: %s", o->filename, o->reason);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first entry of a walk upward through HDF5's errors is where it went wrong. */
static herr_t TakeReason(unsigned n, const H5E_error2_t *error, void *reason)
{
  if (n == 0 && error->desc) (void)snprintf((char *)reason, sizeof(((SamOutput)NULL)->reason), "%s", error->desc);
  return 0;
}

hid_t SamOutputNote(SamOutput o, hid_t result)
{
  if (result >= 0 || o->failed) return result;
  o->failed = PETSC_TRUE;
  (void)snprintf(o->reason, sizeof(o->reason), "HDF5 failed");
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, TakeReason, o->reason);
  return result;
}

/* ---- options ---- */

static PetscErrorCode GetSettings(MPI_Comm comm, SamOutputSettings *set)
{
  PetscFunctionBegin;
  *set = (SamOutputSettings){.compress = 0, .chunk = {1024, 256}, .xdmf = PETSC_TRUE};
  PetscCall(SamOptionsInt(NULL, "output_compress", "level of compression of the fields, 0 (none) to 9", 0, &set->compress, NULL));
  PetscCheck(set->compress <= 9, comm, SAM_ERR_USER, "-output_compress %" PetscInt_FMT ": expected a whole number from 0 to 9", set->compress);
  PetscCheck(set->compress == 0 || H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0, comm, SAM_ERR_USER, "-output_compress %" PetscInt_FMT ": this HDF5 was built without zlib", set->compress);
  PetscCall(SamOptionsIntPair(NULL, "output_chunk", "most cells of a chunk of the file in x[,y]", 1, set->chunk, NULL));
  PetscCall(SamOptionsBool(NULL, "output_xdmf", "an XDMF file beside the results, for ParaView and VisIt", &set->xdmf, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCheckOptions(MPI_Comm comm)
{
  SamOutputSettings set;

  PetscFunctionBegin;
  PetscCall(GetSettings(comm, &set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- looking at the file before HDF5 does, on one rank; these return an errno or 0 ---- */

/* Allocates this many bytes beyond the end of the file, which becomes that much longer if they are to be kept. */
static int Reserve(int file, off_t bytes, PetscBool keep)
{
  struct stat    status;
  struct statvfs space;
  int            error = EOPNOTSUPP;

  if (fstat(file, &status)) return errno;
#if defined(__linux__)
  error = fallocate(file, 0, status.st_size, bytes) ? errno : 0;
  if ((error || !keep) && ftruncate(file, status.st_size)) return errno; /* part may be allocated */
#endif
  if (error != EOPNOTSUPP && error != ENOSYS) return error;
  if (fstatvfs(file, &space)) return errno;
  if ((double)space.f_bavail * (double)space.f_frsize < (double)bytes) return ENOSPC;
  return keep && ftruncate(file, status.st_size + bytes) ? errno : 0;
}

static int ReserveInFile(const char filename[], off_t bytes)
{
  const int file = open(filename, O_WRONLY);
  int       error;

  if (file < 0) return errno;
  error = Reserve(file, bytes, PETSC_TRUE);
  return close(file) && !error ? errno : error;
}

/*
  Moves what the superblock says is the end of the data to the end of the file, before HDF5 writes what points there: the
  space of a step has been reserved, so that it lies before. HDF5 itself tells the end last; a run that is killed in
  between would leave datasets that lead beyond it, and with them steps that were complete before. Version 0 of the superblock has no checksum and the end at byte 40 (HDF5 file format
  specification, II.A); of others this is left to HDF5.
*/
#define SUPERBLOCK_VERSION 8
#define SUPERBLOCK_OFFSETS 13 /* bytes of an address */
#define SUPERBLOCK_END     40
static int MoveEnd(const char filename[])
{
  const int     file = open(filename, O_RDWR);
  unsigned char start[SUPERBLOCK_END], end[8];
  struct stat   status;
  int           error = 0;

  if (file < 0) return errno;
  errno = EIO; /* of what is shorter than it should be */
  if (pread(file, start, sizeof(start), 0) != (ssize_t)sizeof(start) || fstat(file, &status)) error = errno;
  else if (start[SUPERBLOCK_VERSION] == 0 && start[SUPERBLOCK_OFFSETS] == sizeof(end)) {
    for (unsigned k = 0; k < sizeof(end); k++) end[k] = (unsigned char)((uint64_t)status.st_size >> 8 * k & 0xff);
    if (pwrite(file, end, sizeof(end), SUPERBLOCK_END) != (ssize_t)sizeof(end)) error = errno;
  }
  return close(file) && !error ? errno : error;
}

/* Whether a file of the name can be written; leaves an existing one as it is, and none that was not there. */
static int Probe(const char filename[])
{
  struct stat status, link;
  const int   exists = !stat(filename, &status), named = !lstat(filename, &link); /* a link may lead nowhere */
  int         file, error;

  if (exists && S_ISDIR(status.st_mode)) return EISDIR;
  if (exists && !S_ISREG(status.st_mode)) return EINVAL; /* a pipe would wait for its reader */
  file = open(filename, O_WRONLY | O_CREAT, 0666);
  if (file < 0) return errno;
  error = Reserve(file, ADMINISTRATION, PETSC_FALSE);
  if (close(file) && !error) error = errno;
  if (!named && unlink(filename) && !error) error = errno;
  return error;
}

PetscErrorCode SamOutputRaise(SamGrid grid, const char filename[], int error)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, grid->comm));
  PetscCheck(!error, grid->comm, SAM_ERR_FILE, "-output %s: cannot be written: %s", filename, strerror(error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckName(SamGrid grid, const char filename[])
{
  PetscMPIInt rank;
  int         error = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (rank == 0) error = Probe(filename);
  PetscCall(SamOutputRaise(grid, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

/* An object with nothing open. */
static PetscErrorCode Allocate(SamGrid grid, const char filename[], const SamOutputSettings *set, SamOutput *output)
{
  SamOutput o;

  PetscFunctionBegin;
  PetscCall(PetscNew(&o));
  PetscCall(SamGridReference(grid));
  o->grid = grid;
  o->set  = *set;
  o->file = o->transfer = o->time = o->state = o->vtk_steps = -1;
  for (PetscInt f = 0; f < SAM_OUTPUT_FIELDS; f++) o->fields[f] = -1;
  for (PetscInt c = 0; c < SAM_OUTPUT_COLUMNS; c++) o->columns[c] = -1;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &o->rank));
  PetscCall(PetscStrallocpy(filename, &o->filename));
  PetscCall(PetscMalloc1(grid->cells, &o->states));
  *output = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CloseFile(SamOutput o)
{
  SamOutputCloseLayout(o);
  if (o->transfer >= 0) (void)SamOutputNote(o, H5Pclose(o->transfer));
  if (o->file >= 0) (void)SamOutputNote(o, H5Fclose(o->file));
  o->transfer = o->file = -1;
}

static PetscErrorCode Free(SamOutput *output)
{
  PetscFunctionBegin;
  PetscCall(SamXdmfDestroy(&(*output)->xdmf));
  PetscCall(SamGridDestroy(&(*output)->grid));
  PetscCall(PetscFree((*output)->filename));
  PetscCall(PetscFree((*output)->states));
  PetscCall(PetscFree(*output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFile(SamOutput o)
{
  hid_t access;

  PetscFunctionBegin;
  PetscCall(SamOutputBegin(o));
  access = SamOutputNote(o, H5Pcreate(H5P_FILE_ACCESS));
  (void)SamOutputNote(o, H5Pset_fapl_mpio(access, o->grid->comm, MPI_INFO_NULL));
  (void)SamOutputNote(o, H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  o->transfer = SamOutputNote(o, H5Pcreate(H5P_DATASET_XFER));
  (void)SamOutputNote(o, H5Pset_dxpl_mpio(o->transfer, H5FD_MPIO_COLLECTIVE));
  o->file = SamOutputNote(o, H5Fcreate(o->filename, H5F_ACC_TRUNC, H5P_DEFAULT, access));
  (void)SamOutputNote(o, H5Pclose(access));
  PetscCall(SamOutputEnd(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateDatasets(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(SamOutputBegin(o));
  PetscCall(SamOutputCreateLayout(o));
  (void)SamOutputNote(o, H5Fflush(o->file, H5F_SCOPE_GLOBAL));
  PetscCall(SamOutputEnd(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], SamOutput *output)
{
  SamOutputSettings set;
  PetscErrorCode    ierr;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamInitialize());
  PetscCall(GetSettings(grid->comm, &set));
  PetscCall(CheckName(grid, filename));
  PetscCall(Allocate(grid, filename, &set, output));
  ierr = set.xdmf ? SamXdmfCreate(grid, filename, &(*output)->xdmf) : PETSC_SUCCESS; /* first: the old results stay if it fails */
  if (!ierr) {
    ierr = CreateFile(*output);
    if (ierr) (*output)->file = -1; /* not closed: that would wait for a rank that could not open it */
    else ierr = CreateDatasets(*output);
  }
  if (ierr) {
    Silence(*output);
    CloseFile(*output);
    Unsilence(*output);
    PetscCall(Free(output));
  }
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputDestroy(SamOutput *output)
{
  SamOutput      o = *output;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output = NULL;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  o->failed = PETSC_FALSE; /* what failed before has been raised */
  PetscCall(SamOutputBegin(o));
  if (!o->broken) CloseFile(o);
  ierr = SamOutputEnd(o);
  PetscCall(Free(&o));
  PetscCall(ierr);
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
  PetscCall(SamOutputBegin(o));
  SamOutputWriteAttribute(o, o->file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, values);
  PetscCall(SamOutputEnd(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetText(SamOutput o, const char name[], const char text[])
{
  PetscFunctionBegin;
  PetscCall(SamOutputBegin(o));
  SamOutputWriteTextAttribute(o, o->file, name, text);
  PetscCall(SamOutputEnd(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

/* Appends a number to a series, which rank 0 writes. */
static void AppendNumber(SamOutput o, hid_t dataset, hid_t type, hsize_t index, const void *number)
{
  const hsize_t size = index + 1, one = 1;
  const hid_t   memory = SamOutputNote(o, H5Screate_simple(1, &one, NULL));
  hid_t         space;

  (void)SamOutputNote(o, H5Dset_extent(dataset, &size));
  space = SamOutputNote(o, H5Dget_space(dataset));
  if (o->rank == 0) {
    (void)SamOutputNote(o, H5Sselect_hyperslab(space, H5S_SELECT_SET, &index, NULL, &one, NULL));
  } else {
    (void)SamOutputNote(o, H5Sselect_none(space));
    (void)SamOutputNote(o, H5Sselect_none(memory));
  }
  (void)SamOutputNote(o, H5Dwrite(dataset, type, memory, space, o->transfer, number));
  (void)SamOutputNote(o, H5Sclose(space));
  (void)SamOutputNote(o, H5Sclose(memory));
}

static void AppendHistory(SamOutput o, const SamStep *step)
{
  for (PetscInt c = 0; c < SAM_OUTPUT_COLUMNS; c++) {
    const char *const place = (const char *)step + SamOutputColumns[c].offset;
    double            real;
    int64_t           whole;

    switch (SamOutputColumns[c].kind) {
    case SAM_COLUMN_REAL:
      real = (double)*(const PetscReal *)place;
      AppendNumber(o, o->columns[c], H5T_NATIVE_DOUBLE, o->steps, &real);
      break;
    case SAM_COLUMN_INT:
      whole = (int64_t)*(const PetscInt *)place;
      AppendNumber(o, o->columns[c], H5T_NATIVE_INT64, o->steps, &whole);
      break;
    case SAM_COLUMN_STATUS:
      whole = (int64_t)*(const SamStatus *)place;
      AppendNumber(o, o->columns[c], H5T_NATIVE_INT64, o->steps, &whole);
      break;
    }
  }
}

/* Appends a field, of which each rank writes its rows; a rank without rows takes part with an empty selection. */
static void AppendField(SamOutput o, hid_t dataset, hid_t type, const void *values)
{
  const SamGrid grid     = o->grid;
  const hsize_t size[3]  = {o->saved + 1, (hsize_t)grid->ny, (hsize_t)grid->nx};
  const hsize_t start[3] = {o->saved, (hsize_t)grid->row_start, 0};
  const hsize_t count[3] = {1, (hsize_t)grid->rows, (hsize_t)grid->nx};
  const hid_t   memory   = SamOutputNote(o, H5Screate_simple(3, count, NULL));
  const double  nothing  = 0;
  hid_t         space;

  (void)SamOutputNote(o, H5Dset_extent(dataset, size));
  space = SamOutputNote(o, H5Dget_space(dataset));
  if (grid->rows) {
    (void)SamOutputNote(o, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL));
  } else {
    (void)SamOutputNote(o, H5Sselect_none(space));
    (void)SamOutputNote(o, H5Sselect_none(memory));
  }
  (void)SamOutputNote(o, H5Dwrite(dataset, type, memory, space, o->transfer, grid->rows ? values : &nothing));
  (void)SamOutputNote(o, H5Sclose(space));
  (void)SamOutputNote(o, H5Sclose(memory));
}

static PetscErrorCode AppendState(SamOutput o, const SamFields *fields, PetscReal friction)
{
  const PetscInt     cells = o->grid->cells;
  const PetscScalar *p, *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(fields->pressure, &p));
  PetscCall(VecGetArrayRead(fields->shear, &q));
  for (PetscInt k = 0; k < cells; k++) o->states[k] = (signed char)SamStateOf(p[k], q[k], q[cells + k], friction);
  PetscCall(VecRestoreArrayRead(fields->shear, &q));
  PetscCall(VecRestoreArrayRead(fields->pressure, &p));
  AppendField(o, o->state, H5T_NATIVE_SCHAR, o->states);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AppendFields(SamOutput o, const SamFields *fields, PetscReal friction)
{
  PetscFunctionBegin;
  for (PetscInt f = 0; f < SAM_OUTPUT_FIELDS; f++) {
    const Vec          vec = *(const Vec *)((const char *)fields + SamOutputFields[f].offset);
    const PetscScalar *values;

    PetscCall(VecGetArrayRead(vec, &values));
    AppendField(o, o->fields[f], H5T_NATIVE_DOUBLE, values + SamOutputFields[f].component * o->grid->cells);
    PetscCall(VecRestoreArrayRead(vec, &values));
  }
  PetscCall(AppendState(o, fields, friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for a step, by which the file becomes longer; what is not needed of it, HDF5 cuts off when it flushes. */
static PetscErrorCode ReserveStep(SamOutput o, PetscBool has_fields)
{
  const off_t bytes = ADMINISTRATION + (has_fields ? SamOutputFieldBytes(o) : 0);
  int         error = 0;

  PetscFunctionBegin;
  if (o->rank == 0) error = ReserveInFile(o->filename, bytes);
  PetscCall(SamOutputRaise(o->grid, o->filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the file complete up to here: first its end is told, then HDF5 writes its administration. */
static PetscErrorCode Flush(SamOutput o)
{
  int error = 0;

  PetscFunctionBegin;
  PetscCall(Agree(o)); /* flush only what is there */
  if (o->failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->rank == 0) error = MoveEnd(o->filename);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, o->grid->comm)); /* readers see the end before what points there */
  if (error) {
    o->failed = PETSC_TRUE;
    (void)snprintf(o->reason, sizeof(o->reason), "%s", strerror(error));
  } else (void)SamOutputNote(o, H5Fflush(o->file, H5F_SCOPE_GLOBAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputWriteStep(SamOutput o, const SamStep *step, const SamFields *fields, PetscReal friction)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCheck(!o->broken, o->grid->comm, SAM_ERR_FILE, "-output %s: cannot be written: %s", o->filename, o->reason);
  PetscCall(ReserveStep(o, fields ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(SamOutputBegin(o));
  AppendHistory(o, step);
  if (fields) {
    const double time = (double)step->time;

    AppendNumber(o, o->time, H5T_NATIVE_DOUBLE, o->saved, &time);
    PetscCall(AppendFields(o, fields, friction));
    SamOutputCountVTK(o, o->saved + 1);
  }
  PetscCall(Flush(o));
  o->steps++;
  o->saved += fields ? 1 : 0;
  ierr = SamOutputEnd(o);
  if (ierr) o->broken = PETSC_TRUE;
  PetscCall(ierr);
  if (fields && o->xdmf) PetscCall(SamXdmfAddStep(o->xdmf, (PetscInt)o->saved - 1, step->time));
  PetscFunctionReturn(PETSC_SUCCESS);
}

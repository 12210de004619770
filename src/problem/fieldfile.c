/*
  Fields read from HDF5 datasets of shape (ny, nx).

  A file may be wrong in many ways. Rank 0 examines it with the serial driver, in a child process, and broadcasts its
  verdict. So all ranks raise the same error, none waits for another, and a damaged file does no harm. Only then all
  read their rows.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/chunks.h>
#include <petsam/private/fieldfile.h>
#include <petsam/private/lengths.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef enum {
  GOOD,
  UNREADABLE,
  NO_FILE,
  NOT_HDF5,
  DAMAGED,
  NO_DATASET,
  WRONG_TYPE,
  WRONG_RANK,
  WRONG_SHAPE,
  NOT_FINITE,
  TOO_SMALL,
  WRONG_LENGTHS, /* see lengths.problem */
  WRONG_SIZE
} Kind;

typedef struct {
  Kind      kind;
  long long detail[2]; /* UNREADABLE: errno; WRONG_RANK: rank; WRONG_SHAPE: shape; NOT_FINITE, TOO_SMALL: row, column */
  SamLengths lengths;  /* of a source that is one */
} Verdict;

/* A surface is stretched to the grid without a word up to this: no instrument's calibration is better. */
static const double size_tolerance = 1e-3;

/* HDF5 prints its own error stack unless that is switched off; this holds what to restore. */
typedef struct {
  H5E_auto2_t print;
  void       *data;
} ErrorOutput;

static ErrorOutput Silence(void)
{
  ErrorOutput output = {NULL, NULL};

  (void)H5Eget_auto2(H5E_DEFAULT, &output.print, &output.data);
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return output;
}

static void Unsilence(ErrorOutput output)
{
  (void)H5Eset_auto2(H5E_DEFAULT, output.print, output.data);
}

PetscErrorCode SamFieldFileSetFromOptions(SamFieldFile *source, const SamOptions *from, const char help[])
{
  const char *prefix = SamOptionsPrefix(from);
  char        text[96];
  PetscBool   set, print;

  PetscFunctionBegin;
  PetscCall(SamSetPrefix(source->prefix, prefix));
  PetscCall(PetscStrncpy(source->dataset, source->default_dataset, sizeof(source->dataset)));
  PetscCall(PetscSNPrintf(text, sizeof(text), "dataset in it: (ny, nx), %s", source->unit));
  PetscCall(SamOptionsFile(from, source->file_option, help, source->file, sizeof(source->file), NULL));
  PetscCall(SamOptionsString(from, source->dataset_option, text, source->dataset, sizeof(source->dataset), &set));
  PetscCall(SamPrintHelp(&print));
  PetscCheck(!set || source->file[0] || print, from->comm, SAM_ERR_USER, "-%s%s is given without -%s%s", prefix,
             source->dataset_option, prefix, source->file_option);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static Verdict JudgeShape(SamGrid grid, hid_t space)
{
  Verdict   verdict = {.kind = GOOD};
  hsize_t   shape[2];
  const int rank = H5Sget_simple_extent_ndims(space);

  if (rank != 2 || H5Sget_simple_extent_dims(space, shape, NULL) != 2) {
    verdict.kind      = WRONG_RANK;
    verdict.detail[0] = rank;
  } else if (shape[0] != (hsize_t)grid->ny || shape[1] != (hsize_t)grid->nx) {
    verdict.kind      = WRONG_SHAPE;
    verdict.detail[0] = (long long)shape[0];
    verdict.detail[1] = (long long)shape[1];
  }
  return verdict;
}

static Verdict JudgeDataset(SamGrid grid, hid_t dataset)
{
  const hid_t       space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  const H5T_class_t kind    = H5Tget_class(type);
  Verdict           verdict = {.kind = DAMAGED};

  if (space >= 0 && type >= 0) {
    verdict = JudgeShape(grid, space);
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) verdict.kind = WRONG_TYPE;
  }
  if (type >= 0) (void)H5Tclose(type);
  if (space >= 0) (void)H5Sclose(space);
  return verdict;
}

/* Whether all data of a dataset lie within the file; in a damaged one they may be anywhere. */
static PetscBool HasAllData(hid_t file, hid_t dataset)
{
  const hid_t creation = H5Dget_create_plist(dataset);
  const int   chunked  = creation >= 0 && H5Pget_layout(creation) == H5D_CHUNKED,
            plain      = creation >= 0 && H5Pget_layout(creation) == H5D_CONTIGUOUS && !H5Pget_external_count(creation);
  hsize_t   size       = 0;
  PetscBool good       = creation >= 0 && H5Fget_filesize(file, &size) >= 0;

  if (good && chunked) {
    good = SamChunksAreWhole(file, dataset, 2, NULL, PETSC_FALSE);
  } else if (good && plain) {
    const haddr_t address = H5Dget_offset(dataset);

    if (address != HADDR_UNDEF && address + H5Dget_storage_size(dataset) > size) good = PETSC_FALSE;
  }
  if (creation >= 0) (void)H5Pclose(creation);
  return good;
}

/* Finds out what the numbers mean, and whether the surface is as large as the grid. */
static void JudgeLengths(const SamFieldFile *source, SamGrid grid, hid_t file, hid_t dataset, Verdict *verdict)
{
  const hsize_t shape[2] = {(hsize_t)grid->ny, (hsize_t)grid->nx};
  double *const size     = verdict->lengths.size;

  SamLengthsRead(file, dataset, source->dataset, shape, &verdict->lengths);
  if (verdict->lengths.problem) verdict->kind = WRONG_LENGTHS;
  for (int d = 0; d < 2 && verdict->kind == GOOD; d++)
    if (size[d] > 0 && !(fabs(size[d] - grid->width[d]) <= size_tolerance * grid->width[d])) verdict->kind = WRONG_SIZE;
  for (int d = 0; d < 2; d++)
    if (!(size[d] > 0)) size[d] = grid->width[d]; /* for the message: one axis may be missing */
}

/* Examines the file, on one rank. */
static Verdict Judge(const SamFieldFile *source, SamGrid grid)
{
  Verdict     verdict = {.kind = GOOD};
  struct stat status;
  hid_t       file, dataset;

  if (stat(source->file, &status) || access(source->file, R_OK))
    return (Verdict){.kind = UNREADABLE, .detail = {errno}};
  if (S_ISDIR(status.st_mode)) return (Verdict){.kind = UNREADABLE, .detail = {EISDIR}};
  if (!S_ISREG(status.st_mode)) return (Verdict){.kind = NO_FILE}; /* a pipe would wait for its writer */
  if (H5Fis_hdf5(source->file) <= 0) return (Verdict){.kind = NOT_HDF5};
  file = H5Fopen(source->file, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return (Verdict){.kind = DAMAGED};
  dataset = H5Dopen2(file, source->dataset, H5P_DEFAULT);
  if (dataset < 0) {
    verdict.kind = NO_DATASET;
  } else {
    verdict = JudgeDataset(grid, dataset);
    if (verdict.kind == GOOD && !HasAllData(file, dataset)) verdict.kind = DAMAGED;
    if (verdict.kind == GOOD && source->is_length) JudgeLengths(source, grid, file, dataset, &verdict);
    (void)H5Dclose(dataset);
  }
  (void)H5Fclose(file);
  return verdict;
}

/* The message about a file whose lengths cannot be taken. */
static PetscErrorCode RaiseLengths(const SamFieldFile *source, SamGrid grid, const Verdict *verdict)
{
  const SamLengths *const lengths = &verdict->lengths;
  const char *const option = source->file_option, *const prefix = source->prefix, *const file = source->file;
  const char *const of = lengths->name[0] ? lengths->name : source->dataset;

  PetscFunctionBegin;
  PetscCheck(verdict->kind != WRONG_SIZE, grid->comm, SAM_ERR_FILE,
             "-%s%s %s: %s is a surface of %.10g m x %.10g m by its x and y or its size, but the grid is %.10g m x "
             "%.10g m: give -grid_size %.10g,%.10g, or cut the surface by petsam-surface",
             prefix, option, file, source->dataset, lengths->size[0], lengths->size[1], (double)grid->width[0],
             (double)grid->width[1], lengths->size[0], lengths->size[1]);
  switch (lengths->problem) {
  case SAM_LENGTHS_BAD_UNITS:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: %s: its attribute units is \"%s\": known are " SAM_LENGTHS_UNITS,
            prefix, option, file, of, lengths->text);
  case SAM_LENGTHS_BAD_QUANTITY:
    SETERRQ(grid->comm, SAM_ERR_FILE,
            "-%s%s %s: %s: its attribute quantity is \"%s\": known are " SAM_LENGTHS_QUANTITIES
            " (heights of body 1 or 2, positive out of the body)",
            prefix, option, file, of, lengths->text);
  case SAM_LENGTHS_PACKED:
    SETERRQ(grid->comm, SAM_ERR_FILE,
            "-%s%s %s: %s: its attributes scale_factor or add_offset say that it is packed: expected the numbers "
            "themselves, and no such attributes",
            prefix, option, file, of);
  case SAM_LENGTHS_FALLING_AXIS:
    SETERRQ(grid->comm, SAM_ERR_FILE,
            "-%s%s %s: %s falls along the file, so the surface would be mirrored: turn it and the values of %s round",
            prefix, option, file, of, source->dataset);
  default: /* SAM_LENGTHS_BAD_SIZE */
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: %s: its attribute size is not two positive numbers: x, y in m", prefix,
            option, file, of);
  }
}

/* Names of datasets in the file's root, and of groups with a slash behind them, as many as there is room for. */
static void ListNames(const SamFieldFile *source, char list[], size_t size)
{
  const hid_t file = H5Fopen(source->file, H5F_ACC_RDONLY, H5P_DEFAULT);
  H5G_info_t  info;
  size_t      used = 0;

  list[0] = '\0';
  if (file < 0) return;
  if (H5Gget_info(file, &info) < 0) info.nlinks = 0;
  for (hsize_t k = 0; k < info.nlinks && used + 8 < size; k++) {
    const hid_t object = H5Oopen_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT);
    const int   group  = object >= 0 && H5Iget_type(object) == H5I_GROUP;
    char        name[64];

    if (H5Lget_name_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof(name), H5P_DEFAULT) > 0)
      used += (size_t)snprintf(list + used, size - used, "%s/%s%s", used ? ", " : "", name, group ? "/..." : "");
    if (object >= 0) (void)H5Oclose(object);
  }
  if (used + 8 >= size) (void)snprintf(list + size - 5, 5, " ...");
  (void)H5Fclose(file);
}

static PetscErrorCode Raise(const SamFieldFile *source, SamGrid grid, const Verdict *verdict)
{
  const char *const file = source->file, *const dataset = source->dataset;
  const long long ny = grid->ny, nx = grid->nx, *const detail = verdict->detail;

  PetscFunctionBegin;
  switch (verdict->kind) {
  case GOOD:
    PetscFunctionReturn(PETSC_SUCCESS);
  case UNREADABLE:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: cannot be read: %s", source->prefix, source->file_option, file,
            strerror((int)detail[0]));
  case NO_FILE:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: cannot be read: it is not a file", source->prefix, source->file_option,
            file);
  case NOT_HDF5:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: is not an HDF5 file; petsam-surface makes one of other formats",
            source->prefix, source->file_option, file);
  case WRONG_TYPE:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: %s does not hold real or whole numbers", source->prefix,
            source->file_option, file, dataset);
  case WRONG_RANK:
    SETERRQ(grid->comm, SAM_ERR_FILE,
            "-%s%s %s: %s has %lld dimension(s), expected shape (ny, nx) = (%lld, %lld), rows are y", source->prefix,
            source->file_option, file, dataset, detail[0], ny, nx);
  case WRONG_SHAPE:
    SETERRQ(grid->comm, SAM_ERR_FILE,
            "-%s%s %s: %s has shape (%lld, %lld), expected (ny, nx) = (%lld, %lld), rows are y: %s -grid_n %lld,%lld",
            source->prefix, source->file_option, file, dataset, detail[0], detail[1], ny, nx,
            detail[0] == nx && detail[1] == ny ? "transpose it, or give" : "it fits", detail[1], detail[0]);
  case NOT_FINITE:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: %s[%lld, %lld] is not a finite number", source->prefix,
            source->file_option, file, dataset, detail[0], detail[1]);
  case TOO_SMALL:
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: %s[%lld, %lld] is less than %g", source->prefix, source->file_option,
            file, dataset, detail[0], detail[1], (double)source->least);
  case WRONG_LENGTHS:
  case WRONG_SIZE:
    PetscCall(RaiseLengths(source, grid, verdict));
    PetscFunctionReturn(PETSC_SUCCESS);
  default: /* DAMAGED */
    SETERRQ(grid->comm, SAM_ERR_FILE, "-%s%s %s: %s cannot be read: the file is damaged or in use", source->prefix,
            source->file_option, file, dataset);
  }
}

typedef struct {
  const SamFieldFile *source;
  SamGrid             grid;
  Verdict             verdict;
  char                names[160]; /* of the datasets that there are, where the one that is wanted is not */
} Case;

static void JudgeCase(void *data)
{
  Case *c = (Case *)data;

  c->verdict = Judge(c->source, c->grid);
  if (c->verdict.kind == NO_DATASET) ListNames(c->source, c->names, sizeof(c->names));
}

/* Raises an error for a file that is no good; otherwise returns what its values are to be multiplied with. */
static PetscErrorCode CheckFile(const SamFieldFile *source, SamGrid grid, double *factor)
{
  Case        c = {.source = source, .grid = grid, .verdict = {.kind = GOOD}, .names = ""};
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (rank == 0 && !SamCallInChild(JudgeCase, &c, sizeof(c))) c.verdict.kind = DAMAGED;
  PetscCallMPI(MPI_Bcast(&c.verdict, (PetscMPIInt)sizeof(c.verdict), MPI_BYTE, 0, grid->comm));
  PetscCallMPI(MPI_Bcast(c.names, (PetscMPIInt)sizeof(c.names), MPI_CHAR, 0, grid->comm));
  PetscCheck(c.verdict.kind != NO_DATASET, grid->comm, SAM_ERR_FILE, "-%s%s %s: has no dataset %s (-%s%s); it has %s",
             source->prefix, source->file_option, source->file, source->dataset, source->prefix, source->dataset_option,
             c.names[0] ? c.names : "none");
  PetscCall(Raise(source, grid, &c.verdict));
  *factor = source->is_length ? c.verdict.lengths.factor : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens file and dataset on all ranks; an identifier is negative where that failed. */
static void Open(const SamFieldFile *source, SamGrid grid, hid_t *file, hid_t *dataset)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);

  *file = *dataset = -1;
  if (access >= 0 && H5Pset_fapl_mpio(access, grid->comm, MPI_INFO_NULL) >= 0)
    *file = H5Fopen(source->file, H5F_ACC_RDONLY, access);
  if (*file >= 0) *dataset = H5Dopen2(*file, source->dataset, H5P_DEFAULT);
  if (access >= 0) (void)H5Pclose(access);
}

/* Reads this rank's rows, without waiting for others: reading may fail on some ranks. */
static PetscBool ReadRows(SamGrid grid, hid_t dataset, double array[])
{
  const hsize_t start[2] = {(hsize_t)grid->row_start, 0}, count[2] = {(hsize_t)grid->rows, (hsize_t)grid->nx};
  const hid_t   space = H5Dget_space(dataset), memory = H5Screate_simple(2, count, NULL),
              transfer = H5Pcreate(H5P_DATASET_XFER);
  double    nothing;
  PetscBool good = PETSC_TRUE;
  herr_t    status;

  status = grid->rows ? H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) : H5Sselect_none(space);
  if (status < 0) good = PETSC_FALSE;
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, transfer, grid->rows ? array : &nothing) < 0)
    good = PETSC_FALSE;
  if (H5Pclose(transfer) < 0) good = PETSC_FALSE;
  if (H5Sclose(memory) < 0) good = PETSC_FALSE;
  if (H5Sclose(space) < 0) good = PETSC_FALSE;
  return good;
}

static PetscErrorCode Read(const SamFieldFile *source, SamGrid grid, double array[])
{
  hid_t  file, dataset;
  double bad;

  PetscFunctionBegin;
  Open(source, grid, &file, &dataset);
  bad = dataset < 0;
  if (bad == 0) bad = ReadRows(grid, dataset, array) ? 0 : 1;
  if (dataset >= 0 && H5Dclose(dataset) < 0) bad = 1;
  if (file >= 0 && H5Fclose(file) < 0) bad = 1;
  PetscCall(SamMax(grid->comm, 1, &bad));
  if (bad != 0) PetscCall(Raise(source, grid, &(Verdict){.kind = DAMAGED}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Raises an error for the first value, in the file's order, that is not finite, or else for the first below `least`. */
static PetscErrorCode CheckValues(const SamFieldFile *source, SamGrid grid, const double array[])
{
  const long long none   = (long long)grid->nx * grid->ny;
  long long       bad[2] = {none, none};

  PetscFunctionBegin;
  for (PetscInt k = grid->cells - 1; k >= 0; k--) {
    const long long cell = (long long)grid->row_start * grid->nx + k;

    if (!isfinite(array[k]))
      bad[0] = cell;
    else if (array[k] < source->least)
      bad[1] = cell;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bad, 2, MPI_LONG_LONG, MPI_MIN, grid->comm));
  if (bad[0] != none)
    PetscCall(Raise(source, grid, &(Verdict){.kind = NOT_FINITE, .detail = {bad[0] / grid->nx, bad[0] % grid->nx}}));
  if (bad[1] != none)
    PetscCall(Raise(source, grid, &(Verdict){.kind = TOO_SMALL, .detail = {bad[1] / grid->nx, bad[1] % grid->nx}}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The caller has switched off HDF5's own error output. */
static PetscErrorCode CheckAndRead(const SamFieldFile *source, SamGrid grid, Vec h)
{
  PetscScalar *array;
  double       factor;

  PetscFunctionBegin;
  PetscCall(CheckFile(source, grid, &factor));
  PetscCall(VecGetArrayWrite(h, &array));
  PetscCall(Read(source, grid, array));
  PetscCall(CheckValues(source, grid, array));
  PetscCall(VecRestoreArrayWrite(h, &array));
  if (factor != 1) PetscCall(VecScale(h, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFieldFileRead(const SamFieldFile *source, SamGrid grid, Vec h)
{
  const ErrorOutput output = Silence();
  PetscErrorCode    ierr;

  PetscFunctionBegin;
  ierr = CheckAndRead(source, grid, h);
  Unsilence(output);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

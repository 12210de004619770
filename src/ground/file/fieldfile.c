/*
  Fields read from HDF5 datasets of shape (ny, nx).

  A file may be wrong in many ways. Rank 0 examines it, so that all ranks raise the same error. All ranks read their
  rows only after that.
*/
#include "fileimpl.h"
#include <petsam/private/fieldfile.h>
#include <petsam/private/base.h>
#include <petsam/private/grid.h>
#include <math.h>
#include <stdlib.h>

/* A surface is stretched to the grid without a message up to this part of its size: no instrument is calibrated
   better. */
static const double size_tolerance = 1e-3;

/* A source, and the name of its first option with the prefix; `grid`: NULL if the grid follows from the file */
typedef struct {
  const SamFieldFile *source;
  SamGrid             grid;
  char                option[SAM_PREFIX + 32];
} Wanted;

/*
  Attributes of the file: the dataset's shape, the factor for its values, the surface's size and centre (0: unknown)
*/
typedef struct {
  hsize_t shape[2];
  double  factor, size[2], center[2];
} Answer;

PetscErrorCode SamFieldFileSetFromOptions(SamFieldFile *source, const SamOptions *from, const char help[])
{
  char text[96];

  const SamOptionRow rows[] = {{source->file_option, help, SAM_OPTION_FILE, offsetof(SamFieldFile, file),
                                .size = sizeof(source->file)},
                               {source->dataset_option, text, SAM_OPTION_STRING, offsetof(SamFieldFile, dataset),
                                .size = sizeof(source->dataset), .needs = source->file_option}};

  PetscFunctionBegin;
  PetscCall(SamSetPrefix(source->prefix, SamOptionsPrefix(from)));
  if (!source->dataset[0]) PetscCall(PetscStrncpy(source->dataset, source->default_dataset, sizeof(source->dataset)));
  PetscCall(PetscSNPrintf(text, sizeof(text), "dataset in it: (ny, nx), %s", source->unit));
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(rows), source, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- examination, by one rank ---- */

static PetscErrorCode CheckShape(SamFile f, const Wanted *w, hid_t space, hsize_t shape[2])
{
  const int     rank  = H5Sget_simple_extent_ndims(space);
  const hsize_t least = w->grid ? 1 : 2, row = w->grid ? 0 : w->source->row;

  PetscFunctionBegin;
  SamFileCheck(f, rank == 2 && H5Sget_simple_extent_dims(space, shape, NULL) == 2,
               "%s has %d dimension(s), expected shape (ny, nx), rows are y", w->source->dataset, rank);
  SamFileCheck(f, shape[0] + row >= least && shape[1] >= least,
               "%s has shape (%lld, %lld), expected %d or more of each", w->source->dataset, (long long)shape[0],
               (long long)shape[1], (int)least);
  if (w->grid) {
    const long long ny = w->grid->ny, nx = w->grid->nx;

    SamFileCheck(f, shape[0] == (hsize_t)ny && shape[1] == (hsize_t)nx,
                 "%s has shape (%lld, %lld), expected (ny, nx) = (%lld, %lld), rows are y: %s -grid_n %lld,%lld",
                 w->source->dataset, (long long)shape[0], (long long)shape[1], ny, nx,
                 shape[0] == (hsize_t)nx && shape[1] == (hsize_t)ny ? "transpose it, or give" : "it fits",
                 (long long)shape[1], (long long)shape[0]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Determines the unit and sign of the numbers, and checks that the surface is as large as the grid. */
static PetscErrorCode CheckLengths(SamFile f, const Wanted *w, hid_t dataset, Answer *answer)
{
  const SamGrid grid = w->grid;
  SamLengths    lengths;
  double *const size = lengths.size;
  PetscBool     fits = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamLengthsRead(f, dataset, w->source->dataset, answer->shape, &lengths));
  for (int d = 0; d < 2; d++) {
    answer->size[d]   = size[d];
    answer->center[d] = lengths.center[d];
  }
  answer->factor = lengths.factor;
  if (!grid) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < grid->axes; d++) {
    if (!(size[d] > 0)) size[d] = grid->width[d]; /* the size along one axis may be missing */
    fits = fits && fabs(size[d] - grid->width[d]) <= size_tolerance * grid->width[d];
  }
  SamFileCheck(f, fits,
               "%s is a surface of %.10g m x %.10g m by its x and y or its size, but the grid is %.10g m x "
               "%.10g m: give -grid_size %.10g,%.10g, or cut the surface by petsam-surface",
               w->source->dataset, size[0], size[1], (double)grid->width[0], (double)grid->width[1], size[0], size[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the names of datasets in the file's root, and of groups followed by a slash, as far as they fit. */
static void ListNames(hid_t file, char list[], size_t size)
{
  H5G_info_t info;
  size_t     used = 0;

  (void)snprintf(list, size, "none");
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
}

/* Raises an error for an unsuitable file; otherwise answers the question. */
static PetscErrorCode Look(SamFile f, const void *question, void *answer)
{
  const Wanted *const w       = (const Wanted *)question;
  const char *const   name    = w->source->dataset;
  const hid_t         dataset = H5Dopen2(f->id, name, H5P_DEFAULT);
  Answer *const       found   = (Answer *)answer;
  char                names[160];
  hid_t               type, space;
  H5T_class_t         kind;
  PetscErrorCode      ierr;

  PetscFunctionBegin;
  found->factor = 1;
  if (dataset < 0) ListNames(f->id, names, sizeof(names));
  SamFileCheck(f, dataset >= 0, "has no dataset %.160s (-%s%s); it has %s", name, w->source->prefix,
               w->source->dataset_option, names);
  type  = H5Dget_type(dataset);
  space = H5Dget_space(dataset);
  kind  = H5Tget_class(type);
  (void)H5Tclose(type);
  SamFileCheck(f, kind == H5T_FLOAT || kind == H5T_INTEGER, "%s holds neither real numbers nor integers", name);
  ierr = CheckShape(f, w, space, found->shape);
  (void)H5Sclose(space);
  PetscCall(ierr);
  SamFileCheck(f, SamFileIsWhole(f, dataset, NULL, PETSC_FALSE), "%s cannot be read: the file is damaged", name);
  if (w->source->is_length) PetscCall(CheckLengths(f, w, dataset, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading ---- */

/* Reads this rank's rows independently of other ranks: reading may fail on some ranks. */
static PetscErrorCode Read(const Wanted *w, double array[])
{
  const SamGrid  grid  = w->grid;
  const SamBlock block = {2, {(hsize_t)grid->row_start, 0}, {(hsize_t)grid->rows, (hsize_t)grid->nx}};
  SamFile        f;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamFileOpen(grid, SAM_EVENT_OUTPUT, w->option, w->source->file, SAM_FILE_READ, NULL, &f));
  PetscCall(SamFileBegin(f));
  SamFileReadBlock(f, SamFileNote(f, H5Dopen2(f->id, w->source->dataset, H5P_DEFAULT)), H5T_NATIVE_DOUBLE, &block,
                   array);
  ierr = SamFileEnd(f);
  (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Raises an error for the first value, in the file's order, that is not finite, or else is below `least`. */
static PetscErrorCode CheckValues(const Wanted *w, const double array[])
{
  const SamFieldFile *source = w->source;
  const SamGrid       grid   = w->grid;
  const long long     none   = (long long)grid->nx * grid->ny;
  long long           bad[2] = {none, none};

  PetscFunctionBegin;
  for (PetscInt k = grid->cells - 1; k >= 0; k--) {
    const long long cell = (long long)grid->row_start * grid->nx + k;

    if (!isfinite(array[k]))
      bad[0] = cell;
    else if (array[k] < source->least)
      bad[1] = cell;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bad, 2, MPI_LONG_LONG, MPI_MIN, grid->comm));
  PetscCheck(bad[0] == none, grid->comm, SAM_ERR_FILE, "-%s %s: %s[%lld, %lld] is not a finite number", w->option,
             source->file, source->dataset, bad[0] / grid->nx, bad[0] % grid->nx);
  PetscCheck(bad[1] == none, grid->comm, SAM_ERR_FILE, "-%s %s: %s[%lld, %lld] is less than %.6g", w->option,
             source->file, source->dataset, bad[1] / grid->nx, bad[1] % grid->nx, (double)source->least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Examine(Wanted *w, MPI_Comm comm, Answer *answer)
{
  char              axes[2][PETSC_MAX_PATH_LEN];
  const char *const objects[SAM_FILE_OBJECTS + 1] = {w->source->dataset, axes[0], axes[1]};

  PetscFunctionBegin;
  for (int d = 0; d < 2; d++) SamLengthsNameAxis(w->source->dataset, "xy"[d], axes[d]);
  PetscCall(PetscMemzero(answer, sizeof(*answer)));
  PetscCall(PetscSNPrintf(w->option, sizeof(w->option), "%s%s", w->source->prefix, w->source->file_option));
  PetscCall(SamFileExamine(comm, w->option, w->source->file, objects, Look, w, answer, sizeof(*answer)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFieldFileRead(const SamFieldFile *source, SamGrid grid, Vec h)
{
  Wanted       w = {.source = source, .grid = grid};
  Answer       answer;
  PetscScalar *array;

  PetscFunctionBegin;
  PetscCall(Examine(&w, grid->comm, &answer));
  PetscCall(VecGetArrayWrite(h, &array));
  PetscCall(Read(&w, array));
  PetscCall(CheckValues(&w, array));
  PetscCall(VecRestoreArrayWrite(h, &array));
  if (answer.factor != 1) PetscCall(VecScale(h, answer.factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFieldFileCreate(const SamFieldFile *source, SamGrid grid, Vec *field)
{
  PetscErrorCode ierr;
  SamTransfer    transfer;
  Vec            fine = NULL;

  PetscFunctionBegin;
  *field = NULL;
  if (!source->file[0] || SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  if (grid->fine) PetscCall(SamFieldFileCreate(source, grid->fine, &fine));
  PetscCall(SamGridCreateVec(grid, 1, field));
  if (fine) {
    PetscCall(SamTransferCreate(grid->fine, grid, &transfer));
    PetscCall(SamTransferRestrict(transfer, fine, *field));
    PetscCall(SamTransferDestroy(&transfer));
    PetscCall(VecDestroy(&fine));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ierr = SamFieldFileRead(source, grid, *field);
  if (ierr) PetscCall(VecDestroy(field));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rounds the last digits of sizes that come from coordinates, so that they equal the same sizes given as options. */
static double RoundOff(double x)
{
  char text[32];

  (void)snprintf(text, sizeof(text), "%.12g", x);
  return strtod(text, NULL);
}

PetscErrorCode SamFieldFileGetGrid(const SamFieldFile *source, MPI_Comm comm, PetscInt n[2], PetscReal width[2],
                                   PetscReal center[2])
{
  Wanted w = {.source = source};
  Answer answer;

  PetscFunctionBegin;
  PetscCall(Examine(&w, comm, &answer));
  for (int d = 0; d < 2; d++) {
    n[d]      = (PetscInt)PetscMin(answer.shape[1 - d], (hsize_t)PETSC_MAX_INT);
    width[d]  = RoundOff(answer.size[d]);
    center[d] = fabs(answer.center[d]) > 1e-12 * width[d] ? RoundOff(answer.center[d]) : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

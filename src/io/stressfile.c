/*
  Files of stresses: datasets of shape (time, z, y, x), all of them created at once and filled part by part.

  The file is written beside its name and renamed when it is complete.
*/
#include "ioimpl.h"
#include <petsam/private/quantities.h>
#include <petsam/stressfile.h>

#define OPTION "output"

enum { DIMENSIONS = 4, TIME = 0, Z, Y, X };

struct _n_SamStressFile {
  SamGrid   grid;
  char     *filename, *temporary;
  SamHold   hold; /* of the temporary file */
  SamFile   f;
  PetscBool section;
  hsize_t   shape[DIMENSIONS];
  hid_t     dataset[SAM_DATASETS], history, history_time;
  double   *coordinate[DIMENSIONS];
  PetscBool wants[SAM_QUANTITIES];
  PetscBool broken; /* a write has failed: no collective call on the file may follow */
};

/* The first dimension of a dataset: those of all steps together have no time. */
static int FirstDimension(PetscInt k)
{
  return SamQuantityIsOfCycle(SamDatasets[k].quantity) ? Z : TIME;
}

/* ---- creation ---- */

/* The shape of a dataset that has the file's dimensions from `first` on. */
static SamShape ShapeOf(SamStressFile s, int first, int rank)
{
  SamShape shape = {.rank = rank};

  for (int d = 0; d < rank; d++) shape.size[d] = shape.largest[d] = s->shape[first + d];
  return shape;
}

/* The coordinates of all four dimensions; a section has one y or one x. */
static PetscErrorCode SetCoordinates(SamStressFile s, const SamStressLayout *layout)
{
  const SamGrid g = s->grid;

  PetscFunctionBegin;
  s->shape[TIME] = (hsize_t)layout->steps;
  s->shape[Z]    = (hsize_t)layout->depths;
  s->shape[Y]    = layout->section && layout->axis == SAM_SECTION_X ? 1 : (hsize_t)g->ny;
  s->shape[X]    = layout->section && layout->axis == SAM_SECTION_Y ? 1 : (hsize_t)g->nx;
  for (int d = 0; d < DIMENSIONS; d++) PetscCall(PetscMalloc1(s->shape[d], &s->coordinate[d]));
  for (hsize_t k = 0; k < s->shape[TIME]; k++) s->coordinate[TIME][k] = (double)layout->times[k];
  for (hsize_t k = 0; k < s->shape[Z]; k++) s->coordinate[Z][k] = (double)layout->depth[k];
  for (hsize_t k = 0; k < s->shape[Y]; k++)
    s->coordinate[Y][k] = (double)SamGridY(g, s->shape[Y] == 1 ? layout->index : (PetscInt)k);
  for (hsize_t k = 0; k < s->shape[X]; k++)
    s->coordinate[X][k] = (double)SamGridX(g, s->shape[X] == 1 ? layout->index : (PetscInt)k);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamLabel    coordinate_labels[DIMENSIONS] = {{"time", "s", "time of the load steps"},
                                                          {"z", "m", "depth below the surface"},
                                                          {"y", "m", "y of the cell centres"},
                                                          {"x", "m", "x of the cell centres"}};
static const char *const axes[DIMENSIONS]              = {"T", "Z", "Y", "X"};

/* The spacing of coordinates, which VTK needs; 0 where they are unequal. A single one has that of the grid. */
static double Spacing(SamStressFile s, int d)
{
  const hsize_t       n = s->shape[d];
  const double *const x = s->coordinate[d], step = n > 1 ? (x[n - 1] - x[0]) / (double)(n - 1) : s->grid->dx;

  for (hsize_t k = 0; k < n; k++)
    if (!(fabs(x[k] - x[0] - (double)k * step) <= 1e-9 * fabs(x[n - 1] - x[0]))) return 0;
  return step;
}

/*
  For VTK the stresses of all steps are at points, or those of the cycle if there are no others. VTK counts a dimension
  of one point as none, so a section is a sheet of cells.
*/
static void CreateVTK(SamStressFile s)
{
  SamImage image = {.steps = (int64_t)s->shape[TIME], .time = s->coordinate[TIME][0]};

  for (int d = 0; d < 3; d++) {
    image.n[d]       = s->shape[X - d];
    image.cells      = image.cells || image.n[d] == 1;
    image.spacing[d] = Spacing(s, X - d);
    if (!(image.spacing[d] > 0)) return;
  }
  for (int d = 0; d < 3; d++) image.origin[d] = s->coordinate[X - d][0] - (image.cells ? 0.5 * image.spacing[d] : 0);
  for (int first = TIME; first <= Z && !image.count; first++) {
    if (first == Z) image.steps = -1;
    for (PetscInt k = 0; k < SAM_DATASETS; k++)
      if (s->wants[SamDatasets[k].quantity] && FirstDimension(k) == first)
        image.names[image.count++] = SamDatasets[k].label.name;
  }
  (void)SamFileCreateVTK(s->f, &image);
}

static void CreateAll(SamStressFile s, const SamParameters *parameters)
{
  SamShape shape;
  hid_t    scale[DIMENSIONS];

  SamFileWriteOrigin(s->f, "Stresses under a partial-slip contact", "petsam-stress");
  SamParametersWrite(s->f, parameters);
  for (int d = 0; d < DIMENSIONS; d++) {
    shape    = ShapeOf(s, d, 1);
    scale[d] = SamFileCreateScale(s->f, s->f->id, &coordinate_labels[d], axes[d], NULL, &shape, s->coordinate[d]);
  }
  for (PetscInt k = 0; k < SAM_DATASETS; k++) {
    const int first = FirstDimension(k);

    if (!s->wants[SamDatasets[k].quantity]) continue;
    shape         = ShapeOf(s, first, DIMENSIONS - first);
    s->dataset[k] = SamFileCreateDataset(s->f, s->f->id, &SamDatasets[k].label, H5T_IEEE_F64LE, &shape, 0);
    SamFileAttachScales(s->f, s->dataset[k], shape.rank, scale + first);
  }
  CreateVTK(s);
  shape      = ShapeOf(s, TIME, 1);
  s->history = SamFileNote(s->f, H5Gcreate2(s->f->id, "history", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  s->history_time =
    SamFileCreateScale(s->f, s->history, &coordinate_labels[TIME], NULL, NULL, &shape, s->coordinate[TIME]);
}

/* The size of all datasets, bytes. */
static off_t Bytes(SamStressFile s)
{
  off_t bytes = 0;

  for (PetscInt k = 0; k < SAM_DATASETS; k++) {
    off_t size = s->wants[SamDatasets[k].quantity] ? (off_t)sizeof(double) : 0;

    for (int d = FirstDimension(k); d < DIMENSIONS; d++) size *= (off_t)s->shape[d];
    bytes += size;
  }
  return bytes;
}

PetscErrorCode SamStressFileCreate(SamGrid grid, const char filename[], const SamStressLayout *layout,
                                   const SamParameters *parameters, SamStressFile *file)
{
  SamStressFile s;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&s));
  *file        = s;
  s->hold.file = -1;
  PetscCall(SamGridReference(grid));
  s->grid    = grid;
  s->section = layout->section;
  PetscCall(PetscArraycpy(s->wants, layout->wants, SAM_QUANTITIES));
  PetscCall(PetscStrallocpy(filename, &s->filename));
  PetscCall(SamOutputNameTemporary(filename, &s->temporary));
  PetscCall(SetCoordinates(s, layout));
  PetscCall(SamFileCheckName(grid, OPTION, filename, SAM_FILE_RESULTS));
  PetscCall(SamHoldTake(grid, OPTION, s->temporary, SAM_FILE_TEMPORARY, &s->hold));
  PetscCall(SamFileOpen(grid, SAM_EVENT_OUTPUT, OPTION, s->temporary, SAM_FILE_CREATE, &s->f));
  PetscCall(SamFileReserve(s->f, Bytes(s)));
  PetscCall(SamFileBegin(s->f));
  CreateAll(s, parameters);
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- values ---- */

PetscErrorCode SamStressFileWrite(SamStressFile s, SamQuantity quantity, PetscInt component, PetscInt step,
                                  PetscInt depth, PetscInt depths, const double values[])
{
  const PetscInt k       = SamDatasetOf(quantity) + component;
  const int      first   = FirstDimension(k);
  const hsize_t  row     = s->section ? 0 : (hsize_t)s->grid->row_start;
  const hsize_t  start[] = {(hsize_t)step, (hsize_t)depth, row, 0},
                count[]  = {1, (hsize_t)depths, s->section ? s->shape[Y] : (hsize_t)s->grid->rows, s->shape[X]};
  SamBlock       block   = {.rank = DIMENSIONS - first};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(block.start, start + first, block.rank));
  PetscCall(PetscArraycpy(block.count, count + first, block.rank));
  PetscCall(SamFileBegin(s->f));
  SamFileWriteBlock(s->f, s->dataset[k], H5T_NATIVE_DOUBLE, &block, values);
  ierr = SamFileEnd(s->f);
  if (ierr) s->broken = PETSC_TRUE;
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressFileSetLargest(SamStressFile s, SamQuantity quantity, double value, const double place[3])
{
  const hid_t dataset = s->dataset[SamDatasetOf(quantity)];

  PetscFunctionBegin;
  PetscCall(SamFileBegin(s->f));
  SamFileWriteAttribute(s->f, dataset, "largest", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &value);
  SamFileWriteAttribute(s->f, dataset, "largest_at", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, place);
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressFileSetText(SamStressFile s, const char name[], const char text[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(s->f));
  SamFileWriteTextAttribute(s->f, s->f->id, name, text);
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressFileSetHistory(SamStressFile s, const char name[], const char units[], const char long_name[],
                                       const double values[])
{
  const SamLabel label = {name, units, long_name};
  const SamShape shape = ShapeOf(s, TIME, 1);
  const SamBlock block = {1, {0}, {s->f->rank ? 0 : s->shape[TIME]}};
  hid_t          dataset;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(s->f));
  dataset = SamFileCreateDataset(s->f, s->history, &label, H5T_IEEE_F64LE, &shape, 0);
  SamFileAttachScales(s->f, dataset, 1, &s->history_time);
  SamFileWriteBlock(s->f, dataset, H5T_NATIVE_DOUBLE, &block, values);
  (void)SamFileNote(s->f, H5Dclose(dataset));
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the end ---- */

PetscErrorCode SamStressFileFinish(SamStressFile s)
{
  PetscFunctionBegin;
  PetscCall(SamFileDestroy(&s->f, PETSC_TRUE));
  PetscCall(SamFileReplace(s->grid, OPTION, s->temporary, s->filename, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamStressFileAbandon(SamStressFile s)
{
  if (s) SamHoldRelease(s->temporary, &s->hold);
}

PetscErrorCode SamStressFileDestroy(SamStressFile *file)
{
  SamStressFile s = *file;

  PetscFunctionBegin;
  *file = NULL;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFileDestroy(&s->f, s->broken ? PETSC_FALSE : PETSC_TRUE));
  SamHoldRelease(s->temporary, &s->hold);
  for (int d = 0; d < DIMENSIONS; d++) PetscCall(PetscFree(s->coordinate[d]));
  PetscCall(PetscFree(s->filename));
  PetscCall(PetscFree(s->temporary));
  PetscCall(SamGridDestroy(&s->grid));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

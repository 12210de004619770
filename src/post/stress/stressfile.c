/*
  Files of stresses: datasets of shape (time, z, y, x), which are all created at the beginning and filled part by part.

  The file is written under a temporary name and renamed when it is complete.
*/
#include <petsam/private/evaluation.h>
#include <petsam/private/file.h>
#include <petsam/private/grid.h>

#define OPTION "output"

enum { AXES = SAM_STRESS_AXES };

struct _n_SamStressFile {
  SamGrid         grid;
  char           *filename, *temporary;
  SamFileLock     hold; /* lock of the temporary file */
  SamFile         f;
  SamStressLayout layout;
  hid_t           dataset[SAM_STRESS_DATASETS], history, history_time;
  PetscBool       broken; /* a write has failed: no collective call on the file may follow */
};

/* Returns the first dimension of a dataset: datasets for all steps together have no time. */
static int FirstAxis(SamStressFile s, PetscInt k)
{
  return s->layout.dataset[k].of_cycle ? SAM_Z : SAM_TIME;
}

/* ---- creation ---- */

/* Returns the shape of a dataset with the file's dimensions from `first` on. */
static SamShape ShapeOf(SamStressFile s, int first, int rank)
{
  SamShape shape = {.rank = rank};

  for (int d = 0; d < rank; d++) shape.size[d] = shape.largest[d] = (hsize_t)s->layout.n[first + d];
  return shape;
}

static const SamLabel    coordinate_labels[AXES] = {{"time", "s", "time of the load steps"},
                                                    {"z", "m", "depth below the surface"},
                                                    {"y", "m", "y of the cell centres"},
                                                    {"x", "m", "x of the cell centres"}};
static const char *const own_points[AXES] = {[SAM_Y] = "y of the body's own points, under the cells before it moves",
                                             [SAM_X] = "x of the body's own points, under the cells before it moves"};
static const char *const axes[AXES]       = {"T", "Z", "Y", "X"};

/* Returns the spacing of coordinates for VTK; 0 if they are unequal. A single coordinate has the spacing of the
   grid. */
static double Spacing(SamStressFile s, int d)
{
  const PetscInt      n = s->layout.n[d];
  const double *const x = s->layout.coordinate[d], step = n > 1 ? (x[n - 1] - x[0]) / (double)(n - 1) : s->grid->dx;

  for (PetscInt k = 0; k < n; k++)
    if (!(fabs(x[k] - x[0] - (double)k * step) <= 1e-9 * fabs(x[n - 1] - x[0]))) return 0;
  return step;
}

/*
  Describes for VTK the stresses of all steps, or those of the cycle if there are no others, as values at points. VTK
  ignores a dimension of one point, so a section is described as a sheet of cells.
*/
static void CreateVTK(SamStressFile s)
{
  SamImage image = {.steps = (int64_t)s->layout.n[SAM_TIME], .time = s->layout.coordinate[SAM_TIME][0]};

  for (int d = 0; d < 3; d++) {
    image.n[d]       = (hsize_t)s->layout.n[SAM_X - d];
    image.cells      = image.cells || image.n[d] == 1;
    image.spacing[d] = Spacing(s, SAM_X - d);
    if (!(image.spacing[d] > 0)) return;
  }
  for (int d = 0; d < 3; d++)
    image.origin[d] = s->layout.coordinate[SAM_X - d][0] - (image.cells ? 0.5 * image.spacing[d] : 0);
  for (int first = SAM_TIME; first <= SAM_Z && !image.count; first++) {
    if (first == SAM_Z) image.steps = -1;
    for (PetscInt k = 0; k < s->layout.datasets; k++)
      if (FirstAxis(s, k) == first) image.names[image.count++] = s->layout.dataset[k].name;
  }
  (void)SamFileCreateVTK(s->f, &image);
}

static void CreateAll(SamStressFile s, const SamParameters *parameters)
{
  SamShape shape;
  hid_t    scale[AXES];

  SamFileWriteOrigin(s->f, "Stresses under a partial-slip contact", "petsam-stress");
  SamParametersWrite(s->f, parameters);
  for (int d = 0; d < AXES; d++) {
    SamLabel label = coordinate_labels[d];

    if (s->layout.own && own_points[d]) label.long_name = own_points[d];
    shape    = ShapeOf(s, d, 1);
    scale[d] = SamFileCreateScale(s->f, s->f->id, &label, axes[d], NULL, &shape, s->layout.coordinate[d]);
  }
  for (PetscInt k = 0; k < s->layout.datasets; k++) {
    const SamStressDataset *of    = &s->layout.dataset[k];
    const SamLabel          label = {of->name, of->unit, of->text};
    const int               first = FirstAxis(s, k);

    shape         = ShapeOf(s, first, AXES - first);
    s->dataset[k] = SamFileCreateDataset(s->f, s->f->id, &label, H5T_IEEE_F64LE, &shape, 0);
    SamFileAttachScales(s->f, s->dataset[k], shape.rank, scale + first);
  }
  CreateVTK(s);
  shape           = ShapeOf(s, SAM_TIME, 1);
  s->history      = SamFileNote(s->f, H5Gcreate2(s->f->id, "history", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  s->history_time = SamFileCreateScale(s->f, s->history, &coordinate_labels[SAM_TIME], NULL, NULL, &shape,
                                       s->layout.coordinate[SAM_TIME]);
}

/* Returns the size of all datasets, bytes. */
static off_t Bytes(SamStressFile s)
{
  off_t bytes = 0;

  for (PetscInt k = 0; k < s->layout.datasets; k++) {
    off_t size = (off_t)sizeof(double);

    for (int d = FirstAxis(s, k); d < AXES; d++) size *= (off_t)s->layout.n[d];
    bytes += size;
  }
  return bytes;
}

PetscErrorCode SamStressFileCreate(SamGrid grid, const char filename[], const SamStressLayout *layout,
                                   const SamParameters *parameters, SamStressFile *file)
{
  SamStressFile s;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(PetscNew(&s));
  *file        = s;
  s->hold.file = -1;
  PetscCall(SamGridReference(grid));
  s->grid   = grid;
  s->layout = *layout;
  PetscCall(PetscStrallocpy(filename, &s->filename));
  PetscCall(SamFileNameTemporary(filename, &s->temporary));
  PetscCall(SamFileCheckName(grid, OPTION, filename, SAM_FILE_RESULTS));
  PetscCall(SamFileLockTake(grid, OPTION, s->temporary, SAM_FILE_TEMPORARY, &s->hold));
  PetscCall(SamFileOpen(grid, SAM_EVENT_OUTPUT, OPTION, s->temporary, SAM_FILE_CREATE, NULL, &s->f));
  PetscCall(SamFileReserve(s->f, Bytes(s)));
  PetscCall(SamFileBegin(s->f));
  CreateAll(s, parameters);
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- values ---- */

PetscErrorCode SamStressFileWrite(void *file, PetscInt dataset, const PetscInt start[SAM_STRESS_AXES],
                                  const PetscInt count[SAM_STRESS_AXES], const double values[])
{
  const SamStressFile s     = (SamStressFile)file;
  const int           first = FirstAxis(s, dataset);
  SamBlock            block = {.rank = AXES - first};
  PetscErrorCode      ierr;

  PetscFunctionBegin;
  for (int d = first; d < AXES; d++) {
    block.start[d - first] = (hsize_t)start[d];
    block.count[d - first] = (hsize_t)count[d];
  }
  PetscCall(SamFileBegin(s->f));
  SamFileWriteBlock(s->f, s->dataset[dataset], H5T_NATIVE_DOUBLE, &block, values);
  ierr = SamFileEnd(s->f);
  if (ierr) s->broken = PETSC_TRUE;
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the largest value of a cycle as attributes of its dataset. */
static PetscErrorCode WriteLargestOfCycle(SamStressFile s, const SamLargestSeries *of)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  while (strcmp(s->layout.dataset[k].name, of->name)) k++;
  PetscCall(SamFileBegin(s->f));
  SamFileWriteAttribute(s->f, s->dataset[k], "largest", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &of->step->value);
  SamFileWriteAttribute(s->f, s->dataset[k], "largest_at", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, of->step->place);
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressFileWriteLargest(SamStressFile s, const SamLargestSeries *of)
{
  static const char *const endings[] = {"max", "max_x", "max_y", "max_z"};
  double                  *values;

  PetscFunctionBegin;
  if (of->of_cycle) {
    PetscCall(WriteLargestOfCycle(s, of));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(of->count, &values));
  for (int k = 0; k <= of->places; k++) {
    char dataset[64], text[128], coordinate[16] = "";

    for (PetscInt n = 0; n < of->count; n++) values[n] = k ? of->step[n].place[k - 1] : of->step[n].value;
    if (k) PetscCall(PetscSNPrintf(coordinate, sizeof(coordinate), "%c of the ", "xyz"[k - 1]));
    PetscCall(PetscSNPrintf(dataset, sizeof(dataset), "%s_%s", of->name, endings[k]));
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s", coordinate, of->text));
    PetscCall(SamStressFileSetHistory(s, dataset, k ? "m" : of->unit, text, values));
  }
  PetscCall(PetscFree(values));
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
  const SamShape shape = ShapeOf(s, SAM_TIME, 1);
  const SamBlock block = {1, {0}, {s->f->rank ? 0 : shape.size[0]}};
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
  if (s) SamFileLockRelease(s->temporary, &s->hold);
}

PetscErrorCode SamStressFileDestroy(SamStressFile *file)
{
  SamStressFile s = *file;

  PetscFunctionBegin;
  *file = NULL;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFileDestroy(&s->f, s->broken ? PETSC_FALSE : PETSC_TRUE));
  SamFileLockRelease(s->temporary, &s->hold);
  PetscCall(PetscFree(s->filename));
  PetscCall(PetscFree(s->temporary));
  PetscCall(SamGridDestroy(&s->grid));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

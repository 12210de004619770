/*
  Files of stresses: datasets of shape (time, z, y, x), all of them created at once and filled part by part.

  The file is written beside its name and renamed when it is complete. The XDMF file is small and written at the end.
*/
#include "ioimpl.h"
#include <errno.h>
#include <hdf5_hl.h>
#include <petsam/stressfile.h>
#include <stdio.h>
#include <string.h>

#define OPTION "output"

enum { DIMENSIONS = 4, TIME = 0, Z, Y, X };

typedef struct {
  SamOutputLabel label;
  SamQuantity    quantity;
} Dataset;

/* The normal of the plane on which a parameter is largest. */
#define NORMAL(name, quantity) \
  {{name "_normal_x", "1", "normal of the critical plane, x"}, quantity}, \
    {{name "_normal_y", "1", "normal of the critical plane, y"}, quantity}, \
  { \
    {name "_normal_z", "1", "normal of the critical plane, z"}, quantity \
  }

static const Dataset datasets[] = {
  {{"stress_xx", "Pa", "stress xx, tension positive"}, SAM_QUANTITY_STRESS},
  {{"stress_yy", "Pa", "stress yy"}, SAM_QUANTITY_STRESS},
  {{"stress_zz", "Pa", "stress zz, z points into the body"}, SAM_QUANTITY_STRESS},
  {{"stress_xy", "Pa", "stress xy"}, SAM_QUANTITY_STRESS},
  {{"stress_xz", "Pa", "stress xz"}, SAM_QUANTITY_STRESS},
  {{"stress_yz", "Pa", "stress yz"}, SAM_QUANTITY_STRESS},
  {{"mises", "Pa", "von Mises stress"}, SAM_QUANTITY_MISES},
  {{"principal_1", "Pa", "largest principal stress"}, SAM_QUANTITY_PRINCIPAL},
  {{"principal_2", "Pa", "middle principal stress"}, SAM_QUANTITY_PRINCIPAL},
  {{"principal_3", "Pa", "smallest principal stress"}, SAM_QUANTITY_PRINCIPAL},
  {{"shear_max", "Pa", "largest shear stress"}, SAM_QUANTITY_SHEAR_MAX},
  {{"strain_xx", "1", "strain xx"}, SAM_QUANTITY_STRAIN},
  {{"strain_yy", "1", "strain yy"}, SAM_QUANTITY_STRAIN},
  {{"strain_zz", "1", "strain zz"}, SAM_QUANTITY_STRAIN},
  {{"strain_xy", "1", "strain xy, tensor shear strain"}, SAM_QUANTITY_STRAIN},
  {{"strain_xz", "1", "strain xz, tensor shear strain"}, SAM_QUANTITY_STRAIN},
  {{"strain_yz", "1", "strain yz, tensor shear strain"}, SAM_QUANTITY_STRAIN},
  {{"crossland", "Pa", "Crossland's parameter of the cycle"}, SAM_QUANTITY_CROSSLAND},
  {{"dang_van", "Pa", "Dang Van's parameter of the cycle"}, SAM_QUANTITY_DANG_VAN},
  {{"findley", "Pa", "Findley's parameter of the cycle"}, SAM_QUANTITY_FINDLEY},
  NORMAL("findley", SAM_QUANTITY_FINDLEY),
  {{"swt", "Pa", "parameter of Smith, Watson and Topper of the cycle"}, SAM_QUANTITY_SWT},
  NORMAL("swt", SAM_QUANTITY_SWT),
  {{"fatemi_socie", "1", "parameter of Fatemi and Socie of the cycle"}, SAM_QUANTITY_FATEMI_SOCIE},
  NORMAL("fatemi_socie", SAM_QUANTITY_FATEMI_SOCIE),
  {{"ruiz_1", "J/m2", "Ruiz's first parameter of the cycle: work of friction"}, SAM_QUANTITY_RUIZ},
  {{"ruiz_2", "Pa J/m2", "Ruiz's second parameter of the cycle: tension times work of friction"}, SAM_QUANTITY_RUIZ},
};
enum { DATASETS = sizeof(datasets) / sizeof(datasets[0]) };

struct _n_SamStressFile {
  SamGrid   grid;
  char     *filename, *temporary;
  SamHold   hold; /* of the temporary file */
  SamFile   f;
  PetscBool section;
  hsize_t   shape[DIMENSIONS];
  hid_t     dataset[DATASETS], scale[DIMENSIONS], history, history_time;
  double   *coordinate[DIMENSIONS];
  PetscBool wants[SAM_QUANTITIES];
  PetscBool broken; /* a write has failed: no collective call on the file may follow */
};

PetscInt SamQuantityComponents(SamQuantity quantity)
{
  PetscInt count = 0;

  for (PetscInt d = 0; d < DATASETS; d++) count += datasets[d].quantity == quantity;
  return count;
}

/* The first dimension of a dataset: those of all steps together have no time. */
static int FirstDimension(PetscInt k)
{
  return datasets[k].quantity >= SAM_QUANTITY_CROSSLAND ? Z : TIME;
}

/* ---- creation ---- */

/* A dataset of numbers, of `rank` of the file's dimensions from `first` on. */
static hid_t CreateDataset(SamStressFile s, hid_t where, const SamOutputLabel *label, int first, int rank)
{
  SamShape shape = {.rank = rank};

  for (int d = 0; d < rank; d++) shape.size[d] = shape.largest[d] = s->shape[first + d];
  return SamFileCreateDataset(s->f, where, label, H5T_IEEE_F64LE, &shape, 0);
}

static const SamOutputLabel coordinate_labels[DIMENSIONS] = {{"time", "s", "time of the load steps"},
                                                             {"z", "m", "depth below the surface"},
                                                             {"y", "m", "y of the cell centres"},
                                                             {"x", "m", "x of the cell centres"}};
static const char *const    axes[DIMENSIONS]              = {"T", "Z", "Y", "X"};

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

static void CreateAll(SamStressFile s, const SamParameters *parameters)
{
  int first;

  SamFileWriteTextAttribute(s->f, s->f->id, "Conventions", "CF-1.8");
  SamFileWriteTextAttribute(s->f, s->f->id, "title", "Stresses under a partial-slip contact");
  SamFileWriteTextAttribute(s->f, s->f->id, "source", "petsam-stress " PETSAM_VERSION ", semi-analytical method");
  SamFileWriteTextAttribute(s->f, s->f->id, "petsam_version", PETSAM_VERSION);
  SamParametersWrite(s->f, parameters);
  for (int d = 0; d < DIMENSIONS; d++) {
    s->scale[d] = CreateDataset(s, s->f->id, &coordinate_labels[d], d, 1);
    SamFileWriteTextAttribute(s->f, s->scale[d], "axis", axes[d]);
    (void)SamFileNote(s->f, H5DSset_scale(s->scale[d], coordinate_labels[d].name));
    SamFileWriteSeries(s->f, s->scale[d], s->coordinate[d]);
  }
  for (PetscInt k = 0; k < DATASETS; k++) {
    if (!s->wants[datasets[k].quantity]) continue;
    first         = FirstDimension(k);
    s->dataset[k] = CreateDataset(s, s->f->id, &datasets[k].label, first, DIMENSIONS - first);
    for (int d = first; d < DIMENSIONS; d++)
      (void)SamFileNote(s->f, H5DSattach_scale(s->dataset[k], s->scale[d], (unsigned)(d - first)));
  }
  s->history      = SamFileNote(s->f, H5Gcreate2(s->f->id, "history", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  s->history_time = CreateDataset(s, s->history, &coordinate_labels[TIME], TIME, 1);
  (void)SamFileNote(s->f, H5DSset_scale(s->history_time, "time"));
  SamFileWriteSeries(s->f, s->history_time, s->coordinate[TIME]);
}

/* The size of all datasets, bytes. */
static off_t Bytes(SamStressFile s)
{
  off_t bytes = 0;

  for (PetscInt k = 0; k < DATASETS; k++) {
    off_t size = s->wants[datasets[k].quantity] ? (off_t)sizeof(double) : 0;

    for (int d = FirstDimension(k); d < DIMENSIONS; d++) size *= (off_t)s->shape[d];
    bytes += size;
  }
  return bytes;
}

PetscErrorCode SamStressFileCreate(SamGrid grid, const char filename[], const SamStressLayout *layout,
                                   const SamParameters *parameters, SamStressFile *file)
{
  SamStressFile s;
  char         *xdmf;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&s));
  *file        = s;
  s->hold.file = -1;
  s->history = s->history_time = -1;
  for (PetscInt k = 0; k < DATASETS; k++) s->dataset[k] = -1;
  for (int d = 0; d < DIMENSIONS; d++) s->scale[d] = -1;
  PetscCall(SamGridReference(grid));
  s->grid    = grid;
  s->section = layout->section;
  PetscCall(PetscArraycpy(s->wants, layout->wants, SAM_QUANTITIES));
  PetscCall(PetscStrallocpy(filename, &s->filename));
  PetscCall(SamFileNameBeside(filename, ".tmp", &s->temporary));
  PetscCall(SetCoordinates(s, layout));
  PetscCall(SamXdmfMakeName(filename, &xdmf));
  PetscCall(SamFileCheckName(grid, OPTION, filename, SAM_FILE_RESULTS));
  PetscCall(SamFileCheckName(grid, OPTION, xdmf, SAM_FILE_XDMF));
  PetscCall(PetscFree(xdmf));
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
  const hsize_t row     = s->section ? 0 : (hsize_t)s->grid->row_start;
  const hsize_t start[] = {(hsize_t)step, (hsize_t)depth, row, 0},
                count[] = {1, (hsize_t)depths, s->section ? s->shape[Y] : (hsize_t)s->grid->rows, s->shape[X]};
  hsize_t        size   = 1;
  hid_t          space, memory;
  PetscInt       k = component;
  int            first;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  while (datasets[k - component].quantity != quantity) k++;
  first = FirstDimension(k);
  for (int d = 0; d < DIMENSIONS; d++) size *= count[d];
  PetscCall(SamFileBegin(s->f));
  space  = SamFileNote(s->f, H5Dget_space(s->dataset[k]));
  memory = SamFileNote(s->f, H5Screate_simple(1, &size, NULL));
  if (size) {
    (void)SamFileNote(s->f, H5Sselect_hyperslab(space, H5S_SELECT_SET, start + first, NULL, count + first, NULL));
  } else {
    (void)SamFileNote(s->f, H5Sselect_none(space));
    (void)SamFileNote(s->f, H5Sselect_none(memory));
  }
  (void)SamFileNote(s->f, H5Dwrite(s->dataset[k], H5T_NATIVE_DOUBLE, memory, space, s->f->transfer, values));
  (void)SamFileNote(s->f, H5Sclose(memory));
  (void)SamFileNote(s->f, H5Sclose(space));
  ierr = SamFileEnd(s->f);
  if (ierr) s->broken = PETSC_TRUE;
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressFileSetLargest(SamStressFile s, SamQuantity quantity, double value, const double place[3])
{
  PetscInt k = 0;

  PetscFunctionBegin;
  while (datasets[k].quantity != quantity) k++;
  PetscCall(SamFileBegin(s->f));
  SamFileWriteAttribute(s->f, s->dataset[k], "largest", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &value);
  SamFileWriteAttribute(s->f, s->dataset[k], "largest_at", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, place);
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
  const SamOutputLabel label = {name, units, long_name};
  hid_t                dataset;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(s->f));
  dataset = CreateDataset(s, s->history, &label, TIME, 1);
  (void)SamFileNote(s->f, H5DSattach_scale(dataset, s->history_time, 0));
  SamFileWriteSeries(s->f, dataset, values);
  (void)SamFileNote(s->f, H5Dclose(dataset));
  PetscCall(SamFileEnd(s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the end ---- */

static void WriteAxis(FILE *file, const char name[], const double values[], hsize_t n)
{
  fprintf(file,
          "        <DataItem Name=\"%s\" Dimensions=\"%llu\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">",
          name, (unsigned long long)n);
  for (hsize_t k = 0; k < n; k++) fprintf(file, "%s%.17g", k % 8 ? " " : "\n          ", values[k]);
  fprintf(file, "\n        </DataItem>\n");
}

/* A dataset of all steps together, or one step of another, taken from the HDF5 file. */
static void WriteAttribute(FILE *file, const SamStressFile s, const char results[], PetscInt k, hsize_t step)
{
  const unsigned long long t = step, n[3] = {s->shape[Z], s->shape[Y], s->shape[X]};

  fprintf(file, "      <Attribute Name=\"%s\" Center=\"Node\">\n", datasets[k].label.name);
  if (FirstDimension(k) == TIME)
    fprintf(file,
            "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"%llu %llu %llu\">\n"
            "          <DataItem Dimensions=\"3 4\" Format=\"XML\">%llu 0 0 0 1 1 1 1 1 %llu %llu %llu</DataItem>\n"
            "          <DataItem Dimensions=\"%llu %llu %llu %llu\"",
            n[0], n[1], n[2], t, n[0], n[1], n[2], (unsigned long long)s->shape[TIME], n[0], n[1], n[2]);
  else
    fprintf(file, "          <DataItem Dimensions=\"%llu %llu %llu\"", n[0], n[1], n[2]);
  fprintf(file, " NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">%s:/%s</DataItem>\n", results,
          datasets[k].label.name);
  if (FirstDimension(k) == TIME) fprintf(file, "        </DataItem>\n");
  fprintf(file, "      </Attribute>\n");
}

/* The whole description; returns an errno or 0. */
static int WriteXdmf(const SamStressFile s, const char name[], const char results[])
{
  FILE *file = fopen(name, "w");
  int   bad;

  if (!file) return errno;
  fprintf(file, "%s", SamXdmfHead);
  for (hsize_t t = 0; t < s->shape[TIME]; t++) {
    fprintf(file,
            "    <Grid Name=\"step\">\n      <Time Value=\"%.17g\"/>\n"
            "      <Topology TopologyType=\"3DRectMesh\" Dimensions=\"%llu %llu %llu\"/>\n"
            "      <Geometry GeometryType=\"VXVYVZ\">\n",
            s->coordinate[TIME][t], (unsigned long long)s->shape[Z], (unsigned long long)s->shape[Y],
            (unsigned long long)s->shape[X]);
    WriteAxis(file, "x", s->coordinate[X], s->shape[X]);
    WriteAxis(file, "y", s->coordinate[Y], s->shape[Y]);
    WriteAxis(file, "z", s->coordinate[Z], s->shape[Z]);
    fprintf(file, "      </Geometry>\n");
    for (PetscInt k = 0; k < DATASETS; k++)
      if (s->wants[datasets[k].quantity]) WriteAttribute(file, s, results, k, t);
    fprintf(file, "    </Grid>\n");
  }
  fprintf(file, "    </Grid>\n  </Domain>\n</Xdmf>\n");
  bad = ferror(file) ? EIO : 0;
  return fclose(file) ? errno : bad;
}

static PetscErrorCode Describe(SamStressFile s)
{
  const char *slash = strrchr(s->filename, '/');
  char       *name, *results;
  int         error = 0;

  PetscFunctionBegin;
  PetscCall(SamXdmfMakeName(s->filename, &name));
  PetscCall(SamXdmfEscape(slash ? slash + 1 : s->filename, &results));
  PetscCall(SamFileCheckName(s->grid, OPTION, name, SAM_FILE_XDMF));
  if (s->f->rank == 0) error = WriteXdmf(s, name, results);
  PetscCall(SamFileRaise(s->grid, OPTION, name, error));
  PetscCall(PetscFree(results));
  PetscCall(PetscFree(name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CloseAll(SamStressFile s)
{
  for (PetscInt k = 0; k < DATASETS; k++) {
    if (s->dataset[k] >= 0) (void)SamFileNote(s->f, H5Dclose(s->dataset[k]));
    s->dataset[k] = -1;
  }
  for (int d = 0; d < DIMENSIONS; d++) {
    if (s->scale[d] >= 0) (void)SamFileNote(s->f, H5Dclose(s->scale[d]));
    s->scale[d] = -1;
  }
  if (s->history_time >= 0) (void)SamFileNote(s->f, H5Dclose(s->history_time));
  if (s->history >= 0) (void)SamFileNote(s->f, H5Gclose(s->history));
  s->history = s->history_time = -1;
}

PetscErrorCode SamStressFileFinish(SamStressFile s)
{
  PetscFunctionBegin;
  PetscCall(Describe(s));
  PetscCall(SamFileBegin(s->f));
  CloseAll(s);
  PetscCall(SamFileEnd(s->f));
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
  if (s->f && !s->broken) {
    PetscCall(SamFileBegin(s->f));
    CloseAll(s);
    PetscCall(SamFileEnd(s->f));
  }
  if (s->f) PetscCall(SamFileDestroy(&s->f, s->broken ? PETSC_FALSE : PETSC_TRUE));
  SamHoldRelease(s->temporary, &s->hold);
  for (int d = 0; d < DIMENSIONS; d++) PetscCall(PetscFree(s->coordinate[d]));
  PetscCall(PetscFree(s->filename));
  PetscCall(PetscFree(s->temporary));
  PetscCall(SamGridDestroy(&s->grid));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

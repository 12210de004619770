/*
  The datasets of the results file: names, units, dimensions, attributes.

  Dimension scales follow the HDF5 dimension scale specification, so that netCDF-4 and xarray find the coordinates; the
  attributes follow the CF conventions.
*/
#include "ioimpl.h"
#include <hdf5_hl.h>
#include <math.h>
#include <string.h>

#define CHUNK_STEPS SAM_OUTPUT_WAIT /* steps per chunk of a series, which has one number per step */

static const SamLabel x_label        = {"x", "m", "x of the cell centres"};
static const SamLabel y_label        = {"y", "m", "y of the cell centres"};
static const SamLabel z_label        = {"z", "m", "z of the middle of layers, into body 2"};
static const SamLabel time_label     = {"time", "s", "time of the saved fields"};
static const char     state_words[]  = "open stick slip"; /* SamCellState */
static const char     status_words[] = "converged not_converged no_equilibrium edge_contact";

#define CHUNK_MATRICES 16 /* chunk size of a series of matrices */
#define EDGE           4  /* expected number of cells that an edge crosses, relative to the number along x and y */

static const SamShape series   = {1, {0}, {H5S_UNLIMITED}, {CHUNK_STEPS}, NULL};
static const SamShape matrices = {3,
                                  {0, SAM_COMPONENTS, SAM_COMPONENTS},
                                  {H5S_UNLIMITED, SAM_COMPONENTS, SAM_COMPONENTS},
                                  {CHUNK_MATRICES, SAM_COMPONENTS, SAM_COMPONENTS},
                                  NULL};

/* Creates the coordinates of the cell centres along x (0) or y (1), in the root group or in another group. */
static PetscErrorCode CreateAxis(SamOutput o, hid_t where, const SamLabel *label, PetscInt direction, hid_t *scale)
{
  const PetscInt n     = direction ? o->grid->ny : o->grid->nx;
  const SamShape shape = {1, {(hsize_t)n}, {(hsize_t)n}, {0}, NULL};
  double        *values;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &values));
  for (PetscInt k = 0; k < n; k++) values[k] = direction ? SamGridY(o->grid, k) : SamGridX(o->grid, k);
  *scale = SamFileCreateScale(o->f, where, label, direction ? "Y" : "X",
                              direction ? "projection_y_coordinate" : "projection_x_coordinate", &shape, values);
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Divides n into as few chunks of equal size as possible, none larger than `most`, and returns their size; the last
  chunk may extend beyond n.
*/
static hsize_t ChunkSize(hsize_t n, hsize_t most)
{
  const hsize_t chunks = (n + most - 1) / most;

  return (n + chunks - 1) / chunks;
}

/* Returns the shape of a field's dataset; each chunk holds one step. */
static SamShape FieldShape(SamGrid grid, const SamOutputSettings *set)
{
  const hsize_t ny = (hsize_t)grid->ny, nx = (hsize_t)grid->nx;

  return (SamShape){3,
                    {0, ny, nx},
                    {H5S_UNLIMITED, ny, nx},
                    {1, ChunkSize(ny, (hsize_t)set->chunk[1]), ChunkSize(nx, (hsize_t)set->chunk[0])},
                    NULL};
}

/* Returns the shape of a dataset of so many layers; each layer has separate chunks. */
static SamShape LayersShape(SamGrid grid, const SamOutputSettings *set, PetscInt layers)
{
  const SamShape plane = FieldShape(grid, set);

  return (SamShape){4,
                    {0, (hsize_t)layers, plane.size[1], plane.size[2]},
                    {H5S_UNLIMITED, (hsize_t)layers, plane.size[1], plane.size[2]},
                    {1, 1, plane.chunk[1], plane.chunk[2]},
                    NULL};
}

static hid_t StoredType(const SamStateResult *field, PetscBool single)
{
  return field->kind == SAM_FIELD_STATE ? H5T_STD_I8LE : single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
}

/* Returns the layers of a field; NULL: it is not a field of layers. */
static const SamStateLayers *LayersOf(SamOutput o, PetscInt f)
{
  const SamStateResult *field = SamOutputResult(o, f);

  return field->kind == SAM_FIELD_LAYERS ? SamStateLayersOf(o->state[SAM_SERIES_HISTORY], field->name) : NULL;
}

hsize_t SamOutputPlanes(SamOutput o, PetscInt f)
{
  const SamStateLayers *layers = LayersOf(o, f);

  return layers ? (hsize_t)(layers->count[0] + layers->count[1]) : 1;
}

/* Returns the chunks of one plane of a field of cells in one step. */
static hsize_t PlaneChunks(SamOutput o)
{
  const SamShape shape  = FieldShape(o->grid, &o->set);
  hsize_t        chunks = 1;

  for (int d = 1; d < 3; d++) chunks *= (shape.size[d] + shape.chunk[d] - 1) / shape.chunk[d];
  return chunks;
}

off_t SamOutputFieldBytes(SamOutput o)
{
  const SamShape shape = FieldShape(o->grid, &o->set);
  const hsize_t  cells = PlaneChunks(o) * shape.chunk[1] * shape.chunk[2]; /* in whole chunks */
  hsize_t        bytes = 0, points = 0; /* bytes per cell of all fields; bytes of edges */

  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    if (!o->wants[f]) continue;
    if (SamOutputResult(o, f)->kind == SAM_FIELD_POINTS)
      points += EDGE * (shape.size[1] + shape.size[2]) * 2 * sizeof(double);
    else
      bytes += H5Tget_size(StoredType(SamOutputResult(o, f), o->set.single)) * SamOutputPlanes(o, f);
  }
  return (off_t)(cells * bytes + points);
}

/* Returns the bytes of a series, in whole chunks. */
static double SeriesBytes(double rows, hsize_t chunk, hsize_t numbers)
{
  return ceil(rows / (double)chunk) * (double)(chunk * numbers * sizeof(double));
}

#define STRUCTURE 136e3 /* bytes of an empty file */
#define INDEX     64    /* bytes per chunk in HDF5's indices */

SamFileGrowth SamOutputGrowth(SamOutput o)
{
  const double  points = EDGE * (double)(o->grid->nx + o->grid->ny) / SAM_OUTPUT_POINTS;
  SamFileGrowth growth = {0, 1, o->set.steps / CHUNK_MATRICES}; /* beside the fields and numbers: time */

  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    const PetscBool edge   = SamOutputResult(o, f)->kind == SAM_FIELD_POINTS ? PETSC_TRUE : PETSC_FALSE;
    const double    chunks = edge ? ceil(points) : (double)(PlaneChunks(o) * SamOutputPlanes(o, f)); /* of a step */

    if (!o->wants[f]) continue;
    growth.fields++;
    growth.chunks = PetscMax(growth.chunks, o->set.saved * chunks);
  }
  for (PetscInt k = 0; k < SAM_SERIES; k++)
    for (PetscInt c = 0; o->state[k] && c < SamStateCountNumbers(o->state[k]); c++)
      growth.series += SamStateNumberOf(o->state[k], c, NULL)->result ? 1 : 0;
  return growth;
}

PetscErrorCode SamOutputForecast(SamOutput o, const char filename[], double *bytes, double *space)
{
  const SamState      state  = o->state[SAM_SERIES_HISTORY];
  const SamFileGrowth growth = SamOutputGrowth(o);
  const double        index = INDEX * (double)PlaneChunks(o), steps = o->set.steps, saved = o->set.saved;

  PetscFunctionBegin;
  *bytes = STRUCTURE + SamFileIndexBytes(&growth) + SeriesBytes(saved, CHUNK_STEPS, 1) +
           saved * (double)SamOutputFieldBytes(o);
  for (PetscInt f = 0; f < SamOutputCount(o); f++)
    *bytes += o->wants[f] ? saved * index * (double)SamOutputPlanes(o, f) : 0;
  for (PetscInt c = 0; c < SamStateCountNumbers(state); c++) {
    const SamStateNumber *n      = SamStateNumberOf(state, c, NULL);
    const PetscBool       matrix = n->kind == SAM_NUMBER_MATRIX;

    if (n->result) *bytes += SeriesBytes(steps, matrix ? CHUNK_MATRICES : CHUNK_STEPS, (hsize_t)n->count);
  }
  PetscCall(SamFileGetSpace(o->grid, "output", filename, space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void WriteFlags(SamOutput o, hid_t dataset)
{
  const int8_t states[] = {SAM_CELL_OPEN, SAM_CELL_STICK, SAM_CELL_SLIP};

  SamFileWriteAttribute(o->f, dataset, "flag_values", H5T_STD_I8LE, H5T_NATIVE_INT8, 3, states);
  SamFileWriteTextAttribute(o->f, dataset, "flag_meanings", state_words);
}

/* Marks the file by its first coordinate, which is stored in the order of memory only on little-endian machines. */
static void Mark(SamOutput o, hid_t x)
{
  const haddr_t at = x >= 0 ? H5Dget_offset(x) : HADDR_UNDEF;

  o->hold.mark    = (double)SamGridX(o->grid, 0);
  o->hold.mark_at = at != HADDR_UNDEF && H5Tequal(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE) > 0 ? (off_t)at : 0;
}

/* A group of the file with fields of layers, and its scales for [time, z, y, x] */
typedef struct {
  hid_t                 id, scales[4];
  const SamStateLayers *layers; /* NULL: none is open */
} LayerGroup;

/* Creates a field of layers in its group, which is created with the first of its fields. */
static PetscErrorCode CreateLayers(SamOutput o, PetscInt f, LayerGroup *group)
{
  const SamStateLayers *layers = LayersOf(o, f);
  const SamStateResult *field  = SamOutputResult(o, f);
  const hsize_t         count  = SamOutputPlanes(o, f);
  const SamShape        shape  = LayersShape(o->grid, &o->set, (PetscInt)count);
  const SamShape        column = {1, {count}, {count}, {0}, NULL};
  const SamLabel        label  = {strchr(field->name, '/') + 1, field->unit, field->text};

  PetscFunctionBegin;
  if (group->layers != layers) {
    *group           = (LayerGroup){.layers = layers, .scales = {o->time}};
    group->id        = SamFileNote(o->f, H5Gcreate2(o->f->id, layers->group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    group->scales[1] = SamFileCreateScale(o->f, group->id, &z_label, "Z", NULL, &column, layers->z);
    PetscCall(CreateAxis(o, group->id, &y_label, 1, &group->scales[2]));
    PetscCall(CreateAxis(o, group->id, &x_label, 0, &group->scales[3]));
  }
  o->fields[f] =
    SamFileCreateDataset(o->f, group->id, &label, StoredType(field, o->set.single), &shape, o->set.compress);
  SamFileAttachScales(o->f, o->fields[f], 4, group->scales);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names the groups that add to the stresses by tractions, also those that are not saved, for readers of stresses. */
static void NameStresses(SamOutput o)
{
  const SamStateLayers *layers;
  char                  names[256] = "", name[64];

  for (PetscInt k = 0; (layers = SamStateGetLayers(o->state[SAM_SERIES_HISTORY], k)); k++) {
    const double facts[3] = {(double)layers->count[0], (double)layers->count[1], layers->initial ? 1 : 0};

    if (!layers->stresses) continue;
    (void)snprintf(names + strlen(names), sizeof(names) - strlen(names), "%s%s", names[0] ? "," : "", layers->group);
    (void)snprintf(name, sizeof(name), "%s" SAM_OUTPUT_LAYERS, layers->group);
    SamFileWriteAttribute(o->f, o->f->id, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, facts);
  }
  if (names[0]) SamFileWriteTextAttribute(o->f, o->f->id, SAM_OUTPUT_STRESSES, names);
}

static PetscErrorCode CreateFields(SamOutput o)
{
  const SamShape shape = FieldShape(o->grid, &o->set);
  LayerGroup     group = {.layers = NULL};
  hid_t          scales[3]; /* for [time, y, x] */
  PetscBool      points = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(CreateAxis(o, o->f->id, &x_label, 0, &scales[2]));
  PetscCall(CreateAxis(o, o->f->id, &y_label, 1, &scales[1]));
  scales[0] = o->time = SamFileCreateScale(o->f, o->f->id, &time_label, "T", "time", &series, NULL);
  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    const SamStateResult *field = SamOutputResult(o, f);
    const SamLabel        label = SamOutputLabel(o, f);

    if (!o->wants[f]) continue;
    if (field->kind == SAM_FIELD_POINTS) {
      o->fields[f] = SamOutputCreatePoints(o, &label);
      points       = PETSC_TRUE;
      continue;
    }
    if (field->kind == SAM_FIELD_LAYERS) {
      PetscCall(CreateLayers(o, f, &group));
      continue;
    }
    o->fields[f] =
      SamFileCreateDataset(o->f, o->f->id, &label, StoredType(field, o->set.single), &shape, o->set.compress);
    if (field->kind == SAM_FIELD_STATE) WriteFlags(o, o->fields[f]);
    SamFileAttachScales(o->f, o->fields[f], 3, scales);
  }
  if (points) SamOutputCreatePointScales(o);
  Mark(o, scales[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the names of the rows or columns of matrices: the six loads, or the six rigid displacements. */
static hid_t CreateComponents(SamOutput o, PetscBool loads)
{
  static const SamLabel load             = {"load_component", "1", "component of the load"},
                        rigid            = {"rigid_component", "1", "component of the rigid-body displacement"};
  const SamShape shape                   = {1, {SAM_COMPONENTS}, {SAM_COMPONENTS}, {0}, NULL};
  const SamBlock block                   = {1, {0}, {o->f->rank ? 0 : SAM_COMPONENTS}};
  double         numbers[SAM_COMPONENTS] = {0};
  char           names[128]              = "";
  hid_t          scale;

  for (int c = 0; c < SAM_COMPONENTS; c++) {
    numbers[c] = c;
    (void)snprintf(names + strlen(names), sizeof(names) - strlen(names), "%s%s", c ? " " : "",
                   loads ? SamComponentNames[c].load : SamComponentNames[c].rigid);
  }
  scale = SamFileCreateDataset(o->f, o->f->id, loads ? &load : &rigid, H5T_STD_I8LE, &shape, 0);
  (void)SamFileNote(o->f, H5DSset_scale(scale, loads ? load.name : rigid.name));
  SamFileWriteAttribute(o->f, scale, "flag_values", H5T_STD_I8LE, H5T_NATIVE_DOUBLE, SAM_COMPONENTS, numbers);
  SamFileWriteTextAttribute(o->f, scale, "flag_meanings", names);
  SamFileWriteBlock(o->f, scale, H5T_NATIVE_DOUBLE, &block, numbers);
  return scale;
}

static hid_t CreateColumn(SamOutput o, hid_t group, const SamStateNumber *number)
{
  const int64_t   statuses[] = {SAM_STATUS_CONVERGED, SAM_STATUS_NOT_CONVERGED, SAM_STATUS_NO_EQUILIBRIUM,
                                SAM_STATUS_EDGE_CONTACT};
  const SamLabel  label      = {number->name, SamUnitOn(o->grid, number->unit), number->text};
  const PetscBool whole      = number->kind == SAM_NUMBER_INT || number->kind == SAM_NUMBER_STATUS;
  const hid_t     dataset    = SamFileCreateDataset(o->f, group, &label, whole ? H5T_STD_I64LE : H5T_IEEE_F64LE,
                                             number->kind == SAM_NUMBER_MATRIX ? &matrices : &series, 0);

  if (number->kind == SAM_NUMBER_STATUS) {
    SamFileWriteAttribute(o->f, dataset, "flag_values", H5T_STD_I64LE, H5T_NATIVE_INT64, 4, statuses);
    SamFileWriteTextAttribute(o->f, dataset, "flag_meanings", status_words);
  }
  return dataset;
}

/* Creates a series. Its first column is the dimension scale of the others; matrices have two more scales, created with
   the first. */
static void CreateSeries(SamOutput o, SamSeries kind)
{
  const SamState  state   = o->state[kind];
  const PetscBool history = kind == SAM_SERIES_HISTORY;
  hid_t          *to = o->columns[kind], group, scales[3] = {-1, -1, -1};

  if (!state) return;
  group = SamFileNote(o->f, H5Gcreate2(o->f->id, o->series[kind], H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (PetscInt c = 0; c < SamStateCountNumbers(state); c++) {
    const SamStateNumber *n      = SamStateNumberOf(state, c, NULL);
    const SamLabel        label  = {n->name, SamUnitOn(o->grid, n->unit), n->text};
    const double          before = SamStateMissingNumber(state, c); /* value in parts of the run without the column */

    if (!n->result) continue;
    if (c == 0) {
      to[0] = scales[0] =
        SamFileCreateScale(o->f, group, &label, history ? "T" : NULL, history ? "time" : NULL, &series, NULL);
      continue;
    }
    if (n->kind == SAM_NUMBER_MATRIX && scales[1] < 0) {
      scales[1] = CreateComponents(o, PETSC_TRUE);
      scales[2] = CreateComponents(o, PETSC_FALSE);
    }
    to[c] = CreateColumn(o, group, n);
    if (!isnan(before))
      SamFileWriteAttribute(o->f, to[c], "value_before", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &before);
    SamFileAttachScales(o->f, to[c], n->kind == SAM_NUMBER_MATRIX ? 3 : 1, scales);
  }
}

/* Describes the results for VTK as one sheet of cells. */
static void CreateVTK(SamOutput o)
{
  const SamGrid g       = o->grid;
  const double  sides[] = {g->dx, g->dy}, dy = sides[g->axes - 1]; /* plane strain: square cells, not 1 m wide */
  SamImage      image = {.cells   = PETSC_TRUE,
                         .n       = {(hsize_t)g->nx, (hsize_t)g->ny, 0},
                         .origin  = {SamGridX(g, 0) - 0.5 * g->dx, SamGridY(g, 0) - 0.5 * dy, 0},
                         .spacing = {g->dx, dy, g->dx}};

  for (PetscInt f = 0; f < SamOutputCount(o); f++)
    if (o->fields[f] >= 0 && SamOutputResult(o, f)->kind <= SAM_FIELD_STATE)
      image.names[image.count++] = SamOutputResult(o, f)->name;
  o->vtk_steps = SamFileCreateVTK(o->f, &image);
}

PetscErrorCode SamOutputCreateLayout(SamOutput o)
{
  const int8_t open = 0;
  char         identity[32];

  PetscFunctionBegin;
  PetscCall(CreateFields(o));
  for (PetscInt k = 0; k < SAM_SERIES; k++) CreateSeries(o, (SamSeries)k);
  SamOutputCreateTables(o);
  PetscCall(SamOutputCreateGradients(o));
  CreateVTK(o);
  NameStresses(o);
  SamFileWriteOrigin(o->f, "Partial-slip contact of elastic bodies", "petsam");
  (void)snprintf(identity, sizeof(identity), SAM_IDENTITY, o->identity);
  SamFileWriteTextAttribute(o->f, o->f->id, SAM_OUTPUT_IDENTITY, identity);
  SamFileWriteAttribute(o->f, o->f->id, "closed", H5T_STD_I8LE, H5T_NATIVE_INT8, 1, &open);
  o->closed = SamFileNote(o->f, H5Aopen(o->f->id, "closed", H5P_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The datasets of the results file: names, units, dimensions, attributes.

  Dimension scales follow the HDF5 dimension scale specification, so that netCDF-4 and xarray know the coordinates; the
  attributes follow the CF conventions.
*/
#include "ioimpl.h"
#include <hdf5_hl.h>
#include <math.h>
#include <string.h>

#define CHUNK_STEPS SAM_OUTPUT_WAIT /* steps in a chunk of a series, which has one number a step */

static const SamOutputLabel x_label        = {"x", "m", "x of the cell centres"};
static const SamOutputLabel y_label        = {"y", "m", "y of the cell centres"};
static const SamOutputLabel time_label     = {"time", "s", "time of the saved fields"};
static const char           state_words[]  = "open stick slip"; /* SamState */
static const char           status_words[] = "converged not_converged no_equilibrium edge_contact";

#define CHUNK_MATRICES 16 /* of a series of matrices */
#define EDGE           4  /* cells that an edge is expected to cross, over those along x and y */

static const SamShape series   = {1, {0}, {H5S_UNLIMITED}, {CHUNK_STEPS}};
static const SamShape matrices = {3,
                                  {0, SAM_COMPONENTS, SAM_COMPONENTS},
                                  {H5S_UNLIMITED, SAM_COMPONENTS, SAM_COMPONENTS},
                                  {CHUNK_MATRICES, SAM_COMPONENTS, SAM_COMPONENTS}};

/* A coordinate, marked by the CF attributes `axis` and `standard_name`. */
static hid_t CreateScale(SamOutput o, hid_t where, const SamOutputLabel *label, const char axis[],
                         const char standard_name[], const SamShape *shape)
{
  const hid_t scale = SamFileCreateDataset(o->f, where, label, H5T_IEEE_F64LE, shape, 0);

  SamFileWriteTextAttribute(o->f, scale, "axis", axis);
  SamFileWriteTextAttribute(o->f, scale, "standard_name", standard_name);
  (void)SamFileNote(o->f, H5DSset_scale(scale, label->name));
  return scale;
}

/* The coordinates of the cell centres along x (0) or y (1), written by rank 0. */
static PetscErrorCode CreateAxis(SamOutput o, const SamOutputLabel *label, PetscInt direction, hid_t *scale)
{
  const PetscInt n     = direction ? o->f->grid->ny : o->f->grid->nx;
  const SamShape shape = {1, {(hsize_t)n}, {(hsize_t)n}, {0}};
  double        *values;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &values));
  for (PetscInt k = 0; k < n; k++) values[k] = direction ? SamGridY(o->f->grid, k) : SamGridX(o->f->grid, k);
  *scale = CreateScale(o, o->f->id, label, direction ? "Y" : "X",
                       direction ? "projection_y_coordinate" : "projection_x_coordinate", &shape);
  SamFileWriteSeries(o->f, *scale, values);
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Divides n into as few chunks of equal size as possible, none larger than `most`, and returns their size; the last may
  reach a little beyond n.
*/
static hsize_t ChunkSize(hsize_t n, hsize_t most)
{
  const hsize_t chunks = (n + most - 1) / most;

  return (n + chunks - 1) / chunks;
}

/* Chunks are one step deep. */
static SamShape FieldShape(SamGrid grid, const SamOutputSettings *set)
{
  const hsize_t ny = (hsize_t)grid->ny, nx = (hsize_t)grid->nx;

  return (SamShape){3,
                    {0, ny, nx},
                    {H5S_UNLIMITED, ny, nx},
                    {1, ChunkSize(ny, (hsize_t)set->chunk[1]), ChunkSize(nx, (hsize_t)set->chunk[0])}};
}

static hid_t StoredType(const SamOutputField *field, PetscBool single)
{
  return field->kind == SAM_FIELD_STATE ? H5T_STD_I8LE : single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
}

off_t SamOutputFieldBytes(SamGrid grid, const SamOutputSettings *set)
{
  const SamShape shape = FieldShape(grid, set);
  hsize_t        cells = 1, bytes = 0, points = 0; /* cells in whole chunks; bytes of all fields in a cell; of edges */

  for (int d = 1; d < 3; d++) cells *= (shape.size[d] + shape.chunk[d] - 1) / shape.chunk[d] * shape.chunk[d];
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    if (!SamOutputWantsField(set, f)) continue;
    if (SamOutputFields[f].kind == SAM_FIELD_POINTS)
      points += EDGE * (shape.size[1] + shape.size[2]) * 2 * sizeof(double);
    else
      bytes += H5Tget_size(StoredType(&SamOutputFields[f], set->single));
  }
  return (off_t)(cells * bytes + points);
}

/* Bytes that a series takes: whole chunks. */
static double SeriesBytes(double rows, hsize_t chunk, hsize_t numbers)
{
  return ceil(rows / (double)chunk) * (double)(chunk * numbers * sizeof(double));
}

#define STRUCTURE 100e3 /* bytes, of an empty file */
#define INDEX     64    /* bytes for a chunk in HDF5's indices */
PetscErrorCode SamOutputForecast(SamOutput o, double steps, double saved, double *bytes)
{
  const SamOutputSettings *set   = &o->set;
  const SamOutputSeries   *s     = &SamOutputAllSeries[SAM_SERIES_HISTORY];
  const SamShape           shape = FieldShape(o->f->grid, set);
  double                   index = INDEX;

  PetscFunctionBegin;
  for (int d = 1; d < 3; d++) index *= (double)((shape.size[d] + shape.chunk[d] - 1) / shape.chunk[d]);
  *bytes = STRUCTURE + SeriesBytes(saved, CHUNK_STEPS, 1) + saved * (double)SamOutputFieldBytes(o->f->grid, set);
  for (PetscInt f = 0; f < SamOutputFieldCount; f++)
    if (SamOutputWantsField(set, f)) *bytes += saved * index;
  for (PetscInt c = 0; c < s->count; c++) {
    const PetscBool matrix = s->columns[c].kind == SAM_COLUMN_MATRIX;

    if (SamOutputWants(set, s->columns[c].option))
      *bytes += SeriesBytes(steps, matrix ? CHUNK_MATRICES : CHUNK_STEPS, matrix ? SAM_COMPONENTS * SAM_COMPONENTS : 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void WriteFlags(SamOutput o, hid_t dataset)
{
  const int8_t states[] = {SAM_STATE_OPEN, SAM_STATE_STICK, SAM_STATE_SLIP};

  SamFileWriteAttribute(o->f, dataset, "flag_values", H5T_STD_I8LE, H5T_NATIVE_INT8, 3, states);
  SamFileWriteTextAttribute(o->f, dataset, "flag_meanings", state_words);
}

static PetscErrorCode CreateFields(SamOutput o)
{
  const SamShape shape = FieldShape(o->f->grid, &o->set);
  hid_t          scales[3]; /* of [time, y, x] */
  PetscBool      points = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(CreateAxis(o, &x_label, 0, &scales[2]));
  PetscCall(CreateAxis(o, &y_label, 1, &scales[1]));
  scales[0] = o->time = CreateScale(o, o->f->id, &time_label, "T", "time", &series);
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    const SamOutputField *field = &SamOutputFields[f];

    if (!SamOutputWantsField(&o->set, f)) continue;
    if (field->kind == SAM_FIELD_POINTS) {
      o->fields[f] = SamOutputCreatePoints(o, &field->label);
      points       = PETSC_TRUE;
      continue;
    }
    o->fields[f] =
      SamFileCreateDataset(o->f, o->f->id, &field->label, StoredType(field, o->set.single), &shape, o->set.compress);
    if (field->kind == SAM_FIELD_STATE) WriteFlags(o, o->fields[f]);
    for (unsigned d = 0; d < 3; d++) (void)SamFileNote(o->f, H5DSattach_scale(o->fields[f], scales[d], d));
  }
  if (points) SamOutputCreatePointScales(o);
  (void)SamFileNote(o->f, H5Dclose(scales[1]));
  (void)SamFileNote(o->f, H5Dclose(scales[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows or columns of matrices: the six loads, or the six rigid displacements, by name. */
static hid_t CreateComponents(SamOutput o, PetscBool loads)
{
  static const SamOutputLabel load       = {"load_component", "1", "component of the load"},
                              rigid      = {"rigid_component", "1", "component of the rigid displacement"};
  const SamShape shape                   = {1, {SAM_COMPONENTS}, {SAM_COMPONENTS}, {0}};
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
  SamFileWriteSeries(o->f, scale, numbers);
  return scale;
}

/* Names the rows and columns of the matrices of a group of columns. */
static void AttachComponents(SamOutput o, SamOutputSeriesKind kind)
{
  const SamOutputSeries *s     = &SamOutputAllSeries[kind];
  const hid_t            loads = CreateComponents(o, PETSC_TRUE), rigid = CreateComponents(o, PETSC_FALSE);

  for (PetscInt c = 0; c < s->count; c++) {
    if (o->columns[kind][c] < 0 || s->columns[c].kind != SAM_COLUMN_MATRIX) continue;
    (void)SamFileNote(o->f, H5DSattach_scale(o->columns[kind][c], loads, 1));
    (void)SamFileNote(o->f, H5DSattach_scale(o->columns[kind][c], rigid, 2));
  }
  (void)SamFileNote(o->f, H5Dclose(loads));
  (void)SamFileNote(o->f, H5Dclose(rigid));
}

static hid_t CreateColumn(SamOutput o, hid_t group, const SamOutputColumn *column)
{
  const int64_t   statuses[] = {SAM_STATUS_CONVERGED, SAM_STATUS_NOT_CONVERGED, SAM_STATUS_NO_EQUILIBRIUM,
                                SAM_STATUS_EDGE_CONTACT};
  const PetscBool whole      = column->kind == SAM_COLUMN_INT || column->kind == SAM_COLUMN_STATUS;
  const hid_t     dataset    = SamFileCreateDataset(o->f, group, &column->label, whole ? H5T_STD_I64LE : H5T_IEEE_F64LE,
                                             column->kind == SAM_COLUMN_MATRIX ? &matrices : &series, 0);

  if (column->kind == SAM_COLUMN_STATUS) {
    SamFileWriteAttribute(o->f, dataset, "flag_values", H5T_STD_I64LE, H5T_NATIVE_INT64, 4, statuses);
    SamFileWriteTextAttribute(o->f, dataset, "flag_meanings", status_words);
  }
  return dataset;
}

/* The first column is the dimension scale of the others. */
static void CreateSeries(SamOutput o, SamOutputSeriesKind kind)
{
  const SamOutputSeries *s  = &SamOutputAllSeries[kind];
  hid_t                 *to = o->columns[kind], group;

  if (!SamOutputWants(&o->set, s->columns[0].option)) return;
  group = SamFileNote(o->f, H5Gcreate2(o->f->id, s->name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (kind == SAM_SERIES_HISTORY) {
    to[0] = CreateScale(o, group, &s->columns[0].label, "T", "time", &series);
  } else {
    to[0] = CreateColumn(o, group, &s->columns[0]);
    (void)SamFileNote(o->f, H5DSset_scale(to[0], s->columns[0].label.name));
  }
  for (PetscInt c = 1; c < s->count; c++) {
    if (!SamOutputWants(&o->set, s->columns[c].option)) continue;
    to[c] = CreateColumn(o, group, &s->columns[c]);
    (void)SamFileNote(o->f, H5DSattach_scale(to[c], to[0], 0));
  }
  if (kind == SAM_SERIES_HISTORY && o->set.with[SAM_OUTPUT_STIFFNESS]) AttachComponents(o, kind);
  (void)SamFileNote(o->f, H5Gclose(group));
}

PetscErrorCode SamOutputCreateLayout(SamOutput o)
{
  const int8_t open = 0;

  PetscFunctionBegin;
  PetscCall(CreateFields(o));
  for (PetscInt k = 0; k < SAM_SERIES; k++) CreateSeries(o, (SamOutputSeriesKind)k);
  SamOutputCreateVTK(o);
  SamFileWriteTextAttribute(o->f, o->f->id, "Conventions", "CF-1.8");
  SamFileWriteTextAttribute(o->f, o->f->id, "title", "Partial-slip contact of elastic bodies");
  SamFileWriteTextAttribute(o->f, o->f->id, "source", "petsam " PETSAM_VERSION ", semi-analytical method");
  SamFileWriteTextAttribute(o->f, o->f->id, "petsam_version", PETSAM_VERSION);
  SamFileWriteAttribute(o->f, o->f->id, "closed", H5T_STD_I8LE, H5T_NATIVE_INT8, 1, &open);
  o->closed = SamFileNote(o->f, H5Aopen(o->f->id, "closed", H5P_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens a dataset; an optional one may not be there, and stays closed then. */
static void OpenDataset(SamOutput o, hid_t where, const char name[], PetscBool optional, hid_t *dataset)
{
  if (where < 0 || (optional && SamFileNote(o->f, H5Lexists(where, name, H5P_DEFAULT)) == 0)) return;
  *dataset = SamFileNote(o->f, H5Dopen2(where, name, H5P_DEFAULT));
}

static void OpenSeries(SamOutput o, SamOutputSeriesKind kind)
{
  const SamOutputSeries *s = &SamOutputAllSeries[kind];
  hid_t                  group;

  if (kind != SAM_SERIES_HISTORY && SamFileNote(o->f, H5Lexists(o->f->id, s->name, H5P_DEFAULT)) == 0) return;
  group = SamFileNote(o->f, H5Gopen2(o->f->id, s->name, H5P_DEFAULT));
  for (PetscInt c = 0; c < s->count; c++)
    OpenDataset(o, group, s->columns[c].label.name,
                kind == SAM_SERIES_HISTORY && s->columns[c].option < SAM_OUTPUT_OPTIONS, &o->columns[kind][c]);
  if (group >= 0) (void)SamFileNote(o->f, H5Gclose(group));
}

/* Takes over the fields, their precision and the chunk sizes that the file has. */
static void ReadFields(SamOutput o)
{
  PetscInt some = -1;
  hid_t    creation, type;
  hsize_t  chunk[3] = {1, 1, 1};

  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    o->set.fields[f] = o->fields[f] >= 0;
    if (!o->set.fields[f] || SamOutputFields[f].kind == SAM_FIELD_POINTS) continue;
    some = f;
    if (SamOutputFields[f].kind != SAM_FIELD_REAL) continue;
    type          = SamFileNote(o->f, H5Dget_type(o->fields[f]));
    o->set.single = H5Tget_size(type) == sizeof(float);
    if (type >= 0) (void)SamFileNote(o->f, H5Tclose(type));
  }
  if (some < 0) return;
  creation = SamFileNote(o->f, H5Dget_create_plist(o->fields[some]));
  (void)SamFileNote(o->f, H5Pget_chunk(creation, 3, chunk));
  o->set.chunk[0] = (PetscInt)chunk[2];
  o->set.chunk[1] = (PetscInt)chunk[1];
  (void)SamFileNote(o->f, H5Pclose(creation));
}

void SamOutputOpenLayout(SamOutput o)
{
  OpenDataset(o, o->f->id, "time", PETSC_FALSE, &o->time);
  OpenDataset(o, o->f->id, "point", PETSC_TRUE, &o->point);
  for (PetscInt f = 0; f < SamOutputFieldCount; f++)
    OpenDataset(o, o->f->id, SamOutputFields[f].label.name, PETSC_TRUE, &o->fields[f]);
  for (PetscInt k = 0; k < SAM_SERIES; k++) OpenSeries(o, (SamOutputSeriesKind)k);
  ReadFields(o);
  SamOutputOpenVTK(o);
  o->closed = SamFileNote(o->f, H5Aopen(o->f->id, "closed", H5P_DEFAULT));
}

void SamOutputMark(SamOutput o)
{
  const hid_t   x  = SamFileNote(o->f, H5Dopen2(o->f->id, x_label.name, H5P_DEFAULT));
  const haddr_t at = x >= 0 ? H5Dget_offset(x) : HADDR_UNDEF;

  /* stored as it is in memory on little-endian machines only */
  o->hold.mark    = (double)SamGridX(o->f->grid, 0);
  o->hold.mark_at = at != HADDR_UNDEF && H5Tequal(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE) > 0 ? (off_t)at : 0;
  if (x >= 0) (void)SamFileNote(o->f, H5Dclose(x));
}

static void Close(SamOutput o, hid_t *dataset)
{
  if (*dataset >= 0) (void)SamFileNote(o->f, H5Dclose(*dataset));
  *dataset = -1;
}

void SamOutputCloseLayout(SamOutput o)
{
  if (o->vtk_steps >= 0) (void)SamFileNote(o->f, H5Aclose(o->vtk_steps));
  if (o->closed >= 0) (void)SamFileNote(o->f, H5Aclose(o->closed));
  o->vtk_steps = o->closed = -1;
  Close(o, &o->time);
  Close(o, &o->point);
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) Close(o, &o->fields[f]);
  for (PetscInt k = 0; k < SAM_SERIES; k++)
    for (PetscInt c = 0; c < SamOutputAllSeries[k].count; c++) Close(o, &o->columns[k][c]);
}

/* ---- reading ---- */

hsize_t SamOutputLength(SamOutput o, hid_t dataset)
{
  const hid_t space   = SamFileNote(o->f, H5Dget_space(dataset));
  hsize_t     size[3] = {0, 0, 0};

  if (SamFileNote(o->f, H5Sget_simple_extent_ndims(space)) <= 3)
    (void)SamFileNote(o->f, H5Sget_simple_extent_dims(space, size, NULL));
  if (space >= 0) (void)SamFileNote(o->f, H5Sclose(space));
  return size[0];
}

void SamOutputReadSeries(SamOutput o, hid_t dataset, hid_t type, hsize_t first, hsize_t count, void *values)
{
  const hid_t space    = SamFileNote(o->f, H5Dget_space(dataset));
  hsize_t     start[3] = {first, 0, 0}, size[3] = {0, 1, 1}, all;
  hid_t       memory;

  if (SamFileNote(o->f, H5Sget_simple_extent_ndims(space)) <= 3)
    (void)SamFileNote(o->f, H5Sget_simple_extent_dims(space, size, NULL));
  size[0] = count;
  all     = count * size[1] * size[2];
  memory  = SamFileNote(o->f, H5Screate_simple(1, &all, NULL));
  if (count) (void)SamFileNote(o->f, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL));
  if (count) (void)SamFileNote(o->f, H5Dread(dataset, type, memory, space, o->f->transfer, values));
  (void)SamFileNote(o->f, H5Sclose(memory));
  (void)SamFileNote(o->f, H5Sclose(space));
}

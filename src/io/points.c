/*
  Edges as points in a results file: datasets (time, point, 2) of x and y, whose rows end in NaN where a step has fewer
  points than another one. Rank 0 writes and reads them. netCDF's readers want a scale for each dimension; those of
  points and coordinates have no values, as the attribute says by which netCDF knows such scales.
*/
#include "ioimpl.h"
#include <hdf5_hl.h>
#include <math.h>

#define CHUNK 256 /* points */

static const SamOutputLabel point_label      = {"point", "1", "point of an edge"},
                            coordinate_label = {"coordinate", "1", "x and y of a point"};

/* A scale without values. */
static hid_t CreateScale(SamOutput o, const SamOutputLabel *label, const SamShape *shape)
{
  const hid_t scale = SamFileCreateDataset(o->f, o->f->id, label, H5T_STD_I8LE, shape, 0);

  (void)SamFileNote(o->f, H5DSset_scale(scale, "This is a netCDF dimension but not a netCDF variable.         0"));
  return scale;
}

void SamOutputCreatePointScales(SamOutput o)
{
  const SamShape point = {1, {0}, {H5S_UNLIMITED}, {CHUNK}}, coordinate = {1, {2}, {2}, {0}};
  hid_t          scale;

  o->point = CreateScale(o, &point_label, &point);
  scale    = CreateScale(o, &coordinate_label, &coordinate);
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    if (o->fields[f] < 0 || SamOutputFields[f].kind != SAM_FIELD_POINTS) continue;
    (void)SamFileNote(o->f, H5DSattach_scale(o->fields[f], o->time, 0));
    (void)SamFileNote(o->f, H5DSattach_scale(o->fields[f], o->point, 1));
    (void)SamFileNote(o->f, H5DSattach_scale(o->fields[f], scale, 2));
  }
  (void)SamFileNote(o->f, H5Dclose(scale));
}

hid_t SamOutputCreatePoints(SamOutput o, const SamOutputLabel *label)
{
  const hsize_t size[3] = {0, 0, 2}, largest[3] = {H5S_UNLIMITED, H5S_UNLIMITED, 2}, chunk[3] = {1, CHUNK, 2};
  const double  nothing = NAN;
  const hid_t   space   = SamFileNote(o->f, H5Screate_simple(3, size, largest)),
              creation  = SamFileNote(o->f, H5Pcreate(H5P_DATASET_CREATE));
  hid_t dataset;

  (void)SamFileNote(o->f, H5Pset_chunk(creation, 3, chunk));
  (void)SamFileNote(o->f, H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &nothing));
  dataset =
    SamFileNote(o->f, H5Dcreate2(o->f->id, label->name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  SamFileWriteTextAttribute(o->f, dataset, "units", label->units);
  SamFileWriteTextAttribute(o->f, dataset, "long_name", label->long_name);
  (void)SamFileNote(o->f, H5Pclose(creation));
  (void)SamFileNote(o->f, H5Sclose(space));
  return dataset;
}

PetscErrorCode SamOutputGatherPoints(SamOutput o, const SamEdge *edge)
{
  const MPI_Comm comm = o->f->grid->comm;
  PetscMPIInt    ranks, mine = (PetscMPIInt)(2 * edge->count), *counts, *starts, total = 0;
  double        *own;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(PetscMalloc3(ranks, &counts, ranks, &starts, mine, &own));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < ranks; r++) {
    starts[r] = total;
    total += counts[r];
  }
  for (PetscInt k = 0; k < edge->count; k++) {
    own[2 * k]     = (double)edge->x[k];
    own[2 * k + 1] = (double)edge->y[k];
  }
  PetscCall(PetscFree(o->points.xy));
  PetscCall(PetscMalloc1(total, &o->points.xy));
  o->points.count = (hsize_t)total / 2;
  PetscCallMPI(MPI_Gatherv(own, mine, MPI_DOUBLE, o->points.xy, counts, starts, MPI_DOUBLE, 0, comm));
  PetscCall(PetscFree3(counts, starts, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The size of a dataset of points: steps, points, 2. */
static void GetSize(SamOutput o, hid_t dataset, hsize_t size[3])
{
  const hid_t space = SamFileNote(o->f, H5Dget_space(dataset));

  size[0] = size[1] = 0;
  size[2]           = 2;
  if (space < 0) return;
  (void)SamFileNote(o->f, H5Sget_simple_extent_ndims(space) == 3 ? H5Sget_simple_extent_dims(space, size, NULL) : -1);
  (void)SamFileNote(o->f, H5Sclose(space));
}

void SamOutputGetPointsExtent(SamOutput o, PetscInt f, hsize_t extent[2])
{
  hsize_t size[3];

  GetSize(o, o->fields[f], size);
  extent[0] = size[1];
  extent[1] = size[2];
}

/* Selects the first `count` points of a step; only rank 0 transfers any. */
static void Select(SamOutput o, hid_t dataset, hsize_t step, hsize_t count, hid_t *space, hid_t *memory)
{
  const hsize_t start[3] = {step, 0, 0}, size[3] = {1, count, 2}, numbers = PetscMax(2 * count, 1);

  *space  = SamFileNote(o->f, H5Dget_space(dataset));
  *memory = SamFileNote(o->f, H5Screate_simple(1, &numbers, NULL));
  if (o->f->rank == 0 && count) {
    (void)SamFileNote(o->f, H5Sselect_hyperslab(*space, H5S_SELECT_SET, start, NULL, size, NULL));
  } else {
    (void)SamFileNote(o->f, H5Sselect_none(*space));
    (void)SamFileNote(o->f, H5Sselect_none(*memory));
  }
}

/* Makes the scale of points as long as the longest edge. */
static void ExtendScale(SamOutput o, hsize_t points)
{
  const hid_t space   = SamFileNote(o->f, H5Dget_space(o->point));
  hsize_t     size[1] = {0};

  (void)SamFileNote(o->f, H5Sget_simple_extent_dims(space, size, NULL));
  (void)SamFileNote(o->f, H5Sclose(space));
  if (size[0] < points) (void)SamFileNote(o->f, H5Dset_extent(o->point, &points));
}

void SamOutputAppendPoints(SamOutput o, hid_t dataset, hsize_t step, const SamOutputPoints *points)
{
  hsize_t size[3];
  double  nothing = 0;
  hid_t   space, memory;

  GetSize(o, dataset, size);
  size[0] = step + 1;
  size[1] = PetscMax(size[1], points->count);
  (void)SamFileNote(o->f, H5Dset_extent(dataset, size));
  ExtendScale(o, size[1]);
  Select(o, dataset, step, points->count, &space, &memory);
  (void)SamFileNote(o->f, H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, o->f->transfer,
                                   points->count ? points->xy : &nothing));
  (void)SamFileNote(o->f, H5Sclose(space));
  (void)SamFileNote(o->f, H5Sclose(memory));
}

PetscErrorCode SamOutputReadPoints(SamOutput o, hid_t dataset, hsize_t step, SamOutputPoints *points)
{
  unsigned long long count = 0;
  hsize_t            size[3];
  double             nothing = 0;
  hid_t              space, memory;

  PetscFunctionBegin;
  GetSize(o, dataset, size);
  PetscCall(PetscFree(points->xy));
  PetscCall(PetscMalloc1(2 * size[1], &points->xy));
  Select(o, dataset, step, size[1], &space, &memory);
  (void)SamFileNote(o->f, H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, o->f->transfer,
                                  size[1] ? points->xy : &nothing));
  (void)SamFileNote(o->f, H5Sclose(space));
  (void)SamFileNote(o->f, H5Sclose(memory));
  if (o->f->rank == 0)
    while (count < size[1] && !isnan(points->xy[2 * count])) count++;
  PetscCallMPI(MPI_Bcast(&count, 1, MPI_UNSIGNED_LONG_LONG, 0, o->f->grid->comm));
  points->count = count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Edges as points in a results file: datasets (time, point, 2) of x and y, whose rows end in NaN if a step has fewer
  points than another one. Rank 0 writes them. Readers of netCDF need a scale for each dimension; the scales of points
  and coordinates have no values, which an attribute of netCDF declares.
*/
#include "ioimpl.h"
#include <petsam/private/rows.h>
#include <hdf5_hl.h>
#include <math.h>

static const SamLabel point_label      = {"point", "1", "point of an edge"},
                      coordinate_label = {"coordinate", "1", "x and y of a point"};

/* Creates a scale without values. */
static hid_t CreateScale(SamOutput o, const SamLabel *label, const SamShape *shape)
{
  const hid_t scale = SamFileCreateDataset(o->f, o->f->id, label, H5T_STD_I8LE, shape, 0);

  (void)SamFileNote(o->f, H5DSset_scale(scale, "This is a netCDF dimension but not a netCDF variable.         0"));
  return scale;
}

void SamOutputCreatePointScales(SamOutput o)
{
  const SamShape point = {1, {0}, {H5S_UNLIMITED}, {SAM_OUTPUT_POINTS}, NULL}, coordinate = {1, {2}, {2}, {0}, NULL};
  hid_t          scales[3];

  scales[0] = o->time;
  scales[1] = o->point = CreateScale(o, &point_label, &point);
  scales[2]            = CreateScale(o, &coordinate_label, &coordinate);
  for (PetscInt f = 0; f < SamOutputCount(o); f++)
    if (o->fields[f] >= 0 && SamOutputResult(o, f)->kind == SAM_FIELD_POINTS)
      SamFileAttachScales(o->f, o->fields[f], 3, scales);
}

/* Creates the dataset of edge points; places beyond a step's last point are NaN. */
hid_t SamOutputCreatePoints(SamOutput o, const SamLabel *label)
{
  const double   nothing = NAN;
  const SamShape shape   = {3, {0, 0, 2}, {H5S_UNLIMITED, H5S_UNLIMITED, 2}, {1, SAM_OUTPUT_POINTS, 2}, &nothing};

  return SamFileCreateDataset(o->f, o->f->id, label, H5T_IEEE_F64LE, &shape, 0);
}

PetscErrorCode SamOutputGatherPoints(SamOutput o, const SamEdge *edge, SamOutputPoints *points)
{
  double  *own;
  PetscInt total;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * edge->count, &own));
  for (PetscInt k = 0; k < edge->count; k++) {
    own[2 * k]     = (double)edge->x[k];
    own[2 * k + 1] = (double)edge->y[k];
  }
  PetscCall(SamGather(o->f->comm, MPI_DOUBLE, 2 * edge->count, own, &total, &points->xy));
  points->count = (hsize_t)total / 2;
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts the points of steps side by side, each step filled up with NaN to `most` points. Only rank 0 has any. */
static void Align(SamOutput o, hsize_t count, hsize_t most, const SamOutputPoints points[], double xy[])
{
  for (hsize_t k = 0; k < count && o->f->rank == 0; k++)
    for (hsize_t i = 0; i < 2 * most; i++) xy[2 * most * k + i] = i < 2 * points[k].count ? points[k].xy[i] : NAN;
}

PetscErrorCode SamOutputAppendPoints(SamOutput o, hid_t dataset, hsize_t count, const SamOutputPoints points[])
{
  hsize_t  most = 0, size[3], scale[1];
  SamBlock block;
  double  *xy;

  PetscFunctionBegin;
  for (hsize_t k = 0; k < count; k++) most = PetscMax(most, points[k].count);
  PetscCall(PetscMalloc1(2 * most * count, &xy));
  Align(o, count, most, points, xy);
  SamFileGetSize(o->f, dataset, 3, size);
  size[0] = o->saved + count;
  size[1] = PetscMax(size[1], most);
  size[2] = 2;
  (void)SamFileNote(o->f, H5Dset_extent(dataset, size));
  SamFileGetSize(o->f, o->point, 1, scale); /* as long as the longest edge */
  if (scale[0] < size[1]) (void)SamFileNote(o->f, H5Dset_extent(o->point, &size[1]));
  block = (SamBlock){3, {o->saved, 0, 0}, {count, o->f->rank ? 0 : most, 2}};
  SamFileWriteBlock(o->f, dataset, H5T_NATIVE_DOUBLE, &block, xy);
  PetscCall(PetscFree(xy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

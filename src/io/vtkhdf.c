/*
  The results for VTK: a group VTKHDF in the same file, for ParaView from 5.12 on.

  The group describes an image of one layer of cells with a series of steps (VTKHDF file format 2.0,
  https://docs.vtk.org, "VTKHDF File Format"). It links to the datasets of the file, so that nothing is stored twice.
*/
#include "ioimpl.h"
#include <stdio.h>

/* VTK reads the type's name only as an ASCII text of fixed length. */
static void WriteType(SamOutput o, hid_t group)
{
  static const char image[] = "ImageData";
  const hid_t       type    = SamFileNote(o->f, H5Tcopy(H5T_C_S1));

  (void)SamFileNote(o->f, H5Tset_size(type, sizeof(image) - 1));
  (void)SamFileNote(o->f, H5Tset_strpad(type, H5T_STR_NULLPAD));
  SamFileWriteAttribute(o->f, group, "Type", type, type, 1, image);
  (void)SamFileNote(o->f, H5Tclose(type));
}

static void WriteGeometry(SamOutput o, hid_t group)
{
  const SamGrid grid         = o->grid;
  const double  dy           = grid->axes == 1 ? grid->dx : grid->dy; /* a row of squares, not of sticks of 1 m */
  const int64_t version[2]   = {2, 0};
  const int64_t extent[6]    = {0, grid->nx, 0, grid->ny, 0, 0};
  const double  origin[3]    = {SamGridX(grid, 0) - 0.5 * grid->dx, SamGridY(grid, 0) - 0.5 * dy, 0};
  const double  spacing[3]   = {grid->dx, dy, grid->side[1]};
  const double  direction[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  SamFileWriteAttribute(o->f, group, "Version", H5T_STD_I64LE, H5T_NATIVE_INT64, 2, version);
  WriteType(o, group);
  SamFileWriteAttribute(o->f, group, "WholeExtent", H5T_STD_I64LE, H5T_NATIVE_INT64, 6, extent);
  SamFileWriteAttribute(o->f, group, "Origin", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, origin);
  SamFileWriteAttribute(o->f, group, "Spacing", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, spacing);
  SamFileWriteAttribute(o->f, group, "Direction", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 9, direction);
}

static hid_t CreateGroup(SamOutput o, hid_t where, const char name[])
{
  return SamFileNote(o->f, H5Gcreate2(where, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

/* A soft link: with a hard link, readers might take the second name for that of a dimension. */
static void Link(SamOutput o, hid_t group, const char name[], const char dataset[])
{
  char path[64];

  (void)snprintf(path, sizeof(path), "/%s", dataset);
  (void)SamFileNote(o->f, H5Lcreate_soft(path, group, name, H5P_DEFAULT, H5P_DEFAULT));
}

void SamOutputCreateVTK(SamOutput o)
{
  const hid_t group = CreateGroup(o, o->f->id, "VTKHDF"), cells = CreateGroup(o, group, "CellData"),
              steps  = CreateGroup(o, group, "Steps");
  const int64_t none = 0;

  WriteGeometry(o, group);
  for (PetscInt f = 0; f < SamOutputCount(o); f++)
    if (o->fields[f] >= 0 && SamOutputResult(o, f)->kind != SAM_FIELD_POINTS)
      Link(o, cells, SamOutputResult(o, f)->name, SamOutputResult(o, f)->name);
  Link(o, steps, "Values", "time");
  SamFileWriteAttribute(o->f, steps, "NSteps", H5T_STD_I64LE, H5T_NATIVE_INT64, 1, &none);
  o->vtk_steps = SamFileNote(o->f, H5Aopen(steps, "NSteps", H5P_DEFAULT));
  (void)SamFileNote(o->f, H5Gclose(steps));
  (void)SamFileNote(o->f, H5Gclose(cells));
  (void)SamFileNote(o->f, H5Gclose(group));
}

void SamOutputCountVTK(SamOutput o, hsize_t saved)
{
  const int64_t count = (int64_t)saved;

  (void)SamFileNote(o->f, H5Awrite(o->vtk_steps, H5T_NATIVE_INT64, &count));
}

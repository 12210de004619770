/*
  Results and stresses for VTK: a group VTKHDF in the same file, for ParaView from 5.12 on.

  The group describes an image of cells or points, with a series of steps (VTKHDF file format 2.0, https://docs.vtk.org,
  "VTKHDF File Format"). It links to the datasets of the file, so that nothing is stored twice.

  VTK (9.3 to 9.7) expects no dimension of time if there is only one step. So a single sheet of cells with one step is
  described as a slab whose third dimension is the time, until there is a second step. A volume with one step is
  described as two steps with the same values.
*/
#include <petsam/private/file.h>
#include <stdio.h>

/* VTK reads the type's name only as an ASCII text of fixed length. */
static void WriteType(SamFile f, hid_t group)
{
  static const char image[] = "ImageData";
  const hid_t       type    = SamFileNote(f, H5Tcopy(H5T_C_S1));

  (void)SamFileNote(f, H5Tset_size(type, sizeof(image) - 1));
  (void)SamFileNote(f, H5Tset_strpad(type, H5T_STR_NULLPAD));
  SamFileWriteAttribute(f, group, "Type", type, type, 1, image);
  (void)SamFileNote(f, H5Tclose(type));
}

static void WriteGeometry(SamFile f, hid_t group, const SamImage *image)
{
  const int64_t version[2]   = {2, 0};
  const double  direction[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  int64_t       extent[6]    = {0};

  for (int d = 0; d < 3; d++) extent[2 * d + 1] = (int64_t)image->n[d] - (image->cells ? 0 : 1);
  SamFileWriteAttribute(f, group, "Version", H5T_STD_I64LE, H5T_NATIVE_INT64, 2, version);
  WriteType(f, group);
  SamFileWriteAttribute(f, group, "WholeExtent", H5T_STD_I64LE, H5T_NATIVE_INT64, 6, extent);
  SamFileWriteAttribute(f, group, "Origin", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, image->origin);
  SamFileWriteAttribute(f, group, "Spacing", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, image->spacing);
  SamFileWriteAttribute(f, group, "Direction", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 9, direction);
}

static hid_t CreateGroup(SamFile f, hid_t where, const char name[])
{
  return SamFileNote(f, H5Gcreate2(where, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

/* Makes a soft link: readers might take the second name of a hard link for the name of a dimension. */
static void Link(SamFile f, hid_t group, const char name[], const char dataset[])
{
  char path[64];

  (void)snprintf(path, sizeof(path), "/%s", dataset);
  (void)SamFileNote(f, H5Lcreate_soft(path, group, name, H5P_DEFAULT, H5P_DEFAULT));
}

/* Describes the only step twice: its time, and the place in the datasets where the values of both begin. */
static void RepeatStep(SamFile f, hid_t steps, const SamImage *image)
{
  static const SamLabel values = {"Values", "s", "time of the only step"}, first = {"first", "1", "index of the step"};
  const SamShape        shape     = {1, {2}, {2}, {0}, NULL};
  const SamBlock        block     = {1, {0}, {f->rank ? 0 : 2}};
  const double          times[2]  = {image->time, image->time};
  const int64_t         places[2] = {0, 0};
  const hid_t           time      = SamFileCreateDataset(f, steps, &values, H5T_IEEE_F64LE, &shape, 0),
              place               = SamFileCreateDataset(f, steps, &first, H5T_STD_I64LE, &shape, 0),
              group               = CreateGroup(f, steps, image->cells ? "CellDataOffsets" : "PointDataOffsets");

  SamFileWriteBlock(f, time, H5T_NATIVE_DOUBLE, &block, times);
  SamFileWriteBlock(f, place, H5T_NATIVE_INT64, &block, places);
  for (PetscInt k = 0; k < image->count; k++) Link(f, group, image->names[k], "VTKHDF/Steps/first");
  (void)SamFileNote(f, H5Gclose(group));
}

void SamFileCountVTK(SamFile f, hid_t number, int64_t steps)
{
  const hid_t group     = SamFileNote(f, H5Gopen2(f->id, "VTKHDF", H5P_DEFAULT));
  const hid_t attribute = SamFileNote(f, H5Aopen(group, "WholeExtent", H5P_DEFAULT));
  int64_t     extent[6] = {0};

  (void)SamFileNote(f, H5Aread(attribute, H5T_NATIVE_INT64, extent));
  extent[5] = steps == 1;
  (void)SamFileNote(f, H5Awrite(attribute, H5T_NATIVE_INT64, extent));
  (void)SamFileNote(f, H5Aclose(attribute));
  (void)SamFileNote(f, H5Gclose(group));
  (void)SamFileNote(f, H5Awrite(number, H5T_NATIVE_INT64, &steps));
}

hid_t SamFileCreateVTK(SamFile f, const SamImage *image)
{
  const hid_t group = CreateGroup(f, f->id, "VTKHDF"),
              data  = CreateGroup(f, group, image->cells ? "CellData" : "PointData");
  const int64_t two = 2;
  hid_t         steps, number = -1;

  WriteGeometry(f, group, image);
  for (PetscInt k = 0; k < image->count; k++) Link(f, data, image->names[k], image->names[k]);
  if (image->steps >= 0) {
    steps = CreateGroup(f, group, "Steps");
    if (image->steps == 1)
      RepeatStep(f, steps, image);
    else
      Link(f, steps, "Values", "time");
    SamFileWriteAttribute(f, steps, "NSteps", H5T_STD_I64LE, H5T_NATIVE_INT64, 1,
                          image->steps == 1 ? &two : &image->steps);
    number = SamFileNote(f, H5Aopen(steps, "NSteps", H5P_DEFAULT));
    (void)SamFileNote(f, H5Gclose(steps));
  }
  (void)SamFileNote(f, H5Gclose(data));
  (void)SamFileNote(f, H5Gclose(group));
  return number;
}

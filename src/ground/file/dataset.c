/* Attributes and datasets of an HDF5 file that all ranks use together. */
#include <petsam/private/file.h>
#include <hdf5_hl.h>
#include <stdlib.h>
#include <string.h>

/* ---- attributes ---- */

void SamFileWriteAttribute(SamFile f, hid_t object, const char name[], hid_t stored, hid_t type, PetscInt count,
                           const void *values)
{
  const hsize_t size  = (hsize_t)count;
  const hid_t   space = SamFileNote(f, count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL));
  hid_t         attribute;

  if (SamFileNote(f, H5Aexists(object, name)) > 0) (void)SamFileNote(f, H5Adelete(object, name));
  attribute = SamFileNote(f, H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT));
  (void)SamFileNote(f, H5Awrite(attribute, type, values));
  (void)SamFileNote(f, H5Aclose(attribute));
  (void)SamFileNote(f, H5Sclose(space));
}

/* Texts are stored with variable length, since h5py reads these as str. */
void SamFileWriteTextAttribute(SamFile f, hid_t object, const char name[], const char text[])
{
  const hid_t type = SamFileNote(f, H5Tcopy(H5T_C_S1));

  (void)SamFileNote(f, H5Tset_size(type, H5T_VARIABLE));
  (void)SamFileNote(f, H5Tset_cset(type, H5T_CSET_UTF8));
  SamFileWriteAttribute(f, object, name, type, type, 1, &text);
  (void)SamFileNote(f, H5Tclose(type));
}

void SamFileReadAttribute(SamFile f, hid_t object, const char name[], hid_t type, PetscInt count, void *values)
{
  const hid_t attribute = SamFileNote(f, H5Aopen(object, name, H5P_DEFAULT)),
              space     = SamFileNote(f, H5Aget_space(attribute));

  if (attribute >= 0 && space >= 0) {
    if (H5Sget_simple_extent_npoints(space) == count)
      (void)SamFileNote(f, H5Aread(attribute, type, values));
    else
      (void)SamFileNote(f, -1);
  }
  if (space >= 0) (void)SamFileNote(f, H5Sclose(space));
  if (attribute >= 0) (void)SamFileNote(f, H5Aclose(attribute));
}

void SamFileReadTextAttribute(SamFile f, hid_t object, const char name[], char **text)
{
  const hid_t type = SamFileNote(f, H5Tcopy(H5T_C_S1));
  char       *read = NULL;

  (void)SamFileNote(f, H5Tset_size(type, H5T_VARIABLE));
  (void)SamFileNote(f, H5Tset_cset(type, H5T_CSET_UTF8));
  SamFileReadAttribute(f, object, name, type, 1, &read);
  if (PetscStrallocpy(read ? read : "", text)) (void)SamFileNote(f, -1);
  if (read) (void)SamFileNote(f, H5free_memory(read));
  (void)SamFileNote(f, H5Tclose(type));
}

PetscBool SamFileHasAttribute(SamFile f, const char name[])
{
  return SamFileNote(f, H5Aexists(f->id, name)) > 0;
}

void SamFileWriteOrigin(SamFile f, const char title[], const char program[])
{
  char source[64];

  (void)snprintf(source, sizeof(source), "%s " PETSAM_VERSION ", semi-analytical method", program);
  SamFileWriteTextAttribute(f, f->id, "Conventions", "CF-1.8");
  SamFileWriteTextAttribute(f, f->id, "title", title);
  SamFileWriteTextAttribute(f, f->id, "source", source);
  SamFileWriteTextAttribute(f, f->id, "petsam_version", PETSAM_VERSION);
}

/* Copies a text without the spaces that pad it, cut to the available length. */
static void CopyTrimmed(const char from[], size_t most, char text[], size_t size)
{
  size_t length = strnlen(from, most);

  while (length && from[length - 1] == ' ') length--;
  if (length > size - 1) length = size - 1;
  memcpy(text, from, length);
  text[length] = '\0';
}

H5T_class_t SamAttributeClass(hid_t object, const char name[], hssize_t *count)
{
  const hid_t attribute   = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1,
              type        = attribute >= 0 ? H5Aget_type(attribute) : -1,
              space       = attribute >= 0 ? H5Aget_space(attribute) : -1;
  const H5T_class_t class = type >= 0 ? H5Tget_class(type) : H5T_NO_CLASS;

  *count = space >= 0 ? H5Sget_simple_extent_npoints(space) : 0;
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  if (attribute >= 0) (void)H5Aclose(attribute);
  return class;
}

PetscBool SamTextRead(hid_t object, const char name[], char text[], size_t size)
{
  hssize_t        count;
  const PetscBool is     = SamAttributeClass(object, name, &count) == H5T_STRING && count == 1,
                  exists = H5Aexists(object, name) > 0;
  const hid_t attribute = is ? H5Aopen(object, name, H5P_DEFAULT) : -1, type = is ? H5Aget_type(attribute) : -1;
  char       *value = NULL;

  (void)snprintf(text, size, "not a text");
  if (!is) return exists;
  if (H5Tis_variable_str(type) > 0) {
    if (H5Aread(attribute, type, &value) >= 0 && value) CopyTrimmed(value, strlen(value), text, size);
    if (value) (void)H5free_memory(value);
  } else if ((value = (char *)calloc(H5Tget_size(type), 1)) != NULL) {
    if (H5Aread(attribute, type, value) >= 0) CopyTrimmed(value, H5Tget_size(type), text, size);
    free(value);
  }
  (void)H5Tclose(type);
  (void)H5Aclose(attribute);
  return exists;
}

/* ---- datasets ---- */

/*
  Creates the index of the chunks of a dataset that will grow. HDF5 creates it with the first chunk; then a run on
  several ranks, each of which writes a part of the metadata, could be killed after the dataset names its index and
  before the index is written, and nothing of the dataset could be read. Here the file has not got its name yet.
*/
static void CreateIndex(SamFile f, hid_t dataset, const SamShape *shape)
{
  static const hsize_t one[SAM_SHAPE_RANK] = {1, 1, 1, 1, 1, 1};

  if (!shape->chunk[0] || shape->size[0]) return;
  (void)SamFileNote(f, H5Dset_extent(dataset, one));
  (void)SamFileNote(f, H5Dset_extent(dataset, shape->size));
}

hid_t SamFileCreateDataset(SamFile f, hid_t where, const SamLabel *label, hid_t type, const SamShape *shape,
                           PetscInt compress)
{
  const hid_t space    = SamFileNote(f, H5Screate_simple(shape->rank, shape->size, shape->largest)),
              creation = SamFileNote(f, H5Pcreate(H5P_DATASET_CREATE));
  hid_t dataset;

  if (shape->chunk[0]) (void)SamFileNote(f, H5Pset_chunk(creation, shape->rank, shape->chunk));
  if (shape->fill)
    (void)SamFileNote(f, H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, shape->fill));
  else /* filling would write every value twice */
    (void)SamFileNote(f, H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER));
  if (compress > 0) {
    (void)SamFileNote(f, H5Pset_shuffle(creation));
    (void)SamFileNote(f, H5Pset_deflate(creation, (unsigned)compress));
  }
  dataset = SamFileNote(f, H5Dcreate2(where, label->name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  CreateIndex(f, dataset, shape);
  if (label->units) SamFileWriteTextAttribute(f, dataset, "units", label->units);
  if (label->long_name) SamFileWriteTextAttribute(f, dataset, "long_name", label->long_name);
  (void)SamFileNote(f, H5Pclose(creation));
  (void)SamFileNote(f, H5Sclose(space));
  return dataset;
}

hid_t SamFileCreateScale(SamFile f, hid_t where, const SamLabel *label, const char axis[], const char standard_name[],
                         const SamShape *shape, const double values[])
{
  const hid_t    scale = SamFileCreateDataset(f, where, label, H5T_IEEE_F64LE, shape, 0);
  const SamBlock block = {1, {0}, {f->rank ? 0 : shape->size[0]}};

  if (axis) SamFileWriteTextAttribute(f, scale, "axis", axis);
  if (standard_name) SamFileWriteTextAttribute(f, scale, "standard_name", standard_name);
  (void)SamFileNote(f, H5DSset_scale(scale, label->name));
  if (values) SamFileWriteBlock(f, scale, H5T_NATIVE_DOUBLE, &block, values);
  return scale;
}

void SamFileAttachScales(SamFile f, hid_t dataset, int count, const hid_t scales[])
{
  for (int d = 0; d < count; d++) (void)SamFileNote(f, H5DSattach_scale(dataset, scales[d], (unsigned)d));
}

void SamFileGetSize(SamFile f, hid_t dataset, int rank, hsize_t size[])
{
  const hid_t space = SamFileNote(f, H5Dget_space(dataset));

  for (int d = 0; d < rank; d++) size[d] = 0;
  (void)SamFileNote(
    f, space >= 0 && H5Sget_simple_extent_ndims(space) == rank ? H5Sget_simple_extent_dims(space, size, NULL) : -1);
  if (space >= 0) (void)SamFileNote(f, H5Sclose(space));
}

/* ---- blocks ---- */

/* Selects a rank's block; a rank without a block takes part with an empty selection. */
static void Select(SamFile f, hid_t dataset, const SamBlock *b, hid_t *space, hid_t *memory)
{
  hsize_t size = 1;

  for (int d = 0; d < b->rank; d++) size *= b->count[d];
  *memory = SamFileNote(f, H5Screate_simple(b->rank, b->count, NULL));
  *space  = SamFileNote(f, H5Dget_space(dataset));
  if (size) {
    (void)SamFileNote(f, H5Sselect_hyperslab(*space, H5S_SELECT_SET, b->start, NULL, b->count, NULL));
  } else {
    (void)SamFileNote(f, H5Sselect_none(*space));
    (void)SamFileNote(f, H5Sselect_none(*memory));
  }
}

void SamFileWriteBlock(SamFile f, hid_t dataset, hid_t type, const SamBlock *block, const void *values)
{
  const double nothing = 0;
  hid_t        space, memory;

  Select(f, dataset, block, &space, &memory);
  (void)SamFileNote(f, H5Dwrite(dataset, type, memory, space, f->transfer, values ? values : &nothing));
  (void)SamFileNote(f, H5Sclose(space));
  (void)SamFileNote(f, H5Sclose(memory));
}

void SamFileReadBlock(SamFile f, hid_t dataset, hid_t type, const SamBlock *block, void *values)
{
  double nothing;
  hid_t  space, memory;

  Select(f, dataset, block, &space, &memory);
  (void)SamFileNote(f, H5Dread(dataset, type, memory, space, f->transfer, values ? values : &nothing));
  (void)SamFileNote(f, H5Sclose(space));
  (void)SamFileNote(f, H5Sclose(memory));
}

/* True if a dataset is compressed: then its chunks have no zeros before they are written. */
static PetscBool IsCompressed(SamFile f, hid_t dataset)
{
  const hid_t creation = SamFileNote(f, H5Dget_create_plist(dataset));
  const int   filters  = H5Pget_nfilters(creation);

  (void)SamFileNote(f, H5Pclose(creation));
  return filters > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsZero(const char bytes[], size_t n)
{
  return n == 0 || (bytes[0] == 0 && !memcmp(bytes, bytes + 1, n - 1));
}

void SamFileWriteNotZero(SamFile f, hid_t dataset, hid_t type, size_t bytes, const SamBlock *block, const void *values)
{
  const size_t row  = bytes * (size_t)block->count[2];
  const char  *from = (const char *)values;
  SamBlock     left = *block;

  for (; left.count[1] > 0 && IsZero(from, row); from += row) {
    left.start[1]++;
    left.count[1]--;
  }
  while (left.count[1] > 0 && IsZero(from + row * (size_t)(left.count[1] - 1), row)) left.count[1]--;
  if (left.count[1] < block->count[1] && !IsCompressed(f, dataset))
    SamFileWriteBlock(f, dataset, type, &left, from);
  else
    SamFileWriteBlock(f, dataset, type, block, values);
}

static SamBlock FrameOf(SamGrid grid, hsize_t frame)
{
  return (SamBlock){3, {frame, (hsize_t)grid->row_start, 0}, {1, (hsize_t)grid->rows, (hsize_t)grid->nx}};
}

void SamFileWriteFrame(SamFile f, hid_t dataset, hid_t type, hsize_t frame, const void *values)
{
  const SamBlock block = FrameOf(f->grid, frame);

  SamFileWriteBlock(f, dataset, type, &block, values);
}

void SamFileReadFrame(SamFile f, hid_t dataset, hid_t type, hsize_t frame, void *values)
{
  const SamBlock block = FrameOf(f->grid, frame);

  SamFileReadBlock(f, dataset, type, &block, values);
}

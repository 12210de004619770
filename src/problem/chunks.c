/* Where the data of an HDF5 dataset lie in their file. */
#include <petsam/private/chunks.h>

PetscBool SamChunksVisit(hid_t dataset, int rank, const hsize_t extent[], SamChunkVisitor visitor, void *context)
{
  const hid_t space = H5Dget_space(dataset), creation = H5Dget_create_plist(dataset);
  hsize_t     n[SAM_CHUNK_RANK] = {1, 1, 1}, chunk[SAM_CHUNK_RANK] = {1, 1, 1}, at[SAM_CHUNK_RANK];
  PetscBool   good = PETSC_FALSE;

  if (space >= 0 && creation >= 0)
    good = H5Sget_simple_extent_ndims(space) == rank && H5Sget_simple_extent_dims(space, n, NULL) == rank &&
           H5Pget_layout(creation) == H5D_CHUNKED && H5Pget_chunk(creation, rank, chunk) == rank && chunk[0] &&
           chunk[1] && chunk[2];
  for (int d = 0; d < rank && extent; d++) n[d] = extent[d];
  for (at[0] = 0; good && at[0] < n[0]; at[0] += chunk[0])
    for (at[1] = 0; good && at[1] < n[1]; at[1] += chunk[1])
      for (at[2] = 0; good && at[2] < n[2]; at[2] += chunk[2]) {
        haddr_t  address = HADDR_UNDEF;
        hsize_t  bytes   = 0;
        unsigned filters = 0;

        good = H5Dget_chunk_info_by_coord(dataset, at, &filters, &address, &bytes) < 0
                 ? PETSC_FALSE
                 : visitor(address, bytes, context);
      }
  if (creation >= 0) (void)H5Pclose(creation);
  if (space >= 0) (void)H5Sclose(space);
  return good;
}

typedef struct {
  hsize_t   size; /* of the file, bytes */
  PetscBool every;
} Bounds;

static PetscBool IsWithin(haddr_t address, hsize_t bytes, void *context)
{
  const Bounds *b = (const Bounds *)context;

  if (address == HADDR_UNDEF) return b->every ? PETSC_FALSE : PETSC_TRUE;
  return address <= b->size && bytes <= b->size - address;
}

PetscBool SamChunksAreWhole(hid_t file, hid_t dataset, int rank, const hsize_t extent[], PetscBool every)
{
  Bounds b = {0, every};

  return H5Fget_filesize(file, &b.size) >= 0 && SamChunksVisit(dataset, rank, extent, IsWithin, &b);
}

/*
  The seal of results that were closed properly: a checksum over all of the file but the values of the fields, that is
  over HDF5's structure and the small datasets. Only a file whose structure is as it was is appended to: in a damaged
  one HDF5 may hang on several ranks.

  The seal is a line after the end of HDF5's data, which HDF5 ignores, and overwrites when the file grows.
*/
#include "ioimpl.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TITLE "petsam results "
#define LINE  32 /* bytes: title, checksum in 16 digits, end of line */

typedef struct {
  off_t first, end;
} Extent;

static int CompareExtents(const void *a, const void *b)
{
  const off_t one = ((const Extent *)a)->first, other = ((const Extent *)b)->first;

  return (one > other) - (one < other);
}

/* The extents of all chunks of a field, appended to a growing list; returns whether they could be found. */
static PetscBool AddChunks(hid_t dataset, Extent **list, size_t *count, size_t *room)
{
  const hid_t space = H5Dget_space(dataset), creation = H5Dget_create_plist(dataset);
  hsize_t     n[3] = {0, 0, 0}, chunk[3] = {0, 0, 0}, at[3];
  PetscBool   good = H5Sget_simple_extent_ndims(space) == 3 && H5Sget_simple_extent_dims(space, n, NULL) == 3 &&
                       H5Pget_chunk(creation, 3, chunk) == 3 && chunk[0] && chunk[1] && chunk[2]
                       ? PETSC_TRUE
                       : PETSC_FALSE;

  for (at[0] = 0; good && at[0] < n[0]; at[0] += chunk[0])
    for (at[1] = 0; good && at[1] < n[1]; at[1] += chunk[1])
      for (at[2] = 0; good && at[2] < n[2]; at[2] += chunk[2]) {
        haddr_t  address = HADDR_UNDEF;
        hsize_t  bytes   = 0;
        unsigned filters = 0;

        if (*count == *room) {
          Extent *more = (Extent *)realloc(*list, sizeof(Extent) * 2 * (*room + 1024));

          if (!more) good = PETSC_FALSE;
          if (!more) break;
          *list = more;
          *room = 2 * (*room + 1024);
        }
        if (H5Dget_chunk_info_by_coord(dataset, at, &filters, &address, &bytes) < 0) good = PETSC_FALSE;
        if (good && address != HADDR_UNDEF) (*list)[(*count)++] = (Extent){(off_t)address, (off_t)(address + bytes)};
      }
  if (creation >= 0) (void)H5Pclose(creation);
  if (space >= 0) (void)H5Sclose(space);
  return good;
}

/* The extents of all values of fields, in order. */
static PetscBool FindChunks(const char filename[], Extent **list, size_t *count)
{
  const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  size_t      room = 0;
  PetscBool   good = file >= 0 ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt f = 0; f < SamOutputFieldCount && good; f++) {
    const hid_t dataset = H5Dopen2(file, SamOutputFields[f].label.name, H5P_DEFAULT);

    good = dataset >= 0 ? AddChunks(dataset, list, count, &room) : PETSC_FALSE;
    if (dataset >= 0) (void)H5Dclose(dataset);
  }
  if (file >= 0) (void)H5Fclose(file);
  if (*count) qsort(*list, *count, sizeof(Extent), CompareExtents);
  return good;
}

/* Adds the bytes from `first` to `end` to the hash. */
static PetscBool HashRange(int file, off_t first, off_t end, uint64_t *hash)
{
  unsigned char bytes[65536];

  while (first < end) {
    const ssize_t n = pread(file, bytes, (size_t)PetscMin((off_t)sizeof(bytes), end - first), first);

    if (n <= 0) return PETSC_FALSE;
    *hash = SamHashBytes(*hash, bytes, (size_t)n);
    first += n;
  }
  return PETSC_TRUE;
}

/* The line that the file should end with; its data end at `end`. */
static PetscBool MakeLine(const char filename[], int file, off_t end, char line[LINE + 1])
{
  Extent   *list  = NULL;
  size_t    count = 0;
  off_t     at    = 0;
  uint64_t  hash  = SamHashMix((uint64_t)end);
  PetscBool good  = FindChunks(filename, &list, &count);

  for (size_t k = 0; k < count && good; k++) {
    good = HashRange(file, at, PetscMin(list[k].first, end), &hash);
    at   = PetscMax(at, list[k].end);
  }
  good = good && HashRange(file, at, end, &hash) ? PETSC_TRUE : PETSC_FALSE;
  free(list);
  (void)snprintf(line, LINE + 1, TITLE "%016llx\n", (unsigned long long)hash);
  return good;
}

void SamStructureSeal(const char filename[])
{
  const int   file = open(filename, O_RDWR);
  char        line[LINE + 1];
  struct stat status;

  /* without a seal the file will be copied before it is appended to */
  if (file >= 0 && !fstat(file, &status) && MakeLine(filename, file, status.st_size, line) &&
      pwrite(file, line, LINE, status.st_size) != LINE)
    (void)!ftruncate(file, status.st_size);
  if (file >= 0) (void)close(file);
}

PetscBool SamStructureIsSealed(const char filename[])
{
  const int   file = open(filename, O_RDONLY);
  char        should[LINE + 1], has[LINE];
  struct stat status;
  PetscBool   good = PETSC_FALSE;

  if (file >= 0 && !fstat(file, &status) && status.st_size > LINE &&
      pread(file, has, LINE, status.st_size - LINE) == LINE && !strncmp(has, TITLE, strlen(TITLE)))
    good =
      MakeLine(filename, file, status.st_size - LINE, should) && !memcmp(has, should, LINE) ? PETSC_TRUE : PETSC_FALSE;
  if (file >= 0) (void)close(file);
  return good;
}

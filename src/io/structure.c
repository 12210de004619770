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

/* The extents of chunks, a list that grows. */
typedef struct {
  Extent *list;
  size_t  count, room;
} Extents;

static PetscBool AddChunk(haddr_t address, hsize_t bytes, void *context)
{
  Extents *e = (Extents *)context;

  if (e->count == e->room) {
    Extent *more = (Extent *)realloc(e->list, sizeof(Extent) * 2 * (e->room + 1024));

    if (!more) return PETSC_FALSE;
    e->list = more;
    e->room = 2 * (e->room + 1024);
  }
  if (address != HADDR_UNDEF) e->list[e->count++] = (Extent){(off_t)address, (off_t)(address + bytes)};
  return PETSC_TRUE;
}

/* The extents of all values of fields, in order. */
static PetscBool FindChunks(const char filename[], Extents *e)
{
  const hid_t file = H5Fopen(filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  PetscBool   good = file >= 0;

  for (PetscInt f = 0; f < SamOutputFieldCount && good; f++) {
    const SamOutputField *field = &SamOutputFields[f];
    hid_t                 dataset;

    if (H5Lexists(file, field->label.name, H5P_DEFAULT) == 0) continue;
    dataset = H5Dopen2(file, field->label.name, H5P_DEFAULT);
    good    = dataset >= 0 ? SamChunksVisit(dataset, 3, NULL, AddChunk, e) : PETSC_FALSE;
    if (dataset >= 0) (void)H5Dclose(dataset);
  }
  if (file >= 0) (void)H5Fclose(file);
  if (e->count) qsort(e->list, e->count, sizeof(Extent), CompareExtents);
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
  Extents   e    = {NULL, 0, 0};
  off_t     at   = 0;
  uint64_t  hash = SamHashMix((uint64_t)end);
  PetscBool good = FindChunks(filename, &e);

  for (size_t k = 0; k < e.count && good; k++) {
    good = HashRange(file, at, PetscMin(e.list[k].first, end), &hash);
    at   = PetscMax(at, e.list[k].end);
  }
  good = good && HashRange(file, at, end, &hash);
  free(e.list);
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
    good = MakeLine(filename, file, status.st_size - LINE, should) && !memcmp(has, should, LINE);
  if (file >= 0) (void)close(file);
  return good;
}

/*
  petsam-examine - reads the structure of an HDF5 file; if it ends normally, HDF5 does not crash on the file.

      petsam-examine FILE [OBJECT ...]

  HDF5 follows the addresses in a file; on a damaged file it may crash, or follow a circle without end. So the library
  runs this program on a file before it opens the file itself (ground/file/examine.c). The program reads everything that
  the library may read later: names, attributes, shapes, indices of chunks, and small datasets, of the OBJECTs and their
  members, or else of the whole file. It writes a character when it begins, and one when it ends. It ignores errors that
  HDF5 returns, since the library gets them again and reports them. The program needs neither MPI nor PETSc.
*/
#include <hdf5.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __GLIBC__
  #include <malloc.h>
#endif

enum {
  DEPTH = 8, /* depth of groups within groups; petsam reads from at most four */
  SMALL =
    1 << 22, /* bytes of values that are read: larger datasets are read by blocks, from addresses that are checked */
  PATIENCE   = 2,      /* seconds of CPU time, */
  BYTES_MORE = 1 << 26 /* plus one for each so many bytes; a file takes milliseconds */
};

/* Sets limits by which the system ends this process; a crash leaves no core file. */
static void SetLimits(const char filename[])
{
  struct stat         status;
  const rlim_t        more = stat(filename, &status) ? 0 : (rlim_t)status.st_size / BYTES_MORE;
  const struct rlimit time = {PATIENCE + more, PATIENCE + more}, core = {0, 0};

  (void)setrlimit(RLIMIT_CPU, &time);
  (void)setrlimit(RLIMIT_CORE, &core);
}

/* Returns the bytes in memory of all values of this type and space; 0 if there are none, or too many. */
static size_t CountBytes(hid_t type, hid_t space)
{
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const size_t   size  = H5Tget_size(type);

  return count > 0 && size > 0 && (size_t)count <= SMALL / size ? (size_t)count * size : 0;
}

/* Reads the values of an attribute or a dataset into memory, and frees them. */
static void ReadValues(hid_t object, int is_attribute, hid_t file_type, hid_t space)
{
  const hid_t  type   = H5Tget_native_type(file_type, H5T_DIR_DEFAULT);
  const size_t bytes  = type >= 0 ? CountBytes(type, space) : 0;
  void        *values = bytes ? calloc(1, bytes) : NULL;

  if (values) {
    const herr_t error =
      is_attribute ? H5Aread(object, type, values) : H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);

    if (error >= 0) (void)H5Dvlen_reclaim(type, space, H5P_DEFAULT, values);
  }
  free(values);
  if (type >= 0) (void)H5Tclose(type);
}

static void ReadAttributes(hid_t object)
{
  for (hsize_t k = 0;; k++) {
    const hid_t attribute = H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_NATIVE, k, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type      = attribute >= 0 ? H5Aget_type(attribute) : -1,
                space     = attribute >= 0 ? H5Aget_space(attribute) : -1;
    char name[256];

    if (attribute < 0) return;
    (void)H5Aget_name(attribute, sizeof(name), name);
    if (type >= 0 && space >= 0) ReadValues(attribute, 1, type, space);
    if (space >= 0) (void)H5Sclose(space);
    if (type >= 0) (void)H5Tclose(type);
    (void)H5Aclose(attribute);
  }
}

/* Reads the places of a dataset's values, including all nodes of the index of its chunks, and the values of a small
   one. */
static void ReadDataset(hid_t dataset)
{
  const hid_t creation = H5Dget_create_plist(dataset), type = H5Dget_type(dataset), space = H5Dget_space(dataset);

  (void)H5Dget_storage_size(dataset);
  (void)H5Dget_offset(dataset);
  if (type >= 0 && space >= 0) ReadValues(dataset, 0, type, space);
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  if (creation >= 0) (void)H5Pclose(creation);
}

static void ReadObject(hid_t object, int depth)
{
  const H5I_type_t kind = H5Iget_type(object);
  H5G_info_t       info;

  ReadAttributes(object);
  if (kind == H5I_DATASET) ReadDataset(object);
  if (kind != H5I_GROUP || depth == 0 || H5Gget_info(object, &info) < 0) return;
  for (hsize_t k = 0; k < info.nlinks; k++) {
    const hid_t below = H5Oopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT);
    char        name[256];

    (void)H5Lget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof(name), H5P_DEFAULT);
    if (below >= 0) ReadObject(below, depth - 1);
    if (below >= 0) (void)H5Oclose(below);
  }
}

/* Reads an object of that name and returns true, or false if there is none. */
static int ReadNamed(hid_t file, const char name[], int depth)
{
  const hid_t object = H5Oopen(file, name, H5P_DEFAULT);

  if (object < 0) return 0;
  ReadObject(object, depth);
  (void)H5Oclose(object);
  return 1;
}

/* Writes a character, without a buffer that a crash would lose. */
static void Tell(char what)
{
  if (write(STDOUT_FILENO, &what, 1) != 1) _exit(EXIT_FAILURE);
}

int main(int argc, char **argv)
{
  hid_t file;

  if (argc < 2) return EXIT_FAILURE;
  SetLimits(argv[1]);
  Tell('-');
#ifdef M_PERTURB
  (void)mallopt(M_PERTURB, 0x55); /* after an error HDF5 may use uninitialized memory; this makes it crash here */
#endif
  (void)setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1); /* the caller may have locked the file */
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  file = H5Fopen(argv[1], H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file >= 0 && argc == 2) (void)ReadNamed(file, "/", DEPTH);
  for (int k = 2; k < argc && file >= 0; k++) {
    if (!ReadNamed(file, argv[k], DEPTH) && k == 2)
      (void)ReadNamed(file, "/", 1); /* an error will list the objects in the file */
  }
  if (file >= 0) (void)H5Fclose(file);
  (void)H5close();
  Tell('\n');
  return EXIT_SUCCESS;
}

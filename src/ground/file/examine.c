/*
  A file is examined in a child process, as HDF5 may crash, or never end, on a damaged one: it follows the addresses in
  a file without end if they lead in a circle.
*/
#include "fileimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Seconds of CPU time, and one more for so many bytes: what is examined takes milliseconds. */
#define PATIENCE   2
#define BYTES_MORE (1 << 26)

/* A question about a file. */
typedef struct {
  const char *option, *filename;
  SamFileLook look;
  const void *question;
} Case;

/* The outcome of an examination, which ends with the answer. */
typedef struct {
  PetscErrorCode code;
  char           message[SAM_MESSAGE];
  double         answer[]; /* double for its alignment */
} Outcome;

/* Why a file cannot be read as HDF5, NULL if it can. A pipe would wait for its writer. */
static const char *FindFault(const char filename[])
{
  struct stat status;
  htri_t      hdf5;

  if (stat(filename, &status) || access(filename, R_OK)) return strerror(errno);
  if (!S_ISREG(status.st_mode)) return S_ISDIR(status.st_mode) ? strerror(EISDIR) : "it is not a file";
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hdf5 = H5Fis_hdf5(filename);
  return hdf5 > 0 ? NULL : "it is not an HDF5 file; make one by petsam-surface, of a body by petsam-compliance";
}

static const char damaged[] = "it is damaged";

static PetscErrorCode OpenAndLook(const Case *c, void *answer)
{
  const char    *fault = FindFault(c->filename);
  SamFile        file;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCheck(!fault, PETSC_COMM_SELF, SAM_ERR_FILE, SAM_CANNOT_READ, c->option, c->filename, fault);
  ierr = SamFileOpen(NULL, SAM_EVENT_OUTPUT, c->option, c->filename, SAM_FILE_READ, &file);
  PetscCheck(!ierr, PETSC_COMM_SELF, SAM_ERR_FILE, SAM_CANNOT_READ, c->option, c->filename, damaged);
  PetscCall(SamFileBegin(file));
  PetscCall(c->look(file, c->question, answer));
  PetscCall(SamFileEnd(file));
  PetscCall(SamFileDestroy(&file, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Examine(const Case *c, Outcome *outcome)
{
  (void)PetscPushErrorHandler(SamKeepMessage, outcome->message);
  outcome->code = OpenAndLook(c, outcome->answer);
  (void)PetscPopErrorHandler();
}

/* In the child: nothing is printed, a crash is a crash, and the system ends it after the time. */
static void Prepare(const char filename[])
{
  struct stat         status;
  const rlim_t        more = stat(filename, &status) ? 0 : (rlim_t)status.st_size / BYTES_MORE;
  const struct rlimit time = {PATIENCE + more, PATIENCE + more}, core = {0, 0};
  const int           nowhere = open("/dev/null", O_WRONLY);

  for (int k = 1; k < 32; k++) (void)signal(k, SIG_DFL);
  (void)setrlimit(RLIMIT_CPU, &time);
  (void)setrlimit(RLIMIT_CORE, &core);
  if (nowhere >= 0) (void)(dup2(nowhere, STDERR_FILENO) + dup2(nowhere, STDOUT_FILENO));
  (void)setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1); /* the parent may have locked the file */
}

/* Examines the file in a child process, or here if there is no memory for one. */
static void ExamineInChild(const Case *c, Outcome *outcome, size_t size)
{
  Outcome *shared = (Outcome *)mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  pid_t    child  = shared == MAP_FAILED ? -1 : fork();
  int      status = 0;

  if (child == 0) {
    Prepare(c->filename);
    Examine(c, shared);
    _exit(0);
  }
  if (child < 0) {
    Examine(c, outcome);
  } else {
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    memcpy(outcome, shared, size);
    if (!WIFEXITED(status) || WEXITSTATUS(status)) {
      outcome->code = SAM_ERR_FILE;
      (void)snprintf(outcome->message, sizeof(outcome->message), SAM_CANNOT_READ, c->option, c->filename, damaged);
    }
  }
  if (shared != MAP_FAILED) (void)munmap(shared, size);
}

PetscErrorCode SamFileExamine(MPI_Comm comm, const char option[], const char filename[], SamFileLook look,
                              const void *question, void *answer, size_t size)
{
  const Case     c     = {option, filename, look, question};
  const size_t   bytes = sizeof(Outcome) + size;
  Outcome       *outcome;
  PetscMPIInt    rank;
  PetscErrorCode code;
  char           message[SAM_MESSAGE];

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscCalloc(bytes, &outcome));
  if (rank == 0) ExamineInChild(&c, outcome, bytes);
  PetscCallMPI(MPI_Bcast(outcome, (PetscMPIInt)bytes, MPI_BYTE, 0, comm));
  memcpy(answer, outcome->answer, size);
  memcpy(message, outcome->message, sizeof(message));
  code = outcome->code;
  PetscCall(PetscFree(outcome));
  PetscCheck(!code, comm, code, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- where the data lie ---- */

/* True if all chunks that hold the first `extent` places in each dimension lie within a file of that size (bytes). */
static PetscBool ChunksAreWithin(hid_t dataset, hid_t creation, hsize_t size, const hsize_t extent[], PetscBool every)
{
  const hid_t space = H5Dget_space(dataset);
  const int   rank  = H5Sget_simple_extent_ndims(space);
  hsize_t     n[SAM_SHAPE_RANK], chunk[SAM_SHAPE_RANK], at[SAM_SHAPE_RANK] = {0};
  PetscBool   good = rank > 0 && rank <= SAM_SHAPE_RANK && H5Sget_simple_extent_dims(space, n, NULL) == rank &&
                   H5Pget_chunk(creation, rank, chunk) == rank;

  if (space >= 0) (void)H5Sclose(space);
  for (int d = 0; d < rank && good; d++) good = chunk[d] > 0;
  for (int d = 0; d < rank && good && extent; d++) n[d] = extent[d];
  for (int d = 0; d < rank && good; d++)
    if (n[d] == 0) return PETSC_TRUE;
  while (good && at[0] < n[0]) {
    haddr_t  address = HADDR_UNDEF;
    hsize_t  bytes   = 0;
    unsigned filters = 0;
    int      d       = rank - 1;

    good = H5Dget_chunk_info_by_coord(dataset, at, &filters, &address, &bytes) >= 0 &&
           (address == HADDR_UNDEF ? !every : address <= size && bytes <= size - address);
    for (at[d] += chunk[d]; d > 0 && at[d] >= n[d]; at[d] += chunk[d]) at[d--] = 0; /* the next one */
  }
  return good;
}

PetscBool SamFileIsWhole(SamFile f, hid_t dataset, const hsize_t extent[], PetscBool every)
{
  const hid_t        creation = H5Dget_create_plist(dataset);
  const H5D_layout_t layout   = creation >= 0 ? H5Pget_layout(creation) : H5D_LAYOUT_ERROR;
  hsize_t            size     = 0;
  PetscBool          good     = layout != H5D_LAYOUT_ERROR && H5Fget_filesize(f->id, &size) >= 0;

  if (good && layout == H5D_CHUNKED) {
    good = ChunksAreWithin(dataset, creation, size, extent, every);
  } else if (good && layout == H5D_CONTIGUOUS && !H5Pget_external_count(creation)) {
    const haddr_t address = H5Dget_offset(dataset);

    good = address == HADDR_UNDEF ? !every : address + H5Dget_storage_size(dataset) <= size;
  }
  if (creation >= 0) (void)H5Pclose(creation);
  return good;
}

/*
  The seal of a checkpoint: one checksum over all of its bytes, which is compared before HDF5 interprets any of them.
  HDF5's own checksums omit texts, and HDF5 might never return from a damaged file.

  The seal is a text in the user block, the SAM_SEAL bytes before HDF5's data. The file is hashed by blocks, each with
  its place; the sum of the hashes does not depend on the distribution of blocks over the ranks.
*/
#include "fileimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TITLE "petsam checkpoint "
#define BLOCK (1 << 20) /* bytes */

PetscBool SamSealIsOne(const char head[], size_t size)
{
  return size >= SAM_SEAL && !strncmp(head, TITLE, strlen(TITLE));
}

static uint64_t HashBlock(const unsigned char bytes[], size_t size, uint64_t place)
{
  return SamHashMix(SamHashBytes(SamHashMix(place + 1), bytes, size) + size);
}

/* Hashes every `stride`-th block of an open file from `first` on. Returns an errno or 0. */
static int HashBlocks(int file, off_t size, off_t first, off_t stride, uint64_t *sum)
{
  const off_t    blocks = (size - SAM_SEAL + BLOCK - 1) / BLOCK;
  unsigned char *bytes;
  int            error = 0;

  if (PetscMalloc1(BLOCK, &bytes)) return ENOMEM;
  for (off_t b = first; b < blocks && !error; b += stride) {
    const off_t  at   = SAM_SEAL + b * BLOCK;
    const size_t n    = (size_t)PetscMin((off_t)BLOCK, size - at);
    size_t       done = 0;

    while (done < n && !error) {
      const ssize_t got = pread(file, bytes + done, n - done, at + (off_t)done);

      if (got <= 0) error = got ? errno : EIO;
      if (got > 0) done += (size_t)got;
    }
    if (!error) *sum += HashBlock(bytes, n, (uint64_t)b);
  }
  (void)PetscFree(bytes);
  return error;
}

/* Computes the text of the seal for the present file, the same on all ranks; error: an errno or 0. */
static PetscErrorCode MakeSeal(MPI_Comm comm, const char filename[], char seal[SAM_SEAL], int *error)
{
  const int   file = open(filename, O_RDONLY | O_NONBLOCK);
  struct stat status;
  PetscMPIInt rank, ranks;
  uint64_t    sum = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  *error = file < 0 || fstat(file, &status) ? errno : S_ISREG(status.st_mode) ? 0 : EINVAL;
  if (!*error) *error = HashBlocks(file, status.st_size, rank, ranks, &sum);
  if (file >= 0) (void)close(file);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, error, 1, MPI_INT, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, comm));
  memset(seal, 0, SAM_SEAL);
  if (!*error)
    (void)snprintf(seal, SAM_SEAL, TITLE "%d\nbytes %lld\nchecksum %016llx\n", SAM_CHECKPOINT_FORMAT,
                   (long long)status.st_size, (unsigned long long)sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSealWrite(SamGrid grid, const char option[], const char filename[])
{
  char        seal[SAM_SEAL];
  PetscMPIInt rank;
  int         error, file;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(MakeSeal(grid->comm, filename, seal, &error));
  if (!error && rank == 0) {
    file  = open(filename, O_WRONLY);
    error = file < 0 || pwrite(file, seal, SAM_SEAL, 0) != SAM_SEAL ? (errno ? errno : EIO) : 0;
    if (file >= 0 && close(file) && !error) error = errno;
  }
  PetscCall(SamFileRaise(grid, option, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the seal of the file. Returns NULL, or the reason why there is none. */
static const char *ReadSeal(const char filename[], char seal[SAM_SEAL])
{
  static const char now[]              = TITLE PetscStringize(SAM_CHECKPOINT_FORMAT) "\n";
  const int                       file = open(filename, O_RDONLY | O_NONBLOCK);
  struct stat                     status;
  ssize_t                         n = 0;

  memset(seal, 0, SAM_SEAL);
  if (file < 0 || fstat(file, &status)) return strerror(errno);
  if (S_ISREG(status.st_mode)) n = pread(file, seal, SAM_SEAL, 0);
  (void)close(file);
  if (!S_ISREG(status.st_mode)) return S_ISDIR(status.st_mode) ? strerror(EISDIR) : "it is not a file";
  if (n < 0) return strerror(errno);
  if (!SamSealIsOne(seal, (size_t)n)) return "it is not a checkpoint";
  return strncmp(seal, now, strlen(now)) ? "it is damaged, or was written by another version of petsam" : NULL;
}

PetscErrorCode SamSealCheck(SamGrid grid, const char option[], const char filename[])
{
  char        text[128] = "", has[SAM_SEAL], should[SAM_SEAL];
  PetscMPIInt rank;
  const char *reason = NULL;
  int         error  = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (rank == 0) reason = ReadSeal(filename, has);
  if (reason) (void)snprintf(text, sizeof(text), "%s", reason);
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)sizeof(text), MPI_CHAR, 0, grid->comm));
  if (!text[0]) {
    PetscCall(MakeSeal(grid->comm, filename, should, &error));
    if (error)
      (void)snprintf(text, sizeof(text), "%s", strerror(error));
    else if (rank == 0 && memcmp(has, should, SAM_SEAL))
      (void)snprintf(text, sizeof(text), "it is damaged: its checksum is wrong");
    PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)sizeof(text), MPI_CHAR, 0, grid->comm));
  }
  PetscCheck(!text[0], grid->comm, SAM_ERR_FILE, SAM_CANNOT_READ, option, filename, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The slabs of memory in which transforms keep their half spectra.

  On a communicator only one transform is under way at a time, so all of them use the same slabs, as large as the
  largest transform so far. If all ranks are on one node, the slabs are in shared memory: columns are gathered directly
  from the rows, without messages. Otherwise, or without shared memory, every rank has its own slabs, and rows are
  exchanged for columns by FFTW's transposes.
*/
#include "fourierimpl.h"
#include <fcntl.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <unistd.h>

/* Attributes of a communicator: its workspace that may share memory, and its workspace that must send */
static PetscMPIInt keyvals[2] = {MPI_KEYVAL_INVALID, MPI_KEYVAL_INVALID};

static PetscErrorCode FreeKeyvals(void)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) PetscCallMPI(MPI_Comm_free_keyval(&keyvals[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateKeyvals(void)
{
  PetscFunctionBegin;
  if (keyvals[0] != MPI_KEYVAL_INVALID) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; k++)
    PetscCallMPI(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, MPI_COMM_NULL_DELETE_FN, &keyvals[k], NULL));
  PetscCall(PetscRegisterFinalize(FreeKeyvals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the workspace share memory if this is allowed and all ranks are on one node. */
static PetscErrorCode CanShare(SamWorkspace w)
{
  MPI_Comm    node;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_split_type(w->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  PetscCallMPI(MPI_Comm_size(node, &size));
  PetscCallMPI(MPI_Comm_free(&node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_INT, MPI_MIN, w->comm));
  w->shared = !w->send && w->ranks > 1 && size == w->ranks;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceGet(MPI_Comm comm, PetscBool send, SamWorkspace *workspace)
{
  SamWorkspace w;
  PetscMPIInt  found;

  PetscFunctionBegin;
  PetscCall(CreateKeyvals());
  PetscCallMPI(MPI_Comm_get_attr(comm, keyvals[send ? 1 : 0], &w, &found));
  if (!found) {
    PetscCall(PetscNew(&w));
    w->user = comm;
    w->send = send;
    PetscCallMPI(MPI_Comm_dup(comm, &w->comm));
    PetscCallMPI(MPI_Comm_size(comm, &w->ranks));
    PetscCallMPI(MPI_Comm_rank(comm, &w->rank));
    PetscCall(CanShare(w));
    PetscCallMPI(MPI_Comm_set_attr(comm, keyvals[send ? 1 : 0], w));
  }
  w->references++;
  *workspace = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeSlab(SamWorkspace w, SamSlab *slab)
{
  PetscFunctionBegin;
  if (slab->mapped) {
    (void)munmap(slab->of[0], slab->mapped);
    PetscCall(PetscFree(slab->of));
  } else
    SamFree(slab->own);
  *slab = (SamSlab){0};
  w->version++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceTrim(SamWorkspace w)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k <= SAM_FOURIER_FIELDS; k++)
    if (w->slab[k].bytes) PetscCall(FreeSlab(w, &w->slab[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceRelease(SamWorkspace *workspace)
{
  SamWorkspace w = *workspace;

  PetscFunctionBegin;
  *workspace = NULL;
  if (!w || --w->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWorkspaceTrim(w));
  PetscCallMPI(MPI_Comm_delete_attr(w->user, keyvals[w->send ? 1 : 0]));
  PetscCallMPI(MPI_Comm_free(&w->comm));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Creates a new shared memory object, which all ranks open under a temporary name; returns -1 if there is none.
*/
static PetscErrorCode OpenShared(SamWorkspace w, size_t bytes, int *fd)
{
  static unsigned count    = 0;
  char            name[64] = "";
  PetscMPIInt     good;

  PetscFunctionBegin;
  *fd = -1;
  if (w->rank == 0) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "/petsam-%ld-%u", (long)getpid(), count++));
    *fd = shm_open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
    if (*fd >= 0 && ftruncate(*fd, (off_t)bytes)) {
      (void)shm_unlink(name);
      (void)close(*fd);
      *fd = -1;
    }
    if (*fd < 0) name[0] = 0;
  }
  PetscCallMPI(MPI_Bcast(name, sizeof(name), MPI_CHAR, 0, w->comm));
  if (w->rank && name[0]) *fd = shm_open(name, O_RDWR, 0600);
  good = *fd >= 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, w->comm));
  if (w->rank == 0 && name[0]) (void)shm_unlink(name);
  if (!good && *fd >= 0) {
    (void)close(*fd);
    *fd = -1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Allocates a slab in shared memory, or none if that is exhausted. MPI_Win_allocate_shared is not used: if memory is
  short, Open MPI reports this on one rank only, and the others wait for ever.
*/
static PetscErrorCode AllocateShared(SamWorkspace w, size_t bytes, SamSlab *slab, PetscBool *done)
{
  const size_t page = (size_t)sysconf(_SC_PAGESIZE), part = (bytes + page - 1) / page * page;
  void        *base = MAP_FAILED;
  PetscMPIInt  good;
  int          fd;

  PetscFunctionBegin;
  PetscCall(OpenShared(w, part * (size_t)w->ranks, &fd));
  *done = PETSC_FALSE;
  if (fd < 0) PetscFunctionReturn(PETSC_SUCCESS);
  good = posix_fallocate(fd, (off_t)(part * (size_t)w->rank), (off_t)part) ==
         0; /* otherwise the first write to a full node would kill the process */
  if (good) base = mmap(NULL, part * (size_t)w->ranks, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  (void)close(fd);
  good = base != MAP_FAILED;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, w->comm));
  if (!good) {
    if (base != MAP_FAILED) (void)munmap(base, part * (size_t)w->ranks);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(w->ranks, &slab->of));
  for (PetscMPIInt r = 0; r < w->ranks; r++) slab->of[r] = (char *)base + part * (size_t)r;
  slab->own    = slab->of[w->rank];
  slab->mapped = part * (size_t)w->ranks;
  *done        = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceReserve(SamWorkspace w, size_t bytes, PetscInt fields)
{
  PetscFunctionBegin;
  PetscCheck(fields <= SAM_FOURIER_FIELDS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d fields in one pass",
             SAM_FOURIER_FIELDS);
  for (PetscInt k = 0; k < fields + (SamWorkspaceTransposes(w) ? 1 : 0); k++) {
    SamSlab  *slab = &w->slab[k];
    PetscBool done = PETSC_FALSE;

    if (slab->bytes >= bytes) continue;
    if (slab->bytes) PetscCall(FreeSlab(w, slab));
    if (w->shared) {
      PetscCall(AllocateShared(w, bytes, slab, &done));
      w->shared = done; /* slabs that are already shared stay shared, and are used as private ones */
    }
    if (!done) PetscCall(SamAllocate(bytes, &slab->own));
    slab->bytes = bytes;
    w->version++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceSynchronize(SamWorkspace w)
{
  PetscFunctionBegin;
  if (!w->shared) PetscFunctionReturn(PETSC_SUCCESS);
  atomic_thread_fence(memory_order_seq_cst);
  PetscCallMPI(MPI_Barrier(w->comm));
  atomic_thread_fence(memory_order_seq_cst);
  PetscFunctionReturn(PETSC_SUCCESS);
}

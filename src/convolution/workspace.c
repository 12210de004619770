/*
  The slabs of memory in which transforms keep their half spectra.

  On a communicator only one transform is under way at a time, so all of them use the same slabs, as large as the largest
  needs them. Where all ranks are on one node the slabs are in memory that they share: columns are gathered from where the
  rows are, and nothing is sent. Elsewhere, or when there is no such memory, every rank has its own, and rows are exchanged
  for columns by FFTW's transposes.
*/
#include "fourierimpl.h"
#include <stdlib.h>
#include <string.h>

static const char *const exchanges[] = {"auto", "transpose", NULL};

static PetscMPIInt keyval = MPI_KEYVAL_INVALID;

static PetscErrorCode FreeKeyval(void)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_free_keyval(&keyval));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether all ranks are on one node, and the user does not want it otherwise. */
static PetscErrorCode CanShare(SamWorkspace w)
{
  PetscInt    exchange = 0;
  MPI_Comm    node;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCall(SamOptionsEnum(NULL, "fft_exchange", "how ranks of one node see each other's rows: auto (in shared memory) or transpose (by messages)", exchanges, &exchange, NULL));
  PetscCallMPI(MPI_Comm_split_type(w->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  PetscCallMPI(MPI_Comm_size(node, &size));
  PetscCallMPI(MPI_Comm_free(&node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_INT, MPI_MIN, w->comm));
  w->shared = (exchange == 0 && w->ranks > 1 && size == w->ranks) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceGet(MPI_Comm comm, size_t bytes, SamWorkspace *workspace)
{
  SamWorkspace w;
  PetscMPIInt  found;
  unsigned long long most = bytes;

  PetscFunctionBegin;
  if (keyval == MPI_KEYVAL_INVALID) {
    PetscCallMPI(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, MPI_COMM_NULL_DELETE_FN, &keyval, NULL));
    PetscCall(PetscRegisterFinalize(FreeKeyval));
  }
  PetscCallMPI(MPI_Comm_get_attr(comm, keyval, &w, &found));
  if (!found) {
    PetscCall(PetscNew(&w));
    w->user = comm;
    PetscCallMPI(MPI_Comm_dup(comm, &w->comm));
    PetscCallMPI(MPI_Comm_set_errhandler(w->comm, MPI_ERRORS_RETURN)); /* without shared memory there is another way */
    PetscCallMPI(MPI_Comm_size(comm, &w->ranks));
    PetscCallMPI(MPI_Comm_rank(comm, &w->rank));
    PetscCall(CanShare(w));
    PetscCallMPI(MPI_Comm_set_attr(comm, keyval, w));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_UNSIGNED_LONG_LONG, MPI_MAX, w->comm));
  w->references++;
  w->bytes   = PetscMax(w->bytes, (size_t)most);
  *workspace = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeSlab(SamWorkspace w, SamSlab *slab)
{
  PetscFunctionBegin;
  if (slab->window != MPI_WIN_NULL && slab->bytes) {
    PetscCallMPI(MPI_Win_unlock_all(slab->window));
    PetscCallMPI(MPI_Win_free(&slab->window));
    PetscCall(PetscFree(slab->of));
  } else free(slab->own);
  slab->own   = NULL;
  slab->bytes = 0;
  w->version++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceRelease(SamWorkspace *workspace)
{
  SamWorkspace w = *workspace;

  PetscFunctionBegin;
  *workspace = NULL;
  if (!w || --w->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k <= SAM_FOURIER_FIELDS; k++)
    if (w->slab[k].bytes) PetscCall(FreeSlab(w, &w->slab[k]));
  PetscCallMPI(MPI_Comm_delete_attr(w->user, keyval));
  PetscCallMPI(MPI_Comm_free(&w->comm));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first whole cache line of a rank's part: the same place for all, since their views begin with whole pages. */
static void *Align(void *pointer)
{
  return (void *)(((uintptr_t)pointer + 63) / 64 * 64);
}

/* A slab in shared memory, or none when there is no more of it. */
static PetscErrorCode AllocateShared(SamWorkspace w, SamSlab *slab, PetscBool *done)
{
  MPI_Info    info;
  void       *base = NULL;
  PetscMPIInt good;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Info_create(&info));
  PetscCallMPI(MPI_Info_set(info, "alloc_shared_noncontig", "true"));
  good = MPI_Win_allocate_shared((MPI_Aint)w->bytes + 64, 1, info, w->comm, &base, &slab->window) == MPI_SUCCESS;
  PetscCallMPI(MPI_Info_free(&info));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, w->comm));
  *done = good ? PETSC_TRUE : PETSC_FALSE;
  if (!good) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(w->ranks, &slab->of));
  for (PetscMPIInt r = 0; r < w->ranks; r++) {
    MPI_Aint    size;
    PetscMPIInt unit;

    PetscCallMPI(MPI_Win_shared_query(slab->window, r, &size, &unit, &base));
    slab->of[r] = Align(base);
  }
  slab->own = slab->of[w->rank];
  PetscCallMPI(MPI_Win_lock_all(MPI_MODE_NOCHECK, slab->window));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceReserve(SamWorkspace w, PetscInt fields)
{
  PetscFunctionBegin;
  PetscCheck(fields <= SAM_FOURIER_FIELDS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d fields in one pass", SAM_FOURIER_FIELDS);
  for (PetscInt k = 0; k < fields + (SamWorkspaceTransposes(w) ? 1 : 0); k++) {
    SamSlab  *slab = &w->slab[k];
    PetscBool done = PETSC_FALSE;

    if (slab->bytes == w->bytes) continue;
    if (slab->bytes) PetscCall(FreeSlab(w, slab));
    slab->window = MPI_WIN_NULL;
    if (w->shared) {
      PetscCall(AllocateShared(w, slab, &done));
      w->shared = done; /* what is shared by now stays so, and is used as if it were not */
    }
    if (!done) PetscCall(SamFourierAllocate(w->bytes, &slab->own));
    slab->bytes = w->bytes;
    w->version++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWorkspaceSynchronize(SamWorkspace w)
{
  PetscFunctionBegin;
  if (!w->shared) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k <= SAM_FOURIER_FIELDS; k++)
    if (w->slab[k].bytes) PetscCallMPI(MPI_Win_sync(w->slab[k].window));
  PetscCallMPI(MPI_Barrier(w->comm));
  for (PetscInt k = 0; k <= SAM_FOURIER_FIELDS; k++)
    if (w->slab[k].bytes) PetscCallMPI(MPI_Win_sync(w->slab[k].window));
  PetscFunctionReturn(PETSC_SUCCESS);
}

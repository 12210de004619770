/*
  An HDF5 file that all ranks write or read together through MPI-IO.

  Open MPI's collective writes, and HDF5 when it flushes its metadata, may hang for ever if writing fails on one rank
  only. So rank 0 checks for the likely failures before MPI-IO is used (disk.c). The file is then still consistent and
  can be closed.
*/
#include "fileimpl.h"
#include <petsam/private/grid.h>
#include <math.h>

/* ---- errors ---- */

/* HDF5 prints its own error stack unless that is disabled. */
PetscErrorCode SamFileBegin(SamFile f)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[f->event], 0, 0, 0, 0));
  (void)SamFileNote(f, H5Eget_auto2(H5E_DEFAULT, &f->print, &f->print_data));
  (void)SamFileNote(f, H5Eset_auto2(H5E_DEFAULT, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileAgree(SamFile f)
{
  struct {
    int good, rank;
  } worst;

  PetscFunctionBegin;
  worst.good = f->failed ? 0 : 1;
  worst.rank = f->rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_2INT, MPI_MINLOC, f->comm));
  if (!worst.good) {
    f->failed = PETSC_TRUE;
    PetscCallMPI(MPI_Bcast(f->reason, (PetscMPIInt)sizeof(f->reason), MPI_CHAR, worst.rank, f->comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileEnd(SamFile f)
{
  PetscFunctionBegin;
  (void)SamFileNote(f, H5Eset_auto2(H5E_DEFAULT, f->print, f->print_data));
  PetscCall(PetscLogEventEnd(SamEvents[f->event], 0, 0, 0, 0));
  PetscCall(SamFileAgree(f));
  PetscCheck(!f->failed, f->comm, SAM_ERR_FILE, "-%s %s: cannot be %s: %s", f->option, f->filename,
             f->writing ? "written" : "read", f->reason);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the cause, which is the first entry of an upward walk through HDF5's error stack. */
static herr_t TakeReason(unsigned n, const H5E_error2_t *error, void *reason)
{
  if (n == 0 && error->desc) (void)snprintf((char *)reason, sizeof(((SamFile)NULL)->reason), "%s", error->desc);
  return 0;
}

hid_t SamFileNote(SamFile f, hid_t result)
{
  if (result >= 0 || f->failed) return result;
  f->failed = PETSC_TRUE;
  (void)snprintf(f->reason, sizeof(f->reason), "HDF5 failed");
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, TakeReason, f->reason);
  return result;
}

/* ---- the file ---- */

/*
  Half of the entries of a node of the indices of chunks, so that one node has room for all chunks, if it can. A node is
  written as a whole whenever a chunk is added, and each dataset has a node of that size, however few its chunks are.
*/
#define HALF_NODE    32   /* HDF5's own */
#define MOST_HALF    512  /* a node of 49 kB: all nodes of a file must be far fewer bytes than MOST_CHANGED */
#define FIELD_ENTRY  48.0 /* bytes of an entry with three dimensions, */
#define SERIES_ENTRY 32.0 /* and with one */
static unsigned HalfNode(const SamFileGrowth *growth)
{
  return (unsigned)PetscClipInterval(growth ? ceil(0.5 * growth->chunks) : 0, HALF_NODE, MOST_HALF);
}

double SamFileIndexBytes(const SamFileGrowth *growth)
{
  return growth ? 2.0 * (double)(HalfNode(growth) - HALF_NODE) *
                    (FIELD_ENTRY * (double)growth->fields + SERIES_ENTRY * (double)growth->series)
                : 0;
}

/*
  Lets HDF5 write its metadata only when the file is flushed. By itself it also does so whenever so many bytes of them
  have changed since the last time. That is in the middle of a step, and as the ranks count these bytes differently,
  some begin, wait for the others, and none goes on (HDF5 1.10.8, at 256 kB).
*/
#define MOST_CHANGED (32 << 20) /* bytes; HDF5 allows no more */
static void WriteOnlyInFlushes(SamFile f, hid_t access)
{
  H5AC_cache_config_t cache = {.version = H5AC__CURR_CACHE_CONFIG_VERSION};

  (void)SamFileNote(f, H5Pget_mdc_config(access, &cache));
  cache.dirty_bytes_threshold = MOST_CHANGED;
  (void)SamFileNote(f, H5Pset_mdc_config(access, &cache));
}

/* Opens a file. Reading is not collective: it may fail on some ranks for a damaged file, and no other rank must
   wait. */
static PetscErrorCode OpenFile(SamFile f, SamFileMode mode, const SamFileGrowth *growth)
{
  hid_t access, creation;

  PetscFunctionBegin;
  if (SamFileIndexBytes(growth) > 0) PetscCall(SamFileCheckRoom(f, SamFileIndexBytes(growth)));
  PetscCall(SamFileBegin(f));
  access = SamFileNote(f, H5Pcreate(H5P_FILE_ACCESS));
  if (f->grid) (void)SamFileNote(f, H5Pset_fapl_mpio(access, f->comm, MPI_INFO_NULL));
#if H5_VERSION_GE(1, 10, 7) && !(H5_VERS_MINOR == 12 && H5_VERS_RELEASE == 0)
  if (!f->grid) (void)SamFileNote(f, H5Pset_file_locking(access, 0, 1)); /* MPI-IO does not lock the file either */
#endif
  (void)SamFileNote(f, H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  if (f->writing) WriteOnlyInFlushes(f, access);
  creation = SamFileNote(f, H5Pcreate(H5P_FILE_CREATE));
  if (mode == SAM_FILE_CREATE_SEALED) (void)SamFileNote(f, H5Pset_userblock(creation, SAM_SEAL));
  if (HalfNode(growth) > HALF_NODE) (void)SamFileNote(f, H5Pset_istore_k(creation, HalfNode(growth)));
  f->transfer = SamFileNote(f, H5Pcreate(H5P_DATASET_XFER));
  if (f->writing) (void)SamFileNote(f, H5Pset_dxpl_mpio(f->transfer, H5FD_MPIO_COLLECTIVE));
  if (f->writing)
    f->id = SamFileNote(f, H5Fcreate(f->filename, H5F_ACC_TRUNC, creation, access));
  else
    f->id = SamFileNote(f, H5Fopen(f->filename, H5F_ACC_RDONLY, access));
  (void)SamFileNote(f, H5Pclose(access));
  (void)SamFileNote(f, H5Pclose(creation));
  if (f->grid) SamFileRemoveLeftOvers(f);
  PetscCall(SamFileEnd(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileOpen(SamGrid grid, SamEvent event, const char option[], const char filename[], SamFileMode mode,
                           const SamFileGrowth *growth, SamFile *file)
{
  SamFile        f;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscNew(&f));
  if (grid) PetscCall(SamGridReference(grid));
  f->comm    = grid ? grid->comm : PETSC_COMM_SELF;
  f->grid    = grid;
  f->event   = event;
  f->option  = option;
  f->writing = mode != SAM_FILE_READ;
  f->id = f->transfer = -1;
  PetscCallMPI(MPI_Comm_rank(f->comm, &f->rank));
  PetscCall(PetscStrallocpy(filename, &f->filename));
  ierr = OpenFile(f, mode, growth);
  if (ierr) {
    f->id = -1; /* left open, as closing would wait for a rank that could not open the file */
    (void)SamFileDestroy(&f, PETSC_TRUE);
  }
  *file = f;
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFileClose(SamFile f)
{
  if (f->transfer >= 0) (void)SamFileNote(f, H5Pclose(f->transfer));
  if (f->id >= 0) (void)SamFileNote(f, H5Fclose(f->id));
  f->transfer = f->id = -1;
}

PetscErrorCode SamFileDestroy(SamFile *file, PetscBool close)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  if (!*file) PetscFunctionReturn(PETSC_SUCCESS);
  (*file)->failed = PETSC_FALSE; /* earlier failures have been raised */
  PetscCall(SamFileBegin(*file));
  if (close) SamFileClose(*file);
  ierr = SamFileEnd(*file);
  PetscCall(SamGridDestroy(&(*file)->grid));
  PetscCall(PetscFree((*file)->filename));
  PetscCall(PetscFree(*file));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

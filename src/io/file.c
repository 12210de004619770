/*
  An HDF5 file that all ranks write or read together through MPI-IO.

  Open MPI's collective writes, and HDF5 when it flushes its metadata, may hang for ever if writing fails on one rank
  only. So rank 0 looks for the likely failures before MPI-IO meets them (disk.c). The file is then still consistent and
  can be closed.
*/
#include "ioimpl.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- errors ---- */

/* HDF5 prints its own error stack unless that is switched off. */
static void Silence(SamFile f)
{
  (void)SamFileNote(f, H5Eget_auto2(H5E_DEFAULT, &f->print, &f->print_data));
  (void)SamFileNote(f, H5Eset_auto2(H5E_DEFAULT, NULL, NULL));
}

static void Unsilence(SamFile f)
{
  (void)SamFileNote(f, H5Eset_auto2(H5E_DEFAULT, f->print, f->print_data));
}

PetscErrorCode SamFileBegin(SamFile f)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[f->event], 0, 0, 0, 0));
  Silence(f);
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
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_2INT, MPI_MINLOC, f->grid->comm));
  if (!worst.good) {
    f->failed = PETSC_TRUE;
    PetscCallMPI(MPI_Bcast(f->reason, (PetscMPIInt)sizeof(f->reason), MPI_CHAR, worst.rank, f->grid->comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileEnd(SamFile f)
{
  PetscFunctionBegin;
  Unsilence(f);
  PetscCall(PetscLogEventEnd(SamEvents[f->event], 0, 0, 0, 0));
  PetscCall(SamFileAgree(f));
  PetscCheck(!f->failed, f->grid->comm, SAM_ERR_FILE, "-%s %s: cannot be %s: %s", f->option, f->filename,
             f->writing ? "written" : "read", f->reason);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first entry of an upward walk through HDF5's error stack is the cause. */
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

static PetscErrorCode Allocate(SamGrid grid, SamEvent event, const char option[], const char filename[], SamFile *file)
{
  SamFile f;

  PetscFunctionBegin;
  PetscCall(PetscNew(&f));
  PetscCall(SamGridReference(grid));
  f->grid   = grid;
  f->event  = event;
  f->option = option;
  f->id = f->transfer = -1;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &f->rank));
  PetscCall(PetscStrallocpy(filename, &f->filename));
  *file = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Free(SamFile *file)
{
  PetscFunctionBegin;
  PetscCall(SamGridDestroy(&(*file)->grid));
  PetscCall(PetscFree((*file)->filename));
  PetscCall(PetscFree(*file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define NOT_HDF5 (-1)

PetscErrorCode SamFileExamine(MPI_Comm comm, const char option[], const char filename[], PetscBool writing)
{
  struct stat status;
  PetscMPIInt rank;
  int         error = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    if (stat(filename, &status) || access(filename, writing ? R_OK | W_OK : R_OK))
      error = errno;
    else if (!S_ISREG(status.st_mode))
      error = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
    else {
      H5E_auto2_t print;
      void       *data;

      (void)H5Eget_auto2(H5E_DEFAULT, &print, &data);
      (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
      if (H5Fis_hdf5(filename) <= 0) error = NOT_HDF5;
      (void)H5Eset_auto2(H5E_DEFAULT, print, data);
    }
  }
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  PetscCheck(!error, comm, SAM_ERR_FILE, "-%s %s: cannot be %s: %s", option, filename, writing ? "written" : "read",
             error == NOT_HDF5 ? "it is not an HDF5 file" : strerror(error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsOld(SamFileMode mode)
{
  return (mode == SAM_FILE_CREATE || mode == SAM_FILE_CREATE_SEALED) ? PETSC_FALSE : PETSC_TRUE;
}

/* Reading is not collective: in a damaged file it may fail on some ranks, and no other shall wait for these. */
static PetscErrorCode OpenFile(SamFile f, SamFileMode mode)
{
  hid_t access, creation;

  PetscFunctionBegin;
  if (IsOld(mode)) PetscCall(SamFileExamine(f->grid->comm, f->option, f->filename, f->writing));
  PetscCall(SamFileBegin(f));
  access = SamFileNote(f, H5Pcreate(H5P_FILE_ACCESS));
  if (mode != SAM_FILE_READ_ALONE) (void)SamFileNote(f, H5Pset_fapl_mpio(access, f->grid->comm, MPI_INFO_NULL));
  (void)SamFileNote(f, H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  creation = SamFileNote(f, H5Pcreate(H5P_FILE_CREATE));
  if (mode == SAM_FILE_CREATE_SEALED) (void)SamFileNote(f, H5Pset_userblock(creation, SAM_SEAL));
  f->transfer = SamFileNote(f, H5Pcreate(H5P_DATASET_XFER));
  if (f->writing) (void)SamFileNote(f, H5Pset_dxpl_mpio(f->transfer, H5FD_MPIO_COLLECTIVE));
  if (IsOld(mode))
    f->id = SamFileNote(f, H5Fopen(f->filename, f->writing ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access));
  else
    f->id = SamFileNote(f, H5Fcreate(f->filename, H5F_ACC_TRUNC, creation, access));
  (void)SamFileNote(f, H5Pclose(access));
  (void)SamFileNote(f, H5Pclose(creation));
  SamFileRemoveLeftOvers(f);
  PetscCall(SamFileEnd(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileOpen(SamGrid grid, SamEvent event, const char option[], const char filename[], SamFileMode mode,
                           SamFile *file)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(Allocate(grid, event, option, filename, file));
  (*file)->writing = mode == SAM_FILE_READ || mode == SAM_FILE_READ_ALONE ? PETSC_FALSE : PETSC_TRUE;
  ierr             = OpenFile(*file, mode);
  if (ierr) {
    (*file)->id = -1; /* not closed: closing would wait for a rank that could not open the file */
    Silence(*file);
    SamFileClose(*file);
    Unsilence(*file);
    PetscCall(Free(file));
  }
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
  (*file)->failed = PETSC_FALSE; /* what failed before has been raised */
  PetscCall(SamFileBegin(*file));
  if (close) SamFileClose(*file);
  ierr = SamFileEnd(*file);
  PetscCall(Free(file));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

/* Texts are stored with variable length, which h5py reads as str. */
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

/* ---- fields ---- */

/* Selects this rank's rows of a layer; a rank without rows takes part with an empty selection. */
static void SelectLayer(SamFile f, hid_t dataset, hsize_t layer, hid_t *space, hid_t *memory)
{
  const SamGrid grid     = f->grid;
  const hsize_t start[3] = {layer, (hsize_t)grid->row_start, 0};
  const hsize_t count[3] = {1, (hsize_t)grid->rows, (hsize_t)grid->nx};

  *memory = SamFileNote(f, H5Screate_simple(3, count, NULL));
  *space  = SamFileNote(f, H5Dget_space(dataset));
  if (grid->rows) {
    (void)SamFileNote(f, H5Sselect_hyperslab(*space, H5S_SELECT_SET, start, NULL, count, NULL));
  } else {
    (void)SamFileNote(f, H5Sselect_none(*space));
    (void)SamFileNote(f, H5Sselect_none(*memory));
  }
}

hid_t SamFileCreateDataset(SamFile f, hid_t where, const SamOutputLabel *label, hid_t type, const SamShape *shape,
                           PetscInt compress)
{
  const hid_t space    = SamFileNote(f, H5Screate_simple(shape->rank, shape->size, shape->largest)),
              creation = SamFileNote(f, H5Pcreate(H5P_DATASET_CREATE));
  hid_t dataset;

  if (shape->chunk[0]) (void)SamFileNote(f, H5Pset_chunk(creation, shape->rank, shape->chunk));
  /* every value is written, so filling would only write them twice */
  (void)SamFileNote(f, H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER));
  if (compress > 0) {
    (void)SamFileNote(f, H5Pset_shuffle(creation));
    (void)SamFileNote(f, H5Pset_deflate(creation, (unsigned)compress));
  }
  dataset = SamFileNote(f, H5Dcreate2(where, label->name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  SamFileWriteTextAttribute(f, dataset, "units", label->units);
  SamFileWriteTextAttribute(f, dataset, "long_name", label->long_name);
  (void)SamFileNote(f, H5Pclose(creation));
  (void)SamFileNote(f, H5Sclose(space));
  return dataset;
}

void SamFileWriteSeries(SamFile f, hid_t dataset, const double values[])
{
  const hid_t space = SamFileNote(f, H5Dget_space(dataset));

  if (f->rank) (void)SamFileNote(f, H5Sselect_none(space));
  (void)SamFileNote(f, H5Dwrite(dataset, H5T_NATIVE_DOUBLE, space, space, f->transfer, values));
  (void)SamFileNote(f, H5Sclose(space));
}

void SamFileWriteLayer(SamFile f, hid_t dataset, hid_t type, hsize_t layer, const void *values)
{
  const double nothing = 0;
  hid_t        space, memory;

  SelectLayer(f, dataset, layer, &space, &memory);
  (void)SamFileNote(f, H5Dwrite(dataset, type, memory, space, f->transfer, f->grid->rows ? values : &nothing));
  (void)SamFileNote(f, H5Sclose(space));
  (void)SamFileNote(f, H5Sclose(memory));
}

void SamFileReadLayer(SamFile f, hid_t dataset, hid_t type, hsize_t layer, void *values)
{
  double nothing;
  hid_t  space, memory;

  SelectLayer(f, dataset, layer, &space, &memory);
  (void)SamFileNote(f, H5Dread(dataset, type, memory, space, f->transfer, f->grid->rows ? values : &nothing));
  (void)SamFileNote(f, H5Sclose(space));
  (void)SamFileNote(f, H5Sclose(memory));
}

/*
  Recorded steps beyond a limit of memory: they wait in a file of this rank, which has no name and so ends with the
  program, in the folder TMPDIR, or /tmp.
*/
#include "gradientimpl.h"
#include <petsam/private/contact.h>
#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

static const char *Folder(void)
{
  const char *folder = getenv("TMPDIR");

  return folder && folder[0] ? folder : "/tmp";
}

/* The three arrays of a record, and their sizes in bytes */
typedef struct {
  void  *array[3];
  size_t size[3], all;
} Arrays;

static Arrays ArraysOf(const SamRecord *r)
{
  const size_t n = (size_t)r->count;
  Arrays       a = {{r->cell, r->value, r->slope},
                    {n * sizeof(*r->cell), SAM_RECORD_BY_BACK * n * sizeof(*r->value),
                     (SAM_RECORD_VALUES - SAM_RECORD_BY_BACK) * n * sizeof(*r->slope)},
                    0};

  for (int k = 0; k < 3; k++) a.all += a.size[k];
  return a;
}

/* Opens the file of this rank; returns false, with errno, if that is not possible. */
static PetscBool Open(SamGradient g)
{
  char name[PETSC_MAX_PATH_LEN];
  int  file;

  if (g->file) return PETSC_TRUE;
  (void)snprintf(name, sizeof(name), "%s/petsam-XXXXXX", Folder());
  file = mkstemp(name);
  if (file < 0) return PETSC_FALSE;
  (void)unlink(name);
  g->file = fdopen(file, "w+b");
  return g->file ? PETSC_TRUE : PETSC_FALSE;
}

/* Writes a record to the end of the file, or reads it; returns false, with errno, if that fails. */
static PetscBool Transfer(SamGradient g, const SamRecord *r, PetscBool write)
{
  const Arrays a = ArraysOf(r);

  errno = 0;
  if (fseeko(g->file, r->at, SEEK_SET)) return PETSC_FALSE;
  for (int k = 0; k < 3; k++) {
    const size_t done = write ? fwrite(a.array[k], 1, a.size[k], g->file) : fread(a.array[k], 1, a.size[k], g->file);

    if (done != a.size[k]) return PETSC_FALSE;
  }
  return !write || fflush(g->file) == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Lets all ranks fail if one of them has. */
static PetscErrorCode Check(SamGradient g, PetscBool good)
{
  const MPI_Comm comm  = SamContactGetGrid(g->contact)->comm;
  double         fault = good ? 0 : errno ? errno : EIO;

  PetscFunctionBegin;
  PetscCall(SamMax(comm, 1, &fault));
  PetscCheck(fault == 0, comm, SAM_ERR_FILE,
             "the recorded steps beyond -gradient_memory cannot be kept in a file in %s (TMPDIR): %s", Folder(),
             strerror((int)fault));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStoreKeep(SamGradient g, SamRecord *r)
{
  const double bytes = (double)ArraysOf(r).all;
  double       most  = g->limit > 0 && g->kept + bytes > g->limit ? 1 : 0;
  PetscBool    good;

  PetscFunctionBegin;
  PetscCall(SamMax(SamContactGetGrid(g->contact)->comm, 1, &most)); /* a step waits on all ranks, or on none */
  if (most == 0) {
    g->kept += bytes;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  r->at = g->end;
  good  = Open(g) && Transfer(g, r, PETSC_TRUE);
  PetscCall(Check(g, good));
  g->end += (off_t)bytes;
  r->stored = PETSC_TRUE;
  PetscCall(PetscFree3(r->cell, r->value, r->slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStoreTake(SamGradient g, SamRecord *r)
{
  PetscFunctionBegin;
  if (!r->stored) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamRecordAllocate(r));
  PetscCall(Check(g, Transfer(g, r, PETSC_FALSE)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStoreLeave(SamRecord *r)
{
  PetscFunctionBegin;
  if (r->stored) PetscCall(PetscFree3(r->cell, r->value, r->slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamStoreForget(SamGradient g)
{
  if (g->file) (void)fclose(g->file);
  g->file = NULL;
  g->end  = 0;
  g->kept = 0;
}

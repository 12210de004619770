/* The names of all files of a run, and of those that PETSc writes for its viewers. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/compliance.h>
#include <petsam/private/file.h>
#include <petsam/private/runfiles.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

PetscErrorCode SamFilesAdd(SamFiles *f, const char option[], const char name[], PetscBool written)
{
  PetscFunctionBegin;
  PetscCheck(f->count < SAM_FILES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "More than %d files", SAM_FILES);
  f->list[f->count] = (SamNamedFile){.option = option, .written = written};
  PetscCall(PetscStrallocpy(name, &f->list[f->count++].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a name that is derived from that of a file, and frees it. */
static PetscErrorCode AddDerived(SamFiles *f, const char option[], char *name)
{
  PetscFunctionBegin;
  PetscCall(SamFilesAdd(f, option, name, PETSC_TRUE));
  f->list[f->count - 1].derived = PETSC_TRUE;
  PetscCall(PetscFree(name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFilesAddWritten(SamFiles *f, const char option[], const char name[], char *derived, char *other)
{
  PetscFunctionBegin;
  PetscCall(SamFilesAdd(f, option, name, PETSC_TRUE));
  PetscCall(AddDerived(f, option, derived));
  PetscCall(AddDerived(f, option, other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFilesFind(MPI_Comm comm, const char name[], PetscBool *there)
{
  double bytes;

  PetscFunctionBegin;
  PetscCall(SamFileGetBytes(comm, name, &bytes));
  *there = bytes >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFilesAddOutput(SamFiles *f, const char name[])
{
  char *temporary;

  PetscFunctionBegin;
  PetscCall(SamFileNameTemporary(name, &temporary));
  PetscCall(SamFilesAdd(f, "-output", name, PETSC_TRUE));
  PetscCall(AddDerived(f, "-output", temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if two names denote the same file; files that do not exist yet are compared by folder and name. */
static PetscBool IsSameFile(const char a[], const char b[])
{
  const char *const names[2] = {a, b};
  char              folder[2][PETSC_MAX_PATH_LEN], *real[2];
  const char       *last[2];
  struct stat       one, other;
  PetscBool         same;

  if (!strcmp(a, b)) return PETSC_TRUE;
  if (!stat(a, &one) && !stat(b, &other)) return one.st_dev == other.st_dev && one.st_ino == other.st_ino;
  for (int k = 0; k < 2; k++) {
    const char *slash = strrchr(names[k], '/');

    last[k] = slash ? slash + 1 : names[k];
    SamGetFolder(names[k], folder[k]);
    real[k] = realpath(folder[k], NULL);
  }
  same = real[0] && real[1] && !strcmp(real[0], real[1]) && !strcmp(last[0], last[1]);
  free(real[0]);
  free(real[1]);
  return same;
}

/* ---- files that PETSc writes ---- */

static const char *const own[] = {"-log_view", "-memory_view"}; /* PETSc's own options, which no row declares */

static PetscBool IsViewerFormat(const char text[])
{
  for (PetscInt k = 0; PetscViewerFormats[k] && strcmp(PetscViewerFormats[k], "PetscViewerFormat"); k++)
    if (!strcasecmp(PetscViewerFormats[k], text)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Returns 0 if the file can be written, else errno; PETSc would report a failure on one rank only. Not collective. */
static int CheckPlace(const char name[])
{
  char        folder[PETSC_MAX_PATH_LEN];
  struct stat status;

  if (!stat(name, &status)) return S_ISDIR(status.st_mode) ? EISDIR : access(name, W_OK) ? errno : 0;
  SamGetFolder(name, folder);
  return SamFileCheckFolder(folder, W_OK | X_OK);
}

/* Checks -options_view, which PETSc reads twice: once as a viewer and once as a logical value. */
static PetscErrorCode CheckOptionsView(MPI_Comm comm)
{
  char      value[PETSC_MAX_PATH_LEN] = "";
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-options_view", value, sizeof(value), &set));
  PetscCheck(!value[0], comm, SAM_ERR_USER, "-options_view %s: expected no value", value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the file of a viewer; its option's value is type:file:format:mode, of which each may be missing. The type is
   ascii. */
static PetscErrorCode AddViewer(MPI_Comm comm, const char option[], SamFiles *files)
{
  char        value[PETSC_MAX_PATH_LEN] = "", *part[4] = {value, NULL, NULL, NULL};
  char        shown[PETSC_MAX_PATH_LEN];
  PetscBool   set;
  PetscMPIInt rank;
  int         error = 0;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, option, value, sizeof(value), &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(shown, value, sizeof(shown)));
  for (int k = 1; k < 4 && part[k - 1]; k++) {
    part[k] = strchr(part[k - 1], ':');
    if (part[k]) *part[k]++ = '\0';
  }
  PetscCheck(!part[0][0] || !strcmp(part[0], "ascii"), comm, SAM_ERR_USER,
             "%s %s: expected nothing, ascii, :file or :file:format", option, shown);
  PetscCheck(!part[2] || !part[2][0] || IsViewerFormat(part[2]), comm, SAM_ERR_USER,
             "%s %s: unknown format %s, expected for example ascii_info or ascii_xml", option, shown, part[2]);
  PetscCheck(!part[3] || !strcmp(part[3], "write") || !strcmp(part[3], "append"), comm, SAM_ERR_USER,
             "%s %s: unknown mode %s, expected write or append", option, shown, part[3]);
  if (!part[1] || !part[1][0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) error = CheckPlace(part[1]);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  PetscCheck(!error, comm, SAM_ERR_FILE, "%s %s: cannot be written: %s", option, part[1], strerror(error));
  PetscCall(SamFilesAdd(files, option, part[1], PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all files ---- */

/* True if the files of an option, with the names derived from it, have already been added. */
static PetscBool Has(const SamFiles *f, const char option[])
{
  for (PetscInt k = 0; k < f->count; k++)
    if (!strcmp(f->list[k].option, option)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Adds the files that an option names by its declaration. */
static PetscErrorCode AddDeclared(SamFiles *f, MPI_Comm comm, const SamOptionFile *one)
{
  char      value[PETSC_MAX_PATH_LEN] = "", **list;
  PetscBool set;
  int       count;

  PetscFunctionBegin;
  if (one->kind == SAM_OPTION_VIEWER) PetscCall(AddViewer(comm, one->name, f));
  if (one->kind == SAM_OPTION_VIEWER || Has(f, one->shown)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsGetString(NULL, NULL, one->name, value, sizeof(value), &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrToArray(value, one->kind == SAM_OPTION_FILES ? ',' : '\n', &count, &list));
  for (int k = 0; k < count; k++) {
    PetscInt  patch, lower;
    PetscBool local;

    if (one->kind == SAM_OPTION_FILE) list[k][SamComplianceFileName(list[k], &patch, &local, &lower)] = '\0';
    PetscCall(SamFilesAdd(f, one->shown, list[k], one->kind == SAM_OPTION_OUTPUT ? PETSC_TRUE : PETSC_FALSE));
  }
  PetscCall(PetscStrToArrayDestroy(count, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds files of options, and those of viewers. */
static PetscErrorCode AddCommon(SamFiles *f, MPI_Comm comm, const SamArguments *arguments)
{
  PetscFunctionBegin;
  for (int k = 0; arguments && k < arguments->count; k++)
    PetscCall(SamFilesAdd(f, "-options_file", arguments->files[k], PETSC_FALSE));
  PetscCall(CheckOptionsView(comm));
  for (PetscInt k = 0; SamOptionsFile(k); k++) PetscCall(AddDeclared(f, comm, SamOptionsFile(k)));
  for (size_t k = 0; k < sizeof(own) / sizeof(own[0]); k++) PetscCall(AddViewer(comm, own[k], f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if one of two files may replace the other: a restart continues its checkpoints. */
static PetscBool MayMeet(const SamNamedFile *one, const SamNamedFile *other)
{
  if (!strcmp(one->option, other->option)) return PETSC_TRUE;
  return !strcmp(one->option, "-checkpoint") && !strcmp(other->option, "-restart");
}

/* Describes the first written file that would replace another one; empty if none does. */
static void Compare(const SamFiles *f, char message[], size_t size)
{
  for (const SamNamedFile *one = f->list; one < f->list + f->count; one++)
    for (const SamNamedFile *other = f->list; other < f->list + f->count && one->written; other++) {
      if (other->written && other >= one) continue;
      if (MayMeet(one, other) || !IsSameFile(one->name, other->name)) continue;
      (void)snprintf(message, size, "%s %s: %s the %sfile of %s", one->option, one->name,
                     other->written ? "is also" : "would overwrite", other->derived ? "second " : "", other->option);
      return;
    }
}

PetscErrorCode SamFilesCheck(SamFiles *f, MPI_Comm comm, const SamArguments *arguments)
{
  char           message[512] = "";
  PetscMPIInt    rank;
  PetscErrorCode code;

  PetscFunctionBegin;
  code = AddCommon(f, comm, arguments);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0 && !code) Compare(f, message, sizeof(message));
  for (PetscInt k = 0; k < f->count; k++) PetscCall(PetscFree(f->list[k].name));
  PetscCall(code);
  PetscCallMPI(MPI_Bcast(message, (PetscMPIInt)sizeof(message), MPI_CHAR, 0, comm));
  PetscCheck(!message[0], comm, SAM_ERR_USER, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

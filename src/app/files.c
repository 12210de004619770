/*
  The names of all files of a run, so that none that it writes replaces one that it reads, or another that it writes.
  Names that petsam derives count too: the XDMF file beside the results, a checkpoint's file.1 and file.tmp; and files
  that PETSc writes for its viewers.
*/
#include "files.h"
#include "runimpl.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct {
  const char *option; /* with dash */
  char       *name;
  PetscBool   derived; /* from the value of the option */
} File;

#define MOST 64
typedef struct {
  PetscInt count;
  File     list[MOST];
} Files;

/* Takes over the name; NULL is none. */
static void Add(Files *files, const char option[], char *name, PetscBool derived)
{
  if (name && files->count < MOST) files->list[files->count++] = (File){option, name, derived};
}

static PetscErrorCode AddCopy(Files *files, const char option[], const char name[])
{
  char *copy;

  PetscFunctionBegin;
  PetscCall(PetscStrallocpy(name, &copy));
  Add(files, option, copy, PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeFiles(Files *files)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < files->count; k++) PetscCall(PetscFree(files->list[k].name));
  files->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamIsSameFile(const char a[], const char b[])
{
  const char *const names[2] = {a, b};
  char              folder[2][PETSC_MAX_PATH_LEN], *real[2];
  const char       *last[2];
  struct stat       one, other;
  PetscBool         same;

  if (!strcmp(a, b)) return PETSC_TRUE;
  if (!stat(a, &one) && !stat(b, &other))
    return one.st_dev == other.st_dev && one.st_ino == other.st_ino ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++) {
    const char *slash = strrchr(names[k], '/');

    last[k] = slash ? slash + 1 : names[k];
    SamGetFolder(names[k], folder[k]);
    real[k] = realpath(folder[k], NULL);
  }
  same = real[0] && real[1] && !strcmp(real[0], real[1]) && !strcmp(last[0], last[1]) ? PETSC_TRUE : PETSC_FALSE;
  free(real[0]);
  free(real[1]);
  return same;
}

/* ---- files that PETSc writes ---- */

static const char *const viewers[] = {"-normal_view",
                                      "-normal_converged_reason",
                                      "-tangential_view",
                                      "-tangential_converged_reason",
                                      "-log_view",
                                      "-memory_view",
                                      NULL};

static PetscBool IsViewerFormat(const char text[])
{
  for (PetscInt k = 0; PetscViewerFormats[k] && strcmp(PetscViewerFormats[k], "PetscViewerFormat"); k++)
    if (!strcasecmp(PetscViewerFormats[k], text)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether PETSc could open the file; it would report a failure on one rank only. Not collective. */
static int CheckPlace(const char name[])
{
  char        folder[PETSC_MAX_PATH_LEN];
  struct stat status;

  if (!stat(name, &status)) return S_ISDIR(status.st_mode) ? EISDIR : access(name, W_OK) ? errno : 0;
  SamGetFolder(name, folder);
  return access(folder, W_OK | X_OK) ? errno : 0;
}

/* PETSc reads it twice, once as a viewer and once as a logical value. */
static PetscErrorCode CheckOptionsView(MPI_Comm comm)
{
  char      value[PETSC_MAX_PATH_LEN] = "";
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-options_view", value, sizeof(value), &set));
  PetscCheck(!value[0], comm, SAM_ERR_USER, "-options_view %s: expected no value", value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The value of a viewer's option is type:file:format:mode, each of which may be missing. The type is ascii. */
static PetscErrorCode AddViewer(MPI_Comm comm, const char option[], Files *files)
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
  PetscCall(AddCopy(files, option, part[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all files ---- */

static PetscErrorCode CollectRead(const SamArguments *arguments, Files *files)
{
  static const char *const inputs[] = {"-gap_file",     "-gap_rough_file", "-friction_file",
                                       "-load_history", "-restart",        NULL};
  static const char *const names[]  = {"-gap_file", "-gap_rough_file", "-friction_file", "-history", "-restart"};

  PetscFunctionBegin;
  for (PetscInt k = 0; inputs[k]; k++) {
    char      name[PETSC_MAX_PATH_LEN];
    PetscBool set;

    PetscCall(PetscOptionsGetString(NULL, NULL, inputs[k], name, sizeof(name), &set));
    if (set) PetscCall(AddCopy(files, names[k], name));
  }
  for (int k = 0; k < arguments->count; k++) PetscCall(AddCopy(files, "-options_file", arguments->files[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CollectWritten(const SamRun *run, MPI_Comm comm, Files *files)
{
  const char *checkpoint, *restart;
  char       *before, *temporary;

  PetscFunctionBegin;
  PetscCall(SamCheckpointsGetNames(run->checkpoints, &checkpoint, &restart));
  if (run->has_output) {
    PetscCall(AddCopy(files, "-output", run->filename));
    PetscCall(SamOutputNames(run->filename, &before, &temporary));
    if (!run->output_settings.xdmf) PetscCall(PetscFree(before));
    if (!restart) PetscCall(PetscFree(temporary));
    Add(files, "-output", before, PETSC_TRUE);
    Add(files, "-output", temporary, PETSC_TRUE);
  }
  if (checkpoint) {
    PetscCall(AddCopy(files, "-checkpoint", checkpoint));
    PetscCall(SamCheckpointNames(checkpoint, &before, &temporary));
    Add(files, "-checkpoint", before, PETSC_TRUE);
    Add(files, "-checkpoint", temporary, PETSC_TRUE);
  }
  PetscCall(CheckOptionsView(comm));
  for (PetscInt k = 0; viewers[k]; k++) PetscCall(AddViewer(comm, viewers[k], files));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether one of two files may replace the other: checkpoints go on where the run restarts. */
static PetscBool MayMeet(const File *one, const File *other)
{
  if (!strcmp(one->option, other->option)) return PETSC_TRUE;
  return !strcmp(one->option, "-checkpoint") && !strcmp(other->option, "-restart") ? PETSC_TRUE : PETSC_FALSE;
}

/* Says which written file would replace another one; empty if none does. */
static void Compare(const Files *written, const Files *read, char message[], size_t size)
{
  message[0] = '\0';
  for (PetscInt w = 0; w < written->count && !message[0]; w++) {
    const File *one = &written->list[w];

    for (PetscInt k = 0; k < read->count + w && !message[0]; k++) {
      const File *other = k < read->count ? &read->list[k] : &written->list[k - read->count];

      if (!MayMeet(one, other) && SamIsSameFile(one->name, other->name))
        (void)snprintf(message, size, "%s %s: %s the %sfile of %s", one->option, one->name,
                       k >= read->count ? "is also" : "would overwrite", other->derived ? "second " : "",
                       other->option);
    }
  }
}

PetscErrorCode SamRunCheckFiles(const SamRun *run, MPI_Comm comm, const SamArguments *arguments)
{
  Files          read = {.count = 0}, written = {.count = 0};
  char           message[512] = "";
  PetscMPIInt    rank;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(CollectRead(arguments, &read));
  ierr = CollectWritten(run, comm, &written);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!ierr && rank == 0) Compare(&written, &read, message, sizeof(message));
  PetscCallMPI(MPI_Bcast(message, (PetscMPIInt)sizeof(message), MPI_CHAR, 0, comm));
  PetscCall(FreeFiles(&read));
  PetscCall(FreeFiles(&written));
  PetscCall(ierr);
  PetscCheck(!message[0], comm, SAM_ERR_USER, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

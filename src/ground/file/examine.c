/*
  A separate program examines a file before it is opened, since HDF5 may crash on a damaged file, or never end if the
  addresses in the file lead in a circle. The program is started by posix_spawn(): a fork after MPI_Init() would be
  unsafe if MPI has registered memory with the network's hardware.
*/
#include "fileimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

/* Outcomes of a run of the program beside the number of characters that it has written; and how long it may take: it
   limits its own CPU time, but may sleep, or wait for a disk. */
enum { NOT_STARTED = -1, TOO_LATE = -2, SECONDS = 60 };

/* A question about a file. */
typedef struct {
  const char        *option, *filename;
  const char *const *objects;
  SamFileLook        look;
  const void        *question;
} Case;

/* The outcome of an examination; the answer is its last part */
typedef struct {
  PetscErrorCode code;
  char           message[SAM_MESSAGE];
  double         answer[]; /* of type double for its alignment */
} Outcome;

/* Returns true if a file has HDF5's signature; prints no message. */
static PetscBool IsHDF5(const char filename[])
{
  H5E_auto2_t print;
  void       *data;
  htri_t      is;

  (void)H5Eget_auto2(H5E_DEFAULT, &print, &data);
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  is = H5Fis_hdf5(filename);
  (void)H5Eset_auto2(H5E_DEFAULT, print, data);
  return is > 0 ? PETSC_TRUE : PETSC_FALSE;
}

#define NO_HDF5 "it is not an HDF5 file; "

/* Returns why the file of an option cannot be read as HDF5, NULL if it can. A pipe would wait for its writer. */
static const char *FindFault(const char option[], const char filename[])
{
  struct stat status;

  if (stat(filename, &status) || access(filename, R_OK)) return strerror(errno);
  if (!S_ISREG(status.st_mode)) return S_ISDIR(status.st_mode) ? strerror(EISDIR) : "it is not a file";
  if (IsHDF5(filename)) return NULL;
  if (!strcmp(option, "input")) return NO_HDF5 "give results of petsam -output";
  return strstr(option, "compliance") ? NO_HDF5 "make one by petsam-compliance" : NO_HDF5 "make one by petsam-surface";
}

static const char damaged[] = "it is damaged";
static const char late[]    = "petsam-examine has read it for 60 s without an end; copy it to a faster disk";

/*
  Gets the folder of the file that the library's code lies in, with a slash: the shared library, or a program that is
  linked with the static one. The system's list of the process' memory has the whole name, as it was when it was loaded.
*/
static PetscBool FindOwnFolder(char folder[PETSC_MAX_PATH_LEN])
{
  static const char anchor = 0; /* an address in the library */
  FILE             *maps   = fopen("/proc/self/maps", "re");
  char              line[PETSC_MAX_PATH_LEN + 128], *name = NULL;

  while (maps && !name && fgets(line, sizeof(line), maps)) {
    char           *end;
    const uintptr_t first = (uintptr_t)strtoull(line, &end, 16), last = (uintptr_t)strtoull(end + 1, NULL, 16);

    if ((uintptr_t)&anchor >= first && (uintptr_t)&anchor < last) name = strchr(line, '/');
  }
  if (maps) (void)fclose(maps);
  if (!name || strlen(name) >= PETSC_MAX_PATH_LEN) return PETSC_FALSE;
  *(strrchr(name, '/') + 1) = 0;
  (void)strcpy(folder, name);
  return PETSC_TRUE;
}

/* Gets the folder of the program petsam that the environment's PATH finds, with a slash. */
static PetscBool FindInstalledFolder(char folder[PETSC_MAX_PATH_LEN])
{
  char *const path = getenv("PATH") ? strdup(getenv("PATH")) : NULL, *rest = path;

  for (const char *one; path && (one = strsep(&rest, ":"));) {
    char name[PETSC_MAX_PATH_LEN];

    if (snprintf(name, sizeof(name), "%s/petsam", one[0] ? one : ".") >= PETSC_MAX_PATH_LEN) continue;
    if (access(name, X_OK) || !realpath(name, folder)) continue;
    *(strrchr(folder, '/') + 1) = 0;
    free(path);
    return PETSC_TRUE;
  }
  free(path);
  return PETSC_FALSE;
}

/*
  Finds the program that examines: petsam/petsam-examine beside the shared library, or in lib/ of the folder above a
  program that is linked with the static one, or above the program petsam. Returns false if there is none.
*/
static PetscBool FindProgram(char path[PETSC_MAX_PATH_LEN])
{
  static const char *const places[] = {"petsam/petsam-examine", "../lib/petsam/petsam-examine"};
  PetscBool (*const folders[])(char folder[PETSC_MAX_PATH_LEN]) = {FindOwnFolder, FindInstalledFolder};

  for (size_t k = 0; k < sizeof(folders) / sizeof(folders[0]); k++) {
    char folder[PETSC_MAX_PATH_LEN];

    if (!folders[k](folder)) continue;
    for (size_t n = 0; n < sizeof(places) / sizeof(places[0]); n++)
      if (snprintf(path, PETSC_MAX_PATH_LEN, "%s%s", folder, places[n]) < PETSC_MAX_PATH_LEN && !access(path, X_OK))
        return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Starts the program with signals as at a program's start and its output to a pipe; returns 0 or a number of errno. */
static int Start(const char program[], const char *const words[], int output, pid_t *child)
{
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t          attributes;
  sigset_t                   all, none;
  int                        error;

  (void)posix_spawn_file_actions_init(&actions);
  (void)posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  (void)posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  (void)posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  (void)posix_spawnattr_init(&attributes);
  (void)sigfillset(&all);
  (void)sigemptyset(&none);
  (void)posix_spawnattr_setsigdefault(&attributes, &all);
  (void)posix_spawnattr_setsigmask(&attributes, &none);
  (void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  error = posix_spawn(child, program, &actions, &attributes, (char *const *)words, environ);
  (void)posix_spawnattr_destroy(&attributes);
  (void)posix_spawn_file_actions_destroy(&actions);
  return error;
}

/* Returns the time, ms. */
static long long GetTime(void)
{
  struct timespec now;

  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return 1000LL * now.tv_sec + now.tv_nsec / 1000000;
}

/* Counts the characters that arrive until the other end closes; returns TOO_LATE if it does not. */
static int CountCharacters(int input)
{
  const long long end     = GetTime() + 1000LL * SECONDS;
  struct pollfd   wanted  = {.fd = input, .events = POLLIN};
  int             written = 0;

  for (;;) {
    const long long left = end - GetTime();
    char            text[2];
    ssize_t         count;

    if (left <= 0) return TOO_LATE;
    if (poll(&wanted, 1, (int)left) <= 0) continue; /* interrupted, or the time is over */
    count = read(input, text, sizeof(text));
    if (count == 0 || (count < 0 && errno != EINTR)) return written;
    if (count > 0) written += (int)count;
  }
}

/*
  Runs the program and returns the number of characters that it has written: one when it begins, and one when it ends;
  or NOT_STARTED or TOO_LATE. Its exit status is no evidence: the system drops it where the process ignores SIGCHLD, and
  another part of the process may take it.
*/
static int Run(const char program[], const char *const words[])
{
  int   ends[2], written = NOT_STARTED, error;
  pid_t child;

  if (pipe2(ends, O_CLOEXEC)) return NOT_STARTED;
  error = Start(program, words, ends[1], &child);
  (void)close(ends[1]);
  if (!error) written = CountCharacters(ends[0]);
  (void)close(ends[0]);
  if (written == TOO_LATE) (void)kill(child, SIGKILL);
  while (!error && waitpid(child, NULL, 0) < 0 && errno == EINTR) continue;
  return written;
}

/* A file as it was examined, and the requested objects in it */
typedef struct {
  dev_t    device;
  ino_t    inode;
  off_t    size;
  time_t   seconds;
  long     nanoseconds;
  uint64_t objects;
} Seen;

static Seen TakeSeen(const char filename[], const char *const objects[])
{
  Seen        seen = {0};
  struct stat status;

  if (stat(filename, &status)) return seen;
  seen.device      = status.st_dev;
  seen.inode       = status.st_ino;
  seen.size        = status.st_size;
  seen.seconds     = status.st_mtim.tv_sec;
  seen.nanoseconds = status.st_mtim.tv_nsec;
  for (int k = 0; objects && objects[k]; k++)
    seen.objects = SamHashBytes(seen.objects, (const unsigned char *)objects[k], strlen(objects[k]) + 1);
  return seen;
}

static PetscBool IsSame(const Seen *a, const Seen *b)
{
  return a->device == b->device && a->inode == b->inode && a->size == b->size && a->seconds == b->seconds &&
             a->nanoseconds == b->nanoseconds && a->objects == b->objects
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Returns why the file cannot be opened: HDF5 crashes on it, or does not end. NULL also if the program is missing. */
static const char *FindDamage(const char filename[], const char *const objects[])
{
  static Seen last; /* the last file that passed: a surface is read twice, for its grid and for its heights */
  const Seen  now                             = TakeSeen(filename, objects);
  const char *words[2 + SAM_FILE_OBJECTS + 1] = {"petsam-examine", filename};
  char        program[PETSC_MAX_PATH_LEN];
  int         written;

  if (IsSame(&now, &last)) return NULL;
  for (int k = 0; objects && objects[k] && k < SAM_FILE_OBJECTS; k++) words[2 + k] = objects[k];
  written = FindProgram(program) ? Run(program, words) : NOT_STARTED;
  if (written == TOO_LATE) return late;
  if (written == 1) return damaged;
  last = now;
  return NULL;
}

static PetscErrorCode OpenAndLook(const Case *c, void *answer)
{
  const char    *fault = FindFault(c->option, c->filename);
  SamFile        file;
  PetscErrorCode ierr, ended;

  PetscFunctionBegin;
  if (!fault) fault = FindDamage(c->filename, c->objects);
  PetscCheck(!fault, PETSC_COMM_SELF, SAM_ERR_FILE, SAM_CANNOT_READ, c->option, c->filename, fault);
  ierr = SamFileOpen(NULL, SAM_EVENT_OUTPUT, c->option, c->filename, SAM_FILE_READ, NULL, &file);
  PetscCheck(!ierr, PETSC_COMM_SELF, SAM_ERR_FILE, SAM_CANNOT_READ, c->option, c->filename, damaged);
  PetscCall(SamFileBegin(file));
  ierr = c->look(file, c->question, answer);
  if (ierr) file->failed = PETSC_FALSE; /* the raised error explains the failures noted after it */
  ended = SamFileEnd(file);
  (void)SamFileDestroy(&file, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(ended);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Examine(const Case *c, Outcome *outcome)
{
  (void)PetscPushErrorHandler(SamKeepMessage, outcome->message);
  outcome->code = OpenAndLook(c, outcome->answer);
  (void)PetscPopErrorHandler();
}

PetscErrorCode SamFileExamine(MPI_Comm comm, const char option[], const char filename[], const char *const objects[],
                              SamFileLook look, const void *question, void *answer, size_t size)
{
  const Case     c     = {option, filename, objects, look, question};
  const size_t   bytes = sizeof(Outcome) + size;
  Outcome       *outcome;
  PetscMPIInt    rank;
  PetscErrorCode code;
  char           message[SAM_MESSAGE];

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscCalloc(bytes, &outcome));
  if (rank == 0) Examine(&c, outcome);
  PetscCallMPI(MPI_Bcast(outcome, (PetscMPIInt)bytes, MPI_BYTE, 0, comm));
  memcpy(answer, outcome->answer, size);
  memcpy(message, outcome->message, sizeof(message));
  code = outcome->code;
  PetscCall(PetscFree(outcome));
  PetscCheck(!code, comm, code, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- places of the data ---- */

/* True if all chunks of the first `extent` places in each dimension lie within a file of this size (bytes). */
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
    for (at[d] += chunk[d]; d > 0 && at[d] >= n[d]; at[d] += chunk[d]) at[d--] = 0; /* the next chunk */
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

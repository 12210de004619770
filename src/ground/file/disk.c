/*
  Rank 0 handles files through the system, before and after HDF5 uses them: it finds out if a name can be written,
  identifies its present file, excludes other runs from it, allocates space, notices changes from outside, and renames.

  Functions that return an int return 0, an errno, or one of the reasons below.
*/
#include "fileimpl.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

enum { IN_USE = -1, FOREIGN = -2, REPLACED = -3, RESIZED = -4, IS_LINK = -5, NOT_A_FILE = -6, NO_FOLDER = -7 };

static const struct {
  int         error;
  const char *text;
} reasons[] = {{IN_USE, "another run is writing it"},
               {FOREIGN,
                "there is a file of that name that petsam has not written for this purpose, and it is not replaced"},
               {REPLACED, "another program has replaced it during this run"},
               {RESIZED, "another program has changed its size during this run"},
               {IS_LINK, "it is a symbolic link"},
               {NOT_A_FILE, "it is not a file"},
               {NO_FOLDER, "its folder does not exist"},
               {ENOTDIR, "its folder is a file"},
               {EISDIR, "it is a folder, expected the name of a file"}};

static const char *Reason(int error)
{
  for (size_t k = 0; k < sizeof(reasons) / sizeof(reasons[0]); k++)
    if (reasons[k].error == error) return reasons[k].text;
  return strerror(error);
}

PetscErrorCode SamFileRaise(SamGrid grid, const char option[], const char filename[], int error)
{
  char folder[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  SamGetFolder(filename, folder);
  if (error == ENOENT && access(folder, F_OK)) error = NO_FOLDER;
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, grid->comm));
  PetscCheck(!error, grid->comm, SAM_ERR_FILE, "-%s %s: cannot be written: %s", option, filename, Reason(error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MOST_LINKS 40 /* links that may follow one another; the system has the same limit */

/* Finds the name behind symbolic links, even if no such file exists: a link remains a link when its file is
   replaced. */
static void FollowLinks(const char filename[], char real[PETSC_MAX_PATH_LEN])
{
  (void)snprintf(real, PETSC_MAX_PATH_LEN, "%s", filename);
  for (int k = 0; k < MOST_LINKS; k++) {
    char          target[PETSC_MAX_PATH_LEN], folder[PETSC_MAX_PATH_LEN], next[2 * PETSC_MAX_PATH_LEN + 2];
    const ssize_t length = readlink(real, target, sizeof(target) - 1);

    if (length <= 0) return;
    target[length] = '\0';
    SamGetFolder(real, folder);
    (void)snprintf(next, sizeof(next), "%s%s%s", target[0] == '/' ? "" : folder, target[0] == '/' ? "" : "/", target);
    if (strlen(next) >= PETSC_MAX_PATH_LEN) return;
    (void)strcpy(real, next);
  }
}

PetscErrorCode SamFileNameBeside(const char filename[], const char ending[], char **name)
{
  char   real[PETSC_MAX_PATH_LEN];
  size_t size;

  PetscFunctionBegin;
  FollowLinks(filename, real);
  size = strlen(real) + strlen(ending) + 1;
  PetscCall(PetscMalloc1(size, name));
  (void)snprintf(*name, size, "%s%s", real, ending);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileNameTemporary(const char filename[], char **temporary)
{
  return SamFileNameBeside(filename, ".tmp", temporary);
}

static PetscBool IsFirst(SamGrid grid)
{
  PetscMPIInt rank = 0;

  (void)MPI_Comm_rank(grid->comm, &rank);
  return rank ? PETSC_FALSE : PETSC_TRUE;
}

/* ---- identification of files ---- */

#define HEAD (16 << 20) /* bytes at the start of results that contain their attributes */

/* True if the bytes contain the text. */
static PetscBool Contains(const char bytes[], size_t size, const char text[])
{
  const size_t length = strlen(text);
  const char  *found  = bytes;

  while (size >= length && (found = (const char *)memchr(bytes, text[0], size - length + 1))) {
    if (!memcmp(found, text, length)) return PETSC_TRUE;
    size -= (size_t)(found + 1 - bytes);
    bytes = found + 1;
  }
  return PETSC_FALSE;
}

static const char hdf5[8] = {'\211', 'H', 'D', 'F', '\r', '\n', '\032', '\n'}; /* first bytes of its files */

/*
  True if a file begins with the bytes that petsam writes under this name. HDF5 is not used here, as it might never
  return from a damaged file. A killed run may have left a file that begins with zeros.
*/
static PetscBool IsOwn(SamFileUse use, const char head[], size_t size)
{
  static const char zeros[8] = {0};

  if (!size) return PETSC_TRUE;
  if (size >= sizeof(zeros) && !memcmp(head, zeros, sizeof(zeros))) return PETSC_TRUE;
  if ((use == SAM_FILE_CHECKPOINT || use == SAM_FILE_TEMPORARY) && SamSealIsOne(head, size)) return PETSC_TRUE;
  if (use == SAM_FILE_CHECKPOINT || size < sizeof(hdf5) || memcmp(head, hdf5, sizeof(hdf5))) return PETSC_FALSE;
  return Contains(head, size, "petsam_version");
}

static off_t SizeOf(int file)
{
  struct stat status;

  return fstat(file, &status) ? -1 : status.st_size;
}

off_t SamFilePlaceOfEnd(const unsigned char start[SAM_FILE_SUPERBLOCK])
{
  const int version = start[8], address = start[13]; /* its size */

  return version <= 1 && address == 8 ? 40 + 4 * version : 0;
}

/*
  True if a run that was killed in its first flush may have left this temporary file: its first block has an HDF5
  version that petsam uses, and the file is shorter than the end of data that this block names.
*/
static PetscBool IsUnfinished(int file, const char head[], size_t size)
{
  const off_t place = size < SAM_FILE_SUPERBLOCK ? 0 : SamFilePlaceOfEnd((const unsigned char *)head);
  uint64_t    end   = 0;

  if (!place || memcmp(head, hdf5, sizeof(hdf5))) return PETSC_FALSE;
  for (int k = 7; k >= 0; k--) end = end << 8 | (unsigned char)head[place + k];
  return (uint64_t)SizeOf(file) < end;
}

static int CheckContent(int file, SamFileUse use)
{
  char   *head;
  ssize_t n;
  int     error;

  if (PetscMalloc1(HEAD, &head)) return ENOMEM;
  n     = pread(file, head, HEAD, 0);
  error = n < 0 ? errno : IsOwn(use, head, (size_t)n) ? 0 : FOREIGN;
  if (error == FOREIGN && use == SAM_FILE_TEMPORARY && IsUnfinished(file, head, (size_t)n)) error = 0;
  (void)PetscFree(head);
  return error;
}

/* ---- space ---- */

int SamFileCheckFolder(const char folder[], int mode)
{
  struct stat status;

  if (!stat(folder, &status) && !S_ISDIR(status.st_mode)) return ENOTDIR;
  return access(folder, mode) ? errno : 0;
}

/*
  Allocates so many bytes beyond the end of the file. With `keep` the file becomes longer; otherwise its length never
  changes, because a checkpoint that is longer when a run is killed would count as damaged. The limit of file sizes is
  checked here, as the system checks it only if a file becomes longer.
*/
static int Reserve(int file, off_t bytes, PetscBool keep)
{
  struct stat    status;
  struct statvfs space;
  struct rlimit  limit;
  int            error = EOPNOTSUPP;

  if (fstat(file, &status)) return errno;
  if (!getrlimit(RLIMIT_FSIZE, &limit) && limit.rlim_cur != RLIM_INFINITY &&
      (rlim_t)(status.st_size + bytes) > limit.rlim_cur)
    return EFBIG;
#if defined(__linux__)
  error = fallocate(file, keep ? 0 : FALLOC_FL_KEEP_SIZE, status.st_size, bytes) ? errno : 0;
  if ((error || !keep) && ftruncate(file, status.st_size)) return errno; /* an error may leave a part allocated */
#endif
  if (error != EOPNOTSUPP && error != ENOSYS) return error;
  if (fstatvfs(file, &space)) return errno;
  if ((double)space.f_bavail * (double)space.f_frsize < (double)bytes) return ENOSPC;
  return keep && ftruncate(file, status.st_size + bytes) ? errno : 0;
}

/* Reserves so many bytes and those of HDF5's metadata in a file that exists. */
static int ReserveInFile(SamFile f, off_t bytes, PetscBool keep)
{
  const int file  = open(f->filename, O_WRONLY);
  off_t     begin = 0;
  int       error;

  if (file < 0) return errno;
  begin = SizeOf(file);
  bytes += SAM_FILE_METADATA;
  error = Reserve(file, bytes, keep);
  if (!error && keep) {
    f->reserved_begin = begin;
    f->reserved_end   = begin + bytes;
  }
  return close(file) && !error ? errno : error;
}

PetscErrorCode SamFileCheckRoom(SamFile f, double bytes)
{
  int error = 0;

  PetscFunctionBegin;
  if (f->rank == 0) error = ReserveInFile(f, (off_t)bytes, PETSC_FALSE);
  PetscCall(SamFileRaise(f->grid, f->option, f->filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

off_t SamFileFindUnused(SamFile f)
{
  struct stat status;

  return !stat(f->filename, &status) && f->reserved_end > 0 && status.st_size == f->reserved_end ? f->reserved_begin
                                                                                                 : -1;
}

PetscErrorCode SamFileReserve(SamFile f, off_t bytes)
{
  int error = 0;

  PetscFunctionBegin;
  if (f->rank == 0) error = ReserveInFile(f, bytes, PETSC_TRUE);
  PetscCall(SamFileRaise(f->grid, f->option, f->filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileGetSpace(SamGrid grid, const char option[], const char filename[], double *bytes)
{
  struct statvfs space;
  char           folder[PETSC_MAX_PATH_LEN], real[PETSC_MAX_PATH_LEN];
  PetscMPIInt    rank;
  int            error = 0;

  PetscFunctionBegin;
  *bytes = PETSC_INFINITY;
  FollowLinks(filename, real);
  SamGetFolder(real, folder);
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (rank == 0) error = access(filename, F_OK) ? SamFileCheckFolder(folder, W_OK) : access(filename, W_OK) ? errno : 0;
  if (rank == 0 && !statvfs(folder, &space)) *bytes = (double)space.f_bavail * (double)space.f_frsize;
  PetscCallMPI(MPI_Bcast(bytes, 1, MPI_DOUBLE, 0, grid->comm));
  PetscCall(SamFileRaise(grid, option, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- exclusion of other runs ---- */

/*
  Locks a file while it is open, for other nodes too if the file system supports this. The lock is on a range beyond all
  data, where MPI-IO has no locks of its own. On systems without such locks the file is not locked.
*/
#define LOCK_AT ((off_t)1 << 60)
static int Lock(int file)
{
#if defined(F_OFD_SETLK)
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCK_AT, .l_len = 1};

  if (fcntl(file, F_OFD_SETLK, &lock) && (errno == EAGAIN || errno == EACCES)) return IN_USE;
#else
  (void)file;
#endif
  return 0;
}

/* True if the name still belongs to the open file. */
static PetscBool IsNameOf(const char filename[], int file)
{
  struct stat named, open;

  return !stat(filename, &named) && !fstat(file, &open) && named.st_dev == open.st_dev && named.st_ino == open.st_ino;
}

/* Checks, before a name is opened, that it is a file. Opening a pipe or a device would wait for its reader. */
static int CheckPlace(const char filename[], SamFileUse use)
{
  struct stat status;

  if (use == SAM_FILE_TEMPORARY && !lstat(filename, &status) && S_ISLNK(status.st_mode)) return IS_LINK;
  if (stat(filename, &status)) return errno == ENOENT ? 0 : errno;
  if (S_ISDIR(status.st_mode)) return EISDIR;
  return S_ISREG(status.st_mode) ? 0 : NOT_A_FILE;
}

void SamFileLockRelease(const char filename[], SamFileLock *hold)
{
  if (hold->file < 0) return;
  if ((hold->use == SAM_FILE_TEMPORARY || (hold->created && SizeOf(hold->file) == 0)) && IsNameOf(filename, hold->file))
    (void)unlink(filename);
  (void)close(hold->file);
  hold->file = -1;
}

/* Opens and locks a file, which is created if necessary; checks that it can be written and may be replaced. */
static int Take(const char filename[], SamFileUse use, SamFileLock *hold)
{
  int error = 0;

  *hold = (SamFileLock){.use = use, .file = -1};
  do { /* repeat if another run has meanwhile renamed or removed the file */
    if (hold->file >= 0) (void)close(hold->file);
    error = CheckPlace(filename, use);
    if (error) return error;
    hold->created = access(filename, F_OK) != 0;
    hold->file    = open(filename, O_RDWR | O_CLOEXEC | (use == SAM_FILE_OLD_RESULTS ? 0 : O_CREAT), 0666);
    if (hold->file < 0) return errno;
    error = Lock(hold->file);
  } while (!error && !IsNameOf(filename, hold->file));
  if (error) {
    (void)close(hold->file); /* the file belongs to another run: leave it */
    hold->file = -1;
    return error;
  }
  error = CheckContent(hold->file, use);
  if (error) hold->use = SAM_FILE_RESULTS; /* not created by petsam: keep */
  if (!error) error = Reserve(hold->file, SAM_FILE_METADATA, PETSC_FALSE);
  if (error) SamFileLockRelease(filename, hold);
  return error;
}

PetscErrorCode SamFileLockTake(SamGrid grid, const char option[], const char filename[], SamFileUse use,
                               SamFileLock *hold)
{
  int error = 0;

  PetscFunctionBegin;
  hold->file = -1;
  if (IsFirst(grid)) error = Take(filename, use, hold);
  PetscCall(SamFileRaise(grid, option, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that a file can be created there, without creating one, which a killed run would leave behind. */
static int CheckFolderOf(const char filename[])
{
  char folder[PETSC_MAX_PATH_LEN], real[PETSC_MAX_PATH_LEN];

  FollowLinks(filename, real);
  SamGetFolder(real, folder);
  return SamFileCheckFolder(folder, W_OK | X_OK);
}

PetscErrorCode SamFileCheckName(SamGrid grid, const char option[], const char filename[], SamFileUse use)
{
  SamFileLock hold  = {.file = -1};
  int         error = 0;

  PetscFunctionBegin;
  if (IsFirst(grid)) {
    error = !access(filename, F_OK)       ? Take(filename, use, &hold)
            : use == SAM_FILE_OLD_RESULTS ? ENOENT
                                          : CheckFolderOf(filename);
    SamFileLockRelease(filename, &hold);
  }
  PetscCall(SamFileRaise(grid, option, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileGetBytes(MPI_Comm comm, const char filename[], double *bytes)
{
  struct stat status;

  PetscFunctionBegin;
  *bytes = stat(filename, &status) ? -1 : (double)status.st_size;
  PetscCallMPI(MPI_Bcast(bytes, 1, MPI_DOUBLE, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileContains(SamGrid grid, const char filename[], const char text[], PetscBool *contains)
{
  const int file = IsFirst(grid) ? open(filename, O_RDONLY | O_NONBLOCK) : -1;
  char     *head;
  int       is = 0;

  PetscFunctionBegin;
  if (file >= 0) {
    PetscCall(PetscMalloc1(HEAD, &head));
    is = Contains(head, (size_t)PetscMax(pread(file, head, HEAD, 0), 0), text);
    PetscCall(PetscFree(head));
    (void)close(file);
  }
  PetscCallMPI(MPI_Bcast(&is, 1, MPI_INT, 0, grid->comm));
  *contains = is != 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFileLockNoteSize(SamFileLock *hold)
{
  if (hold->file >= 0) hold->size = SizeOf(hold->file);
}

static PetscBool HasMark(const SamFileLock *hold)
{
  double found = 0;

  if (!hold->mark_at) return PETSC_TRUE;
  return pread(hold->file, &found, sizeof(found), hold->mark_at) == (ssize_t)sizeof(found) && found == hold->mark;
}

PetscErrorCode SamFileLockCheck(SamGrid grid, const char option[], const char filename[], const SamFileLock *hold)
{
  struct stat status;
  int         error = 0;

  PetscFunctionBegin;
  if (hold->file >= 0) {
    if (stat(filename, &status))
      error = errno;
    else if (!IsNameOf(filename, hold->file))
      error = REPLACED;
    else if (SizeOf(hold->file) != hold->size || !HasMark(hold))
      error = RESIZED;
  }
  PetscCall(SamFileRaise(grid, option, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define PATIENCE 1000 /* milliseconds after which another run that was refused has released a file */

/* Locks the next file of a name whose file has been renamed, and releases the old one after that. */
static int TakeNext(const char filename[], SamFileLock *hold)
{
  SamFileLock next;
  int         error = IN_USE;

  for (int k = 0; k < PATIENCE && error == IN_USE; k++) {
    if (k) (void)usleep(1000);
    error = Take(filename, hold->use, &next);
  }
  (void)close(hold->file);
  *hold = next;
  return error;
}

PetscErrorCode SamFileLockTakeNext(SamGrid grid, const char option[], const char filename[], SamFileLock *hold)
{
  PetscFunctionBegin;
  PetscCall(SamFileRaise(grid, option, filename, hold->file >= 0 ? TakeNext(filename, hold) : 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- left-overs ---- */

/* True if a text is -<number>-<number>.lock */
static PetscBool IsLockEnding(const char text[])
{
  for (int k = 0; k < 2; k++) {
    const size_t digits = text[0] == '-' ? strspn(text + 1, "0123456789") : 0;

    if (!digits) return PETSC_FALSE;
    text += 1 + digits;
  }
  return strcmp(text, ".lock") ? PETSC_FALSE : PETSC_TRUE;
}

/*
  Removes lock files of Open MPI. It keeps a file <name>-<job>-<process>.lock beside each file that is open through
  MPI-IO, for shared file pointers, which HDF5 does not use. A killed run would leave it behind. Lock files of earlier
  killed runs are removed, too.
*/
void SamFileRemoveLeftOvers(SamFile f)
{
  const char    *slash = strrchr(f->filename, '/'), *name = slash ? slash + 1 : f->filename;
  const size_t   length = strlen(name);
  char           folder[PETSC_MAX_PATH_LEN], path[2 * PETSC_MAX_PATH_LEN];
  struct dirent *entry;
  DIR           *list;

  if (f->rank) return;
  SamGetFolder(f->filename, folder);
  list = opendir(folder);
  while (list && (entry = readdir(list))) {
    if (strncmp(entry->d_name, name, length) || !IsLockEnding(entry->d_name + length)) continue;
    (void)snprintf(path, sizeof(path), "%s/%s", folder, entry->d_name);
    (void)unlink(path);
  }
  if (list) (void)closedir(list);
}

/* ---- the disk ---- */

/* Flushes a file, or a folder's list of names, to the disk. */
static int Sync(const char name[], int flags)
{
  const int file = open(name, flags);
  int       error;

  if (file < 0) return errno;
  error = fsync(file) && errno != EINVAL && errno != EROFS ? errno : 0; /* some systems cannot flush folders */
  return close(file) && !error ? errno : error;
}

static int SyncFolderOf(const char filename[])
{
  char folder[PETSC_MAX_PATH_LEN];

  SamGetFolder(filename, folder);
  return Sync(folder, O_RDONLY | O_DIRECTORY);
}

/*
  Gives a file the second name `kept`, replacing a file of that name; does nothing if the file does not exist. If the
  file system has no hard links, the file is renamed and loses its first name.
*/
static int KeepAs(const char filename[], const char kept[])
{
  if (access(filename, F_OK)) return 0;
  if (unlink(kept) && errno != ENOENT) return errno;
  if (!link(filename, kept)) return 0;
  return rename(filename, kept) ? errno : 0;
}

PetscErrorCode SamFileReplace(SamGrid grid, const char option[], const char temporary[], const char filename[],
                              const char kept[])
{
  char real[PETSC_MAX_PATH_LEN];
  int  error = 0;

  PetscFunctionBegin;
  if (IsFirst(grid)) {
    FollowLinks(filename, real);
    error = Sync(temporary, O_RDONLY);
    if (!error && kept) error = KeepAs(real, kept);
    if (!error && rename(temporary, real)) error = errno;
    if (!error) error = SyncFolderOf(real);
  }
  PetscCall(SamFileRaise(grid, option, filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Preloaded into a program: kills it, as nothing can be caught, before its n-th change of a file of results or a
  checkpoint: a write, a change of its length or of its name. DIE_AT is n; DIE_RANK the rank that is killed (all, if it
  is not set); DIE_HALF=1: after the first half of a write. DIE_LOG names a file that is told the place of each change,
  a line each, -1 for one that is not a write.
*/
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

static int IsName(const char name[])
{
  return strstr(name, ".h5") && !strstr(name, ".lock"); /* Open MPI has own files beside those that it writes */
}

static int IsResults(int file)
{
  char    link[64], name[4096];
  ssize_t length;

  snprintf(link, sizeof(link), "/proc/self/fd/%d", file);
  length = readlink(link, name, sizeof(name) - 1);
  if (length > 0) name[length] = '\0';
  return length > 0 && IsName(name);
}

static int IsRank(void)
{
  const char *const chosen = getenv("DIE_RANK"), *const rank = getenv("OMPI_COMM_WORLD_RANK");

  return !chosen || !strcmp(chosen, rank ? rank : "0");
}

/* Counts a change. Returns 1 if the process is to die in its middle. */
static int Count(long where)
{
  static long       count = 0;
  const char *const at = getenv("DIE_AT"), *const log = getenv("DIE_LOG"), *const half = getenv("DIE_HALF");

  if (!IsRank()) return 0;
  count++;
  if (at && count == atol(at)) {
    if (half && half[0] == '1' && where >= 0) return 1;
    raise(SIGKILL);
  }
  if (log) {
    FILE *out = fopen(log, "a");

    if (!out) abort();
    fprintf(out, "%ld\n", where);
    fclose(out);
  }
  return 0;
}

#define NEXT(result, name, ...) result (*next)(__VA_ARGS__) = (result(*)(__VA_ARGS__))dlsym(RTLD_NEXT, name)

ssize_t pwrite(int file, const void *data, size_t size, off_t where)
{
  NEXT(ssize_t, "pwrite", int, const void *, size_t, off_t);

  if (IsResults(file) && Count(where)) {
    (void)!next(file, data, size / 2, where);
    raise(SIGKILL);
  }
  return next(file, data, size, where);
}

ssize_t pwrite64(int file, const void *data, size_t size, off64_t where)
{
  return pwrite(file, data, size, where);
}

ssize_t pwritev(int file, const struct iovec *data, int count, off_t where)
{
  NEXT(ssize_t, "pwritev", int, const struct iovec *, int, off_t);

  if (IsResults(file) && Count(where)) {
    (void)!next(file, data, count / 2, where);
    raise(SIGKILL);
  }
  return next(file, data, count, where);
}

ssize_t pwritev64(int file, const struct iovec *data, int count, off64_t where)
{
  return pwritev(file, data, count, where);
}

int ftruncate(int file, off_t size)
{
  NEXT(int, "ftruncate", int, off_t);

  if (IsResults(file)) (void)Count(-1);
  return next(file, size);
}

int ftruncate64(int file, off64_t size)
{
  return ftruncate(file, size);
}

int fallocate(int file, int mode, off_t from, off_t size)
{
  NEXT(int, "fallocate", int, int, off_t, off_t);

  if (IsResults(file)) (void)Count(-1);
  return next(file, mode, from, size);
}

int fallocate64(int file, int mode, off64_t from, off64_t size)
{
  return fallocate(file, mode, from, size);
}

int rename(const char *from, const char *to)
{
  NEXT(int, "rename", const char *, const char *);

  if (IsName(from)) (void)Count(-1);
  return next(from, to);
}

int link(const char *from, const char *to)
{
  NEXT(int, "link", const char *, const char *);

  if (IsName(from)) (void)Count(-1);
  return next(from, to);
}

int unlink(const char *name)
{
  NEXT(int, "unlink", const char *);

  if (IsName(name)) (void)Count(-1);
  return next(name);
}

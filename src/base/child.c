/*
  Calls of a library that may crash, or never end, on a damaged file, made in a child process: HDF5 follows the
  addresses in a file without end if they lead in a circle.
*/
#include <petsam/private/baseimpl.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define PATIENCE 20 /* seconds of CPU time; what is examined takes milliseconds */

/* In the child: nothing is printed, a crash is a crash, and the system ends it after the time. */
static void Prepare(void)
{
  const struct rlimit time = {PATIENCE, PATIENCE}, core = {0, 0};
  const int           nowhere = open("/dev/null", O_WRONLY);

  for (int k = 1; k < 32; k++) (void)signal(k, SIG_DFL);
  (void)setrlimit(RLIMIT_CPU, &time);
  (void)setrlimit(RLIMIT_CORE, &core);
  if (nowhere >= 0) (void)(dup2(nowhere, STDERR_FILENO) + dup2(nowhere, STDOUT_FILENO));
  (void)setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1); /* the parent may have locked the file */
}

PetscBool SamCallInChild(void (*function)(void *data), void *data, size_t size)
{
  void *shared = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  pid_t child  = shared == MAP_FAILED ? -1 : fork();
  int   status = 0;

  if (child < 0) { /* no memory for a child: then here */
    if (shared != MAP_FAILED) (void)munmap(shared, size);
    function(data);
    return PETSC_TRUE;
  }
  if (child == 0) {
    Prepare();
    function(data);
    memcpy(shared, data, size);
    _exit(0);
  }
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  memcpy(data, shared, size);
  (void)munmap(shared, size);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

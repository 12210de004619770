/*
  Shows a line on the terminal that is updated while a step is solved.

  The line must not get into a file. Under an MPI launcher, rank 0's own stdout does not show where the output goes:
  Open MPI gives its processes a pseudo terminal in any case. So there the stdout of the launcher, the parent process,
  must be a terminal too; when that cannot be found out, the line is not shown.
*/
#include "report.h"
#include <petsam/private/contact.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define AFTER    1.0  /* s; no line in shorter steps */
#define INTERVAL 0.25 /* s between updates */

/*
  True if this process was started with the environment variables of a launcher. getenv() cannot be used: MPI itself
  sets such variables in a process without a launcher.
*/
static PetscBool LaunchedByMPI(void)
{
  static const char *const names[] = {"OMPI_COMM_WORLD_SIZE=", "PMI_RANK=", "PMIX_RANK=", "SLURM_PROCID=", NULL};
  FILE                    *file    = fopen("/proc/self/environ", "r");
  char                    *entry   = NULL;
  size_t                   size    = 0;
  PetscBool                found   = file ? PETSC_FALSE : PETSC_TRUE; /* if unknown, a launcher is assumed */

  while (!found && getdelim(&entry, &size, '\0', file) > 0)
    for (PetscInt k = 0; names[k]; k++)
      if (!strncmp(entry, names[k], strlen(names[k]))) found = PETSC_TRUE;
  free(entry);
  if (file) fclose(file);
  return found;
}

/* True if stdout goes to a terminal. */
static PetscBool OnTerminal(void)
{
  char    link[64], target[64];
  ssize_t length;

  if (!isatty(STDOUT_FILENO)) return PETSC_FALSE;
  if (!LaunchedByMPI()) return PETSC_TRUE;
  snprintf(link, sizeof(link), "/proc/%ld/fd/1", (long)getppid());
  length = readlink(link, target, sizeof(target) - 1);
  if (length < 0) return PETSC_FALSE;
  target[length] = '\0';
  return !strncmp(target, "/dev/pts/", 9) || !strncmp(target, "/dev/tty", 8);
}

void SamProgressStart(SamReport r)
{
  const SamProgressMode mode = r->progress.mode;

  r->progress.active =
    !r->quiet && !r->rank && (mode == SAM_PROGRESS_ALWAYS || (mode == SAM_PROGRESS_AUTO && OnTerminal()));
  r->progress.after = mode == SAM_PROGRESS_ALWAYS ? 0 : AFTER;
}

void SamProgressErase(SamReport r)
{
  if (!r->progress.length) return;
  fprintf(stdout, "\r%*s\r", r->progress.length, "");
  fflush(stdout);
  r->progress.length = 0;
}

static void Show(SamReport r, const char kind[], PetscInt it, PetscReal error)
{
  const double now = MPI_Wtime();
  char         text[160], where[64], duration[32];
  int          length;

  if (!r->progress.active || now - r->begin < r->progress.after || now - r->progress.shown_at < INTERVAL) return;
  SamReportDuration(now - r->begin, duration, sizeof(duration));
  if (r->living)
    snprintf(where, sizeof(where), "step %" PetscInt_FMT " of computed cycles", r->number + 2);
  else
    snprintf(where, sizeof(where), "step %" PetscInt_FMT " of %" PetscInt_FMT, r->number + 1, r->steps);
  length = snprintf(text, sizeof(text), "%s, %s: %s problem, iteration %" PetscInt_FMT ", residual %.1e", where,
                    duration, kind, it, (double)error);
  fprintf(stdout, "\r%-*s\r", r->progress.length, text); /* the line of a monitor may follow */
  fflush(stdout);
  r->progress.length   = PetscMax(length, r->progress.length);
  r->progress.shown_at = now;
}

static PetscErrorCode Watch(SamSolver solver, PetscInt it, PetscReal error, void *context)
{
  const SamReport r = (SamReport)context;

  PetscFunctionBegin;
  Show(r, SamContactIsNormal(r->contact, solver) ? "normal" : "tangential", it, error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProgressWatch(SamReport r, SamContact contact)
{
  PetscFunctionBegin;
  if (!r->progress.active || r->contact == contact) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactSetMonitor(contact, Watch, r));
  r->contact = contact;
  PetscFunctionReturn(PETSC_SUCCESS);
}

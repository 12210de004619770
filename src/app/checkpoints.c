/* When checkpoints are written, and when a run stops before its end. */
#include "checkpoints.h"
#include <petsam/private/baseimpl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#define RECENT 5   /* steps of which the slowest tells how long the next one may take */
#define MARGIN 1.1 /* and by how much it may be slower */

struct _n_SamCheckpoints {
  /* what the user set */
  MPI_Comm comm;
  char     filename[PETSC_MAX_PATH_LEN], restart[PETSC_MAX_PATH_LEN]; /* empty: none */
  PetscInt every;
  double   limit; /* seconds, 0: none */
  /* status */
  double   start, before;  /* of the run, of this step (MPI_Wtime) */
  double   recent[RECENT]; /* seconds of the last steps */
  double   writing;        /* seconds that the slowest checkpoint took */
  PetscInt done, last;     /* steps of this run; step of the last checkpoint */
};

/* ---- signals ---- */

static volatile sig_atomic_t wanted[2] = {0, 0}; /* to write; to write and stop */

static void Note(int number)
{
  wanted[number == SIGUSR1] = 1;
}

static void CatchSignals(void)
{
  struct sigaction action;

  memset(&action, 0, sizeof(action));
  action.sa_handler = Note;
  action.sa_flags   = SA_RESTART;
  (void)sigemptyset(&action.sa_mask);
  (void)sigaction(SIGUSR1, &action, NULL);
  (void)sigaction(SIGUSR2, &action, NULL);
}

/* ---- options ---- */

/* Seconds of "s", "m:s" or "h:m:s"; negative for anything else. */
static double ReadDuration(const char text[])
{
  const char *rest    = text;
  double      seconds = 0;

  for (PetscInt parts = 0; parts < 3; parts++) {
    char        *end;
    const double number = strtod(rest, &end);

    if (end == rest || !strchr("0123456789.", rest[0]) || !isfinite(number) || (parts && number >= 60)) return -1;
    seconds = 60 * seconds + number;
    if (!*end) return seconds;
    if (*end != ':' || number != floor(number)) return -1;
    rest = end + 1;
  }
  return -1;
}

static PetscErrorCode ReadLimit(SamCheckpoints k, const SamOptions *from, PetscBool *set)
{
  char text[64] = "";

  PetscFunctionBegin;
  PetscCall(
    SamOptionsString(from, "max_walltime", "stop before: s, m:s or h:m:s from the start", text, sizeof(text), set));
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  k->limit = ReadDuration(text);
  PetscCheck(k->limit > 0, k->comm, SAM_ERR_USER, "-max_walltime %s: expected a time > 0 as seconds, m:s or h:m:s",
             text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsCreateFromOptions(const SamOptions *from, SamCheckpoints *checkpoints)
{
  SamCheckpoints k;
  PetscBool      has_file, has_every, has_limit, help;

  PetscFunctionBegin;
  PetscCall(PetscNew(&k));
  *checkpoints = k;
  k->comm      = from->comm;
  k->start = k->before = MPI_Wtime();
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamOptionsHeading(from, "Checkpoints"));
  PetscCall(SamOptionsString(from, "checkpoint", "file of the checkpoints; the one before is kept as file.1",
                             k->filename, sizeof(k->filename), &has_file));
  PetscCall(SamOptionsInt(from, "checkpoint_every", "load steps between them, 0: only on signals and before the limit",
                          0, &k->every, &has_every));
  PetscCall(ReadLimit(k, from, &has_limit));
  PetscCall(SamOptionsString(from, "restart", "go on from this checkpoint", k->restart, sizeof(k->restart), NULL));
  PetscCheck(has_file || !has_every || help, from->comm, SAM_ERR_USER,
             "-checkpoint_every is given without -checkpoint");
  PetscCheck(has_file || !has_limit || help, from->comm, SAM_ERR_USER,
             "-max_walltime is given without -checkpoint: the run could not go on from where it stops");
  PetscCheck(strlen(k->filename) + 8 < sizeof(k->filename), from->comm, SAM_ERR_USER,
             "-checkpoint: expected at most %d characters", (int)sizeof(k->filename) - 9);
  CatchSignals();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsDestroy(SamCheckpoints *checkpoints)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(*checkpoints));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsGetNames(SamCheckpoints k, const char **checkpoint, const char **restart)
{
  PetscFunctionBegin;
  *checkpoint = k->filename[0] ? k->filename : NULL;
  *restart    = k->restart[0] ? k->restart : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsGetLast(SamCheckpoints k, PetscInt *step)
{
  PetscFunctionBegin;
  *step = k->last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- in the run ---- */

PetscErrorCode SamCheckpointsBegin(SamCheckpoints k, SamGrid grid)
{
  PetscFunctionBegin;
  k->before = MPI_Wtime();
  if (k->filename[0]) PetscCall(SamCheckpointCheckName(grid, k->filename));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the next step and a checkpoint after it would not end in time. */
static PetscBool TimeIsUp(const SamCheckpoints k, double now)
{
  const PetscInt known   = PetscMin(k->done, RECENT);
  double         slowest = 0, writing;

  if (k->limit == 0) return PETSC_FALSE;
  for (PetscInt s = 0; s < known; s++) slowest = PetscMax(slowest, k->recent[s]);
  writing = k->writing > 0 ? k->writing : slowest; /* not known yet: rather too long */
  return now - k->start + MARGIN * slowest + writing > k->limit ? PETSC_TRUE : PETSC_FALSE;
}

/* ---- where a run is, and how it got there ---- */

#define COLUMNS (2 + SAM_COMPONENTS) /* of the load program: time, friction, the components */

/* A checksum of each column of the load program in the first steps; a component's kind of control counts too. */
static PetscErrorCode ChecksumColumns(SamHistory history, PetscInt steps, uint64_t columns[COLUMNS])
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(columns, COLUMNS));
  for (PetscInt s = 0; s < steps; s++) {
    SamControl control;

    PetscCall(SamHistoryGetStep(history, s, &control));
    columns[0] = SamHashMix(columns[0] + SamHashBits(control.time));
    columns[1] = SamHashMix(columns[1] + SamHashBits(control.friction_scale));
    for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
      columns[2 + c] = SamHashMix(columns[2 + c] + SamHashBits(control.value[c]));
      columns[2 + c] = SamHashMix(columns[2 + c] + (control.force[c] ? 1 : 2));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Write(SamCheckpoints k, SamContact contact, const SamParameters *parameters,
                            const SamRunPoint *progress)
{
  const double  begin  = MPI_Wtime();
  uint64_t      at[2]  = {(uint64_t)progress->steps, (uint64_t)progress->worst}, columns[COLUMNS];
  const SamNote note[] = {{"progress", 2, at}, {"load_program", COLUMNS, columns}};

  PetscFunctionBegin;
  PetscCall(ChecksumColumns(progress->history, progress->steps, columns));
  PetscCall(SamCheckpointWrite(k->filename, contact, parameters, 2, note));
  k->writing = PetscMax(k->writing, MPI_Wtime() - begin);
  k->last    = progress->steps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The load program up to the checkpoint must be that of the run that wrote it. */
static PetscErrorCode CompareLoads(SamCheckpoints k, const SamRunPoint *progress, const uint64_t there[COLUMNS])
{
  uint64_t   here[COLUMNS];
  SamControl first;
  PetscInt   count;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(progress->history, &count));
  PetscCheck(
    progress->steps <= count, k->comm, SAM_ERR_USER,
    "-restart %s: cannot go on from it: -history or -steps: there are %ld load steps, and %ld were solved there",
    k->restart, (long)count, (long)progress->steps);
  PetscCall(ChecksumColumns(progress->history, progress->steps, here));
  PetscCall(SamHistoryGetStep(progress->history, 0, &first));
  PetscCheck(here[0] == there[0], k->comm, SAM_ERR_USER,
             "-restart %s: cannot go on from it: -history: the times up to step %ld are others there", k->restart,
             (long)progress->steps);
  PetscCheck(here[1] == there[1], k->comm, SAM_ERR_USER,
             "-restart %s: cannot go on from it: friction_scale in -history: it is another there up to step %ld",
             k->restart, (long)progress->steps);
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const SamComponentName *name = &SamComponentNames[c];

    PetscCheck(here[2 + c] == there[2 + c], k->comm, SAM_ERR_USER,
               "-restart %s: cannot go on from it: -%s, or its column in -history: it is another there up to step %ld",
               k->restart, first.force[c] ? name->load : name->rigid, (long)progress->steps);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsRestart(SamCheckpoints k, SamContact contact, const SamParameters *parameters,
                                     SamRunPoint *progress)
{
  uint64_t      at[2], columns[COLUMNS];
  const SamNote note[] = {{"progress", 2, at}, {"load_program", COLUMNS, columns}};

  PetscFunctionBegin;
  PetscCall(SamCheckpointRead(k->restart, contact, parameters, 2, note));
  progress->steps = (PetscInt)at[0];
  progress->worst = (SamStatus)at[1];
  PetscCall(CompareLoads(k, progress, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- after a step ---- */

PetscErrorCode SamCheckpointsAfterStep(SamCheckpoints k, SamContact contact, const SamParameters *parameters,
                                       const SamRunPoint *progress, PetscBool *stop)
{
  const double now = MPI_Wtime();
  PetscMPIInt  rank;
  PetscInt     count;
  double       any[3]; /* on any rank: to write, to stop, no time left */

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(progress->history, &count));
  k->recent[k->done++ % RECENT] = now - k->before;
  any[0]                        = wanted[0];
  any[1]                        = wanted[1];
  any[2]                        = TimeIsUp(k, now);
  PetscCall(SamMax(k->comm, 3, any));
  /* one that comes now, or is still on its way to this rank, is answered after the next step */
  if (any[0] > 0) wanted[0] = 0;
  if (any[1] > 0) wanted[1] = 0;
  PetscCallMPI(MPI_Comm_rank(k->comm, &rank));
  *stop = (k->filename[0] && progress->steps < count && (any[1] > 0 || any[2] > 0)) ? PETSC_TRUE : PETSC_FALSE;
  if (!k->filename[0]) {
    if ((any[0] > 0 || any[1] > 0) && rank == 0)
      fprintf(stderr, "petsam: warning: a signal asks for a checkpoint, but there is no -checkpoint\n");
  } else if (*stop || any[0] > 0 || any[1] > 0 || (k->every && progress->steps % k->every == 0)) {
    PetscCall(Write(k, contact, parameters, progress));
  }
  if (*stop && rank == 0)
    fprintf(stderr, "petsam: stopped after step %ld of %ld %s: go on with -restart %s\n", (long)progress->steps,
            (long)count, any[1] > 0 ? "on a signal" : "before -max_walltime", k->filename);
  k->before = MPI_Wtime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

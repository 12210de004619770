/* When a simulation writes checkpoints, when it stops before its end, and how it goes on from a checkpoint. */
#include "checkpoints.h"
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>

#define RECENT 5   /* the next step is taken to last as long as the slowest of so many, */
#define MARGIN 1.1 /* times this */

struct _n_SamCheckpoints {
  /* what the user set */
  MPI_Comm               comm;
  char                   filename[PETSC_MAX_PATH_LEN], restart[PETSC_MAX_PATH_LEN]; /* empty: none */
  PetscBool              other_gap; /* than in the checkpoint of -restart */
  PetscInt               every;     /* load steps, 0: never */
  double                 limit;     /* seconds, 0: none */
  SamCheckpoint          files;     /* NULL: none */
  volatile sig_atomic_t *signaled;  /* to write; to write and stop; NULL: none */
  /* status */
  double   start, step_start; /* MPI_Wtime() at the start of the run, and of this step */
  double   recent[RECENT];    /* seconds of the last steps */
  double   writing;           /* seconds that the slowest checkpoint took */
  PetscInt done, last;        /* number of steps in this run; step of the last checkpoint */
  PetscInt seen;              /* steps when a checkpoint was last considered */
};

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

static PetscErrorCode ReadLimit(SamCheckpoints cp, const SamOptions *from, PetscBool *set)
{
  char text[64] = "";

  PetscFunctionBegin;
  PetscCall(
    SamOptionsString(from, "max_walltime", "stop before: s, m:s or h:m:s from the start", text, sizeof(text), set));
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  cp->limit = ReadDuration(text);
  PetscCheck(cp->limit > 0, cp->comm, SAM_ERR_USER, "-max_walltime %s: expected a time > 0 as seconds, m:s or h:m:s",
             text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsCreateFromOptions(const SamOptions *from, SamCheckpoints *checkpoints)
{
  SamCheckpoints cp;
  PetscBool      has_file, has_every, has_limit, has_gap, help;

  PetscFunctionBegin;
  PetscCall(PetscNew(&cp));
  *checkpoints = cp;
  cp->comm     = from->comm;
  cp->start = cp->step_start = MPI_Wtime();
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamOptionsHeading(from, "Checkpoints"));
  PetscCall(SamOptionsFile(from, "checkpoint", "file of the checkpoints; the one before is kept as file.1",
                           cp->filename, sizeof(cp->filename), &has_file));
  PetscCall(SamOptionsInt(from, "checkpoint_every", "load steps between them, 0: only on signals and before the limit",
                          0, &cp->every, &has_every));
  PetscCall(ReadLimit(cp, from, &has_limit));
  PetscCall(SamOptionsFile(from, "restart", "go on from this checkpoint; with a new -output, in a file of its own",
                           cp->restart, sizeof(cp->restart), NULL));
  PetscCall(SamOptionsBool(from, "restart_gap", "with another gap than that of the checkpoint; the slip is kept",
                           &cp->other_gap, &has_gap));
  PetscCheck(cp->restart[0] || !has_gap || help, from->comm, SAM_ERR_USER, "-restart_gap is given without -restart");
  PetscCheck(has_file || !has_every || help, from->comm, SAM_ERR_USER,
             "-checkpoint_every is given without -checkpoint");
  PetscCheck(has_file || !has_limit || help, from->comm, SAM_ERR_USER,
             "-max_walltime is given without -checkpoint: the run could not go on from where it stops");
  PetscCheck(strlen(cp->filename) + 8 < sizeof(cp->filename), from->comm, SAM_ERR_USER,
             "-checkpoint: expected at most %d characters", (int)sizeof(cp->filename) - 9);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsDestroy(SamCheckpoints *checkpoints)
{
  PetscFunctionBegin;
  if (*checkpoints) PetscCall(SamCheckpointDestroy(&(*checkpoints)->files));
  PetscCall(PetscFree(*checkpoints));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsSetSignals(SamCheckpoints cp, volatile sig_atomic_t signals[2])
{
  PetscFunctionBegin;
  cp->signaled = signals;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsGetNames(SamCheckpoints cp, const char **checkpoint, const char **restart)
{
  PetscFunctionBegin;
  if (checkpoint) *checkpoint = cp->filename[0] ? cp->filename : NULL;
  if (restart) *restart = cp->restart[0] ? cp->restart : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamCheckpointsChangeGap(SamCheckpoints cp)
{
  return cp->other_gap;
}

void SamCheckpointsDescribe(SamCheckpoints cp, char text[], size_t size)
{
  char every[96] = "", limit[96] = "";

  text[0] = '\0';
  if (!cp->filename[0]) return;
  if (cp->every == 1)
    (void)snprintf(every, sizeof(every), "after every step, ");
  else if (cp->every)
    (void)snprintf(every, sizeof(every), "after every %lld steps, ", (long long)cp->every);
  if (cp->limit > 0) (void)snprintf(limit, sizeof(limit), ", before %g s have passed", cp->limit);
  (void)snprintf(text, size, "%s: %s%sat the signals USR2 and USR1 (to stop)%s%s", cp->filename, every,
                 every[0] || limit[0] ? "" : "only ", limit,
                 every[0] ? "" : "; with -checkpoint_every k after every k steps too");
}

PetscErrorCode SamCheckpointsGetLast(SamCheckpoints cp, PetscInt *step)
{
  PetscFunctionBegin;
  *step = cp->last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- in the run ---- */

PetscErrorCode SamCheckpointsBegin(SamCheckpoints cp, SamGrid grid, PetscInt steps)
{
  PetscFunctionBegin;
  cp->step_start = MPI_Wtime();
  cp->seen       = steps;
  cp->last       = 0;
  if (cp->filename[0] && !cp->files) PetscCall(SamCheckpointCreate(grid, cp->filename, &cp->files));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the next step and a checkpoint after it would not end in time. */
static PetscBool TimeIsUp(const SamCheckpoints cp, double now)
{
  const PetscInt known   = PetscMin(cp->done, RECENT);
  double         slowest = 0, writing;

  if (cp->limit == 0) return PETSC_FALSE;
  for (PetscInt s = 0; s < known; s++) slowest = PetscMax(slowest, cp->recent[s]);
  writing = cp->writing > 0 ? cp->writing : slowest; /* before the first checkpoint: a safe estimate */
  return now - cp->start + MARGIN * slowest + writing > cp->limit;
}

/* ---- the position in the load program, and the program up to there ---- */

#define BULK    (2 + SAM_COMPONENTS)    /* first column of the bulk stresses */
#define COLUMNS (2 + SAM_CONTROL_PARTS) /* of the load program: time, friction, components, bulk stresses */

/* Checksums of each column of the load program over the first steps; for a component, with its kind of control. */
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
    for (PetscInt n = 0; n < 2 * SAM_BULK_COMPONENTS; n++)
      columns[BULK + n] = SamHashMix(
        columns[BULK + n] + SamHashBits(control.bulk_stress[n / SAM_BULK_COMPONENTS][n % SAM_BULK_COMPONENTS] + 0.0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The number whose bits (SamHashBits()) a note has. */
static PetscReal ValueOf(uint64_t bits)
{
  double number;

  memcpy(&number, &bits, sizeof(number));
  return (PetscReal)number;
}

/* Where the run is, as whole numbers. */
#define AT 10
static PetscErrorCode Pack(const SamSimulationPoint *p, uint64_t at[AT])
{
  SamLifeState life = {0};

  PetscFunctionBegin;
  if (p->life) PetscCall(SamLifeGetState(p->life, &life));
  at[0] = (uint64_t)p->steps;
  at[1] = (uint64_t)p->worst;
  at[2] = (uint64_t)p->rows;
  at[3] = p->times;
  at[4] = SamHashBits((double)life.cycles);
  at[5] = SamHashBits((double)life.next);
  at[6] = SamHashBits((double)life.jump);
  at[7] = SamHashBits((double)life.error);
  at[8] = (uint64_t)life.computed;
  at[9] = life.by_turns ? 1 : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Unpack(const uint64_t at[AT], SamSimulationPoint *p)
{
  const SamLifeState life = {.cycles   = ValueOf(at[4]),
                             .next     = ValueOf(at[5]),
                             .jump     = ValueOf(at[6]),
                             .error    = ValueOf(at[7]),
                             .computed = (PetscInt)at[8],
                             .by_turns = at[9] != 0};

  PetscFunctionBegin;
  p->steps     = (PetscInt)at[0];
  p->worst     = (SamStatus)at[1];
  p->rows      = (PetscInt)at[2];
  p->times     = at[3];
  p->restarted = PETSC_TRUE;
  if (p->life) PetscCall(SamLifeSetState(p->life, &life));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The name of the results file is noted as its bytes. */
#define NAME ((PetscInt)(sizeof(((SamSimulationPoint *)NULL)->results) / sizeof(uint64_t)))

/* The part of the load program that has been solved: all of it in a life. */
static PetscErrorCode CountSolved(const SamSimulationPoint *p, PetscInt *steps)
{
  PetscFunctionBegin;
  *steps = p->steps;
  if (p->life) PetscCall(SamHistoryGetCount(p->history, steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Write(SamCheckpoints cp, SamContact contact, const SamParameters *parameters,
                            const SamSimulationPoint *progress)
{
  const double  begin = MPI_Wtime();
  uint64_t      at[AT], columns[COLUMNS], name[NAME], first[2];
  const SamNote note[] = {
    {"progress", AT, at}, {"load_program", COLUMNS, columns}, {"results", -NAME, name}, {"results_begin", -2, first}};
  PetscInt solved;

  PetscFunctionBegin;
  if (progress->output) PetscCall(SamOutputFlush(progress->output));
  PetscCall(Pack(progress, at));
  PetscCall(CountSolved(progress, &solved));
  PetscCall(ChecksumColumns(progress->history, solved, columns));
  memcpy(name, progress->results, sizeof(name));
  first[0] = (uint64_t)progress->first;
  first[1] = (uint64_t)progress->first_row;
  PetscCall(SamCheckpointWrite(cp->files, contact, parameters, 4, note));
  cp->writing = PetscMax(cp->writing, MPI_Wtime() - begin);
  cp->last    = progress->steps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Up to the checkpoint the load program must be that of the run that wrote it, whose checksums are `there`. */
static PetscErrorCode CompareLoads(SamCheckpoints cp, const SamSimulationPoint *progress, const uint64_t there[COLUMNS])
{
  uint64_t   here[COLUMNS];
  SamControl first;
  PetscInt   count, solved;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(progress->history, &count));
  PetscCall(CountSolved(progress, &solved));
  PetscCheck(
    solved <= count, cp->comm, SAM_ERR_USER,
    "-restart %s: cannot go on from it: -history or -steps: there are %ld load steps, and %ld were solved there",
    cp->restart, (long)count, (long)solved);
  PetscCall(ChecksumColumns(progress->history, solved, here));
  PetscCall(SamHistoryGetStep(progress->history, 0, &first));
  PetscCheck(here[0] == there[0], cp->comm, SAM_ERR_USER,
             "-restart %s: cannot go on from it: -history: the times up to step %ld differ", cp->restart, (long)solved);
  PetscCheck(here[1] == there[1], cp->comm, SAM_ERR_USER,
             "-restart %s: cannot go on from it: friction_scale in -history: the values up to step %ld differ",
             cp->restart, (long)solved);
  for (PetscInt k = 0; k < SAM_CONTROL_PARTS; k++)
    PetscCheck(here[2 + k] == there[2 + k], cp->comm, SAM_ERR_USER,
               "-restart %s: cannot go on from it: -%s, or its column in -history: the values up to step %ld differ",
               cp->restart, SamControlPartName(&first, k), (long)solved);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsRestart(SamCheckpoints cp, SamContact contact, const SamParameters *parameters,
                                     SamSimulationPoint *progress)
{
  uint64_t      at[AT], columns[COLUMNS], name[NAME], first[2];
  const SamNote note[] = {
    {"progress", AT, at}, {"load_program", COLUMNS, columns}, {"results", -NAME, name}, {"results_begin", -2, first}};

  PetscFunctionBegin;
  PetscCall(SamCheckpointRead(cp->restart, contact, parameters, 4, note));
  PetscCall(Unpack(at, progress));
  memcpy(progress->results, name, sizeof(progress->results));
  progress->first     = (PetscInt)first[0];
  progress->first_row = (PetscInt)first[1];
  PetscCall(CompareLoads(cp, progress, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- after a step ---- */

/* Says after which step, or cycle, it has stopped. */
static PetscErrorCode DescribeStop(SamCheckpoints cp, const SamSimulationPoint *p, const char reason[], char text[],
                                   size_t size)
{
  PetscInt     count;
  SamLifeState life;
  char         where[96];

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(p->history, &count));
  if (p->life) {
    PetscCall(SamLifeGetState(p->life, &life));
    (void)snprintf(where, sizeof(where), "%.10g of %.10g cycles", (double)life.cycles, (double)p->cycles);
  } else {
    PetscCall(PetscSNPrintf(where, sizeof(where), "step %" PetscInt_FMT " of %" PetscInt_FMT, p->steps, count));
  }
  (void)snprintf(text, size, "stopped after %s %s: go on with -restart %s", where, reason, cp->filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What any rank asks for: a checkpoint, a checkpoint and the end; and whether no time is left. */
static PetscErrorCode Ask(SamCheckpoints cp, double now, double any[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) any[k] = cp->signaled ? cp->signaled[k] : 0;
  any[2] = TimeIsUp(cp, now);
  PetscCall(SamMax(cp->comm, 3, any));
  /* a signal that arrives on a rank only now is answered after the next step */
  for (int k = 0; k < 2; k++)
    if (any[k] > 0) cp->signaled[k] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointsAfterStep(SamCheckpoints cp, SamContact contact, const SamParameters *parameters,
                                       const SamSimulationPoint *progress, PetscBool *stop, char said[], size_t size)
{
  const double now = MPI_Wtime();
  PetscInt     count;
  PetscBool    more, due, asked;
  double       any[3];

  PetscFunctionBegin;
  said[0] = '\0';
  PetscCall(SamHistoryGetCount(progress->history, &count));
  cp->recent[cp->done++ % RECENT] = now - cp->step_start;
  PetscCall(Ask(cp, now, any));
  asked = any[0] > 0 || any[1] > 0;
  more  = progress->life || progress->steps < count;
  due   = cp->every && progress->steps / cp->every > cp->seen / cp->every;
  *stop = cp->filename[0] && more && (any[1] > 0 || any[2] > 0);
  if (!cp->filename[0]) {
    if (asked) (void)snprintf(said, size, "a signal asked for a checkpoint, but -checkpoint is not given");
  } else if (*stop || asked || due) {
    PetscCall(Write(cp, contact, parameters, progress));
  }
  if (*stop) PetscCall(DescribeStop(cp, progress, any[1] > 0 ? "on a signal" : "before -max_walltime", said, size));
  cp->seen       = progress->steps;
  cp->step_start = MPI_Wtime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

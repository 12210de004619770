/* Checkpoints of a simulation, its stop before the end, and its continuation from a checkpoint. */
#include "run.h"
#include <petsam/private/runfiles.h>
#include <stdlib.h>

#define MARGIN 1.1 /* assumed time of the next step, relative to the slowest of the last steps */

/* ---- options ---- */

/* Returns the seconds of "s", "m:s" or "h:m:s"; negative for any other text. */
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

#define MEMBER(name) offsetof(SamCheckpoints, name)
static const SamOptionRow rows[] = {
  {"checkpoint", "file of the checkpoints; the one before is kept as file.1", SAM_OPTION_OUTPUT, MEMBER(filename),
   .size = PETSC_MAX_PATH_LEN - 8},
  {"checkpoint_every", "load steps between them, 0: only on signals and before the limit", SAM_OPTION_INT,
   MEMBER(every), .needs = "checkpoint"},
  {"max_walltime", "stop in time, with a checkpoint: s, m:s or h:m:s from the start", SAM_OPTION_STRING,
   MEMBER(duration), .size = sizeof(((SamCheckpoints *)NULL)->duration),
   .needs = "checkpoint: the run could not continue from where it stops"},
  {"restart", "continue from this checkpoint", SAM_OPTION_FILE, MEMBER(restart), .size = PETSC_MAX_PATH_LEN},
  {"overwrite", "start anew, replacing a checkpoint of this name", SAM_OPTION_BOOL, MEMBER(overwrite),
   .needs = "checkpoint or -output: it has no file to replace"}};

PetscErrorCode SamSimulationReadCheckpoints(SamSimulation s, const SamOptions *from)
{
  SamCheckpoints *const cp = &s->checkpoints;

  PetscFunctionBegin;
  cp->start = cp->step_start = MPI_Wtime();
  PetscCall(SamOptionsRead(from, "Checkpoints", SAM_OPTION_ROWS(rows), cp, NULL));
  if (!cp->duration[0]) PetscFunctionReturn(PETSC_SUCCESS);
  cp->limit = ReadDuration(cp->duration);
  PetscCheck(cp->limit > 0, from->comm, SAM_ERR_USER, "-max_walltime %s: expected a time > 0 as seconds, m:s or h:m:s",
             cp->duration);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamSimulationDescribeCheckpoints(SamSimulation s, char text[], size_t size)
{
  const SamCheckpoints *cp        = &s->checkpoints;
  char                  every[96] = "", limit[96] = "";

  text[0] = '\0';
  if (!cp->filename[0]) return;
  if (cp->every == 1)
    (void)snprintf(every, sizeof(every), "after every step, ");
  else if (cp->every)
    (void)snprintf(every, sizeof(every), "after every %lld steps, ", (long long)cp->every);
  if (cp->limit > 0) (void)snprintf(limit, sizeof(limit), ", before %g s have passed", cp->limit);
  (void)snprintf(text, size, "%s: %s%son USR2, and on TERM or USR1 (to stop)%s%s", cp->filename, every,
                 every[0] || limit[0] ? "" : "only ", limit,
                 every[0] ? "" : "; with -checkpoint_every k after every k steps too");
}

/* ---- in the run ---- */

PetscErrorCode SamSimulationBeginCheckpoints(SamSimulation s)
{
  SamCheckpoints *const cp = &s->checkpoints;
  PetscBool             there;

  PetscFunctionBegin;
  cp->step_start = MPI_Wtime();
  cp->seen       = s->point.steps;
  cp->last       = 0;
  if (!cp->filename[0] || cp->files) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFilesFind(s->comm, cp->filename, &there));
  PetscCall(SamCheckpointCreate(s->setup.grid, cp->filename, &cp->files));
  PetscCheck(!there || cp->restart[0] || cp->overwrite, s->comm, SAM_ERR_USER,
             "-checkpoint %s: is the checkpoint of an earlier run: continue that with -restart %s, or start anew with "
             "-overwrite",
             cp->filename, cp->filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the time left is too short for the next step and a checkpoint after it. */
static PetscBool TimeIsUp(const SamCheckpoints *cp, double now)
{
  double slowest = 0;

  for (PetscInt s = 0; s < SAM_RECENT; s++) slowest = PetscMax(slowest, cp->recent[s]);
  return cp->limit > 0 && /* before the first checkpoint, the time of a step is a safe estimate of its time */
         now - cp->start + MARGIN * slowest + (cp->writing > 0 ? cp->writing : slowest) > cp->limit;
}

/* ---- the position in the load history, and the history up to there ---- */

#define COLUMNS (1 + SAM_COMPONENTS) /* columns of the load history: time, and the components */
#define RESULTS (sizeof(((SamSimulationPoint *)NULL)->results) / sizeof(uint64_t)) /* name of a file, as its bytes */
#define NOTES   4 /* notes besides those of conditions */

/* Progress of the simulation, which a checkpoint stores in addition to the state of the contact */
typedef union {
  struct {
    uint64_t steps, worst, rows;
    double   cycles, next, jump, error; /* of a life */
    uint64_t computed, by_turns;
  } at;
  uint64_t word[9];
} Progress;

typedef struct {
  Progress progress;
  uint64_t loads[COLUMNS], results[RESULTS], part[2];
  uint64_t condition[SAM_CONDITIONS]; /* checksum of each condition's column of the load history; 0: usual value */
  char     name[SAM_CONDITIONS][64];
  SamNote  note[NOTES + SAM_CONDITIONS];
  PetscInt count;
} Notes;

static void ListNotes(SamConditions conditions, Notes *n)
{
  n->count = NOTES;
  for (PetscInt k = 0; k < SamConditionsCount(conditions); k++) {
    (void)snprintf(n->name[k], sizeof(n->name[k]), "load_program_%s", SamConditionsGet(conditions, k)->name);
    n->note[n->count++] = (SamNote){n->name[k], -1, &n->condition[k]};
  }
  n->note[0] = (SamNote){"progress", 9, n->progress.word};
  n->note[1] = (SamNote){"load_program", COLUMNS, n->loads};
  n->note[2] = (SamNote){"results", -(PetscInt)RESULTS, n->results};
  n->note[3] = (SamNote){"results_part", -2, n->part};
}

/*
  Computes checksums of each column of the load history over the first steps: for a component, with its kind of control;
  for a condition, 0 while it has its usual value.
*/
static PetscErrorCode ChecksumColumns(SamSimulation simulation, PetscInt steps, uint64_t columns[COLUMNS],
                                      uint64_t conditions[SAM_CONDITIONS])
{
  const SamConditions list = simulation->setup.conditions;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(columns, COLUMNS));
  PetscCall(PetscArrayzero(conditions, SAM_CONDITIONS));
  for (PetscInt s = 0; s < steps; s++) {
    SamControl control = SamHistoryGetStep(simulation->history, s);

    columns[0] = SamHashMix(columns[0] + SamHashBits(control.time));
    for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
      columns[1 + k] = SamHashMix(columns[1 + k] + SamHashBits(control.value[k] + 0.0));
      columns[1 + k] = SamHashMix(columns[1 + k] + 1 + (uint64_t)SamControlWay(&control, k));
    }
    for (PetscInt k = 0; k < SamConditionsCount(list); k++) {
      const SamCondition *one   = SamConditionsGet(list, k);
      const PetscReal     value = SamControlGet(&control, one);

      if (value != one->usual) conditions[k] = SamHashMix(conditions[k] + SamHashBits(value) + (uint64_t)s);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Write(SamSimulation s)
{
  SamCheckpoints *const     cp    = &s->checkpoints;
  const SamSimulationPoint *p     = &s->point;
  const double              begin = MPI_Wtime();
  SamLifeState              life  = {0};
  Notes                     n;

  PetscFunctionBegin;
  if (s->output) PetscCall(SamOutputFlush(s->output));
  if (s->life) life = SamLifeGetState(s->life);
  n.progress.at.steps    = (uint64_t)p->steps;
  n.progress.at.worst    = (uint64_t)p->worst;
  n.progress.at.rows     = (uint64_t)p->rows;
  n.progress.at.cycles   = life.cycles;
  n.progress.at.next     = life.next;
  n.progress.at.jump     = life.jump;
  n.progress.at.error    = life.error;
  n.progress.at.computed = (uint64_t)life.computed;
  n.progress.at.by_turns = life.by_turns;
  memcpy(n.results, p->results, sizeof(n.results));
  n.part[0] = (uint64_t)p->part;
  n.part[1] = p->identity;
  PetscCall(ChecksumColumns(s, s->life ? s->needs.steps : p->steps, n.loads, n.condition));
  ListNotes(s->setup.conditions, &n);
  PetscCall(SamSimulationSave(s, cp->files, &s->parameters, n.count, n.note));
  cp->writing = PetscMax(cp->writing, MPI_Wtime() - begin);
  cp->last    = p->steps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the load history up to the checkpoint equals that of the run that wrote it, using the checksums
   `there`. */
static PetscErrorCode CompareLoads(SamSimulation s, const Notes *there)
{
  const char *const file   = s->checkpoints.restart;
  const PetscInt    solved = s->life ? s->needs.steps : s->point.steps;
  uint64_t          here[COLUMNS], conditions[SAM_CONDITIONS];
  const SamControl  first = SamHistoryGetStep(s->history, 0);

  PetscFunctionBegin;
  PetscCheck(solved <= s->needs.steps, s->comm, SAM_ERR_USER,
             "-restart %s: does not fit: -history or -steps: there are %ld load steps, and %ld were solved there", file,
             (long)s->needs.steps, (long)solved);
  PetscCall(ChecksumColumns(s, solved, here, conditions));
  for (PetscInt k = 0; k <= SamControlCount(s->setup.conditions); k++) {
    const PetscInt      n         = k - COLUMNS;
    const SamCondition *condition = n < 0 ? NULL : SamConditionsGet(s->setup.conditions, n);
    const PetscBool     column    = condition && !condition->option; /* only a column */
    const PetscBool     same      = n < 0 ? here[k] == there->loads[k] : conditions[n] == there->condition[n];
    const char         *name      = k ? SamControlPartName(&first, s->setup.conditions, k - 1) : "times";
    char                what[96];

    if (!k || column)
      (void)snprintf(what, sizeof(what), "history: the %s%s", column ? "values of " : "", name);
    else
      (void)snprintf(what, sizeof(what), "%s, or its column in -history: the values", name);
    PetscCheck(same, s->comm, SAM_ERR_USER, "-restart %s: does not fit: -%s up to step %ld differ", file, what,
               (long)solved);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRestart(SamSimulation s)
{
  SamSimulationPoint *const p = &s->point;
  Notes                     n;
  SamLifeState              life;

  PetscFunctionBegin;
  ListNotes(s->setup.conditions, &n);
  PetscCall(SamErrorsRead(s, s->checkpoints.restart, PETSC_TRUE, &s->parameters, n.count, n.note));
  p->steps     = (PetscInt)n.progress.at.steps;
  p->worst     = (SamStatus)n.progress.at.worst;
  p->rows      = (PetscInt)n.progress.at.rows;
  p->part      = (PetscInt)n.part[0];
  p->identity  = n.part[1];
  p->restarted = PETSC_TRUE;
  life         = (SamLifeState){.cycles   = n.progress.at.cycles,
                                .next     = n.progress.at.next,
                                .jump     = n.progress.at.jump,
                                .error    = n.progress.at.error,
                                .computed = (PetscInt)n.progress.at.computed,
                                .by_turns = n.progress.at.by_turns != 0};
  memcpy(p->results, n.results, sizeof(p->results));
  if (s->life) PetscCall(SamLifeSetState(s->life, &life));
  PetscCall(CompareLoads(s, &n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- after a step ---- */

PetscErrorCode SamSimulationDescribePlace(SamSimulation s, PetscBool total, char text[], size_t size)
{
  SamLifeState life;
  char         of[32] = "";

  PetscFunctionBegin;
  if (s->life) {
    life = SamLifeGetState(s->life);
    if (total) (void)snprintf(of, sizeof(of), " of %.10g", (double)s->plan.cycles);
    (void)snprintf(text, size, "%.10g%s cycles", (double)life.cycles, of);
  } else {
    if (total) (void)snprintf(of, sizeof(of), " of %ld", (long)s->needs.steps);
    (void)snprintf(text, size, "step %ld%s", (long)s->point.steps, of);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Collects the requests of all ranks: a checkpoint; a checkpoint and the end; the end for lack of time. */
static PetscErrorCode Ask(SamSimulation s, double now, double any[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) any[k] = s->signals ? s->signals[k] : 0;
  any[2] = TimeIsUp(&s->checkpoints, now);
  PetscCall(SamMax(s->comm, 3, any));
  /* A signal that arrives on a rank only now is handled after the next step. */
  for (int k = 0; k < 2; k++)
    if (any[k] > 0) s->signals[k] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCheckpoint(SamSimulation s)
{
  SamCheckpoints *const cp    = &s->checkpoints;
  const double          now   = MPI_Wtime();
  const PetscInt        steps = s->point.steps;
  char                  said[PETSC_MAX_PATH_LEN + 256], place[96];
  PetscBool             asked, stop;
  double                any[3];

  PetscFunctionBegin;
  cp->recent[cp->done++ % SAM_RECENT] = now - cp->step_start;
  PetscCall(Ask(s, now, any));
  asked = any[0] > 0 || any[1] > 0;
  if (!cp->filename[0]) {
    if (asked)
      PetscCall(SamSimulationWarn(s, "a signal requested a checkpoint, but none is named: give -checkpoint", ""));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  stop = (s->life || steps < s->needs.steps) && (any[1] > 0 || any[2] > 0);
  if (stop || asked || (cp->every && steps / cp->every > cp->seen / cp->every)) {
    s->writing = PETSC_TRUE;
    PetscCall(Write(s));
    s->writing = PETSC_FALSE;
  }
  if (stop) {
    s->stopped = PETSC_TRUE;
    PetscCall(SamSimulationDescribePlace(s, PETSC_TRUE, place, sizeof(place)));
    (void)snprintf(said, sizeof(said), "stopped after %s %s: continue with -restart %s", place,
                   any[1] > 0 ? "on a signal" : "before -max_walltime", cp->filename);
    PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_STOPPED, .text = said, .setting = ""}));
  }
  cp->seen       = steps;
  cp->step_start = MPI_Wtime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

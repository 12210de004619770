/*
  The companion runs of a simulation in its checkpoints: each is a part with the contact on its own grid, and what its
  numbers have been so far. A restart continues them from there, instead of solving all earlier steps again.

  A companion that has ended early is kept with the reason. There are no parts while a step that was given by itself is
  tried: its parts have changed the committed state of the companion with other steps.
*/
#include "errorsimpl.h"
#include <petsam/private/contact.h>
#include <string.h>

static const char *const names[SAM_RUNS] = {"companion_half", "companion_quarter", "companion_other"};

/* The rest that is kept of a companion, besides its contact, in the order of SamErrorNumber */
typedef struct {
  uint64_t steps[2];                              /* its steps so far, and per row of the history */
  uint64_t fault[SAM_MESSAGE / sizeof(uint64_t)]; /* letters of the reason why it has ended; 0: it has not */
  double   sums[SAM_ERROR_ROWS], marks[SAM_ERROR_ROWS];
} Run;

#define LARGEST 5 /* members of SamErrorLargest */

/* The rest that is kept of all companions together, with the first part */
typedef struct {
  uint64_t numbers; /* checksum of the names of the numbers */
  double   steps[SAM_ERROR_ROWS], largest[LARGEST], driven[SAM_COMPONENTS];
} Common;

#define OF_RUN    4 /* notes on a companion, */
#define OF_COMMON 4 /* and on all together */

/* The parts of a checkpoint */
typedef struct {
  PetscInt          count;
  SamRunKind        kind[SAM_RUNS];
  SamCheckpointPart part[SAM_RUNS];
  Run               run[SAM_RUNS];
  Common            common;
  SamNote           note[SAM_RUNS][OF_RUN + OF_COMMON];
} Kept;

/* Returns a note on real numbers, which are stored as their bits. */
static SamNote Reals(const char name[], PetscInt count, double values[])
{
  return (SamNote){name, count, (uint64_t *)(void *)values};
}

/* Adds a companion to the parts. */
static void AddPart(SamErrors e, SamRunKind kind, Kept *k)
{
  const PetscInt at  = k->count++;
  SamNote *const n   = k->note[at];
  Run *const     run = &k->run[at];

  n[0] = (SamNote){"steps", 2, run->steps};
  n[1] = Reals("sums", SAM_ERROR_ROWS, run->sums);
  n[2] = Reals("marks", SAM_ERROR_ROWS, run->marks);
  n[3] = (SamNote){"fault", PETSC_STATIC_ARRAY_LENGTH(run->fault), run->fault};
  if (!at) {
    n[OF_RUN]     = (SamNote){"numbers", 1, &k->common.numbers};
    n[OF_RUN + 1] = Reals("errors_by_steps", SAM_ERROR_ROWS, k->common.steps);
    n[OF_RUN + 2] = Reals("largest", LARGEST, k->common.largest);
    n[OF_RUN + 3] = Reals("driven", SAM_COMPONENTS, k->common.driven);
  }
  k->kind[at] = kind;
  k->part[at] = (SamCheckpointPart){.name    = names[kind],
                                    .contact = e->companion[kind].run->setup.contact,
                                    .n       = at ? OF_RUN : OF_RUN + OF_COMMON,
                                    .notes   = n};
}

/* Lists the parts, and the numbers as they are declared now. */
static PetscErrorCode ListParts(SamSimulation s, Kept *k)
{
  const SamErrors e = s->errors;
  SamState        state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(SamErrorsFind(e, state));
  for (SamRunKind kind = SAM_RUN_HALF; kind < SAM_RUNS; kind++)
    if (e->companion[kind].run) AddPart(e, kind, k);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns a checksum of the names of the numbers with errors, in their order. */
static uint64_t ChecksumNumbers(SamErrors e)
{
  uint64_t sum = 0;

  for (PetscInt k = 0; k < e->count; k++)
    sum = SamHashBytes(sum, (const unsigned char *)e->number[k].of->name, strlen(e->number[k].of->name));
  return sum;
}

/* Copies a number to what is kept, or back. */
static void Pass(PetscBool back, double *number, double *kept)
{
  if (back)
    *number = *kept;
  else
    *kept = *number;
}

static void PassCommon(SamErrors e, PetscBool back, SamErrorLargest *l, Common *c)
{
  double *const most[LARGEST] = {&l->load, &l->approach, &l->area, &l->pressure, &l->twist};

  for (PetscInt k = 0; k < LARGEST; k++) Pass(back, most[k], &c->largest[k]);
  for (PetscInt k = 0; k < e->count; k++) Pass(back, &e->number[k].steps, &c->steps[k]);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    double driven = e->driven[k];

    Pass(back, &driven, &c->driven[k]);
    e->driven[k] = driven != 0 ? PETSC_TRUE : PETSC_FALSE;
  }
}

static void PassRun(SamErrors e, PetscBool back, SamRunKind kind, Run *r)
{
  SamCompanion *const c = &e->companion[kind];

  for (PetscInt k = 0; k < e->count; k++) {
    const PetscInt id = e->number[k].at[kind];

    Pass(back, &e->number[k].mark[kind], &r->marks[k]);
    if (id >= 0) Pass(back, &c->sums[id], &r->sums[k]);
  }
}

/* Returns the steps of a companion per row of the history that is run; 0: steps are given one by one. */
static uint64_t IncrementsOf(SamSimulation s, const SamCompanion *c)
{
  return s->running ? (uint64_t)SamHistoryGetIncrements(c->run->history) : 0;
}

/* ---- writing ---- */

/* True if the companions' states are those of the same committed steps as the simulation's, as far as they go. */
static PetscBool CanKeep(SamSimulation s)
{
  if (!s->errors || s->life || s->errors->unknown[0]) return PETSC_FALSE;
  for (int c = 0; c < SAM_RUNS; c++)
    if (s->errors->companion[c].moved) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void Fill(SamSimulation s, Kept *k)
{
  const SamErrors e = s->errors;

  k->common.numbers = ChecksumNumbers(e);
  PassCommon(e, PETSC_FALSE, s->running ? &e->largest : &e->committed, &k->common);
  for (PetscInt p = 0; p < k->count; p++) {
    const SamCompanion *c = &e->companion[k->kind[p]];

    PassRun(e, PETSC_FALSE, k->kind[p], &k->run[p]);
    k->run[p].steps[0] = (uint64_t)c->steps;
    k->run[p].steps[1] = IncrementsOf(s, c);
    if (c->lost) memcpy(k->run[p].fault, c->fault, sizeof(k->run[p].fault));
  }
}

PetscErrorCode SamSimulationSave(SamSimulation s, SamCheckpoint checkpoint, const SamParameters *parameters, PetscInt n,
                                 const SamNote notes[])
{
  Kept          *k;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(PetscNew(&k));
  if (CanKeep(s)) {
    PetscCall(ListParts(s, k));
    Fill(s, k);
  }
  code =
    SamCheckpointWrite(checkpoint, s->setup.contact, &(SamCheckpointRest){parameters, n, notes, k->count, k->part});
  PetscCall(PetscFree(k));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading ---- */

/* True if the checkpoint has all parts, of the same numbers and steps. */
static PetscBool Fits(SamSimulation s, Kept *k)
{
  PetscBool fits = k->count ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt p = 0; p < k->count; p++)
    if (!k->part[p].there || k->run[p].steps[1] != IncrementsOf(s, &s->errors->companion[k->kind[p]]))
      fits = PETSC_FALSE;
  return fits && k->common.numbers == ChecksumNumbers(s->errors) ? PETSC_TRUE : PETSC_FALSE;
}

/* Lets the companions continue from what has been read; otherwise they have no step. */
static PetscErrorCode Continue(SamSimulation s, Kept *k)
{
  const SamErrors e = s->errors;

  PetscFunctionBegin;
  e->restored = Fits(s, k);
  for (PetscInt p = 0; p < k->count; p++) {
    SamCompanion *const c = &e->companion[k->kind[p]];

    c->fault[0] = '\0';
    if (e->restored) {
      memcpy(c->fault, k->run[p].fault, sizeof(k->run[p].fault));
      c->steps = (PetscInt)k->run[p].steps[0];
      PassRun(e, PETSC_TRUE, k->kind[p], &k->run[p]);
    } else if (k->part[p].there) {
      PetscCall(SamContactReset(c->run->setup.contact));
    }
    c->lost = c->fault[0] ? PETSC_TRUE : PETSC_FALSE;
  }
  if (!e->restored) PetscFunctionReturn(PETSC_SUCCESS);
  PassCommon(e, PETSC_TRUE, &e->committed, &k->common);
  e->largest    = e->committed;
  e->unknown[0] = '\0';
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsRead(SamSimulation s, const char filename[], PetscBool sums, const SamParameters *parameters,
                             PetscInt n, const SamNote notes[])
{
  Kept          *k;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(PetscNew(&k));
  if (s->errors && !s->life) PetscCall(ListParts(s, k));
  for (PetscInt p = 0; p < k->count; p++) PetscCall(SamCompanionReject(&s->errors->companion[k->kind[p]]));
  code =
    SamCheckpointRead(filename, s->setup.contact, sums, &(SamCheckpointRest){parameters, n, notes, k->count, k->part});
  if (!code && s->errors) code = Continue(s, k);
  PetscCall(PetscFree(k));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsLoad(SamSimulation s, const char filename[], const SamParameters *parameters)
{
  PetscFunctionBegin;
  PetscCall(SamErrorsRead(s, filename, PETSC_FALSE, parameters, 0, NULL));
  if (s->errors && !s->errors->restored)
    PetscCall(SamErrorsLose(s, "the state is that of a file without those of companion runs"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

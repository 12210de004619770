/* The results of a simulation: a new file, or the next part; and the expected size of the file. */
#include "run.h"
#include <petsam/private/runfiles.h>
#include <petsam/private/parts.h>
#include <string.h>

/* ---- expected steps ---- */

PetscBool SamSimulationSaves(SamSimulation s, PetscInt step, PetscInt last)
{
  const PetscInt first      = s->output_rows && !s->life; /* the start is the first row */
  PetscInt       increments = 1, start = 0;

  if (s->output_rows) increments = SamHistoryGetIncrements(s->history);
  if (s->output_rows && !s->life) start = SamHistoryGetStart(s->history);
  return (PetscBool)(step == last || ((step - start) % increments == 0 &&
                                      ((step - start) / increments + first) % s->output_every == 0));
}

/* Counts the steps first + 1 ... last whose fields are saved. */
static PetscInt CountSaved(SamSimulation s, PetscInt first, PetscInt last)
{
  PetscInt count = 0;

  for (PetscInt k = first + 1; k <= last; k++) count += SamSimulationSaves(s, k, last);
  return count;
}

void SamSimulationExpectSteps(SamSimulation s)
{
  const PetscInt           last = s->needs.steps, done = s->point.steps;
  SamOutputSettings *const set = &s->output_settings;

  if (s->life) {
    const PetscInt start  = SamLifeOptionsGetStart(&s->plan, s->history);
    const double   cycles = (double)SamLifeOptionsCountOutputs(&s->plan);

    set->steps = cycles * (double)(last - start);
    set->saved = cycles * (double)CountSaved(s, 0, last - start);
  } else {
    set->steps = (double)(last - done);
    set->saved = (double)CountSaved(s, done, last);
  }
}

/* ---- opening ---- */

static PetscErrorCode Create(SamSimulation s)
{
  char *all;

  PetscFunctionBegin;
  PetscCall(PetscFree(s->written));
  s->output_settings.errors    = s->errors ? PETSC_TRUE : PETSC_FALSE;
  s->output_settings.gradients = s->gradients.count;
  s->output_settings.gradient  = s->gradients.name;
  PetscCall(SamOutputNamePart(s->filename, s->point.part, &s->written));
  PetscCall(SamOutputCreate(s->setup.grid, s->written, &s->output_settings, &s->output));
  s->point.identity = SamOutputGetIdentity(s->output);
  PetscCall(PetscOptionsGetAll(NULL, &all));
  PetscCall(SamOutputSetText(s->output, "options", all));
  PetscCall(PetscFree(all));
  PetscCall(SamOutputSetParameters(s->output, &s->parameters));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates a file of the steps after the checkpoint; it follows the file with that identity; 0: none. */
static PetscErrorCode Follow(SamSimulation s, uint64_t identity)
{
  SamSimulationPoint *p = &s->point;

  PetscFunctionBegin;
  PetscCall(Create(s));
  PetscCall(SamOutputFollow(s->output, identity, p->steps, p->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the next part of the results of the stopped simulation. */
static PetscErrorCode Continue(SamSimulation s)
{
  SamSimulationPoint *p        = &s->point;
  const uint64_t      identity = p->identity;
  SamControl          last;
  char               *before;
  PetscErrorCode      ierr;

  PetscFunctionBegin;
  if (!s->life) {
    last         = SamHistoryGetStep(s->history, p->steps - 1);
    s->last_time = last.time;
  }
  PetscCall(SamOutputNamePart(s->filename, PetscMax(p->part, 1), &before));
  ierr = SamOutputCheckPart(s->setup.grid, before, identity);
  PetscCall(PetscFree(before));
  PetscCall(ierr);
  p->part++;
  PetscCall(Follow(s, identity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationOpenResults(SamSimulation s)
{
  const PetscBool restarted = s->checkpoints.restart[0] != '\0';
  PetscBool       there     = PETSC_FALSE;

  PetscFunctionBegin;
  if (restarted) PetscCall(SamFilesFind(s->comm, s->filename, &there));
  /* it is an error if the stopped run's own file is missing */
  if (restarted && (there || !strcmp(s->filename, s->point.results))) {
    PetscCall(Continue(s));
  } else {
    s->point.part = 1;
    PetscCall(restarted ? Follow(s, 0) : Create(s));
  }
  PetscCall(PetscStrncpy(s->point.results, s->filename, sizeof(s->point.results)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- size ---- */

/* A larger file (bytes) may be larger than intended. */
#define LARGE 1e8

PetscErrorCode SamSimulationForecast(SamSimulation s, char text[], size_t size)
{
  double bytes, space;
  char   words[2][32];
  char   advice[PETSC_MAX_PATH_LEN + 200];

  PetscFunctionBegin;
  PetscCall(SamOutputForecast(s->output, s->filename, &bytes, &space));
  SamDescribeBytes(bytes, words[0], sizeof(words[0]));
  SamDescribeBytes(space, words[1], sizeof(words[1]));
  (void)snprintf(text, size, "%s %s, %s free there",
                 s->life                           ? "at least"
                 : s->output_settings.compress > 0 ? "at most"
                                                   : "about",
                 words[0], words[1]);
  if (bytes > LARGE && s->output_every == 1 && s->needs.steps > 1)
    (void)snprintf(text + strlen(text), size - strlen(text), "; -output_every m: the fields of every m-th step only");
  if (bytes <= space) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(advice, sizeof(advice),
                 "-output %s: needs %s %s, and %s are free there: a larger -output_every, fewer -output_fields, or "
                 "-output_single make it smaller",
                 s->filename, s->output_settings.compress > 0 ? "up to" : "about", words[0], words[1]);
  PetscCall(SamSimulationWarn(s, advice, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

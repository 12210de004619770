/* A simulation: makes the objects, solves the load steps, writes results and checkpoints. */
#include "run.h"
#include <petsam/private/checkpoint.h>
#include <petsam/private/contact.h>
#include <petsam/private/runfiles.h>
#include <petsam/private/state.h>

/* ---- creation ---- */

PetscErrorCode SamSimulationCreate(MPI_Comm comm, SamSimulation *simulation)
{
  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(simulation));
  (*simulation)->comm = comm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationDestroy(SamSimulation *simulation)
{
  const SamSimulation s = *simulation;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOutputDestroy(&s->output));
  PetscCall(SamErrorsDestroy(&s->errors));
  PetscCall(SamSimulationEndRecord(s));
  PetscCall(SamSimulationForgetGradients(s));
  PetscCall(PetscFree(s->written));
  PetscCall(SamCheckpointDestroy(&s->checkpoints.files));
  PetscCall(SamLifeDestroy(&s->life));
  PetscCall(SamLifeOptionsDestroy(&s->plan));
  PetscCall(SamHistoryDestroy(&s->history));
  PetscCall(SamSetupDestroy(&s->setup));
  PetscCall(PetscFree(*simulation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationSetSignals(SamSimulation s, volatile sig_atomic_t signals[2])
{
  PetscFunctionBegin;
  s->signals = signals;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- advice ---- */

/*
  Passes the loads of the steps that are left on to the advice, and rejects those that no contact of this theory bears.
*/
static PetscErrorCode AdviseLoads(SamSimulation s)
{
  const PetscInt first = s->life ? 0 : PetscMin(s->point.steps, s->needs.steps - 1);

  PetscFunctionBegin;
  s->advice.steps      = s->needs.steps;
  s->advice.increments = SamHistoryGetIncrements(s->history);
  s->advice.step_rtol  = s->step_rtol;
  for (PetscInt k = first; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k)) {
    const SamControl control = SamHistoryGetStep(s->history, k);

    SamAdviceAddLoads(&s->advice, k, &control);
  }
  PetscCall(SamAdviceRefuse(&s->advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationExamine(SamSimulation s, PetscInt k, PetscBool of_laws, const SamStep *step)
{
  const SamExtent *found;

  PetscFunctionBegin;
  PetscCall(SamAdviceStep(&s->advice, k, of_laws, step, &found));
  if (found)
    PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_EXTENT, .step = k, .extent = found}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- set-up ---- */

/* Declares a number of the step for each prescribed value that varies. */
static PetscErrorCode Offer(SamSimulation s)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamConditionsCount(s->setup.conditions); k++) {
    const SamCondition *one = SamConditionsGet(s->setup.conditions, k);

    if (SamHistoryGives(s->history, one) || (s->plan.points && !strcmp(one->name, SAM_FRICTION_SCALE)))
      PetscCall(SamContactOfferCondition(s->setup.contact, one));
  }
  PetscCall(SamSimulationDeclareTangent(s));
  PetscCall(SamErrorsCreate(s));
  PetscCall(SamErrorsPrepare(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prepares all objects that depend on both the contact and the load history. */
static PetscErrorCode Prepare(SamSimulation s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamSimulationCreateLife(s));
  PetscCall(SamSimulationCheckSteps(s));
  PetscCall(Offer(s));
  PetscCall(SamOutputSettingsPrepare(&s->output_settings, s->setup.contact, from));
  PetscCall(SamSimulationCollectParameters(s));
  s->prepared = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationSetUp(SamSimulation s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamSetupCreateContact(&s->setup, from));
  if (SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSimulationDeclarePieces(s));
  PetscCall(s->history ? Prepare(s, from) : SamErrorsCreate(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results ---- */

/* Restores the state, opens the results, and reports the beginning; `writes`: if false, no file is changed. */
static PetscErrorCode Begin(SamSimulation s, PetscBool writes)
{
  SamSimulationStart *const start = &s->start;

  PetscFunctionBegin;
  s->last_time      = PETSC_NINFINITY;
  start->steps      = s->needs.steps;
  start->cyclic     = s->plan.cycles > 0 ? PETSC_TRUE : PETSC_FALSE;
  start->companions = SamErrorsDescribe(s->errors);
  start->gradients  = s->gradients.count > 0 ? PETSC_TRUE : PETSC_FALSE;
  start->share      = SamErrorsShare(s);
  for (PetscInt k = 0; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k)) {
    SamControl control;

    if (!SamHistoryIsLast(s->history, k)) continue;
    control = SamHistoryGetStep(s->history, k);
    for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
      if (!control.force[c] || control.value[c] != 0) start->loads[c] = PETSC_TRUE;
  }
  /* With committed steps the state is that of a later step. */
  if (s->checkpoints.restart[0] && !(SamContactGetSteps(s->setup.contact) > 0)) {
    start->restart = s->checkpoints.restart;
    PetscCall(SamSimulationRestart(s));
    PetscCall(SamSimulationDescribePlace(s, PETSC_FALSE, start->after, sizeof(start->after)));
  }
  PetscCall(SamSimulationBeginGradients(s));
  PetscCall(AdviseLoads(s));
  if (writes) PetscCall(SamSimulationBeginCheckpoints(s));
  if (s->has_output) SamSimulationExpectSteps(s);
  if (writes && s->has_output) PetscCall(SamSimulationOpenResults(s));
  if (!writes && s->has_output) PetscCall(SamOutputPlan(s->setup.grid, &s->output_settings, &s->output));
  if (s->output) {
    start->results  = s->written ? s->written : s->filename;
    start->replaced = SamOutputHasReplaced(s->output);
    PetscCall(SamSimulationForecast(s, start->size, sizeof(start->size)));
  }
  if (!writes) PetscCall(SamSimulationGuessTime(s, start));
  if (s->errors) start->seconds *= 1 + start->share;
  for (int k = 0; k < SAM_SCALINGS && s->errors; k++) {
    start->scaling[k].seconds *= 1 + start->share;
    start->scaling[k].messages *= 1 + start->share;
  }
  SamSimulationDescribeCheckpoints(s, start->when, sizeof(start->when));
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_BEGIN, .start = start}));
  PetscCall(SamAdviceBegin(&s->advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationWriteLastFields(SamSimulation s)
{
  PetscReal saved;

  PetscFunctionBegin;
  if (!s->output) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOutputGetSaved(s->output, NULL, NULL, &saved));
  if (s->last_time <= saved) PetscFunctionReturn(PETSC_SUCCESS);
  s->writing = PETSC_TRUE;
  PetscCall(SamOutputWriteFields(s->output, s->last_time));
  s->writing = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationWriteStep(SamSimulation s, const SamStep *step, PetscBool due)
{
  const PetscBool none = step->status == SAM_STATUS_NO_EQUILIBRIUM;

  PetscFunctionBegin;
  if (!s->output) PetscFunctionReturn(PETSC_SUCCESS);
  if (none) PetscCall(SamSimulationWriteLastFields(s));
  s->writing = PETSC_TRUE;
  PetscCall(SamOutputWriteStep(s->output, due && !none));
  s->writing   = PETSC_FALSE;
  s->last_time = step->control.time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TellFile(SamSimulation s, const char name[], const char content[])
{
  PetscFunctionBegin;
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_FILE, .text = name, .setting = content}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Closes the results, and reports all files. */
static PetscErrorCode Finish(SamSimulation s)
{
  char     content[96];
  PetscInt steps, saved;

  PetscFunctionBegin;
  if (s->output) {
    if (s->warnings) PetscCall(SamOutputWriteWarnings(s->output, s->warnings, s->warning));
    PetscCall(SamOutputGetSaved(s->output, &steps, &saved, NULL));
    PetscCall(PetscSNPrintf(content, sizeof(content), "%" PetscInt_FMT " step%s, fields of %" PetscInt_FMT, steps,
                            steps == 1 ? "" : "s", saved));
    PetscCall(TellFile(s, s->written, content));
  }
  s->writing = PETSC_TRUE;
  PetscCall(SamOutputDestroy(&s->output));
  s->writing = PETSC_FALSE;
  PetscCall(PetscSNPrintf(content, sizeof(content), "checkpoint after step %" PetscInt_FMT, s->checkpoints.last));
  if (s->checkpoints.last) PetscCall(TellFile(s, s->checkpoints.filename, content));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

/*
  Solves one load step; `ended`: it failed, so that no further step can be solved, or the contact is at the edge of the
  grid, so that no further step should be solved.
*/
static PetscErrorCode SolveStep(SamSimulation s, PetscBool *ended)
{
  const PetscInt k = s->point.steps, last = s->needs.steps - 1;
  SamStep        step;
  PetscBool      due, waits;

  PetscFunctionBegin;
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_STEP_BEGINS, .step = k}));
  PetscCall(SamSimulationTry(s, k, &step));
  PetscCall(SamSimulationRecordTangent(s, &step));
  PetscCall(SamErrorsRecord(s, k, &step));
  *ended = step.status == SAM_STATUS_CONVERGED ? PETSC_FALSE : PETSC_TRUE;
  due    = (PetscBool)(SamSimulationSaves(s, k + 1, last + 1) || *ended);
  PetscCall(SamSimulationWriteStep(s, &step, due));
  if (s->output && (k == last || *ended || step.message[0])) PetscCall(SamOutputFlush(s->output));
  waits = s->output && SamOutputWaits(s->output) ? PETSC_TRUE : PETSC_FALSE;
  /* After writing, so that a reported step is in the file. */
  PetscCall(
    SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_STEP, .step = k, .result = &step, .waits = waits}));
  if (k == last) SamAdviceRenew(&s->advice);
  PetscCall(SamSimulationExamine(s, k, PETSC_TRUE, &step));
  if (!*ended) PetscCall(SamSimulationCommitStep(s, &step));
  if (*ended || !s->point.worst) s->point.worst = step.status;
  s->point.steps++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the remaining steps; ends early when a step fails, or with a checkpoint. */
static PetscErrorCode SolveSteps(SamSimulation s)
{
  PetscBool ended = PETSC_FALSE;

  PetscFunctionBegin;
  while (s->point.steps < s->needs.steps && !ended && !s->stopped) {
    PetscCall(SolveStep(s, &ended));
    if (!ended) PetscCall(SamSimulationCheckpoint(s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the gradients, and tells the errors of them and of the last numbers. A run that stops for the time being has
  those of the numbers as far as it has come; a life has not, since its companions live as long as it does.
*/
static PetscErrorCode EndErrors(SamSimulation s)
{
  const PetscBool known = s->point.worst == SAM_STATUS_CONVERGED && !(s->stopped && s->life) ? PETSC_TRUE : PETSC_FALSE;
  SamControl      last;

  PetscFunctionBegin;
  if (known) {
    last = SamHistoryGetStep(s->history, (s->life ? s->needs.steps : s->point.steps) - 1);
    PetscCall(SamErrorsAdd(s, &last));
  }
  PetscCall(SamSimulationEndGradients(s));
  PetscCall(known ? SamErrorsEnd(s) : SamErrorsLose(s, "an earlier history ended before its last step"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunAll(SamSimulation s)
{
  PetscErrorCode code;
  const SamSlip *slip = NULL;

  PetscFunctionBegin;
  if (!s->prepared) PetscCall(Prepare(s, &(SamOptions){s->comm, NULL}));
  code = Begin(s, PETSC_TRUE);
  if (code && s->start.restart) PetscCall(SamContactReset(s->setup.contact)); /* as before, without any step */
  PetscCall(code);
  if (s->life)
    PetscCall(SamSimulationLive(s));
  else
    PetscCall(SolveSteps(s));
  if (s->point.worst == SAM_STATUS_CONVERGED) PetscCall(SamAdviceEnd(&s->advice, &slip));
  if (slip) PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_SLIP, .slip = slip}));
  PetscCall(EndErrors(s));
  if (!s->untold) PetscCall(SamAdviceTell(&s->advice));
  PetscCall(Finish(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRehearse(SamSimulation s)
{
  PetscFunctionBegin;
  PetscCheck(s->history && s->prepared, s->comm, PETSC_ERR_ORDER, "A simulation that has not been set up");
  PetscCall(Begin(s, PETSC_FALSE));
  PetscCall(SamOutputDestroy(&s->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRun(SamSimulation s)
{
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCheck(s->history, s->comm, PETSC_ERR_ORDER, "There is no load history");
  s->running = PETSC_TRUE;
  code       = RunAll(s);
  s->running = PETSC_FALSE;
  if (code == SAM_ERR_USER && s->output) { /* the results of a step may exclude the next one */
    PetscCall(SamContactReject(s->setup.contact));
    if (s->life) PetscCall(SamSimulationPlaceLast(s));
    PetscCall(SamSimulationWriteLastFields(s));
  }
  if (s->life) SamLifeEnd(s->life); /* the contact may still be used */
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- queries ---- */

const SamSetup *SamSimulationGetSetup(SamSimulation s)
{
  return &s->setup;
}

SamSimulationNeeds SamSimulationGetNeeds(SamSimulation s)
{
  return s->needs;
}

PetscErrorCode SamSimulationGetFiles(SamSimulation s, SamSimulationFiles *files)
{
  PetscFunctionBegin;
  files->output     = s->has_output ? s->filename : NULL;
  files->checkpoint = s->checkpoints.filename[0] ? s->checkpoints.filename : NULL;
  files->restart    = s->checkpoints.restart[0] ? s->checkpoints.restart : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCheckFiles(SamSimulation s, const SamArguments *arguments)
{
  SamFiles           files = {.count = 0};
  SamSimulationFiles own;
  char              *one, *other; /* names that are derived: a checkpoint's file.1 and file.tmp */

  PetscFunctionBegin;
  PetscCall(SamSimulationGetFiles(s, &own));
  if (own.output) PetscCall(SamFilesAddOutput(&files, own.output));
  if (own.checkpoint) {
    PetscCall(SamCheckpointNames(own.checkpoint, &one, &other));
    PetscCall(SamFilesAddWritten(&files, "-checkpoint", own.checkpoint, one, other));
  }
  PetscCall(SamFilesCheck(&files, s->comm, arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationGetStatus(SamSimulation s, SamStatus *worst, PetscBool *stopped)
{
  PetscFunctionBegin;
  *worst   = s->point.worst;
  *stopped = s->stopped;
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamState SamSimulationGetSeries(SamSimulation s)
{
  return s->life ? SamLifeGetSeries(s->life) : NULL;
}

PetscErrorCode SamSimulationSetGap(SamSimulation s, Vec gap)
{
  PetscFunctionBegin;
  s->has_gap = PETSC_TRUE;
  PetscCall(SamSetupSetGap(&s->setup, gap));
  PetscCall(SamErrorsSetField(s, SamSetupSetGap, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationSetFriction(SamSimulation s, Vec friction)
{
  PetscFunctionBegin;
  PetscCall(SamSetupSetFriction(&s->setup, friction));
  PetscCall(SamErrorsSetField(s, SamSetupSetFriction, friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationReset(SamSimulation s)
{
  PetscFunctionBegin;
  PetscCall(SamContactReset(s->setup.contact));
  PetscCall(SamErrorsReset(s));
  SamSimulationForgetAdvice(s);
  SamSimulationForgetRecord(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationTakeOver(SamSimulation s, SamSimulation from)
{
  PetscFunctionBegin;
  PetscCall(SamContactTakeOver(s->setup.contact, from->setup.contact));
  PetscCall(SamErrorsCopy(s, from));
  SamSimulationForgetAdvice(s);
  SamSimulationForgetRecord(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamGradient SamSimulationGetGradient(SamSimulation s)
{
  return s->gradient;
}

PetscErrorCode SamSimulationStop(SamSimulation s)
{
  PetscFunctionBegin;
  s->stopped = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamSimulationIsWriting(SamSimulation s)
{
  return s->writing;
}

void SamSimulationAbandon(SamSimulation s)
{
  (void)SamCheckpointDestroy(&s->checkpoints.files);
}

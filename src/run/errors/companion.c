/* A companion: a simulation of the same history on other cells or with other steps, which nobody watches. */
#include "companion.h"
#include <petsam/private/contact.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>

PetscErrorCode SamCompanionCreate(SamSimulation s, PetscInt halvings, SamCompanion *c)
{
  const SamOptions   from = {s->comm, NULL};
  SamContactSettings settings;
  SamSimulation      run;

  PetscFunctionBegin;
  PetscCall(PetscNew(&run));
  *c        = (SamCompanion){.run = run};
  run->comm = s->comm;
  PetscCall(SamSetupCreateCoarse(&s->setup, halvings, &from, &run->setup));
  settings             = SamContactGetSettings(run->setup.contact);
  settings.extrapolate = PETSC_FALSE; /* steady rolling: the companions are the coarser solutions */
  PetscCall(SamContactSetSettings(run->setup.contact, &settings));
  run->needs           = s->needs;
  run->needs.companion = PETSC_FALSE;
  run->running         = PETSC_TRUE;
  PetscCall(SamContactGetState(run->setup.contact, &c->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionPrepare(SamCompanion *c, SamSimulation s, PetscInt increments)
{
  const SamSimulation run = c->run;

  PetscFunctionBegin;
  PetscCall(SamCompanionReject(c));
  PetscCall(SamLifeDestroy(&c->life));
  PetscCall(SamHistoryDestroy(&run->history));
  PetscCall(SamHistoryDivide(s->history, increments, &run->history));
  run->plan            = s->plan; /* its arrays stay those of the simulation */
  run->needs           = s->needs;
  run->needs.steps     = SamHistoryGetCount(run->history);
  run->needs.companion = PETSC_FALSE;
  run->step_rtol       = s->step_rtol;
  run->step_divide     = s->step_divide;
  c->steps             = 0;
  PetscCall(PetscArrayzero(c->sums, SAM_STATE_NUMBERS));
  PetscCall(SamSimulationDeclarePieces(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionDestroy(SamCompanion *c)
{
  PetscFunctionBegin;
  if (!c->run) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLifeDestroy(&c->life));
  PetscCall(SamSimulationEndRecord(c->run));
  PetscCall(SamStateDestroy(&c->kept));
  PetscCall(SamHistoryDestroy(&c->run->history));
  PetscCall(SamSetupDestroy(&c->run->setup));
  PetscCall(PetscFree(c->run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the companion after a step that has not converged. */
static void End(SamCompanion *c, const SamStep *step)
{
  (void)snprintf(c->fault, sizeof(c->fault), "%s", step->message[0] ? step->message : "a step has no solution");
}

/* Solves the next step. */
static PetscErrorCode Solve(SamCompanion *c)
{
  const SamContact contact = c->run->setup.contact;
  SamStep          step;

  PetscFunctionBegin;
  PetscCall(SamSimulationTry(c->run, c->steps, &step));
  if (step.status != SAM_STATUS_CONVERGED) {
    End(c, &step);
    PetscCall(SamContactReject(contact));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetState(contact, &c->state)); /* makes all parts declare their numbers again */
  SamStateJoinNumbers(c->state, c->sums, PETSC_FALSE);
  PetscCall(SamSimulationCommitStep(c->run, &step));
  c->steps++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionFollow(SamCompanion *c, SamSimulation s, PetscInt k, PetscBool *there)
{
  const PetscInt last = SamHistoryFindStep(s->history, c->run->history, k);

  PetscFunctionBegin;
  *there = PETSC_FALSE;
  if (last < 0) PetscFunctionReturn(PETSC_SUCCESS);
  SamContactSetSettles(c->run->setup.contact, s->gradient ? PETSC_TRUE : PETSC_FALSE);
  while (c->steps <= last && !c->fault[0]) {
    char           message[SAM_MESSAGE] = "";
    PetscErrorCode code;

    PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
    code = Solve(c);
    PetscCall(PetscPopErrorHandler());
    if (code) (void)snprintf(c->fault, sizeof(c->fault), "%s", message); /* as loads that its cells cannot follow */
  }
  if (c->fault[0]) c->lost = PETSC_TRUE;
  *there = c->lost ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs so many cycles of the life; gets the last step, or the first one that is not converged. */
static PetscErrorCode LiveAlone(SamSimulation s, PetscReal cycles, SamLife *life, SamStep *step)
{
  const SamContact contact = s->setup.contact;
  const PetscInt   start   = SamLifeOptionsGetStart(&s->plan, s->history);
  SamLifeCycle     cycle   = {.control = SamSimulationCycleControl,
                              .commits = SamSimulationRecordCycleStep,
                              .jumps   = SamSimulationRecordJump,
                              .context = s};
  SamLifeReport    r;

  PetscFunctionBegin;
  cycle.steps = s->needs.steps - start;
  PetscCall(SamSimulationBeginCycles(s));
  PetscCall(SamLifeCreate(contact, &cycle, &s->plan.life, life));
  for (PetscInt k = 0; k < start; k++) {
    const SamControl control = SamHistoryGetStep(s->history, k);

    PetscCall(SamContactTry(contact, &control, step));
    if (step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(SamSimulationCommitStep(s, step));
  }
  PetscCall(SamLifeCompute(*life, &r));
  while (r.step.status == SAM_STATUS_CONVERGED && r.cycles < cycles) {
    PetscCall(SamLifeJump(*life, PetscMin(cycles, SamLifeOptionsNextStop(&s->plan, r.cycles)), &r));
    if (r.step.status == SAM_STATUS_CONVERGED) PetscCall(SamLifeCompute(*life, &r));
  }
  PetscCall(SamLifeRecord(*life, &r));
  *step = r.step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionLive(SamCompanion *c, PetscReal cycles)
{
  char           message[SAM_MESSAGE] = "";
  SamStep        step;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
  code = LiveAlone(c->run, cycles, &c->life, &step);
  PetscCall(PetscPopErrorHandler());
  if (code)
    (void)snprintf(c->fault, sizeof(c->fault), "%s", message);
  else if (step.status != SAM_STATUS_CONVERGED)
    End(c, &step);
  if (c->fault[0]) c->lost = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps given one by one ---- */

PetscErrorCode SamCompanionLose(SamCompanion *c, const char why[])
{
  PetscFunctionBegin;
  PetscCall(SamCompanionReject(c));
  (void)snprintf(c->fault, sizeof(c->fault), "%s", why);
  c->lost = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionReject(SamCompanion *c)
{
  PetscFunctionBegin;
  PetscCall(SamContactReject(c->run->setup.contact));
  if (c->moved) PetscCall(SamContactSetState(c->run->setup.contact, c->kept, c->current));
  c->moved = PETSC_FALSE;
  if (!c->lost) c->fault[0] = '\0';
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the committed state before a step that is divided. */
static PetscErrorCode Keep(SamCompanion *c)
{
  PetscFunctionBegin;
  PetscCall(SamStateDestroy(&c->kept)); /* numbers may have been declared since */
  PetscCall(SamStateCreateLike(c->state, &c->kept));
  PetscCall(SamStateCopy(c->state, c->kept));
  PetscCall(SamContactIsGapCurrent(c->run->setup.contact, &c->current));
  c->moved = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces the history by one row that leads from the committed step to this one. */
static PetscErrorCode Lead(SamCompanion *c, PetscInt parts, const SamControl *control)
{
  const SamSimulation run                                          = c->run;
  char                names[(SAM_COMPONENTS + 1) * SAM_ERROR_NAME] = "time";
  double              values[SAM_COMPONENTS + 1]                   = {(double)control->time};
  SamControl          before;
  const SamSolution  *committed;
  SamHistory          whole;
  PetscInt            count = 1;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    const char *name = SamComponentNameOf(k, SamControlWay(control, k));

    (void)snprintf(names + strlen(names), sizeof(names) - strlen(names), ",%s", name);
    values[count++] = (double)control->value[k];
  }
  PetscCall(SamContactGetSolution(run->setup.contact, &committed));
  before      = committed->control;
  before.time = control->time - 1;
  PetscCall(SamHistoryDestroy(&run->history));
  PetscCall(SamHistoryCreate(run->comm, run->setup.conditions, control,
                             SamContactHasStep(run->setup.contact, SAM_COMMITTED) ? &before : NULL, names, 1, values, 1,
                             &whole));
  PetscCall(SamHistoryDivide(whole, parts, &run->history));
  PetscCall(SamHistoryDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tries the step in so many parts, all but the last of which are committed. */
static PetscErrorCode TryParts(SamCompanion *c, PetscInt parts, const SamControl *control)
{
  PetscInt count;

  PetscFunctionBegin;
  PetscCall(Lead(c, parts, control));
  count = SamHistoryGetCount(c->run->history);
  if (count > 1) PetscCall(Keep(c));
  for (PetscInt k = 0; k < count && !c->fault[0]; k++) {
    const SamControl now = SamHistoryGetStep(c->run->history, k);
    SamStep          step;

    PetscCall(SamSimulationTryStep(c->run, &now, &step));
    if (step.status != SAM_STATUS_CONVERGED) End(c, &step);
    PetscCall(SamContactGetState(c->run->setup.contact, &c->state));
    SamStateJoinNumbers(c->state, c->sums, PETSC_FALSE);
    if (k < count - 1 && !c->fault[0]) PetscCall(SamSimulationCommitStep(c->run, &step));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionTry(SamCompanion *c, PetscInt parts, const SamControl *control)
{
  char           message[SAM_MESSAGE] = "";
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(SamCompanionReject(c));
  PetscCall(PetscArrayzero(c->sums, SAM_STATE_NUMBERS));
  if (c->lost) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
  code = TryParts(c, parts, control);
  PetscCall(PetscPopErrorHandler());
  if (code) (void)snprintf(c->fault, sizeof(c->fault), "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionCommit(SamCompanion *c)
{
  PetscFunctionBegin;
  c->moved = PETSC_FALSE;
  if (c->fault[0])
    c->lost = PETSC_TRUE;
  else
    PetscCall(SamContactCommit(c->run->setup.contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

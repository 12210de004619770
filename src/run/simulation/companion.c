/* A companion: a simulation of the same history on other cells or with other steps, which nobody watches. */
#include "companion.h"
#include <petsam/private/contact.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>

PetscErrorCode SamCompanionCreate(SamSimulation s, PetscInt halvings, PetscInt increments, SamCompanion *c)
{
  const SamOptions from = {s->comm, NULL};
  SamSimulation    run;

  PetscFunctionBegin;
  PetscCall(PetscNew(&run));
  *c        = (SamCompanion){.run = run};
  run->comm = s->comm;
  PetscCall(SamSetupCreateCoarse(&s->setup, halvings, &from, &run->setup));
  run->conditions = SamProblemGetConditions(run->setup.problem);
  PetscCall(SamHistoryDivide(s->history, increments, &run->history));
  run->plan            = s->plan; /* its arrays stay those of the simulation */
  run->needs           = s->needs;
  run->needs.steps     = SamHistoryGetCount(run->history);
  run->needs.companion = PETSC_FALSE;
  run->step_rtol       = s->step_rtol;
  run->running         = PETSC_TRUE;
  PetscCall(SamSimulationDeclarePieces(run));
  PetscCall(SamContactGetState(run->setup.contact, &c->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionDestroy(SamCompanion *c)
{
  PetscFunctionBegin;
  if (!c->run) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLifeDestroy(&c->life));
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
  PetscCall(SamSimulationCommitStep(c->run, &step, NULL, 0));
  c->steps++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompanionFollow(SamCompanion *c, SamSimulation s, PetscInt k, PetscBool *there)
{
  const PetscInt last = SamHistoryFindStep(s->history, c->run->history, k);

  PetscFunctionBegin;
  *there = PETSC_FALSE;
  if (last < 0) PetscFunctionReturn(PETSC_SUCCESS);
  while (c->steps <= last && !c->fault[0]) {
    char           message[SAM_MESSAGE] = "";
    PetscErrorCode code;

    PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
    code = Solve(c);
    PetscCall(PetscPopErrorHandler());
    if (code) (void)snprintf(c->fault, sizeof(c->fault), "%s", message); /* as loads that its cells cannot follow */
  }
  *there = c->fault[0] ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs so many cycles of the life; gets the last step, or the first one that is not converged. */
static PetscErrorCode LiveAlone(SamSimulation s, PetscReal cycles, SamLife *life, SamStep *step)
{
  const SamContact contact = s->setup.contact;
  const PetscInt   start   = SamLifeOptionsGetStart(&s->plan, s->history);
  SamLifeCycle     cycle   = {.control = SamSimulationCycleControl, .context = s};
  SamLifeReport    r;

  PetscFunctionBegin;
  cycle.steps = s->needs.steps - start;
  PetscCall(SamLifeCreate(contact, &cycle, &s->plan.life, life));
  for (PetscInt k = 0; k < start; k++) {
    const SamControl control = SamHistoryGetStep(s->history, k);

    PetscCall(SamContactTry(contact, &control, step));
    if (step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(SamContactCommit(contact));
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

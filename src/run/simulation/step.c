/* A step of a history, or a step given by another program: it is tried, then committed or rejected. */
#include "simulationimpl.h"
#include <petsam/private/state.h>
#include <petsam/private/contact.h>

/* Gets step `step` of the cycle; the steps before it, up to the history's first row, lead to its start. */
PetscErrorCode SamSimulationCycleControl(void *context, PetscInt step, PetscReal cycles, SamControl *control)
{
  SamSimulation       s     = (SamSimulation)context;
  const SamCondition *scale = SamConditionsFind(s->conditions, SAM_FRICTION_SCALE);

  PetscFunctionBegin;
  *control = SamHistoryGetStep(s->history, SamLifeOptionsGetStart(&s->plan, s->history) + step);
  SamControlSetCondition(control, scale, SamControlGet(control, scale) * SamLifeOptionsFriction(&s->plan, cycles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationAdviseEdge(SamSimulation s, const SamControl *control, SamStep *step)
{
  const size_t used  = strlen(step->message);
  SamAdvice    alone = {.setup = &s->setup, .most.open = s->has_gap};

  PetscFunctionBegin;
  if (!s->running) SamAdviceAddLoads(&alone, 0, control);
  PetscCall(SamAdviceEdge(s->running ? &s->advice : &alone, step));
  if (s->running && step->message[used] && step->status)
    (void)strncat(step->message, "; to continue anyway: -allow_edge_contact",
                  sizeof(step->message) - strlen(step->message) - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationTryStep(SamSimulation s, const SamControl *control, SamStep *step)
{
  PetscErrorCode code;
  SamAdvice      alone = {.setup = &s->setup, .most.open = s->has_gap};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamConditionsCount(s->conditions); k++) {
    const SamCondition *one = SamConditionsGet(s->conditions, k);

    if (SamControlGet(control, one) != one->usual) PetscCall(SamContactOfferCondition(s->setup.contact, one));
  }
  if (!s->running) SamAdviceAddLoads(&alone, 0, control);
  PetscCall(SamAdviceRefuse(&alone));
  s->advised = PETSC_FALSE;
  code       = SamContactTry(s->setup.contact, control, step);
  if (code) PetscCall(SamContactReject(s->setup.contact));
  PetscCall(code);
  PetscCall(SamSimulationAdviseEdge(s, control, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- advice ---- */

/* Adds the tried step to the earlier ones; `examine`: examines its contact, too, if its normal load is the largest. */
static PetscErrorCode Follow(SamSimulation s, const SamStep *step, PetscBool examine, SamAdvice *now)
{
  const PetscInt   k = s->earlier + now->most.steps;
  const SamExtent *found;
  PetscBool        examined;

  PetscFunctionBegin;
  now->setup = &s->setup;
  now->steps = k + 1;
  if (s->has_gap) now->most.open = PETSC_TRUE;
  SamAdviceAddLoads(now, k, &step->control);
  examined      = now->examined && now->largest != k ? PETSC_TRUE : PETSC_FALSE;
  now->examined = examined || !examine ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SamAdviceStep(now, k, PETSC_FALSE, step, &found));
  now->examined = examined || examine ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationAdviseStep(SamSimulation s, const SamStep *step, SamAdviceFunction receive, void *context)
{
  SamAdvice now = s->single;

  PetscFunctionBegin;
  now.setup   = &s->setup;
  now.receive = receive;
  now.context = context;
  if (!now.most.steps) PetscCall(SamAdviceBegin(&now));
  PetscCall(Follow(s, step, PETSC_TRUE, &now));
  s->tried   = now;
  s->advised = PETSC_TRUE;
  PetscCall(SamAdviceEnd(&now, NULL));
  PetscCall(SamAdviceTell(&now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamSimulationForgetAdvice(SamSimulation s)
{
  s->single  = (SamAdvice){.setup = &s->setup};
  s->earlier = SamContactHasStep(s->setup.contact, SAM_COMMITTED) ? 1 : 0;
  s->advised = PETSC_FALSE;
}

/* Adds the tried step to the steps for which advice is given. */
static PetscErrorCode CommitAdvice(SamSimulation s, const SamStep *step)
{
  PetscFunctionBegin;
  if (s->running) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->advised)
    s->single = s->tried;
  else
    PetscCall(Follow(s, step, PETSC_FALSE, &s->single));
  s->advised = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCommitStep(SamSimulation s, const SamStep *step, char warning[], size_t size)
{
  PetscInt        law   = 0;
  const PetscBool tried = SamContactHasStep(s->setup.contact, SAM_TRIED);

  PetscFunctionBegin;
  PetscCheck(step->status != SAM_STATUS_NO_EQUILIBRIUM, s->comm, PETSC_ERR_ORDER,
             "the last try has no solution, and cannot be committed: %s", step->message);
  PetscCheck(tried, s->comm, PETSC_ERR_ORDER, "there is no tried step to commit");
  PetscCheck(SamStepIsSolved(step), s->comm, PETSC_ERR_NOT_CONVERGED,
             "the tried step did not converge, and cannot be committed: %s", step->message);
  if (warning) PetscCall(SamContactAdvise(s->setup.contact, &law, warning, size));
  PetscCall(CommitAdvice(s, step));
  PetscCall(SamContactCommit(s->setup.contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step: it is tried, then committed or rejected. */
#include "simulationimpl.h"
#include <petsam/private/state.h>
#include <petsam/private/contact.h>

/* Gets step `step` of the cycle; the steps before it, up to the history's first row, lead to its start. */
PetscErrorCode SamSimulationCycleControl(void *context, PetscInt step, PetscReal cycles, SamControl *control)
{
  SamSimulation       s     = (SamSimulation)context;
  const SamCondition *scale = SamConditionsFind(s->setup.conditions, SAM_FRICTION_SCALE);

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
  for (PetscInt k = 0; k < SamConditionsCount(s->setup.conditions); k++) {
    const SamCondition *one = SamConditionsGet(s->setup.conditions, k);

    if (SamControlGet(control, one) != one->usual) PetscCall(SamContactOfferCondition(s->setup.contact, one));
  }
  if (!s->running) SamAdviceAddLoads(&alone, 0, control);
  PetscCall(SamAdviceRefuse(&alone));
  code = SamContactTry(s->setup.contact, control, step);
  if (code) PetscCall(SamContactReject(s->setup.contact));
  PetscCall(code);
  PetscCall(SamSimulationAdviseEdge(s, control, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationNeedTried(SamSimulation s, const SamStep *step)
{
  const PetscBool tried = SamContactHasStep(s->setup.contact, SAM_TRIED);

  PetscFunctionBegin;
  PetscCheck(step->status != SAM_STATUS_NO_EQUILIBRIUM, s->comm, PETSC_ERR_ORDER,
             "the last try has no solution, and cannot be committed: %s", step->message);
  PetscCheck(tried, s->comm, PETSC_ERR_ORDER, "there is no tried step to commit");
  PetscCheck(SamStepIsSolved(step), s->comm, PETSC_ERR_NOT_CONVERGED,
             "the tried step did not converge, and cannot be committed: %s", step->message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCommitStep(SamSimulation s, const SamStep *step)
{
  PetscFunctionBegin;
  PetscCall(SamSimulationNeedTried(s, step));
  PetscCall(SamSimulationRecordStep(s));
  PetscCall(SamContactCommit(s->setup.contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

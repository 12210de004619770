/* Steps that another program gives one by one: they are tried, with advice and errors, then committed or rejected. */
#include "run.h"
#include <petsam/private/contact.h>

PetscErrorCode SamSimulationTrySingle(SamSimulation s, const SamControl *control, SamStep *step)
{
  PetscFunctionBegin;
  s->advised = PETSC_FALSE;
  PetscCall(SamSimulationTryStep(s, control, step));
  PetscCall(SamErrorsTry(s, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

PetscErrorCode SamSimulationAdviseSingle(SamSimulation s, const SamStep *step, SamAdviceFunction receive, void *context)
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
  PetscCall(SamErrorsAdvise(s, step, &now));
  if (!s->untold) PetscCall(SamAdviceTell(&now));
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
  if (s->advised)
    s->single = s->tried;
  else
    PetscCall(Follow(s, step, PETSC_FALSE, &s->single));
  s->advised = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCommitSingle(SamSimulation s, const SamStep *step, char warning[], size_t size)
{
  PetscInt law = 0;

  PetscFunctionBegin;
  PetscCall(SamSimulationNeedTried(s, step));
  PetscCall(SamContactAdvise(s->setup.contact, &law, warning, size));
  PetscCall(CommitAdvice(s, step));
  PetscCall(SamErrorsCommit(s));
  PetscCall(SamSimulationCommitStep(s, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationLoad(SamSimulation s, const char filename[], const SamParameters *parameters)
{
  PetscFunctionBegin;
  PetscCall(SamErrorsLoad(s, filename, parameters));
  SamSimulationForgetAdvice(s);
  SamSimulationForgetRecord(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

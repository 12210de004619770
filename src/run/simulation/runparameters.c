/* The parameters that define a run, with the names of its options. */
#include "run.h"
#include <petsam/private/parameters.h>

/*
  Adds the values that the last step prescribes. The steps of a history are in /history of the results, and checkpoints
  compare them by checksums (stopresume.c).
*/
static PetscErrorCode AddLoads(SamParameters *p, SamHistory history, SamConditions conditions)
{
  PetscReal        steps;
  const SamControl control = SamHistoryGetStep(history, SamHistoryGetCount(history) - 1);

  PetscFunctionBegin;
  steps = (PetscReal)SamHistoryGetIncrements(history);
  PetscCall(SamParametersAddReals(p, "steps", PETSC_TRUE, 1, &steps));
  for (PetscInt k = 0; k < SamControlCount(conditions); k++) {
    const SamCondition *condition = k < SAM_COMPONENTS ? NULL : SamConditionsGet(conditions, k - SAM_COMPONENTS);
    const PetscReal     value     = SamControlPart(&control, conditions, k);

    if (condition && (!condition->option || !SamHistoryGives(history, condition))) continue;
    PetscCall(SamParametersAddReals(p, SamControlPartName(&control, conditions, k), PETSC_FALSE, 1, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the parameters of a life, which may continue with more cycles, and in other jumps. */
static PetscErrorCode AddLife(SamParameters *p, const SamLifeOptions *w)
{
  uint64_t sum = 0;

  PetscFunctionBegin;
  if (w->cycles > 0) {
    PetscCall(SamParametersAddReals(p, "wear_cycles", PETSC_FALSE, 1, &w->cycles));
    PetscCall(SamParametersAddReals(p, w->life.fixed ? "wear_jump" : "wear_rtol", PETSC_FALSE, 1,
                                    w->life.fixed ? &w->life.jump : &w->life.rtol));
  }
  if (!w->points) {
    PetscCall(SamParametersAddText(p, "wear_friction", PETSC_TRUE, "none"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < w->points; k++)
    sum = SamHashMix(sum + SamHashBits(w->at[k]) + 3 * SamHashBits(w->friction[k]));
  PetscCall(SamParametersAddChecksum(p, "wear_friction", sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCollectParameters(SamSimulation s)
{
  PetscFunctionBegin;
  s->parameters.count = 0;
  PetscCall(SamSetupAddParameters(&s->setup, &s->parameters));
  PetscCall(AddLoads(&s->parameters, s->history, s->setup.conditions));
  PetscCall(AddLife(&s->parameters, &s->plan));
  if (!s->step_divide) PetscCall(SamParametersAddText(&s->parameters, "step_divide", PETSC_FALSE, "no"));
  if (s->step_rtol > 0) PetscCall(SamParametersAddReals(&s->parameters, "step_rtol", PETSC_FALSE, 1, &s->step_rtol));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The record of tangents, and of steps and jumps for gradients: of a simulation, and of its companions. */
#include "simulationimpl.h"
#include <petsam/private/stiffness.h>

PetscErrorCode SamSimulationDeclareTangent(SamSimulation s)
{
  PetscFunctionBegin;
  if (s->needs.stiffness) PetscCall(SamStiffnessDeclare(s->setup.contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRecordTangent(SamSimulation s, SamStep *step)
{
  PetscFunctionBegin;
  if (s->needs.stiffness) PetscCall(SamStiffnessRecord(s->setup.contact, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamSimulationCountSteps(SamSimulation s)
{
  return s->plan.cycles > 0 ? s->needs.steps - SamLifeOptionsGetStart(&s->plan, s->history) : s->needs.steps;
}

PetscErrorCode SamSimulationCreateGradient(SamSimulation s, SamGap shape, PetscReal memory)
{
  PetscFunctionBegin;
  PetscCall(SamSimulationEndRecord(s));
  PetscCall(SamGradientCreate(s->setup.contact, shape, &s->gradient));
  SamGradientSetMemory(s->gradient, memory);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationEndRecord(SamSimulation s)
{
  PetscFunctionBegin;
  PetscCall(SamGradientDestroy(&s->gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamSimulationForgetRecord(SamSimulation s)
{
  if (s->gradient) SamGradientForget(s->gradient);
}

PetscErrorCode SamSimulationRecordStep(SamSimulation s)
{
  PetscFunctionBegin;
  if (s->gradient) PetscCall(SamGradientRecord(s->gradient, -1, SAM_LIFE_CLOSING));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationBeginCycles(SamSimulation s)
{
  PetscFunctionBegin;
  if (s->gradient && s->plan.cycles > 0)
    PetscCall(SamGradientBeginLife(s->gradient, s->needs.steps, SamSimulationCountSteps(s), &s->plan.life));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRecordCycleStep(void *context, PetscInt step, SamLifePlace place)
{
  const SamSimulation s = (SamSimulation)context;

  PetscFunctionBegin;
  if (s->gradient)
    PetscCall(SamGradientRecord(s->gradient, SamLifeOptionsGetStart(&s->plan, s->history) + step, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRecordJump(void *context, const SamLifePart *part)
{
  const SamSimulation s = (SamSimulation)context;

  PetscFunctionBegin;
  if (s->gradient) PetscCall(SamGradientRecordJump(s->gradient, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

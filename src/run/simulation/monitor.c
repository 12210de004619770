/* The monitor of a simulation, which receives all events. */
#include "simulationimpl.h"

PetscErrorCode SamSimulationSetMonitor(SamSimulation s, SamSimulationMonitor monitor, void *context)
{
  PetscFunctionBegin;
  s->monitor = monitor;
  s->context = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps that wait are written before anything but the next step is told, so that all that has been told is in the
   file. */
PetscErrorCode SamSimulationNotify(SamSimulation s, const SamSimulationEvent *news)
{
  const PetscBool speaks =
    news->kind == SAM_NOTIFY_MESSAGE || news->kind == SAM_NOTIFY_ADVICE || news->kind == SAM_NOTIFY_STOPPED;

  PetscFunctionBegin;
  if (speaks && s->output && SamOutputWaits(s->output)) PetscCall(SamOutputFlush(s->output));
  if (s->monitor) PetscCall(s->monitor(s->context, s->setup.contact, news));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationWarn(void *simulation, const char text[], const char setting[])
{
  PetscFunctionBegin;
  PetscCall(SamSimulationNotify((SamSimulation)simulation,
                                &(SamSimulationEvent){.kind = SAM_NOTIFY_ADVICE, .text = text, .setting = setting}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

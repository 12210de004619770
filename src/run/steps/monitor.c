/* The monitor of a simulation, which receives all events. */
#include "simulationimpl.h"
#include <string.h>

PetscErrorCode SamSimulationSetMonitor(SamSimulation s, SamSimulationMonitor monitor, void *context)
{
  PetscFunctionBegin;
  s->monitor = monitor;
  s->context = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps a warning for the results as it is printed, each once. */
static void Keep(SamSimulation s, const SamSimulationEvent *news)
{
  char text[SAM_WARNING_TEXT], line[SAM_WARNING_TEXT] = "";

  SamNameSetting(news->text, news->setting, text, sizeof(text));
  SamOneLine(text, line, sizeof(line));
  for (PetscInt k = 0; k < s->warnings; k++)
    if (!strcmp(s->warning[k], line)) return;
  if (s->warnings < SAM_WARNINGS) memcpy(s->warning[s->warnings++], line, sizeof(line));
}

/* Steps that wait are written before anything but the next step is told, so that all that has been told is in the
   file. */
PetscErrorCode SamSimulationNotify(SamSimulation s, const SamSimulationEvent *news)
{
  const PetscBool speaks =
    news->kind == SAM_NOTIFY_MESSAGE || news->kind == SAM_NOTIFY_ADVICE || news->kind == SAM_NOTIFY_STOPPED;

  PetscFunctionBegin;
  if (speaks && s->output && SamOutputWaits(s->output)) PetscCall(SamOutputFlush(s->output));
  if (news->kind == SAM_NOTIFY_ADVICE) Keep(s, news);
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

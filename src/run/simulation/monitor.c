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

/* Keeps a warning for the results, each once. */
static void Keep(SamSimulation s, const SamSimulationEvent *news)
{
  char            option[64] = "", text[SAM_WARNING_TEXT] = "";
  const PetscBool named = news->setting && news->setting[0] ? PETSC_TRUE : PETSC_FALSE;

  if (named) (void)snprintf(option, sizeof(option), " (-%s)", news->setting);
  (void)snprintf(text, sizeof(text), "%s%s", news->text, named && !strstr(news->text, news->setting) ? option : "");
  for (PetscInt k = 0; k < s->warnings; k++)
    if (!strcmp(s->warning[k], text)) return;
  if (s->warnings < SAM_WARNINGS) memcpy(s->warning[s->warnings++], text, sizeof(text));
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

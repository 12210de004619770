/* What a user should know of a run besides its results: warnings, each of them once. */
#include "runimpl.h"

/* A coefficient of friction from the first of these on is likely to be percent; from the second on it means stick. */
static const PetscReal percent[2] = {5, 100};

PetscErrorCode SamRunPrepareAdvice(SamRun *run, PetscInt first)
{
  PetscReal friction;
  Vec       field;
  char      text[160];

  PetscFunctionBegin;
  for (PetscInt k = first; k < run->needs.steps; k++) {
    SamControl      control;
    const PetscReal before = run->most.normal;

    PetscCall(SamHistoryGetStep(run->history, k, &control));
    SamLoadsMostAdd(&run->most, &control);
    if (k == first || run->most.normal > before) run->largest = k;
  }
  if (run->wear) run->most.open = PETSC_TRUE;
  PetscCall(SamProblemGetFriction(run->setup.problem, &friction, &field));
  if (!field && friction >= percent[0] && friction <= percent[1]) {
    (void)snprintf(text, sizeof(text), "the coefficient of friction is %g: a ratio is meant, %g for %g percent",
                   (double)friction, (double)friction / 100, (double)friction);
    SamReportWarn(run->report, text, "friction");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunAdviseEdge(const SamRun *run, SamStep *step)
{
  const size_t used = strlen(step->message);
  char         text[400];

  PetscFunctionBegin;
  if (!SamStepIsSolved(step) || !(step->check.edge > 0) || !run->most.steps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAdviseEdge(&run->setup, step, &run->most, text, sizeof(text)));
  (void)snprintf(step->message + used, sizeof(step->message) - used, "; %s%s", text,
                 step->status ? "; -allow_edge_contact goes on all the same" : "");
  step->setting[0] = '\0'; /* the text names the options */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunExamineWear(SamRun *run, PetscInt k)
{
  PetscReal excess;
  char      advice[400], text[440];

  PetscFunctionBegin;
  if (run->wear_told) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWearGetExcess(run->wear, &excess));
  PetscCall(SamAdviseWear(excess, advice, sizeof(advice)));
  if (!advice[0]) PetscFunctionReturn(PETSC_SUCCESS);
  run->wear_told = PETSC_TRUE;
  (void)snprintf(text, sizeof(text), "step %" PetscInt_FMT ": %s", k + 1, advice);
  SamReportWarn(run->report, text, "steps");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunExamine(SamRun *run, PetscInt k, const SamStep *step)
{
  const PetscBool force = step->control.force[SAM_COMPONENT_N];
  SamExtent       extent;
  char            text[512];

  PetscFunctionBegin;
  if (run->examined || k < run->largest || !SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  run->examined = PETSC_TRUE;
  PetscCall(SamSetupMeasure(&run->setup, &extent));
  SamReportSetExtent(run->report, k + 1, &extent);
  PetscCall(SamAdviseMotion(&extent, &run->most, text, sizeof(text)));
  if (text[0]) SamReportWarn(run->report, text, "");
  if (step->check.edge > 0) PetscFunctionReturn(PETSC_SUCCESS); /* and the grid decides the size of the contact */
  PetscCall(SamAdviseCells(&run->setup, step, &extent, text, sizeof(text)));
  if (text[0]) SamReportWarn(run->report, text, "");
  PetscCall(SamAdviseCurvature(&run->setup, step, &extent, text, sizeof(text)));
  if (text[0]) SamReportWarn(run->report, text, "");
  if (extent.zones) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, sizeof(text),
                 "the bodies do not touch in any step: the %s is %g %s at most, and has to be larger than %s",
                 force ? "normal force" : "approach", (double)step->control.value[SAM_COMPONENT_N], force ? "N" : "m",
                 force ? "0" : "0, or than the smallest separation");
  SamReportWarn(run->report, text, force ? "load_n" : "disp_z");
  PetscFunctionReturn(PETSC_SUCCESS);
}

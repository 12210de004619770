/*
  The errors of derivatives, by companion runs: each records its steps and passes back over them, as the simulation
  does (src/post/gradient), and the shares of its gradient are compared (estimates.c). A share is the derivative times
  the parameter, which is one number on any grid and with any steps.
*/
#include "errorsimpl.h"
#include <petsam/private/contact.h>
#include <math.h>

#define LITTLE 0.02 /* share of the number below which a derivative is next to nothing; errors are relative to that */

PetscErrorCode SamErrorsRecordGradient(SamSimulation s, PetscBool on)
{
  PetscFunctionBegin;
  for (int c = 0; s->errors && c < SAM_RUNS; c++) {
    const SamSimulation run = s->errors->companion[c].run;

    if (!run) continue;
    PetscCall(SamSimulationEndRecord(run));
    if (on) PetscCall(SamSimulationCreateGradient(run, s->setup.gap, s->gradients.memory));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the step of a companion at whose end all values are those at the end of a step of the simulation, -2: there
   is none. Both count from 0, in a wear simulation from the start of the cycle; -1: before the first one. */
static PetscInt FindStep(SamSimulation s, SamSimulation run, PetscInt step)
{
  const PetscInt own = s->needs.steps - SamSimulationCountSteps(s),
                 its = run->needs.steps - SamSimulationCountSteps(run);
  PetscInt found;

  if (step < 0) return -1;
  found = SamHistoryFindStep(s->history, run->history, own + step);
  return found < 0 ? -2 : found - its;
}

/*
  Finds the steps of a companion that are those of the gradient; -1: the usual ones. Returns false if there are none: a
  number that is summed over steps, and that is not an integral over them, needs the same steps.
*/
static PetscBool FindSteps(SamSimulation s, SamSimulation run, const SamObjective *objective, PetscInt steps[2])
{
  const PetscInt first = s->gradients.steps[0] - 1, last = s->gradients.steps[1] - 1, end = FindStep(s, run, last);
  const PetscInt before = first == last && !objective->all ? end - 1 : FindStep(s, run, first - 1);

  steps[0] = first < 0 ? -1 : before + 1;
  steps[1] = end;
  if (!objective->all && first >= 0 && first != last && run->needs.steps != s->needs.steps) return PETSC_FALSE;
  return (first >= 0 && before < -1) || end < -1 ? PETSC_FALSE : PETSC_TRUE;
}

/* Computes the shares of a companion. */
static PetscErrorCode Compute(SamSimulation s, SamSimulation run, const SamGradientGoal *goal, PetscInt *count,
                              SamGradientShare shares[])
{
  PetscInt steps[2];

  PetscFunctionBegin;
  *count = 0;
  if (!FindSteps(s, run, goal->objective, steps)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGradientCompute(run->gradient, goal, steps, s->gradients.of, s->gradients.rtol));
  PetscCall(SamGradientGetShares(run->gradient, shares, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the shares of a companion, NaN where it has none. */
static PetscErrorCode GetShares(SamSimulation s, SamCompanion *c, const SamGradientGoal *goal, PetscInt count,
                                double share[])
{
  char             message[SAM_MESSAGE] = "";
  SamGradientShare its[SAM_GRADIENT_SHARES];
  PetscInt         found = 0;
  PetscErrorCode   code;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++) share[k] = NAN;
  if (!c->run || !c->run->gradient || c->fault[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
  code = Compute(s, c->run, goal, &found, its);
  PetscCall(PetscPopErrorHandler());
  for (PetscInt k = 0; k < found && !code; k++) share[k] = its[k].share;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsAddGradient(SamSimulation s, const SamGradientGoal *goal, PetscInt count,
                                    SamGradientShare shares[])
{
  const SamErrors e     = s->errors;
  const double    began = MPI_Wtime();
  const char     *of    = goal->objective->number ? goal->objective->number : goal->name;
  double          share[SAM_RUNS][SAM_GRADIENT_SHARES];
  PetscReal       value;
  double          least;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGradientGetNumber(s->gradient, "value", 0, &value));
  least = LITTLE * PetscMax(fabs((double)value),
                            SamErrorsLeast(s, &(SamStateNumber){.name = goal->name, .unit = goal->objective->unit}));
  for (int c = 0; c < SAM_RUNS; c++) PetscCall(GetShares(s, &e->companion[c], goal, count, share[c]));
  for (PetscInt k = 0; k < count; k++) {
    const double   run[SAM_RUNS] = {share[SAM_RUN_HALF][k], share[SAM_RUN_QUARTER][k], share[SAM_RUN_OTHER][k]};
    char           name[SAM_ERROR_NAME];
    SamStateNumber number = {.name = name, .unit = SamGradientUnit(s->gradient), .order = 1};

    (void)snprintf(name, sizeof(name), "%s_by_%s", goal->name, shares[k].name);
    SamErrorsAddDerivative(s, &number, of, shares[k].share, least, run, &shares[k].error);
  }
  e->table.seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

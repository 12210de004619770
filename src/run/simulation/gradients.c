/* The gradients of a run, by -gradient: steps are recorded as they are committed, and what is found is written. */
#include "run.h"
#include <petsam/private/base.h>
#include <petsam/private/contact.h>
#include <petsam/private/history.h>
#include <string.h>

#define MEMBER(name) offsetof(SamGradientPlan, name)
enum { MEMORY = 3 }; /* row of the option that a contact in another program has, too */
static const SamOptionRow rows[] = {
  {"gradient", "energy, disp_x, ...: numbers whose derivatives are written", SAM_OPTION_STRING, MEMBER(names),
   .size = SAM_GRADIENT_NAMES, .needs = SAM_OUTPUT_NEEDED, .excludes = "step_rtol,restart"},
  {"gradient_steps", "first and last step that they are of; 0: usual ones", SAM_OPTION_INT, MEMBER(steps), .size = 2,
   .needs = "gradient"},
  {"gradient_of", "gap, load_tx, body1_young, ...: by these; else all but moduli, shape", SAM_OPTION_STRING, MEMBER(of),
   .size = SAM_GRADIENT_NAMES, .needs = "gradient"},
  {"gradient_memory", "bytes for recorded steps; more wait in a file in $TMPDIR; 0: any", SAM_OPTION_REAL,
   MEMBER(memory), .range = SAM_RANGE_NONNEGATIVE, .needs = "gradient"},
  {"gradient_rtol", "relative residual of their systems", SAM_OPTION_REAL, MEMBER(rtol), .range = SAM_RANGE_POSITIVE,
   .needs = "gradient", .loosest = SAM_GRADIENT_LOOSEST, .beyond = "derivatives are wrong by per cents"}};

/* Calls a function for each of the numbers, also after an error for one of them. */
static PetscErrorCode ForEach(SamSimulation s, PetscErrorCode (*call)(SamSimulation s, SamGradientGoal *goal))
{
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  for (int k = 0; k < s->gradients.count; k++) {
    const PetscErrorCode one = (*call)(s, &s->gradients.goal[k]);

    if (!ierr) ierr = one;
  }
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the names apart, and checks that there are some, and that none is listed twice. */
static PetscErrorCode TakeNames(SamSimulation s)
{
  SamGradientPlan *const p     = &s->gradients;
  int                    twice = -1;

  PetscFunctionBegin;
  PetscCall(PetscStrToArray(p->names, ',', &p->count, &p->name));
  PetscCheck(p->count > 0, s->comm, SAM_ERR_USER, "-gradient %s: expected names like energy,disp_x", p->names);
  for (int k = 0; k < p->count; k++)
    for (int m = 0; m < k; m++)
      if (!strcmp(p->name[k], p->name[m])) twice = k;
  PetscCheck(twice < 0, s->comm, SAM_ERR_USER, "-gradient %s: %s is listed twice", p->names, p->name[twice]);
  PetscCall(PetscCalloc1(p->count, &p->goal));
  for (int k = 0; k < p->count; k++) p->goal[k].name = p->name[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationForgetGradients(SamSimulation s)
{
  SamGradientPlan *const p = &s->gradients;

  PetscFunctionBegin;
  PetscCall(PetscStrToArrayDestroy(p->count, p->name));
  PetscCall(PetscFree(p->goal));
  p->count = 0;
  p->name  = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a number, and raises the memory of the numbers, which are computed one after the other, to that of it. */
static PetscErrorCode Find(SamSimulation s, SamGradientGoal *goal)
{
  PetscFunctionBegin;
  PetscCall(SamGradientFind(s->comm, goal->name, goal));
  for (int k = 0; k < 3; k++)
    s->needs.gradient_bytes[k] = PetscMax(s->needs.gradient_bytes[k], goal->objective->bytes[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationReadGradientMemory(SamSimulation s, const SamOptions *from)
{
  SamOptionRow row = rows[MEMORY];

  PetscFunctionBegin;
  row.needs = NULL;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &s->gradients, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationReadGradients(SamSimulation s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamSimulationForgetGradients(s));
  s->gradients = (SamGradientPlan){.rtol = 1e-4};
  PetscCall(SamOptionsRead(from, "Gradients", SAM_OPTION_ROWS(rows), &s->gradients, NULL));
  s->needs.gradient_memory = s->gradients.memory;
  s->needs.gradient        = s->gradients.names[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscArrayzero(s->needs.gradient_bytes, 3));
  s->needs.gradient_jumps = s->needs.life && s->plan.life.fixed ? s->plan.cycles / s->plan.life.jump : 0;
  if (!s->needs.gradient) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TakeNames(s));
  PetscCall(ForEach(s, Find));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Check(SamSimulation s, SamGradientGoal *goal)
{
  const SamControl last = SamHistoryGetStep(s->history, s->needs.steps - 1);

  PetscFunctionBegin;
  PetscCall(SamGradientCheck(s->gradient, goal, last.force, s->gradients.of));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects friction that changes, before any step. */
static PetscErrorCode CheckFriction(SamSimulation s)
{
  const SamCondition *scale   = SamConditionsFind(s->setup.conditions, SAM_FRICTION_SCALE);
  PetscBool           changes = s->plan.points > 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt k = 1; scale && k < s->needs.steps && !changes; k++) {
    const SamControl first = SamHistoryGetStep(s->history, 0), one = SamHistoryGetStep(s->history, k);

    if (SamControlGet(&first, scale) != SamControlGet(&one, scale)) changes = PETSC_TRUE;
  }
  PetscCheck(!changes, s->comm, SAM_ERR_USER,
             "-gradient with friction that changes in the history has no derivative: keep it the same");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationBeginGradients(SamSimulation s)
{
  const PetscInt count = SamSimulationCountSteps(s);
  const PetscInt first = s->gradients.steps[0], last = s->gradients.steps[1];

  PetscFunctionBegin;
  if (!s->gradients.count) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck((first == 0 && last == 0) || (first >= 1 && first <= last && last <= count), s->comm, SAM_ERR_USER,
             "-gradient_steps %" PetscInt_FMT ",%" PetscInt_FMT ": the history has %" PetscInt_FMT
             " steps: give the first and the last one, from 1 on",
             first, last, count);
  PetscCall(CheckFriction(s));
  PetscCall(SamSimulationRecordGradient(s, PETSC_TRUE));
  PetscCall(SamErrorsRecordGradient(s, PETSC_TRUE));
  PetscCall(SamSimulationBeginCycles(s));
  PetscCall(ForEach(s, Check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the gradient of a number with its errors, writes it and tells of it. */
static PetscErrorCode End(SamSimulation s, SamGradientGoal *goal)
{
  const PetscInt   steps[2] = {s->gradients.steps[0] - 1, s->gradients.steps[1] - 1};
  SamGradientShare shares[SAM_GRADIENT_SHARES];
  PetscReal        borders;
  PetscInt         count;
  char             text[SAM_MESSAGE];

  PetscFunctionBegin;
  PetscCall(SamGradientCompute(s->gradient, goal, steps, s->gradients.of, s->gradients.rtol));
  PetscCall(SamGradientGetShares(s->gradient, shares, &count));
  PetscCall(SamErrorsAddGradient(s, goal, count, shares));
  if (s->output) PetscCall(SamOutputWriteGradient(s->output, s->gradient, goal->name, count, shares));
  PetscCall(SamGradientDescribe(s->gradient, count, shares, text, sizeof(text)));
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_GRADIENT, .text = text}));
  PetscCall(SamGradientGetNumber(s->gradient, "borders", 0, &borders));
  (void)snprintf(text, sizeof(text),
                 "gradient of %s: %.0f cells are on the border of their set: it holds to one side, and jumps there by "
                 "the share of these cells",
                 goal->name, (double)borders);
  if (borders > 0) PetscCall(SamSimulationWarn(s, text, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationEndGradients(SamSimulation s)
{
  PetscFunctionBegin;
  if (!s->gradients.count || !(s->output || s->errors)) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->point.worst != SAM_STATUS_CONVERGED || s->stopped) {
    PetscCall(SamSimulationWarn(s, "the gradients are not computed: they need all steps, in one run", "gradient"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ForEach(s, End));
  PetscCall(SamSimulationRecordGradient(s, PETSC_FALSE));
  PetscCall(SamErrorsRecordGradient(s, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationRecordGradient(SamSimulation s, PetscBool on)
{
  PetscFunctionBegin;
  PetscCheck(!on || !SamContactHasStep(s->setup.contact, SAM_COMMITTED), s->comm, PETSC_ERR_ORDER,
             "the gradient: the contact has steps already: begin before its first step, or after a reset");
  PetscCall(SamGradientDestroy(&s->gradient));
  if (on) PetscCall(SamSimulationCreateGradient(s, s->setup.gap, s->gradients.memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

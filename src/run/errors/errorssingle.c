/*
  The errors of the numbers of steps that are given one by one, by companion runs: -errors companion in process.

  Each try is tried by the companions, too; that with other steps takes it in two halves. They are committed or rejected
  with it. Their committed states are those of the same steps, so that all numbers of a step can be compared; what is
  not known of a state that comes from elsewhere, as from a file, stays unknown until the contact is reset.
*/
#include "errorsimpl.h"
#include <petsam/private/control.h>
#include <petsam/private/contact.h>
#include <petsam/private/problem.h>
#include <petsam/private/setup.h>

/* Compares the companions of a step, whose sums are those of its own parts. */
static void CompareStep(SamSimulation s)
{
  const SamErrors e = s->errors;

  for (PetscInt k = 0; k < e->count && e->companion[SAM_RUN_OTHER].run; k++) {
    e->number[k].apart = 0;
    for (int c = 0; c < SAM_RUNS; c++) e->number[k].mark[c] = 0;
    SamErrorsCompareSteps(s, &e->number[k]);
  }
}

void SamErrorsKeep(SamSimulation s)
{
  SamErrors e = s->errors;

  e->committed = e->largest;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) e->driven[c] = s->start.loads[c];
}

PetscErrorCode SamErrorsTry(SamSimulation s, const SamStep *step)
{
  const SamErrors e     = s->errors;
  const double    began = MPI_Wtime();
  SamState        state;

  PetscFunctionBegin;
  if (!e || !SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  e->largest = e->committed;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    s->start.loads[c] =
      e->driven[c] || !step->control.force[c] || step->control.value[c] != 0 ? PETSC_TRUE : PETSC_FALSE;
  for (int c = 0; c < SAM_RUNS; c++) {
    if (!e->companion[c].run) continue;
    SamContactSetSettles(e->companion[c].run->setup.contact, s->gradient ? PETSC_TRUE : PETSC_FALSE);
    PetscCall(SamCompanionTry(&e->companion[c], c == SAM_RUN_OTHER ? 2 : 1, &step->control));
  }
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(SamErrorsFind(e, state));
  SamErrorsBegin(&e->largest, &step->control);
  SamErrorsRaise(&e->largest, state);
  CompareStep(s);
  PetscCall(PetscArrayzero(e->sums, SAM_STATE_NUMBERS));
  e->resolved = PETSC_FALSE;
  PetscCall(SamErrorsSet(s, &step->control));
  e->table.seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsCommit(SamSimulation s)
{
  const SamErrors e = s->errors;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  SamErrorsKeep(s);
  for (int c = 0; c < SAM_RUNS; c++)
    if (e->companion[c].run) PetscCall(SamCompanionCommit(&e->companion[c]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsAdvise(SamSimulation s, const SamStep *step, SamAdvice *advice)
{
  const SamErrors e = s->errors;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  e->table.count = 0;
  e->closed      = &advice->doubts;
  PetscCall(SamErrorsAddNumbers(s, &step->control));
  PetscCall(SamErrorsAddDoubts(e, advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsLose(SamSimulation s, const char why[])
{
  const SamErrors e = s->errors;

  PetscFunctionBegin;
  if (e) (void)snprintf(e->unknown, sizeof(e->unknown), "%s", why);
  for (int c = 0; c < SAM_RUNS && e; c++)
    if (e->companion[c].run) PetscCall(SamCompanionLose(&e->companion[c], why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsReset(SamSimulation s)
{
  const SamErrors e = s->errors;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  e->largest = e->committed = (SamErrorLargest){.load = 0};
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) e->driven[c] = PETSC_FALSE;
  e->unknown[0] = '\0';
  for (int c = 0; c < SAM_RUNS; c++) {
    SamCompanion *one = &e->companion[c];

    if (!one->run) continue;
    one->lost = PETSC_FALSE;
    PetscCall(SamCompanionReject(one));
    PetscCall(SamContactReset(one->run->setup.contact));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsCopy(SamSimulation s, SamSimulation from)
{
  const SamErrors e = s->errors, other = from->errors;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  if (!other) {
    PetscCall(SamErrorsLose(s, "the state is that of a contact without -errors companion"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  e->largest = e->committed = other->committed;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) e->driven[c] = other->driven[c];
  PetscCall(PetscStrncpy(e->unknown, other->unknown, sizeof(e->unknown)));
  for (int c = 0; c < SAM_RUNS; c++) {
    SamCompanion *one = &e->companion[c], *its = &other->companion[c];
    SamState      state;
    PetscBool     current;

    if (!one->run || !its->run) continue;
    PetscCall(SamCompanionReject(one));
    PetscCall(SamCompanionReject(its));
    one->lost = its->lost;
    PetscCall(PetscStrncpy(one->fault, its->fault, sizeof(one->fault)));
    PetscCall(SamContactGetState(its->run->setup.contact, &state));
    PetscCall(SamContactIsGapCurrent(its->run->setup.contact, &current));
    PetscCall(SamContactSetState(one->run->setup.contact, state, current));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamErrorsSetField(SamSimulation s, PetscErrorCode (*set)(const SamSetup *, Vec), Vec field)
{
  const SamErrors e = s->errors;

  PetscFunctionBegin;
  for (int c = 0; c < SAM_RUNS && e; c++) {
    SamCompanion *one = &e->companion[c];
    Vec           means;

    if (!one->run) continue;
    PetscCall(SamCompanionReject(one));
    PetscCall(SamGridCreateVec(one->run->setup.grid, 1, &means));
    PetscCall(SamSetupAverage(&s->setup, field, &one->run->setup, means));
    PetscCall((*set)(&one->run->setup, means));
    PetscCall(VecDestroy(&means));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

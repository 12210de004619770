/* What a user should know of a simulation besides its results: warnings, each of them once. */
#include "simulationimpl.h"

/* A coefficient of friction from the first of these on is likely to be percent; from the second on it means stick. */
static const PetscReal percent[2] = {5, 100};
/* Dundurs' beta, or what stands for it in bodies of several materials, from which one step of N is too coarse. */
#define DISSIMILAR 0.05

PetscErrorCode SamSimulationPrepareAdvice(SamSimulation s, PetscInt first)
{
  PetscReal          friction;
  PetscBool          moves, rubs;
  SamLaw             law;
  SamContactSettings set;
  char               text[160];
  const SamGrid      g        = s->setup.grid;
  const double       waves[2] = {PETSC_PI / (double)g->length, PETSC_PI / (double)g->side[1]};

  PetscFunctionBegin;
  for (PetscInt k = first; k < s->needs.steps; k++) {
    SamControl      control;
    const PetscReal before = s->most.normal;

    PetscCall(SamHistoryGetStep(s->history, k, &control));
    SamLoadsMostAdd(&s->most, &control);
    if (k == first || s->most.normal > before) s->largest = k;
  }
  PetscCall(SamProblemMoves(s->setup.problem, &moves));
  if (moves) s->most.open = PETSC_TRUE;
  PetscCall(SamProblemGetLaw(s->setup.problem, SAM_LAW_COULOMB, &law));
  PetscCall(SamLawGetFriction(law, &friction));
  if (friction >= percent[0] && friction <= percent[1]) {
    (void)snprintf(text, sizeof(text), "the coefficient of friction is %g: give a ratio, %g for %g percent",
                   (double)friction, (double)friction / 100, (double)friction);
    PetscCall(SamSimulationWarn(s, text, "friction"));
  }
  PetscCall(SamProblemHasFriction(s->setup.problem, &rubs));
  PetscCall(SamContactGetSettings(s->setup.contact, &set));
  if (rubs && set.coupling && SamMotionOf(s->setup.elasticity)->continues && s->needs.steps == 1 &&
      SamPairCoupling(s->setup.pair, waves[0], waves[1]) > DISSIMILAR)
    PetscCall(
      SamSimulationWarn(s,
                        "elastically dissimilar bodies with friction slip while the normal load grows, here in one "
                        "step: use more steps until the stick area converges",
                        "steps"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationAdviseEdge(SamSimulation s, SamStep *step)
{
  const size_t used = strlen(step->message);

  PetscFunctionBegin;
  PetscCall(SamAdviseEdge(&s->setup, &s->most, step));
  if (step->message[used] && step->status)
    (void)strncat(step->message, "; to continue anyway: -allow_edge_contact",
                  sizeof(step->message) - strlen(step->message) - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationExamineLaws(SamSimulation s, PetscInt k)
{
  char advice[400], text[440];

  PetscFunctionBegin;
  for (PetscInt law = 0;; law++) {
    PetscCall(SamContactAdvise(s->setup.contact, &law, advice, sizeof(advice)));
    if (!advice[0]) break;
    if (s->advised[law]) continue;
    s->advised[law] = PETSC_TRUE;
    (void)snprintf(text, sizeof(text), "step %" PetscInt_FMT ": %s", k + 1, advice);
    PetscCall(SamSimulationWarn(s, text, "steps"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationExamine(SamSimulation s, PetscInt k, const SamStep *step)
{
  SamExtent extent;

  PetscFunctionBegin;
  if (s->examined || k < s->largest || !SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  s->examined = PETSC_TRUE;
  PetscCall(SamSetupMeasure(&s->setup, &extent));
  PetscCall(SamSimulationTell(s, &(SamSimulationNews){.kind = SAM_NEWS_EXTENT, .step = k, .extent = &extent}));
  PetscCall(SamAdviseStep(&s->setup, step, &extent, &s->most, SamSimulationWarn, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

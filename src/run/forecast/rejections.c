/* Rejects, before the first step, loads and options that the bodies or the laws of the contact do not bear. */
#include "forecast.h"
#include <petsam/private/contact.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/arguments.h>
#include <petsam/private/base.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/solutionimpl.h>

/* Rejects moments and rotations that the bodies do not have, and components that laws reject, by the name that the user
   gave. */
static PetscErrorCode CheckComponents(SamSimulation s, const SamOptions *from)
{
  PetscInt       wrong;
  char           why[192];
  const PetscInt count = SamHistoryGetCount(s->history);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k = SamHistoryNextEnd(s->history, k)) {
    SamControl control = SamHistoryGetStep(s->history, k);

    PetscCall(SamProblemCheckControl(s->setup.problem, &control, &wrong, why, sizeof(why)));
    PetscCheck(!why[0], from->comm, SAM_ERR_USER, "-%s%s, or its column in -history: %.6g: %s", SamOptionsPrefix(from),
               SamControlPartName(&control, s->setup.conditions, wrong),
               (double)SamControlPart(&control, s->setup.conditions, wrong), why);
    for (PetscInt c = SAM_COMPONENT_MX; c < SAM_COMPONENTS; c++) {
      char      place[PETSC_MAX_PATH_LEN + 32];
      PetscBool given;

      if (control.value[c] == 0 || SamElasticityGetTraits(s->setup.elasticity).rotations[c - SAM_COMPONENT_MX])
        continue;
      PetscCall(SamOptionsHas(from, SamComponentNameOf(c, SamControlWay(&control, c)), &given));
      PetscCall(SamHistoryGetPlace(s->history, k, place, sizeof(place)));
      if (given || !place[0]) (void)snprintf(place, sizeof(place), "-%s", SamOptionsPrefix(from));
      SETERRQ(from->comm, SAM_ERR_USER,
              "%s%s %.6g: has no meaning with -%selasticity %s, which has no such moment or rotation", place,
              SamComponentNameOf(c, SamControlWay(&control, c)), (double)control.value[c], SamOptionsPrefix(from),
              SamElasticityKeyword(s->setup.elasticity));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects laws that are incompatible with the other options. */
static PetscErrorCode CheckLaws(SamSimulation s, const SamOptions *from)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(s->setup.problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) {
    PetscCheck(!laws[k]->needs_friction || s->needs.friction, from->comm, SAM_ERR_USER,
               "-%s is given without -friction, on which it acts: give -friction, or remove it", laws[k]->option);
    PetscCheck(!laws[k]->by_passages || s->needs.life || !SamMotionOf(s->setup.elasticity)->streams, from->comm,
               SAM_ERR_USER, "-%s with -rolling steady is that of passages: give their number, -wear_cycles",
               laws[k]->option);
    PetscCheck(!laws[k]->forbids_jumps || !s->needs.life, from->comm, SAM_ERR_USER,
               "-%s with -wear_cycles: cycle jumps ignore what it changes in skipped cycles: repeat the rows in "
               "-history, or omit one option",
               SamLawOption(laws[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCheckProgram(SamSimulation s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(CheckLaws(s, from));
  PetscCall(CheckComponents(s, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects a load step that no contact of this kind can take. */
static PetscErrorCode CheckStep(SamSimulation s, PetscInt k)
{
  const SamControl control = SamHistoryGetStep(s->history, k);
  char             where[PETSC_MAX_PATH_LEN + 32];

  PetscFunctionBegin;
  PetscCall(SamHistoryGetPlace(s->history, k, where, sizeof(where)));
  PetscCall(SamContactCheckConditions(s->setup.contact, &control, where));
  PetscCall(SamMotionCheck(s->setup.elasticity, s->setup.conditions, &control, where));
  PetscCheck(SamProblemGetRolled(s->setup.problem, &control, NULL) == 0 || !s->needs.life, s->comm, SAM_ERR_USER,
             "roll with -wear_cycles: surfaces that roll are worn step by step: omit one of them");
  PetscCheck(s->step_rtol == 0 || (SamProblemGetRolled(s->setup.problem, &control, NULL) == 0 &&
                                   SamMotionOf(s->setup.elasticity)->continues),
             s->comm, SAM_ERR_USER, "-step_rtol with rolling, which has no estimate of the energy's error: use -steps");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCheckSteps(SamSimulation s)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k))
    if (SamHistoryIsLast(s->history, k)) PetscCall(CheckStep(s, k));
  for (PetscInt k = 0; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k))
    if (!SamHistoryIsLast(s->history, k)) PetscCall(CheckStep(s, k));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The verdict: what the check of a step found becomes its status. */
#include "contactimpl.h"

PetscErrorCode SamStepFail(SamStep *step, SamStatus status, const char message[])
{
  PetscFunctionBegin;
  if (step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  step->status = status;
  PetscCall(PetscStrncpy(step->message, message, sizeof(step->message)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Written so that a residual that is not a number disagrees too. */
static PetscBool Agrees(const SamCheck *check, const SamCheckLimits *limits)
{
  return (check->normal <= limits->normal && check->tangential <= limits->tangential &&
          check->equilibrium <= limits->equilibrium && check->cone <= limits->cone)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

PetscErrorCode SamStepJudge(SamStep *step, const SamCheckLimits *limits)
{
  const SamCheck *check = &step->check;
  char            message[sizeof(step->message)];

  PetscFunctionBegin;
  if (!Agrees(check, limits)) {
    PetscCall(PetscSNPrintf(
      message, sizeof(message), "the check disagrees: normal residual %g, tangential %g, equilibrium %g, cone %g",
      (double)check->normal, (double)check->tangential, (double)check->equilibrium, (double)check->cone));
    PetscCall(SamStepFail(step, SAM_STATUS_NOT_CONVERGED, message));
  }
  if (check->edge == 0 || step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  if (!limits->edge) step->status = SAM_STATUS_EDGE_CONTACT;
  PetscCall(PetscSNPrintf(step->message, sizeof(step->message),
                          "the contact reached the edge of the grid (pressure there up to %.2g of the largest): the "
                          "answer depends on the size of the grid",
                          (double)check->edge));
  PetscCall(PetscStrncpy(step->setting, "grid_size", sizeof(step->setting)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

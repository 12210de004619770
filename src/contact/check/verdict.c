/* The verdict: turns the errors that the check of a step found into its status and message. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/check.h>

/* True if all residuals are within their limits. The comparisons use <= so that a NaN fails, too. */
static PetscBool Agrees(const SamCheck *check, const SamCheckLimits *limits)
{
  return check->normal <= limits->normal && check->tangential <= limits->tangential &&
         check->equilibrium <= limits->equilibrium && check->cone <= limits->cone;
}

const char *SamCheckDescribeEdge(const SamCheck *check, char text[], size_t size)
{
  if (check->edge >= 0.995) /* a share that would be printed as 1 */
    (void)snprintf(text, size, "the maximum pressure is there");
  else
    (void)snprintf(text, size, "pressure there up to %.2g times the maximum", (double)check->edge);
  return text;
}

PetscErrorCode SamStepJudge(SamStep *step, const SamCheckLimits *limits)
{
  const SamCheck *check = &step->check;
  char            message[sizeof(step->message)], place[64];

  PetscFunctionBegin;
  if (!Agrees(check, limits)) {
    PetscCall(PetscSNPrintf(
      message, sizeof(message),
      "the check disagrees: normal residual %.6g (limit %.6g), tangential %.6g (%.6g), equilibrium %.6g "
      "(%.6g), cone %.6g (%.6g)",
      (double)check->normal, (double)limits->normal, (double)check->tangential, (double)limits->tangential,
      (double)check->equilibrium, (double)limits->equilibrium, (double)check->cone, (double)limits->cone));
    PetscCall(SamStepFail(step, SAM_STATUS_NOT_CONVERGED, message));
  }
  if (check->edge == 0 || step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  if (!limits->edge) step->status = SAM_STATUS_EDGE_CONTACT;
  PetscCall(PetscSNPrintf(step->message, sizeof(step->message),
                          "the contact reached the edge of the grid (%s): the answer depends on the size of the grid",
                          SamCheckDescribeEdge(check, place, sizeof(place))));
  PetscCall(PetscStrncpy(step->setting, "grid_size", sizeof(step->setting)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

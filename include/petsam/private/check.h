/* Functions of check, besides petsam/check.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_CHECK_H
#define PETSAM_PRIVATE_CHECK_H

#include <petsam/check.h>

/* SamCheckLimits - the largest errors of a step that counts as converged. */
typedef struct {
  PetscReal normal, tangential, equilibrium, cone;
  PetscBool edge; /* true: contact at the edge of the grid is only a warning */
} SamCheckLimits;

/*
  SamStepJudge - sets a step's status and message from the errors in step->check. An error that is NaN fails. A status
  other than CONVERGED that the step already has is kept. Not collective: all ranks have the same numbers.
*/
PETSC_INTERN PetscErrorCode SamStepJudge(SamStep *step, const SamCheckLimits *limits);

/*
  SamCheckDescribeEdge - writes, for messages, how large the pressure at the edge of the grid is; returns the text. Not
  collective.
*/
PETSC_INTERN const char *SamCheckDescribeEdge(const SamCheck *check, char text[], size_t size);

/*
  SamStepFail - sets status and message unless the step has failed already, since later failures follow from the first.
*/
static inline PetscErrorCode SamStepFail(SamStep *step, SamStatus status, const char message[])
{
  PetscFunctionBegin;
  if (step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  step->status = status;
  PetscCall(PetscStrncpy(step->message, message, sizeof(step->message)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif

/* The source of an evaluation: the tractions of a step. */
#include "evaluationimpl.h"

PetscErrorCode SamEvaluationReadTractions(SamEvaluation e, PetscInt step, PetscBool own,
                                          double *const to[SAM_STRESS_TRACTIONS])
{
  static const char *const names[SAM_STRESS_TRACTIONS] = {"pressure", "shear_x", "shear_y"};

  PetscFunctionBegin;
  e->stress->conditions = SamProblemGetConditions(e->problem);
  e->stress->control = step < 0 ? NULL : &e->control[step]; /* no stress is requested for the step before the first */
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
    PetscCall((*e->source.read)(e->source.context, step, names[t], to[t]));
    if (own && t == SAM_STRESS_P) PetscCall(SamPointsCheck(e, step, to[t]));
    if (own) PetscCall(SamPointsMove(e, step, to[t]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationTell(SamEvaluation e, const char work[], double part, double whole)
{
  PetscFunctionBegin;
  if (e->source.tell) PetscCall((*e->source.tell)(e->source.context, work, part, whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The source of an evaluation: the tractions of a step, and the stress that is uniform at a depth. */
#include "evaluationimpl.h"
#include <petsam/private/body.h>

PetscErrorCode SamEvaluationReadTractions(SamEvaluation e, PetscInt step, PetscBool own,
                                          double *const to[SAM_STRESS_TRACTIONS])
{
  PetscFunctionBegin;
  e->stress->conditions = SamProblemGetConditions(e->problem);
  e->stress->control = step < 0 ? NULL : &e->control[step]; /* no stress is requested for the step before the first */
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
    PetscCall((*e->source.read)(e->source.context, step, (SamStepField)(SAM_STEP_PRESSURE + t), to[t]));
    if (own && t == SAM_STRESS_P) PetscCall(SamPointsCheck(e, step, to[t]));
    if (own) PetscCall(SamPointsMove(e, step, to[t]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the stresses at a depth that do not depend on x and y: the stress before any load, unless the layers of the
  body already include it, and the stress that laws add in a step.
*/
static void GetUniform(SamEvaluation e, PetscInt step, PetscReal depth, double stress[SAM_STRESS_COMPONENTS])
{
  double initial[2] = {0};

  for (int k = 0; k < SAM_STRESS_COMPONENTS; k++) stress[k] = 0;
  if (!SamLayersHaveInitial(e)) SamBodyInitialStress(SamEvaluationBody(e), (double)depth, initial);
  stress[SAM_STRESS_XX] = initial[0];
  stress[SAM_STRESS_YY] = initial[1];
  (void)SamProblemAddStress(e->problem, &e->control[step], e->body - 1, depth, stress);
}

void SamStressAddUniform(SamEvaluation e, PetscInt step, const SamPoints *p, double stress[])
{
  double uniform[SAM_STRESS_COMPONENTS];

  for (PetscInt depth = 0; depth < p->depths; depth++) {
    GetUniform(e, step, e->depth[p->depth + depth], uniform);
    for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++) {
      double *const s = stress + k * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane;

      for (PetscInt i = 0; i < p->plane && uniform[k] != 0; i++) s[i] += uniform[k];
    }
  }
}

PetscErrorCode SamEvaluationTell(SamEvaluation e, const char work[], double part, double whole)
{
  PetscFunctionBegin;
  if (e->source.tell) PetscCall((*e->source.tell)(e->source.context, work, part, whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

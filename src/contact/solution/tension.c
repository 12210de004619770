/* The tension by which surfaces attract each other, in the tractions and loads of a solution. */
#include <petsam/private/balance.h>
#include <petsam/private/problem.h>
#include <petsam/private/solutionimpl.h>

PetscErrorCode SamSolutionCreateTotal(SamProblem problem, const SamSolution *s, Vec *total)
{
  PetscFunctionBegin;
  *total = s->pressure;
  if (!s->tension) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(SamProblemGetGrid(problem), 1, total));
  PetscCall(VecWAXPY(*total, -1, s->tension, s->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionDestroyTotal(const SamSolution *s, Vec *total)
{
  PetscFunctionBegin;
  if (*total != s->pressure) PetscCall(VecDestroy(total));
  *total = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the loads that contact bears because of the tension; 0 without. */
static PetscErrorCode GetBorne(SamProblem problem, const SamSolution *s, PetscReal borne[SAM_COMPONENTS])
{
  PetscReal loads[3];

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(borne, SAM_COMPONENTS));
  if (!s->tension) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamBalanceGetLoads(SamProblemGetGrid(problem), SAM_BALANCE_NORMAL, s->tension, loads));
  for (PetscInt k = 0; k < 3; k++) borne[SamComponentsOf[SAM_BALANCE_NORMAL][k]] = loads[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionGiven(SamProblem problem, const SamSolution *s, PetscReal load[])
{
  PetscReal borne[SAM_COMPONENTS];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(load, s->load, SAM_COMPONENTS));
  if (!s->tension) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GetBorne(problem, s, borne));
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt c = SamComponentsOf[SAM_BALANCE_NORMAL][k];

    load[c] = s->control.force[c] ? s->control.value[c] : load[c] - borne[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionTake(SamProblem problem, SamSolution *s)
{
  PetscReal borne[SAM_COMPONENTS];

  PetscFunctionBegin;
  PetscCall(GetBorne(problem, s, borne));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) s->load[k] += borne[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionTensionError(SamProblem problem, const SamSolution *s, Vec change, PetscReal *error)
{
  const SamGrid grid = SamProblemGetGrid(problem);
  PetscReal     loads[3][3];
  const Vec     fields[3] = {change, s->pressure, s->tension};

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, fields[k], loads[k]));
  *error = PetscAbsReal(loads[0][0]);
  if (*error > 0) *error /= PetscMax(loads[1][0], PetscMax(loads[2][0], *error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

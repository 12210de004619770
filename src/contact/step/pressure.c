/* The solution of the normal problem for a separation, and the count of what solvers do. */
#include "stepimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/solver.h>

PetscErrorCode SamSolveCount(SamSolver solver, double counts[3])
{
  PetscInt last[3];

  PetscFunctionBegin;
  PetscCall(SamSolverGetStatistics(solver, NULL, &last[0], &last[1], &last[2]));
  for (int k = 0; k < 3; k++) counts[k] += (double)last[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolvePressureOnce(SamSolve *w, Vec h, PetscBool has_pressure)
{
  SamBalance balance = w->normal;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][k]]; /* of the last pass */
  PetscCall(SamNormalSolveKeeping(w->task->normal, h, &balance, has_pressure, w->s->pressure,
                                  w->task->coupled ? &w->pressure_product : NULL));
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscCall(SamSolveCount(SamNormalAsSolver(w->task->normal), w->counts + SAM_COUNT_NORMAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolvePressure(SamSolve *w, Vec h, PetscBool has_pressure)
{
  PetscFunctionBegin;
  PetscCall((w->task->traits.skewed ? SamSolveSkewed : SamSolvePressureOnce)(w, h, has_pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

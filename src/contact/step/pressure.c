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

PetscErrorCode SamSolvePressureOnce(SamSolve *w, Vec h)
{
  SamBalance balance = w->normal;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][k]]; /* of the last pass */
  PetscCall(SamNormalSolveKeeping(w->solver, h, &balance, w->has_pressure, w->s->pressure,
                                  w->pressure_product.field ? &w->pressure_product : NULL));
  w->has_pressure = PETSC_TRUE;
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscCall(SamSolveCount(SamNormalAsSolver(w->solver), w->counts + SAM_COUNT_NORMAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolvePressure(SamSolve *w, Vec h)
{
  PetscFunctionBegin;
  PetscCall((w->contact->traits.skewed ? SamSolveSkewed : SamSolvePressureOnce)(w, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

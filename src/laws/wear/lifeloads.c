/* The wear loads of a life, the sums of its laws, and the normal problem on surfaces that wear by the pressure. */
#include "lifeimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/normal.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>
#include <petsam/private/state.h>

/* ---- loads and sums ---- */

PetscErrorCode SamLifeGetSum(SamLife l, PetscInt k, Vec *sum)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  *sum = NULL;
  PetscCall(SamProblemGetLaws(l->problem, &count, &laws));
  if (k < count && laws[k]->accumulates)
    PetscCall(SamStateRestoreField(l->memory, SamStateFindField(l->memory, laws[k]->type), SAM_COMMITTED, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBeginSums(SamLife l, PetscBool middle)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_LAWS; k++) {
    Vec sum;

    PetscCall(SamLifeGetSum(l, k, &sum));
    if (sum && middle) PetscCall(VecSet(sum, 0));
    if (sum && !middle) PetscCall(VecCopy(l->before[k], sum));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeRemembered(SamLife l, const char name[], Vec *field)
{
  PetscFunctionBegin;
  PetscCall(SamStateRestoreField(l->memory, SamStateFindField(l->memory, name), SAM_COMMITTED, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeGetLoads(SamLife l, SamLoads loads)
{
  static const char *const names[SAM_WEAR_LOADS] = {SAM_WEAR_LOAD, SAM_WEAR_LOAD2};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(SamLifeRemembered(l, names[k], &loads[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeSetLoads(SamLife l, const SamLoads loads)
{
  SamLoads to;

  PetscFunctionBegin;
  PetscCall(SamLifeGetLoads(l, to));
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(VecCopy(loads[k], to[k]));
  l->law->revision++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeIntegrate(SamGrid grid, Vec field)
{
  double *f;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &f));
  for (PetscInt first = 0; first < grid->cells; first += grid->nx) {
    double sum = 0;

    for (PetscInt k = first; k < first + grid->nx; k++) sum += f[k] * (double)grid->dx;
    for (PetscInt k = first; k < first + grid->nx; k++) f[k] = sum;
  }
  PetscCall(VecRestoreArray(field, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the normal problem ---- */

/* Reports a jump without solution as a failed step. */
static PetscErrorCode FailJump(SamLife l, PetscReal cycles, SamSolverReason reason)
{
  PetscFunctionBegin;
  l->at          = l->cycle.steps - 1;
  l->step.status = SAM_STATUS_NOT_CONVERGED;
  (void)snprintf(l->step.message, sizeof(l->step.message),
                 "the normal problem of a cycle jump of %.10g cycles did not converge: %s", (double)cycles,
                 SamSolverReasonName(reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeSolveNormal(SamLife l, Vec gap, Vec yield, SamBalance balance, PetscReal cycles, PetscBool guess,
                                  Vec p, PetscBool *solved)
{
  const SamNormal normal = SamContactGetNormal(l->contact);

  PetscFunctionBegin;
  PetscCall(SamNormalSolveYielding(normal, gap, yield, &balance, guess, p));
  *solved = SamSolverGetReason(SamNormalAsSolver(normal)) > 0;
  if (!*solved) PetscCall(FailJump(l, cycles, SamSolverGetReason(SamNormalAsSolver(normal))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

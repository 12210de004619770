/* The normal problem for its tests: loads, and a solver that is made, used once and described. */
#ifndef PETSAM_NORMALS_H
#define PETSAM_NORMALS_H

#include "fields.h"

#include <petsam/normal.h>

/* All three components under force control. */
static inline SamBalance Forced(double N, double Mx, double My)
{
  const SamBalance b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {N, Mx, My}};

  return b;
}

static inline SamBalance Displaced(const PetscReal rigid[3])
{
  const SamBalance b = {.kind = SAM_BALANCE_NORMAL, .rigid = {rigid[0], rigid[1], rigid[2]}};

  return b;
}

typedef struct {
  SamSolverReason reason;
  PetscReal       error;
  PetscInt        iterations, applies, preconditions;
} Outcome;

/* Solves with a new solver; type NULL: the default, rtol 0: the default. */
static inline Outcome Solve(SamElasticity elasticity, Vec h, SamSolverType type, double rtol, SamBalance *balance,
                            Vec p)
{
  SamNormal normal;
  Outcome   o;

  sam_call(SamNormalCreate(elasticity, &normal));
  if (type) sam_call(SamSolverSetType(SamNormalAsSolver(normal), type));
  if (rtol > 0) sam_call(SamSolverSetTolerances(SamNormalAsSolver(normal), rtol, PETSC_DEFAULT));
  sam_call(SamNormalSolve(normal, h, balance, PETSC_FALSE, p));
  o.reason = SamSolverGetReason(SamNormalAsSolver(normal));
  sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), &o.error, &o.iterations, &o.applies, &o.preconditions));
  sam_call(SamNormalDestroy(&normal));
  if (getenv("SAM_SHOW"))
    print_message("# %s %s error %g its %d S %d M %d\n", type ? type : "", SamSolverReasonName(o.reason), o.error,
                  (int)o.iterations, (int)o.applies, (int)o.preconditions);
  return o;
}

static inline void SolveWell(SamElasticity elasticity, Vec h, SamSolverType type, double rtol, SamBalance *balance,
                             Vec p)
{
  sam_assert(Solve(elasticity, h, type, rtol, balance, p).reason == SAM_SOLVER_CONVERGED_RTOL);
}

#endif

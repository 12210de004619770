/* Base of all solvers: creation, the registries of types, settings, and the common part of a solve. */
#include <petsam/private/elasticity.h>
#include <petsam/private/solverimpl.h>
#include <petsam/private/solver.h>
#include <math.h>

#define BRIEF 10 /* iterations of a brief solve */
#define WORTH 10 /* iterations on the finest grid that a start for them may cost */

static SamSolverKind *kinds = NULL; /* the kinds with registries in use */

const char *SamSolverReasonName(SamSolverReason reason)
{
  static const char *const names[] = {
    "DIVERGED_NO_EQUILIBRIUM", "DIVERGED_STAGNATED", "DIVERGED_NAN", "DIVERGED_ITS", "ITERATING",
    "CONVERGED_RTOL",          "CONVERGED_TRIVIAL"};

  return names[reason - SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM];
}

/* ---- registries ---- */

static PetscErrorCode FreeRegistries(void)
{
  PetscFunctionBegin;
  for (; kinds; kinds = kinds->next) PetscCall(PetscFunctionListDestroy(&kinds->types));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RegisterAll(SamSolverKind *kind)
{
  PetscFunctionBegin;
  if (kind->types) PetscFunctionReturn(PETSC_SUCCESS);
  if (!kinds) PetscCall(PetscRegisterFinalize(FreeRegistries));
  kind->next = kinds;
  kinds      = kind;
  PetscCall(PetscFunctionListAdd(&kind->types, kind->type, kind->create));
  if (kind->upwind) PetscCall(PetscFunctionListAdd(&kind->types, kind->upwind, kind->createupwind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverRegister(SamSolverKind *kind, const char name[], PetscErrorCode (*create)(SamSolver))
{
  PetscFunctionBegin;
  PetscCall(RegisterAll(kind)); /* first, so that a type from outside replaces a built-in type of the same name */
  PetscCall(PetscFunctionListAdd(&kind->types, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- life ---- */

static PetscErrorCode DestroyType(SamSolver s)
{
  PetscFunctionBegin;
  if (s->ops.destroy) PetscCall(s->ops.destroy(s));
  PetscCall(PetscMemzero(&s->ops, sizeof(s->ops)));
  s->data          = NULL;
  s->keeps_product = s->limits_pressure = s->upwind = PETSC_FALSE;
  s->default_levels                                 = 1;
  s->default_max_it                                 = 1000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverCreate(SamSolverKind *kind, SamElasticity elasticity, SamSolver *solver)
{
  SamSolver s;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(RegisterAll(kind));
  PetscCall(PetscNew(&s));
  s->class_id = kind->class_id;
  PetscCall(SamElasticityReference(elasticity));
  s->kind       = kind;
  s->comm       = SamElasticityGetGrid(elasticity)->comm;
  s->elasticity = elasticity;
  s->rtol       = kind->rtol;

  s->pressure_limit = INFINITY;
  PetscCall(SamSolverSetOptionsPrefix(s, NULL));
  PetscCall(SamSolverSetType(s, kind->type));
  *solver = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverDestroy(SamSolver s)
{
  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroyType(s));
  PetscCall(SamElasticityDestroy(&s->elasticity));
  s->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- settings ---- */

PetscErrorCode SamSolverSetType(SamSolver s, SamSolverType type)
{
  PetscErrorCode (*create)(SamSolver);

  PetscFunctionBegin;
  SamValidHandle(s, SamSolver, 1);
  SamValidPointer(type, 2);
  PetscCall(PetscFunctionListFind(s->kind->types, type, &create));
  if (!create) {
    char types[256];

    PetscCall(SamTypesList(s->kind->types, types, sizeof(types)));
    SETERRQ(s->comm, SAM_ERR_USER, "%s is not a type of %s solver: use %s", type, s->kind->name, types);
  }
  PetscCall(DestroyType(s));
  if (type != s->type) PetscCall(PetscStrncpy(s->type, type, sizeof(s->type)));
  PetscCall(create(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamSolverType SamSolverGetType(SamSolver s)
{
  return s->type;
}

PetscErrorCode SamSolverSetOptionsPrefix(SamSolver s, const char prefix[])
{
  PetscFunctionBegin;
  SamValidHandle(s, SamSolver, 1);
  PetscCall(SamSetPrefix(s->prefix, prefix));
  PetscCall(PetscStrlcat(s->prefix, s->kind->name, sizeof(s->prefix)));
  PetscCall(PetscStrlcat(s->prefix, "_", sizeof(s->prefix)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverSetTolerances(SamSolver s, PetscReal rtol, PetscInt max_it)
{
  PetscFunctionBegin;
  SamValidHandle(s, SamSolver, 1);
  PetscCheck(rtol == PETSC_DEFAULT || rtol > 0, s->comm, PETSC_ERR_ARG_OUTOFRANGE, "rtol %.6g: expected a number > 0",
             (double)rtol);
  PetscCheck(max_it == PETSC_DEFAULT || max_it >= 0, s->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "max_it %" PetscInt_FMT ": expected a number >= 0", max_it);
  if (rtol != PETSC_DEFAULT) s->rtol = rtol;
  if (max_it != PETSC_DEFAULT) s->max_it = max_it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverGetTolerances(SamSolver s, PetscReal *rtol, PetscInt *max_it)
{
  PetscFunctionBegin;
  if (rtol) *rtol = s->rtol;
  if (max_it) *max_it = SamSolverMaxIterations(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverSetLevels(SamSolver s, PetscInt levels)
{
  PetscFunctionBegin;
  PetscCheck(levels >= 0, s->comm, PETSC_ERR_ARG_OUTOFRANGE, "levels %" PetscInt_FMT ": expected a number >= 0",
             levels);
  s->levels = levels;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverSetErrorIfNotConverged(SamSolver s, PetscBool error)
{
  PetscFunctionBegin;
  s->error_if_not_converged = error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamSolverMaxIterations(SamSolver s)
{
  const PetscInt most = s->max_it ? s->max_it : s->default_max_it;

  if (s->effort == SAM_EFFORT_RESIDUAL_ONLY) return 0;
  return s->effort == SAM_EFFORT_FEW_ITERATIONS ? PetscMin(most, BRIEF) : most;
}

PetscBool SamLevelAtMaxIterations(SamSolver s, const SamLevel *level)
{
  const double smaller = SamGridIsRow(level->grid) ? 2 : 4; /* cells of the next finer grid over those of a grid */

  if (level->depth == 0) return s->iterations >= SamSolverMaxIterations(s);
  return level->iterations >= WORTH * pow(smaller, (double)level->depth);
}

PetscInt SamSolverLevels(SamSolver s)
{
  return s->levels ? s->levels : s->default_levels;
}

void SamSolverSetEffort(SamSolver s, PetscReal rtol, SamEffort effort)
{
  s->enough = rtol;
  s->effort = effort;
}

PetscErrorCode SamSolverMonitorSet(SamSolver s, SamSolverMonitor monitor, void *context)
{
  PetscFunctionBegin;
  SamValidHandle(s, SamSolver, 1);
  SamValidPointer(monitor, 2);
  PetscCheck(s->monitors < SAM_MONITORS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d monitors",
             SAM_MONITORS);
  s->monitor[s->monitors]           = monitor;
  s->monitor_context[s->monitors++] = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the solve and its results ---- */

/* Checks the fields' sizes, and that the given fields are finite, because the methods might miss a NaN. */
static PetscErrorCode CheckFields(const SamLevel *level, const SamSolverKind *kind, PetscBool *finite)
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(level->grid, kind->components, level->traction, "The traction"));
  *finite = PETSC_TRUE;
  for (PetscInt g = 0; g < SAM_GIVEN; g++) {
    if (!level->given[g]) continue;
    PetscCall(SamGridCheckVec(level->grid, kind->given_components[g], level->given[g], "The given field"));
    if (*finite) PetscCall(SamGridIsFinite(level->grid, level->given[g], finite));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverSolve(SamSolver s, const SamLevel *problem, PetscBool guess)
{
  const SamSolverKind *kind  = s->kind;
  SamLevel             level = *problem;
  PetscBool            finite;

  PetscFunctionBegin;
  PetscCheck(level.balance->kind == kind->balance, s->comm, PETSC_ERR_ARG_WRONG, "The %s solver requires a %s balance",
             kind->name, kind->name);
  PetscCall(PetscLogEventBegin(SamEvents[kind->event], 0, 0, 0, 0));
  s->iterations = s->applies = s->preconditions = 0;
  s->error                                      = 0;
  s->limit                                      = PETSC_INFINITY;
  s->reason                                     = SAM_SOLVER_ITERATING;
  level.elasticity                              = s->elasticity;
  level.rtol                                    = s->enough > 0 ? s->enough : s->rtol;
  level.depth                                   = 0;
  level.grid                                    = SamElasticityGetGrid(s->elasticity);
  if (!s->keeps_product) {
    SamLevelForgetProduct(&level);
    level.product = NULL;
  }
  PetscCall(CheckFields(&level, kind, &finite));
  if (finite) {
    PetscCall(kind->solve(s, &level, guess));
  } else {
    PetscCall(SamVecZero(level.traction));
    SamLevelForgetProduct(&level);
    s->reason = SAM_SOLVER_DIVERGED_NAN;
  }
  PetscCall(PetscLogEventEnd(SamEvents[kind->event], 0, 0, 0, 0));
  PetscCheck(s->reason, s->comm, PETSC_ERR_PLIB, "Method %s set no reason", s->type);
  if (s->effort == SAM_EFFORT_RESIDUAL_ONLY || s->effort == SAM_EFFORT_WARM) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolverViewFromOptions(s));
  PetscCheck(s->reason > 0 || !s->error_if_not_converged ||
               (s->effort == SAM_EFFORT_FEW_ITERATIONS && s->reason == SAM_SOLVER_DIVERGED_ITS),
             s->comm, PETSC_ERR_NOT_CONVERGED, "The %s solve did not converge due to %s", kind->name,
             SamSolverReasonName(s->reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamLevelWork *SamSolverGetWork(SamSolver s, PetscInt depth)
{
  return &s->work[depth];
}

SamSolverReason SamSolverGetReason(SamSolver s)
{
  return s->reason;
}

PetscErrorCode SamSolverGetStatistics(SamSolver s, PetscReal *error, PetscInt *iterations, PetscInt *applies,
                                      PetscInt *preconditions)
{
  PetscFunctionBegin;
  SamValidHandle(s, SamSolver, 1);
  if (error) *error = s->error;
  if (iterations) *iterations = s->iterations;
  if (applies) *applies = s->applies;
  if (preconditions) *preconditions = s->preconditions;
  PetscFunctionReturn(PETSC_SUCCESS);
}

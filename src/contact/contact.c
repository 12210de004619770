/* The class SamContact: its parts, its settings, its state, and its results by name. */
#include "contactimpl.h"
#include <petsam/private/state.h>
#include <petsam/private/base.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/problem.h>
#include <math.h>

/* ---- creation ---- */

PetscErrorCode SamContactCreate(SamProblem problem, SamContact *contact)
{
  SamContact    c;
  SamElasticity symmetric;

  PetscFunctionBegin;
  SamValidHandle(problem, SamProblem, 1);
  SamValidPointer(contact, 2);
  PetscCall(PetscNew(&c));
  c->class_id = SamContact_CLASSID;
  PetscCall(SamProblemReference(problem));
  c->problem    = problem;
  c->set        = (SamContactSettings){.coupling        = PETSC_TRUE,
                                       .coupling_rtol   = 1e-6,
                                       .coupling_max_it = 100,
                                       .warm_start      = PETSC_TRUE,
                                       .extrapolate     = PETSC_TRUE,
                                       .edges           = PETSC_TRUE,
                                       .cycle_memory    = NAN};
  c->elasticity = SamProblemGetElasticity(problem);
  c->grid       = SamProblemGetGrid(problem);
  c->conditions = SamProblemGetConditions(problem);
  c->traits     = SamElasticityGetTraits(c->elasticity);
  c->motion     = SamMotionOf(c->elasticity);
  PetscCall(SamElasticityGetSymmetric(c->elasticity, &symmetric));
  PetscCall(SamNormalCreate(symmetric, &c->normal));
  PetscCall(SamTangentialCreate(c->elasticity, &c->tangential));
  PetscCall(SamStateCreate(c->grid, &c->state));
  PetscCall(SamStepCacheCreate(c->grid, c->conditions, &c->cache));
  PetscCall(SamContactDeclare(c));
  PetscCall(SamContactRefresh(c));
  c->revision[SAM_COMMITTED] = -1;
  *contact                   = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactDestroy(SamContact *contact)
{
  SamContact c;

  PetscFunctionBegin;
  SamValidPointer(contact, 1);
  if (!*contact) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*contact, SamContact, 1);
  c = *contact;
  PetscCall(SamNormalDestroy(&c->normal));
  PetscCall(SamTangentialDestroy(&c->tangential));
  PetscCall(SamStateDestroy(&c->state));
  SamStepCacheDestroy(&c->cache);
  PetscCall(SamProblemDestroy(&c->problem));
  c->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- settings ---- */

PetscErrorCode SamContactSetOptionsPrefix(SamContact c, const char prefix[])
{
  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  PetscCall(SamSetPrefix(c->prefix, prefix));
  PetscCall(SamSolverSetOptionsPrefix(SamNormalAsSolver(c->normal), prefix));
  PetscCall(SamSolverSetOptionsPrefix(SamTangentialAsSolver(c->tangential), prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetSettings(SamContact c, const SamContactSettings *settings)
{
  PetscFunctionBegin;
  PetscCheck(settings->coupling_rtol > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coupling tolerance rtol = %.6g: expected a number > 0", (double)settings->coupling_rtol);
  PetscCheck(settings->coupling_max_it > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coupling iterations max_it = %" PetscInt_FMT ": expected at least 1", settings->coupling_max_it);
  PetscCheck(isnan(settings->cycle_memory) || settings->cycle_memory >= 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "cycle memory = %.6g: expected a number >= 0", (double)settings->cycle_memory);
  c->set      = *settings;
  c->declared = 0;
  SamStepCacheSetMemory(c->cache, isnan(settings->cycle_memory) ? SamStepCacheUsual(c->grid) : settings->cycle_memory);
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamContactSettings SamContactGetSettings(SamContact c)
{
  return c->set;
}

/* Rejects a keyword of earlier versions, which is not among the listed ones. */
static PetscErrorCode RefuseDeferred(const SamOptions *from)
{
  char word[16] = "";

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, from->prefix, "-edges", word, sizeof(word), NULL));
  PetscCheck(strcmp(word, "deferred"), from->comm, SAM_ERR_USER,
             "-%sedges deferred: no longer supported: use -edges reconstruct on a finer grid; -errors companion "
             "estimates its errors",
             SamOptionsPrefix(from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MEMBER(name) offsetof(SamContactSettings, name)
static const SamOptionRow rows[] = {
  {"coupling", "normal-tangential coupling of dissimilar materials: full or none", SAM_OPTION_BOOL, MEMBER(coupling),
   .words = "none,full"},
  {"coupling_rtol", "relative change of p and q between iterations", SAM_OPTION_REAL, MEMBER(coupling_rtol),
   .range = SAM_RANGE_POSITIVE},
  {"coupling_max_it", "maximum number of coupling iterations", SAM_OPTION_INT, MEMBER(coupling_max_it), .least = 1},
  {"coupling_monitor", "print the change after each coupling iteration", SAM_OPTION_BOOL,
   .member = MEMBER(coupling_monitor)},
  {"slip_direction", "by the shear at mid or end of a step", SAM_OPTION_ENUM, MEMBER(slip_direction),
   .words = "mid,end"},
  {"warm_start", "start each step from the previous steps, on the finest grid only", SAM_OPTION_BOOL,
   .member = MEMBER(warm_start)},
  {"cycle_memory", "bytes to keep steps of a repeated cycle; default: 20 fields, 48 MB to 1 GB", SAM_OPTION_REAL,
   MEMBER(cycle_memory), .range = SAM_RANGE_NONNEGATIVE},
  {"allow_edge_contact", "contact at the grid's edge is a warning, no error", SAM_OPTION_BOOL,
   .member = MEMBER(allow_edge)},
  {"edges", "reconstruct, none (count cells)", SAM_OPTION_BOOL, MEMBER(edges), .words = "none,reconstruct"},
  {"contact_spots", "number of contact spots and mean gap of each step", SAM_OPTION_BOOL, .member = MEMBER(spots)},
  {"extrapolate", "solve steady rolling on half the cells, too, for extrapolated numbers", SAM_OPTION_BOOL,
   .member = MEMBER(extrapolate)},
  {"contact_check", "print the check of each step", SAM_OPTION_BOOL, .member = MEMBER(print_check)}};

PetscErrorCode SamContactSetFromOptions(SamContact c)
{
  static const char *const of_history[] = {"slip_direction", "cycle_memory"};
  SamOptions               from;
  SamContactSettings       s;

  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  from = (SamOptions){c->grid->comm, c->prefix};
  s    = c->set;
  PetscCall(RefuseDeferred(&from));
  PetscCall(SamOptionsRead(&from, "Contact", SAM_OPTION_ROWS(rows), &s, NULL));
  for (int k = 0; k < 2; k++) {
    PetscBool has;

    PetscCall(SamOptionsHas(&from, of_history[k], &has));
    if (has) PetscCall(SamMotionRefuse(c->motion, SAM_MOTION_HISTORY, c->grid->comm, "-", of_history[k]));
  }
  PetscCall(SamContactSetSettings(c, &s));
  PetscCall(SamSolverSetFromOptions(SamNormalAsSolver(c->normal)));
  PetscCall(SamSolverSetFromOptions(SamTangentialAsSolver(c->tangential)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamContactSetSettles(SamContact c, PetscBool settles)
{
  c->settles = settles;
}

PetscErrorCode SamContactSetMonitor(SamContact c, SamSolverMonitor monitor, void *context)
{
  PetscFunctionBegin;
  PetscCall(SamSolverMonitorSet(SamNormalAsSolver(c->normal), monitor, context));
  PetscCall(SamSolverMonitorSet(SamTangentialAsSolver(c->tangential), monitor, context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamContactIsNormal(SamContact c, SamSolver solver)
{
  return solver == SamNormalAsSolver(c->normal) ? PETSC_TRUE : PETSC_FALSE;
}

const SamLevelWork *SamContactGetWork(SamContact c, SamBalanceKind kind, PetscInt depth)
{
  const PetscBool normal = kind == SAM_BALANCE_NORMAL ? PETSC_TRUE : PETSC_FALSE;

  return SamSolverGetWork(normal ? SamNormalAsSolver(c->normal) : SamTangentialAsSolver(c->tangential), depth);
}

const char *SamContactNameOf(SamContact c, const char usual[])
{
  const SamMotionName *own = SamMotionFindName(c->motion, usual);

  return own && own->name ? own->name : usual;
}

SamMotionName SamContactRigidName(SamContact c, SamComponent component)
{
  return SamMotionRigidName(c->motion, component);
}

SamProblem SamContactGetProblem(SamContact c)
{
  return c->problem;
}

PetscErrorCode SamContactGetState(SamContact c, SamState *state)
{
  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  SamValidPointer(state, 2);
  PetscCall(SamContactDeclare(c));
  *state = c->state;
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamGrid SamContactGetGrid(SamContact c)
{
  return c->grid;
}

SamNormal SamContactGetNormal(SamContact c)
{
  return c->normal;
}

SamTangential SamContactGetTangential(SamContact c)
{
  return c->tangential;
}

/* ---- states ---- */

PetscErrorCode SamContactSetState(SamContact c, SamState state, PetscBool gap_is_current)
{
  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  PetscCall(SamStateCopy(state, c->state));
  SamStepCacheForget(c->cache);
  PetscCall(SamContactRefresh(c));
  PetscCall(SamContactReject(c));
  PetscCall(SamProblemGetRevision(c->problem, &c->revision[SAM_COMMITTED]));
  if (!gap_is_current) c->revision[SAM_COMMITTED] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactTakeOver(SamContact c, SamContact from)
{
  PetscBool current;

  PetscFunctionBegin;
  PetscCall(SamContactDeclare(from));
  PetscCall(SamContactIsGapCurrent(from, &current));
  PetscCall(SamContactSetState(c, from->state, current));
  PetscCall(SamStepCacheCopy(from->cache, c->cache));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamStepCache SamContactGetCache(SamContact c)
{
  return c->cache;
}

PetscReal SamContactCycleMemory(SamGrid grid)
{
  return SamStepCacheUsual(grid);
}

PetscErrorCode SamContactReset(SamContact c)
{
  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  PetscCall(SamStateReset(c->state));
  SamStepCacheForget(c->cache);
  PetscCall(SamContactRefresh(c));
  PetscCall(SamContactReject(c));
  c->revision[SAM_COMMITTED] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- by name ---- */

PetscErrorCode SamContactHasField(SamContact c, const char name[], PetscBool *has)
{
  PetscInt k;

  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  k    = SamStateFindResult(c->state, name);
  *has = k >= 0 && SamStateResultOf(c->state, k)->kind <= SAM_FIELD_STATE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetField(SamContact c, const char name[], Vec field)
{
  const SamSolution *s;
  const double      *from;
  double            *to;
  Vec                holder;
  PetscInt           component, cells;
  PetscBool          has = PETSC_FALSE;

  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  SamValidPointer(name, 2);
  SamValidVec(field, 3);
  SamValidVecOn(c->grid->comm, 1, field, 3);
  PetscCall(SamGridCheckVec(c->grid, 1, field, name));
  PetscCall(SamContactHasField(c, name, &has));
  PetscCheck(has, c->grid->comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "Unknown field %s", name);
  PetscCall(SamContactGetSolution(c, &s)); /* computes the displacements */
  PetscCall(SamStateFindValues(c->state, SamStateFindResult(c->state, name), field, &holder, &component));
  if (holder == field) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetLocalSize(field, &cells));
  PetscCall(VecGetArrayRead(holder, &from));
  PetscCall(VecGetArrayWrite(field, &to));
  PetscCall(PetscArraycpy(to, from + component * cells, cells));
  PetscCall(VecRestoreArrayWrite(field, &to));
  PetscCall(VecRestoreArrayRead(holder, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamMotion SamContactGetMotion(SamContact c)
{
  return c->motion;
}

PetscErrorCode SamContactOfferCondition(SamContact c, const SamCondition *condition)
{
  SamState state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(c, &state));
  for (PetscInt k = 0; k < SamConditionsCount(c->conditions); k++) {
    const SamCondition *one = SamConditionsGet(c->conditions, k);

    if (!strcmp(one->group, condition->group)) PetscCall(SamStateOfferNumber(state, one->name, one->usual));
  }
  for (PetscInt n = 0; n < SAM_COMPONENTS && condition->change; n++)
    if (SamComponentNames[n].creep) PetscCall(SamStateOfferNumber(state, SamComponentNames[n].creep, NAN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetNumber(SamContact c, const char name[], PetscReal *value)
{
  PetscInt id;

  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  SamValidPointer(name, 2);
  SamValidPointer(value, 3);
  id = SamStateFindNumber(c->state, SamContactNameOf(c, name));
  PetscCheck(id >= 0, c->grid->comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "Unknown number %s", name);
  *value = *SamStateReadNumbers(c->state, id);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reports of the laws ---- */

PetscErrorCode SamContactPrintLaws(SamContact c, PetscViewer viewer)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(c->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    if (laws[k]->ops.view) PetscCall(laws[k]->ops.view(laws[k], c->state, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactAdvise(SamContact c, PetscInt *k, char text[], size_t size)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  text[0] = '\0';
  PetscCall(SamProblemGetLaws(c->problem, &count, &laws));
  for (; *k < count; (*k)++) {
    if (laws[*k]->ops.advise) PetscCall(laws[*k]->ops.advise(laws[*k], c->state, text, size));
    if (text[0]) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamLawType SamContactSummarize(SamContact c, PetscInt k, PetscInt step, PetscReal *weight, char text[], size_t size)
{
  const SamLaw *laws;
  PetscInt      count;

  text[0] = '\0';
  *weight = 0;
  (void)SamProblemGetLaws(c->problem, &count, &laws);
  if (k >= count) return NULL;
  if (laws[k]->ops.summarize) (*laws[k]->ops.summarize)(laws[k], c->state, step, weight, text, size);
  return laws[k]->type;
}

/* The class SamContact: its parts and settings, and what others ask of it. */
#include "contactimpl.h"

#define CYCLE_MEMORY 5e8 /* bytes: 240 steps of 512 x 512 cells, a third of them in contact */

/* ---- creation ---- */

PetscErrorCode SamContactCreate(SamProblem problem, SamContact *contact)
{
  SamContact c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  PetscCall(SamProblemReference(problem));
  c->problem         = problem;
  c->coupling        = PETSC_TRUE;
  c->warm            = PETSC_TRUE;
  c->edges           = PETSC_TRUE;
  c->coupling_rtol   = 1e-6;
  c->coupling_max_it = 100;
  c->cycle_memory    = CYCLE_MEMORY;
  PetscCall(SamProblemGetElasticity(problem, &c->elasticity));
  PetscCall(SamProblemGetGrid(problem, &c->grid));
  PetscCall(SamElasticityGetTraits(c->elasticity, &c->traits));
  PetscCall(SamNormalCreate(c->elasticity, &c->normal));
  PetscCall(SamTangentialCreate(c->elasticity, &c->tangential));
  PetscCall(SamStateCreate(c->grid, &c->state));
  PetscCall(SamRecallCreate(c->grid, &c->recall));
  SamRecallSetMemory(c->recall, c->cycle_memory);
  PetscCall(SamContactDeclare(c));
  PetscCall(SamContactView(c));
  c->revision[SAM_COMMITTED] = -1;
  *contact                   = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactDestroy(SamContact *contact)
{
  SamContact c = *contact;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamNormalDestroy(&c->normal));
  PetscCall(SamTangentialDestroy(&c->tangential));
  PetscCall(SamStateDestroy(&c->state));
  SamRecallDestroy(&c->recall);
  PetscCall(SamProblemDestroy(&c->problem));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- settings ---- */

PetscErrorCode SamContactSetOptionsPrefix(SamContact c, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(SamSetPrefix(c->prefix, prefix));
  PetscCall(SamSolverSetOptionsPrefix(SamNormalAsSolver(c->normal), prefix));
  PetscCall(SamSolverSetOptionsPrefix(SamTangentialAsSolver(c->tangential), prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetCoupling(SamContact c, PetscBool full, PetscReal rtol, PetscInt max_it)
{
  PetscFunctionBegin;
  PetscCheck(rtol == PETSC_DEFAULT || rtol > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coupling tolerance rtol = %g: expected a number > 0", (double)rtol);
  PetscCheck(max_it == PETSC_DEFAULT || max_it > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coupling passes max_it = %" PetscInt_FMT ": expected at least 1", max_it);
  c->coupling = full;
  if (rtol != PETSC_DEFAULT) c->coupling_rtol = rtol;
  if (max_it != PETSC_DEFAULT) c->coupling_max_it = max_it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetCoupling(SamContact c, PetscBool *full)
{
  PetscFunctionBegin;
  *full = c->coupling;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetWarmStart(SamContact c, PetscBool warm)
{
  PetscFunctionBegin;
  c->warm = warm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetCycleMemory(SamContact c, PetscReal bytes)
{
  PetscFunctionBegin;
  PetscCheck(bytes >= 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "cycle memory = %g: expected a number >= 0",
             (double)bytes);
  c->cycle_memory = bytes;
  SamRecallSetMemory(c->recall, bytes);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactAllowEdge(SamContact c, PetscBool allow)
{
  PetscFunctionBegin;
  c->allow_edge = allow;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetSpots(SamContact c, PetscBool count)
{
  PetscFunctionBegin;
  c->spots = count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetSpots(SamContact c, PetscBool *count)
{
  PetscFunctionBegin;
  *count = c->spots;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetEdges(SamContact c, PetscBool reconstruct)
{
  PetscFunctionBegin;
  c->edges = reconstruct;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetEdges(SamContact c, PetscBool *reconstruct)
{
  PetscFunctionBegin;
  *reconstruct = c->edges;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetFromOptions(SamContact c)
{
  static const char *const coupling_words[] = {"none", "full", NULL}, *const edge_words[] = {"none", "reconstruct",
                                                                                             "deferred", NULL};
  const SamOptions from     = {c->grid->comm, c->prefix};
  PetscInt         coupling = c->coupling ? 1 : 0, max_it = c->coupling_max_it;
  PetscReal        rtol  = c->coupling_rtol, memory = c->cycle_memory;
  PetscInt         edges = c->edges;
  PetscBool        warm = c->warm, edge = c->allow_edge, spots = c->spots;

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(&from, "Contact"));
  PetscCall(SamOptionsEnum(&from, "coupling", "normal-tangential coupling of dissimilar materials: full or none",
                           coupling_words, &coupling, NULL));
  PetscCall(SamOptionsReal(&from, "coupling_rtol", "relative change of p and q between passes", SAM_RANGE_POSITIVE,
                           &rtol, NULL));
  PetscCall(SamOptionsInt(&from, "coupling_max_it", "most passes of the coupling", 1, &max_it, NULL));
  PetscCall(SamOptionsBool(&from, "coupling_monitor", "print the change after each pass", &c->coupling_monitor, NULL));
  PetscCall(
    SamOptionsBool(&from, "warm_start", "start each step from the one before, on the finest grid only", &warm, NULL));
  PetscCall(SamOptionsReal(&from, "cycle_memory",
                           "bytes for steps of a cycle, from which those of the next cycle start; 0: none",
                           SAM_RANGE_NONNEGATIVE, &memory, NULL));
  PetscCall(SamOptionsBool(&from, "allow_edge_contact", "contact at the grid's edge is a warning", &edge, NULL));
  PetscCall(SamOptionsEnum(&from, "edges", "reconstruct, deferred (correct the pressure), none (count cells)",
                           edge_words, &edges, NULL));
  PetscCall(
    SamOptionsBool(&from, "contact_spots", "number of spots of contact and mean gap of each step", &spots, NULL));
  PetscCall(SamOptionsBool(&from, "contact_check", "print the check of each step", &c->print_check, NULL));
  PetscCall(SamContactSetCoupling(c, coupling != 0, rtol, max_it));
  PetscCall(SamContactSetWarmStart(c, warm));
  PetscCall(SamContactSetCycleMemory(c, memory));
  PetscCall(SamContactAllowEdge(c, edge));
  PetscCall(SamContactSetSpots(c, spots));
  PetscCall(SamContactSetEdges(c, edges > 0));
  PetscCall(SamSolverSetFromOptions(SamNormalAsSolver(c->normal)));
  PetscCall(SamSolverSetFromOptions(SamTangentialAsSolver(c->tangential)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetProblem(SamContact c, SamProblem *problem)
{
  PetscFunctionBegin;
  *problem = c->problem;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetState(SamContact c, SamState *state)
{
  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  *state = c->state;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetGrid(SamContact c, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = c->grid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetNormal(SamContact c, SamNormal *normal)
{
  PetscFunctionBegin;
  *normal = c->normal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetTangential(SamContact c, SamTangential *tangential)
{
  PetscFunctionBegin;
  *tangential = c->tangential;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- states ---- */

PetscErrorCode SamContactSetState(SamContact c, SamState state, PetscBool gap_is_current)
{
  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  PetscCall(SamStateCopy(state, c->state));
  SamRecallForget(c->recall);
  PetscCall(SamContactView(c));
  PetscCall(SamContactReject(c));
  PetscCall(SamProblemGetRevision(c->problem, &c->revision[SAM_COMMITTED]));
  if (!gap_is_current) c->revision[SAM_COMMITTED] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactReset(SamContact c)
{
  PetscFunctionBegin;
  PetscCall(SamStateReset(c->state));
  SamRecallForget(c->recall);
  PetscCall(SamContactView(c));
  PetscCall(SamContactReject(c));
  c->revision[SAM_COMMITTED] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetSteps(SamContact c, PetscInt *steps)
{
  PetscFunctionBegin;
  *steps = (PetscInt)*SamStateNumbers(c->state, c->steps, SAM_COMMITTED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- by name ---- */

PetscErrorCode SamContactHasField(SamContact c, const char name[], PetscBool *has)
{
  PetscInt k;

  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  k    = SamStateFindResult(c->state, name);
  *has = k >= 0 && SamStateResultOf(c->state, k)->kind != SAM_FIELD_POINTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetField(SamContact c, const char name[], Vec field)
{
  const SamSolution *s;
  const double      *from;
  double            *to;
  Vec                holder;
  PetscInt           component, cells;
  PetscBool          has;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(c->grid, 1, field, name));
  PetscCall(SamContactHasField(c, name, &has));
  PetscCheck(has, c->grid->comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "Unknown field %s", name);
  PetscCall(SamContactGetSolution(c, &s)); /* makes the displacements */
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

PetscErrorCode SamContactGetNumber(SamContact c, const char name[], PetscReal *value)
{
  const PetscInt id = SamStateFindNumber(c->state, name);

  PetscFunctionBegin;
  PetscCheck(id >= 0, c->grid->comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "Unknown number %s", name);
  *value = *SamStateReadNumbers(c->state, id);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what laws say ---- */

PetscErrorCode SamContactViewLaws(SamContact c, PetscViewer viewer)
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

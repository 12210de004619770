/* The fields of a step that the tangent stiffness freezes, on the part of the grid that contains the contact. */
#include "stiffnessimpl.h"
#include <petsam/normal.h>
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <petsam/private/solutionimpl.h>

/*
  Largest resistance of a cell to a turn of the slip. A cell at the contact's edge with hardly any pressure slips far
  for its bound, and so would resist more; its traction is too small to matter.
*/
#define STIFFEST 1e3

static PetscErrorCode TakeField(SamWindow window, SamGrid grid, PetscInt components, Vec whole, Vec *field)
{
  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, components, field));
  if (window)
    PetscCall(SamWindowTake(window, whole, *field));
  else
    PetscCall(VecCopy(whole, *field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the overlap of the surfaces, as they were before the tried step, in cells at the limit of the pressure. */
static PetscErrorCode ComputeOverlap(SamProblem problem, SamState state, const SamSolution *s, Vec overlap)
{
  PetscReal     limit;
  const double *p;
  double       *g;
  Vec           separation;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamProblemGetPressureLimit(problem, &limit));
  PetscCall(SamSolutionCreateSeparation(problem, state, SAM_COMMITTED, &separation));
  PetscCall(SamSolutionComputeGap(problem, s, s->displacement_z, separation, overlap));
  PetscCall(SamSolutionDestroySeparation(problem, &separation));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArray(overlap, &g));
  for (PetscInt k = 0; k < grid->cells; k++) g[k] = p[k] >= SAM_SATURATED * limit && g[k] < 0 ? -g[k] : 0;
  PetscCall(VecRestoreArray(overlap, &g));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the derivatives of the bound, the slip and the overlap of the tried step, for a motion that continues the
   step. */
static PetscErrorCode CreateMotion(SamContact contact, const SamSolution *s, SamWindow window, SamGrid grid, Vec f[])
{
  SamBoundAt       at    = {.control = &s->control, .pressure = s->pressure};
  SamBound         bound = {NULL, NULL, NULL};
  Vec              field;
  const SamProblem problem = SamContactGetProblem(contact);
  const SamGrid    whole   = SamContactGetGrid(contact);

  PetscFunctionBegin;
  at.rolled = s->rolled;
  PetscCall(SamContactGetState(contact, &at.state));
  PetscCall(SamGridCreateVec(whole, 1, &at.slip));
  PetscCall(SamGridCreateVec(whole, 1, &field));
  PetscCall(SamContactComputeFriction(contact, at.slip, NULL, NULL));
  PetscCall(TakeField(window, grid, 1, at.slip, &f[SAM_FROZEN_PATH]));
  bound.by_pressure = field;
  if (SamProblemFollowsSlip(problem)) {
    PetscCall(SamGridCreateVec(whole, 1, &bound.value));
    PetscCall(SamGridCreateVec(whole, 1, &bound.by_slip));
  }
  PetscCall(SamProblemComputeBound(problem, &at, &bound));
  PetscCall(TakeField(window, grid, 1, field, &f[SAM_FROZEN_SLOPE]));
  if (bound.by_slip) PetscCall(TakeField(window, grid, 1, bound.by_slip, &f[SAM_FROZEN_RATE]));
  PetscCall(VecDestroy(&bound.value));
  PetscCall(VecDestroy(&bound.by_slip));
  PetscCall(ComputeOverlap(problem, at.state, s, field));
  PetscCall(TakeField(window, grid, 1, field, &f[SAM_FROZEN_OVERLAP]));
  PetscCall(VecDestroy(&field));
  PetscCall(VecDestroy(&at.slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFields(SamContact contact, SamStiffnessDirection direction, SamWindow window, SamGrid grid,
                                   Vec f[])
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(contact, &s));
  PetscCall(TakeField(window, grid, 1, s->pressure, &f[SAM_FROZEN_PRESSURE]));
  PetscCall(TakeField(window, grid, 1, s->bound, &f[SAM_FROZEN_BOUND]));
  PetscCall(TakeField(window, grid, 2, s->shear, &f[SAM_FROZEN_SHEAR]));
  if (direction == SAM_STIFFNESS_FORWARD) PetscCall(CreateMotion(contact, s, window, grid, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the step: without a tried step there must be a committed one, at which the motion reverses. */
static PetscErrorCode CheckStep(SamContact contact, SamStiffnessDirection direction)
{
  const SamGrid   grid      = SamContactGetGrid(contact);
  const PetscBool tried     = SamContactHasStep(contact, SAM_TRIED);
  const PetscBool committed = SamContactHasStep(contact, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCheck(tried || committed, grid->comm, PETSC_ERR_ORDER,
             "no step is tried or committed: try a step before its stiffness is computed");
  PetscCheck(tried || direction == SAM_STIFFNESS_REVERSAL, grid->comm, PETSC_ERR_ORDER,
             "the forward stiffness needs the slip of the step, which is not kept after the commit: compute it before, "
             "or compute the stiffness at the reversal");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacement (m) of body 1 relative to body 2 by a unit of a condition, on the whole grid; `rest`: the
   fields without conditions, of body 2 relative to body 1. */
static PetscErrorCode ComputeMotion(SamProblem problem, SamState state, const SamCondition *condition,
                                    const Vec rest[2], const Vec u[2])
{
  SamControl control = {.force = {PETSC_FALSE}};

  PetscFunctionBegin;
  SamControlSetCondition(&control, condition, 1);
  for (PetscInt d = 0; d < 2; d++) PetscCall(VecZeroEntries(u[d]));
  PetscCall(SamProblemDisplace(problem, state, &control, u[0], u[1], NULL, NULL));
  for (PetscInt d = 0; d < 2; d++) PetscCall(VecAYPX(u[d], -1, rest[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddMotions(SamContact contact, SamWindow window, PetscInt count,
                                 const SamCondition *const conditions[], SamFrozen *f)
{
  SamState         state;
  Vec              whole[2], part[2], rest[2];
  const SamControl none    = {.force = {PETSC_FALSE}};
  const SamProblem problem = SamContactGetProblem(contact);
  const SamGrid    grid    = SamContactGetGrid(contact);

  PetscFunctionBegin;
  if (!count) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetState(contact, &state));
  for (PetscInt d = 0; d < 2; d++) {
    PetscCall(SamGridCreateVec(grid, d + 1, &whole[d]));
    PetscCall(SamGridCreateVec(grid, d + 1, &rest[d]));
  }
  PetscCall(SamProblemDisplace(problem, state, &none, rest[0], rest[1], NULL, NULL));
  for (PetscInt k = 0; k < count; k++) {
    PetscCall(ComputeMotion(problem, state, conditions[k], rest, whole));
    for (PetscInt d = 0; d < 2; d++) PetscCall(TakeField(window, f->grid, d + 1, whole[d], &part[d]));
    PetscCall(SamFrozenAddMotion(f, part[0], part[1]));
    for (PetscInt d = 0; d < 2; d++) PetscCall(VecDestroy(&part[d]));
  }
  for (PetscInt d = 0; d < 2; d++) {
    PetscCall(VecDestroy(&whole[d]));
    PetscCall(VecDestroy(&rest[d]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the response of laws ---- */

/* Adds the displacements by all laws that follow the tractions, on the whole grid. */
static PetscErrorCode AddTangents(SamContact contact, const Vec v[4])
{
  const SamLaw *laws;
  SamState      state;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(contact, &state));
  PetscCall(SamProblemGetLaws(SamContactGetProblem(contact), &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    if (laws[k]->ops.tangent) PetscCall(laws[k]->ops.tangent(laws[k], state, v[0], v[1], v[2], v[3]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Respond(void *context, Vec p, Vec q, Vec u_z, Vec u_t)
{
  const SamResponse *r    = (const SamResponse *)context;
  const Vec          in[] = {p, q}, out[] = {u_z, u_t};

  PetscFunctionBegin;
  if (!r->window) {
    PetscCall(AddTangents(r->contact, (const Vec[4]){p, q, u_z, u_t}));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int d = 0; d < 2; d++) {
    PetscCall(SamWindowPut(r->window, in[d], r->whole[d]));
    PetscCall(VecZeroEntries(r->whole[2 + d]));
  }
  PetscCall(AddTangents(r->contact, r->whole));
  for (int d = 0; d < 2; d++) {
    PetscCall(SamWindowTake(r->window, r->whole[2 + d], r->u[d]));
    PetscCall(VecAXPY(out[d], 1, r->u[d]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns true if a law's offset follows the tractions. */
static PetscErrorCode HasTangent(SamContact contact, PetscBool *has)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  *has = PETSC_FALSE;
  PetscCall(SamProblemGetLaws(SamContactGetProblem(contact), &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    if (laws[k]->ops.tangent) *has = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetResponse(SamContact contact, SamWindow window, SamResponse *r, SamFrozen *f)
{
  PetscFunctionBegin;
  *r         = (SamResponse){.contact = contact, .window = window};
  f->respond = Respond;
  f->context = r;
  for (int k = 0; window && k < 4; k++)
    PetscCall(SamGridCreateVec(SamContactGetGrid(contact), k % 2 + 1, &r->whole[k]));
  for (int d = 0; window && d < 2; d++) PetscCall(SamGridCreateVec(f->grid, d + 1, &r->u[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStiffnessThaw(SamResponse *r, SamFrozen *f)
{
  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) PetscCall(VecDestroy(&r->whole[k]));
  for (int d = 0; d < 2; d++) PetscCall(VecDestroy(&r->u[d]));
  PetscCall(SamFrozenDestroy(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all ---- */

PetscErrorCode SamStiffnessFreeze(SamContact contact, SamStiffnessDirection direction, PetscInt count,
                                  const SamCondition *const conditions[], SamResponse *response, SamFrozen *f)
{
  const SamSolution  *s;
  SamWindow           window;
  SamElasticity       part;
  PetscInt            first[2], n[2];
  PetscBool           friction, coupled, follows;
  Vec                 fields[SAM_FROZEN_FIELDS] = {NULL};
  const SamProblem    problem                   = SamContactGetProblem(contact);
  const SamElasticity e                         = SamProblemGetElasticity(problem);
  const SamGrid       whole                     = SamContactGetGrid(contact);

  PetscFunctionBegin;
  PetscCall(CheckStep(contact, direction));
  PetscCall(SamProblemHasFriction(problem, &friction));
  coupled = SamElasticityGetTraits(e).coupled && SamContactGetSettings(contact).coupling && friction;
  PetscCall(SamContactGetSolution(contact, &s));
  PetscCall(SamGridGetSupport(whole, s->pressure, PETSC_FALSE, first, n));
  PetscCall(SamElasticityChoosePart(e, first, n, PETSC_TRUE, &window, &part));
  PetscCall(CreateFields(contact, direction, window, window ? SamWindowGetGrid(window) : whole, fields));
  PetscCall(HasTangent(contact, &follows));
  PetscCall(SamFrozenCreate(window ? part : e, fields, coupled || count || follows ? PETSC_TRUE : PETSC_FALSE, STIFFEST,
                            SAM_FROZEN_STILL, f));
  if (follows) PetscCall(SetResponse(contact, window, response, f));
  PetscCall(AddMotions(contact, window, count, conditions, f));
  for (int k = 0; k < SAM_FROZEN_FIELDS; k++) PetscCall(VecDestroy(&fields[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

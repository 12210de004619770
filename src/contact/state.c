/* Solutions and states: their fields, and getting and setting the committed state. */
#include "contactimpl.h"

/* ---- components ---- */

void SamBalanceStore(const SamBalance *balance, PetscReal load[], PetscReal rigid[])
{
  for (PetscInt k = 0; k < 3; k++) {
    load[SamComponentsOf[balance->kind][k]]  = balance->load[k];
    rigid[SamComponentsOf[balance->kind][k]] = balance->rigid[k];
  }
}

PetscBool SamControlIsSame(const SamControl *a, const SamControl *b, SamBalanceKind kind)
{
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt c = SamComponentsOf[kind][k];

    if (a->force[c] != b->force[c] || a->value[c] != b->value[c]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* ---- fields ---- */

PetscErrorCode SamSolutionCreate(SamGrid grid, SamSolution *s)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  PetscCall(SamControlInitialize(&s->control));
  PetscCall(SamGridCreateVec(grid, 1, &s->pressure));
  PetscCall(SamGridCreateVec(grid, 1, &s->bound));
  PetscCall(SamGridCreateVec(grid, 2, &s->shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionCreateDisplacements(SamGrid grid, SamSolution *s)
{
  PetscFunctionBegin;
  if (!s->displacement_z) PetscCall(SamGridCreateVec(grid, 1, &s->displacement_z));
  if (!s->displacement_t) PetscCall(SamGridCreateVec(grid, 2, &s->displacement_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionCreateCorrection(SamGrid grid, SamSolution *s)
{
  PetscFunctionBegin;
  if (!s->correction) PetscCall(SamGridCreateVec(grid, 1, &s->correction));
  if (!s->rim) PetscCall(SamGridCreateVec(grid, 1, &s->rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionCopyCorrection(SamGrid grid, const SamSolution *from, SamSolution *to)
{
  PetscFunctionBegin;
  to->passes = from->passes;
  if (!from->passes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolutionCreateCorrection(grid, to));
  PetscCall(VecCopy(from->correction, to->correction));
  PetscCall(VecCopy(from->rim, to->rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearCorrectionCreate(SamGrid grid, SamShearCorrection *c)
{
  PetscFunctionBegin;
  if (!c->displacement) {
    PetscCall(SamGridCreateVec(grid, 2, &c->displacement));
    PetscCall(SamGridCreateVec(grid, 1, &c->rim));
    PetscCall(SamGridCreateVec(grid, SAM_SHEAR_SLOPES, &c->within.slopes));
    PetscCall(SamGridCreateVec(grid, SAM_SHEAR_TERMS, &c->within.terms));
    PetscCall(SamGridCreateVec(grid, SAM_SHEAR_REFERENCE, &c->within.reference));
    PetscCall(SamGridCreateVec(grid, 2, &c->plain_reference));
  } else {
    PetscCall(SamVecZero(c->displacement));
    PetscCall(SamVecZero(c->rim));
    PetscCall(SamVecZero(c->within.slopes));
    PetscCall(SamVecZero(c->within.terms));
    PetscCall(SamVecZero(c->within.reference));
    PetscCall(SamVecZero(c->plain_reference));
  }
  c->has           = PETSC_FALSE;
  c->passes        = 0;
  c->slack         = SAM_SLACK_NONE;
  c->within.refers = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearCorrectionCopy(SamGrid grid, const SamShearCorrection *from, SamShearCorrection *to)
{
  PetscFunctionBegin;
  to->has = to->within.refers = PETSC_FALSE;
  if (from->has || from->within.refers || to->displacement) PetscCall(SamShearCorrectionCreate(grid, to));
  if (!from->has && !from->within.refers) PetscFunctionReturn(PETSC_SUCCESS);
  to->has = from->has;
  PetscCall(SamVecCopyNonzero(from->displacement, to->displacement));
  PetscCall(SamVecCopyNonzero(from->rim, to->rim));
  PetscCall(SamVecCopyNonzero(from->within.slopes, to->within.slopes));
  PetscCall(SamVecCopyNonzero(from->within.terms, to->within.terms));
  PetscCall(SamVecCopyNonzero(from->within.reference, to->within.reference));
  PetscCall(SamVecCopyNonzero(from->plain_reference, to->plain_reference));
  to->within.refers = from->within.refers;
  to->slack         = from->slack;
  to->passes        = from->passes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearCorrectionDestroy(SamShearCorrection *c)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&c->displacement));
  PetscCall(VecDestroy(&c->rim));
  PetscCall(VecDestroy(&c->within.slopes));
  PetscCall(VecDestroy(&c->within.terms));
  PetscCall(VecDestroy(&c->within.reference));
  PetscCall(VecDestroy(&c->plain_reference));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the plastic depth, where there is one. */
static PetscErrorCode CopyPlastic(SamGrid grid, const SamSolution *from, SamSolution *to)
{
  PetscFunctionBegin;
  if (!from->plastic) PetscCall(VecDestroy(&to->plastic));
  if (from->plastic && !to->plastic) PetscCall(SamGridCreateVec(grid, 1, &to->plastic));
  if (from->plastic) PetscCall(VecCopy(from->plastic, to->plastic));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionDestroy(SamSolution *s)
{
  PetscFunctionBegin;
  PetscCall(SamShearCorrectionDestroy(&s->sheared));
  PetscCall(VecDestroy(&s->correction));
  PetscCall(VecDestroy(&s->rim));
  PetscCall(VecDestroy(&s->plastic));
  PetscCall(VecDestroy(&s->pressure));
  PetscCall(VecDestroy(&s->bound));
  PetscCall(VecDestroy(&s->shear));
  PetscCall(VecDestroy(&s->displacement_z));
  PetscCall(VecDestroy(&s->displacement_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- states ---- */

PetscErrorCode SamContactGetSolution(SamContact c, const SamSolution **solution)
{
  SamSolution *s = c->has_tried ? &c->tried.solution : &c->committed.solution;

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateDisplacements(c->grid, s));
  *solution = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactIsGapCurrent(SamContact c, PetscBool *current)
{
  PetscObjectState revision;
  double           changed;

  PetscFunctionBegin;
  PetscCall(SamProblemGetGapRevision(c->problem, &revision));
  changed = c->committed.gap_revision == revision ? 0 : 1;
  PetscCall(SamMax(c->grid->comm, 1, &changed)); /* each rank counts the changes of its own part */
  *current = changed == 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetState(SamContact c, SamContactState *s)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  PetscCall(SamSolutionCreateDisplacements(c->grid, &c->committed.solution));
  s->steps = c->steps;
  s->now   = c->committed.solution;
  s->plain = c->committed.plain;
  if (c->steps > 1) s->before = c->before;
  PetscCall(PetscArraycpy(s->sums, c->sums, SAM_CONTACT_SUMS));
  PetscCall(PetscArraycpy(s->window_first, c->committed.window_first, 2));
  PetscCall(PetscArraycpy(s->window_n, c->committed.window_n, 2));
  PetscCall(SamContactIsGapCurrent(c, &s->gap_is_current));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies a solution into one that keeps its own vectors; displacements only where `to` has them. */
static PetscErrorCode CopySolution(SamGrid grid, const SamSolution *from, SamSolution *to)
{
  SamSolution own = *to;

  PetscFunctionBegin;
  *to                = *from;
  to->pressure       = own.pressure;
  to->bound          = own.bound;
  to->shear          = own.shear;
  to->displacement_z = own.displacement_z;
  to->displacement_t = own.displacement_t;
  to->correction     = own.correction;
  to->rim            = own.rim;
  to->sheared        = own.sheared;
  PetscCall(SamSolutionCopyCorrection(grid, from, to));
  PetscCall(SamShearCorrectionCopy(grid, &from->sheared, &to->sheared));
  to->plastic = own.plastic;
  PetscCall(CopyPlastic(grid, from, to));
  PetscCall(SamVecCopyNonzero(from->pressure, to->pressure));
  PetscCall(SamVecCopyNonzero(from->bound, to->bound));
  PetscCall(SamVecCopyNonzero(from->shear, to->shear));
  if (to->displacement_z && from->displacement_z)
    PetscCall(SamVecCopyNonzero(from->displacement_z, to->displacement_z));
  if (to->displacement_t) PetscCall(SamVecCopyNonzero(from->displacement_t, to->displacement_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckTractions(SamGrid grid, const SamSolution *s)
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(grid, 1, s->pressure, "The state's pressure"));
  PetscCall(SamGridCheckVec(grid, 1, s->bound, "The state's bound"));
  PetscCall(SamGridCheckVec(grid, 2, s->shear, "The state's shear"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetState(SamContact c, const SamContactState *s)
{
  PetscObjectState revision;

  PetscFunctionBegin;
  PetscCheck(s->steps >= 0 && s->now.pressure && s->now.bound && s->now.shear && s->now.displacement_z &&
               s->now.displacement_t && (s->steps < 2 || (s->before.pressure && s->before.bound && s->before.shear)),
             c->grid->comm, PETSC_ERR_ARG_INCOMP,
             "The state is incomplete: it lacks tractions, displacements, or the tractions one step back");
  PetscCall(CheckTractions(c->grid, &s->now));
  if (s->steps > 1) PetscCall(CheckTractions(c->grid, &s->before));
  if (s->now.sheared.has) PetscCall(CheckTractions(c->grid, &s->plain));
  PetscCall(SamGridCheckVec(c->grid, 1, s->now.displacement_z, "The state's normal displacement"));
  PetscCall(SamGridCheckVec(c->grid, 2, s->now.displacement_t, "The state's tangential displacement"));
  if (s->now.plastic) PetscCall(SamGridCheckVec(c->grid, 1, s->now.plastic, "The state's plastic depth"));
  PetscCall(SamContactReject(c));
  PetscCall(SamSolutionCreateDisplacements(c->grid, &c->committed.solution));
  PetscCall(CopySolution(c->grid, &s->now, &c->committed.solution));
  if (s->now.sheared.has) {
    if (!c->committed.plain.pressure) PetscCall(SamSolutionCreate(c->grid, &c->committed.plain));
    PetscCall(SamSolutionCreateDisplacements(c->grid, &c->committed.plain));
    PetscCall(CopySolution(c->grid, &s->plain, &c->committed.plain));
  }
  if (s->steps > 1) PetscCall(CopySolution(c->grid, &s->before, &c->before));
  PetscCall(SamContactSetSums(c, s->sums));
  c->steps = s->steps;
  PetscCall(PetscArraycpy(c->committed.window_first, s->window_first, 2));
  PetscCall(PetscArraycpy(c->committed.window_n, s->window_n, 2));
  PetscCall(SamProblemGetGapRevision(c->problem, &revision));
  c->committed.gap_revision = s->gap_is_current ? revision : -1; /* -1: solved with another gap */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edges of contact and stick of a solution, and tractions at the centres of cells. */
#include "contactimpl.h"
#include <math.h>

/*
  What vanishes at the edges like the distance, of this rank's cells: of the contact p^2, of the stick zone the square
  of what the pressure exceeds |q|/mu by.
*/
static PetscErrorCode FillSquares(const SamSolution *s, SamContactEdge which, Vec w)
{
  const PetscBool stick = which == SAM_CONTACT_EDGE_STICK;
  const double   *p, *b, *q;
  double         *square;
  PetscInt        cells;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(w, &cells));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->bound, &b));
  PetscCall(VecGetArrayRead(s->shear, &q));
  PetscCall(VecGetArrayWrite(w, &square));
  for (PetscInt k = 0; k < cells; k++) {
    const double slack = stick && b[k] > 0 ? p[k] * (1 - hypot(q[k], q[k + cells]) / b[k]) : p[k];

    square[k] = 0;
    if (p[k] > 0 && (!stick || SamStateOf(p[k], q[k], q[k + cells], b[k]) == SAM_STATE_STICK))
      square[k] = slack * slack;
  }
  PetscCall(VecRestoreArrayWrite(w, &square));
  PetscCall(VecRestoreArrayRead(s->shear, &q));
  PetscCall(VecRestoreArrayRead(s->bound, &b));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edge of a plain solution. */
static PetscErrorCode Reconstruct(SamContact c, const SamSolution *s, SamContactEdge which, Vec point, SamEdge *edge)
{
  Vec w;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(c->grid, 1, &w));
  PetscCall(FillSquares(s, which, w));
  PetscCall(SamEdgeReconstruct(c->grid, w, point, edge));
  PetscCall(VecDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetProfile(SamContact c, SamProfile *profile)
{
  PetscFunctionBegin;
  if (!c->profile) PetscCall(SamProfileCreate(c->elasticity, &c->profile));
  *profile = c->profile;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetShearProfile(SamContact c, SamShearProfile *profile)
{
  PetscFunctionBegin;
  if (!c->shear_profile) PetscCall(SamShearProfileCreate(c->elasticity, &c->shear_profile));
  *profile = c->shear_profile;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edge of contact of a solution that has been corrected for it. */
static PetscErrorCode FindCorrected(SamContact c, const SamSolution *s, Vec point, SamEdge *edge)
{
  SamProfile profile = NULL;
  PetscBool  found;

  PetscFunctionBegin;
  PetscCall(SamContactGetProfile(c, &profile));
  PetscCall(SamProfileMatch(profile, s->pressure, s->rim, &found));
  PetscCall(SamProfileGetEdge(profile, point, edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The square of a slack (Pa2) becomes that of the slack over mu. */
static PetscErrorCode DivideByFriction(const SamSolution *s, Vec square)
{
  const double *p, *b;
  double       *value;
  PetscInt      n;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(square, &n));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->bound, &b));
  PetscCall(VecGetArray(square, &value));
  for (PetscInt k = 0; k < n; k++) value[k] *= b[k] > 0 ? p[k] * p[k] / (b[k] * b[k]) : 0;
  PetscCall(VecRestoreArray(square, &value));
  PetscCall(VecRestoreArrayRead(s->bound, &b));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the profiles of a solution whose shear is corrected; that of the slack, NULL where the stick zone has none. */
static PetscErrorCode SetShear(SamContact c, const SamSolution *s, Vec slips, SamShearProfile *shear, SamProfile *slack)
{
  const SamShearFields fields = {s->pressure, s->bound, s->shear, slips, s->sheared.rim};
  PetscBool            found;
  SamProfile           profile = NULL;
  Vec                  mean;

  PetscFunctionBegin;
  PetscCall(SamSolutionFindSlips(s, slips));
  PetscCall(SamContactGetShearProfile(c, shear));
  PetscCall(SamShearProfileSet(*shear, &fields));
  *slack = NULL;
  if (s->sheared.slack == SAM_SLACK_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamShearProfileFindSlack(*shear, s->sheared.slack, s->sheared.within.reference, &mean, &profile));
  PetscCall(SamProfileMatch(profile, mean, s->sheared.rim, &found));
  if (found) *slack = profile;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where no edge of stick is known: that of the contact if nothing slips, else that of the plain solution. */
static PetscErrorCode FindPlainStick(SamContact c, const SamSolution *s, Vec slips, Vec point, SamEdge *edge)
{
  const SamSolution *plain = s == &c->committed.solution ? &c->committed.plain : &c->tried.plain;
  PetscReal          most;

  PetscFunctionBegin;
  PetscCall(VecMax(slips, NULL, &most));
  if (most <= 0)
    PetscCall(FindCorrected(c, s, point, edge));
  else
    PetscCall(Reconstruct(c, plain, SAM_CONTACT_EDGE_STICK, point, edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edge of stick of a solution whose shear is corrected. */
static PetscErrorCode FindCorrectedStick(SamContact c, const SamSolution *s, Vec point, SamEdge *edge)
{
  SamShearProfile shear;
  SamProfile      slack = NULL;
  Vec             slips;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(c->grid, 1, &slips));
  PetscCall(SetShear(c, s, slips, &shear, &slack));
  if (slack) {
    PetscCall(SamProfileGetEdge(slack, point, edge));
    if (point) PetscCall(DivideByFriction(s, point));
  } else {
    PetscCall(FindPlainStick(c, s, slips, point, edge));
  }
  PetscCall(VecDestroy(&slips));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactFindEdge(SamContact c, SamContactEdge which, Vec point, SamEdge *edge)
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c, &s));
  if (which == SAM_CONTACT_EDGE_CONTACT && s->passes)
    PetscCall(FindCorrected(c, s, point, edge));
  else if (which == SAM_CONTACT_EDGE_STICK && s->sheared.has)
    PetscCall(FindCorrectedStick(c, s, point, edge));
  else
    PetscCall(Reconstruct(c, s, which, point, edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- at the centres of cells ---- */

/* The root of what vanishes at an edge, at the cells' centres. */
static PetscErrorCode ComputeRoots(SamContact c, SamContactEdge which, Vec root)
{
  SamEdge edge;
  double *value;

  PetscFunctionBegin;
  PetscCall(SamContactFindEdge(c, which, root, &edge));
  PetscCall(SamEdgeDestroy(&edge));
  PetscCall(VecGetArray(root, &value));
  for (PetscInt k = 0; k < c->grid->cells; k++) value[k] = value[k] > 0 ? sqrt(value[k]) : 0;
  PetscCall(VecRestoreArray(root, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactComputePressureCenter(SamContact c, Vec pressure)
{
  PetscFunctionBegin;
  PetscCall(ComputeRoots(c, SAM_CONTACT_EDGE_CONTACT, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a solution whose shear is corrected: what that does within cells is found anew, from the last shear. */
static PetscErrorCode ComputeCorrectedShear(SamContact c, const SamSolution *s, PetscInt component, Vec value)
{
  const SamShearBefore before   = {s->shear, &s->sheared.within, PETSC_FALSE};
  SamShearCorrection   now      = {.has = PETSC_FALSE};
  SamProfile           pressure = NULL, slack = NULL;
  SamShearProfile      shear = NULL;
  PetscBool            found;
  Vec                  slips;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(c->grid, 1, &slips));
  PetscCall(SetShear(c, s, slips, &shear, &slack));
  PetscCall(SamContactGetProfile(c, &pressure));
  PetscCall(SamProfileMatch(pressure, s->pressure, s->rim, &found));
  PetscCall(SamShearCorrectionCreate(c->grid, &now));
  PetscCall(SamVecCopyNonzero(s->sheared.within.reference, now.within.reference));
  PetscCall(SamShearProfileFind(shear, found ? pressure : NULL, slack ? s->sheared.slack : SAM_SLACK_NONE, &before,
                                &now.within));
  PetscCall(SamShearProfileComputeCenter(shear, &now.within, component, value));
  PetscCall(SamShearCorrectionDestroy(&now));
  PetscCall(VecDestroy(&slips));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shear keeps its direction; its size is mu times what the pressure exceeds the slack by, both at the centre. */
PetscErrorCode SamContactComputeShearCenter(SamContact c, PetscInt component, Vec shear)
{
  const SamSolution *s;
  const double      *p, *b, *q, *at;
  double            *value;
  Vec                pressure;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c, &s));
  if (s->sheared.has) {
    PetscCall(ComputeCorrectedShear(c, s, component, shear));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecDuplicate(shear, &pressure));
  PetscCall(ComputeRoots(c, SAM_CONTACT_EDGE_CONTACT, pressure));
  PetscCall(ComputeRoots(c, SAM_CONTACT_EDGE_STICK, shear));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(s->bound, &b));
  PetscCall(VecGetArrayRead(s->shear, &q));
  PetscCall(VecGetArrayRead(pressure, &at));
  PetscCall(VecGetArray(shear, &value));
  for (PetscInt k = 0; k < c->grid->cells; k++) {
    const double size = hypot(q[k], q[k + c->grid->cells]);

    value[k] = size > 0 ? PetscMax(at[k] - value[k], 0) * b[k] / p[k] * q[k + component * c->grid->cells] / size : 0;
  }
  PetscCall(VecRestoreArray(shear, &value));
  PetscCall(VecRestoreArrayRead(pressure, &at));
  PetscCall(VecRestoreArrayRead(s->shear, &q));
  PetscCall(VecRestoreArrayRead(s->bound, &b));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(VecDestroy(&pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

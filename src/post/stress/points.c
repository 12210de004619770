/*
  The points of a body whose surface slides past the other one (laws/slide.c): the cells go with body 1, and under the
  cell x lies the point x + D of body 2. All results of body 2 are at its own points, those under the cells at D = 0, so
  that the steps of a cycle are the states of one point. Where the bodies roll that is so of body 1, too.

  The tractions of a step are moved to these points before anything is computed from them. Interpolating the tractions
  or the stresses is equivalent, as both are sums whose weights do not depend on the place. But the stresses of moved
  tractions are known at all points, while moved stresses would lack the values beyond the grid.
*/
#include "evaluationimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/pressed.h>
#include <petsam/private/lawimpl.h>

PetscErrorCode SamPointsSetUp(SamEvaluation e)
{
  PetscBool moves = e->body == 2 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  if (!e->source.slides) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(2 * (e->source.steps + 1), &e->slide));
  for (PetscInt step = e->source.before ? -1 : 0; step < e->source.steps; step++)
    for (int axis = e->passing ? 1 : 0; axis < 2; axis++) { /* points that travel along x do so at any place */
      double *const at = &e->slide[2 * (step + 1) + axis], rolled;

      if (e->body == 2)
        PetscCall((*e->source.number)(e->source.context, step, (SamStepNumber)(SAM_STEP_SLIDE_X + axis), at));
      PetscCall((*e->source.number)(e->source.context, step, (SamStepNumber)(SAM_STEP_ROLLED_X + axis), &rolled));
      *at += rolled;
      moves = moves || *at != 0;
    }
  if (!moves) PetscCall(PetscFree(e->slide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PetscReal *SamPointsSlide(SamEvaluation e, PetscInt step)
{
  const PetscReal *const slide = e->slide ? &e->slide[2 * (step + 1)] : NULL;

  return slide && (slide[0] != 0 || slide[1] != 0) ? slide : NULL;
}

PetscErrorCode SamPointsMove(SamEvaluation e, PetscInt step, double field[])
{
  const PetscReal *const slide = SamPointsSlide(e, step);
  Vec                    from, to;

  PetscFunctionBegin;
  if (!slide) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(e->grid, 1, &from));
  PetscCall(SamGridCreateVec(e->grid, 1, &to));
  PetscCall(VecPlaceArray(to, field));
  PetscCall(VecCopy(to, from));
  PetscCall(SamFramesWrite(e->source.bodies, slide, from, to));
  PetscCall(VecResetArray(to));
  PetscCall(VecDestroy(&from));
  PetscCall(VecDestroy(&to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPointsCheck(SamEvaluation e, PetscInt step, const double pressure[])
{
  const PetscReal *const slide = SamPointsSlide(e, step);
  const SamGrid          g     = e->grid;
  PetscInt               low[2], high[2];
  PetscReal              beyond = 0;

  PetscFunctionBegin;
  if (!slide) PetscFunctionReturn(PETSC_SUCCESS);
  SamGridEntering(g, slide, low, high);
  for (PetscInt k = 0; k < g->cells; k++) {
    const PetscInt i = k % g->nx, j = g->row_start + k / g->nx;

    if (SamIsPressed(pressure[k]) && (i < low[0] || i >= g->nx - high[0] || j < low[1] || j >= g->ny - high[1]))
      beyond = 1;
  }
  PetscCall(SamMax(g->comm, 1, &beyond));
  PetscCheck(beyond == 0, e->comm, SAM_ERR_USER,
             "-body %d: where its points have moved by %.6g m, %.6g m the contact is over points beyond the border of "
             "the grid: simulate it on a grid that holds contact and path, or give %s-passing",
             (int)e->body, (double)slide[0], (double)slide[1], e->body == 2 ? "-body 1, or " : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

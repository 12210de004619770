/*
  The width of a contact in cells, and whether these are so few that nothing but the given loads is known.

  A closed-form solution holds even where the grid does not resolve the contact; else the width is that of the contact
  that was found.
*/
#include "adviceimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/gap.h>
#include <petsam/private/grid.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

PetscErrorCode SamAdviceMeasureZones(const SamSetup *s, SamExtent *extent)
{
  const PetscBool    wrap = SamElasticityGetTraits(s->elasticity).periodic;
  const SamSolution *solution;
  PetscReal          across;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(s->contact, &solution));
  PetscCall(SamGridMeasureZones(s->grid, solution->pressure, SAM_ADVICE_STRAY, wrap, &extent->across));
  PetscCall(SamGridMeasureZones(s->grid, solution->pressure, 0.5, wrap, &extent->half_across));
  PetscCall(SamGridCountZones(s->grid, solution->pressure, wrap, &extent->zones));
  PetscCall(SamContactGetNumber(s->contact, "contact_half_x", &extent->half[0]));
  PetscCall(SamContactGetNumber(s->contact, "contact_half_y", &extent->half[1]));
  if (SamGridIsRow(s->grid)) extent->half[1] = 0;
  /* A row in contact from border to border has no width along x. */
  across        = SamGridIsRow(s->grid) && extent->zones == 1 ? 2 * extent->half[0] / s->grid->dx : extent->across;
  extent->whole = across > (PetscReal)s->grid->fewest - 0.5 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceEstimateContact(const SamSetup *s, PetscBool force, PetscReal value, PetscReal half[2],
                                        PetscBool *known)
{
  PetscFunctionBegin;
  half[1] = 0;
  if (SamGridIsRow(s->grid))
    PetscCall(SamGapEstimateLine(s->gap, force ? value / SamPairModulus(s->pair) : 0, &half[0], known));
  else
    PetscCall(SamGapEstimateContact(s->gap, force, force ? value / SamPairModulus(s->pair) : value, half, known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceEstimate(const SamSetup *s, PetscBool force, PetscReal value, PetscReal half[2],
                                 PetscBool *known)
{
  PetscFunctionBegin;
  PetscCall(SamAdviceEstimateContact(s, force, value, half, known));
  for (int k = 0; k < s->grid->axes; k++)
    if (!isfinite(half[k]) || half[k] <= 0 || !SamPairIsUniform(s->pair)) *known = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds the half widths and cells across: by the closed-form solution if it describes this contact, which is not so
  after wear, for example; otherwise from the contact that was found.
*/
PetscErrorCode SamAdviceGetWidths(SamAdvice *a)
{
  const SamSetup   *s       = a->setup;
  const SamControl *control = &a->step->control;
  const PetscReal   cell[2] = {s->grid->dx, s->grid->dy};
  PetscReal         closed[2], cells = INFINITY;
  PetscBool         known;

  PetscFunctionBegin;
  PetscCall(SamAdviceEstimate(s, control->force[SAM_COMPONENT_N], control->value[SAM_COMPONENT_N], closed, &known));
  for (PetscInt k = 0; k < s->grid->axes; k++) cells = PetscMin(cells, 2 * closed[k] / cell[k]);
  known     = known && fabs(cells - a->extent.across) <= SAM_ADVICE_SAME;
  a->across = known ? cells : a->extent.across;
  a->closed = known;
  for (int k = 0; k < 2; k++) a->half[k] = known ? closed[k] : a->extent.half[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the fewest cells across that resolve the contact. */
int SamAdviceFewest(const SamAdvice *a)
{
  return a->closed && !SamProblemYields(a->setup->problem) ? SAM_ADVICE_FEW_CLOSED : SAM_ADVICE_CELLS;
}

/*
  Returns the width in cells of the spots with half of the contact, or of a narrower contact in closed form.

  Below SAM_ADVICE_BORDER it is no contact but a load on cells, whose width is their size: of nothing but the given load
  anything is known. The area of a sphere's contact is wrong by up to 16 % on 4 cells, by half on 3, its pressure by
  half on 2; on a tenth of a cell the pressure is a thousandth of Hertz's. The approach is right to 8 % down to 2 cells,
  SAM_ADVICE_SAME.
*/
double SamAdviceWidth(const SamAdvice *a)
{
  return (double)PetscMin(a->extent.half_across, a->across);
}

PetscErrorCode SamAdviceFindFew(const SamSetup *s, const SamControl *control, PetscReal *few, double *more)
{
  const PetscBool    wrap = SamElasticityGetTraits(s->elasticity).periodic;
  const SamStep      step = {.control = *control};
  SamAdvice          a    = {.setup = s, .step = &step};
  const SamSolution *solution;
  PetscReal          width;
  PetscBool          ends[2];

  PetscFunctionBegin;
  *few = 0;
  PetscCall(SamContactGetSolution(s->contact, &solution));
  PetscCall(SamGridMeasureZones(s->grid, solution->pressure, 0.5, wrap, &width));
  if (!(width > 0) || width >= SAM_ADVICE_BORDER + SAM_ADVICE_SAME) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAdviceMeasureZones(s, &a.extent));
  PetscCall(SamAdviceGetWidths(&a));
  if (a.extent.zones > 1 || (a.extent.whole && !SamAdviceIsStrip(&a, ends))) PetscFunctionReturn(PETSC_SUCCESS);
  if (SamAdviceWidth(&a) < SAM_ADVICE_BORDER) *few = a.extent.across;
  *more = (SamAdviceFewest(&a) + SAM_ADVICE_SAME) / (double)a.across;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Steps with long slides.

  A step wears body 2 at the two places of its points under the contact before and after the step, by the trapezoidal
  rule along the slide. If it slides by the contact's length, each point has only one or two pressures, and the depth
  looks like a comb. If the load of the step is spread over places between, while the weight of the pressure after the
  step grows linearly from 0 to 1, the depth is that of many steps. The difference of the two, summed over a cycle and
  over the cycles of all jumps, in the 2-norm relative to the load of body 2, estimates the error of the depth by the
  length of the steps. For a pin that slides over a disc by 4, 2, 1 and 1/2 lengths of the contact per step it is within
  a third of the true error; scars that conform, as in fretting, have a third of it.

  Where a stroke of few steps ends, the depth is uneven, and the pressure has a tip on what stands out. The tip's excess
  over the mean of the pressure along the slide of a step was 1.2 to 3.2 times the error of the maximum pressure where
  that was above 5 %: in 17 of 22 random lives with steps of up to a quarter of the contact.
*/
#include "lifeimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/state.h>
#include <petsam/private/wear.h>
#include <math.h>

/* Largest slide of a step, relative to the contact's length */
#define LONGEST 0.25
/* Largest excess of a tip of pressure without a warning, its ratio to the error, fewest cells of a step that show it */
#define TIP      0.07
#define TIPS     2
#define RESOLVED 4
#define ROW      2 /* the same of a row */
/* Number of places between for a slide of the contact's length, and the maximum number */
#define PLACES      8
#define MOST_PLACES 64

PetscErrorCode SamWearGetStride(SamElasticity elasticity, Vec pressure, const PetscReal from[2], const PetscReal to[2],
                                PetscReal *stride)
{
  const SamGrid   grid    = SamElasticityGetGrid(elasticity);
  const PetscReal cell[2] = {grid->dx, grid->dy};
  PetscInt        first[2], n[2];

  PetscFunctionBegin;
  *stride = 0;
  PetscCall(SamGridGetSupport(grid, pressure, SamElasticityGetTraits(elasticity).periodic, first, n));
  for (PetscInt k = 0; k < 2; k++)
    if (n[k] > 0) *stride = PetscMax(*stride, fabs(to[k] - from[k]) / ((PetscReal)n[k] * cell[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the excess of the maximum pressure over its mean along the slide of a step about it, in contact; 0 where a
  step has few cells.
*/
static PetscErrorCode FindTip(SamElasticity elasticity, Vec pressure, const PetscReal from[2], const PetscReal to[2],
                              PetscReal *tip)
{
  const PetscBool wrap    = SamElasticityGetTraits(elasticity).periodic;
  const SamGrid   grid    = SamElasticityGetGrid(elasticity);
  const double    slide[] = {(double)((to[0] - from[0]) / grid->dx), (double)((to[1] - from[1]) / grid->dy)};
  const PetscInt  n       = (PetscInt)(PetscMax(fabs(slide[0]), fabs(slide[1])) + 0.5);
  double          line[MOST_PLACES + 1] = {0}, sum = 0, cells = 0, most;
  PetscInt        at[2] = {0};
  const double   *p;

  PetscFunctionBegin;
  *tip = 0;
  if (n < (SamGridIsRow(grid) ? ROW : RESOLVED) || n > MOST_PLACES) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridFindPeak(grid, pressure, at, &most));
  PetscCall(VecGetArrayRead(pressure, &p));
  for (PetscInt k = 0; k <= n; k++) {
    const double t = (double)k / (double)n - 0.5;
    PetscInt     i = at[0] + (PetscInt)lrint(t * slide[0]), j = at[1] + (PetscInt)lrint(t * slide[1]);

    if (wrap) {
      i = (i % grid->nx + grid->nx) % grid->nx;
      j = (j % grid->ny + grid->ny) % grid->ny;
    }
    j -= grid->row_start;
    if (i >= 0 && i < grid->nx && j >= 0 && j < grid->rows) line[k] = p[i + j * grid->nx];
  }
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamSum(grid->comm, n + 1, line));
  for (PetscInt k = 0; k <= n; k++) {
    sum += line[k];
    cells += line[k] > 0 ? 1 : 0;
  }
  *tip = sum > 0 ? most * cells / sum - 1 : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearAdviseTip(PetscReal tip, char text[], size_t size)
{
  PetscFunctionBegin;
  text[0] = '\0';
  if (tip > TIP)
    PetscCall(PetscSNPrintf(text, size,
                            "the pressure has a tip %.0f %% above its mean along the slide of a step, so that the "
                            "maximum pressure and shear may be wrong by %.0f %%: use 2 times more steps",
                            100 * (double)tip, 100 * (double)tip / TIPS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearAdviseStride(PetscReal stride, char text[], size_t size)
{
  PetscFunctionBegin;
  text[0] = '\0';
  if (stride > LONGEST)
    PetscCall(
      PetscSNPrintf(text, size,
                    "a step slides by %.2g of the contact's length (limit %.2g), so that body 2 wears in stripes: "
                    "use %.0f times more steps",
                    (double)stride, LONGEST, ceil((double)stride / LONGEST)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds `scale` times `field`, at the points of body 2 under it at a slide, to the difference at body 2's own points. */
static PetscErrorCode Write(SamLife l, const PetscReal slide[2], PetscReal scale, Vec field)
{
  Vec written;

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &written));
  PetscCall(SamFramesWrite(SamProblemGetElasticity(l->problem), slide, field, written));
  PetscCall(VecAXPY(l->stripes, scale, written));
  PetscCall(SamPoolGive(l->pool, &written));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Divides a step's load into the part due to the pressure before it, `first`, and the `rest`. */
static PetscErrorCode Divide(SamGrid grid, Vec load, Vec before, Vec after, Vec first, Vec rest)
{
  const double *p0, *p1, *worn;
  double       *to;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(before, &p0));
  PetscCall(VecGetArrayRead(after, &p1));
  PetscCall(VecGetArrayRead(load, &worn));
  PetscCall(VecGetArrayWrite(first, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = p0[k] + p1[k] > 0 ? fabs(worn[k]) * p0[k] / (p0[k] + p1[k]) : 0;
  PetscCall(VecRestoreArrayWrite(first, &to));
  PetscCall(VecGetArrayWrite(rest, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = p0[k] + p1[k] > 0 ? fabs(worn[k]) * p1[k] / (p0[k] + p1[k]) : 0;
  PetscCall(VecRestoreArrayWrite(rest, &to));
  PetscCall(VecRestoreArrayRead(load, &worn));
  PetscCall(VecRestoreArrayRead(after, &p1));
  PetscCall(VecRestoreArrayRead(before, &p0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBeginStrides(SamLife l)
{
  PetscFunctionBegin;
  l->stride = l->tip = 0;
  if (l->loads == 1) PetscFunctionReturn(PETSC_SUCCESS);
  if (!l->stripes) PetscCall(SamGridCreateVec(l->grid, 1, &l->stripes));
  PetscCall(VecSet(l->stripes, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeNoteStride(SamLife l, Vec load, Vec before, Vec after)
{
  Vec       first, rest;
  PetscReal from[2], to[2], stride;
  PetscInt  n;

  PetscFunctionBegin;
  if (l->loads == 1) PetscFunctionReturn(PETSC_SUCCESS);
  (void)SamFramesGetSlide(l->memory, SAM_COMMITTED, from);
  (void)SamFramesGetSlide(l->memory, SAM_TRIED, to);
  PetscCall(SamWearGetStride(SamProblemGetElasticity(l->problem), after, from, to, &stride));
  l->stride = PetscMax(l->stride, stride);
  PetscCall(FindTip(SamProblemGetElasticity(l->problem), after, from, to, &l->tip));
  n = (PetscInt)PetscMin(PetscMax(ceil(PLACES * stride), 2), MOST_PLACES);
  PetscCall(SamPoolTake(l->pool, &first));
  PetscCall(SamPoolTake(l->pool, &rest));
  PetscCall(Divide(l->grid, load, before, after, first, rest));
  PetscCall(Write(l, from, 1, first));
  PetscCall(Write(l, to, 1, rest));
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal t         = ((PetscReal)k + 0.5) / (PetscReal)n;
    const PetscReal middle[2] = {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};

    PetscCall(Write(l, middle, -2 * (1 - t) / (PetscReal)n, first));
    PetscCall(Write(l, middle, -2 * t / (PetscReal)n, rest));
  }
  PetscCall(SamPoolGive(l->pool, &rest));
  PetscCall(SamPoolGive(l->pool, &first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeEndStrides(SamLife l)
{
  PetscReal difference, size;
  Vec       sum, load;

  PetscFunctionBegin;
  l->stripes_error = 0;
  if (l->loads == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStateRestoreField(l->memory, SamStateFindField(l->memory, SAM_WEAR_STRIPES), SAM_COMMITTED, &sum));
  PetscCall(SamStateRestoreField(l->memory, SamStateFindField(l->memory, SAM_WEAR_LOAD2), SAM_COMMITTED, &load));
  PetscCall(VecAXPY(sum, l->state.jump, l->stripes));
  PetscCall(SamGridNorm(l->grid, sum, NORM_2, &difference));
  PetscCall(SamGridNorm(l->grid, load, NORM_2, &size));
  l->stripes_error = size > 0 ? difference / size : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

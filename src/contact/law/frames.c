/*
  The frames of both bodies. The grid goes with body 1; where surfaces move past each other, other points of body 2 lie
  under it in each step, and where the bodies roll it moves over both. A field that is stored at a body's own points is
  read and written through these offsets. They are numbers of the state, which the law slide declares and moves; without
  it both bodies stay under the grid.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/state.h>

PetscBool SamFramesGetSlide(SamState state, SamGeneration generation, PetscReal slide[2])
{
  const PetscInt id = SamStateFindNumber(state, SAM_FRAME);
  const double  *n  = id < 0                    ? NULL
                      : generation == SAM_TRIED ? SamStateReadNumbers(state, id)
                                                : SamStateNumbers(state, id, generation);

  for (int k = 0; k < 2; k++) slide[k] = n ? n[SAM_FRAME_X + k] : 0;
  return n != NULL;
}

PetscBool SamFramesGetOffset(SamState state, SamGeneration generation, PetscInt body, PetscReal offset[2])
{
  const PetscBool slides = SamFramesGetSlide(state, generation, offset);

  for (int k = 0; k < 2; k++) {
    if (body == 0) offset[k] = 0;
    if (slides) offset[k] += SamStateReadNumbers(state, SamStateFindNumber(state, SAM_FRAME))[SAM_FRAME_ROLLED_X + k];
  }
  return slides;
}

void SamFramesSetSlide(SamState state, const PetscReal slide[2])
{
  const PetscInt id = SamStateFindNumber(state, SAM_FRAME);
  double        *n  = id < 0 ? NULL : SamStateNumbers(state, id, SAM_COMMITTED);

  for (int k = 0; k < 2 && n; k++) n[SAM_FRAME_X + k] = slide[k];
}

void SamFramesRewind(SamState state, SamGeneration generation, const PetscReal by[2])
{
  const PetscInt id = SamStateFindNumber(state, SAM_FRAME);
  double        *n  = id < 0 ? NULL : SamStateNumbers(state, id, generation);

  for (int k = 0; k < 2 && n; k++) {
    n[SAM_FRAME_X + k] -= by[k];
    n[SAM_FRAME_SLIDER_X + k] -= by[k];
  }
}

PetscErrorCode SamFramesReadBeyond(SamElasticity elasticity, const PetscReal slide[2], SamBorder beyond, Vec own,
                                   Vec seen)
{
  const PetscBool periodic = SamElasticityGetTraits(elasticity).periodic;

  PetscFunctionBegin;
  PetscCall(SamGridMove(SamElasticityGetGrid(elasticity), 1, slide, periodic ? SAM_BORDER_WRAPS : beyond, own, seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFramesRead(SamElasticity elasticity, const PetscReal slide[2], Vec own, Vec seen)
{
  PetscFunctionBegin;
  PetscCall(SamFramesReadBeyond(elasticity, slide, SAM_BORDER_ZERO, own, seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFramesWrite(SamElasticity elasticity, const PetscReal slide[2], Vec seen, Vec own)
{
  PetscFunctionBegin;
  PetscCall(SamFramesRead(elasticity, (const PetscReal[]){-slide[0], -slide[1]}, seen, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

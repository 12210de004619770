/*
  Fixed-point iterations x <- g(x) on fields with Anderson's acceleration (ground/grid/mixing.c): the driver of
  coupling.c and bound.c.
*/
#include "stepimpl.h"
#include <petsam/private/mixing.h>
#include <math.h>

static PetscErrorCode CutNegative(SamGrid grid, Vec field)
{
  double *values;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &values));
  for (PetscInt k = 0; k < grid->cells; k++) values[k] = PetscMax(values[k], 0);
  PetscCall(VecRestoreArray(field, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveFixedPoint(SamSolve *w, const SamFixedPoint *f, void *context, Vec argument, SamPassEnd *end)
{
  const SamGrid grid = w->grid;
  SamMixing     m;
  Vec           result;

  PetscFunctionBegin;
  PetscCall(SamMixingCreate(grid, f->components, &m));
  PetscCall(SamGridCreateVec(grid, f->components, &result));
  *end = SAM_PASS_REPEATS;
  for (PetscInt pass = 1; *end < SAM_PASS_SOLVED && pass <= f->most; pass++) {
    *end = SAM_PASS_GOES_ON;
    PetscCall((*f->pass)(context, pass, result, end));
    if (*end == SAM_PASS_GOES_ON) PetscCall(SamMixingNext(m, w->s->pressure, result, argument));
    if (*end == SAM_PASS_GOES_ON && f->nonnegative) PetscCall(CutNegative(grid, argument));
    if (*end == SAM_PASS_RESTARTS) PetscCall(VecCopy(result, argument));
    if (*end == SAM_PASS_RESTARTS) SamMixingRestart(m);
  }
  PetscCall(VecDestroy(&result));
  PetscCall(SamMixingDestroy(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveGetChange(SamSolve *w, Vec argument, Vec result, PetscReal unit, PetscReal *change,
                                 PetscReal *largest)
{
  const SamGrid grid = w->grid;
  PetscReal     size, shear, bound;
  Vec           difference;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(result, &difference));
  PetscCall(VecWAXPY(difference, -1, argument, result));
  PetscCall(SamGridNorm(grid, difference, NORM_2, &size));
  if (largest) PetscCall(VecNorm(difference, NORM_INFINITY, largest));
  PetscCall(VecDestroy(&difference));
  PetscCall(SamGridNorm(grid, w->s->shear, NORM_2, &shear));
  PetscCall(SamGridNorm(grid, w->s->bound, NORM_2, &bound));
  *change = size > 0 ? size / unit / PetscMax(shear, SAM_SHEAR_FLOOR * bound) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

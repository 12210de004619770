/* The fields of Newton's method: creation and destruction. */
#include "newtonimpl.h"
#include <math.h>

/* The root of the number of cells in contact. */
static PetscErrorCode FindReach(SamNewton *w)
{
  const SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  w->reach = 0;
  for (PetscInt j = 0; j < u->rows; j++)
    for (ptrdiff_t k = (ptrdiff_t)j * u->nx + u->first[j]; k < (ptrdiff_t)j * u->nx + u->last[j]; k++)
      w->reach += u->bound[k] > 0;
  PetscCall(SamSum(u->level->grid->comm, 1, &w->reach));
  w->reach = sqrt(w->reach);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define FLOATS 6

PetscErrorCode SamNewtonCreate(SamSolver solver, SamLevel *level, SamNewton *w)
{
  const SamFrame *f              = &level->frame;
  float **const   floats[FLOATS] = {&w->weight, &w->normal, &w->r, &w->z, &w->step, &w->u};

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, &w->base));
  PetscCall(SamAllocateZeros(sizeof(*w->trial) * 2 * (size_t)w->base.cells, &w->trial));
  for (PetscInt k = 0; k < FLOATS; k++)
    PetscCall(SamAllocateZeros(sizeof(***floats) * (k > 0 ? 2 : 1) * (size_t)w->base.cells, floats[k]));
  PetscCall(PetscMalloc1(w->base.nx, &w->xi));
  for (PetscInt i = 0; i < w->base.nx; i++) w->xi[i] = (float)(f->xi0 + (double)i * f->dxi);
  PetscCall(FindReach(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNewtonDestroy(SamNewton *w)
{
  PetscFunctionBegin;
  SamFree(w->trial);
  SamFree(w->weight);
  SamFree(w->normal);
  SamFree(w->r);
  SamFree(w->z);
  SamFree(w->step);
  SamFree(w->u);
  PetscCall(PetscFree(w->xi));
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

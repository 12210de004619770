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

PetscErrorCode SamNewtonCreate(SamSolver solver, SamLevel *level, SamNewton *w)
{
  const SamFrame *f = &level->frame;
  PetscInt        cells;

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, &w->base));
  cells = w->base.cells;
  PetscCall(SamAllocateZeros(sizeof(*w->trial) * 2 * (size_t)cells, &w->trial));
  PetscCall(SamAllocateZeros(sizeof(*w->weight) * 11 * (size_t)cells, &w->weight));
  w->normal = w->weight + cells;
  w->r      = w->normal + 2 * cells;
  w->z      = w->r + 2 * cells;
  w->step   = w->z + 2 * cells;
  w->u      = w->step + 2 * cells;
  PetscCall(PetscMalloc1(w->base.nx, &w->xi));
  for (PetscInt i = 0; i < w->base.nx; i++) w->xi[i] = (float)(f->xi0 + (double)i * f->dxi);
  PetscCall(FindReach(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNewtonDestroy(SamNewton *w)
{
  PetscFunctionBegin;
  SamFree(w->trial);
  SamFree(w->weight); /* with the others behind it */
  PetscCall(PetscFree(w->xi));
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fields in the rows about this rank's. */
#include "gridimpl.h"
#include <petsam/private/rows.h>

PetscErrorCode SamSee(SamGrid grid, Vec field, PetscInt components, PetscInt halo, SamSeen *seen)
{
  PetscFunctionBegin;
  *seen = (SamSeen){.field = field, .components = components};
  PetscCall(SamRowsCreateAbout(grid, halo, &seen->rows));
  PetscCall(VecGetArrayRead(field, &seen->own));
  for (PetscInt c = 0; c < components; c++)
    PetscCall(SamRowsFetch(&seen->rows, grid->nx, seen->own + (ptrdiff_t)c * grid->cells, &seen->at[c]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamForget(SamSeen *seen)
{
  PetscFunctionBegin;
  for (PetscInt c = seen->components; c-- > 0;) PetscCall(SamRowsRestore(&seen->rows, &seen->at[c]));
  PetscCall(VecRestoreArrayRead(seen->field, &seen->own));
  PetscCall(SamRowsDestroy(&seen->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

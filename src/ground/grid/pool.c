/* Fields that functions take for a while: what one has given back serves the next one. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/private/pool.h>

/* Largest number of fields that are lent at a time */
#define MOST 12

struct _n_SamPool {
  SamGrid   grid;
  Vec       field[MOST]; /* NULL: not created yet */
  PetscBool lent[MOST];
};

PetscErrorCode SamPoolCreate(SamGrid grid, SamPool *pool)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(pool));
  (*pool)->grid = grid;
  PetscCall(SamGridReference(grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPoolTake(SamPool pool, Vec *field)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  while (k < MOST && pool->lent[k]) k++;
  PetscCheck(k < MOST, pool->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "All %d fields of the pool are lent", MOST);
  if (!pool->field[k]) PetscCall(SamGridCreateVec(pool->grid, 1, &pool->field[k]));
  pool->lent[k] = PETSC_TRUE;
  *field        = pool->field[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPoolGive(SamPool pool, Vec *field)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  while (k < MOST && !(pool->lent[k] && pool->field[k] == *field)) k++;
  PetscCheck(k < MOST, pool->grid->comm, PETSC_ERR_ARG_WRONG, "The field is not one that the pool has lent");
  pool->lent[k] = PETSC_FALSE;
  *field        = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPoolDestroy(SamPool *pool)
{
  PetscFunctionBegin;
  if (!*pool) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < MOST; k++) PetscCall(VecDestroy(&(*pool)->field[k]));
  PetscCall(SamGridDestroy(&(*pool)->grid));
  PetscCall(PetscFree(*pool));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fields of a grid that functions take for a while (pool.c). */
#ifndef PETSAM_PRIVATE_POOL_H
#define PETSAM_PRIVATE_POOL_H

#include <petsam/grid.h>

/*
  SamPool - fields of one component that functions take for their own use, so that loops allocate none.
  SamPoolCreate - creates a pool without fields; it references the grid. SamPoolDestroy - frees it with all its fields,
  lent or not.
  SamPoolTake - lends a field, whose values are any. SamPoolGive - takes it back, and sets the handle to NULL.
  All are collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for more than 12 lent fields, PETSC_ERR_ARG_WRONG for one that is
  not lent.
*/
typedef struct _n_SamPool  *SamPool;
PETSC_INTERN PetscErrorCode SamPoolCreate(SamGrid grid, SamPool *pool);
PETSC_INTERN PetscErrorCode SamPoolDestroy(SamPool *pool);
PETSC_INTERN PetscErrorCode SamPoolTake(SamPool pool, Vec *field);
PETSC_INTERN PetscErrorCode SamPoolGive(SamPool pool, Vec *field);

#endif

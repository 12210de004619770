/* A bed of springs as a type of elasticity from outside the library: its one number, its options and parameters. */
#ifndef PETSAM_SPRINGS_H
#define PETSAM_SPRINGS_H

#include "contacts.h"

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/stress.h>

/* The size of the springs, a depth or a compliance; the same on all grids. How often the type was set up. */
typedef struct {
  double   size;
  PetscInt setups;
} Springs;

static inline double SizeOf(SamElasticity e)
{
  return ((const Springs *)e->data)->size;
}

static inline PetscErrorCode SpringsSetFromOptions(SamElasticity e, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, "springs_size", "size of the springs", NULL, SAM_RANGE_POSITIVE,
                           &((Springs *)e->data)->size, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode SpringsInherit(SamElasticity parent, SamElasticity child)
{
  ((Springs *)child->data)->size = SizeOf(parent);
  return 0;
}

static inline PetscErrorCode SpringsAddParameters(SamElasticity e, SamParameters *p)
{
  const PetscReal size = SizeOf(e);

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "springs_size", PETSC_TRUE, 1, &size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode SpringsSetParameters(SamElasticity e, const SamParameters *p, const char source[])
{
  const SamParameter *size = SamParametersFind(p, "springs_size");

  PetscFunctionBegin;
  PetscCheck(size, e->grid->comm, SAM_ERR_FILE, "%s: it lacks springs_size", source);
  ((Springs *)e->data)->size = size->value[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode SpringsSetUp(SamElasticity e)
{
  ((Springs *)e->data)->setups++;
  return 0;
}

static inline PetscErrorCode SpringsDestroy(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(e->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The data of springs of a size, and the methods about it; the type adds its products. */
static inline PetscErrorCode BeginSprings(SamElasticity e, double size)
{
  Springs *data;

  PetscFunctionBegin;
  PetscCall(PetscNew(&data));
  data->size = size;
  e->data    = data;
  e->ops     = (SamElasticityOps){.setfromoptions = SpringsSetFromOptions,
                                  .inherit        = SpringsInherit,
                                  .addparameters  = SpringsAddParameters,
                                  .setparameters  = SpringsSetParameters,
                                  .setup          = SpringsSetUp,
                                  .destroy        = SpringsDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif

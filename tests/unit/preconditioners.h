/* The preconditioners of an elasticity, of fields instead of floats. */
#ifndef PETSAM_PRECONDITIONERS_H
#define PETSAM_PRECONDITIONERS_H

#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>

/* Scaled to what floats hold, and back. */
static inline PetscErrorCode PreconditionField(SamElasticity e, PetscInt components, Vec in, Vec out)
{
  PetscInt      n;
  PetscReal     self[2], size;
  const double *x;
  double       *y;
  float        *work;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(in, &n));
  PetscCall(VecNorm(in, NORM_INFINITY, &size));
  PetscCall(SamElasticityGetSelfInfluence(e, &self[0], &self[1]));
  PetscCall(PetscMalloc1(n, &work));
  PetscCall(VecGetArrayRead(in, &x));
  for (PetscInt k = 0; k < n; k++) work[k] = (float)(x[k] / size);
  PetscCall(VecRestoreArrayRead(in, &x));
  PetscCall((components == 1 ? SamElasticityPreconditionNormalSingle
                             : SamElasticityPreconditionTangentialSingle)(e, self[components - 1], work, work));
  PetscCall(VecGetArrayWrite(out, &y));
  for (PetscInt k = 0; k < n; k++) y[k] = size / self[components - 1] * (double)work[k];
  PetscCall(VecRestoreArrayWrite(out, &y));
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode PreconditionNormal(SamElasticity e, Vec residual, Vec p)
{
  return PreconditionField(e, 1, residual, p);
}

static inline PetscErrorCode PreconditionTangential(SamElasticity e, Vec residual, Vec q)
{
  return PreconditionField(e, 2, residual, q);
}

typedef PetscErrorCode (*SingleProduct)(SamElasticity, double, const float[], float[]);

/* `factor` times the single product of a field in place. */
static inline void ApplySingle(SamElasticity e, SamGrid grid, PetscInt components, SingleProduct single, double factor,
                               Vec v)
{
  const PetscInt n    = components * grid->cells;
  float         *work = (float *)calloc((size_t)n + 1, sizeof(*work));
  double        *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt i = 0; i < n; i++) work[i] = (float)a[i];
  sam_call(single(e, factor, work, work));
  for (PetscInt i = 0; i < n; i++) a[i] = (double)work[i];
  sam_call(VecRestoreArray(v, &a));
  free(work);
}

#endif

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

typedef PetscErrorCode (*Product)(SamElasticity, Vec, Vec);

/* The four products, and the components of what goes in and comes out: 0, 1 tangential, 2 normal. */
static const struct {
  Product  apply;
  PetscInt first_in, n_in, first_out, n_out;
} products[4] = {{SamElasticityApplyNormal, 2, 1, 2, 1},
                 {SamElasticityApplyTangential, 0, 2, 0, 2},
                 {SamElasticityApplyNormalToTangential, 2, 1, 0, 2},
                 {SamElasticityApplyTangentialToNormal, 0, 2, 2, 1}};

/* All products of a field, in both precisions, of the whole grid: 12 fields, then the self influences. */
static inline double *AllProducts(SamElasticity e, size_t *count)
{
  const SingleProduct single[4] = {SamElasticityApplyNormalSingle, SamElasticityApplyTangentialSingle,
                                   SamElasticityPreconditionNormalSingle, SamElasticityPreconditionTangentialSingle};
  const SamGrid       grid      = SamElasticityGetGrid(e);
  double             *all, *to;

  *count = (size_t)(12 * grid->nx * grid->ny + 2);
  to = all = (double *)calloc(*count, sizeof(*all));
  for (int c = 0; c < 8; c++) {
    const PetscInt n_in = c < 4 ? products[c].n_in : c % 2 + 1, n_out = c < 4 ? products[c].n_out : n_in;
    Vec            in = NewRandom(grid, n_in, 7), out = c < 4 ? NewField(grid, n_out) : Copy(in);
    double        *whole;

    if (c < 4)
      sam_call(products[c].apply(e, in, out));
    else
      ApplySingle(e, grid, n_in, single[c - 4], c < 6 ? 1e15 : 1e-15, out);
    whole = Whole(grid, n_out, out);
    memcpy(to, whole, sizeof(*to) * (size_t)(n_out * grid->nx * grid->ny));
    to += n_out * grid->nx * grid->ny;
    free(whole);
    sam_destroy(&in, &out);
  }
  sam_call(SamElasticityGetSelfInfluence(e, &to[0], &to[1]));
  return all;
}

/* Of two operators, which are destroyed, to the last bit; but for the sign of zeros, which a sum over ranks loses. */
static inline void AssertSameProducts(SamElasticity e[2])
{
  size_t        count[2];
  double *const one = AllProducts(e[0], &count[0]), *const two = AllProducts(e[1], &count[1]);

  sam_assert(count[0] == count[1]);
  for (size_t k = 0; k < count[0]; k++) sam_assert(isfinite(one[k]) && one[k] == two[k]);
  free(one);
  free(two);
  for (int k = 0; k < 2; k++) sam_call(SamElasticityDestroy(&e[k]));
}

#endif

/* What the sub-cells of a cell add to the displacements of the cells about it. */
#include "edgesimpl.h"

enum { LAGS = 2 * SAM_NEAR + 1 };

void SamNearInitialize(SamElasticity elasticity, SamNear *n)
{
  *n = (SamNear){.elasticity = elasticity};
  SamRootsInitialize(SAM_ROOTS_SUB, &n->roots[SAM_NEAR_FINE]);
  SamRootsInitialize(SAM_ROOTS_COARSE, &n->roots[SAM_NEAR_COARSE]);
}

PetscErrorCode SamNearSetUp(SamNear *n)
{
  PetscFunctionBegin;
  for (int k = 0; k < 2 && !n->table[k]; k++) {
    PetscCall(PetscMalloc1(LAGS * LAGS * n->roots[k].cells, &n->table[k]));
    PetscCall(SamElasticityGetNear(n->elasticity, SAM_NEAR, n->roots[k].sub, n->table[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNearDestroy(SamNear *n)
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(PetscFree(n->table[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum of the displacements of a cell's centre by the sub-cells of another one. */
SAM_VECTORIZED static double Product(int n, const double *restrict influence, const double *restrict part)
{
  double sum = 0;

#pragma omp simd reduction(+ : sum)
  for (int k = 0; k < n; k++) sum += influence[k] * part[k];
  return sum;
}

void SamNearAdd(const SamNear *n, SamNearSub sub, SamGrid grid, const SamNearPart *part, double u[])
{
  const int     cells = n->roots[sub].cells;
  const double *table = n->table[sub];

  for (PetscInt b = -SAM_NEAR; b <= SAM_NEAR; b++)
    for (PetscInt a = -SAM_NEAR; a <= SAM_NEAR; a++) {
      const PetscInt row = part->j + b - grid->row_start, i = part->i + a;

      if (row >= 0 && row < grid->rows && i >= 0 && i < grid->nx)
        u[row * grid->nx + i] += Product(cells, table + ((b + SAM_NEAR) * LAGS + a + SAM_NEAR) * cells, part->traction);
    }
}

/*
  Generalised conjugate residuals, for the linear systems of heat, which are not symmetric.

  A direction is the residual, preconditioned if the system has a preconditioner, from which the part is subtracted that
  is needed to make its product orthogonal to the earlier products; the step along it minimises the residual. The
  directions restart after RESTART. Sums are the same on any number of ranks.

  Reference: Eisenstat, Elman and Schultz 1983, SIAM J. Numer. Anal. 20, 345.
*/
#include "heatimpl.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <math.h>

#define RESTART 30
/* Orthogonalisation is repeated, against rounding, if less than this part of a product is left. */
#define CANCELLED 0.5

/* A direction, and its product, which is a unit vector */
typedef struct {
  double *p, *v;
} Direction;

/* Adds a x to y. */
SAM_VECTORIZED static void AddTimes(PetscInt n, double a, const double *restrict x, double *restrict y)
{
#pragma omp simd
  for (PetscInt m = 0; m < n; m++) y[m] += a * x[m];
}

SAM_VECTORIZED static double DotOfRow(PetscInt n, const double *x, const double *y)
{
  double sum = 0;

#pragma omp simd reduction(+ : sum)
  for (PetscInt m = 0; m < n; m++) sum += x[m] * y[m];
  return sum;
}

/* Computes the dot products of x with n vectors. */
static PetscErrorCode Dots(SamGrid grid, PetscInt n, double *const v[], const double x[], double dots[])
{
  const PetscInt nx = grid->nx;
  SamTotal       totals[RESTART];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) {
    totals[k] = (SamTotal){0};
    for (PetscInt j = 0; j < grid->rows; j++)
      SamAdd(&totals[k], DotOfRow(nx, v[k] + j * (ptrdiff_t)nx, x + j * (ptrdiff_t)nx));
  }
  if (n) PetscCall(SamSumTotals(grid->comm, n, totals, dots));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatNorm(SamGrid grid, double x[], double *norm)
{
  PetscFunctionBegin;
  PetscCall(Dots(grid, 1, &x, x, norm));
  *norm = sqrt(*norm);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes direction k from the residual r; its product is orthogonal to the earlier ones. */
static PetscErrorCode NewDirection(SamHeatSystem *s, PetscInt k, const double r[], double size, Direction d[],
                                   double *norm)
{
  const PetscInt n = s->grid->cells;
  double        *v[RESTART], dots[RESTART];

  PetscFunctionBegin;
  if (!d[k].p) PetscCall(PetscMalloc2(n, &d[k].p, n, &d[k].v));
  for (PetscInt i = 0; i <= k; i++) v[i] = d[i].v;
  PetscCall(s->precondition ? (*s->precondition)(s->context, r, size, d[k].p) : PetscArraycpy(d[k].p, r, n));
  PetscCall((*s->multiply)(s->context, d[k].p, v[k]));
  PetscCall(SamHeatNorm(s->grid, v[k], norm));
  for (double before = PETSC_INFINITY; k > 0 && *norm > 0 && *norm < CANCELLED * before;) {
    before = *norm;
    PetscCall(Dots(s->grid, k, v, v[k], dots));
    for (PetscInt i = 0; i < k; i++) {
      AddTimes(n, -dots[i], v[i], v[k]);
      AddTimes(n, -dots[i], d[i].p, d[k].p);
    }
    PetscCall(SamHeatNorm(s->grid, v[k], norm));
  }
  for (PetscInt m = 0; *norm > 0 && m < n; m++) {
    v[k][m] /= *norm;
    d[k].p[m] /= *norm;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatReduce(SamHeatSystem *s, double goal, double x[], double r[], double *left)
{
  Direction d[RESTART] = {{NULL, NULL}};
  double    size, step, *v;

  PetscFunctionBegin;
  for (PetscInt it = 0; s->products<s->most && * left> goal; it++) {
    const PetscInt k = it % RESTART;

    PetscCall(NewDirection(s, k, r, *left, d, &size));
    s->products++;
    if (!(size > 0)) break;
    v = d[k].v;
    PetscCall(Dots(s->grid, 1, &v, r, &step));
    AddTimes(s->grid->cells, step, d[k].p, x);
    AddTimes(s->grid->cells, -step, v, r);
    PetscCall(SamHeatNorm(s->grid, r, left));
  }
  for (PetscInt k = 0; k < RESTART; k++) PetscCall(PetscFree2(d[k].p, d[k].v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

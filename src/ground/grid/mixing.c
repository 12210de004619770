/*
  Anderson's acceleration of an iteration x <- g(x) on fields.

  The next x is sum t_i g(x_i) over the last iterates; the t, with sum 1, minimise sum t_i (g(x_i) - x_i). For a linear
  g this is equivalent to a Krylov method. So an iteration with the eigenvalues +- i r, which converges slowly or
  diverges without acceleration, converges like r/(1 + sqrt(1 + r^2)).

  References: Anderson 1965, J. ACM 12, 547; Walker and Ni 2011, SIAM J. Numer. Anal. 49, 1715.
*/
#include <petsam/private/mixing.h>
#include <petsam/private/base.h>
#include <petsam/private/baseimpl.h>
#include <math.h>

/* Number of last iterates that are stored */
#define DEPTH 6
/* Smaller eigenvalues of the scaled matrix of products are rounding. */
#define LEAST 1e-10
/* Largest sum of the absolute weights of the combined results; it bounds the amplification of their errors */
#define MOST 10.0

struct _n_SamMixing {
  SamGrid  grid; /* borrowed */
  PetscInt components, count, newest;
  Vec      result[DEPTH], change[DEPTH]; /* change: result minus argument, in cells that count */
  double   products[DEPTH][DEPTH];       /* of the changes */
};

/* Adds the newest result, and the products of its change with all others. */
static PetscErrorCode Add(SamMixing m, Vec weight, Vec result, Vec argument)
{
  const PetscInt k = m->count < DEPTH ? m->count : (m->newest + 1) % DEPTH, cells = m->grid->cells, nx = m->grid->nx,
                 rows         = m->components * m->grid->rows;
  SamTotal      totals[DEPTH] = {{0}};
  double        sums[DEPTH], *change;
  const double *w, *x, *g, *other;

  PetscFunctionBegin;
  if (!m->result[k]) {
    PetscCall(SamGridCreateVec(m->grid, m->components, &m->result[k]));
    PetscCall(SamGridCreateVec(m->grid, m->components, &m->change[k]));
  }
  m->newest = k;
  m->count  = PetscMin(m->count + 1, DEPTH);
  PetscCall(VecCopy(result, m->result[k]));
  PetscCall(VecGetArrayRead(weight, &w));
  PetscCall(VecGetArrayRead(argument, &x));
  PetscCall(VecGetArrayRead(result, &g));
  PetscCall(VecGetArray(m->change[k], &change));
  for (PetscInt i = 0; i < m->components * cells; i++) change[i] = w[i % cells] > 0 ? g[i] - x[i] : 0;
  PetscCall(VecRestoreArrayRead(result, &g));
  PetscCall(VecRestoreArrayRead(argument, &x));
  PetscCall(VecRestoreArrayRead(weight, &w));
  for (PetscInt l = 0; l < m->count; l++) {
    other = change;
    if (l != k) PetscCall(VecGetArrayRead(m->change[l], &other));
    for (PetscInt j = 0; j < rows; j++) {
      double row = 0;

      for (PetscInt i = j * nx; i < (j + 1) * nx; i++) row += change[i] * other[i];
      SamAdd(&totals[l], row);
    }
    if (l != k) PetscCall(VecRestoreArrayRead(m->change[l], &other));
  }
  PetscCall(VecRestoreArray(m->change[k], &change));
  PetscCall(SamSumTotals(m->grid->comm, m->count, totals, sums));
  for (PetscInt l = 0; l < m->count; l++) m->products[k][l] = m->products[l][k] = sums[l];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the parts t of all iterates; their sum is 1. */
static void FindParts(SamMixing m, double t[DEPTH])
{
  const PetscInt k = m->newest;
  double         A[DEPTH * DEPTH], b[DEPTH], x[DEPTH], unit[DEPTH];
  PetscInt       other[DEPTH], n = 0;

  /* differences of the other changes from the newest one */
  for (PetscInt l = 0; l < m->count; l++) {
    const double size = m->products[l][l] - 2 * m->products[k][l] + m->products[k][k];

    if (l == k || !(size > 0)) continue;
    unit[n]  = 1 / sqrt(size);
    other[n] = l;
    n++;
  }
  for (double least = LEAST; least < 1; least *= 10) {
    double sizes = 0;

    for (PetscInt i = 0; i < n; i++) {
      const PetscInt p = other[i];

      for (PetscInt j = 0; j < n; j++) {
        const PetscInt q = other[j];

        A[i * n + j] =
          unit[i] * unit[j] * (m->products[p][q] - m->products[p][k] - m->products[k][q] + m->products[k][k]);
      }
      b[i] = unit[i] * (m->products[k][k] - m->products[p][k]);
    }
    SamSolveSymmetric(n, A, b, least, x);
    for (PetscInt l = 0; l < DEPTH; l++) t[l] = 0;
    t[k] = 1;
    for (PetscInt i = 0; i < n; i++) {
      t[other[i]] = unit[i] * x[i];
      t[k] -= t[other[i]];
      sizes += fabs(t[other[i]]);
    }
    if (sizes + fabs(t[k]) <= MOST) break;
  }
}

PetscErrorCode SamMixingCreate(SamGrid grid, PetscInt components, SamMixing *mixing)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(mixing));
  (*mixing)->grid       = grid;
  (*mixing)->components = components;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMixingDestroy(SamMixing *mixing)
{
  PetscFunctionBegin;
  if (!*mixing) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < DEPTH; k++) {
    PetscCall(VecDestroy(&(*mixing)->result[k]));
    PetscCall(VecDestroy(&(*mixing)->change[k]));
  }
  PetscCall(PetscFree(*mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamMixingRestart(SamMixing m)
{
  m->count = 0;
}

PetscErrorCode SamMixingNext(SamMixing m, Vec weight, Vec result, Vec argument)
{
  double t[DEPTH];

  PetscFunctionBegin;
  PetscCall(Add(m, weight, result, argument));
  FindParts(m, t);
  PetscCall(VecSet(argument, 0));
  for (PetscInt l = 0; l < m->count; l++) PetscCall(VecAXPY(argument, t[l], m->result[l]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  GMRES with preconditioning from the right, for the systems of the tangent stiffness.

  Algorithm: V is an orthonormal basis of r, A M r, (A M)^2 r ..., M the preconditioner; x = M V y with the y that makes
  the residual shortest. Starts anew after RESTART directions, or when the residual that is left is not the one that was
  expected: M is in single precision.
  Products of vectors are the same on any number of ranks, which those of PETSc's own KSP are not.

  Reference: Saad and Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856.
*/
#include "stiffnessimpl.h"
#include <math.h>

#define RESTART 30
#define MOST    300 /* products of one column */
#define GOAL    0.7 /* the part of the tolerance that the basis is grown to; the true residual is a little larger */

typedef struct {
  SamFrozen *f;
  PetscInt   n;                       /* values of a field on this rank */
  double    *v[RESTART + 1];          /* the basis; NULL for those not needed yet */
  double    *z, *w;                   /* M v; A M v */
  double     h[RESTART + 1][RESTART]; /* A M V = V h, made triangular by rotations */
  double     cosine[RESTART], sine[RESTART], g[RESTART + 1];
} Work;

static PetscErrorCode Norm(const SamFrozen *f, double x[], double *norm)
{
  double *const fields[1] = {x};

  PetscFunctionBegin;
  PetscCall(SamFrozenDots(f, 1, fields, x, norm));
  *norm = sqrt(*norm);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes w normal to the first k + 1 of the basis; its products with them are column k of h. Twice, against rounding. */
static PetscErrorCode Orthogonalize(Work *s, PetscInt k)
{
  double dots[RESTART + 1], norm;

  PetscFunctionBegin;
  for (PetscInt i = 0; i <= k; i++) s->h[i][k] = 0;
  for (PetscInt twice = 0; twice < 2; twice++) {
    PetscCall(SamFrozenDots(s->f, k + 1, s->v, s->w, dots));
    for (PetscInt i = 0; i <= k; i++) {
      s->h[i][k] += dots[i];
      for (PetscInt m = 0; m < s->n; m++) s->w[m] -= dots[i] * s->v[i][m];
    }
  }
  PetscCall(Norm(s->f, s->w, &norm));
  s->h[k + 1][k] = norm;
  if (!s->v[k + 1]) PetscCall(PetscMalloc1(s->n, &s->v[k + 1]));
  for (PetscInt m = 0; m < s->n; m++) s->v[k + 1][m] = norm > 0 ? s->w[m] / norm : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rotates column k so that h is triangular; g then ends with the norm of the residual. */
static void Rotate(Work *s, PetscInt k)
{
  double norm;

  for (PetscInt i = 0; i < k; i++) {
    const double a = s->h[i][k], b = s->h[i + 1][k];

    s->h[i][k]     = s->cosine[i] * a + s->sine[i] * b;
    s->h[i + 1][k] = -s->sine[i] * a + s->cosine[i] * b;
  }
  norm         = hypot(s->h[k][k], s->h[k + 1][k]);
  s->cosine[k] = norm > 0 ? s->h[k][k] / norm : 1;
  s->sine[k]   = norm > 0 ? s->h[k + 1][k] / norm : 0;
  s->h[k][k]   = norm;
  s->g[k + 1]  = -s->sine[k] * s->g[k];
  s->g[k] *= s->cosine[k];
}

/* x += M V y, with h y = g. */
static PetscErrorCode Combine(Work *s, PetscInt k, double x[])
{
  double y[RESTART];

  PetscFunctionBegin;
  for (PetscInt i = k - 1; i >= 0; i--) {
    y[i] = s->g[i];
    for (PetscInt j = i + 1; j < k; j++) y[i] -= s->h[i][j] * y[j];
    y[i] = s->h[i][i] > 0 ? y[i] / s->h[i][i] : 0;
  }
  for (PetscInt m = 0; m < s->n; m++) {
    s->w[m] = 0;
    for (PetscInt i = 0; i < k; i++) s->w[m] += y[i] * s->v[i][m];
  }
  PetscCall(SamFrozenPrecondition(s->f, s->w, s->z));
  for (PetscInt m = 0; m < s->n; m++) x[m] += s->z[m];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the residual, of norm `left`, up to RESTART directions; adds what they bring to x. */
static PetscErrorCode Cycle(Work *s, const double residual[], double left, double limit, double x[])
{
  PetscInt k = 0;

  PetscFunctionBegin;
  if (!s->v[0]) PetscCall(PetscMalloc1(s->n, &s->v[0]));
  for (PetscInt m = 0; m < s->n; m++) s->v[0][m] = residual[m] / left;
  s->g[0] = left;
  while (k < RESTART && fabs(s->g[k]) > limit) {
    PetscCall(SamFrozenPrecondition(s->f, s->v[k], s->z));
    PetscCall(SamFrozenApply(s->f, s->z, s->w));
    PetscCall(Orthogonalize(s, k));
    Rotate(s, k);
    k++;
  }
  PetscCall(Combine(s, k, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKrylovSolve(SamFrozen *f, const double b[], double x[], double residual[], PetscReal *error)
{
  const PetscInt before = f->applies;
  Work           s      = {.f = f, .n = SamFrozenSize(f)};
  double         norm, left, last = PETSC_INFINITY;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s.n, &s.z, s.n, &s.w));
  PetscCall(PetscArrayzero(x, s.n));
  PetscCall(PetscArraycpy(residual, b, s.n));
  PetscCall(Norm(f, residual, &norm));
  left = norm;
  while (left > SAM_STIFFNESS_RTOL * norm && left < 0.5 * last && f->applies - before < MOST) {
    last = left;
    PetscCall(Cycle(&s, residual, left, GOAL * SAM_STIFFNESS_RTOL * norm, x));
    PetscCall(SamFrozenApply(f, x, residual));
    for (PetscInt m = 0; m < s.n; m++) residual[m] = b[m] - residual[m];
    PetscCall(Norm(f, residual, &left));
  }
  *error = norm > 0 ? left / norm : 0;
  for (PetscInt k = 0; k <= RESTART; k++) PetscCall(PetscFree(s.v[k]));
  PetscCall(PetscFree2(s.z, s.w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

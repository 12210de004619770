/* Small symmetric systems that may be singular. */
#include <petsam/private/baseimpl.h>
#include <math.h>

#define SWEEPS 30

/* Applies one Jacobi rotation that removes entry (i, j) of the symmetric A of order n; V collects the rotations. */
static void Rotate(PetscInt n, double A[], double V[], PetscInt i, PetscInt j)
{
  const double entry = A[i * n + j];
  double       theta, t, c, s;

  if (entry == 0) return;
  theta = (A[j * n + j] - A[i * n + i]) / (2 * entry);
  t     = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
  c     = 1 / sqrt(t * t + 1);
  s     = t * c;
  for (PetscInt k = 0; k < n; k++) {
    const double x = A[k * n + i], y = A[k * n + j];

    A[k * n + i] = c * x - s * y;
    A[k * n + j] = s * x + c * y;
  }
  for (PetscInt k = 0; k < n; k++) {
    const double x = A[i * n + k], y = A[j * n + k], vx = V[k * n + i], vy = V[k * n + j];

    A[i * n + k] = c * x - s * y;
    A[j * n + k] = s * x + c * y;
    V[k * n + i] = c * vx - s * vy;
    V[k * n + j] = s * vx + c * vy;
  }
}

/* True if all off-diagonal entries are rounding errors. */
static PetscBool IsDiagonal(PetscInt n, const double A[])
{
  double beside = 0, on = 0;

  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++)
      if (i == j)
        on = PetscMax(on, fabs(A[i * n + j]));
      else
        beside = PetscMax(beside, fabs(A[i * n + j]));
  return beside <= 1e-18 * on;
}

void SamSolveSymmetric(PetscInt n, double A[], const double b[], double least, double x[])
{
  double V[SAM_SYMMETRIC_MAX * SAM_SYMMETRIC_MAX] = {0}, largest = 0;

  for (PetscInt k = 0; k < n; k++) V[k * n + k] = 1;
  for (PetscInt sweep = 0; sweep < SWEEPS && !IsDiagonal(n, A); sweep++)
    for (PetscInt i = 0; i < n; i++)
      for (PetscInt j = i + 1; j < n; j++) Rotate(n, A, V, i, j);
  for (PetscInt k = 0; k < n; k++) {
    largest = PetscMax(largest, A[k * n + k]);
    x[k]    = 0;
  }
  for (PetscInt k = 0; k < n; k++) {
    double part = 0;

    if (A[k * n + k] <= least * largest) continue;
    for (PetscInt i = 0; i < n; i++) part += V[i * n + k] * b[i];
    for (PetscInt i = 0; i < n; i++) x[i] += V[i * n + k] * part / A[k * n + k];
  }
}

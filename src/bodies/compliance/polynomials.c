/* Fits the polynomials of a patch to a field that is given at points. */
#include <petsam/private/compliance.h>
#include <math.h>
#include <petscdt.h>
#include <petscmat.h>

#define INDEPENDENT 1e-6 /* least ratio of diagonal elements of R for which points determine the polynomials */

/* Evaluates the polynomials at places along an axis. */
static PetscErrorCode ValuesAt(SamCompliance c, int axis, PetscInt n, const double at[], PetscReal values[])
{
  PetscInt   degrees[SAM_COMPLIANCE_DEGREE + 1];
  PetscReal *t;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &t));
  for (PetscInt k = 0; k <= c->degree; k++) degrees[k] = k;
  for (PetscInt k = 0; k < n; k++) t[k] = (at[k] - c->center[axis]) / c->half[axis];
  PetscCall(PetscDTLegendreEval(n, t, c->degree + 1, degrees, values, NULL, NULL));
  PetscCall(PetscFree(t));
  for (PetscInt k = 0; k < n * (c->degree + 1); k++)
    values[k] *= sqrt((2 * (double)(k % (c->degree + 1)) + 1) / (2 * c->half[axis]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceFit(SamCompliance c, PetscInt n, const double *const at[2], const double values[],
                                double field[][3], double *rest)
{
  const PetscInt degrees = c->degree + 1;
  PetscReal     *along[2], *a, least = PETSC_INFINITY, most = 0;
  Mat            matrix, factor;
  Vec            b, solution;

  PetscFunctionBegin;
  *rest = 0;
  PetscCall(PetscMalloc2(n * degrees, &along[0], n * degrees, &along[1]));
  for (int d = 0; d < 2; d++) PetscCall(ValuesAt(c, d, n, at[d], along[d]));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, c->modes, NULL, &matrix));
  PetscCall(MatDenseGetArray(matrix, &a));
  for (PetscInt m = 0; m < c->modes; m++)
    for (PetscInt k = 0; k < n; k++)
      a[m * n + k] = along[0][k * degrees + c->power[m][0]] * along[1][k * degrees + c->power[m][1]];
  PetscCall(MatDenseRestoreArray(matrix, &a));
  PetscCall(MatDuplicate(matrix, MAT_COPY_VALUES, &factor));
  PetscCall(MatQRFactor(factor, NULL, NULL));
  PetscCall(MatDenseGetArray(factor, &a));
  for (PetscInt m = 0; m < c->modes; m++) {
    least = PetscMin(least, fabs(a[m * n + m]));
    most  = PetscMax(most, fabs(a[m * n + m]));
  }
  PetscCall(MatDenseRestoreArray(factor, &a));
  if (!(least > INDEPENDENT * most)) *rest = NAN;
  PetscCall(MatCreateVecs(matrix, &solution, &b));
  for (PetscInt d = 0; d < 3 && !isnan(*rest); d++) {
    double range[2] = {values[d], values[d]};

    PetscCall(VecGetArray(b, &a));
    for (PetscInt k = 0; k < n; k++) {
      a[k]     = values[3 * k + d];
      range[0] = PetscMin(range[0], a[k]);
      range[1] = PetscMax(range[1], a[k]);
    }
    PetscCall(VecRestoreArray(b, &a));
    PetscCall(MatSolve(factor, b, solution));
    PetscCall(VecGetArray(solution, &a));
    for (PetscInt m = 0; m < c->modes; m++) field[m][d] = a[m];
    PetscCall(VecRestoreArray(solution, &a));
    PetscCall(VecScale(b, -1));
    PetscCall(MatMultAdd(matrix, solution, b, b));
    PetscCall(VecGetArray(b, &a));
    for (PetscInt k = 0; k < n && range[1] > range[0]; k++) *rest = PetscMax(*rest, fabs(a[k]) / (range[1] - range[0]));
    PetscCall(VecRestoreArray(b, &a));
  }
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&solution));
  PetscCall(MatDestroy(&factor));
  PetscCall(MatDestroy(&matrix));
  PetscCall(PetscFree2(along[0], along[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

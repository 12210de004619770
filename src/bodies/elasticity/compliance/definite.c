/*
  Checks that a body's compliance is positive definite. The compliance of the half-space is positive definite, and so is
  the true one of the body, but the sum of the half-space's compliance and a projection need not be.

  With K of the half-space on cells, Phi the polynomials' means (modes, cells), A the area of a cell and G =
  A Phi K^-1 Phi', the eigenvalues of K + A Phi'D Phi relative to K are 1 and 1 + those of D G.
*/
#include <petsam/private/body.h>
#include <petsam/private/compliance.h>
#include <math.h>
#include <petscksp.h>

enum { SIDE = 20, CELLS = SIDE * SIDE, UNKNOWNS = 3 * CELLS, LAGS = 2 * SIDE, TABLE = LAGS * LAGS };

/* Computes the displacements (3, LAGS, LAGS) of the cells about the middle one by a unit traction in each direction on
   it. */
static PetscErrorCode FillTable(SamElasticity e, double table[])
{
  const PetscInt middle = SIDE * LAGS + SIDE;
  Vec            field[2], moved[2];
  const double  *u;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) {
    PetscCall(SamGridCreateVec(e->grid, k + 1, &field[k]));
    PetscCall(SamGridCreateVec(e->grid, k + 1, &moved[k]));
  }
  for (PetscInt from = 0; from < 3; from++) {
    const PetscInt k = from == 2 ? 0 : 1;

    PetscCall(VecZeroEntries(field[k]));
    PetscCall(VecSetValue(field[k], k * from * TABLE + middle, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(field[k]));
    PetscCall(VecAssemblyEnd(field[k]));
    if (k) {
      PetscCall(SamElasticityApplyTangential(e, field[1], moved[1]));
      PetscCall(VecGetArrayRead(moved[1], &u));
      PetscCall(PetscArraycpy(table + 3 * from * TABLE, u, 2 * TABLE));
      PetscCall(VecRestoreArrayRead(moved[1], &u));
      if (e->traits.coupled) PetscCall(SamElasticityApplyTangentialToNormal(e, field[1], moved[0]));
    } else {
      PetscCall(SamElasticityApplyNormal(e, field[0], moved[0]));
    }
    PetscCall(VecGetArrayRead(moved[0], &u));
    PetscCall(PetscArraycpy(table + (3 * from + 2) * TABLE, u, TABLE));
    PetscCall(VecRestoreArrayRead(moved[0], &u));
  }
  for (PetscInt k = 0; k < 2; k++) {
    PetscCall(VecDestroy(&field[k]));
    PetscCall(VecDestroy(&moved[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the lower triangle of K, by columns; K is the compliance of the body against a rigid one. */
static PetscErrorCode Fill(SamCompliance c, SamPair both, const double d[2], double matrix[])
{
  const PetscReal   width[2] = {LAGS * d[0], LAGS * d[1]}, center[2] = {0, 0};
  const SamMaterial rigid = {.young = INFINITY};
  SamElasticity     e;
  SamGrid           grid;
  SamBody           above;
  SamPair           pair;
  double           *table;

  PetscFunctionBegin;
  PetscCall(SamBodyCreate(1, &rigid, &above));
  PetscCall(SamPairCreate(SamComplianceIsPair(c) ? SamPairBody(both, 0) : above, SamPairBody(both, c->body), &pair));
  PetscCall(SamBodyDestroy(&above));
  PetscCall(SamGridCreate(PETSC_COMM_SELF, (PetscInt[]){LAGS, LAGS}, width, center, &grid));
  PetscCall(SamElasticityCreate(grid, pair, &e));
  PetscCall(SamElasticitySetType(e, SAM_ELASTICITY_HALFSPACE));
  PetscCall(PetscCalloc1(9 * TABLE, &table));
  PetscCall(FillTable(e, table));
  for (int column = 0; column < UNKNOWNS; column++)
    for (int row = column; row < UNKNOWNS; row++) {
      const int from = column % CELLS, to = row % CELLS, i = to % SIDE - from % SIDE, j = to / SIDE - from / SIDE;

      matrix[column * UNKNOWNS + row] =
        table[(column / CELLS * 3 + row / CELLS) * TABLE + (j + SIDE) * LAGS + i + SIDE];
    }
  PetscCall(PetscFree(table));
  PetscCall(SamElasticityDestroy(&e));
  PetscCall(SamPairDestroy(&pair));
  PetscCall(SamGridDestroy(&grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes Phi', by columns: polynomial m of direction a is column a modes + m. */
static void FillMeans(SamCompliance c, const double d[2], double means[])
{
  double along[2][SIDE][SAM_COMPLIANCE_DEGREE + 1];

  for (PetscInt k = 0; k < 2 * SIDE; k++) {
    const double from = c->center[k / SIDE] - c->half[k / SIDE] + (double)(k % SIDE) * d[k / SIDE];

    SamComplianceMeans(c, k / SIDE, from, from + d[k / SIDE], along[k / SIDE][k % SIDE]);
  }
  for (PetscInt a = 0; a < 3; a++)
    for (PetscInt m = 0; m < c->modes; m++)
      for (PetscInt k = 0; k < CELLS; k++)
        means[(a * c->modes + m) * UNKNOWNS + a * CELLS + k] =
          along[0][k % SIDE][c->power[m][0]] * along[1][k / SIDE][c->power[m][1]];
}

/* Computes D G, the compliance of the tractions on the cells relative to the half-space's, minus the identity. */
static PetscErrorCode CreateRelative(SamCompliance c, SamPair pair, Mat d, PetscInt n, Mat *relative)
{
  const double side[2] = {2 * c->half[0] / SIDE, 2 * c->half[1] / SIDE};
  Mat          matrix, means, solved, g;
  double      *values;

  PetscFunctionBegin;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, UNKNOWNS, UNKNOWNS, NULL, &matrix));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, UNKNOWNS, n, NULL, &means));
  PetscCall(MatDenseGetArray(matrix, &values));
  PetscCall(Fill(c, pair, side, values));
  PetscCall(MatDenseRestoreArray(matrix, &values));
  PetscCall(MatDenseGetArray(means, &values));
  FillMeans(c, side, values);
  PetscCall(MatDenseRestoreArray(means, &values));
  PetscCall(MatDuplicate(means, MAT_DO_NOT_COPY_VALUES, &solved));
  PetscCall(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  PetscCall(MatCholeskyFactor(matrix, NULL, NULL));
  PetscCall(MatMatSolve(matrix, means, solved));
  PetscCall(MatTransposeMatMult(means, solved, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &g));
  PetscCall(MatScale(g, side[0] * side[1]));
  PetscCall(MatMatMult(d, g, MAT_INITIAL_MATRIX, PETSC_DEFAULT, relative));
  PetscCall(MatDestroy(&g));
  PetscCall(MatDestroy(&solved));
  PetscCall(MatDestroy(&means));
  PetscCall(MatDestroy(&matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the smallest and the largest of the real eigenvalues of a matrix of order n. */
static PetscErrorCode FindEnds(Mat matrix, PetscInt n, double *least, double *most)
{
  double *real, *imaginary;
  KSP     ksp;
  PC      pc;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &real, n, &imaginary));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, matrix, matrix));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetUp(ksp));
  PetscCall(KSPComputeEigenvaluesExplicitly(ksp, n, real, imaginary));
  *least = *most = real[0];
  for (PetscInt k = 1; k < n; k++) {
    *least = PetscMin(*least, real[k]);
    *most  = PetscMax(*most, real[k]);
  }
  PetscCall(KSPDestroy(&ksp));
  PetscCall(PetscFree2(real, imaginary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceEnds(SamCompliance c, SamPair pair, double *least, double *most)
{
  const PetscInt n = 3 * c->modes;
  double        *values, entry = 0;
  PetscReal      norm;
  Mat            d, relative = NULL;

  PetscFunctionBegin;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, n, NULL, &d));
  PetscCall(MatDenseGetArray(d, &values));
  for (PetscInt k = 0; k < n * n; k++) {
    values[k] = c->matrix[k];
    entry     = PetscMax(entry, fabs(values[k]));
  }
  PetscCall(MatDenseRestoreArray(d, &values));
  if (!isinf(c->young)) PetscCall(CreateRelative(c, pair, d, n, &relative));
  PetscCall(MatNorm(relative ? relative : d, NORM_FROBENIUS, &norm));
  *least = *most = NAN; /* for matrices that are not finite, for which LAPACK would end the process with exit code 0 */
  if (isfinite(norm)) PetscCall(FindEnds(relative ? relative : d, n, least, most));
  if (relative) {
    *least += 1;
    *most += 1;
  } else {
    if (*least > -1e-9 * entry) *least = 0;
    *most = 1;
  }
  PetscCall(MatDestroy(&relative));
  PetscCall(MatDestroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

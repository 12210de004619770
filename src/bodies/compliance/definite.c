/*
  Checks that a body's compliance is positive definite. The compliance of the half-space is positive definite, and so is
  the true one of the body, but the sum of the half-space's compliance and a projection need not be.

  With K of the half-space on cells, Phi the polynomials' means (modes, cells), A the area of a cell and G =
  A Phi K^-1 Phi', the eigenvalues of K + A Phi'D Phi relative to K are 1 and 1 + those of D G.
*/
#include <petsam/private/halfspace.h>
#include <petsam/private/body.h>
#include <petsam/private/compliance.h>
#include <math.h>
#include <petscksp.h>

enum { SIDE = 20, LAGS = 2 * SIDE };

/* The numbers of cells along y and in all, and of lags: one row in plane strain */
typedef struct {
  PetscInt rows, cells, lags, table;
} Count;

static Count CountOf(SamCompliance c)
{
  return c->datum > 0 ? (Count){1, SIDE, 1, LAGS} : (Count){SIDE, SIDE * SIDE, LAGS, LAGS * LAGS};
}

/* Computes the displacements (3, lags, LAGS) of the cells about the middle one by a unit traction in each direction on
   it. */
static PetscErrorCode FillTable(SamElasticity e, Count n, double table[])
{
  const PetscInt middle = n.lags / 2 * LAGS + SIDE;
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
    PetscCall(VecSetValue(field[k], k * from * n.table + middle, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(field[k]));
    PetscCall(VecAssemblyEnd(field[k]));
    if (k) {
      PetscCall(SamElasticityApplyTangential(e, field[1], moved[1]));
      PetscCall(VecGetArrayRead(moved[1], &u));
      PetscCall(PetscArraycpy(table + 3 * from * n.table, u, 2 * n.table));
      PetscCall(VecRestoreArrayRead(moved[1], &u));
      if (e->traits.coupled) PetscCall(SamElasticityApplyTangentialToNormal(e, field[1], moved[0]));
    } else {
      PetscCall(SamElasticityApplyNormal(e, field[0], moved[0]));
    }
    PetscCall(VecGetArrayRead(moved[0], &u));
    PetscCall(PetscArraycpy(table + (3 * from + 2) * n.table, u, n.table));
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
  const Count       n        = CountOf(c);
  const PetscReal   width[2] = {LAGS * d[0], (PetscReal)n.lags * d[1]}, center[2] = {0, 0};
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
  PetscCall(SamGridCreate(PETSC_COMM_SELF, (PetscInt[]){LAGS, n.lags}, width, center, &grid));
  PetscCall(SamElasticityCreate(grid, pair, &e));
  if (c->datum > 0) {
    PetscCall(SamElasticitySetType(e, SAM_ELASTICITY_PLANE));
    *SamHalfSpaceDatum(e) = c->datum;
  } else {
    PetscCall(SamElasticitySetType(e, SAM_ELASTICITY_HALFSPACE));
  }
  PetscCall(PetscCalloc1(9 * n.table, &table));
  PetscCall(FillTable(e, n, table));
  for (PetscInt column = 0; column < 3 * n.cells; column++)
    for (PetscInt row = column; row < 3 * n.cells; row++) {
      const PetscInt from = column % n.cells, to = row % n.cells;
      const PetscInt i = to % SIDE - from % SIDE, j = to / SIDE - from / SIDE;

      matrix[column * 3 * n.cells + row] =
        table[(column / n.cells * 3 + row / n.cells) * n.table + (j + n.lags / 2) * LAGS + i + SIDE];
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
  const Count n = CountOf(c);
  double      along[2][SIDE][SAM_COMPLIANCE_DEGREE + 1];

  for (PetscInt k = 0; k < SIDE + n.rows; k++) {
    const double from = c->center[k / SIDE] - c->half[k / SIDE] + (double)(k % SIDE) * d[k / SIDE];

    SamComplianceMeans(c, k / SIDE, from, from + d[k / SIDE], along[k / SIDE][k % SIDE]);
  }
  for (PetscInt a = 0; a < 3; a++)
    for (PetscInt m = 0; m < c->modes; m++)
      for (PetscInt k = 0; k < n.cells; k++)
        means[((a * c->modes + m) * 3 + a) * n.cells + k] =
          along[0][k % SIDE][c->power[m][0]] * along[1][k / SIDE][c->power[m][1]];
}

/* Computes D G, the compliance of the tractions on the cells relative to the half-space's, minus the identity. */
static PetscErrorCode CreateRelative(SamCompliance c, SamPair pair, Mat d, PetscInt n, Mat *relative)
{
  const Count    count    = CountOf(c);
  const PetscInt unknowns = 3 * count.cells;
  const double   side[2]  = {2 * c->half[0] / SIDE, 2 * c->half[1] / (double)count.rows};
  Mat            matrix, means, solved, g;
  double        *values;

  PetscFunctionBegin;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, unknowns, unknowns, NULL, &matrix));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, unknowns, n, NULL, &means));
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

void SamComplianceMoveDatum(SamCompliance c, double datum)
{
  /* A line load displaces by -ln(|x|/D)/pi times a factor in x, y and z; that of a pair displaces both bodies. */
  const double young[2] = {c->young, c->young1}, poisson[2] = {c->poisson, c->poisson1}, change = log(c->datum / datum);

  for (PetscInt b = 0; b < (SamComplianceIsPair(c) ? 2 : 1) && !isinf(young[b]); b++) {
    const double shear     = young[b] / (2 * (1 + poisson[b]));
    const double factor[3] = {(1 - poisson[b]) / shear, 1 / shear, (1 - poisson[b]) / shear};

    for (PetscInt k = 0; k < 3; k++)
      for (PetscInt m = 0; m < c->modes; m++)
        if (!c->power[m][0])
          c->matrix[(k * c->modes + m) * (3 * c->modes + 1)] += change * factor[k] / PETSC_PI * 2 * c->half[0];
  }
  c->datum = datum;
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

/*
  Systems of frozen sets of cells with a border: equations of the unknowns as a whole, such as loads, and a multiplier
  of each.

  Directions have no part in the rows: what they have is taken off by the columns, brought to tractions by the
  approximate inverse. Residuals lose what lies along the columns. So the iteration does not see the border. The start
  meets the rows, and the multipliers are those of the columns in the residual that is left.
*/
#include <petsam/private/frozen.h>
#include <math.h>

#define SINGULAR 1e-12 /* a pivot relative to the largest number of its row below which the rows depend on each other */
#define ROUNDING 1e-14 /* part of a residual below which what is left of it is rounding */
#define PASSES   6     /* solutions for the residual of the one before: directions are in single precision */
#define SINGLE   1e-6  /* tolerance from which on that matters */

/* Finds the orthonormal basis of the columns; false: they depend on each other. */
static PetscErrorCode FindBasis(const SamFrozen *f, SamFrozenBorder *b, PetscBool *regular)
{
  const PetscInt n = SamFrozenSize(f);
  double         dots[SAM_COMPONENTS], square, whole;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < b->count; k++) {
    PetscCall(PetscMalloc1(n, &b->unit[k]));
    PetscCall(PetscArraycpy(b->unit[k], b->column[k], n));
    PetscCall(SamFrozenDots(f, 1, &b->column[k], b->column[k], &whole));
    for (PetscInt twice = 0; twice < 2; twice++) {
      PetscCall(SamFrozenDots(f, k, b->unit, b->unit[k], dots));
      for (PetscInt l = 0; l < k; l++) {
        b->triangle[l][k] += dots[l];
        for (PetscInt m = 0; m < n; m++) b->unit[k][m] -= dots[l] * b->unit[l][m];
      }
    }
    PetscCall(SamFrozenDots(f, 1, &b->unit[k], b->unit[k], &square));
    b->triangle[k][k] = sqrt(square);
    *regular          = *regular && square > SINGULAR * whole ? PETSC_TRUE : PETSC_FALSE;
    for (PetscInt m = 0; square > 0 && m < n; m++) b->unit[k][m] /= b->triangle[k][k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Inverts a small matrix by Gauss and Jordan's elimination with row pivots; false: it is singular. */
static PetscBool Invert(PetscInt n, double A[][SAM_COMPONENTS], double inverse[][SAM_COMPONENTS])
{
  double size[SAM_COMPONENTS];

  for (PetscInt i = 0; i < n; i++) {
    size[i] = 0;
    for (PetscInt j = 0; j < n; j++) {
      size[i]       = PetscMax(size[i], fabs(A[i][j]));
      inverse[i][j] = i == j;
    }
    if (!(size[i] > 0)) return PETSC_FALSE;
  }
  for (PetscInt c = 0; c < n; c++) {
    PetscInt best = c;

    for (PetscInt i = c + 1; i < n; i++)
      if (fabs(A[i][c]) * size[best] > fabs(A[best][c]) * size[i]) best = i;
    if (!(fabs(A[best][c]) > SINGULAR * size[best])) return PETSC_FALSE;
    for (PetscInt j = 0; j < n; j++) {
      const double a = A[c][j], b = inverse[c][j];

      A[c][j]          = A[best][j];
      A[best][j]       = a;
      inverse[c][j]    = inverse[best][j];
      inverse[best][j] = b;
    }
    size[best] = size[c];
    for (PetscInt j = 0; j < n; j++) inverse[c][j] /= A[c][c];
    for (PetscInt j = n - 1; j >= c; j--) A[c][j] /= A[c][c]; /* the pivot last */
    for (PetscInt i = 0; i < n; i++) {
      const double part = A[i][c];

      for (PetscInt j = 0; i != c && j < n; j++) {
        A[i][j] -= part * A[c][j];
        inverse[i][j] -= part * inverse[c][j];
      }
    }
  }
  return PETSC_TRUE;
}

PetscErrorCode SamFrozenSetBorder(SamFrozen *f, PetscInt count, double *const rows[], double *const columns[],
                                  PetscBool *regular)
{
  SamFrozenBorder b = {.count = count};
  double          products[SAM_COMPONENTS][SAM_COMPONENTS], column[SAM_COMPONENTS];

  PetscFunctionBegin;
  *regular = PETSC_TRUE;
  for (PetscInt k = 0; k < count; k++) {
    b.row[k]    = rows[k];
    b.column[k] = columns[k];
  }
  PetscCall(FindBasis(f, &b, regular));
  for (PetscInt k = 0; k < count; k++) {
    PetscCall(PetscMalloc1(SamFrozenSize(f), &b.spread[k]));
    PetscCall(SamFrozenPrecondition(f, b.column[k], b.spread[k]));
    PetscCall(SamFrozenDots(f, count, b.row, b.spread[k], column));
    for (PetscInt i = 0; i < count; i++) products[i][k] = column[i];
  }
  if (!Invert(count, products, b.inverse)) *regular = PETSC_FALSE;
  f->border = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenClearBorder(SamFrozen *f)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < f->border.count; k++) {
    PetscCall(PetscFree(f->border.row[k]));
    PetscCall(PetscFree(f->border.column[k]));
    PetscCall(PetscFree(f->border.spread[k]));
    PetscCall(PetscFree(f->border.unit[k]));
  }
  f->border.count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the multipliers whose columns make up the residual. */
static PetscErrorCode FindMultipliers(const SamFrozen *f, const double residual[], double multipliers[])
{
  const SamFrozenBorder *b = &f->border;

  PetscFunctionBegin;
  PetscCall(SamFrozenDots(f, b->count, b->unit, residual, multipliers));
  for (PetscInt k = b->count - 1; k >= 0; k--) {
    for (PetscInt l = k + 1; l < b->count; l++) multipliers[k] -= b->triangle[k][l] * multipliers[l];
    multipliers[k] /= b->triangle[k][k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the displacements of a product to sums of them, or with `take` replaces them by these. */
static PetscErrorCode AddDisplacements(SamFrozen *f, double times, const Vec sums[2], PetscBool take)
{
  PetscFunctionBegin;
  for (int c = 0; c < 2; c++) {
    const Vec u = c ? f->u_t : f->u_z;

    PetscCall(take ? VecCopy(sums[c], u) : VecAXPY(sums[c], times, u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets what residuals are relative to: the right-hand side, or if that is 0, or no more than rounding of earlier
   systems beside the numbers of the rows, what the start leaves of it; 0 if that is rounding, as where the rows
   determine the unknowns. `error`: what the start leaves relative to that, at least 1; `least`: its rounding. */
static PetscErrorCode SetReference(SamFrozen *f, const double b[], const double residual[], PetscReal *error,
                                   PetscReal *least)
{
  const PetscInt n = SamFrozenSize(f);
  double        *work, square, whole, left;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &work));
  PetscCall(PetscArraycpy(work, b, n));
  PetscCall(SamFrozenDots(f, 1, &work, work, &square));
  PetscCall(PetscArraycpy(work, residual, n));
  PetscCall(SamFrozenDots(f, 1, &work, work, &whole));
  PetscCall(SamFrozenTakeColumns(f, work));
  PetscCall(SamFrozenDots(f, 1, &work, work, &left));
  if (square <= SINGLE * SINGLE * left) square = left <= ROUNDING * ROUNDING * whole ? 0 : left;
  f->reference = sqrt(square);
  *error       = square > 0 ? PetscMax(1, sqrt(left / square)) : 0;
  *least       = square > 0 ? ROUNDING * sqrt(whole / square) : 0;
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds the spread columns that make x meet the rows, and takes their products off the residual; `sums` follow. The start
  meets the rows, but directions are in single precision. `work`: scratch.
*/
static PetscErrorCode MeetRows(SamFrozen *f, const double given[], double x[], double residual[], double work[],
                               const Vec sums[2])
{
  const PetscInt n = SamFrozenSize(f);
  double         missing[SAM_COMPONENTS], *change;

  PetscFunctionBegin;
  PetscCall(SamFrozenDots(f, f->border.count, f->border.row, x, missing));
  for (PetscInt k = 0; k < f->border.count; k++) missing[k] = given[k] - missing[k];
  PetscCall(PetscCalloc1(n, &change));
  SamFrozenAddSpread(f, 1, missing, change);
  PetscCall(SamFrozenApply(f, change, work));
  PetscCall(AddDisplacements(f, 1, sums, PETSC_FALSE));
  for (PetscInt m = 0; m < n; m++) {
    x[m] += change[m];
    residual[m] -= work[m];
  }
  PetscCall(PetscFree(change));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves for a residual, which is scaled to the order of one, as the range of single precision is small, as far as its
  digits reach; adds to x. `error` is that of x, before and after.
*/
static PetscErrorCode AddSolution(SamFrozen *f, double residual[], double x[], double right[], double dx[],
                                  const Vec sums[2], PetscReal *error)
{
  const PetscInt  n     = SamFrozenSize(f);
  const double    scale = f->reference;
  const PetscReal rtol  = f->rtol;

  PetscFunctionBegin;
  for (PetscInt m = 0; m < n; m++) right[m] = residual[m] / scale;
  f->reference = 1;
  f->rtol      = PetscMax(rtol, SINGLE * *error);
  PetscCall(SamKrylovSolve(f, right, dx, residual, error));
  f->reference = scale;
  f->rtol      = rtol;
  PetscCall(AddDisplacements(f, scale, sums, PETSC_FALSE));
  for (PetscInt m = 0; m < n; m++) {
    x[m] += scale * dx[m];
    residual[m] *= scale;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenSolveBordered(SamFrozen *f, const double b[], const double given[], double x[],
                                      double multipliers[], PetscReal *error)
{
  const PetscInt  n     = SamFrozenSize(f);
  const PetscReal rtol  = f->rtol;
  const PetscBool tight = rtol < SINGLE ? PETSC_TRUE : PETSC_FALSE;
  double         *right, *residual, *dx;
  PetscReal       last, least = 0;
  Vec             sums[2];

  PetscFunctionBegin;
  f->single = f->loose = tight ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscMalloc3(n, &right, n, &residual, n, &dx));
  for (int c = 0; c < 2; c++) PetscCall(SamGridCreateVec(f->grid, c + 1, &sums[c]));
  PetscCall(PetscArrayzero(x, n));
  PetscCall(PetscArraycpy(residual, b, n));
  PetscCall(MeetRows(f, given, x, residual, right, sums));
  PetscCall(SetReference(f, b, residual, error, &least));
  last    = *error;
  f->rtol = PetscMax(rtol, least);
  for (PetscInt pass = 0; pass < PASSES && f->reference > 0; pass++) {
    PetscCall(AddSolution(f, residual, x, right, dx, sums, error));
    if ((*error <= f->rtol && (pass > 0 || !tight)) || *error > 0.5 * last) break;
    if (tight) PetscCall(MeetRows(f, given, x, residual, right, sums));
    last = *error;
  }
  f->reference = 0;
  f->rtol      = rtol;
  PetscCall(AddDisplacements(f, 1, sums, PETSC_TRUE));
  PetscCall(FindMultipliers(f, residual, multipliers));
  for (int c = 0; c < 2; c++) PetscCall(VecDestroy(&sums[c]));
  PetscCall(PetscFree3(right, residual, dx));
  f->single = f->loose = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

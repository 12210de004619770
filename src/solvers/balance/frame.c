/* The frame: small dense algebra of at most three components. */
#include "projectionimpl.h"
#include <petsam/private/balance.h>
#include <math.h>

const PetscInt SamComponentsOf[2][3] = {{SAM_COMPONENT_N, SAM_COMPONENT_MX, SAM_COMPONENT_MY},
                                        {SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ}};

SamBalance SamControlGetBalance(const SamControl *control, SamBalanceKind kind)
{
  SamBalance balance = {.kind = kind};

  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt c = SamComponentsOf[kind][k];

    balance.force[k] = control->force[c];
    if (control->force[c])
      balance.load[k] = control->value[c];
    else
      balance.rigid[k] = control->value[c];
  }
  return balance;
}

void SamFrameGetComponent(SamGrid grid, SamBalanceKind kind, PetscInt k, double row[3])
{
  const double xc = grid->center[0], yc = grid->center[1], L = grid->length;
  const double normal[3][3]     = {{1, 0, 0}, {-yc, L, 0}, {xc, 0, L}};
  const double tangential[3][3] = {{1, 0, 0}, {0, 1, 0}, {-yc, xc, L}};

  for (PetscInt i = 0; i < 3; i++) row[i] = kind == SAM_BALANCE_NORMAL ? normal[k][i] : tangential[k][i];
}

double SamOrthonormalize(PetscInt m, double basis[3][3], const double row[3], double lower[3])
{
  double rest[3] = {row[0], row[1], row[2]}, norm;

  for (PetscInt k = 0; k < m; k++) lower[k] = 0;
  for (PetscInt pass = 0; pass < 2; pass++) /* a second pass suffices */
    for (PetscInt k = 0; k < m; k++) {
      const double part = SamFrameDot(rest, basis[k]);

      lower[k] += part;
      for (PetscInt i = 0; i < 3; i++) rest[i] -= part * basis[k][i];
    }
  norm = lower[m] = sqrt(SamFrameDot(rest, rest));
  for (PetscInt i = 0; i < 3; i++) basis[m][i] = rest[i] / (norm > 0 ? norm : 1);
  return norm;
}

void SamFrameMove(const SamFrame *f, double times, double a[3])
{
  a[1] += times * f->ahead * a[2];
}

PetscErrorCode SamFrameSet(SamFrame *f, SamGrid grid, const SamBalance *balance)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(f, sizeof(*f)));
  f->grid  = grid;
  f->kind  = balance->kind;
  f->most  = INFINITY;
  f->dxi   = grid->dx / grid->length;
  f->deta  = grid->dy / grid->length;
  f->xi0   = (0.5 - 0.5 * (double)grid->nx) * f->dxi;
  f->ahead = balance->ahead / grid->length;
  for (PetscInt k = 0; k < 3; k++) {
    double row[3];

    SamFrameGetComponent(grid, f->kind, k, row);
    if (balance->force[k]) {
      const PetscInt m = f->count;

      (void)SamOrthonormalize(m, f->basis, row, f->lower[m]);
      f->target[m] = balance->load[k] / (grid->dx * grid->dy);
      for (PetscInt i = 0; i < m; i++) f->target[m] -= f->lower[m][i] * f->target[i];
      f->target[m] /= f->lower[m][m];
      f->component[m] = k;
      f->count++;
    } else {
      for (PetscInt i = 0; i < 3; i++) f->fixed[i] += balance->rigid[k] * row[i];
    }
  }
  SamFrameMove(f, 1, f->fixed);
  for (PetscInt k = 0; k < f->count; k++) {
    PetscCall(PetscArraycpy(f->motion[k], f->basis[k], 3));
    SamFrameMove(f, 1, f->motion[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrameSetGiven(SamFrame *f, SamGrid grid, const SamBalance *balance)
{
  SamBalance given = *balance;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++) given.force[k] = PETSC_FALSE;
  PetscCall(SamFrameSet(f, grid, &given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFrameGetRigid(const SamFrame *f, const double a[3], SamBalance *balance)
{
  double d[3], still[3] = {a[0], a[1], a[2]};

  SamFrameMove(f, -1, still);
  /* a = basis' b with b = lower' d */
  for (PetscInt k = f->count - 1; k >= 0; k--) {
    double b = SamFrameDot(still, f->basis[k]);

    for (PetscInt m = k + 1; m < f->count; m++) b -= f->lower[m][k] * d[m];
    d[k]                            = b / f->lower[k][k];
    balance->rigid[f->component[k]] = d[k];
  }
}

/* Rounding of an entry of a Gram matrix, relative to the largest entry */
#define DIAGONAL_ROUNDING 1e-14
/* Eigenvalues below this part of the largest one are rounding. */
#define SINGULAR 1e-13

double SamFrameSolveSeen(const SamFrame *f, const double gram[SAM_GRAM], const double sums[3], double a[3],
                         double unseen[3])
{
  const double G[3][3] = {{gram[0], gram[1], gram[2]}, {gram[1], gram[3], gram[4]}, {gram[2], gram[4], gram[5]}};
  double       A[3][3], scaled[9], b[3], x[3], unit[3], most = 0, all = 0, left = 0;

  for (PetscInt k = 0; k < f->count; k++) {
    b[k] = 0;
    for (PetscInt i = 0; i < 3; i++) b[k] += f->basis[k][i] * sums[i];
    for (PetscInt m = 0; m < f->count; m++) {
      A[k][m] = 0;
      for (PetscInt i = 0; i < 3; i++)
        for (PetscInt j = 0; j < 3; j++) A[k][m] += f->basis[k][i] * G[i][j] * f->basis[m][j];
    }
    most = PetscMax(most, A[k][k]);
  }
  /* In units for which a diagonal entry is 1, unless the entry is the rounding of a sum of zeros. */
  for (PetscInt k = 0; k < f->count; k++)
    unit[k] = 1 / sqrt(A[k][k] > DIAGONAL_ROUNDING * most ? A[k][k] : (most > 0 ? most : 1));
  for (PetscInt k = 0; k < f->count; k++) {
    b[k] *= unit[k];
    for (PetscInt m = 0; m < f->count; m++) scaled[k * f->count + m] = A[k][m] *= unit[k] * unit[m];
  }
  SamSolveSymmetric(f->count, scaled, b, SINGULAR, x);
  for (PetscInt i = 0; i < 3; i++) a[i] = unseen[i] = 0;
  for (PetscInt k = 0; k < f->count; k++) {
    double r = b[k];

    for (PetscInt m = 0; m < f->count; m++) r -= A[k][m] * x[m];
    all += b[k] * b[k];
    left += r * r;
    for (PetscInt i = 0; i < 3; i++) {
      a[i] += unit[k] * x[k] * f->basis[k][i];
      unseen[i] += unit[k] * r * f->basis[k][i];
    }
  }
  return all > 0 ? sqrt(left / all) : 0;
}

void SamFrameSolve(const SamFrame *f, const double gram[SAM_GRAM], const double sums[3], double a[3])
{
  double unseen[3];

  (void)SamFrameSolveSeen(f, gram, sums, a, unseen);
}

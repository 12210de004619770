/*
  The spectral preconditioner.

  On an infinite surface a wave of pressure exp(i k.x) gives the displacement 2 pi A/|k| times itself, A = pair.normal, so
  that |k| is the inverse up to a factor. For shear the symbol is (2 pi (A + B)/|k|)(I - nu kk'/|k|^2), B = pair.shear_xx,
  nu = B/(A + B), with the inverse (|k|/(2 pi (A + B)))(I + nu/(1 - nu) kk'/|k|^2). Here they act on the grid made
  periodic, which costs a quarter of a padded transform and conditions as well. The symbol is computed as it is used.
*/
#include "complianceimpl.h"
#include <math.h>

typedef struct {
  double step[2]; /* wave number of the first harmonic, 2 pi/period, 1/m */
  double gain;    /* 1/(2 pi A) or 1/(2 pi (A + B)), and the transforms' normalisation */
  double extra;   /* nu/(1 - nu) */
  double mean;    /* stands for |k| at k = 0 */
} Symbol;

static PetscErrorCode GetSymbol(SamCompliance C, PetscBool tangential, Symbol *symbol)
{
  const SamPair *pair  = &C->pair;
  const double   local = tangential ? pair->shear + pair->shear_xx : pair->normal;
  PetscInt       hx, hy;

  PetscFunctionBegin;
  PetscCall(SamFourierGetPeriods(C->fourier, &hx, &hy));
  symbol->step[0] = 2 * PETSC_PI / ((double)hx * C->grid->dx);
  symbol->step[1] = 2 * PETSC_PI / ((double)hy * C->grid->dy);
  symbol->gain    = 1 / (2 * PETSC_PI * local * (double)hx * (double)hy);
  symbol->extra   = tangential ? pair->shear_xx / pair->shear : 0;
  symbol->mean    = 0.5 * PetscMin(symbol->step[0], symbol->step[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double WaveNumberY(const SamFourierBlock *block, const Symbol *s, PetscInt m)
{
  return s->step[1] * (double)(2 * m <= block->hy ? m : m - block->hy);
}

static void FilterNormal(const SamFourierBlock *block, const void *context)
{
  const Symbol *s = (const Symbol *)context;

  for (PetscInt b = 0; b < block->columns; b++) {
    double (*column)[2] = block->data[0] + (ptrdiff_t)b * block->stride;
    const double kx     = s->step[0] * (double)(block->first + b);

    for (PetscInt m = 0; m < block->hy; m++) {
      const double ky = WaveNumberY(block, s, m), k = sqrt(kx * kx + ky * ky), gain = s->gain * PetscMax(k, s->mean);

      column[m][0] *= gain;
      column[m][1] *= gain;
    }
  }
}

static void FilterTangential(const SamFourierBlock *block, const void *context)
{
  const Symbol *s = (const Symbol *)context;

  for (PetscInt b = 0; b < block->columns; b++) {
    double (*x)[2] = block->data[0] + (ptrdiff_t)b * block->stride, (*y)[2] = block->data[1] + (ptrdiff_t)b * block->stride;
    const double kx = s->step[0] * (double)(block->first + b);

    for (PetscInt m = 0; m < block->hy; m++) {
      const double ky = WaveNumberY(block, s, m), k2 = kx * kx + ky * ky, gain = s->gain * PetscMax(sqrt(k2), s->mean);
      /* the two waves at the Nyquist frequency are one: the sign of its cross term is not defined, and none is right */
      const double cross = (2 * m == block->hy || 2 * (block->first + b) == block->hx) ? 0 : (k2 > 0 ? s->extra / k2 : 0);
      const double along = k2 > 0 ? s->extra / k2 : 0;

      for (PetscInt r = 0; r < 2; r++) {
        const double vx = x[m][r], vy = y[m][r];

        x[m][r] = gain * (vx + along * kx * kx * vx + cross * kx * ky * vy);
        y[m][r] = gain * (vy + along * ky * ky * vy + cross * kx * ky * vx);
      }
    }
  }
}

static PetscErrorCode Precondition(SamCompliance C, PetscInt components, Vec in, Vec out)
{
  Symbol        symbol;
  const double *x;
  double       *y;
  const double *from[2];
  double       *to[2];

  PetscFunctionBegin;
  PetscCall(GetSymbol(C, components == 2 ? PETSC_TRUE : PETSC_FALSE, &symbol));
  if (in == out) {
    PetscCall(VecGetArray(out, &y));
    x = y;
  } else {
    PetscCall(VecGetArrayRead(in, &x));
    PetscCall(VecGetArrayWrite(out, &y));
  }
  for (PetscInt k = 0; k < components; k++) {
    from[k] = x + k * C->grid->cells;
    to[k]   = y + k * C->grid->cells;
  }
  PetscCall(SamFourierApply(C->fourier, SAM_FOURIER_PERIODIC, components, from, components, to, components == 2 ? FilterTangential : FilterNormal, &symbol));
  if (in == out) {
    PetscCall(VecRestoreArray(out, &y));
  } else {
    PetscCall(VecRestoreArrayWrite(out, &y));
    PetscCall(VecRestoreArrayRead(in, &x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompliancePreconditionNormal(SamCompliance C, Vec residual, Vec p)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PRECONDITION_NORMAL], 0, 0, 0, 0));
  PetscCall(Precondition(C, 1, residual, p));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PRECONDITION_NORMAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCompliancePreconditionTangential(SamCompliance C, Vec residual, Vec q)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PRECONDITION_TANGENTIAL], 0, 0, 0, 0));
  PetscCall(Precondition(C, 2, residual, q));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PRECONDITION_TANGENTIAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

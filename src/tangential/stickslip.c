/* What the tangential methods share: slip increment, energy, residual, fit of the rigid motion. */
#include "tangentialimpl.h"
#include <math.h>

/* The columns between which each row has contact: loops run over these only. */
static PetscErrorCode FindRows(SamStickSlip *w)
{
  PetscInt *first, *last;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(w->rows, &first, w->rows, &last));
  for (PetscInt j = 0; j < w->rows; j++) {
    const double *b = w->bound + j * w->nx;

    first[j] = 0;
    last[j]  = w->nx;
    while (first[j] < w->nx && b[first[j]] <= 0) first[j]++;
    while (last[j] > first[j] && b[last[j] - 1] <= 0) last[j]--;
  }
  w->first = first;
  w->last  = last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipCreate(SamTangential solver, SamTangentialLevel *level, SamStickSlip *w)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(w, sizeof(*w)));
  w->solver = solver;
  w->level  = level;
  w->frame  = &level->frame;
  w->nx     = level->grid->nx;
  w->rows   = level->grid->rows;
  w->cells  = level->grid->cells;
  for (PetscInt c = 0; c < 3; c++) w->motion[c] = level->has_motion ? level->rigid[c] : level->frame.fixed[c];
  PetscCall(SamComplianceGetSelfInfluence(level->compliance, NULL, &w->self));
  PetscCall(VecDuplicate(level->q, &w->vs));
  PetscCall(VecGetArrayRead(level->bound, &w->bound));
  if (level->offset) PetscCall(VecGetArrayRead(level->offset, &w->offset));
  PetscCall(VecGetArray(level->q, &w->q));
  PetscCall(VecGetArray(w->vs, &w->s));
  PetscCall(FindRows(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipDestroy(SamStickSlip *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArrayRead(w->level->bound, &w->bound));
  if (w->level->offset) PetscCall(VecRestoreArrayRead(w->level->offset, &w->offset));
  PetscCall(VecRestoreArray(w->level->q, &w->q));
  PetscCall(VecRestoreArray(w->vs, &w->s));
  PetscCall(VecDestroy(&w->vs));
  PetscCall(PetscFree2(w->first, w->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipComputeSlip(SamStickSlip *w)
{
  const SamFrame *f = w->frame;

  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->q, &w->q));
  PetscCall(VecRestoreArray(w->vs, &w->s));
  PetscCall(SamTangentialApply(w->solver, w->level, w->level->q, w->vs));
  PetscCall(VecGetArray(w->level->q, &w->q));
  PetscCall(VecGetArray(w->vs, &w->s));
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = w->first[j]; i < w->last[j]; i++) {
      const PetscInt k = j * w->nx + i, l = k + w->cells;

      w->s[k] += (w->offset ? w->offset[k] : 0) - SamFrameX(w->motion, eta);
      w->s[l] += (w->offset ? w->offset[l] : 0) - SamFrameY(w->motion, f->xi0 + (double)i * f->dxi);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipEnergy(const SamStickSlip *w, double *energy)
{
  const SamFrame *f = w->frame;
  double          a[3];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) a[c] = w->motion[c] - 2 * f->fixed[c];
  *energy = 0;
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = w->first[j]; i < w->last[j]; i++) {
      const PetscInt k = j * w->nx + i, l = k + w->cells;

      *energy += 0.5 * w->q[k] * (w->s[k] + (w->offset ? w->offset[k] : 0) + SamFrameX(a, eta));
      *energy += 0.5 * w->q[l] * (w->s[l] + (w->offset ? w->offset[l] : 0) + SamFrameY(a, f->xi0 + (double)i * f->dxi));
    }
  }
  PetscCall(SamSum(w->level->grid->comm, 1, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fits the motion: least squares of s over the tangent space, the sets taken from s as it is, or all of it stick. */
static PetscErrorCode FitMotion(SamStickSlip *w, PetscBool stick)
{
  const SamFrame *f = w->frame;
  double          sums[3 + SAM_GRAM] = {0}, a[3];
  const double    inverse = 1 / w->self;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;
    double       row[3 + SAM_GRAM] = {0};

    for (PetscInt i = w->first[j]; i < w->last[j]; i++) {
      const PetscInt k = j * w->nx + i, l = k + w->cells;
      const double   b = w->bound[k], xi = f->xi0 + (double)i * f->dxi;
      double         yx, yy, n, tx, ty, hxx = 1, hxy = 0, hyy = 1;

      if (b <= 0) continue;
      tx = w->s[k];
      ty = w->s[l];
      yx = w->q[k] - inverse * tx;
      yy = w->q[l] - inverse * ty;
      n  = yx * yx + yy * yy;
      if (n > b * b && !stick) { /* the derivative of the projection on the disc */
        const double scale = b / (n * sqrt(n));

        hxx = scale * yy * yy;
        hxy = -scale * yx * yy;
        hyy = scale * yx * yx;
        n   = tx;
        tx  = hxx * n + hxy * ty;
        ty  = hxy * n + hyy * ty;
      }
      row[0] += tx;
      row[1] += ty;
      row[2] += xi * ty - eta * tx;
      SamGramAddTangential(row + 3, hxx, hxy, hyy, xi, eta);
    }
    for (PetscInt c = 0; c < 3 + SAM_GRAM; c++) sums[c] += row[c];
  }
  PetscCall(SamSum(w->level->grid->comm, 3 + SAM_GRAM, sums));
  SamFrameSolve(f, sums + 3, sums, a);
  for (PetscInt c = 0; c < 3; c++) w->motion[c] += a[c];
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = w->first[j]; i < w->last[j]; i++) {
      const PetscInt k = j * w->nx + i;

      w->s[k] -= SamFrameX(a, eta);
      w->s[k + w->cells] -= SamFrameY(a, f->xi0 + (double)i * f->dxi);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipStart(SamStickSlip *w)
{
  PetscFunctionBegin;
  PetscCall(SamStickSlipComputeSlip(w));
  if (!w->level->has_motion && w->frame->count) PetscCall(FitMotion(w, PETSC_TRUE));
  /* the fit and the sets depend on each other */
  for (PetscInt sweep = 0; sweep < 4; sweep++) PetscCall(SamStickSlipMeasure(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipMeasure(SamStickSlip *w)
{
  const double inverse = 1 / w->self;
  double       sums[4] = {0, 0, 0, 0};

  PetscFunctionBegin;
  if (w->frame->count) PetscCall(FitMotion(w, PETSC_FALSE));
  for (PetscInt j = 0; j < w->rows; j++) {
    double row[4] = {0, 0, 0, 0};

    for (PetscInt i = w->first[j]; i < w->last[j]; i++) {
      const PetscInt k = j * w->nx + i, l = k + w->cells;
      const double   b = w->bound[k], yx = w->q[k] - inverse * w->s[k], yy = w->q[l] - inverse * w->s[l];
      const double   n2 = yx * yx + yy * yy, scale = n2 > b * b ? b / sqrt(n2) : 1;
      double         rx, ry;

      if (b <= 0) continue;
      rx = w->q[k] - scale * yx;
      ry = w->q[l] - scale * yy;
      row[0] += rx * rx + ry * ry;
      row[1] += w->q[k] * w->q[k] + w->q[l] * w->q[l];
      row[2] += scale * scale * (yx * yx + yy * yy);
      row[3] += SAM_SHEAR_FLOOR * SAM_SHEAR_FLOOR * b * b;
    }
    for (PetscInt c = 0; c < 4; c++) sums[c] += row[c];
  }
  PetscCall(SamSum(w->level->grid->comm, 4, sums));
  w->error = sums[0] != 0 ? sqrt(sums[0] / PetscMax(sums[3], PetscMax(sums[1], sums[2]))) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

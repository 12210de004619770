/*
  Step 1 of the active-set method: the gap, the set A and the motion that fits A, the error, and the estimate of the
  gap's rounding.
*/
#include "activesetimpl.h"
#include <math.h>

/* Largest rounding of g at the end, relative to the tolerance */
#define DOUBT 0.03
/* Relative change of S p by the last projection of a solve, which restores exact equilibrium */
#define PROJECTION_ROUNDING 1e-9
/* g is recomputed at the latest when the error has fallen by this factor, as rounding may dominate the error then. */
#define FALL 1e-3

typedef SamActiveSet Work;

/* ---- the estimate of rounding ---- */

static double Tolerance(const Work *w)
{
  return PetscMax(w->level->rtol * w->displacement, w->floor);
}

/* True if single precision of S p suffices for the tolerance. */
static PetscBool IsSingleEnough(const Work *w)
{
  return SAM_SINGLE_ROUNDING <= DOUBT * w->level->rtol;
}

/* True if the rounding of g is small enough for the tolerance. */
static PetscBool IsTrusted(const Work *w)
{
  return w->rounding <= DOUBT * Tolerance(w);
}

PetscBool SamActiveSetIsStale(const Work *w)
{
  const double later = SAM_SINGLE_ROUNDING * w->error; /* rounding after the next product */

  return !IsTrusted(w) && (later <= DOUBT * Tolerance(w) || later <= FALL * w->rounding);
}

/* ---- the gap and the active set ---- */

/* Computes g = S p in single precision. */
static PetscErrorCode ApplySingle(Work *w)
{
  double most = 0, scale;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) most = w->p[k] > most ? w->p[k] : most;
  PetscCall(SamMax(w->level->grid->comm, 1, &most));
  if (most == 0) most = 1;
  for (PetscInt k = 0; k < w->cells; k++) w->z[k] = (float)(w->p[k] / most);
  PetscCall(SamLevelApplySingle(w->solver, w->level, 1 / w->self, w->z, w->z));
  scale = w->self * most;
  for (PetscInt k = 0; k < w->cells; k++) w->g[k] = scale * (double)w->z[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes g = S p. */
static PetscErrorCode Apply(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->traction, &w->p));
  PetscCall(VecRestoreArray(w->vg, &w->g));
  PetscCall(SamLevelApply(w->solver, w->level, w->level->traction, w->vg));
  PetscCall(VecGetArray(w->level->traction, &w->p));
  PetscCall(VecGetArray(w->vg, &w->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns g, which contains S p, into S p + h - motion; finds the maximum displacement and the floor by rounding of p. */
static PetscErrorCode FinishGap(Work *w)
{
  const SamGrid grid   = w->level->grid;
  double        max[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) max[1] = w->p[k] > max[1] ? w->p[k] : max[1];
  for (PetscInt j = 0; j < w->rows; j++) max[0] = SamLarger(max[0], SamActiveSetGapRow(w, SamActiveSetRow(w, j)));
  for (PetscInt k = 0; k < w->rows * w->blocks; k++) w->open[k] = -INFINITY;
  PetscCall(SamMax(grid->comm, 2, max));
  w->displacement = max[0];
  w->floor        = SamGapRounding(max[1], w->self, (double)grid->nx * (double)grid->ny, w->motion[0], max[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamActiveSetAddRow(SamGapSums row, double eta, SamTotal totals[])
{
  double sums[SAM_GAP_TOTALS] = {[SAM_GRAM] = row.g, -eta * row.g, row.xi_g};

  SamGramNormalRow(sums, row.count, row.xi, row.xi2, eta);
  SamAddAll(SAM_GAP_TOTALS, totals, sums);
}

/* Adds to `motion` the motion that fits the gap to the cells of these totals; their Gram matrix becomes w's. */
static PetscErrorCode Fit(Work *w, SamTotal totals[], double motion[3])
{
  double sums[SAM_GAP_TOTALS], a[3];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(w->level->grid->comm, SAM_GAP_TOTALS, totals, sums));
  PetscCall(PetscArraycpy(w->gram, sums, SAM_GRAM));
  SamFrameSolve(w->frame, w->gram, sums + SAM_GRAM, a);
  for (PetscInt c = 0; c < 3; c++) motion[c] += a[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  True if a block without pressure has no gap that `motion` could close. It is evaluated like the gaps, so that rounding
  makes no difference.
*/
static PetscBool IsClear(const Work *w, PetscInt block, SamRow row, const double motion[3])
{
  const double a = motion[0] - motion[1] * row.eta, b = motion[2];
  const double last = w->frame->xi0 + (double)(row.column + row.count - 1) * row.dxi;

  return !w->busy[block] && w->open[block] > PetscMax(a + b * row.xi0, a + b * last);
}

/* Chooses A in a row, and marks its busy blocks, by the gap after a correction by `motion`. */
static SamGapSums ChooseRow(Work *w, PetscInt j, double ease, const double motion[3])
{
  SamGapSums sums = {0};

  for (PetscInt i = 0, block = j * w->blocks; i < w->nx; i += SAM_ROW_BLOCK, block++) {
    const SamRow row = SamFrameRow(w->frame, j, i, PetscMin(i + SAM_ROW_BLOCK, w->nx));

    if (IsClear(w, block, row, motion)) continue; /* it has no cell of A, and stays without */
    w->busy[block] = SamActiveSetChooseRow(w, row, ease, motion, &sums) ? 1 : 0;
  }
  return sums;
}

/* Chooses A by the gap after a correction by `motion`, and adds to `motion` the fit to A. */
static PetscErrorCode Choose(Work *w, double ease, double motion[3])
{
  SamTotal totals[SAM_GAP_TOTALS] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++)
    SamActiveSetAddRow(ChooseRow(w, j, ease, motion), SamFrameEta(w->frame, j), totals);
  PetscCall(Fit(w, totals, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the motion, and updates the gap and the error, but not A. */
static PetscErrorCode Move(Work *w, const double motion[3])
{
  double error = 0;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) w->motion[c] += motion[c];
  for (PetscInt j = 0; j < w->rows; j++)
    error = SamLarger(error, SamActiveSetMoveRow(w, SamActiveSetRow(w, j), motion));
  PetscCall(SamMax(w->level->grid->comm, 1, &error));
  w->error = error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamActiveSetChoose(Work *w, double patch, SamTotal contact[])
{
  double motion[3] = {0, 0, 0};

  PetscFunctionBegin;
  if (contact)
    PetscCall(Fit(w, contact, motion));
  else
    PetscCall(Choose(w, 0, motion));
  PetscCall(Choose(w, 1 / (patch * w->self), motion));
  PetscCall(Move(w, motion));
  w->rounding = SamLarger(w->rounding, SAM_SINGLE_ROUNDING * w->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamActiveSetRefresh(Work *w)
{
  PetscBool single = IsSingleEnough(w), found;

  PetscFunctionBegin;
  if (single) {
    PetscCall(ApplySingle(w));
    PetscCall(FinishGap(w));
    if (w->floor > 0) single = PETSC_FALSE; /* the displacement is mere rounding in single precision */
  }
  if (!single) {
    /* The steps so far have kept equilibrium only to the rounding of single precision. */
    PetscCall(SamFrameProjectNormalBetween(w->frame, w->p, &found));
    PetscCall(Apply(w));
    PetscCall(FinishGap(w));
  }
  w->rounding = single ? SAM_SINGLE_ROUNDING * w->displacement : 0;
  PetscCall(SamActiveSetChoose(w, SAM_PATCH, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamActiveSetStart(Work *w)
{
  const double *u;

  PetscFunctionBegin;
  if (!SamLevelHasProduct(w->level)) {
    PetscCall(SamActiveSetRefresh(w));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecGetArrayRead(w->level->product->field, &u));
  PetscCall(PetscArraycpy(w->g, u, w->cells));
  PetscCall(VecRestoreArrayRead(w->level->product->field, &u));
  w->rounding = w->level->product->rounding;
  PetscCall(FinishGap(w));
  PetscCall(SamActiveSetChoose(w, SAM_PATCH, NULL));
  if (SamActiveSetIsStale(w)) PetscCall(SamActiveSetRefresh(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamActiveSetKeepProduct(Work *w)
{
  double *u;

  PetscFunctionBegin;
  if (!w->level->product) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayWrite(w->level->product->field, &u));
  for (PetscInt j = 0; j < w->rows; j++) {
    const SamRow row = SamActiveSetRow(w, j);

    for (PetscInt i = 0; i < row.count; i++)
      u[row.first + i] =
        w->g[row.first + i] - w->h[row.first + i] + SamFrameNormal(w->motion, row.xi0 + (double)i * row.dxi, row.eta);
  }
  PetscCall(VecRestoreArrayWrite(w->level->product->field, &u));
  SamLevelKeepProduct(w->level, w->rounding + PROJECTION_ROUNDING * w->displacement);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamActiveSetIsSolved(Work *w, PetscBool *solved)
{
  double max = 0;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  if (!(w->error <= Tolerance(w)) || !IsTrusted(w)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < w->rows; j++) max = PetscMax(max, SamActiveSetDisplacementRow(w, SamActiveSetRow(w, j)));
  PetscCall(SamMax(w->level->grid->comm, 1, &max));
  w->displacement = max;
  *solved         = w->error <= Tolerance(w);
  PetscFunctionReturn(PETSC_SUCCESS);
}

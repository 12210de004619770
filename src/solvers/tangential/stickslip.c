/* Shared by tangential methods: the slip increment, the residual, and the fit of the rigid-body motion. */
#include <petsam/private/tangentialimpl.h>
#include <math.h>

/* A cell lies on its circle if |q|^2 is at least this part of the bound's square. */
#define ON_CIRCLE (1 - 1e-9)
/* Error of a start above which another fit of the motion is tried */
#define POOR_START 0.1

PetscErrorCode SamStickSlipCreate(SamSolver solver, SamLevel *level, PetscInt gap, SamStickSlip *w)
{
  const Vec offset = level->given[SAM_TANGENTIAL_OFFSET];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(w, sizeof(*w)));
  w->solver = solver;
  w->level  = level;
  w->frame  = &level->frame;
  w->nx     = level->grid->nx;
  w->rows   = level->grid->rows;
  w->cells  = level->grid->cells;
  for (PetscInt c = 0; c < 3; c++) w->motion[c] = level->rigid[c];
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, NULL, &w->self));
  PetscCall(SamGridCreateVec(level->grid, 2, &w->vs));
  PetscCall(VecGetArrayRead(level->given[SAM_TANGENTIAL_BOUND], &w->bound));
  if (offset) PetscCall(VecGetArrayRead(offset, &w->offset));
  PetscCall(VecGetArray(level->traction, &w->q));
  PetscCall(VecGetArray(w->vs, &w->s));
  PetscCall(SamRunsCreate(level->grid, w->bound, SamLevelHasProduct(level) ? w->q : NULL, gap, &w->runs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipDestroy(SamStickSlip *w)
{
  const Vec offset = w->level->given[SAM_TANGENTIAL_OFFSET];

  PetscFunctionBegin;
  PetscCall(VecRestoreArrayRead(w->level->given[SAM_TANGENTIAL_BOUND], &w->bound));
  if (offset) PetscCall(VecRestoreArrayRead(offset, &w->offset));
  PetscCall(VecRestoreArray(w->level->traction, &w->q));
  PetscCall(VecRestoreArray(w->vs, &w->s));
  PetscCall(VecDestroy(&w->vs));
  PetscCall(SamRunsDestroy(&w->runs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamStickSlipClearMargins(const SamStickSlip *w, float z[])
{
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt j = 0; j < w->rows; j++) {
      float *const row = z + c * (ptrdiff_t)w->cells + (ptrdiff_t)j * w->nx;
      PetscInt     end = 0;
      SamRow       run;

      for (PetscInt n = 0; SamStickSlipNext(w, j, &n, &run); end = run.column + run.count)
        (void)memset(row + end, 0, sizeof(*row) * (size_t)(run.column - end));
      (void)memset(row + end, 0, sizeof(*row) * (size_t)(w->nx - end));
    }
}

/* Adds `times` (offset minus motion) in the runs. */
static void AddGiven(const SamStickSlip *w, double s[], double times)
{
  SamRow row;

  for (PetscInt j = 0; j < w->rows; j++)
    for (PetscInt n = 0; SamStickSlipNext(w, j, &n, &row);)
      for (PetscInt i = 0; i < row.count; i++) {
        const ptrdiff_t k = row.first + i, l = k + w->cells;

        s[k] += times * ((w->offset ? w->offset[k] : 0) - SamFrameX(w->motion, row.eta));
        s[l] += times * ((w->offset ? w->offset[l] : 0) - SamFrameY(w->motion, row.xi0 + (double)i * row.dxi));
      }
}

PetscErrorCode SamStickSlipComputeSlip(SamStickSlip *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->traction, &w->q));
  PetscCall(VecRestoreArray(w->vs, &w->s));
  PetscCall(SamLevelApply(w->solver, w->level, w->level->traction, w->vs));
  PetscCall(VecGetArray(w->level->traction, &w->q));
  PetscCall(VecGetArray(w->vs, &w->s));
  AddGiven(w, w->s, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipKeepProduct(SamStickSlip *w, double rounding)
{
  double *u;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(w->level->product->field, &u));
  PetscCall(PetscArraycpy(u, w->s, 2 * w->cells));
  AddGiven(w, u, -1);
  PetscCall(VecRestoreArrayWrite(w->level->product->field, &u));
  SamLevelKeepProduct(w->level, rounding);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes, for at most SAM_CHUNK cells of a row, the sums of the slip in the tangent space with the phi, and the Gram
  matrix there. The tangent space is that of H, the derivative of the projection of y = q - inverse s onto the disc.
  With `inverse` 0 it is that of q: cells on their circles may slip along them. The second loop, with roots and
  divisions, runs only if a cell lies beyond its disc; `slips`: one does, so that the first loop would find the same.
*/
SAM_VECTORIZED static void FitCells(const SamStickSlip *w, SamRow row, double inverse, PetscBool slips,
                                    double sums[3 + SAM_GRAM])
{
  const double *restrict qx = w->q + row.first, *restrict qy = qx + w->cells, *restrict tx = w->s + row.first,
                         *restrict ty = tx + w->cells, *restrict bound = w->bound + row.first;
  double x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0, beyond = slips ? 1 : 0;

#pragma omp simd reduction(+ : x, y, turn, hxx, xi_hyy, xi2_hyy, beyond)
  for (int i = 0; i < (slips ? 0 : row.count); i++) {
    const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0;
    const double yx = qx[i] - inverse * tx[i], yy = qy[i] - inverse * ty[i];

    beyond += yx * yx + yy * yy > ON_CIRCLE * b * b ? in : 0;
    x += in * tx[i];
    y += in * ty[i];
    turn += in * xi * ty[i];
    hxx += in;
    xi_hyy += in * xi;
    xi2_hyy += in * xi * xi;
  }
  hyy = hxx;
  if (beyond > 0) {
    x = y = turn = hxx = hyy = xi_hyy = xi2_hyy = 0;
#pragma omp simd reduction(+ : x, y, turn, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy)
    for (int i = 0; i < row.count; i++) {
      const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0;
      const double yx = qx[i] - inverse * tx[i], yy = qy[i] - inverse * ty[i], n2 = yx * yx + yy * yy;
      const double over = b > 0 && n2 > ON_CIRCLE * b * b ? 1 / n2 : 0, s = over > 0 ? b * sqrt(n2) * over : in,
                   g   = s * over;
      const double gxx = s - g * yx * yx, gxy = -g * yx * yy, gyy = s - g * yy * yy;
      const double px = gxx * tx[i] + gxy * ty[i], py = gxy * tx[i] + gyy * ty[i];

      SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi);
    }
  }
  sums[0] += x;
  sums[1] += y;
  sums[2] += turn - row.eta * x;
  SamGramTangentialRow(sums + 3, (const double[6]){hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy}, row.eta);
}

/* True if the first cell, the last or the one between lies beyond its disc: most rows begin or end in slip. */
static PetscBool Slips(const SamStickSlip *w, SamRow row, double inverse)
{
  const int cells[] = {0, row.count / 2, row.count - 1};

  for (int k = 0; k < 3; k++) {
    const ptrdiff_t i = row.first + cells[k], j = i + w->cells;
    const double    b = w->bound[i], yx = w->q[i] - inverse * w->s[i], yy = w->q[j] - inverse * w->s[j];

    if (b > 0 && yx * yx + yy * yy > ON_CIRCLE * b * b) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Subtracts the rigid motion a from a row of slips. */
SAM_VECTORIZED static void SubtractRow(SamRow row, double *restrict sx, double *restrict sy, const double a[3])
{
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    sx[i] -= ax;
    sy[i] -= a1 + a2 * (row.xi0 + (double)i * row.dxi);
  }
}

/* Adds a to the motion. */
static void AddMotion(SamStickSlip *w, const double a[3])
{
  SamRow row;

  for (PetscInt c = 0; c < 3; c++) w->motion[c] += a[c];
  for (PetscInt j = 0; j < w->rows; j++)
    for (PetscInt n = 0; SamStickSlipNext(w, j, &n, &row);)
      SubtractRow(row, w->s + row.first, w->s + row.first + w->cells, a);
}

/* Fits the motion: least squares of s over the tangent space of q - inverse s. */
static PetscErrorCode FitMotion(SamStickSlip *w, double inverse)
{
  SamFrame moves                = *w->frame; /* its basis is that of motions */
  SamTotal totals[3 + SAM_GRAM] = {{0}};
  double   sums[3 + SAM_GRAM], a[3];
  SamRow   run;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    double row[3 + SAM_GRAM] = {0};

    for (PetscInt n = 0; SamStickSlipNext(w, j, &n, &run);)
      for (PetscInt i = run.column, last = i + run.count; i < last; i += SAM_CHUNK) {
        const SamRow chunk = SamFrameRow(w->frame, j, i, PetscMin(i + SAM_CHUNK, last));

        FitCells(w, chunk, inverse, Slips(w, chunk, inverse), row);
      }
    SamAddAll(3 + SAM_GRAM, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 3 + SAM_GRAM, totals, sums));
  PetscCall(PetscArraycpy(moves.basis[0], w->frame->motion[0], 9));
  SamFrameSolve(&moves, sums + 3, sums, a);
  AddMotion(w, a);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the error of the start. The fit of the motion and the tangent space depend on each other, hence the sweeps.
*/
static PetscErrorCode MeasureStart(SamStickSlip *w)
{
  PetscFunctionBegin;
  w->error = 0;
  for (PetscInt sweep = 0; sweep < 4; sweep++) {
    const double before = w->error;

    PetscCall(SamStickSlipMeasure(w));
    if (fabs(w->error - before) <= 1e-3 * w->error) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipStart(SamStickSlip *w)
{
  double motion[3], back[3], error;

  PetscFunctionBegin;
  if (SamLevelHasProduct(w->level)) {
    PetscCall(VecRestoreArray(w->vs, &w->s));
    PetscCall(VecCopy(w->level->product->field, w->vs));
    PetscCall(VecGetArray(w->vs, &w->s));
    AddGiven(w, w->s, 1);
  } else {
    PetscCall(SamStickSlipComputeSlip(w));
  }
  PetscCall(MeasureStart(w));
  if (w->error <= POOR_START || !w->frame->count) PetscFunctionReturn(PETSC_SUCCESS);
  /* Tests whether the motion fits better if cells on their circles may slip along them, and the others stick. */
  error = w->error;
  for (PetscInt c = 0; c < 3; c++) motion[c] = w->motion[c];
  PetscCall(FitMotion(w, 0));
  PetscCall(MeasureStart(w));
  if (w->error <= error) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < 3; c++) back[c] = motion[c] - w->motion[c];
  AddMotion(w, back);
  w->error = error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

SAM_VECTORIZED static void MeasureRow(const SamStickSlip *w, SamRow row, double squares[SAM_SQUARES])
{
  const double *restrict qx = w->q + row.first, *restrict qy = qx + w->cells, *restrict tx = w->s + row.first,
                         *restrict ty = tx + w->cells, *restrict bound = w->bound + row.first;
  const double inverse  = 1 / w->self;
  double       residual = 0, shear = 0, projected = 0, least = 0;

#pragma omp simd reduction(+ : residual, shear, projected, least)
  for (int i = 0; i < row.count; i++) {
    const double b = bound[i], yx = qx[i] - inverse * tx[i], yy = qy[i] - inverse * ty[i], n2 = yx * yx + yy * yy,
                 scale = SamDiscScale(n2, b);

    SAM_ADD_SQUARES(qx[i], qy[i], yx, yy, scale, n2, b);
  }
  SamSumSquares(squares, residual, shear, projected, least);
}

PetscErrorCode SamStickSlipSetError(SamStickSlip *w, const SamTotal squares[SAM_SQUARES])
{
  double sums[SAM_SQUARES];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(w->level->grid->comm, SAM_SQUARES, squares, sums));
  w->scale = sqrt(PetscMax(sums[3], PetscMax(sums[1], sums[2])));
  w->error = sums[0] != 0 ? sqrt(sums[0]) / w->scale : 0;
  if (!isfinite(sums[2])) w->error = NAN; /* a square of the slip overflows */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStickSlipMeasure(SamStickSlip *w)
{
  SamTotal squares[SAM_SQUARES] = {{0}};
  SamRow   run;

  PetscFunctionBegin;
  if (w->frame->count) PetscCall(FitMotion(w, 1 / w->self));
  for (PetscInt j = 0; j < w->rows; j++) {
    double row[SAM_SQUARES] = {0};

    for (PetscInt n = 0; SamStickSlipNext(w, j, &n, &run);) MeasureRow(w, run, row);
    SamAddAll(SAM_SQUARES, squares, row);
  }
  PetscCall(SamStickSlipSetError(w, squares));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nearest admissible shear in equilibrium: see projection.c. */
#include "projectionimpl.h"
#include <math.h>

/*
  The error of equilibrium below which one step of Newton's method usually reaches the solution. It is smaller than for
  pressures, as the equations of shears are not piecewise linear.
*/
#define SMOOTH 1e-6
/* Loads below this part of the sum of the shear are rounding. */
#define ROUNDING 1e-13

/* The input of a pass over the cells. */
typedef struct {
  const SamRuns *runs;
  const double  *field; /* the field to be projected */
  const double  *bound;
  const float   *weight; /* NULL: 1 */
} Cells;

/* Returns weights 1 for the cells of a chunk. */
static const float *Ones(void)
{
  static float ones[SAM_CHUNK];

  for (PetscInt i = 0; ones[SAM_CHUNK - 1] != 1 && i < SAM_CHUNK; i++) ones[i] = 1;
  return ones;
}

/*
  Computes for at most SAM_CHUNK cells of a row v = field + w phi a, its projection x = D(v) onto the disc, and the
  derivative h of D times w. The second loop, with roots and divisions, runs only if a cell lies beyond its disc;
  `slips`: one does, so that the first loop would find the same. A cell of weight 0 keeps its shear, whose work on the
  motion is its part of the dual, but for a constant.
*/
SAM_VECTORIZED static void AddShears(SamRow row, const double *restrict qx, const double *restrict qy,
                                     const double *restrict bound, const float *restrict weight, const double a[3],
                                     PetscBool slips, SamDual *sums)
{
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];
  double value = 0, scale = 0, x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0,
         beyond = slips ? 1 : 0;

#pragma omp simd reduction(+ : value, scale, x, y, turn, hxx, xi_hyy, xi2_hyy, beyond)
  for (int i = 0; i < (slips ? 0 : row.count); i++) {
    const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0, w = in * (double)weight[i];
    const double vx = in * qx[i] + w * ax, vy = in * qy[i] + w * (a1 + a2 * xi), n2 = vx * vx + vy * vy;

    beyond += n2 > b * b ? 1 : 0;
    value += w > 0 ? 0.5 * n2 / w : vx * ax + vy * (a1 + a2 * xi);
    scale += fabs(vx) + fabs(vy);
    x += vx;
    y += vy;
    turn += xi * vy;
    hxx += w;
    xi_hyy += w * xi;
    xi2_hyy += w * xi * xi;
  }
  if (beyond > 0) {
    value = scale = x = y = turn = hxx = xi_hyy = xi2_hyy = 0;
#pragma omp simd reduction(+ : value, scale, x, y, turn, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy)
    for (int i = 0; i < row.count; i++) {
      const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0, w = in * (double)weight[i];
      const double vx = in * qx[i] + w * ax, vy = in * qy[i] + w * (a1 + a2 * xi), n2 = vx * vx + vy * vy,
                   size    = sqrt(n2);
      const double inverse = 1 / n2, s = n2 > b * b ? b * size * inverse : in,
                   g  = n2 > b * b ? s * inverse : 0; /* one division */
      const double px = s * vx, py = s * vy, gxx = w * (s - g * vx * vx), gxy = -w * g * vx * vy,
                   gyy = w * (s - g * vy * vy);

      value += w > 0 ? (n2 > b * b ? b * size - 0.5 * b * b : 0.5 * n2) / w : px * ax + py * (a1 + a2 * xi);
      scale += fabs(px) + fabs(py);
      SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi);
    }
  } else
    hyy = hxx;
  sums->value += value;
  sums->scale += scale;
  sums->sums[0] += x;
  sums->sums[1] += y;
  sums->sums[2] += turn - row.eta * x;
  SamGramTangentialRow(sums->gram, (const double[6]){hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy}, row.eta);
}

/* True if the first cell, the last or the one between lies beyond its disc: most rows begin or end in slip. */
static PetscBool Slips(SamRow row, const double qx[], const double qy[], const double bound[], const float weight[],
                       const double a[3])
{
  const int cells[] = {0, row.count / 2, row.count - 1};

  for (int k = 0; k < 3; k++) {
    const int    i = cells[k];
    const double w = (double)weight[i], vx = qx[i] + w * SamFrameX(a, row.eta),
                 vy = qy[i] + w * (a[1] + a[2] * (row.xi0 + (double)i * row.dxi));

    if (bound[i] > 0 && vx * vx + vy * vy > bound[i] * bound[i]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void PassTangential(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  const Cells *c = (const Cells *)context;

  for (PetscInt j = 0; j < f->grid->rows; j++) {
    SamDual sums = {0};

    for (PetscInt n = c->runs->start[j]; n < c->runs->start[j + 1]; n++)
      for (PetscInt i = c->runs->span[n][0], last = c->runs->span[n][1]; i < last; i += SAM_CHUNK) {
        const SamRow  row = SamFrameRow(f, j, i, PetscMin(i + SAM_CHUNK, last));
        const double *qx = c->field + row.first, *qy = qx + f->grid->cells, *bound = c->bound + row.first;
        const float  *weight = c->weight ? c->weight + row.first : Ones();

        AddShears(row, qx, qy, bound, weight, a, Slips(row, qx, qy, bound, weight, a), &sums);
      }
    SamAddAll(SAM_DUAL, dual, (const double *)&sums);
  }
}

/* Replaces the shear of some cells of a row by its projection, and adds its moments. */
SAM_VECTORIZED static void ApplyShears(SamRow row, double *restrict qx, double *restrict qy,
                                       const double *restrict bound, const float *restrict weight, const double a[3],
                                       SamDual *sums)
{
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];
  double       scale = 0, x = 0, y = 0, turn = 0;

#pragma omp simd reduction(+ : scale, x, y, turn)
  for (int i = 0; i < row.count; i++) {
    const double xi = row.xi0 + (double)i * row.dxi, b = bound[i], in = b > 0 ? 1 : 0, w = in * (double)weight[i];
    const double vx = in * qx[i] + w * ax, vy = in * qy[i] + w * (a1 + a2 * xi), n2 = vx * vx + vy * vy,
                 s  = n2 > b * b ? b / sqrt(n2) : in;
    const double px = s * vx, py = s * vy;

    qx[i] = px;
    qy[i] = py;
    scale += fabs(px) + fabs(py);
    x += px;
    y += py;
    turn += xi * py;
  }
  sums->scale += scale;
  sums->sums[0] += x;
  sums->sums[1] += y;
  sums->sums[2] += turn - row.eta * x;
}

/* Replaces q by the projection for this a, and computes its moments. */
static PetscErrorCode ApplyTangential(const SamFrame *f, const Cells *c, const double a[3], double q[], SamTotal dual[])
{
  const PetscInt nx = f->grid->nx;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    double  *qx = q + (ptrdiff_t)j * nx, *qy = qx + f->grid->cells;
    PetscInt end  = 0; /* of the columns that are done */
    SamDual  sums = {0};

    for (PetscInt n = c->runs->start[j]; n < c->runs->start[j + 1]; n++) {
      const PetscInt first = c->runs->span[n][0], last = c->runs->span[n][1];

      PetscCall(PetscArrayzero(qx + end, first - end));
      PetscCall(PetscArrayzero(qy + end, first - end));
      for (PetscInt i = first; i < last; i += SAM_CHUNK) {
        const SamRow row = SamFrameRow(f, j, i, PetscMin(i + SAM_CHUNK, last));

        ApplyShears(row, qx + i, qy + i, c->bound + row.first, c->weight ? c->weight + row.first : Ones(), a, &sums);
      }
      end = last;
    }
    PetscCall(PetscArrayzero(qx + end, nx - end));
    PetscCall(PetscArrayzero(qy + end, nx - end));
    SamAddAll(SAM_DUAL, dual, (const double *)&sums);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  If one step of Newton's method is likely to suffice, it is applied first, without a further pass over the cells. If it
  did not suffice, the result is the nearest shear to it.
*/
static PetscErrorCode Project(const SamFrame *f, const Cells *cells, PetscBool nearest, double q[], double motion[3],
                              PetscBool *found)
{
  PetscBool near = PETSC_TRUE;

  PetscFunctionBegin;
  *found = PETSC_FALSE;
  for (PetscInt time = nearest ? 1 : 0; time < 2 && !*found; time++) {
    SamTotal totals[SAM_DUAL] = {{0}};
    double   a[3]             = {0, 0, 0};

    if (f->count)
      PetscCall(SamDualMinimize(f, PassTangential, cells, time == 0 ? SMOOTH : 0, a, found, &near));
    else
      *found = PETSC_TRUE;
    if (!*found && (!near || time > 0)) break;
    PetscCall(ApplyTangential(f, cells, a, q, totals));
    for (PetscInt i = 0; motion && i < 3; i++) motion[i] += a[i];
    if (!*found) PetscCall(SamDualIsBalanced(f, totals, SAM_BALANCED_EXACT, found));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if the loads are mere rounding errors of the load that the cells' shear could carry. */
static PetscErrorCode AreRounding(const SamFrame *f, const double q[], PetscBool *are)
{
  SamTotal total = {0};
  double   sum, load = 0;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    double row = 0;

    for (PetscInt k = j * f->grid->nx; k < (j + 1) * f->grid->nx; k++) row += fabs(q[k]) + fabs(q[k + f->grid->cells]);
    SamAddAll(1, &total, &row);
  }
  PetscCall(SamSumTotals(f->grid->comm, 1, &total, &sum));
  for (PetscInt k = 0; k < f->count; k++) load = SamLarger(load, fabs(f->target[k]));
  *are = load <= ROUNDING * sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  If all shear has to vanish, as in a contact of few cells whose load goes through zero, the remaining shear is rounding
  and balances no load. Then the nearest shear to zero is sought.
*/
PetscErrorCode SamFrameProjectTangential(const SamFrame *f, const SamRuns *runs, const double bound[],
                                         const float weight[], PetscBool nearest, double q[], double motion[3],
                                         PetscBool *found)
{
  PetscBool rounding = PETSC_FALSE;
  SamRuns   own      = {NULL, NULL};
  Cells     cells    = {.runs = runs ? runs : &own, .field = q, .bound = bound, .weight = weight};

  PetscFunctionBegin;
  if (!runs) PetscCall(SamRunsCreate(f->grid, bound, NULL, SAM_RUN_GAP, &own));
  for (PetscInt i = 0; motion && i < 3; i++) motion[i] = 0;
  PetscCall(Project(f, &cells, nearest, q, motion, found));
  if (!*found) PetscCall(AreRounding(f, q, &rounding));
  if (rounding) {
    PetscCall(PetscArrayzero(q, 2 * f->grid->cells));
    PetscCall(Project(f, &cells, nearest, q, motion, found));
  }
  PetscCall(SamRunsDestroy(&own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

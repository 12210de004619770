/*
  The loops of the method for rolling over the contact cells of a row; see rolling.c. Each is vectorised but the
  sweep, in which a cell depends on the next one. Sums over a row do not depend on the number of ranks. A cell that
  slips has the unit vector `normal` along its shear, P takes it off a vector.
*/
#include <petsam/private/elasticity.h>
#include "rollingimpl.h"
#include <math.h>

/*
  A cell slips when q - EASE s/c is beyond its circle and q no nearer to its centre than NEAR of the bound, and either
  its slip is against its shear, or q is farther out than OUT of the bound, less if the error is below ROUGH: such cells
  would stall the iteration if they stuck.
*/
#define EASE  0.25
#define NEAR  0.5
#define OUT   0.02
#define ROUGH 1e-3
/* Up to this weight a cell counts in the preconditioner in proportion to the weight, not to its square root. */
#define FAINT 1e-3f

SAM_VECTORIZED void SamRollingSetsRow(const SamRollingWork *w, SamRow row, SamRollingSums *sums)
{
  const SamStickSlip *u       = &w->base;
  const ptrdiff_t     cells   = u->cells;
  const double        inverse = 1 / u->self, ease = EASE * inverse, far = 1 + OUT * PetscMin(1, u->error / ROUGH);
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict sx = u->s + row.first,
                         *restrict sy = sx + cells, *restrict bound = u->bound + row.first;
  float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first;
  double residual = 0, shear = 0, projected = 0, least = 0, x = 0, y = 0, turn = 0;

#pragma omp simd reduction(+ : residual, shear, projected, least, x, y, turn)
  for (int i = 0; i < row.count; i++) {
    const double b = bound[i], in = b > 0 ? 1 : 0, q2 = qx[i] * qx[i] + qy[i] * qy[i],
                 power = qx[i] * sx[i] + qy[i] * sy[i];
    const double ox = qx[i] - ease * sx[i], oy = qy[i] - ease * sy[i], beyond = ox * ox + oy * oy >= b * b ? 1 : 0,
                 near = q2 >= NEAR * NEAR * b * b ? 1 : 0, out = q2 > far * far * b * b ? 1 : 0,
                 against = power < 0 ? 1 : 0, slips = in * beyond * near * (against > out ? against : out);
    const double scale = slips / sqrt(q2 + (1 - slips)), lambda = -power * scale * inverse / (b + (1 - in)),
                 yx = qx[i] - inverse * sx[i], yy = qy[i] - inverse * sy[i], n2 = yx * yx + yy * yy,
                 factor = SamDiscScale(n2, b);

    nx[i]     = (float)(scale * qx[i]);
    ny[i]     = (float)(scale * qy[i]);
    weight[i] = (float)(in / (1 + (lambda > 0 ? lambda : 0)));
    SAM_ADD_SQUARES(qx[i], qy[i], yx, yy, factor, n2, b);
    x += qx[i];
    y += qy[i];
    turn += (row.xi0 + (double)i * row.dxi) * qy[i];
  }
  SamSumSquares(sums->squares, residual, shear, projected, least);
  sums->load[0] += x;
  sums->load[1] += y;
  sums->load[2] += turn - row.eta * x;
}

/*
  Returns the root of a weight, less for faint cells. The slip of a cell with hardly any bound is large; by the root,
  the preconditioner would move the neighbouring cells, on which its shear has no influence.
*/
static inline float Root(float h)
{
  return h < FAINT ? h / sqrtf(FAINT) : sqrtf(h);
}

SAM_VECTORIZED void SamRollingRightRow(const SamRollingWork *w, SamRow row, const double *a, float z[])
{
  const SamStickSlip *u     = &w->base;
  const ptrdiff_t     cells = u->cells;
  const double *restrict sx = u->s + row.first, *restrict sy = sx + cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first;
  float *restrict rx = w->r + row.first, *restrict ry = rx + cells, *restrict zx = z + row.first,
                  *restrict zy = zx + cells, *restrict hx = w->slot[0] + 2 * cells + row.first,
                  *restrict hy = hx + cells;
  const double ax = a ? SamFrameX(a, row.eta) : 0, a1 = a ? a[1] : 0, a2 = a ? a[2] : 0, s = a ? 0 : -1 / w->unit_s;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float in = weight[i] > 0 ? 1.0f : 0.0f, g = Root(weight[i]), x = in * (float)(ax + s * sx[i]),
                y = in * (float)(a1 + a2 * (row.xi0 + (double)i * row.dxi) + s * sy[i]), part = nx[i] * x + ny[i] * y;

    rx[i] = x - part * nx[i];
    ry[i] = y - part * ny[i];
    zx[i] = g * rx[i];
    zy[i] = g * ry[i];
    hx[i] = weight[i] * rx[i];
    hy[i] = weight[i] * ry[i];
  }
}

/* Returns the part of N: 0 in stick and beside it, where N for the true h is small; 1 where h is at most that of N. */
static float SlipPart(const float weight[], int count, int i)
{
  float most = weight[i], part;

  if (most <= 0) return 0;
  if (i > 0) most = PetscMax(most, weight[i - 1]);
  if (i + 1 < count) most = PetscMax(most, weight[i + 1]);
  part = PetscMin(1, (1 - most) / (1 - (float)SAM_SLIP_WEIGHT));
  return part * part;
}

void SamRollingSweepRow(const SamRollingWork *w, SamRow row, float z[], float normal)
{
  const SamStickSlip *u     = &w->base;
  const ptrdiff_t     cells = u->cells;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict bound = u->bound + row.first;
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + cells,
                        *restrict rx = w->r + row.first, *restrict ry = rx + cells,
                        *restrict slip_x = w->slot[0] + 2 * cells + row.first, *restrict slip_y = slip_x + cells;
  float *restrict zx = z + row.first, *restrict zy = zx + cells;
  float x = 0, y = 0;

  for (int i = row.count - 1; i >= 0; i--) {
    const float h = weight[i], g = Root(h), rest = 0.5f * (1 - h) * h,
                over  = normal * (float)((bound[i] - sqrt(qx[i] * qx[i] + qy[i] * qy[i])) / w->unit_q);
    const float share = w->slipping ? SlipPart(weight, row.count, i) : 0, stick = 1 - share,
                near = PetscMin(1, h / (float)SAM_SLIP_WEIGHT),
                vx   = stick * (g * zx[i] + rest * rx[i]) + share * (near * slip_x[i] + (1 - near) * h * rx[i]) + h * x,
                vy   = stick * (g * zy[i] + rest * ry[i]) + share * (near * slip_y[i] + (1 - near) * h * ry[i]) + h * y,
                part = nx[i] * vx + ny[i] * vy;

    x     = vx - part * nx[i];
    y     = vy - part * ny[i];
    zx[i] = x + over * nx[i];
    zy[i] = y + over * ny[i];
  }
}

SAM_VECTORIZED void SamRollingLoadsRow(const SamRollingWork *w, SamRow row, float project, float z[], double sums[3])
{
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + w->base.cells;
  float *restrict zx = z + row.first, *restrict zy = zx + w->base.cells;
  double x = 0, y = 0, turn = 0;

#pragma omp simd reduction(+ : x, y, turn)
  for (int i = 0; i < row.count; i++) {
    const float part = project * (nx[i] * zx[i] + ny[i] * zy[i]);

    zx[i] -= part * nx[i];
    zy[i] -= part * ny[i];
    x += (double)zx[i];
    y += (double)zy[i];
    turn += (row.xi0 + (double)i * row.dxi) * (double)zy[i];
  }
  sums[0] += x;
  sums[1] += y;
  sums[2] += turn - row.eta * x;
}

/* ---- least squares ---- */

#define CHUNK 128

/* Computes the change of the residual by a direction, in some cells of a row: x, then y. */
SAM_VECTORIZED static void DirectionColumn(const SamRollingWork *w, SamRow row, const float slot[],
                                           float *restrict column)
{
  const ptrdiff_t cells    = w->base.cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first,
                        *restrict dx = slot + row.first, *restrict dy = dx + cells, *restrict ux = dy + cells,
                        *restrict uy = ux + cells;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float h = weight[i], in = h > 0 ? 1.0f : 0.0f, normal = nx[i] * dx[i] + ny[i] * dy[i];
    const float x = h * ux[i] + (in - h) * dx[i], y = h * uy[i] + (in - h) * dy[i],
                part = normal - (nx[i] * x + ny[i] * y);

    column[i]         = in * x + part * nx[i];
    column[CHUNK + i] = in * y + part * ny[i];
  }
}

/* Computes the change of the residual by a creepage. */
SAM_VECTORIZED static void CreepColumn(const SamRollingWork *w, SamRow row, const double a[3], float *restrict column)
{
  const ptrdiff_t cells    = w->base.cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first;
  const float ax = (float)SamFrameX(a, row.eta), a1 = (float)a[1], a2 = (float)a[2], xi0 = (float)row.xi0,
              dxi = (float)row.dxi;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float y = a1 + a2 * (xi0 + (float)i * dxi), part = nx[i] * ax + ny[i] * y;

    column[i]         = -weight[i] * (ax - part * nx[i]);
    column[CHUNK + i] = -weight[i] * (y - part * ny[i]);
  }
}

/* Computes the residual: slip that should not be, and shear that is not on its circle. */
SAM_VECTORIZED static void ResidualColumn(const SamRollingWork *w, SamRow row, float *restrict column)
{
  const SamStickSlip *u     = &w->base;
  const ptrdiff_t     cells = u->cells;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict bound = u->bound + row.first;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first,
                        *restrict rx = w->r + row.first, *restrict ry = rx + cells;
  const double inverse = 1 / w->unit_q;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float over = (float)(inverse * (bound[i] - sqrt(qx[i] * qx[i] + qy[i] * qy[i])));

    column[i]         = weight[i] * rx[i] + over * nx[i];
    column[CHUNK + i] = weight[i] * ry[i] + over * ny[i];
  }
}

/* Adds the products of a column with itself and those after it. */
SAM_VECTORIZED static void AddProducts(int count, PetscInt n, const float *restrict columns, double sums[])
{
  for (PetscInt k = 0; k < n; k++) {
    const float *restrict other = columns + 2 * CHUNK * k;
    float sum                   = 0;

#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < count; i++) sum += columns[i] * other[i] + columns[CHUNK + i] * other[CHUNK + i];
    sums[k] += (double)sum;
  }
}

void SamRollingGramRow(const SamRollingWork *w, SamRow whole, double sums[SAM_ROLLING_GRAM])
{
  const SamFrame *f = w->base.frame;
  const PetscInt  n = w->kept + 1, columns = n + f->count + 1;

  for (int from = 0; from < whole.count; from += CHUNK) {
    SamRow  row   = whole;
    double *place = sums;

    row.first += from;
    row.column += from;
    row.xi0 += (double)from * row.dxi;
    row.count = PetscMin(CHUNK, whole.count - from);
    for (PetscInt k = 0; k < n; k++) DirectionColumn(w, row, w->slot[k], w->columns + 2 * CHUNK * k);
    for (PetscInt k = 0; k < f->count; k++) CreepColumn(w, row, f->motion[k], w->columns + 2 * CHUNK * (n + k));
    ResidualColumn(w, row, w->columns + 2 * CHUNK * (columns - 1));
    for (PetscInt k = 0; k < columns; k++) {
      AddProducts(row.count, columns - k, w->columns + 2 * CHUNK * k, place);
      place += columns - k;
    }
  }
}

/* ---- the step ---- */

SAM_VECTORIZED static void Add(int n, float x, const float *restrict from, float *restrict to)
{
#pragma omp simd
  for (int i = 0; i < n; i++) to[i] += x * from[i];
}

void SamRollingCombineRow(const SamRollingWork *w, SamRow row, const double x[])
{
  for (PetscInt c = 0; c < 4; c++) {
    const ptrdiff_t first = c * (ptrdiff_t)w->base.cells + row.first;

    for (int i = 0; i < row.count; i++) w->slot[0][first + i] *= (float)x[0];
    for (PetscInt k = 1; k <= w->kept; k++) Add(row.count, (float)x[k], w->slot[k] + first, w->slot[0] + first);
  }
}

SAM_VECTORIZED void SamRollingLengthsRow(const SamRollingWork *w, SamRow row, const double length[SAM_ROLLING_LENGTHS],
                                         const double a[3], double squares[SAM_ROLLING_LENGTHS])
{
  const SamStickSlip *u       = &w->base;
  const ptrdiff_t     cells   = u->cells;
  const double        inverse = 1 / u->self;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict sx = u->s + row.first,
                         *restrict sy = sx + cells, *restrict bound = u->bound + row.first;
  const float *restrict dx = w->slot[0] + row.first, *restrict dy = dx + cells, *restrict ux = dy + cells,
                        *restrict uy = ux + cells;
  const double motion_x = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];

  for (int k = 0; k < SAM_ROLLING_LENGTHS; k++) {
    const double t = length[k], by_q = t * w->unit_q, by_s = t * w->unit_s;
    double       sum = 0;

#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < row.count; i++) {
      const double x = qx[i] + by_q * (double)dx[i], y = qy[i] + by_q * (double)dy[i],
                   vx = sx[i] + by_s * (double)ux[i] - t * motion_x,
                   vy = sy[i] + by_s * (double)uy[i] - t * (a1 + a2 * (row.xi0 + (double)i * row.dxi));
      const double yx = x - inverse * vx, yy = y - inverse * vy, factor = SamDiscScale(yx * yx + yy * yy, bound[i]),
                   in = bound[i] > 0 ? 1 : 0, ex = x - factor * yx, ey = y - factor * yy;

      sum += in * (ex * ex + ey * ey);
    }
    squares[k] += sum;
  }
}

SAM_VECTORIZED void SamRollingAdvanceRow(const SamRollingWork *w, SamRow row, double t, const double a[3])
{
  const SamStickSlip *u     = &w->base;
  const ptrdiff_t     cells = u->cells;
  double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict sx = u->s + row.first,
                   *restrict sy = sx + cells;
  const float *restrict dx = w->slot[0] + row.first, *restrict dy = dx + cells, *restrict ux = dy + cells,
                        *restrict uy = ux + cells;
  const double motion_x = t * SamFrameX(a, row.eta), a1 = t * a[1], a2 = t * a[2], by_q = t * w->unit_q,
               by_s = t * w->unit_s;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    qx[i] += by_q * (double)dx[i];
    qy[i] += by_q * (double)dy[i];
    sx[i] += by_s * (double)ux[i] - motion_x;
    sy[i] += by_s * (double)uy[i] - (a1 + a2 * (row.xi0 + (double)i * row.dxi));
  }
}

/*
  Newton's method's loops over the contact cells of a row.

  Each is vectorised; sums over cells are local variables, and rows are added up by the caller in twice the digits, so
  that the results do not depend on the number of ranks. In a cell that slips, `normal` is the unit vector along its
  shear, and P subtracts a vector's component along it; in a cell that sticks, `normal` is zero, and P changes nothing.
  In a cell that turns, `normal` is the unit vector against its slip, the weight is zero, and P makes all vectors zero.
*/
#include "newtonimpl.h"
#include <math.h>

/* A cell slips if q - EASE s/c is beyond its circle, and q is no nearer to its centre than NEAR of the bound. */
#define EASE 0.25
#define NEAR 0.5

SAM_VECTORIZED double SamNewtonAdvanceRow(const SamNewton *w, SamRow row, double t, double by, const double a[3],
                                          SamNewtonSpace *space)
{
  const SamStickSlip *u       = &w->base;
  const ptrdiff_t     cells   = u->cells;
  const double        inverse = 1 / u->self, ease = EASE * inverse;
  const double *restrict vx = w->trial + row.first, *restrict vy = vx + cells, *restrict bound = u->bound + row.first;
  const float *restrict ux = w->u + row.first, *restrict uy = ux + cells;
  double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict sx = u->s + row.first,
                   *restrict sy = sx + cells;
  float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first;
  const double motion_x = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2], turns_from = w->turns_from;
  double most = 0, x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0, work = 0;

#pragma omp simd reduction(+ : x, y, turn, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy, work) reduction(max : most)
  for (int i = 0; i < row.count; i++) {
    const double b = bound[i], in = b > 0 ? 1 : 0, xi = row.xi0 + (double)i * row.dxi;
    const double ax = qx[i] + t * (vx[i] - qx[i]), ay = qy[i] + t * (vy[i] - qy[i]),
                 bx = sx[i] + by * (double)ux[i] - motion_x, cy = sy[i] + by * (double)uy[i] - a1 - a2 * xi,
                 power = bx * ax + cy * ay;
    const double yx = ax - ease * bx, yy = ay - ease * cy, outside = yx * yx + yy * yy >= b * b ? 1 : 0,
                 near = ax * ax + ay * ay >= NEAR * NEAR * b * b ? 1 : 0, slips = outside * near * (power < 0 ? 1 : 0);
    const double s2 = bx * bx + cy * cy, turns = in * (1 - slips) * (s2 > turns_from * b * b ? 1 : 0),
                 moves = in * (1 - turns), back = turns / sqrt(s2 + (1 - turns));
    const double scale = slips / sqrt(ax * ax + ay * ay + (1 - slips)), ex = scale * ax - back * bx,
                 ey = scale * ay - back * cy, part = moves * (ex * bx + ey * cy);
    const double h = moves / (1 - inverse * part * scale), px = moves * bx - part * ex, py = moves * cy - part * ey;
    const double hx = h * px, hy = h * py, gxx = h * (1 - ex * ex), gxy = -h * ex * ey, gyy = h * (1 - ey * ey);
    const double largest = fabs(px) > fabs(py) ? fabs(px) : fabs(py);

    qx[i]     = ax;
    qy[i]     = ay;
    sx[i]     = bx;
    sy[i]     = cy;
    nx[i]     = (float)ex;
    ny[i]     = (float)ey;
    weight[i] = sqrtf((float)h);
    most      = largest > most ? largest : most;
    work -= slips * power;
    SAM_ADD_TANGENTIAL(hx, hy, gxx, gxy, gyy, xi);
  }
  space->work += work;
  space->slip[0] += x;
  space->slip[1] += y;
  space->slip[2] += turn - row.eta * x;
  SamGramTangentialRow(space->gram, (const double[6]){hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy}, row.eta);
  return most;
}

void SamNewtonOutsideRow(const SamNewton *w, PetscInt j, double by)
{
  const SamStickSlip *u = &w->base;

  for (PetscInt c = 0; c < 2; c++) {
    const ptrdiff_t row = c * (ptrdiff_t)u->cells + (ptrdiff_t)j * u->nx;
    PetscInt        i   = 0;
    SamRow          run;

    for (PetscInt n = 0; SamStickSlipNext(u, j, &n, &run); i = run.column + run.count)
      for (; i < run.column; i++) u->s[row + i] += by * (double)w->u[row + i];
    for (; i < u->nx; i++) u->s[row + i] += by * (double)w->u[row + i];
  }
}

SAM_VECTORIZED void SamNewtonResidualRow(const SamNewton *w, SamRow row, double inverse_unit, const double a[3],
                                         double squares[SAM_SQUARES])
{
  const SamStickSlip *u       = &w->base;
  const ptrdiff_t     cells   = u->cells;
  const double        inverse = 1 / u->self;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict bound = u->bound + row.first;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict weight = w->weight + row.first;
  double *restrict sx = u->s + row.first, *restrict sy = sx + cells;
  float *restrict rx = w->r + row.first, *restrict ry = rx + cells, *restrict zx = w->z + row.first,
                  *restrict zy = zx + cells;
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];
  double       residual = 0, shear = 0, projected = 0, least = 0;

#pragma omp simd reduction(+ : residual, shear, projected, least)
  for (int i = 0; i < row.count; i++) {
    const double x = sx[i] - ax, y = sy[i] - a1 - a2 * (row.xi0 + (double)i * row.dxi), b = bound[i],
                 q2    = qx[i] * qx[i] + qy[i] * qy[i];
    const double slips = nx[i] * nx[i] + ny[i] * ny[i] > 0.5f ? 1 : 0,
                 part = slips * (x * qx[i] + y * qy[i]) / (q2 > 0 ? q2 : 1), unit = weight[i] > 0 ? -inverse_unit : 0;
    const float  vx = (float)(unit * (x - part * qx[i])), vy = (float)(unit * (y - part * qy[i]));
    const double yx = qx[i] - inverse * x, yy = qy[i] - inverse * y, n2 = yx * yx + yy * yy,
                 scale = SamDiscScale(n2, b);

    sx[i] = x;
    sy[i] = y;
    rx[i] = vx;
    ry[i] = vy;
    zx[i] = weight[i] * vx;
    zy[i] = weight[i] * vy;
    SAM_ADD_SQUARES(qx[i], qy[i], yx, yy, scale, n2, b);
  }
  SamSumSquares(squares, residual, shear, projected, least);
}

SAM_VECTORIZED void SamNewtonPreconditionedRow(const SamNewton *w, SamRow row, double sums[])
{
  const ptrdiff_t cells        = w->base.cells;
  const float *restrict weight = w->weight + row.first, *restrict rx = w->r + row.first, *restrict ry = rx + cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict xi = w->xi + row.column;
  const float *restrict dx = w->step + row.first, *restrict dy = dx + cells, *restrict ux = w->u + row.first,
                        *restrict uy = ux + cells;
  float *restrict zx = w->z + row.first, *restrict zy = zx + cells;
  float z_x = 0, z_y = 0, z_turn = 0, e_x = 0, e_y = 0, e_turn = 0, v_x = 0, v_y = 0, v_turn = 0, zr = 0, zv = 0,
        ev = 0, er = 0;

#pragma omp simd reduction(+ : z_x, z_y, z_turn, e_x, e_y, e_turn, v_x, v_y, v_turn, zr, zv, ev, er)
  for (int i = 0; i < row.count; i++) {
    const float g = weight[i], h = g * g, in = h > 0 ? 1.0f : 0.0f, rest = 0.5f * (1 - h) * h,
                lambda = h > 0 ? (1 - h) / h : 0, part = g * (nx[i] * zx[i] + ny[i] * zy[i]);
    const float x = g * zx[i] - part * nx[i] + rest * rx[i], y = g * zy[i] - part * ny[i] + rest * ry[i];
    const float d_part = nx[i] * dx[i] + ny[i] * dy[i], ex = in * (dx[i] - d_part * nx[i]),
                ey     = in * (dy[i] - d_part * ny[i]);
    const float u_part = nx[i] * ux[i] + ny[i] * uy[i], vx = in * (ux[i] - u_part * nx[i]) + lambda * ex,
                vy = in * (uy[i] - u_part * ny[i]) + lambda * ey;

    zx[i] = x;
    zy[i] = y;
    z_x += x;
    z_y += y;
    z_turn += xi[i] * y;
    e_x += ex;
    e_y += ey;
    e_turn += xi[i] * ey;
    v_x += h * vx;
    v_y += h * vy;
    v_turn += h * xi[i] * vy;
    zr += x * rx[i] + y * ry[i];
    zv += x * vx + y * vy;
    ev += ex * vx + ey * vy;
    er += ex * rx[i] + ey * ry[i];
  }
  const double run[] = {(double)z_x, (double)z_y, (double)z_turn - row.eta * (double)z_x,
                        (double)e_x, (double)e_y, (double)e_turn - row.eta * (double)e_x,
                        (double)v_x, (double)v_y, (double)v_turn - row.eta * (double)v_x,
                        (double)zr,  (double)zv,  (double)ev,
                        (double)er}; /* in the order of SamNewtonProducts */

  for (size_t k = 0; k < sizeof(run) / sizeof(run[0]); k++) sums[k] += run[k];
}

SAM_VECTORIZED void SamNewtonDirectionRow(const SamNewton *w, SamRow row, const double a[3], float beta)
{
  const ptrdiff_t cells        = w->base.cells;
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + cells,
                        *restrict xi = w->xi + row.column;
  const float *restrict dx = w->step + row.first, *restrict dy = dx + cells;
  float *restrict zx = w->z + row.first, *restrict zy = zx + cells;
  const float ax = (float)SamFrameX(a, row.eta), a1 = (float)a[1], a2 = (float)a[2];

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float in = weight[i] > 0 ? 1.0f : 0.0f, h = weight[i] * weight[i], x = beta * dx[i] - h * ax,
                y = beta * dy[i] - h * (a1 + a2 * xi[i]), part = nx[i] * x + ny[i] * y;

    zx[i] += in * (x - part * nx[i]);
    zy[i] += in * (y - part * ny[i]);
  }
}

/*
  Moves cells that turn to where they are opposite to their slip, and slipping cells beyond their circles, as far as
  their slip in units of c, but at least to twice their bound. The projection, which restores equilibrium by a common
  shift, then leaves them on the circle. Otherwise it would pull half of them inside, and convergence would be linear
  instead of quadratic. It also turns them as far as a change of the motion would.
*/
SAM_VECTORIZED void SamNewtonTrialRow(const SamNewton *w, SamRow row, double alpha)
{
  const SamStickSlip *u      = &w->base;
  const ptrdiff_t     cells  = u->cells;
  const double        unit_q = alpha * w->unit / u->self;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + cells, *restrict zx = w->z + row.first,
                        *restrict zy = zx + cells, *restrict weight = w->weight + row.first;
  const double *restrict b = u->bound + row.first, *restrict qx = u->q + row.first, *restrict qy = qx + cells;
  double *restrict vx = w->trial + row.first, *restrict vy = vx + cells;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const double slips = nx[i] * nx[i] + ny[i] * ny[i] > 0.5f ? 1 : 0, turns = weight[i] > 0 ? 0 : slips * b[i];
    const double x  = turns > 0 ? turns * (double)nx[i] : qx[i] + unit_q * (double)zx[i],
                 y  = turns > 0 ? turns * (double)ny[i] : qy[i] + unit_q * (double)zy[i];
    const double in = weight[i] > 0 ? 1 : 0, far = 1 / ((double)(weight[i] * weight[i]) + (1 - in)),
                 push  = far > 2 ? far : 2;
    const double scale = 1 + slips * (b[i] * push / sqrt(x * x + y * y + (1 - slips)) - 1);

    vx[i] = scale * x;
    vy[i] = scale * y;
  }
}

SAM_VECTORIZED void SamNewtonChangeRow(const SamNewton *w, SamRow row, double sums[4])
{
  const SamStickSlip *u       = &w->base;
  const ptrdiff_t     cells   = u->cells;
  const double        inverse = u->self / w->unit;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict ax = w->trial + row.first,
                         *restrict ay = ax + cells;
  const double *restrict sx = u->s + row.first, *restrict sy = sx + cells;
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + cells,
                        *restrict rx = w->r + row.first, *restrict ry = rx + cells;
  float *restrict dx = w->step + row.first, *restrict dy = dx + cells;
  double slope = 0;
  float  along = 0, bend = 0, size = 0;

#pragma omp simd reduction(+ : slope, along, bend, size)
  for (int i = 0; i < row.count; i++) {
    const double x = (ax[i] - qx[i]) * inverse, y = (ay[i] - qy[i]) * inverse;
    const float  vx = (float)x, vy = (float)y, part = nx[i] * vx + ny[i] * vy, ex = vx - part * nx[i],
                ey = vy - part * ny[i];
    const float h = weight[i] * weight[i], lambda = h > 0 ? (1 - h) / h : 0;

    dx[i] = vx;
    dy[i] = vy;
    slope += x * sx[i] + y * sy[i];
    along += ex * rx[i] + ey * ry[i];
    bend += lambda * (ex * ex + ey * ey);
    size += vx * vx + vy * vy;
  }
  sums[0] += slope;
  sums[1] += (double)along;
  sums[2] += (double)bend;
  sums[3] += (double)size;
}

SAM_VECTORIZED void SamNewtonCurvatureRow(const SamNewton *w, SamRow row, double sums[2])
{
  const ptrdiff_t cells    = w->base.cells;
  const float *restrict dx = w->step + row.first, *restrict dy = dx + cells, *restrict ux = w->u + row.first,
                        *restrict uy = ux + cells;
  float curvature = 0, norm = 0;

#pragma omp simd reduction(+ : curvature, norm)
  for (int i = 0; i < row.count; i++) {
    curvature += dx[i] * ux[i] + dy[i] * uy[i];
    norm += ux[i] * ux[i] + uy[i] * uy[i];
  }
  sums[0] += (double)curvature;
  sums[1] += (double)norm;
}

SAM_VECTORIZED void SamNewtonGradientRow(const SamNewton *w, SamRow row)
{
  const SamStickSlip *u       = &w->base;
  const ptrdiff_t     cells   = u->cells;
  const double        inverse = 1 / u->self;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + cells, *restrict sx = u->s + row.first,
                         *restrict sy = sx + cells;
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + cells;
  const double *restrict b = u->bound + row.first;
  double *restrict vx = w->trial + row.first, *restrict vy = vx + cells;
  float *restrict h = w->z + row.first;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float  g      = weight[i] * weight[i];
    const double length = inverse * (double)g;
    const int    turns  = weight[i] <= 0 && nx[i] * nx[i] + ny[i] * ny[i] > 0.5f;

    h[i]  = g;
    vx[i] = turns ? b[i] * (double)nx[i] : qx[i] - length * sx[i];
    vy[i] = turns ? b[i] * (double)ny[i] : qy[i] - length * sy[i];
  }
}

/*
  Newton's method and conjugate gradients in one, on changing stick and slip.

  Problem: minimise q.C q/2 + offset.q over the discs |q| <= b in equilibrium (or with given rigid displacements); its
  gradient is the slip increment s. Strictly convex, so there is one solution. An iteration, with one product:
    1. Sets: cells that are or should be on their circle, with s against q, slip; the others stick. Unknown are both
       components of q in stick, and the one along the circle in slip; P projects on them. The motion (the multipliers
  of equilibrium) makes P s smallest. The residual is -P s, its derivative P(C + L)P, L = |s|/b in slip being the
  curvature of the circle.
    2. Direction: the preconditioned residual, with the part of the last step that makes the two conjugate. Both stay
       meaningful when the sets change, as the last step is the difference of two shears, whose product is known.
       Preconditioned by P(w M w + (1 - h)/2(L + c))P, M the spectral inverse of C, c a cell's self-influence, h = c/(L
  + c), which is 1 in stick, and w = sqrt(h).
    3. Trial: the admissible shear nearest to q + alpha times the direction, discs and equilibrium at once
       (SamFrameProjectTangential), the slipping cells having been pushed outward before; alpha as last was best.
    4. The product of trial - q gives the length of the step, at most to the trial: the one that leaves the residual
  normal to it, as in linear conjugate gradients, unless the energy falls much farther. Cells that slip are then a
  little within their circles, by the square of the step, and the next trial puts them back. If the trial is uphill, or
  the error has not fallen for several iterations, the direction is the slip itself: projected gradient steps with the
  best length converge whatever is between them. Stops on the residual of q = D(q - s/c), which only the solution makes
  zero.

  Steps and their products are in single precision, at half the cost; q and s are not. Their rounding is counted, and
  before it can matter the slip is computed anew in double precision. References: Dostal and Kucera 2010, SIAM J. Optim.
  20, 2913 (separable convex constraints); Alart and Curnier 1991, CMAME 92, 353 (semi-smooth Newton for friction); the
  classical alternative is Wang, Jin, Zhang and Keer 2010.
*/
#include <petsam/private/tangentialimpl.h>
#include <math.h>

/* A cell slips when q - EASE s/c is beyond its circle. */
#define EASE 0.25
/* A direction's least descent, as a part of that of the preconditioned residual. */
#define DESCENT 0.1
/*
  The first trial's length; then it is to be longer than the best one, as steps go at most to the trial, and changes by
  at most FOLLOW's root. Chosen by counting; other values around them change the counts by a few per cent.
*/
#define FIRST_LENGTH 0.85
#define LONGER       1.2
#define FOLLOW       2.0
/* Least and largest length of a step, in parts of that to the least energy, where these bound it. */
#define LEAST_PART   0.5
#define LARGEST_PART 1.8
/*
  Rounding of a product in single precision, relative, and the part of the error that it may make up before the slip is
  computed anew. Rounding of energies, relative to the work of friction in them.
*/
#define SINGLE_ROUNDING 3e-7
#define DOUBT           0.2
#define ENERGY_ROUNDING 1e-14
/* Iterations without progress before a gradient step, and before giving up. */
#define PATIENCE   10
#define STAGNATION 100

/* Floats are in units: slip in unit, shear in unit/c, with the unit of the iteration that made them. */
typedef struct {
  SamStickSlip base;
  double      *trial;          /* admissible shear */
  float       *normal;         /* q/|q| where a cell slips, 0 where it sticks */
  float       *weight;         /* w; 0 outside the contact */
  float       *r, *z;          /* residual -P s; direction */
  float       *step, *u;       /* last step, and C times it */
  float       *xi;             /* of the columns */
  double       unit;           /* m */
  double       gram[SAM_GRAM]; /* of the tangent space */
  double       slope;          /* of the energy along the step: s.step */
  double       along, bend;    /* r.P step; P step.L P step */
  double       size;           /* |step|^2 */
  double       alpha;          /* length of the trial */
  double       work;           /* of friction: sum of -s.q where cells slip, m Pa */
  double       reach;          /* largest eigenvalue of C in units of c: about the root of the number of cells */
  double       doubt;          /* norm of what rounding may be in s/c since the last product in double precision, Pa */
} Work;

/* The contact's part of a row: cells first ... first + count - 1 of the arrays. */
typedef struct {
  ptrdiff_t    first, cells;
  int          count; /* 32 bits: loops that make a double of such an index are vectorised */
  const float *xi;
  double       xi0, dxi, eta;
} Row;

static Row GetRow(const Work *w, PetscInt j)
{
  const SamStickSlip *u = &w->base;

  return (Row){.first = (ptrdiff_t)j * u->nx + u->first[j],
               .count = (int)(u->last[j] - u->first[j]),
               .cells = u->cells,
               .xi    = w->xi + u->first[j],
               .xi0   = u->frame->xi0 + (double)u->first[j] * u->frame->dxi,
               .dxi   = u->frame->dxi,
               .eta   = SamFrameEta(u->frame, j)};
}

/* The root of the number of cells in contact. */
static PetscErrorCode FindReach(Work *w)
{
  const SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  w->reach = 0;
  for (PetscInt j = 0; j < u->rows; j++)
    for (ptrdiff_t k = (ptrdiff_t)j * u->nx + u->first[j]; k < (ptrdiff_t)j * u->nx + u->last[j]; k++)
      w->reach += u->bound[k] > 0;
  PetscCall(SamSum(u->level->grid->comm, 1, &w->reach));
  w->reach = sqrt(w->reach);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define FLOATS 6

static PetscErrorCode CreateWork(SamTangential solver, SamTangentialLevel *level, Work *w)
{
  const SamFrame *f              = &level->frame;
  float **const   floats[FLOATS] = {&w->weight, &w->normal, &w->r, &w->z, &w->step, &w->u};

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, &w->base));
  PetscCall(SamAllocateZeros(sizeof(*w->trial) * 2 * (size_t)w->base.cells, &w->trial));
  for (PetscInt k = 0; k < FLOATS; k++)
    PetscCall(SamAllocateZeros(sizeof(***floats) * (k > 0 ? 2 : 1) * (size_t)w->base.cells, floats[k]));
  PetscCall(PetscMalloc1(w->base.nx, &w->xi));
  for (PetscInt i = 0; i < w->base.nx; i++) w->xi[i] = (float)(f->xi0 + (double)i * f->dxi);
  PetscCall(FindReach(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Work *w)
{
  PetscFunctionBegin;
  SamFree(w->trial);
  SamFree(w->weight);
  SamFree(w->normal);
  SamFree(w->r);
  SamFree(w->z);
  SamFree(w->step);
  SamFree(w->u);
  PetscCall(PetscFree(w->xi));
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over cells: the slip with the phi in the tangent space, its Gram matrix, the work of friction. */
typedef struct {
  double slip[3], gram[SAM_GRAM], work;
} Space;

#define SPACE ((PetscInt)(sizeof(Space) / sizeof(double)))

/*
  Makes the step of length t: q += t (trial - q), s += by u; chooses the sets, and returns the largest slip in the
  tangent space.
*/
SAM_VECTORIZED static double RowAdvance(const Work *w, Row row, double t, double by, Space *space)
{
  const SamStickSlip *u       = &w->base;
  const double        inverse = 1 / u->self, ease = EASE * inverse;
  const double *restrict vx = w->trial + row.first, *restrict vy = vx + row.cells,
                         *restrict bound = u->bound + row.first;
  const float *restrict ux = w->u + row.first, *restrict uy = ux + row.cells;
  double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells, *restrict sx = u->s + row.first,
                   *restrict sy = sx + row.cells;
  float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict weight = w->weight + row.first;
  double most = 0, x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0, work = 0;

#pragma omp simd reduction(+ : x, y, turn, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy, work) reduction(max : most)
  for (int i = 0; i < row.count; i++) {
    const double ax = qx[i] + t * (vx[i] - qx[i]), ay = qy[i] + t * (vy[i] - qy[i]), bx = sx[i] + by * (double)ux[i],
                 cy = sy[i] + by * (double)uy[i];
    const double b = bound[i], in = b > 0 ? 1 : 0, xi = row.xi0 + (double)i * row.dxi, power = bx * ax + cy * ay;
    const double yx = ax - ease * bx, yy = ay - ease * cy, outside = yx * yx + yy * yy >= b * b ? 1 : 0,
                 slips = outside * (power < 0 ? 1 : 0);
    const double scale = slips / sqrt(ax * ax + ay * ay + (1 - slips)), ex = scale * ax, ey = scale * ay,
                 part = ex * bx + ey * cy;
    const double px = in * bx - part * ex, py = in * cy - part * ey, gxx = in - ex * ex, gxy = -ex * ey,
                 gyy     = in - ey * ey;
    const double largest = fabs(px) > fabs(py) ? fabs(px) : fabs(py);

    qx[i]     = ax;
    qy[i]     = ay;
    sx[i]     = bx;
    sy[i]     = cy;
    nx[i]     = (float)ex;
    ny[i]     = (float)ey;
    weight[i] = (float)in / sqrtf((float)(1 - inverse * part * scale));
    most      = largest > most ? largest : most;
    work -= slips * power;
    SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi);
  }
  space->work += work;
  space->slip[0] += x;
  space->slip[1] += y;
  space->slip[2] += turn - row.eta * x;
  SamGramTangentialRow(space->gram, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy, row.eta);
  return most;
}

/* Takes the motion a off s; r = -P s, in units, and z = w r; the squares of the error. */
SAM_VECTORIZED static void RowResidual(const Work *w, Row row, double inverse_unit, const double a[3],
                                       double squares[SAM_SQUARES])
{
  const SamStickSlip *u       = &w->base;
  const double        inverse = 1 / u->self;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells, *restrict bound = u->bound + row.first;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells,
                        *restrict weight = w->weight + row.first;
  double *restrict sx = u->s + row.first, *restrict sy = sx + row.cells;
  float *restrict rx = w->r + row.first, *restrict ry = rx + row.cells, *restrict zx = w->z + row.first,
                  *restrict zy = zx + row.cells;
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];
  double       residual = 0, shear = 0, projected = 0, least = 0;

#pragma omp simd reduction(+ : residual, shear, projected, least)
  for (int i = 0; i < row.count; i++) {
    const double x = sx[i] - ax, y = sy[i] - a1 - a2 * (row.xi0 + (double)i * row.dxi), b = bound[i],
                 q2    = qx[i] * qx[i] + qy[i] * qy[i];
    const double slips = nx[i] * nx[i] + ny[i] * ny[i] > 0.5f ? 1 : 0,
                 part = slips * (x * qx[i] + y * qy[i]) / (q2 + (1 - slips)), unit = b > 0 ? -inverse_unit : 0;
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

/* z = 0 beside the contact's rows, which alone are written to. */
static PetscErrorCode ClearMargins(const Work *w)
{
  const SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt j = 0; j < u->rows; j++) {
      float *z = w->z + c * u->cells + j * u->nx;

      PetscCall(PetscArrayzero(z, u->first[j]));
      PetscCall(PetscArrayzero(z + u->last[j], u->nx - u->last[j]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  After a step of length t: the sets, the Gram matrix of the tangent space, the unit, the motion that fits best, the
  residual and the error.
*/
static PetscErrorCode Advance(Work *w, double t)
{
  SamStickSlip *u                                      = &w->base;
  SamTotal      totals[sizeof(Space) / sizeof(double)] = {{0, 0}}, squares[SAM_SQUARES] = {{0, 0}};
  Space         space;
  double        most = 0, a[3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    Space        row     = {0};
    const double largest = RowAdvance(w, GetRow(w, j), t, t * w->unit, &row);

    most = PetscMax(most, largest);
    SamAddAll(SPACE, totals, (const double *)&row);
  }
  PetscCall(SamMax(u->level->grid->comm, 1, &most));
  PetscCall(SamSumTotals(u->level->grid->comm, SPACE, totals, (double *)&space));
  w->unit = most > 0 ? most : 1;
  w->work = space.work;
  PetscCall(PetscArraycpy(w->gram, space.gram, SAM_GRAM));
  SamFrameSolve(u->frame, w->gram, space.slip, a);
  for (PetscInt c = 0; c < 3; c++) u->motion[c] += a[c];
  PetscCall(ClearMargins(w));
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[SAM_SQUARES] = {0};

    RowResidual(w, GetRow(w, j), 1 / w->unit, a, row);
    SamAddAll(SAM_SQUARES, squares, row);
  }
  PetscCall(SamStickSlipSetError(u, squares));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a row adds to a direction's sums: z and v with the phi; z.r, z.v, e.v, e.r. */
typedef struct {
  double z[3], v[3], zr, zv, ev, er;
} Products;

#define PRODUCTS ((PetscInt)(sizeof(Products) / sizeof(double)))

/* z = P(w z + rest r), with e = P step and v = P(u + L step) its products. */
SAM_VECTORIZED static void RowPreconditioned(const Work *w, Row row, Products *sums)
{
  const float *restrict weight = w->weight + row.first, *restrict rx = w->r + row.first, *restrict ry = rx + row.cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict xi = row.xi;
  const float *restrict dx = w->step + row.first, *restrict dy = dx + row.cells, *restrict ux = w->u + row.first,
                        *restrict uy = ux + row.cells;
  float *restrict zx = w->z + row.first, *restrict zy = zx + row.cells;
  float z_x = 0, z_y = 0, z_turn = 0, v_x = 0, v_y = 0, v_turn = 0, zr = 0, zv = 0, ev = 0, er = 0;

#pragma omp simd reduction(+ : z_x, z_y, z_turn, v_x, v_y, v_turn, zr, zv, ev, er)
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
    v_x += vx;
    v_y += vy;
    v_turn += xi[i] * vy;
    zr += x * rx[i] + y * ry[i];
    zv += x * vx + y * vy;
    ev += ex * vx + ey * vy;
    er += ex * rx[i] + ey * ry[i];
  }
  *sums = (Products){{(double)z_x, (double)z_y, (double)z_turn - row.eta * (double)z_x},
                     {(double)v_x, (double)v_y, (double)v_turn - row.eta * (double)v_x},
                     (double)zr,
                     (double)zv,
                     (double)ev,
                     (double)er};
}

/* z = z - P a + beta P step. */
SAM_VECTORIZED static void RowDirection(const Work *w, Row row, const double a[3], float beta)
{
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first,
                        *restrict ny = nx + row.cells, *restrict xi = row.xi;
  const float *restrict dx = w->step + row.first, *restrict dy = dx + row.cells;
  float *restrict zx = w->z + row.first, *restrict zy = zx + row.cells;
  const float ax = (float)SamFrameX(a, row.eta), a1 = (float)a[1], a2 = (float)a[2];

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const float in = weight[i] > 0 ? 1.0f : 0.0f, x = beta * dx[i] - ax, y = beta * dy[i] - a1 - a2 * xi[i],
                part = nx[i] * x + ny[i] * y;

    zx[i] += in * (x - part * nx[i]);
    zy[i] += in * (y - part * ny[i]);
  }
}

/* Step 2: z = P M r + beta P step, conjugate to the last step. */
static PetscErrorCode NewDirection(Work *w)
{
  SamStickSlip *u                                         = &w->base;
  SamTotal      totals[sizeof(Products) / sizeof(double)] = {{0, 0}};
  Products      sums;
  double        a[3], beta = 0;

  PetscFunctionBegin;
  PetscCall(SamTangentialPreconditionSingle(u->solver, u->level, u->self, w->z, w->z));
  for (PetscInt j = 0; j < u->rows; j++) {
    Products row;

    RowPreconditioned(w, GetRow(w, j), &row);
    SamAddAll(PRODUCTS, totals, (const double *)&row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, PRODUCTS, totals, (double *)&sums));
  SamFrameSolve(u->frame, w->gram, sums.z, a);
  if (sums.ev > 0) beta = -(sums.zv - (a[0] * sums.v[0] + a[1] * sums.v[1] + a[2] * sums.v[2])) / sums.ev;
  if (!(beta > 0) || sums.zr + beta * sums.er < DESCENT * sums.zr) beta = 0;
  for (PetscInt j = 0; j < u->rows; j++) RowDirection(w, GetRow(w, j), a, (float)beta);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  trial = q + alpha z. Cells that slip go beyond their circles, as far as their slip in units of c, but at least to
  twice their bound. So the projection, which restores equilibrium by a common shift, leaves them on the circle:
  otherwise half of them would be pulled inside, and convergence would be linear instead of quadratic. And it turns them
  by what a change of the motion would turn them by.
*/
SAM_VECTORIZED static void RowAddStep(const Work *w, Row row, double alpha)
{
  const SamStickSlip *u      = &w->base;
  const double        unit_q = alpha * w->unit / u->self;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict zx = w->z + row.first,
                        *restrict zy = zx + row.cells, *restrict weight = w->weight + row.first;
  const double *restrict b = u->bound + row.first, *restrict qx = u->q + row.first, *restrict qy = qx + row.cells;
  double *restrict vx = w->trial + row.first, *restrict vy = vx + row.cells;

#pragma omp simd
  for (int i = 0; i < row.count; i++) {
    const double x = qx[i] + unit_q * (double)zx[i], y = qy[i] + unit_q * (double)zy[i],
                 slips = nx[i] * nx[i] + ny[i] * ny[i] > 0.5f ? 1 : 0;
    const double in = weight[i] > 0 ? 1 : 0, far = 1 / ((double)(weight[i] * weight[i]) + (1 - in)),
                 push  = far > 2 ? far : 2;
    const double scale = 1 + slips * (b[i] * push / sqrt(x * x + y * y + (1 - slips)) - 1);

    vx[i] = scale * x;
    vy[i] = scale * y;
  }
}

/* step = trial - q, in units; its products with s, with r, with L, and its square. */
SAM_VECTORIZED static void RowChange(const Work *w, Row row, double sums[4])
{
  const SamStickSlip *u       = &w->base;
  const double        inverse = u->self / w->unit;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells, *restrict ax = w->trial + row.first,
                         *restrict ay = ax + row.cells;
  const double *restrict sx = u->s + row.first, *restrict sy = sx + row.cells;
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first,
                        *restrict ny = nx + row.cells, *restrict rx = w->r + row.first, *restrict ry = rx + row.cells;
  float *restrict dx = w->step + row.first, *restrict dy = dx + row.cells;
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

/* The trial becomes an admissible shear near it, or the nearest one, step and its products the way there. */
static PetscErrorCode Project(Work *w, PetscBool nearest, PetscBool *found)
{
  SamStickSlip *u         = &w->base;
  SamTotal      totals[4] = {{0, 0}};
  double        sums[4];

  PetscFunctionBegin;
  PetscCall(SamFrameProjectTangential(u->frame, u->bound, nearest, w->trial, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[4] = {0, 0, 0, 0};

    RowChange(w, GetRow(w, j), row);
    SamAddAll(4, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, 4, totals, sums));
  w->slope = sums[0] / w->unit;
  w->along = sums[1];
  w->bend  = sums[2];
  w->size  = sums[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 3, and what it is to the energy. */
static PetscErrorCode Try(Work *w, PetscBool *found)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) RowAddStep(w, GetRow(w, j), w->alpha);
  PetscCall(Project(w, PETSC_FALSE, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The same along the slip itself, as far as is downhill for modes of the contact's size; only the nearest shear is sure
  to be.
*/
static PetscErrorCode TryGradient(Work *w, PetscBool *found)
{
  SamStickSlip *u      = &w->base;
  const double  length = 1 / (u->self * w->reach);

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    const ptrdiff_t first = (ptrdiff_t)j * u->nx + u->first[j], last = (ptrdiff_t)j * u->nx + u->last[j];

    for (ptrdiff_t k = first; k < last; k++) {
      w->trial[k]            = u->q[k] - length * u->s[k];
      w->trial[k + u->cells] = u->q[k + u->cells] - length * u->s[k + u->cells];
    }
  }
  PetscCall(Project(w, PETSC_TRUE, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step changes the energy by less than what rounding makes of the work of friction in it. */
static PetscBool IsRounding(const Work *w)
{
  return fabs(w->slope) * w->unit * w->unit / w->base.self <= ENERGY_ROUNDING * w->work ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsDownhill(const Work *w)
{
  return (IsRounding(w) ? w->along > 0 : w->slope < 0) ? PETSC_TRUE : PETSC_FALSE;
}

/* step.u, and u.u. */
SAM_VECTORIZED static void RowCurvature(const Work *w, Row row, double sums[2])
{
  const float *restrict dx = w->step + row.first, *restrict dy = dx + row.cells, *restrict ux = w->u + row.first,
                        *restrict uy = ux + row.cells;
  float curvature = 0, norm = 0;

#pragma omp simd reduction(+ : curvature, norm)
  for (int i = 0; i < row.count; i++) {
    curvature += dx[i] * ux[i] + dy[i] * uy[i];
    norm += ux[i] * ux[i] + uy[i] * uy[i];
  }
  sums[0] += (double)curvature;
  sums[1] += (double)norm;
}

/*
  Step 4, and step 1 of the next iteration. `best` is the length of the step for which the residual would be normal to
  it, were the circles followed; `least` that of least energy on the straight way to the trial, which is admissible.
*/
static PetscErrorCode Step(Work *w, double *best)
{
  SamStickSlip *u         = &w->base;
  SamTotal      totals[2] = {{0, 0}};
  double        sums[2], least, t;

  PetscFunctionBegin;
  PetscCall(SamTangentialApplySingle(u->solver, u->level, 1 / u->self, w->step, w->u));
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[2] = {0, 0};

    RowCurvature(w, GetRow(w, j), row);
    SamAddAll(2, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, 2, totals, sums));
  *best = w->along / (sums[0] + w->bend);
  least = -w->slope / sums[0];
  t     = IsRounding(w) ? *best : PetscMin(PetscMax(*best, LEAST_PART * PetscMin(1, least)), LARGEST_PART * least);
  t     = PetscMin(1, t);
  w->doubt += SINGLE_ROUNDING * t * sqrt(sums[1]) * w->unit / u->self;
  PetscCall(Advance(w, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The most that the error can be. */
static double Error(const Work *w)
{
  return w->base.error + (w->doubt > 0 ? w->doubt / w->base.scale : 0);
}

/* Computes the slip anew where what is in doubt about it matters. */
static PetscErrorCode Refresh(Work *w)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  if (w->doubt <= DOUBT * PetscMax(u->error, u->level->rtol) * u->scale) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(Advance(w, 0));
  w->doubt = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamTangentialReason Reason(const Work *w, PetscInt stagnant)
{
  const SamStickSlip *u = &w->base;

  if (!isfinite(u->error)) return SAM_TANGENTIAL_DIVERGED_NAN;
  if (Error(w) <= u->level->rtol) return SAM_TANGENTIAL_CONVERGED_RTOL;
  if (u->level->finest && u->solver->solver.iterations >= SamSolverMaxIterations(&u->solver->solver))
    return SAM_TANGENTIAL_DIVERGED_ITS;
  return stagnant > STAGNATION ? SAM_TANGENTIAL_DIVERGED_STAGNATED : SAM_TANGENTIAL_CONVERGED_ITERATING;
}

/* One iteration. `good`: there was a way down. */
static PetscErrorCode Iterate(Work *w, PetscBool gradient, PetscBool *good, PetscBool *found)
{
  SamStickSlip *u    = &w->base;
  double        best = 0;

  PetscFunctionBegin;
  if (!gradient) {
    PetscCall(NewDirection(w));
    PetscCall(Try(w, found));
    gradient = (!*found || !IsDownhill(w)) ? PETSC_TRUE : PETSC_FALSE;
  }
  if (gradient) PetscCall(TryGradient(w, found));
  *good = (*found && IsDownhill(w)) ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Step(w, &best));
  if (!gradient) w->alpha *= sqrt(PetscMin(PetscMax(LONGER * best, 1 / FOLLOW), FOLLOW));
  PetscCall(Refresh(w));
  SamTangentialIterated(u->solver, u->level);
  PetscCall(SamTangentialMeasured(u->solver, u->level, u->error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Slipping cells, which steps of less than the full length leave a little within their circles, are put on them. */
static PetscErrorCode Finish(Work *w, PetscBool *found)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) RowAddStep(w, GetRow(w, j), 0);
  PetscCall(Project(w, PETSC_FALSE, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  w->doubt += (1 + w->reach) * sqrt(w->size) * w->unit / u->self;
  PetscCall(PetscArraycpy(u->q, w->trial, 2 * u->cells));
  PetscCall(Refresh(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamTangentialSolve_Newton(SamTangential solver, SamTangentialLevel *level)
{
  Work                w = {.alpha = FIRST_LENGTH};
  SamStickSlip       *u = &w.base;
  SamTangentialReason reason;
  double              best;
  PetscInt            stagnant = 0;

  PetscFunctionBegin;
  PetscCall(CreateWork(solver, level, &w));
  PetscCall(SamStickSlipStart(u));
  PetscCall(Advance(&w, 0));
  best   = u->error;
  reason = Reason(&w, stagnant);
  while (!reason) {
    const PetscBool gradient = stagnant > 0 && stagnant % PATIENCE == 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscBool       good = PETSC_TRUE, found = PETSC_TRUE;

    PetscCall(Iterate(&w, gradient, &good, &found));
    if (good && Error(&w) <= level->rtol) PetscCall(Finish(&w, &found));
    if (!good || !found) {
      reason = SAM_TANGENTIAL_DIVERGED_STAGNATED; /* the loads can be carried, that was found out before */
      break;
    }
    stagnant = u->error < 0.9 * best ? 0 : stagnant + 1;
    best     = PetscMin(best, u->error);
    reason   = Reason(&w, stagnant);
  }
  solver->reason       = reason;
  solver->solver.error = Error(&w);
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = u->motion[c];
  PetscCall(DestroyWork(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTangentialCreate_Newton(SamTangential solver)
{
  PetscFunctionBegin;
  solver->solve                 = SamTangentialSolve_Newton;
  solver->solver.default_levels = PETSC_MAX_INT;
  solver->solver.default_max_it = 2000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

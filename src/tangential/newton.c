/*
  Newton's method on stick and slip, with preconditioned projected conjugate gradients.

  Problem: minimise q.C q/2 + offset.q over the discs |q| <= b in equilibrium (or with given rigid displacements); its
  gradient is the slip increment s. Strictly convex, so there is one solution.
    1. Cells on their circle with s.q < 0 slip, the others stick. Unknown are both components of q in stick, and the one
       along the circle in slip; P projects on them.
    2. Newton's step delta: conjugate gradients on P(C + L)P in the null space of equilibrium, L = |s|/b in slip (the
       curvature of the circle). Preconditioned by P(w M w + (1 - h)/2(L + c))P, M the spectral inverse of C, c a cell's
       self-influence, h = c/(L + c), which is 1 in stick, and w = sqrt(h). It ends when the residual has fallen enough,
       or is smaller than what the discs will cut off.
    3. q becomes the nearest admissible shear: discs and equilibrium at once (SamFrameProjectTangential), the slipping
       cells having been pushed outward before.
    4. The energy may rise in a step; if the error has not fallen for several, the best point between the old and the new
       q is taken, or a projected gradient step. If it still does not fall, every other step is one: a few cells that slip
       and are to be released can hold up Newton's steps, which the discs cut off at once, but not the gradient's.
  Stops on the residual of q = D(q - s/c), which only the solution makes zero.

  Step 2 is done in single precision, at half the cost, in units of its residual; so is the slip that the whole step causes.
  Their rounding is counted, and before it can matter the slip is computed anew in double precision.
  References: Dostal and Kucera 2010, SIAM J. Optim. 20, 2913 (separable convex constraints); Alart and Curnier 1991,
  CMAME 92, 353 (semi-smooth Newton for friction); the classical alternative is Wang, Jin, Zhang and Keer 2010.
*/
#include "tangentialimpl.h"
#include <math.h>

/*
  The step ends when its residual has fallen by this factor, or the shear that the discs will cut off, times c, exceeds
  this part of it (squared). Both were chosen by counting: half or twice of either changes the counts by a few per cent.
  Once a step leaves the slipping cells what they were, the next falls by more, and in the end to this part of the tolerance;
  not by more, since the rounding of single precision remains of what the step began with.
*/
#define INNER_FALL  0.02
#define PROPORTION  0.3
#define SETTLED_FALL 1e-3
#define LAST_FALL   0.7
/* A cell is on its circle from this part of the bound on. */
#define ON_CIRCLE (1 - 1e-9)
/*
  Rounding of a product in single precision, relative, and the part of the error that it may make up before the slip is
  computed anew; at the end it is less than this part of the tolerance.
*/
#define SINGLE_ROUNDING 3e-7
#define DOUBT           1e-4
/* Steps without progress before the energy is watched, before every other step follows the gradient, and before giving up. */
#define PATIENCE   4
#define JAMMED     8
#define STAGNATION 40

/* Floats are in units of the step's first residual: slip in unit, shear in unit/c. */
typedef struct {
  SamStickSlip base;
  double      *old;            /* q at the start of the step */
  float       *normal;         /* q/|q| where a cell slips, 0 where it sticks */
  float       *weight;         /* w; 0 outside the contact */
  float       *r, *d, *z;      /* residual P(-s - L delta); direction; C d, or the preconditioned residual */
  float       *delta;
  float       *xi;             /* of the columns */
  double       unit;           /* m */
  double       gram[SAM_GRAM]; /* of the tangent space */
  double       shift[3];       /* change of the motion in this step, in units */
  double       residual, rz;
  double       doubt;          /* norm of what rounding may be in s/c since the last product in double precision, Pa */
  PetscInt     changed;        /* cells that began or ceased to slip */
} Work;

/* The contact's part of a row: cells first ... first + count - 1 of the arrays. */
typedef struct {
  ptrdiff_t    first, count, cells;
  const float *xi;
  double       xi0, dxi, eta;
} Row;

static Row GetRow(const Work *w, PetscInt j)
{
  const SamStickSlip *u = &w->base;

  return (Row){.first = (ptrdiff_t)j * u->nx + u->first[j], .count = u->last[j] - u->first[j], .cells = u->cells, .xi = w->xi + u->first[j], .xi0 = u->frame->xi0 + (double)u->first[j] * u->frame->dxi, .dxi = u->frame->dxi, .eta = SamFrameEta(u->frame, j)};
}

static PetscErrorCode CreateWork(SamTangential solver, SamTangentialLevel *level, Work *w)
{
  const SamFrame *f = &level->frame;
  PetscInt        n;

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, &w->base));
  n = 2 * w->base.cells;
  PetscCall(PetscCalloc6(n, &w->normal, n / 2, &w->weight, n, &w->r, n, &w->d, n, &w->z, n, &w->delta));
  PetscCall(PetscMalloc2(n, &w->old, w->base.nx, &w->xi));
  for (PetscInt i = 0; i < w->base.nx; i++) w->xi[i] = (float)(f->xi0 + (double)i * f->dxi);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Work *w)
{
  PetscFunctionBegin;
  PetscCall(PetscFree6(w->normal, w->weight, w->r, w->d, w->z, w->delta));
  PetscCall(PetscFree2(w->old, w->xi));
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over cells: those that began or ceased to slip; in the tangent space the slip with the phi, and the Gram matrix. */
typedef struct {
  double changed, sums[3], gram[SAM_GRAM];
} Space;

#define SPACE ((PetscInt)(sizeof(Space) / sizeof(double)))

/* Step 1 for a row, and the sums of the tangent space that it makes; returns the largest slip there. */
SAM_VECTORIZED static double RowClassify(const Work *w, Row row, Space *space)
{
  const SamStickSlip *u       = &w->base;
  const double        inverse = 1 / u->self;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells, *restrict sx = u->s + row.first, *restrict sy = sx + row.cells;
  const double *restrict bound = u->bound + row.first;
  float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict weight = w->weight + row.first;
  double changed = 0, most = 0, x = 0, y = 0, turn = 0, hxx = 0, hxy = 0, hyy = 0, xi_hxy = 0, xi_hyy = 0, xi2_hyy = 0;

#pragma omp simd reduction(+ : changed, x, y, turn, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy) reduction(max : most)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const double b = bound[i], in = b > 0 ? 1 : 0, xi = row.xi0 + (double)i * row.dxi, power = sx[i] * qx[i] + sy[i] * qy[i], q2 = qx[i] * qx[i] + qy[i] * qy[i];
    const double slips = (b > 0 && power < 0 && q2 >= ON_CIRCLE * ON_CIRCLE * b * b) ? 1 : 0, slipped = (nx[i] != 0 || ny[i] != 0) ? 1 : 0;
    const double scale = slips > 0 ? 1 / sqrt(q2) : 0, vx = scale * qx[i], vy = scale * qy[i], part = vx * sx[i] + vy * sy[i];
    const double px = in * (sx[i] - part * vx), py = in * (sy[i] - part * vy), gxx = in - vx * vx, gxy = -vx * vy, gyy = in - vy * vy;
    const double largest = fabs(px) > fabs(py) ? fabs(px) : fabs(py);

    changed += slips != slipped ? 1 : 0;
    nx[i]     = (float)vx;
    ny[i]     = (float)vy;
    weight[i] = (float)(slips > 0 ? 1 / sqrt(1 - inverse * power * scale * scale) : in);
    most = largest > most ? largest : most;
    SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi);
  }
  space->changed += changed;
  space->sums[0] += x;
  space->sums[1] += y;
  space->sums[2] += turn - row.eta * x;
  SamGramTangentialRow(space->gram, hxx, hxy, hyy, xi_hxy, xi_hyy, xi2_hyy, row.eta);
  return most;
}

/* r = P(a - s), in units. */
SAM_VECTORIZED static void RowFirstResidual(const Work *w, Row row, double inverse, const double a[3])
{
  const SamStickSlip *u = &w->base;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells, *restrict sx = u->s + row.first, *restrict sy = sx + row.cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict weight = w->weight + row.first;
  float *restrict rx = w->r + row.first, *restrict ry = rx + row.cells;
  const double ax = SamFrameX(a, row.eta), a1 = a[1], a2 = a[2];

#pragma omp simd
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const double x = ax - sx[i], y = a1 + a2 * (row.xi0 + (double)i * row.dxi) - sy[i], q2 = qx[i] * qx[i] + qy[i] * qy[i];
    const double part = (nx[i] != 0 || ny[i] != 0) ? (x * qx[i] + y * qy[i]) / q2 : 0, scale = weight[i] > 0 ? inverse : 0;

    rx[i] = (float)(scale * (x - part * qx[i]));
    ry[i] = (float)(scale * (y - part * qy[i]));
  }
}

/* Step 1, the Gram matrix of the tangent space, the unit, the motion that fits best, and the first residual. */
static PetscErrorCode Classify(Work *w)
{
  SamStickSlip *u      = &w->base;
  SamTotal      totals[sizeof(Space) / sizeof(double)] = {{0, 0}};
  Space         space;
  double        most   = 0, a[3], inverse;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    Space        row     = {0};
    const double largest = RowClassify(w, GetRow(w, j), &row);

    most = PetscMax(most, largest);
    SamAddAll(SPACE, totals, (const double *)&row);
  }
  PetscCall(SamMax(u->level->grid->comm, 1, &most));
  PetscCall(SamSumTotals(u->level->grid->comm, SPACE, totals, (double *)&space));
  w->unit    = most;
  w->changed = (PetscInt)space.changed;
  PetscCall(PetscArraycpy(w->gram, space.gram, SAM_GRAM));
  SamFrameSolve(u->frame, w->gram, space.sums, a);
  inverse = w->unit > 0 ? 1 / w->unit : 0;
  for (PetscInt c = 0; c < 3; c++) w->shift[c] = a[c] * inverse;
  for (PetscInt j = 0; j < u->rows; j++) RowFirstResidual(w, GetRow(w, j), inverse, a);
  PetscCall(PetscArraycpy(w->old, u->q, 2 * u->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scales the residual for the preconditioner, into z; returns its square. */
SAM_VECTORIZED static double RowScale(const Work *w, Row row)
{
  const float *restrict weight = w->weight + row.first, *restrict rx = w->r + row.first, *restrict ry = rx + row.cells;
  float *restrict zx = w->z + row.first, *restrict zy = zx + row.cells;
  float norm = 0;

#pragma omp simd reduction(+ : norm)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const float x = weight[i] * rx[i], y = weight[i] * ry[i];

    zx[i] = x;
    zy[i] = y;
    norm += x * x + y * y;
  }
  return (double)norm;
}

/* The square of the shear, in units, by which sticking cells are beyond their circles. */
SAM_VECTORIZED static double RowCut(const Work *w, Row row)
{
  const SamStickSlip *u      = &w->base;
  const double        unit_q = w->unit / u->self;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict ex = w->delta + row.first, *restrict ey = ex + row.cells;
  const double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells, *restrict b = u->bound + row.first;
  double any = 0, sum = 0;

#pragma omp simd reduction(+ : any)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const double vx = qx[i] + unit_q * (double)ex[i], vy = qy[i] + unit_q * (double)ey[i], over = vx * vx + vy * vy - b[i] * b[i];

    any += (over > 0 && nx[i] == 0 && ny[i] == 0) ? 1 : 0;
  }
  if (any == 0) return 0; /* mostly so: no divisions */
#pragma omp simd reduction(+ : sum)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const double vx = qx[i] + unit_q * (double)ex[i], vy = qy[i] + unit_q * (double)ey[i], v2 = vx * vx + vy * vy;
    const double size = (v2 > b[i] * b[i] && nx[i] == 0 && ny[i] == 0) ? sqrt(v2) - b[i] : 0;

    sum += size * size;
  }
  return sum / (unit_q * unit_q);
}

/* z = 0 beside the contact's rows, which alone are written to. */
static PetscErrorCode ClearMargins(Work *w)
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

/* Prepares the preconditioner's input, and measures the residual. */
static PetscErrorCode Scale(Work *w, double *cut)
{
  SamStickSlip *u         = &w->base;
  SamTotal      totals[2] = {{0, 0}};
  double        sums[2];

  PetscFunctionBegin;
  PetscCall(ClearMargins(w));
  for (PetscInt j = 0; j < u->rows; j++) {
    const Row row = GetRow(w, j);

    SamAdd(&totals[0], RowScale(w, row));
    SamAdd(&totals[1], RowCut(w, row));
  }
  PetscCall(SamSumTotals(u->level->grid->comm, 2, totals, sums));
  w->residual = sums[0];
  *cut        = sums[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* z = P(w z + rest r), and its sums with the phi and with r. */
SAM_VECTORIZED static void RowPreconditioned(const Work *w, Row row, double sums[4])
{
  const float *restrict weight = w->weight + row.first, *restrict rx = w->r + row.first, *restrict ry = rx + row.cells;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict xi = row.xi;
  float *restrict zx = w->z + row.first, *restrict zy = zx + row.cells;
  float x = 0, y = 0, turn = 0, product = 0;

#pragma omp simd reduction(+ : x, y, turn, product)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const float g = weight[i], h = g * g, rest = 0.5f * (1 - h) * h, part = g * (nx[i] * zx[i] + ny[i] * zy[i]);
    const float vx = g * zx[i] - part * nx[i] + rest * rx[i], vy = g * zy[i] - part * ny[i] + rest * ry[i];

    zx[i] = vx;
    zy[i] = vy;
    x += vx;
    y += vy;
    turn += xi[i] * vy;
    product += vx * rx[i] + vy * ry[i];
  }
  sums[0] += (double)x;
  sums[1] += (double)y;
  sums[2] += (double)turn - row.eta * (double)x;
  sums[3] += (double)product;
}

/* d = z - P a + beta d. */
SAM_VECTORIZED static void RowDirection(const Work *w, Row row, const double a[3], float beta)
{
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict xi = row.xi;
  const float *restrict zx = w->z + row.first, *restrict zy = zx + row.cells;
  float *restrict dx = w->d + row.first, *restrict dy = dx + row.cells;
  const float ax = (float)SamFrameX(a, row.eta), a1 = (float)a[1], a2 = (float)a[2];

#pragma omp simd
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const float in = weight[i] > 0 ? 1.0f : 0.0f, ay = a1 + a2 * xi[i], part = nx[i] * ax + ny[i] * ay;

    dx[i] = zx[i] - in * (ax - part * nx[i]) + beta * dx[i];
    dy[i] = zy[i] - in * (ay - part * ny[i]) + beta * dy[i];
  }
}

/* d = P M r + beta d. */
static PetscErrorCode NewDirection(Work *w, PetscBool first)
{
  SamStickSlip *u         = &w->base;
  SamTotal      totals[4] = {{0, 0}};
  double        sums[4], a[3], beta;

  PetscFunctionBegin;
  PetscCall(SamTangentialPreconditionSingle(u->solver, u->level, u->self, w->z, w->z));
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[4] = {0, 0, 0, 0};

    RowPreconditioned(w, GetRow(w, j), row);
    SamAddAll(4, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, 4, totals, sums));
  SamFrameSolve(u->frame, w->gram, sums, a);
  beta  = first ? 0 : sums[3] / w->rz;
  w->rz = sums[3];
  for (PetscInt j = 0; j < u->rows; j++) RowDirection(w, GetRow(w, j), a, (float)beta);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d.(C + L) d, C d in z. */
SAM_VECTORIZED static double RowCurvature(const Work *w, Row row)
{
  const float *restrict weight = w->weight + row.first;
  const float *restrict dx = w->d + row.first, *restrict dy = dx + row.cells, *restrict tx = w->z + row.first, *restrict ty = tx + row.cells;
  float sum = 0;

#pragma omp simd reduction(+ : sum)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const float h = weight[i] * weight[i], lambda = h > 0 ? (1 - h) / h : 0;

    sum += dx[i] * (tx[i] + lambda * dx[i]) + dy[i] * (ty[i] + lambda * dy[i]);
  }
  return (double)sum;
}

/* delta += alpha d, r -= alpha P(C + L) d, and the sums of r with the phi. */
SAM_VECTORIZED static void RowStep(const Work *w, Row row, float alpha, double sums[3])
{
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict xi = row.xi;
  const float *restrict dx = w->d + row.first, *restrict dy = dx + row.cells, *restrict tx = w->z + row.first, *restrict ty = tx + row.cells;
  float *restrict rx = w->r + row.first, *restrict ry = rx + row.cells, *restrict ex = w->delta + row.first, *restrict ey = ex + row.cells;
  float x = 0, y = 0, turn = 0;

#pragma omp simd reduction(+ : x, y, turn)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const float h = weight[i] * weight[i], step = h > 0 ? alpha : 0, lambda = h > 0 ? (1 - h) / h : 0, part = nx[i] * tx[i] + ny[i] * ty[i];
    const float vx = rx[i] - step * (tx[i] - part * nx[i] + lambda * dx[i]), vy = ry[i] - step * (ty[i] - part * ny[i] + lambda * dy[i]);

    ex[i] += alpha * dx[i];
    ey[i] += alpha * dy[i];
    rx[i] = vx;
    ry[i] = vy;
    x += vx;
    y += vy;
    turn += xi[i] * vy;
  }
  sums[0] += (double)x;
  sums[1] += (double)y;
  sums[2] += (double)turn - row.eta * (double)x;
}

/* r -= P a. */
SAM_VECTORIZED static void RowBalance(const Work *w, Row row, const double a[3])
{
  const float *restrict weight = w->weight + row.first, *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict xi = row.xi;
  float *restrict rx = w->r + row.first, *restrict ry = rx + row.cells;
  const float ax = (float)SamFrameX(a, row.eta), a1 = (float)a[1], a2 = (float)a[2];

#pragma omp simd
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const float in = weight[i] > 0 ? 1.0f : 0.0f, ay = a1 + a2 * xi[i], part = nx[i] * ax + ny[i] * ay;

    rx[i] -= in * (ax - part * nx[i]);
    ry[i] -= in * (ay - part * ny[i]);
  }
}

/* One step of conjugate gradients along d, and the residual after it; `good` is false when there is no direction left. */
static PetscErrorCode Step(Work *w, PetscBool *good)
{
  SamStickSlip *u         = &w->base;
  SamTotal      total = {0, 0}, totals[3] = {{0, 0}};
  double        curvature, alpha, sums[3], a[3];

  PetscFunctionBegin;
  PetscCall(SamTangentialApplySingle(u->solver, u->level, 1 / u->self, w->d, w->z));
  for (PetscInt j = 0; j < u->rows; j++) SamAdd(&total, RowCurvature(w, GetRow(w, j)));
  PetscCall(SamSumTotals(u->level->grid->comm, 1, &total, &curvature));
  *good = (curvature > 0 && w->rz > 0) ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
  alpha = w->rz / curvature;
  for (PetscInt j = 0; j < u->rows; j++) {
    double row[3] = {0, 0, 0};

    RowStep(w, GetRow(w, j), (float)alpha, row);
    SamAddAll(3, totals, row);
  }
  PetscCall(SamSumTotals(u->level->grid->comm, 3, totals, sums));
  SamFrameSolve(u->frame, w->gram, sums, a);
  for (PetscInt j = 0; j < u->rows; j++) RowBalance(w, GetRow(w, j), a);
  for (PetscInt c = 0; c < 3; c++) w->shift[c] -= a[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 2: delta, from 0. */
static PetscErrorCode NewtonStep(Work *w)
{
  SamStickSlip *u    = &w->base;
  PetscBool     good = PETSC_TRUE, done;
  double        goal, fall, cut = 0;

  PetscFunctionBegin;
  PetscCall(Classify(w));
  PetscCall(PetscArrayzero(w->d, 2 * u->cells));
  PetscCall(PetscArrayzero(w->delta, 2 * u->cells));
  if (w->unit == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Scale(w, &cut));
  fall = PetscMax(LAST_FALL * u->level->rtol / u->error, w->changed > 0 ? INNER_FALL : SETTLED_FALL);
  goal = fall * fall * w->residual;
  done = w->residual == 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt it = 0; !done; it++) {
    PetscCall(NewDirection(w, it == 0 ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(Step(w, &good));
    if (!good) break;
    PetscCall(Scale(w, &cut));
    SamTangentialIterated(u->solver, u->level);
    done = (w->residual <= goal || cut > PROPORTION * w->residual || !isfinite(w->residual)) ? PETSC_TRUE : PETSC_FALSE;
    if (u->level->finest && u->solver->solver.iterations >= SamSolverMaxIterations(&u->solver->solver)) done = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  q += delta. Cells that slip go beyond their circles, so that the projection, which restores equilibrium by a common shift,
  leaves them on it: otherwise half of them would be pulled inside, and convergence would be linear instead of quadratic.
*/
SAM_VECTORIZED static void RowAddStep(const Work *w, Row row)
{
  const SamStickSlip *u      = &w->base;
  const double        unit_q = w->unit / u->self;
  const float *restrict nx = w->normal + row.first, *restrict ny = nx + row.cells, *restrict ex = w->delta + row.first, *restrict ey = ex + row.cells;
  const double *restrict b = u->bound + row.first;
  double *restrict qx = u->q + row.first, *restrict qy = qx + row.cells;

#pragma omp simd
  for (ptrdiff_t i = 0; i < row.count; i++) {
    const double x = qx[i] + unit_q * (double)ex[i], y = qy[i] + unit_q * (double)ey[i];
    const double scale = (nx[i] != 0 || ny[i] != 0) ? 2 * b[i] / sqrt(x * x + y * y) : 1;

    qx[i] = scale * x;
    qy[i] = scale * y;
  }
}

/* z = q - old, in units. */
SAM_VECTORIZED static void RowChange(const Work *w, Row row)
{
  const SamStickSlip *u       = &w->base;
  const double        inverse = u->self / w->unit;

  for (PetscInt c = 0; c < 2; c++) {
    const double *restrict q = u->q + row.first + c * row.cells, *restrict old = w->old + row.first + c * row.cells;
    float *restrict z = w->z + row.first + c * row.cells;

#pragma omp simd
    for (ptrdiff_t i = 0; i < row.count; i++) z[i] = (float)((q[i] - old[i]) * inverse);
  }
}

/* s += unit z - shift; returns the square of z. */
SAM_VECTORIZED static double RowUpdateSlip(const Work *w, Row row)
{
  const SamStickSlip *u    = &w->base;
  const double        unit = w->unit, ax = SamFrameX(w->shift, row.eta), a1 = w->shift[1], a2 = w->shift[2];
  const float *restrict zx = w->z + row.first, *restrict zy = zx + row.cells;
  double *restrict sx = u->s + row.first, *restrict sy = sx + row.cells;
  float norm = 0;

#pragma omp simd reduction(+ : norm)
  for (ptrdiff_t i = 0; i < row.count; i++) {
    sx[i] += unit * (double)zx[i] - ax;
    sy[i] += unit * (double)zy[i] - a1 - a2 * (row.xi0 + (double)i * row.dxi);
    norm += zx[i] * zx[i] + zy[i] * zy[i];
  }
  return (double)norm;
}

/* s and the motion after the step from `old` to q; how much the rounding may be. */
static PetscErrorCode UpdateSlip(Work *w)
{
  SamStickSlip *u     = &w->base;
  SamTotal      total = {0, 0};
  double        norm;

  PetscFunctionBegin;
  if (w->unit == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ClearMargins(w));
  for (PetscInt j = 0; j < u->rows; j++) RowChange(w, GetRow(w, j));
  PetscCall(SamTangentialApplySingle(u->solver, u->level, 1 / u->self, w->z, w->z));
  for (PetscInt c = 0; c < 3; c++) w->shift[c] *= w->unit;
  for (PetscInt j = 0; j < u->rows; j++) SamAdd(&total, RowUpdateSlip(w, GetRow(w, j)));
  for (PetscInt c = 0; c < 3; c++) u->motion[c] += w->shift[c];
  PetscCall(SamSumTotals(u->level->grid->comm, 1, &total, &norm));
  w->doubt += SINGLE_ROUNDING * sqrt(norm) * w->unit / u->self;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The error after a step. Where rounding matters, the slip is computed anew. */
static PetscErrorCode Measure(Work *w)
{
  SamStickSlip *u = &w->base;

  PetscFunctionBegin;
  PetscCall(SamStickSlipMeasure(u));
  if (w->doubt <= DOUBT * PetscMax(u->error, u->level->rtol) * u->scale) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(SamStickSlipMeasure(u));
  w->doubt = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* q = old + alpha (q - old), and its slip. */
static PetscErrorCode StepBetween(Work *w, double alpha)
{
  SamStickSlip *u = &w->base;
  const double *from = w->old;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2 * u->cells; k++) u->q[k] = from[k] + alpha * (u->q[k] - from[k]);
  PetscCall(SamStickSlipComputeSlip(u));
  w->doubt = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A projected gradient step from `old` of the length 1/(compliance at the contact's size), made the best by a search. */
static PetscErrorCode GradientStep(Work *w)
{
  SamStickSlip *u    = &w->base;
  const double *from = w->old;
  double       *slip, sums[3] = {0, 0, 0}, before, after, length;
  PetscBool     found;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(u->q, from, 2 * u->cells));
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(SamStickSlipMeasure(u));
  PetscCall(SamStickSlipEnergy(u, &before));
  PetscCall(PetscMalloc1(2 * u->cells, &slip));
  PetscCall(PetscArraycpy(slip, u->s, 2 * u->cells));
  for (PetscInt j = 0; j < u->rows; j++)
    for (PetscInt k = j * u->nx + u->first[j]; k < j * u->nx + u->last[j]; k++) sums[2] += u->bound[k] > 0;
  PetscCall(SamSum(u->level->grid->comm, 3, sums));
  length = 1 / (u->self * sqrt(sums[2]));
  for (PetscInt k = 0; k < 2 * u->cells; k++) u->q[k] -= length * slip[k];
  PetscCall(SamFrameProjectTangential(u->frame, u->bound, u->q, &found));
  sums[0] = 0;
  for (PetscInt k = 0; k < 2 * u->cells; k++) sums[0] += slip[k] * (u->q[k] - from[k]);
  PetscCall(PetscFree(slip));
  PetscCall(SamSum(u->level->grid->comm, 1, sums));
  PetscCall(StepBetween(w, 1));
  PetscCall(SamStickSlipEnergy(u, &after));
  if (sums[0] < 0 && 2 * (after - before - sums[0]) > -sums[0]) PetscCall(StepBetween(w, -sums[0] / (2 * (after - before - sums[0]))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 4, from the admissible `old` of that energy to q. */
static PetscErrorCode EnsureDescent(Work *w, double before)
{
  SamStickSlip *u    = &w->base;
  const double *from = w->old;
  double        after, sum = 0, slope, curvature;

  PetscFunctionBegin;
  PetscCall(SamStickSlipEnergy(u, &after));
  if (after <= before + 1e-13 * fabs(before)) PetscFunctionReturn(PETSC_SUCCESS);
  /* after = before + slope + curvature/2, and s.(q - from) = slope + curvature at q */
  for (PetscInt k = 0; k < 2 * u->cells; k++) sum += (u->q[k] - from[k]) * u->s[k];
  PetscCall(SamSum(u->level->grid->comm, 1, &sum));
  curvature = 2 * (sum - (after - before));
  slope     = sum - curvature;
  if (slope < 0 && curvature > 0) PetscCall(StepBetween(w, -slope / curvature));
  else PetscCall(GradientStep(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamTangentialReason Reason(const SamStickSlip *u, PetscInt stagnant)
{
  if (!isfinite(u->error)) return SAM_TANGENTIAL_DIVERGED_NAN;
  if (u->error <= u->level->rtol) return SAM_TANGENTIAL_CONVERGED_RTOL;
  if (u->level->finest && u->solver->solver.iterations >= SamSolverMaxIterations(&u->solver->solver)) return SAM_TANGENTIAL_DIVERGED_ITS;
  return stagnant > STAGNATION ? SAM_TANGENTIAL_DIVERGED_STAGNATED : SAM_TANGENTIAL_CONVERGED_ITERATING;
}

/* A projected gradient step in place of a round. */
static PetscErrorCode GradientRound(Work *w)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(w->old, w->base.q, 2 * w->base.cells));
  PetscCall(GradientStep(w));
  PetscCall(Measure(w));
  SamTangentialIterated(w->base.solver, w->base.level);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps 1 to 4 once. */
static PetscErrorCode Round(Work *w, PetscBool watch, PetscBool *found)
{
  SamStickSlip *u = &w->base;
  double        energy = 0;

  PetscFunctionBegin;
  if (watch) PetscCall(SamStickSlipEnergy(u, &energy));
  PetscCall(NewtonStep(w));
  for (PetscInt j = 0; j < u->rows; j++) RowAddStep(w, GetRow(w, j));
  PetscCall(SamFrameProjectTangential(u->frame, u->bound, u->q, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(UpdateSlip(w));
  if (watch) PetscCall(EnsureDescent(w, energy));
  PetscCall(Measure(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamTangentialSolve_Newton(SamTangential solver, SamTangentialLevel *level)
{
  Work                w = {.doubt = 0};
  SamStickSlip       *u = &w.base;
  SamTangentialReason reason;
  double              best;
  PetscInt            stagnant = 0;

  PetscFunctionBegin;
  PetscCall(CreateWork(solver, level, &w));
  PetscCall(SamStickSlipStart(u));
  best   = u->error;
  reason = Reason(u, stagnant);
  while (!reason) {
    PetscBool found = PETSC_TRUE;

    if (stagnant > JAMMED && stagnant % 2) PetscCall(GradientRound(&w));
    else PetscCall(Round(&w, stagnant > PATIENCE ? PETSC_TRUE : PETSC_FALSE, &found));
    if (!found) {
      reason = SAM_TANGENTIAL_DIVERGED_STAGNATED; /* the loads can be carried, that was found out before */
      break;
    }
    PetscCall(SamTangentialMeasured(solver, level, u->error));
    stagnant = u->error < 0.9 * best ? 0 : stagnant + 1;
    best     = PetscMin(best, u->error);
    reason   = Reason(u, stagnant);
  }
  solver->reason = reason;
  solver->solver.error = u->error;
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

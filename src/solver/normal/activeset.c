/*
  Projected preconditioned conjugate gradients on a changing active set.

  Problem: minimise p.S p/2 + h.p over the admissible p: p >= 0, in equilibrium (or with given rigid displacements).
  An iteration, with one product:
    1. A: the cells where pressure is, or is to be: those without that penetrate are in A, those with little that are to
  part are not. The rigid displacements (the multipliers of equilibrium) make the gap g on A smallest. The residual is
  -g on A.
    2. Direction: the preconditioned residual, with the part of the last step that makes the two conjugate. Both stay
       meaningful when A changes, as the last step is the difference of two pressures, whose product is known.
    3. Trial: the pressure on A, 0 outside, admissible and nearest to p + alpha times the direction, alpha as last was
  best.
    4. The product of trial - p gives the best point between p and the trial, or beyond as long as p >= 0. When no cell
  meets its bound that is the step of linear conjugate gradients. So p is admissible and the energy falls throughout,
  cells enter and leave by the thousand without a product of their own, and conjugacy is kept. If the trial is uphill,
  or the error has not fallen for several iterations, the direction is the residual itself: projected gradient steps
  with the best length converge whatever is between them. Stops when |g| under pressure and -g elsewhere are below the
  tolerance, relative to the largest displacement.

  Preconditioner: |k| on A, less half its loss. |k| = |k|' + loss on A: |k|' is what the differences of a field within A
  cost, loss = |k| 1_A what it costs that the field ends at the edge of A. The inverse of S on A lies between the two:
  the field outside is free, not zero. The loss grows at edges like 1/distance, which |k| alone has too much.

  Steps and their products are in single precision, at half the cost; p and g are not. What rounding g collects is a
  part of about 1e-7 of the largest error since the last product in double precision; before it matters there is another
  one. Coarse grids, solved roughly, need none. References: Polonsky and Keer 1999, Wear 231, 206-219 (projected CG for
  contact); Dostal 2009, Optimal Quadratic Programming Algorithms, ch. 5 (active sets with CG); Stanley and Kato 1997,
  J. Tribol. 119, 481-485 (the spectrum); Bogdan, Burdzy and Chen 2003, Probab. Theory Relat. Fields 127, 89-152 (|k| on
  a part of the plane, with and without loss).
*/
#include <petsam/private/normalimpl.h>
#include <float.h>
#include <math.h>
#include <string.h>

/*
  A cell parts when the gap is more than its own pressure and that of its neighbours displace it, in units of the
  former.
*/
#define PATCH 6.0
/* The part of the loss that is taken off, and that of A that may change before the loss is computed anew. */
#define LOSS_OFF 0.5
#define LOSS_OLD 0.01
/* A direction's least descent, as a part of that of the preconditioned residual. */
#define DESCENT 0.1
/* The trial's length follows the best one by at most this factor's root. */
#define FOLLOW 2.0
/*
  Rounding of g as a part of the largest error since it was computed in double precision, the part of the tolerance
  that it may be at the end, and the fall of the error after which g is computed anew in any case.
*/
#define SINGLE_ROUNDING 3e-7
#define DOUBT           0.03
#define FALL            1e-3
/*
  Iterations without progress before a gradient step, and before giving up: then it is rounding that stands in the way.
*/
#define PATIENCE   10
#define STAGNATION 100

typedef struct {
  SamNormal       normal;
  SamNormalLevel *level;
  const SamFrame *frame;
  PetscInt        nx, rows, cells;
  Vec             vg;
  double         *p, *g;     /* pressure; gap */
  float          *z, *s, *u; /* direction; last step; S s: z and s in units of unit/self, u in units of `unit` */
  float          *loss;      /* what is taken off the preconditioner; 0 on cells that were not in A then */
  float          *xi;        /* of the columns */
  double          unit;      /* m, of the iteration */
  const double   *h;
  float          *active;         /* 1 on cells of A, else 0 */
  PetscInt        stretches;      /* of a row */
  char           *busy;           /* stretches with cells of A, or pressure */
  double         *least;          /* of others: the least gap when p went its last step; none known: -infinity */
  double          gram[SAM_GRAM]; /* of A */
  double          motion[3];      /* rigid displacement in g, fixed part included */
  double          displacement;   /* largest |S p| */
  double          self;           /* influence of a cell on itself, m/Pa */
  double error, worst;  /* largest complementarity error, m: now, and since g was a product (in single precision: its
                          displacement) */
  double slope, shrink; /* of the step: s.g; largest part of its pressure that a cell loses */
  double curvature;     /* s.u; 0: no step yet */
  double alpha;         /* length of the trial */
} Work;

#define FLOATS 5

static PetscErrorCode CreateWork(SamNormal normal, SamNormalLevel *level, Work *w)
{
  float **const floats[FLOATS] = {&w->z, &w->s, &w->u, &w->loss, &w->active};

  PetscFunctionBegin;
  PetscCall(PetscMemzero(w, sizeof(*w)));
  w->normal = normal;
  w->level  = level;
  w->frame  = &level->frame;
  w->nx     = level->grid->nx;
  w->rows   = level->grid->rows;
  w->cells  = level->grid->cells;
  w->alpha  = 1;
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &w->self, NULL));
  PetscCall(SamGridCreateVec(level->grid, 1, &w->vg));
  PetscCall(VecGetArray(level->p, &w->p));
  PetscCall(VecGetArrayRead(level->h, &w->h));
  PetscCall(VecGetArray(w->vg, &w->g));
  w->stretches = SamStretches(level->grid);
  PetscCall(PetscCalloc2(w->rows * w->stretches, &w->busy, w->rows * w->stretches, &w->least));
  for (PetscInt k = 0; k < FLOATS; k++) PetscCall(SamAllocate(sizeof(***floats) * (size_t)w->cells, floats[k]));
  PetscCall(PetscArrayzero(w->s, w->cells));
  PetscCall(PetscArrayzero(w->u, w->cells));
  PetscCall(PetscArrayzero(w->loss, w->cells));
  PetscCall(PetscMalloc1(w->nx, &w->xi));
  for (PetscInt i = 0; i < w->nx; i++) w->xi[i] = (float)(w->frame->xi0 + (double)i * w->frame->dxi);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->p, &w->p));
  PetscCall(VecRestoreArrayRead(w->level->h, &w->h));
  PetscCall(VecRestoreArray(w->vg, &w->g));
  PetscCall(VecDestroy(&w->vg));
  PetscCall(PetscFree2(w->busy, w->least));
  SamFree(w->z);
  SamFree(w->s);
  SamFree(w->u);
  SamFree(w->loss);
  SamFree(w->active);
  PetscCall(PetscFree(w->xi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of gaps: g + h - motion; returns the largest |g| before. */
SAM_VECTORIZED static double GapRow(PetscInt n, double *restrict g, const double *restrict h, double xi0, double dxi,
                                    double eta, const double motion[3])
{
  const double a = motion[0] - motion[1] * eta, b = motion[2];
  double       max = 0;

#pragma omp simd reduction(max : max)
  for (PetscInt i = 0; i < n; i++) {
    const double size = fabs(g[i]);

    max  = size > max ? size : max;
    g[i] = g[i] + h[i] - a - b * (xi0 + (double)i * dxi);
  }
  return max;
}

/* Single precision for S p is all that the tolerance asks for. */
static PetscBool IsSingleEnough(const Work *w)
{
  return SINGLE_ROUNDING <= DOUBT * w->level->rtol ? PETSC_TRUE : PETSC_FALSE;
}

/* g = S p in single precision. */
static PetscErrorCode ApplySingle(Work *w)
{
  double most = 0, scale;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) most = w->p[k] > most ? w->p[k] : most;
  PetscCall(SamMax(w->level->grid->comm, 1, &most));
  if (most == 0) most = 1;
  for (PetscInt k = 0; k < w->cells; k++) w->z[k] = (float)(w->p[k] / most);
  PetscCall(SamNormalApplySingle(w->normal, w->level, 1 / w->self, w->z, w->z));
  scale = w->self * most;
  for (PetscInt k = 0; k < w->cells; k++) w->g[k] = scale * (double)w->z[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* g = S p */
static PetscErrorCode Apply(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->p, &w->p));
  PetscCall(VecRestoreArray(w->vg, &w->g));
  PetscCall(SamNormalApply(w->normal, w->level, w->level->p, w->vg));
  PetscCall(VecGetArray(w->level->p, &w->p));
  PetscCall(VecGetArray(w->vg, &w->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* g = S p + h - motion, and the largest displacement. */
static PetscErrorCode ComputeGap(Work *w)
{
  const SamFrame *f   = w->frame;
  double          max = 0;

  PetscFunctionBegin;
  if (IsSingleEnough(w))
    PetscCall(ApplySingle(w));
  else
    PetscCall(Apply(w));
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k    = (ptrdiff_t)j * w->nx;
    const double    size = GapRow(w->nx, w->g + k, w->h + k, f->xi0, f->dxi, SamFrameEta(f, j), w->motion);

    max = SamLarger(max, size);
  }
  for (PetscInt k = 0; k < w->rows * w->stretches; k++) w->least[k] = -INFINITY;
  PetscCall(SamMax(w->level->grid->comm, 1, &max));
  w->displacement = max;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over a row's cells of A: their number, xi, xi^2, g and xi g. */
typedef struct {
  double count, xi, xi2, g, xi_g;
} RowSums;

/*
  A in a stretch of a row: the cells with p > ease times the gap, which `motion` moves back first; adds to their sums.
  Whether any is, or has pressure.
*/
SAM_VECTORIZED static PetscBool ChooseStretch(PetscInt n, const double *restrict p, const double *restrict g,
                                              double ease, double xi0, double dxi, double eta, const double motion[3],
                                              float *restrict active, RowSums *sums)
{
  const double a = motion[0] - motion[1] * eta, b = motion[2];
  double       count = 0, xi = 0, xi2 = 0, sum = 0, turn = 0, pressure = 0;

#pragma omp simd reduction(+ : count, xi, xi2, sum, turn, pressure)
  for (PetscInt i = 0; i < n; i++) {
    const double x = xi0 + (double)i * dxi, v = g[i] - (a + b * x), in = p[i] > ease * v ? 1 : 0;

    active[i] = (float)in;
    count += in;
    xi += in * x;
    xi2 += in * x * x;
    sum += in * v;
    turn += in * x * v;
    pressure += p[i];
  }
  sums->count += count;
  sums->xi += xi;
  sums->xi2 += xi2;
  sums->g += sum;
  sums->xi_g += turn;
  return count > 0 || pressure > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static void AddRow(RowSums row, double eta, SamTotal totals[])
{
  double sums[SAM_GRAM + 3] = {[SAM_GRAM] = row.g, -eta * row.g, row.xi_g};

  SamGramNormalRow(sums, row.count, row.xi, row.xi2, eta);
  SamAddAll(SAM_GRAM + 3, totals, sums);
}

/* Adds to the motion what fits the gap to the cells that were summed, whose Gram matrix becomes w's. */
static PetscErrorCode Fit(Work *w, SamTotal totals[], double motion[3])
{
  double sums[SAM_GRAM + 3], a[3];

  PetscFunctionBegin;
  PetscCall(SamSumTotals(w->level->grid->comm, SAM_GRAM + 3, totals, sums));
  PetscCall(PetscArraycpy(w->gram, sums, SAM_GRAM));
  SamFrameSolve(w->frame, w->gram, sums + SAM_GRAM, a);
  for (PetscInt c = 0; c < 3; c++) motion[c] += a[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a stretch without pressure has no gap that `motion` could close; rounding is the same as that of the gaps. */
static PetscBool IsClear(const Work *w, PetscInt stretch, PetscInt i, PetscInt n, double eta, const double motion[3])
{
  const SamFrame *f = w->frame;
  const double    a = motion[0] - motion[1] * eta, b = motion[2];
  const double most = PetscMax(a + b * (f->xi0 + (double)i * f->dxi), a + b * (f->xi0 + (double)(i + n - 1) * f->dxi));

  return !w->busy[stretch] && w->least[stretch] > most ? PETSC_TRUE : PETSC_FALSE;
}

/* A in a row, and which of its stretches are busy: by the gap that `motion` has moved back. */
static RowSums ChooseRow(Work *w, PetscInt j, double ease, const double motion[3])
{
  const SamFrame *f   = w->frame;
  const double    eta = SamFrameEta(f, j);
  RowSums         row = {0};

  for (PetscInt i = 0, stretch = j * w->stretches; i < w->nx; i += SAM_STRETCH, stretch++) {
    const PetscInt  n = PetscMin(SAM_STRETCH, w->nx - i);
    const ptrdiff_t k = (ptrdiff_t)j * w->nx + i;

    if (IsClear(w, stretch, i, n, eta, motion)) continue; /* what was not busy has no cell of A */
    w->busy[stretch] =
      ChooseStretch(n, w->p + k, w->g + k, ease, f->xi0 + (double)i * f->dxi, f->dxi, eta, motion, w->active + k, &row)
        ? 1
        : 0;
  }
  return row;
}

/* Chooses A by the gap that `motion` has moved back, and adds to it what fits it to A. */
static PetscErrorCode Choose(Work *w, double ease, double motion[3])
{
  SamTotal totals[SAM_GRAM + 3] = {{0, 0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const RowSums row = ChooseRow(w, j, ease, motion);

    AddRow(row, SamFrameEta(w->frame, j), totals);
  }
  PetscCall(Fit(w, totals, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A row of gaps moved by the rigid displacement -motion; returns the largest complementarity error: |g| under pressure,
  -g elsewhere.
*/
SAM_VECTORIZED static double MoveRow(PetscInt n, double *restrict g, const double *restrict p, double xi0, double dxi,
                                     double eta, const double motion[3])
{
  const double a = motion[0] - motion[1] * eta, b = motion[2];
  double       sum = 0, error = 0;

#pragma omp simd reduction(+ : sum) reduction(max : error)
  for (PetscInt i = 0; i < n; i++) {
    const double v = g[i] - (a + b * (xi0 + (double)i * dxi)), wrong = p[i] > 0 ? fabs(v) : -v;

    g[i] = v;
    sum += v;
    error = wrong > error ? wrong : error;
  }
  return isfinite(sum) ? error : NAN;
}

/*
  Chooses A by the gap that fits the cells with pressure best, moves g to fit A, and measures it. `contact`: the sums
  over the cells with pressure, when they are known.
*/
static PetscErrorCode ChooseSet(Work *w, SamTotal contact[])
{
  const SamFrame *f         = w->frame;
  double          motion[3] = {0, 0, 0}, error = 0;

  PetscFunctionBegin;
  if (contact)
    PetscCall(Fit(w, contact, motion));
  else
    PetscCall(Choose(w, 0, motion));
  PetscCall(Choose(w, 1 / (PATCH * w->self), motion));
  for (PetscInt c = 0; c < 3; c++) w->motion[c] += motion[c];
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * w->nx;

    error = SamLarger(error, MoveRow(w->nx, w->g + k, w->p + k, f->xi0, f->dxi, SamFrameEta(f, j), motion));
  }
  PetscCall(SamMax(w->level->grid->comm, 1, &error));
  w->error = error;
  w->worst = SamLarger(w->worst, error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* g by a product, and the set by it. */
static PetscErrorCode Refresh(Work *w)
{
  PetscFunctionBegin;
  PetscCall(ComputeGap(w));
  w->worst = IsSingleEnough(w) ? w->displacement : 0;
  PetscCall(ChooseSet(w, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many cells have a loss and are not in A, or the other way round. */
SAM_VECTORIZED static double CountChanged(PetscInt n, const float *restrict loss, const float *restrict active)
{
  float changed = 0; /* exact: a row has fewer cells than a float counts */

#pragma omp simd reduction(+ : changed)
  for (PetscInt i = 0; i < n; i++) changed += fabsf((loss[i] > 0 ? 1.0f : 0.0f) - active[i]);
  return (double)changed;
}

SAM_VECTORIZED static void LossRow(PetscInt n, const float *restrict active, float *restrict loss)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    const float some = (float)LOSS_OFF * loss[i];

    loss[i] = active[i] * (some > FLT_MIN ? some : FLT_MIN);
  }
}

/* The part of |k| 1_A that is taken off the preconditioner, when A is no longer the one it was computed for. */
static PetscErrorCode UpdateLoss(Work *w)
{
  double changed = 0;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++)
    changed += CountChanged(w->nx, w->loss + (ptrdiff_t)j * w->nx, w->active + (ptrdiff_t)j * w->nx);
  PetscCall(SamSum(w->level->grid->comm, 1, &changed));
  if (changed <= LOSS_OLD * w->gram[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamNormalPreconditionSingle(w->normal, w->level, w->self, w->active, w->loss));
  for (PetscInt j = 0; j < w->rows; j++)
    LossRow(w->nx, w->active + (ptrdiff_t)j * w->nx, w->loss + (ptrdiff_t)j * w->nx);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The busy cells of a row: see SamNextBusy(). */
static const char *BusyOfRow(const Work *w, PetscInt j)
{
  return w->busy + (ptrdiff_t)j * w->stretches;
}

/* The residual, in units. */
SAM_VECTORIZED static void ResidualRow(PetscInt n, const double *restrict g, const float *restrict active,
                                       double   inverse, float *restrict z)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) z[i] = active[i] * (float)(-inverse * g[i]);
}

static PetscErrorCode ComputeResidual(Work *w)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(w->z, w->cells));
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * w->nx;

    for (PetscInt i = 0, end = 0; SamNextBusy(BusyOfRow(w, j), w->nx, &i, &end);)
      ResidualRow(end - i, w->g + k + i, w->active + k + i, 1 / w->unit, w->z + k + i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  What a stretch of a row adds to a direction's sums over A: moments of z and of u (without the factor of eta); z.r,
  z.u, s.r.
*/
typedef struct {
  double z, z_turn, u, u_turn, zr, zu, sr;
} Products;

/* z = |k| r less the loss of r, and its products, added to `sums`. */
SAM_VECTORIZED static void PreconditionedRow(PetscInt n, const double *restrict g, const float *restrict s,
                                             const float *restrict u, const float *restrict loss,
                                             const float *restrict active, const float *restrict xi, double inverse,
                                             float *restrict z, Products *sums)
{
  float  z_sum = 0, z_turn = 0, u_sum = 0, u_turn = 0, zu = 0;
  double zr = 0, sr = 0;

#pragma omp simd reduction(+ : z_sum, z_turn, u_sum, u_turn, zu, zr, sr)
  for (PetscInt i = 0; i < n; i++) {
    const float r = active[i] * (float)(-inverse * g[i]), v = active[i] * (z[i] - loss[i] * r), w = active[i] * u[i];

    z[i] = v;
    z_sum += v;
    z_turn += xi[i] * v;
    u_sum += w;
    u_turn += xi[i] * w;
    zu += v * w;
    zr += (double)v * (double)r;
    sr += (double)s[i] * (double)r;
  }
  sums->z += (double)z_sum;
  sums->z_turn += (double)z_turn;
  sums->u += (double)u_sum;
  sums->u_turn += (double)u_turn;
  sums->zr += zr;
  sums->zu += (double)zu;
  sums->sr += sr;
}

/* Where a cell is not in A, z is of no use, and stays what it is. */
SAM_VECTORIZED static void DirectionRow(PetscInt n, const float *restrict s, const float *restrict xi, double eta,
                                        const double motion[3], float beta, float *restrict z)
{
  const float a = (float)(motion[0] - motion[1] * eta), b = (float)motion[2];

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) z[i] = z[i] - a - b * xi[i] + beta * s[i];
}

/* z = P M r + beta s on A, conjugate to the last step. */
static PetscErrorCode NewDirection(Work *w)
{
  const SamFrame *f         = w->frame;
  SamTotal        totals[9] = {{0, 0}};
  double          sums[9], a[3], beta = 0;

  PetscFunctionBegin;
  PetscCall(UpdateLoss(w));
  PetscCall(ComputeResidual(w));
  PetscCall(SamNormalPreconditionSingle(w->normal, w->level, w->self, w->z, w->z));
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k   = (ptrdiff_t)j * w->nx;
    const double    eta = SamFrameEta(f, j);
    Products        row = {0};

    for (PetscInt i = 0; i < w->nx; i += SAM_STRETCH) {
      const PetscInt  n = PetscMin(SAM_STRETCH, w->nx - i);
      const ptrdiff_t m = k + i;

      if (BusyOfRow(w, j)[i / SAM_STRETCH])
        PreconditionedRow(n, w->g + m, w->s + m, w->u + m, w->loss + m, w->active + m, w->xi + i, 1 / w->unit, w->z + m,
                          &row);
    }
    SamAddAll(9, totals,
              (const double[9]){row.z, -eta * row.z, row.z_turn, row.u, -eta * row.u, row.u_turn, row.zr, row.zu,
                                row.sr});
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 9, totals, sums));
  SamFrameSolve(f, w->gram, sums, a);
  if (w->curvature > 0) beta = -(sums[7] - (a[0] * sums[3] + a[1] * sums[4] + a[2] * sums[5])) / w->curvature;
  if (!(beta > 0) || sums[6] + beta * sums[8] < DESCENT * sums[6]) beta = 0;
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * w->nx;

    for (PetscInt i = 0, end = 0; SamNextBusy(BusyOfRow(w, j), w->nx, &i, &end);)
      DirectionRow(end - i, w->s + k + i, w->xi + i, SamFrameEta(f, j), a, (float)beta, w->z + k + i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slope of the step to the trial p, in some cells of a row; raises `shrink`. */
SAM_VECTORIZED static double TrialRow(PetscInt n, const double *restrict p, const double *restrict g,
                                      const float *restrict s, double pressure, double *shrink)
{
  double slope = 0, most = 0;

#pragma omp simd reduction(+ : slope) reduction(max : most)
  for (PetscInt i = 0; i < n; i++) {
    const double less = s[i] < 0 ? -pressure * (double)s[i] : 0, part = less > 0 ? less / (p[i] + less) : 0;

    slope += (double)s[i] * g[i];
    most = part > most ? part : most;
  }
  *shrink = PetscMax(*shrink, most);
  return slope;
}

/* p goes to the admissible pressure on A nearest to p + alpha z; s is the step there. */
static PetscErrorCode Try(Work *w, double alpha, PetscBool *found)
{
  const double pressure = w->unit / w->self;
  SamTotal     total    = {0, 0};

  PetscFunctionBegin;
  PetscCall(
    SamFrameProjectNormalStep(w->frame, w->active, w->busy, w->p, alpha * pressure, w->z, 1 / pressure, w->s, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  w->shrink = 0;
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k   = (ptrdiff_t)j * w->nx;
    double          row = 0;

    for (PetscInt i = 0, end = 0; SamNextBusy(BusyOfRow(w, j), w->nx, &i, &end);)
      row += TrialRow(end - i, w->p + k + i, w->g + k + i, w->s + k + i, pressure, &w->shrink);
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, &w->slope));
  PetscCall(SamMax(w->level->grid->comm, 1, &w->shrink));
  w->slope /= w->unit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Along the residual, with no cell made to part, as far as is downhill for modes like that of all the pressure. */
static PetscErrorCode TryGradient(Work *w, PetscBool *found)
{
  double most = 0;

  PetscFunctionBegin;
  (void)memset(w->busy, 1, (size_t)(w->rows * w->stretches)); /* cells may enter anywhere */
  for (PetscInt k = 0; k < w->cells; k++) {
    w->active[k] = w->p[k] > 0 || w->g[k] < 0 ? 1.0f : 0.0f;
    most         = PetscMax(most, w->p[k]);
  }
  PetscCall(SamMax(w->level->grid->comm, 1, &most));
  PetscCall(ComputeResidual(w));
  PetscCall(Try(w, most / w->displacement * w->self, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In single precision: no more cells at a time than a stretch has. */
SAM_VECTORIZED static double CurvatureStretch(PetscInt n, const float *restrict s, const float *restrict u)
{
  float sum = 0;

#pragma omp simd reduction(+ : sum)
  for (PetscInt i = 0; i < n; i++) sum += s[i] * u[i];
  return (double)sum;
}

/*
  From the trial, where p has gone by s, by so much more: what is left to rounding of a pressure is none. Adds to the
  sums over cells with pressure.
*/
SAM_VECTORIZED static void StepRow(PetscInt n, const float *restrict s, const float *restrict u, double by_s,
                                   double rounding, double by_u, double xi0, double dxi, double *restrict p,
                                   double *restrict g, RowSums *sums)
{
  double count = 0, xi = 0, xi2 = 0, sum = 0, turn = 0;

#pragma omp simd reduction(+ : count, xi, xi2, sum, turn)
  for (PetscInt i = 0; i < n; i++) {
    const double v = p[i] + by_s * (double)s[i], gap = g[i] + by_u * (double)u[i], x = xi0 + (double)i * dxi;
    const double in = v > rounding * fabs((double)s[i]) ? 1 : 0;

    p[i] = in * v;
    g[i] = gap;
    count += in;
    xi += in * x;
    xi2 += in * x * x;
    sum += in * gap;
    turn += in * x * gap;
  }
  sums->count += count;
  sums->xi += xi;
  sums->xi2 += xi2;
  sums->g += sum;
  sums->xi_g += turn;
}

/* The same where there is neither pressure nor a step: the least gap. */
SAM_VECTORIZED static double OpenStretch(PetscInt n, const float *restrict u, double by_u, double *restrict g)
{
  double least = INFINITY, sum = 0;

#pragma omp simd reduction(+ : sum) reduction(min : least)
  for (PetscInt i = 0; i < n; i++) {
    const double gap = g[i] + by_u * (double)u[i];

    g[i] = gap;
    sum += gap;
    least = gap < least ? gap : least;
  }
  return isfinite(sum) ? least : -INFINITY;
}

/* From the trial to where the step has the length t instead of 1; the sums over the cells with pressure there. */
static void SetLength(Work *w, double t, SamTotal contact[])
{
  const SamFrame *f        = w->frame;
  const double    pressure = w->unit / w->self;

  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k    = (ptrdiff_t)j * w->nx;
    const char     *busy = BusyOfRow(w, j);
    RowSums         row  = {0};

    for (PetscInt i = 0, end = 0; SamNextBusy(busy, w->nx, &i, &end);)
      StepRow(end - i, w->s + k + i, w->u + k + i, (t - 1) * pressure, SINGLE_ROUNDING * pressure, t * w->unit,
              f->xi0 + (double)i * f->dxi, f->dxi, w->p + k + i, w->g + k + i, &row);
    for (PetscInt i = 0, m = 0; i < w->nx; i += SAM_STRETCH, m++) {
      if (!busy[m])
        w->least[(ptrdiff_t)j * w->stretches + m] =
          OpenStretch(PetscMin(SAM_STRETCH, w->nx - i), w->u + k + i, t * w->unit, w->g + k + i);
    }
    AddRow(row, SamFrameEta(f, j), contact);
  }
}

/* s.u */
static PetscErrorCode ComputeCurvature(Work *w)
{
  SamTotal total = {0, 0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k   = (ptrdiff_t)j * w->nx;
    double          row = 0;

    for (PetscInt i = 0; i < w->nx; i += SAM_STRETCH)
      if (BusyOfRow(w, j)[i / SAM_STRETCH])
        row += CurvatureStretch(PetscMin(SAM_STRETCH, w->nx - i), w->s + k + i, w->u + k + i);
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, &w->curvature));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The least energy between where the step begins and where a pressure vanishes. `best`: its length without that bound.
*/
static PetscErrorCode Step(Work *w, double *best, SamTotal contact[])
{
  PetscFunctionBegin;
  PetscCall(SamNormalApplySingle(w->normal, w->level, 1 / w->self, w->s, w->u));
  PetscCall(ComputeCurvature(w));
  *best = w->curvature > 0 ? PetscMax(-w->slope / w->curvature, 0) : 0;
  SetLength(w, *best * w->shrink > 1 ? 1 / w->shrink : *best, contact);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One iteration. `good`: there was a way down. */
static PetscErrorCode Iterate(Work *w, PetscBool gradient, PetscBool *good, PetscBool *found)
{
  SamTotal contact[SAM_GRAM + 3] = {{0, 0}}, ignored[SAM_GRAM + 3] = {{0, 0}};
  double   best = 0;

  PetscFunctionBegin;
  w->unit = w->error;
  if (!gradient) {
    PetscCall(NewDirection(w));
    PetscCall(Try(w, w->alpha, found));
    gradient = (!*found || w->slope >= 0) ? PETSC_TRUE : PETSC_FALSE;
    if (*found && gradient) SetLength(w, 0, ignored);
  }
  if (gradient) PetscCall(TryGradient(w, found));
  if (*found && w->slope < 0)
    PetscCall(Step(w, &best, contact));
  else if (*found)
    SetLength(w, 0, ignored);
  *good = best > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
  w->alpha = gradient ? 1 : w->alpha * sqrt(PetscMin(PetscMax(best, 1 / FOLLOW), FOLLOW));
  PetscCall(ChooseSet(w, contact));
  PetscCall(SamNormalIterated(w->normal, w->level, w->error / w->displacement));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Tolerance(const Work *w)
{
  return w->level->rtol * w->displacement;
}

/* Single precision has rounded g by no more than the tolerance has room for. */
static PetscBool IsTrusted(const Work *w)
{
  return SINGLE_ROUNDING * w->worst <= DOUBT * Tolerance(w) ? PETSC_TRUE : PETSC_FALSE;
}

/*
  g is to be computed anew: when that makes it trusted to the end, or is the least that can be done about its rounding.
*/
static PetscBool IsStale(const Work *w)
{
  return (!IsTrusted(w) && (SINGLE_ROUNDING * w->error <= DOUBT * Tolerance(w) || w->error <= FALL * w->worst))
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* A row's largest |S p|. */
SAM_VECTORIZED static double DisplacementRow(PetscInt n, const double *restrict g, const double *restrict h, double xi0,
                                             double dxi, double eta, const double motion[3])
{
  const double a = motion[0] - motion[1] * eta, b = motion[2];
  double       max = 0;

#pragma omp simd reduction(max : max)
  for (PetscInt i = 0; i < n; i++) {
    const double size = fabs(g[i] - h[i] + a + b * (xi0 + (double)i * dxi));

    max = size > max ? size : max;
  }
  return max;
}

/* The error is below the tolerance, which the displacement decides that now is. */
static PetscErrorCode IsSolved(Work *w, PetscBool *solved)
{
  const SamFrame *f   = w->frame;
  double          max = 0;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  if (!(w->error <= Tolerance(w)) || !IsTrusted(w)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * w->nx;

    max = PetscMax(max, DisplacementRow(w->nx, w->g + k, w->h + k, f->xi0, f->dxi, SamFrameEta(f, j), w->motion));
  }
  PetscCall(SamMax(w->level->grid->comm, 1, &max));
  w->displacement = max;
  *solved         = w->error <= Tolerance(w) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The reason to stop, when there is one. */
static PetscErrorCode GetReason(Work *w, PetscInt stagnant, PetscBool good, PetscBool found, SamNormalReason *reason)
{
  const SamSolver *solver = &w->normal->solver;
  PetscBool        solved;

  PetscFunctionBegin;
  *reason = SAM_NORMAL_CONVERGED_ITERATING;
  if (!found)
    *reason = SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM;
  else if (!isfinite(w->error))
    *reason = SAM_NORMAL_DIVERGED_NAN;
  if (*reason) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(IsSolved(w, &solved));
  if (solved)
    *reason = SAM_NORMAL_CONVERGED_RTOL;
  else if (w->level->finest && solver->iterations >= SamSolverMaxIterations(solver))
    *reason = SAM_NORMAL_DIVERGED_ITS;
  else if (stagnant > STAGNATION || !good)
    *reason = SAM_NORMAL_DIVERGED_STAGNATED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamNormalSolve_ActiveSet(SamNormal normal, SamNormalLevel *level)
{
  Work            w;
  double          best;
  PetscInt        stagnant = 0;
  PetscBool       good = PETSC_TRUE, found = PETSC_TRUE;
  SamNormalReason reason;

  PetscFunctionBegin;
  PetscCall(CreateWork(normal, level, &w));
  for (PetscInt c = 0; c < 3; c++) w.motion[c] = w.frame->fixed[c];
  PetscCall(Refresh(&w));
  best = w.error;
  PetscCall(GetReason(&w, stagnant, good, found, &reason));
  while (!reason) {
    const PetscBool gradient = stagnant > 0 && stagnant % PATIENCE == 0 ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(Iterate(&w, gradient, &good, &found));
    if (good && (gradient || IsStale(&w))) PetscCall(Refresh(&w));
    stagnant = w.error < 0.9 * best ? 0 : stagnant + 1;
    best     = PetscMin(best, w.error);
    PetscCall(GetReason(&w, stagnant, good, found, &reason));
  }
  /* steps balance to the rounding of single precision only */
  if (found) PetscCall(SamFrameProjectNormalOnContact(w.frame, w.p, &found));
  normal->reason       = reason;
  normal->solver.error = w.error / w.displacement;
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = w.motion[c];
  PetscCall(DestroyWork(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalCreate_ActiveSet(SamNormal normal)
{
  PetscFunctionBegin;
  normal->solve                 = SamNormalSolve_ActiveSet;
  normal->solver.default_levels = PETSC_MAX_INT;
  normal->solver.default_max_it = 1000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

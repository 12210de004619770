/*
  Preconditioned projected conjugate gradients on an active set.

  Problem: minimise p.S p/2 + h.p over p >= 0 in equilibrium (or with given rigid displacements).
    1. On the set A of contact cells, conjugate gradients in the null space of the equilibrium constraints: the residual
       -g and the preconditioned residual are both projected on it (P M P, M of order |k|). The rigid displacements are
       the multipliers that the projection finds.
    2. This goes on while the residual is larger than what is wrong with A (proportioning): p < 0 on it, g < 0 outside.
    3. Then cells with p < 0 leave A, cells with g < 0 enter it, the nearest admissible pressure is taken (p >= 0 on A
       and in equilibrium), and g is computed anew. The energy may rise in a round; if the error has not fallen for
       several, it is made to fall by the best point between the old and the new pressure, which are both admissible.
  Stops when |g| on A and -g outside it are below the tolerance, relative to the largest displacement.

  The directions of step 1 and their products are in single precision, at half the cost, in units of the round's first
  residual; p and g are not. The rounding that g collects in a round is a part of about 1e-7 of what the round began with, so
  a round ends when the residual has fallen by more than a little; the next begins with a product in double precision.
  References: Polonsky and Keer 1999, Wear 231, 206-219 (projected CG for contact); Dostal 2009, Optimal Quadratic
  Programming Algorithms, ch. 5 (active sets with CG); Stanley and Kato 1997, J. Tribol. 119, 481-485 (the spectrum).
*/
#include "normalimpl.h"
#include <math.h>
#include <string.h>

/* The set is changed when what is wrong with it exceeds this part of the residual (both squared). */
#define PROPORTION 0.01
/* A round ends at this part of its first residual, so that rounding stays small. */
#define ROUND_FALL 3e-3
/* Rounding of g in a round, as a part of its first error, and the part of the tolerance that it may be at the end. */
#define SINGLE_ROUNDING 3e-7
#define DOUBT           0.03
/* Rounds without progress before the energy is watched, and before giving up: then it is rounding that stands in the way. */
#define PATIENCE 5
#define STAGNATION 50

typedef struct {
  SamNormal       normal;
  SamNormalLevel *level;
  const SamFrame *frame;
  PetscInt        nx, rows, cells;
  Vec             vg;
  double         *p, *g, *old;         /* pressure; gap; pressure before the round, while the energy is watched */
  float          *d, *s;               /* direction; S d, or the residual, preconditioned or not */
  float          *xi;                  /* of the columns */
  double          unit;                /* of s, m; d is in units of unit/self */
  const double   *h;
  char           *active;              /* cells of A */
  double          gram[SAM_GRAM];      /* of A */
  double          motion[3];           /* rigid displacement in g, fixed part included */
  double          displacement;        /* largest |S p| */
  double          self;                /* influence of a cell on itself, m/Pa */
  double          error;               /* largest complementarity error, m */
  double          residual, rz;        /* |P g| on A, squared; r.z, in units */
  double          pulling, violation;  /* how wrong A is, squared: cells of A that pull; those and the penetrating outside */
} Work;

static PetscErrorCode CreateWork(SamNormal normal, SamNormalLevel *level, Work *w)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(w, sizeof(*w)));
  w->normal = normal;
  w->level  = level;
  w->frame  = &level->frame;
  w->nx     = level->grid->nx;
  w->rows   = level->grid->rows;
  w->cells  = level->grid->cells;
  PetscCall(SamComplianceGetSelfInfluence(level->compliance, &w->self, NULL));
  PetscCall(VecDuplicate(level->p, &w->vg));
  PetscCall(VecGetArray(level->p, &w->p));
  PetscCall(VecGetArrayRead(level->h, &w->h));
  PetscCall(VecGetArray(w->vg, &w->g));
  PetscCall(PetscCalloc1(w->cells, &w->active));
  PetscCall(PetscCalloc2(w->cells, &w->d, w->cells, &w->s));
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
  PetscCall(PetscFree2(w->d, w->s));
  PetscCall(PetscFree(w->xi));
  PetscCall(PetscFree(w->old));
  PetscCall(PetscFree(w->active));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of gaps: g + h - motion; returns the largest |g| before. */
SAM_VECTORIZED static double GapRow(PetscInt n, double *restrict g, const double *restrict h, double xi0, double dxi, double eta, const double motion[3])
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

/* g = S p + h - motion, and the largest displacement. */
static PetscErrorCode ComputeGap(Work *w)
{
  const SamFrame *f   = w->frame;
  double          max = 0;

  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->p, &w->p));
  PetscCall(VecRestoreArray(w->vg, &w->g));
  PetscCall(SamNormalApply(w->normal, w->level, w->level->p, w->vg));
  PetscCall(VecGetArray(w->level->p, &w->p));
  PetscCall(VecGetArray(w->vg, &w->g));
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k    = (ptrdiff_t)j * w->nx;
    const double    size = GapRow(w->nx, w->g + k, w->h + k, f->xi0, f->dxi, SamFrameEta(f, j), w->motion);

    max = SamLarger(max, size);
  }
  PetscCall(SamMax(w->level->grid->comm, 1, &max));
  w->displacement = max;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeGram(Work *w)
{
  const SamFrame *f = w->frame;

  SamTotal totals[SAM_GRAM] = {{0, 0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta           = SamFrameEta(f, j);
    double       row[SAM_GRAM] = {0};

    for (PetscInt i = 0; i < w->nx; i++)
      if (w->active[j * w->nx + i]) SamGramAddNormal(row, f->xi0 + (double)i * f->dxi, eta);
    SamAddAll(SAM_GRAM, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, SAM_GRAM, totals, w->gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum phi g over A of a row. */
SAM_VECTORIZED static void AddMoments(PetscInt n, const double *restrict g, const char *restrict active, double xi0, double dxi, double eta, double sums[3])
{
  double sum = 0, turn = 0;

#pragma omp simd reduction(+ : sum, turn)
  for (PetscInt i = 0; i < n; i++) {
    const double v = active[i] ? g[i] : 0;

    sum += v;
    turn += (xi0 + (double)i * dxi) * v;
  }
  sums[0] += sum;
  sums[1] -= eta * sum;
  sums[2] += turn;
}

/* What a pass over the cells measures: see Work. */
typedef struct {
  double residual, pulling, outside, error;
} Measures;

/*
  A row of gaps moved by the rigid displacement -a, and measured: residual |g|^2 on A, complementarity error (|g| on A, -g
  outside), the gap that letting pulling cells go would cause, and penetration outside A, squared.
*/
SAM_VECTORIZED static void MoveRow(PetscInt n, double *restrict g, const double *restrict p, const char *restrict active, double self, double xi0, double dxi, double eta, const double motion[3], Measures *m)
{
  const double a = motion[0] - motion[1] * eta, b = motion[2];
  double       residual = 0, pulling = 0, outside = 0, error = 0;

#pragma omp simd reduction(+ : residual, pulling, outside) reduction(max : error)
  for (PetscInt i = 0; i < n; i++) {
    const double v = g[i] - (a + b * (xi0 + (double)i * dxi)), in = active[i] ? v : 0, out = active[i] ? 0 : (v < 0 ? v : 0), pull = active[i] ? (p[i] < 0 ? self * p[i] : 0) : 0;
    const double wrong = fabs(in) - out;

    g[i] = v;
    residual += in * in;
    pulling += pull * pull;
    outside += out * out;
    error = wrong > error ? wrong : error;
  }
  m->residual += residual;
  m->pulling += pulling;
  m->outside += outside;
  m->error = SamLarger(m->error, isfinite(residual + outside) ? error : NAN);
}

/* Moves g by the rigid displacement that fits it best on A, and measures it. */
static PetscErrorCode FitMotion(Work *w)
{
  const SamFrame *f         = w->frame;
  SamTotal        totals[3] = {{0, 0}}, squares[3] = {{0, 0}};
  double          sums[3], a[3], error = 0;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k      = (ptrdiff_t)j * w->nx;
    double          row[3] = {0, 0, 0};

    AddMoments(w->nx, w->g + k, w->active + k, f->xi0, f->dxi, SamFrameEta(f, j), row);
    SamAddAll(3, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 3, totals, sums));
  SamFrameSolve(f, w->gram, sums, a);
  for (PetscInt c = 0; c < 3; c++) w->motion[c] += a[c];
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k   = (ptrdiff_t)j * w->nx;
    Measures        row = {0};

    MoveRow(w->nx, w->g + k, w->p + k, w->active + k, w->self, f->xi0, f->dxi, SamFrameEta(f, j), a, &row);
    SamAdd(&squares[0], row.residual);
    SamAdd(&squares[1], row.pulling);
    SamAdd(&squares[2], row.outside);
    error = SamLarger(error, row.error);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 3, squares, sums));
  PetscCall(SamMax(w->level->grid->comm, 1, &error));
  w->residual  = sums[0];
  w->pulling   = sums[1];
  w->violation = sums[1] + sums[2];
  w->error     = error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual, in units, for the preconditioner. */
SAM_VECTORIZED static void ResidualRow(PetscInt n, const double *restrict g, const char *restrict active, double inverse, float *restrict s)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) s[i] = active[i] ? (float)(-inverse * g[i]) : 0.0f;
}

/* Moments of z on A, and r.z in units. */
SAM_VECTORIZED static void PreconditionedRow(PetscInt n, const double *restrict g, const float *restrict z, const char *restrict active, const float *restrict xi, double inverse, double eta, double sums[4])
{
  float  sum = 0, turn = 0;
  double product = 0;

#pragma omp simd reduction(+ : sum, turn, product)
  for (PetscInt i = 0; i < n; i++) {
    const float v = active[i] ? z[i] : 0.0f;

    sum += v;
    turn += xi[i] * v;
    product -= (double)v * g[i];
  }
  sums[0] += (double)sum;
  sums[1] -= eta * (double)sum;
  sums[2] += (double)turn;
  sums[3] += inverse * product;
}

SAM_VECTORIZED static void DirectionRow(PetscInt n, const float *restrict z, const char *restrict active, const float *restrict xi, double eta, const double motion[3], float beta, float *restrict d)
{
  const float a = (float)(motion[0] - motion[1] * eta), b = (float)motion[2];

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) d[i] = active[i] ? z[i] - a - b * xi[i] + beta * d[i] : 0.0f;
}

/* d = P M r + beta d on A. */
static PetscErrorCode NewDirection(Work *w, PetscBool first)
{
  const SamFrame *f       = w->frame;
  const double    inverse = 1 / w->unit;
  SamTotal        totals[4] = {{0, 0}};
  double          sums[4], a[3], beta;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * w->nx;

    ResidualRow(w->nx, w->g + k, w->active + k, inverse, w->s + k);
  }
  PetscCall(SamNormalPreconditionSingle(w->normal, w->level, w->self, w->s, w->s));
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k      = (ptrdiff_t)j * w->nx;
    double          row[4] = {0, 0, 0, 0};

    PreconditionedRow(w->nx, w->g + k, w->s + k, w->active + k, w->xi, inverse, SamFrameEta(f, j), row);
    SamAddAll(4, totals, row);
  }
  PetscCall(SamSumTotals(w->level->grid->comm, 4, totals, sums));
  SamFrameSolve(f, w->gram, sums, a);
  beta  = first ? 0 : sums[3] / w->rz;
  w->rz = sums[3];
  for (PetscInt j = 0; j < w->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * w->nx;

    DirectionRow(w->nx, w->s + k, w->active + k, w->xi, SamFrameEta(f, j), a, (float)beta, w->d + k);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

SAM_VECTORIZED static double CurvatureRow(PetscInt n, const float *restrict d, const float *restrict s)
{
  float sum = 0;

#pragma omp simd reduction(+ : sum)
  for (PetscInt i = 0; i < n; i++) sum += d[i] * s[i];
  return (double)sum;
}

SAM_VECTORIZED static void StepRow(PetscInt n, const float *restrict d, const float *restrict s, double by_d, double by_s, double *restrict p, double *restrict g)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    p[i] += by_d * (double)d[i];
    g[i] += by_s * (double)s[i];
  }
}

/* p += alpha d, g += alpha S d with the exact step; `good` is false when there is no direction left. */
static PetscErrorCode Step(Work *w, PetscBool *good)
{
  SamTotal total = {0, 0};
  double   curvature, alpha;

  PetscFunctionBegin;
  PetscCall(SamNormalApplySingle(w->normal, w->level, 1 / w->self, w->d, w->s));
  for (PetscInt j = 0; j < w->rows; j++) SamAdd(&total, CurvatureRow(w->nx, w->d + (ptrdiff_t)j * w->nx, w->s + (ptrdiff_t)j * w->nx));
  PetscCall(SamSumTotals(w->level->grid->comm, 1, &total, &curvature));
  *good = (curvature > 0 && w->rz > 0) ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
  alpha = w->rz / curvature;
  StepRow(w->cells, w->d, w->s, alpha * w->unit / w->self, alpha * w->unit, w->p, w->g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Conjugate gradients on A until the set should be changed, the tolerance is met or max_it is. `solved`: it is met, and
  no cell pulls. The residual and what is wrong with the set are both gaps, squared, which are compared.
*/
static PetscErrorCode Iterate(Work *w, PetscBool *solved)
{
  const double goal = ROUND_FALL * ROUND_FALL * w->residual, tolerance = w->level->rtol * w->displacement;
  /* after a round that began far from the solution the error is what a product in double precision says */
  const PetscBool trusted = SINGLE_ROUNDING * w->error <= DOUBT * tolerance ? PETSC_TRUE : PETSC_FALSE;
  PetscBool    good = PETSC_TRUE, done = w->residual == 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  w->unit = w->error;
  PetscCall(PetscArrayzero(w->d, w->cells));
  for (PetscInt it = 0; !done; it++) {
    PetscCall(NewDirection(w, it == 0 ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(Step(w, &good));
    if (!good) break;
    PetscCall(FitMotion(w));
    PetscCall(SamNormalIterated(w->normal, w->level, w->error / w->displacement));
    *solved = (trusted && w->error <= tolerance && w->pulling == 0) ? PETSC_TRUE : PETSC_FALSE;
    done    = (*solved || w->violation > PROPORTION * w->residual || w->residual <= goal || !isfinite(w->residual)) ? PETSC_TRUE : PETSC_FALSE;
    if (w->error <= 0.5 * tolerance) done = PETSC_TRUE;
    if (w->level->finest && w->normal->solver.iterations >= SamSolverMaxIterations(&w->normal->solver)) done = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that pull leave A, cells that penetrate enter; p becomes the nearest admissible pressure. */
static PetscErrorCode UpdateSet(Work *w, PetscBool *found)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) {
    w->active[k] = w->active[k] ? w->p[k] > 0 : w->g[k] < 0;
    if (!w->active[k]) w->p[k] = 0;
  }
  PetscCall(SamFrameProjectNormal(w->frame, w->active, w->p, found));
  if (!*found) PetscCall(SamFrameProjectNormal(w->frame, NULL, w->p, found)); /* A alone cannot carry the loads */
  for (PetscInt k = 0; k < w->cells; k++) w->active[k] = (w->p[k] > 0 || (w->active[k] && w->g[k] < 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy p.S p/2 + (h - fixed).p from p and g. */
static PetscErrorCode ComputeEnergy(const Work *w, double *energy)
{
  const SamFrame *f = w->frame;
  double          a[3];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) a[c] = w->motion[c] - 2 * f->fixed[c];
  *energy = 0;
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = SamFrameEta(f, j);

    for (PetscInt i = 0; i < w->nx; i++) {
      const PetscInt k = j * w->nx + i;

      if (w->p[k] > 0) *energy += 0.5 * w->p[k] * (w->g[k] + w->h[k] + SamFrameNormal(a, f->xi0 + (double)i * f->dxi, eta));
    }
  }
  PetscCall(SamSum(w->level->grid->comm, 1, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* p = old + alpha (p - old), and its gap. */
static PetscErrorCode StepBetween(Work *w, double alpha)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) {
    w->p[k]      = w->old[k] + alpha * (w->p[k] - w->old[k]);
    w->active[k] = w->p[k] > 0;
  }
  PetscCall(ComputeGap(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A projected gradient step from `old`, which always finds a lower energy unless `old` is the solution. */
static PetscErrorCode GradientStep(Work *w)
{
  double    sums[1] = {0}, *gap, most = 0, before, after, slope, curvature;
  PetscBool found;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(w->p, w->old, w->cells));
  PetscCall(ComputeGap(w));
  PetscCall(ComputeEnergy(w, &before));
  for (PetscInt k = 0; k < w->cells; k++) most = PetscMax(most, w->p[k]);
  PetscCall(SamMax(w->level->grid->comm, 1, &most));
  PetscCall(PetscMalloc1(w->cells, &gap));
  PetscCall(PetscArraycpy(gap, w->g, w->cells));
  for (PetscInt k = 0; k < w->cells; k++) w->p[k] -= most / w->displacement * w->g[k];
  PetscCall(SamFrameProjectNormal(w->frame, NULL, w->p, &found));
  for (PetscInt k = 0; k < w->cells; k++) sums[0] += gap[k] * (w->p[k] - w->old[k]);
  PetscCall(PetscFree(gap));
  PetscCall(StepBetween(w, 1));
  PetscCall(ComputeEnergy(w, &after));
  PetscCall(SamSum(w->level->grid->comm, 1, sums));
  slope     = sums[0];
  curvature = 2 * (after - before - slope);
  if (slope < 0 && curvature > -slope) PetscCall(StepBetween(w, -slope / curvature));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a change of the set: if the energy has risen, the best point between the old and the new pressure. */
static PetscErrorCode EnsureDescent(Work *w, double *energy)
{
  const double before = *energy;
  double       after, sums[1] = {0}, slope, curvature;

  PetscFunctionBegin;
  PetscCall(ComputeEnergy(w, &after));
  if (after <= before + 1e-12 * fabs(before)) {
    *energy = after;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /* along delta = p - old: after = before + slope + curvature/2, and delta.g = slope + curvature at the new pressure */
  for (PetscInt k = 0; k < w->cells; k++) sums[0] += (w->p[k] - w->old[k]) * w->g[k];
  PetscCall(SamSum(w->level->grid->comm, 1, sums));
  curvature = 2 * (sums[0] - (after - before));
  slope     = sums[0] - curvature;
  if (slope < 0 && curvature > 0) PetscCall(StepBetween(w, -slope / curvature));
  else PetscCall(GradientStep(w));
  PetscCall(ComputeEnergy(w, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first set: where there is pressure, or, without any, where the undeformed bodies overlap. */
static PetscErrorCode Start(Work *w, double *energy)
{
  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; c++) w->motion[c] = w->frame->fixed[c];
  for (PetscInt k = 0; k < w->cells; k++) w->active[k] = w->p[k] > 0;
  PetscCall(ComputeGap(w));
  PetscCall(ComputeEnergy(w, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fits the motion on A and measures the error. */
static PetscErrorCode LookAtSet(Work *w)
{
  PetscFunctionBegin;
  PetscCall(ComputeGram(w));
  PetscCall(FitMotion(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that penetrate enter A, and the motion is fitted anew. */
static PetscErrorCode AddPenetrating(Work *w)
{
  double added = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) {
    if (w->active[k] || w->g[k] >= 0) continue;
    w->active[k] = 1;
    added += 1;
  }
  PetscCall(SamSum(w->level->grid->comm, 1, &added));
  if (added > 0) {
    PetscCall(ComputeGram(w));
    PetscCall(FitMotion(w));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The reason to stop, when there is one, with the set and the gap as they are. */
static SamNormalReason Reason(const Work *w, PetscInt stagnant)
{
  if (!isfinite(w->error)) return SAM_NORMAL_DIVERGED_NAN;
  if (w->error <= w->level->rtol * w->displacement) return SAM_NORMAL_CONVERGED_RTOL;
  if (w->level->finest && w->normal->solver.iterations >= SamSolverMaxIterations(&w->normal->solver)) return SAM_NORMAL_DIVERGED_ITS;
  return stagnant > STAGNATION ? SAM_NORMAL_DIVERGED_STAGNATED : SAM_NORMAL_CONVERGED_ITERATING;
}

/* One round: enter what penetrates, iterate, change the set. */
static PetscErrorCode Round(Work *w, PetscBool watch, double *energy, PetscBool *solved, PetscBool *found)
{
  PetscFunctionBegin;
  *found = PETSC_TRUE;
  PetscCall(AddPenetrating(w));
  if (watch) {
    if (!w->old) PetscCall(PetscMalloc1(w->cells, &w->old));
    PetscCall(PetscArraycpy(w->old, w->p, w->cells));
  }
  PetscCall(Iterate(w, solved));
  if (*solved) { /* the directions balance to the rounding of single precision only */
    PetscCall(SamFrameProjectNormal(w->frame, w->active, w->p, found));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(UpdateSet(w, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ComputeGap(w));
  if (watch) PetscCall(EnsureDescent(w, energy));
  else PetscCall(ComputeEnergy(w, energy));
  PetscCall(LookAtSet(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamNormalSolve_ActiveSet(SamNormal normal, SamNormalLevel *level)
{
  Work            w;
  double          energy, best;
  PetscInt        stagnant = 0;
  SamNormalReason reason;

  PetscFunctionBegin;
  PetscCall(CreateWork(normal, level, &w));
  PetscCall(Start(&w, &energy));
  PetscCall(LookAtSet(&w));
  best   = w.error;
  reason = Reason(&w, stagnant);
  while (!reason) {
    PetscBool solved, found;

    PetscCall(Round(&w, stagnant > PATIENCE ? PETSC_TRUE : PETSC_FALSE, &energy, &solved, &found));
    stagnant = w.error < 0.9 * best ? 0 : stagnant + 1;
    best     = PetscMin(best, w.error);
    reason   = found ? Reason(&w, stagnant) : SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM;
  }
  normal->reason = reason;
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

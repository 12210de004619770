/*
  Newton's method on stick and slip, with preconditioned projected conjugate gradients.

  Problem: minimise q.C q/2 + offset.q over the discs |q| <= b in equilibrium (or with given rigid displacements); its
  gradient is the slip increment s. Strictly convex, so there is one solution.
    1. Cells on their circle with s.q < 0 slip, the others stick. Unknown are both components of q in stick, and the one
       along the circle in slip; T spans them.
    2. Newton's step: conjugate gradients on T'(C + L)T in the null space of equilibrium, L = |s|/b in slip (the curvature
       of the circle). Preconditioned by T(sqrt(h) M sqrt(h) + (1 - h)/2(L + c))T, M the spectral inverse of C, c a cell's
       self-influence and h = c/(L + c), which is 1 in stick. It ends when the residual has fallen enough, or is smaller
       than what the discs will cut off.
    3. q becomes the nearest admissible shear: discs and equilibrium at once (SamFrameProjectTangential), the slipping
       cells having been pushed outward before.
    4. The energy may rise in a step; if the error has not fallen for several, the best point between the old and the new
       q is taken, or a projected gradient step.
  Stops on the residual of q = D(q - s/c), which only the solution makes zero.
  References: Dostal and Kucera 2010, SIAM J. Optim. 20, 2913 (separable convex constraints); Alart and Curnier 1991,
  CMAME 92, 353 (semi-smooth Newton for friction); the classical alternative is Wang, Jin, Zhang and Keer 2010.
*/
#include "tangentialimpl.h"
#include <math.h>

/*
  The step ends when its residual has fallen by this factor, or the shear that the discs will cut off, times c, exceeds
  this part of it (squared). Both were chosen by counting: half or twice of either changes the counts by a few per cent.
*/
#define INNER_FALL 0.1
#define PROPORTION 0.3
/* A cell is on its circle from this part of the bound on. */
#define ON_CIRCLE (1 - 1e-9)
/* Steps without progress before the energy is watched, and before giving up. */
#define PATIENCE   4
#define STAGNATION 40

typedef struct {
  SamStickSlip base;
  char        *slip;          /* 1 where a contact cell slips */
  double      *lambda;        /* L, m/Pa; 0 in stick */
  double      *old;           /* q at the start of the step */
  double      *d, *t;         /* direction; C d, or the preconditioned residual before */
  Vec          vold, vd, vt;
  double       gram[SAM_GRAM]; /* of the tangent space */
  double       residual, rz;
} Work;

static PetscErrorCode CreateWork(SamTangential solver, SamTangentialLevel *level, Work *w)
{
  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(solver, level, &w->base));
  PetscCall(VecDuplicate(level->q, &w->vold));
  PetscCall(VecDuplicate(level->q, &w->vd));
  PetscCall(VecDuplicate(level->q, &w->vt));
  PetscCall(VecGetArray(w->vold, &w->old));
  PetscCall(VecGetArray(w->vd, &w->d));
  PetscCall(VecGetArray(w->vt, &w->t));
  PetscCall(PetscCalloc1(w->base.cells, &w->slip));
  PetscCall(PetscCalloc1(w->base.cells, &w->lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->vold, &w->old));
  PetscCall(VecRestoreArray(w->vd, &w->d));
  PetscCall(VecRestoreArray(w->vt, &w->t));
  PetscCall(VecDestroy(&w->vold));
  PetscCall(VecDestroy(&w->vd));
  PetscCall(VecDestroy(&w->vt));
  PetscCall(PetscFree(w->slip));
  PetscCall(PetscFree(w->lambda));
  PetscCall(SamStickSlipDestroy(&w->base));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 1. */
static void Classify(Work *w)
{
  SamStickSlip *u = &w->base;

  for (PetscInt j = 0; j < u->rows; j++) {
    for (PetscInt k = j * u->nx + u->first[j]; k < j * u->nx + u->last[j]; k++) {
      const PetscInt l = k + u->cells;
      const double   b = u->bound[k], power = u->s[k] * u->q[k] + u->s[l] * u->q[l];

      w->slip[k]   = b > 0 && power < 0 && u->q[k] * u->q[k] + u->q[l] * u->q[l] >= ON_CIRCLE * ON_CIRCLE * b * b;
      w->lambda[k] = w->slip[k] ? -power / (b * b) : 0;
      w->old[k]    = u->q[k];
      w->old[l]    = u->q[l];
    }
  }
}

/* The part of a vector at cell k in the tangent space. */
static inline void ToTangent(const Work *w, PetscInt k, double *x, double *y)
{
  const PetscInt l = k + w->base.cells;
  double         along, b2;

  if (!w->slip[k]) return;
  b2    = w->old[k] * w->old[k] + w->old[l] * w->old[l];
  along = (w->old[k] * *y - w->old[l] * *x) / b2;
  *x    = -along * w->old[l];
  *y    = along * w->old[k];
}

/* Minus the gradient of the quadratic model in the tangent space at cell k. */
static inline void Residual(const Work *w, PetscInt k, double *x, double *y)
{
  const SamStickSlip *u = &w->base;
  const PetscInt      l = k + u->cells;

  *x = -u->s[k] - w->lambda[k] * (u->q[k] - w->old[k]);
  *y = -u->s[l] - w->lambda[k] * (u->q[l] - w->old[l]);
  ToTangent(w, k, x, y);
}

static PetscErrorCode ComputeGram(Work *w)
{
  const SamStickSlip *u = &w->base;
  const SamFrame     *f = u->frame;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(w->gram, SAM_GRAM));
  for (PetscInt j = 0; j < u->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = u->first[j]; i < u->last[j]; i++) {
      const PetscInt k  = j * u->nx + i;
      const double   xi = f->xi0 + (double)i * f->dxi;
      double         xx = 1, xy = 0, yx = 0, yy = 1;

      if (u->bound[k] <= 0) continue;
      ToTangent(w, k, &xx, &xy);
      ToTangent(w, k, &yx, &yy);
      SamGramAddTangential(w->gram, xx, xy, yy, xi, eta);
    }
  }
  PetscCall(SamSum(u->level->grid->comm, SAM_GRAM, w->gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves s by the rigid motion that makes the residual smallest; puts the residual into t, scaled for the preconditioner. */
static PetscErrorCode NewResidual(Work *w, double *cut)
{
  SamStickSlip   *u       = &w->base;
  const SamFrame *f       = u->frame;
  const double    self    = u->self;
  double          sums[3] = {0, 0, 0}, norms[2] = {0, 0}, a[3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < u->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;
    double       x = 0, y = 0, turn = 0; /* sums of the row stay in registers */

    for (PetscInt i = u->first[j]; i < u->last[j]; i++) {
      double rx, ry;

      if (u->bound[j * u->nx + i] <= 0) continue;
      Residual(w, j * u->nx + i, &rx, &ry);
      x -= rx;
      y -= ry;
      turn -= (f->xi0 + (double)i * f->dxi) * ry - eta * rx;
    }
    sums[0] += x;
    sums[1] += y;
    sums[2] += turn;
  }
  PetscCall(SamSum(u->level->grid->comm, 3, sums));
  SamFrameSolve(f, w->gram, sums, a);
  for (PetscInt c = 0; c < 3; c++) u->motion[c] += a[c];
  PetscCall(PetscArrayzero(w->t, 2 * u->cells)); /* the preconditioner sees the whole grid */
  for (PetscInt j = 0; j < u->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    const double sx = SamFrameX(a, eta);
    double       norm = 0, beyond = 0;

    for (PetscInt i = u->first[j]; i < u->last[j]; i++) {
      const PetscInt k = j * u->nx + i, l = k + u->cells;
      const double   b = u->bound[k];
      double         rx, ry, h = 1, q2, excess;

      if (b <= 0) continue;
      u->s[k] -= sx;
      u->s[l] -= SamFrameY(a, f->xi0 + (double)i * f->dxi);
      Residual(w, k, &rx, &ry);
      if (w->slip[k]) h = sqrt(self / (w->lambda[k] + self));
      rx *= h;
      ry *= h;
      w->t[k] = rx;
      w->t[l] = ry;
      norm += rx * rx + ry * ry;
      if (w->slip[k]) continue;
      q2 = u->q[k] * u->q[k] + u->q[l] * u->q[l];
      if (q2 <= b * b) continue;
      excess = (sqrt(q2) - b) * self;
      beyond += excess * excess;
    }
    norms[0] += norm;
    norms[1] += beyond;
  }
  PetscCall(SamSum(u->level->grid->comm, 2, norms));
  w->residual = norms[0];
  if (cut) *cut = norms[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = P M r + beta d, from the scaled residual in t. */
static PetscErrorCode NewDirection(Work *w, PetscBool first)
{
  SamStickSlip   *u       = &w->base;
  const SamFrame *f       = u->frame;
  const double    self    = u->self;
  double          sums[4] = {0, 0, 0, 0}, a[3], beta;

  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->vt, &w->t));
  PetscCall(SamTangentialPrecondition(u->solver, u->level, w->vt, w->vt));
  PetscCall(VecGetArray(w->vt, &w->t));
  for (PetscInt j = 0; j < u->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;
    double       x = 0, y = 0, turn = 0, product = 0;

    for (PetscInt i = u->first[j]; i < u->last[j]; i++) {
      const PetscInt k = j * u->nx + i, l = k + u->cells;
      double         rx, ry, zx = w->t[k], zy = w->t[l];

      if (u->bound[k] <= 0) continue;
      Residual(w, k, &rx, &ry);
      if (w->slip[k]) {
        const double sum = w->lambda[k] + self, h = self / sum, root = sqrt(h), rest = 0.5 * (1 - h) / sum;

        zx *= root;
        zy *= root;
        ToTangent(w, k, &zx, &zy);
        zx += rest * rx;
        zy += rest * ry;
        w->t[k] = zx;
        w->t[l] = zy;
      }
      x += zx;
      y += zy;
      turn += (f->xi0 + (double)i * f->dxi) * zy - eta * zx;
      product += zx * rx + zy * ry;
    }
    sums[0] += x;
    sums[1] += y;
    sums[2] += turn;
    sums[3] += product;
  }
  PetscCall(SamSum(u->level->grid->comm, 4, sums));
  SamFrameSolve(f, w->gram, sums, a);
  beta  = first ? 0 : sums[3] / w->rz;
  w->rz = sums[3];
  for (PetscInt j = 0; j < u->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = u->first[j]; i < u->last[j]; i++) {
      const PetscInt k = j * u->nx + i, l = k + u->cells;
      double         ax = SamFrameX(a, eta), ay = SamFrameY(a, f->xi0 + (double)i * f->dxi);

      if (u->bound[k] <= 0) continue;
      ToTangent(w, k, &ax, &ay);
      w->d[k] = w->t[k] - ax + beta * w->d[k];
      w->d[l] = w->t[l] - ay + beta * w->d[l];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* q += alpha d, s += alpha C d; `good` is false when there is no direction left. */
static PetscErrorCode Step(Work *w, PetscBool *good)
{
  SamStickSlip *u         = &w->base;
  double        curvature = 0, alpha;

  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->vd, &w->d));
  PetscCall(VecRestoreArray(w->vt, &w->t));
  PetscCall(SamTangentialApply(u->solver, u->level, w->vd, w->vt));
  PetscCall(VecGetArray(w->vd, &w->d));
  PetscCall(VecGetArray(w->vt, &w->t));
  for (PetscInt j = 0; j < u->rows; j++) {
    double sum = 0;

    for (PetscInt k = j * u->nx + u->first[j]; k < j * u->nx + u->last[j]; k++) { /* d is 0 outside the contact */
      const PetscInt l = k + u->cells;

      sum += w->d[k] * (w->t[k] + w->lambda[k] * w->d[k]) + w->d[l] * (w->t[l] + w->lambda[k] * w->d[l]);
    }
    curvature += sum;
  }
  PetscCall(SamSum(u->level->grid->comm, 1, &curvature));
  *good = (curvature > 0 && w->rz > 0) ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
  alpha = w->rz / curvature;
  for (PetscInt j = 0; j < u->rows; j++)
    for (PetscInt k = j * u->nx + u->first[j]; k < j * u->nx + u->last[j]; k++) {
      const PetscInt l = k + u->cells;

      u->q[k] += alpha * w->d[k];
      u->q[l] += alpha * w->d[l];
      u->s[k] += alpha * w->t[k];
      u->s[l] += alpha * w->t[l];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 2. */
static PetscErrorCode NewtonStep(Work *w)
{
  SamStickSlip *u    = &w->base;
  PetscBool     good = PETSC_TRUE, done;
  double        goal, cut = 0;

  PetscFunctionBegin;
  Classify(w);
  PetscCall(ComputeGram(w));
  PetscCall(PetscArrayzero(w->d, 2 * u->cells));
  PetscCall(NewResidual(w, NULL));
  goal = INNER_FALL * INNER_FALL * w->residual;
  done = w->residual == 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt it = 0; !done; it++) {
    PetscCall(NewDirection(w, it == 0 ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(Step(w, &good));
    if (!good) break;
    PetscCall(NewResidual(w, &cut));
    SamTangentialIterated(u->solver, u->level);
    done = (w->residual <= goal || cut > PROPORTION * w->residual || !isfinite(w->residual)) ? PETSC_TRUE : PETSC_FALSE;
    if (u->level->finest && u->solver->solver.iterations >= SamSolverMaxIterations(&u->solver->solver)) done = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Cells that slip go beyond their circles, so that the projection, which restores equilibrium by a common shift, leaves
  them on it: otherwise half of them would be pulled inside, and convergence would be linear instead of quadratic.
*/
static void PushOutward(Work *w)
{
  SamStickSlip *u = &w->base;

  for (PetscInt k = 0; k < u->cells; k++) {
    const PetscInt l = k + u->cells;
    double         scale;

    if (!w->slip[k]) continue;
    scale = 2 * u->bound[k] / sqrt(u->q[k] * u->q[k] + u->q[l] * u->q[l]);
    u->q[k] *= scale;
    u->q[l] *= scale;
  }
}

/* q = old + alpha (q - old), and its slip. */
static PetscErrorCode StepBetween(Work *w, double alpha)
{
  SamStickSlip *u = &w->base;
  const double *from = w->old;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2 * u->cells; k++) u->q[k] = from[k] + alpha * (u->q[k] - from[k]);
  PetscCall(SamStickSlipComputeSlip(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A projected gradient step from `old` of the length 1/(compliance at the contact's size), made the best by a search. */
static PetscErrorCode GradientStep(Work *w)
{
  SamStickSlip *u    = &w->base;
  const double *from = w->old;
  double        sums[3] = {0, 0, 0}, before, after, length;
  PetscBool     found;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(u->q, from, 2 * u->cells));
  PetscCall(SamStickSlipComputeSlip(u));
  PetscCall(SamStickSlipMeasure(u));
  PetscCall(SamStickSlipEnergy(u, &before));
  PetscCall(PetscArraycpy(w->d, u->s, 2 * u->cells));
  for (PetscInt j = 0; j < u->rows; j++)
    for (PetscInt k = j * u->nx + u->first[j]; k < j * u->nx + u->last[j]; k++) sums[2] += u->bound[k] > 0;
  PetscCall(SamSum(u->level->grid->comm, 3, sums));
  length = 1 / (u->self * sqrt(sums[2]));
  for (PetscInt k = 0; k < 2 * u->cells; k++) u->q[k] -= length * w->d[k];
  PetscCall(SamFrameProjectTangential(u->frame, u->bound, u->q, &found));
  sums[0] = 0;
  for (PetscInt k = 0; k < 2 * u->cells; k++) sums[0] += w->d[k] * (u->q[k] - from[k]);
  PetscCall(SamSum(u->level->grid->comm, 1, sums));
  PetscCall(StepBetween(w, 1));
  PetscCall(SamStickSlipEnergy(u, &after));
  if (sums[0] < 0 && 2 * (after - before - sums[0]) > -sums[0]) PetscCall(StepBetween(w, -sums[0] / (2 * (after - before - sums[0]))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 4, from the admissible `old` of energy *energy to q. */
static PetscErrorCode EnsureDescent(Work *w, double *energy)
{
  SamStickSlip *u      = &w->base;
  const double *from   = w->old;
  const double  before = *energy;
  double        after, sum = 0, slope, curvature;

  PetscFunctionBegin;
  PetscCall(SamStickSlipEnergy(u, &after));
  if (after <= before + 1e-13 * fabs(before)) {
    *energy = after;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /* after = before + slope + curvature/2, and s.(q - from) = slope + curvature at q */
  for (PetscInt k = 0; k < 2 * u->cells; k++) sum += (u->q[k] - from[k]) * u->s[k];
  PetscCall(SamSum(u->level->grid->comm, 1, &sum));
  curvature = 2 * (sum - (after - before));
  slope     = sum - curvature;
  if (slope < 0 && curvature > 0) PetscCall(StepBetween(w, -slope / curvature));
  else PetscCall(GradientStep(w));
  PetscCall(SamStickSlipEnergy(u, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamTangentialReason Reason(const SamStickSlip *u, PetscInt stagnant)
{
  if (!isfinite(u->error)) return SAM_TANGENTIAL_DIVERGED_NAN;
  if (u->error <= u->level->rtol) return SAM_TANGENTIAL_CONVERGED_RTOL;
  if (u->level->finest && u->solver->solver.iterations >= SamSolverMaxIterations(&u->solver->solver)) return SAM_TANGENTIAL_DIVERGED_ITS;
  return stagnant > STAGNATION ? SAM_TANGENTIAL_DIVERGED_STAGNATED : SAM_TANGENTIAL_CONVERGED_ITERATING;
}

static PetscErrorCode SamTangentialSolve_Newton(SamTangential solver, SamTangentialLevel *level)
{
  Work                w = {.slip = NULL};
  SamStickSlip       *u = &w.base;
  SamTangentialReason reason;
  double              energy, best;
  PetscInt            stagnant = 0;

  PetscFunctionBegin;
  PetscCall(CreateWork(solver, level, &w));
  PetscCall(SamStickSlipStart(u));
  PetscCall(SamStickSlipEnergy(u, &energy));
  best   = u->error;
  reason = Reason(u, stagnant);
  while (!reason) {
    PetscBool found;

    PetscCall(NewtonStep(&w));
    PushOutward(&w);
    PetscCall(SamFrameProjectTangential(u->frame, u->bound, u->q, &found));
    if (!found) {
      reason = SAM_TANGENTIAL_DIVERGED_STAGNATED; /* the loads can be carried, that was found out before */
      break;
    }
    PetscCall(SamStickSlipComputeSlip(u));
    if (stagnant > PATIENCE) PetscCall(EnsureDescent(&w, &energy));
    else PetscCall(SamStickSlipEnergy(u, &energy));
    PetscCall(SamStickSlipMeasure(u));
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

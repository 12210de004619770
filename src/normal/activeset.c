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
  References: Polonsky and Keer 1999, Wear 231, 206-219 (projected CG for contact); Dostal 2009, Optimal Quadratic
  Programming Algorithms, ch. 5 (active sets with CG); Stanley and Kato 1997, J. Tribol. 119, 481-485 (the spectrum).
*/
#include "normalimpl.h"
#include <math.h>
#include <string.h>

/* The set is changed when what is wrong with it exceeds this part of the residual (both squared). */
#define PROPORTION 0.1
/* Rounds without progress before the energy is watched, and before giving up: then it is rounding that stands in the way. */
#define PATIENCE 5
#define STAGNATION 50

typedef struct {
  SamNormal       normal;
  SamNormalLevel *level;
  const SamFrame *frame;
  PetscInt        nx, rows, cells;
  Vec             vg, vd, vs, vold;
  double         *p, *g, *d, *s, *old; /* pressure; gap; direction; S d, or the preconditioned residual; pressure before */
  const double   *h;
  char           *active;              /* cells of A */
  double          gram[SAM_GRAM];      /* of A */
  double          motion[3];           /* rigid displacement in g, fixed part included */
  double          displacement;        /* largest |S p| */
  double          self;                /* influence of a cell on itself, m/Pa */
  double          error;               /* largest complementarity error, m */
  double          residual, rz;        /* |P g| on A, squared; r.z */
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
  PetscCall(VecDuplicate(level->p, &w->vd));
  PetscCall(VecDuplicate(level->p, &w->vs));
  PetscCall(VecDuplicate(level->p, &w->vold));
  PetscCall(VecGetArray(level->p, &w->p));
  PetscCall(VecGetArrayRead(level->h, &w->h));
  PetscCall(VecGetArray(w->vg, &w->g));
  PetscCall(VecGetArray(w->vd, &w->d));
  PetscCall(VecGetArray(w->vs, &w->s));
  PetscCall(VecGetArray(w->vold, &w->old));
  PetscCall(PetscCalloc1(w->cells, &w->active));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->level->p, &w->p));
  PetscCall(VecRestoreArrayRead(w->level->h, &w->h));
  PetscCall(VecRestoreArray(w->vg, &w->g));
  PetscCall(VecRestoreArray(w->vd, &w->d));
  PetscCall(VecRestoreArray(w->vs, &w->s));
  PetscCall(VecRestoreArray(w->vold, &w->old));
  PetscCall(VecDestroy(&w->vg));
  PetscCall(VecDestroy(&w->vd));
  PetscCall(VecDestroy(&w->vs));
  PetscCall(VecDestroy(&w->vold));
  PetscCall(PetscFree(w->active));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The Vecs are handed to the operators while their arrays are held here: give them back for the call. */
static PetscErrorCode Product(Work *w, Vec x, double **ax, Vec y, double **ay)
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArray(x, ax));
  if (y != x) PetscCall(VecRestoreArray(y, ay));
  PetscCall(SamNormalApply(w->normal, w->level, x, y));
  PetscCall(VecGetArray(x, ax));
  if (y != x) PetscCall(VecGetArray(y, ay));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* g = S p + h - motion, and the largest displacement. */
static PetscErrorCode ComputeGap(Work *w)
{
  const SamFrame *f   = w->frame;
  double          max = 0;

  PetscFunctionBegin;
  PetscCall(Product(w, w->level->p, &w->p, w->vg, &w->g));
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < w->nx; i++) {
      const PetscInt k = j * w->nx + i;

      max = PetscMax(max, fabs(w->g[k]));
      w->g[k] += w->h[k] - SamFrameNormal(w->motion, f->xi0 + (double)i * f->dxi, eta);
    }
  }
  PetscCall(SamMax(w->level->grid->comm, 1, &max));
  w->displacement = max;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeGram(Work *w)
{
  const SamFrame *f = w->frame;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(w->gram, SAM_GRAM));
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < w->nx; i++)
      if (w->active[j * w->nx + i]) SamGramAddNormal(w->gram, f->xi0 + (double)i * f->dxi, eta);
  }
  PetscCall(SamSum(w->level->grid->comm, SAM_GRAM, w->gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum phi v over A, not yet summed over the ranks. */
static void AddMoments(const Work *w, const double v[], double sums[3])
{
  const SamFrame *f = w->frame;

  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < w->nx; i++) {
      const PetscInt k = j * w->nx + i;

      if (!w->active[k]) continue;
      sums[0] += v[k];
      sums[1] -= eta * v[k];
      sums[2] += (f->xi0 + (double)i * f->dxi) * v[k];
    }
  }
}

/* Moves g by the rigid displacement that fits it best on A; s = -g on A, 0 outside; residual = |g|^2 on A. */
static PetscErrorCode FitMotion(Work *w)
{
  const SamFrame *f       = w->frame;
  double          sums[3] = {0, 0, 0}, a[3];

  PetscFunctionBegin;
  AddMoments(w, w->g, sums);
  PetscCall(SamSum(w->level->grid->comm, 3, sums));
  SamFrameSolve(f, w->gram, sums, a);
  for (PetscInt c = 0; c < 3; c++) w->motion[c] += a[c];
  w->residual = 0;
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < w->nx; i++) {
      const PetscInt k = j * w->nx + i;

      w->g[k] -= SamFrameNormal(a, f->xi0 + (double)i * f->dxi, eta);
      w->s[k] = w->active[k] ? -w->g[k] : 0;
      w->residual += w->s[k] * w->s[k];
    }
  }
  PetscCall(SamSum(w->level->grid->comm, 1, &w->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Complementarity error: |g| on A, -g outside. */
static PetscErrorCode MeasureError(Work *w)
{
  PetscFunctionBegin;
  w->error = 0;
  for (PetscInt k = 0; k < w->cells; k++) w->error = SamLarger(w->error, w->active[k] ? fabs(w->g[k]) : -w->g[k]);
  PetscCall(SamMax(w->level->grid->comm, 1, &w->error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = P M r + beta d on A, from r in s (overwritten). */
static PetscErrorCode NewDirection(Work *w, PetscBool first)
{
  const SamFrame *f       = w->frame;
  double          sums[4] = {0, 0, 0, 0}, a[3], beta;

  PetscFunctionBegin;
  PetscCall(VecRestoreArray(w->vs, &w->s));
  PetscCall(SamNormalPrecondition(w->normal, w->level, w->vs, w->vs));
  PetscCall(VecGetArray(w->vs, &w->s));
  AddMoments(w, w->s, sums);
  for (PetscInt k = 0; k < w->cells; k++)
    if (w->active[k]) sums[3] -= w->g[k] * w->s[k];
  PetscCall(SamSum(w->level->grid->comm, 4, sums));
  SamFrameSolve(f, w->gram, sums, a);
  beta  = first ? 0 : sums[3] / w->rz;
  w->rz = sums[3];
  for (PetscInt j = 0; j < w->rows; j++) {
    const double eta = f->eta0 + (double)j * f->deta;

    for (PetscInt i = 0; i < w->nx; i++) {
      const PetscInt k = j * w->nx + i;

      w->d[k] = w->active[k] ? w->s[k] - SamFrameNormal(a, f->xi0 + (double)i * f->dxi, eta) + beta * w->d[k] : 0;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* p += alpha d, g += alpha S d with the exact step; `good` is false when there is no direction left. */
static PetscErrorCode Step(Work *w, PetscBool *good)
{
  double curvature = 0, alpha;

  PetscFunctionBegin;
  PetscCall(Product(w, w->vd, &w->d, w->vs, &w->s));
  for (PetscInt k = 0; k < w->cells; k++) curvature += w->d[k] * w->s[k];
  PetscCall(SamSum(w->level->grid->comm, 1, &curvature));
  *good = (curvature > 0 && w->rz > 0) ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
  alpha = w->rz / curvature;
  for (PetscInt k = 0; k < w->cells; k++) {
    w->p[k] += alpha * w->d[k];
    w->g[k] += alpha * w->s[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  How wrong the set is, as a squared gap comparable with `residual`: penetration outside A, and on cells of A that pull
  the displacement that letting go would cause there.
*/
static PetscErrorCode MeasureSet(Work *w, double *pulling, double *violation)
{
  double sums[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->cells; k++) {
    const double pull = w->active[k] ? PetscMin(0, w->self * w->p[k]) : 0, penetration = w->active[k] ? 0 : PetscMin(0, w->g[k]);

    sums[0] += pull * pull;
    sums[1] += penetration * penetration;
  }
  PetscCall(SamSum(w->level->grid->comm, 2, sums));
  *pulling   = sums[0];
  *violation = sums[0] + sums[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Conjugate gradients on A until the set should be changed, the tolerance is met or max_it is. `solved`: it is met, and
  no cell pulls.
*/
static PetscErrorCode Iterate(Work *w, PetscBool *solved)
{
  PetscBool good = PETSC_TRUE, done = w->residual == 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  for (PetscInt it = 0; !done; it++) {
    double pulling = 0, violation = 0;

    PetscCall(NewDirection(w, it == 0 ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(Step(w, &good));
    if (!good) break;
    PetscCall(FitMotion(w));
    PetscCall(MeasureError(w));
    PetscCall(SamNormalIterated(w->normal, w->level, w->error / w->displacement));
    PetscCall(MeasureSet(w, &pulling, &violation));
    *solved = (w->error <= w->level->rtol * w->displacement && pulling == 0) ? PETSC_TRUE : PETSC_FALSE;
    done    = (*solved || violation > PROPORTION * w->residual || !isfinite(w->residual)) ? PETSC_TRUE : PETSC_FALSE;
    if (w->error <= 0.5 * w->level->rtol * w->displacement) done = PETSC_TRUE;
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
    const double eta = f->eta0 + (double)j * f->deta;

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
  double    sums[2] = {0, 0}, most = 0, before, after, slope, curvature;
  PetscBool found;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(w->p, w->old, w->cells));
  PetscCall(ComputeGap(w));
  PetscCall(ComputeEnergy(w, &before));
  for (PetscInt k = 0; k < w->cells; k++) most = PetscMax(most, w->p[k]);
  PetscCall(SamMax(w->level->grid->comm, 1, &most));
  PetscCall(PetscArraycpy(w->d, w->g, w->cells));
  for (PetscInt k = 0; k < w->cells; k++) w->p[k] -= most / w->displacement * w->g[k];
  PetscCall(SamFrameProjectNormal(w->frame, NULL, w->p, &found));
  for (PetscInt k = 0; k < w->cells; k++) sums[0] += w->d[k] * (w->p[k] - w->old[k]);
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
  PetscCall(MeasureError(w));
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
  PetscCall(PetscArraycpy(w->old, w->p, w->cells));
  PetscCall(Iterate(w, solved));
  if (*solved) PetscFunctionReturn(PETSC_SUCCESS);
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

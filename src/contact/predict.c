/*
  The guess from which a step is solved.

  When the prescribed values continue as in the last step, the tractions are extrapolated, and a few iterations on the
  finest grid suffice. At a load reversal nested grids find the new slip zones faster.

  Near the edge of the contact the pressure goes to zero like the square root of the distance from the edge; so does
  mu p - |q| near the edge of the stick zone. Edges move, and extrapolating p or q themselves would give relative errors
  of order one where an edge passes. Their squares are linear in the position of the edge, and a negative extrapolated
  square means that the edge has passed. So p^2 is extrapolated. The ratio q/(mu p) moves in the unit disc; for it, the
  square of its distance to the circle is extrapolated, measured in the direction of its last change. In cells that
  slip, where the ratio lies on the circle, it continues along the circle.
*/
#include "contactimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/problem.h>
#include <math.h>

/*
  A step is extrapolated when the part of its change across that of the last step is at most PREDICT_ACROSS, relative to
  the whole change, and the part along it at most PREDICT_FARTHEST times as long as that of the last step.
*/
#define PREDICT_ACROSS   0.3
#define PREDICT_FARTHEST 3.0

/* A cell counts as slipping where |q| is at least this part of the bound. */
#define ON_CIRCLE (1 - 1e-7)

/* ---- how far to extrapolate ---- */

/* Products of the last change `old` and the next one `new`, of all prescribed values, scaled. */
typedef struct {
  double old_old, old_new, new_new;
} Changes;

/* Adds the products of one value, which is scaled by its largest size in the three steps. */
static void AddChange(double before, double now, double next, Changes *c)
{
  const double scale = PetscMax(fabs(before), PetscMax(fabs(now), fabs(next)));
  const double a = scale > 0 ? (now - before) / scale : 0, b = scale > 0 ? (next - now) / scale : 0;

  c->old_old += a * a;
  c->old_new += a * b;
  c->new_new += b * b;
}

/*
  Returns the length of the change to the next step along the last change, in units of the last change, or 0.
  `straight`: the prescribed values change in nearly the same proportions.
*/
static double Continuation(SamContact contact, const SamControl *before, const SamControl *now, const SamControl *next,
                           PetscBool *straight)
{
  Changes c = {0, 0, 0};
  double  alpha, across;

  *straight = PETSC_FALSE;
  if (contact->generation[SAM_COMMITTED].rolled != 0 || SamContactRolls(contact))
    return 0; /* the slip moves even if nothing prescribed changes */
  for (PetscInt n = 0; n < SAM_COMPONENTS; n++) {
    const PetscInt k = SamComponentsOf[n / 3][n % 3];

    if (SamControlWay(next, k) != SamControlWay(now, k) || SamControlWay(now, k) != SamControlWay(before, k)) return 0;
    AddChange(before->value[k], now->value[k], next->value[k], &c);
  }
  for (PetscInt k = 0; k < SamConditionsCount(contact->conditions); k++) {
    const SamCondition *one = SamConditionsGet(contact->conditions, k);

    if (!one->bounds) AddChange(SamControlGet(before, one), SamControlGet(now, one), SamControlGet(next, one), &c);
  }
  if (c.old_old == 0 || c.old_new <= 0) return 0;
  alpha     = c.old_new / c.old_old;
  across    = c.new_new - alpha * c.old_new; /* square of the part across the last change */
  *straight = across <= PREDICT_ACROSS * PREDICT_ACROSS * c.new_new && alpha <= PREDICT_FARTHEST;
  return PetscMin(alpha, PREDICT_FARTHEST);
}

/* ---- steps that do not continue each other ---- */

/*
  Such a step is near the last one if loads and creepages change by at most this part of the last ones, divided by the
  number of cells along a side: edges then move by about two cells.
*/
#define PREDICT_NEAR 2.0

/* Returns the size of the three components of a problem; lever: length by which moments or rotations are scaled. */
static double SizeOf(const PetscReal values[], PetscInt problem, double lever)
{
  double sum = 0;

  for (PetscInt n = 0; n < 3; n++) {
    const PetscInt k = SamComponentsOf[problem][n];
    const double   v = values[k] * (k < SAM_COMPONENT_MX ? 1 : lever);

    sum += v * v;
  }
  return sqrt(sum);
}

/*
  True if the next step is so near the last one that nested grids would cost more than they save. At 64 x 64 cells they
  cost a fifth of a step's time, and a third if the step is extrapolated. Friction that depends on slip may have several
  solutions.
*/
static PetscBool IsNear(SamContact c, const SamControl *next)
{
  const SamSolution *now                       = &c->generation[SAM_COMMITTED];
  const double       lever                     = PetscMin(c->grid->width[0], c->grid->width[1]) / 2;
  const double       most                      = PREDICT_NEAR / PetscMax(c->grid->nx, c->grid->ny);
  PetscReal          change[2][SAM_COMPONENTS] = {{0}};
  PetscBool          near                      = PETSC_TRUE;

  if (c->motion->continues || !c->set.warm_start || !SamContactBefore(c) || SamContactIsCoupled(c) ||
      SamProblemFollowsSlip(c->problem))
    return PETSC_FALSE;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    change[next->force[k]][k] = next->value[k] - (next->force[k] ? now->load : now->rigid)[k];
  for (PetscInt problem = 0; problem < 2; problem++)
    near = near && SizeOf(change[1], problem, 1 / lever) <= most * SizeOf(now->load, problem, 1 / lever) &&
           SizeOf(change[0], problem, lever) <= most * SizeOf(now->rigid, problem, lever);
  return near;
}

/* ---- extrapolation ---- */

/* p, bound, q_x and q_y one step back, in the last step and in the next one. */
enum { P, B, X, Y, FIELDS };
typedef struct {
  const double *before[FIELDS], *now[FIELDS];
  double       *next[FIELDS];
} Tractions;

/* Extrapolates the next p of n cells from index k on. */
SAM_VECTORIZED static void ExtrapolatePressure(const Tractions *t, double alpha, ptrdiff_t k, PetscInt n)
{
  const double *restrict p0 = t->before[P] + k, *restrict p1 = t->now[P] + k;
  double *restrict p = t->next[P] + k;

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    const double square = (1 + alpha) * p1[i] * p1[i] - alpha * p0[i] * p0[i], root = sqrt(square > 0 ? square : 0);

    p[i] = p1[i] == p0[i] ? p1[i] : root;
  }
}

/* Extrapolates the next q of n cells from index k on, from the next bound. */
SAM_VECTORIZED static void ExtrapolateShear(const Tractions *t, double alpha, ptrdiff_t k, PetscInt n)
{
  const double *restrict b0 = t->before[B] + k, *restrict qx0 = t->before[X] + k, *restrict qy0 = t->before[Y] + k;
  const double *restrict b1 = t->now[B] + k, *restrict qx1 = t->now[X] + k, *restrict qy1 = t->now[Y] + k;
  const double *restrict bound = t->next[B] + k;
  double *restrict qx = t->next[X] + k, *restrict qy = t->next[Y] + k;

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    const double known = (b0[i] < b1[i] ? b0[i] : b1[i]) > 0 ? 1 : 0, bound0 = b0[i] + (1 - known),
                 bound1 = b1[i] + (1 - known);
    const double rx = qx1[i] / bound1, ry = qy1[i] / bound1, x = rx - qx0[i] / bound0, y = ry - qy0[i] / bound0,
                 way2 = x * x + y * y, n2 = rx * rx + ry * ry;
    const double moves = way2 > 0 ? 1 : 0, inside = n2 < ON_CIRCLE * ON_CIRCLE ? 1 : 0, way = sqrt(way2),
                 along = (rx * x + ry * y) / (way + (1 - moves)), rest = along * along + 1 - n2;
    const double left = sqrt(rest > 0 ? rest : 0) - along, left_before = left + way,
                 left2 = (1 + alpha) * left * left - alpha * left_before * left_before,
                 go    = left - sqrt(left2 > 0 ? left2 : 0);
    const double part = inside > 0 ? moves * go / (way + (1 - moves)) : alpha, vx = rx + part * x, vy = ry + part * y,
                 v2    = vx * vx + vy * vy;
    const double scale = bound[i] * (inside > 0 ? 1 : 1 / sqrt(v2 > 0 ? v2 : 1));

    qx[i] = known > 0 ? scale * vx : qx1[i];
    qy[i] = known > 0 ? scale * vy : qy1[i];
  }
}

/* Extrapolates the pressure (P), or the shear (X), and zeroes the rest. Returns the largest pressure. */
static double ExtrapolateRows(const Tractions *t, SamGrid grid, double alpha, PetscInt field)
{
  const PetscInt nx = grid->nx, end = field == P ? P : Y;
  double         most = 0;

  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * nx;
    PetscInt        first, last;

    SamBoundRangeOfBoth(nx, t->before[P] + k, t->now[P] + k, &first, &last);
    if (field == P)
      ExtrapolatePressure(t, alpha, k + first, last - first);
    else
      ExtrapolateShear(t, alpha, k + first, last - first);
    for (PetscInt f = field; f <= end; f++) {
      SamZero(first, t->next[f] + k);
      SamZero(nx - last, t->next[f] + k + last);
    }
    for (PetscInt i = first; i < last; i++) most = PetscMax(most, t->next[P][k + i]);
  }
  return most;
}

static PetscErrorCode ReadTractions(SamGrid grid, const SamSolution *s, const double *fields[FIELDS])
{
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(s->pressure, &fields[P]));
  PetscCall(VecGetArrayRead(s->bound, &fields[B]));
  PetscCall(VecGetArrayRead(s->shear, &fields[X]));
  fields[Y] = fields[X] + grid->cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RestoreTractions(const SamSolution *s, const double *fields[FIELDS])
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArrayRead(s->pressure, &fields[P]));
  PetscCall(VecRestoreArrayRead(s->bound, &fields[B]));
  PetscCall(VecRestoreArrayRead(s->shear, &fields[X]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Extrapolates pressure or shear of the tried solution by alpha times their last change; `most`: largest pressure. */
static PetscErrorCode ExtrapolateField(SamContact c, double alpha, PetscInt field, double *most)
{
  const SamSolution *before = &c->generation[SAM_BEFORE], *now = &c->generation[SAM_COMMITTED],
                    *next = &c->generation[SAM_TRIED];
  Tractions t;

  PetscFunctionBegin;
  PetscCall(ReadTractions(c->grid, before, t.before));
  PetscCall(ReadTractions(c->grid, now, t.now));
  PetscCall(VecGetArray(next->pressure, &t.next[P]));
  PetscCall(VecGetArray(next->bound, &t.next[B]));
  PetscCall(VecGetArray(next->shear, &t.next[X]));
  t.next[Y] = t.next[X] + c->grid->cells;
  *most     = ExtrapolateRows(&t, c->grid, alpha, field);
  PetscCall(VecRestoreArray(next->shear, &t.next[X]));
  PetscCall(VecRestoreArray(next->bound, &t.next[B]));
  PetscCall(VecRestoreArray(next->pressure, &t.next[P]));
  PetscCall(RestoreTractions(now, t.now));
  PetscCall(RestoreTractions(before, t.before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Extrapolates the pressure, and the shear under its bound; `found`: there is contact. */
static PetscErrorCode Extrapolate(SamContact c, double alpha, const SamControl *control, PetscBool *found)
{
  const SamSolution *next = &c->generation[SAM_TRIED];
  const SamBoundAt   at   = {c->state, control, next->pressure, NULL, 0};
  double             most = 0;

  PetscFunctionBegin;
  PetscCall(ExtrapolateField(c, alpha, P, &most));
  PetscCall(SamProblemComputeBound(c->problem, &at, &(SamBound){.value = next->bound}));
  PetscCall(ExtrapolateField(c, alpha, X, &most));
  PetscCall(SamMax(c->grid->comm, 1, &most));
  *found = most > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the start ---- */

/* Takes the committed pressure as the guess, for a step in which only the gap has changed. */
static PetscErrorCode StartFromLastPressure(SamContact c)
{
  PetscReal most;

  PetscFunctionBegin;
  PetscCall(VecMax(c->generation[SAM_COMMITTED].pressure, NULL, &most));
  if (most <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamVecCopyNonzero(c->generation[SAM_COMMITTED].pressure, c->generation[SAM_TRIED].pressure));
  c->tried.start.pressure = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactPredict(SamContact c)
{
  const SamControl  *control = &c->generation[SAM_TRIED].control;
  SamStepStart      *start   = &c->tried.start;
  const SamSolution *now = &c->generation[SAM_COMMITTED], *before = &c->generation[SAM_BEFORE];
  double             alpha = 0;
  PetscBool          found = PETSC_FALSE, near = IsNear(c, control), straight = PETSC_FALSE;

  PetscFunctionBegin;
  if (SamContactGetSteps(c) > 1) start->along = Continuation(c, &before->control, &now->control, control, &straight);
  if (straight && c->set.warm_start) alpha = start->along;
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt n = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];

    start->rigid[k] = now->rigid[n] + alpha * (now->rigid[n] - before->rigid[n]);
  }
  if (alpha > 0) PetscCall(Extrapolate(c, alpha, control, &found));
  start->pressure = found;
  start->shear    = found && (near || c->motion->continues);
  if (!found && near) {
    PetscCall(StartFromLastPressure(c));
    PetscCall(SamVecCopyNonzero(now->shear, c->generation[SAM_TRIED].shear));
    start->shear = start->pressure;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!found && c->set.warm_start && !SamContactIsCoupled(c) &&
      SamControlIsSame(&now->control, control, SAM_BALANCE_NORMAL))
    PetscCall(StartFromLastPressure(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

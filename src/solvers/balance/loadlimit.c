/*
  Admissible loads: the lever arms of a normal load, and the limit of sliding.

  Sliding: shears with |q| <= b carry a load F exactly when F.v <= sum b |v| dA for every rigid velocity v (the set of
  loads is convex, and the sum is its support function). So the minimum of sum b |v| dA over all v with F.v = 1 is the
  factor by which F can grow. |v| has a kink at the centre of rotation; it is smoothed, and Newton's method minimises
  the sum for a smoothing that is reduced step by step.
*/
#include "projectionimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/balance.h>
#include <petsam/private/control.h>
#include <math.h>

/* An error of equilibrium, relative to the sum of the bound, that is ignored. */
#define TOLERANCE 1e-11
/*
  Number of smoothings, 1, 0.1, ..., and the index of the one that the shear uses: a smaller smoothing would leave
  rounding in the shear where the motion turns.
*/
#define SMOOTHINGS         10
#define SMOOTHING_OF_SHEAR 6
/* Relative rounding of a load or lever that equals the limit of all pressures */
#define FULL 1e-12
/* Least predicted gain of a step, relative to the power, at which the power is accurate enough to measure the gain */
#define FLAT 1e-10

/* Computes a row's sums of t and of xi t. */
SAM_VECTORIZED static void SumRow(SamRow row, const double *restrict t, double sums[2])
{
  double sum = 0, turn = 0;

#pragma omp simd reduction(+ : sum, turn)
  for (int i = 0; i < row.count; i++) {
    sum += t[i];
    turn += (row.xi0 + (double)i * row.dxi) * t[i];
  }
  sums[0] = sum;
  sums[1] = turn;
}

PetscErrorCode SamBalanceGetLoads(SamGrid grid, SamBalanceKind kind, Vec traction, PetscReal loads[3])
{
  const SamBalance none = {.kind = kind};
  SamFrame         f;
  SamTotal         totals[3] = {{0}};
  double           sums[3];
  const double    *t;

  PetscFunctionBegin;
  PetscCall(SamFrameSet(&f, grid, &none));
  PetscCall(VecGetArrayRead(traction, &t));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const SamRow row  = SamFrameRow(&f, j, 0, grid->nx);
    double       x[2] = {0, 0}, y[2] = {0, 0};

    SumRow(row, t + row.first, x);
    if (kind == SAM_BALANCE_TANGENTIAL) SumRow(row, t + row.first + grid->cells, y);
    sums[0] = x[0];
    sums[1] = kind == SAM_BALANCE_NORMAL ? -row.eta * x[0] : y[0];
    sums[2] = kind == SAM_BALANCE_NORMAL ? x[1] : y[1] - row.eta * x[0];
    SamAddAll(3, totals, sums);
  }
  PetscCall(VecRestoreArrayRead(traction, &t));
  PetscCall(SamSumTotals(grid->comm, 3, totals, sums));
  for (PetscInt k = 0; k < 3; k++) {
    double row[3];

    SamFrameGetComponent(grid, kind, k, row);
    loads[k] = SamFrameDot(row, sums) * grid->dx * grid->dy;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBalanceLever(SamGrid grid, const SamBalance *balance, char message[], size_t size,
                               PetscBool *possible)
{
  const PetscReal sign[3] = {1, -1, 1}; /* lever of Mx along -y, of My along x */
  const char     *axis[3] = {"", "y", "x"}, *force = SamUnitOn(grid, "N"), *moment = SamUnitOn(grid, "N m");

  PetscFunctionBegin;
  *possible  = PETSC_TRUE;
  message[0] = '\0';
  if (!balance->force[0]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 1; k < 3 && *possible; k++) {
    const PetscReal first = k == 1 ? SamGridY(grid, 0) : SamGridX(grid, 0);
    const PetscReal last  = k == 1 ? SamGridY(grid, grid->ny - 1) : SamGridX(grid, grid->nx - 1);
    const char     *name  = SamComponentNames[SamComponentsOf[SAM_BALANCE_NORMAL][k]].load;
    PetscReal       lever;

    if (!balance->force[k]) continue;
    if (balance->load[0] == 0) {
      *possible = balance->load[k] == 0;
      if (!*possible)
        PetscCall(PetscSNPrintf(message, size, "%s = %.6g %s needs a normal force to balance it, and load_n is 0", name,
                                (double)balance->load[k], moment));
      continue;
    }
    lever = sign[k] * balance->load[k] / balance->load[0];
    if (lever > first && lever < last) continue;
    *possible = PETSC_FALSE;
    PetscCall(
      PetscSNPrintf(message, size,
                    "%s = %.6g %s under load_n = %.6g %s: the resultant lies at %s = %.6g m, the grid's cells from "
                    "%.6g to %.6g m, so no pressure on this grid balances it (limits %.6g and %.6g %s)",
                    name, (double)balance->load[k], moment, (double)balance->load[0], force, axis[k], (double)lever,
                    (double)first, (double)last, (double)(sign[k] * (k == 1 ? last : first) * balance->load[0]),
                    (double)(sign[k] * (k == 1 ? first : last) * balance->load[0]), moment));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds the maximum moment, about the grid's first or last row or column of centres, of a load (Pa, a sum over the
  cells) under a pressure limit: the outermost lines of cells bear all of the load. Returns the place of its resultant
  (m), along y for k = 1 and along x for k = 2; `last`: at the last line.
*/
static double OutermostPlace(SamGrid grid, PetscInt k, PetscBool last, double load, double limit)
{
  const PetscInt n    = k == 1 ? grid->ny : grid->nx;
  const double   most = limit * (double)(k == 1 ? grid->nx : grid->ny);
  double         left = load, moment = 0;

  for (PetscInt i = 0; i < n && left > 0; i++) {
    const PetscInt line  = last ? n - 1 - i : i;
    const double   borne = PetscMin(left, most);

    moment += borne * (double)(k == 1 ? SamGridY(grid, line) : SamGridX(grid, line));
    left -= borne;
  }
  return moment / load;
}

PetscErrorCode SamBalanceCapacity(SamGrid grid, const SamBalance *balance, PetscReal limit, char message[], size_t size,
                                  PetscBool *possible)
{
  const double cell = grid->dx * grid->dy, most = (double)limit * cell * (double)grid->nx * (double)grid->ny,
               load = (double)balance->load[0];
  const char *force = SamUnitOn(grid, "N"), *moment = SamUnitOn(grid, "N m");

  PetscFunctionBegin;
  *possible  = PETSC_TRUE;
  message[0] = '\0';
  if (!isfinite(limit) || !balance->force[0] || load == 0) PetscFunctionReturn(PETSC_SUCCESS);
  *possible = load <= most * (1 + FULL);
  if (!*possible)
    PetscCall(PetscSNPrintf(
      message, size,
      "load_n = %.8g %s exceeds the load that the whole grid carries under pressure_limit = %.6g Pa (limit %.8g %s)",
      load, force, (double)limit, most, force));
  for (PetscInt k = 1; k < 3 && *possible; k++) {
    const double sign  = k == 1 ? -1 : 1, /* lever of Mx along -y, of My along x */
      place            = sign * (double)balance->load[k] / load,
                 first = OutermostPlace(grid, k, PETSC_FALSE, load / cell, (double)limit),
                 last  = OutermostPlace(grid, k, PETSC_TRUE, load / cell, (double)limit),
                 room  = FULL * (double)(k == 1 ? grid->width[1] : grid->width[0]);

    if (!balance->force[k] || (place >= first - room && place <= last + room)) continue;
    *possible = PETSC_FALSE;
    PetscCall(PetscSNPrintf(
      message, size,
      "%s = %.6g %s under load_n = %.6g %s: pressures up to pressure_limit = %.6g Pa on this grid do "
      "not balance it (limits %.6g and %.6g %s)",
      SamComponentNames[SamComponentsOf[SAM_BALANCE_NORMAL][k]].load, (double)balance->load[k], moment, load, force,
      (double)limit, (k == 1 ? -last : first) * load, (k == 1 ? -first : last) * load, moment));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum b sqrt(|v|^2 + s^2), its gradient and Hessian with respect to the combination a of the phi */
typedef struct {
  double value, gradient[3], hessian[SAM_GRAM];
  double bound; /* the sum of b */
} Power;

#define POWER ((PetscInt)(sizeof(Power) / sizeof(double)))

/*
  Adds the power of a load as small as a tolerance, in any direction, since so small loads count as carried. Otherwise a
  contact of one cell could carry no load, because rounding leaves a torque about the cell.
*/
static void AddTolerance(const double a[3], double smoothing, double all, Power *power)
{
  const double n = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + smoothing * smoothing), b = TOLERANCE * all;

  power->value += b * n;
  for (PetscInt i = 0; i < 3; i++) power->gradient[i] += b * a[i] / n;
  for (PetscInt i = 0, entry = 0; i < 3; i++)
    for (PetscInt k = i; k < 3; k++, entry++)
      power->hessian[entry] += b / n * ((i == k ? 1 : 0) - a[i] * a[k] / (n * n));
}

static PetscErrorCode EvaluatePower(const SamFrame *f, const double bound[], const double a[3], double smoothing,
                                    Power *power)
{
  SamTotal totals[sizeof(Power) / sizeof(double)] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    const double eta = SamFrameEta(f, j);
    Power        row = {0};

    for (PetscInt i = 0; i < f->grid->nx; i++) {
      const double xi = f->xi0 + (double)i * f->dxi, b = bound[j * f->grid->nx + i];
      double       vx, vy, n, hxx, hxy, hyy;

      if (b <= 0) continue;
      vx = SamFrameX(a, eta);
      vy = SamFrameY(a, xi);
      n  = sqrt(vx * vx + vy * vy + smoothing * smoothing);
      row.bound += b;
      row.value += b * n;
      vx /= n;
      vy /= n;
      row.gradient[0] += b * vx;
      row.gradient[1] += b * vy;
      row.gradient[2] += b * (xi * vy - eta * vx);
      hxx = b / n * (1 - vx * vx);
      hxy = -b / n * vx * vy;
      hyy = b / n * (1 - vy * vy);
      SamGramAddTangential(row.hessian, hxx, hxy, hyy, xi, eta);
    }
    SamAddAll(POWER, totals, (const double *)&row);
  }
  PetscCall(SamSumTotals(f->grid->comm, POWER, totals, (double *)power));
  AddTolerance(a, smoothing, power->bound, power);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the free combinations orthogonal to the load F, as the basis of a frame for SamFrameSolve(). */
static void OrthogonalTo(const SamFrame *f, const double F[3], SamFrame *across)
{
  double   basis[3][3], lower[3];
  PetscInt m = 1;

  (void)SamOrthonormalize(0, basis, F, lower);
  for (PetscInt k = 0; k < f->count && m < f->count; k++)
    if (SamOrthonormalize(m, basis, f->basis[k], lower) >= 1e-6) m++;
  *across       = *f;
  across->count = m - 1;
  for (PetscInt k = 0; k < 3 * across->count; k++) across->basis[k / 3][k % 3] = basis[k / 3 + 1][k % 3];
}

/* Computes the Newton step within the directions of `across`; returns the slope of the power down along it. */
static double FindStep(const SamFrame *across, const Power *now, double step[3])
{
  double down[3], slope = 0;

  for (PetscInt i = 0; i < 3; i++) down[i] = -now->gradient[i];
  SamFrameSolve(across, now->hessian, down, step);
  for (PetscInt i = 0; i < 3; i++) slope += down[i] * step[i];
  return slope;
}

/*
  Minimises for one smoothing by Newton's method with halving, moving a within the directions of `across`. If the power
  is too flat to measure a step's gain, the slope decides: the motion must be accurate, not only its power.
*/
static PetscErrorCode MinimizePower(const SamFrame *f, const SamFrame *across, const double bound[], double smoothing,
                                    double a[3])
{
  Power  now, next;
  double step[3], next_step[3], slope, next_slope;

  PetscFunctionBegin;
  PetscCall(EvaluatePower(f, bound, a, smoothing, &now));
  slope = FindStep(across, &now, step);
  for (PetscInt it = 0; it < 50 && across->count && slope > 0; it++) {
    const PetscBool flat = slope <= FLAT * now.value;
    double          t    = 1, trial[3];

    for (;;) {
      for (PetscInt i = 0; i < 3; i++) trial[i] = a[i] + t * step[i];
      PetscCall(EvaluatePower(f, bound, trial, smoothing, &next));
      if (flat || next.value <= now.value - 1e-4 * t * slope || t < 1e-8) break;
      t *= 0.5;
    }
    next_slope = FindStep(across, &next, next_step);
    if (flat ? next_slope > 0.25 * slope : next.value >= now.value) break; /* rounding dominates */
    PetscCall(PetscArraycpy(a, trial, 3));
    PetscCall(PetscArraycpy(step, next_step, 3));
    now   = next;
    slope = next_slope;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the shear along a smoothed motion a; a cell at the centre of rotation carries the rest. */
static PetscErrorCode SetSliding(const SamFrame *f, const double bound[], const double a[3], double smoothing,
                                 Vec shear)
{
  double *q;

  PetscFunctionBegin;
  PetscCall(VecGetArray(shear, &q));
  for (PetscInt j = 0; j < f->grid->rows; j++)
    for (PetscInt i = 0; i < f->grid->nx; i++) {
      const PetscInt k = j * f->grid->nx + i;
      const double   x = SamFrameX(a, SamFrameEta(f, j)), y = SamFrameY(a, f->xi0 + (double)i * f->dxi),
                   s = bound[k] > 0 ? bound[k] / sqrt(x * x + y * y + smoothing * smoothing) : 0;

      q[k]                  = s > 0 ? s * x : 0; /* avoids -0 */
      q[k + f->grid->cells] = s > 0 ? s * y : 0;
    }
  PetscCall(VecRestoreArray(shear, &q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBalanceSlideLimit(SamGrid grid, const SamBalance *balance, Vec bound, PetscReal *factor, Vec shear)
{
  SamBalance    scaled = *balance; /* scaled by a power of two, since the squares of the largest loads would overflow */
  SamFrame      f, across;
  double        F[3] = {0, 0, 0}, norm = 0, most = 0, a[3];
  const double *b;
  Power         exact;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++) most = PetscMax(most, PetscAbsReal(balance->force[k] ? balance->load[k] : 0));
  for (PetscInt k = 0; k < 3; k++) scaled.load[k] = ldexp(balance->load[k], -ilogb(most > 0 ? most : 1));
  PetscCall(SamFrameSet(&f, grid, &scaled));
  for (PetscInt k = 0; k < f.count; k++)
    for (PetscInt i = 0; i < 3; i++) F[i] += f.target[k] * f.basis[k][i];
  for (PetscInt i = 0; i < 3; i++) norm += F[i] * F[i];
  *factor = PETSC_INFINITY;
  if (shear) PetscCall(SamVecZero(shear));
  if (norm == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < 3; i++) a[i] = F[i] / norm;
  OrthogonalTo(&f, F, &across);
  PetscCall(VecGetArrayRead(bound, &b));
  /* The smoothed sum exceeds the true one by at most smoothing * sum b. */
  for (PetscInt k = 0; k < SMOOTHINGS; k++) {
    const double smoothing = pow(10, -k) / sqrt(norm);

    PetscCall(MinimizePower(&f, &across, b, smoothing, a));
    if (shear && k == SMOOTHING_OF_SHEAR) PetscCall(SetSliding(&f, b, a, smoothing, shear));
  }
  PetscCall(EvaluatePower(&f, b, a, 1e-300, &exact));
  PetscCall(VecRestoreArrayRead(bound, &b));
  *factor = ldexp(exact.value, -ilogb(most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

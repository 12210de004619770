/* The tangential problem for its tests: a sphere under its normal load, a solver that is used once, the conditions. */
#ifndef PETSAM_TANGENTIALS_H
#define PETSAM_TANGENTIALS_H

#include "fields.h"

#include <petsam/normal.h>
#include <petsam/private/tangential.h>
#include <petsam/private/balance.h>

static const double mu = 0.3; /* friction */

/* A sphere under its normal load, with the bound of the shear; torque is the limit of Mz, 3 pi/16 mu N a. */
typedef struct {
  Sphere s;
  Vec    p, bound;
  double T, torque;
} Case;

static inline Case NewCase(PetscInt n, double poisson)
{
  Case       c      = {.s = NewSphere(n, 1.5, poisson)};
  SamBalance normal = {
    .kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {c.s.N, 0, 0}};
  SamNormal solver;

  c.p = NewField(c.s.grid, 1);
  sam_call(SamNormalCreate(c.s.elasticity, &solver));
  sam_call(SamNormalSolve(solver, c.s.h, &normal, PETSC_FALSE, c.p));
  sam_call(SamNormalDestroy(&solver));
  c.bound = Copy(c.p);
  sam_call(VecScale(c.bound, mu));
  c.T      = Sum(c.bound) * c.s.grid->dx * c.s.grid->dy; /* mu N to rounding */
  c.torque = 3 * PETSC_PI / 16 * c.T * c.s.a;
  return c;
}

static inline void DestroyCase(Case *c)
{
  sam_destroy(&c->p, &c->bound);
  DestroySphere(&c->s);
}

/* Loads in units of mu N and of the limit torque. */
static inline SamBalance Loaded(const Case *c, double x, double y, double z)
{
  const SamBalance b = {.kind  = SAM_BALANCE_TANGENTIAL,
                        .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                        .load  = {x * c->T, y * c->T, z * c->torque}};

  return b;
}

typedef struct {
  SamSolverReason reason;
  PetscReal       error, limit;
  PetscInt        iterations, applies, preconditions;
} Outcome;

static inline Outcome Solve(const Case *c, Vec bound, Vec offset, SamSolverType type, double rtol, SamBalance *balance,
                            Vec q)
{
  SamTangential t;
  Outcome       o;

  sam_call(SamTangentialCreate(c->s.elasticity, &t));
  if (type) sam_call(SamSolverSetType(SamTangentialAsSolver(t), type));
  if (rtol > 0) sam_call(SamSolverSetTolerances(SamTangentialAsSolver(t), rtol, PETSC_DEFAULT));
  sam_call(SamTangentialSolve(t, bound, offset, balance, PETSC_FALSE, q));
  o.reason = SamSolverGetReason(SamTangentialAsSolver(t));
  o.limit  = SamTangentialGetLimit(t);
  sam_call(SamSolverGetStatistics(SamTangentialAsSolver(t), &o.error, &o.iterations, &o.applies, &o.preconditions));
  sam_call(SamTangentialDestroy(&t));
  if (getenv("SAM_SHOW"))
    print_message("# %s %s error %g its %d C %d M %d limit %.12g\n", type ? type : "", SamSolverReasonName(o.reason),
                  o.error, (int)o.iterations, (int)o.applies, (int)o.preconditions, o.limit);
  return o;
}

static inline Outcome SolveWell(const Case *c, Vec offset, SamSolverType type, double rtol, SamBalance *balance, Vec q)
{
  const Outcome o = Solve(c, c->bound, offset, type, rtol, balance, q);

  sam_assert(o.reason == SAM_SOLVER_CONVERGED_RTOL);
  return o;
}

/* s = C q - rigid; the caller destroys it. */
static inline Vec Slip(const Case *c, const SamBalance *balance, Vec q)
{
  const SamGrid grid = c->s.grid;
  Vec           slip = NewField(grid, 2);
  double       *s;

  sam_call(SamElasticityApplyTangential(c->s.elasticity, q, slip));
  sam_call(VecGetArray(slip, &s));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      s[j * grid->nx + i] -= balance->rigid[0] - SamGridY(grid, grid->row_start + j) * balance->rigid[2];
      s[grid->cells + j * grid->nx + i] -= balance->rigid[1] + SamGridX(grid, i) * balance->rigid[2];
    }
  sam_call(VecRestoreArray(slip, &s));
  return slip;
}

/* ---- the conditions of the problem, looked at without the solver ---- */

/* offset NULL: none. */
static inline void AssertConditions(const Case *c, Vec offset, const SamBalance *balance, const SamBalance *given,
                                    Vec q)
{
  const SamGrid grid = c->s.grid;
  const double *b, *t, *s;
  double        cone = 0, stick = 0, uphill = 0, across = 0, most = Norm(c->bound, NORM_INFINITY), limit;
  PetscReal     loads[3], self;
  Vec           slip = Slip(c, balance, q);

  if (offset) sam_call(VecAXPY(slip, 1, offset));
  sam_call(SamElasticityGetSelfInfluence(c->s.elasticity, NULL, &self));
  sam_call(SamBalanceGetLoads(grid, SAM_BALANCE_TANGENTIAL, q, loads));
  for (int k = 0; k < 3; k++)
    if (given->force[k])
      sam_assert_close(loads[k], given->load[k], 1e-10 * c->T * (k == 2 ? c->s.a : 1)); /* kept by projection */
  sam_call(VecGetArrayRead(c->bound, &b));
  sam_call(VecGetArrayRead(q, &t));
  sam_call(VecGetArrayRead(slip, &s));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt l = k + grid->cells;
    const double   n = hypot(t[k], t[l]), ds = hypot(s[k], s[l]);

    cone = fmax(cone, n - b[k]);
    if (b[k] <= 0) continue;
    if (n < (1 - 1e-5) * b[k])
      stick = fmax(stick, ds);
    else {
      uphill = fmax(uphill, (s[k] * t[k] + s[l] * t[l]) / n);
      across = fmax(across, fabs(s[k] * t[l] - s[l] * t[k]) / n / (1 + ds / (self * b[k])));
    }
  }
  sam_call(VecRestoreArrayRead(slip, &s));
  sam_call(VecRestoreArrayRead(q, &t));
  sam_call(VecRestoreArrayRead(c->bound, &b));
  sam_assert_close(fmax(cone, 0), 0, 1e-14 * most); /* rounding of a square root */
  /* a cell's part of |q - D(q - s/c)|: slip across q makes b/(b + |s|/c) times that of it */
  limit = 1e-6 * self * Norm(q, NORM_2);
  sam_assert_close(stick, 0, limit);
  sam_assert_close(fmax(uphill, 0), 0, limit);
  sam_assert_close(across, 0, limit);
  sam_call(VecDestroy(&slip));
}

#endif

/* Contacts of few cells, down to none: equations without a unique solution, bodies that tilt out of touch. */
#include "fields.h"

#include <petsam/normal.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/tangential.h>
#include <petsam/private/balance.h>

enum { NX = 13, NY = 17 };

typedef struct {
  SamGrid       grid;
  SamElasticity elasticity;
  Vec           h, p, bound, q;
} Case;

/* Cells of 1 mm. */
static Case NewCaseAt(double x, double y)
{
  const SamPair pair = NewPair(2e9, 0.3, 2e9, 0.3);
  Case          c    = {.grid = NewGridOn(PETSC_COMM_WORLD, NX, NY, NX * 1e-3, NY * 1e-3, x, y)};

  sam_call(SamElasticityCreate(c.grid, pair, &c.elasticity));
  c.h     = NewField(c.grid, 1);
  c.p     = NewField(c.grid, 1);
  c.bound = NewField(c.grid, 1);
  c.q     = NewField(c.grid, 2);
  return c;
}

/* Its centre is the origin. */
static Case NewCase(void)
{
  return NewCaseAt(0, 0);
}

static void DestroyCase(Case *c)
{
  sam_destroy(&c->h, &c->p, &c->bound, &c->q);
  sam_call(SamElasticityDestroy(&c->elasticity));
  sam_call(SamGridDestroy(&c->grid));
}

/* A plane 1 mm away with points at the given heights below it. */
typedef struct {
  PetscInt i, j;
  double   height;
} Point;

static void SetPoints(const Case *c, PetscInt n, const Point points[])
{
  sam_call(VecSet(c->h, 1e-3));
  for (PetscInt k = 0; k < n; k++) AddAt(c->grid, 0, points[k].i, points[k].j, -points[k].height, c->h);
}

static SamSolverReason Press(const Case *c, SamBalance *balance)
{
  SamNormal       solver;
  SamSolverReason reason;

  sam_call(SamNormalCreate(c->elasticity, &solver));
  sam_call(SamNormalSolve(solver, c->h, balance, PETSC_FALSE, c->p));
  reason = SamSolverGetReason(SamNormalAsSolver(solver));
  sam_call(SamNormalDestroy(&solver));
  return reason;
}

static PetscInt Touching(const Case *c)
{
  const double *p;
  double        n = 0;

  sam_call(VecGetArrayRead(c->p, &p));
  for (PetscInt k = 0; k < c->grid->cells; k++) n += p[k] > 0;
  sam_call(VecRestoreArrayRead(c->p, &p));
  sam_call(SamSum(c->grid->comm, 1, &n));
  return (PetscInt)n;
}

/* p >= 0, no gap below p and none above, no overlap elsewhere: to `tolerance`, m. */
static void AssertPressed(const Case *c, const SamBalance *balance, double tolerance)
{
  Vec           u = NewField(c->grid, 1);
  const double *p, *h;
  double       *g, worst = 0;

  sam_call(SamElasticityApplyNormal(c->elasticity, c->p, u));
  sam_call(VecGetArray(u, &g));
  sam_call(VecGetArrayRead(c->p, &p));
  sam_call(VecGetArrayRead(c->h, &h));
  for (PetscInt j = 0; j < c->grid->rows; j++)
    for (PetscInt i = 0; i < c->grid->nx; i++) {
      const PetscInt k     = j * c->grid->nx + i;
      const double   rigid = balance->rigid[0] - SamGridY(c->grid, c->grid->row_start + j) * balance->rigid[1] +
                           SamGridX(c->grid, i) * balance->rigid[2];
      const double gap = g[k] + h[k] - rigid;

      worst = fmax(worst, p[k] > 0 ? fabs(gap) : -gap);
      if (p[k] < 0) worst = INFINITY;
    }
  sam_call(VecRestoreArrayRead(c->h, &h));
  sam_call(VecRestoreArrayRead(c->p, &p));
  sam_call(VecRestoreArray(u, &g));
  sam_call(VecDestroy(&u));
  sam_assert_close(worst, 0, tolerance);
}

/* From 0 to 1. */
static double Part(PetscInt seed, PetscInt component, PetscInt i)
{
  return 0.5 * (Random(seed, component, i, 0) + 1);
}

static double LargestDisplacement(const Case *c)
{
  Vec    u = NewField(c->grid, 1);
  double most;

  sam_call(SamElasticityApplyNormal(c->elasticity, c->p, u));
  most = Norm(u, NORM_INFINITY);
  sam_call(VecDestroy(&u));
  return most;
}

/* ---- the normal problem ---- */

/* The approach is given and no moment holds the bodies: with one or two points they turn until they part. */
static void test_bodies_free_to_tilt_lose_touch(void **state)
{
  const Point points[] = {{8, 11, 1e-3}, {3, 12, 0.95e-3}};
  Case        c        = NewCase();

  (void)state;
  for (PetscInt n = 1; n <= 2; n++) {
    SamBalance b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_FALSE, PETSC_TRUE, PETSC_TRUE}, .rigid = {2e-4, 0, 0}};

    SetPoints(&c, n, points);
    sam_assert(Press(&c, &b) == SAM_SOLVER_CONVERGED_TRIVIAL);
    sam_assert(Touching(&c) == 0);
    sam_assert(b.rigid[0] == 2e-4 && b.load[0] == 0);
    AssertPressed(&c, &b, 1e-15); /* rounding of the heights' differences */
  }
  DestroyCase(&c);
}

/* Three points around the middle hold them, a fourth that is lower does not touch. */
static void test_three_points_around_the_middle_carry_bodies_free_to_tilt(void **state)
{
  const Point points[] = {{2, 3, 1e-3}, {11, 5, 0.98e-3}, {5, 15, 0.99e-3}, {6, 8, 0.5e-3}};
  Case        c        = NewCase();
  SamBalance  b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_FALSE, PETSC_TRUE, PETSC_TRUE}, .rigid = {1e-4, 0, 0}};

  (void)state;
  SetPoints(&c, 4, points);
  sam_assert(Press(&c, &b) == SAM_SOLVER_CONVERGED_RTOL);
  sam_assert(Touching(&c) == 3);
  AssertPressed(&c, &b, 1e-8 * LargestDisplacement(&c));
  DestroyCase(&c);
}

/*
  Two points that lie opposite each other carry a force between them: it leaves open how far the bodies turn about the
  line through both, and they must not turn into each other. The pressures are far smaller than the gaps.
*/
static void test_two_points_leave_a_rotation_open_that_makes_no_overlap(void **state)
{
  const Point points[] = {{3, 4, 1e-3}, {9, 12, 0.99e-3}, {10, 4, 0.9e-3}, {2, 13, 0.2e-3}};
  Case        c        = NewCase();

  (void)state;
  for (double N = 1e-6; N < 1; N *= 100) {
    SamBalance b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {N, 0, 0}};

    SetPoints(&c, 4, points);
    sam_assert(Press(&c, &b) == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert(Touching(&c) == 2);
    sam_assert_close(b.load[0], N, 1e-10 * N);
    sam_assert_close(b.load[1], 0, 1e-10 * N * 1e-2);
    sam_assert_close(b.load[2], 0, 1e-10 * N * 1e-2);
    AssertPressed(&c, &b, 1e-8 * LargestDisplacement(&c));
  }
  DestroyCase(&c);
}

/* Pressures of very different size: the resultant lies close to one of three points. */
static void test_resultant_next_to_one_of_three_points(void **state)
{
  const Point points[] = {{6, 8, 1e-3}, {5, 8, 0.9999e-3}, {6, 9, 0.9998e-3}};
  Case        c        = NewCase();

  (void)state;
  SetPoints(&c, 3, points);
  for (int k = 2; k < 7; k++) {
    const double N = 1e-3, arm = 1e-3 * pow(10, -k);
    SamBalance   b = {
        .kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {N, -N * arm, -2 * N * arm}};

    sam_assert(Press(&c, &b) == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert_close(b.load[1], -N * arm, 1e-10 * N * 1e-2);
    sam_assert_close(b.load[2], -2 * N * arm, 1e-10 * N * 1e-2);
    AssertPressed(&c, &b, 1e-8 * LargestDisplacement(&c));
  }
  DestroyCase(&c);
}

/* Points at random, with hardly any load and no moments, on all kinds of control. */
static void test_points_at_random_carry_a_small_load(void **state)
{
  Case c = NewCaseAt(0.31e-3, -0.17e-3);

  (void)state;
  for (PetscInt seed = 1; seed <= 150; seed++) {
    const double N = pow(10, -6 + 5 * Part(seed, 0, 1));
    SamBalance   b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {N, 0, 0}};
    Point        points[6];

    for (PetscInt k = 0; k < 6; k++)
      points[k] = (Point){(PetscInt)(NX * Part(seed, 1, k)), (PetscInt)(NY * Part(seed, 2, k)),
                          1e-3 * (1 - 0.1 * Part(seed, 3, k))};
    SetPoints(&c, 6, points);
    sam_assert(Press(&c, &b) == SAM_SOLVER_CONVERGED_RTOL);
    AssertPressed(&c, &b, fmax(1e-8 * LargestDisplacement(&c), 1e-18)); /* rounding of heights of 1 mm */
  }
  DestroyCase(&c);
}

/* A sphere above a row of cells: two of them carry it, and leave open how far it turns about the row. */
static void test_sphere_above_a_row_of_cells(void **state)
{
  const SamPair pair = NewPair(2, 0.3, 2, 0.3);
  const double  R    = 0.5;

  (void)state;
  for (int k = 0; k < 12; k++) {
    const double N = 1e-8 * pow(10, 0.3 * k);
    Case         c = {.grid = NewGridOn(PETSC_COMM_WORLD, 20, 20, 1, 0.5, 0.00881 - 1.1e-3 * k, -0.0125)};
    SamBalance   b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {N, 0, 0}};

    sam_call(SamElasticityCreate(c.grid, pair, &c.elasticity));
    c.h     = NewFrom(c.grid, Paraboloid, &R);
    c.p     = NewField(c.grid, 1);
    c.bound = NewField(c.grid, 1);
    c.q     = NewField(c.grid, 2);
    sam_assert(Press(&c, &b) == SAM_SOLVER_CONVERGED_RTOL);
    AssertPressed(&c, &b, fmax(1e-8 * LargestDisplacement(&c), 1e-16)); /* rounding of heights of 0.3 m */
    DestroyCase(&c);
  }
}

/* ---- the tangential problem ---- */

typedef struct {
  SamSolverReason reason;
  PetscReal       error, limit;
} Outcome;

static Outcome ShearFrom(const Case *c, SamBalance *balance, PetscBool guess)
{
  SamTangential solver;
  Outcome       o;

  sam_call(SamTangentialCreate(c->elasticity, &solver));
  sam_call(SamTangentialSolve(solver, c->bound, NULL, balance, guess, c->q));
  o.reason = SamSolverGetReason(SamTangentialAsSolver(solver));
  sam_call(SamSolverGetStatistics(SamTangentialAsSolver(solver), &o.error, NULL, NULL, NULL));
  o.limit = SamTangentialGetLimit(solver);
  sam_call(SamTangentialDestroy(&solver));
  return o;
}

static Outcome Shear(const Case *c, SamBalance *balance)
{
  return ShearFrom(c, balance, PETSC_FALSE);
}

/* The projection equation, from a product of its own. */
static void AssertSheared(const Case *c, const SamBalance *balance)
{
  Vec           u = NewField(c->grid, 2);
  const double *q, *b;
  double       *s, sums[2] = {0, 0};
  PetscReal     self;

  sam_call(SamElasticityGetSelfInfluence(c->elasticity, NULL, &self));
  sam_call(SamElasticityApplyTangential(c->elasticity, c->q, u));
  sam_call(VecGetArray(u, &s));
  sam_call(VecGetArrayRead(c->q, &q));
  sam_call(VecGetArrayRead(c->bound, &b));
  for (PetscInt j = 0; j < c->grid->rows; j++)
    for (PetscInt i = 0; i < c->grid->nx; i++) {
      const PetscInt k = j * c->grid->nx + i, l = k + c->grid->cells;
      const double   sx = s[k] - (balance->rigid[0] - SamGridY(c->grid, c->grid->row_start + j) * balance->rigid[2]);
      const double   sy = s[l] - (balance->rigid[1] + SamGridX(c->grid, i) * balance->rigid[2]);
      const double   x = q[k] - sx / self, y = q[l] - sy / self, size = hypot(x, y), d = size > b[k] ? b[k] / size : 1;

      if (b[k] <= 0) continue;
      sums[0] += (q[k] - d * x) * (q[k] - d * x) + (q[l] - d * y) * (q[l] - d * y);
      sums[1] += q[k] * q[k] + q[l] * q[l];
    }
  sam_call(VecRestoreArrayRead(c->bound, &b));
  sam_call(VecRestoreArrayRead(c->q, &q));
  sam_call(VecRestoreArray(u, &s));
  sam_call(SamSum(c->grid->comm, 2, sums));
  sam_call(VecDestroy(&u));
  sam_assert_close(sqrt(sums[0] / sums[1]), 0, 1.05e-6);
}

/* Up to the limit of sliding, with bounds from equal to 1 : 1000, and loads in all directions. */
static void AssertAllLoadsAreCarried(PetscInt n, const Point bounds[])
{
  const double level[]    = {0.1, 0.5, 0.9, 0.99, 0.999, 0.9999};
  const double loads[][3] = {{1, 0, 0}, {0, 1, 0}, {1, 0, 1e-3}, {0.3, -0.7, -2e-3}, {0, 0, 1e-3}};
  Case         c          = NewCase();

  for (PetscInt k = 0; k < n; k++) AddAt(c.grid, 0, bounds[k].i, bounds[k].j, bounds[k].height, c.bound);
  for (int load = 0; load < 5; load++) {
    SamBalance full = {.kind  = SAM_BALANCE_TANGENTIAL,
                       .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                       .load  = {loads[load][0], loads[load][1], loads[load][2]}};
    PetscReal  limit;

    sam_call(SamBalanceSlideLimit(c.grid, &full, c.bound, &limit, NULL));
    for (int k = 0; k < 6; k++) {
      SamBalance b = full, beyond = full;

      for (int m = 0; m < 3; m++) {
        b.load[m] *= limit * level[k];
        beyond.load[m] *= limit * pow(10, k) * 1.01;
      }
      sam_assert(Shear(&c, &b).reason > 0);
      AssertSheared(&c, &b);
      sam_assert(Shear(&c, &beyond).reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
    }
  }
  DestroyCase(&c);
}

static void test_shear_of_two_cells(void **state)
{
  const Point equal[] = {{5, 7, 1e6}, {8, 11, 1e6}}, unequal[] = {{5, 7, 1e6}, {6, 7, 1e3}};

  (void)state;
  AssertAllLoadsAreCarried(2, equal);
  AssertAllLoadsAreCarried(2, unequal);
}

static void test_shear_of_three_cells(void **state)
{
  const Point line[] = {{5, 8, 1e5}, {6, 8, 1e6}, {7, 8, 1e6}}, corner[] = {{5, 8, 1.4e4}, {6, 8, 3.5e6}, {6, 9, 9e4}};

  (void)state;
  AssertAllLoadsAreCarried(3, line);
  AssertAllLoadsAreCarried(3, corner);
}

static void test_shear_of_seven_cells(void **state)
{
  const Point points[] = {{2, 3, 1e6},  {2, 4, 1e4},  {7, 9, 3e5},  {8, 9, 2e3},
                          {8, 10, 4e6}, {11, 2, 1e6}, {10, 14, 5e5}};

  (void)state;
  AssertAllLoadsAreCarried(7, points);
}

/* Cells at random, of random bounds, under a force along x or any load, up to the limit. */
static void test_shear_of_cells_at_random(void **state)
{
  (void)state;
  for (PetscInt seed = 1; seed <= 150; seed++) {
    Case           c    = NewCaseAt(0.31e-3, -0.17e-3);
    const PetscInt n    = 1 + seed % 6;
    const double   some = seed % 2;
    SamBalance     b    = {.kind  = SAM_BALANCE_TANGENTIAL,
                           .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                           .load  = {1, some * Part(seed, 0, 1), some * 1e-3 * Part(seed, 0, 2)}};
    PetscReal      limit;

    for (PetscInt k = 0; k < n; k++)
      AddAt(c.grid, 0, 5 + (PetscInt)(3 * Part(seed, 1, k)), 7 + (PetscInt)(3 * Part(seed, 2, k)),
            pow(10, 3 + 3 * Part(seed, 3, k)), c.bound);
    sam_call(SamBalanceSlideLimit(c.grid, &b, c.bound, &limit, NULL));
    if (limit > 1e-6) { /* one cell does not lie on the line of any force */
      for (int m = 0; m < 3; m++) b.load[m] *= limit * (seed % 3 ? 0.9 : 0.9999);
      sam_assert(Shear(&c, &b).reason > 0);
      AssertSheared(&c, &b);
    }
    DestroyCase(&c);
  }
}

/* As when a sine goes through zero: of the shear that was there no more than the load's rounding is left. */
static void test_load_through_zero_leaves_no_shear_in_two_cells(void **state)
{
  const double kept[] = {0, 1e-15, -3e-17, 1e-200};

  (void)state;
  for (PetscInt seed = 1; seed <= 12; seed++) {
    Case           c = NewCaseAt(0.31e-3, -0.17e-3);
    const PetscInt i = 3 + seed % 5, j = 4 + seed % 3;
    SamBalance     first = {.kind  = SAM_BALANCE_TANGENTIAL,
                            .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                            .load  = {Part(seed, 0, 0), seed % 2 * Part(seed, 0, 1), 1e-3 * Part(seed, 0, 2)}};
    PetscReal      limit, size;

    AddAt(c.grid, 0, i, j, 1e6, c.bound);
    AddAt(c.grid, 0, i + 1, j + seed % 2, 7e5, c.bound);
    sam_call(SamBalanceSlideLimit(c.grid, &first, c.bound, &limit, NULL));
    for (int m = 0; m < 3; m++) first.load[m] *= 0.5 * limit;
    for (int k = 0; k < 4; k++) {
      SamBalance next = first;

      sam_assert(Shear(&c, &first).reason > 0);
      for (int m = 0; m < 3; m++) next.load[m] = kept[k] * first.load[m];
      sam_assert(ShearFrom(&c, &next, PETSC_TRUE).reason > 0);
      size = Norm(c.q, NORM_INFINITY);
      sam_assert(size <= 1e-13 * 1e6);
    }
    DestroyCase(&c);
  }
}

/* One cell carries a force through its centre; the torque about the origin is that force's to rounding only. */
static void test_one_cell_carries_a_force_through_its_centre(void **state)
{
  Case c = NewCaseAt(0.31e-3, -0.17e-3);

  (void)state;
  for (int k = 0; k < 60; k++) {
    const PetscInt i = (5 * k) % NX, j = (7 * k) % NY;
    const double   x = SamGridX(c.grid, i), y = SamGridY(c.grid, j), T = 1e6 * c.grid->dx * c.grid->dy, fx = cos(k),
                 fy   = sin(k);
    SamBalance b      = {.kind  = SAM_BALANCE_TANGENTIAL,
                         .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                         .load  = {0.7 * T * fx, 0.7 * T * fy, 0.7 * T * (x * fy - y * fx)}},
               beyond = b;
    PetscReal limit;

    sam_call(VecSet(c.bound, 0));
    AddAt(c.grid, 0, i, j, 1e6, c.bound);
    sam_call(SamBalanceSlideLimit(c.grid, &b, c.bound, &limit, NULL));
    sam_assert_close(limit, 1 / 0.7, 1e-9);
    sam_assert(Shear(&c, &b).reason > 0);
    AssertSheared(&c, &b);
    for (int m = 0; m < 3; m++) beyond.load[m] *= 2;
    sam_assert(Shear(&c, &beyond).reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
  }
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_bodies_free_to_tilt_lose_touch),
    cmocka_unit_test(test_three_points_around_the_middle_carry_bodies_free_to_tilt),
    cmocka_unit_test(test_two_points_leave_a_rotation_open_that_makes_no_overlap),
    cmocka_unit_test(test_resultant_next_to_one_of_three_points),
    cmocka_unit_test(test_points_at_random_carry_a_small_load),
    cmocka_unit_test(test_sphere_above_a_row_of_cells),
    cmocka_unit_test(test_shear_of_two_cells),
    cmocka_unit_test(test_shear_of_three_cells),
    cmocka_unit_test(test_shear_of_seven_cells),
    cmocka_unit_test(test_shear_of_cells_at_random),
    cmocka_unit_test(test_load_through_zero_leaves_no_shear_in_two_cells),
    cmocka_unit_test(test_one_cell_carries_a_force_through_its_centre),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

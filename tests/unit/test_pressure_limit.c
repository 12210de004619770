/*
 * A limit of the pressure in the solver: projections between two bounds, loads that can be borne, the normal problem.
 */
#include "fields.h"
#include "methods/methods.h"
#include "../../src/solvers/balance/projectionimpl.h"

#include <petsam/private/normal.h>
#include <petsam/private/balanceimpl.h>
#include <petsam/private/balance.h>

/* ---- projections ---- */

#define MOST 0.5 /* of random pressures, which reach from -1 to 1 */

/* What each component of a random admissible pressure carries, under control as `mask` says. */
static SamFrame NewFrame(SamGrid grid, int mask, double seed_scale)
{
  SamBalance b = {.kind = SAM_BALANCE_NORMAL};
  Vec        p = NewRandom(grid, 1, 40);
  double    *a;
  SamFrame   f;

  sam_call(VecGetArray(p, &a));
  for (PetscInt k = 0; k < grid->cells; k++) a[k] = seed_scale * fmin(fmax(a[k] + 0.3, 0), MOST);
  sam_call(VecRestoreArray(p, &a));
  sam_call(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, p, b.load));
  for (int k = 0; k < 3; k++) b.force[k] = mask & (1 << k) ? PETSC_TRUE : PETSC_FALSE;
  sam_call(SamFrameSet(&f, grid, &b));
  f.most = MOST;
  sam_call(VecDestroy(&p));
  return f;
}

typedef PetscErrorCode (*Projection)(const SamFrame *, double[], PetscBool *);

static PetscErrorCode ProjectAll(const SamFrame *f, double p[], PetscBool *found)
{
  return SamFrameProjectNormal(f, NULL, p, found);
}

static void Project(const SamFrame *f, Projection project, Vec p)
{
  PetscBool found;
  double   *a;

  sam_call(VecGetArray(p, &a));
  sam_call(project(f, a, &found));
  sam_call(VecRestoreArray(p, &a));
  sam_assert(found);
}

/* The largest error of a load, over the sum of the pressures and a length. */
static double Imbalance(const SamFrame *f, Vec p)
{
  double worst = 0;

  for (PetscInt k = 0; k < f->count; k++) {
    double        sum = 0;
    const double *a;

    sam_call(VecGetArrayRead(p, &a));
    for (PetscInt j = 0; j < f->grid->rows; j++)
      for (PetscInt i = 0; i < f->grid->nx; i++)
        sum += a[j * f->grid->nx + i] * SamFrameNormal(f->basis[k], f->xi0 + (double)i * f->dxi, SamFrameEta(f, j));
    sam_call(VecRestoreArrayRead(p, &a));
    sam_call(SamSum(f->grid->comm, 1, &sum));
    worst = fmax(worst, fabs(sum - f->target[k]) / Norm(p, NORM_1));
  }
  return worst;
}

/* No admissible pressure is nearer: (v - x).(w - x) <= 0 for all of them. */
static void test_projection_is_the_nearest_between_two_bounds(void **state)
{
  SamGrid grid = NewGrid(23, 17, 1e-3, 0.8e-3);

  (void)state;
  for (int mask = 0; mask < 8; mask++) {
    const SamFrame f = NewFrame(grid, mask, 1);
    Vec            v = NewRandom(grid, 1, mask), x = Copy(v);
    PetscReal      low, high;

    Project(&f, ProjectAll, x);
    sam_call(VecMin(x, NULL, &low));
    sam_call(VecMax(x, NULL, &high));
    sam_assert(low == 0 && high == MOST);
    sam_assert_close(Imbalance(&f, x), 0, 1e-11);
    sam_call(VecAXPY(v, -1, x));
    for (PetscInt seed = 20; seed < 26; seed++) {
      Vec w = NewRandom(grid, 1, seed);

      Project(&f, ProjectAll, w);
      sam_call(VecAXPY(w, -1, x));
      sam_assert(Dot(v, w) <= 1e-9 * Norm(v, NORM_2) * Norm(w, NORM_2));
      sam_call(VecDestroy(&w));
    }
    sam_destroy(&v, &x);
  }
  sam_call(SamGridDestroy(&grid));
}

/* How many cells are at a bound in both. */
static double CountBound(SamGrid grid, Vec a, Vec b, double bound)
{
  const double *x, *y;
  double        count = 0;

  sam_call(VecGetArrayRead(a, &x));
  sam_call(VecGetArrayRead(b, &y));
  for (PetscInt k = 0; k < grid->cells; k++) count += x[k] == bound && y[k] == bound;
  sam_call(VecRestoreArrayRead(b, &y));
  sam_call(VecRestoreArrayRead(a, &x));
  sam_call(SamSum(grid->comm, 1, &count));
  return count;
}

static void test_equilibrium_is_mended_between_the_bounds(void **state)
{
  SamGrid        grid  = NewGrid(23, 17, 1e-3, 0.8e-3);
  const SamFrame right = NewFrame(grid, 7, 1), f = NewFrame(grid, 7, 1 - 1e-6);
  Vec            x = NewRandom(grid, 1, 3), y;

  (void)state;
  Project(&right, ProjectAll, x);
  y = Copy(x);
  sam_assert(CountBound(grid, x, x, 0) > 50 && CountBound(grid, x, x, MOST) > 50);
  sam_assert(Imbalance(&f, x) > 1e-8);
  Project(&f, SamFrameProjectNormalBetween, x);
  sam_assert_close(Imbalance(&f, x), 0, 1e-11);
  sam_assert(CountBound(grid, x, y, 0) == CountBound(grid, y, y, 0));
  sam_assert(CountBound(grid, x, y, MOST) == CountBound(grid, y, y, MOST));
  sam_destroy(&x, &y);
  sam_call(SamGridDestroy(&grid));
}

static void test_cells_outside_of_a_mask_go_to_the_nearer_bound(void **state)
{
  SamGrid        grid = NewGrid(23, 17, 1e-3, 0.8e-3);
  const SamFrame f    = NewFrame(grid, 7, 1);
  Vec            p    = NewRandom(grid, 1, 5), before;
  float         *mask = (float *)calloc((size_t)grid->cells + 1, sizeof(*mask));
  const double  *was;
  double        *a, wrong = 0;
  PetscBool      found;

  (void)state;
  Project(&f, ProjectAll, p);
  before = Copy(p);
  for (PetscInt c = 0; c < grid->cells; c++) mask[c] = (c + grid->row_start * grid->nx) % 3 != 1 ? 1 : 0;
  sam_call(VecGetArrayRead(before, &was));
  sam_call(VecGetArray(p, &a));
  sam_call(SamFrameProjectNormal(&f, mask, a, &found));
  for (PetscInt c = 0; c < grid->cells; c++)
    if (mask[c] == 0) wrong += a[c] != (was[c] > 0.5 * MOST ? MOST : 0);
  sam_call(VecRestoreArray(p, &a));
  sam_call(VecRestoreArrayRead(before, &was));
  sam_assert(found);
  sam_assert(wrong == 0);
  sam_assert_close(Imbalance(&f, p), 0, 1e-11);
  free(mask);
  sam_destroy(&p, &before);
  sam_call(SamGridDestroy(&grid));
}

/* ---- which loads there are ---- */

static void test_capacity_of_a_grid(void **state)
{
  SamGrid           grid = NewGridOn(PETSC_COMM_WORLD, 20, 30, 2e-3, 3e-3, 1e-3, -2e-3);
  const double      H = 1e9, all = H * 6e-6;
  const PetscReal   cases[][3] = {{all, 2e-3 * all, 1e-3 * all},
                                  {1.0001 * all, 2e-3 * all, 1e-3 * all},
                                  {0.5 * all, 0.5 * all * (2e-3 + 0.749e-3), 0.5 * all * (1e-3 - 0.499e-3)},
                                  {0.5 * all, 0.5 * all * (2e-3 + 0.751e-3), 0.5 * all * 1e-3},
                                  {0.5 * all, 0.5 * all * (2e-3 - 0.751e-3), 0.5 * all * 1e-3},
                                  {0.5 * all, 0.5 * all * 2e-3, 0.5 * all * (1e-3 + 0.501e-3)},
                                  {0.5 * all, 0.5 * all * 2e-3, 0.5 * all * (1e-3 - 0.501e-3)}};
  const char *const names[]    = {NULL, "load_n", NULL, "load_mx", "load_mx", "load_my", "load_my"};

  (void)state;
  for (int c = 0; c < 7; c++) {
    const SamBalance b = {.kind  = SAM_BALANCE_NORMAL,
                          .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                          .load  = {cases[c][0], cases[c][1], cases[c][2]}};
    char             message[256];
    PetscBool        possible;

    sam_call(SamBalanceCapacity(grid, &b, H, message, sizeof(message), &possible));
    sam_assert(possible == (names[c] ? PETSC_FALSE : PETSC_TRUE));
    sam_assert(names[c] ? strstr(message, names[c]) != NULL && strstr(message, "limit") != NULL : !message[0]);
    sam_call(SamBalanceCapacity(grid, &b, INFINITY, message, sizeof(message), &possible));
    sam_assert(possible && !message[0]);
  }
  sam_call(SamGridDestroy(&grid));
}

/* The dual of pressures a between 0 and MOST on all cells, whose field is zero; `context`: the number of passes. */
static void CountedPass(const SamFrame *f, const void *context, const double a[3], SamTotal dual[])
{
  SamDual      sums = {0};
  const double p = fmin(fmax(a[0], 0), MOST), cells = (double)f->grid->cells;
  int *const   count = *(int *const *)context;

  *count += 1;
  sums.value   = cells * p * (a[0] - 0.5 * p);
  sums.scale   = cells * p;
  sums.sums[0] = cells * p;
  sums.gram[0] = a[0] > 0 && a[0] < MOST ? cells : 0;
  SamAddAll(SAM_DUAL, dual, (const double *)&sums);
}

/* The search for more than all cells can bear ends with the first line that falls without end. */
static void test_a_load_beyond_all_bounds_is_given_up_at_once(void **state)
{
  SamGrid grid = NewGrid(9, 7, 9e-3, 7e-3);

  (void)state;
  for (int beyond = 0; beyond < 2; beyond++) {
    SamBalance b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE}};
    SamFrame   f;
    int        passes = 0, *count = &passes;
    double     a[3];
    PetscBool  found, near;

    b.load[0] = (beyond ? 1.3 : 0.8) * MOST * (double)(grid->dx * grid->dy) * 63;
    sam_call(SamFrameSet(&f, grid, &b));
    f.most = MOST;
    sam_call(SamDualMinimize(&f, CountedPass, &count, 0, a, &found, &near));
    sam_assert(found == (beyond ? PETSC_FALSE : PETSC_TRUE) && near == found);
    sam_assert(passes <= 70);
  }
  sam_call(SamGridDestroy(&grid));
}

/* ---- the normal problem ---- */

/* The largest error of the conditions, over the displacement, by a product in double precision. */
static double Error(const Sphere *s, const SamBalance *b, Vec p, double H, double *saturated)
{
  Vec           u     = NewField(s->grid, 1);
  SamBalance    moved = *b;
  const double *at, *h, *w;
  double        worst = 0, scale, count = 0;
  SamFrame      f;

  sam_call(SamFrameSetGiven(&f, s->grid, &moved));
  sam_call(SamElasticityApplyNormal(s->elasticity, p, u));
  scale = Norm(u, NORM_INFINITY);
  sam_call(VecGetArrayRead(p, &at));
  sam_call(VecGetArrayRead(s->h, &h));
  sam_call(VecGetArrayRead(u, &w));
  for (PetscInt j = 0; j < s->grid->rows; j++)
    for (PetscInt i = 0; i < s->grid->nx; i++) {
      const PetscInt k = j * s->grid->nx + i;
      const double   g = w[k] + h[k] - SamFrameNormal(f.fixed, f.xi0 + (double)i * f.dxi, SamFrameEta(&f, j));

      worst = fmax(worst, at[k] >= SAM_SATURATED * H ? g : at[k] > 0 ? fabs(g) : -g);
      worst = fmax(worst, (at[k] < 0 || at[k] > H) ? INFINITY : 0);
      count += at[k] == H;
    }
  sam_call(VecRestoreArrayRead(u, &w));
  sam_call(VecRestoreArrayRead(s->h, &h));
  sam_call(VecRestoreArrayRead(p, &at));
  sam_call(SamMax(s->grid->comm, 1, &worst));
  sam_call(SamSum(s->grid->comm, 1, &count));
  *saturated = count;
  sam_call(VecDestroy(&u));
  return worst / scale;
}

static void test_conditions_hold_with_two_bounds(void **state)
{
  const double parts[] = {0.99, 0.7, 0.4, 0.2};

  (void)state;
  for (int k = 0; k < 4; k++)
    for (int start = 0; start < 2; start++) {
      Sphere     s = NewSphere(k % 2 ? 61 : 90, 3, 0.3);
      SamBalance b = {
        .kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE}, .load = {s.N, 0.1 * s.N * s.a, 0}};
      Vec             p = start ? NewRandom(s.grid, 1, k) : NewField(s.grid, 1);
      double          saturated, before;
      SamNormal       normal;
      SamSolverReason reason;

      sam_call(VecScale(p, 2 * s.p0));
      sam_call(SamNormalCreate(s.elasticity, &normal));
      sam_call(SamNormalSetPressureLimit(normal, parts[k] * s.p0));
      sam_call(SamNormalSolve(normal, s.h, &b, start ? PETSC_TRUE : PETSC_FALSE, p));
      reason = SamSolverGetReason(SamNormalAsSolver(normal));
      sam_assert(reason == SAM_SOLVER_CONVERGED_RTOL);
      sam_assert(Error(&s, &b, p, parts[k] * s.p0, &saturated) < 1.05e-8);
      before = k ? 0.3 * s.N / (parts[k] * s.p0 * s.grid->dx * s.grid->dy) : 5;
      sam_assert(saturated > before);
      sam_assert_close(Sum(p) * s.grid->dx * s.grid->dy, s.N, 1e-10 * s.N);
      sam_call(SamNormalDestroy(&normal));
      sam_call(VecDestroy(&p));
      DestroySphere(&s);
    }
}

static void test_methods_without_an_upper_bound_refuse_it(void **state)
{
  Sphere     s = NewSphere(20, 1.5, 0.3);
  SamBalance b = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE}, .load = {s.N}};
  Vec        p = NewField(s.grid, 1);
  SamNormal  normal;
  PetscBool  limits;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  limits = SamNormalLimitsPressure(normal);
  sam_assert(limits);
  sam_fails(SamNormalSetPressureLimit(normal, 0), PETSC_ERR_ARG_OUTOFRANGE);
  sam_fails(SamNormalSetPressureLimit(normal, NAN), PETSC_ERR_ARG_OUTOFRANGE);
  sam_call(SamNormalSetPressureLimit(normal, s.p0));
  sam_call(SamSolverSetType(SamNormalAsSolver(normal), SAM_NORMAL_POLONSKYKEER));
  limits = SamNormalLimitsPressure(normal);
  sam_assert(!limits);
  sam_fails(SamNormalSolve(normal, s.h, &b, PETSC_FALSE, p), PETSC_ERR_SUP);
  sam_call(SamNormalSetPressureLimit(normal, INFINITY));
  sam_call(SamNormalSolve(normal, s.h, &b, PETSC_FALSE, p));
  sam_call(SamNormalDestroy(&normal));
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_projection_is_the_nearest_between_two_bounds),
    cmocka_unit_test(test_equilibrium_is_mended_between_the_bounds),
    cmocka_unit_test(test_cells_outside_of_a_mask_go_to_the_nearer_bound),
    cmocka_unit_test(test_capacity_of_a_grid),
    cmocka_unit_test(test_a_load_beyond_all_bounds_is_given_up_at_once),
    cmocka_unit_test(test_conditions_hold_with_two_bounds),
    cmocka_unit_test(test_methods_without_an_upper_bound_refuse_it),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * The rigid-body components: projections that keep equilibrium, the limit of sliding, levers.
 */
#include "fields.h"

#include <petsam/private/balanceimpl.h>
#include <petsam/private/balance.h>

/* Grids about the origin, aside, and far away; one with fewer rows than ranks. */
static const double place[][2] = {{0, 0}, {3e-4, -2e-4}, {1, -0.7}, {0, 0}};
static const int    cells[][2] = {{17, 13}, {12, 19}, {16, 15}, {9, 2}};
enum { NUM_GRIDS = sizeof(cells) / sizeof(cells[0]) };

/*
  Loads relative to the sum of |traction| dA, times half the grid's width for moments, which are taken about its centre:
  the projection's own 1e-14, and for a grid 1000 widths away the rounding of the moments about the origin.
*/
static const double exact = 1e-11;

static SamGrid Grid(int k)
{
  return NewGridOn(PETSC_COMM_WORLD, cells[k][0], cells[k][1], 1e-3, 0.8e-3, place[k][0], place[k][1]);
}

static SamBalance Balance(SamBalanceKind kind, int mask, const PetscReal loads[3])
{
  SamBalance b = {.kind = kind};

  for (int k = 0; k < 3; k++) {
    b.force[k] = mask & (1 << k) ? PETSC_TRUE : PETSC_FALSE;
    b.load[k]  = b.force[k] ? loads[k] : NAN; /* what is a result must not be read */
    b.rigid[k] = b.force[k] ? NAN : 0;
  }
  return b;
}

/* What the loads of a traction differ from those wanted, by the measure above; all moments about the grid's centre. */
static double Imbalance(SamGrid grid, const SamBalance *b, Vec traction, double *size)
{
  const double area = grid->dx * grid->dy;
  PetscReal    loads[3];
  double       worst = 0, error[3];

  *size = Norm(traction, NORM_1) * area;
  sam_call(SamBalanceGetLoads(grid, b->kind, traction, loads));
  for (int k = 0; k < 3; k++) error[k] = b->force[k] ? loads[k] - b->load[k] : 0;
  /* with the forces under control as well, their error moves to the centre */
  if (b->kind == SAM_BALANCE_NORMAL && b->force[0]) {
    error[1] += b->force[1] ? grid->center[1] * error[0] : 0;
    error[2] -= b->force[2] ? grid->center[0] * error[0] : 0;
  }
  for (int k = 0; k < 3; k++) {
    const int    moment = b->kind == SAM_BALANCE_NORMAL ? k > 0 : k == 2;
    const double arm =
      b->force[0] && b->force[1] ? grid->length : grid->length + fabs(grid->center[0]) + fabs(grid->center[1]);

    worst = fmax(worst, fabs(error[k]) / (*size * (moment ? arm : 1)));
  }
  return worst;
}

/* A random pressure with holes, and a random bound with them. */
static Vec NewPressure(SamGrid grid, PetscInt seed)
{
  Vec     p = NewRandom(grid, 1, seed);
  double *a;

  sam_call(VecGetArray(p, &a));
  for (PetscInt k = 0; k < grid->cells; k++) a[k] = fmax(0, a[k] + 0.3);
  sam_call(VecRestoreArray(p, &a));
  return p;
}

/* A random shear at most `most` of the bound. */
static Vec NewShear(SamGrid grid, Vec bound, PetscInt seed, double most)
{
  Vec           q = NewRandom(grid, 2, seed);
  double       *a;
  const double *b;

  sam_call(VecGetArray(q, &a));
  sam_call(VecGetArrayRead(bound, &b));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) a[k] *= most * b[k % grid->cells] / sqrt(2);
  sam_call(VecRestoreArrayRead(bound, &b));
  sam_call(VecRestoreArray(q, &a));
  return q;
}

static PetscBool Project(SamGrid grid, const SamBalance *b, Vec bound, Vec traction)
{
  SamFrame      f;
  double       *t;
  const double *a;
  PetscBool     found;

  sam_call(SamFrameSet(&f, grid, b));
  sam_call(VecGetArray(traction, &t));
  if (b->kind == SAM_BALANCE_NORMAL)
    sam_call(SamFrameProjectNormal(&f, NULL, t, &found));
  else {
    sam_call(VecGetArrayRead(bound, &a));
    sam_call(SamFrameProjectTangential(&f, NULL, a, NULL, PETSC_FALSE, t, NULL, &found));
    sam_call(VecRestoreArrayRead(bound, &a));
  }
  sam_call(VecRestoreArray(traction, &t));
  return found;
}

/* p >= 0, or |q| <= bound to the rounding of a root. */
static void AssertAdmissible(SamGrid grid, SamBalanceKind kind, Vec bound, Vec traction)
{
  const double *t, *b;
  double        worst = 0;

  sam_call(VecGetArrayRead(traction, &t));
  sam_call(VecGetArrayRead(bound, &b));
  for (PetscInt k = 0; k < grid->cells; k++)
    worst =
      fmax(worst, kind == SAM_BALANCE_NORMAL ? -t[k] : hypot(t[k], t[k + grid->cells]) - b[k] * (1 + 4 * DBL_EPSILON));
  sam_call(VecRestoreArrayRead(bound, &b));
  sam_call(VecRestoreArrayRead(traction, &t));
  sam_assert(worst <= 0);
}

/* For all choices of controlled components, loads that are known to be possible, and all places. */
static void AssertProjection(SamBalanceKind kind)
{
  const PetscInt components = kind == SAM_BALANCE_NORMAL ? 1 : 2;

  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid grid  = Grid(k);
    Vec     bound = NewPressure(grid, 3),
        known     = kind == SAM_BALANCE_NORMAL ? NewPressure(grid, 4) : NewShear(grid, bound, 4, 0.9);
    PetscReal loads[3];

    sam_call(SamBalanceGetLoads(grid, kind, known, loads));
    for (int mask = 0; mask < 8; mask++) {
      const SamBalance b = Balance(kind, mask, loads);
      Vec              v = NewRandom(grid, components, mask), x = Copy(v), y;
      double           size, far;

      sam_assert(Project(grid, &b, bound, x));
      AssertAdmissible(grid, kind, bound, x);
      sam_assert_close(Imbalance(grid, &b, x, &size), 0, exact);
      /* again: the same */
      y = Copy(x);
      sam_assert(Project(grid, &b, bound, y));
      sam_assert_close(Difference(y, x, NORM_2), 0, 1e-10); /* errors of equilibrium, 1e-11, spread over cells */
      sam_call(VecDestroy(&y));
      /* nearest: (v - x).(w - x) <= 0 for all admissible w */
      far = Norm(v, NORM_2);
      for (PetscInt seed = 20; seed < 30; seed++) {
        Vec w = seed == 20 ? Copy(known) : NewRandom(grid, components, seed), d = Copy(v);

        sam_assert(Project(grid, &b, bound, w));
        AssertAdmissible(grid, kind, bound, w);
        sam_call(VecAXPY(d, -1, x));
        sam_call(VecAXPY(w, -1, x));
        sam_assert(Dot(d, w) <= 1e-9 * (far + Norm(x, NORM_2)) *
                                  (Norm(w, NORM_2) + 1e-3)); /* errors of equilibrium times the multipliers */
        sam_destroy(&w, &d);
      }
      sam_destroy(&v, &x);
    }
    sam_destroy(&bound, &known);
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_normal_projection_is_the_nearest_admissible_pressure(void **state)
{
  (void)state;
  AssertProjection(SAM_BALANCE_NORMAL);
}

static void test_tangential_projection_is_the_nearest_admissible_shear(void **state)
{
  (void)state;
  AssertProjection(SAM_BALANCE_TANGENTIAL);
}

/* sum d.w/weight over the cells */
static double WeightedDot(SamGrid grid, Vec d, Vec w, const float *weight)
{
  const double *a, *b;
  double        sum = 0;

  sam_call(VecGetArrayRead(d, &a));
  sam_call(VecGetArrayRead(w, &b));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) sum += a[k] * b[k] / (double)weight[k % grid->cells];
  sam_call(VecRestoreArrayRead(w, &b));
  sam_call(VecRestoreArrayRead(d, &a));
  sam_call(SamSum(grid->comm, 1, &sum));
  return sum;
}

/* With weights from 1e-3 to 1: (v - x).(w - x) <= 0 for all admissible w, each cell divided by its weight. */
static void test_weighted_projection_is_the_nearest_shear_in_its_metric(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid grid  = Grid(k);
    Vec     bound = NewPressure(grid, 3), known = NewShear(grid, bound, 4, 0.9), v = NewRandom(grid, 2, 7), x = Copy(v);
    float  *weight = (float *)calloc((size_t)grid->cells + 1, sizeof(*weight));
    PetscReal     loads[3];
    SamBalance    b;
    SamFrame      f;
    double       *a, size;
    const double *radius;
    PetscBool     found;

    for (PetscInt c = 0; c < grid->cells; c++) weight[c] = (float)pow(10, -((c + grid->row_start * grid->nx) % 4));
    sam_call(SamBalanceGetLoads(grid, SAM_BALANCE_TANGENTIAL, known, loads));
    b = Balance(SAM_BALANCE_TANGENTIAL, 7, loads);
    sam_call(SamFrameSet(&f, grid, &b));
    sam_call(VecGetArray(x, &a));
    sam_call(VecGetArrayRead(bound, &radius));
    sam_call(SamFrameProjectTangential(&f, NULL, radius, weight, PETSC_TRUE, a, NULL, &found));
    sam_call(VecRestoreArrayRead(bound, &radius));
    sam_call(VecRestoreArray(x, &a));
    sam_assert(found);
    AssertAdmissible(grid, SAM_BALANCE_TANGENTIAL, bound, x);
    sam_assert_close(Imbalance(grid, &b, x, &size), 0, exact);
    sam_call(VecAXPY(v, -1, x));
    for (PetscInt seed = 20; seed < 30; seed++) {
      Vec w = seed == 20 ? Copy(known) : NewRandom(grid, 2, seed);

      sam_assert(Project(grid, &b, bound, w));
      sam_call(VecAXPY(w, -1, x));
      sam_assert(WeightedDot(grid, v, w, weight) <=
                 1e-9 * 1e3 * Norm(v, NORM_2) * (Norm(w, NORM_2) + 1e-3)); /* as above, over the least weight */
      sam_call(VecDestroy(&w));
    }
    free(weight);
    sam_destroy(&v, &x, &bound, &known);
    sam_call(SamGridDestroy(&grid));
  }
}

/*
  Every fifth cell has weight 0: it keeps its shear, inside its disc or on it, and the others carry what is left. Then
  the others have it, on discs so wide that all cells are inside, and every fifth carries as much in the opposite
  direction, so that the dual falls by the work of the shear that is kept alone.
*/
static void test_cells_of_weight_0_keep_their_shear(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * NUM_GRIDS; k++) {
    SamGrid         grid  = Grid(k % NUM_GRIDS);
    Vec             bound = NewPressure(grid, 3), known = NewShear(grid, bound, 4, 0.9), x = NewRandom(grid, 2, 7);
    float          *weight = (float *)calloc((size_t)grid->cells + 1, sizeof(*weight));
    const PetscBool wide   = k >= NUM_GRIDS;
    PetscReal       loads[3];
    SamBalance      b;
    SamFrame        f;
    double         *a, size, moved = 0;
    const double   *radius, *kept;
    PetscBool       found;

    if (wide) sam_call(VecScale(bound, 50));
    sam_call(SamBalanceGetLoads(grid, SAM_BALANCE_TANGENTIAL, known, loads));
    for (int j = 0; j < 3; j++) loads[j] *= wide ? -0.1 : 1;
    b = Balance(SAM_BALANCE_TANGENTIAL, 7, loads);
    sam_call(SamFrameSet(&f, grid, &b));
    sam_call(VecGetArray(x, &a));
    sam_call(VecGetArrayRead(bound, &radius));
    sam_call(VecGetArrayRead(known, &kept));
    for (PetscInt c = 0; c < 2 * grid->cells; c++) {
      const PetscBool fifth = (c % grid->cells + grid->row_start * grid->nx) % 5 == 0, keeps = fifth != wide;

      weight[c % grid->cells] = keeps ? 0 : 1;
      if (keeps) a[c] = kept[c];
    }
    sam_call(SamFrameProjectTangential(&f, NULL, radius, weight, PETSC_TRUE, a, NULL, &found));
    for (PetscInt c = 0; c < 2 * grid->cells; c++)
      if (weight[c % grid->cells] <= 0) moved = PetscMax(moved, fabs(a[c] - kept[c]));
    sam_call(SamMax(grid->comm, 1, &moved));
    sam_call(VecRestoreArrayRead(known, &kept));
    sam_call(VecRestoreArrayRead(bound, &radius));
    sam_call(VecRestoreArray(x, &a));
    sam_assert(found);
    sam_assert_close(moved, 0, exact);
    AssertAdmissible(grid, SAM_BALANCE_TANGENTIAL, bound, x);
    sam_assert_close(Imbalance(grid, &b, x, &size), 0, exact);
    free(weight);
    sam_destroy(&x, &bound, &known);
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_normal_projection_keeps_to_its_mask(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid         grid = Grid(k);
    const PetscReal N = 5, loads[3] = {N, -N * (grid->center[1] + 0.02e-3), N * (grid->center[0] + 0.05e-3)};
    SamBalance      b    = Balance(SAM_BALANCE_NORMAL, 7, loads);
    Vec             p    = NewRandom(grid, 1, 1);
    float          *mask = (float *)calloc((size_t)grid->cells + 1, sizeof(*mask));
    double         *a, size, outside = 0;
    SamFrame        f;
    PetscBool       found;

    for (PetscInt c = 0; c < grid->cells; c++) mask[c] = (c + grid->row_start * grid->nx) % 3 != 1 ? 1 : 0;
    sam_call(SamFrameSet(&f, grid, &b));
    sam_call(VecGetArray(p, &a));
    sam_call(SamFrameProjectNormal(&f, mask, a, &found));
    for (PetscInt c = 0; c < grid->cells; c++)
      if (mask[c] == 0) outside += fabs(a[c]);
    sam_call(VecRestoreArray(p, &a));
    sam_assert(found);
    sam_assert(outside == 0);
    sam_assert_close(Imbalance(grid, &b, p, &size), 0, exact);
    free(mask);
    sam_call(VecDestroy(&p));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_impossible_normal_loads_are_found(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid      grid = Grid(k);
    const double x = grid->center[0], y = grid->center[1], h = 0.5 * grid->width[0] - 0.49 * grid->dx,
                 v             = 0.5 * grid->width[1] - 0.49 * grid->dy;
    const PetscReal cases[][3] = {{-1, 0, 0},
                                  {1, -y, x + h}, /* the resultant just beyond the outermost centres */
                                  {1, -y, x - h},
                                  {1, -(y + v), x},
                                  {2, -2 * y, 2 * x + 4 * h}};

    for (int c = 0; c < 5; c++) {
      const SamBalance b = Balance(SAM_BALANCE_NORMAL, c ? 7 : 1, cases[c]);
      Vec              p = NewRandom(grid, 1, c), before = Copy(p);

      sam_assert(!Project(grid, &b, p, p));
      sam_assert(Difference(p, before, NORM_INFINITY) == 0); /* left as it was */
      sam_destroy(&p, &before);
    }
    sam_call(SamGridDestroy(&grid));
  }
}

/* A cell that is no number, on the first rank, ends the projection everywhere: nothing is nearest to it. */
static void test_a_shear_with_nan_is_not_projected(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid          grid     = Grid(k);
    const PetscReal  loads[3] = {1, 0, 0};
    const SamBalance b        = Balance(SAM_BALANCE_TANGENTIAL, 3, loads);
    Vec              q = NewRandom(grid, 2, 1), bound = NewField(grid, 1);
    double          *a;

    sam_call(VecSet(bound, 1e9));
    sam_call(VecGetArray(q, &a));
    if (grid->cells && !grid->row_start) a[0] = NAN;
    sam_call(VecRestoreArray(q, &a));
    sam_assert(!Project(grid, &b, bound, q));
    sam_destroy(&q, &bound);
    sam_call(SamGridDestroy(&grid));
  }
}

/* ---- sliding ---- */

static double Disc(double x, double y, const void *context)
{
  const double *d = (const double *)context; /* centre, radius */

  return hypot(x - d[0], y - d[1]) < d[2] ? 1 : 0;
}

static SamBalance Forced(double x, double y, double z)
{
  const PetscReal loads[3] = {x, y, z};

  return Balance(SAM_BALANCE_TANGENTIAL, 7, loads);
}

static double Limit(SamGrid grid, const SamBalance *b, Vec bound)
{
  PetscReal factor;

  sam_call(SamBalanceSlideLimit(grid, b, bound, &factor, NULL));
  return factor;
}

static void test_force_alone_slides_at_the_sum_of_the_bound(void **state)
{
  const double disc[3] = {0, 0, 0.4e-3};
  SamGrid      grid    = NewGrid(27, 27, 1e-3, 1e-3);
  Vec          bound   = NewFrom(grid, Disc, disc);
  const double all     = Sum(bound) * grid->dx * grid->dy;

  (void)state;
  for (int k = 0; k < 4; k++) {
    const double     size = k == 3 ? 1e308 : 1;
    const SamBalance b    = Forced(size * cos(k), size * sin(k), 0);

    sam_assert_close(Limit(grid, &b, bound) * size, all,
                     2e-11 * all); /* the tolerance of equilibrium, 1e-11, counts as carried */
  }
  sam_call(VecDestroy(&bound));
  sam_call(SamGridDestroy(&grid));
}

static void test_torque_alone_slides_at_two_thirds_of_a_uniform_disc(void **state)
{
  const double disc[3] = {0, 0, 0.4e-3};

  (void)state;
  for (PetscInt n = 32; n <= 128; n *= 2) {
    SamGrid          grid  = NewGrid(n, n + 3, 1e-3, 1e-3);
    Vec              bound = NewFrom(grid, Disc, disc);
    const double     all   = Sum(bound) * grid->dx * grid->dy;
    const SamBalance b     = Forced(0, 0, 1);

    sam_assert_close(Limit(grid, &b, bound), 2.0 / 3 * all * disc[2],
                     1.2 / (double)n * all * disc[2]); /* the rim is cells wide */
    sam_call(VecDestroy(&bound));
    sam_call(SamGridDestroy(&grid));
  }
}

/*
  Each limit load lies inside the limits of its parts, and outside the straight line between them: the set is convex.
*/
static void test_combined_limit_lies_between_line_and_rectangle(void **state)
{
  const double disc[3] = {0, 0, 0.4e-3};
  SamGrid      grid    = NewGrid(31, 31, 1e-3, 1e-3);
  Vec          bound   = NewFrom(grid, Disc, disc);
  SamBalance   force = Forced(1, 0, 0), torque = Forced(0, 0, 1);
  const double T = Limit(grid, &force, bound), M = Limit(grid, &torque, bound);
  double       last = M * (1 + 1e-9);

  (void)state;
  for (int k = 1; k < 10; k++) {
    const double     t = 0.1 * k, m = 1 - t;
    const SamBalance b = Forced(t * T, 0, m * M);
    const double     f = Limit(grid, &b, bound);

    sam_assert(f * t <= 1 + 1e-9 && f * m <= 1 + 1e-9);
    sam_assert(f >= 1 - 1e-9);
    sam_assert(f * m * M < last); /* more force, less torque */
    last = f * m * M;
  }
  sam_call(VecDestroy(&bound));
  sam_call(SamGridDestroy(&grid));
}

/* The limit by virtual power against the projection, which looks for a shear: no gap between them, on rough bounds. */
static void test_loads_are_feasible_below_the_limit_and_not_above(void **state)
{
  const double loads[][3] = {{1, 0, 0}, {0, 0, 1}, {1, 1, 0.5}, {-0.3, 1, -2}, {0.01, 0, 1}};

  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid grid  = Grid(k);
    Vec     bound = NewPressure(grid, 9);

    for (int c = 0; c < 5; c++)
      for (int mask = 1; mask < 8; mask++) {
        const double     arm = 0.3e-3, x = loads[c][0], y = loads[c][1];
        const PetscReal  given[3] = {x, y, loads[c][2] * arm + grid->center[0] * y - grid->center[1] * x};
        const SamBalance b        = Balance(SAM_BALANCE_TANGENTIAL, mask, given);
        double           f = Limit(grid, &b, bound), norm = 0;

        for (int i = 0; i < 3; i++) norm += b.force[i] ? fabs(given[i]) : 0;
        if (norm == 0) {
          sam_assert(f > 1e300);
          continue;
        }
        if (place[k][0] == 1 && (mask & 4) && mask != 7) continue; /* about a far centre the torque is a force: below */
        for (int above = 0; above < 2; above++) {
          const double    by    = f * (above ? 1 + 1e-5 : 1 - 1e-5);
          const PetscReal at[3] = {by * given[0], by * given[1], by * given[2]};
          SamBalance      near  = Balance(SAM_BALANCE_TANGENTIAL, mask, at);
          Vec             q     = NewField(grid, 2);
          const PetscBool found = Project(grid, &near, bound, q);

          if (getenv("SAM_SHOW") && (int)found == above)
            print_message("# grid %d load %d mask %d above %d limit %.15g\n", k, c, mask, above, f);
          sam_assert(found == (above ? PETSC_FALSE : PETSC_TRUE));
          sam_call(VecDestroy(&q));
        }
      }
    sam_call(VecDestroy(&bound));
    sam_call(SamGridDestroy(&grid));
  }
}

/* The shear of sliding carries the limit of the loads, and is at its bound but near the centre of rotation. */
static void test_sliding_shear_carries_the_limit_of_the_loads(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid         grid  = Grid(k);
    Vec             bound = NewPressure(grid, 9), shear = NewField(grid, 2);
    const PetscReal given[3] = {1, -0.5, 0.4e-3 - 0.5 * grid->center[0] - grid->center[1]};
    SamBalance      b        = Balance(SAM_BALANCE_TANGENTIAL, 7, given);
    PetscReal       factor, loads[3], beyond = 0, within = 0;
    const double   *a, *q;

    sam_call(SamBalanceSlideLimit(grid, &b, bound, &factor, shear));
    sam_call(SamBalanceGetLoads(grid, SAM_BALANCE_TANGENTIAL, shear, loads));
    for (int i = 0; i < 3; i++) sam_assert_close(loads[i], factor * given[i], 1e-9 * fabs(factor * given[i]));
    sam_call(VecGetArrayRead(bound, &a));
    sam_call(VecGetArrayRead(shear, &q));
    for (PetscInt i = 0; i < grid->cells; i++) {
      const double size = hypot(q[i], q[i + grid->cells]);

      beyond = fmax(beyond, size - a[i]);
      within += a[i] > 0 && size < (1 - 1e-6) * a[i];
    }
    sam_call(VecRestoreArrayRead(shear, &q));
    sam_call(VecRestoreArrayRead(bound, &a));
    sam_assert(beyond <= 1e-15 * Norm(bound, NORM_INFINITY));
    sam_call(SamSum(grid->comm, 1, &within));
    sam_assert(within <= 1);
    sam_destroy(&bound, &shear);
    sam_call(SamGridDestroy(&grid));
  }
}

/* ---- levers, frames ---- */

static void test_lever_must_lie_among_the_cell_centres(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid      grid = Grid(k);
    const double N = 7, right = SamGridX(grid, grid->nx - 1), low = SamGridY(grid, 0), d = 1e-3 * grid->dx;
    const struct {
      double Mx, My;
      int    possible;
    } cases[] = {{-N * grid->center[1], N * grid->center[0], 1},
                 {-N * grid->center[1], N * (right - d), 1},
                 {-N * grid->center[1], N * (right + d), 0},
                 {-N * (low + d), N * grid->center[0], 1},
                 {-N * (low - d), N * grid->center[0], 0}};
    char      message[256];
    PetscBool possible;

    for (int c = 0; c < 5; c++) {
      const PetscReal  loads[3] = {N, cases[c].Mx, cases[c].My};
      const SamBalance b = Balance(SAM_BALANCE_NORMAL, 7, loads), other = Balance(SAM_BALANCE_NORMAL, 6, loads);

      sam_call(SamBalanceLever(grid, &b, message, sizeof(message), &possible));
      sam_assert(possible == (PetscBool)cases[c].possible);
      sam_assert(!possible == (strstr(message, c < 3 ? "load_my" : "load_mx") != NULL));
      sam_call(SamBalanceLever(grid, &other, message, sizeof(message), &possible));
      sam_assert(possible); /* N adapts */
    }
    {
      const PetscReal  moment[3] = {0, 1, 0}, none[3] = {0, 0, 0};
      const SamBalance b = Balance(SAM_BALANCE_NORMAL, 7, moment), zero = Balance(SAM_BALANCE_NORMAL, 7, none);

      sam_call(SamBalanceLever(grid, &b, message, sizeof(message), &possible));
      sam_assert(!possible && strstr(message, "load_mx"));
      sam_call(SamBalanceLever(grid, &zero, message, sizeof(message), &possible));
      sam_assert(possible);
    }
    sam_call(SamGridDestroy(&grid));
  }
}

/* Loads and rigid displacements are conjugate: sum traction . rigid displacement dA = sum load * rigid. */
static void test_loads_are_conjugate_to_displacements(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_GRIDS; k++) {
    SamGrid         grid     = Grid(k);
    const PetscReal rigid[3] = {0.7, -0.4, 0.9};

    for (int kind = 0; kind < 2; kind++) {
      Vec           t = NewRandom(grid, kind + 1, 5);
      const double *a;
      double        power = 0;
      PetscReal     loads[3];

      sam_call(VecGetArrayRead(t, &a));
      for (PetscInt j = 0; j < grid->rows; j++)
        for (PetscInt i = 0; i < grid->nx; i++) {
          const double   x = SamGridX(grid, i), y = SamGridY(grid, grid->row_start + j);
          const PetscInt c = j * grid->nx + i;

          if (kind == 0)
            power += a[c] * (rigid[0] - y * rigid[1] + x * rigid[2]);
          else
            power += a[c] * (rigid[0] - y * rigid[2]) + a[c + grid->cells] * (rigid[1] + x * rigid[2]);
        }
      sam_call(VecRestoreArrayRead(t, &a));
      (void)MPI_Allreduce(MPI_IN_PLACE, &power, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
      power *= grid->dx * grid->dy;
      sam_call(SamBalanceGetLoads(grid, kind ? SAM_BALANCE_TANGENTIAL : SAM_BALANCE_NORMAL, t, loads));
      sam_assert_close(loads[0] * rigid[0] + loads[1] * rigid[1] + loads[2] * rigid[2], power,
                       1e-13 * Norm(t, NORM_1) * grid->dx * grid->dy); /* rounding of sums */
      sam_call(VecDestroy(&t));
    }
    sam_call(SamGridDestroy(&grid));
  }
}

/*
  Runs contain all cells with a bound or with shear, lie apart in order, and begin and end with such a cell but for
  whole blocks; with a wide gap there is one, from the first cell to the last.
*/
static void test_runs_contain_the_contact(void **state)
{
  const PetscInt n[2] = {203, 7}, some[] = {SAM_RUN_GAP, 203};
  SamGrid        grid  = NewGridOn(PETSC_COMM_WORLD, (int)n[0], (int)n[1], 1, 1, 0, 0);
  Vec            field = NewField(grid, 1), shear = NewField(grid, 2);
  double        *b, *q;
  SamRuns        runs;

  (void)state;
  sam_call(VecGetArray(field, &b));
  sam_call(VecGetArray(shear, &q));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscInt row = grid->row_start + j;

    for (PetscInt i = 0; i < n[0] && row > 0; i++) b[j * n[0] + i] = (i * i + 31 * row) % 97 < row ? 1 : 0;
  }
  if (grid->rows) q[grid->cells + 150] = -1; /* along y alone */
  for (int with = 0; with < 2; with++)
    for (int k = 0; k < 2; k++) {
      int apart = 1, within = 1, all = 1, narrow = 1;

      sam_call(SamRunsCreate(grid, b, with ? q : NULL, some[k], &runs));
      for (PetscInt j = 0; j < grid->rows; j++) {
        PetscInt count = 0, inside = 0;

        for (PetscInt i = 0; i < n[0]; i++) count += b[j * n[0] + i] > 0 || (with && j == 0 && i == 150);
        for (PetscInt r = runs.start[j]; r < runs.start[j + 1]; r++) {
          const PetscInt *span = runs.span[r];

          apart &= r == runs.start[j] || span[0] > runs.span[r - 1][1];
          within &= span[0] >= 0 && span[0] < span[1] && span[1] <= n[0];
          for (PetscInt i = span[0]; i < span[1]; i++) inside += b[j * n[0] + i] > 0 || (with && j == 0 && i == 150);
          if (runs.start[j + 1] - runs.start[j] > 1)
            narrow &= span[0] % SAM_RUN_GAP == 0 && (span[1] % SAM_RUN_GAP == 0 || span[1] == n[0]);
        }
        all &= inside == count;
        narrow &= k == 0 || runs.start[j + 1] - runs.start[j] == (count > 0);
      }
      sam_assert(apart && within && all && narrow);
      sam_call(SamRunsDestroy(&runs));
    }
  sam_call(VecRestoreArray(field, &b));
  sam_call(VecRestoreArray(shear, &q));
  sam_destroy(&field, &shear);
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_normal_projection_is_the_nearest_admissible_pressure),
    cmocka_unit_test(test_tangential_projection_is_the_nearest_admissible_shear),
    cmocka_unit_test(test_weighted_projection_is_the_nearest_shear_in_its_metric),
    cmocka_unit_test(test_cells_of_weight_0_keep_their_shear),
    cmocka_unit_test(test_normal_projection_keeps_to_its_mask),
    cmocka_unit_test(test_impossible_normal_loads_are_found),
    cmocka_unit_test(test_a_shear_with_nan_is_not_projected),
    cmocka_unit_test(test_force_alone_slides_at_the_sum_of_the_bound),
    cmocka_unit_test(test_torque_alone_slides_at_two_thirds_of_a_uniform_disc),
    cmocka_unit_test(test_combined_limit_lies_between_line_and_rectangle),
    cmocka_unit_test(test_loads_are_feasible_below_the_limit_and_not_above),
    cmocka_unit_test(test_sliding_shear_carries_the_limit_of_the_loads),
    cmocka_unit_test(test_lever_must_lie_among_the_cell_centres),
    cmocka_unit_test(test_loads_are_conjugate_to_displacements),
    cmocka_unit_test(test_runs_contain_the_contact),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

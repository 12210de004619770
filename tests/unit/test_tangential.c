/* The tangential solver: Cattaneo and Mindlin's contact, the conditions of stick and slip, symmetries, control. */
#include "tangentials.h"
#include "methods/methods.h"

#include <petsam/private/tangentialimpl.h>

/* ---- Cattaneo and Mindlin ---- */

/* mu p0 (sqrt(1 - r^2/a^2) - (c/a) sqrt(1 - r^2/c^2)), T = ratio mu N. */
static double Cattaneo(const Sphere *s, double ratio, double r)
{
  const double c = s->a * cbrt(1 - ratio);

  return mu * (Hertz(s, r) - (r < c ? s->p0 * c / s->a * sqrt(1 - r * r / (c * c)) : 0));
}

/* |q - exact|/|exact|, exact in x alone: Cattaneo at `first`, less twice that of half the way to `second`. */
static double CattaneoError(const Case *c, double first, double second, Vec q)
{
  const SamGrid grid  = c->s.grid;
  Vec           exact = NewField(grid, 2);
  double       *a, error;

  sam_call(VecGetArray(exact, &a));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const double r = hypot(SamGridX(grid, i), SamGridY(grid, grid->row_start + j));

      a[j * grid->nx + i] =
        Cattaneo(&c->s, first, r) - (second < first ? 2 * Cattaneo(&c->s, (first - second) / 2, r) : 0);
    }
  sam_call(VecRestoreArray(exact, &a));
  error = Difference(q, exact, NORM_2);
  sam_call(VecDestroy(&exact));
  return error;
}

static void test_cattaneo_mindlin_at_zero_poisson_ratio(void **state)
{
  const double ratio[3]     = {0.3, 0.6, 0.9},
               tolerance[3] = {3e-2, 2.5e-2, 1e-2}; /* 1.7, 0.7 and 0.5 % as a prototype measured */
  Case c                    = NewCase(128, 0);
  Vec  q                    = NewField(c.s.grid, 2);

  (void)state;
  for (int k = 0; k < 3; k++) {
    SamBalance balance = Loaded(&c, ratio[k], 0, 0);
    double     expected, error;

    SolveWell(&c, NULL, NULL, 0, &balance, q);
    error = CattaneoError(&c, ratio[k], ratio[k], q);
    if (getenv("SAM_SHOW")) print_message("# Cattaneo T %g: %g\n", ratio[k], error);
    sam_assert(error < tolerance[k]);
    /*
      Mindlin: d_x = d_0 (1 - (1 - T/mu N)^(2/3)); at nu = 0 shear meets the stiffness of pressure, and d_0 = mu a^2/R
    */
    expected = 0.75 * c.T / (c.s.a * c.s.pair->modulus) * (1 - pow(1 - ratio[k], 2.0 / 3));
    if (getenv("SAM_SHOW")) print_message("# d_x/Mindlin %g\n", balance.rigid[0] / expected);
    sam_assert_close(balance.rigid[0], expected, 0.01 * expected); /* of the order of the error of q */
  }
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

/* Unloading (Mindlin and Deresiewicz): a reversed solution of half the change, twice as strong, on top of the first. */
static void test_unloading_leaves_reversed_slip(void **state)
{
  Case       c     = NewCase(128, 0);
  SamBalance first = Loaded(&c, 0.8, 0, 0), second = Loaded(&c, 0.1, 0, 0);
  Vec        q = NewField(c.s.grid, 2), offset;
  double     error;

  (void)state;
  SolveWell(&c, NULL, NULL, 0, &first, q);
  offset = Slip(&c, &first, q);
  sam_call(VecScale(offset, -1));
  SolveWell(&c, offset, NULL, 0, &second, q);
  error = CattaneoError(&c, 0.8, 0.1, q);
  if (getenv("SAM_SHOW")) print_message("# unloading %g\n", error);
  sam_assert(error < 5e-2); /* two solutions with 1 and 2 %, whose difference is smaller than either */
  sam_destroy(&offset, &q);
  DestroyCase(&c);
}

/* ---- the conditions of the problem ---- */

static void test_stick_slip_cone_and_equilibrium_hold(void **state)
{
  const double loads[][3] = {{0.5, 0, 0}, {0.95, 0, 0}, {0, 0, 0.6}, {0, 0, 0.95}, {0.4, 0.3, 0.4}, {-0.2, 0.6, -0.3}};
  Case         c          = NewCase(63, 0.3);
  Vec          q          = NewField(c.s.grid, 2);

  (void)state;
  for (size_t k = 0; k < sizeof(loads) / sizeof(loads[0]); k++) {
    const SamBalance given   = Loaded(&c, loads[k][0], loads[k][1], loads[k][2]);
    SamBalance       balance = given;

    SolveWell(&c, NULL, NULL, 0, &balance, q);
    AssertConditions(&c, NULL, &balance, &given, q);
  }
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

static void test_force_and_displacement_control_agree(void **state)
{
  Case       c     = NewCase(45, 0.3);
  SamBalance given = Loaded(&c, 0.5, 0.2, 0.3), found = given;
  Vec        q = NewField(c.s.grid, 2), other = NewField(c.s.grid, 2);

  (void)state;
  SolveWell(&c, NULL, NULL, 1e-8, &found, q);
  for (int mask = 0; mask < 7; mask++) { /* bit k: component k stays under force control */
    SamBalance mixed = found;

    for (int k = 0; k < 3; k++) {
      mixed.force[k] = mask & (1 << k) ? PETSC_TRUE : PETSC_FALSE;
      if (mixed.force[k])
        mixed.rigid[k] = NAN; /* what is a result must not be read */
      else
        mixed.load[k] = NAN;
    }
    SolveWell(&c, NULL, NULL, 1e-8, &mixed, other);
    sam_assert_close(Difference(other, q, NORM_2), 0, 1e-5); /* two solutions to 1e-8 times the condition, about n */
    for (int k = 0; k < 3; k++) sam_assert_close(mixed.load[k], given.load[k], 1e-5 * c.T * (k == 2 ? c.s.a : 1));
  }
  sam_destroy(&q, &other);
  DestroyCase(&c);
}

/* ---- methods ---- */

static void test_both_types_agree(void **state)
{
  const double loads[][3] = {{0.6, 0, 0}, {0, 0, 0.7}, {0.3, 0.4, -0.3}, {0.9, 0, 0}};

  (void)state;
  for (int k = 0; k < 4; k++) {
    Case       c      = NewCase(k == 1 ? 48 : 33, 0.3);
    SamBalance newton = Loaded(&c, loads[k][0], loads[k][1], loads[k][2]), gradient = newton;
    Vec        q = NewField(c.s.grid, 2), other = NewField(c.s.grid, 2);

    SolveWell(&c, NULL, SAM_TANGENTIAL_NEWTON, 0, &newton, q);
    SolveWell(&c, NULL, SAM_TANGENTIAL_GRADIENT, 0, &gradient, other);
    sam_assert_close(Difference(q, other, NORM_2), 0, 1e-4); /* rtol 1e-6 times the condition, about n */
    for (int i = 0; i < 3; i++)
      sam_assert_close(newton.rigid[i], gradient.rigid[i],
                       1e-4 * c.T / (c.s.a * c.s.pair->modulus) / (i == 2 ? c.s.a : 1));
    sam_destroy(&q, &other);
    DestroyCase(&c);
  }
}

static void test_combined_loads_need_few_products(void **state)
{
  Case c = NewCase(128, 0.3);
  Vec  q = NewField(c.s.grid, 2);

  (void)state;
  for (int k = 0; k < 2; k++) {
    SamBalance balance = k ? Loaded(&c, 0.6, 0.5, 0.3) : Loaded(&c, 0.4, 0.3, 0.4);

    sam_assert(SolveWell(&c, NULL, NULL, 0, &balance, q).applies <=
               60); /* 22 to 54 as a prototype measured at 256 and 512 */
  }
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

/* ---- symmetries ---- */

static void test_load_along_y_gives_the_transposed_solution(void **state)
{
  const PetscInt n = 41;
  Case           c = NewCase(n, 0.3);
  SamBalance     x = Loaded(&c, 0.7, 0, 0), y = Loaded(&c, 0, 0.7, 0);
  Vec            qx = NewField(c.s.grid, 2), qy = NewField(c.s.grid, 2);
  double        *a, *b;

  (void)state;
  SolveWell(&c, NULL, NULL, 1e-8, &x, qx);
  SolveWell(&c, NULL, NULL, 1e-8, &y, qy);
  a = Whole(c.s.grid, 2, qx);
  b = Whole(c.s.grid, 2, qy);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      b[j * n + i]         = a[n * n + i * n + j];
      b[n * n + j * n + i] = a[i * n + j];
    }
  SetWhole(c.s.grid, 2, b, qx);
  sam_assert_close(Difference(qy, qx, NORM_2), 0, 1e-5); /* two solutions to 1e-8 times the condition, about n */
  sam_assert_close(y.rigid[1], x.rigid[0], 1e-6 * x.rigid[0]);
  free(a);
  free(b);
  sam_destroy(&qx, &qy);
  DestroyCase(&c);
}

static void test_reversed_load_gives_the_reversed_solution(void **state)
{
  Case       c     = NewCase(41, 0.3);
  SamBalance there = Loaded(&c, 0.4, -0.3, 0.4), back = Loaded(&c, -0.4, 0.3, -0.4);
  Vec        q = NewField(c.s.grid, 2), r = NewField(c.s.grid, 2);

  (void)state;
  SolveWell(&c, NULL, NULL, 0, &there, q);
  SolveWell(&c, NULL, NULL, 0, &back, r);
  sam_call(VecScale(r, -1));
  sam_assert_close(Difference(q, r, NORM_2), 0, 1e-9); /* the same numbers with another sign, but for rounding */
  sam_destroy(&q, &r);
  DestroyCase(&c);
}

static void test_torque_alone_turns_the_shear_about_the_centre(void **state)
{
  Case       c       = NewCase(40, 0.3);
  SamBalance balance = Loaded(&c, 0, 0, 0.5);
  Vec        q       = NewField(c.s.grid, 2);
  double    *a, error = 0, most;

  (void)state;
  SolveWell(&c, NULL, NULL, 1e-8, &balance, q);
  most = Norm(q, NORM_INFINITY);
  a    = Whole(c.s.grid, 2, q);
  /* a quarter turn maps (q_x, q_y) at (x, y) to (-q_y, q_x) at (-y, x) */
  for (PetscInt j = 0; j < 40; j++)
    for (PetscInt i = 0; i < 40; i++)
      error = fmax(error, fmax(fabs(a[i * 40 + 39 - j] + a[1600 + j * 40 + i]),
                               fabs(a[1600 + i * 40 + 39 - j] - a[j * 40 + i])));
  sam_assert_close(error, 0, 1e-5 * most); /* as above, in one cell */
  sam_assert_close(hypot(balance.rigid[0], balance.rigid[1]), 0, 1e-6 * balance.rigid[2] * c.s.a);
  free(a);
  sam_call(VecDestroy(&q));
  DestroyCase(&c);
}

/* ---- history ---- */

static void test_same_load_again_changes_nothing(void **state)
{
  Case       c     = NewCase(41, 0.3);
  SamBalance first = Loaded(&c, 0.5, 0.2, 0.3), second = Loaded(&c, 0.5, 0.2, 0.3);
  Vec        q = NewField(c.s.grid, 2), r = NewField(c.s.grid, 2), offset;

  (void)state;
  SolveWell(&c, NULL, NULL, 1e-8, &first, q);
  offset = Slip(&c, &first, q);
  sam_call(VecScale(offset, -1));
  SolveWell(&c, offset, NULL, 1e-8, &second, r);
  sam_assert_close(Difference(r, q, NORM_2), 0, 1e-5); /* as above */
  for (int k = 0; k < 3; k++)
    sam_assert_close(second.rigid[k], first.rigid[k], 1e-5 * c.T / (c.s.a * c.s.pair->modulus) / (k == 2 ? c.s.a : 1));
  sam_destroy(&offset, &q, &r);
  DestroyCase(&c);
}

/* A rigid offset is a rigid displacement. */
static void test_rigid_offset_moves_the_bodies_alone(void **state)
{
  Case       c     = NewCase(33, 0.3);
  SamBalance plain = Loaded(&c, 0.5, 0, 0.2), moved = plain;
  Vec        q = NewField(c.s.grid, 2), r = NewField(c.s.grid, 2), offset = NewField(c.s.grid, 2);
  SamBalance shift = {.kind = SAM_BALANCE_TANGENTIAL, .rigid = {-1e-6, 2e-6, 1e-3}};

  (void)state;
  sam_call(VecDestroy(&offset));
  offset = Slip(&c, &shift, q); /* of q = 0: minus the rigid displacement */
  SolveWell(&c, NULL, NULL, 1e-8, &plain, q);
  SolveWell(&c, offset, NULL, 1e-8, &moved, r);
  sam_assert_close(Difference(r, q, NORM_2), 0, 1e-5); /* as above */
  for (int k = 0; k < 3; k++)
    sam_assert_close(moved.rigid[k] + shift.rigid[k], plain.rigid[k], 1e-5 * fabs(shift.rigid[k]));
  sam_destroy(&offset, &q, &r);
  DestroyCase(&c);
}

/* A smaller bound with a smaller edge: `less` of its largest value is taken off. */
static Vec Shrunk(const Case *c, double less)
{
  Vec            bound = Copy(c->bound);
  const double   most  = Norm(bound, NORM_INFINITY);
  const PetscInt cells = c->s.grid->cells;
  double        *b;

  sam_call(VecGetArray(bound, &b));
  for (PetscInt k = 0; k < cells; k++) b[k] = fmax(0, b[k] - less * most);
  sam_call(VecRestoreArray(bound, &b));
  return bound;
}

/* The shear where there is no bound. */
static double ShearOutside(const Case *c, Vec bound, Vec q)
{
  const PetscInt cells = c->s.grid->cells;
  const double  *b, *t;
  PetscReal      most = 0;

  sam_call(VecGetArrayRead(bound, &b));
  sam_call(VecGetArrayRead(q, &t));
  for (PetscInt k = 0; k < cells; k++)
    if (b[k] == 0) most = fmax(most, hypot(t[k], t[k + cells]));
  sam_call(VecRestoreArrayRead(q, &t));
  sam_call(VecRestoreArrayRead(bound, &b));
  sam_call(SamMax(c->s.grid->comm, 1, &most));
  return most;
}

/* How far a product is from that with the shear, relative to it, where it is known. */
static double ProductError(const Case *c, const SamProduct *product, Vec q)
{
  const SamGrid grid = c->s.grid;
  Vec           u    = NewField(grid, 2);
  const double *known, *is;
  double        most[2] = {0, 0};

  sam_call(SamElasticityApplyTangential(c->s.elasticity, q, u));
  sam_call(VecGetArrayRead(u, &is));
  sam_call(VecGetArrayRead(product->field, &known));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) {
    const PetscInt i = k % grid->nx - product->first[0],
                   j = k % grid->cells / grid->nx + grid->row_start - product->first[1];

    if (i < 0 || i >= product->n[0] || j < 0 || j >= product->n[1]) continue;
    most[0] = fmax(most[0], fabs(known[k] - is[k]));
    most[1] = fmax(most[1], fabs(is[k]));
  }
  sam_call(VecRestoreArrayRead(product->field, &known));
  sam_call(VecRestoreArrayRead(u, &is));
  sam_call(VecDestroy(&u));
  sam_call(SamMax(grid->comm, 2, most));
  return most[0] / most[1];
}

/* As between two passes of dissimilar bodies; `less` is from cells at the edge to nearly all of the contact. */
static void test_start_from_shear_beyond_the_bound_and_its_product(void **state)
{
  static const double less[] = {0.1, 0.5, 0.9, 0.98};
  Case                c      = NewCase(67, 0.3);

  (void)state;
  for (int k = 0; k < 4; k++) {
    Vec           bound = Shrunk(&c, less[k]), q = NewField(c.s.grid, 2), r = NewField(c.s.grid, 2);
    const double  T     = 0.3 * Sum(bound) * c.s.grid->dx * c.s.grid->dy;
    SamBalance    first = Loaded(&c, 0.6, 0.1, 0.3), next = first, cold;
    SamProduct    product = {.field = NewField(c.s.grid, 2)};
    SamTangential t;

    next.load[0] = T;
    next.load[1] = 0.1 * T;
    next.load[2] = 0;
    cold         = next;
    sam_assert(Solve(&c, bound, NULL, NULL, 1e-7, &cold, r).reason == SAM_SOLVER_CONVERGED_RTOL);
    sam_call(SamTangentialCreate(c.s.elasticity, &t));
    sam_call(SamTangentialSolveKeeping(t, c.bound, NULL, &first, PETSC_FALSE, q, &product));
    sam_assert(product.n[0] > 0);
    sam_call(SamSolverSetTolerances(SamTangentialAsSolver(t), 1e-7, PETSC_DEFAULT));
    sam_call(SamTangentialSolveKeeping(t, bound, NULL, &next, PETSC_TRUE, q, &product));
    sam_assert_close(ShearOutside(&c, bound, q), 0, 0);
    sam_assert_close(ProductError(&c, &product, q), 0, 1e-4);
    sam_assert_close(Difference(q, r, NORM_2), 0, 1e-4);
    sam_assert_close(next.rigid[0], cold.rigid[0], 1e-4 * cold.rigid[0]);
    sam_call(SamTangentialDestroy(&t));
    sam_destroy(&product.field, &bound, &q, &r);
  }
  DestroyCase(&c);
}

/*
  Two strips of the contact, far apart: a product is kept in the cells between them, too, into which contact may grow,
  and what the preconditioner leaves there does not count.
*/
static void test_strips_far_apart(void **state)
{
  Case          c     = NewCase(320, 0.3);
  const SamGrid grid  = c.s.grid;
  Vec           bound = Copy(c.bound), q = NewField(grid, 2);
  SamProduct    product = {.field = NewField(grid, 2)};
  SamBalance    loads;
  SamTangential t;
  PetscInt      iterations;
  double       *b, T;

  (void)state;
  sam_call(VecGetArray(bound, &b));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (fabs(SamGridX(grid, k % grid->nx)) < 0.8 * c.s.a) b[k] = 0;
  sam_call(VecRestoreArray(bound, &b));
  T     = 0.3 * Sum(bound) * grid->dx * grid->dy;
  loads = Loaded(&c, 0, 0, 0);
  sam_call(SamTangentialCreate(c.s.elasticity, &t));
  for (int k = 0; k < 3; k++) {
    loads.load[0] = (0.6 - 0.2 * k) * T;
    loads.load[1] = 0.2 * k * T;
    sam_call(SamTangentialSolveKeeping(t, bound, NULL, &loads, k > 0, q, &product));
    sam_assert(product.n[0] > 0);
    sam_assert_close(ProductError(&c, &product, q), 0, 1e-5);
    sam_call(SamSolverGetStatistics(SamTangentialAsSolver(t), NULL, &iterations, NULL, NULL));
    sam_assert(iterations < 25); /* 10 to 14; 60 to 170 with what is left */
    sam_call(VecScale(bound, 0.95));
  }
  sam_call(SamTangentialDestroy(&t));
  sam_destroy(&product.field, &bound, &q);
  DestroyCase(&c);
}

static PetscBool knows; /* whether the last start of Notice() came with its product */

/* A method that takes the start for the solution. */
static PetscErrorCode Notice(SamSolver solver, SamLevel *level)
{
  PetscFunctionBegin;
  knows          = SamLevelHasProduct(level);
  solver->reason = SAM_SOLVER_CONVERGED_RTOL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateNotice(SamSolver solver)
{
  PetscFunctionBegin;
  solver->ops.solve     = Notice;
  solver->keeps_product = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A bound so small that its window cuts some of the shear off. */
static void test_product_of_shear_that_is_cut_off_is_forgotten(void **state)
{
  Case          c      = NewCase(67, 0.3);
  Vec           nearly = Shrunk(&c, 0.1), small = Shrunk(&c, 0.95), q = NewField(c.s.grid, 2);
  SamBalance    loaded = Loaded(&c, 0.6, 0, 0), same = loaded, little = Loaded(&c, 1e-5, 0, 0);
  SamProduct    product = {.field = NewField(c.s.grid, 2)};
  SamTangential t;

  (void)state;
  sam_call(SamTangentialRegister("notice", CreateNotice));
  sam_call(SamTangentialCreate(c.s.elasticity, &t));
  sam_call(SamTangentialSolveKeeping(t, c.bound, NULL, &loaded, PETSC_FALSE, q, &product));
  sam_call(SamSolverSetType(SamTangentialAsSolver(t), "notice"));
  sam_call(SamTangentialSolveKeeping(t, nearly, NULL, &same, PETSC_TRUE, q, &product));
  sam_assert(knows);
  sam_call(SamTangentialSolveKeeping(t, small, NULL, &little, PETSC_TRUE, q, &product));
  sam_assert(!knows);
  sam_call(SamTangentialDestroy(&t));
  sam_destroy(&product.field, &nearly, &small, &q);
  DestroyCase(&c);
}

/* Where the bodies stick to where they were, shear remains without any load. */
static void test_offset_alone_leaves_shear_that_carries_no_load(void **state)
{
  Case             c      = NewCase(33, 0.3);
  SamBalance       loaded = Loaded(&c, 0.9, 0, 0.2), free = Loaded(&c, 0, 0, 0);
  const SamBalance given = free;
  Vec              q = NewField(c.s.grid, 2), r = NewField(c.s.grid, 2), offset;

  (void)state;
  SolveWell(&c, NULL, NULL, 1e-8, &loaded, q);
  offset = Slip(&c, &loaded, q);
  sam_call(VecScale(offset, -1));
  SolveWell(&c, offset, NULL, 1e-8, &free, r);
  sam_assert(Norm(r, NORM_2) > 0.1 * Norm(q, NORM_2));
  AssertConditions(&c, offset, &free, &given, r);
  sam_destroy(&offset, &q, &r);
  DestroyCase(&c);
}

/*
  Cells around the contact get a small bound, and begin without shear, as those that a coarse grid leaves: their slip is
  many times what their bound could prevent. The solution is that without them, nearly, and as near as before.
*/
static void test_cells_that_cannot_stick_do_not_hold_up_the_others(void **state)
{
  Case          c       = NewCase(150, 0.3);
  const SamGrid grid    = c.s.grid;
  SamBalance    balance = Loaded(&c, 0.6, 0, 0), again;
  const double  most    = Norm(c.bound, NORM_INFINITY);
  Vec           q       = NewField(grid, 2), start;
  SamTangential t;
  PetscReal     error;
  PetscInt      iterations, added = 0;
  double       *b;

  (void)state;
  SolveWell(&c, NULL, NULL, 0, &balance, q);
  sam_call(VecGetArray(c.bound, &b));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const double r = hypot(SamGridX(grid, i), SamGridY(grid, grid->row_start + j));

      if (b[j * grid->nx + i] > 0 || r > c.s.a + 2 * (double)grid->dx) continue;
      b[j * grid->nx + i] = 2e-3 * most;
      added++;
    }
  sam_call(VecRestoreArray(c.bound, &b));
  start = Copy(q);
  again = balance;
  sam_call(SamTangentialCreate(c.s.elasticity, &t));
  sam_call(SamTangentialSolve(t, c.bound, NULL, &again, PETSC_TRUE, q));
  sam_call(SamSolverGetStatistics(SamTangentialAsSolver(t), &error, &iterations, NULL, NULL));
  if (getenv("SAM_SHOW")) print_message("# cells %d its %d error %g\n", (int)added, (int)iterations, error);
  sam_assert(SamSolverGetReason(SamTangentialAsSolver(t)) == SAM_SOLVER_CONVERGED_RTOL);
  sam_assert(iterations <= 12); /* 17 if such cells count as sticking */
  AssertConditions(&c, NULL, &again, &balance, q);
  sam_assert(Difference(q, start, NORM_2) < 1e-2);
  sam_assert(fabs(again.rigid[0] - balance.rigid[0]) < 1e-3 * fabs(balance.rigid[0]));
  sam_call(SamTangentialDestroy(&t));
  sam_destroy(&start, &q);
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_cattaneo_mindlin_at_zero_poisson_ratio),
    cmocka_unit_test(test_unloading_leaves_reversed_slip),
    cmocka_unit_test(test_stick_slip_cone_and_equilibrium_hold),
    cmocka_unit_test(test_force_and_displacement_control_agree),
    cmocka_unit_test(test_both_types_agree),
    cmocka_unit_test(test_combined_loads_need_few_products),
    cmocka_unit_test(test_load_along_y_gives_the_transposed_solution),
    cmocka_unit_test(test_reversed_load_gives_the_reversed_solution),
    cmocka_unit_test(test_torque_alone_turns_the_shear_about_the_centre),
    cmocka_unit_test(test_same_load_again_changes_nothing),
    cmocka_unit_test(test_rigid_offset_moves_the_bodies_alone),
    cmocka_unit_test(test_start_from_shear_beyond_the_bound_and_its_product),
    cmocka_unit_test(test_strips_far_apart),
    cmocka_unit_test(test_product_of_shear_that_is_cut_off_is_forgotten),
    cmocka_unit_test(test_offset_alone_leaves_shear_that_carries_no_load),
    cmocka_unit_test(test_cells_that_cannot_stick_do_not_hold_up_the_others),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

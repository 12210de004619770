/* Wear that follows every step: laws, conservation, the gap, a sphere that slides under constant load. */
#include "contacts.h"

#include <petsam/private/solutionimpl.h>
#include <petsam/wear.h>

#define ARCHARD 1e-14 /* 1/Pa */

static const PetscReal both[2] = {0.7 * ARCHARD, 0.3 * ARCHARD};

static const SamLawType types[] = {SAM_LAW_ARCHARD, SAM_LAW_ENERGY};

static Vec DepthOf(const Case *c, int body)
{
  return NewFieldOf(c, body ? "wear_depth2" : "wear_depth1");
}

/* The separation from which the next step is solved. */
static Vec SeparationOf(const Case *c)
{
  SamState memory;
  Vec      h, copy;

  sam_call(SamContactGetState(c->contact, &memory));
  sam_call(SamSolutionCreateSeparation(c->problem, memory, SAM_COMMITTED, &h));
  copy = Copy(h);
  sam_call(SamSolutionDestroySeparation(c->problem, &h));
  return copy;
}

/* To and fro under constant N; in both directions, so that partial slip has two components. Returns the work. */
static double Strokes(const Case *c, int count)
{
  double work = 0;

  for (int k = 0; k < count; k++) {
    const SamControl control = Loads(c, 1, k % 2 ? -0.8 : 0.8, k % 3 ? 0.2 : -0.2, 0);
    const SamStep    step    = Solve(c, &control);

    AssertGood(&step);
    work += NumberOf(c, "dissipated_energy");
  }
  return work;
}

/* The volume is that of the work of friction: k E/mu for Archard's law, alpha E for that of energy. */
static void test_volume_is_that_of_the_work(void **state)
{
  (void)state;
  for (int law = 0; law < 2; law++) {
    const PetscReal k[2] = {law == 0 ? ARCHARD : ARCHARD / MU, 0};
    Case            c    = NewCase(Steel(), 40, 1.5, MU, "");
    double          work;
    Vec             depth[2];

    AddWear(&c, types[law], k);
    work = Strokes(&c, 5);
    for (int body = 0; body < 2; body++) depth[body] = DepthOf(&c, body);
    sam_assert(work > 0 && NumberOf(&c, "wear_volume2") == 0);
    sam_assert(Norm(depth[0], NORM_INFINITY) > 0 && Norm(depth[1], NORM_INFINITY) == 0);
    sam_assert_close(NumberOf(&c, "wear_volume1") * MU / ARCHARD, work, 1e-5 * work);
    sam_assert_close(Sum(depth[0]) * c.s.grid->dx * c.s.grid->dy, NumberOf(&c, "wear_volume1"), 1e-12 * Sum(depth[0]));
    for (int body = 0; body < 2; body++) sam_call(VecDestroy(&depth[body]));
    DestroyCase(&c);
  }
}

/* Both laws, and either body or both, give the same gap. */
static void test_laws_and_bodies_give_the_same_gap(void **state)
{
  static const struct {
    int       law;
    PetscReal share; /* of body 1 */
  } kinds[] = {{0, 1}, {0, 0}, {0, 0.5}, {1, 1}};
  Vec first = NULL;

  (void)state;
  for (int n = 0; n < 4; n++) {
    const double    rate = ARCHARD * (kinds[n].law == 1 ? 1 / MU : 1) * 1e3;
    const PetscReal k[2] = {rate * kinds[n].share, rate * (1 - kinds[n].share)};
    Case            c    = NewCase(Steel(), 40, 1.5, MU, "");
    Vec             gap;

    AddWear(&c, types[kinds[n].law], k);
    (void)Strokes(&c, 5);
    gap = SeparationOf(&c);
    if (!first) {
      first = Copy(gap);
      sam_assert(Difference(first, c.s.h, NORM_INFINITY) > 1e-4); /* it has worn */
    } else if (n == 3) {
      sam_assert(Difference(gap, first, NORM_INFINITY) < 1e-9);
    } else {
      sam_assert(Difference(gap, first, NORM_INFINITY) < 1e-14);
    }
    sam_call(VecDestroy(&gap));
    DestroyCase(&c);
  }
  sam_call(VecDestroy(&first));
}

static void test_gap_grows_by_both_depths(void **state)
{
  Case c = NewCase(Steel(), 40, 1.5, MU, "");
  Vec  gap, depth[2];

  (void)state;
  AddWear(&c, SAM_LAW_ARCHARD, both);
  (void)Strokes(&c, 3);
  gap = SeparationOf(&c);
  for (int body = 0; body < 2; body++) {
    depth[body] = DepthOf(&c, body);
    sam_call(VecAXPY(gap, -1, depth[body]));
  }
  sam_assert(Difference(gap, c.s.h, NORM_INFINITY) < 1e-14);
  sam_call(VecScale(depth[0], 3. / 7));
  sam_assert(Norm(depth[0], NORM_INFINITY) > 0 && Difference(depth[0], depth[1], NORM_INFINITY) < 1e-14);
  for (int body = 0; body < 2; body++) sam_call(VecDestroy(&depth[body]));
  sam_call(VecDestroy(&gap));
  DestroyCase(&c);
}

/* The depths of a try are known, but its separation is that of the bodies before it; rejected, it leaves no wear. */
static void test_step_wears_when_it_is_committed(void **state)
{
  Case             c = NewCase(Steel(), 40, 1.5, MU, ""), calm = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl first = Loads(&c, 1, 0.6, 0, 0), other = Loads(&c, 1, -0.7, 0.1, 0);
  SamStep          a, b;
  double           volume;
  Vec              worn, gap;

  (void)state;
  AddWear(&c, SAM_LAW_ARCHARD, both);
  AddWear(&calm, SAM_LAW_ARCHARD, both);
  (void)Try(&c, &first);
  volume = NumberOf(&c, "wear_volume1");
  gap    = SeparationOf(&c);
  sam_assert(volume > 0 && SameBits(gap, c.s.h));
  sam_call(SamContactCommit(c.contact));
  (void)Solve(&calm, &first);
  sam_assert(NumberOf(&c, "wear_volume1") == volume);
  worn = SeparationOf(&c);
  sam_assert(!SameBits(worn, c.s.h));
  (void)Try(&c, &other);
  sam_assert(NumberOf(&c, "wear_volume1") > volume);
  sam_call(SamContactReject(c.contact));
  sam_assert(NumberOf(&c, "wear_volume1") == volume);
  sam_call(VecDestroy(&gap));
  gap = SeparationOf(&c);
  sam_assert(SameBits(gap, worn));
  a = Solve(&c, &first);
  b = Solve(&calm, &first);
  AssertSameSteps(&c, &a, &calm, &b);
  AssertSameFields(&c, &calm);
  sam_assert(NumberOf(&c, "normal_applies") > 0); /* the gap has changed */
  sam_destroy(&gap, &worn);
  DestroyCase(&c);
  DestroyCase(&calm);
}

/* Where the surfaces stick nothing is removed, and outside of the contact neither. */
static void test_only_cells_that_slip_wear(void **state)
{
  Case             c         = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl control   = Loads(&c, 1, 0.5, 0, 0);
  double           counts[3] = {0, 0, 0}; /* slipping; worn; worn and not slipping */
  const double    *d, *is;
  SamStep          step;
  Vec              depth, states;

  (void)state;
  AddWear(&c, SAM_LAW_ARCHARD, both);
  step = Solve(&c, &control);
  AssertGood(&step);
  depth  = DepthOf(&c, 0);
  states = NewState(&c);
  sam_call(VecGetArrayRead(depth, &d));
  sam_call(VecGetArrayRead(states, &is));
  for (PetscInt k = 0; k < c.s.grid->cells; k++) {
    counts[0] += is[k] == SAM_CELL_SLIP;
    counts[1] += d[k] > 0;
    counts[2] += d[k] > 0 && is[k] != SAM_CELL_SLIP;
  }
  sam_call(VecRestoreArrayRead(states, &is));
  sam_call(VecRestoreArrayRead(depth, &d));
  (void)MPI_Allreduce(MPI_IN_PLACE, counts, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  sam_assert(counts[0] > 100 && counts[1] == counts[0] && counts[2] == 0);
  sam_destroy(&states, &depth);
  DestroyCase(&c);
}

/* Sliding with a prescribed stroke at vanishing friction: every cell in contact slips by the stroke. */
static SamControl Stroke(const Case *c, double x)
{
  SamControl control = Loads(c, 1, 0, 0, 0);

  Displace(&control, SAM_COMPONENT_TX, x);
  Displace(&control, SAM_COMPONENT_TY, 0);
  Displace(&control, SAM_COMPONENT_MZ, 0);
  return control;
}

/*
  A sphere that slides under constant load: the volume is k N times the path, and its shape that of Archard's law for
  uniform slip, by quadratures of the axisymmetric problem, at tau = 4 k E* u n/a0 = 1.
*/
static void test_sliding_sphere_has_its_volume_and_shape(void **state)
{
  const PetscInt n = 90, strokes = 90;
  Case           c = NewCase(Steel(), n, 1.6, 1e-9, "");
  const double   a = c.s.a, u = 1e-4, k = a / (2 * c.s.pair->modulus * u * strokes); /* a stroke is 2 u */
  const double   d0   = a * a / c.s.R;
  double         path = 0;
  Vec            depth;

  (void)state;
  for (PetscInt s = 0; s <= strokes; s++) {
    const SamControl control = Stroke(&c, s % 2 ? -u : u);
    const SamStep    step    = Solve(&c, &control);

    AssertGood(&step);
    if (!s) AddWear(&c, SAM_LAW_ARCHARD, (const PetscReal[2]){0, k});
    if (s) path += 2 * u;
  }
  depth = DepthOf(&c, 1);
  sam_assert_close(NumberOf(&c, "wear_volume2"), k * c.s.N * path, 1e-6 * NumberOf(&c, "wear_volume2"));
  sam_assert_close(sqrt(NumberOf(&c, "contact_area") / PETSC_PI) / a, 1.305, 0.013);
  sam_assert_close(Norm(depth, NORM_INFINITY) / d0, 0.4891, 0.005);
  sam_assert_close(NumberOf(&c, "pressure_max") / c.s.p0, 0.5875, 0.006);
  sam_call(VecDestroy(&depth));
  DestroyCase(&c);
}

/* The mean of a field with the signs of a checkerboard, in the middle 16 x 16 cells of 48 x 48. */
static double Checkerboard(SamGrid grid, Vec field)
{
  const double *a;
  double        sum = 0;

  sam_call(VecGetArrayRead(field, &a));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt i = k % grid->nx, j = grid->row_start + k / grid->nx;

    if (i >= 16 && i < 32 && j >= 16 && j < 32) sum += (i + j) % 2 ? a[k] : -a[k];
  }
  sam_call(VecRestoreArrayRead(field, &a));
  sam_call(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, grid->comm));
  return sum / 256;
}

/*
  A sphere with a little checkerboard on it slides with `excess` times the wear that a step may have. A step wears by
  the mean of the pressures before and after it, so the checkerboard c of the pressure goes on by c(n+1) = c(n) - 2
  excess (c(n) + c(n-1)) / 2. Returns the square of its growth, the product of both roots.
*/
static double GrowthOf(int law, double excess)
{
  const double    u     = 1e-8;
  const PetscReal mu    = law == 1 ? 1e-6 : 1e-9;
  Case            c     = NewCase(Steel(), 48, 1.5, mu, "");
  const double    limit = 1.16 * (double)(c.s.grid->dx / c.s.pair->modulus) / (2 * u);
  const PetscReal k[2]  = {(PetscReal)(excess * limit * (law == 1 ? 1e6 : 1)), 0};
  double         *a, board[6];
  Vec             gap;

  gap = SamProblemGetGap(c.problem);
  sam_call(VecGetArray(gap, &a));
  for (PetscInt n = 0; n < c.s.grid->cells; n++)
    a[n] += (n % c.s.grid->nx + n / c.s.grid->nx + c.s.grid->row_start) % 2 ? 1e-11 : -1e-11;
  sam_call(VecRestoreArray(gap, &a));
  for (PetscInt s = 0; s <= 5; s++) {
    const SamControl control = Stroke(&c, s % 2 ? -u : u);

    (void)Solve(&c, &control);
    board[s] = Checkerboard(c.s.grid, SolutionOf(&c)->pressure);
    if (s) sam_assert_close(NumberOf(&c, "wear_excess"), excess, 0.02 * excess);
    if (!s) AddWear(&c, types[law], k);
  }
  DestroyCase(&c);
  return (board[4] * board[4] - board[5] * board[3]) / (board[3] * board[3] - board[4] * board[2]);
}

/* It grows from the limit on. */
static void test_pressure_gets_uneven_above_the_limit_and_even_below(void **state)
{
  (void)state;
  for (int law = 0; law < 2; law++) {
    sam_assert_close(GrowthOf(law, 0.8), 0.8, 0.02);
    sam_assert_close(GrowthOf(law, 1.2), 1.2, 0.03);
  }
}

static void test_wear_that_cannot_be_is_refused(void **state)
{
  Case   c = NewCase(Steel(), 20, 1.5, MU, "");
  SamLaw law;

  (void)state;
  for (int type = 0; type < 2; type++) {
    sam_call(SamProblemAddLawOfType(c.problem, types[type], &law));
    for (int body = 0; body < 2; body++) {
      PetscReal k[2] = {1e-14, 1e-14};

      k[body] = -1e-14;
      sam_fails(SamLawSetWear(law, k), PETSC_ERR_ARG_OUTOFRANGE);
      k[body] = INFINITY;
      sam_fails(SamLawSetWear(law, k), PETSC_ERR_ARG_OUTOFRANGE);
    }
  }
  law = SamProblemGetLaw(c.problem, SAM_LAW_COULOMB);
  sam_fails(SamLawSetWear(law, both), PETSC_ERR_ARG_WRONG);
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_volume_is_that_of_the_work),
    cmocka_unit_test(test_laws_and_bodies_give_the_same_gap),
    cmocka_unit_test(test_gap_grows_by_both_depths),
    cmocka_unit_test(test_step_wears_when_it_is_committed),
    cmocka_unit_test(test_only_cells_that_slip_wear),
    cmocka_unit_test(test_sliding_sphere_has_its_volume_and_shape),
    cmocka_unit_test(test_pressure_gets_uneven_above_the_limit_and_even_below),
    cmocka_unit_test(test_wear_that_cannot_be_is_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/* Wear that follows every step: laws, conservation, the gap, a sphere that slides under constant load. */
#include "contacts.h"

#include <petsam/wear.h>

#define ARCHARD 1e-14 /* 1/Pa */

static const PetscReal both[2] = {0.7 * ARCHARD, 0.3 * ARCHARD};

/* A step that wears at once; returns it. */
static SamStep WearStep(const Case *c, SamWear wear, const SamControl *control)
{
  const SamStep step = Try(c, control);

  sam_call(SamWearCountStep(wear));
  sam_call(SamContactCommit(c->contact));
  sam_call(SamWearApply(wear, 1));
  sam_call(SamWearMoveGap(wear));
  return step;
}

static Vec DepthOf(const Case *c, SamWear wear, PetscInt body)
{
  Vec depth;

  sam_call(SamGridCreateVec(c->s.grid, 1, &depth));
  sam_call(SamWearGetDepth(wear, body, depth));
  return depth;
}

/* To and fro under constant N; in both directions, so that partial slip has two components. Returns the work. */
static double Strokes(const Case *c, SamWear wear, int count)
{
  double work = 0;

  for (int k = 0; k < count; k++) {
    const SamControl control = Loads(c, 1, k % 2 ? -0.8 : 0.8, k % 3 ? 0.2 : -0.2, 0);
    const SamStep    step    = WearStep(c, wear, &control);

    AssertGood(&step);
    work += step.dissipated_energy;
  }
  return work;
}

/* The volume is that of the work of friction: k E/mu for Archard's law, alpha E for that of energy. */
static void test_volume_is_that_of_the_work(void **state)
{
  (void)state;
  for (int law = 0; law < 2; law++) {
    const PetscReal k[2] = {law == SAM_WEAR_ARCHARD ? ARCHARD : ARCHARD / MU, 0};
    Case            c    = NewCase(Steel(), 40, 1.5, MU, "");
    PetscReal       volume[2], depth[2];
    double          work;
    SamWear         wear;

    sam_call(SamWearCreate(c.contact, (SamWearLaw)law, k, &wear));
    work = Strokes(&c, wear, 5);
    sam_call(SamWearGetVolumes(wear, volume, depth));
    sam_assert(work > 0 && volume[1] == 0 && depth[1] == 0 && depth[0] > 0);
    sam_assert_close(volume[0] * MU / ARCHARD, work, 1e-5 * work);
    sam_call(SamWearDestroy(&wear));
    DestroyCase(&c);
  }
}

/* Both laws, and either body or both, give the same gap. */
static void test_laws_and_bodies_give_the_same_gap(void **state)
{
  static const struct {
    SamWearLaw law;
    PetscReal  share; /* of body 1 */
  } kinds[] = {{SAM_WEAR_ARCHARD, 1}, {SAM_WEAR_ARCHARD, 0}, {SAM_WEAR_ARCHARD, 0.5}, {SAM_WEAR_ENERGY, 1}};
  Vec first = NULL;

  (void)state;
  for (int n = 0; n < 4; n++) {
    const double    rate = ARCHARD * (kinds[n].law == SAM_WEAR_ENERGY ? 1 / MU : 1) * 1e3;
    const PetscReal k[2] = {rate * kinds[n].share, rate * (1 - kinds[n].share)};
    Case            c    = NewCase(Steel(), 40, 1.5, MU, "");
    Vec             gap;
    SamWear         wear;

    sam_call(SamWearCreate(c.contact, kinds[n].law, k, &wear));
    (void)Strokes(&c, wear, 5);
    sam_call(SamProblemGetGap(c.problem, &gap));
    if (!first) {
      first = Copy(gap);
      sam_assert(Difference(first, c.s.h, NORM_INFINITY) > 1e-4); /* it has worn */
    } else if (n == 3) {
      sam_assert(Difference(gap, first, NORM_INFINITY) < 1e-9);
    } else {
      sam_assert(Difference(gap, first, NORM_INFINITY) < 1e-14);
    }
    sam_call(SamWearDestroy(&wear));
    DestroyCase(&c);
  }
  sam_call(VecDestroy(&first));
}

static void test_gap_grows_by_both_depths(void **state)
{
  Case    c = NewCase(Steel(), 40, 1.5, MU, "");
  Vec     gap, depth[2];
  SamWear wear;

  (void)state;
  sam_call(SamWearCreate(c.contact, SAM_WEAR_ARCHARD, both, &wear));
  (void)Strokes(&c, wear, 3);
  sam_call(SamProblemGetGap(c.problem, &gap));
  for (int body = 0; body < 2; body++) {
    depth[body] = DepthOf(&c, wear, body);
    sam_call(VecAXPY(gap, -1, depth[body]));
  }
  sam_assert(Difference(gap, c.s.h, NORM_INFINITY) < 1e-14);
  sam_call(VecScale(depth[0], 3. / 7));
  sam_assert(Difference(depth[0], depth[1], NORM_INFINITY) < 1e-14);
  for (int body = 0; body < 2; body++) sam_call(VecDestroy(&depth[body]));
  sam_call(SamWearDestroy(&wear));
  DestroyCase(&c);
}

/* Where the surfaces stick nothing is removed, and outside of the contact neither. */
static void test_only_cells_that_slip_wear(void **state)
{
  Case             c         = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl control   = Loads(&c, 1, 0.5, 0, 0);
  const SamStep    step      = Try(&c, &control);
  double           counts[3] = {0, 0, 0}; /* slipping; worn; worn and not slipping */
  const double    *d, *is;
  Vec              depth, states;
  SamWear          wear;

  (void)state;
  AssertGood(&step);
  sam_call(SamWearCreate(c.contact, SAM_WEAR_ARCHARD, both, &wear));
  sam_call(SamWearCountStep(wear));
  sam_call(SamContactCommit(c.contact));
  sam_call(SamWearApply(wear, 1));
  sam_call(SamWearMoveGap(wear));
  depth = DepthOf(&c, wear, 0);
  sam_call(SamGridCreateVec(c.s.grid, 1, &states));
  sam_call(SamContactComputeState(c.contact, states));
  sam_call(VecGetArrayRead(depth, &d));
  sam_call(VecGetArrayRead(states, &is));
  for (PetscInt k = 0; k < c.s.grid->cells; k++) {
    counts[0] += is[k] == SAM_STATE_SLIP;
    counts[1] += d[k] > 0;
    counts[2] += d[k] > 0 && is[k] != SAM_STATE_SLIP;
  }
  sam_call(VecRestoreArrayRead(states, &is));
  sam_call(VecRestoreArrayRead(depth, &d));
  MPI_Allreduce(MPI_IN_PLACE, counts, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  sam_assert(counts[0] > 100 && counts[1] == counts[0] && counts[2] == 0);
  sam_call(VecDestroy(&states));
  sam_call(VecDestroy(&depth));
  sam_call(SamWearDestroy(&wear));
  DestroyCase(&c);
}

/* What is counted and not applied leaves the gap; what is applied three times wears three times as much. */
static void test_wear_of_a_cycle_is_applied_as_often_as_is_asked(void **state)
{
  Case      c = NewCase(Steel(), 40, 1.5, MU, "");
  PetscReal volume[3][2], depth[2];
  SamWear   wear;

  (void)state;
  sam_call(SamWearCreate(c.contact, SAM_WEAR_ARCHARD, both, &wear));
  for (int k = 0; k < 2; k++) {
    const SamControl control = Loads(&c, 1, k ? -0.7 : 0.7, 0, 0);
    const SamStep    step    = Try(&c, &control);

    AssertGood(&step);
    sam_call(SamWearCountStep(wear));
    sam_call(SamContactCommit(c.contact));
  }
  sam_call(SamWearGetVolumes(wear, volume[0], depth));
  sam_call(SamWearApply(wear, 3));
  sam_call(SamWearMoveGap(wear));
  sam_call(SamWearGetVolumes(wear, volume[1], depth));
  sam_call(SamWearApply(wear, 100));
  sam_call(SamWearMoveGap(wear)); /* nothing has been counted since */
  sam_call(SamWearGetVolumes(wear, volume[2], depth));
  sam_assert(volume[0][0] == 0 && volume[1][0] > 0 && volume[2][0] == volume[1][0]);
  sam_call(SamWearDestroy(&wear));
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
  const double   a = c.s.a, u = 1e-4, k = a / (2 * c.s.pair.modulus * u * strokes); /* a stroke is 2 u */
  const double   d0 = a * a / c.s.R;
  PetscReal      volume[2], depth[2], most;
  double         path = 0;
  SamStep        step;
  SamWear        wear;

  (void)state;
  sam_call(SamWearCreate(c.contact, SAM_WEAR_ARCHARD, (const PetscReal[2]){0, k}, &wear));
  for (PetscInt s = 0; s <= strokes; s++) {
    const SamControl control = Stroke(&c, s % 2 ? -u : u);

    if (s) {
      step = WearStep(&c, wear, &control);
      path += 2 * u;
    } else {
      step = Solve(&c, &control);
    }
    AssertGood(&step);
  }
  sam_call(SamWearGetVolumes(wear, volume, depth));
  sam_call(VecMax(SolutionOf(&c)->pressure, NULL, &most));
  sam_assert_close(volume[1], k * c.s.N * path, 1e-6 * volume[1]);
  sam_assert_close(sqrt(step.contact_area / PETSC_PI) / a, 1.305, 0.013);
  sam_assert_close(depth[1] / d0, 0.4891, 0.005);
  sam_assert_close(most / c.s.p0, 0.5875, 0.006);
  sam_call(SamWearDestroy(&wear));
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
static double GrowthOf(SamWearLaw law, double excess)
{
  const double    u     = 1e-8;
  const PetscReal mu    = law == SAM_WEAR_ENERGY ? 1e-6 : 1e-9;
  Case            c     = NewCase(Steel(), 48, 1.5, mu, "");
  const double    limit = 1.16 * (double)(c.s.grid->dx / c.s.pair.modulus) / (2 * u);
  const PetscReal k[2]  = {(PetscReal)(excess * limit * (law == SAM_WEAR_ENERGY ? 1e6 : 1)), 0};
  double         *a, board[6];
  PetscReal       found;
  SamWear         wear;
  Vec             gap;

  sam_call(SamProblemGetGap(c.problem, &gap));
  sam_call(VecGetArray(gap, &a));
  for (PetscInt n = 0; n < c.s.grid->cells; n++)
    a[n] += (n % c.s.grid->nx + n / c.s.grid->nx + c.s.grid->row_start) % 2 ? 1e-11 : -1e-11;
  sam_call(VecRestoreArray(gap, &a));
  sam_call(SamWearCreate(c.contact, law, k, &wear));
  for (PetscInt s = 0; s <= 5; s++) {
    const SamControl control = Stroke(&c, s % 2 ? -u : u);

    if (s)
      (void)WearStep(&c, wear, &control);
    else
      (void)Solve(&c, &control);
    board[s] = Checkerboard(c.s.grid, SolutionOf(&c)->pressure);
    if (s) sam_call(SamWearGetExcess(wear, &found));
    if (s) sam_assert_close(found, excess, 0.02 * excess);
  }
  sam_call(SamWearDestroy(&wear));
  DestroyCase(&c);
  return (board[4] * board[4] - board[5] * board[3]) / (board[3] * board[3] - board[4] * board[2]);
}

/* It grows from the limit on. */
static void test_pressure_gets_uneven_above_the_limit_and_even_below(void **state)
{
  (void)state;
  for (int law = 0; law < 2; law++) {
    sam_assert_close(GrowthOf((SamWearLaw)law, 0.8), 0.8, 0.02);
    sam_assert_close(GrowthOf((SamWearLaw)law, 1.2), 1.2, 0.03);
  }
}

static void test_wear_that_cannot_be_is_refused(void **state)
{
  Case    c = NewCase(Steel(), 20, 1.5, MU, "");
  SamWear wear;

  (void)state;
  for (int body = 0; body < 2; body++) {
    PetscReal k[2] = {1e-14, 1e-14};

    k[body] = -1e-14;
    sam_fails(SamWearCreate(c.contact, SAM_WEAR_ARCHARD, k, &wear), PETSC_ERR_ARG_OUTOFRANGE);
    k[body] = INFINITY;
    sam_fails(SamWearCreate(c.contact, SAM_WEAR_ENERGY, k, &wear), PETSC_ERR_ARG_OUTOFRANGE);
  }
  sam_call(SamWearCreate(c.contact, SAM_WEAR_ARCHARD, both, &wear));
  sam_fails(SamWearCountStep(wear), PETSC_ERR_ORDER);
  sam_call(SamWearDestroy(&wear));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_volume_is_that_of_the_work),
    cmocka_unit_test(test_laws_and_bodies_give_the_same_gap),
    cmocka_unit_test(test_gap_grows_by_both_depths),
    cmocka_unit_test(test_only_cells_that_slip_wear),
    cmocka_unit_test(test_wear_of_a_cycle_is_applied_as_often_as_is_asked),
    cmocka_unit_test(test_sliding_sphere_has_its_volume_and_shape),
    cmocka_unit_test(test_pressure_gets_uneven_above_the_limit_and_even_below),
    cmocka_unit_test(test_wear_that_cannot_be_is_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

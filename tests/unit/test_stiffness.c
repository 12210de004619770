/* The tangent stiffness: closed forms, differences of trials in both directions, symmetry, and what it leaves alone. */
#include "derivatives.h"

/* Steel without Poisson's ratio: then Cattaneo's and Mindlin's solution is exact. */
#define PLAIN NewPair(210e9, 0, 210e9, 0)

/* Of two similar bodies. */
static double NormalStiffness(const Case *c, double young, double poisson)
{
  return young / (1 - poisson * poisson) * c->s.a;
}
static double ShearStiffness(const Case *c, double young, double poisson)
{
  return 4 * c->s.a / (2 - poisson) * young / (2 * (1 + poisson));
}

/* ---- closed forms ---- */

static void test_stuck_contact_is_as_stiff_as_a_bonded_disc(void **state)
{
  Case             c       = NewCase(Steel(), 128, 1.1, MU, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  const double     a = c.s.a, kn = NormalStiffness(&c, 210e9, 0.3), kt = ShearStiffness(&c, 210e9, 0.3),
               shear = 210e9 / 2.6;
  SamStiffness k;

  (void)state;
  (void)Try(&c, &control);
  k = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
  sam_assert(k.converged && k.columns == SAM_COMPONENTS);
  sam_assert_close(k.k[Z][Z] / kn, 1, 3e-3);
  sam_assert_close(k.k[TX][TX] / kt, 1, 3e-3);
  sam_assert_close(k.k[MX][MX] / (2.0 / 3 * kn * a * a), 1, 5e-3);
  sam_assert_close(k.k[MY][MY] / (2.0 / 3 * kn * a * a), 1, 5e-3);
  sam_assert_close(k.k[MZ][MZ] / (8.0 / 3 * a * a * a * shear), 1, 5e-3);
  DestroyCase(&c);
}

/* With t = (1 - T/mu N)^(1/3) the shear stiffness is k t, and dT/dN = mu (1 - t) while N falls. */
static void test_slipping_contact_softens_as_mindlin_has_it(void **state)
{
  Case c = NewCase(PLAIN, 128, 1.1, MU, "");

  (void)state;
  for (PetscInt step = 0; step < 3; step++) {
    const double part = 0.3 + 0.3 * (double)step, t = cbrt(1 - part), kt = ShearStiffness(&c, 210e9, 0),
                 kn           = NormalStiffness(&c, 210e9, 0);
    const SamControl control  = Loads(&c, 1, part, 0, 0);
    const SamStep    solution = Try(&c, &control);
    SamStiffness     k;

    AssertGood(&solution);
    k = Stiffness(&c, SAM_STIFFNESS_FORWARD);
    sam_assert_close(k.k[TX][TX] / (kt * t), 1, 5e-3);
    sam_assert_close(k.k[TX][Z] / kn, MU * (1 - t), 5e-3 * MU);
    sam_assert(k.k[Z][TX] == 0);
    k = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
    sam_assert_close(k.k[TX][TX] / kt, 1, 5e-3);
    sam_assert(k.k[TX][Z] == 0);
  }
  DestroyCase(&c);
}

/* While T falls from T*, the shear stiffness is that of growing by half as much from a stuck state. */
static void test_unloading_softens_half_as_fast(void **state)
{
  Case             c  = NewCase(PLAIN, 128, 1.1, MU, "");
  const SamControl up = Loads(&c, 1, 0.8, 0, 0), down = Loads(&c, 1, -0.2, 0, 0);
  const double     kt = ShearStiffness(&c, 210e9, 0);

  (void)state;
  (void)Solve(&c, &up);
  (void)Try(&c, &down);
  sam_assert_close(Stiffness(&c, SAM_STIFFNESS_FORWARD).k[TX][TX] / (kt * cbrt(1 - 0.5)), 1, 5e-3);
  DestroyCase(&c);
}

/* ---- differences ---- */

/* Some load of all kinds, the solvers being exact enough for differences. */
static Case NewLoaded(SamPair pair, PetscReal rigid[SAM_COMPONENTS])
{
  Case       c       = NewCase(pair, 48, 1.4, MU, "-normal_rtol 1e-11 -tangential_rtol 1e-10 -coupling_rtol 1e-10");
  SamControl control = Loads(&c, 1, 0.5, -0.2, 0.15);
  SamStep    step;

  control.value[MX] = 0.05 * c.s.N * c.s.a;
  control.value[MY] = -0.1 * c.s.N * c.s.a;
  step              = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_CONVERGED);
  memcpy(rigid, step.rigid, sizeof(step.rigid));
  return c;
}

static void CheckAgainstDifferences(SamPair pair, double limit)
{
  PetscReal rigid[SAM_COMPONENTS];
  Case      c = NewLoaded(pair, rigid);
  double    small, twice;

  const SamStiffness k = Stiffness(&c, SAM_STIFFNESS_FORWARD);

  small = ErrorOf(&c, &k, rigid, 1e-5);
  twice = ErrorOf(&c, &k, rigid, 1e-2);
  if (getenv("SAM_SHOW")) print_message("# differences %g, of larger steps %g\n", small, twice);
  sam_assert(small < limit);
  sam_assert(twice > 2 * small); /* what is left is the step's */
  DestroyCase(&c);
}

static void test_all_entries_are_derivatives_of_trials(void **state)
{
  (void)state;
  CheckAgainstDifferences(Steel(), 1e-4);
}

static void test_all_entries_of_dissimilar_bodies_are_derivatives_of_trials(void **state)
{
  (void)state;
  CheckAgainstDifferences(Dissimilar(), 1e-4);
}

/* Each motion backwards from the committed step, by little: all cells stick. */
static void test_reversal_is_the_derivative_of_a_step_back(void **state)
{
  PetscReal    rigid[SAM_COMPONENTS];
  Case         c = NewLoaded(Steel(), rigid);
  SamStiffness k = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
  SamControl   control;
  const double step = 1e-4 * c.s.a * c.s.a / c.s.R;
  SamStep      base, back;

  (void)state;
  sam_call(SamControlInitialize(&control));
  for (PetscInt i = 0; i < SAM_COMPONENTS; i++) Displace(&control, (SamComponent)i, rigid[i]);
  base = Solve(&c, &control);
  control.value[TX] -= step;
  back = Try(&c, &control);
  sam_assert_close((base.load[TX] - back.load[TX]) / step / k.k[TX][TX], 1, 2e-3);
  control.value[TX] += step;
  control.value[Z] += step; /* a growing normal force sticks, too */
  back = Try(&c, &control);
  sam_assert_close((back.load[Z] - base.load[Z]) / step / k.k[Z][Z], 1, 2e-3);
  sam_assert_close((back.load[TX] - base.load[TX]) / step / k.k[Z][Z], 0, 2e-3);
  DestroyCase(&c);
}

/* ---- by elimination ---- */

/* x from the symmetric A x = b of order n, by Gauss; A and b are overwritten. */
static void Eliminate(int n, double A[], double b[])
{
  for (int k = 0; k < n; k++)
    for (int i = k + 1; i < n; i++) {
      const double part = A[i * n + k] / A[k * n + k];

      for (int j = k; j < n; j++) A[i * n + j] -= part * A[k * n + j];
      b[i] -= part * b[k];
    }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) b[k] -= A[k * n + j] * b[j];
    b[k] /= A[k * n + k];
  }
}

/* The systems are solved to 1e-4, and symmetric entries are right to the square of that. */
static void test_normal_stiffness_is_that_of_the_whole_matrix(void **state)
{
  Case             c       = NewCase(Steel(), 20, 1.4, MU, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  const SamGrid    grid    = c.s.grid;
  double          *p, *A, *b, sum = 0;
  int              n = 0, cell[400];

  (void)state;
  (void)Try(&c, &control);
  p = Whole(grid, 1, SolutionOf(&c)->pressure);
  for (int k = 0; k < 400; k++)
    if (p[k] > 0) cell[n++] = k;
  A = (double *)malloc(sizeof(*A) * (size_t)(n * n));
  b = (double *)malloc(sizeof(*b) * (size_t)n);
  for (int i = 0; i < n; i++) {
    Vec     unit = NewField(grid, 1);
    double *u;

    AddAt(grid, 0, cell[i] % 20, cell[i] / 20, 1, unit);
    sam_call(SamElasticityApplyNormal(c.s.elasticity, unit, unit));
    u = Whole(grid, 1, unit);
    for (int j = 0; j < n; j++) A[i * n + j] = u[cell[j]];
    b[i] = 1;
    free(u);
    sam_call(VecDestroy(&unit));
  }
  Eliminate(n, A, b);
  for (int i = 0; i < n; i++) sum += b[i] * grid->dx * grid->dy;
  sam_assert(n > 100);
  sam_assert_close(Stiffness(&c, SAM_STIFFNESS_FORWARD).k[Z][Z] / sum, 1, 1e-8);
  free(A);
  free(b);
  free(p);
  DestroyCase(&c);
}

/* ---- symmetry ---- */

static double Asymmetry(const Case *c, const SamStiffness *k)
{
  double apart = 0, most = 0;

  for (PetscInt i = 0; i < SAM_COMPONENTS; i++)
    for (PetscInt j = 0; j < SAM_COMPONENTS; j++) {
      apart = fmax(apart, fabs(k->k[i][j] - k->k[j][i]) / Unit(c, i) / Unit(c, j));
      most  = fmax(most, fabs(k->k[i][j]) / Unit(c, i) / Unit(c, j));
    }
  return apart / most;
}

static void test_reversal_is_symmetric_and_sliding_on_is_not(void **state)
{
  (void)state;
  for (PetscInt kind = 0; kind < 2; kind++) {
    PetscReal    rigid[SAM_COMPONENTS];
    Case         c = NewLoaded(kind ? Dissimilar() : Steel(), rigid);
    SamStiffness k = Stiffness(&c, SAM_STIFFNESS_REVERSAL);

    sam_assert(Asymmetry(&c, &k) <= 1e-12);
    k = Stiffness(&c, SAM_STIFFNESS_FORWARD);
    sam_assert(Asymmetry(&c, &k) > 1e-2);
    DestroyCase(&c);
  }
}

/* Moments and rotations are about the origin, wherever the grid is: K moves as forces and motions do. */
static void test_stiffness_of_a_contact_beside_the_origin(void **state)
{
  Case         c       = NewCase(Steel(), 40, 1.4, MU, ""), d;
  SamControl   control = Loads(&c, 1, 0.5, 0, 0);
  const double x = 3 * c.s.a, y = -2 * c.s.a;
  SamStiffness k, moved;
  SamStep      step;

  (void)state;
  step = Try(&c, &control);
  AssertGood(&step);
  k                 = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  d                 = NewCaseOn(NewSphereOn(PETSC_COMM_WORLD, Steel(), 40, 1.4, x, y), MU, NULL, "");
  control.value[MX] = -y * control.value[Z];
  control.value[MY] = x * control.value[Z];
  control.value[MZ] = -y * control.value[TX];
  step              = Try(&d, &control);
  AssertGood(&step);
  moved = Stiffness(&d, SAM_STIFFNESS_FORWARD);
  sam_assert_close(moved.k[Z][Z] / k.k[Z][Z], 1, 1e-6);
  sam_assert_close(moved.k[TX][TX] / k.k[TX][TX], 1, 1e-5);
  sam_assert_close(moved.k[MX][Z] / (-y * k.k[Z][Z]), 1, 1e-6);
  sam_assert_close(moved.k[MY][MY] / (k.k[MY][MY] + x * x * k.k[Z][Z]), 1, 1e-6);
  sam_assert_close(moved.k[MZ][TX] / (-y * k.k[TX][TX]), 1, 1e-4);
  DestroyCase(&c);
  DestroyCase(&d);
}

/* ---- what it leaves alone, and what does not exist ---- */

static void test_contact_goes_on_as_if_it_had_not_been_asked(void **state)
{
  Case c = NewCase(Dissimilar(), 44, 1.6, MU, ""), d = NewCase(Dissimilar(), 44, 1.6, MU, "");

  (void)state;
  for (PetscInt k = 1; k <= 3; k++) {
    const SamControl control = Loads(&c, 1, 0.2 * (double)k, 0, 0.05);
    const SamStep    one     = Try(&c, &control);
    SamStep          other;

    (void)Stiffness(&c, SAM_STIFFNESS_FORWARD);
    (void)Stiffness(&c, SAM_STIFFNESS_REVERSAL);
    sam_call(SamContactCommit(c.contact));
    (void)Stiffness(&c, SAM_STIFFNESS_REVERSAL);
    other = Solve(&d, &control);
    AssertSameSteps(&c, &one, &d, &other);
  }
  AssertSameFields(&c, &d);
  DestroyCase(&c);
  DestroyCase(&d);
}

/* Of a committed step the reversal is left, to the last bit that of the tried one; the slip to go on from is not. */
static void test_committed_step_has_the_stiffness_of_its_reversal(void **state)
{
  static const char *const options[] = {"", "-coupling none"};

  (void)state;
  for (PetscInt o = 0; o < 2; o++) {
    Case             c     = NewCase(o ? Steel() : Dissimilar(), 40, 1.6, MU, options[o]);
    const SamControl first = Loads(&c, 1, 0.3, 0, 0.05), then = Loads(&c, 1.2, 0.5, 0, 0);
    SamStiffness     tried, committed, k;
    SamStep          step;

    (void)Try(&c, &first);
    tried = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
    sam_call(SamContactCommit(c.contact));
    committed = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
    sam_assert(!memcmp(tried.k, committed.k, sizeof(tried.k)));
    BeginCatching();
    sam_assert(SamStiffnessCompute(c.contact, SAM_STIFFNESS_FORWARD, 0, NULL, &k) == PETSC_ERR_ORDER);
    EndCatching();
    sam_assert(strstr(CaughtMessage(), "forward stiffness needs the slip"));
    step = Try(&c, &then);
    sam_assert(step.status == SAM_STATUS_CONVERGED);
    k = Stiffness(&c, SAM_STIFFNESS_REVERSAL); /* of the tried one again */
    sam_assert(memcmp(k.k, committed.k, sizeof(k.k)));
    sam_call(SamContactReject(c.contact));
    k = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
    sam_assert(!memcmp(k.k, committed.k, sizeof(k.k)));
    DestroyCase(&c);
  }
}

static void test_same_bits_on_any_number_of_ranks(void **state)
{
  Case             c       = NewCase(Steel(), 45, 1.4, MU, "");
  Case             alone   = NewCaseOn(NewSphereOn(PETSC_COMM_SELF, Steel(), 45, 1.4, 0, 0), MU, NULL, "");
  const SamControl control = Loads(&c, 1, 0.6, 0.2, 0.1);
  SamStiffness     k, one;

  (void)state;
  (void)Try(&c, &control);
  (void)Try(&alone, &control);
  k   = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  one = Stiffness(&alone, SAM_STIFFNESS_FORWARD);
  sam_assert(!memcmp(k.k, one.k, sizeof(k.k)));
  DestroyCase(&c);
  DestroyCase(&alone);
}

static void test_surfaces_apart_have_no_stiffness(void **state)
{
  Case         c       = NewCase(Steel(), 32, 1.4, MU, "");
  SamControl   control = Loads(&c, 0, 0, 0, 0);
  SamStiffness k;

  (void)state;
  sam_fails(SamStiffnessCompute(c.contact, SAM_STIFFNESS_FORWARD, 0, NULL, &k), PETSC_ERR_ORDER);
  sam_fails(SamStiffnessCompute(c.contact, SAM_STIFFNESS_REVERSAL, 0, NULL, &k), PETSC_ERR_ORDER);
  Displace(&control, SAM_COMPONENT_N, -1e-6);
  (void)Try(&c, &control);
  k = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  sam_assert(k.converged);
  for (PetscInt i = 0; i < SAM_COMPONENTS; i++)
    for (PetscInt j = 0; j < SAM_COMPONENTS; j++) sam_assert(k.k[i][j] == 0);
  DestroyCase(&c);
}

/* Without friction there is no shear, and nothing but the pressure resists. */
static void test_without_friction_only_the_pressure_resists(void **state)
{
  Case             c       = NewCase(Steel(), 40, 1.4, 0, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStiffness     k;

  (void)state;
  (void)Try(&c, &control);
  k = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  sam_assert(k.converged && k.k[Z][Z] > 0 && k.k[TX][TX] == 0 && k.k[MZ][MZ] == 0 && k.k[TX][Z] == 0);
  DestroyCase(&c);
}

/* A try that repeats the committed step slips nowhere. */
static void test_held_contact_sticks(void **state)
{
  Case             c       = NewCase(Steel(), 40, 1.4, MU, "");
  const SamControl control = Loads(&c, 1, 0.6, 0.1, 0.1);
  SamStiffness     on, back;

  (void)state;
  (void)Solve(&c, &control);
  (void)Try(&c, &control);
  on   = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  back = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
  sam_assert(!memcmp(on.k, back.k, sizeof(on.k)));
  DestroyCase(&c);
}

/* Surfaces that repeat do not rotate; the others are derivatives of trials. */
static void test_periodic_bodies_have_no_rotations(void **state)
{
  Case         c       = NewPeriodic(Steel(), 40, 2, 1, MU, "-normal_rtol 1e-11 -tangential_rtol 1e-10");
  SamControl   control = Loads(&c, 1, 0.5, 0, 0), moved;
  SamStep      one     = Try(&c, &control), other;
  SamStiffness k;

  (void)state;
  for (PetscInt i = 0; i < SAM_COMPONENT_MX; i++) Displace(&control, (SamComponent)i, one.rigid[i]);
  moved = control;
  moved.value[TX] += 1e-5 * one.rigid[TX];
  other = Try(&c, &moved);
  one   = Try(&c, &control);
  k     = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  sam_assert(k.converged && isnan(k.k[MX][MX]) && isnan(k.k[TX][MZ]) && isnan(k.k[MY][Z]));
  sam_assert_close((other.load[TX] - one.load[TX]) / (moved.value[TX] - control.value[TX]) / k.k[TX][TX], 1, 1e-3);
  DestroyCase(&c);
}

/* In full contact of periodic bodies the approach does not decide the pressure: that stiffness is infinite. */
static void test_full_periodic_contact_has_no_stiffness(void **state)
{
  Case             c       = NewPeriodic(Steel(), 32, 0.1, 1, MU, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStiffness     k;

  (void)state;
  (void)Try(&c, &control);
  k = Stiffness(&c, SAM_STIFFNESS_REVERSAL);
  sam_assert(!k.converged && isnan(k.k[Z][Z]) && isnan(k.k[TX][TX]));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_stuck_contact_is_as_stiff_as_a_bonded_disc),
    cmocka_unit_test(test_slipping_contact_softens_as_mindlin_has_it),
    cmocka_unit_test(test_unloading_softens_half_as_fast),
    cmocka_unit_test(test_all_entries_are_derivatives_of_trials),
    cmocka_unit_test(test_all_entries_of_dissimilar_bodies_are_derivatives_of_trials),
    cmocka_unit_test(test_reversal_is_the_derivative_of_a_step_back),
    cmocka_unit_test(test_normal_stiffness_is_that_of_the_whole_matrix),
    cmocka_unit_test(test_reversal_is_symmetric_and_sliding_on_is_not),
    cmocka_unit_test(test_stiffness_of_a_contact_beside_the_origin),
    cmocka_unit_test(test_contact_goes_on_as_if_it_had_not_been_asked),
    cmocka_unit_test(test_committed_step_has_the_stiffness_of_its_reversal),
    cmocka_unit_test(test_same_bits_on_any_number_of_ranks),
    cmocka_unit_test(test_surfaces_apart_have_no_stiffness),
    cmocka_unit_test(test_without_friction_only_the_pressure_resists),
    cmocka_unit_test(test_held_contact_sticks),
    cmocka_unit_test(test_periodic_bodies_have_no_rotations),
    cmocka_unit_test(test_full_periodic_contact_has_no_stiffness),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Surfaces that yield at a limit of the pressure: the check, the verdict, the depth that stays, other programs.
 */
#include "contacts.h"
#include "embedded.h"

#include <petsam/embed.h>
#include <petsam/private/normalimpl.h> /* to register a method */

/* ---- the check ---- */

#define PART 0.7 /* of Hertz's pressure: the limit */

static void SetLimit(const Case *c, double limit)
{
  SamLaw law;

  sam_call(SamProblemAddLawOfType(c->problem, SAM_LAW_HARDNESS, &law));
  sam_call(SamLawSetHardness(law, limit));
}

static Case NewYielding(SamPair pair, double part, const char *options)
{
  Case c = NewCase(pair, 48, 1.5, MU, options);

  SetLimit(&c, part * c.s.p0);
  return c;
}

/* The errors of a yielded step after a change of one cell at the middle, the edge of the yielded zone, or outside. */
static SamCheck CheckChanged(PetscInt column, double add)
{
  Case             c       = NewYielding(Steel(), PART, "");
  const SamControl control = Loads(&c, 1, 0.3, 0, 0);
  const SamStep    step    = Solve(&c, &control);
  SamSolution      s       = *SolutionOf(&c); /* the fields are the contact's, which is not used again */
  SamCheck         check;

  AssertGood(&step);
  sam_assert(NumberOf(&c, "plastic_cells") > 100 && NumberOf(&c, "plastic_cells") < NumberOf(&c, "contact_cells"));
  AddAt(c.s.grid, 0, column, 24, add * c.s.p0, s.pressure);
  sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_TRUE, NULL, &s, &check));
  DestroyCase(&c);
  return check;
}

static void test_check_finds_pressure_beyond_the_limit(void **state)
{
  (void)state;
  sam_assert(CheckChanged(24, 0).normal < 1.05e-8);
  sam_assert_close(CheckChanged(24, 1e-3).normal, 1e-3 / PART, 1e-9);
}

static void test_check_finds_an_overlap_below_the_limit(void **state)
{
  (void)state;
  sam_assert(CheckChanged(24, -1e-12).normal < 1.05e-8); /* rounding */
  sam_assert(CheckChanged(24, -1e-6).normal > 0.05);
}

/* Surfaces that do not touch under the limit: the pressure of the whole sphere, cut off, and brought nearer. */
static void test_check_finds_a_gap_at_the_limit(void **state)
{
  Case             c       = NewYielding(Steel(), PART, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  SamSolution      s;
  SamCheck         check;

  (void)state;
  (void)Solve(&c, &control);
  s = *SolutionOf(&c);
  s.rigid[SAM_COMPONENT_N] *= 0.5;
  sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_TRUE, NULL, &s, &check));
  sam_assert(check.normal > 0.3);
  sam_call(VecSet(s.pressure, PART * c.s.p0)); /* everywhere: of cells at the limit only the gap counts */
  sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_FALSE, NULL, &s, &check));
  sam_assert(check.normal > 0.1);
  s.rigid[SAM_COMPONENT_N] *= 1e3;
  sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_FALSE, NULL, &s, &check));
  sam_assert(check.normal == 0);
  DestroyCase(&c);
}

/* The gap of a second step is that of the surfaces that the first one has left. */
static void test_check_knows_the_depth_before(void **state)
{
  Case        c     = NewYielding(Steel(), PART, "");
  SamControl  first = Loads(&c, 1, 0, 0, 0), next = Loads(&c, 0.5, 0, 0, 0);
  SamSolution before, s;
  SamCheck    check;
  SamState    memory;
  PetscInt    depth;

  (void)state;
  (void)Solve(&c, &first);
  before = *SolutionOf(&c);
  sam_assert(Try(&c, &next).status == SAM_STATUS_CONVERGED);
  s = *SolutionOf(&c);
  sam_call(SamContactGetState(c.contact, &memory));
  sam_call(SamCheckSolution(c.problem, memory, PETSC_TRUE, PETSC_FALSE, &before, &s, &check));
  sam_assert(check.normal < 1.05e-8);
  sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_FALSE, &before, &s, &check));
  sam_assert(check.normal > 1e-2);
  depth = SamStateFindField(memory, "plastic_depth");
  sam_assert(SamStateGetField(memory, depth, SAM_TRIED) == NULL); /* nothing has yielded in this step */
  DestroyCase(&c);
}

static Vec NewDepth(const Case *c)
{
  return NewFieldOf(c, "plastic_depth");
}

/* In a second step the surfaces yield by the overlap that is left after the first: N in two steps is N in one. */
static void test_depth_grows_by_the_overlap_that_is_left(void **state)
{
  Case             one = NewYielding(Steel(), PART, ""), two = NewYielding(Steel(), PART, "");
  const SamControl half = Loads(&one, 0.6, 0, 0, 0), all = Loads(&one, 1, 0, 0, 0);
  PetscReal        most, difference;
  Vec              a, b;

  (void)state;
  (void)Solve(&one, &all);
  (void)Solve(&two, &half);
  (void)Solve(&two, &all);
  a = NewDepth(&one);
  b = NewDepth(&two);
  sam_call(VecNorm(a, NORM_INFINITY, &most));
  sam_call(VecAXPY(b, -1, a));
  sam_call(VecNorm(b, NORM_INFINITY, &difference));
  sam_assert(most > 0 && difference < 1e-5 * most);
  sam_destroy(&a, &b);
  DestroyCase(&one);
  DestroyCase(&two);
}

/* ---- a solver that does not know the limit, and says that it does ---- */

static PetscErrorCode (*solve)(SamSolver, SamLevel *);

static PetscErrorCode SolveWithout(SamSolver normal, SamLevel *level)
{
  PetscFunctionBegin;
  level->frame.most = INFINITY;
  PetscCall(solve(normal, level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateWithout(SamSolver normal)
{
  PetscFunctionBegin;
  PetscCall(SamNormalCreate_ActiveSet(normal));
  solve             = normal->ops.solve;
  normal->ops.solve = SolveWithout;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void test_verdict_refuses_a_pressure_beyond_the_limit(void **state)
{
  Case             c       = NewYielding(Steel(), PART, "");
  const SamControl control = Loads(&c, 1, 0.3, 0, 0);
  SamNormal        normal;
  SamStep          step;

  (void)state;
  sam_call(SamNormalRegister("without", CreateWithout));
  normal = SamContactGetNormal(c.contact);
  sam_call(SamSolverSetType(SamNormalAsSolver(normal), "without"));
  step = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_NOT_CONVERGED && strstr(step.message, "check disagrees"));
  sam_assert(step.check.normal > 0.3);
  SetLimit(&c, 1.1 * c.s.p0);
  sam_assert(Try(&c, &control).status == SAM_STATUS_CONVERGED);
  DestroyCase(&c);
}

/* ---- states ---- */

static void AssertSameDepths(const Case *one, const SamStep *a, const Case *other, const SamStep *b)
{
  AssertSameSteps(one, a, other, b); /* with the numbers of cells that yield */
  AssertSameFields(one, other);
  sam_assert(SameBitsOf(one, other, NewDepth));
}

enum { STEPS = 6 };
static SamControl Turn(const Case *c, int k)
{
  const double N[STEPS] = {0.8, 1, 0.3, 0.9, 1, 1.2}, T[STEPS] = {0.1, 0.3, 0.2, -0.3, 0, 0.4};

  return Loads(c, N[k], T[k] * N[k], 0.1 * T[k], 0);
}

static SamPair BodiesOf(int kind)
{
  return kind ? Dissimilar() : Steel();
}

/* Between steps, one contact tries loads under which it would yield farther; the other does not. */
static void test_overlap_of_a_rejected_try_is_forgotten(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    Case one = NewYielding(BodiesOf(kind), PART, ""), other = NewYielding(BodiesOf(kind), PART, "");

    for (int k = 0; k < STEPS; k++) {
      const SamControl control = Turn(&one, k), more = Loads(&one, 1.6, 0.3, 0, 0);
      SamStep          a, b                          = Solve(&other, &control);

      (void)Try(&one, &more);
      sam_assert(NumberOf(&one, "hardness_work") > 0);
      sam_assert(NumberOf(&one, "plastic_depth_max") > NumberOf(&other, "plastic_depth_max"));
      sam_call(SamContactReject(one.contact));
      a = Solve(&one, &control);
      AssertSameDepths(&one, &a, &other, &b);
    }
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

static void test_contact_with_the_state_of_a_yielded_one_goes_on_as_it_would(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++)
    for (int solved = 0; solved < 4; solved++) {
      Case             one = NewYielding(BodiesOf(kind), PART, ""), other = NewYielding(BodiesOf(kind), PART, "");
      const SamControl far = Loads(&one, 1.5, 0, 0, 0);
      SamState         held;
      PetscBool        current;

      for (int k = 0; k < solved; k++) {
        const SamControl control = Turn(&one, k);

        (void)Solve(&one, &control);
      }
      (void)Solve(&other, &far); /* its depth must go */
      sam_call(SamContactGetState(one.contact, &held));
      sam_call(SamContactIsGapCurrent(one.contact, &current));
      sam_call(SamContactSetState(other.contact, held, current));
      for (int k = solved; k < STEPS; k++) {
        const SamControl control = Turn(&one, k);
        const SamStep    a = Solve(&one, &control), b = Solve(&other, &control);

        AssertSameDepths(&one, &a, &other, &b);
      }
      DestroyCase(&one);
      DestroyCase(&other);
    }
}

static void test_state_without_a_depth_takes_it_away(void **state)
{
  Case             one = NewCase(Steel(), 48, 1.5, MU, ""), other = NewYielding(Steel(), PART, "");
  const SamControl control = Loads(&one, 1, 0, 0, 0);
  SamState         held;
  Vec              depth;

  (void)state;
  (void)Solve(&one, &control);
  (void)Solve(&other, &control);
  sam_assert(NumberOf(&other, "plastic_depth_max") > 0);
  sam_call(SamContactGetState(one.contact, &held));
  sam_assert(SamStateFindField(held, "plastic_depth") < 0);
  sam_call(SamContactSetState(other.contact, held, PETSC_TRUE));
  depth = NewDepth(&other);
  sam_assert(Norm(depth, NORM_INFINITY) == 0);
  sam_call(VecDestroy(&depth));
  DestroyCase(&one);
  DestroyCase(&other);
}

static void test_depth_stays_without_the_limit(void **state)
{
  Case       c    = NewYielding(Steel(), PART, "");
  SamControl full = Loads(&c, 1, 0, 0, 0), half = Loads(&c, 0.5, 0, 0, 0);
  SamStep    again;
  double     most;
  Vec        depth, now;

  (void)state;
  (void)Solve(&c, &full);
  most = NumberOf(&c, "plastic_depth_max");
  sam_assert(most > 0 && NumberOf(&c, "hardness_work") > 0);
  (void)Solve(&c, &half);
  depth = NewDepth(&c);
  sam_assert(NumberOf(&c, "plastic_depth_max") == most);
  sam_assert(NumberOf(&c, "hardness_work") == 0 && NumberOf(&c, "plastic_cells") == 0);
  (void)Try(&c, &half);
  sam_assert(NumberOf(&c, "normal_applies") == 0); /* nothing has changed */
  SetLimit(&c, INFINITY);
  (void)Try(&c, &half);
  sam_assert(NumberOf(&c, "normal_applies") > 0); /* another limit is like another gap */
  again = Solve(&c, &full);
  now   = NewDepth(&c);
  sam_assert(again.status == SAM_STATUS_CONVERGED && NumberOf(&c, "hardness_work") == 0);
  sam_assert(SameBits(depth, now));
  sam_destroy(&depth, &now);
  DestroyCase(&c);
}

static void test_limit_is_positive_and_of_its_law(void **state)
{
  Case   c = NewCase(Steel(), 24, 1.5, 0, "");
  SamLaw law;

  (void)state;
  SetLimit(&c, INFINITY);
  law = SamProblemGetLaw(c.problem, SAM_LAW_HARDNESS);
  sam_fails(SamLawSetHardness(law, -1), PETSC_ERR_ARG_OUTOFRANGE);
  law = SamProblemGetLaw(c.problem, SAM_LAW_COULOMB);
  sam_fails(SamLawSetHardness(law, 1), PETSC_ERR_ARG_WRONG);
  DestroyCase(&c);
}

/* ---- in another program ---- */

#define EMBEDDED \
  "-body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3 -gap_type sphere -gap_radius1 0.1 " \
  "-gap_radius2 inf -grid_n 40 -grid_size 3e-3 -allow_edge_contact "

static double Number(petsam_contact *c, const char *name)
{
  double value;

  sam_assert(petsam_get_number(c, name, &value) == 0);
  return value;
}

static void Press(petsam_contact *c, double N)
{
  const int    force[6] = {1, 1, 1, 1, 1, 1};
  const double value[6] = {N};
  double       load[6], rigid[6];

  sam_assert(TryComponents(c, 1, force, value, load, rigid) == 0);
}

static void test_embedded_contact_yields_when_committed(void **state)
{
  petsam_contact *c = NULL, *plain = NULL;
  double         *depth = (double *)calloc(1600, sizeof(*depth)), most;

  (void)state;
  sam_assert(petsam_create(World(), EMBEDDED "-pressure_limit 5e8", &c) == 0);
  sam_assert(petsam_create(World(), EMBEDDED, &plain) == 0);
  Press(c, 2000);
  most = Number(c, "plastic_depth_max");
  sam_assert(most > 0 && Number(c, "plastic_cells") > 100);
  sam_assert(petsam_reject(c) == 0);
  Press(c, 100);
  sam_assert(Number(c, "plastic_depth_max") == 0);
  Press(c, 2000);
  sam_assert(petsam_commit(c) == 0);
  Press(c, 100);
  sam_assert(Number(c, "plastic_depth_max") == most && Number(c, "hardness_work") == 0);
  sam_assert(petsam_get_field(c, "plastic_depth", depth) == 0);
  Press(plain, 100);
  sam_assert(petsam_get_field(plain, "plastic_depth", depth) != 0);
  free(depth);
  petsam_destroy(&c);
  petsam_destroy(&plain);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_check_finds_pressure_beyond_the_limit),
    cmocka_unit_test(test_check_finds_an_overlap_below_the_limit),
    cmocka_unit_test(test_check_finds_a_gap_at_the_limit),
    cmocka_unit_test(test_check_knows_the_depth_before),
    cmocka_unit_test(test_depth_grows_by_the_overlap_that_is_left),
    cmocka_unit_test(test_verdict_refuses_a_pressure_beyond_the_limit),
    cmocka_unit_test(test_overlap_of_a_rejected_try_is_forgotten),
    cmocka_unit_test(test_contact_with_the_state_of_a_yielded_one_goes_on_as_it_would),
    cmocka_unit_test(test_state_without_a_depth_takes_it_away),
    cmocka_unit_test(test_depth_stays_without_the_limit),
    cmocka_unit_test(test_limit_is_positive_and_of_its_law),
    cmocka_unit_test(test_embedded_contact_yields_when_committed),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * The verdict on a step: each limit by itself, and solvers that call a wrong solution converged.
 */
#include "contacts.h"

#include <petsam/private/normalimpl.h> /* to register a method */
#include <petsam/private/tangentialimpl.h>
#include <petsam/private/check.h>

/* ---- the verdict as a function ---- */

static const SamCheckLimits limits = {.normal = 1e-8, .tangential = 2e-6, .equilibrium = 3e-10, .cone = 4e-12};

/* The residual of that number, and its limit. */
static PetscReal *ResidualOf(SamCheck *check, int k)
{
  PetscReal *const residuals[] = {&check->normal, &check->tangential, &check->equilibrium, &check->cone};

  return residuals[k];
}

static PetscReal LimitOf(int k)
{
  const PetscReal all[] = {limits.normal, limits.tangential, limits.equilibrium, limits.cone};

  return all[k];
}

/* The verdict on a step whose residuals are at their limits but for one. */
static SamStep JudgeWith(int k, PetscReal residual)
{
  SamStep step;

  memset(&step, 0, sizeof(step));
  for (int other = 0; other < 4; other++) *ResidualOf(&step.check, other) = LimitOf(other);
  *ResidualOf(&step.check, k) = residual;
  sam_call(SamStepJudge(&step, &limits));
  return step;
}

static void test_residual_at_its_limit_is_accepted(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    const PetscReal good[] = {0, 0.5 * LimitOf(k), nextafter(LimitOf(k), 0), LimitOf(k)};

    for (int n = 0; n < 4; n++) {
      const SamStep step = JudgeWith(k, good[n]);

      sam_assert(step.status == SAM_STATUS_CONVERGED && step.message[0] == '\0');
    }
  }
}

static void test_each_residual_beyond_its_limit_is_refused(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    const PetscReal bad[] = {nextafter(LimitOf(k), 1), 2 * LimitOf(k), INFINITY, NAN};

    for (int n = 0; n < 4; n++) {
      const SamStep step = JudgeWith(k, bad[n]);

      sam_assert(step.status == SAM_STATUS_NOT_CONVERGED && strstr(step.message, "check disagrees"));
    }
  }
}

static void test_pressure_at_the_edge_is_refused_or_a_warning(void **state)
{
  static const PetscReal edges[] = {0, DBL_MIN, 1e-9, 1};

  (void)state;
  for (int allowed = 0; allowed < 2; allowed++)
    for (int k = 0; k < 4; k++) {
      SamCheckLimits these = limits;
      SamStep        step;

      memset(&step, 0, sizeof(step));
      these.edge      = allowed ? PETSC_TRUE : PETSC_FALSE;
      step.check.edge = edges[k];
      sam_call(SamStepJudge(&step, &these));
      sam_assert(step.status == (k && !allowed ? SAM_STATUS_EDGE_CONTACT : SAM_STATUS_CONVERGED));
      sam_assert(k ? strstr(step.message, "edge of the grid") != NULL : step.message[0] == '\0');
    }
}

/* The first failure stays, with its message. */
static void test_verdict_does_not_mend_a_failed_step(void **state)
{
  static const SamStatus failures[] = {SAM_STATUS_NOT_CONVERGED, SAM_STATUS_NO_EQUILIBRIUM};

  (void)state;
  for (int k = 0; k < 4; k++) { /* the check agrees or not, edge allowed or not */
    SamCheckLimits these = limits;
    SamStep        step;

    memset(&step, 0, sizeof(step));
    these.edge        = k / 2 ? PETSC_TRUE : PETSC_FALSE;
    step.status       = failures[k % 2];
    step.check.normal = k % 2;
    step.check.edge   = 1;
    (void)snprintf(step.message, sizeof(step.message), "first");
    sam_call(SamStepJudge(&step, &these));
    sam_assert(step.status == failures[k % 2] && !strcmp(step.message, "first"));
  }
}

/* A wrong solution that reaches the grid's edge is NOT_CONVERGED, not EDGE_CONTACT. */
static void test_disagreement_comes_before_the_edge(void **state)
{
  SamStep step;

  (void)state;
  memset(&step, 0, sizeof(step));
  step.check.cone = 1;
  step.check.edge = 1;
  sam_call(SamStepJudge(&step, &limits));
  sam_assert(step.status == SAM_STATUS_NOT_CONVERGED);
}

/* ---- solvers that lie ---- */

/* How the traction is wrong that they report as converged. */
typedef struct {
  PetscReal pressure, shear; /* factor on all of it, less 1 */
  PetscInt  cell[2];         /* one cell of the finest grid, column and row; negative: none */
  PetscReal part;            /* of the largest pressure, which is added there */
} Lie;

static const Lie truth = {.cell = {-1, -1}};
static Lie       lie;

static PetscErrorCode (*solve_normal)(SamSolver, SamLevel *);
static PetscErrorCode (*solve_tangential)(SamSolver, SamLevel *);

static PetscErrorCode LieOfPressure(SamSolver normal, SamLevel *level)
{
  PetscReal most;

  PetscFunctionBegin;
  PetscCall(solve_normal(normal, level));
  if (level->depth > 0 || normal->effort == SAM_EFFORT_RESIDUAL_ONLY) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecScale(level->traction, 1 + lie.pressure));
  PetscCall(VecNorm(level->traction, NORM_INFINITY, &most));
  if (lie.cell[0] >= 0) AddAt(level->grid, 0, lie.cell[0], lie.cell[1], lie.part * most, level->traction);
  normal->reason = SAM_SOLVER_CONVERGED_RTOL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LieOfShear(SamSolver tangential, SamLevel *level)
{
  PetscFunctionBegin;
  PetscCall(solve_tangential(tangential, level));
  if (level->depth == 0) PetscCall(VecScale(level->traction, 1 + lie.shear));
  tangential->reason = SAM_SOLVER_CONVERGED_RTOL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateNormalLiar(SamSolver normal)
{
  PetscFunctionBegin;
  PetscCall(SamNormalCreate_ActiveSet(normal));
  solve_normal      = normal->ops.solve;
  normal->ops.solve = LieOfPressure;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateTangentialLiar(SamSolver tangential)
{
  PetscFunctionBegin;
  PetscCall(SamTangentialCreate_Newton(tangential));
  solve_tangential      = tangential->ops.solve;
  tangential->ops.solve = LieOfShear;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step that both liars have solved; where `displaced` no load is given that could be out of equilibrium. */
static SamStep TryLieOf(SamPair pair, PetscBool displaced)
{
  SamControl control;
  SamStep    step;
  Case       c;

  sam_call(SamNormalRegister("liar", CreateNormalLiar));
  sam_call(SamTangentialRegister("liar", CreateTangentialLiar));
  c       = NewCase(pair, 40, 1.5, MU, "-normal_type liar -tangential_type liar");
  control = Loads(&c, 1, 0.5, 0, 0);
  for (PetscInt k = 0; k < SAM_COMPONENTS && displaced; k++) Displace(&control, (SamComponent)k, 0);
  if (displaced) {
    control.value[SAM_COMPONENT_N]  = c.s.a * c.s.a / c.s.R;
    control.value[SAM_COMPONENT_TX] = 0.4 * MU * c.s.a * c.s.a / c.s.R;
  }
  step = Try(&c, &control);
  DestroyCase(&c);
  return step;
}

static SamStep TryLie(PetscBool displaced)
{
  return TryLieOf(Steel(), displaced);
}

static void AssertRefused(const SamStep *step)
{
  sam_assert(step->status == SAM_STATUS_NOT_CONVERGED && strstr(step->message, "check disagrees"));
}

static void test_solvers_that_tell_the_truth_are_believed(void **state)
{
  SamStep step;

  (void)state;
  lie  = truth;
  step = TryLie(PETSC_FALSE);
  AssertGood(&step);
  step = TryLie(PETSC_TRUE);
  AssertGood(&step);
}

static void test_wrong_pressure_that_a_solver_calls_converged_is_refused(void **state)
{
  static const PetscInt inside[2] = {18, 22}, outside[2] = {2, 20};
  SamStep               step;

  (void)state;
  lie          = truth;
  lie.pressure = 1e-9; /* less than the normal residual may be, more than equilibrium allows */
  step         = TryLie(PETSC_FALSE);
  AssertRefused(&step);
  for (int k = 0; k < 2; k++) {
    lie = truth;
    memcpy(lie.cell, k ? inside : outside, sizeof(lie.cell));
    lie.part = 1e-3;
    step     = TryLie(PETSC_TRUE);
    AssertRefused(&step);
    sam_assert(step.check.normal > 1e-6 && step.check.tangential < 2e-6 && step.check.cone < 1e-13);
  }
}

/* By the same limits as that of similar bodies. */
static void test_wrong_pressure_of_dissimilar_bodies_is_refused(void **state)
{
  SamStep step;

  (void)state;
  lie  = truth;
  step = TryLieOf(Dissimilar(), PETSC_TRUE);
  sam_assert(step.status == SAM_STATUS_CONVERGED);
  lie.pressure = 1e-7;
  step         = TryLieOf(Dissimilar(), PETSC_TRUE);
  sam_assert(step.status == SAM_STATUS_NOT_CONVERGED);
  sam_assert(step.check.normal > 2e-8 && step.check.normal < 1e-5 && step.check.tangential < 1e-6);
}

static void test_wrong_shear_that_a_solver_calls_converged_is_refused(void **state)
{
  static const double wrong[] = {1e-3, -1e-3, -2};
  SamStep             step;

  (void)state;
  for (int k = 0; k < 3; k++) {
    lie       = truth;
    lie.shear = wrong[k];
    step      = TryLie(PETSC_TRUE);
    AssertRefused(&step);
    sam_assert(step.check.tangential > 1e-5 && step.check.equilibrium < 1e-11);
  }
}

/* Far below the limit of the tangential residual. */
static void test_shear_that_is_a_little_beyond_the_cone_is_refused(void **state)
{
  SamStep step;

  (void)state;
  lie       = truth;
  lie.shear = 1e-11;
  step      = TryLie(PETSC_TRUE);
  AssertRefused(&step);
  sam_assert(step.check.tangential < 2e-6 && step.check.equilibrium < 1e-11 && step.check.normal < 2e-8);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_residual_at_its_limit_is_accepted),
    cmocka_unit_test(test_each_residual_beyond_its_limit_is_refused),
    cmocka_unit_test(test_pressure_at_the_edge_is_refused_or_a_warning),
    cmocka_unit_test(test_verdict_does_not_mend_a_failed_step),
    cmocka_unit_test(test_disagreement_comes_before_the_edge),
    cmocka_unit_test(test_solvers_that_tell_the_truth_are_believed),
    cmocka_unit_test(test_wrong_pressure_that_a_solver_calls_converged_is_refused),
    cmocka_unit_test(test_wrong_pressure_of_dissimilar_bodies_is_refused),
    cmocka_unit_test(test_wrong_shear_that_a_solver_calls_converged_is_refused),
    cmocka_unit_test(test_shear_that_is_a_little_beyond_the_cone_is_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

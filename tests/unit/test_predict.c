/*
 * The guess for a step: exact where the squared radii of contact and stick change evenly from step to step.
 */
#include "contacts.h"

#include "../../src/contact/contactimpl.h"

/*
  Hertz's pressure of radius a, and of Cattaneo's shear under T = (1 - (c/a)^3) mu N: mu times it less that of radius
  c.
*/
typedef struct {
  double a, c;
} Stage;

static double HertzOf(double radius, double x, double y)
{
  const double left = radius * radius - x * x - y * y;

  return left > 0 ? sqrt(left) : 0;
}

static double StagePressure(double x, double y, const void *stage)
{
  return HertzOf(((const Stage *)stage)->a, x, y);
}

static double StageShear(double x, double y, const void *stage)
{
  return MU * (HertzOf(((const Stage *)stage)->a, x, y) - HertzOf(((const Stage *)stage)->c, x, y));
}

static Vec NewShear(SamGrid grid, const Stage *stage)
{
  Vec     q = NewField(grid, 2), x = NewFrom(grid, StageShear, stage);
  double *a, *b;

  sam_call(VecGetArray(q, &a));
  sam_call(VecGetArray(x, &b));
  for (PetscInt k = 0; k < grid->cells; k++) a[k] = b[k];
  sam_call(VecRestoreArray(x, &b));
  sam_call(VecRestoreArray(q, &a));
  sam_call(VecDestroy(&x));
  return q;
}

/* ---- a contact that has made two steps ---- */

typedef struct {
  SamElasticity elasticity;
  SamProblem    problem;
  SamContact    contact;
} Made;

/* Loads grow from step to step by the same. */
static SamControl ControlOf(int step)
{
  SamControl control;

  sam_call(SamControlInitialize(&control));
  control.value[SAM_COMPONENT_N]  = step + 1;
  control.value[SAM_COMPONENT_TX] = 0.1 * (step + 1);
  return control;
}

/* With these tractions after the first step and after the second. */
static Made MakeContact(SamGrid grid, Vec p[2], Vec q[2])
{
  const SamPair   pair = Steel();
  SamContactState state;
  Made            m;

  sam_call(SamElasticityCreate(grid, &pair, &m.elasticity));
  sam_call(SamProblemCreate(m.elasticity, &m.problem));
  sam_call(SamProblemSetFriction(m.problem, MU));
  sam_call(SamContactCreate(m.problem, &m.contact));
  memset(&state, 0, sizeof(state));
  state.steps              = 2;
  state.before             = (SamSolution){.control = ControlOf(0), .pressure = p[0], .shear = q[0]};
  state.now                = (SamSolution){.control = ControlOf(1), .pressure = p[1], .shear = q[1]};
  state.before.bound       = NewField(grid, 1);
  state.now.bound          = NewField(grid, 1);
  state.now.displacement_z = NewField(grid, 1);
  state.now.displacement_t = NewField(grid, 2);
  sam_call(SamProblemComputeBound(m.problem, 1, p[0], state.before.bound));
  sam_call(SamProblemComputeBound(m.problem, 1, p[1], state.now.bound));
  sam_call(SamContactSetState(m.contact, &state));
  sam_call(VecDestroy(&state.before.bound));
  sam_call(VecDestroy(&state.now.bound));
  sam_call(VecDestroy(&state.now.displacement_z));
  sam_call(VecDestroy(&state.now.displacement_t));
  return m;
}

static void DestroyContact(Made *m)
{
  sam_call(SamContactDestroy(&m->contact));
  sam_call(SamProblemDestroy(&m->problem));
  sam_call(SamElasticityDestroy(&m->elasticity));
}

/* ---- tests ---- */

/* Extrapolates from two stages of equal way in a^2 and c^2 to the third; returns the errors of p and q, relative. */
static void PredictStages(const Stage stages[3], double errors[2])
{
  const SamControl next = ControlOf(2);
  SamGrid          grid = NewGrid(61, 47, 2.4, 2.4);
  Vec              p[3], q[3];
  SamStepStart     start;
  Made             m;

  for (int k = 0; k < 3; k++) {
    p[k] = NewFrom(grid, StagePressure, &stages[k]);
    q[k] = NewShear(grid, &stages[k]);
  }
  m = MakeContact(grid, p, q);
  sam_call(SamContactPredict(m.contact, &next, &start));
  sam_assert(start.pressure && start.shear);
  errors[0] = Difference(m.contact->tried.solution.pressure, p[2], NORM_2);
  errors[1] = Difference(m.contact->tried.solution.shear, q[2], NORM_2);
  DestroyContact(&m);
  for (int k = 0; k < 3; k++) {
    sam_call(VecDestroy(&p[k]));
    sam_call(VecDestroy(&q[k]));
  }
  sam_call(SamGridDestroy(&grid));
}

static void test_prediction_follows_the_edge_of_stick(void **state)
{
  const Stage stages[3] = {{1, 0.8}, {1, sqrt(0.54)}, {1, sqrt(0.44)}};
  double      errors[2];

  (void)state;
  PredictStages(stages, errors);
  /* both squares are linear in c^2: exact; extrapolating q itself would be wrong by 7 % */
  sam_assert_close(errors[0], 0, 1e-14);
  sam_assert_close(errors[1], 0, 1e-12);
}

static void test_prediction_follows_the_edge_of_contact(void **state)
{
  const Stage stages[3] = {{1, 0}, {sqrt(0.9), 0}, {sqrt(0.8), 0}};
  double      errors[2];

  (void)state;
  PredictStages(stages, errors);
  sam_assert_close(errors[0], 0, 1e-12);
  sam_assert_close(errors[1], 0, 1e-12);
}

static void test_prediction_keeps_what_would_vanish(void **state)
{
  const SamControl   next = ControlOf(2);
  SamGrid            grid = NewGrid(8, 5, 1, 1);
  Vec                p[2] = {NewField(grid, 1), NewField(grid, 1)}, q[2] = {NewField(grid, 2), NewField(grid, 2)};
  const SamSolution *s;
  SamStepStart       start;
  Made               m;

  (void)state;
  sam_call(VecSet(p[0], 2));
  sam_call(VecSet(p[1], 1));
  sam_call(VecSet(q[1], 0.1));
  m = MakeContact(grid, p, q);
  sam_call(SamContactPredict(m.contact, &next, &start));
  sam_assert(!start.pressure && !start.shear);
  sam_call(SamContactGetSolution(m.contact, &s));
  sam_assert(SameBits(s->pressure, p[1]) && SameBits(s->shear, q[1]));
  sam_assert(SameBits(m.contact->before.pressure, p[0]) && SameBits(m.contact->before.shear, q[0]));
  DestroyContact(&m);
  for (int k = 0; k < 2; k++) {
    sam_call(VecDestroy(&p[k]));
    sam_call(VecDestroy(&q[k]));
  }
  sam_call(SamGridDestroy(&grid));
}

/* No guess when loads turn, or when a component changes between load and displacement. */
static void test_what_turns_is_not_predicted(void **state)
{
  const Stage  stages[2] = {{1, 0}, {sqrt(0.9), 0}};
  SamGrid      grid      = NewGrid(21, 17, 2.4, 2.4);
  Vec          p[2], q[2];
  SamControl   next = ControlOf(0);
  SamStepStart start;
  Made         m;

  (void)state;
  for (int k = 0; k < 2; k++) {
    p[k] = NewFrom(grid, StagePressure, &stages[k]);
    q[k] = NewShear(grid, &stages[k]);
  }
  m = MakeContact(grid, p, q);
  sam_call(SamContactPredict(m.contact, &next, &start));
  sam_assert(!start.pressure && !start.shear);
  next = ControlOf(2);
  Displace(&next, SAM_COMPONENT_TX, 0.3);
  sam_call(SamContactPredict(m.contact, &next, &start));
  sam_assert(!start.pressure && !start.shear);
  next = ControlOf(2);
  sam_call(SamContactSetWarmStart(m.contact, PETSC_FALSE));
  sam_call(SamContactPredict(m.contact, &next, &start));
  sam_assert(!start.pressure && !start.shear);
  DestroyContact(&m);
  for (int k = 0; k < 2; k++) {
    sam_call(VecDestroy(&p[k]));
    sam_call(VecDestroy(&q[k]));
  }
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_prediction_follows_the_edge_of_stick),
    cmocka_unit_test(test_prediction_follows_the_edge_of_contact),
    cmocka_unit_test(test_prediction_keeps_what_would_vanish),
    cmocka_unit_test(test_what_turns_is_not_predicted),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

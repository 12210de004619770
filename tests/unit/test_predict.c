/*
 * The guess for a step: exact where the squared radii of contact and stick change evenly from step to step.
 */
#include "contacts.h"

#include "../../src/contact/contactimpl.h"
#include <petsam/private/state.h>

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

/* The tractions and what was prescribed in a generation of a state. */
static void SetGeneration(SamProblem problem, SamState s, SamGeneration g, int step, Vec p, Vec q)
{
  const SamControl control = ControlOf(step);
  double          *given;
  Vec              field;

  sam_call(SamStateRestoreField(s, SamStateFindField(s, "pressure"), g, &field));
  sam_call(VecCopy(p, field));
  sam_call(SamStateRestoreField(s, SamStateFindField(s, "shear"), g, &field));
  sam_call(VecCopy(q, field));
  sam_call(SamStateRestoreField(s, SamStateFindField(s, "bound"), g, &field));
  ComputeBound(problem, 1, p, field);
  given = SamStateNumbers(s, SamStateFindNumber(s, "control"), g);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) given[1 + SAM_COMPONENTS + k] = control.value[k]; /* all are loads */
  *SamStateNumbers(s, SamStateFindNumber(s, "steps"), g) = step + 1;
}

/* With these tractions after the first step and after the second. */
static Made MakeContact(SamGrid grid, Vec p[2], Vec q[2])
{
  const SamPair pair = Steel();
  SamState      state, made;
  Made          m;

  sam_call(SamElasticityCreate(grid, pair, &m.elasticity));
  sam_call(SamProblemCreate(m.elasticity, &m.problem));
  sam_call(SamProblemSetFriction(m.problem, MU));
  sam_call(SamContactCreate(m.problem, &m.contact));
  sam_call(SamContactGetState(m.contact, &state));
  sam_call(SamStateCreateLike(state, &made));
  SetGeneration(m.problem, made, SAM_BEFORE, 0, p[0], q[0]);
  SetGeneration(m.problem, made, SAM_COMMITTED, 1, p[1], q[1]);
  sam_call(SamContactSetState(m.contact, made, PETSC_FALSE));
  sam_call(SamStateDestroy(&made));
  return m;
}

/* The guess for a step, into the tried generation. */
static SamStepStart Predict(const Made *m, const SamControl *next)
{
  sam_call(SamContactBegin(m->contact, next));
  sam_call(SamContactPredict(m->contact));
  return m->contact->tried.start;
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
  m     = MakeContact(grid, p, q);
  start = Predict(&m, &next);
  sam_assert(start.pressure && start.shear);
  errors[0] = Difference(m.contact->generation[SAM_TRIED].pressure, p[2], NORM_2);
  errors[1] = Difference(m.contact->generation[SAM_TRIED].shear, q[2], NORM_2);
  DestroyContact(&m);
  for (int k = 0; k < 3; k++) {
    sam_destroy(&p[k], &q[k]);
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
  m     = MakeContact(grid, p, q);
  start = Predict(&m, &next);
  sam_assert(!start.pressure && !start.shear);
  sam_call(SamContactGetSolution(m.contact, &s));
  sam_assert(SameBits(s->pressure, p[1]) && SameBits(s->shear, q[1]));
  sam_assert(SameBits(m.contact->generation[SAM_BEFORE].pressure, p[0]) &&
             SameBits(m.contact->generation[SAM_BEFORE].shear, q[0]));
  DestroyContact(&m);
  for (int k = 0; k < 2; k++) {
    sam_destroy(&p[k], &q[k]);
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
  m     = MakeContact(grid, p, q);
  start = Predict(&m, &next);
  sam_assert(!start.pressure && !start.shear);
  next = ControlOf(2);
  Displace(&next, SAM_COMPONENT_TX, 0.3);
  start = Predict(&m, &next);
  sam_assert(!start.pressure && !start.shear);
  next                      = ControlOf(2);
  m.contact->set.warm_start = PETSC_FALSE;
  start                     = Predict(&m, &next);
  sam_assert(!start.pressure && !start.shear);
  DestroyContact(&m);
  for (int k = 0; k < 2; k++) {
    sam_destroy(&p[k], &q[k]);
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

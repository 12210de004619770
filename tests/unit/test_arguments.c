/*
 * Arguments of the library's functions that are NULL, belong to another class, or have been destroyed.
 */
#include "contacts.h"
#include "embedded.h"

#include <petsam/gap.h>
#include <petsam/normal.h>
#include <petsam/stiffness.h>
#include <petsam/tangential.h>

static Case   c; /* a contact, whose parts are the objects of other classes */
static SamGap gap;

static int Create(void **state)
{
  (void)state;
  c = NewCase(Steel(), 12, 2, MU, "");
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  return 0;
}

/* ---- what the messages say ---- */

/* `object` is NULL, another one, or one that has been destroyed, whose class is 0, as argument n of `function`. */
#define REFUSES(function, class, n, ...) \
  do { \
    static int destroyed[64]; \
    class object = NULL; \
\
    sam_says(function(__VA_ARGS__), PETSC_ERR_ARG_NULL, "Null " #class ": argument # " #n); \
    object = (class)(void *)(strcmp(#class, "SamGrid") ? (void *)c.s.grid : (void *)c.problem); \
    sam_says(function(__VA_ARGS__), PETSC_ERR_ARG_WRONG, \
             "Argument # " #n " is not a " #class ", or it has been destroyed"); \
    object = (class)(void *)destroyed; \
    sam_says(function(__VA_ARGS__), PETSC_ERR_ARG_WRONG, \
             "Argument # " #n " is not a " #class ", or it has been destroyed"); \
  } while (0)

#define REFUSES_NULL(n, petsc_call_expr)   sam_says(petsc_call_expr, PETSC_ERR_ARG_NULL, "Null pointer: argument # " #n)
#define REFUSES_NO_VEC(n, petsc_call_expr) sam_says(petsc_call_expr, PETSC_ERR_ARG_NULL, "Null Vec: argument # " #n)

static void test_bodies_and_grid(void **state)
{
  const SamMaterial steel    = {.young = 210e9, .poisson = 0.3};
  const PetscInt    n[2]     = {4, 4};
  const PetscReal   width[2] = {1, 1};
  SamBody           body     = NULL;
  SamPair           pair     = NULL;
  SamGrid           grid     = NULL;
  Vec               v        = NULL;
  PetscReal         norm;

  (void)state;
  sam_call(SamBodyCreate(1, &steel, &body));
  REFUSES_NULL(2, SamBodyCreate(1, NULL, &body));
  REFUSES_NULL(3, SamBodyCreate(1, &steel, NULL));
  REFUSES(SamPairCreate, SamBody, 1, object, body, &pair);
  REFUSES(SamPairCreate, SamBody, 2, body, object, &pair);
  REFUSES_NULL(3, SamPairCreate(body, body, NULL));
  sam_call(SamBodyDestroy(&body));
  REFUSES_NULL(2, SamGridCreate(PETSC_COMM_WORLD, NULL, width, width, &grid));
  REFUSES_NULL(5, SamGridCreate(PETSC_COMM_WORLD, n, width, width, NULL));
  REFUSES(SamGridCreateVec, SamGrid, 1, object, 1, &v);
  REFUSES_NULL(3, SamGridCreateVec(c.s.grid, 1, NULL));
  REFUSES_NO_VEC(2, SamGridNorm(c.s.grid, NULL, NORM_2, &norm));
  REFUSES_NULL(4, SamGridNorm(c.s.grid, c.s.h, NORM_2, NULL));
  REFUSES(SamElasticityCreate, SamGrid, 1, object, NULL, NULL);
  REFUSES(SamElasticityCreate, SamPair, 2, c.s.grid, object, NULL);
  sam_assert(!body && !pair && !grid && !v);
}

static void test_elasticity_and_gap(void **state)
{
  (void)state;
  REFUSES(SamElasticitySetUp, SamElasticity, 1, object);
  REFUSES(SamElasticityApplyNormal, SamElasticity, 1, object, c.s.h, c.s.h);
  REFUSES_NO_VEC(2, SamElasticityApplyNormal(c.s.elasticity, NULL, c.s.h));
  REFUSES_NO_VEC(3, SamElasticityApplyTangentialToNormal(c.s.elasticity, c.s.h, NULL));
  REFUSES_NULL(2, SamElasticitySetType(c.s.elasticity, NULL));
  sam_call(SamElasticityGetSelfInfluence(c.s.elasticity, NULL, NULL)); /* allowed */
  REFUSES(SamGapSetType, SamGap, 1, object, SAM_GAP_SPHERE);
  REFUSES_NULL(2, SamGapSetType(gap, NULL));
  REFUSES_NULL(2, SamGapSetParameter(gap, NULL, 1));
  REFUSES(SamGapFill, SamGrid, 2, gap, object, c.s.h);
  REFUSES_NO_VEC(3, SamGapFill(gap, c.s.grid, NULL));
  REFUSES_NULL(2, SamGapCreate(PETSC_COMM_WORLD, NULL));
  REFUSES_NULL(1, SamGapRegister(NULL, NULL));
  sam_call(SamGapSetOptionsPrefix(gap, NULL));
  sam_call(SamGapSetFile(gap, PETSC_FALSE, NULL, NULL));
}

/* A solver of one kind is none of the other. */
static void test_solvers(void **state)
{
  const SamNormal     normal     = SamContactGetNormal(c.contact);
  const SamTangential tangential = SamContactGetTangential(c.contact);
  SamBalance          balance    = {0};

  (void)state;
  REFUSES(SamSolverSetTolerances, SamSolver, 1, object, PETSC_DEFAULT, PETSC_DEFAULT);
  REFUSES_NULL(2, SamSolverSetType(SamNormalAsSolver(normal), NULL));
  REFUSES(SamNormalSolve, SamNormal, 1, object, c.s.h, &balance, PETSC_FALSE, c.s.h);
  REFUSES_NULL(3, SamNormalSolve(normal, c.s.h, NULL, PETSC_FALSE, c.s.h));
  REFUSES_NO_VEC(5, SamNormalSolve(normal, c.s.h, &balance, PETSC_FALSE, NULL));
  REFUSES(SamTangentialSolve, SamTangential, 1, object, c.s.h, NULL, &balance, PETSC_FALSE, c.s.h);
  REFUSES_NO_VEC(2, SamTangentialSolve(tangential, NULL, NULL, &balance, PETSC_FALSE, c.s.h));
  sam_says(SamNormalSolve((SamNormal)(void *)tangential, c.s.h, &balance, PETSC_FALSE, c.s.h), PETSC_ERR_ARG_WRONG,
           "Argument # 1 is not a SamNormal");
  sam_says(SamTangentialSolve((SamTangential)(void *)normal, c.s.h, NULL, &balance, PETSC_FALSE, c.s.h),
           PETSC_ERR_ARG_WRONG, "Argument # 1 is not a SamTangential");
  sam_call(SamSolverGetStatistics(SamTangentialAsSolver(tangential), NULL, NULL, NULL, NULL));
}

static void test_problem_and_laws(void **state)
{
  const PetscReal     wear[2]   = {0, 0};
  const SamCondition  condition = {.name = "a condition"};
  const SamConditions list      = SamProblemGetConditions(c.problem);
  SamLaw              law       = SamProblemGetLaw(c.problem, SAM_LAW_COULOMB);
  SamControl          control;

  (void)state;
  REFUSES(SamProblemCreate, SamElasticity, 1, object, NULL);
  REFUSES(SamProblemSetFriction, SamProblem, 1, object, MU);
  REFUSES(SamProblemAddLaw, SamLaw, 2, c.problem, object);
  REFUSES_NO_VEC(2, SamProblemSetGap(c.problem, NULL));
  REFUSES_NULL(2, SamProblemAddLawOfType(c.problem, NULL, NULL));
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_COULOMB, NULL)); /* allowed */
  REFUSES(SamLawCreate, SamElasticity, 1, object, SAM_LAW_COULOMB, &law);
  REFUSES_NULL(3, SamLawCreate(c.s.elasticity, SAM_LAW_COULOMB, NULL));
  REFUSES(SamLawSetHardness, SamLaw, 1, object, 1);
  REFUSES(SamLawSetWear, SamLaw, 1, object, wear);
  REFUSES_NULL(2, SamLawSetWear(law, NULL));
  sam_says(SamLawSetSurface(law, 2, c.s.h), PETSC_ERR_ARG_OUTOFRANGE, "Body 2: expected 0 or 1");
  REFUSES(SamConditionsAdd, SamConditions, 1, object, &condition, NULL);
  REFUSES_NULL(2, SamConditionsAdd(list, NULL, NULL));
  REFUSES_NULL(1, SamControlInitialize(NULL));
  sam_call(SamControlInitialize(&control));
  REFUSES_NULL(3, SamControlSet(&control, list, NULL, 1));
  sam_call(SamControlSet(&control, NULL, "load_n", 1)); /* allowed */
}

static void test_contact_and_state(void **state)
{
  SamControl   control = Loads(&c, 1, 0, 0, 0);
  SamContact   none    = NULL;
  SamState     own;
  SamStep      step;
  SamStiffness stiffness;
  PetscReal    value;
  PetscInt     id;
  Vec          field;

  (void)state;
  REFUSES(SamContactCreate, SamProblem, 1, object, &none);
  REFUSES_NULL(2, SamContactCreate(c.problem, NULL));
  REFUSES(SamContactTry, SamContact, 1, object, &control, &step);
  REFUSES_NULL(2, SamContactTry(c.contact, NULL, &step));
  REFUSES_NULL(3, SamContactTry(c.contact, &control, NULL));
  REFUSES(SamContactGetNumber, SamContact, 1, object, "load_n", &value);
  REFUSES_NULL(2, SamContactGetNumber(c.contact, NULL, &value));
  REFUSES_NULL(3, SamContactGetNumber(c.contact, "load_n", NULL));
  REFUSES_NO_VEC(3, SamContactGetField(c.contact, "pressure", NULL));
  REFUSES_NULL(2, SamContactGetSolution(c.contact, NULL));
  REFUSES_NULL(2, SamContactGetState(c.contact, NULL));
  REFUSES(SamStiffnessCompute, SamContact, 1, object, SAM_STIFFNESS_FORWARD, 0, NULL, &stiffness);
  REFUSES_NULL(5, SamStiffnessCompute(c.contact, SAM_STIFFNESS_FORWARD, 0, NULL, NULL));
  sam_call(SamContactGetState(c.contact, &own));
  REFUSES(SamStateSetField, SamState, 1, object, 0, &field);
  REFUSES_NULL(3, SamStateSetField(own, 0, NULL));
  sam_says(SamStateSetField(own, -1, &field), PETSC_ERR_ARG_OUTOFRANGE, "Field -1: expected one of the");
  sam_says(SamStateSetField(own, SAM_STATE_MOST, &field), PETSC_ERR_ARG_OUTOFRANGE, "expected one of the");
  REFUSES_NULL(2, SamStateDeclareField(own, NULL, &id));
  REFUSES_NULL(2, SamStateDeclareNumber(own, NULL, &id));
  REFUSES(SamCheckSolution, SamProblem, 1, object, NULL, PETSC_FALSE, PETSC_FALSE, NULL, NULL, NULL);
  REFUSES_NULL(6, SamCheckSolution(c.problem, NULL, PETSC_FALSE, PETSC_FALSE, NULL, NULL, NULL));
}

static void test_options_and_parameters(void **state)
{
  const SamOptions from       = {PETSC_COMM_WORLD, NULL};
  SamParameters    parameters = {0};
  PetscReal        value      = 1;

  (void)state;
  REFUSES_NULL(1, SamOptionsReal(NULL, "a", "text", NULL, SAM_RANGE_POSITIVE, &value, NULL));
  REFUSES_NULL(6, SamOptionsReal(&from, "a", "text", NULL, SAM_RANGE_POSITIVE, NULL, NULL));
  REFUSES_NULL(4, SamOptionsRead(&from, NULL, 1, NULL, &value, NULL));
  sam_call(SamOptionsRead(&from, NULL, 0, NULL, NULL, NULL)); /* allowed */
  REFUSES_NULL(1, SamOptionsPlugins(NULL));
  REFUSES_NULL(2, SamOptionsHeading(&from, NULL));
  REFUSES_NULL(1, SamParametersAddText(NULL, "a", PETSC_FALSE, ""));
  REFUSES_NULL(5, SamParametersAddReals(&parameters, "a", PETSC_FALSE, 1, NULL));
}

/* ---- objects that are destroyed ---- */

static PetscErrorCode (*usual_free)(void *, int, const char[], const char[]);

static const void *watched; /* an object, */
static int         left;    /* the class that it has when it is freed */

static PetscErrorCode Free(void *memory, int line, const char function[], const char file[])
{
  if (memory && memory == watched) left = *(const int *)memory;
  return usual_free(memory, line, function, file);
}

#define DESTROYS(function, object) \
  do { \
    left    = -1; \
    watched = *(object); \
    sam_assert(*(const int *)watched); \
    sam_call(function(object)); \
    sam_assert(left == 0 && !*(object)); \
    sam_call(function(object)); \
    REFUSES_NULL(1, function(NULL)); \
  } while (0)

/* An object loses its class before its memory is freed; destroyers accept NULL objects, and refuse other ones. */
static void test_destroyed_objects_have_no_class(void **state)
{
  const SamMaterial steel = {.young = 210e9, .poisson = 0.3};
  SamBody           body  = NULL;
  SamPair           pair  = NULL;
  SamLaw            law;
  SamNormal         normal;
  SamTangential     tangential;
  SamConditions     conditions;
  SamState          own;
  SamGrid           other;

  (void)state;
  usual_free  = PetscTrFree;
  PetscTrFree = Free;
  sam_call(SamBodyCreate(1, &steel, &body));
  sam_call(SamPairCreate(body, body, &pair));
  sam_call(SamLawCreate(c.s.elasticity, SAM_LAW_HARDNESS, &law));
  sam_call(SamNormalCreate(c.s.elasticity, &normal));
  sam_call(SamTangentialCreate(c.s.elasticity, &tangential));
  sam_call(SamConditionsCreate(&conditions));
  sam_call(SamStateCreate(c.s.grid, &own));
  other = (SamGrid)(void *)gap;
  sam_says(SamGridDestroy(&other), PETSC_ERR_ARG_WRONG, "Argument # 1 is not a SamGrid");
  DESTROYS(SamPairDestroy, &pair);
  DESTROYS(SamBodyDestroy, &body);
  DESTROYS(SamLawDestroy, &law);
  DESTROYS(SamNormalDestroy, &normal);
  DESTROYS(SamTangentialDestroy, &tangential);
  DESTROYS(SamGapDestroy, &gap);
  left    = -1;
  watched = conditions;
  sam_call(SamConditionsDestroy(&conditions));
  sam_assert(left == 0);
  left    = -1;
  watched = own;
  sam_call(SamStateDestroy(&own));
  sam_assert(left == 0);
  DESTROYS(SamContactDestroy, &c.contact);
  DESTROYS(SamProblemDestroy, &c.problem);
  DESTROYS(SamElasticityDestroy, &c.s.elasticity);
  DESTROYS(SamGridDestroy, &c.s.grid);
  PetscTrFree = usual_free;
  sam_call(VecDestroy(&c.s.h));
}

/* ---- contacts in other programs ---- */

#define OPTIONS \
  "-body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3 -gap_type sphere -gap_radius1 0.1 " \
  "-gap_radius2 inf -grid_n 12 -grid_size 3e-3 -friction 0.3"

/* All functions answer for a contact that does not exist, and for none. */
static void AssertNoContact(petsam_contact *none, const char words[])
{
  int    shape[4], count, n[2];
  double values[36];

  sam_assert(petsam_commit(none) == 2 && Says(NULL, "petsam_commit: the contact ") && Says(none, words));
  sam_assert(petsam_grid(none, n, NULL, NULL, NULL, NULL) == 2 && Says(none, words));
  sam_assert(petsam_set_field(none, "gap", values) == 2 && petsam_get_field(none, "gap", values) == 2);
  sam_assert(petsam_try(none, 0, "load_n", values, NULL, NULL) == 2);
  sam_assert(petsam_history(none, "load_n", 0, values, NULL, NULL) == 2);
  sam_assert(petsam_live(none, 1, "load_n", 0, values, NULL, NULL) == 2);
  sam_assert(petsam_advise(none, &count) == 2 && petsam_reject(none) == 2 && petsam_stiffness(none, 0, values) == 2);
  sam_assert(petsam_get_number(none, "load_n", values) == 2 && petsam_record(none, 1) == 2);
  sam_assert(petsam_stress(none, "", shape) == 2 && petsam_fatigue(none, "", shape) == 2);
  sam_assert(petsam_get_stress(none, "x", values) == 2 && petsam_save(none, "x") == 2 && petsam_load(none, "x") == 2);
  sam_assert(petsam_copy(none, none) == 2 && petsam_reset(none) == 2 && Says(NULL, words));
  sam_assert(!petsam_step_name(none, 0, NULL) && !petsam_warning(none, 0) && !petsam_field_name(none, 0));
  sam_assert(!petsam_number_name(none, 0) && !petsam_stress_name(none, 0, NULL));
}

static void test_contacts_of_other_programs(void **state)
{
  petsam_contact *other = NewContact(World(), OPTIONS), *one = NewContact(World(), OPTIONS), *copy = one;
  double          value;

  (void)state;
  AssertNoContact(NULL, "the contact is NULL");
  petsam_destroy(&one);
  AssertNoContact(copy, "the contact has been destroyed, or is none");
  sam_assert(petsam_copy(other, copy) == 2 && Says(other, "the contact to copy has been destroyed"));
  petsam_destroy(&copy);
  sam_assert(!one && !copy && Says(NULL, "petsam_destroy: the contact has been destroyed"));
  sam_assert(petsam_get_number(other, NULL, &value) == 2 && Says(other, "petsam_get_number: a pointer is NULL"));
  sam_assert(petsam_get_number(other, "load_n", NULL) == 2 && Says(other, "petsam_get_number: a pointer is NULL"));
  sam_assert(petsam_copy(other, NULL) == 2 && Says(other, "petsam_copy: a pointer is NULL"));
  sam_assert(petsam_reset(other) == 0);
  petsam_destroy(&other);
  petsam_destroy(&other);
  petsam_destroy(NULL);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_bodies_and_grid),
    cmocka_unit_test(test_elasticity_and_gap),
    cmocka_unit_test(test_solvers),
    cmocka_unit_test(test_problem_and_laws),
    cmocka_unit_test(test_contact_and_state),
    cmocka_unit_test(test_options_and_parameters),
    cmocka_unit_test(test_destroyed_objects_have_no_class),
    cmocka_unit_test(test_contacts_of_other_programs),
  };

  return SamTestMainWith(argc, argv, Create, tests, sizeof(tests) / sizeof(tests[0]));
}

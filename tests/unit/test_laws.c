/*
 * The list of laws of a problem: their order, what one law says once, and what several say together.
 */
#include "contacts.h"

#include <petsam/private/problemimpl.h>
#include <petsam/wear.h>

#define N     24
#define LIMIT 0.7 /* of the largest Hertzian pressure */

static PetscErrorCode LimitAtHalf(SamLaw law, PetscReal *most)
{
  (void)law;
  *most = 0.5e9;
  return PETSC_SUCCESS;
}

static PetscErrorCode LimitAtTwo(SamLaw law, PetscReal *most)
{
  (void)law;
  *most = 2e9;
  return PETSC_SUCCESS;
}

static PetscErrorCode CreateHalf(SamLaw law)
{
  law->ops.limit = LimitAtHalf;
  return PETSC_SUCCESS;
}

static PetscErrorCode CreateTwo(SamLaw law)
{
  law->ops.limit = LimitAtTwo;
  return PETSC_SUCCESS;
}

/* Laws act in the order in which their types were registered, whatever the order in which they are added. */
static void test_laws_stand_in_the_order_of_their_types(void **state)
{
  static const char *const        added[]    = {SAM_LAW_ACCUMULATED_SLIP, SAM_LAW_HARDNESS, SAM_LAW_ARCHARD},
                           *const expected[] = {SAM_LAW_COULOMB, SAM_LAW_BULK_STRESS, SAM_LAW_ARCHARD, SAM_LAW_HARDNESS,
                                                SAM_LAW_ACCUMULATED_SLIP};
  Case                            c          = NewCase(Steel(), N, 1.5, MU, "");
  const SamLaw                   *laws;
  PetscInt                        count;

  (void)state;
  for (int k = 0; k < 3; k++) sam_call(SamProblemAddLawOfType(c.problem, added[k], NULL));
  sam_call(SamProblemGetLaws(c.problem, &count, &laws));
  sam_assert(count == 5);
  for (int k = 0; k < 5; k++) sam_assert(!strcmp(laws[k]->type, expected[k]));
  DestroyCase(&c);
}

static void test_problem_has_one_law_of_a_type(void **state)
{
  Case      c = NewCase(Steel(), N, 1.5, MU, "");
  PetscReal friction;
  SamLaw    one, two, other;

  (void)state;
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_HARDNESS, &one));
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_HARDNESS, &two));
  sam_assert(one == two);
  sam_call(SamLawCreate(c.s.elasticity, SAM_LAW_HARDNESS, &other));
  sam_fails(SamProblemAddLaw(c.problem, other), PETSC_ERR_ARG_WRONG);
  sam_fails(SamLawGetFriction(other, &friction), PETSC_ERR_ARG_WRONG);
  sam_fails(SamLawSetWear(other, (double[]){1, 1}), PETSC_ERR_ARG_WRONG);
  sam_call(SamLawDestroy(&other));
  sam_fails(SamLawCreate(c.s.elasticity, "glue", &other), PETSC_ERR_ARG_UNKNOWN_TYPE);
  DestroyCase(&c);
}

static void test_lowest_limit_counts(void **state)
{
  Case      c = NewCase(Steel(), N, 1.5, MU, "");
  PetscReal limit;
  SamLaw    law;

  (void)state;
  sam_call(SamProblemGetPressureLimit(c.problem, &limit));
  sam_assert(isinf(limit));
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_HARDNESS, &law));
  sam_call(SamLawSetHardness(law, 1e9));
  sam_call(SamLawRegister("half", CreateHalf));
  sam_call(SamLawRegister("two", CreateTwo));
  sam_call(SamProblemAddLawOfType(c.problem, "half", NULL));
  sam_call(SamProblemAddLawOfType(c.problem, "two", NULL));
  sam_call(SamProblemGetPressureLimit(c.problem, &limit));
  sam_assert(limit == 0.5e9);
  DestroyCase(&c);
}

/* Setters of laws raise the revision, so that the pressure is solved again. */
static void test_revision_follows_the_laws(void **state)
{
  Case             c = NewCase(Steel(), N, 1.5, MU, "");
  PetscObjectState before, after;
  SamLaw           hardness, wear;

  (void)state;
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_HARDNESS, &hardness));
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_ARCHARD, &wear));
  sam_call(SamProblemGetRevision(c.problem, &before));
  sam_call(SamLawSetHardness(hardness, 1e9));
  sam_call(SamProblemGetRevision(c.problem, &after));
  sam_assert(after > before);
  sam_call(SamLawSetHardness(hardness, 1e9));
  sam_call(SamProblemGetRevision(c.problem, &before));
  sam_assert(after == before);
  sam_call(SamLawSetWear(wear, (double[]){1e-14, 0}));
  sam_call(SamProblemGetRevision(c.problem, &after));
  sam_assert(after > before);
  DestroyCase(&c);
}

static double Overlap(const Case *c)
{
  Vec      overlap = NewField(c->s.grid, 1);
  SamState s;
  double   most;

  sam_call(SamContactGetState(c->contact, &s));
  sam_call(SamProblemAddSeparation(c->problem, s, SAM_COMMITTED, overlap, NULL));
  sam_call(VecScale(overlap, -1));
  sam_call(SamProblemAddSeparation(c->problem, s, SAM_TRIED, overlap, NULL));
  most = Norm(overlap, NORM_INFINITY);
  sam_call(VecDestroy(&overlap));
  return most;
}

/* Only the tried step's yielding is overlap, not the depth that there was before. */
static void test_overlap_is_that_of_the_step(void **state)
{
  Case       c      = NewCase(Steel(), N, 1.5, MU, "");
  SamControl loaded = Loads(&c, 1, 0, 0, 0), unloaded = Loads(&c, 0.5, 0, 0, 0);
  SamLaw     hardness;

  (void)state;
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_HARDNESS, &hardness));
  sam_call(SamLawSetHardness(hardness, LIMIT * c.s.p0));
  (void)Try(&c, &loaded);
  sam_assert(Overlap(&c) > 0);
  sam_call(SamContactCommit(c.contact));
  sam_assert(NumberOf(&c, "plastic_depth_max") > 0);
  (void)Try(&c, &unloaded);
  sam_assert(Overlap(&c) == 0);
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_laws_stand_in_the_order_of_their_types),
                                     cmocka_unit_test(test_problem_has_one_law_of_a_type),
                                     cmocka_unit_test(test_lowest_limit_counts),
                                     cmocka_unit_test(test_revision_follows_the_laws),
                                     cmocka_unit_test(test_overlap_is_that_of_the_step)};

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Arguments of the library's functions that belong to other ranks: an error at once on all ranks, and no wait for ever.
 */
#include "contacts.h"

#include <petsam/gap.h>
#include <petsam/normal.h>
#include <petsam/private/elasticity.h>
#include <petsam/tangential.h>

static Case c; /* a contact of all ranks, and one of each rank for itself */
static struct {
  SamGrid       grid;
  SamElasticity elasticity;
  SamProblem    problem;
  SamState      state;
  SamLaw        law;
  SamGap        gap;
  Vec           one, two;
} own;
static SamGap gap;
static Vec    one, two;

static int Create(void **state)
{
  (void)state;
  c = NewCase(Steel(), 12, 2, MU, "");
  sam_call(SamGapCreate(PETSC_COMM_WORLD, &gap));
  sam_call(SamGapSetType(gap, SAM_GAP_FLAT));
  one      = NewField(c.s.grid, 1);
  two      = NewField(c.s.grid, 2);
  own.grid = NewGridOn(PETSC_COMM_SELF, 12, 12, 1, 1, 0, 0);
  sam_call(SamElasticityCreate(own.grid, SamElasticityGetPair(c.s.elasticity), &own.elasticity));
  sam_call(SamProblemCreate(own.elasticity, &own.problem));
  sam_call(SamStateCreate(own.grid, &own.state));
  sam_call(SamLawCreate(own.elasticity, SAM_LAW_SLIDE, &own.law));
  sam_call(SamGapCreate(PETSC_COMM_SELF, &own.gap));
  own.one = NewField(own.grid, 1);
  own.two = NewField(own.grid, 2);
  return 0;
}

/* A single rank has the same ranks alone as with all others: nothing is wrong then. */
#define DIFFER(n, m, petsc_call_expr) \
  if (SamRanks_() > 1) \
  sam_says(petsc_call_expr, PETSC_ERR_ARG_NOTSAMECOMM, "Different communicators: arguments # " #n " and # " #m)

static void test_fields_of_a_grid(void **state)
{
  PetscReal norm;

  (void)state;
  DIFFER(1, 2, SamGridNorm(c.s.grid, own.one, NORM_2, &norm));
  DIFFER(1, 2, SamGridNorm(own.grid, one, NORM_2, &norm));
  DIFFER(1, 2, SamGapFill(gap, own.grid, own.one));
  DIFFER(1, 3, SamGapFill(gap, c.s.grid, own.one));
  DIFFER(1, 2, SamGapFill(own.gap, c.s.grid, one));
  sam_call(SamGridNorm(own.grid, own.one, NORM_2, &norm));
  sam_assert(norm == 0);
}

static void test_products(void **state)
{
  (void)state;
  DIFFER(1, 2, SamElasticityApplyNormal(c.s.elasticity, own.one, one));
  DIFFER(1, 3, SamElasticityApplyNormal(c.s.elasticity, one, own.one));
  DIFFER(1, 2, SamElasticityApplyNormal(own.elasticity, one, own.one));
  DIFFER(1, 3, SamElasticityApplyTangential(c.s.elasticity, two, own.two));
  DIFFER(1, 2, SamElasticityApplyNormalToTangential(c.s.elasticity, own.one, two));
  DIFFER(1, 3, SamElasticityApplyTangentialToNormal(own.elasticity, own.two, one));
}

static void test_problem_and_its_laws(void **state)
{
  SamSolution solution = {.pressure = one};
  SamCheck    check;

  (void)state;
  DIFFER(1, 2, SamProblemSetGap(c.problem, own.one));
  DIFFER(1, 2, SamProblemSetGap(own.problem, one));
  DIFFER(1, 2, SamProblemSetFrictionField(c.problem, own.one));
  DIFFER(1, 2, SamProblemAddLaw(c.problem, own.law));
  DIFFER(1, 3, SamLawSetSurface(own.law, 0, one));
  DIFFER(1, 2, SamCheckSolution(c.problem, own.state, PETSC_TRUE, PETSC_FALSE, NULL, &solution, &check));
  sam_call(SamLawSetSurface(own.law, 0, own.one));
}

static void test_solvers_and_contact(void **state)
{
  SamBalance    normal_balance = {.kind = SAM_BALANCE_NORMAL}, balance = {.kind = SAM_BALANCE_TANGENTIAL};
  SamNormal     normal;
  SamTangential tangential;

  (void)state;
  sam_call(SamNormalCreate(c.s.elasticity, &normal));
  sam_call(SamTangentialCreate(c.s.elasticity, &tangential));
  DIFFER(1, 2, SamNormalSolve(normal, own.one, &normal_balance, PETSC_FALSE, one));
  DIFFER(1, 5, SamNormalSolve(normal, one, &normal_balance, PETSC_FALSE, own.one));
  DIFFER(1, 2, SamTangentialSolve(tangential, own.one, NULL, &balance, PETSC_FALSE, two));
  DIFFER(1, 3, SamTangentialSolve(tangential, one, own.two, &balance, PETSC_FALSE, two));
  DIFFER(1, 6, SamTangentialSolve(tangential, one, NULL, &balance, PETSC_FALSE, own.two));
  DIFFER(1, 3, SamContactGetField(c.contact, "pressure", own.one));
  sam_call(SamTangentialDestroy(&tangential));
  sam_call(SamNormalDestroy(&normal));
}

/* The same ranks in the same order may have any number of communicators; in another order they hold other rows. */
static void test_communicators_of_the_same_ranks(void **state)
{
  MPI_Comm  same, turned;
  SamGrid   grid;
  Vec       h;
  PetscReal norm;
  int       rank;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_dup(PETSC_COMM_WORLD, &same);
  MPI_Comm_split(PETSC_COMM_WORLD, 0, -rank, &turned);
  grid = NewGridOn(same, 12, 12, 1, 1, 0, 0);
  h    = NewField(grid, 1);
  sam_call(SamProblemSetGap(c.problem, h));
  sam_destroy(&h);
  sam_call(SamGridDestroy(&grid));
  grid = NewGridOn(turned, 12, 12, 1, 1, 0, 0);
  h    = NewField(grid, 1);
  DIFFER(1, 2, SamGridNorm(c.s.grid, h, NORM_1, &norm));
  DIFFER(1, 2, SamGapFill(gap, grid, h));
  sam_destroy(&h);
  sam_call(SamGridDestroy(&grid));
  MPI_Comm_free(&turned);
  MPI_Comm_free(&same);
}

/* The last of the tests. */
static void test_objects_end(void **state)
{
  (void)state;
  sam_destroy(&own.one, &own.two, &one, &two);
  sam_call(SamGapDestroy(&own.gap));
  sam_call(SamLawDestroy(&own.law));
  sam_call(SamStateDestroy(&own.state));
  sam_call(SamProblemDestroy(&own.problem));
  sam_call(SamElasticityDestroy(&own.elasticity));
  sam_call(SamGridDestroy(&own.grid));
  sam_call(SamGapDestroy(&gap));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_fields_of_a_grid),
    cmocka_unit_test(test_products),
    cmocka_unit_test(test_problem_and_its_laws),
    cmocka_unit_test(test_solvers_and_contact),
    cmocka_unit_test(test_communicators_of_the_same_ranks),
    cmocka_unit_test(test_objects_end),
  };

  return SamTestMainWith(argc, argv, Create, tests, sizeof(tests) / sizeof(tests[0]));
}

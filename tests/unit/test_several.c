/*
 * Several contacts in one process, solved in turn or at the same time: each is as if it were alone.
 */
#include "contacts.h"
#include <petsam/private/state.h>

enum { STEPS = 3, BODIES = 2, N = 45 };

static Case NewBodiesOn(MPI_Comm comm, int kind, const char *prefix, const char *options)
{
  return NewCaseOn(NewSphereOn(comm, kind ? Dissimilar() : Steel(), N, 2, 0, 0), MU, prefix, options);
}

static SamStep StepOf(const Case *c, int kind, int k)
{
  const SamControl control = Loads(c, 1 - 0.1 * kind, 0.2 * (k + 1), 0.1, 0);

  return Solve(c, &control);
}

/*
  Pressure, shear and numbers after each step, on all ranks: what is on several ranks can be compared to what is on one.
*/
typedef struct {
  double  *pressure[STEPS], *shear[STEPS], number[STEPS][SAM_STATE_NUMBERS];
  PetscInt numbers;
  SamStep  step[STEPS];
} Record;

static void Keep(const Case *c, int k, SamStep step, Record *r)
{
  SamState state;

  sam_call(SamContactGetState(c->contact, &state));
  r->numbers = SamStateCountValues(state);
  memcpy(r->number[k], SamStateNumbers(state, 0, SAM_COMMITTED), sizeof(double) * (size_t)r->numbers);
  r->step[k]     = step;
  r->pressure[k] = Whole(c->s.grid, 1, SolutionOf(c)->pressure);
  r->shear[k]    = Whole(c->s.grid, 2, SolutionOf(c)->shear);
}

static void DestroyRecord(Record *r)
{
  for (int k = 0; k < STEPS; k++) {
    free(r->pressure[k]);
    free(r->shear[k]);
  }
}

/* The contact by itself, on each rank alone. */
static Record Alone(int kind, const char *options)
{
  Case   c = NewBodiesOn(PETSC_COMM_SELF, kind, NULL, options);
  Record r;

  for (int k = 0; k < STEPS; k++) Keep(&c, k, StepOf(&c, kind, k), &r);
  DestroyCase(&c);
  return r;
}

static void AssertSameRecords(const Record *a, const Record *b)
{
  for (int k = 0; k < STEPS; k++) {
    sam_assert(!memcmp(a->pressure[k], b->pressure[k], sizeof(double) * N * N));
    sam_assert(!memcmp(a->shear[k], b->shear[k], sizeof(double) * 2 * N * N));
    sam_assert(a->numbers == b->numbers && SameNumbers(a->numbers, a->number[k], b->number[k]));
    AssertSameOutcomes(&a->step[k], &b->step[k]);
  }
}

/* Each reads its own options; their steps alternate. */
static void test_contacts_with_different_prefixes_do_not_disturb_each_other(void **state)
{
  static const char *const prefixes[BODIES] = {"one_", "other_"};
  static const char *const options          = "-one_coupling none -one_normal_rtol 1e-6 -other_coupling_rtol 1e-4 "
                                              "-other_tangential_rtol 1e-5 -normal_rtol 0.1 -coupling_max_it 1";
  Case                     cases[BODIES];
  Record                   together[BODIES], alone[BODIES];

  (void)state;
  for (int b = 0; b < BODIES; b++) cases[b] = NewBodiesOn(PETSC_COMM_WORLD, b, prefixes[b], options);
  for (int k = 0; k < STEPS; k++)
    for (int b = 0; b < BODIES; b++) Keep(&cases[b], k, StepOf(&cases[b], b, k), &together[b]);
  alone[0] = Alone(0, "-coupling none -normal_rtol 1e-6");
  alone[1] = Alone(1, "-coupling_rtol 1e-4 -tangential_rtol 1e-5");
  for (int b = 0; b < BODIES; b++) {
    sam_assert(together[b].step[STEPS - 1].status == SAM_STATUS_CONVERGED);
    AssertSameRecords(&together[b], &alone[b]);
    DestroyRecord(&together[b]);
    DestroyRecord(&alone[b]);
    DestroyCase(&cases[b]);
  }
}

/* One elasticity and one problem for two contacts: each has its own part of the grid, and its own slip. */
static void test_contacts_of_one_problem_do_not_disturb_each_other(void **state)
{
  static const double sizes[2] = {0.1, 1.2};

  (void)state;
  for (int kind = 0; kind < BODIES; kind++) {
    Case shared = NewBodiesOn(PETSC_COMM_WORLD, kind, NULL, ""), second = shared, own[2];

    sam_call(SamContactCreate(shared.problem, &second.contact));
    own[0] = NewBodiesOn(PETSC_COMM_WORLD, kind, NULL, "");
    own[1] = NewBodiesOn(PETSC_COMM_WORLD, kind, NULL, "");
    for (int k = 0; k < STEPS; k++)
      for (int b = 0; b < 2; b++) {
        const SamControl control = Loads(&shared, sizes[b], 0.2 * (k + 1) * sizes[b], 0, 0);
        const SamStep    one = Solve(b ? &second : &shared, &control), other = Solve(&own[b], &control);

        sam_assert(one.status == SAM_STATUS_CONVERGED);
        AssertSameSteps(b ? &second : &shared, &one, &own[b], &other);
        AssertSameFields(b ? &second : &shared, &own[b]);
      }
    sam_call(SamContactDestroy(&second.contact));
    DestroyCase(&shared);
    DestroyCase(&own[0]);
    DestroyCase(&own[1]);
  }
}

/* Two parts of the ranks have a contact each, and solve them at the same time. */
static void test_contacts_on_parts_of_the_ranks_are_as_alone(void **state)
{
  Record   alone[BODIES], here;
  MPI_Comm part;
  Case     c;
  int      rank, ranks, kind;

  (void)state;
  for (int b = 0; b < BODIES; b++) alone[b] = Alone(b, "");
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  kind = rank < (ranks + 1) / 2 ? 1 : 0; /* on 3 ranks: 2 and 1 */
  (void)MPI_Comm_split(PETSC_COMM_WORLD, kind, rank, &part);
  c = NewBodiesOn(part, kind, NULL, "");
  for (int k = 0; k < STEPS; k++) Keep(&c, k, StepOf(&c, kind, k), &here);
  AssertSameRecords(&here, &alone[kind]);
  DestroyRecord(&here);
  for (int b = 0; b < BODIES; b++) DestroyRecord(&alone[b]);
  DestroyCase(&c);
  (void)MPI_Comm_free(&part);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_contacts_with_different_prefixes_do_not_disturb_each_other),
    cmocka_unit_test(test_contacts_of_one_problem_do_not_disturb_each_other),
    cmocka_unit_test(test_contacts_on_parts_of_the_ranks_are_as_alone),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

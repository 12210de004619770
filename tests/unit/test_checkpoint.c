/*
 * The state of a contact in a file: what is read is what was written, on any number of ranks. Checksums depend on the
 * values, and not on how the cells lie on the ranks.
 */
#include "checkpoints.h"
#include <petsam/private/grid.h>
#include <petsam/private/state.h>

/* ---- checksums ---- */

static uint64_t ChecksumOn(MPI_Comm comm, int swap)
{
  SamGrid  grid  = NewGridOn(comm, 13, 7, 1, 1, 0, 0);
  Vec      field = NewField(grid, 2);
  uint64_t checksum;
  double  *values;

  sam_call(VecGetArray(field, &values));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < grid->nx; i++) {
        const PetscInt row   = grid->row_start + j,
                       other = swap && row == 3 && i < 2 ? 1 - i : i; /* two cells change places */

        values[c * grid->cells + j * grid->nx + i] = Random(1, c, other, row);
      }
  sam_call(VecRestoreArray(field, &values));
  sam_call(SamGridChecksum(grid, field, &checksum));
  sam_call(VecDestroy(&field));
  sam_call(SamGridDestroy(&grid));
  return checksum;
}

static void test_checksum_is_that_of_the_field_not_of_its_ranks(void **state)
{
  (void)state;
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 0) == ChecksumOn(PETSC_COMM_SELF, 0));
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 1) == ChecksumOn(PETSC_COMM_SELF, 1));
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 0) != ChecksumOn(PETSC_COMM_WORLD, 1));
}

/* ---- files ---- */

static void test_contact_that_is_read_goes_on_as_the_one_that_was_written(void **state)
{
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int solved = 0; solved < 4; solved++) {
    Case          one = NewBody(), other = NewBody();
    uint64_t      written[3] = {1, UINT64_MAX, 42}, read[3] = {0};
    const SamNote to[2]   = {{"first", 2, written}, {"second", 1, &written[2]}},
                  from[2] = {{"second", 1, &read[2]}, {"first", 2, read}};
    SamStep a, b;

    for (int k = 0; k < solved; k++) SolveStep(&one, k, &a);
    SolveStep(&other, 3, &b); /* is forgotten */
    Write(&one, &parameters, 2, to);
    sam_call(
      SamCheckpointRead(filename, other.contact, PETSC_TRUE, &(SamCheckpointRest){&parameters, 2, from, 0, NULL}));
    sam_assert(!memcmp(read, written, sizeof(read)));
    if (solved) AssertSameFields(&one, &other);
    for (int k = solved; k < 5; k++) {
      SolveStep(&one, k, &a);
      SolveStep(&other, k, &b);
      AssertSameSteps(&one, &a, &other, &b);
      AssertSameFields(&one, &other);
    }
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

static SamState StateOf(const Case *c)
{
  SamState state;

  sam_call(SamContactGetState(c->contact, &state));
  return state;
}

static int IsGapCurrent(const Case *c)
{
  PetscBool current;

  sam_call(SamContactIsGapCurrent(c->contact, &current));
  return current ? 1 : 0;
}

/* A committed number that a contact remembers. */
static double KeptOf(const Case *c, const char *name)
{
  return *SamStateNumbers(StateOf(c), SamStateFindNumber(StateOf(c), name), SAM_COMMITTED);
}

/* The part of the grid that the committed step was solved on: first cell and size. */
static const double *PlaceOf(const Case *c)
{
  return SamStateNumbers(StateOf(c), SamStateFindNumber(StateOf(c), "window"), SAM_COMMITTED);
}

/* All that is kept, of both generations, to the last bit; returns how many fields that are. */
static int AssertSameStates(const Case *one, const Case *other)
{
  const SamState a = StateOf(one), b = StateOf(other);
  int            fields = 0;

  for (PetscInt k = 0; k < SamStateCountFields(a); k++)
    for (PetscInt g = SAM_COMMITTED; g < SamStateFieldOf(a, k)->generations && SamStateFieldOf(a, k)->kept; g++) {
      const PetscInt same = SamStateFindField(b, SamStateFieldOf(a, k)->name);

      sam_assert(SameBits(SamStateGetField(a, k, (SamGeneration)g), SamStateGetField(b, same, (SamGeneration)g)));
      fields++;
    }
  for (PetscInt k = 0; k < SamStateCountNumbers(a); k++)
    for (PetscInt g = SAM_COMMITTED; g < SAM_GENERATIONS; g++) {
      PetscInt              id;
      const SamStateNumber *number = SamStateNumberOf(a, k, &id);

      if (number->kept)
        sam_assert(SameNumbers(number->count, SamStateNumbers(a, id, (SamGeneration)g),
                               SamStateNumbers(b, SamStateFindNumber(b, number->name), (SamGeneration)g)));
    }
  return fields;
}

static void test_state_in_the_file_is_the_committed_one(void **state)
{
  static const char *const conditions[] = {"friction_scale", "bulk1_stress_xy", "bulk2_stress_yy"};
  static const double      values[]     = {0.9, 1e6, -2e6};

  const SamParameters parameters = NewParameters(friction);
  Case                one = NewBody(), other = NewBody();
  const SamControl    control = Loads(&one, 1, -0.2, 0, 0);
  SamControl          second  = Loads(&one, 0.5, 0.2, 0, 0);
  const SamControl   *read;
  const double       *before;
  SamStep             step;

  (void)state;
  SolveStep(&one, 0, &step);
  Displace(&second, SAM_COMPONENT_MZ, 1e-6);
  second.time = 2.5;
  for (int k = 0; k < 3; k++) Prescribe(one.problem, &second, conditions[k], values[k]);
  (void)Solve(&one, &second);
  (void)Try(&one, &control);
  Write(&one, &parameters, 0, NULL);
  sam_call(SamCheckpointRead(filename, other.contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters}));
  sam_call(SamContactReject(one.contact));
  AssertSameFields(&one, &other);
  sam_assert(AssertSameStates(&one, &other) == 9);
  sam_assert(PlaceOf(&one)[2] > 0 && SameNumbers(4, PlaceOf(&one), PlaceOf(&other)));
  sam_assert(KeptOf(&other, "steps") == 2 && IsGapCurrent(&one) && IsGapCurrent(&other));
  read = &SolutionOf(&other)->control;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    sam_assert(read->value[k] == second.value[k] && read->force[k] == second.force[k] &&
               SolutionOf(&one)->load[k] == SolutionOf(&other)->load[k] &&
               SolutionOf(&one)->rigid[k] == SolutionOf(&other)->rigid[k]);
  sam_assert(read->time == 2.5 && Prescribed(other.problem, read, "bulk1_stress_xx") == 0);
  for (int k = 0; k < 3; k++) {
    const PetscInt id = SamStateFindNumber(StateOf(&other), conditions[k]);

    sam_assert(Prescribed(other.problem, read, conditions[k]) == values[k]);
    sam_assert(*SamStateNumbers(StateOf(&other), id, SAM_BEFORE) == (k ? 0 : 1));
  }
  before = SamStateNumbers(StateOf(&other), SamStateFindNumber(StateOf(&other), "control"), SAM_BEFORE);
  sam_assert(before[0] == 0 && before[1 + SAM_COMPONENTS + SAM_COMPONENT_N] == 0.25 * one.s.N);
  DestroyCase(&one);
  DestroyCase(&other);
  Remove();
}

/* In the problem that wrote the state after its last step, in the one that is given it, or in both alike. */
static void test_gap_that_has_changed_is_told(void **state)
{
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int which = 0; which < 4; which++) {
    Case    one = NewBody(), other = NewBody();
    SamStep step;
    Vec     gap;

    SolveStep(&one, 3, &step);
    gap = SamProblemGetGap(one.problem);
    if (which & 1) AddAt(one.s.grid, 0, 36, 36, 1e-9, gap);
    gap = SamProblemGetGap(other.problem);
    if (which & 2) AddAt(one.s.grid, 0, 36, 36, 1e-9, gap);
    Write(&one, &parameters, 0, NULL);
    sam_call(SamCheckpointRead(filename, other.contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters}));
    sam_assert(IsGapCurrent(&other) == (which ? 0 : 1));
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

/* ---- what only one of the two contacts remembers ---- */

/* Declares a field, which is 5 everywhere so far. */
static void DeclareOther(const Case *c, PetscBool optional)
{
  const SamStateField field = {"other_field", "m", "of another law", 1, 2, PETSC_TRUE, optional, SAM_RESULT_NONE,
                               SAM_STAYS,     0,   PETSC_FALSE};
  PetscInt            id;
  Vec                 values;

  sam_call(SamStateDeclareField(StateOf(c), &field, &id));
  sam_call(SamStateRestoreField(StateOf(c), id, SAM_COMMITTED, &values));
  sam_call(VecSet(values, 5));
}

static double LargestOf(const Case *c, const char *field)
{
  PetscReal most;

  sam_call(
    VecNorm(SamStateGetField(StateOf(c), SamStateFindField(StateOf(c), field), SAM_COMMITTED), NORM_INFINITY, &most));
  return (double)most;
}

static PetscErrorCode Read(const Case *c)
{
  const SamParameters parameters = NewParameters(friction);
  PetscErrorCode      ierr;

  BeginCatching();
  ierr = SamCheckpointRead(filename, c->contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters});
  EndCatching();
  return ierr;
}

/* It cannot begin in the middle, unless it is optional: then it is zero. */
static void test_field_that_the_file_lacks_is_named(void **state)
{
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int optional = 0; optional < 2; optional++) {
    Case    one = NewBody(), other = NewBody();
    SamStep step;

    DeclareOther(&other, optional);
    SolveStep(&one, 0, &step);
    Write(&one, &parameters, 0, NULL);
    if (optional) {
      sam_assert(!Read(&other));
      AssertSameFields(&one, &other);
      sam_assert(LargestOf(&other, "other_field") == 0);
    } else {
      sam_assert(Read(&other) == SAM_ERR_USER && strstr(CaughtMessage(), "lacks other_field"));
      sam_assert(KeptOf(&other, "steps") == 0 && LargestOf(&other, "other_field") == 5);
    }
    Write(&other, &parameters, 0, NULL); /* has it */
    sam_assert(!Read(&other) && LargestOf(&other, "other_field") == (optional ? 0 : 5));
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

/* It would be lost, also if it is optional. */
static void test_field_that_only_the_file_has_is_named(void **state)
{
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int optional = 0; optional < 2; optional++) {
    Case    one = NewBody(), other = NewBody();
    SamStep step;

    DeclareOther(&one, optional);
    SolveStep(&one, 0, &step);
    Write(&one, &parameters, 0, NULL);
    sam_assert(Read(&other) == SAM_ERR_USER && strstr(CaughtMessage(), "has the field other_field"));
    sam_assert(KeptOf(&other, "steps") == 0);
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

static void test_number_that_the_file_lacks_is_named(void **state)
{
  static const SamStateNumber number = {
    "other_number", "m", "of another law", SAM_NUMBER_REAL, 2, PETSC_TRUE, PETSC_FALSE, SAM_JOIN_LAST, 0};
  const SamParameters parameters = NewParameters(friction);
  Case                one = NewBody(), other = NewBody();
  SamStep             step;
  PetscInt            id;

  (void)state;
  SolveStep(&one, 0, &step);
  Write(&one, &parameters, 0, NULL);
  sam_call(SamStateDeclareNumber(StateOf(&other), &number, &id));
  sam_assert(Read(&other) == SAM_ERR_USER && strstr(CaughtMessage(), "lacks other_number"));
  SamStateNumbers(StateOf(&other), id, SAM_COMMITTED)[1] = 6;
  Write(&other, &parameters, 0, NULL);
  SamStateNumbers(StateOf(&other), id, SAM_COMMITTED)[1] = 7;
  sam_assert(!Read(&other) && SamStateNumbers(StateOf(&other), id, SAM_COMMITTED)[1] == 6);
  DestroyCase(&one);
  DestroyCase(&other);
  Remove();
}

/*
  The contact that goes on accumulates it too, to the last bit, though nobody asked it to; not what the file lacks. One
  that is refused the file stays as it was.
*/
static void test_sum_in_the_file_goes_on(void **state)
{
  const SamParameters parameters = NewParameters(friction);
  Case                one = NewBody(), other = NewBody(), refused = NewBody();
  SamStep             a, b;
  SamLaw              law;

  (void)state;
  sam_call(SamProblemAddLawOfType(one.problem, SAM_LAW_ACCUMULATED_SLIP, NULL));
  for (int k = 0; k < 2; k++) SolveStep(&one, k, &a);
  Write(&one, &parameters, 0, NULL);
  DeclareOther(&refused, 0);
  sam_assert(Read(&refused) == SAM_ERR_USER && strstr(CaughtMessage(), "lacks other_field"));
  law = SamProblemGetLaw(refused.problem, SAM_LAW_ACCUMULATED_SLIP);
  sam_assert(!law);
  DestroyCase(&refused);
  sam_assert(!Read(&other));
  law = SamProblemGetLaw(other.problem, SAM_LAW_FRICTION_ENERGY);
  sam_assert(!law);
  sam_assert(AssertSameStates(&one, &other) == 10 && LargestOf(&other, "slip_path") > 0);
  for (int k = 2; k < 4; k++) {
    const double before = LargestOf(&other, "slip_path");

    SolveStep(&one, k, &a);
    SolveStep(&other, k, &b);
    AssertSameSteps(&one, &a, &other, &b);
    sam_assert(AssertSameStates(&one, &other) == 10 && LargestOf(&other, "slip_path") > before);
  }
  DestroyCase(&one);
  DestroyCase(&other);
  Remove();
}

/* A condition that the contact lacks must be as usual; one that the file lacks is. */
static void test_conditions_that_only_one_has_must_be_as_usual(void **state)
{
  const SamCondition  heat       = {.name = "heat", .unit = "K", .text = "of a test", .usual = 3};
  const SamParameters parameters = NewParameters(friction);

  (void)state;
  for (int given = 0; given < 2; given++) {
    Case           one = NewBody(), other = NewBody();
    SamControl     control = Loads(&one, 1, 0, 0, 0);
    SamConditions  conditions;
    PetscErrorCode ierr;

    conditions = SamProblemGetConditions(one.problem);
    sam_call(SamConditionsAdd(conditions, &heat, NULL));
    Prescribe(one.problem, &control, "heat", given ? 2 : 3);
    (void)Solve(&one, &control);
    Write(&one, &parameters, 0, NULL);
    BeginCatching();
    ierr = SamCheckpointRead(filename, other.contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters});
    EndCatching();
    sam_assert(given ? ierr == SAM_ERR_USER && strstr(CaughtMessage(), "heat") : !ierr);
    control = Loads(&other, 1, 0, 0, 0);
    (void)Solve(&other, &control);
    Write(&other, &parameters, 0, NULL);
    sam_call(SamCheckpointRead(filename, one.contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters}));
    sam_assert(Prescribed(one.problem, &SolutionOf(&one)->control, "heat") == 3);
    DestroyCase(&one);
    DestroyCase(&other);
    Remove();
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_checksum_is_that_of_the_field_not_of_its_ranks),
    cmocka_unit_test(test_contact_that_is_read_goes_on_as_the_one_that_was_written),
    cmocka_unit_test(test_state_in_the_file_is_the_committed_one),
    cmocka_unit_test(test_gap_that_has_changed_is_told),
    cmocka_unit_test(test_field_that_the_file_lacks_is_named),
    cmocka_unit_test(test_field_that_only_the_file_has_is_named),
    cmocka_unit_test(test_number_that_the_file_lacks_is_named),
    cmocka_unit_test(test_sum_in_the_file_goes_on),
    cmocka_unit_test(test_conditions_that_only_one_has_must_be_as_usual),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

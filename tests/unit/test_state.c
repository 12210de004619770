/* The memory of a contact: declarations by name, generations, what is copied, and what is refused. */
#include "contacts.h"
#include <petsam/private/state.h>

static const SamStateField field3 = {.name        = "three",
                                     .unit        = "m",
                                     .text        = "kept for three generations",
                                     .components  = 2,
                                     .generations = 3,
                                     .kept        = PETSC_TRUE,
                                     .result      = SAM_RESULT_USUAL},
                           field2 = {.name = "two", .components = 1, .generations = 2, .kept = PETSC_TRUE};

static const SamStateNumber real    = {"real",     "N",          "a result", SAM_NUMBER_REAL, 1, PETSC_FALSE,
                                       PETSC_TRUE, SAM_JOIN_SUM, 0},
                            integer = {"integer",         "1", "a result", SAM_NUMBER_INT, 1, PETSC_FALSE, PETSC_TRUE,
                                       SAM_JOIN_GREATEST, 0},
                            matrix  = {"matrix",   "1",           "a result", SAM_NUMBER_MATRIX, 36, PETSC_FALSE,
                                       PETSC_TRUE, SAM_JOIN_LAST, 0},
                            kept    = {"kept",        "1", "is remembered", SAM_NUMBER_REAL, 2, PETSC_TRUE, PETSC_FALSE,
                                       SAM_JOIN_LAST, 0};

/* A state with two fields and four numbers, and their handles. */
typedef struct {
  SamGrid  grid;
  SamState state;
  PetscInt three, two, real, integer, matrix, kept;
} Memory;

static Memory NewMemoryOn(PetscInt nx, PetscInt ny)
{
  Memory m = {.grid = NewGrid(nx, ny, 1, 1)};

  sam_call(SamStateCreate(m.grid, &m.state));
  sam_call(SamStateDeclareField(m.state, &field3, &m.three));
  sam_call(SamStateDeclareField(m.state, &field2, &m.two));
  sam_call(SamStateDeclareNumber(m.state, &real, &m.real));
  sam_call(SamStateDeclareNumber(m.state, &integer, &m.integer));
  sam_call(SamStateDeclareNumber(m.state, &matrix, &m.matrix));
  sam_call(SamStateDeclareNumber(m.state, &kept, &m.kept));
  return m;
}

static Memory NewMemory(void)
{
  return NewMemoryOn(7, 11);
}

static void DestroyMemory(Memory *m)
{
  sam_call(SamStateDestroy(&m->state));
  sam_assert(!m->state);
  sam_call(SamGridDestroy(&m->grid));
}

/* Writes a constant to a tried field. */
static Vec Set(const Memory *m, PetscInt id, double value)
{
  Vec field;

  sam_call(SamStateSetField(m->state, id, &field));
  sam_call(VecSet(field, value));
  return field;
}

/* Whether a generation of a field is this constant. */
static int Is(const Memory *m, PetscInt id, SamGeneration g, double value)
{
  const Vec field = SamStateGetField(m->state, id, g);
  PetscReal least, most;

  sam_assert(field != NULL);
  sam_call(VecMin(field, NULL, &least));
  sam_call(VecMax(field, NULL, &most));
  return least == value && most == value;
}

/* A committed step with these values of both fields. */
static void Step(const Memory *m, double three, double two)
{
  sam_call(SamStateBegin(m->state));
  (void)Set(m, m->three, three);
  (void)Set(m, m->two, two);
  sam_call(SamStateCommit(m->state));
}

/* ---- declarations ---- */

static void test_same_declaration_gives_the_same_handle(void **state)
{
  Memory         m      = NewMemory();
  const PetscInt fields = SamStateCountFields(m.state), values = SamStateCountValues(m.state);
  PetscInt       id, place;

  (void)state;
  Step(&m, 1, 2);
  sam_call(SamStateDeclareField(m.state, &field2, &id));
  sam_assert(id == m.two && id != m.three && SamStateCountFields(m.state) == fields && fields == 2);
  sam_assert(Is(&m, m.two, SAM_COMMITTED, 2)); /* and keeps its values */
  *SamStateNumbers(m.state, m.kept, SAM_COMMITTED) = 5;
  sam_call(SamStateDeclareNumber(m.state, &kept, &id));
  sam_assert(id == m.kept && SamStateCountValues(m.state) == values && values == 1 + 1 + 36 + 2);
  sam_assert(*SamStateNumbers(m.state, m.kept, SAM_COMMITTED) == 5);
  /* those declared one after the other lie side by side, and are found by their names */
  sam_assert(m.integer == m.real + 1 && m.matrix == m.real + 2 && m.kept == m.matrix + 36);
  sam_assert(SamStateFindField(m.state, "two") == m.two && SamStateFindNumber(m.state, "matrix") == m.matrix);
  sam_assert(SamStateFindField(m.state, "real") < 0 && SamStateFindNumber(m.state, "two") < 0);
  sam_assert(SamStateNumberOf(m.state, 2, &place)->kind == SAM_NUMBER_MATRIX && place == m.matrix);
  DestroyMemory(&m);
}

/* Components of a field have names of their own; a field that is no result is not offered. */
static void test_results_are_the_components_of_fields(void **state)
{
  Memory   m    = NewMemory();
  Vec      work = NewField(m.grid, 1), holder, tried;
  PetscInt component;

  (void)state;
  sam_assert(SamStateCountResults(m.state) == 2);
  sam_assert(SamStateFindResult(m.state, "three_x") == 0 && SamStateFindResult(m.state, "three_y") == 1);
  sam_assert(SamStateFindResult(m.state, "three") < 0 && SamStateFindResult(m.state, "two") < 0);
  sam_assert(!strcmp(SamStateResultOf(m.state, 1)->unit, "m") && SamStateResultOf(m.state, 1)->use == SAM_RESULT_USUAL);
  sam_call(VecSet(work, 9));
  sam_call(SamStateFindValues(m.state, 1, work, &holder, &component));
  sam_assert(holder == work && Norm(work, NORM_INFINITY) == 0); /* no values yet */
  sam_call(SamStateBegin(m.state));
  tried = Set(&m, m.three, 4);
  sam_call(SamStateFindValues(m.state, 1, work, &holder, &component));
  sam_assert(holder == tried && component == 1);
  sam_call(VecDestroy(&work));
  DestroyMemory(&m);
}

/* Its layers are results of their own, and move with the surface. */
static void test_field_with_depth_has_its_layers(void **state)
{
  static const SamStateField below   = {.name        = "below",
                                        .unit        = "1",
                                        .text        = "strain, of body 2",
                                        .components  = 2,
                                        .generations = 2,
                                        .kept        = PETSC_TRUE,
                                        .result      = SAM_RESULT_OFFERED,
                                        .motion      = SAM_MOVES,
                                        .layers      = 3};
  static const char *const   names[] = {"below_1_x", "below_1_y", "below_2_x", "below_2_y", "below_3_x", "below_3_y"};
  Memory                     m       = NewMemory();
  Vec                        work    = NewField(m.grid, 1), field, holder;
  PetscInt                   id, component;

  (void)state;
  sam_call(SamStateDeclareField(m.state, &below, &id));
  sam_assert(SamStateFieldSize(&below) == 6 && SamStateFieldSize(&field3) == 2);
  for (PetscInt k = 0; k < 6; k++) sam_assert(SamStateFindResult(m.state, names[k]) == 2 + k);
  sam_assert(!strcmp(SamStateResultOf(m.state, 5)->text, "strain along y, of body 2, layer 2"));
  sam_call(SamStateBegin(m.state));
  sam_call(SamStateSetField(m.state, id, &field));
  sam_call(VecSet(field, 2));
  sam_call(SamStateFindValues(m.state, 6, work, &holder, &component));
  sam_assert(holder == field && component == 4);
  sam_call(SamStateCommit(m.state));
  sam_call(SamStateBegin(m.state));
  sam_call(SamStateMove(m.state, (const PetscReal[2]){m.grid->dx, 0}, PETSC_FALSE));
  sam_assert(Norm(SamStateGetField(m.state, id, SAM_COMMITTED), NORM_1) == 2. * 6 * 6 * 11); /* a column has left */
  sam_call(VecDestroy(&work));
  DestroyMemory(&m);
}

static void test_more_than_fits_is_refused(void **state)
{
  Memory         m    = NewMemory();
  SamStateNumber many = {"many",      "1",           "", SAM_NUMBER_REAL, SAM_STATE_NUMBERS, PETSC_FALSE,
                         PETSC_FALSE, SAM_JOIN_LAST, 0};
  char           names[SAM_STATE_MOST][16];
  PetscInt       id;

  (void)state;
  sam_fails(SamStateDeclareNumber(m.state, &many, &id), PETSC_ERR_ARG_OUTOFRANGE);
  sam_assert(SamStateFindNumber(m.state, "many") < 0);
  for (int k = 2; k <= SAM_STATE_MOST; k++) {
    SamStateField more = {.name = names[k - 2], .components = 1, .generations = 2};

    (void)snprintf(names[k - 2], sizeof(names[0]), "more%d", k);
    if (k < SAM_STATE_MOST)
      sam_call(SamStateDeclareField(m.state, &more, &id));
    else
      sam_fails(SamStateDeclareField(m.state, &more, &id), PETSC_ERR_ARG_OUTOFRANGE);
  }
  DestroyMemory(&m);
}

/* ---- generations ---- */

/* No vector is copied: the one of a generation is that of the next one after a commit. */
static void test_generations_rotate_by_pointer(void **state)
{
  Memory m = NewMemory();
  Vec    three[4], two[4];

  (void)state;
  for (int k = 0; k < 4; k++) {
    sam_call(SamStateBegin(m.state));
    three[k] = Set(&m, m.three, k);
    two[k]   = Set(&m, m.two, 10 + k);
    sam_assert(SamStateReadField(m.state, m.three) == three[k] && SamStateHasTried(m.state));
    sam_call(SamStateCommit(m.state));
    sam_assert(!SamStateHasTried(m.state) && !SamStateGetField(m.state, m.three, SAM_TRIED));
    sam_assert(SamStateGetField(m.state, m.three, SAM_COMMITTED) == three[k] && Is(&m, m.three, SAM_COMMITTED, k));
    sam_assert(SamStateGetField(m.state, m.two, SAM_COMMITTED) == two[k] && Is(&m, m.two, SAM_COMMITTED, 10 + k));
    sam_assert(SamStateGetField(m.state, m.three, SAM_BEFORE) == (k ? three[k - 1] : NULL));
    if (k) sam_assert(Is(&m, m.three, SAM_BEFORE, k - 1));
    sam_assert(!SamStateGetField(m.state, m.two, SAM_BEFORE)); /* of two generations */
  }
  sam_assert(three[3] == three[0] && two[2] == two[0] && two[1] != two[0]); /* three vectors, and two */
  DestroyMemory(&m);
}

static void test_field_that_is_not_set_keeps_its_values(void **state)
{
  Memory m = NewMemory();
  Vec    kept_vector;

  (void)state;
  Step(&m, 1, 2);
  kept_vector = SamStateGetField(m.state, m.two, SAM_COMMITTED);
  sam_call(SamStateBegin(m.state));
  (void)Set(&m, m.three, 3);
  sam_assert(!SamStateGetField(m.state, m.two, SAM_TRIED) && SamStateReadField(m.state, m.two) == kept_vector);
  sam_call(SamStateCommit(m.state));
  sam_assert(SamStateGetField(m.state, m.two, SAM_COMMITTED) == kept_vector && Is(&m, m.two, SAM_COMMITTED, 2));
  sam_assert(Is(&m, m.three, SAM_COMMITTED, 3) && Is(&m, m.three, SAM_BEFORE, 1));
  DestroyMemory(&m);
}

static void test_rejected_try_leaves_no_trace(void **state)
{
  Memory  m = NewMemory();
  Vec     committed, before;
  double *numbers;

  (void)state;
  sam_fails(SamStateCommit(m.state), PETSC_ERR_ORDER);
  Step(&m, 1, 2);
  Step(&m, 3, 4);
  SamStateNumbers(m.state, m.kept, SAM_COMMITTED)[0] = 7;
  *SamStateNumbers(m.state, m.real, SAM_COMMITTED)   = 8;
  committed                                          = SamStateGetField(m.state, m.three, SAM_COMMITTED);
  before                                             = SamStateGetField(m.state, m.three, SAM_BEFORE);
  for (int twice = 0; twice < 2; twice++) {
    sam_call(SamStateBegin(m.state));
    (void)Set(&m, m.three, 5);
    (void)Set(&m, m.two, 6);
    numbers                                  = SamStateNumbers(m.state, 0, SAM_TRIED);
    numbers[m.kept]                          = -1;
    numbers[m.real]                          = -1;
    *SamStateReadNumbers(m.state, m.integer) = -1;
    if (twice) sam_call(SamStateBegin(m.state)); /* another try rejects the first, too */
    sam_call(SamStateReject(m.state));
    sam_assert(!SamStateHasTried(m.state) && !SamStateGetField(m.state, m.three, SAM_TRIED));
    sam_assert(SamStateGetField(m.state, m.three, SAM_COMMITTED) == committed && Is(&m, m.three, SAM_COMMITTED, 3));
    sam_assert(SamStateGetField(m.state, m.three, SAM_BEFORE) == before && Is(&m, m.three, SAM_BEFORE, 1));
    sam_assert(SamStateReadField(m.state, m.three) == committed && Is(&m, m.two, SAM_COMMITTED, 4));
    sam_assert(*SamStateReadNumbers(m.state, m.kept) == 7 && *SamStateReadNumbers(m.state, m.real) == 8);
  }
  sam_fails(SamStateCommit(m.state), PETSC_ERR_ORDER);
  DestroyMemory(&m);
}

/* Of a step without a solution the numbers stay, and the fields are those of the committed one. */
static void test_fields_can_be_forgotten_without_the_numbers(void **state)
{
  Memory m = NewMemory();

  (void)state;
  Step(&m, 1, 2);
  sam_call(SamStateBegin(m.state));
  (void)Set(&m, m.two, 3);
  *SamStateNumbers(m.state, m.integer, SAM_TRIED) = 4;
  sam_call(SamStateForgetFields(m.state));
  sam_assert(SamStateReadField(m.state, m.two) == SamStateGetField(m.state, m.two, SAM_COMMITTED));
  sam_assert(Is(&m, m.two, SAM_COMMITTED, 2) && *SamStateReadNumbers(m.state, m.integer) == 4);
  DestroyMemory(&m);
}

/* Results of a try are not known at first; what is remembered starts from the committed values. */
static void test_numbers_begin_with_none(void **state)
{
  Memory        m = NewMemory();
  const double *tried;

  (void)state;
  for (int step = 0; step < 2; step++) {
    double *committed;

    sam_call(SamStateBegin(m.state));
    tried = SamStateNumbers(m.state, 0, SAM_TRIED);
    sam_assert(isnan(tried[m.real]) && tried[m.integer] == 0);
    for (int k = 0; k < 36; k++) sam_assert(isnan(tried[m.matrix + k]));
    sam_assert(tried[m.kept] == 3 * step && tried[m.kept + 1] == 4 * step);
    sam_call(SamStateCommit(m.state));
    committed               = SamStateNumbers(m.state, 0, SAM_COMMITTED);
    committed[m.real]       = 1;
    committed[m.integer]    = 2;
    committed[m.matrix + 5] = 6;
    committed[m.kept]       = 3;
    committed[m.kept + 1]   = 4;
  }
  sam_assert(*SamStateReadNumbers(m.state, m.real) == 1); /* without a try the committed ones */
  DestroyMemory(&m);
}

/* A number that becomes a result is one from the next try on. */
/* Over the parts of a step sums add up, the greatest counts, and of all others the last. */
static void test_numbers_join_over_the_parts_of_a_step(void **state)
{
  Memory m                        = NewMemory();
  double parts[SAM_STATE_NUMBERS] = {0};

  (void)state;
  for (int part = 0; part < 3; part++) {
    double *tried;

    sam_call(SamStateBegin(m.state));
    tried            = SamStateNumbers(m.state, 0, SAM_TRIED);
    tried[m.real]    = 1 + part;
    tried[m.integer] = 5 - part;
    tried[m.kept]    = part;
    SamStateJoinNumbers(m.state, parts, part == 2);
    if (part < 2) sam_call(SamStateCommit(m.state));
  }
  sam_assert(*SamStateReadNumbers(m.state, m.real) == 6 && *SamStateReadNumbers(m.state, m.integer) == 5);
  sam_assert(*SamStateReadNumbers(m.state, m.kept) == 2);
  DestroyMemory(&m);
}

static void test_offered_number_is_a_result(void **state)
{
  Memory m = NewMemory();

  (void)state;
  sam_call(SamStateOfferNumber(m.state, "kept", NAN));
  sam_assert(SamStateNumberOf(m.state, 3, NULL)->result && SamStateNumberOf(m.state, 3, NULL)->kept);
  *SamStateNumbers(m.state, m.kept, SAM_COMMITTED) = 3;
  sam_call(SamStateBegin(m.state));
  sam_assert(isnan(*SamStateReadNumbers(m.state, m.kept)));
  DestroyMemory(&m);
}

static void test_reset_forgets_all_values(void **state)
{
  Memory m = NewMemory();

  (void)state;
  Step(&m, 1, 2);
  Step(&m, 3, 4);
  for (PetscInt id = 0; id < SamStateCountValues(m.state); id++) *SamStateNumbers(m.state, id, SAM_COMMITTED) = 5;
  sam_call(SamStateBegin(m.state));
  (void)Set(&m, m.two, 6);
  sam_call(SamStateReset(m.state));
  sam_assert(!SamStateHasTried(m.state) && SamStateCountFields(m.state) == 2);
  for (PetscInt id = 0; id < 2; id++)
    sam_assert(!SamStateReadField(m.state, id) && !SamStateGetField(m.state, id, SAM_BEFORE));
  sam_assert(isnan(*SamStateReadNumbers(m.state, m.real)) && *SamStateReadNumbers(m.state, m.kept) == 0);
  sam_assert(*SamStateReadNumbers(m.state, m.integer) == 0);
  DestroyMemory(&m);
}

/* ---- copies ---- */

static void test_copy_has_both_committed_generations(void **state)
{
  Memory   m = NewMemory();
  SamState other;

  (void)state;
  Step(&m, 1, 2);
  Step(&m, 3, 4);
  SamStateNumbers(m.state, m.kept, SAM_BEFORE)[1]    = 5;
  SamStateNumbers(m.state, m.kept, SAM_COMMITTED)[1] = 6;
  sam_call(SamStateCreateLike(m.state, &other));
  for (int twice = 0; twice < 2; twice++) { /* into an empty state, and over what it has */
    Memory copy = {m.grid, other, m.three, m.two, m.real, m.integer, m.matrix, m.kept};

    sam_call(SamStateBegin(other));
    (void)Set(&copy, m.three, 7); /* is forgotten */
    sam_call(SamStateCopy(m.state, other));
    sam_assert(!SamStateHasTried(other));
    sam_assert(Is(&copy, m.three, SAM_COMMITTED, 3) && Is(&copy, m.three, SAM_BEFORE, 1));
    sam_assert(Is(&copy, m.two, SAM_COMMITTED, 4));
    sam_assert(SamStateGetField(other, m.two, SAM_COMMITTED) != SamStateGetField(m.state, m.two, SAM_COMMITTED));
    sam_assert(SamStateNumbers(other, m.kept, SAM_BEFORE)[1] == 5);
    sam_assert(SamStateNumbers(other, m.kept, SAM_COMMITTED)[1] == 6);
    Step(&copy, 8, 9);
    Step(&copy, 8, 9);
    sam_assert(Is(&m, m.three, SAM_COMMITTED, 3) && Is(&m, m.three, SAM_BEFORE, 1)); /* its own vectors */
  }
  sam_call(SamStateDestroy(&other));
  DestroyMemory(&m);
}

/* By name, whatever the order of the declarations; what the source does not have is as at first. */
static void test_copy_goes_by_name(void **state)
{
  Memory   m = NewMemory(), other = {.grid = m.grid};
  PetscInt more, number;

  (void)state;
  Step(&m, 1, 2);
  SamStateNumbers(m.state, m.kept, SAM_COMMITTED)[0] = 3;
  sam_call(SamStateCreate(m.grid, &other.state));
  sam_call(SamStateDeclareNumber(
    other.state, &(SamStateNumber){"more", "1", "", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_FALSE, SAM_JOIN_LAST, 0},
    &number));
  sam_call(SamStateDeclareNumber(other.state, &kept, &other.kept));
  sam_call(
    SamStateDeclareField(other.state, &(SamStateField){.name = "more", .components = 1, .generations = 2}, &more));
  sam_call(SamStateDeclareField(other.state, &field3, &other.three));
  sam_call(SamStateDeclareField(other.state, &field2, &other.two));
  Step(&other, 5, 5);
  sam_call(SamStateBegin(other.state));
  (void)Set(&other, more, 5);
  *SamStateNumbers(other.state, number, SAM_TRIED) = 5;
  sam_call(SamStateCommit(other.state));
  sam_call(SamStateCopy(m.state, other.state));
  sam_assert(other.two != m.two && Is(&other, other.two, SAM_COMMITTED, 2) &&
             Is(&other, other.three, SAM_COMMITTED, 1));
  sam_assert(Is(&other, more, SAM_COMMITTED, 0));
  sam_assert(other.kept != m.kept && SamStateNumbers(other.state, other.kept, SAM_COMMITTED)[0] == 3);
  sam_assert(*SamStateNumbers(other.state, number, SAM_COMMITTED) == 0);
  sam_call(SamStateDestroy(&other.state));
  DestroyMemory(&m);
}

/* Values that would be lost are refused by the name of the field, and nothing is copied. */
static void test_copy_of_a_field_that_is_not_declared_is_refused(void **state)
{
  Memory m = NewMemory(), fewer = {.grid = m.grid};

  (void)state;
  sam_call(SamStateCreate(m.grid, &fewer.state));
  sam_call(SamStateDeclareField(fewer.state, &field3, &fewer.three));
  sam_call(SamStateCopy(m.state, fewer.state)); /* declared there, but without values */
  Step(&m, 1, 2);
  sam_call(SamStateBegin(fewer.state));
  (void)Set(&fewer, fewer.three, 5);
  sam_call(SamStateCommit(fewer.state));
  sam_says(SamStateCopy(m.state, fewer.state), PETSC_ERR_ARG_INCOMP, " two");
  sam_assert(Is(&fewer, fewer.three, SAM_COMMITTED, 5));
  sam_call(SamStateDestroy(&fewer.state));
  DestroyMemory(&m);
}

static void test_copy_from_another_grid_is_refused(void **state)
{
  Memory m = NewMemory(), other = NewMemoryOn(11, 7);

  (void)state;
  Step(&m, 1, 2);
  Step(&other, 3, 4);
  sam_fails(SamStateCopy(m.state, other.state), PETSC_ERR_ARG_SIZ);
  sam_assert(Is(&other, other.two, SAM_COMMITTED, 4));
  DestroyMemory(&m);
  DestroyMemory(&other);
}

/* A step must not depend on a number that a restart lacks; a rejected step, a copy and a commit still have it. */
static void test_tries_do_not_see_what_checkpoints_lack(void **state)
{
  Memory m = NewMemory(), other = NewMemory();

  (void)state;
  sam_call(SamStateBegin(m.state));
  *SamStateNumbers(m.state, m.real, SAM_TRIED) = 5;
  *SamStateNumbers(m.state, m.kept, SAM_TRIED) = 6;
  sam_call(SamStateCommit(m.state));
  sam_assert(*SamStateNumbers(m.state, m.real, SAM_COMMITTED) == 5);
  for (int k = 0; k < 2; k++) {
    sam_call(SamStateBegin(m.state));
    sam_assert(isnan(*SamStateNumbers(m.state, m.real, SAM_COMMITTED)));
    sam_assert(*SamStateNumbers(m.state, m.kept, SAM_COMMITTED) == 6);
    sam_call(SamStateCopy(m.state, other.state));
    sam_assert(*SamStateNumbers(other.state, other.real, SAM_COMMITTED) == 5);
    sam_assert(isnan(*SamStateNumbers(m.state, m.real, SAM_COMMITTED)));
    if (k) continue; /* a try that begins anew rejects the one before */
    sam_call(SamStateReject(m.state));
    sam_assert(*SamStateNumbers(m.state, m.real, SAM_COMMITTED) == 5);
  }
  *SamStateNumbers(m.state, m.real, SAM_TRIED) = 7;
  sam_call(SamStateCommit(m.state));
  sam_assert(*SamStateNumbers(m.state, m.real, SAM_COMMITTED) == 7);
  sam_assert(*SamStateNumbers(m.state, m.real, SAM_BEFORE) == 5);
  DestroyMemory(&m);
  DestroyMemory(&other);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_same_declaration_gives_the_same_handle),
    cmocka_unit_test(test_results_are_the_components_of_fields),
    cmocka_unit_test(test_field_with_depth_has_its_layers),
    cmocka_unit_test(test_more_than_fits_is_refused),
    cmocka_unit_test(test_generations_rotate_by_pointer),
    cmocka_unit_test(test_field_that_is_not_set_keeps_its_values),
    cmocka_unit_test(test_rejected_try_leaves_no_trace),
    cmocka_unit_test(test_fields_can_be_forgotten_without_the_numbers),
    cmocka_unit_test(test_numbers_begin_with_none),
    cmocka_unit_test(test_numbers_join_over_the_parts_of_a_step),
    cmocka_unit_test(test_offered_number_is_a_result),
    cmocka_unit_test(test_reset_forgets_all_values),
    cmocka_unit_test(test_copy_has_both_committed_generations),
    cmocka_unit_test(test_copy_goes_by_name),
    cmocka_unit_test(test_copy_of_a_field_that_is_not_declared_is_refused),
    cmocka_unit_test(test_copy_from_another_grid_is_refused),
    cmocka_unit_test(test_tries_do_not_see_what_checkpoints_lack),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

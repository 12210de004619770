/* A contact in another program: the same bits as the library, mistakes that are told, several contacts, its files. */
#include "contacts.h"
#include "embedded.h"

#include <petsam/embed.h>
#include <petsam/stiffness.h>

#define BODIES \
  "-body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3 -gap_type sphere -gap_radius1 0.1 " \
  "-gap_radius2 inf "
#define OPTIONS BODIES "-grid_n 44 -grid_size 3e-3 -friction 0.3"

enum { CELLS = 44 * 44 };

/* The six components of a stiffness, to the last bit. */
static int SameStiffness(const double k[36], const SamStiffness *expected)
{
  for (PetscInt i = 0; i < SAM_COMPONENTS; i++)
    if (!SameNumbers(SAM_COMPONENTS, k + SAM_COMPONENTS * i, expected->k[i])) return 0;
  return 1;
}

/* The gap of a sphere as the other tests compute it, which is that of the options but for rounding. */
static void GiveGap(petsam_contact *c, const Sphere *s)
{
  const double *gap;

  sam_call(VecGetArrayRead(s->h, &gap));
  sam_assert(petsam_set_field(c, "gap", gap) == 0);
  sam_call(VecRestoreArrayRead(s->h, &gap));
}

static void test_embedded_contact_has_the_bits_of_the_library(void **state)
{
  petsam_contact *c       = NewContact(World(), OPTIONS);
  Case            same    = NewCase(Steel(), 44, 1.5, 0.3, "");
  SamControl      control = Loads(&same, 0, 0, 0, 0);
  double         *field   = (double *)calloc(CELLS, sizeof(*field)), load[6], rigid[6], k[36], number;
  SamStiffness    stiffness;

  (void)state;
  GiveGap(c, &same.s);
  for (int step = 1; step <= 3; step++) {
    SamStep       expected;
    const double *cells;

    control.value[SAM_COMPONENT_N]  = 1000;
    control.value[SAM_COMPONENT_TX] = 80.0 * step;
    expected                        = Try(&same, &control);
    sam_assert(TryLoads(c, 1000, 80.0 * step, load, rigid) == 0);
    sam_assert(SameNumbers(6, load, expected.load) && SameNumbers(6, rigid, expected.rigid));
    sam_assert(petsam_get_number(c, "dissipated_energy", &number) == 0 &&
               number == NumberOf(&same, "dissipated_energy"));
    sam_assert(petsam_get_number(c, "tangential_applies", &number) == 0 &&
               number == NumberOf(&same, "tangential_applies"));
    sam_call(SamStiffnessCompute(same.contact, SAM_STIFFNESS_FORWARD, 0, NULL, &stiffness));
    sam_assert(petsam_stiffness(c, 0, k) == 0 && SameStiffness(k, &stiffness));
    sam_assert(petsam_get_field(c, "shear_x", field) == 0);
    sam_call(VecGetArrayRead(SolutionOf(&same)->shear, &cells));
    sam_assert(!memcmp(field, cells, sizeof(*field) * (size_t)same.s.grid->cells));
    sam_call(VecRestoreArrayRead(SolutionOf(&same)->shear, &cells));
    sam_assert(petsam_commit(c) == 0);
    sam_call(SamStiffnessCompute(same.contact, SAM_STIFFNESS_REVERSAL, 0, NULL, &stiffness));
    sam_call(SamContactCommit(same.contact));
    sam_assert(petsam_stiffness(c, 1, k) == 0 && SameStiffness(k, &stiffness));
    sam_assert(petsam_stiffness(c, 0, k) == 2 && strstr(petsam_message(c), "not kept after the commit"));
  }
  free(field);
  DestroyCase(&same);
  petsam_destroy(&c);
  sam_assert(!c);
}

static void test_grid_is_told(void **state)
{
  petsam_contact *c    = NewContact(World(), BODIES "-grid_n 5,7 -grid_size 1e-3,2e-3 -grid_center 1,2");
  SamGrid         grid = NewGridOn(PETSC_COMM_WORLD, 5, 7, 1e-3, 2e-3, 1, 2);
  int             n[2], first, rows;
  double          size[2], center[2];

  (void)state;
  sam_assert(petsam_grid(c, n, size, center, &first, &rows) == 0);
  sam_assert(n[0] == 5 && n[1] == 7 && size[0] == 1e-3 && size[1] == 2e-3 && center[0] == 1 && center[1] == 2);
  sam_assert(first == grid->row_start && rows == grid->rows);
  sam_assert(petsam_grid(c, NULL, NULL, NULL, NULL, NULL) == 0);
  sam_call(SamGridDestroy(&grid));
  petsam_destroy(&c);
}

/* After a try is rejected, the next step is as if it had not been tried. */
static void test_rejected_try_leaves_no_trace(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(World(), OPTIONS);
  double          one[6], other[6], number;

  (void)state;
  sam_assert(petsam_reject(c) == 0);
  for (int step = 1; step <= 2; step++) {
    sam_assert(TryLoads(c, 700, 100, NULL, NULL) == 0);
    sam_assert(TryLoads(c, 900, -150, NULL, NULL) == 0);
    sam_assert(petsam_reject(c) == 0);
    if (step == 2) sam_assert(petsam_get_number(c, "load_tx", &number) == 0 && fabs(number - 100) < 1e-8);
    sam_assert(TryLoads(c, 1000, 100.0 * step, NULL, one) == 0 && petsam_commit(c) == 0);
    sam_assert(TryLoads(d, 1000, 100.0 * step, NULL, other) == 0 && petsam_commit(d) == 0);
    sam_assert(SameNumbers(6, one, other));
  }
  petsam_destroy(&c);
  petsam_destroy(&d);
}

/* ---- mistakes ---- */

static void Refuses(const char *options, int code, const char *words)
{
  petsam_contact *c;

  sam_assert(petsam_create(World(), options, &c) == code);
  sam_assert(!c && Says(NULL, words));
}

static void test_wrong_options_are_named(void **state)
{
  petsam_contact *c;

  (void)state;
  Refuses(OPTIONS " -frictoin 0.2", 2, "-frictoin 0.2: unknown option");
  Refuses(OPTIONS " -friction -1", 2, "-friction -1");
  Refuses(OPTIONS " -load_n 5", 2, "-load_n");
  Refuses(OPTIONS " 17 4", 2, "17: expected an option");
  Refuses(BODIES "-grid_size 1", 2, "-grid_n");
  Refuses(OPTIONS " -options_file nowhere.opts", 3, "nowhere.opts");
  Refuses(OPTIONS " -gap_rough_file nowhere.h5", 3, "nowhere.h5");
  Refuses(OPTIONS " -python here", 2, "-python");
  Refuses(OPTIONS " -help", 2, "-help");
  Refuses(OPTIONS " -log_view", 2, "-log_view");
  Refuses(OPTIONS " -gap_rough_file \"a.h5", 3, "a.h5");
  Refuses(OPTIONS " -options_file", 2, "-options_file has no value");
  Refuses(OPTIONS "\n-frictoin\t0.2\n", 2, "-frictoin 0.2: unknown option");
  sam_assert(petsam_create((int)MPI_Comm_c2f(MPI_COMM_NULL), OPTIONS, &c) == 2 && Says(NULL, "no communicator"));
  sam_assert(petsam_create(World(), NULL, NULL) == 2);
}

static void test_mistakes_leave_a_contact_that_goes_on(void **state)
{
  petsam_contact *c            = NewContact(World(), OPTIONS);
  const int       displaced[6] = {0, 0, 0, 1, 1, 0}, force[6] = {1, 1, 1, 1, 1, 1};
  const double    away[6] = {-1e-6, 0, 0, 0, 0, 0}, wrong[6] = {NAN, 0, 0, 0, 0, 0}, pull[6] = {-1, 0, 0, 0, 0, 0};
  double          number, *field = (double *)calloc(CELLS, sizeof(*field)), k[36], rigid[6];

  (void)state;
  sam_assert(petsam_commit(c) == 2 && Says(c, "no tried step"));
  sam_assert(petsam_stiffness(c, 0, k) == 2 && Says(c, "no step is tried or committed"));
  sam_assert(petsam_get_field(c, "pressure", field) == 2 && Says(c, "no step has been solved"));
  sam_assert(petsam_get_number(c, "load_n", &number) == 2 && Says(c, "no step has been tried"));
  sam_assert(petsam_save(c, "early.h5") == 2);
  sam_assert(petsam_load(c, "nowhere.h5") == 3 && Says(c, "nowhere.h5"));
  sam_assert(TryComponents(c, 0, force, wrong, NULL, NULL) == 2 && Says(c, "load_n is not a finite number"));
  sam_assert(TryComponents(c, 0, force, pull, NULL, NULL) == 2 && Says(c, "load_n = -1"));
  sam_assert(TryLoads(c, 1000, 100, NULL, NULL) == 0 && petsam_message(c)[0] == '\0');
  sam_assert(petsam_get_field(c, "presure", field) == 2 && Says(c, "presure"));
  sam_assert(petsam_get_number(c, "load", &number) == 2);
  sam_assert(petsam_set_field(c, "pressure", field) == 2);
  field[0] = INFINITY;
  sam_assert(petsam_set_field(c, "gap", field) == 2 && Says(c, "gap"));
  field[0] = -1;
  sam_assert(petsam_set_field(c, "friction", field) == 2);
  sam_assert(petsam_stiffness(NULL, 0, k) == 2 && petsam_try(c, 0, NULL, NULL, NULL, NULL) == 2 &&
             Says(c, "petsam_try: a pointer is NULL"));
  sam_assert(petsam_try(c, 0, "disp_z,roll,roll_y", (double[]){-1e-6, 0, NAN}, NULL, NULL) == 2 &&
             Says(c, "roll_y = nan"));
  /* more than friction bears: no solution, the numbers of the step are there, and nothing can be committed */
  sam_assert(TryLoads(c, 1000, 400, NULL, rigid) == 11 && Says(c, "gross slip"));
  sam_assert(isnan(rigid[1]) && petsam_get_number(c, "status", &number) == 0 && number == 11);
  sam_assert(petsam_commit(c) == 2 && Says(c, "gross slip"));
  sam_assert(!petsam_reject(c) && petsam_commit(c) == 2 && Says(c, "no tried step")); /* that try is forgotten */
  sam_assert(TryComponents(c, NAN, force, away, NULL, NULL) == 2 && Says(c, "time"));
  sam_assert(TryComponents(c, 0, displaced, away, NULL, NULL) == 0); /* bodies apart */
  sam_assert(petsam_commit(c) == 0);
  sam_assert(TryLoads(c, 1000, 100, NULL, NULL) == 0 && petsam_commit(c) == 0);
  free(field);
  petsam_destroy(&c);
}

/* Options may stand on several lines. */
static void test_white_space_separates_options(void **state)
{
  petsam_contact *c = NewContact(World(), BODIES "\n-grid_n\t44 \r\n -grid_size 3e-3\n\t-friction 0.3\n");

  (void)state;
  sam_assert(TryLoads(c, 1000, 250, NULL, NULL) == 0);
  petsam_destroy(&c);
}

static void test_step_that_does_not_converge_is_not_committed(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS " -tangential_max_it 1 -tangential_levels 1");
  double          number;

  (void)state;
  sam_assert(TryLoads(c, 1000, 200, NULL, NULL) == 10 && Says(c, "did not converge"));
  sam_assert(petsam_commit(c) == 10);
  sam_assert(petsam_get_number(c, "load_n", &number) == 0);
  petsam_destroy(&c);
}

/* ---- several ---- */

static void test_contacts_live_together(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(-1, OPTIONS " -normal_rtol 1e-6"),
                 *e = NewContact(-1, OPTIONS);
  double one[6], other[6], loose[6];

  (void)state;
  for (int step = 1; step <= 2; step++) {
    sam_assert(TryLoads(c, 1000, 90.0 * step, NULL, one) == 0 && petsam_commit(c) == 0);
    sam_assert(TryLoads(d, 1000, 90.0 * step, NULL, loose) == 0 && petsam_commit(d) == 0);
    sam_assert(TryLoads(e, 1000, 90.0 * step, NULL, other) == 0 && petsam_commit(e) == 0);
    sam_assert(SameNumbers(6, one, other)); /* on all ranks, and on each alone */
    sam_assert(!SameNumbers(6, loose, other));
  }
  petsam_destroy(&c);
  petsam_destroy(&d);
  petsam_destroy(&e);
}

/* Half of the ranks have a contact, the others none: they do not wait for each other. */
static void test_contact_of_some_ranks(void **state)
{
  petsam_contact *c = NULL;
  MPI_Comm        half;
  int             rank, good = 1;

  (void)state;
  (void)MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  (void)MPI_Comm_split(PETSC_COMM_WORLD, rank % 2, 0, &half);
  if (rank % 2 == 0) {
    good = petsam_create((int)MPI_Comm_c2f(half), OPTIONS, &c) == 0;
    good = good && TryLoads(c, 1000, 100, NULL, NULL) == 0 && petsam_commit(c) == 0;
    petsam_destroy(&c);
  }
  sam_assert(good);
  (void)MPI_Comm_free(&half);
}

/* ---- fields and files ---- */

/* A gap that is given is that of the options, and friction too. */
static void test_given_fields_replace_those_of_options(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(World(), BODIES "-grid_n 44 -grid_size 3e-3");
  Sphere          s = NewSphereOf(Steel(), 44, 1.5);
  double          one[6], other[6], *friction;

  (void)state;
  friction = (double *)malloc(sizeof(*friction) * (size_t)(s.grid->cells + 1));
  for (PetscInt k = 0; k < s.grid->cells; k++) friction[k] = 0.3;
  GiveGap(c, &s);
  GiveGap(d, &s);
  sam_assert(petsam_set_field(d, "friction", friction) == 0);
  sam_assert(TryLoads(c, 1000, 100, NULL, one) == 0 && TryLoads(d, 1000, 100, NULL, other) == 0);
  sam_assert(SameNumbers(6, one, other));
  for (PetscInt k = 0; k < s.grid->cells; k++) friction[k] = 0.05;
  sam_assert(petsam_set_field(d, "friction", friction) == 0);
  sam_assert(TryLoads(d, 1000, 100, NULL, other) == 11);
  free(friction);
  DestroySphere(&s);
  petsam_destroy(&c);
  petsam_destroy(&d);
}

static void test_saved_state_goes_on_in_another_contact(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS " -wear_coefficient2 1e-11"),
                 *d = NewContact(World(), OPTIONS " -wear_coefficient2 1e-11"), *e = NewContact(World(), OPTIONS);
  double one[6], other[6], worn, restored;

  (void)state;
  for (int step = 1; step <= 2; step++)
    sam_assert(TryLoads(c, 1000, 120.0 * step, NULL, one) == 0 && !petsam_commit(c));
  sam_assert(petsam_save(c, "state.h5") == 0 && petsam_save(c, "state.h5") == 0);
  sam_assert(petsam_load(e, "state.h5") == 2 && Says(e, "wear")); /* not the same bodies */
  sam_assert(petsam_load(d, "state.h5") == 0);
  sam_assert(petsam_get_number(d, "disp_x", &restored) == 0 && restored == one[1]);
  sam_assert(petsam_get_number(c, "wear_volume2", &worn) == 0 && worn > 0);
  sam_assert(petsam_get_number(d, "wear_volume2", &restored) == 0 && restored == worn);
  sam_assert(TryLoads(c, 900, -50, NULL, one) == 0 && TryLoads(d, 900, -50, NULL, other) == 0);
  sam_assert(SameNumbers(6, one, other));
  petsam_destroy(&c);
  petsam_destroy(&d);
  petsam_destroy(&e);
}

/* A law that only one of the two has. */
static void test_state_of_other_laws_is_refused(void **state)
{
  static const char *const options[] = {OPTIONS " -pressure_limit 1e9", OPTIONS};

  (void)state;
  for (int k = 0; k < 2; k++) {
    petsam_contact *c = NewContact(World(), options[k]), *d = NewContact(World(), options[1 - k]);

    sam_assert(TryLoads(c, 1000, 100, NULL, NULL) == 0 && petsam_commit(c) == 0 && petsam_save(c, "limit.h5") == 0);
    sam_assert(petsam_load(d, "limit.h5") == 2 && Says(d, "-pressure_limit") &&
               Says(d, k ? "not given" : "and not here"));
    sam_assert(TryLoads(d, 1000, 100, NULL, NULL) == 0 && petsam_commit(d) == 0);
    petsam_destroy(&c);
    petsam_destroy(&d);
  }
}

/* Of another gap, though the options are the same. */
static void test_state_of_another_gap_is_refused(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(World(), OPTIONS);
  Sphere          s = NewSphereOf(Steel(), 44, 1.5);

  (void)state;
  GiveGap(c, &s);
  sam_assert(TryLoads(c, 1000, 100, NULL, NULL) == 0 && petsam_commit(c) == 0 && petsam_save(c, "given.h5") == 0);
  sam_assert(petsam_load(d, "given.h5") == 2 && Says(d, "given_gap") && !strstr(petsam_message(d), "-restart"));
  GiveGap(d, &s);
  sam_assert(petsam_load(d, "given.h5") == 0);
  sam_call(VecScale(s.h, 0.5));
  GiveGap(d, &s);
  sam_assert(petsam_load(d, "given.h5") == 2);
  DestroySphere(&s);
  petsam_destroy(&c);
  petsam_destroy(&d);
}

/* A step that wears more than a step may is told by the commit, and by no other call. */
static void test_wear_of_too_large_a_step_is_told(void **state)
{
  petsam_contact *little = NewContact(World(), OPTIONS " -wear_coefficient1 1e-12"),
                 *much   = NewContact(World(), OPTIONS " -wear_coefficient1 1e-6");

  (void)state;
  sam_assert(TryLoads(little, 1000, 200, NULL, NULL) == 0 && petsam_commit(little) == 0);
  sam_assert(!petsam_message(little)[0]);
  sam_assert(TryLoads(much, 1000, 200, NULL, NULL) == 0 && !petsam_message(much)[0]);
  sam_assert(petsam_commit(much) == 0 && Says(much, "times the limit of a step"));
  sam_assert(petsam_reject(much) == 0 && !petsam_message(much)[0]);
  petsam_destroy(&little);
  petsam_destroy(&much);
}

/* A worn body's gap may be given anew: what has been removed stays. */
static void test_wear_stays_when_the_gap_is_given_anew(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS " -wear_coefficient1 1e-10");
  Sphere          s = NewSphereOf(Steel(), 44, 1.5);
  double          worn[3], one[6], other[6]; /* by one step, and by two */

  (void)state;
  sam_assert(TryLoads(c, 1000, 200, NULL, NULL) == 0 && petsam_commit(c) == 0);
  sam_assert(petsam_get_number(c, "wear_volume1", &worn[0]) == 0 && worn[0] > 0);
  sam_assert(TryLoads(c, 1000, -200, NULL, one) == 0);
  sam_assert(petsam_get_number(c, "wear_volume1", &worn[1]) == 0 && worn[1] > 1.5 * worn[0]);
  GiveGap(c, &s);
  sam_assert(TryLoads(c, 1000, -200, NULL, other) == 0);
  sam_assert_close(other[0], one[0], 1e-7 * one[0]);
  sam_assert(petsam_get_number(c, "wear_volume1", &worn[2]) == 0);
  sam_assert_close(worn[2], worn[1], 1e-7 * worn[1]);
  sam_assert(petsam_reject(c) == 0 && petsam_get_number(c, "wear_volume1", &worn[2]) == 0 && worn[2] == worn[0]);
  DestroySphere(&s);
  petsam_destroy(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_embedded_contact_has_the_bits_of_the_library),
    cmocka_unit_test(test_grid_is_told),
    cmocka_unit_test(test_rejected_try_leaves_no_trace),
    cmocka_unit_test(test_wrong_options_are_named),
    cmocka_unit_test(test_mistakes_leave_a_contact_that_goes_on),
    cmocka_unit_test(test_white_space_separates_options),
    cmocka_unit_test(test_step_that_does_not_converge_is_not_committed),
    cmocka_unit_test(test_contacts_live_together),
    cmocka_unit_test(test_contact_of_some_ranks),
    cmocka_unit_test(test_given_fields_replace_those_of_options),
    cmocka_unit_test(test_saved_state_goes_on_in_another_contact),
    cmocka_unit_test(test_state_of_other_laws_is_refused),
    cmocka_unit_test(test_state_of_another_gap_is_refused),
    cmocka_unit_test(test_wear_stays_when_the_gap_is_given_anew),
    cmocka_unit_test(test_wear_of_too_large_a_step_is_told),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/* Histories and lives in another program: the same bits on any number of ranks, what a monitor may do, copies. */
#include "contacts.h"
#include "embedded.h"

#include <petsam/embed.h>

#define OPTIONS \
  "-body1_young 210e9 -body1_poisson 0.3 -body2_young 70e9 -body2_poisson 0.2 -gap_type sphere -gap_radius1 0.1 " \
  "-gap_radius2 inf -grid_n 37,29 -grid_size 3e-3,2.4e-3 -friction 0.3 -wear_coefficient2 1e-12 -steps 2"

enum { ROWS = 5, STEPS = 2 * (ROWS - 1) + 1 };

static const char   columns[]        = "time,disp_z,disp_x";
static const double values[3 * ROWS] = {0, 7e-6, 0, 1, 7e-6, 5e-7, 2, 7e-6, 0, 3, 7e-6, -5e-7, 4, 7e-6, 0};

/* The numbers of the steps or cycles of a run, as the monitor sees them; it stops after `most`. */
typedef struct {
  int    count, most, refused;
  double number[64][3];
} Log;

static int Note(void *context, petsam_contact *c, int cycle)
{
  static const char *const names[2][3] = {{"load_tx", "wear_volume2", "dissipated_energy"},
                                          {"wear/volume2", "wear/jump", "wear/pressure_max"}};
  Log *const               log         = (Log *)context;

  if (log->count == 64) return 1;
  for (int k = 0; k < 3; k++)
    if (petsam_get_number(c, names[cycle != 0][k], &log->number[log->count][k])) return 1;
  log->refused += petsam_reject(c) == 2 && petsam_commit(c) == 2;
  return ++log->count == log->most;
}

static void AssertSameLogs(const Log *a, const Log *b)
{
  sam_assert(a->count == b->count && !memcmp(a->number, b->number, sizeof(a->number[0]) * (size_t)a->count));
}

static void test_history_has_the_same_bits_on_any_ranks(void **state)
{
  petsam_contact *all = NewContact(World(), OPTIONS), *one = NewContact(-1, OPTIONS);
  Log             a = {.most = 0}, b = {.most = 0};

  (void)state;
  sam_assert(petsam_history(all, columns, ROWS, values, Note, &a) == 0 && a.count == STEPS + 1);
  sam_assert(petsam_history(one, columns, ROWS, values, Note, &b) == 0);
  AssertSameLogs(&a, &b);
  sam_assert(a.refused == a.count);
  petsam_destroy(&all);
  petsam_destroy(&one);
}

static void test_life_has_the_same_bits_on_any_ranks(void **state)
{
  petsam_contact *all = NewContact(World(), OPTIONS), *one = NewContact(-1, OPTIONS);
  Log             a = {.most = 0}, b = {.most = 0};

  (void)state;
  sam_assert(petsam_live(all, 500, columns, ROWS, values, Note, &a) == 0 && a.count > 2);
  sam_assert(petsam_live(one, 500, columns, ROWS, values, Note, &b) == 0);
  AssertSameLogs(&a, &b);
  sam_assert(a.number[a.count - 1][0] > a.number[0][0] && a.number[0][0] == 0);
  petsam_destroy(&all);
  petsam_destroy(&one);
}

/* Steps that were solved before the stop are committed: another contact that does only these is the same. */
static void test_monitor_stops_after_a_step(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *other = NewContact(World(), OPTIONS);
  Log             a = {.most = 6}, b = {.most = 0};
  double          load[6], same[6];
  const int       force[6] = {0, 0, 1, 1, 1, 1};
  const double    given[6] = {7e-6, 2e-7, 0, 0, 0, 0};

  (void)state;
  sam_assert(petsam_history(c, columns, ROWS, values, Note, &a) == 0 && a.count == 6);
  sam_assert(petsam_history(other, columns, 3, values, Note, &b) == 0 && b.count == 6);
  AssertSameLogs(&a, &b);
  sam_assert(TryComponents(c, 9, force, given, load, NULL) == 0 &&
             TryComponents(other, 9, force, given, same, NULL) == 0);
  sam_assert(!memcmp(load, same, sizeof(load)));
  petsam_destroy(&c);
  petsam_destroy(&other);
}

/* A run that fails keeps what it has committed: all that is asked for, and the next run, follow from there. */
static void test_run_that_fails_keeps_what_it_committed(void **state)
{
  const double    rows[] = {1, 500, 0, 2, 500, 100, 3, 500, 1e4}, next[] = {10, 700, 50};
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(World(), OPTIONS);
  Log             a = {.most = 0}, b = {.most = 0};
  double          time, load[6], same[6], *field = (double *)malloc(sizeof(double) * 37 * 29);

  (void)state;
  sam_assert(petsam_history(c, "time,load_n,load_tx", 3, rows, NULL, NULL) == 11); /* at 2.5, after 1, 1.5 and 2 */
  sam_assert(petsam_get_number(c, "time", &time) == 0 && time == 2.5 && petsam_commit(c) == 2);
  sam_assert(petsam_reject(c) == 0 && petsam_get_number(c, "time", &time) == 0 && time == 2);
  sam_assert(petsam_get_field(c, "pressure", field) == 0 && petsam_save(c, "failed.h5") == 0);
  sam_assert(petsam_history(d, "time,load_n,load_tx", 2, rows, NULL, NULL) == 0);
  sam_assert(petsam_history(c, "time,load_n,load_tx", 1, next, Note, &a) == 0 && a.count == 2);
  sam_assert(petsam_history(d, "time,load_n,load_tx", 1, next, Note, &b) == 0);
  AssertSameLogs(&a, &b);
  sam_assert_close(a.number[0][0], 75, 1e-6); /* half-way from the committed 100 N */
  sam_assert(TryComponents(c, 11, (int[6]){1, 1, 1, 1, 1, 1}, (double[6]){800, 20}, load, NULL) == 0);
  sam_assert(TryComponents(d, 11, (int[6]){1, 1, 1, 1, 1, 1}, (double[6]){800, 20}, same, NULL) == 0);
  sam_assert(!memcmp(load, same, sizeof(load)));
  free(field);
  petsam_destroy(&c);
  petsam_destroy(&d);
}

/* What a monitor may not do changes nothing; a copy and a file have the step that was committed before. */
typedef struct {
  Log             log;
  petsam_contact *other;
  int             refused, copied;
} Meddler;

static int Meddle(void *context, petsam_contact *c, int cycle)
{
  Meddler *const  m    = (Meddler *)context;
  petsam_contact *self = c;
  double          time;

  m->refused += petsam_reset(c) == 2 && petsam_load(c, "failed.h5") == 2 && petsam_copy(c, m->other) == 2;
  petsam_destroy(&self);
  m->refused += self == c && strstr(petsam_message(c), "after the monitor");
  if (m->log.count == 2)
    m->copied = petsam_copy(m->other, c) == 0 && petsam_get_number(m->other, "time", &time) == 0 && time == 0 &&
                petsam_save(c, "between.h5") == 0;
  return Note(&m->log, c, cycle);
}

static void test_monitor_cannot_change_its_contact(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(World(), OPTIONS);
  Log             b = {.most = 0};
  Meddler         m = {.other = NewContact(World(), OPTIONS)};

  (void)state;
  sam_assert(petsam_history(c, columns, ROWS, values, Meddle, &m) == 0 && m.refused == 2 * (STEPS + 1) && m.copied);
  sam_assert(petsam_history(d, columns, ROWS, values, Note, &b) == 0);
  AssertSameLogs(&m.log, &b);
  petsam_destroy(&c);
  petsam_destroy(&d);
  petsam_destroy(&m.other);
  sam_assert(!c && !d);
}

static void test_copy_goes_on_and_reset_begins_anew(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *copy = NewContact(World(), OPTIONS);
  Log             first = {.most = 0}, again = {.most = 0};
  int             shape[4];
  double          load[6], same[6];
  const int       force[6] = {0, 0, 1, 1, 1, 1};
  const double    given[6] = {7e-6, 2e-7, 0, 0, 0, 0};

  (void)state;
  sam_assert(petsam_history(c, columns, ROWS, values, Note, &first) == 0);
  sam_assert(petsam_copy(copy, c) == 0);
  sam_assert(TryComponents(c, 9, force, given, load, NULL) == 0 &&
             TryComponents(copy, 9, force, given, same, NULL) == 0);
  sam_assert(!memcmp(load, same, sizeof(load)));
  sam_assert(petsam_reset(copy) == 0 && petsam_history(copy, columns, ROWS, values, Note, &again) == 0);
  AssertSameLogs(&first, &again);
  sam_assert(petsam_record(c, 1) == 0 && petsam_history(c, columns, ROWS, values, NULL, NULL) == 0);
  sam_assert(petsam_fatigue(c, "-fatigue swt", shape) == 0);
  sam_assert(petsam_reset(c) == 0 && petsam_fatigue(c, "-fatigue swt", shape) == 2); /* nothing is recorded */
  petsam_destroy(&c);
  petsam_destroy(&copy);
}

/* Steps after a life wear, as do those of a new contact that has loaded its state. */
static void test_steps_after_a_life_wear(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *d = NewContact(World(), OPTIONS);
  Log             a = {.most = 0}, b = {.most = 0};
  double          worn, before;

  (void)state;
  sam_assert(petsam_history(c, columns, ROWS, values, NULL, NULL) == 0 && petsam_save(c, "new.h5") == 0);
  sam_assert(petsam_live(c, 100, columns, ROWS, values, NULL, NULL) == 0 && petsam_save(c, "worn.h5") == 0);
  sam_assert(petsam_get_number(c, "wear_volume2", &before) == 0 && petsam_load(d, "worn.h5") == 0);
  sam_assert(petsam_history(d, columns, ROWS, values, Note, &a) == 0);
  sam_assert(TryComponents(c, 9, (int[6]){0}, (double[6]){7e-6, 5e-7}, NULL, NULL) == 0);
  sam_assert(petsam_get_number(c, "wear_volume2", &worn) == 0 && worn > before);
  sam_assert(petsam_load(c, "worn.h5") == 0 && petsam_history(c, columns, ROWS, values, Note, &b) == 0);
  AssertSameLogs(&a, &b);
  sam_assert(petsam_load(c, "new.h5") == 0);
  petsam_destroy(&c);
  petsam_destroy(&d);
}

/* All ranks refuse what a copy cannot be of, also where the rows of only some of them differ. */
static void test_copy_of_another_contact_is_refused(void **state)
{
  petsam_contact *c = NewContact(World(), OPTIONS), *other = NULL;
  int             rank, size;
  MPI_Comm        reversed;

  (void)state;
  (void)MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  (void)MPI_Comm_size(PETSC_COMM_WORLD, &size);
  (void)MPI_Comm_split(PETSC_COMM_WORLD, 0, -rank, &reversed);
  sam_assert(petsam_history(c, columns, ROWS, values, NULL, NULL) == 0);
  other = NewContact((int)MPI_Comm_c2f(reversed), OPTIONS);
  sam_assert(petsam_copy(other, c) == (size > 1 ? 2 : 0));
  sam_assert(size == 1 || strstr(petsam_message(other), "different ranks"));
  petsam_destroy(&other);
  sam_assert(petsam_create(World(), OPTIONS " -grid_center 1e-4,0", &other) == 0 && petsam_copy(other, c) == 2);
  sam_assert(strstr(petsam_message(other), "different grids") != NULL);
  petsam_destroy(&other);
  sam_assert(petsam_create(World(), OPTIONS " -gap_radius1 0.2", &other) == 0 && petsam_copy(other, c) == 2);
  sam_assert(strstr(petsam_message(other), "different gaps") != NULL);
  petsam_destroy(&other);
  petsam_destroy(&c);
  (void)MPI_Comm_free(&reversed);
}

/* Steps given by names have the same bits on any ranks, and those of six components; what makes no sense is named. */
static void test_steps_by_names(void **state)
{
  static const char names[]   = "disp_z,disp_x,bulk2_stress_xx,friction_scale";
  const double      rows[][4] = {{7e-6, 1e-7, 0, 1}, {7.5e-6, 2e-7, 3e7, 0.8}}, odd[] = {500, 1, 1};
  const char *const wrong[][2] = {{"load_n,bulk2_stres_xx", "is bulk2_stress_xx meant?"},
                                  {"load_n,load_tx,disp_x", "load_tx and disp_x exclude each other"},
                                  {"load_n,friction_scale,friction_scale", "friction_scale and friction_scale exclude"},
                                  {"load_tx,friction_scale", "load_n or disp_z is missing"},
                                  {",load_n", "name 1, \"\", is empty"},
                                  {"load_n,", "name 2, \"\", is empty"},
                                  {"load_n,,load_tx", "name 2, \"\", is empty"},
                                  {"load_n, load_tx", "name 2, \" load_tx\", is empty or contains a blank"},
                                  {"load_n,roll", "at most the width of the grid"}};
  petsam_contact   *c = NewContact(World(), OPTIONS), *d = NewContact(-1, OPTIONS);
  double            found[6], same[6], plain[6], rigid[6];
  const char       *unit;
  int               count;

  (void)state;
  for (int k = 0; k < 2; k++) {
    sam_assert(petsam_try(c, k + 1, names, rows[k], found, rigid) == 0 && petsam_commit(c) == 0);
    sam_assert(petsam_try(d, k + 1, names, rows[k], same, NULL) == 0 && petsam_commit(d) == 0);
    sam_assert(!memcmp(found, same, sizeof(found)) && rigid[1] == rows[k][1]);
  }
  sam_assert(TryComponents(c, 3, (int[6]){0, 0, 1, 1, 1, 1}, (double[6]){7.5e-6, 2e-7}, plain, NULL) == 0);
  sam_assert(petsam_try(d, 3, "disp_x,disp_z", (double[2]){2e-7, 7.5e-6}, same, NULL) == 0);
  sam_assert(!memcmp(plain, same, sizeof(same)) &&
             plain[1] != found[1]); /* without bulk stress, and friction as usual */
  for (size_t k = 0; k < sizeof(wrong) / sizeof(wrong[0]); k++)
    sam_assert(petsam_try(c, 4, wrong[k][0], odd, NULL, NULL) == 2 && strstr(petsam_message(c), wrong[k][1]));
  sam_assert(petsam_try(c, 4, NULL, odd, NULL, NULL) == 2 && petsam_try(c, 4, "", odd, NULL, NULL) == 2);
  sam_assert(petsam_try(c, 4, "load_n", &odd[1], NULL, NULL) == 0 && petsam_advise(c, NULL) == 2);
  sam_assert(petsam_advise(c, &count) == 0 && count >= 1 && strstr(petsam_warning(c, 0), "cells across"));
  sam_assert(!petsam_warning(c, count) && !petsam_warning(c, -1) && petsam_reject(c) == 0 && !petsam_warning(c, 0));
  sam_assert(!strcmp(petsam_step_name(c, 6, &unit), "disp_z") && !strcmp(unit, "m"));
  sam_assert(!petsam_step_name(c, -1, NULL) && !petsam_step_name(c, 1000, NULL) && !petsam_step_name(c, 12, NULL)[0]);
  for (int k = 18; strcmp(petsam_step_name(c, k, &unit), "bulk2_stress_xx"); k++)
    sam_assert(petsam_step_name(c, k, NULL) != NULL);
  sam_assert(!strcmp(unit, "Pa"));
  petsam_destroy(&c);
  petsam_destroy(&d);
}

/* Ranks that call different functions, or with different arguments, would wait for each other for ever. */
static void test_ranks_that_differ_are_refused(void **state)
{
  const char      words[] = "call the same with the same on all of them";
  petsam_contact *c = NewContact(World(), OPTIONS), *other = NULL;
  const int       none[6] = {0};
  int             rank, size;

  (void)state;
  (void)MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  (void)MPI_Comm_size(PETSC_COMM_WORLD, &size);
  sam_assert(petsam_commit(NULL) == 2 && strstr(petsam_message(NULL), "petsam_commit: the contact is NULL"));
  for (int k = 0; k < 11 && size > 1; k++) {
    const int    odd      = rank == size - 1;
    const double value[6] = {7e-6, odd && k == 0 ? 5e-7 : 0}, cycles = odd ? 0 : 10;
    const double rolled[2] = {1e-5, odd ? 1e-6 : 0};
    const int    code      = k == 0   ? TryComponents(c, 1, none, value, NULL, NULL)
                             : k == 1 ? TryComponents(c, odd, none, value, NULL, NULL)
                             : k == 2 ? petsam_try(c, 1, odd ? NULL : "disp_z", value, NULL, NULL)
                             : k == 3 ? (odd ? petsam_commit(c) : petsam_reject(c))
                             : k == 4 ? petsam_get_field(c, odd ? "gap" : "slip_x", NULL)
                             : k == 5 ? petsam_history(c, columns, ROWS - odd, values, NULL, NULL)
                             : k == 6 ? petsam_live(c, cycles, columns, ROWS, values, NULL, NULL)
                             : k == 7 ? petsam_save(c, odd ? "this.h5" : "that.h5")
                             : k == 8 ? petsam_try(c, 1, "roll,disp_z", rolled, NULL, NULL)
                             : k == 9 ? petsam_try(c, 1, odd ? "disp_z" : "load_n", rolled, NULL, NULL)
                                      : petsam_create(World(), odd ? NULL : OPTIONS, &other);

    sam_assert(code == 2 && strstr(petsam_message(k < 10 ? c : NULL), words));
  }
  sam_assert(!other && petsam_history(c, columns, ROWS, values, NULL, NULL) == 0);
  petsam_destroy(&c);
}

static void test_mistakes_are_named(void **state)
{
  petsam_contact *c      = NewContact(World(), OPTIONS);
  double          bad[3] = {0, 7e-6, NAN};

  (void)state;
  sam_assert(petsam_history(c, NULL, ROWS, values, NULL, NULL) == 2);
  sam_assert(petsam_history(c, columns, 0, values, NULL, NULL) == 2 && strstr(petsam_message(c), "no row"));
  sam_assert(petsam_history(c, columns, 1, bad, NULL, NULL) == 2 && strstr(petsam_message(c), "disp_x"));
  sam_assert(petsam_history(c, "time,disp_z,dispx", ROWS, values, NULL, NULL) == 2);
  sam_assert(strstr(petsam_message(c), "is disp_x meant?") != NULL);
  sam_assert(petsam_live(c, 0.5, columns, ROWS, values, NULL, NULL) == 2);
  sam_assert(petsam_live(c, 10, columns, ROWS - 1, values, NULL, NULL) == 2);
  sam_assert(strstr(petsam_message(c), "not a closed cycle") != NULL);
  sam_assert(petsam_history(c, columns, ROWS, values, NULL, NULL) == 0);
  petsam_destroy(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_history_has_the_same_bits_on_any_ranks),
    cmocka_unit_test(test_life_has_the_same_bits_on_any_ranks),
    cmocka_unit_test(test_monitor_stops_after_a_step),
    cmocka_unit_test(test_run_that_fails_keeps_what_it_committed),
    cmocka_unit_test(test_monitor_cannot_change_its_contact),
    cmocka_unit_test(test_copy_goes_on_and_reset_begins_anew),
    cmocka_unit_test(test_steps_after_a_life_wear),
    cmocka_unit_test(test_copy_of_another_contact_is_refused),
    cmocka_unit_test(test_steps_by_names),
    cmocka_unit_test(test_ranks_that_differ_are_refused),
    cmocka_unit_test(test_mistakes_are_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

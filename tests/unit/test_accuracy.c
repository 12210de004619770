/* The way of -accuracy from one trial to the next, for errors that are given. */
#include "samtest.h"
#include "../../src/run/choice/accuracyimpl.h"
#include <string.h>

/* Trials of one number on a grid that stays where it is. */
typedef struct {
  SamAccuracy asked;
  SamTask     task;
  SamChoice   c;
  SamTrial    t;
  PetscBool   last;
  char        limit[SAM_ACCURACY_LIMIT];
} Trials;

/* With given steps, first on n cells along both sides. */
static void Begin(Trials *a, PetscInt n)
{
  *a                = (Trials){.asked = {.error = 0.01}, .c = {{n, n}, 1, {1, 1}, {0, 0}}};
  a->task           = (SamTask){.asked = &a->asked, .number = PETSC_TRUE, .axes = 2, .few = n, .most = 4096};
  a->t.touched      = PETSC_TRUE;
  a->t.table.count  = 1;
  a->t.table.row[0] = (SamErrorRow){.name = "shear_max", .value = 1, .order = 1};
  a->t.steps        = 1;
}

/* Ends a trial with these errors of the number by the cells and by the steps, and this time (s) for a million cells. */
static void End(Trials *a, double by_cells, double by_steps, double seconds_per_million)
{
  SamErrorRow *row = &a->t.table.row[0];

  a->asked.trials++;
  a->task.seconds = seconds_per_million * 1e-6 * (double)a->c.n[0] * (double)a->c.n[1];
  a->task.spent += a->task.seconds;
  row->cells = row->of[SAM_CAUSE_CELLS] = by_cells;
  row->of[SAM_CAUSE_STEPS]              = by_steps;
  row->error                            = by_cells + by_steps;
  row->run[SAM_RUN_HALF]                = 1 + by_cells;
  row->run[SAM_RUN_QUARTER]             = 1 + 3 * by_cells;
  SamTaskChange(&a->task, &a->t, &a->c, &a->last, a->limit);
}

/* At first order 6.4 % on 512 cells become 1 % on 6.4 times as many; 12.8 % do on more than there may be. */
static void test_a_number_that_would_take_too_long_ends_the_trials(void **state)
{
  Trials a;

  (void)state;
  Begin(&a, 128);
  End(&a, 0.256, 0, 100);
  sam_assert(!a.last && a.c.n[0] == 512 && !a.limit[0]);
  End(&a, 0.064, 0, 100);
  sam_assert(a.last && a.c.n[0] == 512 && !strcmp(a.limit, "shear_max would need about -grid_n 3277, and 18 min"));
  Begin(&a, 128);
  End(&a, 0.512, 0, 100);
  End(&a, 0.128, 0, 100);
  sam_assert(a.last && a.c.n[0] == 512 && !strcmp(a.limit, "shear_max would need more than -grid_n 4096"));
}

static void test_the_same_number_is_tried_further_where_trials_take_little(void **state)
{
  Trials a;

  (void)state;
  Begin(&a, 128);
  End(&a, 0.256, 0, 1);
  End(&a, 0.064, 0, 1);
  sam_assert(!a.last && a.c.n[0] > 1024 && !a.limit[0]);
}

/* An error that falls slowly, or is unknown, is given another trial only if that does not take long. */
static void test_slow_numbers_have_short_trials_only(void **state)
{
  const double error[2] = {0.25, 1};

  (void)state;
  for (int k = 0; k < 2; k++)
    for (int slow = 0; slow < 2; slow++) {
      Trials a;

      Begin(&a, 128);
      End(&a, error[k], 0, slow ? 1000 : 20);
      sam_assert(!a.last && a.c.n[0] > 192);
      End(&a, error[k], 0, slow ? 1000 : 20);
      sam_assert(slow ? a.last && !strcmp(a.limit, "finer cells hardly lower it") : !a.last && !a.limit[0]);
    }
}

/* Where the given steps cause 90 %, cells of 5 % are enough; on few cells this is not yet believed. */
static void test_cells_are_no_finer_than_given_steps_are_worth(void **state)
{
  Trials a;

  (void)state;
  Begin(&a, 64);
  End(&a, 0.2, 0.9, 1);
  sam_assert(!a.last && a.c.n[0] > 128);
  End(&a, 0.05, 0.9, 1);
  sam_assert(a.last && !a.limit[0]);
  Begin(&a, 64);
  End(&a, 0.2, 0.001, 1);
  End(&a, 0.05, 0.001, 1);
  sam_assert(!a.last);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_number_that_would_take_too_long_ends_the_trials),
    cmocka_unit_test(test_the_same_number_is_tried_further_where_trials_take_little),
    cmocka_unit_test(test_slow_numbers_have_short_trials_only),
    cmocka_unit_test(test_cells_are_no_finer_than_given_steps_are_worth),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

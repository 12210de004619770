/*
 * Rolling in steps of time: fields that move over the grid, and steps that are tried, rejected and saved.
 */
#include "contacts.h"
#include <petsam/private/grid.h>

/* ---- fields ---- */

static double Wave(double x, double y, const void *context)
{
  (void)context;
  return sin(3 * x) * cos(2 * y) + x * y;
}

/* The largest error of a field moved by this distance, in its inner half. */
static double ErrorOf(PetscInt n, double roll, double roll_y)
{
  SamGrid      grid = NewGrid(n, n, 2, 2);
  Vec          from = NewFrom(grid, Wave, NULL), to = NewField(grid, 1);
  const double distance[2] = {roll, roll_y};
  double      *moved, error = 0;

  sam_call(SamGridMove(grid, 1, distance, SAM_BORDER_CONTINUES, from, to));
  moved = Whole(grid, 1, to);
  for (PetscInt j = n / 4; j < n - n / 4; j++)
    for (PetscInt i = n / 4; i < n - n / 4; i++)
      error =
        PetscMax(error, fabs(moved[j * n + i] - Wave(SamGridX(grid, i) + roll, SamGridY(grid, j) + roll_y, NULL)));
  free(moved);
  sam_destroy(&from, &to);
  sam_call(SamGridDestroy(&grid));
  return error;
}

static void test_parts_of_a_cell_are_interpolated_to_fourth_order(void **state)
{
  const double coarse = ErrorOf(32, 0.1, -0.07), fine = ErrorOf(64, 0.1 / 2, -0.07 / 2);

  (void)state;
  sam_assert(coarse < 1e-4 && coarse > 10 * fine);
  sam_assert(ErrorOf(32, 2.0 / 32 * 3, -2.0 / 32 * 5) < 1e-14);
}

/* What enters is 0, or as at the border; what is nearly a whole number of cells is one. */
static void test_what_enters(void **state)
{
  SamGrid        grid        = NewGrid(7, 9, 7, 9);
  const PetscInt shifts[][2] = {{2, 0}, {0, 3}, {-1, -4}, {30, 0}, {0, -30}};

  (void)state;
  for (size_t s = 0; s < sizeof(shifts) / sizeof(shifts[0]); s++)
    for (int continues = 0; continues < 2; continues++) {
      Vec          from = NewRandom(grid, 2, 1), to = NewRandom(grid, 2, 2);
      double      *before      = Whole(grid, 2, from), *after;
      const double distance[2] = {(double)shifts[s][0] * (1 + 1e-8), (double)shifts[s][1] * (1 - 1e-8)};
      PetscInt     low[2], high[2];

      sam_call(SamGridMove(grid, 2, distance, continues ? SAM_BORDER_CONTINUES : SAM_BORDER_ZERO, from, to));
      after = Whole(grid, 2, to);
      SamGridEntering(grid, distance, low, high);
      for (PetscInt c = 0; c < 2; c++)
        for (PetscInt j = 0; j < 9; j++)
          for (PetscInt i = 0; i < 7; i++) {
            const PetscInt k = i + shifts[s][0], l = j + shifts[s][1];
            const int      inside = k >= 0 && k < 7 && l >= 0 && l < 9;
            const PetscInt near = PetscMax(PetscMin(k, 6), 0), over = PetscMax(PetscMin(l, 8), 0);

            sam_assert(inside == (i >= low[0] && i < 7 - high[0] && j >= low[1] && j < 9 - high[1]));
            sam_assert(after[(c * 9 + j) * 7 + i] == (inside || continues ? before[(c * 9 + over) * 7 + near] : 0));
          }
      free(before);
      free(after);
      sam_destroy(&from, &to);
    }
  sam_call(SamGridDestroy(&grid));
}

/* ---- steps ---- */

#define OPTIONS "-sum_slip_path -wear_coefficient1 1e-12 -pressure_limit 4e8"

/* Two steps without rolling. */
static Case Begun(void)
{
  Case             c     = NewCase(Steel(), 41, 2, MU, OPTIONS);
  const SamControl first = Loads(&c, 1, 0.3, 0, 0), second = Loads(&c, 1, 0.6, 0.1, 0);

  Solve(&c, &first);
  Solve(&c, &second);
  return c;
}

static SamControl Rolled(const Case *c, double cells, double cells_y)
{
  SamControl control = Loads(c, 1, 0.6, 0.1, 0);

  Prescribe(c->problem, &control, "roll", cells * c->s.grid->dx);
  Prescribe(c->problem, &control, "roll_y", cells_y * c->s.grid->dy);
  return control;
}

static void test_rejected_steps_leave_no_trace(void **state)
{
  Case             one = Begun(), other = Begun();
  const SamControl far = Rolled(&one, 2.5, -1), step = Rolled(&one, 1, 0), stands = Loads(&one, 1, 0.5, 0, 0),
                   slides = Loads(&one, 1, 3, 0, 0);
  SamControl rolls_off    = slides;
  SamStep    a, b;

  (void)state;
  Prescribe(one.problem, &rolls_off, "roll", Prescribed(one.problem, &step, "roll"));
  Try(&one, &far);
  sam_call(SamContactReject(one.contact));
  sam_assert(SameBitsOf(&one, &other, NewSlip) && SameBitsOf(&one, &other, NewPath));
  Try(&one, &far);
  sam_assert(Try(&one, &rolls_off).status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_assert(SameBitsOf(&one, &other, NewSlip) && SameBitsOf(&one, &other, NewPath)); /* the committed ones */
  for (int k = 0; k < 3; k++) {
    const SamControl *control = k == 1 ? &stands : &step;

    Try(&one, &far);
    a = Solve(&one, control);
    b = Solve(&other, control);
    AssertSameOutcomes(&a, &b);
    AssertSameFields(&one, &other);
    sam_assert(SameBitsOf(&one, &other, NewPath));
  }
  DestroyCase(&one);
  DestroyCase(&other);
}

/* A state that is copied while a rolled step is tried is the committed one. */
static void test_a_tried_step_is_not_copied(void **state)
{
  Case             one = Begun(), other = NewCase(Steel(), 41, 2, MU, OPTIONS);
  const SamControl step = Rolled(&one, 1.5, 1);
  SamState         from;
  SamStep          a, b;

  (void)state;
  a = Try(&one, &step);
  sam_call(SamContactGetState(one.contact, &from));
  sam_call(SamContactSetState(other.contact, from, PETSC_TRUE));
  b = Try(&other, &step);
  AssertSameOutcomes(&a, &b);
  AssertSameFields(&one, &other);
  sam_assert(SameBitsOf(&one, &other, NewPath));
  DestroyCase(&one);
  DestroyCase(&other);
}

/* Yielded surfaces move under the pressure, which is found anew; so it is after them. */
static void test_pressure_follows_what_has_moved(void **state)
{
  Case             c    = Begun();
  const SamControl step = Rolled(&c, 4, 0), stands = Loads(&c, 1, 0.6, 0.1, 0);
  Vec              before = Copy(SolutionOf(&c)->pressure);

  (void)state;
  sam_assert(NumberOf(&c, "plastic_cells") > 0);
  sam_assert(Solve(&c, &step).status == SAM_STATUS_CONVERGED);
  sam_assert(Difference(before, SolutionOf(&c)->pressure, NORM_INFINITY) > 1e-3);
  sam_assert(Solve(&c, &stands).status == SAM_STATUS_CONVERGED);
  sam_call(VecDestroy(&before));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_parts_of_a_cell_are_interpolated_to_fourth_order),
    cmocka_unit_test(test_what_enters),
    cmocka_unit_test(test_rejected_steps_leave_no_trace),
    cmocka_unit_test(test_a_tried_step_is_not_copied),
    cmocka_unit_test(test_pressure_follows_what_has_moved),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

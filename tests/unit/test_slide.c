/*
 * Surfaces that slide past each other: interpolation and its transpose, volumes, which body the grid goes with, steps
 * that are tried, rejected and copied, and the pressure that follows the slide.
 */
#include "contacts.h"
#include <petsam/private/grid.h>
#include <petsam/wear.h>

/* ---- fields ---- */

/* The sum of the products, with the move by -distance as the transpose; a period, or zero beyond the border. */
static void test_moving_back_is_the_transpose(void **state)
{
  static const double distances[][2] = {{0.3, -1.7}, {-2.6, 0.2}, {5, -3}, {11.4, 0}, {0, -40.3}, {-29.5, 31.1}};

  (void)state;
  for (size_t s = 0; s < sizeof(distances) / sizeof(distances[0]); s++)
    for (int wraps = 0; wraps < 2; wraps++) {
      SamGrid         grid   = NewGrid(9, 7, 9, 7);
      const SamBorder border = wraps ? SAM_BORDER_WRAPS : SAM_BORDER_ZERO;
      const double    back[] = {-distances[s][0], -distances[s][1]};
      Vec    f = NewRandom(grid, 2, 1), g = NewRandom(grid, 2, 2), rg = NewField(grid, 2), tf = NewField(grid, 2);
      double sum;

      sam_call(SamGridMove(grid, 2, distances[s], border, g, rg));
      sam_call(SamGridMove(grid, 2, back, border, f, tf));
      sam_assert_close(Dot(f, rg), Dot(tf, g), 1e-13 * Norm(f, NORM_2) * Norm(g, NORM_2));
      sum = Sum(g);
      if (wraps) sam_assert_close(Sum(rg), sum, 1e-13 * Norm(g, NORM_1));
      sam_destroy(&f, &g, &rg, &tf);
      sam_call(SamGridDestroy(&grid));
    }
}

/* Whole cells of a period are moved to the bit, over the border and any number of periods. */
static void test_a_period_moves_round(void **state)
{
  static const PetscInt shifts[][2] = {{2, 0}, {0, 3}, {-1, -4}, {30, 2}, {-7, 0}, {0, -30}};

  SamGrid grid = NewGrid(7, 9, 7, 9);

  (void)state;
  for (size_t s = 0; s < sizeof(shifts) / sizeof(shifts[0]); s++) {
    const double distance[2] = {(double)shifts[s][0], (double)shifts[s][1]};
    Vec          from = NewRandom(grid, 1, 1), to = NewField(grid, 1);
    double      *before = Whole(grid, 1, from), *after;

    sam_call(SamGridMove(grid, 1, distance, SAM_BORDER_WRAPS, from, to));
    after = Whole(grid, 1, to);
    for (PetscInt j = 0; j < 9; j++)
      for (PetscInt i = 0; i < 7; i++)
        sam_assert(after[j * 7 + i] == before[(j + shifts[s][1] + 90) % 9 * 7 + (i + shifts[s][0] + 70) % 7]);
    free(before);
    free(after);
    sam_destroy(&from, &to);
  }
  sam_call(SamGridDestroy(&grid));
}

static double WaveAt(double x, double y, const void *cells)
{
  (void)y;
  return cos(2 * PETSC_PI * x / *(const double *)cells);
}

/* The largest error of a wave's height is that of cubic interpolation half way: 1 - 9/8 cos(t/2) + 1/8 cos(3t/2). */
static void test_waves_lose_a_known_part_of_their_height(void **state)
{
  static const double waves[][2] = {{4, 0.1161}, {8, 0.00847}, {16, 5.5e-4}, {32, 3.5e-5}};

  SamGrid grid = NewGrid(32, 2, 32, 2);

  (void)state;
  for (size_t k = 0; k < sizeof(waves) / sizeof(waves[0]); k++) {
    Vec    from = NewFrom(grid, WaveAt, &waves[k][0]), to = NewField(grid, 1);
    double before = Norm(from, NORM_2);

    sam_call(SamGridMove(grid, 1, (const PetscReal[]){3.5, 0}, SAM_BORDER_WRAPS, from, to));
    sam_assert_close(1 - Norm(to, NORM_2) / before, waves[k][1], 0.02 * waves[k][1]);
    sam_destroy(&from, &to);
  }
  sam_call(SamGridDestroy(&grid));
}

/* ---- steps ---- */

/* Body 2 has bumps a few cells wide, which are a hundredth of the approach high. */
static double Bumps(double x, double y, const void *context)
{
  const Sphere *s = (const Sphere *)context;

  return 0.01 * s->a * s->a / 0.1 * cos(9 * x / s->a) * cos(7 * y / s->a);
}

/* A sphere that wears itself and body 2 by these options, on a body 2 with bumps; it has been pressed on. */
static Case Pressed(double friction, PetscBool bumps, const char *options)
{
  Case             c     = NewCase(Steel(), 41, 2.5, friction, options);
  const SamControl press = Loads(&c, 1, 0, 0, 0);

  if (bumps) {
    Vec heights = NewFrom(c.s.grid, Bumps, &c.s);

    sam_call(SamLawSetSurface(SamProblemGetLaw(c.problem, SAM_LAW_SLIDE), 1, heights));
    sam_call(VecDestroy(&heights));
  }
  Solve(&c, &press);
  return c;
}

/* The sphere is moved to there, in its contact's radii. */
static SamControl Moved(const Case *c, double x, double y)
{
  SamControl control = Loads(c, 1, 0, 0, 0);

  Displace(&control, SAM_COMPONENT_TX, x * c->s.a);
  Displace(&control, SAM_COMPONENT_TY, y * c->s.a);
  return control;
}

static const double path[][2] = {{0.31, 0.1}, {0.77, -0.2}, {1.02, 0.06}, {0.4, 0.33}, {-0.13, 0.2}};
#define PATH (int)(sizeof(path) / sizeof(path[0]))

/* Both volumes are those of the same work of friction, though the scars are not the same, nor where they lie. */
static void test_volumes_do_not_depend_on_the_slide(void **state)
{
  static const char *const options[2] = {"-slide -wear_coefficient1 1e-14 -wear_coefficient2 2e-14",
                                         "-slide -wear_energy1 1e-14 -wear_energy2 2e-14"};

  (void)state;
  for (int law = 0; law < 2; law++) {
    Case   c    = Pressed(MU, PETSC_TRUE, options[law]);
    double work = 0, volume, sharp[2];

    for (int k = 0; k < PATH; k++) {
      const SamControl control = Moved(&c, path[k][0], path[k][1]);
      const SamStep    step    = Solve(&c, &control);

      AssertGood(&step);
      work += NumberOf(&c, "dissipated_energy");
    }
    volume = 1e-14 * work / (law ? 1 : MU);
    sam_assert_close(NumberOf(&c, "wear_volume1"), volume, 1e-5 * volume);
    sam_assert_close(NumberOf(&c, "wear_volume2"), 2 * NumberOf(&c, "wear_volume1"), 1e-12 * volume);
    for (int body = 0; body < 2; body++) {
      Vec depth = NewFieldOf(&c, body ? "wear_depth2" : "wear_depth1");

      sharp[body] = Norm(depth, NORM_2) / (body + 1);
      sam_call(VecDestroy(&depth));
    }
    sam_assert(sharp[1] < 0.95 * sharp[0]); /* the same volume on a larger area */
    DestroyCase(&c);
  }
}

/* Where nothing of body 2 changes the gap, all is as without sliding, to the bit. */
static void test_a_smooth_unworn_body_may_slide(void **state)
{
  Case one   = Pressed(MU, PETSC_FALSE, "-slide -wear_coefficient1 1e-14"),
       other = Pressed(MU, PETSC_FALSE, "-wear_coefficient1 1e-14");

  (void)state;
  for (int k = 0; k < PATH; k++) {
    const SamControl control = Moved(&one, path[k][0], path[k][1]);
    SamStep          a, b;

    a = Solve(&one, &control);
    b = Solve(&other, &control);
    AssertSameOutcomes(&a, &b);
    AssertSameFields(&one, &other);
  }
  sam_assert_close(NumberOf(&one, "slide_x"), path[PATH - 1][0] * one.s.a, 0.1 * one.s.a);
  DestroyCase(&one);
  DestroyCase(&other);
}

static void test_rejected_steps_leave_no_trace(void **state)
{
  Case one   = Pressed(MU, PETSC_TRUE, "-slide -wear_coefficient1 1e-14 -wear_coefficient2 2e-14 -cycle_memory 1e8"),
       other = Pressed(MU, PETSC_TRUE, "-slide -wear_coefficient1 1e-14 -wear_coefficient2 2e-14 -cycle_memory 1e8");

  (void)state;
  for (int k = 0; k < PATH; k++) {
    const SamControl control = Moved(&one, path[k][0], path[k][1]), far = Moved(&one, -0.9, 0.4);
    SamStep          a, b;

    Try(&one, &far);
    sam_call(SamContactReject(one.contact));
    Try(&one, &far);
    a = Solve(&one, &control);
    b = Solve(&other, &control);
    AssertSameSteps(&one, &a, &other, &b);
    sam_assert(NumberOf(&one, "slide_x") == NumberOf(&other, "slide_x"));
  }
  DestroyCase(&one);
  DestroyCase(&other);
}

/* A contact continues from the state of another one to the bit. */
static void test_a_copied_state_slides_on(void **state)
{
  Case one   = Pressed(MU, PETSC_TRUE, "-slide -wear_coefficient2 2e-14"),
       other = Pressed(MU, PETSC_TRUE, "-slide -wear_coefficient2 2e-14");
  SamState from;

  (void)state;
  for (int k = 0; k < PATH; k++) {
    const SamControl control = Moved(&one, path[k][0], path[k][1]);
    SamStep          a, b;

    sam_call(SamContactGetState(one.contact, &from));
    sam_call(SamContactSetState(other.contact, from, PETSC_FALSE));
    b = Try(&other, &control);
    a = Solve(&one, &control);
    AssertSameOutcomes(&a, &b);
    sam_call(SamContactCommit(other.contact));
    AssertSameSteps(&one, &a, &other, &b);
  }
  DestroyCase(&one);
  DestroyCase(&other);
}

/*
  Without wear the pressure is that of the place alone: it changes where body 2 has moved, stays to the bit where it has
  moved less than counts, and comes back with it.
*/
static void test_the_pressure_is_that_of_the_place(void **state)
{
  Case             c     = Pressed(0, PETSC_TRUE, "-slide");
  const SamControl there = Moved(&c, 1.1, 0), near = Moved(&c, 1.1 - 1e-4 * 5 / 41, 0), home = Moved(&c, 0, 0);
  Vec              first = Copy(SolutionOf(&c)->pressure), second;

  (void)state;
  Solve(&c, &there);
  second = Copy(SolutionOf(&c)->pressure);
  sam_assert(Difference(first, second, NORM_2) > 1e-2);
  Solve(&c, &near);
  sam_assert(SameBits(SolutionOf(&c)->pressure, second));
  sam_assert(NumberOf(&c, "slide_x") == (double)there.value[SAM_COMPONENT_TX]);
  Solve(&c, &home);
  sam_assert(Difference(first, SolutionOf(&c)->pressure, NORM_2) < 1e-5);
  sam_destroy(&first, &second);
  DestroyCase(&c);
}

/* ---- the frame ---- */

#define N_CELLS 24

static double Heights(double x, double y, const void *body)
{
  const int b = *(const int *)body;

  return b ? 2e-8 * (sin(2 * PETSC_PI * (x + 0.3)) + 0.5 * cos(2 * PETSC_PI * (2 * y - x)))
           : 3e-8 * cos(2 * PETSC_PI * (3 * x + y)) + 1e-8 * cos(2 * PETSC_PI * y);
}

/* Two rough periodic bodies on a unit square without friction but what wears; body `first` has the grid. */
typedef struct {
  SamGrid       grid;
  SamElasticity elasticity;
  SamProblem    problem;
  SamContact    contact;
} Rough;

static Rough NewRough(int first)
{
  const int second = 1 - first;
  SamPair   pair   = Steel();
  char      options[160];
  Rough     r;
  SamLaw    law;
  Vec       h;

  (void)snprintf(options, sizeof(options), "-slide -wear_coefficient1 %g -wear_coefficient2 %g", first ? 3e-17 : 1e-17,
                 first ? 1e-17 : 3e-17);
  SetOptions(options);
  r.grid = NewGrid(N_CELLS, N_CELLS, 1, 1);
  sam_call(SamElasticityCreate(r.grid, pair, &r.elasticity));
  sam_call(SamElasticitySetType(r.elasticity, SAM_ELASTICITY_PERIODIC));
  sam_call(SamProblemCreate(r.elasticity, &r.problem));
  h = NewFrom(r.grid, Heights, &first);
  sam_call(SamProblemSetGap(r.problem, h));
  sam_call(VecDestroy(&h));
  sam_call(SamProblemSetFriction(r.problem, 1e-9));
  sam_call(SamProblemSetLawsFromOptions(r.problem, &(SamOptions){r.grid->comm, NULL}));
  law = SamProblemGetLaw(r.problem, SAM_LAW_SLIDE);
  h   = NewFrom(r.grid, Heights, &second);
  sam_call(SamLawSetSurface(law, 1, h));
  sam_call(VecDestroy(&h));
  sam_call(SamContactCreate(r.problem, &r.contact));
  sam_call(SamContactSetFromOptions(r.contact));
  sam_call(SamPairDestroy(&pair));
  SetOptions("");
  return r;
}

/* The wear depths of a body at its own points, after a path over several periods by whole cells. */
static double *Worn(int first, int body)
{
  Rough         r        = NewRough(first);
  static double moves[5] = {3, 8, 2, -19, -64};
  double       *depth;
  Vec           field = NewField(r.grid, 1);

  for (int k = 0; k < 5; k++) {
    SamControl control;
    SamStep    step;

    sam_call(SamControlInitialize(&control));
    control.value[SAM_COMPONENT_N] = 2e4;
    Displace(&control, SAM_COMPONENT_TX, (first ? -1 : 1) * moves[k] / N_CELLS);
    Displace(&control, SAM_COMPONENT_TY, 0);
    sam_call(SamContactTry(r.contact, &control, &step));
    sam_assert(step.status == SAM_STATUS_CONVERGED);
    sam_call(SamContactCommit(r.contact));
  }
  sam_call(SamContactGetField(r.contact, body == first ? "wear_depth1" : "wear_depth2", field));
  depth = Whole(r.grid, 1, field);
  sam_call(VecDestroy(&field));
  sam_call(SamContactDestroy(&r.contact));
  sam_call(SamProblemDestroy(&r.problem));
  sam_call(SamElasticityDestroy(&r.elasticity));
  sam_call(SamGridDestroy(&r.grid));
  return depth;
}

static void test_the_grid_may_go_with_either_body(void **state)
{
  (void)state;
  for (int body = 0; body < 2; body++) {
    double *here = Worn(0, body), *there = Worn(1, body), most = 0, error = 0;

    for (PetscInt k = 0; k < N_CELLS * N_CELLS; k++) {
      most  = PetscMax(most, here[k]);
      error = PetscMax(error, fabs(here[k] - there[k]));
    }
    sam_assert(most > 0 && error < 1e-5 * most);
    free(here);
    free(there);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_moving_back_is_the_transpose),
    cmocka_unit_test(test_a_period_moves_round),
    cmocka_unit_test(test_waves_lose_a_known_part_of_their_height),
    cmocka_unit_test(test_volumes_do_not_depend_on_the_slide),
    cmocka_unit_test(test_a_smooth_unworn_body_may_slide),
    cmocka_unit_test(test_rejected_steps_leave_no_trace),
    cmocka_unit_test(test_a_copied_state_slides_on),
    cmocka_unit_test(test_the_pressure_is_that_of_the_place),
    cmocka_unit_test(test_the_grid_may_go_with_either_body),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/* Friction that depends on the temperature that it causes: its solution, its cost, and heat that runs away. */
#include "fields.h"

#include "../../src/laws/heat/contactheat.h"

#include <math.h>

static const PetscReal none[2] = {0, 0};

/* The contact of CONTACT's example ertz_temperature in full slip: rates of slip in its ellipse, and its bodies. */
typedef struct {
  SamGrid     grid;
  SamHeatPair pair;
  SamHeatRate rate;
  Vec         temperature;
} Wheel;

static Wheel NewWheel(PetscInt nx, PetscInt ny, PetscReal capacity_2)
{
  static const double half[2] = {6.46e-3, 10.9e-3}, most = 678e6;
  Wheel               w    = {.grid = NewGrid(nx, ny, 16e-3, 24e-3), .pair = {.rtol = 1e-9, .most = 200}};
  const SamHeatBody   b[2] = {{50, 3.5325e6, -30}, {50, capacity_2, -30}};
  double             *p;

  for (int k = 0; k < 2; k++) sam_call(SamConductorCreate(w.grid, NULL, &b[k], 0, &w.pair.body[k]));
  w.rate        = (SamHeatRate){w.grid, NewField(w.grid, 1), NewField(w.grid, 1), NewField(w.grid, 1)};
  w.temperature = NewField(w.grid, 1);
  sam_call(VecGetArray(w.rate.pressure, &p));
  for (PetscInt k = 0; k < w.grid->cells; k++) {
    const double x = ((double)(k % nx) + 0.5 - 0.5 * nx) * w.grid->dx / half[0],
                 y = ((double)(w.grid->row_start + k / nx) + 0.5 - 0.5 * ny) * w.grid->dy / half[1];

    p[k] = most * sqrt(fmax(0, 1 - x * x - y * y));
  }
  sam_call(VecRestoreArray(w.rate.pressure, &p));
  sam_call(VecCopy(w.rate.pressure, w.rate.bound));
  sam_call(VecScale(w.rate.bound, 0.3));
  sam_call(VecSet(w.rate.rate, 1));
  return w;
}

static void DestroyWheel(Wheel *w)
{
  sam_destroy(&w->rate.pressure, &w->rate.bound, &w->rate.rate, &w->temperature);
  for (int k = 0; k < 2; k++) sam_call(SamConductorDestroy(&w->pair.body[k]));
  sam_call(SamGridDestroy(&w->grid));
}

/* The largest difference in contact between the temperature and that by its heat, over the largest temperature. */
static double Misfit(const Wheel *w, const SamHeatFriction *friction)
{
  Vec     heat = NewField(w->grid, 1), heat_2 = NewField(w->grid, 1), surface[2] = {NewField(w->grid, 1), NULL};
  double *p, *t, *q, *found, most[2] = {0};
  char    failed[192];

  sam_call(VecGetArray(w->rate.pressure, &p));
  sam_call(VecGetArray(w->temperature, &t));
  sam_call(VecGetArray(heat, &q));
  for (PetscInt k = 0; k < w->grid->cells; k++)
    q[k] = (0.3 + friction->change * fmin(1, fmax(0, (t[k] - friction->from) / friction->over))) * p[k];
  sam_call(VecRestoreArray(heat, &q));
  sam_call(SamHeatTemperatures(&w->pair, w->rate.pressure, heat, none, heat_2, surface, failed, sizeof(failed)));
  sam_assert(!failed[0]);
  sam_call(VecGetArray(surface[0], &found));
  for (PetscInt k = 0; k < w->grid->cells; k++) {
    if (!(p[k] > 0)) continue;
    most[0] = fmax(most[0], fabs(found[k] - t[k]));
    most[1] = fmax(most[1], found[k]);
  }
  sam_call(VecRestoreArray(surface[0], &found));
  sam_call(VecRestoreArray(w->temperature, &t));
  sam_call(VecRestoreArray(w->rate.pressure, &p));
  sam_call(SamMax(PETSC_COMM_WORLD, 2, most));
  sam_destroy(&heat, &heat_2, &surface[0]);
  return most[0] / most[1];
}

/* Products: 15 for a mild law, 43 for one that falls by 0.18 in 30 K (measured with a Newton method with GMRES). */
static void test_friction_and_temperature_belong_to_each_other(void **state)
{
  static const struct {
    SamHeatFriction friction;
    PetscReal       capacity;
    PetscInt        products;
  } rows[] = {{{0, 400, -0.18}, 3.5325e6, 15},
              {{20, 30, -0.18}, 3.5325e6, 43},
              {{20, 30, -0.18}, 1e6, 43},
              {{0, 400, 0.1}, 3.5325e6, 15}};

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(*rows); k++) {
    Wheel    w = NewWheel(40, 30, rows[k].capacity);
    PetscInt products;
    char     failed[192];

    sam_call(SamHeatSolveFriction(&w.pair, none, &rows[k].friction, &w.rate, w.temperature, &products, failed,
                                  sizeof(failed)));
    sam_assert(!failed[0]);
    sam_assert(products <= rows[k].products);
    sam_assert(Misfit(&w, &rows[k].friction) < 2e-8);
    DestroyWheel(&w);
  }
}

static void test_results_do_not_depend_on_the_start(void **state)
{
  const SamHeatFriction friction = {20, 30, -0.18};
  Wheel                 one = NewWheel(23, 18, 1e6), other = NewWheel(23, 18, 1e6);
  PetscReal             most, difference;
  PetscInt              products;
  char                  failed[192];
  double               *t, *p;

  (void)state;
  sam_call(VecGetArray(other.temperature, &t));
  sam_call(VecGetArray(other.rate.pressure, &p));
  for (PetscInt k = 0; k < other.grid->cells; k++) t[k] = p[k] > 0 ? 200 : 0;
  sam_call(VecRestoreArray(other.rate.pressure, &p));
  sam_call(VecRestoreArray(other.temperature, &t));
  for (int k = 0; k < 2; k++) {
    Wheel *w = k ? &other : &one;

    sam_call(
      SamHeatSolveFriction(&w->pair, none, &friction, &w->rate, w->temperature, &products, failed, sizeof(failed)));
    sam_assert(!failed[0]);
  }
  sam_call(VecNorm(one.temperature, NORM_INFINITY, &most));
  sam_call(VecAXPY(other.temperature, -1, one.temperature));
  sam_call(VecNorm(other.temperature, NORM_INFINITY, &difference));
  sam_assert(most > 20 && difference < 1e-6 * most);
  DestroyWheel(&one);
  DestroyWheel(&other);
}

/* Heat rises with friction that rises with temperature, so steeply that there is no solution before its end. */
static void test_temperature_that_runs_away_reaches_the_end_of_the_rise(void **state)
{
  const SamHeatFriction friction = {5, 10, 3};
  Wheel                 w        = NewWheel(23, 18, 3.5325e6);
  PetscInt              products;
  char                  failed[192];

  (void)state;
  sam_call(SamHeatSolveFriction(&w.pair, none, &friction, &w.rate, w.temperature, &products, failed, sizeof(failed)));
  sam_assert(failed[0] ? strstr(failed, "may run away") != NULL : Misfit(&w, &friction) < 2e-8);
  DestroyWheel(&w);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_friction_and_temperature_belong_to_each_other),
    cmocka_unit_test(test_results_do_not_depend_on_the_start),
    cmocka_unit_test(test_temperature_that_runs_away_reaches_the_end_of_the_rise),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

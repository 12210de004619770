/*
 * A film between the surfaces: what it adds to tangential products, on coarser grids and parts of the grid too.
 */
#include "fields.h"

#include <petsam/private/elasticity.h>

#define FILM 3e-12 /* m/Pa */

static SamElasticity NewElasticity(SamGrid grid, SamElasticityType type, double film)
{
  SamPair       pair = NewPair(210e9, 0.3, 70e9, 0.2);
  SamElasticity e;

  pair->film[0] = film * 1e9;
  pair->film[1] = 1e9;
  sam_call(SamElasticityCreate(grid, pair, &e));
  sam_call(SamElasticitySetType(e, type));
  return e;
}

/* The difference of the products with and without the film is that of the film alone. */
static void AssertFilm(SamElasticity with, SamElasticity without)
{
  SamGrid grid;
  Vec     q, u, v;

  grid = SamElasticityGetGrid(with);
  q    = NewRandom(grid, 2, 7);
  u    = NewField(grid, 2);
  v    = Copy(q);
  sam_call(SamElasticityApplyTangential(with, q, u));
  sam_call(SamElasticityApplyTangential(with, v, v)); /* in place */
  sam_assert(Difference(u, v, NORM_INFINITY) == 0);
  sam_call(SamElasticityApplyTangential(without, q, v));
  sam_call(VecAXPY(v, FILM, q));
  sam_assert(Difference(u, v, NORM_INFINITY) < 1e-14);
  sam_destroy(&q, &u, &v);
}

/* In single precision, in place or not; `factor` times the product. */
static void AssertSingle(SamElasticity e)
{
  const double factor = 1e11;
  SamGrid      grid;
  PetscInt     n, wrong = 0;
  double      *exact;
  float       *x, *y;
  Vec          q, u;

  grid = SamElasticityGetGrid(e);
  n    = 2 * grid->cells;
  q    = NewRandom(grid, 2, 8);
  u    = NewField(grid, 2);
  x    = (float *)calloc((size_t)n + 1, sizeof(*x));
  y    = (float *)calloc((size_t)n + 1, sizeof(*y));
  sam_assert(x && y);
  sam_call(SamElasticityApplyTangential(e, q, u));
  sam_call(VecGetArray(q, &exact));
  for (PetscInt k = 0; k < n; k++) x[k] = (float)exact[k];
  sam_call(VecRestoreArray(q, &exact));
  sam_call(SamElasticityApplyTangentialSingle(e, factor, x, y));
  sam_call(SamElasticityApplyTangentialSingle(e, factor, x, x));
  sam_call(VecGetArray(u, &exact));
  for (PetscInt k = 0; k < n; k++) wrong += x[k] != y[k] || !(fabs(y[k] - factor * exact[k]) < 1e-4);
  sam_assert(wrong == 0);
  sam_call(VecRestoreArray(u, &exact));
  free(x);
  free(y);
  sam_destroy(&q, &u);
}

static void test_products_have_the_film(void **state)
{
  const SamElasticityType types[] = {SAM_ELASTICITY_HALFSPACE, SAM_ELASTICITY_PERIODIC};
  const PetscInt          first[] = {9, 11}, n[] = {14, 12};

  (void)state;
  for (int t = 0; t < 2; t++) {
    SamGrid       grid = NewGrid(40, 36, 1e-3, 0.9e-3);
    SamElasticity with = NewElasticity(grid, types[t], FILM), without = NewElasticity(grid, types[t], 0);
    SamElasticity coarse[2], part[2];
    SamTransfer   transfer;
    SamWindow     window;
    PetscReal     self[2];

    AssertFilm(with, without);
    AssertSingle(with);
    sam_call(SamElasticityGetSelfInfluence(with, NULL, &self[0]));
    sam_call(SamElasticityGetSelfInfluence(without, NULL, &self[1]));
    sam_assert(fabs(self[0] - self[1] - FILM) < 1e-14 * FILM);
    sam_call(SamElasticityGetCoarse(with, &coarse[0], &transfer));
    sam_call(SamElasticityGetCoarse(without, &coarse[1], &transfer));
    AssertFilm(coarse[0], coarse[1]);
    if (t == 0) {
      sam_call(SamElasticityChoosePart(with, first, n, PETSC_FALSE, &window, &part[0]));
      sam_call(SamElasticityChoosePart(without, first, n, PETSC_FALSE, &window, &part[1]));
      AssertFilm(part[0], part[1]);
    }
    sam_call(SamElasticityDestroy(&with));
    sam_call(SamElasticityDestroy(&without));
    sam_call(SamGridDestroy(&grid));
  }
}

/* Of periodic bodies the preconditioner is the inverse, but for the mean. */
static void test_preconditioner_knows_the_film(void **state)
{
  SamGrid       grid = NewGrid(24, 20, 1e-3, 1e-3);
  SamElasticity e    = NewElasticity(grid, SAM_ELASTICITY_PERIODIC, FILM);
  Vec           q = NewField(grid, 2), u = NewField(grid, 2);
  PetscInt      wrong = 0;
  double       *a;
  float        *r = (float *)calloc((size_t)(2 * grid->cells) + 1, sizeof(*r));

  (void)state;
  sam_assert(r != NULL);
  sam_call(VecGetArray(q, &a));
  for (PetscInt k = 0; k < grid->cells; k++) {
    a[k]               = cos(2 * PETSC_PI * 3 * (double)(k % 24) / 24);
    a[k + grid->cells] = sin(2 * PETSC_PI * (2 * (double)(k % 24) / 24 + (double)(grid->row_start + k / 24) / 20));
  }
  sam_call(VecRestoreArray(q, &a));
  sam_call(SamElasticityApplyTangential(e, q, u));
  sam_call(VecScale(u, 1e12));
  sam_call(VecGetArray(u, &a));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) r[k] = (float)a[k];
  sam_call(VecRestoreArray(u, &a));
  sam_call(SamElasticityPreconditionTangentialSingle(e, 1e-12, r, r));
  sam_call(VecGetArray(q, &a));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) wrong += !(fabs(r[k] - a[k]) < 1e-5);
  sam_assert(wrong == 0);
  sam_call(VecRestoreArray(q, &a));
  free(r);
  sam_destroy(&q, &u);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_products_have_the_film),
    cmocka_unit_test(test_preconditioner_knows_the_film),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
  Plastic strain that comes up to the surface as wear removes material: means of smooth profiles, their order, and what
  is lost.
*/
#include "fields.h"

#include "../../src/laws/plastic/plasticnewton.h"

#define SIZE  (7 + 6) /* strain, its accumulated size and a backstress */
#define DEPTH 1.0
#define PEAK  0.6 /* depth of the profile's maximum */
#define WIDE  0.15

/* The integral of the profile exp(-((z - PEAK)/WIDE)^2) from 0 to z. */
static double Integral(double z)
{
  return 0.5 * sqrt(PETSC_PI) * WIDE * (erf((z - PEAK) / WIDE) + erf(PEAK / WIDE));
}

static double MeanOver(double top, double thickness)
{
  return (Integral(top + thickness) - Integral(top)) / thickness;
}

/* The factor of value v of a layer on the profile: the components zz of both tensors are minus the sum of xx and yy. */
static double FactorOf(PetscInt v)
{
  if (v == 2) return -(FactorOf(0) + FactorOf(1));
  if (v == 7 + 2) return -(FactorOf(7) + FactorOf(8));
  return (double)(v + 1);
}

typedef struct {
  SamPlastic p;
  PetscReal *thickness;
  double    *strain;
  PetscInt   body; /* of two, the one that is moved */
} Case;

/* The profile in all cells of both bodies. */
static Case NewProfiles(SamGrid grid, PetscInt layers, double first)
{
  Case c = {.p = {.grid = grid, .bodies = 2, .layers = layers, .size = SIZE}, .body = 1};

  sam_call(PetscMalloc1(layers, &c.thickness));
  SamPlasticGrade(layers, first, DEPTH, c.thickness);
  c.p.thickness = c.thickness;
  sam_call(PetscMalloc1(2 * layers * SIZE * grid->cells, &c.strain));
  for (PetscInt l = 0; l < 2 * layers; l++) {
    double top = 0;

    for (PetscInt m = 0; m < l % layers; m++) top += (double)c.thickness[m];
    for (PetscInt k = 0; k < SIZE * grid->cells; k++)
      c.strain[l * SIZE * grid->cells + k] = FactorOf(k / grid->cells) * MeanOver(top, (double)c.thickness[l % layers]);
  }
  return c;
}

static void DestroyProfiles(Case *c)
{
  sam_call(PetscFree(c->thickness));
  sam_call(PetscFree(c->strain));
}

/* Removes a depth in some equal parts; cells of odd numbers lose nothing. */
static void Remove(Case *c, double depth, int parts)
{
  const PetscInt cells = c->p.grid->cells;
  double        *by;

  sam_call(PetscMalloc1(cells, &by));
  for (PetscInt k = 0; k < cells; k++) by[k] = k % 2 ? -depth : depth / parts;
  for (int n = 0; n < parts; n++) sam_call(SamPlasticRaise(&c->p, c->body, by, c->strain));
  sam_call(PetscFree(by));
}

/* The largest error of a column over depths that stay within the layers, relative to the peak. */
static double ErrorOf(const Case *c, double depth, PetscInt cell)
{
  const PetscInt cells = c->p.grid->cells;
  double         top = 0, most = 0;

  for (PetscInt l = 0; l < c->p.layers; top += (double)c->thickness[l++])
    for (PetscInt v = 0; v < SIZE && top + depth + (double)c->thickness[l] < DEPTH; v++) {
      const double found = c->strain[((c->body * c->p.layers + l) * SIZE + v) * cells + cell];

      most = PetscMax(most, fabs(found / FactorOf(v) - MeanOver(top + depth, (double)c->thickness[l])));
    }
  return most;
}

static double ErrorWith(PetscInt layers, double first, double depth, int parts)
{
  SamGrid grid  = NewGrid(4, 3, 1, 1);
  Case    c     = NewProfiles(grid, layers, first);
  double  error = 0;

  Remove(&c, depth, parts);
  for (PetscInt k = 0; k < grid->cells; k++) error = PetscMax(error, ErrorOf(&c, k % 2 ? 0 : depth, k));
  sam_call(SamMax(grid->comm, 1, &error));
  DestroyProfiles(&c);
  sam_call(SamGridDestroy(&grid));
  return error;
}

static void test_a_removed_depth_shifts_the_profile(void **state)
{
  (void)state;
  sam_assert(ErrorWith(16, DEPTH / 16, DEPTH / 16, 1) < 1e-14); /* a whole layer: without error */
  sam_assert(ErrorWith(32, DEPTH / 32, 0.07, 1) < 0.05);
  sam_assert(ErrorWith(64, DEPTH / 64, 0.07, 1) < 0.0125);
  sam_assert(ErrorWith(128, DEPTH / 128, 0.07, 1) < 0.0035);
  sam_assert(ErrorWith(128, DEPTH / 512, 0.07, 1) < 0.0125);
}

static void test_many_small_depths_are_their_sum(void **state)
{
  const double coarse = ErrorWith(64, DEPTH / 64, 0.2, 100), fine = ErrorWith(128, DEPTH / 128, 0.2, 200);

  (void)state;
  sam_assert(coarse < 0.1);
  sam_assert(fine < 0.5 * coarse);
}

/* A strain in single layers keeps between its least and largest value, however it is moved, and does not change the
   volume. */
static void test_no_value_leaves_the_range_of_the_profile(void **state)
{
  SamGrid        grid  = NewGrid(4, 3, 1, 1);
  Case           c     = NewProfiles(grid, 12, DEPTH / 20);
  const PetscInt cells = grid->cells, count = 2 * c.p.layers * SIZE * cells;
  double         range[2] = {1, 0}, volume = 0;

  (void)state;
  for (PetscInt k = 0; k < count; k++) {
    const PetscInt v = k / cells % SIZE, layer = k / (SIZE * cells) % 5;

    c.strain[k] = layer == (v == 1 || v == 7 + 1 ? 3 : 2) ? 1 : 0; /* yy elsewhere than the others */
    if (v == 2 || v == 7 + 2) c.strain[k] = -(c.strain[k - cells] + c.strain[k - 2 * cells]);
  }
  for (int n = 0; n < 7; n++) {
    Remove(&c, 0.02, 1);
    for (PetscInt k = 0; k < count; k++) {
      const PetscInt v = k / cells % SIZE;

      if (v == 2 || v == 7 + 2) {
        volume = PetscMax(volume, fabs(c.strain[k] + (c.strain[k - cells] + c.strain[k - 2 * cells])));
      } else {
        range[0] = PetscMin(range[0], c.strain[k]);
        range[1] = PetscMax(range[1], c.strain[k]);
      }
    }
  }
  sam_assert(range[0] >= -1e-15 && range[1] <= 1 + 1e-15 && volume == 0);
  DestroyProfiles(&c);
  sam_call(SamGridDestroy(&grid));
}

/* What lies above the removed depth is gone, the rest stays; nothing comes up from below, and the other body stays. */
static void test_the_removed_part_is_gone(void **state)
{
  SamGrid        grid = NewGrid(4, 3, 1, 1);
  Case           c = NewProfiles(grid, 20, DEPTH / 50), virgin = NewProfiles(grid, 20, DEPTH / 50);
  const PetscInt cells = grid->cells, other = c.p.layers * SIZE * cells;
  double         sum = 0, changed = 0;

  (void)state;
  Remove(&c, 0.5, 1);
  for (PetscInt l = 0; l < c.p.layers && cells; l++) sum += (double)c.thickness[l] * c.strain[other + l * SIZE * cells];
  sam_assert(!cells || fabs(sum - (Integral(DEPTH) - Integral(0.5))) < 5e-3 * Integral(DEPTH));
  for (PetscInt k = 0; k < other; k++) changed = PetscMax(changed, fabs(c.strain[k] - virgin.strain[k]));
  sam_assert(changed == 0);
  Remove(&c, 2 * DEPTH, 1);
  for (PetscInt l = 0; l < c.p.layers && cells; l++)
    changed = PetscMax(changed, fabs(c.strain[other + l * SIZE * cells]));
  sam_assert(changed == 0);
  DestroyProfiles(&c);
  DestroyProfiles(&virgin);
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_removed_depth_shifts_the_profile),
    cmocka_unit_test(test_many_small_depths_are_their_sum),
    cmocka_unit_test(test_no_value_leaves_the_range_of_the_profile),
    cmocka_unit_test(test_the_removed_part_is_gone),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

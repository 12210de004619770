/* Half-spaces of which one creeps while its material streams: products against sums over all cells ahead. */
#include "elasticities.h"

#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/halfspace.h>

#include <math.h>

/* Lengths by which the material moves in the times of the terms, in cells: below one, some towards +x, and beyond the
   grid. */
static const double lengths[]                    = {0.3, -6, 300};
static const double values[][SAM_PAIR_CONSTANTS] = {{3e-12, 1e-12, 4e-13}, {1e-11, -2e-12, 5e-13}, {2e-11, 0, -3e-12}};
enum { TERMS = 3, ENDS = 45 }; /* lengths after which the rest of a sum is below rounding */

/* Kernels: u_z by p; u_t by q; u_t by p; u_z by q */
typedef struct {
  Product  apply;
  PetscInt n_in, n_out;
} Way;
static const Way ways[] = {{SamElasticityApplyNormal, 1, 1},
                           {SamElasticityApplyTangential, 2, 2},
                           {SamElasticityApplyNormalToTangential, 1, 2},
                           {SamElasticityApplyTangentialToNormal, 2, 1}};

/* The integral of ln(|x|/D) over a cell. */
static double Log(long double x, long double h, long double datum)
{
  long double sum = -h;

  for (int s = -1; s <= 1; s += 2) {
    const long double at = x + (long double)s * h / 2;

    if (at != 0) sum += (long double)s * at * logl(fabsl(at) / datum);
  }
  return (double)sum;
}

/* Displacement at the lag (i, j) without creep, for the constants A, B and D. */
static double Kernel(SamGrid g, int way, PetscInt in, PetscInt out, const double c[3], PetscInt i, PetscInt j)
{
  static const SamIntegral same[2] = {SAM_INTEGRAL_XX, SAM_INTEGRAL_YY}, push[2] = {SAM_INTEGRAL_X, SAM_INTEGRAL_Y};
  const double             dx = (double)g->dx, dy = (double)g->dy;

  if (SamGridIsRow(g)) {
    const PetscInt component = PetscMax(in, out);

    if (way > 1) return component ? 0 : (way == 3 ? -1 : 1) * PETSC_PI * c[2] * dx * ((i > 0) - (i < 0));
    if (in != out) return 0;
    return -2 * (c[0] + (component ? c[1] : 0)) * Log((long double)i * dx, dx, (long double)g->width[0]);
  }
  if (way > 1) return (way == 3 ? -1 : 1) * c[2] * SamIntegralCell(push[PetscMax(in, out)], dx, dy, i, j);
  if (in != out) return c[1] * SamIntegralCell(SAM_INTEGRAL_XY, dx, dy, i, j);
  if (way == 0) return c[0] * SamIntegralCell(SAM_INTEGRAL_R, dx, dy, i, j);
  return c[0] * SamIntegralCell(SAM_INTEGRAL_R, dx, dy, i, j) + c[1] * SamIntegralCell(same[in], dx, dy, i, j);
}

/*
  The same with creep: a unit traction on a cell is followed in it by c = now, s cells farther in the direction of the
  material by (before + kept now) kept^(s - 1), and displaces by them.
*/
static double Streaming(SamGrid g, int way, PetscInt in, PetscInt out, const double sudden[3], PetscInt i, PetscInt j)
{
  double sum = Kernel(g, way, in, out, sudden, i, j);

  for (int k = 0; k < TERMS; k++) {
    const double   x = 1 / fabs(lengths[k]), kept = exp(-x), mean = (1 - kept) / x;
    const PetscInt far = (PetscInt)(ENDS * fabs(lengths[k])) + 2, ahead = lengths[k] > 0 ? 1 : -1;
    double         c = mean - kept + kept * (1 - mean);

    sum += (1 - mean) * Kernel(g, way, in, out, values[k], i, j);
    for (PetscInt s = 1; s < far; s++, c *= kept) sum += c * Kernel(g, way, in, out, values[k], i + ahead * s, j);
  }
  return sum;
}

/* Gives bodies the stream of these tests, with lengths in cells of the size dx. */
static void SetStream(SamElasticity e, PetscReal dx)
{
  SamStream stream = {.terms = TERMS};

  for (int k = 0; k < TERMS; k++) {
    stream.length[k] = lengths[k] * (double)dx;
    for (int c = 0; c < SAM_PAIR_CONSTANTS; c++) stream.value[k][c] = values[k][c];
  }
  sam_call((*e->ops.setstream)(e, &stream));
}

/* Compares the products with a unit traction on a cell. */
static void Compare(SamElasticity e, int way, PetscInt in)
{
  const SamGrid  g     = SamElasticityGetGrid(e);
  const PetscInt at[2] = {g->nx / 3, g->ny / 2}, n_out = ways[way].n_out;
  double         sudden[SAM_PAIR_CONSTANTS], *u;
  Vec            from = NewField(g, ways[way].n_in), to = NewField(g, n_out);

  SamPairGetValues(SamElasticityGetPair(e), sudden);
  AddAt(g, in, at[0], at[1], 1, from);
  sam_call(ways[way].apply(e, from, to));
  u = Whole(g, n_out, to);
  for (PetscInt out = 0; out < n_out; out++)
    for (PetscInt j = 0; j < g->ny; j++)
      for (PetscInt i = 0; i < g->nx; i++)
        sam_assert_close(u[(out * g->ny + j) * g->nx + i], Streaming(g, way, in, out, sudden, i - at[0], j - at[1]),
                         1e-9 * values[0][0] * (double)g->dx);
  free(u);
  sam_destroy(&from, &to);
}

static void test_products_are_sums_over_all_that_the_material_has_borne(void **state)
{
  (void)state;
  for (int n = 0; n < 2; n++) {
    SamGrid g =
      n ? NewGridOn(PETSC_COMM_WORLD, 13, 1, 3e-3, 1, 1e-3, 0) : NewGridOn(PETSC_COMM_WORLD, 7, 5, 3e-3, 2e-3, 0, 0);
    SamElasticity e = NewDissimilar(g);

    if (n) *SamHalfSpaceDatum(e) = g->width[0];
    SetStream(e, g->dx);
    for (int way = 0; way < 4; way++)
      for (PetscInt in = 0; in < ways[way].n_in; in++) Compare(e, way, in);
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&g));
  }
}

static void test_the_coarse_grid_of_periods_has_the_same_stream(void **state)
{
  SamGrid       g = NewGridOn(PETSC_COMM_WORLD, 32, 24, 3e-3, 2e-3, 0, 0), half;
  SamElasticity e = NewDissimilar(g), coarse, same;
  SamTransfer   transfer;
  PetscReal     most;
  Vec           from, to, other;

  (void)state;
  sam_call(SamElasticitySetType(e, SAM_ELASTICITY_PERIODIC));
  SetStream(e, g->dx);
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  half = SamElasticityGetGrid(coarse);
  same = NewDissimilar(half);
  sam_call(SamElasticitySetType(same, SAM_ELASTICITY_PERIODIC));
  SetStream(same, g->dx);
  from  = NewField(half, 1);
  to    = NewField(half, 1);
  other = NewField(half, 1);
  AddAt(half, 0, 5, 3, 1, from);
  sam_call(SamElasticityApplyNormal(coarse, from, to));
  sam_call(SamElasticityApplyNormal(same, from, other));
  sam_call(VecNorm(other, NORM_INFINITY, &most));
  sam_call(VecAXPY(to, -1, other));
  sam_assert(most > 0);
  sam_call(VecNorm(to, NORM_INFINITY, &most));
  sam_assert(most == 0);
  sam_destroy(&from, &to, &other);
  sam_call(SamElasticityDestroy(&same));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&g));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_products_are_sums_over_all_that_the_material_has_borne),
    cmocka_unit_test(test_the_coarse_grid_of_periods_has_the_same_stream),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

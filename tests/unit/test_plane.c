/* Plane strain: products against closed forms and waves, symmetry, precision, inverses, one datum, grids, ranks. */
#include "elasticities.h"
#include "preconditioners.h"

#include "../../src/bodies/layered/layered.h"

#include <math.h>

/* Cells: few, odd, prime, and so many that lines are transformed in parts. */
static const PetscInt lengths[] = {2, 3, 7, 16, 37, 600, 3000};
enum { NUM_LENGTHS = sizeof(lengths) / sizeof(lengths[0]) };

static const double width = 3e-3, tolerance = 2e-14;

static SamElasticity NewOn(MPI_Comm comm, PetscInt nx, SamElasticityType type)
{
  SamGrid       grid = NewGridOn(comm, nx, 1, width, 1, 1e-3, 0);
  SamElasticity e    = NewDissimilar(grid);

  sam_call(SamElasticitySetType(e, type));
  sam_call(SamGridDestroy(&grid)); /* the operator has a reference */
  return e;
}

static SamGrid GridOf(SamElasticity e)
{
  SamGrid grid;

  grid = SamElasticityGetGrid(e);
  return grid;
}

/* x ln(|x|/D). */
static long double L(long double x, long double datum)
{
  return x == 0 ? 0 : x * logl(fabsl(x) / datum);
}

/* Displacement along `row` at the lag i by unit traction along `column`, of both bodies: Johnson 1985, 2.2 to 2.3. */
static long double Kernel(int row, int column, PetscInt i, long double h, long double datum)
{
  const long double pi = acosl(-1), x = (long double)i * h;
  const long double F = L(x + h / 2, datum) - L(x - h / 2, datum) - h, sides = fabsl(x + h / 2) - fabsl(x - h / 2);
  long double       sum = 0;

  for (int b = 0; b < 2; b++) {
    const long double nu = poisson[b], G = young[b] / (2 * (1 + nu));

    if (row == column) sum -= (row == 1 ? 1 : 1 - nu) / (pi * G) * F;
    /* a load draws the surface of body 2 to it; that of body 1, of which p is the mirror image, likewise */
    if (row == 0 && column == 2) sum += (b == 1 ? -1 : 1) * (1 - 2 * nu) / (4 * G) * sides;
    if (row == 2 && column == 0) sum -= (b == 1 ? -1 : 1) * (1 - 2 * nu) / (4 * G) * sides;
  }
  return sum;
}

static void test_kernels_are_the_closed_forms(void **state)
{
  (void)state;
  for (int n = 0; n < NUM_LENGTHS; n++)
    for (int c = 0; c < 4; c++) {
      SamElasticity  e    = NewOn(PETSC_COMM_WORLD, lengths[n], SAM_ELASTICITY_PLANE);
      const SamGrid  grid = GridOf(e);
      const PetscInt nx = grid->nx, at = nx / 3;

      for (PetscInt in = 0; in < products[c].n_in; in++) {
        Vec     t = NewField(grid, products[c].n_in), u = NewField(grid, products[c].n_out);
        double *values;

        AddAt(grid, in, at, 0, 1, t);
        sam_call(products[c].apply(e, t, u));
        values = Whole(grid, products[c].n_out, u);
        for (PetscInt out = 0; out < products[c].n_out; out++)
          for (PetscInt i = 0; i < nx; i++) {
            const int    row = (int)(products[c].first_out + out), column = (int)(products[c].first_in + in);
            const double own = (double)Kernel(1, 1, 0, (long double)grid->dx, (long double)width);

            sam_assert_close(values[out * nx + i],
                             (double)Kernel(row, column, i - at, (long double)grid->dx, (long double)width),
                             tolerance * own);
          }
        free(values);
        sam_destroy(&t, &u);
      }
      sam_call(SamElasticityDestroy(&e));
    }
}

/*
  Of layered bodies: the symbols' differences by quadrature over k, with 1/k cos(kx), or sin, over a cell; what remains
  of them at k = 0 is c0 exp(-kd), whose line load is -c0/pi ln(sqrt(x^2 + d^2)/D), or c0/pi atan(x/d).
*/
static double LayeredKernel(SamPair pair, SamWaveSymbol symbol, double x, double h, double datum)
{
  enum { PANELS = 30000 };
  static const double at[4][2] = {{-0.861136311594053, 0.347854845137454},
                                  {-0.339981043584856, 0.652145154862546},
                                  {0.339981043584856, 0.652145154862546},
                                  {0.861136311594053, 0.347854845137454}};
  const PetscBool     odd      = symbol == SAM_WAVE_ZR;
  const double        d = 1e-4, least = log(1e-8), step = (log(6e5) - least) / PANELS; /* of ln k */
  double              total[SAM_WAVE_SYMBOLS], limit[SAM_WAVE_SYMBOLS], some[SAM_WAVE_SYMBOLS], sum = 0;

  SamPairSymbols(pair, 1e-15, total, limit);
  for (int n = 0; n < 4 * PANELS; n++) {
    const double k = exp(least + step * (n / 4 + 0.5 + 0.5 * at[n % 4][0])), w = 0.5 * step * k * at[n % 4][1];

    SamPairSymbols(pair, k, total, some);
    sum +=
      w * (some[symbol] - limit[symbol] * exp(-k * d)) / k * (odd ? sin(k * x) : cos(k * x)) * 2 * sin(k * h / 2) / k;
  }
  for (int n = 0; n < 400; n++) { /* the rest is smooth over d */
    const double s = x + h * ((n / 4 + 0.5 + 0.5 * at[n % 4][0]) / 100 - 0.5), w = 0.5 * h / 100 * at[n % 4][1];

    sum += w * limit[symbol] * (odd ? atan(s / d) : -log(hypot(s, d) / datum));
  }
  return sum / PETSC_PI;
}

static void test_layers_add_their_symbols(void **state)
{
  static const SamWaveSymbol symbols[4] = {SAM_WAVE_ZZ, SAM_WAVE_RR, SAM_WAVE_TT, SAM_WAVE_ZR};
  const SamMaterial          one[2]     = {{120e9, 0.1, 1e-4}, {.young = 210e9, .poisson = poisson[0]}},
                    two[3] = {{150e9, 0.2, 6e-5}, {60e9, 0.4, 2e-4}, {.young = 70e9, .poisson = poisson[1]}};
  SamGrid       grid       = NewGridOn(PETSC_COMM_WORLD, 37, 1, width, 1, 0, 0);
  SamParameters p          = {.count = 0};
  SamElasticity e;
  const SamPair pair = NewPairOf(2, one, 3, two);
  double       *all[4], datum;

  (void)state;
  sam_call(SamElasticityCreate(grid, pair, &e));
  sam_call(SamElasticityAddParameters(e, &p));
  datum = (double)SamParametersFind(&p, "plane_datum")->value[0];
  for (int c = 0; c < 4; c++) { /* u_z by p, u_x by q_x, u_y by q_y, u_x by p */
    Vec t = NewField(grid, c == 0 || c == 3 ? 1 : 2), u = NewField(grid, c ? 2 : 1);

    AddAt(grid, c == 2 ? 1 : 0, 0, 0, 1, t);
    sam_call((c == 0   ? SamElasticityApplyNormal
              : c == 3 ? SamElasticityApplyNormalToTangential
                       : SamElasticityApplyTangential)(e, t, u));
    all[c] = Whole(grid, c ? 2 : 1, u);
    sam_destroy(&t, &u);
  }
  for (int c = 0; c < 4; c++)
    for (PetscInt i = 0; i < 37; i += i < 2 ? 1 : i < 3 ? 12 : 22) {
      const double h = grid->dx, x = (double)i * h, own = all[c][c == 2 ? 37 : 0];
      const double lag      = c == 3 ? (i ? PETSC_PI * pair->coupling * h : 0)
                                     : -2 * (pair->normal + (c == 2 ? pair->shear_xx : 0)) *
                                    (double)(L(x + h / 2, datum) - L(x - h / 2, datum) - h);
      const double size     = c == 3 ? all[0][0] : own;
      const double expected = lag + LayeredKernel(pair, symbols[c], x, h, datum);

      sam_assert_close(all[c][(c == 2 ? 37 : 0) + i], expected, 1e-11 * size);
    }
  for (int c = 0; c < 4; c++) free(all[c]);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* On one period cos k x is displaced as on a half-plane: 2/(E* k), (1/G1 + 1/G2)/k, and the coupling turned by pi/2. */
static void test_waves_are_displaced_by_their_symbols(void **state)
{
  const double G[2]     = {young[0] / (2 * (1 + poisson[0])), young[1] / (2 * (1 + poisson[1]))};
  const double in_plane = (1 - poisson[0]) / G[0] + (1 - poisson[1]) / G[1], across = 1 / G[0] + 1 / G[1],
               coupled = (1 - 2 * poisson[0]) / (2 * G[0]) - (1 - 2 * poisson[1]) / (2 * G[1]);
  (void)state;
  for (int n = 2; n < NUM_LENGTHS; n++)
    for (PetscInt m = 1; 2 * m < PetscMin(lengths[n], 20); m++) {
      SamElasticity e    = NewOn(PETSC_COMM_WORLD, lengths[n], SAM_ELASTICITY_PLANE_PERIODIC);
      const SamGrid grid = GridOf(e);
      const double  k    = 2 * PETSC_PI * (double)m / width;
      Vec           t = NewField(grid, 2), p = NewField(grid, 1), u = NewField(grid, 2), u_z = NewField(grid, 1);
      double       *values, *normal, *moved;

      for (PetscInt i = 0; i < grid->nx; i++) {
        AddAt(grid, 0, i, 0, cos(k * SamGridX(grid, i)), t);
        AddAt(grid, 1, i, 0, 3 * cos(k * SamGridX(grid, i)), t);
        AddAt(grid, 0, i, 0, cos(k * SamGridX(grid, i)), p);
      }
      sam_call(SamElasticityApplyTangential(e, t, u));
      sam_call(SamElasticityApplyNormal(e, p, u_z));
      values = Whole(grid, 2, u);
      normal = Whole(grid, 1, u_z);
      sam_call(SamElasticityApplyNormalToTangential(e, p, u));
      moved = Whole(grid, 2, u);
      for (PetscInt i = 0; i < grid->nx; i++) {
        const double c = cos(k * SamGridX(grid, i)), s = sin(k * SamGridX(grid, i)), size = tolerance * across / k;

        sam_assert_close(normal[i], in_plane / k * c, size);
        sam_assert_close(values[i], in_plane / k * c, size);
        sam_assert_close(values[grid->nx + i], 3 * across / k * c, 3 * size);
        sam_assert_close(moved[i], coupled / k * s, size);
        sam_assert(moved[grid->nx + i] == 0);
      }
      free(values);
      free(normal);
      free(moved);
      sam_destroy(&t, &p, &u, &u_z);
      sam_call(SamElasticityDestroy(&e));
    }
}

static const SamElasticityType types[] = {SAM_ELASTICITY_PLANE, SAM_ELASTICITY_PLANE_PERIODIC};

static void test_operator_is_symmetric(void **state)
{
  (void)state;
  for (int n = 0; n < 2 * NUM_LENGTHS; n++) {
    SamElasticity e    = NewOn(PETSC_COMM_WORLD, lengths[n / 2], types[n % 2]);
    const SamGrid grid = GridOf(e);
    Vec    p = NewRandom(grid, 1, 1), q = NewRandom(grid, 2, 2), u_z = NewField(grid, 1), u_t = NewField(grid, 2);
    double size;

    sam_call(SamElasticityApplyTangential(e, q, u_t));
    size = Norm(u_t, NORM_2) * Norm(q, NORM_2);
    sam_assert(Dot(q, u_t) > 0);
    sam_call(SamElasticityApplyNormalToTangential(e, p, u_t));
    sam_call(SamElasticityApplyTangentialToNormal(e, q, u_z));
    sam_assert_close(Dot(q, u_t) - Dot(p, u_z), 0, 1e-14 * size);
    sam_call(SamElasticityApplyNormal(e, p, u_z));
    sam_assert(Dot(p, u_z) > 0);
    sam_destroy(&p, &q, &u_z, &u_t);
    sam_call(SamElasticityDestroy(&e));
  }
}

/* In single precision the same; preconditioners are positive, of the periodic operator the inverse. */
static void test_single_precision_and_inverses(void **state)
{
  const SingleProduct single[2]       = {SamElasticityApplyNormalSingle, SamElasticityApplyTangentialSingle};
  const Product       precondition[2] = {PreconditionNormal, PreconditionTangential};

  (void)state;
  for (int n = 4; n < 2 * NUM_LENGTHS; n++)
    for (PetscInt c = 0; c < 2; c++) {
      SamElasticity e    = NewOn(PETSC_COMM_WORLD, lengths[n / 2], types[n % 2]);
      const SamGrid grid = GridOf(e);
      Vec           x = NewRandom(grid, c + 1, 5), y = Copy(x), z = Copy(x);

      sam_call(products[c].apply(e, x, y));
      ApplySingle(e, grid, c + 1, single[c], 1e12, z);
      sam_call(VecScale(z, 1e-12));
      sam_assert(Difference(z, y, NORM_2) < 1e-6);
      sam_call(VecCopy(y, x));
      sam_call(precondition[c](e, y, y));
      sam_assert(Dot(x, y) > 0);
      sam_call(products[c].apply(e, y, y));
      sam_assert(!(n % 2) || Difference(y, x, NORM_2) < 1e-6);
      sam_destroy(&x, &y, &z);
      sam_call(SamElasticityDestroy(&e));
    }
}

/* Parts and coarser grids are counted from the same datum. */
static void test_datum_is_one_on_all_grids(void **state)
{
  const PetscInt first[2] = {5, 0}, n[2] = {20, 1};
  SamElasticity  e = NewOn(PETSC_COMM_WORLD, 64, SAM_ELASTICITY_PLANE), coarse, part;
  SamTransfer    transfer;
  SamWindow      window;
  PetscReal      own[2];

  (void)state;
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  sam_assert(coarse && transfer && GridOf(coarse)->nx == 32 && GridOf(coarse)->ny == 1);
  sam_call(SamElasticityGetSelfInfluence(coarse, &own[0], &own[1]));
  sam_assert_close(own[0], (double)Kernel(2, 2, 0, width / 32, (long double)width), 1e-14 * own[0]);
  sam_assert_close(own[1], (double)Kernel(1, 1, 0, width / 32, (long double)width), 1e-14 * own[1]);
  sam_call(SamElasticityChoosePart(e, first, n, PETSC_FALSE, &window, &part));
  sam_assert(window && part && GridOf(part)->nx < 64 && GridOf(part)->ny == 1);
  sam_call(SamElasticityGetSelfInfluence(part, &own[0], NULL));
  sam_assert_close(own[0], (double)Kernel(2, 2, 0, width / 64, (long double)width), 1e-14 * own[0]);
  sam_call(SamElasticityDestroy(&e));
}

static void test_types_and_grids_must_fit(void **state)
{
  SamGrid       row = NewGrid(8, 1, width, 1), grid = NewGrid(8, 8, width, width);
  SamElasticity e[3] = {NewDissimilar(row), NewDissimilar(grid), NewDissimilar(row)};

  (void)state;
  sam_call(SamElasticitySetUp(e[2])); /* by itself a row is plane */
  sam_call(SamElasticitySetType(e[0], SAM_ELASTICITY_HALFSPACE));
  sam_call(SamElasticitySetType(e[1], SAM_ELASTICITY_PLANE));
  for (int k = 0; k < 2; k++) sam_fails(SamElasticitySetUp(e[k]), PETSC_ERR_ARG_SIZ);
  for (int k = 0; k < 3; k++) sam_call(SamElasticityDestroy(&e[k]));
  sam_call(SamGridDestroy(&row));
  sam_call(SamGridDestroy(&grid));
}

/* Restriction keeps sums, prolongation of a constant is that; windows and shifts take a row. */
static void test_fields_of_one_row_move_between_grids(void **state)
{
  SamGrid     fine = NewGrid(37, 1, width, 1), coarse;
  Vec         x = NewRandom(fine, 2, 3), y, z = NewField(fine, 2);
  SamTransfer transfer;
  SamWindow   window;
  double     *before = Whole(fine, 2, x), *after;

  (void)state;
  sam_call(SamGridCoarsen(fine, &coarse));
  sam_assert(coarse->nx == 19 && coarse->ny == 1);
  y = NewField(coarse, 2);
  sam_call(SamTransferCreate(fine, coarse, &transfer));
  sam_call(SamTransferRestrict(transfer, x, y));
  sam_assert_close(Sum(y) / 19, Sum(x) / 37, 1e-15);
  sam_call(VecSet(y, 0.25));
  sam_call(SamTransferProlong(transfer, y, z));
  sam_assert_close(Sum(z), 2 * 37 * 0.25, 1e-13);
  sam_call(SamWindowCreate(fine, (const PetscInt[]){9, 0}, (const PetscInt[]){11, 1}, &window));
  sam_call(VecDestroy(&y));
  sam_call(SamGridDestroy(&coarse));
  coarse = SamWindowGetGrid(window);
  y      = NewField(coarse, 2);
  sam_call(SamWindowTake(window, x, y));
  sam_call(SamWindowPut(window, y, z));
  after = Whole(fine, 2, z);
  for (PetscInt k = 0; k < 2 * 37; k++) sam_assert(after[k] == (k % 37 >= 9 && k % 37 < 20 ? before[k] : 0));
  free(after);
  sam_call(SamGridMove(fine, 2, (const PetscReal[]){2 * fine->dx, 0}, SAM_BORDER_ZERO, x, z));
  after = Whole(fine, 2, z);
  for (PetscInt k = 0; k < 2 * 37; k++) sam_assert(after[k] == (k % 37 < 35 ? before[k + 2] : 0));
  free(after);
  free(before);
  sam_call(SamWindowDestroy(&window));
  sam_call(SamTransferDestroy(&transfer));
  sam_destroy(&x, &y, &z);
  sam_call(SamGridDestroy(&fine));
}

static void test_any_number_of_ranks_gives_the_same_bits(void **state)
{
  (void)state;
  for (int n = 0; n < 2 * NUM_LENGTHS; n++) {
    const PetscInt nx   = lengths[n / 2];
    SamElasticity  e[2] = {NewOn(PETSC_COMM_WORLD, nx, types[n % 2]), NewOn(PETSC_COMM_SELF, nx, types[n % 2])};

    AssertSameProducts(e);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_kernels_are_the_closed_forms),
    cmocka_unit_test(test_layers_add_their_symbols),
    cmocka_unit_test(test_waves_are_displaced_by_their_symbols),
    cmocka_unit_test(test_operator_is_symmetric),
    cmocka_unit_test(test_single_precision_and_inverses),
    cmocka_unit_test(test_datum_is_one_on_all_grids),
    cmocka_unit_test(test_types_and_grids_must_fit),
    cmocka_unit_test(test_fields_of_one_row_move_between_grids),
    cmocka_unit_test(test_any_number_of_ranks_gives_the_same_bits),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

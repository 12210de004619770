/*
  Periodic bodies: products against sums over waves and against half-spaces; symmetry, translations, precision, inverses
*/
#include "fields.h"
#include "preconditioners.h"

#include <petsam/elasticity.h>

/* Even and odd numbers of cells, prime ones, fewer rows than ranks; cells that are not square. */
static const PetscInt sizes[][2] = {{12, 10}, {13, 9}, {8, 7}, {7, 6}, {5, 2}, {2, 11}, {3, 3}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]) };

/* Rounding of the transforms and of the sums they are compared to. */
static const double tolerance = 1e-13;

/* Two bodies that have nothing in common. */
static const double young[2] = {210e9, 3e9}, poisson[2] = {0.3, 0.2};

static SamElasticity NewOfType(SamGrid grid, SamElasticityType type)
{
  const SamPair pair = NewPair(young[0], poisson[0], young[1], poisson[1]);
  SamElasticity e;

  sam_call(SamElasticityCreate(grid, pair, &e));
  sam_call(SamElasticitySetType(e, type));
  return e;
}

static SamElasticity NewPeriodic(SamGrid grid)
{
  return NewOfType(grid, SAM_ELASTICITY_PERIODIC);
}

/* ---- sums over waves ---- */

/*
  What a wave exp(i k.x) of traction along `column` displaces along `row` (0, 1, 2: x, y, z), body by body: the Fourier
  transforms of the surface displacements of a point force (Johnson 1985, sections 3.2 and 3.6); re + i im.
*/
static void Symbol(int row, int column, const long double k[2], long double *re, long double *im)
{
  const long double size = sqrtl(k[0] * k[0] + k[1] * k[1]);

  *re = *im = 0;
  for (int b = 0; b < 2 && size > 0; b++) {
    const long double G = young[b] / (2 * (1 + (long double)poisson[b])), nu = poisson[b];
    /* tangential tractions and displacements of body 1 are both reversed, normal ones are the same for both */
    const long double side = b == 0 ? -1 : 1;

    if (row == 2 && column == 2)
      *re += (1 - nu) / (G * size);
    else if (row == 2)
      *im += -side * (1 - 2 * nu) / (2 * G) * k[column] / (size * size);
    else if (column == 2)
      *im += side * (1 - 2 * nu) / (2 * G) * k[row] / (size * size);
    else
      *re += ((row == column) - nu * k[row] * k[column] / (size * size)) / (G * size);
  }
}

/*
  Displacement along `row` at a lag of (i, j) cells from unit traction along `column` on one cell: the sum over all
  waves on the grid. A wave of two cells' length is its own mirror image: what is odd in its wave number has no meaning.
*/
static double Influence(SamGrid grid, int row, int column, PetscInt i, PetscInt j)
{
  const PetscInt    n[2] = {grid->nx, grid->ny};
  const long double turn = 2 * acosl(-1.0L);
  long double       sum  = 0;

  for (PetscInt m = 0; m < n[1]; m++)
    for (PetscInt l = 0; l < n[0]; l++) {
      const PetscInt    w[2]  = {2 * l > n[0] ? l - n[0] : l, 2 * m > n[1] ? m - n[1] : m};
      const long double k[2]  = {turn * (long double)w[0] / grid->width[0], turn * (long double)w[1] / grid->width[1]},
                        phase = turn * ((long double)(w[0] * i) / (long double)n[0] +
                                        (long double)(w[1] * j) / (long double)n[1]);
      long double re, im;
      PetscBool   odd = PETSC_FALSE;

      for (int c = 0; c < 2; c++)
        if (2 * w[c] == n[c] && (row == c) != (column == c)) odd = PETSC_TRUE;
      if (odd) continue;
      Symbol(row, column, k, &re, &im);
      sum += re * cosl(phase) - im * sinl(phase);
    }
  return (double)(sum / (long double)(n[0] * n[1]));
}

/* The product by summation over cells and waves. */
static Vec SumDirectly(SamGrid grid, int product, Vec traction)
{
  const PetscInt n_in = products[product].n_in, n_out = products[product].n_out, nx = grid->nx, ny = grid->ny;
  Vec            u     = NewField(grid, n_out);
  double        *whole = Whole(grid, n_in, traction), *a, *table = (double *)malloc(sizeof(*table) * (size_t)(nx * ny));

  sam_call(VecGetArray(u, &a));
  for (PetscInt o = 0; o < n_out; o++)
    for (PetscInt c = 0; c < n_in; c++) {
      for (PetscInt k = 0; k < nx * ny; k++)
        table[k] = Influence(grid, (int)(products[product].first_out + o), (int)(products[product].first_in + c),
                             k % nx, k / nx);
      for (PetscInt j = 0; j < grid->rows; j++)
        for (PetscInt i = 0; i < nx; i++)
          for (PetscInt l = 0; l < ny; l++)
            for (PetscInt k = 0; k < nx; k++)
              a[o * grid->cells + j * nx + i] +=
                table[(grid->row_start + j - l + ny) % ny * nx + (i - k + nx) % nx] * whole[(c * ny + l) * nx + k];
    }
  sam_call(VecRestoreArray(u, &a));
  free(table);
  free(whole);
  return u;
}

static void test_products_are_sums_over_waves(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity e    = NewPeriodic(grid);

    for (int c = 0; c < 4; c++) {
      Vec    in = NewRandom(grid, products[c].n_in, k), out = NewField(grid, products[c].n_out);
      Vec    exact = SumDirectly(grid, c, in);
      double size  = Norm(exact, NORM_INFINITY);

      sam_call(products[c].apply(e, in, out));
      sam_call(VecAXPY(exact, -1, out));
      sam_assert_close(Norm(exact, NORM_INFINITY), 0, tolerance * size + 1e-30); /* coupling is 0 on 2 cells */
      if (products[c].n_in == products[c].n_out) {                               /* input and output may be the same */
        sam_call(products[c].apply(e, in, in));
        sam_call(VecAXPY(in, -1, out));
        sam_assert(Norm(in, NORM_INFINITY) == 0);
      }
      sam_destroy(&in, &out, &exact);
    }
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_self_influence_is_that_of_one_cell(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity e    = NewPeriodic(grid);
    PetscReal     normal, tangential;

    sam_call(SamElasticityGetSelfInfluence(e, &normal, &tangential));
    sam_assert_close(normal, Influence(grid, 2, 2, 0, 0), tolerance * normal);
    sam_assert_close(tangential, fmax(Influence(grid, 0, 0, 0, 0), Influence(grid, 1, 1, 0, 0)),
                     tolerance * tangential);
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

/* ---- half-spaces ---- */

/* Waves of 16 cells under a bell of 12 cells: no mean, and nothing at the border. */
static Vec NewPacket(SamGrid grid, PetscInt refine)
{
  Vec     v = NewField(grid, 2);
  double *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const double x    = SamGridX(grid, i) / grid->dx / (double)refine,
                   y    = SamGridY(grid, grid->row_start + j) / grid->dy / (double)refine;
      const double bell = exp(-(x * x + y * y) / 288);

      a[j * grid->nx + i]               = bell * cos(2 * PETSC_PI * (0.8 * x + 0.6 * y) / 16 + 0.4);
      a[grid->cells + j * grid->nx + i] = bell * cos(2 * PETSC_PI * (0.6 * x - 0.8 * y) / 16 - 0.7);
    }
  sam_call(VecRestoreArray(v, &a));
  return v;
}

/* Largest difference of a product on periodic bodies and on half-spaces, relative. */
static double AgainstHalfSpaces(int product, PetscInt refine)
{
  SamGrid       grid = NewGrid(100 * refine, 110 * refine, 1.0, 1.1);
  SamElasticity a = NewOfType(grid, SAM_ELASTICITY_PERIODIC), b = NewOfType(grid, SAM_ELASTICITY_HALFSPACE);
  Vec           packet = NewPacket(grid, refine), in = NewField(grid, products[product].n_in);
  Vec           u = NewField(grid, products[product].n_out), v = Copy(u);
  double       *whole = Whole(grid, 2, packet), difference;

  SetWhole(grid, products[product].n_in, whole, in);
  sam_call(products[product].apply(a, in, u));
  sam_call(products[product].apply(b, in, v));
  difference = Difference(u, v, NORM_INFINITY);
  if (getenv("SAM_SHOW")) print_message("# product %d refined %d: %g\n", product, (int)refine, difference);
  free(whole);
  sam_destroy(&packet, &in, &u, &v);
  sam_call(SamElasticityDestroy(&a));
  sam_call(SamElasticityDestroy(&b));
  sam_call(SamGridDestroy(&grid));
  return difference;
}

/*
  Far from its next period a packet of waves does not feel it. What is left is that the one's tractions are smooth and
  the other's constant on each cell: k^2 (dx^2 + dy^2)/24 = 0.6 % of the displacement, about twice that for
  coupling, and second order.
*/
static void test_waves_displace_as_on_half_spaces(void **state)
{
  (void)state;
  for (int product = 0; product < 4; product++) {
    const double coarse = AgainstHalfSpaces(product, 1), fine = AgainstHalfSpaces(product, 2);

    sam_assert(coarse < 0.015);
    sam_assert(fine < 0.3 * coarse);
  }
}

/* ---- symmetries ---- */

/* y.K x for fields of three components, and the sum of the sizes of its parts. */
static double Work(SamElasticity e, SamGrid grid, const double *y, const double *x, double *size)
{
  const PetscInt all  = grid->nx * grid->ny;
  double         work = 0;

  *size = 0;
  for (int c = 0; c < 4; c++) {
    Vec in = NewField(grid, products[c].n_in), out = NewField(grid, products[c].n_out), with = Copy(out);

    SetWhole(grid, products[c].n_in, x + products[c].first_in * all, in);
    SetWhole(grid, products[c].n_out, y + products[c].first_out * all, with);
    sam_call(products[c].apply(e, in, out));
    work += Dot(with, out);
    *size += Norm(with, NORM_2) * Norm(out, NORM_2);
    sam_destroy(&in, &out, &with);
  }
  return work;
}

/* Betti's theorem, with coupling. */
static void test_operator_is_symmetric(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity e    = NewPeriodic(grid);
    Vec           x = NewRandom(grid, 3, 1), y = NewRandom(grid, 3, 2);
    double       *a = Whole(grid, 3, x), *b = Whole(grid, 3, y), size, other;

    sam_assert_close(Work(e, grid, a, b, &size), Work(e, grid, b, a, &other), tolerance * (size + other));
    sam_assert(Work(e, grid, a, a, &size) > 0);
    free(a);
    free(b);
    sam_destroy(&x, &y);
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

static void Shift(PetscInt components, PetscInt nx, PetscInt ny, const PetscInt by[2], const double from[], double to[])
{
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt j = 0; j < ny; j++)
      for (PetscInt i = 0; i < nx; i++)
        to[(c * ny + (j + by[1]) % ny) * nx + (i + by[0]) % nx] = from[(c * ny + j) * nx + i];
}

static void test_shifted_tractions_shift_the_displacements(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    const PetscInt nx = sizes[k][0], ny = sizes[k][1], by[2] = {nx / 3 + 1, ny / 2};
    SamGrid        grid = NewGrid(nx, ny, 3e-3, 1e-3);
    SamElasticity  e    = NewPeriodic(grid);

    for (int c = 0; c < 4; c++) {
      Vec     in = NewRandom(grid, products[c].n_in, k), out = NewField(grid, products[c].n_out), other = Copy(out);
      double *a = Whole(grid, products[c].n_in, in), *b, *shifted = (double *)calloc((size_t)(2 * nx * ny), sizeof(*b));

      sam_call(products[c].apply(e, in, out));
      Shift(products[c].n_in, nx, ny, by, a, shifted);
      SetWhole(grid, products[c].n_in, shifted, in);
      sam_call(products[c].apply(e, in, other));
      b = Whole(grid, products[c].n_out, out);
      Shift(products[c].n_out, nx, ny, by, b, shifted);
      SetWhole(grid, products[c].n_out, shifted, out);
      sam_call(VecAXPY(other, -1, out));
      sam_assert_close(Norm(other, NORM_INFINITY), 0, tolerance * Norm(out, NORM_INFINITY) + 1e-30);
      free(a);
      free(b);
      free(shifted);
      sam_destroy(&in, &out, &other);
    }
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_uniform_tractions_displace_nothing(void **state)
{
  SamGrid             grid = NewGrid(12, 7, 3e-3, 1e-3);
  SamElasticity       e    = NewPeriodic(grid);
  SamElasticityTraits traits;
  PetscReal           self[2];

  (void)state;
  traits = SamElasticityGetTraits(e);
  sam_assert(traits.coupled && traits.periodic && !traits.stretch && !traits.mean && !traits.parts);
  for (int k = 0; k < 3; k++) sam_assert(!traits.rotations[k]);
  sam_call(SamElasticityGetSelfInfluence(e, &self[0], &self[1]));
  for (int c = 0; c < 4; c++) {
    Vec in = NewField(grid, products[c].n_in), out = NewField(grid, products[c].n_out);

    sam_call(VecSet(in, 1));
    sam_call(products[c].apply(e, in, out));
    sam_assert(Norm(out, NORM_INFINITY) < tolerance * self[0]);
    sam_destroy(&in, &out);
  }
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* ---- precision, ranks ---- */

static void test_single_precision_is_double_but_for_rounding(void **state)
{
  const SingleProduct single[2] = {SamElasticityApplyNormalSingle, SamElasticityApplyTangentialSingle};

  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity e    = NewPeriodic(grid);
    double        self[2];

    sam_call(SamElasticityGetSelfInfluence(e, &self[0], &self[1]));
    for (PetscInt c = 0; c < 2; c++) {
      Vec in = NewRandom(grid, c + 1, 3), exact = Copy(in);

      sam_call(products[c].apply(e, in, exact));
      sam_call(VecScale(exact, 1 / self[c]));
      ApplySingle(e, grid, c + 1, single[c], 1 / self[c], in);
      sam_assert(Norm(exact, NORM_INFINITY) > 0.1);
      sam_assert_close(Difference(in, exact, NORM_2), 0, 3e-7 * Norm(exact, NORM_2)); /* what the solvers count on */
      sam_destroy(&in, &exact);
    }
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

/* Of everything but the mean, which has none. */
static void test_preconditioners_are_the_inverses(void **state)
{
  const Product precondition[2] = {PreconditionNormal, PreconditionTangential};

  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity e    = NewPeriodic(grid);

    for (PetscInt c = 0; c < 2; c++) {
      Vec x = NewRandom(grid, c + 1, 5), y = Copy(x);

      sam_call(products[c].apply(e, x, y)); /* without mean */
      sam_call(VecCopy(y, x));
      sam_call(precondition[c](e, y, y));
      sam_call(products[c].apply(e, y, y));
      sam_assert_close(Difference(y, x, NORM_2), 0, 1e-6); /* floats */
      sam_call(VecSet(x, 1));
      sam_call(precondition[c](e, x, y));
      sam_assert(Dot(x, y) > 0.1 * Norm(x, NORM_2) * Norm(y, NORM_2)); /* the mean has a gain all the same */
      sam_destroy(&x, &y);
    }
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

/* Of pressure that takes a shear with it; of waves that are their own mirror images it is not, with even sizes. */
static void test_preconditioner_of_sliding_bodies_is_the_inverse(void **state)
{
  static const PetscInt odd[][2] = {{13, 9}, {3, 3}, {13, 1}};
  const double          slope[2] = {1.7, -0.9};

  (void)state;
  for (int k = 0; k < 3; k++) {
    SamGrid       grid = NewGrid(odd[k][0], odd[k][1], 3e-3, 1e-3);
    SamElasticity e    = NewOfType(grid, odd[k][1] > 1 ? SAM_ELASTICITY_PERIODIC : SAM_ELASTICITY_PLANE_PERIODIC);
    Vec           p = NewRandom(grid, 1, 5), q = NewField(grid, 2), u = Copy(p), lift = Copy(p);
    double       *to, *from;
    float        *work = (float *)calloc((size_t)grid->cells + 1, sizeof(*work));

    sam_call(SamElasticityApplyNormal(e, p, u));
    sam_call(VecCopy(u, p)); /* without mean */
    sam_call(VecGetArray(p, &from));
    sam_call(VecGetArray(q, &to));
    for (PetscInt m = 0; m < 2 * grid->cells; m++) to[m] = slope[m / grid->cells] * from[m % grid->cells];
    sam_call(VecRestoreArray(q, &to));
    sam_call(VecRestoreArray(p, &from));
    sam_call(SamElasticityApplyNormal(e, p, u));
    sam_call(SamElasticityApplyTangentialToNormal(e, q, lift));
    sam_call(VecAXPY(u, 1, lift));
    sam_call(VecGetArray(u, &to));
    for (PetscInt m = 0; m < grid->cells; m++) work[m] = (float)(to[m] * 1e30);
    sam_call(SamElasticityPreconditionSlidingSingle(e, 1e-15, slope, work, work));
    for (PetscInt m = 0; m < grid->cells; m++) to[m] = (double)work[m] * 1e-15;
    sam_call(VecRestoreArray(u, &to));
    sam_assert_close(Difference(u, p, NORM_2), 0, 1e-6); /* floats */
    free(work);
    sam_destroy(&p, &q, &u, &lift);
    sam_call(SamElasticityDestroy(&e));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_any_number_of_ranks_gives_the_same_bits(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamElasticity e[2];

    for (int alone = 0; alone < 2; alone++) {
      SamGrid grid = NewGridOn(alone ? PETSC_COMM_SELF : PETSC_COMM_WORLD, sizes[k][0], sizes[k][1], 3e-3, 1e-3, 0, 0);

      e[alone] = NewPeriodic(grid);
      sam_call(SamGridDestroy(&grid));
    }
    AssertSameProducts(e);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_products_are_sums_over_waves),
    cmocka_unit_test(test_self_influence_is_that_of_one_cell),
    cmocka_unit_test(test_waves_displace_as_on_half_spaces),
    cmocka_unit_test(test_operator_is_symmetric),
    cmocka_unit_test(test_shifted_tractions_shift_the_displacements),
    cmocka_unit_test(test_uniform_tractions_displace_nothing),
    cmocka_unit_test(test_single_precision_is_double_but_for_rounding),
    cmocka_unit_test(test_preconditioners_are_the_inverses),
    cmocka_unit_test(test_preconditioner_of_sliding_bodies_is_the_inverse),
    cmocka_unit_test(test_any_number_of_ranks_gives_the_same_bits),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

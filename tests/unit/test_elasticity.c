/*
  The influence operator: against sums over the closed forms, closed solutions, symmetry, bodies.
*/
#include "elasticities.h"

#include <petsam/private/elasticity.h>
#include <petsam/private/halfspace.h>

/* Rounding of the transforms and of the sums they are compared to, n^2 terms of one sign. */
static const double tolerance = 1e-13;

/*
  Displacement along `row` at lag (i, j) from unit traction along `column` (0, 1, 2: x, y, z), body by body (Johnson
  1985).
*/
static double Influence(SamGrid grid, int row, int column, PetscInt i, PetscInt j)
{
  double sum = 0;

  for (int b = 0; b < 2; b++) {
    const double G = young[b] / (2 * (1 + poisson[b])), nu = poisson[b];
    /* tangential tractions and displacements of body 1 are both reversed, normal ones are the same for both */
    const double side = b == 0 ? -1 : 1;
    const double at_r = (1 - nu) / (2 * PETSC_PI * G), at_xx = nu / (2 * PETSC_PI * G),
                 at_x = (1 - 2 * nu) / (4 * PETSC_PI * G);

    if (row == 2 && column == 2)
      sum += at_r * SamIntegralCell(SAM_INTEGRAL_R, grid->dx, grid->dy, i, j);
    else if (column == 2)
      sum -= side * at_x * SamIntegralCell(row == 0 ? SAM_INTEGRAL_X : SAM_INTEGRAL_Y, grid->dx, grid->dy, i, j);
    else if (row == 2)
      sum += side * at_x * SamIntegralCell(column == 0 ? SAM_INTEGRAL_X : SAM_INTEGRAL_Y, grid->dx, grid->dy, i, j);
    else if (row != column)
      sum += at_xx * SamIntegralCell(SAM_INTEGRAL_XY, grid->dx, grid->dy, i, j);
    else
      sum += at_r * SamIntegralCell(SAM_INTEGRAL_R, grid->dx, grid->dy, i, j) +
             at_xx * SamIntegralCell(row == 0 ? SAM_INTEGRAL_XX : SAM_INTEGRAL_YY, grid->dx, grid->dy, i, j);
  }
  return sum;
}

/* The product by summation, from components first_in ... to first_out ... */
static Vec SumDirectly(SamGrid grid, int first_in, PetscInt n_in, int first_out, PetscInt n_out, Vec traction)
{
  Vec     u     = NewField(grid, n_out);
  double *whole = Whole(grid, n_in, traction), *a;

  sam_call(VecGetArray(u, &a));
  for (PetscInt o = 0; o < n_out; o++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < grid->nx; i++)
        for (PetscInt c = 0; c < n_in; c++)
          for (PetscInt l = 0; l < grid->ny; l++)
            for (PetscInt k = 0; k < grid->nx; k++)
              a[o * grid->cells + j * grid->nx + i] +=
                Influence(grid, first_out + (int)o, first_in + (int)c, i - k, grid->row_start + j - l) *
                whole[(c * grid->ny + l) * grid->nx + k];
  sam_call(VecRestoreArray(u, &a));
  free(whole);
  return u;
}

static void AssertProduct(Product product, PetscBool tangential_in, PetscBool tangential_out)
{
  const PetscInt n_in = tangential_in ? 2 : 1, n_out = tangential_out ? 2 : 1;

  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity C    = NewDissimilar(grid);
    Vec           in = NewRandom(grid, n_in, k), out = NewField(grid, n_out), exact;

    exact = SumDirectly(grid, tangential_in ? 0 : 2, n_in, tangential_out ? 0 : 2, n_out, in);
    sam_call(product(C, in, out));
    sam_assert_close(Difference(out, exact, NORM_INFINITY), 0, tolerance);
    if (n_in == n_out) { /* input and output may be the same */
      sam_call(product(C, in, in));
      sam_assert_close(Difference(in, exact, NORM_INFINITY), 0, tolerance);
    }
    sam_destroy(&in, &out, &exact);
    sam_call(SamElasticityDestroy(&C));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_normal_displacement_from_pressure(void **state)
{
  (void)state;
  AssertProduct(SamElasticityApplyNormal, PETSC_FALSE, PETSC_FALSE);
}

static void test_tangential_displacement_from_shear(void **state)
{
  (void)state;
  AssertProduct(SamElasticityApplyTangential, PETSC_TRUE, PETSC_TRUE);
}

static void test_tangential_displacement_from_pressure(void **state)
{
  (void)state;
  AssertProduct(SamElasticityApplyNormalToTangential, PETSC_FALSE, PETSC_TRUE);
}

static void test_normal_displacement_from_shear(void **state)
{
  (void)state;
  AssertProduct(SamElasticityApplyTangentialToNormal, PETSC_TRUE, PETSC_FALSE);
}

/* ---- single precision ---- */

typedef PetscErrorCode (*SingleProduct)(SamElasticity, double, const float[], float[]);

/* `factor` times the product in double precision, to the rounding of floats. */
static void AssertSingleProduct(PetscInt      components, PetscErrorCode (*product)(SamElasticity, Vec, Vec),
                                SingleProduct single)
{
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity C    = NewDissimilar(grid);
    Vec           in = NewRandom(grid, components, 3), exact = Copy(in), out = Copy(in);
    double        self[2], factor, *a;
    float        *work = (float *)calloc((size_t)(components * grid->cells) + 1, sizeof(float));

    sam_call(SamElasticityGetSelfInfluence(C, &self[0], &self[1]));
    factor = 1 / self[components - 1];
    sam_call(VecGetArray(in, &a));
    for (PetscInt i = 0; i < components * grid->cells; i++) work[i] = (float)a[i];
    sam_call(VecRestoreArray(in, &a));
    sam_call(product(C, in, exact));
    sam_call(VecScale(exact, factor));
    sam_call(single(C, factor, work, work));
    sam_call(VecGetArray(out, &a));
    for (PetscInt i = 0; i < components * grid->cells; i++) a[i] = (double)work[i];
    sam_call(VecRestoreArray(out, &a));
    sam_assert(Norm(exact, NORM_INFINITY) > 0.1);
    sam_assert_close(Difference(out, exact, NORM_2), 0, 3e-7 * Norm(exact, NORM_2)); /* what the solver counts on */
    free(work);
    sam_destroy(&in, &out, &exact);
    sam_call(SamElasticityDestroy(&C));
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_normal_product_in_single_precision(void **state)
{
  (void)state;
  AssertSingleProduct(1, SamElasticityApplyNormal, SamElasticityApplyNormalSingle);
}

static void test_tangential_product_in_single_precision(void **state)
{
  (void)state;
  AssertSingleProduct(2, SamElasticityApplyTangential, SamElasticityApplyTangentialSingle);
}

/* ---- the full operator on (q, p), scaled so that no part is lost beside another ---- */

typedef struct {
  Vec q, p;
} Traction;

static Traction NewTraction(SamGrid grid, PetscInt seed)
{
  const Traction t = {NewRandom(grid, 2, seed), NewRandom(grid, 1, seed + 100)};

  return t;
}

static void DestroyTraction(Traction *t)
{
  sam_destroy(&t->q, &t->p);
}

/* y.Kx, and the sum of the sizes of its four parts. */
static double Work(SamElasticity C, const Traction *y, const Traction *x, double *size)
{
  Vec    uz = Copy(x->p), ut = Copy(x->q);
  double part[4];

  sam_call(SamElasticityApplyNormal(C, x->p, uz));
  part[0] = Dot(y->p, uz);
  *size   = Norm(y->p, NORM_2) * Norm(uz, NORM_2);
  sam_call(SamElasticityApplyTangentialToNormal(C, x->q, uz));
  part[1] = Dot(y->p, uz);
  sam_call(SamElasticityApplyTangential(C, x->q, ut));
  part[2] = Dot(y->q, ut);
  *size += Norm(y->q, NORM_2) * Norm(ut, NORM_2);
  sam_call(SamElasticityApplyNormalToTangential(C, x->p, ut));
  part[3] = Dot(y->q, ut);
  sam_destroy(&uz, &ut);
  return part[0] + part[1] + part[2] + part[3];
}

/* Betti's theorem. */
static void test_operator_is_symmetric_with_coupling(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid             grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity       C    = NewDissimilar(grid);
    Traction            x = NewTraction(grid, 1), y = NewTraction(grid, 2);
    double              size, other;
    SamElasticityTraits traits;

    traits = SamElasticityGetTraits(C);
    sam_assert(traits.coupled);
    sam_assert_close(Work(C, &x, &y, &size), Work(C, &y, &x, &other), tolerance * (size + other));
    DestroyTraction(&x);
    DestroyTraction(&y);
    sam_call(SamElasticityDestroy(&C));
    sam_call(SamGridDestroy(&grid));
  }
}

/* Elastic energy: of random tractions, and of the waves of one and two cells, which have the least. */
static void test_operator_is_positive_definite(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 3e-3, 1e-3);
    SamElasticity C    = NewDissimilar(grid);

    for (PetscInt seed = 0; seed < 12; seed++) {
      Traction x = NewTraction(grid, seed);
      double   size, work, *q, *p;

      if (seed >= 4) {
        sam_call(VecGetArray(x.q, &q));
        sam_call(VecGetArray(x.p, &p));
        for (PetscInt j = 0; j < grid->rows; j++)
          for (PetscInt i = 0; i < grid->nx; i++) {
            const PetscInt c    = j * grid->nx + i;
            const double   sign = ((seed & 1 ? i : 0) + (seed & 2 ? grid->row_start + j : 0)) % 2 ? -1 : 1;

            p[c]               = seed < 8 ? sign : 0;
            q[c]               = seed < 8 ? 0 : sign;
            q[c + grid->cells] = seed < 8 ? 0 : -sign;
          }
        sam_call(VecRestoreArray(x.q, &q));
        sam_call(VecRestoreArray(x.p, &p));
      }
      work = Work(C, &x, &x, &size);
      sam_assert(work > 1e-3 * size); /* the least eigenvalue lies some 1/n below the largest */
      DestroyTraction(&x);
    }
    sam_call(SamElasticityDestroy(&C));
    sam_call(SamGridDestroy(&grid));
  }
}

/* ---- closed solutions ---- */

/* Love: the centre of a rectangle of sides 2a, 2b under uniform pressure. */
static void test_uniform_pressure_lowers_the_centre_as_love_says(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    const PetscInt n[3][2] = {{13, 9}, {7, 21}, {3, 33}}; /* odd: a cell in the centre */
    const double   a = 1.5e-3, b = 0.5e-3, expected = 4 * (a * asinh(b / a) + b * asinh(a / b));
    SamGrid        grid = NewGrid(n[k][0], n[k][1], 2 * a, 2 * b);
    SamPair        pair = NewPair(young[0], poisson[0], young[1], poisson[1]);
    SamElasticity  C    = NewCompliance(grid, pair);
    Vec            u    = NewField(grid, 1);
    double        *whole;

    sam_call(VecSet(u, 1));
    sam_call(SamElasticityApplyNormal(C, u, u));
    whole = Whole(grid, 1, u);
    sam_assert_close(whole[(n[k][1] / 2) * n[k][0] + n[k][0] / 2] * PETSC_PI * pair->modulus, expected,
                     1e-12 * expected); /* closed forms to 1e-14, and transforms */
    free(whole);
    sam_call(VecDestroy(&u));
    sam_call(SamElasticityDestroy(&C));
    sam_call(SamGridDestroy(&grid));
  }
}

static double HertzPressure(double x, double y, const void *context)
{
  const double r2 = x * x + y * y;

  (void)context;
  return r2 < 1 ? sqrt(1 - r2) : 0;
}

/* u_z = pi p0 (2 a^2 - r^2)/(4 E* a) in the contact; the error within r < a/2, a = 1. */
static double HertzError(PetscInt n)
{
  SamGrid       grid = NewGrid(n, n, 3, 3);
  SamPair       pair = NewPair(young[0], poisson[0], young[1], poisson[1]);
  SamElasticity C    = NewCompliance(grid, pair);
  Vec           u    = NewFrom(grid, HertzPressure, NULL);
  const double *a;
  double        error = 0;

  sam_call(SamElasticityApplyNormal(C, u, u));
  sam_call(VecGetArrayRead(u, &a));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < n; i++) {
      const double x = SamGridX(grid, i), y = SamGridY(grid, grid->row_start + j), r2 = x * x + y * y;

      if (r2 < 0.25) error = fmax(error, fabs(a[j * n + i] * 4 * pair->modulus / (2 * PETSC_PI) - (1 - r2 / 2)));
    }
  sam_call(VecRestoreArrayRead(u, &a));
  (void)MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  sam_call(VecDestroy(&u));
  sam_call(SamElasticityDestroy(&C));
  sam_call(SamGridDestroy(&grid));
  return error;
}

/*
  Pressure sampled at the centres of cells: second order but for the cells at the contact's edge, where the root makes
  it h^(3/2) and irregular; so the order is taken over a factor of 8.
*/
static void test_hertz_pressure_gives_the_hertz_displacement(void **state)
{
  const double coarse = HertzError(19), fine = HertzError(152), order = log(coarse / fine) / log(8);

  (void)state;
  if (getenv("SAM_SHOW")) print_message("# hertz displacement error %g %g order %g\n", coarse, fine, order);
  sam_assert(fine < 5e-4);
  sam_assert(order > 1.4);
}

/* ---- bodies ---- */

/* Differences of the four products of two compliances, the second scaled by factors. */
static void AssertRelated(SamGrid grid, SamPair first, SamPair second, double factor, double coupling_factor)
{
  const Product  products[4] = {SamElasticityApplyNormal, SamElasticityApplyTangential,
                                SamElasticityApplyNormalToTangential, SamElasticityApplyTangentialToNormal};
  const PetscInt n_in[4] = {1, 2, 1, 2}, n_out[4] = {1, 2, 2, 1};
  SamElasticity  A = NewCompliance(grid, first), B = NewCompliance(grid, second);

  for (int k = 0; k < 4; k++) {
    Vec in = NewRandom(grid, n_in[k], k), a = NewField(grid, n_out[k]), b = NewField(grid, n_out[k]);

    sam_call(products[k](A, in, a));
    sam_call(products[k](B, in, b));
    sam_call(VecScale(b, k < 2 ? factor : coupling_factor));
    sam_assert_close(Difference(a, b, NORM_INFINITY), 0, tolerance);
    sam_destroy(&in, &a, &b);
  }
  sam_call(SamElasticityDestroy(&A));
  sam_call(SamElasticityDestroy(&B));
}

static void test_swapping_the_bodies_reverses_the_coupling_alone(void **state)
{
  SamGrid grid = NewGrid(11, 7, 3e-3, 1e-3);

  (void)state;
  AssertRelated(grid, NewPair(young[0], poisson[0], young[1], poisson[1]),
                NewPair(young[1], poisson[1], young[0], poisson[0]), 1, -1);
  sam_call(SamGridDestroy(&grid));
}

static void test_displacement_is_inverse_to_young(void **state)
{
  SamGrid grid = NewGrid(11, 7, 3e-3, 1e-3);

  (void)state;
  AssertRelated(grid, NewPair(young[0], poisson[0], young[1], poisson[1]),
                NewPair(3 * young[0], poisson[0], 3 * young[1], poisson[1]), 3, 3);
  sam_call(SamGridDestroy(&grid));
}

/*
  A rigid body adds nothing, and its Poisson's ratio does not matter: alone, a body gives half of what two of it give.
*/
static void test_rigid_body_contributes_nothing(void **state)
{
  SamGrid       grid    = NewGrid(11, 7, 3e-3, 1e-3);
  SamElasticity one     = NewCompliance(grid, NewPair(INFINITY, 0.1, 70e9, 0.33)),
                two     = NewCompliance(grid, NewPair(70e9, 0.33, 70e9, 0.33));
  Vec                 q = NewRandom(grid, 2, 1), p = NewRandom(grid, 1, 1), a, b;
  SamElasticityTraits traits;

  (void)state;
  AssertRelated(grid, NewPair(70e9, 0.33, INFINITY, 0.5), NewPair(70e9, 0.33, INFINITY, 0), 1, 1);
  traits = SamElasticityGetTraits(two);
  sam_assert(!traits.coupled);
  traits = SamElasticityGetTraits(one);
  sam_assert(traits.coupled);
  a = Copy(p);
  b = Copy(p);
  sam_call(SamElasticityApplyNormal(one, a, a));
  sam_call(SamElasticityApplyNormal(two, b, b));
  sam_call(VecScale(b, 0.5));
  sam_assert_close(Difference(a, b, NORM_INFINITY), 0, tolerance);
  sam_destroy(&a, &b);
  a = Copy(q);
  b = Copy(q);
  sam_call(SamElasticityApplyTangential(one, a, a));
  sam_call(SamElasticityApplyTangential(two, b, b));
  sam_call(VecScale(b, 0.5));
  sam_assert_close(Difference(a, b, NORM_INFINITY), 0, tolerance);
  sam_destroy(&a, &b, &p, &q);
  sam_call(SamElasticityDestroy(&one));
  sam_call(SamElasticityDestroy(&two));
  sam_call(SamGridDestroy(&grid));
}

static void test_impossible_bodies_are_refused(void **state)
{
  static const struct {
    PetscInt    count;
    SamMaterial material[2];
  } wrong[]               = {{1, {{.young = 0}}},
                             {1, {{.young = -1}}},
                             {1, {{.young = NAN}}},
                             {1, {{.young = 1e-320}}},
                             {1, {{1, 0.6, 0}}},
                             {1, {{1, -1, 0}}},
                             {1, {{1, NAN, 0}}},
                             {1, {{1, INFINITY, 0}}},
                             {0, {{1, 0.3, 0}}},
                             {2, {{1, 0.3, 0}, {1, 0.3, 0}}},
                             {2, {{INFINITY, 0.3, 1}, {1, 0.3, 0}}}};
  const SamMaterial rigid = {.young = INFINITY};
  SamBody           body;
  SamPair           pair;

  (void)state;
  for (size_t k = 0; k < sizeof(wrong) / sizeof(wrong[0]); k++)
    sam_fails(SamBodyCreate(wrong[k].count, wrong[k].material, &body), PETSC_ERR_ARG_OUTOFRANGE);
  sam_call(SamBodyCreate(1, &rigid, &body));
  sam_fails(SamPairCreate(body, body, &pair), PETSC_ERR_ARG_OUTOFRANGE);
  sam_call(SamBodyDestroy(&body));
}

/* ---- self-influence, coarse grids ---- */

static void test_self_influence_is_that_of_one_cell(void **state)
{
  SamGrid       grid = NewGrid(9, 7, 3e-3, 1e-3);
  SamElasticity C    = NewDissimilar(grid);
  PetscReal     normal, tangential;

  (void)state;
  sam_call(SamElasticityGetSelfInfluence(C, &normal, &tangential));
  sam_assert_close(normal, Influence(grid, 2, 2, 0, 0), 1e-14 * normal); /* a few operations */
  sam_assert_close(tangential, fmax(Influence(grid, 0, 0, 0, 0), Influence(grid, 1, 1, 0, 0)), 1e-14 * tangential);
  sam_call(SamElasticityDestroy(&C));
  sam_call(SamGridDestroy(&grid));
}

static void test_coarser_operators_end_below_8_cells(void **state)
{
  static const PetscInt nx[] = {65, 33, 17, 9}, ny[] = {34, 17, 9, 5};

  SamGrid       grid = NewGrid(129, 67, 3e-3, 1e-3), coarse_grid;
  SamElasticity C    = NewDissimilar(grid), coarse, again;
  SamTransfer   transfer;

  (void)state;
  sam_call(SamElasticityGetCoarse(C, &coarse, &transfer));
  sam_call(SamElasticityGetCoarse(C, &again, &transfer));
  sam_assert(again == coarse);
  for (int k = 0; k < 4; k++) {
    sam_assert(coarse && transfer);
    coarse_grid = SamElasticityGetGrid(coarse);
    sam_assert(coarse_grid->nx == nx[k] && coarse_grid->ny == ny[k] && coarse_grid->width[0] == 3e-3 &&
               coarse_grid->width[1] == 1e-3);
    sam_call(SamElasticityGetCoarse(coarse, &coarse, &transfer));
  }
  sam_assert(!coarse && !transfer);
  sam_call(SamElasticityDestroy(&C));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_normal_displacement_from_pressure),
    cmocka_unit_test(test_tangential_displacement_from_shear),
    cmocka_unit_test(test_tangential_displacement_from_pressure),
    cmocka_unit_test(test_normal_displacement_from_shear),
    cmocka_unit_test(test_normal_product_in_single_precision),
    cmocka_unit_test(test_tangential_product_in_single_precision),
    cmocka_unit_test(test_operator_is_symmetric_with_coupling),
    cmocka_unit_test(test_operator_is_positive_definite),
    cmocka_unit_test(test_uniform_pressure_lowers_the_centre_as_love_says),
    cmocka_unit_test(test_hertz_pressure_gives_the_hertz_displacement),
    cmocka_unit_test(test_swapping_the_bodies_reverses_the_coupling_alone),
    cmocka_unit_test(test_displacement_is_inverse_to_young),
    cmocka_unit_test(test_rigid_body_contributes_nothing),
    cmocka_unit_test(test_impossible_bodies_are_refused),
    cmocka_unit_test(test_self_influence_is_that_of_one_cell),
    cmocka_unit_test(test_coarser_operators_end_below_8_cells),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

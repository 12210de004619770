/*
  Layered bodies: symbols, point forces and cells against reference numbers, of integrals by adaptive quadrature with
  many digits; limits that are half-spaces; reciprocity, products on periodic grids, and the same bits on any ranks.
*/
#include "fields.h"
#include "preconditioners.h"

#include <petsam/private/elasticityimpl.h>
#include "../../src/bodies/layered/layered.h"
#include <petsam/private/stress.h>
#include <petsam/private/body.h>

#define MOST 4

/* A substrate, and layers from the surface down. */
typedef struct {
  double young, poisson;
  int    count;
  double layer[MOST][3]; /* young, poisson, thickness */
} Body;

static const Body hard = {1, 0.3, 1, {{4, 0.25, 1}}}, soft = {1, 0.3, 1, {{0.1, 0.45, 1}}},
                  two = {1, 0.3, 2, {{4, 0.2, 0.5}, {0.25, 0.4, 1}}}, rigid_base = {INFINITY, 0, 1, {{1, 0.4, 1}}},
                  incompressible = {INFINITY, 0, 1, {{1, 0.5, 1}}}, thin = {1, 0.3, 1, {{4, 0.25, 0.1}}},
                  plain = {1, 0.3, 0, {{0}}}, nothing = {INFINITY, 0, 0, {{0}}};

static SamPair PairOf(const Body *first, const Body *second)
{
  const Body *body[2]               = {first, second};
  SamMaterial material[2][MOST + 1] = {{{0}}};

  for (int b = 0; b < 2; b++) {
    const Body *of = body[b];

    for (int n = 0; n < of->count; n++)
      material[b][n] = (SamMaterial){of->layer[n][0], of->layer[n][1], of->layer[n][2]};
    material[b][of->count] = (SamMaterial){.young = of->young, .poisson = of->poisson};
  }
  return NewPairOf(first->count + 1, material[0], second->count + 1, material[1]);
}

static void AssertRelative(double value, double expected, double tolerance)
{
  if (getenv("SAM_SHOW")) print_message("# %.13g %.13g %.1e\n", value, expected, fabs(value / expected - 1));
  sam_assert_close(value, expected, tolerance * fabs(expected));
}

/* ---- reference numbers ---- */

static void test_symbols_have_reference_values(void **state)
{
  static const struct {
    const Body *body;
    double      k, c[4]; /* zz, zr, rr, tt */
  } rows[] = {{&hard, 0.1, {1.7304034942453, -0.387100066602337, 1.11558718866319, 1.88198572517436}},
              {&hard, 1, {1.04309842376544, -0.398872936295302, 0.587509402231786, 0.737961940972535}},
              {&soft, 0.1, {2.0002741667644, -0.423581198265951, 4.67564353118825, 5.44174575770933}},
              {&soft, 1, {6.00573959599193, 2.58763116648521, 13.5758414782393, 23.1083711730117}},
              {&two, 1, {3.11224398049045, -0.717908658003394, 0.723199384207728, 1.17511467790783}},
              {&rigid_base, 1, {0.591097742908859, 0.19631928293647, 1.35935465087091, 2.13246363667614}},
              {&incompressible, 0.1, {0.000982322664746747, 0.0147054011430603, 0.295090345525952, 0.299003983874867}},
              {&incompressible, 1, {0.360872521773985, 0.443642884212251, 1.24815829019849, 2.28478246786729}}};

  (void)state;
  for (size_t n = 0; n < sizeof(rows) / sizeof(rows[0]); n++) {
    const SamPair pair = PairOf(&nothing, rows[n].body), other = PairOf(rows[n].body, &nothing);
    double        c[4], d[4];

    SamPairSymbols(pair, rows[n].k, c, d);
    for (int s = 0; s < 4; s++) AssertRelative(c[s], rows[n].c[s], 1e-12);
    SamPairSymbols(other, rows[n].k, c, d);
    for (int s = 0; s < 4; s++) AssertRelative(c[s], (s == SAM_WAVE_ZR ? -1 : 1) * rows[n].c[s], 1e-12);
  }
}

/* The half-spaces' part of a unit force's influence at (x, y), and the layers'. */
static void PointForce(SamPair p, double x, double y, double u[4])
{
  const double s = x * x + y * y, r = sqrt(s);
  double       f[SAM_RADIAL_FUNCTIONS];
  SamLayered   l;

  sam_call(SamLayeredCreate(p, &l));
  sam_call(SamLayeredPrepare(l, r, (const double[]){0, 0}));
  for (int k = 0; k < SAM_RADIAL_FUNCTIONS; k++) SamSplineRow(&l->radial, k, 1, &s, &f[k]);
  u[0] = p->normal / r + f[SAM_RADIAL_N];
  u[1] = p->shear / r + p->shear_xx * x * x / (s * r) + f[SAM_RADIAL_A] + f[SAM_RADIAL_B] * (x * x - y * y);
  u[2] = p->shear_xx * x * y / (s * r) + 2 * f[SAM_RADIAL_B] * x * y;
  u[3] = p->coupling * x / s + f[SAM_RADIAL_C] * x;
  sam_call(SamLayeredDestroy(&l));
}

static void test_point_forces_have_reference_values(void **state)
{
  static const struct {
    const Body *body;
    double      r, u[4]; /* u_z from p, u_x from q_x on the x axis and on the y axis, u_x from p */
  } rows[] = {{&hard, 0.2, {0.589375273673, 0.576545982401, 0.452496202902, -0.132525076319}},
              {&hard, 1, {0.246448459087, 0.16625567427, 0.144837147645, -0.0519707833763}},
              {&hard, 5, {0.0575795694899, 0.0591902540753, 0.046175853651, -0.0122275597138}},
              {&soft, 0.2, {9.10401312533, 20.9594150227, 10.5677567935, -0.94358520935}},
              {&two, 1, {0.523622035608, 0.255348988826, 0.250589451689, -0.137011819652}},
              {&rigid_base, 1, {-0.00190552885556, 0.248600083082, 0.0657619724741, 0.022494248811}},
              {&incompressible, 1, {-0.0300081519915, 0.283807955409, 0.0411644732378, 0.0663453419825}}};

  (void)state;
  for (size_t n = 0; n < sizeof(rows) / sizeof(rows[0]); n++) {
    const SamPair pair = PairOf(&nothing, rows[n].body);
    double        along[4], across[4];

    PointForce(pair, rows[n].r, 0, along);
    PointForce(pair, 0, rows[n].r, across);
    AssertRelative(along[0], rows[n].u[0], 1e-10);
    AssertRelative(along[1], rows[n].u[1], 1e-10);
    AssertRelative(across[1], rows[n].u[2], 1e-10);
    AssertRelative(along[3], rows[n].u[3], 1e-10);
  }
}

/* An elasticity on cells of 1 by 1. */
static SamElasticity NewOn(SamGrid grid, SamPair pair, SamElasticityType type)
{
  SamElasticity e;

  sam_call(SamElasticityCreate(grid, pair, &e));
  sam_call(SamElasticitySetType(e, type));
  return e;
}

/* Displacement along `row` (0, 1, 2: x, y, z) in cell (i, j) by unit traction along `column` on cell (0, 0). */
static double Influence(SamElasticity e, int row, int column, PetscInt i, PetscInt j)
{
  Vec     in = NewField(e->grid, column == 2 ? 1 : 2), out = NewField(e->grid, row == 2 ? 1 : 2);
  double *whole, value;

  AddAt(e->grid, column == 2 ? 0 : column, 0, 0, 1, in);
  if (row == 2)
    sam_call((column == 2 ? SamElasticityApplyNormal : SamElasticityApplyTangentialToNormal)(e, in, out));
  else
    sam_call((column == 2 ? SamElasticityApplyNormalToTangential : SamElasticityApplyTangential)(e, in, out));
  whole = Whole(e->grid, row == 2 ? 1 : 2, out);
  value = whole[((row == 2 ? 0 : row) * e->grid->ny + j) * e->grid->nx + i];
  free(whole);
  sam_destroy(&in, &out);
  return value;
}

static void test_cells_have_reference_values(void **state)
{
  static const struct {
    const Body *body;
    int         i, j;
    double      u[5]; /* zz, xx, yy, xy, xz */
  } rows[]     = {{&hard, 0, 0, {0.472155009842, 0.38438160012, 0.38438160012, 0, 0}},
                  {&hard, 3, 2, {0.0817790969877, 0.0686391459241, 0.06381961848, 0.00578268669219, -0.0154930378676}},
                  {&thin, 0, 0, {0.946351724464, 0.734679150307, 0.734679150307, 0, 0}},
                  {&thin, 1, 0, {0.297181800793, 0.353758107488, 0.272857594381, 0, -0.0587562457369}}};
  SamGrid grid = NewGrid(5, 4, 5, 4);

  (void)state;
  for (size_t n = 0; n < sizeof(rows) / sizeof(rows[0]); n++) {
    static const int which[5][2] = {{2, 2}, {0, 0}, {1, 1}, {0, 1}, {0, 2}};
    const SamPair    pair        = PairOf(&nothing, rows[n].body);
    SamElasticity    e           = NewOn(grid, pair, SAM_ELASTICITY_HALFSPACE);

    for (int c = 0; c < 5; c++) {
      const double value = Influence(e, which[c][0], which[c][1], rows[n].i, rows[n].j);

      if (rows[n].u[c] == 0)
        sam_assert_close(value, 0, 1e-14);
      else
        AssertRelative(value, rows[n].u[c], 1e-10);
    }
    sam_call(SamElasticityDestroy(&e));
  }
  sam_call(SamGridDestroy(&grid));
}

/* ---- layers that make no difference ---- */

/* The largest differences of all kinds of influence on 24 x 20 cells of these sides, over that of a cell on itself. */
static double Unlike(SamPair a, SamPair b, double dx, double dy, SamElasticityType type)
{
  static const int which[6][2] = {{2, 2}, {0, 0}, {1, 1}, {0, 1}, {0, 2}, {1, 2}};
  SamGrid          grid        = NewGrid(24, 20, 24 * dx, 20 * dy);
  SamElasticity    e[2]        = {NewOn(grid, a, type), NewOn(grid, b, type)};
  double           worst       = 0;

  for (int c = 0; c < 6; c++) {
    const int n_in = which[c][1] == 2 ? 1 : 2, n_out = which[c][0] == 2 ? 1 : 2;
    Vec       in = NewField(grid, n_in), u[2] = {NewField(grid, n_out), NewField(grid, n_out)};

    AddAt(grid, n_in == 1 ? 0 : which[c][1], 3, 2, 1, in);
    for (int k = 0; k < 2; k++)
      sam_call((n_in == 2    ? SamElasticityApplyTangential
                : n_out == 2 ? SamElasticityApplyNormalToTangential
                             : SamElasticityApplyNormal)(e[k], in, u[k]));
    sam_call(VecAXPY(u[0], -1, u[1]));
    worst = fmax(worst, Norm(u[0], NORM_INFINITY) / (b->normal * sqrt(dx * dy)));
    sam_call(VecDestroy(&in));
    for (int k = 0; k < 2; k++) sam_call(VecDestroy(&u[k]));
  }
  for (int k = 0; k < 2; k++) sam_call(SamElasticityDestroy(&e[k]));
  sam_call(SamGridDestroy(&grid));
  if (getenv("SAM_SHOW")) print_message("# difference %.2e\n", worst);
  return worst;
}

static void test_layers_of_one_material_are_one(void **state)
{
  static const Body cut  = {1, 0.3, 3, {{4, 0.25, 0.2}, {4, 0.25, 0.5}, {4, 0.25, 0.3}}},
                    same = {1, 0.3, 2, {{1, 0.3, 0.4}, {1, 0.3, 1}}};
  const SamPair whole = PairOf(&soft, &hard), parts = PairOf(&soft, &cut), half_space = PairOf(&nothing, &plain),
                like                     = PairOf(&nothing, &same);
  static const SamElasticityType types[] = {SAM_ELASTICITY_HALFSPACE, SAM_ELASTICITY_PERIODIC};

  (void)state;
  for (int t = 0; t < 2; t++) {
    sam_assert_close(Unlike(parts, whole, 0.3, 0.1, types[t]), 0, 1e-11);
    sam_assert_close(Unlike(like, half_space, 0.3, 0.1, types[t]), 0, 1e-13);
  }
}

/* A vanishing layer leaves the substrate, of order h; one without end hides it, of order 1/h. */
static void test_thin_and_thick_layers_are_half_spaces(void **state)
{
  static const Body skin = {1, 0.3, 1, {{4, 0.25, 1e-9}}}, block = {1, 0.3, 1, {{4, 0.25, 1e7}}},
                    top = {4, 0.25, 0, {{0}}};
  const SamPair a = PairOf(&nothing, &skin), b = PairOf(&nothing, &plain), c = PairOf(&nothing, &block),
                d = PairOf(&nothing, &top);

  (void)state;
  sam_assert_close(Unlike(a, b, 1, 0.25, SAM_ELASTICITY_HALFSPACE), 0, 2e-7);
  sam_assert_close(Unlike(c, d, 1, 0.25, SAM_ELASTICITY_HALFSPACE), 0, 3e-6);
  sam_assert_close(Unlike(a, b, 1, 0.25, SAM_ELASTICITY_PERIODIC), 0, 2e-7);
  sam_assert_close(Unlike(c, d, 1, 0.25, SAM_ELASTICITY_PERIODIC), 0, 1e-12);
}

/* ---- integrals over cells at all distances ---- */

/* Quadrature by 16 x 16 points on parts that are small against the distance and the layer. */
static double Quadrature(SamLayered l, const double at[2], const double side[2], int parts)
{
  double sum = 0;

  for (int m = 0; m < 4 * parts * parts; m++) {
    /* the mid points of 2 x 2 and of 1 x 1 would not do: Gauss' two points in each part */
    const double root = 0.5 / sqrt(3), x = (m % (2 * parts) / 2 + 0.5 + (m % 2 ? root : -root)) / parts - 0.5,
                 y = (m / (2 * parts) / 2 + 0.5 + (m / (2 * parts) % 2 ? root : -root)) / parts - 0.5;
    const double s = pow(at[0] + x * side[0], 2) + pow(at[1] + y * side[1], 2);
    double       f;

    SamSplineRow(&l->radial, SAM_RADIAL_N, 1, &s, &f);
    sum += f * side[0] * side[1] / (4 * parts * parts);
  }
  return sum;
}

static void test_cells_are_integrals_at_all_distances(void **state)
{
  static const double side[2]     = {1, 0.5};
  static const int    lags[][2]   = {{0, 0},  {2, 1},  {7, 0},   {0, 17},  {9, 3},
                                     {40, 2}, {45, 1}, {60, 50}, {639, 7}, {700, 3}};
  static const double thickness[] = {0.3, 5, 400};

  (void)state;
  for (int t = 0; t < 3; t++) {
    const Body    body = {1, 0.3, 1, {{4, 0.25, thickness[t]}}};
    const SamPair pair = PairOf(&nothing, &body);
    SamLayered    l;

    sam_call(SamLayeredCreate(pair, &l));
    sam_call(SamLayeredPrepare(l, 2000, (const double[]){0, 0}));
    for (size_t k = 0; k < sizeof(lags) / sizeof(lags[0]); k++) {
      const double at[2]     = {lags[k][0] * side[0], lags[k][1] * side[1]};
      double       row[1000] = {0};

      SamLayeredAddRow(l, SAM_INTEGRAL_R, side[0], side[1], lags[k][1], 1000, row);
      AssertRelative(row[lags[k][0]], Quadrature(l, at, side, hypot(at[0], at[1]) < 3 ? 250 : 40), 2e-11);
    }
    sam_call(SamLayeredDestroy(&l));
  }
}

/* ---- products ---- */

/* What shear does to u_z, pressure does to u_t, with the sign of reciprocity: the operator is symmetric. */
static void test_products_are_reciprocal(void **state)
{
  static const SamElasticityType types[] = {SAM_ELASTICITY_HALFSPACE, SAM_ELASTICITY_PERIODIC};
  const SamPair                  pair    = PairOf(&soft, &two);
  SamGrid                        grid    = NewGrid(19, 14, 6, 3);

  (void)state;
  for (int t = 0; t < 2; t++) {
    SamElasticity e = NewOn(grid, pair, types[t]);
    Vec p = NewRandom(grid, 1, 1), q = NewRandom(grid, 2, 2), r = NewRandom(grid, 2, 3), u = NewField(grid, 1),
        v = NewField(grid, 2);
    double both;

    sam_call(SamElasticityApplyTangentialToNormal(e, q, u));
    sam_call(SamElasticityApplyNormalToTangential(e, p, v));
    both = Dot(p, u);
    sam_assert_close(both, Dot(q, v), 1e-12 * Norm(p, NORM_2) * Norm(u, NORM_2));
    sam_call(SamElasticityApplyTangential(e, q, v));
    both = Dot(r, v);
    sam_assert(Dot(q, v) > 0);
    sam_call(SamElasticityApplyTangential(e, r, v));
    sam_assert_close(Dot(q, v), both, 1e-12 * Norm(q, NORM_2) * Norm(v, NORM_2));
    sam_destroy(&p, &q, &r, &u, &v);
    sam_call(SamElasticityDestroy(&e));
  }
  sam_call(SamGridDestroy(&grid));
}

/* A wave on the periodic grid is multiplied by its symbols, and the preconditioners take it back. */
static void test_waves_are_multiplied_by_symbols(void **state)
{
  const SamPair pair = PairOf(&soft, &two);
  SamGrid       grid = NewGrid(20, 16, 5, 3);
  SamElasticity e    = NewOn(grid, pair, SAM_ELASTICITY_PERIODIC);
  const double  k[2] = {2 * PETSC_PI * 3 / 5, -2 * PETSC_PI * 2 / 3}, size = hypot(k[0], k[1]);
  Vec           in = NewField(grid, 2), out = NewField(grid, 2), back = NewField(grid, 2);
  double       *a, c[4], d[4], worst = 0;

  (void)state;
  SamPairSymbols(pair, size, c, d);
  for (int across = 0; across < 2; across++) {
    const double along[2] = {across ? -k[1] / size : k[0] / size, across ? k[0] / size : k[1] / size},
                 gain     = c[across ? SAM_WAVE_TT : SAM_WAVE_RR] / size;

    sam_call(VecGetArray(in, &a));
    for (PetscInt m = 0; m < 2 * grid->cells; m++) {
      const PetscInt cell = m % grid->cells;
      const double   x = SamGridX(grid, cell % grid->nx), y = SamGridY(grid, grid->row_start + cell / grid->nx);

      a[m] = along[m / grid->cells] * cos(k[0] * x + k[1] * y);
    }
    sam_call(VecRestoreArray(in, &a));
    sam_call(SamElasticityApplyTangential(e, in, out));
    sam_call(PreconditionTangential(e, out, back));
    sam_call(VecAXPY(back, -1, in));
    sam_call(VecAXPY(out, -gain, in));
    sam_assert_close(Norm(out, NORM_INFINITY), 0, 1e-13 * gain);
    sam_assert_close(Norm(back, NORM_INFINITY), 0, 1e-5);
  }
  /* u_z from shear, and the other way round: cos becomes sin */
  sam_call(VecGetArray(in, &a));
  for (PetscInt m = 0; m < grid->cells; m++) {
    const double x = SamGridX(grid, m % grid->nx), y = SamGridY(grid, grid->row_start + m / grid->nx);

    a[m] = cos(k[0] * x + k[1] * y);
  }
  sam_call(VecRestoreArray(in, &a));
  {
    Vec           p = NewField(grid, 1);
    double       *b;
    const double *u;

    sam_call(VecGetArray(p, &b));
    sam_call(VecGetArray(in, &a));
    sam_call(PetscArraycpy(b, a, grid->cells));
    sam_call(VecRestoreArray(in, &a));
    sam_call(VecRestoreArray(p, &b));
    sam_call(SamElasticityApplyNormalToTangential(e, p, out));
    sam_call(VecGetArrayRead(out, &u));
    for (PetscInt m = 0; m < 2 * grid->cells; m++) {
      const PetscInt cell = m % grid->cells;
      const double   x = SamGridX(grid, cell % grid->nx), y = SamGridY(grid, grid->row_start + cell / grid->nx);

      worst = fmax(worst, fabs(u[m] - c[SAM_WAVE_ZR] / size * k[m / grid->cells] / size * sin(k[0] * x + k[1] * y)));
    }
    sam_call(VecRestoreArrayRead(out, &u));
    sam_assert_close(worst, 0, 1e-13 * fabs(c[SAM_WAVE_ZR]) / size);
    sam_call(VecDestroy(&p));
  }
  sam_destroy(&in, &out, &back);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* A cell's influence on itself, in double and in single precision. */
static void test_a_cell_displaces_itself_as_products_say(void **state)
{
  static const SamElasticityType types[] = {SAM_ELASTICITY_HALFSPACE, SAM_ELASTICITY_PERIODIC};
  const SamPair                  pair    = PairOf(&rigid_base, &hard);
  SamGrid                        grid    = NewGrid(12, 10, 4, 6);

  (void)state;
  for (int t = 0; t < 2; t++) {
    SamElasticity e = NewOn(grid, pair, types[t]);
    PetscReal     normal, tangential;
    double        u[2] = {Influence(e, 0, 0, 0, 0), Influence(e, 1, 1, 0, 0)};

    sam_call(SamElasticityGetSelfInfluence(e, &normal, &tangential));
    sam_assert_close(Influence(e, 2, 2, 0, 0) / normal, 1, 1e-12);
    sam_assert_close(fmax(u[0], u[1]) / tangential, 1, 1e-12);
    sam_call(SamElasticityDestroy(&e));
  }
  sam_call(SamGridDestroy(&grid));
}

/* Parts and coarse grids take the same tables; a part's products are those of the whole. */
static void test_parts_and_coarse_grids_are_the_same_bodies(void **state)
{
  const PetscInt first[2] = {6, 9}, n[2] = {12, 10};
  const SamPair  pair = PairOf(&soft, &hard);
  SamGrid        grid = NewGrid(40, 36, 8, 9);
  SamElasticity  e    = NewOn(grid, pair, SAM_ELASTICITY_HALFSPACE), part, coarse;
  SamTransfer    transfer;
  SamWindow      window;
  PetscReal      self[2];

  (void)state;
  sam_call(SamElasticityChoosePart(e, first, n, PETSC_FALSE, &window, &part));
  sam_assert(part != NULL);
  AssertRelative(Influence(part, 2, 2, 4, 3), Influence(e, 2, 2, 4, 3), 1e-13);
  AssertRelative(Influence(part, 0, 2, 4, 3), Influence(e, 0, 2, 4, 3), 1e-12);
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  sam_call(SamElasticityGetSelfInfluence(coarse, &self[0], NULL));
  AssertRelative(Influence(coarse, 2, 2, 0, 0), self[0], 1e-13);
  sam_assert(Influence(coarse, 2, 2, 8, 7) > 0);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

static void test_results_are_the_same_on_any_number_of_ranks(void **state)
{
  static const SamElasticityType types[] = {SAM_ELASTICITY_HALFSPACE, SAM_ELASTICITY_PERIODIC};
  const SamPair                  pair    = PairOf(&soft, &two);

  (void)state;
  for (int t = 0; t < 2; t++) {
    double *u[2];

    for (int alone = 0; alone < 2; alone++) {
      SamGrid       grid = NewGridOn(alone ? PETSC_COMM_SELF : PETSC_COMM_WORLD, 23, 17, 3, 2, 0, 0);
      SamElasticity e    = NewOn(grid, pair, types[t]);
      Vec           q    = NewRandom(grid, 2, 1);

      sam_call(SamElasticityApplyTangential(e, q, q));
      sam_call(PreconditionTangential(e, q, q));
      u[alone] = Whole(grid, 2, q);
      sam_call(VecDestroy(&q));
      sam_call(SamElasticityDestroy(&e));
      sam_call(SamGridDestroy(&grid));
    }
    sam_assert(!memcmp(u[0], u[1], sizeof(double) * 2 * 23 * 17));
    for (int alone = 0; alone < 2; alone++) free(u[alone]);
  }
}

/* ---- bodies ---- */

static void test_bodies_with_layers_come_back_from_their_parameters(void **state)
{
  const SamPair pair = PairOf(&plain, &two);
  SamParameters p    = {.count = 0};
  SamPair       same;

  (void)state;
  sam_call(SamPairAddParameters(pair, &p));
  sam_assert(SamParametersFind(&p, "body2_layer_thickness")->count == 2);
  sam_assert(!SamParametersFind(&p, "body1_layer_thickness"));
  sam_call(SamPairCreateFromParameters(PETSC_COMM_WORLD, &p, "x.h5", &same));
  for (int b = 0; b < 2; b++)
    sam_assert(!memcmp(pair->body[b]->material, same->body[b]->material, sizeof(same->body[b]->material)));
  sam_call(SamPairDestroy(&same));
  p.list[p.count - 1].count = 1;
  sam_fails(SamPairCreateFromParameters(PETSC_COMM_WORLD, &p, "x.h5", &same), SAM_ERR_FILE);
  p.list[p.count - 1].count    = 2;
  p.list[p.count - 1].value[1] = 0;
  sam_fails(SamPairCreateFromParameters(PETSC_COMM_WORLD, &p, "x.h5", &same), SAM_ERR_FILE);
}

/* Alike bodies with alike layers are not coupled; else layers couple, whatever the materials at the surface. */
static void test_layers_couple(void **state)
{
  const SamPair alike = PairOf(&two, &two), other = PairOf(&hard, &thin), half = PairOf(&plain, &soft);

  (void)state;
  sam_assert(!SamPairIsCoupled(alike));
  sam_assert(SamPairIsCoupled(other));
  sam_assert(SamPairIsCoupled(half));
}

/* Stresses are those of bodies without layers only. */
/* A type that does not know of layers refuses them. */
static PetscErrorCode CreateBare(SamElasticity e)
{
  e->traits = (SamElasticityTraits){.mean = PETSC_TRUE};
  return 0;
}

static void test_types_without_layers_refuse_them(void **state)
{
  const SamPair pair = PairOf(&plain, &hard);
  SamGrid       grid = NewGrid(16, 16, 4, 4);
  SamElasticity e;

  (void)state;
  sam_call(SamElasticityRegister("bare", CreateBare));
  sam_call(SamElasticityCreate(grid, pair, &e));
  sam_call(PetscOptionsInsertString(NULL, "-elasticity bare"));
  sam_fails(SamElasticitySetFromOptions(e), SAM_ERR_USER);
  sam_call(PetscOptionsClear(NULL));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_symbols_have_reference_values),
                                     cmocka_unit_test(test_point_forces_have_reference_values),
                                     cmocka_unit_test(test_cells_have_reference_values),
                                     cmocka_unit_test(test_layers_of_one_material_are_one),
                                     cmocka_unit_test(test_thin_and_thick_layers_are_half_spaces),
                                     cmocka_unit_test(test_cells_are_integrals_at_all_distances),
                                     cmocka_unit_test(test_products_are_reciprocal),
                                     cmocka_unit_test(test_waves_are_multiplied_by_symbols),
                                     cmocka_unit_test(test_a_cell_displaces_itself_as_products_say),
                                     cmocka_unit_test(test_parts_and_coarse_grids_are_the_same_bodies),
                                     cmocka_unit_test(test_results_are_the_same_on_any_number_of_ranks),
                                     cmocka_unit_test(test_bodies_with_layers_come_back_from_their_parameters),
                                     cmocka_unit_test(test_layers_couple),
                                     cmocka_unit_test(test_types_without_layers_refuse_them)};

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

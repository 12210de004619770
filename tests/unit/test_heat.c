/* Temperatures by moving heat on cells against closed solutions, and its partition between two bodies. */
#include "fields.h"

#include "../../src/laws/heat/heat.h"

#include <math.h>

static const PetscReal unit[2] = {1, 1};

/* The body with the conductivity and the diffusivity 1 and P = speed/(2 D), whose material moves to -x. */
static SamHeatBody Moving(double p)
{
  return (SamHeatBody){.conductivity = 1, .capacity = 1, .speed = -2 * p};
}

static double Cell(const SamHeatBody *body, const PetscReal side[2], double depth, PetscInt i, PetscInt j)
{
  double value;

  sam_call(SamHeatRow(body, side, depth, j, i, 1, &value));
  return value;
}

/* ---- kernels ---- */

/* Cells 1 x 1 at the lags (0,0), (-1,0), (1,0), (-5,2), and (0,0) at a depth: from an integration with many points. */
static void test_cells_have_reference_values(void **state)
{
  static const struct {
    double p, at[4], depth, below;
  } rows[] = {
    {0, {0.5610998523392, 0.1652107466445, 0.1652107466445, 0.02959697183433}, 0.5, 0.2525340516123},
    {0.1, {0.545630219408, 0.1644728601392, 0.1370859391023, 0.02846154097998}, 0.5, 0.2372078695672},
    {10, {0.1812925148847, 0.1144017193756, 3.621005496958e-7, 0.0009802865068999}, 0.5, 0.004039488797358},
    {1e5, {0.001784128576446, 0.001306067614897, 0, 0}, 0.005, 1.971542899395e-5},
  };

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(*rows); k++) {
    static const PetscInt lags[4][2] = {{0, 0}, {-1, 0}, {1, 0}, {-5, 2}};
    const SamHeatBody     body       = Moving(rows[k].p);

    for (int l = 0; l < 4; l++)
      sam_assert_close(Cell(&body, unit, 0, lags[l][0], lags[l][1]), rows[k].at[l], 1e-12 * rows[k].at[0]);
    sam_assert_close(Cell(&body, unit, rows[k].depth, 0, 0), rows[k].below, 1e-12 * rows[k].at[0]);
  }
}

static void test_strips_have_reference_values(void **state)
{
  static const PetscInt  lags[4] = {0, -1, 1, -5};
  static const PetscReal strip[] = {1, INFINITY};
  static const struct {
    double p, at[4];
  } rows[] = {{0.1, {1.309535207055, 0.8671775822426, 0.7149869623082, 0.4855447645104}},
              {10, {0.182722454457, 0.1288407523793, 3.79101676086e-7, 0.05634943376638}}};

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(*rows); k++)
    for (int l = 0; l < 4; l++) {
      const SamHeatBody body = Moving(rows[k].p);

      sam_assert_close(Cell(&body, strip, 0, lags[l], 0), rows[k].at[l], 1e-12 * rows[k].at[0]);
    }
}

/* The maximum of a band with half width 1 lies behind its centre; here it is the sum of those of narrow strips. */
static void test_maximum_of_a_band(void **state)
{
  static const PetscReal side[] = {1e-3, INFINITY};
  static const struct {
    double p, x, most;
  } rows[] = {{1, -0.66644701, 0.991850421751}, {10, -0.92438129, 0.348499748743}};
  enum { N = 2000 };

  (void)state;
  for (int k = 0; k < 2; k++) {
    const SamHeatBody body  = Moving(rows[k].p);
    const PetscInt    place = (PetscInt)floor((rows[k].x + 1) / side[0]);
    double           *value = (double *)malloc(sizeof(*value) * N), at[3] = {0};

    for (PetscInt l = 0; l < 3; l++) { /* the cell of the maximum, and those beside it */
      sam_call(SamHeatRow(&body, side, 0, 0, place + l - N, N, value));
      for (PetscInt i = 0; i < N; i++) at[l] += value[i];
    }
    sam_assert(at[1] > at[0] && at[1] > at[2]);
    at[1] += (at[2] - at[0]) * (at[2] - at[0]) / (16 * at[1] - 8 * at[0] - 8 * at[2]); /* vertex of a parabola */
    sam_assert_close(at[1], rows[k].most, 1e-8 * rows[k].most);
    free(value);
  }
}

/* A band and a square of three cells along each side: their temperature is the sum of those of their cells. */
static void test_temperature_is_that_of_the_parts(void **state)
{
  static const PetscReal whole[] = {3, INFINITY}, part[] = {1, INFINITY}, cell[] = {3, 3};
  const SamHeatBody      body = Moving(0.7), back = {2, 3, 0.5};
  double                 sum = 0, cells = 0;

  (void)state;
  for (PetscInt i = -1; i <= 1; i++) sum += Cell(&body, part, 0.2, i - 3, 0);
  sam_assert_close(sum, Cell(&body, whole, 0.2, -1, 0), 1e-13);
  for (PetscInt i = -1; i <= 1; i++)
    for (PetscInt j = -1; j <= 1; j++) cells += Cell(&back, unit, 0, i + 3, j - 3);
  sam_assert_close(cells, Cell(&back, cell, 0, 1, -1), 1e-13);
}

static void test_directions_mirror_each_other(void **state)
{
  static const PetscReal side[] = {0.3e-3, 0.2e-3};

  (void)state;
  for (PetscInt i = -4; i <= 4; i++)
    for (PetscInt j = 0; j <= 3; j++) {
      const SamHeatBody to = {50, 3.6e6, 0.7}, fro = {50, 3.6e6, -0.7};

      sam_assert(Cell(&to, side, 1e-5, i, j) == Cell(&fro, side, 1e-5, -i, j));
      sam_assert(Cell(&to, side, 1e-5, i, j) == Cell(&to, side, 1e-5, i, -j));
    }
  sam_assert(Cell(&(SamHeatBody){50, 3.6e6, 0.7}, side, 0, 2, 0) >
             100 * Cell(&(SamHeatBody){50, 3.6e6, -0.7}, side, 0, 2, 0));
}

/* The integral for hardly any speed and depth is the closed form; slow bodies need the tail. */
static void test_slow_bodies_approach_the_one_at_rest(void **state)
{
  static const PetscReal side[] = {1, 0.4};
  const SamHeatBody      rest   = Moving(0);

  (void)state;
  for (PetscInt i = -300; i <= 300; i += 60)
    for (PetscInt j = 0; j <= 40; j += 20) {
      const double      own = Cell(&rest, side, 0, 0, 0), still = Cell(&rest, side, 0, i, j);
      const SamHeatBody slow = Moving(1e-13), slower = Moving(1e-200), some = Moving(1e-7);

      sam_assert_close(Cell(&slow, side, 0, i, j), still, 1e-12 * own);
      sam_assert_close(Cell(&slower, side, 0, i, j), still, 1e-14 * own);
      sam_assert_close(Cell(&rest, side, 1e-13, i, j), still, 1e-12 * own);
      /* far away: exp(-P (r + x))/(2 pi r) */
      if (i)
        sam_assert_close(Cell(&some, side, 0, i, j) / still - 1,
                         expm1(-1e-7 * (hypot((double)i, 0.4 * (double)j) + (double)i)), 1e-9);
    }
}

static void test_long_cells_are_strips(void **state)
{
  static const PetscReal side[] = {1, 1e6}, strip[] = {1, INFINITY};

  (void)state;
  for (PetscInt i = -5; i <= 5; i++) {
    const SamHeatBody body = Moving(0.3);

    sam_assert_close(Cell(&body, side, 0, i, 0), Cell(&body, strip, 0, i, 0), 1e-13);
  }
}

static void test_fast_bodies_conduct_downwards_only(void **state)
{
  (void)state;
  for (PetscInt i = -3; i <= 0; i++) {
    const double      p = 1e5, x = (double)i, at = sqrt(0.5 - x) - (x < -0.5 ? sqrt(-0.5 - x) : 0);
    const SamHeatBody body = Moving(p);

    sam_assert_close(Cell(&body, (const PetscReal[]){1, 1000}, 0, i, 0), sqrt(2 / (PETSC_PI * p)) * at, 1e-8);
  }
}

static void test_tables_are_rows(void **state)
{
  static const PetscReal side[]   = {1, 0.7};
  static const double    speeds[] = {0, 0, 3, -3}, depths[] = {0, 0.5, 0, 0.1};
  enum { N = 12 };
  const PetscInt n[2] = {N, 6};

  (void)state;
  for (int k = 0; k < 4; k++) {
    const SamHeatBody body = {2, 1, speeds[k]};
    SamHeatTable      table;

    sam_call(SamHeatTableCreate(&body, side, depths[k], n, &table));
    for (int turn = 0; turn < 9; turn++) {
      const PetscInt j = turn < 6 ? turn : 2 * turn - 11;
      double         even[N], odd[N], ahead[N], behind[N];

      SamHeatTableRow(table, j, even, odd);
      sam_call(SamHeatRow(&body, side, depths[k], j, 0, N, ahead));
      sam_call(SamHeatRow(&body, side, depths[k], j, 1 - N, N, behind));
      for (PetscInt i = 0; i < N; i++) {
        sam_assert_close(even[i] + odd[i], ahead[i], 1e-14);
        sam_assert_close(even[i] - odd[i], behind[N - 1 - i], 1e-14);
      }
    }
    sam_call(SamHeatTableDestroy(&table));
  }
}

static void test_wrong_bodies_are_refused(void **state)
{
  static const PetscReal strip[] = {1, INFINITY};
  const SamHeatBody      good = {1, 1, 1}, still = {1, 1, 0};
  double                 v;

  (void)state;
  sam_says(SamHeatRow(&(SamHeatBody){0, 1, 1}, unit, 0, 0, 0, 1, &v), PETSC_ERR_ARG_OUTOFRANGE, "Conductivity 0");
  sam_says(SamHeatRow(&(SamHeatBody){1, -2, 1}, unit, 0, 0, 0, 1, &v), PETSC_ERR_ARG_OUTOFRANGE, "capacity -2");
  sam_says(SamHeatRow(&(SamHeatBody){1, 1, NAN}, unit, 0, 0, 0, 1, &v), PETSC_ERR_ARG_OUTOFRANGE, "Speed nan");
  sam_says(SamHeatRow(&good, (const PetscReal[]){0, 1}, 0, 0, 0, 1, &v), PETSC_ERR_ARG_OUTOFRANGE, "Sides 0");
  sam_says(SamHeatRow(&good, unit, -1, 0, 0, 1, &v), PETSC_ERR_ARG_OUTOFRANGE, "Depth -1");
  sam_says(SamHeatRow(&still, strip, 0, 0, 0, 1, &v), PETSC_ERR_SUP, "plane strain");
  sam_says(SamHeatRow(&(SamHeatBody){1, 1, 1e-200}, strip, 0, 0, 0, 1, &v), PETSC_ERR_SUP, "plane strain");
  sam_call(SamHeatRow(&good, strip, 0, 0, 0, 1, &v));
}

/* ---- operators ---- */

static SamConductor NewConductor(SamGrid grid, SamHeatBody body, double depth)
{
  SamConductor c;

  sam_call(SamConductorCreate(grid, NULL, &body, depth, &c));
  return c;
}

/* Products on a grid are the sums over all pairs of cells, for bodies that stand or move either way. */
static void CheckProducts(SamGrid grid, double depth, double speed)
{
  const PetscInt nx = grid->nx, ny = grid->ny;
  SamHeatBody    body = {20, 1e6, speed};
  SamConductor   c    = NewConductor(grid, body, depth);
  Vec            flux = NewRandom(grid, 1, 3);
  double        *in = Whole(grid, 1, flux), *out, *row = (double *)malloc(sizeof(*row) * (size_t)(2 * nx));
  const double   whole = Cell(&body, grid->area, depth, 0, 0);

  sam_call(SamConductorApply(c, flux, flux));
  out = Whole(grid, 1, flux);
  for (PetscInt j = 0; j < ny; j++)
    for (PetscInt i = 0; i < nx; i++) {
      double sum = 0;

      for (PetscInt l = 0; l < ny; l++) {
        sam_call(SamHeatRow(&body, grid->area, depth, j - l, i - nx + 1, nx, row));
        for (PetscInt k = 0; k < nx; k++) sum += row[nx - 1 - k] * in[l * nx + k];
      }
      sam_assert_close(out[j * nx + i], sum, 1e-14 * (double)nx * whole);
    }
  free(row);
  free(in);
  free(out);
  sam_destroy(&flux);
  sam_call(SamConductorDestroy(&c));
}

static void test_products_are_sums_over_cells(void **state)
{
  SamGrid grid = NewGrid(7, 5, 3e-3, 1e-3), row = NewGrid(13, 1, 3e-3, 1);

  (void)state;
  CheckProducts(grid, 0, 0);
  CheckProducts(grid, 0, 0.02);
  CheckProducts(grid, 1e-4, -0.02);
  CheckProducts(row, 0, 0.02);
  CheckProducts(row, 1e-4, -0.03);
  sam_call(SamGridDestroy(&grid));
  sam_call(SamGridDestroy(&row));
}

static double Dome(double x, double y, const void *context)
{
  const double square = 1 - x * x - y * y;

  (void)context;
  return square > 0 ? sqrt(square) : 0;
}

static double Circle(double x, double y, const void *context)
{
  (void)context;
  return hypot(x, y) < 1 ? 1 : 0;
}

/* Means over a cell, by points; the context is the cells' width. */
static double MeanOf(double (*flux)(double, double, const void *), double x, double y, double width)
{
  enum { N = 40 };
  double sum = 0;

  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) sum += flux(x + width * ((i + 0.5) / N - 0.5), y + width * ((j + 0.5) / N - 0.5), NULL);
  return sum / (N * N);
}

static double MeanDome(double x, double y, const void *width)
{
  return MeanOf(Dome, x, y, *(const double *)width);
}

static double MeanCircle(double x, double y, const void *width)
{
  return MeanOf(Circle, x, y, *(const double *)width);
}

/* Temperature of the centre, on n cells along each side of a square, n odd. */
static double CentreOf(double (*flux)(double, double, const void *), PetscInt n, double p)
{
  SamGrid      grid = NewGrid(n, n, 2.2, 2.2);
  const double dx   = (double)grid->dx;
  SamConductor c    = NewConductor(grid, Moving(p), 0);
  Vec          t    = NewFrom(grid, flux, &dx);
  double      *whole, centre;

  sam_call(SamConductorApply(c, t, t));
  whole  = Whole(grid, 1, t);
  centre = whole[(n / 2) * n + n / 2];
  free(whole);
  sam_destroy(&t);
  sam_call(SamConductorDestroy(&c));
  sam_call(SamGridDestroy(&grid));
  return centre;
}

static void test_centres_of_discs_are_of_second_order(void **state)
{
  static const struct {
    double p, hertz;
  } rows[]                       = {{0, PETSC_PI / 4}, {5, 0.300350410187}, {500, 0.0311764771895}};
  static const double discs[][2] = {{0.5, 0.801456073634}, {5, 0.347513079554}, {50, 0.11255475054}};

  (void)state;
  for (int k = 0; k < 3; k++) {
    const double coarse = fabs(CentreOf(MeanDome, 65, rows[k].p) / rows[k].hertz - 1),
                 fine   = fabs(CentreOf(MeanDome, 129, rows[k].p) / rows[k].hertz - 1);

    sam_assert(coarse < 3e-4 && fine < 8e-5);
    sam_assert(coarse / fine > 3.2 && coarse / fine < 5);
  }
  for (int k = 0; k < 3; k++) sam_assert_close(CentreOf(MeanCircle, 65, discs[k][0]) / discs[k][1], 1, 2e-4);
}

/* ---- partition ---- */

typedef struct {
  SamHeatPair   pair;
  SamGrid       grid;
  SamHeatReport report;
  PetscReal     bulk[2];
  Vec           contact, heat, q[2], t[2];
} Split;

static void Divide(Split *s)
{
  sam_call(SamHeatSplit(&s->pair, s->contact, s->heat, s->bulk, s->q[1], &s->report));
  sam_call(VecWAXPY(s->q[0], -1, s->q[1], s->heat));
  for (int b = 0; b < 2; b++) {
    sam_call(SamConductorApply(s->pair.body[b], s->q[b], s->t[b]));
    sam_call(VecShift(s->t[b], s->bulk[b]));
  }
}

static Split NewSplit(SamGrid grid, SamHeatBody one, SamHeatBody two)
{
  Split s = {.pair    = {.body = {NewConductor(grid, one, 0), NewConductor(grid, two, 0)}, .rtol = 1e-8, .most = 60},
             .grid    = grid,
             .contact = NewFrom(grid, Circle, NULL),
             .heat    = NewFrom(grid, Dome, NULL)};

  for (int b = 0; b < 2; b++) {
    s.q[b] = NewField(grid, 1);
    s.t[b] = NewField(grid, 1);
  }
  return s;
}

static void DestroySplit(Split *s)
{
  sam_destroy(&s->contact, &s->heat, &s->q[0], &s->q[1], &s->t[0], &s->t[1]);
  for (int b = 0; b < 2; b++) sam_call(SamConductorDestroy(&s->pair.body[b]));
}

/* The largest difference T1 - T2 - r q2 in contact; share of body 2, maximum and mean of T1 in contact */
typedef struct {
  double jump, share, most, mean;
} Found;

static Found Measure(const Split *s)
{
  const PetscInt n = s->grid->nx * s->grid->ny;
  Found          f = {0};
  double *contact = Whole(s->grid, 1, s->contact), *heat = Whole(s->grid, 1, s->heat), *q = Whole(s->grid, 1, s->q[1]),
         *t1 = Whole(s->grid, 1, s->t[0]), *t2 = Whole(s->grid, 1, s->t[1]);
  double sum = 0, cells = 0, part = 0;

  f.most = -INFINITY;
  for (PetscInt k = 0; k < n; k++) {
    sum += heat[k];
    part += q[k];
    if (!(contact[k] > 0)) sam_assert(q[k] == 0);
    if (!(contact[k] > 0)) continue;
    f.jump = fmax(f.jump, fabs(t1[k] - t2[k] - s->pair.resistance * q[k]));
    f.most = fmax(f.most, t1[k]);
    f.mean += t1[k];
    cells += 1;
  }
  f.mean /= cells;
  f.share = part / sum;
  free(contact);
  free(heat);
  free(q);
  free(t1);
  free(t2);
  return f;
}

/* Conductivity, diffusivity and P. */
static SamHeatBody Body(const double of[3])
{
  return (SamHeatBody){.conductivity = of[0], .capacity = of[0] / of[1], .speed = -2 * of[2] * of[1]};
}

static void test_shares_of_discs(void **state)
{
  static const struct {
    double   one[3], two[3], share, most, mean;
    PetscInt products;
  } rows[]     = {{{1, 1, 0}, {1, 1, 0}, 0.5, 0.39264, 0.29463, 0},
                  {{1, 1, 0}, {1, 1, 10}, 0.80011, 0.196496, 0.123639, 10},
                  {{1, 1, 0}, {1, 1, 1000}, 0.976375, 0.0266451, 0.0148850, 12},
                  {{1, 1, 1000}, {1, 1, 1000}, 0.5, 0.0137942, 0.0075674, 0},
                  {{1, 1, 10}, {0.05, 0.1, 100}, 0.132079, 0.228239, 0.128576, 10},
                  {{50, 1, 0}, {0.2, 0.01, 1e4}, 0.301340, 0.0116130, 0.0083651, 16}};
  SamGrid grid = NewGrid(128, 128, 2.3, 2.3);

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(*rows); k++) {
    Split s = NewSplit(grid, Body(rows[k].one), Body(rows[k].two));
    Found f;

    Divide(&s);
    f = Measure(&s);
    sam_assert(s.report.reason == SAM_HEAT_CONVERGED && s.report.residual <= 1e-8);
    sam_assert(s.report.products <= rows[k].products + 2);
    sam_assert_close(f.share, rows[k].share, 5e-6);
    sam_assert_close(f.most / rows[k].most, 1, 1e-5);
    sam_assert_close(f.mean / rows[k].mean, 1, 2e-5);
    sam_assert(f.jump < 1e-6 * f.most);
    DestroySplit(&s);
  }
  sam_call(SamGridDestroy(&grid));
}

static void test_bodies_at_rest_share_by_their_conductivities(void **state)
{
  SamGrid grid = NewGrid(37, 29, 2.3, 2.3);
  Split   s    = NewSplit(grid, (SamHeatBody){1, 1, 0}, (SamHeatBody){0.1, 7, 0});
  double *q, *heat;

  (void)state;
  s.pair.rtol = 1e-11;
  Divide(&s);
  q    = Whole(grid, 1, s.q[1]);
  heat = Whole(grid, 1, s.heat);
  for (PetscInt k = 0; k < grid->nx * grid->ny; k++) sam_assert_close(q[k], 0.1 / 1.1 * heat[k], 1e-9);
  free(q);
  free(heat);
  DestroySplit(&s);
  sam_call(SamGridDestroy(&grid));
}

/* Both bodies fast, without own heat: the temperature is the mean weighted by sqrt(conductivity capacity speed). */
static void test_a_cool_body_chills_the_other(void **state)
{
  SamGrid           grid = NewGrid(64, 64, 2.3, 2.3);
  const SamHeatBody one = {50, 3e6, -3}, two = {20, 2e6, -1};
  const double      b1 = sqrt(50 * 3e6 * 3.), b2 = sqrt(20 * 2e6 * 1.);
  Split             s = NewSplit(grid, one, two);
  double           *t, *contact;

  (void)state;
  sam_call(VecSet(s.heat, 0));
  s.bulk[0] = 20;
  s.bulk[1] = 150;
  Divide(&s);
  sam_assert(s.report.reason == SAM_HEAT_CONVERGED && s.report.products <= 24);
  sam_assert(Measure(&s).jump < 1e-4);
  t       = Whole(grid, 1, s.t[0]);
  contact = Whole(grid, 1, s.contact);
  for (PetscInt k = 0; k < grid->nx * grid->ny; k++)
    if (contact[k] > 0) sam_assert_close(t[k], (b1 * 20 + b2 * 150) / (b1 + b2), 0.05);
  free(t);
  free(contact);
  DestroySplit(&s);
  sam_call(SamGridDestroy(&grid));
}

/* Unlike bodies that move against each other; equal ones with a resistance, and with unlike bulk temperatures. */
static void test_temperatures_agree_up_to_the_resistance(void **state)
{
  static const SamHeatBody one = {1, 1, -8}, others[] = {{2, 1, 40}, {1, 1, -8}, {1, 1, -8}};
  static const double      resistance[] = {0, 0.7, 0}, bulk[] = {0.1, 0, 0.1};
  SamGrid                  grids[] = {NewGrid(48, 33, 2.3, 2.3), NewGrid(200, 1, 2.3, 1)};

  (void)state;
  for (int k = 0; k < 2; k++)
    for (int r = 0; r < 3; r++) {
      Split s = NewSplit(grids[k], one, others[r]);
      Found f;

      s.pair.resistance = resistance[r];
      s.bulk[1]         = bulk[r];
      Divide(&s);
      f = Measure(&s);
      sam_assert(s.report.reason == SAM_HEAT_CONVERGED && s.report.products <= 14);
      sam_assert(f.jump < 1e-6 * f.most);
      sam_assert(f.share > 0.05 && f.share < 0.9 && fabs(f.share - 0.5) > 0.01);
      DestroySplit(&s);
    }
  for (int k = 0; k < 2; k++) sam_call(SamGridDestroy(&grids[k]));
}

/* The same bits as on one rank. */
static void test_results_do_not_depend_on_ranks(void **state)
{
  SamGrid grids[] = {NewGrid(31, 23, 2.3, 2.3), NewGridOn(PETSC_COMM_SELF, 31, 23, 2.3, 2.3, 0, 0)};
  double *q[2], *t[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    Split s = NewSplit(grids[k], (SamHeatBody){1, 1, 0}, (SamHeatBody){2, 1, -8});

    Divide(&s);
    sam_assert(s.report.products > 5);
    q[k] = Whole(grids[k], 1, s.q[1]);
    t[k] = Whole(grids[k], 1, s.t[1]);
    DestroySplit(&s);
  }
  for (PetscInt i = 0; i < 31 * 23; i++) sam_assert(q[0][i] == q[1][i] && t[0][i] == t[1][i]);
  for (int k = 0; k < 2; k++) {
    free(q[k]);
    free(t[k]);
    sam_call(SamGridDestroy(&grids[k]));
  }
}

static void test_no_convergence_is_reported(void **state)
{
  SamGrid grid = NewGrid(33, 33, 2.3, 2.3);
  Split   s    = NewSplit(grid, (SamHeatBody){1, 1, 0}, (SamHeatBody){2, 1, -8});

  (void)state;
  s.pair.most = 4;
  Divide(&s);
  sam_assert(s.report.reason == SAM_HEAT_LIMIT && s.report.residual > 1e-8 && s.report.products <= 5);
  s.pair.most = 500;
  s.pair.rtol = 1e-25;
  Divide(&s);
  sam_assert(s.report.reason == SAM_HEAT_STAGNATES && s.report.residual < 1e-13 && s.report.products < 120);
  sam_call(VecSet(s.heat, 0));
  Divide(&s);
  sam_assert(s.report.reason == SAM_HEAT_CONVERGED && s.report.products == 0 && s.report.residual == 0);
  s.bulk[0] = NAN;
  Divide(&s);
  sam_assert(s.report.reason == SAM_HEAT_STAGNATES && !(s.report.residual <= s.pair.rtol));
  DestroySplit(&s);
  sam_call(SamGridDestroy(&grid));
}

#define sam_split_says(code, words) \
  sam_says(SamHeatSplit(&s.pair, s.contact, s.heat, s.bulk, s.q[1], &s.report), code, words)

static void test_wrong_pairs_are_refused(void **state)
{
  SamGrid grid = NewGrid(9, 7, 2.3, 2.3), other = NewGrid(8, 7, 2.3, 2.3);
  Split   s = NewSplit(grid, (SamHeatBody){1, 1, 0}, (SamHeatBody){2, 1, -8}), good = s;

  (void)state;
  s.pair.resistance = -1;
  sam_split_says(PETSC_ERR_ARG_OUTOFRANGE, "Resistance -1");
  s.pair.resistance = 0;
  s.pair.rtol       = 0;
  sam_split_says(PETSC_ERR_ARG_OUTOFRANGE, "Tolerance 0");
  s.pair         = good.pair;
  s.pair.body[1] = NewConductor(grid, (SamHeatBody){2, 1, -8}, 0.1);
  sam_split_says(PETSC_ERR_ARG_WRONG, "Operators of heat at the depths 0");
  sam_call(SamConductorDestroy(&s.pair.body[1]));
  s.pair.body[1] = NewConductor(other, (SamHeatBody){2, 1, -8}, 0);
  sam_split_says(PETSC_ERR_ARG_WRONG, "different grids");
  sam_call(SamConductorDestroy(&s.pair.body[1]));
  s.pair = good.pair;
  s.heat = NewRandom(grid, 1, 1);
  sam_split_says(PETSC_ERR_ARG_WRONG, "outside of contact");
  sam_destroy(&s.heat);
  DestroySplit(&good);
  sam_call(SamGridDestroy(&grid));
  sam_call(SamGridDestroy(&other));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_cells_have_reference_values),
    cmocka_unit_test(test_strips_have_reference_values),
    cmocka_unit_test(test_maximum_of_a_band),
    cmocka_unit_test(test_temperature_is_that_of_the_parts),
    cmocka_unit_test(test_directions_mirror_each_other),
    cmocka_unit_test(test_slow_bodies_approach_the_one_at_rest),
    cmocka_unit_test(test_long_cells_are_strips),
    cmocka_unit_test(test_fast_bodies_conduct_downwards_only),
    cmocka_unit_test(test_tables_are_rows),
    cmocka_unit_test(test_wrong_bodies_are_refused),
    cmocka_unit_test(test_products_are_sums_over_cells),
    cmocka_unit_test(test_centres_of_discs_are_of_second_order),
    cmocka_unit_test(test_shares_of_discs),
    cmocka_unit_test(test_bodies_at_rest_share_by_their_conductivities),
    cmocka_unit_test(test_a_cool_body_chills_the_other),
    cmocka_unit_test(test_temperatures_agree_up_to_the_resistance),
    cmocka_unit_test(test_results_do_not_depend_on_ranks),
    cmocka_unit_test(test_no_convergence_is_reported),
    cmocka_unit_test(test_wrong_pairs_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
  Connected zones of cells, against a flood fill of the whole grid by every rank, and against shapes of known width.
*/
#include "fields.h"
#include <petsam/private/grid.h>

/* Square, odd, thin; fewer rows than ranks; four rows, which leave the last of three ranks without one. */
static const PetscInt sizes[][2] = {{16, 16}, {23, 31}, {40, 2}, {7, 60}, {64, 50}, {5, 3}, {9, 4}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]), MOST = 64 * 64 };

static const int sides[][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/* A pattern of cells, the same on all ranks. */
typedef struct {
  PetscInt nx, ny;
  char     in[MOST];
} Pattern;

static void FieldOf(const Pattern *p, SamGrid *grid, Vec *field)
{
  double *a;

  *grid = NewGrid(p->nx, p->ny, 1, 1);
  sam_call(SamGridCreateVec(*grid, 1, field));
  sam_call(VecGetArray(*field, &a));
  for (PetscInt k = 0; k < (*grid)->cells; k++) a[k] = p->in[(*grid)->row_start * p->nx + k] ? 1e-3 : -1;
  sam_call(VecRestoreArray(*field, &a));
}

static void Measure(const Pattern *p, double part, PetscBool wrap, PetscInt *zones, PetscReal *across)
{
  SamGrid grid;
  Vec     field;

  FieldOf(p, &grid, &field);
  sam_call(SamGridCountZones(grid, field, wrap, zones));
  sam_call(SamGridMeasureZones(grid, field, part, wrap, across));
  sam_call(VecDestroy(&field));
  sam_call(SamGridDestroy(&grid));
}

/* Takes the zone of cell (i, j) out of a pattern; returns its cells. */
static PetscInt Fill(Pattern *p, PetscInt i, PetscInt j, PetscInt cells[][2])
{
  PetscInt count = 1;

  cells[0][0]          = i;
  cells[0][1]          = j;
  p->in[j * p->nx + i] = 0;
  for (PetscInt k = 0; k < count; k++)
    for (int d = 0; d < 4; d++) {
      const PetscInt a = cells[k][0] + sides[d][0], b = cells[k][1] + sides[d][1];

      if (a < 0 || a >= p->nx || b < 0 || b >= p->ny || !p->in[b * p->nx + a]) continue;
      p->in[b * p->nx + a] = 0;
      cells[count][0]      = a;
      cells[count++][1]    = b;
    }
  return count;
}

/*
  Its width: the least, over all directions, of the rms distance from the middle line, as of an ellipse; or its box. One
  that spans the grid along one axis only counts as no shorter along that than across it.
*/
static double WidthOf(const Pattern *p, PetscInt cells[][2], PetscInt count)
{
  double    mean[2] = {0, 0}, square[2] = {0, 0}, more[2], least = 1e300;
  PetscInt  low[2] = {MOST, MOST}, high[2] = {0, 0};
  PetscBool spans[2];

  for (PetscInt k = 0; k < count; k++)
    for (int d = 0; d < 2; d++) {
      mean[d] += (double)cells[k][d] / (double)count;
      low[d]  = PetscMin(low[d], cells[k][d]);
      high[d] = PetscMax(high[d], cells[k][d]);
    }
  for (PetscInt k = 0; k < count; k++)
    for (int d = 0; d < 2; d++) square[d] += pow((double)cells[k][d] - mean[d], 2) / (double)count;
  for (int d = 0; d < 2; d++) spans[d] = high[d] - low[d] + 1 == (d ? p->ny : p->nx);
  for (int d = 0; d < 2; d++) more[d] = spans[d] && !spans[!d] ? PetscMax(0, square[!d] - square[d]) : 0;
  for (int t = 0; t < 3600; t++) {
    const double angle = t * PETSC_PI / 3600;
    double       sum   = (double)count * (more[0] * pow(cos(angle), 2) + more[1] * pow(sin(angle), 2));

    for (PetscInt k = 0; k < count; k++) {
      const double x = ((double)cells[k][0] - mean[0]) * cos(angle) + ((double)cells[k][1] - mean[1]) * sin(angle);

      sum += x * x;
    }
    least = PetscMin(least, sum / (double)count);
  }
  for (int d = 0; d < 2; d++)
    if (spans[d] && !spans[!d]) high[d] = low[d] + MOST;
  return PetscMin(4 * sqrt(least + 1. / 12), (double)PetscMin(high[0] - low[0], high[1] - low[1]) + 1);
}

/* The answer by the definition: zones by width, the narrowest left out up to that part of all cells. */
static void Expect(const Pattern *pattern, double part, PetscInt *zones, double *across)
{
  static PetscInt cells[MOST][2];
  static double   width[MOST], size[MOST];
  Pattern         p   = *pattern;
  double          sum = 0, before;

  *zones = 0;
  for (PetscInt k = 0; k < p.nx * p.ny; k++) {
    PetscInt count;

    if (!p.in[k]) continue;
    count         = Fill(&p, k % p.nx, k / p.nx, cells);
    width[*zones] = WidthOf(pattern, cells, count);
    size[*zones]  = (double)count;
    sum += size[(*zones)++];
  }
  *across = *zones ? 1e300 : 0;
  for (PetscInt z = 0; z < *zones; z++) {
    before = 0; /* cells in zones as narrow, or narrower */
    for (PetscInt y = 0; y < *zones; y++)
      before += floor(10 * width[y] + .5) <= floor(10 * width[z] + .5) ? size[y] : 0;
    if (before > part * sum) *across = PetscMin(*across, width[z]);
  }
}

static void AssertRight(const Pattern *p, double part)
{
  PetscInt  zones, expected;
  PetscReal across;
  double    width;

  Measure(p, part, PETSC_FALSE, &zones, &across);
  Expect(p, part, &expected, &width);
  sam_assert(zones == expected);
  sam_assert_close(across, width, 0.0501); /* a tenth of a cell */
}

/* A share of 16 of the cells of a size, chosen at random. */
static void Scatter(Pattern *p, const PetscInt size[2], int share, uint64_t *seed)
{
  p->nx = size[0];
  p->ny = size[1];
  for (PetscInt k = 0; k < p->nx * p->ny; k++) {
    *seed    = *seed * UINT64_C(6364136223846793005) + 1442695040888963407;
    p->in[k] = (int)(*seed >> 60) < share;
  }
}

static void test_random_cells_give_the_zones_of_a_flood_fill(void **state)
{
  static Pattern p;
  uint64_t       seed = 1;

  (void)state;
  for (int s = 0; s < NUM_SIZES; s++)
    for (int share = 1; share < 10; share += 2)
      for (int part = 0; part < 2; part++) {
        Scatter(&p, sizes[s], share, &seed);
        AssertRight(&p, 0.1 * part);
      }
}

/* The zones by the definition: each cell takes the least number of its neighbours, until none changes. */
static PetscInt CountBySides(const Pattern *p, PetscBool wrap)
{
  static PetscInt at[MOST];
  const PetscInt  n     = p->nx * p->ny;
  PetscInt        zones = 0;
  PetscBool       changes;

  for (PetscInt k = 0; k < n; k++) at[k] = k;
  do {
    changes = PETSC_FALSE;
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < 4; d++) {
        const PetscInt i = k % p->nx + sides[d][0], j = k / p->nx + sides[d][1];
        const PetscInt other = (j + p->ny) % p->ny * p->nx + (i + p->nx) % p->nx;

        if (!p->in[k] || !p->in[other]) continue;
        if (!wrap && (i < 0 || i >= p->nx || j < 0 || j >= p->ny)) continue;
        if (at[other] < at[k]) changes = PETSC_TRUE;
        at[k] = PetscMin(at[k], at[other]);
      }
  } while (changes);
  for (PetscInt k = 0; k < n; k++) zones += p->in[k] && at[k] == k;
  return zones;
}

static void test_zones_by_sides_are_those_of_neighbours_also_over_the_borders(void **state)
{
  static Pattern p;
  uint64_t       seed = 7;

  (void)state;
  for (int s = 0; s < NUM_SIZES; s++)
    for (int share = 3; share < 14; share += 2)
      for (int wrap = 0; wrap < 2; wrap++) {
        PetscInt zones;
        SamGrid  grid;
        Vec      field;

        Scatter(&p, sizes[s], share, &seed);
        FieldOf(&p, &grid, &field);
        sam_call(SamGridCountZones(grid, field, (PetscBool)wrap, &zones));
        sam_assert(zones == CountBySides(&p, (PetscBool)wrap));
        sam_call(VecDestroy(&field));
        sam_call(SamGridDestroy(&grid));
      }
}

/* Arms that only the last row joins; rings within rings; a spiral, which the rows meet again and again. */
static void test_zones_that_meet_late_are_one(void **state)
{
  static Pattern p;

  (void)state;
  p.nx = 33;
  p.ny = 30;
  for (PetscInt k = 0; k < p.nx * p.ny; k++) p.in[k] = (k % p.nx) % 2 == 0 || k / p.nx == 29;
  AssertRight(&p, 0);
  for (PetscInt k = 0; k < p.nx * p.ny; k++)
    p.in[k] = PetscMax(PetscAbs((int)(k % p.nx) - 16), PetscAbs((int)(k / p.nx) - 15)) % 3 == 0;
  AssertRight(&p, 0);
  for (PetscInt k = 0; k < p.nx * p.ny; k++) {
    const double x = (double)(k % p.nx) - 16, y = (double)(k / p.nx) - 15;

    p.in[k] = fmod(hypot(x, y) - 4 * atan2(y, x) / (2 * PETSC_PI) + 40, 4) < 1.5;
  }
  AssertRight(&p, 0);
}

/* A disc, and a strip that lies across the axes, whose bounding box says nothing. */
static void test_widths_are_those_of_the_shapes(void **state)
{
  static Pattern p;
  PetscInt       zones;
  PetscReal      across;

  (void)state;
  p.nx = p.ny = 64;
  for (PetscInt k = 0; k < 64 * 64; k++) p.in[k] = hypot((double)(k % 64) - 31.5, (double)(k / 64) - 30.2) < 12.5;
  Measure(&p, 0, PETSC_FALSE, &zones, &across);
  sam_assert(zones == 1);
  sam_assert_close(across, 25, 1.01); /* the box counts whole cells */
  for (PetscInt k = 0; k < 64 * 64; k++)
    p.in[k] = fabs((double)(k % 64) - (double)(k / 64)) < 5 * sqrt(2.) && k % 64 + k / 64 > 20 && k % 64 + k / 64 < 106;
  Measure(&p, 0, PETSC_FALSE, &zones, &across);
  sam_assert(zones == 1);
  sam_assert_close(across, 15 / sqrt(2.) * 4 / sqrt(12.), 0.2); /* the ellipse of a strip is a little wider */
}

/* A strip from border to border is as wide as it is, however short its grid is. */
static void test_strips_have_no_width_along_their_length(void **state)
{
  static Pattern p;
  PetscInt       zones;
  PetscReal      across;

  (void)state;
  for (int along = 0; along < 2; along++) {
    p.nx = along ? 40 : 6;
    p.ny = along ? 6 : 40;
    for (PetscInt k = 0; k < 240; k++) {
      const PetscInt n = along ? k % p.nx : k / p.nx;

      p.in[k] = n >= 11 && n < 26;
    }
    Measure(&p, 0, PETSC_FALSE, &zones, &across);
    sam_assert(zones == 1);
    sam_assert_close(across, 15, 1e-12);
  }
}

static void test_small_zones_do_not_count_up_to_their_part(void **state)
{
  static Pattern p;
  PetscInt       zones;
  PetscReal      across;

  (void)state;
  p.nx = p.ny = 64;
  memset(p.in, 0, sizeof(p.in));
  Measure(&p, 0.1, PETSC_FALSE, &zones, &across);
  sam_assert(zones == 0 && across == 0);
  for (PetscInt k = 0; k < 64 * 64; k++) p.in[k] = k % 64 >= 20 && k % 64 < 50 && k / 64 >= 20 && k / 64 < 50;
  for (PetscInt k = 0; k < 30; k++) p.in[2 * k] = p.in[63 * 64 + 2 * k] = 1; /* 60 of 960 cells */
  Measure(&p, 0.1, PETSC_FALSE, &zones, &across);
  sam_assert(zones == 61);
  sam_assert_close(across, 30, 0.06);
  Measure(&p, 0.05, PETSC_FALSE, &zones, &across);
  sam_assert_close(across, 1, 0.06);
}

/* Wherever the border of the grid cuts the zones, they are those in its middle: two ellipses, and a strip. */
static void test_zones_over_the_borders_are_as_wide_as_in_the_middle(void **state)
{
  static const PetscInt by[][2] = {{0, 0}, {9, 0}, {0, 20}, {13, 17}, {30, 31}};
  static Pattern        p, moved;
  PetscInt              zones;
  PetscReal             across, middle = 0;

  (void)state;
  for (int strip = 0; strip < 2; strip++) {
    moved.nx = p.nx = 44;
    moved.ny = p.ny = 37;
    for (PetscInt k = 0; k < p.nx * p.ny; k++) {
      const double x = (double)(k % p.nx) - 20, y = (double)(k / p.nx) - 16;

      p.in[k] = strip ? fabs(x) < 5.2 : hypot(x + 0.6 * y, 2 * y) < 13 || hypot(x - 14, 0.7 * (y - 11)) < 4;
    }
    for (int n = 0; n < 5; n++) {
      for (PetscInt k = 0; k < p.nx * p.ny; k++)
        moved.in[(k % p.nx + by[n][0]) % p.nx + (k / p.nx + by[n][1]) % p.ny * p.nx] = p.in[k];
      Measure(&moved, 0.3, PETSC_TRUE, &zones, &across);
      if (n == 0) {
        Measure(&moved, 0.3, PETSC_FALSE, &zones, &middle);
        sam_assert(middle > 10);
      }
      sam_assert(zones == 2 - strip);
      sam_assert_close(across, middle, 1e-12);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_random_cells_give_the_zones_of_a_flood_fill),
    cmocka_unit_test(test_zones_by_sides_are_those_of_neighbours_also_over_the_borders),
    cmocka_unit_test(test_zones_that_meet_late_are_one),
    cmocka_unit_test(test_widths_are_those_of_the_shapes),
    cmocka_unit_test(test_strips_have_no_width_along_their_length),
    cmocka_unit_test(test_small_zones_do_not_count_up_to_their_part),
    cmocka_unit_test(test_zones_over_the_borders_are_as_wide_as_in_the_middle),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

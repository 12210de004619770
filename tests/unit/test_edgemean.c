/* Means of a motion over the open cells beside a contact, against sums over all of them. */
#include "fields.h"
#include "../../src/contact/step/edgemean.h"

#define DEVIATION 2.5 /* of the least Gaussian, in cells */
#define LONGER    1.25

enum { MOST = 60 * 60 };

/* Points in random cells, the same on all ranks, by rows */
typedef struct {
  PetscInt nx, ny, count;
  double   point[MOST][SAM_EDGE_POINT];
} Points;

static void Scatter(Points *p, PetscInt nx, PetscInt ny, double part, double radial)
{
  *p = (Points){.nx = nx, .ny = ny};
  for (PetscInt j = 0; j < ny; j++)
    for (PetscInt i = 0; i < nx; i++) {
      double *const point = p->point[p->count];

      if (Random(1, 0, i, j) > 2 * part - 1) continue;
      p->count++;
      point[SAM_EDGE_COLUMN]    = (double)i;
      point[SAM_EDGE_ROW]       = (double)j;
      point[SAM_EDGE_WEIGHT]    = 1.5 + Random(2, 0, i, j);
      point[SAM_EDGE_MOVED]     = 3 + radial * Random(3, 0, i, j);
      point[SAM_EDGE_MOVED + 1] = -2 + radial * Random(3, 1, i, j);
    }
}

/* The mean about cell (i, j), with all images of the points in the periods around. */
static void SumAll(const Points *p, PetscBool wraps, PetscInt i, PetscInt j, double mean[2])
{
  const PetscInt more    = wraps ? 1 : 0;
  double         nearest = INFINITY, sum[4] = {0, 0, 0, 0}, size;

  for (int pass = 0; pass < 2; pass++)
    for (PetscInt a = -more; a <= more; a++)
      for (PetscInt b = -more; b <= more; b++)
        for (PetscInt k = 0; k < p->count; k++) {
          const double *point = p->point[k], *moved = point + SAM_EDGE_MOVED;
          const double  x  = point[SAM_EDGE_COLUMN] + (double)(a * p->nx - i),
                       y   = point[SAM_EDGE_ROW] + (double)(b * p->ny - j);
          const double far = x * x + y * y,
                       w   = point[SAM_EDGE_WEIGHT] * exp((nearest - far) / (2 * DEVIATION * DEVIATION));

          if (pass == 0) nearest = PetscMin(nearest, far);
          if (pass == 0) continue;
          sum[0] += w;
          for (int c = 0; c < 2; c++) sum[1 + c] += w * moved[c];
          sum[3] += w * hypot(moved[0], moved[1]);
        }
  size = hypot(sum[1], sum[2]);
  for (int c = 0; c < 2; c++) mean[c] = PetscMin(sum[3] / size, LONGER) * sum[1 + c] / sum[0];
}

/* The largest difference of the means of all cells from those sums; `deviation`: that of the Gaussian, or 0. */
static double Compare(const Points *p, PetscBool wraps, PetscInt pressed, double *deviation)
{
  const SamGrid grid = NewGrid(p->nx, p->ny, 1, 1);
  double       *pressure, worst = 0, mean[2], right[2];
  PetscInt      first = 0, count = 0;
  SamEdgeMean   edge;

  sam_call(PetscCalloc1(grid->cells, &pressure));
  for (PetscInt k = 0; k < grid->cells; k++) pressure[k] = grid->row_start * p->nx + k < pressed ? 1 : 0;
  while (first < p->count && p->point[first][SAM_EDGE_ROW] < (double)grid->row_start) first++;
  while (first + count < p->count && p->point[first + count][SAM_EDGE_ROW] < (double)(grid->row_start + grid->rows))
    count++;
  sam_call(SamEdgeMeanCreate(grid, wraps, pressure, count, p->point[first], deviation, &edge));
  for (PetscInt j = grid->row_start; j < grid->row_start + grid->rows; j++) {
    SamEdgeMeanSetRow(edge, j);
    for (PetscInt i = 0; i < p->nx; i++) {
      SamEdgeMeanAt(edge, i, mean);
      SumAll(p, wraps, i, j, right);
      worst = PetscMax(worst, PetscMax(fabs(mean[0] - right[0]), fabs(mean[1] - right[1])));
    }
  }
  sam_call(SamEdgeMeanDestroy(&edge));
  sam_call(PetscFree(pressure));
  sam_call(SamGridDestroy((SamGrid *)&grid));
  sam_call(SamMax(PETSC_COMM_WORLD, 1, &worst));
  return worst;
}

static void test_means_are_those_of_all_points(void **state)
{
  static const PetscInt sizes[][2] = {{37, 41}, {50, 12}, {60, 60}};
  static Points         p;

  (void)state;
  for (size_t k = 0; k < sizeof(sizes) / sizeof(sizes[0]); k++)
    for (int wraps = 0; wraps < 2; wraps++) {
      double deviation = 0;

      Scatter(&p, sizes[k][0], sizes[k][1], 0.1, 2);
      sam_assert(Compare(&p, wraps ? PETSC_TRUE : PETSC_FALSE, 4, &deviation) < 1e-4);
      sam_assert(deviation == DEVIATION);
    }
}

/*
  Wide contacts have a wide Gaussian, whose means are interpolated; a motion that is the same everywhere remains. Little
  edge does not make a contact wider than the root of its area.
*/
static void test_the_deviation_follows_from_the_width(void **state)
{
  static Points       p;
  static const double parts[] = {0.016, 0.005};

  (void)state;
  for (int k = 0; k < 2; k++) {
    double deviation = 0, weights = 0, width;

    Scatter(&p, 200, 200, parts[k], 0);
    for (PetscInt n = 0; n < p.count; n++) weights += p.point[n][SAM_EDGE_WEIGHT];
    width = k ? 200 : 4.0 * 200 * 200 / weights;
    sam_assert(Compare(&p, PETSC_FALSE, 200 * 200, &deviation) < 1e-12);
    sam_assert_close(deviation, width / 16, 1e-12 * deviation);
    sam_assert(deviation > 10); /* every second row and column */
  }
}

static void test_without_points_nothing_moves(void **state)
{
  const SamGrid grid         = NewGrid(6, 5, 1, 1);
  double        pressure[30] = {0}, mean[2], deviation = 0, most = 0;
  SamEdgeMean   edge;

  (void)state;
  sam_call(SamEdgeMeanCreate(grid, PETSC_TRUE, pressure, 0, NULL, &deviation, &edge));
  for (PetscInt j = grid->row_start; j < grid->row_start + grid->rows; j++) {
    SamEdgeMeanSetRow(edge, j);
    SamEdgeMeanAt(edge, 3, mean);
    most = PetscMax(most, PetscMax(fabs(mean[0]), fabs(mean[1])));
  }
  sam_assert(most == 0);
  sam_call(SamEdgeMeanDestroy(&edge));
  sam_call(SamGridDestroy((SamGrid *)&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_means_are_those_of_all_points),
    cmocka_unit_test(test_the_deviation_follows_from_the_width),
    cmocka_unit_test(test_without_points_nothing_moves),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

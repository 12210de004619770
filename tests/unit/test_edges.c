/* Edges of contact and stick to a fraction of a cell: closed solutions, order, and what is refused. */
#include "contacts.h"

#include <petsam/private/edges.h>

#define PLAIN NewPair(210e9, 0, 210e9, 0)

static Vec NewSquare(const Case *c, Vec field)
{
  Vec w = NewField(c->s.grid, 1);

  sam_call(VecPointwiseMult(w, field, field));
  return w;
}

/* The edge without its points. */
static SamEdge Reconstruct(SamGrid grid, Vec w, Vec point)
{
  SamEdge edge;

  sam_call(SamEdgeReconstruct(grid, PETSC_FALSE, w, &edge));
  if (point) {
    sam_call(VecCopy(w, point));
    sam_call(SamEdgeCorrect(&edge, point));
  }
  sam_call(SamEdgeDestroy(&edge));
  return edge;
}

/* ---- closed solutions ---- */

static const double places[][2] = {{0, 0}, {0.3, 0.1}, {0.41, 0.73}};

static void test_edge_of_hertz_is_found_to_a_fraction_of_a_cell(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    const double x = places[k][0], y = places[k][1];
    Case         c = NewBeside(Steel(), 96, 1.5, x, y, 0, "");
    Vec          w = NewSquare(&c, SolutionOf(&c)->pressure), point = NewField(c.s.grid, 1);
    double       errors[2];
    SamEdge      edge;

    edge = Reconstruct(c.s.grid, w, point);
    HertzErrors(&c, point, x, y, errors);
    if (getenv("SAM_SHOW"))
      print_message("# %g of the raw error, area %g\n", errors[1] / errors[0], edge.area / (PETSC_PI * 1e-6) - 1);
    sam_assert(edge.faces > 0 && edge.good == edge.faces);
    sam_assert_close(edge.area / (PETSC_PI * 1e-6), 1, 2e-4);
    sam_assert(errors[1] < errors[0] / 6);
    sam_destroy(&w, &point);
    DestroyCase(&c);
  }
}

/* Areas: counted cells are wrong by the cell, reconstructed ones by its square. */
static void test_area_is_of_second_order(void **state)
{
  double errors[2] = {0, 0};

  (void)state;
  for (int fine = 0; fine < 2; fine++)
    for (int k = 0; k < 3; k++) {
      Case    c = NewBeside(Steel(), fine ? 160 : 40, 1.5, places[k][0], places[k][1], 0, "");
      Vec     w = NewSquare(&c, SolutionOf(&c)->pressure);
      SamEdge edge;

      edge         = Reconstruct(c.s.grid, w, NULL);
      errors[fine] = fmax(errors[fine], fabs(edge.area / (PETSC_PI * 1e-6) - 1));
      sam_call(VecDestroy(&w));
      DestroyCase(&c);
    }
  if (getenv("SAM_SHOW")) print_message("# %g %g\n", errors[0], errors[1]);
  sam_assert(errors[1] < errors[0] / 8); /* four times as many cells in a direction */
}

/* Half widths: within 1/70 of a cell on any grid, 1/14 where a cell is rejected; by whole
   cells they are wrong by up to a half. */
static void test_half_widths_are_found_to_a_fraction_of_a_cell(void **state)
{
  static const char *const names[4] = {"contact_half_x", "contact_half_y", "stick_half_x", "stick_half_y"};
  static const PetscInt    cells[2] = {37, 149};
  double                   counted  = 0;

  (void)state;
  for (int fine = 0; fine < 2; fine++)
    for (int k = 0; k < 3; k++) {
      Case         c        = NewBeside(PLAIN, cells[fine], 1.5, places[k][0], places[k][1], 0.6, "");
      const double exact[2] = {1e-3, 1e-3 * cbrt(0.4)}, cell = c.s.grid->dx;
      const double part = NumberOf(&c, "edge_accepted") < 1 ? 14 : 70;
      PetscInt     first[2], n[2];

      sam_call(SamGridGetSupport(c.s.grid, SolutionOf(&c)->pressure, PETSC_FALSE, first, n));
      for (int i = 0; i < 2; i++) counted = fmax(counted, fabs(0.5 * (double)n[i] * cell - exact[0]) / cell);
      for (int i = 0; i < 4; i++) sam_assert_close(NumberOf(&c, names[i]), exact[i / 2], cell / part);
      DestroyCase(&c);
    }
  sam_assert(counted > 0.3);
}

/* Cells that are rejected count as whole ones, unless the edge beside them is known. */
static void test_half_widths_of_counted_cells(void **state)
{
  SamGrid grid = NewGridOn(PETSC_COMM_WORLD, 64, 41, 64, 41, 0, 0);
  Vec     w    = NewField(grid, 1);
  SamEdge edge[2];
  double *array;

  (void)state;
  for (int bump = 0; bump < 2; bump++) {
    sam_call(VecGetArray(w, &array));
    for (PetscInt c = 0; c < grid->cells; c++) {
      const double x = SamGridX(grid, c % 64), y = SamGridY(grid, grid->row_start + c / 64), r = hypot(x, y) / 15.3;

      array[c] = fmax(0, 1 - r * r);
      if (bump && x == 25.5 && y == 0) array[c] = 1;
    }
    sam_call(VecRestoreArray(w, &array));
    sam_call(SamEdgeReconstruct(grid, PETSC_FALSE, w, &edge[bump]));
    sam_call(SamEdgeDestroy(&edge[bump]));
  }
  sam_assert_close(edge[0].half[0], 15.3, 0.05);
  sam_assert(edge[1].half[1] == edge[0].half[1]);
  sam_assert_close(edge[1].half[0], (edge[0].half[0] + 26 - SAM_EDGE_FACE) / 2, 1e-12);
  sam_call(VecDestroy(&w));
  sam_call(SamGridDestroy(&grid));
}

/* At the tips of slender zones no cell is accepted; the function of the last one tells where they end. */
static void test_half_widths_of_slender_zones(void **state)
{
  static const double half[][2] = {{5.3, 24.4}, {6.7, 25.1}, {6.2, 28.8}};
  SamGrid             grid      = NewGridOn(PETSC_COMM_WORLD, 64, 25, 64, 25, 0, 0);
  Vec                 w         = NewField(grid, 1);

  (void)state;
  for (int k = 0; k < 3; k++) {
    SamEdge edge;
    double *array;

    sam_call(VecGetArray(w, &array));
    for (PetscInt c = 0; c < grid->cells; c++) {
      const double x = SamGridX(grid, c % 64) / half[k][1], y = SamGridY(grid, grid->row_start + c / 64) / half[k][0];

      array[c] = fmax(0, 1 - x * x - y * y);
    }
    sam_call(VecRestoreArray(w, &array));
    sam_call(SamEdgeReconstruct(grid, PETSC_FALSE, w, &edge));
    sam_assert(edge.good < edge.faces);
    sam_assert_close(edge.half[0], half[k][1], 0.2);
    sam_assert_close(edge.half[1], half[k][0], 0.1);
    sam_call(SamEdgeDestroy(&edge));
  }
  sam_call(VecDestroy(&w));
  sam_call(SamGridDestroy(&grid));
}

/* A disc and an ellipse over the border of a period have the half widths of those in its middle. */
static void test_half_widths_of_periodic_zones(void **state)
{
  static const double at[][2] = {{0, 0}, {20, 0}, {-20, 15}, {13, -15}};
  PetscReal           half[4][2];

  (void)state;
  for (int k = 0; k < 4; k++) {
    SamGrid grid = NewGridOn(PETSC_COMM_WORLD, 41, 31, 41, 31, 0, 0);
    Vec     w    = NewField(grid, 1);
    SamEdge edge;
    double *array;

    sam_call(VecGetArray(w, &array));
    for (PetscInt c = 0; c < grid->cells; c++) {
      const double x = remainder(SamGridX(grid, c % 41) - at[k][0], 41) / 16.3,
                   y = remainder(SamGridY(grid, grid->row_start + c / 41) - at[k][1], 31) / 11.8;

      array[c] = fmax(0, 1 - x * x - y * y);
    }
    sam_call(VecRestoreArray(w, &array));
    sam_call(SamEdgeReconstruct(grid, PETSC_TRUE, w, &edge));
    for (int i = 0; i < 2; i++) half[k][i] = edge.half[i];
    sam_call(SamEdgeDestroy(&edge));
    sam_call(VecDestroy(&w));
    sam_call(SamGridDestroy(&grid));
  }
  sam_assert_close(half[0][0], 16.3, 0.05);
  sam_assert_close(half[0][1], 11.8, 0.05);
  for (int k = 1; k < 4; k++)
    for (int i = 0; i < 2; i++) sam_assert_close(half[k][i], half[0][i], 1e-10 * half[0][i]);
}

/* Cattaneo: the slack mu p - |q| vanishes like a root at the edge of stick, whose radius is (1 - T/mu N)^(1/3). */
static void test_edge_of_stick_is_cattaneos(void **state)
{
  const double exact = PETSC_PI * 1e-6 * pow(0.4, 2.0 / 3);

  (void)state;
  for (int k = 0; k < 2; k++) {
    Case          c = NewBeside(PLAIN, 96, 1.5, places[k][0], places[k][1], 0.6, "");
    const double *b, *q;
    double       *slack;
    Vec           w = NewField(c.s.grid, 1);
    SamEdge       edge;

    sam_call(VecGetArrayRead(SolutionOf(&c)->bound, &b));
    sam_call(VecGetArrayRead(SolutionOf(&c)->shear, &q));
    sam_call(VecGetArray(w, &slack));
    for (PetscInt i = 0; i < c.s.grid->cells; i++) {
      const double left = b[i] - hypot(q[i], q[i + c.s.grid->cells]);

      slack[i] = left > SAM_SLIP_MARGIN * b[i] ? left * left : 0;
    }
    sam_call(VecRestoreArray(w, &slack));
    sam_call(VecRestoreArrayRead(SolutionOf(&c)->shear, &q));
    sam_call(VecRestoreArrayRead(SolutionOf(&c)->bound, &b));
    edge = Reconstruct(c.s.grid, w, NULL);
    if (getenv("SAM_SHOW")) print_message("# stick %g accepted %g\n", edge.area / exact - 1, edge.good / edge.faces);
    sam_assert(edge.faces > 0 && edge.good == edge.faces);
    sam_assert_close(edge.area / exact, 1, 1e-3);
    sam_call(VecDestroy(&w));
    DestroyCase(&c);
  }
}

/* The areas of a step are those of its edges where that is asked for, and cells else. */
static void test_step_has_the_areas_of_its_edges(void **state)
{
  const double exact = PETSC_PI * 1e-6;
  double       peak  = 0;
  struct {
    double contact_area, stick_area, contact_cells, stick_cells, edge_accepted, shear_max, pressure_max;
  } steps[2];

  (void)state;
  for (int edges = 0; edges < 2; edges++) {
    Case             c       = NewCase(PLAIN, 90, 1.5, MU, edges ? "" : "-edges none");
    const SamControl control = Loads(&c, 1, 0.6, 0, 0);
    const double     cell    = c.s.grid->dx * c.s.grid->dy;

    (void)Try(&c, &control);
    steps[edges].contact_area  = NumberOf(&c, "contact_area");
    steps[edges].stick_area    = NumberOf(&c, "stick_area");
    steps[edges].contact_cells = NumberOf(&c, "contact_cells");
    steps[edges].stick_cells   = NumberOf(&c, "stick_cells");
    steps[edges].edge_accepted = NumberOf(&c, "edge_accepted");
    steps[edges].shear_max     = NumberOf(&c, "shear_max");
    steps[edges].pressure_max  = NumberOf(&c, "pressure_max");
    peak                       = c.s.p0;
    if (!edges) sam_assert_close(steps[0].contact_area, steps[0].contact_cells * cell, 1e-12 * exact);
    if (!edges) sam_assert_close(steps[0].stick_area, steps[0].stick_cells * cell, 1e-12 * exact);
    DestroyCase(&c);
  }
  sam_assert(steps[0].edge_accepted == 0 && steps[1].edge_accepted == 1);
  sam_assert(steps[0].contact_cells == steps[1].contact_cells && steps[0].stick_cells == steps[1].stick_cells);
  sam_assert_close(steps[1].contact_area / exact, 1, 3e-4);
  sam_assert_close(steps[1].stick_area / exact / pow(0.4, 2.0 / 3), 1, 1e-3);
  /* the peak of the shear is mu p at the stick radius; a cell's mean is less */
  peak = MU * peak * sqrt(1 - pow(0.4, 2.0 / 3));
  sam_assert_close(steps[1].shear_max / peak, 1, 3e-4);
  sam_assert(steps[0].shear_max < (1 - 1e-3) * peak && steps[0].pressure_max == steps[1].pressure_max);
}

/* Without shear, and where the slip is thinner than the cells, the largest shear is that of the cells. */
static void test_peak_is_not_sought_where_slip_is_not_resolved(void **state)
{
  (void)state;
  for (int pushed = 0; pushed < 2; pushed++) {
    Case             c       = NewCase(PLAIN, 60, 1.5, MU, "");
    const SamControl control = Loads(&c, 1, pushed ? 1e-3 : 0, 0, 0);
    /* in full stick, q = T/(2 pi a sqrt(a^2 - r^2)), cut off by mu p: less than mu p a tenth of a cell from the edge */
    const double most = pushed ? MU * c.s.p0 * 0.1 : 0;

    (void)Try(&c, &control);
    sam_assert(NumberOf(&c, "shear_max") <= most);
    DestroyCase(&c);
  }
}

/* mu p at the stick radius, of zones of a tenth to three quarters of a cell, beside the contact's edge. With the mean
   pressure of the cell at the edge it was up to 1.2 times that at 0.03. */
static void test_peak_of_a_thin_slip_zone_is_that_of_mindlin(void **state)
{
  static const double loads[] = {0.02, 0.03, 0.06, 0.08, 0.1, 0.12};

  (void)state;
  for (PetscInt n = 60; n <= 72; n += 12)
    for (int k = 0; k < 6; k++) {
      Case             c       = NewCase(PLAIN, n, 1.5, MU, "");
      const SamControl control = Loads(&c, 1, loads[k], 0, 0);
      const double     peak    = MU * c.s.p0 * sqrt(1 - pow(1 - loads[k], 2.0 / 3));

      (void)Try(&c, &control);
      sam_assert_close(NumberOf(&c, "shear_max") / peak, 1, loads[k] < 0.05 ? 0.08 : 0.04);
      DestroyCase(&c);
    }
}

/* One point in each cell that the edge crosses, on the circle, to a part of a cell; together they go round it. */
static void test_points_lie_on_the_edge(void **state)
{
  Case    c       = NewBeside(Steel(), 96, 1.5, 0.3, 0.1, 0, "");
  Vec     w       = NewSquare(&c, SolutionOf(&c)->pressure);
  double  sums[4] = {0, 0, 0, 0}, most = 0;
  SamEdge edge;

  (void)state;
  sam_call(SamEdgeReconstruct(c.s.grid, PETSC_FALSE, w, &edge));
  for (PetscInt k = 0; k < edge.count; k++) {
    const double x = edge.x[k] - 0.3 * c.s.grid->dx, y = edge.y[k] - 0.1 * c.s.grid->dy;

    most = fmax(most, fabs(hypot(x, y) - c.s.a) / c.s.grid->dx);
    sums[0] += 1;
    sums[1] += x;
    sums[2] += y;
  }
  (void)MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  (void)MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  sam_assert(most < 0.05);
  sam_assert(sums[0] > 0.8 * 2 * PETSC_PI * 32 && sums[0] < 1.3 * 2 * PETSC_PI * 32);
  sam_assert(hypot(sums[1], sums[2]) < 0.03 * sums[0] * c.s.a);
  sam_call(SamEdgeDestroy(&edge));
  sam_call(VecDestroy(&w));
  DestroyCase(&c);
}

/* ---- given fields ---- */

/* An ellipse turned on the grid: w is exact here, and so is what is behind the band. */
static double Ellipse(double x, double y, const void *context)
{
  const double turn = *(const double *)context, u = cos(turn) * x + sin(turn) * y, v = cos(turn) * y - sin(turn) * x;
  const double w = 1 - u * u - 4 * v * v;

  return w > 0 ? w : 0;
}

static void test_area_of_an_ellipse_of_exact_values(void **state)
{
  const double turn  = 0.4;
  SamGrid      grid  = NewGrid(61, 47, 2.3, 2.1);
  Vec          w     = NewFrom(grid, Ellipse, &turn);
  const double shift = 0.0105 * 2.3 / 61;
  SamEdge      edge;

  (void)state;
  edge = Reconstruct(grid, w, NULL);
  /* the mean shift of discrete solutions is taken off here too: of the perimeter, 4.844 */
  sam_assert_close(edge.area, PETSC_PI / 2 - 4.844 * shift, 2e-3 * PETSC_PI / 2);
  sam_call(VecDestroy(&w));
  sam_call(SamGridDestroy(&grid));
}

static double Disc(double x, double y, const void *context)
{
  (void)context;
  return fmax(1 - x * x - y * y, 0);
}

/* What lies in the cells at the edge must be the layer of a smooth edge: neither too little nor too much of it. */
static void test_another_layer_at_the_edge_is_refused(void **state)
{
  SamGrid      grid = NewGrid(60, 60, 2.6, 2.6);
  const double part = 2 * 2.6 / 60; /* slope of a cell at the edge */

  (void)state;
  for (int k = -1; k <= 1; k++) {
    Vec     w = NewFrom(grid, Disc, NULL);
    double *values, *whole = Whole(grid, 1, w);
    SamEdge edge;

    sam_call(VecGetArray(w, &values));
    for (PetscInt n = 0; n < grid->cells; n++) {
      const PetscInt m = n + grid->row_start * 60;
      const int      at_edge =
        whole[m] > 0 && !(whole[m - 1] > 0 && whole[m + 1] > 0 && whole[m - 60] > 0 && whole[m + 60] > 0);

      if (at_edge) values[n] += 0.3 * part * k * (k > 0 || values[n] > 0.4 * part);
    }
    sam_call(VecRestoreArray(w, &values));
    free(whole);
    edge = Reconstruct(grid, w, NULL);
    if (getenv("SAM_SHOW")) print_message("# layer %d: %g of %g\n", k, (double)edge.good, (double)edge.faces);
    sam_assert(k ? edge.good < 0.3 * edge.faces : edge.good == edge.faces);
    sam_call(VecDestroy(&w));
  }
  sam_call(SamGridDestroy(&grid));
}

/* Makes w small in cells of the zone that have a face outside: it seems to vanish at the edge. */
static void SharpenEdges(SamGrid grid, Vec w)
{
  double *values, *whole = Whole(grid, 1, w);

  sam_call(VecGetArray(w, &values));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt n = k + grid->row_start * grid->nx, i = n % grid->nx, j = n / grid->nx;

    if ((i > 0 && !(whole[n - 1] > 0)) || (i + 1 < grid->nx && !(whole[n + 1] > 0)) ||
        (j > 0 && !(whole[n - grid->nx] > 0)) || (j + 1 < grid->ny && !(whole[n + grid->nx] > 0)))
      values[k] *= 0.01;
  }
  sam_call(VecRestoreArray(w, &values));
  free(whole);
}

/* Random spots are no smooth edge: all is counted, less a part of a cell a face. */
static void test_rough_zone_is_counted(void **state)
{
  SamGrid  grid = NewGrid(45, 38, 45, 38);
  Vec      w = NewRandom(grid, 1, 3), point = NewField(grid, 1);
  double  *values, *whole;
  double   faces = 0, cells = 0;
  PetscInt same;
  SamEdge  edge;

  (void)state;
  sam_call(VecGetArray(w, &values));
  for (PetscInt k = 0; k < grid->cells; k++) values[k] = values[k] > -0.4 ? values[k] + 0.5 : 0;
  sam_call(VecRestoreArray(w, &values));
  SharpenEdges(grid, w);
  edge  = Reconstruct(grid, w, point);
  whole = Whole(grid, 1, w);
  for (PetscInt j = 0; j < 38; j++)
    for (PetscInt i = 0; i < 45; i++) {
      const PetscInt k = j * 45 + i;

      cells += whole[k] > 0;
      if (i > 0) faces += (whole[k] > 0) != (whole[k - 1] > 0);
      if (j > 0) faces += (whole[k] > 0) != (whole[k - 45] > 0);
    }
  free(whole);
  same = SameBits(w, point);
  sam_assert(same && edge.good == 0 && edge.faces == faces && edge.cells == (PetscInt)cells);
  sam_assert_close(edge.area, cells - 0.09 * faces, 1e-9 * cells);
  sam_destroy(&w, &point);
  sam_call(SamGridDestroy(&grid));
}

/* Where w does not vanish at the edge, as on worn surfaces, cells are right in the mean, and nothing is taken off. */
static void test_blunt_edge_is_counted_in_whole_cells(void **state)
{
  SamGrid grid = NewGrid(45, 38, 2.6, 2.2);
  Vec     w    = NewFrom(grid, Disc, NULL);
  double *values;
  SamEdge edge;

  (void)state;
  sam_call(VecGetArray(w, &values));
  for (PetscInt k = 0; k < grid->cells; k++) values[k] = values[k] > 0 ? 1 + 0.2 * values[k] : 0;
  sam_call(VecRestoreArray(w, &values));
  edge = Reconstruct(grid, w, NULL);
  sam_assert(edge.good == 0 && edge.faces > 0);
  sam_assert_close(edge.area, edge.cells * grid->dx * grid->dy, 1e-12);
  sam_call(VecDestroy(&w));
  sam_call(SamGridDestroy(&grid));
}

/* Everything, and nothing. */
static void test_zone_without_an_edge(void **state)
{
  SamGrid grid = NewGrid(17, 13, 17, 13);
  Vec     w    = NewField(grid, 1);
  SamEdge edge;

  (void)state;
  edge = Reconstruct(grid, w, NULL);
  sam_assert(edge.area == 0 && edge.faces == 0 && edge.cells == 0);
  sam_call(VecSet(w, 2));
  edge = Reconstruct(grid, w, NULL);
  sam_assert(edge.area == 17 * 13 && edge.faces == 0 && edge.cells == 17 * 13);
  sam_call(VecDestroy(&w));
  sam_call(SamGridDestroy(&grid));
}

/* The same bits on any number of ranks, also where a rank has fewer rows than a window. */
static void test_edge_does_not_depend_on_the_ranks(void **state)
{
  const double turn = 0.4;
  SamEdge      all, alone;

  (void)state;
  for (PetscInt ny = 24; ny <= 50; ny += 13) {
    SamGrid grid = NewGridOn(PETSC_COMM_WORLD, 61, ny, 2.3, 2.1, 0, 0),
            own  = NewGridOn(PETSC_COMM_SELF, 61, ny, 2.3, 2.1, 0, 0);
    Vec w = NewFrom(grid, Ellipse, &turn), v = NewFrom(own, Ellipse, &turn),
        points[2] = {NewField(grid, 1), NewField(own, 1)};
    double *a, *b;

    all   = Reconstruct(grid, w, points[0]);
    alone = Reconstruct(own, v, points[1]);
    sam_assert(SameNumbers(1, &all.area, &alone.area) && all.good == alone.good && all.faces == alone.faces &&
               all.cells == alone.cells);
    a = Whole(grid, 1, points[0]);
    b = Whole(own, 1, points[1]);
    sam_assert(!memcmp(a, b, sizeof(*a) * (size_t)(61 * ny)));
    free(a);
    free(b);
    for (int k = 0; k < 2; k++) sam_call(VecDestroy(&points[k]));
    sam_destroy(&w, &v);
    sam_call(SamGridDestroy(&grid));
    sam_call(SamGridDestroy(&own));
  }
}

/* A ridge on a grid of a few rows that repeats: the same bits on any number of ranks, and as on several periods. */
static void test_edge_of_few_periodic_rows(void **state)
{
  (void)state;
  for (PetscInt ny = 2; ny <= 8; ny += 3) {
    const PetscInt rows[] = {ny, ny, 4 * ny};
    SamEdge        edge[3];
    double        *values[3];

    for (int k = 0; k < 3; k++) {
      SamGrid grid = NewGridOn(k == 1 ? PETSC_COMM_SELF : PETSC_COMM_WORLD, 40, (int)rows[k], 40, rows[k], 0, 0);
      Vec     w    = NewField(grid, 1);
      double *array;

      sam_call(VecGetArray(w, &array));
      for (PetscInt c = 0; c < grid->cells; c++) {
        const double wave = 1 + 2e-4 * cos(2 * PETSC_PI * (double)(grid->row_start + c / 40) / (double)ny),
                     x    = SamGridX(grid, c % 40) / (12.3 * wave);

        array[c] = fmax(0, 1 - x * x); /* the square of a traction */
      }
      sam_call(VecRestoreArray(w, &array));
      sam_call(SamEdgeReconstruct(grid, PETSC_TRUE, w, &edge[k]));
      sam_call(SamEdgeCorrect(&edge[k], w));
      sam_call(SamEdgeDestroy(&edge[k]));
      values[k] = Whole(grid, 1, w);
      sam_call(VecDestroy(&w));
      sam_call(SamGridDestroy(&grid));
    }
    sam_assert(!memcmp(values[0], values[1], sizeof(double) * (size_t)(40 * ny)));
    sam_assert(SameNumbers(1, &edge[0].area, &edge[1].area) && edge[0].good == edge[1].good);
    sam_assert(edge[0].good > 0 && 4 * edge[0].good == edge[2].good && 4 * edge[0].faces == edge[2].faces);
    sam_assert_close(4 * edge[0].area, edge[2].area, 1e-10 * edge[2].area);
    for (int k = 0; k < 3; k++) free(values[k]);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_edge_of_hertz_is_found_to_a_fraction_of_a_cell),
    cmocka_unit_test(test_area_is_of_second_order),
    cmocka_unit_test(test_half_widths_are_found_to_a_fraction_of_a_cell),
    cmocka_unit_test(test_half_widths_of_counted_cells),
    cmocka_unit_test(test_half_widths_of_slender_zones),
    cmocka_unit_test(test_half_widths_of_periodic_zones),
    cmocka_unit_test(test_edge_of_stick_is_cattaneos),
    cmocka_unit_test(test_step_has_the_areas_of_its_edges),
    cmocka_unit_test(test_peak_is_not_sought_where_slip_is_not_resolved),
    cmocka_unit_test(test_peak_of_a_thin_slip_zone_is_that_of_mindlin),
    cmocka_unit_test(test_points_lie_on_the_edge),
    cmocka_unit_test(test_area_of_an_ellipse_of_exact_values),
    cmocka_unit_test(test_another_layer_at_the_edge_is_refused),
    cmocka_unit_test(test_rough_zone_is_counted),
    cmocka_unit_test(test_blunt_edge_is_counted_in_whole_cells),
    cmocka_unit_test(test_zone_without_an_edge),
    cmocka_unit_test(test_edge_does_not_depend_on_the_ranks),
    cmocka_unit_test(test_edge_of_few_periodic_rows),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

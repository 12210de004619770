/*
  The grid, its rows, and moving fields between grids.
*/
#include "fields.h"
#include <petsam/private/grid.h>
#include <petsam/private/pool.h>

/* Even, odd, prime, and fewer rows than ranks. */
static const PetscInt sizes[][2] = {{16, 12}, {13, 7}, {9, 2}, {3, 3}, {31, 17}, {8, 4}, {5, 16}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]) };

/* Sums of a few hundred numbers, and shares that do not divide. */
static const double rounding = 1e-14;

/* ---- layout ---- */

static void test_rows_fill_the_grid_in_blocks_of_ceil_ny_over_ranks(void **state)
{
  PetscMPIInt rank, ranks;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for (PetscInt ny = 2; ny < 20; ny++) {
    SamGrid        grid  = NewGrid(5, ny, 1, 1);
    const PetscInt block = (ny + ranks - 1) / ranks;
    PetscInt       all   = grid->rows;
    Vec            v;
    PetscInt       local, global, start;

    (void)MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
    sam_assert(all == ny);
    sam_assert(grid->rows >= 0 && grid->rows <= block && grid->cells == 5 * grid->rows);
    sam_assert(grid->rows == 0 || grid->row_start == rank * block);
    sam_assert(grid->rows == block || grid->row_start + grid->rows == ny);
    for (PetscInt components = 1; components <= 2; components++) {
      sam_call(SamGridCreateVec(grid, components, &v));
      sam_call(VecGetSize(v, &global));
      sam_call(VecGetLocalSize(v, &local));
      sam_call(VecGetOwnershipRange(v, &start, NULL));
      sam_assert(global == components * 5 * ny && local == components * grid->cells &&
                 (!local || start == components * 5 * grid->row_start));
      sam_call(VecDestroy(&v));
    }
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_coordinates_are_cell_centres(void **state)
{
  SamGrid grid = NewGridOn(PETSC_COMM_WORLD, 6, 3, 3, 1.5, 10, -2);

  (void)state;
  sam_assert(grid->dx == 0.5 && grid->dy == 0.5 && grid->length == 1.5);
  for (PetscInt i = 0; i < 6; i++) sam_assert_close(SamGridX(grid, i), 8.75 + 0.5 * i, 10 * rounding);
  for (PetscInt j = 0; j < 3; j++) sam_assert_close(SamGridY(grid, j), -2.5 + 0.5 * j, 10 * rounding);
  sam_call(SamGridDestroy(&grid));
}

static void test_coarse_grid_has_half_the_cells_of_the_same_rectangle(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid fine = NewGridOn(PETSC_COMM_WORLD, sizes[k][0], sizes[k][1], 3, 1.5, 10, -2), coarse;

    if (sizes[k][1] > 2) {
      sam_call(SamGridCoarsen(fine, &coarse));
      sam_assert(coarse->nx == (fine->nx + 1) / 2 && coarse->ny == (fine->ny + 1) / 2);
      sam_assert(coarse->width[0] == 3 && coarse->width[1] == 1.5 && coarse->center[0] == 10 &&
                 coarse->center[1] == -2);
      sam_call(SamGridDestroy(&coarse));
    }
    sam_call(SamGridDestroy(&fine));
  }
}

static void test_impossible_grids_are_refused(void **state)
{
  const PetscInt  n[][2]      = {{1, 5}, {5, 0}, {0, 5}, {-3, 5}, {5, 5}};
  const PetscReal width[][2]  = {{0, 1}, {1, -1}, {NAN, 1}, {1, INFINITY}, {1, 1e-200}};
  const PetscReal center[][2] = {{NAN, 0}, {0, INFINITY}, {1e15, 0}}, size[2] = {1, 1}, origin[2] = {0, 0};
  SamGrid         grid;

  (void)state;
  for (int k = 0; k < 4; k++)
    sam_fails(SamGridCreate(PETSC_COMM_WORLD, n[k], size, origin, &grid), PETSC_ERR_ARG_OUTOFRANGE);
  for (int k = 0; k < 5; k++)
    sam_fails(SamGridCreate(PETSC_COMM_WORLD, n[4], width[k], origin, &grid), PETSC_ERR_ARG_OUTOFRANGE);
  for (int k = 0; k < 3; k++)
    sam_fails(SamGridCreate(PETSC_COMM_WORLD, n[4], size, center[k], &grid), PETSC_ERR_ARG_OUTOFRANGE);
}

/* What the caller waits for on its communicator is not met by what the library sends. */
static void test_messages_do_not_meet_the_caller_s(void **state)
{
  const PetscInt first[2] = {1, 2}, n[2] = {7, 9};
  SamGrid        grid = NewGrid(13, 17, 1, 1), other = NewGrid(5, 5, 1, 1);
  SamWindow      window;
  Vec            whole = NewRandom(grid, 1, 1), part;
  MPI_Request    request;
  int            buffer[1000], same, arrived;

  (void)state;
  (void)MPI_Comm_compare(grid->comm, PETSC_COMM_WORLD, &same);
  sam_assert(same == MPI_CONGRUENT);
  (void)MPI_Comm_compare(grid->comm, other->comm, &same);
  sam_assert(same == MPI_IDENT); /* so that transforms on both share their memory */
  (void)MPI_Irecv(buffer, 1000, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, PETSC_COMM_WORLD, &request);
  sam_call(SamWindowCreate(grid, first, n, &window));
  sam_call(SamGridDestroy(&other));
  other = SamWindowGetGrid(window);
  part  = NewField(other, 1);
  sam_call(SamWindowTake(window, whole, part));
  (void)MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
  if (!arrived) {
    (void)MPI_Cancel(&request);
    (void)MPI_Wait(&request, MPI_STATUS_IGNORE);
  }
  sam_assert(!arrived);
  sam_destroy(&part, &whole);
  sam_call(SamWindowDestroy(&window));
  sam_call(SamGridDestroy(&grid));
}

static void test_more_cells_than_can_be_counted_are_refused(void **state)
{
  const PetscInt  n[2]    = {65536, 65536};
  const PetscReal size[2] = {1, 1}, origin[2] = {0, 0};
  SamGrid         grid;

  (void)state;
  if (sizeof(PetscInt) > 4) skip();
  sam_fails(SamGridCreate(PETSC_COMM_WORLD, n, size, origin, &grid), PETSC_ERR_ARG_OUTOFRANGE);
}

/* With nothing that counts without the options. */
static PetscErrorCode FromOptions(SamGrid *grid)
{
  const SamOptions from     = {PETSC_COMM_WORLD, NULL};
  PetscInt         n[2]     = {0, 0};
  PetscReal        width[2] = {0, 0}, center[2] = {0, 0};

  return SamGridCreateFromOptions(&from, PETSC_FALSE, n, width, center, grid);
}

static void test_grid_from_options(void **state)
{
  const char *const wrong[] = {"",
                               "-grid_n 8",
                               "-grid_size 1",
                               "-grid_n 1 -grid_size 1",
                               "-grid_n 8 -grid_size 0",
                               "-grid_n 8,8,8 -grid_size 1",
                               "-grid_n 8.5 -grid_size 1",
                               "-grid_n 8 -grid_size 1 -grid_center nan",
                               "-grid_n 8 -grid_size 2,6e-3",
                               "-grid_n 8 -grid_size 0.5,60",
                               "-grid_n 8,9 -grid_size 60,0.5",
                               "-grid_n 9,4000 -grid_size 60,0.5"};
  const char *const thin[]  = {"-grid_n 5,1000 -grid_size 0.0005,0.1", "-grid_n 8 -grid_size 1,100",
                               "-grid_n 8 -grid_size 100,1", "-grid_n 500,4 -grid_size 60,0.5"};
  SamGrid           grid;

  (void)state;
  for (size_t k = 0; k < sizeof(wrong) / sizeof(wrong[0]); k++) {
    SetOptions(wrong[k]);
    sam_fails(FromOptions(&grid), SAM_ERR_USER);
  }
  for (size_t k = 0; k < sizeof(thin) / sizeof(thin[0]); k++) {
    SetOptions(thin[k]);
    sam_call(FromOptions(&grid));
    sam_call(SamGridDestroy(&grid));
  }
  SetOptions("-grid_n 8,5 -grid_size 2 -grid_center 1,-1");
  sam_call(FromOptions(&grid));
  sam_assert(grid->nx == 8 && grid->ny == 5 && grid->width[0] == 2 && grid->width[1] == 2 && grid->center[0] == 1 &&
             grid->center[1] == -1);
  sam_call(SamGridDestroy(&grid));
  sam_call(PetscOptionsClear(NULL));
}

/* ---- transfer ---- */

typedef struct {
  SamGrid     fine, coarse;
  SamTransfer transfer;
} Pair;

static Pair NewPairOn(MPI_Comm comm, int k)
{
  Pair p = {.fine = NewGridOn(comm, sizes[k][0], sizes[k][1], 3, 1.5, 0.2, -0.1)};

  if (sizes[k][1] > 2)
    sam_call(SamGridCoarsen(p.fine, &p.coarse));
  else
    p.coarse = NewGridOn(comm, (sizes[k][0] + 1) / 2, 2, 3, 1.5, 0.2, -0.1);
  sam_call(SamTransferCreate(p.fine, p.coarse, &p.transfer));
  return p;
}

static void DestroyPair(Pair *p)
{
  sam_call(SamTransferDestroy(&p->transfer));
  sam_call(SamGridDestroy(&p->fine));
  sam_call(SamGridDestroy(&p->coarse));
}

/* Of a field: that of one component of it. */
static double SumOf(SamGrid grid, Vec v, PetscInt component)
{
  const double *a;
  double        sum = 0;

  sam_call(VecGetArrayRead(v, &a));
  for (PetscInt k = 0; k < grid->cells; k++) sum += a[component * grid->cells + k];
  sam_call(VecRestoreArrayRead(v, &a));
  (void)MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum * grid->dx * grid->dy;
}

static void test_restriction_keeps_the_integral(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++)
    for (PetscInt components = 1; components <= 2; components++) {
      Pair p    = NewPairOn(PETSC_COMM_WORLD, k);
      Vec  fine = NewRandom(p.fine, components, k), coarse = NewField(p.coarse, components);

      sam_call(VecSet(coarse, NAN)); /* all of it is overwritten */
      sam_call(SamTransferRestrict(p.transfer, fine, coarse));
      for (PetscInt c = 0; c < components; c++)
        sam_assert_close(SumOf(p.coarse, coarse, c), SumOf(p.fine, fine, c),
                         rounding * Norm(fine, NORM_1) * p.fine->dx * p.fine->dy);
      sam_destroy(&fine, &coarse);
      DestroyPair(&p);
    }
}

static void test_constant_stays_constant_both_ways(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Pair      p    = NewPairOn(PETSC_COMM_WORLD, k);
    Vec       fine = NewField(p.fine, 2), coarse = NewField(p.coarse, 2);
    PetscReal least, most;

    sam_call(VecSet(fine, 1));
    sam_call(SamTransferRestrict(p.transfer, fine, coarse));
    sam_call(VecMin(coarse, NULL, &least));
    sam_call(VecMax(coarse, NULL, &most));
    sam_assert_close(least, 1, rounding);
    sam_assert_close(most, 1, rounding);
    sam_call(VecSet(coarse, 1));
    sam_call(VecSet(fine, NAN));
    sam_call(SamTransferProlong(p.transfer, coarse, fine));
    sam_call(VecMin(fine, NULL, &least));
    sam_call(VecMax(fine, NULL, &most));
    sam_assert_close(least, 1, rounding);
    sam_assert_close(most, 1, rounding);
    sam_destroy(&fine, &coarse);
    DestroyPair(&p);
  }
}

/* A linear function in each of two components. */
static double Linear(double x, double y, PetscInt component)
{
  return component ? 1 - 2 * x + 0.7 * y : 0.3 + x - 3 * y;
}

static Vec NewLinear(SamGrid grid)
{
  Vec     v = NewField(grid, 2);
  double *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < grid->nx; i++)
        a[c * grid->cells + j * grid->nx + i] = Linear(SamGridX(grid, i), SamGridY(grid, grid->row_start + j), c);
  sam_call(VecRestoreArray(v, &a));
  return v;
}

/*
  Between the outermost coarse centres linear functions are reproduced; beyond, the value on the way to them is kept.
*/
static void test_prolongation_is_linear_inside_and_constant_beyond(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Pair          p      = NewPairOn(PETSC_COMM_WORLD, k);
    Vec           coarse = NewLinear(p.coarse), fine = NewField(p.fine, 2);
    const double *a;
    double        error = 0;

    sam_call(SamTransferProlong(p.transfer, coarse, fine));
    sam_call(VecGetArrayRead(fine, &a));
    for (PetscInt c = 0; c < 2; c++)
      for (PetscInt j = 0; j < p.fine->rows; j++)
        for (PetscInt i = 0; i < p.fine->nx; i++) {
          const double x = fmin(fmax(SamGridX(p.fine, i), SamGridX(p.coarse, 0)), SamGridX(p.coarse, p.coarse->nx - 1));
          const double y = fmin(fmax(SamGridY(p.fine, p.fine->row_start + j), SamGridY(p.coarse, 0)),
                                SamGridY(p.coarse, p.coarse->ny - 1));

          error = fmax(error, fabs(a[c * p.fine->cells + j * p.fine->nx + i] - Linear(x, y, c)));
        }
    sam_call(VecRestoreArrayRead(fine, &a));
    sam_assert_close(error, 0, 10 * rounding); /* values up to 7 */
    sam_destroy(&fine, &coarse);
    DestroyPair(&p);
  }
}

/* Each rank does the whole on its own, which must be what all do together, to the last bit. */
static void test_transfer_does_not_depend_on_the_ranks(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    Pair all = NewPairOn(PETSC_COMM_WORLD, k), own = NewPairOn(PETSC_COMM_SELF, k);
    Vec  fine[2]  = {NewRandom(all.fine, 2, k), NewRandom(own.fine, 2, k)},
        coarse[2] = {NewField(all.coarse, 2), NewField(own.coarse, 2)};
    double *a, *b;

    sam_call(SamTransferRestrict(all.transfer, fine[0], coarse[0]));
    sam_call(SamTransferRestrict(own.transfer, fine[1], coarse[1]));
    a = Whole(all.coarse, 2, coarse[0]);
    b = Whole(own.coarse, 2, coarse[1]);
    for (PetscInt c = 0; c < 2 * all.coarse->nx * all.coarse->ny; c++) a[0] += a[c] == b[c] ? 0 : INFINITY;
    sam_assert(isfinite(a[0]));
    free(a);
    free(b);
    sam_call(SamTransferProlong(all.transfer, coarse[0], fine[0]));
    sam_call(SamTransferProlong(own.transfer, coarse[1], fine[1]));
    a = Whole(all.fine, 2, fine[0]);
    b = Whole(own.fine, 2, fine[1]);
    for (PetscInt c = 0; c < 2 * all.fine->nx * all.fine->ny; c++) a[0] += a[c] == b[c] ? 0 : INFINITY;
    sam_assert(isfinite(a[0]));
    free(a);
    free(b);
    for (int g = 0; g < 2; g++) {
      sam_destroy(&fine[g], &coarse[g]);
    }
    DestroyPair(&all);
    DestroyPair(&own);
  }
}

/* ---- windows ---- */

/* First cell and size of windows of a 13 x 11 grid: inside, at corners, all of it, one with fewer rows than ranks. */
static const PetscInt windows[][4] = {{3, 2, 7, 6}, {0, 0, 5, 11}, {8, 7, 5, 4}, {0, 0, 13, 11}, {4, 5, 2, 2}};
enum { NUM_WINDOWS = sizeof(windows) / sizeof(windows[0]) };

static void test_window_takes_its_cells_and_puts_them_back(void **state)
{
  SamGrid grid = NewGridOn(PETSC_COMM_WORLD, 13, 11, 2.6, 1.1, 0.3, -0.2);

  (void)state;
  for (int w = 0; w < NUM_WINDOWS; w++) {
    const PetscInt *first = windows[w], *n = windows[w] + 2;
    Vec             whole = NewRandom(grid, 2, w), part, back = NewRandom(grid, 2, 99);
    SamWindow       window;
    SamGrid         inner;
    const double   *a;
    PetscInt        wrong = 0;

    sam_call(SamWindowCreate(grid, first, n, &window));
    inner = SamWindowGetGrid(window);
    sam_assert(inner->nx == n[0] && inner->ny == n[1]);
    sam_assert_close(SamGridX(inner, 0), SamGridX(grid, first[0]), rounding);
    sam_assert_close(SamGridY(inner, n[1] - 1), SamGridY(grid, first[1] + n[1] - 1), rounding);
    part = NewField(inner, 2);
    sam_call(SamWindowTake(window, whole, part));
    sam_call(VecGetArrayRead(part, &a));
    for (PetscInt c = 0; c < 2; c++)
      for (PetscInt j = 0; j < inner->rows; j++)
        for (PetscInt i = 0; i < inner->nx; i++)
          wrong +=
            a[c * inner->cells + j * inner->nx + i] != Random(w, c, first[0] + i, first[1] + inner->row_start + j);
    sam_call(VecRestoreArrayRead(part, &a));
    sam_assert(wrong == 0);
    sam_call(SamWindowPut(window, part, back));
    sam_call(VecGetArrayRead(back, &a));
    for (PetscInt c = 0; c < 2; c++)
      for (PetscInt j = 0; j < grid->rows; j++)
        for (PetscInt i = 0; i < grid->nx; i++) {
          const PetscInt row    = grid->row_start + j;
          const int      inside = i >= first[0] && i < first[0] + n[0] && row >= first[1] && row < first[1] + n[1];

          wrong += a[c * grid->cells + j * grid->nx + i] != (inside ? Random(w, c, i, row) : 0);
        }
    sam_call(VecRestoreArrayRead(back, &a));
    sam_assert(wrong == 0);
    sam_destroy(&whole, &part, &back);
    sam_call(SamWindowDestroy(&window));
  }
  sam_call(SamGridDestroy(&grid));
}

static void test_window_knows_what_it_covers(void **state)
{
  const PetscInt first[2] = {3, 2}, n[2] = {7, 6}, inside[2] = {4, 2}, small[2] = {6, 6}, left[2] = {2, 2};
  SamGrid        grid = NewGrid(13, 11, 1, 1);
  SamWindow      window;

  (void)state;
  sam_call(SamWindowCreate(grid, first, n, &window));
  sam_assert(SamWindowCovers(window, first, n));
  sam_assert(SamWindowCovers(window, inside, small));
  sam_assert(!SamWindowCovers(window, left, small));
  sam_assert(!SamWindowCovers(window, inside, n));
  sam_call(SamWindowDestroy(&window));
  sam_call(SamGridDestroy(&grid));
}

static void test_support_is_the_smallest_rectangle_of_positive_cells(void **state)
{
  SamGrid  grid  = NewGrid(13, 11, 1, 1);
  Vec      field = NewField(grid, 1);
  PetscInt first[2], n[2];
  double  *a;

  (void)state;
  sam_call(SamGridGetSupport(grid, field, PETSC_FALSE, first, n));
  sam_assert(n[0] == 0 && n[1] == 0);
  sam_call(VecGetArray(field, &a));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < 13; i++) {
      const PetscInt row = grid->row_start + j;

      a[j * 13 + i] = (i == 4 && row == 9) || (i == 11 && row == 3) ? 1 : -1;
    }
  sam_call(VecRestoreArray(field, &a));
  sam_call(SamGridGetSupport(grid, field, PETSC_FALSE, first, n));
  sam_assert(first[0] == 4 && n[0] == 8 && first[1] == 3 && n[1] == 7);
  sam_call(SamGridGetSupport(grid, field, PETSC_TRUE, first, n)); /* from column 11 on over the border, and row 9 */
  sam_assert(first[0] == 11 && n[0] == 7 && first[1] == 9 && n[1] == 6);
  sam_call(VecGetArray(field, &a)); /* what is left out lies across both borders */
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < 13; i++) a[j * 13 + i] = (i == 4 || i == 8) && (grid->row_start + j) % 2 ? 1 : 0;
  sam_call(VecRestoreArray(field, &a));
  sam_call(SamGridGetSupport(grid, field, PETSC_TRUE, first, n));
  sam_assert(first[0] == 4 && n[0] == 5 && first[1] == 1 && n[1] == 9);
  sam_call(VecSet(field, 1));
  sam_call(SamGridGetSupport(grid, field, PETSC_TRUE, first, n));
  sam_assert(first[0] == 0 && n[0] == 13 && first[1] == 0 && n[1] == 11);
  sam_call(VecSet(field, 0));
  sam_call(SamGridGetSupport(grid, field, PETSC_TRUE, first, n));
  sam_assert(n[0] == 0 && n[1] == 0);
  sam_call(VecDestroy(&field));
  sam_call(SamGridDestroy(&grid));
}

/* A field that has been given back is the next one's; it needs the pool no other way. */
static void test_a_pool_lends_what_it_has_got_back(void **state)
{
  SamGrid        grid = NewGrid(5, 4, 1, 1);
  SamPool        pool = NULL;
  Vec            field[2], again, many[12], another, own;
  const PetscInt all = 5 * 4;
  PetscInt       size;

  (void)state;
  sam_call(SamPoolCreate(grid, &pool));
  for (int k = 0; k < 2; k++) sam_call(SamPoolTake(pool, &field[k]));
  sam_assert(field[0] != field[1]);
  sam_call(VecGetSize(field[1], &size));
  sam_assert(size == all);
  many[0] = field[0];
  sam_call(SamPoolGive(pool, &field[0]));
  sam_assert(!field[0]);
  sam_call(SamPoolTake(pool, &again));
  sam_assert(again == many[0]);
  for (int k = 0; k < 10; k++) sam_call(SamPoolTake(pool, &many[k]));
  sam_says(SamPoolTake(pool, &another), PETSC_ERR_ARG_OUTOFRANGE, "All 12 fields");
  sam_call(SamGridCreateVec(grid, 1, &own));
  another = own;
  sam_says(SamPoolGive(pool, &another), PETSC_ERR_ARG_WRONG, "not one that the pool has lent");
  another = many[3];
  sam_call(SamPoolGive(pool, &many[3]));
  sam_says(SamPoolGive(pool, &another), PETSC_ERR_ARG_WRONG, "not one that the pool has lent");
  sam_call(VecDestroy(&own));
  sam_call(SamPoolDestroy(&pool));
  sam_assert(!pool);
  sam_call(SamPoolDestroy(&pool));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_rows_fill_the_grid_in_blocks_of_ceil_ny_over_ranks),
    cmocka_unit_test(test_coordinates_are_cell_centres),
    cmocka_unit_test(test_coarse_grid_has_half_the_cells_of_the_same_rectangle),
    cmocka_unit_test(test_impossible_grids_are_refused),
    cmocka_unit_test(test_messages_do_not_meet_the_caller_s),
    cmocka_unit_test(test_more_cells_than_can_be_counted_are_refused),
    cmocka_unit_test(test_grid_from_options),
    cmocka_unit_test(test_restriction_keeps_the_integral),
    cmocka_unit_test(test_constant_stays_constant_both_ways),
    cmocka_unit_test(test_prolongation_is_linear_inside_and_constant_beyond),
    cmocka_unit_test(test_transfer_does_not_depend_on_the_ranks),
    cmocka_unit_test(test_window_takes_its_cells_and_puts_them_back),
    cmocka_unit_test(test_window_knows_what_it_covers),
    cmocka_unit_test(test_support_is_the_smallest_rectangle_of_positive_cells),
    cmocka_unit_test(test_a_pool_lends_what_it_has_got_back),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * The state of a contact in a file: what is read is what was written, on all ranks; a checksum sees what changes and
 * not where it lies.
 */
#include "fields.h"

#include <unistd.h>

#include <petsam/checkpoint.h>

static const char filename[] = "test_checkpoint.h5";

static void Remove(void)
{
  static const char *const names[] = {"test_checkpoint.h5", "test_checkpoint.h5.1"};
  int                      rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  for (int k = 0; k < 2 && !rank; k++) (void)unlink(names[k]);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* ---- checksums ---- */

static uint64_t ChecksumOn(MPI_Comm comm, int swap)
{
  SamGrid  grid  = NewGridOn(comm, 13, 7, 1, 1, 0, 0);
  Vec      field = NewField(grid, 2);
  uint64_t checksum;
  double  *values;

  sam_call(VecGetArray(field, &values));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < grid->nx; i++) {
        const PetscInt row   = grid->row_start + j,
                       other = swap && row == 3 && i < 2 ? 1 - i : i; /* two cells change places */

        values[c * grid->cells + j * grid->nx + i] = Random(1, c, other, row);
      }
  sam_call(VecRestoreArray(field, &values));
  sam_call(SamCheckpointChecksum(grid, field, &checksum));
  sam_call(VecDestroy(&field));
  sam_call(SamGridDestroy(&grid));
  return checksum;
}

static void test_checksum_is_that_of_the_field_not_of_its_ranks(void **state)
{
  (void)state;
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 0) == ChecksumOn(PETSC_COMM_SELF, 0));
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 1) == ChecksumOn(PETSC_COMM_SELF, 1));
  sam_assert(ChecksumOn(PETSC_COMM_WORLD, 0) != ChecksumOn(PETSC_COMM_WORLD, 1));
}

/* ---- files ---- */

typedef struct {
  SamGrid       grid;
  SamElasticity elasticity;
  SamContact    contact;
} Body;

/* A sphere; one row of the grid may be on fewer ranks than there are. */
static Body NewBody(PetscInt ny)
{
  const double young[2] = {210e9, 70e9}, poisson[2] = {0.3, 0.2};
  Body         b = {.grid = NewGrid(37, ny, 6e-3, 6e-3)};
  Vec          h = NewField(b.grid, 1);
  SamPair      pair;
  double      *values;

  sam_call(SamPairSet(&pair, young, poisson));
  sam_call(SamElasticityCreate(b.grid, &pair, &b.elasticity));
  sam_call(VecGetArray(h, &values));
  for (PetscInt k = 0; k < b.grid->cells; k++) {
    const double x = SamGridX(b.grid, k % b.grid->nx), y = SamGridY(b.grid, b.grid->row_start + k / b.grid->nx);

    values[k] = (x * x + y * y) / 0.2;
  }
  sam_call(VecRestoreArray(h, &values));
  sam_call(SamContactCreate(b.elasticity, h, 0.3, &b.contact));
  sam_call(VecDestroy(&h));
  return b;
}

static void DestroyBody(Body *b)
{
  sam_call(SamContactDestroy(&b->contact));
  sam_call(SamElasticityDestroy(&b->elasticity));
  sam_call(SamGridDestroy(&b->grid));
}

static SamHistory NewHistory(void)
{
  SamHistory history;

  sam_call(PetscOptionsInsertString(NULL, "-load_n 200 -load_tx 20 -load_ty 5 -steps 4"));
  sam_call(SamHistoryCreateFromOptions(PETSC_COMM_WORLD, &history));
  sam_call(PetscOptionsClear(NULL));
  return history;
}

static SamStep SolveStep(const Body *b, SamHistory history, PetscInt k)
{
  SamStep step;

  sam_call(SamHistoryGetStep(history, k, &step));
  sam_call(SamContactSolve(b->contact, &step));
  sam_assert(step.check.normal < 1e-7 && step.check.tangential < 1e-5);
  return step;
}

static PetscBool Same(Vec a, Vec b)
{
  PetscBool same;

  sam_call(VecEqual(a, b, &same));
  return same;
}

static void test_contact_that_is_read_goes_on_as_the_one_that_was_written(void **state)
{
  (void)state;
  for (PetscInt solved = 1; solved < 4; solved++) {
    Body          one = NewBody(30), other = NewBody(30);
    SamHistory    history    = NewHistory();
    SamParameters parameters = {.count = 0};
    PetscInt      steps;
    SamStatus     worst;

    sam_call(SamParametersAddReals(&parameters, "friction", PETSC_TRUE, 1, &(PetscReal){0.3}));
    for (PetscInt k = 0; k < solved; k++) (void)SolveStep(&one, history, k);
    sam_call(SamCheckpointWrite(filename, one.contact, history, &parameters, solved, SAM_STATUS_EDGE_CONTACT));
    sam_call(SamCheckpointRead(filename, other.contact, history, &parameters, &steps, &worst));
    sam_assert(steps == solved && worst == SAM_STATUS_EDGE_CONTACT);
    for (PetscInt k = solved; k < 4; k++) {
      const SamStep a = SolveStep(&one, history, k), b = SolveStep(&other, history, k);
      SamFields     f[2];

      sam_call(SamContactGetFields(one.contact, &f[0]));
      sam_call(SamContactGetFields(other.contact, &f[1]));
      sam_assert(Same(f[0].pressure, f[1].pressure) && Same(f[0].shear, f[1].shear) && Same(f[0].slip, f[1].slip) &&
                 Same(f[0].gap, f[1].gap));
      sam_assert(a.normal_iterations == b.normal_iterations && a.tangential_iterations == b.tangential_iterations);
    }
    sam_call(SamHistoryDestroy(&history));
    DestroyBody(&one);
    DestroyBody(&other);
    Remove();
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_checksum_is_that_of_the_field_not_of_its_ranks),
    cmocka_unit_test(test_contact_that_is_read_goes_on_as_the_one_that_was_written),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/* Stresses on sections: those of the maps, at any line, for any steps, the same on any number of ranks. */
#include "fields.h"

#include <petsam/private/stressimpl.h>

enum { COMPONENTS = SAM_STRESS_COMPONENTS, TRACTIONS = SAM_STRESS_TRACTIONS, DEPTHS = 4, STEPS = 3 };
#define NU 0.34

static const PetscReal depths[DEPTHS] = {0, 0.011e-3, 0.15e-3, 2e-3};

/* Random tractions within a rectangle of cells that differs from step to step; none in the last step but one. */
static Vec NewTractions(SamGrid grid, PetscInt step)
{
  const PetscInt nx = grid->nx, ny = grid->ny;
  Vec            v = NewRandom(grid, TRACTIONS, 11 + step);
  double        *t;

  sam_call(VecGetArray(v, &t));
  for (PetscInt c = 0; c < TRACTIONS; c++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < nx; i++) {
        const PetscInt  y      = grid->row_start + j;
        const PetscBool inside = i >= step && i < nx - 2 * step && y >= 2 * step && y < ny - step;

        if (!inside || step == 1) t[c * grid->cells + j * nx + i] = 0;
      }
  sam_call(VecRestoreArray(v, &t));
  return v;
}

/* The maps' stresses along the section: [step][component][depth][cell], on all ranks. */
static double *FromMaps(SamGrid grid, PetscInt body, SamSectionAxis axis, PetscInt index)
{
  const PetscInt length = axis == SAM_SECTION_X ? grid->nx : grid->ny;
  double        *result = calloc((size_t)(STEPS * COMPONENTS * DEPTHS * length), sizeof(double));
  SamStress      stress;

  sam_call(SamStressCreate(grid, NULL, body, NU, &stress));
  for (int k = 0; k < DEPTHS; k++) {
    sam_call(SamStressSetDepth(stress, depths[k]));
    for (PetscInt step = 0; step < STEPS; step++) {
      Vec           t = NewTractions(grid, step), s = NewField(grid, COMPONENTS);
      const double *from;
      double       *to;

      sam_call(VecGetArrayRead(t, &from));
      sam_call(VecGetArray(s, &to));
      sam_call(PetscArraycpy(to + SAM_STRESS_ZZ * grid->cells, from, grid->cells));
      sam_call(PetscArraycpy(to + SAM_STRESS_XZ * grid->cells, from + grid->cells, 2 * grid->cells));
      sam_call(VecRestoreArray(s, &to));
      sam_call(VecRestoreArrayRead(t, &from));
      sam_call(SamStressApply(stress, s));
      to = Whole(grid, COMPONENTS, s);
      for (int c = 0; c < COMPONENTS; c++)
        for (PetscInt i = 0; i < length; i++) {
          const PetscInt cell = axis == SAM_SECTION_X ? index * grid->nx + i : i * grid->nx + index;

          result[((step * COMPONENTS + c) * DEPTHS + k) * length + i] = to[(ptrdiff_t)c * grid->nx * grid->ny + cell];
        }
      free(to);
      sam_call(VecDestroy(&t));
      sam_call(VecDestroy(&s));
    }
  }
  sam_call(SamStressDestroy(&stress));
  return result;
}

static void AssertSection(PetscInt nx, PetscInt ny, PetscInt body, SamSectionAxis axis, PetscInt index)
{
  SamGrid    grid = NewGrid(nx, ny, 1.2e-3, 0.9e-3);
  double    *maps = FromMaps(grid, body, axis, index), *mine, worst = 0;
  SamSection section;
  PetscInt   first, count, length;

  sam_call(SamSectionCreate(grid, body, NU, axis, index, DEPTHS, depths, &section));
  sam_call(SamSectionGetDepths(section, &first, &count, &length));
  sam_assert(length == (axis == SAM_SECTION_X ? nx : ny));
  for (PetscInt step = 0; step < STEPS; step++) {
    Vec t = NewTractions(grid, step);

    sam_call(SamSectionAddStep(section, t));
    sam_call(VecDestroy(&t));
  }
  mine = calloc((size_t)(STEPS * COMPONENTS * count * length) + 1, sizeof(double));
  sam_call(SamSectionCompute(section, mine));
  for (PetscInt sc = 0; sc < STEPS * COMPONENTS; sc++)
    for (PetscInt k = 0; k < count; k++)
      for (PetscInt i = 0; i < length; i++)
        worst =
          SamLarger(worst, fabs(mine[(sc * count + k) * length + i] - maps[(sc * DEPTHS + first + k) * length + i]));
  sam_call(SamMax(grid->comm, 1, &worst));
  sam_assert_close(worst, 0, 1e-13);
  free(mine);
  free(maps);
  sam_call(SamSectionDestroy(&section));
  sam_call(SamGridDestroy(&grid));
}

static void test_sections_along_x_are_rows_of_the_maps(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    AssertSection(17, 11, body, SAM_SECTION_X, 5);
    AssertSection(17, 11, body, SAM_SECTION_X, 0);
    AssertSection(8, 13, body, SAM_SECTION_X, 11);
  }
}

static void test_sections_along_y_are_columns_of_the_maps(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    AssertSection(17, 11, body, SAM_SECTION_Y, 8);
    AssertSection(17, 11, body, SAM_SECTION_Y, 16);
    AssertSection(9, 14, body, SAM_SECTION_Y, 1);
  }
}

/* Steps at once or one by one: the same bits; and steps that have been computed are forgotten. */
static void test_steps_do_not_depend_on_each_other(void **state)
{
  SamGrid    grid = NewGrid(19, 12, 1e-3, 1e-3);
  SamSection section;
  PetscInt   count, length;
  size_t     size;
  double    *all, *one;

  (void)state;
  sam_call(SamSectionCreate(grid, 2, NU, SAM_SECTION_X, 4, DEPTHS, depths, &section));
  sam_call(SamSectionGetDepths(section, NULL, &count, &length));
  size = (size_t)(COMPONENTS * count * length);
  all  = calloc(STEPS * size + 1, sizeof(double));
  one  = calloc(size + 1, sizeof(double));
  for (PetscInt step = 0; step < STEPS; step++) {
    Vec t = NewTractions(grid, step);

    sam_call(SamSectionAddStep(section, t));
    sam_call(VecDestroy(&t));
  }
  sam_call(SamSectionCompute(section, all));
  for (PetscInt step = 0; step < STEPS; step++) {
    Vec t = NewTractions(grid, step);

    sam_call(SamSectionAddStep(section, t));
    sam_call(SamSectionCompute(section, one));
    sam_assert(!memcmp(one, all + (size_t)step * size, size * sizeof(double)));
    sam_call(VecDestroy(&t));
  }
  free(all);
  free(one);
  sam_call(SamSectionDestroy(&section));
  sam_call(SamGridDestroy(&grid));
}

static void test_depths_are_divided_among_the_ranks(void **state)
{
  SamGrid     grid = NewGrid(5, 4, 1, 1);
  PetscMPIInt rank;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscInt n = 0; n <= DEPTHS; n++) {
    SamSection section;
    PetscInt   first, count;
    double     sums[2], ends = 0;

    sam_call(SamSectionCreate(grid, 2, NU, SAM_SECTION_X, 1, n, depths, &section));
    sam_call(SamSectionGetDepths(section, &first, &count, NULL));
    sums[0] = count;
    sums[1] = rank ? 0 : first;
    ends    = first + count;
    sam_call(SamSum(grid->comm, 2, sums));
    sam_call(SamMax(grid->comm, 1, &ends));
    sam_assert(sums[0] == n && sums[1] == 0 && ends == n);
    sam_call(SamSectionDestroy(&section));
  }
  sam_call(SamGridDestroy(&grid));
}

static void test_wrong_arguments_are_refused(void **state)
{
  const PetscReal wrong[] = {0, -1};
  SamGrid         grid    = NewGrid(5, 4, 1, 1);
  SamSection      none;

  (void)state;
  sam_call(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  sam_assert(SamSectionCreate(grid, 2, NU, SAM_SECTION_X, 4, 1, depths, &none));
  sam_assert(SamSectionCreate(grid, 2, NU, SAM_SECTION_Y, 5, 1, depths, &none));
  sam_assert(SamSectionCreate(grid, 2, NU, SAM_SECTION_Y, -1, 1, depths, &none));
  sam_assert(SamSectionCreate(grid, 2, NU, SAM_SECTION_Y, 0, 2, wrong, &none));
  sam_assert(SamSectionCreate(grid, 0, NU, SAM_SECTION_X, 0, 1, depths, &none));
  sam_call(PetscPopErrorHandler());
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sections_along_x_are_rows_of_the_maps),
    cmocka_unit_test(test_sections_along_y_are_columns_of_the_maps),
    cmocka_unit_test(test_steps_do_not_depend_on_each_other),
    cmocka_unit_test(test_depths_are_divided_among_the_ranks),
    cmocka_unit_test(test_wrong_arguments_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

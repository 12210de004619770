/* Stresses on sections: those of the maps, at any line, for any steps, the same on any number of ranks. */
#include "fields.h"

#include <petsam/private/halfspace.h>

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

/* The kernels of a half-space; those of zz by shear as ones of their own, as other bodies have them. */
static void AllRows(SamStress stress, const double side[2], double depth, SamStressGroup group, PetscInt j, PetscInt n,
                    double *const values[SAM_STRESS_GROUP])
{
  const SamHalfSpaceSource source = {{side[0], side[1]}, depth, NU};
  double *const            to[]   = {values[2], values[0], values[1]};
  const PetscBool          z      = group == SAM_STRESS_NORMAL_Z;

  (void)stress;
  SamHalfSpaceStressRow(&source, z ? SAM_STRESS_NORMAL_P : group, j, n, z ? to : values);
}

/* A smooth part: in each component another plane, whose height goes with the sums of p and q_x. */
static PetscErrorCode Reduce(SamStress stress, const double *const tractions[], double sums[])
{
  PetscFunctionBegin;
  for (int t = 0; t < 2; t++) {
    sums[t] = 0;
    for (PetscInt k = 0; k < stress->grid->cells; k++) sums[t] += tractions[t][k];
  }
  PetscCall(SamSum(stress->grid->comm, 2, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddPlane(SamStress stress, const double sums[], const double first[3], const double step[2], PetscInt n,
                     double *const to[SAM_STRESS_COMPONENTS])
{
  (void)stress;
  for (PetscInt i = 0; i < n; i++)
    for (int c = 0; c < COMPONENTS; c++)
      to[c][i] += 1e-3 * sums[0] * (1 + c + 1e3 * (first[0] + (double)i * step[0])) +
                  sums[1] * (2 * (first[1] + (double)i * step[1]) + c * first[2]);
}

/* Maps and sections must agree whatever a type knows: all kernels, a smooth part. */
typedef enum { PLAIN, ALL, SMOOTH } Kind;
static SamStress NewStress(SamGrid grid, PetscInt body, Kind kind)
{
  SamStress stress;

  sam_call(SamHalfSpaceCreateStress(grid, NULL, body, NU, &stress));
  if (kind == ALL) {
    stress->groups  = SAM_STRESS_GROUPS;
    stress->ops.row = AllRows;
    sam_assert(SamStressKernelOf(stress, SAM_STRESS_ZZ, SAM_STRESS_QY).group == SAM_STRESS_NORMAL_Z);
  } else if (kind == SMOOTH) {
    stress->sums       = 2;
    stress->ops.reduce = Reduce;
    stress->ops.add    = AddPlane;
  }
  return stress;
}

/* The maps' stresses along the section: [step][component][depth][cell], on all ranks. */
static double *FromMaps(SamGrid grid, PetscInt body, SamSectionAxis axis, PetscInt index, Kind kind)
{
  const PetscInt length = axis == SAM_SECTION_X ? grid->nx : grid->ny;
  double        *result = calloc((size_t)(STEPS * COMPONENTS * DEPTHS * length), sizeof(double));
  SamStress      stress = NewStress(grid, body, kind);

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
      sam_destroy(&t, &s);
    }
  }
  sam_call(SamStressDestroy(&stress));
  return result;
}

static void AssertSection(PetscInt nx, PetscInt ny, PetscInt body, SamSectionAxis axis, PetscInt index, Kind of_maps,
                          Kind of_section)
{
  SamGrid    grid = NewGrid(nx, ny, 1.2e-3, 0.9e-3);
  double    *maps = FromMaps(grid, body, axis, index, of_maps), *mine, worst = 0;
  SamStress  stress = NewStress(grid, body, of_section);
  SamSection section;
  PetscInt   first, count, length;

  sam_call(SamSectionCreate(stress, axis, index, DEPTHS, depths, &section));
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
  sam_call(SamStressDestroy(&stress));
  sam_call(SamGridDestroy(&grid));
}

static void test_sections_along_x_are_rows_of_the_maps(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    AssertSection(17, 11, body, SAM_SECTION_X, 5, PLAIN, ALL);
    AssertSection(17, 11, body, SAM_SECTION_X, 0, ALL, PLAIN);
    AssertSection(8, 13, body, SAM_SECTION_X, 11, PLAIN, ALL);
    AssertSection(8, 13, body, SAM_SECTION_X, 10, SMOOTH, SMOOTH);
  }
}

static void test_sections_along_y_are_columns_of_the_maps(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    AssertSection(17, 11, body, SAM_SECTION_Y, 8, PLAIN, ALL);
    AssertSection(17, 11, body, SAM_SECTION_Y, 16, ALL, PLAIN);
    AssertSection(9, 14, body, SAM_SECTION_Y, 1, PLAIN, ALL);
    AssertSection(9, 14, body, SAM_SECTION_Y, 2, SMOOTH, SMOOTH);
  }
}

/* Steps at once or one by one: the same bits; and steps that have been computed are forgotten. */
static void test_steps_do_not_depend_on_each_other(void **state)
{
  SamGrid    grid   = NewGrid(19, 12, 1e-3, 1e-3);
  SamStress  stress = NewStress(grid, 2, PLAIN);
  SamSection section;
  PetscInt   count, length;
  size_t     size;
  double    *all, *one;

  (void)state;
  sam_call(SamSectionCreate(stress, SAM_SECTION_X, 4, DEPTHS, depths, &section));
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
  sam_call(SamStressDestroy(&stress));
  sam_call(SamGridDestroy(&grid));
}

static void test_depths_are_divided_among_the_ranks(void **state)
{
  SamGrid     grid   = NewGrid(5, 4, 1, 1);
  SamStress   stress = NewStress(grid, 2, PLAIN);
  PetscMPIInt rank;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscInt n = 0; n <= DEPTHS; n++) {
    SamSection section;
    PetscInt   first, count;
    double     sums[2], ends = 0;

    sam_call(SamSectionCreate(stress, SAM_SECTION_X, 1, n, depths, &section));
    sam_call(SamSectionGetDepths(section, &first, &count, NULL));
    sums[0] = count;
    sums[1] = rank ? 0 : first;
    ends    = first + count;
    sam_call(SamSum(grid->comm, 2, sums));
    sam_call(SamMax(grid->comm, 1, &ends));
    sam_assert(sums[0] == n && sums[1] == 0 && ends == n);
    sam_call(SamSectionDestroy(&section));
  }
  sam_call(SamStressDestroy(&stress));
  sam_call(SamGridDestroy(&grid));
}

static void test_wrong_arguments_are_refused(void **state)
{
  const PetscReal wrong[] = {0, -1};
  SamGrid         grid    = NewGrid(5, 4, 1, 1);
  SamStress       stress  = NewStress(grid, 2, PLAIN);
  SamSection      none;

  (void)state;
  sam_call(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  sam_assert(SamSectionCreate(stress, SAM_SECTION_X, 4, 1, depths, &none));
  sam_assert(SamSectionCreate(stress, SAM_SECTION_Y, 5, 1, depths, &none));
  sam_assert(SamSectionCreate(stress, SAM_SECTION_Y, -1, 1, depths, &none));
  sam_assert(SamSectionCreate(stress, SAM_SECTION_Y, 0, 2, wrong, &none));
  sam_call(PetscPopErrorHandler());
  sam_call(SamStressDestroy(&stress));
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

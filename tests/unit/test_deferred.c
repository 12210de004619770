/* The correction for the edge of contact: closed solutions, what it is made of, and what is refused. */
#include "contacts.h"

#include <petsam/private/halfspace.h>
#include <string.h>

#define DEFERRED "-edges deferred"

static const double places[][2] = {{0.13, 0.27}, {0.41, 0.07}, {0.02, 0.31}};

/* ---- slopes and sub-cells ---- */

/* The displacement by a pressure that is linear in one cell, by its sub-cells. */
static double BySubCells(const Sphere *s, int axis, PetscInt i, PetscInt j)
{
  enum { SUB = 61 };
  const double h[2] = {s->grid->dx / SUB, s->grid->dy / SUB};
  double       sum  = 0;

  for (int b = 0; b < SUB; b++)
    for (int a = 0; a < SUB; a++) {
      const double at = ((axis ? b : a) + 0.5) / SUB - 0.5;

      sum += at * SamIntegralCell(SAM_INTEGRAL_R, h[0], h[1], i * SUB + SUB / 2 - a, j * SUB + SUB / 2 - b);
    }
  return s->pair.normal * sum;
}

/* A pressure that is linear in one cell, on cells that are not square, near and far, on both sides and in itself. */
static void test_linear_pressure_displaces_as_its_sub_cells(void **state)
{
  const double size[] = {2e-3, 9e-3};
  Sphere       s      = {.pair = Steel()};

  (void)state;
  for (int k = 0; k < 2; k++)
    for (int axis = 0; axis < 2; axis++) {
      Vec           slopes, u;
      const double *whole;

      s.grid = NewGridOn(PETSC_COMM_WORLD, 37, 31, size[k], 2e-3, 0, 0);
      sam_call(SamElasticityCreate(s.grid, &s.pair, &s.elasticity));
      slopes = NewField(s.grid, 2);
      u      = NewField(s.grid, 1);
      AddAt(s.grid, axis, 12, 11, 1e6, slopes);
      sam_call(SamElasticityApplyNormalSlopes(s.elasticity, slopes, u));
      whole = Whole(s.grid, 1, u);
      for (PetscInt j = 0; j < 31; j += 2)
        for (PetscInt i = 0; i < 37; i += 3) {
          const double exact = 1e6 * BySubCells(&s, axis, i - 12, j - 11);

          sam_assert_close(whole[j * 37 + i], exact, 1e-3 * fabs(exact) + 1e-9 * 1e6 * s.pair.normal * s.grid->dx);
        }
      free((void *)whole);
      sam_call(VecDestroy(&u));
      sam_call(VecDestroy(&slopes));
      sam_call(SamElasticityDestroy(&s.elasticity));
      sam_call(SamGridDestroy(&s.grid));
    }
}

/* Uniform pressure on all sub-cells is that of the cell. */
static void test_sub_cells_add_up_to_the_cell(void **state)
{
  enum { REACH = 2, LAGS = 2 * REACH + 1, SUB = 5 };
  Sphere s = NewSphereOf(Steel(), 20, 1.5);
  double table[LAGS * LAGS * SUB * SUB];

  (void)state;
  sam_call(SamElasticityGetNear(s.elasticity, REACH, SUB, table));
  for (int k = 0; k < LAGS * LAGS; k++) {
    double sum = 0;

    for (int n = 0; n < SUB * SUB; n++) sum += table[k * SUB * SUB + n];
    sam_assert_close(
      sum, s.pair.normal * SamIntegralCell(SAM_INTEGRAL_R, s.grid->dx, s.grid->dy, k % LAGS - REACH, k / LAGS - REACH),
      1e-12 * sum);
  }
  DestroySphere(&s);
}

/* ---- closed solutions ---- */

typedef struct {
  double errors[2]; /* of the pressure: means, and at the centres */
  double area, approach;
} Hertzian;

static Hertzian Measure(const Case *c, const SamStep *step, double x, double y)
{
  Vec      point = NewField(c->s.grid, 1);
  SamEdge  edge;
  Hertzian h;

  sam_call(SamContactFindEdge(c->contact, SAM_EDGE_CONTACT, point, &edge));
  sam_call(SamEdgeDestroy(&edge));
  HertzErrors(c, point, x, y, h.errors);
  h.area     = fabs(NumberOf(c, "contact_area") / (PETSC_PI * c->s.a * c->s.a) - 1);
  h.approach = fabs((double)step->rigid[SAM_COMPONENT_N] / (c->s.a * c->s.a / c->s.R) - 1);
  if (getenv("SAM_SHOW"))
    print_message("# %d cells: p %g, area %g, approach %g\n", (int)c->s.grid->nx, h.errors[1], h.area, h.approach);
  sam_call(VecDestroy(&point));
  return h;
}

/* A sphere pressed off the grid's centre; the plain errors of p, area and approach are 7e-3, 1e-2 and 9e-5. */
static void test_correction_makes_hertz_exact(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    Case     c = NewBeside(Steel(), 64, 1.5, places[k][0], places[k][1], 0, DEFERRED);
    SamStep  step;
    Hertzian h;

    sam_call(SamContactTry(c.contact, &SolutionOf(&c)->control, &step));
    AssertGood(&step);
    sam_assert(NumberOf(&c, "edge_passes") == 2 && NumberOf(&c, "edge_accepted") == 1);
    h = Measure(&c, &step, places[k][0], places[k][1]);
    sam_assert(h.errors[1] < 4e-4);
    sam_assert(h.area < 5e-5);
    sam_assert(h.approach < 5e-6);
    sam_assert_close(NumberOf(&c, "stored_energy") / (0.4 * c.s.N * c.s.a * c.s.a / c.s.R), 1, 5e-5); /* plain: 2e-4 */
    DestroyCase(&c);
  }
}

/* Approach and area are of second order, with a constant that is a fraction of the plain one's. */
static void test_correction_gains_on_all_grids(void **state)
{
  (void)state;
  for (PetscInt n = 32; n <= 96; n += 32) {
    Hertzian h[2];

    for (int deferred = 0; deferred < 2; deferred++) {
      Case    c = NewBeside(Steel(), n, 1.5, 0.33, 0.49, 0, deferred ? DEFERRED : "-edges none");
      SamStep step;

      sam_call(SamContactTry(c.contact, &SolutionOf(&c)->control, &step));
      h[deferred] = Measure(&c, &step, 0.33, 0.49);
      DestroyCase(&c);
    }
    sam_assert(h[1].errors[1] < h[0].errors[0] / 10);
    sam_assert(h[1].area < h[0].area / 20);
    sam_assert(h[1].approach < h[0].approach / 10);
  }
}

/* ---- control ---- */

/*
  The displacements that a force and moments lead to lead back to them, all prescribed or some: up to what the passes,
  which start from another plain solution, leave of the error.
*/
static void test_correction_under_forces_and_displacements_is_the_same(void **state)
{
  Case       c[2];
  SamControl control;
  SamStep    step[2];

  (void)state;
  for (int k = 0; k < 2; k++) c[k] = NewCase(Steel(), 63, 1.6, 0, DEFERRED " -normal_rtol 1e-10");
  control                         = Loads(&c[0], 1, 0, 0, 0);
  control.value[SAM_COMPONENT_MY] = 0.1 * c[0].s.N * c[0].s.a;
  step[0]                         = Try(&c[0], &control);
  for (int mixed = 0; mixed < 2; mixed++) {
    Displace(&control, SAM_COMPONENT_N, (double)step[0].rigid[SAM_COMPONENT_N]);
    if (!mixed) Displace(&control, SAM_COMPONENT_MY, (double)step[0].rigid[SAM_COMPONENT_MY]);
    if (mixed) {
      control.force[SAM_COMPONENT_MY] = PETSC_TRUE;
      control.value[SAM_COMPONENT_MY] = 0.1 * c[0].s.N * c[0].s.a;
    }
    step[1] = Try(&c[1], &control);
    sam_assert(NumberOf(&c[0], "edge_passes") == 2 && NumberOf(&c[1], "edge_passes") == 2);
    sam_assert_close(step[1].load[SAM_COMPONENT_N], c[0].s.N, 1e-5 * c[0].s.N);
    sam_assert_close(step[1].load[SAM_COMPONENT_MY], 0.1 * c[0].s.N * c[0].s.a, 1e-5 * c[0].s.N * c[0].s.a);
    sam_assert(Difference(SolutionOf(&c[0])->pressure, SolutionOf(&c[1])->pressure, NORM_2) < 2e-4);
  }
  for (int k = 0; k < 2; k++) DestroyCase(&c[k]);
}

/* ---- histories ---- */

static Vec PressureOf(const Case *c)
{
  return Copy(SolutionOf(c)->pressure);
}

/*
  A step at the same normal load keeps pressure and correction; a state goes on in another contact, and a rejected try
  leaves no trace, all to the last bit.
*/
static void test_correction_belongs_to_the_state(void **state)
{
  Case       c = NewCase(Steel(), 45, 1.5, 0, DEFERRED), other = NewCase(Steel(), 45, 1.5, 0, DEFERRED);
  SamControl control = Loads(&c, 1, 0, 0, 0), next = Loads(&c, 1, 0, 0, 0), more = Loads(&c, 1.4, 0, 0, 0);
  SamStep    step[3];
  SamState   now;
  double     area;

  (void)state;
  step[0] = Solve(&c, &control);
  AssertGood(&step[0]);
  sam_call(SamContactGetState(c.contact, &now));
  area = NumberOf(&c, "contact_area");
  sam_call(SamContactSetState(other.contact, now, PETSC_TRUE));
  for (int k = 0; k < 3; k++) { /* with other passes, with too few cells for them, without contact */
    (void)Try(&other, &(SamControl[]){more, Loads(&c, 1e-3, 0, 0, 0), Loads(&c, 0, 0, 0, 0)}[k]);
    sam_assert(NumberOf(&other, "edge_passes") == (k ? 0 : 2));
    sam_call(SamContactReject(other.contact));
  }
  step[1] = Solve(&c, &next);
  step[2] = Solve(&other, &next);
  AssertGood(&step[1]);
  sam_assert(NumberOf(&c, "normal_iterations") == 0 && NumberOf(&c, "edge_passes") == 2);
  sam_assert(NumberOf(&c, "contact_area") == area);
  AssertSameSteps(&c, &step[1], &other, &step[2]);
  sam_assert(SameBitsOf(&c, &other, PressureOf) && SameBitsOf(&c, &other, NewSlip) && SameBitsOf(&c, &other, NewGap));
  DestroyCase(&c);
  DestroyCase(&other);
}

static void test_correction_does_not_depend_on_the_ranks(void **state)
{
  Case    c[2];
  double *whole[2];
  SamStep step[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    c[k] = NewCaseOn(NewSphereOn(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, Steel(), 47, 1.5, 0, 0), 0, NULL, DEFERRED);
    SamControl control = Loads(&c[k], 1, 0, 0, 0);

    control.value[SAM_COMPONENT_MX] = 0.07 * c[k].s.N * c[k].s.a;
    step[k]                         = Try(&c[k], &control);
    whole[k]                        = Whole(c[k].s.grid, 1, SolutionOf(&c[k])->pressure);
  }
  sam_assert(NumberOf(&c[0], "edge_passes") == 2);
  sam_assert(NumberOf(&c[0], "contact_area") == NumberOf(&c[1], "contact_area"));
  sam_assert(SameNumbers(SAM_COMPONENTS, step[0].rigid, step[1].rigid));
  sam_assert(!memcmp(whole[0], whole[1], sizeof(double) * 47 * 47));
  for (int k = 0; k < 2; k++) {
    free(whole[k]);
    DestroyCase(&c[k]);
  }
}

/* ---- what is refused, and what the check sees ---- */

/* Spots of a few cells: the plain solution stays, to the last bit, and each step says so, also if nothing changes. */
static void test_edges_that_are_not_smooth_are_left(void **state)
{
  Case c[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SamStep step;
    Vec     h, rough;

    c[k]  = NewCase(Steel(), 40, 1.5, 0, k ? DEFERRED : "");
    rough = NewRandom(c[k].s.grid, 1, 3);
    sam_call(SamProblemGetGap(c[k].problem, &h));
    sam_call(VecAXPY(h, 0.1 * c[k].s.a * c[k].s.a / c[k].s.R, rough));
    sam_call(VecDestroy(&rough));
    step = Solve(&c[k], &(SamControl[]){Loads(&c[k], 0.2, 0, 0, 0)}[0]);
    sam_assert(step.status == SAM_STATUS_CONVERGED && (!k || NumberOf(&c[k], "edge_passes") == 0));
    sam_assert(!k || (strstr(step.message, "not corrected: 0 % of it is smooth") && !strcmp(step.setting, "edges")));
  }
  sam_assert(SameBitsOf(&c[0], &c[1], PressureOf));
  sam_assert(strstr(Try(&c[1], &(SamControl[]){Loads(&c[1], 0.2, 0, 0, 0)}[0]).message, "not corrected"));
  for (int k = 0; k < 2; k++) DestroyCase(&c[k]);
}

/* Without contact, and where the contact ends at the grid's border only, there is no edge to correct for. */
static void test_contact_without_an_edge_is_left(void **state)
{
  Case       c       = NewCase(Steel(), 24, 0.5, 0, DEFERRED " -allow_edge_contact");
  SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStep    step    = Try(&c, &control);

  (void)state;
  sam_assert(NumberOf(&c, "contact_cells") == 24 * 24 && NumberOf(&c, "edge_passes") == 0);
  Displace(&control, SAM_COMPONENT_N, -1e-6);
  step = Try(&c, &control);
  sam_assert(NumberOf(&c, "contact_cells") == 0 && NumberOf(&c, "edge_passes") == 0 &&
             step.status == SAM_STATUS_CONVERGED);
  DestroyCase(&c);
}

/* A state that was solved in another way is not taken over, although nothing that is prescribed has changed. */
static void test_pressure_is_that_of_the_way_that_is_asked_for(void **state)
{
  Case             c       = NewCase(Steel(), 45, 1.5, 0, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  double           cells;
  SamLaw           law;

  (void)state;
  (void)Solve(&c, &control);
  cells = NumberOf(&c, "contact_cells");
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_DEFERRED, &law));
  (void)Solve(&c, &control);
  sam_assert(NumberOf(&c, "edge_passes") == 2 && NumberOf(&c, "contact_cells") > cells); /* with the rim */
  sam_call(SamLawSetEdgePasses(law, 1));
  (void)Solve(&c, &control);
  sam_assert(NumberOf(&c, "edge_passes") == 1);
  sam_fails(SamLawSetEdgePasses(law, 0), PETSC_ERR_ARG_OUTOFRANGE);
  DestroyCase(&c);
}

/* A plain shear under a corrected pressure would be less exact than without the correction. */
static void test_correction_with_friction_is_refused(void **state)
{
  Case             c       = NewCase(Steel(), 24, 1.5, 0.3, DEFERRED);
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStep          step;

  (void)state;
  sam_fails(SamContactTry(c.contact, &control, &step), SAM_ERR_USER);
  DestroyCase(&c);
}

/* Cells that the edge cuts and whose centres are outside do not count for the largest slip, here of a rotation. */
static void test_slip_is_that_of_cells_in_contact(void **state)
{
  Case               c       = NewBeside(Steel(), 45, 1.5, 0.13, 0.27, 0, DEFERRED);
  SamControl         control = Loads(&c, 1, 0, 0, 0);
  const PetscReal    angle   = 1e-6;
  const SamGrid      grid    = c.s.grid;
  double             most    = 0;
  const PetscReal   *p, *least;
  const SamSolution *s;
  SamState           memory;
  SamStep            step;
  Vec                rim;

  (void)state;
  Displace(&control, SAM_COMPONENT_MZ, angle);
  step = Try(&c, &control);
  AssertGood(&step);
  s = SolutionOf(&c);
  sam_call(VecGetArrayRead(s->pressure, &p));
  sam_call(SamContactGetState(c.contact, &memory));
  rim = SamStateReadField(memory, SamStateFindField(memory, "edge_rim"));
  sam_call(VecGetArrayRead(rim, &least));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (p[k] > least[k])
      most = PetscMax(most, hypot(SamGridX(grid, k % grid->nx), SamGridY(grid, grid->row_start + k / grid->nx)));
  sam_call(VecRestoreArrayRead(rim, &least));
  sam_call(VecRestoreArrayRead(s->pressure, &p));
  sam_call(SamMax(PETSC_COMM_WORLD, 1, &most));
  sam_assert_close(NumberOf(&c, "slip_max"), angle * most, 1e-9 * angle * most);
  DestroyCase(&c);
}

/* The normal error of a corrected solution, by a memory in which a field is forgotten; NULL: none is. */
static double ErrorWithout(const Case *c, SamState memory, const char *forgotten)
{
  SamSolution s = *SolutionOf(c);
  SamState    other;
  SamCheck    check;
  Vec         field;

  sam_call(SamStateCreateLike(memory, &other));
  sam_call(SamStateCopy(memory, other));
  if (forgotten) {
    sam_call(SamStateRestoreField(other, SamStateFindField(other, forgotten), SAM_COMMITTED, &field));
    sam_assert(Norm(field, NORM_INFINITY) > 0);
    sam_call(VecSet(field, 0));
  }
  sam_call(SamCheckSolution(c->problem, other, PETSC_TRUE, PETSC_FALSE, NULL, &s, &check));
  sam_call(SamStateDestroy(&other));
  return (double)check.normal;
}

/* The check of a corrected solution is as strict as that of a plain one. */
static void test_check_sees_what_is_wrong_with_a_correction(void **state)
{
  Case             c       = NewCase(Steel(), 45, 1.5, 0, DEFERRED);
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  const SamStep    step    = Solve(&c, &control);
  SamState         memory;

  (void)state;
  AssertGood(&step);
  sam_call(SamContactGetState(c.contact, &memory));
  sam_assert(ErrorWithout(&c, memory, NULL) == (double)step.check.normal);
  sam_assert(ErrorWithout(&c, memory, "edge_correction") > 1e-5);
  sam_assert(ErrorWithout(&c, memory, "edge_rim") > 1e-5); /* its cells do not touch */
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_linear_pressure_displaces_as_its_sub_cells),
    cmocka_unit_test(test_sub_cells_add_up_to_the_cell),
    cmocka_unit_test(test_correction_makes_hertz_exact),
    cmocka_unit_test(test_correction_gains_on_all_grids),
    cmocka_unit_test(test_correction_under_forces_and_displacements_is_the_same),
    cmocka_unit_test(test_correction_belongs_to_the_state),
    cmocka_unit_test(test_correction_does_not_depend_on_the_ranks),
    cmocka_unit_test(test_edges_that_are_not_smooth_are_left),
    cmocka_unit_test(test_contact_without_an_edge_is_left),
    cmocka_unit_test(test_pressure_is_that_of_the_way_that_is_asked_for),
    cmocka_unit_test(test_correction_with_friction_is_refused),
    cmocka_unit_test(test_slip_is_that_of_cells_in_contact),
    cmocka_unit_test(test_check_sees_what_is_wrong_with_a_correction),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

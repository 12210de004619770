/*
 * The check of a solution: a right solution passes, and each kind of error is found.
 */
#include "contacts.h"

/* Errors are made in a copy of the solution. */
typedef void (*Spoil)(const Case *c, SamSolution *s);

/* Solves, spoils the solution, and checks what is left. */
static SamCheck CheckSpoilt(Spoil spoil)
{
  Case             c       = NewCase(Steel(), 48, 1.5, MU, "");
  const SamControl control = Loads(&c, 1, 0.5, 0.2, 0.1);
  const SamStep    step    = Solve(&c, &control);
  SamSolution      s       = *SolutionOf(&c); /* the fields are the contact's, which is not used again */
  SamCheck         check;

  AssertGood(&step);
  if (spoil) spoil(&c, &s);
  sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_FALSE, NULL, &s, &check));
  if (getenv("SAM_SHOW"))
    print_message("# spoilt: %g %g %g %g %g\n", (double)check.normal, (double)check.tangential,
                  (double)check.equilibrium, (double)check.cone, (double)check.edge);
  DestroyCase(&c);
  return check;
}

static void test_check_agrees_with_itself(void **state)
{
  const SamCheck check = CheckSpoilt(NULL);

  (void)state;
  sam_assert(check.normal < 2e-8 && check.tangential < 2e-6 && check.equilibrium < 1e-11 && check.cone < 1e-13 &&
             check.edge == 0);
}

/* ---- pressure ---- */

static void AddPressure(const Case *c, SamSolution *s)
{
  AddAt(c->s.grid, 0, 20, 25, 0.01 * c->s.p0, s->pressure);
}

static void test_check_finds_wrong_pressure_in_one_cell(void **state)
{
  const SamCheck check = CheckSpoilt(AddPressure);

  (void)state;
  sam_assert(check.normal > 1e-4); /* 1 % of a cell's self-influence, about 1/n of the displacement */
  sam_assert(check.equilibrium > 1e-6);
}

static void AddTension(const Case *c, SamSolution *s)
{
  AddAt(c->s.grid, 0, 1, 1, -1e-3 * c->s.p0, s->pressure);
}

static void test_check_finds_tension(void **state)
{
  const SamCheck check = CheckSpoilt(AddTension);

  (void)state;
  sam_assert(check.normal > 0.9e-3);
  sam_assert(check.cone < 1e-13); /* a cell in tension has the bound 0, which its shear of 0 does not exceed */
}

static void AddPressureOutside(const Case *c, SamSolution *s)
{
  AddAt(c->s.grid, 0, 0, 30, 1e-6 * c->s.p0, s->pressure);
}

static void test_check_finds_pressure_across_a_gap_and_at_the_edge(void **state)
{
  const SamCheck check = CheckSpoilt(AddPressureOutside);

  (void)state;
  sam_assert(check.normal > 0.1); /* the gap there is as large as the approach */
  sam_assert_close(check.edge, 1e-6, 1e-8);
}

/* Pressure at each of the four borders. */
static void AddAtBorder(const Case *c, SamSolution *s)
{
  static const PetscInt at[4][2] = {{0, 20}, {47, 20}, {20, 0}, {20, 47}};

  for (int k = 0; k < 4; k++) {
    Vec      p = Copy(s->pressure);
    SamCheck check;
    Vec      own = s->pressure;

    AddAt(c->s.grid, 0, at[k][0], at[k][1], 1e-6 * c->s.p0, p);
    s->pressure = p;
    sam_call(SamCheckSolution(c->problem, NULL, PETSC_TRUE, PETSC_FALSE, NULL, s, &check));
    sam_assert_close(check.edge, 1e-6, 1e-8);
    s->pressure = own;
    sam_call(VecDestroy(&p));
  }
}

static void test_check_looks_at_all_four_borders(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(AddAtBorder).edge == 0);
}

/* A cell of the contact's rim that bears nothing: the surfaces would penetrate there. */
static void RemovePressure(const Case *c, SamSolution *s)
{
  const PetscInt k = CellAt(c->s.grid, 24 - 15, 24); /* r = 0.91 a */
  double        *p;

  sam_call(VecGetArray(s->pressure, &p));
  if (k >= 0) p[k] = 0;
  sam_call(VecRestoreArray(s->pressure, &p));
}

static void test_check_finds_penetration_outside_of_contact(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(RemovePressure).normal > 1e-3);
}

/* Bodies that interpenetrate, and do not press on each other at all. */
static void PushWithoutPressure(const Case *c, SamSolution *s)
{
  (void)c;
  sam_call(VecSet(s->pressure, 0));
  sam_call(VecSet(s->shear, 0));
  s->control.force[SAM_COMPONENT_N] = PETSC_FALSE;
}

static void test_check_finds_penetration_without_any_contact(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(PushWithoutPressure).normal > 0.1);
}

/* ---- shear ---- */

/* Multiplies the shear of a cell at the contact's rim, where it slips. */
static void ScaleShearAtRim(const Case *c, double factor, SamSolution *s)
{
  const PetscInt k = CellAt(c->s.grid, 24 - 15, 24); /* r = 0.91 a */
  double        *q;

  sam_call(VecGetArray(s->shear, &q));
  if (k >= 0) {
    q[k] *= factor;
    q[k + c->s.grid->cells] *= factor;
  }
  sam_call(VecRestoreArray(s->shear, &q));
}

/* Cone and size are as before. */
static void FlipShear(const Case *c, SamSolution *s)
{
  ScaleShearAtRim(c, -1, s);
}

static void test_check_finds_shear_against_its_direction(void **state)
{
  const SamCheck check = CheckSpoilt(FlipShear);

  (void)state;
  sam_assert(check.tangential > 1e-2);
  sam_assert(check.cone < 1e-13);
  sam_assert(check.equilibrium > 1e-5);
}

static void EaseShear(const Case *c, SamSolution *s)
{
  ScaleShearAtRim(c, 0.9, s);
}

/* The shear is within the cone, so the cell should stick, but it slips. */
static void test_check_finds_slip_within_the_cone(void **state)
{
  const SamCheck check = CheckSpoilt(EaseShear);

  (void)state;
  sam_assert(check.tangential > 1e-4 && check.cone < 1e-13);
}

static void StretchShear(const Case *c, SamSolution *s)
{
  (void)c;
  sam_call(VecScale(s->shear, 1.01));
}

static void test_check_finds_shear_beyond_the_cone(void **state)
{
  const SamCheck check = CheckSpoilt(StretchShear);

  (void)state;
  sam_assert(check.cone > 5e-3 &&
             check.cone < 1.01e-2); /* 1 % where it slips, where mu p is somewhat below its largest */
  sam_assert(check.tangential > 1e-4);
  sam_assert(check.equilibrium > 5e-3);
}

/* ---- displacements ---- */

static void LiftBody(const Case *c, SamSolution *s)
{
  (void)c;
  s->rigid[SAM_COMPONENT_N] *= 1 + 1e-4;
}

static void TurnBody(const Case *c, SamSolution *s)
{
  s->rigid[SAM_COMPONENT_MX] += 1e-4 * c->s.a / c->s.R;
}

static void TurnBodyAboutY(const Case *c, SamSolution *s)
{
  s->rigid[SAM_COMPONENT_MY] += 1e-4 * c->s.a / c->s.R;
}

static void test_check_finds_wrong_normal_displacement(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(LiftBody).normal > 0.9e-4);
  sam_assert(CheckSpoilt(TurnBody).normal > 0.9e-4);
  sam_assert(CheckSpoilt(TurnBodyAboutY).normal > 0.9e-4);
}

static void ShiftBody(const Case *c, SamSolution *s)
{
  (void)c;
  s->rigid[SAM_COMPONENT_TX] *= 1 + 1e-3;
}

static void ShiftBodyAlongY(const Case *c, SamSolution *s)
{
  (void)c;
  s->rigid[SAM_COMPONENT_TY] *= 1 + 1e-3;
}

static void TwistBody(const Case *c, SamSolution *s)
{
  (void)c;
  s->rigid[SAM_COMPONENT_MZ] *= 1.01;
}

static void test_check_finds_wrong_tangential_displacement(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(ShiftBody).tangential > 1e-4);
  sam_assert(CheckSpoilt(ShiftBodyAlongY).tangential > 1e-4);
  sam_assert(CheckSpoilt(TwistBody).tangential > 1e-4);
}

/* What is wrong along y counts as much as what is wrong along x. */
static void test_check_weighs_both_directions_alike(void **state)
{
  double found[2];

  (void)state;
  for (int y = 0; y < 2; y++) {
    Case             c       = NewCase(Steel(), 48, 1.5, MU, "");
    const SamControl control = Loads(&c, 1, y ? 0 : 0.5, y ? 0.5 : 0, 0);
    const SamStep    step    = Solve(&c, &control);
    SamSolution      s       = *SolutionOf(&c);
    SamCheck         check;

    AssertGood(&step);
    s.rigid[y ? SAM_COMPONENT_TY : SAM_COMPONENT_TX] *= 1 + 1e-2;
    sam_call(SamCheckSolution(c.problem, NULL, PETSC_TRUE, PETSC_FALSE, NULL, &s, &check));
    found[y] = check.tangential;
    DestroyCase(&c);
  }
  sam_assert(found[0] > 1e-4);
  sam_assert_close(found[1], found[0], 1e-4 * found[0]); /* rtol over the error */
}

/* The stretch is part of the slip, so one that was not there when it was solved is found. */
static void StretchBody(const Case *c, SamSolution *s)
{
  Prescribe(c->problem, &s->control, "bulk2_stress_yy",
            1e-3 * MU * c->s.a / c->s.R * c->s.pair->body[1]->material[0].young);
}

static void test_check_finds_wrong_stretch(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(StretchBody).tangential > 1e-4);
}

/* ---- loads ---- */

static PetscInt wrong; /* the component whose load is changed after the solve */

static void ChangeLoad(const Case *c, SamSolution *s)
{
  const PetscBool moment = wrong >= SAM_COMPONENT_MX;

  s->control.value[wrong] += 1e-6 * c->s.N * (moment ? c->s.a : 1);
}

static void test_check_finds_each_load_out_of_equilibrium(void **state)
{
  (void)state;
  for (wrong = 0; wrong < SAM_COMPONENTS; wrong++) {
    const SamCheck check = CheckSpoilt(ChangeLoad);

    /* moments by the grid's half width, 1.5 a; shears by their sum, some 0.5 mu N */
    sam_assert(check.equilibrium > 0.6e-6 && check.equilibrium < 1e-5);
    sam_assert(check.normal < 2e-8 && check.tangential < 2e-6 && check.cone < 1e-13);
  }
}

static void ChangeFreeLoad(const Case *c, SamSolution *s)
{
  ChangeLoad(c, s);
  s->control.force[wrong] = PETSC_FALSE;
}

/* A component given by its displacement has no load that could be wrong. */
static void test_check_asks_no_equilibrium_of_given_displacements(void **state)
{
  (void)state;
  for (wrong = 0; wrong < SAM_COMPONENTS; wrong++) sam_assert(CheckSpoilt(ChangeFreeLoad).equilibrium < 1e-11);
}

/* ---- not a number ---- */

static void PutNanIntoPressure(const Case *c, SamSolution *s)
{
  AddAt(c->s.grid, 0, 20, 40, NAN, s->pressure);
}

static void PutNanIntoShear(const Case *c, SamSolution *s)
{
  AddAt(c->s.grid, 1, 20, 40, NAN, s->shear);
}

static void PutNanIntoDisplacement(const Case *c, SamSolution *s)
{
  (void)c;
  s->rigid[SAM_COMPONENT_N]  = NAN;
  s->rigid[SAM_COMPONENT_MZ] = NAN;
}

/* Everything that compares with a tolerance must fail. */
static void test_nan_does_not_pass_the_check(void **state)
{
  SamCheck check;

  (void)state;
  check = CheckSpoilt(PutNanIntoPressure);
  sam_assert(!(check.normal < 1));
  check = CheckSpoilt(PutNanIntoShear);
  sam_assert(!(check.tangential < 1));
  check = CheckSpoilt(PutNanIntoDisplacement);
  sam_assert(!(check.normal < 1) && !(check.tangential < 1));
}

static void test_nan_is_no_equilibrium(void **state)
{
  (void)state;
  sam_assert(!(CheckSpoilt(PutNanIntoPressure).equilibrium < 1));
  sam_assert(!(CheckSpoilt(PutNanIntoShear).equilibrium < 1));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_check_agrees_with_itself),
    cmocka_unit_test(test_check_finds_wrong_pressure_in_one_cell),
    cmocka_unit_test(test_check_finds_tension),
    cmocka_unit_test(test_check_finds_pressure_across_a_gap_and_at_the_edge),
    cmocka_unit_test(test_check_looks_at_all_four_borders),
    cmocka_unit_test(test_check_finds_penetration_outside_of_contact),
    cmocka_unit_test(test_check_finds_penetration_without_any_contact),
    cmocka_unit_test(test_check_finds_shear_against_its_direction),
    cmocka_unit_test(test_check_finds_slip_within_the_cone),
    cmocka_unit_test(test_check_finds_shear_beyond_the_cone),
    cmocka_unit_test(test_check_finds_wrong_normal_displacement),
    cmocka_unit_test(test_check_finds_wrong_tangential_displacement),
    cmocka_unit_test(test_check_weighs_both_directions_alike),
    cmocka_unit_test(test_check_finds_wrong_stretch),
    cmocka_unit_test(test_check_finds_each_load_out_of_equilibrium),
    cmocka_unit_test(test_check_asks_no_equilibrium_of_given_displacements),
    cmocka_unit_test(test_nan_does_not_pass_the_check),
    cmocka_unit_test(test_nan_is_no_equilibrium),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * The problem of a contact may change between steps: the gap, and the friction as a number or a field.
 */
#include "contacts.h"

/* ---- the gap ---- */

static SamStep StepTo(const Case *c, double N, double x)
{
  const SamControl control = Loads(c, N, x, 0, 0);

  return Solve(c, &control);
}

/* The same without rotation: a sphere that may roll finds the same pressure under another slope. */
static SamStep StepUpright(const Case *c, double N, double x)
{
  SamControl control = Loads(c, N, x, 0, 0);

  HoldRotations(&control);
  return Solve(c, &control);
}

/* A sphere of which the lowest point lies at x = 0.8 a. */
static double Shifted(double x, double y, const void *s)
{
  const Sphere *sphere = (const Sphere *)s;
  const double  dx     = x - 0.8 * sphere->a;

  return (dx * dx + y * y) / (2 * sphere->R);
}

static void test_gap_that_is_changed_in_place_finds_a_new_pressure(void **state)
{
  Case          c     = NewCase(Steel(), 48, 2, MU, "");
  const SamStep first = StepUpright(&c, 1, 0.3);
  Vec           gap;
  SamStep       second;

  (void)state;
  gap = SamProblemGetGap(c.problem);
  for (PetscInt j = 20; j < 28; j++) AddAt(c.s.grid, 0, 24, j, -1e-6, gap); /* through VecGetArray() */
  second = StepUpright(&c, 1, 0.3);
  AssertGood(&second);
  sam_assert(NumberOf(&c, "normal_iterations") > 0);
  sam_assert(fabs(second.rigid[SAM_COMPONENT_N] - first.rigid[SAM_COMPONENT_N]) > 1e-4 * first.rigid[SAM_COMPONENT_N]);
  second = StepUpright(&c, 1, 0.3);
  AssertGood(&second);
  sam_assert(NumberOf(&c, "normal_iterations") == 0); /* now it is known */
  DestroyCase(&c);
}

/* PETSc counts the changes of a vector on each rank for itself. */
static void test_gap_may_be_changed_on_one_rank_alone(void **state)
{
  Case    c = NewCase(Steel(), 48, 2, MU, "");
  Vec     gap;
  SamStep step;

  (void)state;
  (void)StepUpright(&c, 1, 0.3);
  gap = SamProblemGetGap(c.problem);
  if (c.s.grid->row_start == 0) {
    double *h;

    if (VecGetArray(gap, &h) || c.s.grid->rows < 1) MPI_Abort(PETSC_COMM_WORLD, 1);
    for (PetscInt k = 0; k < c.s.grid->cells; k++) h[k] *= 1.1;
    if (VecRestoreArray(gap, &h)) MPI_Abort(PETSC_COMM_WORLD, 1);
  }
  step = StepUpright(&c, 1, 0.3);
  AssertGood(&step);
  sam_assert(NumberOf(&c, "normal_iterations") > 0);
  DestroyCase(&c);
}

static void test_setting_a_gap_raises_its_revision(void **state)
{
  Case             c = NewCase(Steel(), 20, 2, MU, "");
  PetscObjectState before, after;
  Vec              gap;

  (void)state;
  sam_call(SamProblemGetRevision(c.problem, &before));
  gap = SamProblemGetGap(c.problem);
  sam_call(SamProblemGetRevision(c.problem, &after));
  sam_assert(after == before);
  sam_call(SamProblemSetGap(c.problem, c.s.h));
  sam_call(SamProblemGetRevision(c.problem, &after));
  sam_assert(after > before && SameBits(gap, c.s.h));
  DestroyCase(&c);
}

/*
  Slip is remembered by place: where the contact has moved to, cells that stick have the slip that they had when they
  were open, and those that are open have the one that follows from the displacements.
*/
static void test_slip_stays_with_its_place_when_the_gap_changes(void **state)
{
  Case          c        = NewCase(Steel(), 61, 2.5, MU, "");
  double        found[2] = {0, 0}; /* cells that stick, and were open; largest change of slip there */
  const double *before, *after, *states, *p;
  Vec           slip[2], pressure, now, h = NewFrom(c.s.grid, Shifted, &c.s);
  SamStep       step;

  (void)state;
  (void)StepUpright(&c, 1, 0.5);
  slip[0]  = NewSlip(&c);
  pressure = Copy(SolutionOf(&c)->pressure);
  sam_call(SamProblemSetGap(c.problem, h));
  step = StepUpright(&c, 1, 0.6);
  AssertGood(&step);
  slip[1] = NewSlip(&c);
  now     = NewState(&c);
  sam_call(VecGetArrayRead(slip[0], &before));
  sam_call(VecGetArrayRead(slip[1], &after));
  sam_call(VecGetArrayRead(pressure, &p));
  sam_call(VecGetArrayRead(now, &states));
  for (PetscInt k = 0; k < c.s.grid->cells; k++)
    if (states[k] == SAM_CELL_STICK && p[k] == 0) {
      found[0] += 1;
      found[1] = fmax(found[1], hypot(after[k] - before[k], after[k + c.s.grid->cells] - before[k + c.s.grid->cells]));
    }
  sam_call(VecRestoreArrayRead(now, &states));
  sam_call(VecRestoreArrayRead(pressure, &p));
  sam_call(VecRestoreArrayRead(slip[1], &after));
  sam_call(VecRestoreArrayRead(slip[0], &before));
  (void)MPI_Allreduce(MPI_IN_PLACE, &found[0], 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  sam_assert(found[0] > 50);
  sam_assert(found[1] < 1e-5 * MU * c.s.a * c.s.a / c.s.R); /* rtol of the shear, of the largest displacement */
  sam_assert(Norm(slip[0], NORM_INFINITY) > 0.1 * MU * c.s.a * c.s.a / c.s.R);
  for (int k = 0; k < 2; k++) sam_call(VecDestroy(&slip[k]));
  sam_destroy(&pressure, &now, &h);
  DestroyCase(&c);
}

/* A state's pressure belongs to the gap it was solved with. If the state claims another gap, the check finds out. */
static void test_state_of_another_gap_is_solved_anew(void **state)
{
  (void)state;
  for (int told = 0; told < 2; told++) {
    Case      one = NewCase(Steel(), 48, 2.5, MU, ""), other = NewCase(Steel(), 48, 2.5, MU, "");
    Vec       h = NewFrom(other.s.grid, Shifted, &other.s);
    SamState  held;
    PetscBool current;
    SamStep   step;

    sam_call(SamProblemSetGap(other.problem, h));
    (void)StepUpright(&one, 1, 0.3);
    sam_call(SamContactGetState(one.contact, &held));
    sam_call(SamContactIsGapCurrent(one.contact, &current));
    sam_assert(current);
    sam_call(SamContactSetState(other.contact, held, told == 0));
    step = StepUpright(&other, 1, 0.3);
    if (told) {
      AssertGood(&step);
      sam_assert(NumberOf(&other, "normal_iterations") > 0);
    } else
      sam_assert(step.status == SAM_STATUS_NOT_CONVERGED && strstr(step.message, "check disagrees"));
    sam_call(VecDestroy(&h));
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

/* ---- friction ---- */

static double Constant(double x, double y, const void *value)
{
  (void)x;
  (void)y;
  return *(const double *)value;
}

static void SetField(const Case *c, double (*value)(double, double, const void *), const void *context)
{
  Vec field = NewFrom(c->s.grid, value, context);

  sam_call(SamProblemSetFrictionField(c->problem, field));
  sam_call(VecDestroy(&field));
}

static void test_constant_field_is_the_number_to_the_last_bit(void **state)
{
  static const double T[] = {0.2, 0.5, 0.8, 0.3}, mu = MU;

  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    Case one   = NewCase(kind ? Dissimilar() : Steel(), 45, 2, MU, ""),
         other = NewCase(kind ? Dissimilar() : Steel(), 45, 2, 0.1, "");

    other.friction = MU; /* by which loads are measured */
    SetField(&other, Constant, &mu);
    for (int k = 0; k < 4; k++) {
      const SamStep a = StepTo(&one, 1, T[k]), b = StepTo(&other, 1, T[k]);

      AssertSameSteps(&one, &a, &other, &b);
      AssertSameFields(&one, &other);
    }
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

/* The bound of half the friction is, by powers of 2, that of the scale 0.5 to the last bit. */
static void test_friction_scale_is_a_factor_on_number_and_field(void **state)
{
  static const double T[] = {0.2, 0.4, 0.3}, half = 0.5 * MU, full = MU;

  (void)state;
  for (int field = 0; field < 2; field++) {
    Case one = NewCase(Steel(), 45, 2, MU, ""), other = NewCase(Steel(), 45, 2, MU, "");

    for (int k = 0; k < 3; k++) {
      SamControl whole = Loads(&one, 1, T[k], 0, 0), scaled = whole;
      SamStep    a, b;

      Prescribe(other.problem, &scaled, "friction_scale", k == 1 ? 1 : 0.5);
      if (field) {
        SetField(&one, Constant, k == 1 ? &full : &half);
        SetField(&other, Constant, &full);
      } else
        sam_call(SamProblemSetFriction(one.problem, k == 1 ? full : half));
      a = Solve(&one, &whole);
      b = Solve(&other, &scaled);
      AssertGood(&a);
      AssertSameSteps(&one, &a, &other, &b);
      AssertSameFields(&one, &other);
    }
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

static void test_friction_that_falls_below_the_shear_makes_it_slip(void **state)
{
  Case       c     = NewCase(Steel(), 48, 1.5, MU, "");
  SamStep    high  = StepTo(&c, 1, 0.3), low;
  double     stick = NumberOf(&c, "stick_area");
  SamControl same = Loads(&c, 1, 0.3, 0, 0), less = same;

  (void)state;
  Prescribe(c.problem, &same, "friction_scale", 0.4); /* |T| = 0.3 mu N is now 0.75 of the limit */
  low = Solve(&c, &same);
  AssertGood(&high);
  AssertGood(&low);
  sam_assert(NumberOf(&c, "normal_iterations") == 0); /* the pressure does not know it */
  sam_assert(NumberOf(&c, "stick_area") < 0.7 * stick);
  sam_assert(NumberOf(&c, "dissipated_energy") > 0);
  Prescribe(c.problem, &less, "friction_scale", 0.29); /* less than the load needs */
  sam_assert(Try(&c, &less).status == SAM_STATUS_NO_EQUILIBRIUM);
  Prescribe(c.problem, &less, "friction_scale", 0);
  sam_assert(Try(&c, &less).status == SAM_STATUS_NO_EQUILIBRIUM);
  DestroyCase(&c);
}

static const double stripes[2] = {0.05, 0.5};

/* Stripes along y, an eighth of a wide. */
static double Stripes(double x, double y, const void *a)
{
  (void)y;
  return stripes[(int)floor(8 * x / *(const double *)a) & 1];
}

/* How far a cell violates Coulomb's law. */
typedef struct {
  double cone, stick, direction; /* over the bound; slip of what sticks; slip along the shear or across it */
  double cells[2][3];            /* how many there are: by stripe, then state */
} Violations;

static void CheckCell(SamGrid grid, PetscInt k, double p, double qx, double qy, const double s[2], Violations *v)
{
  const double mu = stripes[(int)floor(8 * SamGridX(grid, k % grid->nx) / 1e-3) & 1], q = hypot(qx, qy);
  const int    stripe = mu > 0.1 ? 1 : 0, slips = q >= (1 - SAM_SLIP_MARGIN) * mu * p;

  v->cells[stripe][p > 0 ? 1 + slips : 0] += 1;
  v->cone = fmax(v->cone, q - mu * p);
  if (p > 0 && !slips) v->stick = fmax(v->stick, hypot(s[0], s[1]));
  if (p > 0 && slips)
    v->direction = fmax(v->direction, hypot(s[0] + hypot(s[0], s[1]) * qx / q, s[1] + hypot(s[0], s[1]) * qy / q));
}

static void test_stripes_of_friction_hold_coulombs_law_cell_by_cell(void **state)
{
  Case               c = NewCase(Steel(), 90, 1.4, 0.27, "");
  const double      *p, *q, *s;
  const SamSolution *solution;
  Violations         v = {0, 0, 0, {{0}}};
  Vec                slip;
  SamStep            step;

  (void)state;
  SetField(&c, Stripes, &c.s.a);
  step = StepTo(&c, 1, 0.4);
  AssertGood(&step);
  solution = SolutionOf(&c);
  slip     = NewSlip(&c);
  sam_call(VecGetArrayRead(solution->pressure, &p));
  sam_call(VecGetArrayRead(solution->shear, &q));
  sam_call(VecGetArrayRead(slip, &s));
  for (PetscInt k = 0; k < c.s.grid->cells; k++)
    CheckCell(c.s.grid, k, p[k], q[k], q[k + c.s.grid->cells], (const double[2]){s[k], s[k + c.s.grid->cells]}, &v);
  sam_call(VecRestoreArrayRead(slip, &s));
  sam_call(VecRestoreArrayRead(solution->shear, &q));
  sam_call(VecRestoreArrayRead(solution->pressure, &p));
  (void)MPI_Allreduce(MPI_IN_PLACE, v.cells, 6, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  sam_assert(v.cone <= 1e-12 * 0.5 * c.s.p0);
  sam_assert(v.stick < 1e-5 * 0.27 * c.s.a * c.s.a / c.s.R); /* rtol of the shear, of the largest displacement */
  sam_assert(v.direction < 1e-4 * 0.27 * c.s.a * c.s.a / c.s.R);
  sam_assert(v.cells[0][2] > 10 * v.cells[0][1]); /* nearly all of the slippery stripes slip */
  sam_assert(v.cells[1][1] > v.cells[1][2]);      /* most of the others stick */
  sam_call(VecDestroy(&slip));
  DestroyCase(&c);
}

/* The later call counts; the bound is scale times friction times pressure, zero where there is no pressure. */
static void test_bound_follows_the_friction_that_was_set_last(void **state)
{
  Case          c = NewCase(Steel(), 23, 2, MU, "");
  Vec           p = NewFrom(c.s.grid, Stripes, &c.s.a), b = NewField(c.s.grid, 1), expected = Copy(p);
  static double two = 2;
  PetscReal     number;
  PetscBool     has;
  SamLaw        law;

  (void)state;
  SetField(&c, Constant, &two);
  law = SamProblemGetLaw(c.problem, SAM_LAW_COULOMB);
  sam_call(SamLawGetFriction(law, &number));
  sam_assert(number == 0); /* a field counts */
  ComputeBound(c.problem, 4, p, b);
  sam_call(VecScale(expected, 8)); /* exact */
  sam_assert(SameBits(b, expected));
  sam_call(SamProblemSetFriction(c.problem, 0.5));
  sam_assert(HasCoefficient(c.problem, 0.5));
  ComputeBound(c.problem, 1, p, b);
  sam_call(VecScale(expected, 1.0 / 16));
  sam_assert(SameBits(b, expected));
  sam_call(SamProblemHasFriction(c.problem, &has));
  sam_assert(has);
  two = 0;
  SetField(&c, Constant, &two);
  sam_call(SamProblemHasFriction(c.problem, &has));
  sam_assert(!has);
  two = 2;
  sam_destroy(&p, &b, &expected);
  DestroyCase(&c);
}

static void test_coefficients_that_are_none_are_refused(void **state)
{
  static const double bad[] = {-1e-300, NAN, INFINITY};
  Case                c     = NewCase(Steel(), 23, 2, MU, "");

  (void)state;
  for (int k = 0; k < 3; k++) {
    Vec wrong = NewField(c.s.grid, 1);

    AddAt(c.s.grid, 0, 3, 22, bad[k], wrong); /* one cell, of the last rank */
    sam_fails(SamProblemSetFriction(c.problem, bad[k]), PETSC_ERR_ARG_OUTOFRANGE);
    sam_fails(SamProblemSetFrictionField(c.problem, wrong), PETSC_ERR_ARG_OUTOFRANGE);
    sam_call(VecDestroy(&wrong));
  }
  sam_assert(HasCoefficient(c.problem, MU));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_gap_that_is_changed_in_place_finds_a_new_pressure),
    cmocka_unit_test(test_gap_may_be_changed_on_one_rank_alone),
    cmocka_unit_test(test_setting_a_gap_raises_its_revision),
    cmocka_unit_test(test_slip_stays_with_its_place_when_the_gap_changes),
    cmocka_unit_test(test_state_of_another_gap_is_solved_anew),
    cmocka_unit_test(test_constant_field_is_the_number_to_the_last_bit),
    cmocka_unit_test(test_friction_scale_is_a_factor_on_number_and_field),
    cmocka_unit_test(test_friction_that_falls_below_the_shear_makes_it_slip),
    cmocka_unit_test(test_stripes_of_friction_hold_coulombs_law_cell_by_cell),
    cmocka_unit_test(test_bound_follows_the_friction_that_was_set_last),
    cmocka_unit_test(test_coefficients_that_are_none_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
 * Load steps: their numbers, steps that have no solution or are refused, periodic and dissimilar bodies.
 */
#include "contacts.h"

/* ---- steps ---- */

static void test_step_with_all_tangential_loads_passes_its_check(void **state)
{
  Case             c       = NewCase(Steel(), 64, 1.5, MU, "");
  const SamControl control = Loads(&c, 1, 0.4, -0.3, 0.2);
  const SamStep    step    = Solve(&c, &control);
  const double     area    = PETSC_PI * c.s.a * c.s.a;

  (void)state;
  AssertGood(&step);
  sam_assert(NumberOf(&c, "coupling_iterations") == 1);
  sam_assert_close(NumberOf(&c, "contact_area"), area, 0.03 * area); /* cells at the edge count or not: some h/a */
  sam_assert(NumberOf(&c, "stick_area") > 0 && NumberOf(&c, "stick_area") < NumberOf(&c, "contact_area"));
  sam_assert(NumberOf(&c, "dissipated_energy") > 0);
  DestroyCase(&c);
}

/* Slip goes on from the step before: the same load again causes no slip and no dissipation. */
static void test_second_step_with_the_same_load_dissipates_nothing(void **state)
{
  Case             c       = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl control = Loads(&c, 1, 0.5, 0, 0.1);
  const SamStep    first   = Solve(&c, &control);
  const double     work    = NumberOf(&c, "dissipated_energy");
  const SamStep    second  = Solve(&c, &control);

  (void)state;
  AssertGood(&second);
  sam_assert_close(NumberOf(&c, "dissipated_energy"), 0, 1e-5 * work); /* rtol of the shear, times the condition */
  sam_assert_close(second.rigid[SAM_COMPONENT_TX], first.rigid[SAM_COMPONENT_TX], 1e-5 * first.rigid[SAM_COMPONENT_TX]);
  DestroyCase(&c);
}

/* -sum q.s dA = T d_x - sum q.u dA, with d_x by Mindlin's solution. */
static void test_dissipation_is_work_at_the_final_shear_less_that_of_the_elastic_part(void **state)
{
  Case               c       = NewCase(NewPair(210e9, 0, 210e9, 0), 64, 1.5, MU, "");
  const SamControl   control = Loads(&c, 1, 0.8, 0, 0);
  const SamStep      step    = Solve(&c, &control);
  const double       d0 = MU * c.s.a * c.s.a / c.s.R, T = MU * c.s.N, rest = 1 - 0.8;
  const SamSolution *s    = SolutionOf(&c);
  const double       work = 0.8 * T * d0 * (1 - pow(rest, 2.0 / 3)),
               elastic    = Dot(s->shear, s->displacement_t) * c.s.grid->dx * c.s.grid->dy;

  (void)state;
  AssertGood(&step);
  sam_assert_close(NumberOf(&c, "dissipated_energy"), work - elastic,
                   2e-2 * work); /* Mindlin's displacement on 64 cells */
  DestroyCase(&c);
}

/* Hertz: U = 2/5 N d_z. */
static void test_stored_energy_is_that_of_hertz(void **state)
{
  Case             c       = NewCase(Steel(), 64, 1.3, 0, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  const SamStep    step    = Try(&c, &control);

  (void)state;
  sam_assert_close(NumberOf(&c, "stored_energy") / (0.4 * c.s.N * step.rigid[SAM_COMPONENT_N]), 1, 2e-3);
  DestroyCase(&c);
}

/* The work of the tangential force over a loop goes into stored and dissipated energy, at any moment. */
static void test_work_is_stored_or_dissipated(void **state)
{
  Case       c       = NewCase(Dissimilar(), 40, 1.4, MU, "");
  SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStep    step    = Solve(&c, &control), before;
  double     work = 0, stored = NumberOf(&c, "stored_energy"), dissipated = 0;

  (void)state;
  for (PetscInt k = 1; k <= 36; k++) {
    before                          = step;
    control.value[SAM_COMPONENT_TX] = 0.9 * MU * c.s.N * sin(PETSC_PI / 12 * (double)k);
    step                            = Solve(&c, &control);
    for (PetscInt i = 0; i < SAM_COMPONENTS; i++)
      work += 0.5 * (step.load[i] + before.load[i]) * (step.rigid[i] - before.rigid[i]);
    dissipated += NumberOf(&c, "dissipated_energy");
    sam_assert_close(NumberOf(&c, "stored_energy") - stored + dissipated, work, 0.02 * (dissipated + fabs(work)));
  }
  sam_assert(work > 0);
  DestroyCase(&c);
}

/* A given displacement is kept; prescribing the load that it takes gives the same displacement again. */
static void test_loads_and_displacements_are_two_ways_to_give_the_same_step(void **state)
{
  Case       c = NewCase(Steel(), 48, 1.5, MU, ""), d = NewCase(Steel(), 48, 1.5, MU, "");
  SamControl control = Loads(&c, 1, 0, 0.2, 0);
  SamStep    one, other;

  (void)state;
  Displace(&control, SAM_COMPONENT_N, c.s.a * c.s.a / c.s.R);
  Displace(&control, SAM_COMPONENT_TX, 0.4 * MU * c.s.a * c.s.a / c.s.R);
  Displace(&control, SAM_COMPONENT_MZ, 1e-5);
  one = Solve(&c, &control);
  AssertGood(&one);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    if (control.force[k]) /* a load is told as the traction carries it */
      sam_assert_close(one.load[k], control.value[k], 1e-12 * c.s.N * (k < SAM_COMPONENT_MX ? 1 : c.s.a));
    else
      sam_assert(one.rigid[k] == control.value[k]);
  }
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    control.force[k] = PETSC_TRUE;
    control.value[k] = one.load[k];
  }
  other = Solve(&d, &control);
  AssertGood(&other);
  sam_assert_close(other.rigid[SAM_COMPONENT_N], one.rigid[SAM_COMPONENT_N], 1e-7 * one.rigid[SAM_COMPONENT_N]);
  sam_assert_close(other.rigid[SAM_COMPONENT_TX], one.rigid[SAM_COMPONENT_TX], 1e-5 * one.rigid[SAM_COMPONENT_TX]);
  sam_assert_close(other.rigid[SAM_COMPONENT_MZ], one.rigid[SAM_COMPONENT_MZ], 1e-4 * one.rigid[SAM_COMPONENT_MZ]);
  DestroyCase(&c);
  DestroyCase(&d);
}

/* Loads along y do along y what loads along x do along x. */
static void test_directions_x_and_y_are_alike(void **state)
{
  Case             c = NewCase(Steel(), 48, 1.5, MU, ""), d = NewCase(Steel(), 48, 1.5, MU, "");
  const SamControl along_x = Loads(&c, 1, 0.6, 0, 0), along_y = Loads(&d, 1, 0, 0.6, 0);
  const SamStep    x = Solve(&c, &along_x), y = Solve(&d, &along_y);

  (void)state;
  AssertGood(&x);
  AssertGood(&y);
  sam_assert_close(y.rigid[SAM_COMPONENT_TY], x.rigid[SAM_COMPONENT_TX], 1e-5 * x.rigid[SAM_COMPONENT_TX]);
  sam_assert_close(NumberOf(&d, "dissipated_energy"), NumberOf(&c, "dissipated_energy"),
                   1e-5 * NumberOf(&c, "dissipated_energy"));
  /* a few cells at the rim of stick */
  sam_assert_close(NumberOf(&d, "stick_area"), NumberOf(&c, "stick_area"), 0.02 * NumberOf(&c, "stick_area"));
  DestroyCase(&c);
  DestroyCase(&d);
}

/* ---- no step ---- */

static void test_gross_slip_is_told_with_its_limit(void **state)
{
  Case             c       = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl control = Loads(&c, 1, 1.1, 0, 0);
  const SamStep    step    = Try(&c, &control);
  const char      *limit   = strstr(step.message, "(limit ");

  (void)state;
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_assert(strstr(step.message, "load_tx") && limit && !strstr(step.message, "load_ty"));
  sam_assert_close(limit ? strtod(limit + 7, NULL) : 0, MU * c.s.N, 1e-6 * MU * c.s.N);
  DestroyCase(&c);
}

static void test_moment_beyond_the_grid_is_told(void **state)
{
  Case       c       = NewCase(Steel(), 40, 1.5, MU, "");
  SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStep    step;

  (void)state;
  control.value[SAM_COMPONENT_MY] = 1.6 * c.s.N * c.s.a;
  step                            = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_assert(strstr(step.message, "load_my"));
  DestroyCase(&c);
}

/* Of a step without a solution only the given values are known. */
static void test_what_a_step_without_equilibrium_lacks_is_nan(void **state)
{
  Case       c       = NewCase(Steel(), 40, 1.5, MU, "");
  SamControl control = Loads(&c, 1, 1.1, 0, 0);
  SamStep    step;

  (void)state;
  Displace(&control, SAM_COMPONENT_MZ, 1e-5);
  step = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    sam_assert((control.force[k] ? step.load[k] : step.rigid[k]) == control.value[k]);
    sam_assert(isnan(control.force[k] ? step.rigid[k] : step.load[k]));
  }
  sam_assert(isnan(NumberOf(&c, "contact_area")) && isnan(NumberOf(&c, "stick_area")) &&
             isnan(NumberOf(&c, "dissipated_energy")));
  sam_assert(isnan(step.check.normal) && isnan(step.check.tangential) && isnan(step.check.equilibrium) &&
             isnan(step.check.cone) && isnan(step.check.edge));
  DestroyCase(&c);
}

static void test_contact_at_the_edge_of_the_grid_is_a_status(void **state)
{
  (void)state;
  for (int allowed = 0; allowed < 2; allowed++) {
    Case             c       = NewCase(Steel(), 40, 0.8, MU, allowed ? "-allow_edge_contact" : "-allow_edge_contact 0");
    const SamControl control = Loads(&c, 1, 0.3, 0, 0);
    const SamStep    step    = Solve(&c, &control);

    sam_assert(step.status == (allowed ? SAM_STATUS_CONVERGED : SAM_STATUS_EDGE_CONTACT));
    sam_assert(strstr(step.message, "size of the grid"));
    sam_assert(step.check.edge > 0.1 && step.check.normal < 2e-8 && step.check.tangential < 2e-6);
    DestroyCase(&c);
  }
}

/* A wrong control is refused, and changes nothing. */
static void test_controls_that_are_none_are_refused(void **state)
{
  Case             c    = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl good = Loads(&c, 1, 0.3, 0, 0);
  SamControl       bad[7];
  SamStep          step;

  (void)state;
  for (int k = 0; k < 7; k++) bad[k] = good;
  bad[0].value[SAM_COMPONENT_N]  = -1;
  bad[1].value[SAM_COMPONENT_TY] = NAN;
  bad[2].value[SAM_COMPONENT_MX] = INFINITY;
  Prescribe(c.problem, &bad[3], "friction_scale", -0.1);
  Prescribe(c.problem, &bad[4], "friction_scale", NAN);
  Prescribe(c.problem, &bad[5], "bulk1_stress_yy", NAN);
  Prescribe(c.problem, &bad[6], "bulk2_stress_xy", INFINITY);
  for (int k = 0; k < 7; k++) sam_fails(SamContactTry(c.contact, &bad[k], &step), PETSC_ERR_ARG_OUTOFRANGE);
  sam_fails(SamContactCommit(c.contact), PETSC_ERR_ORDER);
  step = Solve(&c, &good);
  AssertGood(&step);
  DestroyCase(&c);
}

/* ---- periodic bodies ---- */

/* There is no edge that the contact could reach, and nothing turns. */
static void test_periodic_bodies_have_no_edge_and_no_moments(void **state)
{
  Case             c       = NewPeriodic(Steel(), 40, 0.8, 1, MU, "");
  const SamControl control = Loads(&c, 4, 0.3, 0, 0);
  SamStep          step;

  (void)state;
  for (PetscInt k = SAM_COMPONENT_MX; k < SAM_COMPONENTS; k++) {
    for (int force = 0; force < 2; force++) {
      SamControl turned = control;

      turned.force[k] = force ? PETSC_TRUE : PETSC_FALSE;
      turned.value[k] = 1e-9;
      sam_fails(SamContactTry(c.contact, &turned, &step), PETSC_ERR_ARG_OUTOFRANGE);
    }
  }
  step = Solve(&c, &control);
  AssertGood(&step);
  sam_assert(NumberOf(&c, "contact_area") > 0.99 * 1.6 * 1.6 * c.s.a * c.s.a); /* over the border of the grid as well */
  for (PetscInt k = SAM_COMPONENT_MX; k < SAM_COMPONENTS; k++) sam_assert(!step.control.force[k] && step.rigid[k] == 0);
  DestroyCase(&c);
}

/* Whatever is given, and whatever the bodies: it is the numbers, and not the loads, that have no solution. */
static void test_gap_that_is_no_number_is_told(void **state)
{
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    Sphere     s = NewSphereOf(Steel(), 24, 1.5);
    Case       c;
    SamControl control;
    SamStep    step;

    if (kind / 2) sam_call(SamElasticitySetType(s.elasticity, SAM_ELASTICITY_PERIODIC));
    AddAt(s.grid, 0, 11, 23, NAN, s.h); /* one cell, of the last rank */
    c       = NewCaseOn(s, MU, NULL, "");
    control = Loads(&c, 1, 0.3, 0, 0);
    HoldRotations(&control);
    if (kind % 2) Displace(&control, SAM_COMPONENT_N, 1e-6);
    step = Try(&c, &control);
    sam_assert(step.status == SAM_STATUS_NOT_CONVERGED && strstr(step.message, "NAN"));
    DestroyCase(&c);
  }
}

/* ---- dissimilar bodies ---- */

/* The mean of the tractions, most of them here, has no part in what the bodies do to each other. */
static void test_dissimilar_periodic_bodies_in_full_contact_pass_their_check(void **state)
{
  Case       c       = NewPeriodic(Dissimilar(), 36, 1.5, 1e-3, 0.2, "");
  SamControl control = Loads(&c, 1, 0.4, 0.1, 0);
  SamStep    step;

  (void)state;
  HoldRotations(&control);
  step = Solve(&c, &control);
  AssertGood(&step);
  sam_assert_close(NumberOf(&c, "contact_area"), 9 * c.s.a * c.s.a, 1e-12 * c.s.a * c.s.a);
  DestroyCase(&c);
}

static void test_dissimilar_bodies_without_friction_need_one_pass(void **state)
{
  Case             c       = NewCase(NewPair(210e9, 0.3, 3e9, 0.2), 64, 1.5, 0, "");
  const SamControl control = Loads(&c, 1, 0, 0, 0);
  const SamStep    step    = Solve(&c, &control);
  Vec              slip    = NewSlip(&c);

  (void)state;
  AssertGood(&step);
  sam_assert(NumberOf(&c, "coupling_iterations") == 1);
  sam_assert(Norm(SolutionOf(&c)->shear, NORM_INFINITY) == 0);
  sam_assert(Norm(slip, NORM_INFINITY) > 0); /* the surfaces slide on each other all the same */
  sam_call(VecDestroy(&slip));
  DestroyCase(&c);
}

/* Exchanging the bodies is looking from below: shear, slip and tangential loads change their sign. */
static void test_exchanged_bodies_have_the_same_pressure_and_opposite_shear(void **state)
{
  Case c                 = NewCase(NewPair(210e9, 0.3, 70e9, 0.33), 48, 1.5, 0.2, ""),
       d                 = NewCase(NewPair(70e9, 0.33, 210e9, 0.3), 48, 1.5, 0.2, "");
  const SamControl forth = Loads(&c, 1, 0.2, 0.1, 0), back = Loads(&d, 1, -0.2, -0.1, 0);
  const SamStep    one = Solve(&c, &forth), two = Solve(&d, &back);
  Vec              shear = Copy(SolutionOf(&d)->shear);

  (void)state;
  sam_assert(one.status == SAM_STATUS_CONVERGED && two.status == SAM_STATUS_CONVERGED);
  sam_assert(NumberOf(&c, "coupling_iterations") > 1);
  /* -coupling_rtol 1e-6 at a rate of some 0.1 */
  sam_assert_close(Difference(SolutionOf(&d)->pressure, SolutionOf(&c)->pressure, NORM_2), 0, 1e-4);
  sam_call(VecScale(shear, -1));
  sam_assert_close(Difference(shear, SolutionOf(&c)->shear, NORM_2), 0, 1e-4);
  sam_call(VecDestroy(&shear));
  DestroyCase(&c);
  DestroyCase(&d);
}

static void test_coupling_can_be_left_out(void **state)
{
  Case             c       = NewCase(NewPair(210e9, 0.3, 70e9, 0.33), 40, 1.5, 0.2, "-coupling none");
  const SamControl control = Loads(&c, 1, 0.3, 0, 0);
  const SamStep    step    = Solve(&c, &control);

  (void)state;
  AssertGood(&step);
  sam_assert(NumberOf(&c, "coupling_iterations") == 1);
  DestroyCase(&c);
}

/* The work of friction while force and shear grow together, in this many steps. */
static double WorkIn(int steps)
{
  Case       c     = NewCase(Steel(), 64, 1.4, MU, "");
  SamControl start = Loads(&c, 0.5, 0, 0, 0); /* without shear, so that there is a bound before the first slip */
  double     work  = 0;

  (void)Solve(&c, &start);
  for (int n = 1; n <= steps; n++) {
    const double     part = (double)n / steps;
    const SamControl next = Loads(&c, 0.5 + 0.5 * part, 0.6 * part, 0, 0);

    (void)Solve(&c, &next);
    work += NumberOf(&c, "dissipated_energy");
  }
  DestroyCase(&c);
  return work;
}

/* With the bound at the end of a step instead of the mean one it would be first order: a quarter in place of 1/16. */
static void test_dissipation_under_changing_pressure_is_of_second_order(void **state)
{
  const double exact = WorkIn(48), coarse = fabs(WorkIn(2) - exact), fine = fabs(WorkIn(8) - exact);

  (void)state;
  if (getenv("SAM_SHOW")) print_message("# %g: %g %g\n", exact, coarse, fine);
  sam_assert(coarse > 0.01 * exact);
  sam_assert(fine < 0.1 * coarse);
}

/* The passes end when both problems are solved, or at the largest number of passes, with a status. */
static void test_too_few_passes_are_a_status(void **state)
{
  Case               c       = NewCase(Dissimilar(), 40, 1.5, MU, "-coupling_max_it 2");
  const SamControl   control = Loads(&c, 1, 0.3, 0, 0);
  SamStep            step    = Try(&c, &control);
  SamContactSettings set;

  (void)state;
  sam_assert(step.status == SAM_STATUS_NOT_CONVERGED && NumberOf(&c, "coupling_iterations") == 2);
  sam_assert(strstr(step.message, "coupling"));
  set                 = SamContactGetSettings(c.contact);
  set.coupling_max_it = 0;
  sam_fails(SamContactSetSettings(c.contact, &set), PETSC_ERR_ARG_OUTOFRANGE);
  set.coupling_max_it = 30;
  sam_call(SamContactSetSettings(c.contact, &set));
  step = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_CONVERGED && NumberOf(&c, "coupling_iterations") < 15);
  sam_assert(step.check.normal <= 1.05e-8 && step.check.tangential <= 1.05e-6); /* as strict as of similar bodies */
  DestroyCase(&c);
}

/*
  Friction up to 2 at a Dundurs' beta of 0.5, where passes in turn diverge: from nothing, both problems are solved, and
  sliding begins at the loads at which a history of displacements slides.
*/
static void test_coupling_of_large_friction_converges(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    const double  friction = k == 0 ? 0.5 : k;
    Case          c        = NewCase(NewPair(210e9, 0, INFINITY, 0), 48, 1.6, friction, "");
    SamControl    control  = Loads(&c, 1, 0.55, 0.1, 0.2);
    const SamStep step     = Try(&c, &control);

    AssertGood(&step);
    sam_assert(step.check.normal <= 1.05e-8);
    sam_assert(NumberOf(&c, "normal_applies") + NumberOf(&c, "tangential_applies") <= 160);
    DestroyCase(&c);
  }
}

/* Cells that lose contact from pass to pass must not keep their shear. */
static void test_coupling_without_load_converges(void **state)
{
  (void)state;
  for (int n = 64; n <= 128; n *= 2) {
    Case             c       = NewCase(NewPair(210e9, 0, INFINITY, 0), n, 1.86, 1, "");
    const SamControl control = Loads(&c, 1, 0, 0, 0);
    const SamStep    step    = Try(&c, &control);

    AssertGood(&step);
    sam_assert(NumberOf(&c, "coupling_iterations") <= 25);
    DestroyCase(&c);
  }
}

static void test_gross_slip_of_dissimilar_bodies_is_decided_with_their_own_pressure(void **state)
{
  const double level[] = {0.98, 0.995, 0.999, 1.001, 1.01};
  Case         c       = NewCase(NewPair(210e9, 0, INFINITY, 0), 48, 1.6, 0.8, "");
  SamControl   given   = Loads(&c, 1, 0, 0, 0);
  SamStep      sliding = {.status = SAM_STATUS_CONVERGED};

  (void)state;
  /* displaced until all slides, in some steps */
  for (int k = 1; k <= 6; k++) {
    Displace(&given, SAM_COMPONENT_TX, 2e-6 * k * k);
    Displace(&given, SAM_COMPONENT_TY, 1e-6 * k * k);
    Displace(&given, SAM_COMPONENT_MZ, 1.5e-3 * k * k);
    sliding = Solve(&c, &given);
    AssertGood(&sliding);
  }
  sam_assert(NumberOf(&c, "stick_area") == 0);
  DestroyCase(&c);
  /* these loads at once */
  for (int k = 0; k < 5; k++) {
    SamControl control;
    SamStep    step;

    c       = NewCase(NewPair(210e9, 0, INFINITY, 0), 48, 1.6, 0.8, "");
    control = Loads(&c, 1, 0, 0, 0);
    for (PetscInt n = SAM_COMPONENT_N; n < SAM_COMPONENTS; n++) {
      const PetscInt component = n;

      if (component != SAM_COMPONENT_TX && component != SAM_COMPONENT_TY && component != SAM_COMPONENT_MZ) continue;
      control.value[component] = level[k] * sliding.load[component];
    }
    step = Try(&c, &control);
    sam_assert(step.status == (level[k] < 1 ? SAM_STATUS_CONVERGED : SAM_STATUS_NO_EQUILIBRIUM));
    DestroyCase(&c);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_step_with_all_tangential_loads_passes_its_check),
    cmocka_unit_test(test_second_step_with_the_same_load_dissipates_nothing),
    cmocka_unit_test(test_dissipation_is_work_at_the_final_shear_less_that_of_the_elastic_part),
    cmocka_unit_test(test_stored_energy_is_that_of_hertz),
    cmocka_unit_test(test_work_is_stored_or_dissipated),
    cmocka_unit_test(test_loads_and_displacements_are_two_ways_to_give_the_same_step),
    cmocka_unit_test(test_directions_x_and_y_are_alike),
    cmocka_unit_test(test_gross_slip_is_told_with_its_limit),
    cmocka_unit_test(test_moment_beyond_the_grid_is_told),
    cmocka_unit_test(test_what_a_step_without_equilibrium_lacks_is_nan),
    cmocka_unit_test(test_contact_at_the_edge_of_the_grid_is_a_status),
    cmocka_unit_test(test_controls_that_are_none_are_refused),
    cmocka_unit_test(test_periodic_bodies_have_no_edge_and_no_moments),
    cmocka_unit_test(test_gap_that_is_no_number_is_told),
    cmocka_unit_test(test_dissimilar_periodic_bodies_in_full_contact_pass_their_check),
    cmocka_unit_test(test_dissimilar_bodies_without_friction_need_one_pass),
    cmocka_unit_test(test_exchanged_bodies_have_the_same_pressure_and_opposite_shear),
    cmocka_unit_test(test_coupling_can_be_left_out),
    cmocka_unit_test(test_dissipation_under_changing_pressure_is_of_second_order),
    cmocka_unit_test(test_too_few_passes_are_a_status),
    cmocka_unit_test(test_coupling_of_large_friction_converges),
    cmocka_unit_test(test_coupling_without_load_converges),
    cmocka_unit_test(test_gross_slip_of_dissimilar_bodies_is_decided_with_their_own_pressure),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

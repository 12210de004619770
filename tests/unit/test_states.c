/*
 * Try, commit, reject: what is tried and rejected leaves nothing behind, to the last bit.
 */
#include "contacts.h"
#include <petsam/private/state.h>

/* ---- random steps ---- */

enum { BODIES = 4, COMMITS = 7, TRIES = 3 };

/* Similar and dissimilar bodies, half-spaces and periodic ones; 45 rows on 2 ranks do not divide. */
static Case NewBodies(int kind)
{
  Sphere s = NewSphereOf(kind % 2 ? Dissimilar() : Steel(), 45, 2);

  if (kind / 2) sam_call(SamElasticitySetType(s.elasticity, SAM_ELASTICITY_PERIODIC));
  return NewCaseOn(s, MU, NULL, "");
}

/* In [0, 1), different for each step, try and purpose. */
static double Chance(int kind, int step, int attempt, int what)
{
  return 0.5 * (1 + Random(kind, step, attempt, what));
}

/* Loads and displacements in any mixture; some of them slide, some part the bodies. */
static SamControl RandomControl(const Case *c, int kind, int step, int attempt)
{
#define CHANCE(what) Chance(kind, step, attempt, what)
  const double d = c->s.a * c->s.a / c->s.R; /* approach */
  SamControl   control =
    Loads(c, 0.3 + CHANCE(0), 1.4 * CHANCE(1) - 0.7, 0.6 * CHANCE(2) - 0.3, kind < 2 ? 0.2 * CHANCE(3) - 0.1 : 0);

  control.time = step;
  if (CHANCE(4) < 0.2) Displace(&control, SAM_COMPONENT_N, d * (1.3 * CHANCE(5) - 0.2)); /* may be apart */
  if (CHANCE(6) < 0.3) Displace(&control, SAM_COMPONENT_TX, MU * d * (2 * CHANCE(7) - 1));
  if (CHANCE(8) < 0.3) Displace(&control, SAM_COMPONENT_TY, MU * d * (2 * CHANCE(9) - 1));
  if (CHANCE(10) < 0.3) Prescribe(c->problem, &control, "friction_scale", 0.5 + CHANCE(11));
  if (kind < 2 && CHANCE(12) < 0.3)
    Prescribe(c->problem, &control, "bulk2_stress_xx",
              0.1 * MU * c->s.a / c->s.R * CHANCE(13) * c->s.pair->body[1]->material[0].young);
  return control;
#undef CHANCE
}

static double Wave(double x, double y, const void *length)
{
  return 1 + 0.3 * sin(x / *(const double *)length) * cos(1.3 * y / *(const double *)length);
}

/* The gap of a sphere that is a little another one each time. */
static void SetRandomGap(const Case *c, int kind, int step, int attempt)
{
  const double R = c->s.R * (0.8 + 0.4 * Chance(kind, step, attempt, 20));
  Vec          h = NewFrom(c->s.grid, Paraboloid, &R);

  sam_call(SamProblemSetGap(c->problem, h));
  sam_call(VecDestroy(&h));
}

/* A number, or a field. */
static void SetRandomFriction(const Case *c, int kind, int step, int attempt)
{
  const double mu = MU * (0.6 + 0.8 * Chance(kind, step, attempt, 21));

  if (Chance(kind, step, attempt, 22) < 0.5)
    sam_call(SamProblemSetFriction(c->problem, mu));
  else {
    Vec field = NewFrom(c->s.grid, Wave, &c->s.a);

    sam_call(VecScale(field, mu));
    sam_call(SamProblemSetFrictionField(c->problem, field));
    sam_call(VecDestroy(&field));
  }
}

/* Whether the gap is another in this step. A try may then have still another one; else its revision must stay. */
static PetscBool HasOwnGap(int kind, int step)
{
  return Chance(kind, step, 0, 23) < 0.4;
}

/* How a try ended, and how often. */
static int tried[13];

/* A try that does not converge: one of the solvers stops after the first iterations. */
static void TryTooShort(const Case *c, const SamControl *control, PetscBool normal)
{
  SetMostIterations(c, normal ? 2 : 0, normal ? 0 : 2);
  tried[Try(c, control).status]++;
  SetMostIterations(c, 0, 0);
}

/* Tries of all kinds before the step that counts, rejected or just left. */
static void Distract(const Case *c, int kind, int step)
{
  for (int k = 1; k <= TRIES; k++) {
    SamControl control = RandomControl(c, kind, step, k);

    if (HasOwnGap(kind, step)) SetRandomGap(c, kind, step, k);
    SetRandomFriction(c, kind, step, k);
    if (Chance(kind, step, k, 24) < 0.2) control = Loads(c, 0, 0, 0, 0);        /* no contact */
    if (Chance(kind, step, k, 25) < 0.2) control = Loads(c, 1, 3, 0, 0);        /* gross slip */
    if (Chance(kind, step, k, 26) < 0.2) control.value[SAM_COMPONENT_TX] = NAN; /* refused */
    if (isnan(control.value[SAM_COMPONENT_TX])) {
      SamStep refused;

      sam_fails(SamContactTry(c->contact, &control, &refused), PETSC_ERR_ARG_OUTOFRANGE);
    } else if (Chance(kind, step, k, 27) < 0.3)
      TryTooShort(c, &control, k % 2 ? PETSC_TRUE : PETSC_FALSE);
    else
      tried[Try(c, &control).status]++;
    if (Chance(kind, step, k, 28) < 0.5) sam_call(SamContactReject(c->contact));
  }
}

/* The step that counts. Of three steps each, the last goes on as the second did, and is predicted. */
static SamStep TakeStep(const Case *c, int kind, int step)
{
  SamControl control = RandomControl(c, kind, step - step % 3, 0);

  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) control.value[k] *= 1 + 0.05 * (step % 3);
  if (HasOwnGap(kind, step)) SetRandomGap(c, kind, step, 0);
  SetRandomFriction(c, kind, step, 0);
  return Solve(c, &control);
}

static void test_tries_leave_nothing_behind(void **state)
{
  (void)state;
  memset(tried, 0, sizeof(tried));
  for (int kind = 0; kind < BODIES; kind++) {
    Case restless = NewBodies(kind), calm = NewBodies(kind);
    int  committed = 0;

    for (int step = 0; step < COMMITS; step++) {
      SamStep a, b;

      Distract(&restless, kind, step);
      a = TakeStep(&restless, kind, step);
      b = TakeStep(&calm, kind, step);
      AssertSameSteps(&restless, &a, &calm, &b);
      AssertSameFields(&restless, &calm);
      committed += a.status == SAM_STATUS_CONVERGED ? 1 : 0;
    }
    sam_assert(committed > COMMITS / 2);
    DestroyCase(&restless);
    DestroyCase(&calm);
  }
  /* the tries were of all kinds */
  sam_assert(tried[SAM_STATUS_CONVERGED] > 5 && tried[SAM_STATUS_NOT_CONVERGED] > 5 &&
             tried[SAM_STATUS_NO_EQUILIBRIUM] > 5);
}

/* Contact that is much larger, smaller or elsewhere makes the solvers work on another part of the grid. */
static void test_tries_that_move_the_window_leave_nothing_behind(void **state)
{
  static const double sizes[] = {0.3, 1.4, 0.05, 0.7};

  (void)state;
  for (int step = 0; step < 2; step++) { /* before the first step, and after it */
    Case             restless = NewCase(Steel(), 91, 4, MU, ""), calm = NewCase(Steel(), 91, 4, MU, "");
    const SamControl first = Loads(&calm, 0.5, 0.2, 0, 0), next = Loads(&calm, 0.5, 0.4, 0.1, 0);
    SamStep          a, b;

    if (step) {
      (void)Solve(&restless, &first);
      (void)Solve(&calm, &first);
    }
    for (int k = 0; k < 4; k++) {
      SamControl far              = Loads(&calm, sizes[k], 0.1 * sizes[k], 0, 0);
      far.value[SAM_COMPONENT_MY] = 0.5 * calm.s.a * far.value[SAM_COMPONENT_N];
      sam_assert(Try(&restless, &far).status == SAM_STATUS_CONVERGED);
    }
    sam_call(SamContactReject(restless.contact));
    a = Solve(&restless, &next);
    b = Solve(&calm, &next);
    AssertGood(&a);
    AssertSameSteps(&restless, &a, &calm, &b);
    AssertSameFields(&restless, &calm);
    DestroyCase(&restless);
    DestroyCase(&calm);
  }
}

/* ---- the order of calls ---- */

static PetscInt StepsOf(const Case *c)
{
  PetscInt steps;

  steps = SamContactGetSteps(c->contact);
  return steps;
}

static void test_commit_without_a_tried_state_is_an_error(void **state)
{
  Case             c    = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl good = Loads(&c, 1, 0.3, 0, 0), slides = Loads(&c, 1, 1.3, 0, 0);

  (void)state;
  sam_fails(SamContactCommit(c.contact), PETSC_ERR_ORDER);
  (void)Try(&c, &good);
  sam_call(SamContactReject(c.contact));
  sam_fails(SamContactCommit(c.contact), PETSC_ERR_ORDER);
  (void)Solve(&c, &good);
  sam_fails(SamContactCommit(c.contact), PETSC_ERR_ORDER);
  (void)Try(&c, &good);
  sam_assert(Try(&c, &slides).status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_fails(SamContactCommit(c.contact), PETSC_ERR_ORDER);
  sam_assert(StepsOf(&c) == 1);
  DestroyCase(&c);
}

/* Before the first step as well: the bodies have never touched. */
static void test_reject_gives_back_the_committed_solution(void **state)
{
  Case             c     = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl first = Loads(&c, 1, 0.3, 0, 0), second = Loads(&c, 0.8, -0.3, 0, 0);
  Vec              pressure;

  (void)state;
  sam_call(SamContactReject(c.contact));
  (void)Try(&c, &first);
  sam_assert(Norm(SolutionOf(&c)->pressure, NORM_INFINITY) > 0);
  sam_call(SamContactReject(c.contact));
  sam_assert(Norm(SolutionOf(&c)->pressure, NORM_INFINITY) == 0 && Norm(SolutionOf(&c)->shear, NORM_INFINITY) == 0);
  sam_assert(StepsOf(&c) == 0);
  (void)Solve(&c, &first);
  pressure = Copy(SolutionOf(&c)->pressure);
  (void)Try(&c, &second);
  sam_assert(!SameBits(SolutionOf(&c)->pressure, pressure));
  sam_call(SamContactReject(c.contact));
  sam_assert(SameBits(SolutionOf(&c)->pressure, pressure));
  sam_assert(StepsOf(&c) == 1);
  sam_call(VecDestroy(&pressure));
  DestroyCase(&c);
}

/* Nor is one that does. */
static void test_step_that_does_not_converge_is_not_committed_by_itself(void **state)
{
  Case             c     = NewCase(Steel(), 40, 1.5, MU, "-normal_max_it 1"), d;
  const SamControl given = Loads(&c, 1, 0.3, 0, 0);
  SamStep          step, plain;

  (void)state;
  step = Try(&c, &given);
  sam_assert(step.status == SAM_STATUS_NOT_CONVERGED && strstr(step.message, "normal"));
  sam_assert(StepsOf(&c) == 0);
  SetMostIterations(&c, 0, 0);
  step = Try(&c, &given);
  sam_assert(StepsOf(&c) == 0);
  d     = NewCase(Steel(), 40, 1.5, MU, "");
  plain = Try(&d, &given);
  AssertSameSteps(&c, &step, &d, &plain);
  AssertSameFields(&c, &d);
  DestroyCase(&c);
  DestroyCase(&d);
}

/* When the pressure does not converge, the shear is zero and not what earlier steps have left. */
static void test_there_is_no_shear_to_a_pressure_that_is_not_found(void **state)
{
  Case c = NewCase(Steel(), 40, 1.5, MU, "");

  (void)state;
  for (int k = 0; k < 5; k++) {
    const SamControl control = Loads(&c, 1 - 0.02 * k * k, 0.3, 0, 0);
    SamStep          step;

    if (k < 4) {
      (void)Solve(&c, &control);
      continue;
    }
    SetMostIterations(&c, 1, 0);
    step = Try(&c, &control);
    sam_assert(step.status == SAM_STATUS_NOT_CONVERGED);
    sam_assert(Norm(SolutionOf(&c)->shear, NORM_INFINITY) == 0);
  }
  DestroyCase(&c);
}

/* What was given stays given, also where tries with other values were rejected before. */
static void test_given_displacements_stay_when_the_pressure_is_not_found(void **state)
{
  Case       c       = NewCase(Steel(), 40, 1.5, MU, "");
  SamControl control = Loads(&c, 1, 0, 0.2, 0), other = control;

  (void)state;
  Displace(&control, SAM_COMPONENT_TX, 1e-7);
  Displace(&other, SAM_COMPONENT_TX, 7e-7);
  for (int k = 0; k < 2; k++) {
    SetMostIterations(&c, 1, 0);
    sam_assert(Try(&c, &control).status == SAM_STATUS_NOT_CONVERGED);
    sam_assert(SolutionOf(&c)->rigid[SAM_COMPONENT_TX] == 1e-7 && SolutionOf(&c)->load[SAM_COMPONENT_TX] == 0);
    sam_assert(SolutionOf(&c)->load[SAM_COMPONENT_TY] == control.value[SAM_COMPONENT_TY]);
    sam_assert(SolutionOf(&c)->rigid[SAM_COMPONENT_TY] == 0);
    SetMostIterations(&c, 0, 0);
    sam_assert(Try(&c, &other).status == SAM_STATUS_CONVERGED);
    sam_call(SamContactReject(c.contact));
  }
  DestroyCase(&c);
}

/* As results take it: that of the tried state, if there is one. */
static Vec NewPressure(const Case *c)
{
  return NewFieldOf(c, "pressure");
}

/* Gross slip at the same and at another N, and a moment that tips. */
static void test_step_without_equilibrium_leaves_the_contact_as_it_was(void **state)
{
  static const double N[] = {1, 1.1, 1.1, 1.1}, T[] = {0.1, 0.3, 0.6, 0.2};

  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    Case       c = NewCase(Steel(), 45, 2, MU, ""), whole = NewCase(Steel(), 45, 2, MU, "");
    SamControl fails = Loads(&c, kind == 1 ? 0.9 : 1.1, kind < 2 ? 1.5 : 0, 0, 0);
    SamStep    next, same;

    if (kind == 2) fails.value[SAM_COMPONENT_MY] = 9 * c.s.a * c.s.N;
    for (int k = 0; k < 4; k++) {
      const SamControl control = Loads(&c, N[k], T[k], 0.1, 0);

      if (k == 3) sam_assert(Try(&c, &fails).status == SAM_STATUS_NO_EQUILIBRIUM);
      if (k == 3) sam_assert(SameBitsOf(&c, &whole, NewPressure));
      if (k == 3) AssertSameFields(&c, &whole);
      next = Solve(&c, &control);
      same = Solve(&whole, &control);
    }
    AssertGood(&next);
    AssertSameSteps(&c, &next, &whole, &same);
    AssertSameFields(&c, &whole);
    DestroyCase(&c);
    DestroyCase(&whole);
  }
}

/* ---- getting and setting a state ---- */

static SamControl Turn(const Case *c, int k)
{
  const double N[] = {1, 1.1, 1.1, 1.1, 1.05}, T[] = {0.1, 0.3, 0.6, 0.2, -0.3};

  return Loads(c, N[k], T[k], 0.1, 0);
}

static void test_contact_with_the_state_of_another_goes_on_as_it_would(void **state)
{
  (void)state;
  for (int kind = 0; kind < BODIES; kind++)
    for (int solved = 0; solved < 4; solved++) {
      Case      one = NewBodies(kind), other = NewBodies(kind);
      SamState  held;
      PetscBool current;
      Vec       before;

      for (int k = 0; k < solved; k++) {
        const SamControl control = Turn(&one, k);

        (void)Solve(&one, &control);
      }
      (void)Try(&other, &(SamControl){.force = {PETSC_TRUE}, .value = {1}}); /* is forgotten */
      sam_call(SamContactGetState(one.contact, &held));
      before = SamStateGetField(held, SamStateFindField(held, "pressure"), SAM_BEFORE);
      sam_assert(StepsOf(&one) == solved && (before && Norm(before, NORM_INFINITY) > 0) == (solved > 1));
      sam_call(SamContactIsGapCurrent(one.contact, &current));
      sam_assert((current != 0) == (solved > 0));
      sam_call(SamContactSetState(other.contact, held, current));
      sam_assert(StepsOf(&other) == solved);
      for (int k = solved; k < 5; k++) {
        const SamControl control = Turn(&one, k);
        const SamStep    a = Solve(&one, &control), b = Solve(&other, &control);

        AssertSameSteps(&one, &a, &other, &b);
        AssertSameFields(&one, &other);
      }
      DestroyCase(&one);
      DestroyCase(&other);
    }
}

/* All that two contacts remember, by its names. */
static void AssertSameStates(SamState a, SamState b)
{
  sam_assert(SamStateCountFields(a) == SamStateCountFields(b) && SamStateCountNumbers(a) == SamStateCountNumbers(b));
  for (SamGeneration g = SAM_COMMITTED; g <= SAM_BEFORE; g++) {
    for (PetscInt k = 0; k < SamStateCountFields(a); k++) {
      const PetscInt other = SamStateFindField(b, SamStateFieldOf(a, k)->name);
      Vec            x     = SamStateGetField(a, k, g), y;

      sam_assert(other >= 0);
      y = SamStateGetField(b, other, g);
      sam_assert(x ? y && SameBits(x, y) : !y || Norm(y, NORM_INFINITY) == 0);
    }
    for (PetscInt k = 0; k < SamStateCountNumbers(a); k++) {
      PetscInt              id;
      const SamStateNumber *number = SamStateNumberOf(a, k, &id);
      const PetscInt        other  = SamStateFindNumber(b, number->name);

      sam_assert(other >= 0);
      sam_assert(SameNumbers(number->count, SamStateNumbers(a, id, g), SamStateNumbers(b, other, g)));
    }
  }
}

static void test_state_is_what_was_set(void **state)
{
  Case          one = NewCase(Steel(), 91, 4, MU, ""), other = NewCase(Steel(), 91, 4, MU, "");
  SamState      a, b;
  PetscBool     current[2];
  const double *window;

  (void)state;
  for (int k = 0; k < 2; k++) {
    const SamControl control = Turn(&one, k);

    (void)Solve(&one, &control);
  }
  sam_call(SamContactGetState(one.contact, &a));
  sam_call(SamContactIsGapCurrent(one.contact, &current[0]));
  sam_call(SamContactSetState(other.contact, a, current[0]));
  sam_call(SamContactGetState(other.contact, &b));
  sam_call(SamContactIsGapCurrent(other.contact, &current[1]));
  sam_assert(StepsOf(&one) == 2 && StepsOf(&other) == 2 && current[0] && current[1]);
  window = SamStateNumbers(b, SamStateFindNumber(b, "window"), SAM_COMMITTED);
  sam_assert(window[2] > 0 && window[2] < 91); /* a part of the grid */
  AssertSameStates(a, b);
  AssertSameFields(&one, &other);
  DestroyCase(&one);
  DestroyCase(&other);
}

/* What only the other contact remembers is refused by its name, and the contact goes on as it was. */
static void test_state_with_more_fields_is_refused(void **state)
{
  Case             one = NewCase(Steel(), 40, 1.5, MU, "-sum_slip_path"), c = NewCase(Steel(), 40, 1.5, MU, "");
  const SamControl control = Loads(&c, 1, 0.3, 0, 0), other = Loads(&c, 0.7, 0, 0.2, 0);
  SamState         held, own, kept;

  (void)state;
  (void)Solve(&one, &other);
  (void)Solve(&c, &control);
  sam_call(SamContactGetState(one.contact, &held));
  sam_call(SamContactGetState(c.contact, &own));
  sam_call(SamStateCreateLike(own, &kept));
  sam_call(SamStateCopy(own, kept));
  sam_says(SamContactSetState(c.contact, held, PETSC_TRUE), PETSC_ERR_ARG_INCOMP, "slip_path");
  AssertSameStates(own, kept);
  sam_assert(StepsOf(&c) == 1);
  sam_call(SamContactSetState(one.contact, own, PETSC_TRUE)); /* the reverse: there is none so far */
  AssertSameFields(&one, &c);
  sam_call(SamStateDestroy(&kept));
  DestroyCase(&one);
  DestroyCase(&c);
}

static void test_contact_that_is_reset_is_as_a_new_one(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    Case one = NewBodies(kind), other = NewBodies(kind);

    for (int k = 0; k < 2; k++) {
      const SamControl control = Turn(&one, k);

      (void)Solve(&one, &control);
    }
    sam_call(SamContactReset(one.contact));
    sam_assert(StepsOf(&one) == 0);
    for (int k = 2; k < 4; k++) {
      const SamControl control = Turn(&one, k);
      const SamStep    a = Solve(&one, &control), b = Solve(&other, &control);

      AssertSameSteps(&one, &a, &other, &b);
      AssertSameFields(&one, &other);
    }
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

static void test_fields_of_another_grid_are_refused(void **state)
{
  Case             c = NewCase(Steel(), 40, 1.5, MU, ""), d = NewCase(Steel(), 24, 1.5, MU, "");
  const SamControl control = Loads(&c, 1, 0.3, 0, 0);
  Vec              shorter = NewField(d.s.grid, 1), both = NewField(c.s.grid, 2), right = NewField(c.s.grid, 1);
  PetscReal        number;
  SamState         held;

  (void)state;
  (void)Solve(&c, &control);
  (void)Solve(&d, &control);
  sam_call(SamContactGetState(c.contact, &held));
  sam_fails(SamContactSetState(d.contact, held, PETSC_TRUE), PETSC_ERR_ARG_SIZ);
  sam_call(SamContactGetState(d.contact, &held));
  sam_fails(SamContactSetState(c.contact, held, PETSC_TRUE), PETSC_ERR_ARG_SIZ);
  sam_fails(SamContactGetField(c.contact, "gap", shorter), PETSC_ERR_ARG_SIZ);
  sam_fails(SamContactGetField(c.contact, "state", shorter), PETSC_ERR_ARG_SIZ);
  sam_fails(SamContactGetField(c.contact, "slip_x", shorter), PETSC_ERR_ARG_SIZ);
  sam_fails(SamContactGetField(c.contact, "slip_y", both), PETSC_ERR_ARG_SIZ);
  sam_fails(SamContactGetField(c.contact, "shear", both), PETSC_ERR_ARG_SIZ);
  sam_fails(SamContactGetField(c.contact, "slip_z", right), PETSC_ERR_ARG_UNKNOWN_TYPE);
  sam_fails(SamContactGetField(c.contact, "contact_edge", right), PETSC_ERR_ARG_UNKNOWN_TYPE);
  sam_fails(SamContactGetNumber(c.contact, "slip_x", &number), PETSC_ERR_ARG_UNKNOWN_TYPE);
  sam_fails(SamProblemSetGap(c.problem, shorter), PETSC_ERR_ARG_SIZ);
  sam_fails(SamProblemSetFrictionField(c.problem, both), PETSC_ERR_ARG_SIZ);
  sam_destroy(&shorter, &both, &right);
  DestroyCase(&c);
  DestroyCase(&d);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_tries_leave_nothing_behind),
    cmocka_unit_test(test_tries_that_move_the_window_leave_nothing_behind),
    cmocka_unit_test(test_commit_without_a_tried_state_is_an_error),
    cmocka_unit_test(test_reject_gives_back_the_committed_solution),
    cmocka_unit_test(test_step_that_does_not_converge_is_not_committed_by_itself),
    cmocka_unit_test(test_there_is_no_shear_to_a_pressure_that_is_not_found),
    cmocka_unit_test(test_given_displacements_stay_when_the_pressure_is_not_found),
    cmocka_unit_test(test_step_without_equilibrium_leaves_the_contact_as_it_was),
    cmocka_unit_test(test_contact_with_the_state_of_another_goes_on_as_it_would),
    cmocka_unit_test(test_state_is_what_was_set),
    cmocka_unit_test(test_state_with_more_fields_is_refused),
    cmocka_unit_test(test_contact_that_is_reset_is_as_a_new_one),
    cmocka_unit_test(test_fields_of_another_grid_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

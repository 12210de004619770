/*
 * One load step, and its check: that right solutions pass it and wrong ones do not.
 */
#include "fields.h"

#include "../../src/contact/contactimpl.h"

static const double mu = 0.3;

/* A sphere of radius 0.1 m, a grid, and a contact with friction; loads in units of N, mu N and mu N a. */
typedef struct {
  Sphere     s;
  SamContact contact;
  double     friction;
} Case;

static Case NewCase(SamPair pair, PetscInt n, double half_width, double friction, const char *options)
{
  Case c = {.s = NewSphereOf(pair, n, half_width), .friction = friction};

  sam_call(PetscOptionsClear(NULL));
  sam_call(PetscOptionsInsertString(NULL, options));
  sam_call(SamContactCreate(c.s.elasticity, c.s.h, friction, &c.contact));
  sam_call(SamContactSetFromOptions(c.contact));
  sam_call(PetscOptionsClear(NULL));
  return c;
}

static void DestroyCase(Case *c)
{
  sam_call(SamContactDestroy(&c->contact));
  DestroySphere(&c->s);
}

static SamStep Loaded(const Case *c, double N, double x, double y, double z)
{
  const double  T    = c->friction > 0 ? c->friction * c->s.N : c->s.N;
  const SamStep step = {
    .normal = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {N * c->s.N, 0, 0}},
    .tangential = {.kind  = SAM_BALANCE_TANGENTIAL,
                   .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                   .load  = {x * T, y * T, z * T * c->s.a}}};

  return step;
}

static void Solve(Case *c, SamStep *step)
{
  sam_call(SamContactSolve(c->contact, step));
  if (getenv("SAM_SHOW"))
    print_message("# status %d passes %d check %g %g %g %g %g %s\n", (int)step->status, (int)step->coupling_iterations,
                  step->check.normal, step->check.tangential, step->check.equilibrium, step->check.cone,
                  step->check.edge, step->message);
}

static SamPair Steel(void)
{
  return NewPair(210e9, 0.3, 210e9, 0.3);
}

static void AssertGood(const SamStep *step)
{
  sam_assert(step->status == SAM_STATUS_CONVERGED);
  sam_assert(step->message[0] == '\0');
  sam_assert(step->check.normal < 2e-8); /* the tolerances of the solvers, and rounding */
  sam_assert(step->check.tangential < 2e-6);
  sam_assert(step->check.equilibrium < 1e-11);
  sam_assert(step->check.cone < 1e-13);
  sam_assert(step->check.edge == 0);
}

/* ---- steps ---- */

static void test_step_with_all_tangential_loads_passes_its_check(void **state)
{
  Case         c    = NewCase(Steel(), 64, 1.5, mu, "");
  SamStep      step = Loaded(&c, 1, 0.4, -0.3, 0.2);
  const double area = PETSC_PI * c.s.a * c.s.a;

  (void)state;
  Solve(&c, &step);
  AssertGood(&step);
  sam_assert(step.coupling_iterations == 1);
  sam_assert_close(step.contact_area, area, 0.03 * area); /* cells at the edge count or not: some h/a */
  sam_assert(step.stick_area > 0 && step.stick_area < step.contact_area);
  sam_assert(step.dissipated_energy > 0);
  DestroyCase(&c);
}

/* The slip of one step is the reference of the next: the same load again neither slips nor dissipates. */
static void test_second_step_with_the_same_load_dissipates_nothing(void **state)
{
  Case    c     = NewCase(Steel(), 40, 1.5, mu, "");
  SamStep first = Loaded(&c, 1, 0.5, 0, 0.1), second = Loaded(&c, 1, 0.5, 0, 0.1);

  (void)state;
  Solve(&c, &first);
  Solve(&c, &second);
  AssertGood(&second);
  sam_assert_close(second.dissipated_energy, 0,
                   1e-5 * first.dissipated_energy); /* rtol of the shear, times the condition */
  sam_assert_close(second.tangential.rigid[0], first.tangential.rigid[0], 1e-5 * first.tangential.rigid[0]);
  DestroyCase(&c);
}

/* -sum q.s dA = T d_x - sum q.u dA, with d_x by Mindlin's solution. */
static void test_dissipation_is_work_at_the_final_shear_less_that_of_the_elastic_part(void **state)
{
  Case         c    = NewCase(NewPair(210e9, 0, 210e9, 0), 64, 1.5, mu, "");
  SamStep      step = Loaded(&c, 1, 0.8, 0, 0);
  const double d0 = mu * c.s.a * c.s.a / c.s.R, T = mu * c.s.N, rest = 1 - 0.8;
  double       work, elastic;
  SamFields    f;

  (void)state;
  Solve(&c, &step);
  AssertGood(&step);
  sam_call(SamContactGetFields(c.contact, &f));
  work    = 0.8 * T * d0 * (1 - pow(rest, 2.0 / 3));
  elastic = Dot(f.shear, f.displacement_t) * c.s.grid->dx * c.s.grid->dy;
  sam_assert_close(step.dissipated_energy, work - elastic, 2e-2 * work); /* Mindlin's displacement on 64 cells */
  DestroyCase(&c);
}

static void test_gross_slip_is_told_with_its_limit(void **state)
{
  Case    c    = NewCase(Steel(), 40, 1.5, mu, "");
  SamStep step = Loaded(&c, 1, 1.1, 0, 0);

  (void)state;
  Solve(&c, &step);
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_assert(strstr(step.message, "load_tx") && strstr(step.message, "limit") && !strstr(step.message, "load_ty"));
  DestroyCase(&c);
}

/* Tractions and slip to the last bit, what is computed from them to `rest`, relative. */
static void AssertSameFields(const SamFields *a, const SamFields *b, double rest)
{
  PetscBool same[3];

  sam_call(VecEqual(a->pressure, b->pressure, &same[0]));
  sam_call(VecEqual(a->shear, b->shear, &same[1]));
  sam_call(VecEqual(a->slip, b->slip, &same[2]));
  sam_assert(same[0] && same[1] && same[2]);
  sam_assert(Difference(a->gap, b->gap, NORM_INFINITY) <= rest &&
             Difference(a->displacement_z, b->displacement_z, NORM_INFINITY) <= rest &&
             Difference(a->displacement_t, b->displacement_t, NORM_INFINITY) <= rest);
}

/* Loads of a sequence in which N stays for a while and T turns. */
static SamStep Turn(const Case *c, int k)
{
  const double N[] = {1, 1.1, 1.1, 1.1, 1.05}, T[] = {0.1, 0.3, 0.6, 0.2, -0.3};

  return Loaded(c, N[k], T[k], 0.1, 0);
}

/* Both contacts take the k-th step, to the last bit alike. */
static void AssertSameTurn(Case *one, Case *other, int k)
{
  SamStep   a = Turn(one, k), b = Turn(other, k);
  SamFields f[2];

  Solve(one, &a);
  Solve(other, &b);
  sam_call(SamContactGetFields(one->contact, &f[0]));
  sam_call(SamContactGetFields(other->contact, &f[1]));
  AssertSameFields(&f[0], &f[1], 0);
  sam_assert(a.tangential_iterations == b.tangential_iterations && a.dissipated_energy == b.dissipated_energy);
}

static void test_contact_with_the_state_of_another_goes_on_as_it_would(void **state)
{
  (void)state;
  for (int solved = 1; solved < 4; solved++) {
    Case            one = NewCase(Steel(), 45, 2, mu, ""), other = NewCase(Steel(), 45, 2, mu, "");
    SamContactState held;

    for (int k = 0; k < solved; k++) {
      SamStep step = Turn(&one, k);

      Solve(&one, &step);
    }
    sam_call(SamContactGetState(one.contact, &held));
    sam_call(SamContactSetState(other.contact, &held));
    for (int k = solved; k < 5; k++) AssertSameTurn(&one, &other, k);
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

/* What was given back is made again: similar and dissimilar bodies, steps of new and of the same pressure. */
static void test_last_step_is_as_any_other_and_may_be_followed(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    const SamPair pair = kind ? NewPair(210e9, 0.3, 70e9, 0.2) : Steel();
    Case          one = NewCase(pair, 45, 2, mu, ""), other = NewCase(pair, 45, 2, mu, "");

    sam_call(SamContactSetLast(other.contact, PETSC_TRUE));
    for (int k = 0; k < 4; k++) AssertSameTurn(&one, &other, k);
    DestroyCase(&one);
    DestroyCase(&other);
  }
}

static void test_step_without_equilibrium_leaves_the_contact_as_it_was(void **state)
{
  (void)state;
  for (int kind = 0; kind < 3; kind++) { /* gross slip at the same and at another N, and a moment that tips */
    Case    c = NewCase(Steel(), 45, 2, mu, ""), whole = NewCase(Steel(), 45, 2, mu, "");
    SamStep step, next, same, fails = Loaded(&c, kind == 1 ? 0.9 : 1.1, kind < 2 ? 1.5 : 0, 0, 0);

    if (kind == 2) fails.normal.load[2] = 9 * c.s.a * c.s.N;
    for (int k = 0; k < 3; k++) {
      step = Turn(&c, k);
      same = step;
      Solve(&c, &step);
      Solve(&whole, &same);
    }
    Solve(&c, &fails);
    sam_assert(fails.status == SAM_STATUS_NO_EQUILIBRIUM);
    {
      SamFields f[2];

      sam_call(SamContactGetFields(c.contact, &f[0]));
      sam_call(SamContactGetFields(whole.contact, &f[1]));
      AssertSameFields(&f[0], &f[1], 1e-13);
    }
    next = same = Turn(&c, 3);
    Solve(&c, &next);
    Solve(&whole, &same);
    AssertGood(&next);
    /* the starts differ, so the solutions do within the tolerances */
    sam_assert_close(next.tangential.rigid[0], same.tangential.rigid[0], 1e-7 * fabs(same.tangential.rigid[0]));
    sam_assert_close(next.normal.rigid[0], same.normal.rigid[0], 1e-9 * same.normal.rigid[0]);
    sam_assert_close(next.dissipated_energy, same.dissipated_energy, 1e-5 * same.dissipated_energy);
    DestroyCase(&c);
    DestroyCase(&whole);
  }
}

static void test_moment_beyond_the_grid_is_told(void **state)
{
  Case    c    = NewCase(Steel(), 40, 1.5, mu, "");
  SamStep step = Loaded(&c, 1, 0, 0, 0);

  (void)state;
  step.normal.load[2] = 1.6 * c.s.N * c.s.a;
  Solve(&c, &step);
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_assert(strstr(step.message, "load_my"));
  DestroyCase(&c);
}

static void test_contact_at_the_edge_of_the_grid_is_a_status(void **state)
{
  (void)state;
  for (int allowed = 0; allowed < 2; allowed++) {
    Case    c    = NewCase(Steel(), 40, 0.8, mu, allowed ? "-allow_edge_contact" : "-allow_edge_contact 0");
    SamStep step = Loaded(&c, 1, 0.3, 0, 0);

    Solve(&c, &step);
    sam_assert(step.status == (allowed ? SAM_STATUS_CONVERGED : SAM_STATUS_EDGE_CONTACT));
    sam_assert(strstr(step.message, "-grid_size"));
    sam_assert(step.check.edge > 0.1 && step.check.normal < 2e-8 && step.check.tangential < 2e-6);
    DestroyCase(&c);
  }
}

/* ---- dissimilar bodies ---- */

static void test_dissimilar_bodies_without_friction_need_one_pass(void **state)
{
  Case      c    = NewCase(NewPair(210e9, 0.3, 3e9, 0.2), 64, 1.5, 0, "");
  SamStep   step = Loaded(&c, 1, 0, 0, 0);
  SamFields f;

  (void)state;
  Solve(&c, &step);
  AssertGood(&step);
  sam_assert(step.coupling_iterations == 1);
  sam_call(SamContactGetFields(c.contact, &f));
  sam_assert(Norm(f.shear, NORM_INFINITY) == 0);
  sam_assert(Norm(f.slip, NORM_INFINITY) > 0); /* the surfaces slide on each other all the same */
  DestroyCase(&c);
}

/* Exchanging the bodies is looking from below: shear, slip and tangential loads change their sign. */
static void test_exchanged_bodies_have_the_same_pressure_and_opposite_shear(void **state)
{
  Case c        = NewCase(NewPair(210e9, 0.3, 70e9, 0.33), 48, 1.5, 0.2, ""),
       d        = NewCase(NewPair(70e9, 0.33, 210e9, 0.3), 48, 1.5, 0.2, "");
  SamStep   one = Loaded(&c, 1, 0.2, 0.1, 0), two = Loaded(&d, 1, -0.2, -0.1, 0);
  SamFields f, g;

  (void)state;
  Solve(&c, &one);
  Solve(&d, &two);
  sam_assert(one.status == SAM_STATUS_CONVERGED && two.status == SAM_STATUS_CONVERGED);
  sam_assert(one.coupling_iterations > 1);
  sam_call(SamContactGetFields(c.contact, &f));
  sam_call(SamContactGetFields(d.contact, &g));
  sam_assert_close(Difference(g.pressure, f.pressure, NORM_2), 0, 1e-4); /* -coupling_rtol 1e-6 at a rate of some 0.1 */
  sam_call(VecScale(g.shear, -1));
  sam_assert_close(Difference(g.shear, f.shear, NORM_2), 0, 1e-4);
  DestroyCase(&c);
  DestroyCase(&d);
}

static void test_coupling_can_be_left_out(void **state)
{
  Case    c    = NewCase(NewPair(210e9, 0.3, 70e9, 0.33), 40, 1.5, 0.2, "-coupling none");
  SamStep step = Loaded(&c, 1, 0.3, 0, 0);

  (void)state;
  Solve(&c, &step);
  AssertGood(&step);
  sam_assert(step.coupling_iterations == 1);
  DestroyCase(&c);
}

/* ---- the check ---- */

typedef void (*Spoil)(const Case *c, SamStep *step, SamFields *f);

/* Solves, spoils the solution, and checks what is left. */
static SamCheck CheckSpoilt(Spoil spoil)
{
  Case       c        = NewCase(Steel(), 48, 1.5, mu, "");
  SamStep    step     = Loaded(&c, 1, 0.5, 0.2, 0.1);
  SamBalance given[2] = {step.normal, step.tangential};
  SamFields  f;
  SamCheck   check;

  Solve(&c, &step);
  AssertGood(&step);
  sam_call(SamContactGetFields(c.contact, &f));
  if (spoil) spoil(&c, &step, &f);
  sam_call(
    SamContactCheck(c.s.elasticity, PETSC_TRUE, PETSC_FALSE, mu, c.s.h, NULL, &given[0], &given[1], &step, &f, &check));
  if (getenv("SAM_SHOW"))
    print_message("# spoilt: %g %g %g %g %g\n", check.normal, check.tangential, check.equilibrium, check.cone,
                  check.edge);
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

static void AddPressure(const Case *c, SamStep *step, SamFields *f)
{
  (void)step;
  AddAt(c->s.grid, 0, 20, 25, 0.01 * c->s.p0, f->pressure);
}

static void test_check_finds_wrong_pressure_in_one_cell(void **state)
{
  const SamCheck check = CheckSpoilt(AddPressure);

  (void)state;
  sam_assert(check.normal > 1e-4); /* 1 % of a cell's self-influence, about 1/n of the displacement */
  sam_assert(check.equilibrium > 1e-6);
}

static void AddTension(const Case *c, SamStep *step, SamFields *f)
{
  (void)step;
  AddAt(c->s.grid, 0, 1, 1, -1e-3 * c->s.p0, f->pressure);
}

static void test_check_finds_tension(void **state)
{
  const SamCheck check = CheckSpoilt(AddTension);

  (void)state;
  sam_assert(check.normal > 0.9e-3);
}

static void AddPressureOutside(const Case *c, SamStep *step, SamFields *f)
{
  (void)step;
  AddAt(c->s.grid, 0, 0, 30, 1e-6 * c->s.p0, f->pressure);
}

static void test_check_finds_pressure_across_a_gap_and_at_the_edge(void **state)
{
  const SamCheck check = CheckSpoilt(AddPressureOutside);

  (void)state;
  sam_assert(check.normal > 0.1); /* the gap there is as large as the approach */
  sam_assert_close(check.edge, 1e-6, 1e-8);
}

/* The shear of a cell at the contact's rim, where it slips, turned round: cone and size are as before. */
static void FlipShear(const Case *c, SamStep *step, SamFields *f)
{
  double *q;

  (void)step;
  sam_call(VecGetArray(f->shear, &q));
  for (PetscInt j = 0; j < c->s.grid->rows; j++) {
    const PetscInt k = j * c->s.grid->nx + 24 - 15; /* r = 0.91 a */

    if (c->s.grid->row_start + j != 24) continue;
    q[k] *= -1;
    q[k + c->s.grid->cells] *= -1;
  }
  sam_call(VecRestoreArray(f->shear, &q));
}

static void test_check_finds_shear_against_its_direction(void **state)
{
  const SamCheck check = CheckSpoilt(FlipShear);

  (void)state;
  sam_assert(check.tangential > 1e-2);
  sam_assert(check.cone < 1e-13);
  sam_assert(check.equilibrium > 1e-5);
}

static void StretchShear(const Case *c, SamStep *step, SamFields *f)
{
  (void)c;
  (void)step;
  sam_call(VecScale(f->shear, 1.01));
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

static void LiftBody(const Case *c, SamStep *step, SamFields *f)
{
  (void)c;
  (void)f;
  step->normal.rigid[0] *= 1 + 1e-4;
}

static void TurnBody(const Case *c, SamStep *step, SamFields *f)
{
  (void)f;
  step->normal.rigid[1] += 1e-4 * c->s.a / c->s.R;
}

static void test_check_finds_wrong_normal_displacement(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(LiftBody).normal > 0.9e-4);
  sam_assert(CheckSpoilt(TurnBody).normal > 0.9e-4);
}

static void ShiftBody(const Case *c, SamStep *step, SamFields *f)
{
  (void)c;
  (void)f;
  step->tangential.rigid[0] *= 1 + 1e-3;
}

static void TwistBody(const Case *c, SamStep *step, SamFields *f)
{
  (void)c;
  (void)f;
  step->tangential.rigid[2] *= 1.01;
}

static void test_check_finds_wrong_tangential_displacement(void **state)
{
  (void)state;
  sam_assert(CheckSpoilt(ShiftBody).tangential > 1e-4);
  sam_assert(CheckSpoilt(TwistBody).tangential > 1e-4);
}

static void PutNanIntoPressure(const Case *c, SamStep *step, SamFields *f)
{
  (void)step;
  AddAt(c->s.grid, 0, 20, 40, NAN, f->pressure);
}

static void PutNanIntoShear(const Case *c, SamStep *step, SamFields *f)
{
  (void)step;
  AddAt(c->s.grid, 1, 20, 40, NAN, f->shear);
}

static void PutNanIntoDisplacement(const Case *c, SamStep *step, SamFields *f)
{
  (void)c;
  (void)f;
  step->normal.rigid[0]     = NAN;
  step->tangential.rigid[2] = NAN;
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

/* ---- the prediction of the next step ---- */

/*
  Hertz's pressure of radius a, and of Cattaneo's shear under T = (1 - (c/a)^3) mu N: mu times it less that of radius
  c.
*/
typedef struct {
  double a, c;
} Stage;

static double HertzOf(double radius, double x, double y)
{
  const double left = radius * radius - x * x - y * y;

  return left > 0 ? sqrt(left) : 0;
}

static double StagePressure(double x, double y, const void *stage)
{
  return HertzOf(((const Stage *)stage)->a, x, y);
}

static double StageShear(double x, double y, const void *stage)
{
  return mu * (HertzOf(((const Stage *)stage)->a, x, y) - HertzOf(((const Stage *)stage)->c, x, y));
}

static Vec NewShear(SamGrid grid, const Stage *stage)
{
  Vec     q = NewField(grid, 2), x = NewFrom(grid, StageShear, stage);
  double *a, *b;

  sam_call(VecGetArray(q, &a));
  sam_call(VecGetArray(x, &b));
  for (PetscInt k = 0; k < grid->cells; k++) a[k] = b[k];
  sam_call(VecRestoreArray(x, &b));
  sam_call(VecRestoreArray(q, &a));
  sam_call(VecDestroy(&x));
  return q;
}

/* Extrapolates from two stages of equal way in a^2 and c^2 to the third; returns the errors of p and q, relative. */
static void PredictStages(const Stage stages[3], double errors[2])
{
  SamGrid   grid = NewGrid(61, 47, 2.4, 2.4);
  Vec       p[3], q[3];
  PetscBool found;

  for (int k = 0; k < 3; k++) {
    p[k] = NewFrom(grid, StagePressure, &stages[k]);
    q[k] = NewShear(grid, &stages[k]);
  }
  errors[0] = Norm(p[2], NORM_2);
  errors[1] = Norm(q[2], NORM_2);
  sam_call(SamExtrapolate(grid, mu, 1, p[1], q[1], p[0], q[0], &found));
  sam_assert(found);
  errors[0] = Difference(p[1], p[2], NORM_2) / errors[0];
  errors[1] = Difference(q[1], q[2], NORM_2) / errors[1];
  for (int k = 0; k < 3; k++) {
    sam_call(VecDestroy(&p[k]));
    sam_call(VecDestroy(&q[k]));
  }
  sam_call(SamGridDestroy(&grid));
}

static void test_prediction_follows_the_edge_of_stick(void **state)
{
  const Stage stages[3] = {{1, 0.8}, {1, sqrt(0.54)}, {1, sqrt(0.44)}};
  double      errors[2];

  (void)state;
  PredictStages(stages, errors);
  /* both squares are linear in c^2: exact; extrapolating q itself would be wrong by 7 % */
  sam_assert_close(errors[0], 0, 1e-14);
  sam_assert_close(errors[1], 0, 1e-12);
}

static void test_prediction_follows_the_edge_of_contact(void **state)
{
  const Stage stages[3] = {{1, 0}, {sqrt(0.9), 0}, {sqrt(0.8), 0}};
  double      errors[2];

  (void)state;
  PredictStages(stages, errors);
  sam_assert_close(errors[0], 0, 1e-12);
  sam_assert_close(errors[1], 0, 1e-12);
}

static void test_prediction_keeps_what_would_vanish(void **state)
{
  SamGrid   grid = NewGrid(8, 5, 1, 1);
  Vec       p = NewField(grid, 1), q = NewField(grid, 2), p0 = Copy(p), q0 = Copy(q);
  PetscBool found;

  (void)state;
  sam_call(VecSet(p, 1));
  sam_call(VecSet(p0, 2));
  sam_call(VecSet(q, 0.1));
  sam_call(SamExtrapolate(grid, mu, 1, p, q, p0, q0, &found));
  sam_assert(!found);
  sam_assert(Norm(p, NORM_INFINITY) == 1 && Norm(p0, NORM_INFINITY) == 1 && Norm(q, NORM_INFINITY) == 0.1);
  sam_call(VecDestroy(&p));
  sam_call(VecDestroy(&q));
  sam_call(VecDestroy(&p0));
  sam_call(VecDestroy(&q0));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_step_with_all_tangential_loads_passes_its_check),
    cmocka_unit_test(test_second_step_with_the_same_load_dissipates_nothing),
    cmocka_unit_test(test_dissipation_is_work_at_the_final_shear_less_that_of_the_elastic_part),
    cmocka_unit_test(test_gross_slip_is_told_with_its_limit),
    cmocka_unit_test(test_contact_with_the_state_of_another_goes_on_as_it_would),
    cmocka_unit_test(test_last_step_is_as_any_other_and_may_be_followed),
    cmocka_unit_test(test_step_without_equilibrium_leaves_the_contact_as_it_was),
    cmocka_unit_test(test_moment_beyond_the_grid_is_told),
    cmocka_unit_test(test_contact_at_the_edge_of_the_grid_is_a_status),
    cmocka_unit_test(test_dissimilar_bodies_without_friction_need_one_pass),
    cmocka_unit_test(test_exchanged_bodies_have_the_same_pressure_and_opposite_shear),
    cmocka_unit_test(test_coupling_can_be_left_out),
    cmocka_unit_test(test_check_agrees_with_itself),
    cmocka_unit_test(test_check_finds_wrong_pressure_in_one_cell),
    cmocka_unit_test(test_check_finds_tension),
    cmocka_unit_test(test_check_finds_pressure_across_a_gap_and_at_the_edge),
    cmocka_unit_test(test_check_finds_shear_against_its_direction),
    cmocka_unit_test(test_check_finds_shear_beyond_the_cone),
    cmocka_unit_test(test_check_finds_wrong_normal_displacement),
    cmocka_unit_test(test_check_finds_wrong_tangential_displacement),
    cmocka_unit_test(test_nan_does_not_pass_the_check),
    cmocka_unit_test(test_nan_is_no_equilibrium),
    cmocka_unit_test(test_prediction_follows_the_edge_of_stick),
    cmocka_unit_test(test_prediction_follows_the_edge_of_contact),
    cmocka_unit_test(test_prediction_keeps_what_would_vanish),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

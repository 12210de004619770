/*
 * Friction that follows the slip of the step: shear and bound are solved together. The law and the body are those of
 * the plugin in examples/embed.
 */
#include "derivatives.h"

#include "../../examples/embed/plugin/plugin.h"
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/problemimpl.h>

#define N      13
#define WIDTH  1e-3
#define P      1e8
#define LENGTH 1e-6
#define FINAL  0.25

/* Planes of periodic bodies under a coating of compliance c (m/Pa) and the mean pressure P: all cells do the same. */
typedef struct {
  SamGrid       grid;
  SamPair       pair;
  SamElasticity elasticity;
  SamProblem    problem;
  SamContact    contact;
  double        c;
} Planes;

static PetscErrorCode CreatePlanes(SamElasticity e)
{
  PetscCall(CreateCoated(e));
  return SamElasticitySetInner(e, SAM_ELASTICITY_PERIODIC);
}

static Planes NewPlanes(SamPair pair, double c, const char *fading)
{
  Planes p = {.grid = NewGrid(N, N + 1, WIDTH, WIDTH), .pair = pair, .c = c};
  char   options[256];

  sam_call(SamElasticityRegister("planes", CreatePlanes));
  sam_call(SamLawRegister("fading", CreateFading));
  (void)snprintf(options, sizeof(options),
                 "-elasticity planes -coating_compliance %.17g -friction %g -coupling none %s", c, MU, fading);
  SetOptions(options);
  sam_call(SamElasticityCreate(p.grid, p.pair, &p.elasticity));
  sam_call(SamElasticitySetFromOptions(p.elasticity));
  sam_call(SamProblemCreate(p.elasticity, &p.problem));
  sam_call(SamProblemSetLawsFromOptions(p.problem, &(SamOptions){PETSC_COMM_WORLD, NULL}));
  sam_call(SamContactCreate(p.problem, &p.contact));
  sam_call(SamContactSetFromOptions(p.contact));
  SetOptions("");
  return p;
}

static void DestroyPlanes(Planes *p)
{
  sam_call(SamContactDestroy(&p->contact));
  sam_call(SamProblemDestroy(&p->problem));
  sam_call(SamElasticityDestroy(&p->elasticity));
  sam_call(SamGridDestroy(&p->grid));
}

static SamStep TryMove(const Planes *p, double x)
{
  SamControl control;
  SamStep    step;

  sam_call(SamControlInitialize(&control));
  control.value[SAM_COMPONENT_N] = P * WIDTH * WIDTH;
  Displace(&control, SAM_COMPONENT_TX, x);
  sam_call(SamContactTry(p->contact, &control, &step));
  return step;
}

/* The law, written anew. */
static double Friction(double path)
{
  return MU * (FINAL + (1 - FINAL) * exp(-path / LENGTH));
}

/* One cell: the shear after a move of the other body to x; s and path are its slip and path before, and after it. */
static double MoveCell(double c, double x, double *s, double *path)
{
  /* slip c q - x: without further slip q = (s + x)/c */
  const double stick = (*s + x) / c, sign = stick > 0 ? 1 : -1;
  double       low = 0, high = fabs(stick) * c;

  if (fabs(stick) <= Friction(*path) * P) return stick;
  for (int k = 0; k < 200; k++) { /* the slip d of the step: |stick| - d/c = mu(path + d) P */
    const double d = 0.5 * (low + high);

    if (fabs(stick) - d / c > Friction(*path + d) * P)
      low = d;
    else
      high = d;
  }
  *s -= sign * low;
  *path += low;
  return sign * Friction(*path) * P;
}

static double NormOf(Vec field)
{
  PetscReal norm;

  sam_call(VecNorm(field, NORM_INFINITY, &norm));
  return (double)norm;
}

static void AssertField(const Planes *p, const char *name, double value, double tolerance)
{
  Vec       field = NewField(p->grid, 1);
  PetscReal least, most;

  sam_call(SamContactGetField(p->contact, name, field));
  sam_call(VecMin(field, NULL, &least));
  sam_call(VecMax(field, NULL, &most));
  sam_assert_close(least, value, tolerance);
  sam_assert_close(most, value, tolerance);
  sam_call(VecDestroy(&field));
}

/* Step after step there and back, the shear is that of one cell, and what it dissipates is force times slip. */
static void test_all_cells_slide_like_one(void **state)
{
  /* how fast friction falls at first, MU P (1 - FINAL)/LENGTH, as a part of how fast the coating unloads, 1/c */
  static const double part[] = {0.9, 0.3, 1e-3}, moves[] = {0, 1e-7, 6e-7, 8e-7, 2.4e-6, 1e-6, -2e-6, 3e-6};

  (void)state;
  for (int k = 0; k < 3; k++) {
    const double c    = part[k] * LENGTH / (MU * P * (1 - FINAL));
    Planes       p    = NewPlanes(Steel(), c, "-fading_length 1e-6 -fading_final 0.25");
    double       path = 0, s = 0, before = MU * P;

    for (size_t m = 0; m < sizeof(moves) / sizeof(moves[0]); m++) {
      const double slip = s, q = MoveCell(c, moves[m], &s, &path),
                   work  = fabs(s - slip) * 0.5 * (before + Friction(path) * P);
      const SamStep step = TryMove(&p, moves[m]);
      PetscReal     energy;

      sam_assert(step.status == SAM_STATUS_CONVERGED);
      AssertField(&p, "shear_x", q, 2e-6 * MU * P);
      AssertField(&p, "slip_x", s, 1e-5 * LENGTH);
      AssertField(&p, "fading_path", path, 1e-5 * LENGTH);
      sam_assert_close(step.load[SAM_COMPONENT_TX], q * WIDTH * WIDTH, 2e-6 * MU * P * WIDTH * WIDTH);
      sam_call(SamContactGetNumber(p.contact, "dissipated_energy", &energy));
      sam_assert_close(energy, work * WIDTH * WIDTH, 1e-5 * MU * P * LENGTH * WIDTH * WIDTH);
      sam_call(SamContactCommit(p.contact));
      before = Friction(path) * P;
    }
    DestroyPlanes(&p);
  }
}

/* ---- spheres ---- */

/* Adds the law to a contact: with `final` above 1 friction grows with the slip. */
static Case AddFading(Case c, double length, double final)
{
  char   fading[128];
  SamLaw law;

  sam_call(SamLawRegister("fading", CreateFading));
  sam_call(SamProblemAddLawOfType(c.problem, "fading", &law));
  (void)snprintf(fading, sizeof(fading), "-fading_length %.17g -fading_final %g", length, final);
  SetOptions(fading);
  sam_call(SamLawSetFromOptions(law, &(SamOptions){c.s.grid->comm, NULL}, &(PetscBool){PETSC_FALSE}));
  SetOptions("");
  return c;
}

static Case NewFading(SamPair pair, double length, const char *options)
{
  return AddFading(NewCase(pair, 41, 1.6, MU, options), length, FINAL);
}

/* The slip that a sphere's contact has before it slides, by orders of magnitude. */
static double TypicalSlip(const Case *c)
{
  return MU * c->s.a * c->s.a / c->s.R;
}

/* |q| = bound where surfaces slip, < bound elsewhere, by the path after it. The part of the contact that slips. */
static double AssertBound(const Case *c, double length)
{
  const SamSolution *s     = SolutionOf(c);
  const PetscInt     cells = c->s.grid->cells;
  Vec                field[2];
  const double      *p, *q, *path, *state;
  double             worst[2] = {0, 0}, counts[2] = {0, 0};

  for (int k = 0; k < 2; k++) field[k] = NewField(c->s.grid, 1);
  sam_call(SamContactGetField(c->contact, "fading_path", field[0]));
  sam_call(SamContactGetField(c->contact, "state", field[1]));
  sam_call(VecGetArrayRead(s->pressure, &p));
  sam_call(VecGetArrayRead(s->shear, &q));
  sam_call(VecGetArrayRead(field[0], &path));
  sam_call(VecGetArrayRead(field[1], &state));
  for (PetscInt k = 0; k < cells; k++) {
    const double bound = MU * (FINAL + (1 - FINAL) * exp(-path[k] / length)) * p[k], size = hypot(q[k], q[k + cells]);

    worst[0] = fmax(worst[0], state[k] == SAM_CELL_SLIP ? fabs(size - bound) : size - bound);
    worst[1] = fmax(worst[1], bound);
    counts[0] += state[k] == SAM_CELL_SLIP;
    counts[1] += p[k] > 0;
  }
  sam_call(VecRestoreArrayRead(field[1], &state));
  sam_call(VecRestoreArrayRead(field[0], &path));
  sam_call(VecRestoreArrayRead(s->shear, &q));
  sam_call(VecRestoreArrayRead(s->pressure, &p));
  for (int k = 0; k < 2; k++) sam_call(VecDestroy(&field[k]));
  sam_call(SamMax(c->s.grid->comm, 2, worst));
  sam_call(SamSum(c->s.grid->comm, 2, counts));
  sam_assert(worst[0] <= 1e-5 * worst[1]);
  return counts[0] / counts[1];
}

static void test_shear_is_at_the_bound_of_the_slip_that_it_has(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    const SamPair pair   = k ? Dissimilar() : Steel();
    Sphere        s      = NewSphereOf(pair, 9, 2);
    const double  length = 0.3 * MU * s.a * s.a / s.R, moves[] = {0, 0.3, 0.5, -0.2, 0.4};
    Case          c        = NewFading(pair, length, "");
    double        slipping = 0;

    DestroySphere(&s);
    for (int m = 0; m < 5; m++) {
      SamControl control = Loads(&c, 1, 0, 0.02 * m, 0);
      SamStep    step;

      Displace(&control, SAM_COMPONENT_TX, moves[m] * TypicalSlip(&c));
      step = Solve(&c, &control);
      sam_assert(step.status == SAM_STATUS_CONVERGED);
      sam_assert(step.check.cone <= 1e-6);
      slipping = fmax(slipping, AssertBound(&c, length));
    }
    sam_assert(slipping > 0.2);
    sam_assert_close(length, 0.3 * TypicalSlip(&c), 1e-12 * length);
    DestroyCase(&c);
  }
}

static void test_law_that_does_not_fade_changes_nothing(void **state)
{
  Case    c[2] = {NewCase(Steel(), 41, 1.6, MU, ""), NewFading(Steel(), INFINITY, "")};
  SamStep step[2];

  (void)state;
  for (int m = 0; m < 3; m++) {
    const SamControl control = Loads(&c[0], 1, 0.4 * m, 0, 0);

    for (int k = 0; k < 2; k++) step[k] = Solve(&c[k], &control);
  }
  sam_assert(!step[0].status && !step[1].status);
  sam_assert(Difference(SolutionOf(&c[0])->shear, SolutionOf(&c[1])->shear, NORM_INFINITY) <= 1e-5);
  for (int k = 0; k < 2; k++) DestroyCase(&c[k]);
}

/* Friction that falls much faster than the bodies unload: the surfaces jump. */
static void test_step_that_jumps_fails_by_the_name_of_the_law(void **state)
{
  Case       c       = NewFading(Dissimilar(), 1e-8, "");
  SamControl control = Loads(&c, 1, 0, 0, 0);
  SamStep    step;

  (void)state;
  Displace(&control, SAM_COMPONENT_TX, 0.1 * TypicalSlip(&c));
  step = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_NOT_CONVERGED);
  sam_assert(strstr(step.message, "law fading") && strstr(step.message, "smaller"));
  DestroyCase(&c);
}

/* Loads that one step does not reach: what the friction bears by its slip is no limit, as smaller steps reach more. */
static void test_load_that_slip_leaves_unbalanced_names_no_limit(void **state)
{
  Case       plain = NewCase(Steel(), 41, 1.6, MU, ""), c = NewFading(Steel(), 0.1 * TypicalSlip(&plain), "");
  double     borne = 0, reached = 0;
  SamControl control;
  SamStep    step;

  (void)state;
  control = Loads(&c, 1, 0.75, 0, 0);
  step    = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_NO_EQUILIBRIUM);
  sam_assert(!strstr(step.message, "limit") && strstr(step.message, "use smaller load steps"));
  sam_assert(sscanf(strchr(step.message, '('), "(%lf at the slip of the last iteration)", &borne) == 1);
  for (int k = 1; k <= 75; k++) {
    control = Loads(&c, 1, 0.01 * k, 0, 0);
    step    = Try(&c, &control);
    if (step.status != SAM_STATUS_CONVERGED) break;
    sam_call(SamContactCommit(c.contact));
    reached = control.value[SAM_COMPONENT_TX];
  }
  sam_assert(reached > borne);
  DestroyCase(&plain);
  DestroyCase(&c);
}

static void test_derivatives_of_the_bound(void **state)
{
  const double     eps = 1e-4, length = 1e-6;
  Case             c       = NewFading(Steel(), length, "");
  const SamControl control = Loads(&c, 1, 0.5, 0, 0);
  const SamControl scaled  = Scaled(c.problem, 0.7);
  SamBoundAt       at      = {NULL, &scaled, NewField(c.s.grid, 1), NewField(c.s.grid, 1), 0};
  SamBound         b       = {NewField(c.s.grid, 1), NewField(c.s.grid, 1), NewField(c.s.grid, 1)};
  Vec              other   = NewField(c.s.grid, 1);

  (void)state;
  (void)Solve(&c, &control);
  sam_call(SamContactGetState(c.contact, &at.state));
  sam_call(VecSet(at.pressure, P));
  sam_call(VecSet(at.slip, length));
  sam_call(SamProblemComputeBound(c.problem, &at, &b));
  sam_call(VecSet(at.pressure, P * (1 + eps)));
  sam_call(SamProblemComputeBound(c.problem, &at, &(SamBound){.value = other}));
  sam_call(VecAXPY(other, -1, b.value));
  sam_call(VecAXPY(other, -eps * P, b.by_pressure));
  sam_assert(NormOf(other) <= 1e-9 * MU * P);
  sam_call(VecSet(at.pressure, P));
  sam_call(VecSet(at.slip, length * (1 + eps)));
  sam_call(SamProblemComputeBound(c.problem, &at, &(SamBound){.value = other}));
  sam_call(VecAXPY(other, -1, b.value));
  sam_assert(NormOf(other) >= 1e-6 * MU * P);
  sam_call(VecAXPY(other, -eps * length, b.by_slip));
  sam_assert(NormOf(other) <= 1e-8 * MU * P);
  sam_destroy(&at.pressure, &at.slip, &b.value, &b.by_pressure, &b.by_slip, &other);
  DestroyCase(&c);
}

/*
  Loads of all kinds beyond a committed step, by the rigid displacements that belong to them; solved well enough for
  differences.
*/
static Case NewFaded(SamPair pair, double final, PetscReal rigid[SAM_COMPONENTS])
{
  Case       c = NewCase(pair, 40, 1.4, MU,
                         "-normal_rtol 1e-11 -tangential_rtol 1e-10 -coupling_rtol 1e-10 "
                               "-slip_direction end");
  SamControl control;
  SamStep    step;

  c       = AddFading(c, 0.3 * TypicalSlip(&c), final);
  control = Loads(&c, 1, 0.25, 0, 0);
  step    = Solve(&c, &control);
  sam_assert(step.status == SAM_STATUS_CONVERGED);
  control           = Loads(&c, 1, 0.4, -0.15, 0.1);
  control.value[MX] = 0.05 * control.value[Z] * c.s.a;
  control.value[MY] = -0.1 * control.value[Z] * c.s.a;
  step              = Try(&c, &control);
  sam_assert(step.status == SAM_STATUS_CONVERGED);
  memcpy(rigid, step.rigid, sizeof(step.rigid));
  return c;
}

/* Friction that falls, and that grows; what the change with the slip adds is far more than the differences' error. */
static void test_stiffness_is_the_derivative_of_trials(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    PetscReal          rigid[SAM_COMPONENTS];
    Case               c = NewFaded(k % 2 ? Dissimilar() : Steel(), k / 2 ? 2.5 : FINAL, rigid);
    const SamStiffness s = Stiffness(&c, SAM_STIFFNESS_FORWARD);
    double             error;

    sam_assert(s.converged);
    error = ErrorOf(&c, &s, rigid, 1e-5);
    if (getenv("SAM_SHOW")) print_message("# error %g after %d products\n", error, (int)s.applies);
    sam_assert(error < 1e-4);
    DestroyCase(&c);
  }
}

static void test_stiffness_has_the_same_bits_on_any_number_of_ranks(void **state)
{
  const Case   bare = NewCase(Steel(), 45, 1.4, MU, "");
  const double slip = 0.3 * TypicalSlip(&bare);
  Case         c    = AddFading(bare, slip, FINAL),
       alone = AddFading(NewCaseOn(NewSphereOn(PETSC_COMM_SELF, Steel(), 45, 1.4, 0, 0), MU, NULL, ""), slip, FINAL);
  const SamControl control = Loads(&c, 1, 0.4, 0.2, 0.1);
  SamStiffness     k, one;

  (void)state;
  sam_assert(!Try(&c, &control).status && !Try(&alone, &control).status);
  k   = Stiffness(&c, SAM_STIFFNESS_FORWARD);
  one = Stiffness(&alone, SAM_STIFFNESS_FORWARD);
  sam_assert(k.converged && !memcmp(k.k, one.k, sizeof(k.k)));
  DestroyCase(&c);
  DestroyCase(&alone);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_all_cells_slide_like_one),
    cmocka_unit_test(test_shear_is_at_the_bound_of_the_slip_that_it_has),
    cmocka_unit_test(test_law_that_does_not_fade_changes_nothing),
    cmocka_unit_test(test_step_that_jumps_fails_by_the_name_of_the_law),
    cmocka_unit_test(test_load_that_slip_leaves_unbalanced_names_no_limit),
    cmocka_unit_test(test_derivatives_of_the_bound),
    cmocka_unit_test(test_stiffness_is_the_derivative_of_trials),
    cmocka_unit_test(test_stiffness_has_the_same_bits_on_any_number_of_ranks),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

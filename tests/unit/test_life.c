/* Wear over many cycles: Popov's limiting shape and the way to it, sliding under constant load, laws, failures. */
#include "contacts.h"

#include <petsam/private/life.h>
#include <petsam/wear.h>

#define K 1e-14 /* 1/Pa */

#define STEEL NewPair(210e9, 0, 210e9, 0)

/* To and fro along x between +-amplitude, from 0 to 0. */
typedef struct {
  const Case *c;
  PetscBool   approach, force; /* the approach is given instead of N; T_x instead of d_x */
  double      amplitude;       /* m; N */
  double      rock;            /* amplitude of M_y over N a */
  double      fast;            /* coefficient of wear over K; 0: 1 */
  PetscInt    steps;
} Strokes;

static PetscErrorCode Control(void *context, PetscInt step, PetscReal cycles, SamControl *control)
{
  const Strokes *s = (const Strokes *)context;
  const double   t = (double)(step + 1) / (double)s->steps, x = s->amplitude * (t <= 0.25   ? 4 * t
                                                                                : t <= 0.75 ? 2 - 4 * t
                                                                                            : 4 * t - 4);

  (void)cycles;
  *control = Loads(s->c, 1, 0, 0, 0);
  if (s->rock > 0) control->value[SAM_COMPONENT_MY] = s->rock * s->c->s.N * s->c->s.a * sin(2 * PETSC_PI * t);
  if (s->approach) Displace(control, SAM_COMPONENT_N, s->c->s.a * s->c->s.a / s->c->s.R);
  if (s->force) {
    control->value[SAM_COMPONENT_TX] = x;
  } else {
    Displace(control, SAM_COMPONENT_TX, x);
    Displace(control, SAM_COMPONENT_TY, 0);
    Displace(control, SAM_COMPONENT_MZ, 0);
  }
  if (s->approach) {
    Displace(control, SAM_COMPONENT_MX, 0);
    Displace(control, SAM_COMPONENT_MY, 0);
  }
  return 0;
}

typedef struct {
  Case         c;
  Strokes      strokes;
  SamLifeCycle cycle;
  PetscReal    wear[2];
  SamLawType   law;
  SamLife      life; /* NULL: none */
} Joint;

/* A joint at rest where its cycle begins. */
static Joint *NewRest(SamPair pair, PetscInt n, double half_width, double friction, Strokes strokes, SamLawType law)
{
  const double fast = strokes.fast > 0 ? strokes.fast : 1;
  Joint       *j    = (Joint *)calloc(1, sizeof(*j));
  SamControl   control;
  SamStep      step;

  j->c         = NewCase(pair, n, half_width, friction, "");
  j->law       = law;
  j->wear[1]   = fast * (strcmp(law, SAM_LAW_ENERGY) ? K : K / friction);
  j->strokes   = strokes;
  j->strokes.c = &j->c;
  j->cycle     = (SamLifeCycle){.steps = strokes.steps, .control = Control, .context = &j->strokes};
  sam_call(Control(&j->strokes, strokes.steps - 1, 0, &control));
  step = Solve(&j->c, &control);
  AssertGood(&step);
  return j;
}

/* The same with its life. */
static Joint *NewJoint(SamPair pair, PetscInt n, double half_width, double friction, Strokes strokes, SamLawType law,
                       SamLifeSettings settings)
{
  Joint *j = NewRest(pair, n, half_width, friction, strokes, law);

  AddWear(&j->c, j->law, j->wear);
  sam_call(SamLifeCreate(j->c.contact, &j->cycle, &settings, &j->life));
  return j;
}

static void DestroyJoint(Joint *j)
{
  sam_call(SamLifeDestroy(&j->life));
  DestroyCase(&j->c);
  free(j);
}

static SamLifeReport Live(Joint *j, double cycles)
{
  SamLifeReport r;

  for (;;) {
    sam_call(SamLifeCompute(j->life, &r));
    sam_assert(r.step.status == SAM_STATUS_CONVERGED || r.step.status == SAM_STATUS_EDGE_CONTACT);
    if (r.cycles >= cycles * (1 - 1e-12)) return r;
    sam_call(SamLifeJump(j->life, cycles, &r));
    sam_assert(r.step.status == SAM_STATUS_CONVERGED || r.step.status == SAM_STATUS_EDGE_CONTACT);
  }
}

/*
  A sphere under a given approach d and a given amplitude of d_x, stick radius a0/2: after tau = 4 k E* u n/a0 its
  volume over a0^2 d, largest depth over d, N over the first one, contact radius over a0. At last it has Popov's shape
  (2014, Sci. Rep. 4, 3749).
*/
static void test_sphere_wears_towards_popovs_shape(void **state)
{
  static const double table[][5] = {{0.1, 0.01233, 0.00792, 0.99360, 1.0165},
                                    {1, 0.13092, 0.07102, 0.93843, 1.083},
                                    {10, 0.7481, 0.29345, 0.6920, 1.226}};
  const double        mu         = 0.1;
  Joint *j = NewJoint(STEEL, 72, 1.4, mu, (Strokes){.approach = PETSC_TRUE, .steps = 8, .amplitude = 0.75 * mu * 1e-5},
                      SAM_LAW_ARCHARD, (SamLifeSettings){.rtol = 1e-2});
  const Sphere *s = &j->c.s;
  const double  d = s->a * s->a / s->R, unit = s->a / (4 * K * s->pair->modulus * j->strokes.amplitude);

  (void)state;
  for (int k = 0; k < 3; k++) {
    const SamLifeReport r = Live(j, table[k][0] * unit);

    if (getenv("SAM_SHOW"))
      print_message("# tau %g: V %g depth %g N %g a %g computed %d\n", table[k][0], r.volume[1] / (s->a * s->a * d),
                    r.depth[1] / d, r.step.load[0] / s->N, sqrt(r.contact_area / PETSC_PI) / s->a, (int)r.computed);
    sam_assert_close(r.volume[1] / (s->a * s->a * d), table[k][1], 0.02 * table[k][1]);
    sam_assert_close(r.depth[1] / d, table[k][2], 0.02 * table[k][2]);
    sam_assert_close(r.step.load[0] / s->N, table[k][3], 0.004);
    sam_assert_close(sqrt(r.contact_area / PETSC_PI) / s->a, table[k][4], 0.02);
    sam_assert(r.volume[0] == 0 && r.computed <= 60);
  }
  DestroyJoint(j);
}

/* Every cell slips by the whole stroke under constant N: V = k N 4 u n, however long the jumps are; its shape. */
static void test_volume_of_a_sliding_sphere_is_exact(void **state)
{
  const double  u         = 1e-4;
  Joint        *j         = NewJoint(STEEL, 64, 2.6, 1e-9, (Strokes){.steps = 4, .amplitude = u}, SAM_LAW_ARCHARD,
                                     (SamLifeSettings){.rtol = 1e-2});
  const Sphere *s         = &j->c.s;
  const double  cycles[2] = {s->a / (4 * K * s->pair->modulus * u), 30 * s->a / (4 * K * s->pair->modulus * u)};
  SamLifeReport r         = Live(j, cycles[0]);

  (void)state;
  sam_assert_close(r.volume[1], K * s->N * 4 * u * cycles[0], 1e-6 * r.volume[1]);
  sam_assert_close(sqrt(r.contact_area / PETSC_PI) / s->a, 1.305, 0.02);
  sam_assert_close(r.depth[1] * s->R / (s->a * s->a), 0.4891, 0.01);
  sam_assert_close(r.pressure / s->p0, 0.5875, 0.01);
  r = Live(j, cycles[1]);
  sam_assert_close(r.volume[1], K * s->N * 4 * u * cycles[1], 1e-6 * r.volume[1]);
  /* long times: uniform pressure, a^4 = 4 R V/pi */
  sam_assert_close(sqrt(r.contact_area / PETSC_PI), pow(4 * s->R * r.volume[1] / PETSC_PI, 0.25), 0.03 * s->a);
  DestroyJoint(j);
}

/* At constant friction the laws are the same. */
static void test_both_laws_live_alike(void **state)
{
  double volume[2], depth[2];

  (void)state;
  for (int law = 0; law < 2; law++) {
    const double mu = 0.2;
    Joint       *j =
      NewJoint(STEEL, 40, 1.5, mu, (Strokes){.approach = PETSC_TRUE, .steps = 8, .amplitude = 0.75 * mu * 1e-5},
               law ? SAM_LAW_ENERGY : SAM_LAW_ARCHARD, (SamLifeSettings){.rtol = 2e-2});
    SamLifeReport r = Live(j, 1e5);

    volume[law] = r.volume[1];
    depth[law]  = r.depth[1];
    DestroyJoint(j);
  }
  sam_assert(volume[0] > 0);
  sam_assert_close(volume[1], volume[0], 1e-6 * volume[0]);
  sam_assert_close(depth[1], depth[0], 1e-6 * depth[0]);
}

/* After some cycles that close the loop, every step of so many wears, one after the other. */
static void LiveDirectly(Joint *j, PetscInt cycles)
{
  const PetscInt first = -3 * j->cycle.steps;

  for (PetscInt k = first; k < cycles * j->cycle.steps; k++) {
    SamControl control;
    SamStep    step;

    if (k == 0) AddWear(&j->c, j->law, j->wear);
    sam_call(Control(&j->strokes, (k - first) % j->cycle.steps, 0, &control));
    step = Solve(&j->c, &control);
    AssertGood(&step);
  }
}

/* What all cycles would have come to, one by one. */
typedef struct {
  double volume, most;
} Worn;

static Worn WearDirectly(SamPair pair, Strokes strokes, PetscInt cycles)
{
  Joint *j = NewRest(pair, 24, 1.8, MU, strokes, SAM_LAW_ARCHARD);
  Worn   worn;
  Vec    depth;

  LiveDirectly(j, cycles);
  depth = NewFieldOf(&j->c, "wear_depth2");
  worn  = (Worn){NumberOf(&j->c, "wear_volume2"), Norm(depth, NORM_INFINITY)};
  sam_call(VecDestroy(&depth));
  DestroyJoint(j);
  sam_assert(worn.volume > 0 && worn.most > 0);
  return worn;
}

/*
  Jumps come to where all cycles would have come: under a force, while the joint rocks so that cells close and open in
  every cycle, between dissimilar bodies; jumps by means over the cycle, and magnified cycles.
*/
static void test_jumps_lead_where_all_cycles_would(void **state)
{
  const struct {
    SamPair  pair;
    Strokes  strokes;
    PetscInt ways; /* 1: by means alone */
  } cases[] = {
    {STEEL, {.force = PETSC_TRUE, .steps = 12, .amplitude = 60, .fast = 3e3}, 1},
    {STEEL, {.force = PETSC_TRUE, .steps = 12, .amplitude = 60, .rock = 0.3, .fast = 3e3}, 2},
    {NewPair(210e9, 0.3, 70e9, 0.2), {.approach = PETSC_TRUE, .steps = 12, .amplitude = 4e-6, .fast = 1e3}, 2},
  };

  (void)state;
  sam_on_one_rank();
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    const PetscInt cycles = 30;
    const Worn     worn   = WearDirectly(cases[k].pair, cases[k].strokes, cycles);

    for (PetscInt n = 0; n < cases[k].ways; n++) {
      const SamLifeSettings set = {.magnified = n > 0, .rtol = 4e-3};
      Joint                *j   = NewJoint(cases[k].pair, 24, 1.8, MU, cases[k].strokes, SAM_LAW_ARCHARD, set);
      const SamLifeReport   r   = Live(j, (double)cycles);

      sam_assert_close(r.volume[1], worn.volume, 0.001 * worn.volume);
      sam_assert_close(r.depth[1], worn.most, 0.0015 * worn.most);
      sam_assert(r.computed < cycles);
      DestroyJoint(j);
    }
  }
}

/* Half as long jumps have a quarter of the error. */
static void test_jumps_are_of_second_order(void **state)
{
  double volume[4], depth[4];

  (void)state;
  sam_on_one_rank();
  for (int k = 0; k < 4; k++) {
    Joint *j =
      NewJoint(STEEL, 40, 1.4, 0.1, (Strokes){.approach = PETSC_TRUE, .steps = 8, .amplitude = 7.5e-7, .fast = 1e3},
               SAM_LAW_ARCHARD, (SamLifeSettings){.rtol = 1e-2, .jump = 80 >> k, .fixed = PETSC_TRUE});
    SamLifeReport r = Live(j, 320);

    volume[k] = r.volume[1];
    depth[k]  = r.depth[1];
    DestroyJoint(j);
  }
  for (int k = 0; k < 2; k++) {
    sam_assert(fabs(volume[k + 1] - volume[k]) > 3 * fabs(volume[k + 2] - volume[k + 1]));
    sam_assert(fabs(depth[k + 1] - depth[k]) > 3 * fabs(depth[k + 2] - depth[k + 1]));
  }
}

/* Where the contact rocks, one cycle does not close the loop; what is computed on the same surfaces is the same. */
static void test_loop_is_closed_before_it_counts(void **state)
{
  Joint        *j = NewJoint(STEEL, 40, 1.8, MU,
                             (Strokes){.force = PETSC_TRUE, .steps = 12, .amplitude = 60, .rock = 0.3, .fast = 1e-9},
                             SAM_LAW_ARCHARD, (SamLifeSettings){.rtol = 1e-3});
  SamLifeReport r = Live(j, 0), after = Live(j, 2);

  (void)state;
  sam_assert_close(r.dissipated_energy, after.dissipated_energy, 1e-3 * after.dissipated_energy);
  DestroyJoint(j);
}

/* A force that the friction no longer carries ends the life; the wear so far stays. */
static void test_failure_leaves_the_wear(void **state)
{
  Joint *j = NewJoint(STEEL, 40, 1.5, MU, (Strokes){.force = PETSC_TRUE, .steps = 8, .amplitude = 100}, SAM_LAW_ARCHARD,
                      (SamLifeSettings){.rtol = 2e-2, .jump = 1e3});
  SamLifeReport r = Live(j, 1e3), after;

  (void)state;
  j->strokes.amplitude = 1.1 * MU * j->c.s.N;
  sam_call(SamLifeJump(j->life, 1e5, &after));
  sam_assert(after.step.status == SAM_STATUS_NO_EQUILIBRIUM && after.cycles == r.cycles);
  sam_assert(after.volume[1] == r.volume[1] && r.volume[1] > 0);
  DestroyJoint(j);
}

/* In a life a step adds to the wear of its cycle, and the gap stays until a jump, which repeats the cycle. */
static void test_steps_of_a_life_do_not_wear(void **state)
{
  Joint *j = NewJoint(STEEL, 40, 1.5, MU, (Strokes){.force = PETSC_TRUE, .steps = 8, .amplitude = 60}, SAM_LAW_ARCHARD,
                      (SamLifeSettings){.rtol = 1, .jump = 3, .fixed = PETSC_TRUE});
  SamControl    control;
  SamLifeReport r;
  SamState      memory;
  Vec           worn, cycle;
  double        once;

  (void)state;
  sam_call(Control(&j->strokes, 1, 0, &control));
  (void)Solve(&j->c, &control);
  sam_call(SamContactGetState(j->c.contact, &memory));
  cycle = SamStateReadField(memory, SamStateFindField(memory, "wear_cycle_load"));
  sam_assert(NumberOf(&j->c, "wear_volume2") == 0 && cycle && Norm(cycle, NORM_INFINITY) > 0);
  once = 3 * K / MU * (double)Live(j, 0).dissipated_energy;
  sam_call(SamLifeJump(j->life, 3, &r));
  sam_assert_close(r.volume[1], once, 1e-3 * once);
  worn = NewFieldOf(&j->c, "wear_depth2");
  once = Sum(worn);
  sam_call(VecDestroy(&worn));
  sam_assert(once > 0);
  (void)Live(j, 6);
  worn = NewFieldOf(&j->c, "wear_depth2");
  sam_assert_close(Sum(worn), 2 * once, 1e-4 * once);
  sam_call(VecDestroy(&worn));
  DestroyJoint(j);
}

static void test_life_without_wear_is_refused(void **state)
{
  Joint *j = NewRest(STEEL, 24, 1.5, MU, (Strokes){.force = PETSC_TRUE, .steps = 4, .amplitude = 60}, SAM_LAW_ARCHARD);
  SamLifeSettings set = {.rtol = 1e-2};

  (void)state;
  sam_fails(SamLifeCreate(j->c.contact, &j->cycle, &set, &j->life), PETSC_ERR_ARG_INCOMP);
  AddWear(&j->c, j->law, j->wear);
  set.rtol = 0;
  sam_fails(SamLifeCreate(j->c.contact, &j->cycle, &set, &j->life), PETSC_ERR_ARG_OUTOFRANGE);
  set.rtol = 1e-2;
  sam_call(SamLifeCreate(j->c.contact, &j->cycle, &set, &j->life));
  sam_fails(SamLifeJump(j->life, 1, &(SamLifeReport){0}), PETSC_ERR_ORDER);
  sam_call(SamLifeDestroy(&j->life));
  sam_call(SamProblemAddLawOfType(j->c.problem, SAM_LAW_SLIDE, NULL));
  sam_fails(SamLifeCreate(j->c.contact, &j->cycle, &set, &j->life), PETSC_ERR_ARG_INCOMP);
  set.magnified = PETSC_TRUE;
  sam_call(SamLifeCreate(j->c.contact, &j->cycle, &set, &j->life));
  DestroyJoint(j);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sphere_wears_towards_popovs_shape),
    cmocka_unit_test(test_volume_of_a_sliding_sphere_is_exact),
    cmocka_unit_test(test_both_laws_live_alike),
    cmocka_unit_test(test_jumps_lead_where_all_cycles_would),
    cmocka_unit_test(test_jumps_are_of_second_order),
    cmocka_unit_test(test_loop_is_closed_before_it_counts),
    cmocka_unit_test(test_failure_leaves_the_wear),
    cmocka_unit_test(test_steps_of_a_life_do_not_wear),
    cmocka_unit_test(test_life_without_wear_is_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

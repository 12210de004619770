/* Stresses and fatigue parameters of load steps, by the library's object and in other programs. */
#include "fields.h"
#include "embedded.h"

#include <petsam/embed.h>
#include <petsam/private/evaluation.h>
#include <petsam/private/stress.h>
#include <petsam/private/elasticity.h>

#define BULK 3e7
#define OPTIONS \
  "-body1_young 210e9 -body1_poisson 0.3 -body2_young 70e9 -body2_poisson 0.2 -gap_type sphere -gap_radius1 0.1 " \
  "-gap_radius2 inf -grid_n 24,21 -grid_size 3e-3 -friction 0.3 -bulk2_stress_xx 3e7"

enum { NX = 24, NY = 21, DEPTHS = 3, STEPS = 3 };

/* ---- the object ---- */

/* What an evaluation has handed over. */
typedef struct {
  SamGrid grid;
  double *xx[2][2]; /* stress xx of (step, depth) */
  int     calls[SAM_STRESS_DATASETS];
} Kept;

static PetscErrorCode Keep(void *context, PetscInt dataset, const PetscInt start[], const PetscInt count[],
                           const double values[])
{
  Kept *const kept = (Kept *)context;

  kept->calls[dataset]++;
  if (count[SAM_Z] == 1 && dataset == 0)
    memcpy(kept->xx[start[SAM_TIME]][start[SAM_Z]], values, sizeof(double) * (size_t)kept->grid->cells);
  return 0;
}

/* A pressure about the middle of the grid, and a shear of its parts mu and mu/2 along x and y. */
static void NewTractions(SamGrid g, double mu, Vec *pressure, Vec *shear)
{
  double *p, *q;

  sam_call(SamGridCreateVec(g, 1, pressure));
  sam_call(SamGridCreateVec(g, 2, shear));
  sam_call(VecGetArray(*pressure, &p));
  sam_call(VecGetArray(*shear, &q));
  for (PetscInt k = 0; k < g->cells; k++) {
    const double x = 2 * (double)(SamGridX(g, k % g->nx) / g->width[0]),
                 y = 2 * (double)(SamGridY(g, g->row_start + k / g->nx) / g->width[1]), r = 0.5 - x * x - y * y;

    p[k]            = r > 0 ? 1e9 * sqrt(r) : 0;
    q[k]            = mu * p[k];
    q[g->cells + k] = 0.5 * mu * p[k];
  }
  sam_call(VecRestoreArray(*shear, &q));
  sam_call(VecRestoreArray(*pressure, &p));
}

/* Two steps that an evaluation reads; they have no slip. */
typedef struct {
  SamGrid grid;
  Vec     pressure[2], shear[2];
} Given;

static PetscErrorCode Read(void *context, PetscInt step, const char field[], double values[])
{
  const Given *const g    = (const Given *)context;
  const Vec          v    = !strcmp(field, "pressure") ? g->pressure[step] : g->shear[step];
  const ptrdiff_t    skip = !strcmp(field, "shear_y") ? g->grid->cells : 0;
  const double      *cells;

  if (!strncmp(field, "slip", 4)) return SAM_ERR_USER;
  sam_call(VecGetArrayRead(v, &cells));
  memcpy(values, cells + skip, sizeof(*values) * (size_t)g->grid->cells);
  sam_call(VecRestoreArrayRead(v, &cells));
  return 0;
}

static PetscErrorCode ReadNumber(void *context, PetscInt step, SamStepNumber number, double *value)
{
  (void)context;
  *value = number == SAM_STEP_TIME ? step : 0;
  return 0;
}

static PetscErrorCode ReadConditions(void *context, PetscInt step, SamConditions conditions, SamControl *control)
{
  (void)context;
  (void)step;
  sam_call(SamControlSet(control, conditions, "bulk2_stress_xx", BULK));
  return 0;
}

/* An evaluation of these options; with bodies it is set up, of no steps, or those that are given. */
static PetscErrorCode NewEvaluation(const char *options, SamElasticity bodies, Given *given, SamEvaluation *e)
{
  const SamStressSource source = {.bodies     = bodies,
                                  .name       = "these bodies",
                                  .steps      = given ? 2 : 0,
                                  .slips      = PETSC_TRUE,
                                  .read       = Read,
                                  .number     = ReadNumber,
                                  .conditions = ReadConditions,
                                  .context    = given};
  PetscOptions          database;
  PetscErrorCode        code;

  *e = NULL;
  sam_call(PetscOptionsCreate(&database));
  sam_call(PetscOptionsPush(database));
  sam_call(PetscOptionsInsertString(NULL, options));
  code = SamEvaluationCreateFromOptions(&(SamOptions){PETSC_COMM_WORLD, NULL}, e);
  sam_call(PetscOptionsPop());
  sam_call(PetscOptionsDestroy(&database));
  if (!code && bodies) code = SamEvaluationSetUp(*e, &source);
  return code;
}

static void DestroyGiven(Given *given)
{
  for (int step = 0; step < 2; step++) {
    sam_destroy(&given->pressure[step], &given->shear[step]);
  }
}

/* The stress xx of a map at each depth, by the class of stresses, and a bulk stress. */
static int IsMap(SamElasticity elasticity, const Kept *kept, int step, Vec pressure, Vec shear, double bulk)
{
  const PetscReal depth[2] = {0, 1e-4};
  const PetscInt  n        = kept->grid->cells;
  int             good     = 1;
  SamStress       stress;
  Vec             field;

  sam_call(SamElasticityCreateStress(elasticity, 2, NULL, &stress));
  sam_call(SamGridCreateVec(kept->grid, SAM_STRESS_COMPONENTS, &field));
  for (int d = 0; d < 2; d++) {
    const double *p, *q;
    double       *a;

    sam_call(VecGetArrayRead(pressure, &p));
    sam_call(VecGetArrayRead(shear, &q));
    sam_call(VecGetArray(field, &a));
    memcpy(a + SAM_STRESS_ZZ * n, p, sizeof(*a) * (size_t)n);
    memcpy(a + SAM_STRESS_XZ * n, q, sizeof(*a) * (size_t)n);
    memcpy(a + SAM_STRESS_YZ * n, q + n, sizeof(*a) * (size_t)n);
    sam_call(VecRestoreArray(field, &a));
    sam_call(VecRestoreArrayRead(shear, &q));
    sam_call(VecRestoreArrayRead(pressure, &p));
    sam_call(SamStressSetDepth(stress, depth[d]));
    sam_call(SamStressApply(stress, field));
    sam_call(VecGetArray(field, &a));
    for (PetscInt k = 0; k < n; k++) good = good && a[SAM_STRESS_XX * n + k] + bulk == kept->xx[step][d][k];
    sam_call(VecRestoreArray(field, &a));
  }
  sam_call(VecDestroy(&field));
  sam_call(SamStressDestroy(&stress));
  return good;
}

static void test_steps_have_the_stresses_of_their_tractions(void **state)
{
  Sphere           s     = NewSphereOf(NewPair(210e9, 0.3, 70e9, 0.2), 24, 1.5);
  Kept             kept  = {.grid = s.grid};
  Given            given = {.grid = s.grid};
  SamEvaluation    e;
  SamLargestSeries largest;

  (void)state;
  for (int step = 0; step < 2; step++) {
    NewTractions(s.grid, step ? -0.2 : 0.3, &given.pressure[step], &given.shear[step]);
    for (int d = 0; d < 2; d++) kept.xx[step][d] = (double *)calloc((size_t)kept.grid->cells + 1, sizeof(double));
  }
  sam_call(NewEvaluation("-depths 0,1e-4 -quantities stress -fatigue swt", s.elasticity, &given, &e));
  sam_call(SamEvaluationCompute(e, Keep, &kept));
  sam_assert(SamEvaluationGetLayout(e)->datasets == SAM_STRESS_COMPONENTS + 4);
  for (int k = 0; k < SAM_STRESS_COMPONENTS + 4; k++)
    sam_assert(kept.calls[k] == (k < SAM_STRESS_COMPONENTS ? 2 * 2 : 2));
  for (int step = 0; step < 2; step++)
    sam_assert(IsMap(s.elasticity, &kept, step, given.pressure[step], given.shear[step], BULK));
  for (int k = 0; k < 4; k++) sam_assert(SamEvaluationGetLargest(e, k, &largest) && largest.count == 2);
  sam_assert(SamEvaluationGetLargest(e, 4, &largest) && !strcmp(largest.name, "swt") && largest.of_cycle);
  sam_assert(largest.step->value > 0 && largest.step->place[2] == 0 && !SamEvaluationGetLargest(e, 5, &largest));
  for (int step = 0; step < 2; step++)
    for (int d = 0; d < 2; d++) free(kept.xx[step][d]);
  DestroyGiven(&given);
  sam_call(SamEvaluationDestroy(&e));
  DestroySphere(&s);
}

static void test_settings_that_cannot_be_are_refused(void **state)
{
  static const struct {
    const char *options;
    int         given, set_up, compute; /* whether there are steps; the errors */
  } wrong[]           = {{"-depths 1e-15", 1, SAM_ERR_USER, 0},
                         {"-fatigue ruiz", 0, SAM_ERR_USER, 0}, /* no cycle */
                         {"-fatigue ruiz -depths 1e-4", 1, SAM_ERR_USER, 0},
                         {"-depths 0.5a", 1, SAM_ERR_USER, 0}, /* the steps have no area */
                         {"-section y=1", 1, SAM_ERR_USER, 0},
                         {"-quantities none -fatigue ruiz -section y=0", 1, 0, SAM_ERR_USER}}; /* without slip */
  Sphere        s     = NewSphereOf(NewPair(210e9, 0.3, 210e9, 0.3), 24, 1.5);
  Given         given = {.grid = s.grid};
  SamEvaluation e;

  (void)state;
  for (int step = 0; step < 2; step++) NewTractions(s.grid, 0.1, &given.pressure[step], &given.shear[step]);
  BeginCatching();
  sam_assert(NewEvaluation("-body 3", NULL, NULL, &e) == SAM_ERR_USER && strstr(CaughtMessage(), "body 3: expected"));
  sam_call(SamEvaluationDestroy(&e));
  sam_assert(NewEvaluation("-depths 1e-4,0", NULL, NULL, &e) == SAM_ERR_USER);
  sam_call(SamEvaluationDestroy(&e));
  for (size_t k = 0; k < sizeof(wrong) / sizeof(wrong[0]); k++) {
    sam_assert((int)NewEvaluation(wrong[k].options, s.elasticity, wrong[k].given ? &given : NULL, &e) ==
               wrong[k].set_up);
    if (wrong[k].compute) sam_assert((int)SamEvaluationCompute(e, Keep, NULL) == wrong[k].compute);
    sam_call(SamEvaluationDestroy(&e));
  }
  EndCatching();
  DestroyGiven(&given);
  DestroySphere(&s);
}

/* ---- in other programs ---- */

static void AddStep(petsam_contact *c, double N, double T)
{
  sam_assert(TryLoads(c, N, T, NULL, NULL) == 0 && petsam_commit(c) == 0);
}

static petsam_contact *NewRecorded(int comm)
{
  petsam_contact *c = NewContact(comm, OPTIONS);

  sam_assert(petsam_record(c, 1) == 0);
  for (int k = 0; k < STEPS; k++) AddStep(c, 1000, k % 2 ? -150 : 150);
  return c;
}

/* All results of the last call of a contact on all ranks are the rows of those of one on this rank alone. */
static int AreAlike(petsam_contact *c, const int shape[4], petsam_contact *alone, const int whole[4], int first_row)
{
  const char *name;
  int         dimensions, good = 1, count = 0;

  for (; (name = petsam_stress_name(alone, count, &dimensions)); count++) {
    const size_t lines = dimensions == 1 ? 1 : (size_t)(dimensions == 3 ? whole[1] : whole[0] * whole[1]);
    const size_t row   = dimensions == 1 ? 1 : (size_t)whole[3];
    const int    y     = dimensions > 1 || !strcmp(name, "y");
    const size_t size  = (size_t)whole[0] * (size_t)whole[1] * (size_t)whole[2] * (size_t)whole[3];
    double      *mine = (double *)malloc(sizeof(double) * size), *all = (double *)malloc(sizeof(double) * size);
    const size_t rows = (size_t)(y ? shape[2] : dimensions == 1 ? 1 : 0), of = (size_t)whole[2];

    good = good && !strcmp(name, petsam_stress_name(c, count, NULL));
    good = good && petsam_get_stress(c, name, mine) == 0 && petsam_get_stress(alone, name, all) == 0;
    for (size_t k = 0; good && k < lines; k++)
      good =
        !memcmp(mine + k * rows * row, all + (k * of + (size_t)(y ? first_row : 0)) * row, sizeof(double) * rows * row);
    free(mine);
    free(all);
  }
  return good && count > 4 && !petsam_stress_name(c, count, NULL);
}

static void test_embedded_stresses_do_not_depend_on_the_ranks(void **state)
{
  static const char *const where[] = {"-depths 0,1e-4,2e-4", "-section y=0 -depths 0:2e-4:3",
                                      "-section x=1e-4 -body 1 -depths 0,1e-4,2e-4"};

  petsam_contact *c = NewRecorded(World()), *alone = NewRecorded(-1);
  int             shape[4], whole[4], first;

  (void)state;
  sam_assert(petsam_grid(c, NULL, NULL, NULL, &first, NULL) == 0);
  for (int k = 0; k < 3; k++) {
    const int row = k ? 0 : first;
    char      text[256];

    sam_assert(petsam_stress(c, where[k], shape) == 0 && petsam_stress(alone, where[k], whole) == 0);
    sam_assert(whole[0] == 1 && whole[1] == DEPTHS && whole[2] == (k == 1 ? 1 : NY) && whole[3] == (k == 2 ? 1 : NX));
    sam_assert(AreAlike(c, shape, alone, whole, row));
    (void)snprintf(text, sizeof(text), "-fatigue swt,ruiz -quantities mises %s", where[k]);
    sam_assert(petsam_fatigue(c, text, shape) == 0 && petsam_fatigue(alone, text, whole) == 0);
    sam_assert(whole[0] == STEPS && shape[3] == whole[3] && AreAlike(c, shape, alone, whole, row));
  }
  petsam_destroy(&c);
  petsam_destroy(&alone);
}

static void test_depths_in_half_widths_are_those_of_the_contact(void **state)
{
  petsam_contact *c    = NewRecorded(World());
  double          area = 0, z[2];
  int             shape[4];

  (void)state;
  sam_assert(petsam_stress(c, "-section y=0 -depths 0,2a", shape) == 0 && shape[1] == 2);
  sam_assert(petsam_get_stress(c, "z", z) == 0 && petsam_get_number(c, "contact_area", &area) == 0);
  sam_assert(z[0] == 0);
  sam_assert_close(z[1], 2 * sqrt(area / PETSC_PI), 0.05 * z[1]); /* a circle of few cells, nearly */
  petsam_destroy(&c);
}

static void test_mistakes_in_embedded_stresses_are_named(void **state)
{
  petsam_contact *c = NewRecorded(World()), *fresh = NewContact(World(), OPTIONS);
  double         *mises = (double *)malloc(sizeof(double) * NX * NY);
  int             shape[4];

  (void)state;
  sam_assert(petsam_stress(fresh, "", shape) == 2 && Says(fresh, "no step has been solved"));
  sam_assert(petsam_fatigue(fresh, "-fatigue swt", shape) == 2 && Says(fresh, "two at least, and not 0"));
  sam_assert(petsam_get_stress(fresh, "mises", mises) == 2 && !petsam_stress_name(fresh, 0, NULL));
  sam_assert(petsam_stress(c, "-depth 0", shape) == 2 && Says(c, "-depth 0: unknown option"));
  sam_assert(petsam_stress(c, "-depths 1,0", shape) == 2 && Says(c, "-depths 1,0"));
  sam_assert(petsam_stress(c, "-fatigue swt", shape) == 2 && Says(c, "two at least, and not 1"));
  sam_assert(petsam_stress(c, "-help", shape) == 2 && petsam_stress(c, "-h", shape) == 2);
  sam_assert(petsam_stress(c, NULL, shape) == 2 && petsam_stress(c, "", NULL) == 2 &&
             petsam_stress(NULL, "", shape) == 2);
  sam_assert(petsam_get_stress(c, "mises", mises) == 2 && Says(c, "mises"));
  sam_assert(petsam_stress(c, "-section y=0", shape) == 0 && petsam_get_stress(c, "mises", mises) == 0);
  sam_assert(mises[NX / 2] > 0 && petsam_get_stress(c, "swt", mises) == 2 && Says(c, "swt"));
  sam_assert(petsam_fatigue(c, "-fatigue swt -section y=0", shape) == 0 && !petsam_message(c)[0]);
  sam_assert(petsam_record(c, 1) == 0);
  AddStep(c, 900, 0);
  AddStep(c, 800, 0);
  sam_assert(petsam_fatigue(c, "-fatigue swt -section y=0", shape) == 0 && Says(c, "not a closed cycle"));
  sam_assert(petsam_record(c, 0) == 0 && petsam_fatigue(c, "-fatigue swt", shape) == 2);
  free(mises);
  petsam_destroy(&c);
  petsam_destroy(&fresh);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_steps_have_the_stresses_of_their_tractions),
    cmocka_unit_test(test_settings_that_cannot_be_are_refused),
    cmocka_unit_test(test_embedded_stresses_do_not_depend_on_the_ranks),
    cmocka_unit_test(test_depths_in_half_widths_are_those_of_the_contact),
    cmocka_unit_test(test_mistakes_in_embedded_stresses_are_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

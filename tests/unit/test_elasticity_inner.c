/*
  A type of elasticity from outside the library that adds to another one: a half-space and a layer of springs on it,
  u_z += c p and u_t += c q/2, stiffer here and softer there. Contacts on it through nested grids and parts.
*/
#include "elasticities.h"
#include "springs.h"

#include <petsam/private/normal.h>
#include <petsam/private/elasticity.h>

#define SIDEWAYS 0.5 /* c of shear over that of pressure */

/* The compliance in cell k of this rank, by its place on the finest grid. */
static double ComplianceAt(SamElasticity e, PetscInt k)
{
  const double x = e->first[0] + (0.5 + (double)(k % e->grid->nx)) * e->factor[0],
               y = e->first[1] + (0.5 + (double)(e->grid->row_start + k / e->grid->nx)) * e->factor[1];

  return SizeOf(e) * (1 + 0.6 * sin(0.31 * x) * cos(0.23 * y));
}

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);
typedef PetscErrorCode (*MethodSingle)(SamElasticity, double, const float *const[], float *const[]);

/* The product of the inner operator, and the springs' own part, which is taken before: input and output may be one. */
static PetscErrorCode Add(SamElasticity e, Method inner, PetscInt n, double factor, const double *const in[],
                          double *const out[])
{
  const PetscInt cells = e->grid->cells;
  double        *own;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n * cells, &own));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = 0; k < cells; k++) own[c * cells + k] = factor * ComplianceAt(e, k) * in[c][k];
  PetscCall((*inner)(e->inner, in, out));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = 0; k < cells; k++) out[c][k] += own[c * cells + k];
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddSingle(SamElasticity e, MethodSingle inner, PetscInt n, double factor, double scale,
                                const float *const in[], float *const out[])
{
  const PetscInt cells = e->grid->cells;
  float         *own;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n * cells, &own));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = 0; k < cells; k++)
      own[c * cells + k] = (float)(scale * factor * ComplianceAt(e, k) * (double)in[c][k]);
  PetscCall((*inner)(e->inner, scale, in, out));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = 0; k < cells; k++) out[c][k] += own[c * cells + k];
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyNormal(SamElasticity e, const double *const p[], double *const u[])
{
  return Add(e, e->inner->ops.applynormal, 1, 1, p, u);
}

static PetscErrorCode ApplyTangential(SamElasticity e, const double *const q[], double *const u[])
{
  return Add(e, e->inner->ops.applytangential, 2, SIDEWAYS, q, u);
}

static PetscErrorCode ApplyNormalSingle(SamElasticity e, double scale, const float *const p[], float *const u[])
{
  return AddSingle(e, e->inner->ops.applynormalsingle, 1, 1, scale, p, u);
}

static PetscErrorCode ApplyTangentialSingle(SamElasticity e, double scale, const float *const q[], float *const u[])
{
  return AddSingle(e, e->inner->ops.applytangentialsingle, 2, SIDEWAYS, scale, q, u);
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  const double mean = SizeOf(e);

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(e->inner, normal, tangential));
  *normal += mean;
  *tangential += SIDEWAYS * mean;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateSprings(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(BeginSprings(e, 0));
  e->ops.applynormal           = ApplyNormal;
  e->ops.applytangential       = ApplyTangential;
  e->ops.applynormalsingle     = ApplyNormalSingle;
  e->ops.applytangentialsingle = ApplyTangentialSingle;
  e->ops.getselfinfluence      = GetSelfInfluence;
  PetscCall(SamElasticitySetInner(e, SAM_ELASTICITY_HALFSPACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a sphere on it ---- */

/* The springs yield about as much as the bodies: the approach by Hertz under the mean pressure. */
static void AddSprings(Sphere *s)
{
  char options[128];

  sam_call(SamElasticityRegister("springs", CreateSprings));
  (void)snprintf(options, sizeof(options), "-elasticity springs -springs_size %.17g", 0.7 * s->a * s->a / s->R / s->p0);
  SetOptions(options);
  sam_call(SamElasticitySetFromOptions(s->elasticity));
  SetOptions("");
}

static Sphere NewOn(MPI_Comm comm, SamPair pair, PetscInt n, double half_width)
{
  Sphere s = NewSphereOn(comm, pair, n, half_width, 0.13e-3, -0.07e-3);

  AddSprings(&s);
  return s;
}

/* The springs' compliance times `factor`, as a field. */
static Vec NewDiagonal(const Sphere *s, double factor)
{
  Vec     d = NewField(s->grid, 1);
  double *a;

  sam_call(VecGetArray(d, &a));
  for (PetscInt k = 0; k < s->grid->cells; k++) a[k] = factor * ComplianceAt(s->elasticity, k);
  sam_call(VecRestoreArray(d, &a));
  return d;
}

/* The pressure is that of a half-space whose surface yields by a diagonal besides, which the solver knows by itself. */
static void test_pressure_is_that_with_a_diagonal(void **state)
{
  static const double half_width[] = {1.4, 5}; /* on the whole grid, and on a part of it */

  (void)state;
  for (int k = 0; k < 2; k++) {
    Sphere        s       = NewOn(PETSC_COMM_WORLD, Steel(), 117, half_width[k]);
    SamBalance    balance = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {s.N}};
    SamBalance    other   = balance;
    SamElasticity plain   = NewCompliance(s.grid, s.pair);
    Vec           d = NewDiagonal(&s, 1), p = NewField(s.grid, 1), q = NewField(s.grid, 1);
    SamNormal     normal;
    PetscInt      first[2], n[2];

    sam_call(SamNormalCreate(s.elasticity, &normal));
    sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
    sam_call(SamNormalDestroy(&normal));
    sam_call(SamElasticityGetPartPlace(s.elasticity, first, n));
    sam_assert((n[0] > 0) == (k == 1));
    sam_call(SamNormalCreate(plain, &normal));
    sam_call(SamNormalSolveYielding(normal, s.h, d, &other, PETSC_FALSE, q));
    sam_assert_close(Difference(p, q, NORM_INFINITY), 0, 3e-7);
    sam_assert_close(balance.rigid[0], other.rigid[0], 1e-8 * other.rigid[0]);
    sam_call(SamNormalDestroy(&normal));
    sam_call(SamElasticityDestroy(&plain));
    sam_destroy(&d, &p, &q);
    DestroySphere(&s);
  }
}

/* A normal load and a shear, in two steps; the last one's solution. */
static const SamSolution *SolveSlip(const Case *c)
{
  const SamControl   controls[] = {Loads(c, 1, 0, 0, 0), Loads(c, 1, 0.6, 0.2, 0.1)};
  const SamSolution *solution;

  for (int k = 0; k < 2; k++) {
    const SamStep step = Try(c, &controls[k]);

    sam_assert(step.status == 0);
    sam_call(SamContactCommit(c->contact));
  }
  sam_call(SamContactGetSolution(c->contact, &solution));
  return solution;
}

/* The largest of |u_t - rigid displacement| where cells stick, over the largest displacement; similar bodies. */
static double Slip(const Case *c, const SamSolution *s, SamElasticity plain)
{
  const SamGrid grid = c->s.grid;
  Vec           u = NewField(grid, 2), d = NewDiagonal(&c->s, SIDEWAYS);
  double       *displacement, worst[2]   = {0, 0};
  const double *own, *q, *p;

  sam_call(SamElasticityApplyTangential(plain, s->shear, u));
  sam_call(VecGetArray(u, &displacement));
  sam_call(VecGetArrayRead(d, &own));
  sam_call(VecGetArrayRead(s->shear, &q));
  sam_call(VecGetArrayRead(s->pressure, &p));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const double x = SamGridX(grid, k % grid->nx), y = SamGridY(grid, grid->row_start + k / grid->nx);
    const double rigid[2] = {s->rigid[SAM_COMPONENT_TX] - y * s->rigid[SAM_COMPONENT_MZ],
                             s->rigid[SAM_COMPONENT_TY] + x * s->rigid[SAM_COMPONENT_MZ]};
    const double bound = c->friction * p[k], size = hypot(q[k], q[k + grid->cells]);

    for (int m = 0; m < 2; m++) {
      const PetscInt i = k + m * grid->cells;

      if (size < 0.98 * bound) worst[0] = fmax(worst[0], fabs(displacement[i] + own[k] * q[i] - rigid[m]));
      worst[1] = fmax(worst[1], fabs(rigid[m]));
    }
  }
  sam_call(VecRestoreArrayRead(s->pressure, &p));
  sam_call(VecRestoreArrayRead(s->shear, &q));
  sam_call(VecRestoreArrayRead(d, &own));
  sam_call(VecRestoreArray(u, &displacement));
  sam_destroy(&u, &d);
  sam_call(SamMax(grid->comm, 2, worst));
  return worst[0] / worst[1];
}

/* Sticking cells move as one body, by the products of the half-space on the whole grid and the springs' own part. */
static void test_sticking_cells_move_together(void **state)
{
  Case          c     = NewCaseOn(NewOn(PETSC_COMM_WORLD, Steel(), 82, 3.2), MU, NULL, "");
  SamElasticity plain = NewCompliance(c.s.grid, c.s.pair);

  (void)state;
  sam_assert_close(Slip(&c, SolveSlip(&c), plain), 0, 1e-6);
  sam_call(SamElasticityDestroy(&plain));
  DestroyCase(&c);
}

static void test_results_are_the_same_on_any_number_of_ranks(void **state)
{
  const SamSolution *solution[2];
  double            *shear[2];
  Case               c[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    c[k]        = NewCaseOn(NewOn(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, Dissimilar(), 71, 2.5), MU, NULL, "");
    solution[k] = SolveSlip(&c[k]);
    shear[k]    = Whole(c[k].s.grid, 2, solution[k]->shear);
  }
  sam_assert(!memcmp(solution[0]->rigid, solution[1]->rigid, sizeof(solution[0]->rigid)));
  sam_assert(!memcmp(shear[0], shear[1], sizeof(double) * 2 * 71 * 71));
  for (int k = 0; k < 2; k++) {
    free(shear[k]);
    DestroyCase(&c[k]);
  }
}

/* ---- what the class does for it ---- */

static void AssertPlace(SamElasticity e, double x, double y, double factor)
{
  sam_assert_close(e->first[0], x, 1e-12);
  sam_assert_close(e->first[1], y, 1e-12);
  for (int k = 0; k < 2; k++) sam_assert_close(e->factor[k], factor, 1e-12);
  if (e->inner) AssertPlace(e->inner, x, y, factor);
}

static void test_grids_and_parts_know_their_place(void **state)
{
  const PetscInt first[2] = {8, 11}, n[2] = {32, 32};
  Sphere         s = NewOn(PETSC_COMM_WORLD, Steel(), 80, 2);
  SamElasticity  coarse, coarser, part, of_coarse;
  SamTransfer    transfer;
  SamWindow      window;

  (void)state;
  AssertPlace(s.elasticity, 0, 0, 1);
  s.elasticity->traits.rotations[2] =
    PETSC_FALSE; /* as a type decides that does not take over all of the inner one's */
  sam_call(SamElasticityGetCoarse(s.elasticity, &coarse, &transfer));
  AssertPlace(coarse, 0, 0, 2);
  sam_assert(!memcmp(&coarse->traits, &s.elasticity->traits, sizeof(coarse->traits)));
  sam_call(SamElasticityGetCoarse(coarse, &coarser, &transfer));
  AssertPlace(coarser, 0, 0, 4);
  sam_call(SamElasticityChoosePart(s.elasticity, first, n, PETSC_FALSE, &window, &part));
  AssertPlace(part, 5, 8, 1);
  sam_call(SamElasticityGetCoarse(part, &of_coarse, &transfer));
  AssertPlace(of_coarse, 5, 8, 2);
  sam_call(SamElasticityChoosePart(coarse, (const PetscInt[2]){8, 11}, (const PetscInt[2]){12, 12}, PETSC_FALSE,
                                   &window, &part));
  AssertPlace(part, 10, 16, 2);
  sam_assert(SizeOf(part) == SizeOf(s.elasticity));
  DestroySphere(&s);
}

/* What the type has no method for is the inner one's: traits, preconditioner, slopes, stresses; and it is recorded. */
static void test_all_else_is_the_inner_ones(void **state)
{
  Sphere              s     = NewOn(PETSC_COMM_WORLD, Dissimilar(), 40, 2);
  SamElasticity       plain = NewCompliance(s.grid, s.pair), same;
  SamElasticityTraits traits[2];
  SamParameters       p = {.count = 0};
  SamStress           stress;
  Vec                 r = NewRandom(s.grid, 2, 1), a = NewField(s.grid, 2), b = NewField(s.grid, 2);

  (void)state;
  traits[0] = SamElasticityGetTraits(s.elasticity);
  traits[1] = SamElasticityGetTraits(plain);
  sam_assert(!memcmp(&traits[0], &traits[1], sizeof(traits[0])));
  sam_call(SamElasticityApplyTangentialToNormal(s.elasticity, r, a));
  sam_call(SamElasticityApplyTangentialToNormal(plain, r, b));
  sam_assert(Difference(a, b, NORM_INFINITY) == 0);
  sam_call(SamElasticityCreateStress(s.elasticity, 1, NULL, &stress));
  sam_call(SamStressDestroy(&stress));
  sam_call(SamElasticityTrim(s.elasticity));
  sam_call(SamElasticityAddParameters(s.elasticity, &p));
  sam_assert(!strcmp(SamParametersFind(&p, "elasticity")->text, "springs"));
  sam_assert(!strcmp(SamParametersFind(&p, "elasticity_inner")->text, SAM_ELASTICITY_HALFSPACE));
  sam_call(SamElasticityCreateFromParameters(s.grid, &p, "-input x.h5", &same));
  sam_call(SamElasticityApplyTangential(s.elasticity, r, a));
  sam_call(SamElasticityApplyTangential(same, r, b));
  sam_assert(Difference(a, b, NORM_INFINITY) == 0);
  sam_call(SamElasticityApplyTangential(plain, r, b));
  sam_assert(Difference(a, b, NORM_INFINITY) > 0.01);
  sam_call(SamElasticityApplyTangential(s.elasticity, r, r)); /* in place */
  sam_assert(Difference(a, r, NORM_INFINITY) == 0);
  sam_call(SamElasticityDestroy(&same));
  sam_call(SamElasticityDestroy(&plain));
  sam_destroy(&r, &a, &b);
  DestroySphere(&s);
}

/* ---- bodies that remember ---- */

/* Each step leaves a dent, K p deep; by it times the next step's duration the bodies have sunk in. */
#define K(e) (0.1 * (e)->grid->length / (e)->pair->modulus)
static const SamStateField dent = {.name = "dent", .components = 1, .generations = 2, .kept = PETSC_TRUE},
                           sunk = {.name = "sunk", .components = 1, .generations = 2, .kept = PETSC_TRUE};

static PetscErrorCode DeclareDent(SamElasticity e, SamState state)
{
  PetscInt id;

  PetscFunctionBegin;
  (void)e;
  PetscCall(SamStateDeclareField(state, &dent, &id));
  PetscCall(SamStateDeclareField(state, &sunk, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tried values of a field: `factor` times the committed dent, and K times a pressure, unless it is NULL. */
static PetscErrorCode SetField(SamElasticity e, SamState state, const char name[], PetscReal factor, Vec p)
{
  const Vec before = SamStateGetField(state, SamStateFindField(state, dent.name), SAM_COMMITTED);
  Vec       field;

  PetscFunctionBegin;
  PetscCall(SamStateSetField(state, SamStateFindField(state, name), &field));
  PetscCall(VecSet(field, 0));
  if (before) PetscCall(VecAXPY(field, factor, before));
  if (p) PetscCall(VecAXPY(field, K(e), p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeginSinking(SamElasticity e, SamState state, const SamControl *control, PetscReal duration)
{
  (void)control;
  return SetField(e, state, sunk.name, duration, NULL);
}

static PetscErrorCode AddSunk(SamElasticity e, SamConditions conditions, SamState state, const SamControl *control,
                              Vec u_z, Vec u_t, PetscBool *adds)
{
  PetscFunctionBegin;
  (void)e;
  (void)conditions;
  (void)control;
  (void)u_t;
  if (adds) *adds = PETSC_TRUE;
  if (u_z) PetscCall(VecAXPY(u_z, 1, SamStateReadField(state, SamStateFindField(state, sunk.name))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AdvanceDent(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  (void)shear;
  return SetField(e, state, dent.name, 1, pressure);
}

static PetscErrorCode CreateDented(SamElasticity e)
{
  PetscFunctionBegin;
  e->ops =
    (SamElasticityOps){.declare = DeclareDent, .begin = BeginSinking, .displace = AddSunk, .advance = AdvanceDent};
  PetscCall(SamElasticitySetInner(e, SAM_ELASTICITY_HALFSPACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure of each step is that of a half-space with the dents of the steps before in its gap. */
static void test_bodies_remember_what_a_step_left(void **state)
{
  static const double times[] = {1, 1.75, 4};

  Sphere s = NewSphereOn(PETSC_COMM_WORLD, Steel(), 41, 2, 0, 0);
  Vec    p = NewField(s.grid, 1), q = NewField(s.grid, 1), left = NewField(s.grid, 1);
  Case   c;

  (void)state;
  sam_call(SamElasticityRegister("dented", CreateDented));
  sam_call(SamElasticitySetType(s.elasticity, "dented"));
  c = NewCaseOn(s, 0.1, NULL, "");
  for (int k = 0; k < 3; k++) {
    Sphere     t       = NewSphereOn(PETSC_COMM_WORLD, Steel(), 41, 2, 0, 0);
    SamControl control = Loads(&c, 1, 0.4, 0, 0);
    PetscReal  error;
    Case       d;

    control.time = times[k];
    (void)Try(&c, &control);
    sam_call(SamContactReject(c.contact));
    sam_assert(Solve(&c, &control).status == SAM_STATUS_CONVERGED);
    sam_call(SamContactGetField(c.contact, "pressure", p));
    if (k) sam_call(VecAXPY(t.h, times[k] - times[k - 1], left));
    d = NewCaseOn(t, 0.1, NULL, "");
    (void)Solve(&d, &control);
    sam_call(SamContactGetField(d.contact, "pressure", q));
    sam_call(VecAXPY(q, -1, p));
    sam_call(VecNorm(q, NORM_INFINITY, &error));
    sam_assert_close(error, 0, 1e-5 * s.p0);
    sam_assert_close(NumberOf(&c, "disp_z"), NumberOf(&d, "disp_z"), 1e-6 * NumberOf(&d, "disp_z"));
    sam_call(VecAXPY(left, K(s.elasticity), p));
    DestroyCase(&d);
  }
  DestroyCase(&c);
  sam_destroy(&left, &q, &p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_pressure_is_that_with_a_diagonal),
    cmocka_unit_test(test_sticking_cells_move_together),
    cmocka_unit_test(test_results_are_the_same_on_any_number_of_ranks),
    cmocka_unit_test(test_grids_and_parts_know_their_place),
    cmocka_unit_test(test_all_else_is_the_inner_ones),
    cmocka_unit_test(test_bodies_remember_what_a_step_left),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

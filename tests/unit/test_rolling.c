/* Steady rolling: the operator, what holds exactly, and the solver against another method. */
#include "tangentials.h"

#include <petsam/private/elasticity.h>
#include <petsam/private/motionimpl.h>

/* The case on bodies that roll, with the bodies at rest besides. */
typedef struct {
  Case          c;
  SamElasticity rest;
} Rolling;

static Rolling NewRolling(PetscInt n, double poisson)
{
  Rolling r = {.c = NewCase(n, poisson)};

  r.rest = r.c.s.elasticity;
  sam_call(SamElasticityReference(r.rest));
  sam_call(SamMotionSet(&SamMotionSteady, &(SamOptions){r.c.s.grid->comm, NULL}, &r.c.s.elasticity));
  return r;
}

static void DestroyRolling(Rolling *r)
{
  sam_call(SamElasticityDestroy(&r->rest));
  DestroyCase(&r->c);
}

/* Zero in the first column, behind which there is no cell. */
static void ClearFirstColumn(SamGrid grid, Vec v)
{
  double *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt k = 0; k < 2 * grid->cells; k += grid->nx) a[k] = 0;
  sam_call(VecRestoreArray(v, &a));
}

/* Each cell less the next one along x (`forth`), or the mean of it and the one before. */
static Vec NewNeighbours(SamGrid grid, Vec v, int forth)
{
  Vec           w = NewField(grid, 2);
  const double *a;
  double       *b;

  sam_call(VecGetArrayRead(v, &a));
  sam_call(VecGetArray(w, &b));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) {
    const PetscInt i = k % grid->nx;

    b[k] = forth ? a[k] - (i + 1 < grid->nx ? a[k + 1] : 0) : 0.5 * (a[k] + (i > 0 ? a[k - 1] : 0));
  }
  sam_call(VecRestoreArray(w, &b));
  sam_call(VecRestoreArrayRead(v, &a));
  return w;
}

/* A q = C D q/dx, also in place and in single precision; q.A q is half of (D q).C (D q)/dx, and positive. */
static void test_operator_is_that_of_the_differences(void **state)
{
  Rolling       r    = NewRolling(37, 0.28);
  const SamGrid grid = r.c.s.grid;
  const double *a, *b;
  PetscReal     self[2], rest[2];
  Vec           q = NewRandom(grid, 2, 3), d, u = NewField(grid, 2), v = NewField(grid, 2);
  float        *single = (float *)malloc(sizeof(float) * 2 * (size_t)grid->cells);
  double        error  = 0;

  (void)state;
  ClearFirstColumn(grid, q);
  d = NewNeighbours(grid, q, 1);
  sam_call(SamElasticityApplyTangential(r.c.s.elasticity, q, u));
  sam_call(SamElasticityApplyTangential(r.rest, d, v));
  sam_call(VecScale(v, 1 / grid->dx));
  sam_assert_close(Difference(u, v, NORM_INFINITY), 0, 1e-13);
  sam_assert_close(Dot(q, u), 0.5 * Dot(d, v), 1e-12 * Dot(d, v));
  sam_assert(Dot(q, u) > 0);
  sam_call(SamElasticityGetSelfInfluence(r.c.s.elasticity, &self[0], &self[1]));
  sam_call(SamElasticityGetSelfInfluence(r.rest, &rest[0], &rest[1]));
  sam_assert(self[0] == rest[0] && self[1] == rest[1] / grid->dx);
  sam_call(VecGetArrayRead(q, &a));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) single[k] = (float)a[k];
  sam_call(VecRestoreArrayRead(q, &a));
  sam_call(SamElasticityApplyTangentialSingle(r.c.s.elasticity, 1 / self[1], single, single));
  sam_call(VecGetArrayRead(u, &b));
  for (PetscInt k = 0; k < 2 * grid->cells; k++) error = fmax(error, fabs((double)single[k] - b[k] / self[1]));
  sam_call(VecRestoreArrayRead(u, &b));
  sam_assert_close(error, 0, 1e-5);
  sam_call(SamElasticityApplyTangential(r.c.s.elasticity, q, q)); /* in place */
  sam_assert(Difference(q, u, NORM_INFINITY) == 0);
  free(single);
  sam_destroy(&q, &d, &u, &v);
  DestroyRolling(&r);
}

/* Creepages are given, and nothing carries a load of them but what is asked for. */
static SamBalance Creep(double x, double y, double spin)
{
  return (SamBalance){.kind = SAM_BALANCE_TANGENTIAL, .rigid = {x, y, spin}};
}

/* The creepage by which a sphere slides, mu p0/G, and its half of spin. */
static double Unit(const Case *c)
{
  return mu * c->s.p0 / (c->s.pair->body[0]->material[0].young / 2 / (1 + c->s.pair->body[0]->material[0].poisson));
}

/* Lateral force by spin and moment by lateral creepage, without slip: C23 = C32. */
static void test_reciprocity(void **state)
{
  Rolling      r       = NewRolling(40, 0.25);
  const Case   wide    = r.c;
  const double u       = Unit(&r.c);
  SamBalance   lateral = Creep(0, u, 0), spin = Creep(0, 0, u / r.c.s.a);
  Vec          bound = Copy(r.c.bound), q = NewField(r.c.s.grid, 2);

  (void)state;
  sam_call(VecScale(bound, 1e6));
  sam_assert(Solve(&wide, bound, NULL, NULL, 1e-9, &lateral, q).error <= 1e-9); /* of the shear that is returned */
  (void)Solve(&wide, bound, NULL, NULL, 1e-9, &spin, q);
  sam_assert(spin.load[1] > 0);
  sam_assert_close(spin.load[1] / r.c.s.a, -lateral.load[2] / r.c.s.a / r.c.s.a, 1e-7 * spin.load[1] / r.c.s.a);
  sam_destroy(&bound, &q);
  DestroyRolling(&r);
}

/* The solution without the solver: the extragradient method, which converges for any monotone operator. */
static void SolvePlainly(const Case *c, const SamBalance *creep, Vec q)
{
  const SamGrid grid = c->s.grid;
  PetscReal     self;
  Vec           half = Copy(q);

  sam_call(SamElasticityGetSelfInfluence(c->s.elasticity, NULL, &self));
  for (int k = 0; k < 1500; k++)
    for (int part = 0; part < 2; part++) {
      Vec           to = part ? q : half, slip = Slip(c, creep, part ? half : q);
      const double *b;
      double       *t;

      if (!part) sam_call(VecCopy(q, half));
      sam_call(VecAXPY(to, -0.25 / self, slip));
      sam_call(VecGetArrayRead(c->bound, &b));
      sam_call(VecGetArray(to, &t));
      for (PetscInt i = 0; i < grid->cells; i++) {
        const double n = hypot(t[i], t[i + grid->cells]), scale = n > b[i] ? b[i] / n : 1;

        t[i] *= scale;
        t[i + grid->cells] *= scale;
      }
      sam_call(VecRestoreArray(to, &t));
      sam_call(VecRestoreArrayRead(c->bound, &b));
      sam_call(VecDestroy(&slip));
    }
  sam_call(VecDestroy(&half));
}

static void test_solution_is_the_only_one(void **state)
{
  Rolling      r     = NewRolling(22, 0.28);
  const double u     = Unit(&r.c);
  SamBalance   creep = Creep(0.5 * u, 0.2 * u, 0.7 * u / r.c.s.a), same = creep;
  Vec          q = NewField(r.c.s.grid, 2), plain = NewField(r.c.s.grid, 2);

  (void)state;
  (void)SolveWell(&r.c, NULL, NULL, 1e-8, &creep, q);
  SolvePlainly(&r.c, &same, plain);
  sam_assert_close(Difference(q, plain, NORM_INFINITY), 0, 1e-6);
  sam_destroy(&q, &plain);
  DestroyRolling(&r);
}

/* Stick, slip and loads on one grid, nested grids, and a part of a grid, with few products. */
static void test_conditions_hold(void **state)
{
  static const PetscInt cells[] = {30, 90, 160};

  (void)state;
  for (int k = 0; k < 3; k++)
    for (int loaded = 0; loaded < 3; loaded++) {
      Rolling      r     = NewRolling(cells[k], 0.28);
      const double u     = Unit(&r.c);
      SamBalance   given = loaded ? Loaded(&r.c, loaded == 1 ? 0.95 : 0.3, loaded == 1 ? 0 : 0.4, 0)
                                  : Creep(0.3 * u, 0, 0.5 * u / r.c.s.a),
                 found;
      Vec q = NewField(r.c.s.grid, 2);

      if (loaded == 2) {
        given.force[2] = PETSC_FALSE;
        given.rigid[2] = 0.3 * u / r.c.s.a;
      }
      found = given;
      sam_assert(SolveWell(&r.c, NULL, NULL, 3e-7, &found, q).applies <= 30);
      AssertConditions(&r.c, NULL, &found, &given, q);
      sam_call(VecDestroy(&q));
      DestroyRolling(&r);
    }
}

/* By cells the power lacks half of (D q).C (D q)/dx; with the slip between two cells it is that of the loads. */
static void test_power(void **state)
{
  Rolling       r    = NewRolling(50, 0.28);
  const SamGrid grid = r.c.s.grid;
  const double  u = Unit(&r.c), area = grid->dx * grid->dy;
  SamBalance    creep = Creep(0.5 * u, 0.3 * u, 0.4 * u / r.c.s.a), none = Creep(0, 0, 0);
  Vec           q = NewField(grid, 2), d, v = NewField(grid, 2), slip, velocity, middle;
  double        power;

  (void)state;
  (void)SolveWell(&r.c, NULL, NULL, 1e-8, &creep, q);
  power = creep.rigid[0] * creep.load[0] + creep.rigid[1] * creep.load[1] + creep.rigid[2] * creep.load[2];
  slip  = Slip(&r.c, &creep, q);
  d     = NewNeighbours(grid, q, 1);
  sam_call(SamElasticityApplyTangential(r.rest, d, v));
  sam_assert_close(-Dot(q, slip) * area, power - 0.5 * Dot(d, v) / grid->dx * area, 1e-11 * power);
  velocity = Slip(&r.c, &none, q);
  middle   = NewNeighbours(grid, velocity, 0);
  sam_assert_close(Dot(q, middle) * area, 0, 1e-11 * power);
  sam_destroy(&q, &d, &v, &slip, &velocity, &middle);
  DestroyRolling(&r);
}

/* Loads beyond what the bound can carry are gross slip, with the limit of bodies at rest. */
static void test_gross_slip(void **state)
{
  Rolling       r = NewRolling(40, 0.28);
  SamBalance    b = Loaded(&r.c, 1.25, 0, 0);
  Vec           q = NewField(r.c.s.grid, 2);
  const Outcome o = Solve(&r.c, r.c.bound, NULL, NULL, 0, &b, q);

  (void)state;
  sam_assert(o.reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
  sam_assert_close(o.limit, 0.8, 1e-9);
  sam_call(VecDestroy(&q));
  DestroyRolling(&r);
}

/* The checksum of a solution, which does not depend on the number of ranks. */
static void test_bits_are_the_same_on_any_number_of_ranks(void **state)
{
  Sphere     s[2];
  double    *shear[2];
  SamBalance b[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SamElasticity rolling;
    SamTangential t;
    Vec           bound, none, q;

    s[k] = NewSphereOn(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, NewPair(210e9, 0.28, 210e9, 0.28), 71, 1.3, 1e-5, -2e-5);
    bound = NewRandom(s[k].grid, 1, 5);
    none  = NewField(s[k].grid, 1);
    q     = NewField(s[k].grid, 2);
    sam_call(VecShift(bound, 0.2)); /* in some cells no contact */
    sam_call(VecScale(bound, 1e8));
    sam_call(VecPointwiseMax(bound, bound, none));
    sam_call(SamElasticityCreateRolling(s[k].elasticity, &rolling));
    sam_call(SamTangentialCreate(rolling, &t));
    b[k] = (SamBalance){.kind  = SAM_BALANCE_TANGENTIAL,
                        .force = {PETSC_TRUE, PETSC_FALSE, PETSC_FALSE},
                        .load  = {20},
                        .rigid = {0, 1e-3, 5}};
    sam_call(SamTangentialSolve(t, bound, NULL, &b[k], PETSC_FALSE, q));
    shear[k] = Whole(s[k].grid, 2, q);
    sam_call(SamTangentialDestroy(&t));
    sam_call(SamElasticityDestroy(&rolling));
    sam_destroy(&bound, &none, &q);
  }
  sam_assert(b[0].rigid[0] == b[1].rigid[0] && b[0].load[1] == b[1].load[1]);
  sam_assert(!memcmp(shear[0], shear[1], sizeof(double) * 2 * 71 * 71));
  for (int k = 0; k < 2; k++) {
    free(shear[k]);
    DestroySphere(&s[k]);
  }
}

/* A disc of bound 1e8 Pa whose first column is `first`. */
static void SetDisc(SamGrid grid, PetscInt first, PetscInt radius, Vec bound)
{
  double *b;

  sam_call(VecGetArray(bound, &b));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt i = k % grid->nx - first - radius, j = grid->row_start + k / grid->nx - grid->ny / 2;

    b[k] = i * i + j * j <= radius * radius ? 1e8 : 0;
  }
  sam_call(VecRestoreArray(bound, &b));
}

/* Contact that moves to the first column of the part of the grid in use needs another part: it acts one cell behind. */
static void test_part_holds_the_cell_behind(void **state)
{
  Rolling    r     = NewRolling(120, 0.28);
  Vec        q     = NewField(r.c.s.grid, 2);
  SamBalance creep = Creep(1e-3, 0, 0), given = creep;
  PetscInt   first[2], n[2];

  (void)state;
  SetDisc(r.c.s.grid, 50, 20, r.c.bound);
  (void)SolveWell(&r.c, NULL, NULL, 0, &creep, q);
  sam_call(SamElasticityGetPartPlace(r.c.s.elasticity, first, n));
  sam_assert(first[0] > 0 && first[0] < 50);
  SetDisc(r.c.s.grid, first[0], 20, r.c.bound);
  creep = given;
  (void)SolveWell(&r.c, NULL, NULL, 3e-7, &creep, q);
  AssertConditions(&r.c, NULL, &creep, &given, q);
  sam_call(VecDestroy(&q));
  DestroyRolling(&r);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_operator_is_that_of_the_differences),
    cmocka_unit_test(test_reciprocity),
    cmocka_unit_test(test_solution_is_the_only_one),
    cmocka_unit_test(test_conditions_hold),
    cmocka_unit_test(test_power),
    cmocka_unit_test(test_gross_slip),
    cmocka_unit_test(test_part_holds_the_cell_behind),
    cmocka_unit_test(test_bits_are_the_same_on_any_number_of_ranks),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

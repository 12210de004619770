/* The normal problem with surfaces that yield besides: complementarity of the solution, by a product of its own. */
#include "normals.h"
#include "methods/methods.h"

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/normal.h>

/* What a cell yields besides, in units of its influence on itself: little to the left, `most` to the right. */
static double Yield(double x, double y, const void *context)
{
  const double *c = (const double *)context; /* most, length */

  return c[0] * (0.5 + 0.5 * tanh(x / c[1])) * (1.2 + cos(2 * y / c[1]));
}

static Vec NewYield(const Sphere *s, double most)
{
  const double c[2] = {most, 0.3 * s->a};
  Vec          d    = NewFrom(s->grid, Yield, c);
  PetscReal    self;

  sam_call(SamElasticityGetSelfInfluence(s->elasticity, &self, NULL));
  sam_call(VecScale(d, self));
  return d;
}

static Outcome SolveYielding(const Sphere *s, SamSolverType type, Vec d, SamBalance *balance, Vec p)
{
  SamNormal normal;
  Outcome   o;

  sam_call(SamNormalCreate(s->elasticity, &normal));
  sam_call(SamSolverSetType(SamNormalAsSolver(normal), type));
  sam_call(SamNormalSolveYielding(normal, s->h, d, balance, PETSC_FALSE, p));
  o.reason = SamSolverGetReason(SamNormalAsSolver(normal));
  sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), &o.error, &o.iterations, &o.applies, &o.preconditions));
  sam_call(SamNormalDestroy(&normal));
  if (getenv("SAM_SHOW")) print_message("# %s its %d products %d\n", type, (int)o.iterations, (int)o.applies);
  return o;
}

/* The largest |g| where p > 0 and -g elsewhere, over the largest displacement; `lines`: they yield, not cells. */
static double Complementarity(const Sphere *s, Vec d, const SamBalance *balance, Vec p, PetscBool lines)
{
  const PetscInt nx    = s->grid->nx;
  double         error = 0, most = 0, *u;
  const double  *h, *pressure, *yield;
  Vec            gap = NewField(s->grid, 1);

  sam_call(SamElasticityApplyNormal(s->elasticity, p, gap));
  sam_call(VecGetArray(gap, &u));
  sam_call(VecGetArrayRead(s->h, &h));
  sam_call(VecGetArrayRead(p, &pressure));
  sam_call(VecGetArrayRead(d, &yield));
  for (PetscInt k = 0; k < s->grid->cells; k++) {
    const double x = SamGridX(s->grid, k % s->grid->nx), y = SamGridY(s->grid, s->grid->row_start + k / s->grid->nx);
    double       line = 0;

    for (PetscInt i = k / nx * nx; i < (k / nx + 1) * nx; i++) line += pressure[i] * s->grid->dx;

    const double displacement = u[k] + yield[k] * (lines ? line : pressure[k]);
    const double g = displacement + h[k] - (balance->rigid[0] - y * balance->rigid[1] + x * balance->rigid[2]);

    error = fmax(error, pressure[k] > 0 ? fabs(g) : -g);
    if (!(pressure[k] >= 0)) error = INFINITY;
    most = fmax(most, displacement);
  }
  sam_call(VecRestoreArrayRead(d, &yield));
  sam_call(VecRestoreArrayRead(p, &pressure));
  sam_call(VecRestoreArrayRead(s->h, &h));
  sam_call(VecRestoreArray(gap, &u));
  sam_call(VecDestroy(&gap));
  sam_call(SamMax(PETSC_COMM_WORLD, 1, &error));
  sam_call(SamMax(PETSC_COMM_WORLD, 1, &most));
  return error / most;
}

static void test_solution_is_complementary(void **state)
{
  static const SamSolverType types[] = {SAM_NORMAL_ACTIVESET, SAM_NORMAL_POLONSKYKEER};
  static const double        most[]  = {0.3, 5, 60};

  (void)state;
  for (int t = 0; t < 2; t++)
    for (int k = 0; k < 3; k++)
      for (int forced = 0; forced < 2; forced++) {
        Sphere          s       = NewSphere(58, 2, 0.3);
        const PetscReal tilt[3] = {1.3 * s.a * s.a / s.R, 0, 0.1 * s.a / s.R};
        SamBalance      balance = forced ? Forced(s.N, 0, 0) : Displaced(tilt);
        Vec             d = NewYield(&s, most[k]), p = NewField(s.grid, 1);
        const Outcome   o = SolveYielding(&s, types[t], d, &balance, p);

        sam_assert(o.reason == SAM_SOLVER_CONVERGED_RTOL);
        sam_assert(Complementarity(&s, d, &balance, p, PETSC_FALSE) < 3e-8);
        if (forced) sam_assert_close(balance.load[0], s.N, 1e-12 * s.N);
        sam_destroy(&p, &d);
        DestroySphere(&s);
      }
}

static double YieldOfLine(double x, double y, const void *context)
{
  const double *c = (const double *)context;

  (void)x;
  return c[0] * (1.2 + sin(2 * y / c[1]));
}

/* Where material streams through the contact, a line along x yields by the integral of its pressure. */
static void test_lines_yield_in_steady_rolling(void **state)
{
  static const SamSolverType types[] = {SAM_NORMAL_ACTIVESET, SAM_NORMAL_POLONSKYKEER};
  static const double        most[]  = {0.3, 60};

  (void)state;
  for (int t = 0; t < 2; t++)
    for (int k = 0; k < 2; k++) {
      Sphere     s = NewSphere(58, 2, 0.3), moving = s;
      PetscReal  self;
      SamBalance balance = Forced(s.N, 0, 0);
      Vec        d, p = NewField(s.grid, 1);

      sam_call(SamElasticityGetSelfInfluence(s.elasticity, &self, NULL));
      d = NewFrom(s.grid, YieldOfLine, (const double[]){most[k] * self / s.a, 0.3 * s.a});
      sam_call(SamElasticityCreateRolling(s.elasticity, &moving.elasticity));
      sam_assert(SolveYielding(&moving, types[t], d, &balance, p).reason == SAM_SOLVER_CONVERGED_RTOL);
      sam_assert(Complementarity(&s, d, &balance, p, PETSC_TRUE) < 3e-8);
      sam_assert_close(balance.load[0], s.N, 1e-12 * s.N);
      sam_call(SamElasticityDestroy(&moving.elasticity));
      sam_destroy(&p, &d);
      DestroySphere(&s);
    }
}

/* Where nothing yields besides, the solution is the usual one, to the last bit. */
static void test_no_yield_changes_nothing(void **state)
{
  Sphere     s       = NewSphere(50, 1.5, 0.3);
  SamBalance balance = Forced(s.N, 0, 0), other = balance;
  Vec        d = NewYield(&s, 0), p = NewField(s.grid, 1), q = NewField(s.grid, 1);

  (void)state;
  SolveWell(s.elasticity, s.h, NULL, 0, &balance, p);
  (void)SolveYielding(&s, SAM_NORMAL_ACTIVESET, d, &other, q);
  sam_assert(Difference(q, p, NORM_INFINITY) == 0);
  sam_destroy(&q, &p, &d);
  DestroySphere(&s);
}

/* Much softer than the bodies, the yield is a bed of springs: p = (d_z - h)/yield. */
static void test_soft_yield_is_a_bed_of_springs(void **state)
{
  Sphere          s        = NewSphere(60, 2, 0.3);
  const PetscReal rigid[3] = {s.a * s.a / s.R, 0, 0};
  SamBalance      balance  = Displaced(rigid);
  Vec             d = NewField(s.grid, 1), p = NewField(s.grid, 1), bed = NewField(s.grid, 1);
  PetscReal       self;
  double         *b;
  const double   *h;

  (void)state;
  sam_call(SamElasticityGetSelfInfluence(s.elasticity, &self, NULL));
  sam_call(VecSet(d, 1e6 * self));
  (void)SolveYielding(&s, SAM_NORMAL_ACTIVESET, d, &balance, p);
  sam_call(VecGetArray(bed, &b));
  sam_call(VecGetArrayRead(s.h, &h));
  for (PetscInt k = 0; k < s.grid->cells; k++) b[k] = fmax(0, rigid[0] - h[k]) / (1e6 * self);
  sam_call(VecRestoreArrayRead(s.h, &h));
  sam_call(VecRestoreArray(bed, &b));
  sam_assert(Difference(p, bed, NORM_2) < 1e-4);
  sam_destroy(&bed, &p, &d);
  DestroySphere(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_solution_is_complementary),
    cmocka_unit_test(test_lines_yield_in_steady_rolling),
    cmocka_unit_test(test_no_yield_changes_nothing),
    cmocka_unit_test(test_soft_yield_is_a_bed_of_springs),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

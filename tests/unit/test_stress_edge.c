/* Stresses on the surface at the contact's edge: Hertz's contact that slides. */
#include "contacts.h"

#include <petsam/private/edges.h>
#include <petsam/private/stressimpl.h>
#include <petsam/private/elasticity.h>

/* A sphere beside the grid's centre, its shear mu p: the map of the surface, its edge, and the stresses there. */
typedef struct {
  Case    c;
  Vec     field;
  SamEdge edge;
  double *stress, scale, x, y; /* the centre, m */
} Sliding;

static SamStress NewStress(const Case *c)
{
  SamStress stress;

  sam_call(SamElasticityCreateStress(c->s.elasticity, 2, NULL, &stress));
  return stress;
}

static Sliding NewSliding(PetscInt n, double mu)
{
  Sliding       s      = {.c = NewBeside(Steel(), n, 1.5, 0.31, 0.17, 0, "")};
  const SamGrid grid   = s.c.s.grid;
  SamStress     stress = NewStress(&s.c);
  Vec           square;
  const double *p;
  double       *a;

  s.x     = 0.31 * grid->dx;
  s.y     = 0.17 * grid->dy;
  s.scale = Hertz(&s.c.s, 0);
  s.field = NewField(grid, SAM_STRESS_COMPONENTS);
  square  = NewField(grid, 1);
  sam_call(VecPointwiseMult(square, SolutionOf(&s.c)->pressure, SolutionOf(&s.c)->pressure));
  sam_call(SamEdgeReconstruct(grid, PETSC_FALSE, square, &s.edge));
  sam_call(VecGetArrayRead(SolutionOf(&s.c)->pressure, &p));
  sam_call(VecGetArray(s.field, &a));
  for (PetscInt k = 0; k < grid->cells; k++) {
    a[SAM_STRESS_ZZ * grid->cells + k] = p[k];
    a[SAM_STRESS_XZ * grid->cells + k] = mu * p[k];
  }
  sam_call(VecRestoreArray(s.field, &a));
  sam_call(VecRestoreArrayRead(SolutionOf(&s.c)->pressure, &p));
  sam_call(SamStressSetDepth(stress, 0));
  sam_call(SamStressApply(stress, s.field));
  sam_call(PetscMalloc1(3 * s.edge.count, &s.stress));
  sam_call(SamStressAtEdge(stress, s.field, &s.edge, s.stress));
  sam_call(SamStressDestroy(&stress));
  sam_call(VecDestroy(&square));
  return s;
}

static void DestroySliding(Sliding *s)
{
  sam_call(PetscFree(s->stress));
  sam_call(SamEdgeDestroy(&s->edge));
  sam_call(VecDestroy(&s->field));
  DestroyCase(&s->c);
}

/*
  The largest deviation from the closed solution over all points of the edge, relative to p0: by the pressure the radial
  stress is (1 - 2 nu)/3 and the circumferential one its opposite; full sliding adds, linear in x and y,
  xx = -mu pi (4 + nu) x/8, yy = -3 mu pi nu x/8, xy = -mu pi (2 - nu) y/8.
*/
static double Deviation(const Sliding *s, double mu, double *count)
{
  const double nu   = 0.3;
  double       most = 0, n = (double)s->edge.count;

  for (PetscInt k = 0; k < s->edge.count; k++) {
    const double dx = (double)s->edge.x[k] - s->x, dy = (double)s->edge.y[k] - s->y, r = hypot(dx, dy);
    const double x = dx / r, y = dy / r, radial = (1 - 2 * nu) / 3, *got = s->stress + 3 * k;
    const double xx = radial * (x * x - y * y) - mu * PETSC_PI * (4 + nu) * x / 8,
                 yy = -radial * (x * x - y * y) - 3 * mu * PETSC_PI * nu * x / 8,
                 xy = 2 * radial * x * y - mu * PETSC_PI * (2 - nu) * y / 8;

    most = fmax(most, fabs(got[0] / s->scale - xx));
    most = fmax(most, fabs(got[1] / s->scale - yy));
    most = fmax(most, fabs(got[2] / s->scale - xy));
  }
  (void)MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  (void)MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  *count = n;
  return most;
}

/* The map's largest value is 10 % off at the trailing edge. */
static void test_edge_has_the_stresses_of_hertz_and_of_sliding(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    const double mu = k ? 0.4 : 0;
    Sliding      s  = NewSliding(90, mu);
    double       count;
    const double most = Deviation(&s, mu, &count);

    if (getenv("SAM_SHOW")) print_message("# mu %g: %g of p0 at %g points\n", mu, most, count);
    sam_assert(count > 150);
    sam_assert(most < (k ? 6e-3 : 3e-3));
    DestroySliding(&s);
  }
}

/* A point too near to the grid's border has no complete surroundings. */
static void test_edge_at_the_border_is_left(void **state)
{
  Case      c    = NewCase(Steel(), 60, 1.1, 0, "");
  SamStress body = NewStress(&c);
  SamEdge   edge;
  Vec       field = NewField(c.s.grid, SAM_STRESS_COMPONENTS), square = NewField(c.s.grid, 1);
  double   *stress, none                                              = 0;

  (void)state;
  (void)Solve(&c, &(SamControl[]){Loads(&c, 1, 0, 0, 0)}[0]);
  sam_call(VecPointwiseMult(square, SolutionOf(&c)->pressure, SolutionOf(&c)->pressure));
  sam_call(SamEdgeReconstruct(c.s.grid, PETSC_FALSE, square, &edge));
  sam_call(PetscMalloc1(3 * edge.count, &stress));
  sam_call(SamStressAtEdge(body, field, &edge, stress));
  for (PetscInt k = 0; k < edge.count; k++)
    if (isnan(stress[3 * k])) none++;
  (void)MPI_Allreduce(MPI_IN_PLACE, &none, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  sam_assert(none > 0);
  body->ops.atedge = NULL; /* a type that does not know them */
  sam_call(SamStressAtEdge(body, field, &edge, stress));
  none = 0;
  for (PetscInt k = 0; k < 3 * edge.count; k++)
    if (!isnan(stress[k])) none++;
  sam_assert(none == 0);
  sam_call(SamStressDestroy(&body));
  sam_call(PetscFree(stress));
  sam_call(SamEdgeDestroy(&edge));
  sam_destroy(&square, &field);
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_edge_has_the_stresses_of_hertz_and_of_sliding),
    cmocka_unit_test(test_edge_at_the_border_is_left),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

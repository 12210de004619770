/* Contact of periodic bodies: Westergaard's surface, waves in both directions, roughness, stick and slip. */
#include "fields.h"
#include "methods/methods.h"

#include <petsam/normal.h>
#include <petsam/tangential.h>

/* A surface of amplitude and wavelength, on a grid of one wavelength. */
static const double amplitude = 1e-6, wavelength = 1e-3;

typedef struct {
  SamPair       pair;
  SamGrid       grid;
  SamElasticity elasticity;
  Vec           h, p;
  double        area; /* of the grid, m^2 */
} Case;

static Case NewCase(PetscInt nx, PetscInt ny, double height, double (*shape)(double, double, const void *))
{
  Case c = {.pair = NewPair(210e9, 0.3, 70e9, 0.33), .area = wavelength * height};

  c.grid = NewGrid(nx, ny, wavelength, height);
  c.h    = NewFrom(c.grid, shape, NULL);
  c.p    = NewField(c.grid, 1);
  sam_call(SamElasticityCreate(c.grid, c.pair, &c.elasticity));
  sam_call(SamElasticitySetType(c.elasticity, SAM_ELASTICITY_PERIODIC));
  return c;
}

static void DestroyCase(Case *c)
{
  sam_destroy(&c->h, &c->p);
  sam_call(SamElasticityDestroy(&c->elasticity));
  sam_call(SamGridDestroy(&c->grid));
}

/* Solves for a mean pressure, or, without one, for the approach in the balance. */
static SamSolverReason Press(Case *c, SamSolverType type, double rtol, double mean, SamBalance *b)
{
  SamNormal       normal;
  SamSolverReason reason;
  PetscInt        its;

  b->kind     = SAM_BALANCE_NORMAL;
  b->force[0] = mean > 0;
  b->load[0]  = mean * c->area;
  sam_call(SamNormalCreate(c->elasticity, &normal));
  sam_call(SamSolverSetType(SamNormalAsSolver(normal), type));
  sam_call(SamSolverSetTolerances(SamNormalAsSolver(normal), rtol, PETSC_DEFAULT));
  sam_call(SamNormalSolve(normal, c->h, b, PETSC_FALSE, c->p));
  reason = SamSolverGetReason(SamNormalAsSolver(normal));
  sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), NULL, &its, NULL, NULL));
  if (getenv("SAM_SHOW"))
    print_message("# %s %d x %d: %s, %d iterations, approach %.10g\n", type, (int)c->grid->nx, (int)c->grid->ny,
                  SamSolverReasonName(reason), (int)its, b->rigid[0]);
  sam_call(SamNormalDestroy(&normal));
  return reason;
}

static const SamSolverType types[2] = {SAM_NORMAL_ACTIVESET, SAM_NORMAL_POLONSKYKEER};

/* ---- Westergaard ---- */

static double Wave(double x, double y, const void *context)
{
  (void)y;
  (void)context;
  return amplitude * (1 - cos(2 * PETSC_PI * x / wavelength));
}

/* The mean pressure that brings all of the surface into contact. */
static double FullPressure(const Case *c)
{
  return PETSC_PI * c->pair->modulus * amplitude / wavelength;
}

/* p = mean + p* cos(2 pi x/lambda), for a mean that is at least p*; displacements count from the mean surface. */
static void test_wave_in_full_contact_is_exact(void **state)
{
  (void)state;
  for (int t = 0; t < 2; t++) {
    Case          c    = NewCase(47, 36, wavelength, Wave);
    SamBalance    b    = {.kind = SAM_BALANCE_NORMAL};
    const double  full = FullPressure(&c), mean = 1.3 * full;
    double        error = 0;
    const double *p;

    sam_assert(Press(&c, types[t], 1e-10, mean, &b) == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert_close(b.rigid[0], amplitude, 1e-9 * amplitude);
    sam_call(VecGetArrayRead(c.p, &p));
    for (PetscInt j = 0; j < c.grid->rows; j++)
      for (PetscInt i = 0; i < c.grid->nx; i++)
        error =
          fmax(error, fabs(p[j * c.grid->nx + i] - mean - full * cos(2 * PETSC_PI * SamGridX(c.grid, i) / wavelength)));
    sam_call(VecRestoreArrayRead(c.p, &p));
    sam_assert(error < 1e-7 * full); /* rtol times the condition, about n */
    DestroyCase(&c);
  }
}

/* Westergaard's pressure at x for the sine of half the contact's angle, in units of p*. */
static double Westergaard(double x, double sine)
{
  const double s = sin(PETSC_PI * x / wavelength);

  return fabs(s) < sine ? 2 * cos(PETSC_PI * x / wavelength) * sqrt(sine * sine - s * s) : 0;
}

/*
  Errors of a contact of half width 0.3 wavelengths, relative: of the approach, and of the pressure in the 2-norm, in
  the inner half of the contact and in all of it.
*/
static void WestergaardErrors(PetscInt n, SamSolverType type, double errors[3])
{
  const double  sine = sin(0.3 * PETSC_PI), square = sine * sine;
  Case          c        = NewCase(n, 5, wavelength / 8, Wave);
  SamBalance    b        = {.kind = SAM_BALANCE_NORMAL};
  Vec           exact    = NewField(c.grid, 1);
  double        inner[2] = {0, 0};
  double       *a;
  const double *p;

  sam_assert(Press(&c, type, 1e-10, FullPressure(&c) * square, &b) == SAM_SOLVER_CONVERGED_RTOL);
  sam_call(VecGetArray(exact, &a));
  sam_call(VecGetArrayRead(c.p, &p));
  for (PetscInt j = 0; j < c.grid->rows; j++)
    for (PetscInt i = 0; i < n; i++) {
      const double x = SamGridX(c.grid, i), is = fabs(x) < 0.15 * wavelength ? 1 : 0;

      a[j * n + i] = FullPressure(&c) * Westergaard(x, sine);
      inner[0] += is * pow(p[j * n + i] - a[j * n + i], 2);
      inner[1] += is * pow(a[j * n + i], 2);
    }
  sam_call(VecRestoreArrayRead(c.p, &p));
  sam_call(VecRestoreArray(exact, &a));
  (void)MPI_Allreduce(MPI_IN_PLACE, inner, 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  /* the derivative of the least energy by the mean pressure, from the integral of the pressure times log |sin| */
  errors[0] = fabs(b.rigid[0] / (amplitude * square * (1 - log(square))) - 1);
  errors[1] = sqrt(inner[0] / inner[1]);
  errors[2] = Difference(c.p, exact, NORM_2);
  sam_call(VecDestroy(&exact));
  DestroyCase(&c);
}

/*
  Mean pressure p* sin^2(pi a/lambda) on the half width a. The root at the contact's edge makes the pressure there less
  than of second order. Which part of a cell the edge cuts off varies, so orders are taken over a factor of 16.
*/
static void test_wave_in_partial_contact_is_of_second_order(void **state)
{
  (void)state;
  for (int t = 0; t < 2; t++) {
    const double least[3] = {1.8, 1.8, 0.9}, most[3] = {1e-5, 1e-5, 1e-3};
    double       coarse[3], fine[3];

    WestergaardErrors(31, types[t], coarse);
    WestergaardErrors(496, types[t], fine);
    for (int k = 0; k < 3; k++) {
      const double order = log(coarse[k] / fine[k]) / log(16);

      if (getenv("SAM_SHOW")) print_message("# error %d: %g, order %.2f\n", k, fine[k], order);
      sam_assert(order > least[k] && fine[k] < most[k]);
    }
  }
}

/* The same contact by its approach. Beyond the mean separation, and at it, there is no or no single solution. */
static void test_approach_is_limited_by_the_mean_separation(void **state)
{
  Case       c = NewCase(64, 40, wavelength, Wave);
  SamBalance b = {.kind = SAM_BALANCE_NORMAL}, again;
  Vec        p;

  (void)state;
  sam_assert(Press(&c, types[0], 1e-10, 0.6 * FullPressure(&c), &b) == SAM_SOLVER_CONVERGED_RTOL);
  p = Copy(c.p);
  for (int t = 0; t < 2; t++) {
    again = b;
    sam_assert(Press(&c, types[t], 1e-10, 0, &again) == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert_close(Difference(c.p, p, NORM_2), 0, 1e-7);
    sam_assert_close(again.load[0], 0.6 * FullPressure(&c) * c.area, 1e-8 * again.load[0]);
    again.rigid[0] = 0.999 * amplitude; /* nearly closed */
    sam_assert(Press(&c, types[t], 1e-8, 0, &again) == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert(again.load[0] > 0.9 * FullPressure(&c) * c.area && again.load[0] < FullPressure(&c) * c.area);
    again.rigid[0] = 1.000001 * amplitude;
    sam_assert(Press(&c, types[t], 1e-8, 0, &again) == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
    again.rigid[0] = 3 * amplitude;
    sam_assert(Press(&c, types[t], 1e-8, 0, &again) == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM);
    again.rigid[0] = -amplitude;
    sam_assert(Press(&c, types[t], 1e-8, 0, &again) == SAM_SOLVER_CONVERGED_TRIVIAL);
  }
  sam_call(VecDestroy(&p));
  DestroyCase(&c);
}

/* ---- waves in both directions: Johnson, Greenwood and Higginson 1985, Int. J. Mech. Sci. 27, 383-396 ---- */

static double Waves(double x, double y, const void *context)
{
  (void)context;
  return amplitude * (1 - cos(2 * PETSC_PI * x / wavelength) * cos(2 * PETSC_PI * y / wavelength));
}

/* The wave vector is sqrt(2) times as long as that of a single wave, and so is the pressure. */
static double FullPressureOfWaves(const Case *c)
{
  return sqrt(2.0) * FullPressure(c);
}

static double ContactShare(const Case *c)
{
  const double *p;
  double        count = 0;

  sam_call(VecGetArrayRead(c->p, &p));
  for (PetscInt k = 0; k < c->grid->cells; k++) count += p[k] > 0;
  sam_call(VecRestoreArrayRead(c->p, &p));
  (void)MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return count / ((double)c->grid->nx * (double)c->grid->ny);
}

static void test_waves_in_full_contact_are_exact(void **state)
{
  Case          c    = NewCase(40, 33, wavelength, Waves);
  SamBalance    b    = {.kind = SAM_BALANCE_NORMAL};
  const double  full = FullPressureOfWaves(&c), mean = full * 1.0001;
  double        error = 0;
  const double *p;

  (void)state;
  sam_assert(Press(&c, types[0], 1e-10, mean, &b) == SAM_SOLVER_CONVERGED_RTOL);
  sam_assert(ContactShare(&c) == 1);
  sam_call(VecGetArrayRead(c.p, &p));
  for (PetscInt j = 0; j < c.grid->rows; j++)
    for (PetscInt i = 0; i < c.grid->nx; i++)
      error = fmax(error, fabs(p[j * c.grid->nx + i] - mean -
                               full * cos(2 * PETSC_PI * SamGridX(c.grid, i) / wavelength) *
                                 cos(2 * PETSC_PI * SamGridY(c.grid, c.grid->row_start + j) / wavelength)));
  sam_call(VecRestoreArrayRead(c.p, &p));
  sam_assert(error < 1e-7 * full);
  DestroyCase(&c);
}

/* Under a light load each of the two summits in a period is Hertz's contact of radius of curvature R. */
static void test_summits_under_a_light_load_are_hertz_contacts(void **state)
{
  Case         c = NewCase(256, 256, wavelength, Waves);
  SamBalance   b = {.kind = SAM_BALANCE_NORMAL};
  const double R = wavelength * wavelength / (4 * PETSC_PI * PETSC_PI * amplitude), a = 0.05 * wavelength,
               E = c.pair->modulus, N = 4 * E * a * a * a / (3 * R), p0 = 2 * E * a / (PETSC_PI * R);
  PetscReal most;

  (void)state;
  sam_assert(Press(&c, types[0], 1e-8, 2 * N / c.area, &b) == SAM_SOLVER_CONVERGED_RTOL);
  sam_call(VecMax(c.p, NULL, &most));
  if (getenv("SAM_SHOW"))
    print_message("# light: largest pressure %.4f, area %.4f of Hertz\n", most / p0,
                  ContactShare(&c) * c.area / (2 * PETSC_PI * a * a));
  /* the summits' neighbours and their shape change both by about (a/lambda)^2 times some */
  sam_assert_close(most / p0, 1, 0.02);
  sam_assert_close(ContactShare(&c) * c.area / (2 * PETSC_PI * a * a), 1, 0.06);
  DestroyCase(&c);
}

/*
  Near full contact the two valleys in a period are cracks: b^2 = 3 lambda^2 (1 - mean/p*)/(4 pi^2), where a parabolic
  tension leaves no stress intensity at the edge of a penny-shaped crack.
*/
static void test_valleys_near_full_contact_are_cracks(void **state)
{
  Case         c   = NewCase(256, 256, wavelength, Waves);
  SamBalance   b   = {.kind = SAM_BALANCE_NORMAL};
  const double off = 0.05;
  double       open;

  (void)state;
  sam_assert(Press(&c, types[0], 1e-8, (1 - off) * FullPressureOfWaves(&c), &b) == SAM_SOLVER_CONVERGED_RTOL);
  open = 1 - ContactShare(&c);
  if (getenv("SAM_SHOW")) print_message("# open %.5f, cracks %.5f\n", open, 1.5 * off / PETSC_PI);
  sam_assert_close(open / (1.5 * off / PETSC_PI), 1, 0.06);
  DestroyCase(&c);
}

/* ---- roughness ---- */

/* Waves of pseudo-random phases, self-affine, folded at their mean plane. The seed is the context. */
static double Rough(double x, double y, const void *context)
{
  const PetscInt seed = *(const PetscInt *)context;
  double         h    = 0;

  for (PetscInt k = 0; k <= 8; k++)
    for (PetscInt l = k ? -8 : 1; l <= 8; l++)
      h +=
        (k * k + l * l <= 64 ? 1 : 0) * pow((double)(k * k + l * l), -0.9) *
        cos(2 * PETSC_PI * ((double)k * x + (double)l * y * 97 / 53) / wavelength + PETSC_PI * Random(seed, 0, k, l));
  return 0.2 * amplitude * fabs(h);
}

/* Cells that part in short steps come to zero pressure, or else their gap is an error that stays, as it did here. */
static void test_cells_part_when_steps_are_short(void **state)
{
  const PetscInt seeds[5] = {4, 25, 43, 47, 57};

  (void)state;
  for (int k = 0; k < 5; k++) {
    Case         c = NewCase(97, 53, wavelength * 53 / 97, Wave);
    SamBalance   b = {.kind = SAM_BALANCE_NORMAL}, other = b;
    const double mean = (k ? 0.05363 : 0.02823) * FullPressure(&c);
    Vec          p;

    sam_call(VecDestroy(&c.h));
    c.h = NewFrom(c.grid, Rough, &seeds[k]);
    sam_assert(Press(&c, types[0], 1e-8, mean, &b) == SAM_SOLVER_CONVERGED_RTOL);
    p = Copy(c.p);
    sam_assert(Press(&c, types[1], 1e-8, mean, &other) == SAM_SOLVER_CONVERGED_RTOL);
    sam_assert_close(Difference(p, c.p, NORM_2), 0, 1e-6); /* rtol times the condition, about n */
    sam_call(VecDestroy(&p));
    DestroyCase(&c);
  }
}

/* ---- stick and slip ---- */

static double Hills(double x, double y, const void *context)
{
  (void)context;
  return amplitude * (2 - cos(2 * PETSC_PI * x / wavelength + 0.3) - 0.8 * cos(2 * PETSC_PI * y / wavelength - 0.2));
}

/* u_t from q by summation over cells, from the answers to a unit shear on one cell; the grid is one period. */
static double *Responses(const Case *c)
{
  const PetscInt all       = c->grid->nx * c->grid->ny;
  double        *responses = (double *)calloc((size_t)(4 * all), sizeof(*responses));

  for (PetscInt k = 0; k < 2; k++) {
    Vec     q = NewField(c->grid, 2);
    double *u;

    AddAt(c->grid, k, 0, 0, 1, q);
    sam_call(SamElasticityApplyTangential(c->elasticity, q, q));
    u = Whole(c->grid, 2, q);
    memcpy(responses + 2 * k * all, u, sizeof(*u) * (size_t)(2 * all));
    free(u);
    sam_call(VecDestroy(&q));
  }
  return responses;
}

static double SumAt(const Case *c, const double *responses, const double *q, PetscInt component, PetscInt i, PetscInt j)
{
  const PetscInt nx = c->grid->nx, ny = c->grid->ny, all = nx * ny;
  double         sum = 0;

  for (PetscInt k = 0; k < 2; k++)
    for (PetscInt m = 0; m < ny; m++)
      for (PetscInt l = 0; l < nx; l++)
        sum +=
          responses[(2 * k + component) * all + (j - m + ny) % ny * nx + (i - l + nx) % nx] * q[k * all + m * nx + l];
  return sum;
}

/*
  The conditions of stick and slip, with displacements summed up cell by cell: largest distance of q from the projection
  of q - s/self on the disc, relative to the largest bound; and how much of the contact slips.
*/
static double Residual(const Case *c, const SamBalance *b, Vec bound, Vec shear, double *slips)
{
  const PetscInt nx = c->grid->nx, all = nx * c->grid->ny;
  double        *responses = Responses(c), *limit = Whole(c->grid, 1, bound), *q = Whole(c->grid, 2, shear);
  double         worst = 0, largest = 0, contact = 0;
  PetscReal      self;

  sam_call(SamElasticityGetSelfInfluence(c->elasticity, NULL, &self));
  *slips = 0;
  for (PetscInt k = 0; k < all; k++) {
    double y[2], size, scale;

    if (limit[k] <= 0) {
      sam_assert(q[k] == 0 && q[all + k] == 0);
      continue;
    }
    for (PetscInt d = 0; d < 2; d++)
      y[d] = q[d * all + k] - (SumAt(c, responses, q, d, k % nx, k / nx) - b->rigid[d]) / self;
    size    = hypot(y[0], y[1]);
    scale   = size > limit[k] ? limit[k] / size : 1;
    worst   = fmax(worst, hypot(q[k] - scale * y[0], q[all + k] - scale * y[1]));
    largest = fmax(largest, limit[k]);
    contact += 1;
    *slips += size > limit[k];
  }
  *slips /= contact;
  free(responses);
  free(limit);
  free(q);
  return worst / largest;
}

/* Stick and slip of a contact pressed by a mean pressure, under forces (in units of mu N) or displacements. */
static double Shear(Case *c, SamSolverType type, double mean, double tx, double ty, const double *displaced,
                    double *slips)
{
  const double    mu = 0.3;
  SamBalance      b = {.kind = SAM_BALANCE_NORMAL}, t = {.kind = SAM_BALANCE_TANGENTIAL};
  Vec             bound, q                            = NewField(c->grid, 2);
  SamTangential   tangential;
  SamSolverReason reason;
  double          residual;
  PetscInt        its;

  sam_assert(Press(c, types[0], 1e-10, mean, &b) == SAM_SOLVER_CONVERGED_RTOL);
  bound = Copy(c->p);
  sam_call(VecScale(bound, mu));
  for (PetscInt k = 0; k < 2; k++) {
    t.force[k] = displaced ? PETSC_FALSE : PETSC_TRUE;
    t.load[k]  = mu * mean * c->area * (k ? ty : tx);
    t.rigid[k] = displaced ? displaced[k] : 0;
  }
  sam_call(SamTangentialCreate(c->elasticity, &tangential));
  sam_call(SamSolverSetType(SamTangentialAsSolver(tangential), type));
  sam_call(SamSolverSetTolerances(SamTangentialAsSolver(tangential), 1e-8, PETSC_DEFAULT));
  sam_call(SamTangentialSolve(tangential, bound, NULL, &t, PETSC_FALSE, q));
  reason = SamSolverGetReason(SamTangentialAsSolver(tangential));
  sam_call(SamSolverGetStatistics(SamTangentialAsSolver(tangential), NULL, &its, NULL, NULL));
  residual = Residual(c, &t, bound, q, slips);
  if (getenv("SAM_SHOW"))
    print_message("# %s: %s, %d iterations, residual %g, slips %.3f, d %g %g\n", type, SamSolverReasonName(reason),
                  (int)its, residual, *slips, t.rigid[0], t.rigid[1]);
  sam_assert(reason == SAM_SOLVER_CONVERGED_RTOL);
  sam_call(SamTangentialDestroy(&tangential));
  sam_destroy(&bound, &q);
  return residual;
}

static const SamSolverType methods[2] = {SAM_TANGENTIAL_NEWTON, SAM_TANGENTIAL_GRADIENT};

static void test_stick_and_slip_by_direct_summation(void **state)
{
  (void)state;
  for (int m = 0; m < 2; m++) {
    Case   c = NewCase(21, 34, 1.3 * wavelength, Hills);
    double slips;

    sam_assert(Shear(&c, methods[m], 0.4 * FullPressure(&c), 0.5, -0.3, NULL, &slips) < 1e-6);
    sam_assert(slips > 0.1 && slips < 0.9);
    DestroyCase(&c);
  }
}

/* On nested grids, whose transfers know nothing of the period. */
static void test_stick_and_slip_on_nested_grids(void **state)
{
  Case   c = NewCase(70, 66, wavelength, Hills);
  double slips;

  (void)state;
  sam_assert(Shear(&c, methods[0], 0.7 * FullPressure(&c), 0.6, 0.2, NULL, &slips) < 1e-6);
  sam_assert(slips > 0.1 && slips < 0.9);
  DestroyCase(&c);
}

/* In full contact a uniform shear displaces nothing: under a force all sticks, under a displacement all slides. */
static void test_full_contact_sticks_or_slides(void **state)
{
  Case         c      = NewCase(36, 33, wavelength, Wave);
  const double far[2] = {1e-4, 0};
  double       slips;

  (void)state;
  for (int m = 0; m < 2; m++) {
    sam_assert(Shear(&c, methods[m], 2 * FullPressure(&c), 0.2, 0, NULL, &slips) < 1e-6);
    sam_assert(slips == 0);
    sam_assert(Shear(&c, methods[m], 2 * FullPressure(&c), 0, 0, far, &slips) < 1e-6);
    sam_assert(slips == 1);
  }
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_wave_in_full_contact_is_exact),
    cmocka_unit_test(test_wave_in_partial_contact_is_of_second_order),
    cmocka_unit_test(test_approach_is_limited_by_the_mean_separation),
    cmocka_unit_test(test_waves_in_full_contact_are_exact),
    cmocka_unit_test(test_summits_under_a_light_load_are_hertz_contacts),
    cmocka_unit_test(test_valleys_near_full_contact_are_cracks),
    cmocka_unit_test(test_cells_part_when_steps_are_short),
    cmocka_unit_test(test_stick_and_slip_by_direct_summation),
    cmocka_unit_test(test_stick_and_slip_on_nested_grids),
    cmocka_unit_test(test_full_contact_sticks_or_slides),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}

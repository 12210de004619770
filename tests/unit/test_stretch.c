/*
 * Bulk strain that stretches the surfaces: s = u_t + stretch - rigid.
 */
#include "contacts.h"

#include <petsam/private/checkpoint.h>
#include <unistd.h>

/* Bulk stresses of body 2 that stretch it by that much more than body 1, which is stretched as well. */
static void SetStretch(const Case *c, SamControl *control, double xx, double yy, double xy)
{
  const double E[2]    = {c->s.pair->body[0]->material[0].young, c->s.pair->body[1]->material[0].young},
               nu[2]   = {c->s.pair->body[0]->material[0].poisson, c->s.pair->body[1]->material[0].poisson};
  const double some    = 0.3 * (fabs(xx) + fabs(yy) + fabs(xy)); /* strain of body 1, alike in x and y */
  const double e[2][3] = {{some, some, 0.5 * some}, {some + xx, some + yy, 0.5 * some + xy}};

  for (int b = 0; b < 2; b++) {
    const double plane = E[b] / (1 - nu[b] * nu[b]);

    Prescribe(c->problem, control, b ? "bulk2_stress_xx" : "bulk1_stress_xx", plane * (e[b][0] + nu[b] * e[b][1]));
    Prescribe(c->problem, control, b ? "bulk2_stress_yy" : "bulk1_stress_yy", plane * (e[b][1] + nu[b] * e[b][0]));
    Prescribe(c->problem, control, b ? "bulk2_stress_xy" : "bulk1_stress_xy", E[b] / (1 + nu[b]) * e[b][2]);
  }
}

/* A strain of the size of Cattaneo's displacement over the contact radius, at which large parts of the contact slip. */
static double StrainOf(const Case *c)
{
  return 0.3 * MU * c->s.a / c->s.R;
}

static SamControl Stretched(const Case *c, double xx, double yy, double xy)
{
  SamControl control = Loads(c, 1, 0, 0, 0);

  SetStretch(c, &control, xx * StrainOf(c), yy * StrainOf(c), xy * StrainOf(c));
  return control;
}

/* q(n - 1 - i, j) against q(i, j), each component with its sign: the largest difference over the largest shear. */
static double Asymmetry(const Case *c, int across_y, double sign_x, double sign_y)
{
  const PetscInt n = c->s.grid->nx, all = n * n;
  double        *q    = Whole(c->s.grid, 2, SolutionOf(c)->shear);
  double         most = 0, difference = 0;

  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt k = j * n + i, l = across_y ? (n - 1 - j) * n + i : j * n + n - 1 - i;

      difference = fmax(difference, fmax(fabs(q[l] - sign_x * q[k]), fabs(q[all + l] - sign_y * q[all + k])));
      most       = fmax(most, fmax(fabs(q[k]), fabs(q[all + k])));
    }
  free(q);
  return difference / most;
}

/* A stretch along x is odd in x; shear opposes it. */
static void test_stretch_has_the_symmetry_of_its_strain(void **state)
{
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    Case             c       = NewCase(kind == 2 ? Dissimilar() : Steel(), 49, 1.5, MU, "");
    const SamControl control = Stretched(&c, kind != 1 ? 1 : 0, kind == 1 ? 1 : 0, 0);
    const SamStep    step    = Solve(&c, &control);
    double          *q       = Whole(c.s.grid, 2, SolutionOf(&c)->shear);
    const PetscInt   n = 49, right = 24 * n + 24 + 8, up = n * n + (24 + 8) * n + 24;

    sam_assert(step.status == SAM_STATUS_CONVERGED);
    sam_assert(NumberOf(&c, "stick_area") > 0 && NumberOf(&c, "stick_area") < NumberOf(&c, "contact_area"));
    sam_assert(Asymmetry(&c, 0, -1, 1) < 1e-4 && Asymmetry(&c, 1, 1, -1) < 1e-4); /* rtol times the condition */
    if (kind == 0) sam_assert(q[right] < 0 && fabs(q[right]) > fabs(q[up])); /* body 2 stretches more: it is held */
    if (kind == 1) sam_assert(q[up] < 0 && fabs(q[up]) > fabs(q[right]));
    sam_assert_close(step.load[SAM_COMPONENT_TX], 0, 1e-10 * c.s.N);
    free(q);
    DestroyCase(&c);
  }
}

/* Pure shear strain is that of stretches along the diagonals: x and y may be exchanged. */
static void test_shear_strain_exchanges_x_and_y(void **state)
{
  Case             c       = NewCase(Steel(), 49, 1.5, MU, "");
  const SamControl control = Stretched(&c, 0, 0, 1);
  const SamStep    step    = Solve(&c, &control);
  double          *q = Whole(c.s.grid, 2, SolutionOf(&c)->shear), most = 0, difference = 0;
  const PetscInt   n = 49, all = n * n;

  (void)state;
  AssertGood(&step);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      difference = fmax(difference, fabs(q[j * n + i] - q[all + i * n + j]));
      most       = fmax(most, fabs(q[j * n + i]));
    }
  sam_assert(most > 0 && difference < 1e-4 * most);
  sam_assert(q[(24 + 8) * n + 24] < 0); /* above the centre the surface of body 2 moves along x */
  free(q);
  DestroyCase(&c);
}

/* Hertz's pressure over the largest one. */
static double Cap(double x, double y, double a)
{
  const double r2 = (x * x + y * y) / (a * a);

  return r2 < 1 ? sqrt(1 - r2) : 0;
}

/*
  Without Poisson's ratio the shear displaces the surfaces as the pressure does, so that Cattaneo's solution holds with
  its stick zone, of radius c, moved by e = strain R/mu along x: the difference of two paraboloids of slip is linear.
*/
static double ErrorOfMovedStickZone(PetscInt n, int body)
{
  const SamPair  pair   = NewPair(210e9, 0, 210e9, 0);
  Case           c      = NewCase(pair, n, 1.5, MU, "");
  const double   radius = 0.7, move = 0.2, a = c.s.a; /* c and e over a */
  SamControl     control = Loads(&c, 1, 1 - radius * radius * radius, 0, 0);
  const PetscInt all     = n * n;
  double         sums[2] = {0, 0}, *q;
  SamStep        step;

  Prescribe(c.problem, &control, body ? "bulk2_stress_xx" : "bulk1_stress_xx",
            (body ? 1 : -1) * move * a * MU / c.s.R * pair->body[body]->material[0].young);
  step = Solve(&c, &control);
  AssertGood(&step);
  q = Whole(c.s.grid, 2, SolutionOf(&c)->shear);
  for (PetscInt k = 0; k < all; k++) {
    const double x = SamGridX(c.s.grid, k % n), y = SamGridY(c.s.grid, k / n);
    const double shear = MU * c.s.p0 * (Cap(x, y, a) - radius * Cap(x - move * a, y, radius * a));

    sums[0] += (q[k] - shear) * (q[k] - shear) + q[k + all] * q[k + all];
    sums[1] += shear * shear;
  }
  free(q);
  DestroyCase(&c);
  return sqrt(sums[0] / sums[1]);
}

static void test_tension_moves_the_stick_zone(void **state)
{
  const double coarse = ErrorOfMovedStickZone(49, 1), fine = ErrorOfMovedStickZone(98, 1);

  (void)state;
  sam_assert(coarse < 0.025 && fine < 0.6 * coarse);
  sam_assert_close(ErrorOfMovedStickZone(49, 0), coarse, 1e-4); /* compression of the other body does the same */
}

/* s - u_t is the stretch less the rigid displacement, everywhere. */
static void test_slip_is_displacement_and_stretch_less_rigid(void **state)
{
  Case             c       = NewCase(Steel(), 31, 1.5, MU, "");
  const SamControl control = Stretched(&c, 0.5, -0.3, 0.2);
  const SamStep    step    = Solve(&c, &control);
  Vec              slip    = NewSlip(&c);
  const double     strain = StrainOf(&c), e[3] = {0.5 * strain, -0.3 * strain, 0.2 * strain}, *d = step.rigid;
  double           error = 0, *s;

  (void)state;
  sam_call(VecAXPY(slip, -1, SolutionOf(&c)->displacement_t));
  sam_call(VecGetArray(slip, &s));
  for (PetscInt k = 0; k < c.s.grid->cells; k++) {
    const double x = SamGridX(c.s.grid, k % 31), y = SamGridY(c.s.grid, c.s.grid->row_start + k / 31);
    const double sx = e[0] * x + e[2] * y - (d[SAM_COMPONENT_TX] - y * d[SAM_COMPONENT_MZ]),
                 sy = e[2] * x + e[1] * y - (d[SAM_COMPONENT_TY] + x * d[SAM_COMPONENT_MZ]);

    error = fmax(error, fmax(fabs(s[k] - sx), fabs(s[k + c.s.grid->cells] - sy)));
  }
  sam_call(VecRestoreArray(slip, &s));
  sam_assert(error < 1e-13 * c.s.a * c.s.a / c.s.R);
  sam_call(VecDestroy(&slip));
  DestroyCase(&c);
}

/* The sphere with its grid, elsewhere. */
static Case NewCaseAt(double x, double y)
{
  const SamPair pair = Steel();
  Sphere        s = NewSphereOf(pair, 45, 1.5), at = s;

  at.grid = NewGridOn(PETSC_COMM_WORLD, 45, 45, s.grid->width[0], s.grid->width[1], x, y);
  sam_call(SamElasticityCreate(at.grid, pair, &at.elasticity));
  at.h = Copy(s.h);
  DestroySphere(&s);
  return NewCaseOn(at, MU, NULL, "");
}

/*
  The stretch is about the origin: a contact elsewhere sees it as the same stretch about itself and the displacement of
  its centre, which the same rigid displacement takes back.
*/
static void test_rigid_displacement_takes_back_the_stretch_of_the_centre(void **state)
{
  const double X = 3e-3, Y = -2e-3;
  Case         here = NewCaseAt(0, 0), there = NewCaseAt(X, Y);

  (void)state;
  for (int k = 1; k < 3; k++) {
    SamControl   one    = Stretched(&here, 0.4 * k, -0.2 * k, 0.3 * k), other;
    const double strain = k * StrainOf(&here), e[3] = {0.4 * strain, -0.2 * strain, 0.3 * strain};
    SamStep      a, b;

    Displace(&one, SAM_COMPONENT_N, here.s.a * here.s.a / here.s.R);
    Displace(&one, SAM_COMPONENT_MX, 0);
    Displace(&one, SAM_COMPONENT_MY, 0);
    Displace(&one, SAM_COMPONENT_TX, 0);
    Displace(&one, SAM_COMPONENT_TY, 0);
    Displace(&one, SAM_COMPONENT_MZ, 0);
    other                         = one;
    other.value[SAM_COMPONENT_TX] = e[0] * X + e[2] * Y;
    other.value[SAM_COMPONENT_TY] = e[2] * X + e[1] * Y;
    a                             = Solve(&here, &one);
    b                             = Solve(&there, &other);
    AssertGood(&a);
    AssertGood(&b);
    sam_assert(Difference(SolutionOf(&there)->shear, SolutionOf(&here)->shear, NORM_2) < 1e-5);
    sam_assert_close(NumberOf(&there, "dissipated_energy"), NumberOf(&here, "dissipated_energy"),
                     1e-4 * NumberOf(&here, "dissipated_energy"));
  }
  DestroyCase(&here);
  DestroyCase(&there);
}

#define LIFT 1e-8 /* m */

/* A law that displaces the surfaces by the strain in `data` and the lift, times the time of the step. */
static PetscErrorCode Pull(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *strain,
                           PetscBool *adds)
{
  const SamStrain *e     = (const SamStrain *)law->data;
  const PetscInt   cells = law->grid->cells;
  double          *u;

  PetscFunctionBegin;
  (void)state;
  (void)strain;
  if (adds) *adds = PETSC_TRUE;
  if (u_z) PetscCall(VecShift(u_z, control->time * LIFT));
  if (!u_t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(u_t, &u));
  for (PetscInt k = 0; k < cells; k++) {
    const double x = SamGridX(law->grid, k % law->grid->nx),
                 y = SamGridY(law->grid, law->grid->row_start + k / law->grid->nx);

    u[k] += control->time * (e->xx * x + e->xy * y);
    u[k + cells] += control->time * (e->xy * x + e->yy * y);
  }
  PetscCall(VecRestoreArray(u_t, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeginPull(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  static PetscReal before;

  (void)state;
  sam_assert(duration == (control->time > 1 ? control->time - before : 0)); /* 0 in the first step */
  before = control->time;
  law->revision++;
  return PETSC_SUCCESS;
}

static PetscErrorCode CreatePull(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(PetscNew((SamStrain **)&law->data));
  law->displaces    = PETSC_TRUE;
  law->ops.begin    = BeginPull;
  law->ops.displace = Pull;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A law's displacement that is linear along the surface is a strain; a uniform one normal to it is an approach. At mid
  step the first guess of the slip's direction would follow from what is prescribed, of which only the strain is a part.
*/
static void test_displacement_by_a_law_is_that_of_the_bodies(void **state)
{
  (void)state;
  sam_call(SamLawRegister("pull", CreatePull));
  for (int kind = 0; kind < 2; kind++) {
    Case one = NewCase(kind ? Dissimilar() : Steel(), 45, 1.5, MU, "-slip_direction end"),
         two = NewCase(kind ? Dissimilar() : Steel(), 45, 1.5, MU, "-slip_direction end");
    SamLaw law;

    sam_call(SamProblemAddLawOfType(two.problem, "pull", &law));
    for (int k = 1; k < 4; k++) {
      const double time  = k < 3 ? k : 1.5;
      SamControl   given = Loads(&one, 1, 0.1 * k, 0, 0), bulk = given;
      SamStep      a, b;

      SetStretch(&one, &bulk, time * StrainOf(&one), -0.5 * time * StrainOf(&one), 0.3 * time * StrainOf(&one));
      given.time = bulk.time = time;
      if (k == 1) sam_call(SamProblemDisplace(one.problem, NULL, &bulk, NULL, NULL, (SamStrain *)law->data, NULL));
      a = Solve(&one, &bulk);
      b = Solve(&two, &given);
      AssertGood(&a);
      AssertGood(&b);
      sam_assert(Difference(SolutionOf(&two)->pressure, SolutionOf(&one)->pressure, NORM_2) < 1e-6);
      sam_assert(Difference(SolutionOf(&two)->shear, SolutionOf(&one)->shear, NORM_2) < 1e-4);
      sam_assert_close(b.rigid[SAM_COMPONENT_N], a.rigid[SAM_COMPONENT_N] + time * LIFT,
                       1e-6 * a.rigid[SAM_COMPONENT_N]);
      sam_assert_close(NumberOf(&two, "dissipated_energy"), NumberOf(&one, "dissipated_energy"),
                       1e-3 * NumberOf(&one, "dissipated_energy"));
      sam_assert(isnan(NumberOf(&two, "stored_energy")) && !isnan(NumberOf(&one, "stored_energy")));
    }
    DestroyCase(&one);
    DestroyCase(&two);
  }
}

/* Without a change of strain nothing slips. */
static void test_stretch_that_stays_dissipates_nothing(void **state)
{
  Case             c       = NewCase(Steel(), 45, 1.5, MU, "");
  const SamControl control = Stretched(&c, 1, 0.2, 0.1), back = Loads(&c, 1, 0, 0, 0);
  double           work[3];

  (void)state;
  for (int k = 0; k < 3; k++) {
    const SamStep step = Solve(&c, k < 2 ? &control : &back);

    AssertGood(&step);
    work[k] = NumberOf(&c, "dissipated_energy");
  }
  sam_assert(work[0] > 0 && work[2] > 0);
  sam_assert_close(work[1], 0, 1e-5 * work[0]);
  DestroyCase(&c);
}

static void test_restart_keeps_the_stretch(void **state)
{
  static const char   filename[] = "test_stretch.h5";
  Case                one = NewCase(Steel(), 45, 1.5, MU, ""), other = NewCase(Steel(), 45, 1.5, MU, "");
  const SamControl    first = Stretched(&one, 1, 0.2, 0.1), next = Stretched(&one, 1.2, 0.1, 0.1);
  const SamParameters none = {.count = 0};
  SamCheckpoint       files;
  SamStep             a, b;

  (void)state;
  (void)Solve(&one, &first);
  sam_call(SamCheckpointCreate(one.s.grid, filename, &files));
  sam_call(SamCheckpointWrite(files, one.contact, &(SamCheckpointRest){.parameters = &none}));
  sam_call(SamCheckpointDestroy(&files));
  sam_call(SamCheckpointRead(filename, other.contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &none}));
  AssertSameFields(&one, &other);
  a = Solve(&one, &next);
  b = Solve(&other, &next);
  AssertGood(&a);
  AssertSameSteps(&one, &a, &other, &b);
  AssertSameFields(&one, &other);
  RemoveFile(filename);
  DestroyCase(&one);
  DestroyCase(&other);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_stretch_has_the_symmetry_of_its_strain),
    cmocka_unit_test(test_shear_strain_exchanges_x_and_y),
    cmocka_unit_test(test_tension_moves_the_stick_zone),
    cmocka_unit_test(test_slip_is_displacement_and_stretch_less_rigid),
    cmocka_unit_test(test_rigid_displacement_takes_back_the_stretch_of_the_centre),
    cmocka_unit_test(test_displacement_by_a_law_is_that_of_the_bodies),
    cmocka_unit_test(test_stretch_that_stays_dissipates_nothing),
    cmocka_unit_test(test_restart_keeps_the_stretch),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

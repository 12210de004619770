/*
  The stress and the displacement by an eigenstrain in layers: against amplitudes of waves, Hankel integrals and closed
  forms, symmetric, and the same on any number of ranks.
*/
#include "elasticities.h"

#include "../../src/laws/plastic/images.h"
#include "../../src/bodies/layered/layered.h"

#define MU 1.0
#define NU 0.3

/* Body 2 is of shear modulus 1. */
static SamElasticity NewBodies(SamGrid grid, SamElasticityType type)
{
  SamElasticity e = NewCompliance(grid, NewPair(3, 0.2, 2 * MU * (1 + NU), NU));

  sam_call(SamElasticitySetType(e, type));
  return e;
}

static void Apply(SamResidual r, Vec e, Vec s, Vec u)
{
  const double *from;
  double       *to, *at, *shift[3];
  PetscInt      n;

  sam_call(VecGetArrayRead(e, &from));
  sam_call(VecGetArray(s, &to));
  sam_call(VecGetArray(u, &at));
  sam_call(VecGetLocalSize(u, &n));
  for (int c = 0; c < 3; c++) shift[c] = at + c * (n / 3);
  sam_call(SamResidualBegin(1, &r, from, PARTS, shift));
  sam_call(SamResidualEnd(1, &r, NULL, to));
  sam_call(VecRestoreArray(u, &at));
  sam_call(VecRestoreArray(s, &to));
  sam_call(VecRestoreArrayRead(e, &from));
}

static void Load(SamResidual r, Vec q, Vec s)
{
  const double *from, *traction[3];
  double       *to;
  PetscInt      n;

  sam_call(VecGetArrayRead(q, &from));
  sam_call(VecGetArray(s, &to));
  sam_call(VecGetLocalSize(q, &n));
  for (int c = 0; c < 3; c++) traction[c] = from + ((c + 2) % 3) * (n / 3); /* p last, as u_z */
  SamResidualBeginWithout(1, &r);
  sam_call(SamResidualEnd(1, &r, traction, to));
  sam_call(VecRestoreArray(s, &to));
  sam_call(VecRestoreArrayRead(q, &from));
}

static double CosineOf(double x, double y, const void *context)
{
  const double *k = (const double *)context;

  return cos(k[0] * x + k[1] * y);
}

static double SineOf(double x, double y, const void *context)
{
  const double *k = (const double *)context;

  return sin(k[0] * x + k[1] * y);
}

/* A plane of a field of many. */
static void SetPlane(SamGrid grid, PetscInt plane, Vec from, Vec to)
{
  const double *a;
  double       *b;

  sam_call(VecGetArrayRead(from, &a));
  sam_call(VecGetArray(to, &b));
  memcpy(b + plane * grid->cells, a, sizeof(*a) * (size_t)grid->cells);
  sam_call(VecRestoreArray(to, &b));
  sam_call(VecRestoreArrayRead(from, &a));
}

static double PlaneDot(SamGrid grid, PetscInt planes, PetscInt plane, Vec field, Vec with)
{
  Vec    all = NewField(grid, planes);
  double dot;

  SetPlane(grid, plane, with, all);
  dot = Dot(all, field);
  sam_call(VecDestroy(&all));
  return dot;
}

/* ---- waves ---- */

/* Amplitudes by cos 2x in the second layer; those of xz, u_x and, for e_xz, the others are of -sin 2x. */
static const struct {
  int    component;
  double s[3][6], u[3];
} amplitudes[] = {{SAM_STRESS_XX,
                   {{0.70190100874, 0.20914989025, -0.0047347079018, 0, -0.070712733231, 0},
                    {-2.1972540531, -0.66327853345, -0.013674391763, 0, 0.077825530894, 0},
                    {0.44792055588, 0.14859986089, 0.047412313739, 0, 0.20025412107, 0}},
                   {-0.12639628742, 0, -0.052190933899}},
                  {SAM_STRESS_ZZ,
                   {{0.0721289981, 0.021441227756, -0.00065823891338, 0, -0.0089835025104, 0},
                    {-0.013674391763, -0.0050722839993, -0.0032332215685, 0, -0.013846704894, 0},
                    {-0.020533023981, -0.0080393920957, -0.0062649496714, 0, -0.0071340371549, 0}},
                   {-0.022014419622, 0, -0.096219773143}},
                  {SAM_STRESS_XZ,
                   {{-0.62977201064, -0.18770866249, 0.0040764689885, 0, -0.06172923072, 0},
                    {-0.15565106179, -0.0383872956, 0.027693409788, 0, -0.15865771145, 0},
                    {0.26431204424, 0.099478619792, 0.067283355071, 0, -0.098514344583, 0}},
                   {-0.1043818678, 0, -0.044028839244}}};

static void test_waves_have_reference_amplitudes(void **state)
{
  const PetscReal h[3]    = {0.1, 0.1, 0.2};
  const double    k[2]    = {2, 0};
  SamGrid         grid    = NewGrid(8, 6, PETSC_PI, 1);
  SamElasticity   b       = NewBodies(grid, SAM_ELASTICITY_PERIODIC);
  Vec             wave[2] = {NewFrom(grid, CosineOf, k), NewFrom(grid, SineOf, k)};
  SamResidual     r;

  (void)state;
  sam_call(SamResidualCreate(b, 2, 3, h, PETSC_TRUE, &r));
  for (size_t n = 0; n < sizeof(amplitudes) / sizeof(amplitudes[0]); n++) {
    const int shear = amplitudes[n].component == SAM_STRESS_XZ;
    Vec       e = NewField(grid, 18), s = NewField(grid, 18), u = NewField(grid, 3);

    SetPlane(grid, 6 + amplitudes[n].component, wave[0], e);
    Apply(r, e, s, u);
    for (int l = 0; l < 3; l++)
      for (int c = 0; c < 6; c++) {
        const int turned = shear != (c == SAM_STRESS_XZ);

        sam_assert_close(PlaneDot(grid, 18, 6 * l + c, s, wave[turned]) / 24, (turned ? -1 : 1) * amplitudes[n].s[l][c],
                         1e-10);
      }
    for (int c = 0; c < 3; c++) {
      const int turned = shear != (c == 0);

      sam_assert_close(PlaneDot(grid, 3, c, u, wave[turned]) / 24, (turned ? -1 : 1) * amplitudes[n].u[c], 1e-10);
    }
    sam_destroy(&e, &s, &u);
  }
  sam_destroy(&wave[0], &wave[1]);
  sam_call(SamResidualDestroy(&r));
  sam_call(SamElasticityDestroy(&b));
  sam_call(SamGridDestroy(&grid));
}

/* A uniform eigenstrain along the surface stresses its layer alone; one across it lifts the surface. */
static void test_uniform_layers(void **state)
{
  const PetscReal h[2] = {0.1, 0.3};
  SamGrid         grid = NewGrid(5, 4, 1, 1);
  SamElasticity   b    = NewBodies(grid, SAM_ELASTICITY_PERIODIC);
  Vec             one = NewField(grid, 1), e = NewField(grid, 12), s = NewField(grid, 12), u = NewField(grid, 3);
  SamResidual     r;

  (void)state;
  sam_call(SamResidualCreate(b, 2, 2, h, PETSC_TRUE, &r));
  sam_call(VecSet(one, 1));
  SetPlane(grid, 6 + SAM_STRESS_XX, one, e);
  Apply(r, e, s, u);
  for (int c = 0; c < 12; c++)
    sam_assert_close(PlaneDot(grid, 12, c, s, one) / 20,
                     c == 6   ? -2 * MU / (1 - NU)
                     : c == 7 ? -2 * MU * NU / (1 - NU)
                              : 0,
                     1e-14);
  sam_assert_close(PlaneDot(grid, 3, 2, u, one) / 20, -0.3 * NU / (1 - NU), 1e-14);
  sam_call(VecSet(e, 0));
  SetPlane(grid, SAM_STRESS_ZZ, one, e);
  Apply(r, e, s, u);
  sam_assert_close(Norm(s, NORM_INFINITY), 0, 1e-14);
  sam_assert_close(PlaneDot(grid, 3, 2, u, one) / 20, -0.1, 1e-14);
  sam_destroy(&one, &e, &s, &u);
  sam_call(SamResidualDestroy(&r));
  sam_call(SamElasticityDestroy(&b));
  sam_call(SamGridDestroy(&grid));
}

/* ---- symmetry ---- */

/* Multiplies by the thickness of the layers, and shear strains by two. */
static void Weigh(SamGrid grid, int layers, const PetscReal h[], Vec e)
{
  double *a;

  sam_call(VecGetArray(e, &a));
  for (PetscInt k = 0; k < 6 * layers * grid->cells; k++)
    a[k] *= h[k / (6 * grid->cells)] * (k / grid->cells % 6 > SAM_STRESS_ZZ ? 2 : 1);
  sam_call(VecRestoreArray(e, &a));
}

static void AssertSymmetric(SamElasticityType type, PetscInt rows, PetscInt body)
{
  const PetscReal h[3] = {0.1, 0.15, 0.3};
  SamGrid         grid = NewGrid(9, rows, 1, 0.9);
  SamElasticity   b    = NewBodies(grid, type);
  Vec e = NewRandom(grid, 18, 1), f = NewRandom(grid, 18, 2), q = NewRandom(grid, 3, 3), s = NewField(grid, 18),
      t = NewField(grid, 18), u = NewField(grid, 3);
  SamResidual r;
  double      size;

  sam_call(SamResidualCreate(b, body, 3, h, PETSC_TRUE, &r));
  Apply(r, f, t, u);
  Apply(r, e, s, u);
  Weigh(grid, 3, h, f);
  size = Norm(f, NORM_2) * Norm(s, NORM_2);
  sam_assert(Dot(e, f) != 0);
  {
    const double one = Dot(f, s);

    Weigh(grid, 3, h, e);
    sam_assert_close(one, Dot(e, t), 1e-14 * size);
  }
  Load(r, q, s);
  sam_assert_close(Dot(e, s), Dot(q, u), 1e-14 * Norm(e, NORM_2) * Norm(s, NORM_2));
  sam_assert(fabs(Dot(q, u)) > 1e-4);
  sam_destroy(&e, &f, &q, &s, &t, &u);
  sam_call(SamResidualDestroy(&r));
  sam_call(SamElasticityDestroy(&b));
  sam_call(SamGridDestroy(&grid));
}

static void test_operators_are_symmetric(void **state)
{
  (void)state;
  for (PetscInt body = 1; body <= 2; body++) {
    AssertSymmetric(SAM_ELASTICITY_PERIODIC, 8, body);
    AssertSymmetric(SAM_ELASTICITY_HALFSPACE, 8, body);
    AssertSymmetric(SAM_ELASTICITY_PLANE, 1, body);
  }
}

/* ---- half-spaces ---- */

static void test_nucleus_has_reference_stress(void **state)
{
  static const double between[2]    = {0.7, -0.4},
                      expected[][7] = {{SAM_STRESS_XX, 0.14925478819, 0.055939936171, -0.044091448569, 0.10930692895,
                                        0.12906712861, -0.15670092811},
                                       {SAM_STRESS_ZZ, -0.055988326108, 0.096038274651, 0.13783034223, 0.12899226731,
                                        0.15656006255, -0.089462892888},
                                       {SAM_STRESS_XZ, 0.17091596904, -0.11915914723, -0.075049594466, -0.30982555144,
                                        -0.33521556908, 0.30825985059}};
  double s[36];

  (void)state;
  SamNucleus(between, 0.25, 0.9, MU, NU, s);
  for (int n = 0; n < 3; n++)
    for (int c = 0; c < 6; c++) sam_assert_close(s[6 * c + (int)expected[n][0]], expected[n][c + 1], 1e-11);
}

static double BellOf(double x, double y, const void *context)
{
  (void)context;
  return exp(-(x * x + y * y) / 0.08);
}

/* Asserts the stress in the fourth layer by a Gaussian in the second one, in a cell; expected: the component of the
   strain, and the stress by it. */
static void AssertStress(SamElasticityType type, SamGrid grid, PetscInt i, PetscInt j, int count,
                         const double expected[][7])
{
  const PetscReal h[4] = {0.1, 0.1, 0.1, 0.1};
  SamElasticity   b    = NewBodies(grid, type);
  Vec             bell = NewFrom(grid, BellOf, NULL), at = NewField(grid, 1);
  SamResidual     r;

  sam_call(SamResidualCreate(b, 2, 4, h, PETSC_TRUE, &r));
  AddAt(grid, 0, i, j, 1, at);
  for (int n = 0; n < count; n++) {
    Vec e = NewField(grid, 24), s = NewField(grid, 24), u = NewField(grid, 3);

    SetPlane(grid, 6 + (PetscInt)expected[n][0], bell, e);
    Apply(r, e, s, u);
    for (int c = 0; c < 6; c++) {
      if (getenv("SAM_SHOW")) print_message("# %.10f %.10f\n", PlaneDot(grid, 24, 18 + c, s, at), expected[n][c + 1]);
      sam_assert_close(PlaneDot(grid, 24, 18 + c, s, at), expected[n][c + 1], 1.5e-6);
    }
    sam_destroy(&e, &s, &u);
  }
  sam_destroy(&bell, &at);
  sam_call(SamResidualDestroy(&r));
  sam_call(SamElasticityDestroy(&b));
  sam_call(SamGridDestroy(&grid));
}

/* At (0.15, 0.1), by cells with their centre there. */
static void test_half_space_has_reference_stress(void **state)
{
  static const double expected[][7] = {{SAM_STRESS_XX, 0.12017021472, 0.034940988292, 0.021526568346, -0.005247477715,
                                        -0.036862316792, -0.0015730785622},
                                       {SAM_STRESS_ZZ, -0.0185524886, -0.014585083899, -0.057615056146,
                                        -0.0047608856406, -0.024629023266, -0.016419348844},
                                       {SAM_STRESS_XY, -0.013273441173, -0.012211776717, -0.016004904682,
                                        0.088328127178, -0.028986725032, -0.038492649437}};

  (void)state;
  AssertStress(SAM_ELASTICITY_HALFSPACE, NewGridOn(PETSC_COMM_WORLD, 40, 40, 2, 2, 0.025, 0.025), 22, 21, 3, expected);
}

/* In plane strain, at x = 0.15. */
static void test_plane_has_reference_stress(void **state)
{
  static const double expected[][7] = {{SAM_STRESS_XX, 0.224803103, 0.08112454165, 0.04561203584, 0, -0.04365772005, 0},
                                       {SAM_STRESS_ZZ, -0.01515929707, -0.01279692906, -0.02749713315, 0,
                                        -0.02309058016, 0}};

  (void)state;
  AssertStress(SAM_ELASTICITY_PLANE, NewGridOn(PETSC_COMM_WORLD, 40, 1, 2, 1, 0.025, 0), 22, 0, 2, expected);
}

/* ---- below layers of other materials ---- */

/* The stiffness of the layers of a body at the wave numbers k. */
static void SetHold(SamBody body, PetscInt n, const double k[], double hold[4][8])
{
  for (PetscInt m = 0; m < n; m++) {
    double s[4];

    SamBodyInterfaceStiffness(body, k[m], s);
    for (int c = 0; c < 4; c++) hold[c][m] = s[c];
  }
}

/*
  Amplitudes of the mean stress in layers of 0.15, 0.1 and 0.2 by e in the second one, cos 2x (of xz and yz sin 2x), in
  a substrate of shear modulus 1 below layers of E = 6, nu = 0.2, 0.1 thick, and E = 0.5, nu = 0.4, 0.2 thick. By finite
  elements of three nodes along z, 8 and 16 a layer, whose results differ by 2e-6.
*/
static const struct {
  PetscInt component;
  double   s[3][6];
} below[] = {
  {SAM_STRESS_XX,
   {{0.4652207, 0.1258296, -0.0457889, 0, 0.1384298, 0},
    {-2.3621795, -0.7312376, -0.0752793, 0, -0.0261654, 0},
    {0.3495875, 0.0980026, -0.0229122, 0, -0.1862500, 0}}},
  {SAM_STRESS_ZZ,
   {{0.0051539, -0.0055670, -0.0237106, 0, 0.0390777, 0},
    {-0.0752793, -0.0324394, -0.0328519, 0, 0.0298399, 0},
    {-0.0565502, -0.0284149, -0.0381661, 0, 0.0091921, 0}}},
  {SAM_STRESS_XY,
   {{0, 0, 0, 0.2227454, 0, 0.0904659}, {0, 0, 0, -1.7612899, 0, -0.0514026}, {0, 0, 0, 0.1876726, 0, -0.1876727}}},
  {SAM_STRESS_XZ,
   {{-0.4600670, -0.1313966, 0.0220783, 0, -0.0993522, 0},
    {-0.0523308, 0.0022047, 0.0596797, 0, -0.1943248, 0},
    {0.3266277, 0.1297004, 0.1057069, 0, -0.1104606, 0}}},
  {SAM_STRESS_YZ,
   {{0, 0, 0, -0.2227454, 0, -0.0904659}, {0, 0, 0, -0.0514026, 0, -0.1359049}, {0, 0, 0, 0.1111315, 0, -0.1111315}}}};

static void test_waves_below_layers_have_amplitudes_of_finite_elements(void **state)
{
  static const PetscReal h[]        = {0.15, 0.1, 0.2};
  const SamMaterial      material[] = {{6, 0.2, 0.1}, {0.5, 0.4, 0.2}, {2 * MU * (1 + NU), NU, PETSC_INFINITY}};
  const SamWaveBody      of         = {3, h, MU, NU};
  const double           k[] = {2}, ky[] = {0};
  double                 hold[4][8];
  const SamWaveHold      stiffness = {hold[0], hold[1], hold[2], hold[3]};
  SamBody                body;

  (void)state;
  sam_call(SamBodyCreate(3, material, &body));
  SetHold(body, 1, k, hold);
  for (size_t n = 0; n < sizeof(below) / sizeof(below[0]); n++) {
    double complex value[18] = {0}, *planes[18];

    for (int c = 0; c < 18; c++) planes[c] = &value[c];
    value[6 + below[n].component] = below[n].component > SAM_STRESS_XY ? -I : 1;
    sam_call(SamWavesApply(&of, 1, 2, ky, planes, PETSC_TRUE, NULL, &stiffness));
    for (int c = 0; c < 18; c++) {
      const double complex expected = (c % 6 > SAM_STRESS_XY ? -I : 1) * below[n].s[c / 6][c % 6];

      sam_assert_close(cabs(value[c] - expected), 0, 1e-6);
    }
  }
  sam_call(SamBodyDestroy(&body));
}

/* Layers of the substrate's own material change nothing, in waves of any direction and length. */
static void test_layers_of_the_same_material_change_nothing(void **state)
{
  static const PetscReal h[]        = {0.3, 0.15, 0.1, 0.2};
  const SamMaterial      same       = {2 * MU * (1 + NU), NU, 0.1};
  const SamMaterial      material[] = {same, {same.young, NU, 0.2}, {same.young, NU, PETSC_INFINITY}};
  const SamWaveBody      whole = {4, h, MU, NU}, of = {3, h + 1, MU, NU};
  const double           ky[8] = {0, 0.01, -0.9, 2, -3.3, 5, 17, 80};
  double                 hold[4][8], k[8];
  const SamWaveHold      stiffness       = {hold[0], hold[1], hold[2], hold[3]};
  double complex         value[2][24][8] = {{{0}}}, *planes[2][24];
  SamBody                body;

  (void)state;
  sam_call(SamBodyCreate(3, material, &body));
  for (int m = 0; m < 8; m++) k[m] = hypot(0.4, ky[m]);
  SetHold(body, 8, k, hold);
  for (int c = 0; c < 24; c++)
    for (int m = 0; m < 8; m++) {
      planes[0][c]   = value[0][c];
      planes[1][c]   = value[1][c];
      value[0][c][m] = c < 6 ? 0 : sin(1 + 3 * c + m) + I * cos(2 * c - 0.3 * m);
      value[1][c][m] = value[0][c][m];
    }
  sam_call(SamWavesApply(&whole, 8, 0.4, ky, planes[0], PETSC_TRUE, NULL, NULL));
  sam_call(SamWavesApply(&of, 8, 0.4, ky, planes[1] + 6, PETSC_TRUE, NULL, &stiffness));
  for (int c = 6; c < 24; c++)
    for (int m = 0; m < 8; m++) sam_assert_close(cabs(value[0][c][m] - value[1][c][m]), 0, 1e-10);
  sam_call(SamBodyDestroy(&body));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_waves_have_reference_amplitudes),
    cmocka_unit_test(test_uniform_layers),
    cmocka_unit_test(test_operators_are_symmetric),
    cmocka_unit_test(test_nucleus_has_reference_stress),
    cmocka_unit_test(test_half_space_has_reference_stress),
    cmocka_unit_test(test_plane_has_reference_stress),
    cmocka_unit_test(test_waves_below_layers_have_amplitudes_of_finite_elements),
    cmocka_unit_test(test_layers_of_the_same_material_change_nothing),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

/*
  Stresses in layered bodies: under a disc and in Hertz's contact against reference numbers, of integrals with many
  digits; layers cut in two, layers of the substrate's material; continuity and jumps at interfaces; the surface.
*/
#include "fields.h"

#include "../../src/bodies/layered/layered.h"
#include <petsam/private/stressimpl.h>

enum { COMPONENTS = SAM_STRESS_COMPONENTS, GROUP = SAM_STRESS_GROUP, LAGS = 40 };

/* A body with layers: modulus, Poisson's ratio, thickness of each, the substrate last. */
static SamBody BodyOf(int count, const double layer[][3])
{
  SamMaterial material[3] = {{0}};
  SamBody     body;

  for (int n = 0; n <= count; n++) material[n] = (SamMaterial){layer[n][0], layer[n][1], layer[n][2]};
  sam_call(SamBodyCreate(count + 1, material, &body));
  return body;
}

static const double hard[][3] = {{4, 0.25, 1}, {1, 0.3, 0}}, soft[][3] = {{0.1, 0.45, 1}, {1, 0.3, 0}},
                    two[][3] = {{4, 0.2, 0.5}, {0.25, 0.4, 1}, {1, 0.3, 0}}, thin[][3] = {{4, 0.25, 0.5}, {1, 0.3, 0}},
                    cut[][3] = {{4, 0.25, 0.3}, {4, 0.25, 0.2}, {1, 0.3, 0}}, alike[][3] = {{1, 0.3, 0.4}, {1, 0.3, 0}};

/* ---- a disc under pressure ---- */

/*
  s_rr, s_tt, s_zz at (r, z) under a uniform pressure on a disc of radius 1, by Gauss' rule over the wave number; in the
  first layer on the axis only, where the half-space's are known (Johnson 1985, section 3.4).
*/
static void Disc(SamBody body, PetscInt layer, double z, double r, double stress[3])
{
  static const double point[]  = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640},
                      weight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                  0.2369268850561891};
  const double step = 0.1, last = 80, root = sqrt(1 + z * z), nu = body->material[0].poisson;
  double       s[SAM_WAVE_STRESSES], sum[3] = {0, 0, 0};

  for (int m = 0; m < last / step; m++)
    for (int g = 0; g < 5; g++) {
      const double k = (m + 0.5 + point[g] / 2) * step, w = j1(k) * weight[g] * step / 2, x = k * r;

      SamBodyStresses(body, layer, z, k, s);
      sum[0] += w * s[0] * j0(x);
      sum[1] += w * s[2] * j0(x);
      sum[2] += w * s[3] * jn(2, x);
    }
  if (layer == 0) {
    sum[0] -= 1 - pow(z / root, 3);
    sum[1] -= 0.5 + nu - (1 + nu) * z / root + pow(z / root, 3) / 2;
  }
  stress[0] = sum[1] - sum[2];
  stress[1] = sum[1] + sum[2];
  stress[2] = sum[0];
}

static void test_disc_has_reference_stresses(void **state)
{
  static const struct {
    const double (*body)[3];
    int    count, layer;
    double z, r, expected[3]; /* z below the layer's top */
  } rows[] = {{hard, 1, 0, 0.5, 0, {-0.21842722707, -0.21842722707, -0.79817385991}},
              {hard, 1, 0, 1, 0, {0.53375865773, 0.53375865773, -0.45467737443}},
              {hard, 1, 1, 0, 0, {-0.011294468717, -0.011294468717, -0.45467737443}},
              {soft, 1, 1, 0, 0.8, {-0.094060730995, -0.024391211954, -0.50831826235}},
              {two, 2, 0, 0.5, 0, {1.9379969712, 1.9379969712, -0.65077979608}},
              {two, 2, 2, 0.5, 0.8, {-0.02578927114, -0.011187343142, -0.23906394705}}};

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(rows[0]); k++) {
    const SamBody body = BodyOf(rows[k].count, rows[k].body);
    double        stress[3];

    Disc(body, rows[k].layer, rows[k].z, rows[k].r, stress);
    if (getenv("SAM_SHOW"))
      for (int c = 0; c < 3; c++) print_message("# %.10f %.10f\n", stress[c], rows[k].expected[c]);
    for (int c = 0; c < 3; c++) sam_assert_close(stress[c], rows[k].expected[c], 1e-9);
  }
}

/* ---- rows of kernels ---- */

static SamStress NewStress(SamGrid grid, SamBody body)
{
  SamStress stress;

  sam_call(SamLayeredCreateStress(grid, NULL, 2, body, &stress));
  return stress;
}

/* All kernels at LAGS lags in rows j = 0, 1, 7. */
typedef double Rows[SAM_STRESS_GROUPS][3][GROUP][LAGS];

static void GetRows(SamStress stress, double depth, Rows rows)
{
  static const PetscInt lines[] = {0, 1, 7};

  sam_call(SamStressUseDepth(stress, depth));
  for (int g = 0; g < SAM_STRESS_GROUPS; g++)
    for (int l = 0; l < 3; l++)
      (*stress->ops.row)(stress, (const double[]){0.11, 0.08}, depth, (SamStressGroup)g, lines[l], LAGS,
                         (double *[]){rows[g][l][0], rows[g][l][1], rows[g][l][2]});
}

/* The largest difference of a group's kernels. */
static double DifferenceOf(Rows a, Rows b, int g)
{
  double most = 0;

  for (int l = 0; l < 3; l++)
    for (int k = 0; k < GROUP; k++)
      for (int i = 0; i < LAGS; i++) most = fmax(most, fabs(a[g][l][k][i] - b[g][l][k][i]));
  return most;
}

static void AssertSameRows(SamBody a, SamBody b, double depth, double tolerance)
{
  static Rows rows[2];
  SamGrid     grid = NewGrid(37, 23, 5, 4);
  SamStress   one = NewStress(grid, a), other = NewStress(grid, b);

  GetRows(one, depth, rows[0]);
  GetRows(other, depth, rows[1]);
  for (int g = 0; g < SAM_STRESS_GROUPS; g++) {
    if (getenv("SAM_SHOW")) print_message("# group %d: %.1e\n", g, DifferenceOf(rows[0], rows[1], g));
    sam_assert(DifferenceOf(rows[0], rows[1], g) < tolerance);
  }
  sam_call(SamStressDestroy(&one));
  sam_call(SamStressDestroy(&other));
  sam_call(SamGridDestroy(&grid));
}

/* In the lower part the functions are the whole stresses, in the whole layer they are added to closed forms. */
static void test_layer_cut_in_two_is_one(void **state)
{
  const SamBody one = BodyOf(1, thin), parts = BodyOf(2, cut);

  (void)state;
  AssertSameRows(one, parts, 0.31, 1e-12);
  AssertSameRows(one, parts, 0.5, 1e-12);
  AssertSameRows(one, parts, 0.12, 1e-12);
  AssertSameRows(one, parts, 0.7, 1e-12);
}

/* Of the substrate's material, the layer is no layer: closed forms, with their values at centres. */
static void test_layer_of_the_substrates_material_is_none(void **state)
{
  static Rows   rows;
  const SamBody body   = BodyOf(1, alike);
  SamGrid       grid   = NewGrid(37, 23, 5, 4);
  SamStress     stress = NewStress(grid, body);

  (void)state;
  for (double depth = 0.1; depth < 1; depth += 0.41) {
    const SamHalfSpaceSource source = {{0.11, 0.08}, depth, 0.3};
    static double            exact[GROUP][LAGS];

    GetRows(stress, depth, rows);
    for (int g = 0; g < SAM_STRESS_NORMAL_Z; g++)
      for (int l = 0; l < 2; l++) {
        double most = 0;

        SamHalfSpaceStressRow(&source, (SamStressGroup)g, l, LAGS, (double *[]){exact[0], exact[1], exact[2]});
        for (int k = 0; k < GROUP; k++)
          for (int i = 0; i < LAGS; i++) most = fmax(most, fabs(rows[g][l][k][i] - exact[k][i]));
        if (getenv("SAM_SHOW")) print_message("# depth %g group %d row %d: %.1e\n", depth, g, l, most);
        sam_assert(most < 1e-12);
      }
  }
  sam_call(SamStressDestroy(&stress));
  sam_call(SamGridDestroy(&grid));
}

/* ---- fields ---- */

/* Hertz's pressure and 0.3 of it as shear along x, on 241 x 241 cells of 0.01. */
static Vec NewHertz(SamGrid grid)
{
  Vec     field = NewField(grid, COMPONENTS);
  double *s;

  sam_call(VecGetArray(field, &s));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const double   x = (double)SamGridX(grid, i), y = (double)SamGridY(grid, grid->row_start + j);
      const double   p = sqrt(fmax(1 - x * x - y * y, 0));
      const PetscInt k = j * grid->nx + i;

      s[SAM_STRESS_ZZ * grid->cells + k] = p;
      s[SAM_STRESS_XZ * grid->cells + k] = 0.3 * p;
    }
  sam_call(VecRestoreArray(field, &s));
  return field;
}

static void test_sliding_has_reference_stresses(void **state)
{
  static const struct {
    int    i, j;
    double z, stress[COMPONENTS]; /* xx yy zz xy xz yz */
  } rows[] = {
    {30, 20, 0.25, {-0.4416382258, -0.3473601862, -0.8154782498, -0.0297038391, -0.2427627972, -0.0895965173}},
    {30, 20, 0.5, {0.3843873174, 0.4609366747, -0.6147015752, -0.0428066056, -0.1126825785, -0.0587985443}},
    {-100, 0, 0.5, {-0.0641674889, 0.1378583317, -0.1993715839, 0, 0.1322900517, 0}}};
  const SamBody body   = BodyOf(1, thin);
  SamGrid       grid   = NewGrid(241, 241, 2.41, 2.41);
  SamStress     stress = NewStress(grid, body);

  (void)state;
  for (size_t k = 0; k < sizeof(rows) / sizeof(rows[0]); k++) {
    Vec field = NewHertz(grid);

    sam_call(SamStressSetDepth(stress, rows[k].z));
    sam_call(SamStressApply(stress, field));
    for (PetscInt c = 0; c < COMPONENTS; c++) {
      const double value = At(grid, field, c, 120 + rows[k].i, 120 + rows[k].j);

      if (getenv("SAM_SHOW")) print_message("# %.8f %.8f\n", value, rows[k].stress[c]);
      sam_assert_close(value, rows[k].stress[c], 3e-4);
    }
    sam_call(VecDestroy(&field));
  }
  sam_call(SamStressDestroy(&stress));
  sam_call(SamGridDestroy(&grid));
}

/* Tractions are continuous through an interface, the others jump by the strains, which are continuous in the plane. */
static void test_interfaces_transmit_tractions_and_strains(void **state)
{
  const SamBody body   = BodyOf(2, two);
  const double  bottom = 0.5, E[] = {4, 0.25}, nu[] = {0.2, 0.4};
  SamGrid       grid             = NewGrid(37, 23, 3.7, 2.3);
  SamStress     stress           = NewStress(grid, body);
  double        most[COMPONENTS] = {0}, strain[2][3];

  (void)state;
  for (PetscInt i = 3; i < 37; i += 7) {
    double s[2][COMPONENTS];

    for (int side = 0; side < 2; side++) {
      Vec field = NewHertz(grid);

      sam_call(SamStressSetDepth(stress, side ? nextafter(bottom, 1) : bottom));
      sam_call(SamStressApply(stress, field));
      for (PetscInt c = 0; c < COMPONENTS; c++) s[side][c] = At(grid, field, c, i, 9);
      sam_call(VecDestroy(&field));
      strain[side][0] = (s[side][0] - nu[side] * (s[side][1] + s[side][2])) / E[side];
      strain[side][1] = (s[side][1] - nu[side] * (s[side][0] + s[side][2])) / E[side];
      strain[side][2] = s[side][3] * (1 + nu[side]) / E[side];
    }
    for (int c = 0; c < 3; c++) {
      const int traction[] = {SAM_STRESS_ZZ, SAM_STRESS_XZ, SAM_STRESS_YZ};

      most[c]     = fmax(most[c], fabs(s[0][traction[c]] - s[1][traction[c]]));
      most[3 + c] = fmax(most[3 + c], fabs(strain[0][c] - strain[1][c]));
    }
  }
  for (int c = 0; c < COMPONENTS; c++) {
    if (getenv("SAM_SHOW")) print_message("# %.1e\n", most[c]);
    sam_assert(most[c] < 1e-11);
  }
  sam_call(SamStressDestroy(&stress));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_disc_has_reference_stresses),
                                     cmocka_unit_test(test_layer_cut_in_two_is_one),
                                     cmocka_unit_test(test_layer_of_the_substrates_material_is_none),
                                     cmocka_unit_test(test_sliding_has_reference_stresses),
                                     cmocka_unit_test(test_interfaces_transmit_tractions_and_strains)};

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

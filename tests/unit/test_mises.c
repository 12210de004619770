/* The return to the yield surface: paths with known ends, the yield function there, and the tangent by differences. */
#include "samtest.h"

#include "../../src/laws/plastic/mises.h"

#define SHEAR 80000.0
#define YIELD 300.0

/* Four strains after each other; the accumulated plastic strain after each, and s_xx and s_xy after the last. */
static void test_paths_have_reference_ends(void **state)
{
  static const double strain[4][PARTS] = {
    {4e-3, -2e-3, -2e-3}, {4e-3, -2e-3, -2e-3, 3e-3}, {-4e-3, 2e-3, 2e-3, 3e-3}, {-4e-3, 2e-3, 2e-3, -3e-3}};
  static const struct {
    SamMises material;
    double   p[4], stress[2];
  } paths[] = {{{.shear = SHEAR, .yield = YIELD},
                {0.00275, 0.00518272996566, 0.0115991540126, 0.0171979545597},
                {-36.07087705, -170.3648111}},
               {{.shear = SHEAR, .yield = YIELD, .hardening = {SAM_HARDENING_LINEAR, {2000}}},
                {0.00272727272727, 0.00512506983565, 0.0114308343999, 0.0168850841905},
                {-43.17766205, -189.0395256}},
               {{.shear = SHEAR, .yield = YIELD, .hardening = {SAM_HARDENING_SWIFT, {0.002, 0.15}}},
                {0.00258437714864, 0.00482390823881, 0.0107344587937, 0.0158193805225},
                {-66.02864572, -233.5603198}},
               {{.shear = SHEAR, .yield = YIELD, .backstresses = 1, .back = {{10000, 0}}},
                {0.00264, 0.00497542076704, 0.0111351878521, 0.0165100363773},
                {-60.22804197, -182.7502187}}};

  (void)state;
  for (size_t n = 0; n < sizeof(paths) / sizeof(paths[0]); n++) {
    SamMisesAt      at = {{0}, 0, {{0}}};
    SamMisesTangent t;

    for (int k = 0; k < 4; k++) {
      sam_assert(SamMisesReturn(&paths[n].material, strain[k], &at, &t));
      sam_assert_close(at.p, paths[n].p[k], 1e-13);
    }
    sam_assert_close(2 * SHEAR * (strain[3][0] - at.e[0]), paths[n].stress[0], 1e-7);
    sam_assert_close(2 * SHEAR * (strain[3][3] - at.e[3]), paths[n].stress[1], 1e-6);
  }
}

/* Armstrong and Frederick's backstress tends to C/g, where the steps of the strain are those of the plastic one. */
static void test_backstress_saturates(void **state)
{
  const SamMises  m  = {.shear = SHEAR, .yield = YIELD, .backstresses = 1, .back = {{60000, 600}}};
  SamMisesAt      at = {{0}, 0, {{0}}};
  SamMisesTangent t;
  double          d[PARTS] = {0};

  (void)state;
  for (int k = 1; k <= 60; k++) {
    d[0] = 1e-3 * k;
    d[1] = d[2] = -d[0] / 2;
    (void)SamMisesReturn(&m, d, &at, &t);
  }
  sam_assert_close(at.p, 0.0583333333333, 1e-12);
  sam_assert_close(3 * SHEAR * (d[0] - at.e[0]), 400, 1e-6);
}

/* Voce's hardening and two backstresses: the end lies on the yield surface, and elastic steps change nothing. */
static void test_tangent_is_the_derivative(void **state)
{
  const SamMises m             = {.shear        = SHEAR,
                                  .yield        = YIELD,
                                  .hardening    = {SAM_HARDENING_VOCE, {120, 80}},
                                  .backstresses = 2,
                                  .back         = {{20000, 0}, {9000, 0}}};
  const double   before[PARTS] = {5e-3, -3e-3, -2e-3, 1e-3, 2e-3, -1e-3},
               after[PARTS] = {2e-3, -4e-3, 2e-3, 3e-3, -2e-3, 1e-3}, step = 1e-8;
  SamMisesAt      start = {{0}, 0, {{0}}}, at, more;
  SamMisesTangent t, unused;
  double          stress[PARTS], d[PARTS], change[PARTS] = {0.3, -0.5, 0.2, 0.4, -0.1, 0.6};

  (void)state;
  (void)SamMisesReturn(&m, before, &start, &t);
  at = more = start;
  sam_assert(SamMisesReturn(&m, after, &at, &t));
  for (int c = 0; c < PARTS; c++) stress[c] = 2 * SHEAR * (after[c] - at.e[c]);
  sam_assert_close(SamMisesExcess(&m, &at, stress), 0, 1e-10);
  for (int c = 0; c < PARTS; c++) d[c] = after[c] + step * change[c];
  (void)SamMisesReturn(&m, d, &more, &unused);
  for (int c = 0; c < PARTS; c++) {
    const double along = SamTensorDot(t.n, change) * t.n[c];

    sam_assert_close((more.e[c] - at.e[c]) / step, t.along * along + t.across * (change[c] - along), 1e-5);
  }
  more = at;
  for (int c = 0; c < PARTS; c++) d[c] = at.e[c] + 0.99 * (after[c] - at.e[c]) + 0.01 * at.back[0][c] / SHEAR;
  sam_assert(!SamMisesReturn(&m, d, &more, &unused));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_paths_have_reference_ends),
    cmocka_unit_test(test_backstress_saturates),
    cmocka_unit_test(test_tangent_is_the_derivative),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

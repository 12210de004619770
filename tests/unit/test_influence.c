/*
  The influence integrals over a cell: stored values, symmetries, additivity, identities, scaling.
*/
#include "samtest.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include <petsam/private/halfspace.h>

typedef struct {
  double    dx, dy;    /* sides of the cell, m */
  ptrdiff_t i, j;      /* its lag */
  double    values[6]; /* R, XX, YY, XY, X, Y, m */
} Reference;

static const Reference references[] = {
#include "influence_values.txt"
};

enum { NUM_KINDS = 6, NUM_REFERENCES = sizeof(references) / sizeof(references[0]) };

/* What the header promises: 5e-15 that the bound allows for truncation, and rounding. Observed is up to 1.2e-15. */
static const double promised = 1e-14;

static const char *const names[]    = {"R", "XX", "YY", "XY", "X", "Y"};
static const double      sides[][2] = {{1, 1}, {3, 1}, {0.7e-6, 1.1e-6}, {1, 40}, {50, 1}, {1, 50}};
static const ptrdiff_t   lags[]     = {0, 1, 2, 3, 5, 11, 40, 63, 64, 65, 500, 2200, 16383};

enum { NUM_SIDES = sizeof(sides) / sizeof(sides[0]), NUM_LAGS = sizeof(lags) / sizeof(lags[0]) };

static int OddX(int kind)
{
  return kind == SAM_INTEGRAL_XY || kind == SAM_INTEGRAL_X;
}

static int OddY(int kind)
{
  return kind == SAM_INTEGRAL_XY || kind == SAM_INTEGRAL_Y;
}

/* Fails unless |value - expected| <= tolerance, and says where; a NaN fails. */
static void AssertNear(const char *what, int kind, const double side[2], const ptrdiff_t lag[2], double value,
                       double expected, double tolerance)
{
  if (fabs(value - expected) <= tolerance) return;
  fail_msg("%s: %s of %g x %g at (%td, %td) is %.17g, not %.17g (tolerance %.1e)", what, names[kind], side[0], side[1],
           lag[0], lag[1], value, expected, tolerance);
}

static void test_values_match_50_digit_arithmetic(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_REFERENCES; k++) {
    const Reference *ref     = &references[k];
    const double     side[2] = {ref->dx, ref->dy};

    for (int kind = 0; kind < NUM_KINDS; kind++) {
      const double value = SamIntegralCell((SamIntegral)kind, ref->dx, ref->dy, ref->i, ref->j);

      /* A value that is 0 must be exactly 0. */
      AssertNear("stored value", kind, side, (const ptrdiff_t[2]){ref->i, ref->j}, value, ref->values[kind],
                 promised * fabs(ref->values[kind]));
    }
  }
}

static void CheckMirrored(int kind, const double side[2], ptrdiff_t i, ptrdiff_t j)
{
  const double value  = SamIntegralCell((SamIntegral)kind, side[0], side[1], i, j);
  const double sign_x = OddX(kind) ? -1 : 1, sign_y = OddY(kind) ? -1 : 1;

  AssertNear("mirror in x", kind, side, (const ptrdiff_t[2]){-i, j},
             SamIntegralCell((SamIntegral)kind, side[0], side[1], -i, j), sign_x * value, 0);
  AssertNear("mirror in y", kind, side, (const ptrdiff_t[2]){i, -j},
             SamIntegralCell((SamIntegral)kind, side[0], side[1], i, -j), sign_y * value, 0);
  AssertNear("half turn", kind, side, (const ptrdiff_t[2]){-i, -j},
             SamIntegralCell((SamIntegral)kind, side[0], side[1], -i, -j), sign_x * sign_y * value, 0);
  if ((OddX(kind) && i == 0) || (OddY(kind) && j == 0)) {
    AssertNear("odd", kind, side, (const ptrdiff_t[2]){i, j}, value, 0, 0);
  } else {
    assert_true(value > 0 && isfinite(value));
  }
}

static void test_parity_and_zeros_are_exact(void **state)
{
  (void)state;
  for (int s = 0; s < NUM_SIDES; s++) {
    for (int a = 0; a < NUM_LAGS; a++) {
      for (int b = 0; b < NUM_LAGS; b++) {
        for (int kind = 0; kind < NUM_KINDS; kind++) CheckMirrored(kind, sides[s], lags[a], lags[b]);
      }
    }
  }
}

/* Exchanging x and y exchanges the kinds; both values keep the promise, so they differ by two of it. */
static void test_exchange_of_axes(void **state)
{
  static const SamIntegral exchanged[] = {SAM_INTEGRAL_R,  SAM_INTEGRAL_YY, SAM_INTEGRAL_XX,
                                          SAM_INTEGRAL_XY, SAM_INTEGRAL_Y,  SAM_INTEGRAL_X};

  (void)state;
  for (int s = 0; s < NUM_SIDES; s++) {
    for (int a = 0; a < NUM_LAGS; a++) {
      for (int b = 0; b < NUM_LAGS; b++) {
        for (int kind = 0; kind < NUM_KINDS; kind++) {
          const double value = SamIntegralCell((SamIntegral)kind, sides[s][0], sides[s][1], lags[a], lags[b]);
          const double other = SamIntegralCell(exchanged[kind], sides[s][1], sides[s][0], lags[b], lags[a]);

          AssertNear("exchange", kind, sides[s], (const ptrdiff_t[2]){lags[a], lags[b]}, value, other,
                     2 * promised * fabs(value));
        }
      }
    }
  }
}

/* x^2/r^3 + y^2/r^3 = 1/r. All terms are positive, so the sum keeps the promise. */
static void test_xx_and_yy_add_up_to_r(void **state)
{
  (void)state;
  for (int s = 0; s < NUM_SIDES; s++) {
    for (int a = 0; a < NUM_LAGS; a++) {
      for (int b = 0; b < NUM_LAGS; b++) {
        const double xx = SamIntegralCell(SAM_INTEGRAL_XX, sides[s][0], sides[s][1], lags[a], lags[b]);
        const double yy = SamIntegralCell(SAM_INTEGRAL_YY, sides[s][0], sides[s][1], lags[a], lags[b]);
        const double r  = SamIntegralCell(SAM_INTEGRAL_R, sides[s][0], sides[s][1], lags[a], lags[b]);

        AssertNear("XX + YY", SAM_INTEGRAL_R, sides[s], (const ptrdiff_t[2]){lags[a], lags[b]}, xx + yy, r,
                   2 * promised * r);
      }
    }
  }
}

/* The cell (i, j) three times as wide and high against the nine cells that it consists of. */
static void CheckNine(int kind, const double side[2], ptrdiff_t i, ptrdiff_t j)
{
  const double whole = SamIntegralCell((SamIntegral)kind, 3 * side[0], 3 * side[1], i, j);
  double       sum = 0, size = 0;

  for (ptrdiff_t b = -1; b <= 1; b++) {
    for (ptrdiff_t a = -1; a <= 1; a++) {
      const double part = SamIntegralCell((SamIntegral)kind, side[0], side[1], 3 * i + a, 3 * j + b);

      sum += part;
      size += fabs(part);
    }
  }
  /*
   * Relative to the parts' absolute sum, which is the sum itself except where an odd kernel
   * changes sign among the nine. Both sides keep the promise; 3 dx may round, and the most
   * sensitive value (XX at i = 0) goes with its third power: three more roundings.
   */
  AssertNear("nine cells", kind, side, (const ptrdiff_t[2]){i, j}, sum, whole, (2 * promised + 3 * DBL_EPSILON) * size);
}

static void test_nine_cells_make_one_three_times_as_large(void **state)
{
  (void)state;
  for (int s = 0; s < NUM_SIDES; s++) {
    for (int a = 0; a < NUM_LAGS; a++) {
      for (int b = 0; b < NUM_LAGS; b++) {
        for (int kind = 0; kind < NUM_KINDS; kind++) CheckNine(kind, sides[s], lags[a], -lags[b]);
      }
    }
  }
}

static void CheckRow(int kind, const double side[2], ptrdiff_t j, ptrdiff_t i0, ptrdiff_t n)
{
  enum { ROOM = 300 };
  double row[ROOM + 1];

  assert_true(n <= ROOM);
  row[n] = -7;
  SamIntegralRow((SamIntegral)kind, side[0], side[1], j, i0, n, row);
  assert_true(row[n] == -7);
  for (ptrdiff_t k = 0; k < n; k++) {
    const double cell = SamIntegralCell((SamIntegral)kind, side[0], side[1], i0 + k, j);

    if (memcmp(&row[k], &cell, sizeof(cell)) != 0) {
      AssertNear("row", kind, side, (const ptrdiff_t[2]){i0 + k, j}, row[k], cell, 0);
      fail_msg("row and cell differ in the sign of zero");
    }
  }
}

/* Rows that begin and end inside blocks of lags, cross the axis, or hold one cell or none. */
static void test_row_equals_cells_to_the_last_bit(void **state)
{
  static const ptrdiff_t rows[][2] = {{-150, 300}, {0, 200},      {-7, 7}, {-64, 65}, {5, 59}, {63, 2},
                                      {2100, 250}, {-16383, 200}, {0, 1},  {1, 1},    {17, 0}};
  static const ptrdiff_t heights[] = {0, 1, -2, 9, -130, 2200, 16383};

  (void)state;
  for (int s = 0; s < NUM_SIDES; s++) {
    for (size_t h = 0; h < sizeof(heights) / sizeof(heights[0]); h++) {
      for (size_t r = 0; r < sizeof(rows) / sizeof(rows[0]); r++) {
        for (int kind = 0; kind < NUM_KINDS; kind++) {
          CheckRow(kind, sides[s], heights[h], rows[r][0], rows[r][1]);
        }
      }
    }
  }
}

static void CheckScaled(int kind, const double side[2], ptrdiff_t i, ptrdiff_t j, double scale, double tolerance)
{
  const double value  = SamIntegralCell((SamIntegral)kind, side[0], side[1], i, j);
  const double scaled = SamIntegralCell((SamIntegral)kind, scale * side[0], scale * side[1], i, j);

  AssertNear("scaling", kind, side, (const ptrdiff_t[2]){i, j}, scaled, scale * value, tolerance * fabs(scale * value));
}

/* Every integral is a length: exact for powers of two, for other factors up to the promise. */
static void test_integrals_scale_as_a_length(void **state)
{
  (void)state;
  for (int s = 0; s < NUM_SIDES; s++) {
    for (int a = 0; a < NUM_LAGS; a++) {
      for (int b = 0; b < NUM_LAGS; b++) {
        for (int kind = 0; kind < NUM_KINDS; kind++) {
          CheckScaled(kind, sides[s], lags[a], lags[b], 0x1p-30, 0);
          CheckScaled(kind, sides[s], lags[a], lags[b], 0x1p10, 0);
          CheckScaled(kind, sides[s], lags[a], lags[b], 1e-9, 2 * promised + 3 * DBL_EPSILON);
          CheckScaled(kind, sides[s], lags[a], lags[b], 1e3, 2 * promised + 3 * DBL_EPSILON);
        }
      }
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_values_match_50_digit_arithmetic),
    cmocka_unit_test(test_parity_and_zeros_are_exact),
    cmocka_unit_test(test_exchange_of_axes),
    cmocka_unit_test(test_xx_and_yy_add_up_to_r),
    cmocka_unit_test(test_nine_cells_make_one_three_times_as_large),
    cmocka_unit_test(test_row_equals_cells_to_the_last_bit),
    cmocka_unit_test(test_integrals_scale_as_a_length),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

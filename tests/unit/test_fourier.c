/*
  The pruned transform and convolution: against sums written out, for all parities and shapes.
*/
#include "fields.h"

#include <petsam/private/fourier.h>

/* Sizes that do not divide, odd, prime, square, and fewer rows than ranks. */
static const PetscInt sizes[][2] = {{7, 5}, {13, 11}, {16, 9},   {2, 3},    {17, 17},
                                    {9, 2}, {5, 13},  {2563, 2}, {3, 2810}, {4096, 4}};
enum {
  NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]),
  NUM_SHORT = 7
}; /* the last ones have lines that are transformed in parts */

/*
  Rounding of transforms grows as the logarithm of their length: some 10 eps of the largest value for these, while the
  sums of n^2 products differ by up to 20 eps of theirs.
*/
static const double tolerance = 1e-13;

/*
  A kernel without any smoothness, also at lags that no pair of cells has and, when odd, at lag 0: none of that may
  count.
*/
typedef struct {
  PetscInt  seed;
  PetscBool odd_x, odd_y;
} Shape;

static double AtPositiveLag(const Shape *s, PetscInt i, PetscInt j)
{
  return (2 + Random(s->seed, 0, i, j)) / (double)(1 + i + j);
}

/* Kernels that are made together. */
typedef struct {
  PetscInt     n;
  const Shape *shape;
} Shapes;

static void Rows(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  const Shapes *s = (const Shapes *)context;

  for (PetscInt k = 0; k < s->n; k++)
    for (PetscInt i = 0; i < n; i++) values[k][i] = AtPositiveLag(&s->shape[k], i, j);
}

static double AtLag(const Shape *s, PetscInt i, PetscInt j)
{
  double sign = 1;

  if (s->odd_x) sign *= (i > 0) - (i < 0);
  if (s->odd_y) sign *= (j > 0) - (j < 0);
  return sign == 0 ? 0 : sign * AtPositiveLag(s, i < 0 ? -i : i, j < 0 ? -j : j);
}

static SamFourierSettings settings;

static SamFourier NewFourier(SamGrid grid, SamFourierPeriod period)
{
  SamFourier fourier;

  sam_call(SamFourierCreate(grid, period, &settings, &fourier));
  return fourier;
}

static void NewKernels(SamFourier fourier, PetscInt n, const Shape shape[], SamKernel kernels[])
{
  const Shapes shapes = {n, shape};
  PetscBool    odd[3][2];

  for (PetscInt k = 0; k < n; k++) {
    odd[k][0] = shape[k].odd_x;
    odd[k][1] = shape[k].odd_y;
  }
  sam_call(SamKernelsCreate(fourier, n, (const PetscBool(*)[2])odd, Rows, &shapes, kernels));
}

/* out[o] of this rank's cells by summation. */
static void SumDirectly(SamGrid grid, PetscInt n_in, PetscInt n_out, const Shape shape[3][3],
                        const SamKernelMatrix *matrix, const double in[], double out[])
{
  const PetscInt nx = grid->nx, ny = grid->ny;

  for (PetscInt o = 0; o < n_out; o++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < nx; i++) {
        double sum = 0;

        for (PetscInt c = 0; c < n_in; c++) {
          if (!matrix->kernel[o][c]) continue;
          for (PetscInt l = 0; l < ny; l++)
            for (PetscInt k = 0; k < nx; k++)
              sum +=
                matrix->scale[o][c] * AtLag(&shape[o][c], i - k, grid->row_start + j - l) * in[(c * ny + l) * nx + k];
        }
        out[o * grid->cells + j * nx + i] = sum;
      }
}

/* Empties each third row of a field, and each third one but for its last cell. */
static void EmptyRows(SamGrid grid, PetscInt components, Vec field)
{
  double *a;

  sam_call(VecGetArray(field, &a));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt j = 0; j < grid->rows; j++) {
      const PetscInt kind = (grid->row_start + j) % 3;

      for (PetscInt i = 0; kind && i < grid->nx - (kind == 2 ? 1 : 0); i++) a[c * grid->cells + j * grid->nx + i] = 0;
    }
  sam_call(VecRestoreArray(field, &a));
}

/* A matrix of kernels; bit 1 of a parity: odd in x, bit 2: odd in y, negative: no kernel there. */
static void AssertConvolution(SamGrid grid, SamFourier fourier, PetscInt n_in, PetscInt n_out, const int parity[3][3],
                              PetscBool in_place)
{
  SamKernelMatrix matrix = {.n_in = n_in, .n_out = n_out};
  Shape           shape[3][3];
  const double   *from[3];
  double         *to[3], *a, *b, *whole;
  Vec             in = NewRandom(grid, 3, 7), out = NewField(grid, 3), exact = NewField(grid, 3);

  for (PetscInt o = 0; o < n_out; o++) {
    PetscInt first = n_in;

    for (PetscInt c = 0; c < n_in; c++) {
      const Shape s = {.seed  = 3 * o + c,
                       .odd_x = parity[o][c] & 1 ? PETSC_TRUE : PETSC_FALSE,
                       .odd_y = parity[o][c] & 2 ? PETSC_TRUE : PETSC_FALSE};

      shape[o][c]        = s;
      matrix.scale[o][c] = 1 + 0.5 * (double)(o - 2 * c);
      if (parity[o][c] >= 0 && first == n_in) first = c;
    }
    if (first < n_in) NewKernels(fourier, n_in - first, &shape[o][first], &matrix.kernel[o][first]);
    for (PetscInt c = first; c < n_in; c++)
      if (parity[o][c] < 0) sam_call(SamKernelDestroy(&matrix.kernel[o][c]));
  }
  EmptyRows(grid, 3, in);
  whole = Whole(grid, 3, in);
  sam_call(VecGetArray(exact, &b));
  SumDirectly(grid, n_in, n_out, (const Shape(*)[3])shape, &matrix, whole, b);
  sam_call(VecRestoreArray(exact, &b));
  free(whole);

  if (in_place) sam_call(VecCopy(in, out));
  sam_call(VecGetArray(in, &a));
  sam_call(VecGetArray(out, &b));
  for (PetscInt k = 0; k < 3; k++) {
    to[k]   = b + k * grid->cells;
    from[k] = in_place ? to[k] : a + k * grid->cells;
  }
  sam_call(SamConvolve(fourier, &matrix, from, to));
  for (PetscInt k = n_out * grid->cells; k < 3 * grid->cells; k++) b[k] = 0;
  sam_call(VecRestoreArray(out, &b));
  sam_call(VecRestoreArray(in, &a));
  sam_assert_close(Difference(out, exact, NORM_INFINITY), 0, tolerance);

  for (PetscInt o = 0; o < n_out; o++)
    for (PetscInt c = 0; c < n_in; c++) sam_call(SamKernelDestroy(&matrix.kernel[o][c]));
  sam_destroy(&in, &out, &exact);
}

static void AssertConvolutionOn(const PetscInt n[2], PetscInt n_in, PetscInt n_out, const int parity[3][3],
                                PetscBool in_place)
{
  SamGrid    grid = NewGrid(n[0], n[1], 1, 1);
  SamFourier fourier;

  fourier = NewFourier(grid, SAM_FOURIER_FAST);
  AssertConvolution(grid, fourier, n_in, n_out, parity, in_place);
  sam_call(SamFourierDestroy(&fourier));
  sam_call(SamGridDestroy(&grid));
}

static void AssertConvolutions(PetscInt n_in, PetscInt n_out, const int parity[3][3], PetscBool in_place)
{
  for (int k = 0; k < NUM_SHORT; k++) AssertConvolutionOn(sizes[k], n_in, n_out, parity, in_place);
}

static void test_kernels_of_all_parities(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    const int parity[3][3] = {{k}};

    AssertConvolutions(1, 1, parity, PETSC_FALSE);
  }
}

static void test_two_fields_to_one(void **state)
{
  const int parity[3][3] = {{1, 2}};

  (void)state;
  AssertConvolutions(2, 1, parity, PETSC_FALSE);
}

static void test_one_field_to_two(void **state)
{
  const int parity[3][3] = {{1}, {2}};

  (void)state;
  AssertConvolutions(1, 2, parity, PETSC_FALSE);
}

static void test_two_fields_to_two(void **state)
{
  const int parity[3][3] = {{0, 3}, {3, 0}};

  (void)state;
  AssertConvolutions(2, 2, parity, PETSC_FALSE);
}

static void test_three_fields_to_three(void **state)
{
  const int parity[][3][3] = {{{0, 3, 1}, {3, 0, 2}, {1, 2, 0}}, /* by reflection: the normal and two tangential ones */
                              {{0, 1, 2}, {3, 2, 1}, {1, 0, 3}}, /* turned another way */
                              {{1, 0, 0}, {0, 1, 3}, {0, 0, 1}}}; /* no such order */

  (void)state;
  for (int k = 0; k < 3; k++) {
    AssertConvolutions(3, 3, parity[k], PETSC_FALSE);
    AssertConvolutions(3, 3, parity[k], PETSC_TRUE);
  }
}

static void test_long_lines(void **state)
{
  (void)state;
  for (int k = NUM_SHORT; k < NUM_SIZES - 1; k++) /* sums over the last size take too long */
    for (int p = 0; p < 4; p += 3) {
      const int parity[3][3] = {{p}};

      AssertConvolutionOn(sizes[k], 1, 1, parity, PETSC_FALSE);
    }
}

static void test_missing_kernel_is_zero(void **state)
{
  const int parity[3][3] = {{-1, 1, 0}, {2, 0, -1}, {0, -1, 3}};

  (void)state;
  AssertConvolutions(3, 3, parity, PETSC_FALSE);
}

static void test_output_may_be_the_input(void **state)
{
  const int parity[3][3] = {{0, 3, 1}, {3, 0, 2}, {1, 2, 0}};

  (void)state;
  for (PetscInt n = 1; n <= 3; n++) AssertConvolutions(n, n, parity, PETSC_TRUE);
  AssertConvolutions(2, 1, parity, PETSC_TRUE);
  AssertConvolutions(1, 3, parity, PETSC_TRUE);
}

/* Work space grows with the number of fields, and then serves fewer as well. */
static void test_one_transform_serves_any_number_of_fields(void **state)
{
  const int  parity[3][3] = {{0, 3, 1}, {3, 0, 2}, {1, 2, 0}};
  SamGrid    grid         = NewGrid(11, 7, 1, 1);
  SamFourier fourier;

  (void)state;
  fourier = NewFourier(grid, SAM_FOURIER_FAST);
  for (PetscInt n = 1; n <= 5; n++)
    AssertConvolution(grid, fourier, n > 3 ? 6 - n : n, n > 3 ? 6 - n : n, parity, PETSC_FALSE);
  sam_call(SamFourierDestroy(&fourier));
  sam_call(SamGridDestroy(&grid));
}

/* Deltas in the corners, on the edges and inside: each answer is the kernel about it, and nothing wraps round. */
static void test_impulse_response_is_the_kernel(void **state)
{
  (void)state;
  for (int k = 0; k < NUM_SIZES; k++) {
    const PetscInt nx = sizes[k][0], ny = sizes[k][1];
    const PetscInt at[5][2] = {{0, 0}, {nx - 1, 0}, {0, ny - 1}, {nx - 1, ny - 1}, {nx / 2, ny / 3}};
    SamGrid        grid     = NewGrid(nx, ny, 1, 1);
    SamFourier     fourier;

    fourier = NewFourier(grid, SAM_FOURIER_FAST);
    for (int parity = 0; parity < 4; parity++) {
      const Shape shape = {
        .seed = parity, .odd_x = parity & 1 ? PETSC_TRUE : PETSC_FALSE, .odd_y = parity & 2 ? PETSC_TRUE : PETSC_FALSE};
      SamKernelMatrix matrix = {.n_in = 1, .n_out = 1, .scale = {{1}}};

      NewKernels(fourier, 1, &shape, &matrix.kernel[0][0]);
      for (int d = 0; d < 5; d++) {
        Vec           v = NewField(grid, 1);
        double       *a, error = 0;
        const double *from[1];
        double       *to[1];

        AddAt(grid, 0, at[d][0], at[d][1], 1, v);
        sam_call(VecGetArray(v, &a));
        from[0] = to[0] = a;
        sam_call(SamConvolve(fourier, &matrix, from, to));
        for (PetscInt j = 0; j < grid->rows; j++)
          for (PetscInt i = 0; i < nx; i++)
            error = fmax(error, fabs(a[j * nx + i] - AtLag(&shape, i - at[d][0], grid->row_start + j - at[d][1])));
        sam_call(VecRestoreArray(v, &a));
        sam_assert_close(error, 0, tolerance); /* the kernel's largest value is between 1/2 and 3 */
        sam_call(VecDestroy(&v));
      }
      sam_call(SamKernelDestroy(&matrix.kernel[0][0]));
    }
    sam_call(SamFourierDestroy(&fourier));
    sam_call(SamGridDestroy(&grid));
  }
}

static void Identity(const SamFourierBlock *block, const void *context)
{
  (void)block;
  (void)context;
}

/* Transforms are not normalised: back and forth multiplies by the period. */
static void AssertIdentity(SamFourierMode mode, SamFourierPeriod period)
{
  const SamFourierFilter filter = {mode, 3, 3, Identity, NULL};

  for (int k = 0; k < NUM_SIZES; k++) {
    SamGrid       grid = NewGrid(sizes[k][0], sizes[k][1], 1, 1);
    Vec           in = NewRandom(grid, 3, k), out = NewField(grid, 3);
    SamFourier    fourier;
    PetscInt      hx, hy;
    double       *a, *b;
    const double *from[3];
    double       *to[3];

    fourier = NewFourier(grid, period);
    sam_call(SamFourierGetPeriods(fourier, &hx, &hy));
    if (period == SAM_FOURIER_EXACT)
      sam_assert(hx == grid->nx && hy == grid->ny);
    else
      sam_assert(hx >= grid->nx && hy >= grid->ny && hx % 2 == 0 && hy % 2 == 0);
    sam_call(VecGetArray(in, &a));
    sam_call(VecGetArray(out, &b));
    for (PetscInt c = 0; c < 3; c++) {
      from[c] = a + c * grid->cells;
      to[c]   = b + c * grid->cells;
    }
    sam_call(SamFourierApply(fourier, &filter, from, to));
    sam_call(VecRestoreArray(in, &a));
    sam_call(VecRestoreArray(out, &b));
    sam_call(VecScale(out, 1 / ((mode == SAM_FOURIER_PADDED ? 4.0 : 1.0) * (double)hx * (double)hy)));
    sam_assert_close(Difference(out, in, NORM_INFINITY), 0, tolerance);
    sam_call(SamFourierDestroy(&fourier));
    sam_destroy(&in, &out);
    sam_call(SamGridDestroy(&grid));
  }
}

static void test_periodic_transform_and_back_is_the_identity(void **state)
{
  (void)state;
  AssertIdentity(SAM_FOURIER_PERIODIC, SAM_FOURIER_FAST);
}

static void test_exactly_periodic_transform_and_back_is_the_identity(void **state)
{
  (void)state;
  AssertIdentity(SAM_FOURIER_PERIODIC, SAM_FOURIER_EXACT);
}

static void test_padded_transform_and_back_is_the_identity(void **state)
{
  (void)state;
  AssertIdentity(SAM_FOURIER_PADDED, SAM_FOURIER_FAST);
}

/* Picks one wave: kx = 1, ky = 2 and its mirror image. */
static void OneWave(const SamFourierBlock *block, const void *context)
{
  (void)context;
  for (PetscInt b = 0; b < block->columns; b++)
    for (PetscInt m = 0; m < block->hy; m++)
      if (block->first + b != 1 || m != 2)
        block->data[0][b * block->stride + m][0] = block->data[0][b * block->stride + m][1] = 0;
}

/* The filter meets the frequencies where the header says they are, on a grid that is one period. */
static void AssertFrequencies(PetscInt nx, PetscInt ny, SamFourierPeriod period)
{
  const SamFourierFilter filter  = {SAM_FOURIER_PERIODIC, 1, 1, OneWave, NULL};
  SamGrid                grid    = NewGrid(nx, ny, 1, 1);
  SamFourier             fourier = NewFourier(grid, period);
  PetscInt               hx, hy;
  Vec                    in = NewField(grid, 1), out = NewField(grid, 1), other = NewField(grid, 1);
  double                *a, *b;
  const double          *from[1];
  double                *to[1];

  sam_call(SamFourierGetPeriods(fourier, &hx, &hy));
  sam_assert(hx == nx && hy == ny);
  sam_call(VecGetArray(in, &a));
  sam_call(VecGetArray(other, &b));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < nx; i++) {
      const double x = 2 * PETSC_PI * (double)i / (double)nx,
                   y = 2 * PETSC_PI * (double)(grid->row_start + j) / (double)ny;

      b[j * nx + i] = cos(x + 2 * y + 0.3);
      a[j * nx + i] = b[j * nx + i] + cos(2 * x + y) + sin(x - 2 * y) + 0.7;
    }
  sam_call(VecRestoreArray(other, &b));
  from[0] = a;
  sam_call(VecGetArray(out, &b));
  to[0] = b;
  sam_call(SamFourierApply(fourier, &filter, from, to));
  sam_call(VecRestoreArray(out, &b));
  sam_call(VecRestoreArray(in, &a));
  sam_call(VecScale(out, 1 / ((double)nx * (double)ny)));
  sam_assert_close(Difference(out, other, NORM_INFINITY), 0, tolerance);
  sam_call(SamFourierDestroy(&fourier));
  sam_destroy(&in, &out, &other);
  sam_call(SamGridDestroy(&grid));
}

static void test_filter_sees_frequencies_by_their_numbers(void **state)
{
  (void)state;
  AssertFrequencies(14, 10, SAM_FOURIER_FAST); /* sizes that are their own periods */
  AssertFrequencies(14, 10, SAM_FOURIER_EXACT);
  AssertFrequencies(13, 11, SAM_FOURIER_EXACT);
  AssertFrequencies(22, 5, SAM_FOURIER_EXACT);
  AssertFrequencies(9, 26, SAM_FOURIER_EXACT);
}

static void test_settings_come_from_options(void **state)
{
  const SamOptions   from = {PETSC_COMM_WORLD, "some_"};
  SamFourierSettings s    = {.send = PETSC_FALSE};

  (void)state;
  sam_call(PetscOptionsSetValue(NULL, "-fft_effort", "patient")); /* without the prefix: somebody else's */
  sam_call(PetscOptionsSetValue(NULL, "-some_fft_exchange", "transpose"));
  sam_call(SamFourierSettingsFromOptions(&s, &from));
  sam_assert(s.effort == SAM_FOURIER_ESTIMATE && s.send);
  sam_call(PetscOptionsSetValue(NULL, "-some_fft_effort", "measure"));
  sam_call(PetscOptionsClearValue(NULL, "-some_fft_exchange"));
  sam_call(SamFourierSettingsFromOptions(&s, &from));
  sam_assert(s.effort == SAM_FOURIER_MEASURE && s.send); /* what is not given stays */
  sam_call(PetscOptionsSetValue(NULL, "-some_fft_effort", "much"));
  sam_fails(SamFourierSettingsFromOptions(&s, &from), SAM_ERR_USER);
  sam_call(PetscOptionsClearValue(NULL, "-some_fft_effort"));
  sam_call(PetscOptionsClearValue(NULL, "-fft_effort"));
}

/* The same by FFTW's transposes, which otherwise only ranks on several nodes need. */
static int Transpose(void **state)
{
  (void)state;
  settings.send = PETSC_TRUE;
  return 0;
}

static int NoTranspose(void **state)
{
  (void)state;
  settings.send = PETSC_FALSE;
  return 0;
}

#define TEST_TRANSPOSED(f) \
  { \
    #f "_transposed", f, Transpose, NoTranspose, NULL \
  }

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_kernels_of_all_parities),
    cmocka_unit_test(test_two_fields_to_one),
    cmocka_unit_test(test_one_field_to_two),
    cmocka_unit_test(test_two_fields_to_two),
    cmocka_unit_test(test_three_fields_to_three),
    cmocka_unit_test(test_long_lines),
    cmocka_unit_test(test_missing_kernel_is_zero),
    cmocka_unit_test(test_output_may_be_the_input),
    cmocka_unit_test(test_one_transform_serves_any_number_of_fields),
    cmocka_unit_test(test_impulse_response_is_the_kernel),
    cmocka_unit_test(test_periodic_transform_and_back_is_the_identity),
    cmocka_unit_test(test_exactly_periodic_transform_and_back_is_the_identity),
    cmocka_unit_test(test_padded_transform_and_back_is_the_identity),
    cmocka_unit_test(test_filter_sees_frequencies_by_their_numbers),
    cmocka_unit_test(test_settings_come_from_options),
    TEST_TRANSPOSED(test_kernels_of_all_parities),
    TEST_TRANSPOSED(test_two_fields_to_one),
    TEST_TRANSPOSED(test_three_fields_to_three),
    TEST_TRANSPOSED(test_output_may_be_the_input),
    TEST_TRANSPOSED(test_one_transform_serves_any_number_of_fields),
    TEST_TRANSPOSED(test_impulse_response_is_the_kernel),
    TEST_TRANSPOSED(test_exactly_periodic_transform_and_back_is_the_identity),
    TEST_TRANSPOSED(test_padded_transform_and_back_is_the_identity),
    TEST_TRANSPOSED(test_filter_sees_frequencies_by_their_numbers),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}

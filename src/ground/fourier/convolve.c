/*
  Convolution: products of spectra with kernels.

  A kernel's column of hy + 1 values is used twice for a column of 2 hy frequencies: upwards, then downwards.
*/
#include "fourierimpl.h"

/*
  The kernel's values for one column in one phase: the first `rising` entries in order, the others mirrored.
*/
typedef struct {
  const double *values;
  ptrdiff_t     rising, mirror; /* entry m >= rising has the value at mirror - m, with the parity's sign */
} Column;

static Column GetColumn(SamKernel kernel, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const ptrdiff_t hy = block->hy, even = hy / 2 + 1;
  const double   *base = kernel->values + (block->local + b) * (hy + 1);

  if (block->stride == 1) return (Column){kernel->values, hy, hy};
  if (phase == 0) return (Column){base, even, hy};
  return (Column){base + even, (hy + 1) / 2, hy - 1};
}

/*
  Computes to += kernel * from for n entries whose kernel values are factor times k[0], k[1], ... or, downwards, k[0],
  k[-1], ...; `Turned`: multiplied by -i.
*/
#define DEFINE_ADD(Name, STEP, re, im, ADD) \
  SAM_VECTORIZED static void Name(ptrdiff_t n, double factor, const double *restrict k, \
                                  const double(*restrict from)[2], double(*restrict to)[2]) \
  { \
    for (ptrdiff_t m = 0; m < n; m++) { \
      to[m][0] += factor * k[STEP m] * from[m][re]; \
      to[m][1] ADD factor *k[STEP m] * from[m][im]; \
    } \
  }

DEFINE_ADD(AddRising, , 0, 1, +=)
DEFINE_ADD(AddFalling, -, 0, 1, +=)
DEFINE_ADD(AddRisingTurned, , 1, 0, -=)
DEFINE_ADD(AddFallingTurned, -, 1, 0, -=)

/* Computes to += scale * kernel * from for one column, multiplied by -i if the kernel is odd in one direction only. */
static void AddProduct(SamKernel kernel, const SamFourierBlock *block, PetscInt phase, PetscInt b, double scale,
                       const double (*from)[2], double (*to)[2])
{
  const Column    c      = GetColumn(kernel, block, phase, b);
  const double    folded = kernel->odd_y ? -scale : scale;
  const ptrdiff_t rest   = block->hy - c.rising;

  if (kernel->odd_x != kernel->odd_y) {
    AddRisingTurned(c.rising, scale, c.values, from, to);
    AddFallingTurned(rest, folded, c.values + c.mirror - c.rising, from + c.rising, to + c.rising);
  } else {
    AddRising(c.rising, scale, c.values, from, to);
    AddFalling(rest, folded, c.values + c.mirror - c.rising, from + c.rising, to + c.rising);
  }
}

/*
  Compute products in place, of either precision, for n entries as above: of one field and an even kernel, and of two
  fields and a symmetric matrix of kernels whose off-diagonal kernel, with the factor `cross`, is odd in x and in y.
*/
#define DEFINE_PRODUCTS(Real, STEP, MultiplyColumn, MultiplyPair) \
  SAM_VECTORIZED static void MultiplyColumn(ptrdiff_t n, double factor, const double *restrict values, \
                                            Real(*restrict column)[2]) \
  { \
    for (ptrdiff_t m = 0; m < n; m++) { \
      const Real k = (Real)(factor * values[STEP m]); \
\
      column[m][0] *= k; \
      column[m][1] *= k; \
    } \
  } \
\
  SAM_VECTORIZED static void MultiplyPair(ptrdiff_t n, double factor, double cross, const double *restrict xx, \
                                          const double *restrict xy, const double *restrict yy, Real(*restrict x)[2], \
                                          Real(*restrict y)[2]) \
  { \
    for (ptrdiff_t m = 0; m < n; m++) { \
      const Real kxx = (Real)(factor * xx[STEP m]), kxy = (Real)(cross * xy[STEP m]), \
                 kyy = (Real)(factor * yy[STEP m]); \
      const Real x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1]; \
\
      x[m][0] = kxx * x0 + kxy * y0; \
      x[m][1] = kxx * x1 + kxy * y1; \
      y[m][0] = kxy * x0 + kyy * y0; \
      y[m][1] = kxy * x1 + kyy * y1; \
    } \
  }

DEFINE_PRODUCTS(double, , ColumnRising, PairRising)
DEFINE_PRODUCTS(double, -, ColumnFalling, PairFalling)
DEFINE_PRODUCTS(float, , ColumnRisingSingle, PairRisingSingle)
DEFINE_PRODUCTS(float, -, ColumnFallingSingle, PairFallingSingle)

/*
  Multiplies three fields by 3 x 3 kernels, in place. The factors -i can be moved from the kernels to the fields: field
  i has it if in[i], result o if out[o], and where both have it, the kernel's sign changes. By reflection, all kernels
  of mechanical problems are of this kind.
*/
typedef struct {
  PetscBool     in[3], out[3];
  const double *values[3][3]; /* of a column, upwards or downwards */
  double        factor[3][3];
} Nine;

/* Multiplies the fields that are due by -i. */
static void Turn(const PetscBool due[3], ptrdiff_t n, double (*const column[3])[2])
{
  for (PetscInt c = 0; c < 3; c++)
    for (ptrdiff_t m = 0; due[c] && m < n; m++) {
      const double re = column[c][m][0];

      column[c][m][0] = column[c][m][1];
      column[c][m][1] = -re;
    }
}

#define DEFINE_NINE(Name, STEP) \
  SAM_VECTORIZED static void Name(const Nine *nine, ptrdiff_t n, double(*restrict x)[2], double(*restrict y)[2], \
                                  double(*restrict z)[2]) \
  { \
    const double *restrict xx = nine->values[0][0], *restrict xy = nine->values[0][1], \
                           *restrict xz = nine->values[0][2], *restrict yx = nine->values[1][0], \
                           *restrict yy = nine->values[1][1], *restrict yz = nine->values[1][2], \
                           *restrict zx = nine->values[2][0], *restrict zy = nine->values[2][1], \
                           *restrict zz = nine->values[2][2]; \
    const double(*const f)[3]           = nine->factor; \
\
    for (ptrdiff_t m = 0; m < n; m++) { \
      const double a = x[m][0], b = x[m][1], c = y[m][0], d = y[m][1], e = z[m][0], g = z[m][1]; \
      const double k0 = f[0][0] * xx[STEP m], k1 = f[0][1] * xy[STEP m], k2 = f[0][2] * xz[STEP m], \
                   k3 = f[1][0] * yx[STEP m], k4 = f[1][1] * yy[STEP m], k5 = f[1][2] * yz[STEP m], \
                   k6 = f[2][0] * zx[STEP m], k7 = f[2][1] * zy[STEP m], k8 = f[2][2] * zz[STEP m]; \
\
      x[m][0] = k0 * a + k1 * c + k2 * e; \
      x[m][1] = k0 * b + k1 * d + k2 * g; \
      y[m][0] = k3 * a + k4 * c + k5 * e; \
      y[m][1] = k3 * b + k4 * d + k5 * g; \
      z[m][0] = k6 * a + k7 * c + k8 * e; \
      z[m][1] = k6 * b + k7 * d + k8 * g; \
    } \
  }

DEFINE_NINE(MultiplyRising, )
DEFINE_NINE(MultiplyFalling, -)

/* True if a matrix has 3 x 3 kernels whose symmetries fit the sign pattern of MultiplyThree(); fills in `nine`. */
static PetscBool FindNine(const SamKernelMatrix *M, Nine *nine)
{
  if (M->n_in != 3 || M->n_out != 3) return PETSC_FALSE;
  for (PetscInt o = 0; o < 3; o++)
    for (PetscInt i = 0; i < 3; i++)
      if (!M->kernel[o][i]) return PETSC_FALSE;
  for (PetscInt k = 0; k < 3; k++) {
    nine->in[k]  = M->kernel[0][k]->odd_x != M->kernel[0][k]->odd_y;
    nine->out[k] = (M->kernel[k][0]->odd_x != M->kernel[k][0]->odd_y) != nine->in[0];
  }
  for (PetscInt o = 0; o < 3; o++)
    for (PetscInt i = 0; i < 3; i++) {
      const int turned = M->kernel[o][i]->odd_x != M->kernel[o][i]->odd_y;

      if (turned != (nine->in[i] != nine->out[o])) return PETSC_FALSE;
      nine->factor[o][i] = nine->in[i] && nine->out[o] ? -M->scale[o][i] : M->scale[o][i];
    }
  return PETSC_TRUE;
}

static PetscBool IsScalar(const SamKernelMatrix *M)
{
  return M->n_in == 1 && M->n_out == 1 && M->scale[0][0] == 1 && M->kernel[0][0]->odd_x == M->kernel[0][0]->odd_y &&
         !M->kernel[0][0]->odd_y;
}

static PetscBool IsSymmetricPair(const SamKernelMatrix *M)
{
  if (M->n_in != 2 || M->n_out != 2 || M->kernel[0][1] != M->kernel[1][0]) return PETSC_FALSE;
  for (PetscInt o = 0; o < 2; o++)
    for (PetscInt i = 0; i < 2; i++) {
      const PetscBool odd = o == i ? PETSC_FALSE : PETSC_TRUE;

      if (!M->kernel[o][i] || M->scale[o][i] != 1 || M->kernel[o][i]->odd_x != odd || M->kernel[o][i]->odd_y != odd)
        return PETSC_FALSE;
    }
  return PETSC_TRUE;
}

/* Kernels whose products with one field are added, and work space for a column. */
typedef struct {
  PetscInt         n;
  const SamKernel *kernels;
  double (*column)[2];
} Summands;

typedef struct Factors {
  const SamKernelMatrix *matrix;
  double                 factor;
  /* product for one column in one phase, by the kind of matrix */
  void (*multiply)(const struct Factors *factors, const SamFourierBlock *block, PetscInt phase, PetscInt b);
  Nine nine;
  double (*column[SAM_FOURIER_FIELDS])[2]; /* work space of the general case */
  const Summands *summands;                /* NULL: not a sum of kernels */
} Factors;

/* Multiplies three columns in place. */
static void MultiplyColumns(const SamKernelMatrix *M, Nine nine, const SamFourierBlock *block, PetscInt phase,
                            PetscInt b, double (*const column[3])[2])
{
  const ptrdiff_t n = block->hy, rising = GetColumn(M->kernel[0][0], block, phase, b).rising;

  for (PetscInt o = 0; o < 3; o++)
    for (PetscInt i = 0; i < 3; i++) nine.values[o][i] = GetColumn(M->kernel[o][i], block, phase, b).values;
  Turn(nine.in, n, column);
  MultiplyRising(&nine, rising, column[0], column[1], column[2]);
  for (PetscInt o = 0; o < 3; o++)
    for (PetscInt i = 0; i < 3; i++) {
      nine.values[o][i] += GetColumn(M->kernel[o][i], block, phase, b).mirror - rising;
      if (M->kernel[o][i]->odd_y) nine.factor[o][i] = -nine.factor[o][i];
    }
  MultiplyFalling(&nine, n - rising, column[0] + rising, column[1] + rising, column[2] + rising);
  Turn(nine.out, n, column);
}

static void MultiplyThree(const Factors *factors, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const ptrdiff_t offset      = (phase * block->width + b) * (ptrdiff_t)block->stride;
  double(*const column[3])[2] = {block->data[0] + offset, block->data[1] + offset, block->data[2] + offset};

  MultiplyColumns(factors->matrix, factors->nine, block, phase, b, column);
}

/* Multiplies by any matrix: the output columns are collected separately, and then replace the inputs. */
static void MultiplyGeneral(const Factors *factors, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const SamKernelMatrix *M      = factors->matrix;
  const ptrdiff_t        offset = (phase * block->width + b) * (ptrdiff_t)block->stride;

  for (PetscInt o = 0; o < M->n_out; o++) {
    double(*to)[2] = factors->column[o];

    for (ptrdiff_t m = 0; m < block->hy; m++) to[m][0] = to[m][1] = 0;
    for (PetscInt i = 0; i < M->n_in; i++)
      if (M->kernel[o][i])
        AddProduct(M->kernel[o][i], block, phase, b, M->scale[o][i], (const double(*)[2])block->data[i] + offset, to);
  }
  for (PetscInt o = 0; o < M->n_out; o++)
    for (ptrdiff_t m = 0; m < block->hy; m++)
      for (PetscInt r = 0; r < 2; r++) block->data[o][offset + m][r] = factors->column[o][m][r];
}

/* Multiplies one field by an even kernel, upwards along its values and down again. */
static void MultiplyOne(const Factors *f, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const ptrdiff_t offset = (phase * block->width + b) * (ptrdiff_t)block->stride;
  const Column    c      = GetColumn(f->matrix->kernel[0][0], block, phase, b);
  const ptrdiff_t rising = c.rising, rest = block->hy - rising;
  const double   *falling = c.values + c.mirror - rising;

  if (block->data[0]) {
    ColumnRising(rising, f->factor, c.values, block->data[0] + offset);
    ColumnFalling(rest, f->factor, falling, block->data[0] + offset + rising);
  } else {
    ColumnRisingSingle(rising, f->factor, c.values, block->single[0] + offset);
    ColumnFallingSingle(rest, f->factor, falling, block->single[0] + offset + rising);
  }
}

static void MultiplyTwo(const Factors *f, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const ptrdiff_t offset = (phase * block->width + b) * (ptrdiff_t)block->stride;
  const Column    c      = GetColumn(f->matrix->kernel[0][0], block, phase, b);
  const double   *xx = c.values, *xy = GetColumn(f->matrix->kernel[0][1], block, phase, b).values,
               *yy   = GetColumn(f->matrix->kernel[1][1], block, phase, b).values;
  const ptrdiff_t up = c.rising, rest = block->hy - up, at = c.mirror - up;

  if (block->data[0]) {
    PairRising(up, f->factor, f->factor, xx, xy, yy, block->data[0] + offset, block->data[1] + offset);
    PairFalling(rest, f->factor, -f->factor, xx + at, xy + at, yy + at, block->data[0] + offset + up,
                block->data[1] + offset + up);
  } else {
    PairRisingSingle(up, f->factor, f->factor, xx, xy, yy, block->single[0] + offset, block->single[1] + offset);
    PairFallingSingle(rest, f->factor, -f->factor, xx + at, xy + at, yy + at, block->single[0] + offset + up,
                      block->single[1] + offset + up);
  }
}

static void Multiply(const SamFourierBlock *block, const void *context)
{
  const Factors  *factors = (const Factors *)context;
  SamFourierBlock row     = *block;

  if (block->stride == 1) { /* a single row: its values along x are stored as one column */
    row.hy      = block->columns;
    row.columns = 1;
    block       = &row;
  }
  for (PetscInt f = 0; f < block->phases; f++)
    for (PetscInt b = 0; b < block->columns; b++) factors->multiply(factors, block, f, b);
}

PetscErrorCode SamConvolve(SamFourier F, const SamKernelMatrix *M, const double *const in[], double *const out[])
{
  Factors                factors = {.matrix = M, .factor = 1, .multiply = MultiplyGeneral};
  const SamFourierFilter filter  = {SAM_FOURIER_PADDED, M->n_in, M->n_out, Multiply, &factors};

  PetscFunctionBegin;
  if (IsScalar(M)) factors.multiply = MultiplyOne;
  if (IsSymmetricPair(M)) factors.multiply = MultiplyTwo;
  if (FindNine(M, &factors.nine)) factors.multiply = MultiplyThree;
  if (factors.multiply == MultiplyGeneral)
    for (PetscInt o = 0; o < M->n_out; o++)
      PetscCall(SamAllocate(sizeof(*factors.column[o]) * (size_t)(F->row ? F->hx + 1 : F->hy), &factors.column[o]));
  PetscCall(SamFourierApply(F, &filter, in, out));
  for (PetscInt o = 0; o < M->n_out; o++) SamFree(factors.column[o]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void MultiplySum(const Factors *factors, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const Summands *s = factors->summands;
  double(*from)[2]  = block->data[0] + (phase * block->width + b) * (ptrdiff_t)block->stride;

  memset(s->column, 0, sizeof(*s->column) * (size_t)block->hy);
  for (PetscInt k = 0; k < s->n; k++)
    AddProduct(s->kernels[k], block, phase, b, 1, (const double(*)[2])from, s->column);
  memcpy(from, s->column, sizeof(*s->column) * (size_t)block->hy);
}

PetscErrorCode SamConvolveSum(SamFourier F, PetscInt n, const SamKernel kernels[], const double in[], double out[])
{
  Summands               summands = {.n = n, .kernels = kernels};
  const Factors          factors  = {.multiply = MultiplySum, .summands = &summands};
  const SamFourierFilter filter   = {SAM_FOURIER_PADDED, 1, 1, Multiply, &factors};

  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(*summands.column) * (size_t)(F->row ? F->hx + 1 : F->hy), &summands.column));
  PetscCall(SamFourierApply(F, &filter, &in, &out));
  SamFree(summands.column);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKernelMatrixAdd(const SamKernelMatrix *M, const SamFourierBlock *block, PetscInt phase, PetscInt b,
                                  double (*const in[])[2], double (*const out[])[2], double (*scratch)[2])
{
  double(*const column[3])[2] = {scratch, scratch + block->hy, scratch + 2 * block->hy};
  Nine nine;

  PetscFunctionBegin;
  PetscCheck(FindNine(M, &nine), PETSC_COMM_SELF, PETSC_ERR_SUP, "Only for 3 x 3 kernels");
  for (PetscInt k = 0; k < 3; k++) PetscCall(PetscArraycpy(column[k], in[k], block->hy));
  MultiplyColumns(M, nine, block, phase, b, column);
  for (PetscInt k = 0; k < 3; k++)
    for (PetscInt m = 0; m < block->hy; m++) {
      out[k][m][0] += column[k][m][0];
      out[k][m][1] += column[k][m][1];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConvolveSingle(SamFourier F, const SamKernelMatrix *M, double factor, const float *const in[],
                                 float *const out[])
{
  const Factors          factors = {.matrix = M, .factor = factor, .multiply = IsScalar(M) ? MultiplyOne : MultiplyTwo};
  const SamFourierFilter filter  = {SAM_FOURIER_PADDED, M->n_in, M->n_out, Multiply, &factors};

  PetscFunctionBegin;
  PetscCheck(IsScalar(M) || IsSymmetricPair(M), PETSC_COMM_SELF, PETSC_ERR_SUP,
             "Convolution in single precision: one even kernel, or a symmetric pair");
  PetscCall(SamFourierApplySingle(F, &filter, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

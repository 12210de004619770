/*
  Kernels and convolution.

  A kernel that is even or odd in x and in y has a real (or, odd in just one, imaginary) transform with the same
  symmetries. Its quadrant comes from cosine transforms (even) and sine transforms (odd) of the quadrant of its values:
  along x for rows of lags, then, rows exchanged for columns, along y. FFTW's own (REDFT00, RODFT00) take twice as long
  as a transform of the mirrored line, of which the real or the imaginary part is kept. A column of hy + 1 values is
  kept with its even frequencies first and its odd ones after them, as the filter meets them.
*/
#define Real   double
#define FFT(x) fftw_##x
#define LINE   SamLineDouble
#include "line.h"

struct _n_SamKernel {
  PetscBool odd_x, odd_y;
  ptrdiff_t columns; /* of this rank */
  double   *values;  /* (columns, hy + 1) */
};

/* Columns that are gathered together: two cache lines of each row are read at once. */
#define BLOCK ((ptrdiff_t)(128 / sizeof(double)))

/*
  The transform of lines given by their values at 0 ... n and a parity: that of half their length, which is planned in
  a fraction of the time of a real one.
*/
typedef struct {
  SamLineDouble half;
  PetscBool     odd;
  double       *line;   /* 2 n values, of which the caller sets n + 1 */
  double       *values; /* n + 1 of the transform */
  Complex      *pairs;  /* of the line's values, at the places of entries to be transformed */
  Complex      *z;      /* transform of the even values and i times the odd ones, n + 1 */
  Complex      *mirror; /* the same from its end to its beginning */
  Complex      *turn;   /* i exp(i pi k/n) */
} Mirrored;

static PetscErrorCode MirroredCreate(ptrdiff_t n, PetscBool odd, Mirrored *m)
{
  PetscFunctionBegin;
  *m = (Mirrored){.odd = odd};
  PetscCall(SamAllocate(sizeof(*m->line) * (size_t)(2 * n), &m->line));
  PetscCall(SamAllocate(sizeof(*m->values) * (size_t)(n + 1), &m->values));
  PetscCall(AllocateComplex((size_t)n, &m->pairs));
  PetscCall(AllocateComplex((size_t)(n + 1), &m->z));
  PetscCall(AllocateComplex((size_t)(n + 1), &m->mirror));
  PetscCall(CreateTurns(n, &m->turn));
  PetscCall(LineCreate(n, FFTW_ESTIMATE, PETSC_FALSE, m->pairs, m->z, &m->half));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void MirroredDestroy(Mirrored *m)
{
  LineDestroy(&m->half);
  SamFree(m->turn);
  SamFree(m->mirror);
  SamFree(m->z);
  SamFree(m->pairs);
  SamFree(m->values);
  SamFree(m->line);
}

/* The real part of a line's transform, all there is when it is even, or the imaginary part. */
SAM_VECTORIZED static void RealPart(ptrdiff_t n, const Complex *restrict turn, const Complex *restrict z,
                                    const Complex *restrict m, double *restrict to)
{
  for (ptrdiff_t k = 0; k <= n; k++)
    to[k] = 0.5 * (z[k][0] + m[k][0] + turn[k][0] * (z[k][0] - m[k][0]) + turn[k][1] * (z[k][1] + m[k][1]));
}
SAM_VECTORIZED static void ImaginaryPart(ptrdiff_t n, const Complex *restrict turn, const Complex *restrict z,
                                         const Complex *restrict m, double *restrict to)
{
  for (ptrdiff_t k = 0; k <= n; k++)
    to[k] = 0.5 * (z[k][1] - m[k][1] + turn[k][0] * (z[k][1] + m[k][1]) - turn[k][1] * (z[k][0] - m[k][0]));
}

/* The transform of an even line, or the imaginary part of an odd one's: n + 1 values. */
static const double *MirroredTransform(Mirrored *m)
{
  const ptrdiff_t n    = m->half.n;
  double         *line = m->line;

  if (m->odd) line[0] = line[n] = 0;
  for (ptrdiff_t j = 1; j < n; j++) line[2 * n - j] = m->odd ? -line[j] : line[j];
  LinePut(&m->half, n, (const Complex *)line, m->pairs);
  LineForward(&m->half, m->pairs, m->z);
  (void)memcpy(m->z[n], m->z[0], sizeof(Complex));
  Mirror(n, (const Complex *)m->z, m->mirror);
  if (m->odd)
    ImaginaryPart(n, (const Complex *)m->turn, (const Complex *)m->z, (const Complex *)m->mirror, m->values);
  else
    RealPart(n, (const Complex *)m->turn, (const Complex *)m->z, (const Complex *)m->mirror, m->values);
  return m->values;
}

/* Rows of lags of all kernels, transformed along x, into the slabs (local rows of hy + 1, hx + 1). */
static PetscErrorCode TransformRows(SamFourier F, PetscInt kernels, const PetscBool odd[][2], SamKernelRows rows,
                                    const void *context, ptrdiff_t start, ptrdiff_t count)
{
  const ptrdiff_t n = F->hx + 1;
  Mirrored        m[SAM_FOURIER_FIELDS];
  double         *lines[SAM_FOURIER_FIELDS], *to[SAM_FOURIER_FIELDS];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < kernels; k++) {
    PetscCall(MirroredCreate(F->hx, odd[k][0], &m[k]));
    lines[k] = m[k].line;
    to[k]    = (double *)SamFourierRows(F, k);
  }
  for (ptrdiff_t j = 0; j < count; j++) {
    rows((PetscInt)(start + j), (PetscInt)n, lines, context);
    for (PetscInt k = 0; k < kernels; k++) PetscCall(PetscArraycpy(to[k] + j * n, MirroredTransform(&m[k]), (size_t)n));
  }
  for (PetscInt k = 0; k < kernels; k++) MirroredDestroy(&m[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns k ... k + count - 1 of this rank into the buffer, where each is contiguous. */
static void Gather(const SamPieces *pieces, ptrdiff_t k, ptrdiff_t count, ptrdiff_t stride, double *restrict buffer)
{
  ptrdiff_t row = 0;

  for (PetscMPIInt r = 0; r < pieces->count; r++) {
    const ptrdiff_t rows        = SamPieceRows(pieces, r);
    const double *restrict data = (const double *)SamPieceData(pieces, r, sizeof(*data)) + k;

    for (ptrdiff_t j = 0; j < rows; j++, row++)
      for (ptrdiff_t b = 0; b < count; b++) buffer[b * stride + row] = data[j * pieces->row_length + b];
  }
}

/* Columns transformed along y, scaled and sorted into the kernel. */
static PetscErrorCode TransformColumns(SamFourier F, SamKernel kernel, const SamPieces *pieces)
{
  const ptrdiff_t n = F->hy + 1, even = F->hy / 2 + 1;
  const double    sign =
    (kernel->odd_x || kernel->odd_y) ? -1 : 1; /* odd in both: i^2; in one: Multiply's -i makes it 1 */
  const double scale = sign / (4.0 * (double)F->hx * (double)F->hy);
  double      *buffer;
  Mirrored     m;

  PetscFunctionBegin;
  PetscCall(MirroredCreate(F->hy, kernel->odd_y, &m));
  PetscCall(SamAllocate(sizeof(double) * (size_t)(BLOCK * F->stride), &buffer));
  for (ptrdiff_t k = 0; k < kernel->columns; k++) {
    double       *to = kernel->values + k * n;
    const double *from;

    if (k % BLOCK == 0) Gather(pieces, k, PetscMin(BLOCK, kernel->columns - k), F->stride, buffer);
    PetscCall(PetscArraycpy(m.line, buffer + k % BLOCK * F->stride, (size_t)n));
    from = MirroredTransform(&m);
    for (ptrdiff_t j = 0; j < even; j++) to[j] = scale * from[2 * j];
    for (ptrdiff_t j = even; j < n; j++) to[j] = scale * from[2 * (j - even) + 1];
  }
  MirroredDestroy(&m);
  SamFree(buffer);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The quadrant (hy + 1, hx + 1), of which each rank has rows, exchanged for own columns of all rows. */
static PetscErrorCode ExchangeRows(SamFourier F, double rows[], double columns[])
{
  fftw_plan plan;

  PetscFunctionBegin;
  plan =
    fftw_mpi_plan_many_transpose(F->hy + 1, F->hx + 1, 1, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, rows, columns,
                                 F->grid->comm, FFTW_ESTIMATE | FFTW_DESTROY_INPUT | FFTW_MPI_TRANSPOSED_OUT);
  PetscCall(SamFourierCheckPlan(plan));
  fftw_execute(plan);
  fftw_destroy_plan(plan);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKernelsCreate(SamFourier F, PetscInt n, const PetscBool odd[][2], SamKernelRows rows,
                                const void *context, SamKernel kernels[])
{
  ptrdiff_t count, start, columns, column_start;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_SETUP_INFLUENCE], 0, 0, 0, 0));
  (void)SamFourierDivideQuadrant(F, &count, &start, &columns, &column_start);
  PetscCall(SamWorkspaceReserve(F->work, F->bytes, n));
  PetscCall(TransformRows(F, n, odd, rows, context, start, count));
  for (PetscInt i = 0; i < n; i++) {
    const SamPieces pieces = SamFourierGetPieces(F, i, F->hy + 1, F->hx + 1, column_start, columns);
    SamKernel       k;

    PetscCall(PetscNew(&k));
    *k = (struct _n_SamKernel){.odd_x = odd[i][0], .odd_y = odd[i][1], .columns = columns};
    if (SamWorkspaceTransposes(F->work))
      PetscCall(ExchangeRows(F, (double *)SamFourierRows(F, i), (double *)pieces.single));
    PetscCall(SamWorkspaceSynchronize(F->work));
    PetscCall(SamAllocate(sizeof(double) * (size_t)(columns * (F->hy + 1)), &k->values));
    PetscCall(TransformColumns(F, k, &pieces));
    kernels[i] = k;
  }
  PetscCall(SamWorkspaceSynchronize(F->work));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_SETUP_INFLUENCE], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKernelDestroy(SamKernel *kernel)
{
  PetscFunctionBegin;
  if (!*kernel) PetscFunctionReturn(PETSC_SUCCESS);
  SamFree((*kernel)->values);
  PetscCall(PetscFree(*kernel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  One column in one phase: the kernel's values there, those of the first `rising` entries in order, the others
  mirrored.
*/
typedef struct {
  const double *values;
  ptrdiff_t     rising, mirror; /* entry m >= rising has the value at mirror - m, with the parity's sign */
} Column;

static Column GetColumn(SamKernel kernel, const SamFourierBlock *block, PetscInt phase, PetscInt b)
{
  const ptrdiff_t hy = block->hy, even = hy / 2 + 1;
  const double   *base = kernel->values + (block->local + b) * (hy + 1);

  if (phase == 0) return (Column){base, even, hy};
  return (Column){base + even, (hy + 1) / 2, hy - 1};
}

/* to += scale * kernel * from for one column; multiplied by -i when the kernel is odd in one direction only. */
static void AddProduct(SamKernel kernel, const SamFourierBlock *block, PetscInt phase, PetscInt b, double scale,
                       const double (*from)[2], double (*to)[2])
{
  const Column    c      = GetColumn(kernel, block, phase, b);
  const double    folded = kernel->odd_y ? -scale : scale;
  const PetscBool turn   = kernel->odd_x != kernel->odd_y ? PETSC_TRUE : PETSC_FALSE;

  for (ptrdiff_t m = 0; m < block->hy; m++) {
    const double k = m < c.rising ? scale * c.values[m] : folded * c.values[c.mirror - m];

    to[m][0] += turn ? k * from[m][1] : k * from[m][0];
    to[m][1] += turn ? -k * from[m][0] : k * from[m][1];
  }
}

/*
  Products in place, of either precision: one field by an even kernel, and two fields by a symmetric matrix of kernels
  whose off-diagonal one is odd in x and in y. Each column goes up the kernel's values and down again.
*/
#define DEFINE_PRODUCTS(Real, MultiplyColumn, MultiplyPair) \
  SAM_VECTORIZED static void MultiplyColumn(Column c, ptrdiff_t n, double factor, Real(*restrict column)[2]) \
  { \
    for (ptrdiff_t m = 0; m < c.rising; m++) { \
      const Real k = (Real)(factor * c.values[m]); \
\
      column[m][0] *= k; \
      column[m][1] *= k; \
    } \
    for (ptrdiff_t m = c.rising; m < n; m++) { \
      const Real k = (Real)(factor * c.values[c.mirror - m]); \
\
      column[m][0] *= k; \
      column[m][1] *= k; \
    } \
  } \
\
  SAM_VECTORIZED static void MultiplyPair(Column xx, Column xy, Column yy, ptrdiff_t n, double factor, \
                                          Real(*restrict x)[2], Real(*restrict y)[2]) \
  { \
    for (ptrdiff_t m = 0; m < xx.rising; m++) { \
      const Real kxx = (Real)(factor * xx.values[m]), kxy = (Real)(factor * xy.values[m]), \
                 kyy = (Real)(factor * yy.values[m]); \
      const Real x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1]; \
\
      x[m][0] = kxx * x0 + kxy * y0; \
      x[m][1] = kxx * x1 + kxy * y1; \
      y[m][0] = kxy * x0 + kyy * y0; \
      y[m][1] = kxy * x1 + kyy * y1; \
    } \
    for (ptrdiff_t m = xx.rising; m < n; m++) { \
      const ptrdiff_t l   = xx.mirror - m; \
      const Real      kxx = (Real)(factor * xx.values[l]), kxy = (Real)(-factor * xy.values[l]), \
                 kyy = (Real)(factor * yy.values[l]); \
      const Real x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1]; \
\
      x[m][0] = kxx * x0 + kxy * y0; \
      x[m][1] = kxx * x1 + kxy * y1; \
      y[m][0] = kxy * x0 + kyy * y0; \
      y[m][1] = kxy * x1 + kyy * y1; \
    } \
  }

DEFINE_PRODUCTS(double, MultiplyColumn, MultiplyPair)
DEFINE_PRODUCTS(float, MultiplyColumnSingle, MultiplyPairSingle)

static PetscBool IsScalar(const SamKernelMatrix *M)
{
  return (M->n_in == 1 && M->n_out == 1 && M->scale[0][0] == 1 && M->kernel[0][0]->odd_x == M->kernel[0][0]->odd_y &&
          !M->kernel[0][0]->odd_y)
           ? PETSC_TRUE
           : PETSC_FALSE;
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

typedef struct {
  const SamKernelMatrix *matrix;
  double                 factor;
  PetscBool              scalar, pair;
  double (*column[SAM_FOURIER_FIELDS])[2]; /* work space of the general case */
} Factors;

/* Any matrix: the output columns are gathered aside and then take the inputs' place. */
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

static void Multiply(const SamFourierBlock *block, const void *context)
{
  const Factors         *factors = (const Factors *)context;
  const SamKernelMatrix *M       = factors->matrix;

  for (PetscInt f = 0; f < block->phases; f++)
    for (PetscInt b = 0; b < block->columns; b++) {
      const ptrdiff_t offset = (f * block->width + b) * (ptrdiff_t)block->stride, n = block->hy;

      if (factors->scalar) {
        const Column c = GetColumn(M->kernel[0][0], block, f, b);

        if (block->data[0])
          MultiplyColumn(c, n, factors->factor, block->data[0] + offset);
        else
          MultiplyColumnSingle(c, n, factors->factor, block->single[0] + offset);
      } else if (factors->pair) {
        const Column xx = GetColumn(M->kernel[0][0], block, f, b), xy = GetColumn(M->kernel[0][1], block, f, b),
                     yy = GetColumn(M->kernel[1][1], block, f, b);

        if (block->data[0])
          MultiplyPair(xx, xy, yy, n, factors->factor, block->data[0] + offset, block->data[1] + offset);
        else
          MultiplyPairSingle(xx, xy, yy, n, factors->factor, block->single[0] + offset, block->single[1] + offset);
      } else
        MultiplyGeneral(factors, block, f, b);
    }
}

static SamFourierFilter NewFilter(const Factors *factors)
{
  return (SamFourierFilter){.mode    = SAM_FOURIER_PADDED,
                            .n_in    = factors->matrix->n_in,
                            .n_out   = factors->matrix->n_out,
                            .apply   = Multiply,
                            .context = factors};
}

PetscErrorCode SamConvolve(SamFourier F, const SamKernelMatrix *matrix, const double *const in[], double *const out[])
{
  Factors factors = {.matrix = matrix, .factor = 1, .scalar = IsScalar(matrix), .pair = IsSymmetricPair(matrix)};
  const SamFourierFilter filter = NewFilter(&factors);

  PetscFunctionBegin;
  if (!factors.scalar && !factors.pair)
    for (PetscInt o = 0; o < matrix->n_out; o++)
      PetscCall(SamAllocate(sizeof(*factors.column[o]) * (size_t)F->hy, &factors.column[o]));
  PetscCall(SamFourierApply(F, &filter, in, out));
  for (PetscInt o = 0; o < matrix->n_out; o++) SamFree(factors.column[o]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConvolveSingle(SamFourier F, const SamKernelMatrix *matrix, double factor, const float *const in[],
                                 float *const out[])
{
  const Factors factors = {
    .matrix = matrix, .factor = factor, .scalar = IsScalar(matrix), .pair = IsSymmetricPair(matrix)};
  const SamFourierFilter filter = NewFilter(&factors);

  PetscFunctionBegin;
  PetscCheck(factors.scalar || factors.pair, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "Convolution in single precision: one even kernel, or a symmetric pair");
  PetscCall(SamFourierApplySingle(F, &filter, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

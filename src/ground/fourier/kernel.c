/*
  Kernels are tabulated, transformed, and stored in the order in which the filter uses them.

  A kernel that is even or odd in x and in y has a real (or, odd in just one, imaginary) transform with the same
  symmetries. Its quadrant comes from cosine transforms (even) and sine transforms (odd) of the quadrant of its values:
  first along x for rows of lags, then, after an exchange of rows for columns, along y. FFTW's own functions (REDFT00,
  RODFT00) take twice as long as a transform of the mirrored line, whose real or imaginary part is used. A column of hy
  + 1 values is stored with its even frequencies first, then its odd ones, as the filter uses them.
*/
#define Real   double
#define FFT(x) fftw_##x
#define LINE   SamLineDouble
#include "line.h"

/* Number of columns gathered together: two cache lines of each row are read at once */
#define BLOCK ((ptrdiff_t)(128 / sizeof(double)))

/*
  The transform of lines given by their values at 0 ... n and a parity. It is computed by a complex transform of half
  the length, which FFTW plans in a fraction of the time of a real one.
*/
typedef struct {
  SamLineDouble half;
  PetscBool     odd;
  double       *line;   /* 2 n values; the caller sets n + 1 */
  double       *values; /* n + 1 values of the transform */
  Complex      *pairs;  /* pairs of the line's values, at the places of the transform's input */
  Complex      *z;      /* transform of the even values and i times the odd values, n + 1 */
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

/* Extracts the real part of a line's transform, which is everything if the line is even, or the imaginary part. */
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

/* Returns the transform of an even line, or the imaginary part of the transform of an odd line: n + 1 values. */
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

/* Writes rows of lags of all kernels, transformed along x, to the slabs (local rows of hy + 1, hx + 1). */
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

/* Gathers columns k ... k + count - 1 of this rank in the buffer, where each is contiguous. */
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

/* Transforms columns along y, scales them and sorts them into the kernel. */
static PetscErrorCode TransformColumns(SamFourier F, SamKernel kernel, const SamPieces *pieces)
{
  const ptrdiff_t n = F->hy + 1, even = F->hy / 2 + 1;
  const double    sign =
    (kernel->odd_x || kernel->odd_y) ? -1 : 1; /* odd in both: i^2; odd in one: the -i of Multiply makes it 1 */
  const double scale = sign / ((double)(1 << F->grid->axes) * (double)F->hx * (double)F->hy);
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
    if (F->row) {
      kernel->values[k] = scale * from[0];
      continue;
    }
    for (ptrdiff_t j = 0; j < even; j++) to[j] = scale * from[2 * j];
    for (ptrdiff_t j = even; j < n; j++) to[j] = scale * from[2 * (j - even) + 1];
  }
  MirroredDestroy(&m);
  SamFree(buffer);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Exchanges the quadrant (hy + 1, hx + 1), in which each rank has rows, so that each rank has columns of all rows. */
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

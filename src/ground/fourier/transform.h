/*
  The transform in one precision. The file is included with these definitions:
    Real     double or float
    FFT(x)   fftw_x or fftwf_x
    LINE     the type SamLine...
    TRANSFORM, PART   the type SamTransform..., and its place in SamFourier
    DATA     the block's array of that precision
    DESTROY, APPLY    names of the two functions that others call
  See fourier.c for the steps.
*/
#include "line.h"

/* Number of columns transformed together: two cache lines of each row are read and written at once */
#define BLOCK ((ptrdiff_t)(128 / sizeof(Complex)))

static inline ptrdiff_t HalfLength(SamFourier F, SamFourierMode mode)
{
  return mode == SAM_FOURIER_PADDED ? F->hx : F->hx / 2;
}

/* True if a row is periodic and of odd length, so that it cannot be halved. */
static inline PetscBool IsOdd(SamFourier F, SamFourierMode mode)
{
  return mode == SAM_FOURIER_PERIODIC && F->hx % 2;
}

/*
  Creates all one-dimensional plans and buffers, except the plans of rows, which are made when a mode is first used: on
  small grids planning takes most of the time.
*/
static PetscErrorCode PlanLines(SamFourier F)
{
  TRANSFORM *t = &F->PART;

  PetscFunctionBegin;
  PetscCall(AllocateComplex((size_t)F->hx, &t->row));
  PetscCall(AllocateComplex((size_t)(F->hx + 1), &t->line));
  PetscCall(AllocateComplex((size_t)(F->hx + 1), &t->mirror));
  PetscCall(AllocateComplex((size_t)(BLOCK * F->stride), &t->staging));
  PetscCall(AllocateComplex((size_t)F->stride, &t->twisted));
  PetscCall(LineCreate(F->hy, F->effort, PETSC_TRUE, t->twisted, t->staging, &t->column));
  PetscCall(AllocateComplex((size_t)F->hy, &t->twiddle));
  for (PetscInt j = 0; j < F->grid->ny; j++) {
    Real  *twiddle = t->twiddle[LinePlace(&t->column, j)];
    double root[2];

    SamRootOfUnity(j, F->hy, root);
    twiddle[0] = (Real)root[0];
    twiddle[1] = (Real)-root[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void DestroyTransposes(TRANSFORM *t)
{
  for (PetscInt m = 0; m < 2; m++) {
    for (PetscInt k = 0; k < SAM_FOURIER_FIELDS; k++) {
      if (t->forward[m][k]) FFT(destroy_plan)(t->forward[m][k]);
      if (t->backward[m][k]) FFT(destroy_plan)(t->backward[m][k]);
      t->forward[m][k] = t->backward[m][k] = NULL;
    }
  }
}

void DESTROY(SamFourier F)
{
  TRANSFORM *t = &F->PART;

  if (!t->row) return;
  DestroyTransposes(t);
  for (PetscInt m = 0; m < 2; m++) {
    LineDestroy(&t->rows[m]);
    SamFree(t->turn[m]);
  }
  LineDestroy(&t->column);
  SamFree(t->buffer);
  SamFree(t->twiddle);
  SamFree(t->twisted);
  SamFree(t->staging);
  SamFree(t->row);
  SamFree(t->line);
  SamFree(t->mirror);
  memset(t, 0, sizeof(*t));
}

/*
  Each transpose writes, out of place, to the slab that the transpose before has emptied: fields are processed upwards
  in the forward direction, downwards in the backward direction.
*/
static PetscErrorCode PlanTransposes(SamFourier F, SamFourierMode mode, PetscInt fields)
{
  TRANSFORM      *t       = &F->PART;
  const ptrdiff_t columns = F->columns[mode].n;
  const unsigned  flags   = FFTW_ESTIMATE | FFTW_DESTROY_INPUT; /* measuring takes seconds and gains little here */

  PetscFunctionBegin;
  for (PetscInt k = 0; k < fields; k++) {
    Real *by_row = (Real *)F->work->slab[k + 1].own, *by_column = (Real *)F->work->slab[k].own;

    t->forward[mode][k] =
      FFT(mpi_plan_many_transpose)(F->grid->ny, columns, 2, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, by_row,
                                   by_column, F->grid->comm, flags | FFTW_MPI_TRANSPOSED_OUT);
    t->backward[mode][k] =
      FFT(mpi_plan_many_transpose)(columns, F->grid->ny, 2, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, by_column,
                                   by_row, F->grid->comm, flags | FFTW_MPI_TRANSPOSED_IN);
    PetscCall(SamFourierCheckPlan(t->forward[mode][k]));
    PetscCall(SamFourierCheckPlan(t->backward[mode][k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates the buffers for that many fields, and the plans of the mode. */
static PetscErrorCode Reserve(SamFourier F, SamFourierMode mode, PetscInt fields)
{
  TRANSFORM      *t   = &F->PART;
  const PetscBool odd = IsOdd(F, mode);

  PetscFunctionBegin;
  if (!t->row) PetscCall(PlanLines(F));
  if (!t->rows[mode].n && !odd) PetscCall(CreateTurns(HalfLength(F, mode), &t->turn[mode]));
  if (!t->rows[mode].n)
    PetscCall(LineCreate(odd ? F->hx : HalfLength(F, mode), F->effort, PETSC_TRUE, t->row, t->line, &t->rows[mode]));
  if (fields > t->fields) {
    SamFree(t->buffer);
    PetscCall(AllocateComplex((size_t)(fields * 2 * BLOCK) * (size_t)F->stride, &t->buffer));
    t->fields  = fields;
    t->version = -1;
  }
  PetscCall(SamWorkspaceReserve(F->work, F->bytes, t->fields));
  if (!SamWorkspaceTransposes(F->work) || t->version == F->work->version) PetscFunctionReturn(PETSC_SUCCESS);
  DestroyTransposes(t);
  PetscCall(PlanTransposes(F, SAM_FOURIER_PERIODIC, t->fields));
  PetscCall(PlanTransposes(F, SAM_FOURIER_PADDED, t->fields));
  t->version = F->work->version;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the transform of a line from the transform z of its even entries and i times its odd entries; m is the mirror
  of z.
*/
SAM_VECTORIZED static void Unpack(ptrdiff_t n, const Complex *restrict turn, const Complex *restrict z,
                                  const Complex *restrict m, Complex *restrict to)
{
  const Real half = (Real)0.5;

  for (ptrdiff_t k = 0; k <= n; k++) {
    const Real sum[2] = {z[k][0] + m[k][0], z[k][1] - m[k][1]}, gap[2] = {z[k][0] - m[k][0], z[k][1] + m[k][1]};

    to[k][0] = half * (sum[0] + turn[k][0] * gap[0] + turn[k][1] * gap[1]);
    to[k][1] = half * (sum[1] + turn[k][0] * gap[1] - turn[k][1] * gap[0]);
  }
}

/* Inverts Unpack(); the result is multiplied by 2. */
SAM_VECTORIZED static void Pack(ptrdiff_t n, const Complex *restrict turn, const Complex *restrict z,
                                const Complex *restrict m, Complex *restrict to)
{
  for (ptrdiff_t k = 0; k < n; k++) {
    const Real sum[2] = {z[k][0] + m[k][0], z[k][1] - m[k][1]}, gap[2] = {z[k][0] - m[k][0], z[k][1] + m[k][1]};

    to[k][0] = sum[0] + turn[k][0] * gap[0] - turn[k][1] * gap[1];
    to[k][1] = sum[1] + turn[k][0] * gap[1] + turn[k][1] * gap[0];
  }
}

/* Transforms rows of an odd period, nx = hx, as complex numbers, and keeps the first half of the result. */
static void OddRowsForward(SamFourier F, const Real field[], Complex *slab)
{
  TRANSFORM      *t  = &F->PART;
  const ptrdiff_t nx = F->hx, n = nx / 2 + 1;

  for (ptrdiff_t j = 0; j < F->grid->rows; j++) {
    for (ptrdiff_t i = 0; i < nx; i++) {
      t->row[i][0] = field[j * nx + i];
      t->row[i][1] = 0;
    }
    LineForward(&t->rows[SAM_FOURIER_PERIODIC], t->row, t->line);
    memcpy(slab + j * n, t->line, sizeof(Complex) * (size_t)n);
  }
}

static void OddRowsBackward(SamFourier F, const Complex *slab, Real field[])
{
  TRANSFORM      *t  = &F->PART;
  const ptrdiff_t nx = F->hx, n = nx / 2 + 1;

  for (ptrdiff_t j = 0; j < F->grid->rows; j++) {
    memcpy(t->line, slab + j * n, sizeof(Complex) * (size_t)n);
    t->line[0][1] = 0; /* rounding must not differ from a transform of real numbers */
    for (ptrdiff_t k = 1; k < n; k++) {
      t->line[nx - k][0] = t->line[k][0];
      t->line[nx - k][1] = -t->line[k][1];
    }
    LineBackward(&t->rows[SAM_FOURIER_PERIODIC], t->line, t->row);
    for (ptrdiff_t i = 0; i < nx; i++) field[j * nx + i] = t->row[i][0];
  }
}

/* True if a row has nothing but zeros, as most rows of tractions beside a contact. */
static inline PetscBool IsEmptyRow(ptrdiff_t n, const Real row[])
{
  return row[0] == 0 && !memcmp(row, row + 1, sizeof(Real) * (size_t)(n - 1)) ? PETSC_TRUE : PETSC_FALSE;
}

static void RowsForward(SamFourier F, SamFourierMode mode, const Real field[], Complex *slab)
{
  TRANSFORM      *t  = &F->PART;
  const ptrdiff_t n  = HalfLength(F, mode);
  const ptrdiff_t nx = F->grid->nx, last = LinePlace(&t->rows[mode], nx / 2);

  if (IsOdd(F, mode)) {
    OddRowsForward(F, field, slab);
    return;
  }
  LineClear(&t->rows[mode], nx / 2, t->row);
  for (PetscInt j = 0; j < F->grid->rows; j++) {
    if (IsEmptyRow(nx, field + j * nx)) {
      memset(slab + j * (n + 1), 0, sizeof(Complex) * (size_t)(n + 1));
      continue;
    }
    LinePut(&t->rows[mode], nx / 2, (const Complex *)(field + j * nx), t->row);
    if (nx % 2) t->row[last][0] = field[(j + 1) * nx - 1];
    LineForward(&t->rows[mode], t->row, t->line);
    memcpy(t->line[n], t->line[0], sizeof(Complex));
    Mirror(n, (const Complex *)t->line, t->mirror);
    Unpack(n, (const Complex *)t->turn[mode], (const Complex *)t->line, (const Complex *)t->mirror, slab + j * (n + 1));
  }
}

static void RowsBackward(SamFourier F, SamFourierMode mode, Complex *slab, Real field[])
{
  TRANSFORM      *t  = &F->PART;
  const ptrdiff_t n  = HalfLength(F, mode);
  const ptrdiff_t nx = F->grid->nx, last = LinePlace(&t->rows[mode], nx / 2);

  if (IsOdd(F, mode)) {
    OddRowsBackward(F, (const Complex *)slab, field);
    return;
  }
  for (PetscInt j = 0; j < F->grid->rows; j++) {
    Complex *line = slab + j * (n + 1);

    line[0][1] = line[n][1] = 0; /* rounding must not differ from a transform of real numbers */
    Mirror(n, (const Complex *)line, t->mirror);
    Pack(n, (const Complex *)t->turn[mode], (const Complex *)line, (const Complex *)t->mirror, t->line);
    LineBackward(&t->rows[mode], t->line, t->row);
    LineTake(&t->rows[mode], nx / 2, (const Complex *)t->row, (Complex *)(field + j * nx));
    if (nx % 2) field[(j + 1) * nx - 1] = t->row[last][0];
  }
}

/* Computes to[j] = from[j] * exp(-i pi j/hy), the column whose transform has the odd frequencies. */
SAM_VECTORIZED static void Twist(ptrdiff_t n, const Complex *restrict twiddle, const Complex *restrict from,
                                 Complex *restrict to)
{
  for (ptrdiff_t j = 0; j < n; j++) {
    to[j][0] = from[j][0] * twiddle[j][0] - from[j][1] * twiddle[j][1];
    to[j][1] = from[j][0] * twiddle[j][1] + from[j][1] * twiddle[j][0];
  }
}

/* Computes even[j] += odd[j] * exp(i pi j/hy). */
SAM_VECTORIZED static void Untwist(ptrdiff_t n, const Complex *restrict twiddle, const Complex *restrict odd,
                                   Complex *restrict even)
{
  for (ptrdiff_t j = 0; j < n; j++) {
    even[j][0] += odd[j][0] * twiddle[j][0] + odd[j][1] * twiddle[j][1];
    even[j][1] += odd[j][1] * twiddle[j][0] - odd[j][0] * twiddle[j][1];
  }
}

/* Gathers columns of a slab, beginning with this rank's k-th, one after the other in the buffer. */
static void Gather(const LINE *line, const SamPieces *pieces, ptrdiff_t k, ptrdiff_t count, ptrdiff_t stride,
                   Complex *restrict buffer)
{
  for (PetscMPIInt r = 0; r < pieces->count; r++) {
    const ptrdiff_t rows = SamPieceRows(pieces, r), row_length = pieces->row_length;
    const Complex *restrict slab = (const Complex *)SamPieceData(pieces, r, sizeof(Complex)) + k;

    for (ptrdiff_t j = 0; j < rows; j++) {
      Complex *restrict to = buffer + LinePlace(line, r * pieces->block + j);

      for (ptrdiff_t b = 0; b < count; b++) memcpy(to[b * stride], slab[j * row_length + b], sizeof(Complex));
    }
  }
}

static void Scatter(const LINE *line, const SamPieces *pieces, ptrdiff_t k, ptrdiff_t count, ptrdiff_t stride,
                    const Complex *restrict buffer)
{
  for (PetscMPIInt r = 0; r < pieces->count; r++) {
    const ptrdiff_t rows = SamPieceRows(pieces, r), row_length = pieces->row_length;
    Complex *restrict slab = (Complex *)SamPieceData(pieces, r, sizeof(Complex)) + k;

    for (ptrdiff_t j = 0; j < rows; j++) {
      const Complex *restrict from = buffer + LinePlace(line, r * pieces->block + j);

      for (ptrdiff_t b = 0; b < count; b++) memcpy(slab[j * row_length + b], from[b * stride], sizeof(Complex));
    }
  }
}

/* Gathers columns, pads them and transforms them; then ColumnsBackward() inverts it. Out of place, which is faster in
   FFTW. */
static void ColumnsForward(SamFourier F, PetscInt phases, const SamPieces *pieces, ptrdiff_t k, ptrdiff_t count,
                           Complex *buffer)
{
  TRANSFORM  *t    = &F->PART;
  const LINE *line = &t->column;

  Gather(line, pieces, k, count, F->stride, t->staging);
  for (ptrdiff_t b = 0; b < count; b++) {
    Complex *staged = t->staging + b * F->stride, *even = buffer + b * F->stride, *odd = even + BLOCK * F->stride;

    LineClear(line, F->grid->ny, staged);
    LineForward(line, staged, even);
    if (phases == 1) continue;
    for (ptrdiff_t q = 0; q < LineParts(line); q++)
      Twist(LineCount(line, F->grid->ny, q), (const Complex *)t->twiddle + q * line->part,
            (const Complex *)staged + q * line->part, t->twisted + q * line->part);
    LineClear(line, F->grid->ny, t->twisted);
    LineForward(line, t->twisted, odd);
  }
}

static void ColumnsBackward(SamFourier F, PetscInt phases, const SamPieces *pieces, ptrdiff_t k, ptrdiff_t count,
                            Complex *buffer)
{
  TRANSFORM  *t    = &F->PART;
  const LINE *line = &t->column;

  for (ptrdiff_t b = 0; b < count; b++) {
    Complex *staged = t->staging + b * F->stride, *even = buffer + b * F->stride, *odd = even + BLOCK * F->stride;

    LineBackward(line, even, staged);
    if (phases == 1) continue;
    LineBackward(line, odd, t->twisted);
    for (ptrdiff_t q = 0; q < LineParts(line); q++)
      Untwist(LineCount(line, F->grid->ny, q), (const Complex *)t->twiddle + q * line->part,
              (const Complex *)t->twisted + q * line->part, staged + q * line->part);
  }
  Scatter(line, pieces, k, count, F->stride, (const Complex *)t->staging);
}

/* Filters the spectra of a grid of one row in place. */
static void FilterRow(SamFourier F, const SamFourierFilter *filter)
{
  const SamColumns *c     = &F->columns[filter->mode];
  SamFourierBlock   block = {.mode    = filter->mode,
                             .phases  = 1,
                             .hx      = (PetscInt)F->hx,
                             .hy      = 1,
                             .first   = (PetscInt)c->start,
                             .columns = (PetscInt)c->count,
                             .width   = (PetscInt)c->count,
                             .stride  = 1};

  for (PetscInt i = 0; i < PetscMax(filter->n_in, filter->n_out); i++) {
    const SamPieces pieces = SamFourierGetPieces(F, i, 1, c->n, c->start, c->count);

    block.DATA[i] = (Complex *)SamPieceData(&pieces, 0, sizeof(Complex));
  }
  filter->apply(&block, filter->context);
}

static void Columns(SamFourier F, const SamFourierFilter *filter)
{
  const SamFourierMode mode  = filter->mode;
  TRANSFORM           *t     = &F->PART;
  const SamColumns    *c     = &F->columns[mode];
  SamFourierBlock      block = {.mode   = mode,
                                .phases = mode == SAM_FOURIER_PADDED ? 2 : 1,
                                .hx     = (PetscInt)F->hx,
                                .hy     = (PetscInt)F->hy,
                                .width  = BLOCK,
                                .stride = F->stride};
  SamPieces            pieces[SAM_FOURIER_FIELDS];

  for (PetscInt i = 0; i < PetscMax(filter->n_in, filter->n_out); i++)
    pieces[i] = SamFourierGetPieces(F, i, F->grid->ny, c->n, c->start, c->count);
  for (PetscInt k = 0; k < t->fields; k++) block.DATA[k] = t->buffer + k * 2 * BLOCK * (ptrdiff_t)F->stride;
  for (ptrdiff_t k = 0; k < c->count; k += BLOCK) {
    const ptrdiff_t count = PetscMin(BLOCK, c->count - k);

    for (PetscInt i = 0; i < filter->n_in; i++) ColumnsForward(F, block.phases, &pieces[i], k, count, block.DATA[i]);
    block.first   = (PetscInt)(c->start + k);
    block.local   = (PetscInt)k;
    block.columns = (PetscInt)count;
    filter->apply(&block, filter->context);
    for (PetscInt o = 0; o < filter->n_out; o++) ColumnsBackward(F, block.phases, &pieces[o], k, count, block.DATA[o]);
  }
}

PetscErrorCode APPLY(SamFourier F, const SamFourierFilter *filter, const Real *const in[], Real *const out[])
{
  const SamFourierMode mode = filter->mode;
  const PetscInt       n_in = filter->n_in, n_out = filter->n_out;
  TRANSFORM           *t = &F->PART;
  PetscBool            transposes;

  PetscFunctionBegin;
  PetscCall(Reserve(F, mode, PetscMax(n_in, n_out)));
  transposes = SamWorkspaceTransposes(F->work);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  for (PetscInt i = 0; i < n_in; i++) RowsForward(F, mode, in[i], (Complex *)SamFourierRows(F, i));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  if (F->work->ranks > 1) {
    PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
    for (PetscInt i = 0; i < n_in && transposes; i++) FFT(execute)(t->forward[mode][i]);
    PetscCall(SamWorkspaceSynchronize(F->work));
    PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
  }
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_COLUMNS], 0, 0, 0, 0));
  if (F->row)
    FilterRow(F, filter);
  else
    Columns(F, filter);
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_COLUMNS], 0, 0, 0, 0));
  if (F->work->ranks > 1) {
    PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
    for (PetscInt o = n_out - 1; o >= 0 && transposes; o--) FFT(execute)(t->backward[mode][o]);
    PetscCall(SamWorkspaceSynchronize(F->work));
    PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
  }
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  for (PetscInt o = 0; o < n_out; o++) RowsBackward(F, mode, (Complex *)SamFourierRows(F, o), out[o]);
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The distributed pruned transform.

  A filter in the frequency domain needs the two-dimensional transform of a field that is zero beyond its ny rows and nx
  columns, and of the result only those rows and columns. So:
    1. each of the ny rows is padded with zeros in a buffer and transformed (real to half complex);
    2. rows are exchanged for columns (FFTW's distributed transpose; nothing to do on one rank);
    3. a few columns at a time are gathered into a buffer that stays in cache. There the padding along y is done by
       splitting the 2 hy frequencies: the even ones are the transform of length hy of the column, the odd ones that of
       the column times exp(-i pi j/hy). No zero is ever transformed. The filter acts, the way back is the same;
    4. columns are exchanged for rows, 5. rows are transformed back and cut.
  In periodic mode rows are padded to hx instead of 2 hx only, and columns have the even frequencies only.

  Both directions of the exchange leave the data as (ny rows, own columns) in row order (FFTW_MPI_TRANSPOSED_OUT), which
  is what one rank has from the start, so that one code serves any number of ranks.
*/
#include "fourierimpl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static const char *const efforts[] = {"auto", "estimate", "measure", "patient", NULL};

/* From this length on FFTW's estimated plans are clearly slower than measured ones, which take some 0.2 s each. */
#define MEASURE_FROM 4096
/* Below this, measuring costs more than all transforms of a coarse grid. */
#define ESTIMATE_BELOW 300

PetscErrorCode SamFourierAllocate(size_t bytes, void *pointer)
{
  const size_t huge      = (size_t)2 << 20;
  const size_t alignment = bytes >= huge ? huge : 64;
  void        *p         = NULL;

  PetscFunctionBegin;
  PetscCheck(!posix_memalign(&p, alignment, PetscMax(bytes, 64)), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for %zu bytes", bytes);
#if defined(MADV_HUGEPAGE)
  /* columns touch every row: with small pages most of the time would go into looking up addresses */
  if (bytes >= huge) (void)madvise(p, bytes, MADV_HUGEPAGE);
#endif
  *(void **)pointer = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsSmooth(ptrdiff_t n)
{
  for (ptrdiff_t p = 2; p <= 7; p++)
    while (n % p == 0) n /= p;
  return n == 1 ? PETSC_TRUE : PETSC_FALSE;
}

/*
  A length >= n for which FFTW is fast: prime factors up to 7 only, and many twos among them. The weights are the times a
  cell measured from 300 to 640 cells: 384 takes less time than 360, 512 less than 500.
*/
static ptrdiff_t FastSize(ptrdiff_t n)
{
  ptrdiff_t best      = n;
  double    best_cost = PETSC_MAX_REAL;

  for (ptrdiff_t m = n; (double)m < best_cost; m++) {
    const double weight = m % 64 == 0 ? 1 : (m % 16 == 0 ? 1.1 : (m % 8 == 0 ? 1.25 : 1.4));

    if (!IsSmooth(m) || weight * (double)m >= best_cost) continue;
    best      = m;
    best_cost = n < 64 ? (double)m : weight * (double)m; /* small ones are fast anyway */
  }
  return best;
}

static PetscErrorCode CheckPlan(fftw_plan plan)
{
  PetscFunctionBegin;
  PetscCheck(plan, PETSC_COMM_SELF, PETSC_ERR_LIB, "FFTW could not make a plan");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Plans of one row, forward out of place into a row of a slab, backward from there. */
static PetscErrorCode PlanRows(SamFourier F, SamFourierMode mode)
{
  SamColumns  *c      = &F->columns[mode];
  const int    period = (int)(mode == SAM_FOURIER_PADDED ? 2 * F->hx : F->hx);
  fftw_complex *line   = NULL;

  PetscFunctionBegin;
  c->n = period / 2 + 1;
  PetscCall(SamFourierAllocate(sizeof(fftw_complex) * (size_t)c->n, &line));
  c->r2c = fftw_plan_dft_r2c_1d(period, F->row, line, F->effort);
  c->c2r = fftw_plan_dft_c2r_1d(period, line, F->row, F->effort | FFTW_DESTROY_INPUT);
  free(line);
  PetscCall(CheckPlan(c->r2c));
  PetscCall(CheckPlan(c->c2r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which columns are whose, and how many doubles FFTW wants for a slab. */
static PetscErrorCode DivideColumns(SamFourier F, SamFourierMode mode, ptrdiff_t *doubles)
{
  SamColumns     *c       = &F->columns[mode];
  const ptrdiff_t size[2] = {F->grid->ny, c->n};
  ptrdiff_t       rows, row_start;

  PetscFunctionBegin;
  *doubles = fftw_mpi_local_size_many_transposed(2, size, 2, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, F->grid->comm, &rows, &row_start, &c->count, &c->start);
  PetscCheck(rows == F->grid->rows, PETSC_COMM_SELF, PETSC_ERR_PLIB, "FFTW gives this rank %td rows, the grid %" PetscInt_FMT, rows, F->grid->rows);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFourierCreate(SamGrid grid, SamFourier *fourier)
{
  SamFourier     F;
  PetscInt       effort         = 0;
  const unsigned flags[]        = {FFTW_ESTIMATE, FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT};

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&F));
  *fourier = F;
  PetscCall(SamOptionsEnum(NULL, "fft_effort", "FFTW's planning: auto, estimate, measure or patient", efforts, &effort, NULL));
  PetscCall(SamGridReference(grid));
  F->grid   = grid;
  F->effort = flags[effort];
  PetscCallMPI(MPI_Comm_size(grid->comm, &F->ranks));
  F->hx     = FastSize(grid->nx);
  F->hy     = FastSize(grid->ny);
  if (effort == 0 && PetscMax(F->hx, F->hy) >= MEASURE_FROM) F->effort = FFTW_MEASURE;
  if (effort == 2 && PetscMax(F->hx, F->hy) < ESTIMATE_BELOW) F->effort = FFTW_ESTIMATE;
  /* whole cache lines, and one more, so that the columns of a block do not compete for the same cache sets */
  F->stride = (PetscInt)(F->hy + 3) / 4 * 4 + 4;
  PetscCall(SamFourierAllocate(sizeof(double) * (size_t)(2 * F->hx + 2), &F->row));
  PetscCall(PlanRows(F, SAM_FOURIER_PERIODIC));
  PetscCall(PlanRows(F, SAM_FOURIER_PADDED));

  PetscCall(SamFourierAllocate(sizeof(*F->twiddle) * (size_t)grid->ny, &F->twiddle));
  for (PetscInt j = 0; j < grid->ny; j++) {
    F->twiddle[j][0] = cos(PETSC_PI * (double)j / (double)F->hy);
    F->twiddle[j][1] = -sin(PETSC_PI * (double)j / (double)F->hy);
  }
  PetscCall(SamFourierAllocate(sizeof(*F->staging) * (size_t)(COLUMN_BLOCK * F->stride), &F->staging));
  PetscCall(SamFourierAllocate(sizeof(*F->twisted) * (size_t)F->stride, &F->twisted));
  F->up   = fftw_plan_dft_1d((int)F->hy, (fftw_complex *)F->twisted, (fftw_complex *)F->staging, FFTW_FORWARD, F->effort | FFTW_DESTROY_INPUT);
  F->down = fftw_plan_dft_1d((int)F->hy, (fftw_complex *)F->twisted, (fftw_complex *)F->staging, FFTW_BACKWARD, F->effort | FFTW_DESTROY_INPUT);
  PetscCall(CheckPlan(F->up));
  PetscCall(CheckPlan(F->down));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyTransposes(SamFourier F)
{
  PetscFunctionBegin;
  for (PetscInt m = 0; m < 2; m++) {
    for (PetscInt k = 0; k < SAM_FOURIER_FIELDS; k++) {
      if (F->columns[m].forward[k]) fftw_destroy_plan(F->columns[m].forward[k]);
      if (F->columns[m].backward[k]) fftw_destroy_plan(F->columns[m].backward[k]);
      F->columns[m].forward[k] = F->columns[m].backward[k] = NULL;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFourierDestroy(SamFourier *fourier)
{
  SamFourier F = *fourier;

  PetscFunctionBegin;
  if (!F) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroyTransposes(F));
  for (PetscInt m = 0; m < 2; m++) {
    fftw_destroy_plan(F->columns[m].r2c);
    fftw_destroy_plan(F->columns[m].c2r);
  }
  fftw_destroy_plan(F->up);
  fftw_destroy_plan(F->down);
  for (PetscInt k = 0; k <= SAM_FOURIER_FIELDS; k++) free(F->slab[k]);
  free(F->buffer);
  free(F->twiddle);
  free(F->twisted);
  free(F->staging);
  free(F->row);
  PetscCall(SamGridDestroy(&F->grid));
  PetscCall(PetscFree(*fourier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFourierGetPeriods(SamFourier F, PetscInt *hx, PetscInt *hy)
{
  PetscFunctionBegin;
  *hx = (PetscInt)F->hx;
  *hy = (PetscInt)F->hy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  On several ranks field k has its rows in slab k + 1 and its columns in slab k: each transpose goes out of place into
  the slab that the one before has left. Forward runs through the fields upwards, backward downwards.
*/
static PetscInt RowSlab(SamFourier F, PetscInt field)
{
  return F->ranks > 1 ? field + 1 : field;
}

static PetscErrorCode PlanTransposes(SamFourier F, SamFourierMode mode, PetscInt fields)
{
  SamColumns    *c     = &F->columns[mode];
  const unsigned flags = FFTW_ESTIMATE | FFTW_DESTROY_INPUT; /* measuring takes seconds and gains little here */

  PetscFunctionBegin;
  for (PetscInt k = 0; k < fields; k++) {
    double *rows = F->slab[k + 1][0], *columns = F->slab[k][0];

    c->forward[k]  = fftw_mpi_plan_many_transpose(F->grid->ny, c->n, 2, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, rows, columns, F->grid->comm, flags | FFTW_MPI_TRANSPOSED_OUT);
    c->backward[k] = fftw_mpi_plan_many_transpose(c->n, F->grid->ny, 2, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, columns, rows, F->grid->comm, flags | FFTW_MPI_TRANSPOSED_IN);
    PetscCall(CheckPlan(c->forward[k]));
    PetscCall(CheckPlan(c->backward[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFourierReserve(SamFourier F, PetscInt fields)
{
  ptrdiff_t periodic, padded;

  PetscFunctionBegin;
  if (fields <= F->buffer_fields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(fields <= SAM_FOURIER_FIELDS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d fields in one pass", SAM_FOURIER_FIELDS);
  PetscCall(DivideColumns(F, SAM_FOURIER_PERIODIC, &periodic));
  PetscCall(DivideColumns(F, SAM_FOURIER_PADDED, &padded));
  for (PetscInt k = 0; k < fields + (F->ranks > 1 ? 1 : 0); k++)
    if (!F->slab[k]) PetscCall(SamFourierAllocate(sizeof(double) * (size_t)PetscMax(periodic, padded), &F->slab[k]));
  free(F->buffer);
  PetscCall(SamFourierAllocate(sizeof(*F->buffer) * (size_t)(fields * 2 * COLUMN_BLOCK) * (size_t)F->stride, &F->buffer));
  if (F->ranks > 1) {
    PetscCall(DestroyTransposes(F));
    PetscCall(PlanTransposes(F, SAM_FOURIER_PERIODIC, fields));
    PetscCall(PlanTransposes(F, SAM_FOURIER_PADDED, fields));
  }
  F->buffer_fields = fields;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void RowsForward(SamFourier F, SamFourierMode mode, const double field[], double (*slab)[2])
{
  const SamColumns *c      = &F->columns[mode];
  const ptrdiff_t   period = mode == SAM_FOURIER_PADDED ? 2 * F->hx : F->hx;
  const size_t      nx     = (size_t)F->grid->nx;

  memset(F->row + nx, 0, sizeof(double) * ((size_t)period - nx));
  for (PetscInt j = 0; j < F->grid->rows; j++) {
    memcpy(F->row, field + (size_t)j * nx, sizeof(double) * nx);
    fftw_execute_dft_r2c(c->r2c, F->row, (fftw_complex *)(slab + j * c->n));
  }
}

static void RowsBackward(SamFourier F, SamFourierMode mode, double (*slab)[2], double field[])
{
  const SamColumns *c  = &F->columns[mode];
  const size_t      nx = (size_t)F->grid->nx;

  for (PetscInt j = 0; j < F->grid->rows; j++) {
    fftw_execute_dft_c2r(c->c2r, (fftw_complex *)(slab + j * c->n), F->row);
    memcpy(field + (size_t)j * nx, F->row, sizeof(double) * nx);
  }
}

/* to[j] = from[j] * exp(-i pi j/hy): the column whose transform has the odd frequencies. */
SAM_VECTORIZED static void Twist(ptrdiff_t n, const double (*restrict twiddle)[2], const double (*restrict from)[2], double (*restrict to)[2])
{
  for (ptrdiff_t j = 0; j < n; j++) {
    to[j][0] = from[j][0] * twiddle[j][0] - from[j][1] * twiddle[j][1];
    to[j][1] = from[j][0] * twiddle[j][1] + from[j][1] * twiddle[j][0];
  }
}

/* even[j] += odd[j] * exp(i pi j/hy). */
SAM_VECTORIZED static void Untwist(ptrdiff_t n, const double (*restrict twiddle)[2], const double (*restrict odd)[2], double (*restrict even)[2])
{
  for (ptrdiff_t j = 0; j < n; j++) {
    even[j][0] += odd[j][0] * twiddle[j][0] + odd[j][1] * twiddle[j][1];
    even[j][1] += odd[j][1] * twiddle[j][0] - odd[j][0] * twiddle[j][1];
  }
}

/* Columns of a slab into the buffer, where each is contiguous. */
static void Gather(ptrdiff_t ny, ptrdiff_t row_length, ptrdiff_t count, ptrdiff_t stride, const double (*restrict slab)[2], double (*restrict buffer)[2])
{
  for (ptrdiff_t j = 0; j < ny; j++)
    for (ptrdiff_t b = 0; b < count; b++) memcpy(buffer[b * stride + j], slab[j * row_length + b], sizeof(*buffer));
}

static void Scatter(ptrdiff_t ny, ptrdiff_t row_length, ptrdiff_t count, ptrdiff_t stride, const double (*restrict buffer)[2], double (*restrict slab)[2])
{
  for (ptrdiff_t j = 0; j < ny; j++)
    for (ptrdiff_t b = 0; b < count; b++) memcpy(slab[j * row_length + b], buffer[b * stride + j], sizeof(*buffer));
}

/* Gathers columns, pads them and transforms them; then the way back. Out of place, which FFTW does faster. */
static void ColumnsForward(SamFourier F, PetscInt phases, ptrdiff_t row_length, ptrdiff_t count, const double (*slab)[2], double (*buffer)[2])
{
  const size_t ny = (size_t)F->grid->ny, padding = sizeof(*buffer) * ((size_t)F->hy - ny);

  Gather((ptrdiff_t)ny, row_length, count, F->stride, slab, F->staging);
  for (ptrdiff_t b = 0; b < count; b++) {
    double (*staged)[2] = F->staging + b * F->stride, (*even)[2] = buffer + b * F->stride, (*odd)[2] = even + COLUMN_BLOCK * F->stride;

    memset(staged + ny, 0, padding);
    fftw_execute_dft(F->up, (fftw_complex *)staged, (fftw_complex *)even);
    if (phases == 1) continue;
    Twist((ptrdiff_t)ny, (const double(*)[2])F->twiddle, (const double(*)[2])staged, F->twisted);
    memset(F->twisted + ny, 0, padding);
    fftw_execute_dft(F->up, (fftw_complex *)F->twisted, (fftw_complex *)odd);
  }
}

static void ColumnsBackward(SamFourier F, PetscInt phases, ptrdiff_t row_length, ptrdiff_t count, double (*buffer)[2], double (*slab)[2])
{
  for (ptrdiff_t b = 0; b < count; b++) {
    double (*staged)[2] = F->staging + b * F->stride, (*even)[2] = buffer + b * F->stride, (*odd)[2] = even + COLUMN_BLOCK * F->stride;

    fftw_execute_dft(F->down, (fftw_complex *)even, (fftw_complex *)staged);
    if (phases == 1) continue;
    fftw_execute_dft(F->down, (fftw_complex *)odd, (fftw_complex *)F->twisted);
    Untwist(F->grid->ny, (const double(*)[2])F->twiddle, (const double(*)[2])F->twisted, staged);
  }
  Scatter(F->grid->ny, row_length, count, F->stride, (const double(*)[2])F->staging, slab);
}

static void Columns(SamFourier F, SamFourierMode mode, PetscInt n_in, PetscInt n_out, SamFourierFilter filter, const void *context)
{
  const SamColumns *c      = &F->columns[mode];
  SamFourierBlock   block  = {.mode = mode, .phases = mode == SAM_FOURIER_PADDED ? 2 : 1, .hx = (PetscInt)F->hx, .hy = (PetscInt)F->hy, .width = COLUMN_BLOCK, .stride = F->stride};
  const ptrdiff_t   field  = 2 * COLUMN_BLOCK * (ptrdiff_t)F->stride;

  for (PetscInt k = 0; k < F->buffer_fields; k++) block.data[k] = F->buffer + k * field;
  for (ptrdiff_t k = 0; k < c->count; k += COLUMN_BLOCK) {
    const ptrdiff_t count = PetscMin(COLUMN_BLOCK, c->count - k);

    for (PetscInt i = 0; i < n_in; i++) ColumnsForward(F, block.phases, c->count, count, (const double(*)[2])F->slab[i] + k, block.data[i]);
    block.first   = (PetscInt)(c->start + k);
    block.local   = (PetscInt)k;
    block.columns = (PetscInt)count;
    filter(&block, context);
    for (PetscInt o = 0; o < n_out; o++) ColumnsBackward(F, block.phases, c->count, count, block.data[o], F->slab[o] + k);
  }
}

PetscErrorCode SamFourierApply(SamFourier F, SamFourierMode mode, PetscInt n_in, const double *const in[], PetscInt n_out, double *const out[], SamFourierFilter filter, const void *context)
{
  PetscFunctionBegin;
  PetscCall(SamFourierReserve(F, PetscMax(n_in, n_out)));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  for (PetscInt i = 0; i < n_in; i++) RowsForward(F, mode, in[i], F->slab[RowSlab(F, i)]);
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  if (F->ranks > 1) {
    PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
    for (PetscInt i = 0; i < n_in; i++) fftw_execute(F->columns[mode].forward[i]);
    PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
  }
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_COLUMNS], 0, 0, 0, 0));
  Columns(F, mode, n_in, n_out, filter, context);
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_COLUMNS], 0, 0, 0, 0));
  if (F->ranks > 1) {
    PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
    for (PetscInt o = n_out - 1; o >= 0; o--) fftw_execute(F->columns[mode].backward[o]);
    PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_TRANSPOSE], 0, 0, 0, 0));
  }
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  for (PetscInt o = 0; o < n_out; o++) RowsBackward(F, mode, F->slab[RowSlab(F, o)], out[o]);
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_FFT_ROWS], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

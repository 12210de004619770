/*
  The distributed pruned transform.

  A filter in the frequency domain needs the two-dimensional transform of a field that is zero beyond its ny rows and nx
  columns, and only these rows and columns of the result. So:
    1. Each of the ny rows is padded with zeros in a buffer and transformed, real to half complex. This uses a complex
       transform of half the length, which FFTW plans in a fraction of the time of a real one, and computes faster.
       Rows of zeros stay zeros.
    2. Ranks of one node access all rows in shared memory (workspace.c). Otherwise rows are exchanged for columns by
       FFTW's distributed transpose.
    3. A few columns at a time are gathered into a buffer that stays in cache. There the padding along y is done by
       splitting the 2 hy frequencies: the even ones are the transform of length hy of the column, the odd ones that of
       the column times exp(-i pi j/hy). Zeros are never transformed. Then the filter acts, and the same steps are
       reversed.
    4. Columns are exchanged for rows as in step 2.
    5. Rows are transformed back and shortened to nx.
  In periodic mode rows are padded to hx instead of 2 hx only, and columns have the even frequencies only. An odd hx,
  which only exact periods have, cannot be halved: a complex transform of the whole row is used.

  Both directions of the transpose leave the data as (ny rows, own columns) in row order (FFTW_MPI_TRANSPOSED_OUT),
  which is also the order on a single rank and, in pieces, in shared memory. So one code serves any number of ranks.

  The steps are in transform.h, and the transforms of single lines in line.h; both are compiled for double and for
  single precision. This file contains the code that both precisions share.
*/
#include "fourierimpl.h"
#include <petsam/private/grid.h>

/* For shorter lengths, measuring costs more than all transforms of a coarse grid. */
#define ESTIMATE_BELOW 300

static PetscBool IsSmooth(ptrdiff_t n)
{
  for (ptrdiff_t p = 2; p <= 7; p++)
    while (n % p == 0) n /= p;
  return n == 1;
}

/*
  Returns the cost of a length relative to its size. Lengths 2^a and 5 2^a are fast in FFTW's estimated plans, 3 2^a is
  somewhat slower, and all others take about twice as long. The numbers are square roots of the times per element of c2c
  transforms in both precisions, since the cost arises in two dimensions.
*/
static double Weight(ptrdiff_t m)
{
  while (m % 2 == 0) m /= 2;
  return m == 1 || m == 5 ? 1 : (m == 3 ? 1.12 : (m == 25 ? 1.25 : 1.45));
}

PetscInt SamFourierFastLength(PetscInt n)
{
  PetscInt best      = n;
  double   best_cost = PETSC_MAX_REAL;

  for (PetscInt m = n; (double)m < best_cost; m++) {
    const double cost = n < 64 ? (double)m : Weight(m) * (double)m; /* small lengths are always fast */

    if (m % 2 || !IsSmooth(m) || cost >= best_cost) continue;
    best      = m;
    best_cost = cost;
  }
  return best;
}

/* Determines the columns of this rank, and the number of reals that FFTW needs for a slab. */
static PetscErrorCode DivideColumns(SamFourier F, SamFourierMode mode, ptrdiff_t *reals)
{
  SamColumns *c = &F->columns[mode];
  ptrdiff_t   size[2];
  ptrdiff_t   rows, row_start;

  PetscFunctionBegin;
  c->n    = (mode == SAM_FOURIER_PADDED ? 2 * F->hx : F->hx) / 2 + 1;
  size[0] = F->grid->ny;
  size[1] = c->n;
  *reals  = fftw_mpi_local_size_many_transposed(2, size, 2, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK,
                                                F->grid->comm, &rows, &row_start, &c->count, &c->start);
  PetscCheck(rows == F->grid->rows, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "FFTW gives this rank %td rows, the grid %" PetscInt_FMT, rows, F->grid->rows);
  PetscFunctionReturn(PETSC_SUCCESS);
}

ptrdiff_t SamFourierDivideQuadrant(SamFourier F, ptrdiff_t *rows, ptrdiff_t *row_start, ptrdiff_t *columns,
                                   ptrdiff_t *column_start)
{
  const ptrdiff_t size[2] = {F->hy + 1, F->hx + 1};

  return fftw_mpi_local_size_many_transposed(2, size, 1, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, F->grid->comm,
                                             rows, row_start, columns, column_start);
}

PetscErrorCode SamFourierSettingsFromOptions(SamFourierSettings *settings, const SamOptions *from)
{
  static const SamOptionRow rows[] = {{"fft_effort", "FFTW's planning: estimate, measure or patient", SAM_OPTION_ENUM,
                                       offsetof(SamFourierSettings, effort), .words = "estimate,measure,patient"},
                                      {"fft_exchange",
                                       "between ranks of a node: auto (shared memory) or transpose (messages)",
                                       SAM_OPTION_BOOL, offsetof(SamFourierSettings, send), .words = "auto,transpose"}};

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(rows), settings, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns FFTW's flag for planning. */
static unsigned PlanningFlag(const SamFourierSettings *settings, ptrdiff_t largest)
{
  if (settings->effort == SAM_FOURIER_PATIENT) return FFTW_PATIENT;
  return settings->effort == SAM_FOURIER_MEASURE && largest >= ESTIMATE_BELOW ? FFTW_MEASURE : FFTW_ESTIMATE;
}

PetscErrorCode SamFourierCreate(SamGrid grid, SamFourierPeriod period, const SamFourierSettings *settings,
                                SamFourier *fourier)
{
  const SamFourierSettings usual = {.send = PETSC_FALSE};
  SamFourier               F;
  ptrdiff_t                periodic, padded, quadrant, rows, row_start, columns, column_start;
  unsigned long long       bytes;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(PetscNew(&F));
  *fourier = F;
  if (!settings) settings = &usual;
  PetscCall(SamGridReference(grid));
  F->grid   = grid;
  F->row    = SamGridIsRow(grid);
  F->hx     = period == SAM_FOURIER_EXACT ? (ptrdiff_t)grid->nx : SamFourierFastLength(grid->nx);
  F->hy     = period == SAM_FOURIER_EXACT || F->row ? (ptrdiff_t)grid->ny : SamFourierFastLength(grid->ny);
  F->effort = PlanningFlag(settings, PetscMax(F->hx, F->hy));
  /* Whole cache lines and one more, so that the columns of a block do not compete for the same cache sets. */
  F->stride = (PetscInt)(F->hy + 7) / 8 * 8 + 8;
  PetscCall(DivideColumns(F, SAM_FOURIER_PERIODIC, &periodic));
  PetscCall(DivideColumns(F, SAM_FOURIER_PADDED, &padded));
  quadrant = SamFourierDivideQuadrant(F, &rows, &row_start, &columns, &column_start);
  bytes    = sizeof(double) * (unsigned long long)PetscMax(quadrant, PetscMax(periodic, padded));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_UNSIGNED_LONG_LONG, MPI_MAX, grid->comm));
  F->bytes = (size_t)bytes;
  PetscCall(SamWorkspaceGet(grid->comm, settings->send, &F->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFourierDestroy(SamFourier *fourier)
{
  SamFourier F = *fourier;

  PetscFunctionBegin;
  if (!F) PetscFunctionReturn(PETSC_SUCCESS);
  SamTransformDestroyDouble(F);
  SamTransformDestroySingle(F);
  PetscCall(SamWorkspaceRelease(&F->work));
  PetscCall(SamGridDestroy(&F->grid));
  PetscCall(PetscFree(*fourier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  At 4096 x 4096 cells this reduces the peak of a partial-slip run from 155 to 149 bytes per cell; smaller slabs would
  soon be allocated again.
*/
#define LARGE_SLAB ((size_t)64 << 20)

PetscErrorCode SamFourierTrim(SamFourier F)
{
  PetscFunctionBegin;
  if (F->bytes >= LARGE_SLAB) PetscCall(SamWorkspaceTrim(F->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFourierGetPeriods(SamFourier F, PetscInt *hx, PetscInt *hy)
{
  PetscFunctionBegin;
  *hx = (PetscInt)F->hx;
  *hy = (PetscInt)F->hy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Moves fields between a fine and a coarse grid of the same rectangle, with any numbers of cells.

  Restriction averages over each coarse cell, with fine cells that its edge cuts weighted by their share, so that the
  integral of the field is conserved. Prolongation is linear interpolation between cell centres. Both are separable: x
  is processed on the rank that has the data, y after the needed rows have been fetched.
*/
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>
#include <math.h>

struct _n_SamTransfer {
  SamGrid   fine, coarse;
  SamRows   fine_rows;     /* fine rows from which this rank's coarse rows are averaged */
  SamRows   coarse_rows;   /* coarse rows from which its fine rows are interpolated */
  PetscInt *first, *count; /* coarse column J covers the fine columns first[J] ... first[J] + count[J] - 1 */
  double   *share;         /* shares of these fine columns in coarse column J, COVER_MAX per coarse column */
  PetscInt *left;          /* fine column i lies between the coarse columns left[i] and left[i] + 1 */
  double   *position;      /* place between the centres of these, 0 to 1 */
};

/* A coarse cell is at most two fine cells wide, so it overlaps at most three. */
#define COVER_MAX 3

/* Cell J of N covers the fine cells first..last of n; the share of cell k in it is Share(). */
static void Covered(PetscInt J, PetscInt N, PetscInt n, PetscInt *first, PetscInt *last)
{
  const PetscInt64 begin = (PetscInt64)J * n, end = (PetscInt64)(J + 1) * n;

  *first = (PetscInt)(begin / N);
  *last  = (PetscInt)((end + N - 1) / N) - 1;
}

static double Share(PetscInt J, PetscInt N, PetscInt n, PetscInt k)
{
  const double ratio = (double)n / (double)N;
  const double begin = PetscMax((double)k, (double)J * ratio), end = PetscMin((double)k + 1, (double)(J + 1) * ratio);

  return PetscMax(end - begin, 0) / ratio;
}

/* Finds the coarse cells *left and *left + 1 whose centres enclose that of fine cell k of n; t is the place between
   them. */
static void Between(PetscInt k, PetscInt n, PetscInt N, PetscInt *left, double *t)
{
  const double s = ((double)k + 0.5) * (double)N / (double)n - 0.5;

  *left = (PetscInt)floor(s);
  *t    = s - floor(s);
  if (*left < 0) {
    *left = 0;
    *t    = 0;
  }
  if (*left > N - 2 && N > 1) {
    *left = N - 2;
    *t    = 1;
  }
}

static PetscErrorCode TabulateColumns(SamTransfer t)
{
  const PetscInt N = t->coarse->nx, n = t->fine->nx;

  PetscFunctionBegin;
  PetscCall(PetscMalloc5(N, &t->first, N, &t->count, COVER_MAX * N, &t->share, n, &t->left, n, &t->position));
  for (PetscInt J = 0; J < N; J++) {
    PetscInt last;

    Covered(J, N, n, &t->first[J], &last);
    t->count[J] = last + 1 - t->first[J];
    PetscCheck(t->count[J] <= COVER_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
               "The coarse grid is more than twice as coarse");
    for (PetscInt k = 0; k < t->count[J]; k++) t->share[COVER_MAX * J + k] = Share(J, N, n, t->first[J] + k);
  }
  for (PetscInt i = 0; i < n; i++) Between(i, n, N, &t->left[i], &t->position[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTransferCreate(SamGrid fine, SamGrid coarse, SamTransfer *transfer)
{
  SamTransfer t;
  PetscInt    fine_first = 0, fine_count = 0, coarse_first = 0, coarse_count = 0, ignored, last;
  double      weight;

  PetscFunctionBegin;
  PetscCall(PetscNew(&t));
  PetscCall(SamGridReference(fine));
  PetscCall(SamGridReference(coarse));
  t->fine   = fine;
  t->coarse = coarse;
  PetscCall(TabulateColumns(t));
  if (coarse->rows) {
    Covered(coarse->row_start, coarse->ny, fine->ny, &fine_first, &ignored);
    Covered(coarse->row_start + coarse->rows - 1, coarse->ny, fine->ny, &ignored, &last);
    fine_count = last + 1 - fine_first;
  }
  if (fine->rows) {
    Between(fine->row_start, fine->ny, coarse->ny, &coarse_first, &weight);
    Between(fine->row_start + fine->rows - 1, fine->ny, coarse->ny, &last, &weight);
    coarse_count = PetscMin(last + 2, coarse->ny) - coarse_first;
  }
  PetscCall(SamRowsCreate(fine, fine_first, fine_count, &t->fine_rows));
  PetscCall(SamRowsCreate(coarse, coarse_first, coarse_count, &t->coarse_rows));
  *transfer = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTransferDestroy(SamTransfer *transfer)
{
  SamTransfer t = *transfer;

  PetscFunctionBegin;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree5(t->first, t->count, t->share, t->left, t->position));
  PetscCall(SamRowsDestroy(&t->fine_rows));
  PetscCall(SamRowsDestroy(&t->coarse_rows));
  PetscCall(SamGridDestroy(&t->fine));
  PetscCall(SamGridDestroy(&t->coarse));
  PetscCall(PetscFree(*transfer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AverageColumns(SamTransfer t, const double fine[], double averaged[])
{
  const PetscInt N = t->coarse->nx;

  for (PetscInt j = 0; j < t->fine->rows; j++) {
    const double *row = fine + j * t->fine->nx;

    for (PetscInt J = 0; J < N; J++) {
      double sum = 0;

      for (PetscInt k = 0; k < t->count[J]; k++) sum += t->share[COVER_MAX * J + k] * row[t->first[J] + k];
      averaged[j * N + J] = sum;
    }
  }
}

static void AverageRows(SamTransfer t, const double averaged[], double coarse[])
{
  const PetscInt n = t->coarse->nx;

  for (PetscInt j = 0; j < t->coarse->rows; j++) {
    const PetscInt J = t->coarse->row_start + j;
    PetscInt       first, last;

    Covered(J, t->coarse->ny, t->fine->ny, &first, &last);
    for (PetscInt i = 0; i < n; i++) coarse[j * n + i] = 0;
    for (PetscInt k = first; k <= last; k++) {
      const double  w   = Share(J, t->coarse->ny, t->fine->ny, k);
      const double *row = averaged + (k - t->fine_rows.first) * n;

      for (PetscInt i = 0; i < n; i++) coarse[j * n + i] += w * row[i];
    }
  }
}

PetscErrorCode SamTransferRestrict(SamTransfer t, Vec fine, Vec coarse)
{
  PetscInt      components;
  const double *f, *rows;
  double       *averaged, *c;

  PetscFunctionBegin;
  PetscCall(SamGridMatch(t->fine, fine, t->coarse, coarse, "this transfer", &components));
  PetscCall(SamAllocate(sizeof(*averaged) * (size_t)t->fine->rows * (size_t)t->coarse->nx, &averaged));
  PetscCall(VecGetArrayRead(fine, &f));
  PetscCall(VecGetArrayWrite(coarse, &c));
  for (PetscInt k = 0; k < components; k++) {
    AverageColumns(t, f + k * t->fine->cells, averaged);
    PetscCall(SamRowsFetch(&t->fine_rows, t->coarse->nx, averaged, &rows));
    AverageRows(t, rows, c + k * t->coarse->cells);
    PetscCall(SamRowsRestore(&t->fine_rows, &rows));
  }
  PetscCall(VecRestoreArrayWrite(coarse, &c));
  PetscCall(VecRestoreArrayRead(fine, &f));
  SamFree(averaged);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void InterpolateComponent(SamTransfer t, const double rows[], double row[], double fine[])
{
  const PetscInt N = t->coarse->nx, n = t->fine->nx;

  for (PetscInt j = 0; j < t->fine->rows; j++) {
    PetscInt      J;
    double        ty;
    const double *below, *above;

    Between(t->fine->row_start + j, t->fine->ny, t->coarse->ny, &J, &ty);
    below = rows + (J - t->coarse_rows.first) * N;
    above = below + (t->coarse->axes - 1) * N;
    for (PetscInt l = 0; l < N; l++) row[l] = (1 - ty) * below[l] + ty * above[l];
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt l  = t->left[i];
      const double   tx = t->position[i];

      fine[j * n + i] = (1 - tx) * row[l] + tx * row[l + 1];
    }
  }
}

PetscErrorCode SamTransferProlong(SamTransfer t, Vec coarse, Vec fine)
{
  PetscInt      components;
  const double *c, *rows;
  double       *f, *row;

  PetscFunctionBegin;
  PetscCall(SamGridMatch(t->fine, fine, t->coarse, coarse, "this transfer", &components));
  PetscCall(PetscMalloc1(t->coarse->nx, &row));
  PetscCall(VecGetArrayRead(coarse, &c));
  PetscCall(VecGetArrayWrite(fine, &f));
  for (PetscInt k = 0; k < components; k++) {
    const double *component = c + k * t->coarse->cells;

    PetscCall(SamRowsFetch(&t->coarse_rows, t->coarse->nx, component, &rows));
    InterpolateComponent(t, rows, row, f + k * t->fine->cells);
    PetscCall(SamRowsRestore(&t->coarse_rows, &rows));
  }
  PetscCall(VecRestoreArrayWrite(fine, &f));
  PetscCall(VecRestoreArrayRead(coarse, &c));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

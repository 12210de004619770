/* The grid and its slab distribution. */
#include "gridimpl.h"
#include <math.h>

PetscErrorCode SamGridCreate(MPI_Comm comm, const PetscInt n[2], const PetscReal width[2], const PetscReal center[2],
                             SamGrid *grid)
{
  PetscMPIInt rank, size;
  PetscInt    end;
  SamGrid     g;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  for (PetscInt k = 0; k < 2; k++) {
    PetscCheck(n[k] >= 2, comm, SAM_ERR_USER, "-grid_n: %" PetscInt_FMT " cells in %s, expected at least 2", n[k],
               k ? "y" : "x");
    PetscCheck(width[k] > 0 && isfinite(width[k]), comm, SAM_ERR_USER,
               "-grid_size: a width of %g m in %s, expected a number > 0", (double)width[k], k ? "y" : "x");
    PetscCheck(isfinite(center[k]), comm, SAM_ERR_USER, "-grid_center: expected finite numbers");
    /* the centres must be told apart in double precision, and areas must not underflow or overflow */
    PetscCheck(width[k] / (PetscReal)n[k] > 1e-12 * PetscAbsReal(center[k]) && width[k] > 1e-100 && width[k] < 1e100,
               comm, SAM_ERR_USER,
               "-grid_size: a width of %g m in %s about %g m cannot be resolved in double precision", (double)width[k],
               k ? "y" : "x", (double)center[k]);
  }
  PetscCheck((double)n[0] * (double)n[1] * 2 < (double)PETSC_MAX_INT, comm, SAM_ERR_USER,
             "-grid_n %" PetscInt_FMT ",%" PetscInt_FMT
             ": more cells than this PETSc can count; configure it with 64-bit indices",
             n[0], n[1]);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscNew(&g));
  g->references = 1;
  g->comm       = comm;
  g->nx         = n[0];
  g->ny         = n[1];
  for (PetscInt k = 0; k < 2; k++) {
    g->width[k]  = width[k];
    g->center[k] = center[k];
  }
  g->dx     = width[0] / (PetscReal)n[0];
  g->dy     = width[1] / (PetscReal)n[1];
  g->length = 0.5 * PetscMax(width[0], width[1]);
  SamGridRowsOf(g, size, rank, &g->row_start, &end);
  g->rows  = end - g->row_start;
  g->cells = g->rows * n[0];
  *grid    = g;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridCreateFromOptions(const SamOptions *from, SamGrid *grid)
{
  PetscInt  n[2]      = {0, 0};
  PetscReal width[2]  = {0, 0};
  PetscReal center[2] = {0, 0};
  PetscBool has_n, has_width, help;

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(from, "Grid"));
  PetscCall(SamOptionsIntPair(from, "grid_n", "cells in x[,y]: required", 2, n, &has_n));
  PetscCall(
    SamOptionsRealPair(from, "grid_size", "full width in x[,y] (m): required", SAM_RANGE_POSITIVE, width, &has_width));
  PetscCall(SamOptionsRealPair(from, "grid_center", "centre x,y (m)", SAM_RANGE_ANY, center, NULL));
  PetscCall(SamPrintHelp(&help));
  if (help) { /* the defaults are listed; any grid does */
    n[0] = n[1] = 2;
    width[0] = width[1] = 1;
    has_n = has_width = PETSC_TRUE;
  }
  PetscCheck(has_n, from->comm, SAM_ERR_USER, "-%sgrid_n is missing: the number of cells in x[,y]",
             SamOptionsPrefix(from));
  PetscCheck(has_width, from->comm, SAM_ERR_USER, "-%sgrid_size is missing: the full width of the grid in x[,y], m",
             SamOptionsPrefix(from));
  PetscCall(SamGridCreate(from->comm, n, width, center, grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridReference(SamGrid grid)
{
  PetscFunctionBegin;
  grid->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridDestroy(SamGrid *grid)
{
  PetscFunctionBegin;
  if (!*grid) PetscFunctionReturn(PETSC_SUCCESS);
  if (--(*grid)->references == 0) PetscCall(PetscFree(*grid));
  *grid = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridCoarsen(SamGrid fine, SamGrid *coarse)
{
  const PetscInt n[2] = {(fine->nx + 1) / 2, (fine->ny + 1) / 2};

  PetscFunctionBegin;
  PetscCall(SamGridCreate(fine->comm, n, fine->width, fine->center, coarse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeArray(void *pointer)
{
  SamFree(pointer);
  return PETSC_SUCCESS;
}

PetscErrorCode SamGridCreateVec(SamGrid grid, PetscInt components, Vec *field)
{
  const PetscInt n = components * grid->cells, all = components * grid->nx * grid->ny;
  PetscContainer owner;
  PetscScalar   *array;
  PetscMPIInt    ranks;

  PetscFunctionBegin;
  PetscCall(SamAllocateZeros(sizeof(*array) * (size_t)n, &array));
  PetscCallMPI(MPI_Comm_size(grid->comm, &ranks));
  if (ranks > 1)
    PetscCall(VecCreateMPIWithArray(grid->comm, 1, n, all, array, field));
  else
    PetscCall(VecCreateSeqWithArray(grid->comm, 1, n, array, field));
  PetscCall(PetscContainerCreate(PETSC_COMM_SELF, &owner));
  PetscCall(PetscContainerSetPointer(owner, array));
  PetscCall(PetscContainerSetUserDestroy(owner, FreeArray));
  PetscCall(PetscObjectCompose((PetscObject)*field, "sam_array", (PetscObject)owner));
  PetscCall(PetscContainerDestroy(&owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamVecZero(Vec v)
{
  double  *x;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(v, &n));
  PetscCall(VecGetArray(v, &x));
  SamZero(n, x);
  PetscCall(VecRestoreArray(v, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row's sums of |x| and of x^2. */
SAM_VECTORIZED static void SumRow(PetscInt n, const double *restrict x, double sums[2])
{
  double sizes = 0, squares = 0;

#pragma omp simd reduction(+ : sizes, squares)
  for (PetscInt i = 0; i < n; i++) {
    sizes += fabs(x[i]);
    squares += x[i] * x[i];
  }
  sums[0] = sizes;
  sums[1] = squares;
}

PetscErrorCode SamGridNorm(SamGrid grid, Vec field, NormType type, PetscReal *norm)
{
  SamTotal      totals[2] = {{0, 0}};
  double        sums[2];
  const double *x;
  PetscInt      n;

  PetscFunctionBegin;
  PetscCheck(type == NORM_1 || type == NORM_2, grid->comm, PETSC_ERR_SUP, "Only NORM_1 and NORM_2");
  PetscCall(VecGetLocalSize(field, &n));
  PetscCall(VecGetArrayRead(field, &x));
  for (PetscInt k = 0; k < n; k += grid->nx) {
    SumRow(grid->nx, x + k, sums);
    SamAddAll(2, totals, sums);
  }
  PetscCall(VecRestoreArrayRead(field, &x));
  PetscCall(SamSumTotals(grid->comm, 2, totals, sums));
  *norm = type == NORM_1 ? sums[0] : PetscSqrtReal(sums[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridMatch(SamGrid grid, Vec field, SamGrid other, Vec other_field, const char words[],
                            PetscInt *components)
{
  PetscInt n, m;

  PetscFunctionBegin;
  PetscCall(VecGetSize(field, &n));
  PetscCall(VecGetSize(other_field, &m));
  *components = n / (grid->nx * grid->ny);
  PetscCheck(m == *components * other->nx * other->ny, grid->comm, PETSC_ERR_ARG_SIZ, "The fields do not belong to %s",
             words);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The grid and its slab distribution. */
#include "gridimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/base.h>
#include <math.h>
#include <string.h>

#define LARGEST    1e9                 /* numbers of cells from here on are not rounded; they may be infinite */
#define MOST_RATIO (100 * (1 + 1e-12)) /* largest ratio of the sides of a grid or of its cells, apart from rounding */

/*
  Checks the sizes of a grid and writes a message about the first fault; the message is empty if there is none. The
  names are those of the arguments of SamGridCreate(), or of options.
*/
static PetscErrorCode FindFault(const PetscInt n[2], const PetscReal width[2], const PetscReal center[2],
                                const char *const names[3], char message[], size_t size)
{
  PetscFunctionBegin;
  message[0] = '\0';
  for (PetscInt k = 0; k < 2 && !message[0]; k++) {
    const char *axis = k ? "y" : "x";

    if (n[k] < (k ? 1 : 2))
      PetscCall(PetscSNPrintf(message, size, "%s: %" PetscInt_FMT " cells in %s, expected at least %d", names[0], n[k],
                              axis, k ? 1 : 2));
    else if (!(width[k] > 0) || !isfinite(width[k]))
      PetscCall(PetscSNPrintf(message, size, "%s: a width of %.6g m in %s, expected a number > 0", names[1],
                              (double)width[k], axis));
    else if (!isfinite(center[k]))
      PetscCall(PetscSNPrintf(message, size, "%s: expected finite numbers", names[2]));
    /* Centres must be distinct in double precision, and areas must not underflow or overflow. */
    else if (!(width[k] / (PetscReal)n[k] > 1e-12 * PetscAbsReal(center[k]) && width[k] > 1e-100 && width[k] < 1e100))
      PetscCall(PetscSNPrintf(message, size,
                              "%s: a width of %.6g m in %s about %.6g m cannot be resolved in double precision",
                              names[1], (double)width[k], axis, (double)center[k]));
  }
  if (!message[0] && (double)n[0] * (double)n[1] * 2 >= (double)PETSC_MAX_INT)
    PetscCall(PetscSNPrintf(message, size,
                            "%s %" PetscInt_FMT ",%" PetscInt_FMT
                            ": expected fewer than %.4g cells; a PETSc with 64-bit indices counts more",
                            names[0], n[0], n[1], 0.5 * (double)PETSC_MAX_INT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridCreate(MPI_Comm comm, const PetscInt n[2], const PetscReal width[2], const PetscReal center[2],
                             SamGrid *grid)
{
  static const char *const names[3] = {"Number of cells", "Width of the grid", "Centre of the grid"};
  PetscMPIInt              rank, size;
  PetscInt                 end;
  char                     message[256];
  SamGrid                  g;

  PetscFunctionBegin;
  SamValidPointer(n, 2);
  SamValidPointer(width, 3);
  SamValidPointer(center, 4);
  SamValidPointer(grid, 5);
  PetscCall(SamBaseInitialize());
  PetscCall(FindFault(n, width, center, names, message, sizeof(message)));
  PetscCheck(!message[0], comm, PETSC_ERR_ARG_OUTOFRANGE, "%s", message);
  PetscCall(PetscNew(&g));
  g->class_id = SamGrid_CLASSID;
  PetscCall(PetscCommDuplicate(comm, &g->comm, NULL));
  PetscCallMPI(MPI_Comm_rank(g->comm, &rank));
  PetscCallMPI(MPI_Comm_size(g->comm, &size));
  g->references = 1;
  g->nx         = n[0];
  g->ny         = n[1];
  for (PetscInt k = 0; k < 2; k++) {
    g->width[k]  = width[k];
    g->center[k] = center[k];
  }
  g->dx      = width[0] / (PetscReal)n[0];
  g->dy      = width[1] / (PetscReal)n[1];
  g->axes    = n[1] == 1 ? 1 : 2;
  g->fewest  = n[0];
  g->side[0] = g->side[1] = g->area[0] = g->dx;
  g->area[1]                           = INFINITY;
  g->length                            = 0.5 * width[0];
  if (!SamGridIsRow(g)) {
    g->fewest  = PetscMin(n[0], n[1]);
    g->side[0] = PetscMin(g->dx, g->dy);
    g->side[1] = PetscMax(g->dx, g->dy);
    g->area[1] = g->dy;
    g->length  = 0.5 * PetscMax(width[0], width[1]);
  }
  SamGridRowsOf(g, size, rank, &g->row_start, &end);
  g->rows  = end - g->row_start;
  g->cells = g->rows * n[0];
  *grid    = g;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Rejects widths that differ more than a hundredfold, unless the numbers of cells do, too: -grid_size 2,600 is likely to
  be one number that contains a comma.
*/
static PetscErrorCode RefuseThin(const SamOptions *from, const PetscInt n[2], const PetscReal width[2])
{
  const double ratio = (double)(width[0] / width[1]), cells = ratio * (double)n[1] / (double)n[0];
  char         numbers[64];

  PetscFunctionBegin;
  if (fabs(log(ratio)) <= log(MOST_RATIO) || fabs(log(cells)) <= log(MOST_RATIO)) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(numbers, sizeof(numbers), "%g,%g", (double)width[0], (double)width[1]);
  SETERRQ(from->comm, SAM_ERR_USER,
          "-%sgrid_size %s: the comma separates two lengths, which differ more than a hundredfold, as do the sides of "
          "the cells: expected one number, with a decimal point, or -%sgrid_n to match",
          SamOptionsPrefix(from), numbers, SamOptionsPrefix(from));
}

/* Makes one row of cells, 1 m wide; the y values of -grid_size and -grid_center are ignored. */
static PetscErrorCode TakeRow(const SamOptions *from, PetscInt n[2], PetscReal width[2], PetscReal center[2])
{
  PetscFunctionBegin;
  PetscCheck(n[1] == 1 || n[1] == n[0], from->comm, SAM_ERR_USER,
             "-%sgrid_n %" PetscInt_FMT ",%" PetscInt_FMT ": a plane problem has one row of cells: use %" PetscInt_FMT
             ",1",
             SamOptionsPrefix(from), n[0], n[1], n[0]);
  n[1]      = 1;
  width[1]  = 1;
  center[1] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values set by options */
typedef struct {
  PetscInt  n[2];
  PetscReal width[2], center[2];
} Settings;
#define MEMBER(name) offsetof(Settings, name)

PetscErrorCode SamGridCreateFromOptions(const SamOptions *from, PetscBool row, PetscInt n[2], PetscReal width[2],
                                        PetscReal center[2], SamGrid *grid)
{
  Settings           set    = {{n[0], n[1]}, {width[0], width[1]}, {center[0], center[1]}};
  const SamOptionRow rows[] = {
    {"grid_n", "cells in x[,y]: required without a surface file", SAM_OPTION_INT, MEMBER(n), .least = row ? 1 : 2,
     .size = 2, .missing = "the number of cells in x[,y], for example 256; a run with -accuracy 1% chooses it"},
    {"grid_size", "full width in x[,y] (): required without a surface file", SAM_OPTION_REAL, MEMBER(width),
     .range = SAM_RANGE_POSITIVE, .size = 2, .unit = "m",
     .missing = "the full width of the grid in x[,y], m: about 1.5 times that of the contact; a run with -accuracy 1% "
                "chooses it"},
    {"grid_center", "centre x,y", SAM_OPTION_REAL, MEMBER(center), .range = SAM_RANGE_ANY, .size = 2, .unit = "m"}};
  char              message[256], options[3][96];
  const char *const names[3] = {options[0], options[1], options[2]};
  const PetscBool   help     = SamPrintHelp();

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, "Grid", SAM_OPTION_ROWS(rows), &set, NULL));
  for (int k = 0; k < 2; k++) { /* for the defaults in the help; any grid will do */
    n[k]      = help ? 2 : set.n[k];
    width[k]  = help ? 1 : set.width[k];
    center[k] = set.center[k];
  }
  for (int k = 0; k < 3; k++)
    PetscCall(PetscSNPrintf(options[k], sizeof(options[k]), "-%s%s", SamOptionsPrefix(from), rows[k].name));
  PetscCheck(row || n[1] != 1, from->comm, SAM_ERR_USER, "%s: one cell in y: a plane problem needs -%selasticity plane",
             names[0], SamOptionsPrefix(from));
  if (row) PetscCall(TakeRow(from, n, width, center));
  PetscCall(FindFault(n, width, center, names, message, sizeof(message)));
  PetscCheck(!message[0], from->comm, SAM_ERR_USER, "%s", message);
  if (!row) PetscCall(RefuseThin(from, n, width));
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
  SamValidPointer(grid, 1);
  if (!*grid) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*grid, SamGrid, 1);
  if (--(*grid)->references == 0) {
    PetscCall(PetscCommDestroy(&(*grid)->comm));
    PetscCall(SamGridDestroy(&(*grid)->fine));
    (*grid)->class_id = SAM_CLASSID_NONE;
    PetscCall(PetscFree(*grid));
  }
  *grid = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridCoarsen(SamGrid fine, SamGrid *coarse)
{
  const PetscInt n[2] = {(fine->nx + 1) / 2, (fine->ny + 1) / 2};

  PetscFunctionBegin;
  PetscCall(SamGridCreate(fine->comm, n, fine->width, fine->center, coarse));
  PetscCall(SamGridReference(fine));
  (*coarse)->fine = fine;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Data of a field, and the function that frees them */
typedef struct {
  void *data;
  PetscErrorCode (*free)(void *data);
} Owned;

static PetscErrorCode FreeOwned(Owned *owned)
{
  PetscFunctionBegin;
  PetscCall((*owned->free)(owned->data));
  PetscCall(PetscFree(owned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc passes the pointer; from 3.23 on, the address of the pointer to it; since 3.25 that as a pointer to void. */
#if PETSC_VERSION_LT(3, 23, 0)
  #define PetscContainerSetCtxDestroy PetscContainerSetUserDestroy
static PetscErrorCode Free(void *owned)
{
  return FreeOwned((Owned *)owned);
}
#else
  #if PETSC_VERSION_LT(3, 25, 0)
typedef void        **PetscCtxRt;
  #endif
static PetscErrorCode Free(PetscCtxRt address)
{
  return FreeOwned(*(Owned **)address);
}
#endif

PetscErrorCode SamVecOwn(Vec field, const char name[], void *data, PetscErrorCode (*free)(void *))
{
  PetscContainer container;
  Owned         *owned;

  PetscFunctionBegin;
  PetscCall(PetscNew(&owned));
  *owned = (Owned){data, free};
  PetscCall(PetscContainerCreate(PETSC_COMM_SELF, &container));
  PetscCall(PetscContainerSetPointer(container, owned));
  PetscCall(PetscContainerSetCtxDestroy(container, Free));
  PetscCall(PetscObjectCompose((PetscObject)field, name, (PetscObject)container));
  PetscCall(PetscContainerDestroy(&container));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamVecGetOwned(Vec field, const char name[], void **data)
{
  PetscContainer container;
  Owned         *owned;

  PetscFunctionBegin;
  *data = NULL;
  PetscCall(PetscObjectQuery((PetscObject)field, name, (PetscObject *)&container));
  if (!container) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscContainerGetPointer(container, (void **)&owned));
  *data = owned->data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeArray(void *array)
{
  SamFree(array);
  return PETSC_SUCCESS;
}

PetscErrorCode SamGridCreateVec(SamGrid grid, PetscInt components, Vec *field)
{
  PetscInt     n, all;
  PetscScalar *array;
  PetscMPIInt  ranks;

  PetscFunctionBegin;
  SamValidHandle(grid, SamGrid, 1);
  SamValidPointer(field, 3);
  n   = components * grid->cells;
  all = components * grid->nx * grid->ny;
  PetscCall(SamAllocateZeros(sizeof(*array) * (size_t)n, &array));
  PetscCallMPI(MPI_Comm_size(grid->comm, &ranks));
  if (ranks > 1)
    PetscCall(VecCreateMPIWithArray(grid->comm, 1, n, all, array, field));
  else
    PetscCall(VecCreateSeqWithArray(grid->comm, 1, n, array, field));
  PetscCall(SamVecOwn(*field, "sam_array", array, FreeArray));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridCheckVec(SamGrid grid, PetscInt components, Vec field, const char words[])
{
  PetscInt here, all;
  double   bad;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(field, &here));
  PetscCall(VecGetSize(field, &all));
  bad = here != components * grid->cells || all != components * grid->nx * grid->ny ? 1 : 0;
  PetscCall(SamMax(grid->comm, 1, &bad));
  PetscCheck(bad == 0, grid->comm, PETSC_ERR_ARG_SIZ,
             "%s is not a field of %" PetscInt_FMT " component(s) on this grid of %" PetscInt_FMT " x %" PetscInt_FMT
             " cells",
             words, components, grid->nx, grid->ny);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGridIsFinite(SamGrid grid, Vec field, PetscBool *is)
{
  const PetscScalar *values;
  PetscInt           n;
  double             sum = 0, bad;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(field, &n));
  PetscCall(VecGetArrayRead(field, &values));
#pragma omp simd reduction(+ : sum)
  for (PetscInt k = 0; k < n; k++) sum += 0 * values[k]; /* becomes NaN if a value is not finite */
  PetscCall(VecRestoreArrayRead(field, &values));
  bad = isnan(sum) ? 1 : 0;
  PetscCall(SamMax(grid->comm, 1, &bad));
  *is = bad == 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamVecCopyNonzero(Vec from, Vec to)
{
  enum { CHUNK = 512 };
  static const double zeros[CHUNK] = {0};
  const double       *x;
  double             *y;
  PetscInt            n;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(from, &n));
  PetscCall(VecGetArrayRead(from, &x));
  PetscCall(VecGetArray(to, &y));
  for (PetscInt k = 0; k < n; k += CHUNK) {
    const PetscInt count = PetscMin(CHUNK, n - k);

    if (memcmp(x + k, zeros, sizeof(*x) * (size_t)count))
      PetscCall(PetscArraycpy(y + k, x + k, count));
    else
      SamZero(count, y + k);
  }
  PetscCall(VecRestoreArray(to, &y));
  PetscCall(VecRestoreArrayRead(from, &x));
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

/* Computes a row's sums of |x| and of x^2. */
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
  SamTotal      totals[2] = {{0}};
  double        sums[2];
  const double *x;
  PetscInt      n;

  PetscFunctionBegin;
  SamValidHandle(grid, SamGrid, 1);
  SamValidVec(field, 2);
  SamValidPointer(norm, 4);
  SamValidVecOn(grid->comm, 1, field, 2);
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

/*
  Sums a hash of value and place over the cells. The order of the sum, and so the number of ranks, does not matter.
*/
PetscErrorCode SamGridChecksum(SamGrid grid, Vec field, uint64_t *checksum)
{
  const uint64_t cells = (uint64_t)grid->nx * (uint64_t)grid->ny,
                 first = (uint64_t)grid->nx * (uint64_t)grid->row_start;
  const PetscScalar *values;
  PetscInt           n;

  PetscFunctionBegin;
  *checksum = 0;
  PetscCall(VecGetLocalSize(field, &n));
  PetscCall(VecGetArrayRead(field, &values));
  for (PetscInt k = 0; k < n; k++)
    *checksum += SamHashMix(SamHashBits(values[k]) +
                            SamHashMix((uint64_t)(k / grid->cells) * cells + first + (uint64_t)(k % grid->cells) + 1));
  PetscCall(VecRestoreArrayRead(field, &values));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, checksum, 1, MPI_UINT64_T, MPI_SUM, grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

double SamGridRoundUp(double n)
{
  for (n = PetscMax(ceil(n), 1); n < LARGEST; n++) {
    PetscInt rest = (PetscInt)n;

    for (PetscInt p = 2; p <= 5; p += p == 2 ? 1 : 2)
      while (rest % p == 0) rest /= p;
    if (rest == 1) return n;
  }
  return n;
}

PetscErrorCode SamGridDot(SamGrid g, PetscInt n, const double a[], const double b[], double *sum)
{
  SamTotal total = {0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt c = 0; c < n; c++)
      for (PetscInt k = j * g->nx + c * g->cells, end = k + g->nx; k < end; k++) row += a[k] * b[k];
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(g->comm, 1, &total, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

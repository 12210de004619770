/* Runs: the parts of rows that loops pass over. */
#include <petsam/private/balanceimpl.h>

/* Finds the runs of a row of nx cells; returns their number. */
static PetscInt FindRuns(PetscInt nx, const double bound[], const double x[], const double y[], PetscInt gap,
                         PetscInt (*span)[2])
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < nx; i++) {
    if (!(bound[i] > 0) && (!x || (x[i] == 0 && y[i] == 0))) continue;
    if (!count || i - span[count - 1][1] >= gap) span[count++][0] = i;
    span[count - 1][1] = i + 1;
  }
  return count;
}

/* Runs that cover a larger part of the cells from the first to the last gain less than they cost: they become one. */
#define MOST 0.5

/*
  Widens the runs of a row, in place, to whole blocks of SAM_RUN_GAP cells, and joins those that then meet, or all;
  returns their number.
*/
static PetscInt Widen(PetscInt nx, PetscInt count, PetscInt (*span)[2])
{
  const PetscInt begin = span[0][0], end = span[count - 1][1];
  PetscInt       joined = 0, cells = 0;

  for (PetscInt n = 0; n < count; n++) {
    const PetscInt first = span[n][0] / SAM_RUN_GAP * SAM_RUN_GAP,
                   last  = PetscMin((span[n][1] + SAM_RUN_GAP - 1) / SAM_RUN_GAP * SAM_RUN_GAP, nx);

    if (!joined || first > span[joined - 1][1]) span[joined++][0] = first;
    span[joined - 1][1] = last;
  }
  for (PetscInt n = 0; n < joined; n++) cells += span[n][1] - span[n][0];
  if ((double)cells <= MOST * (double)(end - begin)) return joined;
  span[0][0] = begin;
  span[0][1] = end;
  return 1;
}

PetscErrorCode SamRunsCreate(SamGrid grid, const double bound[], const double shear[], PetscInt gap, SamRuns *runs)
{
  const PetscInt nx = grid->nx, most = nx / (PetscMin(gap, nx) + 1) + 1; /* runs of a row */

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(grid->rows + 1, &runs->start, grid->rows * most, &runs->span));
  runs->start[0] = 0;
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k        = (ptrdiff_t)j * nx;
    PetscInt(*const span)[2] = runs->span + runs->start[j];
    PetscInt count =
      FindRuns(nx, bound + k, shear ? shear + k : NULL, shear ? shear + k + grid->cells : NULL, gap, span);

    if (count > 1) count = Widen(nx, count, span);
    runs->start[j + 1] = runs->start[j] + count;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunsDestroy(SamRuns *runs)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(runs->start, runs->span));
  PetscFunctionReturn(PETSC_SUCCESS);
}

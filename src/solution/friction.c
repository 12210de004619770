/*
  What friction does in a step, cell by cell: the length of the slip, that under pressure, and its work. With
  numbers.c the one place that says what slip dissipates.
*/
#include <petsam/private/solutionimpl.h>

/* What of a step is needed, and where it goes, or is added to; NULL: not wanted. */
typedef struct {
  PetscBool mid_step; /* the slip is in the direction at mid step */
  SamValues v, before;
  double   *path, *pressed, *work;
} Fields;

static void FrictionRow(const Fields *f, ptrdiff_t first, PetscInt nx, const double sx[], const double sy[])
{
  const double *p = f->v.p, *b = f->v.b, *q = f->v.q, *p_before = f->before.p, *b_before = f->before.b;

  for (PetscInt i = 0; i < nx; i++) {
    const ptrdiff_t    k = first + i, l = k + f->v.cells;
    const double       length = hypot(sx[i], sy[i]);
    const SamCellState state  = SamCellStateOf(p[k], q[k], q[l], b[k]);
    const PetscBool    slips  = f->mid_step ? SamCellSlid(state, b_before[k]) : state == SAM_CELL_SLIP;

    if (f->path) f->path[k] = length;
    if (f->pressed) f->pressed[k] = slips ? 0.5 * (p_before[k] + p[k]) * length : 0;
    if (f->work && f->mid_step)
      f->work[k] = slips ? 0.5 * (b_before[k] + b[k]) * length : 0;
    else if (f->work)
      f->work[k] = slips && b[k] > 0 ? -(q[k] * sx[i] + q[l] * sy[i]) * 0.5 * (b_before[k] + b[k]) / b[k] : 0;
  }
}

static PetscErrorCode GetOptional(Vec field, double **values)
{
  PetscFunctionBegin;
  *values = NULL;
  if (field) PetscCall(VecGetArray(field, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RestoreOptional(Vec field, double **values)
{
  PetscFunctionBegin;
  if (field) PetscCall(VecRestoreArray(field, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionComputeFriction(SamProblem problem, const SamSolution *last, const SamSolution *s, Vec path,
                                          Vec pressed, Vec work)
{
  const SamSolution *before = last ? last : s;
  SamGrid            grid;
  SamIncrement       increment;
  Fields             f;

  PetscFunctionBegin;
  PetscCall(SamProblemGetGrid(problem, &grid));
  PetscCall(SamIncrementCreate(problem, last, s, &increment));
  f.mid_step = increment.turns[0] != NULL;
  PetscCall(SamValuesGet(s, &f.v));
  PetscCall(SamValuesGet(before, &f.before));
  PetscCall(GetOptional(path, &f.path));
  PetscCall(GetOptional(pressed, &f.pressed));
  PetscCall(GetOptional(work, &f.work));
  for (PetscInt j = 0; j < grid->rows; j++) {
    SamIncrementComputeRow(&increment, j);
    FrictionRow(&f, (ptrdiff_t)j * grid->nx, grid->nx, increment.row[0], increment.row[1]);
  }
  PetscCall(RestoreOptional(work, &f.work));
  PetscCall(RestoreOptional(pressed, &f.pressed));
  PetscCall(RestoreOptional(path, &f.path));
  PetscCall(SamValuesRestore(before, &f.before));
  PetscCall(SamValuesRestore(s, &f.v));
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

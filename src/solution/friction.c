/*
  What friction does in a step, cell by cell: the length of the slip, that under pressure, and its work. With
  numbers.c the one place that says what slip dissipates.
*/
#include <petsam/private/solutionimpl.h>

/* What of a step is needed, and where it goes, or is added to; NULL: not wanted. */
typedef struct {
  const double *p, *p_before, *b, *b_before, *q;
  double       *path, *pressed, *work;
} Fields;

static void FrictionRow(const Fields *f, ptrdiff_t first, PetscInt nx, PetscInt cells, const double sx[],
                        const double sy[])
{
  for (PetscInt i = 0; i < nx; i++) {
    const ptrdiff_t k = first + i, l = k + cells;
    const double    length = hypot(sx[i], sy[i]);
    const PetscBool slips  = SamCellStateOf(f->p[k], f->q[k], f->q[l], f->b[k]) == SAM_CELL_SLIP;

    if (f->path) f->path[k] = length;
    if (f->pressed) f->pressed[k] = slips ? 0.5 * (f->p_before[k] + f->p[k]) * length : 0;
    if (f->work)
      f->work[k] =
        slips && f->b[k] > 0 ? -(f->q[k] * sx[i] + f->q[l] * sy[i]) * 0.5 * (f->b_before[k] + f->b[k]) / f->b[k] : 0;
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
  PetscCall(VecGetArrayRead(s->pressure, &f.p));
  PetscCall(VecGetArrayRead(before->pressure, &f.p_before));
  PetscCall(VecGetArrayRead(s->bound, &f.b));
  PetscCall(VecGetArrayRead(before->bound, &f.b_before));
  PetscCall(VecGetArrayRead(s->shear, &f.q));
  PetscCall(GetOptional(path, &f.path));
  PetscCall(GetOptional(pressed, &f.pressed));
  PetscCall(GetOptional(work, &f.work));
  for (PetscInt j = 0; j < grid->rows; j++) {
    SamIncrementComputeRow(&increment, j);
    FrictionRow(&f, (ptrdiff_t)j * grid->nx, grid->nx, grid->cells, increment.row[0], increment.row[1]);
  }
  PetscCall(RestoreOptional(work, &f.work));
  PetscCall(RestoreOptional(pressed, &f.pressed));
  PetscCall(RestoreOptional(path, &f.path));
  PetscCall(VecRestoreArrayRead(s->shear, &f.q));
  PetscCall(VecRestoreArrayRead(before->bound, &f.b_before));
  PetscCall(VecRestoreArrayRead(s->bound, &f.b));
  PetscCall(VecRestoreArrayRead(before->pressure, &f.p_before));
  PetscCall(VecRestoreArrayRead(s->pressure, &f.p));
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What friction does in a step, cell by cell: the path of the slip, that under pressure, and its work. */
#include "contactimpl.h"
#include <math.h>

/* What of a step is needed, and where it goes, or is added to; NULL: not wanted. */
typedef struct {
  const double *p, *p_before, *b, *b_before, *q;
  double       *path, *pressed, *work;
  PetscBool     add;
} Fields;

static void FrictionRow(const Fields *f, ptrdiff_t first, PetscInt nx, PetscInt cells, const double sx[],
                        const double sy[])
{
  for (PetscInt i = 0; i < nx; i++) {
    const ptrdiff_t k = first + i, l = k + cells;
    const double    length = hypot(sx[i], sy[i]);
    const PetscBool slips  = SamStateOf(f->p[k], f->q[k], f->q[l], f->b[k]) == SAM_STATE_SLIP;

    if (f->path) f->path[k] = length + (f->add ? f->path[k] : 0);
    if (f->pressed)
      f->pressed[k] = (slips ? 0.5 * (f->p_before[k] + f->p[k]) * length : 0) + (f->add ? f->pressed[k] : 0);
    if (f->work)
      f->work[k] =
        (slips && f->b[k] > 0 ? -(f->q[k] * sx[i] + f->q[l] * sy[i]) * 0.5 * (f->b_before[k] + f->b[k]) / f->b[k] : 0) +
        (f->add ? f->work[k] : 0);
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

PetscErrorCode SamContactAddFriction(SamContact c, PetscBool add, Vec path, Vec pressed, Vec work)
{
  /* of a solution that is corrected, the plain one: see deferredshear.c */
  const PetscBool    plain = c->tried.solution.sheared.has;
  const SamSolution *s = plain ? &c->tried.plain : &c->tried.solution, *last = SamContactPlainBefore(c);
  const SamSolution *before = last ? last : s;
  SamIncrement       increment;
  Fields             f = {.add = add};

  PetscFunctionBegin;
  PetscCheck(c->has_tried, c->grid->comm, PETSC_ERR_ORDER, "There is no tried step");
  PetscCall(SamIncrementCreate(c->problem, last, s, &increment));
  PetscCall(VecGetArrayRead(s->pressure, &f.p));
  PetscCall(VecGetArrayRead(before->pressure, &f.p_before));
  PetscCall(VecGetArrayRead(s->bound, &f.b));
  PetscCall(VecGetArrayRead(before->bound, &f.b_before));
  PetscCall(VecGetArrayRead(s->shear, &f.q));
  PetscCall(GetOptional(path, &f.path));
  PetscCall(GetOptional(pressed, &f.pressed));
  PetscCall(GetOptional(work, &f.work));
  for (PetscInt j = 0; j < c->grid->rows; j++) {
    SamIncrementComputeRow(&increment, j);
    FrictionRow(&f, (ptrdiff_t)j * c->grid->nx, c->grid->nx, c->grid->cells, increment.row[0], increment.row[1]);
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

PetscErrorCode SamContactComputeFriction(SamContact c, Vec path, Vec pressed, Vec work)
{
  PetscFunctionBegin;
  PetscCall(SamContactAddFriction(c, PETSC_FALSE, path, pressed, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

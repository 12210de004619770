/*
  Computes the slip and the frictional work of a step, cell by cell: the length of the slip, its length under pressure,
  and its work. Dissipation is defined here and in numbers.c only.
*/
#include <petsam/private/solutionimpl.h>
#include <petsam/private/problem.h>

/* Arrays that the values of a step are written or added to; NULL: not wanted */
typedef struct {
  double *path, *pressed, *work;
} Fields;

static void FrictionRow(const Fields *f, const SamIncrement *increment, ptrdiff_t first)
{
  const double *sx = increment->row[0], *sy = increment->row[1];

  for (PetscInt i = 0; i < increment->grid->nx; i++) {
    const ptrdiff_t k      = first + i;
    const double    length = hypot(sx[i], sy[i]);
    double          share[2];
    SamCellMotion   motion;
    const double    work = SamIncrementGetWork(increment, k, share, &motion);

    if (f->path) f->path[k] = length;
    if (f->pressed) f->pressed[k] = SamIncrementMix(share, increment->at_before.p, increment->at_now.p, k) * length;
    if (f->work) f->work[k] = work;
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

/*
  The centred slip of a cell in 1 m of rolled distance is u_t at the cell, as the mean of its two sides, minus the
  creepage. The power of a shear on the mean of u_t is zero, so that the sum over cells is the work of the loads.
*/
PetscErrorCode SamSolutionComputeRolling(SamProblem problem, const SamSolution *s, PetscBool passage, Vec field)
{
  SamIncrement  increment;
  SamValues     v;
  const SamGrid grid = SamProblemGetGrid(problem);
  const double  turn = (double)(SamElasticitySpinAhead(SamProblemGetElasticity(problem)) * s->rigid[SAM_COMPONENT_MZ]);
  double       *to;

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(problem, NULL, s, &increment));
  PetscCall(SamValuesGet(s, &v));
  PetscCall(VecGetArrayWrite(field, &to));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t first = (ptrdiff_t)j * grid->nx;
    double          sum   = 0;

    SamIncrementComputeRow(&increment, j);
    for (PetscInt i = 0; i < grid->nx; i++) {
      const ptrdiff_t k = first + i, l = k + v.cells, behind = i ? 1 : 0;
      const double    sx = increment.slip[0][i] - 0.5 * (v.u_t[k] - v.u_t[k - behind]),
                   sy    = increment.slip[1][i] + turn - 0.5 * (v.u_t[l] - v.u_t[l - behind]);

      to[k] = -(v.q[k] * sx + v.q[l] * sy);
      sum += v.p[k] * hypot(sx, sy) * (double)grid->dx;
    }
    for (PetscInt i = 0; passage && i < grid->nx; i++) to[first + i] = sum;
  }
  PetscCall(VecRestoreArrayWrite(field, &to));
  PetscCall(SamValuesRestore(s, &v));
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionComputeFriction(SamProblem problem, const SamSolution *last, const SamSolution *s, Vec path,
                                          Vec pressed, Vec work)
{
  SamIncrement  increment;
  Fields        f;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(problem, last, s, &increment));
  PetscCall(SamIncrementMeasure(&increment));
  PetscCall(GetOptional(path, &f.path));
  PetscCall(GetOptional(pressed, &f.pressed));
  PetscCall(GetOptional(work, &f.work));
  for (PetscInt j = 0; j < grid->rows; j++) {
    SamIncrementComputeRow(&increment, j);
    FrictionRow(&f, &increment, (ptrdiff_t)j * grid->nx);
  }
  PetscCall(RestoreOptional(work, &f.work));
  PetscCall(RestoreOptional(pressed, &f.pressed));
  PetscCall(RestoreOptional(path, &f.path));
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

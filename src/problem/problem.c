/* The problem of a contact (elasticity, gap, friction), and the bound of the shear that follows from the friction. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/fieldfile.h>
#include <petsam/problem.h>
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */
#include <math.h>

struct _n_SamProblem {
  PetscInt      references;
  SamElasticity elasticity;
  SamGrid       grid; /* of the elasticity; borrowed */
  Vec           gap;  /* its revision is PETSc's object state, which grows with every change */
  PetscReal     friction;
  Vec           field; /* coefficients of friction by cell; NULL: the number counts */
  PetscReal     limit; /* of the pressure, Pa; infinite: none */
};

PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem)
{
  SamProblem p;

  PetscFunctionBegin;
  PetscCall(PetscNew(&p));
  p->references = 1;
  p->limit      = INFINITY; /* PETSC_INFINITY is a finite number */
  PetscCall(SamElasticityReference(elasticity));
  p->elasticity = elasticity;
  PetscCall(SamElasticityGetGrid(elasticity, &p->grid));
  PetscCall(SamGridCreateVec(p->grid, 1, &p->gap));
  *problem = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemReference(SamProblem p)
{
  PetscFunctionBegin;
  p->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemDestroy(SamProblem *problem)
{
  SamProblem p = *problem;

  PetscFunctionBegin;
  *problem = NULL;
  if (!p || --p->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&p->gap));
  PetscCall(VecDestroy(&p->field));
  PetscCall(SamElasticityDestroy(&p->elasticity));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetElasticity(SamProblem p, SamElasticity *elasticity)
{
  PetscFunctionBegin;
  *elasticity = p->elasticity;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetGrid(SamProblem p, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = p->grid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetGap(SamProblem p, Vec h)
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(p->grid, 1, h, "The gap"));
  PetscCall(VecCopy(h, p->gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetGap(SamProblem p, Vec *h)
{
  PetscFunctionBegin;
  *h = p->gap;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetGapRevision(SamProblem p, PetscObjectState *revision)
{
  PetscFunctionBegin;
  PetscCall(PetscObjectStateGet((PetscObject)p->gap, revision));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetFriction(SamProblem p, PetscReal friction)
{
  PetscFunctionBegin;
  PetscCheck(friction >= 0 && isfinite(friction), p->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coefficient of friction %g: expected a finite number >= 0", (double)friction);
  p->friction = friction;
  PetscCall(VecDestroy(&p->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetFrictionField(SamProblem p, Vec friction)
{
  const double *mu;
  double        bad = 0;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(p->grid, 1, friction, "The friction"));
  PetscCall(VecGetArrayRead(friction, &mu));
  for (PetscInt k = 0; k < p->grid->cells; k++) bad += mu[k] >= 0 && isfinite(mu[k]) ? 0 : 1;
  PetscCall(VecRestoreArrayRead(friction, &mu));
  PetscCall(SamSum(p->grid->comm, 1, &bad));
  PetscCheck(bad == 0, p->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%.0f cells have a coefficient of friction that is not a finite number >= 0", bad);
  if (!p->field) PetscCall(SamGridCreateVec(p->grid, 1, &p->field));
  PetscCall(VecCopy(friction, p->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetFrictionFromOptions(SamProblem p, const SamOptions *from)
{
  SamFieldFile source = {
    .file_option = "friction_file", .dataset_option = "friction_dataset", .default_dataset = "/friction", .unit = "1"};
  PetscReal      friction = p->friction;
  PetscBool      set, help;
  PetscErrorCode ierr = 0;
  Vec            field;

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(from, "Friction"));
  PetscCall(SamOptionsReal(from, "friction", "Coulomb's coefficient", SAM_RANGE_NONNEGATIVE, &friction, &set));
  PetscCall(SamFieldFileSetFromOptions(&source, from, "HDF5 file with a coefficient for each cell, instead"));
  PetscCall(SamPrintHelp(&help));
  PetscCheck(!set || !source.file[0], from->comm, SAM_ERR_USER, "-%sfriction and -%sfriction_file: give one of them",
             source.prefix, source.prefix);
  if (set) PetscCall(SamProblemSetFriction(p, friction));
  if (!source.file[0] || help) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(p->grid, 1, &field));
  ierr = SamFieldFileRead(&source, p->grid, field);
  if (!ierr) PetscCall(SamProblemSetFrictionField(p, field));
  PetscCall(VecDestroy(&field));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetFriction(SamProblem p, PetscReal *friction, Vec *field)
{
  PetscFunctionBegin;
  if (friction) *friction = p->friction;
  if (field) *field = p->field;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemHasFriction(SamProblem p, PetscBool *has)
{
  PetscReal most = p->friction;

  PetscFunctionBegin;
  if (p->field) PetscCall(VecMax(p->field, NULL, &most));
  *has = most > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetPressureLimit(SamProblem p, PetscReal limit)
{
  PetscFunctionBegin;
  PetscCheck(limit > 0, p->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "pressure limit %g: expected a number > 0, or inf",
             (double)limit);
  if (limit != p->limit) PetscCall(PetscObjectStateIncrease((PetscObject)p->gap));
  p->limit = limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetPressureLimitFromOptions(SamProblem p, const SamOptions *from)
{
  PetscReal limit = p->limit;

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(from, "Plastic deformation"));
  PetscCall(SamOptionsReal(from, "pressure_limit", "hardness: the largest pressure, where the surfaces yield (Pa)",
                           SAM_RANGE_POSITIVE_INF, &limit, NULL));
  PetscCall(SamProblemSetPressureLimit(p, limit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetPressureLimit(SamProblem p, PetscReal *limit)
{
  PetscFunctionBegin;
  *limit = p->limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b = scale * mu * p for n cells. Returns the sum of b, to find rows without a bound. */
SAM_VECTORIZED static double BoundRow(PetscInt n, const double *restrict p, const double *restrict mu, double scale,
                                      double *restrict b)
{
  double sum = 0;

#pragma omp simd reduction(+ : sum)
  for (PetscInt i = 0; i < n; i++) {
    b[i] = scale * mu[i] * p[i];
    sum += b[i];
  }
  return sum;
}

PetscErrorCode SamProblemComputeBound(SamProblem p, PetscReal scale, Vec pressure, Vec bound)
{
  const PetscInt nx = p->grid->nx;
  const double  *pressures, *field = NULL;
  double        *bounds, *number, *row;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(nx, &number, nx, &row));
  for (PetscInt i = 0; i < nx; i++) number[i] = p->friction;
  if (p->field) PetscCall(VecGetArrayRead(p->field, &field));
  PetscCall(VecGetArray(bound, &bounds));
  if (pressure == bound)
    pressures = bounds;
  else
    PetscCall(VecGetArrayRead(pressure, &pressures));
  for (ptrdiff_t k = 0; k < p->grid->cells; k += nx) {
    const double sum = BoundRow(nx, pressures + k, field ? field + k : number, scale, row);

    /* a row without a bound is not written to, so that untouched pages take no memory */
    if (sum != 0)
      PetscCall(PetscArraycpy(bounds + k, row, nx));
    else
      SamZero(nx, bounds + k);
  }
  if (pressure != bound) PetscCall(VecRestoreArrayRead(pressure, &pressures));
  PetscCall(VecRestoreArray(bound, &bounds));
  if (p->field) PetscCall(VecRestoreArrayRead(p->field, &field));
  PetscCall(PetscFree2(number, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coulomb's friction: |q| <= mu p; mu is a number or a field, times a factor of the step. */
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/fieldfile.h>
#include <petsam/problem.h>
#include <petsam/private/parameters.h>

typedef struct {
  PetscReal friction;
  Vec       field; /* coefficients by cell; NULL: the number applies */

  const SamCondition *scale;
} Coulomb;

static PetscErrorCode SetNumber(SamLaw law, PetscReal friction)
{
  Coulomb *const c = (Coulomb *)law->data;

  PetscFunctionBegin;
  PetscCheck(friction >= 0 && isfinite(friction), law->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coefficient of friction %.6g: expected a finite number >= 0", (double)friction);
  c->friction = friction;
  PetscCall(VecDestroy(&c->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetField(SamLaw law, Vec friction)
{
  Coulomb *const c = (Coulomb *)law->data;
  const double  *mu;
  double         bad = 0;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(law->grid, 1, friction, "The friction"));
  PetscCall(VecGetArrayRead(friction, &mu));
  for (PetscInt k = 0; k < law->grid->cells; k++) bad += mu[k] >= 0 && isfinite(mu[k]) ? 0 : 1;
  PetscCall(VecRestoreArrayRead(friction, &mu));
  PetscCall(SamSum(law->grid->comm, 1, &bad));
  PetscCheck(bad == 0, law->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%.0f cells have a coefficient of friction that is not a finite number >= 0", bad);
  if (!c->field) PetscCall(SamGridCreateVec(law->grid, 1, &c->field));
  PetscCall(VecCopy(friction, c->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetFriction(SamProblem p, PetscReal friction)
{
  SamLaw law;

  PetscFunctionBegin;
  SamValidHandle(p, SamProblem, 1);
  PetscCall(SamProblemAddLawOfType(p, SAM_LAW_COULOMB, &law));
  PetscCall(SetNumber(law, friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetFrictionField(SamProblem p, Vec friction)
{
  SamLaw law;

  PetscFunctionBegin;
  SamValidHandle(p, SamProblem, 1);
  SamValidVec(friction, 2);
  SamValidVecOn(SamProblemGetGrid(p)->comm, 1, friction, 2);
  PetscCall(SamProblemAddLawOfType(p, SAM_LAW_COULOMB, &law));
  PetscCall(SetField(law, friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  Coulomb *const     c          = (Coulomb *)law->data;
  char               words[512] = "coulomb", word[64] = "coulomb", text[600] = "how the coefficient changes: coulomb";
  const SamOptionRow number  = {"friction", "Coulomb's coefficient", SAM_OPTION_REAL, .range = SAM_RANGE_NONNEGATIVE,
                                .excludes = "friction_file"},
                     changes = {"friction_law", text, SAM_OPTION_WORD, .size = sizeof(word), .words = words};
  SamFieldFile source        = {
           .file_option     = "friction_file",
           .dataset_option  = "friction_dataset",
           .default_dataset = "/friction",
           .unit            = "1",
  };
  PetscReal friction = c->friction;
  PetscBool set;
  Vec       field;

  PetscFunctionBegin;
  *asked = PETSC_TRUE; /* without options a coefficient of 0 has been set */
  PetscCall(SamLawListWords(law->elasticity, changes.name, ",", words, sizeof(words)));
  PetscCall(SamLawListWords(law->elasticity, changes.name, ", ", text, sizeof(text)));
  PetscCall(SamOptionsRead(from, "Friction", 1, &number, &friction, &set));
  PetscCall(SamFieldFileSetFromOptions(&source, from, "HDF5 file with a coefficient of friction per cell"));
  PetscCall(SamOptionsRead(from, NULL, 1, &changes, word, NULL));
  if (set) PetscCall(SetNumber(law, friction));
  PetscCall(SamFieldFileCreate(&source, law->grid, &field));
  if (field) PetscCall(SetField(law, field));
  PetscCall(VecDestroy(&field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  const Coulomb *c = (const Coulomb *)law->data;
  uint64_t       checksum;

  PetscFunctionBegin;
  if (c->field) PetscCall(SamGridChecksum(law->grid, c->field, &checksum));
  if (c->field)
    PetscCall(SamParametersAddChecksum(p, "friction_file", checksum));
  else
    PetscCall(SamParametersAddReals(p, "friction", PETSC_TRUE, 1, &c->friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddConditions(SamLaw law, SamConditions conditions)
{
  static const SamCondition scale = {.name   = SAM_FRICTION_SCALE,
                                     .unit   = "1",
                                     .text   = "factor on the coefficient of friction",
                                     .usual  = 1,
                                     .range  = SAM_RANGE_NONNEGATIVE,
                                     .bounds = PETSC_TRUE};

  PetscFunctionBegin;
  PetscCall(SamConditionsAdd(conditions, &scale, &((Coulomb *)law->data)->scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Friction(SamLaw law, PetscReal *uniform, PetscBool *has)
{
  const Coulomb *c    = (const Coulomb *)law->data;
  PetscReal      most = c->friction;

  PetscFunctionBegin;
  *uniform = c->field ? 0 : c->friction;
  if (!has) PetscFunctionReturn(PETSC_SUCCESS);
  if (c->field) PetscCall(VecMax(c->field, NULL, &most));
  *has = most > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes b = scale * mu * p for n cells. Returns the sum of b, by which rows without a bound are found. */
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

static PetscErrorCode FillValue(SamLaw law, const double *field, const SamBoundAt *at, Vec bound)
{
  const Coulomb *c     = (const Coulomb *)law->data;
  const PetscInt nx    = law->grid->nx;
  const double   scale = SamControlGet(at->control, c->scale);
  const double  *pressures;
  double        *bounds, *number, *row;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(nx, &number, nx, &row));
  for (PetscInt i = 0; i < nx; i++) number[i] = c->friction;
  PetscCall(VecGetArray(bound, &bounds));
  if (at->pressure == bound)
    pressures = bounds;
  else
    PetscCall(VecGetArrayRead(at->pressure, &pressures));
  for (ptrdiff_t k = 0; k < law->grid->cells; k += nx) {
    const double sum = BoundRow(nx, pressures + k, field ? field + k : number, scale, row);

    /* A row without a bound is not written, so that untouched pages take no memory. */
    if (sum != 0)
      PetscCall(PetscArraycpy(bounds + k, row, nx));
    else
      SamZero(nx, bounds + k);
  }
  if (at->pressure != bound) PetscCall(VecRestoreArrayRead(at->pressure, &pressures));
  PetscCall(VecRestoreArray(bound, &bounds));
  PetscCall(PetscFree2(number, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Bound(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  const Coulomb *c     = (const Coulomb *)law->data;
  const double   scale = SamControlGet(at->control, c->scale);
  const double  *field = NULL;
  double        *mu;

  PetscFunctionBegin;
  if (c->field) PetscCall(VecGetArrayRead(c->field, &field));
  if (bound->value) PetscCall(FillValue(law, field, at, bound->value));
  if (bound->by_pressure) {
    PetscCall(VecGetArrayWrite(bound->by_pressure, &mu));
    for (PetscInt k = 0; k < law->grid->cells; k++) mu[k] = scale * (field ? field[k] : c->friction);
    PetscCall(VecRestoreArrayWrite(bound->by_pressure, &mu));
  }
  if (bound->by_slip) PetscCall(VecSet(bound->by_slip, 0));
  if (c->field) PetscCall(VecRestoreArrayRead(c->field, &field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&((Coulomb *)law->data)->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Coulomb(SamLaw law)
{
  Coulomb *c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  law->data               = c;
  law->any_motion         = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->ops.conditions     = AddConditions;
  law->ops.friction       = Friction;
  law->ops.bound          = Bound;
  law->ops.back           = SamLawNoBack;
  law->ops.destroy        = Destroy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

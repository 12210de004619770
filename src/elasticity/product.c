/* Products and preconditioners: fields become arrays by component for the type's methods, and are logged. */
#include <petsam/private/elasticityimpl.h>

/* Arrays of fields, by component. */
typedef struct {
  const double *in[2];
  double       *out[2];
  const double *x;
  double       *y;
} Arrays;

static PetscErrorCode GetArrays(SamElasticity e, Vec in, Vec out, Arrays *a)
{
  PetscFunctionBegin;
  if (in == out) {
    PetscCall(VecGetArray(out, &a->y));
    a->x = a->y;
  } else {
    PetscCall(VecGetArrayRead(in, &a->x));
    PetscCall(VecGetArrayWrite(out, &a->y));
  }
  for (PetscInt c = 0; c < 2; c++) { /* of a field of one component only the first is used */
    a->in[c]  = a->x + c * e->grid->cells;
    a->out[c] = a->y + c * e->grid->cells;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RestoreArrays(Vec in, Vec out, Arrays *a)
{
  PetscFunctionBegin;
  if (in == out) {
    PetscCall(VecRestoreArray(out, &a->y));
  } else {
    PetscCall(VecRestoreArrayWrite(out, &a->y));
    PetscCall(VecRestoreArrayRead(in, &a->x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);
typedef PetscErrorCode (*MethodSingle)(SamElasticity, double, const float *const[], float *const[]);

static PetscErrorCode Apply(SamElasticity e, Method method, SamEvent event, Vec in, Vec out)
{
  Arrays a;

  PetscFunctionBegin;
  PetscCheck(method, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s has no such product", e->type);
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscLogEventBegin(SamEvents[event], 0, 0, 0, 0));
  PetscCall(GetArrays(e, in, out, &a));
  PetscCall(method(e, a.in, a.out));
  PetscCall(RestoreArrays(in, out, &a));
  PetscCall(PetscLogEventEnd(SamEvents[event], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplySingle(SamElasticity e, MethodSingle method, SamEvent event, double factor, const float x[],
                                  float y[])
{
  const float *const in[2]  = {x, x + e->grid->cells};
  float *const       out[2] = {y, y + e->grid->cells};

  PetscFunctionBegin;
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscLogEventBegin(SamEvents[event], 0, 0, 0, 0));
  PetscCall(method(e, factor, in, out));
  PetscCall(PetscLogEventEnd(SamEvents[event], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The public functions: a product of fields, or of arrays in single precision, by a method and under an event. */
#define PRODUCT(Name, method, event) \
  PetscErrorCode Name(SamElasticity e, Vec in, Vec out) \
  { \
    PetscFunctionBegin; \
    SamElasticityWith(e, method); \
    PetscCall(Apply(e, e->ops.method, event, in, out)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
#define PRODUCT_SINGLE(Name, method, event) \
  PetscErrorCode Name(SamElasticity e, double factor, const float in[], float out[]) \
  { \
    PetscFunctionBegin; \
    SamElasticityWith(e, method); \
    PetscCall(ApplySingle(e, e->ops.method, event, factor, in, out)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }

PRODUCT(SamElasticityApplyNormal, applynormal, SAM_EVENT_APPLY_NORMAL)
PRODUCT(SamElasticityApplyTangential, applytangential, SAM_EVENT_APPLY_TANGENTIAL)
PRODUCT(SamElasticityApplyNormalToTangential, applynormaltotangential, SAM_EVENT_APPLY_COUPLING)
PRODUCT(SamElasticityApplyTangentialToNormal, applytangentialtonormal, SAM_EVENT_APPLY_COUPLING)
PRODUCT(SamElasticityApplyNormalSlopes, applynormalslopes, SAM_EVENT_APPLY_NORMAL)
PRODUCT_SINGLE(SamElasticityApplyNormalSingle, applynormalsingle, SAM_EVENT_APPLY_NORMAL)
PRODUCT_SINGLE(SamElasticityApplyTangentialSingle, applytangentialsingle, SAM_EVENT_APPLY_TANGENTIAL)
PRODUCT_SINGLE(SamElasticityPreconditionNormalSingle, preconditionnormal, SAM_EVENT_PRECONDITION_NORMAL)
PRODUCT_SINGLE(SamElasticityPreconditionTangentialSingle, preconditiontangential, SAM_EVENT_PRECONDITION_TANGENTIAL)

PetscErrorCode SamElasticityGetNear(SamElasticity e, PetscInt reach, PetscInt sub, double table[])
{
  PetscFunctionBegin;
  SamElasticityWith(e, getnear);
  PetscCheck(e->ops.getnear, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s has no sub-cells", e->type);
  PetscCall(e->ops.getnear(e, reach, sub, table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The preconditioner of a Vec: scaled to what floats hold, and back. */
static PetscErrorCode Precondition(SamElasticity e, PetscInt components, Vec in, Vec out)
{
  const PetscInt n = components * e->grid->cells;
  const double  *x;
  double        *y, self[2];
  PetscReal      size;
  float         *work;

  PetscFunctionBegin;
  PetscCall(VecNorm(in, NORM_INFINITY, &size));
  if (size == 0) {
    PetscCall(VecSet(out, 0));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamElasticityGetSelfInfluence(e, &self[0], &self[1]));
  PetscCall(PetscMalloc1(n, &work));
  PetscCall(VecGetArrayRead(in, &x));
  for (PetscInt k = 0; k < n; k++) work[k] = (float)(x[k] / size);
  PetscCall(VecRestoreArrayRead(in, &x));
  if (components == 1)
    PetscCall(SamElasticityPreconditionNormalSingle(e, self[0], work, work));
  else
    PetscCall(SamElasticityPreconditionTangentialSingle(e, self[1], work, work));
  PetscCall(VecGetArrayWrite(out, &y));
  for (PetscInt k = 0; k < n; k++) y[k] = size / self[components - 1] * (double)work[k];
  PetscCall(VecRestoreArrayWrite(out, &y));
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityPreconditionNormal(SamElasticity e, Vec residual, Vec p)
{
  PetscFunctionBegin;
  PetscCall(Precondition(e, 1, residual, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityPreconditionTangential(SamElasticity e, Vec residual, Vec q)
{
  PetscFunctionBegin;
  PetscCall(Precondition(e, 2, residual, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Products and preconditioners: fields become arrays by component for the type's methods, and are logged. */
#include <petsam/private/elasticityimpl.h>

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);
typedef PetscErrorCode (*MethodSingle)(SamElasticity, double, const float *const[], float *const[]);

static PetscErrorCode Apply(SamElasticity e, Method method, SamEvent event, Vec in, Vec out)
{
  const double *x = NULL;
  double       *y;

  PetscFunctionBegin;
  PetscCheck(method, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s has no such product", e->type);
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscLogEventBegin(SamEvents[event], 0, 0, 0, 0));
  if (in != out) PetscCall(VecGetArrayRead(in, &x));
  PetscCall(VecGetArray(out, &y));
  /* of a field of one component only the first is used */
  PetscCall(method(e, (const double *const[]){x ? x : y, (x ? x : y) + e->grid->cells},
                   (double *const[]){y, y + e->grid->cells}));
  PetscCall(VecRestoreArray(out, &y));
  if (in != out) PetscCall(VecRestoreArrayRead(in, &x));
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

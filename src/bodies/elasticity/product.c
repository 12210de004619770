/* Products and preconditioners: fields are passed as arrays by component to the type's methods, and calls are
   logged. */
#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);
typedef PetscErrorCode (*MethodSingle)(SamElasticity, double, const float *const[], float *const[]);

/* Calls a method; `film`: adds the displacement of each cell by its own value. */
static PetscErrorCode Apply(SamElasticity e, Method method, SamEvent event, PetscReal film, Vec in, Vec out)
{
  const double *x    = NULL;
  Vec           copy = NULL;
  double       *y;

  PetscFunctionBegin;
  if (film > 0 && in == out) {
    PetscCall(VecDuplicate(in, &copy));
    PetscCall(VecCopy(in, copy));
  }
  PetscCheck(method, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s has no such product", e->type);
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscLogEventBegin(SamEvents[event], 0, 0, 0, 0));
  if (in != out) PetscCall(VecGetArrayRead(in, &x));
  PetscCall(VecGetArray(out, &y));
  /* For a field of one component only the first array is used. */
  PetscCall(method(e, (const double *const[]){x ? x : y, (x ? x : y) + e->grid->cells},
                   (double *const[]){y, y + e->grid->cells}));
  PetscCall(VecRestoreArray(out, &y));
  if (in != out) PetscCall(VecRestoreArrayRead(in, &x));
  if (film > 0) PetscCall(VecAXPY(out, film, copy ? copy : in));
  PetscCall(VecDestroy(&copy));
  PetscCall(PetscLogEventEnd(SamEvents[event], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplySingle(SamElasticity e, MethodSingle method, SamEvent event, PetscReal film, double factor,
                                  const float x[], float y[])
{
  const float *const in[2]  = {x, x + e->grid->cells};
  float *const       out[2] = {y, y + e->grid->cells};
  const float        own    = (float)(film * factor);
  float             *copy   = NULL;

  PetscFunctionBegin;
  if (film > 0 && x == y) {
    PetscCall(PetscMalloc1(2 * e->grid->cells, &copy));
    PetscCall(PetscArraycpy(copy, x, 2 * e->grid->cells));
  }
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscLogEventBegin(SamEvents[event], 0, 0, 0, 0));
  PetscCall(method(e, factor, in, out));
  for (PetscInt k = 0; k < 2 * e->grid->cells && film > 0; k++) y[k] += own * (copy ? copy : x)[k];
  PetscCall(PetscFree(copy));
  PetscCall(PetscLogEventEnd(SamEvents[event], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The public functions: a product of fields, or of arrays in single precision, by a method, logged as an event. */
#define PRODUCT(Name, method, event, film) \
  PetscErrorCode Name(SamElasticity e, Vec in, Vec out) \
  { \
    PetscFunctionBegin; \
    SamValidHandle(e, SamElasticity, 1); \
    SamValidVec(in, 2); \
    SamValidVec(out, 3); \
    SamValidVecOn(e->grid->comm, 1, in, 2); \
    SamValidVecOn(e->grid->comm, 1, out, 3); \
    SamElasticityWith(e, method); \
    PetscCall(Apply(e, e->ops.method, event, film, in, out)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
#define PRODUCT_SINGLE(Name, method, event, film) \
  PetscErrorCode Name(SamElasticity e, double factor, const float in[], float out[]) \
  { \
    PetscFunctionBegin; \
    SamElasticityWith(e, method); \
    PetscCall(ApplySingle(e, e->ops.method, event, film, factor, in, out)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }

PRODUCT(SamElasticityApplyNormal, applynormal, SAM_EVENT_APPLY_NORMAL, 0)
PRODUCT(SamElasticityApplyTangential, applytangential, SAM_EVENT_APPLY_TANGENTIAL, e->film)
PRODUCT(SamElasticityApplyNormalToTangential, applynormaltotangential, SAM_EVENT_APPLY_COUPLING, 0)
PRODUCT(SamElasticityApplyTangentialToNormal, applytangentialtonormal, SAM_EVENT_APPLY_COUPLING, 0)
PRODUCT_SINGLE(SamElasticityApplyNormalSingle, applynormalsingle, SAM_EVENT_APPLY_NORMAL, 0)
PRODUCT_SINGLE(SamElasticityApplyTangentialSingle, applytangentialsingle, SAM_EVENT_APPLY_TANGENTIAL, e->film)
PRODUCT_SINGLE(SamElasticityPreconditionNormalSingle, preconditionnormal, SAM_EVENT_PRECONDITION_NORMAL, 0)
PRODUCT_SINGLE(SamElasticityPreconditionTangentialSingle, preconditiontangential, SAM_EVENT_PRECONDITION_TANGENTIAL, 0)

PetscErrorCode SamElasticityPreconditionSlidingSingle(SamElasticity e, double factor, const double slope[2],
                                                      const float in[], float out[])
{
  SamElasticity with = e;

  PetscFunctionBegin;
  SamElasticityWith(with, preconditionnormal);
  if (!with->ops.preconditionsliding) {
    PetscCall(SamElasticityPreconditionNormalSingle(e, factor, in, out));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamElasticitySetUp(with));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PRECONDITION_NORMAL], 0, 0, 0, 0));
  PetscCall((*with->ops.preconditionsliding)(with, factor, slope, &in, &out));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PRECONDITION_NORMAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityPreconditionSlipSingle(SamElasticity e, double factor, const float in[], float out[])
{
  SamElasticity with = e;

  PetscFunctionBegin;
  SamElasticityWith(with, preconditionslip);
  if (with->ops.preconditionslip)
    PetscCall(ApplySingle(with, with->ops.preconditionslip, SAM_EVENT_PRECONDITION_TANGENTIAL, 0, factor, in, out));
  else
    PetscCall(SamElasticityPreconditionTangentialSingle(e, factor, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

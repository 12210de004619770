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

PetscErrorCode SamElasticityApplyNormal(SamElasticity e, Vec p, Vec u_z)
{
  PetscFunctionBegin;
  PetscCall(Apply(e, e->ops.applynormal, SAM_EVENT_APPLY_NORMAL, p, u_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangential(SamElasticity e, Vec q, Vec u_t)
{
  PetscFunctionBegin;
  PetscCall(Apply(e, e->ops.applytangential, SAM_EVENT_APPLY_TANGENTIAL, q, u_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyNormalToTangential(SamElasticity e, Vec p, Vec u_t)
{
  PetscFunctionBegin;
  PetscCall(Apply(e, e->ops.applynormaltotangential, SAM_EVENT_APPLY_COUPLING, p, u_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangentialToNormal(SamElasticity e, Vec q, Vec u_z)
{
  PetscFunctionBegin;
  PetscCall(Apply(e, e->ops.applytangentialtonormal, SAM_EVENT_APPLY_COUPLING, q, u_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyNormalSlopes(SamElasticity e, Vec slopes, Vec u_z)
{
  PetscFunctionBegin;
  PetscCall(Apply(e, e->ops.applynormalslopes, SAM_EVENT_APPLY_NORMAL, slopes, u_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangentialSlopes(SamElasticity e, int axis, Vec slopes, Vec u_t)
{
  Arrays a;

  PetscFunctionBegin;
  PetscCheck(e->ops.applytangentialslopes, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s has no such product",
             e->type);
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_TANGENTIAL], 0, 0, 0, 0));
  PetscCall(GetArrays(e, slopes, u_t, &a));
  PetscCall(e->ops.applytangentialslopes(e, axis, a.in, a.out));
  PetscCall(RestoreArrays(slopes, u_t, &a));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_TANGENTIAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetNear(SamElasticity e, SamElasticityKernel kernel, PetscInt reach, PetscInt sub,
                                    double table[])
{
  PetscFunctionBegin;
  PetscCheck(e->ops.getnear, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s has no sub-cells", e->type);
  PetscCall(e->ops.getnear(e, kernel, reach, sub, table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyNormalSingle(SamElasticity e, double factor, const float p[], float u_z[])
{
  PetscFunctionBegin;
  PetscCall(ApplySingle(e, e->ops.applynormalsingle, SAM_EVENT_APPLY_NORMAL, factor, p, u_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangentialSingle(SamElasticity e, double factor, const float q[], float u_t[])
{
  PetscFunctionBegin;
  PetscCall(ApplySingle(e, e->ops.applytangentialsingle, SAM_EVENT_APPLY_TANGENTIAL, factor, q, u_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityPreconditionNormalSingle(SamElasticity e, double factor, const float residual[], float p[])
{
  PetscFunctionBegin;
  PetscCall(ApplySingle(e, e->ops.preconditionnormal, SAM_EVENT_PRECONDITION_NORMAL, factor, residual, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityPreconditionTangentialSingle(SamElasticity e, double factor, const float residual[],
                                                         float q[])
{
  PetscFunctionBegin;
  PetscCall(ApplySingle(e, e->ops.preconditiontangential, SAM_EVENT_PRECONDITION_TANGENTIAL, factor, residual, q));
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

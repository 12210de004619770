/*
  A body: a half-space with a thin coating that yields by itself, u_z = S p + c p and u_t = C q + c q. What the type has
  no method for is done by the half-space that it holds.
*/
#include "plugin.h"
#include <petsam/private/elasticityimpl.h>

/* The compliance c of the coating (m/Pa). */
#define C(e) (*(PetscReal *)(e)->data)

/* The half-space's product, and c times what it is of, which is taken before: input and output may be one array. */
#define ADD(number, n, scale, product) \
  const PetscInt cells = e->grid->cells; \
  number        *own; \
  PetscCall(PetscMalloc1(n *cells, &own)); \
  for (PetscInt k = 0; k < n * cells; k++) own[k] = (number)((scale)*C(e)) * in[k / cells][k % cells]; \
  PetscCall(product); \
  for (PetscInt k = 0; k < n * cells; k++) out[k / cells][k % cells] += own[k]; \
  return PetscFree(own)

static PetscErrorCode Normal(SamElasticity e, const double *const in[], double *const out[])
{
  ADD(double, 1, 1, (*e->inner->ops.applynormal)(e->inner, in, out));
}

static PetscErrorCode Tangential(SamElasticity e, const double *const in[], double *const out[])
{
  ADD(double, 2, 1, (*e->inner->ops.applytangential)(e->inner, in, out));
}

static PetscErrorCode NormalSingle(SamElasticity e, double x, const float *const in[], float *const out[])
{
  ADD(float, 1, x, (*e->inner->ops.applynormalsingle)(e->inner, x, in, out));
}

static PetscErrorCode TangentialSingle(SamElasticity e, double x, const float *const in[], float *const out[])
{
  ADD(float, 2, x, (*e->inner->ops.applytangentialsingle)(e->inner, x, in, out));
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscCall(SamElasticityGetSelfInfluence(e->inner, normal, tangential));
  *normal += C(e);
  *tangential += C(e);
  return 0;
}

static PetscErrorCode SetFromOptions(SamElasticity e, const SamOptions *from)
{
  return SamOptionsReal(from, "coating_compliance", "compliance of the coating", "m/Pa", SAM_RANGE_POSITIVE, &C(e),
                        NULL);
}

/* On coarser grids, and on a part of the grid, the coating is the same. */
static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  C(child) = C(parent);
  return 0;
}

/* What results and checkpoints record of it, and how it is made of that. */
static PetscErrorCode AddParameters(SamElasticity e, SamParameters *p)
{
  return SamParametersAddReals(p, "coating_compliance", PETSC_TRUE, 1, &C(e));
}

static PetscErrorCode SetParameters(SamElasticity e, const SamParameters *p, const char source[])
{
  const SamParameter *c = SamParametersFind(p, "coating_compliance");

  PetscCheck(c, e->grid->comm, SAM_ERR_FILE, "%s: it lacks coating_compliance", source);
  C(e) = c->value[0];
  return 0;
}

static PetscErrorCode Destroy(SamElasticity e)
{
  return PetscFree(e->data);
}

PetscErrorCode CreateCoated(SamElasticity e)
{
  PetscCall(PetscCalloc1(1, (PetscReal **)&e->data));
  e->ops = (SamElasticityOps){.setfromoptions        = SetFromOptions,
                              .inherit               = Inherit,
                              .destroy               = Destroy,
                              .getselfinfluence      = GetSelfInfluence,
                              .addparameters         = AddParameters,
                              .setparameters         = SetParameters,
                              .applynormal           = Normal,
                              .applytangential       = Tangential,
                              .applynormalsingle     = NormalSingle,
                              .applytangentialsingle = TangentialSingle};
  return SamElasticitySetInner(e, SAM_ELASTICITY_HALFSPACE);
}

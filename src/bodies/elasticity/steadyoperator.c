/*
  Bodies under a contact in steady rolling towards +x; a wrapper of a type of elasticity.

  The grid moves with the contact; material enters at large x and moves towards -x, by a cell in the time in which its
  displacement changes from that of cell i + 1 to that of cell i. So if u = C q is the displacement of bodies at rest,
      the slip in 1 m of rolled distance, which is the slip velocity in units of the rolling speed, is (u_i -
      u_(i+1))/dx - creepage = A q - creepage,     A = C D/dx,     (D q)_i = q_i - q_(i+1),
  as C does not depend on the place; the difference is taken before the product. q is zero outside of the contact, and D
  q also in one cell behind it. A is positive, q.A q = (D q).C (D q)/(2 dx), but not symmetric. Creepages replace the
  displacements in the problem of bodies at rest, and u_t is A q; displacements by pressure are differenced in the same
  way.

  The slip of a cell lies between its centre and the next one ahead, and so does the creepage by spin: it is evaluated
  at x + dx/6, as in CONTACT. At x + dx/2, the place of the slip, the errors of the loads are larger, as the edges have
  errors of the same order; at x itself the error of T_y is 2 to 4 times larger (8 % at 32 cells if spin and creep_y
  oppose each other, 1 % at x + dx/6). The loads are sums at the cells' centres. So, without slip, T_y by spin minus
  dx/6 times T_y by creep_y equals -M_z by creep_y; and the power of the loads on the creepages is that of the slip at
  the centres, with the creepage there.

  Source: J. J. Kalker, Three-dimensional Elastic Bodies in Rolling Contact (1990), chapter 4.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>

/* Computes the differences of the rows of n fields, times `factor`, as new arrays one after the other, for
   SamFree(). */
#define DIFFERENCES(Name, Real) \
  static PetscErrorCode Name(SamGrid grid, PetscInt n, Real factor, const Real *const in[], Real **out) \
  { \
    PetscFunctionBegin; \
    PetscCall(SamAllocate(sizeof(**out) * (size_t)(n * grid->cells), out)); \
    for (PetscInt c = 0; c < n; c++) \
      for (PetscInt j = 0; j < grid->rows; j++) { \
        const Real *restrict from = in[c] + (ptrdiff_t)j * grid->nx; \
        Real *restrict to         = *out + (ptrdiff_t)(c * grid->cells + j * grid->nx); \
\
        for (PetscInt i = 0; i + 1 < grid->nx; i++) to[i] = factor * (from[i] - from[i + 1]); \
        to[grid->nx - 1] = factor * from[grid->nx - 1]; \
      } \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
DIFFERENCES(CreateDifferences, double)
DIFFERENCES(CreateDifferencesSingle, float)

static PetscErrorCode ApplyTangential(SamElasticity e, const double *const q[], double *const u[])
{
  const double  film   = (double)SamPairFilm(e->pair);
  SamElasticity bodies = e->inner;
  double       *d;

  PetscFunctionBegin;
  SamElasticityWith(bodies, applytangential);
  PetscCall(CreateDifferences(e->grid, 2, 1 / e->grid->dx, q, &d));
  PetscCall((*bodies->ops.applytangential)(bodies, (const double *const[]){d, d + e->grid->cells}, u));
  for (PetscInt c = 0; c < 2 && film > 0; c++)
    for (PetscInt k = 0; k < e->grid->cells; k++) u[c][k] += film * d[c * e->grid->cells + k];
  SamFree(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyNormalToTangential(SamElasticity e, const double *const p[], double *const u[])
{
  SamElasticity bodies = e->inner;
  double       *d;

  PetscFunctionBegin;
  SamElasticityWith(bodies, applynormaltotangential);
  PetscCall(CreateDifferences(e->grid, 1, 1 / e->grid->dx, p, &d));
  PetscCall((*bodies->ops.applynormaltotangential)(bodies, (const double *const[]){d}, u));
  SamFree(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyTangentialSingle(SamElasticity e, double factor, const float *const q[], float *const u[])
{
  const float   film   = (float)((double)SamPairFilm(e->pair) * factor / (double)e->grid->dx);
  SamElasticity bodies = e->inner;
  float        *d;

  PetscFunctionBegin;
  SamElasticityWith(bodies, applytangentialsingle);
  PetscCall(CreateDifferencesSingle(e->grid, 2, 1, q, &d));
  PetscCall((*bodies->ops.applytangentialsingle)(bodies, factor / e->grid->dx,
                                                 (const float *const[]){d, d + e->grid->cells}, u));
  for (PetscInt c = 0; c < 2 && film > 0; c++)
    for (PetscInt k = 0; k < e->grid->cells; k++) u[c][k] += film * d[c * e->grid->cells + k];
  SamFree(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(e->inner, normal, tangential));
  *tangential /= e->grid->dx;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamElasticity e)
{
  PetscFunctionBegin;
  e->ops = (SamElasticityOps){.applytangential         = ApplyTangential,
                              .applytangentialsingle   = ApplyTangentialSingle,
                              .applynormaltotangential = ApplyNormalToTangential, /* if the bodies are coupled */
                              .getselfinfluence        = GetSelfInfluence};
  PetscCall(SamElasticitySetInner(e, NULL));
  e->traits.upwind = PETSC_TRUE;
  e->film          = 0; /* the film is a part of the operator */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamElasticitySpinAhead(SamElasticity e)
{
  return e->traits.upwind ? e->grid->dx / 6 : 0;
}

PetscErrorCode SamElasticityCreateRolling(SamElasticity bodies, SamElasticity *rolling)
{
  PetscFunctionBegin;
  PetscCheck(!bodies->traits.periodic && !bodies->traits.upwind, bodies->grid->comm, PETSC_ERR_SUP,
             "Bodies of type %s do not roll", bodies->type);
  PetscCall(SamElasticityWrap(bodies, "rolling", Create, rolling));
  (*rolling)->traits.upwind = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

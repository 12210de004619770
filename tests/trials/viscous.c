/*
  A body with a memory that changes its operator in each step: a standard linear solid of constant Poisson's ratio, of
  which all materials of a pair consist. Displacements creep like J(t)/J(0) = 1 + a (1 - exp(-t/T)), a the creep part
  and T the creep time:

      u = C (p + a c),  T c' + c = p,

  with C of the inner half-spaces, layered or not, and c a traction that follows p. For p linear in the step dt, x =
  dt/T, e = exp(-x), m = (1 - e)/x: c = e c_0 + (m - e) p_0 + (1 - m) p. So the step has the operator (1 + a (1 - m)) C
  and, before any traction, the displacement a C (e c_0 + (m - e) p_0).
  Source: E. H. Lee, J. R. M. Radok, J. Appl. Mech. 27 (1960) 438-444.
*/
#include "trials.h"
#include <petsam/private/elasticityimpl.h>

typedef struct _n_Solid Solid;
struct _n_Solid {
  PetscReal    part, time;        /* a; T, s */
  PetscReal    kept, before, now; /* weights of c_0, p_0 and p in this step */
  const Solid *finest;            /* that of the finest grid, whose weights count on all others */
};
typedef enum { MEMORY, TRACTION, DISPLACED, STORED } Stored;
typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);

#define FIELD(...) \
  { \
    __VA_ARGS__, 2, PETSC_TRUE, .result = SAM_RESULT_OFFERED, .motion = SAM_MOVES \
  }
static const SamStateField fields[2][STORED] = {{FIELD("viscous_pressure", "Pa", "pressure that creep follows", 1),
                                                 FIELD("last_pressure", "Pa", "pressure of the last step", 1),
                                                 FIELD("viscous_z", "m", "creep by earlier steps, normal", 1)},
                                                {FIELD("viscous_shear", "Pa", "shear that creep follows", 2),
                                                 FIELD("last_shear", "Pa", "shear of the last step", 2),
                                                 FIELD("viscous", "m", "creep by earlier steps, tangential", 2)}};

static PetscReal FactorOf(SamElasticity e)
{
  const Solid *const s = ((const Solid *)e->data)->finest;

  return 1 + s->part * s->now;
}

/* ---- products and preconditioners: those of the inner bodies times the factor, and over it ---- */

#define PRODUCT(Name, method, components) \
  static PetscErrorCode Name(SamElasticity e, const double *const in[], double *const out[]) \
  { \
    const PetscReal factor = FactorOf(e); \
\
    PetscCall((*e->inner->ops.method)(e->inner, in, out)); \
    for (PetscInt c = 0; c < components; c++) \
      for (PetscInt k = 0; k < e->grid->cells; k++) out[c][k] *= factor; \
    return 0; \
  }
#define SINGLE(Name, method, power) \
  static PetscErrorCode Name(SamElasticity e, double factor, const float *const in[], float *const out[]) \
  { \
    return (*e->inner->ops.method)(e->inner, factor * pow(FactorOf(e), power), in, out); \
  }
PRODUCT(ApplyNormal, applynormal, 1)
PRODUCT(ApplyTangential, applytangential, 2)
PRODUCT(ApplyNormalToTangential, applynormaltotangential, 2)
PRODUCT(ApplyTangentialToNormal, applytangentialtonormal, 1)
SINGLE(ApplyNormalSingle, applynormalsingle, 1)
SINGLE(ApplyTangentialSingle, applytangentialsingle, 1)
SINGLE(PreconditionNormal, preconditionnormal, -1)
SINGLE(PreconditionTangential, preconditiontangential, -1)

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscCall((*e->inner->ops.getselfinfluence)(e->inner, normal, tangential));
  *normal *= FactorOf(e);
  *tangential *= FactorOf(e);
  return 0;
}

/* ---- the memory ---- */

static Vec Committed(SamState state, PetscInt way, Stored stored)
{
  return SamStateGetField(state, SamStateFindField(state, fields[way][stored].name), SAM_COMMITTED);
}

static PetscErrorCode Set(SamState state, PetscInt way, Stored stored, Vec *to)
{
  PetscCall(SamStateSetField(state, SamStateFindField(state, fields[way][stored].name), to));
  return VecSet(*to, 0);
}

/* Sets c for a traction at the end of the step; NULL: none. */
static PetscErrorCode Remember(const Solid *s, SamState state, PetscInt way, Vec traction, Vec *memory)
{
  const Vec before = Committed(state, way, MEMORY), last = Committed(state, way, TRACTION);

  PetscCall(Set(state, way, MEMORY, memory));
  if (before) PetscCall(VecAXPY(*memory, s->kept, before));
  if (last) PetscCall(VecAXPY(*memory, s->before, last));
  return traction ? VecAXPY(*memory, s->now, traction) : 0;
}

/* Adds to u the displacement that a memory of the inner bodies causes. */
static PetscErrorCode AddCreep(SamElasticity e, Method method, Vec memory, Vec u)
{
  const PetscInt n = e->grid->cells;
  const double  *c;
  double        *out;
  Vec            more;

  PetscCall(VecDuplicate(u, &more));
  PetscCall(VecGetArrayRead(memory, &c));
  PetscCall(VecGetArray(more, &out));
  PetscCall((*method)(e->inner, (const double *const[]){c, c + n}, (double *const[]){out, out + n}));
  PetscCall(VecRestoreArray(more, &out));
  PetscCall(VecRestoreArrayRead(memory, &c));
  PetscCall(VecAXPY(u, ((const Solid *)e->data)->part, more));
  return VecDestroy(&more);
}

static PetscErrorCode Declare(SamElasticity e, SamState state)
{
  (void)e;
  for (PetscInt way = 0; way < 2; way++)
    for (Stored k = 0; k < STORED; k++) PetscCall(SamStateDeclareField(state, &fields[way][k], &(PetscInt){0}));
  return 0;
}

static PetscErrorCode Begin(SamElasticity e, SamState state, const SamControl *control, PetscReal duration)
{
  const SamElasticityOps *const ops = &e->inner->ops;
  Solid *const                  s   = (Solid *)e->data;
  const PetscReal               x = duration / s->time, mean = x > 0 ? -expm1(-x) / x : 1;
  Vec                           c[2], u[2];

  (void)control;
  s->kept   = exp(-x);
  s->before = mean - s->kept;
  s->now    = 1 - mean;
  for (PetscInt way = 0; way < 2; way++) PetscCall(Remember(s, state, way, NULL, &c[way]));
  for (PetscInt way = 0; way < 2; way++) PetscCall(Set(state, way, DISPLACED, &u[way]));
  PetscCall(SamElasticitySetUp(e));
  PetscCall(AddCreep(e, ops->applynormal, c[0], u[0]));
  PetscCall(AddCreep(e, ops->applytangential, c[1], u[1]));
  if (!e->traits.coupled) return 0;
  PetscCall(AddCreep(e, ops->applytangentialtonormal, c[1], u[0]));
  return AddCreep(e, ops->applynormaltotangential, c[0], u[1]);
}

static PetscErrorCode Displace(SamElasticity e, SamConditions conditions, SamState state, const SamControl *control,
                               Vec u_z, Vec u_t, PetscBool *adds)
{
  const Vec to[2] = {u_z, u_t};

  (void)e, (void)conditions, (void)control;
  for (PetscInt way = 0; way < 2; way++) {
    const Vec u = SamStateReadField(state, SamStateFindField(state, fields[way][DISPLACED].name));

    if (adds && u) *adds = PETSC_TRUE;
    if (to[way] && u) PetscCall(VecAXPY(to[way], 1, u));
  }
  return 0;
}

static PetscErrorCode Advance(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  const Vec traction[2] = {pressure, shear};
  Vec       to;

  for (PetscInt way = 0; way < 2; way++) {
    PetscCall(Remember((const Solid *)e->data, state, way, traction[way], &to));
    PetscCall(Set(state, way, TRACTION, &to));
    PetscCall(VecCopy(traction[way], to));
  }
  return 0;
}

/* ---- the type ---- */

static const SamOptionRow rows[] = {{"creep_part", "part of the creep relative to the instantaneous displacement",
                                     SAM_OPTION_REAL, offsetof(Solid, part), .range = SAM_RANGE_NONNEGATIVE},
                                    {"creep_time", "retardation time of the creep", SAM_OPTION_REAL,
                                     offsetof(Solid, time), .range = SAM_RANGE_POSITIVE, .unit = "s"}};

static PetscErrorCode SetFromOptions(SamElasticity e, const SamOptions *from)
{
  return SamOptionsRead(from, NULL, SAM_OPTION_ROWS(rows), e->data, NULL);
}

static PetscErrorCode AddParameters(SamElasticity e, SamParameters *parameters)
{
  return SamParametersAddReals(parameters, "creep", PETSC_TRUE, 2, &((const Solid *)e->data)->part);
}

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  ((Solid *)child->data)->finest = ((const Solid *)parent->data)->finest;
  return 0;
}

PetscErrorCode CreateViscous(SamElasticity e)
{
  Solid *s;

  PetscCall(PetscNew(&s));
  *s      = (Solid){.part = 0, .time = 1, .finest = s};
  e->data = s;
  e->ops  = (SamElasticityOps){.setfromoptions          = SetFromOptions,
                               .inherit                 = Inherit,
                               .addparameters           = AddParameters,
                               .applynormal             = ApplyNormal,
                               .applytangential         = ApplyTangential,
                               .applynormalsingle       = ApplyNormalSingle,
                               .applytangentialsingle   = ApplyTangentialSingle,
                               .preconditionnormal      = PreconditionNormal,
                               .preconditiontangential  = PreconditionTangential,
                               .getselfinfluence        = GetSelfInfluence,
                               .applynormaltotangential = ApplyNormalToTangential,
                               .applytangentialtonormal = ApplyTangentialToNormal,
                               .declare                 = Declare,
                               .begin                   = Begin,
                               .displace                = Displace,
                               .advance                 = Advance};
  return SamElasticitySetInner(e, SAM_ELASTICITY_HALFSPACE);
}

/* A body with a memory in time: a film on periodic bodies that creeps, at a rate in proportion to the last pressure. */
#include "trials.h"
#include <petsam/private/elasticityimpl.h>

#define RATE(e) (*(PetscReal *)(e)->data)

static const SamStateField creep = {"creep",
                                    "m",
                                    "thickness that the film has lost by creep",
                                    .components  = 1,
                                    .generations = 2,
                                    .kept        = PETSC_TRUE,
                                    .result      = SAM_RESULT_OFFERED,
                                    .motion      = SAM_MOVES};
static const SamStateField last  = {
   "creep_pressure",   "Pa", "pressure of the last step", .components = 1, .generations = 2, .kept = PETSC_TRUE,
   .motion = SAM_MOVES};

static PetscErrorCode SetFromOptions(SamElasticity e, const SamOptions *from)
{
  return SamOptionsReal(from, "creep_rate", "rate of the film's creep", "m/(Pa s)", SAM_RANGE_POSITIVE, &RATE(e), NULL);
}

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  RATE(child) = RATE(parent);
  return 0;
}

static PetscErrorCode Declare(SamElasticity e, SamState state)
{
  PetscInt id;

  (void)e;
  PetscCall(SamStateDeclareField(state, &creep, &id));
  return SamStateDeclareField(state, &last, &id);
}

static PetscErrorCode Begin(SamElasticity e, SamState state, const SamControl *control, PetscReal duration)
{
  const PetscInt id     = SamStateFindField(state, creep.name);
  const Vec      before = SamStateGetField(state, id, SAM_COMMITTED);
  const Vec      p      = SamStateGetField(state, SamStateFindField(state, last.name), SAM_COMMITTED);
  Vec            now;

  (void)control;
  PetscCall(SamStateSetField(state, id, &now));
  PetscCall(before ? VecCopy(before, now) : VecSet(now, 0));
  return p ? VecAXPY(now, RATE(e) * duration, p) : 0;
}

static PetscErrorCode Displace(SamElasticity e, SamConditions conditions, SamState state, const SamControl *control,
                               Vec u_z, Vec u_t, PetscBool *adds)
{
  const Vec now = SamStateReadField(state, SamStateFindField(state, creep.name));

  (void)e, (void)conditions, (void)control, (void)u_t;
  if (adds && now) *adds = PETSC_TRUE;
  return u_z && now ? VecAXPY(u_z, 1, now) : 0;
}

static PetscErrorCode Advance(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  Vec now;

  (void)e, (void)shear;
  PetscCall(SamStateSetField(state, SamStateFindField(state, last.name), &now));
  return VecCopy(pressure, now);
}

PetscErrorCode CreateCreeping(SamElasticity e)
{
  PetscCall(PetscCalloc1(1, (PetscReal **)&e->data));
  e->ops = (SamElasticityOps){.setfromoptions = SetFromOptions,
                              .inherit        = Inherit,
                              .declare        = Declare,
                              .begin          = Begin,
                              .displace       = Displace,
                              .advance        = Advance};
  return SamElasticitySetInner(e, SAM_ELASTICITY_PERIODIC);
}

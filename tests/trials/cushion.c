/*
  A thin soft layer between the surfaces, as of debris: where they touch it gives way by c p, so that its displacement
  follows the pressure, and has a tangent. It is found by damped passes, the part of each so small that the roughest
  wave of pressure converges.
*/
#include "trials.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/state.h>

#define FIELD  "cushion"
#define RTOL   1e-11
#define LEAST  0.3 /* of the self-influence: the smallest displacement by a unit wave of pressure is above it */
#define PASSES 2000

typedef struct {
  PetscReal soft; /* c, m/Pa */
  PetscInt  passes;
} Cushion;

static const SamOptionRow row = {"cushion",
                                 "displacement of a soft layer by the pressure",
                                 SAM_OPTION_REAL,
                                 offsetof(Cushion, soft),
                                 .range    = SAM_RANGE_NONNEGATIVE,
                                 .unit     = "m/Pa",
                                 .recorded = PETSC_TRUE};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  (void)from;
  *asked = ((Cushion *)law->data)->soft > 0 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField field = {.name        = FIELD,
                                      .unit        = "m",
                                      .text        = "displacement of the soft layer",
                                      .components  = 1,
                                      .generations = 2,
                                      .kept        = PETSC_TRUE,
                                      .motion      = SAM_STAYS,
                                      .result      = SAM_RESULT_OFFERED,
                                      .separates   = PETSC_TRUE};
  PetscInt                   id;

  (void)law;
  return SamStateDeclareField(state, &field, &id);
}

static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  const Vec u = state ? SamStateReadField(state, SamStateFindField(state, FIELD)) : NULL;

  (void)law, (void)control, (void)u_t, (void)e;
  if (adds && u) *adds = PETSC_TRUE;
  return u && u_z ? VecAXPY(u_z, 1, u) : 0;
}

static PetscErrorCode Follow(SamLaw law, SamLawContact *contact, PetscBool *again)
{
  Cushion *const c     = (Cushion *)law->data;
  const PetscInt id    = SamStateFindField(contact->state, FIELD);
  const Vec      tried = SamStateGetField(contact->state, id, SAM_TRIED),
            last       = SamStateGetField(contact->state, id, SAM_COMMITTED);
  PetscReal self[2], change, size;
  Vec       u, more;

  if (!contact->solved) return 0;
  PetscCall(SamElasticityGetSelfInfluence(law->elasticity, &self[0], &self[1]));
  PetscCall(SamStateSetField(contact->state, id, &u));
  if (!tried) PetscCall(last ? VecCopy(last, u) : VecSet(u, 0));
  PetscCall(VecDuplicate(u, &more));
  PetscCall(VecWAXPY(more, -c->soft, contact->pressure, u)); /* minus the change */
  PetscCall(VecNorm(more, NORM_INFINITY, &change));
  PetscCall(VecNorm(u, NORM_INFINITY, &size));
  *again = change > RTOL * size && c->passes++ < PASSES ? PETSC_TRUE : PETSC_FALSE;
  if (*again)
    PetscCall(VecAXPY(u, -1 / (1 + c->soft / (LEAST * self[0])), more));
  else
    c->passes = 0;
  return VecDestroy(&more);
}

static PetscErrorCode Tangent(SamLaw law, SamState state, Vec pressure, Vec shear, Vec u_z, Vec u_t)
{
  (void)state, (void)shear, (void)u_t;
  return VecAXPY(u_z, ((Cushion *)law->data)->soft, pressure);
}

PetscErrorCode CreateCushion(SamLaw law)
{
  PetscCall(PetscNew((Cushion **)&law->data));
  law->option             = row.name;
  law->heading            = "Soft layer";
  law->rows               = &row;
  law->row_count          = 1;
  law->displaces          = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.declare        = Declare;
  law->ops.displace       = Displace;
  law->ops.follow         = Follow;
  law->ops.tangent        = Tangent;
  return 0;
}

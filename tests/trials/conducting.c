/*
  A body with a conductivity: half-spaces through whose contact a current flows, of heat or of charge. The potential of
  a current density j on the surface of a body of conductivity k is int j/(2 pi k r) dA, the same integral as the normal
  displacement by a pressure. So the current through a contact between bodies at two potentials is the pressure below
  a rigid flat punch on its cells: a normal problem, whose separation is 0 there, and elsewhere more than the approach.
  Source: J. R. Barber, Bounds on the electrical resistance between contacting elastic rough bodies, Proc. R. Soc. A
  459 (2003) 53-66.
*/
#include "trials.h"
#include <petsam/normal.h>
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/state.h>

typedef struct {
  PetscReal conductivity[2];
} Conductor;

static const SamStateField density = {
  "conducted",        "W/(m2 K)", "flux by a unit difference of temperature", 1, 2, .result = SAM_RESULT_OFFERED,
  .motion = SAM_MOVES};

static const SamOptionRow row = {
  "conductivities", "conductivity of body 1 and 2 (W/(m K))", SAM_OPTION_REAL, 0, .range = SAM_RANGE_POSITIVE,
  .size = 2};

static PetscErrorCode SetFromOptions(SamElasticity e, const SamOptions *from)
{
  return SamOptionsRead(from, NULL, 1, &row, e->data, NULL);
}

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  *(Conductor *)child->data = *(const Conductor *)parent->data;
  return 0;
}

static PetscErrorCode Declare(SamElasticity e, SamState state)
{
  static const SamStateNumber conductance = {
    "conductance", "W/K", "conductance of the contact", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1};

  (void)e;
  PetscCall(SamStateDeclareField(state, &density, &(PetscInt){0}));
  return SamStateDeclareNumber(state, &conductance, &(PetscInt){0});
}

/* Sets the separation of a punch on the cells in contact, and its depth beyond them. */
static PetscErrorCode MakePunch(Vec pressure, PetscReal depth, Vec h)
{
  const double *p;
  double       *to;
  PetscInt      n;

  PetscCall(VecGetLocalSize(pressure, &n));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayWrite(h, &to));
  for (PetscInt k = 0; k < n; k++) to[k] = p[k] > 0 ? 0 : depth;
  PetscCall(VecRestoreArrayWrite(h, &to));
  return VecRestoreArrayRead(pressure, &p);
}

static PetscErrorCode Advance(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  const PetscReal *const k = ((const Conductor *)e->data)->conductivity;
  /* a displacement of one cell is a difference of the potential of so much, K per W/m2 instead of m/Pa */
  const PetscReal difference = e->grid->dx * (1 / k[0] + 1 / k[1]) / (2 * PETSC_PI * e->pair->normal);
  SamBalance      punch      = {.kind = SAM_BALANCE_NORMAL, .rigid = {e->grid->dx, 0, 0}};
  SamNormal       normal;
  Vec             h, flux;

  (void)shear;
  PetscCall(SamStateSetField(state, SamStateFindField(state, density.name), &flux));
  PetscCall(VecDuplicate(pressure, &h));
  PetscCall(MakePunch(pressure, 2 * punch.rigid[0], h));
  PetscCall(SamNormalCreate(e->inner, &normal));
  PetscCall(SamNormalSolve(normal, h, &punch, PETSC_FALSE, flux));
  PetscCall(SamNormalDestroy(&normal));
  PetscCall(VecDestroy(&h));
  *SamStateNumbers(state, SamStateFindNumber(state, "conductance"), SAM_TRIED) = punch.load[0] / difference;
  return VecScale(flux, 1 / difference);
}

PetscErrorCode CreateConducting(SamElasticity e)
{
  Conductor *c;

  PetscCall(PetscNew(&c));
  *c      = (Conductor){{1, 1}};
  e->data = c;
  e->ops =
    (SamElasticityOps){.setfromoptions = SetFromOptions, .inherit = Inherit, .declare = Declare, .advance = Advance};
  return SamElasticitySetInner(e, SAM_ELASTICITY_HALFSPACE);
}

/*
  The temperature and the thermal stress below the surface by the steady heat of a step: a part of the stresses in a
  body (private/stresspart.h). The temperature is that of the heat into the body, on a half-space whose material moves
  along x (heatoperator.c); the stress is that of a body that expands (thermalstress.c).
*/
#include "heat.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/body.h>
#include <petsam/private/grid.h>
#include <petsam/private/stresspart.h>

typedef struct {
  SamHeatBody body;
  double      bulk;   /* temperature far from the contact, K */
  double      factor; /* expansion times Young's modulus, Pa/K */
  /* the temperature: its operator at the number of a depth, which serves all steps */
  SamConductor conductor;
  PetscInt     depth;
  /* the stress */
  SamThermalStress operator;
  Vec              flux;
} Below;

static const char *const heats[2] = {"heat_1", "heat_2"};

/* Returns a number among the parameters of the contact, of a body or (0) of both; 0 if it is not there. */
static PetscReal ParameterOf(SamStressPart part, PetscInt body, const char name[])
{
  const SamParameter *parameter;
  char                whole[48], first[16] = "";

  if (!part->source->parameters) return 0;
  if (body) (void)snprintf(first, sizeof(first), "body%d_", (int)body);
  (void)snprintf(whole, sizeof(whole), "%s%s", first, name);
  parameter = SamParametersFind(part->source->parameters, whole);
  return parameter && parameter->count == 1 ? parameter->value[0] : 0;
}

/* Reads this rank's rows of the heat into the body in a step. */
static PetscErrorCode ReadHeat(SamStressPart part, PetscInt step, Vec flux)
{
  double *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(flux, &a));
  PetscCall((*part->source->read)(part->source->context, step, heats[part->places->body - 1], a));
  PetscCall(VecRestoreArray(flux, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the temperature ---- */

static PetscErrorCode Temperature(SamStressPart part, PetscInt step, PetscInt depth, Vec values)
{
  Below *const b = (Below *)part->data;

  PetscFunctionBegin;
  if (b->depth != depth) {
    PetscCall(SamConductorDestroy(&b->conductor));
    PetscCall(SamConductorCreate(part->places->grid, part->source->settings, &b->body, part->places->depth[depth],
                                 &b->conductor));
    b->depth = depth;
  }
  PetscCall(ReadHeat(part, step, values));
  PetscCall(SamConductorApply(b->conductor, values, values));
  PetscCall(VecShift(values, (PetscScalar)b->bulk));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUpTemperature(SamStressPart part, PetscBool has)
{
  const SamStressPlaces *const places = part->places;

  PetscFunctionBegin;
  PetscCheck(has, places->grid->comm, SAM_ERR_USER,
             "-quantities temperature: %s has no frictional heat: run petsam with -heat steady and an output that has "
             "heat_1 and heat_2",
             part->source->name);
  PetscCheck(!places->moves, places->grid->comm, SAM_ERR_USER,
             "-quantities temperature: the points of body %" PetscInt_FMT
             " slide under the contact, where it is not known: omit it, or give the other body",
             places->body);
  part->ops.value = Temperature;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the stress ---- */

static PetscErrorCode Stress(SamStressPart part, PetscInt step, PetscInt depth, Vec stress)
{
  const Below *const b = (const Below *)part->data;

  PetscFunctionBegin;
  PetscCall(ReadHeat(part, step, b->flux));
  PetscCall(SamThermalStressAdd(b->operator, part->places->depth[depth], b->flux, b->factor, stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUpStress(SamStressPart part, PetscReal expansion, PetscBool has)
{
  Below *const                 b      = (Below *)part->data;
  const SamStressPlaces *const places = part->places;
  const PetscReal    speed = PetscAbsReal(b->body.speed), least = SamThermalStressLeast(places->grid, &b->body);
  const SamExpansion of = SamBodyExpansion(part->body, (double)expansion);

  PetscFunctionBegin;
  PetscCheck(has, places->grid->comm, SAM_ERR_USER,
             "%s: body %" PetscInt_FMT " expands by heat, and the heat of the steps is not there: its thermal stress "
             "would be missing: run petsam with an output that has heat_1 and heat_2, and petsam-stress on that",
             part->source->name, places->body);
  PetscCheck(!places->moves, places->grid->comm, SAM_ERR_USER,
             "-body %" PetscInt_FMT ": its points slide under the contact, where the thermal stress is not known: give "
             "the other body",
             places->body);
  PetscCheck(speed == 0 || speed >= least, places->grid->comm, SAM_ERR_USER,
             "%s: body %" PetscInt_FMT " moves at %.3g m/s, so slowly that its heat reaches beyond the grid: its "
             "thermal stress is computed at 0, and from %.3g m/s on",
             part->source->name, places->body, (double)speed, (double)least);
  b->factor = of.stress;
  PetscCall(SamThermalStressCreate(places->grid, part->source->settings, &b->body, of.poisson, &b->operator));
  PetscCall(SamGridCreateVec(places->grid, 1, &b->flux));
  part->ops.plane = Stress;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the part ---- */

static PetscErrorCode Destroy(SamStressPart part)
{
  Below *const b = (Below *)part->data;

  PetscFunctionBegin;
  PetscCall(SamConductorDestroy(&b->conductor));
  PetscCall(SamThermalStressDestroy(&b->operator));
  PetscCall(VecDestroy(&b->flux));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The temperature takes 64 bytes per cell for its kernels, and 312 nodes for each lag along x. */
static double Bytes(SamStressPart part)
{
  const Below *const b     = (const Below *)part->data;
  const SamGrid      g     = part->places->grid;
  double             bytes = 0;

  if (part->ops.value) bytes += 64 * (double)g->cells + 16 * 312 * 2 * (double)g->nx;
  if (part->ops.plane) bytes += SamThermalStressBytes(b->operator) + 8 * (double)g->cells;
  return bytes;
}

static PetscErrorCode Create(SamStressPart part)
{
  const PetscInt  body      = part->places->body;
  const PetscReal expansion = ParameterOf(part, body, "expansion");
  PetscBool       has       = PETSC_FALSE;
  Below          *b;

  PetscFunctionBegin;
  if (!part->wanted && expansion == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (part->source->parameters && SamParametersFind(part->source->parameters, "heat"))
    has = (*part->source->has)(part->source->context, heats[body - 1]);
  PetscCall(PetscNew(&b));
  part->data           = b;
  part->ops.bytes      = Bytes;
  part->ops.destroy    = Destroy;
  b->depth             = -1;
  b->bulk              = (double)ParameterOf(part, body, "bulk_temperature");
  b->body.conductivity = ParameterOf(part, body, "conductivity");
  b->body.capacity     = ParameterOf(part, body, "heat_capacity");
  b->body.speed = part->source->slips ? ParameterOf(part, body, "speed") : -ParameterOf(part, 0, "rolling_speed");
  if (part->wanted) PetscCall(SetUpTemperature(part, has));
  if (expansion != 0) PetscCall(SetUpStress(part, expansion, has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamStressPartType SamStressPart_Heat = {.name     = "thermal stress",
                                              .fields   = {"heat_1", "heat_2"},
                                              .quantity = {"temperature", "temperature", "K",
                                                           "temperature by frictional heat"},
                                              .create   = Create};

/*
  Friction that depends on the temperature: the bound of the shear.

  With -friction_temperature the bound of the shear is b + p dmu(T). It follows the slip of the step, as falling
  friction does, and the temperature that belongs to a slip is found within the bound (contactheat.c). Its derivatives
  are those at the same temperature.
  Source: Ertz and Knothe 2002, Wear 253, 498-508.
*/
#include "heatlaw.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <math.h>

/*
  Computes the velocity of slip from the slip of the step. In steady rolling that is taken at the side of a cell that
  the stream reaches first, so that the mean with the cell behind is that at the centre.
*/
static PetscErrorCode FillRate(SamLaw law, Vec slip, Vec rate)
{
  const SamHeatLaw *h       = (const SamHeatLaw *)law->data;
  const PetscBool   streams = SamMotionOf(law->elasticity)->streams;
  const double     *s;
  double           *v;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(slip, &s));
  PetscCall(VecGetArrayWrite(rate, &v));
  for (PetscInt k = 0; k < law->grid->cells; k++) {
    const PetscInt behind = k % law->grid->nx ? 1 : 0;

    if (streams)
      v[k] = (double)h->rolling * 0.5 * (s[k] + s[k - behind]);
    else
      v[k] = h->duration > 0 ? s[k] / (double)h->duration : 0;
  }
  PetscCall(VecRestoreArrayWrite(rate, &v));
  PetscCall(VecRestoreArrayRead(slip, &s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sets the start of the temperature, relative to the bulk of body 1: that of the last bound in the step that is being
  solved, or that of the step before; 0 outside of contact. So a step does not depend on tries before it.
*/
static PetscErrorCode FillStart(SamLaw law, const SamBoundAt *at, Vec temperature)
{
  const SamHeatLaw *h      = (const SamHeatLaw *)law->data;
  Vec               before = h->solving ? h->start : NULL;
  double            bulk   = 0, *t;
  const double     *p, *was = NULL;

  PetscFunctionBegin;
  if (!before && at->state) {
    before = SamStateGetField(at->state, SamStateFindField(at->state, SAM_TEMPERATURE_1), SAM_COMMITTED);
    bulk   = (double)h->bulk[0];
  }
  PetscCall(VecGetArrayRead(at->pressure, &p));
  if (before) PetscCall(VecGetArrayRead(before, &was));
  PetscCall(VecGetArrayWrite(temperature, &t));
  for (PetscInt k = 0; k < law->grid->cells; k++) t[k] = p[k] > 0 && was ? was[k] - bulk : 0;
  PetscCall(VecRestoreArrayWrite(temperature, &t));
  if (before) PetscCall(VecRestoreArrayRead(before, &was));
  PetscCall(VecRestoreArrayRead(at->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the temperature relative to the bulk of body 1 by the friction that it changes. */
static PetscErrorCode FindTemperature(SamLaw law, const SamBoundAt *at, Vec bound, Vec temperature)
{
  SamHeatLaw *const     h        = (SamHeatLaw *)law->data;
  const SamHeatFriction friction = {h->change[SAM_HEAT_FROM] - h->bulk[0], h->change[SAM_HEAT_OVER],
                                    h->change[SAM_HEAT_CHANGE]};
  const PetscReal       bulk[2]  = {0, h->bulk[1] - h->bulk[0]};
  SamHeatRate           rate     = {.grid = law->grid, .pressure = at->pressure, .bound = bound};
  PetscInt              products;

  PetscFunctionBegin;
  PetscCall(SamHeatLawPrepare(law));
  PetscCall(FillStart(law, at, temperature));
  PetscCall(VecDuplicate(temperature, &rate.rate));
  if (at->slip) PetscCall(FillRate(law, at->slip, rate.rate));
  PetscCall(
    SamHeatSolveFriction(&h->pair, bulk, &friction, &rate, temperature, &products, h->failed, sizeof(h->failed)));
  PetscCall(VecDestroy(&rate.rate));
  if (!h->solving || h->failed[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (!h->start) PetscCall(VecDuplicate(temperature, &h->start));
  PetscCall(VecCopy(temperature, h->start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what the temperature changes to the bound and to its derivative by the pressure. */
static PetscErrorCode AddChange(SamLaw law, const SamBoundAt *at, Vec temperature, const SamBound *bound)
{
  SamHeatLaw *const     h        = (SamHeatLaw *)law->data;
  const SamHeatFriction friction = {h->change[SAM_HEAT_FROM] - h->bulk[0], h->change[SAM_HEAT_OVER],
                                    h->change[SAM_HEAT_CHANGE]};
  const double         *p, *t;
  double               *value = NULL, *slope = NULL, ignored;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(at->pressure, &p));
  PetscCall(VecGetArrayRead(temperature, &t));
  if (bound->value) PetscCall(VecGetArray(bound->value, &value));
  if (bound->by_pressure) PetscCall(VecGetArray(bound->by_pressure, &slope));
  for (PetscInt k = 0; k < law->grid->cells; k++) {
    const double change = p[k] > 0 ? SamHeatFrictionAt(&friction, t[k], &ignored) : 0;

    if (value && value[k] + change * p[k] < 0) h->clipped = PETSC_TRUE;

    if (value) value[k] = PetscMax(value[k] + change * p[k], 0);
    if (slope) slope[k] = PetscMax(slope[k] + change, 0);
  }
  if (bound->by_pressure) PetscCall(VecRestoreArray(bound->by_pressure, &slope));
  if (bound->value) PetscCall(VecRestoreArray(bound->value, &value));
  PetscCall(VecRestoreArrayRead(temperature, &t));
  PetscCall(VecRestoreArrayRead(at->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawBound(SamLaw law, const SamBoundAt *given, const SamBound *bound)
{
  SamHeatLaw *const h  = (SamHeatLaw *)law->data;
  SamBoundAt        at = *given;
  Vec               before, temperature, pressure;

  PetscFunctionBegin;
  if (!h->changes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(law->grid, 1, &before));
  PetscCall(SamGridCreateVec(law->grid, 1, &temperature));
  PetscCall(SamGridCreateVec(law->grid, 1, &pressure));
  PetscCall(VecCopy(at.pressure, pressure)); /* the bound may be written over it */
  at.pressure = pressure;
  PetscCall(bound->value ? VecCopy(bound->value, before) : VecPointwiseMult(before, bound->by_pressure, pressure));
  PetscCall(FindTemperature(law, &at, before, temperature));
  PetscCall(AddChange(law, &at, temperature, bound));
  PetscCall(VecDestroy(&pressure));
  PetscCall(VecDestroy(&temperature));
  PetscCall(VecDestroy(&before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A condition of a step: wetness, from 0 to 1, by half of which friction falls. */
#include "trials.h"
#include <petsam/private/lawimpl.h>

static PetscErrorCode AddConditions(SamLaw law, SamConditions conditions)
{
  static const SamCondition wetness = {.name   = "wetness",
                                       .unit   = "1",
                                       .text   = "wetness of the surfaces, 0 to 1",
                                       .group  = "wetness",
                                       .range  = SAM_RANGE_NONNEGATIVE,
                                       .option = PETSC_TRUE};

  return SamConditionsAdd(conditions, &wetness, (const SamCondition **)law->data);
}

static PetscErrorCode Check(SamLaw law, SamControl *control, PetscInt *wrong, char why[], size_t size)
{
  const SamCondition *const wetness = *(const SamCondition **)law->data;

  *wrong = SAM_COMPONENTS + wetness->place;
  if (SamControlGet(control, wetness) > 1) (void)snprintf(why, size, "expected 0 to 1");
  return 0;
}

static PetscErrorCode Bound(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  const PetscReal factor = 1 - 0.5 * SamControlGet(at->control, *(const SamCondition **)law->data);
  const Vec       all[]  = {bound->value, bound->by_pressure, bound->by_slip};

  for (int k = 0; k < 3; k++)
    if (all[k]) PetscCall(VecScale(all[k], factor));
  return 0;
}

PetscErrorCode CreateWetness(SamLaw law)
{
  PetscCall(PetscNew((const SamCondition ***)&law->data));
  law->always         = PETSC_TRUE;
  law->ops.conditions = AddConditions;
  law->ops.check      = Check;
  law->ops.bound      = Bound;
  law->ops.back       = SamLawNoBack;
  return 0;
}

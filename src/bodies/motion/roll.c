/* The rolled distance of a load step, in which the grid moves over the bodies. */
#include <math.h>
#include <petsam/private/motionimpl.h>

static const SamCondition along[] = {{.name   = "roll",
                                      .unit   = "m",
                                      .text   = "rolled distance of the load step along x",
                                      .group  = "roll",
                                      .range  = SAM_RANGE_ANY,
                                      .change = PETSC_TRUE},
                                     {.name   = "roll_y",
                                      .unit   = "m",
                                      .text   = "rolled distance of the load step along y",
                                      .group  = "roll",
                                      .range  = SAM_RANGE_ANY,
                                      .change = PETSC_TRUE}};

PetscErrorCode SamMotionAddConditions(SamConditions conditions)
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(SamConditionsAdd(conditions, &along[k], NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamMotionRolled(SamConditions conditions, const SamControl *control, PetscReal distance[2])
{
  PetscReal roll[2];

  for (int k = 0; k < 2; k++) roll[k] = SamControlGet(control, SamConditionsFind(conditions, along[k].name));
  for (int k = 0; k < 2 && distance; k++) distance[k] = roll[k];
  return hypot(roll[0], roll[1]);
}

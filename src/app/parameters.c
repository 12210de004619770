/* The parameters that define a run, named as its options. */
#include "runimpl.h"
#include <string.h>

/*
  The loads and bulk stresses of the last step. The steps of a history are in /history of the results, and checkpoints
  compare them themselves (checkpoints.c).
*/
static PetscErrorCode AddLoads(SamParameters *p, SamHistory history)
{
  SamControl control;
  PetscInt   count, increments;
  PetscReal  steps;
  PetscBool  friction, bulk;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(history, &count));
  PetscCall(SamHistoryGetIncrements(history, &increments));
  steps = (PetscReal)increments;
  PetscCall(SamParametersAddReals(p, "steps", PETSC_TRUE, 1, &steps));
  PetscCall(SamHistoryGetStep(history, count - 1, &control));
  PetscCall(SamHistoryHas(history, &friction, &bulk));
  for (PetscInt k = 0; k < (bulk ? SAM_CONTROL_PARTS : SAM_COMPONENTS); k++) {
    const PetscReal value = SamControlPart(&control, k);

    PetscCall(SamParametersAddReals(p, SamControlPartName(&control, k), PETSC_FALSE, 1, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The law of wear. A life can go on with more cycles, and in other jumps. */
static PetscErrorCode AddWear(SamParameters *p, const SamWearing *w)
{
  const char *const kinds[2] = {"steps", "cycles"};
  uint64_t          sum      = 0;

  PetscFunctionBegin;
  PetscCall(SamWearLawsAddParameters(&w->laws, kinds[w->cycles > 0], p));
  if (w->cycles > 0) {
    PetscCall(SamParametersAddReals(p, "wear_cycles", PETSC_FALSE, 1, &w->cycles));
    PetscCall(
      SamParametersAddText(p, "wear_type", PETSC_FALSE, w->life.type == SAM_LIFE_EXPLICIT ? "explicit" : "implicit"));
    PetscCall(SamParametersAddReals(p, w->life.fixed ? "wear_jump" : "wear_rtol", PETSC_FALSE, 1,
                                    w->life.fixed ? &w->life.jump : &w->life.rtol));
  }
  if (!w->points) {
    PetscCall(SamParametersAddText(p, "wear_friction", PETSC_TRUE, "none"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < w->points; k++)
    sum = SamHashMix(sum + SamHashBits(w->at[k]) + 3 * SamHashBits(w->friction[k]));
  PetscCall(SamParametersAddChecksum(p, "wear_friction", sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunCollectParameters(SamRun *run)
{
  PetscFunctionBegin;
  run->parameters.count = 0;
  PetscCall(SamSetupAddParameters(&run->setup, &run->parameters));
  PetscCall(AddLoads(&run->parameters, run->history));
  PetscCall(AddWear(&run->parameters, &run->wearing));
  for (PetscInt k = 0; k < run->parameters.count && run->restart_gap; k++)
    if (!strncmp(run->parameters.list[k].name, "gap_", 4)) run->parameters.list[k].fixed = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

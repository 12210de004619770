/*
  Bodies that yield, in a life: what their strain allows.

  A jump takes the plastic strain as constant. That holds where the cycle has shaken down; so the change of the strain
  in a computed cycle, relative to the strain, times the cycles of a jump stays below the tolerance of jumps, and a body
  that goes on yielding has every cycle computed. A jump that is rejected has tried its cycle on a surface that is worn
  too deep: the strain before it is restored.
*/
#include "lifeimpl.h"
#include <petsam/private/state.h>

/* True for a field on which the separation or the offset of later steps depends, but for the wear loads, which are the
   life's own. */
static PetscBool Matters(SamState state, PetscInt id)
{
  const SamStateField *field = SamStateFieldOf(state, id);

  return field->separates && strcmp(field->name, SAM_WEAR_LOAD) && strcmp(field->name, SAM_WEAR_LOAD2);
}

PetscBool SamLifeHasStrain(SamLife l)
{
  for (PetscInt id = 0; id < SamStateCountFields(l->memory); id++)
    if (Matters(l->memory, id)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SamLifeKeepStrain(SamLife l, SamStrainKept *kept)
{
  PetscFunctionBegin;
  for (PetscInt id = 0; id < SamStateCountFields(l->memory); id++) {
    const Vec now = Matters(l->memory, id) ? SamStateGetField(l->memory, id, SAM_COMMITTED) : NULL;

    if (!now) continue;
    if (!kept->field[id]) PetscCall(VecDuplicate(now, &kept->field[id]));
    PetscCall(VecCopy(now, kept->field[id]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeRestoreStrain(SamLife l, SamStrainKept *kept)
{
  PetscFunctionBegin;
  for (PetscInt id = 0; id < SamStateCountFields(l->memory); id++) {
    Vec now;

    if (!kept->field[id]) continue;
    PetscCall(SamStateRestoreField(l->memory, id, SAM_COMMITTED, &now));
    PetscCall(VecCopy(kept->field[id], now));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeFindFlow(SamLife l, const SamStrainKept *before)
{
  PetscFunctionBegin;
  l->flow = 0;
  for (PetscInt id = 0; id < SamStateCountFields(l->memory); id++) {
    const Vec now = Matters(l->memory, id) ? SamStateGetField(l->memory, id, SAM_COMMITTED) : NULL;
    PetscReal change, size;
    Vec       difference;

    if (!now) continue;
    PetscCall(VecDuplicate(now, &difference));
    PetscCall(VecCopy(now, difference));
    if (before->field[id]) PetscCall(VecAXPY(difference, -1, before->field[id]));
    PetscCall(VecNorm(difference, NORM_INFINITY, &change)); /* a maximum, the same on any number of ranks */
    PetscCall(VecNorm(now, NORM_INFINITY, &size));
    PetscCall(VecDestroy(&difference));
    if (size > 0) l->flow = PetscMax(l->flow, change / size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamLifeMostCycles(SamLife l)
{
  return l->flow > 0 ? PetscMax(1, floor(l->set.rtol / l->flow)) : PETSC_INFINITY;
}

PetscErrorCode SamLifeDropStrain(SamStrainKept *kept)
{
  PetscFunctionBegin;
  for (PetscInt id = 0; id < SAM_STATE_MOST; id++) PetscCall(VecDestroy(&kept->field[id]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

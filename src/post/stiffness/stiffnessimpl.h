/* The parts of the tangent stiffness. */
#ifndef PETSAM_STIFFNESSIMPL_H
#define PETSAM_STIFFNESSIMPL_H

#include <petsam/private/frozen.h>
#include <petsam/stiffness.h>

/*
  SamStiffnessFreeze - freezes the sets of cells of the tried step, or of the committed one for a reversal, and adds the
  unit motions of conditions. Collective. Errors: those of SamStiffnessCompute().
*/
PETSC_INTERN PetscErrorCode SamStiffnessFreeze(SamContact contact, SamStiffnessDirection direction, PetscInt count,
                                               const SamCondition *const conditions[], SamFrozen *frozen);

#endif

/* The parts of the tangent stiffness. */
#ifndef PETSAM_STIFFNESSIMPL_H
#define PETSAM_STIFFNESSIMPL_H

#include <petsam/private/frozen.h>
#include <petsam/private/grid.h>
#include <petsam/stiffness.h>

/* SamResponse - the linear response of the laws that have a method `tangent`, as a part of a frozen contact's. */
typedef struct {
  SamContact contact;        /* borrowed, like the window */
  SamWindow  window;         /* the part of the grid that is frozen; NULL: all of it */
  Vec        whole[4], u[2]; /* scratch: p, q, u_z, u_t on the whole grid; u_z, u_t on the part; without window NULL */
} SamResponse;

/*
  SamStiffnessFreeze - freezes the sets of cells of the tried step, or of the committed one for a reversal, with the
  response of laws, and adds the unit motions of conditions. Collective. Errors: those of SamStiffnessCompute().
  SamStiffnessThaw - frees both. Collective.
*/
PETSC_INTERN PetscErrorCode SamStiffnessFreeze(SamContact contact, SamStiffnessDirection direction, PetscInt count,
                                               const SamCondition *const conditions[], SamResponse *response,
                                               SamFrozen *frozen);
PETSC_INTERN PetscErrorCode SamStiffnessThaw(SamResponse *response, SamFrozen *frozen);

#endif

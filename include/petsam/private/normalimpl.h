/*
  The inside of SamNormal, for methods of the normal problem; see solverimpl.h for how to write one.

  A method starts from a pressure in level->traction that is admissible: p >= 0, and in equilibrium.
*/
#ifndef PETSAM_NORMALIMPL_H
#define PETSAM_NORMALIMPL_H

#include <petsam/private/solverimpl.h>
#include <petsam/normal.h>

/* The given fields of a level. */
enum {
  SAM_NORMAL_SEPARATION /* h, m */
};

PETSC_EXTERN PetscErrorCode SamNormalCreate_ActiveSet(SamSolver solver);
PETSC_EXTERN PetscErrorCode SamNormalCreate_PolonskyKeer(SamSolver solver);

#endif

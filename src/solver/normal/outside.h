/* The check of a pressure found in a window. */
#ifndef PETSAM_OUTSIDE_H
#define PETSAM_OUTSIDE_H

#include <petsam/private/normalimpl.h>

/*
  SamNormalLookOutside - after a solve in a window of the level: whether the bodies are apart outside of the window, so
  that the solution is that of the whole grid. If not, first and size become the smallest rectangle that holds the
  contact and all cells that penetrate. Collective.
*/
PETSC_INTERN PetscErrorCode SamNormalLookOutside(SamSolver solver, SamLevel *level, SamWindow window, PetscInt first[2],
                                                 PetscInt size[2], PetscBool *apart);

#endif

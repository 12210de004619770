/*
  The inside of SamNormal, for methods of the normal problem; see solverimpl.h for how to write one.

  A method starts from a pressure in level->traction that is admissible: 0 <= p <= level->frame.most, and in
  equilibrium.
*/
#ifndef PETSAM_NORMALIMPL_H
#define PETSAM_NORMALIMPL_H

#include <petsam/private/grid.h>
#include <petsam/private/solverimpl.h>
#include <petsam/normal.h>

/* The given fields of a level. */
enum {
  SAM_NORMAL_SEPARATION, /* h, m */
  SAM_NORMAL_DIAGONAL    /* what yields besides the bodies: is added to the diagonal of S, m/Pa; NULL: nothing */
};

/*
  SamNormalSolveKeeping - SamNormalSolve() with the product of the guess, if valid, which becomes that of the result;
  product NULL: none is kept. The balance then holds the rigid-body displacements of the guess. Collective.
*/
PETSC_INTERN PetscErrorCode SamNormalSolveKeeping(SamNormal normal, Vec h, SamBalance *balance, PetscBool guess, Vec p,
                                                  SamProduct *product);

/*
  SamNormalCheckOutside - after a solve in a window of the level: whether the bodies are apart outside of the window, so
  that the solution is that of the whole grid. If not, first and size become the smallest rectangle that holds the
  contact and all cells that penetrate. Collective.
*/
PETSC_INTERN PetscErrorCode SamNormalCheckOutside(SamSolver solver, SamLevel *level, SamWindow window,
                                                  PetscInt first[2], PetscInt size[2], PetscBool *apart);

PETSC_INTERN PetscErrorCode SamNormalCreate_ActiveSet(SamSolver solver);

#endif

/*
  The implementation of SamNormal, for methods of the normal problem; solverimpl.h describes how to write one.

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
  SAM_NORMAL_DIAGONAL    /* extra compliance of each cell, added to the diagonal of S, m/Pa; NULL: none */
};

/*
  SamNormalSolveKeeping - does the same as SamNormalSolve(), and uses the product of the guess if that is valid; it is
  replaced by the product of the result. product NULL: none is kept. On entry, the balance must contain the rigid-body
  displacements of the guess if its product is valid. Collective.
*/
PETSC_INTERN PetscErrorCode SamNormalSolveKeeping(SamNormal normal, Vec h, SamBalance *balance, PetscBool guess, Vec p,
                                                  SamProduct *product);

/*
  SamNormalCheckOutside - sets `apart`, after a solve in a window of the level, to true if the bodies are apart outside
  of the window, so that the solution is that of the whole grid. Else first and size become the smallest rectangle that
  contains the contact and all cells that penetrate. Collective.
*/
PETSC_INTERN PetscErrorCode SamNormalCheckOutside(SamSolver solver, SamLevel *level, SamWindow window,
                                                  PetscInt first[2], PetscInt size[2], PetscBool *apart);

PETSC_INTERN PetscErrorCode SamNormalCreate_ActiveSet(SamSolver solver);

#endif

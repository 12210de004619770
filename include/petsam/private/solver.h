/* Functions of solver, besides petsam/solver.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_SOLVER_H
#define PETSAM_PRIVATE_SOLVER_H

#include <petsam/solver.h>

/*
  SamSolverGetTolerances - gets the values in force; NULL for an unused one. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolverGetTolerances(SamSolver solver, PetscReal *rtol, PetscInt *max_it);

/*
  SamSolverSetLevels - sets the maximum number of nested grids for a solve without a guess; 1: the finest grid only, 0:
  the type's default. Option -<kind>_levels. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolverSetLevels(SamSolver solver, PetscInt levels);

/*
  SamSolverSetErrorIfNotConverged - decides if a solve that does not converge is an error, PETSC_ERR_NOT_CONVERGED, or
  only has a reason. Option -<kind>_error_if_not_converged. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolverSetErrorIfNotConverged(SamSolver solver, PetscBool error);

/*
  SamLevelWork - what all solves of a solver so far did on one of the nested grids: its size, 0: it has not been solved
  on; iterations, products with the operator, and the time on this rank, s.
  SamSolverGetWork - returns the work on the grid whose cells are `depth` times halved, borrowed. Not collective.
*/
#define SAM_NESTED 16 /* nested grids whose work is counted apart */
typedef struct {
  PetscInt n[2], iterations, applies;
  double   seconds;
} SamLevelWork;
PETSC_EXTERN const SamLevelWork *SamSolverGetWork(SamSolver solver, PetscInt depth);

#endif

/* The normal contact problem: pressure under given loads or rigid-body displacements. */
#ifndef PETSAM_NORMAL_H
#define PETSAM_NORMAL_H

#include <petsam/solver.h>

/*
  SamNormal - a solver of the normal problem: find the pressure p so that in every cell
      p >= 0,  g >= 0,  p g = 0,      g = S p + h - (d_z - y r_x + x r_y)
  where g is the gap, S the normal influence operator and h the separation of the undeformed bodies; the balance gives
  the loads or rigid-body displacements. With a pressure limit H (SamNormalSetPressureLimit()) p <= H, and where p = H
  the bodies may overlap, g <= 0: the overlap is the depth by which they yield.
*/
typedef struct _n_SamNormal *SamNormal;

/* SamNormalAsSolver - returns the same object for the functions of solver.h. Not collective. */
static inline SamSolver SamNormalAsSolver(SamNormal normal)
{
  return (SamSolver)normal;
}

#define SAM_NORMAL_ACTIVESET "activeset" /* preconditioned projected CG on an active set, nested grids */

/*
  SamNormalCreate - creates a solver of the default type, activeset, for the grid of an elasticity.

  Collective.

  In:     elasticity - the elasticity; referenced
  Out:    normal     - the solver

  Errors: none of its own.

  See also: SamNormalSolve(), SamSolverSetFromOptions(), SamNormalDestroy().
*/
PETSC_EXTERN PetscErrorCode SamNormalCreate(SamElasticity elasticity, SamNormal *normal);

/*
  SamNormalDestroy - frees the solver and sets the handle to NULL.

  Collective.

  In,out: normal - the solver; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamNormalDestroy(SamNormal *normal);

/*
  SamNormalRegister - adds a type of normal solver, or replaces the one of that name.

  Not collective.

  In:     name   - name of the type
          create - function that sets the solver's methods; see <petsam/private/solverimpl.h>

  Errors: none of its own.

  See also: SamSolverSetType(), SamOptionsPlugins().
*/
PETSC_EXTERN PetscErrorCode SamNormalRegister(const char name[], PetscErrorCode (*create)(SamSolver));

/*
  SAM_SATURATED - the pressure, relative to the limit, that counts as the limit: the projection onto equilibrium may
  shift the pressure of cells at the limit by rounding. This displaces them by far less than the tolerance of the gap.
*/
#define SAM_SATURATED (1 - 1e-9)

/*
  SamNormalSolve - finds the pressure for a separation of the undeformed bodies.

  Collective.

  In:     normal  - the solver
          h       - separation of the undeformed bodies (m), one component
  In,out: balance - a normal balance; on entry the given loads or rigid-body displacements, on return all of them (N, N
                    m, m, rad)
  In:     guess   - true if p is an initial guess; then only the finest grid is used
  In,out: p       - pressure (Pa), one component; on entry the guess, or any values without a guess

  Errors: SAM_ERR_USER for a normal load below zero; PETSC_ERR_SUP for a pressure limit that the method does not have;
  PETSC_ERR_ARG_WRONG for a tangential balance; PETSC_ERR_ARG_SIZ for a vector of another size;
  PETSC_ERR_NOT_CONVERGED only if SamSolverSetErrorIfNotConverged() has been called.

  A solve that does not converge has a reason (SamSolverGetReason()), but is no error unless
  SamSolverSetErrorIfNotConverged() makes it one.

  The relative error is the maximum |g| where p > 0 and the maximum -g elsewhere, over the maximum |S p|; where p is at
  the limit, only g > 0 counts.

  Where displacements are measured from the mean planes (SamElasticityTraits), a given approach must be less than the
  mean separation unless there is a pressure limit; else the reason is NO_EQUILIBRIUM. It is also NO_EQUILIBRIUM for a
  load that exceeds the limit on the whole grid.

  See also: SamSolverSetTolerances(), SamSolverGetReason(), SamSolverGetStatistics().
*/
PETSC_EXTERN PetscErrorCode SamNormalSolve(SamNormal normal, Vec h, SamBalance *balance, PetscBool guess, Vec p);

#endif

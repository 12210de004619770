/* The tangential contact problem: stick and slip under Coulomb friction, for a given pressure. */
#ifndef PETSAM_TANGENTIAL_H
#define PETSAM_TANGENTIAL_H

#include <petsam/solver.h>

/*
  SamTangential - a solver of one increment of the tangential problem: find the shear q with |q| <= b, where b is the
  friction coefficient times the pressure, so that with
      s  = C q + w - (d_x - y r_z, d_y + x r_z),       ds = s - S,
  ds = 0 where |q| < b (stick), and ds = -lambda q with lambda >= 0 where |q| = b (slip). C is the tangential influence
  operator, w a given displacement (that of the pressure, for dissimilar materials), S the slip at the end of the
  previous step; the balance gives the loads or rigid-body displacements. The problem is strictly convex, so it has one
  solution.
*/
typedef struct _n_SamTangential *SamTangential;

/* SamTangentialAsSolver - returns the same object for the functions of solver.h. Not collective. */
static inline SamSolver SamTangentialAsSolver(SamTangential tangential)
{
  return (SamSolver)tangential;
}

#define SAM_TANGENTIAL_ROLLING "rolling" /* rolling: generalised conjugate residuals along the stream */
#define SAM_TANGENTIAL_NEWTON  "newton"  /* Newton on stick and slip with preconditioned projected CG, nested grids */

/*
  SamTangentialCreate - creates a solver of the default type, newton, for the grid of an elasticity.

  Collective.

  In:     elasticity - the elasticity; referenced
  Out:    tangential - the solver

  Errors: none of its own.

  See also: SamTangentialSolve(), SamSolverSetFromOptions(), SamTangentialDestroy().
*/
PETSC_EXTERN PetscErrorCode SamTangentialCreate(SamElasticity elasticity, SamTangential *tangential);

/*
  SamTangentialDestroy - frees the solver and sets the handle to NULL.

  Collective.

  In,out: tangential - the solver; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamTangentialDestroy(SamTangential *tangential);

/*
  SamTangentialRegister - adds a type of tangential solver, or replaces the one of that name.

  Not collective.

  In:     name   - name of the type
          create - function that sets the solver's methods; see <petsam/private/solverimpl.h>

  Errors: none of its own.

  See also: SamSolverSetType(), SamOptionsPlugins().
*/
PETSC_EXTERN PetscErrorCode SamTangentialRegister(const char name[], PetscErrorCode (*create)(SamSolver));

/*
  SAM_SHEAR_FLOOR - the residual is relative to the norm of the shear, but at least to this part of the norm of the
  bound: if a history of displacements leaves almost no shear, the shear is only rounding.
*/
#define SAM_SHEAR_FLOOR 1e-8

/*
  SamTangentialSolve - finds the shear for a bound in each cell.

  Collective.

  In:     tangential - the solver
          bound      - bound of the shear (Pa), one component, >= 0
          offset     - w - S (m), two components; NULL: zero
  In,out: balance    - a tangential balance; on entry the given loads or rigid-body displacements, with `guess` also the
                       initial guess of the displacements; on return all of them (N, N m, m, rad)
  In:     guess      - true if q and the displacements in the balance are an initial guess; then only the finest grid is
                       used
  In,out: q          - shear (Pa), two components; on entry the guess, or any values without a guess

  Errors: PETSC_ERR_ARG_WRONG for a normal balance; PETSC_ERR_ARG_SIZ for a vector of another size;
  PETSC_ERR_NOT_CONVERGED only if SamSolverSetErrorIfNotConverged() has been called.

  A solve that does not converge has a reason (SamSolverGetReason()), but is no error unless
  SamSolverSetErrorIfNotConverged() makes it one.

  After gross slip (SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) the balance is unchanged, unless there was no friction at all,
  and q is the shear of sliding, which carries the loads at their limit.

  The relative error is the residual of the projection equation q = D(q - ds/c), D the projection onto the discs |q| <=
  bound and c the self-influence of a cell: |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)|, in the 2-norm.

  See also: SamSolverSetTolerances(), SamSolverGetReason(), SamCellStateOf().
*/
PETSC_EXTERN PetscErrorCode SamTangentialSolve(SamTangential tangential, Vec bound, Vec offset, SamBalance *balance,
                                               PetscBool guess, Vec q);

/* SamCellState - the state of a cell, as the results store it. */
typedef enum { SAM_CELL_OPEN, SAM_CELL_STICK, SAM_CELL_SLIP } SamCellState;
/*
  SAM_SLIP_MARGIN - relative margin: a cell in contact counts as slipping if |q| >= (1 - SAM_SLIP_MARGIN) of its bound.
*/
#define SAM_SLIP_MARGIN 1e-5

/*
  SamCellStateOf - returns the state of a cell: open, stick or slip.

  Not collective.

  In:     p     - pressure (Pa)
          qx    - shear along x (Pa)
          qy    - shear along y (Pa)
          bound - bound of the shear (Pa)

  Errors: none; it returns no error code.
*/
static inline SamCellState SamCellStateOf(PetscReal p, PetscReal qx, PetscReal qy, PetscReal bound)
{
  if (p <= 0) return SAM_CELL_OPEN;
  return PetscSqrtReal(qx * qx + qy * qy) >= (1 - SAM_SLIP_MARGIN) * bound ? SAM_CELL_SLIP : SAM_CELL_STICK;
}

#endif

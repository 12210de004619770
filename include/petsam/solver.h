/* The common interface of the solvers of the normal and of the tangential problem. */
#ifndef PETSAM_SOLVER_H
#define PETSAM_SOLVER_H

#include <petsam/balance.h>
#include <petsam/elasticity.h>

/*
  SamSolver - a method for one of the two contact problems, with its tolerances, monitors and counts. Its kinds,
  SamNormal and SamTangential, are separate types: each has its own functions to create, solve, destroy, and to register
  methods. The functions of this file do all else, on SamNormalAsSolver(normal) or SamTangentialAsSolver(tangential). A
  solver is used like a KSP: create, set or read options, solve, get the reason.

  The names of options contain the kind, after the user's prefix: -normal_rtol, -tangential_rtol. Below, <kind> stands
  for `normal` or `tangential`.
*/
typedef struct _n_SamSolver *SamSolver;

/* SamSolverType - the name of a method, as it was registered. */
typedef const char *SamSolverType;

/* SamSolverReason - why a solver stopped: converged when > 0, not converged when < 0. */
typedef enum {
  SAM_SOLVER_CONVERGED_RTOL          = 1,  /* the error is at most rtol */
  SAM_SOLVER_CONVERGED_TRIVIAL       = 2,  /* zero traction is the solution: separated bodies, or no cause of shear */
  SAM_SOLVER_ITERATING               = 0,  /* no solve has ended yet */
  SAM_SOLVER_DIVERGED_ITS            = -1, /* max_it reached */
  SAM_SOLVER_DIVERGED_NAN            = -2, /* a number that is not finite, in the input or during the solve */
  SAM_SOLVER_DIVERGED_STAGNATED      = -3, /* no further progress, usually because of rounding */
  SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM = -4  /* no admissible traction balances the loads; for shear: gross slip */
} SamSolverReason;

/*
  SamSolverReasonName - returns the printed name of a reason, for instance CONVERGED_RTOL.

  Not collective.

  In:     reason - the reason

  Errors: none; it returns no error code.

  See also: SamSolverGetReason().
*/
PETSC_EXTERN const char *SamSolverReasonName(SamSolverReason reason);

/*
  SamSolverSetType - chooses the method, one of those registered for the solver's kind.

  Collective.

  In:     solver - the solver
          type   - name of the method

  Errors: SAM_ERR_USER for an unknown type, with the list of registered types.

  The option -<kind>_type sets the type, too.

  See also: SamSolverGetType(), SamNormalRegister(), SamTangentialRegister().
*/
PETSC_EXTERN PetscErrorCode SamSolverSetType(SamSolver solver, SamSolverType type);

/*
  SamSolverGetType - returns the name of the method, borrowed.

  Not collective.

  In:     solver - the solver

  Errors: none; it returns no error code.

  See also: SamSolverSetType().
*/
PETSC_EXTERN SamSolverType SamSolverGetType(SamSolver solver);

/*
  SamSolverSetOptionsPrefix - sets the prefix before `<kind>_` in the names of the options.

  Not collective.

  In:     solver - the solver
          prefix - the prefix, without dash; copied; NULL: none

  Errors: PETSC_ERR_ARG_SIZ for a prefix that is too long.

  See also: SamSolverSetFromOptions().
*/
PETSC_EXTERN PetscErrorCode SamSolverSetOptionsPrefix(SamSolver solver, const char prefix[]);

/*
  SamSolverSetTolerances - sets the relative error and the number of iterations at which the solver stops.

  Not collective.

  In:     solver - the solver
          rtol   - relative error (1), defined at SamNormalSolve() and SamTangentialSolve(); PETSC_DEFAULT: unchanged
          max_it - maximum number of iterations on the finest grid; 0: the type's default; PETSC_DEFAULT: unchanged

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a value below zero, or rtol 0.

  The options -<kind>_rtol and -<kind>_max_it set the same.

  See also: SamSolverGetStatistics(), SamSolverMonitorSet().
*/
PETSC_EXTERN PetscErrorCode SamSolverSetTolerances(SamSolver solver, PetscReal rtol, PetscInt max_it);

/* SamSolverMonitor - a function that is called after an iteration. */
typedef PetscErrorCode (*SamSolverMonitor)(SamSolver solver, PetscInt it, PetscReal error, void *context);

/*
  SamSolverMonitorSet - adds a function that is called after every iteration on the finest grid.

  Not collective; monitors are called on all ranks.

  In:     solver  - the solver
          monitor - the function; it gets the number of iterations so far and the relative error
          context - passed to the function; may be NULL

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than five functions.

  The option -<kind>_monitor adds a function that prints the error.

  See also: SamSolverSetTolerances().
*/
PETSC_EXTERN PetscErrorCode SamSolverMonitorSet(SamSolver solver, SamSolverMonitor monitor, void *context);

/*
  SamSolverSetFromOptions - reads the method of the solver and its settings from the options.

  Collective.

  In:     solver - the solver

  Options: -<kind>_type, -<kind>_rtol, -<kind>_max_it, -<kind>_levels, -<kind>_monitor, -<kind>_error_if_not_converged,
  those of the type, and -<kind>_view and -<kind>_converged_reason, viewers that are used after every solve.
  Errors: SAM_ERR_USER with the option's name for a wrong value.

  See also: SamSolverSetOptionsPrefix(), SamSolverSetTolerances().
*/
PETSC_EXTERN PetscErrorCode SamSolverSetFromOptions(SamSolver solver);

/*
  SamSolverGetReason - returns the reason why the last solve stopped.

  Not collective.

  In:     solver - the solver

  Errors: none; it returns no error code.

  See also: SamSolverReasonName(), SamSolverGetStatistics().
*/
PETSC_EXTERN SamSolverReason SamSolverGetReason(SamSolver solver);

/*
  SamSolverGetStatistics - gets the error and the cost of the last solve; all counts are on the finest grid.

  Not collective.

  In:     solver        - the solver
  Out:    error         - relative error (1); NULL: not wanted
          iterations    - number of iterations; NULL: not wanted
          applies       - number of products with the influence operator; NULL: not wanted
          preconditions - number of products with the preconditioner; NULL: not wanted

  Errors: none of its own.

  See also: SamSolverGetReason(), SamSolverSetTolerances().
*/
PETSC_EXTERN PetscErrorCode SamSolverGetStatistics(SamSolver solver, PetscReal *error, PetscInt *iterations,
                                                   PetscInt *applies, PetscInt *preconditions);

#endif

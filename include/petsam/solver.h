/* What the solvers of the normal and of the tangential problem have in common. */
#ifndef PETSAM_SOLVER_H
#define PETSAM_SOLVER_H

#include <petsam/balance.h>
#include <petsam/elasticity.h>

/*
  SamSolver - a method for one of the two contact problems, with its tolerances, monitors and counts. Its kinds are
  SamNormal and SamTangential, types of their own: each has its functions to create, solve, destroy, and to register
  methods. All else is done by the functions of this file, on SamNormalAsSolver(normal) or
  SamTangentialAsSolver(tangential). Used like a KSP: create, set or read options, solve, get the reason.

  The names of options carry the kind, after the user's prefix: -normal_rtol, -tangential_rtol. Below, <kind> stands for
  `normal` or `tangential`.
*/
typedef struct _n_SamSolver *SamSolver;

/* SamSolverType - the name of a method, as it was registered. */
typedef const char *SamSolverType;

/* SamSolverReason - why a solver stopped: converged when > 0, not converged when < 0. */
typedef enum {
  SAM_SOLVER_CONVERGED_RTOL          = 1,  /* the error is at most rtol */
  SAM_SOLVER_CONVERGED_TRIVIAL       = 2,  /* zero traction solves it: separated bodies, or nothing that causes shear */
  SAM_SOLVER_ITERATING               = 0,  /* no solve has ended yet */
  SAM_SOLVER_DIVERGED_ITS            = -1, /* max_it reached */
  SAM_SOLVER_DIVERGED_NAN            = -2, /* a number that is not finite, in the input or on the way */
  SAM_SOLVER_DIVERGED_STAGNATED      = -3, /* no further progress, as a rule because of rounding */
  SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM = -4  /* no admissible traction balances the loads; for shear: gross slip */
} SamSolverReason;
/* SamSolverReasonName - the reason as it is printed, CONVERGED_RTOL for instance. Not collective. */
PETSC_EXTERN const char *SamSolverReasonName(SamSolverReason reason);

/*
  SamSolverSetType - chooses the method, one of those registered for the solver's kind. Option -<kind>_type. Collective.
  Errors: SAM_ERR_USER for an unknown type, with the list of registered types.
*/
PETSC_EXTERN PetscErrorCode SamSolverSetType(SamSolver solver, SamSolverType type);
PETSC_EXTERN SamSolverType  SamSolverGetType(SamSolver solver);

/* SamSolverSetOptionsPrefix - what stands before `<kind>_` in the names of the options; NULL: nothing. */
PETSC_EXTERN PetscErrorCode SamSolverSetOptionsPrefix(SamSolver solver, const char prefix[]);

/*
  SamSolverSetTolerances - `rtol`: the relative error, defined at SamNormalSolve() and SamTangentialSolve(), at which
  the solver stops (option -<kind>_rtol); `max_it`: most iterations on the finest grid, 0: the type's default (option
  -<kind>_max_it). PETSC_DEFAULT leaves a value as it is. SamSolverGetTolerances - the values in force; NULL for an
  unused one. Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a value below zero, or rtol 0.
*/
PETSC_EXTERN PetscErrorCode SamSolverSetTolerances(SamSolver solver, PetscReal rtol, PetscInt max_it);
PETSC_INTERN PetscErrorCode SamSolverGetTolerances(SamSolver solver, PetscReal *rtol, PetscInt *max_it);

/*
  SamSolverSetLevels - most nested grids that a solve without a guess begins on; 1: the finest only, 0: the type's
  default. Option -<kind>_levels. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolverSetLevels(SamSolver solver, PetscInt levels);

/*
  SamSolverSetErrorIfNotConverged - whether a solve that does not converge is an error, PETSC_ERR_NOT_CONVERGED, and not
  only a reason. Option -<kind>_error_if_not_converged. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolverSetErrorIfNotConverged(SamSolver solver, PetscBool error);

/*
  SamSolverMonitorSet - adds a function that is called after every iteration on the finest grid, with the number of
  iterations so far and the relative error; at most five. Option -<kind>_monitor adds one that prints the error. Not
  collective; monitors are called on all ranks.
*/
typedef PetscErrorCode (*SamSolverMonitor)(SamSolver solver, PetscInt it, PetscReal error, void *context);
PETSC_EXTERN PetscErrorCode SamSolverMonitorSet(SamSolver solver, SamSolverMonitor monitor, void *context);

/*
  SamSolverSetFromOptions - reads the options named above and those of the type; -<kind>_view and
  -<kind>_converged_reason, viewers that are used after every solve. Collective. Errors: SAM_ERR_USER with the option's
  name for a wrong value.
*/
PETSC_EXTERN PetscErrorCode SamSolverSetFromOptions(SamSolver solver);

/* SamSolverGetReason - why the last solve stopped. Not collective. */
PETSC_EXTERN SamSolverReason SamSolverGetReason(SamSolver solver);

/*
  SamSolverGetStatistics - of the last solve: the relative error reached, iterations, products with the influence
  operator and with the preconditioner, all on the finest grid; NULL for an unused one. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamSolverGetStatistics(SamSolver solver, PetscReal *error, PetscInt *iterations,
                                                   PetscInt *applies, PetscInt *preconditions);

#endif

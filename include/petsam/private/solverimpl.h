/* What both solver classes are made of besides their numerics: tolerances, options, monitors, counts. */
#ifndef PETSAM_SOLVER_H
#define PETSAM_SOLVER_H

#include <petsam/private/baseimpl.h>

#define SAM_MONITORS 5

/* A monitor gets the object that holds this part. */
typedef PetscErrorCode (*SamSolverMonitor)(void *owner, PetscInt it, PetscReal error, void *context);

typedef struct {
  /* fixed at creation */
  MPI_Comm    comm;
  void       *owner;
  const char *kind; /* "normal", "tangential": between the user's prefix and the option's name */
  const char *error_help;
  /* what the user set; 0 stands for the type's default */
  char      type[32];
  char      prefix[64];
  PetscReal rtol;
  PetscInt  max_it, levels;
  PetscBool monitor_error, error_if_not_converged;
  /* monitors */
  SamSolverMonitor monitor[SAM_MONITORS];
  void            *monitor_context[SAM_MONITORS];
  PetscInt         monitors;
  /* the type's defaults */
  PetscInt default_levels, default_max_it;
  /* status, of the finest grid */
  PetscReal error;
  PetscInt  iterations, applies, preconditions;
} SamSolver;

PETSC_EXTERN PetscErrorCode SamSolverMonitorSet(SamSolver *solver, SamSolverMonitor monitor, void *context);
/* Reads all options but the type, which is returned when given. */
PETSC_EXTERN PetscErrorCode SamSolverSetFromOptions(SamSolver *solver, const char types[], char type[], size_t size,
                                                    PetscBool *set_type);
PETSC_EXTERN PetscErrorCode SamSolverView(const SamSolver *solver, PetscViewer viewer);
/* -view and -converged_reason, after a solve. */
PETSC_EXTERN PetscErrorCode SamSolverViewFromOptions(const SamSolver *solver, PetscBool converged, const char reason[]);
/* Clears the counts. */
PETSC_EXTERN void     SamSolverStart(SamSolver *solver);
PETSC_EXTERN PetscInt SamSolverMaxIterations(const SamSolver *solver);
PETSC_EXTERN PetscInt SamSolverLevels(const SamSolver *solver);
/* Calls the monitors with the number of iterations so far. */
PETSC_EXTERN PetscErrorCode SamSolverCallMonitors(SamSolver *solver, PetscReal error);

#endif

/* The normal contact problem: pressure under given loads or rigid displacements. */
#ifndef PETSAM_NORMAL_H
#define PETSAM_NORMAL_H

#include <petsam/balance.h>
#include <petsam/elasticity.h>

/*
  SamNormal - solver of: p >= 0, g >= 0, p g = 0 in every cell, where g = S p + h - (d_z - y r_x + x r_y) is the gap, S
  the compliance and h the separation of the undeformed bodies, with the loads or rigid displacements of a balance. Used
  like a KSP: create, set or read options, solve, ask for the reason.
*/
typedef struct _n_SamNormal *SamNormal;

typedef const char *SamNormalType;
#define SAM_NORMAL_ACTIVESET    "activeset"    /* preconditioned projected CG on an active set, nested grids */
#define SAM_NORMAL_POLONSKYKEER "polonskykeer" /* the classical projected CG */

typedef enum {
  SAM_NORMAL_CONVERGED_RTOL          = 1,
  SAM_NORMAL_CONVERGED_SEPARATED     = 2, /* no contact, p = 0 */
  SAM_NORMAL_CONVERGED_ITERATING     = 0,
  SAM_NORMAL_DIVERGED_ITS            = -1, /* max_it reached */
  SAM_NORMAL_DIVERGED_NAN            = -2,
  SAM_NORMAL_DIVERGED_STAGNATED      = -3, /* rounding or no further progress */
  SAM_NORMAL_DIVERGED_NO_EQUILIBRIUM = -4  /* no pressure on this grid balances the loads */
} SamNormalReason;
PETSC_EXTERN const char *SamNormalReasonName(SamNormalReason reason);

/* SamNormalCreate - a solver for grids of this compliance (referenced). Collective. */
PETSC_EXTERN PetscErrorCode SamNormalCreate(SamElasticity elasticity, SamNormal *normal);
PETSC_EXTERN PetscErrorCode SamNormalDestroy(SamNormal *normal);
/* SamNormalRegister - adds a type; its create function sets the solver's methods. Not collective. */
PETSC_EXTERN PetscErrorCode SamNormalRegister(const char name[], PetscErrorCode (*create)(SamNormal));
PETSC_EXTERN PetscErrorCode SamNormalSetType(SamNormal normal, SamNormalType type);
PETSC_EXTERN PetscErrorCode SamNormalGetType(SamNormal normal, SamNormalType *type);
/* Prefix put before `normal_` in the options' names. */
PETSC_EXTERN PetscErrorCode SamNormalSetOptionsPrefix(SamNormal normal, const char prefix[]);
/*
  SamNormalSetTolerances - rtol: largest |g| in contact and -g outside, relative to the largest elastic displacement;
  max_it: iterations on the finest grid. PETSC_DEFAULT keeps a value.
*/
PETSC_EXTERN PetscErrorCode SamNormalSetTolerances(SamNormal normal, PetscReal rtol, PetscInt max_it);
PETSC_EXTERN PetscErrorCode SamNormalGetTolerances(SamNormal normal, PetscReal *rtol, PetscInt *max_it);
/* SamNormalSetLevels - most nested grids, 1: the finest only, 0: the type's default. */
PETSC_EXTERN PetscErrorCode SamNormalSetLevels(SamNormal normal, PetscInt levels);
/*
  SamNormalSetFromOptions - -normal_type, -normal_rtol, -normal_max_it, -normal_levels, -normal_monitor,
  -normal_converged_reason, -normal_view, -normal_error_if_not_converged. Collective.
*/
PETSC_EXTERN PetscErrorCode SamNormalSetFromOptions(SamNormal normal);

/*
  A monitor gets the SamNormal and is called on the finest grid after every iteration with the relative error; monitors
  add up.
*/
typedef PetscErrorCode (*SamNormalMonitor)(void *normal, PetscInt it, PetscReal error, void *context);
PETSC_EXTERN PetscErrorCode SamNormalMonitorSet(SamNormal normal, SamNormalMonitor monitor, void *context);
PETSC_EXTERN PetscErrorCode SamNormalView(SamNormal normal, PetscViewer viewer);

/*
  SamNormalSolve - finds p (Pa, one component) for the separation h (m). With `guess` p holds a start, and only the
  finest grid is used; otherwise p is overwritten. On return the balance holds all loads and rigid displacements.
  Collective. Not converging is a reason, not an error, unless asked for. Where displacements are counted from the mean
  surface (SamElasticityTraits), a given approach must lie below the mean separation: DIVERGED_NO_EQUILIBRIUM.
*/
PETSC_EXTERN PetscErrorCode SamNormalSolve(SamNormal normal, Vec h, SamBalance *balance, PetscBool guess, Vec p);

PETSC_EXTERN PetscErrorCode SamNormalGetReason(SamNormal normal, SamNormalReason *reason);
/*
  Relative error reached, iterations, products with the compliance and with the preconditioner, all on the finest grid.
*/
PETSC_EXTERN PetscErrorCode SamNormalGetStatistics(SamNormal normal, PetscReal *error, PetscInt *iterations,
                                                   PetscInt *applies, PetscInt *preconditions);

#endif

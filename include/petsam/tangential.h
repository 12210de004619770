/* The tangential contact problem: stick and slip under Coulomb friction, for a given pressure. */
#ifndef PETSAM_TANGENTIAL_H
#define PETSAM_TANGENTIAL_H

#include <petsam/balance.h>
#include <petsam/elasticity.h>

/*
  SamTangential - solver of one increment: find the shear q with |q| <= mu p so that, with
      s  = C q + w - (d_x - y r_z, d_y + x r_z),       ds = s - S,
  ds = 0 where |q| < mu p and ds = -lambda q, lambda >= 0, where |q| = mu p. C is the compliance, w a given displacement
  (from pressure, for dissimilar materials), S the slip at the end of the step before; with the loads or rigid
  displacements of a balance. The problem is strictly convex: it has one solution.
  Used like a KSP, as SamNormal.
*/
typedef struct _n_SamTangential *SamTangential;

typedef const char *SamTangentialType;
#define SAM_TANGENTIAL_NEWTON   "newton"   /* Newton on stick and slip with preconditioned projected CG, nested grids */
#define SAM_TANGENTIAL_GRADIENT "gradient" /* accelerated projected gradient: slow, sure, for comparison */

typedef enum {
  SAM_TANGENTIAL_CONVERGED_RTOL      = 1,
  SAM_TANGENTIAL_CONVERGED_FREE      = 2, /* no friction, no contact or no load: q = 0 */
  SAM_TANGENTIAL_CONVERGED_ITERATING = 0,
  SAM_TANGENTIAL_DIVERGED_ITS        = -1,
  SAM_TANGENTIAL_DIVERGED_NAN        = -2,
  SAM_TANGENTIAL_DIVERGED_STAGNATED  = -3,
  SAM_TANGENTIAL_DIVERGED_GROSS_SLIP = -4 /* no admissible shear balances the loads */
} SamTangentialReason;
PETSC_EXTERN const char *SamTangentialReasonName(SamTangentialReason reason);

PETSC_EXTERN PetscErrorCode SamTangentialCreate(SamElasticity elasticity, SamTangential *tangential);
PETSC_EXTERN PetscErrorCode SamTangentialDestroy(SamTangential *tangential);
PETSC_EXTERN PetscErrorCode SamTangentialRegister(const char name[], PetscErrorCode (*create)(SamTangential));
PETSC_EXTERN PetscErrorCode SamTangentialSetType(SamTangential tangential, SamTangentialType type);
PETSC_EXTERN PetscErrorCode SamTangentialGetType(SamTangential tangential, SamTangentialType *type);
PETSC_EXTERN PetscErrorCode SamTangentialSetOptionsPrefix(SamTangential tangential, const char prefix[]);
/* SamTangentialSetTolerances - rtol: of the residual defined at SamTangentialSolve(). PETSC_DEFAULT keeps a value. */
PETSC_EXTERN PetscErrorCode SamTangentialSetTolerances(SamTangential tangential, PetscReal rtol, PetscInt max_it);
PETSC_EXTERN PetscErrorCode SamTangentialGetTolerances(SamTangential tangential, PetscReal *rtol, PetscInt *max_it);
PETSC_EXTERN PetscErrorCode SamTangentialSetLevels(SamTangential tangential, PetscInt levels);
/* SamTangentialSetFromOptions - as SamNormalSetFromOptions(), with -tangential_. */
PETSC_EXTERN PetscErrorCode SamTangentialSetFromOptions(SamTangential tangential);
/* A monitor gets the SamTangential and is called on the finest grid whenever the residual is known anew. */
typedef PetscErrorCode (*SamTangentialMonitor)(void *tangential, PetscInt it, PetscReal error, void *context);
PETSC_EXTERN PetscErrorCode SamTangentialMonitorSet(SamTangential tangential, SamTangentialMonitor monitor,
                                                    void *context);
PETSC_EXTERN PetscErrorCode SamTangentialView(SamTangential tangential, PetscViewer viewer);

/*
  Shears below this part of mu p count as this much in the relative residual: with displacements of a history behind
  them, less is rounding.
*/
#define SAM_SHEAR_FLOOR 1e-8

/*
  SamTangentialSolve - finds q (Pa, two components) for the bound mu p of each cell's shear (Pa, one component, >= 0) and
  the offset w - S (m, two components; NULL: zero). With `guess` q and the rigid displacements in the balance are a
  start, and only the finest grid is used. On return the balance holds all loads and rigid displacements. The residual
  is that of the projection equation q = D(q - ds/c), D onto the discs |q| <= bound and c the self-influence of a cell,
  relative: |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)| in the 2-norm. Collective. Not converging is a
  reason, not an error, unless asked for.
*/
PETSC_EXTERN PetscErrorCode SamTangentialSolve(SamTangential tangential, Vec bound, Vec offset, SamBalance *balance,
                                               PetscBool guess, Vec q);

PETSC_EXTERN PetscErrorCode SamTangentialGetReason(SamTangential tangential, SamTangentialReason *reason);
PETSC_EXTERN PetscErrorCode SamTangentialGetStatistics(SamTangential tangential, PetscReal *error, PetscInt *iterations,
                                                       PetscInt *applies, PetscInt *preconditions);
/* SamTangentialGetLimit - after DIVERGED_GROSS_SLIP: the factor on the given loads at which sliding begins. */
PETSC_EXTERN PetscErrorCode SamTangentialGetLimit(SamTangential tangential, PetscReal *factor);

#endif

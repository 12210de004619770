/* Shared by the projections of pressures and of shears: the dual problem, see projection.c. */
#ifndef PETSAM_PROJECTIONIMPL_H
#define PETSAM_PROJECTIONIMPL_H

#include <petsam/private/balanceimpl.h>

/*
  SamOrthonormalize - Gram-Schmidt: adds row m to an orthonormal basis, so that row = sum lower[k] basis[k]. Returns
  lower[m], how far the row is from those before it.
*/
PETSC_INTERN double SamOrthonormalize(PetscInt m, double basis[3][3], const double row[3], double lower[3]);

/* Errors of equilibrium, relative to the loads or the sum of the traction. */
#define SAM_BALANCED_EXACT  1e-14 /* rounding at best: Newton's method stops */
#define SAM_BALANCED_ENOUGH 1e-11 /* rounding at worst: a solution all the same */
#define SAM_BALANCED_NEAR   1e-3  /* nearly: a further projection may reach a solution */

/* Value, gradient without F, and Hessian of the dual, and sum |x| as the scale of the gradient. */
typedef struct {
  double value, sums[3], gram[SAM_GRAM], scale;
} SamDual;

#define SAM_DUAL (sizeof(SamDual) / sizeof(double))

/* A pass over this rank's cells, which adds to the dual at a. `context` is the caller's. */
typedef void (*SamDualPass)(const SamFrame *frame, const void *context, const double a[3], SamTotal dual[]);

/*
  SamDualMinimize - Newton's method for the dual. Stops when equilibrium holds to rounding, or when steps no longer
  improve it; `near`: then it nearly holds. With an error of less than `once` at the start only one step is made, and
  whether that was enough (`found` is false) is for the caller to check. Collective.
*/
PETSC_INTERN PetscErrorCode SamDualMinimize(const SamFrame *frame, SamDualPass pass, const void *context, double once,
                                            double a[3], PetscBool *found, PetscBool *near);

/*
  SamDualVanish - finds out whether some a makes the traction vanish when no load is to be carried, to rounding of the
  traction at a = 0. Collective.
*/
PETSC_INTERN PetscErrorCode SamDualVanish(const SamFrame *frame, SamDualPass pass, const void *context, double a[3],
                                          PetscBool *vanishes);

/* SamDualIsBalanced - checks if a traction with these totals is in equilibrium up to a relative error. Collective. */
PETSC_INTERN PetscErrorCode SamDualIsBalanced(const SamFrame *frame, const SamTotal totals[], double limit,
                                              PetscBool *balanced);

#endif

/* Shared by the projections of pressures and of shears: the dual problem, see projection.c. */
#ifndef PETSAM_PROJECTIONIMPL_H
#define PETSAM_PROJECTIONIMPL_H

#include <petsam/private/balanceimpl.h>

/*
  SamOrthonormalize - Gram-Schmidt: adds row m to an orthonormal basis, so that row = sum lower[k] basis[k]. Returns
  lower[m], the distance of the row from the span of the earlier rows.
*/
PETSC_INTERN double SamOrthonormalize(PetscInt m, double basis[3][3], const double row[3], double lower[3]);

/* Errors of equilibrium, relative to the loads or the sum of the traction. */
#define SAM_BALANCED_EXACT  1e-14 /* best case of rounding: Newton's method stops */
#define SAM_BALANCED_ENOUGH 1e-11 /* worst case of rounding: still a solution */
#define SAM_BALANCED_NEAR   1e-3  /* near equilibrium: a further projection may reach a solution */

/* Value, gradient without F, and Hessian of the dual, and sum |x| as the scale of the gradient. */
typedef struct {
  double value, sums[3], gram[SAM_GRAM], scale;
} SamDual;

#define SAM_DUAL (sizeof(SamDual) / sizeof(double))

/* A pass over this rank's cells, which adds to the dual at a. `context` is the caller's. */
typedef void (*SamDualPass)(const SamFrame *frame, const void *context, const double a[3], SamTotal dual[]);

/*
  SamDualMinimize - minimises the dual by Newton's method. Stops when equilibrium holds to rounding, or when steps no
  longer improve it; `near` is then true if it nearly holds. If the error at the start is less than `once`, only one
  step is made; `found` is then false, and the caller checks the result. Collective.
*/
PETSC_INTERN PetscErrorCode SamDualMinimize(const SamFrame *frame, SamDualPass pass, const void *context, double once,
                                            double a[3], PetscBool *found, PetscBool *near);

/*
  SamDualVanish - finds out if, without loads, some a makes the traction vanish, within rounding of the traction at a =
  0. Collective.
*/
PETSC_INTERN PetscErrorCode SamDualVanish(const SamFrame *frame, SamDualPass pass, const void *context, double a[3],
                                          PetscBool *vanishes);

/* SamDualIsBalanced - checks if a traction with these totals is in equilibrium up to a relative error. Collective. */
PETSC_INTERN PetscErrorCode SamDualIsBalanced(const SamFrame *frame, const SamTotal totals[], double limit,
                                              PetscBool *balanced);

#endif

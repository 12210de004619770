/* The tangent stiffness of a solved load step. */
#ifndef PETSAM_STIFFNESS_H
#define PETSAM_STIFFNESS_H

#include <petsam/contact.h>

/*
  The derivative of a contact with friction depends on the direction of its motion. Two are computed:
    SAM_STIFFNESS_FORWARD   loading continues: cells that slip continue to slip. This is the derivative of the tried
                            step's loads with respect to its displacements, the step starting where it did. Friction
                            may follow the slip of the step. What a step of second order takes aside of the slip
                            (step/direction.c) counts as given: with it, where loads turn or N grows, the derivative is
                            that of the step to the first order of its length (0.2 % in a test); with
                            -slip_direction end it is exact.
                            Not symmetric: where cells slip, tangential loads depend on the approach, and not the
                            reverse. Across a step's own direction it counts that slip turns within the step: for a
                            path of small steps it tends to the stiffness of stick there.
    SAM_STIFFNESS_REVERSAL  the motion reverses at the end of the step: all cells in contact stick, and none yields.
                            Symmetric; also right where only the normal force grows, without a limit of the pressure.
*/
typedef enum { SAM_STIFFNESS_FORWARD, SAM_STIFFNESS_REVERSAL } SamStiffnessDirection;
#define SAM_STIFFNESS_DIRECTIONS 2

/* SamStiffness - d(load)/d(rigid displacement) in the order of SamComponent, and its cost. */
typedef struct {
  PetscReal k[SAM_COMPONENTS][SAM_COMPONENTS]; /* k[i][j] = d(load i)/d(rigid j): N/m, N/rad, N, N m/rad */
  PetscBool converged;                         /* else, and where rotations do not exist, k is NaN */
  PetscReal error;                             /* largest residual of a column, relative */
  PetscInt  columns, applies, preconditions;   /* systems solved; products with the operator and its inverse */
} SamStiffness;

/*
  SamStiffnessCompute - the tangent stiffness of the tried step, if there is one, else at the reversal of the committed
  one, whose slip, which the forward stiffness needs, is not kept. Displacements are relative to infinity.
  The boundaries of contact, stick and slip do not move to first order: pressure vanishes at the edge of contact, and
  where stick meets slip both |q| = mu p and ds = 0 hold. So the sets of cells are frozen, and a column solves
    normal      S dp + B' dq = n on cells in contact; dp = 0 on those that yield, if loading continues,
    tangential  C dq + B dp - t = d(ds), which is 0 on cells that stick; on cells that slip
                dq = e db - b/|ds| (I - e e') d(ds),  e = q/|q|,  db = b_p dp - b_s e.d(ds),
  n and t being the unit motion of the column, B the coupling of dissimilar bodies, and b_p and b_s the derivatives of
  the bound b of the shear by the pressure and by the length of the slip: mu and 0 of Coulomb's friction. Leaves the
  contact unchanged.
  Collective. Errors: PETSC_ERR_ORDER without such a step.
*/
PETSC_EXTERN PetscErrorCode SamStiffnessCompute(SamContact contact, SamStiffnessDirection direction,
                                                SamStiffness *stiffness);

/*
  SamStiffnessDeclare - makes both directions' stiffness numbers of a contact's steps: `stiffness`,
  `stiffness_reversal`.
  SamStiffnessRecord - computes them for the tried step, unless it has no solution; a failure becomes the step's
  message. Both are collective.
*/
PETSC_INTERN PetscErrorCode SamStiffnessDeclare(SamContact contact);
PETSC_INTERN PetscErrorCode SamStiffnessRecord(SamContact contact, SamStep *step);
/* SamStiffnessDescribe - the message of a stiffness that did not converge; else empty. Not collective. */
PETSC_INTERN void SamStiffnessDescribe(const SamStiffness *stiffness, char text[], size_t size);

#endif

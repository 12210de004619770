/* The tangent stiffness of a solved load step. */
#ifndef PETSAM_STIFFNESS_H
#define PETSAM_STIFFNESS_H

#include <petsam/contact.h>

/*
  The tangent stiffness of a contact with friction depends on the direction of its motion. Two directions are computed:
    SAM_STIFFNESS_FORWARD   continued loading: cells that slip continue to slip. This is the derivative of the tried
                            step's loads with respect to its displacements, for a fixed start of the step. Friction may
                            depend on the slip of the step. The part of the slip that a step of second order sets aside
                            (step/direction.c) counts as constant: so if loads turn or N grows, the derivative has an
                            error of first order in the length of the step (0.2 % in a test); with -slip_direction end
                            it has no error. It is not symmetric: if cells slip, tangential loads depend on the
                            approach, but not the reverse. Perpendicular to the direction of the step it includes the
                            turning of the slip within the step; for a path of small steps it tends to the stiffness of
                            stick in that direction.
    SAM_STIFFNESS_REVERSAL  reversal at the end of the step: all cells in contact stick, and none yields. It is
                            symmetric, and also correct if only the normal force grows, without a pressure limit.
*/
typedef enum { SAM_STIFFNESS_FORWARD, SAM_STIFFNESS_REVERSAL } SamStiffnessDirection;
#define SAM_STIFFNESS_DIRECTIONS 2

/*
  SamStiffness - d(load)/d(rigid displacement) in the order of SamComponent, then those of load cases, and its cost. The
  load of a case is its number NAME_load, the displacement its factor. Rows and columns beyond these are 0.
*/
#define SAM_STIFFNESS_MOST 86
typedef struct {
  PetscReal k[SAM_STIFFNESS_MOST][SAM_STIFFNESS_MOST]; /* k[i][j] = d(load i)/d(rigid j): N/m, N/rad, N, N m/rad */
  PetscBool converged;                                 /* if false, and for rotations that do not exist, k is NaN */
  PetscReal error;                                     /* largest residual of a column, relative */
  PetscInt  columns, applies, preconditions; /* numbers of systems solved, and of products with operator and inverse */
} SamStiffness;

/*
  SamStiffnessCompute - computes the tangent stiffness of the tried step, or that at the reversal of the committed step.

  Collective.

  In:     contact    - the contact; unchanged
          direction  - continued loading or reversal
          count      - number of load cases
          conditions - their factors, as conditions of the contact's problem; NULL if there are none
  Out:    stiffness  - the matrix (N/m, N/rad, N, N m/rad; of load cases J and J/m), its error and its cost

  Errors: PETSC_ERR_ORDER without a solved step, or without a tried step for continued loading; SAM_ERR_USER for a
  motion of the bodies or a law that has no such stiffness, and for a condition that is no load case.

  Without a tried step only the stiffness at the reversal of the committed step is possible, since the forward stiffness
  needs the slip of the step, which is not kept. Displacements are relative to infinity. A stiffness that does not
  converge is no error.

  The boundaries of contact, stick and slip do not move to first order: pressure vanishes at the edge of contact, and
  where stick meets slip both |q| = mu p and ds = 0 hold. So the sets of cells are frozen, and a column solves

    normal      S dp + B' dq = n on cells in contact; dp = 0 on those that yield, if loading continues,
    tangential  C dq + B dp - t = d(ds), which is 0 on cells that stick; on cells that slip
                dq = e db - b/|ds| (I - e e') d(ds),  e = q/|q|,  db = b_p dp - b_s e.d(ds).

  Here n and t are the unit motion of the column, B is the coupling of dissimilar bodies, and b_p and b_s are the
  derivatives of the bound b of the shear by the pressure and by the length of the slip: mu and 0 of Coulomb's friction.

  See also: SamContactTry(), SamContactCommit().
*/
PETSC_EXTERN PetscErrorCode SamStiffnessCompute(SamContact contact, SamStiffnessDirection direction, PetscInt count,
                                                const SamCondition *const conditions[], SamStiffness *stiffness);

#endif

/* Stresses inside the library: the kernels of one depth, for those who sum them up. */
#ifndef PETSAM_STRESSIMPL_H
#define PETSAM_STRESSIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/stress.h>

/*
  SamStressGroup - kernels that are evaluated together. Of the 18, three are equal to others: what p does to xz and yz,
  q_x and q_y do to zz, and q_y to xz what q_x does to yz.
*/
typedef enum {
  SAM_STRESS_PLANE_P,  /* xx, yy, xy from p */
  SAM_STRESS_PLANE_X,  /* xx, yy, xy from q_x */
  SAM_STRESS_PLANE_Y,  /* xx, yy, xy from q_y */
  SAM_STRESS_NORMAL_P, /* zz, xz, yz from p */
  SAM_STRESS_NORMAL_T, /* xz, yz from q_x, yz from q_y */
  SAM_STRESS_GROUPS
} SamStressGroup;

#define SAM_STRESS_GROUP 3 /* kernels of a group */

/* SamStressKernel - which kernel of which group acts from a traction on a component. */
typedef struct {
  SamStressGroup group;
  PetscInt       member;
} SamStressKernel;
PETSC_EXTERN const SamStressKernel SamStressKernels[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS];

/* The parities of the kernels of a group: odd in x, odd in y. */
PETSC_EXTERN const PetscBool SamStressOdd[SAM_STRESS_GROUPS][SAM_STRESS_GROUP][2];

/* SamStressSource - unit traction on a cell, seen from a depth. */
typedef struct {
  double side[2]; /* of the cell, m */
  double depth;   /* z >= 0, m */
  double poisson;
} SamStressSource;

/*
  SamStressRow - the kernels of a group at the lags (i, j), i = 0 ... n - 1, j >= 0, in cells: the stress in a cell's
  centre by unit traction on the cell that lies so far before it. They contain the correction of values at centres
  (cell.c). Not collective.
*/
PETSC_EXTERN void SamStressRow(const SamStressSource *source, SamStressGroup group, PetscInt j, PetscInt n,
                               double *const values[SAM_STRESS_GROUP]);

/*
  SamStressSign - the sign of a traction on body 1 or 2, seen from inside of it: the shear on body 1 is the opposite of
  that on body 2. Not collective.
*/
static inline double SamStressSign(PetscInt body, PetscInt traction)
{
  return traction != SAM_STRESS_P && body == 1 ? -1 : 1;
}

/* SamStressCheckBody, SamStressCheckDepth - raise PETSC_ERR_ARG_OUTOFRANGE for what cannot be. Collective. */
PETSC_EXTERN PetscErrorCode SamStressCheckBody(MPI_Comm comm, PetscInt body, PetscReal poisson);
PETSC_EXTERN PetscErrorCode SamStressCheckDepth(MPI_Comm comm, PetscReal depth);

/* SamPrincipalOf - the principal stresses of one stress, the largest first. Not collective. */
PETSC_EXTERN void SamPrincipalOf(const double s[SAM_STRESS_COMPONENTS], double p[3]);
/* SamPrincipalDirection - a unit vector in the direction of one of them. Not collective. */
PETSC_EXTERN void SamPrincipalDirection(const double s[SAM_STRESS_COMPONENTS], double principal, double n[3]);

#endif

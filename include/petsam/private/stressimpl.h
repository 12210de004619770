/* The implementation of SamStress, for types of elasticity that compute the stresses in their bodies. */
#ifndef PETSAM_STRESSIMPL_H
#define PETSAM_STRESSIMPL_H

#include <petsam/control.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/fourier.h>
#include <petsam/private/stress.h>

/*
  SamStressGroup - kernels that are evaluated together. Some of the 18 kernels are equal: that of q_y on xz and that of
  q_x on yz in any body that is isotropic along the surface, and in a half-space those of q_x and q_y on zz and those of
  p on xz and yz.
*/
typedef enum {
  SAM_STRESS_PLANE_P,  /* xx, yy, xy from p */
  SAM_STRESS_PLANE_X,  /* xx, yy, xy from q_x */
  SAM_STRESS_PLANE_Y,  /* xx, yy, xy from q_y */
  SAM_STRESS_NORMAL_P, /* zz, xz, yz from p */
  SAM_STRESS_NORMAL_T, /* xz, yz from q_x, yz from q_y */
  SAM_STRESS_NORMAL_Z, /* zz from q_x, zz from q_y, 0: only if these differ from the kernels of p on xz and yz */
  SAM_STRESS_GROUPS
} SamStressGroup;

#define SAM_STRESS_GROUP 3 /* kernels of a group */

/* SamStressKernel - the kernel, by its group and index there, of a component of the stress by a traction. */
typedef struct {
  SamStressGroup group;
  PetscInt       member;
} SamStressKernel;
PETSC_INTERN const SamStressKernel SamStressKernels[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS]; /* in a half-space */
PETSC_INTERN SamStressKernel       SamStressKernelOf(SamStress stress, PetscInt component, PetscInt traction);

/* The parities of the kernels of a group: odd in x, odd in y. */
PETSC_INTERN const PetscBool SamStressOdd[SAM_STRESS_GROUPS][SAM_STRESS_GROUP][2];

/*
  SamStressOps - the methods of a type of elasticity for the stresses in one of its bodies; NULL if it has none. The
  type owns `data`.
    row           required: computes the kernels of a group at a cell's centre at the lags (i, j), i = 0 ... n - 1, j >=
                  0, in cells of these sides, by unit traction on the cell that lies (i, j) before it, z = depth >= 0
                  (all m). They contain the correction of values at centres (kernels/stresscell.c). Not
                  collective.
    usedepth      computes the tables of a depth for the following calls of row. Not collective.
    atedge        does the work of SamStressAtEdge(). Collective.
    reduce        computes from this rank's tractions p, q_x, q_y the `sums` numbers on which a smooth part of the
                  stress depends, for instance that of distant boundaries; they are the same on all ranks. Collective.
    add           adds this part at n points from `first` on, `step` apart (m), to the components. Not collective.
    destroy       frees the data.
*/
typedef struct {
  void (*row)(SamStress, const double side[2], double depth, SamStressGroup, PetscInt j, PetscInt n,
              double *const values[SAM_STRESS_GROUP]);
  PetscErrorCode (*usedepth)(SamStress, PetscReal depth);
  PetscErrorCode (*atedge)(SamStress, Vec field, const SamEdge *edge, double stress[]);
  PetscErrorCode (*reduce)(SamStress, const double *const tractions[], double sums[]);
  void (*add)(SamStress, const double sums[], const double first[3], const double step[2], PetscInt n,
              double *const stress[SAM_STRESS_COMPONENTS]);
  PetscErrorCode (*destroy)(SamStress);
} SamStressOps;

struct _n_SamStress {
  SamGrid            grid;
  SamFourierSettings settings;
  SamStressOps       ops; /* set by the type, as the data, the groups and the sums */
  void              *data;
  PetscReal          poisson;    /* Poisson's ratio of the material at the surface; set by the type */
  PetscInt           groups;     /* number of groups of the type: all, or those before SAM_STRESS_NORMAL_Z */
  PetscInt           sums;       /* number of results of reduce */
  void              *smooth;     /* data of reduce and add, if other than `data` */
  SamConditions      conditions; /* conditions of the step of the next tractions, borrowed; NULL: none */
  const SamControl  *control;    /* control of that step */
  double             sign[SAM_STRESS_TRACTIONS]; /* signs of the tractions on the body: -1 for shear on body 1 */
  /* members of the map in use */
  SamFourier fourier;
  PetscReal  depth; /* -1: none */
  SamKernel  kernels[SAM_STRESS_GROUPS][SAM_STRESS_GROUP];
};

/*
  SamStressCreate - creates an object for body 1 or 2, without ops; the `settings` of the transforms may be NULL.
  Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for another number of the body.
  SamStressUseDepth - prepares the kernels of a depth. Errors: PETSC_ERR_ARG_OUTOFRANGE for an invalid depth. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamStressCreate(SamGrid grid, const SamFourierSettings *settings, PetscInt body,
                                            SamStress *stress);
PETSC_INTERN PetscErrorCode SamStressUseDepth(SamStress stress, PetscReal depth);

/*
  SamStressAddColumns - does the work of SamStressApply() at a depth > 0 in a half-space for columns of spectra
  (SamKernelMatrixAdd(), with its scratch): adds the stresses, times `scale`, by the tractions p, q_x, q_y. Transposed:
  it adds to the tractions the sums over the components of the stress times `scale`. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStressAddColumns(SamStress stress, const SamFourierBlock *block, PetscInt phase,
                                                PetscInt b, PetscBool transposed,
                                                const double scale[SAM_STRESS_COMPONENTS],
                                                double (*const traction[SAM_STRESS_TRACTIONS])[2],
                                                double (*const component[SAM_STRESS_COMPONENTS])[2],
                                                double (*scratch)[2]);

/* SamPrincipalOf - computes the principal stresses of one stress, the largest first. Not collective. */
PETSC_INTERN void SamPrincipalOf(const double s[SAM_STRESS_COMPONENTS], double p[3]);
/* SamPrincipalDirection - computes a unit vector in the direction of one principal stress. Not collective. */
PETSC_INTERN void SamPrincipalDirection(const double s[SAM_STRESS_COMPONENTS], double principal, double n[3]);

#endif

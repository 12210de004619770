/* The operators of heat, for the parts of this folder. */
#ifndef PETSAM_HEATIMPL_H
#define PETSAM_HEATIMPL_H

#include "heat.h"

struct _n_SamConductor {
  SamGrid     grid;
  SamFourier  fourier;
  SamHeatBody body;
  PetscReal   depth;   /* m */
  PetscInt    kernels; /* 1: the even part along x alone, 2: both parts */
  SamKernel   kernel[2];
};

/*
  SamHeatSystem - a linear system whose unknowns are a field: arrays of this rank's cells. Both functions are
  collective; `size` is the norm of r.

  SamHeatReduce - takes steps of generalised conjugate residuals until the norm *left of the residual r is at most
  `goal`, or `most` products have been computed; x, r and *left follow (heatsteps.c). Collective.
  SamHeatNorm - computes the 2-norm of a field, the same on any number of ranks. Collective.
*/
typedef struct {
  SamGrid grid;
  void   *context;
  PetscErrorCode (*multiply)(void *context, const double x[], double product[]);
  PetscErrorCode (*precondition)(void *context, const double r[], double size, double z[]); /* NULL: none */
  PetscInt products, most; /* computed so far, and at most */
} SamHeatSystem;
PETSC_INTERN PetscErrorCode SamHeatReduce(SamHeatSystem *system, double goal, double x[], double r[], double *left);
PETSC_INTERN PetscErrorCode SamHeatNorm(SamGrid grid, double x[], double *norm);

/*
  Borders of panels, of an integral over the age of heat (heatkernel.c). Neither is collective.
  SamHeatAddRoots - adds the real, positive roots s of edge + p s^2/2 = m s below `end`, two at most.
  SamHeatSort - puts n borders in their order.
*/
PETSC_INTERN void SamHeatAddRoots(double p, double edge, double m, double end, PetscInt *n, double borders[]);
PETSC_INTERN void SamHeatSort(PetscInt n, double borders[]);

#endif

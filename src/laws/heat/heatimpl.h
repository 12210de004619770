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

#endif

/* Kernels of an elastic half-space: displacements and stresses by tractions on one rectangular cell. */
#ifndef PETSAM_HALFSPACE_H
#define PETSAM_HALFSPACE_H

#include <petsam/elasticity.h>
#include <petsam/private/body.h>
#include <petsam/private/stressimpl.h>

/*
  SamIntegral - a kernel. The cell measures dx by dy and its centre is at (i dx, j dy); x and y are measured from the
  origin and r^2 = x^2 + y^2. Up to a factor of elastic constants, the integral is the displacement at a point (i dx, j
  dy) away from the centre of a cell under unit traction.
*/
typedef enum {
  SAM_INTEGRAL_R = 0, /* 1/r,     even in i, even in j */
  SAM_INTEGRAL_XX,    /* x^2/r^3, even in i, even in j */
  SAM_INTEGRAL_YY,    /* y^2/r^3, even in i, even in j */
  SAM_INTEGRAL_XY,    /* x y/r^3, odd in i,  odd in j  */
  SAM_INTEGRAL_X,     /* x/r^2,   odd in i,  even in j */
  SAM_INTEGRAL_Y      /* y/r^2,   even in i, odd in j  */
} SamIntegral;

/*
  SamIntegralCell - returns the integral of a kernel over the cell at the lag (i, j), in m for every kind; dx, dy: the
  cell's sides, m, positive and finite.
  SamIntegralRow - computes the same, to the last bit, for the n cells (i0 + k, j) in a fraction of the time.
  For lags up to 16384 and sides whose ratio is between 1/50 and 50 the relative error is below 1e-14. Nothing overflows
  or underflows for sides from 1e-9 to 1e3 m. Signs under i -> -i and j -> -j, the zeros of the odd kernels and scaling
  of both sides by a power of two are exact. Not collective, no state. Method and sources: cellintegrals.c.
*/
double SamIntegralCell(SamIntegral kind, double dx, double dy, ptrdiff_t i, ptrdiff_t j);
void   SamIntegralRow(SamIntegral kind, double dx, double dy, ptrdiff_t j, ptrdiff_t i0, ptrdiff_t n, double *values);

/*
  SamHalfSpaceStressCell - computes the stress in a half-space z >= 0 by uniform tractions on a rectangle of its
  surface, at a point given relative to the rectangle's centre (m): each component by unit of each traction, p, which
  presses in the direction of z, and q_x and q_y, which pull in the direction of x and y. On the surface zz is -p, xz is
  -q_x, yz is -q_y, and the stress is infinite on the rectangle's edges. The error is below 1e-12 of the largest kernel
  at that point, up to 16384 sides away. Not collective. Method and sources: stresscell.c.
*/
PETSC_INTERN void SamHalfSpaceStressCell(const PetscReal side[2], PetscReal poisson, const PetscReal point[3],
                                         PetscReal stress[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS]);

/* SamHalfSpaceSource - a cell with unit traction, and the depth at which its stresses are computed. */
typedef struct {
  double side[2]; /* sides of the cell, m; INFINITY along y: plane strain, a strip at the lags (i, 0) */
  double depth;   /* z >= 0, m */
  double poisson;
} SamHalfSpaceSource;

/*
  SamHalfSpaceStressRow - computes the kernels of a group at the lags (i, j), i = 0 ... n - 1, j >= 0, in cells: the
  stress at a cell's centre by unit traction on the cell that lies (i, j) before it. They contain the correction of
  values at centres (stresscell.c). Not collective.
*/
PETSC_INTERN void SamHalfSpaceStressRow(const SamHalfSpaceSource *source, SamStressGroup group, PetscInt j, PetscInt n,
                                        double *const values[SAM_STRESS_GROUP]);

/*
  SamHalfSpaceCreateStress - creates the object for the stresses in body 1 or 2, which is a half-space. Collective.
  Errors: PETSC_ERR_ARG_OUTOFRANGE for another number of the body or an invalid Poisson's ratio.
*/
PETSC_INTERN PetscErrorCode SamHalfSpaceCreateStress(SamGrid grid, const SamFourierSettings *settings, PetscInt body,
                                                     PetscReal poisson, SamStress *stress);
/* SamHalfSpaceDatum - returns the datum of half-spaces in plane strain, m; 0 in three dimensions. Not collective. */
PETSC_INTERN PetscReal *SamHalfSpaceDatum(SamElasticity elasticity);

/*
  SamStreamWeights - finds the weights of a step of duration x, in times of a term, in which the traction p is linear:
  c_new = kept c + before p_old + now p_new. Not collective.
*/
typedef struct {
  double kept, before, now;
} SamStreamStep;
PETSC_INTERN void SamStreamWeights(double x, SamStreamStep *step);
/* SamHalfSpaceStressAtEdge - does the work of SamStressAtEdge() in a half-space. Collective. */
PETSC_INTERN PetscErrorCode SamHalfSpaceStressAtEdge(SamStress stress, Vec field, const SamEdge *edge, double values[]);

#endif

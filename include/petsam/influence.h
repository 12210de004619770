/* Integrals of the kernels of a point force on an elastic half-space over one rectangular cell. */
#ifndef PETSAM_INFLUENCE_H
#define PETSAM_INFLUENCE_H

#include <petsam/base.h>

/*
  SamIntegral - a kernel. The cell measures dx by dy and its centre is at (i dx, j dy); x and y are measured from the
  origin and r^2 = x^2 + y^2. But for the elastic constants, the integral is the displacement at a
  point that lies (i dx, j dy) from the centre of a cell under unit traction.
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
  SamIntegralCell - the integral of one kernel over one cell. Not collective, no state.

  Input:
    kind   - the kernel
    dx, dy - the cell's sides, m, positive and finite
    i, j   - the lag of the cell's centre, in cells

  Returns the integral, in m for every kind. For lags up to 16384 and sides whose ratio
  is between 1/50 and 50 the relative error is below 1e-14. Nothing overflows or underflows for
  sides from 1e-9 m to 1e3 m. Signs under i -> -i and j -> -j and the zeros of the odd kernels are
  exact, and so is scaling of both sides by a power of two.

  Source: kernels from Johnson (1985), Contact Mechanics, sections 3.2 and 3.6; integrals over a
  rectangle from Love (1929). The method stands in src/elasticity/halfspace/influence.c.
*/
double SamIntegralCell(SamIntegral kind, double dx, double dy, ptrdiff_t i, ptrdiff_t j);

/*
  SamIntegralRow - the integrals of one kernel over consecutive cells of a row. Not collective.

  Input:
    kind   - the kernel
    dx, dy - the cells' sides, m, positive and finite
    j      - the lag of the row, in cells
    i0     - the lag of the first cell in the row
    n      - the number of cells; nothing is done if it is not positive

  Output:
    values - n integrals, m; values[k] is that of the cell (i0 + k, j)

  The numbers are those of SamIntegralCell(), to the last bit, at a fraction of the time: the
  accuracy, signs and zeros are the same.
*/
void SamIntegralRow(SamIntegral kind, double dx, double dy, ptrdiff_t j, ptrdiff_t i0, ptrdiff_t n, double *values);

/*
  SamSlopeRow - the integrals of a kernel over consecutive cells of a row whose tractions are linear and zero in the
  mean: each grows by 1 from one side of the cell to the other, along x (axis 0) or y (axis 1). The kernel is
  r/|r| + (xx x^2 + yy y^2 + xy x y)/|r|^3 with the coefficients given. The point lies (i dx, j dy) from the centre of
  cell i, i = 0 ... n - 1; the value at lag (0, 0) is 0. Relative errors are below 1e-8 of the integral of 1/r. Not
  collective; units and sides as for SamIntegralRow().
  SamSlopeRulesCreate - Gauss' points and weights for it. Not collective.
*/
enum { SAM_SLOPE_RULES = 4, SAM_SLOPE_POINTS = 16 };
typedef struct {
  PetscReal x[SAM_SLOPE_RULES][SAM_SLOPE_POINTS], w[SAM_SLOPE_RULES][SAM_SLOPE_POINTS]; /* on (-1/2, 1/2) */
} SamSlopeRules;
typedef struct {
  const SamSlopeRules *rules;
  int                  axis;
  double               dx, dy;        /* sides of the cells, m */
  double               r, xx, yy, xy; /* coefficients, any unit */
} SamSlopeKernel;
PETSC_EXTERN PetscErrorCode SamSlopeRulesCreate(SamSlopeRules *rules);
PETSC_EXTERN void           SamSlopeRow(const SamSlopeKernel *kernel, ptrdiff_t j, ptrdiff_t n, double values[]);

#endif

/* The state of the method for rolling, and its loops over the contact cells of a row. */
#ifndef PETSAM_ROLLINGIMPL_H
#define PETSAM_ROLLINGIMPL_H

#include <petsam/private/tangentialimpl.h>

#define SAM_ROLLING_KEPT    12                             /* maximum number of stored directions */
#define SAM_ROLLING_COLUMNS (SAM_ROLLING_KEPT + 1 + 3 + 1) /* with new one, creepages and residual */
#define SAM_ROLLING_LENGTHS 4                              /* number of lengths of a step that are tried */
#define SAM_ROLLING_GRAM    (SAM_ROLLING_COLUMNS * (SAM_ROLLING_COLUMNS + 1) / 2)

/* Floats are in units: shear in unit_q, slip velocity in unit_s = c unit_q: a cell's influence on itself is 1. */
typedef struct {
  SamStickSlip base;
  double       unit_q, unit_s;
  double      *trial;                      /* admissible shear, Pa */
  float       *normal;                     /* q/|q| where a cell slips, 0 where it sticks */
  float       *weight;                     /* c/(c + lambda); 0 outside of the contact */
  float       *r;                          /* a right-hand side, in the tangent space */
  float       *carry[3];                   /* shear that carries a load along each free creepage */
  float       *slot[SAM_ROLLING_KEPT + 1]; /* the new direction, then those kept, newest first: d, then A d */
  float       *columns;                    /* columns of the least squares, in some cells of a row */
  PetscInt     kept;
  PetscBool    slipping; /* true if directions have N in slip, see rolling.c */
} SamRollingWork;

/* Sums over cells: the projection equation's residual, and the products of the shear with the phi */
typedef struct {
  double squares[SAM_SQUARES], load[3];
} SamRollingSums;

/* Chooses stick and slip, adds to the sums. */
PETSC_INTERN void SamRollingSetsRow(const SamRollingWork *w, SamRow row, SamRollingSums *sums);
/* r = P(-s), or P phi a, z = g r, and h r in place of the new direction's product. */
PETSC_INTERN void SamRollingRightRow(const SamRollingWork *w, SamRow row, const double *a, float z[]);
/* z = M g r becomes, with N h r as above, the direction along the stream, plus `normal` times what the circles need. */
PETSC_INTERN void SamRollingSweepRow(const SamRollingWork *w, SamRow row, float z[], float normal);
/* Takes `project` times the part along the shear off z, and adds the products with the phi. */
PETSC_INTERN void SamRollingLoadsRow(const SamRollingWork *w, SamRow row, float project, float z[], double sums[3]);
/* Adds the upper triangle of the products of all columns of the least squares, the residual being the last one. */
PETSC_INTERN void SamRollingGramRow(const SamRollingWork *w, SamRow row, double sums[SAM_ROLLING_GRAM]);
/* The new direction becomes the combination x of itself and the kept ones. */
PETSC_INTERN void SamRollingCombineRow(const SamRollingWork *w, SamRow row, const double x[]);
/* Adds the squares of the residual of the projection equation after steps of these lengths, with the motion a. */
PETSC_INTERN void SamRollingLengthsRow(const SamRollingWork *w, SamRow row, const double length[SAM_ROLLING_LENGTHS],
                                       const double a[3], double squares[SAM_ROLLING_LENGTHS]);
/* Makes the step of length t, with the motion a. */
PETSC_INTERN void SamRollingAdvanceRow(const SamRollingWork *w, SamRow row, double t, const double a[3]);

#endif

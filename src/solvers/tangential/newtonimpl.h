/* The state of Newton's method, and its loops over the contact cells of a row. */
#ifndef PETSAM_NEWTONIMPL_H
#define PETSAM_NEWTONIMPL_H

#include <petsam/private/tangentialimpl.h>

/* Floats are in units: slip in `unit`, shear in unit/c, with the unit of the iteration that made them. */
typedef struct {
  SamStickSlip base;
  double      *trial;          /* admissible shear, Pa */
  float       *normal;         /* q/|q| where a cell slips, 0 where it sticks, -s/|s| where it turns */
  float       *weight;         /* the preconditioner's w; 0 where a cell turns, and outside of the contact */
  float       *r, *z;          /* residual -P s; direction */
  float       *step, *u;       /* last step, and C times it */
  float       *xi;             /* xi of the columns */
  double       unit;           /* m */
  double       gram[SAM_GRAM]; /* Gram matrix of the tangent space, weighted by h */
  double       slope;          /* slope of the energy along the step: s.step */
  double       along, bend;    /* r.P step; P step.L P step */
  double       size;           /* |step|^2 */
  double       alpha;          /* length of the trial */
  double       turns_from;     /* |s|^2/b^2 from which a cell that does not slip turns, (m/Pa)^2 */
  PetscBool    whole;          /* the next step has length 1, as the shear is not admissible */
  PetscInt     turned;         /* number of sweeps in which cells could turn */
  PetscInt     reopened;       /* number of times that the motion was found not to be determined by the fit */
  double       work;           /* frictional work: sum of -s.q where cells slip, m Pa */
  double       reach;          /* largest eigenvalue of C in units of c: about the square root of the number of cells */
  double       rounding;       /* bound of the rounding of s/c, in the 2-norm, Pa */
} SamNewton;

/* Sums over cells: the slip in the tangent space with the phi and the Gram matrix there, both weighted by h; the work
   of friction. */
typedef struct {
  double slip[3], gram[SAM_GRAM], work;
} SamNewtonSpace;

/* A direction's sums, with e = P step and v = P(u + L step): z, e and h v with the phi; z.r, z.v, e.v, e.r */
typedef struct {
  double z[3], e[3], v[3], zr, zv, ev, er;
} SamNewtonProducts;

/*
  Makes the step of length t: q += t (trial - q), s += by u - the motion a. Chooses stick and slip, adds to the sums,
  and returns the maximum slip in the tangent space.
*/
PETSC_INTERN double SamNewtonAdvanceRow(const SamNewton *w, SamRow row, double t, double by, const double a[3],
                                        SamNewtonSpace *space);
/* Adds by u to s in the cells of row j outside of the runs, where s is C q alone; for products that are stored. */
PETSC_INTERN void SamNewtonOutsideRow(const SamNewton *w, PetscInt j, double by);
/* Subtracts the motion a from s; sets r = -P s, in units, and z = w r; adds to the squares of the error. */
PETSC_INTERN void SamNewtonResidualRow(const SamNewton *w, SamRow row, double inverse_unit, const double a[3],
                                       double squares[SAM_SQUARES]);
/* Turns z from M w r into P(w M w r + rest r), see newton.c; adds its products, a SamNewtonProducts. */
PETSC_INTERN void SamNewtonPreconditionedRow(const SamNewton *w, SamRow row, double sums[]);
/* Turns z into z - h P a + beta P step. */
PETSC_INTERN void SamNewtonDirectionRow(const SamNewton *w, SamRow row, const double a[3], float beta);
/* Computes trial = q + alpha z; slipping cells go beyond their circles. */
PETSC_INTERN void SamNewtonTrialRow(const SamNewton *w, SamRow row, double alpha);
/* Computes step = trial - q, in units; adds its products with s, with r, with L, and its square. */
PETSC_INTERN void SamNewtonChangeRow(const SamNewton *w, SamRow row, double sums[4]);
/* Computes trial = q - h s/c; z's first component becomes h. */
PETSC_INTERN void SamNewtonGradientRow(const SamNewton *w, SamRow row);
/* Adds step.u and u.u. */
PETSC_INTERN void SamNewtonCurvatureRow(const SamNewton *w, SamRow row, double sums[2]);

#endif

/* The state of the active-set method, its step 1, and its loops over the cells of a row. */
#ifndef PETSAM_ACTIVESETIMPL_H
#define PETSAM_ACTIVESETIMPL_H

#include <petsam/private/normalimpl.h>

typedef struct {
  SamSolver       solver;
  SamLevel       *level;
  const SamFrame *frame;
  PetscInt        nx, rows, cells, blocks; /* blocks: of a row */
  Vec             vg;                      /* the field of g */
  const double   *h;
  double         *p, *g;          /* pressure, Pa; gap, m */
  float          *z, *s, *u;      /* direction; last step; S s: z and s in units of unit/self, u in units of `unit` */
  PetscBool       from_gradient;  /* the last step was a gradient step */
  float          *loss;           /* subtracted from the preconditioner; 0 on cells that were not in A at the time */
  float          *active;         /* 1 on cells of A, else 0 */
  float          *xi;             /* xi of the columns */
  char           *busy;           /* blocks with cells of A, or with pressure */
  double         *open;           /* least gap of other blocks after the last step; -infinity: unknown */
  double          unit;           /* unit of length of the iteration, m */
  double          self;           /* influence of a cell on itself, m/Pa */
  double          most;           /* maximum admissible pressure, Pa; infinite: none */
  double          gram[SAM_GRAM]; /* Gram matrix of A */
  double          motion[3];      /* rigid-body displacement in g, fixed part included */
  double          displacement;   /* maximum |S p|, m */
  double          floor;          /* error that rounding leaves where the displacement is nearly zero, m */
  double          error;          /* maximum complementarity error, m */
  double          rounding;       /* bound of the rounding of g, for the maximum error of a cell, m */
  double          slope;          /* slope of the energy along the step: s.g */
  double          shrink;    /* largest part of its distance from a bound by which a cell approaches it in the step */
  double          largest;   /* largest pressure of the trial, Pa */
  double          curvature; /* s.u; 0: no step yet */
  double          alpha;     /* length of the trial */
  PetscBool       layered;   /* a body has layers, for which the preconditioner may be far too strong */
} SamActiveSet;

/* Sums over the cells of a row that take part: their number, xi, xi^2, g and xi g */
typedef struct {
  double count, xi, xi2, g, xi_g;
} SamGapSums;

/* Sums of a direction over A: z and u with 1 and xi; z.r, z.u, s.r */
typedef struct {
  double z, z_turn, u, u_turn, zr, zu, sr;
} SamDirectionSums;

/* Totals over cells: the Gram matrix of the phi, and the products of g with the phi */
#define SAM_GAP_TOTALS (SAM_GRAM + 3)

static inline SamRow SamActiveSetRow(const SamActiveSet *w, PetscInt j)
{
  return SamFrameRow(w->frame, j, 0, w->nx);
}

/* ---- step 1: the gap and the active set ---- */

/* Adds the sums of a row to the totals. */
PETSC_INTERN void SamActiveSetAddRow(SamGapSums row, double eta, SamTotal totals[]);
/*
  Step 1: chooses A by the gap that fits the cells between their bounds best, moves g to fit A, and computes the error.
  `contact`: the totals over the cells between their bounds; NULL: unknown. Collective.

  A cell with pressure leaves A when its gap exceeds `patch` times the displacement by its own pressure. It also leaves
  A when it penetrates by more than `patch` times the displacement by the pressure that it may still bear. SAM_PATCH
  represents the cell's neighbours, which have about the same pressure; 1 the cell alone.
*/
#define SAM_PATCH 6.0
PETSC_INTERN PetscErrorCode SamActiveSetChoose(SamActiveSet *w, double patch, SamTotal contact[]);
/* Makes the first step 1, with the level's product if it has one, else with a new product. Collective. */
PETSC_INTERN PetscErrorCode SamActiveSetStart(SamActiveSet *w);
/* Stores S p in the level if that keeps products. Not collective. */
PETSC_INTERN PetscErrorCode SamActiveSetKeepProduct(SamActiveSet *w);
/* Recomputes g by a product, and makes step 1 with it. Collective. */
PETSC_INTERN PetscErrorCode SamActiveSetRefresh(SamActiveSet *w);
/*
  True if g has to be recomputed: its rounding is too large for the tolerance, and either a product now keeps it small
  enough to the end, or the error has fallen so far that rounding may dominate it.
*/
PETSC_INTERN PetscBool SamActiveSetIsStale(const SamActiveSet *w);
/* Finds out whether the error is below the tolerance, which depends on the present displacement. Collective. */
PETSC_INTERN PetscErrorCode SamActiveSetIsSolved(SamActiveSet *w, PetscBool *solved);

/* ---- loops over some cells of a row ---- */

/* Sets g to g + h - motion; returns the maximum |g| before. */
PETSC_INTERN double SamActiveSetGapRow(SamActiveSet *w, SamRow row);
/*
  Chooses A among some cells, those farther from their bounds than ease times the gap, which is first corrected by
  `motion`; adds to their sums. Returns true if any cell is in A, or has pressure.
*/
PETSC_INTERN PetscBool SamActiveSetChooseRow(SamActiveSet *w, SamRow row, double ease, const double motion[3],
                                             SamGapSums *sums);
/*
  Moves the gap by -motion; returns the maximum complementarity error: |g| if the pressure is between its bounds, -g if
  it is zero, g if it is the largest admissible one.
*/
PETSC_INTERN double SamActiveSetMoveRow(SamActiveSet *w, SamRow row, const double motion[3]);
/* Returns the number of cells that have a loss and are not in A, or have none and are in A. */
PETSC_INTERN double SamActiveSetCountChanged(const SamActiveSet *w, SamRow row);
/* Multiplies the loss by `off` on A, where it never becomes 0, and sets it to 0 elsewhere. */
PETSC_INTERN void SamActiveSetLossRow(SamActiveSet *w, SamRow row, float off);
/* Sets z = r, the residual: -g on A, in units. */
PETSC_INTERN void SamActiveSetResidualRow(SamActiveSet *w, SamRow row);
/* Turns z from |k| r into |k| r - loss r on A and 0 elsewhere; adds its products to the sums. */
PETSC_INTERN void SamActiveSetPreconditionedRow(SamActiveSet *w, SamRow row, SamDirectionSums *sums);
/* Sets z to z - motion + beta s on A, and to 0 outside, where z has no meaning. */
PETSC_INTERN void SamActiveSetDirectionRow(SamActiveSet *w, SamRow row, const double motion[3], float beta);
/* Returns the slope of the step to the trial p; raises `shrink` and `largest`. */
PETSC_INTERN double SamActiveSetTrialRow(SamActiveSet *w, SamRow row);
/* Returns s.u of at most SAM_ROW_BLOCK cells. */
PETSC_INTERN double SamActiveSetCurvatureRow(const SamActiveSet *w, SamRow row);
/* Goes back from the trial, to which p has gone by s, to t times the step; adds to the sums over the cells between
   their bounds. */
PETSC_INTERN void SamActiveSetStepRow(SamActiveSet *w, SamRow row, double t, SamGapSums *sums);
/* Moves the gap in the same way in cells with neither pressure nor a step; returns the least gap. */
PETSC_INTERN double SamActiveSetOpenRow(SamActiveSet *w, SamRow row, double t);
/* Returns the maximum |S p|. */
PETSC_INTERN double SamActiveSetDisplacementRow(const SamActiveSet *w, SamRow row);

#endif

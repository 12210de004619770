/* The inside of SamTangential. */
#ifndef PETSAM_TANGENTIALIMPL_H
#define PETSAM_TANGENTIALIMPL_H

#include <petsam/private/balanceimpl.h>
#include <petsam/private/solverimpl.h>
#include <petsam/tangential.h>

/* One grid's problem, as a method meets it. */
typedef struct {
  SamElasticity elasticity;
  SamGrid       grid;
  SamFrame      frame;
  Vec           bound, offset, q;
  PetscReal     rtol;
  PetscBool     finest;
  double        rigid[3]; /* start and result: combination of the phi, fixed part included */
} SamTangentialLevel;

struct _n_SamTangential {
  SamSolver solver;
  PetscErrorCode (*solve)(SamTangential,
                          SamTangentialLevel *); /* the method: solves one level, sets reason and error */
  SamElasticity       elasticity;
  SamTangentialReason reason;
  PetscReal           limit; /* of the loads, in their multiples, after gross slip */
};

/* Counted products: only those on the finest grid count. */
PETSC_EXTERN PetscErrorCode SamTangentialApply(SamTangential tangential, SamTangentialLevel *level, Vec q, Vec u);
PETSC_EXTERN PetscErrorCode SamTangentialApplySingle(SamTangential tangential, SamTangentialLevel *level, double factor,
                                                     const float q[], float u[]);
PETSC_EXTERN PetscErrorCode SamTangentialPreconditionSingle(SamTangential tangential, SamTangentialLevel *level,
                                                            double factor, const float r[], float z[]);
/*
  Counts an iteration; and, when the error has been measured, calls the monitors: only those on the finest grid count.
*/
PETSC_EXTERN void           SamTangentialIterated(SamTangential tangential, SamTangentialLevel *level);
PETSC_EXTERN PetscErrorCode SamTangentialMeasured(SamTangential tangential, SamTangentialLevel *level, PetscReal error);

/*
  SamStickSlip - the state of an iteration that both methods share: the arrays of a level, the slip increment that
  belongs to q, the energy, and which cells are in contact. Arrays of two components hold x at k and y at cells + k.
*/
typedef struct {
  SamTangential       solver;
  SamTangentialLevel *level;
  const SamFrame     *frame;
  PetscInt            nx, rows, cells;
  const PetscInt     *first, *last;   /* contact cells of row j lie in first[j] ... last[j] - 1 */
  const double       *bound, *offset; /* offset: NULL for zero */
  double             *q, *s;          /* shear; slip increment, with `motion` in it */
  Vec                 vs;
  double              motion[3]; /* rigid displacement in s, fixed part included */
  double              self;      /* influence of a cell on itself, m/Pa */
  double              error;     /* residual of the projection equation, relative to scale */
  double              scale;     /* norm of the shear, Pa */
} SamStickSlip;

/*
  What D, the projection on the disc of radius b, multiplies a vector of square n2 by. No branch: loops with it are
  vectorised.
*/
static inline double SamDiscScale(double n2, double b)
{
  const double ratio = b / sqrt(n2), in = b > 0 ? 1 : 0;

  return in * (ratio < 1 ? ratio : 1);
}

/*
  Sums of squares of which the error is made: residual q - D(q - s/c), q, D(q - s/c), and the bound as the least
  measure of the shear.
*/
#define SAM_SQUARES 4

/*
  Adds a cell to those of a vectorised row, which are variables of these names: its q, y = q - s/c of square n2, and
  the scale of D(y).
*/
#define SAM_ADD_SQUARES(qx, qy, yx, yy, scale, n2, b) \
  residual += ((qx) - (scale) * (yx)) * ((qx) - (scale) * (yx)) + ((qy) - (scale) * (yy)) * ((qy) - (scale) * (yy)), \
    shear += (qx) * (qx) + (qy) * (qy), projected += (scale) * (scale) * (n2), \
    least += SAM_SHEAR_FLOOR * SAM_SHEAR_FLOOR * (b) * (b)

static inline void SamSumSquares(double squares[SAM_SQUARES], double residual, double shear, double projected,
                                 double least)
{
  squares[0] += residual;
  squares[1] += shear;
  squares[2] += projected;
  squares[3] += least;
}

PETSC_EXTERN PetscErrorCode SamStickSlipCreate(SamTangential solver, SamTangentialLevel *level, SamStickSlip *w);
PETSC_EXTERN PetscErrorCode SamStickSlipDestroy(SamStickSlip *w);
/* s = C q + offset - motion. */
PETSC_EXTERN PetscErrorCode SamStickSlipComputeSlip(SamStickSlip *w);
/* The same for the start, with a motion fitted to it and the error measured. */
PETSC_EXTERN PetscErrorCode SamStickSlipStart(SamStickSlip *w);
/*
  The residual of the projection equation with the motion that makes it smallest: s and motion are changed by a fit on
  the tangent space of the constraints (both directions where q - s/c lies within the disc, along the circle elsewhere).
*/
PETSC_EXTERN PetscErrorCode SamStickSlipMeasure(SamStickSlip *w);

/* Error and scale from this rank's squares. Collective. */
PETSC_EXTERN PetscErrorCode SamStickSlipSetError(SamStickSlip *w, const SamTotal squares[SAM_SQUARES]);

PETSC_EXTERN PetscErrorCode SamTangentialCreate_Newton(SamTangential tangential);
PETSC_EXTERN PetscErrorCode SamTangentialCreate_Gradient(SamTangential tangential);

#endif

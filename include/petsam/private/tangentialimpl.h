/*
  The implementation of SamTangential, for methods of the tangential problem; solverimpl.h describes how to write one.

  A method starts from a shear in level->traction that is admissible: within the discs, and in equilibrium; and from the
  rigid-body displacement in level->rigid. The caller has checked that some admissible shear carries the loads. If the
  product of the start is available (SamLevelHasProduct()), neither holds: the start may lie outside of the discs, and
  the method sets NO_EQUILIBRIUM if it finds no admissible shear.
*/
#ifndef PETSAM_TANGENTIALIMPL_H
#define PETSAM_TANGENTIALIMPL_H

#include <petsam/private/solverimpl.h>
#include <petsam/tangential.h>

/* The given fields of a level. */
enum {
  SAM_TANGENTIAL_BOUND, /* bound of the shear in each cell, Pa */
  SAM_TANGENTIAL_OFFSET /* w - S, m, two components; NULL: zero */
};

/*
  SamStickSlip - the state of an iteration, as a base for methods: the arrays of a level, the slip increment that
  belongs to q, and the error. Arrays of two components hold x at k and y at cells + k.
*/
typedef struct {
  SamSolver       solver;
  SamLevel       *level;
  const SamFrame *frame;
  PetscInt        nx, rows, cells;
  SamRuns         runs;           /* the contact, and a start that is not admissible */
  const double   *bound, *offset; /* offset: NULL for zero */
  double         *q, *s;          /* shear, Pa; slip increment, m, with `motion` in it */
  Vec             vs;             /* the field of s */
  double          motion[3];      /* rigid-body displacement in s, fixed part included */
  double          self;           /* influence of a cell on itself, m/Pa */
  double          error;          /* residual of the projection equation, relative to scale */
  double          scale;          /* norm of the shear, Pa */
} SamStickSlip;

/*
  SamDiscScale - returns the factor that projects a vector of squared length n2 onto the disc of radius b. It has no
  branch, so that loops with it are vectorised.
*/
static inline double SamDiscScale(double n2, double b)
{
  const double ratio = b / sqrt(n2), in = b > 0 ? 1 : 0;

  return in * (ratio < 1 ? ratio : 1);
}

/*
  SAM_SQUARES - number of the sums of squares that give the error: those of the residual q - D(q - s/c), of q, of D(q -
  s/c), and of the bound times SAM_SHEAR_FLOOR, the smallest measure of the shear.
*/
#define SAM_SQUARES 4

/*
  Adds a cell to these sums in a vectorised loop, which must be local variables of the names residual, shear, projected,
  least: its q, y = q - s/c, the factor of its projection, y's squared length, and the bound.
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

/* SamStickSlipCreate - creates a state, with runs that are `gap` cells apart or more (SamRunsCreate()). Collective. */
PETSC_EXTERN PetscErrorCode SamStickSlipCreate(SamSolver solver, SamLevel *level, PetscInt gap, SamStickSlip *state);
PETSC_EXTERN PetscErrorCode SamStickSlipDestroy(SamStickSlip *state);
/* SamStickSlipNext - finds the next run of row j, the *n-th at first, and raises *n; false: there is no more. */
static inline PetscBool SamStickSlipNext(const SamStickSlip *state, PetscInt j, PetscInt *n, SamRow *row)
{
  const PetscInt run = state->runs.start[j] + (*n)++;

  if (run >= state->runs.start[j + 1]) return PETSC_FALSE;
  *row = SamRunRow(state->frame, &state->runs, j, run);
  return PETSC_TRUE;
}
/* SamStickSlipRow - returns the only run of row j, or no cells, of a state whose rows have one run. Not collective. */
static inline SamRow SamStickSlipRow(const SamStickSlip *state, PetscInt j)
{
  const PetscInt run = state->runs.start[j];

  return run < state->runs.start[j + 1] ? SamRunRow(state->frame, &state->runs, j, run)
                                        : SamFrameRow(state->frame, j, state->nx, state->nx);
}
/* SamStickSlipClearMargins - sets z (two components) to 0 outside of the runs. Not collective. */
PETSC_INTERN void SamStickSlipClearMargins(const SamStickSlip *state, float z[]);
/* SamStickSlipComputeSlip - computes s = C q + offset - motion in double precision. Collective. */
PETSC_EXTERN PetscErrorCode SamStickSlipComputeSlip(SamStickSlip *state);
/*
  SamStickSlipStart - does the same for the start, by its product if that is available, then fits the motion to it and
  measures the error. Collective.
*/
PETSC_EXTERN PetscErrorCode SamStickSlipStart(SamStickSlip *state);
/* SamStickSlipKeepProduct - stores the product in s in the level, with its rounding. Not collective. */
PETSC_INTERN PetscErrorCode SamStickSlipKeepProduct(SamStickSlip *state, double rounding);
/*
  SamStickSlipMeasure - computes the residual of the projection equation, with the motion that makes it smallest: s and
  motion are changed by a fit on the tangent space of the constraints (both directions where q - s/c lies within the
  disc, along the circle elsewhere). Collective.
*/
PETSC_EXTERN PetscErrorCode SamStickSlipMeasure(SamStickSlip *state);
/* SamStickSlipSetError - computes error and scale from the squares of all ranks. Collective. */
PETSC_INTERN PetscErrorCode SamStickSlipSetError(SamStickSlip *state, const SamTotal squares[SAM_SQUARES]);

/*
  SamTangentialSolveKeeping - does the same as SamTangentialSolve(), and uses the product of the guess if that is valid;
  it is replaced by the product of the result. product NULL: none is kept. Collective.
*/
PETSC_INTERN PetscErrorCode SamTangentialSolveKeeping(SamTangential tangential, Vec bound, Vec offset,
                                                      SamBalance *balance, PetscBool guess, Vec q, SamProduct *product);

PETSC_INTERN PetscErrorCode SamTangentialCreate_Newton(SamSolver solver);
PETSC_INTERN PetscErrorCode SamTangentialCreate_Rolling(SamSolver solver);

#endif

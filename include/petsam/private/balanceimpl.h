/*
  The frame in which the solvers keep equilibrium.

  Rigid displacements are combinations a[0..2] of three dimensionless fields phi about the grid's centre,
    normal      1, -eta, xi
    tangential  (1, 0), (0, 1), (-eta, xi)          xi = (x - xc)/length, eta = (y - yc)/length,
  well conditioned wherever the grid lies. Of these, the force-controlled components span a subspace; its orthonormal
  basis is the `count` rows of `basis`. The given displacements are the combination `fixed`.
*/
#ifndef PETSAM_BALANCEIMPL_H
#define PETSAM_BALANCEIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/balance.h>

typedef struct {
  SamGrid        grid;
  SamBalanceKind kind;
  PetscInt       count;        /* force-controlled components */
  PetscInt       component[3]; /* which they are */
  double         basis[3][3];  /* (count, 3) */
  double         lower[3][3];  /* rows of the components in the phi = lower * basis */
  double         target[3];    /* what sum phi traction must be along the basis: loads/(dx dy) in the basis */
  double         fixed[3];     /* given rigid displacement */
  double         xi0;          /* of the first column */
  double         dxi, deta;
} SamFrame;

PETSC_EXTERN PetscErrorCode SamFrameSet(SamFrame *frame, SamGrid grid, const SamBalance *balance);
/* The same with all rigid displacements given as they stand in the balance. */
PETSC_EXTERN PetscErrorCode SamFrameSetGiven(SamFrame *frame, SamGrid grid, const SamBalance *balance);
/* Rigid displacements of the force-controlled components from a free combination a of the phi. */
PETSC_EXTERN void SamFrameGetRigid(const SamFrame *frame, const double a[3], SamBalance *balance);
/* Loads of all three components from sum phi traction (not times the cell's area). */
PETSC_EXTERN void SamFrameGetLoads(const SamFrame *frame, const double sums[3], PetscReal loads[3]);

/* eta of this rank's row j, the same to the last digit wherever the row is. */
static inline double SamFrameEta(const SamFrame *f, PetscInt j)
{
  return ((double)(f->grid->row_start + j) + 0.5 - 0.5 * (double)f->grid->ny) * f->deta;
}

/* Normal rigid displacement and the two parts of the tangential one at (xi, eta). */
static inline double SamFrameNormal(const double a[3], double xi, double eta)
{
  return a[0] - a[1] * eta + a[2] * xi;
}
static inline double SamFrameX(const double a[3], double eta)
{
  return a[0] - a[2] * eta;
}
static inline double SamFrameY(const double a[3], double xi)
{
  return a[1] + a[2] * xi;
}

/* The cells first ... last - 1 of a row of n between which there is a bound: loops run over these only. */
static inline void SamBoundRange(PetscInt n, const double bound[], PetscInt *first, PetscInt *last)
{
  PetscInt i = 0, j = n;

  while (i < n && bound[i] <= 0) i++;
  while (j > i && bound[j - 1] <= 0) j--;
  *first = i;
  *last  = j;
}

/* Cells of a row looked at together: where all of them are within their discs, roots and divisions are spared. */
#define SAM_CHUNK 256

/*
  Cells of a row that are passed over together when none of them counts: few of a rough surface are in contact. Which
  stretches count is kept as one char each, those of a row together.
*/
#define SAM_STRETCH 64

static inline PetscInt SamStretches(SamGrid grid)
{
  return (grid->nx + SAM_STRETCH - 1) / SAM_STRETCH;
}

/*
  The next cells first ... last - 1 of a row of nx, from `last` on, whose stretches all count; `busy` NULL: the whole
  row.
*/
static inline PetscBool SamNextBusy(const char busy[], PetscInt nx, PetscInt *first, PetscInt *last)
{
  PetscInt i = *last;

  if (busy)
    while (i < nx && !busy[i / SAM_STRETCH]) i += SAM_STRETCH;
  if (i >= nx) return PETSC_FALSE;
  *first = i;
  if (!busy) i = nx;
  while (i < nx && busy[i / SAM_STRETCH]) i += SAM_STRETCH;
  *last = PetscMin(i, nx);
  return PETSC_TRUE;
}

/* Gram matrices sum phi phi' are kept as their six upper entries 00, 01, 02, 11, 12, 22. */
#define SAM_GRAM 6

/* Adds a cell to the Gram matrix of the normal phi. */
static inline void SamGramAddNormal(double gram[SAM_GRAM], double xi, double eta)
{
  gram[0] += 1;
  gram[1] -= eta;
  gram[2] += xi;
  gram[3] += eta * eta;
  gram[4] -= eta * xi;
  gram[5] += xi * xi;
}

/* Adds the cells of a row, from their number and their sums of xi and xi^2. */
static inline void SamGramNormalRow(double gram[SAM_GRAM], double count, double xi, double xi2, double eta)
{
  gram[0] += count;
  gram[1] -= eta * count;
  gram[2] += xi;
  gram[3] += eta * eta * count;
  gram[4] -= eta * xi;
  gram[5] += xi2;
}

/* Adds a cell to the Gram matrix of the tangential phi, weighted by the symmetric 2 x 2 matrix hxx, hxy, hyy. */
static inline void SamGramAddTangential(double gram[SAM_GRAM], double hxx, double hxy, double hyy, double xi,
                                        double eta)
{
  gram[0] += hxx;
  gram[1] += hxy;
  gram[2] += -eta * hxx + xi * hxy;
  gram[3] += hyy;
  gram[4] += -eta * hxy + xi * hyy;
  gram[5] += eta * eta * hxx - 2 * xi * eta * hxy + xi * xi * hyy;
}

/*
  Adds a cell to the sums of a vectorised row, which are variables of these names: a projected vector (px, py) with the
  phi, and the parts of the weighted Gram matrix for SamGramTangentialRow().
*/
#define SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi) \
  x += (px), y += (py), turn += (xi) * (py), hxx += (gxx), hxy += (gxy), hyy += (gyy), xi_hxy += (xi) * (gxy), \
    xi_hyy += (xi) * (gyy), xi2_hyy += (xi) * (xi) * (gyy)

/* The same for the cells of a row, from their sums of hxx, hxy, hyy, xi hxy, xi hyy and xi^2 hyy. */
static inline void SamGramTangentialRow(double gram[SAM_GRAM], double hxx, double hxy, double hyy, double xi_hxy,
                                        double xi_hyy, double xi2_hyy, double eta)
{
  gram[0] += hxx;
  gram[1] += hxy;
  gram[2] += -eta * hxx + xi_hxy;
  gram[3] += hyy;
  gram[4] += -eta * hxy + xi_hyy;
  gram[5] += eta * eta * hxx - 2 * eta * xi_hxy + xi2_hyy;
}

/*
  The combination a of the free phi with gram a = sums within the free subspace, in the sense of least squares when
  the Gram matrix is singular there.
*/
PETSC_EXTERN void SamFrameSolve(const SamFrame *frame, const double gram[SAM_GRAM], const double sums[3], double a[3]);

/*
  SamFrameProjectNormal - p := max(0, p + phi a) on the cells where mask is 1 (mask NULL: all), 0 elsewhere, where it is
  0, with the a for which the force-controlled loads are exact: the nearest admissible pressure. `found` is false when
  there is none (p is then left as it was). Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormal(const SamFrame *frame, const float mask[], double p[],
                                                  PetscBool *found);

/*
  SamFrameProjectNormalStep - the same for p + by step, which nearly carries the loads: p becomes an admissible
  pressure, the nearest where one step of Newton's method finds it, else one as near, and `made` is `scale` times its
  change, in single precision like the step. `busy`: the stretches that have cells in the mask, or pressure. Not found:
  p is as it was, to the rounding of `made`.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormalStep(const SamFrame *frame, const float mask[], const char busy[],
                                                      double p[], double by, const float step[], double scale,
                                                      float made[], PetscBool *found);

/*
  SamFrameProjectNormalOnContact - the same on the cells that have pressure, if those can carry the loads, else on all.
  (The nearest pressure on all cells would spread a little over the whole grid.)
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *frame, double p[], PetscBool *found);

/*
  SamFrameProjectTangential - q := D(q + phi a), D the projection of each cell's shear on the disc of radius bound, with
  the a for which the force-controlled loads are exact. `found` is false when there is none (q is then of no use). The
  result is admissible to rounding in any case; with `nearest` it is the nearest such shear too, without it, which is
  faster, that may hold to 1e-6 of the change only. Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectTangential(const SamFrame *frame, const double bound[], PetscBool nearest,
                                                      double q[], PetscBool *found);

#endif

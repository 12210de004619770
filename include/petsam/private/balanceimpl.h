/*
  The frame in which the solvers keep equilibrium, rows of cells in it, and the projections onto admissible tractions in
  equilibrium.

  Rigid displacements are combinations a[0..2] of three dimensionless fields phi about the grid's centre,
    normal      1, -eta, xi
    tangential  (1, 0), (0, 1), (-eta, xi)          xi = (x - xc)/length, eta = (y - yc)/length,
  which are well conditioned wherever the grid lies. The force-controlled components span a subspace of them; its
  orthonormal basis is the `count` rows of `basis`. The given displacements are the combination `fixed`. Where a
  rotation is taken ahead of the cells, the displacements that belong to the basis are the rows of `motion`; else they
  are those of the basis.
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
  double         motion[3][3]; /* (count, 3) */
  double         ahead;        /* of rotations, relative to the length */
  double         lower[3][3];  /* the components as combinations of the phi = lower * basis */
  double         target[3];    /* what sum phi traction must be along the basis: loads/(dx dy) in the basis */
  double         fixed[3];     /* the given rigid-body displacement as a combination of the phi */
  double         most;         /* normal: the maximum admissible pressure, Pa; infinite: there is none */
  double         xi0;          /* xi of the first column */
  double         dxi, deta;    /* steps of xi and eta from cell to cell */
} SamFrame;

/* SamFrameGetComponent - the rigid-body displacement of component k (1 m or rad) as a combination of the phi. */
PETSC_INTERN void SamFrameGetComponent(SamGrid grid, SamBalanceKind kind, PetscInt k, double row[3]);
/*
  SamFrameSet - the frame of a grid (borrowed) for what a balance controls. Its pressures have no upper bound until the
  caller sets `most`. Not collective.
*/
PETSC_INTERN PetscErrorCode SamFrameSet(SamFrame *frame, SamGrid grid, const SamBalance *balance);
/* SamFrameSetGiven - the same with all rigid-body displacements given as they stand in the balance. */
PETSC_INTERN PetscErrorCode SamFrameSetGiven(SamFrame *frame, SamGrid grid, const SamBalance *balance);
/* SamFrameMove - adds to a combination of the phi, times `times`, what rotations move cells that are ahead by. */
PETSC_INTERN void SamFrameMove(const SamFrame *frame, double times, double a[3]);
/* SamFrameGetRigid - rigid-body displacements of the force-controlled components, from a combination a of the phi. */
PETSC_INTERN void SamFrameGetRigid(const SamFrame *frame, const double a[3], SamBalance *balance);

/* eta of this rank's row j: to the last bit the same on whatever rank the row is. */
static inline double SamFrameEta(const SamFrame *f, PetscInt j)
{
  return ((double)(f->grid->row_start + j) + 0.5 - 0.5 * (double)f->grid->ny) * f->deta;
}

/*
  SamRow - neighbouring cells of one row, for loops over them. `first` is the index of the first of them in this rank's
  arrays, `column` its column; cell i = 0 ... count - 1 has its centre at (xi0 + i dxi, eta). The numbers have 32 bits,
  as GCC does not vectorise the conversion of a longer index to a double.
*/
typedef struct {
  ptrdiff_t first;
  int       column, count;
  double    xi0, dxi, eta;
} SamRow;

/* SamFrameRow - the cells in the columns from ... to - 1 of this rank's row j. */
static inline SamRow SamFrameRow(const SamFrame *f, PetscInt j, PetscInt from, PetscInt to)
{
  return (SamRow){.first  = (ptrdiff_t)j * f->grid->nx + from,
                  .column = (int)from,
                  .count  = (int)(to - from),
                  .xi0    = f->xi0 + (double)from * f->dxi,
                  .dxi    = f->dxi,
                  .eta    = SamFrameEta(f, j)};
}

/* The product of two combinations of the phi, entry by entry. */
static inline double SamFrameDot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The normal rigid-body displacement a at (xi, eta), and the two components of the tangential one. */
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

/* The columns first ... last - 1 of a row of n outside of which the bound is zero: loops run over these only. */
static inline void SamBoundRange(PetscInt n, const double bound[], PetscInt *first, PetscInt *last)
{
  PetscInt i = 0, j = n;

  while (i < n && bound[i] <= 0) i++;
  while (j > i && bound[j - 1] <= 0) j--;
  *first = i;
  *last  = j;
}
/* SamBoundRangeOfBoth - the columns between which either of two bounds has values; n to n where neither has. */
static inline void SamBoundRangeOfBoth(PetscInt n, const double one[], const double other[], PetscInt *first,
                                       PetscInt *last)
{
  PetscInt a[2], b[2];

  SamBoundRange(n, one, &a[0], &b[0]);
  SamBoundRange(n, other, &a[1], &b[1]);
  *first = PetscMin(a[0], a[1]);
  *last  = PetscMax(*first, PetscMax(a[0] < b[0] ? b[0] : 0, a[1] < b[1] ? b[1] : 0));
}

/* Cells of a row that are taken together: where all of them lie within their discs, no root or division is needed. */
#define SAM_CHUNK 256

/*
  Blocks: cells of a row that loops pass over together when none of them takes part, as on a rough surface few cells
  are in contact. An array `busy` of one char per block, row after row, marks the blocks that take part.
*/
#define SAM_ROW_BLOCK 64

static inline PetscInt SamRowBlocks(SamGrid grid)
{
  return (grid->nx + SAM_ROW_BLOCK - 1) / SAM_ROW_BLOCK;
}

/*
  SamNextBusy - the next cells first ... last - 1 of a row of nx, from column `last` on, whose blocks are all busy;
  `busy` is that of the row, NULL: all. PETSC_FALSE when there are no more.
*/
static inline PetscBool SamNextBusy(const char busy[], PetscInt nx, PetscInt *first, PetscInt *last)
{
  PetscInt i = *last;

  if (busy)
    while (i < nx && !busy[i / SAM_ROW_BLOCK]) i += SAM_ROW_BLOCK;
  if (i >= nx) return PETSC_FALSE;
  *first = i;
  if (!busy) i = nx;
  while (i < nx && busy[i / SAM_ROW_BLOCK]) i += SAM_ROW_BLOCK;
  *last = PetscMin(i, nx);
  return PETSC_TRUE;
}

/* Gram matrices sum phi phi' are stored as their six upper entries 00, 01, 02, 11, 12, 22. */
#define SAM_GRAM 6

/* Adds the cells of a row to the Gram matrix of the normal phi, from their number and their sums of xi and xi^2. */
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
  Adds a cell to the sums in a vectorised loop, which must be local variables of these names: a projected vector
  (px, py) with the phi, and the parts of the weighted Gram matrix for SamGramTangentialRow().
*/
#define SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi) \
  x += (px), y += (py), turn += (xi) * (py), hxx += (gxx), hxy += (gxy), hyy += (gyy), xi_hxy += (xi) * (gxy), \
    xi_hyy += (xi) * (gyy), xi2_hyy += (xi) * (xi) * (gyy)

/* The same for the cells of a row, from their sums h of hxx, hxy, hyy, xi hxy, xi hyy and xi^2 hyy. */
static inline void SamGramTangentialRow(double gram[SAM_GRAM], const double h[6], double eta)
{
  gram[0] += h[0];
  gram[1] += h[1];
  gram[2] += -eta * h[0] + h[3];
  gram[3] += h[2];
  gram[4] += -eta * h[1] + h[4];
  gram[5] += eta * eta * h[0] - 2 * eta * h[3] + h[5];
}

/*
  SamFrameSolve - the combination a of the free phi with gram a = sums within the free subspace; where the Gram matrix
  is singular there, the shortest one that leaves the least residual.
*/
PETSC_EXTERN void SamFrameSolve(const SamFrame *frame, const double gram[SAM_GRAM], const double sums[3], double a[3]);

/*
  SamFrameSolveSeen - the same. Returns the part of the sums that the Gram matrix does not see, from 0 to 1 (all of
  them); `unseen` is a combination of the phi along it, on which the sums do positive work.
*/
PETSC_INTERN double SamFrameSolveSeen(const SamFrame *frame, const double gram[SAM_GRAM], const double sums[3],
                                      double a[3], double unseen[3]);

/*
  SamFrameProjectNormal - p := p + phi a, cut off at 0 and at the frame's `most`, on the cells where mask is 1 (mask
  NULL: all), with the a for which the force-controlled loads are exact: the nearest admissible pressure. Where the mask
  is 0 p becomes the nearer one of its bounds: 0 without an upper one. `found` is false if there is none; p is then
  unchanged. Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormal(const SamFrame *frame, const float mask[], double p[],
                                                  PetscBool *found);

/* SamPressureStep - a step of a pressure, for the next function. Arrays of this rank's cells. */
typedef struct {
  const float *mask; /* 1 on cells that may have pressure, 0 on others */
  const char  *busy; /* blocks with cells in the mask, or with pressure */
  const float *step; /* the pressure goes by `by` times this */
  double       by;
  PetscBool    nearest; /* find the nearest admissible pressure, even if that takes longer */
  float       *made;    /* result: `scale` times the change of the pressure */
  double       scale;
  double       motion[3]; /* result: the combination of the phi that was added before cells were cut off */
} SamPressureStep;

/*
  SamFrameProjectNormalStep - the same for p + by step, when that nearly carries the loads. p becomes an admissible
  pressure: the nearest one with `nearest`, or where a single step of Newton's method finds it, else one about as near.
  Not found: p is unchanged, to the rounding of `made`. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrameProjectNormalStep(const SamFrame *frame, SamPressureStep *step, double p[],
                                                      PetscBool *found);

/*
  SamFrameProjectNormalOnContact - the same on the cells that have pressure, if those can carry the loads, else on all.
  (The nearest pressure on all cells would be positive, though small, over much of the grid.) Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *frame, double p[], PetscBool *found);
/*
  SamFrameProjectNormalBetween - the same on the cells whose pressure lies between its bounds, if those can carry what
  is missing; so cells at a bound stay there exactly. Else as above. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrameProjectNormalBetween(const SamFrame *frame, double p[], PetscBool *found);

/*
  SamFrameClear - whether some free rigid-body displacement a leaves no cell with field + phi a > 0, to rounding of the
  field: bodies that are free to tilt then lose contact. For frames without load. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrameClear(const SamFrame *frame, const double field[], double a[3], PetscBool *clear);

/*
  SamFrameProjectTangential - q := D(q + weight phi a), D the projection of each cell's shear onto the disc of radius
  bound, with the a for which the force-controlled loads are exact: the nearest admissible shear, a cell's distance
  squared counting 1/weight (weight NULL: 1). `motion`, when not NULL, becomes a. `found` is false if there is none; q
  is then undefined.
  The result is admissible to rounding in any case. With `nearest` it is the nearest admissible shear; without, which is
  faster, it may differ from that by 1e-6 of the change. Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectTangential(const SamFrame *frame, const double bound[], const float weight[],
                                                      PetscBool nearest, double q[], double motion[3],
                                                      PetscBool *found);

#endif

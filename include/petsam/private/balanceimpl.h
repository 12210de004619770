/*
  The frame in which the solvers maintain equilibrium, rows of cells in it, and the projections onto admissible
  tractions in equilibrium.

  Rigid displacements are combinations a[0..2] of three dimensionless fields phi about the grid's centre,
    normal      1, -eta, xi
    tangential  (1, 0), (0, 1), (-eta, xi)          xi = (x - xc)/length, eta = (y - yc)/length,
  which are well conditioned wherever the grid lies. The force-controlled components span a subspace of them; its
  orthonormal basis is the `count` rows of `basis`. The given displacements are the combination `fixed`. The rows of
  `motion` are the displacements that belong to the basis: if a rotation is evaluated ahead of the cells (`ahead`), they
  differ from the rows of `basis`.
*/
#ifndef PETSAM_BALANCEIMPL_H
#define PETSAM_BALANCEIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/balance.h>

typedef struct {
  SamGrid        grid;
  SamBalanceKind kind;
  PetscInt       count;        /* number of force-controlled components */
  PetscInt       component[3]; /* indices of these components */
  double         basis[3][3];  /* (count, 3) */
  double         motion[3][3]; /* (count, 3) */
  double         ahead;       /* distance ahead of the cells at which rotations are evaluated, relative to the length */
  double         lower[3][3]; /* the components as combinations of the phi = lower * basis */
  double         target[3];   /* required sum phi traction along the basis: loads/(dx dy) in the basis */
  double         fixed[3];    /* the given rigid-body displacement as a combination of the phi */
  double         most;        /* normal: maximum admissible pressure, Pa; infinite: no limit */
  double         xi0;         /* xi of the first column */
  double         dxi, deta;   /* steps of xi and eta from cell to cell */
} SamFrame;

/*
  SamFrameGetComponent - computes the rigid-body displacement of component k (1 m or rad) as a combination of the phi.
*/
PETSC_INTERN void SamFrameGetComponent(SamGrid grid, SamBalanceKind kind, PetscInt k, double row[3]);
/*
  SamFrameSet - sets the frame of a grid (borrowed) for the controlled components of a balance. Its pressures have no
  upper bound until the caller sets `most`. Not collective.
*/
PETSC_INTERN PetscErrorCode SamFrameSet(SamFrame *frame, SamGrid grid, const SamBalance *balance);
/* SamFrameSetGiven - sets the frame for a balance all of whose rigid-body displacements count as given. */
PETSC_INTERN PetscErrorCode SamFrameSetGiven(SamFrame *frame, SamGrid grid, const SamBalance *balance);
/*
  SamFrameMove - adds to a combination a of the phi `times` the extra displacement by rotations that are evaluated ahead
  of the cells.
*/
PETSC_INTERN void SamFrameMove(const SamFrame *frame, double times, double a[3]);
/*
  SamFrameGetRigid - computes the rigid-body displacements of the force-controlled components from a combination a of
  the phi.
*/
PETSC_INTERN void SamFrameGetRigid(const SamFrame *frame, const double a[3], SamBalance *balance);

/* SamFrameEta - returns eta of this rank's row j: the same to the last bit on any number of ranks. */
static inline double SamFrameEta(const SamFrame *f, PetscInt j)
{
  return ((double)(f->grid->row_start + j) + 0.5 - 0.5 * (double)f->grid->ny) * f->deta;
}

/*
  SamRow - neighbouring cells of one row, for loops over them. `first` is the index of the first cell in this rank's
  arrays, `column` its column; cell i = 0 ... count - 1 has its centre at (xi0 + i dxi, eta). The numbers have 32 bits,
  as GCC does not vectorise the conversion of a longer index to a double.
*/
typedef struct {
  ptrdiff_t first;
  int       column, count;
  double    xi0, dxi, eta;
} SamRow;

/* SamFrameRow - returns the cells in the columns from ... to - 1 of this rank's row j. */
static inline SamRow SamFrameRow(const SamFrame *f, PetscInt j, PetscInt from, PetscInt to)
{
  return (SamRow){.first  = (ptrdiff_t)j * f->grid->nx + from,
                  .column = (int)from,
                  .count  = (int)(to - from),
                  .xi0    = f->xi0 + (double)from * f->dxi,
                  .dxi    = f->dxi,
                  .eta    = SamFrameEta(f, j)};
}

/* SamFrameDot - returns the scalar product of two combinations of the phi. */
static inline double SamFrameDot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/*
  SamFrameNormal, SamFrameX, SamFrameY - return the normal rigid-body displacement a at (xi, eta), and the two
  components of the tangential one.
*/
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

/*
  SamBoundRange - finds the columns first ... last - 1 of a row of n cells outside of which the bound is zero; loops run
  over these only.
*/
static inline void SamBoundRange(PetscInt n, const double bound[], PetscInt *first, PetscInt *last)
{
  PetscInt i = 0, j = n;

  while (i < n && bound[i] <= 0) i++;
  while (j > i && bound[j - 1] <= 0) j--;
  *first = i;
  *last  = j;
}
/*
  SamBoundRangeOfBoth - finds the range of columns outside of which both bounds are zero; n to n if both are zero
  everywhere.
*/
static inline void SamBoundRangeOfBoth(PetscInt n, const double one[], const double other[], PetscInt *first,
                                       PetscInt *last)
{
  PetscInt a[2], b[2];

  SamBoundRange(n, one, &a[0], &b[0]);
  SamBoundRange(n, other, &a[1], &b[1]);
  *first = PetscMin(a[0], a[1]);
  *last  = PetscMax(*first, PetscMax(a[0] < b[0] ? b[0] : 0, a[1] < b[1] ? b[1] : 0));
}

/*
  SamRuns - the parts of this rank's rows that have contact: the runs n = start[j] ... start[j + 1] - 1 of row j are the
  columns span[n][0] ... span[n][1] - 1. Loops over runs pass over the cells between the spots of a rough contact.

  SamRunsCreate - finds the runs of the cells with a bound above 0, or with `shear` (two components; NULL: none). Runs
  with fewer than `gap` cells between them are one: SAM_RUN_GAP, below which it costs more to begin a loop than to pass
  over the cells, or the grid's nx: each row has one run, from its first contact to its last. A row in which runs gain
  little has one, too. Not collective.
*/
#define SAM_RUN_GAP 16
typedef struct {
  PetscInt *start;
  PetscInt (*span)[2];
} SamRuns;
PETSC_EXTERN PetscErrorCode SamRunsCreate(SamGrid grid, const double bound[], const double shear[], PetscInt gap,
                                          SamRuns *runs);
PETSC_EXTERN PetscErrorCode SamRunsDestroy(SamRuns *runs);

/* SamRunRow - returns the cells of run n, of this rank's row j. */
static inline SamRow SamRunRow(const SamFrame *f, const SamRuns *runs, PetscInt j, PetscInt n)
{
  return SamFrameRow(f, j, runs->span[n][0], runs->span[n][1]);
}

/*
  SAM_CHUNK - number of cells of a row that are processed together: if all of them lie within their discs, no root or
  division is needed.
*/
#define SAM_CHUNK 256

/*
  SAM_ROW_BLOCK - number of cells in a block of a row. Loops skip blocks without active cells, since on a rough surface
  few cells are in contact. An array `busy` of one char per block, row after row, marks the active blocks.
*/
#define SAM_ROW_BLOCK 64

static inline PetscInt SamRowBlocks(SamGrid grid)
{
  return (grid->nx + SAM_ROW_BLOCK - 1) / SAM_ROW_BLOCK;
}

/*
  SamNextBusy - finds the next cells first ... last - 1 of a row of nx, from column `last` on, whose blocks are all
  busy. `busy` is the array of the row; NULL: all blocks are busy. It returns false if there are no more.
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
  Adds a cell to the sums in a vectorised loop: a projected vector (px, py) times the phi, and the parts of the weighted
  Gram matrix for SamGramTangentialRow(). The sums must be local variables of these names.
*/
#define SAM_ADD_TANGENTIAL(px, py, gxx, gxy, gyy, xi) \
  x += (px), y += (py), turn += (xi) * (py), hxx += (gxx), hxy += (gxy), hyy += (gyy), xi_hxy += (xi) * (gxy), \
    xi_hyy += (xi) * (gyy), xi2_hyy += (xi) * (xi) * (gyy)

/* Adds the cells of a row to that matrix, from their sums h of hxx, hxy, hyy, xi hxy, xi hyy and xi^2 hyy. */
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
  SamFrameSolve - computes the combination a of the free phi with gram a = sums within the free subspace; if the Gram
  matrix is singular there, the shortest a of least residual.
*/
PETSC_EXTERN void SamFrameSolve(const SamFrame *frame, const double gram[SAM_GRAM], const double sums[3], double a[3]);

/*
  SamFrameSolveSeen - does the same, and returns the relative residual, from 0 to 1: the part of the sums outside of the
  range of the Gram matrix. `unseen` is a combination of the phi along this part, on which the sums do positive work.
*/
PETSC_INTERN double SamFrameSolveSeen(const SamFrame *frame, const double gram[SAM_GRAM], const double sums[3],
                                      double a[3], double unseen[3]);

/*
  SamFrameProjectNormal - replaces p by the nearest admissible pressure: p + phi a, cut off at 0 and at the frame's
  `most`, on the cells where mask is 1 (mask NULL: all), with the a for which the force-controlled loads are exact.
  Where the mask is 0, p becomes its nearer bound, which is 0 without an upper one. `found` is false if there is no such
  pressure; p is then unchanged. Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormal(const SamFrame *frame, const float mask[], double p[],
                                                  PetscBool *found);

/* SamPressureStep - a step of a pressure, for the next function, in arrays of this rank's cells. */
typedef struct {
  const float *mask; /* 1 on cells that may have pressure, 0 on others */
  const char  *busy; /* blocks with cells in the mask, or with pressure */
  const float *step; /* direction of the step: the pressure changes by `by` times this */
  double       by;
  PetscBool    nearest; /* find the nearest admissible pressure, even if that takes longer */
  float       *made;    /* result: `scale` times the change of the pressure */
  double       scale;
  double       motion[3]; /* result: the combination of the phi that was added before the pressure was cut off */
} SamPressureStep;

/*
  SamFrameProjectNormalStep - does the same for p + by step, which must nearly carry the loads. p becomes the nearest
  admissible pressure with `nearest`, or if a single step of Newton's method finds it; else an admissible pressure about
  as near. If none is found, p is unchanged up to the rounding of `made`. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrameProjectNormalStep(const SamFrame *frame, SamPressureStep *step, double p[],
                                                      PetscBool *found);

/*
  SamFrameProjectNormalOnContact - does the same on the cells that have pressure, if these can carry the loads, else on
  all cells. (The nearest pressure on all cells would be positive, though small, over much of the grid.) Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectNormalOnContact(const SamFrame *frame, double p[], PetscBool *found);
/*
  SamFrameProjectNormalBetween - does the same on the cells whose pressure lies between its bounds, if these can carry
  the missing load, so that cells at a bound stay there exactly; else it acts as SamFrameProjectNormalOnContact().
  Collective.
*/
PETSC_INTERN PetscErrorCode SamFrameProjectNormalBetween(const SamFrame *frame, double p[], PetscBool *found);

/*
  SamFrameClear - sets `clear` to true if field + phi a <= 0 in all cells, up to rounding of the field, for some free
  rigid-body displacement a: bodies that are free to tilt then lose contact. For frames without load. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrameClear(const SamFrame *frame, const double field[], double a[3], PetscBool *clear);

/*
  SamFrameProjectTangential - replaces q by the nearest admissible shear: D(q + weight phi a), where D projects the
  shear of each cell onto the disc of radius `bound`, with the a for which the force-controlled loads are exact. The
  squared distance of a cell counts 1/weight (weight NULL: 1). `runs` have all cells with a bound above 0; NULL: they
  are found. `motion`, if not NULL, becomes a. `found` is false if there is no such shear; q is then undefined.
  The result is admissible to rounding in any case. With `nearest` it is the nearest admissible shear; without, which is
  faster, it may differ from that by 1e-6 of the change. Collective.
*/
PETSC_EXTERN PetscErrorCode SamFrameProjectTangential(const SamFrame *frame, const SamRuns *runs, const double bound[],
                                                      const float weight[], PetscBool nearest, double q[],
                                                      double motion[3], PetscBool *found);

#endif

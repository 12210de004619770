/*
  The edge of a zone of cells from the field behind it.

  Take a straight edge. The discrete problem there is a Toeplitz system on a half-line, and by Wiener and Hopf's method
  every solution that grows like a root is, far from the edge, alpha (sqrt(j + s) + kappa(s) j^-3/2 + ...) in cell j: it
  has an edge of its own between the cells, at -s. The error of first order is a layer of two cells. So:
    1. Core: cells of the zone farther than BAND from any cell outside. A quadratic function is fitted to w in the core
       cells of a window about each cell of the band, and evaluated there.
    2. The tail of the layer makes the core's edge lie too far out, by SHIFT of a cell in the mean.
    3. Guard: the difference to w must be that of the layer, whose shape is the same for all smooth edges.
    4. Areas: the part of each cell of the band where the function is positive, by sub-cells. Where it is refused, a
       cell counts less FACE for each of its faces to a cell outside.
  Distances are in cells.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/rows.h>
#include <petsam/edges.h>
#include <math.h>

#define BAND   2.5    /* distance of the core from the cells outside */
#define REACH  2      /* cells along a row within that distance */
#define WINDOW 5      /* half width of the window of a fit, cells */
#define LEAST  9      /* core cells in it */
#define SHIFT  0.0105 /* of the edge; fitted on circles and ellipses, within 5 % the same for all */
#define BENT   0.005  /* largest deviation of the core from the function, rms over the slope of a cell */
#define SUB    8      /* sub-cells in each direction */
#define FACE   0.09   /* part of a cell a face */
#define HALO   (WINDOW + REACH + 2)

enum { TERMS = 6 };

/* Rows of the field about this rank's, and what has been found in them. */
typedef struct {
  SamGrid       grid;
  PetscInt      first, count; /* rows that are seen */
  const double *w;
  char         *depth;  /* of each cell: outside, in a layer of the band, or core */
  PetscInt     *slot;   /* of each cell: its place among those of the band, -1 for the others */
  PetscInt      band;   /* number of those */
  char         *passes; /* of each of them: whether its own reconstruction is good */
  double       *fit;    /* of each of them: its function's TERMS */
} Field;

/* Layers of the band by distance, and the least and largest (w less its reconstruction)/slope in them. */
static const double layer_from[]  = {0, 1.2, 2.1};
static const double layer_least[] = {-0.15, -0.03, -0.03}, layer_most[] = {0.20, 0.12, 0.06};
enum { OUTSIDE, NEXT, FIRST_LAYER, CORE = FIRST_LAYER + 3 }; /* next: outside, but beside the zone */

#define OUT_LEAST (-0.2) /* a reconstruction over the slope, of a cell of the zone */
#define IN_MOST   0.25   /* of a cell outside */

static PetscBool Has(const Field *f, PetscInt i, PetscInt j)
{
  return i >= 0 && i < f->grid->nx && j >= f->first && j < f->first + f->count ? PETSC_TRUE : PETSC_FALSE;
}

static ptrdiff_t At(const Field *f, PetscInt i, PetscInt j)
{
  return (ptrdiff_t)(j - f->first) * f->grid->nx + i;
}

/* The layer of a cell of the zone: by the distance of the nearest cell outside. */
static char LayerOf(const Field *f, PetscInt i, PetscInt j)
{
  double nearest = BAND * BAND + 1;

  for (PetscInt b = -REACH; b <= REACH; b++)
    for (PetscInt a = -REACH; a <= REACH; a++)
      if (Has(f, i + a, j + b) && !(f->w[At(f, i + a, j + b)] > 0))
        nearest = PetscMin(nearest, (double)(a * a + b * b));
  if (nearest > BAND * BAND) return CORE;
  for (int k = 2; k >= 0; k--)
    if (nearest >= layer_from[k] * layer_from[k]) return (char)(FIRST_LAYER + k);
  return FIRST_LAYER;
}

/* For each cell of a row: whether it and its neighbours on both sides are all ones; there are ones beyond the grid. */
static void Narrow(PetscInt n, const char in[], char out[])
{
  for (PetscInt i = 1; i + 1 < n; i++) out[i] = in[i - 1] & in[i] & in[i + 1];
  out[0]     = in[0] & in[1];
  out[n - 1] = in[n - 2] & in[n - 1];
}

/* and[i] = and[i] and row[i]; no row: beyond the grid. */
static void And(PetscInt n, char and[], const char *row)
{
  for (PetscInt i = 0; i < n && row; i++) and[i] &= row[i];
}

/* and[i] = and[i] and the same of the rows before and after row j. */
static void NarrowRows(PetscInt n, PetscInt rows, PetscInt j, const char in[], char and[])
{
  And(n, and, j > 0 ? in + (j - 1) * n : NULL);
  And(n, and, j + 1 < rows ? in + (j + 1) * n : NULL);
}

/*
  The layers, in whole rows, so that most cells need no search. The core are cells whose neighbours within the band's
  distance are in the zone: five of three rows, three of the rows beyond. Cells outside are far from the zone when their
  eight neighbours are outside too.
*/
static PetscErrorCode FindLayers(const Field *f)
{
  const PetscInt nx = f->grid->nx, rows = f->count;
  char          *in, *out, *three, *five, *beside, *core, *far;

  PetscFunctionBegin;
  PetscCall(PetscMalloc7(rows * nx, &in, rows * nx, &out, rows * nx, &three, rows * nx, &five, rows * nx, &beside, nx,
                         &core, nx, &far));
  for (PetscInt j = 0; j < rows; j++) {
    for (PetscInt k = j * nx; k < (j + 1) * nx; k++) {
      in[k]  = f->w[k] > 0 ? 1 : 0;
      out[k] = 1 - in[k];
    }
    Narrow(nx, in + j * nx, three + j * nx);
    Narrow(nx, three + j * nx, five + j * nx);
    Narrow(nx, out + j * nx, beside + j * nx);
  }
  for (PetscInt j = 0; j < rows; j++) {
    PetscCall(PetscArraycpy(core, five + j * nx, nx));
    NarrowRows(nx, rows, j, five, core);
    And(nx, core, j > 1 ? three + (j - 2) * nx : NULL);
    And(nx, core, j + 2 < rows ? three + (j + 2) * nx : NULL);
    PetscCall(PetscArraycpy(far, beside + j * nx, nx));
    NarrowRows(nx, rows, j, beside, far);
    for (PetscInt i = 0; i < nx; i++)
      f->depth[j * nx + i] = far[i] ? OUTSIDE : !in[j * nx + i] ? NEXT : core[i] ? CORE : LayerOf(f, i, f->first + j);
  }
  PetscCall(PetscFree7(in, out, three, five, beside, core, far));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the cells that are reconstructed. */
static void FindBand(Field *f)
{
  f->band = 0;
  for (PetscInt k = 0; k < f->count * f->grid->nx; k++)
    f->slot[k] = f->depth[k] != CORE && f->depth[k] != OUTSIDE ? f->band++ : -1;
}

/* ---- fit ---- */

/* The terms 1, x, y, x^2, xy, y^2 at a place in cells. */
static void Terms(double x, double y, double terms[TERMS])
{
  terms[0] = 1;
  terms[1] = x;
  terms[2] = y;
  terms[3] = x * x;
  terms[4] = x * y;
  terms[5] = y * y;
}

static double Evaluate(const double fit[TERMS], double x, double y)
{
  double terms[TERMS], sum = 0;

  Terms(x, y, terms);
  for (int k = 0; k < TERMS; k++) sum += fit[k] * terms[k];
  return sum;
}

/*
  Solves the symmetric positive system A fit = b by Cholesky's method; false where it is singular. (The eigenvalues of
  SamSolveSymmetric() would take longer than the fit.)
*/
static PetscBool SolveFit(double A[TERMS][TERMS], double b[TERMS])
{
  for (int j = 0; j < TERMS; j++) {
    const double whole = A[j][j];

    for (int k = 0; k < j; k++) A[j][j] -= A[j][k] * A[j][k];
    if (!(A[j][j] > 1e-10 * whole)) return PETSC_FALSE;
    A[j][j] = sqrt(A[j][j]);
    for (int i = j + 1; i < TERMS; i++) {
      for (int k = 0; k < j; k++) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
    }
  }
  for (int i = 0; i < TERMS; i++) {
    for (int k = 0; k < i; k++) b[i] -= A[i][k] * b[k];
    b[i] /= A[i][i];
  }
  for (int i = TERMS - 1; i >= 0; i--) {
    for (int k = i + 1; k < TERMS; k++) b[i] -= A[k][i] * b[k];
    b[i] /= A[i][i];
  }
  return PETSC_TRUE;
}

/* The function through the core cells about a cell, and how far they are from it, rms. False: too few of them. */
static PetscBool Fit(const Field *f, PetscInt i, PetscInt j, double fit[TERMS], double *bent)
{
  double   A[TERMS][TERMS] = {{0}}, right[TERMS] = {0}, terms[TERMS], squares = 0;
  PetscInt count = 0;

  for (PetscInt b = -WINDOW; b <= WINDOW; b++)
    for (PetscInt a = -WINDOW; a <= WINDOW; a++) {
      if (!Has(f, i + a, j + b) || f->depth[At(f, i + a, j + b)] != CORE) continue;
      Terms((double)a / WINDOW, (double)b / WINDOW, terms);
      count++;
      squares += f->w[At(f, i + a, j + b)] * f->w[At(f, i + a, j + b)];
      for (int k = 0; k < TERMS; k++) {
        right[k] += terms[k] * f->w[At(f, i + a, j + b)];
        for (int l = 0; l <= k; l++) A[k][l] += terms[k] * terms[l];
      }
    }
  for (int k = 0; k < TERMS; k++) fit[k] = right[k];
  if (count < LEAST || !SolveFit(A, fit)) return PETSC_FALSE;
  for (int k = 0; k < TERMS; k++)
    squares -= fit[k] * right[k]; /* of the deviations: the function is their nearest one */
  for (int k = 1; k < TERMS; k++) fit[k] /= k < 3 ? WINDOW : WINDOW * WINDOW;
  *bent = sqrt(PetscMax(squares, 0) / (double)count);
  return PETSC_TRUE;
}

/* Reconstructs a cell of the band; its constant becomes w*, the shift included. Whether it looks like a smooth edge. */
static PetscBool Reconstruct(const Field *f, PetscInt i, PetscInt j, double fit[TERMS])
{
  const ptrdiff_t k     = At(f, i, j);
  const char      depth = f->depth[k];
  double          bent  = 0, slope, over;

  if (!Fit(f, i, j, fit, &bent)) return PETSC_FALSE;
  slope = hypot(fit[1], fit[2]);
  fit[0] -= SHIFT * slope;
  if (!(bent < BENT * slope)) return PETSC_FALSE;
  if (depth == NEXT) return fit[0] < IN_MOST * slope ? PETSC_TRUE : PETSC_FALSE;
  over = (f->w[k] - fit[0]) / slope;
  return fit[0] > OUT_LEAST * slope && over >= layer_least[depth - FIRST_LAYER] &&
             over <= layer_most[depth - FIRST_LAYER]
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Whether a cell of the band and its neighbours pass. */
static PetscBool IsAccepted(const Field *f, PetscInt i, PetscInt j)
{
  for (PetscInt b = -1; b <= 1; b++)
    for (PetscInt a = -1; a <= 1; a++)
      if (Has(f, i + a, j + b) && f->slot[At(f, i + a, j + b)] >= 0 && !f->passes[f->slot[At(f, i + a, j + b)]])
        return PETSC_FALSE;
  return PETSC_TRUE;
}

/* ---- areas ---- */

/* The part of a cell where its function is positive. */
static double PartOf(const double fit[TERMS])
{
  const double slope = hypot(fit[1], fit[2]) / SUB;
  double       sum   = 0;

  for (int b = 0; b < SUB; b++)
    for (int a = 0; a < SUB; a++) {
      const double part = 0.5 + 0.75 * Evaluate(fit, (a + 0.5) / SUB - 0.5, (b + 0.5) / SUB - 0.5) / slope;

      sum += part < 0 ? 0 : part > 1 ? 1 : part;
    }
  return sum / (SUB * SUB);
}

enum { AREA, FACES, GOOD, CELLS, SUMS };

/*
  Adds the place on the edge that is nearest to the centre of a cell of this rank, if it lies in the cell.
*/
static void AddPoint(SamGrid grid, const double fit[TERMS], PetscInt i, PetscInt j, SamEdge *edge)
{
  const double square = fit[1] * fit[1] + fit[2] * fit[2], x = -fit[0] * fit[1] / square, y = -fit[0] * fit[2] / square;
  const PetscInt n = edge->count;

  if (!(fabs(x) <= 0.5 && fabs(y) <= 0.5)) return;
  edge->x[n]    = SamGridX(grid, i) + x * grid->dx;
  edge->y[n]    = SamGridY(grid, j) + y * grid->dy;
  edge->cell[n] = (j - grid->row_start) * grid->nx + i;
  edge->count++;
}

/* Adds a cell to the sums and to the edge, and writes its value. */
static void AddCell(const Field *f, PetscInt i, PetscInt j, double sums[SUMS], double *point, SamEdge *edge)
{
  static const PetscInt x[] = {1, -1, 0, 0}, y[] = {0, 0, 1, -1};

  const ptrdiff_t k      = At(f, i, j);
  const PetscBool inside = f->depth[k] >= FIRST_LAYER ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool good   = f->slot[k] >= 0 && IsAccepted(f, i, j) ? PETSC_TRUE : PETSC_FALSE;
  const double   *fit    = good ? f->fit + TERMS * (ptrdiff_t)f->slot[k] : NULL;
  PetscInt        faces  = 0;

  for (int n = 0; n < 4 && inside && f->slot[k] >= 0; n++)
    if (Has(f, i + x[n], j + y[n]) && f->depth[At(f, i + x[n], j + y[n])] < FIRST_LAYER) faces++;
  sums[FACES] += (double)faces;
  sums[GOOD] += good ? (double)faces : 0;
  sums[CELLS] += inside ? 1 : 0;
  sums[AREA] += good ? PartOf(fit) : inside ? 1 - FACE * (double)faces : 0;
  if (point) *point = good ? PetscMax(fit[0], 0) : f->w[k];
  if (good) AddPoint(f->grid, fit, i, j, edge);
}

PetscErrorCode SamEdgeDestroy(SamEdge *edge)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(edge->x, edge->y, edge->cell));
  edge->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the whole ---- */

static PetscErrorCode Examine(Field *f)
{
  const PetscInt nx = f->grid->nx;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(f->count * nx, &f->depth, f->count * nx, &f->slot));
  PetscCall(FindLayers(f));
  FindBand(f);
  PetscCall(PetscMalloc2(f->band, &f->passes, TERMS * f->band, &f->fit));
  for (PetscInt j = f->first; j < f->first + f->count; j++)
    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt k = f->slot[At(f, i, j)];

      if (k >= 0) f->passes[k] = Reconstruct(f, i, j, f->fit + TERMS * (ptrdiff_t)k) ? 1 : 0;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeReconstruct(SamGrid grid, Vec w, Vec point, SamEdge *edge)
{
  const PetscInt begin       = PetscMax(grid->row_start - HALO, 0),
                 end         = PetscMin(grid->row_start + grid->rows + HALO, grid->ny);
  SamTotal      totals[SUMS] = {{0}};
  Field         f            = {.grid = grid, .first = grid->rows ? begin : 0, .count = grid->rows ? end - begin : 0};
  SamRows       rows;
  const double *own;
  double       *points = NULL, sums[SUMS];

  PetscFunctionBegin;
  PetscCall(SamRowsCreate(grid, f.first, f.count, &rows));
  PetscCall(VecGetArrayRead(w, &own));
  PetscCall(SamRowsFetch(&rows, grid->nx, own, &f.w));
  PetscCall(Examine(&f));
  edge->count = 0;
  PetscCall(PetscMalloc3(f.band, &edge->x, f.band, &edge->y, f.band, &edge->cell));
  if (point) PetscCall(VecGetArray(point, &points));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row[SUMS] = {0};

    for (PetscInt i = 0; i < grid->nx; i++)
      AddCell(&f, i, grid->row_start + j, row, points ? points + (ptrdiff_t)j * grid->nx + i : NULL, edge);
    SamAddAll(SUMS, totals, row);
  }
  if (point) PetscCall(VecRestoreArray(point, &points));
  PetscCall(PetscFree2(f.depth, f.slot));
  PetscCall(PetscFree2(f.passes, f.fit));
  PetscCall(SamRowsRestore(&rows, &f.w));
  PetscCall(VecRestoreArrayRead(w, &own));
  PetscCall(SamRowsDestroy(&rows));
  PetscCall(SamSumTotals(grid->comm, SUMS, totals, sums));
  edge->area  = sums[AREA] * grid->dx * grid->dy;
  edge->cells = (PetscInt)sums[CELLS];
  edge->faces = sums[FACES];
  edge->good  = sums[GOOD];
  PetscFunctionReturn(PETSC_SUCCESS);
}

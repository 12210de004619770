/*
  Estimates the error of a grid in the peak of the pressure.

  No quotient of the pressures near the peak gives this error for all shapes: a pressure that falls to zero within a
  cell or two may belong to a rounded edge, where finer cells raise it, or to an edge in a favourable place on the grid.
  So the contact near the peak is solved again on cells half as wide:

  1. Take a patch of 18 x 18 cells about the peak, of 18 in plane strain. The displacements by the pressure outside of
     it are the gap minus the shape minus the patch's own displacements; they are smooth, and interpolated to the finer
     cells.
  2. The separation on the finer cells is the shape itself plus these displacements. Roughness, heights from a file and
     wear are interpolated, too.
  3. The pressure of the outer three cells stays as it is; within them the normal problem is solved under the same load
     and without rotation.
  4. While the peak changes, the patch about the new peak is solved on cells half as wide again; at least twice if the
     peak is in the last cell of the contact, where the first change may be small by chance.

  Heights that are interpolated may miss a tip or an edge between two cells. So the first patch is interpolated in two
  ways, which differ at an edge, and the larger change counts. Neither reveals a tip in the contact, but the fourth
  differences of the heights do: a wave two cells long, with 0.08 of their height, changes the pressure by about E*
  times its height over the cells' width. The factor 0.08 was found by trials. A ridge whose slope changes by s has
  a pressure without limit, that of a wedge: it grows by E* s ln 2/(2 pi) with each halving of the cells. Between two
  cells its fourth differences are small, and its s is the second differences of both cells, minus those beside them.

  Lengths of the patch are in units of its cells: displacements under the same pressure are proportional to the cells'
  width, so operators and solver are created once. All ranks solve the same problem; the results of the first rank are
  used.
*/
#include <petsam/private/advice.h>
#include <petsam/normal.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/body.h>
#include <petsam/private/grid.h>
#include <petsam/private/gap.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

#define RING    3                        /* cells about the part that is solved again */
#define WIDE    18                       /* cells of a patch in each direction, */
#define FINE    (WIDE * 2)               /* on the finer grid, */
#define INNER   (FINE - 4 * RING)        /* and of the part that is solved again there */
#define MARGIN  4                        /* finer cells at the border of that part, in which no peak is searched */
#define LEVEL   0.9                      /* a peak is resolved if a cell beside it has at least this part of it */
#define CENTRAL 6                        /* number of places of an interpolation, */
#define VARYING 4                        /* number of places of an interpolation that avoids edges */
#define TIP     0.08                     /* part of the fourth differences that counts, */
#define RIDGE   (M_LN2 / (2 * PETSC_PI)) /* and of the change of slope at a ridge */
#define SHARP   0.4                      /* change at a sharp edge, the largest that interpolation can detect */
#define SETTLED 0.03                     /* change of the peak on cells half as wide as those of an advised grid */

/* Pressure of the cells of the last patch, and their gap without the shape */
typedef struct {
  PetscInt  axes;               /* 2, or 1 for one row of cells */
  PetscReal corner[2], cell[2]; /* m: place of the first cell, and widths of a cell */
  double    p[FINE * FINE];     /* Pa */
  double    g[FINE * FINE];     /* m, times `scale` */
  double    scale;              /* ratio of the cell width of the first patch to that of this one */
  double    tip;                /* m: wave two cells long, or ridge, that may be hidden on the first patch */
  PetscBool last;               /* true: a cell beside the first peak is open */
} Patch;

/* Operators of the first patch, coarse and fine, and the solver. */
typedef struct {
  SamGap             gap;
  SamGrid            whole; /* of the contact */
  const SamSolution *solution;
  PetscBool          wrap;
  SamGrid            grid[3];
  SamElasticity      elasticity[3]; /* of the patch, its finer cells, and the part that is solved again */
  Vec                field[3];
  Vec                pressure;
  SamNormal          normal;
} Local;

/* Returns the number of rows of a patch with so many cells in each direction. */
static PetscInt Rows(PetscInt axes, PetscInt n)
{
  return axes == 1 ? 1 : n;
}

/* Returns the cell of the largest pressure on the first patch. */
static PetscInt PeakOf(const Patch *a)
{
  return Rows(a->axes, WIDE) / 2 * WIDE + WIDE / 2;
}

static PetscErrorCode CreateLocal(const SamSetup *s, Local *l)
{
  const PetscInt  cells[3] = {WIDE, FINE, INNER};
  const PetscReal zero[2]  = {0, 0};

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    const PetscReal part     = k ? 0.5 * (PetscReal)cells[k] : (PetscReal)cells[k];
    const PetscReal width[2] = {part * s->grid->dx, SamGridIsRow(s->grid) ? s->grid->dy : part * s->grid->dy};
    const PetscInt  n[2]     = {cells[k], Rows(s->grid->axes, cells[k])};

    PetscCall(SamGridCreate(PETSC_COMM_SELF, n, width, zero, &l->grid[k]));
    PetscCall(SamElasticityCreate(l->grid[k], s->pair, &l->elasticity[k]));
    PetscCall(SamGridCreateVec(l->grid[k], 1, &l->field[k]));
  }
  PetscCall(VecDuplicate(l->field[2], &l->pressure));
  PetscCall(SamNormalCreate(l->elasticity[2], &l->normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyLocal(Local *l)
{
  PetscFunctionBegin;
  PetscCall(SamNormalDestroy(&l->normal));
  PetscCall(VecDestroy(&l->pressure));
  for (int k = 0; k < 3; k++) {
    PetscCall(VecDestroy(&l->field[k]));
    PetscCall(SamElasticityDestroy(&l->elasticity[k]));
    PetscCall(SamGridDestroy(&l->grid[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds `sign` times the displacements under the pressure p of the patch (k = 0), or of its finer cells (1). */
static PetscErrorCode AddDisplacements(const Local *l, int k, const double p[], double sign, double u[])
{
  const PetscInt count = l->grid[k]->cells;
  double        *field;

  PetscFunctionBegin;
  PetscCall(VecGetArray(l->field[k], &field));
  PetscCall(PetscArraycpy(field, p, count));
  PetscCall(VecRestoreArray(l->field[k], &field));
  PetscCall(SamElasticityApplyNormal(l->elasticity[k], l->field[k], l->field[k]));
  PetscCall(VecGetArray(l->field[k], &field));
  for (PetscInt c = 0; c < count; c++) u[c] += sign * field[c];
  PetscCall(VecRestoreArray(l->field[k], &field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Subtracts (sign -1) or adds the shape at the cells of a patch with rows of n. */
static void AddShape(const Local *l, const Patch *a, PetscInt n, double sign, double g[])
{
  for (PetscInt c = 0; c < n * Rows(a->axes, n); c++) {
    PetscReal x[2] = {a->corner[0] + ((PetscReal)(c % n) + 0.5) * a->cell[0],
                      a->corner[1] + ((PetscReal)(c / n) + 0.5) * a->cell[1]};

    for (int k = 0; k < a->axes && l->wrap; k++)
      x[k] -= l->whole->width[k] * floor((x[k] - l->whole->center[k]) / l->whole->width[k] + 0.5);
    g[c] += sign * a->scale * SamGapGetHeight(l->gap, x[0], x[1]);
  }
}

/* Returns the difference of the given order of the values that begin at f. */
static double Difference(const double f[], ptrdiff_t stride, PetscInt order)
{
  if (!order) return f[0];
  return Difference(f + stride, stride, order - 1) - Difference(f, stride, order - 1);
}

/*
  Interpolates values at WIDE places, `stride` apart, to the centres of twice as many cells: by the polynomials through
  the six nearest places, or through the four where the values vary least, which do not oscillate at an edge (Harten et
  al. 1987, J. Comput. Phys. 71, 231).
*/
static void Interpolate(PetscInt points, const double from[], double to[], ptrdiff_t stride)
{
  for (PetscInt i = 0; i < FINE; i++) {
    const double x = 0.5 * ((double)i + 0.5) - 0.5;
    PetscInt first = points == CENTRAL ? (PetscInt)floor(x) - 2 : PetscMin(PetscMax((PetscInt)floor(x), 0), WIDE - 2);

    for (PetscInt order = 2; points != CENTRAL && order < points; order++) {
      const double *f = from + first * stride;

      if (first > 0 &&
          (first + order >= WIDE || fabs(Difference(f - stride, stride, order)) < fabs(Difference(f, stride, order))))
        first--;
    }
    first          = PetscMin(PetscMax(first, 0), WIDE - points);
    to[i * stride] = 0;
    for (PetscInt a = first; a < first + points; a++) {
      double weight = 1;

      for (PetscInt b = first; b < first + points; b++)
        if (b != a) weight *= (x - (double)b) / (double)(a - b);
      to[i * stride] += weight * from[a * stride];
    }
  }
}

static PetscBool IsInner(PetscInt axes, PetscInt c, PetscInt margin)
{
  const PetscInt i = c % FINE, j = c / FINE, least = 2 * RING + margin, most = FINE - least;

  return i >= least && i < most && (axes == 1 || (j >= least && j < most)) ? PETSC_TRUE : PETSC_FALSE;
}

/* Solves the inner part of the finer patch under its load; `h` is the separation without its own displacements. */
static PetscErrorCode SolveInner(Local *l, const double h[], double p[], PetscBool *solved)
{
  SamBalance     balance = {.kind = SAM_BALANCE_NORMAL, .force = {PETSC_TRUE, PETSC_FALSE, PETSC_FALSE}};
  const PetscInt axes = l->whole->axes, count = l->grid[1]->cells;
  double        *field, load                  = 0;
  const double  *pressure;
  PetscInt       k = 0;

  PetscFunctionBegin;
  PetscCall(VecGetArray(l->field[2], &field));
  for (PetscInt c = 0; c < count; c++)
    if (IsInner(axes, c, 0)) {
      load += p[c];
      field[k++] = h[c];
    }
  PetscCall(VecRestoreArray(l->field[2], &field));
  balance.load[0] = load * l->grid[2]->dx * l->grid[2]->dy;
  PetscCall(SamNormalSolve(l->normal, l->field[2], &balance, PETSC_FALSE, l->pressure));
  PetscCall(VecGetArrayRead(l->pressure, &pressure));
  for (PetscInt c = k = 0; c < count; c++)
    if (IsInner(axes, c, 0)) p[c] = pressure[k++];
  PetscCall(VecRestoreArrayRead(l->pressure, &pressure));
  *solved = SamSolverGetReason(SamNormalAsSolver(l->normal)) > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the cells from `first` to `last`, counted from one with pressure p, are in contact. */
static PetscBool IsClosed(const double p[], PetscInt stride, PetscInt first, PetscInt last)
{
  for (PetscInt c = first; c <= last; c++)
    if (!SamIsPressed(p[c * stride])) return PETSC_FALSE;
  return PETSC_TRUE;
}

static double FourthDifference(const double h[], PetscInt stride)
{
  return Difference(h - 2 * stride, stride, 4);
}

/*
  Returns the second differences of a cell and of the next one together, minus those of a smooth surface: interpolated
  by a parabola from the two cells on both sides.
*/
static double FoldAt(const double h[], PetscInt stride)
{
  double second[6];

  for (PetscInt c = 0; c < 6; c++) second[c] = Difference(h + (c - 3) * stride, stride, 2);
  return second[2] + second[3] - 1.5 * (second[1] + second[4]) + 0.5 * (second[0] + second[5]);
}

/* Returns the height of what may be hidden between the cells about the peak, if all of them are in contact. */
static double FindTip(const Patch *a, const double heights[])
{
  const PetscInt beside = a->axes - 1;
  double         tip = 0, ridge = 0;

  for (PetscInt j = -beside; j <= beside; j++)
    for (PetscInt i = -1; i <= 1; i++)
      for (PetscInt k = 0; k < a->axes; k++) {
        const PetscInt stride = k ? WIDE : 1, at = PeakOf(a) + j * WIDE + i;
        const double  *h = heights + at, *p = a->p + at;

        if (!IsClosed(p, stride, -2, 2)) return 0;
        tip = PetscMax(tip, fabs(FourthDifference(h, stride)));
        if (IsClosed(p, stride, -3, 4)) ridge = PetscMax(ridge, fabs(FoldAt(h, stride)));
      }
  return PetscMax(TIP * tip, RIDGE * ridge);
}

/* Refines WIDE cells in each direction to FINE cells in their place, with another pressure within the outer cells. */
static PetscErrorCode Refine(Local *l, PetscInt points, Patch *a, PetscBool *solved)
{
  const PetscInt count = l->grid[1]->cells;
  double         rows[FINE * WIDE], h[FINE * FINE], p[FINE * FINE];
  PetscInt       c;

  PetscFunctionBegin;
  PetscCall(AddDisplacements(l, 0, a->p, -1, a->g));
  if (a->scale == 1) a->tip = FindTip(a, a->g);
  if (a->axes == 1) PetscCall(PetscArraycpy(rows, a->g, WIDE));
  for (c = 0; c < WIDE && a->axes == 2; c++) Interpolate(points, a->g + c, rows + c, WIDE);
  for (c = 0; c < Rows(a->axes, FINE); c++) Interpolate(points, rows + c * WIDE, a->g + c * FINE, 1);
  for (int k = 0; k < a->axes; k++) a->cell[k] *= 0.5;
  for (c = 0; c < count; c++) p[c] = a->p[c / FINE / 2 * WIDE + c % FINE / 2];
  for (c = 0; c < count; c++) a->p[c] = IsInner(a->axes, c, 0) ? 0 : p[c];
  PetscCall(PetscArraycpy(h, a->g, count));
  AddShape(l, a, FINE, 1, h);
  PetscCall(AddDisplacements(l, 1, a->p, 1, h));
  PetscCall(PetscArraycpy(a->p, p, count));
  PetscCall(SolveInner(l, h, a->p, solved));
  PetscCall(AddDisplacements(l, 1, a->p, 1, a->g));
  for (c = 0; c < count; c++) a->g[c] *= 2;
  a->scale *= 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the peak of a finer patch, and extracts the patch about it. */
static double TakePeak(Patch *a)
{
  const PetscInt rows = Rows(a->axes, WIDE);
  PetscInt       peak = Rows(a->axes, FINE) / 2 * FINE + FINE / 2, first[2];
  double         most;

  for (PetscInt c = 0; c < FINE * Rows(a->axes, FINE); c++)
    if (IsInner(a->axes, c, MARGIN) && a->p[c] > a->p[peak]) peak = c;
  most = a->p[peak];

  first[0] = peak % FINE - WIDE / 2;
  first[1] = peak / FINE - rows / 2;
  for (int k = 0; k < 2; k++) a->corner[k] += (PetscReal)first[k] * a->cell[k];
  for (PetscInt c = 0; c < WIDE * rows; c++) {
    const PetscInt from = (first[1] + c / WIDE) * FINE + first[0] + c % WIDE;

    a->p[c] = a->p[from];
    a->g[c] = a->g[from];
  }
  return most;
}

/* ---- the patch on the grid ---- */

/* Gathers the values of a field in the patch about a cell, on all ranks; beyond the grid's edge those at the edge. */
static PetscErrorCode Gather(const Local *l, Vec field, const PetscInt at[2], double values[])
{
  const SamGrid  grid = l->whole;
  const PetscInt n[2] = {grid->nx, grid->ny}, rows = Rows(grid->axes, WIDE);
  const double  *f;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &f));
  for (PetscInt c = 0; c < WIDE * rows; c++) {
    PetscInt place[2] = {at[0] - WIDE / 2 + c % WIDE, at[1] - rows / 2 + c / WIDE}, row;

    for (int k = 0; k < 2; k++)
      place[k] = l->wrap ? (place[k] + n[k]) % n[k] : PetscMin(PetscMax(place[k], 0), n[k] - 1);
    row       = place[1] - grid->row_start;
    values[c] = row >= 0 && row < grid->rows ? f[(ptrdiff_t)row * grid->nx + place[0]] : 0;
  }
  PetscCall(VecRestoreArrayRead(field, &f));
  PetscCall(SamSum(grid->comm, WIDE * rows, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills the first patch about this cell; its gap only if the cells beside it differ from its pressure: else `level`. */
static PetscErrorCode FillPatch(const SamSetup *s, const Local *l, const PetscInt at[2], Patch *a, PetscBool *level)
{
  const PetscReal cell[2] = {s->grid->dx, s->grid->dy};
  const double   *p;
  double          least;
  Vec             gap;

  PetscFunctionBegin;
  a->scale = 1;
  a->axes  = s->grid->axes;
  for (int k = 0; k < 2; k++) {
    const PetscReal before = k < a->axes ? 0.5 * (PetscReal)(WIDE + 1) : 0.5; /* cells from corner to peak */

    a->cell[k]   = cell[k];
    a->corner[k] = (k ? SamGridY(s->grid, at[k]) : SamGridX(s->grid, at[k])) - before * cell[k];
  }
  PetscCall(Gather(l, l->solution->pressure, at, a->p));
  p       = a->p + PeakOf(a);
  least   = a->axes == 1 ? p[0] : PetscMin(p[-WIDE], p[WIDE]);
  least   = PetscMin(least, PetscMin(p[-1], p[1]));
  *level  = least >= LEVEL * p[0] ? PETSC_TRUE : PETSC_FALSE;
  a->last = !SamIsPressed(least);
  if (*level) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(s->grid, 1, &gap));
  PetscCall(SamContactGetField(s->contact, "gap", gap));
  PetscCall(Gather(l, gap, at, a->g));
  PetscCall(VecDestroy(&gap));
  AddShape(l, a, WIDE, -1, a->g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves finer and finer patches until the peak no longer changes. */
static PetscErrorCode Follow(const SamSetup *s, Local *l, Patch *a, SamExtent *extent)
{
  const PetscInt n    = PetscMax(s->grid->nx, s->grid->ny);
  const double   most = a->p[PeakOf(a)], cell = s->grid->side[0];
  double         before = most, change = 1, other = 0, tip;
  PetscInt       finer = 1; /* number of cells of a patch to one of the grid */
  PetscBool      solved;
  Patch         *b;

  PetscFunctionBegin;
  PetscCall(PetscNew(&b));
  *b = *a;
  while ((fabs(change) > SETTLED || (finer == 2 && a->last)) && extent->finer) {
    PetscCall(Refine(l, VARYING, a, &solved));
    if (!solved) break;
    change = TakePeak(a) / before - 1;
    before *= 1 + change;
    if (finer == 1 || fabs(extent->change) <= SETTLED) extent->change = change;
    finer *= 2;
    if (fabs(change) > SETTLED) extent->finer = finer * n > SAM_LARGEST_ROW ? 0 : finer;
  }
  PetscCall(Refine(l, CENTRAL, b, &solved));
  if (solved) other = PetscMin(TakePeak(b) / most - 1, SHARP);
  tip = PetscMin(b->tip * SamPairModulus(s->pair) / (cell * most), SHARP);
  if (fabs(other) > fabs(extent->change)) extent->change = other;
  if (tip > fabs(extent->change)) extent->change = tip;
  if (fabs(extent->change) > SETTLED && extent->finer == 1) extent->finer = 2;
  if (extent->finer && PetscMax(other, tip) >= SHARP) extent->finer = PetscMax(extent->finer, 4); /* a first guess */
  PetscCall(PetscFree(b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceMeasurePeak(const SamSetup *s, SamExtent *extent)
{
  Local     l = {.gap = s->gap, .whole = s->grid};
  Patch    *a;
  PetscReal limit;
  PetscInt  at[2];
  PetscBool level;
  SamState  state;
  double    most, numbers[2];

  PetscFunctionBegin;
  extent->change = 0;
  extent->finer  = 1;
  PetscCall(SamProblemGetPressureLimit(s->problem, &limit));
  PetscCall(SamContactGetSolution(s->contact, &l.solution));
  PetscCall(SamGridFindPeak(s->grid, l.solution->pressure, at, &most));
  PetscCall(SamContactGetState(s->contact, &state));
  /* The pressure of bodies that yield differs on finer cells from that of the elastic patch. */
  if (!(most > 0) || SamProblemHasYielded(s->problem, state) || most >= SAM_SATURATED * limit || s->grid->fewest < WIDE)
    PetscFunctionReturn(PETSC_SUCCESS);
  l.wrap = SamElasticityGetTraits(s->elasticity).periodic;
  PetscCall(PetscNew(&a));
  PetscCall(FillPatch(s, &l, at, a, &level));
  if (!level) {
    PetscCall(CreateLocal(s, &l));
    PetscCall(Follow(s, &l, a, extent));
    PetscCall(DestroyLocal(&l));
  }
  PetscCall(PetscFree(a));
  numbers[0] = extent->change;
  numbers[1] = (double)extent->finer;
  PetscCallMPI(MPI_Bcast(numbers, 2, MPI_DOUBLE, 0, s->grid->comm));
  extent->change = numbers[0];
  extent->finer  = (PetscInt)numbers[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The largest shear, which is mu p at the edge of a stick zone, and so lies between cells, whose values are means.

  1. Where the edge of stick is reconstructed, p^2 is interpolated to its points. It is smooth up to the contact's edge.
  2. Where it is not, as under pads, or where the contact's edge is near, three cells are used. The slack of sticking
  cells, mu p - q.d with the direction d of the slipping shear, vanishes at the edge like the root of the distance, also
  after a reversal, when |q| has been mu p everywhere. The distance of the edge from the centre of the last sticking
  cell follows from the ratio y of its slack to that of the cell behind it:

         u = -0.17551 + 1.01898 y + 0.32267 y^2 + 0.36465 y^3     cells,

     fitted on Hertz's contact in plane strain, of 760 cells at 66 places, within 5e-4: the pressure vanishes at the
     contact's edge as the slack does at the stick edge. The shear is interpolated by p^2 between this cell and the
     next. If that is the last one in contact, its mean p is not that at its centre: then p^2 falls at least as fast as
     towards the edge of contact, which is found in the same way. This is not used with a film, where the slack vanishes
     differently.

  For spheres and cylinders the first is accurate within 3e-3, and the second within 4 % in slip zones wider than 0.8
  cells, about 20 % in those wider than 0.05.

  3. After a reversal all sticks about that place, and its shear is still the largest until it is overcome. It then
  changes as the shear of the cell beside it does, since a change without slip is smooth there: the state keeps the
  difference of both, until the cell slips again. The shear stays within its bound, which has the same ratio to that of
  the cell as before.
*/
#include <petsam/private/bodyimpl.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/problem.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>

#define BEHIND   2     /* cells about a point of the reconstructed edge that must be in contact */
#define FARTHEST 0.825 /* in cells: an edge farther away belongs to the next cell */

/* Fields of a solution with halos; `cell`: state of each cell, or KNOWN where the stick edge is reconstructed */
#define KNOWN (-1)
typedef struct {
  SamGrid grid;
  SamHalo p, b, q, cell;
} Seen;

/* The largest shear found so far (Pa), and the grid's cell beside which it is; -1: it is the mean of a cell */
typedef struct {
  double   shear;
  PetscInt cell;
} Peak;

static void Raise(Peak *peak, double shear, PetscInt cell)
{
  if (shear > peak->shear) *peak = (Peak){shear, cell};
}

/* A peak between cells that the state keeps */
typedef struct {
  double cell;     /* number of the cell beside it, from 1; 0: there is none */
  double above[2]; /* its shear minus that of the cell (Pa) */
  double bound;    /* its bound relative to that of the cell */
} Kept;
#define VALUES ((PetscInt)(sizeof(Kept) / sizeof(double)))

static const SamStateNumber kept_peak = {"kept_peak", "1",           NULL, SAM_NUMBER_REAL, VALUES, PETSC_TRUE,
                                         PETSC_FALSE, SAM_JOIN_LAST, 0};

PetscErrorCode SamSolutionDeclareShear(SamState state)
{
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareOptional(state, &kept_peak, 0, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if cell i of row j of the grid and its neighbours are in contact, so that the contact edge is farther away. */
static PetscBool IsInside(const SamHalo *p, PetscInt i, PetscInt j)
{
  const PetscInt rows = (p->rows.grid->axes - 1) * BEHIND;

  for (PetscInt b = j - rows; b <= j + rows; b++)
    for (PetscInt a = i - BEHIND; a <= i + BEHIND; a++)
      if (!(SamHaloAt(p, 0, a, b) > 0)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static double SquareIn(const SamHalo *p, PetscInt i, PetscInt j)
{
  const double value = SamHaloAt(p, 0, i, j);

  return value * value;
}

/* Returns p^2 at (x, y), in cells from the grid's first one, interpolated between the four cells about it. */
static double SquareAt(const SamHalo *p, double x, double y)
{
  const PetscInt i = (PetscInt)floor(x), j = (PetscInt)floor(y);
  const double tx = x - (double)i, ty = y - (double)j, here = (1 - tx) * SquareIn(p, i, j) + tx * SquareIn(p, i + 1, j);

  if (SamGridIsRow(p->rows.grid)) return here;
  return (1 - ty) * here + ty * ((1 - tx) * SquareIn(p, i, j + 1) + tx * SquareIn(p, i + 1, j + 1));
}

/* Finds the largest shear at the reconstructed points of the edge, and marks their cells as known. */
static void FindAtPoints(const Seen *s, const SamEdge *stick, double cell[], Peak *peak)
{
  const double *b = s->b.own;

  for (PetscInt n = 0; n < stick->count; n++) {
    const PetscInt k = stick->cell[n], i = k % s->grid->nx, j = s->grid->row_start + k / s->grid->nx;
    /* coordinates from the grid's first row, since sums from the rank's first row would round differently */
    const double x = (double)((stick->x[n] - SamGridX(s->grid, 0)) / s->grid->dx),
                 y = (double)((stick->y[n] - SamGridY(s->grid, 0)) / s->grid->dy);

    if (!IsInside(&s->p, i, j)) continue;
    cell[k] = KNOWN;
    Raise(peak, b[k] / s->p.own[k] * sqrt(SquareAt(&s->p, x, y)), j * s->grid->nx + i);
  }
}

/* Returns the slack of a cell, divided by mu, in the direction of a shear. */
static double SlackAt(const Seen *s, PetscInt i, PetscInt j, const double shear[2])
{
  const double p = SamHaloAt(&s->p, 0, i, j), b = SamHaloAt(&s->b, 0, i, j), size = hypot(shear[0], shear[1]);

  return b > 0 ? p * (1 - (shear[0] * SamHaloAt(&s->q, 0, i, j) + shear[1] * SamHaloAt(&s->q, 1, i, j)) / (b * size))
               : 0;
}

/*
  Returns the distance, in cells, from the centre of a cell to where what vanishes like a root is zero; `ratio`: its
  value in that cell over that in the cell behind it.
*/
static double DistanceOfZero(double ratio)
{
  return PetscMin(-0.17551 + ratio * (1.01898 + ratio * (0.32267 + ratio * 0.36465)), FARTHEST);
}

/* Returns the shear at the edge of stick between a cell that sticks and the next one in a direction, which slips. */
static double ShearAt(const Seen *s, PetscInt i, PetscInt j, PetscInt x, PetscInt y)
{
  const double p = SamHaloAt(&s->p, 0, i, j), next = SamHaloAt(&s->p, 0, i + x, j + y);
  const double shear[] = {SamHaloAt(&s->q, 0, i + x, j + y), SamHaloAt(&s->q, 1, i + x, j + y)};
  const double slack = SlackAt(s, i, j, shear), behind = SlackAt(s, i - x, j - y, shear);
  double       fall = 1 - next * next / (p * p), u; /* fall of p^2, relative to it, over a cell */

  if (!(slack > 0 && behind > 0)) return 0;
  u = DistanceOfZero(slack / behind);
  if (u > 0 && !(SamHaloAt(&s->p, 0, i + 2 * x, j + 2 * y) > 0))
    fall = PetscMax(fall, 1 / (1 + DistanceOfZero(next / p)));
  return SamHaloAt(&s->b, 0, i, j) * sqrt(PetscMax(1 - fall * u, 0));
}

/* Returns the largest shear at the edge of stick beside a cell that sticks, 0 where the edge is known. */
static double ShearBeside(const Seen *s, PetscInt i, PetscInt j)
{
  static const PetscInt x[] = {1, -1, 0, 0}, y[] = {0, 0, 1, -1};

  const PetscInt rows = s->grid->axes - 1;
  double         most = 0;

  for (PetscInt b = j - rows; b <= j + rows; b++)
    for (PetscInt a = i - 1; a <= i + 1; a++)
      if (SamHaloAt(&s->cell, 0, a, b) == KNOWN) return 0;
  for (PetscInt n = 0; n < 2 * s->grid->axes; n++) {
    const PetscBool slips = SamHaloAt(&s->cell, 0, i + x[n], j + y[n]) == SAM_CELL_SLIP;
    const double    shear = slips ? ShearAt(s, i, j, x[n], y[n]) : 0;

    most = PetscMax(most, shear);
  }
  return most;
}

/* Finds the largest shear of this rank at the edge of stick, where it is reconstructed and where it is not. */
static PetscErrorCode FindAtEdge(SamProblem problem, const SamSolution *solution, const SamEdge *stick, Peak *peak)
{
  const SamElasticity e     = SamProblemGetElasticity(problem);
  const PetscBool     wraps = SamElasticityGetTraits(e).periodic;
  const double        film  = (double)SamPairFilm(SamElasticityGetPair(e));
  const SamGrid       grid  = SamProblemGetGrid(problem);
  Seen                s     = {.grid = grid};
  double             *cell;
  Vec                 cells;

  PetscFunctionBegin;
  PetscCall(SamHaloBegin(grid, solution->pressure, 1, BEHIND + 1, wraps, &s.p));
  PetscCall(SamHaloBegin(grid, solution->bound, 1, 1, wraps, &s.b));
  PetscCall(SamHaloBegin(grid, solution->shear, 2, 1, wraps, &s.q));
  PetscCall(SamGridCreateVec(grid, 1, &cells));
  PetscCall(SamSolutionComputeStates(solution, cells));
  PetscCall(VecGetArray(cells, &cell));
  FindAtPoints(&s, stick, cell, peak);
  PetscCall(VecRestoreArray(cells, &cell));
  PetscCall(SamHaloBegin(grid, cells, 1, 1, wraps, &s.cell));
  for (PetscInt k = 0; k < grid->cells && !(film > 0); k++) {
    const PetscInt i = k % grid->nx, j = grid->row_start + k / grid->nx;

    if (s.cell.own[k] == SAM_CELL_STICK) Raise(peak, ShearBeside(&s, i, j), j * grid->nx + i);
  }
  PetscCall(SamHaloEnd(&s.cell));
  PetscCall(VecDestroy(&cells));
  PetscCall(SamHaloEnd(&s.q));
  PetscCall(SamHaloEnd(&s.b));
  PetscCall(SamHaloEnd(&s.p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the largest shear of any rank that of all; of cells with the same the first one counts. */
static PetscErrorCode Agree(SamGrid grid, Peak *peak)
{
  double most = peak->shear, first;

  PetscFunctionBegin;
  PetscCall(SamMax(grid->comm, 1, &most));
  first = peak->shear == most ? -(double)peak->cell : -INFINITY;
  PetscCall(SamMax(grid->comm, 1, &first));
  *peak = (Peak){most, (PetscInt)-first};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns this rank's place of a cell of the grid; -1: it is another rank's. */
static PetscInt PlaceOf(SamGrid grid, PetscInt cell)
{
  const PetscInt k = cell - grid->row_start * grid->nx;

  return cell >= 0 && k >= 0 && k < grid->cells ? k : -1;
}

/* Returns the shear of a kept peak if this rank has its cell, and it sticks; else 0. */
static double ShearOfKept(SamGrid grid, const SamValues *v, const Kept *kept)
{
  const PetscInt k = PlaceOf(grid, (PetscInt)kept->cell - 1), l = k + v->cells;
  const double  *q = v->q;

  if (k < 0 || SamCellStateOf(v->p[k], q[k], q[l], v->b[k]) != SAM_CELL_STICK) return 0;
  return PetscMin(hypot(q[k] + kept->above[0], q[l] + kept->above[1]), kept->bound * v->b[k]);
}

/* Describes a peak beside a cell, on all ranks. */
static PetscErrorCode Keep(SamGrid grid, const SamValues *v, const Peak *peak, Kept *kept)
{
  const PetscInt k         = PlaceOf(grid, peak->cell);
  SamTotal       totals[3] = {{0}};
  double         found[3]  = {0};

  PetscFunctionBegin;
  if (k >= 0) {
    const double q[2] = {v->q[k], v->q[k + v->cells]}, size = hypot(q[0], q[1]);

    for (int c = 0; c < 2; c++) found[c] = size > 0 ? q[c] / size * (peak->shear - size) : 0;
    found[2] = peak->shear / v->b[k];
  }
  SamAddAll(3, totals, found);
  PetscCall(SamSumTotals(grid->comm, 3, totals, found));
  *kept = (Kept){(double)peak->cell + 1, {found[0], found[1]}, found[2]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionFindShear(SamProblem problem, SamState state, const SamSolution *solution,
                                    const SamEdge *stick, double *most)
{
  const PetscInt  id    = SamStateFindNumber(state, kept_peak.name);
  const SamGrid   grid  = SamProblemGetGrid(problem);
  const PetscBool moves = SamMotionOf(SamProblemGetElasticity(problem))->streams || solution->rolled != 0;
  Kept *const     kept  = (Kept *)SamStateNumbers(state, id, SAM_TRIED);
  Peak            peak  = {*most, -1};
  double          shear;
  SamValues       values;

  PetscFunctionBegin;
  memcpy(kept, SamStateNumbers(state, id, SAM_COMMITTED), sizeof(*kept));
  if (moves) kept->cell = 0;
  if (!stick && kept->cell == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (stick) PetscCall(FindAtEdge(problem, solution, stick, &peak));
  PetscCall(Agree(grid, &peak));
  PetscCall(SamValuesGet(solution, &values));
  shear = ShearOfKept(grid, &values, kept);
  PetscCall(SamMax(grid->comm, 1, &shear));
  if (shear == 0) kept->cell = 0;
  if (peak.shear >= shear && peak.cell >= 0 && !moves) PetscCall(Keep(grid, &values, &peak, kept));
  *most = PetscMax(peak.shear, shear);
  PetscCall(SamValuesRestore(solution, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

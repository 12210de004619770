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
*/
#include <petsam/private/bodyimpl.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/problem.h>

#define BEHIND   2     /* cells about a point of the reconstructed edge that must be in contact */
#define FARTHEST 0.825 /* in cells: an edge farther away belongs to the next cell */

/* Fields of a solution with halos; `cell`: state of each cell, or KNOWN where the stick edge is reconstructed */
#define KNOWN (-1)
typedef struct {
  SamGrid grid;
  SamHalo p, b, q, cell;
} Seen;

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
static void FindAtPoints(const Seen *s, const SamEdge *stick, double cell[], double *most)
{
  const double *b = s->b.own;

  for (PetscInt n = 0; n < stick->count; n++) {
    const PetscInt k = stick->cell[n], i = k % s->grid->nx, j = s->grid->row_start + k / s->grid->nx;
    /* coordinates from the grid's first row, since sums from the rank's first row would round differently */
    const double x = (double)((stick->x[n] - SamGridX(s->grid, 0)) / s->grid->dx),
                 y = (double)((stick->y[n] - SamGridY(s->grid, 0)) / s->grid->dy);
    double shear   = 0;

    if (!IsInside(&s->p, i, j)) continue;
    cell[k] = KNOWN;
    shear   = b[k] / s->p.own[k] * sqrt(SquareAt(&s->p, x, y));
    *most   = PetscMax(*most, shear);
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

/* Creates a field of the cells' states, by which neighbours are known without their fields. */
static PetscErrorCode CreateCells(const Seen *s, const SamEdge *stick, const double q[], Vec *cells, double *most)
{
  double *cell;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 1, cells));
  PetscCall(VecGetArrayWrite(*cells, &cell));
  for (PetscInt k = 0; k < s->grid->cells; k++)
    cell[k] = SamCellStateOf(s->p.own[k], q[k], q[k + s->grid->cells], s->b.own[k]);
  FindAtPoints(s, stick, cell, most);
  PetscCall(VecRestoreArrayWrite(*cells, &cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionFindShear(SamProblem problem, const SamSolution *solution, const SamEdge *stick, double *most)
{
  const SamGrid       grid  = SamProblemGetGrid(problem);
  const SamElasticity e     = SamProblemGetElasticity(problem);
  const PetscBool     wraps = SamElasticityGetTraits(e).periodic;
  const double        film  = (double)SamPairFilm(SamElasticityGetPair(e));
  Seen                s     = {.grid = grid};
  Vec                 cells;

  PetscFunctionBegin;
  PetscCall(SamHaloBegin(grid, solution->pressure, 1, BEHIND + 1, wraps, &s.p));
  PetscCall(SamHaloBegin(grid, solution->bound, 1, 1, wraps, &s.b));
  PetscCall(SamHaloBegin(grid, solution->shear, 2, 1, wraps, &s.q));
  PetscCall(CreateCells(&s, stick, s.q.own, &cells, most));
  PetscCall(SamHaloBegin(grid, cells, 1, 1, wraps, &s.cell));
  for (PetscInt k = 0; k < grid->cells && !(film > 0); k++) {
    const double shear =
      s.cell.own[k] == SAM_CELL_STICK ? ShearBeside(&s, k % grid->nx, grid->row_start + k / grid->nx) : 0;

    *most = PetscMax(*most, shear);
  }
  PetscCall(SamHaloEnd(&s.cell));
  PetscCall(VecDestroy(&cells));
  PetscCall(SamHaloEnd(&s.q));
  PetscCall(SamHaloEnd(&s.b));
  PetscCall(SamHaloEnd(&s.p));
  PetscCall(SamMax(grid->comm, 1, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The motion of the surfaces of dissimilar bodies before they touch.

  The pressure of dissimilar bodies moves their surfaces over each other all the time, also outside of contact. A cell
  that comes into contact within a step slips, or sticks, from the place on where it touches. At the new edge of contact
  cells touch at the end of the step, so that their motion is that of the open cells beside the edge; at the old edge
  they touch at its beginning. Between the edges the motion until a cell k touches is taken as

    s ds(e),   s = (g(k)/g(e))^a,   a = 1 - (0.39 - 0.24 c^2) (N0/N)^(1/2),

  e being the open cell beside the contact that is nearest to k, ds its motion in the step, g the gap before the step,
  N0 and N the normal force before and after it, c the part of the contact that sticks before it. In a step from no
  contact g is the distance of the undeformed bodies, and a is 1. If that distance grows like a power of the distance
  from the first point of contact, whatever the power, and all loads grow in proportion, the problem is similar to
  itself: displacements of points on the edge grow like the gap there, and s is exact. In a short step, in which the
  edge moves at a constant speed, g grows like the power 3/2 of the distance from the old edge. The motion grows like
  that distance, a = 2/3, where cells at the edge slip, and faster where they stick. The rule for a was fitted to
  cylinders that are pressed in 200 or 400 steps on 1528 or 3056 cells: with moduli of 210 and 107.5 GPa, mu = 3, 0.2
  and 0.1, and a rigid one, mu = 0.3. Their a at s = 0.4:

    N0/N          0.05    0.25    0.5     0.75    0.875
    c = 1         0.94    0.89    0.88    0.87    0.87
    c = 0.92      0.94    0.89    0.86    0.83    0.80
    c = 0.49      0.92    0.83    0.79    0.73    0.70
    c = 0.18      0.90    0.80    0.73    0.66    0.61

  What one step cannot know is the slip of cells between touching and sticking: where much of the contact slips, its
  stick zone is too small.

  The motion of the cell k itself in the step tells nothing: where it sticks, it moves by nothing but this very motion.
  The motion of the open cells depends on the shear, and that on the motion: coupling.c finds both together with the
  lift, by one fixed-point iteration. Without acceleration its error shrinks to a third or a half in a pass where most
  cells stick: a sticking zone that is displaced takes its edge with it.

  Instead of the nearest cell e, a mean of those about it is used (edgemean.c): an edge of cells is rough, and the shear
  of cells that stick shows the differences of their motion. Of ds(e) counts what exceeds the motion by the loads alone
  (direction.c), which is exact where all sticks and the pressure does not move the surfaces.

  The iteration needs a mean that is a continuous function of the solution, so a cell must have no weight when it
  touches or is released. In each of four ways out of the contact, from its last cell, of pressure P, to the first open
  one, whose gap after the step is g1, the edge divides their distance h in the parts

    t = P/(P + E* g1/h)   and   1 - t.

  The first open cell has the weight (1 - t) f, the second one t f: their distance from the edge is one cell on average.
  g(e) is (1 - t) and t times the gaps of the two cells beside the edge. f is the cosine between the way and the
  direction in which the pressure falls, (1 - t) and t times its values in these cells: so the weights along an edge are
  proportional to its length, whatever its direction, and the end of a way along it has none. Where the last cell was in
  contact before the step, the edge has not moved by more than t cells, and t f replaces f.

  Algorithm: edgemean.c.

  Reference: D. A. Spence, The Hertz contact problem with finite friction, J. Elasticity 5 (1975) 297-319.
*/
#include "edgemean.h"
#include "stepimpl.h"
#include <math.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/pressed.h>
#include <petsam/private/rows.h>

#define SLIPS  0.39 /* what the power of the gap lacks from 1 in a short step, where the contact slips, */
#define STICKS 0.15 /* and where it sticks */

typedef struct {
  SamGrid    grid;
  double     modulus;   /* E* (Pa) */
  Vec        pressure;  /* after the step */
  Vec        left;      /* gap after the step (m) */
  double     power;     /* of the gap, in proportion to which cells move until they touch */
  PetscBool  wraps;     /* the bodies are periodic */
  Vec        gap;       /* before the step (m) */
  Vec        moved;     /* motion in the step (m) */
  Vec        base;      /* motion until cells touch by the loads alone (direction.c), a part of all (m) */
  PetscBool *beside;    /* true in cells that are points */
  double    *deviation; /* SamSolve.deviation */
} Step;

/* ---- points ---- */

static const PetscInt WAY_X[] = {-1, 1, 0, 0}, WAY_Y[] = {0, 0, -1, 1};

/* The number of cells, 1 or 2, from an open cell to the contact in one of the four ways; 0: it is farther */
static PetscInt DistanceFrom(const SamHalo *p, PetscInt i, PetscInt j, int way)
{
  for (PetscInt n = 1; n <= 2; n++)
    if (SamIsPressed(SamHaloAt(p, 0, i + n * WAY_X[way], j + n * WAY_Y[way]))) return n;
  return 0;
}

/* True if this open cell is beside the contact. */
static PetscBool IsBeside(const SamHalo *p, PetscInt i, PetscInt j)
{
  if (SamIsPressed(SamHaloAt(p, 0, i, j))) return PETSC_FALSE;
  for (int way = 0; way < 4; way++)
    if (DistanceFrom(p, i, j, way)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Makes the products with the tractions known beside the contact; the solvers know them in its rectangle only. */
static PetscErrorCode Cover(SamSolve *w)
{
  static PetscErrorCode (*const apply[])(SamElasticity, Vec, Vec) = {SamElasticityApplyNormal,
                                                                     SamElasticityApplyTangential};

  const SamGrid grid       = w->grid;
  const Vec     traction[] = {w->s->pressure, w->s->shear};
  SamProduct   *product[]  = {&w->pressure_product, &w->shear_product};
  double        most[2][2] = {{-INFINITY, -INFINITY}, {-INFINITY, -INFINITY}}; /* minus the first cell, and the last */
  SamHalo       p;

  PetscFunctionBegin;
  PetscCall(SamHaloBegin(grid, w->s->pressure, 1, 2, w->contact->traits.periodic, &p));
  for (PetscInt j = grid->row_start; j < grid->row_start + grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt at[2] = {i, j};

      if (!IsBeside(&p, i, j)) continue;
      for (int k = 0; k < 2; k++) {
        most[0][k] = PetscMax(most[0][k], -(double)at[k]);
        most[1][k] = PetscMax(most[1][k], (double)at[k]);
      }
    }
  PetscCall(SamHaloEnd(&p));
  PetscCall(SamMax(grid->comm, 4, most[0]));
  for (int t = 0; t < 2; t++) {
    PetscBool outside = PETSC_FALSE;

    for (int k = 0; k < 2; k++)
      if (-most[0][k] < (double)product[t]->first[k] || most[1][k] >= (double)(product[t]->first[k] + product[t]->n[k]))
        outside = PETSC_TRUE;
    if (!outside) continue;
    PetscCall((*apply[t])(w->elasticity, traction[t], product[t]->field));
    *product[t] = (SamProduct){.field = product[t]->field, .n = {grid->nx, grid->ny}};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a point is made of, in this rank's rows and two more on either side */
typedef struct {
  double  power, stiff[2]; /* E* over the distance of cells in x and y (Pa/m) */
  SamHalo p, left, gap, moved, base;
} Surface;

/* The cosine between a way out of a cell and the direction in which the pressure falls there; 0 if it is negative */
static double CosineOf(const Surface *s, PetscInt i, PetscInt j, int way)
{
  const PetscInt x = WAY_X[way], y = WAY_Y[way];
  const double   along  = SamHaloAt(&s->p, 0, i + x, j + y) - SamHaloAt(&s->p, 0, i - x, j - y);
  const double   across = SamHaloAt(&s->p, 0, i + y, j + x) - SamHaloAt(&s->p, 0, i - y, j - x);

  return along > 0 ? along / hypot(along, across) : 0;
}

/* The edge between the last cell in contact and the first open cell in one way from an open cell */
typedef struct {
  double share;   /* weight of the open cell */
  double gap;     /* at the edge, before the step (m) */
  double base[2]; /* motion of points there until they touch, by the loads alone (m) */
} Side;

/* Finds it; returns false if there is none near, or if the first open cell was not open before the step. */
static PetscBool FindSide(const Surface *s, PetscInt i, PetscInt j, int way, Side *side)
{
  const PetscInt x = WAY_X[way], y = WAY_Y[way], n = DistanceFrom(&s->p, i, j, way), m = n - 1;
  const double   p = SamHaloAt(&s->p, 0, i + n * x, j + n * y), was = SamHaloAt(&s->gap, 0, i + n * x, j + n * y);
  const double   gap = SamHaloAt(&s->gap, 0, i + m * x, j + m * y);
  double         open, part;

  if (n == 0 || !(gap > 0)) return PETSC_FALSE;
  open = PetscMax(SamHaloAt(&s->left, 0, i + m * x, j + m * y), 0);
  part = p / (p + s->stiff[x ? 0 : 1] * open);

  side->share = (n == 1 ? 1 - part : part) * (was > 0 ? 1 : part);
  side->share *= (1 - part) * CosineOf(s, i + n * x, j + n * y, way) + part * CosineOf(s, i + m * x, j + m * y, way);
  side->gap = (1 - part) * was + part * gap;
  for (int c = 0; c < 2; c++) side->base[c] = side->gap / gap * SamHaloAt(&s->base, c, i + m * x, j + m * y);
  return PETSC_TRUE;
}

/* Makes the point of an open cell; returns false if no cell beside it touches in the step. */
static PetscBool MakePoint(const Surface *s, PetscInt i, PetscInt j, double point[SAM_EDGE_POINT])
{
  double *const moved  = point + SAM_EDGE_MOVED;
  double        weight = 0;
  PetscBool     beside = PETSC_FALSE;
  Side          side;

  if (SamIsPressed(SamHaloAt(&s->p, 0, i, j))) return PETSC_FALSE;
  moved[0] = moved[1] = 0;
  for (int way = 0; way < 4; way++) {
    if (!FindSide(s, i, j, way, &side)) continue;
    beside = PETSC_TRUE;
    weight += side.share;
    for (int c = 0; c < 2 && side.share > 0; c++)
      moved[c] += side.share * (SamHaloAt(&s->moved, c, i, j) - side.base[c]) / pow(side.gap, s->power);
  }
  for (int c = 0; c < 2 && weight > 0; c++) moved[c] /= weight;
  point[SAM_EDGE_COLUMN] = (double)i;
  point[SAM_EDGE_ROW]    = (double)j;
  point[SAM_EDGE_WEIGHT] = weight;
  return beside;
}

/* Finds this rank's points, by rows. */
static PetscErrorCode FindPoints(Step *step, double **points, PetscInt *count)
{
  const SamGrid grid = step->grid;
  Surface       s    = {.power = step->power, .stiff = {step->modulus / grid->dx, step->modulus / grid->dy}};
  PetscInt      room = 0;
  double        point[SAM_EDGE_POINT];

  PetscFunctionBegin;
  *count  = 0;
  *points = NULL;
  PetscCall(SamHaloBegin(grid, step->pressure, 1, 3, step->wraps, &s.p));
  PetscCall(SamHaloBegin(grid, step->left, 1, 2, step->wraps, &s.left));
  PetscCall(SamHaloBegin(grid, step->gap, 1, 2, step->wraps, &s.gap));
  PetscCall(SamHaloBegin(grid, step->moved, 2, 2, step->wraps, &s.moved));
  PetscCall(SamHaloBegin(grid, step->base, 2, 2, step->wraps, &s.base));
  for (PetscInt j = grid->row_start; j < grid->row_start + grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      if (!MakePoint(&s, i, j, point)) continue;
      if (*count == room) {
        room = PetscMax(256, 2 * room);
        PetscCall(PetscRealloc(sizeof(double) * SAM_EDGE_POINT * (size_t)room, points));
      }
      PetscCall(PetscArraycpy(*points + SAM_EDGE_POINT * (ptrdiff_t)(*count)++, point, SAM_EDGE_POINT));
      step->beside[(ptrdiff_t)(j - grid->row_start) * grid->nx + i] = PETSC_TRUE;
    }
  PetscCall(SamHaloEnd(&s.base));
  PetscCall(SamHaloEnd(&s.moved));
  PetscCall(SamHaloEnd(&s.gap));
  PetscCall(SamHaloEnd(&s.left));
  PetscCall(SamHaloEnd(&s.p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the motion of the cells that touch in the step or are beside them, from that of the edge. */
static PetscErrorCode Move(Step *step, Vec motion)
{
  const SamGrid grid = step->grid;
  const double *p, *g;
  double       *to, *own;
  PetscInt      count;
  SamEdgeMean   edge;

  PetscFunctionBegin;
  PetscCall(FindPoints(step, &own, &count));
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(SamEdgeMeanCreate(grid, step->wraps, p, count, own, step->deviation, &edge));
  PetscCall(VecGetArrayRead(step->gap, &g));
  PetscCall(VecGetArray(motion, &to));
  for (PetscInt j = 0; j < grid->rows; j++) {
    SamEdgeMeanSetRow(edge, grid->row_start + j);
    for (PetscInt i = 0; i < grid->nx; i++) {
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + i;
      double          mean[2];

      if (!(g[k] > 0) || !(SamIsPressed(p[k]) || step->beside[k])) continue;
      SamEdgeMeanAt(edge, i, mean);
      for (int c = 0; c < 2; c++) to[k + c * (ptrdiff_t)grid->cells] = pow(g[k], step->power) * mean[c];
    }
  }
  PetscCall(VecRestoreArray(motion, &to));
  PetscCall(VecRestoreArrayRead(step->gap, &g));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(SamEdgeMeanDestroy(&edge));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the motion of all cells in the step. */
static PetscErrorCode FindMoved(SamSolve *w, Vec moved)
{
  const SamGrid grid = w->grid;
  SamIncrement  increment;
  const double *aside;
  double       *to;

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(w->contact->problem, w->before, w->s, &increment));
  aside           = increment.aside;
  increment.aside = NULL; /* for the whole motion of cells that touch, too */
  PetscCall(VecGetArrayWrite(moved, &to));
  for (PetscInt j = 0; j < grid->rows; j++) {
    SamIncrementComputeRow(&increment, j);
    for (int c = 0; c < 2; c++)
      PetscCall(PetscArraycpy(to + c * (ptrdiff_t)grid->cells + (ptrdiff_t)j * grid->nx, increment.row[c], grid->nx));
  }
  PetscCall(VecRestoreArrayWrite(moved, &to));
  increment.aside = aside;
  PetscCall(SamIncrementDestroy(&increment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveBeginTouching(SamSolve *w)
{
  const SamSolution *before  = w->before;
  const PetscInt     cells   = w->grid->cells;
  double             sums[2] = {0}; /* cells in contact before the step, and those of them that stick */
  const double      *p, *q, *b;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(w->grid, 2, &w->touching));
  w->stuck = 1;
  if (!before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(before->pressure, &p));
  PetscCall(VecGetArrayRead(before->shear, &q));
  PetscCall(VecGetArrayRead(before->bound, &b));
  for (PetscInt k = 0; k < cells; k++) {
    const SamCellState state = SamCellStateOf(p[k], q[k], q[k + cells], b[k]);

    sums[0] += state == SAM_CELL_OPEN ? 0 : 1;
    sums[1] += state == SAM_CELL_STICK ? 1 : 0;
  }
  PetscCall(VecRestoreArrayRead(before->bound, &b));
  PetscCall(VecRestoreArrayRead(before->shear, &q));
  PetscCall(VecRestoreArrayRead(before->pressure, &p));
  PetscCall(SamSum(w->grid->comm, 2, sums));
  if (sums[0] > 0) w->stuck = sums[1] / sums[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the power of the gap, in proportion to which cells move until they touch (top of this file). */
static double PowerOf(const SamSolve *w)
{
  const double before = w->before ? (double)SamSolutionGetNormal(w->before) : 0;
  const double share  = before > 0 ? PetscMin(before / (double)SamSolutionGetNormal(w->s), 1) : 0;

  return 1 - (SLIPS - (SLIPS - STICKS) * w->stuck * w->stuck) * sqrt(share);
}

PetscErrorCode SamSolveFindTouching(SamSolve *w, Vec motion)
{
  Step step = {.grid      = w->grid,
               .modulus   = SamElasticityGetModulus(w->elasticity),
               .pressure  = w->s->pressure,
               .power     = PowerOf(w),
               .deviation = &w->deviation,
               .wraps     = w->contact->traits.periodic};

  PetscFunctionBegin;
  PetscCall(SamVecZero(motion));
  PetscCall(SamGridCreateVec(step.grid, 1, &step.gap));
  PetscCall(SamGridCreateVec(step.grid, 1, &step.left));
  PetscCall(SamGridCreateVec(step.grid, 2, &step.moved));
  PetscCall(SamGridCreateVec(step.grid, 2, &step.base));
  PetscCall(PetscCalloc1(step.grid->cells, &step.beside));
  PetscCall(Cover(w));
  PetscCall(VecWAXPY(step.gap, 1, w->lift, w->pressure_product.field)); /* the pressure is solved with this lift */
  PetscCall(SamSolutionComputeGap(w->contact->problem, w->s, step.gap, w->separation, step.left));
  PetscCall(SamSolveFindGaps(w, step.gap));
  PetscCall(SamSolveDisplace(w));
  PetscCall(FindMoved(w, step.moved));
  PetscCall(SamSolveAddEntering(w, PETSC_TRUE, PETSC_TRUE, step.base));
  PetscCall(Move(&step, motion));
  PetscCall(PetscFree(step.beside));
  PetscCall(VecDestroy(&step.base));
  PetscCall(VecDestroy(&step.moved));
  PetscCall(VecDestroy(&step.left));
  PetscCall(VecDestroy(&step.gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveEndTouching(SamSolve *w)
{
  const PetscInt cells = w->grid->cells;
  const double  *p, *m;
  double        *aside;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(w->s->pressure, &p));
  PetscCall(VecGetArrayRead(w->touching, &m));
  PetscCall(VecGetArray(w->s->aside, &aside));
  for (PetscInt k = 0; k < 2 * cells; k++) aside[k] -= SamIsPressed(p[k % cells]) ? 0 : m[k];
  PetscCall(VecRestoreArray(w->s->aside, &aside));
  PetscCall(VecRestoreArrayRead(w->touching, &m));
  PetscCall(VecRestoreArrayRead(w->s->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

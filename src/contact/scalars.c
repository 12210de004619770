/* The numbers of a step that follow from its solution: cells and areas, energies. */
#include "contactimpl.h"
#include <petsam/private/rows.h>
#include <math.h>

/*
  Cells in contact and in stick, largest tractions and slip there, the elastic energy of both bodies, half the work of
  the tractions on the displacements, and the frictional work of this step, -sum q.(s - s_before) dA. Where a cell slips
  while its pressure changes, its shear follows the bound: the mean of the bounds before and after makes the sum over
  steps second order. Before the first step there is no bound; its pressure counts as there before its slip.
*/
enum { CONTACT, STICK, DISSIPATED, STORED, SUMS };
enum { PRESSURE, SHEAR, SLIP, MOSTS }; /* of the last two the squares */

/* The fields of the step's solution, and the bound before it; `rim`, NULL: none, of cells whose centres are outside. */
typedef struct {
  const double *p, *b, *b_before, *q, *u_z, *u_t, *rim;
} Fields;

static void SumRow(const Fields *f, const SamIncrement *increment, ptrdiff_t first, double sums[SUMS],
                   double most[MOSTS])
{
  const PetscInt nx = increment->grid->nx, cells = increment->grid->cells;
  const double  *p = f->p, *b = f->b, *q = f->q, *sx = increment->slip[0], *sy = increment->slip[1];

  for (PetscInt i = 0; i < nx; i++) {
    const ptrdiff_t k = first + i, l = k + cells;
    const SamState  state = SamStateOf(p[k], q[k], q[l], b[k]);

    if (state == SAM_STATE_OPEN) continue;
    most[PRESSURE] = PetscMax(most[PRESSURE], p[k]);
    most[SHEAR]    = PetscMax(most[SHEAR], q[k] * q[k] + q[l] * q[l]);
    if (!f->rim || p[k] > f->rim[k]) most[SLIP] = PetscMax(most[SLIP], sx[i] * sx[i] + sy[i] * sy[i]);
    sums[CONTACT] += 1;
    sums[STICK] += state == SAM_STATE_STICK ? 1 : 0;
    sums[STORED] += 0.5 * (p[k] * f->u_z[k] + q[k] * f->u_t[k] + q[l] * f->u_t[l]);
    sums[DISSIPATED] -= (q[k] * increment->row[0][i] + q[l] * increment->row[1][i]) *
                        (state == SAM_STATE_SLIP && b[k] > 0 ? 0.5 * (f->b_before[k] + b[k]) / b[k] : 1);
  }
}

static PetscErrorCode SumCells(SamContact c, const SamSolution *s, const SamSolution *last, SamStep *step)
{
  const double area         = c->grid->dx * c->grid->dy;
  SamTotal     totals[SUMS] = {{0}};
  double       sums[SUMS], most[MOSTS] = {0};
  SamIncrement increment;
  Fields       f      = {.rim = NULL};
  const Vec    before = last ? last->bound : s->bound;

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(c->problem, last, s, &increment));
  PetscCall(VecGetArrayRead(s->pressure, &f.p));
  PetscCall(VecGetArrayRead(s->bound, &f.b));
  PetscCall(VecGetArrayRead(before, &f.b_before));
  PetscCall(VecGetArrayRead(s->shear, &f.q));
  PetscCall(VecGetArrayRead(s->displacement_z, &f.u_z));
  PetscCall(VecGetArrayRead(s->displacement_t, &f.u_t));
  if (s->passes) PetscCall(VecGetArrayRead(s->rim, &f.rim));
  for (PetscInt j = 0; j < c->grid->rows; j++) {
    double row[SUMS] = {0};

    SamIncrementComputeRow(&increment, j);
    SumRow(&f, &increment, (ptrdiff_t)j * c->grid->nx, row, most);
    SamAddAll(SUMS, totals, row);
  }
  if (s->passes) PetscCall(VecRestoreArrayRead(s->rim, &f.rim));
  PetscCall(VecRestoreArrayRead(s->displacement_t, &f.u_t));
  PetscCall(VecRestoreArrayRead(s->displacement_z, &f.u_z));
  PetscCall(VecRestoreArrayRead(s->shear, &f.q));
  PetscCall(VecRestoreArrayRead(before, &f.b_before));
  PetscCall(VecRestoreArrayRead(s->bound, &f.b));
  PetscCall(VecRestoreArrayRead(s->pressure, &f.p));
  PetscCall(SamIncrementDestroy(&increment));
  PetscCall(SamSumTotals(c->grid->comm, SUMS, totals, sums));
  PetscCall(SamMax(c->grid->comm, MOSTS, most));
  step->pressure_max      = most[PRESSURE];
  step->shear_max         = sqrt(most[SHEAR]);
  step->slip_max          = sqrt(most[SLIP]);
  step->contact_cells     = (PetscInt)sums[CONTACT];
  step->stick_cells       = (PetscInt)sums[STICK];
  step->contact_area      = sums[CONTACT] * area;
  step->stick_area        = sums[STICK] * area;
  step->dissipated_energy = sums[DISSIPATED] * area;
  step->stored_energy     = sums[STORED] * area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- edges ---- */

#define BEHIND 2 /* cells about a point of the stick edge that must be in contact */

/* Whether cell i of row j of the grid and those about it are in contact: the edge of contact is farther. */
static PetscBool IsInside(const SamSeen *p, PetscInt i, PetscInt j)
{
  for (PetscInt b = j - BEHIND; b <= j + BEHIND; b++)
    for (PetscInt a = i - BEHIND; a <= i + BEHIND; a++)
      if (a < 0 || a >= p->rows.grid->nx || b < p->rows.first || b >= p->rows.first + p->rows.count ||
          !(p->at[0][(ptrdiff_t)(b - p->rows.first) * p->rows.grid->nx + a] > 0))
        return PETSC_FALSE;
  return PETSC_TRUE;
}

/* p^2 at (x, y), in cells from the grid's first one, interpolated between the four cells about it. */
static double SquareAt(const SamSeen *p, double x, double y)
{
  const PetscInt nx = p->rows.grid->nx, i = (PetscInt)floor(x), j = (PetscInt)floor(y);
  const double   tx = x - (double)i, ty = y - (double)j, *q = p->at[0] + (ptrdiff_t)(j - p->rows.first) * nx + i;

  return (1 - ty) * ((1 - tx) * q[0] * q[0] + tx * q[1] * q[1]) +
         ty * ((1 - tx) * q[nx] * q[nx] + tx * q[nx + 1] * q[nx + 1]);
}

/*
  The largest shear at the edge of the stick zone, where it is mu p: larger than that of any cell, which is a mean. The
  pressure is interpolated in p^2, which is smooth up to the contact's edge. Where that edge is near, its profile tells
  the pressure, of a solution that is corrected; else cells count only, as what slips there is not resolved.
*/
static PetscErrorCode FindPeak(SamContact c, SamProfile profile, const SamEdge *stick, double *peak)
{
  const SamGrid grid = c->grid;
  const double *b;
  SamSeen       p;

  PetscFunctionBegin;
  PetscCall(SamSee(grid, c->tried.solution.pressure, 1, BEHIND + 1, &p));
  PetscCall(VecGetArrayRead(c->tried.solution.bound, &b));
  for (PetscInt n = 0; n < stick->count; n++) {
    const PetscInt k = stick->cell[n];
    /* counted from the grid's first row and not from the rank's, whose sums would round otherwise */
    const double x = (double)((stick->x[n] - SamGridX(grid, 0)) / grid->dx),
                 y = (double)((stick->y[n] - SamGridY(grid, 0)) / grid->dy);

    const PetscInt i = k % grid->nx, j = grid->row_start + k / grid->nx;

    if (IsInside(&p, i, j))
      *peak = PetscMax(*peak, b[k] / p.own[k] * sqrt(SquareAt(&p, x, y)));
    else if (profile && p.own[k] > 0)
      *peak = PetscMax(*peak, b[k] / p.own[k] * SamProfileRootAt(profile, i, j, x - (double)i, y - (double)j));
  }
  PetscCall(VecRestoreArrayRead(c->tried.solution.bound, &b));
  PetscCall(SamForget(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The areas by the edges of contact and stick, and the peak of the shear between stick and slip. */
static PetscErrorCode FindEdges(SamContact c, SamStep *step)
{
  SamProfile profile = NULL;
  SamEdge    edge[2];
  double     peak = (double)step->shear_max;

  PetscFunctionBegin;
  PetscCall(SamContactFindEdge(c, SAM_CONTACT_EDGE_CONTACT, NULL, &edge[0]));
  PetscCall(SamContactFindEdge(c, SAM_CONTACT_EDGE_STICK, NULL, &edge[1]));
  /* that of the pressure, which the first call has set */
  if (c->tried.solution.sheared.has && c->tried.solution.sheared.passes) PetscCall(SamContactGetProfile(c, &profile));
  PetscCall(FindPeak(c, profile, &edge[1], &peak));
  PetscCall(SamMax(c->grid->comm, 1, &peak));
  step->shear_max    = peak;
  step->contact_area = edge[0].area;
  step->stick_area   = edge[1].area;
  step->edge_accepted =
    edge[0].faces + edge[1].faces > 0 ? (edge[0].good + edge[1].good) / (edge[0].faces + edge[1].faces) : 1;
  for (PetscInt k = 0; k < 2; k++) PetscCall(SamEdgeDestroy(&edge[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energies of a step whose shear is corrected: of its plain solution (deferredshear.c). */
static PetscErrorCode SumPlainEnergies(SamContact c, SamStep *step)
{
  SamSolution *plain = &c->tried.plain;
  SamStep      sums;

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateDisplacements(c->grid, plain));
  PetscCall(SamElasticityApplyNormal(c->elasticity, plain->pressure, plain->displacement_z));
  PetscCall(SamElasticityApplyTangential(c->elasticity, plain->shear, plain->displacement_t));
  PetscCall(SumCells(c, plain, SamContactPlainBefore(c), &sums));
  step->dissipated_energy = sums.dissipated_energy;
  step->stored_energy     = sums.stored_energy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactComputeScalars(SamContact c, SamStep *step)
{
  PetscFunctionBegin;
  PetscCall(SumCells(c, &c->tried.solution, SamContactBefore(c), step));
  if (c->tried.solution.sheared.has)
    PetscCall(SumPlainEnergies(c, step));
  else if (c->tried.solution.passes)
    PetscCall(SamContactAddEnergyWithin(c, step));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  step->edge_accepted = 0;
  if (c->edges != SAM_CONTACT_EDGES_NONE) PetscCall(FindEdges(c, step));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  step->contact_fraction = step->contact_area / (c->grid->width[0] * c->grid->width[1]);
  if (c->spots) PetscCall(SamContactCountSpots(c, &step->spots));
  if (c->spots) PetscCall(SamContactMeanGap(c, &step->gap_mean));
  PetscFunctionReturn(PETSC_SUCCESS);
}

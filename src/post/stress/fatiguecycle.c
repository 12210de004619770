/*
  Fatigue parameters from the stresses of all chosen steps, which are one closed cycle; or, for points that travel along
  x under a single step, from the stresses of a row: these, with zero stress far away, are the cycle of the row's
  points.
*/
#include "evaluationimpl.h"
#include <petsam/private/body.h>

#define BLOCK 256 /* number of points between two checks of the clock */
#define MOST  4   /* components of a quantity: its value, and the normal of its plane */

/* The states at one point, and the arrays that are computed from them */
typedef struct {
  SamEvaluation    e;
  const SamPoints *points;
  PetscInt         surface; /* number of points on the surface, which come first */
  double          *slips;   /* of the surface points: (states, 2, surface) */
  double          *stress, *slip;
  SamFatigueCycle  at;
} Cycle;

/* ---- slip on the surface ---- */

/* Gathers a field's values in the section's line of cells, on all ranks. */
static PetscErrorCode GatherLine(SamEvaluation e, const double field[], PetscInt length, double line[])
{
  const SamGrid g = e->grid;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(line, length));
  for (PetscInt k = 0; k < length; k++) {
    const PetscBool row = e->axis == SAM_SECTION_X;
    const PetscInt  j = (row ? e->index : k) - g->row_start, i = row ? k : e->index;

    if (j >= 0 && j < g->rows) line[k] = field[j * g->nx + i];
  }
  /* Only one term of each value is not zero. */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, line, (PetscMPIInt)length, MPI_DOUBLE, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Reads the slip on the surface of each state since the one before, in the order of Cycle.slips; `length`: cells of a
  map or of the line. Sums of slip are stored at the cells, under which other points of body 2 were before.
*/
static PetscErrorCode ReadSlip(SamEvaluation e, PetscInt length, double slip[])
{
  const PetscInt cells = e->grid->cells;
  double        *since, *sum;

  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(double) * (size_t)(2 * cells), &since));
  sum = since + cells;
  for (PetscInt c = 0; c < 2; c++) {
    const char *const field = c ? "slip_y" : "slip_x";

    PetscCall((*e->source.read)(e->source.context, e->source.steps - 1, field, sum));
    for (PetscInt s = 0; s < e->source.steps; s++) {
      double *const to = slip + (2 * s + c) * (ptrdiff_t)length;

      PetscCall(PetscArraycpy(since, sum, cells));
      PetscCall((*e->source.read)(e->source.context, s, field, sum));
      for (PetscInt k = 0; k < cells; k++) since[k] = sum[k] - since[k];
      PetscCall(SamPointsMove(e, s, since));
      if (e->section)
        PetscCall(GatherLine(e, since, length, to));
      else
        PetscCall(PetscArraycpy(to, since, cells));
    }
  }
  SamFree(since);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- points ---- */

static void GatherStates(const Cycle *c, PetscInt point)
{
  const PetscInt states = c->at.states, n = c->points->count;

  for (PetscInt s = 0; s < states; s++)
    for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++)
      c->stress[k * states + s] = c->points->stress[(s * SAM_STRESS_COMPONENTS + k) * (ptrdiff_t)n + point];
  for (PetscInt k = 0; c->slips && point < c->surface && k < 2 * states; k++)
    c->slip[k % 2 * states + k / 2] = c->slips[k * (ptrdiff_t)c->surface + point];
}

/* Gathers the stress path of a point that travels along its row, whose first point is `point`: the row's stresses and
   those far away. */
static void GatherPassing(const Cycle *c, PetscInt point)
{
  const PetscInt states = c->at.states, nx = states - 1, n = c->points->count;
  double         far[SAM_STRESS_COMPONENTS];

  SamStressPartsUniform(c->e->parts, 0, c->e->depth[c->points->depth + point / c->points->plane], far);
  for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++) {
    for (PetscInt i = 0; i < nx; i++) /* no parameter depends on the direction along the row */
      c->stress[k * states + i] = c->points->stress[k * (ptrdiff_t)n + point + i];
    c->stress[k * states + nx] = far[k];
  }
}

/* Computes a quantity's components at a point, into value[component * count + point]. */
static void ComputePoint(Cycle *c, PetscInt quantity, PetscInt i, double values[])
{
  const SamEvaluation e = c->e;
  const SamQuantity  *q = &SamQuantityTable[quantity];
  const PetscInt      n = c->points->count, depth = c->points->depth + i / c->points->plane;
  const SamBodyPlace  place                     = SamBodyAt(SamEvaluationBody(e), e->depth[depth]);
  SamFatigueConstants constants                 = e->constants[e->materials > 1 ? place.number : 0];
  double              value[SAM_QUANTITY_PARTS] = {0};

  (e->passing ? GatherPassing : GatherStates)(c, i);
  constants.young   = place.young;
  constants.poisson = place.poisson;
  c->at.constants   = &constants;
  c->at.slip        = i < c->surface ? c->slip : NULL;
  value[0]          = (*q->of_cycle)(&c->at, value + 1);
  for (PetscInt k = 0; k < SAM_QUANTITY_PARTS && q->part[k].name; k++) values[k * (ptrdiff_t)n + i] = value[k];
  SamLargestOfCycle(e, quantity, c->points, i, value[0]);
}

/* Computes the quantity at all points; points that travel along the same row have the same stress path. */
static PetscErrorCode ComputeAll(Cycle *c, PetscInt quantity, double values[], double done, double share)
{
  const PetscInt n = c->points->count, length = c->e->passing ? c->e->grid->nx : 1;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    if (i % length == 0) ComputePoint(c, quantity, i, values);
    for (PetscInt k = 0; i % length > 0 && k < SAM_QUANTITY_PARTS && SamQuantityTable[quantity].part[k].name; k++)
      values[k * (ptrdiff_t)n + i] = values[k * (ptrdiff_t)n + i - 1];
    if (i % BLOCK == BLOCK - 1)
      PetscCall(SamEvaluationTell(c->e, "fatigue parameters", done + share * (double)(i + 1) / (double)n, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamEvaluation e, const SamPoints *p, Cycle *c)
{
  const PetscInt length = !e->section ? p->count : e->axis == SAM_SECTION_X ? e->grid->nx : e->grid->ny;
  const PetscInt states = e->passing ? e->grid->nx + 1 : e->source.steps;

  PetscFunctionBegin;
  /* Ruiz's parameters need the first depth to be the surface. */
  *c = (Cycle){.e = e, .points = p, .surface = p->depth == 0 && p->depths > 0 ? length : 0};
  if (SamQuantityWanted(e, SamFatigueRuiz) && (e->section || p->depth == 0)) { /* collective */
    PetscCall(SamAllocate(sizeof(double) * (size_t)(2 * states) * (size_t)length, &c->slips));
    PetscCall(ReadSlip(e, length, c->slips));
  }
  PetscCall(PetscMalloc3(SAM_STRESS_COMPONENTS * states, &c->stress, 2 * states, &c->slip, SAM_FATIGUE_SCRATCH * states,
                         &c->at.scratch));
  c->at.states = states;
  c->at.stress = c->stress;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCycleWrite(SamEvaluation e, const SamPoints *p, double done, double share)
{
  PetscInt wanted = 0, before = 0;
  double  *values;
  Cycle    c;

  PetscFunctionBegin;
  for (PetscInt q = 0; SamQuantityTable[q].name; q++) wanted += SamQuantityTable[q].of_cycle && e->wants[q];
  PetscCall(Create(e, p, &c));
  PetscCall(SamAllocate(sizeof(double) * MOST * (size_t)p->count, &values));
  for (PetscInt q = 0; SamQuantityTable[q].name; q++) {
    if (!SamQuantityTable[q].of_cycle || !e->wants[q]) continue;
    PetscCall(ComputeAll(&c, q, values, done + share * (double)before++ / (double)wanted, share / (double)wanted));
    for (PetscInt k = 0; k < SAM_QUANTITY_PARTS && SamQuantityTable[q].part[k].name; k++)
      PetscCall(SamEvaluationHandOver(e, q, k, 0, p, values + k * (ptrdiff_t)p->count));
  }
  SamFree(values);
  SamFree(c.slips);
  PetscCall(PetscFree3(c.stress, c.slip, c.at.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

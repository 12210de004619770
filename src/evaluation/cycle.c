/*
  Fatigue parameters of the chosen steps, taken as one closed cycle, from the stresses of all of them; or of points that
  pass along x under one step, in whose time x stands: a row's stresses, and none far away, are the cycle of its points.
*/
#include "evaluationimpl.h"

#define BLOCK 256 /* points between two looks at the clock */

/* The states at one point, and what is made of them. */
typedef struct {
  SamEvaluation    e;
  const SamPoints *points;
  PetscInt         states;
  PetscInt         surface;               /* points on the surface, the first ones */
  const double    *slip;                  /* of these: (states, 2, surface) */
  double          *stress, *shear, *path; /* of a point: [component][state] */
} Cycle;

PetscBool SamCycleWanted(SamEvaluation e)
{
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++)
    if (e->wants[q]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* ---- slip on the surface ---- */

/* A field's values in the section's line of cells, on all ranks. */
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
  /* of each value all terms but one are zero */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, line, (PetscMPIInt)length, MPI_DOUBLE, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slip of all states on the surface, in the order of Cycle.slip; `length`: cells of a map's rows or of the line. */
static PetscErrorCode ReadSlip(SamEvaluation e, PetscInt length, double slip[])
{
  double *field;

  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(double) * (size_t)e->grid->cells, &field));
  for (PetscInt s = 0; s < e->source.steps; s++)
    for (PetscInt c = 0; c < 2; c++) {
      double *const to = slip + (2 * s + c) * (ptrdiff_t)length;

      PetscCall((*e->source.read)(e->source.context, s, (SamStepField)(SAM_STEP_SLIP_X + c), e->section ? field : to));
      if (e->section) PetscCall(GatherLine(e, field, length, to));
    }
  SamFree(field);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- points ---- */

static void GatherStress(const Cycle *c, PetscInt point)
{
  const PetscInt states = c->states, n = c->points->count;

  for (PetscInt s = 0; s < states; s++)
    for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++)
      c->stress[k * states + s] = c->points->stress[(s * SAM_STRESS_COMPONENTS + k) * (ptrdiff_t)n + point];
}

/* Those of a point that passes all cells of its row, of which `point` is the first, and of none of them far away. */
static void GatherPassing(const Cycle *c, PetscInt point)
{
  const PetscInt states = c->states, nx = states - 1, n = c->points->count;

  double          far[SAM_STRESS_COMPONENTS] = {0};
  const SamPoints there = {.count = 1, .depth = c->points->depth + point / (n / c->points->depths), .depths = 1};

  SamStressAddBulk(c->e, 0, &there, far);
  for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++) {
    for (PetscInt i = 0; i < nx; i++) /* no parameter depends on which end comes first */
      c->stress[k * states + i] = c->points->stress[k * (ptrdiff_t)n + point + i];
    c->stress[k * states + nx] = far[k];
  }
}

#define MOST 4 /* components of a quantity: the value, and the normal of its plane */

/* Ruiz's parameters exist on the surface only. There the stress is the shear but for the sign, which does not count. */
static void ComputeRuiz(const Cycle *c, PetscInt point, double value[2])
{
  const PetscInt states = c->e->source.steps;

  value[0] = value[1] = NAN;
  if (point >= c->surface) return;
  for (PetscInt s = 0; s < states; s++)
    for (PetscInt k = 0; k < 2; k++) {
      c->shear[k * states + s] = c->stress[(k ? SAM_STRESS_YZ : SAM_STRESS_XZ) * states + s];
      c->path[k * states + s]  = c->slip[(2 * s + k) * (ptrdiff_t)c->surface + point];
    }
  SamFatigueRuiz(states, c->stress, c->shear, c->path, &value[0], &value[1]);
}

/* Computes a quantity's components at a point, into value[component * count + point]. */
static PetscErrorCode ComputePoint(SamEvaluation e, const Cycle *c, SamQuantity quantity, PetscInt i, double values[])
{
  const PetscInt      n = c->points->count, depth = c->points->depth + i / (n / c->points->depths);
  PetscInt            material;
  SamFatigueConstants constants;
  double              value[MOST] = {0, 0, 0, 0};

  PetscFunctionBegin;
  (e->passing ? GatherPassing : GatherStress)(c, i);
  (void)SamLayerAt(e, depth, &material);
  constants = e->constants[e->materials > 1 ? material : 0];
  SamStressGetConstants(e->stress, e->depth[depth], &constants.young, &constants.poisson);
  if (quantity == SAM_QUANTITY_RUIZ)
    ComputeRuiz(c, i, value);
  else
    PetscCall(SamFatigueCompute((SamFatigueParameter)(quantity - SAM_QUANTITY_CROSSLAND), &constants, c->states,
                                c->stress, &value[0], &value[1]));
  for (PetscInt k = 0; k < SamQuantityComponents(quantity); k++) values[k * (ptrdiff_t)n + i] = value[k];
  if (!isnan(value[0])) SamLargestKeep(&e->fatigue[quantity], value[0], c->points->first + (double)i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same at all points; those of a row pass all through the same. */
static PetscErrorCode ComputeAll(SamEvaluation e, const Cycle *c, SamQuantity quantity, double values[], double done,
                                 double share)
{
  const PetscInt n = c->points->count;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    if (!e->passing || i % e->grid->nx == 0) PetscCall(ComputePoint(e, c, quantity, i, values));
    for (PetscInt k = 0; e->passing && i % e->grid->nx > 0 && k < SamQuantityComponents(quantity); k++)
      values[k * (ptrdiff_t)n + i] = values[k * (ptrdiff_t)n + i - 1];
    if (i % BLOCK == BLOCK - 1)
      PetscCall(SamEvaluationTell(e, "fatigue parameters", done + share * (double)(i + 1) / (double)n, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamEvaluation e, const SamPoints *p, Cycle *c)
{
  const PetscInt length = !e->section ? p->count : e->axis == SAM_SECTION_X ? e->grid->nx : e->grid->ny;
  const PetscInt states = e->passing ? e->grid->nx + 1 : e->source.steps;
  double        *slip   = NULL;

  PetscFunctionBegin;
  /* the surface is the first depth, where Ruiz's parameters are asked for */
  *c = (Cycle){.e = e, .points = p, .states = states, .surface = p->depth == 0 && p->depths > 0 ? length : 0};
  if (e->wants[SAM_QUANTITY_RUIZ] && (e->section || p->depth == 0)) { /* collective */
    PetscCall(SamAllocate(sizeof(double) * (size_t)(2 * states) * (size_t)length, &slip));
    PetscCall(ReadSlip(e, length, slip));
  }
  c->slip = slip;
  PetscCall(PetscMalloc3(SAM_STRESS_COMPONENTS * states, &c->stress, 2 * states, &c->shear, 2 * states, &c->path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Cycle *c)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(c->stress, c->shear, c->path));
  SamFree((void *)c->slip);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCycleWrite(SamEvaluation e, const SamPoints *p, double done, double share)
{
  PetscInt wanted = 0, k = 0;
  double  *values;
  Cycle    c;

  PetscFunctionBegin;
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) wanted += e->wants[q];
  PetscCall(Create(e, p, &c));
  PetscCall(SamAllocate(sizeof(double) * MOST * (size_t)p->count, &values));
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) {
    if (!e->wants[q]) continue;
    PetscCall(
      ComputeAll(e, &c, (SamQuantity)q, values, done + share * (double)k / (double)wanted, share / (double)wanted));
    for (PetscInt part = 0; part < SamQuantityComponents((SamQuantity)q); part++)
      PetscCall((*e->write)(e->write_context, (SamQuantity)q, part, 0, p->depth, p->depths,
                            values + part * (ptrdiff_t)p->count));
    k++;
  }
  SamFree(values);
  PetscCall(Destroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Hardness: the pressure has a limit H; cells that reach it overlap and yield.

  In a step 0 <= p <= H. The gap g, of the surfaces before the step, is 0 where the pressure is between these bounds, >=
  0 where p = 0 and <= 0 where p = H. Where p = H, the overlap -g is the depth by which the surfaces yield in the step.
  It is added to the separation of later steps, so that the gap of the yielded surfaces is 0 in these cells. For the
  yielded surfaces and the same loads, the pressure of the step is the only solution, and it has no overlap: reloading
  returns to it, unloading before that is elastic, and a step without changes does not yield.
*/
#include <petsam/private/lawimpl.h>
#include <petsam/normal.h>
#include <petsam/private/state.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>

typedef struct {
  PetscReal limit; /* Pa */
} Hardness;

#define DEPTH "plastic_depth"
/* The numbers of a step, in this order from CELLS on */
enum { CELLS, AREA, MOST, ENERGY, NUMBERS };

PetscErrorCode SamLawSetHardness(SamLaw law, PetscReal limit)
{
  Hardness *h;

  PetscFunctionBegin;
  SamValidHandle(law, SamLaw, 1);
  PetscCheck(!strcmp(law->type, SAM_LAW_HARDNESS), law->grid->comm, PETSC_ERR_ARG_WRONG, "The law %s has no hardness",
             law->type);
  PetscCheck(limit > 0, law->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "hardness %.6g: expected a number > 0, or inf",
             (double)limit);
  h = (Hardness *)law->data;
  if (limit != h->limit) law->revision++;
  h->limit = limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamOptionRow limit_row = {"pressure_limit",
                                       "hardness: the maximum pressure, where the surfaces yield",
                                       SAM_OPTION_REAL,
                                       offsetof(Hardness, limit),
                                       .range    = SAM_RANGE_POSITIVE_INF,
                                       .unit     = "Pa",
                                       .recorded = PETSC_TRUE};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  const double limit = (double)((Hardness *)law->data)->limit;
  double       young = 0; /* Young's modulus at the surface of the softer body */
  char         why[160];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    const double of = (double)SamBodyAt(SamPairBody(SamElasticityGetPair(law->elasticity), b), 0).young;

    young = b ? PetscMin(young, of) : of;
  }
  SamExplainStress(limit, young, SAM_LEAST_CONSTANT, isinf(limit) ? INFINITY : SAM_MOST_STRENGTH, why, sizeof(why));
  PetscCheck(!why[0], from->comm, SAM_ERR_USER, "-%s%s %.6g: %s", SamOptionsPrefix(from), limit_row.name, limit, why);
  *asked = isfinite(limit) != 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField  depth            = {.name        = DEPTH,
                                                  .unit        = "m",
                                                  .text        = "depth by which both surfaces have yielded",
                                                  .components  = 1,
                                                  .generations = 2,
                                                  .kept        = PETSC_TRUE,
                                                  .result      = SAM_RESULT_USUAL,
                                                  .motion      = SAM_MOVES,
                                                  .separates   = PETSC_TRUE};
  static const SamStateNumber numbers[NUMBERS] = {
    {"plastic_cells", "1", "cells at the pressure limit", SAM_NUMBER_INT, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"plastic_area", "m2", "area at the pressure limit", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1},
    {"plastic_depth_max", "m", "maximum depth by which the surfaces have yielded", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_LAST, 1},
    {"hardness_work", "J", "work of the pressure on the plastic depth in the load step", SAM_NUMBER_REAL, 1,
     PETSC_FALSE, PETSC_TRUE, SAM_JOIN_SUM, 2}};
  PetscInt id;

  PetscFunctionBegin;
  (void)law;
  PetscCall(SamStateDeclareField(state, &depth, &id));
  for (PetscInt k = 0; k < NUMBERS; k++) PetscCall(SamStateDeclareNumber(state, &numbers[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Separation(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  const PetscInt id    = SamStateFindField(state, DEPTH);
  const Vec      depth = id < 0                    ? NULL
                         : generation == SAM_TRIED ? SamStateReadField(state, id)
                                                   : SamStateGetField(state, id, generation);

  PetscFunctionBegin;
  (void)law;
  if (depth) *adds = PETSC_TRUE;
  if (depth && h) PetscCall(VecAXPY(h, 1, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Limit(SamLaw law, PetscReal *most)
{
  PetscFunctionBegin;
  *most = ((Hardness *)law->data)->limit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

/* Computes the overlap of the step from the gap before the surfaces yield; `any`: true if any rank has overlap. */
static PetscErrorCode FindOverlap(SamLaw law, SamLawStep *step, Vec overlap, PetscBool *any)
{
  const double  saturated = SAM_SATURATED * ((Hardness *)law->data)->limit;
  const double *p;
  double       *g, most = 0;

  PetscFunctionBegin;
  PetscCall(VecCopy(step->field[SAM_USE_GAP], overlap));
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(VecGetArray(overlap, &g));
  for (PetscInt k = 0; k < step->grid->cells; k++) {
    g[k] = p[k] >= saturated && g[k] < 0 ? -g[k] : 0;
    most = PetscMax(most, g[k]);
  }
  PetscCall(VecRestoreArray(overlap, &g));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(SamMax(step->grid->comm, 1, &most));
  *any = most > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the overlap of the step to the depth, which is unchanged if there is none: elastic steps keep the gap. */
static PetscErrorCode AddOverlap(SamLaw law, SamLawStep *step, PetscInt id, Vec before, Vec *depth)
{
  Vec       overlap;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(step->grid, 1, &overlap));
  PetscCall(FindOverlap(law, step, overlap, &any));
  if (any || !before) {
    PetscCall(SamStateSetField(step->state, id, depth));
    PetscCall(before ? VecWAXPY(*depth, 1, before, overlap) : VecCopy(overlap, *depth));
  }
  PetscCall(VecDestroy(&overlap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the number of cells at the limit, the maximum depth, and the work of the pressure on the added depth. When a
  load returns that has caused yielding, the same cells are at the limit again, within the tolerance of the solver.
*/
#define AT_LIMIT (1 - 1e-6)
static PetscErrorCode CountYielded(SamLaw law, SamLawStep *step, Vec before, Vec depth)
{
  const SamGrid grid  = step->grid;
  const double  limit = AT_LIMIT * ((Hardness *)law->data)->limit, area = grid->dx * grid->dy;
  enum { AT, WORK, SUMS };
  SamTotal      totals[SUMS] = {{0}};
  double        sums[SUMS], most = 0, *numbers;
  const double *p, *w, *w_before;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(VecGetArrayRead(depth, &w));
  PetscCall(VecGetArrayRead(before ? before : depth, &w_before));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row[SUMS] = {0};

    for (PetscInt i = 0; i < grid->nx; i++) {
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + i;

      row[AT] += p[k] >= limit ? 1 : 0;
      row[WORK] += p[k] * (w[k] - (before ? w_before[k] : 0));
      most = PetscMax(most, w[k]);
    }
    SamAddAll(SUMS, totals, row);
  }
  PetscCall(VecRestoreArrayRead(before ? before : depth, &w_before));
  PetscCall(VecRestoreArrayRead(depth, &w));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(SamSumTotals(grid->comm, SUMS, totals, sums));
  PetscCall(SamMax(grid->comm, 1, &most));
  numbers         = SamStateNumbers(step->state, SamStateFindNumber(step->state, "plastic_cells"), SAM_TRIED);
  numbers[CELLS]  = sums[AT];
  numbers[AREA]   = sums[AT] * area;
  numbers[MOST]   = most;
  numbers[ENERGY] = sums[WORK] * area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscInt id     = SamStateFindField(step->state, DEPTH);
  const Vec      before = SamStateGetField(step->state, id, SAM_COMMITTED);
  Vec            depth  = before;

  PetscFunctionBegin;
  /* A known pressure has caused its yielding before; the rest of its gap is rounding. */
  if (!step->known_pressure || !before) PetscCall(AddOverlap(law, step, id, before, &depth));
  PetscCall(CountYielded(law, step, before, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View(SamLaw law, SamState state, PetscViewer viewer)
{
  const double *numbers = SamStateReadNumbers(state, SamStateFindNumber(state, "plastic_cells"));

  PetscFunctionBegin;
  (void)law;
  if (numbers[MOST] > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %.6g %s at the limit, depth up to %.6g m, work %.6g %s\n",
                                     "plastic", numbers[AREA], SamStateUnitOf(state, "plastic_area"), numbers[MOST],
                                     numbers[ENERGY], SamStateUnitOf(state, "hardness_work")));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Hardness(SamLaw law)
{
  Hardness *h;

  PetscFunctionBegin;
  PetscCall(PetscNew(&h));
  h->limit                = INFINITY; /* PETSC_INFINITY is a finite number */
  law->data               = h;
  law->option             = limit_row.name;
  law->heading            = "Plastic deformation";
  law->rows               = &limit_row;
  law->row_count          = 1;
  law->bytes              = 24;
  law->forbids_jumps      = PETSC_TRUE;
  law->any_motion         = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->uses[SAM_USE_GAP]  = PETSC_TRUE;
  law->ops.declare        = Declare;
  law->ops.separation     = Separation;
  law->ops.limit          = Limit;
  law->ops.view           = View;
  law->ops.advance        = Advance;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A third law of wear, with all that a law may answer: body 1 loses the depth k max(0, p |ds| - c) in a step, as wear
  that begins above a threshold. Where it has worn, a stress -s exp(-z/d) remains along its surface; its volume is in
  doubt where few cells wear; and its wear goes back to a derivative by k.
*/
#include "trials.h"
#include <petsam/private/examination.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/state.h>

typedef struct {
  PetscReal rate, least, stress, depth; /* k, 1/Pa; c, Pa m; s, Pa; d, m */
} Threshold;

#define ROW(name, text, member, unit_) \
  { \
    name, text, SAM_OPTION_REAL, offsetof(Threshold, member), .range = SAM_RANGE_NONNEGATIVE, .unit = unit_, \
                                                              .recorded = PETSC_TRUE \
  }
static const SamOptionRow rows[] = {ROW("threshold_wear", "depth worn, k (p |ds| - c): k", rate, "1/Pa"),
                                    ROW("threshold_least", "wear begins at p |ds| = c", least, "Pa m"),
                                    ROW("threshold_stress", "stress that wear leaves", stress, "Pa"),
                                    ROW("threshold_depth", "depth at which it has fallen to 1/e", depth, "m")};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  (void)from;
  *asked = ((Threshold *)law->data)->rate > 0 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

static double LoadOf(const Threshold *t, double rubbed)
{
  return PetscMax(0, fabs(rubbed) - t->least);
}

/* ---- the step ---- */

static PetscErrorCode Compute(void *owner, SamState state, PetscInt component, Vec depth)
{
  const Vec load = SamStateReadField(state, SamStateFindField(state, "threshold_load"));

  (void)component;
  if (!load) return VecSet(depth, 0);
  PetscCall(VecCopy(load, depth));
  return VecScale(depth, ((Threshold *)((SamLaw)owner)->data)->rate);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField  load      = {"threshold_load",   .components = 1,     .generations = 3,
                                           .kept = PETSC_TRUE, .motion = SAM_MOVES, .separates = PETSC_TRUE};
  static const SamStateNumber volumes[] = {
    {"wear_volume1", "m3", "volume removed of body 1", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"wear_volume2", "m3", "volume removed of body 2", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0}};
  PetscInt id;

  PetscCall(SamStateDeclareField(state, &load, &id));
  for (int b = 0; b < 2; b++) PetscCall(SamStateDeclareNumber(state, &volumes[b], &id));
  return SamStateOffer(state, &(SamStateResult){"wear_depth1", "m", "depth removed of body 1", SAM_FIELD_REAL,
                                                SAM_RESULT_USUAL, Compute, law, 0, -1});
}

/* A committed solution has the load before its step, as that opens the gap from the next step on. */
static PetscErrorCode Separation(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  const PetscInt  id    = SamStateFindField(state, "threshold_load");
  const PetscBool later = generation == SAM_TRIED && !SamStateGetField(state, id, SAM_TRIED);
  const Vec       load  = SamStateGetField(state, id, later ? SAM_BEFORE : SAM_COMMITTED);

  if (!load) return 0;
  *adds = PETSC_TRUE;
  return h ? VecAXPY(h, ((Threshold *)law->data)->rate, load) : 0;
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const Threshold *t = (const Threshold *)law->data;
  PetscReal        sum;
  double          *values, *numbers;
  Vec              load;

  PetscCall(SamGridCreateVec(step->grid, 1, &load));
  PetscCall(VecCopy(step->field[SAM_USE_PRESSED], load));
  PetscCall(VecGetArray(load, &values));
  for (PetscInt k = 0; k < step->grid->cells; k++) values[k] = LoadOf(t, values[k]);
  PetscCall(VecRestoreArray(load, &values));
  PetscCall(SamLawAddToSum(step->state, "threshold_load", load));
  PetscCall(VecSum(SamStateReadField(step->state, SamStateFindField(step->state, "threshold_load")), &sum));
  numbers     = SamStateNumbers(step->state, SamStateFindNumber(step->state, "wear_volume1"), SAM_TRIED);
  numbers[0]  = t->rate * sum * step->grid->dx * step->grid->dy;
  numbers[1]  = 0;
  step->moves = PETSC_TRUE;
  return VecDestroy(&load);
}

/* ---- its answers ---- */

static PetscReal Number(SamLaw law)
{
  return ((Threshold *)law->data)->rate;
}

static PetscErrorCode Back(SamLaw law, SamBackStep *step)
{
  const Threshold *t     = (const Threshold *)law->data;
  const PetscInt   cells = step->grid->cells;
  double          *load, *factor, sum;

  PetscCall(PetscMalloc2(cells, &load, cells, &factor));
  for (PetscInt k = 0; k < cells; k++) {
    load[k]   = LoadOf(t, step->rubbed[k]);
    factor[k] = load[k] > 0 ? t->rate * step->by_worn[k] : 0;
  }
  PetscCall(SamGridDot(step->grid, 1, step->by_worn, load, &sum));
  *step->by_number += sum;
  PetscCall(SamBackAddRubbed(step, factor));
  return PetscFree2(load, factor);
}

static PetscErrorCode Doubt(SamLaw law, SamExamination *x)
{
  SamState      state;
  const double *worn;
  double        cells = 0;
  Vec           load;

  (void)law;
  PetscCall(SamContactGetState(x->contact, &state));
  load = SamStateReadField(state, SamStateFindField(state, "threshold_load"));
  if (!load) return 0;
  PetscCall(VecGetArrayRead(load, &worn));
  for (PetscInt k = 0; k < x->grid->cells; k++) cells += worn[k] > 0;
  PetscCall(VecRestoreArrayRead(load, &worn));
  PetscCall(SamSum(x->grid->comm, 1, &cells));
  if (cells > 0)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, 1 / cells, 20 / cells, "wear_volume1", "%.0f cells wear", cells);
  return 0;
}

/* ---- its stress ---- */

static PetscErrorCode Stress(SamStressPart part, PetscInt step, PetscInt depth, Vec stress)
{
  const SamParameters *const p = part->source->parameters;
  const PetscInt             n = part->places->grid->cells;
  const double               s = SamParametersFind(p, "threshold_stress")->value[0];
  const double               d = SamParametersFind(p, "threshold_depth")->value[0];
  double                    *to, *worn;

  PetscCall(PetscMalloc1(n, &worn));
  PetscCall((*part->source->read)(part->source->context, step, "wear_depth1", worn));
  PetscCall(VecGetArray(stress, &to));
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2 && worn[k] > 0; c++)
      to[k + (c ? SAM_STRESS_YY : SAM_STRESS_XX) * n] -= s * exp(-(double)part->places->depth[depth] / d);
  PetscCall(VecRestoreArray(stress, &to));
  return PetscFree(worn);
}

static PetscErrorCode CreateStress(SamStressPart part)
{
  const SamParameters *const p = part->source->parameters;

  if (p && part->places->body == 1 && SamParametersFind(p, "threshold_stress")) part->ops.plane = Stress;
  return 0;
}

const SamStressPartType ThresholdStress = {
  .name = "stress that wear leaves", .fields = {"wear_depth1"}, .create = CreateStress};

PetscErrorCode CreateThreshold(SamLaw law)
{
  Threshold *t;

  PetscCall(PetscNew(&t));
  t->depth                   = 1e-4;
  law->data                  = t;
  law->option                = rows[0].name;
  law->heading               = "Wear above a threshold";
  law->rows                  = rows;
  law->row_count             = 4;
  law->needs_friction        = PETSC_TRUE;
  law->wears                 = PETSC_TRUE;
  law->uses[SAM_USE_PRESSED] = PETSC_TRUE;
  law->number                = "threshold_wear";
  law->ops.setfromoptions    = SetFromOptions;
  law->ops.declare           = Declare;
  law->ops.separation        = Separation;
  law->ops.advance           = Advance;
  law->ops.number            = Number;
  law->ops.back              = Back;
  law->ops.doubt             = Doubt;
  return 0;
}

/*
  Stresses and fatigue parameters in another program: petsam_stress(), petsam_record(), petsam_fatigue().

  A step is recorded as the fields that a results file would contain: tractions and slip. Each rank has its own rows of
  maps, as of fields; all ranks have the whole of a section.
*/
#include "embedimpl.h"
#include <petsam/private/arguments.h>
#include <petsam/private/evaluation.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/contact.h>
#include <petsam/private/setup.h>
#include <petsam/private/problemimpl.h>

enum { AXES = SAM_STRESS_AXES };

/* A step whose stresses can be evaluated */
typedef struct {
  SamControl control;
  double     area;                     /* of contact, m2 */
  PetscReal  slide[4];                 /* m: slide, and rolled distance */
  double    *field[SAM_STRESS_FIELDS]; /* NULL: there is none; the first: there is no step */
  double    *layers[SAM_LAYER_GROUPS]; /* (SAM_STRESS_COMPONENTS, layers, cells): stresses in layers; NULL: none */
} Step;

/* Coordinates, or a dataset of an evaluation */
typedef struct {
  const char *name;
  int         dimensions;
  ptrdiff_t   size; /* count of numbers on this rank */
  double     *values;
} Result;

struct _n_SamEmbedStress {
  PetscBool recording;
  PetscInt  steps, room;
  Step     *step;   /* the recorded steps */
  Step      before; /* committed step when recording began, if there was one */
  /* results */
  PetscInt shape[AXES]; /* shape on this rank */
  int      results;
  Result   result[AXES + SAM_STRESS_DATASETS]; /* coordinates, then datasets */
};

/* ---- steps ---- */

/* Takes the stresses in layers that laws add to those by tractions. */
static PetscErrorCode TakeLayers(petsam_contact *c, Step *step)
{
  const ptrdiff_t       n = c->setup->grid->cells;
  const SamStateLayers *group;
  SamState              state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(c->setup->contact, &state));
  for (PetscInt g = 0; (group = SamStateGetLayers(state, g)); g++) {
    const PetscInt layers = group->count[0] + group->count[1];
    Vec            field;

    if (!group->stresses) continue;
    PetscCall(SamAllocate(sizeof(double) * SAM_STRESS_COMPONENTS * (size_t)layers * (size_t)n, &step->layers[g]));
    PetscCall(SamGridCreateVec(c->setup->grid, layers, &field));
    for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++) {
      char                  name[80];
      const SamStateResult *result;
      const double         *values;

      (void)snprintf(name, sizeof(name), "%s/%s", group->group, SamLayerStresses[k]);
      result = SamStateResultOf(state, SamStateFindResult(state, name));
      PetscCall((*result->compute)(result->owner, state, result->component, field));
      PetscCall(VecGetArrayRead(field, &values));
      PetscCall(PetscArraycpy(step->layers[g] + k * layers * n, values, layers * n));
      PetscCall(VecRestoreArrayRead(field, &values));
    }
    PetscCall(VecDestroy(&field));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the tried step, else the committed one. */
static PetscErrorCode TakeStep(petsam_contact *c, Step *step)
{
  static const char *const slides[4] = {"slide_x", "slide_y", "rolled_x", "rolled_y"};

  const ptrdiff_t    n = c->setup->grid->cells;
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c->setup->contact, &s));
  *step = (Step){.control = s->control};
  PetscCall(SamContactGetNumber(c->setup->contact, "contact_area", &step->area));
  for (int k = 0; k < 4 && SamProblemSlides(c->setup->problem); k++)
    PetscCall(SamContactGetNumber(c->setup->contact, slides[k], &step->slide[k]));
  for (int f = 0; SamStressField(f); f++) {
    PetscBool has;

    PetscCall(SamContactHasField(c->setup->contact, SamStressField(f), &has));
    if (!has && f >= SAM_STRESS_TRACTIONS + SAM_STRESS_SLIP_FIELDS) continue;
    PetscCall(SamAllocate(sizeof(double) * (size_t)n + 1, &step->field[f]));
    for (ptrdiff_t k = 0; k < n && !has; k++) step->field[f][k] = NAN; /* the motion has another field instead */
    if (has) PetscCall(SamEmbedCopyField(c, SamStressField(f), step->field[f]));
  }
  PetscCall(TakeLayers(c, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void DestroyStep(Step *step)
{
  for (int f = 0; f < SAM_STRESS_FIELDS; f++) SamFree(step->field[f]);
  for (int g = 0; g < SAM_LAYER_GROUPS; g++) SamFree(step->layers[g]);
  *step = (Step){.area = 0};
}

PetscErrorCode SamEmbedRecord(petsam_contact *c, const SamStep *step)
{
  SamEmbedStress s = c->stress;

  PetscFunctionBegin;
  if (!s || !s->recording) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->steps == s->room) {
    s->room = 2 * s->room + 16;
    PetscCall(PetscRealloc(sizeof(*s->step) * (size_t)s->room, &s->step));
  }
  PetscCall(TakeStep(c, &s->step[s->steps]));
  s->step[s->steps++].control.time = step->control.time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamEmbedForgetSteps(petsam_contact *c)
{
  const SamEmbedStress s = c->stress;

  if (!s) return;
  while (s->steps) DestroyStep(&s->step[--s->steps]);
  DestroyStep(&s->before);
}

/* ---- results ---- */

static void ForgetResults(SamEmbedStress s)
{
  while (s->results) SamFree(s->result[--s->results].values);
}

PetscErrorCode SamEmbedDestroyStress(petsam_contact *c)
{
  PetscFunctionBegin;
  if (!c->stress) PetscFunctionReturn(PETSC_SUCCESS);
  SamEmbedForgetSteps(c);
  ForgetResults(c->stress);
  PetscCall(PetscFree(c->stress->step));
  PetscCall(PetscFree(c->stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates a result with these dimensions, the last ones of the shape, or with one of the axes alone. */
static PetscErrorCode AddResult(SamEmbedStress s, const char name[], int first, int end)
{
  Result *const r = &s->result[s->results];

  PetscFunctionBegin;
  *r = (Result){.name = name, .dimensions = end - first, .size = 1};
  for (int d = first; d < end; d++) r->size *= s->shape[d];
  PetscCall(SamAllocateZeros(sizeof(double) * (size_t)r->size, &r->values));
  s->results++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the shape and the coordinates, and allocates the results. */
static PetscErrorCode CreateResults(SamEmbedStress s, const SamStressLayout *l)
{
  static const char *const axes[AXES] = {"time", "z", "y", "x"};

  PetscFunctionBegin;
  ForgetResults(s);
  for (int d = 0; d < AXES; d++) {
    s->shape[d] = d == SAM_Y ? l->rows : l->n[d];
    PetscCall(AddResult(s, axes[d], d, d + 1));
    PetscCall(PetscArraycpy(s->result[d].values, l->coordinate[d] + (d == SAM_Y ? l->row : 0), s->shape[d]));
  }
  for (PetscInt k = 0; k < l->datasets; k++)
    PetscCall(AddResult(s, l->dataset[k].name, l->dataset[k].of_cycle ? SAM_Z : SAM_TIME, AXES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores a result of the evaluation. */
static PetscErrorCode Keep(void *context, PetscInt dataset, const PetscInt start[SAM_STRESS_AXES],
                           const PetscInt count[SAM_STRESS_AXES], const double values[])
{
  const SamEmbedStress s     = (SamEmbedStress)context;
  const ptrdiff_t      plane = (ptrdiff_t)s->shape[SAM_Y] * s->shape[SAM_X];
  double *const        to    = s->result[AXES + dataset].values;

  PetscFunctionBegin;
  PetscCall(
    PetscArraycpy(to + (start[SAM_TIME] * s->shape[SAM_Z] + start[SAM_Z]) * plane, values, count[SAM_Z] * plane));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives all ranks the depths of a section: on each rank the depths of the others are zero bits. */
static PetscErrorCode GatherSection(petsam_contact *c)
{
  const SamEmbedStress s = c->stress;
  const ptrdiff_t      n = (ptrdiff_t)s->shape[SAM_Z] * s->shape[SAM_Y] * s->shape[SAM_X];

  PetscFunctionBegin;
  for (int r = AXES; r < s->results; r++)
    for (ptrdiff_t k = 0; k < s->result[r].size; k += n)
      PetscCallMPI(
        MPI_Allreduce(MPI_IN_PLACE, s->result[r].values + k, (PetscMPIInt)n, MPI_UINT64_T, MPI_BOR, c->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- evaluation ---- */

/* Reads the options of a call, which are in a separate database. */
static PetscErrorCode ReadOptions(petsam_contact *c, const char options[], SamEvaluation *e)
{
  const SamOptions from = {c->comm, NULL};
  PetscOptions     database;
  PetscErrorCode   code;

  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(&database));
  PetscCall(PetscOptionsPush(database));
  code = SamEmbedInsertOptions(c, database, options);
  if (!code) code = SamEvaluationCreateFromOptions(&from, e);
  if (!code) code = SamArgumentsRefuseUnknown(c->comm, NULL);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&database));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The steps to be evaluated */
typedef struct {
  petsam_contact *c;
  const Step     *step, *before;
  PetscInt        cells, steps;
} Steps;

/* Returns a field of a step; NULL if it has none. */
static const double *FindField(const Step *step, const char field[])
{
  const PetscInt f = SamStressFieldFind(field);

  return f < SAM_STRESS_FIELDS ? step->field[f] : NULL;
}

static PetscErrorCode ReadField(void *context, PetscInt k, const char field[], double values[])
{
  const Steps *const s = (const Steps *)context;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(values, FindField(k < 0 ? s->before : &s->step[k], field), s->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool HasField(void *context, const char field[])
{
  const Steps *const s = (const Steps *)context;

  for (PetscInt k = 0; k < s->steps; k++)
    if (!FindField(&s->step[k], field)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static const SamStateLayers *GetLayers(void *context, PetscInt k)
{
  SamState state;

  return SamContactGetState(((const Steps *)context)->c->setup->contact, &state) ? NULL : SamStateGetLayers(state, k);
}

static PetscErrorCode ReadLayer(void *context, PetscInt k, PetscInt group, PetscInt component, PetscInt layer,
                                double values[])
{
  const Steps *const    s = (const Steps *)context;
  const SamStateLayers *of;
  SamState              state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->c->setup->contact, &state));
  of = SamStateGetLayers(state, group);
  PetscCall(PetscArraycpy(
    values, s->step[k].layers[group] + (component * (of->count[0] + of->count[1]) + layer) * (ptrdiff_t)s->cells,
    s->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNumber(void *context, PetscInt k, SamStepNumber number, double *value)
{
  const Steps *const s    = (const Steps *)context;
  const Step *const  step = k < 0 ? s->before : &s->step[k];

  *value = 0;
  if (number == SAM_STEP_TIME) *value = (double)step->control.time;
  if (number == SAM_STEP_AREA) *value = step->area;
  if (number >= SAM_STEP_SLIDE_X) *value = (double)step->slide[number - SAM_STEP_SLIDE_X];
  return PETSC_SUCCESS;
}

static PetscErrorCode ReadConditions(void *context, PetscInt k, SamConditions conditions, SamControl *control)
{
  const Steps *const s = (const Steps *)context;

  for (PetscInt n = 0; n < SamConditionsCount(conditions); n++) {
    const SamCondition *one = SamConditionsGet(conditions, n);

    SamControlSetCondition(control, one,
                           SamControlGet(&s->step[k].control, SamConditionsFind(s->c->conditions, one->name)));
  }
  return PETSC_SUCCESS;
}

static PetscErrorCode Warn(void *context, const char text[])
{
  petsam_contact *const c = ((const Steps *)context)->c;

  (void)snprintf(c->message, sizeof(c->message), "%s", text);
  return PETSC_SUCCESS;
}

static PetscErrorCode Compute(petsam_contact *c, const char options[], Steps *steps, SamEvaluation *e)
{
  PetscErrorCode  code;
  SamParameters  *parameters;
  SamStressSource source = {.bodies     = c->setup->elasticity,
                            .name       = "-elasticity",
                            .steps      = steps->steps,
                            .before     = steps->before && steps->before->field[0],
                            .slides     = SamProblemSlides(c->setup->problem),
                            .slips      = SamMotionOf(c->setup->elasticity)->continues,
                            .has        = HasField,
                            .read       = ReadField,
                            .number     = ReadNumber,
                            .conditions = ReadConditions,
                            .layers     = GetLayers,
                            .layer      = ReadLayer,
                            .warn       = Warn,
                            .context    = steps};

  PetscFunctionBegin;
  PetscCall(ReadOptions(c, options, e));
  PetscCall(PetscNew(&parameters));
  source.parameters = parameters;
  code              = SamSetupAddParameters(c->setup, parameters);
  if (!code) code = SamEvaluationSetUp(*e, &source);
  PetscCall(PetscFree(parameters));
  PetscCall(code);
  PetscCall(CreateResults(c->stress, SamEvaluationGetLayout(*e)));
  PetscCall(SamEvaluationCompute(*e, Keep, c->stress));
  if (SamEvaluationGetLayout(*e)->section) PetscCall(GatherSection(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Evaluate(petsam_contact *c, const char options[], PetscInt n, const Step step[],
                               const Step *before, int shape[4])
{
  Steps          steps = {c, step, before, c->setup->grid->cells, n};
  SamEvaluation  e     = NULL;
  PetscErrorCode code;

  PetscFunctionBegin;
  code = Compute(c, options, &steps, &e);
  PetscCall(SamEvaluationDestroy(&e));
  if (code) ForgetResults(c->stress);
  PetscCall(code);
  for (int d = 0; d < AXES; d++) shape[d] = (int)c->stress->shape[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StressOfStep(petsam_contact *c, const char options[], int shape[4])
{
  Step            step = {.area = 0};
  PetscErrorCode  code;
  const PetscBool tried     = SamContactHasStep(c->setup->contact, SAM_TRIED);
  const PetscBool committed = SamContactHasStep(c->setup->contact, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCheck(tried || committed, c->comm, PETSC_ERR_ORDER, "no step has been solved yet");
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  PetscCall(TakeStep(c, &step));
  code = Evaluate(c, options, 1, &step, NULL, shape);
  DestroyStep(&step);
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_stress(petsam_contact *c, const char *options, int shape[4])
{
  return SamEmbedEnterTogether(c, __func__, options && shape, 0) ? SamEmbedLeave(c, StressOfStep(c, options, shape))
                                                                 : SAM_EMBED_USAGE;
}

PetscErrorCode SamEmbedRecordAnew(petsam_contact *c)
{
  const PetscBool tried     = SamContactHasStep(c->setup->contact, SAM_TRIED);
  const PetscBool committed = SamContactHasStep(c->setup->contact, SAM_COMMITTED);

  PetscFunctionBegin;
  SamEmbedForgetSteps(c);
  if (c->stress && c->stress->recording && committed && !tried) PetscCall(TakeStep(c, &c->stress->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Record(petsam_contact *c, PetscBool on)
{
  PetscFunctionBegin;
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  c->stress->recording = on;
  PetscCall(SamEmbedRecordAnew(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_record(petsam_contact *c, int on)
{
  return SamEmbedEnterTogether(c, __func__, PETSC_TRUE, on != 0) ? SamEmbedLeave(c, Record(c, on != 0))
                                                                 : SAM_EMBED_USAGE;
}

static PetscErrorCode Fatigue(petsam_contact *c, const char options[], int shape[4])
{
  char          *all;
  PetscErrorCode code;

  PetscFunctionBegin;
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  PetscCall(PetscMalloc1(strlen(options) + 32, &all));
  (void)sprintf(all, "-quantities none %s", options);
  code = Evaluate(c, all, c->stress->steps, c->stress->step, &c->stress->before, shape);
  PetscCall(PetscFree(all));
  PetscCall(code);
  PetscCheck(c->stress->steps, c->comm, PETSC_ERR_ORDER, "petsam_fatigue: no step has been recorded");
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_fatigue(petsam_contact *c, const char *options, int shape[4])
{
  return SamEmbedEnterTogether(c, __func__, options && shape, 0) ? SamEmbedLeave(c, Fatigue(c, options, shape))
                                                                 : SAM_EMBED_USAGE;
}

/* ---- results by name ---- */

const char *petsam_stress_name(const petsam_contact *c, int k, int *dimensions)
{
  if (!SamEmbedExists(c) || !c->stress || k < 0 || k >= c->stress->results) return NULL;
  if (dimensions) *dimensions = c->stress->result[k].dimensions;
  return c->stress->result[k].name;
}

static PetscErrorCode GetStress(petsam_contact *c, const char name[], double values[])
{
  const SamEmbedStress s     = c->stress;
  const int            count = s ? s->results : 0;
  int                  r     = 0;

  PetscFunctionBegin;
  while (r < count && strcmp(name, s->result[r].name)) r++;
  PetscCheck(r < count, c->comm, SAM_ERR_USER,
             "%s: the last petsam_stress() or petsam_fatigue() has no result of this name", name);
  PetscCall(PetscArraycpy(values, s->result[r].values, s->result[r].size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_get_stress(petsam_contact *c, const char *name, double *values)
{
  return SamEmbedEnter(c, __func__, name && values) ? SamEmbedLeave(c, GetStress(c, name, values)) : SAM_EMBED_USAGE;
}

/*
  Stresses and fatigue parameters in another program: petsam_stress(), petsam_record(), petsam_fatigue().

  A step is recorded as the fields that a results file would hold: tractions and slip. Of maps each rank has its rows,
  as of fields; of a section all ranks have all.
*/
#include "embedimpl.h"
#include <petsam/private/arguments.h>
#include <petsam/private/quantities.h>

/* The results: coordinates, and the datasets of an evaluation. */
enum { TIME, Z, Y, X, AXES, RESULTS = AXES + SAM_DATASETS };

/* A step whose stresses can be evaluated. */
typedef struct {
  SamControl control;
  double    *fields; /* (SAM_STEP_FIELDS, cells); NULL: there is no step */
} Step;

struct _n_SamEmbedStress {
  PetscBool recording;
  PetscInt  steps, room;
  Step     *step;   /* that have been recorded */
  Step      before; /* the committed one when recording began, if there was one */
  /* results */
  PetscInt shape[AXES]; /* on this rank */
  double  *values[RESULTS];
};

/* ---- steps ---- */

/* The tried step, else the committed one. */
static PetscErrorCode TakeStep(petsam_contact *c, Step *step)
{
  static const char *const names[SAM_STEP_FIELDS] = {"pressure", "shear_x", "shear_y", "slip_x", "slip_y"};

  const ptrdiff_t    n = c->setup->grid->cells;
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c->setup->contact, &s));
  step->control = s->control;
  PetscCall(SamAllocate(sizeof(double) * SAM_STEP_FIELDS * (size_t)n, &step->fields));
  for (int f = 0; f < SAM_STEP_FIELDS; f++) {
    PetscBool has;

    PetscCall(SamContactHasField(c->setup->contact, names[f], &has));
    for (ptrdiff_t k = 0; k < n && !has; k++) step->fields[f * n + k] = NAN; /* steady rolling has a velocity instead */
    if (has) PetscCall(SamEmbedCopyField(c, names[f], step->fields + f * n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void DestroyStep(Step *step)
{
  SamFree(step->fields);
  step->fields = NULL;
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
  for (int r = 0; r < RESULTS; r++) {
    SamFree(s->values[r]);
    s->values[r] = NULL;
  }
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

static const char *NameOf(int result)
{
  static const char *const axes[AXES] = {"time", "z", "y", "x"};

  return result < AXES ? axes[result] : SamDatasets[result - AXES].label.name;
}

static int DimensionsOf(int result)
{
  return result < AXES ? 1 : SamQuantityIsOfCycle(SamDatasets[result - AXES].quantity) ? 3 : 4;
}

/* The numbers that a result has on this rank. */
static ptrdiff_t SizeOf(SamEmbedStress s, int result)
{
  ptrdiff_t size = 1;

  if (result < AXES) return s->shape[result];
  for (int d = AXES - DimensionsOf(result); d < AXES; d++) size *= s->shape[d];
  return size;
}

/* Shape, coordinates and room. */
static PetscErrorCode CreateResults(petsam_contact *c, const SamStressLayout *l, const Step step[])
{
  const SamGrid        g   = c->setup->grid;
  const SamEmbedStress s   = c->stress;
  const PetscBool      row = l->section && l->axis == SAM_SECTION_X, column = l->section && l->axis == SAM_SECTION_Y;

  PetscFunctionBegin;
  ForgetResults(s);
  s->shape[TIME] = l->steps;
  s->shape[Z]    = l->depths;
  s->shape[Y]    = row ? 1 : column ? g->ny : g->rows;
  s->shape[X]    = column ? 1 : g->nx;
  for (int r = 0; r < RESULTS; r++)
    if (r < AXES || l->wants[SamDatasets[r - AXES].quantity])
      PetscCall(SamAllocateZeros(sizeof(double) * (size_t)SizeOf(s, r), &s->values[r]));
  for (PetscInt k = 0; k < l->steps; k++) s->values[TIME][k] = (double)step[k].control.time;
  for (PetscInt k = 0; k < l->depths; k++) s->values[Z][k] = (double)l->depth[k];
  for (PetscInt k = 0; k < s->shape[Y]; k++)
    s->values[Y][k] = (double)SamGridY(g, row ? l->index : column ? k : g->row_start + k);
  for (PetscInt k = 0; k < s->shape[X]; k++) s->values[X][k] = (double)SamGridX(g, column ? l->index : k);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps what an evaluation hands over. */
static PetscErrorCode Keep(void *context, SamQuantity quantity, PetscInt component, PetscInt step, PetscInt depth,
                           PetscInt depths, const double values[])
{
  const SamEmbedStress s     = (SamEmbedStress)context;
  const ptrdiff_t      plane = (ptrdiff_t)s->shape[Y] * s->shape[X];
  double *const        to    = s->values[AXES + SamDatasetOf(quantity) + component];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(to + (step * s->shape[Z] + depth) * plane, values, depths * plane));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives all ranks the depths of a section: on each rank the depths of the others are zero bits. */
static PetscErrorCode GatherSection(petsam_contact *c)
{
  const SamEmbedStress s = c->stress;
  const ptrdiff_t      n = (ptrdiff_t)s->shape[Z] * s->shape[Y] * s->shape[X];

  PetscFunctionBegin;
  for (int r = AXES; r < RESULTS; r++)
    for (ptrdiff_t k = 0; s->values[r] && k < SizeOf(s, r); k += n)
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->values[r] + k, (PetscMPIInt)n, MPI_UINT64_T, MPI_BOR, c->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- evaluation ---- */

/* Reads the options of a call, which are in a database of their own. */
static PetscErrorCode ReadOptions(petsam_contact *c, const char options[], SamEvaluation e)
{
  const SamOptions from = {c->comm, NULL};
  PetscOptions     database;
  PetscErrorCode   code;

  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(&database));
  PetscCall(PetscOptionsPush(database));
  code = SamEmbedInsertOptions(c, database, options);
  if (!code) code = SamEvaluationSetFromOptions(e, &from);
  if (!code) code = SamArgumentsRefuseUnknown(c->comm, NULL);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&database));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The steps that are evaluated. */
typedef struct {
  const Step *step;
  PetscInt    cells;
  double (*bulk)[SAM_BULK_AND_CASES];
} Steps;

static PetscErrorCode ReadStep(void *context, PetscInt step, SamStepField field, double values[])
{
  const Steps *const s = (const Steps *)context;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(values, s->step[step].fields + field * (ptrdiff_t)s->cells, s->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Compute(petsam_contact *c, const char options[], PetscInt n, Steps *steps, SamEvaluation e)
{
  SamStressLayout layout;
  PetscInt        body;

  PetscFunctionBegin;
  PetscCall(ReadOptions(c, options, e));
  PetscCall(SamEvaluationSetElasticity(e, c->setup->elasticity, NULL, "-elasticity"));
  PetscCall(SamEvaluationGetBody(e, &body));
  for (PetscInt k = 0; k < n; k++)
    for (int b = 0; b < SAM_BULK_AND_CASES; b++)
      steps->bulk[k][b] = (double)(b < SAM_BULK_COMPONENTS ? steps->step[k].control.bulk_stress[body - 1][b]
                                                           : steps->step[k].control.cases[b - SAM_BULK_COMPONENTS]);
  PetscCall(SamEvaluationSetSource(
    e, &(SamEvaluationSource){.steps = n, .bulk = steps->bulk, .read = ReadStep, .context = steps}));
  PetscCall(SamEvaluationSetUp(e));
  PetscCall(SamEvaluationGetLayout(e, &layout));
  PetscCall(CreateResults(c, &layout, steps->step));
  PetscCall(SamEvaluationCompute(e, Keep, c->stress));
  if (layout.section) PetscCall(GatherSection(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Evaluate(petsam_contact *c, const char options[], PetscInt n, const Step step[], int shape[4])
{
  Steps          steps = {step, c->setup->grid->cells, NULL};
  SamEvaluation  e;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &steps.bulk));
  PetscCall(SamEvaluationCreate(c->comm, &e));
  code = Compute(c, options, n, &steps, e);
  PetscCall(SamEvaluationDestroy(&e));
  PetscCall(PetscFree(steps.bulk));
  if (code) ForgetResults(c->stress);
  PetscCall(code);
  for (int d = 0; d < AXES; d++) shape[d] = (int)c->stress->shape[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StressOfStep(petsam_contact *c, const char options[], int shape[4])
{
  Step           step = {.fields = NULL};
  PetscErrorCode code;
  PetscBool      tried, committed;

  PetscFunctionBegin;
  PetscCall(SamContactHasStep(c->setup->contact, &tried, &committed));
  PetscCheck(tried || committed, c->comm, PETSC_ERR_ORDER, "no step has been solved yet");
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  PetscCall(TakeStep(c, &step));
  code = Evaluate(c, options, 1, &step, shape);
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
  PetscBool tried, committed;

  PetscFunctionBegin;
  SamEmbedForgetSteps(c);
  PetscCall(SamContactHasStep(c->setup->contact, &tried, &committed));
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

/* The ends of a cycle may differ by this part of the maximum traction. */
#define CLOSED 0.01

/* Warns, by the message, when the tractions of the last step differ from those before the first. */
static PetscErrorCode AdviseClosed(petsam_contact *c)
{
  static const int first[] = {SAM_STEP_PRESSURE, SAM_STEP_SHEAR_X, SAM_STEP_SLIP_X};

  const ptrdiff_t      n = c->setup->grid->cells;
  const SamEmbedStress s = c->stress;
  const double *const a = s->before.fields, *const b = s->step[s->steps - 1].fields;

  PetscFunctionBegin;
  for (int f = 0; f < 2 && a && s->steps > 1; f++) { /* one: of points that pass */
    double most[2] = {0, 0};                         /* traction, difference */

    for (ptrdiff_t k = first[f] * n; k < first[f + 1] * n; k++) {
      most[0] = fmax(most[0], fmax(fabs(a[k]), fabs(b[k])));
      most[1] = fmax(most[1], fabs(b[k] - a[k]));
    }
    PetscCall(SamMax(c->comm, 2, most));
    if (most[1] > CLOSED * most[0])
      (void)snprintf(c->message, sizeof(c->message),
                     "not a closed cycle, or not a steady one: the %s of the last recorded step differs from that "
                     "before the first by up to %.0f %% of the maximum",
                     f ? "shear" : "pressure", 100 * most[1] / most[0]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fatigue(petsam_contact *c, const char options[], int shape[4])
{
  char          *all;
  PetscErrorCode code;

  PetscFunctionBegin;
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  PetscCall(PetscMalloc1(strlen(options) + 32, &all));
  (void)sprintf(all, "-quantities none %s", options);
  code = Evaluate(c, all, c->stress->steps, c->stress->step, shape);
  PetscCall(PetscFree(all));
  PetscCall(code);
  PetscCheck(c->stress->steps, c->comm, PETSC_ERR_ORDER, "petsam_fatigue: no step has been recorded");
  PetscCall(AdviseClosed(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_fatigue(petsam_contact *c, const char *options, int shape[4])
{
  return SamEmbedEnterTogether(c, __func__, options && shape, 0) ? SamEmbedLeave(c, Fatigue(c, options, shape))
                                                                 : SAM_EMBED_USAGE;
}

/* ---- asking for results ---- */

const char *petsam_stress_name(const petsam_contact *c, int k, int *dimensions)
{
  for (int r = 0; r < RESULTS && c && c->stress && k >= 0; r++) {
    if (!c->stress->values[r] || k--) continue;
    if (dimensions) *dimensions = DimensionsOf(r);
    return NameOf(r);
  }
  return NULL;
}

static PetscErrorCode GetStress(petsam_contact *c, const char name[], double values[])
{
  const SamEmbedStress s = c->stress;
  int                  r = 0;

  PetscFunctionBegin;
  while (s && r < RESULTS && (!s->values[r] || strcmp(name, NameOf(r)))) r++;
  PetscCheck(s && r < RESULTS, c->comm, SAM_ERR_USER,
             "%s: the last petsam_stress() or petsam_fatigue() has no result of this name", name);
  PetscCall(PetscArraycpy(values, s->values[r], SizeOf(s, r)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_get_stress(petsam_contact *c, const char *name, double *values)
{
  return SamEmbedEnter(c, __func__, name && values) ? SamEmbedLeave(c, GetStress(c, name, values)) : SAM_EMBED_USAGE;
}

/*
  Stresses and fatigue parameters in another program: petsam_stress(), petsam_record(), petsam_fatigue().

  Steps are kept as the tractions and the slip that a results file would have of them. Of maps each rank has its rows,
  as of fields; of a section all ranks have all.
*/
#include "embedimpl.h"
#include <petsam/private/arguments.h>
#include <petsam/private/quantities.h>

enum { TIME, Z, Y, X, AXES };

/* A step whose stresses can be evaluated. */
typedef struct {
  SamControl control;
  Vec        pressure, shear, slip; /* of 1, 2 and 2 components */
} Step;

struct _n_SamEmbedStress {
  PetscBool recording;
  PetscInt  steps, room;
  Step     *step;   /* that have been recorded */
  Step      before; /* the committed one when recording began, if there was one */
  /* results */
  PetscInt shape[AXES]; /* on this rank */
  double  *axis[AXES], *values[SAM_DATASETS];
};

static const char *const axes[AXES] = {"time", "z", "y", "x"};

/* ---- steps ---- */

/* One field of the contact becomes a component of a vector. */
static PetscErrorCode TakeField(petsam_contact *c, const char name[], PetscInt component, Vec to)
{
  const PetscInt n = c->setup->grid->cells;
  const double  *from;
  double        *cells;

  PetscFunctionBegin;
  PetscCall(SamContactGetField(c->setup->contact, name, c->work));
  PetscCall(VecGetArrayRead(c->work, &from));
  PetscCall(VecGetArray(to, &cells));
  PetscCall(PetscArraycpy(cells + component * (ptrdiff_t)n, from, n));
  PetscCall(VecRestoreArray(to, &cells));
  PetscCall(VecRestoreArrayRead(c->work, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tried step, else the committed one. */
static PetscErrorCode TakeStep(petsam_contact *c, Step *step)
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c->setup->contact, &s));
  step->control = s->control;
  PetscCall(SamGridCreateVec(c->setup->grid, 1, &step->pressure));
  PetscCall(SamGridCreateVec(c->setup->grid, 2, &step->shear));
  PetscCall(SamGridCreateVec(c->setup->grid, 2, &step->slip));
  PetscCall(TakeField(c, "pressure", 0, step->pressure));
  PetscCall(TakeField(c, "shear_x", 0, step->shear));
  PetscCall(TakeField(c, "shear_y", 1, step->shear));
  PetscCall(TakeField(c, "slip_x", 0, step->slip));
  PetscCall(TakeField(c, "slip_y", 1, step->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyStep(Step *step)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&step->pressure));
  PetscCall(VecDestroy(&step->shear));
  PetscCall(VecDestroy(&step->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCall(PetscMemzero(&s->step[s->steps], sizeof(*s->step)));
  PetscCall(TakeStep(c, &s->step[s->steps]));
  s->step[s->steps++].control.time = step->control.time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEmbedForgetSteps(petsam_contact *c)
{
  const SamEmbedStress s = c->stress;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < s->steps; k++) PetscCall(DestroyStep(&s->step[k]));
  PetscCall(DestroyStep(&s->before));
  s->steps = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results ---- */

static PetscErrorCode ForgetResults(SamEmbedStress s)
{
  PetscFunctionBegin;
  for (int d = 0; d < AXES; d++) PetscCall(PetscFree(s->axis[d]));
  for (PetscInt k = 0; k < SAM_DATASETS; k++) {
    SamFree(s->values[k]);
    s->values[k] = NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEmbedDestroyStress(petsam_contact *c)
{
  PetscFunctionBegin;
  if (!c->stress) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamEmbedForgetSteps(c));
  PetscCall(ForgetResults(c->stress));
  PetscCall(PetscFree(c->stress->step));
  PetscCall(PetscFree(c->stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The numbers that a dataset has at a depth, and its steps. */
static PetscInt Plane(SamEmbedStress s)
{
  return s->shape[Y] * s->shape[X];
}

static PetscInt StepsOf(SamEmbedStress s, PetscInt dataset)
{
  return SamQuantityIsOfCycle(SamDatasets[dataset].quantity) ? 1 : s->shape[TIME];
}

/* Shape, coordinates and room. */
static PetscErrorCode CreateResults(petsam_contact *c, const SamStressLayout *l, const Step step[])
{
  const SamGrid        g   = c->setup->grid;
  const SamEmbedStress s   = c->stress;
  const PetscBool      row = l->section && l->axis == SAM_SECTION_X, column = l->section && l->axis == SAM_SECTION_Y;

  PetscFunctionBegin;
  PetscCall(ForgetResults(s));
  s->shape[TIME] = l->steps;
  s->shape[Z]    = l->depths;
  s->shape[Y]    = row ? 1 : column ? g->ny : g->rows;
  s->shape[X]    = column ? 1 : g->nx;
  for (int d = 0; d < AXES; d++) PetscCall(PetscMalloc1(s->shape[d], &s->axis[d]));
  for (PetscInt k = 0; k < l->steps; k++) s->axis[TIME][k] = (double)step[k].control.time;
  for (PetscInt k = 0; k < l->depths; k++) s->axis[Z][k] = (double)l->depth[k];
  for (PetscInt k = 0; k < s->shape[Y]; k++)
    s->axis[Y][k] = (double)SamGridY(g, row ? l->index : column ? k : g->row_start + k);
  for (PetscInt k = 0; k < s->shape[X]; k++) s->axis[X][k] = (double)SamGridX(g, column ? l->index : k);
  for (PetscInt k = 0; k < SAM_DATASETS; k++)
    if (l->wants[SamDatasets[k].quantity])
      PetscCall(
        SamAllocateZeros(sizeof(double) * (size_t)(StepsOf(s, k) * s->shape[Z]) * (size_t)Plane(s), &s->values[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps what an evaluation hands over. */
static PetscErrorCode Keep(void *context, SamQuantity quantity, PetscInt component, PetscInt step, PetscInt depth,
                           PetscInt depths, const double values[])
{
  const SamEmbedStress s  = (SamEmbedStress)context;
  double *const        to = s->values[SamDatasetOf(quantity) + component];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(to + (step * s->shape[Z] + depth) * (ptrdiff_t)Plane(s), values, depths * Plane(s)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives all ranks the depths of a section: the others have bits of zero there. */
static PetscErrorCode GatherSection(petsam_contact *c)
{
  const SamEmbedStress s = c->stress;
  const PetscInt       n = s->shape[Z] * Plane(s);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_DATASETS; k++)
    for (PetscInt step = 0; s->values[k] && step < StepsOf(s, k); step++)
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->values[k] + step * (ptrdiff_t)n, (PetscMPIInt)n, MPI_UINT64_T,
                                 MPI_BOR, c->comm));
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
  if (!code) code = SamArgumentsRefuseUnknown(c->comm, PETSC_FALSE);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&database));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Compute(petsam_contact *c, const char options[], PetscInt steps, const Step step[],
                              SamEvaluation e)
{
  SamStressLayout layout;

  PetscFunctionBegin;
  PetscCall(ReadOptions(c, options, e));
  PetscCall(SamEvaluationSetElasticity(e, c->setup->elasticity, NULL, "-elasticity"));
  for (PetscInt k = 0; k < steps; k++)
    PetscCall(SamEvaluationAddStep(e, step[k].pressure, step[k].shear, step[k].slip, &step[k].control));
  PetscCall(SamEvaluationSetUp(e));
  PetscCall(SamEvaluationGetLayout(e, &layout));
  PetscCall(CreateResults(c, &layout, step));
  PetscCall(SamEvaluationCompute(e, Keep, c->stress));
  if (layout.section) PetscCall(GatherSection(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Evaluate(petsam_contact *c, const char options[], PetscInt steps, const Step step[], int shape[4])
{
  SamEvaluation  e;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(SamEvaluationCreate(c->comm, &e));
  code = Compute(c, options, steps, step, e);
  PetscCall(SamEvaluationDestroy(&e));
  if (code) PetscCall(ForgetResults(c->stress));
  PetscCall(code);
  for (int d = 0; d < AXES; d++) shape[d] = (int)c->stress->shape[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StressOfStep(petsam_contact *c, const char options[], int shape[4])
{
  Step           step = {.pressure = NULL};
  PetscBool      tried, committed;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCall(SamContactHasStep(c->setup->contact, &tried, &committed));
  PetscCheck(tried || committed, c->comm, PETSC_ERR_ORDER, "no step has been solved yet");
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  PetscCall(TakeStep(c, &step));
  code = Evaluate(c, options, 1, &step, shape);
  PetscCall(DestroyStep(&step));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_stress(petsam_contact *c, const char *options, int shape[4])
{
  if (!c) return SAM_EMBED_USAGE;
  if (!options || !shape) return SamEmbedRefuse(c, "petsam_stress: a pointer is NULL");
  if (!SamEmbedEnter(c)) return SAM_EMBED_USAGE;
  return SamEmbedLeave(c, StressOfStep(c, options, shape));
}

static PetscErrorCode Record(petsam_contact *c, PetscBool on)
{
  PetscFunctionBegin;
  if (!c->stress) PetscCall(PetscNew(&c->stress));
  PetscCall(SamEmbedForgetSteps(c));
  c->stress->recording = on;
  if (on && c->has_committed && !c->has_tried) PetscCall(TakeStep(c, &c->stress->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_record(petsam_contact *c, int on)
{
  if (!c) return SAM_EMBED_USAGE;
  if (!SamEmbedEnter(c)) return SAM_EMBED_USAGE;
  return SamEmbedLeave(c, Record(c, on != 0));
}

/* The part of the largest traction by which the ends of a cycle may differ. */
#define CLOSED 0.01

/* Says in the message that the last step has not the tractions of the one before the first. */
static PetscErrorCode AdviseClosed(petsam_contact *c)
{
  const SamEmbedStress s       = c->stress;
  const Step *const    last    = &s->step[s->steps - 1];
  const Vec            ends[4] = {s->before.pressure, last->pressure, s->before.shear, last->shear};

  PetscFunctionBegin;
  for (int f = 0; f < 2 && ends[0]; f++) {
    PetscReal size[2], difference;
    Vec       v;

    for (int k = 0; k < 2; k++) PetscCall(VecNorm(ends[2 * f + k], NORM_INFINITY, &size[k]));
    PetscCall(VecDuplicate(ends[2 * f], &v));
    PetscCall(VecWAXPY(v, -1, ends[2 * f], ends[2 * f + 1]));
    PetscCall(VecNorm(v, NORM_INFINITY, &difference));
    PetscCall(VecDestroy(&v));
    size[0] = PetscMax(size[0], size[1]);
    if (difference > CLOSED * size[0])
      (void)snprintf(c->message, sizeof(c->message),
                     "not a closed cycle, or not a steady one: the %s of the last recorded step differs from that "
                     "before the first by up to %.0f %% of the largest",
                     f ? "shear" : "pressure", 100 * (double)(difference / size[0]));
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
  PetscCall(AdviseClosed(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_fatigue(petsam_contact *c, const char *options, int shape[4])
{
  if (!c) return SAM_EMBED_USAGE;
  if (!options || !shape) return SamEmbedRefuse(c, "petsam_fatigue: a pointer is NULL");
  if (!SamEmbedEnter(c)) return SAM_EMBED_USAGE;
  return SamEmbedLeave(c, Fatigue(c, options, shape));
}

/* ---- asking for results ---- */

const char *petsam_stress_name(const petsam_contact *c, int k, int *dimensions)
{
  const SamEmbedStress s = c ? c->stress : NULL;

  if (!s || !s->axis[X] || k < 0) return NULL;
  if (dimensions) *dimensions = 1;
  if (k < AXES) return axes[k];
  for (PetscInt d = 0, left = k - AXES; d < SAM_DATASETS; d++) {
    if (!s->values[d] || left--) continue;
    if (dimensions) *dimensions = SamQuantityIsOfCycle(SamDatasets[d].quantity) ? 3 : 4;
    return SamDatasets[d].label.name;
  }
  return NULL;
}

int petsam_get_stress(petsam_contact *c, const char *name, double *values)
{
  SamEmbedStress s;

  if (!c) return SAM_EMBED_USAGE;
  if (!name || !values) return SamEmbedRefuse(c, "petsam_get_stress: a pointer is NULL");
  s             = c->stress;
  c->message[0] = '\0';
  for (int d = 0; d < AXES && s && s->axis[d]; d++)
    if (!strcmp(name, axes[d])) {
      memcpy(values, s->axis[d], sizeof(double) * (size_t)s->shape[d]);
      return 0;
    }
  for (PetscInt k = 0; k < SAM_DATASETS && s; k++)
    if (s->values[k] && !strcmp(name, SamDatasets[k].label.name)) {
      memcpy(values, s->values[k], sizeof(double) * (size_t)(StepsOf(s, k) * s->shape[Z]) * (size_t)Plane(s));
      return 0;
    }
  return SamEmbedRefuse(c, "%s: the last petsam_stress() or petsam_fatigue() has no result of this name", name);
}

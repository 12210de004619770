/* The stresses under the tractions of load steps: settings, steps, and the order of the work. */
#include "evaluationimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/body.h>

/* ---- life ---- */

PetscErrorCode SamEvaluationDestroy(SamEvaluation *evaluation)
{
  SamEvaluation e = *evaluation;

  PetscFunctionBegin;
  *evaluation = NULL;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStressPartsDestroy(&e->parts));
  PetscCall(SamStressDestroy(&e->stress));
  PetscCall(SamElasticityDestroy(&e->source.bodies));
  PetscCall(PetscFree2(e->depth, e->side));
  PetscCall(PetscFree(e->weight));
  PetscCall(PetscFree(e->depths_text));
  PetscCall(PetscFree(e->control));
  PetscCall(PetscFree(e->slide));
  PetscCall(SamProblemDestroy(&e->problem));
  PetscCall(PetscFree(e->largest));
  for (int d = 0; d < SAM_STRESS_AXES; d++) PetscCall(PetscFree(e->coordinate[d]));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- set-up ---- */

/* Finds the line of cells nearest to the section. */
static PetscErrorCode FindLine(SamEvaluation e)
{
  const SamGrid   g     = e->grid;
  const PetscBool row   = e->axis == SAM_SECTION_X;
  const PetscInt  n     = row ? g->ny : g->nx;
  const PetscReal first = row ? SamGridY(g, 0) : SamGridX(g, 0), step = row ? g->dy : g->dx;
  const PetscReal at = (e->place - first) / step;

  PetscFunctionBegin;
  if (!e->section) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck((PetscInt)e->axis < g->axes, e->comm, SAM_ERR_USER,
             "-section x=%.6g: a plane problem has no section along y: give y=0, or omit it", (double)e->place);
  PetscCheck(at >= -0.5 - 1e-9 && at <= (PetscReal)n - 0.5 + 1e-9, e->comm, SAM_ERR_USER,
             "-section %s=%.6g: outside of the grid, which reaches from %.6g to %.6g m", row ? "y" : "x",
             (double)e->place, (double)(first - 0.5 * step), (double)(first + ((PetscReal)n - 0.5) * step));
  e->index = (PetscInt)PetscMin(PetscMax(PetscFloorReal(at + 0.5), 0), (PetscReal)n - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the stresses of the requested body. */
static PetscErrorCode CreateStress(SamEvaluation e)
{
  const SamElasticityType type = SamElasticityGetType(e->source.bodies);

  PetscFunctionBegin;
  PetscCheck(SamElasticityGetTraits(e->source.bodies).stress, e->comm, SAM_ERR_USER,
             "%s: stresses are not available for bodies of type %s", e->source.name, type);
  PetscCheck(!SamBodyIsRigid(SamEvaluationBody(e)), e->comm, SAM_ERR_USER,
             "-body %" PetscInt_FMT ": it is rigid, so its stresses are undetermined", e->body);
  PetscCall(SamElasticityCreateStress(e->source.bodies, e->body, e->source.settings, &e->stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the number of steps: a cycle needs several, a travelling point one. */
static PetscErrorCode CheckCycle(SamEvaluation e)
{
  const PetscBool ruiz = SamQuantityWanted(e, SamFatigueRuiz);

  PetscFunctionBegin;
  PetscCheck(!e->passing || e->cycle, e->comm, SAM_ERR_USER, "-passing is given without -fatigue");
  PetscCheck(!e->passing || e->source.steps == 1, e->comm, SAM_ERR_USER,
             "-passing: %" PetscInt_FMT " steps are given: a point passes under those of one: give one step",
             e->source.steps);
  PetscCheck(!e->passing || !e->section || e->axis == SAM_SECTION_X, e->comm, SAM_ERR_USER,
             "-passing: points pass along x: give a -section y=..., or none");
  PetscCheck(!e->passing || !ruiz, e->comm, SAM_ERR_USER,
             "-fatigue ruiz: needs the slip of steps, and not -passing: omit one of them");
  PetscCheck(e->source.slips || !ruiz, e->comm, SAM_ERR_USER,
             "-fatigue ruiz: needs the slip of steps, and %s has velocities of slip: omit ruiz, or roll in steps of "
             "time",
             e->source.name);
  PetscCheck(e->source.steps > 1 || e->passing || !e->cycle, e->comm, SAM_ERR_USER,
             "-fatigue needs the steps of a cycle, two at least, and not %" PetscInt_FMT ": give more, or -passing",
             e->source.steps);
  PetscCheck(!ruiz || e->depth[0] == 0, e->comm, SAM_ERR_USER,
             "-fatigue ruiz: it is defined on the surface: 0 must be one of -depths");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the constants of fatigue: one for all materials, or one for each elastic material. */
static PetscErrorCode CheckConstants(SamEvaluation e)
{
  const SamBody      body      = SamEvaluationBody(e);
  const SamBodyPlace last      = SamBodyAt(body, INFINITY);
  const PetscInt     materials = last.number + (isinf(last.young) ? 0 : 1);
  SamBodyPlace       place     = SamBodyAt(body, 0);

  PetscFunctionBegin;
  PetscCheck(e->materials == 1 || e->materials == materials || !e->cycle, e->comm, SAM_ERR_USER,
             "-fatigue: lists of %" PetscInt_FMT " constants for %" PetscInt_FMT " materials in depth: " SAM_ONE_EACH,
             e->materials, materials);
  for (PetscInt m = 0; m < (e->materials > 1 ? materials : 1); m++, place = SamBodyBelow(body, place)) {
    const double yield = (double)e->constants[m].yield;
    const double young = (double)place.young;
    char         why[160];

    SamExplainStress(yield, young, SAM_LEAST_CONSTANT, SAM_MOST_STRENGTH, why, sizeof(why));
    PetscCheck(!why[0], e->comm, SAM_ERR_USER, "-fatigue_yield %.6g: %s", yield, why);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the shape of the results, and their coordinates; a section has one y or one x. */
static PetscErrorCode SetLayout(SamEvaluation e)
{
  const SamGrid    g   = e->grid;
  const PetscBool  row = e->section && e->axis == SAM_SECTION_X, column = e->section && e->axis == SAM_SECTION_Y;
  SamStressLayout *l = &e->layout;

  PetscFunctionBegin;
  l->section     = e->section;
  l->own         = e->slide ? PETSC_TRUE : PETSC_FALSE;
  l->cycle       = e->cycle;
  l->n[SAM_TIME] = e->source.steps;
  l->n[SAM_Z]    = e->average ? 1 : e->depths;
  l->n[SAM_Y]    = row ? 1 : g->ny;
  l->n[SAM_X]    = column ? 1 : g->nx;
  l->row         = e->section ? 0 : g->row_start;
  l->rows        = e->section ? l->n[SAM_Y] : g->rows;
  l->memory      = (e->section ? SamLinesMemory(e) : SamMapsMemory(e)) + SamStressPartsBytes(e->parts);
  for (int d = 0; d < SAM_STRESS_AXES; d++) {
    PetscCall(PetscMalloc1(l->n[d] + 1, &e->coordinate[d]));
    l->coordinate[d] = e->coordinate[d];
  }
  for (PetscInt k = 0; k < l->n[SAM_TIME]; k++)
    PetscCall((*e->source.number)(e->source.context, k, SAM_STEP_TIME, &e->coordinate[SAM_TIME][k]));
  for (PetscInt k = 0; k < l->n[SAM_Z]; k++) e->coordinate[SAM_Z][k] = e->average ? 0 : (double)e->depth[k];
  for (PetscInt k = 0; k < l->n[SAM_Y]; k++) e->coordinate[SAM_Y][k] = (double)SamGridY(g, row ? e->index : k);
  for (PetscInt k = 0; k < l->n[SAM_X]; k++) e->coordinate[SAM_X][k] = (double)SamGridX(g, column ? e->index : k);
  SamQuantitiesList(e);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the parts of the stresses besides those by tractions. */
static PetscErrorCode CreateParts(SamEvaluation e)
{
  PetscBool wanted[SAM_STRESS_PART_TYPES] = {PETSC_FALSE};

  PetscFunctionBegin;
  e->places = (SamStressPlaces){.grid    = e->grid,
                                .body    = e->body,
                                .section = e->section,
                                .axis    = e->axis,
                                .index   = e->index,
                                .length  = e->axis == SAM_SECTION_X ? e->grid->nx : e->grid->ny,
                                .depths  = e->depths,
                                .depth   = e->depth,
                                .side    = e->side,
                                .passing = e->passing,
                                .moves   = e->slide ? PETSC_TRUE : PETSC_FALSE};
  for (PetscInt q = 0; SamQuantityTable[q].name; q++)
    if (SamQuantityTable[q].of_part) wanted[SamQuantityTable[q].of_part - 1] = e->wants[q];
  for (PetscInt q = 0; SamQuantityTable[q].name; q++)
    PetscCheck(!e->wants[q] || !SamQuantityTable[q].elastic || !SamElasticityRemembers(e->source.bodies), e->comm,
               SAM_ERR_USER, "%s: its strains are not those of elastic bodies, as the bodies of %s relax: omit it",
               SamQuantityTable[q].with ? SamQuantityTable[q].with : SamQuantityTable[q].name, e->source.name);
  PetscCall(
    SamStressPartsCreate(&e->source, &e->places, SamProblemGetConditions(e->problem), e->control, wanted, &e->parts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetUp(SamEvaluation e, const SamStressSource *source)
{
  PetscFunctionBegin;
  e->source          = *source;
  e->source.settings = e->settings;
  PetscCall(SamElasticityReference(source->bodies));
  e->grid = SamElasticityGetGrid(source->bodies);
  PetscCall(CreateStress(e));
  PetscCall(CheckConstants(e));
  PetscCall(SamAverageSetUp(e));
  PetscCall(SamDepthsSetUp(e));
  PetscCall(CheckCycle(e));
  PetscCall(FindLine(e));
  PetscCall(SamProblemCreate(e->source.bodies, &e->problem));
  PetscCall(PetscCalloc1(e->source.steps, &e->control));
  for (PetscInt k = 0; k < e->source.steps; k++)
    PetscCall((*e->source.conditions)(e->source.context, k, SamProblemGetConditions(e->problem), &e->control[k]));
  PetscCall(SamPointsSetUp(e));
  PetscCall(CreateParts(e));
  PetscCall(SetLayout(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the work ---- */

PetscErrorCode SamEvaluationCompute(SamEvaluation e, SamEvaluationWrite write, void *context)
{
  PetscFunctionBegin;
  PetscCall(SamLargestClear(e));
  if (e->cycle && e->source.steps > 1) PetscCall(SamCycleCheckClosed(e)); /* one step: travelling points */
  e->write         = write;
  e->write_context = context;
  PetscCall(SamStressPartsPrepare(e->parts));
  PetscCall(e->section ? SamLinesCompute(e) : SamMapsCompute(e));
  PetscCall(SamLargestAgree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamStressLayout *SamEvaluationGetLayout(SamEvaluation e)
{
  return &e->layout;
}

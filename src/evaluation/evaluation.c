/* The stresses under the tractions of load steps: settings, steps, and the order of the work. */
#include "evaluationimpl.h"

/* The least depth, in cells: at smaller ones the kernels equal those of the surface but for rounding. */
#define LEAST_DEPTH 1e-6
#define MOST_DEPTH  1e6  /* widths of the grid */
#define ROUNDING    1e-9 /* of a depth, within which it is that of an interface */

/* ---- life ---- */

PetscErrorCode SamEvaluationCreate(MPI_Comm comm, SamEvaluation *evaluation)
{
  const PetscReal surface = 0;
  SamEvaluation   e;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&e));
  *evaluation  = e;
  e->comm      = comm;
  e->body      = 2;
  e->materials = 1;
  e->dash      = "";
  PetscCall(SamEvaluationSetDepths(e, 1, &surface));
  e->wants[SAM_QUANTITY_STRESS] = e->wants[SAM_QUANTITY_MISES] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationDestroy(SamEvaluation *evaluation)
{
  SamEvaluation e = *evaluation;

  PetscFunctionBegin;
  *evaluation = NULL;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStressDestroy(&e->stress));
  PetscCall(SamElasticityDestroy(&e->elasticity));
  PetscCall(PetscFree2(e->depth, e->side));
  PetscCall(PetscFree(e->weight));
  PetscCall(PetscFree(e->depths_text));
  PetscCall(PetscFree(e->largest));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- settings ---- */

PetscErrorCode SamEvaluationSetBody(SamEvaluation e, PetscInt body)
{
  PetscFunctionBegin;
  PetscCheck(body == 1 || body == 2, e->comm, SAM_ERR_USER, "%sbody %" PetscInt_FMT ": expected 1 or 2", e->dash, body);
  e->body = body;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationGetBody(SamEvaluation e, PetscInt *body)
{
  PetscFunctionBegin;
  *body = e->body;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationTakeDepths(SamEvaluation e, const char said[], PetscInt n, const PetscReal depths[],
                                       const int sides[])
{
  PetscFunctionBegin;
  PetscCheck(n > 0, e->comm, SAM_ERR_USER, "%s: expected at least one depth", said);
  for (PetscInt k = 0; k < n; k++) {
    PetscCheck(depths[k] >= 0 && depths[k] < PETSC_INFINITY, e->comm, SAM_ERR_USER,
               "%s: %.6g is above the surface: expected numbers >= 0", said, (double)depths[k]);
    PetscCheck(!k || depths[k] > depths[k - 1] || (depths[k] == depths[k - 1] && sides && sides[k] > sides[k - 1]),
               e->comm, SAM_ERR_USER, "%s: %.6g follows %.6g: expected depths that increase", said, (double)depths[k],
               (double)depths[k - 1]);
  }
  PetscCall(PetscFree2(e->depth, e->side));
  PetscCall(PetscCalloc2(n, &e->depth, n, &e->side));
  PetscCall(PetscArraycpy(e->depth, depths, n));
  if (sides) PetscCall(PetscArraycpy(e->side, sides, n));
  e->depths = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetDepths(SamEvaluation e, PetscInt n, const PetscReal depths[])
{
  PetscFunctionBegin;
  PetscCall(SamEvaluationTakeDepths(e, "depths", n, depths, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetSection(SamEvaluation e, SamSectionAxis axis, PetscReal place)
{
  PetscFunctionBegin;
  e->section = PETSC_TRUE;
  e->axis    = axis;
  e->place   = place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetPassing(SamEvaluation e, PetscBool passing)
{
  PetscFunctionBegin;
  e->passing = passing;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetQuantities(SamEvaluation e, const PetscBool wants[SAM_QUANTITIES])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(e->wants, wants, SAM_QUANTITIES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetFatigueConstants(SamEvaluation e, PetscInt n, const SamFatigueConstants constants[])
{
  PetscFunctionBegin;
  PetscCheck(n > 0 && n <= SAM_LAYERS + 1, e->comm, PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " sets of constants", n);
  PetscCall(PetscArraycpy(e->constants, constants, n));
  e->materials = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetElasticity(SamEvaluation e, SamElasticity elasticity, const SamFourierSettings *settings,
                                          const char source[])
{
  PetscFunctionBegin;
  PetscCall(SamElasticityReference(elasticity));
  PetscCall(SamStressDestroy(&e->stress));
  PetscCall(SamElasticityDestroy(&e->elasticity));
  e->elasticity = elasticity;
  e->settings   = settings;
  e->of         = source;
  PetscCall(SamElasticityGetGrid(elasticity, &e->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetMonitor(SamEvaluation e, SamEvaluationMonitor monitor, void *context)
{
  PetscFunctionBegin;
  e->monitor         = monitor;
  e->monitor_context = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

PetscErrorCode SamEvaluationSetSource(SamEvaluation e, const SamEvaluationSource *source)
{
  PetscFunctionBegin;
  e->source = *source;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- set-up ---- */

static PetscErrorCode CheckDepths(SamEvaluation e)
{
  const PetscReal side = e->grid->side[0];

  PetscFunctionBegin;
  PetscCheck(e->depth[e->depths - 1] <= MOST_DEPTH * 2 * e->grid->length, e->comm, SAM_ERR_USER,
             "%sdepths: %.6g m is more than %.6g times the width of the grid: check the unit, m", e->dash,
             (double)e->depth[e->depths - 1], MOST_DEPTH);
  for (PetscInt k = 0; k < e->depths; k++)
    PetscCheck(e->depth[k] == 0 || e->depth[k] >= LEAST_DEPTH * side, e->comm, SAM_ERR_USER,
               "%sdepths: %.6g m is less than a millionth of a cell (%.6g m): the surface is 0", e->dash,
               (double)e->depth[k], (double)side);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamLayers *SamLayerAt(SamEvaluation e, PetscInt depth, PetscInt *layer)
{
  const SamPair   *pair;
  const SamLayers *layers;

  PetscCallAbort(e->comm, SamElasticityGetPair(e->elasticity, &pair));
  layers = &pair->layers[e->body - 1];
  *layer = SamLayersAt(layers, e->depth[depth]);
  return layers;
}

/* The number of the layer whose bottom is at a depth, but for rounding; the number of layers: none. */
static PetscInt InterfaceAt(const SamLayers *layers, PetscReal depth)
{
  PetscInt n = 0;

  while (n < layers->count && PetscAbsReal(depth - SamLayersDepth(layers, n + 1)) > ROUNDING * depth) n++;
  return n;
}

/* At an interface the depth itself stands for the side above, the next number for that below; none is said: both. */
static PetscErrorCode SplitInterfaces(SamEvaluation e)
{
  const SamPair   *pair;
  const SamLayers *layers;
  PetscReal       *depth;
  int             *side;
  PetscInt         n = 0;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetPair(e->elasticity, &pair));
  layers = &pair->layers[e->body - 1];
  PetscCall(PetscMalloc2(2 * e->depths, &depth, 2 * e->depths, &side));
  for (PetscInt k = 0; k < e->depths; k++) {
    const PetscInt  interface = InterfaceAt(layers, e->depth[k]);
    const PetscReal bottom    = SamLayersDepth(layers, PetscMin(interface + 1, layers->count));
    const PetscBool rigid     = (PetscBool)(interface == layers->count - 1 && isinf(pair->young[e->body - 1]));

    PetscCheck(!e->side[k] || interface < layers->count, e->comm, SAM_ERR_USER,
               "%sdepths: %.6g%c names a side of an interface, and there is none: omit the sign", e->dash,
               (double)e->depth[k], e->side[k] < 0 ? '-' : '+');
    PetscCheck(!layers->count || !isinf(pair->young[e->body - 1]) ||
                 (interface < layers->count ? !rigid || e->side[k] <= 0 : e->depth[k] < bottom),
               e->comm, SAM_ERR_USER, "%sdepths: %.6g m is in the rigid base, which begins at %.6g m", e->dash,
               (double)e->depth[k], (double)SamLayersDepth(layers, layers->count));
    for (int s = -1; s <= 1; s += 2) {
      if (interface < layers->count ? e->side[k] == -s || (rigid && s > 0) : s > 0) continue;
      depth[n]  = interface == layers->count ? e->depth[k] : s < 0 ? bottom : nextafter(bottom, PETSC_INFINITY);
      side[n++] = interface == layers->count ? 0 : s;
    }
  }
  PetscCall(PetscFree2(e->depth, e->side));
  e->depth  = depth;
  e->side   = side;
  e->depths = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
  PetscCheck(row || g->ny > 1, e->comm, SAM_ERR_USER,
             "%ssection x=%.6g: a plane problem has no section along y: give y=0, or omit it", e->dash,
             (double)e->place);
  PetscCheck(at >= -0.5 - 1e-9 && at <= (PetscReal)n - 0.5 + 1e-9, e->comm, SAM_ERR_USER,
             "%ssection %s=%.6g: outside of the grid, which reaches from %.6g to %.6g m", e->dash, row ? "y" : "x",
             (double)e->place, (double)(first - 0.5 * step), (double)(first + ((PetscReal)n - 0.5) * step));
  e->index = (PetscInt)PetscMin(PetscMax(PetscFloorReal(at + 0.5), 0), (PetscReal)n - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stresses of the body that is asked for. */
static PetscErrorCode CreateStress(SamEvaluation e)
{
  const SamPair      *pair;
  SamElasticityTraits traits;
  SamElasticityType   type;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetTraits(e->elasticity, &traits));
  PetscCall(SamElasticityGetType(e->elasticity, &type));
  PetscCheck(traits.stress, e->comm, SAM_ERR_USER, "%s: stresses are not available for bodies of type %s", e->of, type);
  PetscCall(SamElasticityGetPair(e->elasticity, &pair));
  PetscCheck(!isinf(pair->young[e->body - 1]) || pair->layers[e->body - 1].count, e->comm, SAM_ERR_USER,
             "%sbody %" PetscInt_FMT ": it is rigid, so its stresses are undetermined", e->dash, e->body);
  PetscCall(SamStressDestroy(&e->stress));
  PetscCall(SamElasticityCreateStress(e->elasticity, e->body, e->settings, &e->stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A point that passes has the stresses of one step. */
static PetscErrorCode CheckPassing(SamEvaluation e)
{
  PetscFunctionBegin;
  if (!e->passing) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(SamCycleWanted(e), e->comm, SAM_ERR_USER, "%spassing is given without %sfatigue", e->dash, e->dash);
  PetscCheck(e->source.steps == 1, e->comm, SAM_ERR_USER,
             "%spassing: %" PetscInt_FMT " steps are given: a point passes under those of one: give one step", e->dash,
             e->source.steps);
  PetscCheck(!e->section || e->axis == SAM_SECTION_X, e->comm, SAM_ERR_USER,
             "%spassing: points pass along x: give a %ssection y=..., or none", e->dash, e->dash);
  PetscCheck(!e->wants[SAM_QUANTITY_RUIZ], e->comm, SAM_ERR_USER,
             "%sfatigue ruiz: needs the slip of steps, and not %spassing: omit one of them", e->dash, e->dash);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Constants of fatigue are the same everywhere, or each layer's and the substrate's. */
static PetscErrorCode CheckConstants(SamEvaluation e)
{
  const SamPair *pair;
  PetscInt       materials;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetPair(e->elasticity, &pair));
  materials = pair->layers[e->body - 1].count + !isinf(pair->young[e->body - 1]);
  PetscCheck(e->materials == 1 || e->materials == materials || !SamCycleWanted(e), e->comm, SAM_ERR_USER,
             "%sfatigue: lists of %" PetscInt_FMT " constants for %" PetscInt_FMT
             " materials in depth: give one number, or one for each layer and the substrate",
             e->dash, e->materials, materials);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetUp(SamEvaluation e)
{
  PetscFunctionBegin;
  PetscCheck(e->elasticity, e->comm, PETSC_ERR_ORDER, "An evaluation without elasticity");
  PetscCall(CreateStress(e));
  PetscCall(CheckConstants(e));
  PetscCall(SamAverageSetUp(e));
  PetscCall(SplitInterfaces(e));
  PetscCall(CheckPassing(e));
  PetscCheck(e->source.steps > 1 || e->passing || !SamCycleWanted(e), e->comm, SAM_ERR_USER,
             "%sfatigue needs the steps of a cycle, two at least, and not %" PetscInt_FMT ": give more, or %spassing",
             e->dash, e->source.steps, e->dash);
  PetscCheck(!e->wants[SAM_QUANTITY_RUIZ] || e->depth[0] == 0, e->comm, SAM_ERR_USER,
             "%sfatigue ruiz: it is defined on the surface: 0 must be one of %sdepths", e->dash, e->dash);
  PetscCall(CheckDepths(e));
  PetscCall(FindLine(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the work ---- */

PetscErrorCode SamEvaluationTell(SamEvaluation e, const char work[], double part, double whole)
{
  PetscFunctionBegin;
  if (e->monitor) PetscCall((*e->monitor)(e->monitor_context, work, part, whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLargestAgree(MPI_Comm comm, double *value, int n, double place[])
{
  const double mine = *value;
  PetscBool    here;

  PetscFunctionBegin;
  PetscCall(SamMax(comm, 1, value));
  here = (PetscBool)(mine == *value);
  for (int k = 0; k < n; k++) {
    double least = here ? -place[k] : -INFINITY;

    PetscCall(SamMax(comm, 1, &least));
    here     = (PetscBool)(here && place[k] == -least);
    place[k] = -least;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* No largest value has been found yet. */
static PetscErrorCode ClearLargest(SamEvaluation e)
{
  const SamLargestPoint none = {-INFINITY, 0};
  const SamLargest      edge = {-INFINITY, {0, 0, 0}};

  PetscFunctionBegin;
  PetscCall(PetscFree(e->largest));
  PetscCall(PetscMalloc1(e->source.steps, &e->largest));
  for (PetscInt s = 0; s < e->source.steps; s++) {
    SamStepLargest *const of = &e->largest[s];

    *of = (SamStepLargest){.mises = none, .principal = none, .edge = {edge, edge}};
    for (PetscInt n = 0; n <= SAM_LAYERS; n++) of->layer[n] = none;
    for (PetscInt n = 0; n < 2 * SAM_LAYERS; n++) of->interface[n / 2][n % 2] = none;
  }
  for (PetscInt q = 0; q < SAM_QUANTITIES; q++) e->fatigue[q] = none;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationCompute(SamEvaluation e, SamEvaluationWrite write, void *context)
{
  PetscInt layers;

  PetscFunctionBegin;
  PetscCall(SamEvaluationSetUp(e));
  PetscCall(ClearLargest(e));
  PetscCall(SamEvaluationGetLayers(e, &layers));
  e->write         = write;
  e->write_context = context;
  PetscCall(e->section ? SamLinesCompute(e) : SamMapsCompute(e));
  for (PetscInt s = 0; s < e->source.steps; s++) {
    SamStepLargest *const of = &e->largest[s];

    PetscCall(SamLargestAgree(e->comm, &of->mises.value, 1, &of->mises.point));
    PetscCall(SamLargestAgree(e->comm, &of->principal.value, 1, &of->principal.point));
    for (int k = 0; k < 2; k++) PetscCall(SamLargestAgree(e->comm, &of->edge[k].value, 2, of->edge[k].place));
    for (PetscInt n = 0; n <= layers; n++)
      PetscCall(SamLargestAgree(e->comm, &of->layer[n].value, 1, &of->layer[n].point));
    for (PetscInt n = 0; n < 2 * layers; n++)
      PetscCall(SamLargestAgree(e->comm, &of->interface[n / 2][n % 2].value, 1, &of->interface[n / 2][n % 2].point));
  }
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++)
    if (e->wants[q]) PetscCall(SamLargestAgree(e->comm, &e->fatigue[q].value, 1, &e->fatigue[q].point));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- queries ---- */

PetscErrorCode SamEvaluationGetLayout(SamEvaluation e, SamStressLayout *layout)
{
  static const PetscReal surface = 0;

  PetscFunctionBegin;
  *layout = (SamStressLayout){.steps   = e->source.steps,
                              .depths  = e->average ? 1 : e->depths,
                              .depth   = e->average ? &surface : e->depth,
                              .section = e->section,
                              .axis    = e->axis,
                              .index   = e->index};
  PetscCall(PetscArraycpy(layout->wants, e->wants, SAM_QUANTITIES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationGetMemory(SamEvaluation e, double *bytes)
{
  PetscFunctionBegin;
  *bytes = e->section ? SamLinesMemory(e) : SamMapsMemory(e);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationHasCycle(SamEvaluation e, PetscBool *has)
{
  PetscFunctionBegin;
  *has = SamCycleWanted(e);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The value and the place of a point; NaN where there is none. */
static SamLargest PlaceOf(SamEvaluation e, const SamLargestPoint *of)
{
  const SamGrid   g   = e->grid;
  const PetscBool row = e->section && e->axis == SAM_SECTION_X, column = e->section && e->axis == SAM_SECTION_Y;
  const double    nx = column ? 1 : (double)g->nx, ny = row ? 1 : (double)g->ny;
  const double    plane = floor(of->point / (nx * ny)), j = floor((of->point - plane * nx * ny) / nx);
  const double    i = of->point - (plane * ny + j) * nx;

  if (of->value == -INFINITY) return (SamLargest){NAN, {NAN, NAN, NAN}};
  return (SamLargest){of->value,
                      {(double)SamGridX(g, column ? e->index : (PetscInt)i),
                       (double)SamGridY(g, row ? e->index : (PetscInt)j), (double)e->depth[(PetscInt)plane]}};
}

PetscErrorCode SamEvaluationGetLargest(SamEvaluation e, SamQuantity quantity, PetscInt step, SamLargest *largest)
{
  PetscFunctionBegin;
  *largest = PlaceOf(e, SamQuantityIsOfCycle(quantity)   ? &e->fatigue[quantity]
                        : quantity == SAM_QUANTITY_MISES ? &e->largest[step].mises
                                                         : &e->largest[step].principal);
  if (SamQuantityIsOfCycle(quantity) && e->average && !isnan(largest->value)) largest->place[2] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationGetLayers(SamEvaluation e, PetscInt *layers)
{
  const SamPair *pair;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetPair(e->elasticity, &pair));
  *layers = pair->layers[e->body - 1].count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationGetLayerLargest(SamEvaluation e, PetscInt layer, PetscInt step, SamLargest largest[3])
{
  const SamStepLargest *of = &e->largest[step];

  PetscFunctionBegin;
  largest[0] = PlaceOf(e, &of->layer[layer]);
  for (int k = 0; k < 2; k++)
    largest[1 + k] = PlaceOf(e, layer < SAM_LAYERS ? &of->interface[layer][k] : &(SamLargestPoint){-INFINITY, 0});
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationGetEdgeLargest(SamEvaluation e, PetscInt step, SamLargest largest[2], PetscBool *lost)
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    largest[k] = e->largest[step].edge[k];
    if (largest[k].value == -INFINITY) largest[k] = (SamLargest){NAN, {NAN, NAN, NAN}};
  }
  *lost = e->largest[step].edge_lost;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The law of plastic strain: bodies that yield below their surface.

  The equations of a step are solved in plasticnewton.c. The law's offset is the displacement by the plastic strain of
  the state, so that the gap, the check and all other functions include it; the internal variables of the layers' cells
  are fields of the state. A solved step is checked independently, from the state and the tractions: the stress by both
  lies on the yield surface where the plastic strain has grown, and nowhere outside of it.
*/
#include "equations.h"
#include <petsam/private/state.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/control.h>
#include <petsam/private/elasticity.h>
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */

typedef struct {
  PetscReal    yield;
  char         hardens[SAM_HARDENING_TEXT]; /* value of the option, in one of SAM_HARDENING_FORMS */
  SamHardening hardening;
  PetscInt     count; /* number of values in `back`: C, g, C, g ... */
  PetscReal    back[2 * SAM_BACKSTRESSES];
  double      *initial; /* stress before any load, xx and yy of each layer (Pa); NULL: none */
} Material;

typedef struct {
  Material         material[2];
  PetscReal        depth, first, rtol; /* m, m, 1; depth and first: 0 if they follow from the grid */
  PetscInt         layers;
  PetscReal       *thickness; /* thickness of each layer, m */
  SamPlastic       plastic;
  PetscBool        stressed;  /* true: `stress` is known; a rank without cells has no array */
  double          *stress;    /* by the strain of a vector at a revision, for the results */
  Vec              stress_of; /* this vector */
  PetscObjectState stress_revision;
} Plastic;

/* Memory of a layer's cell without backstresses, bytes; measured at 64 and 96 cells per side: 880 to 910,
   if the cells that yield are a third of all */
#define BYTES 950
/* The check fails if the excess is larger, relative to the yield stress or in tolerances. */
#define EXCESS 1e-5
#define MARGIN 10
/* A smaller growth of the plastic strain in a step counts as none. */
#define GROWTH 1e-6
/* Parts of a step's work in its error; see SumWork() */
#define TURNS 0.01
#define BACK  0.05
/* A plastic strain below this part of the maximum does not count for the extent. */
#define COUNTS 0.01
/* Largest depth that may yield, relative to the width of the grid */
#define LOOSEST 0.05 /* largest tolerance of the plastic strain */
#define DEEPEST 2

/* The fields of the depth removed of each body up to which the strain has been moved */
static const char *const removed[2] = {"plastic_removed1", "plastic_removed2"};
static const char *const depths[2]  = {"wear_depth1", "wear_depth2"};

/* The numbers of a step, in this order from MOST on */
typedef enum {
  MOST,
  CELLS,
  WORK,
  ENERGY,
  ERROR,
  NEWTON,
  PRODUCTS,
  STILL,
  LAYERS,
  LEFT,
  THICK,
  OUTSIDE,
  UNSURE,
  DENT,
  SURFACE,
  NUMBERS
} Number;
/* Those that depend on the strain alone, and are found anew only where it grows */
static const Number OF_STRAIN[] = {LAYERS, LEFT, SURFACE};

#define REAL_ROW(body, option, text, what, range_, ...) \
  { \
    "body" #body "_" option, text, SAM_OPTION_REAL, offsetof(Plastic, material[body - 1].what), \
      .range = (range_), .recorded = PETSC_TRUE, __VA_ARGS__ \
  }
#define MATERIAL_ROWS(body) \
  REAL_ROW(body, "yield", "yield stress: the body yields below its surface", yield, SAM_RANGE_POSITIVE_INF, \
           .unit = "Pa"), \
  { \
    "body" #body "_hardening", "hardening: " SAM_HARDENING_FORMS " (H, Q in Pa)", SAM_OPTION_STRING, \
      offsetof(Plastic, material[body - 1].hardens), .size = SAM_HARDENING_TEXT, .needs = "body" #body "_yield" \
  }

#define YIELDING .needs = "body1_yield or -body2_yield"

static const SamOptionRow rows[] = {
  MATERIAL_ROWS(1),
  MATERIAL_ROWS(2),
  {"yield_depth", "depth below the surface that may yield, 0: the grid's width", SAM_OPTION_REAL,
   offsetof(Plastic, depth), .range = SAM_RANGE_NONNEGATIVE, .unit = "m", .recorded = PETSC_TRUE, YIELDING},
  {"yield_layers", "layers of this depth, thicker from the surface down", SAM_OPTION_INT, offsetof(Plastic, layers),
   .least = 2, .most = 1000, YIELDING},
  {"yield_first", "thickness of the first layer, 0: half a cell", SAM_OPTION_REAL, offsetof(Plastic, first),
   .range = SAM_RANGE_NONNEGATIVE, .unit = "m", .recorded = PETSC_TRUE, YIELDING},
  {"yield_rtol", "tolerance of the plastic strain, relative to the strain at yield", SAM_OPTION_REAL,
   offsetof(Plastic, rtol), .range = SAM_RANGE_PART, YIELDING, .loosest = LOOSEST,
   .beyond = "the plastic work is wrong by per cents"}};

static const char *const hardened[2]   = {"body1_hardening", "body2_hardening"};
static const char *const backstress[2] = {"body1_backstress", "body2_backstress"};
static const char *const yielding[2]   = {"body1_yield", "body2_yield"};

/* Returns the number of values stored per cell of a layer. */
static PetscInt SizeOf(const Plastic *x)
{
  return PARTS + 1 + PARTS * PetscMax(x->material[0].count, x->material[1].count) / 2;
}

static PetscInt BodiesOf(const Plastic *x)
{
  return (isfinite(x->material[0].yield) != 0) + (isfinite(x->material[1].yield) != 0);
}

/*
  Sets the thicknesses of the layers. Values that are not given follow from the grid, since it fits the contact: the
  depth is its smaller width, or for periodic bodies the larger one, and the first layer is half a cell thick. A grid
  with half the cells of another one has half the layers.
*/
static PetscErrorCode SetLayers(Plastic *x, const SamLaw law, const SamOptions *from)
{
  const SamGrid   grid     = law->grid;
  const PetscBool periodic = SamElasticityGetTraits(law->elasticity).periodic, row = SamGridIsRow(grid);
  const PetscReal x_width = grid->width[0], y_width = row ? x_width : grid->width[1],
                  width = periodic ? PetscMax(x_width, y_width) : PetscMin(x_width, y_width);

  PetscFunctionBegin;
  PetscCheck(x->depth <= DEEPEST * width, from->comm, SAM_ERR_USER,
             "-%syield_depth %.6g: at most %d times the width of the grid, %.6g m, can yield: check the unit",
             SamOptionsPrefix(from), (double)x->depth, DEEPEST, (double)width);
  if (x->depth == 0) x->depth = width;
  for (SamGrid fine = grid->fine; fine; fine = fine->fine) {
    x->layers = (x->layers + 1) / 2;
    x->first *= 2;
  }
  if (x->first == 0) x->first = PetscMin(grid->side[0] / 2, x->depth / (PetscReal)x->layers);
  PetscCheck(x->first <= x->depth / (PetscReal)x->layers * (1 + 1e-9), from->comm, SAM_ERR_USER,
             "-%syield_first %.6g: the first layer is the thinnest: at most -yield_depth over -yield_layers, "
             "%.6g m",
             SamOptionsPrefix(from), (double)x->first, (double)x->depth / (double)x->layers);
  PetscCall(PetscFree(x->thickness));
  PetscCall(PetscMalloc1(x->layers, &x->thickness));
  SamPlasticGrade(x->layers, x->first, x->depth, x->thickness);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the depth at which the layers of plastic strain of body 0 or 1 begin: below layers of other materials, m. */
static PetscReal TopOf(SamLaw law, PetscInt body)
{
  return SamBodyAt(SamPairBody(SamElasticityGetPair(law->elasticity), body), INFINITY).top;
}

static PetscErrorCode CheckStress(SamLaw law, const SamOptions *from, PetscInt body, const char option[], double stress,
                                  double most)
{
  const SamPair pair  = SamElasticityGetPair(law->elasticity);
  const double  young = (double)SamBodyAt(SamPairBody(pair, body), INFINITY).young;
  char          why[160];

  PetscFunctionBegin;
  SamExplainStress(stress, young, SAM_LEAST_CONSTANT, most, why, sizeof(why));
  PetscCheck(!why[0], from->comm, SAM_ERR_USER, "-%s%s %.6g: %s", SamOptionsPrefix(from), option, stress, why);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects constants of a yielding body that are likely to be in other units. */
static PetscErrorCode CheckUnits(SamLaw law, const SamOptions *from, PetscInt body)
{
  static const char *const slope[2]  = {"body1_hardening: H =", "body2_hardening: H ="};
  static const char *const growth[2] = {"body1_hardening: Q =", "body2_hardening: Q ="};
  const Plastic *const     x         = (const Plastic *)law->data;
  const Material *const    m         = &x->material[body];
  const double             first     = m->hardening.constant[0];

  PetscFunctionBegin;
  PetscCall(CheckStress(law, from, body, yielding[body], (double)m->yield, SAM_MOST_STRENGTH));
  if (m->hardening.type == SAM_HARDENING_LINEAR) PetscCall(CheckStress(law, from, body, slope[body], first, INFINITY));
  if (m->hardening.type == SAM_HARDENING_VOCE)
    PetscCall(CheckStress(law, from, body, growth[body], first, SAM_MOST_STRENGTH));
  for (PetscInt k = 0; k < m->count; k += 2)
    PetscCall(CheckStress(law, from, body, backstress[body], (double)m->back[k], INFINITY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the stress before any load, as means over the layers; it must be below yield. */
static PetscErrorCode SetInitial(SamLaw law, const SamOptions *from, PetscInt body)
{
  Plastic *const  x   = (Plastic *)law->data;
  Material *const m   = &x->material[body];
  const SamBody   of  = SamPairBody(SamElasticityGetPair(law->elasticity), body);
  PetscReal       top = TopOf(law, body);

  PetscFunctionBegin;
  PetscCall(PetscFree(m->initial));
  if (!SamBodyHasInitialStress(of)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * x->layers, &m->initial));
  for (PetscInt l = 0; l < x->layers; top += x->thickness[l++]) {
    double *const s = m->initial + 2 * l;
    double        mises;

    SamBodyMeanInitialStress(of, (double)top, (double)x->thickness[l], s);
    mises = sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1]);
    PetscCheck(mises < (double)m->yield, from->comm, SAM_ERR_USER,
               "-%sbody%d_initial_stress: the von Mises stress at depth %.6g m, %.6g Pa, is not below the yield stress "
               "%.6g Pa",
               SamOptionsPrefix(from), (int)body + 1, (double)(top + x->thickness[l] / 2), mises, (double)m->yield);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  Plastic *const x = (Plastic *)law->data;

  PetscFunctionBegin;
  *asked = PETSC_FALSE;
  for (PetscInt b = 0; b < 2; b++) {
    Material          *m     = &x->material[b];
    const SamOptionRow pairs = {backstress[b], "pairs C, g of backstresses, C in Pa", SAM_OPTION_REAL,
                                .range = SAM_RANGE_NONNEGATIVE, .size = 2 * SAM_BACKSTRESSES};

    PetscCall(SamOptionsReals(from, &pairs, m->back, &m->count));
    PetscCheck(m->count % 2 == 0, from->comm, SAM_ERR_USER, "-%s%s: %" PetscInt_FMT " numbers: expected pairs C,g",
               SamOptionsPrefix(from), backstress[b], m->count);
    PetscCall(SamOptionsNeed(from, m->count > 0 && !SamPrintHelp(), backstress[b], yielding[b]));
    PetscCall(SamHardeningRead(from, hardened[b], m->hardens, &m->hardening));
    if (!isfinite(m->yield)) continue;
    *asked      = PETSC_TRUE;
    law->option = yielding[b];
  }
  law->bytes = BYTES * x->layers * BodiesOf(x);
  PetscCall(SetLayers(x, law, from));
  for (PetscInt b = 0; b < 2; b++) {
    if (!isfinite(x->material[b].yield)) continue;
    PetscCall(SamResidualCheckBodies(law->elasticity, b + 1));
    PetscCall(CheckUnits(law, from, b));
    PetscCall(SetInitial(law, from, b));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *parameters)
{
  const Plastic  *x      = (const Plastic *)law->data;
  const PetscReal layers = (PetscReal)x->layers;

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(parameters, "yield_layers", PETSC_TRUE, 1, &layers));
  for (PetscInt b = 0; b < 2; b++) {
    const Material *m = &x->material[b];
    char            hardening[SAM_HARDENING_TEXT];

    SamHardeningWrite(&m->hardening, hardening, sizeof(hardening));
    PetscCall(SamParametersAddText(parameters, hardened[b], PETSC_TRUE, hardening));
    if (m->count) PetscCall(SamParametersAddReals(parameters, backstress[b], PETSC_TRUE, m->count, m->back));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the operators ---- */

static SamMises MaterialOf(const Material *from, SamBodyPlace elastic)
{
  SamMises m = {.shear        = (double)elastic.young / (2 * (1 + (double)elastic.poisson)),
                .yield        = (double)from->yield,
                .hardening    = from->hardening,
                .backstresses = from->count / 2};

  for (PetscInt k = 0; k < from->count; k++) m.back[k / 2][k % 2] = (double)from->back[k];
  return m;
}

static PetscErrorCode SetUp(SamLaw law)
{
  Plastic *const x    = (Plastic *)law->data;
  SamPlastic    *p    = &x->plastic;
  const SamPair  pair = SamElasticityGetPair(law->elasticity);

  PetscFunctionBegin;
  if (p->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  *p = (SamPlastic){
    .grid = law->grid, .elasticity = law->elasticity, .layers = x->layers, .size = SizeOf(x), .rtol = x->rtol};
  p->thickness = x->thickness;
  for (PetscInt b = 0; b < 2; b++) {
    SamPlasticBody *body = &p->body[p->bodies];

    if (!isfinite(x->material[b].yield)) continue;
    PetscCall(SamResidualCreate(law->elasticity, b + 1, x->layers, p->thickness, PETSC_TRUE, &p->residual[p->bodies]));
    body->body     = b;
    body->top      = TopOf(law, b);
    body->material = MaterialOf(&x->material[b], SamBodyAt(SamPairBody(pair, b), INFINITY));
    body->initial  = x->material[b].initial;
    body->first    = p->bodies++ * x->layers;
  }
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the state ---- */

/* Computes a result field: the displacement of the surface by plastic strain, or the largest strain below a cell. */
static PetscErrorCode Compute(void *owner, SamState state, PetscInt component, Vec field)
{
  const SamLaw   law   = (SamLaw)owner;
  const PetscInt cells = law->grid->cells;
  const Vec      now   = SamStateReadField(state, SamStateFindField(state, SAM_PLASTIC_FIELD));
  SamPlastic    *p     = &((Plastic *)law->data)->plastic;
  const double  *from;
  double        *to, *u, *at[3];

  PetscFunctionBegin;
  PetscCall(VecSet(field, 0));
  if (!now) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(law));
  PetscCall(PetscMalloc1(3 * cells, &u));
  for (PetscInt c = 0; c < 3; c++) at[c] = u + c * cells;
  if (component < 3) PetscCall(SamPlasticDisplace(p, now, at));
  PetscCall(VecGetArrayRead(now, &from));
  PetscCall(VecGetArray(field, &to));
  for (PetscInt k = 0; k < cells; k++) {
    SamMisesAt of;

    for (PetscInt l = 0; component == 3 && l < p->bodies * p->layers; l++) {
      SamPlasticRead(p, from, l, k, &of);
      to[k] = PetscMax(to[k], of.p);
    }
    if (component < 3) to[k] = at[component][k];
  }
  PetscCall(VecRestoreArray(field, &to));
  PetscCall(VecRestoreArrayRead(now, &from));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the layers of body 1. */
static PetscInt Above(const Plastic *x)
{
  return isfinite(x->material[0].yield) ? x->layers : 0;
}

static PetscErrorCode DropStress(Plastic *x)
{
  PetscFunctionBegin;
  x->stressed = PETSC_FALSE;
  PetscCall(PetscFree(x->stress));
  PetscCall(VecDestroy(&x->stress_of));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the stress by the strain of the state, all components: it is computed once for the fields that follow each other
   in the results, and kept until the next step begins. */
static PetscErrorCode TakeStress(Plastic *x, Vec now, const double **stress)
{
  PetscObjectState revision = 0;

  PetscFunctionBegin;
  if (now) PetscCall(PetscObjectStateGet((PetscObject)now, &revision));
  if (!x->stressed || x->stress_of != now || x->stress_revision != revision) {
    PetscCall(DropStress(x));
    PetscCall(PetscMalloc1(PARTS * BodiesOf(x) * x->layers * x->plastic.grid->cells, &x->stress));
    PetscCall(SamPlasticStress(&x->plastic, now, NULL, NULL, x->stress, NULL));
    if (now) PetscCall(PetscObjectReference((PetscObject)now));
    x->stressed        = PETSC_TRUE;
    x->stress_of       = now;
    x->stress_revision = revision;
  }
  *stress = x->stress;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes a field of layers in the results: the accumulated plastic strain (0), the plastic strain (1 to PARTS), and
  the residual stress. In body 1, whose own z is opposite to that of the results, the shears xz and yz change their
  sign.
*/
static PetscErrorCode ComputeLayers(void *owner, SamState state, PetscInt component, Vec field)
{
  const SamLaw   law   = (SamLaw)owner;
  Plastic *const x     = (Plastic *)law->data;
  const PetscInt cells = law->grid->cells, layers = BodiesOf(x) * x->layers;
  const PetscInt part = (component + PARTS - 1) % PARTS, stored = component ? part : PARTS;
  const Vec      now    = SamStateReadField(state, SamStateFindField(state, SAM_PLASTIC_FIELD));
  const double  *stress = NULL, *from = NULL;
  double        *to;

  PetscFunctionBegin;
  PetscCall(VecSet(field, 0));
  if (!now && component <= PARTS) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(law));
  if (component > PARTS) PetscCall(TakeStress(x, now, &stress));
  if (now) PetscCall(VecGetArrayRead(now, &from));
  PetscCall(VecGetArray(field, &to));
  for (PetscInt m = 0; m < layers; m++) {
    const PetscBool one  = m < Above(x);
    const PetscInt  l    = one ? x->layers - 1 - m : m; /* body 1's layers are stored from its surface on */
    const PetscBool turn = one && component > 0 && (part == SAM_STRESS_XZ || part == SAM_STRESS_YZ);
    const double   *of   = stress ? stress + ((ptrdiff_t)l * PARTS + part) * cells
                                  : from + ((ptrdiff_t)l * x->plastic.size + stored) * cells;

    for (PetscInt k = 0; k < cells; k++) to[m * (ptrdiff_t)cells + k] = turn ? -of[k] : of[k];
  }
  PetscCall(VecRestoreArray(field, &to));
  if (now) PetscCall(VecRestoreArrayRead(now, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OfferLayers(SamLaw law, SamState state)
{
#define TENSOR(name, unit, text) \
  {name "xx", unit, text " xx"}, {name "yy", unit, text " yy"}, {name "zz", unit, text " zz"}, \
    {name "xy", unit, text " xy"}, {name "xz", unit, text " xz"}, \
  { \
    name "yz", unit, text " yz" \
  }
  static const char *const labels[1 + 2 * PARTS][3] = {
    {"plastic/plastic_strain", "1", "accumulated plastic strain"},
    TENSOR("plastic/plastic_strain_", "1", "plastic strain"),
    TENSOR("plastic/residual_stress_", "Pa", "stress without tractions, mean over the layer,"),
  };
  const Plastic *const x     = (const Plastic *)law->data;
  const PetscInt       count = BodiesOf(x) * x->layers;
  PetscReal           *z, top = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(count, &z));
  for (PetscInt l = 0; l < x->layers; l++) {
    const PetscReal middle = top + x->thickness[l] / 2;

    top += x->thickness[l];
    if (count > l + Above(x)) z[l + Above(x)] = TopOf(law, 1) + middle;
    if (Above(x)) z[Above(x) - 1 - l] = -TopOf(law, 0) - middle;
  }
  PetscCall(SamStateSetLayers(state, &(SamStateLayers){.group    = "plastic",
                                                       .count    = {Above(x), count - Above(x)},
                                                       .z        = z,
                                                       .stresses = PETSC_TRUE,
                                                       .initial  = PETSC_TRUE}));
  PetscCall(PetscFree(z));
  for (PetscInt k = 0; k < 1 + 2 * PARTS; k++)
    PetscCall(SamStateOffer(state, &(SamStateResult){.name      = labels[k][0],
                                                     .unit      = labels[k][1],
                                                     .text      = labels[k][2],
                                                     .kind      = SAM_FIELD_LAYERS,
                                                     .use       = SAM_RESULT_OFFERED,
                                                     .compute   = ComputeLayers,
                                                     .owner     = law,
                                                     .component = k}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Declares the depths up to which the strain has been moved, of bodies that wear: a law of wear offers its depth. */
static PetscErrorCode DeclareRemoved(SamLaw law, SamState state)
{
  const Plastic  *x = (const Plastic *)law->data;
  PetscReal       slide[2];
  const PetscBool own = SamFramesGetSlide(state, SAM_TRIED, slide); /* then depths are at the body's own points */
  PetscInt        id;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    const SamStateField field = {.name        = removed[b],
                                 .components  = 1,
                                 .generations = 2,
                                 .kept        = PETSC_TRUE,
                                 .motion      = own ? SAM_STAYS : SAM_MOVES,
                                 .separates   = PETSC_TRUE};

    if (!isfinite(x->material[b].yield) || SamStateFindResult(state, depths[b]) < 0) continue;
    PetscCheck(TopOf(law, b) == 0, law->grid->comm, SAM_ERR_USER,
               "-body%" PetscInt_FMT
               "_yield: the body has layers and wears: not supported: wear thins layers, which the "
               "elastic displacements do not follow",
               b + 1);
    PetscCall(SamStateDeclareField(state, &field, &id));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  const Plastic              *x                = (const Plastic *)law->data;
  const SamStateField         field            = {.name        = SAM_PLASTIC_FIELD,
                                                  .unit        = "1",
                                                  .text        = "plastic strain, accumulated, and backstresses",
                                                  .components  = SizeOf(x),
                                                  .generations = 2,
                                                  .kept        = PETSC_TRUE,
                                                  .layers      = BodiesOf(x) * x->layers,
                                                  .motion      = SAM_MOVES,
                                                  .separates   = PETSC_TRUE};
  static const SamStateNumber numbers[NUMBERS] = {
    {"plastic_max", "1", "maximum accumulated plastic strain", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE,
     SAM_JOIN_LAST, 1},
    {"yielding_cells", "1", "cells of layers that yield in the step", SAM_NUMBER_INT, 1, PETSC_FALSE, PETSC_TRUE,
     SAM_JOIN_LAST, 0},
    {"plastic_work", "J", "work of plastic strain", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_SUM, 2},
    {"residual_energy", "J", "elastic energy of the residual stress", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE,
     SAM_JOIN_LAST, 2},
    {"yield_error", "1", "maximum error of the yield function over the yield stress", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_GREATEST, 0},
    {"plastic_newton", "1", "steps of Newton's method for the plastic strain", SAM_NUMBER_INT, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_SUM, 0},
    {"plastic_products", "1", "operator applications of its conjugate gradients", SAM_NUMBER_INT, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_SUM, 0},
    {"steps_without_yield", "1", "steps in a row, up to this one, in which plastic strain grew by less than 1e-6",
     SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"yielded_layers", "1", "layers of a body with more than 1 % of the maximum plastic strain, the fewest",
     SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"yield_margin", "1", "layers or cells from there to the last layer or the border of the grid, the fewest",
     SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"layer_thickness", "1", "thickness of the layer that yields first over the largest half width of the contact",
     SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"yield_outside", "1", "maximum stress beyond yield below the layers or inside thick ones, over the yield stress",
     SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"plastic_work_error", "J", "estimated error of plastic_work by the length of the load step", SAM_NUMBER_REAL, 1,
     PETSC_FALSE, PETSC_TRUE, SAM_JOIN_SUM, 0},
    {"residual_z_max", "m", "maximum displacement into the bodies by plastic strain", SAM_NUMBER_REAL, 1, PETSC_TRUE,
     PETSC_TRUE, SAM_JOIN_LAST, 2},
    {"plastic_surface", "1", "maximum plastic strain of the first layer, and as much more as it exceeds the second",
     SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0}};
  static const SamStateResult fields[4] = {
    {.name = "residual_x", .unit = "m", .text = "displacement along x by plastic strain", .use = SAM_RESULT_OFFERED},
    {.name = "residual_y", .unit = "m", .text = "displacement along y by plastic strain", .use = SAM_RESULT_OFFERED},
    {.name = "residual_z",
     .unit = "m",
     .text = "displacement into the bodies by plastic strain",
     .use  = SAM_RESULT_USUAL},
    {.name = "plastic_strain",
     .unit = "1",
     .text = "maximum accumulated plastic strain below the cell",
     .use  = SAM_RESULT_USUAL}};
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareField(state, &field, &id));
  PetscCall(DeclareRemoved(law, state));
  for (PetscInt k = 0; k < NUMBERS; k++) PetscCall(SamStateDeclareNumber(state, &numbers[k], &id));
  for (PetscInt k = 0; k < 4; k++) {
    SamStateResult result = fields[k];

    result.compute   = Compute;
    result.owner     = law;
    result.component = k;
    PetscCall(SamStateOffer(state, &result));
  }
  PetscCall(OfferLayers(law, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamPlasticGetYieldStress(SamLaw law)
{
  const SamPlastic *p     = &((const Plastic *)law->data)->plastic;
  PetscReal         least = PETSC_INFINITY;

  for (PetscInt b = 0; b < p->bodies; b++)
    if (p->body[b].top == 0) least = PetscMin(least, (PetscReal)p->body[b].material.yield);
  return least;
}

static PetscBool Yields(SamLaw law, PetscInt body)
{
  return isfinite(((const Plastic *)law->data)->material[body].yield) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamPlasticGetFlow(SamLaw law, PetscReal strain, PetscReal *stress)
{
  const SamPair pair = SamElasticityGetPair(law->elasticity);

  PetscFunctionBegin;
  *stress = PETSC_INFINITY;
  for (PetscInt b = 0; b < 2; b++) {
    const Material *const own = &((const Plastic *)law->data)->material[b];
    SamMises              m;
    PetscReal             flow;

    if (!Yields(law, b)) continue;
    m    = MaterialOf(own, SamBodyAt(SamPairBody(pair, b), INFINITY));
    flow = (PetscReal)SamMisesYield(&m, (double)strain, NULL);
    for (PetscInt k = 0; k < m.backstresses; k++)
      flow += (PetscReal)(m.back[k][0] * (double)strain / (1 + m.back[k][1] * (double)strain));
    *stress = PetscMin(*stress, flow);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  SamPlastic *p = &((Plastic *)law->data)->plastic;

  PetscFunctionBegin;
  PetscCall(VecDestroy(&p->last));
  PetscCall(SamPlasticAbandon(p));
  PetscCall(SamEquationsDestroy(&p->equations));
  PetscCall(SamPlasticForget(p));
  for (PetscInt b = 0; b < p->bodies; b++) PetscCall(SamResidualDestroy(&p->residual[b]));
  for (PetscInt b = 0; b < 2; b++) PetscCall(PetscFree(((Plastic *)law->data)->material[b].initial));
  PetscCall(PetscFree(((Plastic *)law->data)->thickness));
  PetscCall(DropStress((Plastic *)law->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the bulk stress of body 0 or 1 in a step, Pa; `first`: its first condition that is not 0. */
static void GetBulk(SamLaw law, const SamControl *control, PetscInt body, double bulk[PARTS],
                    const SamCondition **first)
{
  static const struct {
    const char        *name[2];
    SamStressComponent component;
  } of[] = {{{"bulk1_stress_xx", "bulk2_stress_xx"}, SAM_STRESS_XX},
            {{"bulk1_stress_yy", "bulk2_stress_yy"}, SAM_STRESS_YY},
            {{"bulk1_stress_xy", "bulk2_stress_xy"}, SAM_STRESS_XY}};

  for (PetscInt c = 0; c < PARTS; c++) bulk[c] = 0;
  for (size_t k = 0; k < sizeof(of) / sizeof(of[0]); k++) {
    const SamCondition *one = law->conditions ? SamConditionsFind(law->conditions, of[k].name[body]) : NULL;

    if (!one) continue;
    bulk[of[k].component] = (double)SamControlGet(control, one);
    if (first && !*first && bulk[of[k].component] != 0) *first = one;
  }
}

/* Rejects bulk stress of a body that yields far away from the contact, where the strain would have no limit. */
static void CheckBulk(SamLaw law, const SamControl *control, PetscInt body, PetscInt *wrong, char why[], size_t size)
{
  const Plastic *const  x      = (const Plastic *)law->data;
  const Material *const m      = &x->material[body];
  const SamCondition   *first  = NULL;
  const SamMisesAt      virgin = {{0}, 0, {{0}}};
  double                bulk[PARTS], most = -INFINITY;
  SamMises              material;

  if (!isfinite(m->yield)) return;
  GetBulk(law, control, body, bulk, &first);
  if (!first) return;
  material = MaterialOf(m, SamBodyAt(SamPairBody(SamElasticityGetPair(law->elasticity), body), INFINITY));
  for (PetscInt l = 0; l < x->layers; l++) {
    double s[PARTS];

    for (PetscInt c = 0; c < PARTS; c++) s[c] = bulk[c];
    for (PetscInt c = 0; c < 2 && m->initial; c++) s[c] += m->initial[2 * l + c];
    most = PetscMax(most, SamMisesExcess(&material, &virgin, s));
  }
  if (most < 0) return;
  *wrong = SAM_COMPONENTS + first->place;
  (void)snprintf(
    why, size,
    "with this bulk stress%s the von Mises stress of body %d away from the contact is %.6g Pa, limit %.6g Pa, "
    "-%s: a body that yields as a whole has no limit of its strain",
    m->initial ? " and the initial stress" : "", (int)body + 1, most + material.yield, material.yield, yielding[body]);
}

/* Rejects bulk stress above the yield stress. */
static PetscErrorCode Check(SamLaw law, SamControl *control, PetscInt *wrong, char why[], size_t size)
{
  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2 && !why[0]; body++) CheckBulk(law, control, body, wrong, why, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

/* Makes the strain before the step a copy, which may be changed, of that of the step before. */
static PetscErrorCode CopyLast(SamPlastic *p, SamState state)
{
  const Vec before = SamStateGetField(state, SamStateFindField(state, SAM_PLASTIC_FIELD), SAM_COMMITTED);

  PetscFunctionBegin;
  if (p->last != before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&p->last));
  PetscCall(VecDuplicate(before, &p->last));
  PetscCall(VecCopy(before, p->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sets the strain before the step to that of the step before, which the state has moved if the bodies roll. Where the
  surfaces slide, body 2 moves under the grid as well.
*/
static PetscErrorCode TakeLast(SamPlastic *p, SamState state)
{
  const Vec before = SamStateGetField(state, SamStateFindField(state, SAM_PLASTIC_FIELD), SAM_COMMITTED);
  PetscReal from[2], to[2];

  PetscFunctionBegin;
  PetscCall(VecDestroy(&p->last));
  if (!before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectReference((PetscObject)before));
  p->last = before;
  (void)SamFramesGetSlide(state, SAM_TRIED, to);
  (void)SamFramesGetSlide(state, SAM_COMMITTED, from);
  for (int k = 0; k < 2; k++) to[k] -= from[k];
  if (p->body[p->bodies - 1].body != 1 || (to[0] == 0 && to[1] == 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CopyLast(p, state));
  PetscCall(SamPlasticSlide(p, to, p->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the depth removed of a body since its strain was moved last, in the cells; notes the present depth. */
static PetscErrorCode TakeRemoved(SamLaw law, SamState state, PetscInt body, Vec since)
{
  const PetscInt id     = SamStateFindField(state, removed[body]);
  const Vec      before = SamStateGetField(state, id, SAM_COMMITTED);
  PetscReal      offset[2];
  PetscInt       component;
  Vec            depth, now, own;

  PetscFunctionBegin;
  PetscCall(SamStateSetField(state, id, &now));
  PetscCall(SamStateFindValues(state, SamStateFindResult(state, depths[body]), since, &depth, &component));
  PetscCall(VecCopy(depth, now));
  if (depth != since) PetscCall(VecCopy(depth, since));
  if (before) PetscCall(VecAXPY(since, -1, before));
  if (!SamFramesGetOffset(state, SAM_TRIED, body, offset)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(since, &own));
  PetscCall(VecCopy(since, own));
  PetscCall(SamFramesRead(law->elasticity, offset, own, since));
  PetscCall(VecDestroy(&own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the strain of body 0 or 1, whose layers stand at a place, up by what wear has removed since the step before. */
static PetscErrorCode FollowWear(SamLaw law, SamState state, PetscInt body, PetscInt place)
{
  SamPlastic   *p = &((Plastic *)law->data)->plastic;
  PetscReal     most;
  const double *by;
  double       *strain;
  Vec           since;

  PetscFunctionBegin;
  if (SamStateFindField(state, removed[body]) < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(law->grid, 1, &since));
  PetscCall(TakeRemoved(law, state, body, since));
  PetscCall(VecMax(since, NULL, &most));
  if (most > 0 && p->last) {
    PetscCall(CopyLast(p, state));
    PetscCall(VecGetArrayRead(since, &by));
    PetscCall(VecGetArray(p->last, &strain));
    PetscCall(SamPlasticRaise(p, place, by, strain));
    PetscCall(VecRestoreArray(p->last, &strain));
    PetscCall(VecRestoreArrayRead(since, &by));
  }
  PetscCall(VecDestroy(&since));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  Plastic *const x    = (Plastic *)law->data;
  PetscInt       next = 0;

  PetscFunctionBegin;
  (void)duration;
  PetscCall(SetUp(law));
  PetscCall(DropStress(x));
  PetscCall(SamPlasticAbandon(&x->plastic)); /* after an error */
  PetscCall(TakeLast(&x->plastic, state));
  x->plastic.newton = x->plastic.products = 0;
  for (PetscInt b = 0; b < 2; b++) {
    if (!isfinite(x->material[b].yield)) continue;
    GetBulk(law, control, b, x->plastic.body[next].bulk, NULL);
    PetscCall(FollowWear(law, state, b, next++));
  }
  law->revision++; /* the pressure has to be solved again */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  const PetscInt cells = law->grid->cells;
  const Vec      field = SamStateReadField(state, SamStateFindField(state, SAM_PLASTIC_FIELD));
  double        *u, *to, *at[3];
  PetscReal      most = 0;

  PetscFunctionBegin;
  (void)control;
  (void)e;
  if (!field) PetscFunctionReturn(PETSC_SUCCESS);
  if (adds) PetscCall(VecNorm(field, NORM_INFINITY, &most));
  if (adds && most > 0) *adds = PETSC_TRUE;
  if (!u_z && !u_t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(law));
  PetscCall(PetscMalloc1(3 * cells, &u));
  for (PetscInt c = 0; c < 3; c++) at[c] = u + c * cells;
  PetscCall(SamPlasticDisplace(&((Plastic *)law->data)->plastic, field, at));
  if (u_z) PetscCall(VecGetArray(u_z, &to));
  for (PetscInt k = 0; u_z && k < cells; k++) to[k] += at[2][k];
  if (u_z) PetscCall(VecRestoreArray(u_z, &to));
  if (u_t) PetscCall(VecGetArray(u_t, &to));
  for (PetscInt k = 0; u_t && k < 2 * cells; k++) to[k] += u[k];
  if (u_t) PetscCall(VecRestoreArray(u_t, &to));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Follow(SamLaw law, SamLawContact *contact, PetscBool *again)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  PetscCall(SamPlasticSolve(&((Plastic *)law->data)->plastic, contact, again));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds, from the state and the stress alone, the largest strain, the yielding cells, and the error of the yield
   function. */
static PetscErrorCode Judge(const SamPlastic *p, const double before[], const double now[], const double stress[],
                            double numbers[NUMBERS])
{
  const PetscInt cells   = p->grid->cells;
  double         most[3] = {0}, yields = 0;

  PetscFunctionBegin;
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < cells; k++) {
      const SamMises *m    = &p->body[l / p->layers].material;
      SamMisesAt      last = {{0}, 0, {{0}}}, at;
      double          s[PARTS], excess;

      for (PetscInt c = 0; c < PARTS; c++) s[c] = stress[((ptrdiff_t)l * PARTS + c) * cells + k];
      if (before) SamPlasticRead(p, before, l, k, &last);
      SamPlasticRead(p, now, l, k, &at);
      excess  = SamMisesExcess(m, &at, s) / m->yield;
      most[0] = PetscMax(most[0], at.p);
      most[1] = SamLarger(most[1], at.p < last.p ? INFINITY : at.p > last.p ? fabs(excess) : excess);
      most[2] = PetscMax(most[2], at.p - last.p);
      yields += at.p > last.p;
    }
  PetscCall(SamMax(p->grid->comm, 3, most));
  PetscCall(SamSum(p->grid->comm, 1, &yields));
  numbers[MOST]  = most[0];
  numbers[ERROR] = most[1];
  numbers[CELLS] = yields;
  numbers[STILL] = most[2] > GROWTH ? 0 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the number of layers that the strain spans, and its distance from the end of the layers. */
static PetscErrorCode Extent(const SamPlastic *p, const double now[], PetscBool periodic, double numbers[NUMBERS])
{
  const SamGrid  grid  = p->grid;
  const PetscInt count = p->bodies * p->layers, cells = grid->cells;
  double        *most, near                           = -(double)(grid->nx + grid->ny);

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(count + 1, &most));
  for (PetscInt l = 0; l < count; l++)
    for (PetscInt k = 0; k < cells; k++) {
      const double   strain = now[((ptrdiff_t)l * p->size + PARTS) * cells + k];
      const PetscInt i = k % grid->nx, j = grid->row_start + k / grid->nx;
      const PetscInt x = PetscMin(i, grid->nx - 1 - i), y = SamGridIsRow(grid) ? x : PetscMin(j, grid->ny - 1 - j);

      most[l] = PetscMax(most[l], strain);
      if (!periodic && strain > COUNTS * numbers[MOST]) near = PetscMax(near, -(double)PetscMin(x, y));
    }
  most[count] = near;
  PetscCall(SamMax(grid->comm, count + 1, most));
  numbers[LAYERS] = numbers[MOST] > 0 ? (double)p->layers : 0;
  numbers[LEFT]   = PetscMin(-most[count], (double)p->layers);
  for (PetscInt b = 0; b < p->bodies; b++) {
    PetscInt spans = 0, left = p->layers;

    for (PetscInt l = 0; l < p->layers; l++)
      if (most[b * p->layers + l] > COUNTS * numbers[MOST]) {
        spans++;
        left = p->layers - 1 - l;
      }
    if (spans) numbers[LAYERS] = PetscMin(numbers[LAYERS], (double)spans);
    numbers[LEFT] = PetscMin(numbers[LEFT], (double)left);
  }
  PetscCall(PetscFree(most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Extrapolates the plastic strain to the surface: the strain of the first layer plus its excess over the second. Strain
  that decays within a layer or two below the surface, as under friction, is larger at the surface than in any layer.
*/
static PetscErrorCode FindSurface(const SamPlastic *p, const double now[], double numbers[NUMBERS])
{
  const PetscInt cells = p->grid->cells;
  double         most  = 0;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < p->bodies; b++)
    for (PetscInt k = 0; k < cells; k++) {
      const ptrdiff_t first = ((ptrdiff_t)b * p->layers * p->size + PARTS) * cells + k;

      most = PetscMax(most, 2 * now[first] - now[first + (ptrdiff_t)p->size * cells]);
    }
  PetscCall(SamMax(p->grid->comm, 1, &most));
  numbers[SURFACE] = most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the work of the plastic strain of a step, and estimates its error by the length of the step. The error is the
  part TURNS of the work that grows from a small strain, whose direction changes, plus the part BACK of the change by
  backstresses, which have errors of first order. Both parts were fitted to steps of a sphere pressed on half-spaces
  without and with hardening.
*/
static PetscErrorCode SumWork(const SamPlastic *p, const double last[], const double now[], double sums[2])
{
  const SamGrid grid     = p->grid;
  SamTotal      total[2] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt l = 0; l < p->bodies * p->layers; l++) {
      const double volume = (double)(p->thickness[l % p->layers] * grid->dx * grid->dy);
      double       row[2] = {0};

      for (PetscInt k = j * grid->nx; k < (j + 1) * grid->nx; k++) {
        SamMisesAt from = {{0}, 0, {{0}}}, to;
        double     work, change;

        if (last) SamPlasticRead(p, last, l, k, &from);
        SamPlasticRead(p, now, l, k, &to);
        if (to.p == from.p) continue;
        work = SamMisesWork(&p->body[l / p->layers].material, &from, &to, &change);
        row[0] += volume * work;
        row[1] += volume * (TURNS * work * (to.p - from.p) / to.p + BACK * change);
      }
      SamAddAll(2, total, row);
    }
  PetscCall(SamSumTotals(grid->comm, 2, total, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The layers are compared with the largest contact so far: a small contact, at the beginning or the end of loading,
  yields little, and the layers are thicker in relation to it.
*/
static void KeepLargest(const double before[NUMBERS], double now[NUMBERS])
{
  if (!(before[THICK] > 0) || (now[THICK] > 0 && now[THICK] < before[THICK])) return;
  now[OUTSIDE] = now[THICK] == before[THICK] ? PetscMax(now[OUTSIDE], before[OUTSIDE]) : before[OUTSIDE];
  now[THICK]   = before[THICK];
}

/* Finds the depth of the dent, which is unchanged if no strain has grown. */
static PetscErrorCode FindDent(SamPlastic *p, Vec state, double before, double numbers[NUMBERS])
{
  const PetscInt cells = p->grid->cells;
  double        *u, *at[3], most = 0;

  PetscFunctionBegin;
  numbers[DENT] = before > 0 ? before : 0;
  if (!(numbers[CELLS] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3 * cells, &u));
  for (PetscInt c = 0; c < 3; c++) at[c] = u + c * cells;
  PetscCall(SamPlasticDisplace(p, state, at));
  for (PetscInt k = 0; k < cells; k++) most = PetscMax(most, at[2][k]);
  PetscCall(SamMax(p->grid->comm, 1, &most));
  numbers[DENT] = most;
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  Plastic *const x      = (Plastic *)law->data;
  SamPlastic    *p      = &x->plastic;
  const PetscInt first  = SamStateFindNumber(step->state, "plastic_max");
  const Vec      tried  = SamStateReadField(step->state, SamStateFindField(step->state, SAM_PLASTIC_FIELD));
  const Vec      before = p->last;
  const PetscInt n      = PARTS * p->bodies * p->layers * p->grid->cells;
  const double  *now, *last = NULL, *committed = SamStateNumbers(step->state, first, SAM_COMMITTED);
  double        *stress, *numbers, work[2]     = {0};

  PetscFunctionBegin;
  if (!tried) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  PetscCall(PetscMalloc1(n, &stress));
  numbers = SamStateNumbers(step->state, first, SAM_TRIED);
  /* where no cell yields, `tried` is `before`, and what depends on the strain alone stays */
  numbers[ENERGY] = committed[ENERGY];
  PetscCall(SamPlasticStress(p, tried, step->pressure, step->shear, stress, tried == before ? NULL : &numbers[ENERGY]));
  PetscCall(VecGetArrayRead(tried, &now));
  if (before) PetscCall(VecGetArrayRead(before, &last));
  PetscCall(Judge(p, last, now, stress, numbers));
  for (PetscInt k = 0; k < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(OF_STRAIN); k++)
    numbers[OF_STRAIN[k]] = committed[OF_STRAIN[k]];
  if (tried != before) {
    PetscCall(Extent(p, now, SamElasticityGetTraits(law->elasticity).periodic, numbers));
    PetscCall(FindSurface(p, now, numbers));
    PetscCall(SumWork(p, last, now, work));
  }
  PetscCall(SamPlasticLookOutside(p, tried, step->pressure, step->shear, &numbers[THICK], &numbers[OUTSIDE]));
  KeepLargest(committed, numbers);
  PetscCall(FindDent(p, tried, committed[DENT], numbers));
  numbers[WORK]   = work[0];
  numbers[UNSURE] = work[1];
  numbers[NEWTON] = (double)p->newton;
  numbers[STILL] *= 1 + committed[STILL];
  numbers[PRODUCTS] = (double)p->products;
  if (!(numbers[ERROR] <= PetscMax(EXCESS, MARGIN * p->rtol)))
    (void)snprintf(step->failed, sizeof(step->failed), "the check of the plastic strain: the yield function is %.2g Y",
                   numbers[ERROR]);
  if (before) PetscCall(VecRestoreArrayRead(before, &last));
  PetscCall(VecRestoreArrayRead(tried, &now));
  PetscCall(PetscFree(stress));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View(SamLaw law, SamState state, PetscViewer viewer)
{
  const double *numbers = SamStateReadNumbers(state, SamStateFindNumber(state, "plastic_max"));

  PetscFunctionBegin;
  (void)law;
  if (numbers[MOST] > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  strain up to %.6g, %.0f cells yield\n", "plastic", numbers[MOST],
                                     numbers[CELLS]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Plastic(SamLaw law)
{
  Plastic *x;

  PetscFunctionBegin;
  PetscCall(PetscNew(&x));
  x->material[0].yield = x->material[1].yield = INFINITY;
  for (PetscInt b = 0; b < 2; b++) PetscCall(PetscStrncpy(x->material[b].hardens, "none", SAM_HARDENING_TEXT));
  x->rtol                 = 1e-6;
  x->layers               = 32;
  law->data               = x;
  law->heading            = "Plastic strain below the surface";
  law->rows               = rows;
  law->row_count          = (PetscInt)(sizeof(rows) / sizeof(rows[0]));
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->ops.destroy        = Destroy;
  law->ops.declare        = Declare;
  law->ops.check          = Check;
  law->ops.begin          = Begin;
  law->displaces          = PETSC_TRUE;
  law->ops.displace       = Displace;
  law->ops.follow         = Follow;
  law->ops.advance        = Advance;
  law->ops.view           = View;
  law->ops.yields         = Yields;
  law->ops.flow           = SamPlasticGetFlow;
  law->ops.examine        = SamPlasticExamine;
  law->ops.doubt          = SamPlasticDoubt;
  law->strained           = "plastic_max";
  law->with_shear         = "plastic_max residual_z_max";
  PetscFunctionReturn(PETSC_SUCCESS);
}

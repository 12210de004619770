/* The options of an evaluation, and the settings recorded in a file of its results. */
#include "evaluationimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>

#define TEXT  4096 /* characters of a list */
#define NAMES 256  /* characters of a list of names */

static const char *const averages[] = {"point", "line", "area"}; /* from SAM_AVERAGE_POINT on */

/* The settings of a user, except lists of names */
typedef struct {
  PetscInt  body;
  char      depths[TEXT], section[128];
  PetscBool passing;
  PetscReal length;
  int       average; /* index into averages[] */
} Settings;

#define MEMBER(name) offsetof(Settings, name)
static const SamOptionRow where[] = {
  {"body", "1 or 2; z points into it", SAM_OPTION_INT, MEMBER(body), .least = 1, .most = 2},
  {"depths", "(m): 0,1e-5 or first:last:number; 0.5a: half widths; 2e-6-, 2e-6+: sides", SAM_OPTION_STRING,
   MEMBER(depths), .size = TEXT},
  {"section", "only the cells nearest to a plane, y=0 or x=1e-4 (m); default: whole maps", SAM_OPTION_STRING,
   MEMBER(section), .size = 128}};
static const SamOptionRow passing = {"passing", "the cycle is that of a point that passes along x under one step",
                                     SAM_OPTION_BOOL, .member = MEMBER(passing)};
static const SamOptionRow mean[]  = {
   {"fatigue_length", "length over which the stresses are averaged (); default: not at all", SAM_OPTION_REAL,
    MEMBER(length), .range = SAM_RANGE_POSITIVE, .unit = "m"},
   {"fatigue_average", "point: at half the length deep; line: to twice the length; area: the half disc of it",
    SAM_OPTION_ENUM, MEMBER(average), .words = "point,line,area", .needs = "fatigue_length"}};

static PetscErrorCode TakeDepths(SamEvaluation e, const char text[])
{
  PetscFunctionBegin;
  PetscCall(PetscStrallocpy(text, &e->depths_text));
  if (!SamDepthsAreRelative(text)) PetscCall(SamDepthsRead(e, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeSection(const SamOptions *from, SamEvaluation e, const char text[])
{
  double place = 0;

  PetscFunctionBegin;
  e->section = text[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(!e->section || ((text[0] == 'x' || text[0] == 'y') && text[1] == '=' && SamReadLength(text + 2, &place)),
             from->comm, SAM_ERR_USER, "-section %s: expected for example y=0 or x=1e-4", text);
  e->axis  = text[0] == 'y' ? SAM_SECTION_X : SAM_SECTION_Y;
  e->place = (PetscReal)place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a list of names, each of which requests a quantity of a step or of the cycle. */
static PetscErrorCode ReadNames(const SamOptions *from, PetscBool of_cycle, const char also[], char text[],
                                SamEvaluation e)
{
  const char *const option = of_cycle ? "fatigue" : "quantities";
  char words[NAMES], list[NAMES + 8], known[NAMES + 8], help[2 * NAMES], whole[NAMES], *parts[SAM_QUANTITIES];
  const SamOptionRow row = {option, help, SAM_OPTION_WORDS, .size = NAMES, .words = known};
  int                given;
  PetscBool          set;

  PetscFunctionBegin;
  SamQuantityNames(of_cycle, words, sizeof(words));
  (void)snprintf(list, sizeof(list), "%s%s%s", words, also[0] ? ", or " : "", also);
  (void)snprintf(known, sizeof(known), "%s%s%s", words, also[0] ? "," : "", also);
  (void)snprintf(help, sizeof(help), "%s%s", of_cycle ? "parameters over the steps as one closed cycle: some of " : "",
                 list);
  PetscCall(SamOptionsRead(from, NULL, 1, &row, text, &set));
  if (!text[0] && !set) PetscFunctionReturn(PETSC_SUCCESS);
  if (!strcmp(text, also)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(whole, text, sizeof(whole)));
  given = SamDivide(text, ',', parts, SAM_QUANTITIES);
  for (int k = 0; k < PetscMin(given, SAM_QUANTITIES); k++) {
    const SamQuantity *q = SamQuantityTable;

    while (q->name && (strcmp(parts[k], q->name) || (q->of_cycle != NULL) != of_cycle)) q++;
    PetscCheck(q->name && given < SAM_QUANTITIES, from->comm, SAM_ERR_USER, "-%s %s: expected some of %s", option,
               whole, list);
    e->wants[q - SamQuantityTable] = PETSC_TRUE;
    if (of_cycle) e->cycle = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- constants of fatigue parameters ---- */

static PetscReal *ConstantOf(SamEvaluation e, PetscInt material, const SamQuantityConstant *k)
{
  return (PetscReal *)(void *)((char *)&e->constants[material] + k->place);
}

/* Reads a constant: one number for all materials, or a list with one number for each; all lists have the same
   length. */
static PetscErrorCode ReadConstant(const SamOptions *from, SamEvaluation e, const SamQuantityConstant *k,
                                   PetscBool required)
{
  const SamOptionRow row = {k->name,        k->help, SAM_OPTION_REAL, .range = k->range, .size = SAM_MATERIALS,
                            .unit = k->unit};
  PetscReal          values[SAM_MATERIALS];
  PetscInt           n;
  char               text[128];

  PetscFunctionBegin;
  SamAddUnit(k->help, k->unit, text, sizeof(text));
  PetscCall(SamOptionsReals(from, &row, values, &n));
  PetscCall(SamOptionsRequire(from, (PetscBool)(n > 0 || !required), k->name, text));
  PetscCheck(n <= 1 || e->materials <= 1 || n == e->materials, from->comm, SAM_ERR_USER,
             "-%s: %" PetscInt_FMT " numbers, but %" PetscInt_FMT " in another list: " SAM_ONE_EACH, k->name, n,
             e->materials);
  e->materials = PetscMax(e->materials, n);
  for (PetscInt m = 0; n > 0 && m < SAM_MATERIALS; m++) *ConstantOf(e, m, k) = values[n > 1 ? PetscMin(m, n - 1) : 0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadConstants(const SamOptions *from, SamEvaluation e)
{
  const PetscBool print = SamPrintHelp();

  PetscFunctionBegin;
  e->materials = 1;
  for (const SamQuantity *q = SamQuantityTable; q->name; q++)
    for (int k = 0; k < 2 && q->constant[k].name; k++) {
      const PetscBool wanted = e->wants[q - SamQuantityTable];

      if (!wanted) SamOptionsKnow(from, q->constant[k].name, q->with);
      if (wanted || print) PetscCall(ReadConstant(from, e, &q->constant[k], (PetscBool)!print));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the length over which stresses are averaged; it excludes depths and quantities of other results. */
static PetscErrorCode TakeLength(const SamOptions *from, SamEvaluation e, const Settings *set)
{
  PetscBool given[2], some = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(from, "depths", &given[0]));
  PetscCall(SamOptionsHas(from, "quantities", &given[1]));
  for (const SamQuantity *q = SamQuantityTable; q->name; q++) {
    if (q->of_cycle) continue;
    some                           = some || e->wants[q - SamQuantityTable];
    e->wants[q - SamQuantityTable] = PETSC_FALSE;
  }
  PetscCheck(!given[0] && !(given[1] && some), from->comm, SAM_ERR_USER,
             "-fatigue_length: the mean has depths and quantities of its own: omit -%s",
             given[0] ? "depths" : "quantities");
  e->length  = set->length;
  e->average = (SamFatigueAverage)(SAM_AVERAGE_POINT + set->average);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationCreateFromOptions(const SamOptions *from, SamEvaluation *evaluation)
{
  char          quantities[NAMES] = "stress,mises", fatigue[NAMES] = "";
  Settings      set = {.body = 2, .depths = "0", .average = 1};
  PetscBool     given[2];
  SamEvaluation e;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  SamQuantitiesAddParts();
  PetscCall(PetscNew(&e));
  *evaluation = e;
  e->comm     = from->comm;
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(where), &set, NULL));
  e->body = e->layout.body = set.body;
  PetscCall(TakeDepths(e, set.depths));
  PetscCall(TakeSection(from, e, set.section));
  PetscCall(SamOptionsHeading(from, "Quantities"));
  PetscCall(ReadNames(from, PETSC_FALSE, "none", quantities, e));
  PetscCall(SamOptionsHeading(from, "Fatigue"));
  PetscCall(ReadNames(from, PETSC_TRUE, "", fatigue, e));
  PetscCall(SamOptionsRead(from, NULL, 1, &passing, &set, NULL));
  e->passing = set.passing;
  PetscCall(ReadConstants(from, e));
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(mean), &set, given));
  if (given[0] && !SamPrintHelp()) PetscCall(TakeLength(from, e, &set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationReadTransforms(const SamOptions *from, SamEvaluation e)
{
  PetscFunctionBegin;
  PetscCall(SamFourierSettingsFromOptions(&e->transforms, from));
  e->settings = &e->transforms;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationAddParameters(SamEvaluation e, SamParameters *p)
{
  const SamBodyPlace surface = SamBodyAt(SamEvaluationBody(e), 0);
  const PetscReal    body    = (PetscReal)e->body;
  PetscReal          values[SAM_MATERIALS];

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "body", PETSC_TRUE, 1, &body));
  if (e->passing) PetscCall(SamParametersAddText(p, "passing", PETSC_TRUE, "true"));
  PetscCall(SamParametersAddReals(p, "young", PETSC_TRUE, 1, &surface.young));
  PetscCall(SamParametersAddReals(p, "poisson", PETSC_TRUE, 1, &surface.poisson));
  PetscCall(SamElasticityAddParameters(e->source.bodies, p));
  for (const SamQuantity *q = SamQuantityTable; q->name; q++)
    for (int k = 0; k < 2 && q->constant[k].name && e->wants[q - SamQuantityTable]; k++) {
      for (PetscInt m = 0; m < e->materials; m++) values[m] = *ConstantOf(e, m, &q->constant[k]);
      PetscCall(SamParametersAddReals(p, q->constant[k].name, PETSC_TRUE, e->materials, values));
    }
  if (e->average) {
    PetscCall(SamParametersAddReals(p, "fatigue_length", PETSC_TRUE, 1, &e->length));
    PetscCall(SamParametersAddText(p, "fatigue_average", PETSC_TRUE, averages[e->average - SAM_AVERAGE_POINT]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The options of an evaluation, and what a file of its results records of them. */
#include "evaluationimpl.h"

#define TEXT  4096 /* characters of a list */
#define NAMES 256  /* characters of a list of names */

static const char *const averages[] = {"point", "line", "area"}; /* from SAM_AVERAGE_POINT on */

static PetscErrorCode ReadDepths(const SamOptions *from, SamEvaluation e)
{
  char text[TEXT] = "0";

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "depths", "m: 0,1e-5 or first:last:number; 0.5a: half widths; 2e-6-, 2e-6+: sides",
                             text, sizeof(text), NULL));
  PetscCall(PetscStrallocpy(text, &e->depths_text));
  if (!strchr(text, 'a')) PetscCall(SamDepthsRead(e, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadSection(const SamOptions *from, SamEvaluation e)
{
  char   text[128] = "";
  double place     = 0;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "section",
                             "only the cells nearest to a plane, y=0 or x=1e-4 (m); default: whole maps", text,
                             sizeof(text), &e->section));
  PetscCheck(!e->section || ((text[0] == 'x' || text[0] == 'y') && text[1] == '=' && SamReadNumber(text + 2, &place)),
             from->comm, SAM_ERR_USER, "-section %s: expected for example y=0 or x=1e-4", text);
  e->axis  = text[0] == 'y' ? SAM_SECTION_X : SAM_SECTION_Y;
  e->place = (PetscReal)place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a list of names, each of which asks for a quantity of a step or of the cycle. */
static PetscErrorCode ReadNames(const SamOptions *from, PetscBool of_cycle, const char also[], char text[],
                                SamEvaluation e)
{
  const char *const option = of_cycle ? "fatigue" : "quantities";
  char      words[NAMES], list[NAMES + 8], known[NAMES + 8], help[2 * NAMES], whole[NAMES], *parts[SAM_QUANTITIES];
  int       given;
  PetscBool set;

  PetscFunctionBegin;
  SamQuantityNames(of_cycle, words, sizeof(words));
  (void)snprintf(list, sizeof(list), "%s%s%s", words, also[0] ? ", or " : "", also);
  (void)snprintf(known, sizeof(known), "%s%s%s", words, also[0] ? "," : "", also);
  (void)snprintf(help, sizeof(help), "%ssome of %s", of_cycle ? "parameters over the steps as one closed cycle: " : "",
                 list);
  PetscCall(SamOptionsWords(from, option, help, known, text, NAMES, &set));
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

/* One number is for all materials; lists of more have one length, that of the materials. */
static PetscErrorCode ReadConstant(const SamOptions *from, SamEvaluation e, const SamQuantityConstant *k,
                                   PetscBool required)
{
  PetscReal values[SAM_MATERIALS];
  PetscInt  n;

  PetscFunctionBegin;
  PetscCall(SamOptionsReals(from, k->name, k->help, k->range, SAM_MATERIALS, values, &n));
  PetscCall(SamOptionsRequire(from, (PetscBool)(n > 0 || !required), k->name, k->help));
  PetscCheck(n <= 1 || e->materials <= 1 || n == e->materials, from->comm, SAM_ERR_USER,
             "-%s: %" PetscInt_FMT " numbers, but %" PetscInt_FMT " in another list: " SAM_ONE_EACH, k->name, n,
             e->materials);
  e->materials = PetscMax(e->materials, n);
  for (PetscInt m = 0; n > 0 && m < SAM_MATERIALS; m++) *ConstantOf(e, m, k) = values[n > 1 ? PetscMin(m, n - 1) : 0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadConstants(const SamOptions *from, SamEvaluation e)
{
  PetscBool print;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&print));
  e->materials = 1;
  for (const SamQuantity *q = SamQuantityTable; q->name; q++)
    for (int k = 0; k < 2 && q->constant[k].name; k++) {
      const PetscBool wanted = e->wants[q - SamQuantityTable];

      if (!wanted) SamOptionsKnow(from, q->constant[k].name, q->with);
      if (wanted || print) PetscCall(ReadConstant(from, e, &q->constant[k], (PetscBool)!print));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The length over which stresses are averaged; the depths and quantities of other results are not for it. */
static PetscErrorCode ReadLength(const SamOptions *from, SamEvaluation e)
{
  char      text[NAMES] = "line";
  PetscBool set, print, given[2], some = PETSC_FALSE;
  int       k = 0;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&print));
  PetscCall(SamOptionsReal(from, "fatigue_length",
                           "length over which the stresses are averaged, m; default: not at all", SAM_RANGE_POSITIVE,
                           &e->length, &set));
  if (!set) SamOptionsKnow(from, "fatigue_average", "-fatigue_length");
  if (!set && !print) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOptionsWord(from, "fatigue_average",
                           "point: at half the length deep; line: to twice the length; area: the half disc of it",
                           "point,line,area", text, sizeof(text), NULL));
  while (k < 3 && strcmp(text, averages[k])) k++;
  PetscCheck(k < 3, from->comm, SAM_ERR_USER, "-fatigue_average %s: expected point, line or area", text);
  if (print) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsHasName(NULL, from->prefix, "-depths", &given[0]));
  PetscCall(PetscOptionsHasName(NULL, from->prefix, "-quantities", &given[1]));
  for (const SamQuantity *q = SamQuantityTable; q->name; q++) {
    if (q->of_cycle) continue;
    some                           = some || e->wants[q - SamQuantityTable];
    e->wants[q - SamQuantityTable] = PETSC_FALSE;
  }
  PetscCheck(!given[0] && !(given[1] && some), from->comm, SAM_ERR_USER,
             "-fatigue_length: the mean has depths and quantities of its own: omit -%s",
             given[0] ? "depths" : "quantities");
  e->average = (SamFatigueAverage)(SAM_AVERAGE_POINT + k);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFatigue(const SamOptions *from, SamEvaluation e)
{
  char text[NAMES] = "";

  PetscFunctionBegin;
  PetscCall(ReadNames(from, PETSC_TRUE, "", text, e));
  PetscCall(SamOptionsBool(from, "passing", "the cycle is that of a point that passes along x under one step",
                           &e->passing, NULL));
  PetscCall(ReadConstants(from, e));
  PetscCall(ReadLength(from, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationCreateFromOptions(const SamOptions *from, SamEvaluation *evaluation)
{
  char          text[NAMES] = "stress,mises";
  SamEvaluation e;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&e));
  *evaluation = e;
  e->comm     = from->comm;
  e->body     = 2;
  PetscCall(SamOptionsInt(from, "body", "1 or 2; z points into it", 1, &e->body, NULL));
  PetscCheck(e->body <= 2, e->comm, SAM_ERR_USER, "-body %" PetscInt_FMT ": expected 1 or 2", e->body);
  PetscCall(ReadDepths(from, e));
  PetscCall(ReadSection(from, e));
  PetscCall(SamOptionsHeading(from, "Quantities"));
  PetscCall(ReadNames(from, PETSC_FALSE, "none", text, e));
  PetscCall(SamOptionsHeading(from, "Fatigue"));
  PetscCall(ReadFatigue(from, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationAddParameters(SamEvaluation e, SamParameters *p)
{
  const PetscReal body = (PetscReal)e->body;
  PetscReal       young, poisson, values[SAM_MATERIALS];

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "body", PETSC_TRUE, 1, &body));
  if (e->passing) PetscCall(SamParametersAddText(p, "passing", PETSC_TRUE, "true"));
  SamStressGetConstants(e->stress, 0, &young, &poisson);
  PetscCall(SamParametersAddReals(p, "young", PETSC_TRUE, 1, &young));
  PetscCall(SamParametersAddReals(p, "poisson", PETSC_TRUE, 1, &poisson));
  PetscCall(SamElasticityAddParameters(e->elasticity, p));
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

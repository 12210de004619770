/* The options of an evaluation, and what a file of its results records of them. */
#include "evaluationimpl.h"
#include <stdlib.h>
#include <string.h>

#define TEXT        4096 /* characters of a list */
#define MOST_DEPTHS 100000

#define NAMES      256 /* characters of a list of names */
#define NAMED      "stress,mises,principal,shear_max,strain"
#define QUANTITIES NAMED ", or none"
#define FATIGUE    "crossland,dang_van,findley,swt,fatemi_socie,ruiz"

/* ---- numbers ---- */

/* The side of an interface that a sign after a depth says, which is taken off: 2e-6- above, 2e-6+ below; 0: none. */
static int ReadSide(char text[])
{
  const size_t length = strlen(text);
  const char   last   = length ? text[length - 1] : '\0';

  if (last != '-' && last != '+') return 0;
  text[length - 1] = '\0';
  return last == '-' ? -1 : 1;
}

/* A finite number that makes up the whole text. */
static PetscBool ReadNumber(const char text[], double *value)
{
  char *end;

  *value = strtod(text, &end);
  return end != text && *end == '\0' && isfinite(*value);
}

static PetscBool ReadWhole(const char text[], PetscInt *value)
{
  char      *end;
  const long number = strtol(text, &end, 10);

  *value = (PetscInt)number;
  return end != text && *end == '\0' && number == (long)*value;
}

/* Divides a text at a character, in place; returns the number of parts, of which at most `most` are given. */
static int Divide(char text[], char at, char *parts[], int most)
{
  int count = 0;

  for (char *next = text; next; count++) {
    if (count < most) parts[count] = next;
    next = strchr(next, at);
    if (next) *next++ = '\0';
  }
  return count;
}

/* ---- depths ---- */

#define EXPECTED \
  "expected depths separated by commas, or first:last:number, first < last, in m or as 0.5a in half widths"

/* A depth in m, or behind a number `a`, in half widths of the contact (m). */
static PetscBool ReadDepth(char text[], PetscReal half, double *value)
{
  const size_t    length   = strlen(text);
  const PetscBool relative = length && text[length - 1] == 'a' ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       good;

  if (relative) text[length - 1] = '\0';
  good = ReadNumber(text, value);
  if (relative) *value *= (double)half;
  return good;
}

/* first:last:number */
static PetscErrorCode ReadRange(MPI_Comm comm, const char whole[], char text[], PetscReal half, PetscInt *n,
                                PetscReal **depths, int **sides)
{
  char  *parts[3];
  double ends[2] = {0, 0};

  PetscFunctionBegin;
  PetscCheck(Divide(text, ':', parts, 3) == 3 && ReadDepth(parts[0], half, &ends[0]) &&
               ReadDepth(parts[1], half, &ends[1]) && ReadWhole(parts[2], n) && *n >= 2 && ends[1] > ends[0],
             comm, SAM_ERR_USER, "%s: " EXPECTED, whole);
  PetscCheck(*n <= MOST_DEPTHS, comm, SAM_ERR_USER, "%s: expected at most %d depths", whole, MOST_DEPTHS);
  PetscCall(PetscCalloc2(*n, depths, *n, sides));
  for (PetscInt k = 0; k < *n; k++)
    (*depths)[k] = (PetscReal)(k + 1 == *n ? ends[1] : ends[0] + (ends[1] - ends[0]) * k / (*n - 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadList(MPI_Comm comm, const char whole[], char text[], PetscReal half, PetscInt *n,
                               PetscReal **depths, int **sides)
{
  char *parts[TEXT / 2];

  PetscFunctionBegin;
  *n = Divide(text, ',', parts, TEXT / 2);
  PetscCall(PetscCalloc2(*n, depths, *n, sides));
  for (PetscInt k = 0; k < *n; k++) {
    double value = 0;

    (*sides)[k] = ReadSide(parts[k]);
    PetscCheck(ReadDepth(parts[k], half, &value), comm, SAM_ERR_USER, "%s: " EXPECTED, whole);
    (*depths)[k] = (PetscReal)value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetHalfWidth(SamEvaluation e, PetscReal half)
{
  char       text[TEXT], whole[TEXT + 16];
  PetscInt   n;
  PetscReal *depths;
  int       *sides;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(text, e->depths_text, sizeof(text)));
  PetscCall(PetscSNPrintf(whole, sizeof(whole), "-depths %s", text));
  PetscCall((strchr(text, ':') ? ReadRange : ReadList)(e->comm, whole, text, half, &n, &depths, &sides));
  PetscCall(SamEvaluationTakeDepths(e, whole, n, depths, sides));
  PetscCall(PetscFree2(depths, sides));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationNeedsHalfWidth(SamEvaluation e, PetscBool *needs)
{
  PetscFunctionBegin;
  *needs = e->depths_text && strchr(e->depths_text, 'a') ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadDepths(const SamOptions *from, SamEvaluation e)
{
  char text[TEXT] = "0";

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "depths", "m: 0,1e-5 or first:last:number; 0.5a: half widths; 2e-6-, 2e-6+: sides",
                             text, sizeof(text), NULL));
  PetscCall(PetscFree(e->depths_text));
  PetscCall(PetscStrallocpy(text, &e->depths_text));
  if (!strchr(text, 'a')) PetscCall(SamEvaluationSetHalfWidth(e, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sections, quantities, fatigue ---- */

static PetscErrorCode ReadSection(const SamOptions *from, SamEvaluation e)
{
  char      text[128] = "";
  double    place     = 0;
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "section",
                             "only the cells nearest to a plane, y=0 or x=1e-4 (m); default: whole maps", text,
                             sizeof(text), &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck((text[0] == 'x' || text[0] == 'y') && text[1] == '=' && ReadNumber(text + 2, &place), from->comm,
             SAM_ERR_USER, "-section %s: expected for example y=0 or x=1e-4", text);
  PetscCall(SamEvaluationSetSection(e, text[0] == 'y' ? SAM_SECTION_X : SAM_SECTION_Y, (PetscReal)place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a list of names, each of which asks for one of `count` quantities from the first on. */
static PetscErrorCode ReadNames(const SamOptions *from, const char option[], const char list[], PetscInt first,
                                int count, char text[], SamEvaluation e)
{
  static const char *const names[SAM_QUANTITIES] = {"stress", "mises",        "principal", "shear_max",
                                                    "strain", "crossland",    "dang_van",  "findley",
                                                    "swt",    "fatemi_socie", "ruiz"};

  char whole[NAMES], *parts[SAM_QUANTITIES];
  int  given;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(whole, text, sizeof(whole)));
  given = Divide(text, ',', parts, count);
  for (int k = 0; k < PetscMin(given, count); k++) {
    int q = 0;

    while (q < count && strcmp(parts[k], names[first + q])) q++;
    PetscCheck(q < count && given <= count, from->comm, SAM_ERR_USER, "-%s %s: expected some of %s", option, whole,
               list);
    e->wants[first + q] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadQuantities(const SamOptions *from, SamEvaluation e)
{
  char text[NAMES] = "stress,mises";

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(e->wants, SAM_QUANTITIES));
  PetscCall(SamOptionsWords(from, "quantities", "some of " QUANTITIES, NAMED ",none", text, sizeof(text), NULL));
  if (strcmp(text, "none")) PetscCall(ReadNames(from, "quantities", QUANTITIES, SAM_QUANTITY_STRESS, 5, text, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The constants of the fatigue parameters, each required by one of them. */
static const struct {
  SamQuantity quantity;
  const char *with, *name, *help;
  SamRange    range;
  size_t      place; /* in SamFatigueConstants */
} constants[] = {
  {SAM_QUANTITY_CROSSLAND, "-fatigue crossland", "fatigue_crossland_alpha",
   "factor on the maximum hydrostatic stress, required by crossland", SAM_RANGE_NONNEGATIVE,
   offsetof(SamFatigueConstants, crossland_alpha)},
  {SAM_QUANTITY_DANG_VAN, "-fatigue dang_van", "fatigue_dang_van_alpha",
   "factor on the hydrostatic stress, required by dang_van", SAM_RANGE_NONNEGATIVE,
   offsetof(SamFatigueConstants, dang_van_alpha)},
  {SAM_QUANTITY_FINDLEY, "-fatigue findley", "fatigue_findley_k",
   "factor on the maximum normal stress, required by findley", SAM_RANGE_NONNEGATIVE,
   offsetof(SamFatigueConstants, findley_k)},
  {SAM_QUANTITY_FATEMI_SOCIE, "-fatigue fatemi_socie", "fatigue_fatemi_socie_k",
   "factor on the maximum normal stress, required by fatemi_socie", SAM_RANGE_NONNEGATIVE,
   offsetof(SamFatigueConstants, fatemi_socie_k)},
  {SAM_QUANTITY_FATEMI_SOCIE, "-fatigue fatemi_socie", "fatigue_yield", "yield stress, Pa, required by fatemi_socie",
   SAM_RANGE_POSITIVE, offsetof(SamFatigueConstants, yield)},
};
enum { CONSTANTS = sizeof(constants) / sizeof(constants[0]) };

static const char *const averages[] = {"point", "line", "area"}; /* from SAM_AVERAGE_POINT on */

static PetscReal *ConstantOf(SamEvaluation e, PetscInt material, int k)
{
  return (PetscReal *)(void *)((char *)&e->constants[material] + constants[k].place);
}

/* One number is for all materials; lists of more have one length, that of the materials. */
static PetscErrorCode ReadConstant(const SamOptions *from, SamEvaluation e, int k, PetscBool required)
{
  PetscReal values[SAM_LAYERS + 1];
  PetscInt  n;

  PetscFunctionBegin;
  PetscCall(
    SamOptionsReals(from, constants[k].name, constants[k].help, constants[k].range, SAM_LAYERS + 1, values, &n));
  PetscCall(SamOptionsRequire(from, (PetscBool)(n > 0 || !required), constants[k].name, constants[k].help));
  PetscCheck(n <= 1 || e->materials <= 1 || n == e->materials, from->comm, SAM_ERR_USER,
             "-%s: %" PetscInt_FMT " numbers, but %" PetscInt_FMT
             " in another list: give one number, or one for each layer and the substrate",
             constants[k].name, n, e->materials);
  e->materials = PetscMax(e->materials, n);
  for (PetscInt m = 0; n > 0 && m <= SAM_LAYERS; m++) *ConstantOf(e, m, k) = values[n > 1 ? PetscMin(m, n - 1) : 0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadConstants(const SamOptions *from, SamEvaluation e)
{
  PetscBool print;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&print));
  e->materials = 1;
  for (int k = 0; k < CONSTANTS; k++) {
    const PetscBool wanted = e->wants[constants[k].quantity];

    if (!wanted) SamOptionsKnow(from, constants[k].name, constants[k].with);
    if (!wanted && !print) continue;
    PetscCall(ReadConstant(from, e, k, (PetscBool)!print));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationAddParameters(SamEvaluation e, SamParameters *p)
{
  const PetscReal body = (PetscReal)e->body;
  PetscReal       young, poisson;

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "body", PETSC_TRUE, 1, &body));
  if (e->passing) PetscCall(SamParametersAddText(p, "passing", PETSC_TRUE, "true"));
  SamStressGetConstants(e->stress, 0, &young, &poisson);
  PetscCall(SamParametersAddReals(p, "young", PETSC_TRUE, 1, &young));
  PetscCall(SamParametersAddReals(p, "poisson", PETSC_TRUE, 1, &poisson));
  PetscCall(SamElasticityAddParameters(e->elasticity, p));
  for (int k = 0; k < CONSTANTS; k++) {
    PetscReal values[SAM_LAYERS + 1];

    if (!e->wants[constants[k].quantity]) continue;
    for (PetscInt m = 0; m < e->materials; m++) values[m] = *ConstantOf(e, m, k);
    PetscCall(SamParametersAddReals(p, constants[k].name, PETSC_TRUE, e->materials, values));
  }
  if (e->average) {
    PetscCall(SamParametersAddReals(p, "fatigue_length", PETSC_TRUE, 1, &e->length));
    PetscCall(SamParametersAddText(p, "fatigue_average", PETSC_TRUE, averages[e->average - SAM_AVERAGE_POINT]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The length over which stresses are averaged; the depths and quantities of other results are not for it. */
static PetscErrorCode ReadLength(const SamOptions *from, SamEvaluation e)
{
  char      text[NAMES] = "line";
  PetscReal length      = 0;
  PetscBool set, print, given[2], some = PETSC_FALSE;
  int       k = 0;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&print));
  PetscCall(SamOptionsReal(from, "fatigue_length",
                           "length over which the stresses are averaged, m; default: not at all", SAM_RANGE_POSITIVE,
                           &length, &set));
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
  for (PetscInt q = 0; q < SAM_QUANTITY_CROSSLAND; q++) some = some || e->wants[q];
  PetscCheck(!given[0] && !(given[1] && some), from->comm, SAM_ERR_USER,
             "-fatigue_length: the mean has depths and quantities of its own: omit -%s",
             given[0] ? "depths" : "quantities");
  PetscCall(PetscArrayzero(e->wants, SAM_QUANTITY_CROSSLAND));
  PetscCall(SamEvaluationSetFatigueLength(e, length, (SamFatigueAverage)(SAM_AVERAGE_POINT + k)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFatigue(const SamOptions *from, SamEvaluation e)
{
  char      text[NAMES] = "";
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(SamOptionsWords(from, "fatigue", "parameters over the steps as one closed cycle: some of " FATIGUE, FATIGUE,
                            text, sizeof(text), &set));
  if (set) PetscCall(ReadNames(from, "fatigue", FATIGUE, SAM_QUANTITY_CROSSLAND, 6, text, e));
  PetscCall(SamOptionsBool(from, "passing", "the cycle is that of a point that passes along x under one step",
                           &e->passing, NULL));
  PetscCall(ReadConstants(from, e));
  PetscCall(ReadLength(from, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEvaluationSetFromOptions(SamEvaluation e, const SamOptions *from)
{
  PetscInt body = 2;

  PetscFunctionBegin;
  e->dash = "-";
  PetscCall(SamOptionsInt(from, "body", "1 or 2; z points into it", 1, &body, NULL));
  PetscCall(SamEvaluationSetBody(e, body));
  PetscCall(ReadDepths(from, e));
  PetscCall(ReadSection(from, e));
  PetscCall(SamOptionsHeading(from, "Quantities"));
  PetscCall(ReadQuantities(from, e));
  PetscCall(SamOptionsHeading(from, "Fatigue"));
  PetscCall(ReadFatigue(from, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

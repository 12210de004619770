/* The options of petsam-stress. */
#include "request.h"
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>

#define TEXT        4096 /* characters of a list */
#define MOST_DEPTHS 100000

#define NAMES      256 /* characters of a list of names */
#define NAMED      "stress,mises,principal,shear_max,strain"
#define QUANTITIES NAMED ", or none"
#define FATIGUE    "crossland,dang_van,findley,swt,fatemi_socie,ruiz"

/* ---- numbers ---- */

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

/* first:last:number */
static PetscErrorCode ReadRange(MPI_Comm comm, const char whole[], char text[], SamStressRequest *r)
{
  char  *parts[3];
  double ends[2] = {0, 0};

  PetscFunctionBegin;
  PetscCheck(Divide(text, ':', parts, 3) == 3 && ReadNumber(parts[0], &ends[0]) && ReadNumber(parts[1], &ends[1]) &&
               ReadWhole(parts[2], &r->depths) && r->depths >= 2 && ends[1] > ends[0],
             comm, SAM_ERR_USER, "-depths %s: expected depths separated by commas, or first:last:number, first < last",
             whole);
  PetscCheck(r->depths <= MOST_DEPTHS, comm, SAM_ERR_USER, "-depths %s: expected at most %d depths", whole,
             MOST_DEPTHS);
  PetscCall(PetscMalloc1(r->depths, &r->depth));
  for (PetscInt k = 0; k < r->depths; k++)
    r->depth[k] = (PetscReal)(k + 1 == r->depths ? ends[1] : ends[0] + (ends[1] - ends[0]) * k / (r->depths - 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadDepths(const SamOptions *from, SamStressRequest *r)
{
  char      text[TEXT] = "0", whole[TEXT], *parts[TEXT / 2];
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(
    SamOptionsString(from, "depths", "m from the surface: 0,1e-5,2e-5 or first:last:number", text, sizeof(text), &set));
  PetscCall(PetscStrncpy(whole, text, sizeof(whole)));
  if (strchr(text, ':')) {
    PetscCall(ReadRange(from->comm, whole, text, r));
  } else {
    r->depths = Divide(text, ',', parts, TEXT / 2);
    PetscCall(PetscMalloc1(r->depths, &r->depth));
    for (PetscInt k = 0; k < r->depths; k++) {
      double value = 0;

      PetscCheck(ReadNumber(parts[k], &value), from->comm, SAM_ERR_USER,
                 "-depths %s: expected depths separated by commas, or first:last:number, first < last", whole);
      r->depth[k] = (PetscReal)value;
    }
  }
  for (PetscInt k = 0; k < r->depths; k++) {
    PetscCheck(r->depth[k] >= 0, from->comm, SAM_ERR_USER, "-depths %s: %g is above the surface: expected numbers >= 0",
               whole, (double)r->depth[k]);
    PetscCheck(!k || r->depth[k] > r->depth[k - 1], from->comm, SAM_ERR_USER,
               "-depths %s: %g follows %g: expected depths that increase", whole, (double)r->depth[k],
               (double)r->depth[k - 1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sections, steps, quantities ---- */

static PetscErrorCode ReadSection(const SamOptions *from, SamStressRequest *r)
{
  char   text[128] = "";
  double place     = 0;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "section", "only the cells nearest to a plane, y=0 or x=1e-4 (m), not whole maps",
                             text, sizeof(text), &r->section));
  if (!r->section) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck((text[0] == 'x' || text[0] == 'y') && text[1] == '=' && ReadNumber(text + 2, &place), from->comm,
             SAM_ERR_USER, "-section %s: expected for example y=0 or x=1e-4", text);
  r->axis  = text[0] == 'y' ? SAM_SECTION_X : SAM_SECTION_Y;
  r->place = (PetscReal)place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadSteps(const SamOptions *from, SamStressRequest *r)
{
  char text[128] = "last", whole[128], *parts[3];
  int  count;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "steps", "load steps: last, all, a number, or first:last[:stride]", text,
                             sizeof(text), NULL));
  PetscCall(PetscStrncpy(whole, text, sizeof(whole)));
  r->all_steps = !strcmp(text, "all");
  r->last_step = !strcmp(text, "last");
  if (r->all_steps || r->last_step) PetscFunctionReturn(PETSC_SUCCESS);
  count     = Divide(text, ':', parts, 3);
  r->stride = 1;
  PetscCheck(count <= 3 && ReadWhole(parts[0], &r->first) && (count < 2 || ReadWhole(parts[1], &r->last)) &&
               (count < 3 || ReadWhole(parts[2], &r->stride)),
             from->comm, SAM_ERR_USER, "-steps %s: expected last, all, a number, or first:last[:stride]", whole);
  if (count < 2) r->last = r->first;
  PetscCheck(r->first >= 1 && r->last >= r->first && r->stride >= 1, from->comm, SAM_ERR_USER,
             "-steps %s: expected 1 <= first <= last and a stride of at least 1", whole);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a list of names, each of which asks for a quantity: names[k] for quantity first + k. */
static PetscErrorCode ReadNames(const SamOptions *from, const char option[], const char list[],
                                const char *const names[], PetscInt first, int count, char text[], SamStressRequest *r)
{
  char whole[NAMES], *parts[SAM_QUANTITIES];
  int  given;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(whole, text, sizeof(whole)));
  given = Divide(text, ',', parts, count);
  for (int k = 0; k < PetscMin(given, count); k++) {
    int q = 0;

    while (q < count && strcmp(parts[k], names[q])) q++;
    PetscCheck(q < count && given <= count, from->comm, SAM_ERR_USER, "-%s %s: expected some of %s", option, whole,
               list);
    r->wants[first + q] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadQuantities(const SamOptions *from, SamStressRequest *r)
{
  static const char *const names[]     = {"stress", "mises", "principal", "shear_max", "strain"};
  char                     text[NAMES] = "stress,mises";

  PetscFunctionBegin;
  PetscCall(SamOptionsWords(from, "quantities", "some of " QUANTITIES, NAMED ",none", text, sizeof(text), NULL));
  if (strcmp(text, "none"))
    PetscCall(ReadNames(from, "quantities", QUANTITIES, names, SAM_QUANTITY_STRESS, 5, text, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The constants of the fatigue parameters, each required by one of them. */
static PetscErrorCode ReadConstants(const SamOptions *from, SamStressRequest *r)
{
  const struct {
    SamQuantity quantity;
    const char *with, *name, *help;
    SamRange    range;
    PetscReal  *value;
  } all[] = {
    {SAM_QUANTITY_CROSSLAND, "-fatigue crossland", "fatigue_crossland_alpha",
     "factor on the largest mean stress, required by crossland", SAM_RANGE_NONNEGATIVE, &r->constants.crossland_alpha},
    {SAM_QUANTITY_DANG_VAN, "-fatigue dang_van", "fatigue_dang_van_alpha",
     "factor on the mean stress, required by dang_van", SAM_RANGE_NONNEGATIVE, &r->constants.dang_van_alpha},
    {SAM_QUANTITY_FINDLEY, "-fatigue findley", "fatigue_findley_k",
     "factor on the largest normal stress, required by findley", SAM_RANGE_NONNEGATIVE, &r->constants.findley_k},
    {SAM_QUANTITY_FATEMI_SOCIE, "-fatigue fatemi_socie", "fatigue_fatemi_socie_k",
     "factor on the largest normal stress, required by fatemi_socie", SAM_RANGE_NONNEGATIVE,
     &r->constants.fatemi_socie_k},
    {SAM_QUANTITY_FATEMI_SOCIE, "-fatigue fatemi_socie", "fatigue_yield", "yield stress, Pa, required by fatemi_socie",
     SAM_RANGE_POSITIVE, &r->constants.yield},
  };
  PetscBool set, print;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&print));
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) {
    if (!r->wants[all[k].quantity]) SamOptionsKnow(from, all[k].name, all[k].with);
    if (!r->wants[all[k].quantity] && !print) continue;
    PetscCall(SamOptionsReal(from, all[k].name, all[k].help, all[k].range, all[k].value, &set));
    PetscCall(SamOptionsRequire(from, set || print, all[k].name, all[k].help));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFatigue(const SamOptions *from, SamStressRequest *r)
{
  static const char *const names[]     = {"crossland", "dang_van", "findley", "swt", "fatemi_socie", "ruiz"};
  char                     text[NAMES] = "";
  PetscBool                set;

  PetscFunctionBegin;
  PetscCall(SamOptionsWords(from, "fatigue", "over the steps as one closed cycle: some of " FATIGUE, FATIGUE, text,
                            sizeof(text), &set));
  if (set) PetscCall(ReadNames(from, "fatigue", FATIGUE, names, SAM_QUANTITY_CROSSLAND, 6, text, r));
  PetscCheck(!r->wants[SAM_QUANTITY_RUIZ] || r->depth[0] == 0, from->comm, SAM_ERR_USER,
             "-fatigue ruiz: is defined on the surface: 0 must be one of -depths");
  PetscCall(ReadConstants(from, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRequestRead(const SamOptions *from, SamStressRequest *r)
{
  PetscBool set, print;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(r, sizeof(*r)));
  PetscCall(SamPrintHelp(&print));
  PetscCall(SamOptionsHeading(from, "Files"));
  PetscCall(SamOptionsFile(from, "input", "results of petsam", r->input, sizeof(r->input), &set));
  PetscCall(SamOptionsRequire(from, set || print, "input", "the results of petsam"));
  PetscCall(SamOptionsFile(from, "output", "the new file", r->output, sizeof(r->output), &set));
  PetscCall(SamOptionsRequire(from, set || print, "output", "the file to be written"));
  PetscCall(SamOptionsHeading(from, "Where and when"));
  r->body = 2;
  PetscCall(SamOptionsInt(from, "body", "1 or 2; z points into it", 1, &r->body, NULL));
  PetscCheck(r->body <= 2, from->comm, SAM_ERR_USER, "-body %" PetscInt_FMT ": expected 1 or 2", r->body);
  PetscCall(ReadDepths(from, r));
  PetscCall(ReadSection(from, r));
  PetscCall(ReadSteps(from, r));
  PetscCall(SamOptionsHeading(from, "What"));
  PetscCall(ReadQuantities(from, r));
  PetscCall(SamOptionsHeading(from, "Fatigue"));
  PetscCall(ReadFatigue(from, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamFatigueConstants SamStressRequestConstants(const SamStressRequest *r, PetscReal young, PetscReal poisson)
{
  SamFatigueConstants constants = r->constants;

  constants.young   = young;
  constants.poisson = poisson;
  return constants;
}

PetscErrorCode SamStressRequestFree(SamStressRequest *r)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(r->depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps of the results ---- */

/* The number of the saved step that is a load step, or -1. */
static PetscErrorCode FindSaved(SamResults results, PetscInt step, PetscInt *saved)
{
  PetscInt count, there;

  PetscFunctionBegin;
  *saved = -1;
  PetscCall(SamResultsGetSteps(results, NULL, &count));
  for (PetscInt k = 0; k < count && *saved < 0; k++) {
    PetscCall(SamResultsGetSaved(results, k, &there, NULL));
    if (there == step) *saved = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRequestSteps(const SamStressRequest *r, SamResults results, PetscInt *count, PetscInt **list)
{
  PetscInt steps, saved;
  SamGrid  grid;

  PetscFunctionBegin;
  PetscCall(SamResultsGetGrid(results, &grid));
  PetscCall(SamResultsGetSteps(results, &steps, &saved));
  *count = r->all_steps ? saved : r->last_step ? 1 : (r->last - r->first) / r->stride + 1;
  PetscCheck(r->all_steps || r->last_step || r->last <= steps, grid->comm, SAM_ERR_USER,
             "-steps: there is no step %" PetscInt_FMT " in %s, the last is %" PetscInt_FMT, r->last, r->input, steps);
  PetscCall(PetscMalloc1(*count, list));
  for (PetscInt k = 0; k < *count; k++) {
    const PetscInt step = r->first + k * r->stride;

    (*list)[k] = r->all_steps ? k : saved - 1;
    if (r->all_steps || r->last_step) continue;
    PetscCall(FindSaved(results, step, &(*list)[k]));
    PetscCheck((*list)[k] >= 0, grid->comm, SAM_ERR_USER,
               "-steps: step %" PetscInt_FMT " of %s has not been saved (-output_every of its run)", step, r->input);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

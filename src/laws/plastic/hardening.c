/* The hardening of a body that yields as an option: its kind and constants in one text, "voce:186MPa,222". */
#include "mises.h"
#include <petsam/private/base.h>
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>

/*
  SamHardeningKind - its word, an example, and the constants in their order: name, SI unit (NULL: none), range, and
  maximum (0: none). Metals have B up to some thousands, E0 below 0.1 and N below 0.6. Beyond the maxima the yield
  stress is at its end after a strain of 1e-6, does not change within one of 1, or grows faster than the strain.
*/
typedef struct {
  const char *word, *example;
  struct {
    const char *name, *unit;
    SamRange    range;
    double      most;
  } constant[SAM_HARDENING_CONSTANTS]; /* without a name: it has fewer */
} SamHardeningKind;

static const SamHardeningKind kinds[] = {
  [SAM_HARDENING_NONE]   = {"none", "none", {{0}}},
  [SAM_HARDENING_LINEAR] = {"linear", "linear:2GPa", {{"H", "Pa", SAM_RANGE_NONNEGATIVE}}},
  [SAM_HARDENING_VOCE]   = {"voce",
                            "voce:186MPa,222",
                            {{"Q", "Pa", SAM_RANGE_NONNEGATIVE}, {"B", NULL, SAM_RANGE_NONNEGATIVE, 1e6}}},
  [SAM_HARDENING_SWIFT]  = {
     "swift", "swift:1e-3,0.2", {{"E0", NULL, SAM_RANGE_POSITIVE, 1}, {"N", NULL, SAM_RANGE_NONNEGATIVE, 1}}}};

/* Returns the kind whose word is the first `length` characters of a text; NULL: none. */
static const SamHardeningKind *FindKind(const char text[], size_t length)
{
  for (size_t k = 0; k < sizeof(kinds) / sizeof(kinds[0]); k++)
    if (!strncmp(kinds[k].word, text, length) && !kinds[k].word[length]) return &kinds[k];
  return NULL;
}

/* Returns the number of constants of a kind. */
static PetscInt CountOf(const SamHardeningKind *kind)
{
  PetscInt count = 0;

  while (count < SAM_HARDENING_CONSTANTS && kind->constant[count].name) count++;
  return count;
}

/* Returns true if a value is one that a constant of a kind may have. */
static PetscBool IsGood(const SamHardeningKind *kind, PetscInt c, double value)
{
  const double most = kind->constant[c].most;

  return SamRangeHas(kind->constant[c].range, value) && (most == 0 || value <= most) ? PETSC_TRUE : PETSC_FALSE;
}

/* Reads the constants behind the word; returns true if they are right, or writes why a number is none. */
static PetscBool ReadConstants(const SamHardeningKind *kind, const char text[], double value[], char why[], size_t size)
{
  PetscBool scaled;

  for (PetscInt c = 0; c < CountOf(kind); c++) {
    const char *const from = text + 1, *const unit = kind->constant[c].unit;
    char number[SAM_HARDENING_TEXT];

    if (*text != (c ? ',' : ':')) return PETSC_FALSE;
    if (!SamReadReal(unit, from, &text, &value[c], &scaled) || !IsGood(kind, c, value[c])) {
      (void)snprintf(number, sizeof(number), "%.*s", (int)strcspn(from, ","), from);
      if (number[0]) SamExplainNumber(number, unit, why, size);
      return PETSC_FALSE;
    }
  }
  return *text ? PETSC_FALSE : PETSC_TRUE;
}

/* Writes what is expected: "voce:Q,B with Q a number >= 0 (Pa), B a number >= 0, for example voce:186MPa,222". */
static void Describe(const SamHardeningKind *kind, char text[], size_t size)
{
  char form[32] = "", with[160] = "";

  for (PetscInt c = 0; c < CountOf(kind); c++) {
    const char *name = kind->constant[c].name, *unit = kind->constant[c].unit;
    char        most[32] = "";
    size_t      used     = strlen(form);

    (void)snprintf(form + used, sizeof(form) - used, "%c%s", c ? ',' : ':', name);
    if (kind->constant[c].most > 0) (void)snprintf(most, sizeof(most), " and <= %g", kind->constant[c].most);
    used = strlen(with);
    (void)snprintf(with + used, sizeof(with) - used, "%s%s %s%s%s%s%s", c ? ", " : " with ", name,
                   SamRangeDescribe(kind->constant[c].range), most, unit ? " (" : "", unit ? unit : "",
                   unit ? ")" : "");
  }
  (void)snprintf(text, size, "%s%s%s, for example %s", kind->word, form, with, kind->example);
}

PetscErrorCode SamHardeningRead(const SamOptions *from, const char option[], const char text[], SamHardening *h)
{
  const size_t                  length        = strcspn(text, ":");
  const SamHardeningKind *const kind          = FindKind(text, length);
  char                          expected[256] = SAM_HARDENING_FORMS ", for example linear:2GPa", why[192] = "";

  PetscFunctionBegin;
  *h = (SamHardening){.type = kind ? (SamHardeningType)(kind - kinds) : SAM_HARDENING_NONE};
  if (kind && CountOf(kind)) Describe(kind, expected, sizeof(expected));
  PetscCheck(kind && ReadConstants(kind, text + length, h->constant, why, sizeof(why)), from->comm, SAM_ERR_USER,
             "-%s%s %s: expected %s%s", SamOptionsPrefix(from), option, text, expected, why);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamHardeningWrite(const SamHardening *h, char text[], size_t size)
{
  const SamHardeningKind *kind = &kinds[h->type];
  size_t                  used = (size_t)snprintf(text, size, "%s", kind->word);

  for (PetscInt c = 0; c < CountOf(kind) && used < size; c++) {
    char number[32];

    (void)snprintf(number, sizeof(number), "%.15g", h->constant[c]);
    if (strtod(number, NULL) != h->constant[c]) (void)snprintf(number, sizeof(number), "%.17g", h->constant[c]);
    used += (size_t)snprintf(text + used, size - used, "%c%s", c ? ',' : ':', number);
  }
}

/*
  Suggests the intended meaning of a mistyped option: the nearest known name, a decimal comma, a unit.

  Known names are all options that have been queried so far, given or not.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/base.h>
#include <ctype.h>
#include <stdlib.h>
#include <strings.h>

#define MOST   256 /* number of names that are kept */
#define LENGTH 48  /* characters of a name that are compared */

static char     known[MOST][LENGTH], belongs[MOST][LENGTH]; /* belongs: what the option needs; or empty */
static PetscInt knowns = 0;

/* Options that PETSc reads; their names are suggested, too */
static const char *const petsc[] = {"options_file", "log_view", "options_left", "help", "version"};

/* Options that have another name since version 1.0.0, and the form of the value where it is another one, too */
static const char *const renamed[][3] = {{"plastic_depth", "yield_depth"},
                                         {"plastic_layers", "yield_layers"},
                                         {"plastic_first", "yield_first"},
                                         {"plastic_rtol", "yield_rtol"},
                                         {"body1_layer_stress", "body1_initial_stress"},
                                         {"body2_layer_stress", "body2_initial_stress"},
                                         {"body1_hardening_modulus", "body1_hardening", " linear:H"},
                                         {"body1_voce_stress", "body1_hardening", " voce:Q,B"},
                                         {"body1_voce_rate", "body1_hardening", " voce:Q,B"},
                                         {"body1_swift_strain", "body1_hardening", " swift:E0,N"},
                                         {"body1_swift_exponent", "body1_hardening", " swift:E0,N"},
                                         {"body2_hardening_modulus", "body2_hardening", " linear:H"},
                                         {"body2_voce_stress", "body2_hardening", " voce:Q,B"},
                                         {"body2_voce_rate", "body2_hardening", " voce:Q,B"},
                                         {"body2_swift_strain", "body2_hardening", " swift:E0,N"},
                                         {"body2_swift_exponent", "body2_hardening", " swift:E0,N"}};

/* PETSc ignores the case of letters in names; a dash within a name is a likely slip. */
static char Plain(char c)
{
  return c == '-' ? '_' : (char)tolower((unsigned char)c);
}

/* Returns the length of a name up to an equals sign and a value after it, which other programs allow. */
static size_t LengthOf(const char name[])
{
  return PetscMin(strcspn(name, "="), LENGTH);
}

/*
  Returns twice the number of slips between two names: letters omitted, inserted, changed, or swapped with the next one
  (optimal string alignment distance). An omitted or inserted underscore is half a slip.
*/
static size_t CountSlips(const char a[], const char b[])
{
  const size_t n = LengthOf(a), m = LengthOf(b);
  size_t       slips[LENGTH + 1][LENGTH + 1];

  for (size_t i = 0; i <= n; i++) slips[i][0] = 2 * i;
  for (size_t j = 0; j <= m; j++) slips[0][j] = 2 * j;
  for (size_t i = 1; i <= n; i++)
    for (size_t j = 1; j <= m; j++) {
      const char   c = Plain(a[i - 1]), d = Plain(b[j - 1]);
      const size_t change = slips[i - 1][j - 1] + (c == d ? 0 : 2), less = slips[i - 1][j] + (c == '_' ? 1 : 2),
                   more = slips[i][j - 1] + (d == '_' ? 1 : 2);

      slips[i][j] = change < less ? change : less;
      if (more < slips[i][j]) slips[i][j] = more;
      if (i > 1 && j > 1 && c == Plain(b[j - 2]) && d == Plain(a[i - 2]) && slips[i - 2][j - 2] + 2 < slips[i][j])
        slips[i][j] = slips[i - 2][j - 2] + 2;
    }
  return slips[n][m];
}

/* True if one name may be a misspelling of the other. */
static PetscBool IsNear(const char tried[], const char name[])
{
  const size_t length = LengthOf(tried);

  return CountSlips(tried, name) <= (length < 4 ? 0 : length < 6 ? 2 : length < 10 ? 4 : 6);
}

const char *SamNearestName(const char tried[], size_t count, const char *const names[])
{
  const char *nearest = NULL;
  size_t      least   = 2 * LENGTH;

  for (size_t k = 0; k < count; k++) {
    const size_t slips = CountSlips(tried, names[k]);

    if (slips >= least || !IsNear(tried, names[k])) continue;
    least   = slips;
    nearest = names[k];
  }
  return nearest;
}

/* ---- options ---- */

static PetscInt FindKnown(const char name[])
{
  for (PetscInt k = 0; k < knowns; k++)
    if (!strcasecmp(known[k], name)) return k;
  return -1;
}

void SamOptionsKnow(const SamOptions *from, const char name[], const char with[])
{
  char     option[LENGTH] = "";
  PetscInt k;

  (void)snprintf(option, sizeof(option), "%.*s%s", LENGTH / 2, SamOptionsPrefix(from), name);
  k = FindKnown(option);
  if (k < 0 && knowns < MOST) {
    k = knowns++;
    memcpy(known[k], option, sizeof(option));
  }
  if (k >= 0 && with) (void)snprintf(belongs[k], sizeof(belongs[k]), "%s", with);
}

PetscBool SamOptionsIsKnown(const char name[], const char **with)
{
  const PetscInt k = FindKnown(name);

  if (with) *with = k >= 0 && belongs[k][0] ? belongs[k] : NULL;
  return k >= 0;
}

const char *SamOptionsNearest(const char tried[])
{
  const char *names[MOST + sizeof(petsc) / sizeof(petsc[0])];
  size_t      count = 0;

  for (size_t k = 0; k < sizeof(renamed) / sizeof(renamed[0]); k++)
    if (!strcasecmp(tried, renamed[k][0])) return renamed[k][1];
  for (PetscInt k = 0; k < knowns; k++) names[count++] = known[k];
  for (size_t k = 0; k < sizeof(petsc) / sizeof(petsc[0]); k++) names[count++] = petsc[k];
  return SamNearestName(tried, count, names);
}

const char *SamOptionsForm(const char tried[])
{
  for (size_t k = 0; k < sizeof(renamed) / sizeof(renamed[0]); k++)
    if (!strcasecmp(tried, renamed[k][0]) && renamed[k][2]) return renamed[k][2];
  return "";
}

/*
  Finds an unused option on the command line that may be a misspelling of this name; if there is none, one of any option
  that has been read, whose name then replaces it.
*/
static PetscErrorCode FindMisspelled(char name[], char found[], size_t size)
{
  PetscInt count;
  char   **names, **values;

  PetscFunctionBegin;
  found[0] = '\0';
  PetscCall(PetscOptionsLeftGet(NULL, &count, &names, &values));
  for (PetscInt k = 0; k < count && !found[0]; k++)
    if (IsNear(names[k], name) && !SamOptionsIsKnown(names[k], NULL)) (void)snprintf(found, size, "%s", names[k]);
  for (PetscInt k = 0; k < count && !found[0]; k++) {
    const char *nearest = SamOptionsIsKnown(names[k], NULL) ? NULL : SamOptionsNearest(names[k]);

    if (!nearest || !SamOptionsIsKnown(nearest, NULL)) continue;
    (void)snprintf(found, size, "%s", names[k]);
    (void)snprintf(name, LENGTH, "%s", nearest);
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsRequire(const SamOptions *from, PetscBool given, const char name[], const char text[])
{
  const char *prefix = SamOptionsPrefix(from);
  char        option[LENGTH], meant[LENGTH];

  PetscFunctionBegin;
  if (given) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(option, sizeof(option), "%.*s%.*s", LENGTH / 2, prefix, (int)strcspn(name, " "), name);
  PetscCall(FindMisspelled(option, meant, sizeof(meant)));
  PetscCheck(!meant[0], from->comm, SAM_ERR_USER, "-%s: unknown option: is -%s%s meant? -%s%s is missing: %s", meant,
             option, SamOptionsForm(meant), prefix, name, text);
  SETERRQ(from->comm, SAM_ERR_USER, "-%s%s is missing: %s", prefix, name, text);
}

/* ---- values ---- */

PetscBool SamIsDecimalComma(const char text[])
{
  const char  *comma = strchr(text, ',');
  const size_t first = text[0] == '-' || text[0] == '+' ? 1 : 0;

  if (!comma || !isdigit((unsigned char)comma[1]) || comma == text + first) return PETSC_FALSE;
  return strspn(text + first, "0123456789") == (size_t)(comma - text) - first;
}

/* Returns the text after a number at the beginning and after white space; NULL if there is no number. */
static const char *FindBehind(const char text[])
{
  char *end;

  (void)strtod(text, &end);
  if (end == text) return NULL;
  while (isspace((unsigned char)*end)) end++;
  return end;
}

void SamExplainNumber(const char text[], const char unit[], char why[], size_t size)
{
  const char  *rest = FindBehind(text);
  char         units[64], *end;
  const double number = strtod(text, &end);

  SamListUnits(unit, units, sizeof(units));
  why[0] = '\0';
  if (end != text && !*end && !isfinite(number)) {
    (void)snprintf(why, size, isnan(number) ? "; nan is no number" : "; the number is infinite, or too large");
    return;
  }
  if (rest && (isalpha((unsigned char)*rest) || isalpha((unsigned char)text[strlen(text) - 1])))
    (void)snprintf(why, size,
                   units[0] ? "; the units allowed, behind each number: %s"
                            : "; without a unit: all numbers are in SI units (m, N, Pa), 2.6e-3 for 2.6 mm",
                   units);
  for (rest = text; *rest; rest++) /* at any place, as in 2.6e-3,2,6e-3 */
    if ((rest == text || rest[-1] == ',') && SamIsDecimalComma(rest))
      (void)snprintf(why, size, "; numbers have a decimal point, not a comma");
}

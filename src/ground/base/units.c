/*
  Units after the numbers of options: 2.6mm is 2.6e-3, to the last bit.

  An option's row declares its unit of SI. The units that may follow a number differ from it by powers of ten only, so
  the number is read with another exponent. Two units of force, which come last, differ by a factor.
*/
#include <petsam/private/baseimpl.h>
#include <errno.h>
#include <stdlib.h>

#define MOST 8 /* number of units that may follow */
#define KGF  9.80665
#define LBF  (0.45359237 * KGF)

typedef struct {
  const char *si, *name[MOST];
  int         power[MOST];
} Kind;

static const Kind kinds[] = {{"m", {"m", "mm", "um", "nm"}, {0, -3, -6, -9}},
                             {"N", {"N", "kN", "MN", "mN", "uN", "nN", "kgf", "lbf"}, {0, 3, 6, -3, -6, -9}},
                             {"N/m", {"N/m", "kN/m", "MN/m", "N/mm", "mN/m", "uN/m"}, {0, 3, 6, 3, -3, -6}},
                             {"N m", {"Nm", "kNm", "Nmm", "mNm", "uNm", "nNm"}, {0, 3, -3, -3, -6, -9}},
                             {"N m/m", {"N", "kN", "mN", "uN", "nN", "Nm/m"}, {0, 3, -3, -6, -9, 0}},
                             {"Pa", {"Pa", "kPa", "MPa", "GPa"}, {0, 3, 6, 9}},
                             {"m/s", {"m/s", "mm/s", "um/s"}, {0, -3, -6}},
                             {"J/m2", {"J/m2", "mJ/m2", "uJ/m2"}, {0, -3, -6}},
                             {"s", {"s", "ms", "us"}, {0, -3, -6}},
                             {"rad", {"rad", "mrad"}, {0, -3}},
                             {"1/Pa", {"m3/Nm", "mm3/Nm"}, {0, -9}}, /* no digit, as it would be part of the number */
                             {"m3/J", {"m3/J", "mm3/J"}, {0, -9}},
                             {"1", {"%"}, {-2}}};

/* Returns the factor of a unit beside its power of ten. */
static double FactorOf(const char name[])
{
  if (!strcmp(name, "kgf")) return KGF;
  return strcmp(name, "lbf") ? 1 : LBF;
}

/* Returns the kind of a unit; NULL if there is none, or if the option takes numbers in SI units only. */
static const Kind *FindKind(const char unit[])
{
  for (size_t k = 0; unit && k < sizeof(kinds) / sizeof(kinds[0]); k++)
    if (!strcmp(kinds[k].si, unit)) return &kinds[k];
  return NULL;
}

/* Reads the first `length` characters as a number, with the exponent raised by `power`. */
static double ReadScaled(const char number[], size_t length, int power)
{
  const size_t digits = PetscMin(length, strcspn(number, "eE"));
  char         text[128];

  (void)snprintf(text, sizeof(text), "%.*se%ld", (int)digits, number,
                 power + (digits < length ? strtol(number + digits + 1, NULL, 10) : 0));
  return strtod(text, NULL);
}

PetscBool SamReadReal(const char si[], const char text[], const char **end, double *value, PetscBool *unit)
{
  const Kind *kind = FindKind(si);
  char       *name;
  size_t      size, length;

  errno  = 0;
  *value = strtod(text, &name);
  size   = (size_t)(name - text);
  length = strcspn(name, ",");
  *end   = name + length;
  *unit  = length ? PETSC_TRUE : PETSC_FALSE;
  if (!size || (errno == ERANGE && (isinf(*value) || *value == 0))) return PETSC_FALSE;
  if (memchr(text, 'x', size) || memchr(text, 'X', size)) return PETSC_FALSE; /* hexadecimal */
  if (!length) return PETSC_TRUE;
  if (size > 64 || strspn(text, "+-.0123456789eE") != size) return PETSC_FALSE; /* excludes inf */
  for (int k = 0; kind && k < MOST && kind->name[k]; k++)
    if (strlen(kind->name[k]) == length && !strncmp(kind->name[k], name, length)) {
      *value = ReadScaled(text, size, kind->power[k]);
      *value *= FactorOf(kind->name[k]);
      return isfinite(*value) ? PETSC_TRUE : PETSC_FALSE;
    }
  return PETSC_FALSE;
}

void SamListUnits(const char unit[], char list[], size_t size)
{
  const Kind *kind  = FindKind(unit);
  PetscInt    count = 0;

  while (kind && count < MOST && kind->name[count]) count++;
  SamJoin(count, kind ? kind->name : NULL, ", ", " or ", list, size);
}

const char *SamUnitOf(int k, int n, int *power)
{
  if (k >= (int)(sizeof(kinds) / sizeof(kinds[0])) || n >= MOST) return NULL;
  if (n >= 0 && kinds[k].name[n] && FactorOf(kinds[k].name[n]) != 1) return NULL;
  *power = n < 0 ? 0 : kinds[k].power[n];
  return n < 0 ? kinds[k].si : kinds[k].name[n];
}

void SamAddUnit(const char text[], const char unit[], char whole[], size_t size)
{
  const char *place = unit ? strstr(text, "()") : NULL;

  if (unit && !place) place = strstr(text, "(,");
  if (place)
    (void)snprintf(whole, size, "%.*s%s%s", (int)(place + 1 - text), text, unit, place + 1);
  else
    (void)snprintf(whole, size, "%s%s%s%s", text, unit ? " (" : "", unit ? unit : "", unit ? ")" : "");
}

void SamExplainStress(double stress, double young, double least, double most, char why[], size_t size)
{
  const double ratio = fabs(stress) / young;

  why[0] = '\0';
  if (isinf(young) || stress == 0) return;
  if (ratio < least)
    (void)snprintf(why, size, "is %.2g of Young's modulus, expected at least %g of it: check the unit, Pa", ratio,
                   least);
  else if (!(ratio <= most))
    (void)snprintf(why, size, "is %.2g of Young's modulus, expected at most %g of it: check the unit, Pa", ratio, most);
}

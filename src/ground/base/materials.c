/*
  Materials by name: the one table of constants, from which the programs, the manual and the Python side take them.

  Values are those at room temperature. What a source does not state is NAN. Names are compared without regard to the
  case of letters, blanks, hyphens and underscores.
*/
#include <petsam/private/baseimpl.h>
#include <ctype.h>

#define LENGTH 40 /* characters of a name that are compared */
#define SPACED ", "

/* Sources of several rows */
#define BEARINGS \
  "SKF, Rolling bearings, catalogue 17000 (2018); Poisson's ratio: Harris, Rolling Bearing Analysis, 4th ed. (2001)"
#define KAYE    "Kaye and Laby, Tables of Physical and Chemical Constants, 16th ed. (1995)"
#define THERMAL "; thermal: Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, 5th ed. (2002)"

enum { COUNT = 16 };
static const SamNamedMaterial table[COUNT] = {
  {"steel",
   "carbon steel, mild steel",
   {210e9, 0.3, 7850, 53.3, 440, 12e-6, NAN, NAN, NAN, NAN, NAN},
   "EN 1993-1-1 (2005), 3.2.6; density, conductivity, specific heat: EN 1993-1-2 (2005), 3.4"},
  {"100Cr6",
   "bearing steel, 52100, AISI 52100, SUJ2, 1.3505",
   {210e9, 0.3, 7900, NAN, NAN, 12e-6, NAN, NAN, NAN, NAN, NAN},
   BEARINGS},
  {"304",
   "stainless steel, stainless, AISI 304, 1.4301, X5CrNi18-10",
   {193e9, 0.29, 8000, 16.2, 500, 17.2e-6, 205e6, NAN, NAN, NAN, NAN},
   "ASM Handbook, vol. 1 (1990), annealed; Poisson's ratio: Ledbetter et al., J. Appl. Phys. 46 (1975) 3855; yield: "
   "least of ASTM A240"},
  {"Ti-6Al-4V",
   "titanium, titanium alloy, Ti64, TA6V, 3.7165",
   {115e9, 0.32, 4430, 6.7, 526, 8.6e-6, 828e6, 2030e6, -0.104, 0.841, -0.688},
   "E, nu: Araujo and Nowell, Int. J. Fatigue 24 (2002) 763; thermal: Materials Properties Handbook: Titanium Alloys, "
   "ASM (1994); yield: least of ASTM B265, annealed; fatigue: Dowling, Mechanical Behavior of Materials, 4th ed. "
   "(2013), solution treated and aged"},
  {"Inconel-718",
   "nickel, nickel alloy, alloy 718, IN718, 2.4668",
   {200e9, 0.29, 8220, 11.4, 435, 13e-6, 1034e6, NAN, NAN, NAN, NAN},
   "Special Metals, Inconel alloy 718, SMC-045 (2007), aged; yield: least of AMS 5662"},
  {"aluminium",
   "aluminum",
   {70e9, 0.33, 2702, 237, 903, 23e-6, NAN, NAN, NAN, NAN, NAN},
   "E, nu, expansion: Gere and Goodno, Mechanics of Materials, 8th ed. (2013), alloys; density, conductivity, specific "
   "heat: Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, 5th ed. (2002), pure"},
  {"7075-T6",
   "7075, aluminium 7075-T6, aluminum 7075-T6, EN AW-7075",
   {71e9, 0.33, 2800, 130, 960, 23.6e-6, 503e6, 1466e6, -0.143, 0.262, -0.619},
   "ASM Handbook, vol. 2 (1990); fatigue: Dowling, Mechanical Behavior of Materials, 4th ed. (2013)"},
  {"2024-T3",
   "2024, aluminium 2024-T3, aluminum 2024-T3, EN AW-2024",
   {72.4e9, 0.33, 2770, 120, 875, 23.2e-6, 345e6, NAN, NAN, NAN, NAN},
   "ASM Handbook, vol. 2 (1990)"},
  {"cast-iron",
   "grey cast iron, gray cast iron, grey iron, gray iron, EN-GJL-250",
   {110e9, 0.26, 7200, 48.5, 460, 11.7e-6, NAN, NAN, NAN, NAN, NAN},
   "EN 1561 (1997), annex A, EN-GJL-250 (103 to 118 GPa; conductivity at 100, expansion to 200 degrees C)"},
  {"bronze",
   "phosphor bronze, tin bronze, C52100, CuSn8",
   {110e9, 0.34, 8800, 62.3, 377, 18.2e-6, NAN, NAN, NAN, NAN, NAN},
   "Copper Development Association, data sheet C52100; Poisson's ratio: Gere and Goodno, Mechanics of Materials, 8th "
   "ed. (2013)"},
  {"copper", "Cu", {129.8e9, 0.343, 8933, 401, 385, NAN, NAN, NAN, NAN, NAN, NAN}, KAYE THERMAL},
  {"brass",
   "cartridge brass, C26000, CuZn30",
   {100.6e9, 0.35, 8530, 110, 380, NAN, NAN, NAN, NAN, NAN, NAN},
   KAYE ", 70/30" THERMAL},
  {"WC-Co",
   "tungsten carbide, cemented carbide, hard metal, WC, WC-6Co",
   {648e9, 0.22, 15000, 100, NAN, 4.3e-6, NAN, NAN, NAN, NAN, NAN},
   "ASM Handbook, vol. 2 (1990), 94WC-6Co, medium grain; Poisson's ratio: Kaye and Laby, 16th ed. (1995)"},
  {"Si3N4", "silicon nitride", {310e9, 0.26, 3200, NAN, NAN, 3e-6, NAN, NAN, NAN, NAN, NAN}, BEARINGS},
  {"alumina",
   "Al2O3, aluminium oxide, aluminum oxide",
   {416e9, 0.231, 3984, 33, 755, 4.6e-6, NAN, NAN, NAN, NAN, NAN},
   "Munro, J. Am. Ceram. Soc. 80 (1997) 1919, sintered alpha alumina"},
  {"gold", "Au", {78e9, 0.44, 19300, 317, 129, NAN, NAN, NAN, NAN, NAN, NAN}, KAYE THERMAL}};

static const SamMaterialConstant constants[SAM_MATERIAL_CONSTANTS] = {
  {"young", "Pa", "Young's modulus"},
  {"poisson", "1", "Poisson's ratio"},
  {"density", "kg/m3", "density"},
  {"conductivity", "W/(m K)", "thermal conductivity"},
  {"specific_heat", "J/(kg K)", "specific heat"},
  {"expansion", "1/K", "coefficient of thermal expansion"},
  {"yield", "Pa", "yield stress"},
  {"sigma_f", "Pa", "fatigue strength coefficient"},
  {"b", "1", "fatigue strength exponent"},
  {"epsilon_f", "1", "fatigue ductility coefficient"},
  {"c", "1", "fatigue ductility exponent"}};

const SamNamedMaterial *SamMaterialAt(PetscInt k)
{
  return k >= 0 && k < COUNT ? &table[k] : NULL;
}

const SamMaterialConstant *SamMaterialConstantAt(PetscInt k)
{
  return k >= 0 && k < SAM_MATERIAL_CONSTANTS ? &constants[k] : NULL;
}

/* ---- names ---- */

/* Writes the letters and digits of the first `length` characters that count in a comparison. */
static void Plain(const char text[], size_t length, char plain[LENGTH])
{
  size_t used = 0;

  for (size_t k = 0; k < length && used + 1 < LENGTH; k++)
    if (!strchr(" -_", text[k])) plain[used++] = (char)tolower((unsigned char)text[k]);
  plain[used] = '\0';
}

/* Moves past one of the names of a material, which it writes as they are compared; false: there are no more. */
static PetscBool NextName(const SamNamedMaterial *m, const char **at, char plain[LENGTH])
{
  const char *from = *at ? *at : m->name;
  size_t      length;

  if (!*from) return PETSC_FALSE;
  length = *at ? strcspn(from, ",") : strlen(from);
  Plain(from, length, plain);
  *at = *at ? from + length + (from[length] ? strlen(SPACED) : 0) : m->aliases;
  return PETSC_TRUE;
}

const SamNamedMaterial *SamMaterialFind(const char name[])
{
  char tried[LENGTH], plain[LENGTH];

  if (strlen(name) >= LENGTH) return NULL;
  Plain(name, strlen(name), tried);
  for (PetscInt k = 0; k < COUNT && tried[0]; k++) {
    const char *at = NULL;

    while (NextName(&table[k], &at, plain))
      if (!strcmp(plain, tried)) return &table[k];
  }
  return NULL;
}

/* Returns the material with the name most similar to one that was tried; NULL: none is similar. */
static const SamNamedMaterial *FindNearest(const char name[])
{
  enum { MOST = 8 * COUNT };
  static char plain[MOST][LENGTH];
  const char *names[MOST], *nearest;
  PetscInt    owner[MOST];
  size_t      count = 0;
  char        tried[LENGTH];

  for (PetscInt k = 0; k < COUNT; k++) {
    const char *at = NULL;

    while (count < MOST && NextName(&table[k], &at, plain[count])) {
      owner[count] = k;
      names[count] = plain[count];
      count++;
    }
  }
  Plain(name, strlen(name), tried);
  nearest = SamNearestName(tried, count, names);
  for (size_t n = 0; n < count; n++)
    if (names[n] == nearest) return &table[owner[n]];
  return NULL;
}

void SamMaterialList(const char between[], char text[], size_t size)
{
  const char *names[COUNT];

  for (PetscInt k = 0; k < COUNT; k++) names[k] = table[k].name;
  SamJoin(COUNT, names, between, between, text, size);
}

void SamMaterialExplain(const char name[], char text[], size_t size)
{
  const SamNamedMaterial *nearest = FindNearest(name);
  char                    names[512];

  SamMaterialList(", ", names, sizeof(names));
  if (nearest)
    (void)snprintf(text, size, "no such material: is %s meant? There are %s", nearest->name, names);
  else
    (void)snprintf(text, size, "no such material: expected one of %s", names);
}

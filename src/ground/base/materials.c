/*
  Materials by name: the one table of constants, from which the programs, the manual and the Python side take them.

  Values are those at room temperature. What a source does not state is NAN. Names are compared without regard to the
  case of letters, blanks, hyphens and underscores. Other names are those that mean one material: the name of an element
  its metal, but titanium the alloy Ti-6Al-4V. A nickel alloy is none, as there are many.
*/
#include <petsam/private/baseimpl.h>
#include <ctype.h>

#define LENGTH 40 /* characters of a name that are compared */
#define SPACED ", "

/* Sources of several rows */
#define ASM      "ASM data sheet, asm.matweb.com, "
#define BEARINGS "SNFA, silicon nitride and bearing steel, cantonicuscinetti.com (expansion to "
#define DOWLING  "Dowling, Mechanical Behavior of Materials, 4th ed. (2013), "
#define GERE     "Gere, Mechanics of Materials, 5th ed. (2001)"
#define THERMAL \
  "; density, thermal: Bergman et al., Fundamentals of Heat and Mass Transfer, 7th ed. (2011); expansion: Callister " \
  "and Rethwisch, Materials Science and Engineering, 8th ed. (2010)"

enum { COUNT = 17 };
static const SamNamedMaterial table[COUNT] = {
  {"steel",
   "carbon steel, mild steel",
   {210e9, 0.3, 7850, 53.3, 440, 12e-6, NAN, NAN, NAN, NAN, NAN},
   "EN 1993-1-1 (2005), 3.2.6; density, conductivity, specific heat: EN 1993-1-2 (2005), 3.4"},
  {"100Cr6",
   "bearing steel, 52100, AISI 52100, SUJ2, 1.3505",
   {210e9, 0.3, 7800, NAN, NAN, 11e-6, NAN, NAN, NAN, NAN, NAN},
   BEARINGS "300 degrees C)"},
  {"304",
   "stainless steel, stainless, AISI 304, 1.4301, X5CrNi18-10",
   {193e9, 0.29, 8000, 16.2, 500, 17.3e-6, 215e6, NAN, NAN, NAN, NAN},
   ASM "MQ304A, annealed (193 to 200 GPa)"},
  {"Ti-6Al-4V",
   "titanium, titanium alloy, Ti64, TA6V, 3.7165",
   {113.8e9, 0.342, 4430, 6.7, 526, 8.6e-6, 880e6, 2030e6, -0.104, NAN, NAN},
   ASM "MTP641, annealed; fatigue: " DOWLING "table 9.1, solution treated and aged"},
  {"nickel",
   "Ni",
   {207e9, 0.31, 8900, 90.7, 444, 13.3e-6, NAN, NAN, NAN, NAN, NAN},
   "pure; E: as expansion, table 6.1; nu: " GERE THERMAL},
  {"Inconel-718",
   "alloy 718, IN718, 2.4668",
   {200e9, 0.29, 8220, 11.4, 435, 13.2e-6, NAN, NAN, NAN, NAN, NAN},
   "Special Metals, Inconel alloy 718, SMC-045 (2007), aged (expansion to 93 degrees C)"},
  {"aluminium",
   "aluminum",
   {70e9, 0.33, 2702, 237, 903, 23.6e-6, NAN, NAN, NAN, NAN, NAN},
   "E, nu of alloys: " GERE "; the others of the pure metal" THERMAL},
  {"7075-T6",
   "7075, aluminium 7075-T6, aluminum 7075-T6, EN AW-7075",
   {71.7e9, 0.33, 2810, 130, 960, 23.6e-6, 503e6, 1466e6, -0.143, 0.262, -0.619},
   ASM "MA7075T6; fatigue: " DOWLING "table 14.1"},
  {"2024-T3",
   "2024, aluminium 2024-T3, aluminum 2024-T3, EN AW-2024",
   {73.1e9, 0.33, 2780, 121, 875, 23.2e-6, 345e6, NAN, NAN, NAN, NAN},
   ASM "MA2024T3"},
  {"grey-cast-iron",
   "cast iron, gray cast iron, grey iron, gray iron, EN-GJL-250",
   {110e9, 0.26, 7200, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN},
   "DIN EN 1561, EN-GJL-250 (103 to 118 GPa), from the tables of sn-castiron.nl"},
  {"bronze",
   "phosphor bronze, tin bronze, C52100, CuSn8",
   {110e9, 0.34, 8800, 62, 370, 18e-6, NAN, NAN, NAN, NAN, NAN},
   "makeitfrom.com, UNS C52100 (CW453K) Phosphor Bronze"},
  {"copper",
   "Cu",
   {130e9, 0.343, 8933, 401, 385, 17e-6, NAN, NAN, NAN, NAN, NAN},
   "pure; E, nu: " DOWLING "table 5.2" THERMAL},
  {"brass",
   "cartridge brass, C26000, CuZn30",
   {101e9, 0.35, 8530, 110, 380, 20e-6, NAN, NAN, NAN, NAN, NAN},
   "70Cu-30Zn; E, nu: " DOWLING "table 5.2" THERMAL},
  {"WC-Co",
   "tungsten carbide, cemented carbide, hard metal",
   {630e9, 0.24, 14600, 85, 280, 5.4e-6, NAN, NAN, NAN, NAN, NAN},
   "makeitfrom.com, Tungsten Carbide (WC), a cemented grade by its density and strength"},
  {"Si3N4",
   "silicon nitride",
   {315e9, 0.26, 3190, NAN, NAN, 3.2e-6, NAN, NAN, NAN, NAN, NAN},
   BEARINGS "1000 degrees C)"},
  {"alumina",
   "Al2O3, aluminium oxide, aluminum oxide",
   {416e9, 0.231, 3984, 33, 755, 4.6e-6, NAN, NAN, NAN, NAN, NAN},
   "Munro, J. Am. Ceram. Soc. 80 (1997) 1919, sintered alpha alumina: NIST SRD 150, "
   "srdata.nist.gov/CeramicDataPortal/Pds/Scdaos"},
  {"gold",
   "Au",
   {78e9, 0.44, 19300, 317, 129, 14.2e-6, NAN, NAN, NAN, NAN, NAN},
   "pure; E, nu: webelements.com/gold/physics.html" THERMAL}};

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

const SamNamedMaterial *SamMaterialElastic(const char text[], SamNamedMaterial *m)
{
  const char *end;
  double      young, poisson;
  PetscBool   unit;

  if (!SamReadReal("Pa", text, &end, &young, &unit) || *end != ',') return NULL;
  if (!SamReadReal(NULL, end + 1, &end, &poisson, &unit) || *end) return NULL;
  m->name    = text;
  m->aliases = m->source = "";
  for (PetscInt k = 0; k < SAM_MATERIAL_CONSTANTS; k++) m->value[k] = NAN;
  m->value[0] = young;
  m->value[1] = poisson;
  return m;
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

/* Bodies: their materials from the surface down, options, records and advice. */
#include <petsam/private/bodyimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <math.h>

#define LAYERS (SAM_MATERIALS - 1) /* maximum number of materials above the last one */

/*
  Writes a message about the fault of a material, with its constants, whose names begin with `name`; empty: no fault.
*/
static PetscErrorCode FindFaultOf(const SamMaterial *m, const char name[], char message[], size_t size)
{
  const PetscReal inverse_shear = isinf(m->young) ? 0 : 2 * (1 + m->poisson) / m->young;

  PetscFunctionBegin;
  if (!(m->young > 0))
    PetscCall(PetscSNPrintf(message, size, "%syoung %.6g: expected a number > 0 or inf", name, (double)m->young));
  else if (!(m->poisson > -1 && m->poisson <= 0.5))
    PetscCall(PetscSNPrintf(message, size, "%spoisson %.6g: expected a number above -1 and at most 0.5%s", name,
                            (double)m->poisson, m->poisson > 1 ? ": 0.3, not 30 percent" : ""));
  else if (!isfinite(inverse_shear) || (inverse_shear == 0 && !isinf(m->young)))
    PetscCall(PetscSNPrintf(message, size, "%syoung %.6g: its compliance is out of range in double precision", name,
                            (double)m->young));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Describes the first fault of all materials of a body, whose constants have this prefix. */
static PetscErrorCode FindFault(PetscInt count, const SamMaterial m[], const char prefix[], char message[], size_t size)
{
  char layer[128];

  PetscFunctionBegin;
  message[0] = '\0';
  PetscCall(FindFaultOf(&m[count - 1], prefix, message, size));
  PetscCall(PetscSNPrintf(layer, sizeof(layer), "%slayer_", prefix));
  for (PetscInt n = 0; n + 1 < count && !message[0]; n++) {
    PetscCall(FindFaultOf(&m[n], layer, message, size));
    if (!message[0] && isinf(m[n].young))
      PetscCall(
        PetscSNPrintf(message, size, "%syoung inf: a layer cannot be rigid: expected a finite number > 0", layer));
    else if (!message[0] && !(m[n].thickness > 0 && isfinite(m[n].thickness)))
      PetscCall(
        PetscSNPrintf(message, size, "%sthickness %.6g: expected a finite number > 0", layer, (double)m[n].thickness));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyCreate(PetscInt count, const SamMaterial materials[], SamBody *body)
{
  char message[256];

  PetscFunctionBegin;
  SamValidPointer(materials, 2);
  SamValidPointer(body, 3);
  PetscCheck(count > 0 && count <= SAM_MATERIALS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "A body of %" PetscInt_FMT " materials: expected 1 to %d", count, SAM_MATERIALS);
  PetscCall(FindFault(count, materials, "", message, sizeof(message)));
  PetscCheck(!message[0], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s", message);
  PetscCall(PetscNew(body));
  (*body)->class_id   = SamBody_CLASSID;
  (*body)->references = 1;
  (*body)->count      = count;
  PetscCall(PetscArraycpy((*body)->material, materials, count));
  (*body)->material[count - 1].thickness = INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyReference(SamBody body)
{
  PetscFunctionBegin;
  body->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyDestroy(SamBody *body)
{
  PetscFunctionBegin;
  SamValidPointer(body, 1);
  if (!*body) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*body, SamBody, 1);
  if (--(*body)->references == 0) {
    (*body)->class_id = SAM_CLASSID_NONE;
    PetscCall(PetscFree(*body));
  }
  *body = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- at a depth ---- */

PetscInt SamBodyCount(SamBody body)
{
  return body->count;
}

PetscReal SamBodyTop(SamBody body, PetscInt n)
{
  PetscReal depth = 0;

  for (PetscInt k = 0; k < n; k++) depth += body->material[k].thickness;
  return depth;
}

PetscInt SamBodyNumberAt(SamBody body, PetscReal depth)
{
  PetscInt n = 0;

  while (n + 1 < body->count && depth > SamBodyTop(body, n + 1)) n++;
  return n;
}

const SamMaterial *SamBodyMaterialAt(SamBody body, PetscReal depth)
{
  return &body->material[SamBodyNumberAt(body, depth)];
}

const SamMaterial *SamBodySubstrate(SamBody body)
{
  return &body->material[body->count - 1];
}

SamBodyPlace SamBodyAt(SamBody body, PetscReal depth)
{
  const PetscInt           n = SamBodyNumberAt(body, depth);
  const SamMaterial *const m = &body->material[n];

  return (SamBodyPlace){.young   = m->young,
                        .poisson = m->poisson,
                        .top     = SamBodyTop(body, n),
                        .bottom  = SamBodyTop(body, n + 1),
                        .number  = n,
                        .last    = n + 1 < body->count ? PETSC_FALSE : PETSC_TRUE};
}

SamBodyPlace SamBodyBelow(SamBody body, SamBodyPlace place)
{
  return SamBodyAt(body, nextafter(place.bottom, INFINITY));
}

PetscBool SamBodyIsRigid(SamBody body)
{
  return isinf(body->material[0].young) ? PETSC_TRUE : PETSC_FALSE;
}

const char *SamBodyNamed(SamBody body)
{
  return body->named;
}

double SamBodyConstant(SamBody body, const char name[])
{
  for (PetscInt k = 0; body->own && SamMaterialConstantAt(k); k++)
    if (!strcmp(SamMaterialConstantAt(k)->name, name)) return body->own->value[k];
  return NAN;
}

SamExpansion SamBodyExpansion(SamBody body, double alpha)
{
  const SamMaterial *m = body->material;

  return (SamExpansion){(1 + (double)m->poisson) * alpha, (double)m->young * alpha, (double)m->poisson};
}

/* ---- advice ---- */

PetscErrorCode SamBodyAdvise(SamBody body, PetscInt number, PetscInt k, PetscReal cell, PetscReal width,
                             const char **option, char text[], size_t size)
{
  const SamMaterial *m = body->material, *last = SamBodySubstrate(body);
  PetscBool          other = PETSC_FALSE;
  PetscInt           same  = 0; /* layers with about the modulus at the surface */

  PetscFunctionBegin;
  text[0] = '\0';
  *option = "";
  if (body->count == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (; m < last; m++) other = other || m->young != last->young || m->poisson != last->poisson;
  m = body->material;
  while (same + 1 < body->count && PetscAbsReal(m[same].young / m->young - 1) < 0.1) same++;
  if (k && m->thickness > 100 * width)
    (void)snprintf(text, size,
                   "-body%d_layer_thickness %g is %.2g times the width of the contact: the limit is 100: check the "
                   "unit, m",
                   (int)number, (double)m->thickness, (double)(m->thickness / width));
  else if (!k && !other)
    (void)snprintf(text, size, "all layers of body %d are of the substrate's material: they have no effect",
                   (int)number);
  else if (!k && SamBodyTop(body, same) < cell) {
    *option = "grid_n";
    (void)snprintf(text, size,
                   "the layer at the surface of body %d is %.2g cells thick: pressures on that scale are not resolved",
                   (int)number, (double)(SamBodyTop(body, same) / cell));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyAdviseWorn(SamBody body, PetscInt number, PetscReal depth, char text[], size_t size)
{
  PetscFunctionBegin;
  text[0] = '\0';
  if (depth >= body->material[0].thickness)
    (void)snprintf(
      text, size,
      "the first layer of body %d, %.4g m thick, is worn through: the elasticity stays that of unworn layers",
      (int)number, (double)body->material[0].thickness);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- options and parameters ---- */

/* Lists with one number per layer */
enum { YOUNG, POISSON, THICKNESS, LISTS };
static const SamOptionRow lists[LISTS] = {
  [YOUNG]     = {"layer_young", "Young's modulus of each layer from the surface down", SAM_OPTION_REAL,
                 .range = SAM_RANGE_POSITIVE_INF, .size = LAYERS, .unit = "Pa"},
  [POISSON]   = {"layer_poisson", "Poisson's ratio of each layer, or one for all", SAM_OPTION_REAL, .size = LAYERS},
  [THICKNESS] = {"layer_thickness", "thickness of each layer", SAM_OPTION_REAL, .size = LAYERS, .unit = "m"}};
#define PROFILE "layer_file"

static PetscReal *MemberOf(SamMaterial *m, int list)
{
  return list == YOUNG ? &m->young : list == POISSON ? &m->poisson : &m->thickness;
}

static PetscErrorCode AddReals(SamParameters *p, const char prefix[], const char name[], PetscInt count,
                               const PetscReal values[])
{
  char full[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(full, sizeof(full), "%s%s", prefix, name));
  PetscCall(SamParametersAddReals(p, full, PETSC_TRUE, count, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamParameter *Find(const SamParameters *p, const char prefix[], const char name[])
{
  char full[64];

  (void)snprintf(full, sizeof(full), "%s%s", prefix, name);
  return SamParametersFind(p, full);
}

PetscErrorCode SamBodyAddParameters(SamBody body, const char prefix[], SamParameters *p)
{
  const PetscInt layers = body->count - 1;
  PetscReal      values[LAYERS];

  PetscFunctionBegin;
  PetscCall(AddReals(p, prefix, "young", 1, &SamBodySubstrate(body)->young));
  PetscCall(AddReals(p, prefix, "poisson", 1, &SamBodySubstrate(body)->poisson));
  for (int l = 0; l < LISTS && layers; l++) {
    for (PetscInt n = 0; n < layers; n++) values[n] = *MemberOf(&body->material[n], l);
    PetscCall(AddReals(p, prefix, lists[l].name, layers, values));
  }
  PetscCall(SamBodyAddInitialStress(body, prefix, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the layers of a record; `fault`: the name of a list with a differing count of numbers, NULL: none. */
static void TakeLayers(const SamParameters *p, const char prefix[], SamMaterial m[], PetscInt *layers,
                       const char **fault)
{
  const SamParameter *found[LISTS];
  PetscInt            count[LISTS];

  *fault = NULL;
  for (int l = 0; l < LISTS; l++) {
    found[l] = Find(p, prefix, lists[l].name);
    count[l] = found[l] ? found[l]->count : 0;
    /* Texts have no numbers, but exist. */
    if (found[l] && (count[l] < 1 || count[l] > LAYERS)) *fault = lists[l].name;
  }
  for (int l = 0; l < LISTS && !*fault; l++)
    if (count[l] != count[(l + 1) % LISTS] && count[l] != count[(l + 2) % LISTS]) *fault = lists[l].name;
  if (*fault) return;
  *layers = count[0];
  for (int l = 0; l < LISTS; l++)
    for (PetscInt n = 0; n < *layers; n++) *MemberOf(&m[n], l) = found[l]->value[n];
}

PetscErrorCode SamBodyCreateFromParameters(MPI_Comm comm, const SamParameters *p, const char prefix[],
                                           const char source[], SamBody *body)
{
  static const char *const own[]            = {"young", "poisson"};
  SamMaterial              m[SAM_MATERIALS] = {{0}}, last = {0};
  PetscInt                 layers;
  const char              *fault;
  char                     message[256];

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    const SamParameter *found = Find(p, prefix, own[k]);

    PetscCheck(found && found->count == 1, comm, SAM_ERR_FILE, "%s: cannot be read: it lacks the attribute %s%s",
               source, prefix, own[k]);
    *MemberOf(&last, k) = found->value[0];
  }
  TakeLayers(p, prefix, m, &layers, &fault);
  PetscCheck(!fault, comm, SAM_ERR_FILE, "%s: cannot be read: the attribute %s%s does not fit the layers", source,
             prefix, fault);
  m[layers] = last;
  PetscCall(FindFault(layers + 1, m, prefix, message, sizeof(message)));
  PetscCheck(!message[0], comm, SAM_ERR_FILE, "%s: cannot be read: %s", source, message);
  PetscCall(SamBodyCreate(layers + 1, m, body));
  PetscCall(SamBodyTakeInitialStress(comm, p, prefix, source, *body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- materials by name ---- */

/* What the options of a body name of the table of materials; NULL: not named. `elastic`: a material of two numbers */
typedef struct {
  const SamNamedMaterial *own, *layer[LAYERS];
  PetscInt                layers;
  SamNamedMaterial        elastic;
  char                    text[64];
} Names;

/* Reads the option that the prefix of the body's others begins with, as -body1 for -body1_young. */
static PetscErrorCode ReadName(const SamOptions *from, Names *names)
{
  const SamOptions all = {from->comm, NULL};
  char             option[SAM_PREFIX + 8], words[512], why[700];
  PetscBool        given;
  SamOptionRow     row = {option, "material by name (-help materials), or by E,nu: constants that are not given",
                          SAM_OPTION_STRING, .size = sizeof(names->text), .words = words};

  PetscFunctionBegin;
  names->text[0] = '\0';
  PetscCall(PetscStrncpy(option, SamOptionsPrefix(from), sizeof(option)));
  option[strlen(option) - 1] = '\0'; /* without the underscore */
  SamMaterialList(",", words, sizeof(words));
  PetscCall(SamOptionsRead(&all, NULL, 1, &row, names->text, &given));
  names->own = given ? SamMaterialFind(names->text) : NULL;
  if (given && !names->own) names->own = SamMaterialElastic(names->text, &names->elastic);
  if (!given || names->own) PetscFunctionReturn(PETSC_SUCCESS);
  SamMaterialExplain(names->text, why, sizeof(why));
  SETERRQ(from->comm, SAM_ERR_USER, "-%s %s: %s; or Young's modulus and Poisson's ratio, 210GPa,0.3", option,
          names->text, why);
}

/* Reads the names of the layers' materials. */
static PetscErrorCode ReadLayerNames(const SamOptions *from, Names *names)
{
  char         words[512], text[2048] = "", why[640], **word;
  int          count;
  SamOptionRow row = {"layers", "material of each layer by its name, from the surface down", SAM_OPTION_WORDS,
                      .size = sizeof(text), .words = words};

  PetscFunctionBegin;
  SamMaterialList(",", words, sizeof(words));
  PetscCall(SamOptionsRead(from, NULL, 1, &row, text, NULL));
  PetscCall(PetscStrToArray(text, ',', &count, &word));
  PetscCheck(count <= LAYERS, from->comm, SAM_ERR_USER, "-%s%s: expected at most %d names separated by commas",
             SamOptionsPrefix(from), row.name, LAYERS);
  names->layers = (PetscInt)count;
  for (int n = 0; n < count; n++) {
    names->layer[n] = SamMaterialFind(word[n]);
    if (!names->layer[n]) SamMaterialExplain(word[n], why, sizeof(why));
    PetscCheck(names->layer[n], from->comm, SAM_ERR_USER, "-%s%s %s: %s", SamOptionsPrefix(from), row.name, word[n],
               why);
  }
  PetscCall(PetscStrToArrayDestroy(count, word));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends the name of a material and the constants that are used; `prefix`: of the options that may give others. */
static void Describe(const SamNamedMaterial *named, const SamMaterial *m, const char prefix[], const char before[],
                     char text[], size_t size)
{
  const size_t used  = strlen(text);
  const double young = named->value[0], poisson = named->value[1];
  char         instead[2][128] = {"", ""};

  if ((double)m->young != young)
    (void)snprintf(instead[0], sizeof(instead[0]), " by -%syoung, not %.6g GPa", prefix, young / 1e9);
  if ((double)m->poisson != poisson)
    (void)snprintf(instead[1], sizeof(instead[1]), " by -%spoisson, not %.6g", prefix, poisson);
  (void)snprintf(text + used, size - used, "%s%s: E %.6g GPa%s, nu %.6g%s", before, named->name, (double)m->young / 1e9,
                 instead[0], (double)m->poisson, instead[1]);
}

static void DescribeAll(const Names *names, const char prefix[], SamBody body)
{
  const size_t size = sizeof(body->named);
  char         layer[SAM_PREFIX + 16];

  (void)snprintf(layer, sizeof(layer), "%slayer_", prefix);
  body->own = names->own == &names->elastic ? NULL : names->own;
  if (names->own) Describe(names->own, SamBodySubstrate(body), prefix, "", body->named, size);
  for (PetscInt n = 0; n < names->layers; n++)
    Describe(names->layer[n], &body->material[n], layer,
             n            ? ", "
             : names->own ? "; layers "
                          : "layers ",
             body->named, size);
}

/* Takes modulus and ratio of the named layers where there is no list of them; `most` is the count of layers. */
static PetscErrorCode TakeNames(const SamOptions *from, const Names *names, PetscReal values[LISTS][LAYERS],
                                PetscInt count[LISTS], PetscInt *most)
{
  PetscFunctionBegin;
  if (!names->layers) PetscFunctionReturn(PETSC_SUCCESS);
  *most = PetscMax(*most, names->layers);
  PetscCheck(names->layers == *most, from->comm, SAM_ERR_USER,
             "-%slayers names %" PetscInt_FMT " of %" PetscInt_FMT " layers: give a name for each",
             SamOptionsPrefix(from), names->layers, *most);
  for (int l = YOUNG; l <= POISSON; l++) {
    if (count[l]) continue;
    count[l] = names->layers;
    for (PetscInt n = 0; n < names->layers; n++) values[l][n] = (PetscReal)names->layer[n]->value[l];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the layers from a file or from lists of equal length; a single Poisson's ratio is used for all. */
static PetscErrorCode ReadLayers(const SamOptions *from, Names *names, SamMaterial m[], PetscInt *layers)
{
  const char *const prefix = SamOptionsPrefix(from);
  PetscReal         values[LISTS][LAYERS];
  PetscInt          count[LISTS], most = 0;
  PetscBool         graded;

  PetscFunctionBegin;
  PetscCall(SamBodyReadProfile(from, PROFILE, m, layers, &graded));
  PetscCall(ReadLayerNames(from, names));
  PetscCheck(!graded || !names->layers, from->comm, SAM_ERR_USER,
             "-%s" PROFILE " and -%slayers exclude each other: omit one", prefix, prefix);
  for (int l = 0; l < LISTS; l++) {
    PetscCall(SamOptionsReals(from, &lists[l], values[l], &count[l]));
    PetscCheck(!graded || !count[l], from->comm, SAM_ERR_USER, "-%s" PROFILE " and -%s%s exclude each other: omit one",
               prefix, prefix, lists[l].name);
    most = PetscMax(most, count[l]);
  }
  if (SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TakeNames(from, names, values, count, &most));
  if (!most) PetscFunctionReturn(PETSC_SUCCESS);
  for (int l = 0; l < LISTS; l++)
    PetscCall(SamOptionsRequire(from, count[l] > 0, lists[l].name, "the layers of a body need all three lists"));
  if (count[POISSON] == 1)
    for (; count[POISSON] < most; count[POISSON]++) values[POISSON][count[POISSON]] = values[POISSON][0];
  for (int l = 0; l < LISTS; l++)
    PetscCheck(count[l] == most, from->comm, SAM_ERR_USER,
               "-%s%s is given for %" PetscInt_FMT " of %" PetscInt_FMT " layers: give a number for each", prefix,
               lists[l].name, count[l], most);
  for (int l = 0; l < LISTS; l++)
    for (PetscInt n = 0; n < most; n++) *MemberOf(&m[n], l) = values[l][n];
  *layers = most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the constants of the body itself, which are the substrate's, by their options or by its name. */
static PetscErrorCode ReadOwn(const SamOptions *from, const SamNamedMaterial *named, SamMaterial *m)
{
  const char *const prefix = SamOptionsPrefix(from);
  const PetscBool   known  = named || SamPrintHelp() ? PETSC_TRUE : PETSC_FALSE;
  PetscBool         given;
  char              text[SAM_PREFIX + 128];

  PetscFunctionBegin;
  (void)snprintf(text, sizeof(text),
                 "Young's modulus, Pa (210e9 for steel), or inf: a rigid body; or name the material: -%.*s steel",
                 (int)strlen(prefix) - 1, prefix);
  PetscCall(SamOptionsReal(from, "young", "Young's modulus (), inf: rigid: required unless named", "Pa",
                           SAM_RANGE_POSITIVE_INF, &m->young, &given));
  PetscCall(SamOptionsRequire(from, given || known, "young", text));
  if (named && !given) m->young = (PetscReal)named->value[0];
  PetscCall(SamOptionsReal(from, "poisson", "Poisson's ratio: required unless rigid or named", NULL, SAM_RANGE_ANY,
                           &m->poisson, &given));
  PetscCall(SamOptionsRequire(from, given || isinf(m->young) || known, "poisson",
                              "Poisson's ratio (0.3 for steel; not needed for a rigid body)"));
  if (named && !given) m->poisson = (PetscReal)named->value[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyCreateFromOptions(const SamOptions *from, SamBody *body)
{
  SamMaterial m[SAM_MATERIALS] = {{0}}, last = {0};
  Names       names  = {.own = NULL};
  PetscInt    layers = 0;
  char        message[256], prefix[128];

  PetscFunctionBegin;
  PetscCall(ReadName(from, &names));
  PetscCall(ReadOwn(from, names.own, &last));
  PetscCall(ReadLayers(from, &names, m, &layers));
  if (SamPrintHelp()) last.young = 1;
  m[layers] = last;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "-%s", SamOptionsPrefix(from)));
  PetscCall(FindFault(layers + 1, m, prefix, message, sizeof(message)));
  PetscCheck(!message[0], from->comm, SAM_ERR_USER, "%s", message);
  PetscCall(SamBodyCreate(layers + 1, m, body));
  DescribeAll(&names, SamOptionsPrefix(from), *body);
  PetscCall(SamBodyReadInitialStress(from, *body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

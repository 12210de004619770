/* Elastic constants of a pair of bodies. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/layered.h>
#include <math.h>

/* One material: a body, or a layer of one. */
typedef struct {
  PetscReal young, poisson;
} Material;

/* The fault of a material: a message that names its constants, which begin with `name`; empty without fault. */
static PetscErrorCode FindFaultOf(Material m, const char name[], char message[], size_t size)
{
  const PetscReal inverse_shear = isinf(m.young) ? 0 : 2 * (1 + m.poisson) / m.young;

  PetscFunctionBegin;
  if (!(m.young > 0))
    PetscCall(PetscSNPrintf(message, size, "%s_young %.6g: expected a number > 0 or inf", name, (double)m.young));
  else if (!(m.poisson > -1 && m.poisson <= 0.5))
    PetscCall(PetscSNPrintf(message, size, "%s_poisson %.6g: expected a number above -1 and at most 0.5%s", name,
                            (double)m.poisson, m.poisson > 1 ? ": 0.3, not 30 percent" : ""));
  else if (!isfinite(inverse_shear) || (inverse_shear == 0 && !isinf(m.young)))
    PetscCall(PetscSNPrintf(message, size, "%s_young %.6g: its compliance is out of range in double precision", name,
                            (double)m.young));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same of a body and its layers. */
static PetscErrorCode FindFaultOfBody(Material body, const SamLayers *layers, const char name[], char message[],
                                      size_t size)
{
  char layer[128];

  PetscFunctionBegin;
  PetscCall(FindFaultOf(body, name, message, size));
  PetscCall(PetscSNPrintf(layer, sizeof(layer), "%s_layer", name));
  for (PetscInt n = 0; n < layers->count && !message[0]; n++) {
    PetscCall(FindFaultOf((Material){layers->young[n], layers->poisson[n]}, layer, message, size));
    if (!message[0] && isinf(layers->young[n]))
      PetscCall(
        PetscSNPrintf(message, size, "%s_young inf: a layer cannot be rigid: expected a finite number > 0", layer));
    else if (!message[0] && !(layers->thickness[n] > 0 && isfinite(layers->thickness[n])))
      PetscCall(PetscSNPrintf(message, size, "%s_thickness %.6g: expected a finite number > 0", layer,
                              (double)layers->thickness[n]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fault of invalid constants: a message that names the constant with a prefix; empty without fault. */
static PetscErrorCode FindFault(const PetscReal young[2], const PetscReal poisson[2], const SamLayers layers[2],
                                const char prefix[], char message[], size_t size)
{
  char name[96];

  PetscFunctionBegin;
  message[0] = '\0';
  for (int b = 0; b < 2 && !message[0]; b++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%sbody%d", prefix, b + 1));
    PetscCall(FindFaultOfBody((Material){young[b], poisson[b]}, &layers[b], name, message, size));
  }
  if (!message[0] && isinf(young[0]) && isinf(young[1]) && !layers[0].count && !layers[1].count)
    PetscCall(PetscSNPrintf(message, size,
                            "%sbody1_young and %sbody2_young: both bodies are rigid, at least one must be elastic",
                            prefix, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamLayersDepth(const SamLayers *layers, PetscInt n)
{
  PetscReal depth = 0;

  for (PetscInt k = 0; k < n; k++) depth += layers->thickness[k];
  return depth;
}

PetscInt SamLayersAt(const SamLayers *layers, PetscReal depth)
{
  PetscInt n = 0;

  while (n < layers->count && depth > SamLayersDepth(layers, n + 1)) n++;
  return n;
}

PetscErrorCode SamPairSetLayered(SamPair *pair, const PetscReal young[2], const PetscReal poisson[2],
                                 const SamLayers layers[2])
{
  PetscReal inverse_shear[2], nu[2]; /* 1/G and Poisson's ratio at the surface; 1/G is zero for a rigid body */
  char      message[256];

  PetscFunctionBegin;
  PetscCall(FindFault(young, poisson, layers, "", message, sizeof(message)));
  PetscCheck(!message[0], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s", message);
  PetscCall(PetscMemzero(pair, sizeof(*pair)));
  for (PetscInt b = 0; b < 2; b++) {
    const PetscReal E = layers[b].count ? layers[b].young[0] : young[b];

    pair->layers[b].count = layers[b].count;
    PetscCall(PetscArraycpy(pair->layers[b].young, layers[b].young, layers[b].count));
    PetscCall(PetscArraycpy(pair->layers[b].poisson, layers[b].poisson, layers[b].count));
    PetscCall(PetscArraycpy(pair->layers[b].thickness, layers[b].thickness, layers[b].count));
    PetscCall(PetscArraycpy(pair->layers[b].stress, layers[b].stress, layers[b].count));
    nu[b]            = layers[b].count ? layers[b].poisson[0] : poisson[b];
    inverse_shear[b] = isinf(E) ? 0 : 2 * (1 + nu[b]) / E;
    pair->young[b]   = young[b];
    pair->poisson[b] = poisson[b];
  }
  pair->normal   = ((1 - nu[0]) * inverse_shear[0] + (1 - nu[1]) * inverse_shear[1]) / (2 * PETSC_PI);
  pair->shear    = pair->normal;
  pair->shear_xx = (nu[0] * inverse_shear[0] + nu[1] * inverse_shear[1]) / (2 * PETSC_PI);
  pair->coupling = ((1 - 2 * nu[0]) * inverse_shear[0] - (1 - 2 * nu[1]) * inverse_shear[1]) / (4 * PETSC_PI);
  pair->modulus  = 1 / (PETSC_PI * pair->normal);
  pair->dundurs  = pair->coupling / pair->normal;
  pair->film[0] = pair->film[1] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamPairFilm(const SamPair *pair)
{
  return pair->film[0] > 0 ? pair->film[0] / pair->film[1] : 0;
}

PetscErrorCode SamPairSet(SamPair *pair, const PetscReal young[2], const PetscReal poisson[2])
{
  static const SamLayers none[2];

  return SamPairSetLayered(pair, young, poisson, none);
}

PetscBool SamPairHasLayers(const SamPair *pair)
{
  return pair->layers[0].count || pair->layers[1].count ? PETSC_TRUE : PETSC_FALSE;
}

double SamPairCoupling(const SamPair *pair, double first, double last)
{
  enum { SAMPLES = 32 };
  double most = fabs((double)pair->dundurs);

  for (int m = 0; m < SAMPLES && SamPairHasLayers(pair); m++) {
    double total[SAM_LAYERED_SYMBOLS], difference[SAM_LAYERED_SYMBOLS];

    SamLayeredSymbols(pair, 0, first * pow(last / first, (double)m / (SAMPLES - 1)), total, difference);
    most = PetscMax(most, fabs(total[SAM_LAYERED_ZR]) / total[SAM_LAYERED_ZZ]);
  }
  return most;
}

/* Options and parameters: of both bodies Young's moduli, then Poisson's ratios; of the layers; of the film. */
static const char *const names[] = {"body1_young", "body2_young", "body1_poisson", "body2_poisson"};
static const char *const films[] = {"film_thickness", "film_shear"};
enum { YOUNG, POISSON, THICKNESS, LISTS };
static const char *const lists[2][LISTS] = {{"body1_layer_young", "body1_layer_poisson", "body1_layer_thickness"},
                                            {"body2_layer_young", "body2_layer_poisson", "body2_layer_thickness"}};
static const char *const residual[2]     = {"body1_layer_stress", "body2_layer_stress"};
static const char *const profiles[2]     = {"body1_layer_file", "body2_layer_file"};

static PetscReal *ListOf(SamLayers *layers, int list)
{
  return list == YOUNG ? layers->young : list == POISSON ? layers->poisson : layers->thickness;
}

static PetscBool HasResidualStress(const SamLayers *layers)
{
  for (PetscInt n = 0; n < layers->count; n++)
    if (layers->stress[n][0] != 0 || layers->stress[n][1] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SamPairAddParameters(const SamPair *pair, SamParameters *p)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    SamLayers layers = pair->layers[b];

    PetscCall(SamParametersAddReals(p, names[b], PETSC_TRUE, 1, &pair->young[b]));
    PetscCall(SamParametersAddReals(p, names[2 + b], PETSC_TRUE, 1, &pair->poisson[b]));
    for (int l = 0; l < LISTS && layers.count; l++)
      PetscCall(SamParametersAddReals(p, lists[b][l], PETSC_TRUE, layers.count, ListOf(&layers, l)));
    if (HasResidualStress(&layers))
      PetscCall(SamParametersAddReals(p, residual[b], PETSC_TRUE, 2 * layers.count, layers.stress[0]));
  }
  for (PetscInt k = 0; k < 2 && pair->film[0] > 0; k++)
    PetscCall(SamParametersAddReals(p, films[k], PETSC_TRUE, 1, &pair->film[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The layers of body b; `fault`: the name of a list that has not as many numbers as the others, NULL: none. */
static void TakeLayers(const SamParameters *p, PetscInt b, SamLayers *layers, const char **fault)
{
  const SamParameter *found[LISTS], *stress = SamParametersFind(p, residual[b]);
  PetscInt            counts[LISTS];

  *fault = NULL;
  for (int l = 0; l < LISTS; l++) {
    found[l]  = SamParametersFind(p, lists[b][l]);
    counts[l] = found[l] ? found[l]->count : 0;
    /* texts have none, but are there */
    if (found[l] && (counts[l] < 1 || counts[l] > SAM_LAYERS)) *fault = lists[b][l];
  }
  for (int l = 0; l < LISTS && !*fault; l++)
    if (counts[l] != counts[(l + 1) % LISTS] && counts[l] != counts[(l + 2) % LISTS]) *fault = lists[b][l];
  if (*fault) return;
  layers->count = counts[0];
  for (int l = 0; l < LISTS; l++)
    for (PetscInt n = 0; n < layers->count; n++) ListOf(layers, l)[n] = found[l]->value[n];
  if (stress && stress->count != 2 * layers->count) *fault = residual[b];
  for (PetscInt n = 0; stress && !*fault && n < stress->count; n++) {
    layers->stress[n / 2][n % 2] = stress->value[n];
    if (!isfinite(stress->value[n])) *fault = residual[b];
  }
}

PetscErrorCode SamPairSetFromParameters(SamPair *pair, MPI_Comm comm, const SamParameters *p, const char source[])
{
  SamLayers layers[2] = {{.count = 0}, {.count = 0}};
  PetscReal value[4];
  char      message[256];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 4; k++) {
    const SamParameter *found = SamParametersFind(p, names[k]);

    PetscCheck(found && found->count == 1, comm, SAM_ERR_FILE, "%s: cannot be read: it lacks the attribute %s", source,
               names[k]);
    value[k] = found->value[0];
  }
  for (PetscInt b = 0; b < 2; b++) {
    const char *fault;

    TakeLayers(p, b, &layers[b], &fault);
    PetscCheck(!fault, comm, SAM_ERR_FILE, "%s: cannot be read: the attribute %s does not fit the layers", source,
               fault);
  }
  PetscCall(FindFault(value, value + 2, layers, "", message, sizeof(message)));
  PetscCheck(!message[0], comm, SAM_ERR_FILE, "%s: cannot be read: %s", source, message);
  PetscCall(SamPairSetLayered(pair, value, value + 2, layers));
  for (PetscInt k = 0; k < 2; k++) {
    const SamParameter *found = SamParametersFind(p, films[k]);

    if (found && found->count == 1) pair->film[k] = found->value[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two numbers for each layer. */
static PetscErrorCode ReadResidualStress(const SamOptions *from, PetscInt b, SamLayers *layers)
{
  PetscInt count;

  PetscFunctionBegin;
  PetscCall(SamOptionsReals(from, residual[b],
                            "residual stress xx and yy of each layer (Pa), which only petsam-stress adds",
                            SAM_RANGE_ANY, 2 * SAM_LAYERS, layers->stress[0], &count));
  PetscCheck(!count || count == 2 * layers->count, from->comm, SAM_ERR_USER,
             "-%s%s: %" PetscInt_FMT " of %" PetscInt_FMT " numbers are given: give xx and yy of each layer",
             SamOptionsPrefix(from), residual[b], count, 2 * layers->count);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The layers of body b, whose lists must have one length; one Poisson's ratio is for all. */
static PetscErrorCode ReadLayers(const SamOptions *from, PetscInt b, SamLayers *layers)
{
  static const char *const help[]  = {"Young's modulus of each layer from the surface down (Pa)",
                                      "Poisson's ratio of each layer, or one for all", "thickness of each layer (m)"};
  static const SamRange    range[] = {SAM_RANGE_POSITIVE_INF, SAM_RANGE_ANY, SAM_RANGE_ANY};
  PetscInt                 count[LISTS], most = 0;
  PetscBool                print, graded;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&print));
  PetscCall(SamLayersReadFile(from, profiles[b], layers, &graded));
  for (int l = 0; l < LISTS; l++) {
    PetscCall(SamOptionsReals(from, lists[b][l], help[l], range[l], SAM_LAYERS, ListOf(layers, l), &count[l]));
    most = PetscMax(most, count[l]);
  }
  PetscCheck(!graded || !most, from->comm, SAM_ERR_USER, "-%s%s and -%s%s exclude each other: omit one",
             SamOptionsPrefix(from), profiles[b], SamOptionsPrefix(from),
             lists[b][count[YOUNG]     ? YOUNG
                      : count[POISSON] ? POISSON
                                       : THICKNESS]);
  if (!most || print) PetscFunctionReturn(ReadResidualStress(from, b, layers));
  for (int l = 0; l < LISTS; l++)
    PetscCall(SamOptionsRequire(from, count[l] > 0, lists[b][l], "the layers of a body need all three lists"));
  for (; count[POISSON] == 1 && layers->count < most; layers->count++)
    layers->poisson[layers->count] = layers->poisson[0];
  if (count[POISSON] == 1) count[POISSON] = most;
  layers->count = most;
  for (int l = 0; l < LISTS; l++)
    PetscCheck(count[l] == most, from->comm, SAM_ERR_USER,
               "-%s%s is given for %" PetscInt_FMT " of %" PetscInt_FMT " layers: give a number for each",
               SamOptionsPrefix(from), lists[b][l], count[l], most);
  PetscCall(ReadResidualStress(from, b, layers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairSetFromOptions(SamPair *pair, const SamOptions *from)
{
  SamLayers layers[2] = {{.count = 0}, {.count = 0}};
  PetscReal young[2] = {0, 0}, poisson[2] = {0, 0};
  PetscBool has_young, has_poisson, help;
  char      message[256], prefix[80];

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamOptionsHeading(from, "Bodies"));
  for (PetscInt k = 0; k < 4; k++)
    SamOptionsKnow(from, names[k], NULL); /* one body's are no misspelling of the other's */
  for (PetscInt b = 0; b < 2; b++) {
    const char *name = names[b];

    PetscCall(SamOptionsReal(from, name, "Young's modulus (Pa), inf: rigid: required", SAM_RANGE_POSITIVE_INF,
                             &young[b], &has_young));
    PetscCall(
      SamOptionsRequire(from, has_young || help, name, "Young's modulus, Pa (210e9 for steel), or inf: a rigid body"));
    name = names[2 + b];
    PetscCall(
      SamOptionsReal(from, name, "Poisson's ratio: required unless rigid", SAM_RANGE_ANY, &poisson[b], &has_poisson));
    PetscCall(SamOptionsRequire(from, has_poisson || isinf(young[b]) || help, name,
                                "Poisson's ratio (0.3 for steel; not needed for a rigid body)"));
    PetscCall(ReadLayers(from, b, &layers[b]));
  }
  if (help) young[0] = young[1] = 1;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "-%s", SamOptionsPrefix(from)));
  PetscCall(FindFault(young, poisson, layers, prefix, message, sizeof(message)));
  PetscCheck(!message[0], from->comm, SAM_ERR_USER, "%s", message);
  PetscCall(SamPairSetLayered(pair, young, poisson, layers));
  PetscCall(SamOptionsReal(from, films[0], "thickness (m) of a film between the surfaces, which shear displaces",
                           SAM_RANGE_POSITIVE, &pair->film[0], &has_young));
  PetscCall(SamOptionsReal(from, films[1], "its shear modulus (Pa)", SAM_RANGE_POSITIVE, &pair->film[1], &has_poisson));
  PetscCheck(has_young == has_poisson, from->comm, SAM_ERR_USER,
             "%s%s is given without %s%s: a film has both: give both", prefix, films[has_young ? 0 : 1], prefix,
             films[has_young ? 1 : 0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

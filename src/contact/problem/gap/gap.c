/* The class SamGap: types, their parameters, roughness. Each shape is in a file of its own. */
#include <petsam/private/elasticity.h>
#include <petsam/private/gapimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/gap.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static PetscFunctionList SamGapList = NULL;
static PetscBool         registered = PETSC_FALSE;

static PetscErrorCode FreeList(void)
{
  PetscFunctionBegin;
  registered = PETSC_FALSE;
  PetscCall(PetscFunctionListDestroy(&SamGapList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RegisterAll(void)
{
  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(SamGapRegister(SAM_GAP_SPHERE, SamGapCreate_Sphere));
  PetscCall(SamGapRegister(SAM_GAP_ELLIPSOID, SamGapCreate_Ellipsoid));
  PetscCall(SamGapRegister(SAM_GAP_CURVED, SamGapCreate_Curved));
  PetscCall(SamGapRegister(SAM_GAP_PAD, SamGapCreate_Pad));
  PetscCall(SamGapRegister(SAM_GAP_ROLLER, SamGapCreate_Roller));
  PetscCall(SamGapRegister(SAM_GAP_PUNCH, SamGapCreate_Punch));
  PetscCall(SamGapRegister(SAM_GAP_FLAT, SamGapCreate_Flat));
  PetscCall(SamGapRegister(SAM_GAP_FILE, SamGapCreate_File));
  PetscCall(PetscRegisterFinalize(FreeList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapRegister(const char name[], PetscErrorCode (*create)(SamGap))
{
  PetscFunctionBegin;
  SamValidPointer(name, 1);
  SamValidPointer(create, 2);
  PetscCall(RegisterAll()); /* first, so that a user's type replaces a built-in one of the same name */
  PetscCall(PetscFunctionListAdd(&SamGapList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapCreate(MPI_Comm comm, SamGap *gap)
{
  const SamFieldFile source = {.file_option = "gap_file", .dataset_option = "gap_dataset", SAM_FIELD_FILE_OF_LENGTHS};
  SamGap             g;

  PetscFunctionBegin;
  SamValidPointer(gap, 2);
  PetscCall(SamBaseInitialize());
  PetscCall(RegisterAll());
  PetscCall(PetscNew(&g));
  g->class_id = SamGap_CLASSID;
  g->comm     = comm;
  g->source = g->rough    = source;
  g->rough.file_option    = "gap_rough_file";
  g->rough.dataset_option = "gap_rough_dataset";
  *gap                    = g;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapSetOptionsPrefix(SamGap gap, const char prefix[])
{
  PetscFunctionBegin;
  SamValidHandle(gap, SamGap, 1);
  PetscCall(SamSetPrefix(gap->prefix, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapDestroy(SamGap *gap)
{
  PetscFunctionBegin;
  SamValidPointer(gap, 1);
  if (!*gap) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*gap, SamGap, 1);
  (*gap)->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(*gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapSetType(SamGap gap, SamGapType type)
{
  PetscErrorCode (*create)(SamGap);
  char list[512];

  PetscFunctionBegin;
  SamValidHandle(gap, SamGap, 1);
  SamValidPointer(type, 2);
  PetscCall(PetscFunctionListFind(SamGapList, type, &create));
  if (!create) {
    PetscCall(SamTypesList(SamGapList, list, sizeof(list)));
    SETERRQ(gap->comm, SAM_ERR_USER, "%s is no type of gap: expected %s", type, list);
  }
  PetscCall(PetscMemzero(&gap->ops, sizeof(gap->ops)));
  for (PetscInt k = 0; k < SAM_GAP_PARAMETERS; k++) gap->values[k] = NAN;
  PetscCall(create(gap));
  PetscCheck(gap->ops.count <= SAM_GAP_PARAMETERS, gap->comm, PETSC_ERR_PLIB, "Gap type %s has more than %d parameters",
             type, SAM_GAP_PARAMETERS);
  PetscCheck(gap->ops.height || gap->ops.fill, gap->comm, PETSC_ERR_PLIB, "Gap type %s sets neither height nor fill",
             type);
  for (PetscInt k = 0; k < gap->ops.count; k++) {
    gap->names[k] = gap->ops.parameters[k].name;
    if (gap->ops.defaults) gap->values[k] = gap->ops.defaults[k];
  }
  PetscCall(PetscStrncpy(gap->type, type, sizeof(gap->type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapSetParameter(SamGap gap, const char name[], PetscReal value)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  SamValidHandle(gap, SamGap, 1);
  SamValidPointer(name, 2);
  while (k < gap->ops.count && strcmp(gap->names[k], name) &&
         (strncmp(gap->names[k], "gap_", 4) || strcmp(gap->names[k] + 4, name)))
    k++;
  PetscCheck(k < gap->ops.count, gap->comm, PETSC_ERR_ARG_OUTOFRANGE, "Gap type %s has no parameter %s",
             gap->type[0] ? gap->type : "none", name);
  PetscCheck(SamRangeHas(gap->ops.parameters[k].range, value), gap->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Gap parameter %s is %.6g: expected %s", name, (double)value,
             SamRangeDescribe(gap->ops.parameters[k].range));
  gap->values[k] = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapSetFile(SamGap gap, PetscBool rough, const char file[], const char dataset[])
{
  SamFieldFile *source;

  PetscFunctionBegin;
  SamValidHandle(gap, SamGap, 1);
  source = rough ? &gap->rough : &gap->source;
  PetscCall(PetscStrncpy(source->file, file ? file : "", sizeof(source->file)));
  PetscCall(PetscStrncpy(source->dataset, dataset ? dataset : source->default_dataset, sizeof(source->dataset)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects a file for a type that reads none, since its surface would be ignored. */
static PetscErrorCode RefuseFile(SamGap gap)
{
  const SamOptions from = {gap->comm, gap->prefix};
  PetscBool        set;

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(&from, gap->source.file_option, &set));
  PetscCheck(!set, gap->comm, SAM_ERR_USER,
             "-%s%s: has no effect with -%sgap_type %s: expected -%sgap_type file, or -%s%s for a roughness on it",
             gap->prefix, gap->source.file_option, gap->prefix, gap->type, gap->prefix, gap->prefix,
             gap->rough.file_option);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the options of the type; those without a default are required, except while the help is printed. */
static PetscErrorCode SetTypeFromOptions(SamGap gap, PetscBool help)
{
  const SamOptions from = {gap->comm, gap->prefix};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < gap->ops.count; k++) {
    const SamGapParameter *parameter = &gap->ops.parameters[k];
    char                   text[256], missing[256], meaning[160];
    const SamOptionRow     row = {.name    = parameter->name,
                                  .text    = text,
                                  .kind    = SAM_OPTION_REAL,
                                  .range   = parameter->range,
                                  .words   = gap->ops.beyond,
                                  .unit    = parameter->unit,
                                  .missing = missing};

    PetscCall(PetscSNPrintf(text, sizeof(text), isnan(gap->values[k]) ? "%s: required by %s" : "%s, of %s",
                            parameter->help, gap->type));
    SamAddUnit(parameter->help, parameter->unit, meaning, sizeof(meaning));
    PetscCall(
      PetscSNPrintf(missing, sizeof(missing), "%s, required by -%sgap_type %s", meaning, gap->prefix, gap->type));
    PetscCall(SamOptionsRead(&from, NULL, 1, &row, &gap->values[k], NULL));
  }
  if (gap->ops.setfromoptions) PetscCall(gap->ops.setfromoptions(gap));
  if (!gap->ops.setfromoptions && !help) PetscCall(RefuseFile(gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the options of all types in the help. The gap is flat afterwards, a type without options. */
static PetscErrorCode PrintTypes(SamGap gap)
{
  const char **types;
  int          count;

  PetscFunctionBegin;
  PetscCall(SamTypesGet(SamGapList, &types, &count));
  for (int t = 0; t < count; t++) {
    PetscCall(SamGapSetType(gap, types[t]));
    PetscCall(SetTypeFromOptions(gap, PETSC_TRUE));
  }
  PetscCall(PetscFree(types));
  PetscCall(SamGapSetType(gap, SAM_GAP_FLAT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Registers the options of all types: an option that belongs to another type is not reported as misspelled. */
static PetscErrorCode KnowTypes(MPI_Comm comm, const SamOptions *from)
{
  const char **types;
  int          count;
  SamGap       gap;

  PetscFunctionBegin;
  PetscCall(SamGapCreate(comm, &gap));
  PetscCall(SamTypesGet(SamGapList, &types, &count));
  for (int t = 0; t < count; t++) {
    char with[96];

    (void)snprintf(with, sizeof(with), "-%sgap_type %s", SamOptionsPrefix(from), types[t]);
    PetscCall(SamGapSetType(gap, types[t]));
    for (PetscInt k = 0; k < gap->ops.count; k++) SamOptionsKnow(from, gap->names[k], with);
    if (gap->ops.setfromoptions) SamOptionsKnow(from, gap->source.file_option, with);
    if (gap->ops.setfromoptions) SamOptionsKnow(from, gap->source.dataset_option, with);
  }
  PetscCall(PetscFree(types));
  PetscCall(SamGapDestroy(&gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapSetFromOptions(SamGap gap)
{
  SamOptions      from;
  char            type[64], list[512], text[600];
  PetscBool       set, file;
  const PetscBool help = SamPrintHelp();

  PetscFunctionBegin;
  SamValidHandle(gap, SamGap, 1);
  from = (SamOptions){gap->comm, gap->prefix};
  PetscCall(SamOptionsHeading(&from, "Gap"));
  PetscCall(SamTypesList(SamGapList, list, sizeof(list)));
  PetscCall(PetscSNPrintf(text, sizeof(text), "%s: required", list));
  PetscCall(SamOptionsHas(&from, "gap_file", &file));
  PetscCall(PetscStrncpy(type, file && !gap->type[0] ? SAM_GAP_FILE : gap->type, sizeof(type)));
  PetscCall(SamTypesOption(SamGapList, &from, "gap_type", text, type, sizeof(type), &set));
  if (help) {
    PetscCall(PrintTypes(gap));
  } else {
    PetscCall(SamOptionsRequire(&from, set || type[0], "gap_type", list));
    PetscCall(KnowTypes(gap->comm, &from));
    if (strcmp(type, gap->type)) PetscCall(SamGapSetType(gap, type));
    PetscCall(SetTypeFromOptions(gap, PETSC_FALSE));
  }
  PetscCall(SamFieldFileSetFromOptions(&gap->rough, &from, "HDF5 file with a roughness, added to the gap of any type"));
  if (help) gap->rough.file[0] = '\0';
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapGetFileGrid(SamGap gap, PetscInt n[2], PetscReal width[2], PetscReal center[2])
{
  const SamOptions from = {gap->comm, gap->prefix};
  SamFieldFile     sources[2];
  char             type[64];
  PetscBool        has_n, has_size;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; d++) n[d] = 0, width[d] = center[d] = 0;
  PetscCall(SamOptionsHas(&from, "grid_n", &has_n));
  PetscCall(SamOptionsHas(&from, "grid_size", &has_size));
  if (SamPrintHelp() || (has_n && has_size)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(type, gap->type[0] ? gap->type : SAM_GAP_FILE, sizeof(type)));
  PetscCall(PetscOptionsGetString(NULL, gap->prefix, "-gap_type", type, sizeof(type), NULL));
  sources[0] = gap->source;
  sources[1] = gap->rough;
  for (PetscInt s = strcmp(type, SAM_GAP_FILE) ? 1 : 0; s < 2 && !n[0]; s++) {
    SamFieldFile *source = &sources[s];

    PetscCall(SamFieldFileSetFromOptions(source, &from, ""));
    if (!source->file[0]) continue;
    PetscCall(SamElasticityPlaneFromOptions(&from, &source->row));
    PetscCall(SamFieldFileGetGrid(source, gap->comm, n, width, center));
    PetscCheck(
      has_size || (width[0] > 0 && (width[1] > 0 || source->row)), gap->comm, SAM_ERR_USER,
      "-%sgrid_size is missing: -%s%s %s records no size of %s, neither as its attribute size nor by x and y with "
      "units beside it",
      gap->prefix, gap->prefix, source->file_option, source->file, source->dataset);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillHeight(SamGap gap, SamGrid grid, Vec h)
{
  PetscScalar *array;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(h, &array));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscReal y = SamGridY(grid, grid->row_start + j);

    for (PetscInt i = 0; i < grid->nx; i++)
      array[j * grid->nx + i] = gap->ops.height(gap->values, SamGridX(grid, i), y);
  }
  PetscCall(VecRestoreArrayWrite(h, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddRoughness(SamGap gap, SamGrid grid, Vec h)
{
  PetscErrorCode ierr;
  Vec            rough;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(h, &rough));
  ierr = SamFieldFileRead(&gap->rough, grid, rough);
  if (!ierr) PetscCall(VecAXPY(h, 1, rough));
  PetscCall(VecDestroy(&rough));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapFill(SamGap gap, SamGrid grid, Vec h)
{
  PetscBool finite = PETSC_FALSE;

  PetscFunctionBegin;
  SamValidHandle(gap, SamGap, 1);
  SamValidHandle(grid, SamGrid, 2);
  SamValidVec(h, 3);
  SamValidSameComm(gap->comm, 1, grid->comm, 2);
  SamValidVecOn(gap->comm, 1, h, 3);
  PetscCheck(gap->type[0], gap->comm, PETSC_ERR_ORDER, "Call SamGapSetType() or SamGapSetFromOptions() first");
  for (PetscInt k = 0; k < gap->ops.count; k++)
    PetscCheck(!isnan(gap->values[k]), gap->comm, PETSC_ERR_ORDER, "Call SamGapSetParameter() for %s first",
               gap->names[k]);
  if (gap->ops.check) PetscCall(gap->ops.check(gap));
  if (gap->ops.fill)
    PetscCall(gap->ops.fill(gap, grid, h));
  else
    PetscCall(FillHeight(gap, grid, h));
  if (gap->rough.file[0]) PetscCall(AddRoughness(gap, grid, h));
  PetscCall(SamGridIsFinite(grid, h, &finite)); /* it may overflow when a radius or the roughness is extreme */
  PetscCheck(finite, gap->comm, SAM_ERR_USER,
             "-%sgap_type %s: the separation is not finite everywhere on the grid: check the values of its options",
             gap->prefix, gap->type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamGapGetHeight(SamGap gap, PetscReal x, PetscReal y)
{
  return gap->ops.height ? gap->ops.height(gap->values, x, y) : 0;
}

/* Relative change of a parameter: differences of fourth order have about its fourth power as error. */
#define SLOPE_STEP 1e-4

PetscReal SamGapGetSlope(SamGap gap, PetscInt k, PetscReal x, PetscReal y)
{
  static const PetscReal weight[] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  const PetscReal        value = gap->values[k], zero = gap->ops.parameters[k].unit ? hypot(x, y) : 1;
  const PetscReal        step = SLOPE_STEP * (value != 0 ? fabs(value) : zero);
  PetscReal              values[SAM_GAP_PARAMETERS], sum = 0;

  if (!gap->ops.height || !isfinite(value) || step == 0) return 0;
  (void)PetscArraycpy(values, gap->values, SAM_GAP_PARAMETERS);
  for (PetscInt n = 0; n < 4; n++) {
    values[k] = value + (PetscReal)(n < 2 ? n - 2 : n - 1) * step;
    sum += weight[n] * gap->ops.height(values, x, y);
  }
  return sum / step;
}

PetscErrorCode SamGapGetParameters(SamGap gap, SamGapType *type, PetscInt *count, const char *const **names,
                                   const PetscReal **values)
{
  PetscFunctionBegin;
  if (type) *type = gap->type;
  if (count) *count = gap->ops.count;
  if (names) *names = gap->names;
  if (values) *values = gap->values;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the contact by a closed-form solution ---- */

#define HALVINGS 200 /* bisections of an interval of half widths; enough for all digits and exponents of a double */

/* Returns the number of a contact (load, half width, ...) that is compared with the prescribed value. */
static PetscReal ValueOf(const SamGapContact *contact, PetscBool force)
{
  return force ? contact->force : contact->approach;
}

PetscErrorCode SamGapEstimateContact(SamGap gap, PetscBool force, PetscReal value, PetscReal half[2], PetscBool *known)
{
  PetscReal     low = 0, high = 1;
  SamGapContact contact;

  PetscFunctionBegin;
  half[0] = half[1] = 0;
  *known            = gap->ops.contact && !gap->rough.file[0];
  if (!*known || !(value > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  contact = gap->ops.contact(gap->values, high);
  for (PetscInt k = 0; k < HALVINGS && ValueOf(&contact, force) < value; k++) {
    low     = high;
    contact = gap->ops.contact(gap->values, high *= 2);
  }
  for (PetscInt k = 0; k < HALVINGS && high - low > 1e-9 * high; k++) {
    const PetscReal middle = 0.5 * (low + high);

    contact = gap->ops.contact(gap->values, middle);
    if (ValueOf(&contact, force) < value)
      low = middle;
    else
      high = middle;
  }
  contact = gap->ops.contact(gap->values, high);
  for (PetscInt k = 0; k < 2; k++) half[k] = contact.half[k];
  if (isnan(half[0]) || isnan(half[1])) *known = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define POINTS 100 /* of the quadrature rule */

/* Returns N/E* of a line contact of half width a: a times the integral of sin t h'(a sin t), t from 0 to pi/2. */
static double LineForce(SamGap gap, double a)
{
  double sum = 0;

  for (int k = 0; k < POINTS; k++) {
    const double sine = sin((k + 0.5) * PETSC_PI / (2 * POINTS)), x = a * sine, by = 1e-4 * x;

    sum += sine * (gap->ops.height(gap->values, x + by, 0) - gap->ops.height(gap->values, x - by, 0)) / (2 * by);
  }
  return a * sum * PETSC_PI / (2 * POINTS);
}

PetscErrorCode SamGapEstimateLine(SamGap gap, PetscReal value, PetscReal *half, PetscBool *known)
{
  double low = 1e-12, high = 1e6;

  PetscFunctionBegin;
  *half  = 0;
  *known = !gap->rough.file[0] && gap->ops.contact;
  if (*known && LineForce(gap, high) <= PetscMax(value, 0)) *half = INFINITY;
  *known = *known && value > 0;
  if (!*known || isinf(*half)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < HALVINGS && high > (1 + 1e-9) * low; k++) {
    const double middle = sqrt(low * high);

    if (LineForce(gap, middle) < value)
      low = middle;
    else
      high = middle;
  }
  *half = high;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapGetSteepness(SamGap gap, const PetscReal half[2], SamGapSteepness *steepness)
{
  PetscInt parameter = 0;

  PetscFunctionBegin;
  *steepness = (SamGapSteepness){.option = NULL};
  if (!gap->ops.steepness) PetscFunctionReturn(PETSC_SUCCESS);
  steepness->ratio   = gap->ops.steepness(gap->values, half, &parameter);
  steepness->radius  = gap->values[parameter];
  steepness->option  = gap->names[parameter];
  steepness->concave = gap->ops.concave ? gap->ops.concave(gap->values) : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapCheckPlane(SamGap gap)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < gap->ops.count && gap->ops.cylinder; k++)
    PetscCheck(isnan(gap->ops.cylinder[k]) || fabs(gap->values[k]) == gap->ops.cylinder[k], gap->comm, SAM_ERR_USER,
               "-%s%s %.6g: has no meaning with -%selasticity plane, whose bodies are cylinders along y: give %.6g",
               gap->prefix, gap->names[k], (double)gap->values[k], gap->prefix, (double)gap->ops.cylinder[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamGapIsFromFile(SamGap gap, PetscBool rough)
{
  const SamFieldFile *source = rough ? &gap->rough : &gap->source;

  return source->file[0] && (rough || gap->ops.setfromoptions) ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool SamGapHasFile(SamGap gap)
{
  return SamGapIsFromFile(gap, PETSC_FALSE) || SamGapIsFromFile(gap, PETSC_TRUE) ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool SamGapIsQuadratic(SamGap gap)
{
  static const char *const names[] = {SAM_GAP_SPHERE, SAM_GAP_ELLIPSOID, SAM_GAP_CURVED};
  SamGapType               type;
  PetscBool                is = PETSC_FALSE;

  (void)SamGapGetParameters(gap, &type, NULL, NULL, NULL);
  for (size_t k = 0; k < sizeof(names) / sizeof(names[0]) && type; k++) is = is || !strcmp(type, names[k]);
  return is && !SamGapHasFile(gap) ? PETSC_TRUE : PETSC_FALSE;
}

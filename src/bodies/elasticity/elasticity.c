/* Influence operators: types, options, and the operators on coarser grids. */
#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/fourier.h>
#include <petsam/private/body.h>
#include <math.h>
#include <string.h>

#define THINNEST 1e-12 /* thinnest layer, in cells */

#define HALVED 8 /* fewest cells in a direction of a grid that is halved */

static PetscFunctionList SamElasticityList = NULL;

#define ADDITIONS 8 /* most of them */

static const SamElasticityAddition *additions[ADDITIONS];
static PetscInt                     added = 0;

/* Empties both lists. */
static PetscErrorCode FreeLists(void)
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListDestroy(&SamElasticityList));
  added = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityRegister(const char name[], PetscErrorCode (*create)(SamElasticity))
{
  PetscFunctionBegin;
  SamValidPointer(name, 1);
  SamValidPointer(create, 2);
  if (!SamElasticityList) PetscCall(PetscRegisterFinalize(FreeLists));
  PetscCall(PetscFunctionListAdd(&SamElasticityList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamElasticityIsRegistered(const char name[])
{
  SamElasticityCreateFunction create = NULL;

  return !PetscFunctionListFind(SamElasticityList, name, &create) && create ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamElasticityRegisterAddition(const SamElasticityAddition *addition)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < added; k++)
    if (additions[k] == addition) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(added < ADDITIONS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "More than %d additions to bodies",
             ADDITIONS);
  additions[added++] = addition;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityAddFromOptions(SamElasticity *elasticity, const SamOptions *from)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < added; k++) PetscCall((*additions[k]->fromoptions)(elasticity, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetTypes(char types[], size_t size)
{
  PetscFunctionBegin;
  PetscCall(SamTypesList(SamElasticityList, types, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate(SamGrid grid, SamPair pair, SamElasticity *elasticity)
{
  SamElasticity e;

  PetscFunctionBegin;
  SamValidHandle(grid, SamGrid, 1);
  SamValidHandle(pair, SamPair, 2);
  SamValidPointer(elasticity, 3);
  PetscCall(SamBaseInitialize());
  PetscCall(PetscNew(&e));
  e->class_id   = SamElasticity_CLASSID;
  e->references = 1;
  PetscCall(SamPairReference(pair));
  e->pair = pair;
  e->film = SamPairFilm(pair);
  for (PetscInt k = 0; k < 2; k++) e->factor[k] = 1;
  PetscCall(SamGridReference(grid));
  e->grid = grid;
  PetscCall(SamElasticitySetType(e, SamGridIsRow(grid) ? SAM_ELASTICITY_PLANE : SAM_ELASTICITY_HALFSPACE));
  *elasticity = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityPlaneFromOptions(const SamOptions *from, PetscBool *plane)
{
  char type[64] = "";

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, from->prefix, "-elasticity", type, sizeof(type), NULL));
  *plane = !strcmp(type, SAM_ELASTICITY_PLANE) || !strcmp(type, SAM_ELASTICITY_PLANE_PERIODIC);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Destroys all data of the type and all derived from it. */
static PetscErrorCode Reset(SamElasticity e)
{
  PetscFunctionBegin;
  if (e->ops.destroy) PetscCall((*e->ops.destroy)(e));
  PetscCall(PetscFree(e->data));
  PetscCall(SamFourierDestroy(&e->fourier));
  PetscCall(SamTransferDestroy(&e->transfer));
  PetscCall(SamElasticityDestroy(&e->coarse));
  PetscCall(SamElasticityDestroy(&e->symmetric));
  PetscCall(SamElasticityDestroyParts(e));
  PetscCall(SamElasticityDestroy(&e->inner));
  PetscCall(PetscMemzero(&e->ops, sizeof(e->ops)));
  e->is_set_up = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamElasticity e, SamElasticityType type, SamElasticityCreateFunction create)
{
  PetscFunctionBegin;
  PetscCall(Reset(e));
  e->create = create;
  PetscCall(create(e));
  PetscCall(PetscStrncpy(e->type, type, sizeof(e->type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetType(SamElasticity e, SamElasticityType type)
{
  SamElasticityCreateFunction create;
  char                        types[256];

  PetscFunctionBegin;
  SamValidHandle(e, SamElasticity, 1);
  SamValidPointer(type, 2);
  PetscCall(PetscFunctionListFind(SamElasticityList, type, &create));
  PetscCall(SamElasticityGetTypes(types, sizeof(types)));
  PetscCheck(create, e->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Elasticity of type %s is not registered: %s%s", type,
             types[0] ? "use " : "call SamInitialize() first", types);
  PetscCheck(e->references == 1, e->grid->comm, PETSC_ERR_ORDER,
             "The type of an elasticity must be set before a problem or a solver refers to it");
  PetscCall(Create(e, type, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamElasticityType SamElasticityKeyword(SamElasticity e)
{
  while (e->wraps) e = e->inner;
  return e->type;
}

SamElasticityType SamElasticityGetType(SamElasticity e)
{
  return e->type;
}

PetscErrorCode SamElasticitySetOptionsPrefix(SamElasticity e, const char prefix[])
{
  PetscFunctionBegin;
  SamValidHandle(e, SamElasticity, 1);
  PetscCall(SamSetPrefix(e->prefix, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the options of the other types for the help, which lists these, too. */
static PetscErrorCode DescribeOthers(SamElasticity e, const SamOptions *from)
{
  const char  **types;
  int           count;
  SamElasticity other;

  PetscFunctionBegin;
  PetscCall(SamTypesGet(SamElasticityList, &types, &count));
  for (int k = 0; k < count; k++) {
    if (!strcmp(types[k], e->type)) continue;
    PetscCall(SamElasticityCreate(e->grid, e->pair, &other));
    PetscCall(SamElasticitySetType(other, types[k]));
    if (other->ops.setfromoptions) PetscCall((*other->ops.setfromoptions)(other, from));
    PetscCall(SamElasticityDestroy(&other));
  }
  PetscCall(PetscFree(types));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the transforms of layered bodies resolve the thicknesses on this grid. */
static PetscErrorCode CheckThicknesses(SamElasticity e, const SamOptions *from)
{
  const PetscReal least = THINNEST * e->grid->side[0], most = 2 * e->grid->length / THINNEST;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++)
    for (PetscInt n = 0; n + 1 < e->pair->body[b]->count; n++) {
      const PetscReal h = e->pair->body[b]->material[n].thickness;

      PetscCheck(h >= least && h <= most, from->comm, SAM_ERR_USER,
                 "-%sbody%" PetscInt_FMT "_layer_thickness %.6g: expected %.3g to %.3g m on this grid", e->prefix,
                 b + 1, (double)h, (double)least, (double)most);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetFromOptions(SamElasticity e)
{
  SamOptions from;
  char       type[sizeof(e->type)], types[256];

  PetscFunctionBegin;
  SamValidHandle(e, SamElasticity, 1);
  from = (SamOptions){e->grid->comm, e->prefix};
  PetscCall(SamElasticityGetTypes(types, sizeof(types)));
  PetscCall(SamOptionsHeading(&from, "Elasticity"));
  PetscCall(PetscStrncpy(type, e->type, sizeof(type)));
  PetscCall(SamTypesOption(SamElasticityList, &from, "elasticity", types, type, sizeof(type), NULL));
  PetscCall(SamFourierSettingsFromOptions(&e->fft, &from));
  if (strcmp(type, e->type) || e->is_set_up || (e->inner && e->inner->is_set_up))
    PetscCall(SamElasticitySetType(e, type)); /* creates it again with the settings */
  PetscCheck(e->traits.layers || SamPairIsUniform(e->pair), from.comm, SAM_ERR_USER,
             "-%selasticity %s: not supported with layers: use %s or %s", e->prefix, type, SAM_ELASTICITY_HALFSPACE,
             SAM_ELASTICITY_PERIODIC);
  PetscCall(CheckThicknesses(e, &from));
  for (SamElasticity o = e; o; o = o->inner) {
    o->fft = e->fft;
    if (o->ops.setfromoptions) PetscCall((*o->ops.setfromoptions)(o, &from));
  }
  if (SamPrintHelp()) PetscCall(DescribeOthers(e, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetUp(SamElasticity e)
{
  PetscFunctionBegin;
  SamValidHandle(e, SamElasticity, 1);
  if (e->is_set_up) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(e->traits.plane == SamGridIsRow(e->grid), e->grid->comm, PETSC_ERR_ARG_SIZ,
             "Elasticity of type %s: a grid of one row is for plane types, and these need one", e->type);
  e->is_set_up = PETSC_TRUE;
  if (e->inner) PetscCall(SamElasticitySetUp(e->inner));
  if (e->ops.setup) PetscCall((*e->ops.setup)(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityReference(SamElasticity e)
{
  PetscFunctionBegin;
  e->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityDestroy(SamElasticity *elasticity)
{
  SamElasticity e;

  PetscFunctionBegin;
  SamValidPointer(elasticity, 1);
  if (!*elasticity) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*elasticity, SamElasticity, 1);
  e           = *elasticity;
  *elasticity = NULL;
  if (--e->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Reset(e));
  PetscCall(SamPairDestroy(&e->pair));
  PetscCall(SamGridDestroy(&e->grid));
  e->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityTrim(SamElasticity e)
{
  PetscFunctionBegin;
  for (; e; e = e->inner)
    if (e->fourier) PetscCall(SamFourierTrim(e->fourier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamGrid SamElasticityGetGrid(SamElasticity e)
{
  return e->grid;
}

SamPair SamElasticityGetPair(SamElasticity e)
{
  return e->pair;
}

PetscReal SamElasticityGetModulus(SamElasticity e)
{
  return SamPairModulus(e->pair);
}

SamElasticityTraits SamElasticityGetTraits(SamElasticity e)
{
  SamElasticityTraits traits = e->traits;

  SamElasticityWith(e, createstress);
  traits.stress = e->ops.createstress != NULL;
  return traits;
}

PetscErrorCode SamElasticityGetSymmetric(SamElasticity e, SamElasticity *symmetric)
{
  PetscFunctionBegin;
  *symmetric = e;
  if (!e->traits.skewed) PetscFunctionReturn(PETSC_SUCCESS);
  SamElasticityWith(e, createsymmetric);
  if (!e->symmetric) PetscCall((*e->ops.createsymmetric)(e, &e->symmetric));
  *symmetric = e->symmetric;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityKeepStream(SamElasticity e, const SamStream *stream, SamStream **kept)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(*kept));
  if (!stream->terms) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(kept));
  **kept = *stream;
  SamPairGetValues(e->pair, (*kept)->sudden);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamElasticityRemembers(SamElasticity e)
{
  for (; e; e = e->inner)
    if (e->ops.begin || e->ops.stream) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SamElasticityGetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscFunctionBegin;
  SamValidHandle(e, SamElasticity, 1);
  PetscCall(SamElasticitySetUp(e));
  SamElasticityWith(e, getselfinfluence);
  if (!e->has_self || e->ops.begin) PetscCall((*e->ops.getselfinfluence)(e, &e->self[0], &e->self[1]));
  e->has_self = PETSC_TRUE;
  if (normal) *normal = e->self[0];
  if (tangential) *tangential = e->self[1] + e->film;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateStress(SamElasticity e, PetscInt body, const SamFourierSettings *settings,
                                         SamStress *stress)
{
  PetscFunctionBegin;
  SamElasticityWith(e, createstress);
  PetscCheck(e->ops.createstress, e->grid->comm, PETSC_ERR_SUP, "Elasticity of type %s: no stresses are available",
             e->type);
  PetscCheck((body == 1 || body == 2) && !SamBodyIsRigid(e->pair->body[body - 1]), e->grid->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "Body %" PetscInt_FMT ": use 1 or 2, an elastic body", body);
  PetscCall((*e->ops.createstress)(e, body, settings ? settings : &e->fft, stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityAddParameters(SamElasticity e, SamParameters *p)
{
  PetscFunctionBegin;
  PetscCall(SamPairAddParameters(e->pair, p));
  for (; e->wraps; e = e->inner)
    if (e->ops.addparameters) PetscCall((*e->ops.addparameters)(e, p)); /* wrappers are recorded by their options */
  PetscCall(SamParametersAddText(p, "elasticity", PETSC_TRUE, e->type));
  if (e->inner) PetscCall(SamParametersAddText(p, "elasticity_inner", PETSC_TRUE, e->inner->type));
  for (; e; e = e->inner)
    if (e->ops.addparameters) PetscCall((*e->ops.addparameters)(e, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateFromParameters(SamGrid grid, const SamParameters *p, const char source[],
                                                 SamElasticity *elasticity)
{
  const SamParameter *type = SamParametersFind(p, "elasticity");
  PetscErrorCode (*create)(SamElasticity);
  SamPair pair;
  char    types[256];

  PetscFunctionBegin;
  PetscCall(SamPairCreateFromParameters(grid->comm, p, source, &pair));
  PetscCheck(type, grid->comm, SAM_ERR_FILE, "%s: cannot be read: it lacks the attribute elasticity", source);
  PetscCall(SamElasticityGetTypes(types, sizeof(types)));
  PetscCall(PetscFunctionListFind(SamElasticityList, type->text, &create));
  PetscCheck(create, grid->comm, SAM_ERR_FILE, "%s: cannot be read: its elasticity is of type %s: expected %s", source,
             type->text, types);
  PetscCall(SamElasticityCreate(grid, pair, elasticity));
  PetscCall(SamPairDestroy(&pair));
  PetscCall(SamElasticitySetType(*elasticity, type->text));
  PetscCheck((*elasticity)->traits.plane == SamGridIsRow(grid), grid->comm, SAM_ERR_FILE,
             "%s: cannot be read: its elasticity %s does not fit its grid of %" PetscInt_FMT " rows", source,
             type->text, grid->ny);
  for (SamElasticity e = *elasticity; e; e = e->inner)
    if (e->ops.setparameters) PetscCall((*e->ops.setparameters)(e, p, source));
  for (PetscInt k = 0; k < added; k++) PetscCall((*additions[k]->fromparameters)(elasticity, p, source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetInner(SamElasticity e, SamElasticityType type)
{
  SamElasticity inner;

  PetscFunctionBegin;
  PetscCall(SamElasticityCreate(e->grid, e->pair, &inner));
  inner->fft = e->fft;
  PetscCall(SamElasticitySetOptionsPrefix(inner, e->prefix));
  PetscCall(PetscArraycpy(inner->first, e->first, 2));
  PetscCall(PetscArraycpy(inner->factor, e->factor, 2));
  if (type) PetscCall(SamElasticitySetType(inner, type));
  PetscCall(SamElasticityDestroy(&e->inner));
  e->inner  = inner;
  e->traits = inner->traits;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityWrap(SamElasticity bodies, SamElasticityType type, SamElasticityCreateFunction create,
                                 SamElasticity *outer)
{
  SamElasticity e;

  PetscFunctionBegin;
  PetscCall(SamElasticityCreate(bodies->grid, bodies->pair, &e));
  PetscCall(Create(e, type, create));
  e->wraps = PETSC_TRUE;
  e->fft   = bodies->fft;
  PetscCall(PetscStrncpy(e->prefix, bodies->prefix, sizeof(e->prefix)));
  PetscCall(SamElasticityDestroy(&e->inner));
  PetscCall(SamElasticityReference(bodies));
  e->inner  = bodies;
  e->traits = bodies->traits;
  *outer    = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateLike(SamElasticity parent, SamGrid grid, const PetscInt first[2],
                                       SamElasticity *child)
{
  const PetscReal ratio[2] = {first ? 1 : (PetscReal)parent->grid->nx / (PetscReal)grid->nx,
                              first ? 1 : (PetscReal)parent->grid->ny / (PetscReal)grid->ny};
  SamElasticity e;

  PetscFunctionBegin;
  PetscCall(SamElasticityCreate(grid, parent->pair, &e));
  e->fft = parent->fft;
  for (PetscInt k = 0; k < 2; k++) {
    e->first[k]  = parent->first[k] + (first ? (PetscReal)first[k] * parent->factor[k] : 0);
    e->factor[k] = parent->factor[k] * ratio[k];
  }
  PetscCall(SamElasticitySetOptionsPrefix(e, parent->prefix));
  PetscCall(Create(e, parent->type, parent->create));
  e->wraps = parent->wraps;
  if (parent->inner) {
    PetscCall(SamElasticityDestroy(&e->inner));
    PetscCall(SamElasticityCreateLike(parent->inner, grid, first, &e->inner));
  }
  e->traits = parent->traits;
  e->motion = parent->motion;
  if (parent->ops.inherit) PetscCall((*parent->ops.inherit)(parent, e));
  *child = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateOfPair(SamElasticity like, SamPair pair, SamElasticity *elasticity)
{
  const PetscInt first[2] = {0, 0};
  SamElasticity  e;

  PetscFunctionBegin;
  PetscCheck(!like->inner && !like->traits.patch, like->grid->comm, PETSC_ERR_SUP,
             "bodies of type %s have no constants that could be replaced", like->type);
  PetscCall(SamElasticityCreateLike(like, like->grid, first, &e));
  PetscCall(SamPairReference(pair));
  PetscCall(SamPairDestroy(&e->pair));
  e->pair           = pair;
  e->film           = 0;
  e->traits.coupled = SamPairIsCoupled(pair);
  *elasticity       = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetCoarse(SamElasticity e, SamElasticity *coarse, SamTransfer *transfer)
{
  PetscFunctionBegin;
  if (!e->coarse && e->grid->fewest >= HALVED) {
    SamGrid grid;

    PetscCall(SamGridCoarsen(e->grid, &grid));
    PetscCall(SamElasticityCreateLike(e, grid, NULL, &e->coarse));
    PetscCall(SamTransferCreate(e->grid, grid, &e->transfer));
    PetscCall(SamGridDestroy(&grid));
  }
  *coarse   = e->coarse;
  *transfer = e->transfer;
  PetscFunctionReturn(PETSC_SUCCESS);
}

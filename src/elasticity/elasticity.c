/* The class of influence operators: types, options, and the operators on coarser grids. */
#include <petsam/private/elasticityimpl.h>
#include <string.h>

/* Grids with fewer cells than this in a direction are solved directly, without a coarser one. */
#define COARSEST 32

static PetscFunctionList SamElasticityList = NULL;
static PetscBool         registered        = PETSC_FALSE;

static PetscErrorCode RegisterAll(void);

PetscErrorCode SamElasticityRegister(const char name[], PetscErrorCode (*create)(SamElasticity))
{
  PetscFunctionBegin;
  PetscCall(RegisterAll()); /* first, so that a type of the same name replaces ours */
  PetscCall(PetscFunctionListAdd(&SamElasticityList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeList(void)
{
  PetscFunctionBegin;
  registered = PETSC_FALSE;
  PetscCall(PetscFunctionListDestroy(&SamElasticityList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RegisterAll(void)
{
  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(SamElasticityRegister(SAM_ELASTICITY_HALFSPACE, SamElasticityCreate_HalfSpace));
  PetscCall(SamElasticityRegister(SAM_ELASTICITY_PERIODIC, SamElasticityCreate_Periodic));
  PetscCall(PetscRegisterFinalize(FreeList));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetTypes(char types[], size_t size)
{
  PetscFunctionBegin;
  PetscCall(RegisterAll());
  PetscCall(SamTypesList(SamElasticityList, types, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate(SamGrid grid, const SamPair *pair, SamElasticity *elasticity)
{
  SamElasticity e;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(RegisterAll());
  PetscCall(PetscNew(&e));
  e->references = 1;
  e->pair       = *pair;
  PetscCall(SamGridReference(grid));
  e->grid = grid;
  PetscCall(SamElasticitySetType(e, SAM_ELASTICITY_HALFSPACE));
  *elasticity = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything that the type and what follows from it have made. */
static PetscErrorCode Reset(SamElasticity e)
{
  PetscFunctionBegin;
  if (e->ops.destroy) PetscCall((*e->ops.destroy)(e));
  e->data = NULL;
  PetscCall(SamFourierDestroy(&e->fourier));
  PetscCall(SamTransferDestroy(&e->transfer));
  PetscCall(SamElasticityDestroy(&e->coarse));
  PetscCall(SamElasticityDestroyParts(e));
  PetscCall(PetscMemzero(&e->ops, sizeof(e->ops)));
  e->is_set_up = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetType(SamElasticity e, SamElasticityType type)
{
  PetscErrorCode (*create)(SamElasticity);
  char types[256];

  PetscFunctionBegin;
  PetscCall(PetscFunctionListFind(SamElasticityList, type, &create));
  PetscCall(SamElasticityGetTypes(types, sizeof(types)));
  PetscCheck(create, e->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Type %s of elasticity: expected %s", type, types);
  PetscCheck(e->references == 1, e->grid->comm, PETSC_ERR_ORDER,
             "The type of an elasticity must be set before a problem or a solver refers to it");
  PetscCall(Reset(e));
  PetscCall(create(e));
  PetscCall(PetscStrncpy(e->type, type, sizeof(e->type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetType(SamElasticity e, SamElasticityType *type)
{
  PetscFunctionBegin;
  *type = e->type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetOptionsPrefix(SamElasticity e, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(SamSetPrefix(e->prefix, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetFromOptions(SamElasticity e)
{
  const SamOptions from = {e->grid->comm, e->prefix};
  char             type[sizeof(e->type)], types[256];

  PetscFunctionBegin;
  PetscCall(SamElasticityGetTypes(types, sizeof(types)));
  PetscCall(SamOptionsHeading(&from, "Elasticity"));
  PetscCall(PetscStrncpy(type, e->type, sizeof(type)));
  PetscCall(SamTypesOption(SamElasticityList, &from, "elasticity", types, type, sizeof(type), NULL));
  PetscCall(SamTypesCheckOption(SamElasticityList, &from, "elasticity", type));
  PetscCall(SamFourierSettingsFromOptions(&e->fft, &from));
  if (strcmp(type, e->type) || e->is_set_up) PetscCall(SamElasticitySetType(e, type)); /* made anew with the settings */
  if (e->ops.setfromoptions) PetscCall((*e->ops.setfromoptions)(e, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetUp(SamElasticity e)
{
  PetscFunctionBegin;
  if (e->is_set_up) PetscFunctionReturn(PETSC_SUCCESS);
  e->is_set_up = PETSC_TRUE;
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
  SamElasticity e = *elasticity;

  PetscFunctionBegin;
  *elasticity = NULL;
  if (!e || --e->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Reset(e));
  PetscCall(SamGridDestroy(&e->grid));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityTrim(SamElasticity e)
{
  PetscFunctionBegin;
  if (e->fourier) PetscCall(SamFourierTrim(e->fourier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetGrid(SamElasticity e, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = e->grid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetPair(SamElasticity e, const SamPair **pair)
{
  PetscFunctionBegin;
  *pair = &e->pair;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetTraits(SamElasticity e, SamElasticityTraits *traits)
{
  PetscFunctionBegin;
  *traits = e->traits;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamElasticityPairIsCoupled(const SamPair *pair)
{
  /* bodies of equal constants cancel exactly; others may leave rounding */
  return PetscAbsReal(pair->dundurs) > 1e-14;
}

PetscErrorCode SamElasticityGetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscReal of_normal, of_tangential;

  PetscFunctionBegin;
  PetscCall(SamElasticitySetUp(e));
  PetscCall((*e->ops.getselfinfluence)(e, &of_normal, &of_tangential));
  if (normal) *normal = of_normal;
  if (tangential) *tangential = of_tangential;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateLike(SamElasticity parent, SamGrid grid, SamElasticity *child)
{
  SamElasticity e;

  PetscFunctionBegin;
  PetscCall(SamElasticityCreate(grid, &parent->pair, &e));
  e->fft = parent->fft;
  PetscCall(SamElasticitySetOptionsPrefix(e, parent->prefix));
  PetscCall(SamElasticitySetType(e, parent->type));
  if (parent->ops.inherit) PetscCall((*parent->ops.inherit)(parent, e));
  *child = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetCoarse(SamElasticity e, SamElasticity *coarse, SamTransfer *transfer)
{
  PetscFunctionBegin;
  if (!e->coarse && PetscMin(e->grid->nx, e->grid->ny) >= COARSEST) {
    SamGrid grid;

    PetscCall(SamGridCoarsen(e->grid, &grid));
    PetscCall(SamElasticityCreateLike(e, grid, &e->coarse));
    PetscCall(SamTransferCreate(e->grid, grid, &e->transfer));
    PetscCall(SamGridDestroy(&grid));
  }
  *coarse   = e->coarse;
  *transfer = e->transfer;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The class SamLaw: its registry, and what all laws share. */
#include <petsam/private/elasticity.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/control.h>
#include <petsam/private/law.h>
#include <petsam/private/parameters.h>

/* ---- the registry ---- */

static SamLawType names[SAM_LAWS];
static PetscErrorCode (*creators[SAM_LAWS])(SamLaw);
static PetscInt count;

static PetscErrorCode FreeList(void)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++) PetscCall(PetscFree(names[k]));
  count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Find(const char name[])
{
  PetscInt k = 0;

  while (k < count && strcmp(names[k], name)) k++;
  return k;
}

PetscErrorCode SamLawRegister(const char name[], PetscErrorCode (*create)(SamLaw))
{
  PetscInt k;
  char    *copy;

  PetscFunctionBegin;
  SamValidPointer(name, 1);
  SamValidPointer(create, 2);
  k = Find(name);
  PetscCheck(k < SAM_LAWS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "More than %d types of law: %s", SAM_LAWS, name);
  creators[k] = create;
  if (k < count) PetscFunctionReturn(PETSC_SUCCESS);
  if (!count) PetscCall(PetscRegisterFinalize(FreeList));
  PetscCall(PetscStrallocpy(name, &copy));
  names[count++] = copy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawGetTypes(PetscInt *n, const SamLawType **types)
{
  PetscFunctionBegin;
  *n     = count;
  *types = names;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamLawIsRegistered(const char name[])
{
  return Find(name) < count ? PETSC_TRUE : PETSC_FALSE;
}

PetscInt SamLawOrder(SamLawType type)
{
  return Find(type);
}

const char *SamLawOption(SamLaw law)
{
  if (law->named) return law->named;
  return law->option ? law->option : law->row_count ? law->rows[0].name : law->type;
}

PetscErrorCode SamLawNoBack(SamLaw law, SamBackStep *step)
{
  PetscFunctionBegin;
  (void)law;
  (void)step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- creation ---- */

PetscErrorCode SamLawCreate(SamElasticity elasticity, SamLawType type, SamLaw *law)
{
  SamLaw   l;
  PetscInt k;

  PetscFunctionBegin;
  SamValidHandle(elasticity, SamElasticity, 1);
  SamValidPointer(type, 2);
  SamValidPointer(law, 3);
  k = Find(type);
  PetscCheck(k < count, PETSC_COMM_SELF, PETSC_ERR_ARG_UNKNOWN_TYPE, "Unknown law %s%s", type,
             count ? "" : ": no law is registered: call SamInitialize() first");
  PetscCall(PetscNew(&l));
  l->class_id   = SamLaw_CLASSID;
  l->references = 1;
  PetscCall(SamElasticityReference(elasticity));
  l->elasticity = elasticity;
  l->grid       = SamElasticityGetGrid(elasticity);
  PetscCall(PetscStrncpy(l->type, names[k], sizeof(l->type)));
  PetscCall(creators[k](l));
  *law = l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawGetFriction(SamLaw law, PetscReal *friction)
{
  PetscFunctionBegin;
  PetscCheck(law->ops.friction, law->grid->comm, PETSC_ERR_ARG_WRONG, "The law %s has no coefficient of friction",
             law->type);
  PetscCall(law->ops.friction(law, friction, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawReference(SamLaw law)
{
  PetscFunctionBegin;
  law->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawDestroy(SamLaw *law)
{
  SamLaw l;

  PetscFunctionBegin;
  SamValidPointer(law, 1);
  if (!*law) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*law, SamLaw, 1);
  l    = *law;
  *law = NULL;
  if (--l->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (l->ops.destroy) PetscCall(l->ops.destroy(l));
  PetscCall(PetscFree(l->data));
  PetscCall(SamConditionsDestroy(&l->conditions));
  PetscCall(SamElasticityDestroy(&l->elasticity));
  l->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawSetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  char option[96];

  PetscFunctionBegin;
  *asked = PETSC_FALSE;
  (void)snprintf(option, sizeof(option), "%s %s", law->option ? law->option : "", law->word ? law->word : "");
  if (law->word) PetscCall(SamOptionsHas(from, option, asked));
  if (!law->word && law->option && !law->ops.setfromoptions) PetscCall(SamOptionsHas(from, law->option, asked));
  PetscCall(SamOptionsRead(from, law->heading, law->row_count, law->rows, law->data, NULL));
  if (law->ops.setfromoptions) PetscCall(law->ops.setfromoptions(law, from, asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawAddConditions(SamLaw law, SamConditions conditions)
{
  PetscFunctionBegin;
  PetscCheck(!law->conditions, law->grid->comm, PETSC_ERR_ARG_WRONG, "The law %s belongs to another problem",
             law->type);
  PetscCall(SamConditionsReference(conditions));
  law->conditions = conditions;
  if (law->ops.conditions) PetscCall(law->ops.conditions(law, conditions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawAddParameters(SamLaw law, SamParameters *parameters)
{
  PetscFunctionBegin;
  if (law->word) PetscCall(SamParametersAddText(parameters, law->option, PETSC_TRUE, law->word));
  PetscCall(SamParametersAddOptions(parameters, law->row_count, law->rows, law->data));
  if (law->ops.addparameters) PetscCall(law->ops.addparameters(law, parameters));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawListWords(SamElasticity elasticity, const char option[], const char between[], char words[],
                               size_t size)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++) {
    const size_t used = strlen(words);
    SamLaw       law;

    PetscCall(SamLawCreate(elasticity, names[k], &law));
    if (law->word && !strcmp(law->option, option))
      (void)snprintf(words + used, size - used, "%s%s", between, law->word);
    PetscCall(SamLawDestroy(&law));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

PetscErrorCode SamLawAddToSum(SamState state, const char name[], Vec more)
{
  const PetscInt id   = SamStateFindField(state, name);
  const Vec      from = SamStateGetField(state, id, SAM_COMMITTED);
  Vec            to;

  PetscFunctionBegin;
  PetscCall(SamStateSetField(state, id, &to));
  PetscCall(VecCopy(more, to));
  if (from) PetscCall(VecAXPY(to, 1, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}
